//! The checks of a system: one test for each check that applies.
//!
//! The table of rules, the forces and the cyclic coordinates decide which checks apply. A rule outside the table is
//! expected to have order 1 and no other property. A system with several rules has the tests once per rule. A system
//! without a rule has the tests of its motion, of its constraints and of its Gauss steps.

use super::formula::number;
use super::{Source, Steps, by_marker};
use crate::indexed::Indexed;
use crate::model::Model;
use crate::pretty::snake_case;
use crate::program::Operation;
use crate::rules::{LEAST_ORDER, NamedRule};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};
use syn::Attribute;

/// The tests of the clause `check`, in their own module:
///
/// ```text
/// #[cfg(test)] mod kepler_checks { fn place() -> Place<2> {…} #[test] fn derivatives() {…} … mod trapezoidal { … } }
/// ```
pub(super) fn tests(
    source: &Source,
    steps: Option<&Steps>,
    further: &[Steps],
    conditions: &[&Attribute],
) -> Option<TokenStream> {
    let model = source.model;
    let applying = match steps {
        Some(steps) => of_steps(&Properties::of(steps)),
        None => of_motion(model, source.system.continuous.cyclic.contains(&true)),
    };
    let by_further = further.iter().map(|steps| Further {
        rule: format_ident!("{}", steps.rule.title()),
        checks: of_steps(&Properties::of(steps)),
        by_rule: Box::new(|system| steps.by_rule(system)),
    });
    module(model, &applying, &by_further.collect::<Vec<_>>(), conditions)
}

/// The tests of the clause `check` of a large system, in their own module.
pub(super) fn tests_of_loops(of: &Indexed, conditions: &[&Attribute]) -> Option<TokenStream> {
    let (forced, is_cyclic) = (of.model.forced, of.cyclic.contains(&true));
    let is_monotone = monotone_table_of(of).is_some();
    let by = |rule: &'static NamedRule| {
        let has_energy_steps = rule.step_density && !is_monotone;
        of_steps(&Properties { rule: Some(rule), has_energy_steps, is_monotone, is_cyclic, forced })
    };
    let Some((own, further)) = of.rules.split_first() else {
        return module(&of.model, &of_motion(&of.model, is_cyclic), &[], conditions);
    };
    let further = further.iter().map(|rule| Further {
        rule: format_ident!("{}", rule.name),
        checks: by(rule),
        by_rule: Box::new(|system| by_marker(&format_ident!("{}", rule.marker), &system)),
    });
    module(&of.model, &by(own), &further.collect::<Vec<_>>(), conditions)
}

/// The name of a monotone table in L of a large system.
pub(super) fn monotone_table_of(of: &Indexed) -> Option<String> {
    let rows = of.recursions.iter().flat_map(|recursion| &recursion.parts).map(|part| &part.body);
    let bodies: Vec<_> = rows.chain(of.lagrangian.iter().map(|sum| &sum.body)).collect();
    let is_called = |name: &str| {
        let is_call = |operation: &Operation| matches!(operation, Operation::Opaque(of, _) if *of.name == *name);
        bodies.iter().any(|body| body.slopes.operations.iter().any(|(_, operation)| is_call(operation)))
    };
    let tables = of.model.functions.iter().filter(|function| function.is_monotone());
    tables.map(|function| function.name.to_string()).find(|name| is_called(name))
}

/// The tests of the steps by a further rule.
struct Further<'a> {
    rule: Ident,
    checks: Vec<Check>,
    /// The system as a value that steps with the rule.
    by_rule: Box<dyn Fn(TokenStream) -> TokenStream + 'a>,
}

