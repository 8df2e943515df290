//! What derivatives of runs need of a system, for systems with and without constraints.

use super::variation::Variation;
use crate::collocation::Collocation;
use crate::constrained::{Constrained, ConvertibleConstrained, velocity_along};
use crate::error::StepError;
use crate::lagrangian::{Lagrangian, Parameters};
use crate::linear;
use crate::real::{Dual, Real};
use crate::state::State;
use crate::stepping::Convertible;
use nalgebra::SVector;

/// The kind of systems without constraints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unconstrained {}

/// The kind of systems with constraints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WithConstraints {}

/// A system of a kind, [`Unconstrained`] or [`WithConstraints`], whose motion has derivatives. Every generated system
/// implements it.
pub trait Varying<const N: usize, Kind>: Lagrangian<N> + Copy {
    /// The same system over the numbers T.
    type Over<T: Real>: Lagrangian<N, T> + Parameters<T>;

    /// Converts the system; every parameter is rounded to T.
    fn over<T: Real>(&self) -> Self::Over<T>;

    /// The derivative of the velocity v of a state, whose momenta are `state.p`, along a tangent vector.
    ///
    /// # Errors
    /// [`StepError::Singular`] if the mass matrix, bordered by the constraints, is singular.
    fn velocity_along(
        &self,
        state: &State<N>,
        v: &SVector<f64, N>,
        variation: &Variation<N>,
    ) -> Result<SVector<f64, N>, StepError>;
}

impl<S: Convertible<N> + Collocation<N>, const N: usize> Varying<N, Unconstrained> for S {
    type Over<T: Real> = S::In<T>;

    fn over<T: Real>(&self) -> S::In<T> {
        self.convert()
    }

    fn velocity_along(
        &self,
        State { t, q, .. }: &State<N>,
        v: &SVector<f64, N>,
        variation: &Variation<N>,
    ) -> Result<SVector<f64, N>, StepError> {
        let matrix = self.point(*t, q, v).mass;
        let along = |value: f64, slope: f64| Dual { value, slope };
        // L_v(t, q, v) = p
        let system = varied::<S, Unconstrained, N>(self, variation);
        let point = system.point(along(*t, variation.t), &q.zip_map(&variation.q, along), &v.map(Dual::fixed));
        let of_v = linear::solve(&matrix, &(variation.p - point.momentum.map(|entry| entry.slope)));
        of_v.ok_or(StepError::Singular { t: *t, matrix: "mass matrix" })
    }
}

impl<S: ConvertibleConstrained<N> + Constrained<N>, const N: usize> Varying<N, WithConstraints> for S {
    type Over<T: Real> = S::In<T>;

    fn over<T: Real>(&self) -> S::In<T> {
        self.convert()
    }

    fn velocity_along(
        &self,
        state: &State<N>,
        v: &SVector<f64, N>,
        variation: &Variation<N>,
    ) -> Result<SVector<f64, N>, StepError> {
        velocity_along(self, state, v, variation)
    }
}

/// A system with parameters that vary in one direction.
pub(crate) fn varied<S: Varying<N, K>, K, const N: usize>(system: &S, variation: &Variation<N>) -> S::Over<Dual<f64>> {
    let mut varied = system.over::<Dual<f64>>();
    for (name, slope) in S::PARAMETERS.iter().zip(&variation.parameters) {
        if let Some(parameter) = varied.parameter_mut(name) {
            parameter.slope = *slope;
        }
    }
    varied
}
