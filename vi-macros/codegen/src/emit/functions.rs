//! Rust functions and tables: their items, and the calls that evaluate them with derivatives.
//!
//! In: the functions of a model, and calls among the operations. Out: an item `NAME_function` for each, and for calls of
//! one function at the same arguments one statement that binds all needed derivatives:
//!
//! ```text
//! let (s1, [s2]) = ::vi_core::function::Jets::jet_1(&drag_function, [x_dot_mid]);
//! ```

use super::formula::{Formula, item_name, jet, number, slots};
use crate::model::{self, FunctionKind, Model, Table, TableKind, Values};
use crate::program::{Function, Operation, OperationId};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{format_ident, quote, quote_spanned};
use std::collections::BTreeMap;
use syn::spanned::Spanned;
use vi_expr::Opaque;

/// The items of all functions of a system.
pub(super) fn items(model: &Model) -> TokenStream {
    model.functions.iter().map(item).collect()
}

fn item(function: &model::Function) -> TokenStream {
    let name = item_name(&function.name.to_string());
    match &function.kind {
        FunctionKind::Rust(path) => {
            let count = Literal::usize_unsuffixed(function.arguments.len());
            let arguments: Vec<Ident> = function.arguments.iter().map(|argument| format_ident!("{argument}")).collect();
            let documentation = format!(" The Rust function `{}`.", function.name);
            // A wrong signature is reported at the path.
            let call = quote_spanned!(path.span()=> #path(#(#arguments),*));
            let source = format_ident!("{}_source", function.name);
            quote! {
                #[allow(non_camel_case_types)]
                struct #source;

                impl ::vi_core::function::Function<#count> for #source {
                    #[inline(always)]
                    fn value<AnyNumber: ::vi_core::real::Number>(
                        &self,
                        [#(#arguments),*]: [AnyNumber; #count],
                    ) -> AnyNumber {
                        #call
                    }
                }

                #[doc = #documentation]
                #[allow(non_upper_case_globals)]
                static #name: ::vi_core::function::Differentiated<#source> =
                    ::vi_core::function::Differentiated(#source);
            }
        }
        FunctionKind::Table(table) => {
            let documentation = format!(" The table `{}`.", function.name);
            let (kind, value) = table_value(table);
            let rebuilt = table.file.as_ref().map(|file| {
                let path = file.to_string_lossy().into_owned();
                // Cargo builds again when the file changes.
                quote!(
                    const _: &[::core::primitive::u8] = ::core::include_bytes!(#path);
                )
            });
            quote! {
                #[doc = #documentation]
                #[allow(non_upper_case_globals)]
                static #name: #kind = #value;
                #rebuilt
            }
        }
    }
}

/// The type and the value of a table.
fn table_value(table: &Table) -> (TokenStream, TokenStream) {
    let kind = format_ident!("{}", table.kind.name());
    let outside = table.outside.name().map(|word| {
        let word = format_ident!("{word}");
        quote!(.#word())
    });
    let list = |numbers: &[f64]| {
        let numbers = numbers.iter().map(|value| number(*value));
        quote!([#(#numbers),*])
    };
    let coefficients = Literal::usize_unsuffixed(match table.kind {
        TableKind::Linear => 2,
        TableKind::Cubic | TableKind::Monotone => 4,
        TableKind::Quintic => 6,
    });
    let (item, counts, values) = match &table.values {
        Values::Points { places, values } => {
            let count = Literal::usize_unsuffixed(places.len());
            let (places, values) = (list(places), list(values));
            (quote!(Table), quote!(#count, #coefficients), quote!(#places, #values))
        }
        Values::Grid { places: [first, second], rows } => {
            let [m, n] = [first, second].map(|axis| Literal::usize_unsuffixed(axis.len()));
            let (first, second) = (list(first), list(second));
            let rows = rows.iter().map(|row| list(row));
            (quote!(Grid), quote!(#m, #n), quote!(#first, #second, [#(#rows),*]))
        }
        Values::Parameters { ends: [from, to], count, .. } => {
            let (count, from, to) = (Literal::usize_unsuffixed(*count), number(*from), number(*to));
            (quote!(Uniform), quote!(#count), quote!(#from, #to))
        }
    };
    (quote!(::vi_core::table::#item<#counts>), quote!(::vi_core::table::#item::#kind(#values)#outside))
}

/// The calls of one function at the same arguments.
#[derive(Default)]
pub(super) struct Calls {
    /// The needed derivatives of each group.
    groups: Vec<Vec<OperationId>>,
    of: BTreeMap<OperationId, usize>,
}

impl Calls {
    /// The calls of a function that needs these operations.
    pub(super) fn of(function: &Function, needed: &[OperationId]) -> Self {
        let mut calls = Self::default();
        let mut known = BTreeMap::new();
        for id in needed {
            let Operation::Opaque(called, arguments) = function.operations.get(*id) else { continue };
            let group = *known.entry((called.name.clone(), arguments.clone())).or_insert(calls.groups.len());
            calls.groups.resize_with(calls.groups.len().max(group + 1), Vec::new);
            calls.groups[group].push(*id);
            calls.of.insert(*id, group);
        }
        calls
    }

    /// The derivatives that are computed together with this one; empty if it is alone.
    pub(super) fn with(&self, id: OperationId) -> &[OperationId] {
        let group = self.of.get(&id).map_or(&[][..], |group| &self.groups[*group]);
        if group.len() > 1 { group } else { &[] }
    }
}

/// The statement that binds these derivatives to their names.
pub(super) fn statement(bound: &[(Opaque, Ident)], arguments: &[Formula]) -> Option<TokenStream> {
    let (first, _) = bound.first()?;
    let order = bound.iter().map(|(function, _)| function.order()).max()?;
    let named = |slots: &[usize]| {
        let name = bound.iter().find(|(function, _)| self::slots(function) == slots).map(|(_, name)| name);
        name.map_or_else(|| quote!(_), |name| quote!(#name))
    };
    let levels = (0..=order).map(|order| pattern(first.arity, order, &mut Vec::new(), &named));
    let call = jet(first, order, arguments);
    Some(quote!(let (#(#levels),*) = #call;))
}

/// The pattern of all derivatives of one order; equal mixed derivatives are bound once.
fn pattern(arity: usize, order: usize, slots: &mut Vec<usize>, named: &dyn Fn(&[usize]) -> TokenStream) -> TokenStream {
    if order == 0 {
        return named(slots);
    }
    let entries: Vec<TokenStream> = (0..arity)
        .map(|slot| {
            slots.push(slot);
            let entry = pattern(arity, order - 1, slots, named);
            slots.pop();
            entry
        })
        .collect();
    if entries.iter().all(|entry| entry.to_string() == "_") { quote!(_) } else { quote!([#(#entries),*]) }
}
