//! Tangent vectors of a solved Gauss step.
//!
//! In: the stages of the last step, and tangent vectors at its node. Out: tangent vectors at the next node. Let `C =
//! ∂L_v/∂q, M = ∂L_v/∂v, K = ∂F/∂q, B = ∂F/∂v` at each stage, and m, f the derivatives of L_v and F with respect to the
//! time and the parameters. The changes of the stage velocities solve
//!
//! ```text
//! C_i δQ_i + M_i δV_i + m_i = δp0 + h Σ_j a_ij δF_j        δQ_i = δq0 + h Σ_j a_ij δV_j        δF_j = K_j δQ_j + B_j δV_j + f_j
//! ```
//!
//! These S N equations have the same matrix for all directions. The step length h may vary too: then T_i, Q_i and the
//! momenta change at fixed V_j and F_j. The matrix differs from the simplified one of `newton`, because derivatives
//! must be exact at every stage.

use super::density::power;
use super::fixed_point::Equations;
use super::general::equations;
use super::points::ErasedSystem;
use super::solve::WIDE;
use super::stages::{
    AtStages, LOOPED, Stages, add_products, gathered, maximum, product, scaled, set, stage, sum, times, weights,
};
use super::tableau::Tableau;
use crate::derivatives::{Covector, Differentiable, Sought, TOGETHER, Variation, Varied, not_finite, singular};
use crate::error::StepError;
use crate::lagrangian::Lagrangian;
use crate::linear::{Matrix, row_by_row};
use crate::method::energy_gauss::{LengthSolver, Solver as Lengths};
use crate::method::gauss::{Solver, StageSolver};
use crate::method::{EnergyPreservingGauss, Gauss};
use crate::motion::{Motion, PointDerivatives};
use crate::node::Node;
use crate::real::{Dual, Lane, Lanes, Number};
use crate::run::Run;
use crate::stepping::Convertible;
use alloc::vec::Vec;
use nalgebra::{DMatrix, SVector};
use vi_dispatch::{Instructions, Loop};

impl<S, const N: usize, const STAGES: usize> Differentiable<S, N> for Gauss<STAGES>
where
    S: Convertible<N>,
{
    /// Allocates the joint matrix of all stages.
    fn vary(run: &Run<Self, S, N>, before: &Node<N>, variations: &mut [Variation<N>]) -> Result<(), StepError> {
        Solver::<S, N, STAGES>::vary(&run.system, (&run.node, &run.memory), before, variations)
    }

    fn curvature(
        run: &Run<Self, S, N>,
        before: &Node<N>,
        directions: &[Variation<N>],
        weights: &Covector<N>,
    ) -> Result<Option<DMatrix<f64>>, StepError> {
        Solver::<S, N, STAGES>::curvature(&run.system, (&run.node, &run.memory), before, (directions, weights))
    }
}

impl<S, const N: usize, const STAGES: usize> Differentiable<S, N> for EnergyPreservingGauss<STAGES>
where
    S: Convertible<N>,
{
    fn keeps_energy(&self) -> bool {
        true
    }

    /// As [`EnergyPreserving`](crate::EnergyPreserving); the shift is constant.
    fn vary(run: &Run<Self, S, N>, before: &Node<N>, variations: &mut [Variation<N>]) -> Result<(), StepError> {
        Lengths::<S, N, STAGES>::vary(run, before, variations)
    }

    fn vary_step_of(run: &Run<Self, S, N>, length: f64, variations: &mut [Variation<N>]) -> Result<(), StepError> {
        Lengths::<S, N, STAGES>::vary_given(run, length, Sought::Neither, variations)
    }

    fn vary_start(run: &Run<Self, S, N>, variations: &mut [Variation<N>]) -> Result<(), StepError> {
        Lengths::<S, N, STAGES>::vary_given(run, run.h(), Sought::Energy, variations)
    }
}

