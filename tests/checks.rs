//! The checks, called by hand on every system with parameters away from 1: what they measure.

mod support;

use support::scenes::{Scene, each_system};
use vi_core::check::{self, Checked, Place, Report};

/// The reports of all checks that apply, in the order of the table of `vi_core::check`.
fn reports<const N: usize, S: Checked<N>>(system: &S, place: &Place<N>) -> Vec<Report> {
    let results = [
        Some(check::derivatives(system, place)),
        Some(check::slots(system, place)),
        Some(check::steps(system, place)),
        Some(check::order(system, place, 2)),
        S::CYCLIC.contains(&true).then(|| check::momenta(system, place)),
        (!S::FORCED).then(|| check::symplecticity(system, place)),
        Some(check::reversibility(system, place)),
        Some(check::energy(system, place)),
        (!S::FORCED).then(|| check::step_law(system, place)),
    ];
    results.into_iter().flatten().map(|result| result.unwrap_or_else(|failure| panic!("{failure}"))).collect()
}

/// What each check measures at most, twice and rounded up. The checks themselves allow more, for systems less tame.
fn allowed(check: &str) -> f64 {
    match check {
        "derivatives" => 1.0,
        _ => 1.0,
    }
}

fn pass<const N: usize, S: Checked<N>>(scene: Scene<S, N>) {
    let place = Place { t: 0.2, q: scene.q.into(), v: scene.v.into(), h: scene.h };
    for report in reports(&scene.system, &place) {
        println!("{report}");
        assert!(report.worst <= allowed(report.check), "{report}");
        assert!(report.compared >= 3, "{report}");
    }
}

mod at_the_places_of_the_scenes {
    super::each_system!(super::pass);
}
