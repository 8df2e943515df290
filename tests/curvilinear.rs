//! Gauss steps in curvilinear coordinates, whose iterations evaluate forces at the velocities of the momenta.

use vi_core::motion::Motion;
use vi_core::stepping::Convertible;
use vi_core::{Gauss, Starts, StepError, lagrangian};
use vi_systems::{DoublePendulum, Kepler, SphericalPendulum};

lagrangian! {
    /// A geodesic about a black hole of mass M, in the equatorial plane, by proper time.
    struct Geodesic {
        param M = 1.3;
        coord T, r, φ;
        L = (-(1 - 2 * M / r) * dot(T)^2 + dot(r)^2 / (1 - 2 * M / r) + r^2 * dot(φ)^2) / 2;
    }
}

lagrangian! {
    /// Kepler's problem in polar coordinates.
    struct Polar {
        param mu = 1.3;
        coord r, φ;
        L = (dot(r)^2 + r^2 * dot(φ)^2) / 2 + mu / r;
    }
}

lagrangian! {
    /// A symmetric top in Euler angles.
    struct Top {
        param A = 1.3, C = 0.7, w = 5;
        coord φ, θ, ψ;
        L = (A * (dot(φ)^2 * sin(θ)^2 + dot(θ)^2) + C * (dot(ψ) + dot(φ) * cos(θ))^2) / 2 - w * cos(θ);
    }
}

lagrangian! {
    /// A pendulum on a cart.
    struct Cart {
        coord x, θ;
        L = (3 * dot(x)^2 + dot(θ)^2) / 2 + dot(x) * dot(θ) * cos(θ) + 9.81 * cos(θ);
    }
}

lagrangian! {
    /// A mass on a turning rod, with a torque that grows from zero.
    struct Ramp {
        coord r, φ;
        L = (dot(r)^2 + r^2 * dot(φ)^2) / 2 - 2 * (r - 1)^2;
        force φ = t;
    }
}

lagrangian! {
    /// A mass on a turning rod, at rest until a pulse of torque.
    struct Late {
        coord r, φ;
        L = (dot(r)^2 + r^2 * dot(φ)^2) / 2 - (r - 1)^2 / 2;
        force φ = exp(-20 * (t - 10)^2);
    }
}

lagrangian! {
    /// Two masses that attract each other: the second one is at rest until the first one has moved.
    struct Coupled {
        coord x, r, φ;
        L = (dot(x)^2 + dot(r)^2 + r^2 * dot(φ)^2) / 2 - 2 * (r - 1)^2 - 2 * x^2 - x * r * cos(φ);
    }
}

/// Mean iterations of a hundred steps, which change the energy by this part at most.
fn iterations<S, const N: usize, const STAGES: usize>(system: S, [q, v]: [[f64; N]; 2], h: f64, error: f64) -> f64
where
    S: Convertible<N, Kind = vi_core::kind::Free> + Motion<N>,
{
    let mut run = system.at(0.0, q, v).integrate(Gauss::<STAGES>, h).expect("a start");
    let start = run.energy().expect("finite");
    let mut iterations = 0;
    for _ in 0..100 {
        run.step().expect("a step");
        iterations += run.iterations();
        let change = (run.energy().expect("finite") / start - 1.0).abs();
        assert!(change < error, "{}: {change:e}", S::NAME);
    }
    let mean = f64::from(iterations) / 100.0;
    println!("{}, {STAGES} stages, h = {h}: {mean}", S::NAME);
    mean
}

#[test]
fn a_coordinate_scales_the_momentum_of_another() {
    fn scales<const N: usize>(system: impl Motion<N>) -> bool {
        system.is_curvilinear()
    }
    assert!(scales(Geodesic::default()) && scales(Top::default()));
    assert!(scales(Polar::default()) && scales(SphericalPendulum::default()));
    // A constant mass matrix; momenta that depend on both angles; a momentum of the cart with the velocity of the angle.
    assert!(!scales(Kepler::default()) && !scales(DoublePendulum::default()) && !scales(Cart::default()));
}

