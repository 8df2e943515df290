//! Vectors, matrices, arrays of arrays and recursion: systems written with them against the same systems written out.

use vi_codegen::{Derived, derive, syntax::parse};

/// The system of these lines.
fn derived(body: &str) -> Derived {
    let text = format!("struct System {{ {body} discretize midpoint; }}");
    let system = parse::system(text.parse().expect("tokens")).unwrap_or_else(|error| panic!("{text}: {error}"));
    derive(&system).unwrap_or_else(|error| panic!("{text}: {error}")).own
}

/// L and the forces as text.
fn rendered(body: &str) -> Vec<String> {
    let Derived { pool, model, .. } = derived(body);
    let all = [model.lagrangian].into_iter().chain(model.forces.iter().copied());
    all.map(|expr| pool.render_within(100_000, expr, &|symbol| model.spell(symbol))).collect()
}

/// Both bodies have the same L and forces, of more than `least` characters.
fn same(least: usize, vectors: &str, written_out: &str) {
    let (one, other) = (rendered(vectors), rendered(written_out));
    assert!(one[0].len() > least, "{one:?}");
    assert_eq!(one, other, "{vectors}\n{written_out}");
}

/// The pairs are equal: with `z` their differences, `L + z * z` is `L`.
fn equal(body: &str, lagrangian: &str, pairs: &[(&str, &str)]) {
    for (left, right) in pairs {
        let with = |factor: u8, summand: &str| {
            let lets = format!("let left = {left}; let z = left - {factor} * ({right});");
            rendered(&format!("{body} {lets} L = {lagrangian} {summand};"))
        };
        assert_eq!(with(1, "+ z * z"), with(1, ""), "{left} is not {right}");
        assert_ne!(with(2, "+ z * z"), with(2, ""), "{left} is zero");
    }
}

#[test]
fn bodies_in_space() {
    let head = "const N = 4; param m[N] = [1, 2, 3, 4], G = 1; coord r[N][3];";
    same(
        300,
        &format!(
            "{head} L = sum(i in 0..N, m[i] * dot(r[i]) * dot(r[i]) / 2) + sum(i in 0..N, j in 0..i, G * m[i] * m[j] / norm(r[i] - r[j]));"
        ),
        &format!(
            "{head} L = sum(i in 0..N, m[i] * (dot(r[i][0])^2 + dot(r[i][1])^2 + dot(r[i][2])^2) / 2) + sum(i in 0..N, sum(j in 0..i, \
             G * m[i] * m[j] / sqrt((r[i][0] - r[j][0])^2 + (r[i][1] - r[j][1])^2 + (r[i][2] - r[j][2])^2)));"
        ),
    );
    // Names of the entries, row by row.
    let Derived { model, .. } = derived(&format!("{head} L = sum(i in 0..N, m[i] * dot(r[i]) * dot(r[i])) - G;"));
    let names: Vec<String> = model.coordinates.iter().map(vi_codegen::model::Coordinate::text).collect();
    assert_eq!(names[..4], ["r[0][0]", "r[0][1]", "r[0][2]", "r[1][0]"]);
    assert_eq!((names.len(), model.coordinates[11].ident()), (12, "r_3_2".to_owned()));
}

