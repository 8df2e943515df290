//! The nodes of an expression.
//!
//! In: nothing. Out: [`Expr`], the handle of a shared expression, and [`Node`], its operation. Nodes refer to children
//! by handle. A child is older than its parent: ascending handles are a topological order.

use num_rational::BigRational;

use crate::{Function, Index, Opaque};

/// Exact number of any size, always in lowest terms.
pub type Rational = BigRational;

/// Handle of an expression in its [`Pool`](crate::Pool). Two expressions of one pool have the same canonical form if
/// and only if their handles are equal. A handle is meaningless in another pool.
#[derive(Copy, Clone, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Expr(pub(crate) usize);

impl Expr {
    /// The number 0, first in every pool.
    pub(crate) const ZERO: Self = Self(0);
    /// The number 1, second in every pool.
    pub(crate) const ONE: Self = Self(1);
    /// `0^-1`, third in every pool: the value of every undefined operation.
    pub(crate) const UNDEFINED: Self = Self(2);
}

impl Index for Expr {
    fn index(self) -> usize {
        self.0
    }
}

/// One operation on older expressions.
#[derive(Clone, Debug)]
pub enum Node<S> {
    /// Exact number.
    Number(Rational),
    /// The circle constant.
    Pi,
    /// Symbol of the user: a variable or an opaque field.
    Symbol(S),
    /// Linear combination.
    Sum(Sum),
    /// Product of powers.
    Product(Product),
    /// Function of [`Function::arity`] arguments.
    Call(Function, Vec<Expr>),
    /// Partial derivative of a function that is known by name, at its arguments.
    Opaque(Opaque, Vec<Expr>),
    /// `if a > 0 { b } else { c }` of a, b, c.
    Select([Expr; 3]),
}

/// `constant + Σ coefficient·term`.
///
/// The terms ascend, are neither numbers nor sums, and have coefficients other than 0. A sum has two parts or more, or is one
/// term with a coefficient other than 1.
#[derive(Clone, Debug)]
pub struct Sum {
    /// The part without a term, often 0.
    pub constant: Rational,
    /// Terms with their coefficients.
    pub terms: Vec<(Expr, Rational)>,
}

impl Sum {
    /// Coefficient and term, if this sum is a single multiple.
    #[must_use]
    pub fn as_multiple(&self) -> Option<(&Rational, Expr)> {
        match self.terms.as_slice() {
            [(term, coefficient)] if num_traits::Zero::is_zero(&self.constant) => Some((coefficient, *term)),
            _ => None,
        }
    }
}

/// `Π base^exponent`.
///
/// The bases ascend and the exponents are not 0. There is no numeric coefficient: `c·product` is a [`Sum`] of one term.
/// A number is a base only with an exponent between 0 and 1 (`2^(1/2)`), if the power is too large to be folded, or in `0^-1`.
/// A product or a multiple is a base only with a fractional exponent, since `(x^2)^(1/2)` is not `x`.
#[derive(Clone, Debug)]
pub struct Product {
    /// Bases with their exponents.
    pub factors: Vec<(Expr, Rational)>,
}

impl<S> Node<S> {
    /// Calls `see` with each operand, in the order of the node.
    pub fn each_child(&self, mut see: impl FnMut(Expr)) {
        match self {
            Self::Number(_) | Self::Pi | Self::Symbol(_) => {}
            Self::Sum(Sum { terms: parts, .. }) | Self::Product(Product { factors: parts }) => {
                for (part, _) in parts {
                    see(*part);
                }
            }
            Self::Call(_, arguments) | Self::Opaque(_, arguments) => {
                for argument in arguments {
                    see(*argument);
                }
            }
            Self::Select(parts) => parts.iter().copied().for_each(see),
        }
    }

    /// Number of operands.
    pub(crate) fn operands(&self) -> usize {
        match self {
            Self::Number(_) | Self::Pi | Self::Symbol(_) => 0,
            Self::Sum(Sum { terms: parts, .. }) | Self::Product(Product { factors: parts }) => parts.len(),
            Self::Call(_, arguments) | Self::Opaque(_, arguments) => arguments.len(),
            Self::Select(parts) => parts.len(),
        }
    }

    /// Whether one of the operands satisfies `is`.
    pub(crate) fn any_child(&self, is: impl Fn(Expr) -> bool) -> bool {
        let mut any = false;
        self.each_child(|child| any = any || is(child));
        any
    }
}
