//! Tangent vectors of a step with constraints.
//!
//! The unknowns of a step and the velocity and the impulse of its projection are functions of the node, the step length
//! and the parameters, by the implicit function theorem: dual numbers give the derivatives of the rows at fixed
//! unknowns, and the factors of the step those of the unknowns,
//!
//! ```text
//! ∂R/∂u δu = −δR        [ M  −A_sᵀ ] [δv1]   [ δp⁻ + δA_sᵀ μ − δL_v ]
//!                       [ A_s  0   ] [δμ ] = [ −δ(A v1 + a)         ]
//! ```
//!
//! Admissible tangent vectors satisfy the derivatives of the constraints and of their rates. A step maps any vector to
//! an admissible one, but the derivative of a run along any other has no meaning.

use super::energies::{energies as energies_of, power_of};
use super::equations::{Rows, stage_velocity};
use super::motion::{Velocity, from_rest, unsolvable, velocity};
use super::solve::Workspace;
use super::{border, bordered, reaction_of, with_idle};
use crate::derivatives::{TOGETHER, Variation, Varied, more_parameters, not_finite, singular};
use crate::error::StepError;
use crate::first_order;
use crate::gauss::variation::VariedEnergies;
use crate::kind::Kind;
use crate::lagrangian::Lagrangian;
use crate::linear::{Bordered, Matrix, Rectangular};
use crate::motion::Motion;
use crate::node::Node;
use crate::real::Dual;
use crate::state::State;
use crate::stepping::Convertible;
use alloc::vec::Vec;
use nalgebra::SVector;

/// Largest part of a tangent vector across the constraints. Central differences have about nine digits.
const ADMISSIBLE: f64 = 1e-8;

/// The system with parameters that vary in each direction.
fn varied<S: Convertible<N> + Lagrangian<N>, const N: usize>(system: &S, variations: &[Variation<N>]) -> S::In<Varied> {
    Variation::vary_parameters(variations, system.parameters(), system.convert::<Varied>())
}

/// The derivative of each entry in one direction.
fn along<const N: usize>(of: &SVector<Varied, N>, direction: usize) -> SVector<f64, N> {
    of.map(|entry| entry.slope.0[direction])
}

/// Maps admissible tangent vectors at the start of a step to those at its end, and optionally adds the derivatives of its
/// energies.
pub(crate) fn vary<S, const N: usize, const STAGES: usize>(
    system: &S,
    (before, h): (&Node<N>, f64),
    (u, mu): (&[f64], &[f64]),
    variations: &mut [Variation<N>],
    mut energies: Option<&mut Vec<VariedEnergies>>,
) -> Result<(), StepError>
where
    S: Convertible<N>,
{
    let workspace = &mut Workspace::new::<S, N, STAGES>(system);
    let rows = Rows::<S, N, STAGES>::at(system, before, h, u);
    workspace.factor(&rows, system, h, u);
    let (t, q) = rows.end();
    let p = before.p + (before.p_low + rows.increment);
    let bordered = &mut bordered(system);
    let Velocity { v, .. } = velocity(system, (t, &q, &p), &stage_velocity(u, STAGES - 1), bordered)?;
    let gradients = rows.end_gradients();
    let factored = border(bordered, system, &system.point(t, &q, &v).mass, gradients);
    factored.map_err(|failure| unsolvable(failure, t))?;
    let mut residuals = vec![Varied::fixed(0.0); u.len()];
    let mut change = vec![0.0; u.len()];
    for variations in variations.chunks_mut(TOGETHER) {
        let system = varied(system, variations);
        let node = Variation::node::<TOGETHER>(variations, before);
        let length = Variation::number(variations, h, |variation| variation.h);
        let rows = |u: &[Varied]| Rows::<S::In<Varied>, N, STAGES, Varied>::at(&system, &node, length, u);
        let mut u: Vec<Varied> = u.iter().map(|entry| Dual::fixed(*entry)).collect();
        rows(&u).write(&mut residuals);
        for direction in 0..variations.len() {
            for (change, residual) in change.iter_mut().zip(&residuals) {
                *change = residual.slope.0[direction];
            }
            workspace.solve(&mut change);
            for (u, change) in u.iter_mut().zip(&change) {
                u.slope.0[direction] = -change;
            }
        }
        let rows = rows(&u);
        let (t, q) = rows.end();
        let p = node.p + (node.p_low + rows.increment);
        let momentum = system.momentum(t, &q, &v.map(Dual::fixed));
        let (varied_gradients, mut rates) = system.constraint_gradients(t, &q);
        let mut mu: Vec<Varied> = mu.iter().map(|entry| Dual::fixed(*entry)).collect();
        let projected = p + reaction_of(&varied_gradients, &mu);
        for (rate, gradient) in rates.as_mut().iter_mut().zip(varied_gradients.rows()) {
            *rate += gradient.dot(&v.map(Dual::fixed));
        }
        for (direction, variation) in variations.iter_mut().enumerate() {
            let of_p = along(&projected, direction);
            let mut of_v = of_p - along(&momentum, direction);
            let mut of_mu: Vec<f64> = rates.as_ref().iter().map(|rate| -rate.slope.0[direction]).collect();
            bordered.solve(&mut of_v, &mut of_mu);
            variation.t = t.slope.0[direction];
            variation.q = along(&q, direction);
            variation.p = of_p + reaction_of(gradients, &of_mu);
            mu.iter_mut().zip(of_mu).for_each(|(mu, of_mu)| mu.slope.0[direction] = of_mu);
        }
        if let Some(energies) = &mut energies {
            let base = Dual::fixed(before.energy);
            let of = energies_of::<S::In<Varied>, N, STAGES, Varied>(&system, (&node, length), &u, base);
            let work = of.work - power_of::<S::In<Varied>, N, Varied>(&system, (t, &q), &mu);
            let of_direction =
                |direction| VariedEnergies { start: of.start.slope.0[direction], work: work.slope.0[direction] };
            energies.extend((0..variations.len()).map(of_direction));
        }
    }
    let is_singular = change.iter().any(|entry| !entry.is_finite());
    Variation::check_finite(variations, before.t)
        .map_err(|failure| if is_singular { singular(before.t) } else { failure })
}

