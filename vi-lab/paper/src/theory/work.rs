//! The error of the trajectory at equal work: energy-preserving steps of order 2, 4 and 6 beside fixed steps of the same order.
//!
//! Kepler's problem from the pericentre, against Kepler's equation: the largest error of a node's position in the tenth period, its time
//! the node's own. Work: evaluations of the equations of motion, with their derivatives where Newton's iteration asks for them.

use super::super::book::Book;
use super::super::unexpected;
use core::f64::consts::TAU;
use vi_core::{
    Called, EnergyPreserving, EnergyPreservingGauss, FixedStep, Gauss, Lagrangian, Method, Run, Starts as _, StepError,
};
use vi_erased::integrator::OF_A_CORRECTION;
use vi_report::chart::{Axis, Chart, Look, Series};
use vi_report::failure::Failure;
use vi_report::table::Table;
use vi_systems::Kepler;

/// Periods of a run; the error is that of the last.
const PERIODS: f64 = 10.0;
/// The longest step of a ladder, for orders 2, 4 and 6, and the rungs, each half of the one above: for shorter steps of
/// order 6 rounding would dominate the computed length.
const LONGEST: [f64; 3] = [0.02, 0.16, 0.48];
const RUNGS: [i32; 3] = [5, 5, 4];
/// The error at which work is compared.
const COMPARED: f64 = 1e-3;
/// How fixed steps of these orders are drawn.
const FIXED: [Look; 3] = [Look::FIXED.dotted(), Look::FIXED.dashed(), Look::FIXED.line()];

/// Evaluations and error of the runs of a ladder.
type Ladder = Vec<(f64, f64)>;

/// The section: a figure for each orbit, and a table.
pub(super) fn section(book: &mut Book) -> Result<(), Failure> {
    book.section("What it costs: the error at equal work");
    book.prose(
        "A step that finds its own length tries two or three. The figures show Kepler’s problem: the largest error of the position in \
         the tenth period over the evaluations of the whole run, for energy-preserving and fixed steps of the same order.",
    );
    let mut table = Table::new("theory-work", ["eccentricity", "order", "fixed steps", "energy-preserving", "ratio"]);
    let orbits = [(0.3, "theory-work-0.3", [false; 3]), (0.6, "theory-work-0.6", [false, false, true])];
    for (eccentricity, name, shifted) in orbits {
        let orbit = Orbit { eccentricity };
        let fixed = [
            orbit.ladder(0, |h| orbit.fixed(h)),
            orbit.ladder(1, |h| orbit.gauss::<2>(h)),
            orbit.ladder(2, |h| orbit.gauss::<3>(h)),
        ];
        let energy = [
            orbit.ladder(0, |h| orbit.energy(h)),
            orbit.ladder(1, |h| orbit.energy_gauss::<2>(h, shifted[1])),
            orbit.ladder(2, |h| orbit.energy_gauss::<3>(h, shifted[2])),
        ];
        let mut series = Vec::new();
        let mut worse = Ladder::new();
        for (index, (fixed, energy)) in fixed.into_iter().zip(energy).enumerate() {
            let order = 2 * (index + 1);
            let fixed = fixed.map_err(unexpected("Kepler"))?;
            let energy = energy.map_err(unexpected("Kepler"))?;
            let note = if shifted[index] { ", with a shift" } else { "" };
            let [(fixed, worse_fixed), (energy, worse_energy)] = [&fixed, &energy].map(efficient);
            worse.extend(worse_fixed.into_iter().chain(worse_energy));
            let [by_fixed, by_energy] = [&fixed, &energy].map(price);
            let ratio = match (by_fixed, by_energy) {
                (Some(Price::Exact(fixed)), Some(Price::Exact(energy))) => format!("{:.3}", energy / fixed),
                _ => "–".to_owned(),
            };
            let text = |price: Option<Price>| price.map_or_else(|| "–".to_owned(), Price::text);
            let cells = [eccentricity.to_string(), format!("{order}{note}"), text(by_fixed), text(by_energy), ratio];
            table.row(cells);
            series.push(Series::line(format!("fixed, order {order}"), FIXED[index], fixed));
            series.push(Series::line(format!("energy, order {order}{note}"), super::LOOKS[index], energy));
        }
        if !worse.is_empty() {
            series.push(Series::scatter("inefficient", Look::RIVAL.dots(5.0), worse));
        }
        let chart = Chart {
            name,
            title: format!("Kepler, e = {eccentricity}: error at equal work"),
            x: Axis::log10("evaluations in ten periods"),
            y: Axis::log10("largest error of the position in the tenth"),
            equal_aspect: false,
            series,
        };
        book.figure(&chart, caption(eccentricity));
    }
    let head = format!(
        "Evaluations for an error of {COMPARED}, interpolated between two runs of a ladder, and the ratio of both. “≤”: the longest \
         efficient step already has a smaller error."
    );
    book.table(table, &head);
    Ok(())
}

