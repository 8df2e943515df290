//! A declared function as an expression calls it.

use crate::syntax;
use std::rc::Rc;
use vi_expr::{Expr, Opaque};

/// A function as an expression calls it.
#[derive(Clone)]
pub(super) enum Called {
    /// A function of the language.
    Language(Rc<syntax::Function>),
    /// An opaque function, the names of its arguments, and the parameters that are its further arguments.
    Opaque { function: Opaque, arguments: Vec<String>, parameters: Vec<Expr> },
}

impl core::fmt::Debug for Called {
    fn fmt(&self, formatter: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Language(function) => write!(formatter, "fn {}", function.name),
            Self::Opaque { function, .. } => write!(formatter, "{function:?}"),
        }
    }
}

impl PartialEq for Called {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Language(left), Self::Language(right)) => Rc::ptr_eq(left, right),
            (Self::Opaque { function: left, .. }, Self::Opaque { function: right, .. }) => left == right,
            _ => false,
        }
    }
}

impl Eq for Called {}
