//! Rust, printed from a program.
//!
//! In: a [`Derived`] system. Out: tokens that name only `::vi_core`, `::core` and what the user declared.
//! One file per kind of item: the struct, the continuous system, the discrete one, the stepper, the
//! checks. All implementations stand in a scope of their own, in which no name of the surrounding code can get in their way.

mod angles;
mod body;
mod check;
mod collocation;
mod discrete;
mod entries;
mod folds;
mod formula;
mod lagrangian;
mod loops;
mod matrix;
mod names;
mod pieces;
mod scope;
mod stepping;
mod structure;

use crate::derived::Derived;
use crate::discrete::DiscreteSystem;
use crate::found::Findings;
use crate::model::Model;
use crate::program::{Function, FunctionId, Program};
use crate::symbol::Symbol;
use proc_macro2::{Literal, TokenStream};
use quote::quote;
use vi_expr::Pool;

pub use structure::Broken;

/// Everything that the items are printed from.
struct Source<'a> {
    pool: &'a Pool<Symbol>,
    model: &'a Model,
    system: &'a DiscreteSystem,
    program: &'a Program,
    findings: &'a Findings,
    limit: usize,
}

/// Operations that one function holds at most; a longer one is emitted in pieces.
pub const LIMIT: usize = 800;

/// The items of a system, in fixed order, in functions of at most `limit` operations, which is [`LIMIT`] but in tests.
#[must_use]
pub fn items(derived: &Derived, limit: usize) -> TokenStream {
    let Derived { pool, model, system, program, findings } = derived;
    let source = Source { pool, model, system, program, findings, limit };
    let structure = structure::structure(&source);
    let parameters = structure::parameters(&source);
    let lagrangian = lagrangian::item(&source);
    let collocation = collocation::item(&source);
    let discrete = discrete::item(&source);
    let stepping = stepping::item(&source);
    let numbers = structure::numbers(&source);
    let implementations = quote!(#parameters #lagrangian #collocation #discrete #stepping #numbers);
    let conditions: Vec<_> = conditions(&model.attributes).collect();
    let scope = scope::scope(&conditions, &implementations);
    let tests = check::tests(&source, &conditions);
    quote! { #structure #scope #tests }
}

/// The conditions under which a struct is there, and all that belongs to it.
pub(crate) fn conditions(attributes: &[syn::Attribute]) -> impl Iterator<Item = &syn::Attribute> {
    attributes.iter().filter(|attribute| attribute.path().is_ident("cfg"))
}

impl Source<'_> {
    /// Number of coordinates, as it stands in types.
    fn dimension(&self) -> Literal {
        Literal::usize_unsuffixed(self.model.dimension())
    }

    /// The function of this identity; the program holds all of them.
    fn function(&self, id: FunctionId) -> Option<&Function> {
        self.program.function(id)
    }
}
