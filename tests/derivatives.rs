//! Each generated derivative against dual numbers, which differentiate operation by operation and know no symbols;
//! and each generated L and f against the formula written by hand.
//!
//! States, intervals and parameters are drawn, parameters away from 1, so that no term hides behind another.

use crate::support::Sequence;
use vi_core::check::{self, EnergyChecked, Place};
use vi_core::lagrangian::Parameters;
use vi_core::linear::Matrix;
use vi_core::node::Node;
use vi_core::real::Dual;
use vi_core::stepping::EnergyStepping;
use vi_core::{DiscreteLagrangian, Interval, Lagrangian, SVector};
use vi_systems as systems;

/// Draws for each system.
const DRAWS: usize = 20;
/// Relative to the largest number that meets in a comparison. Measured: 1.7e-15.
const TOLERANCE: f64 = 4e-15;

/// Compares two numbers, relative to a scale, and remembers the largest difference.
struct Comparison {
    name: &'static str,
    worst: f64,
    nonzero: usize,
    /// The worst difference in the system's own checks.
    checked: f64,
}

impl Comparison {
    fn new(name: &'static str) -> Self {
        Self { name, worst: 0.0, nonzero: 0, checked: 0.0 }
    }

    fn equal(&mut self, what: &str, found: f64, wanted: f64, scale: f64) {
        let difference = (found - wanted).abs() / scale.max(1e-3);
        assert!(
            difference <= TOLERANCE,
            "{} {what}: {found:e}, by dual numbers {wanted:e}, off {difference:e}",
            self.name
        );
        self.worst = self.worst.max(difference);
        self.nonzero += usize::from(wanted != 0.0);
    }

    fn equal_vectors<const N: usize>(
        &mut self,
        what: &str,
        found: &SVector<f64, N>,
        wanted: &SVector<f64, N>,
        scale: f64,
    ) {
        for index in 0..N {
            self.equal(&format!("{what}[{index}]"), found[index], wanted[index], scale.max(wanted.amax()));
        }
    }
}

type D = Dual<f64>;
type DD = Dual<Dual<f64>>;

fn lift<const N: usize>(vector: &SVector<f64, N>) -> SVector<D, N> {
    SVector::from_fn(|index, _| D::fixed(vector[index]))
}

fn along<const N: usize>(vector: &SVector<f64, N>, direction: &SVector<f64, N>) -> SVector<D, N> {
    SVector::from_fn(|index, _| D { value: vector[index], slope: direction[index] })
}

fn unit<const N: usize>(index: usize) -> SVector<f64, N> {
    SVector::from_fn(|row, _| f64::from(u8::from(row == index)))
}

/// ∂L/∂q along the motion (1, v, a): value and rate, by second-order dual numbers; and the same of ∂L/∂t.
fn gradient_and_rate<const N: usize>(
    system: &impl Lagrangian<N, DD>,
    (t, q, v, a): (f64, &SVector<f64, N>, &SVector<f64, N>, &SVector<f64, N>),
) -> (SVector<f64, N>, SVector<f64, N>, f64) {
    let number =
        |value: f64, rate: f64, seed: f64| DD { value: D { value, slope: rate }, slope: D { value: seed, slope: 0.0 } };
    let derivative = |seed_t: f64, seed_q: &SVector<f64, N>| {
        let q2 = SVector::from_fn(|i, _| number(q[i], v[i], seed_q[i]));
        let v2 = SVector::from_fn(|i, _| number(v[i], a[i], 0.0));
        system.lagrangian(number(t, 1.0, seed_t), &q2, &v2).slope
    };
    let each: Vec<D> = (0..N).map(|index| derivative(0.0, &unit(index))).collect();
    let by_time = derivative(1.0, &SVector::from_fn(|_, _| 0.0));
    (SVector::from_fn(|i, _| each[i].value), SVector::from_fn(|i, _| each[i].slope), by_time.slope)
}

