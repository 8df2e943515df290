//! Sensitivities of steps and runs: against dual numbers and differences, adjoints, exponents.

use crate::gauss::Everything;
use nalgebra::{DMatrix, DVector};
use vi_core::derivatives::{Covector, Differentiable, Lyapunov, Objective, Tangent, Variation, gradient};
use vi_core::linear::Matrix;
use vi_core::node::Node;
use vi_core::real::Dual;
use vi_core::stepping::{Convertible, FixedStepping};
use vi_core::{
    Composition, EnergyPreserving, FixedStep, Gauss, Lagrangian, Method, Run, SVector, Starts, State, StepError,
    nalgebra,
};
use vi_systems::{DoublePendulum, DoubleWell, DoubleWellDuffing, HenonHeiles, Pendulum};

/// The columns of the tangent map over `steps` steps.
fn tangent_map<M: Differentiable<S, N>, S: Convertible<N>, const N: usize>(
    run: Run<M, S, N>,
    steps: usize,
) -> (Run<M, S, N>, DMatrix<f64>) {
    let mut tangent = Tangent::new(run, Variation::of_state());
    for _ in 0..steps {
        tangent.step().expect("solvable");
    }
    let column = |variation: &Variation<N>| {
        let entries = variation.q.iter().chain(variation.p.iter()).copied();
        DVector::from_iterator(2 * N, entries)
    };
    let columns: Vec<_> = tangent.variations().iter().map(column).collect();
    (tangent.run().clone(), DMatrix::from_columns(&columns))
}

/// The node after a step solved in dual numbers from the start, without the implicit function theorem.
fn solved_in_duals<S: FixedStepping<N, Dual<f64>>, const N: usize>(
    system: &S,
    node: &mut Node<N, Dual<f64>>,
    h: f64,
    v: &mut SVector<Dual<f64>, N>,
) {
    let h = Dual::fixed(h);
    for _ in 0..20 {
        let equation = system.momentum_equation(node, h, v);
        *v -= equation.jacobian.solve(&equation.residual);
    }
    let increment = system.momentum_residual(node, h, v).increment;
    node.advance(h, v, &increment);
}

#[test]
fn variations_are_those_of_a_run_in_dual_numbers() {
    let system = Everything { a: 1.1, c: 0.3, w: 0.9 };
    let start = State::at(&system, 0.2, [0.6, -0.4], [0.3, 0.5]);
    let mut variations = Variation::of_state();
    variations.extend(["a", "c", "w"].map(|name| Variation::of_parameter::<Everything>(name).expect("a parameter")));
    variations.push(Variation { t: 1.0, ..Variation::zero() });
    assert_eq!(variations.len(), 8);
    let mut tangent =
        Tangent::new(system.at_state(start).integrate(FixedStep, 0.1).expect("valid"), variations.clone());
    for _ in 0..100 {
        tangent.step().expect("solvable");
    }
    for (variation, found) in variations.iter().zip(tangent.variations()) {
        let mut dual = Convertible::<2>::convert::<Dual<f64>>(&system);
        for (parameter, slope) in [&mut dual.a, &mut dual.c, &mut dual.w].into_iter().zip(&variation.parameters) {
            parameter.slope = *slope;
        }
        let mut node = Node::new(start, 0.0).map_to_dual();
        node.t.slope = variation.t;
        for k in 0..2 {
            node.q[k].slope = variation.q[k];
            node.p[k].slope = variation.p[k];
        }
        let mut v = SVector::from([Dual::fixed(0.0); 2]);
        for _ in 0..100 {
            solved_in_duals(&dual, &mut node, 0.1, &mut v);
        }
        for k in 0..2 {
            let error = (found.q[k] - node.q[k].slope).abs() + (found.p[k] - node.p[k].slope).abs();
            let size = 1.0 + found.q.norm() + found.p.norm();
            // 1.4e-15.
            assert!(error < 5e-15 * size, "{variation:?}: {error}");
        }
        assert!(found.q.norm() > 1e-3, "{variation:?} changes nothing");
    }
}

