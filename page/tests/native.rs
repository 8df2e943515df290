//! The examples of the page by a native build: the numbers that the browser has to find, and the facts that it shows.

use std::fmt::Write as _;
use vi_erased::plan::{Method, PhasePoint};
use vi_page::facts::{Length, Model, name};
use vi_page::motion::Motion;
use vi_page::rival::Rival;

const EXAMPLES: [(&str, &str); 4] = [
    ("pendulum", include_str!("../web/examples/pendulum.txt")),
    ("double_pendulum", include_str!("../web/examples/double_pendulum.txt")),
    ("kepler", include_str!("../web/examples/kepler.txt")),
    ("figure_eight", include_str!("../web/examples/figure_eight.txt")),
];

/// The coordinates of each example after 100 steps of each method, as the browser computes them too.
const ENDS: &str = include_str!("ends.txt");

const STEPS: u32 = 100;

/// The step of a method in these tests.
fn step(method: Method) -> f64 {
    if method == Method::Gauss { 0.05 } else { 0.01 }
}

fn model(text: &str) -> Model {
    Model::of(text).unwrap_or_else(|mistakes| panic!("{mistakes}"))
}

/// All parameters, coordinates and velocities, as the text has them.
fn numbers(of: &Model) -> Vec<f64> {
    let at = of.system.check().expect("a start");
    let parameters = of.system.parameters().into_iter().map(|(_, value)| value);
    parameters.chain(at.q.iter().copied()).chain(at.v.iter().copied()).collect()
}

fn motion(of: &Model, method: usize, length: Length) -> Motion {
    let (system, plan) = of.planned(method, length, &numbers(of)).expect("a plan");
    Motion::begin(system, &plan).expect("a run")
}

/// The lines of `ends.txt`: example, method, step, coordinates.
fn ends() -> Vec<(String, Vec<f64>)> {
    let mut lines = Vec::new();
    for (example, text) in EXAMPLES {
        let model = model(text);
        for (index, built) in model.methods().into_iter().enumerate() {
            let h = step(built.0);
            let mut motion = motion(&model, index, Length::Of(h));
            motion.advance(f64::INFINITY, STEPS, &mut Vec::new()).expect("steps");
            lines.push((format!("{example}\t{}\t{h}", name(built)), motion.q()));
        }
    }
    lines
}

#[test]
fn ends_are_those_that_the_browser_compares() {
    let found = ends();
    if std::env::var_os("UPDATE_ENDS").is_some() {
        let mut lines = String::new();
        for (of, q) in &found {
            let q: Vec<_> = q.iter().map(|q| format!("{q:?}")).collect();
            writeln!(lines, "{of}\t{}", q.join(" ")).expect("a string");
        }
        std::fs::write("tests/ends.txt", lines).expect("a file");
        return;
    }
    assert_eq!(found.len(), ENDS.lines().count());
    for ((of, q), line) in found.iter().zip(ENDS.lines()) {
        let (known, numbers) = line.rsplit_once('\t').expect("four columns");
        assert_eq!(of, known);
        for (q, known) in q.iter().zip(numbers.split(' ')) {
            let known: f64 = known.parse().expect("a number");
            assert!((q - known).abs() <= BETWEEN_PROCESSORS, "{of}: {q} is not {known}");
        }
    }
}

/// Without fused multiply-add numbers are rounded otherwise: WebAssembly differs by 3.4e-16.
const BETWEEN_PROCESSORS: f64 = 4e-16;

#[test]
fn each_example_has_the_methods_of_the_page() {
    for (example, text) in EXAMPLES {
        let names: Vec<_> = model(text).methods().into_iter().map(name).collect();
        assert_eq!(names, ["fixed", "gauss 4", "gauss 8", "energy"], "{example}");
    }
}

