//! Mechanics with constraints.
//!
//! k constraints hold along every motion. Both kinds may be in one system; holonomic ones come first:
//!
//! ```text
//! holonomic       g(t, q) = 0              A = ∂g/∂q    a = ∂g/∂t
//! nonholonomic    A(t, q) v + a(t, q) = 0
//!
//! d/dt L_v = L_q + f + AᵀΛ                 with the multipliers Λ and the reaction AᵀΛ on q
//! ```
//!
//! Acceleration and multipliers follow from one bordered linear system:
//!
//! ```text
//! [ M  −Aᵀ ] [v']   [ L_q + f − L_vt − L_vq v        ]
//! [ A   0  ] [Λ ] = [ −(A v + a)_q v − (A v + a)_t   ]
//! ```
//!
//! The mass matrix M needs to be regular only for velocities with `A v = 0`.
//!
//! | file | contents |
//! |---|---|
//! | `motion` | acceleration, flow and reaction at a state |
//! | `start` | consistent and redundant constraints at a start |
//! | `extended` | systems with constraints as ordinary differential equations |
//! | `independent` | systems with redundant constraints: an independent subset |
//! | `projection` | the state on the constraints nearest to a given one, [`State::projected`](crate::State::projected) |
//! | `assembly` | a state on the constraints from a far guess, [`State::assembled`](crate::State::assembled) |
//! | `equations` | the equations of a step of [`GaussLobatto`](crate::GaussLobatto), and their Jacobian |
//! | `solve`, `solved` | their solution to the rounding floor; a solved step |
//! | `connected` | whether a long step continues short ones |
//! | `reduced` | the same for point masses in a uniform field, in the impulses alone |
//! | `guess` | the initial guess of a step |
//! | `lengths` | steps of any length, for [`EnergyPreservingGaussLobatto`](crate::EnergyPreservingGaussLobatto) |
//! | `energies`, `density` | the discrete energies of a step, and its step density |
//! | `variation` | tangent vectors of a step |

mod assembly;
pub(crate) mod connected;
mod density;
pub(crate) mod energies;
mod equations;
mod extended;
pub(crate) mod guess;
mod independent;
pub(crate) mod lengths;
mod motion;
mod projection;
mod reduced;
pub(crate) mod solve;
pub(crate) mod solved;
pub(crate) mod start;
pub(crate) mod variation;

pub use density::step_density;
pub(crate) use equations::{discrete_energy, impulses, unknowns};
pub use extended::Extended;
pub use independent::Independent;
pub(crate) use motion::{accelerations, unsolvable};
pub use motion::{constrained_acceleration, constrained_flow};
pub use projection::{Projected, Projection};

use crate::kind::Gradients;
use crate::linear::{Bordered, Matrix, Rectangular, Row, Unsolvable};
use crate::motion::Motion;
use crate::real::Real;
use nalgebra::{SMatrix, SVector};

/// The bordered mass matrix of a system, in its blocks.
pub(crate) fn bordered<S: Motion<N, T>, const N: usize, T: Real>(system: &S) -> Bordered<T> {
    Bordered::new(N, system.constraint_names().len(), system.blocks())
}

/// Factors the mass matrix bordered by gradients, without dropped constraints.
///
/// # Errors
/// As [`Bordered::factor`].
pub(crate) fn border<S: Motion<N, T>, const N: usize, T: Real>(
    bordered: &mut Bordered<T>,
    system: &S,
    mass: &impl Matrix<N, T>,
    gradients: &Gradients<S, N, T>,
) -> Result<(), Unsolvable> {
    bordered.factor_without(mass, gradients, |r| system.is_dropped(r))
}

/// `Aᵀλ`.
#[inline(always)]
pub(crate) fn reaction_of<const N: usize, T: Real>(
    gradients: &(impl Rectangular<N, T> + ?Sized),
    multipliers: &[T],
) -> SVector<T, N> {
    let mut reaction = SVector::zeros();
    for (row, multiplier) in gradients.rows().zip(multipliers) {
        for (column, value) in row.iter() {
            reaction[column] += value * *multiplier;
        }
    }
    reaction
}