/// In parentheses the iterations with forces at the velocities of the last iteration.
#[test]
fn long_steps_take_few_iterations() {
    let orbit = [[0.0, 13.0, 0.0], [1.25, 0.0, 0.03]];
    // Measured: 9.37 (14.93), 6.84 (11.46), 6.01 (9.73), 6.20 (9.94), 7.56 (12.70).
    assert!(iterations::<_, 3, 8>(Geodesic::default(), orbit, 52.0, 1e-12) < 10.0);
    assert!(iterations::<_, 2, 8>(Polar::default(), [[0.7, 0.0], [0.0, 2.0]], 0.3, 1e-12) < 7.0);
    assert!(iterations::<_, 2, 4>(Polar::default(), [[0.7, 0.0], [0.0, 2.0]], 0.1, 1e-9) < 7.0);
    assert!(iterations::<_, 3, 8>(Top::default(), [[0.0, 0.6, 0.0], [0.5, 0.0, 20.0]], 0.05, 1e-12) < 7.0);
    assert!(iterations::<_, 2, 8>(SphericalPendulum::default(), [[1.0, 0.0], [0.2, 2.0]], 0.1, 1e-9) < 10.0);
}

#[test]
fn polar_and_cartesian_orbits_agree() {
    let mut polar = Polar::default().at(0.0, [0.7, 0.0], [0.0, 2.0]).integrate(Gauss::<8>, 0.15).expect("a start");
    let kepler = Kepler { mu: 1.3 };
    let mut plane = kepler.at(0.0, [0.7, 0.0], [0.0, 1.4]).integrate(Gauss::<8>, 0.05).expect("a start");
    let [polar, plane] = [polar.until(30.0).expect("steps").q, plane.until(30.0).expect("steps").q];
    let off = (polar.x * polar.y.cos() - plane.x).hypot(polar.x * polar.y.sin() - plane.y);
    // Measured: 1e-14.
    println!("{off:e}");
    assert!(off < 1e-13, "{off:e}");
}

/// Beyond the pole θ = 0 there are further solutions, near which the iteration contracts fast.
#[test]
fn long_steps_hardly_ever_pass_a_pole() {
    fn passes<const STAGES: usize>() -> [u32; 3] {
        let mut counts = [0; 3];
        for sample in 0..1500 {
            let number = |factor: f64| (factor * f64::from(sample)).rem_euclid(1.0);
            let (θ, v, φ, h) = (
                0.1 + 2.9 * number(0.618_033_988),
                6.0 * (number(0.754_877_666) - 0.5),
                0.05 + number(0.569_840_291),
                0.01 + number(0.414_213_562),
            );
            let start = SphericalPendulum::default().at(0.0, [θ, 0.0], [v, φ / θ.sin()]);
            let mut run = start.integrate(Gauss::<STAGES>, h).expect("a start");
            match run.step() {
                Ok(end) => counts[usize::from(!(0.0..core::f64::consts::PI).contains(&end.q.x))] += 1,
                Err(StepError::StagesNotConverged { .. } | StepError::TooLong { .. }) => counts[2] += 1,
                Err(error) => panic!("{sample}: {error}"),
            }
        }
        println!("{STAGES} stages: {counts:?}");
        counts
    }
    // Measured: 794 steps and 1 pass, 861 and 1. With forces at the velocities of the last iteration 710 and 6, 759 and 5; with
    // a proof by the contraction of the iteration at least three times as many passes.
    for [solved, passes, _] in [passes::<4>(), passes::<8>()] {
        assert!(solved > 730 && passes < 4, "{solved}, {passes}");
    }
}

lagrangian! {
    /// A free particle in polar coordinates.
    struct Passing {
        coord r, φ;
        L = (dot(r)^2 + r^2 * dot(φ)^2) / 2;
    }
}

