//! Mass matrix, bias, inverse dynamics, linearizations and equilibria against differences, closed forms, and a planar
//! arm in Pinocchio.

use crate::support::Sequence;
use crate::support::reference::{file, vector};
use crate::support::scenes::{Scene, each_system};
use core::f64::consts::PI;
use serde_json::Value;
use vi_core::control::Linearization;
use vi_core::nalgebra::{Complex, DMatrix, SMatrix};
use vi_core::prelude::*;
use vi_core::stepping::Convertible;
use vi_core::{Dynamics, Lagrangian, SVector};
use vi_systems::{DampedOscillator, DoublePendulum, Kepler, Pendulum};

/// Random states near each scene.
const DRAWS: u32 = 10;
/// Step of the differences.
const DELTA: f64 = 1e-5;
/// Relative error of identities; 1.9e-16 was measured.
const EXACT: f64 = 1e-15;
/// Relative error of differences; 5.8e-10 was measured.
const CLOSE: f64 = 5e-9;

/// The largest entry of a difference, relative to the larger matrix.
fn distance(found: &DMatrix<f64>, wanted: &DMatrix<f64>) -> f64 {
    assert_eq!(found.shape(), wanted.shape());
    (found - wanted).amax() / found.amax().max(wanted.amax()).max(f64::MIN_POSITIVE)
}

fn dense<const R: usize, const C: usize>(matrix: &SMatrix<f64, R, C>) -> DMatrix<f64> {
    DMatrix::from_fn(R, C, |i, j| matrix[(i, j)])
}

/// Central differences of a function of one number.
fn difference<const N: usize>(f: impl Fn(f64) -> SVector<f64, N>) -> SVector<f64, N> {
    (f(DELTA) - f(-DELTA)) / (2.0 * DELTA)
}

#[allow(clippy::needless_pass_by_value, reason = "as the other tests of each scene")]
fn agrees_with_differences<const N: usize, S: Dynamics<N> + Convertible<N>>(scene: Scene<S, N>) {
    let system = &scene.system;
    let mut draw = Sequence::new(5);
    let (mut exact, mut close) = ([0.0_f64; 3], [0.0_f64; 2]);
    for _ in 0..DRAWS {
        let t = draw.within(-1.0, 2.0);
        let mut near = |values: [f64; N]| SVector::from(values.map(|value| value * draw.within(0.8, 1.2)));
        let (q, v) = (near(scene.q), near(scene.v));
        let other = SVector::<f64, N>::from_fn(|_, _| draw.within(-2.0, 2.0));
        let a = system.acceleration(t, &q, &v).expect("an acceleration");
        let (mass, bias) = (system.mass_matrix(t, q, v), system.bias(t, q, v));
        let size = (mass * a).amax() + bias.amax() + (mass * v).amax();
        exact[0] = exact[0].max((mass * a + bias).amax() / size);
        exact[1] = exact[1].max(system.inverse_dynamics(t, q, v, a).amax() / size);
        let force = system.inverse_dynamics(t, q, v, other) - mass * (other - a);
        exact[2] = exact[2].max(force.amax() / (size + (mass * other).amax()));

        let unit = |k: usize, e: f64| SVector::<f64, N>::from_fn(|i, _| if i == k { e } else { 0.0 });
        let columns: Vec<_> = (0..N).map(|k| difference(|e| system.momentum(t, &q, &(v + unit(k, e))))).collect();
        close[0] = close[0].max(distance(&dense(&mass), &dense(&SMatrix::<f64, N, N>::from_columns(&columns))));
        let linear = system.linearization(t, q, v).expect("a linearization");
        let by = |k: usize, e: f64| match k {
            k if k < N => system.acceleration(t, &(q + unit(k, e)), &v),
            k => system.acceleration(t, &q, &(v + unit(k - N, e))),
        };
        let rates: Vec<_> = (0..2 * N).map(|k| difference(|e| by(k, e).expect("an acceleration"))).collect();
        let wanted = DMatrix::from_fn(2 * N, 2 * N, |i, j| match i {
            i if i < N => f64::from(u8::from(j == N + i)),
            i => rates[j][i - N],
        });
        close[1] = close[1].max(distance(&linear.a, &wanted));
        assert_eq!(linear.b.shape(), (2 * N, 0));
        assert!(linear.value.iter().eq(v.iter().chain(&a)));
    }
    println!("{}: exact {exact:?}, by differences {close:?}", S::NAME);
    assert!(exact.into_iter().all(|error| error <= EXACT), "{}: {exact:?}", S::NAME);
    assert!(close.into_iter().all(|error| error <= CLOSE), "{}: {close:?}", S::NAME);
}

