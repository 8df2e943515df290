//! Properties of a system that the generator finds.
//!
//! In: a [`Model`], its [`DiscreteSystem`] and its [`Program`]. Out: [`Findings`], read from the emitted operations:
//! their inputs, which results are the constant 0, which are equal. With the Jacobian A = ∂residual/∂v of the momentum
//! row:
//!
//! ```text
//! linear           A takes no velocity: one solve gives the step, exact up to rounding
//! constant for h   A takes parameters and h only
//! explicit         A takes parameters only: v is given by one product with the inverse of a constant matrix
//! separable        p = L_v takes velocities and parameters only: L = T(v) + U(t, q)
//! ```
//!
//! The findings select the form of A and of the mass matrix, and the solver of a step.

mod elimination;
mod pattern;

pub use elimination::Block;
pub use pattern::Pattern;

use crate::discrete::DiscreteSystem;
use crate::model::{Model, Smoothness, Space};
use crate::program::{Function, FunctionId, Operation, OperationId, Output, Program};
use crate::symbol::{Symbol, Variable};
use std::collections::BTreeSet;
use vi_expr::Table;

/// The matrices of the derivatives of the equations of motion.
const POINT_DERIVATIVES: [Output; 4] = [Output::Mass, Output::MomentumDq, Output::ForceDq, Output::ForceDv];

/// Largest size of a non-diagonal matrix that is solved in closed form.
pub const CLOSED: usize = 3;

/// Properties of a system.
#[derive(Clone, Debug, PartialEq, Eq)]
#[allow(clippy::struct_excessive_bools, reason = "each is a finding of its own")]
pub struct Findings {
    /// Number of coordinates.
    pub size: usize,
    /// Neither L nor f depends on the time.
    pub autonomous: bool,
    /// A force acts.
    pub forced: bool,
    /// Indices of the coordinates that are cyclic: absent from L, and without a force or a reaction.
    pub cyclic: Vec<usize>,
    /// Indices of the angles, which a run reduces to a turn.
    pub angles: Vec<usize>,
    /// L = T(v) + U(t, q).
    pub separable: bool,
    /// The coordinates whose velocities L contains, if it is linear in them; none otherwise.
    pub linear: Vec<usize>,
    /// `L = y·x' − T(y) − V(t, x)`, with forces of time and x alone, and the y in the order of the x.
    pub canonical_split: bool,
    /// The mass matrix L_vv depends on parameters only.
    pub constant_mass: bool,
    /// A coordinate scales the momentum of another one: `∂p_φ/∂r` is not zero, but `∂p_r/∂φ` and `∂p_φ/∂v_r` are.
    pub curvilinear: bool,
    /// L_v is M v with a constant mass matrix M, and neither L_q nor f depends on v: the acceleration is a function of t and q.
    pub force_of_position: bool,
    /// L_v is M v with a constant diagonal M, and L_q + f depends on the time alone.
    pub point_masses: bool,
    /// Zero pattern of the mass matrix.
    pub mass: Pattern,
    /// Common zero pattern of the derivatives of L_v and L_q + f with respect to q and v.
    pub point_derivatives: Pattern,
    /// The smoothness of L and f, if tables or conditions limit it.
    pub smoothness: Option<Smoothness>,
    /// The names of the holonomic and of the nonholonomic constraints, with the number of their indices.
    pub constraints: [Vec<(String, usize)>; 2],
    /// A constraint on velocities has a part without velocities: it does work.
    pub driven: bool,
    /// Zero patterns of the constraints, and the order of elimination, if there are any.
    pub elimination: Option<Elimination>,
    /// Properties of the steps, if the system has a rule.
    pub steps: Option<StepFindings>,
}

/// Zero patterns of the functions of constraints, and the order of elimination in their steps.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Elimination {
    /// The columns of the entries of each row of A.
    pub gradients: Vec<Vec<usize>>,
    /// The columns of the entries of each row of ∂(A v + a)/∂q.
    pub rates_dq: Vec<Vec<usize>>,
    /// The columns of the entries of each row of ∂(Aᵀλ)/∂q.
    pub reaction_dq: Vec<Vec<usize>>,
    /// The blocks in the order of their elimination; multiplier r is the unknown N + r.
    pub blocks: Vec<Block>,
    /// M and the derivatives of L_v and L_q + f with respect to q and v depend on parameters only.
    pub is_constant: bool,
}

