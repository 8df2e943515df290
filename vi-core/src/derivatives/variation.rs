//! Directions in which a node and the parameters of a system vary.
//!
//! In: how fast each number of a node and each parameter changes. Out: the node and the system in dual numbers.

use crate::error::StepError;
use crate::lagrangian::{Lagrangian, Parameters};
use crate::node::Node;
use crate::real::{Dual, Slopes};
use crate::state::State;
use crate::stepping::{Convertible, Discretized};
use nalgebra::SVector;

/// Directions that one evaluation follows.
pub(crate) const TOGETHER: usize = 4;

/// A number that varies in W directions.
pub(crate) type Varied<const W: usize = TOGETHER> = Dual<f64, Slopes<f64, W>>;

/// The variations of a step are beyond the range of numbers, or not a number.
pub(crate) fn not_finite(t: f64) -> StepError {
    StepError::NonFinite { t, quantity: "variation of a step", expression: None }
}

/// A variation has more parameters than the system of the step from the time `t`.
pub(crate) fn more_parameters(t: f64) -> StepError {
    let because = "a variation has more parameters than the system; give at most as many as `PARAMETERS` names";
    StepError::NoDerivative { t, because }
}

/// How fast a node and the parameters of its system change in one direction.
#[derive(Clone, Debug, PartialEq)]
pub struct Variation<const N: usize> {
    /// Of the time.
    pub t: f64,
    /// Of the coordinates.
    pub q: SVector<f64, N>,
    /// Of the momenta.
    pub p: SVector<f64, N>,
    /// Of the energy that an energy-preserving run keeps; of no meaning to others. [`crate::Run::set_parameters`] changes it by that of `H_new − H_old`.
    pub energy: f64,
    /// Of the length of a step: h, or Δτ in transformed time. A method that finds its lengths ignores it. Constant along a run.
    pub h: f64,
    /// Of the parameters, in the order of [`Lagrangian::PARAMETERS`]; those beyond the end do not change. The same all along a run.
    pub parameters: Vec<f64>,
}

impl<const N: usize> Variation<N> {
    /// No change.
    #[must_use]
    pub fn zero() -> Self {
        Self { t: 0.0, q: SVector::zeros(), p: SVector::zeros(), energy: 0.0, h: 0.0, parameters: Vec::new() }
    }

    /// The direction of a coordinate, by its index from 0.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] for an index that no coordinate has.
    pub fn of_coordinate(index: usize) -> Result<Self, StepError> {
        Self::of_entry(index, "the index of a coordinate", |variation| &mut variation.q)
    }

    /// The direction of a momentum, by its index from 0.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] for an index that no momentum has.
    pub fn of_momentum(index: usize) -> Result<Self, StepError> {
        Self::of_entry(index, "the index of a momentum", |variation| &mut variation.p)
    }

    /// The direction of the length of a step.
    pub(crate) fn of_length() -> Self {
        Self { h: 1.0, ..Self::zero() }
    }

    /// Adds a multiple of another one, at the same node.
    pub(crate) fn add(&mut self, other: &Self, factor: f64) {
        self.t += other.t * factor;
        self.q += other.q * factor;
        self.p += other.p * factor;
        self.energy += other.energy * factor;
    }

    /// The direction of one entry of a vector.
    fn of_entry(
        index: usize,
        input: &'static str,
        vector: impl Fn(&mut Self) -> &mut SVector<f64, N>,
    ) -> Result<Self, StepError> {
        let mut variation = Self::zero();
        #[allow(clippy::cast_precision_loss)] // for the message
        let value = index as f64;
        let allowed = "below the number of coordinates";
        let beyond = StepError::InvalidInput { input, allowed, value };
        *vector(&mut variation).get_mut(index).ok_or(beyond)? = 1.0;
        Ok(variation)
    }

    /// The directions of all coordinates, and then of all momenta: the variations are the columns of the tangent map.
    #[must_use]
    pub fn of_state() -> Vec<Self> {
        let mut variations = vec![Self::zero(); 2 * N];
        for (index, variation) in variations.iter_mut().enumerate() {
            let (vector, index) = if index < N { (&mut variation.q, index) } else { (&mut variation.p, index - N) };
            vector[index] = 1.0;
        }
        variations
    }

    /// The direction of a parameter of the system S, by its name.
    ///
    /// Time, coordinates, momenta and the energy that is kept stay. Where the start is given by other numbers, velocities or the step of `from_midpoint`, what they
    /// change by with the parameter belongs into `p` and `energy` of the variation. [`Tangent::from_start`](super::Tangent::from_start) sets `energy`.
    ///
    /// # Errors
    /// [`StepError::UnknownParameter`] for a name that no parameter of S has.
    pub fn of_parameter<S: Lagrangian<N>>(name: &str) -> Result<Self, StepError> {
        let parameters: Vec<f64> = S::PARAMETERS.iter().map(|known| if *known == name { 1.0 } else { 0.0 }).collect();
        if parameters.iter().all(|slope| *slope == 0.0) {
            return Err(StepError::UnknownParameter { system: S::NAME, parameters: S::PARAMETERS });
        }
        Ok(Self { parameters, ..Self::zero() })
    }

