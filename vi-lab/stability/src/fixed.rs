//! Limits of fixed steps: the linear limit, resonances, the number of solutions, stiff springs.

use super::atlas::{Map, Part, Section};
use super::ending::{Ending, LASTING, Limit, OWN, RunSummary, oscillation};
use super::trial::{Bent, Oscillator, SpringPendulum, trapezoidal};
use core::f64::consts::SQRT_2;
use vi_core::node::Node;
use vi_core::stepping::FixedStepping;
use vi_core::{SVector, State, StepError};
use vi_report::chart::{Axis, Class};
use vi_systems::{DoubleWell, Kepler};

const DECAYS: Class = Class { label: "bounded, as the motion", ..LASTING };
const GROWS: Class = Class { number: OWN, label: "grows, as the motion", colour: "#CDE8DC" };
/// Steps of the energy-preserving integrator, in viridis.
const SURVIVAL: [(u32, Class); 3] = [
    (10, Class { number: OWN, label: "ends in fewer than 10", colour: "#440154" }),
    (100, Class { number: OWN + 1, label: "10 to 100 steps", colour: "#2A788E" }),
    (1000, Class { number: OWN + 2, label: "100 to 1000 steps", colour: "#7AD151" }),
];
const SURVIVES: Class = Class { label: "more than 1000 steps", ..LASTING };

/// The damped oscillator over (h ω, ζ), by three methods.
///
/// With ω = 1 the trapezoidal rule is `(1 + ζh) x₊ − (2 − h²) x + (1 − ζh) x₋ = 0`: stable up to h ω = 2, for any
/// damping. The midpoint rule has no such limit. The energy-preserving step grows as the motion decays, and ends after
/// about 1/(ζ ω h0) steps.
pub(super) fn linear() -> Section<'static> {
    let damping = || Axis::linear("damping ratio ζ").over(-0.25, 1.25);
    let axes = || [Axis::linear("h ω").over(0.0, 3.0), damping()];
    let midpoint = Map::new(
        "linear-midpoint",
        "Oscillator: fixed step, midpoint rule",
        "Fixed steps of the midpoint rule: no limit. Steps of any length decay and grow as the motion does.",
        axes(),
        |h, zeta| damped(Oscillator { c: 2.0 * zeta }, h, zeta),
    );
    let verlet = Map::new(
        "linear-trapezoidal",
        "Oscillator: fixed step, trapezoidal rule",
        "Fixed steps of the trapezoidal rule (Verlet’s method if there is no damping): unstable above \
         <i>hω</i> = 2. The dashed line is the boundary from the characteristic polynomial.",
        axes(),
        |h, zeta| damped(trapezoidal(Oscillator { c: 2.0 * zeta }), h, zeta),
    );
    let energy = Map::new(
        "linear-energy",
        "Oscillator: energy-preserving, steps until it ends",
        "The energy-preserving integrator: the number of its steps before none exists. With damping the steps grow \
         as e<sup><i>ζωt</i></sup>, and end after about 1/(<i>ζωh</i><sub>0</sub>) of them. Without damping, \
         and with negative damping, they do not end.",
        [Axis::log10("h₀ ω").over(1e-3, 3.0), damping()],
        survival,
    );
    Section {
        heading: "The linear limit",
        prose: "Close to equilibrium every system is a sum of oscillators, and the fastest of them limits the step. The charts \
                show one oscillator of frequency <i>ω</i> and damping ratio <i>ζ</i>; for <i>ζ</i> &lt; 0 the motion itself \
                grows. A run counts as unstable if it grows by more than the square of the true growth."
            .to_owned(),
        parts: vec![
            Part::Map(midpoint),
            Part::Map(verlet.with_theory("spectral radius", excess)),
            Part::Map(energy.with_theory("1/(ζ ω h₀) = 10, 100, 1000", |h, zeta| {
                let power = (zeta * h).log10();
                (power + 1.0) * (power + 2.0) * (power + 3.0)
            })),
        ],
        advice: "With the trapezoidal rule keep <i>h</i> below 2/<i>ω</i><sub>max</sub>, and for accuracy far below. With the \
                 midpoint rule stability sets no limit; <i>hω</i> around 0.1 is a good start. Use the energy-preserving \
                 integrator if damping is weak. It takes about 1/(<i>ζωh</i><sub>0</sub>) steps: use it for times well below \
                 ln(1/<i>ζωh</i><sub>0</sub>)/(<i>ζω</i>), at which the step has grown to 1/(<i>ζω</i>), and the fixed step \
                 for longer times.",
    }
}

