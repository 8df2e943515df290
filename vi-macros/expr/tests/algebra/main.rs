//! Tests of the symbolic algebra, by kind:
//!
//! - `rules`: a table `input => output` of the canonical forms, and the text of expressions;
//! - `derivatives`: every function against central differences;
//! - `random`: random expressions against exact and floating-point dual numbers, independent of canonical forms;
//! - `identities`: value and slope where an identity fails;
//! - `limits`: deep, wide and huge expressions, and undefined values;
//! - `rounding`: errors of values against identities;
//! - `opaque`: functions known by name, and conditions;
//! - `passes`: substitution, expansion and the queries.
//!
//! `notation` reads the text that the tables are written in; `tree` makes the random expressions.

mod constants;
mod derivatives;
mod identities;
mod limits;
mod notation;
mod opaque;
mod passes;
mod random;
mod rounding;
mod rules;
mod tree;

/// Pool with symbols that are text.
type Pool = vi_expr::Pool<String>;

/// Fraction.
fn ratio(numerator: i64, denominator: i64) -> vi_expr::Rational {
    vi_expr::Rational::new(numerator.into(), denominator.into())
}
