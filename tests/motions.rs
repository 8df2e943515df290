//! Systems and motions that other programs computed wrongly, according to their issue reports: against DOP853 of scipy
//! with tolerance 1e-14, the other program, or a hand calculation. The systems are [`Called`], which compiles faster.

use vi_core::derivatives::{Tangent, Variation};
use vi_core::stepping::FixedStepping;
use vi_core::{
    Called, Composition, FixedStep, Gauss, Lagrangian, Method, Run, SVector, Starts, State, StepError, lagrangian,
};

/// Asserts the state of a run, and returns the largest difference of a coordinate or a velocity.
fn off<const N: usize, M: Method<S, N>, S: Lagrangian<N> + Copy>(
    mut run: Run<M, S, N>,
    t: f64,
    q: [f64; N],
    v: [f64; N],
) -> f64 {
    let end = run.until(t).expect("solvable");
    let velocity = run.velocity().expect("regular");
    (end.q - SVector::from(q)).amax().max((velocity - SVector::from(v)).amax())
}

/// The run of a system with Gauss steps of order 16.
macro_rules! gauss {
    ($system:expr, $q:expr, $v:expr, $h:expr) => {{
        let system = $system;
        Called(system).at_state(State::at(&system, 0.0, $q, $v)).integrate(Gauss::<8>, $h).expect("valid")
    }};
}

lagrangian! {
    /// A position-dependent mass (Mathews and Lakshmanan).
    struct Mathews {
        param ω = 1.0, λ = 1.0;
        coord q;
        L = (dot(q)^2 - ω^2 * q^2) / (2 * (1 + λ * q^2));
        discretize midpoint;
    }
}

lagrangian! {
    /// L with a term linear in the velocity, which affects only the momentum.
    struct Perturbed {
        param ω = 0.5, ε = 0.5, δ = pi / 3;
        coord q;
        let A = 0.3 * ε * sin(2 * δ) + 0.7 * ε * sin(3 * δ);
        L = dot(q)^2 / 2 + ω^2 * cos(q) + q * dot(q) * A + q^2 * A^2 / 2;
        discretize midpoint;
    }
}

lagrangian! {
    /// A pendulum with a horizontally driven pivot.
    struct Driven {
        param M = 0.1, b = 0.2, a = 0.3, om = 0.4, g = 0.5;
        coord x;
        L = 0.5 * M * b^2 * dot(x)^2 + M * b * dot(x) * a * om * cos(x) * cos(om * t)
            + 0.5 * M * a^2 * om^2 * cos(om * t)^2 + M * g * b * cos(x);
        discretize midpoint;
    }
}

lagrangian! {
    /// Dust around the sun, braked by its light (Poynting and Robertson).
    struct Dust {
        param mu = 39.478758435, beta = 0.1153812, c = 63241.3;
        coord x, y;
        let r2 = x^2 + y^2, k = beta * mu / c / r2, radial = (x * dot(x) + y * dot(y)) / r2;
        L = (dot(x)^2 + dot(y)^2) / 2 + (1 - beta) * mu / sqrt(r2);
        force x = -k * (dot(x) + x * radial), y = -k * (dot(y) + y * radial);
        discretize midpoint;
    }
}

lagrangian! {
    /// Two bodies that radiate gravitational waves.
    struct Inspiral {
        const nu = 1/4, M = 1;
        coord x, y;
        let r2 = x^2 + y^2, r = sqrt(r2), v2 = dot(x)^2 + dot(y)^2, vq = x * dot(x) + y * dot(y);
        let along_v = nu^2 * (16/5 * M^4 / r2^2 - 48/5 * M^3 * v2 / r^3 + 24 * M^3 * vq^2 / r^5);
        let along_q = nu^2 * (16/15 * M^4 * vq / r^6 + 144/5 * M^3 * v2 * vq / r^5 - 40 * M^3 * vq^3 / r^7);
        L = nu * M * v2 / 2 + nu * M^2 / r;
        force x = along_v * dot(x) + along_q * x, y = along_v * dot(y) + along_q * y;
        discretize midpoint;
    }
}

lagrangian! {
    /// Two pendulums joined by a damped spring.
    struct Joined {
        param k = 20.0, rest = 1.0, c = 1.0, g = 9.8;
        coord a, b;
        let y1 = -2 * sin(a), z1 = 2 * cos(a), y2 = 1 - 2 * sin(b), z2 = 2 * cos(b);
        let length = hypot(y2 - y1, z2 - z1);
        L = (dot(y1)^2 + dot(z1)^2 + dot(y2)^2 + dot(z2)^2) / 2 - g * (z1 + z2) - k * (length - rest)^2 / 2;
        dissipation = c * dot(length)^2 / 2;
        discretize midpoint;
    }
}

