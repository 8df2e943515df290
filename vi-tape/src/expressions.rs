//! Expressions of a system along a motion.
//!
//! In: the text of a system; for [`Expressions`], [`Observable`] and [`Smooth`] further expressions in its names, for [`Terms`] the summands of its L. Out:
//! their values at one point of a motion after the other. Tables are evaluated as by every method.

use crate::compile::parsed;
use crate::mistakes::Mistakes;
use crate::tables::Tables;
use proc_macro2::{Delimiter, Group, TokenStream, TokenTree};
use vi_codegen::model::{Model, check, rate};
use vi_codegen::symbol::{Symbol, Variable};
use vi_codegen::syntax::{self, parse};
use vi_codegen::terms::{self, Term};
use vi_erased::function::{Function, Points};
use vi_expr::{Expr, Opaque, Pool};

/// A point of a motion.
#[derive(Clone, Copy, Debug, Default)]
pub struct Moment<'a> {
    /// The time.
    pub t: f64,
    /// The coordinates.
    pub q: &'a [f64],
    /// The velocities.
    pub v: &'a [f64],
    /// The accelerations, which only forces of terms need.
    pub a: &'a [f64],
    /// The values of the parameters, in the order of the system.
    pub parameters: &'a [f64],
}

/// A text that was read, and its expressions.
struct Source {
    system: syntax::System,
    model: Model,
    of: Pooled,
}

/// Expressions with the tables that they call.
struct Pooled {
    pool: Pool<Symbol>,
    tables: Tables,
}

impl Source {
    fn of(text: &str, files: &[(String, String)]) -> Result<Self, Mistakes> {
        let system = parsed("definition", text, files)?.system;
        let wrong = |error: syn::Error| Mistakes::wrong("definition", text, &error);
        let (pool, model) = vi_codegen::checked(&system, 0).map_err(wrong)?;
        let compiled = || Mistakes::compiled(&model.name.to_string(), "Rust functions");
        let tables = Tables::of(&model).ok_or_else(compiled)?;
        Ok(Self { system, model, of: Pooled { pool, tables } })
    }
}

impl Pooled {
    fn values(&self, exprs: &[Expr], at: &Moment<'_>) -> Vec<f64> {
        let entry = |of: &[f64], index: usize| of.get(index).copied().unwrap_or(f64::NAN);
        let mut symbol = |symbol: &Symbol| match symbol {
            Symbol::Parameter { index, .. } => entry(at.parameters, *index),
            Symbol::Continuous(Variable::Time) => at.t,
            Symbol::Continuous(Variable::Coordinate(index)) => entry(at.q, *index),
            Symbol::Continuous(Variable::Velocity(index)) => entry(at.v, *index),
            Symbol::Acceleration(index) => entry(at.a, *index),
            _ => f64::NAN,
        };
        self.pool.evaluate_with(exprs, &mut symbol, &|function, arguments| self.table(function, arguments))
    }

    /// The value of a derivative of a table; behind its arguments are the values of a table of parameters.
    fn table(&self, of: &Opaque, arguments: &[f64]) -> f64 {
        let Some(place) = self.tables.place(&of.name) else { return f64::NAN };
        let orders = [of.orders[0], of.orders[1]].map(usize::from);
        let (own, values) = arguments.split_at(of.arity.min(arguments.len()));
        let point = [0, 1].map(|index| own.get(index).copied().unwrap_or(0.0));
        self.tables.all[usize::from(place)].derivative(orders, point, values)
    }
}

/// Expressions of the time and the coordinates of a system.
pub struct Expressions {
    of: Pooled,
    values: Vec<Expr>,
    rates: Vec<Expr>,
}

impl Expressions {
    /// Expressions in the names of the system of a text: its coordinates, parameters, `let`s, functions and tables. Each
    /// has a name for messages.
    ///
    /// # Errors
    /// The mistakes of the text or of the first wrong expression; an expression with velocities.
    pub fn parse(text: &str, written: &[(&str, &str)]) -> Result<Self, Mistakes> {
        let Source { system, mut of, .. } = Source::of(text, &[])?;
        let mut values = Vec::with_capacity(written.len());
        for (name, expression) in written {
            let wrong = |error: syn::Error| Mistakes::wrong(name, expression, &error);
            let written = alone(expression).map_err(wrong)?;
            values.push(check::number_expression(&mut of.pool, &system, &written).map_err(wrong)?);
        }
        let moves = |symbol: &Symbol| matches!(symbol, Symbol::Continuous(Variable::Velocity(_)));
        if let Some((_, (name, _))) = values.iter().zip(written).find(|(value, _)| of.pool.depends_on(**value, &moves))
        {
            let text =
                format!("error: the expression of `{name}` has velocities\n = help: write it by coordinates alone");
            return Err(Mistakes::of(&text));
        }
        let rates = values.iter().map(|value| rate(&mut of.pool, *value)).collect();
        Ok(Self { of, values, rates })
    }

