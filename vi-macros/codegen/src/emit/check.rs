//! The checks of a system: one test for each check that applies.
//!
//! The table of rules, the forces and the cyclic coordinates decide which checks apply. A rule outside the table is
//! expected to have order 1 and no other property. A system with several rules has the tests once per rule. A system
//! without a rule has the tests of its motion and of its Gauss steps; one with constraints those of its Gauss–Lobatto
//! steps.

use super::formula::number;
use super::lagrangian::monotone_table;
use super::{Source, Steps};
use crate::pretty::snake_case;
use crate::rules::LEAST_ORDER;
use proc_macro2::{Literal, TokenStream};
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
    let state = source.model.check_state.as_ref()?;
    let (name, dimension) = (&source.model.name, source.dimension());
    let module = format_ident!("{}_checks", snake_case(&name.to_string()));
    let documentation = format!(" Checks of [`{name}`](super::{name}) at the state of its `check` clause.");
    let (t, h) = (number(state.t), number(state.h));
    let (q, v) = (state.q.iter().map(|entry| number(*entry)), state.v.iter().map(|entry| number(*entry)));
    let parameters: Vec<_> = state.parameters.iter().map(|(index, value)| set(source, *index, *value)).collect();
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
    let applying = match steps {
        Some(steps) => of_steps(steps),
        None if source.model.constraints.is_empty() => of_motion(source),
        None => of_constraints(source),
    };
    let tests = tests_of(applying, &own, &quote!(place()));
    let by_further = further.iter().map(|steps| {
        let rule = format_ident!("{}", steps.rule.title());
        let tests = tests_of(of_steps(steps), &steps.by_rule(of_further.clone()), &quote!(super::place()));
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
fn set(source: &Source, index: usize, value: f64) -> Option<TokenStream> {
    let (place, value) = (source.model.parameters.get(index)?.place(), number(value));
    Some(quote!(system.#place = #value;))
}

/// The name of a check and its further argument.
type Check = (&'static str, TokenStream);

/// One test for each check.
fn tests_of(checks: Vec<Check>, system: &TokenStream, place: &TokenStream) -> Vec<TokenStream> {
    let test = |(check, order): Check| {
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
    checks.into_iter().map(test).collect()
}

/// The checks that apply to the motion of a system and to its Gauss steps.
fn of_motion(source: &Source) -> Vec<Check> {
    let each = [
        ("derivatives", true),
        ("gauss_order", true),
        ("gauss_momenta", source.system.continuous.cyclic.contains(&true)),
        ("gauss_symplecticity", !source.model.forced),
    ];
    each.into_iter().filter(|(_, applies)| *applies).map(|(check, _)| (check, TokenStream::new())).collect()
}

/// The checks that apply to a system with constraints and to its Gauss–Lobatto steps.
fn of_constraints(source: &Source) -> Vec<Check> {
    let are_holonomic = source.model.constraints.iter().all(|constraint| constraint.is_holonomic);
    let each = [
        ("constrained_derivatives", true),
        ("constraints", true),
        ("reaction", true),
        ("lobatto_order", true),
        ("lobatto_symplecticity", are_holonomic && !source.model.forced),
    ];
    each.into_iter().filter(|(_, applies)| *applies).map(|(check, _)| (check, TokenStream::new())).collect()
}

/// The checks that apply to the motion of a system and to its steps by a rule.
fn of_steps(steps: &Steps) -> Vec<Check> {
    let forced = steps.model.forced;
    let rule = steps.discrete.rule;
    let symmetric = rule.is_some_and(|rule| rule.symmetric);
    let is_monotone = monotone_table(steps).is_some();
    let step_density = rule.is_some_and(|rule| rule.step_density) && !is_monotone;
    let order = Literal::u32_unsuffixed(rule.map_or(LEAST_ORDER, |rule| rule.order));
    let each = [
        ("derivatives", true, TokenStream::new()),
        ("slots", true, TokenStream::new()),
        ("steps", true, TokenStream::new()),
        ("energy_equations", steps.discrete.has_energy_steps() && !is_monotone, TokenStream::new()),
        ("order", true, quote!(, #order)),
        ("momenta", steps.system.continuous.cyclic.contains(&true), TokenStream::new()),
        ("symplecticity", !forced, TokenStream::new()),
        ("reversibility", symmetric, TokenStream::new()),
        ("energy", step_density, TokenStream::new()),
        ("step_law", step_density && !forced, TokenStream::new()),
    ];
    each.into_iter().filter(|(_, applies, _)| *applies).map(|(check, _, order)| (check, order)).collect()
}
