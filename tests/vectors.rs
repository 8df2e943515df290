//! Three bodies in space, written with vectors: the same run as written entry by entry, and what the symmetries keep.
//! A recursion of vectors against sums. Parameters in matrices.

use vi_core::lagrangian::Parameters;
use vi_core::stepping::EnergyStepping;
use vi_core::{EnergyPreserving, FixedStep, Lagrangian, SVector, Starts, State, lagrangian};

lagrangian! {
    /// Three bodies that attract one another.
    struct Bodies {
        const N = 3;
        param m[N] = [1.0, 2.0, 3.0], G = 1.0;
        coord r[N][3];
        let kinetic = sum(i in 0..N, m[i] * dot(r[i]) * dot(r[i]) / 2);
        L = kinetic + sum(i in 0..N, j in 0..i, G * m[i] * m[j] / norm(r[i] - r[j]));
        discretize midpoint;
        check {
            r = [[1, 0, 0.2], [-1, 0.3, 0], [0.1, -1, -0.4]], dot(r[0]) = [0.1, 0.9, 0], dot(r[1]) = [0, -0.8, 0.3];
            h = 0.01;
        }
    }
}

lagrangian! {
    /// The same bodies, entry by entry.
    struct EntryByEntry {
        const N = 3;
        param m[N] = [1.0, 2.0, 3.0], G = 1.0;
        coord x0, y0, z0, x1, y1, z1, x2, y2, z2;
        let v0 = dot(x0)^2 + dot(y0)^2 + dot(z0)^2;
        let v1 = dot(x1)^2 + dot(y1)^2 + dot(z1)^2;
        let v2 = dot(x2)^2 + dot(y2)^2 + dot(z2)^2;
        let d10 = sqrt((x1 - x0)^2 + (y1 - y0)^2 + (z1 - z0)^2);
        let d20 = sqrt((x2 - x0)^2 + (y2 - y0)^2 + (z2 - z0)^2);
        let d21 = sqrt((x2 - x1)^2 + (y2 - y1)^2 + (z2 - z1)^2);
        let kinetic = m[0] * v0 / 2 + m[1] * v1 / 2 + m[2] * v2 / 2;
        L = kinetic + G * m[1] * m[0] / d10 + G * m[2] * m[0] / d20 + G * m[2] * m[1] / d21;
        discretize midpoint;
    }
}

lagrangian! {
    /// A chain of links in a plane, each position from the one before.
    struct Recursion {
        const N = 6;
        param l = 0.3, g = 9.81;
        coord θ[N];
        let p[0] = l * [sin(θ[0]), -cos(θ[0])];
        let p[i in 1..N] = p[i - 1] + l * [sin(θ[i]), -cos(θ[i])];
        L = sum(i in 0..N, dot(p[i]) * dot(p[i]) / 2 - g * p[i][1]);
        force θ = -0.1 * dot(θ);
        discretize midpoint;
    }
}

lagrangian! {
    /// The same chain by sums.
    struct Sums {
        const N = 6;
        param l = 0.3, g = 9.81;
        coord θ[N];
        let x[i in 0..N] = sum(j in 0..i + 1, l * sin(θ[j]));
        let y[i in 0..N] = -sum(j in 0..i + 1, l * cos(θ[j]));
        L = sum(i in 0..N, (dot(x[i])^2 + dot(y[i])^2) / 2 - g * y[i]);
        force θ[i in 0..N] = -0.1 * dot(θ[i]);
        discretize midpoint;
    }
}

lagrangian! {
    /// Three masses coupled by a matrix of stiffnesses.
    struct Coupled {
        param M[2][2] = [[2, 0.5], [0.5, 1]], K[2][2] = 1;
        coord q[2];
        L = (dot(q) * M * dot(q) - q * K * q) / 2;
        discretize midpoint;
    }
}

/// Positions, and velocities without a total momentum.
fn start() -> (SVector<f64, 9>, SVector<f64, 9>) {
    (
        SVector::from([1.0, 0.0, 0.2, -1.0, 0.3, 0.0, 0.1, -1.0, -0.4]),
        SVector::from([0.1, 0.9, 0.0, 0.0, -0.8, 0.3, 0.3, 0.1, -0.2]),
    )
}

/// The states of a run.
fn run<const N: usize, S: EnergyStepping<N> + Copy>(
    system: S,
    (q, v): (SVector<f64, N>, SVector<f64, N>),
    h: f64,
    steps: usize,
) -> Vec<State<N>> {
    let mut run = system.at(0.0, q, v).integrate(FixedStep, h).expect("a valid start");
    let mut states = Vec::with_capacity(steps);
    for _ in 0..steps {
        run.step().unwrap_or_else(|error| panic!("{}: {error}", S::NAME));
        states.push(run.state());
    }
    states
}

