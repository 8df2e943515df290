//! The Legendre transformation in closed form.
//!
//! In: H of the momenta, or L of the velocities: quadratic in these variables u, or a root of a quadratic radicand. Out: the
//! transform, a function of w = ∂F/∂u, which is L or H. The center u0 is the u at w = 0.
//!
//! ```text
//! F = u·A u/2 + b·u + c          F*(w) = w·A⁻¹ w/2 + w·u0 − F(u0)                     u0 = −A⁻¹ b
//! F = s √Q,  Q = u·B u/2 + …     F*(w) = w·u0 − s √(Q(u0) − 2 Q(u0)/s² w·B⁻¹ w)      u0 of Q
//! ```
//!
//! A is inverted block by block, without rounding. The expansion of F(u0) may cancel terms that its written form does not: the
//! smallest form is taken.

use super::inverse::inverse;
use super::singular::is_singular;
use super::{Parameter, probe};
use crate::discrete::continuous::summands;
use crate::symbol::Symbol;
use num_traits::One;
use std::collections::BTreeMap;
use vi_expr::{Expr, Node, Pool, Rational};

/// The symbols of variables by index.
type Variables = fn(usize) -> Symbol;

/// The transform of a function of the variables `from`, as a function of the variables `to`. `None` if there is none in
/// closed form: the function is not quadratic, its second derivatives are singular, or they couple too many variables by
/// symbols.
pub(crate) fn transform(
    pool: &mut Pool<Symbol>,
    function: Expr,
    [from, to]: [Variables; 2],
    parameters: &[Parameter],
    dimension: usize,
) -> Option<Expr> {
    let places = (0..dimension).map(|place| (from(place), place)).collect();
    let mut legendre = Legendre { pool, places, from, to, parameters };
    let (roots, rest) = legendre.roots(function);
    let mut free: Vec<usize> = (0..dimension).collect();
    let mut parts = Vec::new();
    for Root { factor, radicand } in roots {
        let places = legendre.places(radicand);
        let of_rest = legendre.places(rest);
        if places.iter().any(|place| !free.contains(place) || of_rest.contains(place)) {
            return None;
        }
        free.retain(|place| !places.contains(place));
        parts.push(legendre.of_root(factor, radicand, &places)?);
    }
    parts.push(legendre.of_quadratic(rest, &free)?);
    Some(pool.sum(&parts))
}

/// s √Q.
struct Root {
    factor: Expr,
    radicand: Expr,
}

/// A quadratic function by the variables of its transform: `form` is w·A⁻¹ w/2, `linear` is w·u0, `value` is F(u0).
struct Completed {
    form: Expr,
    linear: Expr,
    value: Expr,
}

struct Legendre<'a> {
    pool: &'a mut Pool<Symbol>,
    /// The index of each variable.
    places: BTreeMap<Symbol, usize>,
    from: Variables,
    to: Variables,
    parameters: &'a [Parameter],
}

