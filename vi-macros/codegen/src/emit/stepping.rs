//! `impl FixedStepping` and, for rules with a step density, `impl EnergyStepping`: the equations of one step in the unknowns (v, h).

use super::Steps;
use super::body::{Body, VelocityFrom, part, parts};
use super::entries::ResultEntry;
use super::lagrangian::step_density;
use super::matrix::matrix;
use super::state_function::vector_of;
use crate::model::Model;
use crate::program::{Function, FunctionId, Output, Results};
use crate::symbol::Symbol;
use proc_macro2::TokenStream;
use quote::{ToTokens, format_ident, quote};

/// The implementations of `FixedStepping` and `EnergyStepping` for the rule.
pub(super) fn item(source: &Steps) -> TokenStream {
    let fixed = fixed(source);
    let energy = source.discrete.has_energy_steps().then(|| energy(source));
    quote!(#fixed #energy)
}

fn fixed(source: &Steps) -> TokenStream {
    let (name, dimension) = (&source.model.name, source.dimension());
    let rule = source.rule_argument();
    let rounded = rounded(source);
    let constant = source.findings.constant_jacobian();
    let (form, equation) = momentum_equation(source);
    let (derivatives_form, derivatives) = momentum_derivatives(source);
    let functions = [equation, momentum_residual(source), derivatives, discrete_energy(source)].into_iter().flatten();
    let closed = source.source.findings.closed_form().then(|| {
        quote!(
            const CLOSED_FORM: bool = true;
        )
    });
    let inlined = source.program.has_short_steps().then(|| {
        quote!(
            const INLINED: bool = true;
        )
    });
    quote! {
        impl<T: ::vi_core::real::Real> ::vi_core::stepping::FixedStepping<#dimension, T #rule> for #name<T> {
            type Jacobian = #form;
            type StepMatrix = #derivatives_form;
            const CONSTANT_JACOBIAN: bool = #constant;
            #closed
            #inlined
            #(#functions)*

            /// Bounds the rounding error of the residual by running error analysis.
            #[cold]
            fn momentum_rounding(
                &self,
                node: &::vi_core::node::Node<#dimension, T>,
                h: T,
                v: &::vi_core::SVector<T, #dimension>,
            ) -> ::vi_core::SVector<T, #dimension> {
                ::vi_core::support::momentum_rounding(&#rounded, node, h, v)
            }
        }
    }
}

/// The system with its rule, in numbers that carry a rounding-error bound.
fn rounded(source: &Steps) -> TokenStream {
    source.by_rule(quote!(self.convert::<::vi_core::real::Rounded>()))
}

fn energy(source: &Steps) -> TokenStream {
    let (name, dimension) = (&source.model.name, source.dimension());
    let rule = source.rule_argument();
    let rounded = rounded(source);
    let density = step_density(source);
    let functions =
        [extended_system(source), extended_residual(source), extended_derivatives(source)].into_iter().flatten();
    quote! {
        impl<T: ::vi_core::real::Real> ::vi_core::stepping::EnergyStepping<#dimension, T #rule> for #name<T> {
            #density
            #(#functions)*

            /// Bounds the rounding errors of both residuals by running error analysis.
            #[cold]
            fn extended_rounding(
                &self,
                node: &::vi_core::node::Node<#dimension, T>,
                h: T,
                v: &::vi_core::SVector<T, #dimension>,
            ) -> ::vi_core::stepping::Rounding<#dimension, T> {
                ::vi_core::support::extended_rounding(&#rounded, node, h, v)
            }
        }
    }
}

/// Binds the node, its low parts and the unknowns.
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

