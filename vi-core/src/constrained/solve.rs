//! The solution of a step with constraints: Newton iteration to the rounding floor, then the projection of the momenta.
//!
//! ```text
//! L_v(t1, q1, v1) = p1 = p0 + h Σ b_i F_i + Σ A_jᵀ λ_j + A_sᵀ μ        A_s v1 + a_s = 0
//! ```
//!
//! The Jacobian at the guess serves every iteration while the residual falls fast; otherwise it is evaluated anew. Its
//! determinant has the sign that it has for short steps. With the other sign, the root is a second one, in which a rod
//! has flipped over, or the constraints depend on each other in the step.

use super::equations::{Jacobian, Rows, Scales, expected_sign, signs, stage_velocity, unknowns};
use super::motion::{Velocity, unsolvable, velocity};
use super::reduced::Reduced;
use super::solved::{NEARLY_SOLVED, Solved, contracted};
use super::{bordered, diagonal, is_reduced, is_shortened, reaction_of};
use crate::error::{Residuals, StepError};
use crate::kind::Multipliers;
use crate::linear::{Bordered, Factored, Rectangular, Row, Unsolvable};
use crate::motion::Motion;
use crate::newton::FLOOR;
use crate::node::Node;
use crate::real::Rounded;
use crate::stepping::Convertible;
use crate::vector::weights;
use alloc::boxed::Box;
use alloc::vec::Vec;
use nalgebra::SVector;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

const ITERATIONS: u32 = 40;
const HALVINGS: u32 = 12;
/// The Jacobian serves a further iteration if the residual fell by this factor.
const FALLEN: f64 = 0.1;
/// Corrections without a halving after the last one that reduced the residual.
const WHOLE: u32 = 3;
/// A solution after more iterations has its determinant evaluated anew.
const FEW: u32 = 8;

/// Buffers of the solver. No result depends on them.
#[derive(Clone, Debug)]
pub struct Workspace {
    /// The number of unknown velocities.
    velocities: usize,
    /// Signs of the coefficients of a step.
    signs: [i8; 2],
    jacobian: Factored,
    /// The solver of midpoint steps in the impulses alone, if the system allows it.
    pub(super) reduced: Option<Box<Reduced>>,
    correction: Vec<f64>,
    /// The correction behind a trial.
    behind: Vec<f64>,
    trial: Vec<f64>,
    bordered: Bordered,
    /// The buffer of the unknowns of a step.
    pub(crate) unknowns: Vec<f64>,
}

/// The equations of a step at some unknowns. Their scales may be those of unknowns nearby.
struct Evaluated<S: Motion<N>, const N: usize, const STAGES: usize> {
    rows: Rows<S, N, STAGES>,
    scales: Scales<S, N, STAGES>,
    residual: f64,
}

/// The equations of a step at its solution.
pub(crate) struct Solution<R> {
    pub(crate) rows: R,
    pub(crate) residual: f64,
    pub(crate) iterations: u32,
}

