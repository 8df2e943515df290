//! The body of a function: named inputs, shared terms bound once, results as formulas.
//!
//! In: a [`Function`]. Out: statements, and one formula per result. A term gets a name if it is used more than once, is
//! an argument of the rule, or makes a line too long. Every other term is written at its use. A long body becomes loops
//! over the coordinates ([`Loops`]). If it is still too long, all results get names and [`pieces`] compute them.

use super::angles::Angles;
use super::entries::ResultEntry;
use super::folds::FoldText;
use super::formula::{Formula, LINE};
use super::functions::{self, Calls};
use super::loops::{LoopContext, Loops, Member, PrintedLoops};
use super::names::Names;
use super::pieces::{PieceContext, Statement, pieces};
use crate::model::Model;
use crate::program::{Function, Operation, OperationId, Results};
use crate::symbol::{Symbol, Variable};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};
use std::collections::{BTreeMap, BTreeSet};
use vi_expr::{Function as Elementary, Table};

/// A printed body.
pub(super) struct Body {
    /// The statements before the results.
    pub(super) statements: TokenStream,
    /// The results.
    pub(super) results: Results<ResultEntry>,
    /// Names of the input components that the body reads.
    pub(super) inputs: BTreeMap<Symbol, Ident>,
    /// Names of the vectors that the body reads as a whole, keyed by component 0.
    pub(super) vectors: BTreeMap<Symbol, Ident>,
}

/// Source of the velocity of the step in a function.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum VelocityFrom {
    /// An argument of the function.
    Argument,
    /// The ends and the length of an interval, which are then inputs of the function.
    Interval,
}

struct Printer<'a> {
    model: &'a Model,
    function: &'a Function,
    names: Names<'a>,
    uses: Table<OperationId, usize>,
    results: Table<OperationId, ()>,
    written: Table<OperationId, Formula>,
    named: Table<OperationId, Ident>,
    inputs: BTreeMap<Symbol, Ident>,
    vectors: BTreeMap<Symbol, Ident>,
    statements: Vec<Statement>,
    in_pieces: bool,
    angles: Angles,
    calls: Calls,
    /// Operations computed in loops.
    members: BTreeMap<OperationId, Member>,
    /// Sums over members of loops.
    folds: BTreeMap<OperationId, (OperationId, FoldText)>,
}