each_system!(agrees_with_differences);

lagrangian! {
    /// A planar arm of three links in the angles of its joints, with friction and a motor in each.
    struct PlanarArm {
        param l[3] = 1.0, c[3] = 0.5, m[3] = 1.0, J[3] = 0.1, d[3] = 0.0, g = 9.81;
        /// Torques of the motors.
        input u[3] = 0.0;
        coord q[3];
        let a[i in 0..3] = sum(j in 0..i + 1, q[j]);
        let x[i in 0..3] = c[i] * cos(a[i]) + sum(j in 0..i, l[j] * cos(a[j]));
        let y[i in 0..3] = c[i] * sin(a[i]) + sum(j in 0..i, l[j] * sin(a[j]));
        L = sum(i in 0..3, m[i] * (dot(x[i])^2 + dot(y[i])^2) / 2 + J[i] * dot(a[i])^2 / 2 - m[i] * g * y[i]);
        force q[i in 0..3] = u[i] - d[i] * dot(q[i]);
        discretize midpoint;
        check { q[0] = 0.4, q[1] = -0.7, dot(q[2]) = 1, d[0] = 0.3; h = 0.005; }
    }
}

fn matrix(value: &Value) -> DMatrix<f64> {
    let rows = value.as_array().expect("rows");
    let row = |row: &Value| row.as_array().expect("a row").iter().map(|x| x.as_f64().expect("a number")).collect();
    let rows: Vec<Vec<f64>> = rows.iter().map(row).collect();
    DMatrix::from_fn(rows.len(), rows[0].len(), |i, j| rows[i][j])
}

#[test]
fn an_arm_is_that_of_pinocchio() {
    let values = file("planar_arm.json");
    let of = &values["parameters"];
    let g = of["g"].as_f64().expect("a number");
    let mut arm = PlanarArm { l: vector(&of["l"]), c: vector(&of["c"]), m: vector(&of["m"]), g, ..Default::default() };
    (arm.J, arm.d) = (vector(&of["J"]), vector(&of["d"]));
    let cases = values["cases"].as_array().expect("cases");
    assert_eq!(cases.len(), 4);
    let mut worst = [0.0_f64; 6];
    for case in cases {
        let [q, v, a, u] = ["q", "v", "a", "u"].map(|name| vector::<3>(&case[name]));
        arm.u = u;
        let near = |found: SVector<f64, 3>, name: &str| {
            let wanted = SVector::from(vector::<3>(&case[name]));
            (found - wanted).amax() / wanted.amax()
        };
        let linear = arm.linearization(0.0, q, v).expect("a linearization");
        let acceleration = SVector::from_column_slice(&linear.value.as_slice()[3..]);
        let errors = [
            distance(&dense(&arm.mass_matrix(0.0, q, v)), &matrix(&case["mass"])),
            near(arm.bias(0.0, q, v), "bias"),
            near(arm.inverse_dynamics(0.0, q, v, a), "inverse"),
            near(acceleration, "acceleration"),
            distance(&linear.a, &matrix(&case["A"])),
            distance(&linear.b, &matrix(&case["B"])),
        ];
        worst = core::array::from_fn(|k| worst[k].max(errors[k]));
    }
    println!("mass, bias, inverse dynamics, acceleration, A, B: {worst:?}");
    // 6.6e-15 was measured, of an acceleration with a mass matrix of condition 300.
    assert!(worst.into_iter().all(|error| error <= 3e-14), "{worst:?}");
}