/// The change that made a tangent vector admissible.
struct Correction<const N: usize> {
    q: SVector<f64, N>,
    p: SVector<f64, N>,
    /// The derivative of each constraint before, and the multiplier of its gradient in `p`.
    residuals: Vec<f64>,
    impulses: Vec<f64>,
    /// The derivative of the velocity.
    v: SVector<f64, N>,
}

/// Moves tangent vectors at a node to admissible ones. Without constraints all are.
///
/// # Errors
/// [`StepError::Singular`], [`StepError::NonFinite`]; [`StepError::NoDerivative`] for too many parameters.
pub(crate) fn project<S, const N: usize>(
    system: &S,
    node: &Node<N>,
    variations: &mut [Variation<N>],
) -> Result<(), StepError>
where
    S: Convertible<N>,
{
    if const { S::Kind::COUNT > 0 } {
        return corrected(system, node, variations).map(drop);
    }
    if system.is_first_order() {
        first_order::project(system, node, variations);
    }
    Ok(())
}

/// Moves tangent vectors at a node to admissible ones, and returns the changes.
///
/// # Errors
/// [`StepError::Singular`], [`StepError::NonFinite`]; [`StepError::NoDerivative`] for too many parameters.
fn corrected<S, const N: usize>(
    system: &S,
    node: &Node<N>,
    variations: &mut [Variation<N>],
) -> Result<Vec<Correction<N>>, StepError>
where
    S: Convertible<N>,
{
    let Node { t, q, p, .. } = *node;
    if variations.iter().any(|variation| variation.parameters.len() > system.parameters().len()) {
        return Err(more_parameters(t));
    }
    let [full, holonomic] = &mut [system.constraint_names().len(), system.holonomic()]
        .map(|count| Bordered::new(N, count, system.blocks()));
    let Velocity { v, .. } = from_rest(system, (t, &q, &p), full)?;
    let mass = system.point(t, &q, &v).mass;
    let (gradients, _) = system.constraint_gradients(t, &q);
    border(full, system, &mass, &gradients).map_err(|failure| unsolvable(failure, t))?;
    let factored = match with_idle(&mass, &gradients, system.holonomic()) {
        Some(mass) => {
            *holonomic = Bordered::new(N, system.holonomic(), &[]);
            border(holonomic, system, &mass, &gradients)
        }
        None => border(holonomic, system, &mass, &gradients),
    };
    factored.map_err(|failure| unsolvable(failure, t))?;
    let mut corrections = Vec::with_capacity(variations.len());
    for variations in variations.chunks_mut(TOGETHER) {
        let system = varied(system, variations);
        let node = Variation::node::<TOGETHER>(variations, node);
        let values = system.constraints(node.t, &node.q);
        for (direction, variation) in variations.iter_mut().enumerate() {
            // A dropped constraint moves nothing.
            let residual =
                |(r, value): (usize, &Varied)| if system.is_dropped(r) { 0.0 } else { value.slope.0[direction] };
            let residuals: Vec<f64> = values.as_ref().iter().enumerate().map(residual).collect();
            let mut moved = SVector::zeros();
            let mut multipliers: Vec<f64> = residuals[..system.holonomic()].iter().map(|residual| -residual).collect();
            holonomic.solve(&mut moved, &mut multipliers);
            variation.q += moved;
            let (zeros, impulses) = (SVector::zeros(), Vec::new());
            corrections.push(Correction { q: moved, p: zeros, residuals, impulses, v: zeros });
        }
        let node = Variation::node::<TOGETHER>(variations, &node.map(|number| number.value));
        let fixed = v.map(Dual::fixed);
        let momentum = system.momentum(node.t, &node.q, &fixed);
        let (varied_gradients, rates) = system.constraint_gradients(node.t, &node.q);
        let first = corrections.len() - variations.len();
        for (direction, (variation, correction)) in variations.iter_mut().zip(&mut corrections[first..]).enumerate() {
            let mut of_v = variation.p - along(&momentum, direction);
            let rates = rates.as_ref().iter().zip(varied_gradients.rows());
            let mut impulses: Vec<f64> =
                rates.map(|(rate, gradient)| -(*rate + gradient.dot(&fixed)).slope.0[direction]).collect();
            full.solve(&mut of_v, &mut impulses);
            correction.v = of_v;
            correction.p = reaction_of(&gradients, &impulses);
            correction.impulses = impulses;
            variation.p += correction.p;
        }
    }
    Variation::check_finite(variations, t)?;
    Ok(corrections)
}

