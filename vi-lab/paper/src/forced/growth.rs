//! Growth of the step with damping up to its end, and its decrease with negative damping.

use super::super::book::{Book, Verdict};
use super::super::unexpected;
use super::oscillator::{OMEGA, Sampled, energy_preserving, start, system};
use super::{DAMPING, H0};
use vi_core::{Called, EnergyPreservingGauss, Starts as _, StepError};
use vi_report::chart::{Axis, Chart, Look, Series};
use vi_report::failure::Failure;
use vi_report::numbers::{extremes, scientific};
use vi_report::table::Table;

/// Time up to which growth is shown.
const SHOWN: f64 = 100.0;
/// Time up to which negative damping is run.
const NEGATIVE: f64 = 50.0;
/// More steps than any run has.
const MOST: u32 = 200_000;

/// Orders 4 and 6: stages, and the first step, long enough that the energy determines it.
const STAGES: [(usize, f64); 3] = [(1, 0.01), (2, 0.05), (3, 0.2)];
/// Time over which their growth is measured.
const MEASURED: f64 = 50.0;

/// The section: growth in time, and the last step of each run.
pub(super) fn section(book: &mut Book) -> Result<(), Failure> {
    book.page.section("Step growth");
    book.page.prose("The paper observes that the step of the damped oscillator grows monotonically, and leaves open why. The \
                energy of the motion decays as e<sup>−2<i>ζωt</i></sup>, and so does the step density <i>D</i>. For a \
                quadratic Lagrangian <i>h</i><sub><i>k</i></sub>√<i>D</i><sub><i>k</i></sub> is constant exactly. Hence");
    book.page.formula("h_k ≈ h_0 e^{ζωt}");
    book.page.prose(
        "Since <i>t</i> advances by <i>h</i>, the step would be infinite after about 1/(<i>ζωh</i><sub>0</sub>) steps. Near that \
         step no further step exists, or only one many times as long. This is a property of the method. The integrator reports \
         it as an error with its numbers.",
    );
    let mut runs = Vec::new();
    for zeta in DAMPING {
        runs.push((zeta, energy_preserving(zeta, f64::INFINITY, MOST).map_err(unexpected("step growth"))?));
    }
    in_time(book, &runs, SHOWN, "step-growth", "Step growth with damping");
    table(book, &runs);
    proof(book)?;
    orders(book)
}