/// Properties of the steps under one rule.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StepFindings {
    /// The momentum row contains no `abs`, `sign` or `atan2`: it has no kink or jump, and Newton iteration converges
    /// quadratically.
    pub smooth: bool,
    /// Quantities that the Jacobian A depends on.
    pub jacobian: Dependence,
    /// Zero pattern of A.
    pub pattern: Pattern,
    /// A is symmetric.
    pub symmetric: bool,
    /// Common zero pattern of the derivatives of the momentum row with respect to q, and of p1 − p0 with respect to q
    /// and v.
    pub step_derivatives: Pattern,
    /// The momentum row and p1 − p0 are linear in the quantities that change from step to step, with constant
    /// coefficients.
    pub affine: bool,
}

/// Description of a step whose Jacobian depends on parameters only.
pub(crate) const EXPLICIT: &str = "explicit: its Jacobian `A` depends on parameters only and is inverted once per run";

/// Quantities that the Jacobian A depends on, in ascending order.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Dependence {
    /// Parameters only: the step is explicit.
    Parameters,
    /// Parameters and the step h.
    Step,
    /// Also the node, but not the unknown v: the momentum row is linear.
    Node,
    /// Also the unknown v: the momentum row is nonlinear.
    Unknown,
}

/// Whether a coordinate scales the momentum of another one; see [`Findings::curvilinear`].
fn is_curvilinear(derivatives: &Function) -> bool {
    let [momentum_dq, mass] = [Output::MomentumDq, Output::Mass].map(|of| derivatives.results.matrix(of));
    let is_zero = |id: &OperationId| derivatives.operations.as_constant(*id) == Some(0.0);
    let places = (0..mass.len()).flat_map(|i| (0..mass.len()).map(move |j| (i, j)));
    let scales =
        |(i, j): (usize, usize)| !is_zero(&momentum_dq[i][j]) && is_zero(&momentum_dq[j][i]) && is_zero(&mass[i][j]);
    places.into_iter().any(scales)
}

/// Finds the properties of a system.
#[must_use]
pub fn findings(model: &Model, system: &DiscreteSystem, program: &Program) -> Findings {
    let cyclic = system.continuous.cyclic.iter().enumerate().filter(|(_, cyclic)| **cyclic).map(|(index, _)| index);
    let matrix = |id: FunctionId, output: Output| program.function(id).map(|of| (of, of.results.matrix(output)));
    let mass = matrix(FunctionId::Point, Output::Mass);
    let momentum = program.function(FunctionId::Momentum);
    let velocities =
        |symbol: &Symbol| matches!(symbol, Symbol::Parameter { .. } | Symbol::Continuous(Variable::Velocity(_)));
    let parameters = |symbol: &Symbol| matches!(symbol, Symbol::Parameter { .. });
    let constant_mass =
        mass.is_some_and(|(function, rows)| inputs(function, rows.iter().flatten()).iter().all(parameters));
    let moves = |symbol: &Symbol| matches!(symbol, Symbol::Continuous(Variable::Velocity(_)));
    let rate = program.function(FunctionId::Point);
    let mass = mass.map_or(Pattern::Dense, |(function, rows)| filled(function, rows));
    let point_derivatives = program.function(FunctionId::PointDerivatives).map(|of| together(of, &POINT_DERIVATIVES));
    let places =
        |symbol: &Symbol| matches!(symbol, Symbol::Continuous(Variable::Coordinate(_) | Variable::Velocity(_)));
    let rate_is_uniform =
        rate.is_some_and(|of| !inputs(of, of.results.vector(Output::AppliedForce).iter()).iter().any(places));
    let is_constrained = !model.constraints.is_empty();
    let rate_moves = rate.is_none_or(|of| inputs(of, of.results.vector(Output::AppliedForce).iter()).iter().any(moves));
    Findings {
        size: model.dimension(),
        autonomous: system.continuous.autonomous,
        forced: model.forced,
        cyclic: cyclic.collect(),
        angles: (0..model.dimension()).filter(|index| model.coordinates[*index].space == Space::Circle).collect(),
        separable: momentum.is_some_and(|function| inputs(function, function.results.entries()).iter().all(velocities)),
        linear: (0..model.without_velocity.len()).filter(|index| !model.without_velocity[*index]).collect(),
        canonical_split: splits_canonically(&model.without_velocity, program),
        constant_mass,
        curvilinear: !constant_mass
            && !is_constrained
            && program.function(FunctionId::PointDerivatives).is_some_and(is_curvilinear),
        force_of_position: constant_mass && system.continuous.momentum_is_mass_times_velocity && !rate_moves,
        point_masses: constant_mass
            && rate_is_uniform
            && system.continuous.momentum_is_mass_times_velocity
            && matches!(mass, Pattern::Scalar | Pattern::Diagonal),
        elimination: is_constrained.then(|| elimination(model, program, &mass, point_derivatives.as_deref())),
        mass,
        point_derivatives: point_derivatives.map_or(Pattern::Dense, |entries| {
            if is_constrained { pattern::by_rows(&entries) } else { pattern::pattern(&entries) }
        }),
        smoothness: model.smoothness.clone(),
        constraints: constraint_names(model),
        driven: program.function(FunctionId::ConstraintGradients).is_some_and(|function| {
            let is_zero = |id: &OperationId| function.operations.as_constant(*id) == Some(0.0);
            !function.results.vector(Output::Rates).iter().all(is_zero)
        }),
        steps: program.function(FunctionId::MomentumEquation).map(|equation| steps(equation, program)),
    }
}

