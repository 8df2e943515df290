//! The text of a large system does not grow with the lengths of its arrays, and its operations are counted.

use vi_codegen::Compiled;
use vi_codegen::indexed::{Indexed, Nest};
use vi_codegen::syntax::parse;

fn bodies(count: usize) -> String {
    format!(
        "struct Bodies {{ const N = {count}; param m[N] = 1.0, G = 1.0; coord r[N][3];
         L = sum(i in 0..N, m[i] * dot(r[i]) * dot(r[i]) / 2) + sum(i in 0..N, j in 0..i, G * m[i] * m[j] / norm(r[i] - r[j]));
         discretize midpoint; }}"
    )
}

fn links(count: usize) -> String {
    format!(
        "struct Links {{ const N = {count}; param m[N] = 1.0, l[N] = 0.3, g = 9.81; coord q[N];
         let x[0] = l[0] * sin(q[0]); let x[i in 1..N] = x[i - 1] + l[i] * sin(q[i]);
         let y[i in 0..N] = -sum(j in 0..i + 1, l[j] * cos(q[j]));
         L = sum(i in 0..N, m[i] * (dot(x[i])^2 + dot(y[i])^2) / 2 - m[i] * g * y[i]);
         discretize midpoint; }}"
    )
}

/// Links by their angles alone: the factors of its terms differ.
fn pendulum(count: usize) -> String {
    format!(
        "struct Pendulum {{ const N = {count}; param m = 1.0, l = 1.0, g = 9.81; coord θ[N];
         let alone = sum(i in 0..N, (N - i) * dot(θ[i])^2) / 2;
         let pairs = sum(i in 1..N, (N - i) * sum(j in 0..i, dot(θ[i]) * dot(θ[j]) * cos(θ[i] - θ[j])));
         L = m * l^2 * (alone + pairs) + m * g * l * sum(i in 0..N, (N - i) * cos(θ[i]));
         discretize midpoint; }}"
    )
}

fn large(text: &str) -> Indexed {
    let system = parse::system(text.parse().expect("tokens")).expect("a system");
    match Compiled::of(&system).unwrap_or_else(|error| panic!("{text}: {error}")) {
        Compiled::Loops(loops) => loops.indexed,
        Compiled::Lines(_) => panic!("no loops: {text}"),
    }
}

/// The functions of the bodies and the primitives, with `#` for every number; and all lines.
fn functions(text: &str) -> (String, usize) {
    let rust = vi_codegen::expand(text.parse().expect("tokens"));
    let rust = vi_codegen::pretty::text(rust).expect("Rust");
    let implementations = rust.split("\n    impl").filter(|part| {
        let head = part.lines().next().unwrap_or_default();
        part.contains("fn lagrangian_1") || head.contains("Indexed") || part.contains("fn first_derivatives")
    });
    let mut digits = false;
    let mut kept = String::new();
    for character in implementations.collect::<Vec<_>>().join("\n").chars() {
        if !(digits && character.is_ascii_digit()) {
            kept.push(if character.is_ascii_digit() { '#' } else { character });
        }
        digits = character.is_ascii_digit();
    }
    // Longer numbers break lines elsewhere.
    (kept.split_whitespace().collect(), rust.lines().count())
}

#[test]
fn the_text_of_loops_is_the_same_for_every_length() {
    for system in [bodies, links, pendulum] {
        let [few, more, most] = [32, 40, 80].map(|count| functions(&system(count)));
        assert!(few.0.len() > 2000, "{}", few.0.len());
        assert_eq!(few.0, more.0);
        assert_eq!(few.0, most.0);
        println!("{} {} {} lines", few.1, more.1, most.1);
        // Measured: 1733 at most, of 80 bodies: one line for each coordinate and two for each parameter.
        assert!(most.1 < 2500);
    }
}

#[test]
fn operations_of_bodies_are_counted() {
    let counts = |text: &str| {
        let large = large(text);
        let rows = large.recursions.iter().flat_map(|recursion| recursion.parts.iter().map(|part| &part.body));
        let bodies = rows.chain(large.lagrangian.iter().map(|sum| &sum.body));
        let of = |function: &vi_codegen::program::Function| function.operation_count();
        bodies.map(|body| [of(&body.slopes), body.curvatures.as_ref().map_or(0, of)]).collect::<Vec<_>>()
    };
    assert_eq!(counts(&bodies(40)), [[10, 3], [32, 122]]);
    assert_eq!(counts(&links(40)), [[9, 10], [12, 11], [7, 2], [5, 2]]);
}

#[test]
fn loops_run_over_all_terms() {
    let rows = |text: &str| {
        let large = large(text);
        large.lagrangian.iter().map(|sum| sum.nests.iter().map(Nest::rows).sum::<usize>()).collect::<Vec<_>>()
    };
    let mut of_bodies = rows(&bodies(40));
    of_bodies.sort_unstable();
    assert_eq!(of_bodies, [40, 780]);
    let mut of_pendulum = rows(&pendulum(40));
    of_pendulum.sort_unstable();
    assert_eq!(of_pendulum, [40, 40, 780]);
}

#[test]
fn small_systems_and_those_that_do_not_repeat_stay_in_lines() {
    let quartic = "coord q[20]; L = sum(i in 0..20, dot(q[i])^2) / 2 - sum(i in 0..20, sum(j in 0..20, q[j]))^4;";
    let chain = "coord q[256]; L = sum(i in 0..256, dot(q[i])^2 - q[i]^2) / 2 - sum(i in 1..256, (q[i] - q[i - 1])^4);";
    for clauses in ["coord q[20]; L = sum(i in 0..20, dot(q[i])^2) / 2;", quartic, chain] {
        let text = format!("struct S {{ {clauses} discretize midpoint; }}");
        let system = parse::system(text.parse().expect("tokens")).expect("a system");
        assert!(matches!(Compiled::of(&system), Ok(Compiled::Lines(_))), "{text}");
    }
}

#[test]
fn a_system_that_lines_cannot_hold_is_in_loops() {
    // 17 links were the last in lines.
    for count in [18, 19, 24] {
        assert!(large(&links(count)).operations() > 7000);
    }
}
