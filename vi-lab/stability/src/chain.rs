//! A chain of springs: where fixed steps blow up, over amplitude and step.
//!
//! Eight masses between walls on springs with the force r + r³. At small amplitude the fastest mode has
//! `ω = 2 sin(4π/9)`: the trapezoidal rule is stable up to h = 2/ω = 1.0154. At larger amplitude the springs stiffen.

use super::atlas::{Atlas, Axes, Labels};
use super::ending::{Course, Limit};
use super::trial::{Chain, trapezoidal};
use core::f64::consts::PI;
use vi_core::stepping::FixedStepping;
use vi_report::chart::{Axis, Class, boundary};
use vi_report::failure::Failure;

const LIMIT: Limit = Limit { steps: 1000, until: f64::INFINITY, bound: 100.0 };
const STEPS: (f64, f64) = (0.1, 3.0);
const AMPLITUDES: (f64, f64) = (0.01, 10.0);

/// The section: two maps.
pub(super) fn section(atlas: &mut Atlas) -> Result<(), Failure> {
    atlas.section("A chain of springs");
    atlas.prose(
        "Eight masses between walls, on springs that stiffen (the <i>β</i>-chain of Fermi, Pasta, Ulam and Tsingou), \
         started in their lowest mode. The energy spreads to faster modes, and with the amplitude all frequencies rise: a \
         step that is stable for a gentle motion blows up in a violent one.",
    );
    let linear = linear_limit();
    let line = boundary("linear limit, h = 1.015", vec![vec![(AMPLITUDES.0, linear), (AMPLITUDES.1, linear)]]);
    let grid = atlas.coarse_grid(
        Axes {
            x: Axis::log10("amplitude").over(AMPLITUDES.0, AMPLITUDES.1),
            y: Axis::linear("h").over(STEPS.0, STEPS.1),
        },
        2,
    );
    let caption = "Trapezoidal rule, 1000 steps. Dashed: 2/<i>ω</i><sub>max</sub> of the linear chain, which holds at small \
                   amplitude only.";
    atlas.map(
        Labels { name: "chain-trapezoidal", title: "Chain of springs: trapezoidal rule", caption },
        &grid,
        line,
        |amplitude, h| class(trapezoidal(Chain::default()), amplitude, h),
    )?;
    let caption = "Midpoint rule, 1000 steps: no limit at small amplitude. The springs have no negative curvature, so that \
                   every step has one solution; yet a violent motion may still run away.";
    atlas.map(
        Labels { name: "chain-midpoint", title: "Chain of springs: midpoint rule", caption },
        &grid,
        Vec::new(),
        |amplitude, h| class(Chain::default(), amplitude, h),
    )?;
    atlas.advice(
        "Take the highest frequency at the largest amplitude that will occur, not that of the chain at rest, and keep a \
         factor of two below its limit; or take the midpoint rule, whose steps cost one banded solve per iteration.",
    );
    Ok(())
}

/// 2/ω of the fastest mode, `ω = 2 sin(8π/18)`.
fn linear_limit() -> f64 {
    1.0 / (4.0 * PI / 9.0).sin()
}

/// How a run from the lowest mode ends.
fn class<S: FixedStepping<8>>(system: S, amplitude: f64, h: f64) -> Class {
    let mut place = 0.0;
    let mode = [(); 8].map(|()| {
        place += 1.0;
        amplitude * (PI * place / 9.0).sin()
    });
    Course::fixed(system, mode, [0.0; 8], h, LIMIT).ending.class()
}

#[cfg(test)]
mod tests {
    use super::super::ending::{LASTING, UNBOUNDED};
    use super::*;

    #[test]
    fn gentle_motion_has_the_linear_limit() {
        // 1.0154266118857451 in `stability.json`, found by bisection to 5e-14.
        assert!((linear_limit() - 1.015_426_611_885_745_1).abs() < 1e-13);
        let ends = |h: f64| class(trapezoidal(Chain::default()), 0.01, h);
        assert_eq!((ends(0.99 * linear_limit()), ends(1.03 * linear_limit())), (LASTING, UNBOUNDED));
        assert_eq!(class(Chain::default(), 0.01, 3.0), LASTING);
    }
}