/// Whether a system of first order has `L = y·x' − T(y) − V(t, x)`, with forces of time and x alone.
fn splits_canonically(without_velocity: &[bool], program: &Program) -> bool {
    let of = |id| program.function(id);
    let (Some(momentum), Some(force), Some(point)) =
        (of(FunctionId::Momentum), of(FunctionId::Force), of(FunctionId::Point))
    else {
        return false;
    };
    let (momenta, forces) =
        (momentum.results.entries().collect::<Vec<_>>(), force.results.entries().collect::<Vec<_>>());
    let rates = point.results.vector(Output::AppliedForce);
    let half = |without: bool| (0..without_velocity.len()).filter(move |index| without_velocity[*index] == without);
    let is_canonical = |(x, y): (usize, usize)| {
        let is_y = |symbol: &Symbol| *symbol == Symbol::Continuous(Variable::Coordinate(y));
        let momentum_is_y = matches!(momentum.operations.get(*momenta[x]), Operation::Input(symbol) if is_y(symbol));
        let of_x = |symbol: &Symbol| match symbol {
            Symbol::Parameter { .. } | Symbol::Continuous(Variable::Time) => true,
            Symbol::Continuous(Variable::Coordinate(index)) => !without_velocity[*index],
            _ => false,
        };
        // Without a force its only velocity is that of x in y·x'.
        let of_y = |symbol: &Symbol| match symbol {
            Symbol::Parameter { .. } | Symbol::Continuous(Variable::Velocity(_)) => true,
            Symbol::Continuous(Variable::Coordinate(index)) => without_velocity[*index],
            _ => false,
        };
        momentum_is_y
            && force.operations.as_constant(*forces[y]) == Some(0.0)
            && inputs(point, [&rates[x]].into_iter()).iter().all(of_x)
            && inputs(point, [&rates[y]].into_iter()).iter().all(of_y)
    };
    !without_velocity.is_empty() && half(false).zip(half(true)).all(is_canonical)
}

/// Finds the properties of the steps with this momentum equation.
fn steps(equation: &Function, program: &Program) -> StepFindings {
    let jacobian = equation.results.matrix(Output::Jacobian);
    StepFindings {
        smooth: smooth(equation),
        jacobian: dependence(equation, jacobian),
        pattern: filled(equation, jacobian),
        symmetric: symmetric(jacobian),
        step_derivatives: filled_together(
            program.function(FunctionId::MomentumDerivatives),
            &[Output::ResidualDq, Output::MomentumIncrementDq, Output::MomentumIncrementDv],
        ),
        affine: program.function(FunctionId::MomentumResidual).is_some_and(affine),
    }
}

