//! Derivatives of runs.
//!
//! In: a run. Out: its tangent vectors, gradients and Lyapunov exponents as plain numbers, and the run at their end. With
//! constraints, the change of one coordinate alone is no motion: derivatives are those of the run from the nearest state
//! on the constraints.

use crate::erasable::Runnable;
use crate::method::{AnyMethod, AnyRun};
use crate::simulation::{End, Wanted};
use vi_core::derivatives::{self, Covector, Lyapunov, Objective, Tangent, Variation};
use vi_core::nalgebra::DMatrix;
use vi_core::{SVector, State, StepError};

/// A value at the end of some steps, and the run there; `None` if it was interrupted.
type AtEnd<S, Y, const N: usize> = Result<Option<(AnyRun<S, N>, Y)>, StepError>;

/// Derivatives of the end of some steps with respect to their start, as [`Session::tangent`](crate::Session::tangent).
/// `begins`: whether the run is at its start.
///
/// # Errors
/// As [`Session::tangent`](crate::Session::tangent).
pub(crate) fn tangent<S: Runnable<N>, const N: usize>(
    run: &AnyRun<S, N>,
    begins: bool,
    Wanted { end, parameters, has_velocities: [at_start, at_end] }: Wanted<'_>,
    goes_on: &mut dyn FnMut() -> bool,
) -> AtEnd<S, Vec<Vec<f64>>, N> {
    let mut tangent = varied(run, begins, parameters, at_start)?;
    check_ahead(run, end)?;
    let mut taken = 0;
    while is_before(end, tangent.run(), taken) {
        if !goes_on() {
            return Ok(None);
        }
        tangent.step()?;
        taken += 1;
    }
    let rows = ended(&mut tangent, end, at_end)?;
    Ok(Some((tangent.run().clone(), rows)))
}

/// Second derivatives of the weighted end of at most one step, as [`Session::curvature`](crate::Session::curvature).
///
/// # Errors
/// As [`Session::curvature`](crate::Session::curvature).
pub(crate) fn curvature<S: Runnable<N>, const N: usize>(
    run: &AnyRun<S, N>,
    Wanted { end, parameters, has_velocities }: Wanted<'_>,
    weights: &[f64],
) -> Result<Option<DMatrix<f64>>, StepError> {
    let steps = match end {
        End::Steps(steps @ ..=1) if !has_velocities[0] => steps,
        _ => return Ok(None),
    };
    let before = *run.node();
    let varies = |index: &usize| *index >= 2 * N || index % N < weights.len() / 2;
    let directions = directions(run, parameters).into_iter().enumerate().filter(|(index, _)| varies(index));
    let directions: Vec<_> = directions.map(|(_, direction)| direction).collect();
    let mut after = run.clone();
    if steps == 1 {
        after.step()?;
    }
    // The coordinates at rest have no weight.
    let (of_q, of_second) = weights.split_at(weights.len() / 2);
    let [q, second] = [of_q, of_second].map(|of| SVector::from_fn(|row, _| of.get(row).copied().unwrap_or(0.0)));
    let mut slope = Covector { q, p: second, ..Covector::zero() };
    let mut sum = DMatrix::zeros(directions.len(), directions.len());
    if has_velocities[1] {
        let (state, mut at_end) = (after.node().state(), directions.clone());
        if steps == 1 {
            after.vary(&before, &mut at_end)?;
        }
        let Some(found) = derivatives::velocity_curvature(after.system(), &state, &at_end, [&q, &second])? else {
            return Ok(None);
        };
        (slope, sum) = found;
    }
    if steps == 1 {
        let Some(of_step) = after.curvature(&before, &directions, &slope)? else { return Ok(None) };
        sum += of_step;
    }
    Ok(Some(sum))
}

