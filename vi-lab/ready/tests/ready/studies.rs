//! Systems of a text have the studies of the compiled ones, without their coordinates at rest.

use core::cell::Cell;
use vi_erased::kind;
use vi_erased::plan::{Method, PhasePoint, Plan};
use vi_systems::{ChaplyginSleigh, ChargedParticle, DoubleRodPendulum, DoubleWell, HenonHeiles};

/// The largest difference of two lists of one length.
fn off(one: &[f64], other: &[f64]) -> f64 {
    assert_eq!(one.len(), other.len());
    one.iter().zip(other).fold(0.0, |most, (one, other)| most.max((one - other).abs()))
}

#[test]
fn a_text_is_studied_as_the_compiled_system() {
    // One, two and three coordinates, the others at rest; a rod and a blade.
    let compiled = [
        kind!(DoubleWell, { energy }),
        kind!(HenonHeiles, { energy }),
        kind!(ChargedParticle, { energy }),
        kind!(DoubleRodPendulum, { gauss 1 }),
        kind!(ChaplyginSleigh, { gauss 1 }),
    ];
    for compiled in compiled {
        let name = compiled.name();
        let entry = vi_ready::systems().into_iter().find(|entry| entry.name == name).expect("a system");
        let at = PhasePoint { t: 0.0, q: entry.q.clone(), v: entry.v.clone() };
        let systems = [&*compiled, &**entry.system];

        let [one, other] = systems.map(|system| system.studies().step_density(&at));
        assert_eq!(one.is_some(), compiled.has(Method::Energy), "{name}");
        assert!(off(one.as_slice(), other.as_slice()) <= 1e-9 * one.unwrap_or(0.0).abs(), "{name}: {one:?} {other:?}");
        let p = compiled.momentum(&at).expect("momenta");
        let [one, other] =
            systems.map(|system| system.studies().step_densities(0.0, &at.q, &p).map(|of| of.unwrap_or(0.0)));
        let scale = one.iter().fold(0.0, |most: f64, of| most.max(of.abs()));
        assert!(off(&one, &other) <= 1e-9 * scale, "{name}: {one:?} {other:?}");

        let [one, other] = systems.map(|system| system.studies().follow(&at, 0.4).expect("a motion"));
        assert!(off(&one.q, &other.q).max(off(&one.v, &other.v)) < 1e-12, "{name}"); // 4.4e-16
        assert!(off(&one.q, &at.q) > 1e-3, "{name} moves");
        let counts = [Cell::new(0), Cell::new(0)];
        let rival = |of: usize| systems[of].studies().rival(&at, 0.4, 1e-10, &counts[of], None).expect("a motion");
        let [one, other] = [0, 1].map(rival);
        assert!(off(&one.q, &other.q).max(off(&one.v, &other.v)) < 1e-9, "{name}");
        assert!(counts[0].get() > 10 && counts[1].get() > 10, "{name}");

        let size = at.q.len();
        let freedom = match name {
            "DoubleRodPendulum" => 4,
            "ChaplyginSleigh" => 5,
            _ => 2 * size,
        };
        let plan = Plan::new(Method::Gauss, entry.h, at);
        let [one, other] = systems.map(|system| {
            let mut exponents = system.studies().lyapunov(&plan, freedom, size).expect("exponents");
            exponents.advance(40).expect("steps");
            assert_eq!(exponents.q().len(), size);
            exponents.exponents()
        });
        assert!(one.iter().any(|of| of.abs() > 1e-3) && off(&one, &other) < 1e-9, "{name}: {one:?} {other:?}");
        let refused = entry.system.studies().lyapunov(&plan, freedom + 1, size).err();
        assert!(matches!(refused, Some(vi_core::StepError::InvalidInput { .. })), "{name}: {refused:?}");
    }
}
