//! The traits of a system, each function by one of `vi_core::indexed`.

use super::super::check::monotone_table_of;
use super::super::constrained;
use super::super::lagrangian::{Properties, implementation};
use super::Printer;
use crate::indexed::Read;
use proc_macro2::{Literal, TokenStream};
use quote::{format_ident, quote};

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
        let reads_entries = self.of.lagrangian.iter().any(|sum| sum.body.reads_entries());
        let of_lagrangian = reads_entries.then(|| self.entries());
        let value = quote! {
            let real = T::real;
            let mut value = real(0.0);
            #of_lagrangian
            #value
            value
        };
        let forces = self.summed("force", &self.of.force, &format_ident!("force"));
        let force = quote! {
            let real = T::real;
            let mut force = ::vi_core::SVector::<T, #dimension>::zeros();
            #forces
            force
        };
        let acceleration = self.of_state(
            "acceleration",
            &quote!(::core::result::Result<::vi_core::SVector<T, #dimension>, ::vi_core::StepError>),
            &quote!(::vi_core::indexed::acceleration(self, t, q, v)),
        );
        let flow = quote! {
            fn flow(
                &self,
                t: T,
                q: &::vi_core::SVector<T, #dimension>,
                p: &::vi_core::SVector<T, #dimension>,
            ) -> ::core::result::Result<::vi_core::lagrangian::Flow<#dimension, T>, ::vi_core::StepError> {
                ::vi_core::indexed::#flow
            }
        };
        let [acceleration, flow] =
            if model.constraints.is_empty() { [acceleration, flow] } else { constrained::motion(&dimension) };
        let functions = [
            number("lagrangian", &value),
            number("energy", &quote!(::vi_core::indexed::energy(self, t, q, v))),
            vector("momentum", &quote!(#first.dv)),
            vector("force", &force),
            acceleration,
            flow,
        ];
        let (autonomous, cyclic) = (self.of.autonomous, &self.of.cyclic);
        let properties = Properties { autonomous, cyclic, monotone: monotone_table_of(self.of) };
        implementation(model, properties, &functions)
    }

    /// The diagonal of a constant mass matrix.
    pub(super) fn diagonal(&self) -> TokenStream {
        let dimension = self.dimension();
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
        quote! {
            /// The diagonal of the mass matrix.
            #[inline]
            fn masses(
                &self,
                t: T,
                q: &::vi_core::SVector<T, #dimension>,
                v: &::vi_core::SVector<T, #dimension>,
            ) -> ::vi_core::linear::Banded<#dimension, 1, T> {
                let real = T::real;
                let mut rows = [[real(0.0)]; #dimension];
                #terms
                ::vi_core::linear::Banded { rows }
            }
        }
    }

    /// The items of a diagonal mass matrix, its type, and the mass matrix at a point.
    fn mass(&self) -> [TokenStream; 3] {
        let (name, dimension) = (&self.model.name, self.dimension());
        if !self.of.separable {
            return [
                TokenStream::new(),
                quote!(::vi_core::nalgebra::SMatrix<T, #dimension, #dimension>),
                quote!(::vi_core::indexed::mass(self, t, q, v)),
            ];
        }
        let diagonal = self.diagonal();
        [
            quote!(impl<T: ::vi_core::real::Real> #name<T> { #diagonal }),
            quote!(::vi_core::linear::Banded<#dimension, 1, T>),
            quote!(self.masses(t, q, v)),
        ]
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

    /// The mass matrix, and what the traits of systems with and without constraints have in common.
    pub(super) fn points(&self) -> [TokenStream; 2] {
        let (dimension, is_constant) = (self.dimension(), self.of.separable);
        let [items, form, mass] = self.mass();
        let point = self.of_state(
            "point",
            &quote!(::vi_core::collocation::Point<#dimension, T, Self::Mass>),
            &quote!(::vi_core::indexed::point(self, t, q, v, #mass)),
        );
        let derivatives = self.of_state(
            "point_derivatives",
            &quote!(::vi_core::collocation::PointDerivatives<Self::PointMatrix>),
            &quote!(::vi_core::indexed::point_derivatives(self, t, q, v)),
        );
        let power = self.of_state("power", &quote!(T), &quote!(::vi_core::indexed::power(self, t, q, v)));
        let common = quote! {
            type Mass = #form;
            type PointMatrix = ::vi_core::nalgebra::SMatrix<T, #dimension, #dimension>;
            const CONSTANT_MASS: bool = #is_constant;
            #point
            #derivatives
            #power
        };
        [items, common]
    }

    pub(super) fn collocation(&self) -> TokenStream {
        let (name, dimension, separable) = (&self.model.name, self.dimension(), self.of.separable);
        let [items, common] = self.points();
        let sides = self.of_state(
            "sides",
            &quote!(::vi_core::collocation::Sides<#dimension, T>),
            &quote!(::vi_core::indexed::sides(self, t, q, v)),
        );
        let splits = separable.then(
            || quote!(impl<T: ::vi_core::real::Real> ::vi_core::collocation::Separable<#dimension, T> for #name<T> {}),
        );
        quote! {
            #items
            #splits
            impl<T: ::vi_core::real::Real> ::vi_core::collocation::Collocation<#dimension, T> for #name<T> {
                #common
                const SEPARABLE: bool = #separable;
                #sides
            }
        }
    }

    pub(super) fn slots(&self) -> TokenStream {
        let (name, dimension) = (&self.model.name, self.dimension());
        let slots = ["ld", "d1_ld", "d2_ld", "d3_ld", "d4_ld", "fd_minus", "fd_plus", "gd_minus", "gd_plus"];
        let functions = slots.into_iter().map(|slot| {
            let is_vector = ["d2_ld", "d4_ld", "fd_minus", "fd_plus"].contains(&slot);
            let value = if is_vector { quote!(::vi_core::SVector<T, #dimension>) } else { quote!(T) };
            let slot = format_ident!("{slot}");
            quote! {
                fn #slot(&self, interval: &::vi_core::Interval<#dimension, T>) -> #value {
                    ::vi_core::indexed::#slot(self, interval)
                }
            }
        });
        quote! {
            impl<T: ::vi_core::real::Real> ::vi_core::DiscreteLagrangian<#dimension, T> for #name<T> {
                #(#functions)*
            }
        }
    }

    pub(super) fn stepping(&self) -> TokenStream {
        let (name, dimension) = (&self.model.name, self.dimension());
        let of_step = |function: &str, value: TokenStream| {
            let function = format_ident!("{function}");
            quote! {
                fn #function(
                    &self,
                    node: &::vi_core::node::Node<#dimension, T>,
                    h: T,
                    v: &::vi_core::SVector<T, #dimension>,
                ) -> #value {
                    ::vi_core::indexed::#function(self, node, h, v)
                }
            }
        };
        let rounding = |function: &str, value: TokenStream| {
            let function = format_ident!("{function}");
            quote! {
                #[cold]
                fn #function(
                    &self,
                    node: &::vi_core::node::Node<#dimension, T>,
                    h: T,
                    v: &::vi_core::SVector<T, #dimension>,
                ) -> #value {
                    ::vi_core::support::#function(&self.convert::<::vi_core::real::Rounded>(), node, h, v)
                }
            }
        };
        let stepping = quote!(::vi_core::stepping);
        let fixed = [
            of_step("momentum_equation", quote!(#stepping::MomentumEquation<#dimension, T, Self::Jacobian>)),
            of_step("momentum_residual", quote!(#stepping::MomentumResidual<#dimension, T>)),
            of_step("momentum_derivatives", quote!(#stepping::MomentumDerivatives<Self::Jacobian, Self::StepMatrix>)),
            of_step("discrete_energy", quote!(T)),
            rounding("momentum_rounding", quote!(::vi_core::SVector<T, #dimension>)),
        ];
        let density = self.of_state(
            "step_density",
            &quote!(::core::result::Result<T, ::vi_core::StepError>),
            &quote!(::vi_core::indexed::step_density(self, t, q, v)),
        );
        let energy = [
            of_step("extended_system", quote!(#stepping::ExtendedSystem<#dimension, T, Self::Jacobian>)),
            of_step("extended_residual", quote!(#stepping::ExtendedResidual<#dimension, T>)),
            of_step(
                "extended_derivatives",
                quote!(#stepping::ExtendedDerivatives<#dimension, T, Self::Jacobian, Self::StepMatrix>),
            ),
            rounding("extended_rounding", quote!(#stepping::Rounding<#dimension, T>)),
        ];
        quote! {
            impl<T: ::vi_core::real::Real> ::vi_core::stepping::FixedStepping<#dimension, T> for #name<T> {
                type Jacobian = ::vi_core::nalgebra::SMatrix<T, #dimension, #dimension>;
                type StepMatrix = ::vi_core::nalgebra::SMatrix<T, #dimension, #dimension>;
                const CONSTANT_JACOBIAN: bool = false;
                #(#fixed)*
            }

            impl<T: ::vi_core::real::Real> ::vi_core::stepping::EnergyStepping<#dimension, T> for #name<T> {
                #density

                #(#energy)*
            }
        }
    }
}