lagrangian! {
    /// A pendulum on a cart with drive and brake.
    struct Cart {
        param M = 10.0, m = 1.0, l = 1.0, g = 9.8, c = 0.01;
        coord x, θ;
        let px = x + l * sin(θ), py = -l * cos(θ);
        L = M * dot(x)^2 / 2 + m * (dot(px)^2 + dot(py)^2) / 2 - m * g * py;
        dissipation = c * (dot(x)^2 + dot(θ)^2) / 2;
        force x = 3 * sin(t);
        discretize midpoint;
    }
}

#[test]
fn motions_of_other_programs_are_followed() {
    let start = State { t: 0.0, q: SVector::from([0.5]), p: SVector::from([0.0]) };
    let perturbed = Perturbed::default().at_state(start).integrate(Gauss::<8>, 0.25).expect("valid");
    let joined = [3.136_949_984_228_409, -3.136_949_984_228_409];
    let inspiral = [-0.000_118_518_518_518_518_52, 0.182_574_185_835_055_36];
    let errors = [
        off(
            gauss!(Mathews::default(), [0.5], [0.0], 0.25),
            20.0,
            [0.286_345_293_711_687_9],
            [0.366_613_008_791_739_36],
        ),
        off(perturbed, 10.0, [0.153_752_011_169_661_22], [0.236_028_285_702_153_78]),
        off(
            gauss!(Driven::default(), [0.1], [0.2], 0.25),
            10.0,
            [-0.186_951_981_683_141_12],
            [-0.168_981_720_116_966_6],
        ),
        off(
            gauss!(Joined::default(), [3.0, -3.0], [0.0, 0.0], 0.05),
            3.0,
            joined,
            [0.040_541_497_825_409_82, -0.040_541_497_825_409_82],
        ),
        off(
            gauss!(Cart::default(), [0.0, 2.0], [0.0, 0.5], 0.1),
            5.0,
            [1.519_247_989_370_356_5, 1.584_496_589_309_372_3],
            [0.178_473_350_269_423, 2.734_289_167_174_966_5],
        ),
        off(
            gauss!(Inspiral::default(), [30.0, 0.0], inspiral, 50.0),
            8000.0,
            [27.218_108_691_404_446, -10.018_217_448_149_473],
            [0.064_015_530_794_006_67, 0.174_301_134_813_067_36],
        ),
    ];
    // Measured 3.6e-15, 1.3e-15, 5.1e-15, 5.0e-15, 4.0e-14, 1.05e-12: the reference is approximate too.
    let tolerances = [1e-14, 5e-15, 2e-14, 2e-14, 1e-13, 3e-12];
    assert!(errors.iter().zip(tolerances).all(|(error, tolerance)| *error < tolerance), "{errors:?}");
    let dust = [[0.276_043_081_936_918_84, -0.858_884_866_231_848_3], [5.750_744_757_654_875, 3.052_021_626_838_209]];
    let error = off(gauss!(Dust::default(), [0.8, 0.0], [0.0, 7.237_781_280_778_617], 0.02), 20.0, dust[0], dust[1]);
    // Measured 1.6e-10, also with steps in transformed time: the error of the reference.
    assert!(error < 2e-10, "{error:e}");
}

lagrangian! {
    /// A hub with four masses on springs along its spokes, from a test of heyoka.
    struct Wheel {
        const N = 4;
        param k = 5.0, fc = 0.1, m0 = 10.0, m = 0.05, a = 1.0;
        coord x0, y0, alpha, l[N];
        let x[i in 0..N] = x0 + (a - l[i]) * cos(alpha + i * 2 * pi / N);
        let y[i in 0..N] = y0 + (a - l[i]) * sin(alpha + i * 2 * pi / N);
        L = m0 * (dot(x0)^2 + dot(y0)^2) / 2 + sum(i in 0..N, m * (dot(x[i])^2 + dot(y[i])^2)) / 2
            - k * sum(i in 0..N, l[i]^2) / 2;
        dissipation = fc * sum(i in 0..N, dot(l[i])^2) / 2;
        discretize midpoint;
    }
}