/// Maps tangent vectors at a node to those after an energy-preserving step of the length h, or a step of a given
/// length. `vary` maps them for a step whose length may vary, and adds the derivatives of its energies.
///
/// The energy equation and the unknown h border the equations of the step. These are solved at fixed h and for the
/// direction of h; one scalar equation gives δh.
pub(crate) fn vary_length<const N: usize, const STAGES: usize>(
    (t, h): (f64, f64),
    shift: f64,
    sought: Sought,
    variations: &mut [Variation<N>],
    vary: impl FnOnce(&mut [Variation<N>], &mut Vec<VariedEnergies>) -> Result<(), StepError>,
) -> Result<(), StepError> {
    let mut all: Vec<_> = variations.iter().map(|variation| Variation { h: 0.0, ..variation.clone() }).collect();
    all.push(Variation::of_length());
    let mut energies = Vec::with_capacity(all.len());
    vary(&mut all, &mut energies)?;
    let (Some(along_h), Some(energy_along_h)) = (all.pop(), energies.pop()) else { return Ok(()) };
    #[allow(clippy::cast_precision_loss)] // at most three stages
    let power_slope = 2.0 * STAGES as f64 * power::<STAGES>(h) / h;
    let schur = energy_along_h.start - power_slope * shift;
    for ((own, varied), energy) in variations.iter_mut().zip(&all).zip(&energies) {
        let of_h = match sought {
            Sought::Length => (own.energy - energy.start) / schur,
            Sought::Neither => own.h,
            Sought::Energy => {
                own.energy = energy.start + schur * own.h;
                continue;
            }
        };
        if !of_h.is_finite() {
            return Err(singular(t));
        }
        (own.t, own.q, own.p) = (varied.t, varied.q, varied.p);
        own.add(&along_h, of_h);
        own.energy += energy.work + energy_along_h.work * of_h;
    }
    Variation::check_finite(variations, t)
}

/// Derivatives of the energies of a step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct VariedEnergies {
    /// E0.
    pub(crate) start: f64,
    /// `E1 − E0`.
    pub(crate) work: f64,
}

/// Derivatives of the energies of the step of length h along `variations` of its node, with the derivatives of the velocities of its stages.
fn varied_energies<S, const N: usize, const STAGES: usize>(
    system: &S,
    at: &Solution<N, STAGES>,
    h: f64,
    variations: &[Variation<N>],
    velocities: &[Stages<N, STAGES>],
) -> Vec<VariedEnergies>
where
    S: Convertible<N>,
{
    let Tableau { b, c, .. } = const { &Tableau::<STAGES>::VALUES };
    let varied = Variation::system::<S, TOGETHER>(variations, system);
    let weights = weights::<STAGES>(h);
    let positions: Vec<_> = velocities.iter().map(|of| integrals::<N, STAGES, false>(of, &weights)).collect();
    let moved = at.moved();
    let mut start = Varied::fixed(0.0);
    let mut work = start;
    let of_h: Varied = Variation::number(variations, h, |variation| variation.h);
    for i in 0..STAGES {
        let t = Variation::number(variations, at.times[i], |variation| variation.t + c[i] * variation.h);
        let mut q = stage::<N, STAGES, f64>(&at.positions, i).map(Varied::fixed);
        let mut v = stage::<N, STAGES, f64>(&at.velocities, i).map(Varied::fixed);
        for (direction, variation) in variations.iter().enumerate() {
            for k in 0..N {
                let along_h = moved[k][i] * variation.h;
                q[k].slope.0[direction] = variation.q[k] + along_h + positions[direction][k][i];
                v[k].slope.0[direction] = velocities[direction][k][i];
            }
        }
        let energy = varied.energy(t, &q, &v);
        start += Dual::real(b[i]) * Dual { value: 0.0, ..energy };
        if !system.conserves_energy() {
            let gain = Varied::real(b[i]) * of_h * varied.power(t, &q, &v);
            start -= gain * Dual::real(1.0 - c[i]);
            work += gain;
        }
    }
    let of = |direction| VariedEnergies { start: start.slope.0[direction], work: work.slope.0[direction] };
    (0..variations.len()).map(of).collect()
}

/// Maps tangent vectors at a node to those after the Gauss step of length h with these stages, and optionally adds the
/// derivatives of its energies.
pub(crate) fn vary<S, const N: usize, const STAGES: usize>(
    system: &S,
    step: (&Node<N>, f64, &Stages<N, STAGES>),
    variations: &mut [Variation<N>],
    energies: Option<&mut Vec<VariedEnergies>>,
) -> Result<(), StepError>
where
    S: Convertible<N>,
{
    let mut linearized = Linearized::of(system, step);
    let Some(energies) = energies else { return linearized.vary(system, variations, None) };
    let mut add = |Linearized { at, h, .. }: &Linearized<N, STAGES>, from: &[Variation<N>], velocities: &[_]| {
        energies.extend(varied_energies(system, at, *h, from, velocities));
    };
    linearized.vary(system, variations, Some(&mut add))
}

