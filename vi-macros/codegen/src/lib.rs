//! The compiler behind `lagrangian!`, as an ordinary library: tests, benches and the command use it too.
//!
//! ```text
//! tokens ──parse──▶ syntax::System ──check──▶ model::Model ──discretize──▶ discrete::DiscreteSystem
//!                      (spans)                  (names resolved, exact)       (L_d, D1…D4, f±, g±, J)
//!                                    ──lower──▶ program::Program ──emit──▶ tokens
//!                                                 (shared operations)       (Rust)
//! ```
//!
//! One stage, one folder, one product. A stage reports all its errors before the next one starts. The stages after
//! parsing run once for each declared rule. A large system takes another path: [`indexed`] replaces the stages from
//! `discrete` to `program`.

pub mod clause;
mod derived;
pub mod discrete;
pub mod emit;
pub mod file;
pub mod findings;
mod header;
pub mod indexed;
#[cfg(feature = "inspect")]
pub mod inspect;
mod limits;
pub mod messages;
pub mod model;
pub mod pretty;
pub mod program;
pub mod rules;
pub mod symbol;
pub mod syntax;
#[cfg(feature = "inspect")]
pub mod terms;

pub use derived::{Derivations, Derived};
pub use indexed::documentation;

use emit::Broken;
use indexed::Indexed;
use model::{Model, check};
use proc_macro2::TokenStream;
use rules::NamedRule;
use symbol::Symbol;
use syntax::{Space, System, parse};
use vi_expr::Pool;

/// A compiled system: straight lines, or loops if it is large and its terms repeat.
pub enum Compiled {
    /// Every function in straight lines, under each rule.
    Lines(Box<Derivations>),
    /// L, f and their derivatives in loops.
    Loops(Box<Loops>),
}

/// A large system in loops, with its expressions.
pub struct Loops {
    /// All expressions.
    pub pool: Pool<Symbol>,
    /// The recursions and sums.
    pub indexed: Indexed,
}

impl Compiled {
    /// Compiles a parsed system; decides between loops and straight lines.
    ///
    /// # Errors
    /// All errors of the first stage that fails.
    pub fn of(system: &System) -> syn::Result<Self> {
        // `#[vi_limit(0)]` on the struct, for tests: loops at any size.
        let is_requested = system.attributes.iter().find_map(emit::limit) == Some(0);
        let (loops, mistake) = match large_model(system) {
            Some(Ok(found)) => (
                Loops::of(found, system.named_rules(), if is_requested { 1 } else { limits::LARGE_COORDINATES })?,
                None,
            ),
            Some(Err(mistake)) => (None, Some(mistake)),
            None => (None, None),
        };
        // Elimination in lines uses that the constraint of a rotation contains four numbers: five bodies take 85 µs a
        // step, not 125.
        let has_rotations = system.coordinates.iter().any(|coordinate| coordinate.space == Space::Rotation);
        let is_large = |loops: &Loops| {
            is_requested || !has_rotations && loops.indexed.operations() > limits::LARGE && loops.indexed.is_dense()
        };
        match loops {
            Some(loops) if is_large(&loops) => Ok(Self::Loops(Box::new(loops))),
            loops => match (derive(system), loops) {
                (Ok(derivations), _) => Ok(Self::Lines(Box::new(derivations))),
                (Err(error), Some(loops)) if messages::is_too_large(&error) => Ok(Self::Loops(Box::new(loops))),
                (Err(error), _) => {
                    // Straight lines report mistakes, but may exceed the limit before they reach the mistakes of
                    // constraints.
                    let has_ended = system.is_constrained && messages::is_too_large(&error);
                    let mistake = mistake.filter(|mistake| has_ended && !messages::is_too_large(mistake));
                    Err(mistake.unwrap_or(error))
                }
            },
        }
    }

    /// Compiles a system from its tokens.
    ///
    /// # Errors
    /// The errors as items, with a stub of the struct.
    pub fn from_tokens(tokens: TokenStream) -> Result<Self, TokenStream> {
        with_stub(tokens, Self::of)
    }

    /// The checked system.
    #[must_use]
    pub fn model(&self) -> &Model {
        match self {
            Self::Lines(derivations) => &derivations.own.model,
            Self::Loops(loops) => &loops.indexed.model,
        }
    }

    /// The items of the system.
    #[must_use]
    pub fn items(&self) -> TokenStream {
        match self {
            Self::Lines(derivations) => items(derivations),
            Self::Loops(loops) => emit::indexed_items(loops),
        }
    }

    /// The expansion as the text of a file.
    ///
    /// # Errors
    /// Tokens that are not Rust items: a bug of this compiler.
    pub fn text(&self) -> syn::Result<String> {
        match self {
            Self::Lines(derivations) => text(derivations),
            Self::Loops(loops) => Ok(header::of_loops(loops) + &pretty::text(self.items())?),
        }
    }
}

