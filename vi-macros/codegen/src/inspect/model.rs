//! The continuous system: its declarations, and L and f with all names resolved.
//!
//! In: a derived system. Out: sections of an explanation.

use super::explanation::{Line, Section};
use super::name;
use crate::Derived;
use crate::discrete::continuous::TimeScale;
use crate::findings::{Block, Elimination};
use crate::limits::bounded;
use crate::model::legendre::transform;
use crate::model::{Coordinate, Model, Parameter, Rule};
use crate::symbol::{Symbol, Variable};

/// Characters of a Hamiltonian that is not shown.
const LONGEST: usize = 1000;

/// The heading of the sections for a further rule.
pub(super) fn further_rule(name: &str) -> Section {
    let rule = Line::words(format!("rule {name}"));
    Section { title: "The same system with another rule", lines: vec![rule] }
}

/// The name of the system's rule.
pub(super) fn title(model: &Model) -> &'static str {
    model.rule.as_ref().map_or("none", Rule::title)
}

/// The names that a system declares, the first and the last entry of each array, and its rule.
pub(super) fn declarations(model: &Model) -> Section {
    let arrays = model.coordinates.chunk_by(|left, right| left.name == right.name);
    let coordinates: Vec<String> = arrays.clone().map(|array| ends(array.iter().map(Coordinate::text))).collect();
    let symbol = |of: &Coordinate| format!("`{}`", name::coordinate(of).text());
    let in_latex: Vec<String> = arrays.map(|array| ends(array.iter().map(symbol))).collect();
    let mut lines = vec![Line::Words {
        text: format!("coordinates {}", coordinates.join(", ")),
        latex: format!("Coordinates {}", in_latex.join(", ")),
    }];
    lines.extend(model.fields().map(|field| parameter(model, field)));
    if model.constraints.is_empty() {
        lines.push(Line::words(format!("rule {}", title(model))));
    }
    Section { title: "System", lines }
}

/// The first and the last of several names, or all of at most two.
fn ends(names: impl Iterator<Item = String>) -> String {
    let names: Vec<String> = names.collect();
    match &names[..] {
        [first, _, .., last] => format!("{first} to {last}"),
        _ => names.join(", "),
    }
}

/// A parameter, or the entries of an array.
fn parameter(model: &Model, field: &[Parameter]) -> Line {
    let is_input = field.first().is_some_and(|of| of.is_input);
    let [word, title] = if is_input { ["input", "Input"] } else { ["parameter", "Parameter"] };
    let symbol = |of: &Parameter| {
        let index = model.parameters.iter().position(|known| core::ptr::eq(known, of)).unwrap_or(0);
        name::of_model(model, &of.symbol(index)).map_or_else(String::new, |name| format!("`{}`", name.text()))
    };
    let defaults: Vec<String> = field.iter().map(Parameter::default_text).collect();
    let in_latex: Vec<String> = defaults.iter().map(|default| format!("`{default}`")).collect();
    let (names, symbols) = (ends(field.iter().map(Parameter::text)), ends(field.iter().map(symbol)));
    Line::Words {
        text: format!("{word} {names} = {}", each(&defaults)),
        latex: format!("{title} {symbols}, by default {}", each(&in_latex)),
    }
}

/// The values of an array, or the one that all entries have.
fn each(values: &[String]) -> String {
    match values {
        [first, others @ ..] if !others.is_empty() && others.iter().all(|other| other == first) => {
            format!("each {first}")
        }
        _ => values.join(", "),
    }
}

/// Names, L and f.
pub(super) fn sections(derived: &Derived) -> Vec<Section> {
    let model = &derived.model;
    let of = &derived.system.continuous;
    let mut functions = vec![Line::equation(derived, ("L", "L"), of.lagrangian)];
    if model.forced {
        functions.extend(Line::equations(derived, ("f", "f"), &of.force));
    }
    functions.extend(Line::equations(derived, ("p", "p"), &of.momentum));
    functions.push(Line::equation(derived, ("E", "E"), of.energy));
    let hamiltonian = hamiltonian(derived);
    let has_hamiltonian = hamiltonian.is_some();
    functions.extend(hamiltonian);
    let has_rule = derived.system.by_rule.is_some();
    if has_rule {
        functions.push(Line::equation(derived, ("D", "D"), of.step_density));
    }
    let title = match (has_hamiltonian, has_rule) {
        (false, false) => "Lagrangian L, force f, momentum p, energy E",
        (true, false) => "Lagrangian L, force f, momentum p, energy E, Hamiltonian H",
        (false, true) => "Lagrangian L, force f, momentum p, energy E, step density D",
        (true, true) => "Lagrangian L, force f, momentum p, energy E, Hamiltonian H, step density D",
    };
    let mut sections = vec![declarations(model), Section { title, lines: functions }];
    sections.extend(constraints(derived));
    if let Some(TimeScale { g, g_dq, g_dt }) = &of.time_scale {
        let mut lines = vec![Line::equation(derived, ("g", "g"), *g)];
        lines.extend(Line::equations(derived, ("(∂g/∂q)", "(\\partial g/\\partial q)"), g_dq));
        lines.push(Line::equation(derived, ("∂g/∂t", "\\partial g/\\partial t"), *g_dt));
        sections.push(Section { title: "Time scale g, dt = g dτ", lines });
    }
    sections.extend(super::functions::sections(model));
    sections
}

