//! Solvers that do not depend on a method.

pub(crate) mod bracket;
