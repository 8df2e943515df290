//! First derivatives by one reverse sweep: recursions forward, terms of L, recursions backward.

use super::{Arrays, Defined, Printer, reads_entries, slope};
use crate::indexed::{Read, Sum};
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

/// A reverse sweep.
#[derive(Clone, Copy)]
pub(super) struct Sweep {
    of: Swept,
    /// Whether absolute values of the terms are summed too.
    is_measured: bool,
}

/// What a sweep differentiates.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Swept {
    /// L, with respect to time, coordinates and velocities.
    Lagrangian,
    /// Rayleigh's function, with respect to velocities: the negative force.
    Dissipation,
    /// The time scale, with respect to time and coordinates.
    Scale,
}

impl Sweep {
    const LAGRANGIAN: Self = Self { of: Swept::Lagrangian, is_measured: false };
    pub(super) const DISSIPATION: Self = Self { of: Swept::Dissipation, is_measured: false };

    pub(super) const SCALE: Self = Self { of: Swept::Scale, is_measured: false };

    fn measured(self) -> Self {
        Self { is_measured: true, ..self }
    }

    /// The tokens of what belongs to absolute values.
    fn of_sizes(self, tokens: TokenStream) -> TokenStream {
        if self.is_measured { tokens } else { TokenStream::new() }
    }

    /// The arrays whose derivatives matter, of those on which sums depend.
    pub(super) fn of_arrays(self, mut arrays: Arrays) -> Arrays {
        arrays.retain(|array| self.needs(array));
        arrays
    }

    /// Whether a derivative with respect to an entry of this array matters.
    fn needs(self, array: &Read) -> bool {
        match self.of {
            Swept::Lagrangian => true,
            Swept::Dissipation => matches!(array, Read::LetRate(_)),
            Swept::Scale => matches!(array, Read::Let(_)),
        }
    }
}

