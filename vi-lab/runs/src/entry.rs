//! A system with a place to start from: what a list of systems is made of.
//!
//! In: the type of a system, and its start. Out: an [`Entry`], the type erased: there the compiler meets all that is generic over systems.

use crate::system::{self, StartOf, System};
use vi_core::kind::Free;
use vi_core::lagrangian::Described;
use vi_core::stepping::EnergyStepping;
use vi_erased::erasable::Runnable;

/// A system with a place to start from.
pub struct Entry {
    /// The system, with the default parameters.
    pub system: Box<dyn System>,
    /// Its description.
    pub about: &'static str,
    /// Default initial coordinates.
    pub q: Vec<f64>,
    /// Default initial velocities.
    pub v: Vec<f64>,
    /// Default step.
    pub h: f64,
}

impl Entry {
    /// A system with a place to start from: what it is, its initial coordinates and velocities, a step.
    #[must_use]
    pub fn new<S, const N: usize>(about: &'static str, q: [f64; N], v: [f64; N], h: f64) -> Self
    where
        S: EnergyStepping<N> + Runnable<N, Kind = Free> + Described + Default,
    {
        Self { system: system::by_rule::<S, N>(), about, q: q.to_vec(), v: v.to_vec(), h }
    }

    /// The same of a system without a rule, which has Gauss steps alone.
    #[must_use]
    pub fn with_gauss_only<S, const N: usize>(about: &'static str, q: [f64; N], v: [f64; N], h: f64) -> Self
    where
        S: Runnable<N, Kind = Free> + Described + Default,
    {
        Self { system: system::gauss_only::<S, N>(), about, q: q.to_vec(), v: v.to_vec(), h }
    }

    /// The same of a system with constraints.
    #[must_use]
    pub fn with_constraints<S, const N: usize>(about: &'static str, q: [f64; N], v: [f64; N], h: f64) -> Self
    where
        S: Runnable<N> + Described + Default,
    {
        Self { system: system::with_constraints::<S, N>(None), about, q: q.to_vec(), v: v.to_vec(), h }
    }

    /// The same of a system with constraints whose initial state follows from its parameters, by `start`.
    #[must_use]
    pub fn placed<S, const N: usize>(about: &'static str, start: StartOf<S, N>, h: f64) -> Self
    where
        S: Runnable<N> + Described + Default,
    {
        let (q, v) = start(&S::default());
        Self { system: system::with_constraints::<S, N>(Some(start)), about, q: q.to_vec(), v: v.to_vec(), h }
    }
}
