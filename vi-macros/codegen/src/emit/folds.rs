//! Sums over the coordinates: kinetic energy, in a long body.
//!
//! In: operations in no family. Out: those that add, or subtract, one member of a family after the other, as one,
//!
//! ```text
//! (1..64).fold(s7, |sum, i| sum + s4[i])
//! ```

use super::formula::Formula;
use crate::program::{Families, Function, Operation, OperationId};
use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;

/// Members from which on a sum is one.
const LEAST: usize = 4;

/// A sum over members of a family.
pub(super) struct Fold {
    /// What the first of them is added to.
    pub(super) start: OperationId,
    pub(super) family: usize,
    places: Range<usize>,
    subtracts: bool,
    /// The sums before the last.
    inner: Vec<OperationId>,
}

/// The text of a sum but for what it starts from.
pub(super) struct FoldText {
    places: TokenStream,
    step: TokenStream,
}

impl Fold {
    /// Its text, with what its members are written as.
    pub(super) fn text(&self, counter: &Ident, term: &Formula) -> FoldText {
        let [first, behind] = [self.places.start, self.places.end].map(Literal::usize_unsuffixed);
        let (term, sign) = (term.tokens(), if self.subtracts { quote!(-) } else { quote!(+) });
        FoldText { places: quote!((#first..#behind)), step: quote!(|sum, #counter| sum #sign #term) }
    }
}

impl FoldText {
    /// The sum that starts from this.
    pub(super) fn from(&self, start: &Formula) -> Formula {
        let (Self { places, step }, start) = (self, start.tokens());
        Formula::atom(quote!(#places.fold(#start, #step)), 1)
    }
}

/// The sums among operations in no family, by their last ones, and the operations that are in none.
pub(super) fn folds(
    function: &Function,
    families: &Families,
    singles: Vec<OperationId>,
) -> (BTreeMap<OperationId, Fold>, Vec<OperationId>) {
    let uses = function.uses();
    let mut folds: BTreeMap<OperationId, Fold> = BTreeMap::new();
    for id in &singles {
        let (before, term, subtracts) = match function.operations.get(*id) {
            Operation::Add(before, term) => (*before, *term, false),
            Operation::Subtract(before, term) => (*before, *term, true),
            _ => continue,
        };
        let Some(of) = families.of(term) else { continue };
        let goes_on = |fold: &Fold| (fold.family, fold.places.end, fold.subtracts) == (of.family, of.place, subtracts);
        let fold = if uses.get(before) == Some(&1) && folds.get(&before).is_some_and(goes_on) {
            folds.remove(&before).map(|mut fold| {
                fold.places.end += 1;
                fold.inner.push(before);
                fold
            })
        } else {
            None
        };
        let (family, places) = (of.family, of.place..of.place + 1);
        let alone = Fold { start: before, family, places, subtracts, inner: Vec::new() };
        folds.insert(*id, fold.unwrap_or(alone));
    }
    folds.retain(|_, fold| fold.places.len() >= LEAST);
    let inner: BTreeSet<OperationId> = folds.values().flat_map(|fold| &fold.inner).copied().collect();
    (folds, singles.into_iter().filter(|id| !inner.contains(id)).collect())
}
