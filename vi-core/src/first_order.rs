//! Systems of first order: L is linear in the velocities.
//!
//! `L = ϑ(t, q)·q' − H(t, q)` has no mass matrix. Its equations are of first order, and q alone is a state:
//!
//! ```text
//! Ω q' = r        Ω = ϑ_q − (ϑ_q)ᵀ − ∂f/∂q'        r = −H_q − ϑ_t + f at rest
//! ```
//!
//! Half of the velocities are absent from L: those of the coordinates y of q = (x, y), with ϑ_y regular for the momenta ϑ of
//! x. Then (x, p = ϑ) are canonical variables, and Ω is regular. A Hamiltonian system in canonical form is the case
//! `L = p·q' − H(t, q, p)`, with x = q and y = p.

#[cfg(feature = "alloc")]
use crate::derivatives::{Variation, along_parameters};
use crate::error::StepError;
#[cfg(feature = "alloc")]
use crate::gauss::points::ErasedSystem;
use crate::lagrangian::Flow;
#[cfg(feature = "alloc")]
use crate::lagrangian::Lagrangian as _;
use crate::linear::{self, Matrix};
use crate::motion::{Motion, PointDerivatives};
use crate::node::Node;
#[cfg(feature = "alloc")]
use crate::real::Dual;
use crate::real::{Real, Scalar};
#[cfg(feature = "alloc")]
use crate::stepping::Convertible;
use crate::vector::Vector;
use nalgebra::{SMatrix, SVector};

/// Name of Ω in [`StepError::Singular`].
pub const STRUCTURE: &str = "matrix ∂ϑ/∂q − (∂ϑ/∂q)ᵀ of the momenta ϑ(q)";

/// Most iterations for the velocity. If f is linear in the velocities, the first one finds it.
const ITERATIONS: u32 = 16;
/// Relative size of a correction of the velocity below which the next one is rounding.
const SMALL: f64 = 1e-9;

/// The flow at (t, q): the velocity of a system of first order, its force `L_q + f` and its power.
///
/// # Errors
/// [`StepError::Singular`] if Ω is singular, [`StepError::NonFinite`] if it or a force is not finite,
/// [`StepError::NotConverged`] if f depends on the velocities and their iteration does not converge.
pub fn first_order_flow<S: Motion<N, T>, const N: usize, T: Real>(
    system: &S,
    t: T,
    q: &SVector<T, N>,
) -> Result<Flow<N, T>, StepError> {
    let v = velocity(system, t, q)?;
    Ok(Flow { v, force: system.applied_force(t, q, &v), power: system.power(t, q, &v) })
}

fn velocity<S: Motion<N, T>, const N: usize, T: Real>(
    system: &S,
    t: T,
    q: &SVector<T, N>,
) -> Result<SVector<T, N>, StepError> {
    let time = t.to_f64();
    let mut v = SVector::<T, N>::zeros();
    for _ in 0..ITERATIONS {
        let missing = system.applied(t, q, &v);
        let structure = structure(system, &system.point_derivatives(t, q, &v));
        let are_finite = structure.iter().chain(&missing).all(|entry| entry.is_finite());
        if !are_finite {
            return Err(StepError::NonFinite { t: time, quantity: "velocity", expression: None });
        }
        let Some(change) = linear::solve(&structure, &missing) else {
            return Err(StepError::Singular { t: time, matrix: STRUCTURE });
        };
        v += change;
        if change.longest().to_f64() <= SMALL * v.longest().to_f64() {
            return Ok(v);
        }
    }
    Err(StepError::NonFinite { t: time, quantity: "velocity", expression: None })
}

/// Ω. Coordinates at rest have the velocity 0.
fn structure<S: Motion<N, T>, const N: usize, T: Real>(
    system: &S,
    of: &PointDerivatives<S::PointMatrix>,
) -> SMatrix<T, N, N> {
    let mut structure = of.momentum_dq.dense() - of.force_dv.dense();
    for k in system.moving()..N {
        structure[(k, k)] = T::one();
    }
    structure
}

/// The entries of Ω between x and y, which solve for one half at given other half: rows of x are ϑ_y, those of y are
/// `−∂(L_y + f)/∂x'`. Coordinates at rest have a one.
pub(crate) fn halves<const N: usize>(
    of: &PointDerivatives<SMatrix<f64, N, N>>,
    without_velocity: &[bool],
) -> SMatrix<f64, N, N> {
    SMatrix::from_fn(|row, column| match (without_velocity.get(row), without_velocity.get(column)) {
        (Some(false), Some(true)) => of.momentum_dq[(row, column)],
        (Some(true), Some(false)) => -of.force_dv[(row, column)],
        (None, _) if row == column => 1.0,
        _ => 0.0,
    })
}

