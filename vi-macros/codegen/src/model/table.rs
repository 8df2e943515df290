//! Tables: functions given by values.
//!
//! In: a clause `table`. Out: its places and values as numbers, or the parameters that are its values. A file is read
//! here; the generated code makes cargo build again when it changes.

use super::Parameter;
use super::context::Context;
use super::scope::Meaning;
use crate::messages::{FunctionMistake, Message, nearest};
use crate::symbol::Symbol;
use crate::syntax::{self, Expression, TableArgument, TableData};
use proc_macro2::{Ident, Span};
use std::path::{Path, PathBuf};
use vi_expr::Expr;

/// Maximum number of values of a table.
const VALUES: usize = 4096;
/// Maximum number of parameters that are values of a table: each evaluation reads all of them.
const PARAMETERS: usize = 64;
/// Minimum number of values of a periodic table: with fewer, no spline is determined.
const LEAST_PERIODIC: usize = 4;

/// The words after the values.
const WORDS: [&str; 7] = ["cubic", "quintic", "monotone", "linear", "periodic", "hold", "extend"];

/// A function given by values.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    /// The interpolation between the values.
    pub kind: TableKind,
    /// What holds outside of the given places.
    pub outside: Outside,
    /// Places and values.
    pub values: Values,
    /// The file of the values.
    pub file: Option<PathBuf>,
}

/// Interpolation between values.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableKind {
    /// A cubic spline, twice continuously differentiable.
    Cubic,
    /// A quintic spline, four times continuously differentiable.
    Quintic,
    /// Cubics without overshoot, once continuously differentiable.
    Monotone,
    /// Straight lines.
    Linear,
}

impl TableKind {
    /// Its word in the language.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Cubic => "cubic",
            Self::Quintic => "quintic",
            Self::Monotone => "monotone",
            Self::Linear => "linear",
        }
    }

    /// The number of continuous derivatives.
    #[must_use]
    pub fn smoothness(self) -> usize {
        match self {
            Self::Cubic => 2,
            Self::Quintic => 4,
            Self::Monotone => 1,
            Self::Linear => 0,
        }
    }
}

/// What holds outside of the given places.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outside {
    /// No value: a step that reads it is an error.
    Nothing,
    /// The value at the end.
    Hold,
    /// The line with the slope at the end.
    Extend,
    /// The values repeat.
    Periodic,
}

impl Outside {
    /// Its word in the language; `None` for the default.
    #[must_use]
    pub fn name(self) -> Option<&'static str> {
        match self {
            Self::Nothing => None,
            Self::Hold => Some("hold"),
            Self::Extend => Some("extend"),
            Self::Periodic => Some("periodic"),
        }
    }
}

/// The values of a table, at ascending places.
#[derive(Clone, Debug, PartialEq)]
pub enum Values {
    /// Places and values.
    Points {
        /// The places.
        places: Vec<f64>,
        /// The values.
        values: Vec<f64>,
    },
    /// A grid: one row of values for each place of the first argument.
    Grid {
        /// The places of the first and of the second argument.
        places: [Vec<f64>; 2],
        /// The values, row by row.
        rows: Vec<Vec<f64>>,
    },
    /// Values at equal distances that are parameters.
    Parameters {
        /// The first and the last place.
        ends: [f64; 2],
        /// The name of the array.
        name: Ident,
        /// The number of its entries.
        count: usize,
    },
}

impl Table {
    /// The period, if it has one.
    #[must_use]
    pub fn period(&self) -> Option<f64> {
        let [from, to] = self.ends().filter(|_| self.outside == Outside::Periodic)?;
        Some(to - from)
    }

    /// The first and the last place of a table of one argument.
    #[must_use]
    pub fn ends(&self) -> Option<[f64; 2]> {
        match &self.values {
            Values::Points { places, .. } => Some([*places.first()?, *places.last()?]),
            Values::Parameters { ends, .. } => Some(*ends),
            Values::Grid { .. } => None,
        }
    }
}

