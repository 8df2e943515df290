//! Mistakes with vectors, matrices, arrays of arrays and recursion, each at its token with its correction.

use crate::messages::{case, errors};

/// A system with vectors and matrices and this clause.
fn clause(clause: &str, message: &str) {
    case(&system(clause), message);
}

fn system(clause: &str) -> String {
    format!(
        "const N = 3; const s = [1, 2]; coord r[N][3], q[N], x; let M = [[x, 1], [2, 3]], ragged[i in 0..N][j in 0..i] = q[j], late[i in 1..N] = q[i]; \
         {clause} L = sum(i in 0..N, dot(r[i]) * dot(r[i])) + dot(q) * dot(q) + dot(x)^2; discretize midpoint;"
    )
}

/// A `let` of this value.
fn value(value: &str, message: &str) {
    clause(&format!("let value = {value};"), message);
}

#[test]
fn shapes_of_sums_and_products() {
    value("r[0] + «s»", "a vector of 3 and one of 2 cannot be added\nhelp: the terms of a sum have one shape");
    value("x - «r»[0]", "a number and a vector of 3 cannot be added");
    value("q + r[0] - «M»", "a vector of 3 and a 2 × 2 matrix cannot be added");
    value("sum(i in 0..2, M * «r»[i])", "a 2 × 2 matrix and a vector of 3 cannot be multiplied");
    value(
        "r[0] * «s»",
        "a vector of 3 and one of 2 cannot be multiplied\nhelp: `v * w` takes two vectors of equal length",
    );
    value("M * «r»[0]", "a 2 × 2 matrix and a vector of 3 cannot be multiplied");
    value("x * M * M * «r»", "a 2 × 2 matrix and a 3 × 3 matrix cannot be multiplied");
    value(
        "1 / «q»",
        "a number is needed here, not a vector of 3\nhelp: write one entry, `q[0]`, the inner product `q * q`, or the length `norm(q)`",
    );
    value("[1, «s»]", "a number and a vector of 2 in one list\nhelp: write numbers, or rows of equal length");
    value("[[1, 2], «[»3]]", "a vector of 2 and one of 1 in one list");
    value("«[»]", "this list has no entries\nhelp: write its entries, as in `[a, b, c]`");
    value("x + 2 * «[»x + 1]", "only parentheses group an expression\nhelp: write `(a + b)`");
}

#[test]
fn numbers_are_needed() {
    let number = "a number is needed here, not a vector of 3";
    clause(
        "force x = «r»[1];",
        &format!(
            "{number}\nhelp: write one entry, `r[1][0]`, the inner product `r[1] * r[1]`, or the length `norm(r[1])`"
        ),
    );
    clause("force x = «M»;", "a number is needed here, not a 2 × 2 matrix\nhelp: write one entry, `M[0][0]`");
    clause("force x = «2» * q;", &format!("{number}\nhelp: write an inner product, `v * w`"));
    clause("dissipation = «dot»(q);", number);
    clause("time_scale = «q»;", number);
    clause("force q[0] = «r»[1];", number);
    clause("force q[i in 0..N] = «r»[i];", &format!("{number}\nhelp: write one entry, `r[i][0]`"));
    value("x^«q»", number);
    value("q[«q»]", number);
    value("sum(i in 0..«s», x)", "a number is needed here, not a vector of 2");
    clause("coord z[«s»];", "a number is needed here, not a vector of 2");
    case("coord q[3]; L = «dot»(q) * (dot(q) * dot(q)); discretize midpoint;", number);
}

