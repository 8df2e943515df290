//! Inverses of small symbolic matrices.
//!
//! In: a symmetric regular matrix of expressions. Out: its inverse, by minors of up to [`SIZE`] rows, or by elimination if its
//! entries are rational multiples of one expression. Common factors leave the matrix first. Sums are multiplied out with
//! cos² = 1 − sin², and their common factors leave them: so factors of the determinant cancel those of the entries, and
//! the inverse of an inverse that is written out is the matrix itself. Sums that remain keep the form in which they were
//! written: multiplied out, they might lose digits.

use crate::discrete::continuous::summands;
use crate::symbol::Symbol;
use num_bigint::BigInt;
use num_integer::Integer;
use num_traits::{One, Signed, ToPrimitive, Zero};
use std::collections::BTreeMap;
use vi_expr::{Expr, Function, Node, Pool, Product, Rational};

/// Maximum rows of a matrix that is inverted by minors.
const SIZE: usize = 4;
/// Largest exponent of a sum whose factors are found.
const EXPONENT: i32 = 64;
/// Work of eliminating one number of 64 bits.
const ELIMINATION: usize = 8;
/// Maximum rounds of expanding a sum and taking its common factors out.
const ROUNDS: usize = 4;

/// The inverse; `None` if the matrix is too large, or the work is exhausted.
pub(super) fn inverse(pool: &mut Pool<Symbol>, matrix: &[Vec<Expr>]) -> Option<Vec<Vec<Expr>>> {
    if let [row] = matrix {
        return Some(vec![vec![pool.power(row[0], &-Rational::one())]]);
    }
    let mut factoring = Factoring { pool, written: BTreeMap::new() };
    let entries = map(matrix, |entry| factoring.factors(*entry));
    let common = Factors::common(entries.iter().flatten());
    let rest = map(&entries, |entry| factoring.expr(&entry.clone().times(&common, -1)));
    let numbers: Vec<Option<Vec<Rational>>> =
        rest.iter().map(|row| row.iter().map(|entry| factoring.pool.as_number(*entry).cloned()).collect()).collect();
    if let Some(numbers) = numbers.into_iter().collect::<Option<Vec<_>>>() {
        let inverse = inverse_of_numbers(factoring.pool, numbers)?;
        return Some(map(&inverse, |value| factoring.expr(&Factors::number(value.clone()).times(&common, -1))));
    }
    if matrix.len() > SIZE {
        return None;
    }
    let determinant = determinant(factoring.pool, &rest);
    let determinant = factoring.factors(determinant);
    let divisor = factoring.with_powers(determinant, &common).times(&common, 1);
    let places: Vec<Vec<[usize; 2]>> = (0..matrix.len())
        .map(|row| (0..matrix.len()).map(|column| [row.min(column), row.max(column)]).collect())
        .collect();
    Some(map(&places, |place| {
        let minor = minor(factoring.pool, &rest, *place);
        let sign = if (place[0] + place[1]) % 2 == 0 { Rational::one() } else { -Rational::one() };
        let cofactor = factoring.factors(minor).times(&Factors::number(sign), 1);
        factoring.expr(&cofactor.times(&divisor, -1))
    }))
}

/// An operation on each entry of a matrix.
fn map<T, U>(matrix: &[Vec<T>], mut make: impl FnMut(&T) -> U) -> Vec<Vec<U>> {
    matrix.iter().map(|row| row.iter().map(&mut make).collect()).collect()
}

fn determinant(pool: &mut Pool<Symbol>, matrix: &[Vec<Expr>]) -> Expr {
    let Some(first) = matrix.first() else { return pool.one() };
    let mut terms = Vec::new();
    for (column, entry) in first.iter().enumerate() {
        let minor = minor(pool, matrix, [0, column]);
        let product = pool.mul(*entry, minor);
        terms.push(if column % 2 == 0 { product } else { pool.neg(product) });
    }
    pool.sum(&terms)
}

/// The determinant of the matrix without this row and this column.
fn minor(pool: &mut Pool<Symbol>, matrix: &[Vec<Expr>], [row, column]: [usize; 2]) -> Expr {
    let mut rows = matrix.to_vec();
    rows.remove(row);
    for row in &mut rows {
        row.remove(column);
    }
    determinant(pool, &rows)
}