/// Checks that the momenta of a system of first order are those of its coordinates.
///
/// # Errors
/// [`StepError::InvalidInput`] with the first momentum that is not.
pub(crate) fn check_momenta<S: Motion<N, T>, const N: usize, T: Scalar>(
    system: &S,
    node: &Node<N, T>,
) -> Result<(), StepError> {
    if !system.is_first_order() {
        return Ok(());
    }
    let momentum = system.momentum(node.t, &node.q, &SVector::zeros());
    let largest = momentum.longest().to_f64();
    let is_other = |(given, of): &(&T, &T)| (**given - **of).to_f64().abs() > OFF.max(4.0 * T::EPSILON) * largest;
    match node.p.iter().zip(&momentum).find(is_other) {
        Some((given, _)) => {
            let allowed = "that of L at the coordinates, which determine it: L is linear in the velocities";
            Err(StepError::InvalidInput { input: "a momentum", allowed, value: given.to_f64() })
        }
        None => Ok(()),
    }
}

/// Relative error of momenta that were computed elsewhere.
const OFF: f64 = 1e-9;

/// The momenta of tangent vectors, which follow from their coordinates, time and parameters.
#[cfg(feature = "alloc")]
fn momenta<S: Convertible<N>, const N: usize>(system: &S, node: &Node<N>, of: &Variation<N>) -> SVector<f64, N> {
    let along = |value: f64, slope: f64| Dual { value, slope };
    let varied = along_parameters(system, of);
    let momentum = varied.momentum(along(node.t, of.t), &node.q.zip_map(&of.q, along), &SVector::zeros());
    // The momenta of coordinates at rest are arbitrary.
    SVector::from_fn(|k, _| if k < system.moving() { momentum[k].slope } else { of.p[k] })
}

/// Moves tangent vectors at a node to those of its coordinates.
#[cfg(feature = "alloc")]
pub(crate) fn project<S: Convertible<N>, const N: usize>(system: &S, node: &Node<N>, variations: &mut [Variation<N>]) {
    for variation in variations {
        variation.p = momenta(system, node, variation);
    }
}

/// Checks that the momenta of tangent vectors follow from their coordinates.
///
/// # Errors
/// [`StepError::InconsistentTangent`].
#[cfg(feature = "alloc")]
pub(crate) fn check<S: Convertible<N>, const N: usize>(
    system: &S,
    node: &Node<N>,
    variations: &[Variation<N>],
) -> Result<(), StepError> {
    for variation in variations {
        let impulse = (variation.p - momenta(system, node, variation)).amax();
        if impulse > ADMISSIBLE * (variation.p.amax() + variation.q.amax()) {
            let constraint = "p = ∂L/∂v";
            return Err(StepError::InconsistentTangent { t: node.t, constraint, residual: 0.0, impulse });
        }
    }
    Ok(())
}

/// Relative rounding error of the momenta of tangent vectors.
#[cfg(feature = "alloc")]
const ADMISSIBLE: f64 = 1e-6;

/// Tangent vectors at the end of a step: computes the changes of y from those of x and p.
///
/// # Errors
/// [`StepError::Singular`] if ϑ_y is singular.
#[cfg(feature = "alloc")]
pub(crate) fn vary<S: Convertible<N>, const N: usize>(
    system: &S,
    node: &Node<N>,
    variations: &mut [Variation<N>],
) -> Result<(), StepError> {
    let without_velocity = system.without_velocity();
    let of = ErasedSystem::of(system).derivatives(node.t, &node.q, &SVector::zeros());
    let halves = halves(&of, without_velocity);
    let half = |of: &SVector<f64, N>, without: bool| {
        SVector::<f64, N>::from_fn(|k, _| if without_velocity.get(k) == Some(&without) { of[k] } else { 0.0 })
    };
    for variation in variations {
        let by_x = Variation { q: half(&variation.q, false), ..variation.clone() };
        let missing = half(&(variation.p - momenta(system, node, &by_x)), false);
        let singular = StepError::Singular { t: node.t, matrix: STRUCTURE };
        let change = linear::solve(&halves, &missing).ok_or(singular)?;
        variation.q += half(&(change - variation.q), true);
        variation.p -= half(&variation.p, true);
    }
    Ok(())
}
