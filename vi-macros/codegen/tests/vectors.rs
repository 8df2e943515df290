//! Vectors, matrices, arrays of arrays and recursion: systems written with them against the same systems written out.

use vi_codegen::{Derived, derive, syntax::parse};

/// A derived system.
fn derived(body: &str) -> Derived {
    let text = format!("struct System {{ {body} discretize midpoint; }}");
    let system = parse::system(text.parse().expect("tokens")).unwrap_or_else(|error| panic!("{text}: {error}"));
    derive(&system).unwrap_or_else(|error| panic!("{text}: {error}")).own
}

/// L and the forces as text.
fn rendered(body: &str) -> Vec<String> {
    let Derived { pool, model, .. } = derived(body);
    let all = [model.lagrangian].into_iter().chain(model.forces.iter().copied());
    all.map(|expr| pool.render(expr, &|symbol| model.spell(symbol))).collect()
}

/// Both bodies give the same L and forces.
fn same(vectors: &str, written_out: &str) {
    let (one, other) = (rendered(vectors), rendered(written_out));
    assert!(one[0].len() > 10, "{one:?}");
    assert_eq!(one, other, "{vectors}\n{written_out}");
}

#[test]
fn probe() {
    same(
        "const N = 3; param m[N] = 1, G = 1; coord r[N][3];
         L = sum(i in 0..N, m[i] * dot(r[i]) * dot(r[i]) / 2) + sum(i in 0..N, j in 0..i, G * m[i] * m[j] / norm(r[i] - r[j]));",
        "const N = 3; param m[N] = 1, G = 1; coord r[N][3];
         L = sum(i in 0..N, m[i] * (dot(r[i][0])^2 + dot(r[i][1])^2 + dot(r[i][2])^2) / 2)
           + sum(i in 0..N, sum(j in 0..i, G * m[i] * m[j] / sqrt((r[i][0] - r[j][0])^2 + (r[i][1] - r[j][1])^2 + (r[i][2] - r[j][2])^2)));",
    );
}
