//! A system has the functions that its clause `discretize` requests.

use vi_codegen::program::FunctionId;
use vi_codegen::syntax::parse;
use vi_codegen::{Derivations, derive, items, text};

/// A force, a time scale, a cyclic coordinate and a check: everything that can be emitted.
const BODY: &str =
    "param m = 1.5, c = 0.1; coord r, φ; L = m * (dot(r)^2 + r^2 * dot(φ)^2) / 2 + sin(t) / r; force r = -c * dot(r);
    time_scale = r^(3/2); check { r = 1, dot(φ) = 1; h = 0.05; }";

fn derived(discretize: &str) -> Derivations {
    let system = format!("struct System {{ {BODY} {discretize} }}").parse().expect("tokens");
    derive(&parse::system(system).expect("a system")).unwrap_or_else(|error| panic!("{discretize}: {error}"))
}

fn emitted(discretize: &str) -> String {
    items(&derived(discretize)).to_string()
}

#[test]
fn without_a_rule_the_functions_of_gauss_steps_are_emitted() {
    let gauss = emitted("");
    for what in ["Lagrangian", "Motion", "TimeScale", "Convertible", "Parameters", "gauss_order", "gauss_momenta"] {
        assert!(gauss.contains(what), "{what}");
    }
    for what in ["FixedStepping", "EnergyStepping", "DiscreteLagrangian", "Discretized", "Batch", "step_density", "ld"]
    {
        assert!(!gauss.split(' ').any(|word| word == what), "{what}");
    }
    // A force destroys the symplectic form.
    assert!(!gauss.contains("gauss_symplecticity"));
    assert_eq!(gauss, emitted("discretize gauss;"));
}

#[test]
fn a_rule_implies_gauss() {
    for rule in ["midpoint", "trapezoidal", "midpoint, trapezoidal"] {
        let alone = emitted(&format!("discretize {rule};"));
        assert_eq!(alone, emitted(&format!("discretize gauss, {rule};")));
        assert_eq!(alone, emitted(&format!("discretize {rule}, gauss;")));
    }
    assert!(emitted("discretize { Ld = h * L(t0, q0, (q1 - q0)/h); }").contains("FixedStepping"));
    assert!(emitted("discretize midpoint;").contains("step_density"));
    assert!(!emitted("discretize trapezoidal;").contains("step_density"));
}

#[test]
fn a_rule_does_not_change_the_functions_of_the_motion() {
    let (alone, by_rule) = (derived(""), derived("discretize midpoint;"));
    assert!(alone.own.program.by_rule().next().is_none());
    let mut seen = 0;
    for function in &alone.own.program.continuous {
        let with_rule = by_rule.own.program.function(function.id).expect("the same function");
        assert_eq!(function.operation_count(), with_rule.operation_count(), "{}", function.id.name());
        seen += usize::from(function.operation_count() > 0);
    }
    assert!(seen > 8, "{seen}");
    assert!(by_rule.own.program.function(FunctionId::StepDensity).is_some());
}

#[test]
fn the_text_of_a_file_starts_with_the_cost_of_each_method() {
    let gauss = text(&derived("")).expect("Rust");
    let lines: Vec<&str> = gauss.lines().collect();
    assert!(lines[0].starts_with("// `System`: L = "), "{}", lines[0]);
    assert_eq!(lines[2], "// Operation counts by method");
    let counted = |text: &str, of: &str| -> usize {
        let line = text.lines().find(|line| line.contains(of)).unwrap_or_else(|| panic!("{of}: {text}"));
        let (all, each) = line.split_once(':').expect("methods and functions");
        let sum = each.split(", ").map(|each| each.rsplit(' ').next().and_then(|count| count.parse::<usize>().ok()));
        let sum: usize = sum.map(|count| count.expect("a number")).sum();
        assert_eq!(all.split_whitespace().nth(1).and_then(|count| count.parse().ok()), Some(sum), "{line}");
        sum
    };
    assert!(counted(&gauss, "Gauss, EnergyPreservingGauss") > 10);
    assert!(counted(&gauss, "Gauss in transformed time") > 10);
    assert!(
        gauss.contains("//      0  FixedStep, Composition, Ensemble, EnergyPreserving: write `discretize midpoint;`")
    );
    let both = text(&derived("discretize midpoint, trapezoidal;")).expect("Rust");
    assert!(counted(&both, "EnergyPreserving by the rule `midpoint`") > 10);
    assert!(counted(&both, "Ensemble by the rule `trapezoidal`") > 10);
    assert!(!both.contains("EnergyPreserving by the rule `trapezoidal`") && !both.contains("//      0"));
    // The names of the scope come last.
    let place = |what: &str| both.find(what).expect("a part");
    assert!(place("impl ::core::default::Default") < place("use ::core::convert"));
}

#[test]
fn an_input_is_a_parameter_with_a_place_in_a_list() {
    let rest = "coord x; L = k * dot(x)^2 / 2; force x = u[0] - w * u[1] * x; check { u[1] = 0.5; h = 0.1; }";
    let text = |declared: &str| {
        let system = format!("struct System {{ {declared} {rest} }}").parse().expect("tokens");
        items(&derive(&parse::system(system).expect("a system")).expect("a system without mistakes")).to_string()
    };
    let inputs = text("input u[2] = 0; param k = 2; input w = 0.5;");
    let parameters = text("param u[2] = 0; param k = 2; param w = 0.5;");
    let documented = [
        ("\" Inputs `u[0]` to `u[1]`, each 0 by default.\"", "\" Parameters `u[0]` to `u[1]`, each 0 by default.\""),
        ("\" Input `w`, 0.5 by default.\"", "\" Parameter `w`, 0.5 by default.\""),
    ];
    // Its place, its documentation, and 1 in the checks: otherwise it is a parameter.
    let list = "const INPUTS : & 'static [:: core :: primitive :: usize] = & [0 , 1 , 3] ; ";
    let ones = ["system . u [0] = 1.0 ;", "system . w = 1.0 ;"];
    assert!(inputs.contains(list), "{inputs}");
    let mut same = inputs.replace(list, "");
    for (of_input, of_parameter) in documented {
        assert!(same.contains(of_input), "{of_input}: {inputs}");
        same = same.replace(of_input, of_parameter);
    }
    for one in ones {
        assert!(same.contains(one), "{one}: {}", same.split_once("fn system ()").expect("the system of the checks").1);
        same = same.replace(&format!("{one} "), "");
    }
    assert_eq!(same, parameters);
    assert!(!parameters.contains("INPUTS"));
}

#[test]
fn what_integrators_ask_of_a_system_is_known() {
    let of = |clauses: &str| {
        let text = format!("struct S {{ coord x; {clauses} }}");
        let found = vi_codegen::inspect::properties(text.parse().expect("tokens")).expect("a system");
        (found.is_separable, found.has_step_density)
    };
    assert_eq!(of("L = dot(x)^2 / 2 - x^4; discretize midpoint;"), (true, true));
    assert_eq!(of("L = dot(x)^2 / 2 - x^4; discretize gauss, trapezoidal, midpoint;"), (true, false));
    assert_eq!(of("L = (1 + x^2) * dot(x)^2 / 2;"), (false, false));
    assert_eq!(
        of("L = dot(x)^2 / 2; force x = -dot(x); discretize { Ld = h * L(t0, q0, (q1 - q0) / h); }"),
        (false, true)
    );
}
