//! Fixed steps of order 2S: Galerkin variational integrators at the S Gauss points.
//!
//! Without constraints a step is Gauss collocation ([`free`]). With constraints the velocities are at the Gauss points too,
//! and the multipliers at the S + 1 Lobatto nodes of the step ([`bound`]). The kind of the system selects the solver:
//! that of free systems iterates the stages in vector registers, that of bound ones solves a bordered system.
//!
//! Both are variational integrators of the discrete Lagrangian `L_d = h Σ b_i L_i`: symplectic without force and
//! time-symmetric. S = 1 is the midpoint rule (Hairer, Lubich, Wanner, *Geometric Numerical Integration*, II.1.3 and
//! VI.6.2).

#[cfg(feature = "alloc")]
pub mod bound;
pub mod free;

use super::{Change, Facts, Method, Problem, Status, Storable};
#[cfg(feature = "alloc")]
use crate::derivatives::{Covector, Variation};
use crate::error::StepError;
use crate::gauss::stages::Stages;
use crate::kind::Kind;
use crate::motion::Motion;
use crate::node::Node;
use crate::state::State;
use crate::stepping::Convertible;
#[cfg(feature = "alloc")]
pub use bound::BoundGauss;
pub use free::FreeGauss;
#[cfg(feature = "alloc")]
use nalgebra::DMatrix;

/// Fixed steps of order 2 STAGES, with 1 to 16 stages: `Gauss::<8>`. See the [module](self).
///
/// With constraints, dense output is a cubic: between nodes it leaves the constraints by O(h⁴).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Gauss<const STAGES: usize>;

/// A solver of Gauss steps.
pub trait StageSolver<S, const N: usize, const STAGES: usize>: Method<S, N, Memory: Storable> + Default {
    /// The solver of steps whose errors may be as large as a tolerance, relative to their motion; zero for steps whose
    /// stages are solved to rounding.
    #[doc(hidden)]
    #[must_use]
    fn within(_tolerance: f64) -> Self {
        Self::default()
    }

    /// The memory for a step of another length from the node, with a guess from the polynomials of the last step.
    ///
    /// # Errors
    /// The reason why no step can start there.
    #[doc(hidden)]
    fn resized(system: &S, memory: &Self::Memory, node: &Node<N>, h: f64) -> Result<Self::Memory, StepError>;

    /// The memory for the last step again, from its start with another length.
    ///
    /// # Errors
    /// The reason why no step can start there.
    #[doc(hidden)]
    fn again(system: &S, memory: &Self::Memory, node: &Node<N>, h: f64) -> Result<Self::Memory, StepError>;

    /// The next step; `None` if Newton's iteration or a proof that it continues short steps would take long.
    ///
    /// # Errors
    /// As [`Method::solve`].
    #[doc(hidden)]
    fn quickly(
        &self,
        at: Problem<'_, S, Self::Prepared, N>,
        memory: &Self::Memory,
        cache: &mut Self::Cache,
    ) -> Result<Option<Self::Step>, StepError> {
        self.solve(at, memory, cache).map(Some)
    }

    /// The next step, from the stages of one of nearly its length, which continues short ones.
    ///
    /// # Errors
    /// As [`Method::solve`].
    #[doc(hidden)]
    fn solve_near(
        &self,
        at: Problem<'_, S, Self::Prepared, N>,
        memory: &Self::Memory,
        cache: &mut Self::Cache,
    ) -> Result<Self::Step, StepError> {
        self.solve(at, memory, cache)
    }

    /// The velocities at the stages of the last step.
    #[doc(hidden)]
    fn velocities(system: &S, memory: &Self::Memory) -> Stages<N, STAGES>;

    /// Maps tangent vectors at `before`, the start of the step that led to the node, to those at its end.
    ///
    /// # Errors
    /// As [`Run::vary`](crate::Run::vary).
    #[cfg(feature = "alloc")]
    #[doc(hidden)]
    fn vary(
        system: &S,
        run: (&Node<N>, &Self::Memory),
        before: &Node<N>,
        variations: &mut [Variation<N>],
    ) -> Result<(), StepError>;

    /// [`Run::curvature`](crate::Run::curvature) along directions, with weights of the end.
    ///
    /// # Errors
    /// As [`Run::curvature`](crate::Run::curvature).
    #[cfg(feature = "alloc")]
    #[doc(hidden)]
    fn curvature(
        _system: &S,
        _run: (&Node<N>, &Self::Memory),
        _before: &Node<N>,
        _of: (&[Variation<N>], &Covector<N>),
    ) -> Result<Option<DMatrix<f64>>, StepError> {
        Ok(None)
    }
}

