//! Wrappers of a system: one that compiles its functions once, and one for generic code.
//!
//! The emitted functions are inlined at every call site, so that the hot path is one piece of code. [`Called`] compiles
//! each function once, which makes integrators smaller. Cold paths of every integrator use it. It is also for programs
//! whose build time matters more than speed: it builds several times faster and steps several times slower.

use crate::lagrangian::Parameters;
use crate::real::Real;
use core::ops::{Deref, DerefMut};

/// A system whose functions are not inlined: `Called(system).at(t, q, v).integrate(Gauss::<3>, h)` builds faster, and
/// steps in plain numbers instead of SIMD vectors. Its states agree with those of the system to rounding.
///
/// Generic code also uses it for a system whose time scale is unknown at compile time: `in_transformed_time` then
/// checks [`Motion::SCALES_TIME`](crate::motion::Motion::SCALES_TIME) at run time.
#[derive(Clone, Copy, Debug)]
pub struct Called<S>(pub S);

/// A system of generic code, presumed [`Separable`](crate::motion::Separable):
/// `Presumed(system).at(t, q, v).integrate(Splitting::BLANES_MOAN_6, h)` checks
/// [`Motion::SPLITS`](crate::motion::Motion::SPLITS) when a run begins. Its functions are inlined.
#[derive(Clone, Copy, Debug)]
pub struct Presumed<S>(pub S);

/// Gives access to the system inside, and to its parameters.
macro_rules! transparent {
    ($wrapper:ident) => {
        impl<S> Deref for $wrapper<S> {
            type Target = S;

            fn deref(&self) -> &S {
                &self.0
            }
        }

        impl<S> DerefMut for $wrapper<S> {
            fn deref_mut(&mut self) -> &mut S {
                &mut self.0
            }
        }

        impl<T: Real, S: Parameters<T>> Parameters<T> for $wrapper<S> {
            fn parameter_mut(&mut self, name: &str) -> Option<&mut T> {
                self.0.parameter_mut(name)
            }
        }
    };
}

transparent!(Called);
transparent!(Presumed);
