//! Compilation of the text of a system to its code.
//!
//! In: the text of a `lagrangian!`. Out: a [`Code`]. The stages up to the program are those of the macro. Instead of
//! printing operations, [`instructions`] selects instructions, [`order`] puts equal ones together, and [`registers`]
//! places their results.

mod instructions;
mod order;
mod registers;

use crate::code::{ByRule, Call, Code, Columns, Constraints, Functions, Start, StepFunctions};
use crate::lines::{Entry, Input, Kind, Lines, Source};
use crate::mistakes::Mistakes;
use crate::sizes::size;
use crate::tables::Tables;
use instructions::{Constants, instructions};
use order::in_runs;
use proc_macro2::TokenStream;
use registers::{Placed, placed};
use std::collections::{BTreeMap, HashMap};
use std::path::PathBuf;
use std::sync::OnceLock;
use vi_codegen::findings::{self, CLOSED, Elimination, Pattern};
use vi_codegen::inspect::{report, source};
use vi_codegen::messages::{FirstOrder, Message, error};
use vi_codegen::model::{self, CheckState, Coordinate, Model, Parameter};
use vi_codegen::program::{Function, FunctionId, Operation, OperationId, Output};
use vi_codegen::rules::NamedRule;
use vi_codegen::symbol::{Symbol, Variable};
use vi_codegen::syntax::Discretization;
use vi_codegen::{Derived, derive_own, sizes, syntax};
use vi_core::lagrangian::Space;
use vi_core::linear::{AnyForm, Block};
use vi_dispatch::Instructions;
use vi_expr::{Expr, Node};

/// Characters of an expression in a message.
const CHARACTERS: usize = 400;

/// Parses the text of a file: `struct … { … }`, or the same in a `lagrangian!`. Files of tables have these texts; others
/// are read.
///
/// # Errors
/// The mistakes of the text.
pub(crate) fn parsed(file: &str, text: &str, files: &[(String, String)]) -> Result<Parsed, Mistakes> {
    let unreadable = |error: syn::Error| Mistakes::at(file, text, vec![report::first_unreadable(text, &error)]);
    let tokens = declaration(text).map_err(unreadable)?;
    let tokens = tokens.ok_or_else(|| Mistakes::of(ONE))?;
    let wrong = |error: syn::Error| Mistakes::wrong(file, text, &error);
    syntax::alone::check(&tokens).map_err(wrong)?;
    let mut system = syntax::parse::system(tokens.clone()).map_err(wrong)?;
    system.files = files.iter().map(|(path, text)| (path.into(), text.clone())).collect();
    system.read_files();
    // Parsing bounds the nesting; `to_string` recurses.
    Ok(Parsed { system, definition: tokens.to_string() })
}

/// A system as it is written.
pub(crate) struct Parsed {
    pub(crate) system: syntax::System,
    definition: String,
}

/// Compiles the system of the text of a file.
///
/// # Errors
/// The mistakes of the text, or an item that only the macro compiles.
pub(crate) fn code(file: &str, text: &str, Parsed { mut system, definition }: Parsed) -> Result<Code, Mistakes> {
    let wrong = |error: syn::Error| Mistakes::wrong(file, text, &error);
    let [declared, constraints] = sizes(&system).map_err(wrong)?;
    // The check reports a system without coordinates.
    let name = system.name.to_string();
    let size_of = |count| if count == 0 { Ok(0) } else { size(&name, [count, constraints]) };
    let least = size_of(declared)?;
    let files = system.files.clone();
    let of_rule = system.discretizations.first().map(Discretization::span);
    let rule = system.take_named_rules();
    let derived = derive_own(&system).map_err(wrong)?;
    if let (Some(span), Some(_), false) = (of_rule, rule, derived.model.without_velocity.is_empty()) {
        return Err(wrong(error(span, &Message::FirstOrder { why: FirstOrder::Clause("discretize") })));
    }
    // Momenta may be coordinates.
    let size = if derived.model.dimension() > declared { size_of(derived.model.dimension())? } else { least };
    of_derived(&derived, (definition, files), (size, rule))
}