lagrangian! {
    /// A pole on a cart; the angle a is zero where the pole is upright.
    struct CartPole {
        param M = 1.3, m = 0.2, l = 0.5, g = 9.81;
        input u = 0.0;
        coord x, a;
        L = (M + m) * dot(x)^2 / 2 + m * l * dot(x) * dot(a) * cos(a) + m * l^2 * dot(a)^2 / 2 - m * g * l * cos(a);
        force x = u;
        discretize midpoint;
        check { a = 0.5, dot(x) = 0.3; h = 0.002; }
    }
}

#[test]
fn a_cart_pole_at_the_top_is_that_of_textbooks() {
    // Ogata, Modern Control Engineering, example 3-6, with the pole a point mass.
    let pole = CartPole::default();
    let CartPole { M, m, l, g, .. } = pole;
    let names = <CartPole as Lagrangian<2>>::PARAMETERS;
    assert_eq!(<CartPole as Lagrangian<2>>::INPUTS.iter().map(|input| names[*input]).collect::<Vec<_>>(), ["u"]);
    let linear = pole.linearization(0.0, [0.7, 0.0], [0.0, 0.0]).expect("a linearization");
    let mut a = DMatrix::zeros(4, 4);
    (a[(0, 2)], a[(1, 3)], a[(2, 1)], a[(3, 1)]) = (1.0, 1.0, -m * g / M, (M + m) * g / (M * l));
    let b = DMatrix::from_column_slice(4, 1, &[0.0, 0.0, 1.0 / M, -1.0 / (M * l)]);
    // 1.6e-16 and 0 were measured.
    assert!(distance(&linear.a, &a) <= 1e-15 && distance(&linear.b, &b) <= 1e-15, "{linear:?}");
    assert!(linear.value.iter().all(|rate| *rate == 0.0));
    let fall = ((M + m) * g / (M * l)).sqrt();
    let rates = linear.eigenvalues().expect("eigenvalues");
    // 1.9e-16 was measured.
    near_rates(&rates, &[-fall, 0.0, 0.0, fall].map(|re| Complex::new(re, 0.0)), 1e-15);

    // Nothing depends on the place of the cart, so that it stays that of the guess.
    let top = pole.equilibrium(0.0, [0.7, 0.3]).expect("an equilibrium");
    assert_eq!((top.q, top.free()), (SVector::from([0.7, 0.0]), [true, false]));
    near_rates(&top.rates().expect("rates"), &[-fall, 0.0, 0.0, fall].map(|re| Complex::new(re, 0.0)), 1e-15);
    let below = pole.equilibrium(0.0, [0.7, 2.9]).expect("an equilibrium");
    assert!((below.q[1] - PI).abs() <= f64::EPSILON * PI, "{below:?}");
    let frequencies = below.frequencies().expect("frequencies");
    assert!(frequencies.len() == 1 && (frequencies[0] / fall - 1.0).abs() < 1e-15, "{frequencies:?}");
    // A force on the cart has no balance.
    let pushed = CartPole { u: 0.5, ..pole }.equilibrium(0.0, [0.0, 0.1]);
    assert_eq!(pushed, Err(StepError::NoEquilibrium { t: 0.0, coordinate: "x", force: 0.5 }));
}

/// Checks rates against theirs in the same order, relative to the largest.
fn near_rates(found: &[Complex<f64>], wanted: &[Complex<f64>], tolerance: f64) {
    assert_eq!(found.len(), wanted.len(), "{found:?}");
    let size = wanted.iter().map(|rate| rate.norm()).fold(0.0, f64::max);
    let error = found.iter().zip(wanted).map(|(a, b)| (a - b).norm() / size).fold(0.0, f64::max);
    println!("rates: {error:.1e}");
    assert!(error <= tolerance, "{error:.1e}: {found:?} against {wanted:?}");
}

