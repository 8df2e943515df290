//! A step of some length.
//!
//! In: the node, a length h, and a guess of the stages. Out: the step of that length, its stages solved to rounding, and by how much its
//! energy differs from the one to preserve. Stages are guessed by the polynomial through those of a step before, wherever its
//! nodes are.

use super::density::power;
use super::stepper::Stepper;
use crate::error::StepError;
use crate::gauss::stages::Stages;
use crate::gauss::tableau::Tableau;
use crate::gauss::{self, sweep::Convergence};
use crate::newton::FLOOR;
use nalgebra::SMatrix;

/// A step of some length, solved.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trial<const N: usize, const S: usize> {
    /// The run after it.
    pub(super) after: gauss::Run<N, S>,
    /// `E0(h) − C_s h^2s D_* − E'`.
    pub(super) residual: f64,
    /// `E1 − E0`.
    pub(super) work: f64,
    /// The size of the terms of E0.
    pub(super) size: f64,
}

impl<const N: usize, const S: usize> Trial<N, S> {
    pub(super) fn h(&self) -> f64 {
        self.after.h
    }

    /// The residual in roundings of the terms of E0.
    pub(super) fn roundings(&self) -> f64 {
        self.residual.abs() / (f64::EPSILON * self.size + f64::MIN_POSITIVE)
    }

    /// The stages of the step of length h from the same node, so far as this one tells.
    pub(super) fn stages_for(&self, h: f64) -> Stages<N, S> {
        let ratio = h / self.h();
        at(&self.after.stages.data.0, |c| ratio * c)
    }
}

/// What the polynomials through the stages of a step are elsewhere: at `place(c_i)` in units of its length.
#[inline(always)]
pub(super) fn at<const N: usize, const S: usize>(stages: &Stages<N, S>, place: impl Fn(f64) -> f64) -> Stages<N, S> {
    let c = const { &Tableau::<S>::VALUES.c };
    let scales = const { &scales::<S>() };
    let mut values = [[0.0; S]; N];
    for i in 0..S {
        for j in 0..S {
            let mut basis = scales[j];
            for k in 0..S {
                if k != j {
                    basis *= place(c[i]) - c[k];
                }
            }
            for k in 0..N {
                values[k][i] += basis * stages[k][j];
            }
        }
    }
    values
}

/// `Π_{k ≠ j} 1/(c_j − c_k)`.
const fn scales<const S: usize>() -> [f64; S] {
    let c = &Tableau::<S>::VALUES.c;
    let mut scales = [1.0; S];
    let mut j = 0;
    while j < S {
        let mut k = 0;
        while k < S {
            if k != j {
                scales[j] /= c[j] - c[k];
            }
            k += 1;
        }
        j += 1;
    }
    scales
}

impl<const N: usize, const S: usize> Stepper<'_, N, S> {
    /// The stages of the next step of length h, by those of the last one.
    fn stages_for(&self, h: f64) -> Stages<N, S> {
        let run = self.gauss.run();
        let stages = &run.stages.data.0;
        if run.convergence.has_begun() { at(stages, |c| 1.0 + c * (h / run.h)) } else { *stages }
    }

    /// The step of length h from the node, by the stages of the last one.
    ///
    /// # Errors
    /// As [`Stepper::trial`].
    pub(super) fn trial_of(&mut self, h: f64) -> Result<Trial<N, S>, StepError> {
        self.trial(h, self.stages_for(h))
    }

    /// The step of length h from the node, by a guess of its stages.
    ///
    /// # Errors
    /// Those of [`Gauss::step`](crate::Gauss::step).
    pub(super) fn trial(&mut self, h: f64, stages: Stages<N, S>) -> Result<Trial<N, S>, StepError> {
        let run = self.gauss.run_mut();
        let kept = (run.h, run.stages, run.convergence);
        run.h = h;
        run.stages = SMatrix::from_array_storage(nalgebra::ArrayStorage(stages));
        // Where no sweep was before, stages are taken as they are, not carried further.
        run.convergence = Convergence { sweeps: 0, ..run.convergence };
        let solved = self.gauss.solved();
        let run = self.gauss.run_mut();
        (run.h, run.stages, run.convergence) = kept;
        let after = solved?;
        let node = &self.gauss.run().node;
        let energies = self.gauss.energies(h, after.stages.data.0, node.energy);
        let residual = energies.start - node.energy_low - power::<S>(h) * self.course.shift;
        if !residual.is_finite() {
            return Err(StepError::NonFinite { t: node.t, quantity: "energy", expression: None });
        }
        Ok(Trial { after, residual, work: energies.work, size: energies.size })
    }

    /// Whether the energy of a trial is the one to preserve as far as its arithmetic can tell, and tells the length.
    #[cold]
    pub(super) fn is_preserved(&self, trial: &Trial<N, S>) -> bool {
        let base = self.gauss.run().node.energy;
        let energies = self.gauss.bounded_energies(trial.h(), trial.after.stages.data.0, base);
        let rounding = f64::EPSILON * energies.start.ulps();
        trial.residual.abs() <= FLOOR * rounding && self.course.excess.abs() >= Self::least_excess(rounding)
    }

    /// The least `|H − E|` that tells a length, where energies are rounded by so much.
    pub(super) fn least_excess(rounding: f64) -> f64 {
        // The length is known to this part of itself, so that the numbers of its step are.
        const PARTS: f64 = 1000.0;
        PARTS * rounding / Self::SLOPE
    }
}
