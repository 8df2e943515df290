//! `impl Stepping`: the equations of one step in the unknowns (v, h).

use super::Source;
use super::body::{Body, Entry, Place, part, parts};
use super::lagrangian::vector_of;
use super::matrix::matrix;
use crate::model::Model;
use crate::program::Function;
use crate::symbol::Symbol;
use proc_macro2::TokenStream;
use quote::{format_ident, quote};

/// Operations up to which the functions of a momentum step are short: `Stepping::INLINED`.
const INLINED: usize = 250;

/// The implementation of `Stepping`.
pub(super) fn item(source: &Source) -> TokenStream {
    let (name, dimension) = (&source.model.name, source.dimension());
    let constant = source.findings.constant_jacobian();
    let (form, equation) = momentum_equation(source);
    let functions = [equation, momentum_residual(source), extended_system(source), extended_residual(source)];
    let functions = functions.into_iter().flatten();
    let closed = source.findings.closed_form().then(|| {
        quote!(
            const CLOSED_FORM: bool = true;
        )
    });
    let is_inlined =
        ["momentum_equation", "momentum_residual"].into_iter().all(|name| operations(source, name) <= INLINED);
    let inlined = is_inlined.then(|| {
        quote!(
            const INLINED: bool = true;
        )
    });
    quote! {
        impl<T: ::vi_core::Real> ::vi_core::Stepping<#dimension, T> for #name<T> {
            type Jacobian = #form;
            const CONSTANT_JACOBIAN: bool = #constant;
            #closed
            #inlined
            #(#functions)*

            /// What the rounding of both residuals is measured in, by running error analysis.
            #[cold]
            fn rounding(
                &self,
                node: &::vi_core::Node<#dimension, T>,
                h: T,
                v: &::vi_core::SVector<T, #dimension>,
            ) -> ::vi_core::Rounding<#dimension, T> {
                ::vi_core::Rounding::of(&self.convert::<::vi_core::real::Rounded>(), node, h, v)
            }
        }
    }
}