trait ToDual<const N: usize> {
    fn map_to_dual(&self) -> Node<N, Dual<f64>>;
}

impl<const N: usize> ToDual<N> for Node<N> {
    fn map_to_dual(&self) -> Node<N, Dual<f64>> {
        let State { t, q, p } = self.state();
        Node::new(State { t: Dual::fixed(t), q: q.map(Dual::fixed), p: p.map(Dual::fixed) }, Dual::fixed(0.0))
    }
}

#[test]
fn an_energy_preserving_step_varies_in_its_length() {
    let system = Everything::default();
    let (h, v) = (0.05, SVector::from([0.3, 0.5]));
    let first = EnergyPreserving::from_midpoint(system, 0.1, [0.6, -0.4], v, h).expect("valid");
    let state = first.state();
    let energy = first.node().energy;
    let begin = |q: SVector<f64, 2>, p: SVector<f64, 2>, e: f64, a: f64| {
        let state = State { q: state.q + q, p: state.p + p, ..state };
        let system = Everything { a: 1.4 + a, ..system };
        EnergyPreserving::from_state(system, state, energy + e, h, v).expect("valid")
    };
    let zeros = SVector::zeros();
    let mut variations = Variation::of_state();
    variations.push(Variation { energy: 1.0, ..Variation::zero() });
    variations.push(Variation::of_parameter::<Everything>("a").expect("a parameter"));
    let mut tangent = Tangent::new(begin(zeros, zeros, 0.0, 0.0), variations.clone());
    for _ in 0..4 {
        tangent.step().expect("solvable");
    }
    let mut lengths = 0.0_f64;
    for (variation, found) in variations.iter().zip(tangent.variations()) {
        let shift = |s: f64| {
            let a = if variation.parameters.is_empty() { 0.0 } else { s };
            let mut run = begin(variation.q * s, variation.p * s, variation.energy * s, a);
            for _ in 0..4 {
                run.step().expect("solvable");
            }
            (run.state(), run.node().energy)
        };
        // The length follows from a small difference: only small perturbations are linear.
        let s = 2e-6;
        let [(a, ea), (b, eb), (c, ec), (d, ed)] = [s, -s, 2.0 * s, -2.0 * s].map(shift);
        let richardson = |a: f64, b: f64, c: f64, d: f64| (8.0 * (a - b) - (c - d)) / (12.0 * s);
        let mut error = (richardson(a.t, b.t, c.t, d.t) - found.t).abs();
        error += (richardson(ea, eb, ec, ed) - found.energy).abs();
        let mut size = 1.0 + found.t.abs() + found.energy.abs();
        for k in 0..2 {
            error += (richardson(a.q[k], b.q[k], c.q[k], d.q[k]) - found.q[k]).abs();
            error += (richardson(a.p[k], b.p[k], c.p[k], d.p[k]) - found.p[k]).abs();
            size += found.q[k].abs() + found.p[k].abs();
        }
        lengths = lengths.max(found.t.abs());
        // 1.1e-10.
        assert!(error < 1e-9 * size, "{variation:?}: {error} of {size}");
    }
    assert!(lengths > 1.0, "the lengths vary: {lengths}");
    let fallen = first.with_fallback(vi_core::Fallback::FixedSteps);
    let refused = Tangent::new(fallen, Variation::of_state()).step();
    assert!(matches!(refused, Err(StepError::NoDerivative { .. })), "{refused:?}");
}

/// The squared distances from a trajectory, at every node.
struct SquaredDistances;

impl<M: Method<Everything, 2>> Objective<M, Everything, 2> for SquaredDistances {
    fn prepare(&self, step: u64, run: &mut Run<M, Everything, 2>) -> Result<(), StepError> {
        #[allow(clippy::cast_precision_loss)] // a few steps
        let step = step as f64;
        run.set_parameters(|system| system.c = 0.1 + 0.05 * step.sin())
    }

