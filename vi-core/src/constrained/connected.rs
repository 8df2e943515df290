//! Whether a step with constraints continues those of short lengths.
//!
//! A step has one solution near its guess if Newton iteration contracts fast, and one near its start if its stages are
//! resolved. The others are continued from short steps by [`branch::follow`].

use super::equations::{Rows, stage_velocity};
use super::guess::{Extrapolation, from_node};
use super::reduced;
use super::solve::{self, Solution, Workspace};
use super::solved::Solved;
use super::{bordered, diagonal};
use crate::error::StepError;
use crate::gauss::branch::{self, EQUAL, FAST, NEAR, Shorter, StepsFromNode, distance, is_resolved};
use crate::gauss::stages::{Stages, set};
use crate::kind::Multipliers;
use crate::node::Node;
use crate::stepping::Convertible;
use crate::vector::weights;
use alloc::vec::Vec;
use nalgebra::SVector;

/// Residual of an iteration that has stalled near its solution.
const STALLED: f64 = 1e4;

/// Solves the step of length h from `node`, and writes its unknowns to `u`. `sign` is the sign of the determinant of the
/// bordered mass matrix, `is_next` says that the step follows the last one of the workspace.
///
/// # Errors
/// The errors of [`unprojected`].
pub(crate) fn step<S, const N: usize, const STAGES: usize>(
    system: &S,
    (node, h, sign, is_next): (&Node<N>, f64, i8, bool),
    last: &Extrapolation,
    u: &mut Vec<f64>,
    workspace: &mut Workspace,
) -> Result<Solved<N, Multipliers<S, N>>, StepError>
where
    S: Convertible<N>,
{
    let of = (node, h, sign);
    let reduced = workspace.reduced.as_mut().filter(|_| system.has_point_masses() && sign > 0);
    let solved = reduced.and_then(|reduced| {
        last.guess(N, u);
        reduced::step(system, (node, h, is_next), u, reduced)
    });
    if let Some((solved, contraction)) = solved {
        if contraction <= FAST {
            return Ok(solved);
        }
        match continued::<S, N, STAGES>(system, of, u, workspace)? {
            None => return Ok(solved),
            Some(found) => *u = found,
        }
    } else {
        last.guess(0, u);
    }
    let solution = unprojected::<S, N, STAGES>(system, of, u, workspace, false)?;
    solve::projected(system, of, (&solution, u), workspace).map(|(solved, _)| solved)
}

/// Solves the equations of a step, without its projection, on the branch from h → 0. If `is_factored`, the workspace
/// holds the factors of a step of nearly this length from the same node.
///
/// # Errors
/// [`StepError::NotConverged`], [`StepError::Singular`], [`StepError::NonFinite`]; [`StepError::TooLong`] if the branch
/// ends at a shorter length, or has not been followed to this one.
pub(crate) fn unprojected<S, const N: usize, const STAGES: usize>(
    system: &S,
    of: (&Node<N>, f64, i8),
    u: &mut Vec<f64>,
    workspace: &mut Workspace,
    is_factored: bool,
) -> Result<Solution<Rows<S, N, STAGES>>, StepError>
where
    S: Convertible<N>,
{
    let (solution, contraction) = solve::unprojected::<S, N, STAGES>(system, of, u, workspace, is_factored)?;
    if contraction <= FAST {
        return Ok(solution);
    }
    match continued::<S, N, STAGES>(system, of, u, workspace)? {
        None => Ok(solution),
        Some(found) => {
            *u = found;
            solve::unprojected(system, of, u, workspace, false).map(|(solution, _)| solution)
        }
    }
}

/// The unknowns of the step that continues those of short lengths; `None` if they are these ones.
#[cold]
#[inline(never)]
fn continued<S, const N: usize, const STAGES: usize>(
    system: &S,
    (node, h, sign): (&Node<N>, f64, i8),
    u: &[f64],
    workspace: &mut Workspace,
) -> Result<Option<Vec<f64>>, StepError>
where
    S: Convertible<N>,
{
    let taken = velocities::<N, STAGES>(u);
    let flow = node.state().raw_flow(system)?;
    let weights = weights(&diagonal(&system.point(node.t, &node.q, &flow.v).mass)).into();
    if is_resolved(&taken, &weights) {
        return Ok(None);
    }
    let from = flow.v.data.0[0].map(|entry| [entry; STAGES]);
    let steps =
        &mut StepsFrom::<S, N, STAGES> { system, node, h, sign, v: flow.v, from: &from, weights, taken: u, workspace };
    let too_long = |part: f64| StepError::TooLong { t: node.t, h, longest: (part * h).abs() };
    let found = branch::follow(steps).map_err(too_long)?.unknowns;
    let is_same = distance([&taken, &velocities(&found)], &from, &weights) <= EQUAL;
    Ok(if is_same { None } else { Some(found) })
}