#[test]
fn functions_and_powers_of_arrays() {
    value(
        "sin(«q»)",
        "`sin` takes numbers, not a vector of 3\nhelp: write `let s[i in 0..3] = sin(q[i]);` for each entry",
    );
    value("x * exp(«r»[0])", "`exp` takes numbers, not a vector of 3\nhelp: write `let e[i in 0..3] = exp(r[0][i]);`");
    value(
        "sum(i in 0..N, cos(«r»[i]))",
        "`cos` takes numbers, not a vector of 3\nhelp: write `let c[j in 0..3] = cos(r[i][j]);`",
    );
    value(
        "ln(«M»)",
        "`ln` takes numbers, not a 2 × 2 matrix\nhelp: write `let l[i in 0..2][j in 0..2] = ln(M[i][j]);`",
    );
    value("abs(«q»)", "`abs` takes numbers, not a vector of 3\nhelp: write `norm(q)` for the length of a vector");
    value("hypot(x, «q»)", "`hypot` takes numbers, not a vector of 3");
    value(
        "«q»^2",
        "`^` takes numbers, not a vector of 3\nhelp: write the inner product, `q * q`, or a power of the length",
    );
    value("1 / «r»[0]^3", "`^` takes numbers, not a vector of 3\nhelp: write the inner product, `r[0] * r[0]`");
    value("«M»^2", "`^` takes numbers, not a 2 × 2 matrix\nhelp: write the product, `M * M`");
    value(
        "«M»^-1",
        "a matrix has no power -1\nhelp: inverses are not supported: `transpose(R)` is the inverse of a rotation",
    );
    value("M^«T»", "`^T` does not denote the transpose\nhelp: write `transpose(M)`");
    value("«norm»(x)", "`norm` takes a vector, not a number\nhelp: write `abs(x)` for a number");
    value("«norm»(M)", "`norm` takes a vector, not a 2 × 2 matrix");
    value("«cross»(q, s)", "`cross` takes two vectors of 3, or two of 2, not a vector of 3 and a vector of 2");
    value("«cross»(q, x)", "`cross` takes two vectors of 3, or two of 2, not a vector of 3 and a number");
    value("«cross»(q)", "`cross` takes 2 arguments, not 1\nhelp: write `cross(a, b)`");
    value("«transpose»(q)", "`transpose` takes a matrix, not a vector of 3\nhelp: write `v * M * w` as it is");
    value("«cross»", "`cross` is a function");
    value("«q»(1)", "`q` is an array, not a function\nhelp: write an entry as `q[0]`; indices start at 0");
    value("M «@» q", "`@` is not an operator\nhelp: write `*`: `M * v`");
    value("q «.»* q", "`.*` is not an operator\nhelp: write `*`: `M * v`");
    value("«diag»(q)", "unknown function `diag`\nhelp: write the rows: `[[a, 0], [0, b]]`");
    value("«cros»(q, q)", "unknown function `cros`\nhelp: did you mean `cross`?");
}

#[test]
fn functions_of_other_languages() {
    for (written, wanted) in [
        ("«dot»(q, q)", "`dot` is the time derivative, of one argument\nhelp: the inner product is `a * b`"),
        ("q.«dot»(q)", "`.dot(…)`: numbers have no methods\nhelp: write `a * b` for the inner product"),
        ("q.«cross»(q)", "`.cross(…)`: numbers have no methods\nhelp: write it as a function, `cross(…)`"),
        ("M.«T»", "`.T`: names have no fields\nhelp: write `transpose(M)`"),
        ("«inv»(M)", "unknown function `inv`\nhelp: inverses are not supported"),
        ("«inverse»(M)", "unknown function `inverse`\nhelp: inverses are not supported"),
        ("«det»(M)", "unknown function `det`\nhelp: write it out: `M[0][0] * M[1][1] - M[0][1] * M[1][0]`"),
        ("«trace»(M)", "unknown function `trace`\nhelp: write `sum(i in 0..3, M[i][i])`"),
        ("«matmul»(M, M)", "unknown function `matmul`\nhelp: write `a * b`"),
        ("«normalize»(q)", "unknown function `normalize`\nhelp: write `v / norm(v)`"),
        ("«identity»(3)", "unknown function `identity`\nhelp: write the rows: `[[1, 0], [0, 1]]`"),
        ("«|»q|", "bars do not denote the absolute value\nhelp: write `abs(x)`, `norm(v)` for the length"),
        ("q[0«,» 1]", "an index is one number\nhelp: write each index in brackets of its own: `q[i][j]`"),
        ("q[0«.».2]", "an index is one number, not a range\nhelp: write the entries in a list, `[q[0], q[1]]`"),
        ("q[0«:»2]", "an index is one number, not a range"),
        ("q[«:»]", "an index is one number, not a range"),
        (
            "(q + r[0])«[»0]",
            "only a name can have an index\nhelp: write `dot(q[0])` for the velocity of `q[0]`, and name other vectors",
        ),
        ("dot(q)«[»0]", "only a name can have an index"),
        ("[1, 2]«[»0]", "only a name can have an index"),
    ] {
        value(written, wanted);
    }
}

