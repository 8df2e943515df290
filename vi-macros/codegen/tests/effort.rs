//! Systems that grow fast: refused when so much was done, not after minutes or gigabytes. What is done is counted, so that the same
//! system always ends in the same way.

use crate::families;
use vi_codegen::syntax;

/// What the compiler says of a system with these clauses.
fn said(clauses: &str) -> String {
    let tokens = format!("struct System {{ {clauses} discretize midpoint; }}").parse().expect("tokens");
    vi_codegen::expand(tokens).to_string()
}

/// Systems that grow fast are refused when so much was done, not after minutes or gigabytes.
#[test]
fn what_grows_fast_is_refused() {
    let chain = |first: &str, count: usize, next: fn(usize) -> String| {
        (1..count).fold(format!("let a0 = {first};"), |lets, i| lets + &next(i))
    };
    let sums = "sum(i in 0..256, dot(q[i])^2)";
    let join = |count: usize, factor: fn(usize) -> String| (1..count).map(factor).collect::<Vec<_>>().join(" * ");
    let of_x = [
        format!("L = dot(x)^2 + {};", join(400, |i| format!("(x + {i} + sin(x + {i}))"))),
        format!("{} L = dot(x)^2 + a199;", chain("dot(x)", 200, |i| format!("let a{i} = sinh(a{});", i - 1))),
        format!("{} L = dot(x)^2 + c9999 * x;", chain("1", 10_000, |i| format!("const c{i} = sin(c{}) + 1;", i - 1)))
            .replace("let a0", "const c0"),
        "L = dot(x)^2 + sum(i in 1..16000, 1 / i) * x;".to_owned(),
        "L = dot(x)^2 + sum(i in 0..1000000000, sum(j in 0..0, x));".to_owned(),
    ];
    let of_many = [
        format!("L = {sums} - sum(i in 0..256, q[i])^4;"),
        format!("L = {sums} + sum(i in 0..256, dot(q[i]))^2;"),
        format!("L = {sums} - sum(i in 0..256, sum(j in 0..256, cos(q[i] - q[j])));"),
    ];
    let of_x = of_x.iter().map(|clauses| format!("coord x; {clauses}"));
    let of_many = of_many.iter().map(|clauses| format!("coord q[256]; {clauses}"));
    for clauses in of_x.chain(of_many) {
        let said = said(&clauses);
        let refused = ["the system grows over ", "the system takes more than 40000000 steps of algebra"]
            .map(|message| said.matches(message).count());
        assert_eq!(refused.iter().sum::<usize>(), 1, "{clauses:.200}: {said:.200}");
        assert_eq!(said.matches("compile_error").count(), 1, "{clauses:.200}: {said:.600}");
    }
}

#[test]
fn what_is_large_and_simple_passes() {
    for clauses in [
        "L = dot(x)^2 + 1 / 3^100000 * x;",
        "L = dot(x)^2 + (1/3)^2000 * (1/7)^1000 * x;",
        "L = dot(x)^2 + (1 + x + sin(x))^1000000000;",
        "L = dot(x)^2 + x^(123456789123456789/987654321987654321);",
        "L = dot(x)^2 + sum(i in 0..40000, i) * x;",
        "L = dot(x)^2 + sinh(sinh(sinh(sinh(sinh(sinh(sinh(sinh(sinh(sinh(x))))))))));",
    ] {
        let said = said(&format!("coord x; {clauses}"));
        assert!(!said.contains("compile_error"), "{clauses}: {said:.200}");
    }
    for clauses in
        ["L = dot(x)^2 + 2^2^2^2^2 * x;", "L = dot(x)^2 + x^9^9^9;", "L = dot(x)^2 + exp(exp(exp(exp(1)))) * x;"]
    {
        let tokens = format!("struct System {{ coord x; {clauses} discretize midpoint; }}").parse().expect("tokens");
        let said = vi_codegen::expand(tokens).to_string();
        assert!(said.contains("the equations have a coefficient outside the range of `f64`"), "{clauses}: {said:.200}");
    }
}

/// Chains and pendula, which pass, do so with work to spare: of the chain that which grows with its length, of the pendulum that which
/// grows with its pairs.
#[test]
fn the_work_of_families_is_pinned() {
    let work = |text: String| {
        let system = syntax::parse::system(text.parse().expect("tokens")).expect("a right system");
        vi_codegen::derive(&system).expect("a right system").own.pool.work()
    };
    for (length, limit) in [(16, 3_000_000), (64, 9_000_000)] {
        let work = work(families::chain(length));
        println!("chain of {length}: {work}");
        // Measured: 2.5 and 8.0 million.
        assert!(work < limit, "a chain of {length} takes {work}");
    }
    for (links, limit) in [(4, 1_200_000), (8, 3_500_000)] {
        let work = work(families::pendulum(links));
        println!("pendulum of {links}: {work}");
        // Measured: 1.0 and 2.9 million.
        assert!(work < limit, "a pendulum of {links} takes {work}");
    }
}
