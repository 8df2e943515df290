//! A quantity of a sweep with its finite values.
//!
//! An axis with given values is a dimension of the grid and has [`Axis::point`]s. For a random axis, [`Axis::draw`]
//! returns the value in a run.

use super::random::{normal, uniform};
use super::scene::{Over, Spacing};
use core::fmt;
use vi_erased::System;
use vi_report::failure::Failure;
use vi_report::numbers::short;
use vi_report::quantity::Quantity;

/// A quantity with its values.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Axis {
    /// Its name in the scene and in the columns.
    pub(super) name: String,
    pub(super) quantity: Quantity,
    /// Its index among the axes, which selects its random numbers.
    index: u64,
    choice: Choice,
}

/// The values of a quantity.
#[derive(Clone, Debug, PartialEq)]
enum Choice {
    Values(Vec<f64>),
    Range { from: f64, to: f64, count: u64, spacing: Spacing },
    Random(Law, [f64; 2]),
}

/// A probability distribution with two parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Law {
    Uniform,
    LogUniform,
    Normal,
}

impl Axis {
    /// The axis of a scene.
    ///
    /// # Errors
    /// [`Failure::Input`] if the system has no such quantity, or the axis has no values.
    pub(super) fn of(over: &Over, index: u64, system: &dyn System) -> Result<Self, Failure> {
        let quantity = Quantity::named(system, &over.name)?;
        let choice = Choice::of(over).and_then(|choice| choice.check().map(|()| choice));
        let choice = choice.map_err(|what| Failure::Input(format!("the sweep over `{}` {what}", over.name)))?;
        Ok(Self { name: over.name.clone(), quantity, index, choice })
    }

    /// Number of its points on the grid; `None` if it is random.
    pub(super) fn points(&self) -> Option<u64> {
        match &self.choice {
            Choice::Values(values) => u64::try_from(values.len()).ok(),
            Choice::Range { count, .. } => Some(*count),
            Choice::Random(..) => None,
        }
    }

    /// The value at a point of the grid.
    #[allow(clippy::cast_precision_loss)] // counts that a study can have
    pub(super) fn point(&self, index: u64) -> f64 {
        match &self.choice {
            Choice::Values(values) => {
                usize::try_from(index).ok().and_then(|index| values.get(index)).copied().unwrap_or(f64::NAN)
            }
            Choice::Range { from, .. } if index == 0 => *from,
            Choice::Range { to, count, .. } if index + 1 == *count => *to,
            Choice::Range { from, to, count, spacing } => {
                let part = index as f64 / (count - 1) as f64;
                match spacing {
                    Spacing::Linear => from + (to - from) * part,
                    Spacing::Log => from * (to / from).powf(part),
                }
            }
            Choice::Random(..) => f64::NAN,
        }
    }

    /// The value in the run with this seed.
    pub(super) fn draw(&self, seed: u64) -> f64 {
        let places = [2 * self.index, 2 * self.index + 1];
        match self.choice {
            Choice::Random(Law::Uniform, [low, high]) => low + (high - low) * uniform(seed, places[0]),
            Choice::Random(Law::LogUniform, [low, high]) => low * (high / low).powf(uniform(seed, places[0])),
            Choice::Random(Law::Normal, [mean, deviation]) => mean + deviation * normal(seed, places),
            _ => f64::NAN,
        }
    }
}