#[test]
fn vectors_and_entries_are_one_system() {
    let (one, other) = (run(Bodies::default(), start(), 0.01, 300), run(EntryByEntry::default(), start(), 0.01, 300));
    for (step, (one, other)) in one.iter().zip(&other).enumerate() {
        assert_eq!((one.q, one.p), (other.q, other.p), "step {step}");
    }
    assert!((one[299].q - start().0).amax() > 0.5, "nothing moved");
    assert_eq!(<Bodies as Lagrangian<9>>::COORDINATES[5], "r[1][2]");
}

/// Σ p and Σ r × p.
fn momenta(state: &State<9>) -> [f64; 6] {
    let mut momenta = [0.0; 6];
    for (r, p) in state.q.as_slice().chunks(3).zip(state.p.as_slice().chunks(3)) {
        for k in 0..3 {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            momenta[k] += p[k];
            momenta[3 + k] += r[i] * p[j] - r[j] * p[i];
        }
    }
    momenta
}

#[test]
fn momentum_and_angular_momentum_are_kept() {
    let bodies = Bodies::default();
    let (q, v) = start();
    let first = momenta(&State::at(&bodies, 0.0, q, v));
    let mut largest = 0.0_f64;
    for state in run(bodies, start(), 0.01, 2000) {
        let now = momenta(&state);
        let change = now.iter().zip(&first).map(|(now, then)| (now - then).abs());
        largest = change.fold(largest, f64::max);
    }
    println!("momenta change by {largest:e}");
    let not_zero = first.iter().filter(|momentum| momentum.abs() > 0.1).count();
    assert_eq!(not_zero, 5, "{first:?}");
    // Measured: 6.3e-15.
    assert!(largest <= 1e-14, "{largest:e}");
    // Energy-preserving steps, whose length varies.
    let mut run = bodies.at(0.0, q, v).integrate(EnergyPreserving, 0.01).expect("a valid start");
    let energy = State::at(&bodies, 0.0, q, v).energy(&bodies).expect("an energy");
    run.until(1.0).expect("steps");
    let state = run.state();
    let change = momenta(&state).iter().zip(&first).map(|(now, then)| (now - then).abs()).fold(0.0, f64::max);
    let of_energy = (state.energy(&bodies).expect("an energy") - energy).abs();
    println!("with energy-preserving steps: momenta {change:e}, energy {of_energy:e}");
}

#[test]
fn a_recursion_is_the_sum() {
    let start = || (SVector::from([0.5, 0.3, -0.2, 0.1, 0.7, 0.2]), SVector::from([0.1, -0.2, 0.3, 0.2, 0.0, 1.0]));
    let (one, other) = (run(Recursion::default(), start(), 0.005, 200), run(Sums::default(), start(), 0.005, 200));
    let difference = one.iter().zip(&other).map(|(one, other)| (one.q - other.q).amax()).fold(0.0, f64::max);
    println!("recursion and sums differ by {difference:e}");
    assert!((one[199].q - start().0).amax() > 0.1, "nothing moved");
    assert_eq!(difference.to_bits(), 0);
}

#[test]
fn matrices_of_parameters() {
    let mut coupled = Coupled { K: [[3.0, 0.0], [0.0, 2.0]], ..Coupled::default() };
    *coupled.parameter_mut("K[1][0]").expect("an entry") = -0.5;
    assert_eq!((coupled.K, coupled.M), ([[3.0, 0.0], [-0.5, 2.0]], [[2.0, 0.5], [0.5, 1.0]]));
    let names = ["M[0][0]", "M[0][1]", "M[1][0]", "M[1][1]", "K[0][0]", "K[0][1]", "K[1][0]", "K[1][1]"];
    assert_eq!(<Coupled as Lagrangian<2>>::PARAMETERS, names);
    assert_eq!(coupled.convert::<f32>().K, [[3.0_f32, 0.0], [-0.5, 2.0]]);
    let (q, v) = (SVector::from([0.4, -1.0]), SVector::from([2.0, 3.0]));
    // v·Mv = 8 + 6 + 9 and q·Kq = 0.48 + 0.2 + 2.
    let lagrangian = coupled.lagrangian(0.0, &q, &v);
    assert!((lagrangian - (23.0 - 2.68) / 2.0).abs() <= 4e-15, "{lagrangian}");
}