/// Checks a table. Returns it with the parameters that are its values; reports every mistake.
pub(super) fn table(
    context: &mut Context,
    written: &syntax::Table,
    (of, declared): (&syntax::System, &[Parameter]),
) -> Option<(Table, Vec<Expr>)> {
    let mut reader = Reader { context, written, of, wrong: false };
    let (kind, outside) = reader.words();
    if !(1..=2).contains(&written.arguments.len()) {
        reader.report(
            written.name.span(),
            format!("has {} arguments", written.arguments.len()),
            "a table has one or two arguments".to_owned(),
        );
        return None;
    }
    let (values, parameters, file) = reader.values()?;
    let table = Table { kind, outside, values, file };
    reader.check(&table);
    reader.check_period(&table, &parameters, declared);
    (!reader.wrong).then_some((table, parameters))
}

struct Reader<'a, 'b> {
    context: &'a mut Context<'b>,
    written: &'a syntax::Table,
    of: &'a syntax::System,
    wrong: bool,
}

impl Reader<'_, '_> {
    fn report(&mut self, span: Span, what: String, help: String) {
        let name = self.written.name.to_string();
        self.context.errors.at(span, &Message::Function(FunctionMistake::Table { name, what, help }));
        self.wrong = true;
    }

    /// The kind of interpolation, and what holds outside.
    fn words(&mut self) -> (TableKind, Outside) {
        let (mut kind, mut outside) = (None, None);
        for word in &self.written.words {
            let text = word.to_string();
            let new_kind = match text.as_str() {
                "cubic" => Some(TableKind::Cubic),
                "quintic" => Some(TableKind::Quintic),
                "monotone" => Some(TableKind::Monotone),
                "linear" => Some(TableKind::Linear),
                _ => None,
            };
            let new_outside = match text.as_str() {
                "hold" => Some(Outside::Hold),
                "extend" => Some(Outside::Extend),
                "periodic" => Some(Outside::Periodic),
                _ => None,
            };
            if new_kind.is_none() && new_outside.is_none() {
                let near = nearest(&text, WORDS);
                self.context.errors.at(word.span(), &Message::Function(FunctionMistake::Word { word: text, near }));
                self.wrong = true;
                continue;
            }
            let is_second = new_kind.is_some() && kind.is_some() || new_outside.is_some() && outside.is_some();
            if is_second {
                let help =
                    "write one of cubic, quintic, monotone, linear, and one of periodic, hold, extend".to_owned();
                self.report(word.span(), format!("cannot also be `{text}`"), help);
            }
            (kind, outside) = (new_kind.or(kind), new_outside.or(outside));
        }
        (kind.unwrap_or(TableKind::Cubic), outside.unwrap_or(Outside::Nothing))
    }

    fn values(&mut self) -> Option<(Values, Vec<Expr>, Option<PathBuf>)> {
        match &self.written.data {
            TableData::File(path) => {
                let file = self.of.folder.join(path.value());
                let rows = self.file(&file, path.span())?;
                Some((self.values_of_rows(rows, path.span())?, Vec::new(), Some(file)))
            }
            TableData::Points(points) => {
                let rows = self.numbers(points);
                if self.written.arguments.len() > 1 || rows.iter().any(|row| row.len() != 2) {
                    let help = "write points `(0, 0.1)` for one argument; for two arguments write rows of values, \
                                `table f(x in 0..1, y in 0..2) = [[1, 2], [3, 4]];`";
                    self.report(
                        self.written.name.span(),
                        "has no place and value in each point".to_owned(),
                        help.to_owned(),
                    );
                    return None;
                }
                if let Some(argument) = self.written.arguments.iter().find(|argument| argument.range.is_some()) {
                    let help = format!("write `{}` without a range, or values without places", argument.name);
                    self.report(argument.name.span(), "has places in its points and a range".to_owned(), help);
                    return None;
                }
                let (places, values) = rows.iter().map(|row| (row[0], row[1])).unzip();
                Some((Values::Points { places, values }, Vec::new(), None))
            }
            TableData::Rows(rows) => {
                let rows = self.numbers(rows);
                Some((self.at_equal_distances(rows)?, Vec::new(), None))
            }
            TableData::Parameters(name) => self.parameters(name),
        }
    }

    fn numbers(&mut self, rows: &[Vec<Expression>]) -> Vec<Vec<f64>> {
        let name = &self.written.name;
        let row = |row: &Vec<Expression>| row.iter().map(|value| self.context.number(value, name).1).collect();
        rows.iter().map(row).collect()
    }

