//! Functions of (t, q, v) with one result, and `flow`.

use super::Source;
use super::body::{Body, VelocityFrom, state_parts};
use super::entries::{self, ResultEntry};
use crate::program::{FunctionId, Output};
use proc_macro2::{Literal, TokenStream};
use quote::{ToTokens as _, format_ident, quote};

/// The vector of one group of results; inference supplies its type.
pub(super) fn vector_of(entries: &[ResultEntry]) -> TokenStream {
    let entries = entries::of(entries.iter().map(|entry| Some(entry).into()));
    quote!(::vi_core::SVector::from(#entries))
}

/// A scalar function of (t, q, v).
pub(super) fn number(source: &Source, id: FunctionId, formula: &str) -> TokenStream {
    function(source, id, formula, (&quote!(T), |body| body.results.number(Output::Value).into_token_stream()))
}

/// A vector function of (t, q, v).
pub(super) fn vector(source: &Source, id: FunctionId, formula: &str) -> TokenStream {
    let dimension = source.dimension();
    let of = &quote!(::vi_core::SVector<T, #dimension>);
    function(source, id, formula, (of, |body| vector_of(body.results.vector(Output::Value))))
}

/// A function of (t, q, v) with a result of this type.
fn function(
    source: &Source,
    id: FunctionId,
    formula: &str,
    (of, result): (&TokenStream, fn(&Body) -> TokenStream),
) -> TokenStream {
    let Some((body, documentation)) = source.documented(id, formula, VelocityFrom::Argument) else {
        return TokenStream::new();
    };
    let (name, dimension) = (format_ident!("{}", id.name()), source.dimension());
    let (inputs, statements, result) = (state_parts(&body, source.model), &body.statements, result(&body));
    quote! {
        #documentation
        #[inline]
        fn #name(
            &self,
            t: T,
            q: &::vi_core::SVector<T, #dimension>,
            v: &::vi_core::SVector<T, #dimension>,
        ) -> #of {
            #inputs #statements #result
        }
    }
}

/// `flow` with this body, which calls its momenta so.
pub(super) fn flow_by(dimension: &Literal, momenta: &TokenStream, body: &TokenStream) -> TokenStream {
    quote! {
        #[inline]
        fn flow(
            &self,
            t: T,
            q: &::vi_core::SVector<T, #dimension>,
            #momenta: &::vi_core::SVector<T, #dimension>,
        ) -> ::core::result::Result<::vi_core::lagrangian::Flow<#dimension, T>, ::vi_core::StepError> {
            #body
        }
    }
}