/// Momentum, energy, acceleration, step density at one state.
fn check_continuous<const N: usize>(
    system: &impl EnergyStepping<N>,
    dual: &impl Lagrangian<N, D>,
    second: &impl Lagrangian<N, DD>,
    (t, q, v): (f64, &SVector<f64, N>, &SVector<f64, N>),
    check: &mut Comparison,
) {
    let momentum = SVector::from_fn(|i, _| dual.lagrangian(D::fixed(t), &lift(q), &along(v, &unit(i))).slope);
    check.equal_vectors("momentum", &system.momentum(t, q, v), &momentum, 1.0);
    let energy = v.dot(&momentum) - system.lagrangian(t, q, v);
    let scale = v.dot(&momentum).abs() + system.lagrangian(t, q, v).abs();
    check.equal("energy", system.energy(t, q, v), energy, scale);
    // d/dt ∂L/∂v = L_q + f along the motion.
    let a = system.acceleration(t, q, v).expect("the mass matrix is regular at a drawn state");
    let rate = dual.momentum(D::variable(t), &along(q, v), &along(v, &a));
    let (gradient, gradient_rate, time_rate) = gradient_and_rate(second, (t, q, v, &a));
    let applied = gradient + system.force(t, q, v);
    check.equal_vectors("d/dt momentum", &SVector::from_fn(|i, _| rate[i].slope), &applied, 1.0 + a.amax());
    let density = a.dot(&applied) - v.dot(&gradient_rate) - time_rate;
    let scale = a.dot(&applied).abs() + v.amax() * gradient_rate.amax() + time_rate.abs();
    check.equal("step density", system.step_density(t, q, v).expect("regular"), density, scale);
}

/// D1…D4 against L_d, and what the midpoint rule says of the discrete force.
fn check_slots<const N: usize>(
    system: &impl DiscreteLagrangian<N>,
    dual: &impl DiscreteLagrangian<N, D>,
    interval: &Interval<N>,
    check: &mut Comparison,
) {
    let Interval { t0, q0, t1, q1 } = *interval;
    let still = Interval { t0: D::fixed(t0), q0: lift(&q0), t1: D::fixed(t1), q1: lift(&q1) };
    let h = t1 - t0;
    let (tm, qm, v) = (t0 + h / 2.0, (q0 + q1) / 2.0, (q1 - q0) / h);
    let scale = system.momentum(tm, &qm, &v).dot(&v).abs() + system.lagrangian(tm, &qm, &v).abs();
    check.equal("L_d", system.ld(interval), h * system.lagrangian(tm, &qm, &v), h * scale);
    let d1 = dual.ld(&Interval { t0: D::variable(t0), ..still }).slope;
    check.equal("D1", system.d1_ld(interval), d1, scale);
    let d3 = dual.ld(&Interval { t1: D::variable(t1), ..still }).slope;
    check.equal("D3", system.d3_ld(interval), d3, scale);
    let d2 = SVector::from_fn(|i, _| dual.ld(&Interval { q0: along(&q0, &unit(i)), ..still }).slope);
    check.equal_vectors("D2", &system.d2_ld(interval), &d2, 1.0);
    let d4 = SVector::from_fn(|i, _| dual.ld(&Interval { q1: along(&q1, &unit(i)), ..still }).slope);
    check.equal_vectors("D4", &system.d4_ld(interval), &d4, 1.0);
    let force = system.force(tm, &qm, &v);
    check.equal_vectors("f-", &system.fd_minus(interval), &(force * (h / 2.0)), 1.0);
    check.equal_vectors("f+", &system.fd_plus(interval), &(force * (h / 2.0)), 1.0);
    check.equal("g-", system.gd_minus(interval), -force.dot(&v) * h / 2.0, 1.0);
    check.equal("g+", system.gd_plus(interval), -force.dot(&v) * h / 2.0, 1.0);
}

