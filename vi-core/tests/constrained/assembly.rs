//! States on the constraints from far guesses, and with held coordinates.

use super::systems::PENDULUM;
use vi_core::constrained::Projection;
use vi_core::motion::Motion;
use vi_core::{Gauss, Lagrangian, SVector, Starts, State, StepError, lagrangian};

lagrangian! {
    /// Crank, coupler and rocker between the pivots (0, 0) and (3, 0).
    struct FourBar {
        param crank = 1.0, coupler = 3.0, rocker = 2.0;
        coord x, y, u, w;
        L = dot(x)^2 + dot(y)^2 + (dot(u)^2 + dot(w)^2) / 2 - 9.81 * (2 * y + w);
        constraint front = x^2 + y^2 - crank^2;
        constraint middle = (u - x)^2 + (w - y)^2 - coupler^2;
        constraint back = (u - 3)^2 + w^2 - rocker^2;
    }
}

/// The largest g at a state.
fn off<S: Motion<N>, const N: usize>(system: &S, state: &State<N>) -> f64 {
    system.constraints(state.t, &state.q).as_ref().iter().fold(0.0, |worst, value| value.abs().max(worst))
}

#[test]
fn a_four_bar_closes_from_a_right_angle_away() {
    let system = FourBar::default();
    // Crank up, coupler to the right and rocker: the assembly is crank (0, 1), and u, w from two circles. The guesses
    // turn each link by up to a right angle, and stretch it.
    let mut worst = 0.0_f64;
    for turn in [-1.5, -1.0, -0.5, 0.5, 1.0, 1.5] {
        for stretch in [0.3, 1.0, 2.5] {
            let link = |angle: f64, length: f64| {
                let (sine, cosine) = (angle + turn).sin_cos();
                [stretch * length * cosine, stretch * length * sine]
            };
            let ([x, y], [a, b]) = (link(1.57, 1.0), link(0.3, 3.0));
            let guess = [x, y, x + a, y + b];
            let found = State::assembled(&system, 0.0, guess, [0.1, 0.2, -0.3, 0.1]);
            let found = found.unwrap_or_else(|failure| panic!("{turn} {stretch}: {failure}"));
            worst = worst.max(off(&system, &found.state));
            // Measured: at most 1.8e-15.
            assert!(off(&system, &found.state) < 4e-15, "{turn} {stretch}: {:e}", off(&system, &found.state));
            // An angle of the moved links of a few radians at most.
            assert!(found.moved_q.norm() < 12.0, "{turn} {stretch}: {found:?}");
            let mut run = system.at_state(found.state).integrate(Gauss::<2>, 0.01).expect("a start");
            run.step().unwrap_or_else(|failure| panic!("{failure}"));
        }
    }
    println!("{worst:e}");
    // Near guesses give the nearest state.
    let (q, v) = ([0.05, 1.02, 2.9, 1.95], [0.0; 4]);
    let near = [State::assembled(&system, 0.0, q, v), State::projected(&system, 0.0, q, v)];
    let [assembled, projected] = near.map(|found| found.unwrap_or_else(|failure| panic!("{failure}")));
    assert_eq!(assembled, projected);
}

#[test]
fn a_rod_is_found_from_beside_its_centre() {
    for [x, y] in [[1e-300, 0.0], [1e-12, 0.0], [0.0, -1e-9], [1e-8, 1e-9], [-1e-7, 0.0], [1e-4, 2e-4], [3e7, 4e7]] {
        for found in [State::assembled, State::projected].map(|find| find(&PENDULUM, 0.0, [x, y], [0.0, 0.0])) {
            let found = found.unwrap_or_else(|failure| panic!("{x} {y}: {failure}"));
            assert!(off(&PENDULUM, &found.state) < 1e-15, "{found:?}");
            // Along the radius.
            let length = f64::hypot(x, y);
            let wanted = SVector::from([x / length, y / length]);
            assert!((found.state.q - wanted).amax() < 1e-7, "{x} {y}: {found:?}");
        }
    }
    for found in [State::assembled, State::projected].map(|find| find(&PENDULUM, 0.0, [0.0, 0.0], [0.0, 0.0])) {
        assert!(found.is_err(), "{found:?}");
    }
}

#[test]
fn a_four_bar_closes_from_any_guess() {
    let system = FourBar::default();
    let mut state = 7_u32;
    let mut draw = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state) / f64::from(1_u32 << 31) - 1.0
    };
    let mut worst = 0.0_f64;
    for _ in 0..200 {
        let guess: [f64; 4] = core::array::from_fn(|_| 5.0 * draw());
        let find = [State::assembled::<FourBar>, State::projected::<FourBar>];
        for found in find.map(|find| find(&system, 0.0, guess, [0.0; 4])) {
            let found = found.unwrap_or_else(|failure| panic!("{guess:?}: {failure}"));
            worst = worst.max(off(&system, &found.state));
        }
        // The move from the guess is along the gradients, in the metric of the masses.
        let nearest = State::projected(&system, 0.0, guess, [0.0; 4]).expect("closed");
        let moved = nearest.moved_q.component_mul(&SVector::from([2.0, 2.0, 1.0, 1.0]));
        let (rows, _) = system.constraint_gradients(0.0, &nearest.state.q);
        let rows = [0, 1, 2].map(|r| rows.row(r).dense::<4>());
        let normals = vi_core::nalgebra::SMatrix::<f64, 4, 3>::from_columns(&rows);
        let inverse = (normals.transpose() * normals).try_inverse().expect("independent");
        let rest = (moved - normals * (inverse * (normals.transpose() * moved))).amax();
        assert!(rest < 1e-4, "{guess:?}: {rest:e}");
    }
    println!("{worst:e}");
    assert!(worst < 1e-13, "{worst:e}");
}

