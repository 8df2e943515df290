//! Tangent vectors of a solved step in transformed time.
//!
//! In: the stages of the last step, and tangent vectors at its node in extended phase space (t, q; −E, p). Out: tangent
//! vectors at the next node. Dual numbers differentiate the functions of a stage
//!
//! ```text
//! L_v        P' = g (L_q + f) − (H − E) ∂g/∂q        g        E' = g (f·v − L_t) + (H − E) ∂g/∂t
//! ```
//!
//! with respect to (T, Q, V, E). The derivatives of V, g and E' at the stages then solve S (N + 2) linear equations, of
//! L_v, g and E':
//!
//! ```text
//! (δL_v)_i = δp0 + Σ_j δ(Δτ a_ij P'_j)
//! δT_i = δt0 + Σ_j δ(Δτ a_ij g_j)         δQ_i = δq0 + Σ_j δ(Δτ a_ij g_j V_j)         δE_i = δE0 + Σ_j δ(Δτ a_ij E'_j)
//! ```

use super::super::fixed_point::Equations;
use super::super::stages::{stage, weights};
use super::super::tableau::Tableau;
use super::equations::Scaled;
use super::rates::LastRates;
use crate::angles;
use crate::derivatives::{
    Differentiable, TOGETHER, Variation, Varied, changes_of_energy, more_parameters, not_finite, not_last, singular,
};
use crate::error::StepError;
use crate::lagrangian::Lagrangian;
use crate::method::{Gauss, InTransformedTime};
use crate::motion::{Motion, ScaledPoint, TimeScale};
use crate::node::Node;
use crate::real::Dual;
use crate::run::Run;
use crate::stepping::Convertible;
use alloc::vec::Vec;
use nalgebra::{DMatrix, DVector, SVector};

impl<S, const N: usize, const STAGES: usize> Differentiable<S, N> for InTransformedTime<Gauss<STAGES>>
where
    S: TimeScale<N> + Convertible<N>,
{
    fn keeps_energy(&self) -> bool {
        true
    }

    /// Steps also depend on the time through g.
    fn depends_on_time(&self, _system: &S) -> bool {
        true
    }

    /// Allocates the joint matrix of all stages.
    fn vary(run: &Run<Self, S, N>, before: &Node<N>, variations: &mut [Variation<N>]) -> Result<(), StepError> {
        if run.memory.taken.to_bits() != run.h.to_bits() {
            return Err(not_last(before.t));
        }
        vary(run, before, variations)
    }

    /// Δτ varies so that the step keeps the given length in time.
    fn vary_step_of(run: &Run<Self, S, N>, length: f64, variations: &mut [Variation<N>]) -> Result<(), StepError> {
        let mut after = run.clone();
        after.step_of(length)?;
        let mut all: Vec<_> = variations.iter().map(|variation| Variation { h: 0.0, ..variation.clone() }).collect();
        all.push(Variation::of_length());
        vary(&after, &angles::reduced_node(&run.system, &run.node), &mut all)?;
        let Some(along_dtau) = all.pop() else { return Ok(()) };
        for (own, varied) in variations.iter_mut().zip(&all) {
            let missing = own.h + own.t - varied.t;
            (own.t, own.q, own.p, own.energy) = (varied.t, varied.q, varied.p, varied.energy);
            own.add(&along_dtau, missing / along_dtau.t);
        }
        Variation::check_finite(variations, run.node.t)
    }

    fn vary_start(run: &Run<Self, S, N>, variations: &mut [Variation<N>]) -> Result<(), StepError> {
        let energies = changes_of_energy::<_, _>(&run.system, &run.node.state(), variations)?;
        for (variation, energy) in variations.iter_mut().zip(energies) {
            variation.energy = energy;
        }
        Ok(())
    }
}