    fn parameters(&self) -> &[&str] {
        &["a", "c", "w"]
    }

    fn slope(&self, step: u64, state: &State<2>) -> Covector<2> {
        let weight = if step.is_multiple_of(3) { 1.0 } else { 0.5 };
        Covector { t: weight, q: state.q * (2.0 * weight), p: state.p * weight, ..Covector::zero() }
    }
}

/// The direction of the time.
fn of_time<const N: usize>() -> Variation<N> {
    Variation { t: 1.0, ..Variation::zero() }
}

#[test]
fn adjoint_and_tangent_agree() {
    fn worst<M: Differentiable<Everything, 2>>(run: &Run<M, Everything, 2>, steps: u64) -> f64 {
        let mut all: Vec<_> =
            [1, 5, 1000].map(|kept| gradient(run, steps, kept, &SquaredDistances).expect("solvable")).into();
        let found = all.pop().expect("three");
        // For any number of stored runs.
        assert!(all.iter().all(|other| *other == found));
        let mut variations = Variation::of_state();
        variations
            .extend(["a", "c", "w"].map(|name| Variation::of_parameter::<Everything>(name).expect("a parameter")));
        variations.push(of_time());
        let mut forward = vec![0.0; variations.len()];
        let mut run = run.clone();
        let mut varied = variations.clone();
        for step in 0..=steps {
            let slope = Objective::<M, Everything, 2>::slope(&SquaredDistances, step, &run.state());
            for (sum, variation) in forward.iter_mut().zip(&varied) {
                *sum += slope.of(variation);
            }
            if step < steps {
                SquaredDistances.prepare(step, &mut run).expect("regular");
                let before = *run.node();
                run.step().expect("solvable");
                run.vary(&before, &mut varied).expect("regular");
            }
        }
        assert_eq!(found.parameters.len(), usize::try_from(steps).expect("a few"));
        let of_parameter = |index: usize| found.parameters.iter().map(|row| row[index]).sum::<f64>();
        let start = &found.start;
        let of_state = [start.q[0], start.q[1], start.p[0], start.p[1]];
        let of_parameters = [0, 1, 2].map(of_parameter);
        let backward = of_state.into_iter().chain(of_parameters).chain([start.t]);
        let size = forward.iter().fold(1.0_f64, |size, entry| size.max(entry.abs()));
        assert!(size > 10.0);
        forward.iter().zip(backward).map(|(one, other)| (one - other).abs() / size).fold(0.0, f64::max)
    }
    let system = Everything::default();
    let start = State::at(&system, 0.1, [0.6, -0.4], [0.3, 0.5]);
    let errors = [
        worst(&system.at_state(start).integrate(FixedStep, 0.1).expect("valid"), 47),
        worst(&system.at_state(start).integrate(Gauss::<3>, 0.3).expect("valid"), 20),
        worst(&system.at_state(start).integrate(Composition::SUZUKI_4, 0.2).expect("valid"), 23),
    ];
    // 3.6e-16.
    assert!(errors.into_iter().all(|error| error < 2e-15), "{errors:?}");
    let none = gradient(&system.at_state(start).integrate(FixedStep, 0.1).expect("valid"), 0, 3, &SquaredDistances)
        .expect("nothing to take");
    assert!(none.parameters.is_empty() && (none.start.q - start.q * 2.0).norm() < 1e-15);
}

/// The squares of the times and of the coordinates of all nodes.
struct Squares;

impl<M: Method<S, 1>, S> Objective<M, S, 1> for Squares {
    fn slope(&self, _step: u64, state: &State<1>) -> Covector<1> {
        Covector { t: 2.0 * state.t, q: state.q * 2.0, ..Covector::zero() }
    }
}

