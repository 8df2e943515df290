//! The traits of a system, each function by one of `vi_core::indexed`.

use super::super::check::monotone_table_of;
use super::super::constraints;
use super::super::constraints::Members;
use super::super::lagrangian::{Properties, implementation};
use super::super::{by_marker, structure};
use super::first::Sweep;
use super::{Printer, reads_entries};
use crate::indexed::Read;
use crate::rules::NamedRule;
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
            fn mass_diagonal(
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
    pub(super) fn mass(&self) -> [TokenStream; 3] {
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
            quote!(self.mass_diagonal(t, q, v)),
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

    /// The implementation of `Motion`.
    pub(super) fn motion(&self) -> TokenStream {
        let (name, dimension, is_constant) = (&self.model.name, self.dimension(), self.of.separable);
        let is_free = self.model.constraints.is_empty();
        let Members { kind, items, functions } = if is_free { Members::free() } else { self.constraints() };
        let [mass_items, form, mass] = self.mass();
        let point = self.of_state(
            "point",
            &quote!(::vi_core::motion::Point<#dimension, T, Self::Mass>),
            &quote!(::vi_core::indexed::point(self, t, q, v, #mass)),
        );
        let sides = self.of_state(
            "sides",
            &quote!(::vi_core::motion::Sides<#dimension, T>),
            &quote!(::vi_core::indexed::sides(self, t, q, v)),
        );
        let derivatives = self.of_state(
            "point_derivatives",
            &quote!(::vi_core::motion::PointDerivatives<Self::PointMatrix>),
            &quote!(::vi_core::indexed::point_derivatives(self, t, q, v)),
        );
        let power = self.of_state("power", &quote!(T), &quote!(::vi_core::indexed::power(self, t, q, v)));
        let [scaled, has_time_scale] = self.time_scale();
        let separable = is_constant && is_free;
        let splits = separable.then(
            || quote!(impl<T: ::vi_core::real::Real> ::vi_core::motion::Separable<#dimension, T> for #name<T> {}),
        );
        quote! {
            #mass_items
            #items
            #splits
            #has_time_scale
            impl<T: ::vi_core::real::Real> ::vi_core::motion::Motion<#dimension, T> for #name<T> {
                type Kind = #kind;
                type Mass = #form;
                type PointMatrix = ::vi_core::nalgebra::SMatrix<T, #dimension, #dimension>;
                const CONSTANT_MASS: bool = #is_constant;
                const SEPARABLE: bool = #separable;
                #point
                #sides
                #derivatives
                #power
                #scaled
                #functions
            }
        }
    }

    /// The steps by a rule; by one that is not the system's own, as the argument of the traits.
    pub(super) fn steps(&self, rule: &'static NamedRule, is_own: bool) -> TokenStream {
        let marker = format_ident!("{}", rule.marker);
        let rule = Rule {
            marker: quote!(::vi_core::rules::#marker),
            argument: (!is_own).then(|| quote!(, ::vi_core::rules::#marker)),
            named: rule,
        };
        let (slots, fixed) = (self.slots(&rule), self.fixed_stepping(&rule));
        let energy = rule.named.step_density.then(|| self.energy_stepping(&rule));
        let discretized = structure::discretized(self.model, rule.argument.as_ref());
        quote!(#slots #fixed #energy #discretized)
    }

    fn slots(&self, Rule { marker, argument, .. }: &Rule) -> TokenStream {
        let (name, dimension) = (&self.model.name, self.dimension());
        let slots = ["ld", "d1_ld", "d2_ld", "d3_ld", "d4_ld", "fd_minus", "fd_plus", "gd_minus", "gd_plus"];
        let functions = slots.into_iter().map(|slot| {
            let is_vector = ["d2_ld", "d4_ld", "fd_minus", "fd_plus"].contains(&slot);
            let value = if is_vector { quote!(::vi_core::SVector<T, #dimension>) } else { quote!(T) };
            let slot = format_ident!("{slot}");
            quote! {
                fn #slot(&self, interval: &::vi_core::Interval<#dimension, T>) -> #value {
                    ::vi_core::indexed::#slot(self, #marker, interval)
                }
            }
        });
        quote! {
            impl<T: ::vi_core::real::Real> ::vi_core::DiscreteLagrangian<#dimension, T #argument> for #name<T> {
                #(#functions)*
            }
        }
    }

    /// A function of a step from a node with (h, v).
    fn of_step(&self, function: &str, value: &TokenStream, result: &TokenStream) -> TokenStream {
        let (function, dimension) = (format_ident!("{function}"), self.dimension());
        quote! {
            fn #function(
                &self,
                node: &::vi_core::node::Node<#dimension, T>,
                h: T,
                v: &::vi_core::SVector<T, #dimension>,
            ) -> #value {
                #result
            }
        }
    }

    /// The bounds of rounding errors, by the same function over other numbers.
    fn rounding(&self, function: &str, rule: &Rule, value: &TokenStream) -> TokenStream {
        let of = format_ident!("{function}");
        let rounded = quote!(self.convert::<::vi_core::real::Rounded>());
        let rounded = if rule.argument.is_some() {
            by_marker(&format_ident!("{}", rule.named.marker), &rounded)
        } else {
            rounded
        };
        let function = self.of_step(function, value, &quote!(::vi_core::support::#of(&#rounded, node, h, v)));
        quote!(#[cold] #function)
    }

    fn fixed_stepping(&self, rule: &Rule) -> TokenStream {
        let (name, dimension) = (&self.model.name, self.dimension());
        let Rule { marker, argument, named } = rule;
        let is_explicit = self.of.is_explicit(named);
        let (form, jacobian) = if is_explicit {
            (quote!(::vi_core::linear::Banded<#dimension, 1, T>), quote!(self.mass_diagonal(node.t, &node.q, v)))
        } else {
            (
                quote!(::vi_core::nalgebra::SMatrix<T, #dimension, #dimension>),
                quote!(::vi_core::indexed::jacobian(self, #marker, node, h, v)),
            )
        };
        let stepping = quote!(::vi_core::stepping);
        let of_step = |function: &str, value: TokenStream| {
            let of = format_ident!("{function}");
            self.of_step(function, &value, &quote!(::vi_core::indexed::#of(self, #marker, node, h, v)))
        };
        let with_jacobian = |function: &str, value: TokenStream| {
            let of = format_ident!("{function}");
            self.of_step(function, &value, &quote!(::vi_core::indexed::#of(self, #marker, node, h, v, #jacobian)))
        };
        let functions = [
            with_jacobian("momentum_equation", quote!(#stepping::MomentumEquation<#dimension, T, Self::Jacobian>)),
            of_step("momentum_residual", quote!(#stepping::MomentumResidual<#dimension, T>)),
            with_jacobian(
                "momentum_derivatives",
                quote!(#stepping::MomentumDerivatives<Self::Jacobian, Self::StepMatrix>),
            ),
            of_step("discrete_energy", quote!(T)),
            self.rounding("momentum_rounding", rule, &quote!(::vi_core::SVector<T, #dimension>)),
        ];
        quote! {
            impl<T: ::vi_core::real::Real> ::vi_core::stepping::FixedStepping<#dimension, T #argument> for #name<T> {
                type Jacobian = #form;
                type StepMatrix = ::vi_core::nalgebra::SMatrix<T, #dimension, #dimension>;
                const CONSTANT_JACOBIAN: bool = #is_explicit;
                #(#functions)*
            }
        }
    }

    fn energy_stepping(&self, rule: &Rule) -> TokenStream {
        let (name, dimension, argument) = (&self.model.name, self.dimension(), &rule.argument);
        let stepping = quote!(::vi_core::stepping);
        let of_step = |function: &str, value: TokenStream| {
            let of = format_ident!("{function}");
            self.of_step(function, &value, &quote!(::vi_core::indexed::#of(self, node, h, v)))
        };
        let density = self.of_state(
            "step_density",
            &quote!(::core::result::Result<T, ::vi_core::StepError>),
            &quote!(::vi_core::indexed::step_density(self, t, q, v)),
        );
        let functions = [
            of_step("extended_system", quote!(#stepping::ExtendedSystem<#dimension, T, Self::Jacobian>)),
            of_step("extended_residual", quote!(#stepping::ExtendedResidual<#dimension, T>)),
            of_step(
                "extended_derivatives",
                quote!(#stepping::ExtendedDerivatives<#dimension, T, Self::Jacobian, Self::StepMatrix>),
            ),
            self.rounding("extended_rounding", rule, &quote!(#stepping::Rounding<#dimension, T>)),
        ];
        quote! {
            impl<T: ::vi_core::real::Real> ::vi_core::stepping::EnergyStepping<#dimension, T #argument> for #name<T> {
                #density

                #(#functions)*
            }
        }
    }
}

/// A rule in code.
struct Rule {
    named: &'static NamedRule,
    /// Its marker.
    marker: TokenStream,
    /// The last argument of a trait; none for the system's own rule.
    argument: Option<TokenStream>,
}