/// Maps tangent vectors at the node `before` to those at the node of a run after its last step.
fn vary<S, const N: usize, const STAGES: usize>(
    run: &Run<InTransformedTime<Gauss<STAGES>>, S, N>,
    before: &Node<N>,
    variations: &mut [Variation<N>],
) -> Result<(), StepError>
where
    S: TimeScale<N> + Convertible<N>,
{
    let Run { system, node, memory, .. } = run;
    let t = before.t;
    if variations.iter().any(|variation| variation.parameters.len() > system.parameters().len()) {
        return Err(more_parameters(t));
    }
    let stages = Linearized::of(system, before, node, memory).ok_or_else(|| not_last(t))?;
    let size = STAGES * (N + 2);
    let mut matrix = stages.matrix();
    let unmoved = DVector::zeros(size);
    if !matrix.iter().all(|entry| entry.is_finite()) {
        return Err(not_finite(t));
    }
    // Pivoting compares rows: each is scaled to a largest entry of 1, since coordinates differ in units.
    let scales = DVector::from_fn(size, |row, _| matrix.row(row).amax().recip());
    matrix.row_iter_mut().zip(&scales).for_each(|(mut row, scale)| row *= *scale);
    let factors = matrix.lu();
    for chunk in variations.chunks_mut(TOGETHER) {
        let explicit = stages.explicit(system, chunk);
        for (variation, explicit) in chunk.iter_mut().zip(&explicit) {
            let (missing, _) = stages.residual(&unmoved, variation, explicit);
            let mut solution = -missing.component_mul(&scales);
            let is_known = solution.iter().all(|entry| entry.is_finite());
            let is_regular = factors.solve_mut(&mut solution);
            if !is_regular || !solution.iter().all(|entry| entry.is_finite()) {
                return Err(if is_known { singular(t) } else { not_finite(t) });
            }
            let (_, changes) = stages.residual(&solution, variation, explicit);
            stages.move_to_end(variation, &solution, &changes);
        }
    }
    Variation::check_finite(variations, t)
}

/// The solved stages of a step, and the derivatives of their functions.
struct Linearized<const N: usize, const S: usize> {
    dtau: f64,
    time: [f64; S],
    position: [SVector<f64, N>; S],
    velocity: [SVector<f64, N>; S],
    energy: [f64; S],
    g: [f64; S],
    energy_rate: [f64; S],
    momentum_rate: [SVector<f64, N>; S],
    /// For each stage, a row for each of (L_v, P', g, E') and a column for each of (T, Q, V, E).
    derivatives: Vec<DMatrix<f64>>,
}

/// Rows of P', g and E' among the functions (L_v, P', g, E') of a stage.
const fn places<const N: usize>() -> [usize; 3] {
    [N, 2 * N, 2 * N + 1]
}

impl<const N: usize, const S: usize> Linearized<N, S> {
    /// The number of functions of a stage, and of their arguments.
    const FUNCTIONS: usize = 2 * N + 2;

    /// The stages of the step from `before` to `node`; `None` if that is not the last step.
    fn of<Y>(system: &Y, before: &Node<N>, node: &Node<N>, last: &LastRates<N, S>) -> Option<Self>
    where
        Y: TimeScale<N> + Convertible<N>,
    {
        let rates = last.rates();
        let dtau = last.taken;
        // The energy at the start of the step: `set_parameters` may have changed the energy of `before`.
        let gain = Scaled::<f64, Y, N, S, false>::new(system, before, dtau, rates, None).quadrature(&rates.energy);
        let start = Node { energy: node.energy - gain, energy_low: node.energy_low, ..*before };
        let mut equations = Scaled::<f64, Y, N, S, false>::new(system, &start, dtau, rates, None);
        let positions = equations.start();
        let momentum_rates = equations.momentum_rates();
        let (clock, rates) = (equations.evaluated(), equations.rates());
        let position = core::array::from_fn(|i| stage(&positions, i));
        let velocity: [SVector<f64, N>; S] = core::array::from_fn(|i| stage(&rates.velocity, i));
        let weights = weights::<S>(dtau);
        // Whether the quadrature of a rate over the stages leads from one number to the other.
        let leads = |from: f64, rate: &dyn Fn(usize) -> f64, to: f64| {
            let gains = (0..S).map(|i| weights[i] * rates.g[i] * rate(i));
            let (end, size) = gains.fold((from, to.abs()), |(end, size), gain| (end + gain, size + gain.abs()));
            (end - to).abs() <= NEAR * size
        };
        let is_last = last.convergence.has_begun()
            && leads(before.t, &|_| 1.0, node.t)
            && (0..N).all(|k| leads(before.q[k], &|i| velocity[i][k], node.q[k]));
        if !is_last {
            return None;
        }
        let mut stages = Self {
            dtau,
            time: clock.time,
            position,
            velocity,
            energy: clock.energy,
            g: rates.g,
            energy_rate: rates.energy,
            momentum_rate: core::array::from_fn(|i| stage(&momentum_rates, i)),
            derivatives: Vec::with_capacity(S),
        };
        let varied = system.convert::<Varied>();
        for i in 0..S {
            let mut derivatives = DMatrix::zeros(Self::FUNCTIONS, Self::FUNCTIONS);
            for first in (0..Self::FUNCTIONS).step_by(TOGETHER) {
                let seed = |place: usize, value: f64| {
                    let mut number = Varied::fixed(value);
                    if let Some(slope) =
                        place.checked_sub(first).and_then(|direction| number.slope.0.get_mut(direction))
                    {
                        *slope = 1.0;
                    }
                    number
                };
                let q = SVector::from_fn(|k, _| seed(1 + k, position[i][k]));
                let v = SVector::from_fn(|k, _| seed(1 + N + k, velocity[i][k]));
                let at = (seed(0, clock.time[i]), q, v, seed(1 + 2 * N, clock.energy[i]));
                for (row, value) in functions(&varied, at).iter().enumerate() {
                    for column in first..Self::FUNCTIONS.min(first + TOGETHER) {
                        derivatives[(row, column)] = value.slope.0[column - first];
                    }
                }
            }
            stages.derivatives.push(derivatives);
        }
        Some(stages)
    }

