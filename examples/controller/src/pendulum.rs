//! A simulated pendulum: Gauss steps of order 4 in `f64`, and encoders.

use crate::{CartPole, PERIOD};
use core::f64::consts::TAU;
use vi_core::prelude::*;

/// Counts of the encoders, a metre and a radian.
pub const COUNTS: [f64; 2] = [4000.0, 8192.0 / TAU];

/// A pendulum, a motor and two encoders.
#[derive(Clone, Debug)]
pub struct Pendulum {
    run: Run<Gauss<2>, CartPole, 2>,
}

impl Pendulum {
    /// A pendulum at rest at the angle θ.
    ///
    /// # Errors
    /// The errors of [`Start::integrate`].
    pub fn at_rest(θ: f64) -> Result<Self, StepError> {
        let start = CartPole::default().at(0.0, [0.0, θ], [0.0, 0.0]);
        Ok(Self { run: start.integrate(Gauss::<2>, f64::from(PERIOD))? })
    }

    /// The measurement of the encoders: (x, θ), rounded to counts.
    #[allow(clippy::cast_possible_truncation)] // counts, and numbers of a controller
    pub fn measured(&self) -> [f32; 2] {
        let q = self.run.state().q;
        let counted = |k: usize| ((q[k] * COUNTS[k]) as i32) as f32 / COUNTS[k] as f32;
        [counted(0), counted(1)]
    }

    /// Moves by one period under this force of the motor.
    ///
    /// # Errors
    /// The errors of a step.
    pub fn pushed(&mut self, force: f32) -> Result<State<2>, StepError> {
        self.run.set_parameters(|cart| cart.u = f64::from(force))?;
        self.run.step()
    }
}
