//! Steps from many nodes with their derivatives: the constraints of direct multiple shooting.
//!
//! In: a system, a plan, and the nodes from which independent steps start. Out: the end of each step, its Jacobian, and
//! its second derivatives. An optimal control problem takes the steps as its constraints: the end of each step is the
//! next node.

use crate::plan::{PhasePoint, Plan};
use crate::simulation::{End, Simulation, Wanted};
use crate::system::{Quantity, System};
use core::num::NonZero;
use std::panic::resume_unwind;
use std::thread;
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

/// Second derivatives of K independent steps. The numbers of a failed step are NaN.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curvatures {
    /// K symmetric matrices with D = 2N + M + 2 rows: q, p, M parameters, h and t.
    pub values: Vec<f64>,
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
        let parameters = parameters(system, varied);
        let shooting = Shooting::of((system, plan), &parameters, steps, has_velocities);
        let (rows, columns) = (2 * shooting.n(), shooting.places().count());
        let mut ends = Ends::default();
        let found = each(&self.starts().collect::<Vec<_>>(), |start| shooting.end(start));
        for (index, end) in found.into_iter().enumerate() {
            match end {
                Ok((state, slopes)) => {
                    ends.states.extend(state);
                    ends.jacobians.extend((0..rows).flat_map(|row| slopes.iter().map(move |of| of[row])));
                }
                Err(error) => {
                    ends.states.resize(ends.states.len() + rows, f64::NAN);
                    ends.jacobians.resize(ends.jacobians.len() + rows * columns, f64::NAN);
                    ends.errors.push((index, error));
                }
            }
        }
        ends
    }

    /// The second derivatives of `weights_k · end_k`, with respect to the numbers of the Jacobian, for each end of
    /// [`Shots::ends`]. `weights` has 2N numbers for each.
    ///
    /// They are exact for zero and one step of the methods of [`Run::curvature`](vi_core::Run::curvature). Otherwise
    /// they are central differences of the Jacobians: the change of each variable is 1e-5 of its largest size in all
    /// nodes.
    #[must_use]
    #[allow(clippy::too_many_arguments)] // those of `ends`, and the weights
    pub fn curvatures(
        &self,
        system: &dyn System,
        plan: &Plan,
        varied: &[usize],
        steps: u64,
        has_velocities: bool,
        weights: &[f64],
    ) -> Curvatures {
        let parameters = parameters(system, varied);
        let shooting = Shooting::of((system, plan), &parameters, steps, has_velocities);
        let (rows, columns) = (2 * shooting.n(), shooting.places().count());
        let changes = self.changes();
        let mut curvatures = Curvatures::default();
        let starts: Vec<_> = self.starts().zip(weights.chunks(rows)).collect();
        let found = each(&starts, |(start, weights)| shooting.curvature(start.clone(), &changes, weights));
        for (index, curvature) in found.into_iter().enumerate() {
            match curvature {
                Ok(matrix) => curvatures.values.extend(matrix),
                Err(error) => {
                    curvatures.values.resize(curvatures.values.len() + columns * columns, f64::NAN);
                    curvatures.errors.push((index, error));
                }
            }
        }
        curvatures
    }

    /// The numbers of each start: q, p, all parameters, h and t.
    fn starts(&self) -> impl Iterator<Item = Vec<f64>> {
        let of = |values: &[f64], index: usize| {
            let count = values.len() / self.t.len();
            values[index * count..(index + 1) * count].to_vec()
        };
        let columns = [self.q, self.p, self.parameters, self.h, self.t];
        (0..self.t.len()).map(move |index| columns.iter().flat_map(|values| of(values, index)).collect())
    }

    /// The change of each number of a start for a difference.
    fn changes(&self) -> Vec<f64> {
        // The error of a difference of this part of a number is near that of rounding.
        const PART: f64 = 1e-5;
        // The size of zero.
        const LEAST: f64 = 1e-2;
        let mut sizes = Vec::new();
        for start in self.starts() {
            sizes.resize(start.len(), 0.0);
            for (size, number) in sizes.iter_mut().zip(&start) {
                *size = number.abs().max(*size);
            }
        }
        if let [others @ .., h, t] = &mut sizes[..] {
            for size in others {
                *size = size.max(LEAST);
            }
            *t = t.max(*h);
        }
        sizes.iter().map(|size| PART * size).collect()
    }
}

