//! The body of a loop: expressions for all its instances.
//!
//! In: the expressions of the instances. Out: a [`Body`] with what it reads, and its values and derivatives as
//! operations, which share their parts. Instances with the same body have the same expression in the numbers that they read, in the order of the
//! arrays and of their places.

use crate::program::{Function, alone};
use crate::symbol::{Symbol, Variable};
use std::collections::BTreeMap;
use vi_expr::{Expr, Pool, Rational};

/// An array from which a body reads a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Read {
    /// A coordinate.
    Coordinate,
    /// A velocity.
    Velocity,
    /// An entry of an array of `let`s.
    Let(usize),
    /// The rate of an entry of an array of `let`s.
    LetRate(usize),
    /// An entry of the array of parameters whose first entry has this index.
    Parameter(usize),
    /// The place itself, as a number.
    Number,
    /// A constraint: the place of a sum, which no body reads.
    Constraint,
    /// A part of the time scale.
    Part,
}

impl Read {
    /// Whether it depends on the state.
    #[must_use]
    pub fn is_of_state(self) -> bool {
        !matches!(self, Self::Parameter(_) | Self::Number | Self::Constraint)
    }

    /// Whether it is an entry of an array of `let`s, or its rate.
    #[must_use]
    pub fn is_entry(&self) -> bool {
        matches!(self, Self::Let(_) | Self::LetRate(_))
    }

    /// Whether it is a velocity or the rate of an entry.
    #[must_use]
    pub fn is_rate(&self) -> bool {
        matches!(self, Self::Velocity | Self::LetRate(_))
    }

    /// The array of a symbol, and the place in it.
    pub(super) fn of(symbol: &Symbol) -> Option<(Self, usize)> {
        match symbol {
            Symbol::Continuous(Variable::Coordinate(index)) => Some((Self::Coordinate, *index)),
            Symbol::Continuous(Variable::Velocity(index)) => Some((Self::Velocity, *index)),
            Symbol::Let(entry) => Some((Self::Let(entry.array), entry.entry)),
            Symbol::LetRate(entry) => Some((Self::LetRate(entry.array), entry.entry)),
            Symbol::Parameter { index, array: Some(first) } => Some((Self::Parameter(*first), index - first)),
            _ => None,
        }
    }
}

/// The expression of a body in the numbers that it reads, the time and parameters.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct Shape {
    pub(super) value: Expr,
    pub(super) reads: Vec<Read>,
}

/// Values that are computed together, for all instances.
pub struct Body {
    /// The arrays that it reads.
    pub reads: Vec<Read>,
    /// The values.
    pub values: Vec<Value>,
    /// For each value: it, its derivative with respect to time, and those with respect to the numbers of the state that it
    /// reads.
    pub slopes: Function,
    /// For each value: the derivatives with respect to these numbers, and second derivatives. `None` for a force.
    pub curvatures: Option<Function>,
}

/// A value of a body.
pub struct Value {
    /// It, by [`Symbol::Access`], the time and parameters.
    pub expr: Expr,
    /// The numbers of the state that it reads: places in [`Body::reads`].
    pub states: Vec<usize>,
    /// The place of the value among the slopes; the derivative with respect to time and those with respect to `states`
    /// follow.
    pub first_slope: usize,
    /// Whether the derivative with respect to time is not zero.
    pub varies: bool,
    /// The numbers of the state with derivative 1.
    pub units: Vec<bool>,
    /// The place of the first derivative among the curvatures.
    pub first_curvature: usize,
    /// Places in `states` of the second derivatives that are not zero; they follow the first derivatives.
    pub pairs: Vec<[usize; 2]>,
}

/// An instance of a body.
pub(super) struct Instance {
    pub(super) shape: Shape,
    /// The places of the numbers in their arrays.
    pub(super) columns: Vec<usize>,
}

impl Instance {
    /// The shape of an expression, and what this instance reads.
    pub(super) fn of(pool: &mut Pool<Symbol>, expr: Expr) -> Self {
        let symbols = pool.symbols(expr).into_iter();
        let mut found: Vec<_> = symbols.filter_map(|symbol| Some((Read::of(&symbol)?, symbol))).collect();
        found.sort_unstable();
        let places: BTreeMap<&Symbol, usize> =
            found.iter().zip(0..).map(|((_, symbol), place)| (symbol, place)).collect();
        let value = pool.substitute(expr, &mut |pool, symbol| {
            let place = places.get(symbol)?;
            Some(pool.symbol(Symbol::Access(*place)))
        });
        let (reads, columns) = found.iter().map(|(read, _)| *read).unzip();
        Self { shape: Shape { value, reads }, columns }
    }
}