/// The proof that the step grows monotonically.
fn proof(book: &mut Book) -> Result<(), Failure> {
    book.page.prose(
        "<b>Why the growth is monotonic.</b> The step density of the oscillator is <i>D</i> = <i>ma</i>² + <i>kv</i>². The \
         derivative of the equation of motion is <i>m</i><i>a</i>′ = −<i>kv</i> − <i>ca</i>. So, exactly and at every state,",
    );
    book.page.formula("D^′ = 2 m a a^′ + 2 k v a = −2 c a^2 ≤ 0");
    book.page.prose(
        "In words: the velocity of a motion is itself a motion of the same linear system, and <i>D</i> is twice its energy. Damping \
         dissipates that energy too. The same proof holds for every linear system <i>Ma</i> + (<i>C</i> + <i>G</i>)<i>v</i> + \
         <i>Kq</i> = 0 with symmetric <i>M</i>, <i>C</i>, <i>K</i> and a gyroscopic <i>G</i>: \
         <i>D</i> = <i>a·Ma</i> + <i>v·Kv</i> and <i>D</i>′ = −2 <i>a·Ca</i>. So <i>D</i> does not increase if <i>C</i> is positive \
         semidefinite, and with negative damping it does not decrease.",
    );
    book.page.prose(
        "The steps inherit this. For the midpoints of two consecutive steps the equations of the method give \
         <i>h</i><sub><i>k</i></sub>²<i>D<sub>k</sub></i> = <i>h</i><sub><i>k</i>+1</sub>²<i>D</i><sub><i>k</i>+1</sub>, with \
         symmetric <i>M</i>, <i>C</i>, <i>K</i>, and from it",
    );
    book.page.formula(
        "h_{k+1} − h_k = \\frac{h_k s·C s}{2B}, ~ s = a_k + a_{k+1}, ~ B = \\frac{D_k (h_k + h_{k+1})}{h_{k+1}^2} \
         − \\frac{1}{2} a_{k+1}·C s − \\frac{1}{2} (a_k·K v_{k+1} − v_k·K a_{k+1})",
    );
    let mut worst = 0.0_f64;
    let mut least = f64::INFINITY;
    let mut drop = 0.0_f64;
    for zeta in DAMPING {
        let measured = increments(zeta).map_err(unexpected("step growth"))?;
        worst = worst.max(measured.identity);
        least = least.min(measured.bracket);
        drop = drop.max(measured.drop);
    }
    book.page.prose(&format!(
        "<i>B</i> ≈ 2<i>D</i>/<i>h</i> is large and positive for small <i>h</i>. So with a positive semidefinite <i>C</i> no step is \
         shorter than the one before: the growth of <i>h</i> is monotonic in the discrete motion, not only on average. Along the three runs up to <i>t</i> = {SHOWN}, \
         <i>B</i> is at least {}, the identity holds to {} of <i>h</i>, and {}.",
        scientific(least),
        scientific(worst),
        if drop > 0.0 {
            format!("no step is shorter than the one before by more than {} of itself, a rounding error", scientific(drop))
        } else {
            "no step is shorter than the one before".to_owned()
        }
    ));
    book.page.prose(
        "<b>What it needs elsewhere.</b> For <i>L</i> = <i>v·Mv</i>/2 − <i>V</i>(<i>q</i>) and the forces −<i>Cv</i> + \
         <i>F</i>(<i>t</i>), <i>D</i>′ = −2 <i>a·Ca</i> + ∇³<i>V</i>[<i>v</i>, <i>v</i>, <i>v</i>] + 2 <i>a·F</i>′. Growth is \
         monotonic only if the damping outweighs both other terms at every state. ∇³<i>V</i>[<i>v</i>, <i>v</i>, <i>v</i>] changes its \
         sign with the velocity, so in a nonlinear potential <i>h</i> oscillates with the motion. The law <i>h</i>√<i>D</i> then no longer holds \
         exactly.",
    );
    book.item(
        "why the adaptive step grows monotonically (open in the paper)",
        "—",
        format!(
            "D′ = −2ca² ≤ 0 exactly; the increment of h is a multiple of c(aₖ + aₖ₊₁)², to {} of h",
            scientific(worst)
        ),
        // Measured: the identity to 1.5e-12, B at least 8.
        Verdict::Answered.when(worst < 1e-10 && least > 0.0 && drop < 1e-10),
        "step-growth",
    );
    Ok(())
}

/// Statistics of the increments of h of a run.
struct Increments {
    /// Largest deviation of the increment from its formula, relative to h.
    identity: f64,
    /// Smallest B.
    bracket: f64,
    /// Largest relative decrease of h.
    drop: f64,
}

/// Follows a run and compares each increment of h with its formula.
fn increments(zeta: f64) -> Result<Increments, StepError> {
    let system = system(zeta);
    let mut integrator = start(zeta)?;
    let mut found = Increments { identity: 0.0, bracket: f64::INFINITY, drop: 0.0 };
    let mut before: Option<(f64, f64, f64)> = None;
    while integrator.state().t < SHOWN {
        let step = integrator.detailed_step()?;
        let (t, q, v) = step.midpoint;
        let now = (step.h, v.x, vi_core::Lagrangian::acceleration(&system, t, &q, &v)?.x);
        if let Some((h, v, a)) = before {
            let (h1, v1, a1) = now;
            let density = system.m * a * a + system.k * v * v;
            let sum = a + a1;
            let bracket =
                density * (h + h1) / (h1 * h1) - system.c * a1 * sum / 2.0 - system.k * (a * v1 - v * a1) / 2.0;
            let increment = h * system.c * sum * sum / (2.0 * bracket);
            found.identity = found.identity.max(((h1 - h - increment) / h).abs());
            found.bracket = found.bracket.min(bracket);
            found.drop = found.drop.max((h - h1) / h);
        }
        before = Some(now);
    }
    Ok(found)
}

