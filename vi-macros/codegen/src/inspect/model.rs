//! The continuous system: its declarations, and L and f with all names resolved.
//!
//! In: a derived system. Out: sections of an explanation.

use super::explanation::{Line, Section};
use super::name;
use crate::Derived;
use crate::discrete::TimeScale;
use crate::model::{Coordinate, Model, Rule};

/// The heading of the sections for a further rule.
pub(super) fn further_rule(derived: &Derived) -> Section {
    let rule = Line::words(format!("rule {}", title(&derived.model)));
    Section { title: "The same system with another rule", lines: vec![rule] }
}

/// The name of the system's rule.
pub(super) fn title(model: &Model) -> &'static str {
    model.rule.as_ref().map_or("none", Rule::title)
}

/// Names, L and f.
pub(super) fn sections(derived: &Derived) -> Vec<Section> {
    let model = &derived.model;
    let coordinates: Vec<String> = model.coordinates.iter().map(Coordinate::text).collect();
    let in_latex: Vec<String> = model.coordinates.iter().map(|of| name::coordinate(of).text()).collect();
    let mut lines = vec![Line::Words {
        text: format!("coordinates {}", coordinates.join(", ")),
        latex: format!("Coordinates `{}`", in_latex.join(", ")),
    }];
    for (index, parameter) in model.parameters.iter().enumerate() {
        let symbol = name::latex(derived, &parameter.symbol(index));
        let [word, title] = if parameter.is_input { ["input", "Input"] } else { ["parameter", "Parameter"] };
        lines.push(Line::Words {
            text: format!("{word} {} = {}", parameter.text(), parameter.default_text()),
            latex: format!("{title} `{symbol}`, by default `{}`", parameter.default_text()),
        });
    }
    lines.push(Line::words(format!("rule {}", title(model))));
    let of = &derived.system.continuous;
    let mut functions = vec![Line::equation(derived, ("L", "L"), of.lagrangian)];
    if model.forced {
        functions.extend(Line::equations(derived, ("f", "f"), &of.force));
    }
    functions.extend(Line::equations(derived, ("p", "p"), &of.momentum));
    functions.push(Line::equation(derived, ("E", "E"), of.energy));
    let mut title = "Lagrangian L, force f, momentum p, energy E";
    if derived.system.by_rule.is_some() {
        functions.push(Line::equation(derived, ("D", "D"), of.step_density));
        title = "Lagrangian L, force f, momentum p, energy E, step density D";
    }
    let mut sections = vec![Section { title: "System", lines }, Section { title, lines: functions }];
    if let Some(TimeScale { g, g_dq, g_dt }) = &of.time_scale {
        let mut lines = vec![Line::equation(derived, ("g", "g"), *g)];
        lines.extend(Line::equations(derived, ("(∂g/∂q)", "(\\partial g/\\partial q)"), g_dq));
        lines.push(Line::equation(derived, ("∂g/∂t", "\\partial g/\\partial t"), *g_dt));
        sections.push(Section { title: "Time scale g, dt = g dτ", lines });
    }
    sections.extend(super::functions::sections(derived));
    sections
}
