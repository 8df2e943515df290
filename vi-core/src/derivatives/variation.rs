//! Directions in which a node and the parameters of a system vary.
//!
//! In: how fast each number of a node and each parameter changes. Out: the node and the system in dual numbers.

use crate::lagrangian::{Lagrangian, Parameters};
use crate::node::Node;
use crate::real::Dual;
use crate::stepping::Convertible;
use nalgebra::SVector;

/// How fast a node and the parameters of its system change in one direction.
#[derive(Clone, Debug, PartialEq)]
pub struct Variation<const N: usize> {
    /// Of the time.
    pub t: f64,
    /// Of the coordinates.
    pub q: SVector<f64, N>,
    /// Of the momenta.
    pub p: SVector<f64, N>,
    /// Of the energy that an energy-preserving run keeps; of no meaning to others.
    pub energy: f64,
    /// Of the parameters, in the order of [`Lagrangian::PARAMETERS`]; those beyond the end do not change. The same all along a run.
    pub parameters: Vec<f64>,
}

impl<const N: usize> Variation<N> {
    /// No change.
    #[must_use]
    pub fn zero() -> Self {
        Self { t: 0.0, q: SVector::zeros(), p: SVector::zeros(), energy: 0.0, parameters: Vec::new() }
    }

    /// The direction of a coordinate, by its index; none beyond the last.
    #[must_use]
    pub fn of_coordinate(index: usize) -> Self {
        let mut variation = Self::zero();
        if let Some(entry) = variation.q.get_mut(index) {
            *entry = 1.0;
        }
        variation
    }

    /// The direction of a momentum, by its index; none beyond the last.
    #[must_use]
    pub fn of_momentum(index: usize) -> Self {
        let mut variation = Self::zero();
        if let Some(entry) = variation.p.get_mut(index) {
            *entry = 1.0;
        }
        variation
    }

    /// The directions of all coordinates, and then of all momenta: the variations are the columns of the tangent map.
    #[must_use]
    pub fn of_state() -> Vec<Self> {
        (0..N).map(Self::of_coordinate).chain((0..N).map(Self::of_momentum)).collect()
    }

    /// The direction of a parameter of the system S, by its name; `None` where it has none of this name.
    #[must_use]
    pub fn of_parameter<S: Lagrangian<N>>(name: &str) -> Option<Self> {
        let index = S::PARAMETERS.iter().position(|known| *known == name)?;
        let mut variation = Self::zero();
        variation.parameters = vec![0.0; S::PARAMETERS.len()];
        variation.parameters[index] = 1.0;
        Some(variation)
    }

    /// The system, its parameters varied.
    pub(crate) fn system<S: Convertible<N> + Lagrangian<N>>(&self, system: &S) -> S::In<Dual<f64>> {
        let mut dual = system.convert::<Dual<f64>>();
        for (name, slope) in S::PARAMETERS.iter().zip(&self.parameters) {
            if let Some(parameter) = dual.parameter_mut(name) {
                parameter.slope = *slope;
            }
        }
        dual
    }

    /// The node, varied.
    pub(super) fn node(&self, node: &Node<N>) -> Node<N, Dual<f64>> {
        let mut dual = node.map(Dual::fixed);
        dual.t.slope = self.t;
        dual.energy.slope = self.energy;
        for k in 0..N {
            dual.q[k].slope = self.q[k];
            dual.p[k].slope = self.p[k];
        }
        dual
    }

    /// Takes the variation of a node; that of the parameters stays.
    pub(super) fn take(&mut self, node: &Node<N, Dual<f64>>) {
        // Both parts of a sum vary.
        let whole = |number: Dual<f64>, low: Dual<f64>| number.slope + low.slope;
        self.t = whole(node.t, node.t_low);
        self.energy = whole(node.energy, node.energy_low);
        for k in 0..N {
            self.q[k] = whole(node.q[k], node.q_low[k]);
            self.p[k] = whole(node.p[k], node.p_low[k]);
        }
    }
}
