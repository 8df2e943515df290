//! How many solutions a fixed step of the midpoint rule has.
//!
//! In one degree of freedom with m = 1 the middle x of a step solves `x + (h²/4) V'(x) = w`, w = q0 + (h/2) p0. Two
//! solutions meet where `1 + (h²/4) V''(x) = 0`: on the curve `h = 2/√(−V''(x))`, `w = x − V'(x)/V''(x)`, whose lowest
//! point is `h = 2/√(−V''_min)`. For Kepler's problem a step exists iff `|q + h p/2|³ ≥ (27/16) μ h²`.

use super::atlas::{Atlas, Axes, Labels};
use super::ending::{Course, LASTING, Limit, OWN};
use core::f64::consts::PI;
use vi_core::node::Node;
use vi_core::stepping::FixedStepping;
use vi_core::{SVector, State};
use vi_report::chart::{Axis, Class, boundary};
use vi_report::failure::Failure;
use vi_systems::{DoubleWell, Kepler, Pendulum};

const ONE: Class = Class { label: "one solution", ..LASTING };
const SEVERAL: Class = Class { number: OWN, label: "three or more", colour: "#21918C" };
const EXISTS: Class = Class { label: "the step exists", ..LASTING };
/// Velocities at which the residual is evaluated.
const SAMPLES: u32 = 1200;
/// Length of Kepler's step.
const KEPLER_STEP: f64 = 0.5;
/// Momentum along y from which Kepler's step starts.
const KEPLER_MOMENTUM: f64 = 1.0;

/// The section: roots of double well and pendulum, Kepler's bound.
pub(super) fn section(atlas: &mut Atlas) -> Result<(), Failure> {
    atlas.section("No solution, one, or several");
    atlas.prose(
        "A fixed step of the midpoint rule solves an equation, which may have several solutions, or none. With <i>w</i> = \
         <i>q</i> + <i>hp</i>/2, where free flight would have its middle, the number of solutions depends on <i>w</i> and \
         <i>h</i> alone.",
    );
    let caption = "Double well: solutions of the momentum equation, counted. The dashed curve is theory’s: beyond \
                   <i>h</i> = 2/√(−<i>V</i>″<sub>min</sub>/<i>m</i>) = 2 a step from near the barrier has three.";
    let grid =
        atlas.grid(Axes { x: Axis::linear("w = q + h p/2").over(-1.0, 1.0), y: Axis::linear("h").over(1.0, 4.0) });
    let fold = boundary("two solutions meet", well_fold());
    atlas.map(
        Labels { name: "roots-well", title: "Solutions of one fixed step: double well", caption },
        &grid,
        fold,
        |w, h| count(&DoubleWell::default(), w, h, 4.0),
    )?;
    let caption = "Pendulum: the same near its highest point, <i>θ</i> = π.";
    let grid =
        atlas.grid(Axes { x: Axis::linear("w = θ + h p/2").over(0.0, 2.0 * PI), y: Axis::linear("h").over(1.0, 4.0) });
    let fold = boundary("two solutions meet", pendulum_fold());
    atlas.map(
        Labels { name: "roots-pendulum", title: "Solutions of one fixed step: pendulum", caption },
        &grid,
        fold,
        |w, h| count(&Pendulum::default(), w, h, 4.0),
    )?;
    let caption = "Kepler’s problem, <i>μ</i> = 1, one step of <i>h</i> = 0.5 with <i>p</i> = (0, 1) from every place: inside \
                   the circle |<i>q</i> + <i>hp</i>/2|³ = (27/16) <i>μh</i>² no step exists, and the solver says so.";
    let grid = atlas.grid(kepler_axes()).square();
    let circle = boundary("(27/16) μ h²", vec![kepler_circle()]);
    atlas.map(
        Labels { name: "roots-kepler", title: "One fixed step of Kepler’s problem", caption },
        &grid,
        circle,
        kepler,
    )?;
    atlas.advice(
        "Keep <i>h</i> below 2/√(−<i>V</i>″<sub>min</sub>/<i>m</i>), and near an attracting centre below \
         (16 <i>r</i>³/27<i>μ</i>)<sup>1/2</sup>. The solver follows the solution that is connected with <i>h</i> → 0; \
         where it reports that there is none, halve the step.",
    );
    Ok(())
}