/// Checks that tangent vectors at a node are admissible, before steps of the length h. Parts across the constraints are
/// compared with the largest vector: one that vanishes consists of rounding errors.
///
/// # Errors
/// [`StepError::InconsistentTangent`]; those of [`project`].
pub(crate) fn check_admissible<S, const N: usize>(
    system: &S,
    (node, h): (&Node<N>, f64),
    variations: &[Variation<N>],
) -> Result<(), StepError>
where
    S: Convertible<N>,
{
    if const { S::Kind::COUNT == 0 } {
        return if system.is_first_order() { first_order::check(system, node, variations) } else { Ok(()) };
    }
    let mut admissible = variations.to_vec();
    let corrections = corrected(system, node, &mut admissible)?;
    let v = node.state().velocity(system)?;
    let mass = system.point(node.t, &node.q, &v).mass;
    let (gradients, _) = system.constraint_gradients(node.t, &node.q);
    let both = || admissible.iter().zip(&corrections);
    // Over a step, changes of velocities move coordinates, and changes of coordinates move momenta.
    let sizes_q = both().map(|(of, correction)| of.q.norm() + correction.q.norm() + h.abs() * correction.v.norm());
    let size_q = sizes_q.fold(0.0, f64::max);
    let sizes_p =
        both().map(|(of, correction)| of.p.norm() + correction.p.norm() + mass.multiply(&of.q).norm() / h.abs());
    let size_p = sizes_p.fold(0.0, f64::max);
    for Correction { q, p, residuals, impulses, .. } in &corrections {
        let is_across = [(q, size_q), (p, size_p)].map(|(across, size)| across.norm() > ADMISSIBLE * size);
        if is_across == [false; 2] {
            continue;
        }
        // The largest part, each over the length of its gradient; dropped constraints have none.
        let part = |r: usize| {
            let length = gradients.row(r).dense::<N>().norm();
            let part = if is_across[0] { residuals[r].abs() / length } else { impulses[r].abs() * length };
            if length > 0.0 { part } else { 0.0 }
        };
        let worst = (0..residuals.len()).max_by(|a, b| part(*a).total_cmp(&part(*b))).unwrap_or(0);
        let (t, constraint, residual, impulse) =
            (node.t, system.constraint_names()[worst], residuals[worst], impulses[worst]);
        return Err(StepError::InconsistentTangent { t, constraint, residual, impulse });
    }
    Ok(())
}

/// The derivative of the velocity v of a state along a tangent vector.
///
/// # Errors
/// [`StepError::Singular`] and [`StepError::NonFinite`].
pub(crate) fn velocity_along<S, const N: usize>(
    system: &S,
    state: &State<N>,
    v: &SVector<f64, N>,
    variation: &Variation<N>,
) -> Result<SVector<f64, N>, StepError>
where
    S: Convertible<N>,
{
    let bordered = &mut bordered(system);
    let (gradients, _) = system.constraint_gradients(state.t, &state.q);
    let factored = border(bordered, system, &system.point(state.t, &state.q, v).mass, &gradients);
    factored.map_err(|failure| unsolvable(failure, state.t))?;
    let directions = core::slice::from_ref(variation);
    let system = varied(system, directions);
    let node = Variation::node::<TOGETHER>(directions, &Node::new(*state, 0.0));
    let fixed = v.map(Dual::fixed);
    let mut of_v = variation.p - along(&system.momentum(node.t, &node.q, &fixed), 0);
    let (gradients, rates) = system.constraint_gradients(node.t, &node.q);
    let rates = rates.as_ref().iter().zip(gradients.rows());
    let mut impulses: Vec<f64> = rates.map(|(rate, gradient)| -(*rate + gradient.dot(&fixed)).slope.0[0]).collect();
    bordered.solve(&mut of_v, &mut impulses);
    if of_v.iter().all(|entry| entry.is_finite()) { Ok(of_v) } else { Err(not_finite(state.t)) }
}
