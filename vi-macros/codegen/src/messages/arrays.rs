//! Mistakes with vectors, matrices and arrays.
//!
//! A shape is the list of the lengths: empty for a number, `[3]` for a vector, `[2, 3]` for a matrix of two rows.

use core::fmt::Display;

catalogue! {
    /// A mistake with vectors, matrices and arrays.
    ArrayMistake:

    NumberNeeded { given: Vec<usize>, name: Option<String> } =
        { format!("a number is needed here, not {}", words(given)) },
        {
            match (name, given.len()) {
                (Some(name), 1) => {
                    format!("write one entry, `{name}[0]`, the inner product `{name} * {name}`, or the length `norm({name})`")
                }
                (Some(name), _) => format!("write one entry, `{name}{}`", first(given)),
                (None, 1) => "write an inner product, `v * w`, or name it, `let v = …;`, for one entry `v[0]`".to_owned(),
                (None, _) => format!("write `v * M * w`, or name it, `let M = …;`, for one entry `M{}`", first(given)),
            }
        },
        ["force x = «r»[1];", "force q[0] = «r»[1];"] { given: [3], name: "r[1]" },
        ["force x = «M»;"] { given: [2, 2], name: "M" },
        ["force x = «2» * q;", "dissipation = «dot»(q);", "coord q[3]; L = «dot»(q) * (dot(q) * dot(q));"]
            { given: [3], name: "" },
        ["time_scale = «q»;", "x^«q»", "q[«q»]", "1 / «q»"] { given: [3], name: "q" },
        ["force q[i in 0..N] = «r»[i];"] { given: [3], name: "r[i]" }, ["sum(i in 0..«s», x)", "coord u[«s»];",
         "check { x = «s»; h = 1; };"] { given: [2], name: "s" },
        ["const N = 2; param m[2] = 1; force x = «m»; coord x; L = m[0] * dot(x)^2 / 2 - m[1] * x^2;"]
            { given: [2], name: "m" },
        ["coord x; L = dot(x)^2; discretize { Ld = «q0»; }",
         "coord x; L = dot(x)^2; discretize { Ld = «sum»(i in 0..2, i * q0); }",
         "coord x; L = dot(x)^2; discretize { Ld = L(«q0», q0, q1); }",
         "coord x; L = dot(x)^2; discretize { Ld = «2» * q0; }"] { given: [1], name: "" },
        ["coord x; L = dot(x)^2; discretize { Ld = h / «q0»; }", "coord x; L = dot(x)^2; discretize { Ld = h^«q0»; }"]
            { given: [1], name: "q0" },
        ["coord q[2]; L = «dot»(q[0])^2 * dot(q);"] { given: [2], name: "" };
    ShapeNeeded { needs: Vec<usize>, given: Vec<usize>, name: String } =
        { format!("{} is needed here, not {}", words(needs), words(given)) },
        {
            if needs.is_empty() {
                "write one number".to_owned()
            } else {
                let (literal, ranges) = (literal(needs), ranges(name, needs).0);
                format!("write a list, as in `{literal}`, or one number for each entry, `{name}{ranges} = …`")
            }
        },
        ["force r[0] = «1»;", "check { r[0] = «1», x = 2; h = 1; };"] { needs: [3], given: vec![], name: "r[0]" },
        ["force r[i in 0..N] = «s»;"] { needs: [3], given: [2], name: "r[0]" },
        ["force r = «q»;"] { needs: [3, 3], given: [3], name: "r" },
        ["check { r = «[»1, 2]; h = 1; };"] { needs: [3, 3], given: [2], name: "r" },
        ["param m[2] = 1, K[2][2] = «[»1, 2]; coord x; L = (K[0][0] + m[0]) * dot(x)^2;"]
            { needs: [2, 2], given: [2], name: "K" },
        ["rotation R, S[2]; torque R = «[»1, 2];"] { needs: [3], given: [2], name: "R" },
        ["rotation R, S[2]; torque R = «x»;"] { needs: [3], given: vec![], name: "R" },
        ["force q = «1»;", "check { q = «1»; h = 1; };"] { needs: [3], given: vec![], name: "q" },
        ["param mass = 1, h = 2, k[3] = 0; force x = mass * h * k[0]; check { k = «1»; h = 1; };"]
            { needs: [3], given: vec![], name: "k" };
    Added { left: Vec<usize>, right: Vec<usize> } =
        { format!("{} cannot be added", both(left, right)) },
        "the terms of a sum have one shape; write a vector as `[a, b, c]`, one entry as `v[0]`",
        ["r[0] + «s»"] { left: [3], right: [2] }, ["x - «r»[0]"] { left: vec![], right: [3] },
        ["q + r[0] - «M»"] { left: [3], right: [2, 2] },
        ["coord x; L = dot(x)^2; discretize { Ld = t0 + «q0»; }"] { left: vec![], right: [1] },
        ["time_scale = 1 + «s»;"] { left: vec![], right: [2] };
    Chosen { left: Vec<usize>, right: Vec<usize> } =
        { format!("`if` chooses between {}", both(left, right)) }, "both values of an `if` have one shape";
    Multiplied { left: Vec<usize>, right: Vec<usize> } =
        { format!("{} cannot be multiplied", both(left, right)) },
        {
            match (&left[..], &right[..]) {
                ([4], [3]) => "write `turn(R, v)` for the vector `v` of a body in space, if this is a `rotation R`",
                _ => "`v * w` takes two vectors of equal length; `M * v` as many columns of `M` as `v` has entries, `v * M` as many rows",
            }
            .to_owned()
        },
        ["sum(i in 0..2, M * «r»[i])", "M * «r»[0]"] { left: [2, 2], right: [3] },
        ["r[0] * «s»"] { left: [3], right: [2] }, ["x * M * M * «r»"] { left: [2, 2], right: [3, 3] };
    Function { function: String, given: Vec<usize>, name: Option<String> } =
        { format!("`{function}` takes numbers, not {}", words(given)) },
        {
            match name {
                Some(name) if function == "abs" && given.len() == 1 => {
                    format!("write `norm({name})` for the length of a vector")
                }
                _ => {
                    let name = name.as_deref().unwrap_or("v");
                    let (ranges, indices) = ranges(name, given);
                    let letter = function.get(..1).unwrap_or("s");
                    format!("write `let {letter}{ranges} = {function}({name}{indices});` for each entry")
                }
            }
        },
        ["sin(«q»)"] { function: "sin", given: [3], name: "q" },
        ["x * exp(«r»[0])"] { function: "exp", given: [3], name: "r[0]" },
        ["sum(i in 0..N, cos(«r»[i]))"] { function: "cos", given: [3], name: "r[i]" },
        ["ln(«M»)"] { function: "ln", given: [2, 2], name: "M" },
        ["abs(«q»)"] { function: "abs", given: [3], name: "q" },
        ["hypot(x, «q»)"] { function: "hypot", given: [3], name: "q" },
        ["coord x; L = dot(x)^2; discretize { Ld = sin(«q0»); }"] { function: "sin", given: [1], name: "q0" };
    Power { given: Vec<usize>, name: Option<String> } =
        { format!("`^` takes numbers, not {}", words(given)) },
        {
            let (name, is_vector) = (name.as_deref(), given.len() == 1);
            let name = name.unwrap_or(if is_vector { "v" } else { "M" });
            if is_vector {
                format!("write the inner product, `{name} * {name}`, or a power of the length, `norm({name})^3`")
            } else {
                format!("write the product, `{name} * {name}`")
            }
        },
        ["«q»^2"] { given: [3], name: "q" }, ["1 / «r»[0]^3"] { given: [3], name: "r[0]" },
        ["«M»^2"] { given: [2, 2], name: "M" };
    Inverse = "a matrix has no power -1", { INVERSE.to_owned() },
        ["«M»^-1"];
    OfVectors { function: &'static str, given: Vec<Vec<usize>> } =
        {
            let needs = match *function {
                "cross" => "two vectors of 3, or two of 2",
                "norm" => "a vector",
                "rate" | "spin" => "a rotation",
                "turn" => "a rotation and a vector of 3",
                _ => "a matrix",
            };
            let given: Vec<String> = given.iter().map(|shape| words(shape)).collect();
            format!("`{function}` takes {needs}, not {}", given.join(" and "))
        },
        {
            match *function {
                "cross" => "write `cross(a, b)` of two vectors, as in `cross([x, y, z], v)`",
                "norm" => "write `abs(x)` for a number, `norm([x, y])` for a vector",
                "rate" | "spin" | "turn" => "declare `rotation R;`, and write `rate(R)`, `spin(R)` and `turn(R, [a, b, c])`",
                _ => "write `v * M * w` as it is: a vector is a row on the left and a column on the right",
            }
            .to_owned()
        },
        ["«norm»(x)"] { function: "norm", given: vec![vec![]] },
        ["«norm»(M)"] { function: "norm", given: vec![vec![2, 2]] },
        ["«cross»(q, s)"] { function: "cross", given: vec![vec![3], vec![2]] },
        ["«cross»(q, x)"] { function: "cross", given: vec![vec![3], vec![]] },
        ["«transpose»(q)"] { function: "transpose", given: vec![vec![3]] },
        ["rotation R, S[2]; force x = «rate»(x) * [1, 0, 0];"] { function: "rate", given: vec![vec![]] },
        ["rotation R, S[2]; force x = «turn»(R, [1, 2]) * [1, 0, 0];"]
            { function: "turn", given: vec![vec![4], vec![2]] },
        ["rotation R, S[2]; force x = «spin»(S) * [1, 0, 0];"] { function: "spin", given: vec![vec![2, 4]] };
    Length { given: i64, limit: usize } = "an array cannot have {given} entries", "a constant has 1 to {limit} entries",
        ["param K[2][2] = 1; const m[«0»] = 1; coord x; L = (K[0][0] + m[0]) * dot(x)^2;"] { given: 0, limit: 65_536 },
        ["param K[2][2] = 1; const m[1000][«1000»] = 1; coord x; L = (K[0][0] + m[0]) * dot(x)^2;"]
            { given: 1_000_000, limit: 65_536 };
    EmptyList = "this list has no entries", "write its entries, as in `[a, b, c]`",
        ["«[»]"];
    Rows { first: Vec<usize>, other: Vec<usize> } =
        { format!("{} in one list", both(first, other)) },
        "write numbers, or rows of equal length, as in `[[a, b], [c, d]]`",
        ["param m[2] = 1, K[2][2] = [[1, 2], «3»]; coord x; L = (K[0][0] + m[0]) * dot(x)^2;"]
            { first: [2], other: vec![] },
        ["[1, «s»]"] { first: vec![], other: [2] }, ["[[1, 2], «[»3]]"] { first: [2], other: [1] };
    First { name: String, first: i64 } =
        "`{name}` is no vector: its first index is {first}",
        "write one entry, `{name}[{first}]`, or a sum over it; an array whose first index is 0 is a vector",
        ["«late»"] { name: "late", first: 1 };
    Ragged { name: String } =
        "`{name}` is no matrix: its rows differ in length", "write one row, `{name}[1]`, or a sum over its entries",
        ["«ragged»"] { name: "ragged" };
    Behind { entry: String, before: String, itself: bool } =
        {
            if *itself {
                format!("`{entry}` appears in its own definition")
            } else {
                format!("entries behind `{entry}` are not defined yet")
            }
        },
        "an entry uses earlier entries only, as in `{before}`",
        ["let w[0] = x; let w[i in 1..N] = w[«i»];"] { entry: "w[i]", before: "w[i - 1]", itself: true },
        ["let w[0] = x; let w[i in 1..N] = w[«i» + 1];"] { entry: "w[i]", before: "w[i - 1]", itself: false },
        ["let w[i in 0..N][j in 0..N] = w[i][«j»];"] { entry: "w[i][j]", before: "w[i][j - 1]", itself: true },
        ["let w[i in 0..N][0] = 1; let u[i in 0..N] = x; let w[0][j in 1..N] = w[«1»][j];"]
            { entry: "w[0][j]", before: "w[0][j - 1]", itself: false };
    Before { name: String, index: i64 } =
        "`{name}[{index}]` is not defined yet",
        {
            let others = if *index < 0 { format!(", then the others, `let {name}[i in 1..8] = …;`") } else { String::new() };
            format!("write `let {name}[0] = …;` first{others}")
        },
        ["let w[i in 1..N] = w[«i» - 1] + x;"] { name: "w", index: 0 },
        ["let w[i in 0..N] = w[«i» - 1] + x;"] { name: "w", index: -1 };
    Twice { entry: String } = "`{entry}` is defined twice", "remove one of them, or change its range",
        ["let w[0] = x; let w[«0»] = q[0];"] { entry: "w[0]" },
        ["let w[i in 0..N] = x; let w[i in «2»..9] = x;"] { entry: "w[2]" };
    Gap { entry: String, missing: String } =
        "`{entry}` is defined before `{missing}`", "write the entries in order: `let {missing} = …;` first",
        ["let w[0] = x; let w[i in «2»..N] = x;"] { entry: "w[2]", missing: "w[1]" },
        ["let w[1] = x; let w[«0»] = x;"] { entry: "w[1]", missing: "w[0]" };
    Entries { name: String, index: i64 } =
        "`{name}[{index}]` is a number, and has no entries",
        "write the same number of indices for all entries of an array",
        ["let w[0] = x; let w[«0»][0] = x;"] { name: "w", index: 0 };
    InnerProduct =
        "`dot` is the time derivative, of one argument", "the inner product is `a * b`, the velocity of `x` is `dot(x)`",
        ["«dot»(q, q)", "«dot»(x, t)"];
    IndexComma = "an index is one number", "write each index in brackets of its own: `q[i][j]`",
        ["q[0«,» 1]", "coord q[2«,» 2]; L = 1;",
         "const N = 2; param m[2«,» 2] = 1; coord x; L = m[0] * dot(x)^2 / 2 - m[1] * x^2;"];
    Slice =
        "an index is one number, not a range",
        "write the entries in a list, `[q[0], q[1]]`, or `let part[i in 0..2] = q[i];`",
        ["q[0«.».2]", "q[0«:»2]", "q[«:»]"];
    Separator { is_row: bool } =
        {
            match is_row {
                true => "`;` does not separate rows",
                false => "a `,` is missing between two entries",
            }
            .to_owned()
        },
        "write a vector as `[a, b, c]`, and a matrix by its rows, `[[a, b], [c, d]]`",
        ["const N = 2; param m[2] = [1 «2»]; coord x; L = m[0] * dot(x)^2 / 2 - m[1] * x^2;"] { is_row: false },
        ["const N = 2; param m[2] = [[1, 2«;» 3, 4]]; coord x; L = m[0] * dot(x)^2 / 2 - m[1] * x^2;"] { is_row: true };
    Brackets { limit: usize } = "an array has at most {limit} indices", "use fewer indices";
    Transposed { name: Option<String> } =
        "`^T` does not denote the transpose", { format!("write `transpose({})`", name.as_deref().unwrap_or("M")) },
        ["M^«T»"] { name: "M" };
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