#[test]
fn a_quadrotor() {
    equal(
        "param m = 1, g = 9.81, J[3] = [1, 2, 3] / 100, thrust = 9; coord r[3], φ, θ, ψ;
         let X = [[1, 0, 0], [0, cos(φ), -sin(φ)], [0, sin(φ), cos(φ)]];
         let Y = [[cos(θ), 0, sin(θ)], [0, 1, 0], [-sin(θ), 0, cos(θ)]];
         let Z = [[cos(ψ), -sin(ψ), 0], [sin(ψ), cos(ψ), 0], [0, 0, 1]];
         let R = Z * Y * X;
         let ω = transpose(X) * (transpose(Y) * [0, 0, dot(ψ)] + [0, dot(θ), 0]) + [dot(φ), 0, 0];
         let inertia = [[J[0], 0, 0], [0, J[1], 0], [0, 0, J[2]]];
         let p = dot(φ) - sin(θ) * dot(ψ);
         let q = cos(φ) * dot(θ) + sin(φ) * cos(θ) * dot(ψ);
         let s = cos(φ) * cos(θ) * dot(ψ) - sin(φ) * dot(θ);",
        "m * dot(r) * dot(r) / 2 + ω * inertia * ω / 2 - m * g * r[2] - thrust * (dot(φ)^2 + dot(θ)^2 + dot(ψ)^2)",
        &[
            ("ω * inertia * ω / 2", "J[0] * p^2 / 2 + J[1] * q^2 / 2 + J[2] * s^2 / 2"),
            (
                "thrust * R * [0, 0, 1]",
                "[thrust * (cos(ψ) * sin(θ) * cos(φ) + sin(ψ) * sin(φ)), thrust * (sin(ψ) * sin(θ) * cos(φ) - cos(ψ) * sin(φ)), \
                 thrust * cos(θ) * cos(φ)]",
            ),
        ],
    );
}

#[test]
fn a_chain_by_recursion() {
    let head = "const N = 5; param m[N] = 1, l = 0.5, g = 9.81; coord θ[N];";
    let energies = "L = sum(i in 0..N, m[i] * (dot(x[i])^2 + dot(y[i])^2) / 2 - m[i] * g * y[i]);";
    let sums = format!(
        "{head} let x[i in 0..N] = sum(j in 0..i + 1, l * sin(θ[j])); let y[i in 0..N] = -sum(j in 0..i + 1, l * cos(θ[j])); {energies}"
    );
    let recursion = "let x[0] = l * sin(θ[0]); let y[0] = -l * cos(θ[0]);
        let x[i in 1..N] = x[i - 1] + l * sin(θ[i]); let y[i in 1..N] = y[i - 1] - l * cos(θ[i]);";
    same(200, &format!("{head} {recursion} {energies}"), &sums);
    // A recursion of vectors.
    let of_vectors =
        "let p[0] = l * [sin(θ[0]), -cos(θ[0])]; let p[i in 1..N] = p[i - 1] + l * [sin(θ[i]), -cos(θ[i])];
        L = sum(i in 0..N, m[i] * dot(p[i]) * dot(p[i]) / 2 - m[i] * g * p[i][1]);";
    same(200, &format!("{head} {of_vectors}"), &sums);
    // Two indices: Pascal's triangle, whose rows differ in length.
    let pascal = "const N = 6; coord x[N];
        let c[n in 0..N][0] = 1; let c[n in 1..N][k in 1..n] = c[n - 1][k - 1] + c[n - 1][k];";
    let found = errors_of(&format!("{pascal} L = sum(i in 0..N, dot(x[i])^2);"));
    assert!(found.starts_with("`c[1][1]` is out of range 0..1"), "{found}");
    let triangle = pascal.replace("= c[n - 1][k - 1] + c[n - 1][k]", "= c[n - 1][k - 1] * n / k");
    equal(
        &triangle,
        "sum(i in 0..N, dot(x[i])^2)",
        &[("c[5][2] * x[0]", "10 * x[0]"), ("c[4] * x[0]", "[1, 4, 6, 4] * x[0]")],
    );
}

/// The first message of a system.
fn errors_of(body: &str) -> String {
    let text = format!("struct System {{ {body} discretize midpoint; }}");
    let system = parse::system(text.parse().expect("tokens"));
    system.and_then(|system| derive(&system)).map_or_else(|error| error.to_string(), |_| String::new())
}

