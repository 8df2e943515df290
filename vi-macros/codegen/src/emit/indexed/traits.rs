//! The traits of a system: `Lagrangian`, and the call of the macro of `vi_core::indexed` that implements the others.

use super::super::check::monotone_table_of;
use super::super::constraints;
use super::super::lagrangian::{Properties, implementation};
use super::super::state_function::flow_by;
use super::first::Sweep;
use super::{Printer, reads_entries};
use crate::indexed::Read;
use proc_macro2::{Literal, TokenStream};
use quote::{ToTokens as _, format_ident, quote};

impl Printer<'_> {
    pub(super) fn lagrangian(&self) -> TokenStream {
        let (model, dimension) = (self.model, self.dimension());
        let flow = if self.of.has_mass_of_position {
            quote!(flow(self, t, q, p))
        } else {
            quote!(flow_by_iteration(self, &self.convert::<::vi_core::real::Rounded>(), t, q, p))
        };
        let number = |name: &str, value: &TokenStream| self.of_state(name, &quote!(T), value);
        let vector =
            |name: &str, value: &TokenStream| self.of_state(name, &quote!(::vi_core::SVector<T, #dimension>), value);
        let first = quote!(::vi_core::indexed::Indexed::first_derivatives(self, t, q, v));
        let value = Self::over_sums("lagrangian", &self.of.lagrangian, 0, &|of| {
            let (name, numbers) = (&of.name, self.numbers(of));
            quote!(value += self.#name(t, #numbers)[0];)
        });
        let of_lagrangian = reads_entries(&self.of.lagrangian).then(|| self.entries());
        let value = quote! {
            let real = T::real;
            let mut value = real(0.0);
            #of_lagrangian
            #value
            value
        };
        let of_force = self.force_reads_entries().then(|| self.entries());
        let forces = self.forces(Sweep::DISSIPATION);
        let force = quote! {
            let real = T::real;
            let mut force = ::vi_core::SVector::<T, #dimension>::zeros();
            #of_force
            #forces
            force
        };
        let acceleration = self.of_state(
            "acceleration",
            &quote!(::core::result::Result<::vi_core::SVector<T, #dimension>, ::vi_core::StepError>),
            &quote!(::vi_core::indexed::acceleration(self, t, q, v)),
        );
        let flow = flow_by(&dimension, &quote!(p), &quote!(::vi_core::indexed::#flow));
        let [acceleration, flow] =
            if model.constraints.is_empty() { [acceleration, flow] } else { constraints::motion(&dimension) };
        // A constant mass matrix needs no gradient.
        let momentum = if self.of.separable {
            quote!(::vi_core::linear::Matrix::multiply(&self.mass_diagonal(t, q, v), v))
        } else {
            quote!(#first.dv)
        };
        let functions = [
            number("lagrangian", &value),
            number("energy", &quote!(::vi_core::indexed::energy(self, t, q, v))),
            vector("momentum", &momentum),
            vector("force", &force),
            acceleration,
            flow,
        ];
        let (autonomous, cyclic) = (self.of.autonomous, &self.of.cyclic);
        let properties = Properties { autonomous, cyclic, monotone: monotone_table_of(self.of) };
        implementation(model, properties, &functions)
    }

    /// The function `mass_diagonal`, if the mass matrix is constant and diagonal.
    pub(super) fn diagonal(&self) -> TokenStream {
        if !self.of.separable {
            return TokenStream::new();
        }
        let (name, dimension) = (&self.model.name, self.dimension());
        let terms = Self::over_sums("lagrangian", &self.of.lagrangian, 0, &|of| {
            if !of.body.reads.contains(&Read::Velocity) {
                return TokenStream::new();
            }
            let (name, numbers) = (format_ident!("{}_curvatures", of.name), self.numbers(of));
            let value = &of.body.values[0];
            let first = value.first_curvature + value.states.len();
            let parts = value.pairs.iter().enumerate().map(|(number, [row, _])| {
                let (number, index) = (Literal::usize_unsuffixed(first + number), of.at(value.states[*row]));
                quote!(rows[#index][0] += curvatures[#number];)
            });
            quote! {
                let curvatures = self.#name(t, #numbers);
                #(#parts)*
            }
        });
        let diagonal = quote! {
            let real = T::real;
            let mut rows = [[real(0.0)]; #dimension];
            #terms
            ::vi_core::linear::Banded { rows }
        };
        let diagonal = self.of_state("mass_diagonal", &quote!(::vi_core::linear::Banded<#dimension, 1, T>), &diagonal);
        quote! {
            impl<T: ::vi_core::real::Real> #name<T> {
                /// The diagonal of the mass matrix.
                #[inline]
                #diagonal
            }
        }
    }

    /// A function of (t, q, v), with this value.
    pub(super) fn of_state(&self, function: &str, result: &TokenStream, value: &TokenStream) -> TokenStream {
        self.of_state_and(&TokenStream::new(), function, result, value)
    }

    /// The same with further arguments.
    pub(super) fn of_state_and(
        &self,
        further: &TokenStream,
        function: &str,
        result: &TokenStream,
        value: &TokenStream,
    ) -> TokenStream {
        let (function, dimension) = (format_ident!("{function}"), self.dimension());
        quote! {
            fn #function(
                &self,
                t: T,
                q: &::vi_core::SVector<T, #dimension>,
                v: &::vi_core::SVector<T, #dimension>,
                #further
            ) -> #result {
                #value
            }
        }
    }

    /// The other traits, which follow from the primitives.
    pub(super) fn system(&self) -> TokenStream {
        let (name, dimension) = (&self.model.name, self.dimension());
        let form = |is_diagonal| if is_diagonal { quote!(diagonal) } else { quote!(dense) };
        let constraints = match self.model.constraints.len() {
            0 => quote!(none),
            count => Literal::usize_unsuffixed(count).into_token_stream(),
        };
        let mass = form(self.of.separable);
        let scale = if self.of.scale.is_some() { quote!(own) } else { quote!(none) };
        let steps = self.of.rules.iter().enumerate().map(|(place, rule)| {
            let points = format_ident!("{}", rule.marker);
            let marker = if place == 0 { quote!(Own) } else { quote!(#points) };
            let (jacobian, energy) = (form(self.of.is_explicit(rule)), rule.step_density);
            quote!(; rule(#marker), points(#points), jacobian(#jacobian), energy_steps(#energy))
        });
        quote! {
            ::vi_core::indexed::system! {
                #name, coordinates(#dimension), constraints(#constraints), mass(#mass), time_scale(#scale) #(#steps)*
            }
        }
    }
}