/// The checked system with entries of arrays of `let`s as symbols, or its mistakes; `None` if it cannot be large.
fn large_model(system: &System) -> Option<syn::Result<(Pool<Symbol>, Model)>> {
    let has_arrays = system.coordinates.iter().any(|coordinate| !coordinate.lengths.is_empty());
    if !has_arrays {
        return None;
    }
    let mut pool = Pool::bounded(limits::WORK);
    Some(check::large_model(&mut pool, system).map(|model| (pool, model)))
}

impl Loops {
    /// The system in loops; `None` if it has fewer coordinates than `least`, or its terms do not repeat.
    ///
    /// # Errors
    /// Recursions with too many entries.
    fn of(
        (mut pool, model): (Pool<Symbol>, Model),
        rules: Vec<&'static NamedRule>,
        least: usize,
    ) -> syn::Result<Option<Self>> {
        if model.dimension() < least {
            return Ok(None);
        }
        Ok(indexed::indexed(&mut pool, model, rules)?.map(|indexed| Self { pool, indexed }))
    }
}

/// Expands a `lagrangian!` to the items of the system, or to its errors with a stub of the struct.
#[must_use]
pub fn expand(tokens: TokenStream) -> TokenStream {
    Compiled::from_tokens(tokens).map_or_else(|errors| errors, |compiled| compiled.items())
}

/// Parses a system and derives from it; errors become items, with a stub of the struct.
fn with_stub<R>(tokens: TokenStream, derived: impl FnOnce(&System) -> syn::Result<R>) -> Result<R, TokenStream> {
    let system = parse::system(tokens.clone()).map_err(|error| {
        let outline = parse::outline(tokens);
        outline.map_or_else(|| error.to_compile_error(), |system| Broken::of(&system).with(&error))
    })?;
    derived(&system).map_err(|error| Broken::of(&system).with(&error))
}

/// Derives a system from its tokens, in straight lines.
///
/// # Errors
/// The errors as items, with a stub of the struct.
pub fn compile(tokens: TokenStream) -> Result<Derivations, TokenStream> {
    with_stub(tokens, derive)
}

/// Runs the stages from the parsed system to its programs in straight lines, one per rule.
///
/// # Errors
/// All errors of the first stage that fails.
pub fn derive(system: &System) -> syn::Result<Derivations> {
    let own = derive_own(system)?;
    let further = (1..system.rules()).map(|place| derive_by(system, place)).collect::<syn::Result<_>>()?;
    Ok(Derivations { own, further })
}

/// The numbers of coordinates and of constraints of a system, with the entries of arrays.
///
/// # Errors
/// All errors of the check, if the numbers depend on it.
pub fn sizes(system: &System) -> syn::Result<[usize; 2]> {
    let is_one = |of: &syntax::Coordinate| of.lengths.is_empty() && of.space != Space::Rotation;
    if system.coordinates.iter().all(is_one) && system.all(syntax::Defining::Constraint).is_empty() {
        return Ok([system.coordinates.len(), 0]);
    }
    let (_, model) = checked(system, 0)?;
    Ok([model.dimension(), model.constraints.len()])
}

/// The checked system with the rule at this position of the list, and its expressions.
///
/// # Errors
/// All mistakes of the system.
pub fn checked(system: &System, place: usize) -> syn::Result<(Pool<Symbol>, Model)> {
    let mut pool = Pool::bounded(limits::WORK);
    let model = check::model(&mut pool, system, place).map_err(messages::bounded)?;
    Ok((pool, model))
}

/// Runs the stages from the parsed system to its program in straight lines, for the default rule alone.
///
/// # Errors
/// All errors of the first stage that fails.
pub fn derive_own(system: &System) -> syn::Result<Derived> {
    derive_by(system, 0)
}

/// Runs the stages for the rule at this position of the list.
fn derive_by(system: &System, place: usize) -> syn::Result<Derived> {
    let (mut pool, model) = checked(system, place)?;
    let system = discrete::system::system(&mut pool, &model)?;
    let program = program::program(&mut pool, &model, &system)?;
    let findings = findings::findings(&model, &system, &program);
    Ok(Derived { pool, model, system, program, findings })
}

/// The expansion of a system in straight lines as the text of a file.
///
/// # Errors
/// Tokens that are not Rust items: a bug of this compiler.
pub fn text(derivations: &Derivations) -> syn::Result<String> {
    Ok(header::header(derivations) + &pretty::text(items(derivations))?)
}

/// The items of a system in straight lines.
#[must_use]
pub fn items(derivations: &Derivations) -> TokenStream {
    emit::items(derivations)
}