/// The zero pattern of a matrix among the results of a function.
fn filled(function: &Function, rows: &[Vec<OperationId>]) -> Pattern {
    pattern::pattern(&entries(function, rows))
}

/// For each entry of a matrix, whether it is nonzero.
fn entries(function: &Function, rows: &[Vec<OperationId>]) -> Vec<Vec<bool>> {
    let zero = |id: &OperationId| function.operations.as_constant(*id) == Some(0.0);
    rows.iter().map(|row| row.iter().map(|id| !zero(id)).collect()).collect()
}

/// The common zero pattern of these matrices among the results of a function.
fn filled_together(function: Option<&Function>, outputs: &[Output]) -> Pattern {
    function.map_or(Pattern::Dense, |function| pattern::pattern(&together(function, outputs)))
}

/// For each entry, whether it is nonzero in any of these matrices among the results of a function.
fn together(function: &Function, outputs: &[Output]) -> Vec<Vec<bool>> {
    let mut matrices = outputs.iter().map(|output| entries(function, function.results.matrix(*output)));
    let mut all = matrices.next().unwrap_or_default();
    for matrix in matrices {
        for (entry, other) in all.iter_mut().flatten().zip(matrix.into_iter().flatten()) {
            *entry |= other;
        }
    }
    all
}

/// The zero patterns of constraints and the order of elimination, given the zero pattern of M and the nonzero entries
/// of the derivatives of the equations of motion.
fn elimination(model: &Model, program: &Program, mass: &Pattern, derivatives: Option<&[Vec<bool>]>) -> Elimination {
    let columns = |id: FunctionId, output: Output| {
        let found = program.function(id).map(|of| pattern::columns(&entries(of, of.results.matrix(output))));
        found.unwrap_or_default()
    };
    let gradients = columns(FunctionId::ConstraintGradients, Output::Gradients);
    let rates_dq = columns(FunctionId::ConstraintRateDerivatives, Output::RatesDq);
    let reaction_dq = columns(FunctionId::ReactionDerivatives, Output::ReactionDq);
    let size = model.dimension();
    let square = |members: &[usize]| members.iter().flat_map(|i| members.iter().map(|j| (*i, *j))).collect();
    let masses: Vec<(usize, usize)> = match mass {
        Pattern::Diagonal => Vec::new(),
        Pattern::Blocks(blocks) => blocks.iter().flat_map(|members| square(members)).collect::<Vec<_>>(),
        _ => square(&(0..size).collect::<Vec<_>>()),
    };
    let pairs = |rows: &[Vec<usize>], from: usize| {
        let of = |(row, columns): (usize, &Vec<usize>)| {
            columns.iter().map(|column| (from + row, *column)).collect::<Vec<_>>()
        };
        rows.iter().enumerate().flat_map(of).collect::<Vec<_>>()
    };
    let derivatives = match derivatives {
        Some(entries) if pattern::by_rows(entries) != Pattern::Dense => pattern::columns(entries),
        _ => vec![(0..size).collect(); size],
    };
    let mut couplings = pairs(&derivatives, 0);
    couplings.extend(pairs(&reaction_dq, 0));
    couplings.extend(pairs(&gradients, size).into_iter().chain(pairs(&rates_dq, size)));
    let blocks = elimination::blocks([size, model.constraints.len()], &masses, &couplings);
    let is_constant = program.function(FunctionId::PointDerivatives).is_some_and(|of| {
        let entries = POINT_DERIVATIVES.iter().flat_map(|output| of.results.matrix(*output)).flatten();
        inputs(of, entries).iter().all(|symbol| matches!(symbol, Symbol::Parameter { .. }))
    });
    Elimination { gradients, rates_dq, reaction_dq, blocks, is_constant }
}

/// Whether a function has no kink and no jump.
fn smooth(function: &Function) -> bool {
    use vi_expr::Function::{Abs, Atan2, Sign};
    !function.needed().into_iter().any(|id| {
        matches!(
            function.operations.get(id),
            Operation::Call(Abs | Sign, _) | Operation::Call2(Atan2, ..) | Operation::Select(..)
        )
    })
}

