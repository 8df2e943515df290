//! The time scale of a large system: its parts, the whole, and one reverse sweep.

use super::first::{Place, Sweep};
use super::{Printed, Printer, reads_entries, slope};
use crate::indexed::{PART, Read, SCALE, Scale};
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

impl Printer<'_> {
    /// What `Motion` has in a system with a time scale, and the trait that says so.
    pub(super) fn time_scale(&self) -> [TokenStream; 2] {
        let Some(scale) = &self.of.scale else { return [TokenStream::new(), TokenStream::new()] };
        let (name, dimension) = (&self.model.name, self.dimension());
        let result = quote!(::vi_core::motion::ScaledPoint<#dimension, T, Self::Mass>);
        let point = self.of_state("scaled_point", &result, &self.scaled_point(scale));
        [
            quote! {
                const SCALES_TIME: bool = true;
                #point
            },
            quote!(impl<T: ::vi_core::real::Real> ::vi_core::motion::TimeScale<#dimension, T> for #name<T> {}),
        ]
    }

    fn scaled_point(&self, scale: &Scale) -> TokenStream {
        let Scale { parts, count, whole } = scale;
        let (dimension, count) = (self.dimension(), Literal::usize_unsuffixed(*count));
        let whole = core::slice::from_ref(whole);
        let parts = &parts[..];
        let has_entries = reads_entries(parts) || reads_entries(whole);
        let entries = has_entries.then(|| self.entries());
        let values = self.summed(PART, parts, &format_ident!("parts"));
        let [_, _, mass] = self.mass();
        let arrays = Sweep::SCALE.of_arrays(self.arrays(&[parts, whole]));
        let bars = has_entries.then(|| self.bars(Sweep::SCALE, &arrays));
        let whole = Self::over_sums(SCALE, whole, 0, &|of| {
            let (name, numbers, slopes) = (&of.name, self.numbers(of), self.slopes(of, None));
            quote! {
                let slopes = self.#name(t, #numbers);
                g = slopes[0];
                #slopes
            }
        });
        let terms = Self::over_sums(PART, parts, 1, &|of| {
            let (name, numbers, on) = (&of.name, self.numbers(of), (of.place)(0));
            let slopes = self.slopes(of, Some(&quote!(weight)));
            quote! {
                let (weight, slopes) = (weights[#on], self.#name(t, #numbers));
                #slopes
            }
        });
        let backward = has_entries.then(|| self.backward(Sweep::SCALE, &arrays));
        quote! {
            let real = T::real;
            #entries
            let mut parts = [real(0.0); #count];
            #values
            let mut weights = [real(0.0); #count];
            let mut g = real(0.0);
            let mut g_dt = real(0.0);
            let mut g_dq = ::vi_core::SVector::<T, #dimension>::zeros();
            #bars
            #whole
            #terms
            #backward
            ::vi_core::indexed::scaled_point(self, (t, q, v), #mass, (g, g_dq, g_dt))
        }
    }

    /// Adds the slopes of a term, times a weight.
    fn slopes(&self, of: &Printed, weight: Option<&TokenStream>) -> TokenStream {
        let value = &of.body.values[0];
        let weighted = |slope: TokenStream| match weight {
            Some(weight) => quote!(#weight * #slope),
            None => slope,
        };
        let by_time =
            value.varies.then(|| self.add(Sweep::SCALE, &Place::Time, &weighted(quote!(slopes[1])), &quote!()));
        let by_state = of.states(value).map(|(place, read, at)| {
            let slope = weighted(slope(value, place));
            if read == Read::Part {
                return quote!(weights[#at] = #slope;);
            }
            self.add(Sweep::SCALE, &Place::State(read, at), &slope, &quote!())
        });
        quote!(#by_time #(#by_state)*)
    }
}
