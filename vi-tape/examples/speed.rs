//! Times of systems of a text, beside compiled ones: `cargo run --release -p vi-tape --features wide --example speed`.
//!
//! Processor time from the text to the end of the first Gauss step, the least of five texts; nanoseconds a step, the
//! least of nine runs that alternate with those of the compiled system.

use std::time::Instant;
use vi_erased::plan::{Method, PhasePoint, Plan};
use vi_erased::{System, kind};
use vi_systems::{DoublePendulum, FpuChain, HenonHeiles, Kepler, NPendulum, Pendulum, SphericalPendulum, ThreeBody};

/// Runs of which the fastest counts.
const RUNS: usize = 9;
/// Steps of each.
const STEPS: u64 = 4000;
/// The methods of the table, with the names of their columns.
const METHODS: [(&str, Method, Option<usize>); 5] = [
    ("Gauss 4", Method::Gauss, Some(4)),
    ("Gauss 8", Method::Gauss, Some(8)),
    ("fixed", Method::Fixed, None),
    ("Kahan–Li 8", Method::KahanLi8, None),
    ("energy", Method::Energy, None),
];

/// A system with a place to start from.
struct Case {
    compiled: Box<dyn System>,
    start: PhasePoint,
    h: f64,
}

fn case(compiled: Box<dyn System>, q: &[f64], v: &[f64], h: f64) -> Case {
    Case { compiled, start: PhasePoint { t: 0.0, q: q.to_vec(), v: v.to_vec() }, h }
}

macro_rules! compiled {
    ($system:ty) => {
        kind!($system, { fixed; gauss 4, 8; energy })
    };
}

fn main() {
    let eight = [0.97, -0.97, 0.0, -0.243, 0.243, 0.0];
    let eight_v = [0.466, 0.466, -0.932, 0.432, 0.432, -0.864];
    let chain: Vec<f64> = (1..=16).map(|i| (core::f64::consts::PI * f64::from(i) / 17.0).sin()).collect();
    let cases = [
        case(compiled!(Pendulum), &[1.0], &[0.0], 0.01),
        case(compiled!(Kepler), &[0.4, 0.0], &[0.0, 2.0], 0.005),
        case(compiled!(HenonHeiles), &[0.0, 0.1], &[0.5, 0.0], 0.02),
        case(compiled!(DoublePendulum), &[1.0, 1.0], &[0.0, 0.0], 0.005),
        case(compiled!(SphericalPendulum), &[0.8, 0.0], &[0.0, 4.0], 0.005),
        case(compiled!(NPendulum), &[0.6, 0.4, 0.2, 0.1], &[0.0; 4], 0.005),
        case(compiled!(ThreeBody), &eight, &eight_v, 0.005),
        case(compiled!(FpuChain), &chain, &[0.0; 16], 0.1),
    ];
    println!("| system (coordinates) | text → first step | {} |", METHODS.map(|(name, ..)| name).join(" | "));
    println!("|---|---|{}", "---|".repeat(METHODS.len()));
    for Case { compiled, start, h } in cases {
        let definition = compiled.definition();
        // Equal texts share their code.
        let texts = (0..5).map(|number| format!("{definition}/* {number} */"));
        let first = texts.map(|text| first_step(&text, &start, h)).fold(f64::INFINITY, f64::min);
        let tape = vi_tape::System::parse(definition).expect("a ready system");
        let cells = METHODS.map(|(_, method, stages)| {
            let plan = Plan { stages, ..Plan::new(method, h, start.clone()) };
            let mut least = [f64::INFINITY; 2];
            for _ in 0..RUNS {
                for (least, system) in least.iter_mut().zip([&*compiled, &*tape]) {
                    *least = least.min(nanoseconds(system, &plan));
                }
            }
            format!("{:.0} → {:.0}, {:.1}", least[0], least[1], least[1] / least[0])
        });
        let size = start.q.len();
        println!("| {} ({size}) | {:.1} ms | {} |", compiled.name(), 1e3 * first, cells.join(" | "));
    }
}

/// Seconds from a text to the end of its first Gauss step.
fn first_step(text: &str, start: &PhasePoint, h: f64) -> f64 {
    let before = Instant::now();
    let system = vi_tape::System::parse(text).expect("a ready system");
    let mut run = system.begin(&Plan::new(Method::Gauss, h, start.clone())).expect("a start");
    run.advance_by(1).expect("a step");
    before.elapsed().as_secs_f64()
}

/// Nanoseconds a step.
#[allow(clippy::cast_precision_loss)] // few steps
fn nanoseconds(system: &dyn System, plan: &Plan) -> f64 {
    let mut run = system.begin(plan).expect("a start");
    run.advance_by(100).expect("steps");
    let before = Instant::now();
    run.advance_by(STEPS).expect("steps");
    1e9 * before.elapsed().as_secs_f64() / STEPS as f64
}
