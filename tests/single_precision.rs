//! Generated systems and both integrators in `f32`.

use vi_core::real::Scalar;
use vi_core::stepping::EnergyStepping;
use vi_core::{EnergyPreserving, FixedStep, Lagrangian, Starts, State};
use vi_systems::{HardDuffing, Kepler};

const STEPS: usize = 200;

/// Both integrators after some steps, and the largest energy change of the energy-preserving one, in roundings of 1.
struct Runs<const N: usize> {
    fixed: State<N>,
    energy_preserving: State<N>,
    energy_error: f64,
}

fn runs<const N: usize, T: Scalar, S: EnergyStepping<N, T> + Copy>(system: S, q: [f64; N], v: [f64; N]) -> Runs<N> {
    let h = T::real(0.05);
    let (q, v) = (q.map(T::real), v.map(T::real));
    let start = State::at(&system, T::zero(), q, v);
    let mut fixed = system.at_state(start).integrate(FixedStep, h).expect("a valid start");
    let mut energy_preserving = EnergyPreserving::from_midpoint(system, T::zero(), q, v, h).expect("a valid start");
    let (energy, mut energy_error) = (energy_preserving.node().energy, 0.0_f64);
    for _ in 0..STEPS {
        fixed.step().unwrap_or_else(|error| panic!("{}: {error}", S::NAME));
        let step = energy_preserving.detailed_step().unwrap_or_else(|error| panic!("{}: {error}", S::NAME));
        let (t, q, v) = step.midpoint;
        energy_error = energy_error.max((system.energy(t, &q, &v) - energy).abs().to_f64() / T::EPSILON);
    }
    let number =
        |state: State<N, T>| State { t: state.t.to_f64(), q: state.q.map(T::to_f64), p: state.p.map(T::to_f64) };
    Runs { fixed: number(fixed.state()), energy_preserving: number(energy_preserving.state()), energy_error }
}

fn difference<const N: usize>(one: &State<N>, other: &State<N>) -> f64 {
    (one.q - other.q).amax().max((one.p - other.p).amax()).max((one.t - other.t).abs())
}

/// Differences of the runs in `f32` to those in `f64`: fixed and energy-preserving steps.
fn differences<const N: usize>(single: &Runs<N>, double: &Runs<N>) -> [f64; 2] {
    let fixed = difference(&single.fixed, &double.fixed);
    [fixed, difference(&single.energy_preserving, &double.energy_preserving)]
}

#[test]
fn kepler() {
    let (system, q, v) = (Kepler { mu: 1.2 }, [0.5, 0.0], [0.1, 1.8]);
    let double = runs::<2, f64, _>(system, q, v);
    let single = runs::<2, f32, _>(system.convert::<f32>(), q, v);
    // Measured: 6.0e-6, and 2.3e-4: the step length is a second-order quantity.
    let [fixed, energy_preserving] = differences(&single, &double);
    assert!(fixed <= 8e-6 && energy_preserving <= 4e-4, "{fixed:e}, {energy_preserving:e}");
    // Measured: 3 and 5, for v²/2 and μ/r of 2.4.
    assert!(
        single.energy_error <= 8.0 && double.energy_error <= 12.0,
        "{} {}",
        single.energy_error,
        double.energy_error
    );
}

#[test]
fn hard_duffing() {
    let (system, q, v) = (HardDuffing { beta: 0.8, ..HardDuffing::default() }, [1.0], [0.2]);
    let double = runs::<1, f64, _>(system, q, v);
    let single = runs::<1, f32, _>(system.convert::<f32>(), q, v);
    // Measured: 5.6e-7, 2.5e-4 (8.2e-5 with another order of terms: a random walk of roundings).
    let [fixed, energy_preserving] = differences(&single, &double);
    assert!(fixed <= 2e-6 && energy_preserving <= 1e-3, "{fixed:e}, {energy_preserving:e}");
}

#[test]
fn parameters_are_rounded_once() {
    let system = Kepler { mu: 1.1 }.convert::<f32>();
    assert_eq!(system.mu.to_bits(), 1.1_f32.to_bits());
    let found = system.lagrangian(0.0, &[0.6, 0.8].into(), &[1.0, 0.0].into());
    // v²/2 + μ/r, within one rounding.
    assert!((found - 1.6).abs() <= f32::EPSILON, "{found}");
}
