//! Equality of nodes.
//!
//! In: two nodes. Out: whether they are equal, and a hash of each. Rationals are in lowest terms, so comparing their
//! parts suffices; ordering them or hashing their value would need a chain of divisions.

use std::hash::{Hash, Hasher};

use num_traits::ToPrimitive;

use crate::{Expr, Node, Product, Rational, Sum};

fn same(left: &Rational, right: &Rational) -> bool {
    left.numer() == right.numer() && left.denom() == right.denom()
}

/// Compares all handles before the first number, because numbers rarely decide. Plain loops: this is the innermost loop
/// of an unoptimized build.
fn same_parts(left: &[(Expr, Rational)], right: &[(Expr, Rational)]) -> bool {
    if left.len() != right.len() {
        return false;
    }
    for (left, right) in left.iter().zip(right) {
        if left.0 != right.0 {
            return false;
        }
    }
    for (left, right) in left.iter().zip(right) {
        if !same(&left.1, &right.1) {
            return false;
        }
    }
    true
}

impl<S: Eq> PartialEq for Node<S> {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Number(left), Self::Number(right)) => same(left, right),
            (Self::Pi, Self::Pi) => true,
            (Self::Symbol(left), Self::Symbol(right)) => left == right,
            (Self::Sum(left), Self::Sum(right)) => {
                same_parts(&left.terms, &right.terms) && same(&left.constant, &right.constant)
            }
            (Self::Product(left), Self::Product(right)) => same_parts(&left.factors, &right.factors),
            (Self::Call(left, left_arguments), Self::Call(right, right_arguments)) => {
                left == right && left_arguments == right_arguments
            }
            (Self::Opaque(left, left_arguments), Self::Opaque(right, right_arguments)) => {
                left == right && left_arguments == right_arguments
            }
            (Self::Select(left), Self::Select(right)) => left == right,
            _ => false,
        }
    }
}

impl<S: Eq> Eq for Node<S> {}

/// For long numbers, their last digits.
fn hash_number(number: &Rational, state: &mut impl Hasher) {
    for part in [number.numer(), number.denom()] {
        let short = part.to_i64().map(i64::cast_unsigned);
        state.write_u64(short.or_else(|| part.iter_u64_digits().next()).unwrap_or(u64::MAX));
    }
}

fn hash_parts(parts: &[(Expr, Rational)], state: &mut impl Hasher) {
    for (expr, number) in parts {
        state.write_usize(expr.0);
        hash_number(number, state);
    }
}

impl<S: Hash> Hash for Node<S> {
    fn hash<H: Hasher>(&self, state: &mut H) {
        match self {
            Self::Number(number) => hash_number(number, state),
            Self::Pi => state.write_u64(1),
            Self::Symbol(symbol) => symbol.hash(state),
            Self::Sum(Sum { constant, terms }) => {
                state.write_u64(2);
                hash_number(constant, state);
                hash_parts(terms, state);
            }
            Self::Product(Product { factors }) => {
                state.write_u64(3);
                hash_parts(factors, state);
            }
            Self::Call(function, arguments) => {
                function.hash(state);
                arguments.hash(state);
            }
            Self::Opaque(function, arguments) => {
                function.hash(state);
                arguments.hash(state);
            }
            Self::Select(parts) => {
                state.write_u64(4);
                parts.hash(state);
            }
        }
    }
}