/// The inputs of these results.
fn inputs<'a>(function: &Function, results: impl Iterator<Item = &'a OperationId>) -> BTreeSet<Symbol> {
    let needed = function.operations.needed(results).into_iter();
    needed
        .filter_map(|id| match function.operations.get(id) {
            Operation::Input(symbol) => Some(symbol.clone()),
            _ => None,
        })
        .collect()
}

fn dependence(function: &Function, rows: &[Vec<OperationId>]) -> Dependence {
    let of = |symbol: Symbol| match symbol {
        Symbol::Parameter { .. } => Dependence::Parameters,
        Symbol::Step => Dependence::Step,
        Symbol::StepVelocity(_) => Dependence::Unknown,
        _ => Dependence::Node,
    };
    inputs(function, rows.iter().flatten()).into_iter().map(of).max().unwrap_or(Dependence::Parameters)
}

/// Whether residual and increment of a momentum row are affine in the quantities that change from step to step.
fn affine(function: &Function) -> bool {
    // The degree of each operation; `None` if it is not a polynomial of degree 0 or 1.
    let mut degrees: Table<OperationId, Option<u8>> = Table::default();
    let residual = function.results.vector(Output::Residual);
    let increment = function.results.vector(Output::MomentumIncrement);
    for id in function.operations.needed(residual.iter().chain(increment)) {
        let degree = |id: &OperationId| degrees.get(*id).copied().flatten();
        let found = match function.operations.get(id) {
            Operation::Constant(_) | Operation::Input(Symbol::Parameter { .. } | Symbol::Step) => Some(0),
            Operation::Input(_) => Some(1),
            Operation::Negate(a) => degree(a),
            Operation::Add(a, b) | Operation::Subtract(a, b) => degree(a).zip(degree(b)).map(|(a, b)| a.max(b)),
            Operation::Multiply(a, b) => degree(a).zip(degree(b)).map(|(a, b)| a + b),
            Operation::Divide(a, b) => degree(a).filter(|_| degree(b) == Some(0)),
            other => other.operands().all(|operand| degree(&operand) == Some(0)).then_some(0),
        };
        degrees.insert(id, found.filter(|degree| *degree <= 1));
    }
    residual.iter().chain(increment).all(|id| degrees.get(*id).copied().flatten().is_some())
}

fn symmetric(rows: &[Vec<OperationId>]) -> bool {
    let entry = |i: usize, j: usize| rows.get(i).and_then(|row| row.get(j));
    (0..rows.len()).all(|i| (0..i).all(|j| entry(i, j) == entry(j, i)))
}

/// The orders that the methods keep with so many continuous derivatives of L.
fn smoothness_in_words(smoothness: &Smoothness) -> String {
    let left = match smoothness.derivatives {
        0 => {
            "`FixedStep` has order 1 across it, and a step may have no solution; no energy-preserving step is certain to exist"
        }
        1 => {
            "`FixedStep` keeps order 2, `Gauss` has order 2 across it; the step density jumps, so that energy-preserving steps may end there"
        }
        2 => "`FixedStep` and energy-preserving steps keep order 2; `Gauss` has order 3 across it",
        _ => {
            "`FixedStep` and energy-preserving steps keep order 2; `Gauss` has one order more than derivatives across it"
        }
    };
    format!("{}: {left}", derivatives_in_words(smoothness))
}

/// The number of continuous derivatives of L in words, with the cause.
pub(crate) fn derivatives_in_words(Smoothness { derivatives, cause }: &Smoothness) -> String {
    let noun = if *derivatives == 1 { "derivative" } else { "derivatives" };
    format!("`L` has {derivatives} continuous {noun} because of {cause}")
}

/// Whether a system without constraints conserves energy.
pub(crate) fn energy_in_words(autonomous: bool, forced: bool) -> &'static str {
    match (autonomous, forced) {
        (true, false) => "Autonomous and without a force: the energy is conserved",
        (true, true) => "Autonomous; a force acts",
        (false, false) => "Not autonomous: `L` depends on the time `t`; no force acts",
        (false, true) => "Not autonomous: `L` or `f` depends on the time `t`; a force acts",
    }
}

