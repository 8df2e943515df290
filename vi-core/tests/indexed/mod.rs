//! The functions of large systems: a system with handwritten primitives against the same system by `lagrangian!`.

mod handwritten;

use handwritten::{Handwritten, Vector};
use vi_core::error::StepError;
use vi_core::indexed;
use vi_core::lagrangian::{Flow, Lagrangian, Parameters};
use vi_core::linear::Matrix;
use vi_core::motion::Motion;
use vi_core::nalgebra::SMatrix;
use vi_core::node::Node;
use vi_core::real::Rounded;
use vi_core::stepping::{EnergyStepping, MomentumDerivatives};
use vi_core::{
    DiscreteLagrangian, EnergyPreserving, FixedStep, Gauss, Interval, Method, Run, SVector, Starts, State, lagrangian,
};

lagrangian! {
    /// Three bodies in the plane, with coupled velocities, a field that depends on the time, and friction.
    struct Generated {
        param m0 = 1.3, m1 = 0.9, m2 = 1.7, g = 0.8, b = 0.3, w = 1.9, c = 0.2;
        coord x0, x1, x2, y0, y1, y2;
        let square0 = dot(x0)^2 + dot(y0)^2, square1 = dot(x1)^2 + dot(y1)^2, square2 = dot(x2)^2 + dot(y2)^2;
        let r01 = sqrt((x0 - x1)^2 + (y0 - y1)^2);
        let r12 = sqrt((x1 - x2)^2 + (y1 - y2)^2);
        let r20 = sqrt((x2 - x0)^2 + (y2 - y0)^2);
        let attraction = g * (m0 * m1 / r01 + m1 * m2 / r12 + m2 * m0 / r20);
        let coupling = b * dot(x0) * dot(y1) * sin(x2) + b * x1 * dot(y2) * cos(w * t);
        L = (m0 * square0 + m1 * square1 + m2 * square2) / 2 + attraction + coupling - b * sin(w * t) * x0 * y2;
        force x0 = -c * dot(x0) * (1 + y1^2) + c * x2 * cos(w * t);
        force y1 = -c * dot(x2) * t;
        discretize midpoint;
    }
}

/// Both systems with the same parameters.
fn systems() -> (Handwritten, Generated) {
    let generated = Generated::default();
    (Handwritten(core::array::from_fn(|index| Lagrangian::<6>::parameter(&generated, index))), generated)
}

/// Deviations between two systems, with the function of the largest.
#[derive(Default)]
struct Deviation {
    name: &'static str,
    roundings: f64,
    compared: usize,
    may_vanish: bool,
}

impl Deviation {
    /// Compares vectors or matrices in roundings of their largest entry.
    fn compare<const R: usize, const C: usize>(
        &mut self,
        name: &'static str,
        found: &SMatrix<f64, R, C>,
        expected: &SMatrix<f64, R, C>,
    ) {
        self.compared += 1;
        if self.may_vanish && expected.amax() == 0.0 {
            return assert_eq!(found, expected, "{name}");
        }
        assert!(expected.amax() > 1e-5, "{name} is zero");
        assert!(found.iter().all(|entry| entry.is_finite()), "{name} is not finite");
        let roundings = (found - expected).amax() / (f64::EPSILON * expected.amax());
        if roundings > self.roundings {
            (self.name, self.roundings) = (name, roundings);
        }
    }

    fn matrices(&mut self, name: &'static str, found: &impl Matrix<6, f64>, expected: &impl Matrix<6, f64>) {
        self.compare(name, &found.dense(), &expected.dense());
    }

    fn numbers(&mut self, name: &'static str, found: f64, expected: f64) {
        self.compare(name, &SVector::from([found]), &SVector::from([expected]));
    }
}

const POINTS: [(f64, [f64; 6], [f64; 6]); 3] = [
    (0.7, [0.9, -0.6, -0.2, 0.3, 0.8, -1.1], [0.4, -0.7, 0.3, 0.8, -0.2, -0.5]),
    (-1.9, [2.1, -1.3, 0.6, -0.4, 1.9, -1.6], [-0.3, 0.5, 0.9, 0.6, -1.4, 0.2]),
    (31.0, [-0.5, 0.4, 1.3, 0.7, -0.9, 0.2], [1.7, 0.6, -0.8, -0.3, 0.4, 1.1]),
];

/// A system with all functions of steps.
trait Complete: Motion<6> + EnergyStepping<6> + DiscreteLagrangian<6> {}
impl<S: Motion<6> + EnergyStepping<6> + DiscreteLagrangian<6>> Complete for S {}