#[test]
fn a_linkage_of_four_bars() {
    // Two cranks joined by a spring in place of the coupler.
    let head = "param m = 1, k = 50, l = 0.8, a[2] = [1, 0.2]; coord α, β;";
    // Squares of sines and cosines leave 119 characters.
    same(
        110,
        &format!(
            "{head}
             let angle = [α, β];
             let R[i in 0..2] = [[cos(angle[i]), -sin(angle[i])], [sin(angle[i]), cos(angle[i])]];
             let pivot = [[0, 0], a];
             let end[i in 0..2] = pivot[i] + R[i] * [l, 0];
             let gap = end[1] - end[0];
             L = m * sum(i in 0..2, dot(end[i]) * dot(end[i])) / 2 - k * (norm(gap) - 1)^2 / 2;"
        ),
        &format!(
            "{head}
             let x0 = l * cos(α), y0 = l * sin(α), x1 = a[0] + l * cos(β), y1 = a[1] + l * sin(β);
             L = m * (dot(x0)^2 + dot(y0)^2 + dot(x1)^2 + dot(y1)^2) / 2 - k * (sqrt((x1 - x0)^2 + (y1 - y0)^2) - 1)^2 / 2;"
        ),
    );
}

#[test]
fn a_rigid_pendulum() {
    equal(
        "const arm = [0, 0.2, -1]; param g = 9.81, J[3][3] = [[3, 0.1, 0.2], [0.1, 2, 0.3], [0.2, 0.3, 1]]; coord θ, φ;
         let R = [[cos(φ), -sin(φ), 0], [sin(φ), cos(φ), 0], [0, 0, 1]] * [[1, 0, 0], [0, cos(θ), -sin(θ)], [0, sin(θ), cos(θ)]];
         let ω = [dot(θ), sin(θ) * dot(φ), cos(θ) * dot(φ)];
         let a = dot(θ), b = sin(θ) * dot(φ), c = cos(θ) * dot(φ);",
        "g * (dot(θ)^2 + dot(φ)^2) + sum(i in 0..3, j in 0..3, J[i][j]) * θ",
        &[
            (
                "ω * J * ω / 2",
                "(a * J[0][0] + b * J[1][0] + c * J[2][0]) * a / 2 + (a * J[0][1] + b * J[1][1] + c * J[2][1]) * b / 2 \
                 + (a * J[0][2] + b * J[1][2] + c * J[2][2]) * c / 2",
            ),
            ("[0, 0, g] * R * arm", "g * sin(θ) / 5 - g * cos(θ)"),
            ("arm * transpose(R) * [1, 0, 0]", "-sin(φ) * cos(θ) / 5 - sin(φ) * sin(θ)"),
        ],
    );
}