impl Choice {
    /// The only choice in a scene.
    fn of(over: &Over) -> Result<Self, String> {
        let Over { values, from, to, count, spacing, uniform, log_uniform, normal, .. } = over;
        let is_range = from.is_some() || to.is_some() || count.is_some() || spacing.is_some();
        let laws = [(Law::Uniform, uniform), (Law::LogUniform, log_uniform), (Law::Normal, normal)];
        let mut random = laws.into_iter().filter_map(|(law, numbers)| Some((law, numbers.as_ref()?)));
        match (values, is_range, random.next(), random.next()) {
            (Some(values), false, None, _) => Ok(Self::Values(values.clone())),
            (None, true, None, _) => {
                let numbers = from.zip(*to).zip(*count);
                let ((from, to), count) = numbers.ok_or("needs all of `from`, `to` and `count`")?;
                Ok(Self::Range { from, to, count, spacing: spacing.unwrap_or(Spacing::Linear) })
            }
            (None, false, Some((law, numbers)), None) => {
                let two = numbers.as_slice().try_into();
                let two = two.map_err(|_| format!("needs two numbers, not {}", numbers.len()))?;
                Ok(Self::Random(law, two))
            }
            _ => {
                let known = "values = […], from, to and count, uniform = […], log_uniform = […], normal = […]";
                Err(format!("needs one of these: {known}"))
            }
        }
    }

    /// Checks that every value is finite.
    fn check(&self) -> Result<(), String> {
        let (numbers, is_logarithmic) = match self {
            Self::Values(values) => (values.as_slice(), false),
            Self::Range { from, to, spacing, .. } => (&[*from, *to][..], *spacing == Spacing::Log),
            Self::Random(law, numbers) => (numbers.as_slice(), *law == Law::LogUniform),
        };
        if let Some(number) = numbers.iter().find(|number| !number.is_finite()) {
            return Err(format!("must have finite numbers, not {number}"));
        }
        let is_ratio = |pair: &[f64]| (pair[1] / pair[0]).is_normal() && pair[1] / pair[0] > 0.0;
        let what = match self {
            _ if is_logarithmic && !numbers.windows(2).all(is_ratio) => {
                "is logarithmic: give two nonzero numbers of the same sign"
            }
            Self::Values(values) if values.is_empty() => "has no values",
            Self::Range { count: 0, .. } => "has no values: `count` must be at least 1",
            Self::Range { from, to, count: 1, .. } if from.to_bits() != to.to_bits() => {
                "goes from one value to another: `count` must be at least 2"
            }
            Self::Random(Law::Uniform | Law::LogUniform, [low, high]) if low >= high => {
                "must give a lower and a higher number, in this order"
            }
            Self::Random(Law::Uniform, [low, high]) | Self::Range { from: low, to: high, .. }
                if !(high - low).is_finite() =>
            {
                "exceeds the range of double precision"
            }
            Self::Random(Law::Normal, [_, deviation]) if *deviation <= 0.0 => {
                "must have a positive deviation, the second number of `normal`"
            }
            _ => return Ok(()),
        };
        Err(what.to_owned())
    }
}

