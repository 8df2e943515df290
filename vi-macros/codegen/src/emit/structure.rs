//! The struct of a system: its parameters as public fields, their defaults, their names.

use super::Source;
use super::formula::number;
use crate::syntax::System;
use proc_macro2::TokenStream;
use quote::quote;

/// The struct, `Default`, `Parameters`, and the conversion to another kind of number.
pub(super) fn items(source: &Source) -> TokenStream {
    let model = source.model;
    let (name, visibility, attributes) = (&model.name, &model.visibility, &model.attributes);
    let names: Vec<_> = model.parameters.iter().map(|parameter| &parameter.name).collect();
    let texts = names.iter().map(ToString::to_string);
    let spellings = texts.clone();
    let defaults = model.parameters.iter().map(|parameter| number(parameter.default));
    let fields = model.parameters.iter().map(|parameter| {
        let (name, attributes) = (&parameter.name, &parameter.attributes);
        let default = format!(" Parameter `{name}`, {} by default.", parameter.default);
        let pause = pause(attributes);
        quote!(#(#attributes)* #pause #[doc = #default] pub #name: T)
    });
    let found = found(source);
    let arms = names.iter().zip(texts).map(|(name, text)| quote!(#text => Some(&mut self.#name)));
    let (marker, marker_value) = marker(names.is_empty());
    quote! {
        #(#attributes)*
        #found
        #[derive(Clone, Copy, Debug, PartialEq)]
        #[allow(non_snake_case)]
        #visibility struct #name<T = f64> {
            #(#fields,)*
            #marker
        }

        impl ::core::default::Default for #name<f64> {
            fn default() -> Self {
                Self { #(#names: #defaults,)* #marker_value }
            }
        }

        impl<T: ::vi_core::Real> #name<T> {
            /// The same system in another kind of number, every parameter rounded to it.
            #[allow(unused_variables)]
            pub fn from_f64(system: &#name<f64>) -> Self {
                Self { #(#names: T::real(system.#names),)* #marker_value }
            }
        }

        impl<T: ::vi_core::Real> ::vi_core::Parameters<T> for #name<T> {
            const PARAMETERS: &'static [&'static str] = &[#(#spellings),*];

            fn parameter_mut(&mut self, name: &str) -> ::core::option::Option<&mut T> {
                match name {
                    #(#arms,)*
                    _ => None,
                }
            }
        }
    }
}

/// What the generator found out, as the end of the struct's documentation.
fn found(source: &Source) -> TokenStream {
    let model = source.model;
    let rule = format!(" Discretized by the rule `{}`. What the generator found:", model.rule_name);
    let findings = source.findings.lines(&|index| format!("`{}`", model.coordinates[index].text()));
    let findings = findings.into_iter().map(|line| format!(" * {line}"));
    let pause = pause(&model.attributes);
    quote!(#pause #[doc = #rule] #[doc = ""] #(#[doc = #findings])*)
}

/// An empty line of documentation after the user's own words, so that ours are a paragraph of their own.
fn pause(attributes: &[syn::Attribute]) -> Option<TokenStream> {
    attributes.iter().any(|attribute| attribute.path().is_ident("doc")).then(|| quote!(#[doc = ""]))
}

/// What is emitted beside the errors of a broken system, so that the code that uses its struct still type-checks.
#[must_use]
pub fn stub(system: &System) -> TokenStream {
    let (name, visibility) = (&system.name, &system.visibility);
    let parameters: Vec<_> = system.parameters.iter().map(|parameter| &parameter.name).collect();
    let (marker, marker_value) = marker(parameters.is_empty());
    quote! {
        #[allow(missing_docs, dead_code, non_snake_case)]
        #visibility struct #name<T = f64> { #(pub #parameters: T,)* #marker }
        impl ::core::default::Default for #name<f64> {
            fn default() -> Self {
                Self { #(#parameters: 0.0,)* #marker_value }
            }
        }
    }
}

/// The field that a system without parameters knows its kind of number by, and its value; nothing for others.
fn marker(needed: bool) -> (TokenStream, TokenStream) {
    if needed {
        (
            quote!(#[doc(hidden)] pub numbers: ::core::marker::PhantomData<T>),
            quote!(numbers: ::core::marker::PhantomData),
        )
    } else {
        (TokenStream::new(), TokenStream::new())
    }
}
