//! The trapezoidal rule: Störmer–Verlet for separable L, order 2 otherwise, slots against dual numbers; and the
//! written-out midpoint rule, which equals the named one bit for bit.

use crate::support::exact::Trajectory;
use vi_core::real::Dual;
use vi_core::stepping::FixedStepping;
use vi_core::{DiscreteLagrangian, FixedStep, Interval, Run, SVector, Starts, State, lagrangian};

type D = Dual<f64>;

lagrangian! {
    /// Separable, two-dimensional, with a time-dependent force.
    struct Separable {
        param m = 1.3, k = 2.1, s = 0.7;
        coord x, y;
        L = m * (dot(x)^2 + 2 * dot(y)^2) / 2 - k * (x^4 + y^2) / 4 - s * x^2 * y;
        force x = sin(t);
        discretize trapezoidal;
    }
}

lagrangian! {
    /// Neither separable nor frictionless: a driven and damped particle on a surface.
    struct Surface {
        param m = 1.2, g = 2.0, c = 0.3;
        coord x, y;
        let height = cos(x) * y^2 / 4 + x^2 / 3;
        let climbing = dot(x) * (2 * x / 3 - sin(x) * y^2 / 4) + dot(y) * cos(x) * y / 2;
        L = m * (dot(x)^2 + dot(y)^2 + climbing^2) / 2 - m * g * height + t * x / 5;
        dissipation = c * (dot(x)^2 + x^2 * dot(y)^2) / 2;
        force y = cos(t) * x;
        discretize trapezoidal;
    }
}

lagrangian! {
    struct Named {
        param m = 1.2, c = 0.3;
        coord x, y;
        L = m * (dot(x)^2 + (1 + x^2) * dot(y)^2) / 2 - x^2 * (1 + y^2) - t * x * y / 7;
        force x = -c * dot(x) * y^2 + cos(t);
        discretize midpoint;
    }
}
lagrangian! {
    struct Written {
        param m = 1.2, c = 0.3;
        coord x, y;
        L = m * (dot(x)^2 + (1 + x^2) * dot(y)^2) / 2 - x^2 * (1 + y^2) - t * x * y / 7;
        force x = -c * dot(x) * y^2 + cos(t);
        discretize {
            Ld = h * L((t0 + t1)/2, (q0 + q1)/2, (q1 - q0)/h);
            fd_minus = h/2 * f((t0 + t1)/2, (q0 + q1)/2, (q1 - q0)/h);
            fd_plus = h/2 * f((t0 + t1)/2, (q0 + q1)/2, (q1 - q0)/h);
            gd_minus = -h/2 * f((t0 + t1)/2, (q0 + q1)/2, (q1 - q0)/h) * (q1 - q0)/h;
            gd_plus = -h/2 * f((t0 + t1)/2, (q0 + q1)/2, (q1 - q0)/h) * (q1 - q0)/h;
        }
    }
}

fn run<const N: usize, S: FixedStepping<N>>(system: S, q: [f64; N], v: [f64; N], h: f64) -> Run<FixedStep, S, N> {
    let start = State::at(&system, 0.0, q, v);
    system.at_state(start).integrate(FixedStep, h).expect("a valid start")
}

#[test]
fn it_is_verlet_for_a_separable_lagrangian() {
    let system = Separable::default();
    let Separable { m, k, s } = system;
    let force = |t: f64, [x, y]: [f64; 2]| [-k * x.powi(3) - 2.0 * s * x * y + t.sin(), -k * y / 2.0 - s * x.powi(2)];
    let h = 0.02;
    let (mut t, mut q, mut p) = (0.0, [0.9, -0.3], [m * 0.4, 2.0 * m * 0.2]);
    let mut run = run(system, q, [0.4, 0.2], h);
    let (mut worst, mut spent) = (0.0_f64, 0);
    for _ in 0..200 {
        // p + (h/2) F, then q + h M⁻¹ p, then p + (h/2) F: the velocity form of Verlet.
        let before = force(t, q);
        let middle = [p[0] + h / 2.0 * before[0], p[1] + h / 2.0 * before[1]];
        q = [q[0] + h * middle[0] / m, q[1] + h * middle[1] / (2.0 * m)];
        t += h;
        let after = force(t, q);
        p = [middle[0] + h / 2.0 * after[0], middle[1] + h / 2.0 * after[1]];
        let state = run.step().expect("an explicit step");
        spent = spent.max(run.iterations());
        worst = worst.max((state.q - SVector::from(q)).amax()).max((state.p - SVector::from(p)).amax());
    }
    println!("200 steps off by {worst:e}, at most {spent} iterations");
    // Measured: 1.9e-15; A depends on parameters only, and each step is one correction.
    assert!(worst <= 4e-15 && spent == 1, "{worst:e}, {spent}");
}

