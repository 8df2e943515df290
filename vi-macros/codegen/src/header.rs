//! The header of an expansion file: L, and the operation counts of the functions, method by method.
//!
//! In: a system under each of its rules, or a large system in loops. Out: comment lines. The documentation of the
//! struct lists the findings; [`documentation`] returns those of a large system.

use crate::indexed::{Body, Indexed, Nest, Part, Read, Recursion, Sum, Value};
use crate::model::{Coordinate, Model};
use crate::program::{Function, FunctionId};
use crate::symbol::{LetEntry, Symbol, Variable};
use crate::{Derivations, Derived, Loops};
use vi_expr::Pool;

/// Characters of L that are shown.
const CHARACTERS: usize = 400;

/// Characters of the expression of a loop that are shown.
const BODY: usize = 160;

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

/// The methods of systems with constraints, and the functions that it calls.
const OF_CONSTRAINTS: (&str, &[FunctionId]) = (
    "GaussLobatto, EnergyPreservingGaussLobatto",
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

/// What the values of a body are.
#[derive(Clone, Copy)]
pub(crate) enum Quantity<'a> {
    /// Entries of these arrays of `let`s, or their rates.
    Entries(&'a [Read]),
    /// Terms of L.
    Lagrangian,
    /// Terms of components of f.
    Force,
}

/// A body with the name of its function and its loops.
pub(crate) struct NamedBody<'a> {
    /// The name of the emitted function.
    pub(crate) name: String,
    pub(crate) quantity: Quantity<'a>,
    pub(crate) body: &'a Body,
    pub(crate) nests: &'a [Nest],
    /// The first of its columns: the entries or the component that a row computes, then what it reads.
    pub(crate) first: usize,
}

/// All bodies of a large system, in the order of emission.
pub(crate) fn named(of: &Indexed) -> Vec<NamedBody<'_>> {
    let mut named = Vec::new();
    for (place, Recursion { parts, nest }) in of.recursions.iter().enumerate() {
        let name = |index: usize| {
            let recursion = format!("row_{}", place + 1);
            if parts.len() == 1 { recursion } else { format!("{recursion}_{}", index + 1) }
        };
        named.extend(parts.iter().enumerate().map(|(index, Part { body, of, first })| NamedBody {
            name: name(index),
            quantity: Quantity::Entries(of),
            body,
            nests: core::slice::from_ref(nest),
            first: *first,
        }));
    }
    let sums = [("lagrangian", Quantity::Lagrangian, &of.lagrangian), ("force", Quantity::Force, &of.force)];
    for (name, quantity, sums) in sums {
        named.extend(sums.iter().enumerate().map(|(index, Sum { body, nests })| {
            let name = format!("{name}_{}", index + 1);
            NamedBody { name, quantity, body, nests, first: 0 }
        }));
    }
    named
}

impl NamedBody<'_> {
    /// Number of rows in all loops.
    pub(crate) fn rows(&self) -> usize {
        self.nests.iter().map(Nest::rows).sum()
    }

    /// The arrays of the numbers that a row computes, by column: entries, or the component of a force.
    pub(crate) fn computed(&self) -> &[Read] {
        match self.quantity {
            Quantity::Entries(of) => of,
            Quantity::Lagrangian => &[],
            Quantity::Force => &[Read::Coordinate],
        }
    }

    /// The arrays of the columns of a row, from the first one on.
    pub(crate) fn columns(&self) -> impl Iterator<Item = (usize, Read)> {
        (self.first..).zip(self.computed().iter().chain(&self.body.reads).copied())
    }

    /// Operations of a row for its values and first derivatives.
    pub(crate) fn first_operations(&self) -> usize {
        self.body.slopes.operation_count()
    }

    /// Operations of a row for first and second derivatives; `-` for a force, which needs no second ones.
    pub(crate) fn second_operations(&self) -> String {
        let count = self.body.curvatures.as_ref().map(Function::operation_count);
        count.map_or_else(|| "-".to_owned(), |count| count.to_string())
    }

    /// The first row in the user's names: `x[1] = x[0] + l*cos(q[1])`.
    pub(crate) fn first_row(&self, pool: &Pool<Symbol>, model: &Model) -> String {
        let mut row: Option<Vec<usize>> = None;
        if let Some(nest) = self.nests.first() {
            nest.each(&mut |columns| {
                row.get_or_insert_with(|| columns.to_vec());
            });
        }
        let row = row.unwrap_or_default();
        let names: Vec<String> = self.columns().map(|(column, read)| spell(model, read, row[column])).collect();
        let (computed, reads) = names.split_at(self.computed().len());
        let value = |value: &Value| {
            pool.render_within(BODY, value.expr, &|symbol| match symbol {
                Symbol::Access(place) => reads[*place].clone(),
                _ => model.spell(symbol),
            })
        };
        let values = self.body.values.iter().map(value);
        match self.quantity {
            Quantity::Lagrangian => format!("term of L: {}", values.collect::<String>()),
            Quantity::Force => format!("term of f_{}: {}", computed.concat(), values.collect::<String>()),
            Quantity::Entries(_) => {
                let entries = computed.iter().zip(values).map(|(entry, value)| format!("{entry} = {value}"));
                entries.collect::<Vec<_>>().join("; ")
            }
        }
    }
}