/// Takes the velocities of the stages along tangent vectors at the start of a step.
pub(super) type Take<'a, const N: usize, const S: usize> =
    &'a mut dyn FnMut(&Linearized<N, S>, &[Variation<N>], &[Stages<N, S>]);

/// A solved step with the derivatives of its equations.
pub(super) struct Linearized<const N: usize, const S: usize> {
    /// Time of the start.
    t: f64,
    pub(super) h: f64,
    /// The number of moving coordinates. Those after them are at rest and have no equations.
    pub(super) moving: usize,
    pub(super) at: Solution<N, S>,
    /// The derivatives at the stages, then a buffer for the equations. On the heap: arrays of long systems would
    /// overflow the stack of a thread.
    rows: Vec<Stages<N, S>>,
}

impl<const N: usize, const STAGES: usize> Linearized<N, STAGES> {
    /// The step of length h from a node, with these stages.
    pub(super) fn of<S: Convertible<N>>(system: &S, (before, h, stages): (&Node<N>, f64, &Stages<N, STAGES>)) -> Self {
        let erased = ErasedSystem::of(system);
        let equations = equations(&erased, before, h, *stages);
        let at = Solution {
            times: times::<N, STAGES, false>(before, h),
            positions: equations.start(),
            velocities: equations.velocity(),
        };
        let mut rows = vec![[[0.0; STAGES]; N]; 4 * N + N * STAGES + TOGETHER];
        let derivatives = rows[..4 * N].as_chunks_mut::<N>().0;
        let are_found = S::SIDE_BY_SIDE && Instructions::detected().run(Differentiate { system, at: &at, derivatives });
        if !are_found || !are_finite(derivatives) {
            // Scalar numbers have sines and cosines of every angle; SIMD lanes reject large ones.
            differentiate_in_scalars(&erased, &at, derivatives);
        }
        Self { t: before.t, h, moving: system.moving(), at, rows }
    }

    /// C, M, K and B at the stages.
    pub(super) fn derivatives(&self) -> &Derivatives<N, STAGES> {
        self.rows[..4 * N].as_chunks().0
    }

    /// Maps tangent vectors at the start of the step to those at its end.
    pub(super) fn vary<S: Convertible<N>>(
        &mut self,
        system: &S,
        variations: &mut [Variation<N>],
        mut take: Option<Take<'_, N, STAGES>>,
    ) -> Result<(), StepError> {
        let Self { t, h, moving, .. } = *self;
        for variations in variations.chunks_mut(TOGETHER) {
            let explicit = explicit(system, &self.at, variations, t)?;
            let from = if take.is_some() { variations.to_vec() } else { Vec::new() };
            let (derivatives, equations) = self.rows.split_at_mut(4 * N);
            let derivatives = derivatives.as_chunks().0;
            let instructions = Instructions::detected();
            let are_found = if const { S::INTERPRETED } {
                instructions.run(Vary::<true, N, STAGES> { moving, derivatives, equations, h, explicit, variations })
            } else {
                instructions.run(Vary::<false, N, STAGES> { moving, derivatives, equations, h, explicit, variations })
            };
            if !are_found {
                // Excludes singular equations, and input that was not finite.
                Variation::check_finite(variations, t)?;
                return Err(self.unsolved());
            }
            if let Some(take) = &mut take {
                take(self, &from, &self.rows[4 * N + N * STAGES..]);
            }
        }
        Variation::check_finite(variations, t)
    }

    /// The error of equations without a solution.
    pub(super) fn unsolved(&self) -> StepError {
        if are_finite(self.derivatives()) { singular(self.t) } else { not_finite(self.t) }
    }
}

/// The stages of a solved step.
pub(super) struct Solution<const N: usize, const S: usize> {
    pub(super) times: [f64; S],
    positions: Stages<N, S>,
    pub(super) velocities: Stages<N, S>,
}

