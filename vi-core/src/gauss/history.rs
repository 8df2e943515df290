//! Memory of energy-preserving Gauss steps beside their stages: lengths, energies, step densities, and the options of
//! the run.

use super::density::power;
use crate::error::StepError;
use crate::method::bounds::{Control, check_forward};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

/// Memory of a run beside its node and its stages.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct StepHistory {
    /// Length of the last step.
    h: f64,
    /// `(H − E) √(h₋ h₊)` at the last nodes between two steps, the newest first, and their count.
    products: [f64; 3],
    known: usize,
    /// Slope of `ln (H − E0)` over ln h.
    pub(crate) slope: f64,
    /// `H − E'` at the node.
    pub(crate) excess: f64,
    /// The size of the terms of H at the node.
    pub(crate) size: f64,
    /// The largest size so far.
    pub(crate) largest_size: f64,
    /// `D_s + D_*` of the last two steps, the newest first; `None` before the first step.
    pub(crate) densities: Option<[f64; 2]>,
    /// The largest `|D_s|` so far.
    pub(crate) largest: f64,
    /// D_*.
    pub(crate) shift: f64,
    /// Energy residual of the last step, over its rounding-error bound.
    pub(crate) residual: f64,
    /// Fixed-point iterations of the last step, over all trial lengths.
    pub(crate) iterations: u32,
    pub(crate) control: Control,
}

impl StepHistory {
    /// The memory before the first step, which has about the length h.
    pub(crate) fn new(h: f64, slope: f64) -> Self {
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
            iterations: 0,
            control: Control::new(),
        }
    }

    /// Whether the run has taken no step.
    pub(crate) fn is_first(&self) -> bool {
        self.densities.is_none()
    }

    /// Length of the last step.
    pub(crate) fn h(&self) -> f64 {
        self.h
    }

    /// The predicted length of the next step. By the step law `(H − E) √(h₋ h₊)` is nearly constant from node to node,
    /// so that it can be extrapolated. Falls back to the last length if the extrapolation is too far from it.
    pub(crate) fn predicted_length(&self) -> f64 {
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
    pub(crate) fn push(&mut self, h: f64, density: f64) {
        // The initial length is not a step.
        if self.densities.is_some() {
            let [a, b, _] = self.products;
            self.products = [self.excess * (self.h * h).sqrt(), a, b];
            self.known = 3.min(self.known + 1);
        }
        self.h = h;
        self.densities = Some([density, self.density().unwrap_or(density)]);
        self.largest = self.largest.max((density - self.shift).abs());
    }

    /// Sets the measurements at a node: `H − E'` and the size of the terms of H.
    pub(crate) fn set_excess(&mut self, [excess, size]: [f64; 2]) {
        self.excess = excess;
        self.size = size;
        self.largest_size = self.largest_size.max(size);
    }

    /// `D_s + D_*` of the last step.
    pub(crate) fn density(&self) -> Option<f64> {
        self.densities.map(|[density, _]| density)
    }

    /// `D_s + D_*` at the start, before the first step, from the energy of S stages.
    pub(crate) fn initial_density<const S: usize>(&self) -> f64 {
        self.density().unwrap_or(self.excess / power::<S>(self.h))
    }

    /// Restarts the extrapolation of lengths from the last one.
    pub(crate) fn forget_lengths(&mut self) {
        self.known = 0;
    }

    /// Checks stored data. A file may contain any numbers.
    pub(crate) fn check(&self, t: f64) -> Result<(), StepError> {
        let Self { slope, excess, size, largest_size, densities, largest, shift, residual, .. } = *self;
        let [last, before] = densities.unwrap_or_default();
        let numbers = [slope, excess, size, largest_size, last, before, largest, shift, residual];
        let products = self.products;
        if !numbers.iter().chain(&products).all(|number| number.is_finite()) {
            return Err(StepError::NonFinite { t, quantity: "last interval", expression: None });
        }
        check_forward("the last step h", self.h)?;
        check_forward("the slope of the energy over the length", slope)?;
        self.control.check(t)
    }
}