/// A number that a row reads, in the user's names.
fn spell(model: &Model, read: Read, column: usize) -> String {
    match read {
        Read::Coordinate => model.spell(&Symbol::Continuous(Variable::Coordinate(column))),
        Read::Velocity => model.spell(&Symbol::Continuous(Variable::Velocity(column))),
        Read::Let(array) => model.spell(&Symbol::Let(LetEntry { array, entry: column })),
        Read::LetRate(array) => model.spell(&Symbol::LetRate(LetEntry { array, entry: column })),
        Read::Parameter(first) => model.spell(&Symbol::Parameter { index: first + column, array: Some(first) }),
        Read::Number => column.to_string(),
    }
}

/// The properties of a large system that the generator found, one per line, with formulas between backticks: for the
/// documentation of the struct.
#[must_use]
pub fn documentation(of: &Indexed) -> Vec<String> {
    properties(of, &|coordinate| format!("`{}`", coordinate.text()))
}

/// The same; `name` names a coordinate.
pub(crate) fn properties(of: &Indexed, name: &dyn Fn(&Coordinate) -> String) -> Vec<String> {
    let model = &of.model;
    let mut lines = vec![
        match (of.autonomous, model.forced) {
            (true, false) => "Autonomous and without a force: the energy is conserved",
            (true, true) => "Autonomous; a force acts",
            (false, false) => "Not autonomous: `L` depends on the time `t`; no force acts",
            (false, true) => "Not autonomous: `L` or `f` depends on the time `t`; a force acts",
        }
        .to_owned(),
    ];
    let cyclic: Vec<usize> = (0..model.dimension()).filter(|index| of.cyclic[*index]).collect();
    if !cyclic.is_empty() {
        let momenta = if cyclic.len() == 1 { "its momentum is" } else { "their momenta are" };
        lines.push(format!("Cyclic: {}; {momenta} conserved", in_ranges(&model.coordinates, &cyclic, name)));
    }
    lines.push(if of.separable {
        "`L = T(v) + U(t, q)` with a constant diagonal mass matrix; no force depends on the velocity".to_owned()
    } else if of.has_mass_of_position {
        "The mass matrix does not depend on the velocity".to_owned()
    } else {
        "The mass matrix depends on the velocity".to_owned()
    });
    if let Some(smoothness) = &model.smoothness {
        let noun = if smoothness.derivatives == 1 { "derivative" } else { "derivatives" };
        lines.push(format!("`L` has {} continuous {noun} because of {}", smoothness.derivatives, smoothness.cause));
    }
    let loops = |sums: &[Sum]| sums.iter().map(|sum| sum.nests.len()).sum::<usize>();
    let loops = [
        (of.recursions.len(), "over recursions"),
        (loops(&of.lagrangian), "over terms of `L`"),
        (loops(&of.force), "over terms of `f`"),
    ];
    let loops = loops.iter().filter(|(count, _)| *count > 0).map(|(count, over)| format!("{count} {over}"));
    let (loops, functions) = (loops.collect::<Vec<_>>().join(", "), named(of).len());
    let noun = if functions == 1 { "function" } else { "functions" };
    lines.push(format!("Loops: {loops}; {functions} {noun} of one row"));
    if model.rule.is_some() {
        lines.push("`A` is dense; solved by elimination with pivoting".to_owned());
    }
    lines
}

/// The names of coordinates, neighbors in an array as `q[0]` to `q[39]`.
fn in_ranges(coordinates: &[Coordinate], indices: &[usize], name: &dyn Fn(&Coordinate) -> String) -> String {
    let follows =
        |left: &usize, right: &usize| left + 1 == *right && coordinates[*left].name == coordinates[*right].name;
    let range = |of: &[usize]| match of {
        [first, .., last] if of.len() > 2 => format!("{} to {}", name(&coordinates[*first]), name(&coordinates[*last])),
        _ => of.iter().map(|index| name(&coordinates[*index])).collect::<Vec<_>>().join(", "),
    };
    indices.chunk_by(follows).map(range).collect::<Vec<_>>().join(", ")
}
