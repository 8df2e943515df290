//! A system whose functions of a step are calls.
//!
//! In: a system. Out: the same system, the same formulas. The emitted functions are inlined wherever they stand, so that the common step is
//! one stretch of code. For [`Called`] each function is compiled once, and integrators of it are smaller: the rare code of every integrator
//! takes the system in this way, and whoever needs an integrator now and then can, to build it several times faster and step several
//! times slower.

use core::ops::{Deref, DerefMut};

/// A system whose functions are calls: `Called(system).at(t, q, v).integrate(Gauss::<3>, h)` is built sooner, and steps in plain numbers, not in
/// vector instructions. Its states are those of the system but for rounding.
///
/// It stands for a system whose time scale is not known when a generic function is compiled, too: `in_transformed_time` asks
/// [`Collocation::SCALES_TIME`](crate::collocation::Collocation::SCALES_TIME) instead.
#[derive(Clone, Copy, Debug)]
pub struct Called<S>(pub S);

impl<S> Deref for Called<S> {
    type Target = S;

    fn deref(&self) -> &S {
        &self.0
    }
}

impl<S> DerefMut for Called<S> {
    fn deref_mut(&mut self) -> &mut S {
        &mut self.0
    }
}
