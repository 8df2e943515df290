//! Many runs of a system with constraints, against each alone.

use vi_core::{Gauss, Run, Starts, State, StepError, lagrangian};
use vi_ensemble::{Ended, Runs};

lagrangian! {
    /// Two rods.
    struct Rods {
        param g = 9.81, l = 1.0;
        coord x, y, u, w;
        L = dot(x)^2 + dot(y)^2 + (dot(u)^2 + dot(w)^2) / 2 - g * (2 * y + w);
        constraint upper = x^2 + y^2 - l^2;
        constraint lower = (u - x)^2 + (w - y)^2 - 1;
    }
}

const STEPS: u32 = 40;
const MEMBERS: u32 = 60;

/// Member k: its weight, length and speed differ. The heaviest fall so fast that a rod turns by a right angle in a step.
fn member<const STAGES: usize>(k: u32) -> Result<Run<Gauss<STAGES>, Rods, 4>, StepError> {
    let part = f64::from(k) / f64::from(MEMBERS);
    let rods = Rods { g: 400.0 * part * part, l: 1.0 + part };
    let (q, v) = ([0.9 + part, 0.4, 1.5 + part, 1.0], [0.1, part, 0.0, 0.2]);
    rods.at_state(State::projected(&rods, 0.0, q, v)?.state).integrate(Gauss, 0.05)
}

fn check<const STAGES: usize>() {
    let begin = || (0..MEMBERS).map(member::<STAGES>).collect::<Result<Vec<_>, _>>().expect("starts");
    let mut together = Runs::new(begin());
    // In two parts, of which the second continues the first.
    together.run(u64::from(STEPS / 4));
    together.run(u64::from(STEPS - STEPS / 4));
    let mut failed = 0;
    for (found, mut alone) in together.results().zip(begin()) {
        let mut taken = 0;
        let error = (0..STEPS).find_map(|_| {
            let error = alone.step().err();
            taken += u64::from(error.is_none());
            error
        });
        // The same bits: states are compared as numbers, none of which is NaN.
        match error {
            None => assert_eq!(found, Ok(alone.state())),
            Some(error) => {
                failed += 1;
                assert!(matches!(error, StepError::NotConverged { .. }), "{error}");
                assert_eq!(found, Err(Ended { state: alone.state(), steps: taken, error }));
            }
        }
    }
    println!("s = {STAGES}: {failed} of {MEMBERS} ended");
    assert!(failed > 3 && failed < MEMBERS - 3, "{failed}");
    assert_eq!(together.running() + failed as usize, MEMBERS as usize);
}

#[test]
fn runs_with_constraints_are_those_alone_and_fail_alone() {
    check::<1>();
    check::<2>();
}
