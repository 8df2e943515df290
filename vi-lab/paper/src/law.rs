//! The step law: the spread of `h D^{1/3}` and of `h √D`.

use super::book::{Book, Verdict};
use super::unexpected;
use vi_core::stepping::EnergyStepping;
use vi_core::{EnergyPreserving, SVector, StepError};
use vi_erased::start::second_point;
use vi_report::failure::Failure;
use vi_report::numbers::{extremes, order, scientific};
use vi_report::table::Table;
use vi_systems::{DampedOscillator, DoubleWell};

/// Initial steps at which constancy is measured.
const LADDER: [f64; 3] = [0.01, 0.02, 0.04];
/// Time of each run: some oscillations of either system.
const UNTIL: f64 = 40.0;

/// The section: the law, what follows from it, and its measured constancy.
pub(super) fn section(book: &mut Book) -> Result<(), Failure> {
    book.page.section("The step law");
    book.page.prose(
        "A quantity of second order determines the length of the energy-preserving step: <i>H</i>(<i>t<sub>k</sub></i>, <i>q<sub>k</sub></i>, <i>p<sub>k</sub></i>) − \
         <i>E<sub>k</sub></i> = <i>h</i>²<i>D</i>/8 + <i>O</i>(<i>h</i>³). So, for small \
         <i>h</i><sub>0</sub>, a step exists while <i>D</i> keeps its sign. As <i>D</i> → 0 the length diverges, and beyond that \
         point no solver finds a step. The first law below holds without forces, in any number of degrees of freedom. The second \
         one holds for quadratic Lagrangians, damping included.",
    );
    book.page.formula("h_k D_k^{1/3} = \\const + O(h^2) ~ ~ h_k \\sqrt{D_k} = \\const");
    let well = |q0: f64| LADDER.map(|h0| Ok((h0, spread(DoubleWell::default(), q0, h0, f64::cbrt)?)));
    let oscillator = LADDER
        .map(|h0| Ok((h0, spread(DampedOscillator { c: 0.04, ..DampedOscillator::default() }, 1.0, h0, f64::sqrt)?)));
    let rows = [
        ("double well, q₀ = 0.74", "h D^(1/3)", well(0.74)),
        ("double well, q₀ = 0.995", "h D^(1/3)", well(0.995)),
        ("damped oscillator, ζ = 0.01", "h √D", oscillator),
    ];
    let head = ["system", "quantity", "h₀ = 0.01", "h₀ = 0.02", "h₀ = 0.04", "order in h₀"];
    let mut table = Table::new("step-law", head);
    let mut orders = Vec::new();
    let mut exact = f64::NAN;
    for (system, quantity, spreads) in rows {
        let spreads: Vec<(f64, f64)> =
            spreads.into_iter().collect::<Result<_, StepError>>().map_err(unexpected("step law"))?;
        let largest = extremes(spreads.iter().map(|(_, spread)| *spread)).1;
        let power = if quantity == "h √D" {
            exact = largest;
            "exact".to_owned()
        } else {
            orders.push(order(&spreads));
            format!("{:.2}", order(&spreads))
        };
        let cells: Vec<String> = spreads.iter().map(|(_, spread)| scientific(*spread)).collect();
        let [a, b, c] = <[String; 3]>::try_from(cells).unwrap_or_default();
        table.row([system.to_owned(), quantity.to_owned(), a, b, c, power]);
    }
    book.page.table(
        &table,
        "Relative spread, largest over smallest minus one, along the motion up to <i>t</i> = 40; <i>D</i> at the midpoints.",
    );
    book.item(
        "the adaptive step is coupled with the dynamics: by which law (open in the paper)",
        "—",
        format!(
            "h D^(1/3) constant up to order {} in h; with linear damping h √D constant to {}",
            orders.iter().map(|order| format!("{order:.2}")).collect::<Vec<_>>().join(" and "),
            scientific(exact)
        ),
        Verdict::Answered.when(orders.iter().all(|order| (order - 2.0).abs() < 0.1)),
        "step-law",
    );
    Ok(())
}

/// Relative spread of `h root(D)` along a run.
fn spread<S>(system: S, q0: f64, h0: f64, root: fn(f64) -> f64) -> Result<f64, StepError>
where
    S: EnergyStepping<1> + Clone,
{
    let q0 = SVector::from([q0]);
    let second = second_point(&system, 0.0, q0, SVector::zeros(), h0)?;
    let mut integrator = EnergyPreserving::from_points(system, (0.0, q0), second)?;
    let mut values = Vec::new();
    while integrator.state().t < UNTIL {
        let step = integrator.detailed_step()?;
        let (t, q, v) = step.midpoint;
        values.push(step.h * root(system.step_density(t, &q, &v)?));
    }
    let (low, high) = extremes(values);
    Ok(high / low - 1.0)
}