impl Legendre<'_> {
    /// The variables in an expression, by index.
    fn places(&self, expr: Expr) -> Vec<usize> {
        self.pool.symbols(expr).iter().filter_map(|symbol| self.places.get(symbol)).copied().collect()
    }

    /// The summands s √Q with variables in Q alone, and the sum of the others.
    fn roots(&mut self, function: Expr) -> (Vec<Root>, Expr) {
        let (mut roots, mut rest) = (Vec::new(), Vec::new());
        for summand in summands(self.pool, function) {
            match self.root(summand) {
                Some(root) => roots.push(root),
                None => rest.push(summand),
            }
        }
        (roots, self.pool.sum(&rest))
    }

    fn root(&mut self, summand: Expr) -> Option<Root> {
        let (coefficient, body) = match self.pool.node(summand) {
            Node::Sum(sum) => sum.as_multiple().map(|(factor, body)| (factor.clone(), body))?,
            _ => (Rational::one(), summand),
        };
        let Node::Product(product) = self.pool.node(body).clone() else { return None };
        let (moving, fixed): (Vec<_>, Vec<_>) =
            product.factors.into_iter().partition(|(base, _)| !self.places(*base).is_empty());
        let [(radicand, exponent)] = &moving[..] else { return None };
        if *exponent != half() {
            return None;
        }
        let mut factor = self.pool.number(coefficient);
        for (base, exponent) in fixed {
            let power = self.pool.power(base, &exponent);
            factor = self.pool.mul(factor, power);
        }
        Some(Root { factor, radicand: *radicand })
    }

    fn of_root(&mut self, factor: Expr, radicand: Expr, places: &[usize]) -> Option<Expr> {
        let Completed { form, linear, value } = self.completed(radicand, places)?;
        if self.pool.is_zero(value) {
            // s √(u·B u) is homogeneous of degree 1.
            return None;
        }
        let square = self.pool.mul(factor, factor);
        let form = self.pool.scale(form, &Rational::from_integer(4.into()));
        let root = if self.is_positive(value) {
            let ratio = self.pool.div(value, square);
            let moved = self.pool.mul(ratio, form);
            let radicand = self.pool.sub(value, moved);
            self.pool.power(radicand, &half())
        } else {
            // √(Q x) = Q √(x/Q) if Q is positive; the right side holds for either sign of Q.
            let (one, ratio) = (self.pool.one(), self.pool.div(form, square));
            let rest = self.pool.sub(one, ratio);
            let radicand = self.pool.div(rest, value);
            let root = self.pool.power(radicand, &half());
            self.pool.mul(value, root)
        };
        let root = self.pool.mul(factor, root);
        Some(self.pool.sub(linear, root))
    }

    /// Whether an expression is negative at no point of a fixed sequence.
    fn is_positive(&self, expr: Expr) -> bool {
        let is_negative = |point: u32| {
            let values = probe::values(self.pool, &[expr], point, self.parameters);
            values.iter().any(|value| value.value < 0.0)
        };
        !(0..probe::POINTS).any(is_negative)
    }

    fn of_quadratic(&mut self, function: Expr, places: &[usize]) -> Option<Expr> {
        let Completed { form, linear, value } = self.completed(function, places)?;
        let moving = self.pool.add(form, linear);
        Some(self.pool.sub(moving, value))
    }

    /// Completes the square.
    fn completed(&mut self, function: Expr, places: &[usize]) -> Option<Completed> {
        let (matrix, slopes) = self.quadratic(function, places)?;
        let (mut groups, mut linear, mut centers, mut squares) =
            (Groups::default(), Vec::new(), Vec::new(), Vec::new());
        for block in blocks(self.pool, &matrix) {
            let rows = block.iter().map(|row| block.iter().map(|column| matrix[*row][*column]).collect());
            let inverted = self.inverted(&rows.collect::<Vec<_>>())?;
            for (row, entries) in block.iter().zip(&inverted) {
                let mut center = Vec::new();
                for (column, entry) in block.iter().zip(entries) {
                    if column >= row {
                        groups.add(self.pool, *entry, [places[*row], places[*column]].map(self.to));
                    }
                    for term in summands(self.pool, slopes[*column]) {
                        let product = self.pool.mul(*entry, term);
                        center.push(self.pool.neg(product));
                    }
                }
                let center = self.pool.sum(&center);
                let velocity = self.pool.symbol((self.to)(places[*row]));
                linear.push(self.pool.mul(velocity, center));
                squares.push(self.pool.mul(slopes[*row], center));
                centers.push((places[*row], center));
            }
        }
        let value = self.value(function, &centers, &squares);
        Some(Completed { form: groups.half_sum(self.pool), linear: self.pool.sum(&linear), value })
    }

    /// A and b of a function that is quadratic in these variables.
    fn quadratic(&mut self, function: Expr, places: &[usize]) -> Option<(Vec<Vec<Expr>>, Vec<Expr>)> {
        let (mut matrix, mut slopes) = (Vec::new(), Vec::new());
        for place in places {
            let slope = self.slope(function, *place);
            let present = self.places(slope);
            let mut row = vec![self.pool.zero(); places.len()];
            let at_zero = self.at(slope, &[]);
            let mut rest = vec![(slope, Rational::one()), (at_zero, -Rational::one())];
            for (entry, column) in row.iter_mut().zip(places).filter(|(_, column)| present.contains(column)) {
                let second = self.slope(slope, *column);
                *entry = self.at(second, &[]);
                let variable = self.pool.symbol((self.from)(*column));
                rest.push((self.pool.mul(*entry, variable), -Rational::one()));
            }
            let rest = self.pool.combination(rest);
            let is_linear = self.pool.is_zero(rest)
                || !self.pool.is_undefined(rest) && probe::vanish(self.pool, &[rest], self.parameters);
            if !is_linear {
                return None;
            }
            if row.iter().all(|entry| self.pool.is_zero(*entry)) {
                return None;
            }
            matrix.push(row);
            slopes.push(at_zero);
        }
        Some((matrix, slopes))
    }

    fn slope(&mut self, expr: Expr, place: usize) -> Expr {
        self.pool.partial_derivative(expr, &(self.from)(place))
    }

    /// The value at these variables; the others are zero.
    fn at(&mut self, expr: Expr, values: &[(usize, Expr)]) -> Expr {
        let places = &self.places;
        self.pool.substitute(expr, &mut |pool, symbol| {
            let place = *places.get(symbol)?;
            let given = values.iter().find(|(of, _)| *of == place);
            Some(given.map_or(pool.zero(), |(_, value)| *value))
        })
    }

    /// F(u0) in its smallest form: as written, with terms that cancel, or F(0) + b·u0/2, whose summands are `squares`.
    fn value(&mut self, function: Expr, centers: &[(usize, Expr)], squares: &[Expr]) -> Expr {
        let written = self.at(function, centers);
        if centers.iter().all(|(_, center)| self.pool.is_zero(*center)) {
            return written;
        }
        let (at_zero, square) = (self.at(function, &[]), self.pool.sum(squares));
        let completed = self.pool.combination([(at_zero, Rational::one()), (square, half())]);
        let cancelled = self.cancelled(function, centers);
        let size = |form: &Expr| self.pool.reachable(&[*form]).len();
        [written, completed, cancelled].into_iter().min_by_key(size).unwrap_or(written)
    }

    /// F(u0) with the summands that contain variables multiplied out, and of the others those that cancel with them: the rest
    /// might lose digits.
    fn cancelled(&mut self, function: Expr, centers: &[(usize, Expr)]) -> Expr {
        let (moving, fixed): (Vec<Expr>, Vec<Expr>) =
            summands(self.pool, function).into_iter().partition(|term| !self.places(*term).is_empty());
        let moving = self.pool.sum(&moving);
        let moving = self.at(moving, centers);
        let mut sum = self.pool.expand(moving).unwrap_or(moving);
        let mut kept = Vec::new();
        for term in fixed {
            let expanded = self.pool.expand(term).unwrap_or(term);
            let together = self.pool.add(sum, expanded);
            if summands(self.pool, together).len() < summands(self.pool, sum).len() {
                sum = together;
            } else {
                kept.push(term);
            }
        }
        kept.push(sum);
        self.pool.sum(&kept)
    }

    /// The inverse of a block of A.
    fn inverted(&mut self, block: &[Vec<Expr>]) -> Option<Vec<Vec<Expr>>> {
        if is_singular(self.pool, &block.concat(), block.len(), self.parameters) {
            return None;
        }
        inverse(self.pool, block)
    }
}

