//! Texts: their facts, their mistakes, and what they may not contain.

use vi_core::StepError;
use vi_erased::plan::{Method, PhasePoint, Plan};
use vi_tape::System;

const DRIVEN: &str = "
    /// A driven pendulum.
    struct Driven {
        /// Mass, in kg.
        param m = 1.5;
        param l = 0.8;
        input u = 0.0;
        angle theta;
        let height = l * (1 - cos(theta));
        L = m * l^2 * dot(theta)^2 / 2 - m * 9.81 * height;
        force theta = u - 0.1 * dot(theta);
        discretize midpoint;
    }";

fn mistakes(text: &str) -> String {
    System::parse(text).err().map_or_else(String::new, |mistakes| mistakes.to_string())
}

#[test]
fn a_text_has_its_facts() {
    let mut system = System::parse(DRIVEN).expect("a system");
    assert_eq!((system.name(), system.about()), ("Driven", "A driven pendulum."));
    assert_eq!(system.coordinates(), ["theta"]);
    assert_eq!(system.parameters(), [("m", 1.5), ("l", 0.8), ("u", 0.0)]);
    assert_eq!(system.parameters_about(), ["Mass, in kg.", "", ""]);
    assert!(!system.conserves_energy() && system.constraints().is_empty());
    assert!(system.set("l", 1.0) && !system.set("k", 1.0));
    assert_eq!(system.parameters()[1], ("l", 1.0));
    // Another system of the same text begins with the defaults.
    assert_eq!(System::parse(DRIVEN).expect("a system").parameters()[1], ("l", 0.8));
}

#[test]
fn an_angle_is_reduced() {
    let system = System::parse(DRIVEN).expect("a system");
    let start = PhasePoint { t: 0.0, q: vec![1e6], v: vec![20.0] };
    let mut run = system.begin(&Plan::new(Method::Gauss, 0.01, start)).expect("a start");
    run.advance_by(100).expect("steps");
    // Without reduction the sine of 1e6 has ten digits.
    let near = PhasePoint { t: 0.0, q: vec![1e6 - 159_154.0 * core::f64::consts::TAU], v: vec![20.0] };
    let mut other = system.begin(&Plan::new(Method::Gauss, 0.01, near)).expect("a start");
    other.advance_by(100).expect("steps");
    let off = (run.p()[0] - other.p()[0]).abs();
    assert!(off < 1e-9, "{off:e}");
}

#[test]
fn a_lagrangian_of_a_file_is_found() {
    let text =
        format!("use vi_core::lagrangian;\n// A comment with L = 1.\nlagrangian! {{ {DRIVEN} }}\nfn main() {{}}");
    assert_eq!(System::parse(&text).expect("a system").name(), "Driven");
    let twice = format!("lagrangian! {{ {DRIVEN} }} lagrangian! {{ {DRIVEN} }}");
    assert!(mistakes(&twice).contains("several systems"));
}

#[test]
fn mistakes_have_their_place() {
    let text = "struct Wrong {\n    coord x;\n    L = dot(x)^2 / 2 - k * x^2;\n}";
    let found = mistakes(text);
    assert!(found.contains("definition:3:24") && found.contains('^') && found.contains("`k`"), "{found}");
    assert!(mistakes("struct Open { coord x; L = (").contains("definition:1:"));
    assert!(mistakes("").contains("error"), "{}", mistakes(""));
    let still = mistakes("struct Still { param k = 1.0; L = k; }");
    assert!(still.contains("no coordinates"), "{still}");
}

#[test]
fn each_mistake_has_its_token() {
    let each = |text: &str| System::parse(text).err().map(|found| found.each().to_vec()).unwrap_or_default();
    let found = each("struct Wrong {\n    coord θ;\n    L = dot(θ)^2 / 2 - kk * θ^2 - j;\n}");
    let tokens: Vec<_> = found.iter().map(|of| of.token.map(|at| (at.line, at.column))).collect();
    assert_eq!(tokens, [[(3, 23), (3, 25)], [(3, 34), (3, 35)]]);
    assert!(found[0].wrong.contains("`kk`") && found[0].helps.starts_with("help: "), "{found:?}");
    // An unclosed bracket is one character.
    assert_eq!(each("struct Open {")[0].token.map(|at| (at.line, at.column)), [(1, 12), (1, 12)]);
    assert!(each("lagrangian! { } lagrangian! { }").is_empty());
}

#[test]
fn nesting_is_bounded() {
    let deep = |open: &str, close: &str| {
        let (open, close) = (open.repeat(20_000), close.repeat(20_000));
        mistakes(&format!("struct S {{ coord x; L = dot(x)^2 / 2 - {open}x{close}; }}"))
    };
    for found in [deep("(", ")"), deep("sin(", ")"), deep("[", "]")] {
        assert!(found.contains("nested deeper than 100 levels"), "{found}");
    }
}

