//! Variations of one step, for each integrator; those of a Gauss step stand with its stages (`gauss/variation.rs`).
//!
//! In: an integrator after a step, the node at which the step began, variations of that node. Out: those of the node reached. The unknowns of the step are at
//! hand, so each direction costs one evaluation of the equations in dual numbers and one solution of the linearized ones.

use super::variation::Variation;
use crate::composition::Composition;
use crate::energy_preserving::{EnergyPreserving, Fallback};
use crate::error::StepError;
use crate::fixed_step::FixedStep;
use crate::integrator::Integrator;
use crate::linear;
use crate::node::Node;
use crate::real::{Dual, Real};
use crate::stepping::{Convertible, EnergyStepping, ExtendedSystem, FixedStepping};
use nalgebra::SVector;

/// An integrator whose steps have derivatives.
pub trait Differentiable<const N: usize>: Integrator<N, System: Convertible<N>> {
    /// Whether the energy that the run keeps is a variable beside coordinates and momenta.
    const KEEPS_ENERGY: bool = false;

    /// Turns variations of the node `before`, at which the last step began, into those of the node that it reached.
    ///
    /// The step is the one that [`Integrator::step`] took last.
    ///
    /// # Errors
    /// [`StepError::Singular`] where the equations of the step do not determine how its solution varies.
    fn vary(&self, before: &Node<N>, variations: &mut [Variation<N>]) -> Result<(), StepError>;
}

/// The derivative of the equations of a step cannot be inverted.
fn singular(t: f64) -> StepError {
    StepError::Singular { t, matrix: "derivative of the equations of a step" }
}

/// The node after the momentum step `(v, h)` of a system, in dual numbers whose values solve it: one Newton step, by the derivative of the same system
/// in the numbers T, gives v its slope.
fn momentum_step<T, P, S, const N: usize>(
    plain: &P,
    system: &S,
    mut node: Node<N, Dual<T>>,
    h: T,
    v: &SVector<T, N>,
) -> Result<Node<N, Dual<T>>, StepError>
where
    T: Real,
    P: FixedStepping<N, T>,
    S: FixedStepping<N, Dual<T>>,
{
    let jacobian = plain.momentum_equation(&node.map(|number| number.value), h, v).jacobian;
    let h = Dual::fixed(h);
    let residual = system.momentum_residual(&node, h, &v.map(Dual::fixed)).residual;
    let change =
        linear::solve(&jacobian, &residual.map(|entry| entry.slope)).ok_or_else(|| singular(node.t.to_f64()))?;
    let v = v.zip_map(&change, |value, change| Dual { value, slope: -change });
    let increment = system.momentum_residual(&node, h, &v).increment;
    node.advance(h, &v, &increment);
    Ok(node)
}

impl<S, const N: usize> Differentiable<N> for FixedStep<S, N>
where
    S: FixedStepping<N> + Convertible<N>,
{
    fn vary(&self, before: &Node<N>, variations: &mut [Variation<N>]) -> Result<(), StepError> {
        for variation in variations {
            let system = variation.system(self.system());
            let node = momentum_step(self.system(), &system, variation.node(before), self.h(), &self.v())?;
            variation.take(&node);
        }
        Ok(())
    }
}

impl<S, const N: usize> FixedStep<S, N>
where
    S: FixedStepping<N> + Convertible<N>,
{
    /// Second derivatives of the last step, which began at the node `before`: how the variation `one` of the node that it reached changes along
    /// `other`; coordinates, then momenta. The variations are those of `before`, and straight: they do not vary themselves.
    ///
    /// # Errors
    /// As [`Differentiable::vary`].
    pub fn second_variation(
        &self,
        before: &Node<N>,
        one: &Variation<N>,
        other: &Variation<N>,
    ) -> Result<(SVector<f64, N>, SVector<f64, N>), StepError> {
        let mut system = self.system().convert::<Dual<Dual<f64>>>();
        for (index, name) in S::PARAMETERS.iter().enumerate() {
            if let Some(parameter) = crate::lagrangian::Parameters::parameter_mut(&mut system, name) {
                parameter.slope.value = one.parameters.get(index).copied().unwrap_or(0.0);
                parameter.value.slope = other.parameters.get(index).copied().unwrap_or(0.0);
            }
        }
        let inner = other.node(before);
        let node = nested(&one.node(before), &inner);
        // The velocity as the other direction varies it; the dual numbers of the first differentiate its equation once more.
        let plain = other.system(self.system());
        let equation = plain.momentum_equation(&inner, Dual::fixed(self.h()), &self.v().map(Dual::fixed));
        let change = linear::solve(&equation.jacobian, &equation.residual).ok_or_else(|| singular(before.t))?;
        let v = self.v().zip_map(&change, |value, change| Dual { value, slope: -change.slope });
        let node = momentum_step(&plain, &system, node, Dual::fixed(self.h()), &v)?;
        let q = SVector::from_fn(|k, _| node.q[k].slope.slope + node.q_low[k].slope.slope);
        let p = SVector::from_fn(|k, _| node.p[k].slope.slope + node.p_low[k].slope.slope);
        Ok((q, p))
    }
}