/// Solves the equations of the step of length h from `node`, without its projection, with the guess in `u`; replaces it
/// by the unknowns. `sign` is the sign of the determinant of the bordered mass matrix. If `is_factored`, the workspace
/// holds the factors of a step of nearly this length from the same node. The step may be on another branch than that of
/// short ones. Returns the contraction, too: the largest ratio of two residuals in turn, above the noise of rounding.
///
/// # Errors
/// [`StepError::NotConverged`], [`StepError::Singular`], [`StepError::NonFinite`].
pub(crate) fn unprojected<S, const N: usize, const STAGES: usize>(
    system: &S,
    (node, h, sign): (&Node<N>, f64, i8),
    u: &mut Vec<f64>,
    workspace: &mut Workspace,
    mut is_factored: bool,
) -> Result<(Solution<Rows<S, N, STAGES>>, f64), StepError>
where
    S: Convertible<N>,
{
    let of_short_steps = sign_of_short_steps::<S, N, STAGES>(system, sign, workspace);
    let start = system.constraint_gradients(node.t, &node.q);
    let rows = |u: &[f64]| Rows::<S, N, STAGES>::from_start(system, (node, h), &start, u);
    let evaluated = |u: &[f64], near: Option<&Scales<S, N, STAGES>>| {
        let rows = rows(u);
        let scales = near.copied().unwrap_or_else(|| rows.scales(system, (node, h), u));
        Evaluated { residual: rows.residual(&scales), rows, scales }
    };
    let mut at = evaluated(u, None);
    let (mut iterations, mut residuals, mut contraction) = (0, Residuals::new(), 0.0);
    let mut has_right_sign = is_factored && workspace.jacobian.determinant_sign() == of_short_steps;
    let failed = |iterations, residual, residuals: &Residuals| {
        let turn = turn(system, node, h);
        StepError::NotConverged { t: node.t, h, iterations, residual, residuals: *residuals, turn }
    };
    loop {
        residuals.push(at.residual);
        if at.residual.is_nan() {
            return Err(StepError::NonFinite { t: node.t, quantity: "step equation", expression: None });
        }
        if !is_factored {
            has_right_sign = workspace.factor(&at.rows, system, h, u) == of_short_steps;
        }
        let is_last = at.residual <= 1.0 || iterations == ITERATIONS;
        let before = at.residual;
        if is_last || !workspace.corrected(&mut at, u, evaluated) {
            if at.residual > FLOOR {
                at.residual = bounded::<S, N, STAGES>(system, node, h, u);
            }
            // A row at its rounding level hides that corrections reduce the residual of another.
            for _ in 0..WHOLE {
                if at.residual <= FLOOR || is_last {
                    break;
                }
                workspace.correct(&at.rows);
                workspace.move_to_trial(u, 1.0);
                core::mem::swap(u, &mut workspace.trial);
                at.rows = rows(u);
                // An error names the smallest one, never NaN.
                at.residual = at.residual.min(bounded::<S, N, STAGES>(system, node, h, u));
                has_right_sign = workspace.factor(&at.rows, system, h, u) == of_short_steps;
            }
            // False for NaN.
            if at.residual <= FLOOR {
                break;
            }
            return Err(failed(iterations, at.residual, &residuals));
        }
        iterations += 1;
        core::mem::swap(u, &mut workspace.trial);
        is_factored = at.residual <= FLOOR || at.residual < FALLEN * before;
        contraction = contracted(contraction, [before, at.residual]);
    }
    let Evaluated { rows: at, residual, .. } = at;
    if iterations > FEW || !has_right_sign {
        has_right_sign = workspace.factor(&at, system, h, u) == of_short_steps;
    }
    if has_right_sign {
        Ok((Solution { rows: at, residual, iterations }, contraction))
    } else if at.is_straight() {
        Err(unsolvable(Unsolvable::Singular, node.t))
    } else {
        Err(failed(iterations, residual, &residuals))
    }
}

/// The sign that the determinant of the Jacobian has in short steps.
fn sign_of_short_steps<S: Motion<N>, const N: usize, const STAGES: usize>(
    system: &S,
    sign: i8,
    workspace: &Workspace,
) -> i8 {
    let kept = [system.holonomic(), system.constraint_names().len()]
        .map(|count| (0..count).filter(|r| !system.is_dropped(*r)).count());
    expected_sign(workspace.signs, (sign, STAGES), kept)
}

/// Whether the determinant of the Jacobian at u has the sign that it has in short steps.
pub(super) fn has_sign_of_short_steps<S: Motion<N>, const N: usize, const STAGES: usize>(
    system: &S,
    (node, h, sign): (&Node<N>, f64, i8),
    u: &[f64],
    workspace: &mut Workspace,
) -> bool {
    let rows = Rows::<S, N, STAGES>::at(system, node, h, u);
    workspace.factor(&rows, system, h, u) == sign_of_short_steps::<S, N, STAGES>(system, sign, workspace)
}

