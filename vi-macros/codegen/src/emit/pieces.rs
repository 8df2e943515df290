//! A long body in pieces.
//!
//! In: the statements of a body, with the values that each binds and reads, and the results. Out: equivalent statements
//! in functions of bounded length. A piece stores values that later pieces or the results read in an array:
//!
//! ```text
//! fn momentum_equation_part_2<T: ::vi_core::real::Real>(system: &Chain<T>, inputs: &[T; 9], values: &mut [T; 4]) {
//!     let h = inputs[0];
//!     let s1 = values[0];
//!     let s5 = h * s1;
//!     values[1] = s5;
//! }
//! ```
//!
//! The compile time of rustc grows faster than the length of a function. Passing values by name, or inlining the
//! pieces, would restore the long function. Operations and results stay the same, bit by bit.

use super::formula::zero;
use super::names::Names;
use crate::program::OperationId;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{ToTokens, quote};
use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use vi_expr::Table;

/// A statement: `let x = a + b;`.
pub(super) struct Statement {
    /// The operations that it binds.
    pub(super) binds: Vec<OperationId>,
    /// The operations that it reads by name.
    pub(super) reads: Vec<OperationId>,
    /// Number of operations in it.
    pub(super) operations: usize,
    /// Its tokens.
    pub(super) tokens: TokenStream,
}

/// Context for printing pieces.
pub(super) struct PieceContext<'a> {
    /// The inputs, vector by vector, and the results, row by row: copies to and from arrays are then fast.
    pub(super) inputs: Vec<OperationId>,
    pub(super) results: Vec<OperationId>,
    /// The system.
    pub(super) system: &'a Ident,
    /// Name of the function that is split.
    pub(super) function: &'a str,
    /// A statement at the start of each piece.
    pub(super) prelude: Option<&'a TokenStream>,
    /// Names of the operations.
    pub(super) named: &'a Table<OperationId, Ident>,
}

/// A body in pieces.
pub(super) struct Pieces {
    /// The functions and the calls to them.
    pub(super) statements: TokenStream,
    /// Expressions for the named results: `values[3]`.
    pub(super) results: BTreeMap<OperationId, TokenStream>,
}

/// Positions of values in an array.
struct Places {
    array: TokenStream,
    of: BTreeMap<OperationId, usize>,
}

