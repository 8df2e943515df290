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
//! | `solve` | their solution to the rounding floor |
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
pub(crate) mod start;
mod variation;

pub use density::step_density;
pub(crate) use equations::{discrete_energy, impulses, unknowns};
pub use extended::Extended;
pub use independent::Independent;
pub(crate) use motion::{accelerations, unsolvable};
pub use motion::{constrained_acceleration, constrained_flow};
pub use projection::{Projected, Projection};
pub(crate) use variation::velocity_along;

use crate::collocation::{Point, PointDerivatives};
use crate::lagrangian::{Lagrangian, Parameters};
use crate::linear::{Block, Bordered, Matrix, Rectangular, Row, Unsolvable};
use crate::real::Real;
use core::fmt::Debug;
use nalgebra::{SMatrix, SVector};

/// Mechanics with constraints; see the [module](self). A system with constraints implements this instead of
/// [`Collocation`](crate::collocation::Collocation) and [`FixedStepping`](crate::stepping::FixedStepping), so that no
/// method that ignores constraints accepts it.
///
/// Systems are small and `Copy`. Times, coordinates and velocities are in the units of the system.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no constraints",
    label = "this system declares no constraint",
    note = "`Gauss` and `FixedStep` integrate a system without constraints",
    note = "write a constraint in its `lagrangian!`, for example `constraint rod = x^2 + y^2 - l^2;`"
)]
pub trait Constrained<const N: usize, T: Real = f64>: Lagrangian<N, T> + Copy {
    /// Matrix type of M, with its zero pattern.
    type Mass: Matrix<N, T>;
    /// Matrix type of [`PointDerivatives`], with the joint zero pattern of all its matrices.
    type PointMatrix: Matrix<N, T>;
    /// Whether M depends on the parameters only.
    const CONSTANT_MASS: bool;
    /// Whether L_v is M v with a constant diagonal M, and `L_q + f` depends on t alone: point masses in a uniform field.
    const POINT_MASSES: bool = false;
    /// Names of the constraints as declared, entries of arrays as `link[3]`. Holonomic constraints come first.
    const CONSTRAINTS: &'static [&'static str];
    /// The number of holonomic constraints.
    const HOLONOMIC: usize;
    /// One number for each constraint: `[T; K]`.
    type Multipliers: Copy + Debug + PartialEq + Send + Sync + AsRef<[T]> + AsMut<[T]>;
    /// The rows of A and of `(A v + a)_q`: [`Sparse`](crate::linear::Sparse), or dense as `[SVector<T, N>; K]`.
    type Gradients: Rectangular<N, T> + Copy + Debug + PartialEq + Send + Sync;
    /// The rows of `∂(Aᵀλ)/∂q`: `Sparse`, or dense as `[SVector<T, N>; N]`.
    type ReactionMatrix: Rectangular<N, T> + Copy + Debug + PartialEq + Send + Sync;
    /// The order of elimination of coordinates and multipliers, for all nonzeros of the matrices of this trait together;
    /// without blocks, dense elimination. Multiplier r is unknown N + r.
    const BLOCKS: &'static [Block] = &[];

    /// Evaluates `L_v`, `L_q + f` and M at a point.
    fn point(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Point<N, T, Self::Mass>;
    /// Evaluates their derivatives at a point.
    fn point_derivatives(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> PointDerivatives<Self::PointMatrix>;
    /// `f·v − L_t`, the rate of change of the energy without the power `−Λ·a` of the constraints.
    fn power(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> T;
    /// `L_q + f − L_vt − L_vq v`: M times the acceleration without the reaction.
    fn applied(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> SVector<T, N>;
    /// g(t, q) of the holonomic constraints; zero for the others.
    fn constraints(&self, t: T, q: &SVector<T, N>) -> Self::Multipliers;
    /// A and a: `g_q` and `g_t` of a holonomic constraint; the coefficients of v and the rest of a nonholonomic one.
    fn constraint_gradients(&self, t: T, q: &SVector<T, N>) -> (Self::Gradients, Self::Multipliers);
    /// `(A v + a)_q`, one row for each constraint, and `(A v + a)_t`.
    fn constraint_rate_derivatives(
        &self,
        t: T,
        q: &SVector<T, N>,
        v: &SVector<T, N>,
    ) -> (Self::Gradients, Self::Multipliers);
    /// `∂(Aᵀλ)/∂q` for constant multipliers λ. Row i, column j is the derivative of entry i with respect to coordinate
    /// j.
    fn reaction_derivatives(&self, t: T, q: &SVector<T, N>, multipliers: &Self::Multipliers) -> Self::ReactionMatrix;
    /// Whether the constraint of this index follows from the others and has no multiplier: its gradients are then zero.
    /// Only in [`Independent`].
    fn is_dropped(&self, _constraint: usize) -> bool {
        false
    }
    /// The first dropped constraint that does not hold at a node, by its index, with its value.
    fn broken(&self, _t: T, _q: &SVector<T, N>, _v: &SVector<T, N>) -> Option<(usize, T)> {
        None
    }
}

/// A system with constraints that evaluates in other number types. Every generated system with constraints does.
#[diagnostic::on_unimplemented(
    message = "`{Self}` has no constraints over other number types",
    note = "every `lagrangian!` with a `constraint` implements it"
)]
pub trait ConvertibleConstrained<const N: usize> {
    /// The same system over the numbers T.
    type In<T: Real>: Constrained<N, T> + Parameters<T>;

    /// Converts the system; every parameter is rounded to T.
    fn convert<T: Real>(&self) -> Self::In<T>;
}

/// A reference to a system with constraints is one.
impl<const N: usize, T: Real, S: Constrained<N, T>> Constrained<N, T> for &S {
    type Mass = S::Mass;
    type PointMatrix = S::PointMatrix;
    const CONSTANT_MASS: bool = S::CONSTANT_MASS;
    const POINT_MASSES: bool = S::POINT_MASSES;
    const CONSTRAINTS: &'static [&'static str] = S::CONSTRAINTS;
    const HOLONOMIC: usize = S::HOLONOMIC;
    type Multipliers = S::Multipliers;
    type Gradients = S::Gradients;
    type ReactionMatrix = S::ReactionMatrix;
    const BLOCKS: &'static [Block] = S::BLOCKS;

    fn point(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Point<N, T, Self::Mass> {
        S::point(self, t, q, v)
    }
    fn point_derivatives(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> PointDerivatives<Self::PointMatrix> {
        S::point_derivatives(self, t, q, v)
    }
    fn power(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> T {
        S::power(self, t, q, v)
    }
    fn applied(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> SVector<T, N> {
        S::applied(self, t, q, v)
    }
    fn constraints(&self, t: T, q: &SVector<T, N>) -> Self::Multipliers {
        S::constraints(self, t, q)
    }
    fn constraint_gradients(&self, t: T, q: &SVector<T, N>) -> (Self::Gradients, Self::Multipliers) {
        S::constraint_gradients(self, t, q)
    }
    fn constraint_rate_derivatives(
        &self,
        t: T,
        q: &SVector<T, N>,
        v: &SVector<T, N>,
    ) -> (Self::Gradients, Self::Multipliers) {
        S::constraint_rate_derivatives(self, t, q, v)
    }
    fn reaction_derivatives(&self, t: T, q: &SVector<T, N>, multipliers: &Self::Multipliers) -> Self::ReactionMatrix {
        S::reaction_derivatives(self, t, q, multipliers)
    }
    fn is_dropped(&self, constraint: usize) -> bool {
        S::is_dropped(self, constraint)
    }
    fn broken(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Option<(usize, T)> {
        S::broken(self, t, q, v)
    }
}

impl<const N: usize, S: ConvertibleConstrained<N>> ConvertibleConstrained<N> for &S {
    type In<T: Real> = S::In<T>;

    fn convert<T: Real>(&self) -> Self::In<T> {
        S::convert(self)
    }
}

/// The bordered mass matrix of a system, in its blocks.
pub(crate) fn bordered<S: Constrained<N, T>, const N: usize, T: Real>() -> Bordered<T> {
    Bordered::new(N, S::CONSTRAINTS.len(), S::BLOCKS)
}

/// Factors the mass matrix bordered by gradients, without dropped constraints.
///
/// # Errors
/// As [`Bordered::factor`].
pub(crate) fn border<S: Constrained<N, T>, const N: usize, T: Real>(
    bordered: &mut Bordered<T>,
    system: &S,
    mass: &impl Matrix<N, T>,
    gradients: &S::Gradients,
) -> Result<(), Unsolvable> {
    bordered.factor_without(mass, gradients, |r| system.is_dropped(r))
}

/// `Aᵀλ`.
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
pub(crate) fn inertia<const N: usize, T: Real>(mass: &impl Matrix<N, T>, v: &SVector<T, N>) -> SVector<T, N> {
    let mut inertia = SVector::zeros();
    mass.each_entry(|row, column, value| inertia[row] += (value * v[column]).abs());
    inertia
}

/// The diagonal of a matrix.
pub(crate) fn diagonal<const N: usize, T: Real>(matrix: &impl Matrix<N, T>) -> SVector<T, N> {
    let mut diagonal = SVector::zeros();
    matrix.each_entry(|row, column, value| {
        if row == column {
            diagonal[row] = value;
        }
    });
    diagonal
}

/// The mass matrix with 1 for coordinates without mass that no holonomic constraint moves: it does not say where they are
/// nearest, and they stay. `None` if there are none.
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

/// Whether a part of a correction of this length brought the place of convergence nearer: `behind` is the length of the
/// next correction with the same factors. Deuflhard's natural monotonicity test.
pub(crate) fn is_shortened(behind: f64, length: f64, part: f64) -> bool {
    behind < (1.0 - 0.25 * part) * length
}

/// Momenta and velocities that each coordinate would have if the whole of v and p were along it, in the metric of the
/// diagonal of the mass matrix; zero for a coordinate without mass.
///
/// They bound the terms of a row from below. A solution of linear equations is accurate relative to the whole vector, not
/// to each entry, so a row with tiny terms, such as that of z in a motion in the plane z = 0, is as accurate as the others.
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

/// Whether a correction reduced a residual in roundings. That of a row without terms is infinite and measures nothing.
pub(crate) fn is_reduced(next: f64, residual: f64) -> bool {
    next < residual || residual.is_infinite() && !next.is_nan()
}
