//! Energy errors over 800 periods: Kepler's problem, e = 0.6, by this project's methods and by DOP853.
//!
//! In: nothing. Out: CSV, for each method its evaluations of the equations in a unit of time, and the largest relative energy
//! error up to a time. `cargo run --release --example energy_error`; `docs/figures/readme.py` draws it.

use std::cell::Cell;
use std::error::Error;
use vi_erased::kind;
use vi_erased::plan::{Method, PhasePoint, Plan, Start};
use vi_systems::Kepler;

/// About 800 periods.
const END: f64 = 5000.0;
/// Steps of this project's methods between two energies: 200 000 energies of the shortest steps.
const BETWEEN: u64 = 5;

/// The largest error so far, wherever time has grown by 2 %.
struct Largest {
    initial: f64,
    error: f64,
    points: Vec<(f64, f64)>,
}

impl Largest {
    fn see(&mut self, t: f64, energy: f64) {
        self.error = self.error.max((energy / self.initial - 1.0).abs());
        if t > 0.0 && self.points.last().is_none_or(|(last, _)| t > last * 1.02) {
            self.points.push((t, self.error));
        }
    }

    fn print(mut self, name: &str, evaluations: u64) {
        self.points.push((END, self.error));
        #[allow(clippy::cast_precision_loss)] // some millions
        let rate = evaluations as f64 / END;
        for (t, error) in self.points {
            println!("{name},{rate:.1},{t:e},{error:e}");
        }
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    let kepler = kind!(Kepler, { fixed; energy; gauss 4, 8 });
    let start = PhasePoint { t: 0.0, q: vec![0.4, 0.0], v: vec![0.0, 2.0] };
    let initial = kepler.energy(&start)?;
    let largest = || Largest { initial, error: 0.0, points: Vec::new() };
    println!("method,evaluations in a unit of time,t,largest energy error so far");
    for (name, method, stages, h) in [
        ("fixed step", Method::Fixed, None, 0.005),
        ("order 8", Method::KahanLi8, None, 0.085),
        ("Gauss of 4 stages", Method::Gauss, Some(4), 0.08),
        ("Gauss of 8 stages", Method::Gauss, Some(8), 0.16),
        ("energy-preserving", Method::Energy, None, 0.005),
    ] {
        // The midpoints of energy-preserving steps are then on the energy of the motion.
        let plan = Plan { stages, start: Start::Midpoint, ..Plan::new(method, h, start.clone()) };
        let mut run = kepler.begin(&plan)?;
        let mut largest = largest();
        while run.t() < END {
            run.advance_until(END, BETWEEN)?;
            let (t, energy) = run.sampled_energy()?;
            largest.see(t, energy);
        }
        largest.print(name, run.evaluations());
    }
    for tolerance in [1e-9, 1e-12] {
        let mut largest = largest();
        let evaluations = Cell::new(0);
        let mut see = |t: f64, energy: f64| largest.see(t, energy);
        kepler
            .studies()
            .rival(&start, END, tolerance, &evaluations, Some(&mut see))
            .map_err(|ended| ended.to_string())?;
        largest.print(&format!("DOP853 {tolerance:e}"), evaluations.get());
    }
    Ok(())
}
