//! Fields: partial derivatives of L and f at the points of a rule, and the chain rule through them.
//!
//! In: L and f. Out: the requested partial derivatives, and total derivatives of expressions that contain fields:
//!
//! ```text
//! d/dx F(t_k, q_k, v_k) = F_t dt_k/dx + Σ_i F_{q_i} dq_{k,i}/dx + Σ_i F_{v_i} dv_{k,i}/dx
//! ```
//!
//! A partial derivative that depends on parameters only is inlined, so that zeros and constants simplify at once.
//! The variables of each partial derivative are recorded: most derivatives in a long chain are zero and are never
//! computed.

use crate::model::{Model, Point};
use crate::symbol::{Field, Quantity, Symbol, Variable};
use std::collections::BTreeSet;
use vi_expr::{Distinct, Expr, Pool};

/// Cost of looking up a partial derivative.
const LOOKED_UP: usize = 8;

/// Partial derivatives of L and f in `(t, q, v)`.
pub struct Fields {
    /// Keys: the quantity and the variables of differentiation, in ascending order.
    known: Distinct<(Quantity, Vec<Variable>)>,
    definitions: Vec<Definition>,
    zero: Definition,
}

/// A partial derivative with the variables that it depends on.
struct Definition {
    expr: Expr,
    variables: Variables,
}

impl Definition {
    fn new(pool: &Pool<Symbol>, expr: Expr) -> Self {
        let mut variables = Variables::default();
        for symbol in pool.reachable(&[expr]).into_iter().filter_map(|expr| pool.as_symbol(expr)) {
            if let Symbol::Continuous(variable) = symbol {
                variables.insert(variable);
            }
        }
        Self { expr, variables }
    }
}

/// A set of variables, one bit each. A dense system has as many sets as pairs of coordinates.
#[derive(Clone, Default)]
pub(super) struct Variables(Vec<u64>);

impl Variables {
    /// Word and bit of a variable.
    fn place(variable: &Variable) -> (usize, u64) {
        let number = match variable {
            Variable::Time => 0,
            Variable::Coordinate(index) => 2 * index + 1,
            Variable::Velocity(index) => 2 * index + 2,
        };
        (number / 64, 1 << (number % 64))
    }

    fn insert(&mut self, variable: &Variable) {
        let (word, bit) = Self::place(variable);
        if word >= self.0.len() {
            self.0.resize(word + 1, 0);
        }
        self.0[word] |= bit;
    }

    pub(super) fn contains(&self, variable: &Variable) -> bool {
        let (word, bit) = Self::place(variable);
        self.0.get(word).is_some_and(|word| word & bit != 0)
    }

    fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    fn extend(&mut self, others: &Self) {
        let length = self.0.len().max(others.0.len());
        self.0.resize(length, 0);
        for (word, other) in self.0.iter_mut().zip(&others.0) {
            *word |= other;
        }
    }
}

/// Derivatives of the arguments of each point with respect to one variable; only nonzero ones.
pub(super) type Changes = Vec<Vec<(Variable, Expr)>>;

impl Fields {
    /// L and f themselves.
    pub(super) fn new(pool: &Pool<Symbol>, model: &Model) -> Self {
        let forces = model.forces.iter().enumerate().map(|(index, force)| (Quantity::Force(index), *force));
        let zero = Definition::new(pool, pool.zero());
        let mut fields = Self { known: Distinct::default(), definitions: Vec::new(), zero };
        for (quantity, expr) in forces.chain([(Quantity::Lagrangian, model.lagrangian)]) {
            fields.known.insert((quantity, Vec::new()));
            fields.definitions.push(Definition::new(pool, expr));
        }
        fields
    }

    /// A partial derivative of L in `(t, q, v)` with respect to these variables, in any order.
    pub(super) fn lagrangian(&mut self, pool: &mut Pool<Symbol>, by: &[Variable]) -> Expr {
        let mut derivatives = by.to_vec();
        derivatives.sort_unstable();
        self.defined(pool, Quantity::Lagrangian, &derivatives).expr
    }

    /// A partial derivative of the force of a coordinate in `(t, q, v)`.
    pub(super) fn force(&mut self, pool: &mut Pool<Symbol>, coordinate: usize, by: Variable) -> Expr {
        self.defined(pool, Quantity::Force(coordinate), &[by]).expr
    }

    /// The variables of a first partial derivative of L.
    pub(super) fn variables(&mut self, pool: &mut Pool<Symbol>, by: Variable) -> Variables {
        self.defined(pool, Quantity::Lagrangian, &[by]).variables.clone()
    }

    /// A partial derivative, cached unless it is zero; `derivatives` are ascending.
    fn defined(&mut self, pool: &mut Pool<Symbol>, quantity: Quantity, derivatives: &[Variable]) -> &Definition {
        pool.spend(LOOKED_UP);
        let key = (quantity, derivatives.to_vec());
        if let Some(place) = self.known.get_index_of(&key) {
            return &self.definitions[place];
        }
        // Differentiates by the last variable first, since the lower derivative is cached too.
        let Some((last, basic)) = derivatives.split_last() else { return &self.zero };
        let basic = self.defined(pool, quantity, basic);
        if !basic.variables.contains(last) {
            return &self.zero;
        }
        let derived = pool.partial_derivative(basic.expr, &Symbol::Continuous(*last));
        let place = self.known.insert_full(key).0;
        self.definitions.push(Definition::new(pool, derived));
        &self.definitions[place]
    }