/// The module with the tests; `None` without a `check` clause.
fn module(model: &Model, applying: &[Check], further: &[Further], conditions: &[&Attribute]) -> Option<TokenStream> {
    let state = model.check_state.as_ref()?;
    let (name, dimension) = (&model.name, Literal::usize_unsuffixed(model.dimension()));
    let module = format_ident!("{}_checks", snake_case(&name.to_string()));
    let documentation = format!(" Checks of [`{name}`](super::{name}) at the state of its `check` clause.");
    let (t, h) = (number(state.t), number(state.h));
    let (q, v) = (state.q.iter().map(|entry| number(*entry)), state.v.iter().map(|entry| number(*entry)));
    let parameters: Vec<_> = state.parameters.iter().map(|(index, value)| set(model, *index, *value)).collect();
    let (system, own, of_further) = if parameters.is_empty() {
        (None, quote!(super::#name::default()), quote!(super::super::#name::default()))
    } else {
        let system = quote! {
            fn system() -> super::#name {
                let mut system = super::#name::default();
                #(#parameters)*
                system
            }
        };
        (Some(system), quote!(system()), quote!(super::system()))
    };
    let tests = tests_of(applying, &own, &quote!(place()));
    let by_further = further.iter().map(|Further { rule, checks, by_rule }| {
        let tests = tests_of(checks, &by_rule(of_further.clone()), &quote!(super::place()));
        quote!(mod #rule { #(#tests)* })
    });
    Some(quote! {
        #[doc = #documentation]
        #(#conditions)*
        #[cfg(test)]
        #[allow(clippy::all, clippy::pedantic, deprecated)]
        mod #module {
            fn place() -> ::vi_core::check::Place<#dimension> {
                ::vi_core::check::Place { t: #t, q: [#(#q),*].into(), v: [#(#v),*].into(), h: #h }
            }

            #system
            #(#tests)*
            #(#by_further)*
        }
    })
}

/// Sets a parameter of `system`.
fn set(model: &Model, index: usize, value: f64) -> Option<TokenStream> {
    let (place, value) = (model.parameters.get(index)?.place(), number(value));
    Some(quote!(system.#place = #value;))
}

/// The name of a check and its further argument.
type Check = (&'static str, TokenStream);

/// One test for each check.
fn tests_of(checks: &[Check], system: &TokenStream, place: &TokenStream) -> Vec<TokenStream> {
    let test = |(check, order): &Check| {
        let check = format_ident!("{check}");
        quote! {
            #[::core::prelude::v1::test]
            fn #check() {
                let checked = ::vi_core::check::#check(&#system, &#place #order);
                if let ::core::result::Result::Err(failure) = checked {
                    ::core::panic!("{failure}");
                }
            }
        }
    };
    checks.iter().map(test).collect()
}

/// The checks that apply to the motion of a system, to its constraints, and to its Gauss steps.
fn of_motion(model: &Model, is_cyclic: bool) -> Vec<Check> {
    let is_constrained = !model.constraints.is_empty();
    let are_holonomic = model.constraints.iter().all(|constraint| constraint.is_holonomic);
    let each = [
        ("derivatives", true),
        ("constraints", is_constrained),
        ("reaction", is_constrained),
        ("gauss_order", true),
        ("gauss_momenta", is_cyclic && !is_constrained),
        ("gauss_symplecticity", are_holonomic && !model.forced),
    ];
    each.into_iter().filter(|(_, applies)| *applies).map(|(check, _)| (check, TokenStream::new())).collect()
}

/// The properties of a system and of its rule that decide which checks of its steps apply.
#[allow(clippy::struct_excessive_bools, reason = "each is a property of its own")]
struct Properties {
    /// The entry of the rule in the table.
    rule: Option<&'static NamedRule>,
    /// Whether energy-preserving steps exist.
    has_energy_steps: bool,
    /// Whether L calls a monotone table, across whose places the step density jumps.
    is_monotone: bool,
    is_cyclic: bool,
    forced: bool,
}

impl Properties {
    /// The properties of a system in straight lines.
    fn of(steps: &Steps) -> Self {
        let is_monotone = steps.model.monotone_table(steps.pool).is_some();
        Self {
            rule: steps.discrete.rule,
            has_energy_steps: steps.discrete.has_energy_steps() && !is_monotone,
            is_monotone,
            is_cyclic: steps.system.continuous.cyclic.contains(&true),
            forced: steps.model.forced,
        }
    }
}

/// The checks that apply to the motion of a system and to its steps by a rule.
fn of_steps(of: &Properties) -> Vec<Check> {
    let Properties { rule, has_energy_steps, is_monotone, is_cyclic, forced } = *of;
    let symmetric = rule.is_some_and(|rule| rule.symmetric);
    let step_density = rule.is_some_and(|rule| rule.step_density) && !is_monotone;
    let order = Literal::u32_unsuffixed(rule.map_or(LEAST_ORDER, |rule| rule.order));
    let each = [
        ("derivatives", true, TokenStream::new()),
        ("slots", true, TokenStream::new()),
        ("steps", true, TokenStream::new()),
        ("energy_equations", has_energy_steps, TokenStream::new()),
        ("order", true, quote!(, #order)),
        ("momenta", is_cyclic, TokenStream::new()),
        ("symplecticity", !forced, TokenStream::new()),
        ("reversibility", symmetric, TokenStream::new()),
        ("energy", step_density, TokenStream::new()),
        ("step_law", step_density && !forced, TokenStream::new()),
    ];
    each.into_iter().filter(|(_, applies, _)| *applies).map(|(check, _, order)| (check, order)).collect()
}
