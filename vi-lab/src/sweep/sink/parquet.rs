//! A table as Parquet: numbers as doubles, counts as integers, words as text; the facts are file metadata.

use super::super::chunks::Description;
use super::super::schema::{Column, ColumnKind, Schema, word};
use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::data_type::{ByteArray, ByteArrayType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::{Type, TypePtr};
use std::fs::File;
use std::io;
use std::sync::Arc;

/// Number of rows in a group, except the last.
const GROUP: usize = 1 << 14;

/// A Parquet file.
pub(super) struct Parquet {
    writer: SerializedFileWriter<File>,
    columns: Vec<Column>,
    /// Rows to be written.
    rows: Vec<f64>,
}

impl Parquet {
    pub(super) fn begin(file: File, study: &Description, schema: &Schema) -> io::Result<Self> {
        let facts = study.facts.iter().map(|(name, fact)| KeyValue::new(name.clone(), fact.clone())).collect();
        let properties = WriterProperties::builder().set_key_value_metadata(Some(facts)).build();
        let writer = SerializedFileWriter::new(file, message_type(schema)?, Arc::new(properties))?;
        Ok(Self { writer, columns: schema.columns.clone(), rows: Vec::new() })
    }

    /// Writes the rows as a group, column by column.
    fn flush(&mut self) -> Result<(), ParquetError> {
        if self.rows.is_empty() {
            return Ok(());
        }
        let mut group = self.writer.next_row_group()?;
        for (index, column) in self.columns.iter().enumerate() {
            let numbers = self.rows.iter().skip(index).step_by(self.columns.len()).copied();
            let Some(mut writer) = group.next_column()? else { break };
            match &column.kind {
                ColumnKind::Number => {
                    writer.typed::<DoubleType>().write_batch(&numbers.collect::<Vec<_>>(), None, None)?;
                }
                #[allow(clippy::cast_possible_truncation)] // counts below 2^53
                ColumnKind::Count => {
                    let counts: Vec<i64> = numbers.map(|number| number as i64).collect();
                    writer.typed::<Int64Type>().write_batch(&counts, None, None)?;
                }
                ColumnKind::Words(words) => {
                    let texts: Vec<ByteArray> = numbers.map(|number| ByteArray::from(word(words, number))).collect();
                    writer.typed::<ByteArrayType>().write_batch(&texts, None, None)?;
                }
            }
            writer.close()?;
        }
        group.close()?;
        self.rows.clear();
        Ok(())
    }

    /// Adds a row. Groups have equal size, so that the file does not depend on the division of the sweep.
    ///
    /// # Errors
    /// The error of the file system.
    pub(super) fn write(&mut self, row: &[f64]) -> io::Result<()> {
        self.rows.extend(row);
        if self.rows.len() >= GROUP * self.columns.len() {
            self.flush()?;
        }
        Ok(())
    }

    /// Writes the rest and returns the file.
    ///
    /// # Errors
    /// The error of the file system.
    pub(super) fn finish(mut self) -> io::Result<File> {
        self.flush()?;
        Ok(self.writer.into_inner()?)
    }
}

/// The columns with their types.
fn message_type(schema: &Schema) -> Result<TypePtr, ParquetError> {
    let field = |column: &Column| {
        let (physical, logical) = match column.kind {
            ColumnKind::Number => (Physical::DOUBLE, None),
            ColumnKind::Count => (Physical::INT64, None),
            ColumnKind::Words(_) => (Physical::BYTE_ARRAY, Some(LogicalType::String)),
        };
        let builder = Type::primitive_type_builder(&column.name, physical);
        builder.with_repetition(Repetition::REQUIRED).with_logical_type(logical).build().map(Arc::new)
    };
    let fields = schema.columns.iter().map(field).collect::<Result<_, _>>()?;
    Ok(Arc::new(Type::group_type_builder("sweep").with_fields(fields).build()?))
}
