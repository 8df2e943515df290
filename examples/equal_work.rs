//! Work for the same error: energy-preserving steps of order 2, 4 and 6 beside fixed steps of the same order.
//!
//! In: nothing. Out: for Kepler's problem from the pericentre, evaluations of the equations in ten periods, from the
//! largest error of the position in the tenth period, interpolated to 1e-3 between two lengths of the first step. A line
//! of `docs/theory.md` is the ratio. `cargo run --release --example equal_work`

use std::f64::consts::TAU;
use vi_core::{
    Called, EnergyPreserving, EnergyPreservingGauss, FixedStep, Gauss, Lagrangian, Method, Run, Starts, StepError,
};
use vi_erased::integrator::OF_A_CORRECTION;
use vi_systems::Kepler;

/// The error at which work is compared.
const ERROR: f64 = 1e-3;

/// Work and error of a run, whose iteration takes this many evaluations.
fn run<S: Lagrangian<2> + Copy, M: Method<S, 2>>(
    mut run: Run<M, S, 2>,
    e: f64,
    evaluations: u64,
) -> Result<(f64, f64), StepError> {
    let (mut iterations, mut worst) = (0, 0.0_f64);
    while run.t() < 10.0 * TAU {
        let is_last = run.t() >= 9.0 * TAU;
        let state = run.step()?;
        iterations += u64::from(run.iterations());
        if is_last {
            // Kepler's equation.
            let mean = state.t.rem_euclid(TAU);
            let anomaly = (0..50).fold(mean, |e1, _| e1 - (e1 - e * e1.sin() - mean) / (1.0 - e * e1.cos()));
            let exact = [anomaly.cos() - e, (1.0 - e * e).sqrt() * anomaly.sin()];
            worst = worst.max((state.q.x - exact[0]).hypot(state.q.y - exact[1]));
        }
    }
    #[allow(clippy::cast_precision_loss)] // far below 2⁵³
    let work = (iterations * evaluations) as f64;
    Ok((work, worst))
}

/// The work for [`ERROR`], by a power law between two runs, the first from the longer step; `None` if the longest step is
/// already better or the shortest one is not good enough. A run that costs more than one with a shorter step does not count.
fn price(rungs: &[(f64, f64)]) -> Option<f64> {
    let least = |from: usize| rungs[from..].iter().map(|(work, _)| *work).fold(f64::INFINITY, f64::min);
    let efficient: Vec<_> =
        (0..rungs.len()).filter(|&rung| rungs[rung].0 < least(rung + 1)).map(|rung| rungs[rung]).collect();
    let pair = efficient.windows(2).find(|pair| pair[0].1 > ERROR && pair[1].1 <= ERROR)?;
    let part = (pair[0].1 / ERROR).ln() / (pair[0].1 / pair[1].1).ln();
    Some(pair[0].0 * (pair[1].0 / pair[0].0).powf(part))
}

/// Prints the work of fixed and of energy-preserving steps of an order, from first steps `h`, each half of the one before.
fn print(
    (e, order, note): (f64, u32, &str),
    h: &[f64],
    fixed: impl Fn(f64) -> Result<(f64, f64), StepError>,
    energy: impl Fn(f64) -> Result<(f64, f64), StepError>,
) -> Result<(), StepError> {
    let price_of = |run: &dyn Fn(f64) -> Result<(f64, f64), StepError>| -> Result<Option<f64>, StepError> {
        Ok(price(&h.iter().map(|h| run(h * (1.0 - e))).collect::<Result<Vec<_>, _>>()?))
    };
    let (fixed, energy) = (price_of(&fixed)?, price_of(&energy)?);
    let ratio = fixed.zip(energy).map(|(fixed, energy)| energy / fixed);
    let shown =
        |number: Option<f64>, digits: usize| number.map_or_else(|| "-".to_owned(), |it| format!("{it:.digits$}"));
    println!("{e:4} {order:5} {:>12} {:>12} {:>6}  {note}", shown(fixed, 0), shown(energy, 0), shown(ratio, 2));
    Ok(())
}

/// The lines of an order with S stages.
fn of_stages<const S: usize>(e: f64, h: &[f64], is_shifted: bool) -> Result<(), StepError> {
    let start = || Called(Kepler::default()).at(0.0, [1.0 - e, 0.0], [0.0, ((1.0 + e) / (1.0 - e)).sqrt()]);
    let fixed = |h: f64| run(start().integrate(Gauss::<S>, h)?, e, S as u64);
    let energy = |h: f64| {
        let of = start().integrate(EnergyPreservingGauss::<S>, h)?;
        run(if is_shifted { of.with_shift_from(TAU)? } else { of }, e, S as u64)
    };
    let note = if is_shifted { "with a shift" } else { "" };
    print((e, 2 * u32::try_from(S).unwrap_or(0), note), h, fixed, energy)
}

fn main() -> Result<(), StepError> {
    println!("   e order  fixed steps   preserving  ratio");
    for e in [0.3, 0.6] {
        let (q, v) = ([1.0 - e, 0.0], [0.0, ((1.0_f64 + e) / (1.0 - e)).sqrt()]);
        let fixed = |h: f64| run(Kepler::default().at(0.0, q, v).integrate(FixedStep, h)?, e, OF_A_CORRECTION);
        let energy =
            |h: f64| run(EnergyPreserving::from_midpoint(Kepler::default(), 0.0, q, v, h)?, e, OF_A_CORRECTION);
        print((e, 2, ""), &[0.02, 0.01, 0.005, 0.0025, 0.00125], fixed, energy)?;
        of_stages::<2>(e, &[0.16, 0.08, 0.04, 0.02, 0.01], false)?;
        of_stages::<3>(e, &[0.48, 0.24, 0.12, 0.06], e > 0.5)?;
    }
    Ok(())
}
