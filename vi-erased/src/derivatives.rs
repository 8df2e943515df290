//! Derivatives of runs.
//!
//! In: a run. Out: its linearization, tangent vectors and gradients as plain numbers, and the run at
//! their end. With constraints, the change of one coordinate alone is no motion: runs have a linearization only.

use crate::erasable::Runnable;
use crate::method::{AnyMethod, AnyRun};
use vi_core::derivatives::{self, Covector, Objective, Tangent, Variation};
use vi_core::kind::Kind;
use vi_core::{State, StepError};

/// Checks that a change of one coordinate alone is a motion.
///
/// # Errors
/// [`StepError::NoDerivative`] with constraints.
fn check_free<S: Runnable<N>, const N: usize>(t: f64) -> Result<(), StepError> {
    let because = "a change of one coordinate alone leaves the constraints; use the linearization of the run";
    if const { S::Kind::COUNT == 0 } { Ok(()) } else { Err(StepError::NoDerivative { t, because }) }
}

/// A value at the end of some steps, and the run there; `None` if it was interrupted.
type AtEnd<S, Y, const N: usize> = Result<Option<(AnyRun<S, N>, Y)>, StepError>;

/// Derivatives of the node after steps by the start, as [`Session::tangent`](crate::Session::tangent); `begins` if the run
/// is where it began.
///
/// # Errors
/// As there.
pub(crate) fn tangent<S: Runnable<N>, const N: usize>(
    run: &AnyRun<S, N>,
    begins: bool,
    steps: u64,
    parameters: &[usize],
    goes_on: &mut dyn FnMut() -> bool,
) -> AtEnd<S, Vec<Vec<f64>>, N> {
    check_free::<S, N>(run.t())?;
    let mut tangent = varied(run, begins, parameters)?;
    for _ in 0..steps {
        if !goes_on() {
            return Ok(None);
        }
        tangent.step()?;
    }
    let of_node = |of: &Variation<N>| of.q.iter().chain(&of.p).copied().collect();
    let found = tangent.variations().iter().map(of_node).collect();
    Ok(Some((tangent.run().clone(), found)))
}

/// Steps of a stretch of a gradient, whose states are all kept.
const STRETCH: u64 = 2048;

/// The gradient of a linear function of the node after steps, by one backward pass, as
/// [`Session::gradient`](crate::Session::gradient).
///
/// # Errors
/// As there.
pub(crate) fn gradient<S: Runnable<N>, const N: usize>(
    run: &AnyRun<S, N>,
    begins: bool,
    (steps, mut slope): (u64, Covector<N>),
    parameters: &[usize],
    goes_on: &mut dyn FnMut() -> bool,
) -> AtEnd<S, Vec<f64>, N> {
    check_free::<S, N>(run.t())?;
    let names: Vec<&'static str> =
        parameters.iter().filter_map(|index| run.system().parameters().get(*index).copied()).collect();
    // The run at the start of each stretch; the pass goes back from the last one.
    let (mut ahead, mut stretches, mut left) = (run.clone(), Vec::new(), steps);
    while left > 0 {
        let few = left.min(STRETCH);
        stretches.push((ahead.clone(), few));
        for _ in 0..few {
            if !goes_on() {
                return Ok(None);
            }
            ahead.single_step()?;
        }
        left -= few;
    }
    let mut sums = vec![0.0; names.len()];
    for (run, few) in stretches.iter().rev() {
        // A stretch takes as long as on the way ahead.
        if !(0..*few).all(|_| goes_on()) {
            return Ok(None);
        }
        let objective = AtTheEnd { steps: *few, slope, parameters: &names };
        let found = derivatives::gradient(run, *few, usize::MAX, &objective)?;
        slope = found.start;
        for of_a_step in &found.parameters {
            sums.iter_mut().zip(of_a_step).for_each(|(sum, slope)| *sum += slope);
        }
        // The sum includes a change of the kept energy, by H at the start of each stretch.
        let changed = Tangent::from_change(run.clone(), directions(parameters))?;
        for (sum, direction) in sums.iter_mut().zip(&changed.variations()[2 * N..]) {
            *sum -= slope.energy * direction.energy;
        }
    }
    let directions = varied(run, begins, parameters)?;
    let mut of: Vec<f64> = directions.variations().iter().map(|direction| slope.of(direction)).collect();
    of[2 * N..].iter_mut().zip(&sums).for_each(|(of, sum)| *of += sum);
    Ok(Some((ahead, of)))
}

/// A linear function of the node at the end.
struct AtTheEnd<'a, const N: usize> {
    steps: u64,
    slope: Covector<N>,
    parameters: &'a [&'static str],
}

impl<S: Runnable<N>, const N: usize> Objective<AnyMethod<S, N>, S, N> for AtTheEnd<'_, N> {
    fn parameters(&self) -> &[&str] {
        self.parameters
    }

    fn slope(&self, step: u64, _state: &State<N>) -> Covector<N> {
        if step == self.steps { self.slope } else { Covector::zero() }
    }
}

/// The directions of the coordinates, the momenta, and the parameters of these indices.
fn directions<const N: usize>(parameters: &[usize]) -> Vec<Variation<N>> {
    Variation::of_state().into_iter().chain(parameters.iter().copied().map(Variation::of_index)).collect()
}

/// The run with its directions. Where it began, the energy that it keeps follows from its start; later it changes as H
/// does.
///
/// # Errors
/// As [`Tangent::from_start`] and [`Tangent::from_change`].
fn varied<S: Runnable<N>, const N: usize>(
    run: &AnyRun<S, N>,
    begins: bool,
    parameters: &[usize],
) -> Result<Tangent<AnyMethod<S, N>, S, N>, StepError> {
    let of = if begins { Tangent::from_start } else { Tangent::from_change };
    of(run.clone(), directions(parameters))
}
