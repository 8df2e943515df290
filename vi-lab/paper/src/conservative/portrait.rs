//! Phase portraits of both integrators with the exact orbit, for both amplitudes and both initial steps.

use super::super::book::{Book, Verdict};
use super::runs::{Pair, Sample};
use vi_report::chart::{Axis, Chart, Look, Series};
use vi_report::numbers::scientific;

/// An amplitude: time of about one oscillation, window, level sets of H.
struct Portrait {
    names: [&'static str; 2],
    q0: f64,
    until: f64,
    q: (f64, f64),
    v: (f64, f64),
    levels: [f64; 6],
}

/// Deep in the well, and near the separatrix H = 0.
const PORTRAITS: [Portrait; 2] = [
    Portrait {
        names: ["portrait-0.74-0.01", "portrait-0.74-0.1"],
        q0: 0.74,
        until: 4.5,
        q: (0.625, 0.785),
        v: (-0.08, 0.08),
        levels: [-0.1248, -0.1244, -0.123, -0.122, -0.1205, -0.1185],
    },
    Portrait {
        names: ["portrait-0.995-0.01", "portrait-0.995-0.1"],
        q0: 0.995,
        until: 7.6,
        q: (-0.15, 1.15),
        v: (-0.62, 0.62),
        levels: [-0.1, -0.05, -0.02, 0.0, 0.05, 0.12],
    },
];
/// Points of half a level set.
const FINENESS: u32 = 400;

/// The section: one portrait for each case.
pub(super) fn section(book: &mut Book, runs: &[Pair]) {
    book.page.section("Phase portraits");
    book.page.prose(
        "Both integrators stay on a closed curve. The exact orbit is the level set of <i>H</i> through the initial state; it \
         is the benchmark. The energy-preserving integrator takes longer steps near the saddle, where the motion is slow.",
    );
    for run in runs {
        let portrait = PORTRAITS.iter().find(|portrait| portrait.q0.total_cmp(&run.case.q0).is_eq());
        if let Some(portrait) = portrait {
            figure(book, portrait, run);
        }
    }
}

fn figure(book: &mut Book, portrait: &Portrait, run: &Pair) {
    let is_fine = run.case.h0 < 0.05;
    let name = portrait.names[usize::from(!is_fine)];
    let points = |samples: &[Sample]| {
        let oscillation = samples.iter().take_while(|sample| sample.t < portrait.until);
        oscillation.map(|sample| (sample.q, sample.v)).collect::<Vec<_>>()
    };
    let start = potential(run.case.q0);
    let distance = |points: &[(f64, f64)]| {
        let excess = points.iter().map(|(q, v)| (v * v / 2.0 + potential(*q) - start).abs());
        excess.fold(0.0, f64::max)
    };
    let fixed = points(&run.fixed.samples);
    let adaptive = points(&run.energy.samples);
    let [off_fixed, off_adaptive] = [&fixed, &adaptive].map(|points| distance(points));
    let caption = format!(
        "Midpoints of the steps of one oscillation: {} energy-preserving, {} fixed. Dashed: the exact orbit. On the exact orbit \
         <i>H</i> = {start:.5}; the energy-preserving midpoints differ from it by at most {}, the fixed ones by {}. Grey: \
         level sets of <i>H</i>.",
        adaptive.len(),
        fixed.len(),
        scientific(off_adaptive),
        scientific(off_fixed)
    );
    let radius = if is_fine { 1.6 } else { 3.0 };
    let mut series: Vec<Series> =
        portrait.levels.iter().flat_map(|&level| level_set(level)).map(Series::background).collect();
    series.push(Series::scatter("fixed step", Look::FIXED.dots(radius), fixed));
    series.push(Series::scatter("energy-preserving", Look::ENERGY.dots(radius), adaptive));
    for (index, branch) in level_set(start).into_iter().enumerate() {
        let branch = Series::curve("exact orbit", Look::EXACT, branch);
        series.push(if index == 0 { branch } else { branch.unlabelled() });
    }
    let chart = Chart {
        equal_aspect: true,
        ..Chart::new(
            name,
            format!("Phase portrait, {}", run.case.label()),
            [Axis::linear("q").over(portrait.q.0, portrait.q.1), Axis::linear("v").over(portrait.v.0, portrait.v.1)],
            series,
        )
    };
    book.page.figure(chart.figure(), &caption);
    // The widest visible deviation: a hundredth of the depth of the well, 1/8.
    let worst = off_fixed.max(off_adaptive);
    book.item(
        &format!("figure: phase portrait, {}; both agree with the benchmark", run.case.label()),
        "—",
        format!("H of both midpoints within {} of the exact orbit", scientific(worst)),
        Verdict::Agrees.when(worst < 0.01 / 8.0),
        name,
    );
}

/// `V = (q⁴ − q²)/2`.
fn potential(q: f64) -> f64 {
    (q.powi(4) - q * q) / 2.0
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
                // Points are dense at the turning points, because the curve is steep there.
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
        let starts = PORTRAITS.iter().map(|portrait| potential(portrait.q0));
        for level in PORTRAITS.iter().flat_map(|portrait| portrait.levels).chain(starts) {
            for (q, v) in level_set(level).concat() {
                let energy = v * v / 2.0 + potential(q);
                worst = worst.max((energy - level).abs());
            }
        }
        // Measured 1.7e-16, at a turning point, at which v is set to 0.
        assert!(worst > 0.0 && worst < 2e-16, "{worst}");
    }
}