impl<const N: usize, const S: usize> Solution<N, S> {
    /// Derivative of the positions with respect to the length of the step at fixed velocities: `Σ_j a_ij V_j`.
    pub(super) fn moved(&self) -> Stages<N, S> {
        integrals::<N, S, false>(&self.velocities, &weights(1.0))
    }
}

/// Derivatives of L_v and F at the stages: C, M, K and B. Entry (k, l) is the derivative of component k with respect to
/// coordinate or velocity l, as a row of stages.
pub(super) type Derivatives<const N: usize, const S: usize> = [[Stages<N, S>; N]];

/// Whether every number is finite.
fn are_finite<const N: usize, const S: usize>(derivatives: &Derivatives<N, S>) -> bool {
    derivatives.as_flattened().as_flattened().as_flattened().iter().all(|entry| entry.is_finite())
}

/// The derivatives, one stage at a time.
fn differentiate_in_scalars<const N: usize, const S: usize>(
    system: &ErasedSystem<'_, N>,
    at: &Solution<N, S>,
    derivatives: &mut Derivatives<N, S>,
) {
    for i in 0..S {
        let [q, v] = [&at.positions, &at.velocities].map(|of| stage(of, i));
        put::<_, f64, N, S>(derivatives, i, &system.derivatives(at.times[i], &q, &v));
    }
}

/// The derivatives of all stages, with SIMD dispatch. Returns whether this succeeded.
struct Differentiate<'a, Y, const N: usize, const S: usize> {
    system: &'a Y,
    at: &'a Solution<N, S>,
    derivatives: &'a mut Derivatives<N, S>,
}

/// Largest matrix, in bytes, that is evaluated at all stages at once: a thread has a stack of two million.
const SIDE_BY_SIDE: usize = 1 << 16;

/// Bytes of a matrix for all stages.
const fn bytes<Y: Convertible<N>, const N: usize, const S: usize, const FUSED: bool>() -> usize {
    size_of::<<Y::In<Lanes<S, FUSED>> as Motion<N, Lanes<S, FUSED>>>::PointMatrix>()
}

impl<Y: Convertible<N>, const N: usize, const S: usize> Loop for Differentiate<'_, Y, N, S> {
    type Output = bool;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> bool {
        let Self { system, at, derivatives } = self;
        if const { N <= LOOPED } {
            // A local array cannot alias, so that the compiler vectorizes the loop over the stages.
            let mut matrices = [[[[0.0; S]; N]; N]; 4];
            put_all::<N, S, Lane<FUSED>, _>(&mut matrices, &system.convert(), at);
            derivatives.copy_from_slice(&matrices);
            true
        } else if const { (FUSED || WIDE) && bytes::<Y, N, S, FUSED>() <= SIDE_BY_SIDE } {
            put_all::<N, S, Lanes<S, FUSED>, _>(derivatives, &system.convert(), at);
            true
        } else {
            false
        }
    }
}

/// Sets the matrices of all evaluations.
#[inline(always)]
fn put_all<const N: usize, const S: usize, T: AtStages<S>, Y: Motion<N, T>>(
    derivatives: &mut Derivatives<N, S>,
    system: &Y,
    at: &Solution<N, S>,
) {
    for i in 0..T::EVALUATIONS {
        let [q, v] = [&at.positions, &at.velocities].map(|stages| gathered(N, stages, i));
        put(derivatives, i, &system.point_derivatives(T::of(&at.times, i), &q, &v));
    }
}

/// Sets the matrices C, M, K and B of an evaluation.
#[inline(always)]
fn put<D: Matrix<N, T>, T: AtStages<S>, const N: usize, const S: usize>(
    derivatives: &mut Derivatives<N, S>,
    evaluation: usize,
    of: &PointDerivatives<D>,
) {
    let PointDerivatives { momentum_dq, mass, force_dq, force_dv } = of;
    for (rows, matrix) in derivatives.iter_mut().zip([momentum_dq, mass, force_dq, force_dv]) {
        for k in 0..N {
            for l in 0..N {
                matrix.entry(k, l).put(&mut rows[k][l], evaluation);
            }
        }
    }
}

