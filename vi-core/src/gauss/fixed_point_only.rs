//! Without the feature `alloc` there is no Newton iteration: steps that are too long for fixed-point iteration fail.

use super::linearization::LinearizationPoint;
use super::points::ErasedSystem;
use super::stages::Stages;

/// An empty buffer.
#[derive(Clone, Debug, Default)]
pub struct Buffer<const N: usize, const S: usize>(());

impl<const N: usize, const S: usize> Buffer<N, S> {
    /// None.
    #[allow(clippy::unused_self)] // as with the feature `alloc`
    pub(crate) fn newton(&mut self) -> Option<&mut Newton<N, S>> {
        None
    }
}

/// A type without values.
#[derive(Clone, Debug)]
pub enum Newton<const N: usize, const S: usize> {}

impl<const N: usize, const S: usize> Newton<N, S> {
    pub(crate) fn linearize(&mut self, _system: &ErasedSystem<'_, N>, _at: LinearizationPoint<N>) {
        match *self {}
    }

    pub(crate) fn correction(&self, _missing: &Stages<N, S>) -> Stages<N, S> {
        match *self {}
    }

    pub(crate) fn correct_positions(&self, _x: &Stages<N, S>, _y: &mut Stages<N, S>) {
        match *self {}
    }
}