fn caption(eccentricity: f64) -> &'static str {
    if eccentricity < 0.5 {
        "A nearly round orbit. Steps that follow the motion pay at order 2. At order 4 and 6 finding their length costs more than it \
         saves. Crosses mark inefficient runs: a shorter step has a smaller error and costs less. The curves and the table omit them."
    } else {
        "An eccentric orbit. At order 6 no step exists beyond <i>e</i> = 0.587 but with a shift, whose steps vary less."
    }
}

/// An orbit about the unit mass, with the unit as its half axis, from the pericentre.
struct Orbit {
    eccentricity: f64,
}

impl Orbit {
    /// Where it starts, and how fast.
    fn start(&self) -> ([f64; 2], [f64; 2]) {
        let e = self.eccentricity;
        ([1.0 - e, 0.0], [0.0, ((1.0 + e) / (1.0 - e)).sqrt()])
    }

    /// The distance of a position from the one at that time, by Kepler's equation.
    fn error(&self, t: f64, q: &[f64]) -> f64 {
        let e = self.eccentricity;
        let mean = t.rem_euclid(TAU);
        let mut anomaly = mean;
        for _ in 0..50 {
            anomaly -= (anomaly - e * anomaly.sin() - mean) / (1.0 - e * anomaly.cos());
        }
        let exact = [anomaly.cos() - e, (1.0 - e * e).sqrt() * anomaly.sin()];
        q.iter().zip(exact).map(|(q, exact)| (q - exact).powi(2)).sum::<f64>().sqrt()
    }

    /// The runs of the steps of an order.
    fn ladder(&self, index: usize, run: impl Fn(f64) -> Result<(f64, f64), StepError>) -> Result<Ladder, StepError> {
        let steps = (0..RUNGS[index]).map(|rung| LONGEST[index] * (1.0 - self.eccentricity) * 0.5_f64.powi(rung));
        steps.map(run).collect()
    }

    /// A run of energy-preserving steps of order 2.
    fn energy(&self, h: f64) -> Result<(f64, f64), StepError> {
        let (q, v) = self.start();
        self.counted(EnergyPreserving::from_midpoint(Kepler::default(), 0.0, q, v, h)?, OF_A_CORRECTION)
    }

    /// A run of energy-preserving steps of more stages.
    fn energy_gauss<const STAGES: usize>(&self, h: f64, is_shifted: bool) -> Result<(f64, f64), StepError> {
        let (q, v) = self.start();
        let run = Called(Kepler::default()).at(0.0, q, v).integrate(EnergyPreservingGauss::<STAGES>, h)?;
        self.counted(if is_shifted { run.with_shift_from(TAU)? } else { run }, STAGES as u64)
    }

    /// A run of fixed steps of order 2.
    fn fixed(&self, h: f64) -> Result<(f64, f64), StepError> {
        let (q, v) = self.start();
        self.counted(Kepler::default().at(0.0, q, v).integrate(FixedStep, h)?, OF_A_CORRECTION)
    }

