//! A long body as loops over the coordinates.
//!
//! In: a function and its [`Families`]. Out: statements in which a family is an array,
//!
//! ```text
//! let mut s4 = [real(0.0); 63];
//! for i in 0..63 { s4[i] = q_mid[i + 1] - q_mid[i]; }
//! let mut s5 = [real(0.0); 63];
//! for i in 0..63 { s5[i] = (s1 + s2 * s4[i]) * s4[i]; }
//! ```
//!
//! or is written inside the formula of the family that reads it. The order is: common operations, arrays, then the
//! remaining ones (ends of a chain, sums over it). Operations and results stay the same, bit by bit, except that a
//! short operation is recomputed instead of stored.

use super::folds::{Fold, FoldText, folds};
use super::formula::{Formula, LINE, index};
use super::names::Names;
use crate::program::{Families, Function, Membership, Operation, OperationId};
use crate::symbol::Symbol;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::quote;
use std::collections::{BTreeMap, BTreeSet};
use vi_expr::{Function as Elementary, Table};

/// Maximum number of operations that are recomputed instead of stored.
const AGAIN: usize = 1;

/// The families of a function that become arrays.
pub(super) struct Loops<'a> {
    function: &'a Function,
    families: Families,
    /// Operations outside families, operands before results.
    singles: Vec<OperationId>,
    /// Families read by an operation outside families.
    outside: BTreeSet<usize>,
    /// The number of families that read each family.
    uses: Vec<usize>,
    /// Folds over members of families, keyed by their last operation.
    folds: BTreeMap<OperationId, Fold>,
}

/// Context for printing loops.
pub(super) struct LoopContext<'a, 'n> {
    /// Names of the input vectors, keyed by component 0.
    pub(super) vectors: &'a BTreeMap<Symbol, Ident>,
    /// Formulas of operations outside families.
    pub(super) singles: &'a Table<OperationId, Formula>,
    pub(super) names: &'a mut Names<'n>,
}

/// The printed loops: their statements, and the positions of members read elsewhere.
pub(super) struct PrintedLoops {
    pub(super) statements: TokenStream,
    pub(super) members: BTreeMap<OperationId, Member>,
    /// Folds over members, keyed by their last operation: the initial value, and the text without it.
    pub(super) folds: BTreeMap<OperationId, (OperationId, FoldText)>,
}

impl<'a> Loops<'a> {
    /// The loops of a function that needs these operations; `None` if more than `limit` operations remain outside.
    pub(super) fn of(function: &'a Function, needed: &[OperationId], limit: usize) -> Option<Self> {
        let families = function.families();
        let singles = needed.iter().copied().filter(|id| families.of(*id).is_none()).collect();
        let (folds, singles) = folds(function, &families, singles);
        let work = |id: &&OperationId| function.operations.get(**id).is_work();
        let written = singles.iter().filter(work).count() + families.members.len();
        if families.members.is_empty() || written > limit {
            return None;
        }
        let operands = |id: OperationId| function.operations.get(id).operands();
        let started = folds.values().map(|fold| fold.start);
        let read = singles.iter().flat_map(|id| operands(*id)).chain(function.results.entries().copied());
        let outside = read.chain(started).filter_map(|id| families.of(id)).map(|of| of.family).collect();
        let mut uses = vec![0; families.members.len()];
        for of in families.members.iter().flat_map(|members| operands(members[0])).filter_map(|id| families.of(id)) {
            uses[of.family] += 1;
        }
        Some(Self { function, families, singles, outside, uses, folds })
    }

    /// Operations outside families: those independent of all families, and the others.
    pub(super) fn singles(&self) -> (Vec<OperationId>, Vec<OperationId>) {
        let mut late = BTreeSet::new();
        for id in &self.singles {
            let waits = |operand: OperationId| late.contains(&operand) || self.families.of(operand).is_some();
            if self.function.operations.get(*id).operands().any(waits) {
                late.insert(*id);
            }
        }
        self.singles.iter().copied().partition(|id| !late.contains(id))
    }

    /// The number of lines that read each operation outside families. A loop counts twice, so that its operands get
    /// names.
    pub(super) fn uses(&self) -> Table<OperationId, usize> {
        let mut uses = Table::default();
        let operands = |id: &OperationId| self.function.operations.get(*id).operands();
        let started = self.folds.values().map(|fold| fold.start);
        let once = self.singles.iter().flat_map(operands).chain(self.function.results.entries().copied());
        let once = once.chain(started);
        let twice = self.families.members.iter().flat_map(|members| operands(&members[0]));
        for (id, count) in once.map(|id| (id, 1)).chain(twice.map(|id| (id, 2))) {
            *uses.entry(id) += count;
        }
        uses
    }

    /// Prints the loops.
    pub(super) fn write(&self, writing: LoopContext) -> PrintedLoops {
        let counter = writing.names.counter();
        let mut lines = Lines { loops: self, writing, counter, arrays: BTreeMap::new() };
        let statements = (0..self.families.members.len()).map(|family| lines.line(family)).collect();
        let (arrays, counter) = (&lines.arrays, &lines.counter);
        let member = |(family, array): (&usize, &Array)| {
            let member = |place| Member { array: array.clone(), place, counter: counter.clone() };
            let members = self.families.members[*family].iter().zip(0_usize..);
            members.map(|(id, place)| (*id, member(place))).collect::<Vec<_>>()
        };
        let fold = |(id, fold): (&OperationId, &Fold)| {
            let term = arrays.get(&fold.family)?.entry(Some(counter), 0);
            Some((*id, (fold.start, fold.text(counter, &term))))
        };
        let folds = self.folds.iter().filter_map(fold).collect();
        PrintedLoops { statements, members: arrays.iter().flat_map(member).collect(), folds }
    }