    /// The ends of the range of an argument.
    fn ends(&mut self, argument: &TableArgument) -> Option<[f64; 2]> {
        let Some((from, to)) = &argument.range else {
            let help = format!("write the range of its values, as in `{} in 0..1`", argument.name);
            self.report(argument.name.span(), format!("has values without places in `{}`", argument.name), help);
            return None;
        };
        let ends = [from, to].map(|end| self.context.number(end, &argument.name).1);
        if ends[0] >= ends[1] {
            let help = "write the smaller end first; both ends are included".to_owned();
            self.report(to.span, "has a range that ends before it begins".to_owned(), help);
            return None;
        }
        Some(ends)
    }

    /// Values at equal distances: one row, or a grid.
    fn at_equal_distances(&mut self, mut rows: Vec<Vec<f64>>) -> Option<Values> {
        let written = self.written;
        if written.arguments.len() == 1 && rows.len() > 1 && rows.iter().all(|row| row.len() == 2) {
            let help = "write points in parentheses, `[(0, 0.1), (1, 0.3)]`".to_owned();
            self.report(written.name.span(), format!("has {} rows of values", rows.len()), help);
            return None;
        }
        let ends: Option<Vec<[f64; 2]>> = written.arguments.iter().map(|argument| self.ends(argument)).collect();
        let ends = ends?;
        if let ([ends], 1) = (ends.as_slice(), rows.len()) {
            let values = rows.remove(0);
            return Some(Values::Points { places: places(*ends, values.len()), values });
        }
        let [first, second] = ends[..] else {
            let help = "write one row of values for one argument, rows of values for two".to_owned();
            self.report(written.name.span(), format!("has {} rows of values", rows.len()), help);
            return None;
        };
        let columns = rows.first().map_or(0, Vec::len);
        Some(Values::Grid { places: [places(first, rows.len()), places(second, columns)], rows })
    }

    /// The rows of a file as values: places with values, or a grid whose first row and column are places.
    fn values_of_rows(&mut self, mut rows: Vec<Vec<f64>>, span: Span) -> Option<Values> {
        let columns = rows.first().map_or(0, Vec::len);
        let is_one = self.written.arguments.len() == 1;
        if is_one && columns == 1 {
            return self.at_equal_distances(vec![rows.into_iter().flatten().collect()]);
        }
        if let Some(argument) = self.written.arguments.iter().find(|argument| argument.range.is_some()) {
            let help = format!("write `{}` without a range: the file has the places", argument.name);
            self.report(argument.name.span(), "has places in its file and a range".to_owned(), help);
            return None;
        }
        if is_one {
            if rows.iter().any(|row| row.len() != 2) {
                let help = "write two columns: the place and the value".to_owned();
                self.report(span, format!("has {columns} columns in its file"), help);
                return None;
            }
            let (places, values) = rows.iter().map(|row| (row[0], row[1])).unzip();
            return Some(Values::Points { places, values });
        }
        if rows.len() < 2 || columns < 2 {
            let help = "write the places of the second argument in the first row, and in every other row the place of the first argument \
                        and its values";
            self.report(span, "has no grid in its file".to_owned(), help.to_owned());
            return None;
        }
        // The corner has no meaning.
        let second = rows.remove(0).split_off(1);
        let first = rows.iter_mut().map(|row| row.remove(0)).collect();
        Some(Values::Grid { places: [first, second], rows })
    }

    /// The numbers of a file, row by row. Its first row may be a header, in which no cell begins as a number; the corner
    /// of a grid may be text.
    fn file(&mut self, file: &Path, span: Span) -> Option<Vec<Vec<f64>>> {
        let text = match self.of.files.get(file) {
            Some(text) => text.clone(),
            None => self.read(file, span)?,
        };
        self.rows(&text, span)
    }

