//! The constraints of a large system: their primitives in loops, and the traits of a system with constraints.

use super::super::constraints;
use super::super::constraints::Members;
use super::second::Column;
use super::{Printer, WEIGHTS, name, reads_entries};
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

impl Printer<'_> {
    /// What the constraints add to `Motion`.
    pub(super) fn constraints(&self) -> Members {
        let dimension = self.dimension();
        let count = Literal::usize_unsuffixed(self.model.constraints.len());
        let names = constraints::names(self.model);
        let vector = quote!(::vi_core::SVector<T, #dimension>);
        let [multipliers, gradients, reaction] = constraints::types(&dimension);
        let rows = quote!((#gradients, #multipliers));
        let applied = self.of_state("applied", &vector, &quote!(::vi_core::indexed::applied(self, t, q, v)));
        let rates = quote!(::vi_core::indexed::constraint_rate_derivatives(self, t, q, v));
        let rates = self.of_state("constraint_rate_derivatives", &rows, &rates);
        let functions = quote! {
            #names
            #applied

            fn constraints(&self, t: T, q: &#vector) -> #multipliers {
                ::vi_core::indexed::constraints(self, t, q)
            }

            fn constraint_gradients(&self, t: T, q: &#vector) -> #rows {
                ::vi_core::indexed::constraint_gradients(self, t, q)
            }

            #rates

            fn reaction_derivatives(&self, t: T, q: &#vector, multipliers: &#multipliers) -> #reaction {
                ::vi_core::indexed::reaction_derivatives(self, t, q, multipliers)
            }
        };
        Members { kind: quote!(::vi_core::kind::Bound<#count>), items: self.constraint_primitives(&count), functions }
    }

    /// The implementation of `IndexedConstraints`.
    fn constraint_primitives(&self, count: &Literal) -> TokenStream {
        let (system, dimension, sums) = (&self.model.name, self.dimension(), &self.of.constraints);
        let [c_q, c_v] = &WEIGHTS.map(name);
        let entries = reads_entries(sums).then(|| self.entries());
        let values = self.summed("constraint", sums, &format_ident!("values"));
        let rows = self.rows("constraint", sums, &|on, column, slope| match column {
            Column::Own(index, weight) => quote!(rows[#on][#index] += ::vi_core::indexed::weighted(#slope, #weight);),
            Column::All(tangent) => quote!(::vi_core::indexed::add(#slope, &mut rows[#on], &#tangent);),
        });
        let second = self.curvatures("constraint", sums, Some(&format_ident!("weights")));
        let [r_q, r_v] = &super::SEEDS.map(name);
        let values = quote! {
            let real = T::real;
            let mut values = [real(0.0); #count];
            #entries
            #values
            values
        };
        let values = self.of_state("constraint_values", &quote!([T; #count]), &values);
        let rows = quote! {
            let real = T::real;
            let mut rows = [[real(0.0); #dimension]; #count];
            #rows
            rows.map(::vi_core::SVector::from)
        };
        let (columns, vectors) = (quote!([#c_q, #c_v]: [T; 2]), quote!([::vi_core::SVector<T, #dimension>; #count]));
        let rows = self.of_state_and(&columns, "constraint_derivatives", &vectors, &rows);
        let further = quote!(weights: &[T; #count], [#r_q, #r_v]: [T; 2], #columns);
        let matrix = quote!(::vi_core::nalgebra::SMatrix<T, #dimension, #dimension>);
        let second = self.of_state_and(&further, "constraint_second_derivatives", &matrix, &second);
        quote! {
            impl<T: ::vi_core::real::Real> ::vi_core::indexed::IndexedConstraints<#dimension, #count, T> for #system<T> {
                type Dual = #system<::vi_core::real::Dual<T>>;

                fn dual(&self) -> Self::Dual {
                    ::vi_core::indexed::Indexed::dual(self)
                }

                #values

                #rows
                #second
            }
        }
    }
}