impl Places {
    /// Each value once, in this order.
    fn new<'a>(array: TokenStream, ids: impl IntoIterator<Item = &'a OperationId>) -> Self {
        let mut of = BTreeMap::new();
        for id in ids {
            let next = of.len();
            of.entry(*id).or_insert(next);
        }
        Self { array, of }
    }

    fn length(&self) -> Literal {
        Literal::usize_unsuffixed(self.of.len())
    }

    /// `values[3]`, if it is there.
    fn place(&self, id: OperationId) -> Option<TokenStream> {
        let (array, index) = (&self.array, Literal::usize_unsuffixed(*self.of.get(&id)?));
        Some(quote!(#array[#index]))
    }
}

/// Splits the statements into functions of at most `limit` operations with unused names.
pub(super) fn pieces(statements: &[Statement], limit: usize, writing: &PieceContext, names: &mut Names) -> Pieces {
    let cuts = cuts(statements, limit);
    let (inputs, values) = places(statements, writing, &cuts);
    let (system, prelude, name_of) = (writing.system, writing.prelude, |id| writing.named.get(id));
    let (inputs_length, values_length) = (inputs.length(), values.length());
    let (mut functions, mut calls) = (TokenStream::new(), TokenStream::new());
    for (cut, number) in cuts.into_iter().zip(1_usize..) {
        let piece = &statements[cut];
        let binds: BTreeSet<OperationId> = piece.iter().flat_map(|statement| &statement.binds).copied().collect();
        let reads: BTreeSet<OperationId> = piece.iter().flat_map(|statement| &statement.reads).copied().collect();
        let takes = reads.difference(&binds).map(|id| {
            let (name, place) = (name_of(*id), inputs.place(*id).or_else(|| values.place(*id)));
            quote!(let #name = #place;)
        });
        let leaves = binds.iter().filter_map(|id| {
            let (name, place) = (name_of(*id), values.place(*id)?);
            Some(quote!(#place = #name;))
        });
        let tokens = piece.iter().map(|statement| &statement.tokens);
        let operations: usize = piece.iter().map(|statement| statement.operations).sum();
        let documentation = format!(" Part {number} of `{}`: {operations} operations.", writing.function);
        let name = names.piece(writing.function, number);
        functions.extend(quote! {
            #[doc = #documentation]
            #[inline(never)]
            fn #name<T: ::vi_core::real::Real>(
                system: &#system<T>,
                inputs: &[T; #inputs_length],
                values: &mut [T; #values_length],
            ) {
                #prelude
                #(#takes)*
                #(#tokens)*
                #(#leaves)*
            }
        });
        calls.extend(quote!(#name(system, &inputs, &mut values);));
    }
    let given = writing.inputs.iter().map(|id| name_of(*id).map(ToTokens::to_token_stream));
    let zero = zero();
    let statements = quote! {
        #functions
        let system = self;
        let inputs = [#(#given),*];
        let mut values = [#zero; #values_length];
        #calls
    };
    Pieces { statements, results: writing.results.iter().filter_map(|id| Some((*id, values.place(*id)?))).collect() }
}

/// Positions of the inputs, and of the values that leave their piece, results first.
fn places(statements: &[Statement], writing: &PieceContext, cuts: &[Range<usize>]) -> (Places, Places) {
    let mut piece_of = BTreeMap::new();
    for (cut, piece) in cuts.iter().zip(0_usize..) {
        let binds = statements[cut.clone()].iter().flat_map(|statement| &statement.binds);
        piece_of.extend(binds.map(|id| (*id, piece)));
    }
    let mut leaving = BTreeSet::new();
    for (cut, piece) in cuts.iter().zip(0_usize..) {
        let reads = statements[cut.clone()].iter().flat_map(|statement| &statement.reads);
        leaving.extend(reads.filter(|id| piece_of.get(id).is_some_and(|bound| *bound < piece)));
    }
    let results = writing.results.iter().filter(|id| piece_of.contains_key(id)).chain(&leaving);
    (Places::new(quote!(inputs), &writing.inputs), Places::new(quote!(values), results))
}

/// Ranges of at most `limit` operations. Each except the last has at least half as many, and ends where the fewest
/// values are live.
fn cuts(statements: &[Statement], limit: usize) -> Vec<Range<usize>> {
    let live = live(statements);
    let mut cuts = Vec::new();
    let mut left: usize = statements.iter().map(|statement| statement.operations).sum();
    let mut start = 0;
    while left > limit {
        let (mut operations, mut best) = (0, (start + 1, statements[start].operations));
        for end in start + 1..=statements.len() {
            operations += statements[end - 1].operations;
            if operations > limit {
                break;
            }
            // A short piece is chosen only if there is no longer one.
            if 2 * best.1 < limit || live[end] <= live[best.0] {
                best = (end, operations);
            }
        }
        left -= best.1;
        cuts.push(start..best.0);
        start = best.0;
    }
    cuts.push(start..statements.len());
    cuts
}

/// Number of live values before each statement.
fn live(statements: &[Statement]) -> Vec<usize> {
    let (mut bound, mut last) = (BTreeMap::new(), BTreeMap::new());
    for (statement, place) in statements.iter().zip(0_usize..) {
        bound.extend(statement.binds.iter().map(|id| (*id, place)));
        last.extend(statement.reads.iter().map(|id| (*id, place)));
    }
    let (mut begins, mut ends) = (vec![0; statements.len() + 1], vec![0; statements.len() + 1]);
    for (id, place) in bound {
        if let Some(read) = last.get(&id) {
            begins[place + 1] += 1;
            ends[read + 1] += 1;
        }
    }
    let mut count = 0;
    let change = |(begin, end): (usize, usize)| {
        count = count + begin - end;
        count
    };
    begins.into_iter().zip(ends).map(change).collect()
}