/// Derivatives at times, which do not vary, as [`Session::tangents_at`](crate::Session::tangents_at).
///
/// # Errors
/// As [`Session::tangents_at`](crate::Session::tangents_at).
pub(crate) fn tangents_at<S: Runnable<N>, const N: usize>(
    run: &AnyRun<S, N>,
    begins: bool,
    (times, parameters): (&[f64], &[usize]),
    has_velocities: [bool; 2],
    goes_on: &mut dyn FnMut() -> bool,
) -> AtEnd<S, Vec<Vec<Vec<f64>>>, N> {
    let [at_start, at_end] = has_velocities;
    let mut tangent = varied(run, begins, parameters, at_start)?;
    let mut found = Vec::with_capacity(times.len());
    for t in times {
        let end = End::Time(*t);
        check_ahead(tangent.run(), end)?;
        while is_before(end, tangent.run(), 0) {
            if !goes_on() {
                return Ok(None);
            }
            tangent.step()?;
        }
        // The run keeps its own steps.
        found.push(ended(&mut tangent.clone(), end, at_end)?);
    }
    Ok(Some((tangent.run().clone(), found)))
}

/// Checks that an end is not behind the run.
///
/// # Errors
/// As [`vi_core::Run::check_ahead`].
fn check_ahead<S: Runnable<N>, const N: usize>(run: &AnyRun<S, N>, end: End<'_>) -> Result<(), StepError> {
    match end {
        End::Steps(_) => Ok(()),
        End::Time(t) | End::Crossing(_, t) => run.check_ahead(t),
    }
}

/// Whether a run that has taken some steps takes another one before its end. [`ended`] takes the last ones to a time.
fn is_before<S: Runnable<N>, const N: usize>(end: End<'_>, run: &AnyRun<S, N>, taken: u64) -> bool {
    match end {
        End::Steps(steps) => taken < steps,
        End::Time(t) | End::Crossing(_, t) => (run.time_to(t) - 2.0 * run.longest()) * run.h().signum() > 0.0,
    }
}

/// Moves tangent vectors to the end, and returns their coordinates, momenta, or velocities if wanted, and times.
///
/// # Errors
/// As [`Session::tangent`](crate::Session::tangent).
fn ended<S: Runnable<N>, const N: usize>(
    tangent: &mut Tangent<AnyMethod<S, N>, S, N>,
    end: End<'_>,
    has_velocities: bool,
) -> Result<Vec<Vec<f64>>, StepError> {
    match end {
        End::Steps(_) => {}
        End::Time(t) => drop(tangent.until(t)?),
        End::Crossing(section, t) => {
            let because = "an event of a derivative is a coordinate or a velocity that crosses a value";
            let event = section.smooth_event().ok_or(StepError::NoDerivative { t, because })?;
            // The step ends past the crossing: at its time rounding decides the side.
            tangent.until_event(&event, t + tangent.run().h())?;
        }
    }
    let velocities = has_velocities.then(|| tangent.velocities()).transpose()?;
    let of_node = |(direction, of): (usize, &Variation<N>)| {
        let second = velocities.as_ref().map_or(&of.p, |of| &of[direction]);
        of.q.iter().chain(second).chain([&of.t]).copied().collect()
    };
    Ok(tangent.variations().iter().enumerate().map(of_node).collect())
}

/// The largest Lyapunov exponents of the first coordinates over some steps, as
/// [`Session::lyapunov`](crate::Session::lyapunov).
///
/// # Errors
/// As [`Session::lyapunov`](crate::Session::lyapunov).
pub(crate) fn lyapunov<S: Runnable<N>, const N: usize>(
    run: &AnyRun<S, N>,
    steps: u64,
    [count, coordinates]: [usize; 2],
    goes_on: &mut dyn FnMut() -> bool,
) -> AtEnd<S, Vec<f64>, N> {
    let mut of = Lyapunov::of_first(run.clone(), count, coordinates.min(N))?;
    for _ in 0..steps {
        if !goes_on() {
            return Ok(None);
        }
        of.advance(1)?;
    }
    Ok(Some((of.run().clone(), of.exponents())))
}

/// Number of steps between two checkpoints of a gradient; the states of these steps are all stored.
const STRETCH: u64 = 2048;

