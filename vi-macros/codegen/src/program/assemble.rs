//! The functions of a system, assembled from its expressions.
//!
//! In: a [`Model`] and its [`DiscreteSystem`]. Out: a [`Program`]. Fields become derivatives of L and f at the points
//! of the rule. A function evaluates the arguments of a point once.

use super::lowering::{Known, Lowering};
use super::results::{FunctionId, Output, Results};
use super::rounding_scale::rounding_scale;
use super::verify::{self, Expressions};
use super::{Function, Program, vanishing};
use crate::discrete::continuous::{Continuous, TimeScale};
use crate::discrete::{ByRule, Constraints, DiscreteSystem, Fields, SlotDerivatives};
use crate::limits::bounded;
use crate::messages::{Message, error};
use crate::model::{Model, Point};
use crate::symbol::{Symbol, Variable};
use proc_macro2::{Ident, Span};
use std::collections::BTreeMap;
use syn::Result;
use vi_expr::{Expr, Node, Pool, TooLarge};

/// Assembles all functions.
///
/// # Errors
/// A coefficient outside the range of `f64`, at the name of the system.
/// Operations that do not reproduce their expressions: a bug of this compiler, reported and not emitted.
pub fn program(pool: &mut Pool<Symbol>, model: &Model, system: &DiscreteSystem) -> Result<Program> {
    let too_large = |found: TooLarge| error(model.name.span(), &Message::TooLarge { size: found });
    let continuous = continuous(&mut Assembly::new(pool, system, &[]), model, system).map_err(too_large)?;
    let (mut of_slots, mut of_steps) = (Vec::new(), Vec::new());
    if let Some(rule) = &system.by_rule {
        let ByRule { slots, equations, .. } = rule;
        of_slots = self::slots(&mut Assembly::new(pool, system, &slots.points), slots).map_err(too_large)?;
        of_steps = step(&mut Assembly::new(pool, system, &equations.points), rule).map_err(too_large)?;
    }
    let check = |(function, expressions): (Function, Expressions)| {
        verify::has_finite_constants(&function, &model.name)?;
        // Only builds with debug assertions verify, so this does not count as work of the system.
        pool.uncounted(|pool| verify::agrees(pool, &function, &expressions, &model.name)).map(|()| function)
    };
    let all = |list: Vec<_>| list.into_iter().map(check).collect::<Result<Vec<_>>>();
    Ok(Program { continuous: all(continuous)?, slots: all(of_slots)?, step: all(of_steps)? })
}

/// A function of its own, of numbers that are inputs: derivatives of `sources`. `None` for one that takes too much work,
/// or has a part without a value or a constant that is not finite.
pub(crate) fn alone(pool: &mut Pool<Symbol>, sources: &[Expr], exprs: &[Expr]) -> Option<Function> {
    bounded(pool).ok()?;
    let collected = pool.collect_constants(exprs);
    if collected.iter().any(|expr| pool.is_undefined(*expr)) {
        return None;
    }
    let mut known = Known { products: vanishing::Known::of(pool, sources), ..Known::default() };
    let arguments = BTreeMap::new();
    let mut lowering = Lowering::new(pool, &mut known, &arguments);
    let results = lowering.lower(&Results::new(vector(&collected)));
    let operations = lowering.operations;
    pool.spend(OPERATION * operations.len());
    bounded(pool).ok()?;
    let function = Function { id: FunctionId::Body, operations, results };
    let name = Ident::new(function.id.name(), Span::call_site());
    verify::has_finite_constants(&function, &name).is_ok().then_some(function)
}

/// Work of an operation until it is emitted.
const OPERATION: usize = 128;

pub(super) type Assembled = core::result::Result<Vec<(Function, Expressions)>, TooLarge>;

pub(super) struct Assembly<'a> {
    pub(super) pool: &'a mut Pool<Symbol>,
    fields: &'a Fields,
    /// The arguments of the points; missing ones are inputs of the function.
    pub(super) arguments: BTreeMap<(usize, Variable), Expr>,
    known: Known,
}

impl<'a> Assembly<'a> {
    fn new(pool: &'a mut Pool<Symbol>, system: &'a DiscreteSystem, points: &[Point]) -> Self {
        let mut arguments = BTreeMap::new();
        for (index, point) in points.iter().enumerate() {
            for (variable, argument) in point.arguments() {
                let argument = step_velocity(pool, argument).unwrap_or(argument);
                arguments
                    .extend(pool.collect_constants(&[argument]).first().map(|argument| ((index, variable), *argument)));
            }
        }
        let Continuous { lagrangian, force, .. } = &system.continuous;
        let of_constraints = system
            .constraints
            .iter()
            .flat_map(|of| of.values.iter().chain(&of.rates).chain(of.gradients.iter().flatten()));
        let sources: Vec<Expr> = [lagrangian].into_iter().chain(force).chain(of_constraints).copied().collect();
        let known = Known { products: vanishing::Known::of(pool, &sources), ..Known::default() };
        Self { pool, fields: &system.fields, arguments, known }
    }