/// Derivatives of the equations with respect to the time, the length of the step and the parameters.
struct Explicit<const N: usize, const S: usize> {
    /// Derivatives of `L_v` and `L_q + f` at fixed positions and velocities, along each direction.
    slopes: [[Stages<N, S>; 2]; TOGETHER],
    /// Derivatives of positions and momenta at the stages with respect to the length, at fixed velocities and forces.
    moved: [Stages<N, S>; 2],
    /// Derivatives of positions and momenta at the end with respect to the length, at fixed velocities and forces.
    moved_end: [SVector<f64, N>; 2],
}

/// Evaluates these derivatives at the stages; `None` if time, length and parameters do not vary.
///
/// # Errors
/// As [`Variation::varying_system`], for the step from the time `t`.
fn explicit<S: Convertible<N> + Lagrangian<N>, const N: usize, const STAGES: usize>(
    system: &S,
    at: &Solution<N, STAGES>,
    variations: &[Variation<N>],
    t: f64,
) -> Result<Option<Explicit<N, STAGES>>, StepError> {
    let Some(varied) = Variation::varying_system(variations, system, t)? else { return Ok(None) };
    let c = const { &Tableau::<STAGES>::VALUES.c };
    let zeros = [[0.0; STAGES]; N];
    let mut slopes = [[zeros; 2]; TOGETHER];
    let mut force = zeros;
    for i in 0..STAGES {
        let t: Varied = Variation::number(variations, at.times[i], |variation| variation.t + c[i] * variation.h);
        let [q, v] = [&at.positions, &at.velocities].map(|of| stage::<N, STAGES, f64>(of, i).map(Dual::fixed));
        let point = varied.point(t, &q, &v);
        set(&mut force, i, &point.force.map(|force| force.value));
        for (direction, changes) in slopes.iter_mut().enumerate() {
            for k in 0..N {
                changes[0][k][i] = point.momentum[k].slope.0[direction];
                changes[1][k][i] = point.force[k].slope.0[direction];
            }
        }
    }
    let part = weights(1.0);
    let moved = [at.moved(), integrals::<N, STAGES, false>(&force, &part)];
    let moved_end = [&at.velocities, &force].map(|of| SVector::from_fn(|k, _| sum(&scaled(&part, &of[k]))));
    Ok(Some(Explicit { slopes, moved, moved_end }))
}

/// Maps tangent vectors at the start of a step to those at its end. Returns false, with unspecified vectors, if the
/// equations are singular. Coordinates may be at rest (`SOME_REST`) in systems that are known at run time only.
struct Vary<'a, const SOME_REST: bool, const N: usize, const S: usize> {
    moving: usize,
    derivatives: &'a Derivatives<N, S>,
    /// Buffer for the columns of the matrix and the right sides.
    equations: &'a mut [Stages<N, S>],
    h: f64,
    explicit: Option<Explicit<N, S>>,
    variations: &'a mut [Variation<N>],
}

impl<const SOME_REST: bool, const N: usize, const S: usize> Loop for Vary<'_, SOME_REST, N, S> {
    type Output = bool;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> bool {
        let Self { moving, derivatives, equations, h, explicit, variations } = self;
        let n = if const { SOME_REST } { moving } else { N };
        let [momentum_dq, mass, force_dq, force_dv] = derivatives else { return false };
        let weights = weights::<S>(h);
        let (columns, right) = equations.split_at_mut(N * S);
        for (l, columns) in columns.chunks_exact_mut(S).enumerate().take(n) {
            for (j, column) in columns.iter_mut().enumerate() {
                *column = self::column::<N, S, FUSED>([momentum_dq, mass, force_dq, force_dv], &weights, [l, j]);
            }
        }
        // Changes of the forces at fixed stage velocities.
        let mut forces = [[[0.0; S]; N]; TOGETHER];
        for (direction, variation) in variations.iter().enumerate() {
            let [mut momentum, mut force] = explicit.as_ref().map_or([[[0.0; S]; N]; 2], |of| of.slopes[direction]);
            let mut position = constant(&variation.q);
            if let Some(Explicit { moved: [position_dh, momentum_dh], .. }) = &explicit {
                for k in 0..N {
                    for i in 0..S {
                        position[k][i] += position_dh[k][i] * variation.h;
                        momentum[k][i] -= momentum_dh[k][i] * variation.h;
                    }
                }
            }
            add_products::<N, S, FUSED>(n, &mut momentum, momentum_dq, &position);
            add_products::<N, S, FUSED>(n, &mut force, force_dq, &position);
            right[direction] = missing::<N, S, FUSED>(&variation.p, &momentum, &force, &weights);
            forces[direction] = force;
        }
        let are_finite = eliminate::<N, S, FUSED>(n, &mut equations[..N * S + variations.len()], mass);
        for (direction, variation) in variations.iter_mut().enumerate() {
            let velocities = &equations[N * S + direction];
            let force = &mut forces[direction];
            add_products::<N, S, FUSED>(n, force, force_dq, &integrals::<N, S, FUSED>(velocities, &weights));
            add_products::<N, S, FUSED>(n, force, force_dv, velocities);
            for k in 0..N {
                variation.q[k] += sum(&scaled(&weights, &velocities[k]));
                variation.p[k] += sum(&scaled(&weights, &force[k]));
            }
            if let Some(Explicit { moved_end: [position_dh, momentum_dh], .. }) = &explicit {
                variation.t += variation.h;
                variation.q += position_dh * variation.h;
                variation.p += momentum_dh * variation.h;
            }
        }
        are_finite
    }
}

