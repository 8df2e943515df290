//! Quantities of a system and of a run that a controller needs, type-erased. Matrices are flat, row by row.

use vi_core::StepError;
use vi_core::control::{Equilibrium, Linearization};
use vi_core::nalgebra::{Complex, DMatrix};

/// A linearization: `value + A δx + B δu`.
#[derive(Clone, Debug, PartialEq)]
pub struct Linear {
    /// Time.
    pub t: f64,
    /// The value at the point of linearization, 2N numbers.
    pub value: Vec<f64>,
    /// A, 2N rows of 2N numbers.
    pub a: Vec<f64>,
    /// B, 2N rows with a number for each input.
    pub b: Vec<f64>,
}

impl From<Linearization> for Linear {
    fn from(of: Linearization) -> Self {
        let rows = |matrix: DMatrix<f64>| matrix.transpose().as_slice().to_vec();
        Self { t: of.t, value: of.value.as_slice().to_vec(), a: rows(of.a), b: rows(of.b) }
    }
}

/// A state of rest without acceleration, as [`Equilibrium`].
#[derive(Clone, Debug, PartialEq)]
pub struct Rest {
    /// Time.
    pub t: f64,
    /// Coordinates.
    pub q: Vec<f64>,
    /// The multiplier Λ of each constraint.
    pub multipliers: Vec<f64>,
    /// Number D of directions that the constraints allow: N without constraints.
    pub freedom: usize,
    /// A basis of these directions, N rows of D numbers: the unit vectors without constraints.
    pub directions: Vec<f64>,
    /// M, C and K of `M x'' + C x' + K x = 0` along these directions, each D rows of D numbers.
    pub matrices: [Vec<f64>; 3],
    /// For each coordinate, whether it changes along a motion along which the forces do not.
    pub free: Vec<bool>,
    /// Number of independent such motions.
    pub free_motions: usize,
    /// Largest unbalanced force, in roundings.
    pub residual: f64,
    /// Real and imaginary part of each rate of small motions.
    pub rates: Vec<[f64; 2]>,
}

impl Rest {
    pub(crate) fn of<const N: usize>(of: &Equilibrium<N>) -> Result<Self, StepError> {
        let rows = |matrix: &DMatrix<f64>| matrix.transpose().as_slice().to_vec();
        Ok(Self {
            t: of.t,
            q: of.q.as_slice().to_vec(),
            multipliers: of.multipliers.clone(),
            freedom: of.directions.ncols(),
            directions: rows(&of.directions),
            matrices: [&of.mass, &of.damping, &of.stiffness].map(rows),
            free: of.free().to_vec(),
            free_motions: of.free_motions.ncols(),
            residual: of.residual,
            rates: pairs(of.rates()?),
        })
    }
}

/// Real and imaginary part of each number.
pub(crate) fn pairs(of: Vec<Complex<f64>>) -> Vec<[f64; 2]> {
    of.into_iter().map(|number| [number.re, number.im]).collect()
}

/// Quantities of a system that a controller needs.
pub trait Control {
    /// Indices of the inputs among the parameters.
    fn inputs(&self) -> &'static [usize];
    /// The mass matrix at as many points as there are times, N² numbers for each; appends to `out`.
    fn mass_matrix(&self, points: [&[f64]; 3], out: &mut Vec<f64>);
    /// The bias at points, N numbers for each; appends to `out`.
    fn bias(&self, points: [&[f64]; 3], out: &mut Vec<f64>);
    /// The linearization of x = (q, v).
    ///
    /// # Errors
    /// As [`vi_core::control::Dynamics::linearization`]; [`StepError::InvalidInput`] for another number of coordinates
    /// or velocities, here and below.
    fn linearization(&self, t: f64, q: &[f64], v: &[f64]) -> Result<Linear, StepError>;
    /// The equilibrium near a guess of the coordinates.
    ///
    /// # Errors
    /// As [`vi_core::control::Dynamics::equilibrium`].
    fn equilibrium(&self, t: f64, guess: &[f64]) -> Result<Rest, StepError>;
}
