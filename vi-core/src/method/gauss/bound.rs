//! Gauss steps of systems with constraints.
//!
//! Velocities are at the S Gauss points, multipliers Λ at the S + 1 Lobatto nodes of a step. S = 1 is the midpoint rule
//! with an impulse λ at the start and an impulse μ at the end:
//!
//! ```text
//! L_v = p0 + (h/2)(L_q + f) + A(t0, q0)ᵀ λ    at (t0 + h/2, q0 + (h/2) v, v)
//! g(t1, q1) = 0,   q1 = q0 + h v              nonholonomic: A v + a = 0 at the midpoint
//! p1 = p0 + h (L_q + f) + A(t0, q0)ᵀ λ + A(t1, q1)ᵀ μ
//! ```
//!
//! μ is the impulse with which the velocity of p1 satisfies `A v1 + a = 0`. So g and A v + a vanish at every node to
//! rounding, in a run of any length. The step is time-symmetric. With holonomic constraints and without force it is
//! symplectic, and preserves the momenta of symmetries of L and g.
//!
//! Source: L. O. Jay, Symplectic partitioned Runge–Kutta methods for constrained Hamiltonian systems, 1996; Marsden and
//! West, Discrete mechanics and variational integrators, 2001, section 3.5. `constrained::solve` solves the equations.
//!
//! L is evaluated at points with g = O(h²), off the constraint, and has to be smooth there. A step does not exist if
//! the gradient of a constraint turns by about a radian in it: [`StepError::NotConverged`]. A step that does not
//! continue short ones is [`StepError::TooLong`].

use super::{Gauss, StageSolver};
use crate::constrained::connected::{self, velocities};
use crate::constrained::guess::{Extrapolation, from_node};
use crate::constrained::solve::Workspace;
use crate::constrained::solved::Solved;
use crate::constrained::variation::vary;
use crate::constrained::{bordered, discrete_energy, impulses, start, unknowns};
use crate::derivatives::{Variation, not_last};
use crate::error::StepError;
use crate::gauss::stages::{Stages, at, stage};
use crate::kind::{Bound, Form, Multipliers};
use crate::linear::Bordered;
use crate::method::{Change, Facts, Memory, Method, Problem, Status};
use crate::motion::Motion;
use crate::node::Node;
use crate::run::{Hermite, Run};
use crate::state::State;
use crate::stepping::Convertible;
use alloc::boxed::Box;
use alloc::vec::Vec;
use nalgebra::SVector;

/// The solver of [`Gauss`] steps with constraints.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BoundGauss<const STAGES: usize>;

/// Memory of steps with constraints: the velocities and impulses of the last steps.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ConstrainedSteps<const N: usize> {
    pub(crate) unknowns: Extrapolation,
    /// The impulse of the last projection.
    pub(crate) mu: Vec<f64>,
    /// The start node of the last step; the current node before the first step.
    pub(crate) before: Node<N>,
    pub(crate) h: f64,
    /// Sign of the determinant of the bordered mass matrix.
    pub(crate) sign: i8,
    pub(crate) residual: f64,
    iterations: u32,
}

impl<const N: usize> Memory for ConstrainedSteps<N> {}

/// A solved step.
#[derive(Clone, Debug)]
pub struct ConstrainedStep<const N: usize, M> {
    pub(crate) end: Node<N>,
    unknowns: Vec<f64>,
    mu: M,
    residual: f64,
    iterations: u32,
}

/// The impulses of a step: its constraints add `Σ_j A_jᵀ λ_j + A_Sᵀ μ` to the momenta, with A_j at the Lobatto nodes j.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impulses<M, const STAGES: usize> {
    /// λ at the Lobatto nodes 0 … S − 1, `h b̃_j` times the multipliers; one impulse for each constraint.
    pub lambda: [M; STAGES],
    /// μ at the end of the step.
    pub mu: M,
}

