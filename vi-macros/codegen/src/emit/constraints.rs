//! Members of `impl Motion` for constraints: values, gradients, rate derivatives and reaction derivatives.

use super::Source;
use super::body::{Body, VelocityFrom, state_parts};
use super::entries::{self, ResultEntry};
use super::formula::zero;
use super::matrix::{all_columns, literals, sparse};
use super::state_function::{flow_by, vector};
use crate::discrete::Constraints;
use crate::findings::{Block, Elimination};
use crate::model::{Constraint, Model};
use crate::program::{FunctionId, Output};
use crate::symbol::Symbol;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{ToTokens, format_ident, quote};
use vi_expr::Expr;

/// The kind of a system, and the members of `Motion` for its constraints.
pub(super) struct Members {
    pub(super) kind: TokenStream,
    /// Items beside the implementation.
    pub(super) items: TokenStream,
    /// Constants and functions of the implementation.
    pub(super) functions: TokenStream,
}

impl Members {
    /// The members of a system without constraints.
    pub(super) fn free() -> Self {
        let kind = quote!(::vi_core::kind::Free);
        Self { kind, items: TokenStream::new(), functions: TokenStream::new() }
    }
}

/// The members of a system with constraints.
pub(super) fn members(source: &Source, of: &Constraints) -> Members {
    let Some(elimination) = &source.findings.elimination else { return Members::free() };
    let formula = source.formulas("(M a − Aᵀ Λ)", &source.system.continuous.mass_times_acceleration);
    let applied = vector(source, FunctionId::Applied, &formula);
    let point_masses = source.findings.point_masses;
    let (names, blocks) = (names(source.model), blocks(&elimination.blocks));
    let [count, width, reaction] =
        [source.model.constraints.len(), elimination.width(), width(&elimination.reaction_dq)]
            .map(Literal::usize_unsuffixed);
    let functions = [
        values(source, of),
        gradients(source, of, elimination),
        rate_derivatives(source, elimination),
        reaction_derivatives(source, elimination),
    ];
    Members {
        kind: quote!(::vi_core::kind::Bound<#count, ::vi_core::kind::Nonzeros<#width, #reaction>>),
        items: columns(source, elimination),
        functions: quote! {
            const POINT_MASSES: bool = #point_masses;
            #names
            #blocks
            #applied
            #(#functions)*
        },
    }
}

/// The types of multipliers, gradients and derivatives of the reaction of `Self`.
pub(super) fn types(dimension: &impl ToTokens) -> [TokenStream; 3] {
    let of = |name: &str| {
        let name = format_ident!("{name}");
        quote!(::vi_core::kind::#name<Self, #dimension, T>)
    };
    ["Multipliers", "Gradients", "ReactionMatrix"].map(of)
}

/// The constants with the names of the constraints, and with the number of holonomic ones.
pub(super) fn names(model: &Model) -> TokenStream {
    let names = model.constraints.iter().map(Constraint::text);
    let holonomic = model.constraints.iter().filter(|constraint| constraint.is_holonomic).count();
    let holonomic = Literal::usize_unsuffixed(holonomic);
    quote! {
        const CONSTRAINTS: &'static [&'static str] = &[#(#names),*];
        const HOLONOMIC: usize = #holonomic;
    }
}

/// The zero patterns of the rows, as constants of the system.
fn columns(source: &Source, elimination: &Elimination) -> TokenStream {
    let (name, count) = (&source.model.name, Literal::usize_unsuffixed(source.model.constraints.len()));
    let dimension = source.dimension();
    let Elimination { gradients, rates_dq, reaction_dq, .. } = elimination;
    let [gradients, rates_dq, reaction_dq] = [gradients, rates_dq, reaction_dq].map(|columns| all_columns(columns));
    quote! {
        impl #name<f64> {
            const GRADIENT_COLUMNS: &'static [&'static [::core::primitive::usize]; #count] = #gradients;
            const RATE_COLUMNS: &'static [&'static [::core::primitive::usize]; #count] = #rates_dq;
            const REACTION_COLUMNS: &'static [&'static [::core::primitive::usize]; #dimension] = #reaction_dq;
        }
    }
}

impl Elimination {
    /// The largest number of entries in a row of A or of ∂(A v + a)/∂q.
    fn width(&self) -> usize {
        width(&self.gradients).max(width(&self.rates_dq))
    }
}

/// The largest number of entries in a row.
fn width(columns: &[Vec<usize>]) -> usize {
    columns.iter().map(Vec::len).max().unwrap_or(0)
}

/// The constant of the order of elimination; nothing for one block.
fn blocks(blocks: &[Block]) -> TokenStream {
    if blocks.len() <= 1 {
        return TokenStream::new();
    }
    let items = blocks.iter().map(|Block { own, border }| {
        let (own, border) = (literals(own), literals(border));
        quote!(::vi_core::linear::Block { own: #own, border: #border })
    });
    quote!(const BLOCKS: &'static [::vi_core::linear::Block] = &[#(#items),*];)
}

/// `acceleration` and `flow` of a system with constraints.
pub(super) fn motion(dimension: &Literal) -> [TokenStream; 2] {
    let acceleration = quote! {
        /// Solves `M a = L_q + f − L_vt − L_vq v + Aᵀ Λ` together with `d/dt (A v + a) = 0`.
        #[inline]
        fn acceleration(
            &self,
            t: T,
            q: &::vi_core::SVector<T, #dimension>,
            v: &::vi_core::SVector<T, #dimension>,
        ) -> ::core::result::Result<::vi_core::SVector<T, #dimension>, ::vi_core::StepError> {
            ::vi_core::support::constrained_acceleration::<Self, #dimension, T>(self, t, q, v)
        }
    };
    let flow = quote!(::vi_core::support::constrained_flow(self, t, q, p));
    [acceleration, flow_by(dimension, &quote!(p), &flow)]
}

/// One formula per constraint that is not identically zero, with the constraint as an index.
fn formulas(source: &Source, exprs: &[Expr], letter: &str) -> String {
    let named = source.model.constraints.iter().zip(exprs);
    let named = named.filter(|(_, expr)| !source.pool.is_zero(**expr));
    let formula =
        |(constraint, expr): (&Constraint, &Expr)| source.formula(&format!("{letter}_{}", constraint.text()), *expr);
    named.map(formula).collect::<Vec<_>>().join("\n\n")
}

fn values(source: &Source, of: &Constraints) -> TokenStream {
    let dimension = source.dimension();
    let [multipliers, ..] = types(&dimension);
    let formula = format!("g of the constraints on positions, 0 for others.\n\n{}", formulas(source, &of.values, "g"));
    let Some((body, documentation)) = source.documented(FunctionId::Constraints, &formula, VelocityFrom::Argument)
    else {
        return TokenStream::new();
    };
    let (inputs, statements) = (state_parts(&body, source.model), &body.statements);
    let result = numbers(body.results.vector(Output::Value));
    quote! {
        #documentation
        #[inline]
        fn constraints(&self, t: T, q: &::vi_core::SVector<T, #dimension>) -> #multipliers {
            #inputs #statements #result
        }
    }
}

fn gradients(source: &Source, of: &Constraints, elimination: &Elimination) -> TokenStream {
    let dimension = source.dimension();
    let [multipliers, gradients_type, _] = types(&dimension);
    let formula = format!("A and a of the constraints.\n\n{}", formulas(source, &of.rates, "a"));
    let id = FunctionId::ConstraintGradients;
    let Some((body, documentation)) = source.documented(id, &formula, VelocityFrom::Argument) else {
        return TokenStream::new();
    };
    let (inputs, statements) = (state_parts(&body, source.model), &body.statements);
    let (name, rows) = (&source.model.name, body.results.matrix(Output::Gradients));
    let columns = quote!(#name::<f64>::GRADIENT_COLUMNS);
    let gradients = sparse(rows, &elimination.gradients, elimination.width(), &columns);
    let rates = numbers(body.results.vector(Output::Rates));
    quote! {
        #documentation
        #[inline]
        fn constraint_gradients(
            &self,
            t: T,
            q: &::vi_core::SVector<T, #dimension>,
        ) -> (#gradients_type, #multipliers) {
            #inputs #statements
            (#gradients, #rates)
        }
    }
}

fn rate_derivatives(source: &Source, elimination: &Elimination) -> TokenStream {
    let dimension = source.dimension();
    let [multipliers, gradients_type, _] = types(&dimension);
    let id = FunctionId::ConstraintRateDerivatives;
    let formula = "∂(A v + a)/∂q and ∂(A v + a)/∂t.";
    let Some((body, documentation)) = source.documented(id, formula, VelocityFrom::Argument) else {
        return TokenStream::new();
    };
    let (inputs, statements) = (state_parts(&body, source.model), &body.statements);
    let (name, rows) = (&source.model.name, body.results.matrix(Output::RatesDq));
    let columns = quote!(#name::<f64>::RATE_COLUMNS);
    let rates_dq = sparse(rows, &elimination.rates_dq, elimination.width(), &columns);
    let rates_dt = numbers(body.results.vector(Output::RatesDt));
    quote! {
        #documentation
        #[inline]
        fn constraint_rate_derivatives(
            &self,
            t: T,
            q: &::vi_core::SVector<T, #dimension>,
            v: &::vi_core::SVector<T, #dimension>,
        ) -> (#gradients_type, #multipliers) {
            #inputs #statements
            (#rates_dq, #rates_dt)
        }
    }
}

fn reaction_derivatives(source: &Source, elimination: &Elimination) -> TokenStream {
    let dimension = source.dimension();
    let [multipliers_type, _, reaction_type] = types(&dimension);
    let id = FunctionId::ReactionDerivatives;
    let formula = "∂(Aᵀλ)/∂q for the multipliers λ.";
    let Some((body, documentation)) = source.documented(id, formula, VelocityFrom::Argument) else {
        return TokenStream::new();
    };
    let (inputs, statements) = (state_parts(&body, source.model), &body.statements);
    let multipliers = multiplier_parts(source, &body);
    let (name, columns) = (&source.model.name, &elimination.reaction_dq);
    let named = quote!(#name::<f64>::REACTION_COLUMNS);
    let matrix = sparse(body.results.matrix(Output::ReactionDq), columns, width(columns), &named);
    quote! {
        #documentation
        #[inline]
        fn reaction_derivatives(
            &self,
            t: T,
            q: &::vi_core::SVector<T, #dimension>,
            multipliers: &#multipliers_type,
        ) -> #reaction_type {
            #multipliers #inputs #statements
            #matrix
        }
    }
}

/// Binds the multipliers that a body reads, before a coordinate may take the name of the argument.
fn multiplier_parts(source: &Source, body: &Body) -> TokenStream {
    if let Some(name) = body.vectors.get(&Symbol::Multiplier(0)) {
        return quote!(let #name = multipliers;);
    }
    let names: Vec<Option<&Ident>> =
        (0..source.model.constraints.len()).map(|index| body.inputs.get(&Symbol::Multiplier(index))).collect();
    if names.iter().all(Option::is_none) {
        return TokenStream::new();
    }
    let names = names.into_iter().map(|name| name.map_or_else(|| quote!(_), |name| quote!(#name)));
    quote!(let [#(#names),*] = *multipliers;)
}

/// The array of these numbers.
fn numbers(results: &[ResultEntry]) -> TokenStream {
    if results.iter().all(|entry| entry.zero) {
        let (zero, count) = (zero(), Literal::usize_unsuffixed(results.len()));
        return quote!([#zero; #count]);
    }
    entries::of(results.iter().map(|entry| Some(entry).into()))
}