    /// Replaces fields by derivatives of L and f at the points. Arguments remain opaque unless they are bare symbols.
    fn open(&mut self, expr: Expr) -> Expr {
        let Self { pool, fields, arguments, .. } = self;
        pool.substitute(expr, &mut |pool, symbol| {
            let Symbol::Field(field) = symbol else { return None };
            let definition = fields.definition(field)?;
            Some(pool.substitute(definition, &mut |pool, symbol| {
                let Symbol::Continuous(variable) = symbol else { return None };
                let argument = *arguments.get(&(field.point, *variable))?;
                let bare = matches!(pool.node(argument), Node::Symbol(_) | Node::Number(_));
                Some(if bare { argument } else { pool.symbol(Symbol::AtPoint(field.point, *variable)) })
            }))
        })
    }

    fn open_all(&mut self, exprs: &[Expr]) -> Vec<Expr> {
        exprs.iter().map(|expr| self.open(*expr)).collect()
    }

    fn open_rows(&mut self, rows: &[Vec<Expr>]) -> Vec<Vec<Expr>> {
        rows.iter().map(|row| self.open_all(row)).collect()
    }

    fn rounding_scales(&mut self, exprs: &[Expr]) -> Vec<Expr> {
        let collected = self.pool.collect_constants(exprs);
        collected.into_iter().map(|expr| rounding_scale(self.pool, &mut self.known.products, expr)).collect()
    }

    /// The expressions, with constants rounded once.
    fn collected(&mut self, expressions: &Results<Expr>) -> Results<Expr> {
        let entries: Vec<Expr> = expressions.entries().copied().collect();
        let mut collected = self.pool.collect_constants(&entries).into_iter();
        expressions.map(|expr| collected.next().unwrap_or(*expr))
    }

    /// A function that computes these quantities, each given by rows.
    fn function(
        &mut self,
        id: FunctionId,
        quantities: Vec<(Output, Vec<Vec<Expr>>)>,
    ) -> core::result::Result<(Function, Expressions), TooLarge> {
        bounded(self.pool)?;
        let expressions = self.collected(&Results::new(quantities));
        let mut used = BTreeMap::new();
        for expr in expressions.entries() {
            for symbol in self.pool.symbols(*expr) {
                if let Symbol::AtPoint(point, variable) = symbol {
                    used.extend(self.arguments.get(&(point, variable)).map(|e| ((point, variable), *e)));
                }
            }
        }
        let mut lowering = Lowering::new(self.pool, &mut self.known, &used);
        let results = lowering.lower(&expressions);
        let operations = lowering.operations;
        self.pool.spend(OPERATION * operations.len());
        bounded(self.pool)?;
        Ok((Function { id, operations, results }, Expressions { results: expressions, arguments: used }))
    }
}

/// The velocity of the step, if an argument of a point equals it.
fn step_velocity(pool: &mut Pool<Symbol>, argument: Expr) -> Option<Expr> {
    let moved = pool.substitute(argument, &mut |pool, symbol| match symbol {
        Symbol::Q1(index) => {
            let (start, step) = (pool.symbol(Symbol::Q0(*index)), pool.symbol(Symbol::Step));
            let velocity = pool.symbol(Symbol::StepVelocity(*index));
            let displacement = pool.mul(step, velocity);
            Some(pool.add(start, displacement))
        }
        _ => None,
    });
    let moved = pool.expand(moved).ok()?;
    matches!(pool.node(moved), Node::Symbol(Symbol::StepVelocity(_))).then_some(moved)
}

/// Ω, and Ω a by the time derivative of `L_q + f − dϑ/dt = 0`.
fn structure(pool: &mut Pool<Symbol>, system: &DiscreteSystem) -> Vec<(Output, Vec<Vec<Expr>>)> {
    let of = &system.point_derivatives;
    let rows = of.momentum_dq.iter().zip(&of.force_dv);
    let structure = rows.map(|(of_momentum, of_force)| {
        of_momentum.iter().zip(of_force).map(|(of_momentum, of_force)| pool.sub(*of_momentum, *of_force)).collect()
    });
    let structure = structure.collect();
    let rate = |equation: &Expr| {
        pool.derivative(*equation, &mut |pool, symbol| match symbol {
            Symbol::Continuous(Variable::Time) => pool.one(),
            Symbol::Continuous(Variable::Coordinate(index)) => {
                pool.symbol(Symbol::Continuous(Variable::Velocity(*index)))
            }
            _ => pool.zero(),
        })
    };
    let rates = system.continuous.mass_times_acceleration.iter().map(rate).collect();
    vec![(Output::Structure, structure), (Output::StructureTimesAcceleration, vec![rates])]
}

