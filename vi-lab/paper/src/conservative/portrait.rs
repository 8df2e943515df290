//! Phase portraits of both integrators, with the level sets of H behind.

use super::super::book::Book;
use super::runs::{Pair, Sample};
use vi_report::chart::{Axis, Chart, Look, Series};
use vi_report::failure::Failure;

/// A portrait: file name, amplitude, time of about one oscillation, window, level sets of H.
struct Portrait {
    name: &'static str,
    q0: f64,
    until: f64,
    q: (f64, f64),
    v: (f64, f64),
    levels: [f64; 6],
}

/// Deep in the well, and about the orbit near the separatrix H = 0.
const PORTRAITS: [Portrait; 2] = [
    Portrait {
        name: "portrait-0.74",
        q0: 0.74,
        until: 4.5,
        q: (0.625, 0.785),
        v: (-0.08, 0.08),
        levels: [-0.1248, -0.1244, -0.123, -0.122, -0.1205, -0.1185],
    },
    Portrait {
        name: "portrait-0.995",
        q0: 0.995,
        until: 7.6,
        q: (-0.15, 1.15),
        v: (-0.62, 0.62),
        levels: [-0.1, -0.05, -0.02, 0.0, 0.05, 0.12],
    },
];
/// Points of half a level set.
const FINENESS: u32 = 400;

/// The section: one portrait per amplitude, at the larger step, where a difference could be seen.
pub(super) fn section(book: &mut Book, runs: &[Pair]) -> Result<(), Failure> {
    book.section("Phase portraits");
    book.prose(
        "Both integrators are symplectic, and both stay on a closed curve. They differ in where they put their points: the \
         energy-preserving integrator takes longer steps where the motion is slow and smooth, near the saddle.",
    );
    for portrait in PORTRAITS {
        let run = runs.iter().find(|run| run.case.q0.total_cmp(&portrait.q0).is_eq() && run.case.h0 > 0.05);
        if let Some(run) = run {
            figure(book, &portrait, run)?;
        }
    }
    Ok(())
}

fn figure(book: &mut Book, portrait: &Portrait, run: &Pair) -> Result<(), Failure> {
    let points = |samples: &[Sample]| {
        let oscillation = samples.iter().take_while(|sample| sample.t < portrait.until);
        oscillation.map(|sample| (sample.q, sample.v)).collect::<Vec<_>>()
    };
    let fixed = points(&run.fixed.samples);
    let adaptive = points(&run.energy.samples);
    let caption = format!(
        "Midpoints of the steps of about one oscillation: {} energy-preserving, {} fixed. In grey level sets of <i>H</i>.",
        adaptive.len(),
        fixed.len()
    );
    let mut series: Vec<Series> =
        portrait.levels.iter().flat_map(|&level| level_set(level)).map(Series::background).collect();
    series.push(Series::scatter("fixed step", Look::FIXED.dots(3.0), fixed));
    series.push(Series::scatter("energy-preserving", Look::ENERGY.dots(3.0), adaptive));
    let chart = Chart {
        name: portrait.name,
        title: format!("Phase portrait, {}", run.case.label()),
        x: Axis::linear("q").over(portrait.q.0, portrait.q.1),
        y: Axis::linear("v").over(portrait.v.0, portrait.v.1),
        equal_aspect: true,
        series,
    };
    book.figure(&chart, &caption)
}

/// The part of the level set `v² = 2H + q² − q⁴` in the right half plane: upper and lower branch.
fn level_set(level: f64) -> Vec<Vec<(f64, f64)>> {
    // With s = q²: s² − s − 2H = 0 at the turning points.
    let root = (1.0 + 8.0 * level).sqrt();
    let inner = ((1.0 - root) / 2.0).max(0.0).sqrt();
    let outer = f64::midpoint(1.0, root).sqrt();
    // Below the separatrix a branch starts at the inner turning point, above it at the border of the figure.
    let start = if level > 0.0 { -outer } else { inner };
    let branch = |sign: f64| {
        (0..=FINENESS)
            .map(|index| {
                // Points crowd at the turning points, where the curve is steep.
                let angle = core::f64::consts::PI * f64::from(index) / f64::from(FINENESS);
                let q = start + (outer - start) * (1.0 - angle.cos()) / 2.0;
                (q, sign * (2.0 * level + q * q * (1.0 - q * q)).max(0.0).sqrt())
            })
            .collect()
    };
    vec![branch(1.0), branch(-1.0)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn level_sets_are_level() {
        let mut worst = 0.0_f64;
        for level in PORTRAITS.iter().flat_map(|portrait| portrait.levels) {
            for (q, v) in level_set(level).concat() {
                let energy = v * v / 2.0 + (q.powi(4) - q * q) / 2.0;
                worst = worst.max((energy - level).abs());
            }
        }
        // Measured 1.7e-16, at a turning point, where v is set to 0.
        assert!(worst > 0.0 && worst < 2e-16, "{worst}");
    }
}
