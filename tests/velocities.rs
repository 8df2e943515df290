//! Lagrangians that are undefined at rest: the velocity of a momentum is searched in their domain.

use vi_core::{EnergyPreserving, FixedStep, Gauss, Starts, State, StepError, lagrangian};

lagrangian! {
    /// Predators and prey of Volterra: X and Y are the integrals of the populations.
    struct Volterra {
        param a = 1.1, b = 0.4, c = 0.4, d = 0.1;
        coord X, Y;
        L = d * dot(X) * ln(dot(X)) + b * dot(Y) * ln(dot(Y)) + b * d * (dot(X) * Y - dot(Y) * X) / 2 + d * a * X - b * c * Y;
        discretize midpoint;
    }
}

lagrangian! {
    struct Root {
        param k = 1.3;
        coord x;
        L = dot(x)^(3/2) - k * x^2 / 2;
        discretize midpoint;
    }
}

lagrangian! {
    struct Inverse {
        param k = 1.3;
        coord x;
        L = 1 / dot(x) - k * x^2 / 2;
        discretize midpoint;
    }
}

/// `X' = n, n' = n (a − b m)`, `m' = m (d n − c)`, with a Runge–Kutta method and steps short enough for 1e-12.
fn numbers(system: &Volterra, [mut n, mut m]: [f64; 2], time: f64) -> [f64; 2] {
    let rate = |n: f64, m: f64| [n * (system.a - system.b * m), m * (system.d * n - system.c)];
    let steps = 40_000;
    let h = time / f64::from(steps);
    for _ in 0..steps {
        let k1 = rate(n, m);
        let k2 = rate(n + h / 2.0 * k1[0], m + h / 2.0 * k1[1]);
        let k3 = rate(n + h / 2.0 * k2[0], m + h / 2.0 * k2[1]);
        let k4 = rate(n + h * k3[0], m + h * k3[1]);
        n += h / 6.0 * (k1[0] + 2.0 * (k2[0] + k3[0]) + k4[0]);
        m += h / 6.0 * (k1[1] + 2.0 * (k2[1] + k3[1]) + k4[1]);
    }
    [n, m]
}

#[test]
fn predators_and_prey_live_on() {
    let system = Volterra::default();
    // The second start is below 1/e, from which Newton iteration leaves the domain of the logarithm.
    for v in [[10.0, 5.0], [0.3, 0.3], [1e-3, 2e-6]] {
        let start = State::at(&system, 0.0, [0.0, 0.0], v);
        let again = start.velocity(&system).expect("a velocity");
        for (found, given) in again.iter().zip(v) {
            assert!((found - given).abs() <= 1e-13 * given, "{v:?}: {again:?}");
        }
        assert!(start.energy(&system).expect("an energy").is_finite());
        let mut run = system.at_state(start).integrate(Gauss::<8>, 0.1).expect("a start");
        run.until(10.05).expect("the last step too");
        assert_eq!(run.t().to_bits(), 10.05_f64.to_bits());
        let found = run.velocity().expect("a velocity");
        let wanted = numbers(&system, v, 10.05);
        for (found, wanted) in found.iter().zip(wanted) {
            // Measured: 2e-12, the error of the reference.
            assert!((found - wanted).abs() <= 1e-10 * wanted, "{v:?}: {found} {wanted}");
        }
        let mut fixed = system.at_state(start).integrate(FixedStep, 1e-3).expect("a start");
        fixed.until(0.5).expect("fixed steps");
        let mut kept = EnergyPreserving::from_midpoint(system, 0.0, [0.0, 0.0], v, 1e-3).expect("a start");
        if let Err(error) = kept.until(0.1) {
            crate::support::ending::assert_typed(error);
        }
    }
    // A long run through small and large numbers preserves its energy.
    let start = State::at(&system, 0.0, [0.0, 0.0], [10.0, 5.0]);
    let energy = start.energy(&system).expect("an energy");
    let mut run = system.at_state(start).integrate(Gauss::<8>, 0.1).expect("a start");
    let mut worst = 0.0_f64;
    for _ in 0..300 {
        run.step().expect("a step");
        worst = worst.max((run.energy().expect("an energy") - energy).abs());
    }
    run.until(30.05).expect("the last step");
    println!("energy off by {worst:.1e}");
    // Measured: 4.4e-15.
    assert!(worst <= 2e-14 && worst > 0.0, "{worst:e}");
}

#[test]
fn a_power_of_the_velocity_has_one() {
    let system = Root::default();
    for v in [1e-6, 0.02, 1.0, 300.0] {
        let start = State::at(&system, 0.0, [0.1], [v]);
        let found = start.velocity(&system).expect("a velocity")[0];
        assert!((found - v).abs() <= 1e-14 * v, "{v}: {found}");
    }
    // No velocity has a negative momentum.
    let start = State { t: 0.0, q: [0.1].into(), p: [-0.5].into() };
    assert!(start.velocity(&system).is_err());
}

/// `p = −1/v²` belongs to v and to −v: the momentum does not determine the sign.
#[test]
fn two_velocities_of_one_momentum_are_an_error() {
    let system = Inverse::default();
    for v in [2.0, -2.0, 1e-3] {
        let start = State::at(&system, 0.5, [0.1], [v]);
        let error = start.velocity(&system).expect_err("two velocities");
        assert_eq!(error, StepError::Ambiguous { t: 0.5 });
        assert!(error.to_string().contains("two velocities have the same momenta"), "{error}");
        assert!(system.at_state(start).integrate(Gauss::<2>, 0.01).is_err());
    }
}

lagrangian! {
    struct Mixed {
        param k = 1.0;
        coord x, y;
        L = -1 / dot(x) + dot(y) * ln(dot(y)) - k * x^2 / 2;
        discretize midpoint;
    }
}

lagrangian! {
    struct Bent {
        param k = 1.0;
        coord x;
        L = -1 / dot(x) + dot(x)^2 / 2 - k * x^2 / 2;
        discretize midpoint;
    }
}

lagrangian! {
    struct Quadrant {
        param k = 1.0;
        coord x, y;
        L = -ln(-dot(x)) + ln(dot(y)) - k * x^2 / 2;
        discretize midpoint;
    }
}

/// Two branches of one coordinate next to one with a single branch, and two branches with the same sign.
#[test]
fn two_branches_among_others_are_an_error() {
    for v in [[-0.5, 0.3], [1e-3, 0.3], [0.5, 2.0]] {
        let start = State::at(&Mixed::default(), 0.0, [0.0, 0.0], v);
        assert_eq!(start.velocity(&Mixed::default()).expect_err("two velocities"), StepError::Ambiguous { t: 0.0 });
    }
    for v in [0.5, -0.5, 0.1] {
        let start = State::at(&Bent::default(), 0.0, [0.0], [v]);
        assert_eq!(start.velocity(&Bent::default()).expect_err("two velocities"), StepError::Ambiguous { t: 0.0 });
    }
}

#[test]
fn every_choice_of_signs_is_searched() {
    for v in [[-0.5, 0.3], [-1e-3, 20.0], [-4.0, 1e-3]] {
        let start = State::at(&Quadrant::default(), 0.0, [0.1, 0.0], v);
        let found = start.velocity(&Quadrant::default()).expect("a velocity");
        assert!((0..2).all(|k| (found[k] - v[k]).abs() <= 1e-13 * v[k].abs()), "{v:?}: {found:?}");
    }
}