/// The end of a solved step, with its projection, and the velocity there.
///
/// # Errors
/// As [`unprojected`].
pub(crate) fn projected<S, const N: usize, const STAGES: usize>(
    system: &S,
    (node, h, sign): (&Node<N>, f64, i8),
    (solution, u): (&Solution<Rows<S, N, STAGES>>, &[f64]),
    workspace: &mut Workspace,
) -> Result<(Solved<N, Multipliers<S, N>>, SVector<f64, N>), StepError>
where
    S: Motion<N>,
{
    let Solution { rows: at, residual, iterations } = solution;
    let (t, q) = at.end();
    let p = node.p + (node.p_low + at.increment);
    let projected = velocity(system, (t, &q, &p), &stage_velocity(u, STAGES - 1), &mut workspace.bordered)?;
    let Velocity { v, momentum, mut mu, residual: of_velocity } = projected;
    if let Some((constraint, residual)) = system.broken(t, &q, &v) {
        let constraint = system.constraint_names()[constraint];
        return Err(StepError::DroppedConstraint { t, constraint, residual });
    }
    if workspace.bordered.determinant_sign() != sign {
        if at.is_straight() {
            return Err(unsolvable(Unsolvable::Singular, node.t));
        }
        let (iterations, residual, residuals) = (*iterations, *residual, Residuals::new());
        let turn = turn(system, node, h);
        return Err(StepError::NotConverged { t: node.t, h, iterations, residual, residuals, turn });
    }
    let gradients = at.end_gradients();
    let mut end = *node;
    end.advance(h, &at.velocity, &(at.increment + reaction_of(gradients, mu.as_ref())));
    // The increment of the momenta was rounded. Its part across the constraints goes into a second, tiny impulse.
    let mut lost = (momentum - end.p) - end.p_low;
    let mut last = mu;
    last.as_mut().fill(0.0);
    workspace.bordered.solve(&mut lost, last.as_mut());
    for (mu, last) in mu.as_mut().iter_mut().zip(last.as_mut()) {
        *last = -*last;
        *mu += *last;
    }
    end.add_momentum(&reaction_of(gradients, last.as_ref()));
    end.check_finite(node.t)?;
    Ok((Solved { end, mu, residual: residual.max(of_velocity), iterations: *iterations }, v))
}

impl Workspace {
    /// Allocates for the steps of a system.
    pub(crate) fn new<S: Motion<N>, const N: usize, const STAGES: usize>(system: &S) -> Self {
        let constraints = system.constraint_names().len();
        let unknowns = unknowns::<N, STAGES>(constraints);
        Self {
            velocities: N * STAGES,
            signs: signs::<STAGES>(),
            jacobian: Factored::new(system.blocks(), N + constraints, STAGES),
            reduced: None,
            correction: vec![0.0; unknowns],
            behind: vec![0.0; unknowns],
            trial: vec![0.0; unknowns],
            bordered: bordered(system),
            unknowns: vec![0.0; unknowns],
        }
    }

    /// The same for fixed steps from a node on, in the impulses alone if the system has such steps.
    pub(crate) fn of_steps<S: Motion<N>, const N: usize, const STAGES: usize>(system: &S, node: &Node<N>) -> Self {
        let reduced = if STAGES == 1 { Reduced::new(system, node).map(Box::new) } else { None };
        Self { reduced, ..Self::new::<S, N, STAGES>(system) }
    }

    /// Factors the Jacobian at u, and returns the sign of its determinant.
    pub(crate) fn factor<S: Motion<N>, const N: usize, const STAGES: usize>(
        &mut self,
        at: &Rows<S, N, STAGES>,
        system: &S,
        h: f64,
        u: &[f64],
    ) -> i8 {
        let sizes = [N + system.constraint_names().len(), STAGES];
        self.jacobian.factor(sizes, &Jacobian { rows: at, system, h, u });
        self.jacobian.determinant_sign()
    }

    /// Replaces rows of the equations, in their order, by the solution of the linear system of the factored Jacobian, in
    /// the order of the unknowns. NaN if it has no factors.
    pub(crate) fn solve(&mut self, rows: &mut [f64]) {
        let (b, c) = rows.split_at_mut(self.velocities);
        self.jacobian.solve(b, c);
    }

