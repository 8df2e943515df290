//! A system without a rule: every method that needs none takes the same steps as with a rule.

use vi_core::derivatives::{Tangent, Variation};
use vi_core::motion::TimeScale;
use vi_core::stepping::Convertible;
use vi_core::{EnergyPreservingGauss, Gauss, Run, Starts, State, StepError};

/// The same system without a rule and with one.
macro_rules! systems {
    ($($tokens:tt)*) => {
        mod alone {
            ::vi_core::lagrangian! { pub(crate) struct Kepler { $($tokens)* } }
        }
        mod by_rule {
            ::vi_core::lagrangian! { pub(crate) struct Kepler { $($tokens)* discretize midpoint; } }
        }
    };
}

systems! {
    param mu = 1.1;
    coord x, y;
    let r = sqrt(x^2 + y^2);
    L = (dot(x)^2 + dot(y)^2) / 2 + mu / r;
    time_scale = r^(3/2);
}

/// Bits of a run: states, and their derivatives with respect to the start and the parameter.
fn bits<S: TimeScale<2> + Convertible<2> + Copy>(system: S) -> Result<Vec<u64>, StepError> {
    let start = State::at(&system, 0.0, [0.4, 0.0], [0.0, 2.0]);
    let mut numbers = Vec::new();
    let mut push = |state: State<2>| numbers.extend([state.t].iter().chain(state.q.iter()).chain(state.p.iter()));
    for state in system.at_state(start).integrate(Gauss::<4>, 0.05)?.take(20) {
        push(state?);
    }
    for state in system.at_state(start).integrate(Gauss::<4>.in_transformed_time(), 0.2)?.take(20) {
        push(state?);
    }
    let mut energy = system.at_state(start).integrate(EnergyPreservingGauss::<2>, 0.02)?;
    for _ in 0..20 {
        push(energy.step()?);
    }
    let directions = vec![Variation::of_coordinate(0)?, Variation::of_parameter::<S>("mu")?];
    let mut tangent = Tangent::new(system.at_state(start).integrate(Gauss::<2>, 0.05)?, directions);
    for _ in 0..10 {
        push(tangent.step()?);
    }
    for variation in tangent.variations() {
        push(State { t: 0.0, q: variation.q, p: variation.p });
    }
    Ok(numbers.into_iter().map(f64::to_bits).collect())
}

#[test]
fn every_method_that_needs_no_rule_takes_the_same_steps() {
    let found = bits(alone::Kepler::default()).expect("steps");
    assert_eq!(found.len(), (20 * 3 + 10 + 2) * 5);
    assert_eq!(found, bits(by_rule::Kepler::default()).expect("steps"));
    assert_ne!(found, bits(alone::Kepler { mu: 1.2 }).expect("steps"));
}

#[test]
fn a_checkpoint_is_of_a_system_and_not_of_a_rule() {
    let system = alone::Kepler::default();
    let start = State::at(&system, 0.0, [0.4, 0.0], [0.0, 2.0]);
    let mut run = system.at_state(start).integrate(Gauss::<4>, 0.05).expect("a start");
    run.step().expect("a step");
    let stored = run.checkpoint();
    let mut again = Run::restart(system, Gauss::<4>, stored.clone()).expect("the same system");
    assert_eq!(run.step(), again.step());
    let other = Run::restart(alone::Kepler { mu: 1.2 }, Gauss::<4>, stored).expect_err("another system");
    assert!(matches!(other, StepError::OtherSystem { parameter: Some("mu"), .. }), "{other}");
}
