//! Expressions of the language against dual numbers and formulas by hand.

#![allow(missing_docs, reason = "a test")]

use vi_core::lagrangian::Parameters;
use vi_core::real::{Dual, Real};
use vi_core::stepping::{Batch, EnergyStepping};
use vi_core::{EnergyPreserving, FixedStep, Lagrangian, SVector, Starts, State, lagrangian};

lagrangian! {
    /// Elastic pendulum with a moving pivot above a curved ground: positions are named, velocities derived.
    struct Driven {
        param m = 1.3, a = 0.4, ω = 2.0, g = 9.81;
        const τ = 5;
        coord r, θ;
        let pivot = a * cos(ω * t) * exp(-t / τ);
        let x = pivot + r * sin(θ);
        let y = -r * cos(θ) * sqrt(1 + x^2 / 10);
        let moment[i in 0..2] = (1 + i) * x * y^i + i;
        L = m * (dot(x)^2 + dot(y)^2) / 2 - m * g * y;
        force r = -dot(x * y) - dot(r)^3;
        force θ = dot(moment[0]) * dot(moment[1]) + dot(t);
        discretize midpoint;
    }
}

/// x, y, and the moments of `Driven`.
fn positions<T: Real>(system: &Driven, t: T, r: T, θ: T) -> [T; 4] {
    let real = T::real;
    let pivot = real(system.a) * (real(system.ω) * t).cos() * (-t / real(5.0)).exp();
    let x = pivot + r * θ.sin();
    let y = -r * θ.cos() * (real(1.0) + x * x / real(10.0)).sqrt();
    [x, y, x, real(2.0) * x * y + real(1.0)]
}

#[test]
fn dot_is_the_derivative_by_time() {
    let system = Driven::default();
    let Driven { m, g, .. } = system;
    let mut largest: f64 = 0.0;
    for (t, r, θ, r_dot, θ_dot) in [(0.0, 1.0, 0.3, 0.2, -0.7), (0.8, 0.7, -1.9, -1.1, 2.3), (-2.5, 2.1, 3.0, 0.0, 0.0)]
    {
        let (q, v) = (SVector::from([r, θ]), SVector::from([r_dot, θ_dot]));
        let along = |value, slope| Dual { value, slope };
        let [x, y, first, second] = positions(&system, along(t, 1.0), along(r, r_dot), along(θ, θ_dot));
        let energies = m * (x.slope * x.slope + y.slope * y.slope) / 2.0 - m * g * y.value;
        let forces = [-(x * y).slope - r_dot.powi(3), first.slope * second.slope + 1.0];
        let compare = |found: f64, wanted: f64| (found - wanted).abs() / (1.0 + wanted.abs());
        largest = largest.max(compare(system.lagrangian(t, &q, &v), energies));
        for (found, wanted) in system.force(t, &q, &v).iter().zip(forces) {
            largest = largest.max(compare(*found, wanted));
        }
        assert!(energies.abs() > 0.1 && forces.iter().any(|force| force.abs() > 0.1), "a place where nothing moves");
    }
    // Measured 2.9e-16, for values between 0.1 and 100.
    assert!(largest < 6e-16, "{largest:e}");
}

lagrangian! {
    /// Two masses between walls, with arrays of parameters.
    #[derive(PartialOrd)]
    struct Listed {
        const N = 2;
        /// Masses.
        param m[N] = [1.5, 0.25 * N];
        /// Stiffnesses.
        param k[N + 1] = 3.0, c = 0.1, only[1] = [0.7];
        coord q[N];
        let stretch[i in 1..N] = q[i] - q[i - 1];
        let walls = k[0] * q[0]^2 + k[N] * q[N - 1]^2;
        L = sum(i in 0..N, m[i] * dot(q[i])^2) / 2 - sum(i in 1..N, k[i] * stretch[i]^2) / 2 - walls / 2 - only[0] * q[0]^4;
        force q[i in 0..N] = -c * m[i] * dot(q[i]);
        discretize midpoint;
        check { q[i in 0..2] = 0.3 + i, dot(q[0]) = 0.2; h = 0.01; }
    }
}

