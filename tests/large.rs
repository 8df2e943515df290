//! Large systems in loops against the same systems in straight lines, with few entries: `#[vi_limit(0)]` asks for loops.

use std::thread;
use vi_core::check::{self, Place};
use vi_core::constrained::Extended;
use vi_core::kind::{Bound, Form};
use vi_core::lagrangian::Space;
use vi_core::linear::{Matrix, Rectangular};
use vi_core::motion::Motion;
use vi_core::nalgebra::SMatrix;
use vi_core::node::Node;
use vi_core::prelude::*;
use vi_core::rules::{By, Midpoint, Own, Trapezoidal};
use vi_core::stepping::{Convertible, Discretized, EnergyStepping, FixedStepping};
use vi_core::{DiscreteLagrangian, Interval, Lagrangian, SVector, Starts};

/// A system twice.
macro_rules! twice {
    ($lines:ident $loops:ident { $($tokens:tt)* }) => {
        lagrangian! { struct $lines { $($tokens)* } }
        lagrangian! { #[vi_limit(0)] struct $loops { $($tokens)* } }
    };
}

twice! { BodiesInLines BodiesInLoops {
    const N = 4;
    param m[N] = [0.3, 1.2, 0.9, 0.5], G = 1.3, b = 0.2;
    coord r[N][3];
    let v2[i in 0..N] = dot(r[i]) * dot(r[i]);
    let pull[i in 0..N] = m[i] * sum(j in 0..i, m[j] / norm(r[i] - r[j]));
    L = sum(i in 0..N, m[i] * v2[i]) / 2 + G * sum(i in 0..N, pull[i]) + sin(t) * sum(i in 0..N, m[i] * r[i][0] * dot(r[i][1])) / 10;
    force r[i in 0..N] = [-b * dot(r[i][0]) * r[i][1], cos(t), -b * dot(r[i][2])];
    discretize midpoint, trapezoidal;
} }

// Links in air, with friction in their joints, that grow heavier.
twice! { DragInLines DragInLoops {
    const N = 5;
    param m[N] = [0.3, 1.2, 0.9, 0.5, 0.7], l[N] = [0.3, 0.5, 0.4, 0.2, 0.6], g = 9.81, b = 0.1, c = 0.3, k = 0.05;
    coord q[N];
    let x[0] = l[0] * sin(q[0]);
    let x[i in 1..N] = x[i - 1] + l[i] * sin(q[i]);
    let y[i in 0..N] = -sum(j in 0..i + 1, l[j] * cos(q[j]));
    let bend[i in 1..N] = q[i] - q[i - 1];
    L = sum(i in 0..N, m[i] * (1 + t / 10) * (dot(x[i])^2 + dot(y[i])^2) / 2 - m[i] * g * y[i]);
    force q[i in 0..N] = sin(q[i]) * cos(t);
    dissipation = c * sum(i in 0..N, (2 + sin(x[i])) * (dot(x[i])^2 + dot(y[i])^2)^2) + b * sum(i in 1..N, dot(bend[i])^2) / 2
        + k * sum(i in 0..N, dot(q[i])^4);
    discretize midpoint, trapezoidal;
} }

// Bodies in transformed time: a function of two sums, of a recursion, of one coordinate and of time.
twice! { ScaledInLines ScaledInLoops {
    const N = 4;
    param m[N] = [0.3, 1.2, 0.9, 0.5], G = 1.3, e = 0.2;
    coord r[N][2];
    let V = sum(i in 0..N, sum(j in 0..i, m[i] * m[j] / sqrt((r[i] - r[j]) * (r[i] - r[j]) + e^2)));
    let far[0] = r[0][0]^2;
    let far[i in 1..N] = far[i - 1] + r[i][0]^2 + t * r[i][1]^2 / 10;
    L = sum(i in 0..N, m[i] * dot(r[i]) * dot(r[i])) / 2 + G * V;
    time_scale = 1 / sqrt(V^3 + sum(i in 0..N, r[i] * r[i]) * (2 + cos(r[1][0]))) + e * ln(1 + far[N - 1]);
    discretize midpoint;
} }

twice! { LinksInLines LinksInLoops {
    const N = 8;
    param m[N] = [0.3, 1.2, 0.9, 0.5, 0.7, 0.4, 1.1, 0.8], l[N] = [0.3, 0.5, 0.4, 0.2, 0.6, 0.3, 0.2, 0.4], g = 9.81, b = 0.1;
    coord q[N];
    let x[0] = l[0] * sin(q[0]);
    let x[i in 1..N] = x[i - 1] + l[i] * sin(q[i]);
    let y[i in 0..N] = -sum(j in 0..i + 1, l[j] * cos(q[j]));
    L = sum(i in 0..N, m[i] * (dot(x[i])^2 + dot(y[i])^2) / 2 - m[i] * g * y[i]);
    force q[i in 0..N] = -b * dot(q[i]) + cos(x[i]) * dot(y[i]) / 20;
    discretize midpoint, trapezoidal;
} }

twice! { PendulumInLines PendulumInLoops {
    const N = 9;
    param m = 1.2, l = 0.3, g = 9.81;
    coord θ[N];
    let alone = sum(i in 0..N, (N - i) * dot(θ[i])^2) / 2;
    let pairs = sum(i in 1..N, (N - i) * sum(j in 0..i, dot(θ[i]) * dot(θ[j]) * cos(θ[i] - θ[j])));
    L = m * l^2 * (alone + pairs) + m * g * l * sum(i in 0..N, (N - i) * cos(θ[i]));
    discretize midpoint;
} }

// A chain of vectors, each relative to the one before, with a velocity that enters by its square root.
twice! { ArmInLines ArmInLoops {
    const N = 4;
    param m = 0.7, l = 0.4, g = 9.81, c = 5.0;
    coord a[N], b[N];
    let r[0] = l * [sin(a[0]) * cos(b[0]), sin(a[0]) * sin(b[0]), cos(a[0])];
    let r[i in 1..N] = r[i - 1] + l * [sin(a[i]) * cos(b[i]), sin(a[i]) * sin(b[i]), cos(a[i])];
    L = sum(i in 0..N, -m * c^2 * sqrt(1 - dot(r[i]) * dot(r[i]) / c^2) - m * g * r[i][2]);
    discretize midpoint;
} }

// Explicit steps: a constant diagonal mass matrix, and forces of positions and time.
twice! { CloudInLines CloudInLoops {
    const N = 5;
    param m[N] = [0.3, 1.2, 0.9, 0.5, 0.7], k = 0.8, w = 1.7;
    coord r[N][2];
    let v2[i in 0..N] = dot(r[i]) * dot(r[i]);
    L = sum(i in 0..N, m[i] * v2[i]) / 2 - k * sum(i in 0..N, sum(j in 0..i, m[i] * m[j] * norm(r[i] - r[j])^3))
        + cos(w * t) * sum(i in 0..N, r[i][0]);
    force r[i in 0..N] = [r[i][1] / 3, -m[i] * sin(t)];
    discretize trapezoidal;
} }

// Links that turn over, by their angles modulo 2π.
twice! { WheelsInLines WheelsInLoops {
    const N = 6;
    param m[N] = [0.3, 1.2, 0.9, 0.5, 0.7, 0.4], l[N] = [0.3, 0.5, 0.4, 0.2, 0.6, 0.3], g = 9.81, b = 0.1;
    angle q[N];
    let x[0] = l[0] * sin(q[0]);
    let x[i in 1..N] = x[i - 1] + l[i] * sin(q[i]);
    let y[i in 0..N] = -sum(j in 0..i + 1, l[j] * cos(q[j]));
    L = sum(i in 0..N, m[i] * (dot(x[i])^2 + dot(y[i])^2) / 2 - m[i] * g * y[i]);
    force q[i in 0..N] = -b * sin(q[i] - q[0]);
    discretize trapezoidal, midpoint;
} }

twice! { LimitsInLines LimitsInLoops {
    const N = 4;
    param c = 0.3;
    coord x[N], y[N];
    L = sum(i in 0..N, dot(x[i])^2 + dot(y[i])^2) / 2 - c * sum(i in 0..N, x[i] * y[i] / sqrt(x[i]^2 + y[i]^2));
    discretize midpoint;
} }

/// Numbers in (−1/2, 1/2), from a fixed sequence.
fn numbers<const N: usize>(seed: u64) -> SVector<f64, N> {
    let mut state = seed;
    SVector::from_fn(|_, _| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        f64::from(u32::try_from(state >> 33).unwrap_or(0)) / f64::from(1_u32 << 31) - 0.5
    })
}

