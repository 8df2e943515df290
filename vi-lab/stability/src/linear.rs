//! The linear limit: the damped oscillator over (h ω, ζ), by three methods.
//!
//! With ω = 1 the trapezoidal rule is `(1 + ζh) x₊ − (2 − h²) x + (1 − ζh) x₋ = 0`: stable up to h ω = 2, whatever the
//! damping. The midpoint rule has no such limit. The energy-preserving step grows as the motion decays, and ends after
//! about 1/(ζ ω h0) steps.

use super::atlas::{Atlas, Axes, Labels};
use super::ending::{Course, Ending, LASTING, Limit, OWN, UNBOUNDED};
use super::trial::{Oscillator, trapezoidal};
use vi_core::stepping::FixedStepping;
use vi_core::{FixedStep, Starts, State, StepError};
use vi_report::chart::{Axis, Class, boundary};
use vi_report::failure::Failure;

/// Steps of a run.
const STEPS: u32 = 2000;
/// Growth that counts as instability, beside that of the motion itself.
const BOUND: f64 = 1e4;
/// A run has seen enough when the motion itself has grown by e to this power.
const GROWTH: f64 = 100.0;
/// Amplitude of a motion that has come to rest: far above the smallest numbers, where rounding is no longer relative.
const REST: f64 = 1e-200;

const DECAYS: Class = Class { label: "bounded, as the motion", ..LASTING };
const GROWS: Class = Class { number: OWN, label: "grows, as the motion", colour: "#CDE8DC" };
/// Steps of the energy-preserving integrator, in viridis.
const SURVIVAL: [(u32, Class); 3] = [
    (10, Class { number: OWN, label: "ends in fewer than 10", colour: "#440154" }),
    (100, Class { number: OWN + 1, label: "10 to 100 steps", colour: "#2A788E" }),
    (1000, Class { number: OWN + 2, label: "100 to 1000 steps", colour: "#7AD151" }),
];
const SURVIVES: Class = Class { label: "more than 1000 steps", ..LASTING };

/// The section: three maps.
pub(super) fn section(atlas: &mut Atlas) -> Result<(), Failure> {
    atlas.section("The linear limit");
    atlas.prose(
        "Close to equilibrium every system is a sum of oscillators, and the fastest of them limits the step. The charts \
         show one oscillator of frequency <i>ω</i> and damping ratio <i>ζ</i>; below <i>ζ</i> = 0 the force drives the \
         motion, whose growth is then no fault of the method. A run is called unstable where it outgrows the square of the \
         true growth.",
    );
    let grid = atlas.grid(axes());
    let caption =
        "Fixed steps of the midpoint rule: no limit. What decays decays, what grows grows, at any step length.";
    atlas.map(
        Labels { name: "linear-midpoint", title: "Oscillator: fixed step, midpoint rule", caption },
        &grid,
        Vec::new(),
        |h, zeta| class(Oscillator { c: 2.0 * zeta }, h, zeta),
    )?;
    let theory = boundary("spectral radius", grid.zeros(&excess));
    let caption = "Fixed steps of the trapezoidal rule (Verlet’s method where there is no damping): unstable beyond \
                   <i>hω</i> = 2. The dashed line is the boundary from the characteristic polynomial.";
    atlas.map(
        Labels { name: "linear-trapezoidal", title: "Oscillator: fixed step, trapezoidal rule", caption },
        &grid,
        theory,
        |h, zeta| class(trapezoidal(Oscillator { c: 2.0 * zeta }), h, zeta),
    )?;
    energy(atlas)?;
    atlas.advice(
        "With the trapezoidal rule keep <i>h</i> below 2/<i>ω</i><sub>max</sub>, and for accuracy far below. With the \
         midpoint rule stability sets no limit; <i>hω</i> around 0.1 is a good start. Use the energy-preserving integrator \
         where damping is weak, and expect about 1/(<i>ζωh</i><sub>0</sub>) steps of it: take it over times well below \
         ln(1/<i>ζωh</i><sub>0</sub>)/(<i>ζω</i>), where the step has grown to 1/(<i>ζω</i>), and the fixed step beyond.",
    );
    Ok(())
}

/// Step and damping.
fn axes() -> Axes {
    Axes { x: Axis::linear("h ω").over(0.0, 3.0), y: Axis::linear("damping ratio ζ").over(-0.25, 1.25) }
}

