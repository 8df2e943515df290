//! A state of rest, with the matrices and the rates of small motions about it.
//!
//! At rest the reactions balance the forces, and small motions x about an equilibrium lie along a basis Z of the
//! directions that the constraints allow: `x = Z y` with `A Z = 0`. Without constraints Z is the unit matrix.
//!
//! ```text
//! L_q + f − L_vt + AᵀΛ = 0       g(t, q) = 0
//! Zᵀ M Z y'' + Zᵀ C Z y' + Zᵀ (K − ∂(AᵀΛ)/∂q) Z y = 0
//! ```

use super::{no_eigenvalues, spectrum};
use crate::error::StepError;
use crate::first_order::STRUCTURE;
use alloc::vec::Vec;
use nalgebra::{Complex, DMatrix, SVector};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

/// Largest difference of a matrix along the constraints from its transpose, relative to its entries: roundings of
/// products.
const SYMMETRIC: f64 = 32.0 * f64::EPSILON;
/// Smallest part of a coordinate in a free motion of length 1.
const MOVES: f64 = 1e-6;

/// A state of rest without acceleration; see [`Dynamics::equilibrium`](super::Dynamics::equilibrium).
#[derive(Clone, Debug, PartialEq)]
pub struct Equilibrium<const N: usize> {
    /// Time.
    pub t: f64,
    /// Coordinates.
    pub q: SVector<f64, N>,
    /// The multipliers Λ, in the order of [`Motion::CONSTRAINTS`](crate::motion::Motion::CONSTRAINTS): the reaction is
    /// AᵀΛ.
    pub multipliers: Vec<f64>,
    /// The basis Z of the directions that the constraints allow, orthonormal columns: `x = Z y`.
    pub directions: DMatrix<f64>,
    /// `Zᵀ M Z`.
    pub mass: DMatrix<f64>,
    /// `Zᵀ C Z`, with `C = −∂F/∂v` and F the generalized force at zero acceleration: damping and gyroscopic terms.
    pub damping: DMatrix<f64>,
    /// `Zᵀ (K − ∂(AᵀΛ)/∂q) Z`, with `K = −∂F/∂q`.
    pub stiffness: DMatrix<f64>,
    /// The free motions, along which the forces do not change: one column of length 1 for each, a change of the
    /// coordinates. None if the equilibrium is isolated.
    pub free_motions: DMatrix<f64>,
    /// Largest unbalanced force and largest constraint, in units of their rounding-error bounds.
    pub residual: f64,
}

impl<const N: usize> Equilibrium<N> {
    /// For each coordinate, whether it changes along a free motion. Without constraints it then has the value of the
    /// guess.
    #[must_use]
    pub fn free(&self) -> [bool; N] {
        core::array::from_fn(|k| self.free_motions.row(k).iter().any(|part| part.abs() > MOVES))
    }

    /// The rates λ of small motions e^(λt), two for each direction, in radians per unit of time, ascending by the size
    /// of their imaginary part, then by their real part. The damping ratio of an oscillation is −Re λ/|λ|; the
    /// equilibrium is unstable if a real part is positive.
    ///
    /// Without damping and gyroscopic terms the rates follow from the symmetric problem `K x = ω² M x`: real parts of
    /// oscillations are then exactly zero, and so are both rates of a free motion; ω² has an error of a few ulps of the
    /// largest ω².
    ///
    /// A direction without mass has one rate: those of `C y' + K y = 0`, if L is linear in the velocities.
    ///
    /// # Errors
    /// [`StepError::Singular`] if the mass matrix is singular along these directions, [`StepError::NonFinite`] if the QR
    /// iteration does not converge.
    pub fn rates(&self) -> Result<Vec<Complex<f64>>, StepError> {
        let Self { t, mass, damping, stiffness, .. } = self;
        let count = mass.nrows();
        let is_massless = |k: &usize| mass.row(*k).iter().all(|entry| *entry == 0.0);
        let (massless, massive): (Vec<usize>, Vec<usize>) = (0..count).partition(is_massless);
        if !massless.is_empty() {
            let [c, k] = [damping, stiffness].map(|of| part(of, &massless));
            let singular = StepError::Singular { t: *t, matrix: STRUCTURE };
            let a = c.lu().solve(&-k).filter(|of| of.iter().all(|entry| entry.is_finite())).ok_or(singular)?;
            let mut rates = spectrum::eigenvalues(&a).ok_or(no_eigenvalues(*t))?;
            if !massive.is_empty() {
                // Coordinates at rest.
                let [mass, damping, stiffness] = [mass, damping, stiffness].map(|of| part(of, &massive));
                rates.extend(Self { mass, damping, stiffness, ..self.clone() }.rates()?);
                spectrum::sort(&mut rates);
            }
            return Ok(rates);
        }
        if damping.iter().all(|entry| *entry == 0.0)
            && self.is_symmetric()
            && let Some(mut squares) = spectrum::squared_frequencies(stiffness, mass)
        {
            squares.sort_by(|one, other| one.abs().total_cmp(&other.abs()));
            squares.iter_mut().take(self.free_motions.ncols()).for_each(|square| *square = 0.0);
            return Ok(oscillations(&squares));
        }
        let factors = mass.clone().lu();
        let singular = StepError::Singular { t: *t, matrix: "mass matrix" };
        let solved = |forces: &DMatrix<f64>| {
            factors.solve(forces).filter(|of| of.iter().all(|entry| entry.is_finite())).ok_or(singular)
        };
        let (by_q, by_v) = (solved(stiffness)?, solved(damping)?);
        let a = DMatrix::from_fn(2 * count, 2 * count, |i, j| match (i < count, j < count) {
            (true, _) => f64::from(u8::from(j == count + i)),
            (false, true) => -by_q[(i - count, j)],
            (false, false) => -by_v[(i - count, j - count)],
        });
        spectrum::eigenvalues(&a).ok_or(no_eigenvalues(*t))
    }

    /// The frequencies of the oscillations about it, ascending, in radians per unit of time: the positive imaginary
    /// parts of [`Equilibrium::rates`].
    ///
    /// # Errors
    /// As [`Equilibrium::rates`].
    pub fn frequencies(&self) -> Result<Vec<f64>, StepError> {
        Ok(self.rates()?.into_iter().map(|rate| rate.im).filter(|frequency| *frequency > 0.0).collect())
    }

    /// Whether the stiffness equals its transpose to rounding.
    fn is_symmetric(&self) -> bool {
        let (k, count) = (&self.stiffness, self.stiffness.nrows());
        if count < N {
            return (k - k.transpose()).amax() <= SYMMETRIC * k.amax();
        }
        (0..count).all(|i| {
            (0..i).all(|j| {
                let size = (k[(i, i)] * k[(j, j)]).abs().sqrt().max(k[(i, j)].abs());
                (k[(i, j)] - k[(j, i)]).abs() <= 4.0 * f64::EPSILON * size
            })
        })
    }
}

/// The rows and columns of these indices.
fn part(of: &DMatrix<f64>, places: &[usize]) -> DMatrix<f64> {
    of.select_rows(places).select_columns(places)
}

/// The rates ±iω of these ω², sorted.
fn oscillations(squares: &[f64]) -> Vec<Complex<f64>> {
    let pair = |square: &f64| {
        let size = square.abs().sqrt();
        let rate = if *square < 0.0 { Complex::new(-size, 0.0) } else { Complex::new(0.0, size) };
        [-rate, rate]
    };
    let mut rates: Vec<_> = squares.iter().flat_map(pair).collect();
    spectrum::sort(&mut rates);
    rates
}
