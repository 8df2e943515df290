//! The paper's trade-off between a small first step and the energy, and its removal.
//!
//! The same equations are solved three times from the same start: in `(q1, t1)`, where both quotients of
//! `(q1 − q0)/(t1 − t0)` cancel; in `(v, h)`, rows as they stand; and scaled, with the sums compensated and E carried.

use super::atlas::Atlas;
use rayon::prelude::*;
use vi_core::{EnergyPreserving, Lagrangian, SVector, StepError};
use vi_erased::start::second_point;
use vi_paper::raw::{RawNode, Unknowns};
use vi_report::chart::{Axis, Chart, Look, Series};
use vi_report::failure::Failure;
use vi_systems::DoubleWell;

const LADDER: [f64; 9] = [1e-5, 3e-5, 1e-4, 3e-4, 1e-3, 3e-3, 0.01, 0.03, 0.1];
/// Steps of each run.
const STEPS: u32 = 20_000;
const Q0: f64 = 0.74;

/// Largest energy errors from one first step.
struct Rung {
    h0: f64,
    points: f64,
    velocity: f64,
    scaled: f64,
}

/// The section: one chart.
pub(super) fn section(atlas: &mut Atlas) -> Result<(), Failure> {
    atlas.section("A small first step and the energy");
    let rungs: Result<Vec<Rung>, StepError> = LADDER.par_iter().map(|&h0| rung(h0)).collect();
    let rungs = rungs.map_err(|error| Failure::Step {
        error: Box::new(error),
        before: "the first steps of the ladder".to_owned(),
        advice: None,
    })?;
    let line = |label: &str, look: Look, pick: fn(&Rung) -> f64| {
        Series::line(label, look, rungs.iter().map(|rung| (rung.h0, pick(rung))).collect())
    };
    let [first, second, ..] = Look::OTHERS;
    let chart = Chart {
        name: "tradeoff",
        title: "Energy error against the first step, solved in three ways".to_owned(),
        x: Axis::log10("h₀"),
        y: Axis::log10("max |Eₖ − E₁|").over(1e-18, 1e-9),
        equal_aspect: false,
        series: vec![
            line("in (q₁, t₁)", first, |rung| rung.points),
            line("in (v, h)", second, |rung| rung.velocity),
            line("scaled and carried", Look::ENERGY, |rung| rung.scaled),
        ],
    };
    atlas.chart(
        &chart,
        "Double well, <i>q</i><sub>0</sub> = 0.74, 20 000 steps from each first step. In (<i>q</i><sub>1</sub>, \
         <i>t</i><sub>1</sub>) the energy gets worse as the step gets smaller: this is the trade-off that the paper \
         reports. In (<i>v</i>, <i>h</i>) nothing cancels: what is left is the rounding of <i>E</i>, computed anew at every \
         node, which adds up over the steps, whatever their length. Scaled, and with <i>E</i> carried, it stays at a single \
         rounding.",
    )?;
    atlas.advice(
        "Choose <i>h</i><sub>0</sub> for the accuracy of the trajectory alone. If you write such an integrator yourself: solve \
         for (<i>v</i>, <i>h</i>), take <i>v</i> times the momentum row from the energy row, and carry <i>E</i>.",
    );
    Ok(())
}

fn rung(h0: f64) -> Result<Rung, StepError> {
    let system = DoubleWell::default();
    let q0 = SVector::from([Q0]);
    let second = second_point(&system, 0.0, q0, SVector::zeros(), h0)?;
    let mut run = EnergyPreserving::from_points(system, (0.0, q0), second)?;
    let energy = run.node().energy;
    let [points, velocity] = [Unknowns::Points, Unknowns::Velocity].map(|unknowns| {
        let mut node = Some(RawNode::first(&run));
        let mut worst = 0.0_f64;
        for _ in 0..STEPS {
            node = node.and_then(|node| node.next(&system, unknowns));
            worst = node.map_or(f64::NAN, |node| worst.max((node.energy - energy).abs()));
        }
        worst
    });
    let mut scaled = 0.0_f64;
    for _ in 0..STEPS {
        let (t, q, v) = run.detailed_step()?.midpoint;
        scaled = scaled.max((system.energy(t, &q, &v) - energy).abs());
    }
    Ok(Rung { h0, points, velocity, scaled })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_trade_off_is_the_solvers() {
        let [small, large] = [1e-4, 0.01].map(|h0| rung(h0).expect("a run"));
        // Measured in (q1, t1) 1.3e-12 and 8.2e-14, in (v, h) 4.2e-16 and 2.2e-15, sums of roundings of E, scaled 1.1e-16 and 1.1e-16.
        assert!(small.points > 5.0 * large.points && small.points > 100.0 * small.scaled);
        assert!(small.velocity < 3e-15 && large.velocity < 3e-15);
        assert!(small.scaled <= 2.3e-16 && large.scaled <= 2.3e-16);
    }
}
