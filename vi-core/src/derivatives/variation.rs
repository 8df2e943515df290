//! Tangent vectors of nodes and parameters, and their dual numbers.

use crate::constrained;
use crate::error::StepError;
use crate::first_order::first_order_flow;
use crate::kind::Kind;
use crate::lagrangian::{Lagrangian, Parameters};
use crate::linear::{self, Matrix};
use crate::motion::Motion;
use crate::node::Node;
use crate::real::{Dual, Slopes};
use crate::state::State;
use crate::stepping::{Convertible, Discretized};
use alloc::vec::Vec;
use nalgebra::SVector;

/// Number of directions per evaluation.
pub(crate) const TOGETHER: usize = 4;

/// A number with derivatives in W directions.
pub(crate) type Varied<const W: usize = TOGETHER> = Dual<f64, Slopes<f64, W>>;

/// The tangent vectors of a step are out of range or NaN.
pub(crate) fn not_finite(t: f64) -> StepError {
    StepError::NonFinite { t, quantity: "tangent vector of a step", expression: None }
}

/// The Jacobian of the step equations is singular.
pub(crate) fn singular(t: f64) -> StepError {
    StepError::Singular { t, matrix: "derivative of the equations of a step" }
}

/// The error of an equation `A x = rhs` for tangent vectors without a solution.
pub(super) fn unsolved<A: Matrix<N, f64>, const N: usize>(matrix: &A, rhs: &SVector<f64, N>, t: f64) -> StepError {
    let are_finite = matrix.dense().iter().chain(rhs).all(|entry| entry.is_finite());
    if are_finite { singular(t) } else { not_finite(t) }
}

/// A tangent vector has more parameters than the system of the step from the time `t`.
pub(crate) fn more_parameters(t: f64) -> StepError {
    let because = "a tangent vector has more parameters than the system; `PARAMETERS` lists them";
    StepError::NoDerivative { t, because }
}

/// Derivatives of each entry in one direction.
pub(super) fn slope_along<const N: usize, const W: usize>(
    direction: usize,
    of: &SVector<Varied<W>, N>,
) -> SVector<f64, N> {
    of.map(|entry| entry.slope.0[direction])
}

/// A tangent vector: derivatives of a node and of the parameters of its system in one direction.
#[derive(Clone, Debug, PartialEq)]
pub struct Variation<const N: usize> {
    /// Derivative of the time.
    pub t: f64,
    /// Derivatives of the coordinates.
    pub q: SVector<f64, N>,
    /// Derivatives of the momenta.
    pub p: SVector<f64, N>,
    /// Derivative of the energy that an energy-preserving run preserves; other runs ignore it.
    /// [`crate::Run::set_parameters`] adds the derivative of `H_new − H_old`.
    pub energy: f64,
    /// Derivative of the step length: h, or Δτ in transformed time. Constant along a run. For methods that find their
    /// lengths it is the derivative of the first length, from which [`Tangent::from_start`](super::Tangent::from_start)
    /// derives the energy; later steps and adaptive ones ignore it.
    pub h: f64,
    /// Derivatives of the parameters, in the order of [`Lagrangian::PARAMETERS`]; missing entries are zero. Constant
    /// along a run.
    pub parameters: Vec<f64>,
}

impl<const N: usize> Variation<N> {
    /// The zero vector.
    #[must_use]
    pub fn zero() -> Self {
        Self { t: 0.0, q: SVector::zeros(), p: SVector::zeros(), energy: 0.0, h: 0.0, parameters: Vec::new() }
    }

    /// The direction of a coordinate, by its index from 0.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] for an index out of range.
    pub fn of_coordinate(index: usize) -> Result<Self, StepError> {
        Self::of_entry(index, "the index of a coordinate", |variation| &mut variation.q)
    }

    /// The direction of a momentum, by its index from 0.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] for an index out of range.
    pub fn of_momentum(index: usize) -> Result<Self, StepError> {
        Self::of_entry(index, "the index of a momentum", |variation| &mut variation.p)
    }

    /// The direction of the step length.
    #[must_use]
    pub fn of_length() -> Self {
        Self { h: 1.0, ..Self::zero() }
    }

    /// Adds a multiple of another tangent vector at the same node.
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

    /// The directions of all coordinates, then of all momenta: after a step they are the columns of the tangent map.
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
    /// Time, coordinates, momenta and the preserved energy stay. If other numbers define the start, such as velocities
    /// or the step of `from_midpoint`, add their derivatives with respect to the parameter to `p` and `energy`.
    /// [`Tangent::from_start`](super::Tangent::from_start) sets `energy`.
    ///
    /// # Errors
    /// [`StepError::UnknownParameter`] for a name that no parameter of S has.
    pub fn of_parameter<S: Lagrangian<N>>(name: &str) -> Result<Self, StepError> {
        Self::of_name(name, S::NAME, S::PARAMETERS)
    }

