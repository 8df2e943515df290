//! Mistakes with vectors, matrices and arrays.
//!
//! In: the shapes and names found. Out: a message with the error and its correction. A shape is the list of the
//! lengths: empty for a number, `[3]` for a vector, `[2, 3]` for a matrix of two rows.

use core::fmt::Display;

/// A mistake with vectors, matrices and arrays. The fields of a variant are the words that its text names.
#[allow(missing_docs)]
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum ArrayMistake {
    /// A vector or a matrix where a number is needed; the name of the array, if it has one.
    NumberNeeded { given: Vec<usize>, name: Option<String> },
    /// Another shape than that of the part of an array that is defined.
    ShapeNeeded { needs: Vec<usize>, given: Vec<usize>, name: String },
    /// A sum of two shapes.
    Added { left: Vec<usize>, right: Vec<usize> },
    /// Two shapes of which an `if` takes one.
    Chosen { left: Vec<usize>, right: Vec<usize> },
    /// A product of two shapes that do not fit.
    Multiplied { left: Vec<usize>, right: Vec<usize> },
    /// A function of numbers with an array as its argument.
    Function { function: String, given: Vec<usize>, name: Option<String> },
    /// A power of an array.
    Power { given: Vec<usize>, name: Option<String> },
    /// `M^-1`.
    Inverse,
    /// A function of vectors or matrices with other arguments.
    OfVectors { function: &'static str, given: Vec<Vec<usize>> },
    /// A constant with too many entries, or none.
    Length { given: i64, limit: usize },
    /// A list without entries.
    EmptyList,
    /// A list of entries of several shapes.
    Rows { first: Vec<usize>, other: Vec<usize> },
    /// An array that is no vector: its first index is not 0.
    First { name: String, first: i64 },
    /// An array that is no matrix: its rows differ in length.
    Ragged { name: String },
    /// An entry at or behind the one that is being defined.
    Behind { entry: String, before: String, itself: bool },
    /// An entry before the first definition of a recursion.
    Before { name: String, index: i64 },
    /// An entry that is defined twice.
    Twice { entry: String },
    /// An entry that is defined before the one in front of it.
    Gap { entry: String, missing: String },
    /// A length that differs from the rows above.
    Entries { name: String, index: i64 },
    /// `dot(a, b)`.
    InnerProduct,
    /// `q[i, j]`.
    IndexComma,
    /// `q[0..2]`, `q[0:2]`.
    Slice,
    /// `[1 2]`, `[1, 2; 3, 4]`.
    Separator { is_row: bool },
    /// More indices than an array may have.
    Brackets { limit: usize },
    /// `M^T`.
    Transposed { name: Option<String> },
}

/// Help for the inverse of a matrix.
pub(crate) const INVERSE: &str = "inverses are not supported: `transpose(R)` is the inverse of a rotation; of `[[a, b], [c, d]]` it is \
    `[[d, -b], [-c, a]] / (a * d - b * c)`";

/// Each of these in brackets of its own: `[0][3]`.
pub(crate) fn bracketed(parts: impl IntoIterator<Item = impl Display>) -> String {
    parts.into_iter().fold(String::new(), |text, part| format!("{text}[{part}]"))
}

/// A shape in words.
fn words(shape: &[usize]) -> String {
    match shape {
        [] => "a number".to_owned(),
        [length] => format!("a vector of {length}"),
        [rows, columns] => format!("a {rows} × {columns} matrix"),
        more => {
            let lengths: Vec<String> = more.iter().map(ToString::to_string).collect();
            format!("an array of {} numbers", lengths.join(" × "))
        }
    }
}

/// Two shapes in words.
fn both(left: &[usize], right: &[usize]) -> String {
    match (left, right) {
        ([_], [length]) => format!("{} and one of {length}", words(left)),
        _ => format!("{} and {}", words(left), words(right)),
    }
}

/// The indices of the first entry: `[0][0]` of a matrix.
fn first(shape: &[usize]) -> String {
    "[0]".repeat(shape.len())
}

/// The ranges over all entries of a named part: `[i in 0..2][j in 0..3]` of a 2 × 3 matrix; then the indices alone.
fn ranges(name: &str, shape: &[usize]) -> (String, String) {
    let is_free = |index: &&str| !name.contains(&format!("[{index}]"));
    let names: Vec<&str> = ["i", "j", "k", "l", "m", "n"].into_iter().filter(is_free).collect();
    let each = || names.iter().zip(shape);
    let ranges = bracketed(each().map(|(index, length)| format!("{index} in 0..{length}")));
    (ranges, bracketed(each().map(|(index, _)| index)))
}

/// A literal of a shape, with letters.
fn literal(shape: &[usize]) -> &'static str {
    match shape.len() {
        0 => "a",
        1 => "[a, b, c]",
        _ => "[[a, b], [c, d]]",
    }
}

