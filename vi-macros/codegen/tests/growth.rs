//! The text of a large system does not grow with the lengths of its arrays, and its operations are counted.

use crate::families::{bodies, links};
use vi_codegen::Compiled;
use vi_codegen::indexed::{Indexed, Nest};
use vi_codegen::syntax::{Space, parse};

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

/// Links whose last one is held at a point.
fn closed(count: usize) -> String {
    format!(
        "pub struct System {{
            const N = {count};
            param m[N] = 1.0, l[N] = 0.3, g = 9.81, d = 0.7;
            coord q[N];
            let x[0] = l[0] * sin(q[0]);
            let x[i in 1..N] = x[i - 1] + l[i] * sin(q[i]);
            let y[i in 0..N] = -sum(j in 0..i + 1, l[j] * cos(q[j]));
            L = sum(i in 0..N, m[i] * (dot(x[i])^2 + dot(y[i])^2) / 2 - m[i] * g * y[i]);
            constraint level = x[N - 1] - d * N * l[0];
            constraint height = y[N - 1];
        }}"
    )
}

/// Links by angles relative to the link before, modulo 2π, with two rules.
fn joints(count: usize) -> String {
    format!(
        "pub struct System {{
            const N = {count};
            param m[N] = 1.0, l[N] = 0.3, g = 9.81;
            angle q[N];
            let a[0] = q[0];
            let a[i in 1..N] = a[i - 1] + q[i];
            let x[i in 0..N] = sum(j in 0..i + 1, l[j] * sin(a[j]));
            let y[i in 0..N] = -sum(j in 0..i + 1, l[j] * cos(a[j]));
            L = sum(i in 0..N, m[i] * (dot(x[i])^2 + dot(y[i])^2) / 2 - m[i] * g * y[i]);
            discretize trapezoidal, midpoint;
        }}"
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
    for system in [bodies, links, pendulum, closed, joints] {
        let [few, more, most] = [32, 40, 80].map(|count| functions(&system(count)));
        assert!(few.0.len() > 2000, "{}", few.0.len());
        assert_eq!(few.0, more.0);
        assert_eq!(few.0, most.0);
        println!("{} {} {} lines", few.1, more.1, most.1);
        // Measured: 1889 at most, of 80 closed links: one line for each coordinate and two for each parameter.
        assert!(most.1 < 2000);
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

/// Whether a system of which loops are asked for is in loops; an error is none.
fn is_in_loops(clauses: &str) -> bool {
    let text = format!("#[vi_limit(0)] struct S {{ const N = 6; {clauses} discretize midpoint; }}");
    let system = parse::system(text.parse().expect("tokens")).unwrap_or_else(|error| panic!("{text}: {error}"));
    matches!(Compiled::of(&system), Ok(Compiled::Loops(_)))
}

#[test]
fn each_rule_and_angles_are_in_loops() {
    let rules = |text: &str| large(text).rules.iter().map(|rule| rule.name).collect::<Vec<_>>();
    assert_eq!(rules(&joints(20)), ["trapezoidal", "midpoint"]);
    assert_eq!(rules(&links(20).replace("discretize midpoint", "discretize gauss, trapezoidal")), ["trapezoidal"]);
    // An angle is reduced although no entry of `a` has a period.
    assert!(large(&joints(20)).model.coordinates.iter().all(|of| of.space == Space::Circle));
    let message = |text: &str| {
        let system = parse::system(text.parse().expect("tokens")).expect("a system");
        Compiled::of(&system).err().map(|error| error.to_string()).unwrap_or_default()
    };
    // A turn of the first link changes the signs of all x: that of another one is noticed.
    let found = message(&joints(20).replace("sin(a[j])", "sin(a[j] / 2)"));
    assert!(found.starts_with("`L` is not periodic in the angle `q[1]`"), "{found}");
    // Explicit steps need masses that are constant.
    let code = |text: &str| vi_codegen::expand(text.parse().expect("tokens")).to_string();
    let constant = "jacobian (diagonal)";
    assert!(code(&bodies(20).replace("midpoint", "trapezoidal")).contains(constant));
    assert!(!code(&bodies(20)).contains(constant) && !code(&joints(20)).contains(constant));
}

#[test]
fn a_time_scale_is_a_function_of_sums() {
    let of = |scale: &str| {
        let pairs = "let V = sum(i in 0..N, sum(j in 0..i, m[i] * m[j] / norm(r[i] - r[j])));";
        let text = bodies(20).replace("discretize midpoint", &format!("{pairs} time_scale = {scale}"));
        large(&text).scale.map(|scale| (scale.count, scale.parts.len()))
    };
    assert_eq!(of("V^(-3/2)"), Some((1, 1)));
    assert_eq!(of("2 + cos(r[0][1])"), Some((0, 0)));
    // One part of two bodies: pairs, and squares.
    assert_eq!(of("1 / (V + sum(i in 0..N, r[i] * r[i]))"), Some((1, 2)));
    // Pairs, squares and a constant.
    assert_eq!(of("1 + V^(-3/2)"), Some((1, 1)));
    assert_eq!(of("sqrt(V^3 + ln(2 + sum(i in 0..N, r[i] * r[i]))) + 1 / V"), Some((2, 3)));
}

#[test]
fn mistakes_in_dissipations_of_recursions_are_found() {
    let of = |dissipation: &str| {
        let text = links(20).replace("discretize", &format!("dissipation = {dissipation}; discretize"));
        let system = parse::system(text.parse().expect("tokens")).expect("a system");
        Compiled::of(&system).err().map(|error| error.to_string()).unwrap_or_default()
    };
    assert_eq!(of("sum(i in 0..N, dot(x[i])^2 + dot(y[i])^4)"), "");
    let feeding = of("sum(i in 0..N, dot(x[i])^2) - 2 * sum(i in 0..N, dot(x[i])^2)");
    assert!(feeding.starts_with("`dissipation` adds energy"), "{feeding}");
    let constant = of("sum(i in 0..N, dot(x[i])^2) + dot(q[3])");
    assert!(constant.starts_with("a term of `dissipation` is linear"), "{constant}");
    let none = of("sum(i in 0..N, x[i]^2)");
    assert!(none.starts_with("`dissipation` does not depend on any velocity"), "{none}");
}

#[test]
fn rotations_are_in_loops_where_lines_end() {
    let needles = |count: usize| {
        format!(
            "pub struct System {{ const N = {count}; param J[3] = [1, 2, 3]; rotation R[N];
             let ω[i in 0..N] = rate(R[i]); let n[i in 0..N] = turn(R[i], [0, 0, 1]);
             L = sum(i in 0..N, J[0] * ω[i][0]^2 + J[1] * ω[i][1]^2 + J[2] * ω[i][2]^2) / 2
                 + sum(i in 0..N, sum(j in 0..i, n[i] * n[j])); }}"
        )
    };
    let system = parse::system(needles(4).parse().expect("tokens")).expect("a system");
    assert!(matches!(Compiled::of(&system), Ok(Compiled::Lines(_))));
    assert_eq!(large(&needles(40)).constraints.len(), 2);
}

