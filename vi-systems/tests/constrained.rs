//! Systems with constraints move as the same mechanics does by independent equations: in angles, in closed form, by
//! published numbers.

use vi_core::lagrangian::Space;
use vi_core::nalgebra::Vector3;
use vi_core::prelude::*;
use vi_core::stepping::Convertible;
use vi_core::{Lagrangian as _, SVector};
use vi_systems::{
    AndrewsSqueezer, ChaplyginSleigh, DoublePendulum, DoubleRodPendulum, FourBar, HeavyTop, Pendulum, RodChain,
    RodPendulum, RollingBall, RollingDisk, SliderCrank,
};

/// The largest difference of two vectors.
fn apart<const N: usize>(found: impl Into<SVector<f64, N>>, wanted: impl Into<SVector<f64, N>>) -> f64 {
    (found.into() - wanted.into()).amax()
}

/// Coordinates and velocities at the time `end`, by steps of order 6 with constraints.
fn constrained<S, const N: usize>(system: S, (q, v): ([f64; N], [f64; N]), h: f64, end: f64) -> [SVector<f64, N>; 2]
where
    S: Convertible<N>,
{
    let mut run = system.at(0.0, q, v).integrate(Gauss::<3>, h).unwrap_or_else(|error| panic!("{error}"));
    let state = run.until(end).unwrap_or_else(|error| panic!("{error}"));
    [state.q, state.velocity(&system).unwrap_or_else(|error| panic!("{error}"))]
}

/// Coordinates at the time `end`, by Gauss steps of 8 stages without constraints.
fn free<S, const N: usize>(system: S, (q, v): ([f64; N], [f64; N]), h: f64, end: f64) -> [f64; N]
where
    S: vi_core::motion::Motion<N> + vi_core::stepping::Convertible<N>,
{
    let mut run = system.at(0.0, q, v).integrate(Gauss::<8>, h).unwrap_or_else(|error| panic!("{error}"));
    run.until(end).unwrap_or_else(|error| panic!("{error}")).q.into()
}

/// Every start is on the constraints to rounding, and a run begins there, whatever the parameters are.
#[test]
fn starts_are_consistent_for_all_parameters() {
    fn check<S, const N: usize>(start: fn(&S) -> ([f64; N], [f64; N]))
    where
        S: Convertible<N> + vi_core::lagrangian::Parameters + Default,
    {
        let mut seed = 1_u32;
        for round in 0..20 {
            let mut system = S::default();
            for name in S::PARAMETERS {
                seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                let part = f64::from(seed >> 8) / f64::from(1 << 24);
                // Up to 2 per cent, so that linkages still close.
                *system.parameter_mut(name).expect("a parameter") *= 1.0 + f64::from(round.min(1)) * 0.02 * part;
            }
            let (q, v) = start(&system);
            let projected = State::projected(&system, 0.0, q, v).unwrap_or_else(|error| panic!("{}: {error}", S::NAME));
            // Measured: at most 8.9e-16 and 7.2e-16.
            let (moved_q, moved_v) = (projected.moved_q.amax(), projected.moved_v.amax());
            assert!(moved_q < 2e-15 && moved_v < 2e-15, "{}: {moved_q:e} {moved_v:e}", S::NAME);
            let run = system.at(0.0, q, v).integrate(Gauss::<1>, 1e-5);
            run.and_then(|mut run| run.step()).unwrap_or_else(|error| panic!("{}, {round}: {error}", S::NAME));
        }
    }
    check(AndrewsSqueezer::start);
    check(ChaplyginSleigh::start);
    check(DoubleRodPendulum::start);
    check(FourBar::start);
    check(HeavyTop::start);
    check(RodChain::start);
    check(RodPendulum::start);
    check(RollingBall::start);
    check(RollingDisk::start);
    check(SliderCrank::start);
}

#[test]
fn lengths_that_do_not_close_are_refused() {
    let short = FourBar { b: 0.2, c: 0.3, ..FourBar::default() };
    let (q, v) = short.start();
    let failure = short.at(0.0, q, v).integrate(Gauss::<3>, 0.01).err();
    assert!(matches!(failure, Some(StepError::InconsistentStart { .. })), "{failure:?}");
    let wide = AndrewsSqueezer { xa: -0.5, ..AndrewsSqueezer::default() };
    let (q, v) = wide.start();
    let failure = wide.at(0.0, q, v).integrate(Gauss::<3>, 1e-5).err();
    assert!(matches!(failure, Some(StepError::InconsistentStart { .. })), "{failure:?}");
}