#[test]
fn pendula_oscillate_at_their_frequencies() {
    let pendulum = Pendulum { m: 1.4, l: 0.7, g: 9.81 };
    // On both sides of π/2, and of π.
    for (guess, wanted) in [(1.5, 0.0), (-1.57, 0.0), (1.6, PI), (3.0, PI), (-4.0, -PI), (30.5, 10.0 * PI), (0.0, 0.0)]
    {
        let found = pendulum.equilibrium(0.0, [guess]).unwrap_or_else(|error| panic!("{guess}: {error}"));
        assert!((found.q[0] - wanted).abs() <= f64::EPSILON * f64::abs(wanted), "{guess}: {found:?}");
        assert!(found.residual <= 4.0);
        let rate = (pendulum.g / pendulum.l).sqrt();
        if wanted.cos() > 0.0 {
            let frequencies = found.frequencies().expect("frequencies");
            assert!((frequencies[0] / rate - 1.0).abs() <= 4e-16, "{frequencies:?}");
        } else {
            near_rates(&found.rates().expect("rates"), &[-rate, rate].map(|re| Complex::new(re, 0.0)), 4e-16);
        }
    }
    // Halfway the force does not change with the angle.
    let level = pendulum.equilibrium(0.0, [0.5 * PI]);
    assert!(matches!(level, Err(StepError::NoEquilibrium { coordinate: "θ", .. })), "{level:?}");

    let DoublePendulum { m1, m2, l1, l2, g } = DoublePendulum { m1: 1.3, m2: 0.6, l1: 0.8, l2: 1.1, g: 9.81 };
    let found = DoublePendulum { m1, m2, l1, l2, g }.equilibrium(0.0, [0.4, -0.3]).expect("an equilibrium");
    assert_eq!(found.q, SVector::from([0.0, 0.0]));
    // m1 l1 l2 ω⁴ − M g (l1 + l2) ω² + M g² = 0, M = m1 + m2: Landau and Lifshitz, Mechanics, section 23.
    let (a, b, c) = (m1 * l1 * l2, (m1 + m2) * g * (l1 + l2), (m1 + m2) * g * g);
    let fast = (b + (b * b - 4.0 * a * c).sqrt()) / (2.0 * a);
    let wanted = [c / (a * fast), fast].map(f64::sqrt);
    let frequencies = found.frequencies().expect("frequencies");
    let error = frequencies.iter().zip(wanted).map(|(found, wanted)| (found / wanted - 1.0).abs()).fold(0.0, f64::max);
    println!("double pendulum: {error:.1e}");
    // 2.2e-16 was measured.
    assert!(frequencies.len() == 2 && error <= 1e-15, "{frequencies:?}, {wanted:?}");
}

lagrangian! {
    /// A charge in a magnetic field and in an isotropic trap.
    struct Trap {
        param B = 0.7, w = 1.3;
        coord x, y;
        L = (dot(x)^2 + dot(y)^2) / 2 + B * (x * dot(y) - y * dot(x)) / 2 - w^2 * (x^2 + y^2) / 2;
        discretize midpoint;
    }
}

#[test]
fn damping_and_gyroscopic_terms_count() {
    let oscillator = DampedOscillator { m: 1.2, k: 3.4, c: 0.9 };
    let found = oscillator.equilibrium(0.0, [5.0]).expect("an equilibrium");
    assert_eq!((found.q[0], found.damping[0], found.stiffness[0], found.mass[0]), (0.0, 0.9, 3.4, 1.2));
    let decay = oscillator.c / (2.0 * oscillator.m);
    let frequency = (oscillator.k / oscillator.m - decay * decay).sqrt();
    let rates = found.rates().expect("rates");
    near_rates(&rates, &[Complex::new(-decay, -frequency), Complex::new(-decay, frequency)], 1e-15);

    // Larmor: √(w² + B²/4) ∓ B/2.
    let trap = Trap::default();
    let [half, mean] = [0.5 * trap.B, f64::hypot(trap.w, 0.5 * trap.B)];
    let found = trap.equilibrium(0.0, [0.3, -0.2]).expect("an equilibrium").frequencies().expect("frequencies");
    let error = (found[0] / (mean - half) - 1.0).abs().max((found[1] / (mean + half) - 1.0).abs());
    println!("trap: {error:.1e}");
    // 1.3e-15 was measured.
    assert!(found.len() == 2 && error < 1e-14, "{found:?}");
}