/// The equations of a step by the rule of a code, whose text is right.
fn by_rule(code: &Code) -> ByRule {
    let derived = code.definition.parse().map_err(Into::into).and_then(syntax::parse::system).and_then(|mut system| {
        system.files.clone_from(&code.files);
        derive_own(&system)
    });
    let found = derived.ok().and_then(|of| steps(&of, &code.tables).ok());
    found.unwrap_or_else(|| ByRule { is_too_large: true, ..ByRule::default() })
}

/// The equations of a step of a derived system; empty without a rule.
fn steps(of: &Derived, tables: &Tables) -> Result<ByRule, TooMany> {
    let Derived { model, program, findings, .. } = of;
    let Some(steps) = &findings.steps else { return Ok(ByRule::default()) };
    Ok(ByRule {
        jacobian: form(&steps.pattern, steps.symmetric, model.dimension()),
        has_constant_jacobian: steps.constant_jacobian(),
        has_closed_form: findings.closed_form(),
        is_inlined: program.has_short_steps(),
        functions: step_functions(of, tables)?,
        is_too_large: false,
    })
}

/// The message about several declarations.
const ONE: &str =
    "error: the text declares several systems\n = help: write one `struct … { … }`, or one `lagrangian! { … }`";

/// The tokens of the only declaration; `None` if there are several.
fn declaration(text: &str) -> syn::Result<Option<TokenStream>> {
    let mut declared = source::declarations(text)?;
    match declared.len() {
        0 => Ok(Some(text.parse()?)),
        1 => Ok(declared.pop()),
        _ => Ok(None),
    }
}

/// The watched expressions as texts.
fn watched(Derived { pool, model, system, .. }: &Derived) -> Box<[&'static str]> {
    let name = |symbol: &Symbol| system.spell(model, symbol);
    let text = |expr: &Expr| &*pool.render_within(CHARACTERS, *expr, &name).leak();
    system.continuous.watched.iter().map(text).collect()
}