    /// The first partial derivative of L or of a force that has no value in any state: quantity, expression, last
    /// variable.
    pub(super) fn undefined(&self, pool: &Pool<Symbol>) -> Option<(Quantity, Expr, Variable)> {
        let place = self.definitions.iter().position(|definition| pool.is_undefined(definition.expr))?;
        let (quantity, derivatives) = self.known.get_index(place)?;
        let (last, basic) = derivatives.split_last()?;
        let basic = self.known.get_index_of(&(*quantity, basic.to_vec()))?;
        Some((*quantity, self.definitions.get(basic)?.expr, *last))
    }

    fn known(&self, field: &Field) -> Option<&Definition> {
        let place = self.known.get_index_of(&(field.quantity, field.derivatives.clone()))?;
        self.definitions.get(place)
    }

    /// The definition of a field in `(t, q, v)`.
    #[must_use]
    pub fn definition(&self, field: &Field) -> Option<Expr> {
        self.known(field).map(|definition| definition.expr)
    }

    /// A partial derivative at a point: a field, or its value if that depends on parameters only.
    fn at_point(&mut self, pool: &mut Pool<Symbol>, field: Field) -> Expr {
        let value = self.defined(pool, field.quantity, &field.derivatives);
        if value.variables.is_empty() { value.expr } else { pool.symbol(Symbol::Field(field)) }
    }

    /// The variables of the fields among these symbols, per point.
    pub(super) fn read(&self, symbols: &BTreeSet<Symbol>, points: usize) -> Vec<Variables> {
        let mut read = vec![Variables::default(); points];
        for symbol in symbols {
            if let Symbol::Field(field) = symbol
                && let Some(definition) = self.known(field)
            {
                read[field.point].extend(&definition.variables);
            }
        }
        read
    }

    /// Inlines the fields of an expression that depend on parameters only.
    pub(super) fn inline_constants(&mut self, pool: &mut Pool<Symbol>, expr: Expr) -> Expr {
        pool.substitute(expr, &mut |pool, symbol| match symbol {
            Symbol::Field(field) => Some(self.at_point(pool, field.clone())),
            _ => None,
        })
    }

    /// The total derivative of an expression. The variable changes symbols by `direct` and points by `changes`.
    pub(super) fn derivative(
        &mut self,
        pool: &mut Pool<Symbol>,
        expr: Expr,
        direct: &dyn Fn(&mut Pool<Symbol>, &Symbol) -> Expr,
        changes: &Changes,
    ) -> Expr {
        pool.derivative(expr, &mut |pool, symbol| {
            let Symbol::Field(field) = symbol else {
                return direct(pool, symbol);
            };
            let variables = self.defined(pool, field.quantity, &field.derivatives).variables.clone();
            let terms: Vec<Expr> = changes[field.point]
                .iter()
                .filter(|(variable, _)| variables.contains(variable))
                .map(|(variable, change)| {
                    let mut derivatives = field.derivatives.clone();
                    derivatives.push(*variable);
                    derivatives.sort_unstable();
                    let partial = self.at_point(pool, Field { derivatives, ..field.clone() });
                    pool.mul(partial, *change)
                })
                .collect();
            pool.sum(&terms)
        })
    }
}

/// The arguments of a point with their symbols. Most contain one coordinate only.
pub(super) struct Arguments(Vec<(Variable, Expr, BTreeSet<Symbol>)>);

impl Arguments {
    /// The arguments of each point.
    pub(super) fn of(pool: &Pool<Symbol>, points: &[Point]) -> Vec<Self> {
        let of_point = |point: &Point| {
            let arguments = point.arguments();
            Self(arguments.map(|(variable, argument)| (variable, argument, pool.symbols(argument))).collect())
        };
        points.iter().map(of_point).collect()
    }
}

/// Derivatives of the arguments of the points with respect to one variable, which changes symbols by `direct`.
pub(super) fn changes(
    pool: &mut Pool<Symbol>,
    arguments: &[Arguments],
    direct: &dyn Fn(&mut Pool<Symbol>, &Symbol) -> Expr,
) -> Changes {
    arguments
        .iter()
        .map(|Arguments(arguments)| {
            let mut found = Vec::new();
            for (variable, argument, symbols) in arguments {
                let zero = pool.zero();
                if symbols.iter().all(|symbol| direct(pool, symbol) == zero) {
                    continue;
                }
                let (variable, argument) = (*variable, *argument);
                let change = pool.derivative(argument, &mut |pool, symbol| direct(pool, symbol));
                if !pool.is_zero(change) {
                    found.push((variable, change));
                }
            }
            found
        })
        .collect()
}