/// The largest difference of two matrices, in ε of the largest entry of both.
#[derive(Default)]
struct Worst {
    off: f64,
    compared: u32,
}

impl Worst {
    fn see<const R: usize, const C: usize>(&mut self, ours: SMatrix<f64, R, C>, theirs: SMatrix<f64, R, C>) {
        let size = ours.amax().max(theirs.amax());
        assert!(size.is_finite());
        if size > 0.0 {
            self.compared += 1;
            self.off = self.off.max((ours - theirs).amax() / (size * f64::EPSILON));
        }
    }

    fn number(&mut self, ours: f64, theirs: f64) {
        self.see(SVector::<f64, 1>::new(ours), SVector::<f64, 1>::new(theirs));
    }
}

/// Compares all functions of a system in loops with those in lines, at states of this spread. `off` bounds the
/// differences of sums, `solved` those of what the mass matrix solves.
fn compare<A, B, const N: usize>(loops: A, lines: B, spread: f64, [off, solved]: [f64; 2])
where
    A: EnergyStepping<N> + Motion<N> + DiscreteLagrangian<N> + Convertible<N> + Discretized<N>,
    B: EnergyStepping<N> + Motion<N> + DiscreteLagrangian<N> + Convertible<N> + Discretized<N>,
{
    assert_eq!((A::AUTONOMOUS, A::FORCED, A::CYCLIC), (B::AUTONOMOUS, B::FORCED, B::CYCLIC));
    let (mut sums, mut solutions) = (Worst::default(), Worst::default());
    for seed in 1..5_u32 {
        let t = 0.3 * f64::from(seed);
        let [q, v, p, low] = [0, 10, 20, 30].map(|of| numbers::<N>(u64::from(seed) + of));
        let (q, low) = (q * spread, low * 1e-17);
        sums.number(loops.lagrangian(t, &q, &v), lines.lagrangian(t, &q, &v));
        sums.number(loops.energy(t, &q, &v), lines.energy(t, &q, &v));
        sums.see(loops.momentum(t, &q, &v), lines.momentum(t, &q, &v));
        sums.see(loops.force(t, &q, &v), lines.force(t, &q, &v));
        sums.number(Motion::power(&loops, t, &q, &v), Motion::power(&lines, t, &q, &v));
        let accelerations = (loops.acceleration(t, &q, &v), lines.acceleration(t, &q, &v));
        solutions.see(accelerations.0.expect("an acceleration"), accelerations.1.expect("an acceleration"));
        let densities = (loops.step_density(t, &q, &v), lines.step_density(t, &q, &v));
        solutions.number(densities.0.expect("a density"), densities.1.expect("a density"));
        let momenta = lines.momentum(t, &q, &v);
        let flows = (loops.flow(t, &q, &momenta), lines.flow(t, &q, &momenta));
        let (ours, theirs) = (flows.0.expect("a flow"), flows.1.expect("a flow"));
        solutions.see(ours.v, theirs.v);
        solutions.see(ours.force, theirs.force);
        let (ours, theirs) = (loops.point(t, &q, &v), lines.point(t, &q, &v));
        sums.see(ours.mass.dense(), theirs.mass.dense());
        sums.see(ours.force, theirs.force);
        let (ours, theirs) = (loops.point_derivatives(t, &q, &v), lines.point_derivatives(t, &q, &v));
        sums.see(ours.momentum_dq.dense(), theirs.momentum_dq.dense());
        sums.see(ours.force_dq.dense(), theirs.force_dq.dense());
        sums.see(ours.force_dv.dense(), theirs.force_dv.dense());
        for h in [0.1, -0.03] {
            let mut node = Node::new(State { t, q, p }, 0.7);
            (node.q_low, node.energy_low) = (low, 1e-17);
            let (ours, theirs) = (loops.extended_system(&node, h, &v), lines.extended_system(&node, h, &v));
            sums.see(ours.momentum.residual, theirs.momentum.residual);
            sums.see(ours.momentum.jacobian.dense(), theirs.momentum.jacobian.dense());
            sums.see(ours.residual_dh, theirs.residual_dh);
            sums.number(ours.energy_residual, theirs.energy_residual);
            sums.see(ours.energy_dv, theirs.energy_dv);
            sums.number(ours.energy_dh, theirs.energy_dh);
            let (ours, theirs) = (loops.extended_residual(&node, h, &v), lines.extended_residual(&node, h, &v));
            sums.see(ours.residual, theirs.residual);
            sums.see(ours.increment.momentum, theirs.increment.momentum);
            sums.number(ours.increment.energy, theirs.increment.energy);
            let ratios = ours.scale.component_div(&theirs.scale);
            // Measured: 0.18 to 1.00. Ours does not see what cancels within one body.
            assert!(ratios.min() > 0.15 && ratios.max() < 1.1, "scales {ratios}");
            let (ours, theirs) = (loops.extended_derivatives(&node, h, &v), lines.extended_derivatives(&node, h, &v));
            sums.see(ours.momentum.residual_dq.dense(), theirs.momentum.residual_dq.dense());
            sums.see(ours.momentum.increment_dq.dense(), theirs.momentum.increment_dq.dense());
            sums.see(ours.momentum.increment_dv.dense(), theirs.momentum.increment_dv.dense());
            sums.see(ours.increment_dh, theirs.increment_dh);
            sums.see(ours.energy_dq, theirs.energy_dq);
            sums.see(ours.energy_increment_dq, theirs.energy_increment_dq);
            sums.see(ours.energy_increment_dv, theirs.energy_increment_dv);
            sums.number(ours.energy_increment_dh, theirs.energy_increment_dh);
            sums.number(loops.discrete_energy(&node, h, &v), lines.discrete_energy(&node, h, &v));
            let interval = Interval { t0: t, q0: q, t1: t + h, q1: q + v * h };
            sums.see(loops.d2_ld(&interval), lines.d2_ld(&interval));
            sums.see(loops.d4_ld(&interval), lines.d4_ld(&interval));
            sums.number(loops.d1_ld(&interval), lines.d1_ld(&interval));
        }
    }
    println!("{}: off by {:.1} ε, solved {:.1} ε", A::NAME, sums.off, solutions.off);
    assert!(sums.compared > 150 && solutions.compared > 15, "{} and {} comparisons", sums.compared, solutions.compared);
    assert!(sums.off < off && solutions.off < solved);
}