/// The code of a system, whose rule has yet to be derived if there is one here.
fn of_derived(
    of: &Derived,
    (definition, files): (String, BTreeMap<PathBuf, String>),
    (size, rule): (usize, Option<&'static NamedRule>),
) -> Result<Code, Mistakes> {
    let Derived { pool, model, system, findings, .. } = of;
    let compiled = |what: &str| Mistakes::compiled(&model.name.to_string(), what);
    let too_many = |of: TooMany| compiled(&format!("too many {of}"));
    let tables = Tables::of(model).ok_or_else(|| compiled("Rust functions"))?;
    let continuous = &system.continuous;
    let inputs = (0..).zip(&model.parameters).filter(|(_, parameter)| parameter.is_input);
    let parameters = names(model, Parameter::text);
    let constraints = constraints(of, size);
    Ok(Code {
        name: model.name.to_string().leak(),
        size,
        about: model.about().leak(),
        definition: definition.leak(),
        files,
        coordinates: model.coordinates.iter().map(|of| &*Coordinate::text(of).leak()).collect(),
        parameters,
        parameters_about: names(model, Parameter::about),
        defaults: model.parameters.iter().map(|of| of.default).collect(),
        inputs: inputs.map(|(index, _)| index).collect::<Vec<_>>().leak(),
        spaces: model.coordinates.iter().map(space).collect(),
        cyclic: continuous.cyclic.clone().into(),
        start: model.check_state.as_ref().map(|state| start(state, parameters)),
        watched: watched(of),
        calls: continuous
            .calls
            .iter()
            .filter_map(|(call, arguments)| called(of, &tables, *call, arguments.len()))
            .collect(),
        digest_of_tables: model.digest_of_tables(),
        monotone_table: model.monotone_table(pool).map(|name| &*name.leak()),
        is_autonomous: findings.autonomous,
        is_forced: findings.forced,
        is_separable: findings.force_of_position && model.constraints.is_empty(),
        splits: findings.force_of_position && model.constraints.is_empty() || findings.canonical_split,
        is_quadratic: continuous.quadratic,
        without_velocity: model.without_velocity.clone().leak(),
        has_constant_mass: findings.constant_mass,
        is_curvilinear: findings.curvilinear,
        scales_time: continuous.time_scale.is_some(),
        has_rule: rule.is_some() || system.by_rule.is_some(),
        has_step_density: rule.map_or(system.has_energy_steps(), |rule| rule.step_density),
        constraints,
        mass: form(&findings.mass, true, model.dimension()),
        point_matrix: form(&findings.point_derivatives, false, model.dimension()),
        functions: functions(of, constraints, &tables).map_err(too_many)?,
        instructions: Instructions::detected(),
        by_rule: if rule.is_some() { OnceLock::new() } else { steps(of, &tables).map_err(too_many)?.into() },
        derive: by_rule,
        tables,
    })
}

/// The call of a table in L or f.
fn called(of: &Derived, tables: &Tables, call: Expr, arguments: usize) -> Option<Call> {
    let Node::Opaque(function, _) = of.pool.node(call) else { return None };
    let text = of.pool.render_within(CHARACTERS, call, &|symbol| of.system.spell(&of.model, symbol));
    Some(Call { text: text.leak(), table: &tables.all[usize::from(tables.place(&function.name)?)], arguments })
}

/// What a coordinate is.
fn space(of: &Coordinate) -> Space {
    match of.component() {
        Some(component) => Space::Rotation(component),
        None if of.space == model::Space::Circle => Space::Circle,
        None => Space::Line,
    }
}

/// The state of the checks, for these parameters.
fn start(state: &CheckState, parameters: &[&'static str]) -> Start {
    let set = state.parameters.iter().map(|(index, value)| (parameters[*index], *value));
    Start { t: state.t, q: state.q.clone(), v: state.v.clone(), h: state.h, parameters: set.collect() }
}

/// The text that `of` returns for each parameter.
fn names(model: &Model, of: impl Fn(&Parameter) -> String) -> &'static [&'static str] {
    model.parameters.iter().map(|parameter| &*of(parameter).leak()).collect::<Vec<_>>().leak()
}

/// The constraints of a system of this size, if it has any.
fn constraints(of: &Derived, size: usize) -> Option<Constraints> {
    let Derived { model, findings, .. } = of;
    let Elimination { gradients, rates_dq, reaction_dq, blocks, .. } = findings.elimination.as_ref()?;
    let declared = model.dimension();
    let names = model.constraints.iter().map(|constraint| &*constraint.text().leak()).collect::<Vec<_>>();
    // Multipliers follow all coordinates.
    let unknowns = |of: &[usize]| -> &'static [usize] {
        let moved = |unknown: &usize| if *unknown < declared { *unknown } else { *unknown + (size - declared) };
        of.iter().map(moved).collect::<Vec<_>>().leak()
    };
    let block = |of: &findings::Block| Block { own: unknowns(&of.own), border: unknowns(&of.border) };
    let at_rest = (declared..size).map(|coordinate| Block { own: vec![coordinate].leak(), border: &[] });
    let blocks: Vec<Block> = blocks.iter().map(block).chain(at_rest).collect();
    Some(Constraints {
        names: names.leak(),
        holonomic: model.constraints.iter().filter(|constraint| constraint.is_holonomic).count(),
        has_point_masses: findings.point_masses,
        // One block is the elimination of a dense matrix.
        blocks: if blocks.len() > 1 { blocks.leak() } else { &[] },
        mass: leaked(&columns(&findings.mass, declared, size)),
        point_matrix: leaked(&columns(&findings.point_derivatives, declared, size)),
        gradients: leaked(gradients),
        rate_derivatives: leaked(rates_dq),
        reaction_derivatives: leaked(reaction_dq),
    })
}