    /// The text of a file.
    fn read(&mut self, file: &Path, span: Span) -> Option<String> {
        if std::fs::metadata(file).is_ok_and(|about| !syntax::is_readable(&about)) {
            let help = format!("`{}`: write the path of a file of at most 16 MB", file.display());
            self.report(span, "cannot be read from its file".to_owned(), help);
            return None;
        }
        match std::fs::read_to_string(file) {
            Ok(text) => Some(text),
            Err(reason) => {
                let start = match &self.written.data {
                    TableData::File(path) if Path::new(&path.value()).is_absolute() => "of a file that exists",
                    _ if self.of.folder.as_os_str().is_empty() => "that starts at the current folder",
                    _ => "that starts at the folder of `Cargo.toml`",
                };
                let help = format!("`{}`: {reason}; write a path {start}", file.display());
                self.report(span, "cannot be read from its file".to_owned(), help);
                None
            }
        }
    }

    /// The numbers of the text of a file.
    fn rows(&mut self, text: &str, span: Span) -> Option<Vec<Vec<f64>>> {
        let is_grid = self.written.arguments.len() == 2;
        let mut rows: Vec<Vec<f64>> = Vec::new();
        let mut is_first = true;
        for (line, number) in text.trim_start_matches('\u{feff}').lines().zip(1..) {
            let line = line.trim();
            if line.is_empty() || line.starts_with('#') {
                continue;
            }
            let cells: Vec<&str> = cells(line);
            let is_header = core::mem::replace(&mut is_first, false);
            let places = if is_grid && is_header { &cells[1..] } else { &cells[..] };
            // The message says where a cell is, and not what it holds: the path may be wrong, and the file a secret.
            let first = cells.len() - places.len() + 1;
            let row: Result<Vec<f64>, usize> =
                places.iter().zip(first..).map(|(cell, column)| finite(cell).ok_or(column)).collect();
            match row {
                Ok(row) => rows.push(if is_grid && is_header { [vec![0.0], row].concat() } else { row }),
                Err(_) if is_header && !is_grid && !cells.iter().any(|cell| begins_number(cell)) => {}
                Err(column) => {
                    let help = "write numbers with a decimal point, separated by commas, semicolons, tabs or spaces; the first line may hold \
                                names, and `#` starts a comment"
                        .to_owned();
                    let what = format!("has no finite number in column {column} of line {number} of its file");
                    self.report(span, what, help);
                    return None;
                }
            }
            let columns = rows.first().map_or(0, Vec::len);
            if let Some(row) = rows.last().filter(|row| row.len() != columns) {
                let what = format!("has {} columns in line {number} of its file, and {columns} before", row.len());
                self.report(span, what, "write the same number of columns in every line".to_owned());
                return None;
            }
        }
        if rows.is_empty() {
            self.report(span, "has no numbers in its file".to_owned(), "write one row for each place".to_owned());
            return None;
        }
        Some(rows)
    }

    fn parameters(&mut self, name: &Ident) -> Option<(Values, Vec<Expr>, Option<PathBuf>)> {
        let written = self.written;
        let meaning = self.context.scope.meaning(&name.to_string()).cloned();
        let pool = &*self.context.pool;
        let is_parameter = |expr: &Expr| matches!(pool.as_symbol(*expr), Some(Symbol::Parameter { .. }));
        let entries = match meaning {
            Some(Meaning::Array(array)) => match array.at(&name.to_string(), &[], name.span()) {
                Ok(value) if value.shape().len() == 1 && value.entries().iter().all(is_parameter) => {
                    value.entries().to_vec()
                }
                _ => Vec::new(),
            },
            Some(Meaning::Wrong) => return None,
            _ => Vec::new(),
        };
        if entries.is_empty() {
            let help = "write the name of an array of parameters, as `c` after `param c[9] = 0;`".to_owned();
            self.report(name.span(), format!("has the values `{name}`, which is no array of parameters"), help);
            return None;
        }
        if entries.len() > PARAMETERS || written.arguments.len() != 1 {
            let help = format!("use at most {PARAMETERS} parameters, and one argument");
            self.report(name.span(), format!("has the values `{name}` with {} entries", entries.len()), help);
            return None;
        }
        let ends = self.ends(&written.arguments[0])?;
        let values = Values::Parameters { ends, name: name.clone(), count: entries.len() };
        Some((values, entries, None))
    }

