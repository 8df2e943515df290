//! Vectors of numbers with rigorous rounding-error bounds.

use crate::real::Running;
use crate::vector::worse;
use alloc::vec::Vec;
use nalgebra::SVector;

/// A number with a bound that holds for all operands within their errors.
pub(super) type Bounded = Running<true>;

impl Bounded {
    /// This bound with a value that the same formula gave elsewhere.
    pub(super) fn of(self, value: f64) -> Self {
        Self { value, ..self }
    }
}

/// An exact vector.
pub(super) fn exact<const N: usize>(vector: &SVector<f64, N>) -> SVector<Bounded, N> {
    vector.map(Bounded::exact)
}

/// These bounds with a vector that the same formula gave elsewhere.
pub(super) fn vector_of<const N: usize>(value: &SVector<f64, N>, again: &SVector<Bounded, N>) -> SVector<Bounded, N> {
    again.zip_map(value, Bounded::of)
}

/// Up to this number of unknowns running error analysis bounds the errors of an elimination.
const FEW: usize = 24;
/// Roundings of the largest entry of a solution, for each unknown.
const STABLE: f64 = 8.0;

/// The solution of linear equations, with error bounds for their residual. `again` has the bounds of the elimination.
///
/// Bounds by running error analysis double with each unknown. The residual of many unknowns has the size of that of an
/// exact solution whose entries have a few roundings of the largest one for each unknown (Higham, section 9.3).
#[allow(clippy::cast_precision_loss, reason = "a few hundred unknowns")]
pub(super) fn solution(value: &[f64], again: &[Bounded], unknowns: usize) -> Vec<Bounded> {
    let largest = value.iter().fold(0.0, |largest, entry| worse(largest, entry.abs()));
    let stable = if unknowns <= FEW { f64::INFINITY } else { STABLE * unknowns as f64 * f64::EPSILON * largest };
    let entries = value.iter().zip(again);
    entries.map(|(value, again)| Bounded { value: *value, error: again.error.min(stable) }).collect()
}

/// A vector after one rounding per entry, or two.
pub(super) fn once<const N: usize>(vector: &SVector<f64, N>) -> SVector<Bounded, N> {
    vector.map(Bounded::nearest)
}