impl ArrayMistake {
    /// What is wrong.
    #[must_use]
    pub fn what(&self) -> String {
        match self {
            Self::Separator { is_row: true } => "`;` does not separate rows".to_owned(),
            Self::Separator { .. } => "a `,` is missing between two entries".to_owned(),
            Self::NumberNeeded { given, .. } => format!("a number is needed here, not {}", words(given)),
            Self::ShapeNeeded { needs, given, .. } => {
                format!("{} is needed here, not {}", words(needs), words(given))
            }
            Self::Added { left, right } => format!("{} cannot be added", both(left, right)),
            Self::Chosen { left, right } => format!("`if` chooses between {}", both(left, right)),
            Self::Multiplied { left, right } => format!("{} cannot be multiplied", both(left, right)),
            Self::Function { function, given, .. } => format!("`{function}` takes numbers, not {}", words(given)),
            Self::Power { given, .. } => format!("`^` takes numbers, not {}", words(given)),
            Self::Inverse => "a matrix has no power -1".to_owned(),
            Self::OfVectors { function, given } => {
                let needs = match *function {
                    "cross" => "two vectors of 3, or two of 2",
                    "norm" => "a vector",
                    "rate" | "spin" => "a rotation",
                    "turn" => "a rotation and a vector of 3",
                    _ => "a matrix",
                };
                let given: Vec<String> = given.iter().map(|shape| words(shape)).collect();
                format!("`{function}` takes {needs}, not {}", given.join(" and "))
            }
            Self::Length { given, .. } => format!("an array cannot have {given} entries"),
            Self::EmptyList => "this list has no entries".to_owned(),
            Self::Rows { first, other } => format!("{} in one list", both(first, other)),
            Self::First { name, first } => format!("`{name}` is no vector: its first index is {first}"),
            Self::Ragged { name } => format!("`{name}` is no matrix: its rows differ in length"),
            Self::Behind { entry, itself: true, .. } => format!("`{entry}` appears in its own definition"),
            Self::Behind { entry, .. } => format!("entries behind `{entry}` are not defined yet"),
            Self::Before { name, index } => format!("`{name}[{index}]` is not defined yet"),
            Self::Twice { entry } => format!("`{entry}` is defined twice"),
            Self::Gap { entry, missing } => format!("`{entry}` is defined before `{missing}`"),
            Self::Entries { name, index } => format!("`{name}[{index}]` is a number, and has no entries"),
            Self::InnerProduct => "`dot` is the time derivative, of one argument".to_owned(),
            Self::IndexComma => "an index is one number".to_owned(),
            Self::Slice => "an index is one number, not a range".to_owned(),
            Self::Brackets { limit } => format!("an array has at most {limit} indices"),
            Self::Transposed { .. } => "`^T` does not denote the transpose".to_owned(),
        }
    }

