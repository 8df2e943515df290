//! The struct of a system: its parameters as public fields, their defaults, their names. A system with mistakes gets a
//! stub: the struct with every trait that its clauses may give it, so that the surrounding code has no further errors.

use super::formula::number;
use super::{Source, Steps, conditions, limit};
use crate::limits::{COORDINATES, PARAMETERS};
use crate::model::{COMPONENTS, Model, Parameter, Space};
use crate::rules::{GAUSS, NamedRule, RULES};
use crate::syntax::{self, Discretization, Expression, Kind, System};
use num_traits::ToPrimitive;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote};
use std::collections::BTreeMap;

/// The struct, with the properties under each rule in its documentation.
pub(super) fn structure(source: &Source, further: &[Steps]) -> TokenStream {
    let findings = findings_documentation(source);
    let further = further.iter().filter_map(further_findings);
    declaration(source.model, &quote!(#findings #(#further)*))
}

/// The struct with this documentation after the user's.
pub(super) fn declaration(model: &Model, documentation: &TokenStream) -> TokenStream {
    let (name, visibility) = (&model.name, &model.visibility);
    let attributes = model.attributes.iter().filter(|attribute| limit(attribute).is_none());
    let fields = model.fields().filter_map(|field| {
        let Parameter { name, attributes, .. } = field.first()?;
        let pause = pause(attributes);
        let default = default_words(field);
        let of = array_of(&lengths(field), quote!(T));
        Some(quote!(#(#attributes)* #pause #[doc = #default] pub #name: #of))
    });
    let (derived, (marker, _)) = (derived(), marker(model.parameters.is_empty()));
    quote! {
        #(#attributes)*
        #documentation
        #derived
        #[allow(non_snake_case)]
        #visibility struct #name<T = ::core::primitive::f64> {
            #(#fields,)*
            #marker
        }
    }
}

/// The lengths of the array of a field; none of a number.
fn lengths(field: &[Parameter]) -> Vec<usize> {
    field.last().map(|last| last.indices.iter().map(|index| index + 1).collect()).unwrap_or_default()
}

/// An array of these lengths, as a type or as a value that repeats one entry.
fn array_of(lengths: &[usize], one: TokenStream) -> TokenStream {
    lengths.iter().rev().fold(one, |inner, length| {
        let length = Literal::usize_unsuffixed(*length);
        quote!([#inner; #length])
    })
}

/// Documentation of the default of a field.
fn default_words(field: &[Parameter]) -> String {
    let defaults: Vec<String> = field.iter().map(Parameter::default_text).collect();
    let (Some(first), Some(last)) = (field.first(), field.last()) else { return String::new() };
    let word = if first.is_input { "Input" } else { "Parameter" };
    if first.indices.is_empty() {
        return format!(" {word} `{}`, {} by default.", first.name, defaults.join(", "));
    }
    let same = defaults.iter().all(|default| *default == defaults[0]);
    let values = if same { format!("each {}", defaults[0]) } else { defaults.join(", ") };
    format!(" {word}s `{}` to `{}`, {values} by default.", first.text(), last.text())
}

/// The same system over dual numbers, without derivatives.
pub(super) fn dual(model: &Model) -> TokenStream {
    let name = &model.name;
    let names: Vec<_> = model.fields().filter_map(<[Parameter]>::first).map(|parameter| &parameter.name).collect();
    let one = |place| quote!(::vi_core::real::Dual::fixed(self.#place));
    let fields = model.fields().filter_map(|field| field_value(field, one));
    let (_, marker_value) = marker(names.is_empty());
    quote!(#name { #(#names: #fields,)* #marker_value })
}

/// The value of a field: `one` of its parameter, or an array of these.
fn field_value(field: &[Parameter], one: impl Fn(TokenStream) -> TokenStream) -> Option<TokenStream> {
    let Parameter { name, indices, .. } = field.first()?;
    let counter = |level: usize| if level == 0 { format_ident!("entry") } else { format_ident!("entry{level}") };
    let counters: Vec<Ident> = (0..indices.len()).map(counter).collect();
    let entry = one(quote!(#name #([#counters])*));
    Some(counters.iter().rev().fold(entry, |inner, counter| quote!(::core::array::from_fn(|#counter| #inner))))
}

/// The default of a field.
fn default_value(field: &[Parameter]) -> TokenStream {
    let mut values: Vec<TokenStream> = field.iter().map(|parameter| number(parameter.default)).collect();
    for length in lengths(field).into_iter().rev() {
        values = values.chunks(length.max(1)).map(|row| quote!([#(#row),*])).collect();
    }
    quote!(#(#values)*)
}

/// The derived traits of every system.
fn derived() -> TokenStream {
    quote!(#[derive(::core::clone::Clone, ::core::marker::Copy, ::core::fmt::Debug, ::core::cmp::PartialEq)])
}

/// `Default`, `Parameters`, and the conversion to another numeric type.
pub(super) fn parameters(model: &Model) -> TokenStream {
    let name = &model.name;
    let names: Vec<_> = model.fields().filter_map(<[Parameter]>::first).map(|parameter| &parameter.name).collect();
    let defaults = model.fields().map(default_value);
    let one = |place| quote!(U::real(self.#place.to_f64()));
    let converted = model.fields().filter_map(|field| field_value(field, one));
    let arms = model.parameters.iter().map(|parameter| {
        let (text, place) = (parameter.text(), parameter.place());
        quote!(#text => ::core::option::Option::Some(&mut self.#place))
    });
    let (_, marker_value) = marker(names.is_empty());
    quote! {
        impl ::core::default::Default for #name<f64> {
            fn default() -> Self {
                Self { #(#names: #defaults,)* #marker_value }
            }
        }

        impl<T: ::vi_core::real::Real> #name<T> {
            /// The same system in another kind of number, every parameter rounded to it.
            pub fn convert<U: ::vi_core::real::Real>(&self) -> #name<U> {
                #name { #(#names: #converted,)* #marker_value }
            }
        }

        impl<T: ::vi_core::real::Real> ::vi_core::lagrangian::Parameters<T> for #name<T> {
            fn parameter_mut(&mut self, name: &str) -> ::core::option::Option<&mut T> {
                match name {
                    #(#arms,)*
                    _ => ::core::option::Option::None,
                }
            }
        }
    }
}

/// The declaration in words, and its text.
pub(crate) fn described(model: &Model, definition: &str) -> TokenStream {
    let name = &model.name;
    let conditions = conditions(&model.attributes);
    let about = model.about();
    let parameters = model.parameters.iter().map(Parameter::about);
    quote! {
        #(#conditions)*
        #[allow(deprecated)]
        impl ::vi_core::lagrangian::Described for #name {
            const ABOUT: &'static ::core::primitive::str = #about;
            const PARAMETERS_ABOUT: &'static [&'static ::core::primitive::str] = &[#(#parameters),*];
            const DEFINITION: &'static ::core::primitive::str = #definition;
        }
    }
}

/// The implementation of `Convertible`: the system in another numeric type.
pub(super) fn convertible(model: &Model, side_by_side: bool) -> TokenStream {
    let alone = (!side_by_side).then(|| {
        quote!(
            const SIDE_BY_SIDE: bool = false;
        )
    });
    let (name, dimension) = (&model.name, Literal::usize_unsuffixed(model.dimension()));
    quote! {
        impl ::vi_core::stepping::Convertible<#dimension> for #name<f64> {
            type In<T: ::vi_core::real::Real> = #name<T>;
            #alone

            #[inline(always)]
            fn convert<T: ::vi_core::real::Real>(&self) -> #name<T> {
                self.convert()
            }
        }
    }
}

/// The implementation of `Discretized` for the rule: its steps in another numeric type.
pub(super) fn discretized(model: &Model, rule: Option<&TokenStream>) -> TokenStream {
    let (name, dimension) = (&model.name, Literal::usize_unsuffixed(model.dimension()));
    quote! {
        impl ::vi_core::stepping::Discretized<#dimension #rule> for #name<f64> {
            type Steps<T: ::vi_core::real::Real> = #name<T>;

            #[inline(always)]
            fn steps<T: ::vi_core::real::Real>(&self) -> #name<T> {
                self.convert()
            }
        }
    }
}

/// The implementation of `Batch`: parameters of several systems in lanes.
pub(super) fn batch(model: &Model) -> TokenStream {
    let (name, dimension) = (&model.name, Literal::usize_unsuffixed(model.dimension()));
    let names: Vec<_> = model.fields().filter_map(<[Parameter]>::first).map(|parameter| &parameter.name).collect();
    let row = |place| quote!(::core::array::from_fn(|index| systems[index].#place));
    let one = |place| quote!(rows.#place[index]);
    let side_by_side = model.fields().filter_map(|field| field_value(field, row));
    let alone = model.fields().filter_map(|field| field_value(field, one));
    let (_, marker_value) = marker(names.is_empty());
    quote! {
        impl ::vi_core::stepping::Batch<#dimension> for #name<f64> {
            type Rows<const W: usize> = #name<[f64; W]>;

            fn rows<const W: usize>(systems: &[Self; W]) -> Self::Rows<W> {
                #name { #(#names: #side_by_side,)* #marker_value }
            }

            #[inline(always)]
            fn from_rows<const W: usize>(rows: &Self::Rows<W>, index: usize) -> Self {
                #name { #(#names: #alone,)* #marker_value }
            }
        }
    }
}

/// The properties found by the generator, at the end of the documentation of the struct.
fn findings_documentation(source: &Source) -> TokenStream {
    let model = source.model;
    let findings = source.findings.lines(&|index| format!("`{}`", model.coordinates[index].text()));
    found(model, findings)
}

/// Documentation of the rule of a system, and these properties.
pub(super) fn found(model: &Model, findings: Vec<String>) -> TokenStream {
    let rule = match &model.rule {
        Some(rule) => format!(" Discretized by the rule `{}`. Properties found by the generator:", rule.title()),
        None if !model.constraints.is_empty() => {
            " Integrated by `Gauss` and `EnergyPreservingGauss`. Properties found by the generator:".to_owned()
        }
        None => " Integrated by Gauss methods only. Properties found by the generator:".to_owned(),
    };
    let findings = findings.into_iter().map(|line| format!(" * {line}"));
    let pause = pause(&model.attributes);
    quote!(#pause #[doc = #rule] #[doc = ""] #(#[doc = #findings])*)
}

/// The properties of the steps with a further rule.
fn further_findings(source: &Steps) -> Option<TokenStream> {
    let rule = source.rule.named.filter(|_| source.marker.is_some())?;
    let name = |index: usize| format!("`{}`", source.model.coordinates[index].text());
    Some(further(rule, source.source.findings.of_steps(&name)))
}

/// Documentation of the steps with a further rule.
pub(super) fn further(rule: &NamedRule, findings: Vec<String>) -> TokenStream {
    let rule = format!(" By the rule `{}`, as `By::new(system, {})`:", rule.name, rule.marker);
    let findings = findings.into_iter().map(|line| format!(" * {line}"));
    quote!(#[doc = ""] #[doc = #rule] #[doc = ""] #(#[doc = #findings])*)
}

/// An empty line of documentation that separates the user's paragraph from ours.
fn pause(attributes: &[syn::Attribute]) -> Option<TokenStream> {
    attributes.iter().any(|attribute| attribute.path().is_ident("doc")).then(|| quote!(#[doc = ""]))
}

/// A system with errors.
pub struct Broken {
    conditions: Vec<syn::Attribute>,
    stub: TokenStream,
}

impl Broken {
    /// The stub of a system with errors: its struct and the traits without bodies, so that the code that uses it still
    /// type-checks. If the number of coordinates is unknown, the stub is generic over it.
    #[must_use]
    pub fn of(system: &System) -> Self {
        Self { conditions: conditions(&system.attributes).cloned().collect(), stub: stub(system) }
    }

    /// The errors, with the stub if there is one.
    #[must_use]
    pub fn with(&self, error: &syn::Error) -> TokenStream {
        let Self { conditions, stub } = self;
        let errors = error.to_compile_error();
        if conditions.is_empty() {
            return quote!(#errors #stub);
        }
        quote! {
            #(#conditions)*
            const _: () = { #errors };
            #stub
        }
    }
}

fn stub(system: &System) -> TokenStream {
    let (name, visibility) = (&system.name, &system.visibility);
    // A parameter that is declared twice is an error, but the stub has one field for it.
    let parameters: BTreeMap<String, &syntax::Parameter> =
        system.parameters.iter().map(|parameter| (parameter.name.to_string(), parameter)).collect();
    let names: Vec<&Ident> = parameters.values().map(|parameter| &parameter.name).collect();
    let lengths: Vec<Vec<usize>> = parameters.values().map(|parameter| field_lengths(system, parameter)).collect();
    let types = lengths.iter().map(|lengths| array_of(lengths, quote!(T)));
    let zeros = lengths.iter().map(|lengths| array_of(lengths, quote!(0.0)));
    let (marker, marker_value) = marker(names.is_empty());
    let size = Size::of(system);
    let (parameters, lagrangian) = (stub_parameters(name), stub_lagrangian(name, &size));
    let motion = if system.is_constrained {
        stub_motion(name, &size, &quote!(Bound<1>))
    } else {
        let by_rules = rules(system).into_iter().map(|rule| stub_steps(name, &size, rule.as_ref()));
        let (motion, batch) = (stub_motion(name, &size, &quote!(Free)), stub_batch(name, &size));
        quote!(#motion #batch #(#by_rules)*)
    };
    let traits = quote!(#parameters #lagrangian #motion);
    let (derived, conditions) = (derived(), conditions(&system.attributes).collect::<Vec<_>>());
    quote! {
        #(#conditions)*
        #derived
        #[allow(missing_docs, dead_code, non_snake_case)]
        #visibility struct #name<T = ::core::primitive::f64> { #(pub #names: #types,)* #marker }
        #(#conditions)*
        #[allow(unused_imports)]
        const _: () = {
            use ::core::primitive::{bool, f64, str, usize};

            impl ::core::default::Default for #name<f64> {
                fn default() -> Self {
                    Self { #(#names: #zeros,)* #marker_value }
                }
            }
            #traits
        };
    }
}

/// The number of coordinates, if every length is a literal or a constant defined by one.
fn dimension(system: &System) -> Option<Literal> {
    let lengths = system.coordinates.iter().map(|coordinate| {
        let lengths = coordinate.lengths.iter().map(|length| plain_length(system, length));
        let product = |before: usize, length: Option<usize>| before.checked_mul(length?);
        let components = if coordinate.space == Space::Rotation { COMPONENTS } else { 1 };
        lengths.into_iter().try_fold(components, product).filter(|length| *length <= COORDINATES)
    });
    lengths.sum::<Option<usize>>().filter(|dimension| *dimension > 0).map(Literal::usize_unsuffixed)
}

/// The lengths of the field of an array of parameters. Unknown lengths are those of its default, or 1.
fn field_lengths(system: &System, parameter: &syntax::Parameter) -> Vec<usize> {
    let mut default = Some(&parameter.default);
    let length = |written: &Expression| {
        let known = plain_length(system, written).filter(|length| (1..=PARAMETERS).contains(length));
        let values = match default.map(|default| &default.kind) {
            Some(Kind::List(values)) => {
                default = values.first();
                values.len()
            }
            _ => 1,
        };
        known.unwrap_or(values)
    };
    let lengths: Vec<usize> = parameter.lengths.iter().map(length).collect();
    let count = lengths.iter().try_fold(1_usize, |before, length| before.checked_mul(*length));
    if count.is_some_and(|count| count <= PARAMETERS) { lengths } else { vec![1; lengths.len()] }
}

/// A length that is a literal, or a constant defined by one.
fn plain_length(system: &System, length: &Expression) -> Option<usize> {
    let number = match &length.kind {
        Kind::Name(name) => &system.constants.iter().find(|constant| constant.name == *name)?.value.kind,
        other => other,
    };
    if let Kind::Number(number) = number { number.to_usize() } else { None }
}

/// The rules of a system as last arguments of a trait, the default rule first. If the list has errors, all existing
/// rules.
fn rules(system: &System) -> Vec<Option<TokenStream>> {
    let names: Vec<&Ident> = match system.discretizations.first() {
        Some(Discretization::Written(_)) => return vec![None],
        Some(Discretization::Named(names)) => names.iter().filter(|name| *name != GAUSS).collect(),
        None => Vec::new(),
    };
    let is_known = |name: &&Ident| RULES.iter().any(|rule| *name == rule.name);
    let is_read = !names.is_empty() && names.iter().all(is_known);
    let further = RULES.iter().filter(|rule| !is_read || names.iter().skip(1).any(|name| *name == rule.name));
    let argument = further.map(|rule| {
        let marker = format_ident!("{}", rule.marker);
        Some(quote!(, ::vi_core::rules::#marker))
    });
    [None].into_iter().chain(argument).collect()
}

/// The number of coordinates of a stub, as written in types.
struct Size {
    /// The generic parameter that declares it, if it is unknown.
    generic: Option<TokenStream>,
    n: TokenStream,
}

impl Size {
    fn of(system: &System) -> Self {
        match dimension(system) {
            Some(dimension) => Self { generic: None, n: quote!(#dimension) },
            None => Self { generic: Some(quote!(const N: ::core::primitive::usize,)), n: quote!(N) },
        }
    }
}

/// The stub of parameters and conversions.
fn stub_parameters(name: &Ident) -> TokenStream {
    let none = quote!({ loop {} });
    quote! {
        impl<T: ::vi_core::real::Real> #name<T> {
            #[allow(dead_code, missing_docs)]
            pub fn convert<U: ::vi_core::real::Real>(&self) -> #name<U> #none
        }
        impl<T: ::vi_core::real::Real> ::vi_core::lagrangian::Parameters<T> for #name<T> {
            fn parameter_mut(&mut self, _: &str) -> ::core::option::Option<&mut T> #none
        }
    }
}

/// The stub of runs side by side, and of a time scale and of kicks and drifts, since their terms may have the error. A
/// system with constraints has none of them.
fn stub_batch(name: &Ident, Size { generic, n }: &Size) -> TokenStream {
    let none = quote!({ loop {} });
    quote! {
        impl<#generic T: ::vi_core::real::Real> ::vi_core::motion::TimeScale<#n, T> for #name<T> {}
        impl<#generic T: ::vi_core::real::Real> ::vi_core::motion::Separable<#n, T> for #name<T> {}
        impl<#generic> ::vi_core::stepping::Batch<#n> for #name<f64> {
            type Rows<const W: ::core::primitive::usize> = Self;
            fn rows<const W: ::core::primitive::usize>(_: &[Self; W]) -> Self #none
            fn from_rows<const W: ::core::primitive::usize>(_: &Self, _: ::core::primitive::usize) -> Self #none
        }
    }
}

fn stub_lagrangian(name: &Ident, Size { generic, n }: &Size) -> TokenStream {
    quote! {
        impl<#generic T: ::vi_core::real::Real> ::vi_core::Lagrangian<#n, T> for #name<T> {
            const NAME: &'static str = "";
            const COORDINATES: [&'static str; #n] = [""; #n];
            const AUTONOMOUS: bool = false;
            const FORCED: bool = false;
            const CYCLIC: [bool; #n] = [false; #n];
            ::vi_core::forward! { [#n T Self] stub; lagrangian rates }
        }
    }
}

/// The stub of the equations of motion.
fn stub_motion(name: &Ident, Size { generic, n }: &Size, kind: &TokenStream) -> TokenStream {
    quote! {
        impl<#generic T: ::vi_core::real::Real> ::vi_core::motion::Motion<#n, T> for #name<T> {
            type Kind = ::vi_core::kind::#kind;
            type Mass = ::vi_core::nalgebra::SMatrix<T, #n, #n>;
            type PointMatrix = ::vi_core::nalgebra::SMatrix<T, #n, #n>;
            const CONSTANT_MASS: bool = false;
            ::vi_core::forward! { [#n T Self] stub; motion reactions }
        }
        impl<#generic> ::vi_core::stepping::Convertible<#n> for #name<f64> {
            type In<T: ::vi_core::real::Real> = #name<T>;
            fn convert<T: ::vi_core::real::Real>(&self) -> #name<T> { loop {} }
        }
    }
}

fn stub_steps(name: &Ident, Size { generic, n }: &Size, rule: Option<&TokenStream>) -> TokenStream {
    quote! {
        impl<#generic T: ::vi_core::real::Real> ::vi_core::DiscreteLagrangian<#n, T #rule> for #name<T> {
            ::vi_core::forward! { [#n T Self] stub; slots }
        }
        impl<#generic T: ::vi_core::real::Real> ::vi_core::stepping::FixedStepping<#n, T #rule> for #name<T> {
            type Jacobian = ::vi_core::nalgebra::SMatrix<T, #n, #n>;
            type StepMatrix = ::vi_core::nalgebra::SMatrix<T, #n, #n>;
            const CONSTANT_JACOBIAN: bool = false;
            ::vi_core::forward! { [#n T Self] stub; fixed_residuals fixed_matrices }
        }
        impl<#generic T: ::vi_core::real::Real> ::vi_core::stepping::EnergyStepping<#n, T #rule> for #name<T> {
            ::vi_core::forward! { [#n T Self] stub; energy_residuals energy_matrices }
        }
        impl<#generic> ::vi_core::stepping::Discretized<#n #rule> for #name<f64> {
            type Steps<T: ::vi_core::real::Real> = #name<T>;
            fn steps<T: ::vi_core::real::Real>(&self) -> #name<T> { loop {} }
        }
    }
}

/// The field for the numeric type of a system without parameters, and its value.
fn marker(needed: bool) -> (TokenStream, TokenStream) {
    if needed {
        (
            quote!(#[doc(hidden)] pub numbers: ::core::marker::PhantomData<T>),
            quote!(numbers: ::core::marker::PhantomData),
        )
    } else {
        (TokenStream::new(), TokenStream::new())
    }
}