/// Solutions of a fixed step from `w` at rest, within `reach` of it on either side, counted by changes of sign.
fn count<S: FixedStepping<1>>(system: &S, w: f64, h: f64, reach: f64) -> Class {
    let node = Node::new(State { t: 0.0, q: [w].into(), p: SVector::zeros() }, 0.0);
    let residual = |index: u32| {
        let middle = reach * (2.0 * (f64::from(index) + 0.5) / f64::from(SAMPLES) - 1.0);
        system.momentum_equation(&node, h, &SVector::from([2.0 * middle / h])).residual.x < 0.0
    };
    let changes = (1..SAMPLES).filter(|&index| residual(index) != residual(index - 1)).count();
    if changes > 1 { SEVERAL } else { ONE }
}

/// The curve on which two solutions meet: `V' = 2x³ − x`, `V'' = 6x² − 1`.
fn well_fold() -> Vec<Vec<(f64, f64)>> {
    vec![fold(0.36, 0.0, |x| (2.0 * x.powi(3) - x, 6.0 * x * x - 1.0))]
}

/// The same for `V' = sin x`, `V'' = cos x`, about x = π.
fn pendulum_fold() -> Vec<Vec<(f64, f64)>> {
    vec![fold(1.35, PI, |x| (x.sin(), x.cos()))]
}

fn fold(half_width: f64, centre: f64, slopes: impl Fn(f64) -> (f64, f64)) -> Vec<(f64, f64)> {
    let points = (-300..=300).map(|index| {
        let x = centre + half_width * f64::from(index) / 300.0;
        let (slope, curvature) = slopes(x);
        (x - slope / curvature, 2.0 / (-curvature).sqrt())
    });
    points.filter(|(_, h)| *h <= 4.0).collect()
}

fn kepler_axes() -> Axes {
    Axes { x: Axis::linear("x").over(-1.5, 1.5), y: Axis::linear("y").over(-1.5, 1.5) }
}

/// Whether a step leads away from (x, y).
fn kepler(x: f64, y: f64) -> Class {
    let limit = Limit { steps: 1, until: f64::INFINITY, bound: f64::INFINITY };
    let class = Course::fixed(Kepler::default(), [x, y], [0.0, KEPLER_MOMENTUM], KEPLER_STEP, limit).ending.class();
    if class == LASTING { EXISTS } else { class }
}

fn kepler_radius() -> f64 {
    (27.0 / 16.0 * KEPLER_STEP * KEPLER_STEP).cbrt()
}

fn kepler_circle() -> Vec<(f64, f64)> {
    let angles = (0..=360).map(|degrees| f64::from(degrees).to_radians());
    angles
        .map(|angle| {
            (kepler_radius() * angle.cos(), kepler_radius() * angle.sin() - KEPLER_STEP * KEPLER_MOMENTUM / 2.0)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::atlas::Grid;
    use super::super::atlas::tests::strays;
    use super::super::ending::NOT_CONVERGED;
    use super::*;

    #[test]
    fn the_kepler_map_ends_at_its_bound() {
        let grid = Grid::new(kepler_axes(), 50).square();
        let cells = grid.cells(&kepler, |_| ());
        let inside = |x: f64, y: f64| x.hypot(y + KEPLER_STEP * KEPLER_MOMENTUM / 2.0) < kepler_radius();
        assert_eq!(strays(&grid, &cells, NOT_CONVERGED, inside), 0);
        assert!(cells.iter().all(|cell| [EXISTS, NOT_CONVERGED].contains(cell)));
    }

    #[test]
    fn several_roots_lie_inside_the_fold() {
        let grid = Grid::new(Axes { x: Axis::linear("w").over(-1.0, 1.0), y: Axis::linear("h").over(1.0, 4.0) }, 60);
        let cells = grid.cells(&|w, h| count(&DoubleWell::default(), w, h, 4.0), |_| ());
        // By the cubic formula: x + (h²/4)(2x³ − x) = w, that is x³ + b x = c, has three roots iff 4 b³ + 27 c² < 0.
        let three = |w: f64, h: f64| {
            let b = (1.0 - h * h / 4.0) * 2.0 / (h * h);
            let c = 2.0 * w / (h * h);
            4.0 * b.powi(3) + 27.0 * c * c < 0.0
        };
        assert_eq!(strays(&grid, &cells, SEVERAL, three), 0);
        let fold = well_fold().concat();
        let lowest = fold.iter().map(|(_, h)| *h).fold(f64::INFINITY, f64::min);
        // Exactly 2, at x = 0.
        assert!((lowest - 2.0).abs() < 1e-15, "{lowest}");
    }
}
