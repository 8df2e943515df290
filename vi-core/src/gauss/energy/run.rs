//! What a run carries from step to step.
//!
//! In: a run, between two steps. Out: a [`Checkpoint`], and the run again (see [`crate::checkpoint`]).

use super::EnergyPreservingGauss;
use super::density::power;
use crate::checkpoint;
use crate::collocation::Collocation;
use crate::energy_preserving::fallback::{Fallback, Phase, StepBounds, Switches, check_step};
use crate::error::StepError;
use crate::gauss::{self, Gauss, Stored};
use crate::state::Method;
use crate::stepping::Convertible;

/// Everything that a run of [`EnergyPreservingGauss`] carries, to be stored and resumed bit for bit.
pub type Checkpoint<const N: usize, const STAGES: usize> = checkpoint::Checkpoint<Run<N, STAGES>>;

/// A run between two steps.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Run<const N: usize, const S: usize> {
    gauss: gauss::Run<N, S>,
    course: Course,
}

/// What a run carries beside its node and its stages.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct Course {
    /// Length of the last step.
    h: f64,
    /// `(H − E) √(h₋ h₊)` at the last nodes between two steps, the newest first; how many there are.
    products: [f64; 3],
    known: usize,
    /// Change of `ln (H − E0)` by that of ln h.
    pub(super) slope: f64,
    /// `H − E'` at the node.
    pub(super) excess: f64,
    /// The size of the terms of H there.
    pub(super) size: f64,
    /// The largest size met.
    pub(super) largest_size: f64,
    /// `D_s + D_*` of the last two steps, the newest first; none before the first step.
    pub(super) densities: Option<[f64; 2]>,
    /// The largest `|D_s|` met.
    pub(super) largest: f64,
    /// D_*.
    pub(super) shift: f64,
    /// What the last step leaves of its energy, in roundings.
    pub(super) residual: f64,
    pub(super) method: Method,
    pub(super) bounds: Option<StepBounds<f64>>,
    pub(super) fallback: Fallback,
    /// The fixed steps under way.
    pub(super) phase: Option<Phase<f64>>,
    pub(super) switches: Switches,
}

impl Course {
    /// Before the first step, which has about the length h.
    pub(super) fn new(h: f64, slope: f64) -> Self {
        Self {
            h,
            products: [0.0; 3],
            known: 0,
            slope,
            excess: 0.0,
            size: 0.0,
            largest_size: 0.0,
            densities: None,
            largest: 0.0,
            shift: 0.0,
            residual: 0.0,
            method: Method::EnergyPreserving,
            bounds: None,
            fallback: Fallback::Stop,
            phase: None,
            switches: Switches::default(),
        }
    }

    /// Length of the last step.
    pub(super) fn h(&self) -> f64 {
        self.h
    }

    /// The length of the next step. By the step law `(H − E) √(h₋ h₊)` is nearly constant from node to node, and is extrapolated. The length of the
    /// last one where this leads too far.
    pub(super) fn predicted_length(&self) -> f64 {
        let [a, b, c] = self.products;
        let product = match self.known {
            0 => return self.h,
            1 => a,
            2 => a + (a - b),
            _ => a + (2.0 * (a - b) - (b - c)),
        };
        let mean = product / self.excess;
        let h = mean * mean / self.h;
        if h > 0.75 * self.h && h < 1.5 * self.h { h } else { self.h }
    }

    /// Adds the length of a step from the node, and its density.
    pub(super) fn push(&mut self, h: f64, density: f64) {
        // The length with which a run starts is no step.
        if self.densities.is_some() {
            let [a, b, _] = self.products;
            self.products = [self.excess * (self.h * h).sqrt(), a, b];
            self.known = 3.min(self.known + 1);
        }
        self.h = h;
        self.densities = Some([density, self.density().unwrap_or(density)]);
        self.largest = self.largest.max((density - self.shift).abs());
    }

    /// Sets what was measured at a node: `H − E'` and the size of the terms of H.
    pub(super) fn set_excess(&mut self, [excess, size]: [f64; 2]) {
        self.excess = excess;
        self.size = size;
        self.largest_size = self.largest_size.max(size);
    }

    /// `D_s + D_*` of the last step.
    pub(super) fn density(&self) -> Option<f64> {
        self.densities.map(|[density, _]| density)
    }

    /// The same, before the first step of its start, as the energy of S stages tells it.
    pub(super) fn told_density<const S: usize>(&self) -> f64 {
        self.density().unwrap_or(self.excess / power::<S>(self.h))
    }

    /// Starts the extrapolation of lengths anew, from the last one.
    pub(super) fn forget_lengths(&mut self) {
        self.known = 0;
    }

    /// Whether a step can follow: what a file says may be anything.
    fn check(&self, t: f64) -> Result<(), StepError> {
        let Self { slope, excess, size, largest_size, densities, largest, shift, residual, switches, .. } = *self;
        let [last, before] = densities.unwrap_or_default();
        let numbers = [slope, excess, size, largest_size, last, before, largest, shift, residual];
        let products = self.products;
        let costs = [switches.energy_change, switches.energy_cost];
        if !numbers.iter().chain(&products).chain(&costs).all(|number| number.is_finite()) {
            return Err(StepError::NonFinite { t, quantity: "last interval", expression: None });
        }
        check_step("the last step h", self.h)?;
        check_step("the slope of the energy over the length", slope)?;
        if let Some(bounds) = &self.bounds {
            bounds.check()?;
        }
        self.phase.as_ref().map_or(Ok(()), Phase::check)
    }
}

impl<S, const N: usize, const STAGES: usize> EnergyPreservingGauss<S, N, STAGES>
where
    S: Collocation<N> + Convertible<N>,
{
    /// Everything that the run carries, and of which system with which parameters. Allocates.
    pub fn checkpoint(&self) -> Checkpoint<N, STAGES> {
        checkpoint::Checkpoint::of(&self.gauss.system, None, Run { gauss: self.gauss.run, course: self.course })
    }

    /// The run that was at `checkpoint`, bit for bit, on a processor with the same instructions.
    ///
    /// # Errors
    /// [`StepError::OtherSystem`] for a checkpoint of another system or of other parameters; [`StepError::NonFinite`] and
    /// [`StepError::InvalidInput`] for one that no run can have left.
    pub fn restart(system: S, checkpoint: Checkpoint<N, STAGES>) -> Result<Self, StepError> {
        let (checkpoint, course) = checkpoint.split(|Run { gauss: run, course }| {
            // Lengths differ from step to step, and each has its own linearization.
            (Stored { run, linearization: None }, course)
        });
        let gauss = Gauss::restart(system, checkpoint)?;
        course.check(gauss.run.node.t)?;
        Ok(Self { gauss, course, failure: None })
    }
}
