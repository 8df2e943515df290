//! A number that the rows of a loop read, by the user's names and the counters of the loop.
//!
//! In: a column of a [`Nest`](crate::indexed::Nest). Out: `q[i + 1]`, or `x[i][2]` in an array of arrays, in both
//! notations. Rows that run through several arrays of coordinates have no such name: coordinate k is `q_k` there.

use super::name::Name;
use crate::indexed::{Affine, Read};
use crate::model::Model;

/// The counters of the outer and of the inner loop.
pub(super) const COUNTERS: [&str; 2] = ["i", "j"];

/// A name in plain text and in LaTeX.
#[derive(Clone)]
pub(super) struct Both {
    pub(super) text: String,
    pub(super) latex: String,
}

/// An affine expression of the counters: `2*i - j + 1`; `times` is the sign of multiplication.
pub(super) fn affine(of: Affine, times: &str) -> String {
    let mut parts: Vec<(i64, String)> = Vec::new();
    for (by, counter) in of.by.into_iter().zip(COUNTERS) {
        let factor = if by.abs() == 1 { String::new() } else { format!("{}{times}", by.abs()) };
        parts.extend((by != 0).then(|| (by, factor + counter)));
    }
    if of.constant != 0 || parts.is_empty() {
        parts.push((of.constant, of.constant.abs().to_string()));
    }
    // A positive term comes first.
    parts.sort_by_key(|(sign, _)| *sign < 0);
    let mut text = String::new();
    for (place, (sign, part)) in parts.iter().enumerate() {
        text.push_str(match (place, *sign < 0) {
            (0, false) => "",
            (0, true) => "-",
            (_, false) => " + ",
            (_, true) => " - ",
        });
        text.push_str(part);
    }
    text
}

/// The values of the counters in a loop.
pub(super) fn counters(outer: i64, inner: Affine) -> Vec<[i64; 2]> {
    (0..outer).flat_map(|i| (0..inner.at([i, 0])).map(move |j| [i, j])).collect()
}

/// A number that the rows read: `column` is its place in its array, at these values of the counters.
pub(super) fn read(model: &Model, read: Read, column: Affine, counters: &[[i64; 2]]) -> Both {
    if read == Read::Number {
        let is_sum = affine(column, "*").contains(' ');
        let whole = |text: String| if is_sum { format!("({text})") } else { text };
        return Both { text: whole(affine(column, "*")), latex: whole(affine(column, " ")) };
    }
    let is_rate = read.is_rate();
    let accented = |name: Name| if is_rate { name.under("dot") } else { name };
    let rate = |text: String| if is_rate { format!("dot({text})") } else { text };
    let Some((name, indices)) = array(model, read, column, counters) else {
        // Parts count from 1, as the terms of L.
        let column = Affine { constant: column.constant + i64::from(read == Read::Part), ..column };
        let index = affine(column, "*");
        let index = if index.contains([' ', '*']) { format!("({index})") } else { index };
        let letter = match read {
            Read::Constraint => "c",
            Read::Part => "g",
            Read::Let(array) | Read::LetRate(array) => &model.lets[array].name,
            _ => "q",
        };
        let latex = accented(Name::of(letter)).with(affine(column, " ")).text();
        return Both { text: rate(format!("{letter}_{index}")), latex };
    };
    let text = indices.iter().fold(name.clone(), |text, index| format!("{text}[{}]", affine(*index, "*")));
    let latex = indices.iter().fold(accented(Name::of(&name)), |name, index| name.with(affine(*index, " "))).text();
    Both { text: rate(text), latex }
}

/// Whether the number has a name of the user.
pub(super) fn has_name(model: &Model, read: Read, column: Affine, counters: &[[i64; 2]]) -> bool {
    matches!(read, Read::Number | Read::Constraint | Read::Part) || array(model, read, column, counters).is_some()
}

/// The name of the array that contains all these numbers, and their indices in it; none for a scalar.
fn array(model: &Model, read: Read, column: Affine, counters: &[[i64; 2]]) -> Option<(String, Vec<Affine>)> {
    let (name, first, lengths) = match read {
        Read::Coordinate | Read::Velocity => {
            let at = usize::try_from(column.at(*counters.first()?)).ok()?;
            let coordinates = &model.coordinates;
            let name = &coordinates.get(at)?.name;
            let first = coordinates.iter().position(|coordinate| coordinate.name == *name)?;
            let last = coordinates.iter().rfind(|coordinate| coordinate.name == *name)?;
            (name.to_string(), first, last.indices.iter().map(|index| index + 1).collect::<Vec<_>>())
        }
        Read::Let(array) | Read::LetRate(array) => {
            let of = model.lets.get(array)?;
            let rows = of.definitions.len() / of.width.max(1);
            (of.name.clone(), 0, if of.width == 1 { vec![rows] } else { vec![rows, of.width] })
        }
        Read::Parameter(first) => {
            let name = &model.parameters.get(first)?.name;
            let count = model.parameters.iter().filter(|parameter| parameter.name == *name).count();
            (name.to_string(), 0, vec![count])
        }
        Read::Constraint => {
            let constraints = &model.constraints;
            let at = usize::try_from(column.at(*counters.first()?)).ok()?;
            let name = &constraints.get(at)?.name;
            let first = constraints.iter().position(|constraint| constraint.name == *name)?;
            let of_name: Vec<_> = constraints.iter().filter(|constraint| constraint.name == *name).collect();
            return match &of_name[..] {
                [alone] if alone.indices.is_empty() => Some((name.to_string(), Vec::new())),
                entries => {
                    let [start] = entries.first()?.indices[..] else { return None };
                    let is_range = (start..).zip(entries).all(|(index, entry)| entry.indices == [index]);
                    let constant = column.constant - i64::try_from(first).ok()? + start;
                    is_range.then(|| (name.to_string(), vec![Affine { constant, ..column }]))
                }
            };
        }
        Read::Number | Read::Part => return None,
    };
    let mut rest = Affine { constant: column.constant - i64::try_from(first).ok()?, ..column };
    let count = i64::try_from(lengths.iter().product::<usize>()).ok()?;
    if !counters.iter().all(|counters| (0..count).contains(&rest.at(*counters))) {
        return None;
    }
    let mut indices = Vec::new();
    for length in lengths.iter().skip(1).rev() {
        let [row, index] = split(rest, i64::try_from(*length).ok()?, counters)?;
        indices.push(index);
        rest = row;
    }
    indices.extend((!lengths.is_empty()).then_some(rest));
    indices.reverse();
    Some((name, indices))
}

/// The row and the place in it of numbers in rows of this length.
fn split(of: Affine, length: i64, counters: &[[i64; 2]]) -> Option<[Affine; 2]> {
    let rows = Affine { constant: of.constant.div_euclid(length), by: of.by.map(|by| by.div_euclid(length)) };
    let places = Affine { constant: of.constant.rem_euclid(length), by: of.by.map(|by| by.rem_euclid(length)) };
    let in_one_row = [Affine { by: [0, 0], ..rows }, Affine { by: of.by, ..places }];
    let is_right = |[_, place]: &[Affine; 2]| counters.iter().all(|at| (0..length).contains(&place.at(*at)));
    [[rows, places], in_one_row].into_iter().find(is_right)
}
