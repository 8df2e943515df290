//! Keeps a pendulum upright on a cart, on a microcontroller: no operating system, no allocator.
//!
//! In, every 5 ms: the position of the cart and the angle of the pendulum, as encoders measure them. Out: the force of
//! the motor for the *next* period, so that there are 5 ms to compute it. The [`Controller`] carries a run of the
//! variational integrator in `f32` as its estimate of the state. Each period it
//!
//! 1. corrects coordinates and momenta of the run by the difference of what it measured from what the run predicted,
//! 2. takes one step with the force that acts now: the state at the end of this period,
//! 3. chooses from that state the force that acts then.
//!
//! The gains are those of a linear-quadratic regulator and of a stationary Kalman filter, for the linearization of this
//! step about the upright pendulum; `tests/gains.rs` computes them from the same system.

#![no_std]

pub mod pendulum;

use vi_core::nalgebra::{Matrix4x2, RowVector4, SVector, Vector4};
use vi_core::prelude::*;

lagrangian! {
    /// A pendulum on a cart. Lengths in m, masses in kg, forces in N; θ = 0 is upright.
    pub struct CartPole {
        param M = 0.5, m = 0.2, l = 0.3, g = 9.81;
        /// Friction of the cart, in kg/s.
        param b = 0.1;
        /// Force of the motor.
        input u = 0.0;
        coord x, θ;
        L = (M + m) * dot(x)^2 / 2 + m * l * dot(x) * dot(θ) * cos(θ) + m * l^2 * dot(θ)^2 / 2 - m * g * l * cos(θ);
        force x = u - b * dot(x);
        discretize midpoint;
    }
}

/// The time between two measurements, in s: one step.
pub const PERIOD: f32 = 0.005;

/// The largest force of the motor, in N.
pub const LARGEST: f32 = 12.0;

/// The force for a state (x, θ, p_x, p_θ) is minus its product with these.
pub const REGULATOR: RowVector4<f32> = RowVector4::new(-9.511_669, -32.543_17, 19.533_225, -347.163_53);

/// The correction of (x, θ, p_x, p_θ) by what was measured more than predicted, of x and of θ.
pub const FILTER: Matrix4x2<f32> = Matrix4x2::new(
    0.359_746_8,
    -0.030_861_027, // x
    -0.290_475_97,
    0.466_257_6, // θ
    10.190_392_5,
    -0.762_005_6, // p_x
    0.428_805_85,
    0.323_235_03, // p_θ
);

/// A run that follows the pendulum, with the force that acts now.
#[derive(Clone, Debug)]
pub struct Controller {
    run: Run<FixedStep, CartPole<f32>, 2, f32>,
}

impl Controller {
    /// A controller of a pendulum that was measured at rest, without force.
    ///
    /// # Errors
    /// The errors of [`Start::integrate`]: a measurement that is not finite.
    pub fn new(measured: [f32; 2]) -> Result<Self, StepError> {
        let model = CartPole::default().convert::<f32>();
        Ok(Self { run: model.at(0.0, measured, [0.0, 0.0]).integrate(FixedStep, PERIOD)? })
    }

    /// The force for the next period, in N, from the (x, θ) measured now.
    ///
    /// # Errors
    /// The errors of a step, if the measurement is not finite or far off. The controller then holds its last state.
    pub fn force(&mut self, measured: [f32; 2]) -> Result<f32, StepError> {
        let mut run = self.run.clone();
        let State { q, p, .. } = run.state();
        let correction = FILTER * (SVector::from(measured) - q);
        let (of_q, of_p) = (correction.fixed_rows::<2>(0), correction.fixed_rows::<2>(2));
        // The system does not depend on time, and times near zero have all digits.
        run.set_state(State { t: 0.0, q: q + of_q, p: p + of_p })?;
        let State { q, p, .. } = run.step()?;
        let force = -(REGULATOR * Vector4::new(q[0], q[1], p[0], p[1]))[0];
        let force = force.clamp(-LARGEST, LARGEST);
        run.set_parameters(|model| model.u = force)?;
        self.run = run;
        Ok(force)
    }
}