/// Compares the continuous functions.
fn compare_continuous(worst: &mut Deviation, ours: &impl Complete, theirs: &impl Complete) {
    for (t, q, v) in POINTS {
        let (q, v) = (q.into(), v.into());
        worst.numbers("lagrangian", ours.lagrangian(t, &q, &v), theirs.lagrangian(t, &q, &v));
        worst.numbers("energy", ours.energy(t, &q, &v), theirs.energy(t, &q, &v));
        worst.compare("momentum", &ours.momentum(t, &q, &v), &theirs.momentum(t, &q, &v));
        worst.compare("force", &ours.force(t, &q, &v), &theirs.force(t, &q, &v));
        worst.numbers("power", ours.power(t, &q, &v), theirs.power(t, &q, &v));
        let [a, b] = [ours.acceleration(t, &q, &v), theirs.acceleration(t, &q, &v)].map(|a| a.expect("acceleration"));
        worst.compare("acceleration", &a, &b);
        let [a, b] = [ours.step_density(t, &q, &v), theirs.step_density(t, &q, &v)].map(|d| d.expect("density"));
        worst.numbers("step density", a, b);

        let (a, b) = (ours.point(t, &q, &v), theirs.point(t, &q, &v));
        worst.compare("point: momentum", &a.momentum, &b.momentum);
        worst.compare("point: force", &a.force, &b.force);
        worst.matrices("point: mass", &a.mass, &b.mass);
        let (a, b) = (ours.point_derivatives(t, &q, &v), theirs.point_derivatives(t, &q, &v));
        worst.matrices("momentum_dq", &a.momentum_dq, &b.momentum_dq);
        worst.matrices("mass", &a.mass, &b.mass);
        worst.matrices("force_dq", &a.force_dq, &b.force_dq);
        worst.matrices("force_dv", &a.force_dv, &b.force_dv);

        let p = theirs.momentum(t, &q, &v);
        let [a, b] = [ours.flow(t, &q, &p), theirs.flow(t, &q, &p)].map(|flow| flow.expect("flow"));
        compare_flows(worst, &a, &b);
    }
}

fn compare_flows(worst: &mut Deviation, found: &Flow<6>, expected: &Flow<6>) {
    worst.compare("flow: v", &found.v, &expected.v);
    worst.compare("flow: force", &found.force, &expected.force);
    worst.numbers("flow: power", found.power, expected.power);
}

/// Compares the slots.
fn compare_slots(worst: &mut Deviation, ours: &impl Complete, theirs: &impl Complete) {
    for (t0, q0, v) in POINTS {
        for h in [0.1, -0.03, 0.5] {
            let (q0, v) = (Vector::from(q0), Vector::from(v));
            let at = Interval { t0, q0, t1: t0 + h, q1: q0 + v * h };
            worst.numbers("ld", ours.ld(&at), theirs.ld(&at));
            worst.numbers("d1_ld", ours.d1_ld(&at), theirs.d1_ld(&at));
            worst.compare("d2_ld", &ours.d2_ld(&at), &theirs.d2_ld(&at));
            worst.numbers("d3_ld", ours.d3_ld(&at), theirs.d3_ld(&at));
            worst.compare("d4_ld", &ours.d4_ld(&at), &theirs.d4_ld(&at));
            worst.compare("fd_minus", &ours.fd_minus(&at), &theirs.fd_minus(&at));
            worst.compare("fd_plus", &ours.fd_plus(&at), &theirs.fd_plus(&at));
            worst.numbers("gd_minus", ours.gd_minus(&at), theirs.gd_minus(&at));
            worst.numbers("gd_plus", ours.gd_plus(&at), theirs.gd_plus(&at));
        }
    }
}

/// Compares the derivatives of the momentum equation.
fn compare_derivatives(
    worst: &mut Deviation,
    found: &MomentumDerivatives<impl Matrix<6, f64>, impl Matrix<6, f64>>,
    expected: &MomentumDerivatives<impl Matrix<6, f64>, impl Matrix<6, f64>>,
) {
    worst.matrices("residual_dq", &found.residual_dq, &expected.residual_dq);
    worst.matrices("residual_dv", &found.residual_dv, &expected.residual_dv);
    worst.matrices("increment_dq", &found.increment_dq, &expected.increment_dq);
    worst.matrices("increment_dv", &found.increment_dv, &expected.increment_dv);
}

/// The smallest and the largest quotient.
fn widen(range: &mut [f64; 2], found: impl IntoIterator<Item = f64>) {
    for quotient in found {
        *range = [range[0].min(quotient), range[1].max(quotient)];
    }
}

