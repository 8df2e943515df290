//! Steps of any length with constraints, among which an energy-preserving method finds its own.
//!
//! The factors of the first length serve the others from the same node: they differ by the error of its prediction.

use super::energies::{energies, power_of};
use super::equations::{Rows, impulses, stage_velocity, unknowns};
use super::guess::{Extrapolation, from_node};
use super::solve::{Solution, Workspace, projected};
use super::solved::Solved;
use super::{bordered, connected, density};
use crate::dense_output::Hermite;
use crate::error::StepError;
use crate::gauss::density::power;
use crate::kind::Multipliers;
use crate::method::length::Trial;
use crate::method::preserving::{Ended, NodeEnergy, StepsOfAnyLength, excess_of, measured};
use crate::node::Node;
use crate::real::Rounded;
use crate::state::State;
use crate::stepping::Convertible;
use alloc::vec::Vec;
use core::cell::RefCell;
use nalgebra::SVector;

/// Largest relative difference of two lengths whose steps share the factors of their Jacobian.
const NEAR: f64 = 0.05;

/// Steps of any length from a node.
pub(crate) struct ConstrainedLengths<'a, S, const N: usize> {
    pub(crate) system: &'a S,
    /// The unknowns of the last steps, each followed by its length.
    pub(crate) last: &'a Extrapolation,
    /// Sign of the determinant of the bordered mass matrix.
    pub(crate) sign: i8,
    pub(crate) workspace: RefCell<&'a mut Workspace>,
}

/// A solved step of some length, without its projection.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TriedLength<const N: usize, const STAGES: usize, M> {
    pub(crate) h: f64,
    v: [SVector<f64, N>; STAGES],
    lambda: [M; STAGES],
    /// Largest residual of the step equations, over its rounding-error bound.
    of_rows: f64,
    iterations: u32,
    /// `E0(h) − C_s h^2s D_*` less the energy of the node.
    residual: f64,
    /// `E1 − E0` without the projection.
    pub(crate) work: f64,
    /// Sum of the absolute terms of E0.
    size: f64,
}

impl<const N: usize, const STAGES: usize, M: Copy> Trial for TriedLength<N, STAGES, M> {
    fn h(&self) -> f64 {
        self.h
    }

    fn residual(&self) -> f64 {
        self.residual
    }

    fn size(&self) -> f64 {
        self.size
    }
}

impl<const N: usize, const STAGES: usize, M: AsRef<[f64]>> TriedLength<N, STAGES, M> {
    /// Replaces the contents of a list by the unknowns.
    pub(crate) fn write(&self, u: &mut Vec<f64>) {
        u.clear();
        u.extend(self.v.iter().flat_map(|v| v.iter()));
        u.extend(self.lambda.iter().flat_map(AsRef::as_ref));
    }
}

/// The end of a step and its unknowns.
#[derive(Clone, Copy, Debug)]
pub struct TakenLength<const N: usize, const STAGES: usize, M> {
    pub(crate) end: Node<N>,
    pub(crate) tried: TriedLength<N, STAGES, M>,
    /// The impulse of the projection.
    pub(crate) mu: M,
    pub(crate) residual: f64,
}

impl<S, const N: usize> ConstrainedLengths<'_, S, N>
where
    S: Convertible<N>,
{
    /// Writes the guess of the step of length h to `u`.
    fn guess<const STAGES: usize>(
        &self,
        h: f64,
        near: Option<&TriedLength<N, STAGES, Multipliers<S, N>>>,
        u: &mut Vec<f64>,
    ) {
        let count = unknowns::<N, STAGES>(self.system.constraint_names().len());
        let of = if let Some(other) = near {
            other.write(u);
            other.h
        } else {
            u.resize(count + 1, 0.0);
            self.last.guess(0, u);
            let of = u[count];
            u.truncate(count);
            // Lengths that change fast do not extrapolate.
            if of > 0.5 * h && of < 2.0 * h { of } else { self.last.newest()[count] }
        };
        // Impulses are multipliers times the length.
        u[STAGES * N..].iter_mut().for_each(|impulse| *impulse *= h / of);
    }

    /// Solves the step of length h with the guess in `u`, or with that of the node alone.
    ///
    /// # Errors
    /// The errors of the first guess.
    fn solved<const STAGES: usize>(
        &self,
        (node, h): (&Node<N>, f64),
        u: &mut Vec<f64>,
        is_factored: bool,
    ) -> Result<Solution<Rows<S, N, STAGES>>, StepError> {
        let Self { system, sign, workspace, .. } = self;
        let (workspace, of) = (&mut **workspace.borrow_mut(), (node, h, *sign));
        connected::unprojected::<S, N, STAGES>(system, of, u, workspace, is_factored).or_else(|left| {
            let flow = node.state().raw_flow(*system).map_err(|_| left)?;
            let bordered = &mut bordered(system);
            *u = from_node::<S, N, STAGES>(system, (node, h, &flow.v), bordered).map_err(|_| left)?;
            connected::unprojected::<S, N, STAGES>(system, of, u, workspace, false).map_err(|_| left)
        })
    }

    /// The equations of a step with these unknowns and its energies.
    fn measure<const STAGES: usize>(
        &self,
        (node, h, shift): (&Node<N>, f64, f64),
        u: &[f64],
        solution: &Solution<Rows<S, N, STAGES>>,
    ) -> Result<TriedLength<N, STAGES, Multipliers<S, N>>, StepError> {
        let energies = energies::<S, N, STAGES, f64>(self.system, (node, h), u, node.energy);
        let residual = energies.start - node.energy_low - power::<STAGES>(h) * shift;
        if !residual.is_finite() {
            return Err(StepError::NonFinite { t: node.t, quantity: "energy", expression: None });
        }
        let (_, any) = self.system.constraint_gradients(node.t, &node.q);
        Ok(TriedLength {
            h,
            v: core::array::from_fn(|i| stage_velocity(u, i)),
            lambda: core::array::from_fn(|j| {
                let mut lambda = any;
                lambda.as_mut().copy_from_slice(impulses::<N, STAGES, f64>(u, self.system.constraint_names().len(), j));
                lambda
            }),
            of_rows: solution.residual,
            iterations: solution.iterations,
            residual,
            work: energies.work,
            size: energies.size,
        })
    }
}

