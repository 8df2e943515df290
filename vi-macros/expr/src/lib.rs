//! Symbolic algebra: exact and shared, without mechanics, tokens or spans.
//!
//! In: symbols of any ordered type. Out: expressions in canonical form. Construction simplifies, so there is no
//! separate simplifier. Equal forms are one node of a [`Pool`]. Coefficients and exponents are exact rationals.
//!
//! ```
//! use vi_expr::{Pool, Rational};
//!
//! // The midpoint rule for a free particle: q1 = q0 + h*v turns (q1 - q0)/h into v.
//! let mut pool = Pool::new();
//! let [m, h, v, q0, q1] = ["m", "h", "v", "q0", "q1"].map(|name| pool.symbol(name));
//! let difference = pool.sub(q1, q0);
//! let velocity = pool.div(difference, h);
//! let square = pool.mul(velocity, velocity);
//! let energy = pool.mul(m, square);
//! let energy = pool.scale(energy, &Rational::new(1.into(), 2.into()));
//! let name = |symbol: &&str| symbol.to_string();
//! assert_eq!(pool.render(energy, &name), "m*(q1 - q0)^2/(2*h^2)");
//!
//! let momentum = pool.partial_derivative(energy, &"q1");
//! assert_eq!(pool.render(momentum, &name), "m*(q1 - q0)/h^2");
//!
//! let way = pool.mul(h, v);
//! let end = pool.add(q0, way);
//! let energy = pool.substitute(energy, &mut |_, symbol| (*symbol == "q1").then_some(end));
//! assert_eq!(pool.render(energy, &name), "m*v^2/2");
//! ```
//!
//! | file | product |
//! |---|---|
//! | `node`, `identity`, `function`, `pool` | expressions and their storage |
//! | `table` | values by index |
//! | `effort` | work limits |
//! | `number` | exact powers of numbers, bounded |
//! | `sum`, `squares`, `product`, `call`, `opaque` | the canonical forms, each with its rules |
//! | `derivative`, `substitute`, `expand`, `ramp` | new expressions from old |
//! | `ball`, `elementary`, `constant` | numbers and functions of any precision; constants, rounded once |
//! | `collect` | merges terms that differ by constants |
//! | `evaluate`, `rounding`, `render` | values, values with their errors, text |
//!
//! No pass recurses: children are older than parents, so each pass is a loop in the order of creation.

mod ball;
mod call;
mod collect;
mod constant;
mod derivative;
mod effort;
mod elementary;
mod evaluate;
mod expand;
mod function;
mod identity;
mod node;
mod number;
mod opaque;
mod pool;
mod product;
mod ramp;
mod render;
mod rounding;
mod squares;
mod substitute;
mod sum;
mod table;

/// Values, each once, numbered in order of insertion and found by hash. A search tree compares about a dozen values, a
/// hash one or two, which matters in an unoptimized macro. The hasher has no seed.
pub type Distinct<T> = indexmap::IndexSet<T, core::hash::BuildHasherDefault<rustc_hash::FxHasher>>;
pub use effort::TooLarge;
pub use elementary::NoConstant;
pub use evaluate::selected;
pub use function::Function;
pub use node::{Expr, Node, Product, Rational, Sum};
pub use opaque::{MAX_ARGUMENTS, Opaque};
pub use pool::Pool;
pub use render::MAX_CHARACTERS;
pub use rounding::Rounded;
pub use table::{Index, Table};
