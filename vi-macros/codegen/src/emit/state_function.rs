//! Functions of (t, q, v) with one result.

use super::Source;
use super::body::{VelocityFrom, state_parts};
use super::entries::{self, ResultEntry};
use crate::program::{FunctionId, Output};
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

/// The vector of one group of results; inference supplies its type.
pub(super) fn vector_of(entries: &[ResultEntry]) -> TokenStream {
    let entries = entries::of(entries.iter().map(|entry| Some(entry).into()));
    quote!(::vi_core::SVector::from(#entries))
}

/// A scalar function of (t, q, v).
pub(super) fn number(source: &Source, id: FunctionId, formula: &str) -> TokenStream {
    let Some((body, documentation)) = source.documented(id, formula, VelocityFrom::Argument) else {
        return TokenStream::new();
    };
    let (name, dimension) = (format_ident!("{}", id.name()), source.dimension());
    let (inputs, statements) = (state_parts(&body, source.model), &body.statements);
    let result = body.results.number(Output::Value);
    quote! {
        #documentation
        #[inline]
        fn #name(
            &self,
            t: T,
            q: &::vi_core::SVector<T, #dimension>,
            v: &::vi_core::SVector<T, #dimension>,
        ) -> T {
            #inputs #statements #result
        }
    }
}

/// A vector function of (t, q, v).
pub(super) fn vector(source: &Source, id: FunctionId, formula: &str) -> TokenStream {
    let Some((body, documentation)) = source.documented(id, formula, VelocityFrom::Argument) else {
        return TokenStream::new();
    };
    let (name, dimension) = (format_ident!("{}", id.name()), source.dimension());
    let (inputs, statements) = (state_parts(&body, source.model), &body.statements);
    let result = vector_of(body.results.vector(Output::Value));
    quote! {
        #documentation
        #[inline]
        fn #name(
            &self,
            t: T,
            q: &::vi_core::SVector<T, #dimension>,
            v: &::vi_core::SVector<T, #dimension>,
        ) -> ::vi_core::SVector<T, #dimension> {
            #inputs #statements #result
        }
    }
}