/// Growth of steps of order 2, 4 and 6: the paper expects that a better approximation of the discrete power stops it.
fn orders(book: &mut Book) -> Result<(), Failure> {
    book.page.prose(
        "<b>A better approximation of the power does not stop the growth.</b> The paper supposes that the low order of the midpoint          rule for the discrete power causes it. With <i>s</i> stages the power is integrated with order 2<i>s</i>. The step still grows,          as e<sup><i>ζωt</i>/<i>s</i></sup>, because <i>H</i> − <i>E</i> ∝ <i>h</i><sup>2<i>s</i></sup><i>D<sub>s</sub></i> is          constant and <i>D<sub>s</sub></i> decays.",
    );
    let mut table = Table::new("step-growth-orders", ["stages", "order", "first step", "h(50)/h(0)", "exp(ζωt/s)"]);
    let zeta = DAMPING[2];
    let mut deviations = Vec::new();
    for (stages, h) in STAGES {
        let (measured, predicted) = grown(stages, zeta, h).map_err(unexpected("step growth"))?;
        deviations.push((measured / predicted - 1.0).abs());
        table.row([
            stages.to_string(),
            (2 * stages).to_string(),
            h.to_string(),
            format!("{measured:.4}"),
            format!("{predicted:.4}"),
        ]);
    }
    book.page.table(&table, &format!("Growth of the step over {MEASURED} units of time, ζ = {zeta}."));
    let (_, worst) = extremes(deviations);
    book.item(
        "supposed cause of the growth: the midpoint approximation of the discrete power",
        "—",
        format!("not the cause: with order 4 and 6 the step grows too, as exp(ζωt/s) to {}", scientific(worst)),
        // Measured 5e-3.
        Verdict::Answered.when(worst < 0.02),
        "step-growth-orders",
    );
    Ok(())
}

/// The growth of the step of a run with this many stages, and the law.
fn grown(stages: usize, zeta: f64, h: f64) -> Result<(f64, f64), StepError> {
    fn of<const STAGES: usize>(zeta: f64, h: f64) -> Result<(f64, f64), StepError> {
        let mut run = Called(system(zeta)).at(0.0, [1.0], [0.0]).integrate(EnergyPreservingGauss::<STAGES>, h)?;
        run.step()?;
        let (first, started) = (run.h(), run.t());
        while run.t() < MEASURED {
            run.step()?;
        }
        #[allow(clippy::cast_precision_loss)] // at most 3
        let exponent = zeta * OMEGA * (run.t() - started) / STAGES as f64;
        Ok((run.h() / first, exponent.exp()))
    }
    [of::<1>, of::<2>, of::<3>][stages - 1](zeta, h)
}

/// The section on negative damping.
pub(super) fn negative(book: &mut Book) -> Result<(), Failure> {
    book.page.section("Negative damping");
    book.page.prose(
        "With <i>ζ</i> &lt; 0 the motion grows, <i>D</i>′ = −2<i>ca</i>² is positive, and the same law makes the step shrink. The          integrator takes more and more steps for the same time.",
    );
    let mut runs = Vec::new();
    for zeta in DAMPING.map(|zeta| -zeta) {
        runs.push((zeta, energy_preserving(zeta, NEGATIVE, MOST).map_err(unexpected("negative damping"))?));
    }
    in_time(book, &runs, NEGATIVE, "negative-damping", "Step length with negative damping");
    let shrinks = runs.iter().all(|(_, run)| run.end.is_none() && is_monotonic(run, -1.0));
    let deviations = runs.iter().map(|(zeta, run)| scientific(deviation(*zeta, run, NEGATIVE)));
    book.item(
        "negative damping: a uniformly decreasing step",
        "—",
        format!("decreases by the same law, to {} for ζ = −0.001, −0.005, −0.01", join(deviations)),
        Verdict::Agrees.when(shrinks),
        "negative-damping",
    );
    Ok(())
}

/// Whether h grows in every step (sign 1) or shrinks in every step (sign −1), up to the rounding error of h, 1e-12.
fn is_monotonic(run: &Sampled, sign: f64) -> bool {
    let pairs = run.samples.iter().zip(run.samples.iter().skip(1));
    pairs.take(4000).all(|(one, next)| sign * (next.h - one.h) > -1e-12 * one.h)
}

/// h/h0 of the step that passes a time.
fn ratio_at(run: &Sampled, t: f64) -> f64 {
    run.samples.iter().find(|sample| sample.t >= t).map_or(f64::NAN, |sample| sample.h / H0)
}

/// Largest relative deviation from the law up to a time.
fn deviation(zeta: f64, run: &Sampled, until: f64) -> f64 {
    let relative = |t: f64, h: f64| (h / (H0 * (zeta * OMEGA * t).exp()) - 1.0).abs();
    run.samples
        .iter()
        .take_while(|sample| sample.t <= until)
        .map(|sample| relative(sample.t, sample.h))
        .fold(0.0, f64::max)
}