/// The class of fixed steps of an oscillator. They are unstable if they grow 1e4 times more than the motion, or by more
/// than its square. A run ends when the exact motion has grown by e^100.
fn damped<S: FixedStepping<1>>(system: S, h: f64, zeta: f64) -> Class {
    let rate = (-zeta).max(0.0);
    let limit = Limit { steps: 2000, until: 100.0 / rate, bound: 1e4 };
    match oscillation(system, h, limit, 2.0 * rate) {
        Ending::Lasting if zeta < 0.0 => GROWS,
        Ending::Lasting => DECAYS,
        ending => ending.class(),
    }
}

/// Logarithm of the spectral radius of the trapezoidal rule, less the growth allowed in one step.
fn excess(h: f64, zeta: f64) -> f64 {
    let a = 1.0 + zeta * h;
    let b = h * h - 2.0;
    let c = 1.0 - zeta * h;
    let discriminant = b * b - 4.0 * a * c;
    let radius = if discriminant < 0.0 { (c / a).sqrt() } else { (b.abs() + discriminant.sqrt()) / (2.0 * a) };
    // Without damping the radius is 1 to rounding.
    radius.ln() - 2.0 * (-zeta).max(0.0) * h - 1e-9
}

/// Steps of the energy-preserving integrator.
fn survival(h: f64, zeta: f64) -> Class {
    let limit = Limit { steps: 1000, until: f64::INFINITY, bound: f64::INFINITY };
    let summary = RunSummary::energy(Oscillator { c: 2.0 * zeta }, [1.0], [0.0], h, limit);
    match summary.ending {
        Ending::Failing(StepError::NoForwardStep { .. } | StepError::StepRatio { .. }) => {
            SURVIVAL.into_iter().find(|(steps, _)| summary.steps < *steps).map_or(SURVIVES, |(_, class)| class)
        }
        Ending::Lasting => SURVIVES,
        ending => ending.class(),
    }
}

/// Growth of the amplitude, in viridis from above.
const GROWTH: [(f64, Class); 5] = [
    (1.25, Class { label: "amplitude below × 1.25", ..LASTING }),
    (1.6, Class { number: OWN, label: "up to × 1.6", colour: "#7AD151" }),
    (2.5, Class { number: OWN + 1, label: "up to × 2.5", colour: "#22A884" }),
    (6.0, Class { number: OWN + 2, label: "up to × 6", colour: "#2A788E" }),
    (f64::INFINITY, Class { number: OWN + 3, label: "beyond × 6", colour: "#440154" }),
];

/// Nonlinear resonances: an oscillator that is nearly linear, over step and amplitude.
///
/// One step turns the phase of the linear oscillator by the angle φ: `cos φ = 1 − h²ω²/2` for the trapezoidal rule,
/// `tan(φ/2) = hω/2` for the midpoint rule. At φ = 2π/3 and π/2 the terms of second and third order act at the same
/// phase every time: h ω = √3 and √2, and 2√3 and 2.
pub(super) fn resonance() -> Section<'static> {
    let axes = |most: f64| [Axis::linear("h ω").over(0.0, most), Axis::log10("amplitude").over(0.003, 0.3)];
    let verlet = Map::new(
        "resonance-trapezoidal",
        "Resonances of the trapezoidal rule",
        "Verlet’s method: largest amplitude over 2000 steps, relative to the first. Dashed: the resonances 1:4 at \
         <i>hω</i> = √2 and 1:3 at √3, and the linear limit 2.",
        axes(2.2),
        |h, a| growth(trapezoidal(Bent::default()), h, a),
    );
    let midpoint = Map::new(
        "resonance-midpoint",
        "Resonances of the midpoint rule",
        "The midpoint rule has resonances at <i>hω</i> = 2 (1:4) and 2√3 (1:3), although it has no linear limit.",
        axes(4.4),
        |h, a| growth(Bent::default(), h, a),
    );
    let third = 3_f64.sqrt();
    Section {
        heading: "Nonlinear resonances",
        prose: "Below the linear limit a method may still fail if the step resonates with the motion: if three or four steps \
                make one oscillation, small nonlinear terms act at the same phase every time. The oscillator of these charts, \
                <i>V</i> = <i>x</i>²/2 + <i>x</i>³/3 + <i>x</i>⁴/4, has a single well, so that the amplitude of the true \
                motion is constant. At 1:3 any quadratic force makes the steps grow. At 1:4, with <i>a x</i>³/3 and \
                <i>b x</i>⁴/4, they grow for 0 &lt; <i>b</i> &lt; 2<i>a</i>² (Verlet) and <i>a</i>² &lt; <i>b</i> &lt; \
                2<i>a</i>² (midpoint rule), and are bounded for larger <i>b</i>."
            .to_owned(),
        parts: vec![
            Part::Map(verlet.with_theory("hω = √2, √3, 2", move |h, _| (h - SQRT_2) * (h - third) * (h - 2.0))),
            Part::Map(midpoint.with_theory("hω = 2, 2√3", move |h, _| (h - 2.0) * (h - 2.0 * third))),
        ],
        advice: "Stay below the 1:4 resonance of the fastest oscillation: <i>hω</i><sub>max</sub> &lt; √2 with the trapezoidal \
                 rule, 2 with the midpoint rule. If a run at a larger step looks calm, vary the step a little before you trust \
                 it.",
    }
}