/// Prints a function of a system whose rule has `points` points: in loops or, if these do not shorten it, in pieces if
/// it has more than `limit` operations.
pub(super) fn body(model: &Model, function: &Function, points: usize, velocity: VelocityFrom, limit: usize) -> Body {
    let long = function.operation_count() > limit;
    let (names, needed) = (Names::new(model, points), function.needed());
    if let Some(loops) = long.then(|| Loops::of(function, &needed, limit)).flatten() {
        return Printer::new(model, function, names, loops.uses()).in_loops(&loops, &needed, velocity);
    }
    let needed = if long { function.local_order() } else { needed };
    let angles = Angles::of(function, &needed);
    let needed = angles.first(function, needed);
    let calls = Calls::of(function, &needed);
    let mut printer =
        Printer { in_pieces: long, angles, calls, ..Printer::new(model, function, names, function.uses()) };
    printer.name_inputs(&needed, velocity);
    let constants = needed.iter().any(|id| matches!(function.operations.get(*id), Operation::Constant(_)));
    for id in needed {
        printer.write(id);
    }
    let prelude = constants.then(|| quote!(let real = T::real;));
    let statements = printer.statements(prelude.as_ref(), limit);
    printer.body(quote!(#prelude #statements))
}

impl<'a> Printer<'a> {
    fn new(model: &'a Model, function: &'a Function, names: Names<'a>, uses: Table<OperationId, usize>) -> Self {
        Self {
            model,
            function,
            names,
            uses,
            results: function.results.entries().map(|id| (*id, ())).collect(),
            written: Table::default(),
            named: Table::default(),
            inputs: BTreeMap::new(),
            vectors: BTreeMap::new(),
            statements: Vec::new(),
            in_pieces: false,
            angles: Angles::default(),
            calls: Calls::default(),
            members: BTreeMap::new(),
            folds: BTreeMap::new(),
        }
    }

    /// The printed body.
    fn body(self, statements: TokenStream) -> Body {
        let results = self.function.results.map(|id| self.result(*id));
        Body { statements, results, inputs: self.inputs, vectors: self.vectors }
    }

    /// The body in loops, with the remaining operations before and after them.
    fn in_loops(mut self, loops: &Loops, needed: &[OperationId], velocity: VelocityFrom) -> Body {
        let vector = |id: &OperationId| match self.function.operations.get(*id) {
            Operation::Input(symbol) => symbol.component().map(|(vector, _)| vector),
            _ => None,
        };
        let mut vectors: BTreeSet<Symbol> = needed.iter().filter_map(vector).collect();
        if velocity == VelocityFrom::Interval && vectors.contains(&Symbol::StepVelocity(0)) {
            vectors.extend([Symbol::Q0(0), Symbol::Q1(0)]);
        }
        for vector in vectors {
            self.vectors.insert(vector.clone(), self.names.vector(&vector));
        }
        let arrays = self.vectors.iter().filter_map(|(vector, name)| {
            let Symbol::Parameter { index, .. } = vector else { return None };
            let field = &self.model.parameters[*index].name;
            Some(quote!(let #name = &self.#field;))
        });
        let arrays: TokenStream = arrays.collect();
        self.name_inputs(needed, velocity);
        let (first, last) = loops.singles();
        for id in first {
            self.write(id);
        }
        let before = self.statements(None, usize::MAX);
        let (vectors, singles) = (&self.vectors, &self.written);
        let PrintedLoops { statements, members, folds } =
            loops.write(LoopContext { vectors, singles, names: &mut self.names });
        self.statements.clear();
        self.written.extend(members.iter().map(|(id, member)| (*id, member.array.entry(None, member.place))));
        (self.members, self.folds) = (members, folds);
        for id in last {
            self.write(id);
        }
        let after = self.statements(None, usize::MAX);
        self.body(quote!(let real = T::real; #arrays #before #statements #after))
    }
}

impl Printer<'_> {
    /// Names the inputs before shared terms, in the order of the symbols.
    fn name_inputs(&mut self, needed: &[OperationId], velocity: VelocityFrom) {
        let mut symbols = BTreeSet::new();
        for id in needed {
            let Operation::Input(symbol) = self.function.operations.get(*id) else { continue };
            if let (Symbol::StepVelocity(index), VelocityFrom::Interval) = (symbol, velocity) {
                symbols.extend([Symbol::Step, Symbol::Q0(*index), Symbol::Q1(*index)]);
            }
            if !matches!(symbol, Symbol::Parameter { .. }) {
                symbols.insert(symbol.clone());
            }
        }
        for symbol in symbols {
            if self.component(&symbol).is_none() {
                let ident = self.names.of(&symbol);
                self.inputs.insert(symbol, ident);
            }
        }
    }

    /// A component of a vector that the body reads as a whole.
    fn component(&self, symbol: &Symbol) -> Option<Formula> {
        let (vector, index) = symbol.component()?;
        let (name, index) = (self.vectors.get(&vector)?, Literal::usize_unsuffixed(index));
        Some(Formula::atom(quote!(#name[#index]), 0))
    }

    /// The formula of an operation whose operands are printed.
    fn formula(&mut self, id: OperationId, operation: &Operation) -> Formula {
        if let Some((start, text)) = self.folds.get(&id) {
            return text.from(&self.operand(*start));
        }
        let together = match operation {
            Operation::Input(Symbol::Parameter { index, .. }) => {
                let system = if self.in_pieces { format_ident!("system") } else { format_ident!("self") };
                return Formula::parameter(&system, &self.model.parameters[*index]);
            }
            Operation::Input(symbol) => {
                return self.component(symbol).unwrap_or_else(|| {
                    let name = self.names.of(symbol);
                    self.named.insert(id, name.clone());
                    Formula::name(&name)
                });
            }
            Operation::Call(function @ (Elementary::Sin | Elementary::Cos), angle) => self.sine(id, *function, *angle),
            Operation::Opaque(..) => self.derivatives(id),
            _ => None,
        };
        together.unwrap_or_else(|| Formula::of(operation, &mut |operand| self.operand(operand)))
    }

    fn write(&mut self, id: OperationId) {
        let operation = self.function.operations.get(id).clone();
        let formula = self.formula(id, &operation);
        if self.written.contains(id) {
            return;
        }
        let uses = self.uses.get(id).copied().unwrap_or(0);
        let shared = uses > 1 && formula.operations > 0;
        // A long formula gets its own line. In pieces a result needs a name, because it leaves its piece.
        let line = match (self.results.contains(id), self.in_pieces) {
            (true, true) => 0,
            (true, false) => usize::MAX,
            (false, _) => LINE,
        };
        let long = formula.operations > line;
        let name = match self.function.operations.name(id) {
            Some(symbol) => Some(self.names.of(symbol)),
            None if shared || long => Some(self.names.next_shared()),
            None => None,
        };
        let formula = match name {
            Some(name) => {
                let (tokens, operands) = (formula.tokens(), operation.operands().collect::<Vec<_>>());
                self.state(&[(id, name.clone())], &operands, formula.operations, quote!(let #name = #tokens;));
                Formula::name(&name)
            }
            None => formula,
        };
        self.written.insert(id, formula);
    }

    /// Computes sine and cosine of one angle together, and those of independent angles in one group.
    fn sine(&mut self, id: OperationId, function: Elementary, angle: OperationId) -> Option<Formula> {
        if let Some(written) = self.written.get(id) {
            return Some(written.clone());
        }
        let angles = self.angles.with(angle);
        let needed = |this: &Self, function, angle| {
            let call = this.function.operations.find(&Operation::Call(function, angle));
            call.filter(|call| this.uses.contains(*call))
        };
        let other = if function == Elementary::Sin { Elementary::Cos } else { Elementary::Sin };
        if angles.len() == 1 && needed(self, other, angle).is_none() {
            return None;
        }
        let (mut binds, mut pairs, mut operations) = (Vec::new(), Vec::new(), 0);
        for angle in &angles {
            let (sine, cosine) = self.names.next_sine();
            let pair = [(Elementary::Sin, sine), (Elementary::Cos, cosine)].map(|(function, name)| {
                let Some(call) = needed(self, function, *angle) else { return quote!(_) };
                operations += 1;
                binds.push((call, name.clone()));
                quote!(#name)
            });
            let [sine, cosine] = pair;
            pairs.push(quote!((#sine, #cosine)));
        }
        let arguments: Vec<Formula> = angles.iter().map(|angle| self.operand(*angle)).collect();
        operations += arguments.iter().map(|argument| argument.operations).sum::<usize>();
        let tokens = if let ([argument], [pair]) = (&arguments[..], &pairs[..]) {
            let receiver = argument.receiver();
            quote!(let #pair = #receiver.sin_cos();)
        } else {
            let arguments = arguments.iter().map(Formula::tokens);
            quote!(let [#(#pairs),*] = T::sin_cos_each([#(#arguments),*]);)
        };
        self.state(&binds, &angles, operations, tokens);
        self.written.extend(binds.iter().map(|(call, name)| (*call, Formula::name(name))));
        self.written.get(id).cloned()
    }

    /// Computes all needed derivatives of one function at the same arguments together.
    fn derivatives(&mut self, id: OperationId) -> Option<Formula> {
        if let Some(written) = self.written.get(id) {
            return Some(written.clone());
        }
        let group = self.calls.with(id).to_vec();
        let mut bound = Vec::new();
        let (mut binds, mut operands) = (Vec::new(), Vec::new());
        for call in group {
            let Operation::Opaque(function, arguments) = self.function.operations.get(call) else { continue };
            let name = self.names.next_shared();
            bound.push((function.clone(), name.clone()));
            binds.push((call, name));
            operands.clone_from(arguments);
        }
        let arguments: Vec<Formula> = operands.iter().map(|argument| self.operand(*argument)).collect();
        let operations = bound.len() + arguments.iter().map(|argument| argument.operations).sum::<usize>();
        let statement = functions::statement(&bound, &arguments)?;
        self.state(&binds, &operands, operations, statement);
        self.written.extend(binds.iter().map(|(call, name)| (*call, Formula::name(name))));
        self.written.get(id).cloned()
    }

    /// A statement that binds operations to a value computed from these operands.
    fn state(
        &mut self,
        binds: &[(OperationId, Ident)],
        operands: &[OperationId],
        operations: usize,
        tokens: TokenStream,
    ) {
        let mut reads = Vec::new();
        if self.in_pieces {
            let mut open = operands.to_vec();
            while let Some(operand) = open.pop() {
                if self.named.contains(operand) {
                    reads.push(operand);
                } else {
                    open.extend(self.function.operations.get(operand).operands());
                }
            }
        }
        self.named.extend(binds.iter().cloned());
        self.statements.push(Statement { binds: binds.iter().map(|(id, _)| *id).collect(), reads, operations, tokens });
    }

    /// The statements, in pieces if there are too many operations.
    fn statements(&mut self, prelude: Option<&TokenStream>, limit: usize) -> TokenStream {
        if !self.in_pieces {
            return self.statements.iter().map(|statement| &statement.tokens).cloned().collect();
        }
        let operations = &self.function.operations;
        let inputs =
            self.inputs.keys().filter_map(|symbol| operations.find(&Operation::Input(symbol.clone()))).collect();
        let results = self.function.results.entries().copied().collect();
        let (system, function) = (&self.model.name, self.function.id.name());
        let writing = PieceContext { inputs, results, system, function, prelude, named: &self.named };
        let pieces = pieces(&self.statements, limit, &writing, &mut self.names);
        self.written.extend(pieces.results.into_iter().map(|(id, place)| (id, Formula::atom(place, 0))));
        pieces.statements
    }

    fn operand(&self, id: OperationId) -> Formula {
        self.written.get(id).cloned().unwrap_or_else(|| {
            // Operands precede results, so this branch is a constant or unreachable.
            Formula::of(self.function.operations.get(id), &mut |inner| self.operand(inner))
        })
    }

    fn result(&self, id: OperationId) -> ResultEntry {
        let (formula, member) = (self.operand(id), self.members.get(&id).cloned());
        ResultEntry { id, formula, member, zero: self.function.operations.as_constant(id) == Some(0.0) }
    }
}

/// Binds the components of vector inputs: `let [x, y]: [T; 2] = (*q).into();`, `_` for unread ones; or the whole
/// vector.
pub(super) fn parts(body: &Body, model: &Model, symbol: impl Fn(usize) -> Symbol, vector: &TokenStream) -> TokenStream {
    if let Some(name) = body.vectors.get(&symbol(0)) {
        return quote!(let #name = &#vector.data.0[0];);
    }
    let dimension = Literal::usize_unsuffixed(model.dimension());
    let names: Vec<Option<&Ident>> = (0..model.dimension()).map(|index| body.inputs.get(&symbol(index))).collect();
    if names.iter().all(Option::is_none) {
        return TokenStream::new();
    }
    let names = names.into_iter().map(|name| name.map_or_else(|| quote!(_), |name| quote!(#name)));
    quote!(let [#(#names),*]: [T; #dimension] = #vector.into();)
}

/// Binds a scalar input: `let t0 = node.t;`.
pub(super) fn part(body: &Body, symbol: &Symbol, value: &TokenStream) -> TokenStream {
    body.inputs.get(symbol).map(|name| quote!(let #name = #value;)).unwrap_or_default()
}

/// Binds components of `q`, of `v` and, if read, of the accelerations.
pub(super) fn state_parts(body: &Body, model: &Model) -> TokenStream {
    let velocity = |index| Symbol::Continuous(Variable::Velocity(index));
    let coordinate = |index| Symbol::Continuous(Variable::Coordinate(index));
    let acceleration =
        parts(body, model, Symbol::Acceleration, &quote!(::vi_core::Lagrangian::acceleration(self, t, q, v)?));
    let velocities = parts(body, model, velocity, &quote!((*v)));
    let coordinates = parts(body, model, coordinate, &quote!((*q)));
    quote!(#acceleration #velocities #coordinates)
}