/// Compares the functions of fixed steps by the rule of both, at states of this spread. `off` bounds
/// the differences of vectors, `cancelled` those of numbers, whose terms cancel.
fn compare_fixed<A, B, const N: usize>(loops: &A, lines: &B, spread: f64, [off, cancelled]: [f64; 2])
where
    A: FixedStepping<N> + DiscreteLagrangian<N>,
    B: FixedStepping<N> + DiscreteLagrangian<N>,
{
    assert_eq!((A::SPACES, A::CONSTANT_JACOBIAN), (B::SPACES, B::CONSTANT_JACOBIAN));
    let (mut sums, mut single) = (Worst::default(), Worst::default());
    for seed in 1..5_u32 {
        let t = 0.3 * f64::from(seed);
        let [q, v, p, low] = [0, 10, 20, 30].map(|of| numbers::<N>(u64::from(seed) + of));
        let (q, low) = (q * spread, low * 1e-17);
        for h in [0.1, -0.03] {
            let mut node = Node::new(State { t, q, p }, 0.7);
            (node.q_low, node.p_low) = (low, low);
            let (ours, theirs) = (loops.momentum_equation(&node, h, &v), lines.momentum_equation(&node, h, &v));
            sums.see(ours.residual, theirs.residual);
            sums.see(ours.jacobian.dense(), theirs.jacobian.dense());
            let (ours, theirs) = (loops.momentum_residual(&node, h, &v), lines.momentum_residual(&node, h, &v));
            sums.see(ours.residual, theirs.residual);
            sums.see(ours.increment, theirs.increment);
            let ratios = ours.scale.component_div(&theirs.scale);
            assert!(ratios.min() > 0.15 && ratios.max() < 1.1, "scales {ratios}");
            let (ours, theirs) = (loops.momentum_derivatives(&node, h, &v), lines.momentum_derivatives(&node, h, &v));
            sums.see(ours.residual_dq.dense(), theirs.residual_dq.dense());
            sums.see(ours.residual_dv.dense(), theirs.residual_dv.dense());
            sums.see(ours.increment_dq.dense(), theirs.increment_dq.dense());
            sums.see(ours.increment_dv.dense(), theirs.increment_dv.dense());
            single.number(loops.discrete_energy(&node, h, &v), lines.discrete_energy(&node, h, &v));
            let of = Interval { t0: t, q0: q, t1: t + h, q1: q + v * h };
            single.number(loops.ld(&of), lines.ld(&of));
            let numbers = [(loops.d1_ld(&of), lines.d1_ld(&of)), (loops.d3_ld(&of), lines.d3_ld(&of))];
            let powers = [(loops.gd_minus(&of), lines.gd_minus(&of)), (loops.gd_plus(&of), lines.gd_plus(&of))];
            numbers.into_iter().chain(powers).for_each(|(ours, theirs)| single.number(ours, theirs));
            let vectors = [(loops.d2_ld(&of), lines.d2_ld(&of)), (loops.d4_ld(&of), lines.d4_ld(&of))];
            let forces = [(loops.fd_minus(&of), lines.fd_minus(&of)), (loops.fd_plus(&of), lines.fd_plus(&of))];
            vectors.into_iter().chain(forces).for_each(|(ours, theirs)| sums.see(ours, theirs));
        }
    }
    println!("{}: fixed steps off by {:.1} ε, numbers {:.1} ε", A::NAME, sums.off, single.off);
    assert!(sums.compared > 50 && single.compared > 20, "{} and {} comparisons", sums.compared, single.compared);
    assert!(sums.off < off && single.off < cancelled);
}

