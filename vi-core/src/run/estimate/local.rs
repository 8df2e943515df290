//! The error of one step, by two steps of half its length from the same node.

use crate::angles;
use crate::error::StepError;
use crate::lagrangian::Lagrangian;
use crate::method::Method;
use crate::node::Node;
use crate::real::Scalar;
use crate::run::{DenseOutput as _, Run};
use crate::state::State;
use nalgebra::SVector;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

/// Relative energy error from which on it counts as an error of the step. Smaller ones may be rounding of a large
/// constant in H.
const GROSS: f64 = 1e-3;
/// Part of the displacement of a step by which the force is probed.
const PROBE: f64 = 1e-4;

/// The error of one step, for each coordinate. Infinite if its half steps have no solution, because the step is too
/// long to measure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LocalError<const N: usize> {
    /// Error of the coordinates.
    pub q: SVector<f64, N>,
    /// Error of the velocities times the length of the step.
    pub hv: SVector<f64, N>,
}

/// Result of a measurement.
pub(super) struct Measurement<const N: usize> {
    /// The larger error of q and h·v.
    pub(super) error: SVector<f64, N>,
    pub(super) of: LocalError<N>,
    /// The length of the step; zero if its error is unknown.
    pub(super) h: f64,
    /// `h v` and `|p v|` at the end of the step.
    pub(super) hv: SVector<f64, N>,
    pub(super) action: SVector<f64, N>,
    /// `|∂(L_q + f)_i/∂q_i|` at the end of the step.
    pub(super) stiffness: SVector<f64, N>,
    /// `|H1 − H0|` of a system that conserves H, relative to the energy, if it exceeds [`GROSS`]; else zero.
    pub(super) energy: f64,
}

impl<const N: usize> Measurement<N> {
    fn unknown() -> Self {
        let infinite = SVector::repeat(f64::INFINITY);
        let of = LocalError { q: infinite, hv: infinite };
        let zeros = SVector::zeros();
        Self { error: infinite, of, h: 0.0, hv: zeros, action: zeros, stiffness: zeros, energy: 0.0 }
    }
}

impl<M: Method<S, N, T>, S: Lagrangian<N, T> + Copy, const N: usize, T: Scalar> Run<M, S, N, T> {
    /// The error of the next step, for each coordinate in its own unit. The run does not change.
    ///
    /// # Errors
    /// The error of the next step. If only its half steps fail, its error is infinite.
    pub fn local_error(&self) -> Result<LocalError<N>, StepError> {
        let mut ahead = self.clone();
        ahead.single_step()?;
        let before = angles::reduced_node(&self.system, &self.node);
        Ok(measured(self, &self.memory, [&before, &ahead.node]).of)
    }
}

/// Measures the step between two nodes. The half steps start from guesses by `memory`.
#[inline(never)]
pub(super) fn measured<M: Method<S, N, T>, S: Lagrangian<N, T> + Copy, const N: usize, T: Scalar>(
    run: &Run<M, S, N, T>,
    memory: &M::Memory,
    [before, after]: [&Node<N, T>; 2],
) -> Measurement<N> {
    let fresh = || {
        // Stages of a long step can give a guess from which the iteration of a half step diverges.
        let mut node = *before;
        let memory = run.method.begin(&run.system, &mut node, run.h)?;
        compared(run, &memory, [before, after])
    };
    compared(run, memory, [before, after]).or_else(|_| fresh()).unwrap_or_else(|_| Measurement::unknown())
}

/// Compares the step with two half steps.
///
/// # Errors
/// The reason why a half step or a velocity has no solution.
fn compared<M: Method<S, N, T>, S: Lagrangian<N, T> + Copy, const N: usize, T: Scalar>(
    run: &Run<M, S, N, T>,
    memory: &M::Memory,
    [before, after]: [&Node<N, T>; 2],
) -> Result<Measurement<N>, StepError> {
    let Run { method, system, h: of_run, .. } = run;
    let h = duration(before, after);
    let half = h * T::real(0.5);
    let (middle, memory) = method.step_of(system, (before, memory), [half, *of_run])?;
    let start = (before.state(), before.state().velocity(system)?);
    let unresolved = unresolved(run, &start, (&middle, &memory, half))?;
    let (end, _) = method.step_of(system, (&middle, &memory), [duration(&middle, after), *of_run])?;
    let v = after.state().velocity(system)?;
    let better = end.state().velocity(system)?;
    let halved = 2.0_f64.powi(i32::try_from(method.facts().order).unwrap_or(i32::MAX));
    let factor = halved / (halved - 1.0);
    let length = h.to_f64();
    // The low parts carry the digits beyond the precision of a number.
    let q = (after.q - end.q) + (after.q_low - end.q_low);
    let q = q.map(|entry| known(factor * entry.to_f64()));
    let error_of_hv = (v - better).map(|entry| known(factor * length * entry.to_f64()));
    let hv = v.map(|entry| length * entry.to_f64());
    let action = v.zip_map(&after.p, |v, p| (v.to_f64() * p.to_f64()).abs());
    let stiffness = stiffness(system, after, &hv);
    let energy = energy_error(method, system, [start, (after.state(), v)], action.sum());
    let error = q.zip_map(&error_of_hv, f64::max).zip_map(&unresolved, f64::max);
    Ok(Measurement { error, of: LocalError { q, hv: error_of_hv }, h: length, hv, action, stiffness, energy })
}

