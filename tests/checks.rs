//! The checks, called by hand on every system with parameters away from 1, and the values that they measure.

use crate::support::scenes::{Scene, each_system};
use vi_core::check::{self, EnergyChecked, Place, Report};

/// The reports of all checks that apply, in the order of the table of `vi_core::check`.
fn reports<const N: usize, S: EnergyChecked<N>>(system: &S, place: &Place<N>) -> Vec<Report> {
    let results = [
        Some(check::derivatives(system, place)),
        Some(check::slots(system, place)),
        Some(check::steps(system, place)),
        Some(check::energy_equations(system, place)),
        Some(check::order(system, place, 2)),
        S::CYCLIC.contains(&true).then(|| check::momenta(system, place)),
        (!S::FORCED).then(|| check::symplecticity(system, place)),
        Some(check::reversibility(system, place)),
        Some(check::energy(system, place)),
        (!S::FORCED).then(|| check::step_law(system, place)),
    ];
    results.into_iter().flatten().map(|result| result.unwrap_or_else(|failure| panic!("{failure}"))).collect()
}

/// Limit for each check here: twice its largest measured value, rounded up. The checks themselves allow more, for less
/// regular systems.
fn allowed(check: &str) -> f64 {
    match check {
        // In units of the rounding bound. Measured: 0.30.
        "derivatives" | "slots" | "steps" | "energy equations" | "symplecticity" | "reversibility" | "energy" => 0.6,
        // Slopes. Measured: 5.0e-4 and 2.5e-3.
        "order" | "step law" => 5e-3,
        // Momenta of cyclic coordinates, bit for bit.
        _ => 0.0,
    }
}

#[allow(clippy::needless_pass_by_value, reason = "as the other tests of each scene")]
fn pass<const N: usize, S: EnergyChecked<N>>(scene: Scene<S, N>) {
    let place = Place { t: 0.2, q: scene.q.into(), v: scene.v.into(), h: scene.h };
    for report in reports(&scene.system, &place) {
        println!("{report}");
        assert!(report.worst <= allowed(report.check), "{report}");
        assert!(report.compared > 0, "{report}");
    }
}

mod at_the_places_of_the_scenes {
    super::each_system!(super::pass);
}
