//! Across the separatrix: the double well above its barrier, the pendulum from libration to rotation.
//!
//! D = V'²/m + V'' v² is positive all along a libration, and vanishes on every orbit above the barrier: for the double
//! well from rest at q0 > 1, for the pendulum beyond v0 = 2 at the lowest point.

use super::atlas::{Atlas, Axes, Labels};
use super::ending::{Course, Limit};
use super::system;
use vi_core::stepping::EnergyStepping;
use vi_report::catalogue::Catalogue;
use vi_report::chart::{Axis, Class, boundary};
use vi_report::entry::Entry;
use vi_report::failure::Failure;
use vi_systems::{DoubleWell, Pendulum};

/// Steps enough for the time even where the first one, close to D = 0, is by far the longest.
const LIMIT: Limit = Limit { steps: 100_000, until: 25.0, bound: 1e3 };
const STEPS: (f64, f64) = (0.003, 0.6);

/// The section: two maps over the first step, two over the phase plane.
pub(super) fn section(atlas: &mut Atlas, catalogue: &Catalogue) -> Result<(), Failure> {
    atlas.section("Across the separatrix");
    atlas.prose(
        "An energy-preserving step exists while the step density <i>D</i> keeps its sign. In a potential well it does; on \
         an orbit over a barrier, where the force vanishes and the curvature is negative, <i>D</i> = <i>V</i>′²/<i>m</i> + \
         <i>V</i>″<i>v</i>² does not.",
    );
    let h = || Axis::log10("h₀").over(STEPS.0, STEPS.1);
    let grid = atlas.grid(Axes { x: Axis::linear("q₀, from rest").over(0.72, 1.3), y: h() });
    let line = |at: f64| vec![vec![(at, STEPS.0), (at, STEPS.1)]];
    let caption = "Double well, energy-preserving: from <i>q</i><sub>0</sub> = 1 on the particle has the energy of the \
                   barrier. Below, the run goes on for 25 units of time.";
    let title = "Double well: initial place against the first step";
    atlas.map(
        Labels { name: "separatrix-well", title, caption },
        &grid,
        boundary("separatrix, q₀ = 1", line(1.0)),
        |q, h| course(DoubleWell::default(), q, 0.0, h),
    )?;
    let grid = atlas.grid(Axes { x: Axis::linear("v₀, from the lowest point").over(0.1, 3.0), y: h() });
    let caption = "Pendulum, energy-preserving: every libration runs, every rotation ends.";
    let title = "Pendulum: initial velocity against the first step";
    atlas.map(
        Labels { name: "separatrix-pendulum", title, caption },
        &grid,
        boundary("separatrix, v₀ = 2", line(2.0)),
        |v, h| course(Pendulum::default(), 0.0, v, h),
    )?;
    let caption = "Phase plane of the double well: how a run from each point ends. Dashed: <i>D</i> = 0; dots: the last steps \
                   of some runs. What ends meets that curve sooner or later; what runs never does, but for a rare run \
                   whose steps, long where <i>D</i> is small, lead over it every time.";
    let labels = Labels { name: "plane-well", title: "Double well: phase plane", caption };
    plane(atlas, labels, &catalogue.find("double-well")?, ["q=-1.5:1.5", "v_q=-1.2:1.2"])?;
    let caption = "Phase plane of the pendulum: librations run, rotations end on <i>D</i> = 0.";
    let labels = Labels { name: "plane-pendulum", title: "Pendulum: phase plane", caption };
    plane(atlas, labels, &catalogue.find("pendulum")?, ["θ=-3.1416:3.1416", "v_θ=-3:3"])?;
    atlas.advice(
        "Ask <code>vi-lab stability SYSTEM</code> before a long run: a motion that stays clear of <i>D</i> = 0 runs. For a \
         motion across a barrier take fixed steps, at least while <i>D</i> has the wrong sign.",
    );
    Ok(())
}

fn course<S: EnergyStepping<1>>(system: S, q: f64, v: f64, h: f64) -> Class {
    Course::energy(system, [q], [v], h, LIMIT).ending.class()
}

/// The phase plane of a system of the catalogue.
fn plane(atlas: &mut Atlas, labels: Labels<'_>, entry: &Entry, [x, y]: [&str; 2]) -> Result<(), Failure> {
    let axes = system::axes(entry, Some(x), Some(y))?;
    system::energy(atlas, labels, entry, &axes)
}

#[cfg(test)]
mod tests {
    use super::super::atlas::Grid;
    use super::super::atlas::tests::strays;
    use super::super::ending::LASTING;
    use super::*;

    #[test]
    fn what_runs_is_inside_the_separatrix() {
        let grid = Grid::new(Axes { x: Axis::linear("q").over(-1.5, 1.5), y: Axis::linear("v").over(-1.2, 1.2) }, 30);
        let cells = grid.cells(&|q, v| course(DoubleWell::default(), q, v, 0.02), |_| ());
        assert_eq!(strays(&grid, &cells, LASTING, |q, v| v * v + q.powi(4) - q * q < 0.0), 0);
        let grid = Grid::new(Axes { x: Axis::linear("θ").over(-3.1, 3.1), y: Axis::linear("v").over(-3.0, 3.0) }, 30);
        let cells = grid.cells(&|q, v| course(Pendulum::default(), q, v, 0.02), |_| ());
        assert_eq!(strays(&grid, &cells, LASTING, |q, v| v * v / 2.0 - q.cos() < 1.0), 0);
    }

    #[test]
    fn the_curve_drawn_is_that_of_the_formula() {
        let grid = Grid::new(Axes { x: Axis::linear("q").over(-1.5, 1.5), y: Axis::linear("v").over(-1.2, 1.2) }, 60);
        let system = DoubleWell::default();
        let density = |q: f64, v: f64| system.step_density(0.0, &[q].into(), &[v].into()).unwrap_or(f64::NAN);
        let curve = grid.zeros(&density).concat();
        // D = (2q³ − q)² + (6q² − 1) v² vanishes at v = ±|2q³ − q|/√(1 − 6q²).
        let exact = |q: f64| (2.0 * q.powi(3) - q).abs() / (1.0 - 6.0 * q * q).sqrt();
        let worst = curve.iter().map(|(q, v)| (v.abs() - exact(*q)).abs()).filter(|gap| gap.is_finite());
        let far = worst.fold(0.0, f64::max);
        assert!(curve.len() > 80 && far < 0.05, "{} points, off by {far}", curve.len());
    }
}
