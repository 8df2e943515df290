//! From the text of a system to its code.
//!
//! In: the text of a `lagrangian!`. Out: a [`Code`]. The stages up to the program are those of the macro; where the
//! macro prints operations, [`instructions`] selects instructions, [`order`] puts equal ones together, and
//! [`registers`] places their results.

mod instructions;
mod order;
mod registers;

use crate::code::{Code, Form, Functions, Start};
use crate::lines::{Entry, Input, Kind, Lines, Source};
use crate::mistakes::Mistakes;
use crate::sizes::size;
use instructions::{Constants, instructions};
use order::in_runs;
use proc_macro2::TokenStream;
use registers::{Placed, placed};
use std::collections::HashMap;
use vi_codegen::findings::{CLOSED, Pattern, StepFindings};
use vi_codegen::inspect::{report, source};
use vi_codegen::model::{CheckState, Coordinate, Model, Parameter};
use vi_codegen::program::{Function, FunctionId, Operation, OperationId, Output};
use vi_codegen::symbol::{Symbol, Variable};
use vi_codegen::{Derived, derive_own, dimension, syntax};
use vi_dispatch::Instructions;

/// Characters of an expression in a message.
const CHARACTERS: usize = 400;

/// Compiles the text of a file: `struct … { … }`, or the same in a `lagrangian!`.
///
/// # Errors
/// The mistakes of the text, or what only the macro compiles.
pub(crate) fn code(file: &str, text: &str) -> Result<Code, Mistakes> {
    let unreadable = |error: syn::Error| Mistakes::of(report::unreadable(file, text, &error));
    let tokens = declaration(text).map_err(unreadable)?;
    let tokens = tokens.ok_or_else(|| Mistakes::of(ONE.to_owned()))?;
    let wrong = |error: syn::Error| Mistakes::of(report::report(file, text, &error));
    syntax::alone::check(&tokens).map_err(wrong)?;
    let system = syntax::parse::system(tokens.clone()).map_err(wrong)?;
    // Parsing bounds the nesting; this recurses.
    let definition = tokens.to_string();
    let declared = dimension(&system).map_err(wrong)?;
    let rest = size(&system.name.to_string(), declared)? - declared;
    let system = if rest == 0 { system } else { system.with_rest(&unused(&definition), rest).map_err(wrong)? };
    of_derived(&derive_own(&system).map_err(wrong)?, definition, declared)
}

/// A name that a definition does not contain.
fn unused(definition: &str) -> String {
    let mut name = "rest".to_owned();
    while definition.contains(&name) {
        name.push('_');
    }
    name
}

/// What to do about several declarations.
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

fn of_derived(of: &Derived, definition: String, declared: usize) -> Result<Code, Mistakes> {
    let Derived { pool, model, system, program, findings } = of;
    let compiled = |what: &str| Mistakes::compiled(&model.name.to_string(), what);
    if !model.constraints.is_empty() {
        let has_rotation = model.coordinates.iter().any(|coordinate| coordinate.is_rotation);
        return Err(compiled(if has_rotation { "a rotation" } else { "constraints" }));
    }
    if !model.functions.is_empty() {
        return Err(compiled("tables"));
    }
    let size = model.dimension();
    let (steps, continuous) = (findings.steps.as_ref(), &system.continuous);
    let jacobian = steps.map_or(Form::Dense, |steps| form(&steps.pattern, steps.symmetric, size));
    let name = |symbol: &Symbol| system.spell(model, symbol);
    let watched = continuous.watched.iter();
    let inputs = (0..).zip(&model.parameters).filter(|(_, parameter)| parameter.is_input);
    let parameters = names(model, Parameter::text);
    Ok(Code {
        name: model.name.to_string().leak(),
        declared,
        about: model.about().leak(),
        definition: definition.leak(),
        coordinates: model.coordinates.iter().map(|of| &*Coordinate::text(of).leak()).collect(),
        parameters,
        parameters_about: names(model, Parameter::about),
        defaults: model.parameters.iter().map(|of| of.default).collect(),
        inputs: inputs.map(|(index, _)| index).collect::<Vec<_>>().leak(),
        angles: model.coordinates.iter().map(|of| of.is_angle).collect(),
        cyclic: continuous.cyclic.clone().into(),
        start: model.check_state.as_ref().map(|state| start(state, parameters, declared)),
        watched: watched.map(|expr| &*pool.render_within(CHARACTERS, *expr, &name).leak()).collect(),
        is_autonomous: findings.autonomous,
        is_forced: findings.forced,
        is_separable: findings.force_of_position,
        is_quadratic: continuous.quadratic,
        has_constant_mass: findings.constant_mass,
        scales_time: continuous.time_scale.is_some(),
        has_rule: system.by_rule.is_some(),
        has_step_density: system.has_energy_steps(),
        has_constant_jacobian: steps.is_some_and(StepFindings::constant_jacobian),
        has_closed_form: findings.closed_form(),
        is_inlined: program.has_short_steps(),
        mass: form(&findings.mass, true, size),
        point_matrix: form(&findings.point_derivatives, false, size),
        jacobian,
        functions: functions(of).map_err(|too_many| compiled(&format!("too many {too_many}")))?,
        instructions: Instructions::detected(),
    })
}

