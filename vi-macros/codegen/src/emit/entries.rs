//! Results side by side: the entries of vectors and matrices.
//!
//! In: rows of results, each joined into one expression by a form. Out: `[a, b, c]`; or, where rows follow each other in the
//! arrays of a long body,
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

/// Rows from which on there is a loop.
const LEAST: usize = 8;

/// One result.
pub(super) struct Entry {
    pub(super) id: OperationId,
    pub(super) formula: Formula,
    /// Where it is in an array of a loop.
    pub(super) member: Option<Member>,
    /// It is zero for every input.
    pub(super) zero: bool,
}

impl Entry {
    /// The counter of loops over the arrays that such results are in.
    pub(super) fn counter(&self) -> Option<&Ident> {
        self.member.as_ref().map(|member| &member.counter)
    }

    /// Whether it is the same result.
    pub(super) fn is(&self, other: &Self) -> bool {
        self.id == other.id
    }

    /// Whether it is the entry of an array one place on.
    pub(super) fn moves_on_from(&self, before: &Self) -> bool {
        let members = self.member.as_ref().zip(before.member.as_ref());
        members.is_some_and(|(this, before)| this.array == before.array && this.place == before.place + 1)
    }

    /// Its formula; with a counter, that of the entry so many places on in its array.
    pub(super) fn formula(&self, counter: Option<&Ident>) -> Formula {
        let moved = self.member.as_ref().filter(|_| counter.is_some());
        moved.map_or_else(|| self.formula.clone(), |member| member.array.entry(counter, member.place))
    }
}

impl ToTokens for Entry {
    fn to_tokens(&self, tokens: &mut TokenStream) {
        self.formula.tokens().to_tokens(tokens);
    }
}

/// What a row is made of: a result, or zero.
#[derive(Clone, Copy)]
pub(super) struct Part<'a>(Option<&'a Entry>);

impl<'a> From<Option<&'a Entry>> for Part<'a> {
    fn from(entry: Option<&'a Entry>) -> Self {
        Self(entry)
    }
}

impl Part<'_> {
    /// Whether it stands one place on from the same part of the row above, or is that again; `None` where it is something else.
    fn moves_on_from(self, above: Self) -> Option<bool> {
        match (self.0, above.0) {
            (Some(this), Some(above)) if this.moves_on_from(above) => Some(true),
            (Some(this), Some(above)) => this.is(above).then_some(false),
            (this, above) => (this.is_none() && above.is_none()).then_some(false),
        }
    }

    /// Its text; in a loop with this counter that of the first row, which moves on there or does not.
    fn tokens(self, counter: Option<&Ident>, moves: bool) -> TokenStream {
        self.0.map_or_else(zero, |entry| entry.formula(counter.filter(|_| moves)).tokens().clone())
    }
}

impl ToTokens for Part<'_> {
    fn to_tokens(&self, tokens: &mut TokenStream) {
        tokens.extend(self.tokens(None, false));
    }
}

/// The array of such numbers.
pub(super) fn of<'a>(parts: impl Iterator<Item = Part<'a>>) -> TokenStream {
    let rows: Vec<Vec<Part>> = parts.map(|part| vec![part]).collect();
    array(&rows, &zero(), |parts| quote!(#(#parts)*))
}

/// The array of rows, each joined from its parts by a form; `zero` is a row of nothing.
pub(super) fn array(
    rows: &[Vec<Part>],
    zero: &TokenStream,
    form: impl Fn(&[TokenStream]) -> TokenStream,
) -> TokenStream {
    let counter = rows.iter().flatten().find_map(|part| part.0?.counter());
    let runs = if counter.is_some() { runs(rows) } else { Vec::new() };
    let Some(counter) = counter.filter(|_| runs.iter().any(Run::is_loop)) else {
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

/// Rows that follow each other.
struct Run {
    rows: Range<usize>,
    /// Which of their parts move on from row to row.
    moves: Vec<bool>,
}

impl Run {
    fn is_loop(&self) -> bool {
        self.rows.len() >= LEAST
    }
}

/// Rows, in runs: in each the same parts move on.
fn runs(rows: &[Vec<Part>]) -> Vec<Run> {
    let mut runs: Vec<Run> = Vec::new();
    for (place, row) in rows.iter().enumerate() {
        let above = place.checked_sub(1).map(|above| &rows[above]).filter(|above| above.len() == row.len());
        let moves =
            above.and_then(|above| row.iter().zip(above).map(|(part, above)| part.moves_on_from(*above)).collect());
        match (runs.last_mut(), moves) {
            (Some(run), Some(moves)) if run.rows.len() == 1 || run.moves == moves => {
                (run.rows.end, run.moves) = (place + 1, moves);
            }
            _ => runs.push(Run { rows: place..place + 1, moves: Vec::new() }),
        }
    }
    runs
}
