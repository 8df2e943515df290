//! `impl Motion`: the first-order equations of motion at one point.

use super::Source;
use super::body::{Body, VelocityFrom, state_parts};
use super::constraints::{self, Members};
use super::matrix::matrix;
use super::state_function::{number, vector, vector_of};
use crate::discrete::continuous::TimeScale;
use crate::program::{FunctionId, Output};
use proc_macro2::TokenStream;
use quote::quote;

/// The implementation of `Motion`.
pub(super) fn item(source: &Source) -> TokenStream {
    let (name, dimension) = (&source.model.name, source.dimension());
    let Members { kind, items, functions } = match &source.system.constraints {
        Some(of) => constraints::members(source, of),
        None => Members { functions: of_first_order(source), ..Members::free() },
    };
    let constant_mass = source.findings.constant_mass;
    let separable = source.findings.force_of_position && source.system.constraints.is_none();
    let (form, point) = point(source);
    let (derivatives_form, point_derivatives) = point_derivatives(source);
    let scaled_point = source.system.continuous.time_scale.as_ref().map(|scale| scaled_point(source, scale));
    let scales_time = scaled_point.is_some().then(|| {
        quote!(
            const SCALES_TIME: bool = true;
        )
    });
    let has_time_scale = scaled_point.is_some().then(|| {
        quote! {
            impl<T: ::vi_core::real::Real> ::vi_core::motion::TimeScale<#dimension, T> for #name<T> {}
        }
    });
    let curvilinear = source.findings.curvilinear.then(|| {
        quote!(
            const CURVILINEAR: bool = true;
        )
    });
    let splits = source.findings.canonical_split.then(|| {
        quote!(
            const SPLITS: bool = true;
        )
    });
    let is_separable = (separable || source.findings.canonical_split).then(|| {
        quote! {
            impl<T: ::vi_core::real::Real> ::vi_core::motion::Separable<#dimension, T> for #name<T> {}
        }
    });
    let power = number(source, FunctionId::Power, &source.formula("dE/dt", source.system.continuous.power));
    quote! {
        #items
        impl<T: ::vi_core::real::Real> ::vi_core::motion::Motion<#dimension, T> for #name<T> {
            type Kind = #kind;
            type Mass = #form;
            type PointMatrix = #derivatives_form;
            const CONSTANT_MASS: bool = #constant_mass;
            #curvilinear
            const SEPARABLE: bool = #separable;
            #splits
            #scales_time
            #point
            #point_derivatives
            #power
            #scaled_point
            #functions
        }
        #has_time_scale
        #is_separable
    }
}

/// Additional members for a system whose L is linear in the velocities; nothing for others.
fn of_first_order(source: &Source) -> TokenStream {
    let without = &source.model.without_velocity;
    if without.is_empty() {
        return TokenStream::new();
    }
    let formula = source.formulas("(L_q + f − dϑ/dt)", &source.system.continuous.mass_times_acceleration);
    let applied = vector(source, FunctionId::Applied, &formula);
    quote! {
        const WITHOUT_VELOCITY: &'static [bool] = &[#(#without),*];
        #applied
    }
}

/// The form of the mass matrix, and the function that computes L_v, L_q + f and M.
fn point(source: &Source) -> (TokenStream, TokenStream) {
    let dimension = source.dimension();
    let of = &source.system.continuous;
    let formula = format!("L_v, M, and\n\n{}", source.formulas("L_q + f", &of.applied_force));
    let Some((body, documentation)) = source.documented(FunctionId::Point, &formula, VelocityFrom::Argument) else {
        return (TokenStream::new(), TokenStream::new());
    };
    let inputs = state_parts(&body, source.model);
    let statements = &body.statements;
    let (form, value) = point_of(source, &body);
    let function = quote! {
        #documentation
        #[inline(always)]
        fn point(
            &self,
            t: T,
            q: &::vi_core::SVector<T, #dimension>,
            v: &::vi_core::SVector<T, #dimension>,
        ) -> ::vi_core::motion::Point<#dimension, T, Self::Mass> {
            #inputs #statements
            #value
        }
    };
    (form, function)
}

/// The form of the matrices, and the function that computes M and the derivatives of L_v and L_q + f.
fn point_derivatives(source: &Source) -> (TokenStream, TokenStream) {
    let dimension = source.dimension();
    let formula = "M = ∂L_v/∂v, ∂L_v/∂q, ∂(L_q + f)/∂q and ∂(L_q + f)/∂v.";
    let Some((body, documentation)) = source.documented(FunctionId::PointDerivatives, formula, VelocityFrom::Argument)
    else {
        return (TokenStream::new(), TokenStream::new());
    };
    let inputs = state_parts(&body, source.model);
    let statements = &body.statements;
    let of = |output| matrix(&source.findings.point_derivatives, false, body.results.matrix(output));
    let (form, mass) = of(Output::Mass);
    let [(_, momentum_dq), (_, force_dq), (_, force_dv)] =
        [Output::MomentumDq, Output::ForceDq, Output::ForceDv].map(of);
    let function = quote! {
        #documentation
        #[inline(always)]
        fn point_derivatives(
            &self,
            t: T,
            q: &::vi_core::SVector<T, #dimension>,
            v: &::vi_core::SVector<T, #dimension>,
        ) -> ::vi_core::motion::PointDerivatives<Self::PointMatrix> {
            #inputs #statements
            ::vi_core::motion::PointDerivatives {
                momentum_dq: #momentum_dq, mass: #mass, force_dq: #force_dq, force_dv: #force_dv
            }
        }
    };
    (form, function)
}

/// The form of the mass matrix, and the point computed by a body.
fn point_of(source: &Source, body: &Body) -> (TokenStream, TokenStream) {
    let (form, mass) = matrix(&source.findings.mass, true, body.results.matrix(Output::Mass));
    let momentum = vector_of(body.results.vector(Output::Momentum));
    let force = vector_of(body.results.vector(Output::AppliedForce));
    (form, quote!(::vi_core::motion::Point { momentum: #momentum, force: #force, mass: #mass }))
}

/// The function of everything that a step in transformed time evaluates at a point.
fn scaled_point(source: &Source, scale: &TimeScale) -> TokenStream {
    let dimension = source.dimension();
    let formula = format!("The point, its energy, its power, and\n\n{}", source.formula("g", scale.g));
    let Some((body, documentation)) = source.documented(FunctionId::ScaledPoint, &formula, VelocityFrom::Argument)
    else {
        return TokenStream::new();
    };
    let inputs = state_parts(&body, source.model);
    let statements = &body.statements;
    let (_, point) = point_of(source, &body);
    let energy = body.results.number(Output::Energy);
    let power = body.results.number(Output::Power);
    let g = body.results.number(Output::TimeScale);
    let g_dq = vector_of(body.results.vector(Output::TimeScaleDq));
    let g_dt = body.results.number(Output::TimeScaleDt);
    quote! {
        #documentation
        #[inline(always)]
        fn scaled_point(
            &self,
            t: T,
            q: &::vi_core::SVector<T, #dimension>,
            v: &::vi_core::SVector<T, #dimension>,
        ) -> ::vi_core::motion::ScaledPoint<#dimension, T, Self::Mass> {
            #inputs #statements
            ::vi_core::motion::ScaledPoint {
                point: #point, energy: #energy, power: #power, g: #g, g_dq: #g_dq, g_dt: #g_dt
            }
        }
    }
}