/// The state of the checks, for these parameters and this number of declared coordinates.
fn start(state: &CheckState, parameters: &[&'static str], declared: usize) -> Start {
    let [q, v] = [&state.q, &state.v].map(|of| of[..declared].to_vec());
    let set = state.parameters.iter().map(|(index, value)| (parameters[*index], *value));
    Start { t: state.t, q, v, h: state.h, parameters: set.collect() }
}

/// A text of each parameter.
fn names(model: &Model, of: impl Fn(&Parameter) -> String) -> &'static [&'static str] {
    model.parameters.iter().map(|parameter| &*of(parameter).leak()).collect::<Vec<_>>().leak()
}

/// The form of a matrix with this pattern; those of few entries in a row are dense.
fn form(pattern: &Pattern, is_symmetric: bool, size: usize) -> Form {
    match pattern {
        Pattern::Diagonal => Form::Diagonal,
        _ if size <= CLOSED => Form::Dense,
        Pattern::Tridiagonal => Form::Tridiagonal,
        _ if is_symmetric => Form::Symmetric,
        _ => Form::Dense,
    }
}

/// What a text has too many of.
type TooMany = &'static str;

fn functions(of: &Derived) -> Result<Functions, TooMany> {
    use FunctionId as F;
    use Output as O;
    const POINT: [Output; 3] = [O::Momentum, O::AppliedForce, O::Mass];
    const SCALED: [Output; 8] =
        [POINT[0], POINT[1], POINT[2], O::Energy, O::Power, O::TimeScale, O::TimeScaleDq, O::TimeScaleDt];
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
    let lines = |id: FunctionId, outputs: &[Output]| match of.program.function(id) {
        Some(function) => lines(function, outputs),
        None => Ok(Lines::default()),
    };
    let value = |id| lines(id, &[O::Value]);
    Ok(Functions {
        lagrangian: value(F::Lagrangian)?,
        energy: value(F::Energy)?,
        momentum: value(F::Momentum)?,
        force: value(F::Force)?,
        acceleration: lines(F::Acceleration, &[O::Mass, O::MassTimesAcceleration])?,
        point: lines(F::Point, &POINT)?,
        sides: lines(F::Point, &POINT[..2])?,
        applied_force: lines(F::Point, &POINT[1..2])?,
        point_derivatives: lines(F::PointDerivatives, &[O::MomentumDq, O::Mass, O::ForceDq, O::ForceDv])?,
        power: value(F::Power)?,
        scaled_point: lines(F::ScaledPoint, &SCALED)?,
        non_finite: value(F::NonFinite)?,
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

/// Where an input is: the argument and the entry, as the functions of `tape` pass them.
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
        Symbol::Acceleration(i) | Symbol::Q1(i) => (4, *i),
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

/// The instructions for these quantities of a function.
fn lines(function: &Function, outputs: &[Output]) -> Result<Lines, TooMany> {
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
    let all = instructions(function, &needed, results().copied(), &mut constants)?;
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
