//! The constraints of a large system: their primitives in loops.

use super::super::constraints;
use super::second::Column;
use super::{Printer, WEIGHTS, name, reads_entries};
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

impl Printer<'_> {
    /// The implementation of `IndexedConstraints`; nothing without constraints.
    pub(super) fn constraints(&self) -> TokenStream {
        if self.model.constraints.is_empty() {
            return TokenStream::new();
        }
        let (system, dimension, sums) = (&self.model.name, self.dimension(), &self.of.constraints);
        let count = Literal::usize_unsuffixed(self.model.constraints.len());
        let names = constraints::names(self.model);
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
                #names

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
