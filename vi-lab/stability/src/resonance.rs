//! Nonlinear resonances: an oscillator that is nearly linear, over step and amplitude.
//!
//! One step turns the phase of the linear oscillator by the angle φ: `cos φ = 1 − h²ω²/2` for the trapezoidal rule,
//! `tan(φ/2) = hω/2` for the midpoint rule. At φ = 2π/3 and π/2 the terms of second and third order act at the same
//! phase every time: h ω = √3 and √2, and 2√3 and 2.

use super::atlas::{Atlas, Axes, Labels};
use super::ending::{Course, Ending, LASTING, Limit, OWN};
use super::trial::{Bent, trapezoidal};
use vi_core::stepping::FixedStepping;
use vi_report::chart::{Axis, Class, boundary};
use vi_report::failure::Failure;

/// Steps of a run.
const STEPS: u32 = 2000;
/// Growth of the amplitude, in viridis from above.
const GROWTH: [(f64, Class); 5] = [
    (1.25, Class { label: "amplitude below × 1.25", ..LASTING }),
    (1.6, Class { number: OWN, label: "up to × 1.6", colour: "#7AD151" }),
    (2.5, Class { number: OWN + 1, label: "up to × 2.5", colour: "#22A884" }),
    (6.0, Class { number: OWN + 2, label: "up to × 6", colour: "#2A788E" }),
    (f64::INFINITY, Class { number: OWN + 3, label: "beyond × 6", colour: "#440154" }),
];

/// The section: a map for each rule.
pub(super) fn section(atlas: &mut Atlas) -> Result<(), Failure> {
    atlas.section("Nonlinear resonances");
    atlas.prose(
        "Below the linear limit a method may still fail where the step resonates with the motion: where three or four \
         steps make one oscillation, small nonlinear terms push at the same phase every time. The oscillator of these \
         charts, <i>V</i> = <i>x</i>²/2 + <i>x</i>³/3 + <i>x</i>⁴/4, has a single well, so that the true motion keeps its \
         amplitude for ever. At 1:3 any quadratic force drives it away; at 1:4, with <i>a x</i>³/3 and <i>b x</i>⁴/4, it is \
         driven away for 0 &lt; <i>b</i> &lt; 2<i>a</i>² (Verlet) and <i>a</i>² &lt; <i>b</i> &lt; 2<i>a</i>² (midpoint rule), \
         and bounded beyond.",
    );
    let grid = atlas.grid(Axes { x: Axis::linear("h ω").over(0.0, 2.2), y: amplitudes() });
    let lines = vertical(&[2_f64.sqrt(), 3_f64.sqrt(), 2.0]);
    let caption = "Verlet’s method: largest amplitude over 2000 steps, relative to the first. Dashed: the resonances 1:4 at \
                   <i>hω</i> = √2 and 1:3 at √3, and the linear limit 2.";
    atlas.map(
        Labels { name: "resonance-trapezoidal", title: "Resonances of the trapezoidal rule", caption },
        &grid,
        boundary("hω = √2, √3, 2", lines),
        |h, a| class(trapezoidal(Bent::default()), h, a),
    )?;
    let grid = atlas.grid(Axes { x: Axis::linear("h ω").over(0.0, 4.4), y: amplitudes() });
    let caption = "The midpoint rule has its resonances at <i>hω</i> = 2 (1:4) and 2√3 (1:3), though its linear limit is \
                   none.";
    atlas.map(
        Labels { name: "resonance-midpoint", title: "Resonances of the midpoint rule", caption },
        &grid,
        boundary("hω = 2, 2√3", vertical(&[2.0, 2.0 * 3_f64.sqrt()])),
        |h, a| class(Bent::default(), h, a),
    )?;
    atlas.advice(
        "Stay below the 1:4 resonance of the fastest oscillation: <i>hω</i><sub>max</sub> &lt; √2 with the trapezoidal \
         rule, 2 with the midpoint rule. If a run at a larger step looks calm, vary the step a little before you trust it.",
    );
    Ok(())
}

fn amplitudes() -> Axis {
    Axis::log10("amplitude").over(0.003, 0.3)
}

fn vertical(steps: &[f64]) -> Vec<Vec<(f64, f64)>> {
    steps.iter().map(|&h| vec![(h, 0.003), (h, 0.3)]).collect()
}

/// How much the amplitude grows.
fn class<S: FixedStepping<1>>(system: S, h: f64, amplitude: f64) -> Class {
    let limit = Limit { steps: STEPS, until: f64::INFINITY, bound: 100.0 };
    let course = Course::fixed(system, [amplitude], [0.0], h, limit);
    let growth = course.largest / amplitude;
    match course.ending {
        Ending::Lasting => GROWTH.into_iter().find(|(most, _)| growth <= *most).map_or(LASTING, |(_, class)| class),
        ending => ending.class(),
    }
}