    /// Derivatives of the functions of each stage with respect to the parameters, a matrix for each direction.
    fn explicit<Y: Convertible<N> + Lagrangian<N>>(
        &self,
        system: &Y,
        variations: &[Variation<N>],
    ) -> Vec<DMatrix<f64>> {
        let mut explicit = vec![DMatrix::zeros(Self::FUNCTIONS, S); variations.len()];
        if variations.iter().all(|variation| variation.parameters.iter().all(|slope| *slope == 0.0)) {
            return explicit;
        }
        let varied = Variation::system::<Y, TOGETHER>(variations, system);
        for i in 0..S {
            let [q, v] = [&self.position, &self.velocity].map(|of| of[i].map(Varied::fixed));
            let at = (Dual::fixed(self.time[i]), q, v, Dual::fixed(self.energy[i]));
            for (row, value) in functions(&varied, at).iter().enumerate() {
                for (direction, explicit) in explicit.iter_mut().enumerate() {
                    explicit[(row, i)] = value.slope.0[direction];
                }
            }
        }
        explicit
    }

    /// The matrix of the linear equations: a row for each of (L_v, g, E') of a stage, a column for each of (V, g, E').
    fn matrix(&self) -> DMatrix<f64> {
        let first = const { &Tableau::<S>::VALUES.first };
        let [rate, g, energy_rate] = places::<N>();
        let weights = weights::<S>(self.dtau);
        let width = N + 2;
        let mut matrix = DMatrix::identity(S * width, S * width);
        let mut changes = DMatrix::zeros(Self::FUNCTIONS, S);
        for j in 0..S {
            for unknown in 0..width {
                let column = j * width + unknown;
                // Changes of the functions of each stage i.
                for i in 0..S {
                    let of = &self.derivatives[i];
                    let a = weights[j] * first[j][i];
                    for row in 0..Self::FUNCTIONS {
                        let along = match unknown {
                            k if k < N => self.g[j] * of[(row, 1 + k)],
                            k if k == N => {
                                of[(row, 0)] + (0..N).map(|k| self.velocity[j][k] * of[(row, 1 + k)]).sum::<f64>()
                            }
                            _ => of[(row, 1 + 2 * N)],
                        };
                        let own = if i == j && unknown < N { of[(row, 1 + N + unknown)] } else { 0.0 };
                        changes[(row, i)] = a * along + own;
                    }
                }
                for i in 0..S {
                    for k in 0..N {
                        let momentum = (0..S).map(|m| weights[m] * first[m][i] * changes[(rate + k, m)]).sum::<f64>();
                        matrix[(i * width + k, column)] = changes[(k, i)] - momentum;
                    }
                    matrix[(i * width + N, column)] -= changes[(g, i)];
                    matrix[(i * width + N + 1, column)] -= changes[(energy_rate, i)];
                }
            }
        }
        matrix
    }

