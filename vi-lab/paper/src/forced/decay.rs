//! Trajectories and energy of the damped oscillator against the exact motion, for the three damping ratios of the paper.

use super::super::book::{Book, Verdict};
use super::super::unexpected;
use super::oscillator::{OMEGA, Sample, Sampled, energy_preserving, exact, exact_energy, fixed};
use super::{DAMPING, H0};
use core::f64::consts::PI;
use vi_report::chart::{Axis, Chart, Look, Series};
use vi_report::failure::Failure;
use vi_report::numbers::{extremes, scientific};

/// Time that the figures show.
const UNTIL: f64 = 100.0;
/// Time over which early errors are averaged.
const EARLY: f64 = 20.0;
/// Points of the exact curve.
const FINENESS: u32 = 4000;
/// Half a period of the energy error: the energy error oscillates with twice the frequency of the motion.
const WINDOW: f64 = PI / OMEGA;

/// Names of the figures of the trajectory and of the energy error, for each damping ratio.
const NAMES: [[&str; 2]; 3] = [
    ["damped-trajectory-0.001", "damped-energy-error-0.001"],
    ["damped-trajectory-0.005", "damped-energy-error-0.005"],
    ["damped-trajectory-0.01", "damped-energy-error-0.01"],
];

/// Both runs with one damping ratio.
struct Damped {
    zeta: f64,
    adaptive: Sampled,
    constant: Sampled,
    names: [&'static str; 2],
}

/// The sections: trajectories, energy errors and their amplitudes.
pub(super) fn section(book: &mut Book) -> Result<(), Failure> {
    let mut runs = Vec::new();
    for (zeta, names) in DAMPING.into_iter().zip(NAMES) {
        let adaptive = energy_preserving(zeta, UNTIL, u32::MAX).map_err(unexpected("damped oscillator"))?;
        let constant = fixed(zeta, UNTIL).map_err(unexpected("damped oscillator"))?;
        runs.push(Damped { zeta, adaptive, constant, names });
    }
    book.page.section("Damped trajectories");
    for run in &runs {
        trajectory(book, run);
    }
    book.page.section("Damped energy");
    book.page.prose(
        "With a force <i>E<sub>k</sub></i> is not constant: it changes by the discrete work of the force. The paper defines the \
         energy error as the difference of <i>E<sub>k</sub></i> and the energy of the exact motion at the same time, \
         <i>E<sub>k</sub></i> − <i>E</i>(<i>t<sub>k</sub></i>).",
    );
    for run in &runs {
        energy_error(book, run);
    }
    amplitudes(book, &runs);
    Ok(())
}

fn pairs(run: &Sampled, value: impl Fn(&Sample) -> f64) -> Vec<(f64, f64)> {
    run.samples.iter().map(|sample| (sample.t, value(sample))).collect()
}

fn curve(value: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
    (0..=FINENESS).map(|index| UNTIL * f64::from(index) / f64::from(FINENESS)).map(|t| (t, value(t))).collect()
}

impl Damped {
    /// A quantity of each node of both runs: energy-preserving, fixed step.
    fn each(&self, value: impl Fn(&Sample) -> f64) -> [Vec<(f64, f64)>; 2] {
        [pairs(&self.adaptive, &value), pairs(&self.constant, &value)]
    }

