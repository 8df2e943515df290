//! `impl Stepping`: the equations of one step in the unknowns (v, h).

use super::Source;
use super::body::{Body, Entry, Place, part, parts};
use super::entries::{Part, array, zero};
use super::lagrangian::vector_of;
use super::matrix::matrix;
use crate::model::Model;
use crate::program::{Function, Operation};
use crate::symbol::{Symbol, Variable};
use num_traits::ToPrimitive;
use proc_macro2::TokenStream;
use quote::{ToTokens, format_ident, quote};

/// Operations up to which a function is always inlined.
const INLINED: usize = 250;

/// The implementation of `Stepping`.
pub(super) fn item(source: &Source) -> TokenStream {
    let (name, dimension) = (&source.model.name, source.dimension());
    let (constant, smooth) = (source.findings.constant_jacobian(), source.findings.smooth);
    let (form, equation) = momentum_equation(source);
    let functions = [equation, extended_system(source), magnitudes(source), increment(source)];
    let functions = functions.into_iter().chain([momentum_step(source), extended_step(source)]).flatten();
    let place = place(source);
    let closed = source.findings.closed_form().then(|| {
        quote!(
            const CLOSED_FORM: bool = true;
        )
    });
    quote! {
        #[allow(clippy::all, clippy::pedantic, non_snake_case, unused_variables, unused_parens)]
        impl<T: ::vi_core::Real> ::vi_core::Stepping<#dimension, T> for #name<T> {
            type Jacobian = #form;
            const CONSTANT_JACOBIAN: bool = #constant;
            const SMOOTH: bool = #smooth;
            #closed
            #place
            #(#functions)*
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

/// In a loop over trajectories a call is a wall: short functions are inlined whatever the compiler thinks of it. Long ones
/// stand in several places of a stepper, and would be compiled in each, even if it is only the copying from and to pieces.
/// Magnitudes are for the rare path.
fn attribute(source: &Source, name: &str) -> TokenStream {
    if name == "magnitudes" {
        return quote!(#[cold]);
    }
    match source.function(name).map_or(0, Function::operation_count) {
        0..=INLINED => quote!(#[inline(always)]),
        count if count <= source.limit => quote!(#[inline]),
        _ => quote!(#[inline(never)]),
    }
}

/// A function of `Stepping`: of the node, the step and the velocity, of what `solve` makes of the equations where it has
/// that, and told the place where it has that.
struct Method {
    name: &'static str,
    formula: String,
    solve: Option<TokenStream>,
    told: bool,
    output: TokenStream,
}

impl Method {
    /// One of a node, the step and the velocity only.
    fn new(name: &'static str, formula: String, output: TokenStream) -> Self {
        Self { name, formula, solve: None, told: false, output }
    }

    /// Its tokens, with the value that `value` makes of its body; `None` where the program does not have it.
    fn tokens(self, source: &Source, value: impl FnOnce(&Body) -> Option<TokenStream>) -> Option<TokenStream> {
        let Self { name, formula, solve, told, output } = self;
        let (dimension, model) = (source.dimension(), source.model);
        let (body, documentation) = source.documented(name, &formula, Place::Argument)?;
        let (inputs, statements, value) = (node_parts(&body, model), &body.statements, value(&body)?);
        let places = source.system.equations.place.as_ref().filter(|_| told).map(|(point, _)| {
            parts(&body, model, |i| Symbol::AtPoint(*point, Variable::Coordinate(i)), &quote!((*place)))
        });
        let place = told.then(|| quote!(place: &::vi_core::SVector<T, #dimension>,));
        let (attribute, name) = (attribute(source, name), format_ident!("{name}"));
        Some(quote! {
            #documentation
            #attribute
            fn #name(
                &self,
                node: &::vi_core::Node<#dimension, T>,
                #place
                h: T,
                v: &::vi_core::SVector<T, #dimension>,
                #solve
            ) -> #output {
                #inputs #places #statements
                #value
            }
        })
    }
}

fn momentum_equation(source: &Source) -> (TokenStream, Option<TokenStream>) {
    let dimension = source.dimension();
    let formula = source.formulas("residual", &source.system.equations.residual);
    let output = quote!(::vi_core::MomentumEquation<#dimension, T, Self::Jacobian>);
    let mut form = TokenStream::new();
    let function = Method::new("momentum_equation", formula, output).tokens(source, |body| {
        let (of, equation) = momentum_fields(source, &body.results);
        form = of;
        Some(equation)
    });
    (form, function)
}

fn extended_system(source: &Source) -> Option<TokenStream> {
    let dimension = source.dimension();
    let formula = source.formula("energy_residual", source.system.equations.energy_residual);
    let output = quote!(::vi_core::ExtendedSystem<#dimension, T, Self::Jacobian>);
    Method::new("extended_system", formula, output).tokens(source, |body| extended_fields(source, &body.results))
}

/// Both rows, as `ExtendedSystem` holds them.
fn extended_fields(source: &Source, results: &[Vec<Entry>]) -> Option<TokenStream> {
    let (momentum, energy) = results.split_at(source.model.dimension() + 1);
    let (_, momentum) = momentum_fields(source, momentum);
    let [residual_dh, energy_residual, energy_dv, energy_dh, ..] = energy else {
        return None;
    };
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
}

/// The part of the step at whose end `momentum_step` and `extended_step` are told the coordinates.
fn place(source: &Source) -> Option<TokenStream> {
    let (_, part) = source.system.equations.place.as_ref()?;
    let reads =
        |operation: &Operation| matches!(operation, Operation::Input(Symbol::AtPoint(_, Variable::Coordinate(_))));
    let told =
        |step: &Function| step.operations.needed(&step.results).into_iter().any(|id| reads(step.operations.get(id)));
    let part = part.to_f64().filter(|_| source.function("momentum_step").is_some_and(told))?;
    Some(quote!(const PLACE: ::core::option::Option<f64> = ::core::option::Option::Some(#part);))
}

/// The formulas of both gains.
fn gains(source: &Source) -> String {
    let of = &source.system.equations;
    let momenta = source.formulas("p1 − p0", &of.momentum_increment);
    format!("{momenta}\n\n{}", source.formula("E1 − E0", of.energy_increment))
}

/// The Newton step in v, and the gain at its end: to first order where that is cheaper than to evaluate it there.
fn momentum_step(source: &Source) -> Option<TokenStream> {
    let (dimension, size) = (source.dimension(), source.model.dimension());
    let end = end(source.function("momentum_step")?, size + 1);
    let momenta = source.formulas("p1 − p0", &source.system.equations.momentum_increment);
    let solve = quote! {
        solve: impl ::core::ops::FnOnce(
            &::vi_core::MomentumEquation<#dimension, T, Self::Jacobian>,
        ) -> ::vi_core::SVector<T, #dimension>,
    };
    let method = Method {
        name: "momentum_step",
        formula: format!("{momenta}\n\n{end} `v + dv`."),
        solve: Some(solve),
        told: true,
        output: quote!(::vi_core::SVector<T, #dimension>),
    };
    method.tokens(source, |body| {
        let (equations, rest) = body.results.split_at(size + 1);
        let (_, equation) = momentum_fields(source, equations);
        let [gains, residuals, slopes @ ..] = rest else {
            // In loops v is an array.
            return Some(quote! {
                let reached = ::vi_core::SVector::<T, #dimension>::from(*v) + solve(&#equation);
                self.increment(node, h, &reached).momentum
            });
        };
        let rows = gains.iter().zip(slopes).enumerate();
        let rows = rows.map(|(i, (gain, slopes))| carried(gain, slopes, Some((&residuals[0], i)), size));
        let gains = array(&rows.collect::<Vec<_>>(), &zero(), sum);
        Some(quote! {
            let momentum = #equation;
            let change: [T; #dimension] = solve(&momentum).into();
            ::vi_core::SVector::from(#gains)
        })
    })
}

/// The Newton step in (v, h), and both gains at its end, in the same way.
fn extended_step(source: &Source) -> Option<TokenStream> {
    let (dimension, size) = (source.dimension(), source.model.dimension());
    let end = end(source.function("extended_step")?, size + 5);
    let solve = quote! {
        solve: impl ::core::ops::FnOnce(
            &::vi_core::ExtendedSystem<#dimension, T, Self::Jacobian>,
        ) -> (::vi_core::SVector<T, #dimension>, T),
    };
    let method = Method {
        name: "extended_step",
        formula: format!("{}\n\n{end} `(v + dv, h + dh)`.", gains(source)),
        solve: Some(solve),
        told: true,
        output: quote!(::vi_core::Increment<#dimension, T>),
    };
    method.tokens(source, |body| {
        let (equations, rest) = body.results.split_at(size + 5);
        let equations = extended_fields(source, equations)?;
        // Of residuals they take none.
        let [momentum, energy, _, slopes @ ..] = rest else {
            return Some(quote! {
                let (change, change_h) = solve(&#equations);
                self.increment(node, h + change_h, &(::vi_core::SVector::<T, #dimension>::from(*v) + change))
            });
        };
        let gains = momentum.iter().chain(energy).zip(slopes).map(|(gain, slopes)| carried(gain, slopes, None, size));
        let mut momenta: Vec<_> = gains.collect();
        let energy = sum(&momenta.pop()?.iter().map(Part::to_token_stream).collect::<Vec<_>>());
        let momenta = array(&momenta, &zero(), sum);
        Some(quote! {
            let (change, change_h) = solve(&#equations);
            let change: [T; #dimension] = change.into();
            ::vi_core::Increment { momentum: ::vi_core::SVector::from(#momenta), energy: #energy }
        })
    })
}

/// How a step of so many rows of equations comes by the gains after it: by those rows that follow, or evaluated anew.
fn end(step: &Function, equations: usize) -> &'static str {
    if step.results.len() > equations { "to first order at" } else { "at" }
}

/// The gain and what it is carried by, the changes times their slopes and the residual times its own, without what is zero; the
/// slope after those by v is that by h.
fn carried<'a>(
    gain: &'a Entry,
    slopes: &'a [Entry],
    residual: Option<(&'a Entry, usize)>,
    dimension: usize,
) -> Vec<Part<'a>> {
    let changes = slopes.iter().enumerate().map(|(j, slope)| {
        let in_v = j < dimension;
        (slope, if in_v { quote!(change) } else { quote!(change_h) }, in_v.then_some(j))
    });
    let products = changes.chain(residual.map(|(factor, i)| (factor, quote!(momentum.residual), Some(i))));
    let products = products.filter(|(slope, ..)| !slope.zero).map(|(slope, of, place)| Part::product(slope, of, place));
    [Part::from(Some(gain))].into_iter().chain(products).collect()
}

/// `gain + (product + product)`.
fn sum(parts: &[TokenStream]) -> TokenStream {
    match parts {
        [gain, product] => quote!(#gain + #product),
        [gain, products @ ..] if !products.is_empty() => quote!(#gain + (#(#products)+*)),
        parts => quote!(#(#parts)*),
    }
}

fn magnitudes(source: &Source) -> Option<TokenStream> {
    let dimension = source.dimension();
    let formula = "Sums of the absolute values of the terms of `residual` and `energy_residual`.".to_owned();
    Method::new("magnitudes", formula, quote!(::vi_core::Magnitudes<#dimension, T>)).tokens(source, |body| {
        let (residual, energy) = (vector_of(&body.results[0]), &body.results[1][0]);
        Some(quote!(::vi_core::Magnitudes { residual: #residual, energy_residual: #energy }))
    })
}

fn increment(source: &Source) -> Option<TokenStream> {
    let dimension = source.dimension();
    Method::new("increment", gains(source), quote!(::vi_core::Increment<#dimension, T>)).tokens(source, |body| {
        let (momentum, energy) = (vector_of(&body.results[0]), &body.results[1][0]);
        Some(quote!(::vi_core::Increment { momentum: #momentum, energy: #energy }))
    })
}