/// Compares fixed steps of both.
fn compare_runs<A, B, const N: usize>(loops: A, lines: B, [q, v]: [SVector<f64, N>; 2], off: f64)
where
    A: FixedStepping<N> + Discretized<N>,
    B: FixedStepping<N> + Discretized<N>,
{
    let ours = loops.at(0.0, q, v).integrate(FixedStep, 0.01).and_then(|mut run| run.until(0.5)).expect("steps");
    let theirs = lines.at(0.0, q, v).integrate(FixedStep, 0.01).and_then(|mut run| run.until(0.5)).expect("steps");
    let moved = (theirs.q - q).amax();
    let found = (ours.q - theirs.q).amax().max((ours.p - theirs.p).amax()) / moved;
    println!("{}: states off by {found:.1e}", A::NAME);
    assert!(moved > 0.01 && found < off);
}

/// Compares steps of both.
fn compare_steps<A, B, const N: usize>(loops: A, lines: B, q: SVector<f64, N>, off: f64)
where
    A: EnergyStepping<N> + Motion<N> + DiscreteLagrangian<N> + Convertible<N> + Discretized<N>,
    B: EnergyStepping<N> + Motion<N> + DiscreteLagrangian<N> + Convertible<N> + Discretized<N>,
{
    let v = numbers::<N>(7);
    let fixed = (
        loops.at(0.0, q, v).integrate(FixedStep, 0.01).and_then(|mut run| run.until(0.5)),
        lines.at(0.0, q, v).integrate(FixedStep, 0.01).and_then(|mut run| run.until(0.5)),
    );
    let gauss = (
        loops.at(0.0, q, v).integrate(Gauss::<3>, 0.02).and_then(|mut run| run.until(0.5)),
        lines.at(0.0, q, v).integrate(Gauss::<3>, 0.02).and_then(|mut run| run.until(0.5)),
    );
    for (ours, theirs) in [fixed, gauss] {
        let (ours, theirs) = (ours.expect("steps"), theirs.expect("steps"));
        let moved = (theirs.q - q).amax();
        let found = (ours.q - theirs.q).amax().max((ours.p - theirs.p).amax()) / moved;
        println!("{}: states off by {found:.1e}", A::NAME);
        assert!(moved > 0.01 && found < off);
    }
}

#[test]
fn a_dissipation_in_loops_is_one_in_lines() {
    // Measured: 81.4 (a number whose terms cancel) and 20.1, 2.3 and 141.8 (such a number), 1.1e-16.
    let (loops, lines) = (DragInLoops::default(), DragInLines::default());
    compare(loops, lines, 1.0, [100.0, 40.0]);
    compare_fixed(&By::new(loops, Trapezoidal), &By::new(lines, Trapezoidal), 1.0, [6.0, 200.0]);
    compare_steps(loops, lines, numbers::<5>(3), 1e-15);
}

#[test]
fn a_time_scale_in_loops_is_one_in_lines() {
    let (loops, lines) = (ScaledInLoops::default(), ScaledInLines::default());
    let flags = |autonomous: bool, cyclic: [bool; 8]| (autonomous, cyclic);
    assert_eq!(
        flags(<ScaledInLoops as Lagrangian<8>>::AUTONOMOUS, <ScaledInLoops as Lagrangian<8>>::CYCLIC),
        flags(<ScaledInLines as Lagrangian<8>>::AUTONOMOUS, <ScaledInLines as Lagrangian<8>>::CYCLIC)
    );
    let mut worst = Worst::default();
    for seed in 1..9_u32 {
        let (t, [q, v]) = (0.3 * f64::from(seed), [0, 10].map(|of| numbers::<8>(u64::from(seed) + of)));
        let (ours, theirs) = (loops.scaled_point(t, &q, &v), lines.scaled_point(t, &q, &v));
        worst.number(ours.g, theirs.g);
        worst.number(ours.g_dt, theirs.g_dt);
        worst.see(ours.g_dq, theirs.g_dq);
        worst.see(ours.point.force, theirs.point.force);
        worst.number(ours.energy, theirs.energy);
    }
    let method = || Gauss::<3>.in_transformed_time();
    let start = (numbers::<8>(3) * 2.0, numbers::<8>(7));
    let ours = loops.at(0.0, start.0, start.1).integrate(method(), 0.01).and_then(|mut run| run.until(0.5));
    let theirs = lines.at(0.0, start.0, start.1).integrate(method(), 0.01).and_then(|mut run| run.until(0.5));
    let gap = (ours.expect("steps").q - theirs.expect("steps").q).amax();
    println!("{}: off by {:.1} ε, states {gap:.1e}", <ScaledInLoops as Lagrangian<8>>::NAME, worst.off);
    // Measured: 3.2 and 5.6e-17.
    assert!(worst.compared == 40 && worst.off < 4.0 && gap < 1e-16);
}

