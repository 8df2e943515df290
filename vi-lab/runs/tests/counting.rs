//! Evaluations are counted without changing a bit.

use core::cell::Cell;
use vi_core::{FixedStep, Starts, State};
use vi_runs::counting::Counting;
use vi_systems::Pendulum;

#[test]
fn every_evaluation_of_a_fixed_step_is_counted_and_no_bit_is_changed() {
    let evaluations = Cell::new(0);
    let plain = Pendulum::default();
    let counting = Counting::new(Pendulum::default(), &evaluations);
    let start = State::at(&plain, 0.0, [1.0], [0.0]);
    let mut runs = (
        plain.at_state(start).integrate(FixedStep, 0.01).expect("a start"),
        counting.at_state(start).integrate(FixedStep, 0.01).expect("a start"),
    );
    for _ in 0..100 {
        let before = evaluations.get();
        assert_eq!(runs.0.step(), runs.1.step());
        // Each correction evaluates the equation with its Jacobian, and then the residual.
        assert_eq!(evaluations.get() - before, 2 * u64::from(runs.1.iterations()));
    }
}