/// The velocities of the unknowns of a step.
pub(crate) fn velocities<const N: usize, const STAGES: usize>(u: &[f64]) -> Stages<N, STAGES> {
    let mut stages = [[0.0; STAGES]; N];
    (0..STAGES).for_each(|i| set(&mut stages, i, &stage_velocity(u, i)));
    stages
}

/// Steps of parts of the length h.
struct StepsFrom<'a, S, const N: usize, const STAGES: usize> {
    system: &'a S,
    node: &'a Node<N>,
    h: f64,
    /// The sign of the determinant of the bordered mass matrix.
    sign: i8,
    /// The velocity at the node.
    v: SVector<f64, N>,
    /// Stages equal to it.
    from: &'a Stages<N, STAGES>,
    weights: [f64; N],
    /// The unknowns of the solved step of the whole length.
    taken: &'a [f64],
    workspace: &'a mut Workspace,
}

/// The unknowns of a step, and the contraction of their iteration.
struct Unknowns {
    unknowns: Vec<f64>,
    contraction: f64,
}

impl<S, const N: usize, const STAGES: usize> StepsFrom<'_, S, N, STAGES>
where
    S: Convertible<N>,
{
    fn solved(&mut self, part: f64, mut unknowns: Vec<f64>) -> Option<Unknowns> {
        let Self { system, node, h, sign, workspace, .. } = self;
        let of = (*node, *h * part, *sign);
        match solve::unprojected::<S, N, STAGES>(*system, of, &mut unknowns, workspace, false) {
            Ok((_, contraction)) => Some(Unknowns { unknowns, contraction }),
            // A guess for the next part needs no more digits.
            Err(StepError::NotConverged { residual, .. })
                if residual < STALLED
                    && solve::has_sign_of_short_steps::<S, N, STAGES>(*system, of, &unknowns, workspace) =>
            {
                Some(Unknowns { unknowns, contraction: f64::INFINITY })
            }
            Err(_) => None,
        }
    }
}

impl<S, const N: usize, const STAGES: usize> StepsFromNode for StepsFrom<'_, S, N, STAGES>
where
    S: Convertible<N>,
{
    type Solution = Unknowns;

    fn short(&mut self, part: f64) -> Option<Unknowns> {
        let of = (self.node, self.h * part, &self.v);
        let guess = from_node::<S, N, STAGES>(self.system, of, &mut bordered(self.system)).ok()?;
        let step = self.solved(part, guess)?;
        let is_resolved = || is_resolved(&velocities::<N, STAGES>(&step.unknowns), &self.weights);
        (step.contraction <= FAST || is_resolved()).then_some(step)
    }

    fn longer(&mut self, part: f64, shorter: [&Shorter<Unknowns>; 2]) -> Option<Unknowns> {
        let [before, last] = shorter;
        let ahead = branch::ahead(part, shorter);
        // Impulses grow with the length.
        let of = |step: &Shorter<Unknowns>, index: usize| {
            let scale = if index < STAGES * N { 1.0 } else { part / step.part };
            step.step.unknowns[index] * scale
        };
        let extrapolated = |index: usize| of(last, index) + ahead * (of(last, index) - of(before, index));
        let guess: Vec<f64> = (0..last.step.unknowns.len()).map(extrapolated).collect();
        let near = velocities::<N, STAGES>(&guess);
        let whole = || Unknowns { unknowns: self.taken.to_vec(), contraction: 0.0 };
        let found = self.solved(part, guess).or_else(|| (part >= 1.0).then(whole));
        found.filter(|step| distance([&near, &velocities(&step.unknowns)], self.from, &self.weights) <= NEAR)
    }
}
