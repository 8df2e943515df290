//! Invariance under units: a system in metres and radians, with masses of 1 and 1e-12, moves like the same system in
//! equal units.

use vi_core::stepping::EnergyStepping;
use vi_core::{EnergyPreserving, FixedStep, SVector, Starts, State, StepError, lagrangian};

/// A system of angles u and angular velocities w, in the coordinates q = u, and in q with u_i = 2^(25 i (−1)^i) q_i:
/// masses of 1 to 1e-75. Powers of two do not round.
macro_rules! in_two_units {
    ($plain:ident, $in_units:ident, $n:literal, $($clauses:tt)*) => {
        lagrangian! {
            struct $plain {
                coord q[$n];
                let u[i in 0..$n] = q[i], w[i in 0..$n] = dot(q[i]);
                $($clauses)*
                discretize midpoint;
            }
        }
        lagrangian! {
            struct $in_units {
                coord q[$n];
                let unit[i in 0..$n] = 2^(25 * i * (-1)^i);
                let u[i in 0..$n] = unit[i] * q[i], w[i in 0..$n] = unit[i] * dot(q[i]);
                $($clauses)*
                discretize midpoint;
            }
        }
    };
}

fn unit(i: usize) -> f64 {
    let power = i32::try_from(25 * i).expect("few coordinates");
    2.0_f64.powi(if i.is_multiple_of(2) { power } else { -power })
}

// Neighbours only: the matrix is tridiagonal.
in_two_units!(Row, RowInUnits, 6,
    L = sum(i in 0..6, w[i]^2 / 2 + cos(u[i])) + sum(i in 1..6, w[i] * w[i - 1] * cos(u[i] - u[i - 1])) / 5;
);

// All pairs interact, and nonreciprocal forces make the matrix unsymmetric: it is dense.
in_two_units!(Net, NetInUnits, 5,
    L = sum(i in 0..5, w[i]^2 + cos(u[i])) + sum(i in 0..5, sum(j in 0..i, w[i] * w[j] * cos(u[i] - u[j]))) / 4;
    dissipation = (w[0] * u[1] - w[4] * u[2])^2;
);

// Two and three: solved in closed form.
in_two_units!(Pair, PairInUnits, 2, L = (w[0]^2 + w[1]^2 + w[0] * w[1] * cos(u[0] - u[1])) / 2 + cos(u[0]) + cos(u[1]););
in_two_units!(Three, ThreeInUnits, 3,
    L = sum(i in 0..3, w[i]^2 / 2 + cos(u[i])) + (w[0] * w[1] * cos(u[0] - u[1]) + w[2] * w[0] * u[1]) / 3;
);

/// The initial state in equal units: 0.3, 0.5, … with the velocities 0.7, 0.5, ….
fn start<const N: usize>(unit: impl Fn(usize) -> f64) -> [SVector<f64, N>; 2] {
    let angle = |i: usize| 0.3 + 0.2 * f64::from(u8::try_from(i).expect("few coordinates"));
    [SVector::from_fn(|i, _| angle(i) / unit(i)), SVector::from_fn(|i, _| (1.0 - angle(i)) / unit(i))]
}

/// The largest difference of an angle in both systems, over 500 steps.
fn angle_difference<const N: usize>(
    plain: impl Iterator<Item = Result<SVector<f64, N>, StepError>>,
    in_units: impl Iterator<Item = Result<SVector<f64, N>, StepError>>,
) -> f64 {
    let [first, _] = start::<N>(|_| 1.0);
    let (mut difference, mut moved, mut steps) = (0.0_f64, 0.0_f64, 0);
    for (plain, in_units) in plain.zip(in_units).take(500) {
        let (plain, in_units) = (plain.expect("a step"), in_units.expect("a step"));
        moved = moved.max((plain - first).amax());
        for i in 0..N {
            let off = (plain[i] - unit(i) * in_units[i]).abs();
            assert!(off.is_finite());
            difference = difference.max(off);
        }
        steps += 1;
    }
    assert!(steps == 500 && moved > 0.1, "{steps} steps move the system by {moved}");
    difference
}

fn fixed<const N: usize>(plain: impl EnergyStepping<N>, in_units: impl EnergyStepping<N>) -> f64 {
    fn run<const N: usize>(
        system: impl EnergyStepping<N>,
        unit: impl Fn(usize) -> f64,
    ) -> impl Iterator<Item = Result<SVector<f64, N>, StepError>> {
        let [q, v] = start(unit);
        let start = State::at(&system, 0.0, q, v);
        system.at_state(start).integrate(FixedStep, 0.01).expect("a right start").map(|step| step.map(|state| state.q))
    }
    angle_difference(run(plain, |_| 1.0), run(in_units, unit))
}

fn energy_preserving<const N: usize>(plain: impl EnergyStepping<N>, in_units: impl EnergyStepping<N>) -> f64 {
    fn run<const N: usize>(
        system: impl EnergyStepping<N>,
        unit: impl Fn(usize) -> f64,
    ) -> impl Iterator<Item = Result<SVector<f64, N>, StepError>> {
        let [q, v] = start(unit);
        let run = EnergyPreserving::from_midpoint(system, 0.0, q, v, 0.01).expect("a right start");
        run.map(|step| step.map(|step| step.q))
    }
    angle_difference(run(plain, |_| 1.0), run(in_units, unit))
}

#[test]
fn trajectories_are_the_same_in_any_units() {
    let fixed = [
        fixed(Row::default(), RowInUnits::default()),
        fixed(Net::default(), NetInUnits::default()),
        fixed(Pair::default(), PairInUnits::default()),
        fixed(Three::default(), ThreeInUnits::default()),
    ];
    let energy_preserving = [
        energy_preserving(Row::default(), RowInUnits::default()),
        energy_preserving(Net::default(), NetInUnits::default()),
        energy_preserving(Pair::default(), PairInUnits::default()),
        energy_preserving(Three::default(), ThreeInUnits::default()),
    ];
    println!("{fixed:?} {energy_preserving:?}");
    // Measured: 2.2e-16; 2.1e-12 for energy-preserving steps, since the rounding of the energy affects the length.
    for (difference, tolerance) in fixed
        .map(|difference| (difference, 5e-16))
        .into_iter()
        .chain(energy_preserving.map(|difference| (difference, 5e-12)))
    {
        assert!(difference <= tolerance, "{difference:e}");
    }
}
