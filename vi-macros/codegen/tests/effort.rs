//! Systems that grow fast are rejected after bounded work, not after minutes or gigabytes. Work is counted, so the
//! result is reproducible.

use crate::families;
use vi_codegen::syntax;

/// The message of the compiler for a system with these clauses.
fn message(clauses: &str) -> String {
    let tokens = format!("struct System {{ {clauses} discretize midpoint; }}").parse().expect("tokens");
    vi_codegen::expand(tokens).to_string()
}

/// Asserts that a fast-growing system is rejected after bounded work.
fn assert_is_refused(clauses: &str) {
    let text = message(clauses);
    let refused = ["the expanded system has more than ", "the system takes more than 56000000 steps of algebra"]
        .map(|message| text.matches(message).count());
    assert_eq!(refused.iter().sum::<usize>(), 1, "{clauses:.200}: {text:.200}");
    assert_eq!(text.matches("compile_error").count(), 1, "{clauses:.200}: {text:.600}");
}

/// Consecutive clauses, each made of the previous one.
fn chain(first: &str, count: usize, next: fn(usize) -> String) -> String {
    (1..count).fold(format!("let a0 = {first};"), |clauses, i| clauses + &next(i))
}

#[test]
fn products_that_grow_fast_are_refused() {
    let factors: Vec<String> = (1..400).map(|i| format!("(x + {i} + sin(x + {i}))")).collect();
    assert_is_refused(&format!("coord x; L = dot(x)^2 + {};", factors.join(" * ")));
}

#[test]
fn chains_that_grow_fast_are_refused() {
    let of_functions = chain("dot(x)", 200, |i| format!("let a{i} = sinh(a{});", i - 1));
    assert_is_refused(&format!("coord x; {of_functions} L = dot(x)^2 + a199;"));
}

#[test]
#[ignore = "much work: `.ci/run nightly`"]
fn constants_of_thousands_of_bits_are_refused() {
    assert_is_refused("coord x; L = dot(x)^2 + sum(i in 1..2000, sin(pi * i * sqrt(2) * sqrt(3) / sqrt(6))) * x;");
    assert_is_refused("coord x; L = dot(x)^2 + sum(i in 1..200, sin(10^1000 + i)) * x;");
}

#[test]
fn sums_that_grow_fast_are_refused() {
    assert_is_refused("coord x; L = dot(x)^2 + sum(i in 1..16000, 1 / i) * x;");
    assert_is_refused("coord x; L = dot(x)^2 + sum(i in 0..1000000000, sum(j in 0..0, x));");
}

/// Refuses 256 coordinates with a term that touches all of them.
fn many_coordinates_are_refused(term: &str) {
    assert_is_refused(&format!("coord q[256]; L = sum(i in 0..256, dot(q[i])^2) {term};"));
}

#[test]
fn a_system_of_many_coordinates_that_grows_fast_is_refused() {
    many_coordinates_are_refused("- sum(i in 0..256, q[i])^4");
}

#[test]
#[ignore = "much work: `.ci/run nightly`"]
fn systems_of_many_coordinates_that_grow_fast_are_refused() {
    many_coordinates_are_refused("+ sum(i in 0..256, dot(q[i]))^2");
    many_coordinates_are_refused("- sum(i in 0..256, sum(j in 0..256, cos(q[i] - q[j])))");
}

/// A chain of constants passes.
fn chain_of_constants_passes(length: usize) {
    let of_constants =
        chain("1", length, |i| format!("const c{i} = sin(c{}) + 1;", i - 1)).replace("let a0", "const c0");
    let text = message(&format!("coord x; {of_constants} L = dot(x)^2 + c{} * x;", length - 1));
    assert!(!text.contains("compile_error"), "{text:.200}");
}

#[test]
#[ignore = "much work: `.ci/run nightly`"]
fn chains_of_ten_thousand_constants_pass() {
    chain_of_constants_passes(10_000);
}