#[test]
fn the_time_of_an_autonomous_run_is_carried_back() {
    /// The largest difference between the gradient and propagated tangent vectors, and the derivative with respect to
    /// the initial time.
    fn worst<M, S>(run: &Run<M, S, 1>, steps: u64) -> (f64, f64)
    where
        M: Differentiable<S, 1>,
        S: Convertible<1>,
    {
        let start = gradient(run, steps, 3, &Squares).expect("solvable").start;
        let mut varied = Variation::of_state();
        varied.extend([of_time(), Variation { energy: 1.0, ..Variation::zero() }]);
        let mut run = run.clone();
        let mut forward = [0.0; 4];
        for step in 0..=steps {
            let slope = Objective::<M, S, 1>::slope(&Squares, step, &run.state());
            for (sum, variation) in forward.iter_mut().zip(&varied) {
                *sum += slope.of(variation);
            }
            if step < steps {
                let before = *run.node();
                run.step().expect("solvable");
                run.vary(&before, &mut varied).expect("regular");
            }
        }
        let size = forward.iter().fold(0.0_f64, |size, entry| size.max(entry.abs()));
        let backward =
            [start.q[0], start.p[0], start.t, if run.method().keeps_energy() { start.energy } else { forward[3] }];
        let off = forward.iter().zip(backward).map(|(one, other)| (one - other).abs() / size).fold(0.0, f64::max);
        (off, start.t)
    }
    let well = DoubleWell::default();
    let start = State::at(&well, 0.5, [0.74], [0.1]);
    let fixed = worst(&well.at_state(start).integrate(FixedStep, 0.05).expect("valid"), 20);
    let gauss = worst(&well.at_state(start).integrate(Gauss::<4>, 0.1).expect("valid"), 20);
    let energy = EnergyPreserving::from_midpoint(well, 0.5, [1.2], [0.3], 0.1).expect("valid");
    // The length of a step changes with the energy by as much as 1/h²: a few long steps.
    let energy = worst(&energy, 6);
    println!("off by {:.1e}, {:.1e}, {:.1e}", fixed.0, gauss.0, energy.0);
    // Σ 2 t_k at times from 0.5 to 1.5, in steps of 0.05.
    assert!((fixed.1 - 42.0).abs() < 1e-12, "{}", fixed.1);
    for (off, by_time) in [fixed, gauss, energy] {
        // Measured: 7.8e-16.
        assert!(off < 2e-15 && by_time > 5.0, "{off:e}, {by_time}");
    }
}

#[test]
fn exponents_of_a_saddle() {
    // An inverted pendulum at rest leaves its position as exp(ω t), and a Gauss run with the stability function of its
    // method.
    let pendulum = Pendulum { m: 1.3, l: 0.5, g: 4.5 };
    let top = State::at(&pendulum, 0.0, [core::f64::consts::PI], [0.0]);
    let run = pendulum.at_state(State { p: SVector::zeros(), ..top }).integrate(Gauss::<6>, 0.1).expect("valid");
    let mut lyapunov = Lyapunov::new(run, 2).expect("two");
    let mut growth = [[0.0; 2]; 2];
    for part in &mut growth {
        lyapunov.advance(40).expect("solvable");
        let exponents = lyapunov.exponents();
        *part = [exponents[0], exponents[1]].map(|exponent| exponent * lyapunov.run().t());
    }
    // ω = 3. The component of the other directions has decayed after four units of time: 3.4e-13.
    let rates = [0, 1].map(|k| (growth[1][k] - growth[0][k]) / 4.0);
    assert!((rates[0] - 3.0).abs() < 1e-12 && (rates[1] + 3.0).abs() < 1e-12, "{rates:?}");
}

