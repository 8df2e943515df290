//! The name and the fields of a typed error.
//!
//! In: a [`StepError`], which implements `Serialize`. Out: the name of its variant, and its fields as [`Value`]s. A new
//! variant needs nothing here. JSON would lose infinite numbers and NaN.

use core::fmt;
use serde::Serialize;
use serde::ser::{Error as _, Impossible, SerializeSeq, SerializeStructVariant, SerializeTuple, Serializer};
use vi_core::StepError;

/// The value of a field.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Value {
    None,
    Number(f64),
    Integer(u64),
    Text(String),
    Numbers(Vec<f64>),
    Texts(Vec<String>),
}

/// Name of the variant, and the fields in the order of their declaration.
pub(crate) fn fields(error: &StepError) -> (&'static str, Vec<(&'static str, Value)>) {
    match error.serialize(Variants) {
        Ok(Variant { name, fields }) => (name, fields),
        // A variant without fields, or with fields of other types. The message of the exception has all numbers.
        Err(Unsupported) => ("StepError", Vec::new()),
    }
}

/// A value of a type that no error has.
#[derive(Debug)]
struct Unsupported;

impl fmt::Display for Unsupported {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("unsupported type of a field")
    }
}

impl core::error::Error for Unsupported {}

impl serde::ser::Error for Unsupported {
    fn custom<T: fmt::Display>(_: T) -> Self {
        Self
    }
}