#[test]
fn a_wheel_moves_as_sympy_has_it() {
    let v = [
        -0.425_133_036_329_320_3,
        0.058_149_733_785_057_72,
        0.442_141_896_498_742_7,
        0.382_113_528_059_325_4,
        0.403_531_944_946_593_7,
        0.473_483_299_702_404,
        -0.322_959_779_176_105_63,
    ];
    let q_end = [
        -1.274_038_299_537_64,
        0.163_763_618_013_590_88,
        1.323_428_337_349_071,
        -0.003_835_262_567_108_764_3,
        -0.003_878_514_761_545_683_3,
        -0.004_319_076_923_234_549,
        -0.000_395_131_823_073_909_7,
    ];
    let v_end = [
        -0.424_722_481_809_496_8,
        0.054_600_061_355_486_61,
        0.439_406_101_879_129_6,
        0.003_381_629_943_640_583,
        0.006_350_901_803_721_282,
        0.004_490_453_710_403_928,
        -0.001_398_805_268_185_932_8,
    ];
    let error = off(gauss!(Wheel::default(), [0.0; 7], v, 0.05), 3.0, q_end, v_end);
    // Measured 2.2e-16.
    assert!(error < 5e-16, "{error:e}");
}

lagrangian! {
    /// Two links, with two rules.
    struct Arm {
        param m1 = 1.5, m2 = 0.8, l1 = 0.9, c1 = 0.4, c2 = 0.35, I1 = 0.1, I2 = 0.05, g = 9.81;
        coord a, b;
        let x1 = c1 * cos(a), y1 = c1 * sin(a);
        let x2 = l1 * cos(a) + c2 * cos(a + b), y2 = l1 * sin(a) + c2 * sin(a + b);
        L = m1 * (dot(x1)^2 + dot(y1)^2) / 2 + I1 * dot(a)^2 / 2 + m2 * (dot(x2)^2 + dot(y2)^2) / 2
            + I2 * (dot(a) + dot(b))^2 / 2 - g * (m1 * y1 + m2 * y2);
        discretize midpoint;
    }
}

/// Largest energy error of fixed steps, relative.
fn energy_error<S: FixedStepping<N>, const N: usize>(
    system: S,
    states: impl Iterator<Item = Result<State<N>, StepError>>,
    start: f64,
) -> f64 {
    states.fold(0.0, |worst: f64, state| {
        let energy = state.and_then(|state| state.energy(&system)).expect("solvable");
        worst.max((energy / start - 1.0).abs())
    })
}

#[test]
fn an_arm_is_that_of_the_textbook() {
    let arm = Arm::default();
    let (q, v) = (SVector::from([0.4, -1.1]), SVector::from([0.7, 1.3]));
    let a = arm.acceleration(0.0, &q, &v).expect("regular");
    let by_hand = (a - SVector::from([-12.545_891_792_163_182, 8.784_076_013_030_78])).amax();
    let error = off(
        gauss!(arm, [0.4, -1.1], [0.7, 1.3], 0.025),
        2.0,
        [-1.385_076_614_680_379_5, 0.206_547_715_385_197_34],
        [2.614_895_454_471_694, 8.301_133_086_138_856],
    );
    // The acrobot of a collection of games, at a step for which its own integrator increases the energy.
    let acrobot = Arm { m1: 1.0, m2: 1.0, l1: 1.0, c1: 0.5, c2: 0.5, I1: 1.0, I2: 1.0, g: 9.8 };
    let start = State::at(&acrobot, 0.0, [-1.0, 0.5], [0.1, 0.0]);
    let steps = acrobot.at_state(start).integrate(Gauss::<8>, 0.2).expect("valid").take(500);
    let energy = energy_error(acrobot, steps, start.energy(&acrobot).expect("regular"));
    // Measured 3.6e-15, 5.3e-15, 7.1e-15.
    assert!(by_hand < 5e-15 && error < 1e-14 && energy < 1e-14, "{by_hand:e} {error:e} {energy:e}");
}

lagrangian! {
    /// Two links with very different masses.
    struct Double {
        param m1 = 40.0, m2 = 40.0, l1 = 200.0, l2 = 200.0, g = 1.0;
        coord a, b;
        let x1 = l1 * sin(a), y1 = -l1 * cos(a), x2 = x1 + l2 * sin(b), y2 = y1 - l2 * cos(b);
        L = m1 * (dot(x1)^2 + dot(y1)^2) / 2 + m2 * (dot(x2)^2 + dot(y2)^2) / 2 - g * (m1 * y1 + m2 * y2);
        discretize midpoint;
    }
}

