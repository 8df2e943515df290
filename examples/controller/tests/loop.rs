//! The controller and the pendulum together, without `std` and `alloc`, unless the feature `std` of this crate is set.

use controller::CartPole;
use controller::Controller;
use controller::pendulum::Pendulum;
use vi_core::{Gauss, Starts, StepError};

/// θ over 4 s from this angle.
fn controlled(angle: f64) -> Result<Vec<f64>, StepError> {
    let mut pendulum = Pendulum::at_rest(angle)?;
    let mut controller = Controller::new(pendulum.measured())?;
    let mut force = 0.0;
    let period = |_| {
        let next = controller.force(pendulum.measured())?;
        let reached = pendulum.pushed(force)?.q[1];
        force = next;
        Ok(reached)
    };
    (0..800).map(period).collect()
}

#[test]
fn the_pendulum_stays_upright() {
    let angles = controlled(0.25).unwrap();
    let late = angles[600..].iter().fold(0.0, |largest: f64, angle| largest.max(angle.abs()));
    println!("θ at last below {late:.1e}");
    assert!(angles[0] > 0.2);
    // The program `board` prints the same bits, where double precision is computed by calls.
    #[cfg(not(feature = "std"))]
    assert_eq!(angles[799].to_bits(), 0xbf22_3e8f_4ec8_623e);
    // Less than four counts of the encoder, of 7.7e-4 each.
    assert!(late < 3e-3);
}

#[test]
fn a_controller_keeps_its_state_after_a_lost_measurement() {
    let mut controller = Controller::new([0.0, 0.1]).unwrap();
    let mut other = controller.clone();
    controller.force([0.0, f32::NAN]).unwrap_err();
    assert_eq!(controller.force([0.0, 0.1]).unwrap().to_bits(), other.force([0.0, 0.1]).unwrap().to_bits());
}

/// A step of 0.6 s is too long for fixed-point iteration.
#[test]
fn without_memory_a_step_that_is_too_long_is_an_error() {
    let start = CartPole::default().at(0.0, [0.0, 0.1], [0.0, 0.0]);
    let outcome = start.integrate(Gauss::<2>, 0.6).unwrap().step();
    println!("{outcome:?}");
    #[cfg(not(feature = "std"))]
    assert!(
        matches!(outcome, Err(StepError::StagesNotConverged { stiffness, .. }) if stiffness.is_finite()),
        "{outcome:?}"
    );
    #[cfg(feature = "std")]
    outcome.unwrap();
}