/// A variant with its fields so far.
struct Variant {
    name: &'static str,
    fields: Vec<(&'static str, Value)>,
}

/// Serializes an enum whose variants have named fields.
struct Variants;

/// Serializes a field.
struct OfField;

/// Refuses types.
macro_rules! refuse {
    ($($function:ident: $type:ty),*) => {
        $(fn $function(self, _: $type) -> Result<Self::Ok, Unsupported> {
            Err(Unsupported)
        })*
    };
}

/// Refuses structured types, but for those given.
macro_rules! refuse_compounds {
    () => {
        type SerializeTupleStruct = Impossible<Self::Ok, Unsupported>;
        type SerializeTupleVariant = Impossible<Self::Ok, Unsupported>;
        type SerializeMap = Impossible<Self::Ok, Unsupported>;
        type SerializeStruct = Impossible<Self::Ok, Unsupported>;

        refuse!(serialize_bool: bool, serialize_char: char, serialize_bytes: &[u8], serialize_unit_struct: &'static str);

        fn serialize_unit(self) -> Result<Self::Ok, Unsupported> {
            Err(Unsupported)
        }
        fn serialize_unit_variant(self, _: &'static str, _: u32, _: &'static str) -> Result<Self::Ok, Unsupported> {
            Err(Unsupported)
        }
        fn serialize_newtype_struct<T: Serialize + ?Sized>(self, _: &'static str, of: &T) -> Result<Self::Ok, Unsupported> {
            of.serialize(self)
        }
        fn serialize_newtype_variant<T: Serialize + ?Sized>(
            self,
            _: &'static str,
            _: u32,
            _: &'static str,
            _: &T,
        ) -> Result<Self::Ok, Unsupported> {
            Err(Unsupported)
        }
        fn serialize_tuple_struct(self, _: &'static str, _: usize) -> Result<Self::SerializeTupleStruct, Unsupported> {
            Err(Unsupported)
        }
        fn serialize_tuple_variant(
            self,
            _: &'static str,
            _: u32,
            _: &'static str,
            _: usize,
        ) -> Result<Self::SerializeTupleVariant, Unsupported> {
            Err(Unsupported)
        }
        fn serialize_map(self, _: Option<usize>) -> Result<Self::SerializeMap, Unsupported> {
            Err(Unsupported)
        }
        fn serialize_struct(self, _: &'static str, _: usize) -> Result<Self::SerializeStruct, Unsupported> {
            Err(Unsupported)
        }
    };
}

impl Serializer for Variants {
    type Ok = Variant;
    type Error = Unsupported;
    type SerializeSeq = Impossible<Variant, Unsupported>;
    type SerializeTuple = Impossible<Variant, Unsupported>;
    type SerializeStructVariant = Variant;

    refuse_compounds!();
    refuse!(
        serialize_i8: i8, serialize_i16: i16, serialize_i32: i32, serialize_i64: i64, serialize_u8: u8,
        serialize_u16: u16, serialize_u32: u32, serialize_u64: u64, serialize_f32: f32, serialize_f64: f64,
        serialize_str: &str
    );

    fn serialize_none(self) -> Result<Variant, Unsupported> {
        Err(Unsupported)
    }
    fn serialize_some<T: Serialize + ?Sized>(self, _: &T) -> Result<Variant, Unsupported> {
        Err(Unsupported)
    }
    fn serialize_seq(self, _: Option<usize>) -> Result<Self::SerializeSeq, Unsupported> {
        Err(Unsupported)
    }
    fn serialize_tuple(self, _: usize) -> Result<Self::SerializeTuple, Unsupported> {
        Err(Unsupported)
    }
    fn serialize_struct_variant(
        self,
        _: &'static str,
        _: u32,
        name: &'static str,
        count: usize,
    ) -> Result<Variant, Unsupported> {
        Ok(Variant { name, fields: Vec::with_capacity(count) })
    }
}

impl SerializeStructVariant for Variant {
    type Ok = Self;
    type Error = Unsupported;

    fn serialize_field<T: Serialize + ?Sized>(&mut self, name: &'static str, value: &T) -> Result<(), Unsupported> {
        self.fields.push((name, value.serialize(OfField)?));
        Ok(())
    }
    fn end(self) -> Result<Self, Unsupported> {
        Ok(self)
    }
}

impl Serializer for OfField {
    type Ok = Value;
    type Error = Unsupported;
    type SerializeSeq = List;
    type SerializeTuple = List;
    type SerializeStructVariant = Impossible<Value, Unsupported>;

    refuse_compounds!();
    refuse!(serialize_i8: i8, serialize_i16: i16, serialize_i32: i32, serialize_i64: i64);

    fn serialize_u8(self, value: u8) -> Result<Value, Unsupported> {
        Ok(Value::Integer(value.into()))
    }
    fn serialize_u16(self, value: u16) -> Result<Value, Unsupported> {
        Ok(Value::Integer(value.into()))
    }
    fn serialize_u32(self, value: u32) -> Result<Value, Unsupported> {
        Ok(Value::Integer(value.into()))
    }
    fn serialize_u64(self, value: u64) -> Result<Value, Unsupported> {
        Ok(Value::Integer(value))
    }
    fn serialize_f32(self, value: f32) -> Result<Value, Unsupported> {
        Ok(Value::Number(value.into()))
    }
    fn serialize_f64(self, value: f64) -> Result<Value, Unsupported> {
        Ok(Value::Number(value))
    }
    fn serialize_str(self, value: &str) -> Result<Value, Unsupported> {
        Ok(Value::Text(value.to_owned()))
    }
    fn serialize_none(self) -> Result<Value, Unsupported> {
        Ok(Value::None)
    }
    fn serialize_some<T: Serialize + ?Sized>(self, value: &T) -> Result<Value, Unsupported> {
        value.serialize(self)
    }
    fn serialize_seq(self, _: Option<usize>) -> Result<List, Unsupported> {
        Ok(List(Vec::new()))
    }
    fn serialize_tuple(self, _: usize) -> Result<List, Unsupported> {
        Ok(List(Vec::new()))
    }
    fn serialize_struct_variant(
        self,
        _: &'static str,
        _: u32,
        _: &'static str,
        _: usize,
    ) -> Result<Self::SerializeStructVariant, Unsupported> {
        Err(Unsupported)
    }
}

/// A list of numbers, or of texts.
struct List(Vec<Value>);

impl SerializeSeq for List {
    type Ok = Value;
    type Error = Unsupported;

    fn serialize_element<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Unsupported> {
        self.0.push(value.serialize(OfField)?);
        Ok(())
    }

    fn end(self) -> Result<Value, Unsupported> {
        let numbers = self.0.iter().map(|value| if let Value::Number(number) = value { Some(*number) } else { None });
        if let Some(numbers) = numbers.collect() {
            return Ok(Value::Numbers(numbers));
        }
        let texts = self.0.into_iter().map(|value| if let Value::Text(text) = value { Some(text) } else { None });
        texts.collect::<Option<_>>().map(Value::Texts).ok_or_else(|| Unsupported::custom("mixed"))
    }
}

/// An array.
impl SerializeTuple for List {
    type Ok = Value;
    type Error = Unsupported;

    fn serialize_element<T: Serialize + ?Sized>(&mut self, value: &T) -> Result<(), Unsupported> {
        SerializeSeq::serialize_element(self, value)
    }

    fn end(self) -> Result<Value, Unsupported> {
        SerializeSeq::end(self)
    }
}