#[test]
fn double_pendulums_gain_no_energy() {
    let drawn = Double::default();
    let end = (
        [-0.009_914_741_246_123_474, -1.466_322_113_993_030_3],
        [0.009_584_573_638_737_67, -0.008_393_444_811_862_563],
    );
    let first = off(gauss!(drawn, [1.0, 0.0], [0.0, 0.0], 2.0), 60.0, end.0, end.1);
    // One short link and one long link, near the top.
    let short = Double { m1: 1.0, m2: 1.0, l1: 0.02, l2: 0.5, g: 9.81 };
    let end = ([-2.498_713_066_097_63, -0.732_882_713_666_877_6], [0.957_380_760_233_732_6, 7.714_102_019_703_501_5]);
    let second = off(gauss!(short, [2.0, -2.5], [0.0, 0.0], 0.01), 0.5, end.0, end.1);
    // A link of nearly no mass.
    let light = Double { m1: 1e-6, m2: 1000.0, l1: 0.5, l2: 0.5, g: 9.81 };
    let energies =
        [(drawn, [1.0, 0.0], 1.0), (short, [2.0, -2.5], 1e-3), (light, [0.3, 0.3], 1e-3)].map(|(system, q, h)| {
            let start = State::at(&system, 0.0, q, [0.0, 0.0]);
            let steps = system.at_state(start).integrate(FixedStep, h).expect("valid").take(20_000);
            energy_error(system, steps, start.energy(&system).expect("regular"))
        });
    // Measured 1.5e-14, and 1.4e-10 for a motion that diverges from its neighbours.
    assert!(first < 3e-14 && second < 2e-10, "{first:e} {second:e}");
    // Measured 8.0e-4, 5.9e-4, 2.3e-8.
    let bounds = [1e-3, 7e-4, 3e-8];
    assert!(energies.iter().zip(bounds).all(|(error, bound)| *error < bound), "{energies:?}");
}

lagrangian! {
    /// An oscillator with any damping.
    struct Damped {
        param m = 1.0, k = 1.0, c = 0.1;
        coord x;
        L = m * dot(x)^2 / 2 - k * x^2 / 2;
        force x = -c * dot(x);
        discretize midpoint;
    }
}

#[test]
fn damping_of_many_turns_a_step_is_no_obstacle() {
    // c h = 100 and 1000, for which explicit steps diverge: x falls as exp(−t k/c).
    let damped = Damped { m: 1.0, k: 1e4, c: 1e4 };
    let start = State::at(&damped, 0.0, [1.0], [0.0]);
    let fixed = |t: f64| {
        damped.at_state(start).integrate(FixedStep, 0.01).and_then(|mut run| run.until(t)).expect("solvable").q[0]
    };
    let gauss =
        damped.at_state(start).integrate(Gauss::<4>, 0.1).and_then(|mut run| run.until(5.0)).expect("solvable").q[0];
    let exact = [0.367_879_443_011_698_3, 0.006_735_251_853_986_8];
    let errors = [fixed(1.0) - exact[0], fixed(5.0) - exact[1], gauss - exact[1]];
    // Measured 4.9e-6, 2.8e-7, 1.4e-5.
    let tolerances = [6e-6, 3e-7, 2e-5];
    assert!(errors.iter().zip(tolerances).all(|(error, tolerance)| error.abs() < tolerance), "{errors:?}");
}

lagrangian! {
    /// Forces of every kind, in every coordinate.
    struct Several {
        coord x, y, z;
        L = (dot(x)^2 + 2 * dot(y)^2 + 3 * dot(z)^2) / 2;
        force x = 1 - dot(x) + y, y = 2 * sin(t) - x, z = -dot(z) * abs(dot(z)) + x * y;
        dissipation = (dot(x) - dot(y))^2 / 2 + dot(z)^2;
        discretize midpoint;
    }
}

#[test]
fn each_force_counts_in_its_coordinate() {
    let (t, q, v) = (0.7_f64, SVector::from([0.3, -0.2, 0.5]), SVector::from([1.1, 0.4, -0.6]));
    let by_hand = [1.0 - 1.1 - 0.2 - (1.1 - 0.4), 2.0 * t.sin() - 0.3 + (1.1 - 0.4), 0.36 - 0.06 + 1.2];
    let error = (Several::default().force(t, &q, &v) - SVector::from(by_hand)).amax();
    // Measured 2.2e-16.
    assert!(error < 5e-16, "{error:e}");
}

lagrangian! {
    /// An oscillator with an input that is switched off.
    struct Pushed {
        param u = 1.0;
        coord x;
        L = dot(x)^2 / 2 - x^2 / 2;
        force x = u - dot(x);
        discretize midpoint;
    }
}