#[test]
fn rows_have_the_state_and_small_errors() {
    let model = model(EXAMPLES[2].1);
    for (index, most) in [(0, 3e-4), (1, 1e-13), (2, 1e-13), (3, 1e-13)] {
        let mut rows = Vec::new();
        let mut motion = motion(&model, index, Length::Of(0.01));
        motion.advance(1.0, u32::MAX, &mut rows).expect("steps");
        let stride = 1 + 2 * 2 + 2;
        assert!(rows.len().is_multiple_of(stride) && rows.len() / stride > 50, "{}", rows.len());
        for row in rows.chunks_exact(stride) {
            let at = PhasePoint { t: row[0], q: row[1..3].to_vec(), v: row[3..5].to_vec() };
            let energy = model.system.energy(&at).expect("an energy");
            // The energy of energy-preserving steps is that of their midpoint.
            if index != 3 {
                assert!((energy - motion.initial_energy - row[5]).abs() < 1e-14, "{row:?}");
            }
            assert!(row[5].abs() < most, "{row:?}");
            assert!(row[6].abs() < 1e-4, "{row:?}");
        }
    }
}

#[test]
fn a_tolerance_finds_the_step() {
    let model = model(EXAMPLES[0].1);
    let [coarse, fine] = [1e-6, 1e-12].map(|tolerance| motion(&model, 1, Length::Within(tolerance)).h());
    assert!(coarse > fine && fine > 0.0, "{coarse} {fine}");
}

#[test]
fn the_rival_has_order_four_and_as_many_evaluations() {
    let model = model(EXAMPLES[2].1);
    let start = || {
        let at = model.system.check().expect("a start");
        PhasePoint { t: 0.0, q: at.q.clone(), v: at.v.clone() }
    };
    let energy = model.system.energy(&start()).expect("an energy");
    let error = |steps: u64| {
        let mut rival = Rival::new(start());
        (rival.advance(&*model.system, 1.0, 4 * steps) - energy).abs()
    };
    // With half the step the error of a method of order 4 falls by 16: measured 17.1.
    let ratio = error(100) / error(200);
    assert!((15.0..18.0).contains(&ratio), "{ratio}");
    // In parts it takes the same number of steps.
    let mut rival = Rival::new(start());
    let in_parts = (1..=10_u32).map(|part| rival.advance(&*model.system, f64::from(part) / 10.0, u64::from(part) * 40));
    let off = (in_parts.last().expect("ten parts") - energy).abs() - error(100);
    assert!(off.abs() < 1e-12, "{off:e}");
}

#[test]
fn mistakes_have_their_tokens() {
    let Err(mistakes) = Model::of("struct S {\n    coord θ;\n    L = dot(θ)^2 / 2 - k * θ;\n}") else {
        panic!("k is unknown")
    };
    assert!(mistakes.contains(r#""from":[3,23],"to":[3,24]"#), "{mistakes}");
    // A mistake of the whole text has no token.
    let Err(mistakes) = Model::of("lagrangian! { } lagrangian! { }") else { panic!("two systems") };
    assert!(mistakes.ends_with(r#""each":[]}"#), "{mistakes}");
}

#[test]
fn facts_have_what_the_page_shows() {
    let facts =
        model("struct S {\n/// Mass, \"m\".\nparam m = 2.0; coord x; L = m * dot(x)^2 / 2; force x = 1.0; }").facts();
    let expected = r#"{"name":"S","about":"","coordinates":["x"],"parameters":[{"name":"m","about":"Mass, \"m\".","value":2.0}],"methods":["gauss 4","gauss 8"],"conserves":false,"start":{"q":[1.0],"v":[0.0]}}"#;
    assert_eq!(facts, expected);
}

#[test]
fn wrong_numbers_are_errors() {
    let model = model(EXAMPLES[0].1);
    assert!(model.planned(9, Length::Of(0.1), &numbers(&model)).is_err());
    for count in 0..5 {
        let (system, plan) = model.planned(0, Length::Of(0.1), &numbers(&model)[..count]).expect("a plan");
        assert!(Motion::begin(system, &plan).is_err(), "{count}");
    }
}