/// Compares the step equations. Returns the ranges of quotients of rounding scales, and of rounding-error bounds.
fn compare_steps(worst: &mut Deviation, ours: &impl Complete, theirs: &impl Complete) -> [[f64; 2]; 2] {
    let (mut scales, mut bounds) = ([f64::INFINITY, 0.0], [f64::INFINITY, 0.0]);
    for (t, q, v) in POINTS {
        for h in [0.1, -0.03, 0.5] {
            // Not a root, so that no residual is zero, and with low parts that matter.
            let v = Vector::from(v);
            let state = State { t, q: q.into(), p: SVector::from([0.3, -0.8, 0.5, 0.7, -0.4, 0.9]) };
            let low = Vector::from_fn(|i, _| 1e-3 * (1.0 + 0.2 * f64::from(u8::try_from(i).expect("index"))));
            let node = Node { t_low: 2e-3, q_low: low, p_low: -low, energy_low: 3e-3, ..Node::new(state, -0.6) };

            let (a, b) = (ours.momentum_equation(&node, h, &v), theirs.momentum_equation(&node, h, &v));
            worst.compare("equation: residual", &a.residual, &b.residual);
            worst.matrices("equation: jacobian", &a.jacobian, &b.jacobian);
            let (a, b) = (ours.momentum_residual(&node, h, &v), theirs.momentum_residual(&node, h, &v));
            worst.compare("residual", &a.residual, &b.residual);
            worst.compare("increment", &a.increment, &b.increment);
            widen(&mut scales, a.scale.component_div(&b.scale).iter().copied());
            let (a, b) = (ours.momentum_rounding(&node, h, &v), theirs.momentum_rounding(&node, h, &v));
            widen(&mut bounds, a.component_div(&b).iter().copied());
            let (a, b) = (ours.momentum_derivatives(&node, h, &v), theirs.momentum_derivatives(&node, h, &v));
            compare_derivatives(worst, &a, &b);
            let (a, b) = (ours.discrete_energy(&node, h, &v), theirs.discrete_energy(&node, h, &v));
            worst.numbers("discrete energy", a, b);

            let (a, b) = (ours.extended_system(&node, h, &v), theirs.extended_system(&node, h, &v));
            worst.compare("extended: residual", &a.momentum.residual, &b.momentum.residual);
            worst.matrices("extended: jacobian", &a.momentum.jacobian, &b.momentum.jacobian);
            worst.compare("extended: residual_dh", &a.residual_dh, &b.residual_dh);
            worst.numbers("extended: energy residual", a.energy_residual, b.energy_residual);
            worst.compare("extended: energy_dv", &a.energy_dv, &b.energy_dv);
            worst.numbers("extended: energy_dh", a.energy_dh, b.energy_dh);
            let (a, b) = (ours.extended_residual(&node, h, &v), theirs.extended_residual(&node, h, &v));
            worst.compare("both: residual", &a.residual, &b.residual);
            worst.numbers("both: energy residual", a.energy_residual, b.energy_residual);
            worst.compare("both: momentum increment", &a.increment.momentum, &b.increment.momentum);
            worst.numbers("both: energy increment", a.increment.energy, b.increment.energy);
            widen(&mut scales, a.scale.component_div(&b.scale).iter().copied());
            widen(&mut scales, [a.energy_scale / b.energy_scale]);
            let (a, b) = (ours.extended_rounding(&node, h, &v), theirs.extended_rounding(&node, h, &v));
            widen(&mut bounds, a.residual.component_div(&b.residual).iter().copied());
            widen(&mut bounds, [a.energy_residual / b.energy_residual, a.energy / b.energy]);
            let (a, b) = (ours.extended_derivatives(&node, h, &v), theirs.extended_derivatives(&node, h, &v));
            compare_derivatives(worst, &a.momentum, &b.momentum);
            worst.compare("residual_dh", &a.residual_dh, &b.residual_dh);
            worst.compare("increment_dh", &a.increment_dh, &b.increment_dh);
            worst.compare("energy_dq", &a.energy_dq, &b.energy_dq);
            worst.compare("energy_dv", &a.energy_dv, &b.energy_dv);
            worst.numbers("energy_dh", a.energy_dh, b.energy_dh);
            worst.compare("energy_increment_dq", &a.energy_increment_dq, &b.energy_increment_dq);
            worst.compare("energy_increment_dv", &a.energy_increment_dv, &b.energy_increment_dv);
            worst.numbers("energy_increment_dh", a.energy_increment_dh, b.energy_increment_dh);
        }
    }
    [scales, bounds]
}

#[test]
fn the_continuous_functions_are_those_of_generated_code() {
    let ((ours, theirs), mut worst) = (systems(), Deviation::default());
    compare_continuous(&mut worst, &ours, &theirs);
    let rounded = ours.convert::<Rounded>();
    for (t, q, v) in POINTS {
        let q = q.into();
        let p = theirs.momentum(t, &q, &v.into());
        let found = indexed::flow_by_iteration(&ours, &rounded, t, &q, &p).expect("flow");
        compare_flows(&mut worst, &found, &theirs.flow(t, &q, &p).expect("flow"));
    }
    assert_eq!(worst.compared, 20 * POINTS.len());
    // Measured: at most 17.7, of an energy whose terms cancel.
    assert!(worst.roundings < 40.0, "{}: {}", worst.name, worst.roundings);
}