/// The growth of the amplitude.
fn growth<S: FixedStepping<1>>(system: S, h: f64, amplitude: f64) -> Class {
    let limit = Limit { steps: 2000, until: f64::INFINITY, bound: 100.0 };
    let summary = RunSummary::fixed(system, [amplitude], [0.0], h, limit);
    let growth = summary.largest / amplitude;
    match summary.ending {
        Ending::Lasting => GROWTH.into_iter().find(|(most, _)| growth <= *most).map_or(LASTING, |(_, class)| class),
        ending => ending.class(),
    }
}

const ONE: Class = Class { label: "one solution", ..LASTING };
/// Several solutions of one step.
pub(super) const SEVERAL: Class = Class { number: OWN, label: "three or more", colour: "#21918C" };
const EXISTS: Class = Class { label: "the step exists", ..LASTING };
/// Length of Kepler's step, and the momentum along y from which it starts.
const KEPLER: (f64, f64) = (0.5, 1.0);

/// The number of solutions of a fixed step of the midpoint rule.
///
/// In one degree of freedom with m = 1 the middle x of a step solves `x + (h²/4) V'(x) = w`, w = q0 + (h/2) p0. Two
/// solutions meet if `1 + (h²/4) V''(x) = 0`: from `h = 2/√(−V''_min)` on. For Kepler's problem a step exists iff
/// `|q + h p/2|³ ≥ (27/16) μ h²`.
pub(super) fn roots() -> Section<'static> {
    let well = Map::new(
        "roots-well",
        "Solutions of one fixed step: double well",
        "Double well: the number of solutions of the momentum equation. Dashed: theory. Above \
         <i>h</i> = 2/√(−<i>V</i>″<sub>min</sub>/<i>m</i>) = 2 a step from near the barrier has three.",
        [Axis::linear("w = q + h p/2").over(-1.0, 1.0), Axis::linear("h").over(1.0, 4.0)],
        count,
    );
    let kepler = Map::new(
        "roots-kepler",
        "One fixed step of Kepler’s problem",
        "Kepler’s problem, <i>μ</i> = 1, one step of <i>h</i> = 0.5 with <i>p</i> = (0, 1) from every place: inside \
         the circle |<i>q</i> + <i>hp</i>/2|³ = (27/16) <i>μh</i>² no step exists, and the solver reports it.",
        [Axis::linear("x").over(-1.5, 1.5), Axis::linear("y").over(-1.5, 1.5)],
        one_step_of_kepler,
    );
    let (h, p) = KEPLER;
    Section {
        heading: "No solution, one, or several",
        prose: "A fixed step of the midpoint rule solves an equation, which may have several solutions, or none. With <i>w</i> = \
                <i>q</i> + <i>hp</i>/2, the middle of a step without force, the number of solutions depends on <i>w</i> and \
                <i>h</i> alone."
            .to_owned(),
        parts: vec![
            Part::Map(well.with_theory("two solutions meet", |w, h| {
                // x + (h²/4)(2x³ − x) = w, that is x³ + b x = c, has three roots iff 4 b³ + 27 c² < 0.
                let (b, c) = ((1.0 - h * h / 4.0) * 2.0 / (h * h), 2.0 * w / (h * h));
                4.0 * b.powi(3) + 27.0 * c * c
            })),
            Part::Map(
                kepler.square().with_theory("(27/16) μ h²", move |x, y| x.hypot(y + h * p / 2.0) - (27.0 / 16.0 * h * h).cbrt()),
            ),
        ],
        advice: "Keep <i>h</i> below 2/√(−<i>V</i>″<sub>min</sub>/<i>m</i>), and near an attracting centre below \
                 (16 <i>r</i>³/27<i>μ</i>)<sup>1/2</sup>. The solver follows the solution that is connected with <i>h</i> → 0; \
                 if it reports that there is none, halve the step.",
    }
}

