//! Trajectories and energy of the damped oscillator against the exact motion.

use super::super::book::{Book, Verdict};
use super::super::unexpected;
use super::oscillator::{OMEGA, Sample, Sampled, energy_preserving, exact, exact_energy, fixed};
use vi_report::chart::{Axis, Chart, Look, Series};
use vi_report::failure::Failure;
use vi_report::numbers::scientific;

/// Damping ratio and time of the trajectories: late enough for the step to have grown fivefold.
const ZETA: f64 = 0.01;
const UNTIL: f64 = 80.0;
/// Points of the exact curve.
const FINENESS: u32 = 4000;

/// The section: trajectories, their errors, energy, its error.
pub(super) fn section(book: &mut Book) -> Result<(), Failure> {
    let adaptive = energy_preserving(ZETA, UNTIL, u32::MAX).map_err(unexpected("damped oscillator"))?;
    let constant = fixed(ZETA, UNTIL).map_err(unexpected("damped oscillator"))?;
    book.section("Damped trajectories");
    trajectory(book, &adaptive, &constant)?;
    error(book, &adaptive, &constant)?;
    book.section("Damped energy");
    book.prose(
        "With a force, <i>E<sub>k</sub></i> is not constant: it changes by the discrete work of the force. Both integrators \
         carry that work; the energy-preserving one solves the energy equation exactly, so its <i>E<sub>k</sub></i> is \
         the energy equation’s own, and differs from the exact decay only by the error of the discretization.",
    );
    energy(book, &adaptive, &constant)?;
    energy_error(book, &adaptive, &constant)
}

fn pairs(run: &Sampled, value: impl Fn(&Sample) -> f64) -> Vec<(f64, f64)> {
    run.samples.iter().map(|sample| (sample.t, value(sample))).collect()
}

fn curve(value: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
    (0..=FINENESS).map(|index| UNTIL * f64::from(index) / f64::from(FINENESS)).map(|t| (t, value(t))).collect()
}

fn trajectory(book: &mut Book, adaptive: &Sampled, constant: &Sampled) -> Result<(), Failure> {
    let chart = Chart {
        name: "damped-trajectory",
        title: format!("Damped trajectory, ζ = {ZETA}"),
        x: Axis::linear("t"),
        y: Axis::linear("q"),
        equal_aspect: false,
        series: vec![
            Series::line("fixed step", Look::FIXED.line(), pairs(constant, |sample| sample.q)),
            Series::line("energy-preserving", Look::ENERGY.line(), pairs(adaptive, |sample| sample.q)),
            Series::line("exact", Look::EXACT, curve(|t| exact(ZETA, t).0)),
        ],
    };
    book.figure(
        &chart,
        &format!(
            "Both integrators follow the exact motion. Up to <i>t</i> = {UNTIL} the energy-preserving one takes {} steps, \
             the fixed step {}.",
            adaptive.samples.len(),
            constant.samples.len()
        ),
    )
}

fn error(book: &mut Book, adaptive: &Sampled, constant: &Sampled) -> Result<(), Failure> {
    let distance = |sample: &Sample| {
        let (q, v) = exact(ZETA, sample.t);
        (sample.q - q).hypot((sample.v - v) / OMEGA)
    };
    let chart = Chart {
        name: "damped-trajectory-error",
        title: format!("Error of the damped trajectory, ζ = {ZETA}"),
        x: Axis::linear("t"),
        y: Axis::linear("distance in the phase plane"),
        equal_aspect: false,
        series: vec![
            Series::line("energy-preserving", Look::ENERGY.line(), pairs(adaptive, distance)),
            Series::line("fixed step", Look::FIXED.line(), pairs(constant, distance)),
        ],
    };
    book.figure(
        &chart,
        "Distance in (<i>q</i>, <i>v</i>/<i>ω</i>) from the exact motion at each node’s time. The fixed step’s phase error \
         grows in proportion to <i>t</i> and its amplitude dies out; the energy-preserving step grows while the motion dies \
         out, and the distance with it.",
    )
}

fn energy(book: &mut Book, adaptive: &Sampled, constant: &Sampled) -> Result<(), Failure> {
    let chart = Chart {
        name: "damped-energy",
        title: format!("Energy of the damped oscillator, ζ = {ZETA}"),
        x: Axis::linear("t"),
        y: Axis::log10("Eₖ"),
        equal_aspect: false,
        series: vec![
            Series::line("fixed step", Look::FIXED.line(), pairs(constant, |sample| sample.energy)),
            Series::line("energy-preserving", Look::ENERGY.line(), pairs(adaptive, |sample| sample.energy)),
            Series::line("exact", Look::EXACT, curve(|t| exact_energy(ZETA, t))),
        ],
    };
    book.figure(&chart, "Computed and exact energy on a logarithmic axis: both decay as e<sup>−2<i>ζωt</i></sup>.")
}

fn energy_error(book: &mut Book, adaptive: &Sampled, constant: &Sampled) -> Result<(), Failure> {
    let relative = |sample: &Sample| sample.energy / exact_energy(ZETA, sample.t) - 1.0;
    let chart = Chart {
        name: "damped-energy-error",
        title: format!("Relative energy error of the damped oscillator, ζ = {ZETA}"),
        x: Axis::linear("t"),
        y: Axis::linear("Eₖ / E(t) − 1"),
        equal_aspect: false,
        series: vec![
            Series::line("energy-preserving", Look::ENERGY.line(), pairs(adaptive, relative)),
            Series::line("fixed step", Look::FIXED.line(), pairs(constant, relative)),
        ],
    };
    let largest = |largest: f64, error: f64| largest.max(error.abs());
    let last = |run: &Sampled| run.samples.iter().rev().take(200).map(relative).fold(0.0, largest);
    let early = |run: &Sampled| run.samples.iter().take(400).map(relative).fold(0.0, largest);
    book.figure(
        &chart,
        &format!(
            "Against the exact energy at each node’s time. Early the energy-preserving error is at most {}, the fixed \
             step’s {}; at the end {} and {}.",
            scientific(early(adaptive)),
            scientific(early(constant)),
            scientific(last(adaptive)),
            scientific(last(constant))
        ),
    )?;
    book.claim(
        "damped oscillator: unexpected behaviour of the energy of the energy-preserving integrator",
        "—",
        format!(
            "relative energy error {} early, {} at t = {UNTIL}, where h has grown to {}; it is the step that grows",
            scientific(early(adaptive)),
            scientific(last(adaptive)),
            scientific(adaptive.samples.last().map_or(f64::NAN, |sample| sample.h)),
        ),
        Verdict::Answered.when(last(adaptive) > early(adaptive)),
    );
    Ok(())
}