/// `Σ_r |A_ri λ_r|`: the terms of `Aᵀλ`, also where they cancel.
#[inline(always)]
pub(crate) fn reaction_terms<const N: usize, T: Real>(
    gradients: &impl Rectangular<N, T>,
    multipliers: &[T],
) -> SVector<T, N> {
    let mut terms = SVector::zeros();
    for (row, multiplier) in gradients.rows().zip(multipliers) {
        for (column, value) in row.iter() {
            terms[column] += (value * *multiplier).abs();
        }
    }
    terms
}

/// `Σ_j |M_ij v_j|`: the terms of the momenta that add to L_v, also where they cancel.
#[inline(always)]
pub(crate) fn inertia<const N: usize, T: Real>(mass: &impl Matrix<N, T>, v: &SVector<T, N>) -> SVector<T, N> {
    let mut inertia = SVector::zeros();
    mass.each_entry(|row, column, value| inertia[row] += (value * v[column]).abs());
    inertia
}

/// The diagonal of a matrix.
#[inline(always)]
pub(crate) fn diagonal<const N: usize, T: Real>(matrix: &impl Matrix<N, T>) -> SVector<T, N> {
    let mut diagonal = SVector::zeros();
    matrix.each_entry(|row, column, value| {
        if row == column {
            diagonal[row] = value;
        }
    });
    diagonal
}

/// The mass matrix with a mass of 1 for each coordinate without mass that no holonomic constraint moves: a projection
/// leaves these where they are. `None` if there are none.
pub(crate) fn with_idle<const N: usize>(
    mass: &impl Matrix<N, f64>,
    gradients: &impl Rectangular<N, f64>,
    holonomic: usize,
) -> Option<SMatrix<f64, N, N>> {
    let mut idle = [true; N];
    mass.each_entry(|row, column, value| {
        if value != 0.0 {
            (idle[row], idle[column]) = (false, false);
        }
    });
    for (column, _) in gradients.rows().take(holonomic).flat_map(Row::iter).filter(|(_, slope)| *slope != 0.0) {
        idle[column] = false;
    }
    idle.contains(&true).then(|| {
        let mut mass = mass.dense();
        (0..N).filter(|i| idle[*i]).for_each(|i| mass[(i, i)] = 1.0);
        mass
    })
}

/// Whether `part` of a correction of this length passes Deuflhard's natural monotonicity test: `behind` is the length of
/// the next correction with the same factors.
pub(crate) fn is_shortened(behind: f64, length: f64, part: f64) -> bool {
    behind < (1.0 - 0.25 * part) * length
}

/// Momenta and velocities that each coordinate would have if the whole of v and p were along it, in the metric of the
/// diagonal of the mass matrix; zero for a coordinate without mass.
///
/// They bound the terms of a row from below. A solution of linear equations is accurate relative to the whole vector, not
/// to each entry, so a row with tiny terms, such as that of z in a motion in the plane z = 0, is as accurate as the others.
#[inline(always)]
pub(crate) fn spread<const N: usize, T: Real>(
    mass: &impl Matrix<N, T>,
    v: &SVector<T, N>,
    p: &SVector<T, N>,
) -> [SVector<T, N>; 2] {
    let roots = diagonal(mass).map(|mass| if mass.is_positive() { mass.sqrt() } else { T::zero() });
    let over = |number: T, root: T| if root.is_positive() { number / root } else { T::zero() };
    let of_velocities =
        inertia(mass, v).iter().zip(v).fold(T::zero(), |sum, (momentum, v)| sum + (*momentum * *v).abs());
    let of_momenta = p.zip_map(&roots, over).iter().fold(of_velocities, |sum, part| sum + *part * *part);
    let size = of_momenta.sqrt();
    [roots.map(|root| root * size), roots.map(|root| over(size, root))]
}

/// Whether a correction reduced a residual, in roundings. An infinite residual, of a row without terms, counts as reduced.
pub(crate) fn is_reduced(next: f64, residual: f64) -> bool {
    next < residual || residual.is_infinite() && !next.is_nan()
}