/// The number of solutions of a fixed step of the double well from `w` at rest, by changes of sign between w − 4 and w
/// + 4.
fn count(w: f64, h: f64) -> Class {
    const SAMPLES: u32 = 1200;
    let node = Node::new(State { t: 0.0, q: [w].into(), p: SVector::zeros() }, 0.0);
    let residual = |index: u32| {
        let middle = 4.0 * (2.0 * (f64::from(index) + 0.5) / f64::from(SAMPLES) - 1.0);
        DoubleWell::default().momentum_equation(&node, h, &SVector::from([2.0 * middle / h])).residual.x < 0.0
    };
    let changes = (1..SAMPLES).filter(|&index| residual(index) != residual(index - 1)).count();
    if changes > 1 { SEVERAL } else { ONE }
}

/// The class of one step from (x, y).
fn one_step_of_kepler(x: f64, y: f64) -> Class {
    let (h, p) = KEPLER;
    let limit = Limit { steps: 1, until: f64::INFINITY, bound: f64::INFINITY };
    let class = RunSummary::fixed(Kepler::default(), [x, y], [0.0, p], h, limit).ending.class();
    if class == LASTING { EXISTS } else { class }
}

/// Stiff springs: a mass on a spring under gravity, over the frequency of the spring and the step.
///
/// The slow motion is a pendulum of frequency 1, the fast one the spring with ω = √k. The trapezoidal rule must resolve
/// the fast one, `h ω < 2`, although its amplitude is tiny.
pub(super) fn stiff() -> Section<'static> {
    // Three oscillations of the pendulum, or this many steps.
    const LIMIT: Limit = Limit { steps: 2000, until: 20.0, bound: 10.0 };
    // One radian from the lowest point, the spring at its length, at rest.
    const START: [[f64; 2]; 2] = [[0.0, 1.0], [0.0, 0.0]];
    let axes = || [Axis::log10("frequency of the spring ω").over(3.0, 1000.0), Axis::log10("h").over(1e-3, 2.0)];
    let [q, v] = START;
    let spring = |omega: f64| SpringPendulum { k: omega * omega };
    let verlet = Map::new(
        "stiff-trapezoidal",
        "Spring pendulum: trapezoidal rule",
        "Trapezoidal rule: the spring must be resolved. Dashed: <i>hω</i> = 2.",
        axes(),
        move |omega, h| RunSummary::fixed(trapezoidal(spring(omega)), q, v, h, LIMIT).ending.class(),
    );
    let midpoint = Map::new(
        "stiff-midpoint",
        "Spring pendulum: midpoint rule",
        "Midpoint rule: stable for steps far longer than the spring’s period, as long as the slow motion is resolved. \
         The vibration itself is not resolved.",
        axes(),
        move |omega, h| RunSummary::fixed(spring(omega), q, v, h, LIMIT).ending.class(),
    );
    let energy = Map::new(
        "stiff-energy",
        "Spring pendulum: energy-preserving",
        "Energy-preserving: the vertical axis is the first step. The step density stays positive, and the run \
         continues. The energy is exact to rounding even if the vibration is not resolved.",
        axes(),
        move |omega, h| RunSummary::energy(spring(omega), q, v, h, LIMIT).ending.class(),
    );
    Section {
        heading: "Stiff springs",
        prose: "A pendulum whose rod is a spring has a slow oscillation of frequency 1, and a fast vibration of frequency \
                <i>ω</i> = √(<i>k</i>/<i>m</i>) and small amplitude. Each run starts one radian from the lowest point with \
                the spring at its length, and covers three slow oscillations or 2000 steps."
            .to_owned(),
        parts: vec![
            Part::Map(verlet.with_theory("hω = 2", |omega, h| (omega * h / 2.0).ln())),
            Part::Map(midpoint),
            Part::Map(energy),
        ],
        advice: "If a stiff spring models a rod, take the midpoint rule, with fixed or energy-preserving steps that resolve the \
                 slow motion; the trapezoidal rule has to resolve the fast one. Choose the stretch as a coordinate: the \
                 difference of two lengths loses digits, and the residual of the solver is then rounding.",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_midpoint_rule_has_no_limit() {
        for (h, zeta) in [0.1, 1.0, 2.9].into_iter().flat_map(|h| [-0.2, 0.0, 1.2].map(|zeta| (h, zeta))) {
            let expected = if zeta < 0.0 { GROWS } else { DECAYS };
            assert_eq!(damped(Oscillator { c: 2.0 * zeta }, h, zeta), expected, "h = {h}, ζ = {zeta}");
        }
    }
}