#[test]
fn pendula_move_as_in_their_angles() {
    let system = RodPendulum { m: 1.3, l: 0.8, g: 9.0 };
    let [found, _] = constrained(system, system.start(), 0.005, 2.0);
    let [angle] = free(Pendulum { m: 1.3, l: 0.8, g: 9.0 }, ([1.0], [0.0]), 0.05, 2.0);
    let error = apart(found, [0.8 * angle.sin(), -0.8 * angle.cos()]);
    println!("{error:e}");
    // Measured: 3.9e-16.
    assert!(error < 2e-15, "{error:e}");

    let system = DoubleRodPendulum { m1: 1.3, m2: 0.8, l1: 0.9, l2: 1.1, g: 9.0 };
    let [found, _] = constrained(system, system.start(), 0.002, 2.0);
    let angles = DoublePendulum { m1: 1.3, m2: 0.8, l1: 0.9, l2: 1.1, g: 9.0 };
    let [a, b] = free(angles, ([1.0, 1.0], [0.0, 0.0]), 0.01, 2.0);
    let [x, y] = [0.9 * a.sin(), -0.9 * a.cos()];
    let error = apart(found, [x, y, x + 1.1 * b.sin(), y - 1.1 * b.cos()]);
    println!("{error:e}");
    // Measured: 7.5e-16.
    assert!(error < 4e-15, "{error:e}");
}

lagrangian! {
    /// The chain of rods in angles, as `NPendulum` with ten links.
    struct ChainInAngles {
        const N = 10;
        param m = 1.0, l = 1.0, g = 9.81;
        coord θ[N];
        let alone = sum(i in 0..N, (N - i) * dot(θ[i])^2) / 2;
        let pairs = sum(i in 1..N, (N - i) * sum(j in 0..i, dot(θ[i]) * dot(θ[j]) * cos(θ[i] - θ[j])));
        L = m * l^2 * (alone + pairs) + m * g * l * sum(i in 0..N, (N - i) * cos(θ[i]));
    }
}

#[test]
fn a_chain_moves_as_in_its_angles() {
    let system = RodChain::default();
    let [found, _] = constrained(system, system.start(), 0.005, 1.0);
    let angles = free(ChainInAngles::default(), ([1.0; 10], [0.0; 10]), 0.02, 1.0);
    let mut end = [0.0, 0.0];
    let error = (0..10).fold(0.0_f64, |worst, i| {
        end = [end[0] + angles[i].sin(), end[1] - angles[i].cos()];
        worst.max((found[2 * i] - end[0]).abs()).max((found[2 * i + 1] - end[1]).abs())
    });
    println!("{error:e}");
    // Measured: 9.0e-13.
    assert!(error < 5e-12, "{error:e}");
}

lagrangian! {
    /// The slider-crank in the angle of its crank: the loop is solved by hand.
    struct CrankAlone {
        param r = 1.0, l = 2.5, J = 2.0, m = 0.5, M = 1.0, k = 5.0;
        coord θ;
        let height = r * sin(θ), base = sqrt(l^2 - height^2);
        let x = r * cos(θ) + base, φ = -asin(height / l);
        let centre = [r * cos(θ) + base / 2, height / 2];
        L = J * dot(θ)^2 / 2 + m * dot(centre) * dot(centre) / 2 + m * l^2 * dot(φ)^2 / 24 + M * dot(x)^2 / 2
            - k * (x - r - l)^2 / 2;
    }
}

lagrangian! {
    /// The four-bar linkage in the angle of its crank: the second joint is the intersection of two circles.
    struct FourBarAlone {
        param a = 1.0, b = 3.0, c = 2.5, d = 3.0, density = 1.0, g = 9.81;
        coord θ;
        let p = [a * cos(θ), a * sin(θ)];
        let line = [d - p[0], -p[1]];
        let distance = norm(line);
        let along = (b^2 - c^2 + distance^2) / (2 * distance);
        let across = sqrt(b^2 - along^2);
        let q = [p[0] + (along * line[0] - across * line[1]) / distance, p[1] + (along * line[1] + across * line[0]) / distance];
        let kinetic = (a + b) * dot(p) * dot(p) + b * dot(p) * dot(q) + (b + c) * dot(q) * dot(q);
        L = density * kinetic / 6 - density * g * ((a + b) * p[1] + (b + c) * q[1]) / 2;
    }
}

