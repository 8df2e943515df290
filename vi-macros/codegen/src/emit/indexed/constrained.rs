//! The constraints of a large system: their primitives in loops, and the traits of a system with constraints.

use super::super::constrained;
use super::second::Column;
use super::{Printer, WEIGHTS, name, reads_entries};
use crate::model::Constraint;
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

impl Printer<'_> {
    pub(super) fn constrained(&self) -> TokenStream {
        let (system, dimension) = (&self.model.name, self.dimension());
        let constraints = &self.model.constraints;
        let holonomic = constraints.iter().filter(|constraint| constraint.is_holonomic).count();
        let [count, holonomic] = [constraints.len(), holonomic].map(Literal::usize_unsuffixed);
        let names = constraints.iter().map(Constraint::text);
        let ([items, common], primitives) = (self.points(), self.constraint_primitives(&count));
        let vector = quote!(::vi_core::SVector<T, #dimension>);
        let rows = quote!((Self::Gradients, Self::Multipliers));
        let applied = self.of_state("applied", &vector, &quote!(::vi_core::indexed::applied(self, t, q, v)));
        let rates = quote!(::vi_core::indexed::constraint_rate_derivatives(self, t, q, v));
        let rates = self.of_state("constraint_rate_derivatives", &rows, &rates);
        let convertible = constrained::convertible(system, &dimension);
        quote! {
            #items
            #primitives

            impl<T: ::vi_core::real::Real> ::vi_core::Constrained<#dimension, T> for #system<T> {
                #common
                const CONSTRAINTS: &'static [&'static str] = &[#(#names),*];
                const HOLONOMIC: usize = #holonomic;
                type Multipliers = [T; #count];
                type Gradients = [#vector; #count];
                type ReactionMatrix = [#vector; #dimension];
                #applied

                fn constraints(&self, t: T, q: &#vector) -> Self::Multipliers {
                    ::vi_core::indexed::constraints(self, t, q)
                }

                fn constraint_gradients(&self, t: T, q: &#vector) -> #rows {
                    ::vi_core::indexed::constraint_gradients(self, t, q)
                }

                #rates

                fn reaction_derivatives(
                    &self,
                    t: T,
                    q: &#vector,
                    multipliers: &Self::Multipliers,
                ) -> Self::ReactionMatrix {
                    ::vi_core::indexed::reaction_derivatives(self, t, q, multipliers)
                }
            }

            #convertible
        }
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
