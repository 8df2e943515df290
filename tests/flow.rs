//! The flow of every system at `(t, q, p)`: the velocity for these momenta, and the rates of p and E, against
//! differences along the motion, which uses the separate acceleration function.

use crate::support::Sequence;
use crate::support::scenes::{Scene, each_system};
use vi_core::{Lagrangian, SVector, State, StepError, lagrangian};

/// Random states near each scene.
const DRAWS: u32 = 20;
/// Time span of the difference quotients.
const TIME: f64 = 1e-4;

#[allow(clippy::needless_pass_by_value, reason = "as the other tests of each scene")]
fn flow<const N: usize, S: Lagrangian<N>>(scene: Scene<S, N>) {
    let system = &scene.system;
    let mut draw = Sequence::new(11);
    let (mut worst, mut moved) = ([0.0_f64; 3], 0.0_f64);
    for _ in 0..DRAWS {
        let t = draw.within(-1.0, 2.0);
        let mut near = |values: [f64; N]| SVector::from(values.map(|value| value * draw.within(0.8, 1.2)));
        let (q, v) = (near(scene.q), near(scene.v));
        let state = State::at(system, t, q, v);
        let flow = system.flow(t, &q, &state.p).unwrap_or_else(|error| panic!("{}: {error}", S::NAME));
        let a = system.acceleration(t, &q, &v).unwrap_or_else(|error| panic!("{}: {error}", S::NAME));
        let [before, after] = [-TIME, TIME].map(|time| {
            let (t, q, v) = (t + time, q + v * time + a * (time * time / 2.0), v + a * time);
            (system.momentum(t, &q, &v), system.energy(t, &q, &v))
        });
        let force = (after.0 - before.0) / (2.0 * TIME);
        let power = (after.1 - before.1) / (2.0 * TIME);
        let differences = [
            (flow.v - v).amax() / v.amax().max(f64::MIN_POSITIVE),
            (flow.force - force).amax() / (force.amax() + state.p.amax()),
            (flow.power - power).abs() / (power.abs() + after.1.abs()),
        ];
        worst = core::array::from_fn(|index| worst[index].max(differences[index]));
        moved = moved.max(flow.force.amax());
        assert_eq!(state.velocity(system), Ok(flow.v), "{}", S::NAME);
        assert_eq!(state.energy(system), Ok(system.energy(t, &q, &flow.v)), "{}", S::NAME);
    }
    println!("{}: {worst:?}", S::NAME);
    // Measured: 5e-14 at most in the velocity, 2e-6 in the differences.
    assert!(worst[0] <= 1e-12 && worst[1] <= 1e-5 && worst[2] <= 1e-5, "{}: {worst:?}", S::NAME);
    assert!(moved > 0.0 || S::CYCLIC.iter().all(|cyclic| *cyclic), "{}: nothing was compared", S::NAME);
}

each_system!(flow);

lagrangian! {
    /// A particle near the speed of light: its momentum is not linear in the velocity.
    struct Relativistic {
        param m = 1.3, c = 1.0, k = 0.7;
        coord x, y;
        L = -m * c^2 * sqrt(1 - (dot(x)^2 + dot(y)^2) / c^2) - k * (x^2 + y^2) / 2;
        force x = -dot(x) / 5 + sin(t);
        discretize midpoint;
    }
}

#[test]
fn a_velocity_that_is_not_linear_in_the_momenta_is_found_by_iteration() {
    let system = Relativistic::default();
    for size in [0.0, 1e-8, 0.1, 1.0, 3.0, 10.0, 100.0] {
        let p = SVector::from([0.6 * size, -0.8 * size]);
        let found = system.flow(0.5, &[0.3, 0.2].into(), &p).unwrap_or_else(|error| panic!("{size}: {error}"));
        // v = p/√(m² + p²/c²), c = 1.
        let wanted = p / f64::hypot(1.3, size);
        println!("{size}: {:e}", (found.v - wanted).amax());
        assert!((found.v - wanted).amax() <= 4.0 * f64::EPSILON, "{size}: {:?}, {wanted:?}", found.v);
        let force = found.v[0] * -0.2 + f64::sin(0.5);
        assert!((found.force - SVector::from([-0.7 * 0.3 + force, -0.7 * 0.2])).amax() <= 1e-15);
        assert!((found.power - force * found.v[0]).abs() <= 1e-15);
    }
}

lagrangian! {
    /// A mass that vanishes at x = 0.
    struct Vanishing {
        coord x;
        L = x^2 * dot(x)^2 / 2;
        discretize midpoint;
    }
}

#[test]
fn momenta_without_a_velocity_are_typed_errors() {
    let zero = SVector::from([0.0]);
    let singular = Vanishing::default().flow(0.25, &zero, &SVector::from([1.0]));
    assert!(matches!(singular, Err(StepError::Singular { t: 0.25, matrix: "mass matrix" })), "{singular:?}");
    let lost = Relativistic::default().flow(0.0, &SVector::zeros(), &SVector::repeat(f64::NAN));
    assert!(matches!(lost, Err(StepError::NonFinite { .. })), "{lost:?}");
}
