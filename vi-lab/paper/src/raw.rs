//! The paper's equations solved as they are written, for comparison.
//!
//! In: a node. Out: the next node. Newton's method on the momentum and the energy equation in the unknowns `(q1, t1)`,
//! neither row combined nor scaled, until the residual no longer decreases; then `p1 = D4 L_d + f_d⁺` and `E1 = −D3 L_d
//! − g_d⁺` of that interval. The guess is the solution in `(v, h)` from the same node, and the Jacobian is exact. So
//! the remaining error is the cancellation in `(q1 − q0)/(t1 − t0)`, which `(v, h)` do not have.

use vi_core::linear::Matrix;
use vi_core::node::Node;
use vi_core::stepping::{EnergyStepping, ExtendedSystem};
use vi_core::{DiscreteLagrangian, EnergyPreserving, Interval, Run, SVector, State};

/// A node with the discrete energy recomputed from it, and the interval that led to it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RawNode {
    /// Time, coordinate, momentum.
    pub(crate) state: State<1>,
    /// Discrete energy.
    pub(crate) energy: f64,
    h: f64,
    v: f64,
}

impl RawNode {
    /// The node that an integrator starts from.
    pub(crate) fn first<S: EnergyStepping<1> + DiscreteLagrangian<1>>(
        integrator: &Run<EnergyPreserving, S, 1>,
    ) -> Self {
        Self { state: integrator.state(), energy: integrator.node().energy, h: integrator.h(), v: integrator.v().x }
    }

    /// The next node; `None` if there is no step, or the iteration is not finite.
    pub(crate) fn next<S: EnergyStepping<1> + DiscreteLagrangian<1>>(&self, system: &S) -> Option<Self> {
        let guess = EnergyPreserving::from_state(system, self.state, self.energy, self.h, [self.v])
            .ok()?
            .detailed_step()
            .ok()?;
        self.polished(system, (guess.t, guess.q.x))
    }

    /// Derivatives of both rows, un-combined, by v and h.
    fn rows<S: EnergyStepping<1> + DiscreteLagrangian<1>>(&self, system: &S, v: f64, h: f64) -> [[f64; 2]; 2] {
        let ExtendedSystem { momentum, residual_dh, energy_dv, energy_dh, .. } =
            system.extended_system(&Node::new(self.state, self.energy), h, &SVector::from([v]));
        let r_v = momentum.jacobian.dense().x;
        let r_h = residual_dh.x;
        [[r_v, r_h], [h * energy_dv.x + v * r_v, h * energy_dh + v * r_h]]
    }

    /// The next node, from the guess `(t1, q1)`.
    fn polished<S: EnergyStepping<1> + DiscreteLagrangian<1>>(&self, system: &S, guess: (f64, f64)) -> Option<Self> {
        let end = descend(guess, |trial| {
            let [r, e] = self.residuals(system, trial);
            ([r, e], self.newton(system, trial, [r, e]))
        });
        let interval = self.interval(end);
        let p = system.d4_ld(&interval) + system.fd_plus(&interval);
        let energy = -system.d3_ld(&interval) - system.gd_plus(&interval);
        let h = end.0 - self.state.t;
        let state = State { t: end.0, q: [end.1].into(), p };
        energy.is_finite().then_some(Self { state, energy, h, v: (end.1 - self.state.q.x) / h })
    }

    fn interval(&self, (t1, q1): (f64, f64)) -> Interval<1> {
        Interval { t0: self.state.t, q0: self.state.q, t1, q1: [q1].into() }
    }

    /// `−D2 L_d − f_d⁻ − p0` and `D1 L_d + g_d⁻ − E0`.
    fn residuals<S: EnergyStepping<1> + DiscreteLagrangian<1>>(&self, system: &S, end: (f64, f64)) -> [f64; 2] {
        let interval = self.interval(end);
        let r = -system.d2_ld(&interval) - system.fd_minus(&interval) - self.state.p;
        [r.x, system.d1_ld(&interval) + system.gd_minus(&interval) - self.energy]
    }

    /// The correction of `(t1, q1)`.
    fn newton<S: EnergyStepping<1> + DiscreteLagrangian<1>>(
        &self,
        system: &S,
        (t1, q1): (f64, f64),
        [r, e]: [f64; 2],
    ) -> Option<(f64, f64)> {
        let h = t1 - self.state.t;
        let v = (q1 - self.state.q.x) / h;
        // By the chain rule ∂v/∂q1 = 1/h, ∂v/∂t1 = −v/h, ∂h/∂t1 = 1.
        let [[r_v, r_h], [e_v, e_h]] = self.rows(system, v, h);
        let r_q = r_v / h;
        let r_t = r_h - r_v * v / h;
        let e_q = e_v / h;
        let e_t = e_h - e_v * v / h;
        let determinant = r_t * e_q - r_q * e_t;
        let correction = ((r_q * e - e_q * r) / determinant, (e_t * r - r_t * e) / determinant);
        (correction.0.is_finite() && correction.1.is_finite()).then_some(correction)
    }
}

/// Follows Newton's corrections from `guess` while the residual decreases.
fn descend(guess: (f64, f64), equations: impl Fn((f64, f64)) -> ([f64; 2], Option<(f64, f64)>)) -> (f64, f64) {
    let mut end = guess;
    let mut least = f64::INFINITY;
    let mut trial = guess;
    for _ in 0..20 {
        let ([r, e], correction) = equations(trial);
        let size = r.hypot(e);
        // An iteration that no longer decreases the residual has reached its floor.
        if size.is_nan() || size >= least {
            break;
        }
        (end, least) = (trial, size);
        let Some((first, second)) = correction else { break };
        trial = (trial.0 + first, trial.1 + second);
    }
    end
}

#[cfg(test)]
mod tests {
    use super::*;
    use vi_systems::DampedOscillator;

    #[test]
    fn the_equations_as_written_have_the_solution_of_the_stepper() {
        let system = DampedOscillator::default();
        let mut stepper = EnergyPreserving::from_midpoint(system, 0.0, [1.0], [0.0], 0.1).expect("a valid start");
        for _ in 0..20 {
            let before = RawNode::first(&stepper);
            let step = stepper.detailed_step().expect("a step");
            // A guess that is wrong by a part in ten thousand.
            let guess = (before.state.t + step.h * 1.0001, before.state.q.x + step.h * step.midpoint.2.x);
            let found = before.polished(&system, guess).expect("a solution");
            // Measured 5.8e-15 and 5.6e-15: the floor of the raw equations at this step, with a force of 1.
            assert!((found.state.t - step.t).abs() < 7e-15, "{}", found.state.t - step.t);
            assert!((found.energy - step.energy).abs() < 7e-15, "{}", found.energy - step.energy);
        }
    }
}
