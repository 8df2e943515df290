//! `impl Collocation`: the equations of motion in first order, at one point.

use super::Source;
use super::body::{VelocityFrom, state_parts};
use super::lagrangian::{number, vector_of};
use super::matrix::matrix;
use crate::program::{FunctionId, Output};
use proc_macro2::TokenStream;
use quote::quote;

/// The implementation of `Collocation`.
pub(super) fn item(source: &Source) -> TokenStream {
    let (name, dimension) = (&source.model.name, source.dimension());
    let constant_mass = source.findings.constant_mass;
    let separable = source.findings.force_of_position;
    let (form, point) = point(source);
    let power = number(source, FunctionId::Power, &source.formula("dE/dt", source.system.continuous.power));
    quote! {
        impl<T: ::vi_core::real::Real> ::vi_core::collocation::Collocation<#dimension, T> for #name<T> {
            type Mass = #form;
            const CONSTANT_MASS: bool = #constant_mass;
            const SEPARABLE: bool = #separable;
            #point
            #power
        }
    }
}

/// The form of the mass matrix, and the function of L_v, L_q + f and M.
fn point(source: &Source) -> (TokenStream, TokenStream) {
    let dimension = source.dimension();
    let of = &source.system.continuous;
    let formula = format!("L_v, M, and\n\n{}", source.formulas("L_q + f", &of.applied_force));
    let Some((body, documentation)) = source.documented(FunctionId::Point, &formula, VelocityFrom::Argument) else {
        return (TokenStream::new(), TokenStream::new());
    };
    let inputs = state_parts(&body, source.model);
    let statements = &body.statements;
    let (form, mass) = matrix(&source.findings.mass, true, body.results.matrix(Output::Mass));
    let momentum = vector_of(body.results.vector(Output::Momentum));
    let force = vector_of(body.results.vector(Output::AppliedForce));
    let function = quote! {
        #documentation
        #[inline(always)]
        fn point(
            &self,
            t: T,
            q: &::vi_core::SVector<T, #dimension>,
            v: &::vi_core::SVector<T, #dimension>,
        ) -> ::vi_core::collocation::Point<#dimension, T, Self::Mass> {
            #inputs #statements
            ::vi_core::collocation::Point { momentum: #momentum, force: #force, mass: #mass }
        }
    };
    (form, function)
}