/// H(t, q, p), if it has a closed form that is not long.
fn hamiltonian(derived: &Derived) -> Option<Line> {
    let mut pool = derived.pool.clone();
    let model = &derived.model;
    let variables: [fn(usize) -> Symbol; 2] = [|index| Symbol::Continuous(Variable::Velocity(index)), Symbol::Momentum];
    let dimension = model.dimension();
    let hamiltonian = transform(&mut pool, model.lagrangian, variables, &model.parameters, dimension)?;
    bounded(&pool).ok()?;
    let text = pool.render_within(LONGEST, hamiltonian, &|symbol| model.spell(symbol));
    (text.chars().count() < LONGEST).then(|| Line::equation_in(derived, &pool, ("H", "H"), hamiltonian))
}

/// g of the constraints on positions; A and a of all of them.
fn constraints(derived: &Derived) -> Vec<Section> {
    let Some(of) = &derived.system.constraints else { return Vec::new() };
    let mut positions = Vec::new();
    let mut velocities = Vec::new();
    for (index, constraint) in derived.model.constraints.iter().enumerate() {
        let (text, latex) = (constraint.text(), name::constraint(constraint));
        let named = |letter: &str| (format!("{letter}_{text}"), name::indexed(letter, &[&latex]));
        if constraint.is_holonomic {
            let (left, left_latex) = named("g");
            positions.push(Line::equation(derived, (&left, &left_latex), of.values[index]));
        }
        for (entry, coordinate) in of.gradients[index].iter().zip(&derived.model.coordinates) {
            if !derived.pool.is_zero(*entry) {
                let left = format!("A_{text},{}", coordinate.text());
                let left_latex = name::indexed("A", &[&latex, &name::coordinate(coordinate).text()]);
                velocities.push(Line::equation(derived, (&left, &left_latex), *entry));
            }
        }
        if !derived.pool.is_zero(of.rates[index]) {
            let (left, left_latex) = named("a");
            velocities.push(Line::equation(derived, (&left, &left_latex), of.rates[index]));
        }
    }
    let mut sections = Vec::new();
    if !positions.is_empty() {
        sections.push(Section { title: "Constraints on positions, g = 0", lines: positions });
    }
    let title = "Constraints on velocities, A v + a = 0; the reaction is A^T times the multipliers";
    sections.push(Section { title, lines: velocities });
    sections.extend(derived.findings.elimination.as_ref().map(|of| elimination(derived, of)));
    sections
}

/// The blocks of coordinates and multipliers λ, in the order of their elimination.
fn elimination(derived: &Derived, of: &Elimination) -> Section {
    let Derived { model, .. } = derived;
    let name = |unknown: &usize, is_latex: bool| match unknown.checked_sub(model.dimension()) {
        None if is_latex => name::coordinate(&model.coordinates[*unknown]).text(),
        None => model.coordinates[*unknown].text(),
        Some(r) if is_latex => name::indexed("\\lambda", &[&name::constraint(&model.constraints[r])]),
        Some(r) => format!("λ_{}", model.constraints[r].text()),
    };
    let block = |Block { own, border }: &Block| {
        let words = |is_latex: bool| {
            let list = |unknowns: &[usize]| {
                let names: Vec<String> = unknowns.iter().map(|unknown| name(unknown, is_latex)).collect();
                if is_latex { format!("`{}`", names.join(", ")) } else { names.join(", ") }
            };
            if border.is_empty() { list(own) } else { format!("{}; coupled to {}", list(own), list(border)) }
        };
        Line::Words { text: words(false), latex: words(true) }
    };
    Section { title: "Order of elimination, block by block", lines: of.blocks.iter().map(block).collect() }
}