#[test]
fn indices() {
    value("r[«3»]", "`r[3]` is out of range 0..3\nhelp: the indices are 0 to 2");
    value("r[1][«3»]", "`r[1][3]` is out of range 0..3");
    value("r[1][2][«0»]", "`r[1][2]` is not an array\nhelp: write `r[1][2]` without an index");
    value("dot(r[0][«-»1])", "`r[0][-1]` is out of range 0..3");
    value("M[1][«2»]", "`M[1][2]` is out of range 0..2");
    value("M[0][0][«0»]", "`M[0][0]` is not an array");
    value("s[«2»]", "`s[2]` is out of range 0..2");
    value("ragged[2][«2»]", "`ragged[2][2]` is out of range 0..2");
    value("ragged[0][«0»]", "`ragged[0][0]` is out of range 0..0\nhelp: this array has no entries");
    value("«ragged»", "`ragged` is no matrix: its rows differ in length\nhelp: write one row, `ragged[1]`");
    value("«late»", "`late` is no vector: its first index is 1\nhelp: write one entry, `late[1]`, or a sum over it");
    value("«x»[0][1]", "`x` is not an array");
    value("«unknown»[0][1]", "unknown name `unknown`");
    value("dot(«s»)", "`dot(s)`: `s` does not change with time");
    value("dot(«dot»(q) * q)", "an expression cannot depend on the acceleration `dot(…)`");
    value("sum(i in 0..2, j in i..«0», 1)", "the range 1..0 ends before it begins");
    value("sum(i in 0..2, «i» in 0..2, 1)", "the name `i` is declared twice");
    value("sum(i in 0..2, j in 0..i«)»", "expected `,` and what is summed");
}

#[test]
fn recursion() {
    clause(
        "let y[0] = x; let y[i in 1..N] = y[«i»];",
        "`y[i]` appears in its own definition\nhelp: an entry uses earlier entries only, as in `y[i - 1]`",
    );
    clause(
        "let y[0] = x; let y[i in 1..N] = y[«i» + 1];",
        "entries behind `y[i]` are not defined yet\nhelp: an entry uses earlier entries only, as in `y[i - 1]`",
    );
    clause("let y[i in 1..N] = y[«i» - 1] + x;", "`y[0]` is not defined yet\nhelp: write `let y[0] = …;` first");
    clause(
        "let y[i in 0..N] = y[«i» - 1] + x;",
        "`y[-1]` is not defined yet\nhelp: write `let y[0] = …;` first, then the others",
    );
    clause("let y[0] = x; let y[i in 1..N] = y[«i» - 2];", "`y[-1]` is out of range 0..1");
    clause(
        "let y[0] = x; let y[i in «2»..N] = x;",
        "`y[2]` is defined before `y[1]`\nhelp: write the entries in order: `let y[1] = …;` first",
    );
    clause("let y[0] = x; let y[«0»] = q[0];", "`y[0]` is defined twice\nhelp: remove one of them");
    clause("let y[i in 0..N] = x; let y[i in «2»..9] = x;", "`y[2]` is defined twice");
    clause("let y[1] = x; let y[«0»] = x;", "`y[1]` is defined before `y[0]`");
    clause("let y[0] = «y»;", "`y` is not declared before this line");
    clause("let y[0] = x; let «y» = 2;", "the name `y` is declared twice");
    clause("let y = s; let «y»[2] = 3;", "the name `y` is declared twice");
    clause("let «q»[3] = x;", "the name `q` is declared twice");
    clause("let y[0] = x; let y[«0»][0] = x;", "`y[0]` is a number, and has no entries");
    clause("let y[i in 0..N][j in 0..N] = y[i][«j»];", "`y[i][j]` appears in its own definition");
    clause(
        "let y[i in 0..N][0] = 1; let z[i in 0..N] = x; let y[0][j in 1..N] = y[«1»][j];",
        "entries behind `y[0][j]` are not defined yet",
    );
    // An entry may use whole earlier rows.
    let rows = "let y[0] = [x, 1]; let y[i in 1..N] = M * y[i - 1]; force x = y[2] * s;";
    assert_eq!(errors(&format!("struct System {{ {} }}", system(rows))), []);
    // A wrong array is reported once.
    clause(
        "let y[0] = x; let y[i in 1..N] = «z»; let y[N] = y[0] + r[0]; force x = y; force q = y + q;",
        "unknown name `z`",
    );
    clause("let y = «z»; let w = y + r[0]; force x = w * r[1] * w; force q[0] = norm(y);", "unknown name `z`");
}