/// The equations of a step against the slots, their Jacobians against dual numbers.
fn check_step<const N: usize>(
    system: &(impl EnergyStepping<N> + DiscreteLagrangian<N>),
    dual: &impl EnergyStepping<N, D>,
    (node, h, v): (&Node<N>, f64, &SVector<f64, N>),
    check: &mut Comparison,
) {
    let interval = Interval { t0: node.t, q0: node.q, t1: node.t + h, q1: node.q + v * h };
    let (found, rounding) = (system.extended_system(node, h, v), system.extended_rounding(node, h, v));
    let row = -system.d2_ld(&interval) - system.fd_minus(&interval) - node.p;
    check.equal_vectors("residual", &found.momentum.residual, &row, rounding.residual.amax());
    let alone = system.momentum_equation(node, h, v);
    check.equal_vectors("residual alone", &alone.residual, &found.momentum.residual, rounding.residual.amax());
    let energy = system.d1_ld(&interval) + system.gd_minus(&interval) - node.energy;
    let combined = energy - v.dot(&row);
    let scale = rounding.energy_residual + v.amax() * rounding.residual.amax();
    check.equal("energy residual", found.energy_residual, combined, scale);
    // A row is a sum that loses at least half an ulp of itself.
    assert!(rounding.energy_residual >= 0.5 * found.energy_residual.abs());
    assert!((0..N).all(|i| rounding.residual[i] >= 0.5 * found.momentum.residual[i].abs()));

    let lifted = Node {
        t: D::fixed(node.t),
        t_low: D::fixed(0.0),
        q: lift(&node.q),
        q_low: lift(&node.q_low),
        p: lift(&node.p),
        p_low: lift(&node.p_low),
        energy: D::fixed(node.energy),
        energy_low: D::fixed(0.0),
    };
    // c = e − v·r, so ∂e/∂x − v·∂r/∂x = ∂c/∂x + r·∂v/∂x.
    for j in 0..N {
        let column = dual.extended_system(&lifted, D::fixed(h), &along(v, &unit(j)));
        let slope = SVector::from_fn(|i, _| column.momentum.residual[i].slope);
        check.equal_vectors("A", &found.momentum.jacobian.dense().column(j).into_owned(), &slope, 1.0);
        check.equal_vectors("A alone", &alone.jacobian.dense().column(j).into_owned(), &slope, 1.0);
        let slope = (column.energy_residual.slope + found.momentum.residual[j]) / h;
        check.equal(
            "energy_dv",
            found.energy_dv[j],
            slope,
            (rounding.energy_residual + node.p.amax() + row.amax()) / h,
        );
    }
    let column = dual.extended_system(&lifted, D::variable(h), &lift(v));
    let slope = SVector::from_fn(|i, _| column.momentum.residual[i].slope);
    check.equal_vectors("residual_dh", &found.residual_dh, &slope, 1.0);
    check.equal("energy_dh", found.energy_dh, column.energy_residual.slope / h, rounding.energy_residual / h);
    let (measured, both) = (system.momentum_residual(node, h, v), system.extended_residual(node, h, v));
    check.equal_vectors("residual measured", &measured.residual, &row, rounding.residual.amax());
    check.equal_vectors("residual measured in both", &both.residual, &row, rounding.residual.amax());
    check.equal("energy residual measured", both.energy_residual, combined, scale);
    let momentum =
        system.d2_ld(&interval) + system.d4_ld(&interval) + system.fd_minus(&interval) + system.fd_plus(&interval);
    check.equal_vectors("p1 - p0", &measured.increment, &momentum, system.d4_ld(&interval).amax());
    check.equal_vectors("p1 - p0 of both", &both.increment.momentum, &momentum, system.d4_ld(&interval).amax());
    let energy =
        -system.d1_ld(&interval) - system.d3_ld(&interval) - system.gd_minus(&interval) - system.gd_plus(&interval);
    check.equal("E1 - E0", both.increment.energy, energy, scale);
    let end = -system.d3_ld(&interval) - system.gd_plus(&interval);
    check.equal("E1", system.discrete_energy(node, h, v), end, scale);
}

