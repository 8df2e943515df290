//! Steps from many nodes with their derivatives: the constraints of direct multiple shooting.
//!
//! In: a system, a plan, and the nodes from which independent steps start. Out: the end of each step, and its Jacobian.
//! An optimal control problem takes the steps as its constraints: the end of each step is the next node.

use crate::plan::{PhasePoint, Plan};
use crate::simulation::{End, Wanted};
use crate::system::{Quantity, System};
use vi_core::StepError;

/// The starts of K independent steps, one after the other.
#[derive(Clone, Copy, Debug)]
pub struct Shots<'a> {
    /// K times.
    pub t: &'a [f64],
    /// N coordinates of each.
    pub q: &'a [f64],
    /// N momenta of each.
    pub p: &'a [f64],
    /// K lengths of steps.
    pub h: &'a [f64],
    /// All parameters of the system for each.
    pub parameters: &'a [f64],
}

/// The ends of K independent steps. The numbers of a failed step are NaN.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Ends {
    /// q and p of each end, or q and v: 2N numbers.
    pub states: Vec<f64>,
    /// The Jacobian of each end, row by row: 2N rows of 2N + M + 2 numbers, the derivatives with respect to q, p, M
    /// parameters, h and t.
    pub jacobians: Vec<f64>,
    /// The index and the error of each failed step.
    pub errors: Vec<(usize, StepError)>,
}

impl Shots<'_> {
    /// Takes `steps` steps of equal length from each node, by the method of the plan, whose start is unused. `varied` has
    /// the indices of the M parameters. With `has_velocities` the ends have velocities in place of momenta. Zero steps
    /// convert the state: the end is the node, and the Jacobian has the derivatives of its velocities.
    ///
    /// The steps of a system with constraints start from the nearest states on them, since the nodes of an iteration leave
    /// the constraints. The Jacobian is exact for nodes on the constraints. If L is linear in the velocities, steps start
    /// from the coordinates alone.
    #[must_use]
    pub fn ends(&self, system: &dyn System, plan: &Plan, varied: &[usize], steps: u64, has_velocities: bool) -> Ends {
        let (n, count) = (system.coordinates().len(), system.parameters().len());
        // Behind the parameters are the length of the steps and the time of the start.
        let parameters: Vec<usize> = varied.iter().copied().chain([count, count + 1]).collect();
        let wanted =
            Wanted { end: End::Steps(steps), parameters: &parameters, has_velocities: [false, has_velocities] };
        let columns = 2 * n + parameters.len();
        let mut ends = Ends::default();
        for index in 0..self.t.len() {
            match self.end(index, (system, plan), wanted) {
                Ok((state, slopes)) => {
                    ends.states.extend(state);
                    ends.jacobians.extend((0..2 * n).flat_map(|row| slopes.iter().map(move |of| of[row])));
                }
                Err(error) => {
                    ends.states.resize(ends.states.len() + 2 * n, f64::NAN);
                    ends.jacobians.resize(ends.jacobians.len() + 2 * n * columns, f64::NAN);
                    ends.errors.push((index, error));
                }
            }
        }
        ends
    }

    /// The end of the steps from one node, and its derivatives in each direction.
    fn end(
        &self,
        index: usize,
        (system, plan): (&dyn System, &Plan),
        wanted: Wanted<'_>,
    ) -> Result<(Vec<f64>, Vec<Vec<f64>>), StepError> {
        let of = |values: &[f64], count: usize| values[index * count..(index + 1) * count].to_vec();
        let (n, count) = (system.coordinates().len(), self.parameters.len() / self.t.len());
        let own = system.with_parameters(&of(self.parameters, count));
        let (t, h, q, p) = (self.t[index], self.h[index], of(self.q, n), of(self.p, n));
        let start = if own.has_constraints() || own.is_first_order() {
            let mut v = Vec::new();
            own.evaluate(Quantity::Velocity, [&[t], &q, &p], &mut v)?;
            let PhasePoint { q, v, .. } = own.project(&PhasePoint { t, q, v })?.point;
            Plan { h, t, q, v, p: None, ..plan.clone() }
        } else {
            Plan { h, t, q, p: Some(p), ..plan.clone() }
        };
        let mut run = own.begin(&start)?;
        let slopes = run.tangent(wanted, &mut || true)?.unwrap_or_default();
        let second = if wanted.has_velocities[1] { run.velocity()? } else { run.p().to_vec() };
        Ok((run.q().iter().copied().chain(second).collect(), slopes))
    }
}
