//! Sums over the coordinates in a long body, such as the kinetic energy.
//!
//! In: operations outside families. Out: chains that add or subtract successive members of a family, each as one fold:
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

/// Minimum number of members in a fold.
const LEAST: usize = 4;

/// A sum over members of a family.
pub(super) struct Fold {
    /// The initial value, to which the first member is added.
    pub(super) start: OperationId,
    pub(super) family: usize,
    places: Range<usize>,
    subtracts: bool,
    /// The partial sums.
    inner: Vec<OperationId>,
}

/// The text of a fold without its initial value.
pub(super) struct FoldText {
    places: TokenStream,
    step: TokenStream,
}

impl Fold {
    /// The text of the fold, given the text of a member.
    pub(super) fn text(&self, counter: &Ident, term: &Formula) -> FoldText {
        let [first, behind] = [self.places.start, self.places.end].map(Literal::usize_unsuffixed);
        let (term, sign) = (term.tokens(), if self.subtracts { quote!(-) } else { quote!(+) });
        FoldText { places: quote!((#first..#behind)), step: quote!(|sum, #counter| sum #sign #term) }
    }
}

impl FoldText {
    /// The fold with this initial value.
    pub(super) fn from(&self, start: &Formula) -> Formula {
        let (Self { places, step }, start) = (self, start.tokens());
        Formula::atom(quote!(#places.fold(#start, #step)), 1)
    }
}

/// The folds among operations outside families, keyed by their last operation, and the remaining operations.
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