#[test]
fn every_operation() {
    let pairs = [
        ("d * d", "((r[1][0] - r[0][0])^2 + (r[1][1] - r[0][1])^2)"),
        ("norm(d)", "sqrt((r[1][0] - r[0][0])^2 + (r[1][1] - r[0][1])^2)"),
        ("cross(r[0], r[1])", "(r[0][0] * r[1][1] - r[0][1] * r[1][0])"),
        (
            "cross([x, y, 1], u) * [2, 3, 5]",
            "((y * u[2] - u[1]) * 2 + (u[0] - x * u[2]) * 3 + (x * u[1] - y * u[0]) * 5)",
        ),
        ("(r[0] * r[1]) * (r[2] * w)", "(r[0][0] * r[1][0] + r[0][1] * r[1][1]) * (r[2][0] * w[0] + r[2][1] * w[1])"),
        // From left to right: a number times a vector times a vector.
        ("r[0] * r[1] * r[2] * w", "(r[0][0] * r[1][0] + r[0][1] * r[1][1]) * (r[2][0] * w[0] + r[2][1] * w[1])"),
        ("w * K * r[2]", "((w[0] * K[0][0] + w[1] * K[1][0]) * r[2][0] + (w[0] * K[0][1] + w[1] * K[1][1]) * r[2][1])"),
        (
            "w * (K * r[2])",
            "(w[0] * (K[0][0] * r[2][0] + K[0][1] * r[2][1]) + w[1] * (K[1][0] * r[2][0] + K[1][1] * r[2][1]))",
        ),
        ("(K * A * s) * w", "(K[0][0] * -2 + K[0][1] * -4) * w[0] + (K[1][0] * -2 + K[1][1] * -4) * w[1]"),
        ("(s * A / 2) * -w", "(4 * w[0] + 5 * w[1]) / 2"),
        ("transpose([w, r[0]]) * s * [x, y]", "((w[0] - 2 * r[0][0]) * x + (w[1] - 2 * r[0][1]) * y)"),
        ("(R * r[0]) * [1, 0]", "(cos(x) * r[0][0] - sin(x) * r[0][1])"),
        ("R[1] * r[0] + R[0][1]", "(sin(x) * r[0][0] + cos(x) * r[0][1]) - sin(x)"),
        (
            "dot(R) * r[0] * w",
            "(((-sin(x) * dot(x)) * r[0][0] - cos(x) * dot(x) * r[0][1]) * w[0] + (cos(x) * dot(x) * r[0][0] - sin(x) * dot(x) * r[0][1]) * w[1])",
        ),
        (
            "dot(d) * dot(r[0])",
            "((dot(r[1][0]) - dot(r[0][0])) * dot(r[0][0]) + (dot(r[1][1]) - dot(r[0][1])) * dot(r[0][1]))",
        ),
        ("sum(i in 0..3, r[i]) * w", "((r[0][0] + r[1][0] + r[2][0]) * w[0] + (r[0][1] + r[1][1] + r[2][1]) * w[1])"),
        // A sum over an empty range is the zero of every shape.
        (
            "sum(i in 0..3, (r[i] + sum(j in 0..i, r[j])) * w)",
            "((r[0][0] * w[0] + r[0][1] * w[1]) + ((r[1][0] + r[0][0]) * w[0] + (r[1][1] + r[0][1]) * w[1]) + ((r[2][0] + r[0][0] + r[1][0]) * w[0] + (r[2][1] + r[0][1] + r[1][1]) * w[1]))",
        ),
        ("[1, 0, 2] * r * w", "((r[0][0] + 2 * r[2][0]) * w[0] + (r[0][1] + 2 * r[2][1]) * w[1])"),
        ("sum(i in 0..3, j in i..3, k in j..3, i * j * k * x)", "(1 + 2 + 4 + 8) * x"),
        ("A[1] * A[0]", "3"),
        ("x * s + w / y", "[x + w[0] / y, w[1] / y - 2 * x]"),
        ("K + 2 * A - [[x, 0], [0, x]]", "[[K[0][0] - x, K[0][1] + 2], [K[1][0] + 4, K[1][1] + 6 - x]]"),
        ("r[2]", "[r[2][0], r[2][1]]"),
        ("-r", "[-r[0], -r[1], -r[2]]"),
    ];
    let body = "param m = 2, K[2][2] = [[1, 2], [3, 4]], w[2] = [5, 6], u[3] = 7; const s = [1, -2], A[2][2] = [[0, 1], [2, 3]];
        coord r[3][2], x, y; let d = r[1] - r[0]; let R = [[cos(x), -sin(x)], [sin(x), cos(x)]];";
    let lagrangian = "sum(i in 0..3, j in 0..2, dot(r[i][j])^2) + dot(x)^2 + dot(y)^2 \
        + m * (x + sum(i in 0..2, w[i] + sum(j in 0..2, K[i][j])) + u[2])";
    // A matrix times itself is a matrix: its entries are compared one by one.
    let as_entries = |(left, right): (&'static str, &'static str)| match left {
        "K + 2 * A - [[x, 0], [0, x]]" | "-r" => (
            format!("[1, x] * ({}) * [y, 3]", left.replace("-r", "(-[r[0], r[1]])")),
            format!("[1, x] * {} * [y, 3]", right.replace(", -r[2]", "")),
        ),
        _ => (left.to_owned(), right.to_owned()),
    };
    let pairs: Vec<(String, String)> = pairs.into_iter().map(as_entries).collect();
    let pairs: Vec<(&str, &str)> = pairs.iter().map(|(left, right)| (left.as_str(), right.as_str())).collect();
    equal(body, lagrangian, &pairs);
}

