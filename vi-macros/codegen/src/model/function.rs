//! Declared functions: of the language, of Rust, and tables.
//!
//! In: the clauses `fn` and `table`. Out: the meaning of their names. A function of the language is replaced by its body
//! at each call. The others are opaque: the [`Model`](super::Model) lists them for the code that evaluates them.

use super::Parameter;
use super::called::Called;
use super::context::Context;
use super::lets;
use super::scope::{Meaning, Scope};
use super::table::{self, Table, TableKind};
use super::value::Value;
use crate::messages::{FunctionMistake, Message, error};
use crate::symbol::Symbol;
use crate::syntax::{self, Body, Expression};
use proc_macro2::{Ident, Span};
use std::rc::Rc;
use syn::Result;
use vi_expr::{Expr, MAX_ARGUMENTS, Opaque, Pool};

/// Work of a call besides its arguments and its body: names get their meanings and lose them.
const CALL: usize = 200;

/// Frequency of the stand-in of a function without a known period.
const FREQUENCY: f64 = 0.7;

/// A function that the generated code evaluates.
pub struct Function {
    /// Its name.
    pub name: Ident,
    /// The names of its arguments.
    pub arguments: Vec<String>,
    /// Its kind.
    pub kind: FunctionKind,
}

/// The kinds of functions that the generated code evaluates.
pub enum FunctionKind {
    /// A Rust function.
    Rust(syn::Path),
    /// A table.
    Table(Table),
}

impl Function {
    /// Whether it is a monotone table, whose second derivative jumps.
    pub(crate) fn is_monotone(&self) -> bool {
        matches!(&self.kind, FunctionKind::Table(table) if table.kind == TableKind::Monotone)
    }

    /// The function itself, for expressions.
    fn opaque(&self) -> Opaque {
        let period = match &self.kind {
            FunctionKind::Table(table) => table.period(),
            FunctionKind::Rust(_) => None,
        };
        let frequency = period.map_or(FREQUENCY, |period| core::f64::consts::TAU / period);
        Opaque::new(&self.name.to_string(), self.arguments.len(), frequency)
    }
}

/// Declares all functions and tables. Returns those that the generated code evaluates.
pub(super) fn functions(context: &mut Context, written: &syntax::System, declared: &[Parameter]) -> Vec<Function> {
    let mut functions = Vec::new();
    for function in &written.functions {
        let arguments: Vec<String> = function.arguments.iter().map(Ident::to_string).collect();
        for (place, argument) in function.arguments.iter().enumerate() {
            if function.arguments[..place].contains(argument) {
                context.errors.at(argument.span(), &Message::Duplicate { name: argument.to_string() });
            }
        }
        let called = match &function.body {
            Body::Expression(_) => Called::Language(Rc::clone(function)),
            Body::Path(path) => {
                if arguments.len() > MAX_ARGUMENTS {
                    let name = function.name.to_string();
                    context.errors.at(
                        function.name.span(),
                        &Message::Function(FunctionMistake::TooManyArguments { name, limit: MAX_ARGUMENTS }),
                    );
                    context.declare(&function.name, Meaning::Wrong);
                    continue;
                }
                let kind = FunctionKind::Rust(path.clone());
                functions.push(Function { name: function.name.clone(), arguments: arguments.clone(), kind });
                let function = functions[functions.len() - 1].opaque();
                Called::Opaque { function, arguments, parameters: Vec::new() }
            }
        };
        context.declare(&function.name, Meaning::Function(called));
    }
    for written_table in &written.tables {
        let name = &written_table.name;
        let Some((table, parameters)) = table::table(context, written_table, (written, declared)) else {
            context.declare(name, Meaning::Wrong);
            continue;
        };
        let arguments: Vec<String> = written_table.arguments.iter().map(|argument| argument.name.to_string()).collect();
        let kind = FunctionKind::Table(table);
        functions.push(Function { name: name.clone(), arguments: arguments.clone(), kind });
        let function = functions[functions.len() - 1].opaque();
        context.declare(name, Meaning::Function(Called::Opaque { function, arguments, parameters }));
    }
    functions
}

/// Reports functions and tables that no expression has called: their bodies would never be checked.
pub(super) fn check_used(context: &mut Context, written: &syntax::System) {
    let names = written.functions.iter().map(|function| &function.name);
    for name in names.chain(written.tables.iter().map(|table| &table.name)) {
        if !context.scope.was_called(&name.to_string()) {
            context.errors.at(name.span(), &Message::Function(FunctionMistake::Unused { name: name.to_string() }));
        }
    }
}

impl Scope {
    /// The value of a declared function at these arguments.
    ///
    /// # Errors
    /// The wrong number of arguments, a function that calls itself, and those of its body.
    pub(super) fn call_declared(
        &mut self,
        pool: &mut Pool<Symbol>,
        name: &Ident,
        called: Called,
        (values, spans): (Vec<Value>, Vec<Span>),
    ) -> Result<Value> {
        let arity = |arguments: Vec<String>| {
            let (name, given) = (name.to_string(), values.len());
            let wrong = arguments.len() != given;
            if wrong { Err(Message::Function(FunctionMistake::Arity { name, arguments, given })) } else { Ok(()) }
        };
        match called {
            Called::Language(function) => {
                arity(function.arguments.iter().map(Ident::to_string).collect())
                    .map_err(|message| error(name.span(), &message))?;
                let Body::Expression(body) = &function.body else {
                    return Err(error(
                        name.span(),
                        &Message::Function(FunctionMistake::Recursive { name: name.to_string() }),
                    ));
                };
                self.body_value(pool, name, (&function.arguments, values), body)
            }
            Called::Opaque { function, arguments, parameters } => {
                arity(arguments).map_err(|message| error(name.span(), &message))?;
                let numbers = values.into_iter().zip(spans).map(|(value, span)| value.number(span));
                let mut numbers = numbers.collect::<Result<Vec<Expr>>>()?;
                numbers.extend(parameters);
                Ok(Value::Number(pool.opaque(function, numbers)))
            }
        }
    }

    /// The value of a body with these arguments. Indices of ranges around the call, and arguments of the calling
    /// function, have no meaning in it.
    fn body_value(
        &mut self,
        pool: &mut Pool<Symbol>,
        name: &Ident,
        (arguments, values): (&[Ident], Vec<Value>),
        body: &Expression,
    ) -> Result<Value> {
        pool.spend(CALL);
        let hidden = self.enter(name).ok_or_else(|| {
            error(name.span(), &Message::Function(FunctionMistake::Recursive { name: name.to_string() }))
        })?;
        let arguments = arguments.iter().zip(values);
        let bound = self.bind(arguments.map(|(name, value)| (name.to_string(), lets::meaning(&value))).collect());
        let value = self.deepen(1, name.span()).and_then(|()| {
            let value = self.value(pool, body);
            self.rise(1);
            value
        });
        self.unbind(bound);
        self.leave(hidden);
        value
    }
}
