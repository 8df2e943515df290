//! Linearization and equilibria with constraints, against the same systems in angles.

use super::systems::{Auto, HeavyTop};
use vi_core::constrained::Extended;
use vi_core::motion::Motion as _;
use vi_core::nalgebra::{DVector, SVector};
use vi_core::prelude::*;
use vi_core::{Lagrangian, State, StepError, lagrangian};

lagrangian! {
    /// Two rods, with friction.
    struct Rods {
        param m = 1.5, g = 9.81, l = 1.2, c = 0.0;
        input push = 0.0;
        coord x, y, u, w;
        L = m / 2 * (dot(x)^2 + dot(y)^2) + (dot(u)^2 + dot(w)^2) / 2 - g * (m * y + w);
        force u = push - c * dot(u);
        force w = -c * dot(w);
        constraint upper = x^2 + y^2 - l^2;
        constraint lower = (u - x)^2 + (w - y)^2 - 1;
    }
}

lagrangian! {
    /// The same in angles.
    struct Angles {
        param m = 1.5, g = 9.81, l = 1.2, c = 0.0;
        coord a, b;
        let du = l * cos(a) * dot(a) + cos(b) * dot(b), dw = l * sin(a) * dot(a) + sin(b) * dot(b);
        L = m / 2 * l^2 * dot(a)^2 + (du^2 + dw^2) / 2 + g * (m * l * cos(a) + l * cos(a) + cos(b));
        dissipation = c / 2 * (du^2 + dw^2);
    }
}

lagrangian! {
    /// A point on springs with a blade.
    struct Blade {
        param k = 3.0;
        coord x, y, θ;
        L = (dot(x)^2 + dot(y)^2 + dot(θ)^2 - k * x^2 - k * y^2 - θ^2) / 2;
        constraint blade = dot(x) * sin(θ) - dot(y) * cos(θ);
    }
}

lagrangian! {
    /// A pendulum on a pivot that moves.
    struct Lifted {
        param s = 0.5;
        coord x, y;
        L = (dot(x)^2 + dot(y)^2) / 2 - 9.81 * y;
        constraint rod = x^2 + (y - s * t)^2 - 1;
    }
}

#[test]
fn rods_hang_as_angles_do() {
    for c in [0.0, 0.4] {
        let rods = Rods { c, ..Rods::default() };
        // From a guess off the constraints.
        let rest = rods.equilibrium(0.0, [0.3, -1.0, 0.1, -2.0]).unwrap_or_else(|failure| panic!("{failure}"));
        let place = SVector::from([0.0, -1.2, 0.0, -2.2]);
        assert!((rest.q - place).amax() < 1e-15, "{rest:?}");
        // 2 l Λ carries both weights, 2 Λ the lower one.
        assert!((rest.multipliers[0] + 2.5 * 9.81 / 2.4).abs() < 4e-15, "{rest:?}");
        assert!((rest.multipliers[1] + 9.81 / 2.0).abs() < 4e-15 && rest.residual <= 4.0, "{rest:?}");
        let angles = Angles { c, ..Angles::default() }.equilibrium(0.0, [0.1, -0.1]).expect("an equilibrium");
        let (found, wanted) = (rest.rates().expect("rates"), angles.rates().expect("rates"));
        assert_eq!(found.len(), wanted.len());
        for (found, wanted) in found.iter().zip(&wanted) {
            println!("{found} {wanted} {:e}", (found - wanted).norm());
            // Measured: at most 1.1e-14.
            assert!((found - wanted).norm() < 2e-14, "{found} {wanted}");
        }
        assert_eq!(rest.frequencies().expect("frequencies").len(), 2);
        assert!(found.iter().all(|rate| if c == 0.0 { rate.re == 0.0 } else { rate.re < -0.01 }), "{found:?}");
    }
}