    /// The values at a point.
    #[must_use]
    pub fn values(&self, at: &Moment<'_>) -> Vec<f64> {
        self.of.values(&self.values, at)
    }

    /// The rates of change at a point, by its velocities.
    #[must_use]
    pub fn rates(&self, at: &Moment<'_>) -> Vec<f64> {
        self.of.values(&self.rates, at)
    }
}

/// A function of the time, the coordinates and the velocities of a system: a number, a vector or a matrix.
pub struct Observable {
    of: Pooled,
    coordinates: usize,
    shape: Vec<usize>,
    entries: Vec<Expr>,
}

impl Observable {
    /// An expression in the names of the system of a text, as for [`Expressions`]; `files` has the texts of files of tables.
    ///
    /// # Errors
    /// The mistakes of the text or of the expression.
    pub fn parse(text: &str, files: &[(String, String)], expression: &str) -> Result<Self, Mistakes> {
        let Source { system, model, mut of } = Source::of(text, files)?;
        let wrong = |error: syn::Error| Mistakes::wrong("expression", expression, &error);
        let written = alone(expression).map_err(wrong)?;
        let (shape, entries) = check::shaped_expression(&mut of.pool, &system, &written).map_err(wrong)?;
        Ok(Self { of, coordinates: model.dimension(), shape, entries })
    }

    /// Its derivatives, with a further last axis: with respect to t, the coordinates, the velocities, and the parameters of
    /// these indices. Those with respect to the values of a table are NaN.
    #[must_use]
    pub fn derivatives(mut self, parameters: &[usize]) -> Self {
        let state =
            (0..self.coordinates).map(Variable::Coordinate).chain((0..self.coordinates).map(Variable::Velocity));
        let state = [Variable::Time].into_iter().chain(state).map(Symbol::Continuous);
        let is = |symbol: &Symbol, wanted: usize| matches!(symbol, Symbol::Parameter { index, .. } if *index == wanted);
        let mut slopes = Vec::new();
        for entry in &self.entries {
            let pool = &mut self.of.pool;
            for variable in state.clone() {
                slopes.push(pool.partial_derivative(*entry, &variable));
            }
            for index in parameters {
                slopes.push(pool.derivative(*entry, &mut |pool, symbol| {
                    if is(symbol, *index) { pool.one() } else { pool.zero() }
                }));
            }
        }
        self.shape.push(1 + 2 * self.coordinates + parameters.len());
        Self { entries: slopes, ..self }
    }

    /// The lengths of a vector or a matrix; none of a number.
    #[must_use]
    pub fn shape(&self) -> &[usize] {
        &self.shape
    }

    /// Whether each entry is zero at every point.
    #[must_use]
    pub fn zeros(&self) -> Vec<bool> {
        let zero = self.of.pool.zero();
        self.entries.iter().map(|entry| *entry == zero).collect()
    }

    /// The entries at a point, row by row; NaN if they have no value.
    #[must_use]
    pub fn values(&self, at: &Moment<'_>) -> Vec<f64> {
        self.of.values(&self.entries, at)
    }
}

/// A number of the time, the coordinates, the velocities and some inputs, with its first and second derivatives: a cost or
/// a condition of optimal control.
pub struct Smooth {
    /// The value, the derivatives, the second derivatives.
    orders: [Observable; 3],
    is_of_inputs: bool,
}

