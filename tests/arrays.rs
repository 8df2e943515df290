//! Systems with arrays against known results: force and frequencies of the chain by hand, the N-pendulum of two links
//! against the double pendulum, order 2, and the energy of both integrators.

use crate::support::exact::Trajectory;
use vi_core::stepping::EnergyStepping;
use vi_core::{EnergyPreserving, FixedStep, Lagrangian, SVector, Starts, State, lagrangian};
use vi_systems::{DoublePendulum, FpuChain, NPendulum};

const N: usize = 16;

lagrangian! {
    /// The lines of `NPendulum`, for two links.
    struct TwoLinks {
        const N = 2;
        param m = 1.0, l = 1.0, g = 9.81;
        coord θ[N];
        let alone = sum(i in 0..N, (N - i) * dot(θ[i])^2) / 2;
        let pairs = sum(i in 1..N, (N - i) * sum(j in 0..i, dot(θ[i]) * dot(θ[j]) * cos(θ[i] - θ[j])));
        L = m * l^2 * (alone + pairs) + m * g * l * sum(i in 0..N, (N - i) * cos(θ[i]));
        discretize midpoint;
    }
}

/// sin(π j (i + 1)/17): the shape of the mode j of the linear chain.
fn mode(j: u8, amplitude: f64) -> SVector<f64, N> {
    let phase = core::f64::consts::PI * f64::from(j) / 17.0;
    let mut place = 0.0;
    SVector::from_fn(|_, _| {
        place += 1.0;
        amplitude * (phase * place).sin()
    })
}

#[test]
fn two_links_are_the_double_pendulum() {
    let two = TwoLinks { m: 1.3, l: 0.8, g: 9.81 };
    let double = DoublePendulum { m1: 1.3, m2: 1.3, l1: 0.8, l2: 0.8, g: 9.81 };
    let (q, v) = ([0.9, -0.4], [0.3, 1.1]);
    let (one, other) = (fixed(two, q, v, 0.005, 400), fixed(double, q, v, 0.005, 400));
    // Measured: 2.0e-15. The masses and lengths of the two systems give coefficients with different rounding.
    let difference = (one.q - other.q).amax().max((one.p - other.p).amax());
    println!("after 400 steps off by {difference:e}");
    assert!(difference <= 3e-15, "{difference:e}");
    assert!((one.q - SVector::from(q)).amax() > 0.1, "nothing moved");
}

/// The state after some fixed steps.
fn fixed<const N: usize, S: EnergyStepping<N>>(system: S, q: [f64; N], v: [f64; N], h: f64, steps: usize) -> State<N> {
    let start = State::at(&system, 0.0, q, v);
    let mut run = system.at_state(start).integrate(FixedStep, h).expect("a valid start");
    for _ in 0..steps {
        run.step().unwrap_or_else(|error| panic!("{}: {error}", S::NAME));
    }
    run.state()
}

#[test]
fn the_chain_pulls_as_the_report_writes_it() {
    let chain = FpuChain { m: 1.4, k: 0.9, alpha: 0.3, beta: 0.7 };
    let (q, v) = (mode(1, 0.8) + mode(3, 0.2), mode(2, 0.5));
    let a = chain.acceleration(0.0, &q, &v).expect("a constant mass");
    let at = |i: usize| if (1..=N).contains(&i) { q[i - 1] } else { 0.0 };
    for i in 1..=N {
        // m ẍ_i = k (x_{i+1} + x_{i−1} − 2 x_i) + α ((x_{i+1} − x_i)² − (x_i − x_{i−1})²) + β (…³ − …³)
        let (right, left) = (at(i + 1) - at(i), at(i) - at(i - 1));
        let force = chain.k * (right - left)
            + chain.alpha * (right.powi(2) - left.powi(2))
            + chain.beta * (right.powi(3) - left.powi(3));
        // Measured: 1.2e-16.
        assert!((a[i - 1] - force / chain.m).abs() <= 3e-16, "{i}: {} is not {}", a[i - 1], force / chain.m);
    }
}