#[test]
fn linkages_move_as_in_the_angle_of_their_crank() {
    let system = SliderCrank::default();
    let [found, _] = constrained(system, system.start(), 0.005, 2.0);
    let [crank] = free(CrankAlone::default(), ([0.0], [4.0]), 0.02, 2.0);
    let height = crank.sin();
    let error = apart(found, [crank, -(height / 2.5).asin(), crank.cos() + (6.25 - height * height).sqrt()]);
    println!("{error:e}");
    // Measured: 3.8e-13.
    assert!(error < 2e-12, "{error:e}");

    let system = FourBar::default();
    let [found, _] = constrained(system, system.start(), 0.002, 2.0);
    let [crank] = free(FourBarAlone::default(), ([core::f64::consts::FRAC_PI_2], [6.0]), 0.01, 2.0);
    let error = apart([found[0], found[1]], [crank.cos(), crank.sin()]);
    println!("{error:e}");
    // Measured: 1.3e-11, the error of the steps: 3.2e-9 with steps of 0.005.
    assert!(error < 5e-11, "{error:e}");
}

lagrangian! {
    /// The heavy top in Euler's angles: precession φ, inclination θ, spin ψ.
    struct TopInAngles {
        param m = 1.0, l = 0.3, J1 = 0.12, J3 = 0.05, g = 9.81;
        coord φ, θ, ψ;
        let across = dot(θ)^2 + dot(φ)^2 * sin(θ)^2, along = dot(ψ) + dot(φ) * cos(θ);
        L = (J1 * across + J3 * along^2) / 2 - m * g * l * cos(θ);
    }
}

#[test]
fn a_top_moves_as_in_eulers_angles() {
    let system = HeavyTop::default();
    let [r, _] = constrained(system, system.start(), 0.001, 1.0);
    let [φ, θ, ψ] = free(TopInAngles::default(), ([0.0, 0.5, 0.0], [0.0, 0.0, 30.0]), 0.01, 1.0);
    // The rotation about z by φ, then x by θ, then z by ψ.
    let (half, sum, difference) = (θ / 2.0, f64::midpoint(φ, ψ), (φ - ψ) / 2.0);
    let wanted =
        [half.cos() * sum.cos(), half.sin() * difference.cos(), half.sin() * difference.sin(), half.cos() * sum.sin()];
    let error = apart(r, wanted);
    println!("{error:e}");
    // Measured: 1.6e-14.
    assert!(error < 1e-13, "{error:e}");
}

#[test]
fn a_system_knows_the_orientations_of_its_bodies() {
    let spaces = RollingBall::default().spaces();
    let rotation = [0, 1, 2, 3].map(Space::Rotation);
    assert_eq!(spaces[..2], [Space::Line; 2]);
    assert_eq!(spaces[2..], rotation);
    assert_eq!(HeavyTop::<f64>::SPACES, rotation);
    let state = State { t: 0.0, q: [3.0, -4.0, 0.48, 0.6, 0.0, 0.64].into(), p: SVector::zeros() };
    let bodies: Vec<_> = state.orientations(&RollingBall::default()).collect();
    let [body] = bodies[..] else { panic!("{bodies:?}") };
    // By Rodrigues' formula: the angle φ about the unit vector n.
    let (φ, n) = (2.0 * 0.48_f64.acos(), [0.6, 0.0, 0.64].map(|entry| entry / (1.0 - 0.48_f64.powi(2)).sqrt()));
    let (n, r) = (Vector3::from(n), Vector3::new(0.3, -1.1, 0.7));
    let wanted = r * φ.cos() + n.cross(&r) * φ.sin() + n * (n.dot(&r) * (1.0 - φ.cos()));
    let error = (body * r - wanted).amax();
    println!("{error:e}");
    // Measured: 2.2e-16.
    assert!(error < 2e-15, "{error:e}");
    let of_angles = State { t: 0.0, q: SVector::repeat(0.1), p: SVector::zeros() };
    assert_eq!(of_angles.orientations(&ChaplyginSleigh::default()).count(), 0);
}

#[test]
fn a_sleigh_ends_straight_and_conserves_its_energy() {
    // With u = x' cos θ + y' sin θ and ω = θ': u' = a ω², (J + m a²) ω' = −m a u ω. So with κ² = (J + m a²)/m the sum
    // u² + κ² ω² is constant, E²; u = E tanh(a E (t − t0)/κ²), ω = (E/κ)/cosh(…).
    let system = ChaplyginSleigh::default();
    let [q, v] = constrained(system, system.start(), 0.01, 1.0);
    let κ2 = 1.25_f64;
    let total = (1.0 + κ2 * 4.0_f64).sqrt();
    let phase = (1.0 / total).atanh() + 0.5 * total / κ2;
    let (u, ω) = (v[0] * q[2].cos() + v[1] * q[2].sin(), v[2]);
    let error = (u - total * phase.tanh()).abs().max((ω - total / κ2.sqrt() / phase.cosh()).abs());
    println!("{error:e}");
    // Measured: 2.2e-14.
    assert!(error < 2e-13, "{error:e}");
}