fn continuous(assembly: &mut Assembly, model: &Model, system: &DiscreteSystem) -> Assembled {
    let of = &system.continuous;
    let mass = (Output::Mass, of.mass.clone());
    let momentum = (Output::Momentum, vec![of.momentum.clone()]);
    let mass_times_acceleration = (Output::MassTimesAcceleration, vec![of.mass_times_acceleration.clone()]);
    let applied_force = (Output::AppliedForce, vec![of.applied_force.clone()]);
    let point_derivatives = vec![
        mass.clone(),
        (Output::MomentumDq, system.point_derivatives.momentum_dq.clone()),
        (Output::ForceDq, system.point_derivatives.force_dq.clone()),
        (Output::ForceDv, system.point_derivatives.force_dv.clone()),
    ];
    let mut functions = vec![
        assembly.function(FunctionId::Lagrangian, number(of.lagrangian))?,
        assembly.function(FunctionId::Energy, number(of.energy))?,
        assembly.function(FunctionId::Momentum, vector(&of.momentum))?,
        assembly.function(FunctionId::Force, vector(&of.force))?,
        match &system.constraints {
            None if model.without_velocity.is_empty() => {
                assembly.function(FunctionId::Acceleration, vec![mass.clone(), mass_times_acceleration])?
            }
            _ => assembly.function(FunctionId::Applied, vector(&of.mass_times_acceleration))?,
        },
        assembly.function(FunctionId::Point, vec![momentum.clone(), applied_force.clone(), mass.clone()])?,
        assembly.function(FunctionId::PointDerivatives, point_derivatives)?,
        assembly.function(FunctionId::Power, number(of.power))?,
    ];
    if let Some(of) = &system.constraints {
        functions.extend(constraints(assembly, of)?);
    }
    if !model.without_velocity.is_empty() {
        let quantities = structure(assembly.pool, system);
        functions.push(assembly.function(FunctionId::Acceleration, quantities)?);
    }
    if system.has_energy_steps() {
        functions.push(assembly.function(FunctionId::StepDensity, number(of.step_density))?);
    }
    functions.push(assembly.function(FunctionId::NonFinite, vector(&of.watched))?);
    if !of.calls.is_empty() {
        let arguments: Vec<Expr> = of.calls.iter().flat_map(|(_, arguments)| arguments).copied().collect();
        functions.push(assembly.function(FunctionId::Undefined, vector(&arguments))?);
    }
    if let Some(TimeScale { g, g_dq, g_dt }) = &of.time_scale {
        let quantities = vec![
            momentum,
            applied_force,
            mass,
            (Output::Energy, vec![vec![of.energy]]),
            (Output::Power, vec![vec![of.power]]),
            (Output::TimeScale, vec![vec![*g]]),
            (Output::TimeScaleDq, vec![g_dq.clone()]),
            (Output::TimeScaleDt, vec![vec![*g_dt]]),
        ];
        functions.push(assembly.function(FunctionId::ScaledPoint, quantities)?);
    }
    Ok(functions)
}

/// The functions of the constraints.
fn constraints(assembly: &mut Assembly, of: &Constraints) -> Assembled {
    let gradients = vec![(Output::Gradients, of.gradients.clone()), (Output::Rates, vec![of.rates.clone()])];
    let derivatives = vec![(Output::RatesDq, of.rates_dq.clone()), (Output::RatesDt, vec![of.rates_dt.clone()])];
    Ok(vec![
        assembly.function(FunctionId::Constraints, vector(&of.values))?,
        assembly.function(FunctionId::ConstraintGradients, gradients)?,
        assembly.function(FunctionId::ConstraintRateDerivatives, derivatives)?,
        assembly.function(FunctionId::ReactionDerivatives, vec![(Output::ReactionDq, of.reaction_dq.clone())])?,
    ])
}

/// A number as the value of a function.
fn number(value: Expr) -> Vec<(Output, Vec<Vec<Expr>>)> {
    vector(&[value])
}

/// A vector as the value of a function.
fn vector(value: &[Expr]) -> Vec<(Output, Vec<Vec<Expr>>)> {
    vec![(Output::Value, vec![value.to_vec()])]
}