/// Whether a system with constraints conserves energy; `driven` if a constraint on velocities does work.
pub(crate) fn constrained_energy_in_words(autonomous: bool, forced: bool, driven: bool) -> &'static str {
    match (autonomous, forced) {
        (true, false) if driven => "Autonomous; no force acts, but a constraint does work",
        (false, false) => "Not autonomous: `L` or a constraint depends on the time `t`; no force acts",
        (false, true) => "Not autonomous: `L`, `f` or a constraint depends on the time `t`; a force acts",
        (true, forced) => energy_in_words(true, forced),
    }
}

/// The names of the holonomic and of the nonholonomic constraints, with the number of their indices.
pub(crate) fn constraint_names(model: &Model) -> [Vec<(String, usize)>; 2] {
    [true, false].map(|is_holonomic| {
        let of_kind = model.constraints.iter().filter(|constraint| constraint.is_holonomic == is_holonomic);
        of_kind.map(|constraint| (constraint.name.to_string(), constraint.indices.len())).collect()
    })
}

/// The constraints of each kind in words; each array is named once.
pub(crate) fn constraints_in_words(names: &[Vec<(String, usize)>; 2]) -> Vec<String> {
    let kinds = names.iter().zip(["positions", "velocities"]).filter(|(names, _)| !names.is_empty());
    kinds.map(|(names, kind)| format!("Constraints on {kind}: {}", in_arrays(names))).collect()
}

/// The finding about angles, given their names.
pub(crate) fn angles_in_words(names: &str) -> String {
    format!("Angles modulo 2π: {names}; a run keeps their sines exact")
}

/// The finding about cyclic coordinates, given their names and number.
pub(crate) fn cyclic_in_words(names: &str, count: usize) -> String {
    let momenta = if count == 1 { "its momentum is" } else { "their momenta are" };
    format!("Cyclic: {names}; {momenta} conserved")
}

/// Names of constraints, each array once with the number of its entries.
fn in_arrays(names: &[(String, usize)]) -> String {
    let arrays = names.chunk_by(|left, right| left == right && left.1 > 0);
    let text = |array: &[(String, usize)]| match array {
        [(name, 0)] => name.clone(),
        [(name, _), ..] => format!("{name} ({})", array.len()),
        [] => String::new(),
    };
    arrays.map(text).collect::<Vec<_>>().join(", ")
}

/// The order of Gauss steps of a system with constraints across a point where a derivative of L jumps.
pub(crate) fn constrained_smoothness_in_words(smoothness: &Smoothness) -> String {
    let order = smoothness.derivatives + 1;
    format!("{}: `Gauss` has order {order} across it", derivatives_in_words(smoothness))
}

/// The names of coordinates, separated by commas.
fn list(name: &dyn Fn(usize) -> String, indices: &[usize]) -> String {
    indices.iter().map(|index| name(*index)).collect::<Vec<_>>().join(", ")
}

impl Elimination {
    /// The method by which a step solves its linear systems, in words.
    fn in_words(&self, point_masses: bool) -> String {
        let matrix = match (point_masses, self.is_constant) {
            (true, _) => "Velocities are affine in the impulses: a midpoint step solves for the impulses alone; ",
            (false, true) => "The derivatives of the momentum rows are constant; ",
            (false, false) => "The derivatives of the momentum rows depend on the state; ",
        };
        let size = |block: &Block| block.own.len() + block.border.len();
        let largest = self.blocks.iter().map(size).max().unwrap_or(0);
        let blocks = match self.blocks.len() {
            0 | 1 => format!("coordinates and multipliers form one block of {largest}"),
            count => format!("coordinates and multipliers are eliminated in {count} blocks of at most {largest}"),
        };
        format!("{matrix}{blocks}")
    }
}

impl StepFindings {
    /// The momentum row is linear and smooth, and A is the same for all steps of equal length: one inversion per run.
    #[must_use]
    pub fn constant_jacobian(&self) -> bool {
        self.smooth && self.jacobian <= Dependence::Step
    }