#[test]
fn what_only_the_macro_compiles_is_refused() {
    let with = |clauses: &str| format!("struct S {{ coord x, y; L = (dot(x)^2 + dot(y)^2) / 2 - y {clauses} }}");
    let found = mistakes(&with("- f(x); fn f(a) = crate::f;"));
    assert!(found.contains("crate::f") || found.contains("`f`"), "{found}");
    let needs_compiler = |text: &str| System::parse(text).err().is_some_and(|mistakes| mistakes.needs_compiler());
    assert!(needs_compiler("struct Row { coord q[9]; L = sum(i in 0..9, dot(q[i])^2 - q[i]^4) / 2; }"));
    assert!(!needs_compiler(&with("- z;")));
    let found = mistakes("struct Row { coord q[9]; L = sum(i in 0..9, dot(q[i])^2 - q[i]^4) / 2; }");
    assert!(found.contains("`Row` has 9 coordinates") && found.contains("8 at most"), "{found}");
    let found = mistakes("struct Row { param k[33] = 1.0; coord x; L = dot(x)^2 / 2 - x^4 * sum(i in 0..33, k[i]); }");
    assert!(found.contains("`Row` has 33 parameters") && found.contains("32 at most"), "{found}");
}

#[test]
fn a_state_without_a_value_is_named() {
    let system = System::parse("struct Well { coord x; L = dot(x)^2 / 2 - 1 / x; }").expect("a system");
    let start = PhasePoint { t: 0.0, q: vec![0.0], v: vec![1.0] };
    let outcome = system.begin(&Plan::new(Method::Gauss, 0.01, start)).map(|mut run| run.advance_by(3));
    let (Err(error) | Ok(Err(error))) = outcome else { panic!("a step from a pole") };
    assert!(matches!(error, StepError::NonFinite { expression: Some(_), .. }), "{error:?}");
}

#[test]
fn a_long_function_and_many_threads() {
    // More numbers at once than the stack and the kept registers hold.
    let text = "struct Long { coord x, y; L = (dot(x)^2 + dot(y)^2) / 2 - sum(i in 1..180, sin(i * x + y) * cos(i * y - x)); }";
    let system = System::parse(text).expect("a system");
    let run = |v: f64| {
        let start = PhasePoint { t: 0.0, q: vec![0.1, 0.2], v: vec![v, 0.0] };
        let mut run = system.begin(&Plan::new(Method::Gauss, 1e-4, start)).expect("a start");
        run.advance_by(5).expect("steps");
        run.row()
    };
    let alone = [run(0.5), run(-0.5)];
    let together = std::thread::scope(|scope| {
        [0.5, -0.5, 0.5, -0.5].map(|v| scope.spawn(move || run(v))).map(|thread| thread.join().expect("a run"))
    });
    assert_eq!(together, [alone[0].clone(), alone[1].clone(), alone[0].clone(), alone[1].clone()]);
    assert_ne!(alone[0], alone[1]);
}

/// N links, each hanging from the one above: the positions of all couple all.
fn links(size: usize) -> String {
    format!(
        "struct Links {{ param l = 0.7, g = 9.81; coord a[{size}];
            let x[i in 0..{size}] = sum(j in 0..i + 1, l * sin(a[j])); let y[i in 0..{size}] = sum(j in 0..i + 1, l * cos(a[j]));
            L = sum(i in 0..{size}, (dot(x[i])^2 + dot(y[i])^2) / 2 + g * y[i]); discretize midpoint; }}"
    )
}

#[test]
fn a_rule_is_derived_when_a_method_asks_for_it() {
    // The continuous equations of eight links fit, those of a step by the rule are several times as many.
    let system = System::parse(&links(8)).expect("a system");
    let at = PhasePoint { t: 0.0, q: vec![0.3; 8], v: vec![0.0; 8] };
    let end = |method, stages| {
        let mut run = system.begin(&Plan { stages, ..Plan::new(method, 1e-3, at.clone()) }).expect("a start");
        run.advance_by(20).expect("steps");
        run.q().to_vec()
    };
    let (by_rule, by_stages) = (end(Method::KahanLi6, None), end(Method::Gauss, Some(4)));
    let off = by_rule.iter().zip(&by_stages).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max);
    assert!(off < 1e-12, "{off:e}"); // 5e-15
}

#[test]
fn a_coordinate_has_any_name() {
    // Names of indices, and of coordinates that a tape adds.
    for name in ["i", "rest", "z"] {
        let text = format!("struct S {{ coord {name}; L = dot({name})^2 / 2 - {name}^2 / 2; }}");
        assert_eq!(System::parse(&text).unwrap_or_else(|error| panic!("{error}")).coordinates(), [name]);
    }
}
