//! Energy-preserving steps of order 2, 4 and 6, and the shift: each order has a domain of its own.
//!
//! Pendulum from rest at the angle a: the step density D_s keeps its sign for a below π, π/2 and 0.81 rad with 1, 2 and 3 stages
//! (`docs/theory.md`, section 4). With a shift beyond the largest |D_s| every motion runs.

use super::atlas::{Atlas, Axes, Labels};
use super::ending::{Course, Limit};
use core::f64::consts::FRAC_PI_2;
use vi_erased::System;
use vi_erased::plan::{Method, PhasePoint, Plan, Shift};
use vi_report::catalogue::Catalogue;
use vi_report::chart::{Axis, Class, boundary};
use vi_report::failure::Failure;

const LIMIT: Limit = Limit { steps: 20_000, until: 25.0, bound: 1e3 };
const STEPS: (f64, f64) = (0.02, 0.8);
/// That of the last map.
const SHIFT: Option<Shift> = Some(Shift::Over(LIMIT.until));

/// The section: a map for each number of stages, and one with a shift.
pub(super) fn section(atlas: &mut Atlas, catalogue: &Catalogue) -> Result<(), Failure> {
    atlas.section("Energy-preserving steps of order 2, 4, 6, and the shift");
    atlas.prose(
        "A step of <i>s</i> stages, of order 2<i>s</i>, has a step density <i>D<sub>s</sub></i> of its own, and exists while that \
         keeps its sign: the domain of a higher order is another one. Pendulum released at rest, for 25 units of time.",
    );
    let system = catalogue.find("pendulum")?.system;
    let class = |stages, shift, angle, h| class(system.as_ref(), stages, shift, (angle, h));
    let axes =
        Axes { x: Axis::linear("angle a, from rest").over(0.2, 3.1), y: Axis::log10("h₀").over(STEPS.0, STEPS.1) };
    let grid = atlas.coarse_grid(axes, 2);
    let line = |name: &str, at: f64| boundary(name, vec![vec![(at, STEPS.0), (at, STEPS.1)]]);
    let caption = "One stage: every libration runs with short steps.";
    let labels = Labels { name: "orders-1", title: "Pendulum, order 2", caption };
    atlas.map(labels, &grid, Vec::new(), |angle, h| class(1, None, angle, h))?;
    let caption = "Two stages: up to π/2.";
    let labels = Labels { name: "orders-2", title: "Pendulum, order 4", caption };
    atlas.map(labels, &grid, line("a = π/2", FRAC_PI_2), |angle, h| class(2, None, angle, h))?;
    let caption =
        "Three stages: up to 0.81. For the shortest steps rounding would dominate the computed length: degenerate.";
    let labels = Labels { name: "orders-3", title: "Pendulum, order 6", caption };
    atlas.map(labels, &grid, line("a = 0.81", 0.81), |angle, h| class(3, None, angle, h))?;
    let caption = "Two stages with a shift of twice the largest |<i>D</i><sub>2</sub>| of the first 25 units of time: the step exists \
                   everywhere.";
    let labels = Labels { name: "orders-2-shifted", title: "Pendulum, order 4, with a shift", caption };
    atlas.map(labels, &grid, Vec::new(), |angle, h| class(2, SHIFT, angle, h))?;
    atlas.advice(
        "Where the energy has to stay on a motion on which <i>D<sub>s</sub></i> changes its sign, take \
         <code>EnergyPreservingGauss</code> with two stages and <code>with_shift_from(period)</code>.",
    );
    Ok(())
}

/// How a run from rest at an angle ends, with the given number of stages.
fn class(system: &dyn System, stages: usize, shift: Option<Shift>, (angle, h): (f64, f64)) -> Class {
    let start = PhasePoint { t: 0.0, q: vec![angle], v: vec![0.0] };
    let plan = Plan { stages: Some(stages), shift, ..Plan::new(Method::Energy, h, start) };
    Course::planned(system, &plan, LIMIT).ending.class()
}

#[cfg(test)]
mod tests {
    use super::super::atlas::Grid;
    use super::super::atlas::tests::strays;
    use super::super::ending::LASTING;
    use super::super::tests::catalogue;
    use super::*;

    const STAGES: usize = 2;

    fn cells(shift: Option<Shift>, columns: usize) -> (Grid, Vec<Class>) {
        let system = catalogue().find("pendulum").expect("a ready system").system;
        let axes = Axes { x: Axis::linear("a").over(0.2, 3.0), y: Axis::log10("h").over(0.03, 0.06) };
        let grid = Grid::new(axes, columns);
        let cells = grid.cells(&|angle, h| class(system.as_ref(), STAGES, shift, (angle, h)), |_| ());
        (grid, cells)
    }

    fn order_four_has_its_domain(columns: usize) {
        let (grid, runs) = cells(None, columns);
        assert_eq!(strays(&grid, &runs, LASTING, |a, _| a < FRAC_PI_2), 0);
    }

    fn with_a_shift_every_motion_runs(columns: usize) {
        let (_, runs) = cells(SHIFT, columns);
        assert!(runs.iter().all(|class| class.number == LASTING.number));
    }

    #[test]
    fn each_order_has_its_domain() {
        order_four_has_its_domain(8);
        with_a_shift_every_motion_runs(6);
    }

    #[test]
    #[ignore = "many steps: `.ci/run nightly`"]
    fn each_order_has_its_domain_in_detail() {
        order_four_has_its_domain(20);
        with_a_shift_every_motion_runs(20);
    }
}