impl Body {
    /// Whether it reads entries of arrays of `let`s.
    #[must_use]
    pub fn reads_entries(&self) -> bool {
        self.reads.iter().any(Read::is_entry)
    }

    /// Whether it reads velocities or rates of entries.
    pub(super) fn moves(&self) -> bool {
        self.reads.iter().any(Read::is_rate)
    }

    /// Derives the values, once or twice. `None` if that is too much work, or a derivative has no value.
    pub(super) fn of(pool: &mut Pool<Symbol>, reads: Vec<Read>, exprs: &[Expr], twice: bool) -> Option<Self> {
        let (mut values, mut slopes, mut curvatures) = (Vec::new(), Vec::new(), Vec::new());
        for expr in exprs.iter().copied() {
            let symbols = pool.symbols(expr);
            let is_read = |place: &usize| reads[*place].is_of_state() && symbols.contains(&Symbol::Access(*place));
            let states: Vec<usize> = (0..reads.len()).filter(is_read).collect();
            let by_time = pool.partial_derivative(expr, &Symbol::Continuous(Variable::Time));
            let by_state: Vec<Expr> = states.iter().map(|place| slope(pool, expr, *place)).collect();
            let (first_slope, first_curvature) = (slopes.len(), curvatures.len());
            let (mut pairs, mut seconds) = (Vec::new(), Vec::new());
            for row in (0..states.len()).filter(|_| twice) {
                for (column, state) in states.iter().enumerate().skip(row) {
                    let second = slope(pool, by_state[row], *state);
                    if !pool.is_zero(second) {
                        pairs.push([row, column]);
                        seconds.push(second);
                    }
                }
            }
            let one = pool.one();
            values.push(Value {
                expr,
                varies: !pool.is_zero(by_time),
                units: by_state.iter().map(|slope| *slope == one).collect(),
                states,
                first_slope,
                first_curvature,
                pairs,
            });
            slopes.extend([expr, by_time]);
            slopes.extend(&by_state);
            curvatures.extend(by_state);
            curvatures.extend(seconds);
        }
        let slopes = alone(pool, exprs, &slopes)?;
        let curvatures = if twice { Some(alone(pool, exprs, &curvatures)?) } else { None };
        Some(Self { reads, values, slopes, curvatures })
    }

    /// Whether each value with a degree is a polynomial of at most this degree in the numbers that satisfy a condition.
    pub(super) fn is_at_most(
        &self,
        pool: &mut Pool<Symbol>,
        moves: &dyn Fn(&Read) -> bool,
        degree: &dyn Fn(usize) -> Option<usize>,
    ) -> bool {
        let places: Vec<usize> = (0..self.reads.len()).filter(|place| moves(&self.reads[*place])).collect();
        let is_one = |symbol: &Symbol| matches!(symbol, Symbol::Access(place) if places.contains(place));
        self.values.iter().enumerate().all(|(index, value)| {
            let Some(degree) = degree(index) else { return true };
            let mut derivatives = vec![value.expr];
            for _ in 0..degree {
                let slopes = |expr: &Expr| places.iter().map(|place| slope(pool, *expr, *place)).collect::<Vec<_>>();
                derivatives = derivatives.iter().flat_map(slopes).collect();
            }
            derivatives.iter().all(|expr| !pool.depends_on(*expr, &is_one))
        })
    }

    /// Whether each value is `Σ c a²` over the numbers a of the state, with c of parameters and numbers alone.
    pub(super) fn is_square(&self, pool: &mut Pool<Symbol>) -> bool {
        let varies = |symbol: &Symbol| match symbol {
            Symbol::Access(place) => self.reads[*place].is_of_state(),
            Symbol::Continuous(_) => true,
            _ => false,
        };
        self.values.iter().all(|value| {
            let mut rest = value.expr;
            for place in &value.states {
                let first = slope(pool, value.expr, *place);
                let second = slope(pool, first, *place);
                if pool.depends_on(second, &varies) {
                    return false;
                }
                let number = pool.symbol(Symbol::Access(*place));
                let square = pool.product(&[second, number, number]);
                let half = pool.scale(square, &Rational::new(1.into(), 2.into()));
                rest = pool.sub(rest, half);
            }
            pool.expand(rest).is_ok_and(|rest| pool.is_zero(rest))
        })
    }
}

/// The derivative with respect to the number at this place.
fn slope(pool: &mut Pool<Symbol>, expr: Expr, place: usize) -> Expr {
    pool.partial_derivative(expr, &Symbol::Access(place))
}