lagrangian! {
    /// Two masses on a line with a spring between them, or none.
    struct Pair {
        param k = 2.0, a = 1.0;
        coord x, y;
        L = (dot(x)^2 + 3 * dot(y)^2) / 2 - k * (y - x - a)^2 / 2;
        discretize midpoint;
    }
}

lagrangian! {
    /// A body that falls, and one on a spring.
    struct Falling {
        coord s, z;
        L = (dot(s)^2 + dot(z)^2) / 2 - s^2 / 2 + s - 9.81 * z;
        discretize midpoint;
    }
}

lagrangian! {
    /// A pendulum with a torque, whose pivot moves up and down.
    struct Torque {
        param m = 1.3, l = 0.6, g = 9.81, lift = 0.0;
        input u = 0.0;
        coord a;
        let y = lift * sin(3 * t) - l * cos(a);
        L = m * (dot(l * sin(a))^2 + dot(y)^2) / 2 - m * g * y;
        force a = u;
        discretize midpoint;
        check { a = 0.4, dot(a) = 0.3, lift = 0.02; h = 0.01; }
    }
}

#[test]
fn equilibria_balance_inputs() {
    let pendulum = Torque::default();
    let limit = pendulum.m * pendulum.g * pendulum.l;
    for part in [-0.999, -0.3, 1e-9, 0.7, 0.999_999] {
        let torque = Torque { u: part * limit, ..pendulum };
        let found = torque.equilibrium(0.0, [0.1]).unwrap_or_else(|error| panic!("{part}: {error}"));
        // Near the limit the sine has a flat top.
        let tolerance = 8.0 * f64::EPSILON / (1.0 - part * part).sqrt();
        assert!((found.q[0] - part.asin()).abs() <= tolerance, "{part}: {:e}", found.q[0] - part.asin());
        assert!(found.residual <= 4.0);
    }
    for beyond in [1.000_001, 2.0, -1e6] {
        let error = Torque { u: beyond * limit, ..pendulum }.equilibrium(0.0, [0.1]).expect_err("none");
        assert!(matches!(error, StepError::NoEquilibrium { coordinate: "a", .. }), "{beyond}: {error}");
    }
    // A pivot that accelerates by y'' = −9 lift sin 3t adds to gravity, at this time.
    let lifted = Torque { lift: 0.4, u: 0.5 * limit, ..pendulum };
    let t = 1.7;
    let found = lifted.equilibrium(t, [0.1]).expect("an equilibrium");
    let wanted = (0.5 * pendulum.g / (pendulum.g - 9.0 * 0.4 * f64::sin(3.0 * t))).asin();
    let rest = lifted.acceleration(t, &found.q, &SVector::zeros()).expect("an acceleration");
    println!("lifted: {:e}, {:e}", found.q[0] - wanted, rest[0]);
    // 5.6e-17 and 9.5e-16 were measured.
    assert!((found.q[0] - wanted).abs() < 1e-15 && rest[0].abs() < 1e-14);
}