/// The checks that a system carries say the same of it, about any state.
fn passes_its_checks<const N: usize, S: EnergyChecked<N>>(system: &S, place: &Place<N>, check: &mut Comparison) {
    let checks = [check::derivatives, check::slots, check::steps, check::energy_equations];
    for report in checks.map(|check| check(system, place)) {
        let report = report.unwrap_or_else(|failure| panic!("{failure}, at {place:?}"));
        // In bounds of rounding. Measured: 0.44.
        assert!(report.worst <= 0.9, "{report}");
        check.checked = check.checked.max(report.worst);
    }
}

/// All of it, for one system with drawn parameters.
macro_rules! derivatives {
    ($test:ident, $system:ident, $n:literal, |$s:ident, $t:ident, $q:ident, $v:ident| $lagrangian:expr, $force:expr) => {
        #[test]
        fn $test() {
            let mut check = Comparison::new(stringify!($system));
            let mut draw = Sequence::new(7);
            for _ in 0..DRAWS {
                let mut $s = systems::$system::default();
                for name in <systems::$system as Lagrangian<_>>::PARAMETERS {
                    *$s.parameter_mut(name).expect("a name of the list") = draw.within(0.6, 1.9);
                }
                let (dual, second) = ($s.convert::<D>(), $s.convert::<DD>());
                let ($t, h) = (draw.within(-1.0, 2.0), draw.within(0.05, 0.4));
                let mut vector = |low, high| SVector::<f64, $n>::from_fn(|_, _| draw.within(low, high));
                // Away from the poles of polar angles and the centre of Kepler's problem.
                let ($q, $v, p) = (vector(0.4, 1.4), vector(-1.2, 1.3), vector(-1.0, 1.0));
                check.equal("L by hand", $s.lagrangian($t, &$q, &$v), $lagrangian, 10.0);
                let force: [f64; $n] = $force;
                check.equal_vectors("f by hand", &$s.force($t, &$q, &$v), &force.into(), 1.0);
                check_continuous(&$s, &dual, &second, ($t, &$q, &$v), &mut check);
                check_slots(&$s, &dual, &Interval { t0: $t, q0: $q, t1: $t + h, q1: $q + $v * h }, &mut check);
                let zero = SVector::from_fn(|_, _| 0.0);
                let node =
                    Node { t: $t, t_low: 0.0, q: $q, q_low: zero, p, p_low: zero, energy: p.sum(), energy_low: 0.0 };
                check_step(&$s, &dual, (&node, h, &$v), &mut check);
                passes_its_checks(&$s, &Place { t: $t, q: $q, v: $v, h: 0.01 }, &mut check);
            }
            println!("{}: its own checks differ by {:.2} of their rounding", check.name, check.checked);
            println!("{}: {} numbers other than zero, worst difference {:e}", check.name, check.nonzero, check.worst);
            assert!(check.nonzero > 10 * DRAWS, "almost everything compared was zero");
        }
    };
}