/// A declared name means what it declares.
#[test]
fn the_new_names_are_not_reserved() {
    same(
        20,
        "param norm = 2, cross = 3; coord transpose; L = norm * dot(transpose)^2 - cross * transpose^2;",
        "param norm = 2, cross = 3; coord transpose; let q = transpose; L = norm * dot(q)^2 - cross * q^2;",
    );
}

/// The forms that forces, constants, parameters, `let`s and checks take.
#[test]
fn the_forms_of_clauses() {
    same(
        20,
        "param k = 2; coord r[2][2], q[3]; L = sum(i in 0..2, dot(r[i]) * dot(r[i])) + dot(q) * dot(q);
         force r[i in 0..2] = [i, -k * r[i][1]]; force q = -k * q;",
        "param k = 2; coord r[2][2], q[3]; L = sum(i in 0..2, j in 0..2, dot(r[i][j])^2) + sum(i in 0..3, dot(q[i])^2);
         force r[0][0] = 0; force r[0][1] = -k * r[0][1]; force r[1][0] = 1; force r[1][1] = -k * r[1][1];
         force q[i in 0..3] = -k * q[i];",
    );
    same(
        20,
        "coord r[2][2]; L = sum(i in 0..2, dot(r[i]) * dot(r[i])); force r = [[1, 2], [3, 4]] * r;",
        "coord r[2][2]; L = sum(i in 0..2, j in 0..2, dot(r[i][j])^2);
         force r[0][j in 0..2] = r[0][j] + 2 * r[1][j]; force r[1][j in 0..2] = 3 * r[0][j] + 4 * r[1][j];",
    );
    let Derived { model, .. } = derived(
        "const s[2] = 3, l[3] = [1, 2, 3]; param K[2][3] = 2 * [[1, 2, 3], [4, 5, 6]], m[2][2] = s[1], c = l[2];
         coord r[2][3], x; L = m[0][0] * c * dot(x)^2 + sum(i in 0..2, dot(r[i]) * dot(r[i])) - K[1][2] * x;
         check { r[0] = [1, 0, 0], r[1] = l, dot(r[0]) = [0, 1, 0], dot(r[1][2]) = 9, K = [[0, 0, 0], [0, 0, 7]], m[i in 0..2] = [i, 5]; h = 0.1; }",
    );
    let parameters: Vec<(String, f64)> =
        model.parameters.iter().map(|parameter| (parameter.text(), parameter.default)).collect();
    let names = ["K[0][0]", "K[0][1]", "K[0][2]", "K[1][0]", "K[1][1]", "K[1][2]"];
    for (index, name) in (1_u8..).zip(names) {
        assert_eq!(parameters[usize::from(index) - 1], (name.to_owned(), 2.0 * f64::from(index)));
    }
    assert_eq!(parameters[6..8], [("m[0][0]".to_owned(), 3.0), ("m[0][1]".to_owned(), 3.0)]);
    assert_eq!(model.parameters[9].ident(), "m_1_1");
    let state = model.check_state.expect("a check");
    assert_eq!(state.q, [1.0, 0.0, 0.0, 1.0, 2.0, 3.0, 0.0]);
    assert_eq!(state.v, [0.0, 1.0, 0.0, 0.0, 0.0, 9.0, 0.0]);
    assert_eq!(state.parameters[5..], [(5, 7.0), (6, 0.0), (7, 5.0), (8, 1.0), (9, 5.0)]);
}
