//! Phase portraits of both integrators, with the level sets of H behind.

use super::super::super::chart::{Axis, Chart, Look, Series};
use super::super::super::failure::Failure;
use super::super::book::Book;
use super::runs::{Run, Sample};

/// Values of H whose level sets are drawn; 0 is the separatrix.
const LEVELS: [f64; 6] = [-0.1, -0.05, -0.02, 0.0, 0.05, 0.12];
/// Points of half a level set.
const FINENESS: u32 = 400;

/// The section: one portrait per amplitude, at the larger step, where a difference could be seen.
pub(super) fn section(book: &mut Book, runs: &[Run]) -> Result<(), Failure> {
    book.section("Phase portraits");
    book.prose(
        "Both integrators are symplectic, and both stay on a closed curve. They differ in where they put their points: the \
         energy-preserving integrator takes longer steps where the motion is slow and smooth, near the saddle.",
    );
    for run in runs.iter().filter(|run| run.case.h0 > 0.05) {
        let name = if run.case.q0 < 0.9 { "portrait-0.74" } else { "portrait-0.995" };
        let points = |samples: &[Sample]| samples.iter().map(|sample| (sample.q, sample.v)).collect::<Vec<_>>();
        let mut series: Vec<Series> =
            LEVELS.iter().flat_map(|&level| level_set(level)).map(Series::background).collect();
        series.push(Series::scatter("fixed step", Look::FIXED.dots(2.6), points(&run.fixed.samples)));
        series.push(Series::scatter("energy-preserving", Look::ENERGY.dots(2.2), points(&run.energy.samples)));
        let chart = Chart {
            name,
            title: format!("Phase portrait, {}", run.case.label()),
            x: Axis::linear("q").over(-0.15, 1.15),
            y: Axis::linear("v").over(-0.62, 0.62),
            equal_aspect: true,
            series,
        };
        let caption = format!(
            "Midpoints of the steps up to <i>t</i> = 40; in grey level sets of <i>H</i>. Energy-preserving: {} points, \
             fixed step: {} points.",
            run.energy.samples.len(),
            run.fixed.samples.len()
        );
        book.figure(&chart, &caption)?;
    }
    Ok(())
}

/// The part of the level set `v² = 2H + q² − q⁴` in the right half plane: upper and lower branch.
fn level_set(level: f64) -> Vec<Vec<(f64, f64)>> {
    // With s = q²: s² − s − 2H = 0 at the turning points.
    let root = (1.0 + 8.0 * level).sqrt();
    let (inner, outer) = (((1.0 - root) / 2.0).max(0.0).sqrt(), ((1.0 + root) / 2.0).sqrt());
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
        for level in LEVELS {
            for (q, v) in level_set(level).concat() {
                let energy = v * v / 2.0 + (q.powi(4) - q * q) / 2.0;
                // Measured 5e-17, and at the turning points, where v is set to 0, 3e-17.
                assert!((energy - level).abs() < 1e-16, "H = {level}: {energy} at ({q}, {v})");
            }
        }
    }
}