impl<const N: usize> ConstrainedSteps<N> {
    /// Before the first step of the length h from a node with the velocity v.
    ///
    /// # Errors
    /// [`StepError::Singular`] and [`StepError::NonFinite`].
    fn from_node<S: Motion<N>, const STAGES: usize>(
        system: &S,
        (node, h, v): (&Node<N>, f64, &SVector<f64, N>),
        bordered: &mut Bordered,
    ) -> Result<Self, StepError> {
        let guess = from_node::<S, N, STAGES>(system, (node, h, v), bordered)?;
        Ok(Self::new(system, (node, h), &guess, bordered.determinant_sign()))
    }

    /// Before the first step of the length h from a node, with a guess of its unknowns and the sign of the determinant
    /// of the bordered mass matrix.
    pub(crate) fn new<S: Motion<N>>(system: &S, (node, h): (&Node<N>, f64), guess: &[f64], sign: i8) -> Self {
        let mu = vec![0.0; system.constraint_names().len()];
        Self { unknowns: Extrapolation::new(guess), mu, before: *node, h, sign, residual: 0.0, iterations: 0 }
    }

    /// Adds a step of the length h from `before`.
    pub(crate) fn take(&mut self, (before, h): (&Node<N>, f64), unknowns: &[f64], mu: &[f64], residual: f64) {
        (self.before, self.h, self.residual) = (*before, h, residual);
        self.unknowns.push(unknowns);
        self.mu.copy_from_slice(mu);
    }

    /// The impulses of the step that led to the node.
    pub(crate) fn impulses<S: Motion<N>, const STAGES: usize>(
        &self,
        system: &S,
        node: &Node<N>,
    ) -> Option<Impulses<Multipliers<S, N>, STAGES>> {
        let constraints = system.constraint_names().len();
        let of = |slice: &[f64]| {
            let mut multipliers = system.constraints(node.t, &node.q);
            multipliers.as_mut().copy_from_slice(slice);
            multipliers
        };
        let newest = self.unknowns.newest();
        self.has_step(node).then(|| Impulses {
            lambda: core::array::from_fn(|j| of(impulses::<N, STAGES, f64>(newest, constraints, j))),
            mu: of(&self.mu),
        })
    }

    /// Checks stored data of steps with these numbers of unknowns and constraints. A file may contain any numbers.
    ///
    /// # Errors
    /// [`StepError::NonFinite`].
    pub(crate) fn check(&self, [unknowns, constraints]: [usize; 2], t: f64) -> Result<(), StepError> {
        self.before.check_finite(t)?;
        let count = self.unknowns.count();
        if count != unknowns || self.mu.len() != constraints {
            let (input, allowed) = ("the number of unknowns of a checkpoint", "that of its method and its system");
            #[allow(clippy::cast_precision_loss)] // a few thousand
            return Err(StepError::InvalidInput { input, allowed, value: count as f64 });
        }
        let are_valid = self.unknowns.is_valid(unknowns)
            && self.mu.iter().chain(&[self.h, self.residual]).all(|entry| entry.is_finite())
            && self.sign.abs() == 1;
        if are_valid { Ok(()) } else { Err(StepError::NonFinite { t, quantity: "last stages", expression: None }) }
    }

    /// Whether the unknowns belong to the step that led to the node. After a change of parameters they do not.
    fn has_step(&self, node: &Node<N>) -> bool {
        // A shift changes the energy of the node alone.
        !self.before.is_at(node)
    }

    /// The start node of the last step; the current node before the first step.
    pub(crate) fn start(&self) -> &Node<N> {
        &self.before
    }

    /// The step that led to the node: its start, length, unknowns and the impulse of its projection.
    pub(crate) fn last(&self, node: &Node<N>) -> Option<(&Node<N>, f64, &[f64], &[f64])> {
        let Self { unknowns, mu, before, h, .. } = self;
        self.has_step(node).then(|| (before, *h, unknowns.newest(), mu.as_slice()))
    }
}

