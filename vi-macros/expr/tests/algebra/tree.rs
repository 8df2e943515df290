//! Random expressions as plain trees, with values and derivatives by dual numbers, independent of canonical forms.

use num_traits::{One, Signed, Zero};
use vi_expr::{Expr, Function, Rational};

use crate::{Pool, ratio};

/// Names of the symbols by number; derivatives are with respect to the first.
pub(crate) const SYMBOLS: [&str; 4] = ["x", "y", "z", "w"];

#[derive(Debug)]
pub(crate) enum Tree {
    Number(i32, i32),
    Symbol(usize),
    Add(Box<Tree>, Box<Tree>),
    Sub(Box<Tree>, Box<Tree>),
    Mul(Box<Tree>, Box<Tree>),
    Div(Box<Tree>, Box<Tree>),
    Power(Box<Tree>, i32),
    Sqrt(Box<Tree>),
    Call(Function, Vec<Tree>),
}

/// Deterministic random numbers (xorshift64*).
pub(crate) struct Random(u64);

impl Random {
    pub(crate) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1)
    }

    pub(crate) fn below(&mut self, bound: u64) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        (self.0.wrapping_mul(0x2545_f491_4f6c_dd1d) >> 33) % bound
    }

    fn between(&mut self, low: i32, high: i32) -> i32 {
        let width = u64::try_from(high - low).expect("low is below high") + 1;
        low + i32::try_from(self.below(width)).expect("a small number")
    }

    /// Rational functions up to the given depth.
    pub(crate) fn rational(&mut self, depth: u32) -> Tree {
        if depth == 0 || self.below(8) == 0 {
            return self.leaf();
        }
        let mut part = || Box::new(self.rational(depth - 1));
        let (left, right) = (part(), part());
        match self.below(10) {
            0..=2 => Tree::Add(left, right),
            3..=4 => Tree::Sub(left, right),
            5..=7 => Tree::Mul(left, right),
            8 => Tree::Div(left, right),
            _ => Tree::Power(left, self.between(-2, 3)),
        }
    }

    /// Functions of rational functions of functions.
    pub(crate) fn transcendental(&mut self, depth: u32) -> Tree {
        if depth == 0 {
            return self.leaf();
        }
        let mut part = || self.transcendental(depth - 1);
        let (left, right) = (part(), part());
        match self.below(12) {
            0..=1 => Tree::Add(left.into(), right.into()),
            2 => Tree::Sub(left.into(), right.into()),
            3..=4 => Tree::Mul(left.into(), right.into()),
            5 => Tree::Div(left.into(), right.into()),
            6 => Tree::Power(left.into(), self.between(-1, 3)),
            7 => Tree::Sqrt(left.into()),
            _ => {
                let place = usize::try_from(self.below(Function::ALL.len() as u64)).expect("a small number");
                let function = Function::ALL[place];
                Tree::Call(function, if function.arity() == 2 { vec![left, right] } else { vec![left] })
            }
        }
    }

    fn leaf(&mut self) -> Tree {
        match self.below(4) {
            0 => Tree::Number(self.between(-4, 4), self.between(1, 3)),
            _ => Tree::Symbol(usize::try_from(self.below(SYMBOLS.len() as u64)).expect("a small number")),
        }
    }
}

impl Tree {
    /// The tree as an expression.
    pub(crate) fn build(&self, pool: &mut Pool) -> Expr {
        match self {
            Self::Number(numerator, denominator) => pool.number(ratio((*numerator).into(), (*denominator).into())),
            Self::Symbol(place) => pool.symbol(SYMBOLS[*place].to_owned()),
            Self::Add(left, right) => Self::binary(pool, left, right, Pool::add),
            Self::Sub(left, right) => Self::binary(pool, left, right, Pool::sub),
            Self::Mul(left, right) => Self::binary(pool, left, right, Pool::mul),
            Self::Div(left, right) => Self::binary(pool, left, right, Pool::div),
            Self::Power(base, exponent) => {
                let base = base.build(pool);
                pool.power(base, &ratio((*exponent).into(), 1))
            }
            Self::Sqrt(base) => {
                let base = base.build(pool);
                pool.power(base, &ratio(1, 2))
            }
            Self::Call(function, arguments) => {
                let arguments: Vec<Expr> = arguments.iter().map(|argument| argument.build(pool)).collect();
                pool.call(*function, &arguments)
            }
        }
    }

    fn binary(pool: &mut Pool, left: &Self, right: &Self, operation: fn(&mut Pool, Expr, Expr) -> Expr) -> Expr {
        let (left, right) = (left.build(pool), right.build(pool));
        operation(pool, left, right)
    }