/// The columns of the nonzeros of each row of a square matrix with this pattern; the diagonal for coordinates at rest.
fn columns(pattern: &Pattern, declared: usize, size: usize) -> Vec<Vec<usize>> {
    let block = |row: usize, blocks: &[Vec<usize>]| blocks.iter().find(|of| of.contains(&row)).cloned();
    let of = |row: usize| match pattern {
        Pattern::Diagonal => vec![row],
        Pattern::Blocks(blocks) => block(row, blocks).unwrap_or_default(),
        Pattern::Sparse(columns) => columns.get(row).cloned().unwrap_or_default(),
        _ => (0..declared).collect(),
    };
    (0..declared).map(of).chain((declared..size).map(|row| vec![row])).collect()
}

fn leaked(rows: &[Vec<usize>]) -> Columns {
    rows.iter().map(|columns| &*columns.clone().leak()).collect::<Vec<_>>().leak()
}

/// Replaces the columns of these quantities by their places among the columns of each row.
fn in_places(lines: &mut Lines, quantities: &[usize], columns: Columns) -> Result<(), TooMany> {
    for quantity in quantities {
        for entry in lines.results.get_mut(*quantity).into_iter().flat_map(|of| of.iter_mut()) {
            let place = columns[usize::from(entry.row)].iter().position(|column| *column == usize::from(entry.column));
            entry.column = place.and_then(|place| u16::try_from(place).ok()).ok_or("columns")?;
        }
    }
    Ok(())
}

/// The form of a matrix with this pattern; those of few entries in a row are dense.
fn form(pattern: &Pattern, is_symmetric: bool, size: usize) -> AnyForm {
    match pattern {
        Pattern::Diagonal => AnyForm::Diagonal,
        _ if size <= CLOSED => AnyForm::Dense,
        Pattern::Tridiagonal => AnyForm::Tridiagonal,
        _ if is_symmetric => AnyForm::Symmetric,
        _ => AnyForm::Dense,
    }
}

/// The noun for the items of which a text has too many.
type TooMany = &'static str;

fn functions(of: &Derived, constraints: Option<Constraints>, tables: &Tables) -> Result<Functions, TooMany> {
    use FunctionId as F;
    use Output as O;
    const MASS: [Output; 2] = [O::Mass, O::MassTimesAcceleration];
    const POINT: [Output; 3] = [O::Momentum, O::AppliedForce, O::Mass];
    const SCALED: [Output; 8] =
        [POINT[0], POINT[1], POINT[2], O::Energy, O::Power, O::TimeScale, O::TimeScaleDq, O::TimeScaleDt];
    let lines = |id, outputs: &[Output]| lines(of, id, outputs, tables);
    let value = |id| lines(id, &[O::Value]);
    let mut functions = Functions {
        lagrangian: value(F::Lagrangian)?,
        energy: value(F::Energy)?,
        momentum: value(F::Momentum)?,
        force: value(F::Force)?,
        acceleration: lines(
            F::Acceleration,
            if of.model.without_velocity.is_empty() { &MASS } else { &[O::Structure, O::StructureTimesAcceleration] },
        )?,
        point: lines(F::Point, &POINT)?,
        sides: lines(F::Point, &POINT[..2])?,
        applied_force: lines(F::Point, &POINT[1..2])?,
        point_derivatives: lines(F::PointDerivatives, &[O::MomentumDq, O::Mass, O::ForceDq, O::ForceDv])?,
        power: value(F::Power)?,
        scaled_point: lines(F::ScaledPoint, &SCALED)?,
        non_finite: value(F::NonFinite)?,
        undefined: value(F::Undefined)?,
        applied: value(F::Applied)?,
        constraints: value(F::Constraints)?,
        constraint_gradients: lines(F::ConstraintGradients, &[O::Gradients, O::Rates])?,
        constraint_rate_derivatives: lines(F::ConstraintRateDerivatives, &[O::RatesDq, O::RatesDt])?,
        reaction_derivatives: lines(F::ReactionDerivatives, &[O::ReactionDq])?,
    };
    if let Some(of) = constraints {
        in_places(&mut functions.point, &[2], of.mass)?;
        in_places(&mut functions.point_derivatives, &[0, 1, 2, 3], of.point_matrix)?;
        in_places(&mut functions.scaled_point, &[2], of.mass)?;
        in_places(&mut functions.constraint_gradients, &[0], of.gradients)?;
        in_places(&mut functions.constraint_rate_derivatives, &[0], of.rate_derivatives)?;
        in_places(&mut functions.reaction_derivatives, &[0], of.reaction_derivatives)?;
    }
    Ok(functions)
}