    /// Writes u less a correction to `trial`: the longest of its halves that reduces the residual, or has a shorter
    /// correction behind it. Replaces the equations by those there; false if there is none.
    #[inline(always)]
    fn corrected<S: Motion<N>, const N: usize, const STAGES: usize>(
        &mut self,
        at: &mut Evaluated<S, N, STAGES>,
        u: &[f64],
        evaluated: impl Fn(&[f64], Option<&Scales<S, N, STAGES>>) -> Evaluated<S, N, STAGES>,
    ) -> bool {
        let Evaluated { rows, scales, residual } = &*at;
        let (residual, near) = (*residual, Some(scales).filter(|_| *residual <= NEARLY_SOLVED));
        self.correct(rows);
        // Near the floor a shorter correction changes nothing.
        let halvings = if residual <= FLOOR { 0 } else { HALVINGS };
        for halved in 0..=halvings {
            let part = 0.5_f64.powi(i32::try_from(halved).unwrap_or(0));
            self.move_to_trial(u, part);
            let next = evaluated(&self.trial, near);
            if is_reduced(next.residual, residual) || residual > FLOOR && self.brings_nearer(rows, &next.rows, part) {
                *at = next;
                return true;
            }
        }
        false
    }

    /// Computes the correction of these rows.
    fn correct<S: Motion<N>, const N: usize, const STAGES: usize>(&mut self, at: &Rows<S, N, STAGES>) {
        let mut correction = core::mem::take(&mut self.correction);
        at.write(&mut correction);
        self.solve(&mut correction);
        self.correction = correction;
    }

    /// Writes u less a part of the correction to `trial`.
    fn move_to_trial(&mut self, u: &[f64], part: f64) {
        for ((trial, u), entry) in self.trial.iter_mut().zip(u).zip(&self.correction) {
            *trial = u - entry * part;
        }
    }

    /// Whether the correction of the velocities at `next` is shorter than the last one, with the same factors.
    #[cold]
    fn brings_nearer<S: Motion<N>, const N: usize, const STAGES: usize>(
        &mut self,
        at: &Rows<S, N, STAGES>,
        next: &Rows<S, N, STAGES>,
        part: f64,
    ) -> bool {
        let weights = weights(&at.mass());
        let length = |correction: &[f64]| {
            let stages = (0..STAGES).map(|i| stage_velocity::<N, _>(correction, i).component_mul(&weights));
            stages.map(|part| part.norm_squared()).sum::<f64>().sqrt()
        };
        let mut behind = core::mem::take(&mut self.behind);
        next.write(&mut behind);
        self.solve(&mut behind);
        self.behind = behind;
        is_shortened(length(&self.behind), length(&self.correction), part)
    }
}

/// The largest row over its rounding-error bound, by running error analysis.
#[cold]
fn bounded<S, const N: usize, const STAGES: usize>(system: &S, node: &Node<N>, h: f64, u: &[f64]) -> f64
where
    S: Convertible<N>,
{
    let u: Vec<Rounded> = u.iter().map(|entry| Rounded::nearest(*entry)).collect();
    let node = node.map(Rounded::exact);
    Rows::<_, N, STAGES, Rounded>::at(&system.convert::<Rounded>(), &node, Rounded::exact(h), &u).bounded_residual()
}

/// The part of a step over which the turn of a gradient is measured.
const PART: f64 = 1.0 / 1024.0;

/// The angle in degrees by which the gradient of a constraint turns in a step of the length h, at the velocity of its
/// start. Lengths are by the diagonal of the mass matrix.
#[cold]
fn turn<S: Motion<N>, const N: usize>(system: &S, node: &Node<N>, h: f64) -> f32 {
    let Ok(flow) = system.flow(node.t, &node.q, &node.p) else { return 0.0 };
    let mass = diagonal(&system.point(node.t, &node.q, &flow.v).mass);
    let weights = mass.map(|entry| if entry > 0.0 { entry.sqrt().recip() } else { 1.0 });
    let (before, _) = system.constraint_gradients(node.t, &node.q);
    let (after, _) = system.constraint_gradients(node.t + h * PART, &(node.q + flow.v * (h * PART)));
    let angle = |(before, after): (Row<f64>, Row<f64>)| {
        let unit = |row: Row<f64>| row.dense::<N>().component_mul(&weights).normalize();
        let [before, after] = [unit(before), unit(after)];
        (after - before * before.dot(&after)).norm() / PART
    };
    let largest = before.rows().zip(after.rows()).map(angle).fold(0.0, f64::max).to_degrees();
    #[allow(clippy::cast_possible_truncation)] // for a message
    let short = largest as f32;
    if short.is_finite() { short } else { 0.0 }
}
