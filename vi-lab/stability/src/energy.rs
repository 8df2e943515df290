//! Limits of energy-preserving steps: eccentric orbits, separatrices, the domains of orders 2, 4 and 6.
//!
//! A step exists while the step density D keeps its sign. On an orbit of eccentricity e, D vanishes somewhere iff
//! e ≥ √(5/8): no run gets around the orbit, with any first step. `D = V'²/m + V'' v²` is positive all along a
//! libration, and vanishes on every orbit above the barrier: for the double well from rest at q0 > 1, for the pendulum
//! with v0 > 2 at the lowest point. D_s of a pendulum from rest at the angle a keeps its sign for a below π, π/2 and
//! 0.81 rad with 1, 2 and 3 stages (`docs/theory.md`, section 4). With a shift above the largest |D_s| every motion
//! runs.

use super::atlas::{Map, Part, Section};
use super::ending::{Limit, RunSummary};
use super::system;
use core::f64::consts::{FRAC_PI_2, TAU};
use vi_erased::System;
use vi_erased::plan::{Method, PhasePoint, Plan, Shift};
use vi_report::chart::Axis;
use vi_report::entry::Entry;
use vi_report::failure::Failure;
use vi_systems::Kepler;

/// Eccentricity against the first step.
pub(super) fn kepler() -> Section<'static> {
    // One orbit and a half; a planet outside of the largest orbit is lost.
    const LIMIT: Limit = Limit { steps: 20_000, until: 1.5 * TAU, bound: 4.0 };
    let axes = || [Axis::linear("eccentricity e").over(0.0, 0.95), Axis::log10("h₀/(1 − e)^(3/2)").over(0.01, 2.0)];
    // The pericentre of the orbit with semi-major axis 1, the velocity there, and the step in units of time.
    let start = |e: f64, h: f64| ([1.0 - e, 0.0], [0.0, ((1.0 + e) / (1.0 - e)).sqrt()], h * (1.0 - e).powf(1.5));
    let energy = Map::new(
        "kepler-energy",
        "Kepler: energy-preserving",
        "Energy-preserving: above <i>e</i> = √(5/8) = 0.7906 the step density <i>D</i> changes its sign on the orbit, \
         and the run ends for any first step. Larger first steps end earlier.",
        axes(),
        move |e, h| {
            let (q, v, h) = start(e, h);
            RunSummary::energy(Kepler::default(), q, v, h, LIMIT).ending.class()
        },
    );
    let fixed = Map::new(
        "kepler-fixed",
        "Kepler: fixed step",
        "Fixed step of the midpoint rule: it runs at every eccentricity, until the pericentre is no longer \
         resolved; then the equation has no solution, or the planet is thrown off its orbit.",
        axes(),
        move |e, h| {
            let (q, v, h) = start(e, h);
            RunSummary::fixed(Kepler::default(), q, v, h, LIMIT).ending.class()
        },
    );
    Section {
        heading: "Kepler: eccentricity against the step",
        prose: "A planet with semi-major axis 1 and <i>μ</i> = 1 starts at its pericentre and runs for one orbit and a half. \
                The unit of the step is the time scale of the pericentre, (1 − <i>e</i>)<sup>3/2</sup>."
            .to_owned(),
        parts: vec![Part::Map(energy.with_theory("e = √(5/8)", |e, _| e - 0.625_f64.sqrt())), Part::Map(fixed)],
        advice: "Up to <i>e</i> = 0.78 the energy-preserving integrator is the better choice: it shortens its step at the \
                 pericentre by itself. Start with <i>h</i><sub>0</sub> of a tenth of (1 − <i>e</i>)<sup>3/2</sup> or less. \
                 Above, take fixed steps of that length, at least while <i>D</i> has the wrong sign.",
    }
}