fn slots(assembly: &mut Assembly, of: &SlotDerivatives) -> Assembled {
    let functions: [(FunctionId, &[Expr]); 9] = [
        (FunctionId::Ld, &[of.ld]),
        (FunctionId::D1Ld, &[of.d1_ld]),
        (FunctionId::D2Ld, &of.d2_ld),
        (FunctionId::D3Ld, &[of.d3_ld]),
        (FunctionId::D4Ld, &of.d4_ld),
        (FunctionId::FdMinus, &of.forces.fd_minus),
        (FunctionId::FdPlus, &of.forces.fd_plus),
        (FunctionId::GdMinus, &[of.forces.gd_minus]),
        (FunctionId::GdPlus, &[of.forces.gd_plus]),
    ];
    functions
        .into_iter()
        .map(|(id, exprs)| {
            let open = assembly.open_all(exprs);
            assembly.function(id, vector(&open))
        })
        .collect()
}

fn step(assembly: &mut Assembly, rule: &ByRule) -> Assembled {
    let of = &rule.equations;
    let residual = assembly.open_all(&of.residual);
    let energy_residual = assembly.open_all(&[of.energy_residual]);
    let momentum_increment = assembly.open_all(&of.momentum_increment);
    let energy_increment = assembly.open_all(&[of.energy_increment]);
    let discrete_energy = assembly.open_all(&[of.discrete_energy]);
    let jacobian = assembly.open_rows(&of.residual_dv);
    let residual_dh = assembly.open_all(&of.residual_dh);
    let energy_dv = assembly.open_all(&of.energy_dv);
    let energy_dh = assembly.open_all(&[of.energy_dh]);
    let momentum_derivatives = vec![
        (Output::Jacobian, jacobian.clone()),
        (Output::ResidualDq, assembly.open_rows(&of.residual_dq)),
        (Output::MomentumIncrementDq, assembly.open_rows(&of.momentum_increment_dq)),
        (Output::MomentumIncrementDv, assembly.open_rows(&of.momentum_increment_dv)),
    ];
    let energy_derivatives = [
        (Output::ResidualDh, vec![residual_dh.clone()]),
        (Output::EnergyDq, vec![assembly.open_all(&of.energy_dq)]),
        (Output::EnergyDv, vec![energy_dv.clone()]),
        (Output::EnergyDh, vec![energy_dh.clone()]),
        (Output::MomentumIncrementDh, vec![assembly.open_all(&of.momentum_increment_dh)]),
        (Output::EnergyIncrementDq, vec![assembly.open_all(&of.energy_increment_dq)]),
        (Output::EnergyIncrementDv, vec![assembly.open_all(&of.energy_increment_dv)]),
        (Output::EnergyIncrementDh, vec![assembly.open_all(&[of.energy_increment_dh])]),
    ];
    let extended_derivatives = momentum_derivatives.iter().cloned().chain(energy_derivatives).collect();
    let rounding_scale = assembly.rounding_scales(&residual);
    let energy_rounding_scale = assembly.rounding_scales(&energy_residual);
    let residual = (Output::Residual, vec![residual]);
    let jacobian = (Output::Jacobian, jacobian);
    let rounding_scale = (Output::RoundingScale, vec![rounding_scale]);
    let energy_residual = (Output::EnergyResidual, vec![energy_residual]);
    let momentum_increment = (Output::MomentumIncrement, vec![momentum_increment]);
    let equation = vec![residual.clone(), jacobian.clone()];
    let measured = vec![residual.clone(), rounding_scale.clone(), momentum_increment.clone()];
    let extended = vec![
        residual.clone(),
        jacobian,
        (Output::ResidualDh, vec![residual_dh]),
        energy_residual.clone(),
        (Output::EnergyDv, vec![energy_dv]),
        (Output::EnergyDh, vec![energy_dh]),
    ];
    let both_measured = vec![
        residual,
        rounding_scale,
        energy_residual,
        (Output::EnergyRoundingScale, vec![energy_rounding_scale]),
        momentum_increment,
        (Output::EnergyIncrement, vec![energy_increment]),
    ];
    let mut functions = vec![
        assembly.function(FunctionId::MomentumEquation, equation)?,
        assembly.function(FunctionId::MomentumResidual, measured)?,
        assembly.function(FunctionId::MomentumDerivatives, momentum_derivatives)?,
        assembly.function(FunctionId::DiscreteEnergy, vector(&discrete_energy))?,
    ];
    if rule.has_energy_steps() {
        functions.push(assembly.function(FunctionId::ExtendedSystem, extended)?);
        functions.push(assembly.function(FunctionId::ExtendedResidual, both_measured)?);
        functions.push(assembly.function(FunctionId::ExtendedDerivatives, extended_derivatives)?);
    }
    Ok(functions)
}