#[test]
fn linear_modes_keep_their_shape_and_frequency() {
    let chain = FpuChain { m: 1.0, k: 1.0, alpha: 0.0, beta: 0.0 };
    for j in [1, 5, 16] {
        let omega = 2.0 * (core::f64::consts::PI * f64::from(j) / 34.0).sin();
        // The midpoint rule rotates a mode by the angle 2 atan(ω h/2) in a step.
        let (h, steps) = (0.1, 100);
        let angle = f64::from(steps) * 2.0 * (omega * h / 2.0).atan();
        let q = mode(j, 1.0);
        let state = fixed(chain, q.into(), [0.0; N], h, 100);
        let difference = (state.q - q * angle.cos()).amax().max((state.p + q * (omega * angle.sin())).amax());
        println!("mode {j}: off by {difference:e}");
        // Measured: 8.0e-15, for the highest mode.
        assert!(difference <= 2e-14, "mode {j}: {difference:e}");
    }
}

/// Checks that errors against an accurate motion fall by 4 per halving of the step.
fn order<const N: usize, S: EnergyStepping<N> + Copy>(system: S, q: [f64; N], v: [f64; N], h: f64, steps: usize) {
    let mut time = 0.0;
    (0..steps).for_each(|_| time += h);
    let exact = Trajectory::new(0.0, q, v).at(&system, time);
    let errors = [1, 2, 4, 8].map(|parts: u16| {
        let state = fixed(system, q, v, h / f64::from(parts), steps * usize::from(parts));
        (state.q - exact.q).amax()
    });
    for pair in errors.windows(2) {
        let slope = (pair[0] / pair[1]).log2();
        println!("{}: errors {:e} and {:e}, order {slope:.4}", S::NAME, pair[0], pair[1]);
        // Measured: 2.0000 within 2e-4.
        assert!(pair[1] > 1e-10 && (slope - 2.0).abs() <= 1e-3, "{}: order {slope}", S::NAME);
    }
}

#[test]
fn both_are_of_order_two() {
    let chain = FpuChain { m: 1.4, k: 0.9, alpha: 0.3, beta: 0.7 };
    order(chain, (mode(1, 0.8) + mode(3, 0.2)).into(), mode(2, 0.5).into(), 0.1, 100);
    let pendulum = NPendulum { m: 1.2, l: 0.9, g: 9.81 };
    order(pendulum, [0.5, 0.3, -0.2, 0.1], [0.1, -0.2, 0.3, 0.2], 0.004, 250);
}

/// Energy deviation of the fixed-step and the energy-preserving integrator over `steps` steps.
fn energies<const N: usize, S: EnergyStepping<N> + Copy>(
    system: S,
    q: [f64; N],
    v: [f64; N],
    h: f64,
    steps: usize,
) -> [f64; 2] {
    let mut run = system.at(0.0, q, v).integrate(FixedStep, h).expect("a valid start");
    let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
    for _ in 0..steps {
        run.step().unwrap_or_else(|error| panic!("{}: {error}", S::NAME));
        let energy = run.discrete_energy().expect("a step was taken");
        (low, high) = (low.min(energy), high.max(energy));
    }
    let mut run = EnergyPreserving::from_midpoint(system, 0.0, q, v, h).expect("a valid start");
    let wanted = system.energy(0.0, &q.into(), &v.into());
    let mut worst = 0.0_f64;
    for _ in 0..steps {
        let step = run.detailed_step().unwrap_or_else(|error| panic!("{}: {error}", S::NAME));
        let (t, q, v) = step.midpoint;
        worst = worst.max((system.energy(t, &q, &v) - wanted).abs());
    }
    println!("{}: fixed steps swing by {:e}, energy-preserving ones are off by {worst:e}", S::NAME, high - low);
    [high - low, worst]
}

#[test]
fn energy_oscillates_with_fixed_steps_and_is_constant_with_energy_preserving_ones() {
    let chain = FpuChain { m: 1.4, k: 0.9, alpha: 0.3, beta: 0.7 };
    let [swing, error] = energies(chain, mode(1, 1.0).into(), [0.0; N], 0.1, 5000);
    // Measured: 4.5e-5 and 1.9e-15, for an energy of 0.04.
    assert!((4e-5..5e-5).contains(&swing) && error <= 4e-15, "{swing:e}, {error:e}");
    // Close to the lowest mode, for which steps always exist.
    let pendulum = NPendulum { m: 1.2, l: 0.9, g: 9.81 };
    let [swing, error] = energies(pendulum, [0.6, 0.4, 0.2, 0.1], [0.0; 4], 0.005, 4000);
    // Measured:
    assert!((7e-4..8e-4).contains(&swing) && error <= 2e-13, "{swing:e}, {error:e}");
}