/// A function of each start, by the threads of the machine; the results are in the order of the starts.
fn each<S: Sync, R: Send>(starts: &[S], of: impl Fn(&S) -> R + Sync) -> Vec<R> {
    let threads = thread::available_parallelism().map_or(1, NonZero::get);
    let share = starts.len().div_ceil(threads).max(1);
    if share >= starts.len() {
        return starts.iter().map(of).collect();
    }
    let of = &of;
    thread::scope(|scope| {
        let parts: Vec<_> =
            starts.chunks(share).map(|part| scope.spawn(move || part.iter().map(of).collect::<Vec<R>>())).collect();
        parts.into_iter().flat_map(|part| part.join().unwrap_or_else(|panic| resume_unwind(panic))).collect()
    })
}

/// Indices as in [`Wanted`]: behind the parameters are the length of the steps and the time of the start.
fn parameters(system: &dyn System, varied: &[usize]) -> Vec<usize> {
    let count = system.parameters().len();
    varied.iter().copied().chain([count, count + 1]).collect()
}

/// The steps from each start.
struct Shooting<'a> {
    system: &'a dyn System,
    plan: &'a Plan,
    wanted: Wanted<'a>,
}

impl<'a> Shooting<'a> {
    fn of(
        (system, plan): (&'a dyn System, &'a Plan),
        parameters: &'a [usize],
        steps: u64,
        has_velocities: bool,
    ) -> Self {
        let wanted = Wanted { end: End::Steps(steps), parameters, has_velocities: [false, has_velocities] };
        Self { system, plan, wanted }
    }

    /// The number of coordinates.
    fn n(&self) -> usize {
        self.system.coordinates().len()
    }

    /// The place, in the numbers of a start, of each one that varies.
    fn places(&self) -> impl Iterator<Item = usize> {
        let state = 2 * self.n();
        (0..state).chain(self.wanted.parameters.iter().map(move |index| state + index))
    }

    /// The run from one start.
    fn begin(&self, start: &[f64]) -> Result<Box<dyn Simulation>, StepError> {
        let (q, rest) = start.split_at(self.n());
        let (p, rest) = rest.split_at(self.n());
        let (parameters, rest) = rest.split_at(self.system.parameters().len());
        let (h, t) = (rest[0], rest[1]);
        let own = self.system.with_parameters(parameters);
        let plan = if own.has_constraints() || own.is_first_order() {
            let mut v = Vec::new();
            own.evaluate(Quantity::Velocity, [&[t], q, p], &mut v)?;
            let PhasePoint { q, v, .. } = own.project(&PhasePoint { t, q: q.to_vec(), v })?.point;
            Plan { h, t, q, v, p: None, ..self.plan.clone() }
        } else {
            Plan { h, t, q: q.to_vec(), p: Some(p.to_vec()), ..self.plan.clone() }
        };
        own.begin(&plan)
    }

    /// The end of the steps from one start, and its derivatives in each direction.
    fn end(&self, start: &[f64]) -> Result<(Vec<f64>, Vec<Vec<f64>>), StepError> {
        let mut run = self.begin(start)?;
        let slopes = run.tangent(self.wanted, &mut || true)?.unwrap_or_default();
        let second = if self.wanted.has_velocities[1] { run.velocity()? } else { run.p().to_vec() };
        Ok((run.q().iter().copied().chain(second).collect(), slopes))
    }

    /// The second derivatives of `weights · end`.
    fn curvature(&self, start: Vec<f64>, changes: &[f64], weights: &[f64]) -> Result<Vec<f64>, StepError> {
        let exact = self.begin(&start)?.curvature(self.wanted, weights)?;
        exact.map_or_else(|| self.differences(start, changes, weights), Ok)
    }

    /// The second derivatives of `weights · end`, by differences of these changes of the numbers of a start.
    fn differences(&self, mut start: Vec<f64>, changes: &[f64], weights: &[f64]) -> Result<Vec<f64>, StepError> {
        let mut rows = Vec::new();
        for place in self.places() {
            let middle = start[place];
            let [above, below] = [middle + changes[place], middle - changes[place]];
            let mut gradient = |number| {
                start[place] = number;
                let (_, slopes) = self.end(&start)?;
                let along = |slopes: Vec<f64>| slopes.iter().zip(weights).map(|(slope, weight)| slope * weight).sum();
                Ok(slopes.into_iter().map(along).collect::<Vec<f64>>())
            };
            let ends = gradient(above)?.into_iter().zip(gradient(below)?);
            rows.push(ends.map(|(end, other)| (end - other) / (above - below)).collect::<Vec<_>>());
            start[place] = middle;
        }
        let mean = &|row: usize, column: usize| f64::midpoint(rows[row][column], rows[column][row]);
        Ok((0..rows.len()).flat_map(|row| (0..rows.len()).map(move |column| mean(row, column))).collect())
    }
}