/// A node that varies in two directions.
fn nested<const N: usize>(one: &Node<N, Dual<f64>>, other: &Node<N, Dual<f64>>) -> Node<N, Dual<Dual<f64>>> {
    let both = |one: Dual<f64>, other: Dual<f64>| Dual { value: other, slope: Dual::fixed(one.slope) };
    Node {
        t: both(one.t, other.t),
        t_low: both(one.t_low, other.t_low),
        q: one.q.zip_map(&other.q, both),
        q_low: one.q_low.zip_map(&other.q_low, both),
        p: one.p.zip_map(&other.p, both),
        p_low: one.p_low.zip_map(&other.p_low, both),
        energy: both(one.energy, other.energy),
        energy_low: both(one.energy_low, other.energy_low),
    }
}

impl<S, const N: usize> Differentiable<N> for Composition<S, N>
where
    S: FixedStepping<N> + Convertible<N>,
{
    fn vary(&self, before: &Node<N>, variations: &mut [Variation<N>]) -> Result<(), StepError> {
        for variation in variations {
            let system = variation.system(self.system());
            let mut node = variation.node(before);
            for (weight, v) in self.scheme().weights.iter().zip(self.velocities()) {
                node = momentum_step(self.system(), &system, node, weight * self.h(), &v)?;
            }
            variation.take(&node);
        }
        Ok(())
    }
}

impl<S, const N: usize> Differentiable<N> for EnergyPreserving<S, N>
where
    S: EnergyStepping<N> + Convertible<N>,
    S::In<Dual<f64>>: EnergyStepping<N, Dual<f64>>,
{
    const KEEPS_ENERGY: bool = true;

    /// The energy that the run keeps is a variable of its own, beside q and p, and the length of the step varies. With
    /// [`Fallback::FixedSteps`] the run may leap from one energy to another: it has no derivative, and this is [`StepError::InvalidInput`].
    fn vary(&self, before: &Node<N>, variations: &mut [Variation<N>]) -> Result<(), StepError> {
        if self.fallback() != Fallback::Stop {
            let (input, allowed) = ("the fallback of a run that is differentiated", "`Fallback::Stop`");
            return Err(StepError::InvalidInput { input, allowed, value: 1.0 });
        }
        let h = self.h();
        let v = self.v();
        let ExtendedSystem { momentum, residual_dh, energy_dv, energy_dh, .. } =
            self.system().extended_system(before, h, &v);
        let along_h = linear::solve(&momentum.jacobian, &residual_dh).ok_or_else(|| singular(before.t))?;
        let schur = energy_dh - energy_dv.dot(&along_h);
        for variation in variations {
            let system = variation.system(self.system());
            let mut node = variation.node(before);
            let dual = system.extended_system(&node, Dual::fixed(h), &v.map(Dual::fixed));
            let residual = dual.momentum.residual.map(|entry| entry.slope);
            let still = linear::solve(&momentum.jacobian, &residual).ok_or_else(|| singular(before.t))?;
            let change_of_h = (energy_dv.dot(&still) - dual.energy_residual.slope / h) / schur;
            if !change_of_h.is_finite() {
                return Err(singular(before.t));
            }
            let change_of_v = -still - along_h * change_of_h;
            let h = Dual { value: h, slope: change_of_h };
            let v = v.zip_map(&change_of_v, |value, slope| Dual { value, slope });
            let increment = system.extended_residual(&node, h, &v).increment;
            node.advance(h, &v, &increment.momentum);
            node.add_energy(increment.energy);
            variation.take(&node);
        }
        Ok(())
    }
}
