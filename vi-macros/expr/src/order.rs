//! The order of nodes.
//!
//! In: two nodes. Out: whether they are the same, and which comes first in the index of a pool. The order of two numbers is
//! that of their denominators, then of their numerators: it is not the order of their values, which takes a chain of
//! divisions as long as the continued fraction, but it is total and cheap. No order of nodes shows in a canonical form,
//! whose parts ascend by handle.

use std::cmp::Ordering;

use crate::{Expr, Node, Product, Rational, Sum};

fn numbers(left: &Rational, right: &Rational) -> Ordering {
    left.denom().cmp(right.denom()).then_with(|| left.numer().cmp(right.numer()))
}

/// Shorter lists first, then the first handle that differs, then the first number: numbers are seldom looked at.
/// Plain loops, because this is the innermost of a build without optimisation.
fn pairs(left: &[(Expr, Rational)], right: &[(Expr, Rational)]) -> Ordering {
    if left.len() != right.len() {
        return left.len().cmp(&right.len());
    }
    for (left, right) in left.iter().zip(right) {
        if left.0 != right.0 {
            return left.0.cmp(&right.0);
        }
    }
    for (left, right) in left.iter().zip(right) {
        let order = numbers(&left.1, &right.1);
        if order.is_ne() {
            return order;
        }
    }
    Ordering::Equal
}

impl Ord for Sum {
    fn cmp(&self, other: &Self) -> Ordering {
        pairs(&self.terms, &other.terms).then_with(|| numbers(&self.constant, &other.constant))
    }
}

impl Ord for Product {
    fn cmp(&self, other: &Self) -> Ordering {
        pairs(&self.factors, &other.factors)
    }
}

impl<S: Ord> Ord for Node<S> {
    fn cmp(&self, other: &Self) -> Ordering {
        match (self, other) {
            (Self::Number(left), Self::Number(right)) => numbers(left, right),
            (Self::Symbol(left), Self::Symbol(right)) => left.cmp(right),
            (Self::Sum(left), Self::Sum(right)) => left.cmp(right),
            (Self::Product(left), Self::Product(right)) => left.cmp(right),
            (Self::Call(left, left_arguments), Self::Call(right, right_arguments)) => {
                left.cmp(right).then_with(|| left_arguments.cmp(right_arguments))
            }
            _ => kind(self).cmp(&kind(other)),
        }
    }
}

fn kind<S>(node: &Node<S>) -> usize {
    match node {
        Node::Number(_) => 0,
        Node::Pi => 1,
        Node::Symbol(_) => 2,
        Node::Sum(_) => 3,
        Node::Product(_) => 4,
        Node::Call(..) => 5,
    }
}

/// Equality and partial order follow the total order.
macro_rules! ordered {
    ($($($parameter:ident)? => $type:ty),*) => {$(
        impl$(<$parameter: Ord>)? PartialOrd for $type {
            fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
                Some(self.cmp(other))
            }
        }

        impl$(<$parameter: Ord>)? PartialEq for $type {
            fn eq(&self, other: &Self) -> bool {
                self.cmp(other).is_eq()
            }
        }

        impl$(<$parameter: Ord>)? Eq for $type {}
    )*};
}
ordered!(=> Sum, => Product, S => Node<S>);