/// The gradient of a linear function of the end of some steps, by one backward pass, as
/// [`Session::gradient`](crate::Session::gradient).
///
/// # Errors
/// As [`Session::gradient`](crate::Session::gradient).
pub(crate) fn gradient<S: Runnable<N>, const N: usize>(
    run: &AnyRun<S, N>,
    begins: bool,
    Wanted { end, parameters, has_velocities: [at_start, at_end] }: Wanted<'_>,
    slope: &[f64],
    goes_on: &mut dyn FnMut() -> bool,
) -> AtEnd<S, Vec<f64>, N> {
    let names: Vec<&'static str> =
        parameters.iter().filter_map(|index| run.system().parameters().get(*index).copied()).collect();
    check_ahead(run, end)?;
    // The run at the start of each stretch; the pass goes back from the last one.
    let (mut ahead, mut stretches, mut taken) = (run.clone(), Vec::new(), 0);
    while is_before(end, &ahead, taken) {
        if !goes_on() {
            return Ok(None);
        }
        match stretches.last_mut() {
            Some((_, few)) if *few < STRETCH => *few += 1,
            _ => stretches.push((ahead.clone(), 1)),
        }
        ahead.single_step()?;
        taken += 1;
    }
    // Over the last steps to a time or an event, and to velocities, tangent vectors of all directions.
    let mut all = Variation::of_state();
    all.extend([Variation { energy: 1.0, ..Variation::zero() }, Variation { t: 1.0, ..Variation::zero() }]);
    all.extend(directions(run, parameters).drain(2 * N..));
    let mut last = Tangent::new(ahead, all);
    last.project()?;
    let rows = ended(&mut last, end, at_end)?;
    let changes: Vec<f64> = rows.iter().map(|row| row.iter().zip(slope).map(|(of, slope)| of * slope).sum()).collect();
    let (state, of_parameters) = changes.split_at(2 * N + 2);
    let mut slope = Covector {
        t: state[2 * N + 1],
        q: SVector::from_fn(|row, _| state[row]),
        p: SVector::from_fn(|row, _| state[N + row]),
        energy: state[2 * N],
    };
    let mut sums = of_parameters.to_vec();
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
        let changed = Tangent::from_change(run.clone(), directions(run, parameters))?;
        for (sum, direction) in sums.iter_mut().zip(&changed.variations()[2 * N..]) {
            *sum -= slope.energy * direction.energy;
        }
    }
    let directions = varied(run, begins, parameters, at_start)?;
    let mut of: Vec<f64> = directions.variations().iter().map(|direction| slope.of(direction)).collect();
    of[2 * N..].iter_mut().zip(&sums).for_each(|(of, sum)| *of += sum);
    Ok(Some((last.run().clone(), of)))
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

/// The directions of the coordinates, the momenta, and the parameters of these indices, as in [`Wanted`].
fn directions<S: Runnable<N>, const N: usize>(run: &AnyRun<S, N>, parameters: &[usize]) -> Vec<Variation<N>> {
    let count = run.system().parameters().len();
    let of = |index: &usize| match index.checked_sub(count) {
        None => Variation::of_index(*index),
        Some(0) => Variation::of_length(),
        Some(_) => Variation { t: 1.0, ..Variation::zero() },
    };
    Variation::of_state().into_iter().chain(parameters.iter().map(of)).collect()
}

/// The run with its directions, which are moved to the nearest admissible ones. With `has_velocities` the second half of
/// those of the state is of velocities, and parameters vary with constant velocities. At the start of the run the
/// energy that it keeps follows from the start; later it changes as H does.
///
/// # Errors
/// As [`Tangent::project`], [`Tangent::from_start`] and [`Tangent::from_change`].
fn varied<S: Runnable<N>, const N: usize>(
    run: &AnyRun<S, N>,
    begins: bool,
    parameters: &[usize],
    has_velocities: bool,
) -> Result<Tangent<AnyMethod<S, N>, S, N>, StepError> {
    let directions = directions(run, parameters);
    let velocities: Vec<SVector<f64, N>> = directions.iter().map(|of| of.p).collect();
    let mut tangent = Tangent::new(run.clone(), directions);
    tangent.project()?;
    if has_velocities {
        tangent.set_velocities(&velocities)?;
        tangent.project()?;
    }
    let of = if begins { Tangent::from_start } else { Tangent::from_change };
    of(run.clone(), tangent.variations().to_vec())
}