    /// What to write instead.
    #[must_use]
    pub fn help(&self) -> String {
        match self {
            Self::Separator { .. } => "write a vector as `[a, b, c]`, and a matrix by its rows, `[[a, b], [c, d]]`".to_owned(),
            Self::NumberNeeded { given, name: Some(name) } if given.len() == 1 => {
                format!("write one entry, `{name}[0]`, the inner product `{name} * {name}`, or the length `norm({name})`")
            }
            Self::NumberNeeded { given, name: Some(name) } => format!("write one entry, `{name}{}`", first(given)),
            Self::NumberNeeded { given, .. } if given.len() == 1 => {
                "write an inner product, `v * w`, or name it, `let v = …;`, for one entry `v[0]`".to_owned()
            }
            Self::NumberNeeded { given, .. } => {
                format!("write `v * M * w`, or name it, `let M = …;`, for one entry `M{}`", first(given))
            }
            Self::ShapeNeeded { needs, name, .. } => match needs.len() {
                0 => "write one number".to_owned(),
                _ => format!("write a list, as in `{}`, or one number for each entry, `{name}{} = …`", literal(needs), ranges(name, needs).0),
            },
            Self::Added { .. } => "the terms of a sum have one shape; write a vector as `[a, b, c]`, one entry as `v[0]`".to_owned(),
            Self::Chosen { .. } => "both values of an `if` have one shape".to_owned(),
            Self::Multiplied { left, right } if left[..] == [4] && right[..] == [3] => {
                "write `turn(R, v)` for the vector `v` of a body in space, if this is a `rotation R`".to_owned()
            }
            Self::Multiplied { .. } => {
                "`v * w` takes two vectors of equal length; `M * v` as many columns of `M` as `v` has entries, `v * M` as many rows"
                    .to_owned()
            }
            Self::Function { function, given, name: Some(name) } if function == "abs" && given.len() == 1 => {
                format!("write `norm({name})` for the length of a vector")
            }
            Self::Function { function, given, name } => {
                let name = name.as_deref().unwrap_or("v");
                let (ranges, indices) = ranges(name, given);
                let letter = function.get(..1).unwrap_or("s");
                format!("write `let {letter}{ranges} = {function}({name}{indices});` for each entry")
            }
            Self::Power { given, name } if given.len() == 1 => {
                let name = name.as_deref().unwrap_or("v");
                format!("write the inner product, `{name} * {name}`, or a power of the length, `norm({name})^3`")
            }
            Self::Power { name, .. } => {
                let name = name.as_deref().unwrap_or("M");
                format!("write the product, `{name} * {name}`")
            }
            Self::Inverse => INVERSE.to_owned(),
            Self::OfVectors { function: "cross", .. } => "write `cross(a, b)` of two vectors, as in `cross([x, y, z], v)`".to_owned(),
            Self::OfVectors { function: "norm", .. } => "write `abs(x)` for a number, `norm([x, y])` for a vector".to_owned(),
            Self::OfVectors { function: "rate" | "spin" | "turn", .. } => {
                "declare `rotation R;`, and write `rate(R)`, `spin(R)` and `turn(R, [a, b, c])`".to_owned()
            }
            Self::OfVectors { .. } => "write `v * M * w` as it is: a vector is a row on the left and a column on the right".to_owned(),
            Self::Length { limit, .. } => format!("a constant has 1 to {limit} entries"),
            Self::EmptyList => "write its entries, as in `[a, b, c]`".to_owned(),
            Self::Rows { .. } => "write numbers, or rows of equal length, as in `[[a, b], [c, d]]`".to_owned(),
            Self::First { name, first } => {
                format!("write one entry, `{name}[{first}]`, or a sum over it; an array whose first index is 0 is a vector")
            }
            Self::Ragged { name } => format!("write one row, `{name}[1]`, or a sum over its entries"),
            Self::Behind { before, .. } => format!("an entry uses earlier entries only, as in `{before}`"),
            Self::Before { name, index: 0.. } => format!("write `let {name}[0] = …;` first"),
            Self::Before { name, .. } => {
                format!("write `let {name}[0] = …;` first, then the others, `let {name}[i in 1..8] = …;`")
            }
            Self::Twice { .. } => "remove one of them, or change its range".to_owned(),
            Self::Gap { missing, .. } => format!("write the entries in order: `let {missing} = …;` first"),
            Self::Entries { .. } => "write the same number of indices for all entries of an array".to_owned(),
            Self::InnerProduct => "the inner product is `a * b`, the velocity of `x` is `dot(x)`".to_owned(),
            Self::IndexComma => "write each index in brackets of its own: `q[i][j]`".to_owned(),
            Self::Slice => "write the entries in a list, `[q[0], q[1]]`, or `let part[i in 0..2] = q[i];`".to_owned(),
            Self::Brackets { .. } => "use fewer indices".to_owned(),
            Self::Transposed { name } => format!("write `transpose({})`", name.as_deref().unwrap_or("M")),
        }
    }
}