    /// Exact value and derivative of a rational function; `None` after a division by 0.
    pub(crate) fn exact(&self, point: &[Rational]) -> Option<(Rational, Rational)> {
        Some(match self {
            Self::Number(numerator, denominator) => {
                (ratio((*numerator).into(), (*denominator).into()), Rational::zero())
            }
            Self::Symbol(place) => (point[*place].clone(), ratio(i64::from(*place == 0), 1)),
            Self::Add(left, right) => {
                let ((a, da), (b, db)) = (left.exact(point)?, right.exact(point)?);
                (a + b, da + db)
            }
            Self::Sub(left, right) => {
                let ((a, da), (b, db)) = (left.exact(point)?, right.exact(point)?);
                (a - b, da - db)
            }
            Self::Mul(left, right) => product(&left.exact(point)?, &right.exact(point)?),
            Self::Div(left, right) => product(&left.exact(point)?, &reciprocal(&right.exact(point)?)?),
            Self::Power(base, exponent) => {
                let base = base.exact(point)?;
                let base = if exponent.is_negative() { reciprocal(&base)? } else { base };
                let one = (Rational::one(), Rational::zero());
                (0..exponent.unsigned_abs()).fold(one, |power, _| product(&power, &base))
            }
            Self::Sqrt(_) | Self::Call(..) => return None,
        })
    }

    /// Value and derivative in floating point; `largest` collects the largest intermediate value or derivative.
    pub(crate) fn float(&self, point: &[f64], largest: &mut f64) -> (f64, f64) {
        let result = match self {
            Self::Number(numerator, denominator) => (f64::from(*numerator) / f64::from(*denominator), 0.0),
            Self::Symbol(place) => (point[*place], if *place == 0 { 1.0 } else { 0.0 }),
            Self::Add(left, right) => {
                let ((a, da), (b, db)) = (left.float(point, largest), right.float(point, largest));
                (a + b, da + db)
            }
            Self::Sub(left, right) => {
                let ((a, da), (b, db)) = (left.float(point, largest), right.float(point, largest));
                (a - b, da - db)
            }
            Self::Mul(left, right) => {
                let ((a, da), (b, db)) = (left.float(point, largest), right.float(point, largest));
                (a * b, da * b + a * db)
            }
            Self::Div(left, right) => {
                let ((a, da), (b, db)) = (left.float(point, largest), right.float(point, largest));
                (a / b, (da * b - a * db) / (b * b))
            }
            Self::Power(base, exponent) => {
                let (a, da) = base.float(point, largest);
                let slope = if *exponent == 0 { 0.0 } else { f64::from(*exponent) * a.powi(exponent - 1) };
                (a.powi(*exponent), slope * da)
            }
            Self::Sqrt(base) => {
                let (a, da) = base.float(point, largest);
                (a.sqrt(), da / (2.0 * a.sqrt()))
            }
            Self::Call(function, arguments) => {
                let (a, da) = arguments[0].float(point, largest);
                let (b, db) = arguments.get(1).map_or((0.0, 0.0), |argument| argument.float(point, largest));
                let (value, by_first, by_second) = call(*function, a, b);
                (value, by_first * da + if db == 0.0 { 0.0 } else { by_second * db })
            }
        };
        // Keeps NaN, which `max` would drop.
        let size = result.0.abs() + result.1.abs();
        *largest = if size.is_nan() || largest.is_nan() { f64::NAN } else { largest.max(size) };
        result
    }
}

fn product((a, da): &(Rational, Rational), (b, db): &(Rational, Rational)) -> (Rational, Rational) {
    (a * b, da * b + a * db)
}

fn reciprocal((a, da): &(Rational, Rational)) -> Option<(Rational, Rational)> {
    (!a.is_zero()).then(|| (a.recip(), -da / (a * a)))
}

/// Value and slopes, by another formula than the library if there is one.
fn call(function: Function, a: f64, b: f64) -> (f64, f64, f64) {
    match function {
        Function::Exp => (a.exp(), a.exp(), 0.0),
        Function::Ln => (a.ln(), a.recip(), 0.0),
        Function::Sin => (a.sin(), a.cos(), 0.0),
        Function::Cos => (a.cos(), -a.sin(), 0.0),
        Function::Tan => (a.tan(), a.cos().powi(-2), 0.0),
        Function::Asin => (a.asin(), a.asin().cos().recip(), 0.0),
        Function::Acos => (a.acos(), -a.acos().sin().recip(), 0.0),
        Function::Atan => (a.atan(), a.atan().cos().powi(2), 0.0),
        Function::Atan2 => (a.atan2(b), b / (a * a + b * b), -a / (a * a + b * b)),
        Function::Sinh => (a.sinh(), a.cosh(), 0.0),
        Function::Cosh => (a.cosh(), a.sinh(), 0.0),
        Function::Tanh => (a.tanh(), a.cosh().powi(-2), 0.0),
        Function::Abs => (a.abs(), a.signum(), 0.0),
        Function::Sign => (if a == 0.0 { 0.0 } else { a.signum() }, 0.0, 0.0),
        Function::Hypot => (a.hypot(b), a.atan2(b).sin(), a.atan2(b).cos()),
        Function::Pow => (a.powf(b), b * a.powf(b) / a, a.powf(b) * a.ln()),
    }
}
