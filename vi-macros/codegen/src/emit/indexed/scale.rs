//! The time scale of a large system: its parts, the whole, and one reverse sweep.

use super::first::{Partial, Sweep};
use super::{Printed, Printer, reads_entries, slope};
use crate::indexed::{PART, Read, SCALE, Scale};
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

impl Printer<'_> {
    /// The function `time_scale`; nothing without one.
    pub(super) fn time_scale(&self) -> TokenStream {
        let Some(scale) = &self.of.scale else { return TokenStream::new() };
        let Scale { parts, count, whole } = scale;
        let (dimension, count) = (self.dimension(), Literal::usize_unsuffixed(*count));
        let whole = core::slice::from_ref(whole);
        let parts = &parts[..];
        let has_entries = reads_entries(parts) || reads_entries(whole);
        let entries = has_entries.then(|| self.entries());
        let values = self.summed(PART, parts, &format_ident!("parts"));
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
        let value = quote! {
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
            (g, g_dq, g_dt)
        };
        self.of_state("time_scale", &quote!((T, ::vi_core::SVector<T, #dimension>, T)), &value)
    }

    /// Adds the slopes of a term, times a weight.
    fn slopes(&self, of: &Printed, weight: Option<&TokenStream>) -> TokenStream {
        let value = &of.body.values[0];
        let weighted = |slope: TokenStream| match weight {
            Some(weight) => quote!(#weight * #slope),
            None => slope,
        };
        let by_time =
            value.varies.then(|| self.add(Sweep::SCALE, &Partial::Time, &weighted(quote!(slopes[1])), &quote!()));
        let by_state = of.states(value).map(|(place, read, at)| {
            let slope = weighted(slope(value, place));
            if read == Read::Part {
                return quote!(weights[#at] = #slope;);
            }
            self.add(Sweep::SCALE, &Partial::State(read, at), &slope, &quote!())
        });
        quote!(#by_time #(#by_state)*)
    }
}
