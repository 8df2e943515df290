//! The header of an expansion file: L, and the operation counts of the functions, method by method.
//!
//! In: a system under each of its rules, or a large system in loops. Out: comment lines. The documentation of the
//! struct lists the findings.

use crate::indexed::named;
use crate::program::{Function, FunctionId};
use crate::{Derivations, Derived, Loops};

/// Characters of L that are shown.
const CHARACTERS: usize = 400;

/// The methods of all systems with the functions that they call.
const OF_MOTION: [(&str, &[FunctionId]); 3] = [
    (
        "every method",
        &[
            FunctionId::Lagrangian,
            FunctionId::Energy,
            FunctionId::Momentum,
            FunctionId::Force,
            FunctionId::Acceleration,
            FunctionId::NonFinite,
            FunctionId::Undefined,
        ],
    ),
    ("Gauss, EnergyPreservingGauss", &[FunctionId::Point, FunctionId::PointDerivatives, FunctionId::Power]),
    ("Gauss in transformed time", &[FunctionId::ScaledPoint]),
];

/// The method of systems whose motion splits into kicks and drifts, and the function that it calls.
const OF_SPLITTING: (&str, &[FunctionId]) = ("Splitting, for each force", &[FunctionId::Point]);

/// The method of systems with constraints, and the functions that it calls.
const OF_CONSTRAINTS: (&str, &[FunctionId]) = (
    "Gauss, EnergyPreservingGauss",
    &[
        FunctionId::Point,
        FunctionId::PointDerivatives,
        FunctionId::Power,
        FunctionId::Applied,
        FunctionId::Constraints,
        FunctionId::ConstraintGradients,
        FunctionId::ConstraintRateDerivatives,
        FunctionId::ReactionDerivatives,
    ],
);

/// The methods of a rule with the functions that they call.
const OF_RULE: [(&str, &[FunctionId]); 3] = [
    (
        "FixedStep, Composition, Ensemble",
        &[
            FunctionId::MomentumEquation,
            FunctionId::MomentumResidual,
            FunctionId::MomentumDerivatives,
            FunctionId::DiscreteEnergy,
        ],
    ),
    (
        "EnergyPreserving",
        &[
            FunctionId::StepDensity,
            FunctionId::ExtendedSystem,
            FunctionId::ExtendedResidual,
            FunctionId::ExtendedDerivatives,
        ],
    ),
    (
        "DiscreteLagrangian",
        &[
            FunctionId::Ld,
            FunctionId::D1Ld,
            FunctionId::D2Ld,
            FunctionId::D3Ld,
            FunctionId::D4Ld,
            FunctionId::FdMinus,
            FunctionId::FdPlus,
            FunctionId::GdMinus,
            FunctionId::GdPlus,
        ],
    ),
];

/// The header of the expansion of a system.
pub(crate) fn header(derivations: &Derivations) -> String {
    let own = &derivations.own;
    let lagrangian =
        own.pool.render_within(CHARACTERS, own.system.continuous.lagrangian, &|symbol| own.model.spell(symbol));
    let mut lines =
        vec![format!("`{}`: L = {lagrangian}", own.model.name), String::new(), "Operation counts by method".to_owned()];
    if own.system.constraints.is_some() {
        let [every, ..] = OF_MOTION;
        lines.extend([every, OF_CONSTRAINTS].into_iter().filter_map(|of| counted(own, "", of)));
        return commented(lines);
    }
    lines.extend(OF_MOTION.iter().filter_map(|of| counted(own, "", *of)));
    if own.findings.force_of_position {
        lines.extend(counted(own, "", OF_SPLITTING));
    }
    for derived in derivations.all() {
        let Some(rule) = &derived.model.rule else { continue };
        let by = format!(" by the rule `{}`", rule.title());
        lines.extend(OF_RULE.iter().filter_map(|of| counted(derived, &by, *of)));
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

/// Operation counts of these functions, in total and one by one; empty if the system has none of them.
fn counted(derived: &Derived, by: &str, (methods, ids): (&str, &[FunctionId])) -> Option<String> {
    let functions: Vec<&Function> = ids.iter().filter_map(|id| derived.program.function(*id)).collect();
    let all: usize = functions.iter().map(|function| function.operation_count()).sum();
    let each = functions.iter().map(|function| format!("{} {}", function.id.name(), function.operation_count()));
    let each = each.collect::<Vec<_>>().join(", ");
    (!functions.is_empty()).then(|| format!("{all:6}  {methods}{by}: {each}"))
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
