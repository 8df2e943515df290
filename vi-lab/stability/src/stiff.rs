//! Stiff springs: a mass on a spring under gravity, over the frequency of the spring and the step.
//!
//! The slow motion is a pendulum of frequency 1, the fast one the spring with ω = √k. The trapezoidal rule must resolve
//! the fast one, `h ω < 2`, although it is too small to be seen.

use super::atlas::{Atlas, Axes, Labels};
use super::ending::{Course, Limit};
use super::trial::{SpringPendulum, trapezoidal};
use vi_report::chart::{Axis, boundary};
use vi_report::failure::Failure;

/// Three oscillations of the pendulum, or this many steps.
const LIMIT: Limit = Limit { steps: 2000, until: 20.0, bound: 10.0 };
/// One radian from the lowest point, the spring at its length.
const START: [f64; 2] = [0.0, 1.0];
/// No velocity.
const AT_REST: [f64; 2] = [0.0, 0.0];
const FASTEST: f64 = 1000.0;

/// The section: three maps.
pub(super) fn section(atlas: &mut Atlas) -> Result<(), Failure> {
    atlas.section("Stiff springs");
    atlas.prose(
        "A pendulum whose rod is a spring: a slow swing of frequency 1, and a fast vibration of frequency \
         <i>ω</i> = √(<i>k</i>/<i>m</i>), excited only slightly. Each run starts one radian aside with the spring at its \
         length, and covers three swings or 2000 steps.",
    );
    let grid = atlas.grid(Axes {
        x: Axis::log10("frequency of the spring ω").over(3.0, FASTEST),
        y: Axis::log10("h").over(1e-3, 2.0),
    });
    let caption = "Trapezoidal rule: the spring must be resolved. Dashed: <i>hω</i> = 2.";
    let limit = boundary("hω = 2", vec![vec![(3.0, 2.0 / 3.0), (FASTEST, 2.0 / FASTEST)]]);
    atlas.map(
        Labels { name: "stiff-trapezoidal", title: "Spring pendulum: trapezoidal rule", caption },
        &grid,
        limit,
        |omega, h| {
            Course::fixed(trapezoidal(SpringPendulum { k: omega * omega }), START, AT_REST, h, LIMIT).ending.class()
        },
    )?;
    let caption = "Midpoint rule: stable far beyond the spring’s period, as long as the slow motion is resolved. What is no \
                   longer resolved is the vibration itself.";
    atlas.map(
        Labels { name: "stiff-midpoint", title: "Spring pendulum: midpoint rule", caption },
        &grid,
        Vec::new(),
        |omega, h| Course::fixed(SpringPendulum { k: omega * omega }, START, AT_REST, h, LIMIT).ending.class(),
    )?;
    let caption = "Energy-preserving: the vertical axis is the first step. The step density stays positive, and the run goes \
                   on; but the energy, kept to rounding, says nothing of how well the vibration is resolved.";
    atlas.map(
        Labels { name: "stiff-energy", title: "Spring pendulum: energy-preserving", caption },
        &grid,
        Vec::new(),
        |omega, h| Course::energy(SpringPendulum { k: omega * omega }, START, AT_REST, h, LIMIT).ending.class(),
    )?;
    atlas.advice(
        "Where a stiff spring stands for a rod, take the midpoint rule, with fixed or energy-preserving steps, at a step that \
         resolves the slow motion; the trapezoidal rule has to resolve the fast one. Choose coordinates in which the spring \
         force is small where the stretch is: the difference of two lengths loses digits to rounding, and with them the \
         solver its measure of a solution.",
    );
    Ok(())
}
