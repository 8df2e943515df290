//! The gains of the controller, from the linearization of its step.

use controller::{CartPole, FILTER, PERIOD, REGULATOR};
use vi_core::nalgebra::{DMatrix, DVector};
use vi_core::prelude::*;

/// The gain `(R + Bᵀ P B)⁻¹ Bᵀ P A` with the P that solves `P = Aᵀ P (A − B gain) + Q`, by iteration.
fn riccati([a, b, q, r]: [&DMatrix<f64>; 4]) -> DMatrix<f64> {
    let mut p = q.clone();
    for _ in 0..100_000 {
        let gain = (r + b.transpose() * &p * b).lu().solve(&(b.transpose() * &p * a)).expect("R is positive");
        let next = a.transpose() * &p * (a - b * &gain) + q;
        let change = (&next - &p).amax();
        p = next;
        if change <= 1e-13 * p.amax() {
            return gain;
        }
    }
    panic!("no stationary solution");
}

/// A and B of a step about the upright pendulum.
fn linearized() -> [DMatrix<f64>; 2] {
    let upright = CartPole::default().at(0.0, [0.0, 0.0], [0.0, 0.0]);
    let linear = upright.integrate(FixedStep, f64::from(PERIOD)).unwrap().linearization().unwrap();
    [linear.a, linear.b]
}

fn diagonal(entries: &[f64]) -> DMatrix<f64> {
    DMatrix::from_diagonal(&DVector::from_row_slice(entries))
}

/// Checks the gains of the controller against these.
fn compare<'a>(gains: impl IntoIterator<Item = &'a f32>, best: &DMatrix<f64>) {
    println!("{best:.9}");
    let off = gains.into_iter().zip(best).map(|(gain, best)| (f64::from(*gain) - best).abs() / best.abs());
    let off = off.fold(0.0, f64::max);
    println!("off by {off:.1e}");
    assert!(off < 1e-6);
}

#[test]
fn the_regulator_is_the_best_for_its_costs() {
    let [a, b] = linearized();
    // A decimetre, a tenth of a radian and a newton cost the same.
    let best = riccati([&a, &b, &diagonal(&[100.0, 100.0, 0.0, 0.0]), &diagonal(&[1.0])]);
    compare(&REGULATOR, &best);
}

#[test]
fn the_filter_is_the_best_for_its_noise() {
    let [a, _] = linearized();
    // Disturbances of the momenta in a period, and encoders with 4000 counts a metre and 8192 a turn.
    let disturbances = diagonal(&[0.0, 0.0, 1e-6, 1e-8]);
    let counts = [1.0 / 4000.0, core::f64::consts::TAU / 8192.0];
    let measured = diagonal(&counts.map(|count| count * count / 12.0));
    let predicted = riccati([&a.transpose(), &DMatrix::identity(4, 2), &disturbances, &measured]).transpose();
    // That gain corrects a prediction. The controller corrects before its step.
    let best = a.lu().solve(&predicted).expect("a step can be undone");
    compare(&FILTER, &best);
}
