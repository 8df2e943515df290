//! The step length along the orbit, and the law that it follows.

use super::super::book::{Book, Verdict};
use super::super::unexpected;
use super::runs::Pair;
use vi_core::SVector;
use vi_core::stepping::EnergyStepping;
use vi_report::chart::{Axis, Chart, Look, Series};
use vi_report::failure::Failure;
use vi_systems::DoubleWell;

/// The section: h/h0 against the iteration, with the step law over it.
pub(super) fn section(book: &mut Book, runs: &[Pair]) -> Result<(), Failure> {
    book.page.section("Step length");
    book.page.prose(
        "The step length is a function of the place on the orbit. The paper observes that it oscillates with the motion. It \
         follows a law. With the acceleration <i>a</i> and derivatives along the motion, the step density is",
    );
    book.page.formula("D = a·(L_q + f) − v·\\frac{d}{dt} L_q − \\frac{d}{dt} L_t");
    book.page.prose("Here the force <i>f</i> is zero, and without forces");
    book.page.formula("h_k = h_0 {(\\frac{D_0}{D_k})}^{1/3} (1 + O(h^2))");
    for run in runs.iter().filter(|run| run.case.h0 < 0.05) {
        let name = if run.case.q0 < 0.9 { "step-length-0.74" } else { "step-length-0.995" };
        let mut series = vec![Series::line("computed", Look::ENERGY.line(), computed(run))];
        series.push(Series::line("step law", Look::EXACT, predicted(run)?));
        let chart = Chart::new(
            name,
            format!("Step length, {}", run.case.label()),
            [Axis::linear("iteration k"), Axis::linear("h / h₀")],
            series,
        );
        let caption = format!(
            "The step varies between {:.4} and {:.4} times <i>h</i><sub>0</sub> over the whole run. Dashed: the law, from \
             <i>D</i> at the midpoints.",
            run.energy.steps.0 / run.case.h0,
            run.energy.steps.1 / run.case.h0
        );
        book.page.figure(chart.figure(), &caption);
        let longest = run.energy.steps.1 / run.case.h0;
        let is_near = run.case.q0 > 0.9;
        book.item(
            &format!("figure: adaptive step against the iteration, {}", run.case.label()),
            if is_near { "increases by 4 times" } else { "does not increase substantially" },
            format!("largest h/h₀ = {longest:.4}"),
            Verdict::Agrees.when(if is_near { (3.5..5.0).contains(&longest) } else { longest < 1.1 }),
            name,
        );
    }
    Ok(())
}

fn computed(run: &Pair) -> Vec<(f64, f64)> {
    run.energy.samples.iter().zip(1_u32..).map(|(sample, k)| (f64::from(k), sample.h / run.case.h0)).collect()
}

/// `(D_1/D_k)^{1/3}`, scaled to the first step.
fn predicted(run: &Pair) -> Result<Vec<(f64, f64)>, Failure> {
    let system = DoubleWell::default();
    let mut first = None;
    let mut points = Vec::new();
    for (sample, k) in run.energy.samples.iter().zip(1_u32..) {
        let q = SVector::from([sample.q]);
        let v = SVector::from([sample.v]);
        let density = system.step_density(sample.t, &q, &v).map_err(unexpected("step law"))?;
        let (d0, h0) = *first.get_or_insert((density, sample.h));
        points.push((f64::from(k), h0 / run.case.h0 * (d0 / density).cbrt()));
    }
    Ok(points)
}