/// For each coordinate, `h |u'(t0) − v0|` of the half step with the dense output u, if that exceeds half of the
/// displacement; zero otherwise.
///
/// If a step is too stiff by orders of magnitude, its stages and those of its halves miss the motion. With an even
/// number of stages both then return the state from which they started, so that their difference hides the error.
fn unresolved<M: Method<S, N, T>, S: Lagrangian<N, T> + Copy, const N: usize, T: Scalar>(
    run: &Run<M, S, N, T>,
    (before, v): &(State<N, T>, SVector<T, N>),
    (middle, memory, half): (&Node<N, T>, &M::Memory, T),
) -> Result<SVector<f64, N>, StepError> {
    let Run { method, system, .. } = run;
    let output = method.dense_output(system, before, middle, half, memory)?;
    let after = middle.state().velocity(system)?;
    let missed = output.velocity(before.t) - v;
    Ok(SVector::from_fn(|i, _| {
        let [missed, before, after] = [missed[i], v[i], after[i]].map(|speed| (half * speed).to_f64().abs());
        if missed > 0.5 * before.max(after) { 2.0 * missed } else { 0.0 }
    }))
}

/// `|H1 − H0|` of a step, relative to the larger of |H| and `Σ |p v|`, if that exceeds [`GROSS`]. Zero if H changes along
/// the motion.
///
/// A step and its halves that do not evaluate the force inside a wall end at the place of the motion without the wall:
/// only the energy shows the error.
fn energy_error<M: Method<S, N, T>, S: Lagrangian<N, T> + Copy, const N: usize, T: Scalar>(
    method: &M,
    system: &S,
    ends: [(State<N, T>, SVector<T, N>); 2],
    action: f64,
) -> f64 {
    if !system.conserves_energy() || method.facts().has_reactions {
        return 0.0;
    }
    let [before, after] = ends.map(|(State { t, q, .. }, v)| system.energy(t, &q, &v).to_f64());
    // An energy may be infinite although the forces are not.
    if !(before.is_finite() && after.is_finite()) {
        return 0.0;
    }
    let error = known(after - before) / before.abs().max(after.abs()).max(action);
    if error > GROSS { error } else { 0.0 }
}

/// `|∂(L_q + f)_i/∂q_i|` of each coordinate at a node, by central differences over small parts of a displacement.
fn stiffness<S: Lagrangian<N, T>, const N: usize, T: Scalar>(
    system: &S,
    node: &Node<N, T>,
    displacement: &SVector<f64, N>,
) -> SVector<f64, N> {
    SVector::from_fn(|i, _| {
        let length = (PROBE * displacement[i].abs()).max(T::EPSILON.powf(2.0 / 3.0) * node.q[i].to_f64().abs());
        let force = |length: f64| {
            let mut q = node.q;
            q[i] += T::real(length);
            Some((system.flow(node.t, &q, &node.p).ok()?.force[i].to_f64(), q[i].to_f64()))
        };
        let (Some((above, right)), Some((below, left))) = (force(length), force(-length)) else { return 0.0 };
        let stiffness = ((above - below) / (right - left)).abs();
        if stiffness.is_finite() { stiffness } else { 0.0 }
    })
}

/// The size of an error; infinite for NaN.
fn known(error: f64) -> f64 {
    if error.is_nan() { f64::INFINITY } else { error.abs() }
}

/// Time from one node to another.
pub(super) fn duration<const N: usize, T: Scalar>(before: &Node<N, T>, after: &Node<N, T>) -> T {
    (after.t - before.t) + (after.t_low - before.t_low)
}