#[test]
fn what_loops_cannot_hold_stays_in_lines() {
    let kinetic = "coord q[N]; L = sum(i in 0..N, dot(q[i])^2) / 2";
    assert!(is_in_loops(&format!("{kinetic} - sum(i in 0..N, q[i]^4);")));
    let friction = "; let s[i in 1..N] = q[i] - q[i - 1]; dissipation = sum(i in 0..N, dot(q[i])^2) + sum(i in 1..N, dot(s[i])^2);";
    assert!(is_in_loops(&format!("{kinetic} {friction}")));
    for rest in [
        // A number beyond 32 bits.
        "; const c[6] = [0.1234567890123456, 0.3, 0.77, -0.123, 1, 2]; force q[i in 0..N] = -c[i] * q[i]^3;",
        // Arrays that read each other.
        "- x[5]^2 - y[5]^2; let x[0] = q[0]; let y[0] = q[1]; let x[1] = x[0] * y[0]; let y[1] = x[1] + q[2]; let x[2] = y[1]; \
         let x[3] = x[2]; let x[4] = x[3]; let x[5] = x[4] + q[5]; let y[2] = 1; let y[3] = 1; let y[4] = 1; let y[5] = y[4] * x[5];",
        // A root that begins where an entry is zero.
        "- sum(i in 1..N, o[i]^(5/2)); let o[i in 1..N] = (abs(q[i] - q[i - 1]) + q[i] - q[i - 1]) / 2;",
        // An acceleration.
        "+ sum(i in 0..N, dot(w[i])^2); let w[i in 0..N] = dot(q[i]);",
        // A jump.
        "- sum(i in 0..N, e[i] * q[i]); let e[i in 0..N] = if q[i] > 0 { 1 } else { 0 };",
        // Without a value in any state.
        "- sum(i in 0..N, ln(e[i] - q[i])); let e[i in 0..N] = q[i];",
        "; let e[i in 0..N] = q[i]; force q[i in 0..N] = sqrt(e[i] - q[i] - 1);",
        "- sum(i in 0..N, 1e-200 * q[i]^2 * 1e-200);",
    ] {
        assert!(!is_in_loops(&format!("{kinetic} {rest}")), "{rest}");
    }
    // A constraint may determine a coordinate without mass.
    let massless = "coord q[N], z; L = sum(i in 0..N, dot(q[i])^2) / 2 - z^2 * sum(i in 0..N, q[i]^2)";
    let text = format!("#[vi_limit(0)] struct S {{ const N = 6; {massless}; constraint c = z - q[0]; }}");
    assert!(large(&text).constraints.len() == 2, "{text}");
    // A velocity in a time scale, a mass by the dissipation alone, and a time scale that is negative.
    let sums = "let s[0] = dot(q[0]); let s[i in 1..N] = s[i - 1] + dot(q[i]);";
    assert!(!is_in_loops(&format!("{kinetic}; {sums} time_scale = 1 + s[5]^2;")));
    let lost =
        "let s[0] = q[0] + z[0]; let s[i in 1..N] = s[i - 1] + q[i] + z[i]; dissipation = sum(i in 0..N, dot(s[i])^2);";
    assert!(!is_in_loops(&format!("coord z[N]; {kinetic} - sum(i in 0..N, z[i]^2); {lost}")));
    let negative = "let s[0] = 0; let s[i in 1..N] = s[i - 1] - 1;";
    assert!(!is_in_loops(&format!("{kinetic}; {negative} time_scale = s[5];")));
    // Without a mass.
    assert!(!is_in_loops("coord q[N], z; L = sum(i in 0..N, dot(q[i])^2) / 2 - z^2 * sum(i in 0..N, q[i]^2);"));
    assert!(!is_in_loops("coord q[N]; L = sum(i in 0..N, q[i]^2);"));
    assert!(!is_in_loops("coord q[N]; L = sum(i in 1..N, q[i - 1] * dot(q[i]) - q[i]^2) - q[0]^2;"));
}