#[test]
fn each_rule_in_loops_is_that_rule_in_lines() {
    // Measured: 3.3 and 4.5, 2.3 and 3.5, 1.6e-16.
    let (loops, lines) = (BodiesInLoops::default(), BodiesInLines::default());
    compare_fixed(&By::new(loops, Own), &By::new(lines, Own), 4.0, [6.0, 6.0]);
    compare_fixed(&By::new(loops, Trapezoidal), &By::new(lines, Trapezoidal), 4.0, [6.0, 6.0]);
    let start = [numbers(3) * 4.0, numbers(7)];
    compare_runs(By::new(loops, Trapezoidal), By::new(lines, Trapezoidal), start, 1e-15);
    // Measured: 3.7 and 2.6, 4.2 and 2.7, 5.0e-16.
    let (loops, lines) = (LinksInLoops::default(), LinksInLines::default());
    compare_fixed(&By::new(loops, Own), &By::new(lines, Own), 1.0, [6.0, 6.0]);
    compare_fixed(&By::new(loops, Trapezoidal), &By::new(lines, Trapezoidal), 1.0, [6.0, 6.0]);
    compare_runs(By::new(loops, Trapezoidal), By::new(lines, Trapezoidal), [numbers(3), numbers(7)], 2e-15);
}

#[test]
fn explicit_steps_in_loops_are_those_in_lines() {
    let (loops, lines) = (CloudInLoops::default(), CloudInLines::default());
    const { assert!(<CloudInLoops as FixedStepping<10>>::CONSTANT_JACOBIAN) };
    // Measured: 1.6 and 57.8 (numbers whose terms cancel), 0.
    compare_fixed(&loops, &lines, 2.0, [6.0, 70.0]);
    compare_runs(loops, lines, [numbers(3), numbers(7)], 1e-15);
}

/// The end of a run from links at rest but for this velocity, and the turns of the links.
fn end_and_turns<S>(system: S, v: SVector<f64, 6>) -> Result<(State<6>, [i64; 6]), StepError>
where
    S: Convertible<6>,
{
    let mut run = system.at(0.0, [0.1; 6], v).integrate(Gauss::<3>, 0.01)?;
    Ok((run.until(1.0)?, run.turns()))
}

#[test]
fn angles_in_loops_are_angles_in_lines() {
    let (loops, lines) = (WheelsInLoops::default(), WheelsInLines::default());
    assert_eq!(<WheelsInLoops as Lagrangian<6>>::SPACES, [Space::Circle; 6]);
    // Measured: 2.3 and 5.2, 2.9 and 3.5, 3.6e-15.
    compare_fixed(&By::new(loops, Own), &By::new(lines, Own), 4.0, [6.0, 7.0]);
    compare_fixed(&By::new(loops, Midpoint), &By::new(lines, Midpoint), 4.0, [6.0, 7.0]);
    // The last link turns over.
    let mut v = SVector::<f64, 6>::zeros();
    v[5] = 40.0;
    let ours = end_and_turns(loops, v).expect("steps");
    let theirs = end_and_turns(lines, v).expect("steps");
    let ((ours, our_turns), (theirs, their_turns)) = (ours, theirs);
    println!("off by {:.1e}, turns {our_turns:?}", (ours.q - theirs.q).amax());
    assert!(our_turns == their_turns && our_turns[5] > 2 && (ours.q - theirs.q).amax() < 1e-14);
}

#[test]
fn bodies_in_loops_are_bodies_in_lines() {
    // Measured: 33.3 (an energy whose terms cancel), 2.3 and 1.6e-16.
    compare(BodiesInLoops::default(), BodiesInLines::default(), 4.0, [40.0, 4.0]);
    compare_steps(BodiesInLoops::default(), BodiesInLines::default(), numbers::<12>(3) * 4.0, 1e-15);
}

#[test]
fn links_in_loops_are_links_in_lines() {
    // Measured: 3.7, 54.6 and 4.8e-16.
    compare(LinksInLoops::default(), LinksInLines::default(), 1.0, [5.0, 100.0]);
    compare_steps(LinksInLoops::default(), LinksInLines::default(), numbers::<8>(3), 2e-15);
}

#[test]
fn a_pendulum_in_loops_is_a_pendulum_in_lines() {
    // Measured: 3.7, 18.5 and 5.7e-15.
    compare(PendulumInLoops::default(), PendulumInLines::default(), 1.0, [5.0, 40.0]);
    compare_steps(PendulumInLoops::default(), PendulumInLines::default(), numbers::<9>(3), 2e-14);
}

#[test]
fn an_arm_in_loops_is_an_arm_in_lines() {
    // Measured: 3.6, 109.2 and 5.6e-16.
    compare(ArmInLoops::default(), ArmInLines::default(), 1.0, [5.0, 200.0]);
    let start = numbers::<8>(3) + SVector::repeat(1.0);
    compare_steps(ArmInLoops::default(), ArmInLines::default(), start, 2e-15);
}

