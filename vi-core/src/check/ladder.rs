//! Slopes over a ladder of steps.
//!
//! In: points (h, error), h halved from one to the next. Out: the slope of log(error) over log(h), by least squares, of the
//! points that stand above rounding; less than three of them prove nothing.

use super::comparison::Comparison;
use super::report::CheckFailure;

/// Halvings of the step: the ladder.
pub(super) const HALVINGS: core::ops::Range<u32> = 0..5;
/// Points that a slope needs.
const FEWEST: usize = 3;

/// A slope and the points that it was fitted through.
pub(super) struct Slope {
    pub(super) slope: f64,
    pub(super) points: Vec<(f64, f64)>,
}

impl Slope {
    /// The slope through the points above the plateau of rounding.
    ///
    /// # Errors
    /// [`CheckFailure::Vacuous`] for less than three points; a point that is no number.
    pub(super) fn fit(points: &[(f64, f64)], plateau: f64, check: &Comparison) -> Result<Self, CheckFailure> {
        if let Some((h, error)) = points.iter().find(|(_, error)| !error.is_finite()) {
            return Err(check.differs(format!("error at h = {h:.1e}"), *error, 0.0, f64::NAN, plateau));
        }
        let points: Vec<(f64, f64)> = points.iter().copied().filter(|(_, error)| *error > plateau).collect();
        if points.len() < FEWEST {
            let why = format!(
                "only {} of the errors stand above rounding, {plateau:.1e}; choose a larger h, or a place where the steps are not exact",
                points.len()
            );
            return Err(check.vacuous(why));
        }
        let logarithms = || points.iter().map(|(h, error)| (h.ln(), error.ln()));
        let count = logarithms().fold(0.0, |count, _| count + 1.0);
        let (x, y) = logarithms().fold((0.0, 0.0), |(x, y), point| (x + point.0 / count, y + point.1 / count));
        let (products, squares) = logarithms()
            .map(|(a, b)| (a - x, b - y))
            .fold((0.0, 0.0), |(products, squares), (a, b)| (products + a * b, squares + a * a));
        Ok(Self { slope: products / squares, points })
    }

    /// The points, as a message shows them.
    pub(super) fn describe(&self, of: &str) -> String {
        let each: Vec<String> = self.points.iter().map(|(h, error)| format!("{error:.1e} at h = {h:.1e}")).collect();
        format!("slope of {of} ({})", each.join(", "))
    }
}
