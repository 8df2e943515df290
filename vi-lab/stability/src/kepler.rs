//! Kepler's problem: eccentricity against the first step.
//!
//! On an orbit of eccentricity e, D vanishes somewhere iff e ≥ √(5/8): no first step, however short, leads around.

use super::atlas::{Atlas, Axes, Labels};
use super::ending::{Course, Limit};
use core::f64::consts::TAU;
use vi_report::chart::{Axis, boundary};
use vi_report::failure::Failure;
use vi_systems::Kepler;

/// One orbit and a half; a planet further away than its orbit reaches is lost.
const LIMIT: Limit = Limit { steps: 20_000, until: 1.5 * TAU, bound: 4.0 };
/// Eccentricity beyond which D changes its sign on the orbit: √(5/8).
const BOUND: f64 = 0.790_569_415_042_094_8;

/// The section: two maps.
pub(super) fn section(atlas: &mut Atlas) -> Result<(), Failure> {
    atlas.section("Kepler: eccentricity against the step");
    atlas.prose(
        "A planet started at its pericentre, semi-major axis and <i>μ</i> being 1, runs for one orbit and a half. The \
         step is measured in the time scale of the pericentre, (1 − <i>e</i>)<sup>3/2</sup>.",
    );
    let grid = atlas.grid(axes());
    let bound = boundary("e = √(5/8)", vec![vec![(BOUND, 0.01), (BOUND, 2.0)]]);
    let caption = "Energy-preserving: beyond <i>e</i> = √(5/8) = 0.7906 the step density <i>D</i> changes its sign on the \
                   orbit, and the run ends, however short the first step is. Larger first steps end earlier.";
    atlas.map(
        Labels { name: "kepler-energy", title: "Kepler: energy-preserving", caption },
        &grid,
        bound,
        |e, h| energy(e, h).class(),
    )?;
    let caption = "Fixed step of the midpoint rule: it runs at every eccentricity, until the pericentre is no longer \
                   resolved; then the equation has no solution, or the planet is thrown off its orbit.";
    atlas.map(Labels { name: "kepler-fixed", title: "Kepler: fixed step", caption }, &grid, Vec::new(), |e, h| {
        Course::fixed(Kepler::default(), pericentre(e), velocity(e), length(e, h), LIMIT).ending.class()
    })?;
    atlas.advice(
        "Up to <i>e</i> = 0.78 the energy-preserving integrator is the better choice: it shortens its step at the pericentre \
         by itself. Start with <i>h</i><sub>0</sub> of a tenth of (1 − <i>e</i>)<sup>3/2</sup> or less. Beyond, take fixed \
         steps of that length, at least where <i>D</i> has the wrong sign.",
    );
    Ok(())
}

fn axes() -> Axes {
    Axes { x: Axis::linear("eccentricity e").over(0.0, 0.95), y: Axis::log10("h₀/(1 − e)^(3/2)").over(0.01, 2.0) }
}

/// Pericentre of the orbit with semi-major axis 1.
fn pericentre(e: f64) -> [f64; 2] {
    [1.0 - e, 0.0]
}

/// Velocity at the pericentre.
fn velocity(e: f64) -> [f64; 2] {
    [0.0, ((1.0 + e) / (1.0 - e)).sqrt()]
}

/// The step in units of time, from one in the time scale of the pericentre.
fn length(e: f64, h: f64) -> f64 {
    h * (1.0 - e).powf(1.5)
}

fn energy(e: f64, h: f64) -> super::ending::Ending {
    Course::energy(Kepler::default(), pericentre(e), velocity(e), length(e, h), LIMIT).ending
}

#[cfg(test)]
mod tests {
    use super::super::atlas::Grid;
    use super::super::atlas::tests::strays;
    use super::super::ending::LASTING;
    use super::*;

    #[test]
    fn runs_end_beyond_the_bound_for_short_steps() {
        let x = Axis::linear("e").over(0.0, 0.95);
        let y = Axis::log10("h").over(0.01, 0.02);
        let grid = Grid::new(Axes { x, y }, 25);
        let cells = grid.cells(&|e, h| energy(e, h).class(), |_| ());
        assert_eq!(strays(&grid, &cells, LASTING, |e, _| e < BOUND), 0);
    }
}