/// The largest exponent from two motions whose distance is rescaled after every step.
fn separated<M: Method<S, N>, S: Lagrangian<N> + Copy, const N: usize>(run: &Run<M, S, N>, steps: u32) -> f64 {
    const NEAR: f64 = 1e-7;
    let mut run = run.clone();
    let begin = run.t();
    let mut q = SVector::<f64, N>::repeat(NEAR);
    let mut p = SVector::<f64, N>::zeros();
    let mut growth = 0.0;
    for _ in 0..steps {
        let at = run.state();
        let mut neighbour = run.clone();
        neighbour.set_state(State { q: at.q + q, p: at.p + p, ..at }).expect("valid");
        let reached = neighbour.step().expect("solvable");
        let state = run.step().expect("solvable");
        q = reached.q - state.q;
        p = reached.p - state.p;
        let distance = q.norm().hypot(p.norm());
        growth += (distance / NEAR).ln();
        q *= NEAR / distance;
        p *= NEAR / distance;
    }
    growth / (run.t() - begin)
}

/// Exponents of three chaotic motions over these tenths of 40 000, 40 000 and 20 000 steps, against the separation of
/// neighbours.
fn exponents_agree_with_separations(tenths: u32, [separation, pairing]: [f64; 2]) {
    fn both<M: Differentiable<S, N>, S: Convertible<N>, const N: usize>(
        run: &Run<M, S, N>,
        steps: u32,
    ) -> (Vec<f64>, f64) {
        let mut lyapunov = Lyapunov::new(run.clone(), 2 * N).expect("all");
        lyapunov.advance(u64::from(steps)).expect("solvable");
        (lyapunov.exponents(), separated(run, steps))
    }
    let duffing = DoubleWellDuffing { amplitude: 0.5, ..DoubleWellDuffing::default() };
    let run = duffing.at(0.0, [0.8], [0.0]).integrate(Gauss::<6>, 0.1).expect("valid");
    let (driven, of_driven) = both(&run, 4000 * tenths);
    let stars = HenonHeiles::default();
    let energy = 1.0 / 6.0;
    let p_x = (2.0_f64 * energy - 0.01 - 2.0e-3 / 3.0).sqrt();
    let chaotic = State { t: 0.0, q: SVector::from([0.0, -0.1]), p: SVector::from([p_x, 0.0]) };
    assert!((chaotic.energy(&stars).expect("regular") - energy).abs() < 1e-15);
    let (galaxy, of_galaxy) = both(&stars.at_state(chaotic).integrate(Gauss::<6>, 0.4).expect("valid"), 4000 * tenths);
    let pendula = DoublePendulum::default();
    let start = State::at(&pendula, 0.0, [2.0, 2.0], [0.0, 0.0]);
    let (swinging, of_swinging) =
        both(&pendula.at_state(start).integrate(Gauss::<6>, 0.02).expect("valid"), 2000 * tenths);
    for (found, other) in [(driven[0], of_driven), (galaxy[0], of_galaxy), (swinging[0], of_swinging)] {
        println!("{found} {other}");
        assert!(found > 0.05 && (found / other - 1.0).abs() < separation, "{found} {other}");
    }
    // Damping contracts volumes at the rate c; otherwise they are preserved. Exponents come in pairs.
    assert!((driven.iter().sum::<f64>() + duffing.c).abs() < 1e-9, "{driven:?}");
    for pairs in [galaxy, swinging] {
        assert!((pairs[0] + pairs[3]).abs() + (pairs[1] + pairs[2]).abs() < pairing, "{pairs:?}");
        assert!(pairs.iter().sum::<f64>().abs() < 1e-10, "{pairs:?}");
    }
}

/// Off by 7e-3, 3e-3 and 5.0e-2; pairs by 1.1e-2.
#[test]
fn exponents_of_chaotic_motion() {
    exponents_agree_with_separations(1, [6e-2, 2e-2]);
}

/// 0.0964, 0.1121 and 1.397; off by 7e-4, 4e-4 and 4e-3.
#[test]
#[ignore = "many steps: `.ci/run nightly`"]
fn exponents_of_chaotic_motion_for_long() {
    exponents_agree_with_separations(10, [1e-2, 1e-2]);
}

/// The coordinate after some steps, with the parameter a as an input of each step.
struct Driven {
    inputs: [f64; 12],
}