    /// A run of fixed Gauss steps.
    fn gauss<const STAGES: usize>(&self, h: f64) -> Result<(f64, f64), StepError> {
        let (q, v) = self.start();
        self.counted(Called(Kepler::default()).at(0.0, q, v).integrate(Gauss::<STAGES>, h)?, STAGES as u64)
    }

    /// Evaluations and error of a run; an iteration takes the given number of evaluations.
    fn counted<S: Lagrangian<2> + Copy, M: Method<S, 2>>(
        &self,
        run: Run<M, S, 2>,
        evaluations: u64,
    ) -> Result<(f64, f64), StepError> {
        let mut iterations = 0;
        let error = self.follow(run, |run| iterations += u64::from(run.iterations()))?;
        Ok((count(iterations * evaluations), error))
    }

    /// The error of a run over its last period; `see` gets the run after each step.
    fn follow<S: Lagrangian<2> + Copy, M: Method<S, 2>>(
        &self,
        mut run: Run<M, S, 2>,
        mut see: impl FnMut(&Run<M, S, 2>),
    ) -> Result<f64, StepError> {
        let mut error = 0.0_f64;
        while run.t() < PERIODS * TAU {
            let is_last = run.t() >= (PERIODS - 1.0) * TAU;
            let state = run.step()?;
            see(&run);
            if is_last {
                error = error.max(self.error(state.t, state.q.as_slice()));
            }
        }
        Ok(error)
    }
}

#[allow(clippy::cast_precision_loss)] // a count far below 2⁵³
fn count(evaluations: u64) -> f64 {
    evaluations as f64
}

/// Splits the runs of a ladder, longest step first, into the efficient ones and the rest: a run is inefficient if a run with a shorter
/// step needs no more evaluations.
fn efficient(ladder: &Ladder) -> (Ladder, Ladder) {
    let least = |from: usize| ladder.iter().skip(from).map(|(work, _)| *work).fold(f64::INFINITY, f64::min);
    let is_efficient: Vec<bool> =
        ladder.iter().enumerate().map(|(index, (work, _))| *work < least(index + 1)).collect();
    let part = |wanted: bool| {
        let runs = ladder.iter().zip(&is_efficient).filter(|(_, is_efficient)| **is_efficient == wanted);
        runs.map(|(run, _)| *run).collect()
    };
    (part(true), part(false))
}

/// The evaluations for the error that is compared.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Price {
    /// Between two runs, by a power law.
    Exact(f64),
    /// The longest step has a smaller error.
    AtMost(f64),
}

impl Price {
    fn text(self) -> String {
        match self {
            Self::Exact(evaluations) => format!("{evaluations:.0}"),
            Self::AtMost(evaluations) => format!("≤ {evaluations:.0}"),
        }
    }
}

/// The price of an error; `None` if no run of the ladder has so small an error.
fn price(ladder: &Ladder) -> Option<Price> {
    let first = ladder.first().filter(|(_, error)| *error <= COMPARED);
    if let Some((work, _)) = first {
        return Some(Price::AtMost(*work));
    }
    let mut pairs = ladder.iter().zip(ladder.iter().skip(1));
    let (above, below) = pairs.find(|(above, below)| above.1 > COMPARED && below.1 <= COMPARED)?;
    let part = (above.1 / COMPARED).ln() / (above.1 / below.1).ln();
    Some(Price::Exact(above.0 * (below.0 / above.0).powf(part)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inefficient_runs_are_no_part_of_a_price() {
        let ladder = vec![(300.0, 1e-2), (100.0, 1e-4), (200.0, 1e-6)];
        let (kept, dropped) = efficient(&ladder);
        assert_eq!((kept.len(), dropped), (2, vec![(300.0, 1e-2)]));
        assert_eq!(price(&kept), Some(Price::AtMost(100.0)));
        assert_eq!(price(&vec![(100.0, 1e-2), (200.0, 5e-3)]), None);
        let exact = price(&vec![(100.0, 1e-2), (10_000.0, 1e-4)]);
        assert!(matches!(exact, Some(Price::Exact(work)) if (work - 1000.0).abs() < 1e-9), "{exact:?}");
    }
}
