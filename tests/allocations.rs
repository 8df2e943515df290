//! Steps allocate nothing, but for the first ones, which allocate their buffers.

use allocation_counter::measure;
use vi_core::prelude::*;
use vi_core::stepping::Convertible;
use vi_core::{Composition, EnergyPreservingGauss, Gauss, Method, Run, Splitting};
use vi_systems::{DoublePendulum, Kepler, RodPendulum};

/// Fails if one of 40 steps after the tenth allocates. Returns how often the first ten do.
fn check<M: Method<S, N>, S: Convertible<N>, const N: usize>(run: Result<Run<M, S, N>, StepError>) -> u64 {
    let mut run = run.expect("a start");
    let before = run.t();
    let first = measure(|| (0..10).for_each(|_| assert!(run.step().is_ok())));
    let later = measure(|| (0..40).for_each(|_| assert!(run.step().is_ok())));
    println!("{} {:?}: {} and {} allocations", S::NAME, run.method(), first.count_total, later.count_total);
    assert!(run.t() > before);
    assert_eq!(later.count_total, 0, "{} {:?}", S::NAME, run.method());
    first.count_total
}

#[test]
fn free_steps_allocate_nothing() {
    let start = DoublePendulum::default().at(0.0, [0.5, -0.3], [0.1, 0.2]);
    check(start.integrate(FixedStep, 0.01));
    check(start.integrate(Composition::SUZUKI_4, 0.01));
    check(start.integrate(Composition::KAHAN_LI_8, 0.01));
    check(start.integrate(Gauss::<1>, 0.01));
    check(start.integrate(Gauss::<4>, 0.01));
    check(start.integrate(EnergyPreserving, 0.01));
    let start = Kepler::default().at(0.0, [1.6, 0.0], [0.0, 0.5]);
    check(start.integrate(Splitting::BLANES_MOAN_6, 0.01));
    check(start.integrate(Gauss::<4>.in_transformed_time(), 0.01));
    check(start.integrate(EnergyPreservingGauss::<2>, 0.05));
}

#[test]
fn bound_steps_allocate_nothing() {
    let system = RodPendulum::default();
    let (q, v) = system.start();
    let start = system.at(0.0, q, v);
    let first = [
        check(start.integrate(Gauss::<1>, 0.01)),
        check(start.integrate(Gauss::<3>, 0.01)),
        check(start.integrate(Gauss::<1>.composed(Composition::SUZUKI_4), 0.01)),
        check(start.integrate(Gauss::<1>.composed(Composition::KAHAN_LI_8), 0.01)),
        check(start.integrate(EnergyPreservingGauss::<2>, 0.05).and_then(|run| run.with_shift_from(3.0))),
    ];
    // Their buffers: the counter counts.
    assert!(first.iter().all(|&count| count > 0), "{first:?}");
}