#[test]
fn large_simple_systems_pass() {
    chain_of_constants_passes(1000);
    for clauses in [
        "L = dot(x)^2 + 3^99800 / 3^100000 * x;",
        "L = dot(x)^2 + (1/3)^2000 * 7^1000 * x;",
        "L = dot(x)^2 + (1 + 10^-2000)^(10^2000) * x;",
        "L = dot(x)^2 + sin(sin(sin(sin(10^1000)))) * x + tanh(10^400) * x + atan(10^5000) * x + ln(10^10^9) * x;",
        "L = dot(x)^2 + sum(i in 1..100, pow(pi, sqrt(i)) * sin(i * x));",
        "L = dot(x)^2 + sum(i in 1..1000, sqrt(i) * x) + (7/3)^(1/1000000) * x^(1/1000000);",
        "L = dot(x)^2 + exp(-exp(exp(3))) * exp(exp(exp(3)) + 1) * x;",
        "L = dot(x)^2 + (1 + x + sin(x))^1000000000;",
        "L = dot(x)^2 + x^(123456789123456789/987654321987654321);",
        "L = dot(x)^2 + sum(i in 0..40000, i) * x;",
        "L = dot(x)^2 + sinh(sinh(sinh(sinh(sinh(sinh(sinh(sinh(sinh(sinh(x))))))))));",
    ] {
        let text = message(&format!("coord x; {clauses}"));
        assert!(!text.contains("compile_error"), "{clauses}: {text:.200}");
    }
    for clauses in [
        "L = dot(x)^2 + 2^2^2^2^2 * x;",
        "L = dot(x)^2 + x^9^9^9;",
        "L = dot(x)^2 + exp(exp(exp(exp(1)))) * x;",
        "L = dot(x)^2 + 1 / 3^100000 * x;",
        "L = dot(x)^2 + (1/3)^2000 * (1/7)^1000 * x;",
        "L = dot(x)^2 + exp(-800) * x;",
        "L = dot(x)^2 + (x / 1e20)^20;",
    ] {
        let tokens = format!("struct System {{ coord x; {clauses} discretize midpoint; }}").parse().expect("tokens");
        let text = vi_codegen::expand(tokens).to_string();
        assert!(
            text.contains("the equations have a coefficient outside the range of double precision"),
            "{clauses}: {text:.200}"
        );
    }
}

/// Accepted chains and pendula leave work to spare: the part of the chain that grows with its length, and the part of
/// the pendulum that grows with its pairs.
#[test]
fn the_work_of_families_is_pinned() {
    let work = |text: String| {
        let system = syntax::parse::system(text.parse().expect("tokens")).expect("a right system");
        vi_codegen::derive(&system).expect("a right system").own.pool.work()
    };
    for (length, limit) in [(16, 3_000_000), (64, 11_500_000)] {
        let work = work(families::chain(length));
        println!("chain of {length}: {work}");
        // Measured: 2.3 and 10.0 million.
        assert!(work < limit, "a chain of {length} takes {work}");
    }
    for (links, limit) in [(4, 1_200_000), (8, 4_500_000)] {
        let work = work(families::pendulum(links));
        println!("pendulum of {links}: {work}");
        // Measured: 1.0 and 3.9 million.
        assert!(work < limit, "a pendulum of {links} takes {work}");
    }
}

/// Six hinges about changing axes: the product of mass matrix and velocities has too many terms to multiply it out.
#[test]
fn the_momenta_of_an_arm_are_not_multiplied_out() {
    let arm = |rest: &str| {
        let hinge = |joint: usize| {
            let (c, s) = (format!("cos(q{joint})"), format!("sin(q{joint})"));
            let (turn, rate) = if joint.is_multiple_of(2) {
                (format!("[[{c}, -{s}, 0], [{s}, {c}, 0], [0, 0, 1]]"), format!("[0, 0, dot(q{joint})]"))
            } else {
                (format!("[[{c}, 0, {s}], [0, 1, 0], [-{s}, 0, {c}]]"), format!("[0, dot(q{joint}), 0]"))
            };
            let Some(last) = joint.checked_sub(1) else {
                return format!("let R0 = {turn}; let x0 = R0 * [0.1, 0.2, 0.3]; let w0 = {rate};");
            };
            format!(
                "let E{joint} = {turn}; let R{joint} = R{last} * E{joint};
                 let x{joint} = x{last} + R{joint} * [0.1, 0.2, 0.3];
                 let w{joint} = transpose(E{joint}) * w{last} + {rate};"
            )
        };
        let body = |joint| {
            format!(
                "dot(x{joint}) * dot(x{joint}) / 2 - x{joint}[2]
                 + w{joint} * [[2, 0.1, 0.2], [0.1, 3, 0.3], [0.2, 0.3, 4]] * w{joint}"
            )
        };
        let names = (0..6).map(|joint| format!("q{joint}")).collect::<Vec<_>>().join(", ");
        let hinges = (0..6).map(hinge).collect::<String>();
        let bodies = (0..6).map(body).collect::<Vec<_>>().join(" + ");
        let text = format!("struct Arm {{ coord {names}; {hinges} L = {bodies} {rest}; }}");
        let system = syntax::parse::system(text.parse().expect("tokens")).expect("a right system");
        vi_codegen::derive(&system).unwrap_or_else(|error| panic!("{error}")).own.system.continuous
    };
    let plain = arm("");
    assert!(plain.quadratic && plain.momentum_is_mass_times_velocity);
    let moving = arm("+ sin(q1) * dot(q0)");
    assert!(moving.quadratic && !moving.momentum_is_mass_times_velocity);
}
