//! A system whose functions of a step are calls.
//!
//! The emitted functions are inlined wherever they stand, so that the common step is one stretch of code. Rare code is given the
//! system as [`Called`]: each function is compiled for it once.

use crate::lagrangian::lagrangian_of_target;
use crate::{
    ExtendedResidual, ExtendedSystem, Lagrangian, MomentumEquation, MomentumResidual, Node, Real, Rounding, StepError,
    Stepping,
};
use core::ops::Deref;
use nalgebra::SVector;

/// A system; see the [module](self).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Called<S>(pub(crate) S);

impl<S> Deref for Called<S> {
    type Target = S;

    fn deref(&self) -> &S {
        &self.0
    }
}

lagrangian_of_target!(Called<S>);

impl<const N: usize, T: Real, S: Stepping<N, T>> Stepping<N, T> for Called<S> {
    type Jacobian = S::Jacobian;
    const CONSTANT_JACOBIAN: bool = S::CONSTANT_JACOBIAN;
    const CLOSED_FORM: bool = S::CLOSED_FORM;
    const INLINED: bool = S::INLINED;

    #[inline(never)]
    fn momentum_equation(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> MomentumEquation<N, T, S::Jacobian> {
        S::momentum_equation(self, node, h, v)
    }

    #[inline(never)]
    fn momentum_residual(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> MomentumResidual<N, T> {
        S::momentum_residual(self, node, h, v)
    }

    #[inline(never)]
    fn extended_system(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> ExtendedSystem<N, T, S::Jacobian> {
        S::extended_system(self, node, h, v)
    }

    #[inline(never)]
    fn extended_residual(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> ExtendedResidual<N, T> {
        S::extended_residual(self, node, h, v)
    }

    fn rounding(&self, node: &Node<N, T>, h: T, v: &SVector<T, N>) -> Rounding<N, T> {
        S::rounding(self, node, h, v)
    }
}