    /// The direction of a parameter of a system, by its name; see [`Variation::of_parameter`].
    ///
    /// # Errors
    /// As [`Variation::of_parameter`].
    pub(crate) fn of_parameter_of(system: &impl Lagrangian<N>, name: &str) -> Result<Self, StepError> {
        Self::of_name(name, system.name(), system.parameters())
    }

    fn of_name(name: &str, system: &'static str, parameters: &'static [&'static str]) -> Result<Self, StepError> {
        let index = parameters.iter().position(|known| *known == name);
        index.map(Self::of_index).ok_or(StepError::UnknownParameter { system, parameters })
    }

    /// The direction of the parameter of this index in [`Lagrangian::PARAMETERS`].
    #[must_use]
    pub fn of_index(index: usize) -> Self {
        let mut parameters = alloc::vec![0.0; index + 1];
        parameters[index] = 1.0;
        Self { parameters, ..Self::zero() }
    }

    /// Rejects values that are not finite. A finite force may have an infinite derivative, and tangent vectors of a
    /// chaotic run may overflow.
    pub(crate) fn check_finite(variations: &[Self], t: f64) -> Result<(), StepError> {
        // Zero times a number is zero, or NaN for one that is not finite. One sum then tests all entries.
        let is_finite = |of: &Self| (of.q * 0.0 + of.p * 0.0).sum() + of.t * 0.0 + of.energy * 0.0 == 0.0;
        if variations.iter().all(is_finite) { Ok(()) } else { Err(not_finite(t)) }
    }

    /// The number with its derivative in each direction; `of` selects it.
    pub(crate) fn number<const W: usize>(variations: &[Self], value: f64, of: impl Fn(&Self) -> f64) -> Varied<W> {
        let mut slopes = [0.0; W];
        for (slope, variation) in slopes.iter_mut().zip(variations) {
            *slope = of(variation);
        }
        Dual { value, slope: Slopes(slopes) }
    }

    /// The system with parameters that vary in each direction; `None` if neither they, the time, nor the step length
    /// vary.
    ///
    /// # Errors
    /// [`StepError::NoDerivative`] for the step from the time `t` if a direction has more parameters than the system.
    pub(crate) fn varying_system<S: Convertible<N> + Lagrangian<N>>(
        variations: &[Self],
        system: &S,
        t: f64,
    ) -> Result<Option<S::In<Varied>>, StepError> {
        Ok(Self::are_explicit(variations, system, t)?.then(|| Self::system(variations, system)))
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
        Ok(Self::are_explicit(variations, system, t)?.then(|| Self::steps(variations, system)))
    }

    /// Whether a parameter, the step length, or the time of a nonautonomous system varies in any direction.
    fn are_explicit(variations: &[Self], system: &impl Lagrangian<N>, t: f64) -> Result<bool, StepError> {
        if variations.iter().any(|variation| variation.parameters.len() > system.parameters().len()) {
            return Err(more_parameters(t));
        }
        let is_in_time = |of: &Self| !system.is_autonomous() && of.t != 0.0 || of.h != 0.0;
        let is_explicit = |of: &Self| is_in_time(of) || of.parameters.iter().any(|slope| *slope != 0.0);
        Ok(variations.iter().any(is_explicit))
    }

    /// The system with parameters that vary in each direction.
    pub(crate) fn system<S: Convertible<N> + Lagrangian<N>, const W: usize>(
        variations: &[Self],
        system: &S,
    ) -> S::In<Varied<W>> {
        Self::vary_parameters(variations, system.parameters(), system.convert())
    }

    /// The system with its steps, with parameters that vary in each direction.
    pub(super) fn steps<S: Discretized<N>, const W: usize>(variations: &[Self], system: &S) -> S::Steps<Varied<W>> {
        Self::vary_parameters(variations, system.parameters(), system.steps())
    }

    /// A system whose parameters of these names vary in each direction.
    pub(crate) fn vary_parameters<Y: Parameters<Varied<W>>, const W: usize>(
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

    /// The node with a time that varies in each direction.
    pub(super) fn in_time<const W: usize>(variations: &[Self], node: &Node<N>) -> Node<N, Varied<W>> {
        let t = Self::number(variations, node.t, |variation| variation.t);
        Node { t, ..node.map(Varied::<W>::fixed) }
    }

    /// The node with derivatives in each direction.
    pub(crate) fn node<const W: usize>(variations: &[Self], node: &Node<N>) -> Node<N, Varied<W>> {
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

/// Derivative of H at a state in each direction: `v·δp − δL` at fixed v.
pub(crate) fn changes_of_energy<S, const N: usize>(
    system: &S,
    state: &State<N>,
    directions: &[Variation<N>],
) -> Result<Vec<f64>, StepError>
where
    S: Convertible<N>,
{
    let v = state.velocity(system)?;
    let node = Node::new(*state, 0.0);
    let mut changes = Vec::with_capacity(directions.len());
    for directions in directions.chunks(TOGETHER) {
        let node = Variation::node::<TOGETHER>(directions, &node);
        let varied = Variation::vary_parameters(directions, system.parameters(), system.convert::<Varied>());
        let varied = varied.lagrangian(node.t, &node.q, &v.map(Dual::fixed));
        let of_lagrangian = varied.slope.0.into_iter();
        changes.extend(directions.iter().zip(of_lagrangian).map(|(direction, slope)| v.dot(&direction.p) - slope));
    }
    Ok(changes)
}

/// The number of independent admissible tangent vectors at a node, with fixed time and parameters.
pub(crate) fn dimension<S: Motion<N>, const N: usize>(system: &S) -> usize {
    let kept = |rows: core::ops::Range<usize>| rows.filter(|r| !system.is_dropped(*r)).count();
    if system.is_first_order() {
        // Coordinates at rest keep their momenta.
        return 2 * N - system.moving();
    }
    2 * N - kept(0..system.holonomic()) - kept(0..system.constraint_names().len())
}

/// The derivative of the velocity v of a state, whose momenta are `state.p`, along a tangent vector.
///
/// # Errors
/// [`StepError::Singular`] if the mass matrix, bordered by the constraints, is singular.
pub(super) fn velocity_along<S, const N: usize>(
    system: &S,
    state: &State<N>,
    v: &SVector<f64, N>,
    variation: &Variation<N>,
) -> Result<SVector<f64, N>, StepError>
where
    S: Convertible<N>,
{
    if const { S::Kind::COUNT > 0 } {
        return constrained::variation::velocity_along(system, state, v, variation);
    }
    let State { t, q, .. } = state;
    let along = |value: f64, slope: f64| Dual { value, slope };
    let varied = along_parameters(system, variation);
    if system.is_first_order() {
        let flow = first_order_flow(&varied, along(*t, variation.t), &q.zip_map(&variation.q, along))?;
        return Ok(flow.v.map(|entry| entry.slope));
    }
    let matrix = system.point(*t, q, v).mass;
    // L_v(t, q, v) = p
    let point = varied.point(along(*t, variation.t), &q.zip_map(&variation.q, along), &v.map(Dual::fixed));
    let of_v = linear::solve(&matrix, &(variation.p - point.momentum.map(|entry| entry.slope)));
    of_v.ok_or(singular_mass(*t))
}

/// Derivatives of a number with respect to a node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Covector<const N: usize> {
    /// Derivatives with respect to the time.
    pub t: f64,
    /// Derivatives with respect to the coordinates.
    pub q: SVector<f64, N>,
    /// Derivatives with respect to the momenta.
    pub p: SVector<f64, N>,
    /// Derivatives with respect to the energy that an energy-preserving run preserves.
    pub energy: f64,
}

impl<const N: usize> Covector<N> {
    /// The zero covector.
    #[must_use]
    pub fn zero() -> Self {
        Self { t: 0.0, q: SVector::zeros(), p: SVector::zeros(), energy: 0.0 }
    }

    /// The derivative of the number along a tangent vector.
    #[must_use]
    pub fn of(&self, variation: &Variation<N>) -> f64 {
        let of_energy = self.energy * variation.energy;
        self.q.dot(&variation.q) + self.p.dot(&variation.p) + of_energy + self.t * variation.t
    }
}

/// The mass matrix at the time t is singular.
pub(super) fn singular_mass(t: f64) -> StepError {
    StepError::Singular { t, matrix: "mass matrix" }
}

/// A system with parameters that vary in one direction.
pub(crate) fn along_parameters<S: Convertible<N>, const N: usize>(
    system: &S,
    variation: &Variation<N>,
) -> S::In<Dual<f64>> {
    let mut varied = system.convert::<Dual<f64>>();
    for (name, slope) in system.parameters().iter().zip(&variation.parameters) {
        if let Some(parameter) = varied.parameter_mut(name) {
            parameter.slope = *slope;
        }
    }
    varied
}