/// The inverse of a matrix of numbers by elimination; `None` if it is singular.
fn inverse_of_numbers(pool: &Pool<Symbol>, mut matrix: Vec<Vec<Rational>>) -> Option<Vec<Vec<Rational>>> {
    let size = matrix.len();
    for (place, row) in matrix.iter_mut().enumerate() {
        row.extend((0..size).map(|column| if column == place { Rational::one() } else { Rational::zero() }));
    }
    for place in 0..size {
        let pivot = (place..size).find(|row| !matrix[*row][place].is_zero())?;
        matrix.swap(place, pivot);
        let scale = matrix[place][place].recip();
        let row: Vec<Rational> = matrix[place].iter().map(|entry| entry * &scale).collect();
        for other in &mut matrix {
            let factor = other[place].clone();
            for (entry, of_pivot) in other.iter_mut().zip(&row).filter(|_| !factor.is_zero()) {
                *entry -= &factor * of_pivot;
                let words = entry.denom().bits().max(entry.numer().bits()) / 64;
                pool.spend(ELIMINATION * (1 + usize::try_from(words).unwrap_or(usize::MAX - 1)));
            }
            if pool.is_exhausted() {
                return None;
            }
        }
        matrix[place] = row;
    }
    Some(matrix.into_iter().map(|row| row[size..].to_vec()).collect())
}

/// coefficient · Π base^exponent.
#[derive(Clone)]
struct Factors {
    coefficient: Rational,
    powers: BTreeMap<Expr, Rational>,
}

impl Factors {
    fn number(coefficient: Rational) -> Self {
        Self { coefficient, powers: BTreeMap::new() }
    }

    fn power(base: Expr, exponent: Rational) -> Self {
        Self { coefficient: Rational::one(), powers: BTreeMap::from([(base, exponent)]) }
    }

    /// The product with the power of another.
    fn times(mut self, other: &Self, exponent: i32) -> Self {
        self.coefficient *= other.coefficient.pow(exponent);
        for (base, of_base) in &other.powers {
            *self.powers.entry(*base).or_insert_with(Rational::zero) +=
                of_base * Rational::from_integer(exponent.into());
        }
        self.powers.retain(|_, exponent| !exponent.is_zero());
        self
    }

    /// The powers in all of these that are not 0; a base that is missing in one has the exponent 0 there.
    fn common<'a>(all: impl IntoIterator<Item = &'a Self>) -> Self {
        let all: Vec<&Self> = all.into_iter().filter(|of| !of.coefficient.is_zero()).collect();
        let mut common = Self::number(Rational::one());
        for base in all.iter().flat_map(|of| of.powers.keys()) {
            let exponents = all.iter().map(|of| of.powers.get(base).cloned().unwrap_or_else(Rational::zero));
            if let Some(least) = exponents.min().filter(|least| !least.is_zero()) {
                common.powers.insert(*base, least);
            }
        }
        common
    }
}

struct Factoring<'a> {
    pool: &'a mut Pool<Symbol>,
    /// Sums that are multiplied out, as multiples of sums as they are written, if these are not twice as large.
    written: BTreeMap<Expr, Factors>,
}

