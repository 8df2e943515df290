//! Entries of vectors and matrices, printed as arrays.
//!
//! In: rows of results, each formatted as one expression. Out: `[a, b, c]`, or a loop if rows are consecutive entries
//! of the arrays of a long body:
//!
//! ```text
//! {
//!     let mut entries = [T::real(0.0); 64];
//!     entries[0] = s12[0] - s18;
//!     for i in 0..62 { entries[i + 1] = s13[i]; }
//!     entries[63] = s12[63] - s19;
//!     entries
//! }
//! ```

use super::formula::{Formula, index, zero};
use super::loops::Member;
use crate::program::OperationId;
use proc_macro2::{Ident, Literal, TokenStream};
use quote::{ToTokens, quote};
use std::ops::Range;

/// Minimum number of rows in a loop.
pub(super) const LEAST: usize = 8;

/// One result.
pub(super) struct ResultEntry {
    pub(super) id: OperationId,
    pub(super) formula: Formula,
    /// Its position in the array of a loop.
    pub(super) member: Option<Member>,
    /// The entry is identically zero.
    pub(super) zero: bool,
}

impl ResultEntry {
    /// The loop counter for the arrays that contain such results.
    pub(super) fn counter(&self) -> Option<&Ident> {
        self.member.as_ref().map(|member| &member.counter)
    }

    /// Whether both are the same result.
    pub(super) fn is(&self, other: &Self) -> bool {
        self.id == other.id
    }

    /// Whether this is the next entry of the same array.
    pub(super) fn follows(&self, before: &Self) -> bool {
        let members = self.member.as_ref().zip(before.member.as_ref());
        members.is_some_and(|(this, before)| this.array == before.array && this.place == before.place + 1)
    }

    /// Its formula; with a counter, the formula of the entry at the counter plus its position.
    pub(super) fn formula(&self, counter: Option<&Ident>) -> Formula {
        let moved = self.member.as_ref().filter(|_| counter.is_some());
        moved.map_or_else(|| self.formula.clone(), |member| member.array.entry(counter, member.place))
    }
}

impl ToTokens for ResultEntry {
    fn to_tokens(&self, tokens: &mut TokenStream) {
        self.formula.tokens().to_tokens(tokens);
    }
}

/// A part of a row: a result, or zero.
#[derive(Clone, Copy)]
pub(super) struct Part<'a>(Option<&'a ResultEntry>);

impl<'a> From<Option<&'a ResultEntry>> for Part<'a> {
    fn from(entry: Option<&'a ResultEntry>) -> Self {
        Self(entry)
    }
}

impl Part<'_> {
    /// Whether it is the next entry after the same part of the previous row, or the same entry; `None` if neither.
    fn follows(self, above: Self) -> Option<bool> {
        match (self.0, above.0) {
            (Some(this), Some(above)) if this.follows(above) => Some(true),
            (Some(this), Some(above)) => this.is(above).then_some(false),
            (this, above) => (this.is_none() && above.is_none()).then_some(false),
        }
    }

    /// Its tokens; in a loop, those of the first row, indexed by the counter if `moves`.
    fn tokens(self, counter: Option<&Ident>, moves: bool) -> TokenStream {
        self.0.map_or_else(zero, |entry| entry.formula(counter.filter(|_| moves)).tokens().clone())
    }
}

impl ToTokens for Part<'_> {
    fn to_tokens(&self, tokens: &mut TokenStream) {
        tokens.extend(self.tokens(None, false));
    }
}

/// The array of these numbers.
pub(super) fn of<'a>(parts: impl Iterator<Item = Part<'a>>) -> TokenStream {
    let rows: Vec<Vec<Part>> = parts.map(|part| vec![part]).collect();
    array(&rows, &zero(), |parts| quote!(#(#parts)*))
}

/// The array of rows, each formatted from its parts; `zero` is an empty row.
pub(super) fn array(
    rows: &[Vec<Part>],
    zero: &TokenStream,
    form: impl Fn(&[TokenStream]) -> TokenStream,
) -> TokenStream {
    let counter = rows.iter().flatten().find_map(|part| part.0?.counter());
    let runs = if counter.is_some() { runs(rows) } else { Vec::new() };
    let Some(counter) = counter.filter(|_| runs.iter().any(RowBlock::is_loop)) else {
        let rows = rows.iter().map(|row| form(&texts(row)));
        return quote!([#(#rows),*]);
    };
    let assignments = runs.iter().map(|run| {
        if run.is_loop() {
            let (place, length) = (index(Some(counter), run.rows.start), Literal::usize_unsuffixed(run.rows.len()));
            let parts = rows[run.rows.start].iter().zip(&run.moves);
            let row = form(&parts.map(|(part, moves)| part.tokens(Some(counter), *moves)).collect::<Vec<_>>());
            return quote!(for #counter in 0..#length { entries #place = #row; });
        }
        let is_there = |place: &usize| rows[*place].iter().any(|part| part.0.is_some());
        let places = run.rows.clone().filter(is_there).map(|place| (index(None, place), form(&texts(&rows[place]))));
        places.map(|(place, row)| quote!(entries #place = #row;)).collect()
    });
    let (assignments, length) = (assignments.collect::<TokenStream>(), Literal::usize_unsuffixed(rows.len()));
    quote!({ let mut entries = [#zero; #length]; #assignments entries })
}

fn texts(row: &[Part]) -> Vec<TokenStream> {
    row.iter().map(Part::to_token_stream).collect()
}

/// Consecutive rows.
struct RowBlock {
    rows: Range<usize>,
    /// Whether each part advances from row to row.
    moves: Vec<bool>,
}

impl RowBlock {
    fn is_loop(&self) -> bool {
        self.rows.len() >= LEAST
    }
}

/// Splits rows into runs whose parts advance alike.
fn runs(rows: &[Vec<Part>]) -> Vec<RowBlock> {
    let mut runs: Vec<RowBlock> = Vec::new();
    for (place, row) in rows.iter().enumerate() {
        let above = place.checked_sub(1).map(|above| &rows[above]).filter(|above| above.len() == row.len());
        let moves = above.and_then(|above| row.iter().zip(above).map(|(part, above)| part.follows(*above)).collect());
        match (runs.last_mut(), moves) {
            (Some(run), Some(moves)) if run.rows.len() == 1 || run.moves == moves => {
                (run.rows.end, run.moves) = (place + 1, moves);
            }
            _ => runs.push(RowBlock { rows: place..place + 1, moves: Vec::new() }),
        }
    }
    runs
}
