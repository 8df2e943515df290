//! Lines, seconds of a build and microseconds of a step of dense systems, from small ones on.
//!
//! In: the crate to build. Out: the second table of `docs/expansion.md`, and its figure.

use crate::families;
use crate::project::Project;
use std::path::Path;
use std::time::Instant;
use vi_codegen::Compiled;
use vi_codegen::syntax::parse;
use vi_report::chart::{Axis, Chart, Look, Panel, Series, Sheet};

/// The measurements of one system.
struct Row {
    n: f64,
    lines: f64,
    microseconds: f64,
}

fn real(count: usize) -> f64 {
    f64::from(u32::try_from(count).expect("a small count"))
}

/// Prints the table and draws it; `empty` are the seconds that an empty program takes.
pub(crate) fn table(project: &Project, empty: f64) {
    println!("| system | n | in | lines of Rust | macro (s) | rustc, release (s) | fixed step (µs) |");
    println!("|---|---|---|---|---|---|---|");
    let row = |name: &str, n: usize, text: String, start: &str| {
        let system = parse::system(text.parse().expect("tokens")).expect("a system");
        let written = match Compiled::of(&system).expect("a right system") {
            Compiled::Lines(_) => "lines",
            Compiled::Loops(_) => "loops",
        };
        let begin = Instant::now();
        let rust = vi_codegen::expand(text.parse().expect("tokens"));
        let seconds = begin.elapsed().as_secs_f64();
        let rust = vi_codegen::pretty::text(rust).expect("Rust");
        let lines = rust.lines().count();
        project.write(&format!("{rust}\n{}", MAIN.replace("START", start)));
        let build = project.build(true) - empty;
        let step = project.output();
        println!("| {name} | {n} | {written} | {lines} | {seconds:.3} | {build:.1} | {step} |");
        Row { n: real(n), lines: real(lines), microseconds: step.parse().expect("a number") }
    };
    let links = [4, 8, 12, 16, 24, 40, 80].map(|n| row("links by positions", n, families::links(n), ANGLES));
    let bodies = [2, 4, 6, 8, 16, 30, 40].map(|n| row("bodies in space", n, families::bodies(n), GRID));
    let panel = |title: &str, label: &str, of: fn(&Row) -> f64| {
        let points = |rows: &[Row]| rows.iter().map(|row| (row.n, of(row))).collect();
        let series = vec![
            Series::curve("links", Look::FIXED, points(&links)),
            Series::curve("bodies", Look::ENERGY, points(&bodies)),
        ];
        let (x, y) = (Axis::log10("links or bodies").over(1.0, 100.0), Axis::log10(label));
        let chart = Chart { name: "", title: title.to_owned(), x, y, equal_aspect: false, series };
        Panel { chart, width: 460.0, height: 320.0 }
    };
    let sheet = Sheet {
        title: "Large systems".to_owned(),
        subtitle: "Small systems are written as lines, large ones as loops, which do not know their length".to_owned(),
        description: "cargo bench -p vi-codegen --bench expansion -- large".to_owned(),
        rows: vec![vec![
            panel("Lines of Rust", "lines", |row| row.lines),
            panel("Fixed step", "microseconds", |row| row.microseconds),
        ]],
    };
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/figures/growth.svg");
    std::fs::write(file, sheet.svg()).expect("a figure");
}

/// Links that hang nearly straight.
const ANGLES: &str = "0.3 + 0.01 * index as f64";

/// Bodies near the points of a grid with a distance of 1.5.
const GRID: &str = "{
    let body = index / 3;
    1.5 * [body % 4, body / 4 % 4, body / 16][index % 3] as f64 + 0.1 * (1.7 * index as f64).sin()
}";

/// Prints the least of seven means over 100 steps, in microseconds.
const MAIN: &str = "
use vi_core::prelude::*;

fn main() -> Result<(), StepError> {
    let q = std::array::from_fn(|index: usize| START);
    let mut run = System::default().at(0.0, q, q.map(|_| 0.0)).integrate(FixedStep, 0.001)?;
    let mut least = f64::MAX;
    for _ in 0..7 {
        let begin = std::time::Instant::now();
        for _ in 0..100 {
            run.step()?;
        }
        least = least.min(begin.elapsed().as_secs_f64() * 1e6 / 100.0);
    }
    println!(\"{least:.2}\");
    Ok(())
}
";