impl Factoring<'_> {
    /// The factors of an expression. Sums among them are multiplied out and have no common factors.
    fn factors(&mut self, expr: Expr) -> Factors {
        match self.pool.node(expr).clone() {
            Node::Number(value) => Factors::number(value),
            Node::Product(Product { factors }) => {
                factors.into_iter().fold(Factors::number(Rational::one()), |all, (base, exponent)| {
                    let whole = exponent.to_i32().filter(|whole| exponent.is_integer() && whole.abs() <= EXPONENT);
                    match whole {
                        Some(whole) => all.times(&self.factors(base), whole),
                        None => all.times(&Factors::power(base, exponent), 1),
                    }
                })
            }
            Node::Sum(sum) => match sum.as_multiple() {
                Some((factor, body)) => self.factors(body).times(&Factors::number(factor.clone()), 1),
                None => self.factors_of_sum(expr),
            },
            _ => Factors::power(expr, Rational::one()),
        }
    }

    fn factors_of_sum(&mut self, sum: Expr) -> Factors {
        let factors = self.multiplied_out(sum);
        let size = |of: Expr| self.pool.reachable(&[of]).len();
        if let (1, Some((base, exponent))) = (factors.powers.len(), factors.powers.first_key_value())
            && exponent.is_one()
            && size(sum) <= 2 * size(*base)
        {
            let written = Factors::power(sum, Rational::one()).times(&Factors::number(factors.coefficient.clone()), -1);
            self.written.entry(*base).or_insert(written);
        }
        factors
    }

    fn multiplied_out(&mut self, mut sum: Expr) -> Factors {
        let mut outside = Factors::number(Rational::one());
        for _ in 0..ROUNDS {
            sum = expanded(self.pool, sum);
            let terms: Vec<Factors> = summands(self.pool, sum).into_iter().map(|term| self.term(term)).collect();
            let common = Factors::common(&terms);
            outside = outside.times(&common, 1);
            let inside: Vec<Expr> =
                terms.into_iter().map(|term| product(self.pool, &term.times(&common, -1))).collect();
            let inside = self.pool.sum(&inside);
            if inside == sum {
                break;
            }
            sum = inside;
        }
        let Node::Sum(of) = self.pool.node(sum) else { return self.factors(sum).times(&outside, 1) };
        let numbers =
            || of.terms.iter().map(|(_, factor)| factor).chain((!of.constant.is_zero()).then_some(&of.constant));
        let numerator = numbers().fold(BigInt::zero(), |divisor, number| divisor.gcd(number.numer()));
        let denominator = numbers().fold(BigInt::one(), |multiple, number| multiple.lcm(number.denom()));
        let content = Rational::new(numerator, denominator) * of.terms[0].1.signum();
        let sum = self.pool.scale(sum, &content.recip());
        outside.times(&Factors { coefficient: content, ..Factors::power(sum, Rational::one()) }, 1)
    }

    /// The factors of a term of a sum; a sum with one term is a multiple.
    fn term(&mut self, term: Expr) -> Factors {
        let is_sum = summands(self.pool, term).len() > 1;
        if is_sum { Factors::power(term, Rational::one()) } else { self.factors(term) }
    }

    /// The same with sums that are multiplied-out powers of sums in `known` as these powers: the determinant of the minors of a
    /// matrix is a power of its own.
    fn with_powers(&mut self, mut factors: Factors, known: &Factors) -> Factors {
        for base in known
            .powers
            .keys()
            .filter(|base| matches!(self.pool.node(**base), Node::Sum(_)))
            .copied()
            .collect::<Vec<_>>()
        {
            for exponent in 2..SIZE {
                let exponent = Rational::from_integer(exponent.into());
                let power = self.pool.power(base, &exponent);
                let Factors { coefficient, powers } = self.multiplied_out(power);
                let Some((sum, _)) = powers.first_key_value().filter(|_| powers.len() == 1) else { continue };
                if let Some(count) = factors.powers.get(sum).and_then(Rational::to_i32) {
                    factors.powers.remove(sum);
                    factors = factors.times(&Factors::number(coefficient), -count);
                    factors = factors.times(&Factors::power(base, exponent), count);
                }
            }
        }
        factors
    }

    /// The product, with sums as they were written.
    fn expr(&mut self, factors: &Factors) -> Expr {
        let mut all = Factors::number(factors.coefficient.clone());
        for (base, exponent) in &factors.powers {
            all = match (self.written.get(base), exponent.to_i32().filter(|_| exponent.is_integer())) {
                (Some(written), Some(exponent)) => all.times(written, exponent),
                _ => all.times(&Factors::power(*base, exponent.clone()), 1),
            };
        }
        product(self.pool, &all)
    }
}

fn product(pool: &mut Pool<Symbol>, Factors { coefficient, powers }: &Factors) -> Expr {
    let powers: Vec<Expr> = powers.iter().map(|(base, exponent)| pool.power(*base, exponent)).collect();
    let product = pool.product(&powers);
    pool.scale(product, coefficient)
}

/// The terms of a sum multiplied out, with cos² = 1 − sin²; unchanged if it becomes too large.
fn expanded(pool: &mut Pool<Symbol>, sum: Expr) -> Expr {
    let Ok(expanded) = pool.expand(sum) else { return sum };
    let terms: Vec<Expr> = summands(pool, expanded).into_iter().map(|term| without_cosines(pool, term)).collect();
    let of_sines = pool.sum(&terms);
    pool.expand(of_sines).unwrap_or(expanded)
}

/// A product with the squares of cosines replaced.
fn without_cosines(pool: &mut Pool<Symbol>, term: Expr) -> Expr {
    let (coefficient, body) = match pool.node(term) {
        Node::Sum(sum) => sum.as_multiple().map_or((Rational::one(), term), |(factor, body)| (factor.clone(), body)),
        _ => (Rational::one(), term),
    };
    let Node::Product(Product { factors }) = pool.node(body).clone() else { return term };
    let two = Rational::from_integer(2.into());
    let mut powers = Vec::new();
    for (base, exponent) in factors {
        let angle = match pool.node(base) {
            Node::Call(Function::Cos, arguments) if exponent.is_integer() && exponent.is_positive() => arguments[0],
            _ => {
                powers.push(pool.power(base, &exponent));
                continue;
            }
        };
        let squares = (&exponent / &two).floor();
        let sine = pool.call(Function::Sin, &[angle]);
        let (square, one) = (pool.power(sine, &two), pool.one());
        let other = pool.sub(one, square);
        powers.push(pool.power(other, &squares));
        powers.push(pool.power(base, &(exponent - two.clone() * squares)));
    }
    let product = pool.product(&powers);
    pool.scale(product, &coefficient)
}