    /// Refuses what is not finite: the derivative of a force may be infinite where the force is not, and what varies along a chaotic run may leave the range of numbers.
    pub(crate) fn check_finite(variations: &[Self], t: f64) -> Result<(), StepError> {
        // Zero times a number is zero, or NaN where the number is not finite: one sum, and one test for all.
        let is_finite = |of: &Self| (of.q * 0.0 + of.p * 0.0).sum() + of.t * 0.0 + of.energy * 0.0 == 0.0;
        if variations.iter().all(is_finite) { Ok(()) } else { Err(not_finite(t)) }
    }

    /// The number that varies as `of` says in each of the directions.
    pub(crate) fn number<const W: usize>(variations: &[Self], value: f64, of: impl Fn(&Self) -> f64) -> Varied<W> {
        let mut slopes = [0.0; W];
        for (slope, variation) in slopes.iter_mut().zip(variations) {
            *slope = of(variation);
        }
        Dual { value, slope: Slopes(slopes) }
    }

    /// The system, its parameters varied in each of the directions; none where neither they, the time, nor the length of a step vary in any.
    ///
    /// # Errors
    /// [`StepError::NoDerivative`] of the step from the time `t` where a direction has more parameters than the system.
    pub(crate) fn varying_system<S: Convertible<N> + Lagrangian<N>>(
        variations: &[Self],
        system: &S,
        t: f64,
    ) -> Result<Option<S::In<Varied>>, StepError> {
        Ok(Self::are_explicit::<S>(variations, t)?.then(|| Self::system(variations, system)))
    }

    /// The same system with its steps.
    ///
    /// # Errors
    /// As [`Self::varying_system`].
    pub(crate) fn varying_steps<S: Discretized<N>>(
        variations: &[Self],
        system: &S,
        t: f64,
    ) -> Result<Option<S::Steps<Varied>>, StepError> {
        Ok(Self::are_explicit::<S>(variations, t)?.then(|| Self::steps(variations, system)))
    }

    /// Whether the time of a system that depends on it, the length of a step, or a parameter varies in any direction.
    fn are_explicit<S: Lagrangian<N>>(variations: &[Self], t: f64) -> Result<bool, StepError> {
        if variations.iter().any(|variation| variation.parameters.len() > S::PARAMETERS.len()) {
            return Err(more_parameters(t));
        }
        let is_in_time = |of: &Self| !S::AUTONOMOUS && of.t != 0.0 || of.h != 0.0;
        let is_explicit = |of: &Self| is_in_time(of) || of.parameters.iter().any(|slope| *slope != 0.0);
        Ok(variations.iter().any(is_explicit))
    }

    /// The system, its parameters varied in each of the directions.
    pub(crate) fn system<S: Convertible<N> + Lagrangian<N>, const W: usize>(
        variations: &[Self],
        system: &S,
    ) -> S::In<Varied<W>> {
        Self::vary_parameters(variations, S::PARAMETERS, system.convert())
    }

    /// The system with its steps, its parameters varied in each of the directions.
    pub(super) fn steps<S: Discretized<N>, const W: usize>(variations: &[Self], system: &S) -> S::Steps<Varied<W>> {
        Self::vary_parameters(variations, S::PARAMETERS, system.steps())
    }

    /// A system whose parameters of these names vary in each of the directions.
    fn vary_parameters<Y: Parameters<Varied<W>>, const W: usize>(
        variations: &[Self],
        names: &[&str],
        mut system: Y,
    ) -> Y {
        for (direction, variation) in variations.iter().enumerate() {
            for (name, slope) in names.iter().zip(&variation.parameters) {
                if let Some(parameter) = system.parameter_mut(name) {
                    parameter.slope.0[direction] = *slope;
                }
            }
        }
        system
    }

    /// The node, its time varied in each of the directions.
    pub(super) fn in_time<const W: usize>(variations: &[Self], node: &Node<N>) -> Node<N, Varied<W>> {
        let t = Self::number(variations, node.t, |variation| variation.t);
        Node { t, ..node.map(Varied::<W>::fixed) }
    }

    /// The node, varied in each of the directions.
    pub(super) fn node<const W: usize>(variations: &[Self], node: &Node<N>) -> Node<N, Varied<W>> {
        let mut varied = node.map(Varied::<W>::fixed);
        for (direction, variation) in variations.iter().enumerate() {
            varied.t.slope.0[direction] = variation.t;
            varied.energy.slope.0[direction] = variation.energy;
            for k in 0..N {
                varied.q[k].slope.0[direction] = variation.q[k];
                varied.p[k].slope.0[direction] = variation.p[k];
            }
        }
        varied
    }
}

/// What H at a state changes by in each direction: `v·δp − δL`, v fixed.
pub(crate) fn changes_of_energy<S, const N: usize>(
    system: &S,
    state: &State<N>,
    directions: &[Variation<N>],
) -> Result<Vec<f64>, StepError>
where
    S: Lagrangian<N> + Convertible<N>,
{
    let v = state.velocity(system)?;
    let node = Node::new(*state, 0.0);
    let mut changes = Vec::with_capacity(directions.len());
    for directions in directions.chunks(TOGETHER) {
        let node = Variation::node::<TOGETHER>(directions, &node);
        let varied = Variation::system(directions, system).lagrangian(node.t, &node.q, &v.map(Dual::fixed));
        let of_lagrangian = varied.slope.0.into_iter();
        changes.extend(directions.iter().zip(of_lagrangian).map(|(direction, slope)| v.dot(&direction.p) - slope));
    }
    Ok(changes)
}
