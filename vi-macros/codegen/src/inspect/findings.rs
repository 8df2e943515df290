//! Findings of the generator, and the cost of each function.
//!
//! In: a derived system. Out: sections of an explanation.

use super::explanation::{Line, Section};
use super::name;
use crate::Derived;
use crate::findings::Findings;
use crate::program::Function;

/// Findings and operation counts.
pub(super) fn sections(derived: &Derived) -> Vec<Section> {
    vec![found(derived, Findings::lines), operations(derived.program.functions())]
}

/// Findings about the steps, and operation counts of the functions that depend on the rule.
pub(super) fn of_steps(derived: &Derived) -> Vec<Section> {
    vec![found(derived, Findings::of_steps), operations(derived.program.by_rule())]
}

/// Findings in words with the names of the coordinates.
fn found(derived: &Derived, lines: impl Fn(&Findings, &dyn Fn(usize) -> String) -> Vec<String>) -> Section {
    let Derived { model, findings, .. } = derived;
    let coordinate = |index: usize| model.coordinates.get(index);
    let text = lines(findings, &|index| coordinate(index).map_or_else(String::new, |of| format!("`{}`", of.text())));
    let latex = lines(findings, &|index| {
        coordinate(index).map_or_else(String::new, |of| format!("`{}`", name::coordinate(of).text()))
    });
    let lines = text.into_iter().zip(latex).map(|(text, latex)| Line::Words { text, latex }).collect();
    Section { title: "Properties found by the generator", lines }
}

/// The operation count of each function.
fn operations<'a>(functions: impl Iterator<Item = &'a Function> + Clone) -> Section {
    let width = functions.clone().map(|function| function.id.name().len()).max().unwrap_or(0);
    let costs = functions.map(|function| {
        let (name, count) = (function.id.name(), function.operation_count());
        Line::Words { text: format!("{name:width$} {count:6}"), latex: format!("{name}: {count}") }
    });
    Section { title: "Operations of each function", lines: costs.collect() }
}