twice! { SlopesInLines SlopesInLoops {
    const N = 4;
    coord q[N];
    L = sum(i in 0..N, dot(q[i])^2) / 2 - sum(i in 0..N, abs(q[i])^(3/2)) + dot(q[0]) * dot(q[1]) / 10;
    discretize midpoint;
} }

#[test]
fn masses_are_finite_where_a_force_has_an_infinite_slope() {
    let [q, v] = [SVector::<f64, 4>::zeros(), SVector::<f64, 4>::repeat(0.1)];
    let found =
        [SlopesInLoops::default().acceleration(0.0, &q, &v), SlopesInLines::default().acceleration(0.0, &q, &v)];
    assert_eq!(found, [Ok(SVector::zeros()), Ok(SVector::zeros())]);
    let mut run = SlopesInLoops::default().at(0.0, q, v).integrate(FixedStep, 0.1).expect("a start");
    assert!(run.step().expect("a step").q[3] > 0.009);
}

// The same where the slopes are those of entries of a recursion, and of a force.
twice! { RootsInLines RootsInLoops {
    const N = 4;
    coord q[N];
    let s[0] = sin(q[0]);
    let s[i in 1..N] = s[i - 1] + sin(q[i]);
    L = sum(i in 0..N, dot(q[i])^2) / 2 - sum(i in 0..N, abs(s[i])^(3/2)) + dot(q[0]) * dot(q[1]) / 10;
    force q[i in 0..N] = 1 - sqrt(abs(q[i]));
    discretize trapezoidal;
} }

#[test]
fn weights_of_zero_hide_infinite_slopes() {
    let (loops, lines) = (RootsInLoops::default(), RootsInLines::default());
    let (q, v) = ([0.0; 4], [0.1; 4]);
    let [here, moves] = [SVector::from(q), SVector::from(v)];
    let (ours, theirs) = (loops.acceleration(0.0, &here, &moves), lines.acceleration(0.0, &here, &moves));
    assert!((ours.expect("masses") - theirs.expect("masses")).amax() < 1e-15);
    let step = |ends: Result<State<4>, StepError>| ends.expect("a step").q;
    let ours = step(loops.at(0.0, q, v).integrate(FixedStep, 0.1).and_then(|mut run| run.step()));
    let theirs = step(lines.at(0.0, q, v).integrate(FixedStep, 0.1).and_then(|mut run| run.step()));
    assert!(ours[0] > 0.01 && (ours - theirs).amax() < 1e-16, "{ours} {theirs}");
}

// A recursion with infinite slopes that only the time scale reads, and one of the force whose derivative has no limit.
twice! { AsideInLines AsideInLoops {
    const N = 3;
    coord q[N];
    let s[0] = sin(q[0]);
    let s[i in 1..N] = s[i - 1] + sin(q[i]);
    let w[0] = sqrt(q[0]);
    let w[i in 1..N] = w[i - 1] + sqrt(q[i]);
    L = sum(i in 0..N, dot(q[i])^2) / 2 - sum(i in 0..N, s[i]^2);
    time_scale = 1 + w[2]^4 + t * s[1]^2;
    discretize midpoint;
} }
twice! { EdgeInLines EdgeInLoops {
    const N = 3;
    coord q[N];
    let w[0] = sqrt(q[0]);
    let w[i in 1..N] = w[i - 1] + sqrt(q[i]);
    L = sum(i in 0..N, dot(q[i])^2) / 2;
    force q[i in 0..N] = -w[i]^2;
    discretize midpoint;
} }

#[test]
fn infinite_slopes_that_l_does_not_read_are_no_part_of_it() {
    let (loops, lines) = (AsideInLoops::default(), AsideInLines::default());
    for q in [[0.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0]] {
        let [q, v] = [SVector::from(q), SVector::from([0.1, 0.2, 0.3])];
        let (ours, theirs) = (loops.acceleration(0.0, &q, &v), lines.acceleration(0.0, &q, &v));
        assert!((ours.expect("finite") - theirs.expect("finite")).amax() < 1e-15);
        let (ours, theirs) = (loops.point_derivatives(0.0, &q, &v), lines.point_derivatives(0.0, &q, &v));
        assert!((ours.force_dq.dense() - theirs.force_dq.dense()).amax() < 1e-15);
    }
    assert_eq!([<AsideInLoops as Lagrangian<3>>::AUTONOMOUS, <AsideInLines as Lagrangian<3>>::AUTONOMOUS], [true; 2]);
}

#[test]
fn a_product_of_zero_and_infinity_without_a_limit_is_no_number() {
    let [q, v] = [SVector::<f64, 3>::zeros(), SVector::<f64, 3>::zeros()];
    let ours = EdgeInLoops::default().point_derivatives(0.0, &q, &v).force_dq.dense();
    let theirs = EdgeInLines::default().point_derivatives(0.0, &q, &v).force_dq.dense();
    assert!(theirs[(1, 0)].is_nan() && theirs[(2, 2)].is_nan());
    assert!(theirs.iter().zip(&ours).all(|(theirs, ours)| !theirs.is_nan() || ours.is_nan()), "{ours} {theirs}");
}

#[test]
fn a_product_of_zero_and_infinity_has_its_limit_in_loops() {
    let [q, v] = [SVector::<f64, 8>::zeros(), SVector::<f64, 8>::repeat(0.1)];
    let [ours, theirs] =
        [LimitsInLoops::default().lagrangian(0.0, &q, &v), LimitsInLines::default().lagrangian(0.0, &q, &v)];
    assert!(ours.to_bits() == theirs.to_bits() && (ours - 0.04).abs() < 1e-16, "{ours} {theirs}");
}