/// The double well above its barrier, the pendulum from libration to rotation, in the phase plane.
///
/// # Errors
/// The entries are not those of the double well and of the pendulum.
pub(super) fn separatrix<'a>(well: &'a Entry, pendulum: &'a Entry) -> Result<Section<'a>, Failure> {
    let plane = |name, title, caption, entry, [x, y]: [&str; 2]| {
        let axes = system::axes(entry, Some(x), Some(y))?;
        Ok::<_, Failure>(Part::Map(system::energy(name, title, caption, entry, axes)))
    };
    Ok(Section {
        heading: "Across the separatrix",
        prose: "An energy-preserving step exists while the step density <i>D</i> keeps its sign. In a potential well <i>D</i> = \
                <i>V</i>′²/<i>m</i> + <i>V</i>″<i>v</i>² keeps it. On an orbit over a barrier it does not, because on \
                the barrier the force vanishes and the curvature is negative."
            .to_owned(),
        parts: vec![
            plane(
                "plane-well",
                "Double well: phase plane",
                "Phase plane of the double well: the ending of a run from each point. Dashed: <i>D</i> = 0; dots: the last steps \
                 of some runs. The runs that end meet this curve. The others do not, except for a few whose steps \
                 are long near <i>D</i> = 0 and pass over the curve each time.",
                well,
                ["q=-1.5:1.5", "v_q=-1.2:1.2"],
            )?,
            plane(
                "plane-pendulum",
                "Pendulum: phase plane",
                "Phase plane of the pendulum: librations run, rotations end on <i>D</i> = 0.",
                pendulum,
                ["θ=-3.1416:3.1416", "v_θ=-3:3"],
            )?,
        ],
        advice: "Look at <code>vi-lab stability SYSTEM</code> before a long run: a motion away from <i>D</i> = 0 runs. For a \
                 motion across a barrier take fixed steps, at least while <i>D</i> has the wrong sign.",
    })
}

/// The pendulum from rest: a map for each number of stages, and one with a shift.
pub(super) fn orders(pendulum: &dyn System) -> Section<'_> {
    const LIMIT: Limit = Limit { steps: 20_000, until: 25.0, bound: 1e3 };
    let map = |name, title, caption, stages, shift| {
        let axes = [Axis::linear("angle a, from rest").over(0.2, 3.1), Axis::log10("h₀").over(0.02, 0.8)];
        let class = move |angle: f64, h: f64| {
            let start = PhasePoint { t: 0.0, q: vec![angle], v: vec![0.0] };
            let plan = Plan { stages: Some(stages), shift, ..Plan::new(Method::Energy, h, start) };
            RunSummary::planned(pendulum, &plan, LIMIT).ending.class()
        };
        Map::new(name, title, caption, axes, class).coarser(2)
    };
    let two = map("orders-2", "Pendulum, order 4", "Two stages: up to π/2.", 2, None);
    let three =
        "Three stages: up to 0.81. For the shortest steps the energy does not determine the length: degenerate.";
    let three = map("orders-3", "Pendulum, order 6", three, 3, None);
    let shifted = "Two stages with a shift of twice the largest |<i>D</i><sub>2</sub>| of the first 25 units of time: the step \
                   exists everywhere.";
    Section {
        heading: "Energy-preserving steps of order 2, 4, 6, and the shift",
        prose: "A step of <i>s</i> stages, of order 2<i>s</i>, has its own step density <i>D<sub>s</sub></i>, and exists \
                while that keeps its sign. So each order has its own domain. The maps show a pendulum from rest, over 25 \
                units of time."
            .to_owned(),
        parts: vec![
            Part::Map(map("orders-1", "Pendulum, order 2", "One stage: every libration runs with short steps.", 1, None)),
            Part::Map(two.with_theory("a = π/2", |angle, _| angle - FRAC_PI_2)),
            Part::Map(three.with_theory("a = 0.81", |angle, _| angle - 0.81)),
            Part::Map(map(
                "orders-2-shifted",
                "Pendulum, order 4, with a shift",
                shifted,
                2,
                Some(Shift::Over(LIMIT.until)),
            )),
        ],
        advice: "If the energy must be exact and <i>D<sub>s</sub></i> changes its sign along the motion, take \
                 <code>EnergyPreservingGauss</code> with two stages and <code>with_shift_from(period)</code>.",
    }
}