#[test]
fn a_top_hangs_at_any_turn() {
    // J1 = 1, m g l = 2. The turn about the vertical is free.
    let top = Auto(HeavyTop { j: 0.0 });
    let rest = top.equilibrium(0.0, [0.0, 1.0, 0.0, 0.0]).unwrap_or_else(|failure| panic!("{failure}"));
    assert_eq!((rest.q, rest.free()), (SVector::from([0.0, 1.0, 0.0, 0.0]), [false, false, true, false]));
    for guess in [[0.0, 1.0, 0.0, 0.0], [0.3, 1.1, 0.4, -0.2], [0.1, 0.0, -1.0, 0.6]] {
        let rest = top.equilibrium(0.0, guess).unwrap_or_else(|failure| panic!("{guess:?}: {failure}"));
        assert!(rest.q[0].abs() + rest.q[3].abs() < 1e-15 && (rest.q.norm() - 1.0).abs() < 1e-15, "{rest:?}");
        // The free motion turns b into c.
        let [motion] = rest.free_motions.as_slice().as_chunks().0 else { panic!("{rest:?}") };
        let wanted = SVector::from([0.0, -rest.q[2], rest.q[1], 0.0]);
        assert!((SVector::<f64, 4>::from(*motion).dot(&wanted).abs() - 1.0).abs() < 1e-14, "{rest:?}");
        let rates = rest.rates().expect("rates");
        assert_eq!((rates.len(), rates[0].norm(), rates[1].norm()), (6, 0.0, 0.0), "{rates:?}");
        let frequencies = rest.frequencies().expect("frequencies");
        let off = frequencies.iter().map(|frequency| (frequency - 2.0_f64.sqrt()).abs()).fold(0.0, f64::max);
        println!("{off:e}");
        assert!(frequencies.len() == 2 && off < 1e-14, "{frequencies:?}");
    }
    // Upright it falls.
    let rates = top.equilibrium(0.0, [1.0, 0.0, 0.0, 0.0]).and_then(|rest| rest.rates()).expect("rates");
    assert_eq!(rates.iter().filter(|rate| (rate.re - 2.0_f64.sqrt()).abs() < 1e-14).count(), 2, "{rates:?}");
}

#[test]
fn rods_that_stand_are_unstable() {
    let rest = Rods::default().equilibrium(0.0, [0.1, 1.2, 0.05, 2.2]).unwrap_or_else(|failure| panic!("{failure}"));
    assert!((rest.q - SVector::from([0.0, 1.2, 0.0, 2.2])).amax() < 1e-14, "{rest:?}");
    let rates = rest.rates().expect("rates");
    assert_eq!(rates.iter().filter(|rate| rate.re > 1.0).count(), 2, "{rates:?}");
    assert!(rest.frequencies().expect("rates").is_empty());
}

lagrangian! {
    /// A point on springs, on a line, in any unit of the constraint.
    struct Line {
        param unit = 1.0;
        coord x, y;
        L = (dot(x)^2 + dot(y)^2 - 3 * x^2 - 5 * y^2) / 2;
        constraint line = unit * (2 * x - y);
    }
}

#[test]
fn the_unit_of_a_constraint_does_not_matter() {
    for unit in [1.0, 1e150, 1e155, 1e-155, 1e-170] {
        let rest = Line { unit }.equilibrium(0.0, [0.3, 0.7]);
        let rest = rest.unwrap_or_else(|failure| panic!("{unit:e}: {failure}"));
        let frequencies = rest.frequencies().unwrap_or_else(|failure| panic!("{unit:e}: {failure}"));
        // With y = 2 x the mass is 5, the stiffness 23.
        assert_eq!(frequencies.len(), 1, "{unit:e}: {rest:?}");
        assert!((frequencies[0] - (23.0_f64 / 5.0).sqrt()).abs() < 1e-15, "{unit:e}: {frequencies:?}");
    }
}