/// h/h0 against t, with the law over it.
fn in_time(book: &mut Book, runs: &[(f64, Sampled)], until: f64, name: &'static str, title: &str) {
    let mut series = Vec::new();
    for ((zeta, run), look) in runs.iter().zip(Look::OTHERS) {
        let points = run.samples.iter().take_while(|sample| sample.t <= until).map(|sample| (sample.t, sample.h / H0));
        series.push(Series::line(format!("ζ = {zeta}"), Look { width: 3.0, ..look.line() }, points.collect()));
    }
    for (index, (zeta, _)) in runs.iter().enumerate() {
        let law = (0..=200).map(|i| until * f64::from(i) / 200.0).map(|t| (t, (zeta * OMEGA * t).exp())).collect();
        let law = Series::line("exp(ζωt)", Look::EXACT, law);
        series.push(if index == 0 { law } else { law.unlabelled() });
    }
    let chart = Chart::new(name, title, [Axis::linear("t"), Axis::linear("h / h₀")], series);
    let worst: Vec<String> = runs.iter().map(|(zeta, run)| scientific(deviation(*zeta, run, until))).collect();
    let caption = format!(
        "Computed, and dashed the law. They differ by at most {} of <i>h</i> for the three damping ratios.",
        worst.join(", ")
    );
    book.page.figure(chart.figure(), &caption);
}

fn table(book: &mut Book, runs: &[(f64, Sampled)]) {
    let head = ["ζ", "h/h₀ at t = 100", "exp(ζωt)", "last step", "1/(ζωh₀)", "last h", "how it ends"];
    let mut table = Table::new("step-growth-table", head);
    let mut ends = Vec::new();
    let mut as_predicted = true;
    for (zeta, run) in runs {
        let last = run.samples.len();
        let predicted = 1.0 / (zeta * OMEGA * H0);
        #[allow(clippy::cast_precision_loss)] // at most 200 000
        let near = (last as f64 / predicted - 1.0).abs() < 0.01;
        as_predicted &= near && run.end.is_some();
        ends.push(last.to_string());
        table.row([
            zeta.to_string(),
            format!("{:.3}", ratio_at(run, SHOWN)),
            format!("{:.3}", (zeta * OMEGA * SHOWN).exp()),
            last.to_string(),
            format!("{predicted:.0}"),
            run.samples.last().map_or_else(String::new, |sample| scientific(sample.h)),
            run.end.map_or_else(|| "it does not".to_owned(), |error| error.reason().to_string()),
        ]);
    }
    book.page.table(
        &table,
        "Step growth, the law, and the end of each run. Against the iteration <i>k</i> the step is \
         <i>h</i><sub>0</sub>/(1 − <i>ζωh</i><sub>0</sub><i>k</i>).",
    );
    for (zeta, run) in runs {
        book.item(
            &format!("figure: adaptive step against time, ζ = {zeta}: monotonically increasing"),
            "—",
            format!("increases in every step; h/h₀ = {:.3} at t = {SHOWN}", ratio_at(run, SHOWN)),
            Verdict::Agrees.when(is_monotonic(run, 1.0)),
            "step-growth",
        );
    }
    book.item(
        "the growing step eventually leads to numerical instability",
        "—",
        format!(
            "the last step with a solution is number {}; theory 1/(ζωh₀) = {}",
            ends.join(", "),
            join(runs.iter().map(|(zeta, _)| format!("{:.0}", 1.0 / (zeta * OMEGA * H0))))
        ),
        Verdict::Answered.when(as_predicted),
        "step-growth-table",
    );
}

fn join(items: impl Iterator<Item = String>) -> String {
    items.collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn increments_follow_their_formula_and_their_sign_follows_the_damping() {
        for zeta in DAMPING {
            let found = increments(zeta).expect("a run");
            // Measured: 1.5e-12, the rounding error of h; B between 8 and 3e3; no decrease.
            assert!(found.identity < 5e-12 && found.bracket > 5.0 && found.drop < 1e-12, "{}", found.identity);
            let growing = energy_preserving(zeta, 20.0, MOST).expect("a run");
            let shrinking = energy_preserving(-zeta, 20.0, MOST).expect("a run");
            assert!(is_monotonic(&growing, 1.0) && !is_monotonic(&growing, -1.0));
            assert!(is_monotonic(&shrinking, -1.0) && !is_monotonic(&shrinking, 1.0));
        }
    }

    #[test]
    fn steps_of_higher_order_grow_too() {
        for (stages, h) in STAGES {
            let (measured, law) = grown(stages, 0.01, h).expect("a run");
            // Measured: at most 4.7e-3.
            assert!((measured / law - 1.0).abs() < 0.01 && measured > 1.3, "{stages}: {measured} {law}");
        }
    }
}