lagrangian! {
    /// The same with scalar parameters only.
    struct Named {
        param m0 = 1.5, m1 = 0.5, k0 = 3.0, k1 = 3.0, k2 = 3.0, c = 0.1, only = 0.7;
        coord x, y;
        let walls = k0 * x^2 + k2 * y^2;
        L = (m0 * dot(x)^2 + m1 * dot(y)^2) / 2 - k1 * (y - x)^2 / 2 - walls / 2 - only * x^4;
        force x = -c * m0 * dot(x), y = -c * m1 * dot(y);
        discretize midpoint;
    }
}

/// The ends of 100 steps of both integrators.
fn ends<S: EnergyStepping<2> + Copy>(system: S) -> [SVector<f64, 2>; 2] {
    let (q, v) = ([0.4, -0.7], [0.3, 1.1]);
    let start = State::at(&system, 0.0, q, v);
    let fixed = system
        .at_state(start)
        .integrate(FixedStep, 0.02)
        .expect("a start")
        .take(100)
        .last()
        .expect("steps")
        .expect("a step");
    let energy = EnergyPreserving::from_midpoint(system, 0.0, q, v, 0.02).expect("a start");
    [fixed.q, energy.take(100).last().expect("steps").expect("a step").q]
}

#[test]
fn an_array_of_parameters_is_that_many_parameters() {
    let (listed, named) = (Listed::default(), Named::default());
    assert_eq!(ends(listed), ends(named));
    let other = Listed { m: [0.9, 2.5], k: [1.0, 7.0, 4.0], ..listed };
    let by_name = Named { m0: 0.9, m1: 2.5, k0: 1.0, k1: 7.0, k2: 4.0, ..named };
    assert_eq!(ends(other), ends(by_name));
    assert_ne!(ends(other), ends(listed));
}

#[test]
fn an_array_of_parameters_is_a_field() {
    let mut listed = Listed::default();
    assert_eq!((listed.m, listed.k, listed.c, listed.only), ([1.5, 0.5], [3.0; 3], 0.1, [0.7]));
    assert_eq!(format!("{listed:?}"), "Listed { m: [1.5, 0.5], k: [3.0, 3.0, 3.0], c: 0.1, only: [0.7] }");
    let names = ["m[0]", "m[1]", "k[0]", "k[1]", "k[2]", "c", "only[0]"];
    assert_eq!(<Listed as Lagrangian<2>>::PARAMETERS, names);
    for (index, name) in names.into_iter().enumerate() {
        let value = 10.0 + f64::from(u8::try_from(index).expect("few parameters"));
        *listed.parameter_mut(name).expect("a parameter") = value;
        assert_eq!(Lagrangian::<2>::parameter(&listed, index).to_bits(), value.to_bits());
    }
    assert_eq!((listed.m, listed.k, listed.c, listed.only), ([10.0, 11.0], [12.0, 13.0, 14.0], 15.0, [16.0]));
    for other in ["m", "m[2]", "m[-1]", "m_0", "only"] {
        assert!(listed.parameter_mut(other).is_none(), "{other}");
    }
    assert_eq!(listed.convert::<f32>().convert::<f64>(), listed);
    let systems = [listed, Listed::default()];
    let rows = Listed::rows(&systems);
    assert_eq!([0, 1].map(|index| Listed::from_rows(&rows, index)), systems);
}

type Long = SVector<f64, 120>;

lagrangian! {
    /// A chain of unlike masses, long enough for loops.
    struct LongListed {
        const N = 120;
        param m[N] = 1.25, k[N] = 2.0;
        coord q[N];
        L = sum(i in 0..N, m[i] * dot(q[i])^2) / 2 - sum(i in 1..N, k[i] * (q[i] - q[i - 1])^2) / 2 - k[0] * q[0]^4;
        discretize midpoint;
    }
}

