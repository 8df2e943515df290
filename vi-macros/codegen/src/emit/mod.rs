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

use crate::derived::{Derivations, Derived};
use crate::discrete::{ByRule, DiscreteSystem};
use crate::found::{Findings, StepFindings};
use crate::model::{Model, Rule};
use crate::program::{Function, FunctionId, Program};
use crate::symbol::Symbol;
use core::ops::Deref;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};
use vi_expr::Pool;

pub use structure::Broken;

/// Everything that the items are printed from.
struct Source<'a> {
    pool: &'a Pool<Symbol>,
    model: &'a Model,
    system: &'a DiscreteSystem,
    program: &'a Program,
    findings: &'a Findings,
    /// The marker of the rule in `vi_core::rules`, where it is not the system's own.
    marker: Option<Ident>,
    limit: usize,
}

/// A system by its rule: everything that its steps are printed from.
struct Steps<'a> {
    source: &'a Source<'a>,
    rule: &'a Rule,
    discrete: &'a ByRule,
    findings: &'a StepFindings,
}

impl<'a> Deref for Steps<'a> {
    type Target = Source<'a>;

    fn deref(&self) -> &Source<'a> {
        self.source
    }
}

/// Operations that one function holds at most; a longer one is emitted in pieces.
const LIMIT: usize = 800;

/// The attribute `#[vi_limit(50)]` of the struct, which the tests of pieces write: another limit than [`LIMIT`].
pub(crate) fn limit(attribute: &syn::Attribute) -> Option<usize> {
    let written: syn::LitInt = attribute.path().is_ident("vi_limit").then(|| attribute.parse_args().ok())??;
    written.base10_parse().ok()
}

/// The items of a system, in fixed order.
#[must_use]
pub fn items(derivations: &Derivations) -> TokenStream {
    let limit = derivations.own.model.attributes.iter().find_map(limit).unwrap_or(LIMIT);
    let source = Source::of(&derivations.own, None, limit);
    let named = |derived: &Derived| derived.model.rule.as_ref().and_then(|rule| rule.named);
    let marked = derivations.further.iter().filter_map(|derived| Some((derived, named(derived)?)));
    let further = marked.map(|(derived, rule)| Source::of(derived, Some(format_ident!("{}", rule.marker)), limit));
    let further: Vec<Source> = further.collect();
    let own = source.steps();
    let further: Vec<Steps> = further.iter().filter_map(Source::steps).collect();
    let structure = structure::structure(&source, &further);
    let parameters = structure::parameters(&source);
    let lagrangian = lagrangian::item(&source);
    let collocation = collocation::item(&source);
    let convertible = structure::convertible(&source);
    let batch = own.as_ref().map(|_| structure::batch(&source));
    let by_own = own.as_ref().map(by_rule);
    let by_further = further.iter().map(by_rule);
    let implementations = quote!(#parameters #lagrangian #collocation #convertible #by_own #batch #(#by_further)*);
    let conditions: Vec<_> = conditions(&source.model.attributes).collect();
    let scope = scope::scope(&conditions, &implementations);
    let tests = check::tests(&source, own.as_ref(), &further, &conditions);
    quote! { #structure #scope #tests }
}

/// What is implemented once for each rule.
fn by_rule(steps: &Steps) -> TokenStream {
    let discrete = discrete::item(steps);
    let stepping = stepping::item(steps);
    let discretized = structure::discretized(steps);
    quote!(#discrete #stepping #discretized)
}

/// The conditions under which a struct is there, and all that belongs to it.
pub(crate) fn conditions(attributes: &[syn::Attribute]) -> impl Iterator<Item = &syn::Attribute> {
    attributes.iter().filter(|attribute| attribute.path().is_ident("cfg"))
}

impl<'a> Source<'a> {
    fn of(derived: &'a Derived, marker: Option<Ident>, limit: usize) -> Self {
        let Derived { pool, model, system, program, findings } = derived;
        Self { pool, model, system, program, findings, marker, limit }
    }

    /// The steps by the rule, if there is one.
    fn steps(&self) -> Option<Steps<'_>> {
        let (rule, discrete) = (self.model.rule.as_ref()?, self.system.by_rule.as_ref()?);
        Some(Steps { source: self, rule, discrete, findings: self.findings.steps.as_ref()? })
    }

    /// The rule as the last argument of a trait, whose default is the system's own: `, ::vi_core::rules::Trapezoidal`.
    fn rule_argument(&self) -> Option<TokenStream> {
        self.marker.as_ref().map(|marker| quote!(, ::vi_core::rules::#marker))
    }

    /// A value of the system that takes steps by the rule: `By::new(system, Trapezoidal)`, or the system.
    fn by_rule(&self, system: TokenStream) -> TokenStream {
        match &self.marker {
            Some(marker) => quote!(::vi_core::rules::By::new(#system, ::vi_core::rules::#marker)),
            None => system,
        }
    }

    /// Number of coordinates, as it stands in types.
    fn dimension(&self) -> Literal {
        Literal::usize_unsuffixed(self.model.dimension())
    }

    /// The function of this identity; the program holds all of them.
    fn function(&self, id: FunctionId) -> Option<&Function> {
        self.program.function(id)
    }
}
