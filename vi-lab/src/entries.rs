//! Entries of a scene as a user writes them.
//!
//! In: a value of TOML or of the command line. Out: a count or a choice, or one line with the allowed values.

use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use core::fmt;
use core::marker::PhantomData;
use serde::de::{self, Deserializer, EnumAccess, Error as _, Expected, Unexpected, VariantAccess as _, Visitor};
use vi_erased::plan::Named;
use vi_report::input::{COUNT, whole};

/// The count of an entry of a scene, `1000` or `1e6`.
///
/// # Errors
/// The allowed values, at the place of the entry.
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
/// The existing names, at the place of the entry.
pub(crate) fn choice<'de, D: Deserializer<'de>, T: Named>(entry: D) -> Result<Option<T>, D::Error> {
    entry.deserialize_enum("", &[], Choice(PhantomData)).map(Some)
}

/// Reads a choice from the command line.
pub(crate) fn named<T: Named + Send + Sync>() -> impl TypedValueParser<Value = T> {
    let values = T::VALUES.iter().map(|value| {
        let aliases = T::ALIASES.iter().filter(|(_, of)| of.name() == value.name()).map(|(alias, _)| *alias);
        PossibleValue::new(value.name()).aliases(aliases).help(value.about())
    });
    PossibleValuesParser::new(values).try_map(|name| T::named(&name).ok_or("no such choice"))
}

/// Reads a choice.
struct Choice<T>(PhantomData<T>);

impl<'de, T: Named> Visitor<'de> for Choice<T> {
    type Value = T;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let names: Vec<String> = T::VALUES.iter().map(|value| format!("`{}`", value.name())).collect();
        match names.as_slice() {
            [one, other] => write!(f, "{one} or {other}"),
            names => write!(f, "one of {}", names.join(", ")),
        }
    }

    fn visit_enum<A: EnumAccess<'de>>(self, entry: A) -> Result<T, A::Error> {
        let (name, variant) = entry.variant::<String>()?;
        variant.unit_variant()?;
        let unknown = || A::Error::custom(format!("unknown variant `{name}`, expected {}", &self as &dyn Expected));
        T::named(&name).ok_or_else(unknown)
    }
}