/// Checks that errors against an accurate motion fall by 4 per halving of the step.
fn order<const N: usize, S: FixedStepping<N> + Copy>(system: S, q: [f64; N], v: [f64; N]) {
    let exact = Trajectory::new(0.0, q, v).at(&system, 2.0);
    let momentum = system.momentum(2.0, &exact.q, &exact.v);
    let errors = [50, 100, 200, 400].map(|steps: u32| {
        let mut run = run(system, q, v, 2.0 / f64::from(steps));
        for _ in 0..steps {
            run.step().unwrap_or_else(|error| panic!("{}: {error}", S::NAME));
        }
        (run.state().q - exact.q).amax().max((run.state().p - momentum).amax())
    });
    for pair in errors.windows(2) {
        let slope = (pair[0] / pair[1]).log2();
        println!("{}: errors {:e} and {:e}, order {slope:.4}", S::NAME, pair[0], pair[1]);
        // Measured: 2.0000 within 1e-4.
        assert!(pair[1] > 1e-10 && (slope - 2.0).abs() <= 1e-3, "{}: order {slope}", S::NAME);
    }
}

#[test]
fn it_is_of_order_two() {
    order(Separable::default(), [0.9, -0.3], [0.4, 0.2]);
    order(Surface::default(), [0.8, 0.5], [0.3, -0.6]);
}

/// Relative differences, and the number of nonzero values.
#[derive(Default)]
struct Comparison {
    worst: f64,
    nonzero: usize,
}

impl Comparison {
    fn equal(&mut self, what: &str, found: f64, wanted: f64) {
        let difference = (found - wanted).abs() / wanted.abs().max(1.0);
        // Measured: 6.8e-16, from cancelling terms of D1.
        assert!(difference <= 2e-15, "{what}: {found:e}, wanted {wanted:e}");
        self.worst = self.worst.max(difference);
        self.nonzero += usize::from(wanted != 0.0);
    }
}

fn slots<S: DiscreteLagrangian<2>>(system: &S, dual: &impl DiscreteLagrangian<2, D>) {
    let (t0, t1) = (0.3, 0.55);
    let (q0, q1) = (SVector::from([0.8, 0.5]), SVector::from([0.9, 0.1]));
    let (interval, h) = (Interval { t0, q0, t1, q1 }, t1 - t0);
    let v = (q1 - q0) / h;
    let mut check = Comparison::default();
    let (start, end) = (system.lagrangian(t0, &q0, &v), system.lagrangian(t1, &q1, &v));
    check.equal("L_d", system.ld(&interval), h / 2.0 * (start + end));
    // One of the six slots varies.
    let slope = |slot: usize| {
        let lift = |value: f64, index| if index == slot { D::variable(value) } else { D::fixed(value) };
        let q0 = SVector::from([lift(q0[0], 1), lift(q0[1], 2)]);
        let q1 = SVector::from([lift(q1[0], 4), lift(q1[1], 5)]);
        dual.ld(&Interval { t0: lift(t0, 0), q0, t1: lift(t1, 3), q1 }).slope
    };
    check.equal("D1", system.d1_ld(&interval), slope(0));
    check.equal("D3", system.d3_ld(&interval), slope(3));
    let (f0, f1) = (system.force(t0, &q0, &v), system.force(t1, &q1, &v));
    for i in 0..2 {
        check.equal("D2", system.d2_ld(&interval)[i], slope(1 + i));
        check.equal("D4", system.d4_ld(&interval)[i], slope(4 + i));
        check.equal("f-", system.fd_minus(&interval)[i], h / 2.0 * f0[i]);
        check.equal("f+", system.fd_plus(&interval)[i], h / 2.0 * f1[i]);
    }
    check.equal("g-", system.gd_minus(&interval), -h / 2.0 * f0.dot(&v));
    check.equal("g+", system.gd_plus(&interval), -h / 2.0 * f1.dot(&v));
    println!("{}: {} numbers other than zero, off by {:e}", S::NAME, check.nonzero, check.worst);
    assert!(check.nonzero >= 11, "almost everything compared was zero");
}

#[test]
fn its_slots_are_those_of_its_discrete_lagrangian() {
    let (separable, surface) = (Separable::default(), Surface::default());
    slots(&separable, &separable.convert::<D>());
    slots(&surface, &surface.convert::<D>());
}

#[test]
fn the_midpoint_rule_written_out_is_the_named_one_bit_for_bit() {
    let (q, v) = ([0.7, 0.4], [0.2, -0.5]);
    let (mut named, mut written) = (run(Named::default(), q, v, 0.05), run(Written::default(), q, v, 0.05));
    for _ in 0..500 {
        let (one, other) = (named.step().expect("a step"), written.step().expect("a step"));
        assert_eq!(one, other);
    }
    assert!((named.state().q - SVector::from(q)).amax() > 0.1, "nothing moved");
}