#[test]
fn without_an_equilibrium_there_is_a_typed_error() {
    let pair = Pair::default().equilibrium(0.0, [0.2, 0.9]);
    let Err(StepError::FreeMotion { coordinate, .. }) = pair else { panic!("{pair:?}") };
    assert!(["x", "y"].contains(&coordinate));
    let falling = Falling::default().equilibrium(0.5, [0.0, 0.0]);
    assert_eq!(falling, Err(StepError::NoEquilibrium { t: 0.5, coordinate: "z", force: -9.81 }));
    let words = falling.expect_err("none").to_string();
    assert!(words.contains("the force -9.810e0 on `z` is not balanced; start nearer to it"), "{words}");
    let orbit = Kepler::default().equilibrium(0.0, [1.0, 0.3]);
    assert!(matches!(orbit, Err(StepError::NoEquilibrium { .. } | StepError::FreeMotion { .. })), "{orbit:?}");
    let center = Kepler::default().equilibrium(0.0, [0.0, 0.0]);
    assert!(matches!(center, Err(StepError::NonFinite { expression: Some(_), .. })), "{center:?}");
    let center = Kepler::default().linearization(0.0, [0.0, 0.0], [0.0, 0.0]);
    assert!(matches!(center, Err(StepError::NonFinite { .. })), "{center:?}");
    let lost = Pendulum::default().equilibrium(0.0, [f64::NAN]);
    assert!(matches!(lost, Err(StepError::NonFinite { .. })), "{lost:?}");
    // With another spring there is one, and several units do not matter.
    for unit in [1e-9, 1.0, 1e9] {
        let arm = PlanarArm { m: [unit; 3], J: [0.1 * unit; 3], u: [2.0 * unit; 3], ..Default::default() };
        let found = arm.equilibrium(0.0, [-1.5, 0.1, 0.1]).expect("an equilibrium");
        let size = arm.bias(0.0, [0.0; 3], [0.0; 3]).amax();
        assert!(arm.bias(0.0, found.q, [0.0; 3]).amax() < 1e-15 * size && found.residual <= 4.0, "{found:?}");
    }
}

#[test]
fn from_any_guess_there_is_an_equilibrium_or_a_typed_error() {
    const GUESSES: u32 = 400;
    let arm = PlanarArm { l: [0.7, 0.55, 0.4], u: [9.0, 2.5, -0.8], d: [0.4, 0.2, 0.1], ..Default::default() };
    let mut draw = Sequence::new(3);
    let (mut found, mut worst, mut farthest) = (0, 0.0_f64, 0.0_f64);
    for _ in 0..GUESSES {
        let guess = SVector::<f64, 3>::from_fn(|_, _| draw.within(-PI, PI));
        match arm.equilibrium(0.0, guess) {
            Ok(at) => {
                found += 1;
                assert!(at.residual <= 4.0, "{at:?}");
                let force = arm.bias(0.0, at.q, [0.0; 3]);
                worst = worst.max(force.amax() / arm.bias(0.0, [0.0; 3], [0.0; 3]).amax());
                farthest = farthest.max((at.q - guess).amax());
            }
            Err(error) => assert!(
                matches!(error, StepError::NoEquilibrium { .. } | StepError::FreeMotion { .. }),
                "{guess}: {error}"
            ),
        }
    }
    println!("{found} of {GUESSES} guesses led to an equilibrium, at most {farthest:.1} away, force {worst:.1e}");
    // All, 3.6 and 9.1e-16 were measured.
    assert!(found > GUESSES * 9 / 10 && worst < 4e-15 && farthest < 5.0, "{found}, {worst:e}, {farthest}");
}

#[test]
fn eigenvalues_are_those_of_the_matrix() {
    let of = |size: usize, rows: &[f64]| {
        let a = DMatrix::from_row_slice(size, size, rows);
        let (value, b) = (a.column(0).into_owned(), DMatrix::zeros(size, 0));
        Linearization { t: 0.0, value, a, b }.eigenvalues().expect("eigenvalues")
    };
    // A cyclic permutation: the QR iteration without exceptional shifts does not end. 5.1e-15 was
    // measured.
    let root = Complex::new(-0.5, 0.75_f64.sqrt());
    let wanted = [Complex::new(1.0, 0.0), root.conj(), root];
    near_rates(&of(3, &[0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]), &wanted, 2e-14);
    // Rows and columns of units far apart.
    let wanted = [-2.0, 5.0].map(|re| Complex::new(re, 0.0));
    near_rates(&of(2, &[1.0, 4e12, 3e-12, 2.0]), &wanted, 1e-15);
}