    /// The paper's energy error.
    fn absolute(&self, sample: &Sample) -> f64 {
        sample.energy - exact_energy(self.zeta, sample.t)
    }
}

fn trajectory(book: &mut Book, run: &Damped) {
    let [adaptive, constant] = run.each(|sample| sample.q);
    let chart = Chart::new(
        run.names[0],
        format!("Damped trajectory, ζ = {}", run.zeta),
        [Axis::linear("t"), Axis::linear("q")],
        vec![
            Series::line("fixed step", Look { width: 3.4, ..Look::FIXED.line() }, constant),
            Series::line("energy-preserving", Look::ENERGY.line(), adaptive),
            Series::line("exact", Look { width: 1.0, ..Look::EXACT }, curve(|t| exact(run.zeta, t).0)),
        ],
    );
    let [adaptive, constant] = run.each(|sample| (sample.q - exact(run.zeta, sample.t).0).abs()).map(largest);
    book.page.figure(
        chart.figure(),
        &format!(
            "The three curves coincide: the energy-preserving <i>q</i> is off by at most {}, the fixed step by {}. Up to \
             <i>t</i> = {UNTIL} the energy-preserving integrator takes {} steps, the fixed step {}.",
            scientific(adaptive),
            scientific(constant),
            run.adaptive.samples.len(),
            run.constant.samples.len()
        ),
    );
    book.item(
        &format!("figure: damped trajectories, ζ = {}: both indistinguishable from the exact solution", run.zeta),
        "—",
        format!("largest error of q: {} energy-preserving, {} fixed", scientific(adaptive), scientific(constant)),
        // The lines of the figure are up to 3.4 pixels wide, and a pixel is 0.006.
        Verdict::Agrees.when(adaptive.max(constant) < 0.02),
        run.names[0],
    );
}

fn largest(points: Vec<(f64, f64)>) -> f64 {
    points.into_iter().map(|(_, value)| value.abs()).fold(0.0, f64::max)
}

fn energy_error(book: &mut Book, run: &Damped) {
    let [adaptive, constant] = run.each(|sample| run.absolute(sample));
    let chart = Chart::new(
        run.names[1],
        format!("Energy error as the paper defines it, ζ = {}", run.zeta),
        [Axis::linear("t"), Axis::linear("Eₖ − E(t)")],
        vec![
            Series::line("energy-preserving", Look::ENERGY.line(), adaptive),
            Series::line("fixed step", Look::FIXED.line(), constant),
        ],
    );
    book.page.figure(
        chart.figure(),
        "Difference of the discrete energy and the energy of the exact motion. Both errors start at \
         −<i>h</i><sub>0</sub>²<i>D</i>/8, because both runs start from the same interval.",
    );
}

/// Amplitude of the oscillation of an error in windows of half a period: half of its range, at the middle of the window.
fn envelope(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut envelope = Vec::new();
    let mut start = 0.0;
    while start + WINDOW <= UNTIL {
        let inside = points.iter().filter(|(t, _)| (start..start + WINDOW).contains(t)).map(|(_, error)| *error);
        let (low, high) = extremes(inside);
        envelope.push((start + WINDOW / 2.0, (high - low) / 2.0));
        start += WINDOW;
    }
    envelope
}

/// The phase error of a run: `ω³/12 ∫ h² dt`, with h = h0 or h = h0 e^{ζωt}.
fn phase_error(zeta: f64, t: f64, is_adaptive: bool) -> f64 {
    let rate = 2.0 * zeta * OMEGA;
    let duration = if is_adaptive { (rate * t).exp_m1() / rate } else { t };
    OMEGA.powi(3) * H0 * H0 / 12.0 * duration
}

/// The amplitude of the energy error: E(t) oscillates by ζE with twice the phase of the motion, so a phase error δφ makes 2ζEδφ.
fn law(zeta: f64, t: f64, is_adaptive: bool) -> f64 {
    let energy = OMEGA * OMEGA / 2.0 * (-2.0 * zeta * OMEGA * t).exp();
    2.0 * zeta * energy * phase_error(zeta, t, is_adaptive)
}

/// Amplitudes of the energy-preserving and of the fixed error.
struct Amplitudes {
    zeta: f64,
    adaptive: Vec<(f64, f64)>,
    constant: Vec<(f64, f64)>,
}

impl Amplitudes {
    fn of(run: &Damped) -> Self {
        let [adaptive, constant] = run.each(|sample| run.absolute(sample)).map(|points| envelope(&points));
        Self { zeta: run.zeta, adaptive, constant }
    }
}

/// Amplitudes of the first and of the last window.
fn ends(envelope: &[(f64, f64)]) -> [f64; 2] {
    [envelope.first(), envelope.last()].map(|point| point.map_or(f64::NAN, |point| point.1))
}

/// The decay of both amplitudes, with the law.
fn amplitudes(book: &mut Book, runs: &[Damped]) {
    book.page.section("The amplitude of the damped energy error");
    book.page.prose(
        "The paper states that the amplitude of the fixed step’s error decays faster. This run confirms it, and the growing step \
         explains it. The exact energy oscillates by <i>ζE</i> about its decay, with twice the phase of the motion. The midpoint rule is late by \
         the phase δ<i>φ</i> = (<i>ω</i>³/12) ∫<i>h</i>² d<i>t</i>. So the energy error oscillates with the amplitude \
         2<i>ζE</i>δ<i>φ</i>. For the fixed step this is proportional to <i>t</i> e<sup>−2<i>ζωt</i></sup>: it decays after \
         <i>t</i> = 1/(2<i>ζω</i>). The energy-preserving step has <i>h</i> = <i>h</i><sub>0</sub>e<sup><i>ζωt</i></sup>, and its \
         amplitude (<i>ω</i>²<i>h</i><sub>0</sub>²<i>E</i><sub>0</sub>/12)(1 − e<sup>−2<i>ζωt</i></sup>) never decays. \
         <i>E</i><sub>0</sub> is the initial energy.",
    );
    let all: Vec<Amplitudes> = runs.iter().map(Amplitudes::of).collect();
    figure(book, &all);
    for (run, amplitudes) in runs.iter().zip(&all) {
        items(book, run, amplitudes);
    }
    let growth = all.iter().map(|amplitudes| {
        let [early, late] = ends(&amplitudes.adaptive);
        late / early
    });
    let (least, most) = extremes(growth);
    book.item(
        "the amplitude of the energy-preserving error does not decrease as quickly, because the step grows",
        "—",
        format!(
            "it does not decrease: at t = {UNTIL} it is {} to {} times the first",
            scientific(least),
            scientific(most)
        ),
        // Measured: 14 to 45.
        Verdict::Agrees.when(least > 1.0),
        "damped-energy-amplitudes",
    );
}

/// The statements of the paper about one damping ratio.
fn items(book: &mut Book, run: &Damped, amplitudes: &Amplitudes) {
    let zeta = run.zeta;
    let [early, late] = ends(&amplitudes.adaptive);
    let [early_fixed, late_fixed] = ends(&amplitudes.constant);
    let end = amplitudes.constant.last().map_or(f64::NAN, |(t, _)| *t);
    let [expected, expected_fixed] = [true, false].map(|is_adaptive| law(zeta, end, is_adaptive));
    let [ratio, last] = [early / early_fixed, late / late_fixed];
    book.item(
        &format!("figure: damped energy error, ζ = {zeta}: the amplitude of the fixed step decays faster"),
        "—",
        format!(
            "energy-preserving over fixed: {} at the start, {} at t = {UNTIL}",
            scientific(ratio),
            scientific(last)
        ),
        // Measured: the law holds to 1.6 %.
        Verdict::Agrees.when(
            last > ratio && (late / expected - 1.0).abs() < 0.1 && (late_fixed / expected_fixed - 1.0).abs() < 0.1,
        ),
        run.names[1],
    );
    let [mean, mean_fixed] = [&run.adaptive, &run.constant].map(|sampled| {
        let early = sampled.samples.iter().take_while(|sample| sample.t < EARLY);
        let sizes = || early.clone().map(|sample| (run.absolute(sample).abs(), 1.0));
        let (sum, count) = sizes().fold((0.0, 0.0), |(sum, count), (size, one)| (sum + size, count + one));
        sum / count
    });
    let [start, start_fixed] =
        [&run.adaptive, &run.constant].map(|sampled| sampled.samples.first().map_or(f64::NAN, |s| run.absolute(s)));
    book.item(
        &format!("ζ = {zeta}: same energy accuracy at the start, the energy-preserving integrator better initially"),
        "—",
        format!(
            "both start at {}; first amplitude {} energy-preserving, {} fixed; mean size up to t = {EARLY} {} and {}",
            scientific(start),
            scientific(early),
            scientific(early_fixed),
            scientific(mean),
            scientific(mean_fixed)
        ),
        Verdict::InPart.when(start.total_cmp(&start_fixed).is_eq() && early < early_fixed),
        run.names[1],
    );
}

/// The amplitudes against time, with the law.
fn figure(book: &mut Book, all: &[Amplitudes]) {
    let mut series = Vec::new();
    let dots = [2.0, 3.0, 4.0];
    for (amplitudes, radius) in all.iter().zip(dots) {
        let zeta = amplitudes.zeta;
        series.push(Series::scatter(
            format!("energy, ζ = {zeta}"),
            Look::ENERGY.dots(radius),
            amplitudes.adaptive.clone(),
        ));
        series.push(Series::scatter(
            format!("fixed, ζ = {zeta}"),
            Look::FIXED.dots(radius),
            amplitudes.constant.clone(),
        ));
    }
    for (index, amplitudes) in all.iter().enumerate() {
        for is_adaptive in [true, false] {
            let points = curve(|t| law(amplitudes.zeta, t, is_adaptive));
            let line = Series::line("2ζEδφ", Look::EXACT, points);
            series.push(if index == 0 && is_adaptive { line } else { line.unlabelled() });
        }
    }
    let chart = Chart::new(
        "damped-energy-amplitudes",
        "Amplitude of the energy error",
        [Axis::linear("t"), Axis::log10("amplitude of Eₖ − E(t)").over(1e-7, 1e-3)],
        series,
    );
    book.page.figure(
        chart.figure(),
        "Half of the range of <i>E<sub>k</sub></i> − <i>E</i>(<i>t<sub>k</sub></i>) in windows of half a period. Small, middle \
         and large points: <i>ζ</i> = 0.001, 0.005, 0.01. Dashed: the law.",
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_phase_error_explains_both_amplitudes() {
        for (zeta, names) in DAMPING.into_iter().zip(NAMES) {
            let adaptive = energy_preserving(zeta, UNTIL, u32::MAX).expect("a run");
            let constant = fixed(zeta, UNTIL).expect("a run");
            let amplitudes = Amplitudes::of(&Damped { zeta, adaptive, constant, names });
            for (is_adaptive, envelope) in [(true, &amplitudes.adaptive), (false, &amplitudes.constant)] {
                let (t, measured) = envelope.last().copied().expect("a window");
                let deviation = (measured / law(zeta, t, is_adaptive) - 1.0).abs();
                // Measured: at most 0.016.
                assert!(deviation < 0.05, "ζ = {zeta}, adaptive {is_adaptive}: {deviation}");
            }
        }
    }
}
