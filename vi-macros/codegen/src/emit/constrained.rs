//! `impl Constrained` and `ConvertibleConstrained`: the equations of motion at one point, and the constraints.
//!
//! A system with constraints implements these in place of `Collocation`, `FixedStepping` and the traits of rules, so
//! that no method that ignores constraints takes it.

use super::Source;
use super::body::{Body, VelocityFrom, state_parts};
use super::collocation::{point, point_derivatives};
use super::entries::{self, ResultEntry};
use super::formula::zero;
use super::lagrangian::{number, vector};
use super::matrix::{all_columns, literals, sparse, sparse_type};
use crate::discrete::Constraints;
use crate::findings::{Block, Elimination};
use crate::model::Constraint;
use crate::program::{FunctionId, Output};
use crate::symbol::Symbol;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;
use vi_expr::Expr;

/// The implementations for a system with constraints.
pub(super) fn item(source: &Source, of: &Constraints) -> TokenStream {
    let (name, dimension) = (&source.model.name, source.dimension());
    let (constant_mass, point_masses) = (source.findings.constant_mass, source.findings.point_masses);
    let (form, point) = point(source);
    let (derivatives_form, point_derivatives) = point_derivatives(source);
    let continuous = &source.system.continuous;
    let power = number(source, FunctionId::Power, &source.formula("dE/dt", continuous.power));
    let formula = source.formulas("(M a − Aᵀ Λ)", &continuous.mass_times_acceleration);
    let applied = vector(source, FunctionId::Applied, &formula);
    let names = source.model.constraints.iter().map(Constraint::text);
    let holonomic = source.model.constraints.iter().filter(|constraint| constraint.is_holonomic).count();
    let (count, size) = (source.model.constraints.len(), source.model.dimension());
    let Some(elimination) = &source.findings.elimination else { return TokenStream::new() };
    let gradients_form = sparse_type(count, elimination.width());
    let reaction_form = sparse_type(size, width(&elimination.reaction_dq));
    let blocks = blocks(&elimination.blocks);
    let [count, holonomic] = [source.model.constraints.len(), holonomic].map(Literal::usize_unsuffixed);
    let functions = [
        values(source, of),
        gradients(source, of, elimination),
        rate_derivatives(source, elimination),
        reaction_derivatives(source, elimination),
    ];
    let (columns, convertible) = (columns(source, elimination), convertible(name, &dimension));
    quote! {
        #columns

        impl<T: ::vi_core::real::Real> ::vi_core::Constrained<#dimension, T> for #name<T> {
            type Mass = #form;
            type PointMatrix = #derivatives_form;
            const CONSTANT_MASS: bool = #constant_mass;
            const POINT_MASSES: bool = #point_masses;
            const CONSTRAINTS: &'static [&'static str] = &[#(#names),*];
            const HOLONOMIC: usize = #holonomic;
            type Multipliers = [T; #count];
            type Gradients = #gradients_form;
            type ReactionMatrix = #reaction_form;
            #blocks
            #point
            #point_derivatives
            #power
            #applied
            #(#functions)*
        }

        #convertible
    }
}

/// The conversion to other numbers.
pub(super) fn convertible(name: &Ident, dimension: &Literal) -> TokenStream {
    quote! {
        impl ::vi_core::ConvertibleConstrained<#dimension> for #name<f64> {
            type In<T: ::vi_core::real::Real> = #name<T>;

            #[inline(always)]
            fn convert<T: ::vi_core::real::Real>(&self) -> #name<T> {
                self.convert()
            }
        }
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
    let flow = quote! {
        #[inline]
        fn flow(
            &self,
            t: T,
            q: &::vi_core::SVector<T, #dimension>,
            p: &::vi_core::SVector<T, #dimension>,
        ) -> ::core::result::Result<::vi_core::lagrangian::Flow<#dimension, T>, ::vi_core::StepError> {
            ::vi_core::support::constrained_flow(self, t, q, p)
        }
    };
    [acceleration, flow]
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
        fn constraints(&self, t: T, q: &::vi_core::SVector<T, #dimension>) -> Self::Multipliers {
            #inputs #statements #result
        }
    }
}

fn gradients(source: &Source, of: &Constraints, elimination: &Elimination) -> TokenStream {
    let dimension = source.dimension();
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
        ) -> (Self::Gradients, Self::Multipliers) {
            #inputs #statements
            (#gradients, #rates)
        }
    }
}

fn rate_derivatives(source: &Source, elimination: &Elimination) -> TokenStream {
    let dimension = source.dimension();
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
        ) -> (Self::Gradients, Self::Multipliers) {
            #inputs #statements
            (#rates_dq, #rates_dt)
        }
    }
}

fn reaction_derivatives(source: &Source, elimination: &Elimination) -> TokenStream {
    let dimension = source.dimension();
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
            multipliers: &Self::Multipliers,
        ) -> Self::ReactionMatrix {
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

/// The traits of a system with errors and constraints.
pub(super) fn stub(name: &Ident, n: &TokenStream, generic: Option<&TokenStream>) -> TokenStream {
    let none = quote!({ loop {} });
    let at = quote!(&self, _: T, _: &::vi_core::SVector<T, #n>, _: &::vi_core::SVector<T, #n>);
    let here = quote!(&self, _: T, _: &::vi_core::SVector<T, #n>);
    let both = quote!((Self::Gradients, Self::Multipliers));
    quote! {
        impl<#generic T: ::vi_core::real::Real> ::vi_core::Constrained<#n, T> for #name<T> {
            type Mass = ::vi_core::nalgebra::SMatrix<T, #n, #n>;
            type PointMatrix = ::vi_core::nalgebra::SMatrix<T, #n, #n>;
            const CONSTANT_MASS: bool = false;
            const CONSTRAINTS: &'static [&'static str] = &[""];
            const HOLONOMIC: ::core::primitive::usize = 1;
            type Multipliers = [T; 1];
            type Gradients = [::vi_core::SVector<T, #n>; 1];
            type ReactionMatrix = [::vi_core::SVector<T, #n>; #n];
            fn point(#at) -> ::vi_core::collocation::Point<#n, T, Self::Mass> #none
            fn point_derivatives(#at) -> ::vi_core::collocation::PointDerivatives<Self::PointMatrix> #none
            fn power(#at) -> T #none
            fn applied(#at) -> ::vi_core::SVector<T, #n> #none
            fn constraints(#here) -> Self::Multipliers #none
            fn constraint_gradients(#here) -> #both #none
            fn constraint_rate_derivatives(#at) -> #both #none
            fn reaction_derivatives(#here, _: &Self::Multipliers) -> Self::ReactionMatrix #none
        }
        impl<#generic> ::vi_core::ConvertibleConstrained<#n> for #name<f64> {
            type In<T: ::vi_core::real::Real> = #name<T>;
            fn convert<T: ::vi_core::real::Real>(&self) -> #name<T> #none
        }
    }
}