/// The column of the matrix for the velocity of coordinate l at stage j. Its entry i is `δ_ij M_i + h a_ij (C_i − B_j)
/// − h² Σ_m a_im a_mj K_m`.
#[inline(always)]
pub(super) fn column<const N: usize, const S: usize, const FUSED: bool>(
    [momentum_dq, mass, force_dq, force_dv]: [&[Stages<N, S>; N]; 4],
    weights: &[f64; S],
    [l, j]: [usize; 2],
) -> Stages<N, S> {
    let first = const { &Tableau::<S>::VALUES.first };
    // h a_ij
    let mut along = [0.0; S];
    for i in 0..S {
        along[i] = weights[j] * first[j][i];
    }
    let mut column = [[0.0; S]; N];
    for k in 0..N {
        row_by_row();
        let mut curved = [0.0; S];
        let mut entries = [0.0; S];
        for i in 0..S {
            curved[i] = weights[i] * along[i] * force_dq[k][l][i];
            entries[i] = along[i] * (force_dv[k][l][j] - momentum_dq[k][l][i]);
        }
        entries = product::<S, FUSED>(first, &curved, &entries);
        for i in 0..S {
            column[k][i] = -entries[i];
        }
        column[k][j] += mass[k][l][j];
    }
    column
}

/// The same vector at every stage.
#[inline(always)]
fn constant<const N: usize, const S: usize>(vector: &SVector<f64, N>) -> Stages<N, S> {
    let mut stages = [[0.0; S]; N];
    for k in 0..N {
        stages[k] = [vector[k]; S];
    }
    stages
}

/// `h Σ_j a_ij x_j` at the stages i.
#[inline(always)]
pub(super) fn integrals<const N: usize, const S: usize, const FUSED: bool>(
    x: &Stages<N, S>,
    weights: &[f64; S],
) -> Stages<N, S> {
    let first = const { &Tableau::<S>::VALUES.first };
    let mut integrals = [[0.0; S]; N];
    for k in 0..N {
        integrals[k] = product::<S, FUSED>(first, &scaled(weights, &x[k]), &[0.0; S]);
    }
    integrals
}

/// The right side of the equations: the change of the momenta by the forces minus the change of L_v.
#[inline(always)]
fn missing<const N: usize, const S: usize, const FUSED: bool>(
    p: &SVector<f64, N>,
    momentum: &Stages<N, S>,
    force: &Stages<N, S>,
    weights: &[f64; S],
) -> Stages<N, S> {
    let mut missing = integrals::<N, S, FUSED>(force, weights);
    for k in 0..N {
        for i in 0..S {
            missing[k][i] += p[k] - momentum[k][i];
        }
    }
    missing
}

/// A diagonal entry is the pivot unless another one exceeds it by this factor.
const FAVOURED: f64 = 4.0;

