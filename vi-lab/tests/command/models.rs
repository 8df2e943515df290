//! Two models of one motion.

use super::lab;
use super::sweep::Folder;

/// The number behind a text.
fn after(output: &str, text: &str) -> f64 {
    let (_, rest) = output.split_once(text).unwrap_or_else(|| panic!("{text} in {output}"));
    rest.split_whitespace().next().and_then(|number| number.parse().ok()).unwrap_or_else(|| panic!("{rest}"))
}

#[test]
fn a_rod_and_its_angle_move_alike() {
    let folder = Folder::new("alike", "");
    let map = ["--map", "x = l * sin(θ)", "--map", "y = -l * cos(θ)"];
    // The rod has the parameters of the angle, and its start: half as long, and turning.
    let scene = ["--set", "l=0.5", "--set", "g=9.81", "--q", "0.7", "--v", "1.1", "--until", "3"];
    let out = ["--out", &folder.at("page")];
    let arguments = [&["compare", "rod-pendulum", "pendulum"][..], &map, &scene, &out].concat();
    let (status, output, errors) = lab(&arguments);
    assert_eq!(status, Some(0), "{errors}");
    assert!(output.starts_with("pendulum beside rod-pendulum, from t = 0 to 3, 300 steps of gauss\n"), "{output}");
    for name in ["x", "y"] {
        let off = after(&output, &format!("  {name}: off by up to "));
        assert!(off > 0.0 && off < 1e-11, "{name}: {off:e}"); // 1.3e-12, 5.0e-13
    }
    let figure = folder.text("page/difference.csv");
    for name in ["x", "y"] {
        let points = figure.lines().filter(|line| line.starts_with(&format!("\"{name}\",")));
        // At the start both are equal.
        assert_eq!(points.count(), 300, "{figure}");
    }
    let costs = folder.text("page/cost.csv");
    let rows: Vec<Vec<&str>> = costs.lines().map(|line| line.split(',').collect()).collect();
    assert_eq!(rows[0], ["model", "operations at a point", "ns a step"]);
    assert_eq!([rows[1][0], rows[2][0]], ["rod-pendulum (full)", "pendulum (reduced)"]);
    assert!(rows[1..].iter().all(|row| row[1..].iter().all(|cell| cell.parse::<f64>().is_ok_and(|of| of > 0.0))));
    assert!(folder.text("page/index.html").contains("<svg"));
}

const MODEL: &str = "struct NAME { coord x; L = dot(x)^2 / 2 - x^2 / 2 TERM; check { x = 0.5; h = 0.02; } }";

#[test]
fn a_dropped_term_shows() {
    let folder = Folder::new("dropped", "");
    let full = folder.file("full.vi", &MODEL.replace("NAME", "Full").replace("TERM", "- x^4 / 40"));
    let linear = folder.file("linear.vi", &MODEL.replace("NAME", "Linear").replace("TERM", ""));
    let (status, output, errors) = lab(&["compare", &full, &linear, "--until", "20", "--out", &folder.at("page")]);
    assert_eq!(status, Some(0), "{errors}");
    // The frequency of x'' = -x - x^3/10 is 1 + 3 a^2/80 to order a^4: the phase is off by 0.19 at the end.
    let (off, wanted) = (after(&output, "  x: off by up to "), 0.5 * 20.0 * 3.0 * 0.25 / 80.0);
    assert!((off / wanted - 1.0).abs() < 0.1, "{off}"); // 0.0885
    let costs = folder.text("page/cost.csv");
    let operations = |name: &str| {
        let line = costs.lines().find(|line| line.starts_with(name)).unwrap_or_else(|| panic!("{costs}"));
        line.split(',').nth(1).and_then(|count| count.parse::<u32>().ok()).unwrap_or_else(|| panic!("{line}"))
    };
    assert!(operations("full") > operations("linear"), "{costs}");
}

#[test]
fn wrong_comparisons_are_refused() {
    let at = |arguments: &[&str]| {
        let (status, output, errors) = lab(&[&["compare"], arguments].concat());
        assert!(output.is_empty(), "{output}");
        (status, errors)
    };
    for (arguments, message) in [
        (
            &["kepler", "pendulum"][..],
            "kepler and pendulum have no coordinate in common: give --map NAME=EXPRESSION for x, y, each an expression of θ",
        ),
        (&["kepler", "pendulum", "--map", "x"], "`--map x` must have the form NAME=EXPRESSION"),
        (&["kepler", "pendulum", "--map", "z = θ"], "kepler has no coordinate `z` for --map; it has `x`, `y`"),
        (&["kepler", "pendulum", "--map", "x = θ", "--map", "x = 1"], "--map gives `x` twice"),
        (
            &["pendulum", "pendulum", "--method", "energy"],
            "steps of --method energy have lengths of their own, so that two models have no times in common; take gauss",
        ),
        (
            &["pendulum", "pendulum", "--method", "adaptive"],
            "steps of --method adaptive have lengths of their own, so that two models have no times in common; take gauss",
        ),
        (&["pendulum", "pendulun"], "there is no system `pendulun`; did you mean `pendulum`?"),
    ] {
        assert_eq!(at(arguments), (Some(2), format!("error: {message}\n")), "{arguments:?}");
    }
    let (status, errors) = at(&["kepler", "pendulum", "--map", "x = sin(phi)"]);
    assert!(status == Some(1) && errors.contains("--> x:1:5") && errors.contains("phi"), "{status:?} {errors}");
}

#[test]
fn terms_that_hardly_act_are_named() {
    let folder = Folder::new("terms", "");
    let text = "struct Own { coord x; L = dot(x)^2 / 2 - x^2 / 2 - x^4 / 1000000 + 3 * x^2 * dot(x); check { x = 1; h = 0.01; } }";
    let own = folder.file("own.vi", text);
    let scene = folder.file("half.toml", &format!("system = {own:?}\nmethod = \"gauss\"\nuntil = 3.2\n"));
    let explain = |further: &[&str]| {
        let (status, output, errors) = lab(&[&["explain", "--along", &scene], further].concat());
        assert_eq!(status, Some(0), "{errors}");
        output
    };
    let output = explain(&[]);
    let row = |term: &str| {
        let mut cells = output.lines().map(|line| line.split_whitespace().collect::<Vec<_>>());
        cells.find(|cells| cells.first() == Some(&term)).unwrap_or_else(|| panic!("{term} in {output}"))
    };
    // x = cos t: the forces of the terms are -x'', -x, -4e-6 x^3 and 0; their energies change by 1/2, 1/2, 1e-6 and 0.
    assert_eq!(row("dot(x)^2/2")[1..3], ["1.00", "1.00"]);
    assert_eq!(row("-x^2/2")[1..3], ["1.00", "1.00"]);
    assert_eq!(row("-x^4/1000000")[1..3], ["4.00·10⁻⁶", "2.00·10⁻⁶"]);
    assert_eq!(row("3*dot(x)*x^2")[1..3], ["0", "0"]);
    let small = |output: &str| output.lines().last().map(str::to_owned).expect("a line");
    let without = "of both, so that this run may do without:";
    assert_eq!(small(&output), format!("below 0.001 {without} -x^4/1000000, 3*dot(x)*x^2"));
    assert_eq!(small(&explain(&["--below", "1e-6"])), format!("below 1e-6 {without} 3*dot(x)*x^2"));
    assert_eq!(small(&explain(&["--below", "0"])), "no term is below 0 of both");
    let (status, _, errors) = lab(&["explain", "kepler", "--along", &scene]);
    assert_eq!((status, errors), (Some(2), format!("error: {scene} is a scene of own, not of kepler\n")));
}