impl Smooth {
    /// An expression as for [`Observable`]; `inputs` are the indices of the parameters that vary.
    ///
    /// # Errors
    /// As [`Observable::parse`]; a vector or a matrix.
    pub fn parse(text: &str, files: &[(String, String)], expression: &str, inputs: &[usize]) -> Result<Self, Mistakes> {
        let [value, first, second] = [(); 3].map(|()| Observable::parse(text, files, expression));
        let value = value?;
        if !value.shape().is_empty() {
            let shape = value.shape();
            return Err(Mistakes::of(&format!(
                "error: `{expression}` has the shape {shape:?}\n = help: write a number, such as one of its entries"
            )));
        }
        let first = first?.derivatives(inputs);
        let is_of_inputs = first.zeros()[..=2 * first.coordinates].iter().all(|is_zero| *is_zero);
        Ok(Self { orders: [value, first, second?.derivatives(inputs).derivatives(inputs)], is_of_inputs })
    }
}

impl Function for Smooth {
    fn at(&self, points: &Points<'_>, order: u8) -> Vec<f64> {
        let of = &self.orders[usize::from(order.min(2))];
        let (n, count) = (of.coordinates, points.parameters.len().checked_div(points.t.len()).unwrap_or(0));
        let moments = points.t.iter().enumerate().map(|(k, t)| Moment {
            t: *t,
            q: &points.q[k * n..(k + 1) * n],
            v: &points.v[k * n..(k + 1) * n],
            parameters: &points.parameters[k * count..(k + 1) * count],
            ..Moment::default()
        });
        moments.flat_map(|at| of.values(&at)).collect()
    }

    fn is_of_inputs(&self) -> bool {
        self.is_of_inputs
    }
}

/// An expression by itself.
fn alone(text: &str) -> syn::Result<syntax::Expression> {
    let head: TokenStream = "struct Alone".parse()?;
    let mut clause: TokenStream = "let alone =".parse()?;
    // The parser reads one clause, so that a `;` in the text ends it too early.
    clause.extend(text.parse::<TokenStream>()?);
    clause.extend(";".parse::<TokenStream>()?);
    let body = TokenTree::Group(Group::new(Delimiter::Brace, clause));
    let mut system = parse::system(head.into_iter().chain([body]).collect())?;
    let mut lets = system.definitions.remove(&syntax::Defining::Let).unwrap_or_default().into_iter();
    match (lets.next(), lets.next()) {
        (Some(only), None) => Ok(only.value),
        _ => Err(syn::Error::new(proc_macro2::Span::call_site(), "expected one expression")),
    }
}

/// The summands of L.
pub struct Terms {
    of: Pooled,
    model: Model,
    summands: Vec<Term>,
    operations: usize,
}

impl Terms {
    /// The summands of L of the system of a text.
    ///
    /// # Errors
    /// The mistakes of the text; a system that is too large.
    pub fn of(text: &str) -> Result<Self, Mistakes> {
        let Source { mut model, mut of, .. } = Source::of(text, &[])?;
        let wrong = |error: syn::Error| Mistakes::wrong("definition", text, &error);
        let operations = terms::operations(&mut of.pool, &mut model).map_err(wrong)?;
        let summands = terms::terms(&mut of.pool, &mut model).map_err(wrong)?;
        Ok(Self { of, model, summands, operations })
    }

    /// Each summand as text, and the operations of the equations of motion at one point that it costs.
    pub fn costs(&self) -> impl Iterator<Item = (String, Option<usize>)> {
        self.summands.iter().map(|term| {
            let text = self.of.pool.render(term.value, &|symbol| self.model.spell(symbol));
            (text, term.operations_without.map(|without| self.operations.saturating_sub(without)))
        })
    }

    /// The force `T_q − d/dt T_v` and the energy `v·T_v − T` of each summand T at a point.
    #[must_use]
    pub fn at(&self, at: &Moment<'_>) -> Vec<(Vec<f64>, f64)> {
        let exprs: Vec<Expr> =
            self.summands.iter().flat_map(|of| of.force.iter().copied().chain([of.energy])).collect();
        let values = self.of.values(&exprs, at);
        let each = values.chunks_exact(self.model.dimension() + 1);
        each.map(|of| (of[..of.len() - 1].to_vec(), of[of.len() - 1])).collect()
    }
}

/// The operations of the equations of motion of the system of a text at one point.
///
/// # Errors
/// The mistakes of the text; a system that is too large.
pub fn operations(text: &str) -> Result<usize, Mistakes> {
    let Source { mut model, mut of, .. } = Source::of(text, &[])?;
    let wrong = |error: syn::Error| Mistakes::wrong("definition", text, &error);
    terms::operations(&mut of.pool, &mut model).map_err(wrong)
}