impl<S, const N: usize, const STAGES: usize> StepsOfAnyLength<N, STAGES> for ConstrainedLengths<'_, S, N>
where
    S: Convertible<N>,
{
    type Trial = TriedLength<N, STAGES, Multipliers<S, N>>;
    type Taken = TakenLength<N, STAGES, Multipliers<S, N>>;

    fn tried(&self, node: &Node<N>, h: f64, shift: f64, near: Option<&Self::Trial>) -> Result<Self::Trial, StepError> {
        let mut u = core::mem::take(&mut self.workspace.borrow_mut().unknowns);
        self.guess(h, near, &mut u);
        let is_near = near.is_some_and(|other| (h / other.h - 1.0).abs() < NEAR);
        let solution = self.solved::<STAGES>((node, h), &mut u, is_near);
        let tried = solution.and_then(|solution| self.measure((node, h, shift), &u, &solution));
        self.workspace.borrow_mut().unknowns = u;
        tried
    }

    #[cold]
    fn rounding_of(&self, node: &Node<N>, trial: &Self::Trial) -> f64 {
        let mut u = Vec::new();
        trial.write(&mut u);
        let u: Vec<Rounded> = u.iter().map(|entry| Rounded::nearest(*entry)).collect();
        let (node, h) = (node.map(Rounded::exact), Rounded::exact(trial.h));
        let system = self.system.convert::<Rounded>();
        energies::<_, N, STAGES, Rounded>(&system, (&node, h), &u, node.energy).start.ulps()
    }

    fn iterations(trial: &Self::Trial) -> u32 {
        trial.iterations
    }

    fn density(&self, state: &State<N>) -> Result<f64, StepError> {
        density::step_density::<S, N, STAGES>(self.system, state)
    }

    fn measured(&self, node: &Node<N>) -> Result<[f64; 2], StepError> {
        measured(self.system, node)
    }

    fn ended(&self, node: &Node<N>, trial: &Self::Trial) -> Result<Ended<Self::Taken, N>, StepError> {
        let Self { system, sign, workspace, .. } = self;
        let workspace = &mut **workspace.borrow_mut();
        let mut u = core::mem::take(&mut workspace.unknowns);
        trial.write(&mut u);
        let TriedLength { h, of_rows: residual, iterations, .. } = *trial;
        let rows = Rows::<S, N, STAGES>::at(system, node, h, &u);
        let solved = projected(*system, (node, h, *sign), (&Solution { rows, residual, iterations }, &u), workspace);
        workspace.unknowns = u;
        let (Solved { mut end, mu, residual, .. }, v) = solved?;
        let gain = trial.work - power_of::<S, N, f64>(system, (end.t, &end.q), mu.as_ref());
        end.add_energy(gain);
        end.check_finite(node.t)?;
        let total = system.energy(end.t, &end.q, &v);
        let measured = excess_of(NodeEnergy { total, size: v.dot(&end.p).abs() + total.abs() }, &end)?;
        let state = end.state();
        Ok(Ended { taken: TakenLength { end, tried: *trial, mu, residual }, state, gain, measured })
    }

    fn between(&self, before: &State<N>, after: &State<N>, h: f64) -> Result<Hermite<N>, StepError> {
        Hermite::between(self.system, before, after, h)
    }
}