#[test]
fn a_push_holds_the_rods_aside() {
    // The lower rod lies along the force on its mass.
    let rods = Rods { push: 9.81, ..Rods::default() };
    let rest = rods.equilibrium(0.0, [0.3, -1.1, 1.0, -1.8]).unwrap_or_else(|failure| panic!("{failure}"));
    let lower = SVector::<f64, 2>::from([rest.q[2] - rest.q[0], rest.q[3] - rest.q[1]]);
    assert!((lower - SVector::from([0.5_f64.sqrt(), -0.5_f64.sqrt()])).amax() < 1e-15, "{rest:?}");
    let state = State::at(&rods, 0.0, rest.q, [0.0; 4]);
    let reaction = state.reaction(&rods).expect("regular");
    assert!(reaction.iter().zip(&rest.multipliers).all(|(one, other)| (one - other).abs() < 1e-14), "{reaction:?}");
    let acceleration = rods.acceleration(0.0, &rest.q, &SVector::zeros()).expect("regular");
    assert!(acceleration.amax() < 1e-14, "{acceleration}");
}

#[test]
fn linearizations_are_differences() {
    let rods = Rods { push: 0.3, c: 0.2, ..Rods::default() };
    let state = State::projected(&rods, 0.0, [0.6, -0.9, 1.1, -1.7], [0.5, 0.4, 0.3, 0.2]).expect("nearest").state;
    let (q, v) = (state.q, state.velocity(&rods).expect("regular"));
    let found = rods.linearization(0.0, q, v).unwrap_or_else(|failure| panic!("{failure}"));
    // Off the constraints by the difference.
    let rate = |column: usize, by: f64| {
        let (mut rods, mut q, mut v) = (rods, q, v);
        match column {
            0..4 => q[column] += by,
            4..8 => v[column - 4] += by,
            _ => rods.push += by,
        }
        let acceleration = Extended(rods).acceleration(0.0, &q, &v).expect("regular");
        DVector::from_iterator(8, v.iter().chain(&acceleration).copied())
    };
    for column in 0..9 {
        let by = 1e-5;
        let difference = (rate(column, by) - rate(column, -by)) / (2.0 * by);
        let exact = if column < 8 { found.a.column(column) } else { found.b.column(0) };
        let off = (exact - &difference).amax() / (1.0 + difference.amax());
        println!("{column} {off:e}");
        // Measured: at most 3.7e-10.
        assert!(off < 1e-9, "{column}: {off:e}");
    }
    // Twice zero for each rod: a change across it neither grows nor swings.
    let rest = Rods::default().equilibrium(0.0, [0.3, -1.0, 0.1, -2.0]).expect("an equilibrium");
    let of_rest =
        Rods::default().linearization(0.0, rest.q, [0.0; 4]).expect("regular").eigenvalues().expect("a spectrum");
    println!("{of_rest:?}");
    // Double zeros: the root of the rounding errors.
    assert_eq!(of_rest.iter().filter(|rate| rate.norm() < 1e-6).count(), 4, "{of_rest:?}");
    let (fast, wanted) = (of_rest.iter().map(|rate| rate.im).fold(0.0, f64::max), rest.frequencies().expect("rates"));
    assert!((fast - wanted[1]).abs() < 1e-12, "{fast} {wanted:?}");
}

