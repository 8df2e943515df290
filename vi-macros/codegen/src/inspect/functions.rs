//! Rust functions and tables in an explanation: what they are, and the values of a table as bars.

use super::explanation::{Line, Section};
use crate::model::{Function, FunctionKind, Model, Table, Values};
use quote::ToTokens;

/// Maximum number of places of a table that are shown.
const SHOWN: usize = 24;
/// Length of the longest bar.
const BAR: f64 = 30.0;

/// The functions of a system; none for a system without them.
pub(super) fn sections(model: &Model) -> Vec<Section> {
    let lines: Vec<Line> = model.functions.iter().flat_map(of_function).collect();
    if lines.is_empty() { Vec::new() } else { vec![Section { title: "Functions and tables", lines }] }
}

fn of_function(function: &Function) -> Vec<Line> {
    let call = format!("{}({})", function.name, function.arguments.join(", "));
    match &function.kind {
        FunctionKind::Rust(path) => {
            vec![Line::words(format!("{call} = {}", path.to_token_stream().to_string().replace(' ', "")))]
        }
        FunctionKind::Table(table) => of_table(&call, table),
    }
}

fn of_table(call: &str, table: &Table) -> Vec<Line> {
    let outside = match table.outside.name() {
        Some(word) => word.to_owned(),
        None => "no value outside".to_owned(),
    };
    let count = match &table.values {
        Values::Points { places, .. } => format!("{} values", places.len()),
        Values::Grid { places: [first, second], .. } => format!("{} × {} values", first.len(), second.len()),
        Values::Parameters { name, count, .. } => format!("the {count} parameters `{name}`"),
    };
    let range = table.ends().map_or_else(String::new, |[from, to]| format!(" from {from} to {to}"));
    let head = Line::words(format!("table {call}: {}, {count}{range}, {outside}", table.kind.name()));
    let bars = match &table.values {
        Values::Points { places, values } => bars(places, values),
        Values::Grid { .. } | Values::Parameters { .. } => Vec::new(),
    };
    [head].into_iter().chain(bars).collect()
}

/// A bar for each place, from the smallest value on; places at equal distances in the list if there are many.
fn bars(places: &[f64], values: &[f64]) -> Vec<Line> {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let step = places.len().div_ceil(SHOWN).max(1);
    let shown = places.iter().zip(values).step_by(step);
    let length = |value: f64| if high > low { (BAR * ((value - low) / (high - low))).round() } else { 0.0 };
    let line = |(place, value): (&f64, &f64)| {
        let bar: String = (0_u8..).take_while(|cell| f64::from(*cell) < length(*value)).map(|_| '█').collect();
        Line::Words {
            text: format!("{place:>12} {value:>12} {bar}").trim_end().to_owned(),
            latex: format!("`{place}` gives `{value}`"),
        }
    };
    shown.map(line).collect()
}
