//! `impl DiscreteLagrangian`: L_d, its slot derivatives, discrete forces and powers.

use super::body::{Body, VelocityFrom, part, parts};
use super::state_function::vector_of;
use super::{Source, Steps};
use crate::program::{FunctionId, Output};
use crate::symbol::Symbol;
use proc_macro2::TokenStream;
use quote::{format_ident, quote};
use vi_expr::Expr;

/// The implementation of `DiscreteLagrangian` for the rule.
pub(super) fn item(source: &Steps) -> TokenStream {
    let (name, dimension, of) = (&source.model.name, source.dimension(), &source.discrete.slots);
    let rule = source.rule_argument();
    let functions = [
        number(source, FunctionId::Ld, of.ld),
        number(source, FunctionId::D1Ld, of.d1_ld),
        vector(source, FunctionId::D2Ld, &of.d2_ld),
        number(source, FunctionId::D3Ld, of.d3_ld),
        vector(source, FunctionId::D4Ld, &of.d4_ld),
        vector(source, FunctionId::FdMinus, &of.forces.fd_minus),
        vector(source, FunctionId::FdPlus, &of.forces.fd_plus),
        number(source, FunctionId::GdMinus, of.forces.gd_minus),
        number(source, FunctionId::GdPlus, of.forces.gd_plus),
    ];
    quote! {
        impl<T: ::vi_core::real::Real> ::vi_core::DiscreteLagrangian<#dimension, T #rule> for #name<T> {
            #(#functions)*
        }
    }
}

/// Binds the ends of the interval, its length and its velocity.
fn interval_parts(source: &Source, body: &Body) -> TokenStream {
    let (model, input) = (source.model, |symbol: Symbol| body.inputs.get(&symbol));
    let quotients = (0..model.dimension()).filter_map(|index| {
        let (velocity, h) = (input(Symbol::StepVelocity(index))?, input(Symbol::Step)?);
        let (start, end) = (input(Symbol::Q0(index))?, input(Symbol::Q1(index))?);
        Some(quote!(let #velocity = (#end - #start) / #h;))
    });
    let vectors = |symbol| body.vectors.get(&symbol);
    let velocity = vectors(Symbol::StepVelocity(0)).and_then(|v| {
        let (q0, q1, h) = (vectors(Symbol::Q0(0))?, vectors(Symbol::Q1(0))?, input(Symbol::Step)?);
        let dimension = source.dimension();
        Some(quote!(let #v: [T; #dimension] = ::core::array::from_fn(|index| (#q1[index] - #q0[index]) / #h);))
    });
    let step = part(body, &Symbol::Step, &quote!(interval.t1 - interval.t0));
    let (t0, t1) = (part(body, &Symbol::T0, &quote!(interval.t0)), part(body, &Symbol::T1, &quote!(interval.t1)));
    let q0 = parts(body, model, Symbol::Q0, &quote!(interval.q0));
    let q1 = parts(body, model, Symbol::Q1, &quote!(interval.q1));
    quote!(#t0 #t1 #step #q0 #q1 #(#quotients)* #velocity)
}

/// A scalar function of the slots.
fn number(source: &Source, id: FunctionId, expr: Expr) -> TokenStream {
    let formula = source.formula(id.name(), expr);
    let Some((body, documentation)) = source.documented(id, &formula, VelocityFrom::Interval) else {
        return TokenStream::new();
    };
    let (name, dimension) = (format_ident!("{}", id.name()), source.dimension());
    let (inputs, statements) = (interval_parts(source, &body), &body.statements);
    let result = body.results.number(Output::Value);
    quote! {
        #documentation
        #[inline]
        fn #name(&self, interval: &::vi_core::Interval<#dimension, T>) -> T {
            #inputs #statements #result
        }
    }
}

/// A vector function of the slots.
fn vector(source: &Source, id: FunctionId, exprs: &[Expr]) -> TokenStream {
    let formula = source.formulas(id.name(), exprs);
    let Some((body, documentation)) = source.documented(id, &formula, VelocityFrom::Interval) else {
        return TokenStream::new();
    };
    let (name, dimension) = (format_ident!("{}", id.name()), source.dimension());
    let (inputs, statements) = (interval_parts(source, &body), &body.statements);
    let result = vector_of(body.results.vector(Output::Value));
    quote! {
        #documentation
        #[inline]
        fn #name(
            &self,
            interval: &::vi_core::Interval<#dimension, T>,
        ) -> ::vi_core::SVector<T, #dimension> {
            #inputs #statements #result
        }
    }
}