/// The node, its low parts, and the unknowns.
fn node_parts(body: &Body, model: &Model) -> TokenStream {
    let low = |symbol: Symbol| Symbol::Low(Box::new(symbol));
    let (node, numbers) = (
        [
            parts(body, model, Symbol::Q0, &quote!(node.q)),
            parts(body, model, |index| low(Symbol::Q0(index)), &quote!(node.q_low)),
            parts(body, model, Symbol::P0, &quote!(node.p)),
            parts(body, model, |index| low(Symbol::P0(index)), &quote!(node.p_low)),
            parts(body, model, Symbol::StepVelocity, &quote!((*v))),
        ],
        [
            part(body, &Symbol::T0, &quote!(node.t)),
            part(body, &low(Symbol::T0), &quote!(node.t_low)),
            part(body, &Symbol::E0, &quote!(node.energy)),
            part(body, &low(Symbol::E0), &quote!(node.energy_low)),
        ],
    );
    quote!(#(#numbers)* #(#node)*)
}

/// The momentum row, residual and rows of A, as `MomentumEquation` holds them; and the form of A.
fn momentum_fields(source: &Source, results: &[Vec<Entry>]) -> (TokenStream, TokenStream) {
    let residual = vector_of(&results[0]);
    let (form, jacobian) = matrix(&source.findings.pattern, source.findings.symmetric, &results[1..]);
    (form, quote!(::vi_core::MomentumEquation { residual: #residual, jacobian: #jacobian }))
}

/// How many operations a function has.
fn operations(source: &Source, name: &str) -> usize {
    source.function(name).map_or(0, Function::operation_count)
}

/// A call that is not inlined spills the run's state out of registers, and keeps a loop over trajectories from becoming vector
/// instructions: functions are inlined whatever the compiler thinks of it, but for those that are in pieces.
fn attribute(source: &Source, name: &str) -> TokenStream {
    if operations(source, name) <= source.limit { quote!(#[inline(always)]) } else { quote!(#[inline(never)]) }
}

/// A function of `Stepping`: of the node, the step and the velocity.
fn method(
    source: &Source,
    name: &str,
    formula: &str,
    output: &TokenStream,
    value: impl FnOnce(&Body) -> Option<TokenStream>,
) -> Option<TokenStream> {
    let (dimension, model) = (source.dimension(), source.model);
    let (body, documentation) = source.documented(name, formula, Place::Argument)?;
    let (inputs, statements, value) = (node_parts(&body, model), &body.statements, value(&body)?);
    let (attribute, name) = (attribute(source, name), format_ident!("{name}"));
    Some(quote! {
        #documentation
        #attribute
        fn #name(
            &self,
            node: &::vi_core::Node<#dimension, T>,
            h: T,
            v: &::vi_core::SVector<T, #dimension>,
        ) -> #output {
            #inputs #statements
            #value
        }
    })
}

fn momentum_equation(source: &Source) -> (TokenStream, Option<TokenStream>) {
    let dimension = source.dimension();
    let formula = source.formulas("residual", &source.system.equations.residual);
    let output = quote!(::vi_core::MomentumEquation<#dimension, T, Self::Jacobian>);
    let mut form = TokenStream::new();
    let function = method(source, "momentum_equation", &formula, &output, |body| {
        let (of, equation) = momentum_fields(source, &body.results);
        form = of;
        Some(equation)
    });
    (form, function)
}

fn momentum_residual(source: &Source) -> Option<TokenStream> {
    let dimension = source.dimension();
    let of = &source.system.equations;
    let formula = format!("The residual, its magnitude, and\n\n{}", source.formulas("p1 − p0", &of.momentum_increment));
    let output = quote!(::vi_core::MomentumResidual<#dimension, T>);
    method(source, "momentum_residual", &formula, &output, |body| {
        let [residual, magnitude, increment] = &body.results[..] else { return None };
        let [residual, magnitude, increment] = [residual, magnitude, increment].map(|entries| vector_of(entries));
        Some(quote! {
            ::vi_core::MomentumResidual { residual: #residual, magnitude: #magnitude, increment: #increment }
        })
    })
}

fn extended_system(source: &Source) -> Option<TokenStream> {
    let dimension = source.dimension();
    let formula = source.formula("energy_residual", source.system.equations.energy_residual);
    let output = quote!(::vi_core::ExtendedSystem<#dimension, T, Self::Jacobian>);
    method(source, "extended_system", &formula, &output, |body| {
        let (momentum, energy) = body.results.split_at(source.model.dimension() + 1);
        let (_, momentum) = momentum_fields(source, momentum);
        let [residual_dh, energy_residual, energy_dv, energy_dh] = energy else { return None };
        let (residual_dh, energy_dv) = (vector_of(residual_dh), vector_of(energy_dv));
        Some(quote! {
            ::vi_core::ExtendedSystem {
                momentum: #momentum,
                residual_dh: #residual_dh,
                energy_residual: #(#energy_residual)*,
                energy_dv: #energy_dv,
                energy_dh: #(#energy_dh)*,
            }
        })
    })
}

fn extended_residual(source: &Source) -> Option<TokenStream> {
    let dimension = source.dimension();
    let of = &source.system.equations;
    let formula =
        format!("Both residuals, their magnitudes, and\n\n{}", source.formula("E1 − E0", of.energy_increment));
    let output = quote!(::vi_core::ExtendedResidual<#dimension, T>);
    method(source, "extended_residual", &formula, &output, |body| {
        let [residual, magnitude, energy_residual, energy_magnitude, momentum, energy] = &body.results[..] else {
            return None;
        };
        let [residual, magnitude, momentum] = [residual, magnitude, momentum].map(|entries| vector_of(entries));
        Some(quote! {
            ::vi_core::ExtendedResidual {
                residual: #residual,
                magnitude: #magnitude,
                energy_residual: #(#energy_residual)*,
                energy_magnitude: #(#energy_magnitude)*,
                increment: ::vi_core::Increment { momentum: #momentum, energy: #(#energy)* },
            }
        })
    })
}
