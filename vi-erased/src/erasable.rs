//! Requirements on systems and methods for type-erased runs.

use crate::simulation::ShiftedEnergy;
#[cfg(not(feature = "derivatives"))]
pub use vi_core::Method as Derived;
#[cfg(feature = "derivatives")]
pub use vi_core::derivatives::Differentiable as Derived;
use vi_core::lagrangian::Parameters;
use vi_core::method::Storable;
use vi_core::stepping::Convertible;
use vi_core::{Run, StepError};

/// A system whose runs are erased: every generated one.
pub trait Runnable<const N: usize>: Convertible<N> + Parameters + Send + Sync + 'static {}
impl<S: Convertible<N> + Parameters + Send + Sync + 'static, const N: usize> Runnable<N> for S {}

/// A method whose runs are erased: what its rows and its evaluations are.
pub trait Erasable<S: Runnable<N>, const N: usize>: Derived<S, N, Memory: Storable> + 'static {
    /// Evaluations of the equations in a step with these iterations.
    fn evaluations(&self, iterations: u32) -> u64;

    /// Time and H at which H is most accurate.
    ///
    /// # Errors
    /// The momenta have no velocity.
    fn sampled_energy(run: &Run<Self, S, N>) -> Result<(f64, f64), StepError> {
        Ok((run.t(), run.energy()?))
    }

    /// The conserved quantity of steps with a shift.
    fn shifted_energy(_run: &Run<Self, S, N>) -> Option<ShiftedEnergy> {
        None
    }
}