#[test]
fn shapes_of_clauses() {
    let list = "help: write a list, as in `[a, b, c]`, or one number for each entry";
    clause("force r[0] = «1»;", &format!("a vector of 3 is needed here, not a number\n{list}, `r[0][i in 0..3] = …`"));
    clause("force r[i in 0..N] = «s»;", "a vector of 3 is needed here, not a vector of 2");
    clause(
        "force r = «q»;",
        "a 3 × 3 matrix is needed here, not a vector of 3\nhelp: write a list, as in `[[a, b], [c, d]]`, or one number for each entry, `r[i in 0..3][j in 0..3] = …`",
    );
    clause("force r[0][0][«0»] = 1;", "`r[0][0]` is not an array");
    clause("force r[0][i in 0..«4»] = 1;", "`r[0][3]` is out of range 0..3");
    clause("force r[0] = q; force «r»[0][1] = 1;", "a second force on `r`");
    clause("check { r[0] = «1», x = 2; h = 1; }", "a vector of 3 is needed here, not a number");
    clause("check { x = «s»; h = 1; }", "a number is needed here, not a vector of 2");
    clause("check { r[0] = [1, 2, 3], «r»[0][0] = 1; h = 1; }", "`r` is given twice");
    clause("check { r = «[»1, 2]; h = 1; }", "a 3 × 3 matrix is needed here, not a vector of 2");
}

#[test]
fn shapes_of_declarations() {
    let used =
        |parameters: &str| format!("{parameters} coord x; L = (K[0][0] + m[0]) * dot(x)^2; discretize midpoint;");
    for (declared, message) in [
        ("param m[2] = 1, K[2][2] = [[1, 2], «3»];", "a vector of 2 and a number in one list"),
        ("param m[2] = 1, K[2][2] = [[1, 2, «3»], [3, 4, 5]];", "`K[0]` has length 2 but a list of 3 values"),
        ("param m[2] = 1, K[2][«2»] = [[1], [3]];", "`K[0]` has length 2 but a list of 1"),
        ("param m[2] = 1, K[2][2] = [[1, 2], [3, 4], «[»5, 6]];", "`K` has length 2 but a list of 3 values"),
        ("param m[2] = 1, K[2][2] = «[»1, 2];", "a 2 × 2 matrix is needed here, not a vector of 2"),
        (
            "param m[2] = 1, «K» = [[1, 2], [3, 4]];",
            "`K` is not an array but has a list of values\nhelp: write its length: `param K[2][2] = […];`",
        ),
        (
            "param m[2] = 1, K[16][«17»] = 1;",
            "an array cannot have 272 parameters\nhelp: an array of parameters has 1 to 256",
        ),
        ("param m[2] = 1, K[2][«0»] = 1;", "an array cannot have 0 parameters"),
        ("param m[2] = 1, K[2][«-»1] = 1;", "an array cannot have -1 parameters"),
        ("param m[2] = 1, K[2][2] = [[1, «exp»(1000)], [1, 2]];", "the value of `K` is not finite"),
        ("param K[2][2] = 1; const m[2] = [1, 2, «3»];", "`m` has length 2 but a list of 3 values"),
        (
            "param K[2][2] = 1; const m[«0»] = 1;",
            "an array cannot have 0 entries\nhelp: a constant has 1 to 65536 entries",
        ),
        ("param K[2][2] = 1; const m[1000][«1000»] = 1;", "an array cannot have 1000000 entries"),
        ("param K[2][2] = 1; const m = [1, «exp»(1000)];", "the value of `m` is not finite"),
        ("param K[2][2] = 1; const m[2] = [1, «K»];", "`K` is a parameter: it has no value"),
    ] {
        case(&used(declared), message);
    }
    case(
        "coord r[100][«3»]; L = 1; discretize midpoint;",
        "an array cannot have 300 coordinates\nhelp: a system has 1 to 256",
    );
    case("coord r[2][«0»]; L = 1; discretize midpoint;", "an array cannot have 0 coordinates");
    case("param «K»[2][2] = 1; coord x; L = dot(x)^2; discretize midpoint;", "the parameter `K` is never used");
}

/// Arrays that grow too large are refused, within the limit of work.
#[test]
fn sizes_are_bounded() {
    let work = ["the system takes more than", "the expanded system has more than"];
    for large in [
        "let big[i in 0..100000000] = x;",
        "let big[i in 0..600][j in 0..600] = 1; let product = big * big;",
        "let big[0] = [x, 1]; let big[i in 1..1000000000] = M * big[i - 1];",
    ] {
        let found = errors(&format!("struct System {{ {} }}", system(large)));
        assert_eq!(found.len(), 1, "{found:?}");
        assert!(work.iter().any(|start| found[0].1.starts_with(start)), "{found:?}");
    }
}