/// The fields of `MomentumEquation`, and the form of A.
fn momentum_fields(source: &Steps, results: &Results<ResultEntry>) -> (TokenStream, TokenStream) {
    let residual = vector_of(results.vector(Output::Residual));
    let rows = results.matrix(Output::Jacobian);
    let (form, jacobian) = matrix(&source.findings.pattern, source.findings.symmetric, rows);
    (form, quote!(::vi_core::stepping::MomentumEquation { residual: #residual, jacobian: #jacobian }))
}

/// Number of operations of a function.
fn operations(source: &Steps, id: FunctionId) -> usize {
    source.function(id).map_or(0, Function::operation_count)
}

/// The inlining attribute. A call that is not inlined spills the state of a run and prevents vectorization over
/// trajectories. So all functions except those in pieces are inlined, against LLVM's own estimate.
fn attribute(source: &Steps, id: FunctionId) -> TokenStream {
    if operations(source, id) <= source.limit { quote!(#[inline(always)]) } else { quote!(#[inline(never)]) }
}

/// A function of the node, the step and the velocity.
fn method(
    source: &Steps,
    id: FunctionId,
    formula: &str,
    output: &TokenStream,
    value: impl FnOnce(&Results<ResultEntry>) -> TokenStream,
) -> Option<TokenStream> {
    let (dimension, model) = (source.dimension(), source.model);
    let (body, documentation) = source.documented(id, formula, VelocityFrom::Argument)?;
    let (inputs, statements, value) = (node_parts(&body, model), &body.statements, value(&body.results));
    let (attribute, name) = (attribute(source, id), format_ident!("{}", id.name()));
    Some(quote! {
        #documentation
        #attribute
        fn #name(
            &self,
            node: &::vi_core::node::Node<#dimension, T>,
            h: T,
            v: &::vi_core::SVector<T, #dimension>,
        ) -> #output {
            #inputs #statements
            #value
        }
    })
}

fn momentum_equation(source: &Steps) -> (TokenStream, Option<TokenStream>) {
    let dimension = source.dimension();
    let formula = source.formulas("residual", &source.discrete.equations.residual);
    let output = quote!(::vi_core::stepping::MomentumEquation<#dimension, T, Self::Jacobian>);
    let mut form = TokenStream::new();
    let function = method(source, FunctionId::MomentumEquation, &formula, &output, |results| {
        let (of, equation) = momentum_fields(source, results);
        form = of;
        equation
    });
    (form, function)
}

fn momentum_residual(source: &Steps) -> Option<TokenStream> {
    let dimension = source.dimension();
    let of = &source.discrete.equations;
    let increments = source.named_formulas(&of.momentum_increment, |name| format!("p1_{name} − p0_{name}"));
    let formula = format!("The residual, its rounding scale, and\n\n{increments}");
    let output = quote!(::vi_core::stepping::MomentumResidual<#dimension, T>);
    method(source, FunctionId::MomentumResidual, &formula, &output, |results| {
        let residual = vector_of(results.vector(Output::Residual));
        let scale = vector_of(results.vector(Output::RoundingScale));
        let increment = vector_of(results.vector(Output::MomentumIncrement));
        quote! {
            ::vi_core::stepping::MomentumResidual { residual: #residual, scale: #scale, increment: #increment }
        }
    })
}

/// The fields of `MomentumDerivatives`, and the form of all matrices except A.
fn momentum_derivatives_of(source: &Steps, results: &Results<ResultEntry>) -> (TokenStream, TokenStream) {
    let (_, residual_dv) =
        matrix(&source.findings.pattern, source.findings.symmetric, results.matrix(Output::Jacobian));
    let of = |output| matrix(&source.findings.step_derivatives, false, results.matrix(output));
    let (form, residual_dq) = of(Output::ResidualDq);
    let [(_, increment_dq), (_, increment_dv)] = [Output::MomentumIncrementDq, Output::MomentumIncrementDv].map(of);
    let derivatives = quote! {
        ::vi_core::stepping::MomentumDerivatives {
            residual_dq: #residual_dq,
            residual_dv: #residual_dv,
            increment_dq: #increment_dq,
            increment_dv: #increment_dv,
        }
    };
    (form, derivatives)
}

fn momentum_derivatives(source: &Steps) -> (TokenStream, Option<TokenStream>) {
    let formula = "Derivatives of the residual and of `p1 − p0` with respect to the coordinates of the node and v.";
    let output = quote!(::vi_core::stepping::MomentumDerivatives<Self::Jacobian, Self::StepMatrix>);
    let mut form = TokenStream::new();
    let function = method(source, FunctionId::MomentumDerivatives, formula, &output, |results| {
        let (of, derivatives) = momentum_derivatives_of(source, results);
        form = of;
        derivatives
    });
    (form, function)
}

fn extended_derivatives(source: &Steps) -> Option<TokenStream> {
    let dimension = source.dimension();
    let formula =
        "Derivatives of both residuals, `p1 − p0` and `E1 − E0` with respect to the coordinates of the node, v and h.";
    let output = quote!(::vi_core::stepping::ExtendedDerivatives<#dimension, T, Self::Jacobian, Self::StepMatrix>);
    method(source, FunctionId::ExtendedDerivatives, formula, &output, |results| {
        let (_, momentum) = momentum_derivatives_of(source, results);
        let vector = |output| vector_of(results.vector(output));
        let residual_dh = vector(Output::ResidualDh);
        let increment_dh = vector(Output::MomentumIncrementDh);
        let [energy_dq, energy_dv] = [Output::EnergyDq, Output::EnergyDv].map(vector);
        let energy_dh = results.number(Output::EnergyDh);
        let [energy_increment_dq, energy_increment_dv] =
            [Output::EnergyIncrementDq, Output::EnergyIncrementDv].map(vector);
        let energy_increment_dh = results.number(Output::EnergyIncrementDh);
        quote! {
            ::vi_core::stepping::ExtendedDerivatives {
                momentum: #momentum,
                residual_dh: #residual_dh,
                increment_dh: #increment_dh,
                energy_dq: #energy_dq,
                energy_dv: #energy_dv,
                energy_dh: #energy_dh,
                energy_increment_dq: #energy_increment_dq,
                energy_increment_dv: #energy_increment_dv,
                energy_increment_dh: #energy_increment_dh,
            }
        }
    })
}

fn discrete_energy(source: &Steps) -> Option<TokenStream> {
    let formula = source.formula("E1", source.discrete.equations.discrete_energy);
    method(source, FunctionId::DiscreteEnergy, &formula, &quote!(T), |results| {
        results.number(Output::Value).to_token_stream()
    })
}

fn extended_system(source: &Steps) -> Option<TokenStream> {
    let dimension = source.dimension();
    let formula = source.formula("energy_residual", source.discrete.equations.energy_residual);
    let output = quote!(::vi_core::stepping::ExtendedSystem<#dimension, T, Self::Jacobian>);
    method(source, FunctionId::ExtendedSystem, &formula, &output, |results| {
        let (_, momentum) = momentum_fields(source, results);
        let residual_dh = vector_of(results.vector(Output::ResidualDh));
        let energy_residual = results.number(Output::EnergyResidual);
        let energy_dv = vector_of(results.vector(Output::EnergyDv));
        let energy_dh = results.number(Output::EnergyDh);
        quote! {
            ::vi_core::stepping::ExtendedSystem {
                momentum: #momentum,
                residual_dh: #residual_dh,
                energy_residual: #energy_residual,
                energy_dv: #energy_dv,
                energy_dh: #energy_dh,
            }
        }
    })
}

fn extended_residual(source: &Steps) -> Option<TokenStream> {
    let dimension = source.dimension();
    let of = &source.discrete.equations;
    let formula =
        format!("Both residuals, their rounding scales, and\n\n{}", source.formula("E1 − E0", of.energy_increment));
    let output = quote!(::vi_core::stepping::ExtendedResidual<#dimension, T>);
    method(source, FunctionId::ExtendedResidual, &formula, &output, |results| {
        let residual = vector_of(results.vector(Output::Residual));
        let scale = vector_of(results.vector(Output::RoundingScale));
        let energy_residual = results.number(Output::EnergyResidual);
        let energy_scale = results.number(Output::EnergyRoundingScale);
        let momentum = vector_of(results.vector(Output::MomentumIncrement));
        let energy = results.number(Output::EnergyIncrement);
        quote! {
            ::vi_core::stepping::ExtendedResidual {
                residual: #residual,
                scale: #scale,
                energy_residual: #energy_residual,
                energy_scale: #energy_scale,
                increment: ::vi_core::stepping::Increment { momentum: #momentum, energy: #energy },
            }
        }
    })
}