fn step_functions(of: &Derived, tables: &Tables) -> Result<StepFunctions, TooMany> {
    use FunctionId as F;
    use Output as O;
    const MOMENTUM: [Output; 4] = [O::Jacobian, O::ResidualDq, O::MomentumIncrementDq, O::MomentumIncrementDv];
    const SYSTEM: [Output; 6] = [O::Residual, O::Jacobian, O::ResidualDh, O::EnergyResidual, O::EnergyDv, O::EnergyDh];
    const RESIDUAL: [Output; 6] = [
        O::Residual,
        O::RoundingScale,
        O::EnergyResidual,
        O::EnergyRoundingScale,
        O::MomentumIncrement,
        O::EnergyIncrement,
    ];
    const DERIVATIVES: [Output; 12] = [
        MOMENTUM[0],
        MOMENTUM[1],
        MOMENTUM[2],
        MOMENTUM[3],
        O::ResidualDh,
        O::EnergyDq,
        O::EnergyDv,
        O::EnergyDh,
        O::MomentumIncrementDh,
        O::EnergyIncrementDq,
        O::EnergyIncrementDv,
        O::EnergyIncrementDh,
    ];
    let lines = |id, outputs: &[Output]| lines(of, id, outputs, tables);
    let value = |id| lines(id, &[O::Value]);
    Ok(StepFunctions {
        ld: value(F::Ld)?,
        d1_ld: value(F::D1Ld)?,
        d2_ld: value(F::D2Ld)?,
        d3_ld: value(F::D3Ld)?,
        d4_ld: value(F::D4Ld)?,
        fd_minus: value(F::FdMinus)?,
        fd_plus: value(F::FdPlus)?,
        gd_minus: value(F::GdMinus)?,
        gd_plus: value(F::GdPlus)?,
        momentum_equation: lines(F::MomentumEquation, &[O::Residual, O::Jacobian])?,
        momentum_residual: lines(F::MomentumResidual, &[O::Residual, O::RoundingScale, O::MomentumIncrement])?,
        momentum_derivatives: lines(F::MomentumDerivatives, &MOMENTUM)?,
        discrete_energy: value(F::DiscreteEnergy)?,
        step_density: value(F::StepDensity)?,
        extended_system: lines(F::ExtendedSystem, &SYSTEM)?,
        extended_residual: lines(F::ExtendedResidual, &RESIDUAL)?,
        extended_derivatives: lines(F::ExtendedDerivatives, &DERIVATIVES)?,
    })
}

