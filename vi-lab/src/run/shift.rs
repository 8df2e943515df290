//! The shift of energy-preserving steps in input: a number, or `auto`.
//!
//! In: text, or a TOML value. Out: the shift, or one line with the allowed values.

use core::fmt;
use serde::Deserializer;
use serde::de::{self, Visitor};
use vi_erased::plan::Shift;
use vi_report::input::number;

/// A requested shift.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Wanted {
    /// This value, in the units of the step density.
    Given(f64),
    /// Measured along the motion.
    Auto,
}

impl Wanted {
    /// The shift of a plan; `auto` is measured over this time from the start.
    pub(super) fn over(self, time: f64) -> Shift {
        match self {
            Self::Given(shift) => Shift::Of(shift),
            Self::Auto => Shift::Over(time),
        }
    }
}

/// The allowed values.
const SHIFT: &str = "a number in the units of the step density, such as 4.9, or auto";

/// Parses the shift on a command line.
pub(crate) fn wanted(text: &str) -> Result<Wanted, String> {
    if text.trim() == "auto" {
        return Ok(Wanted::Auto);
    }
    number(text).map(Wanted::Given).map_err(|_| format!("write {SHIFT}"))
}

/// Parses the shift in a scene.
pub(super) fn of_scene<'de, D: Deserializer<'de>>(entry: D) -> Result<Option<Wanted>, D::Error> {
    entry.deserialize_any(ShiftVisitor).map(Some)
}

/// Parser of a shift.
struct ShiftVisitor;

impl Visitor<'_> for ShiftVisitor {
    type Value = Wanted;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(SHIFT)
    }

    fn visit_str<E: de::Error>(self, value: &str) -> Result<Wanted, E> {
        if value == "auto" { Ok(Wanted::Auto) } else { Err(E::invalid_value(de::Unexpected::Str(value), &self)) }
    }

    #[allow(clippy::cast_precision_loss)] // a shift is no count
    fn visit_i64<E: de::Error>(self, value: i64) -> Result<Wanted, E> {
        Ok(Wanted::Given(value as f64))
    }

    fn visit_f64<E: de::Error>(self, value: f64) -> Result<Wanted, E> {
        Ok(Wanted::Given(value))
    }
}
