//! What the generator found out, and what each function costs.
//!
//! In: a derived system. Out: sections of an explanation.

use super::explanation::{Line, Section};
use super::name;
use crate::Derived;

/// Findings and operation counts.
pub(super) fn sections(derived: &Derived) -> Vec<Section> {
    let Derived { model, findings, .. } = derived;
    let coordinate = |index: usize| model.coordinates.get(index);
    let text = findings.lines(&|index| coordinate(index).map_or_else(String::new, |of| format!("`{}`", of.text())));
    let latex = findings
        .lines(&|index| coordinate(index).map_or_else(String::new, |of| format!("`{}`", name::coordinate(of).text())));
    let found = text.into_iter().zip(latex).map(|(text, latex)| Line::Words { text, latex }).collect();
    let width = findings.operations.iter().map(|(id, _)| id.name().len()).max().unwrap_or(0);
    let costs = findings.operations.iter().map(|(id, count)| Line::Words {
        text: format!("{:width$} {count:6}", id.name()),
        latex: format!("{}: {count}", id.name()),
    });
    vec![
        Section { title: "What the generator found", lines: found },
        Section { title: "Operations of each function", lines: costs.collect() },
    ]
}