lagrangian! {
    /// The same, with the switch at t = 5 in the formula.
    struct Switched {
        coord x;
        L = dot(x)^2 / 2 - x^2 / 2;
        force x = (1 - sign(t - 5)) / 2 - dot(x);
        discretize midpoint;
    }
}

lagrangian! {
    /// A square wave.
    struct Wave {
        coord x;
        L = dot(x)^2 / 2 - x^2 / 2;
        force x = sign(sin(pi * t)) - 0.2 * dot(x);
        discretize midpoint;
    }
}

#[test]
fn inputs_that_switch_where_a_step_ends_cost_no_order() {
    let mut run = gauss!(Pushed::default(), [0.0], [0.0], 0.3);
    let at_five = off(run.clone(), 5.0, [1.074_590_566_595_030_6], [-0.087_942_420_732_510_02]);
    run.until(5.0).expect("solvable");
    run.set_parameters(|system| system.0.u = 0.0).expect("regular");
    let end = ([0.028_225_824_654_361_884], [0.005_286_720_976_763_788]);
    let errors = [
        at_five,
        off(run, 12.0, end.0, end.1),
        off(gauss!(Switched::default(), [0.0], [0.0], 0.25), 12.0, end.0, end.1),
        off(
            gauss!(Wave::default(), [0.1], [0.0], 0.125),
            6.0,
            [-0.047_028_597_642_654_685],
            [-0.232_002_936_762_605_78],
        ),
    ];
    // If no step ends at the switch, order 1 remains.
    let start = State::at(&Switched::default(), 0.0, [0.0], [0.0]);
    let missed = Switched::default().at_state(start).integrate(FixedStep, 0.0037).and_then(|mut run| run.until(12.0));
    let missed = (missed.expect("solvable").q[0] - end.0[0]).abs();
    // Measured 2.8e-15, 8.3e-16, 8.3e-16, 9.9e-16, and 1.0e-5.
    assert!(errors.iter().all(|error| *error < 4e-15) && missed < 2e-5, "{errors:?} {missed:e}");
}

#[test]
fn a_close_passage_is_followed_backwards() {
    let kepler = vi_systems::Kepler::default();
    let start = State::at(&kepler, 3.0, [0.1, 0.0], [0.0, 19.0_f64.sqrt()]);
    let tau = core::f64::consts::TAU;
    let two = kepler.at_state(start).integrate(Gauss::<8>, -0.02).and_then(|mut run| run.until(3.0 - 2.0 * tau));
    let one =
        kepler.at_state(start).integrate(Composition::KAHAN_LI_8, -0.005).and_then(|mut run| run.until(3.0 - tau));
    let errors = [two, one].map(|end| (end.expect("solvable").q - start.q).amax());
    // Measured 4.3e-10, 4.2e-8.
    assert!(errors[0] < 5e-10 && errors[1] < 5e-8, "{errors:?}");
}

lagrangian! {
    /// A power that is a parameter.
    struct Power {
        param n = 2.0;
        coord x;
        L = dot(x)^2 / 2 - x^n;
        discretize midpoint;
    }
}

#[test]
fn the_variation_with_respect_to_a_power_is_finite_or_told() {
    // From x = 0, at which the derivative of x^n with respect to n is 0 · ∞ with a limit.
    let start = State::at(&Power::default(), 0.0, [0.0], [1.0]);
    let run = Power::default().at_state(start).integrate(Gauss::<4>, 0.1).expect("valid");
    let mut tangent = Tangent::new(run, vec![Variation::of_parameter::<Power>("n").expect("a parameter")]);
    let mut reported = None;
    for _ in 0..30 {
        if let Err(error) = tangent.step() {
            reported = Some(error);
            break;
        }
        let Variation { q, p, .. } = &tangent.variations()[0];
        assert!(q[0].is_finite() && p[0].is_finite());
    }
    // For negative x, x^n has a value but no derivative with respect to n.
    assert!(tangent.run().state().t > 2.0, "the motion comes back to x = 0");
    assert!(matches!(reported, Some(StepError::NonFinite { .. })), "{reported:?}");
}

lagrangian! {
    /// A geodesic about a black hole: the mass matrix has both signs.
    struct Geodesic {
        param M = 1.0;
        coord T, r, φ;
        let lapse = 1 - 2 * M / r;
        L = (-lapse * dot(T)^2 + dot(r)^2 / lapse + r^2 * dot(φ)^2) / 2;
        discretize midpoint;
        check { r = 10.0, φ = 0.3, dot(T) = 1.204, dot(r) = 0.05, dot(φ) = 0.04; h = 0.3; }
    }
}