/// Products w_i w_j by their factor, so that m (x² + y²) is not multiplied out.
#[derive(Default)]
struct Groups(Vec<(Expr, Vec<Expr>)>);

impl Groups {
    /// Adds `factor`·w_i w_j, twice if i and j differ.
    fn add(&mut self, pool: &mut Pool<Symbol>, factor: Expr, pair: [Symbol; 2]) {
        let is_square = pair[0] == pair[1];
        let [left, right] = pair.map(|symbol| pool.symbol(symbol));
        let product = pool.mul(left, right);
        let product = if is_square { product } else { pool.scale(product, &Rational::from_integer(2.into())) };
        match self.0.iter_mut().find(|(known, _)| *known == factor) {
            Some((_, products)) => products.push(product),
            None => self.0.push((factor, vec![product])),
        }
    }

    fn half_sum(self, pool: &mut Pool<Symbol>) -> Expr {
        let mut terms = Vec::new();
        for (factor, products) in self.0 {
            let sum = pool.sum(&products);
            terms.push((pool.mul(factor, sum), half()));
        }
        pool.combination(terms)
    }
}

/// The rows of a symmetric matrix that are connected by entries, in ascending order.
fn blocks(pool: &Pool<Symbol>, matrix: &[Vec<Expr>]) -> Vec<Vec<usize>> {
    let mut left: Vec<usize> = (0..matrix.len()).collect();
    let mut blocks = Vec::new();
    while let Some(first) = left.first().copied() {
        let mut block = vec![first];
        let mut next = 0;
        while let Some(row) = block.get(next).copied() {
            left.retain(|place| *place != row);
            let (near, far) = left.iter().partition(|place| !pool.is_zero(matrix[row][**place]));
            block.extend::<Vec<usize>>(near);
            left = far;
            next += 1;
        }
        block.sort_unstable();
        blocks.push(block);
    }
    blocks
}

fn half() -> Rational {
    Rational::new(1.into(), 2.into())
}