impl<M: Method<Everything, 2>> Objective<M, Everything, 2> for Driven {
    fn prepare(&self, step: u64, run: &mut Run<M, Everything, 2>) -> Result<(), StepError> {
        let input = self.inputs[usize::try_from(step).unwrap_or(usize::MAX)];
        run.set_parameters(|system| system.a = input)
    }

    fn parameters(&self) -> &[&str] {
        &["a"]
    }

    fn slope(&self, step: u64, _: &State<2>) -> Covector<2> {
        let last = if step == 12 { 1.0 } else { 0.0 };
        Covector { q: SVector::from([last, 0.5 * last]), ..Covector::zero() }
    }
}

impl Driven {
    fn value<M: Method<Everything, 2>>(&self, run: &Run<M, Everything, 2>) -> f64 {
        let mut run = run.clone();
        for step in 0..12 {
            self.prepare(step, &mut run).expect("regular");
            run.step().expect("solvable");
        }
        run.state().q[0] + 0.5 * run.state().q[1]
    }
}

#[test]
fn gradients_of_inputs_that_bring_energy() {
    fn worst<M: Differentiable<Everything, 2>>(run: &Run<M, Everything, 2>) -> f64 {
        let inputs = [0.0, 8.4, 9.1, 1.4, -7.6, -9.6, -2.8, 6.6, 9.9, 4.1, -5.4, -10.0].map(|part| 1.4 + 1e-3 * part);
        let found = gradient(run, 12, 3, &Driven { inputs }).expect("solvable");
        let mut worst = 0.0_f64;
        for step in 0..12 {
            let value = |change: f64| {
                let mut inputs = inputs;
                inputs[step] += change;
                Driven { inputs }.value(run)
            };
            let difference = (value(1e-4) - value(-1e-4)) / 2e-4;
            assert!(difference.abs() > 1e-6, "step {step} changes nothing");
            worst = worst.max((found.parameters[step][0] - difference).abs() / difference.abs());
        }
        // The start: another state has the energy H, for any preserved quantity.
        let start = run.state();
        let value = |dp: f64| {
            let mut run = run.clone();
            run.set_state(State { p: start.p + SVector::from([dp, 0.0]), ..start }).expect("valid");
            Driven { inputs }.value(&run)
        };
        let v = run.velocity().expect("regular");
        let difference = (value(1e-5) - value(-1e-5)) / 2e-5;
        worst.max((found.start.p[0] + found.start.energy * v[0] - difference).abs() / difference.abs())
    }
    let system = Everything::default();
    let start = State::at(&system, 0.1, [0.6, -0.4], [0.3, 0.5]);
    let kept = EnergyPreserving::from_midpoint(system, 0.1, [0.6, -0.4], [0.3, 0.5], 0.05).expect("valid");
    let errors = [worst(&system.at_state(start).integrate(FixedStep, 0.1).expect("valid")), worst(&kept)];
    // 5.2e-9 and 1.8e-8: the error of the differences.
    assert!(errors.into_iter().all(|error| error < 1e-7), "{errors:?}");
}

#[test]
fn exponents_of_steps_that_find_their_length_are_those_of_the_tangent_map() {
    // With time dependence and force, a direction includes time and energy.
    let run =
        EnergyPreserving::from_midpoint(Everything::default(), 0.1, [0.6, -0.4], [0.3, 0.5], 0.02).expect("valid");
    let mut lyapunov = Lyapunov::new(run.clone(), 4).expect("all");
    lyapunov.advance(20).expect("solvable");
    let (end, map) = tangent_map(run.clone(), 20);
    let found = lyapunov.exponents().iter().sum::<f64>() * (end.t() - run.t());
    let volume = map.determinant().abs().ln();
    // 3.5, to 5.1e-12.
    assert!(volume.abs() > 1e-3 && (found - volume).abs() < 5e-11, "{found} {volume}");
}