/// The solver of the kind of a system.
pub(crate) type Solver<S, const N: usize, const STAGES: usize> = <<S as Motion<N>>::Kind as Kind>::Stages<S, N, STAGES>;

/// The solver of the kind of a system, as a value.
#[inline(always)]
pub(crate) fn solver<S: Convertible<N>, const N: usize, const STAGES: usize>() -> Solver<S, N, STAGES> {
    Solver::<S, N, STAGES>::default()
}

impl<S, const N: usize, const STAGES: usize> Method<S, N> for Gauss<STAGES>
where
    S: Convertible<N>,
{
    type Prepared = <Solver<S, N, STAGES> as Method<S, N>>::Prepared;
    type Memory = <Solver<S, N, STAGES> as Method<S, N>>::Memory;
    type Cache = <Solver<S, N, STAGES> as Method<S, N>>::Cache;
    type Step = <Solver<S, N, STAGES> as Method<S, N>>::Step;
    type Left = <Solver<S, N, STAGES> as Method<S, N>>::Left;
    type DenseOutput = <Solver<S, N, STAGES> as Method<S, N>>::DenseOutput;

    fn facts(&self) -> Facts {
        Method::<S, N>::facts(&solver::<S, N, STAGES>())
    }

    fn prepare(&self, system: &S, h: f64) -> Self::Prepared {
        solver::<S, N, STAGES>().prepare(system, h)
    }

    fn begin(&self, system: &S, node: &mut Node<N>, h: f64) -> Result<Self::Memory, StepError> {
        solver::<S, N, STAGES>().begin(system, node, h)
    }

    #[inline(always)]
    fn attempt(
        &self,
        at: Problem<'_, S, Self::Prepared, N>,
        memory: &Self::Memory,
        cache: &mut Self::Cache,
    ) -> Result<Self::Step, Self::Left> {
        solver::<S, N, STAGES>().attempt(at, memory, cache)
    }

    #[inline(always)]
    fn advance(
        &self,
        system: &S,
        prepared: &Self::Prepared,
        h: f64,
        run: (&mut Node<N>, &mut Self::Memory),
        cache: &mut Self::Cache,
    ) -> Result<(), Self::Left> {
        solver::<S, N, STAGES>().advance(system, prepared, h, run, cache)
    }

    fn recover(
        &self,
        at: Problem<'_, S, Self::Prepared, N>,
        memory: &Self::Memory,
        cache: &mut Self::Cache,
        left: Self::Left,
    ) -> Result<Self::Step, StepError> {
        solver::<S, N, STAGES>().recover(at, memory, cache, left)
    }

    #[inline(always)]
    fn take(
        &self,
        system: &S,
        h: f64,
        run: (&mut Node<N>, &mut Self::Memory),
        cache: &mut Self::Cache,
        step: Self::Step,
    ) {
        Method::<S, N>::take(&solver::<S, N, STAGES>(), system, h, run, cache, step);
    }

    fn restarted(
        &self,
        system: &S,
        change: &Change<'_, S, N>,
        node: &mut Node<N>,
        h: f64,
        memory: &Self::Memory,
    ) -> Result<Self::Memory, StepError> {
        solver::<S, N, STAGES>().restarted(system, change, node, h, memory)
    }

    fn dense_output(
        &self,
        system: &S,
        before: &State<N>,
        node: &Node<N>,
        h: f64,
        memory: &Self::Memory,
    ) -> Result<Self::DenseOutput, StepError> {
        solver::<S, N, STAGES>().dense_output(system, before, node, h, memory)
    }

    fn status(&self, h: f64, memory: &Self::Memory) -> Status {
        Method::<S, N>::status(&solver::<S, N, STAGES>(), h, memory)
    }

    fn discrete_energy(&self, system: &S, node: &Node<N>, h: f64, memory: &Self::Memory) -> Option<f64> {
        solver::<S, N, STAGES>().discrete_energy(system, node, h, memory)
    }

    fn check(&self, system: &S, at: (&Node<N>, &Self::Memory), h: f64) -> Result<(), StepError> {
        solver::<S, N, STAGES>().check(system, at, h)
    }
}
