//! Compositions and damping: negative substeps amplify damped modes.
//!
//! With the midpoint rule a substep multiplies the mode `e^{λt}` of a linear system by `(1 + γhλ/2)/(1 − γhλ/2)`, so a
//! whole step of a composition multiplies it by
//!
//! ```text
//! R(z) = Π_i (1 + γ_i z/2)/(1 − γ_i z/2)        z = hλ;   for a = −c v: z = −c h;   stable if |R| ≤ 1
//! ```
//!
//! A damped mode has `Re z < 0`; a negative weight then has its pole at `z = 2/γ`, on the side of damping.

use super::atlas::{Part, Section};
use vi_core::{Composition, Starts, State};
use vi_report::chart::{Axis, Chart, Look, Series};
use vi_report::table::Table;
use vi_systems::DampedOscillator;

/// Largest `c h` of the chart.
const WIDEST: f64 = 6.0;

/// The section: the factor of a whole step, and the largest stable steps.
pub(super) fn section() -> Section<'static> {
    let mut table = Table::new("composed-limits", ["scheme", "order", "c h from the product", "c h of runs"]);
    for scheme in Composition::ALL {
        let theory = limit(|ch| factor(scheme, -ch) <= 1.0);
        let runs = limit(|ch| slows_down(scheme, ch));
        table.row([scheme.name.to_owned(), scheme.order.to_string(), format!("{theory:.4}"), format!("{runs:.4}")]);
    }
    let table = Part::Table(
        table,
        "The <i>ch</i> up to which each composition is stable, from the product and from runs of its steps.",
    );
    Section {
        heading: "Compositions and damping",
        prose: "Steps of order 4 and more are composed of fixed steps, some of which go backwards in time and amplify \
                damped modes: for the force −<i>cv</i> a substep <i>γh</i> multiplies the speed by \
                (1 − <i>z</i>/2)/(1 + <i>z</i>/2), <i>z</i> = <i>cγh</i>, which has a pole if <i>γ</i> is negative."
            .to_owned(),
        parts: vec![factors(), table],
        advice: "Keep <i>ch</i>, the damping rate of the fastest decay times the whole step, below the limit of the scheme, and \
                 for accuracy far below. If damping is stronger, take fixed steps of order 2, which damp every damped mode.",
    }
}

/// The factor of a whole step for `a = −c v`, by the product, and by one step of each composition as dots.
fn factors() -> Part<'static> {
    // Each scheme looks as in work-precision charts, which have no triple jump.
    let [suzuki, six, eight, jump] = Look::OTHERS;
    let looks = Composition::ALL.into_iter().zip([jump, suzuki, six, eight]);
    let places = |count: u32| (1..=count).map(move |i| WIDEST * f64::from(i) / f64::from(count));
    let mut series = vec![Series::line("limit: 1", Look::EXACT, vec![(0.0, 1.0), (WIDEST, 1.0)])];
    for (scheme, look) in looks {
        let line = places(800).map(|ch| (ch, factor(scheme, -ch))).collect();
        series.push(Series::line(scheme.name, look.line(), line));
        let dots = places(40).filter_map(|ch| Some((ch, after_one_step(scheme, ch)?))).collect();
        series.push(Series::scatter("", look.dots(3.0), dots).unlabelled());
    }
    let chart = Chart::new(
        "composed-factor",
        "Compositions on damping: factor of the speed over a step",
        [Axis::linear("c h").over(0.0, WIDEST), Axis::log10("|v after a step / v before|").over(1e-3, 1e2)],
        series,
    );
    Part::Chart(
        chart,
        "Lines: the product of the substeps’ factors. Dots: one step of each composition. Above the dashed line the speed \
         grows although the force only brakes: in a band beside each pole. Past this band the step is stable again, but does \
         not approximate e<sup>−<i>ch</i></sup>.",
    )
}

/// `|R(z)|` for a real `z`.
fn factor(scheme: Composition, z: f64) -> f64 {
    let of = |weight: &f64| ((1.0 + weight * z / 2.0) / (1.0 - weight * z / 2.0)).abs();
    scheme.weights.iter().map(of).product()
}

/// The first `c h` at which `stable` is false, to 1e-6; zero if it is true up to 10.
fn limit(stable: impl Fn(f64) -> bool) -> f64 {
    let part = 1e-3;
    let first = (1..10_000).map(|index| part * f64::from(index)).find(|ch| !stable(*ch));
    let (mut low, mut high) = first.map_or((0.0, 0.0), |ch| (ch - part, ch));
    while high - low > 1e-6 {
        let middle = f64::midpoint(low, high);
        *(if stable(middle) { &mut low } else { &mut high }) = middle;
    }
    low
}

/// The factor of the speed over one step of `a = −c v`; `None` if the step fails.
fn after_one_step(scheme: Composition, ch: f64) -> Option<f64> {
    let system = DampedOscillator { m: 1.0, k: 0.0, c: ch };
    let start = State::at(&system, 0.0, [0.0], [1.0]);
    Some(system.at_state(start).integrate(scheme, 1.0).ok()?.step().ok()?.p.x.abs())
}

/// Whether one step of `a = −c v` does not make the speed larger.
fn slows_down(scheme: Composition, ch: f64) -> bool {
    after_one_step(scheme, ch).is_some_and(|factor| factor <= 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_product_and_the_runs_have_the_documented_limits() {
        for (scheme, documented) in Composition::ALL.into_iter().zip([1.13, 3.02, 2.73, 3.30]) {
            let theory = limit(|ch| factor(scheme, -ch) <= 1.0);
            let runs = limit(|ch| slows_down(scheme, ch));
            // The documentation of the compositions has two decimals.
            assert!((theory - documented).abs() <= 0.005, "{}: {theory}", scheme.name);
            // Measured: both within the 1e-6 of the bisection.
            assert!((theory - runs).abs() <= 2e-6, "{}: {theory}, {runs}", scheme.name);
        }
    }

    #[test]
    fn a_whole_step_is_the_product() {
        for scheme in Composition::ALL {
            for ch in [0.1, 0.5, 1.0, 2.0, 3.5] {
                let run = after_one_step(scheme, ch).expect("a step");
                let product = factor(scheme, -ch);
                assert!((run / product - 1.0).abs() < 1e-13, "{} at {ch}: {run}, {product}", scheme.name);
            }
        }
    }
}
