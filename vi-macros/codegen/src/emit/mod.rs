//! Rust code printed from a program.
//!
//! In: a [`Derived`] system. Out: tokens that refer only to `::vi_core`, `::core` and the user's declarations. One file
//! per kind of item: the struct, the continuous system, the discrete system, the stepper, the checks. A scope of its
//! own keeps the implementations free of names of the surrounding code.

mod angles;
mod body;
mod check;
mod constraints;
mod discrete;
mod entries;
mod folds;
mod formula;
mod functions;
mod indexed;
mod lagrangian;
mod loops;
mod matrix;
mod motion;
mod names;
mod pieces;
mod scope;
mod state_function;
mod stepping;
pub(crate) mod structure;

use crate::derived::{Derivations, Derived};
use crate::discrete::{ByRule, DiscreteSystem};
use crate::findings::{Findings, StepFindings};
use crate::model::{Model, Rule};
use crate::program::{Function, FunctionId, Program};
use crate::symbol::Symbol;
use core::ops::Deref;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};
use vi_expr::Pool;

pub use indexed::items as indexed_items;
pub use structure::Broken;

/// Input of the items of a system.
struct Source<'a> {
    pool: &'a Pool<Symbol>,
    model: &'a Model,
    system: &'a DiscreteSystem,
    program: &'a Program,
    findings: &'a Findings,
    /// The marker of the rule in `vi_core::rules`, if it is not the default rule.
    marker: Option<Ident>,
    limit: usize,
}

/// Input of the steps of a system under its rule.
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

/// A value that steps with a rule that is not the system's own: `By::new(system, Trapezoidal)`.
fn by_marker(marker: &Ident, system: &TokenStream) -> TokenStream {
    quote!(::vi_core::rules::By::new(#system, ::vi_core::rules::#marker))
}

/// Maximum number of operations in one function; a longer one is emitted in pieces.
const LIMIT: usize = 800;

/// The attribute `#[vi_limit(50)]` of the struct replaces [`LIMIT`]; only the tests of pieces use it.
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
    let (functions, parameters) = (functions::items(source.model), structure::parameters(source.model));
    let lagrangian = lagrangian::item(&source);
    let (motion, convertible) =
        (motion::item(&source), structure::convertible(source.model, source.model.without_velocity.is_empty()));
    let batch = own.as_ref().map(|_| structure::batch(source.model));
    let by_own = own.as_ref().map(by_rule);
    let by_further = further.iter().map(by_rule);
    let implementations =
        quote!(#functions #parameters #lagrangian #motion #convertible #by_own #batch #(#by_further)*);
    let conditions: Vec<_> = conditions(&source.model.attributes).collect();
    let scope = scope::scope(&conditions, &implementations);
    let tests = check::tests(&source, own.as_ref(), &further, &conditions);
    quote! { #structure #scope #tests }
}

/// The implementations for one rule.
fn by_rule(steps: &Steps) -> TokenStream {
    let discrete = discrete::item(steps);
    let stepping = stepping::item(steps);
    let discretized = structure::discretized(steps.model, steps.rule_argument().as_ref());
    quote!(#discrete #stepping #discretized)
}

/// The `cfg` attributes of a struct, which apply to all its items.
pub(crate) fn conditions(attributes: &[syn::Attribute]) -> impl Iterator<Item = &syn::Attribute> {
    attributes.iter().filter(|attribute| attribute.path().is_ident("cfg"))
}

impl<'a> Source<'a> {
    fn of(derived: &'a Derived, marker: Option<Ident>, limit: usize) -> Self {
        let Derived { pool, model, system, program, findings } = derived;
        Self { pool, model, system, program, findings, marker, limit }
    }

    /// The steps with the rule, if there is one.
    fn steps(&self) -> Option<Steps<'_>> {
        let (rule, discrete) = (self.model.rule.as_ref()?, self.system.by_rule.as_ref()?);
        Some(Steps { source: self, rule, discrete, findings: self.findings.steps.as_ref()? })
    }

    /// The rule as the last argument of a trait, whose default is the default rule: `, ::vi_core::rules::Trapezoidal`.
    fn rule_argument(&self) -> Option<TokenStream> {
        self.marker.as_ref().map(|marker| quote!(, ::vi_core::rules::#marker))
    }

    /// A value that steps with the rule: `By::new(system, Trapezoidal)`, or the system.
    fn by_rule(&self, system: TokenStream) -> TokenStream {
        match &self.marker {
            Some(marker) => by_marker(marker, &system),
            None => system,
        }
    }

    /// Number of coordinates as a literal.
    fn dimension(&self) -> Literal {
        Literal::usize_unsuffixed(self.model.dimension())
    }

    /// The function with this identity; the program contains all of them.
    fn function(&self, id: FunctionId) -> Option<&Function> {
        self.program.function(id)
    }
}