#[test]
fn a_ball_on_a_turntable_runs_in_a_circle() {
    let system = RollingBall { m: 1.3, r: 0.4, Ω: 3.0 };
    let [q, v] = constrained(system, system.start(), 0.01, 2.0);
    // With the rate ω = 2 Ω/7 about the centre (1 − 1/(2 ω), 0).
    let ω = 6.0 / 7.0_f64;
    let (sin, cos) = (ω * 2.0).sin_cos();
    let radius = 0.5 / ω;
    let error = apart([q[0], q[1]], [1.0 - radius + radius * cos, radius * sin]);
    let of_velocity = apart([v[0], v[1]], [-0.5 * sin, 0.5 * cos]);
    println!("{error:e} {of_velocity:e}");
    // Measured: 7.6e-14 and 6.6e-14.
    assert!(error < 4e-13 && of_velocity < 4e-13, "{error:e} {of_velocity:e}");
}

#[test]
fn a_disk_rolls_as_in_forty_digits() {
    // `rolling_disk` of tests/reference/constraints.json: 100 steps of two stages.
    let system = RollingDisk::default();
    let (q, v) = system.start();
    let mut run = system.at(0.0, q, v).integrate(Gauss::<2>, 0.02).unwrap_or_else(|error| panic!("{error}"));
    for _ in 0..100 {
        run.step().unwrap_or_else(|error| panic!("{error}"));
    }
    let wanted = [
        2.640_220_919_286_082_6,
        4.657_234_469_934_985,
        2.007_860_291_485_046_7,
        1.099_475_778_750_829_4,
        -6.613_187_730_267_55,
    ];
    let error = apart(run.state().q, wanted);
    println!("{error:e}");
    // Measured: 8.9e-16.
    assert!(error < 5e-15, "{error:e}");
}

lagrangian! {
    /// A pendulum in space that a second constraint keeps in the plane z = 0, with a mass matrix that couples z.
    struct InAPlane {
        param g = 9.81;
        coord x, y, z;
        L = (dot(x)^2 + dot(y)^2 + dot(z)^2 + dot(x) * dot(z)) / 2 - g * y;
        constraint plane = z;
        constraint rod = x^2 + y^2 + z^2 - 1;
    }
}

/// Rows whose terms are roundings of others, as those of z here, do not stop a run.
#[test]
fn motions_in_a_plane_and_near_rest_go_on() {
    let [found, _] = constrained(RodPendulum::default(), ([0.0, -1.0], [1e-18, 0.0]), 0.01, 5.0);
    assert!(found[0].abs() < 1e-18 && (found[1] + 1.0).abs() < 1e-15, "{found}");
    let start = State::projected(&InAPlane::default(), 0.0, [0.5, -0.9, 0.3], [1.0, 0.3, 0.2]);
    let start = start.unwrap_or_else(|error| panic!("{error}")).state;
    let mut run = InAPlane::default().at_state(start).integrate(Gauss::<3>, 0.01).expect("a start");
    let state = run.until(5.0).unwrap_or_else(|error| panic!("{error}"));
    // Measured: 0 and 1.1e-16.
    assert!(state.q[2].abs() < 1e-16 && (state.q.norm() - 1.0).abs() < 1e-15, "{}", state.q);
    let ball = RollingBall { Ω: 0.0, ..RollingBall::default() };
    let [found, _] = constrained(ball, ball.start(), 0.02, 100.0);
    assert!((found[0] - 1.0).abs() < 1e-15 && (found[1] - 50.0).abs() < 1e-12, "{found}");
}

/// The solution at t = 0.03 that the IVP test set publishes, and the one by scipy's DOP853 of its equations of index 1 with
/// tolerances of 1e-13.
#[test]
fn andrews_squeezer_ends_where_others_end() {
    let system = AndrewsSqueezer::default();
    let [found, _] = constrained(system, system.start(), 2.5e-5, 0.03);
    let published = [
        15.810_771_196_299_04,
        -15.756_371_059_842_98,
        0.040_822_240_130_731_01,
        -0.534_730_116_322_694_8,
        0.524_409_965_880_530_4,
        0.534_730_116_322_694_8,
        1.048_080_741_042_263,
    ];
    let computed = [
        15.810_771_195_153_92,
        -15.756_371_058_412_1,
        0.040_822_240_119_613_75,
        -0.534_730_116_342_139_6,
        0.524_409_965_879_949_6,
        0.534_730_116_342_134_1,
        1.048_080_741_041_94,
    ];
    let [of_test_set, of_scipy] = [apart(found, published), apart(found, computed)];
    println!("{of_test_set:e} {of_scipy:e}");
    // Measured: 1.4e-9, the error of the published numbers; 1.4e-13.
    assert!(of_test_set < 2e-9 && of_scipy < 1e-12, "{of_test_set:e} {of_scipy:e}");
}
