//! A system whose functions of a step are calls.
//!
//! The emitted functions are inlined wherever they stand, so that the common step is one stretch of code. Rare code is given the
//! system as [`Called`]: each function is compiled for it once.

use core::ops::Deref;

/// A system; see the [module](self).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Called<S>(pub(crate) S);

impl<S> Deref for Called<S> {
    type Target = S;

    fn deref(&self) -> &S {
        &self.0
    }
}