// A closed chain whose end a motor moves, with a rolling condition.
twice! { ClosedInLines ClosedInLoops {
    const N = 6;
    param l = 0.3, g = 9.81, d = 0.9, w = 1.7, b = 0.1, c = 0.4;
    coord q[N];
    let x[0] = l * sin(q[0]);
    let x[i in 1..N] = x[i - 1] + l * sin(q[i]);
    let y[i in 0..N] = -sum(j in 0..i + 1, l * cos(q[j]));
    L = sum(i in 0..N, (dot(x[i])^2 + dot(y[i])^2) / 2 - g * y[i]) + b * t * dot(q[0]) * q[1];
    force q[i in 0..N] = -b * dot(q[i]);
    constraint end[k in 0..1] = x[N - 1] * (1 + y[2] / 10) - d * (1 + sin(w * t) / 10);
    constraint rolls = dot(x[2]) * cos(q[4]) - c * dot(q[3]) + b * cos(t) * y[3];
} }

// Bodies that attract each other, with rods between neighbors.
twice! { RodsInLines RodsInLoops {
    const N = 4;
    param m[N] = [0.3, 1.2, 0.9, 0.5], l[N] = [0.7, 0.5, 0.6, 0.4], G = 1.3;
    coord r[N][3];
    let v2[i in 0..N] = dot(r[i]) * dot(r[i]);
    let pull[i in 0..N] = m[i] * sum(j in 0..i, m[j] / norm(r[i] - r[j]));
    L = sum(i in 0..N, m[i] * v2[i]) / 2 + G * sum(i in 0..N, pull[i]);
    constraint rod[i in 1..N] = (r[i] - r[i - 1]) * (r[i] - r[i - 1]) - l[i]^2;
} }

// Compass needles, each turned by the others and by a motor.
twice! { NeedlesInLines NeedlesInLoops {
    const N = 2;
    param J[3] = [0.3, 0.5, 0.7], k = 0.4, motor = 0.2;
    rotation R[N];
    let ω[i in 0..N] = rate(R[i]);
    let n[i in 0..N] = turn(R[i], [0, 0, 1]);
    L = sum(i in 0..N, J[0] * ω[i][0]^2 + J[1] * ω[i][1]^2 + J[2] * ω[i][2]^2) / 2
        + k * sum(i in 0..N, sum(j in 0..i, n[i] * n[j]));
    torque R[i in 0..N] = [0, motor, 0];
} }

fn dense<const N: usize, const R: usize>(rows: &impl Rectangular<N, f64>) -> SMatrix<f64, R, N> {
    assert_eq!(rows.rows().count(), R);
    let mut matrix = SMatrix::<f64, R, N>::zeros();
    for (mut to, row) in matrix.row_iter_mut().zip(rows.rows()) {
        to.copy_from(&row.dense::<N>().transpose());
    }
    matrix
}

/// Compares all functions of a system with constraints in loops with those in lines.
fn compare_constrained<A, B, F, G, const N: usize, const K: usize>(loops: A, lines: B, [off, solved]: [f64; 2])
where
    F: Form<Multipliers<K, f64> = [f64; K]>,
    G: Form<Multipliers<K, f64> = [f64; K]>,
    A: Convertible<N, Kind = Bound<K, F>>,
    B: Convertible<N, Kind = Bound<K, G>>,
{
    assert_eq!((A::AUTONOMOUS, A::FORCED, A::CYCLIC), (B::AUTONOMOUS, B::FORCED, B::CYCLIC));
    assert_eq!((A::CONSTRAINTS, A::HOLONOMIC), (B::CONSTRAINTS, B::HOLONOMIC));
    let (mut sums, mut solutions) = (Worst::default(), Worst::default());
    let vector = |numbers: [f64; K]| SVector::from(numbers);
    for seed in 1..5_u32 {
        let t = 0.3 * f64::from(seed);
        let [q, v] = [0, 10].map(|of| numbers::<N>(u64::from(seed) + of) * 3.0);
        let multipliers: [f64; K] = numbers::<K>(u64::from(seed) + 20).into();
        sums.see(vector(loops.constraints(t, &q)), vector(lines.constraints(t, &q)));
        let ((ours, our_rates), (theirs, their_rates)) =
            (loops.constraint_gradients(t, &q), lines.constraint_gradients(t, &q));
        sums.see::<K, N>(dense(&ours), dense(&theirs));
        sums.see(vector(our_rates), vector(their_rates));
        let ((ours, our_rates), (theirs, their_rates)) =
            (loops.constraint_rate_derivatives(t, &q, &v), lines.constraint_rate_derivatives(t, &q, &v));
        sums.see::<K, N>(dense(&ours), dense(&theirs));
        sums.see(vector(our_rates), vector(their_rates));
        let ours = loops.reaction_derivatives(t, &q, &multipliers);
        sums.see::<N, N>(dense(&ours), dense(&lines.reaction_derivatives(t, &q, &multipliers)));
        sums.see(loops.applied(t, &q, &v), lines.applied(t, &q, &v));
        sums.number(loops.power(t, &q, &v), lines.power(t, &q, &v));
        sums.number(loops.energy(t, &q, &v), lines.energy(t, &q, &v));
        let (ours, theirs) = (loops.point(t, &q, &v), lines.point(t, &q, &v));
        sums.see(ours.mass.dense(), theirs.mass.dense());
        sums.see(ours.force, theirs.force);
        sums.see(ours.momentum, theirs.momentum);
        let (ours, theirs) = (loops.point_derivatives(t, &q, &v), lines.point_derivatives(t, &q, &v));
        sums.see(ours.momentum_dq.dense(), theirs.momentum_dq.dense());
        sums.see(ours.force_dq.dense(), theirs.force_dq.dense());
        sums.see(ours.force_dv.dense(), theirs.force_dv.dense());
        // These points are off the constraints.
        let accelerations = (Extended(loops).acceleration(t, &q, &v), Extended(lines).acceleration(t, &q, &v));
        solutions.see(accelerations.0.expect("an acceleration"), accelerations.1.expect("an acceleration"));
        let p = lines.momentum(t, &q, &v);
        let (ours, theirs) = (loops.flow(t, &q, &p).expect("a flow"), lines.flow(t, &q, &p).expect("a flow"));
        solutions.see(ours.v, theirs.v);
    }
    println!("{}: off by {:.1} ε, solved {:.1} ε", A::NAME, sums.off, solutions.off);
    assert!(sums.compared >= 40 && solutions.compared == 8, "{} and {}", sums.compared, solutions.compared);
    assert!(sums.off < off && solutions.off < solved);
}

