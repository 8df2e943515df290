//! `impl Lagrangian`: the continuous functions.

use super::Source;
use super::body::{Body, VelocityFrom, body, state_parts};
use super::constraints;
use super::formula::item_name;
use super::matrix::matrix;
use super::state_function::{flow_by, number, vector, vector_of};
use crate::findings::Pattern;
use crate::model::{Coordinate, Model, Parameter, Space};
use crate::program::{FunctionId, Output};
use crate::symbol::Symbol;
use proc_macro2::{Literal, TokenStream};
use quote::quote;
use vi_expr::{Expr, Node};

/// Characters of a formula shown in documentation.
const CHARACTERS: usize = 400;

/// The implementation of `Lagrangian`.
pub(super) fn item(source: &Source) -> TokenStream {
    let of = &source.system.continuous;
    let [acceleration, flow] = match source.system.constraints {
        Some(_) => constraints::motion(&source.dimension()),
        None => [acceleration(source), flow(source)],
    };
    let functions = [
        number(source, FunctionId::Lagrangian, &source.formula("L", of.lagrangian)),
        number(source, FunctionId::Energy, &source.formula("v·L_v − L", of.energy)),
        vector(source, FunctionId::Momentum, &source.formulas("p", &of.momentum)),
        vector(source, FunctionId::Force, &source.formulas("f", &of.force)),
        acceleration,
        flow,
        non_finite(source),
        undefined(source),
    ];
    let properties = Properties {
        autonomous: of.autonomous,
        cyclic: &of.cyclic,
        monotone: source.model.monotone_table(source.pool),
    };
    implementation(source.model, properties, &functions)
}

/// Values of the constants of `Lagrangian` that the model does not contain.
pub(super) struct Properties<'a> {
    pub(super) autonomous: bool,
    pub(super) cyclic: &'a [bool],
    /// The name of a monotone table in L.
    pub(super) monotone: Option<String>,
}