/// The derivative to which a term is added: with respect to time, or to an entry of the state.
pub(super) enum Partial {
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
        let first = self.sweep(Sweep::LAGRANGIAN);
        let measured = self.sweep(Sweep::LAGRANGIAN.measured());
        let first = self.of_state("first_derivatives", &one, &quote!(#first #found));
        let measured = self.of_state("measured_derivatives", &quote!([#one; 2]), &quote!(#measured [#found, #sizes]));
        quote!(#first #measured)
    }

    /// The statements of the sweep of L, and the force.
    fn sweep(&self, sweep: Sweep) -> TokenStream {
        let dimension = self.dimension();
        let zeros = quote!(::vi_core::SVector::<T, #dimension>::zeros());
        let sizes = sweep.of_sizes(quote! {
            let mut value_size = real(0.0);
            let mut dt_size = real(0.0);
            let mut dq_size = #zeros;
            let mut dv_size = #zeros;
            let mut force_size = #zeros;
        });
        let is_entered = reads_entries(&self.of.lagrangian) || self.force_reads_entries();
        let entries = is_entered.then(|| self.entries());
        let (of_lagrangian, forces) = (self.terms(sweep, "lagrangian", &self.of.lagrangian), self.forces(sweep));
        quote! {
            let real = T::real;
            let mut value = real(0.0);
            let mut dt = real(0.0);
            let mut dq = #zeros;
            let mut dv = #zeros;
            let mut force = #zeros;
            #sizes
            #entries
            #of_lagrangian
            #forces
        }
    }

    /// Adds a term to a sum, and its size to the sum of sizes.
    pub(super) fn add(&self, sweep: Sweep, partial: &Partial, term: &TokenStream, size: &TokenStream) -> TokenStream {
        let (sum, sizes) = match (sweep.of, partial) {
            (Swept::Lagrangian, Partial::Time) => (quote!(dt), quote!(dt_size)),
            (Swept::Lagrangian, Partial::State(Read::Coordinate, index)) => {
                (quote!(dq[#index]), quote!(dq_size[#index]))
            }
            (Swept::Lagrangian, Partial::State(Read::Velocity, index)) => (quote!(dv[#index]), quote!(dv_size[#index])),
            (Swept::Dissipation, Partial::State(Read::Velocity, index)) => {
                let sizes = sweep.of_sizes(quote!(force_size[#index] += #size;));
                return quote!(force[#index] -= #term; #sizes);
            }
            (Swept::Scale, Partial::Time) => (quote!(g_dt), quote!()),
            (Swept::Scale, Partial::State(Read::Coordinate, index)) => (quote!(g_dq[#index]), quote!()),
            (_, Partial::State(read, index)) if read.is_entry() && sweep.needs(read) => {
                let array = self.array(*read);
                let (bar, size) = (format_ident!("bar_{array}"), format_ident!("size_{array}"));
                (quote!(#bar[#index]), quote!(#size[#index]))
            }
            _ => return TokenStream::new(),
        };
        let sizes = sweep.of_sizes(quote!(#sizes += #size;));
        quote!(#sum += #term; #sizes)
    }

    /// Zeros for what the entries of arrays contribute, and for its sizes.
    pub(super) fn bars(&self, sweep: Sweep, arrays: &Arrays) -> TokenStream {
        let zeros = |prefix: &str| self.zeros_of(prefix, &quote!(real(0.0)), arrays);
        let (bars, sizes) = (zeros("bar_"), sweep.of_sizes(zeros("size_")));
        quote!(#bars #sizes)
    }

    /// The slopes of the terms of a sum, those through recursions too.
    fn terms(&self, sweep: Sweep, name: &str, sums: &[Sum]) -> TokenStream {
        let terms = Self::over_sums(name, sums, 0, &|of| {
            let (name, numbers, value) = (&of.name, self.numbers(of), &of.body.values[0]);
            let add = |place, slope: TokenStream| self.add(sweep, &place, &slope, &quote!(#slope.abs()));
            let by_time = value.varies.then(|| add(Partial::Time, quote!(slopes[1])));
            let states = of.states(value);
            let by_state = states.map(|(place, read, at)| add(Partial::State(read, at), slope(value, place)));
            let whole = (sweep.of == Swept::Lagrangian).then(|| {
                let size = sweep.of_sizes(quote!(value_size += slopes[0].abs();));
                quote!(value += slopes[0]; #size)
            });
            quote! {
                let slopes = self.#name(t, #numbers);
                #whole
                #by_time
                #(#by_state)*
            }
        });
        if !reads_entries(sums) {
            return terms;
        }
        let arrays = sweep.of_arrays(self.arrays(&[sums]));
        let (bars, backward) = (self.bars(sweep, &arrays), self.backward(sweep, &arrays));
        quote!(#bars #terms #backward)
    }

    /// The slopes of recursions, times what their entries contribute.
    pub(super) fn backward(&self, sweep: Sweep, arrays: &Arrays) -> TokenStream {
        self.over_recursions(true, &|of, defined| {
            let (name, numbers) = (&of.name, self.numbers(of));
            let needed = defined.iter().rev().filter(|defined| arrays.contains(&defined.of));
            let each = needed.map(|Defined { value, array, entry, .. }| {
                let (bar, size) = (format_ident!("bar_{array}"), format_ident!("size_{array}"));
                let add = |place, slope: TokenStream| {
                    self.add(sweep, &place, &quote!(bar * #slope), &quote!(size * #slope.abs()))
                };
                let time = Literal::usize_unsuffixed(value.first_slope + 1);
                let by_time = value.varies.then(|| add(Partial::Time, quote!(slopes[#time])));
                let states = of.states(value);
                let by_state = states.map(|(place, read, at)| add(Partial::State(read, at), slope(value, place)));
                let size = sweep.of_sizes(quote!(let size = #size[#entry];));
                quote! {
                    let bar = #bar[#entry];
                    #size
                    #by_time
                    #(#by_state)*
                }
            });
            let each: TokenStream = each.collect();
            if each.is_empty() {
                return TokenStream::new();
            }
            quote! {
                let slopes = self.#name(t, #numbers);
                #each
            }
        })
    }

    /// Whether the force is computed from entries of recursions.
    pub(super) fn force_reads_entries(&self) -> bool {
        reads_entries(&self.of.force) || reads_entries(&self.of.dissipation)
    }

    /// The terms of the force.
    pub(super) fn forces(&self, sweep: Sweep) -> TokenStream {
        let forces = Self::over_sums("force", &self.of.force, 1, &|of| {
            let (name, numbers, on) = (&of.name, self.numbers(of), (of.place)(0));
            let size = sweep.of_sizes(quote!(force_size[#on] += term.abs();));
            quote! {
                let term = self.#name(t, #numbers)[0];
                force[#on] += term;
                #size
            }
        });
        let lost = (!self.of.dissipation.is_empty()).then(|| {
            let sweep = Sweep { of: Swept::Dissipation, ..sweep };
            let terms = self.terms(sweep, "dissipation", &self.of.dissipation);
            quote!({ #terms })
        });
        quote!(#forces #lost)
    }
}