/// A particle turns about the centre before the first stage of a long step. If r changes its sign instead, its place is that
/// of the motion up to the error of the step.
#[test]
fn long_steps_see_a_turn_before_their_first_stage() {
    fn passes<const STAGES: usize>() -> [u32; 4] {
        let mut counts = [0; 4];
        for sample in 0..1500 {
            let number = |factor: f64| (factor * f64::from(sample)).rem_euclid(1.0);
            let r = 10.0_f64.powf(-3.0 * number(0.618_033_988));
            let v = -(10.0_f64).powf(2.0 * number(0.754_877_666) - 1.0);
            let w = 10.0_f64.powf(4.0 * number(0.569_840_291) - 3.0);
            let h = 10.0_f64.powf(3.0 * number(0.414_213_562) - 2.0);
            let mut run = Passing::default().at(0.0, [r, 0.0], [v, w]).integrate(Gauss::<STAGES>, h).expect("a start");
            match run.step() {
                Ok(end) => {
                    let (x, y) = (end.q.x * end.q.y.cos(), end.q.x * end.q.y.sin());
                    let (off, way) = ((x - r - v * h).hypot(y - r * w * h), (v * h).hypot(r * w * h));
                    counts[usize::from(end.q.x < 0.0) * (1 + usize::from(off > 0.1 * way))] += 1;
                }
                Err(StepError::StagesNotConverged { .. } | StepError::TooLong { .. }) => counts[3] += 1,
                Err(error) => panic!("{sample}: {error}"),
            }
        }
        println!("{STAGES} stages: {counts:?}");
        counts
    }
    // Measured: 367 steps, 67 passes, none far off; of eight stages 380, 106 and 5, whose stages are smooth. In 20 000 samples
    // 0 and 48 are far off; with iterations that may begin beyond the turn 141 and 232 were.
    for ([solved, passes, lost, _], most) in [(passes::<4>(), 0), (passes::<8>(), 5)] {
        assert!(solved > 300 && passes < 130 && lost <= most, "{solved}, {passes}, {lost}");
    }
}

/// The stages of a velocity that grows as t², t³ or faster are not resolved, however short the step.
#[test]
fn velocities_grow_slowly_from_rest() {
    for h in [1e-6, 1e-3, 0.1, 0.4] {
        let mut run = Ramp::default().at(0.0, [1.2, 0.0], [0.0, 0.0]).integrate(Gauss::<4>, h).expect("a start");
        let momentum = run.step().expect("a step").p.y;
        // Measured: 1 ε.
        assert!((momentum / (h * h / 2.0) - 1.0).abs() < 4.0 * f64::EPSILON, "{h}: {momentum:e}");
    }
    let start = Coupled::default().at(0.0, [1.0, 1.0, core::f64::consts::FRAC_PI_2], [0.0; 3]);
    let four = start.integrate(Gauss::<4>, 0.1).expect("a start").step().expect("a step");
    let eight = start.integrate(Gauss::<8>, 0.1).expect("a start").step().expect("a step");
    let off = (four.q - eight.q).norm();
    println!("{off:e}");
    // Measured: 8e-15.
    assert!(off < 1e-14, "{off:e}");
}

/// At first the only velocity is a subnormal number. The impulse is that of the whole pulse.
#[test]
fn a_pulse_begins_below_normal_numbers() {
    let start = Late::default().at(0.0, [1.0, 0.0], [0.0, 0.0]);
    let impulse = (core::f64::consts::PI / 20.0).sqrt();
    for h in [0.01, 0.05] {
        let end = start.integrate(Gauss::<4>, h).expect("a start").until(12.0).expect("steps");
        let off = (end.p.y - impulse).abs();
        println!("{h}: {off:e}");
        // Measured: 0.
        assert!(off < 1e-15, "{h}: {off:e}");
    }
}