/// The implementation of `Lagrangian` with these functions.
pub(super) fn implementation(model: &Model, properties: Properties, functions: &[TokenStream]) -> TokenStream {
    let Properties { autonomous, cyclic, monotone } = properties;
    let (name, dimension) = (&model.name, Literal::usize_unsuffixed(model.dimension()));
    let (text, coordinates) = (name.to_string(), model.coordinates.iter().map(Coordinate::text));
    let (forced, spaces, inputs) = (model.forced, spaces(model), inputs(model));
    let parameters = model.parameters.iter().map(Parameter::place);
    let names = model.parameters.iter().map(Parameter::text);
    let monotone = monotone.map(|name| {
        quote! {
            const MONOTONE_TABLE: ::core::option::Option<&'static str> = ::core::option::Option::Some(#name);
        }
    });
    let digest = Some(model.digest_of_tables()).filter(|digest| *digest != 0).map(Literal::u32_unsuffixed);
    let tables = digest.map(|digest| quote!(const TABLES: ::core::primitive::u32 = #digest;));
    quote! {
        impl<T: ::vi_core::real::Real> ::vi_core::Lagrangian<#dimension, T> for #name<T> {
            const NAME: &'static str = #text;
            const COORDINATES: [&'static str; #dimension] = [#(#coordinates),*];
            const AUTONOMOUS: bool = #autonomous;
            const FORCED: bool = #forced;
            const CYCLIC: [bool; #dimension] = [#(#cyclic),*];
            #spaces
            const PARAMETERS: &'static [&'static str] = &[#(#names),*];
            #inputs
            #monotone
            #tables

            fn parameter(&self, index: usize) -> T {
                [#(self.#parameters),*][index]
            }

            #(#functions)*
        }
    }
}

/// The constant that lists the inputs, if there are any.
fn inputs(model: &Model) -> Option<TokenStream> {
    let inputs = (0..).zip(&model.parameters).filter(|(_, parameter)| parameter.is_input);
    let inputs: Vec<Literal> = inputs.map(|(index, _)| Literal::usize_unsuffixed(index)).collect();
    (!inputs.is_empty()).then(|| quote!(const INPUTS: &'static [::core::primitive::usize] = &[#(#inputs),*];))
}

/// The constant that says what coordinates are, if not all are numbers.
fn spaces(model: &Model) -> Option<TokenStream> {
    let space = |of: &Coordinate| match of.component().map(Literal::usize_unsuffixed) {
        Some(component) => quote!(::vi_core::lagrangian::Space::Rotation(#component)),
        None if of.space == Space::Circle => quote!(::vi_core::lagrangian::Space::Circle),
        None => quote!(::vi_core::lagrangian::Space::Line),
    };
    let (dimension, spaces) = (model.dimension(), model.coordinates.iter().map(space));
    let are_lines = model.coordinates.iter().all(|coordinate| coordinate.space == Space::Line);
    (!are_lines).then(|| quote!(const SPACES: [::vi_core::lagrangian::Space; #dimension] = [#(#spaces),*];))
}

impl Source<'_> {
    /// `name = formula` in the user's names.
    pub(super) fn formula(&self, name: &str, expr: Expr) -> String {
        format!("`{name} = {}`", self.spelt(expr))
    }

    /// An expression in the user's names, truncated if it is long.
    fn spelt(&self, expr: Expr) -> String {
        let name = |symbol: &Symbol| self.system.spell(self.model, symbol);
        let text = self.pool.render_within(CHARACTERS, expr, &name);
        match text.strip_suffix('…') {
            Some(shown) => format!("{} …", shown.rsplit_once(' ').map_or(shown, |(words, _)| words)),
            None => text,
        }
    }

    /// One formula per coordinate, with the coordinate as an index.
    pub(super) fn formulas(&self, name: &str, exprs: &[Expr]) -> String {
        self.named_formulas(exprs, |coordinate| format!("{name}_{coordinate}"))
    }

    /// One formula per coordinate; `name` gives the left side.
    pub(super) fn named_formulas(&self, exprs: &[Expr], name: impl Fn(&str) -> String) -> String {
        let named = exprs.iter().zip(&self.model.coordinates);
        let formulas = named.map(|(expr, coordinate)| self.formula(&name(&coordinate.text()), *expr));
        formulas.collect::<Vec<_>>().join("\n\n")
    }

    /// The body of a function with its documentation: formula and operation count.
    pub(super) fn documented(
        &self,
        id: FunctionId,
        formula: &str,
        velocity: VelocityFrom,
    ) -> Option<(Body, TokenStream)> {
        let function = self.function(id)?;
        let printed = body(self.model, function, self.system.points(), velocity, self.limit);
        let count = function.operation_count();
        let noun = if count == 1 { "operation" } else { "operations" };
        let lines = format!("{formula}\n\n{count} {noun}.");
        let lines = lines.lines().map(|line| format!(" {line}"));
        Some((printed, quote!(#(#[doc = #lines])*)))
    }
}

/// The acceleration. If L is linear in the velocities, the equations determine the velocity at given coordinates, and
/// this is the acceleration for that velocity.
fn acceleration(source: &Source) -> TokenStream {
    let dimension = source.dimension();
    let is_first_order = !source.model.without_velocity.is_empty();
    let formula = if is_first_order {
        "Solves `Ω a = d/dt (Ω v)` at the velocity v of the coordinates."
    } else {
        "Solves `M a = L_q + f − L_vt − L_vq v`."
    };
    let Some((body, documentation)) = source.documented(FunctionId::Acceleration, formula, VelocityFrom::Argument)
    else {
        return TokenStream::new();
    };
    let (inputs, statements) = (state_parts(&body, source.model), &body.statements);
    let ((form, mass), applied) = if is_first_order {
        let structure = matrix(&Pattern::Dense, false, body.results.matrix(Output::Structure));
        (structure, body.results.vector(Output::StructureTimesAcceleration))
    } else {
        let mass = matrix(&source.findings.mass, true, body.results.matrix(Output::Mass));
        (mass, body.results.vector(Output::MassTimesAcceleration))
    };
    let applied = vector_of(applied);
    quote! {
        #documentation
        #[inline]
        fn acceleration(
            &self,
            t: T,
            q: &::vi_core::SVector<T, #dimension>,
            v: &::vi_core::SVector<T, #dimension>,
        ) -> ::core::result::Result<::vi_core::SVector<T, #dimension>, ::vi_core::StepError> {
            let time = t;
            #inputs #statements
            let mass: #form = #mass;
            let applied: ::vi_core::SVector<T, #dimension> = #applied;
            ::vi_core::support::acceleration(time, &mass, &applied)
        }
    }
}

/// The function of the step density.
pub(super) fn step_density(source: &Source) -> TokenStream {
    let dimension = source.dimension();
    let formula = source.formula("D", source.system.continuous.step_density);
    let Some((body, documentation)) = source.documented(FunctionId::StepDensity, &formula, VelocityFrom::Argument)
    else {
        return TokenStream::new();
    };
    let (inputs, statements) = (state_parts(&body, source.model), &body.statements);
    let result = body.results.number(Output::Value);
    quote! {
        #documentation
        #[inline]
        fn step_density(
            &self,
            t: T,
            q: &::vi_core::SVector<T, #dimension>,
            v: &::vi_core::SVector<T, #dimension>,
        ) -> ::core::result::Result<T, ::vi_core::StepError> {
            let time = t;
            #inputs #statements
            ::vi_core::support::step_density(time, #result)
        }
    }
}

/// The velocity of a momentum, and the rates of change there. Uses the mass matrix if L is quadratic in the velocities,
/// otherwise Newton iteration.
fn flow(source: &Source) -> TokenStream {
    let dimension = source.dimension();
    if !source.model.without_velocity.is_empty() {
        let flow = quote!(::vi_core::support::first_order_flow::<Self, #dimension, T>(self, t, q));
        return flow_by(&dimension, &quote!(_), &flow);
    }
    let point = quote!(::vi_core::motion::Motion::point);
    let velocity = if source.system.continuous.quadratic {
        quote! {
            let at_rest = #point(self, t, q, &::vi_core::SVector::zeros());
            let velocity = ::vi_core::support::velocity_by_mass(t, &at_rest.mass, &(p - at_rest.momentum))?;
        }
    } else {
        quote! {
            let mass = |v: &::vi_core::SVector<T, #dimension>| #point(self, t, q, v).mass;
            let rounded = self.convert::<::vi_core::real::Rounded>();
            let velocity = ::vi_core::support::velocity(self, &rounded, mass, (t, q, p))?;
        }
    };
    let flow = quote! {
        #velocity
        let force = #point(self, t, q, &velocity).force;
        let power = ::vi_core::motion::Motion::power(self, t, q, &velocity);
        ::core::result::Result::Ok(::vi_core::lagrangian::Flow { v: velocity, force, power })
    };
    flow_by(&dimension, &quote!(p), &flow)
}

/// The function that names the first call of a Rust function or a table without a value.
fn undefined(source: &Source) -> TokenStream {
    let dimension = source.dimension();
    let formula = "The first call of a function or a table that has no value at this state.";
    let Some((body, documentation)) = source.documented(FunctionId::Undefined, formula, VelocityFrom::Argument) else {
        return TokenStream::new();
    };
    let (inputs, statements) = (state_parts(&body, source.model), &body.statements);
    let mut arguments = body.results.vector(Output::Value).iter();
    let calls = source.system.continuous.calls.iter().map(|(call, of)| {
        let Node::Opaque(function, _) = source.pool.node(*call) else { return TokenStream::new() };
        let (item, text) = (item_name(&function.name), source.spelt(*call));
        let arguments = arguments.by_ref().take(of.len());
        quote!(#item.undefined(#text, [#(#arguments),*]))
    });
    let calls: Vec<TokenStream> = calls.collect();
    quote! {
        #documentation
        #[cold]
        fn undefined(
            &self,
            t: T,
            q: &::vi_core::SVector<T, #dimension>,
            v: &::vi_core::SVector<T, #dimension>,
        ) -> ::core::option::Option<::vi_core::lagrangian::Undefined> {
            #inputs #statements
            [#(#calls),*].into_iter().flatten().next()
        }
    }
}

fn non_finite(source: &Source) -> TokenStream {
    let dimension = source.dimension();
    let formula = "The first part of L and f that is not finite at this state.";
    let Some((body, documentation)) = source.documented(FunctionId::NonFinite, formula, VelocityFrom::Argument) else {
        return TokenStream::new();
    };
    let (inputs, statements) = (state_parts(&body, source.model), &body.statements);
    let texts = source.system.continuous.watched.iter().map(|expr| source.spelt(*expr));
    let values = body.results.vector(Output::Value).iter();
    quote! {
        #documentation
        #[cold]
        fn non_finite(
            &self,
            t: T,
            q: &::vi_core::SVector<T, #dimension>,
            v: &::vi_core::SVector<T, #dimension>,
        ) -> ::core::option::Option<&'static str> {
            #inputs #statements
            let values = [#((#texts, #values)),*];
            values.into_iter().find(|(_, value)| !value.is_finite()).map(|(text, _)| text)
        }
    }
}
