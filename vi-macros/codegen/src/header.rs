//! The header of an expansion file: L, and the operation counts of the functions, method by method.
//!
//! In: a system under each of its rules, or a large system in loops. Out: comment lines. The documentation of the
//! struct lists the findings.

use crate::indexed::named;
use crate::program::{Function, FunctionId, Methods};
use crate::{Derivations, Derived, Loops};

/// Characters of L that are shown.
const CHARACTERS: usize = 400;

/// The methods of all systems.
const OF_MOTION: [(&str, Methods); 3] = [
    ("every method", Methods::Every),
    ("Gauss, EnergyPreservingGauss", Methods::Gauss),
    ("Gauss in transformed time", Methods::Transformed),
];

/// The methods of a rule.
const OF_RULE: [(&str, Methods); 3] = [
    ("FixedStep, Composition, Ensemble", Methods::Fixed),
    ("EnergyPreserving", Methods::EnergyPreserving),
    ("DiscreteLagrangian", Methods::Slots),
];

/// The header of the expansion of a system.
pub(crate) fn header(derivations: &Derivations) -> String {
    let own = &derivations.own;
    let lagrangian =
        own.pool.render_within(CHARACTERS, own.system.continuous.lagrangian, &|symbol| own.model.spell(symbol));
    let mut lines =
        vec![format!("`{}`: L = {lagrangian}", own.model.name), String::new(), "Operation counts by method".to_owned()];
    lines.extend(OF_MOTION.iter().filter_map(|of| called(own, "", *of)));
    if own.system.constraints.is_some() {
        return commented(lines);
    }
    if own.findings.force_of_position {
        lines.extend(counted("Splitting, for each force", own.program.function(FunctionId::Point)));
    }
    for derived in derivations.all() {
        let Some(rule) = &derived.model.rule else { continue };
        let by = format!(" by the rule `{}`", rule.title());
        lines.extend(OF_RULE.iter().filter_map(|of| called(derived, &by, *of)));
    }
    if own.system.by_rule.is_none() {
        lines.push(
            "     0  FixedStep, Composition, Ensemble, EnergyPreserving: write `discretize midpoint;` for them"
                .to_owned(),
        );
    }
    commented(lines)
}

/// The lines as comments, with an empty line after them.
fn commented(lines: Vec<String>) -> String {
    let comment = |line: String| if line.is_empty() { "//\n".to_owned() } else { format!("// {line}\n") };
    lines.into_iter().map(comment).chain(["\n".to_owned()]).collect()
}

/// The line of methods, by this rule, with the functions that they call.
fn called(derived: &Derived, by: &str, (title, methods): (&str, Methods)) -> Option<String> {
    let functions = derived.program.functions().filter(|function| function.id.methods() == methods);
    counted(&format!("{title}{by}"), functions)
}

/// Operation counts of functions, in total and one by one; nothing for no function.
fn counted<'a>(title: &str, functions: impl IntoIterator<Item = &'a Function>) -> Option<String> {
    let mut functions: Vec<_> = functions.into_iter().map(|of| (of.id, of.operation_count())).collect();
    functions.sort_unstable();
    let all: usize = functions.iter().map(|(_, count)| count).sum();
    let each: Vec<_> = functions.iter().map(|(id, count)| format!("{} {count}", id.name())).collect();
    (!functions.is_empty()).then(|| format!("{all:6}  {title}: {}", each.join(", ")))
}

/// The header of the expansion of a large system.
pub(crate) fn of_loops(of: &Loops) -> String {
    let Loops { pool, indexed } = of;
    let model = &indexed.model;
    let lagrangian = pool.render_within(CHARACTERS, model.lagrangian, &|symbol| model.spell(symbol));
    let mut lines = vec![
        format!("`{}`: L = {lagrangian}", model.name),
        String::new(),
        "Functions in loops: rows, operations of a row for first and for second derivatives, and the first row"
            .to_owned(),
    ];
    let named = named(indexed);
    let width = named.iter().map(|of| of.name.len()).max().unwrap_or(0);
    lines.extend(named.iter().map(|of| {
        let (rows, name, row) = (of.rows(), &of.name, of.first_row(pool, model));
        let (first, second) = (of.first_operations(), of.second_operations());
        format!("{rows:6} {first:5} {second:>5}  {name:width$}  {row}")
    }));
    commented(lines)
}
