//! First derivatives by one reverse sweep: recursions forward, terms of L, recursions backward.

use super::{Defined, Printer, reads_entries, slope};
use crate::indexed::Read;
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

/// What the sweep sums.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Sums {
    /// Derivatives.
    Derivatives,
    /// Derivatives, and the absolute values of their terms.
    Measured,
}

impl Sums {
    /// The tokens of what belongs to absolute values.
    fn measured(self, tokens: TokenStream) -> TokenStream {
        if self == Self::Measured { tokens } else { TokenStream::new() }
    }
}

/// Where a term goes.
enum Place {
    Time,
    State(Read, TokenStream),
}

impl Printer<'_> {
    /// `first_derivatives` and `measured_derivatives`.
    pub(super) fn first_derivatives(&self) -> TokenStream {
        let dimension = self.dimension();
        let one = quote!(::vi_core::indexed::FirstDerivatives<#dimension, T>);
        let found = quote!(::vi_core::indexed::FirstDerivatives { value, dt, dq, dv, force });
        let sizes = quote! {
            ::vi_core::indexed::FirstDerivatives {
                value: value_size,
                dt: dt_size,
                dq: dq_size,
                dv: dv_size,
                force: force_size,
            }
        };
        let first = self.sweep(Sums::Derivatives);
        let measured = self.sweep(Sums::Measured);
        let first = self.of_state("first_derivatives", &one, &quote!(#first #found));
        let measured = self.of_state("measured_derivatives", &quote!([#one; 2]), &quote!(#measured [#found, #sizes]));
        quote!(#first #measured)
    }

    /// The statements of the sweep.
    fn sweep(&self, sums: Sums) -> TokenStream {
        let dimension = self.dimension();
        let zeros = quote!(::vi_core::SVector::<T, #dimension>::zeros());
        let sizes = sums.measured(quote! {
            let mut value_size = real(0.0);
            let mut dt_size = real(0.0);
            let mut dq_size = #zeros;
            let mut dv_size = #zeros;
            let mut force_size = #zeros;
        });
        let of_lagrangian = reads_entries(&self.of.lagrangian);
        let bars = of_lagrangian.then(|| {
            let (bars, sizes) = (self.zeros("bar_", &quote!(real(0.0))), self.zeros("size_", &quote!(real(0.0))));
            let sizes = sums.measured(sizes);
            quote!(#bars #sizes)
        });
        let backward = of_lagrangian.then(|| self.backward(sums));
        let entries = (of_lagrangian || reads_entries(&self.of.force)).then(|| self.entries());
        let (terms, forces) = (self.terms(sums), self.forces(sums));
        quote! {
            let real = T::real;
            let mut value = real(0.0);
            let mut dt = real(0.0);
            let mut dq = #zeros;
            let mut dv = #zeros;
            let mut force = #zeros;
            #sizes
            #entries
            #bars
            #terms
            #backward
            #forces
        }
    }

    /// Adds a term to a sum, and its size to the sum of sizes.
    fn add(&self, sums: Sums, place: &Place, term: &TokenStream, size: &TokenStream) -> TokenStream {
        let (sum, sizes) = match place {
            Place::Time => (quote!(dt), quote!(dt_size)),
            Place::State(Read::Coordinate, index) => (quote!(dq[#index]), quote!(dq_size[#index])),
            Place::State(Read::Velocity, index) => (quote!(dv[#index]), quote!(dv_size[#index])),
            Place::State(read, index) => {
                let array = self.array(*read);
                let (bar, size) = (format_ident!("bar_{array}"), format_ident!("size_{array}"));
                (quote!(#bar[#index]), quote!(#size[#index]))
            }
        };
        let sizes = sums.measured(quote!(#sizes += #size;));
        quote!(#sum += #term; #sizes)
    }

    /// The slopes of the terms of L.
    fn terms(&self, sums: Sums) -> TokenStream {
        Self::over_sums("lagrangian", &self.of.lagrangian, 0, &|of| {
            let (name, numbers, value) = (&of.name, self.numbers(of), &of.body.values[0]);
            let add = |place, slope: TokenStream| self.add(sums, &place, &slope, &quote!(#slope.abs()));
            let by_time = value.varies.then(|| add(Place::Time, quote!(slopes[1])));
            let states = of.states(value);
            let by_state = states.map(|(place, read, at)| add(Place::State(read, at), slope(value, place)));
            let size = sums.measured(quote!(value_size += slopes[0].abs();));
            quote! {
                let slopes = self.#name(t, #numbers);
                value += slopes[0];
                #size
                #by_time
                #(#by_state)*
            }
        })
    }

    /// The slopes of recursions, times what their entries contribute.
    fn backward(&self, sums: Sums) -> TokenStream {
        self.over_recursions(true, &|of, defined| {
            let (name, numbers) = (&of.name, self.numbers(of));
            let each = defined.iter().rev().map(|Defined { value, array, entry }| {
                let (bar, size) = (format_ident!("bar_{array}"), format_ident!("size_{array}"));
                let add = |place, slope: TokenStream| {
                    self.add(sums, &place, &quote!(bar * #slope), &quote!(size * #slope.abs()))
                };
                let time = Literal::usize_unsuffixed(value.first_slope + 1);
                let by_time = value.varies.then(|| add(Place::Time, quote!(slopes[#time])));
                let states = of.states(value);
                let by_state = states.map(|(place, read, at)| add(Place::State(read, at), slope(value, place)));
                let size = sums.measured(quote!(let size = #size[#entry];));
                quote! {
                    let bar = #bar[#entry];
                    #size
                    #by_time
                    #(#by_state)*
                }
            });
            quote! {
                let slopes = self.#name(t, #numbers);
                #(#each)*
            }
        })
    }

    fn forces(&self, sums: Sums) -> TokenStream {
        Self::over_sums("force", &self.of.force, 1, &|of| {
            let (name, numbers, on) = (&of.name, self.numbers(of), (of.place)(0));
            let size = sums.measured(quote!(force_size[#on] += term.abs();));
            quote! {
                let term = self.#name(t, #numbers)[0];
                force[#on] += term;
                #size
            }
        })
    }
}