    /// Reports parameters of a periodic table whose last default is the first one again, as constants need it.
    fn check_period(&mut self, table: &Table, entries: &[Expr], declared: &[Parameter]) {
        let default = |entry: &Expr| match self.context.pool.as_symbol(*entry) {
            Some(Symbol::Parameter { index, .. }) => declared.get(*index).map(|parameter| parameter.default.to_bits()),
            _ => None,
        };
        let defaults: Vec<u64> = entries.iter().filter_map(default).collect();
        let repeats = defaults.first() == defaults.last() && defaults.windows(2).any(|pair| pair[0] != pair[1]);
        if table.outside == Outside::Periodic && repeats {
            let help = "parameters stand for one period without its end: declare one entry less".to_owned();
            self.report(
                self.written.name.span(),
                "is `periodic`, and has its first value again at the end".to_owned(),
                help,
            );
        }
    }

    /// Reports too few or too many values, places that do not ascend, and a kind that these values do not have.
    fn check(&mut self, table: &Table) {
        let span = self.written.name.span();
        let (counts, axes): (Vec<usize>, Vec<&[f64]>) = match &table.values {
            Values::Points { places, .. } => (vec![places.len()], vec![places]),
            Values::Grid { places: [first, second], rows } => {
                if rows.iter().any(|row| row.len() != second.len()) {
                    self.report(
                        span,
                        "has rows of different lengths".to_owned(),
                        "write as many values in every row".to_owned(),
                    );
                    return;
                }
                (vec![first.len(), second.len()], vec![first, second])
            }
            Values::Parameters { count, .. } => (vec![*count], Vec::new()),
        };
        let is_smooth_only = !matches!(table.values, Values::Points { .. });
        if is_smooth_only && matches!(table.kind, TableKind::Quintic | TableKind::Monotone) {
            let help = "a grid, and a table of parameters, can be `cubic` or `linear`".to_owned();
            self.report(span, format!("cannot be `{}`", table.kind.name()), help);
        }
        if matches!(table.values, Values::Grid { .. }) && table.outside == Outside::Periodic {
            self.report(
                span,
                "cannot be `periodic`".to_owned(),
                "a grid can be continued by `hold` or `extend`".to_owned(),
            );
        }
        let is_periodic = table.outside == Outside::Periodic;
        let least = if is_periodic { LEAST_PERIODIC } else { 2 };
        if let Some(few) = counts.iter().find(|count| **count < least) {
            let values = if *few == 1 { "value" } else { "values" };
            self.report(
                span,
                format!("has {few} {values}"),
                format!("write at least {least} values for each argument"),
            );
        }
        let all: usize = counts.iter().product();
        if all > VALUES {
            self.report(span, format!("has {all} values"), format!("write at most {VALUES} values"));
        }
        for axis in axes {
            if let Some(pair) = axis.windows(2).find(|pair| pair[0] >= pair[1])
                && let [before, after] = pair
            {
                let what = format!("has the place {after} after {before}");
                self.report(span, what, "write the places in ascending order, each once".to_owned());
            }
        }
        if let (true, Values::Points { values, .. }) = (is_periodic, &table.values)
            && values.first() != values.last()
        {
            let help = "write the first value again at the end of the period".to_owned();
            self.report(span, "is `periodic`, but its first and last values differ".to_owned(), help);
        }
    }
}

/// Places at equal distances.
fn places([from, to]: [f64; 2], count: usize) -> Vec<f64> {
    let number = |place: usize| u32::try_from(place).map_or(f64::NAN, f64::from);
    let last = number(count.saturating_sub(1));
    (0..count).map(|place| if place + 1 == count { to } else { from + (to - from) * (number(place) / last) }).collect()
}

/// The cells of a line, separated by commas, semicolons, tabs or spaces.
fn cells(line: &str) -> Vec<&str> {
    let separator = [',', ';', '\t'].into_iter().find(|separator| line.contains(*separator));
    match separator {
        Some(separator) => line.split(separator).map(str::trim).collect(),
        None => line.split_whitespace().collect(),
    }
}

/// Whether a cell begins as a number, with a digit, a sign or a point.
fn begins_number(cell: &str) -> bool {
    cell.trim_matches('"').starts_with(|first: char| first.is_ascii_digit() || "+-.".contains(first))
}

/// A finite number.
fn finite(cell: &str) -> Option<f64> {
    cell.trim_matches('"').parse().ok().filter(|number: &f64| number.is_finite())
}