#[test]
fn a_sum_that_loses_terms_is_no_recursion() {
    let tail =
        "coord q[N]; param m[N] = 1.0; let tail[i in 0..N] = 3 + sin(t) + sum(j in i..N, m[j] * (2 + cos(q[j])));
        L = sum(i in 0..N, dot(q[i])^2 / 2 - ln(tail[i]));";
    let text = format!("#[vi_limit(0)] struct S {{ const N = 6; {tail} discretize midpoint; }}");
    let system = parse::system(text.parse().expect("tokens")).expect("a system");
    if let Ok(Compiled::Loops(loops)) = Compiled::of(&system) {
        assert!(loops.indexed.recursions.is_empty());
    }
}

#[test]
fn too_many_entries_of_recursions_are_refused() {
    let arm = "struct Arm { const N = 100; param l = 1.0; coord a[N], b[N];
        let r[0] = l * [sin(a[0]) * cos(b[0]), sin(a[0]) * sin(b[0]), cos(a[0])];
        let r[i in 1..N] = r[i - 1] + l * [sin(a[i]) * cos(b[i]), sin(a[i]) * sin(b[i]), cos(a[i])];
        L = sum(i in 0..N, dot(r[i]) * dot(r[i]) / 2 - r[i][2]); discretize midpoint; }";
    let system = parse::system(arm.parse().expect("tokens")).expect("a system");
    let Err(error) = Compiled::of(&system) else { panic!("accepted") };
    let error = error.to_string();
    assert!(
        error.contains("the tangents of `r` need 1.0 MB of the stack") && error.contains("declare at most 73 entries"),
        "{error}"
    );
}

/// The first line of the message of a system of 40 links with these constraints.
fn mistake(constraints: &str) -> String {
    let text = closed(40);
    let start = text.find("constraint level").expect("a constraint");
    let text = format!("{}{constraints} }}", &text[..start]);
    let system = parse::system(text.parse().expect("tokens")).expect("a system");
    let error = Compiled::of(&system).err().unwrap_or_else(|| panic!("no message: {constraints}"));
    error.to_string().lines().next().unwrap_or_default().to_owned()
}

#[test]
fn mistakes_in_constraints_of_recursions_are_found() {
    let unused = "constraint a = x[39] - d;";
    assert_eq!(
        mistake(&format!("{unused} constraint b = 2 * x[39] - d;")),
        "the constraint `b` repeats `a` up to a factor"
    );
    assert_eq!(
        mistake("constraint a = x[39] - x[38] - l[39] * sin(q[39]) + d;"),
        "the constraint `a` contains no coordinate"
    );
    assert_eq!(
        mistake(&format!("{unused} constraint b = dot(x[3])^2;")),
        "a constraint must be linear in the velocities"
    );
}