#[test]
fn the_slots_are_those_of_generated_code() {
    let ((ours, theirs), mut worst) = (systems(), Deviation::default());
    compare_slots(&mut worst, &ours, &theirs);
    assert_eq!(worst.compared, 9 * 3 * POINTS.len());
    // Measured: at most 33.5, of an energy whose terms cancel.
    assert!(worst.roundings < 70.0, "{}: {}", worst.name, worst.roundings);
}

#[test]
fn the_step_equations_are_those_of_generated_code() {
    let ((ours, theirs), mut worst) = (systems(), Deviation::default());
    let [scales, bounds] = compare_steps(&mut worst, &ours, &theirs);
    assert_eq!(worst.compared, 31 * 3 * POINTS.len());
    // Measured: at most 7.4.
    assert!(worst.roundings < 15.0, "{}: {}", worst.name, worst.roundings);
    // Measured: 0.83 to 1.
    assert!(scales[0] > 0.6 && scales[1] < 1.2, "{scales:?}");
    // Measured: 0.90 to 3.07. Dual numbers multiply by zeros and ones, which count as operations.
    assert!(bounds[0] > 0.6 && bounds[1] < 5.0, "{bounds:?}");
}

#[test]
fn an_autonomous_system_without_a_force_skips_zeros_only() {
    let (mut ours, _) = systems();
    for name in ["w", "c"] {
        *ours.parameter_mut(name).expect("a parameter") = 0.0;
    }
    let closed = Handwritten::<f64, false>(ours.0);
    let mut worst = Deviation { may_vanish: true, ..Deviation::default() };
    compare_continuous(&mut worst, &closed, &ours);
    compare_slots(&mut worst, &closed, &ours);
    let [scales, bounds] = compare_steps(&mut worst, &closed, &ours);
    assert_eq!(worst.compared, (17 + 9 * 3 + 31 * 3) * POINTS.len());
    // Measured: 0.
    assert!(worst.roundings < 1.0, "{}: {}", worst.name, worst.roundings);
    assert!(scales.iter().all(|quotient| (quotient - 1.0).abs() < f64::EPSILON), "{scales:?}");
    // Measured: 0.985 to 0.9999: fewer operations.
    assert!(bounds[0] > 0.9 && bounds[1] < 1.0, "{bounds:?}");
}

/// The states of 200 steps.
fn states<S: Lagrangian<6> + Copy, M: Method<S, 6>>(system: S, method: M, h: f64) -> Vec<State<6>>
where
    Run<M, S, 6>: Iterator<Item = Result<State<6>, StepError>>,
{
    let start = system.at(0.2, [2.1, -1.3, 0.6, -0.4, 1.9, -1.6], [0.2, 0.3, -0.4, 0.5, -0.3, -0.2]);
    let run = start.integrate(method, h).expect("a run");
    run.take(200).map(|state| state.expect("a step")).collect()
}

/// Largest difference of two runs, relative to the largest coordinate or momentum.
fn largest_difference(found: &[State<6>], expected: &[State<6>]) -> f64 {
    assert_eq!([found.len(), expected.len()], [200; 2]);
    let moved = (expected[199].q - expected[0].q).amax();
    assert!(moved > 0.1, "the bodies rest: {moved}");
    let difference = |(a, b): (&State<6>, &State<6>)| {
        let size = b.q.amax().max(b.p.amax());
        (a.t - b.t).abs().max((a.q - b.q).amax()).max((a.p - b.p).amax()) / size
    };
    found.iter().zip(expected).map(difference).fold(0.0, f64::max)
}

#[test]
fn the_runs_are_those_of_generated_code() {
    let (ours, theirs) = systems();
    let fixed = largest_difference(&states(ours, FixedStep, 0.01), &states(theirs, FixedStep, 0.01));
    let gauss = largest_difference(&states(ours, Gauss::<3>, 0.02), &states(theirs, Gauss::<3>, 0.02));
    let h = 0.01;
    let preserving = largest_difference(&states(ours, EnergyPreserving, h), &states(theirs, EnergyPreserving, h));
    // Measured: 1.1e-16, 9.5e-16 and 7.4e-12. A rounding of the energy E changes a length by about 4 E ε/(h D).
    assert!(fixed < 5e-15, "{fixed:e}");
    assert!(gauss < 5e-15, "{gauss:e}");
    assert!(preserving < 3e-11, "{preserving:e}");
}