#[test]
fn accelerations_and_linearizations_off_the_constraints_are_errors() {
    let rods = Rods::default();
    let state = State::projected(&rods, 0.0, [0.6, -0.9, 1.1, -1.7], [0.5, 0.4, 0.3, 0.2]).expect("nearest").state;
    let (q, v) = (state.q, state.velocity(&rods).expect("regular"));
    assert!(rods.acceleration(0.0, &q, &v).is_ok());
    assert_eq!(rods.acceleration(0.0, &q, &v), Extended(rods).acceleration(0.0, &q, &v));
    // The upper rod longer by a millionth; then a velocity along the lower one.
    let mut along = v;
    along[2] += 1e-6;
    for (constraint, q, v) in [("upper", q * (1.0 + 1e-6), v), ("lower", q, along)] {
        let found = [rods.acceleration(0.0, &q, &v).err(), rods.linearization(0.0, q, v).err()];
        for failure in found {
            let Some(StepError::InconsistentStart { constraint: named, residual, rate }) = failure else {
                panic!("{constraint}: {failure:?}")
            };
            let (r, is_upper) = (usize::from(constraint == "lower"), constraint == "upper");
            let value = rods.constraints(0.0, &q)[r];
            assert!(named == constraint && (residual - value).abs() < 1e-15, "{failure:?}");
            assert!(if is_upper { (residual - 2.88e-6).abs() < 1e-10 } else { rate.abs() > 1e-7 }, "{failure:?}");
        }
    }
    // Coordinates at zero have no size.
    let line = Line::default();
    assert!(line.linearization(0.0, [0.0; 2], [0.0; 2]).is_ok());
    assert!(line.acceleration(0.0, &[0.0, 1e-6].into(), &SVector::zeros()).is_err());
    let (still, blade) = (SVector::zeros(), Blade::default());
    assert!(blade.acceleration(0.0, &still, &[1.0, 0.0, 2.0].into()).is_ok());
    let across = blade.acceleration(0.0, &still, &[1.0, 1e-6, 2.0].into());
    assert!(
        matches!(across, Err(StepError::InconsistentStart { constraint: "blade", residual: 0.0, rate: -1e-6 })),
        "{across:?}"
    );
    let lost = rods.acceleration(0.0, &q, &(v * f64::NAN));
    assert!(matches!(lost, Err(StepError::NonFinite { .. })), "{lost:?}");
}

#[test]
fn a_reaction_far_off_the_constraints_is_an_error() {
    let rods = Rods::default();
    let state = State::projected(&rods, 0.0, [0.6, -0.9, 1.1, -1.7], [0.5, 0.4, 0.3, 0.2]).expect("nearest").state;
    let on = state.reaction(&rods).expect("a reaction");
    // As far off as dense output: the reaction is as accurate.
    let close = State { q: state.q * 1.0001, ..state }.reaction(&rods).expect("a reaction");
    let off = (close[0] / on[0] - 1.0).abs();
    // Measured: 1.04e-4.
    assert!(off > 1e-6 && off < 2e-4, "{off:e}");
    let far = State { q: state.q * 1.1, ..state };
    for failure in [far.reaction(&rods).err(), far.reaction_force(&rods).err()] {
        assert!(matches!(failure, Some(StepError::InconsistentStart { constraint: "upper", .. })), "{failure:?}");
    }
}

#[test]
fn a_blade_carries_what_it_forbids() {
    let rest = Blade::default().equilibrium(0.0, [0.5, 0.3, 0.0]).unwrap_or_else(|failure| panic!("{failure}"));
    assert!((rest.q - SVector::from([0.0, 0.3, 0.0])).amax() < 1e-15, "{rest:?}");
    // −k y − Λ = 0.
    assert!((rest.multipliers[0] + 0.9).abs() < 1e-15, "{rest:?}");
    // The reaction turns with the blade: it pushes along x by Λ θ.
    assert_eq!(rest.rates().expect("rates").len(), 4);
}

#[test]
fn places_without_an_equilibrium_are_errors() {
    let moving = Lifted::default().equilibrium(0.0, [0.0, -1.0]);
    assert!(
        matches!(moving, Err(StepError::InconsistentStart { constraint: "rod", rate, .. }) if (rate - 1.0).abs() < 1e-15),
        "{moving:?}"
    );
    // Without weight the rods rest anywhere.
    let family = Rods { g: 0.0, ..Rods::default() }.equilibrium(0.0, [0.3, -1.0, 0.1, -2.0]);
    assert!(matches!(family, Err(StepError::Singular { .. })), "{family:?}");
    let lost = Rods::default().equilibrium(0.0, [f64::NAN, -1.0, 0.1, -2.0]);
    assert!(matches!(lost, Err(StepError::NonFinite { .. })), "{lost:?}");
    let open = Rods::default().equilibrium(0.0, [0.0, 0.0, 0.0, 0.0]);
    assert!(open.is_err(), "{open:?}");
}