impl<S, const N: usize, const STAGES: usize> Method<S, N> for BoundGauss<STAGES>
where
    S: Convertible<N>,
{
    type Prepared = ();
    type Memory = ConstrainedSteps<N>;
    type Cache = Option<Box<Workspace>>;
    type Step = ConstrainedStep<N, Multipliers<S, N>>;
    type Left = StepError;
    type DenseOutput = Hermite<N>;

    fn facts(&self) -> Facts {
        Facts { has_reactions: true, ..Facts::of_order(2 * STAGES) }
    }

    fn prepare(&self, _system: &S, _h: f64) {}

    fn begin(&self, system: &S, node: &mut Node<N>, h: f64) -> Result<Self::Memory, StepError> {
        let bordered = &mut bordered(system);
        let v = start::checked(system, node, bordered)?;
        ConstrainedSteps::from_node::<S, STAGES>(system, (node, h, &v), bordered)
    }

    fn attempt(
        &self,
        at: Problem<'_, S, (), N>,
        memory: &Self::Memory,
        cache: &mut Self::Cache,
    ) -> Result<Self::Step, StepError> {
        let Problem { system, node, h, .. } = at;
        let constraints = system.constraint_names().len();
        let count = unknowns::<N, STAGES>(constraints);
        let workspace = cache.get_or_insert_with(|| Box::new(Workspace::of_steps::<S, N, STAGES>(system, node)));
        let mut unknowns = core::mem::take(&mut workspace.unknowns);
        unknowns.resize(count, 0.0);
        let is_next = memory.has_step(node);
        let of = (node, h, memory.sign, is_next);
        let solved = connected::step::<S, N, STAGES>(system, of, &memory.unknowns, &mut unknowns, workspace)?;
        let Solved { end, mu, residual, iterations, .. } = solved;
        Ok(ConstrainedStep { end, unknowns, mu, residual, iterations })
    }

    fn recover(
        &self,
        at: Problem<'_, S, (), N>,
        _memory: &Self::Memory,
        cache: &mut Self::Cache,
        left: StepError,
    ) -> Result<Self::Step, StepError> {
        // The last unknowns may not extrapolate: a step from the node alone.
        let Problem { system, node, h, .. } = at;
        let flow = node.state().raw_flow(system).map_err(|_| left)?;
        let bordered = &mut bordered(system);
        let memory =
            ConstrainedSteps::from_node::<S, STAGES>(system, (node, h, &flow.v), bordered).map_err(|_| left)?;
        self.attempt(at, &memory, cache)
    }

    fn take(
        &self,
        _system: &S,
        h: f64,
        (node, memory): (&mut Node<N>, &mut Self::Memory),
        cache: &mut Self::Cache,
        step: Self::Step,
    ) {
        let ConstrainedStep { end, unknowns, mu, residual, iterations } = step;
        memory.take((node, h), &unknowns, mu.as_ref(), residual);
        memory.iterations = iterations;
        *node = end;
        // The buffer serves the next step.
        if let Some(workspace) = cache {
            workspace.unknowns = unknowns;
        }
    }

    fn restarted(
        &self,
        system: &S,
        change: &Change<'_, S, N>,
        node: &mut Node<N>,
        h: f64,
        _memory: &Self::Memory,
    ) -> Result<Self::Memory, StepError> {
        match change {
            Change::NewLength => fresh::<S, N, STAGES>(system, node, h),
            _ => change.begun(self, system, node, h),
        }
    }

    fn dense_output(
        &self,
        system: &S,
        before: &State<N>,
        node: &Node<N>,
        h: f64,
        _memory: &Self::Memory,
    ) -> Result<Hermite<N>, StepError> {
        Hermite::between(system, before, &node.state(), h)
    }

    fn status(&self, h: f64, memory: &Self::Memory) -> Status {
        Status { residual: memory.residual, iterations: memory.iterations, ..Status::of_length(h) }
    }

    fn discrete_energy(&self, system: &S, node: &Node<N>, _h: f64, memory: &Self::Memory) -> Option<f64> {
        let ConstrainedSteps { unknowns, mu, before, h, .. } = memory;
        let energy = discrete_energy::<S, N, STAGES>(system, (before, *h), unknowns.newest(), mu);
        (memory.has_step(node) && energy.is_finite()).then_some(energy)
    }

    fn check(&self, system: &S, (node, memory): (&Node<N>, &Self::Memory), h: f64) -> Result<(), StepError> {
        if memory.h.to_bits() != h.to_bits() {
            let (input, allowed) = ("the step of a checkpoint", "that of its run");
            return Err(StepError::InvalidInput { input, allowed, value: memory.h });
        }
        let constraints = system.constraint_names().len();
        memory.check([unknowns::<N, STAGES>(constraints), constraints], node.t)?;
        start::check_stored(system, node)
    }
}

