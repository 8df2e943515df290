//! The named parts: `let` lines.
//!
//! In: the lines in order. Out: their meanings. An array may be defined in pieces, each entry after those before it, so
//! that an entry can use earlier ones:
//!
//! ```text
//! let x[0] = …; let x[i in 1..N] = x[i - 1] + …;
//! ```

use super::array::{Array, Entry};
use super::closed::LetArray;
use super::context::Context;
use super::scope::{Growing, Meaning, Scope};
use super::value::{Value, index_text};
use crate::messages::bracketed;
use crate::symbol::{LetEntry, Symbol};
use crate::syntax::{Definition, Indices};
use proc_macro2::Span;
use std::collections::BTreeSet;
use syn::Result;
use vi_expr::Pool;

/// Work of storing one entry.
const ENTRY: usize = 8;

impl Scope {
    /// The value of the next entry of an array: symbols, if its entries stay symbols.
    fn kept(&mut self, pool: &mut Pool<Symbol>, name: &str, value: Value) -> Value {
        let arrays = self.kept.iter_mut().flat_map(|arrays| arrays.iter_mut().enumerate());
        let Some((array, of)) = arrays.filter(|(_, array)| array.name == name).last() else { return value };
        of.width = value.entries().len();
        value.map(|definition| {
            of.definitions.push(definition);
            pool.symbol(Symbol::Let(LetEntry { array, entry: of.definitions.len() - 1 }))
        })
    }
}

/// Declares the names of these lines; reports wrong ones.
pub(super) fn lets(context: &mut Context, lets: &[Definition]) {
    let mut arrays = BTreeSet::new();
    for named in lets {
        let name = named.name.to_string();
        if named.indices.is_empty() {
            let meaning = match context.shaped(&named.value) {
                None => Meaning::Wrong,
                Some(value) => meaning(&value),
            };
            context.declare(&named.name, meaning);
        } else if !arrays.contains(&name) {
            let declared = context.scope.declare(&named.name, Meaning::Array(Array::default()));
            if context.report(declared).is_some() {
                arrays.insert(name.clone());
                if let Some(kept) = &mut context.scope.kept {
                    kept.push(LetArray { name: name.clone(), width: 1, definitions: Vec::new() });
                }
            }
        }
        if arrays.contains(&name) && !named.indices.is_empty() && context.scope.array_mut(&name).is_some() {
            let Context { scope, pool, .. } = context;
            scope.grow(Some(Growing { name: name.clone(), entry: written(named), at: Vec::new() }));
            let defined = entries(scope, pool, named, &named.indices, &mut Vec::new());
            scope.grow(None);
            if context.report(defined).is_none() {
                context.scope.set(&name, Meaning::Wrong);
            }
        }
    }
}

/// The meaning of a name with this value.
pub(super) fn meaning(value: &Value) -> Meaning {
    match (value, Entry::of(value)) {
        (Value::Wrong(_), _) => Meaning::Wrong,
        (_, Entry::Number(number)) => Meaning::Number(number),
        (_, Entry::Array(array)) => Meaning::Array(array),
    }
}

/// Defines the entries of a line at these first indices.
fn entries(
    scope: &mut Scope,
    pool: &mut Pool<Symbol>,
    named: &Definition,
    levels: &[Indices],
    path: &mut Vec<(i64, Span)>,
) -> Result<()> {
    let name = named.name.to_string();
    let Some((level, inner)) = levels.split_first() else {
        scope.grow_at(path.iter().map(|(index, _)| *index).collect());
        let value = scope.value(pool, &named.value)?;
        let value = scope.kept(pool, &name, value);
        pool.spend(ENTRY);
        return scope.array_mut(&name).map_or(Ok(()), |array| array.define(&name, path, &value));
    };
    let first = match level {
        Indices::One(index) => index,
        Indices::Range(range) => &range.from,
    };
    let at = scope.integer(pool, first)?;
    match scope.array_mut(&name) {
        Some(array) if path.is_empty() && array.entries.is_empty() => array.first = at,
        Some(array) => array.open(&name, path, at)?,
        None => {}
    }
    match level {
        Indices::One(_) => {
            path.push((at, first.span));
            entries(scope, pool, named, inner, path)?;
            path.pop();
        }
        Indices::Range(range) => {
            scope.each(pool, range, &mut |scope, pool, at| {
                path.push((at, range.from.span));
                entries(scope, pool, named, inner, path)?;
                path.pop();
                Ok(())
            })?;
        }
    }
    Ok(())
}

/// The defined entry as it is written: `x[i]`.
fn written(named: &Definition) -> String {
    let index = |level: &Indices| match level {
        Indices::One(index) => index_text(index),
        Indices::Range(range) => range.index.to_string(),
    };
    named.name.to_string() + &bracketed(named.indices.iter().map(index))
}
