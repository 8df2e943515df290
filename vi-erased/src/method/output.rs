//! Dense output behind a pointer.

use vi_core::run::DenseOutput;
use vi_core::{SVector, State};

/// Dense output of such a method.
pub struct AnyOutput<const N: usize>(Box<dyn ErasedOutput<N>>);

impl<const N: usize> AnyOutput<N> {
    /// Dense output of this type.
    pub(super) fn of(output: impl DenseOutput<N> + Send + Sync + 'static) -> Self {
        Self(Box::new(output))
    }
}

/// The functions of dense output.
trait ErasedOutput<const N: usize>: Send + Sync {
    fn state(&self, t: f64) -> State<N>;
    fn velocity(&self, t: f64) -> SVector<f64, N>;
    fn since_start(self: Box<Self>) -> AnyOutput<N>;
    fn moved(self: Box<Self>, by: &SVector<f64, N>) -> AnyOutput<N>;
}

impl<D: DenseOutput<N> + Send + Sync + 'static, const N: usize> ErasedOutput<N> for D {
    fn state(&self, t: f64) -> State<N> {
        self.state(t)
    }

    fn velocity(&self, t: f64) -> SVector<f64, N> {
        self.velocity(t)
    }

    fn since_start(self: Box<Self>) -> AnyOutput<N> {
        AnyOutput::of(DenseOutput::since_start(*self))
    }

    fn moved(self: Box<Self>, by: &SVector<f64, N>) -> AnyOutput<N> {
        AnyOutput::of(DenseOutput::moved(*self, by))
    }
}

impl<const N: usize> DenseOutput<N> for AnyOutput<N> {
    fn state(&self, t: f64) -> State<N> {
        self.0.state(t)
    }

    fn velocity(&self, t: f64) -> SVector<f64, N> {
        self.0.velocity(t)
    }

    fn since_start(self) -> Self {
        self.0.since_start()
    }

    fn moved(self, by: &SVector<f64, N>) -> Self {
        self.0.moved(by)
    }
}