#[test]
fn a_linkage_that_is_too_short_stays_open() {
    // 1 + 1 + 0.5 do not reach from 0 to 3: half a unit is missing.
    let system = FourBar { crank: 1.0, coupler: 1.0, rocker: 0.5 };
    let failure = State::assembled(&system, 0.25, [0.2, 0.9, 1.1, 1.2], [0.0; 4]).expect_err("open");
    let StepError::NotAssembled { t, constraint, residual, gap, passed } = failure else { panic!("{failure}") };
    println!("{failure}");
    assert_eq!(t.to_bits(), 0.25_f64.to_bits());
    assert!(["front", "middle", "back"].contains(&constraint) && passed > 0.3 && passed < 1.0, "{failure}");
    // The missing half is shared among the links, each at least a sixth where they share it evenly.
    assert!(gap > 0.1 && gap < 0.5 && residual > 0.0, "{failure}");
    let text = failure.to_string();
    assert!(text.contains(constraint) && text.contains("gap") && text.contains("anchors"), "{text}");
    // All links in line: no side to bend to is preferred.
    let flat = State::assembled(&FourBar::default(), 0.0, [0.5, 0.0, 1.0, 0.0], [0.0; 4]);
    assert!(matches!(flat, Err(StepError::Singular { .. })), "{flat:?}");
    let lost = State::assembled(&FourBar::default(), 0.0, [f64::NAN, 0.0, 1.0, 0.0], [0.0; 4]);
    assert!(matches!(lost, Err(StepError::NonFinite { .. })), "{lost:?}");
}

#[test]
fn held_coordinates_stay() {
    let system = FourBar::default();
    // The crank keeps its height: the rest follows.
    let projection = Projection::of(&system).holding(&[1]).unwrap_or_else(|failure| panic!("{failure}"));
    let (q, v) = ([0.7, 0.6, 2.9, 1.7], [0.3, 0.4, 0.5, 0.6]);
    for found in [projection.projected(0.0, q, v), projection.assembled(0.0, q, v)] {
        let found = found.unwrap_or_else(|failure| panic!("{failure}"));
        assert_eq!((found.moved_q[1], found.moved_v[1]), (0.0, 0.0));
        // A crank of length 1 at the height 0.6.
        assert!((found.state.q[0] - 0.8).abs() < 1e-15 && found.moved_q.norm() > 0.1, "{found:?}");
        assert!(off(&system, &found.state) < 1e-14);
        system.at_state(found.state).integrate(Gauss::<1>, 0.01).expect("a start");
    }
    // Three rods leave one coordinate.
    let all = Projection::of(&system).holding(&[0, 1]).expect("indices");
    assert!(matches!(all.projected(0.0, q, v), Err(StepError::Singular { .. })));
    // A crank of the right length, and a velocity across it: the other two rods follow.
    let (q, v) = ([0.6, 0.8, 2.9, 1.7], [0.8, -0.6, 0.1, 0.2]);
    for found in [all.projected(0.0, q, v), all.assembled(0.0, q, v)] {
        let found = found.unwrap_or_else(|failure| panic!("{failure}"));
        assert!(found.moved_q.rows(0, 2).amax() <= 0.0 && found.moved_v.rows(0, 2).amax() <= 0.0, "{found:?}");
        assert!(off(&system, &found.state) < 1e-14 && found.moved_q.norm() > 0.01, "{found:?}");
        system.at_state(found.state).integrate(Gauss::<1>, 0.01).expect("a start");
    }
    let along = all.projected(0.0, q, [0.6, 0.8, 0.1, 0.2]);
    assert!(
        matches!(along, Err(StepError::InconsistentStart { constraint: "front", residual: 0.0, rate: 2.0 })),
        "{along:?}"
    );
    assert!(matches!(Projection::of(&system).holding(&[4]), Err(StepError::InvalidInput { value: 4.0, .. })));
}

#[test]
fn the_energy_lost_is_that_of_the_removed_velocity() {
    let system = FourBar::default();
    let start = State::assembled(&system, 0.0, [0.0, 1.0, 2.9, 1.95], [0.0; 4]).expect("closed").state;
    let v = [0.3, -0.4, 0.5, 0.6];
    let found = State::projected(&system, 0.0, start.q, v).expect("nearest");
    let lost: f64 = found.moved_v.iter().zip([2.0, 2.0, 1.0, 1.0]).map(|(v, mass)| 0.5 * mass * v * v).sum();
    println!("{lost} {:e}", found.energy_lost - lost);
    // Measured: 2.7e-15.
    assert!(lost > 0.1 && (found.energy_lost - lost).abs() < 1e-14, "{found:?}");
    let energy = system.energy(0.0, &start.q, &v.into());
    let left = found.state.energy(&system).expect("regular");
    assert!((energy - left - lost).abs() < 1e-13, "{energy} {left}");
}