    /// The method by which a system with `size` coordinates solves for A, in words.
    fn solved(&self, size: usize) -> &'static str {
        match &self.pattern {
            Pattern::Scalar | Pattern::Diagonal => "by division",
            _ if size <= CLOSED => "in closed form",
            Pattern::Tridiagonal => "by elimination from both ends",
            Pattern::Banded(_) => "by elimination inside the band",
            Pattern::Blocks(_) => "block by block",
            Pattern::Dense if self.symmetric => "by `L D Lᵀ`",
            Pattern::Sparse(_) | Pattern::Dense => "by elimination with pivoting",
        }
    }
}

impl Findings {
    /// A step is one constant affine map of (q, p), computed once per run.
    #[must_use]
    pub fn closed_form(&self) -> bool {
        let is_linear = self.steps.as_ref().is_some_and(|steps| steps.constant_jacobian() && steps.affine);
        is_linear && self.autonomous && self.size <= CLOSED
    }

    /// The findings in words, one per line, with formulas between backticks; `name` names a coordinate.
    #[must_use]
    pub fn lines(&self, name: &dyn Fn(usize) -> String) -> Vec<String> {
        let is_constrained = self.constraints.iter().any(|names| !names.is_empty());
        let mut lines = vec![
            if is_constrained {
                constrained_energy_in_words(self.autonomous, self.forced, self.driven)
            } else {
                energy_in_words(self.autonomous, self.forced)
            }
            .to_owned(),
        ];
        if !self.cyclic.is_empty() {
            lines.push(cyclic_in_words(&list(name, &self.cyclic), self.cyclic.len()));
        }
        if !self.angles.is_empty() {
            lines.push(angles_in_words(&list(name, &self.angles)));
        }
        lines.push(match (self.separable, self.constant_mass) {
            _ if !self.linear.is_empty() => {
                let (of, velocities) = (list(name, &self.linear), if self.linear.len() == 1 { "velocity" } else { "velocities" });
                let steps = if self.canonical_split { "Gauss steps, or kicks and drifts" } else { "Gauss steps" };
                format!("`L` is linear in the {velocities} of {of}, without a mass matrix: equations of first order, with {steps}")
            }
            (true, true) => "`L = T(v) + U(t, q)` with a constant mass matrix".to_owned(),
            (true, false) => "`L = T(v) + U(t, q)`; the mass matrix depends on the velocity".to_owned(),
            (false, true) => "The mass matrix is constant".to_owned(),
            (false, false) if self.curvilinear => {
                let steps = "Gauss steps evaluate forces at the velocities of the momenta";
                format!("The mass matrix depends on the state, and a coordinate scales the momentum of another one: {steps}")
            }
            (false, false) => "The mass matrix depends on the state".to_owned(),
        });
        let in_words = if is_constrained { constrained_smoothness_in_words } else { smoothness_in_words };
        lines.extend(self.smoothness.as_ref().map(in_words));
        lines.extend(constraints_in_words(&self.constraints));
        lines.extend(
            self.elimination.as_ref().map(|of| of.in_words(self.point_masses && self.constraints[1].is_empty())),
        );
        lines.extend(self.of_steps(name));
        lines
    }

    /// The findings that depend on the rule; empty without one.
    #[must_use]
    pub fn of_steps(&self, name: &dyn Fn(usize) -> String) -> Vec<String> {
        let Some(steps) = &self.steps else { return Vec::new() };
        let mut lines = vec![format!(
            "The step's equation in `v` is {}",
            match steps.jacobian {
                _ if !steps.smooth =>
                    "not smooth: it has a kink or a jump, across which Newton's iteration may have to be damped",
                _ if self.closed_form() => "linear: one constant matrix, computed once per run, gives the whole step",
                Dependence::Parameters => EXPLICIT,
                Dependence::Step =>
                    "linear: its Jacobian `A` depends on parameters and `h` only and is inverted once per run",
                Dependence::Node => "linear: its Jacobian `A` does not depend on `v`, and one solution gives the step",
                Dependence::Unknown =>
                    "nonlinear: its Jacobian `A` depends on `v`, and Newton's iteration gives the step",
            }
        )];
        if steps.pattern != Pattern::Scalar {
            let symmetry = if steps.symmetric { "symmetric" } else { "not symmetric" };
            lines.push(format!(
                "`A` is {}, {symmetry}; solved {}",
                steps.pattern.text(&|indices| list(name, indices)),
                steps.solved(self.size)
            ));
        }
        lines
    }
}