/// Compares runs of both from the state nearest to q, and how well the constraints hold.
fn compare_constrained_steps<A, B, F, G, const N: usize, const K: usize>(
    (loops, lines): (A, B),
    q: SVector<f64, N>,
    [h, until]: [f64; 2],
    off: f64,
) where
    F: Form,
    G: Form,
    A: Convertible<N, Kind = Bound<K, F>>,
    B: Convertible<N, Kind = Bound<K, G>>,
{
    let start = State::projected(&lines, 0.0, q, numbers::<N>(7)).expect("a start").state;
    let ours = loops.at_state(start).integrate(Gauss::<2>, h).and_then(|mut run| run.until(until)).expect("steps");
    let theirs = lines.at_state(start).integrate(Gauss::<2>, h).and_then(|mut run| run.until(until)).expect("steps");
    let moved = (theirs.q - start.q).amax();
    let found = (ours.q - theirs.q).amax().max((ours.p - theirs.p).amax()) / moved;
    let held = loops.constraints(until, &ours.q).as_ref().iter().fold(0.0_f64, |worst, value| worst.max(value.abs()));
    println!("{}: states off by {found:.1e} after {moved:.2}, constraints by {held:.1e}", A::NAME);
    assert!(moved > 0.1 && found < off && held < 1e-14);
}

#[test]
fn a_closed_chain_in_loops_is_one_in_lines() {
    // Measured: 2.6, 20.2, and 5.4e-16.
    compare_constrained(ClosedInLoops::default(), ClosedInLines::default(), [4.0, 40.0]);
    let q = SVector::from([1.0, 0.9, 0.6, 0.4, 0.3, 0.2]);
    compare_constrained_steps((ClosedInLoops::default(), ClosedInLines::default()), q, [0.01, 0.5], 2e-15);
}

#[test]
fn rotations_in_loops_are_rotations_in_lines() {
    // Measured: 8.8 and 6.3.
    compare_constrained(NeedlesInLoops::default(), NeedlesInLines::default(), [10.0, 10.0]);
}

#[test]
fn rods_in_loops_are_rods_in_lines() {
    // Measured: 29.7 (a constraint whose terms cancel), 1.5 and 3.6e-16.
    compare_constrained(RodsInLoops::default(), RodsInLines::default(), [40.0, 3.0]);
    let q = numbers::<12>(3) * 2.0;
    compare_constrained_steps((RodsInLoops::default(), RodsInLines::default()), q, [0.01, 0.5], 2e-15);
}

// The coefficient of a velocity has one derivative at zero, but no second one.
twice! { RoughInLines RoughInLoops {
    coord x[2], y[2];
    L = sum(i in 0..2, dot(x[i])^2 + dot(y[i])^2) / 2;
    constraint circle = sum(i in 0..2, x[i]^2) - 1;
    constraint rolls[i in 0..1] = dot(y[i]) - abs(y[i + 1])^(3/2) * dot(x[i]);
} }

#[test]
fn constraints_are_finite_where_one_has_an_infinite_second_derivative() {
    let (q, v) = (SVector::from([0.6, 0.8, 0.2, 0.0]), SVector::from([0.8, -0.6, 0.0, 0.0]));
    let [ours, theirs] = [
        dense::<4, 4>(&RoughInLoops::default().reaction_derivatives(0.0, &q, &[0.3, 0.2])),
        dense::<4, 4>(&RoughInLines::default().reaction_derivatives(0.0, &q, &[0.3, 0.2])),
    ];
    assert!(ours == theirs && ours[(0, 0)] > 0.5, "{ours} {theirs}");
    let mut run = RoughInLoops::default().at(0.0, q, v).integrate(Gauss::<2>, 0.01).expect("a start");
    assert!(run.until(0.2).expect("steps").q[0] > 0.7);
}

// A chain between two hooks. Bounds of the elimination of its 32 unknowns are larger than what it finds.
lagrangian! {
    struct Hung {
        const N = 30;
        param m = 1.2, l = 0.5, g = 9.81, d = 13.5;
        coord q[N];
        let x[0] = l * cos(q[0]);
        let x[i in 1..N] = x[i - 1] + l * cos(q[i]);
        let y[i in 0..N] = sum(j in 0..i + 1, l * sin(q[j]));
        L = m * sum(i in 0..N, (dot(x[i])^2 + dot(y[i])^2) / 2 - g * y[i]);
        constraint across = x[N - 1] - d;
        constraint level = y[N - 1];
    }
}

#[test]
fn a_check_of_many_unknowns_proves_something() {
    let run = || {
        let mut angle = -0.78;
        let q = SVector::from_fn(|_, _| {
            let before = angle;
            angle += 0.052;
            before
        });
        let place = Place { t: 0.0, q, v: SVector::zeros(), h: 0.01 };
        check::reaction(&Hung::default(), &place).expect("a reaction").compared
    };
    let run = thread::Builder::new().stack_size(32 << 20).spawn(run).expect("a thread");
    assert!(run.join().expect("no overflow") > 100);
}
