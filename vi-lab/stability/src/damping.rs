//! Damping and negative damping: where the energy-preserving run ends, against the law.
//!
//! For linear damping `h √D` is constant: `h = h0 e^{ζωt}`, and the run ends after about `1/(ζ ω h0)` steps, where the
//! discrete energy would become negative. With negative damping the steps shrink, and time advances as a logarithm.

use super::atlas::Atlas;
use super::ending::{Course, Limit};
use vi_core::EnergyPreserving;
use vi_report::chart::{Axis, Chart, Look, Series};
use vi_report::failure::Failure;
use vi_systems::DampedOscillator;

const RATIOS: [f64; 3] = [0.001, 0.01, 0.1];
const STEPS: [f64; 4] = [0.003, 0.01, 0.03, 0.1];
/// Frequency of the oscillator: m = 1, k = 4.
const OMEGA: f64 = 2.0;

/// The section: the number of steps, and the length of a step in time.
pub(super) fn section(atlas: &mut Atlas) -> Result<(), Failure> {
    atlas.section("Damping and negative damping");
    let mut series: Vec<Series> = RATIOS
        .into_iter()
        .zip(Look::OTHERS)
        .map(|(zeta, look)| {
            Series::scatter(format!("ζ = {zeta}"), look.dots(5.0), STEPS.map(|h0| ended(zeta, h0)).to_vec())
        })
        .collect();
    series.push(Series::line("1/(ζ ω h₀)", Look::EXACT, vec![(1.0, 1.0), (1e6, 1e6)]));
    let chart = Chart {
        name: "damping-steps",
        title: "Damped oscillator: steps until none exists".to_owned(),
        x: Axis::log10("1/(ζ ω h₀)").over(10.0, 1e6),
        y: Axis::log10("steps taken").over(10.0, 1e6),
        equal_aspect: false,
        series,
    };
    atlas.chart(
        &chart,
        "Each point is a run of the energy-preserving integrator to its end, for first steps from 0.003 to 0.1: the law \
         1/(<i>ζωh</i><sub>0</sub>) predicts the last step.",
    )?;
    let lines = [(-0.02, Look::OTHERS[0]), (0.0, Look::EXACT), (0.02, Look::ENERGY)];
    let chart = Chart {
        name: "damping-length",
        title: "Length of the step with damping, without, and with negative damping".to_owned(),
        x: Axis::linear("t").over(0.0, 100.0),
        y: Axis::log10("h/h₀"),
        equal_aspect: false,
        series: lines
            .into_iter()
            .map(|(zeta, look)| Series::line(format!("ζ = {zeta}"), look.line(), lengths(zeta)))
            .collect(),
    };
    atlas.chart(
        &chart,
        "<i>h</i><sub>0</sub> = 0.01. With damping the step grows as e<sup><i>ζωt</i></sup> until the run ends; with \
         negative damping it shrinks at the same rate, and the run never arrives: not a failure, but no use either.",
    )?;
    atlas.advice(
        "Use the energy-preserving integrator over times well below ln(1/<i>ζωh</i><sub>0</sub>)/(<i>ζω</i>), where the step \
         has grown to 1/(<i>ζω</i>), and the fixed step beyond; choose <i>h</i><sub>0</sub> so that \
         1/(<i>ζωh</i><sub>0</sub>) is well above the steps you need.",
    );
    Ok(())
}

fn oscillator(zeta: f64) -> DampedOscillator {
    DampedOscillator { m: 1.0, k: OMEGA * OMEGA, c: 2.0 * zeta * OMEGA }
}

/// The law's number of steps, and that of the run.
fn ended(zeta: f64, h0: f64) -> (f64, f64) {
    let limit = Limit { steps: 2_000_000, until: f64::INFINITY, bound: f64::INFINITY };
    let course = Course::energy(oscillator(zeta), [1.0], [0.0], h0, limit);
    (1.0 / (zeta * OMEGA * h0), f64::from(course.steps))
}

/// Time and relative length of the steps up to t = 100, or to the end.
fn lengths(zeta: f64) -> Vec<(f64, f64)> {
    let h0 = 0.01;
    let Ok(mut run) = EnergyPreserving::from_midpoint(oscillator(zeta), 0.0, [1.0], [0.0], h0) else {
        return Vec::new();
    };
    let steps = run.detailed_steps().map_while(Result::ok).take(200_000);
    steps.take_while(|step| step.t < 100.0).map(|step| (step.t, step.h / h0)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_law_predicts_the_last_step() {
        for zeta in RATIOS {
            for h0 in [0.01, 0.03] {
                let (law, steps) = ended(zeta, h0);
                // Measured: off by 1.3 % at ζ = 0.1, h0 = 0.03, where the law predicts 167 steps.
                assert!((steps / law - 1.0).abs() < 0.03, "ζ = {zeta}, h0 = {h0}: {steps} instead of {law}");
            }
        }
    }
}