    /// The residual of the linear equations if V, g and E' of the stages change by `of_stages`, and the changes of the functions of the stages.
    fn residual(
        &self,
        of_stages: &DVector<f64>,
        variation: &Variation<N>,
        explicit: &DMatrix<f64>,
    ) -> (DVector<f64>, DMatrix<f64>) {
        let [rate, g, energy_rate] = places::<N>();
        let first = const { &Tableau::<S>::VALUES.first };
        let [weights, along] = [self.dtau, variation.h].map(weights::<S>);
        let mut changes = explicit.clone();
        let mut arguments = DVector::zeros(Self::FUNCTIONS);
        for i in 0..S {
            let (mut of_t, mut of_q, mut of_energy) = (variation.t, variation.q, variation.energy);
            for j in 0..S {
                let [of_v, of_g, of_rate] = parts::<N>(of_stages, j);
                let [a, a_dtau] = [weights, along].map(|weights| weights[j] * first[j][i]);
                of_t += a * of_g[0] + a_dtau * self.g[j];
                of_q += (SVector::from_column_slice(of_v) * self.g[j] + self.velocity[j] * of_g[0]) * a;
                of_q += self.velocity[j] * (a_dtau * self.g[j]);
                of_energy += a * of_rate[0] + a_dtau * self.energy_rate[j];
            }
            let [of_v, ..] = parts::<N>(of_stages, i);
            arguments[0] = of_t;
            arguments.rows_mut(1, N).copy_from(&of_q);
            arguments.rows_mut(1 + N, N).copy_from_slice(of_v);
            arguments[1 + 2 * N] = of_energy;
            changes.column_mut(i).gemv(1.0, &self.derivatives[i], &arguments, 1.0);
        }
        let mut residual = DVector::zeros(of_stages.len());
        for i in 0..S {
            let at = i * (N + 2);
            for k in 0..N {
                let mut momentum = variation.p[k];
                for j in 0..S {
                    momentum += weights[j] * first[j][i] * changes[(rate + k, j)];
                    momentum += along[j] * first[j][i] * self.momentum_rate[j][k];
                }
                residual[at + k] = changes[(k, i)] - momentum;
            }
            residual[at + N] = of_stages[at + N] - changes[(g, i)];
            residual[at + N + 1] = of_stages[at + N + 1] - changes[(energy_rate, i)];
        }
        (residual, changes)
    }

    /// Moves a tangent vector to the end of the step.
    fn move_to_end(&self, variation: &mut Variation<N>, of_stages: &DVector<f64>, changes: &DMatrix<f64>) {
        let [rate, ..] = places::<N>();
        let [weights, along] = [self.dtau, variation.h].map(weights::<S>);
        for j in 0..S {
            let [of_v, of_g, of_rate] = parts::<N>(of_stages, j);
            variation.t += weights[j] * of_g[0] + along[j] * self.g[j];
            variation.q += (SVector::from_column_slice(of_v) * self.g[j] + self.velocity[j] * of_g[0]) * weights[j];
            variation.q += self.velocity[j] * (along[j] * self.g[j]);
            variation.p +=
                SVector::from_fn(|k, _| changes[(rate + k, j)]) * weights[j] + self.momentum_rate[j] * along[j];
            variation.energy += weights[j] * of_rate[0] + along[j] * self.energy_rate[j];
        }
    }
}

/// The changes of V, g and E' of one stage.
fn parts<const N: usize>(of_stages: &DVector<f64>, i: usize) -> [&[f64]; 3] {
    let own = &of_stages.as_slice()[i * (N + 2)..][..N + 2];
    [&own[..N], &own[N..=N], &own[N + 1..]]
}

/// L_v, P', g and E' at (T, Q, V, E).
fn functions<Y, const N: usize>(
    system: &Y,
    (t, q, v, energy): (Varied, SVector<Varied, N>, SVector<Varied, N>, Varied),
) -> Vec<Varied>
where
    Y: Motion<N, Varied>,
{
    let ScaledPoint { point, energy: hamiltonian, power, g, g_dq, g_dt } = system.scaled_point(t, &q, &v);
    let excess = hamiltonian - energy;
    let rates = (0..N).map(|k| g * point.force[k] - excess * g_dq[k]);
    point.momentum.iter().copied().chain(rates).chain([g, g * power + excess * g_dt]).collect()
}

/// Relative distance within which the stages lead to the node: above rounding, and below any other step.
const NEAR: f64 = 1e-10;
