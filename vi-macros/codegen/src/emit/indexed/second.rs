//! Second derivatives: the sweep of first derivatives with a tangent of every coordinate.

use super::{
    Arrays, BOTH, Defined, Printed, Printer, SEEDS, Target, WEIGHTS, add_row, curvature, name, reads_entries, slope,
};
use crate::indexed::{Sum, Value};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};

impl Printer<'_> {
    /// The entries, and their derivatives with respect to all coordinates, of which each is moved by `seeds`.
    pub(super) fn tangents(&self, seeds: [&Ident; 2], arrays: &Arrays) -> TokenStream {
        let dimension = self.dimension();
        let zeros = self.zeros("", &quote!(real(0.0)));
        let rows = self.zeros_of("tangent_", &quote!([real(0.0); #dimension]), arrays);
        let loops = self.over_recursions(false, &|of, defined| {
            let (name, numbers) = (&of.name, self.numbers(of));
            let each = defined.iter().map(|Defined { value, of: own, array, entry }| {
                let (tangent, place) = (format_ident!("tangent_{array}"), Literal::usize_unsuffixed(value.first_slope));
                let states = of.states(value).filter(|_| arrays.contains(own));
                let parts = states.map(|(place, read, index)| {
                    let slope = slope(value, place);
                    match self.target(read) {
                        Target::Own(which) => {
                            let seed = seeds[which];
                            quote!(#tangent[#entry][#index] += ::vi_core::indexed::weighted(#slope, #seed);)
                        }
                        Target::Entry(from) => {
                            let from = format_ident!("tangent_{from}");
                            let add = add_row(value, place, &slope, &quote!(#tangent[#entry]));
                            quote! {
                                let from = #from[#index];
                                #add
                            }
                        }
                    }
                });
                quote! {
                    #array[#entry] = slopes[#place];
                    #(#parts)*
                }
            });
            quote! {
                let slopes = self.#name(t, #numbers);
                #(#each)*
            }
        });
        quote!(#zeros #rows #loops)
    }

    /// The products of second derivatives of a value with the tangents of what it reads, times `factor`.
    pub(super) fn curved(&self, of: &Printed, value: &Value, factor: &TokenStream) -> TokenStream {
        let mut parts = TokenStream::new();
        let (weight_of_position, seed_of_position) = (name(WEIGHTS[0]), name(SEEDS[0]));
        for (number, [row, column]) in value.pairs.iter().enumerate() {
            let number = Literal::usize_unsuffixed(value.first_curvature + value.states.len() + number);
            let both = [[row, column], [column, row]];
            for [to, from] in &both[..if row == column { 1 } else { 2 }] {
                let (to, from) = (value.states[**to], value.states[**from]);
                let (at_to, at_from) = (of.at(to), of.at(from));
                let (read_to, read_from) = (of.body.reads[to], of.body.reads[from]);
                // All contributions of positions have these weights.
                let weight_of_to = self.is_of_position(read_to).then_some(&weight_of_position);
                let seed_of_from = self.is_of_position(read_from).then_some(&seed_of_position);
                let (to, from) = (self.target(read_to), self.target(read_from));
                let second = quote!(#factor curvatures[#number]);
                parts.extend(match (to, from) {
                    // A mass is finite where a force has an infinite slope, and its weight is zero.
                    (Target::Own(0), Target::Own(0)) => {
                        let weight = name(BOTH);
                        quote!(matrix[#at_to][#at_from] += ::vi_core::indexed::weighted(#second, #weight);)
                    }
                    (Target::Own(to), Target::Own(from)) => {
                        let (weight, seed) = (&WEIGHTS.map(name)[to], &SEEDS.map(name)[from]);
                        quote!(matrix[#at_to][#at_from] += ::vi_core::indexed::weighted(#second, #weight * #seed);)
                    }
                    (Target::Own(to), Target::Entry(from)) => {
                        let (weight, from) = (&WEIGHTS.map(name)[to], format_ident!("tangent_{from}"));
                        let add =
                            quote!(::vi_core::indexed::add(#second * #weight, &mut matrix[#at_to], &#from[#at_from]););
                        where_not_zero(&[Some(weight), seed_of_from], &add)
                    }
                    (Target::Entry(to), Target::Own(from)) => {
                        let (to, seed) = (format_ident!("bar_tangent_{to}"), &SEEDS.map(name)[from]);
                        where_not_zero(&[weight_of_to, Some(seed)], &quote!(#to[#at_to][#at_from] += #second * #seed;))
                    }
                    (Target::Entry(to), Target::Entry(from)) => {
                        let (to, from) = (format_ident!("bar_tangent_{to}"), format_ident!("tangent_{from}"));
                        let add = quote!(::vi_core::indexed::add(#second, &mut #to[#at_to], &#from[#at_from]););
                        where_not_zero(&[weight_of_to, seed_of_from], &add)
                    }
                });
            }
        }
        parts
    }

    pub(super) fn second_derivatives(&self) -> TokenStream {
        let statements = self.curvatures("lagrangian", &self.of.lagrangian, None);
        self.matrix_of_state("second_derivatives", &statements)
    }

    /// A function of a state and of the weights of rows and columns.
    fn matrix_of_state(&self, function: &str, statements: &TokenStream) -> TokenStream {
        let (dimension, [r_q, r_v], [c_q, c_v]) = (self.dimension(), &SEEDS.map(name), &WEIGHTS.map(name));
        let further = quote!([#r_q, #r_v]: [T; 2], [#c_q, #c_v]: [T; 2]);
        let matrix = quote!(::vi_core::nalgebra::SMatrix<T, #dimension, #dimension>);
        self.of_state_and(&further, function, &matrix, statements)
    }

    /// The second derivatives of these sums. With `weights`, each is multiplied by one of these: the first number of a
    /// row is its place.
    pub(super) fn curvatures(&self, of: &str, sums: &[Sum], weights: Option<&Ident>) -> TokenStream {
        let dimension = self.dimension();
        let seeds = SEEDS.map(name);
        let (reads_entries, arrays) = (reads_entries(sums), self.arrays(&[sums]));
        let forward = reads_entries.then(|| {
            let tangents = self.tangents([&seeds[0], &seeds[1]], &arrays);
            let bars = self.zeros_of("bar_", &quote!(real(0.0)), &arrays);
            let bar_tangents = self.zeros_of("bar_tangent_", &quote!([real(0.0); #dimension]), &arrays);
            quote!(#tangents #bars #bar_tangents)
        });
        let first = usize::from(weights.is_some());
        let terms = Self::over_sums(of, sums, first, &|of| {
            let value = &of.body.values[0];
            let weight = weights.map(|weights| {
                let on = (of.place)(0);
                quote!(#weights[#on])
            });
            let factor = weight.as_ref().map(|weight| quote!(#weight *)).unwrap_or_default();
            let bars = of.states(value).filter(|(_, read, _)| read.is_entry()).map(|(place, read, index)| {
                let (bar, slope) = (format_ident!("bar_{}", self.array(read)), curvature(value, place));
                quote!(#bar[#index] += #factor #slope;)
            });
            let bars: TokenStream = bars.collect();
            if value.pairs.is_empty() && bars.is_empty() {
                return TokenStream::new();
            }
            let (name, numbers) = (format_ident!("{}_curvatures", of.name), self.numbers(of));
            let curved = self.curved(of, value, &factor);
            let added = quote! {
                let curvatures = self.#name(t, #numbers);
                #bars
                #curved
            };
            // A weight of zero times an infinite derivative would be no number.
            match weight {
                Some(weight) => quote!(if !#weight.is_zero() { #added }),
                None => added,
            }
        });
        let backward = reads_entries.then(|| self.curvatures_of_recursions(&arrays));
        let ([r_q, _], [c_q, _], both) = (&seeds, &WEIGHTS.map(name), name(BOTH));
        quote! {
            let real = T::real;
            let mut whole = ::vi_core::nalgebra::SMatrix::<T, #dimension, #dimension>::zeros();
            // Its columns.
            let matrix = &mut whole.data.0;
            let #both = #c_q * #r_q;
            #forward
            #terms
            #backward
            whole
        }
    }

    /// The second derivatives of recursions, times what their entries contribute.
    fn curvatures_of_recursions(&self, arrays: &Arrays) -> TokenStream {
        self.over_recursions(true, &|of, defined| {
            let (function, numbers) = (format_ident!("{}_curvatures", of.name), self.numbers(of));
            let needed = defined.iter().rev().filter(|defined| arrays.contains(&defined.of));
            let each = needed.map(|Defined { value, array, entry, .. }| {
                let (bar, bar_tangent) = (format_ident!("bar_{array}"), format_ident!("bar_tangent_{array}"));
                let parts = of.states(value).map(|(place, read, index)| {
                    let slope = curvature(value, place);
                    match self.target(read) {
                        Target::Own(which) => {
                            let weight = &WEIGHTS.map(name)[which];
                            let add = quote!(::vi_core::indexed::add(#slope * #weight, &mut matrix[#index], &from););
                            where_not_zero(&[Some(weight)], &add)
                        }
                        Target::Entry(to) => {
                            let (bar, bar_tangent) = (format_ident!("bar_{to}"), format_ident!("bar_tangent_{to}"));
                            let add = add_row(value, place, &slope, &quote!(#bar_tangent[#index]));
                            quote! {
                                #bar[#index] += bar * #slope;
                                #add
                            }
                        }
                    }
                });
                let curved = self.curved(of, value, &quote!(bar *));
                quote! {
                    let bar = #bar[#entry];
                    let from = #bar_tangent[#entry];
                    #(#parts)*
                    #curved
                }
            });
            let each: TokenStream = each.collect();
            if each.is_empty() {
                return TokenStream::new();
            }
            quote! {
                let curvatures = self.#function(t, #numbers);
                #each
            }
        })
    }

    pub(super) fn add_force_derivatives(&self) -> TokenStream {
        let (dimension, [c_q, c_v]) = (self.dimension(), &WEIGHTS.map(name));
        let statements = self.rows("force", &self.of.force, &|on, index, slope| match index {
            Column::Own(index, weight) => {
                quote!(matrix[(#on, #index)] += ::vi_core::indexed::weighted(weight * #slope, #weight);)
            }
            Column::All(tangent) => {
                quote!(::vi_core::indexed::add_to_row(matrix, #on, weight * #slope, &#tangent);)
            }
        });
        // The force −R_v.
        let lost = (!self.of.dissipation.is_empty()).then(|| {
            quote! {
                let lost = self.dissipation_curvatures(t, q, v, [real(0.0), real(1.0)], [#c_q, #c_v]);
                *matrix -= lost * weight;
            }
        });
        quote! {
            fn add_force_derivatives(
                &self,
                t: T,
                q: &::vi_core::SVector<T, #dimension>,
                v: &::vi_core::SVector<T, #dimension>,
                weight: T,
                [#c_q, #c_v]: [T; 2],
                matrix: &mut ::vi_core::nalgebra::SMatrix<T, #dimension, #dimension>,
            ) {
                let real = T::real;
                #statements
                #lost
            }
        }
    }

    /// The second derivatives of Rayleigh's function.
    pub(super) fn dissipation_curvatures(&self) -> TokenStream {
        if self.of.dissipation.is_empty() {
            return TokenStream::new();
        }
        let statements = self.curvatures("dissipation", &self.of.dissipation, None);
        let name = &self.model.name;
        let function = self.matrix_of_state("dissipation_curvatures", &statements);
        quote!(impl<T: ::vi_core::real::Real> #name<T> { #function })
    }

    /// Adds the derivatives of these sums to the rows of a matrix; `add` prints a part of a row.
    pub(super) fn rows(
        &self,
        of: &str,
        sums: &[Sum],
        add: &dyn Fn(&TokenStream, Column, &TokenStream) -> TokenStream,
    ) -> TokenStream {
        let weights = WEIGHTS.map(name);
        let tangents = reads_entries(sums).then(|| self.tangents([&weights[0], &weights[1]], &self.arrays(&[sums])));
        let terms = Self::over_sums(of, sums, 1, &|of| {
            let (name_of, numbers, on) = (&of.name, self.numbers(of), (of.place)(0));
            let value = &of.body.values[0];
            let parts = of.states(value).map(|(place, read, index)| {
                let column = match self.target(read) {
                    Target::Own(which) => Column::Own(index, &weights[which]),
                    Target::Entry(from) => {
                        let from = format_ident!("tangent_{from}");
                        Column::All(quote!(#from[#index]))
                    }
                };
                let added = add(&on, column, &slope(value, place));
                let weight = self.is_of_position(read).then_some(&weights[0]);
                where_not_zero(&[weight], &added)
            });
            quote! {
                let slopes = self.#name_of(t, #numbers);
                #(#parts)*
            }
        });
        quote!(#tangents #terms)
    }
}

/// Statements for weights that are not zero: a zero times an infinite derivative would be no number.
fn where_not_zero(weights: &[Option<&Ident>], statements: &TokenStream) -> TokenStream {
    let weights: Vec<_> = weights.iter().flatten().collect();
    if weights.is_empty() {
        return statements.clone();
    }
    quote!(if #(!#weights.is_zero())&&* { #statements })
}

/// The columns of a row that a slope changes.
pub(super) enum Column<'a> {
    /// The column of a coordinate or a velocity, with the weight of its derivative.
    Own(TokenStream, &'a Ident),
    /// All, by this row of derivatives of an entry.
    All(TokenStream),
}