/// How fixed steps end.
fn class<S: FixedStepping<1>>(system: S, h: f64, zeta: f64) -> Class {
    let rate = (-zeta).max(0.0);
    let limit = Limit { steps: STEPS, until: GROWTH / rate, bound: BOUND };
    let state = State::at(&system, 0.0, [1.0], [0.0]);
    let course = system.at_state(state).integrate(FixedStep, h).map(|mut run| {
        // Displacement and momentum both: at an extreme one of them vanishes.
        Course::of(limit, || {
            run.step().map(|state| {
                let size = state.q.x.hypot(state.p.x);
                let t = if size < REST { f64::INFINITY } else { state.t };
                (t, size * (-2.0 * rate * state.t).exp())
            })
        })
    });
    match course.map_or_else(Ending::Failing, |course| course.ending) {
        Ending::Lasting if zeta < 0.0 => GROWS,
        Ending::Lasting => DECAYS,
        Ending::Unbounded => UNBOUNDED,
        ending @ Ending::Failing(_) => ending.class(),
    }
}

/// Logarithm of the spectral radius of the trapezoidal rule, less the growth that is allowed to it in one step.
fn excess(h: f64, zeta: f64) -> f64 {
    let a = 1.0 + zeta * h;
    let b = h * h - 2.0;
    let c = 1.0 - zeta * h;
    let discriminant = b * b - 4.0 * a * c;
    let radius = if discriminant < 0.0 { (c / a).sqrt() } else { (b.abs() + discriminant.sqrt()) / (2.0 * a) };
    // Without damping the radius is 1 but for rounding.
    radius.ln() - 2.0 * (-zeta).max(0.0) * h - 1e-9
}

fn energy(atlas: &mut Atlas) -> Result<(), Failure> {
    let damping = axes().y;
    let grid = atlas.grid(Axes { x: Axis::log10("h₀ ω").over(1e-3, 3.0), y: damping });
    let laws = SURVIVAL.iter().flat_map(|&(steps, _)| grid.zeros(&move |h, zeta| zeta * h * f64::from(steps) - 1.0));
    let theory = boundary("1/(ζ ω h₀) = 10, 100, 1000", laws.collect());
    let caption = "The energy-preserving integrator: how many steps it takes before none exists. Damping takes energy out \
                   of the motion, the steps grow as e<sup><i>ζωt</i></sup> to take it out faster, and the end comes \
                   after about 1/(<i>ζωh</i><sub>0</sub>) of them. Without damping, and with negative damping, it goes on.";
    let title = "Oscillator: energy-preserving, steps until it ends";
    atlas.map(Labels { name: "linear-energy", title, caption }, &grid, theory, |h, zeta| survival(h, zeta).1)?;
    Ok(())
}

/// Steps of the energy-preserving integrator, and their class.
fn survival(h: f64, zeta: f64) -> (u32, Class) {
    let limit = Limit { steps: 1000, until: f64::INFINITY, bound: f64::INFINITY };
    let system = Oscillator { c: 2.0 * zeta };
    let course = Course::energy(system, [1.0], [0.0], h, limit);
    let class = match course.ending {
        Ending::Failing(StepError::NoForwardStep { .. } | StepError::StepRatio { .. }) => {
            SURVIVAL.into_iter().find(|(steps, _)| course.steps < *steps).map_or(SURVIVES, |(_, class)| class)
        }
        Ending::Lasting => SURVIVES,
        ending => ending.class(),
    };
    (course.steps, class)
}

#[cfg(test)]
mod tests {
    use super::super::atlas::Grid;
    use super::super::atlas::tests::strays;
    use super::*;

    #[test]
    fn the_trapezoidal_rule_is_stable_up_to_h_omega_2() {
        let grid = Grid::new(axes(), 30);
        let cells = grid.cells(&|h, zeta| class(trapezoidal(Oscillator { c: 2.0 * zeta }), h, zeta), |_| ());
        // Where the motion decays the boundary is h ω = 2; where it grows, that of the characteristic polynomial.
        assert_eq!(
            strays(&grid, &cells, UNBOUNDED, |h, zeta| if zeta < 0.0 { excess(h, zeta) > 0.0 } else { h > 2.0 }),
            0
        );
    }

    #[test]
    fn the_midpoint_rule_has_no_limit() {
        let grid = Grid::new(axes(), 30);
        let cells = grid.cells(&|h, zeta| class(Oscillator { c: 2.0 * zeta }, h, zeta), |_| ());
        assert_eq!(strays(&grid, &cells, GROWS, |_, zeta| zeta < 0.0), 0);
        assert!(cells.iter().all(|cell| [GROWS, DECAYS].contains(cell)));
    }
}
