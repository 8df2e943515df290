//! Entries of a scene as a user writes them.
//!
//! In: a value of TOML. Out: a count or a choice, or one line that says what is allowed.

use clap::ValueEnum;
use core::fmt;
use core::marker::PhantomData;
use serde::de::{self, Deserializer, EnumAccess, Error as _, Expected, Unexpected, VariantAccess as _, Visitor};
use vi_report::input::{COUNT, whole};

/// The count of an entry of a scene, `1000` or `1e6`.
///
/// # Errors
/// What is allowed, at the place of the entry.
pub(crate) fn count<'de, D: Deserializer<'de>>(entry: D) -> Result<Option<u64>, D::Error> {
    entry.deserialize_any(Count).map(Some)
}

/// Reads a count.
struct Count;

impl Visitor<'_> for Count {
    type Value = u64;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(COUNT)
    }

    fn visit_i64<E: de::Error>(self, value: i64) -> Result<u64, E> {
        u64::try_from(value).map_err(|_| E::invalid_value(Unexpected::Signed(value), &self))
    }

    fn visit_f64<E: de::Error>(self, value: f64) -> Result<u64, E> {
        whole(value).ok_or_else(|| E::invalid_value(Unexpected::Float(value), &self))
    }
}

/// A choice by its name on the command line.
///
/// # Errors
/// The names that there are, at the place of the entry.
pub(crate) fn choice<'de, D: Deserializer<'de>, T: ValueEnum>(entry: D) -> Result<Option<T>, D::Error> {
    entry.deserialize_enum("", &[], Choice(PhantomData)).map(Some)
}

/// Reads a choice.
struct Choice<T>(PhantomData<T>);

impl<'de, T: ValueEnum> Visitor<'de> for Choice<T> {
    type Value = T;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let values = T::value_variants().iter().filter_map(ValueEnum::to_possible_value);
        let names: Vec<String> = values.map(|value| format!("`{}`", value.get_name())).collect();
        match names.as_slice() {
            [one, other] => write!(f, "{one} or {other}"),
            names => write!(f, "one of {}", names.join(", ")),
        }
    }

    fn visit_enum<A: EnumAccess<'de>>(self, entry: A) -> Result<T, A::Error> {
        let (name, variant) = entry.variant::<String>()?;
        variant.unit_variant()?;
        let unknown = |_| A::Error::custom(format!("unknown variant `{name}`, expected {}", &self as &dyn Expected));
        T::from_str(&name, false).map_err(unknown)
    }
}