/// Scale factors that make rows comparable in any units: `1/√M_kk`, so that a positive mass matrix has no entry above
/// 1; for a zero diagonal, the inverse of the largest entry of the row.
#[cold]
fn comparable<const N: usize, const S: usize>(mass: &[Stages<N, S>; N]) -> [f64; N] {
    let mut weights = [1.0; N];
    for k in 0..N {
        let mut size = mass[k][k][0].abs();
        if size == 0.0 {
            size = mass[k].iter().fold(0.0, |largest: f64, row| largest.max(row[0].abs()));
        }
        if size > 0.0 && size.is_finite() {
            weights[k] = size.sqrt().recip();
        }
    }
    weights
}

/// Solves equations whose columns precede their right sides. Eliminates all rows but the pivot's, with partial pivoting
/// among rows scaled by the mass matrix; the right sides become the solutions. Returns whether all are finite, which is
/// false for a singular matrix. The coordinates behind the first `n` are at rest, with the mass 1: their right sides are
/// their solutions.
#[inline(always)]
pub(super) fn eliminate<const N: usize, const S: usize, const FUSED: bool>(
    n: usize,
    equations: &mut [Stages<N, S>],
    mass: &[Stages<N, S>; N],
) -> bool {
    // 1 for rows without a pivot so far, otherwise 0.
    let mut free = [[0.0; S]; N];
    free[..n].fill([1.0; S]);
    let mut pivots = [[(0, 0); S]; N];
    let mut scales = [[0.0; S]; N];
    for l in 0..n {
        for j in 0..S {
            let (done, rest) = equations.split_at_mut(l * S + j + 1);
            let Some(column) = done.last() else { return false };
            let Some((row, at)) = pivot(column, &free, (l, j), mass) else { return false };
            let scale = column[row][at].recip();
            free[row][at] = 0.0;
            pivots[l][j] = (row, at);
            scales[l][j] = scale;
            let mut factors = [[0.0; S]; N];
            for k in 0..n {
                for i in 0..S {
                    factors[k][i] = -column[k][i] * scale;
                }
            }
            factors[row][at] = 0.0;
            let (columns, others) = rest.split_at_mut((n - l) * S - j - 1);
            for other in columns.iter_mut().chain(&mut others[(N - n) * S..]) {
                let pivotal = other[row][at];
                // A copy cannot alias, so that the compiler vectorizes the loop.
                let mut eliminated = *other;
                for k in 0..n {
                    for i in 0..S {
                        eliminated[k][i] = Lane::<FUSED>::multiply_add(factors[k][i], pivotal, eliminated[k][i]);
                    }
                }
                *other = eliminated;
            }
        }
    }
    let mut are_finite = true;
    for right in equations.iter_mut().skip(N * S) {
        let eliminated = *right;
        for l in 0..n {
            for j in 0..S {
                let (row, at) = pivots[l][j];
                right[l][j] = eliminated[row][at] * scales[l][j];
                are_finite &= right[l][j].is_finite();
            }
        }
    }
    are_finite
}

/// The pivot position of a column; `None` if the remaining rows are zero there.
#[inline(always)]
fn pivot<const N: usize, const S: usize>(
    column: &Stages<N, S>,
    free: &Stages<N, S>,
    diagonal: (usize, usize),
    mass: &[Stages<N, S>; N],
) -> Option<(usize, usize)> {
    let mut sizes = [[0.0; S]; N];
    let mut largest = [0.0; N];
    for k in 0..N {
        for i in 0..S {
            sizes[k][i] = column[k][i].abs() * free[k][i];
        }
        largest[k] = maximum(&sizes[k]);
    }
    let (l, j) = diagonal;
    let largest = maximum(&largest);
    if largest > 0.0 && FAVOURED * sizes[l][j] >= largest { Some(diagonal) } else { compared(&sizes, diagonal, mass) }
}

/// The pivot among scaled rows, if it is not the largest entry in their own units.
#[cold]
fn compared<const N: usize, const S: usize>(
    sizes: &Stages<N, S>,
    (l, j): (usize, usize),
    mass: &[Stages<N, S>; N],
) -> Option<(usize, usize)> {
    let weights = comparable(mass);
    let size = |place: usize| sizes[place / S][place % S] * weights[place / S];
    let mut found = l * S + j;
    let mut least = FAVOURED * size(found);
    for place in 0..N * S {
        if size(place) > least {
            found = place;
            least = size(place);
        }
    }
    (size(found) > 0.0).then_some((found / S, found % S))
}