impl fmt::Display for Axis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let values = match &self.choice {
            Choice::Values(values) => {
                format!("= {}", values.iter().map(|value| short(*value)).collect::<Vec<_>>().join(", "))
            }
            Choice::Range { from, to, count, spacing } => {
                let spacing = if *spacing == Spacing::Log { ", in equal ratios" } else { "" };
                format!("from {} to {}, {count} values{spacing}", short(*from), short(*to))
            }
            Choice::Random(law, [a, b]) => {
                let (a, b) = (short(*a), short(*b));
                match law {
                    Law::Uniform => format!("random from {a} to {b}"),
                    Law::LogUniform => format!("random from {a} to {b} by its logarithm"),
                    Law::Normal => format!("random about {a}, deviation {b}"),
                }
            }
        };
        write!(f, "{} {values}", self.name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ready;

    fn axis(over: Over) -> Result<Axis, String> {
        let entry = ready().find("kepler").unwrap_or_else(|failure| panic!("{failure}"));
        let over = Over { name: "x".to_owned(), ..over };
        Axis::of(&over, 2, entry.system.as_ref()).map_err(|failure| failure.to_string())
    }

    fn range(from: f64, to: f64, count: u64, spacing: Option<Spacing>) -> Over {
        Over { from: Some(from), to: Some(to), count: Some(count), spacing, ..Over::default() }
    }

    #[test]
    fn values_and_ranges_have_their_points() {
        let points = |over: Over| {
            let axis = axis(over).unwrap_or_else(|message| panic!("{message}"));
            (0..axis.points().unwrap_or_default()).map(|index| axis.point(index)).collect::<Vec<_>>()
        };
        assert_eq!(points(Over { values: Some(vec![3.0, -1.0]), ..Over::default() }), [3.0, -1.0]);
        assert_eq!(points(range(1.0, 2.0, 5, None)), [1.0, 1.25, 1.5, 1.75, 2.0]);
        assert_eq!(points(range(2.0, 2.0, 1, None)), [2.0]);
        let powers = points(range(-1e-3, -10.0, 5, Some(Spacing::Log)));
        for (point, expected) in powers.iter().zip([-1e-3, -1e-2, -1e-1, -1.0, -10.0]) {
            // Measured 2.3e-16.
            assert!((point / expected - 1.0).abs() < 3e-16, "{point}");
        }
        assert_eq!(powers.last(), Some(&-10.0), "the last one is that of the scene");
    }

    #[test]
    fn draws_lie_where_they_should() {
        let draws = |over: Over| {
            let axis = axis(over).unwrap_or_else(|message| panic!("{message}"));
            assert_eq!(axis.points(), None);
            let mut draws: Vec<f64> = (0..1001).map(|seed| axis.draw(seed)).collect();
            draws.sort_by(f64::total_cmp);
            (draws[0], draws[500], draws[1000])
        };
        let (low, middle, high) = draws(Over { uniform: Some(vec![2.0, 4.0]), ..Over::default() });
        assert!(
            low > 2.0 && low < 2.02 && (middle - 3.0).abs() < 0.13 && high < 4.0 && high > 3.98,
            "{low} {middle} {high}"
        );
        let (low, middle, high) = draws(Over { log_uniform: Some(vec![1e-4, 1.0]), ..Over::default() });
        assert!(low > 1e-4 && (middle.log10() + 2.0).abs() < 0.26 && high < 1.0, "{low} {middle} {high}");
        let (low, middle, high) = draws(Over { normal: Some(vec![5.0, 0.1]), ..Over::default() });
        assert!(low > 4.5 && (middle - 5.0).abs() < 0.016 && high < 5.5, "{low} {middle} {high}");
    }

    #[test]
    fn what_gives_no_values_is_named() {
        let both = Over { values: Some(vec![1.0]), uniform: Some(vec![0.0, 1.0]), ..Over::default() };
        for (over, message) in [
            (
                Over::default(),
                "needs one of these: values = […], from, to and count, uniform = […], log_uniform = […], normal = […]",
            ),
            (
                both,
                "needs one of these: values = […], from, to and count, uniform = […], log_uniform = […], normal = […]",
            ),
            (Over { from: Some(1.0), ..Over::default() }, "needs all of `from`, `to` and `count`"),
            (Over { values: Some(Vec::new()), ..Over::default() }, "has no values"),
            (Over { values: Some(vec![f64::NAN]), ..Over::default() }, "must have finite numbers, not NaN"),
            (Over { uniform: Some(vec![0.0, 1.0, 2.0]), ..Over::default() }, "needs two numbers, not 3"),
            (range(0.0, 1.0, 0, None), "has no values: `count` must be at least 1"),
            (range(0.0, 1.0, 1, None), "goes from one value to another: `count` must be at least 2"),
            (range(-f64::MAX, f64::MAX, 3, None), "exceeds the range of double precision"),
            (range(0.0, 1.0, 3, Some(Spacing::Log)), "is logarithmic: give two nonzero numbers of the same sign"),
            (
                Over { uniform: Some(vec![1.0, 1.0]), ..Over::default() },
                "must give a lower and a higher number, in this order",
            ),
            (
                Over { normal: Some(vec![1.0, 0.0]), ..Over::default() },
                "must have a positive deviation, the second number of `normal`",
            ),
        ] {
            assert_eq!(axis(over), Err(format!("the sweep over `x` {message}")));
        }
    }
}