derivatives!(
    double_well,
    DoubleWell,
    1,
    |s, t, q, v| s.m * v[0].powi(2) / 2.0 - (q[0].powi(4) - q[0].powi(2)) / 2.0,
    [0.0]
);
derivatives!(
    harmonic_oscillator,
    HarmonicOscillator,
    1,
    |s, t, q, v| (s.m * v[0].powi(2) - s.k * q[0].powi(2)) / 2.0,
    [0.0]
);
derivatives!(
    damped_oscillator,
    DampedOscillator,
    1,
    |s, t, q, v| (s.m * v[0].powi(2) - s.k * q[0].powi(2)) / 2.0,
    [-s.c * v[0]]
);
derivatives!(
    pendulum,
    Pendulum,
    1,
    |s, t, q, v| s.m * (s.l * v[0]).powi(2) / 2.0 + s.m * s.g * s.l * q[0].cos(),
    [0.0]
);
derivatives!(
    hard_duffing,
    HardDuffing,
    1,
    |s, t, q, v| v[0].powi(2) / 2.0 - s.alpha * q[0].powi(2) / 2.0 - s.beta * q[0].powi(4) / 4.0,
    [-s.c * v[0] + s.amplitude * (s.omega * t).cos()]
);
derivatives!(
    double_well_duffing,
    DoubleWellDuffing,
    1,
    |s, t, q, v| v[0].powi(2) / 2.0 + q[0].powi(2) / 2.0 - q[0].powi(4) / 4.0,
    [-s.c * v[0] + s.amplitude * (s.omega * t).cos()]
);
derivatives!(
    parametric_pendulum,
    ParametricPendulum,
    1,
    |s, t, q, v| v[0].powi(2) / 2.0 + (1.0 + s.epsilon * (s.omega * t).cos()) * q[0].cos(),
    [0.0]
);
derivatives!(
    rotating_hoop,
    RotatingHoop,
    1,
    |s, t, q, v| s.m * s.r.powi(2) / 2.0 * (v[0].powi(2) + (s.Ω * q[0].sin()).powi(2)) + s.m * s.g * s.r * q[0].cos(),
    [0.0]
);
derivatives!(kepler, Kepler, 2, |s, t, q, v| v.norm_squared() / 2.0 + s.mu / q.norm(), [0.0, 0.0]);
derivatives!(
    henon_heiles,
    HenonHeiles,
    2,
    |s, t, q, v| (v.norm_squared() - q.norm_squared()) / 2.0 - s.lambda * (q[0].powi(2) * q[1] - q[1].powi(3) / 3.0),
    [0.0, 0.0]
);
derivatives!(
    double_pendulum,
    DoublePendulum,
    2,
    |s, t, q, v| {
        let (x1, y1) = (s.l1 * v[0] * q[0].cos(), s.l1 * v[0] * q[0].sin());
        let (x2, y2) = (x1 + s.l2 * v[1] * q[1].cos(), y1 + s.l2 * v[1] * q[1].sin());
        let kinetic = s.m1 * (x1 * x1 + y1 * y1) / 2.0 + s.m2 * (x2 * x2 + y2 * y2) / 2.0;
        let (height1, height2) = (-s.l1 * q[0].cos(), -s.l1 * q[0].cos() - s.l2 * q[1].cos());
        kinetic - s.g * (s.m1 * height1 + s.m2 * height2)
    },
    [0.0, 0.0]
);
derivatives!(
    spherical_pendulum,
    SphericalPendulum,
    2,
    |s, t, q, v| {
        s.m * s.l.powi(2) * (v[0].powi(2) + (q[0].sin() * v[1]).powi(2)) / 2.0 + s.m * s.g * s.l * q[0].cos()
    },
    [0.0, 0.0]
);
derivatives!(
    charged_particle,
    ChargedParticle,
    3,
    |s, t, q, v| {
        let potential = s.b * q[0] + s.s * q[0].powi(2) / 2.0;
        s.m * v.norm_squared() / 2.0 + s.e * (potential * v[1] - s.kappa * q[2].powi(2) / 2.0)
    },
    [0.0, 0.0, 0.0]
);
derivatives!(
    n_pendulum,
    NPendulum,
    4,
    |s, t, q, v| {
        // Every mass where it is and as it moves, in the plane.
        let (mut height, mut velocity, mut sum) = (0.0, [0.0, 0.0], 0.0);
        for i in 0..4 {
            height -= s.l * q[i].cos();
            velocity = [velocity[0] + s.l * v[i] * q[i].cos(), velocity[1] + s.l * v[i] * q[i].sin()];
            sum += s.m * (velocity[0].powi(2) + velocity[1].powi(2)) / 2.0 - s.m * s.g * height;
        }
        sum
    },
    [0.0; 4]
);
derivatives!(
    fpu_chain,
    FpuChain,
    16,
    |s, t, q, v| {
        let at = |i: usize| if (1..=16).contains(&i) { q[i - 1] } else { 0.0 };
        let potential = |r: f64| s.k * r.powi(2) / 2.0 + s.alpha * r.powi(3) / 3.0 + s.beta * r.powi(4) / 4.0;
        s.m * v.norm_squared() / 2.0 - (0..=16).map(|i| potential(at(i + 1) - at(i))).sum::<f64>()
    },
    [0.0; 16]
);
