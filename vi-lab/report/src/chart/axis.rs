//! Axes: a range around the data, ticks at round numbers, labels.
//!
//! In: the values of all series. Out: a [`Ruler`] with the coordinate of the figure: the value, or its log10.

use crate::numbers::{extremes, superscript};

/// An axis.
#[derive(Clone, Debug)]
pub struct Axis {
    /// Text beside the axis with the unit or the scale.
    pub label: String,
    /// Linear or logarithmic.
    pub scale: Scale,
    /// The range, if it does not follow from the data.
    pub range: Option<(f64, f64)>,
}

/// The map from values to lengths.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Linear.
    Linear,
    /// By log10; omits values that are not positive.
    Log10,
}

/// An axis with its range.
#[derive(Clone, Debug)]
pub(super) struct Ruler {
    /// Range in the coordinate drawn.
    pub(super) range: (f64, f64),
    /// Distance of the ticks.
    pub(super) step: f64,
    scale: Scale,
}

impl Axis {
    /// A linear axis.
    pub fn linear(label: impl Into<String>) -> Self {
        Self { label: label.into(), scale: Scale::Linear, range: None }
    }

    /// A logarithmic axis.
    pub fn log10(label: impl Into<String>) -> Self {
        Self { label: label.into(), scale: Scale::Log10, range: None }
    }

    /// The same axis with a given range of values.
    #[must_use]
    pub fn over(self, low: f64, high: f64) -> Self {
        Self { range: Some((low, high)), ..self }
    }

    /// The value at a fraction of the given range; of 0 to 1 without a range.
    #[must_use]
    pub fn at(&self, part: f64) -> f64 {
        let (low, high) = self.range.unwrap_or((0.0, 1.0));
        match self.scale {
            Scale::Linear => low + part * (high - low),
            Scale::Log10 => low * (high / low).powf(part),
        }
    }

    /// The coordinate of `value`; `None` if it has none.
    pub(super) fn coordinate(&self, value: f64) -> Option<f64> {
        let coordinate = match self.scale {
            Scale::Linear => value,
            Scale::Log10 if value > 0.0 => value.log10(),
            Scale::Log10 => return None,
        };
        coordinate.is_finite().then_some(coordinate)
    }

    /// The ruler for these coordinates, with a margin around data but not around a given range.
    pub(super) fn ruler(&self, coordinates: impl Iterator<Item = f64>) -> Ruler {
        let given = self.range.and_then(|(low, high)| Some((self.coordinate(low)?, self.coordinate(high)?)));
        Ruler::over(given.unwrap_or_else(|| widen(extremes(coordinates), self.scale)), self.scale)
    }
}

impl Ruler {
    /// The ruler over a range of coordinates.
    fn over(range: (f64, f64), scale: Scale) -> Self {
        let step = match scale {
            Scale::Linear => round_step((range.1 - range.0) / 6.0),
            Scale::Log10 => round_step((range.1 - range.0) / 8.0).ceil(),
        };
        Self { range, step, scale }
    }

    /// The unit of the coordinates passed to the library, which draws only ranges between 2e-16 and 1e18.
    pub(super) fn unit(&self) -> f64 {
        let length = self.length();
        if (1e-9..1e9).contains(&length) { 1.0 } else { 2_f64.powi(whole(length.log2())) }
    }

    /// Length of the range.
    pub(super) fn length(&self) -> f64 {
        self.range.1 - self.range.0
    }

    /// The ruler with this length around the same middle.
    pub(super) fn widened_to(&self, length: f64) -> Self {
        let more = (length - self.length()) / 2.0;
        Self::over((self.range.0 - more, self.range.1 + more), self.scale)
    }

    /// Label of the tick at `coordinate`.
    pub(super) fn tick_label(&self, coordinate: f64) -> String {
        match self.scale {
            // Ticks of a logarithmic axis are at whole exponents.
            Scale::Log10 => format!("10{}", superscript(whole(coordinate))),
            Scale::Linear => self.linear_label(coordinate),
        }
    }

    fn linear_label(&self, value: f64) -> String {
        let largest = self.range.0.abs().max(self.range.1.abs());
        let exponent = whole(largest.log10().floor());
        if value.abs() < self.step * 1e-6 {
            "0".to_owned()
        } else if (-3..5).contains(&exponent) {
            format!("{value:.*}", decimals(self.step))
        } else {
            let unit = 10_f64.powi(exponent);
            format!("{:.*}·10{}", decimals(self.step / unit), value / unit, superscript(exponent))
        }
    }
}

/// The range `[low, high]` with a margin of 4 %; a single value, or none, gets a range around it.
fn widen((low, high): (f64, f64), scale: Scale) -> (f64, f64) {
    if low > high {
        return (0.0, 1.0);
    }
    let (smallest, around) = match scale {
        Scale::Linear => {
            let smallest = low.abs().max(high.abs()) * 1e-12 + f64::MIN_POSITIVE;
            (smallest, if high == 0.0 { 1.0 } else { high.abs() * 0.05 })
        }
        Scale::Log10 => (1.0, 1.0),
    };
    let margin = if high - low < smallest { around } else { 0.04 * (high - low) };
    (low - margin, high + margin)
}

/// The smallest of 1, 2, 5 times a power of ten that is not below `step`.
fn round_step(step: f64) -> f64 {
    let unit = 10_f64.powf(step.log10().floor());
    let candidates = [1.0, 2.0, 5.0, 10.0];
    unit * candidates.into_iter().find(|&candidate| candidate * unit >= step * (1.0 - 1e-9)).unwrap_or(10.0)
}

/// Number of decimals that distinguishes adjacent ticks.
fn decimals(step: f64) -> usize {
    usize::try_from(-whole((step * (1.0 + 1e-9)).log10().floor())).unwrap_or(0)
}

/// The integer of a coordinate that is whole up to rounding; exponents of floating-point numbers always fit.
#[allow(clippy::cast_possible_truncation)]
fn whole(value: f64) -> i32 {
    value.round() as i32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn steps_are_round() {
        for (step, expected) in [(0.11, 0.2), (0.2, 0.2), (3.0, 5.0), (7.0, 10.0), (1.3e-9, 2e-9)] {
            let found = round_step(step);
            // Measured: at most one rounding of the power of ten, 2e-16.
            assert!((found / expected - 1.0).abs() < 4e-16, "{step}: {found} instead of {expected}");
        }
    }

    #[test]
    fn labels_tell_ticks_apart() {
        let ruler = Axis::linear("x").over(0.0, 7.0e-9).ruler(core::iter::empty());
        assert_eq!(ruler.tick_label(0.0), "0");
        assert_eq!(ruler.tick_label(2.0e-9), "2·10⁻⁹");
        let ruler = Axis::linear("x").over(0.9, 1.05).ruler(core::iter::empty());
        assert_eq!(ruler.tick_label(0.95), "0.95");
        let ruler = Axis::log10("x").over(1e-16, 1.0).ruler(core::iter::empty());
        assert_eq!((ruler.range, ruler.step), ((-16.0, 0.0), 2.0));
        assert_eq!(ruler.tick_label(-14.0), "10⁻¹⁴");
    }

    #[test]
    fn a_flat_series_has_a_range() {
        for axis in [Axis::linear("x"), Axis::log10("x")] {
            let ruler = axis.ruler([2.0, 2.0].into_iter());
            assert!(ruler.range.0 < 2.0 && ruler.range.1 > 2.0 && ruler.step > 0.0);
        }
        let empty = Axis::linear("x").ruler(core::iter::empty());
        assert_eq!(empty.range, (0.0, 1.0));
    }
}