/// Momentum, force and a step of a long chain by hand, with unequal parameters: the functions of a step are loops.
#[test]
fn every_entry_of_a_long_array_acts_in_its_place() {
    let mut chain = LongListed::default();
    let number = |index: usize| f64::from(u8::try_from(index).expect("few"));
    for index in 0..120 {
        chain.m[index] = 1.0 + number(index) / 7.0;
        chain.k[index] = 2.0 + (number(index) * 1.3).sin();
    }
    let q = Long::from_fn(|i, _| (number(i) * 0.9).cos());
    let v = Long::from_fn(|i, _| (number(i) * 0.4).sin());
    let momentum = Long::from_fn(|i, _| chain.m[i] * v[i]);
    // Measured 0.
    assert!((chain.momentum(0.0, &q, &v) - momentum).amax() < 1e-15);
    let force = |q: &Long| {
        let spring = |i: usize| if i == 0 { 4.0 * chain.k[0] * q[0].powi(3) } else { chain.k[i] * (q[i] - q[i - 1]) };
        Long::from_fn(|i, _| if i + 1 < 120 { spring(i + 1) - spring(i) } else { -spring(i) })
    };
    let found = chain.acceleration(0.0, &q, &v).expect("a mass matrix");
    let acceleration = Long::from_fn(|i, _| force(&q)[i] / chain.m[i]);
    let error = (found - acceleration).amax();
    // Measured 1.1e-16.
    assert!(error < 3e-16, "{error:e}");
    assert!(acceleration.amax() > 1.0);
    let h = 0.1;
    let end = chain.at(0.0, q, v).integrate(FixedStep, h).expect("a start").step().expect("a step").q;
    let by_velocity = Long::from_fn(|i, _| chain.m[i] * (end[i] - q[i]) / h);
    let residual = (by_velocity - force(&((q + end) / 2.0)) * (h / 2.0) - momentum).amax();
    // Measured 1.3e-14, for momenta up to 17.
    assert!(residual < 3e-14, "{residual:e}");
}

lagrangian! {
    /// A pole on a cart with a push: the push is a parameter that is zero until a controller sets it.
    struct CartPole {
        param M = 1.0, m = 0.2, l = 0.5, g = 9.81;
        param u = 0.0;
        coord x, a;
        L = (M + m) * dot(x)^2 / 2 + m * l * dot(x) * dot(a) * cos(a) + m * l^2 * dot(a)^2 / 2 - m * g * l * cos(a);
        force x = u;
        discretize midpoint, trapezoidal;
        check { u = 1.0, a = 0.5, dot(x) = 0.3; h = 0.002; }
    }
}

lagrangian! {
    /// Springs between three masses, from an adjacency matrix of which only the upper triangle is used.
    struct Graph {
        const N = 3;
        param k[N * N] = 0.0, m[N] = 1.0;
        coord q[N];
        let stretch[i in 0..N] = sum(j in i + 1..N, k[N * i + j] * (q[j] - q[i])^2);
        L = sum(i in 0..N, m[i] * dot(q[i])^2 / 2 - stretch[i] / 2);
        discretize midpoint;
        check { k[1] = 40.0, k[5] = 30.0, q[i in 0..N] = i^2 / 10; m[0] = 2.0; h = 0.002; }
    }
}

#[test]
fn entries_of_a_parameter_may_be_unused() {
    let mut graph = Graph::default();
    assert_eq!(<Graph as Lagrangian<3>>::PARAMETERS.len(), 12);
    let (q, v) = (SVector::from([0.0, 1.0, 3.0]), SVector::zeros());
    // The spring from 1 to 2 is stretched by 2; k[7] is in the unused triangle.
    for (name, stiffness, potential) in [("k[5]", 0.0, 0.0), ("k[5]", 3.0, 6.0), ("k[7]", 5.0, 6.0)] {
        *graph.parameter_mut(name).expect("an entry") = stiffness;
        let found = -graph.lagrangian(0.0, &q, &v);
        // Exact: a product of small integers.
        assert!((found - potential).abs() <= 0.0, "{name}: {found}");
    }
}
