//! Matrices in the form of their zero pattern, as `vi_core::linear` solves them.

use super::entries::{self, Part, ResultEntry, array};
use super::formula::zero;
use crate::findings::{CLOSED, Pattern};
use proc_macro2::{Literal, TokenStream};
use quote::quote;

/// Type and value of the matrix with these rows of results.
pub(super) fn matrix(pattern: &Pattern, symmetric: bool, rows: &[Vec<ResultEntry>]) -> (TokenStream, TokenStream) {
    let size = Literal::usize_unsuffixed(rows.len());
    match pattern {
        Pattern::Diagonal => banded(rows, 0),
        _ if rows.len() <= CLOSED => {
            let entries = rows.iter().flatten();
            let value = quote!(::vi_core::nalgebra::SMatrix::from_row_slice(&[#(#entries),*]));
            (quote!(::vi_core::nalgebra::SMatrix<T, #size, #size>), value)
        }
        Pattern::Tridiagonal => tridiagonal(rows),
        Pattern::Banded(width) => banded(rows, *width),
        Pattern::Blocks(blocks) => in_blocks(rows, blocks),
        Pattern::Sparse(columns) => {
            let width = columns.iter().map(Vec::len).max().unwrap_or(0);
            (sparse_type(rows.len(), width), sparse(rows, columns, width, &all_columns(columns)))
        }
        Pattern::Scalar | Pattern::Dense => dense(rows, symmetric),
    }
}

/// The entry at this row and column; zero outside the matrix.
fn entry(rows: &[Vec<ResultEntry>], row: usize, column: Option<usize>) -> Part<'_> {
    column.and_then(|column| rows.get(row)?.get(column)).into()
}

fn tridiagonal(rows: &[Vec<ResultEntry>]) -> (TokenStream, TokenStream) {
    let size = Literal::usize_unsuffixed(rows.len());
    let diagonal =
        |column: &dyn Fn(usize) -> Option<usize>| entries::of((0..rows.len()).map(|row| entry(rows, row, column(row))));
    let [lower, middle, upper] =
        [diagonal(&|row| row.checked_sub(1)), diagonal(&|row| Some(row)), diagonal(&|row| Some(row + 1))];
    (
        quote!(::vi_core::linear::Tridiagonal<#size, T>),
        quote!(::vi_core::linear::Tridiagonal { lower: #lower, diagonal: #middle, upper: #upper }),
    )
}

fn banded(rows: &[Vec<ResultEntry>], width: usize) -> (TokenStream, TokenStream) {
    let places = 2 * width + 1;
    let (size, diagonals) = (Literal::usize_unsuffixed(rows.len()), Literal::usize_unsuffixed(places));
    let band = |row: usize| (0..places).map(|place| entry(rows, row, (row + place).checked_sub(width))).collect();
    let bands: Vec<Vec<Part>> = (0..rows.len()).map(band).collect();
    let empty = zero();
    let bands = array(&bands, &quote!([#empty; #diagonals]), |parts| quote!([#(#parts),*]));
    (quote!(::vi_core::linear::Banded<#size, #diagonals, T>), quote!(::vi_core::linear::Banded { rows: #bands }))
}

fn in_blocks(rows: &[Vec<ResultEntry>], blocks: &[Vec<usize>]) -> (TokenStream, TokenStream) {
    let largest = blocks.iter().map(Vec::len).max().unwrap_or(1);
    let (size, width) = (Literal::usize_unsuffixed(rows.len()), Literal::usize_unsuffixed(largest));
    let block_rows = (0..rows.len()).map(|row| {
        let members = blocks.iter().find(|members| members.contains(&row)).map(Vec::as_slice).unwrap_or_default();
        let entries = (0..largest).map(|place| entry(rows, row, members.get(place).copied()));
        quote!([#(#entries),*])
    });
    let members = blocks.iter().map(|members| literals(members));
    (
        quote!(::vi_core::linear::Blocks<#size, #width, T>),
        quote!(::vi_core::linear::Blocks { members: &[#(#members),*], rows: [#(#block_rows),*] }),
    )
}

/// The type of rows with at most `width` entries each.
pub(super) fn sparse_type(count: usize, width: usize) -> TokenStream {
    let (count, width) = (Literal::usize_unsuffixed(count), Literal::usize_unsuffixed(width));
    quote!(::vi_core::linear::Sparse<#count, #width, T>)
}

/// Rows by their entries in these columns, which `named` refers to.
pub(super) fn sparse(
    rows: &[Vec<ResultEntry>],
    columns: &[Vec<usize>],
    width: usize,
    named: &TokenStream,
) -> TokenStream {
    let place = |row: usize, place: usize| entry(rows, row, columns.get(row).and_then(|of| of.get(place)).copied());
    let parts: Vec<Vec<Part>> = (0..rows.len()).map(|row| (0..width).map(|at| place(row, at)).collect()).collect();
    let (empty, places) = (zero(), Literal::usize_unsuffixed(width));
    let values = array(&parts, &quote!([#empty; #places]), |parts| quote!([#(#parts),*]));
    quote!(::vi_core::linear::Sparse { columns: #named, rows: #values })
}

/// A reference to the columns of each row.
pub(super) fn all_columns(columns: &[Vec<usize>]) -> TokenStream {
    let columns = columns.iter().map(|columns| literals(columns));
    quote!(&[#(#columns),*])
}

/// A reference to these numbers.
pub(super) fn literals(numbers: &[usize]) -> TokenStream {
    let numbers = numbers.iter().map(|number| Literal::usize_unsuffixed(*number));
    quote!(&[#(#numbers),*])
}

/// Omits entries that are identically zero.
fn dense(rows: &[Vec<ResultEntry>], symmetric: bool) -> (TokenStream, TokenStream) {
    let size = Literal::usize_unsuffixed(rows.len());
    let assignments = rows.iter().zip(0_usize..).flat_map(|(row, i)| {
        row.iter().zip(0_usize..).filter(|(entry, _)| !entry.zero).map(move |(entry, j)| {
            let (i, j) = (Literal::usize_unsuffixed(i), Literal::usize_unsuffixed(j));
            quote!(entries[(#i, #j)] = #entry;)
        })
    });
    let value = quote!({
        let mut entries = ::vi_core::nalgebra::SMatrix::zeros();
        #(#assignments)*
        entries
    });
    if symmetric {
        (quote!(::vi_core::linear::Symmetric<#size, T>), quote!(::vi_core::linear::Symmetric(#value)))
    } else {
        (quote!(::vi_core::nalgebra::SMatrix<T, #size, #size>), value)
    }
}