/// The memory for a step of the length h from a node.
fn fresh<S: Convertible<N>, const N: usize, const STAGES: usize>(
    system: &S,
    node: &Node<N>,
    h: f64,
) -> Result<ConstrainedSteps<N>, StepError> {
    let v = node.state().velocity(system)?;
    ConstrainedSteps::from_node::<S, STAGES>(system, (node, h, &v), &mut bordered(system))
}

/// The memory for a step of the length h, with the velocities of the polynomials of the last step. The step begins at the
/// part `since` of the last one. The impulses are those of the node.
fn continued<S: Convertible<N>, const N: usize, const STAGES: usize>(
    system: &S,
    memory: &ConstrainedSteps<N>,
    node: &Node<N>,
    (h, since): (f64, f64),
) -> Result<ConstrainedSteps<N>, StepError> {
    let anew = fresh::<S, N, STAGES>(system, node, h)?;
    let ratio = h / memory.h;
    let stages = at(&velocities::<N, STAGES>(memory.unknowns.newest()), |c| since + ratio * c);
    let mut guess = anew.unknowns.newest().to_vec();
    for (i, velocity) in guess.chunks_exact_mut(N).take(STAGES).enumerate() {
        velocity.copy_from_slice(stage(&stages, i).as_slice());
    }
    Ok(ConstrainedSteps { unknowns: Extrapolation::new(&guess), ..anew })
}

impl<S, const N: usize, const STAGES: usize> StageSolver<S, N, STAGES> for BoundGauss<STAGES>
where
    S: Convertible<N>,
{
    fn resized(
        system: &S,
        memory: &ConstrainedSteps<N>,
        node: &Node<N>,
        h: f64,
    ) -> Result<ConstrainedSteps<N>, StepError> {
        if !(memory.has_step(node) && h / memory.h > 0.0) {
            return fresh::<S, N, STAGES>(system, node, h);
        }
        continued::<S, N, STAGES>(system, memory, node, (h, 1.0))
    }

    fn again(
        system: &S,
        memory: &ConstrainedSteps<N>,
        node: &Node<N>,
        h: f64,
    ) -> Result<ConstrainedSteps<N>, StepError> {
        continued::<S, N, STAGES>(system, memory, node, (h, 0.0))
    }

    fn velocities(_system: &S, memory: &ConstrainedSteps<N>) -> Stages<N, STAGES> {
        velocities(memory.unknowns.newest())
    }

    /// Allocates the matrix of the step.
    fn vary(
        system: &S,
        (node, memory): (&Node<N>, &ConstrainedSteps<N>),
        before: &Node<N>,
        variations: &mut [Variation<N>],
    ) -> Result<(), StepError> {
        let (start, h, u, mu) = memory.last(node).ok_or_else(|| not_last(before.t))?;
        if start != before {
            return Err(not_last(before.t));
        }
        vary::<S, N, STAGES>(system, (before, h), (u, mu), variations, None)
    }
}

impl<S, const N: usize, const K: usize, F: Form, const STAGES: usize> Run<Gauss<STAGES>, S, N>
where
    S: Convertible<N, Kind = Bound<K, F>>,
{
    /// The impulses λ and μ of the constraints in the last step, which balance the momenta: `p1 − p0 = h Σ b_i (L_q +
    /// f)_i + Σ A_jᵀ λ_j + A_Sᵀ μ`. `None` before the first step, and after [`Run::set_parameters`], [`Run::set_state`]
    /// or [`Run::step_of`].
    ///
    /// An impulse alone is not a mean of the multipliers: for S = 1, `2λ/h` differs from Λ by O(h). The impulses on both
    /// sides of a node are: `(μ_k + λ_{k+1})/h = Λ(t_k) + O(h²)`. [`State::reaction`] returns Λ itself.
    pub fn impulses(&self) -> Option<Impulses<Multipliers<S, N>, STAGES>> {
        self.memory.impulses(&self.system, &self.node)
    }
}
