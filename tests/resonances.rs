//! Nonlinear resonances of the fixed step: where a step turns the phase by a third, the smallest quadratic force drives the
//! motion away, though the linear problem is stable there. Verlet at h ω = √3, the midpoint rule at 2 √3.

use vi_core::{FixedStep, State, Stepping, lagrangian};

lagrangian! {
    /// Oscillator with a quadratic force, by the trapezoidal rule.
    struct Explicit {
        param a = 1.0;
        coord x;
        L = dot(x)^2 / 2 - x^2 / 2 - a * x^3 / 3;
        discretize trapezoidal;
    }
}

lagrangian! {
    /// The same by the midpoint rule.
    struct Implicit {
        param a = 1.0;
        coord x;
        L = dot(x)^2 / 2 - x^2 / 2 - a * x^3 / 3;
        discretize midpoint;
    }
}

/// The largest amplitude over 3000 steps of length h from x = 0.03 at rest, up to 1, or to where no step is left.
fn amplitude<S: Stepping<1> + Copy>(system: S, h: f64) -> f64 {
    let start = State::at(&system, 0.0, [0.03], [0.0]);
    let run = FixedStep::new(system, start, h).expect("a valid start");
    let mut largest = 0.0_f64;
    for state in run.take(3000) {
        let Ok(state) = state else { return 1.0 };
        largest = largest.max(state.q[0].hypot(state.p[0]));
        if largest >= 1.0 {
            return 1.0;
        }
    }
    largest
}

#[test]
fn a_third_of_a_turn_a_step_drives_the_motion_away() {
    let three = 3.0_f64.sqrt();
    let explicit = [0.95, 1.0, 1.05].map(|factor| amplitude(Explicit::default(), factor * three));
    let implicit = [0.9, 1.0, 1.1].map(|factor| amplitude(Implicit::default(), factor * 2.0 * three));
    println!("{explicit:?} {implicit:?}");
    for [below, at, above] in [explicit, implicit] {
        assert!(at >= 1.0 && below < 0.2 && above < 0.2, "{below} {at} {above}");
    }
}