    /// The family of the cosines for a family of sines, and vice versa.
    fn partner(&self, operation: &Operation) -> Option<usize> {
        let other = match operation {
            Operation::Call(Elementary::Sin, angle) => Operation::Call(Elementary::Cos, *angle),
            Operation::Call(Elementary::Cos, angle) => Operation::Call(Elementary::Sin, *angle),
            _ => return None,
        };
        let Membership { family, place } = self.families.of(self.function.operations.find(&other)?)?;
        (place == 0).then_some(family)
    }
}

/// The position of a member of a family.
#[derive(Clone)]
pub(super) struct Member {
    pub(super) array: Array,
    pub(super) place: usize,
    /// The counter of the loop over the array.
    pub(super) counter: Ident,
}

/// An array, or one component of an array of pairs.
#[derive(Clone, PartialEq, Eq)]
pub(super) struct Array {
    name: Ident,
    part: Option<usize>,
}

impl Array {
    /// The entry at counter + place; without a counter, at place.
    pub(super) fn entry(&self, counter: Option<&Ident>, place: usize) -> Formula {
        let (name, index) = (&self.name, index(counter, place));
        let part = self.part.map(Literal::usize_unsuffixed).into_iter();
        Formula::atom(quote!(#name #index #(.#part)*), 0)
    }
}

/// The lines of the loops.
struct Lines<'a, 'n> {
    loops: &'a Loops<'a>,
    writing: LoopContext<'a, 'n>,
    counter: Ident,
    arrays: BTreeMap<usize, Array>,
}

impl Lines<'_, '_> {
    /// The line of a family; empty if it was printed before or is inlined.
    fn line(&mut self, family: usize) -> TokenStream {
        let loops = self.loops;
        let (members, counter) = (&loops.families.members[family], self.counter.clone());
        let operation = loops.function.operations.get(members[0]);
        if self.arrays.contains_key(&family) {
            return TokenStream::new();
        }
        if let (Some(partner), Operation::Call(function, angle)) = (loops.partner(operation), operation) {
            let (name, receiver) = (self.writing.names.next_shared(), self.operand(*angle, 0).receiver());
            let (own, other) = if *function == Elementary::Sin { (0, 1) } else { (1, 0) };
            // Sine and cosine families of the same angles may have different lengths.
            let length = Literal::usize_unsuffixed(members.len().max(loops.families.members[partner].len()));
            for (family, part) in [(family, own), (partner, other)] {
                self.arrays.insert(family, Array { name: name.clone(), part: Some(part) });
            }
            return quote! {
                let mut #name = [(real(0.0), real(0.0)); #length];
                for #counter in 0..#length { #name[#counter] = #receiver.sin_cos(); }
            };
        }
        let symbol = loops.function.operations.name(members[0]).and_then(Symbol::component);
        let formula = self.formula(family, 0);
        if symbol.is_none() && self.is_inside(family, formula.operations) {
            return TokenStream::new();
        }
        let names = &mut *self.writing.names;
        let name = if let Some((vector, _)) = symbol { names.vector(&vector) } else { names.next_shared() };
        let (tokens, length) = (formula.tokens(), Literal::usize_unsuffixed(members.len()));
        // `from_fn` would call a long closure for each entry.
        let line = quote! {
            let mut #name = [real(0.0); #length];
            for #counter in 0..#length { #name[#counter] = #tokens; }
        };
        self.arrays.insert(family, Array { name, part: None });
        line
    }

    /// Whether a family with such a formula is inlined at its uses.
    fn is_inside(&self, family: usize, operations: usize) -> bool {
        let alone = self.loops.uses[family] == 1 && operations <= LINE;
        !self.loops.outside.contains(&family) && (alone || operations <= AGAIN)
    }

    /// The formula of a family at the counter plus `place`.
    fn formula(&self, family: usize, place: usize) -> Formula {
        let operation = self.loops.function.operations.get(self.loops.families.members[family][0]);
        Formula::of(operation, &mut |operand| self.operand(operand, place))
    }

    /// An operand of the first member of a family, advanced by `on` places.
    fn operand(&self, id: OperationId, on: usize) -> Formula {
        let counter = Some(&self.counter);
        if let Operation::Input(symbol) = self.loops.function.operations.get(id)
            && let Some((vector, place)) = symbol.component()
            && let Some(name) = self.writing.vectors.get(&vector)
        {
            return Array { name: name.clone(), part: None }.entry(counter, place + on);
        }
        if let Some(Membership { family, place }) = self.loops.families.of(id) {
            let inside = || self.formula(family, place + on);
            return self.arrays.get(&family).map_or_else(inside, |array| array.entry(counter, place + on));
        }
        // An operation outside families has been printed already; the fallback prints the same formula.
        let operation = self.loops.function.operations.get(id);
        let again = || Formula::of(operation, &mut |operand| self.operand(operand, on));
        self.writing.singles.get(id).cloned().unwrap_or_else(again)
    }
}