/// The place of an input: the argument and the entry, as the functions of `tape` pass them.
fn place(symbol: &Symbol, of: FunctionId) -> Option<(u8, usize)> {
    let is_of_interval = (FunctionId::Ld..=FunctionId::GdPlus).contains(&of);
    Some(match symbol {
        Symbol::Step if is_of_interval => (0, 2),
        Symbol::Continuous(Variable::Time) | Symbol::T0 => (0, 0),
        Symbol::T1 => (0, 1),
        Symbol::E0 => (0, 2),
        Symbol::Step => (0, 4),
        Symbol::Continuous(Variable::Coordinate(i)) | Symbol::Q0(i) => (1, *i),
        Symbol::Continuous(Variable::Velocity(i)) | Symbol::StepVelocity(i) => (2, *i),
        Symbol::Parameter { index, .. } => (3, *index),
        Symbol::Acceleration(i) | Symbol::Q1(i) | Symbol::Multiplier(i) => (4, *i),
        Symbol::P0(i) => (5, *i),
        Symbol::Low(of) => match &**of {
            Symbol::T0 => (0, 1),
            Symbol::E0 => (0, 3),
            Symbol::Q0(i) => (4, *i),
            Symbol::P0(i) => (6, *i),
            _ => return None,
        },
        _ => return None,
    })
}

/// The instructions for these quantities of a function; none for a function that the system does not have.
fn lines(of: &Derived, id: FunctionId, outputs: &[Output], tables: &Tables) -> Result<Lines, TooMany> {
    let Some(function) = of.program.function(id) else { return Ok(Lines::default()) };
    let operations = &function.operations;
    let results = || outputs.iter().flat_map(|output| function.results.matrix(*output)).flatten();
    let needed = operations.needed(results());
    let mut inputs = Vec::new();
    for id in &needed {
        if let Operation::Input(symbol) = operations.get(*id) {
            let (argument, entry) = place(symbol, function.id).ok_or("kinds of inputs")?;
            inputs.push((argument, u16::try_from(entry).map_err(|_| "inputs")?, *id));
        }
    }
    inputs.sort_unstable();
    let mut constants = Constants::default();
    let all = instructions(function, &needed, results().copied(), &mut constants, tables)?;
    let of_inputs: Vec<OperationId> = inputs.iter().map(|(.., id)| *id).collect();
    let order = in_runs(&all, &of_inputs);
    let Placed { operands, registers, of } = placed(&all, &order, &of_inputs, results().copied())?;
    let mut runs: Vec<(Kind, u16)> = Vec::new();
    for at in &order {
        match runs.last_mut() {
            Some((kind, count)) if *kind == all[*at].kind && *count < u16::MAX => *count += 1,
            _ => runs.push((all[*at].kind, 1)),
        }
    }
    let results = outputs.iter().map(|output| entries(function, *output, &of));
    Ok(Lines {
        results: results.collect::<Result<_, _>>()?,
        inputs: neighbours(inputs.iter().map(|(argument, entry, _)| (*argument, *entry))).into(),
        runs: runs.into(),
        operands: operands.into(),
        constants: constants.into(),
        tables: tables.all,
        registers,
    })
}

/// Inputs in ascending order, neighbouring ones together.
fn neighbours(inputs: impl Iterator<Item = (u8, u16)>) -> Vec<Input> {
    let mut all: Vec<Input> = Vec::new();
    for (argument, from) in inputs {
        match all.last_mut() {
            Some(last) if last.argument == argument && last.from + last.count == from => last.count += 1,
            _ => all.push(Input { argument, from, count: 1 }),
        }
    }
    all
}

/// The entries of a quantity that are not the constant 0.
fn entries(function: &Function, output: Output, of: &HashMap<OperationId, u16>) -> Result<Box<[Entry]>, TooMany> {
    let rows = function.results.matrix(output).iter().enumerate();
    let all = rows.flat_map(|(row, entries)| entries.iter().enumerate().map(move |(column, id)| (row, column, *id)));
    let mut entries = Vec::new();
    for (row, column, id) in all {
        let source = match function.operations.as_constant(id) {
            Some(0.0) => continue,
            Some(value) => Source::Constant(value),
            None => Source::Register(*of.get(&id).ok_or("results")?),
        };
        let [row, column] = [row, column].map(u16::try_from);
        entries.push(Entry { row: row.map_err(|_| "rows")?, column: column.map_err(|_| "columns")?, source });
    }
    Ok(entries.into())
}
