//! Twenty and forty links and bodies, in loops, against their equations of motion by hand, which DOP853 integrates; and
//! forty links with constraints.

use core::cell::Cell;
use std::thread;
use vi_core::check::Trajectory;
use vi_core::lagrangian::Flow;
use vi_core::motion::Motion as _;
use vi_core::nalgebra::SMatrix;
use vi_core::prelude::*;
use vi_core::stepping::{Convertible, EnergyStepping};
use vi_core::{Lagrangian, SVector, StepError, linear};
use vi_erased::studies::rival;

macro_rules! links {
    ($name:ident $count:literal) => {
        lagrangian! {
            struct $name {
                const N = $count;
                param m[N] = 0.4, l[N] = 0.3, g = 9.81;
                coord q[N];
                let x[0] = l[0] * sin(q[0]);
                let x[i in 1..N] = x[i - 1] + l[i] * sin(q[i]);
                let y[i in 0..N] = -sum(j in 0..i + 1, l[j] * cos(q[j]));
                L = sum(i in 0..N, m[i] * (dot(x[i])^2 + dot(y[i])^2) / 2 - m[i] * g * y[i]);
                discretize midpoint;
            }
        }
    };
}

macro_rules! bodies {
    ($name:ident $count:literal) => {
        lagrangian! {
            struct $name {
                const N = $count;
                param m[N] = 0.4, G = 1.3;
                coord r[N][3];
                L = sum(i in 0..N, m[i] * dot(r[i]) * dot(r[i]) / 2)
                    + sum(i in 0..N, j in 0..i, G * m[i] * m[j] / norm(r[i] - r[j]));
                discretize midpoint;
            }
        }
    };
}

lagrangian! {
    /// Forty links whose last one is held at the height of the first.
    struct Closed {
        const N = 40;
        param m[N] = 0.4, l[N] = 0.3, g = 9.81, d = 0.8;
        coord q[N];
        let x[0] = l[0] * sin(q[0]);
        let x[i in 1..N] = x[i - 1] + l[i] * sin(q[i]);
        let y[i in 0..N] = -sum(j in 0..i + 1, l[j] * cos(q[j]));
        L = sum(i in 0..N, m[i] * (dot(x[i])^2 + dot(y[i])^2) / 2 - m[i] * g * y[i]);
        constraint level = x[N - 1] - d * N * l[0];
        constraint height = y[N - 1];
    }
}

links!(Links20 20);
links!(Links40 40);
bodies!(Bodies20 20);
bodies!(Bodies40 40);

/// A system of which only the acceleration is known.
#[derive(Clone, Copy)]
struct ByHand<F>(F);

impl<const N: usize, F> Lagrangian<N> for ByHand<F>
where
    F: Fn(&SVector<f64, N>, &SVector<f64, N>) -> SVector<f64, N>,
{
    const NAME: &'static str = "ByHand";
    const COORDINATES: [&'static str; N] = [""; N];
    const AUTONOMOUS: bool = true;
    const FORCED: bool = false;
    const CYCLIC: [bool; N] = [false; N];

    fn lagrangian(&self, _: f64, _: &SVector<f64, N>, _: &SVector<f64, N>) -> f64 {
        f64::NAN
    }
    fn energy(&self, _: f64, _: &SVector<f64, N>, _: &SVector<f64, N>) -> f64 {
        f64::NAN
    }
    fn momentum(&self, _: f64, _: &SVector<f64, N>, _: &SVector<f64, N>) -> SVector<f64, N> {
        SVector::repeat(f64::NAN)
    }
    fn force(&self, _: f64, _: &SVector<f64, N>, _: &SVector<f64, N>) -> SVector<f64, N> {
        SVector::zeros()
    }
    fn acceleration(&self, _: f64, q: &SVector<f64, N>, v: &SVector<f64, N>) -> Result<SVector<f64, N>, StepError> {
        Ok((self.0)(q, v))
    }
    fn flow(&self, t: f64, _: &SVector<f64, N>, _: &SVector<f64, N>) -> Result<Flow<N, f64>, StepError> {
        Err(StepError::NonFinite { t, quantity: "flow", expression: None })
    }
}

/// The acceleration of equal links: `Σ_j m(i, j) (cos(q_i − q_j) a_j + sin(q_i − q_j) v_j²) = −(g/l) m(i, i) sin q_i`,
/// with m(i, j) the number of links from the later one of both on.
fn of_links<const N: usize>(q: &SVector<f64, N>, v: &SVector<f64, N>) -> SVector<f64, N> {
    let after = |i: usize, j: usize| f64::from(u32::try_from(N - i.max(j)).unwrap_or(0));
    let matrix = SMatrix::<f64, N, N>::from_fn(|i, j| after(i, j) * (q[i] - q[j]).cos());
    let force = SVector::<f64, N>::from_fn(|i, _| {
        let centrifugal: f64 = (0..N).map(|j| after(i, j) * (q[i] - q[j]).sin() * v[j] * v[j]).sum();
        -centrifugal - 9.81 / 0.3 * after(i, i) * q[i].sin()
    });
    linear::solve(&matrix, &force).expect("a regular matrix")
}

/// The acceleration of equal bodies of mass 0.4 with G = 1.3.
fn of_bodies<const N: usize>(q: &SVector<f64, N>, _: &SVector<f64, N>) -> SVector<f64, N> {
    let place = |body: usize| SVector::<f64, 3>::from_fn(|k, _| q[3 * body + k]);
    let mut acceleration = SVector::zeros();
    for body in 0..N / 3 {
        for other in (0..N / 3).filter(|other| *other != body) {
            let away = place(other) - place(body);
            let pull = away * (1.3 * 0.4 / away.norm().powi(3));
            (0..3).for_each(|k| acceleration[3 * body + k] += pull[k]);
        }
    }
    acceleration
}

/// Bodies on a grid with a distance of 1.5, each a little off.
fn grid<const N: usize>() -> SVector<f64, N> {
    SVector::from_fn(|index, _| {
        let (body, direction) = (index / 3, index % 3);
        let place = [body % 4, body / 4 % 4, body / 16][direction];
        1.5 * f64::from(u32::try_from(place).unwrap_or(0))
            + 0.1 * (1.7 * f64::from(u32::try_from(index).unwrap_or(0))).sin()
    })
}

/// Compares Gauss steps of a system with DOP853 of the equations by hand: coordinates at the end, relative to how far they
/// have moved.
fn compare<S, F, const N: usize>(
    system: S,
    by_hand: F,
    (q, v): (SVector<f64, N>, SVector<f64, N>),
    [end, h]: [f64; 2],
    off: f64,
) where
    S: EnergyStepping<N> + Convertible<N>,
    F: Fn(&SVector<f64, N>, &SVector<f64, N>) -> SVector<f64, N>,
{
    let by_hand = ByHand(by_hand);
    let accelerations = [system.acceleration(0.0, &q, &v), by_hand.acceleration(0.0, &q, &v)];
    let [ours, theirs] = accelerations.map(|acceleration| acceleration.expect("an acceleration"));
    let of_acceleration = (ours - theirs).amax() / theirs.amax();
    let mut run = system.at(0.0, q, v).integrate(Gauss::<6>, h).expect("a start");
    let ours = run.until(end).expect("steps");
    let start = Trajectory { t: 0.0, q, v };
    let theirs = rival::motion(by_hand, &start, end, 1e-13, &Cell::new(0), &mut |_| ()).expect("steps");
    let moved = (theirs.q - q).amax();
    let found = (ours.q - theirs.q).amax() / moved;
    println!("{} of {N}: accelerations off by {of_acceleration:.1e}, moved {moved:.2}, off by {found:.1e}", S::NAME);
    // Measured: 4.7e-14, and 2.2e-13 at the end.
    assert!(of_acceleration < 1e-13 && moved > 0.1 && found < off);
}

#[test]
fn links_move_as_their_equations_by_hand() {
    fn start<const N: usize>() -> (SVector<f64, N>, SVector<f64, N>) {
        let at = |index: usize| f64::from(u32::try_from(index).unwrap_or(0));
        (
            SVector::from_fn(|index, _| 0.4 + 0.3 * (0.7 * at(index)).sin()),
            SVector::from_fn(|index, _| 0.2 * at(index).cos()),
        )
    }
    compare(Links20::default(), of_links::<20>, start(), [0.5, 0.005], 1e-12);
    compare(Links40::default(), of_links::<40>, start(), [0.3, 0.0025], 1e-12);
}

#[test]
fn bodies_move_as_their_equations_by_hand() {
    compare(Bodies20::default(), of_bodies::<60>, (grid(), SVector::zeros()), [1.0, 0.05], 1e-12);
    compare(Bodies40::default(), of_bodies::<120>, (grid(), SVector::zeros()), [1.0, 0.05], 1e-12);
}

/// Bytes of the stack that a step of 120 coordinates may use. Measured: 2 MB of a fixed step, 3 MB of an energy-preserving
/// one.
const STACK: usize = 4 << 20;

#[test]
fn steps_of_forty_bodies_keep_energy_and_momentum_within_four_megabytes_of_stack() {
    let run = || {
        let system = Bodies40::default();
        let (q, v) = (grid::<120>(), SVector::zeros());
        let mut fixed = system.at(0.0, q, v).integrate(FixedStep, 0.01).expect("a start");
        let energy = fixed.energy().expect("an energy");
        let mut worst = 0.0_f64;
        for _ in 0..100 {
            let state = fixed.step().expect("a step");
            let momentum: f64 = (0..40).map(|body| state.p[3 * body]).sum();
            assert!(momentum.abs() < 1e-12, "{momentum:e}");
            worst = worst.max((fixed.energy().expect("an energy") / energy - 1.0).abs());
        }
        let mut preserving = system.at(0.0, q, v).integrate(EnergyPreserving, 0.01).expect("a start");
        preserving.step().expect("a step");
        let kept = preserving.discrete_energy().expect("an energy");
        for _ in 0..20 {
            preserving.step().expect("a step");
        }
        let drift = preserving.discrete_energy().expect("an energy") / kept - 1.0;
        println!("H off by {worst:.1e}, E by {drift:.1e}");
        assert!(worst > 1e-9 && worst < 1e-4 && drift.abs() < 1e-14);
    };
    thread::Builder::new().stack_size(STACK).spawn(run).expect("a thread").join().expect("no overflow");
}

#[test]
fn forty_closed_links_take_steps_of_order_four() {
    let system = Closed::default();
    let mut angle = 2.2;
    let guess = SVector::<f64, 40>::from_fn(|_, _| {
        let before = angle;
        angle -= 1.3 / 40.0;
        before
    });
    let start = State::assembled(&system, 0.0, guess, SVector::zeros()).expect("a start").state;
    let ends = [0.01, 0.005, 0.0025].map(|h| {
        let mut run = system.at_state(start).integrate(Gauss::<2>, h).expect("a start");
        let energy = run.energy().expect("an energy");
        let state = run.until(0.4).expect("steps");
        let held = system.constraints(state.t, &state.q).into_iter().fold(0.0_f64, |worst, of| worst.max(of.abs()));
        let drift = (run.energy().expect("an energy") - energy).abs();
        println!("h = {h}: energy off by {drift:.1e}, constraints by {held:.1e}");
        // Measured: 8.6e-6 at most, and 1.8e-15.
        assert!(held < 1e-14 && drift < 2e-5);
        state.q
    });
    let [coarse, fine] = [(ends[0] - ends[1]).amax(), (ends[1] - ends[2]).amax()];
    let order = (coarse / fine).log2();
    println!("order {order:.2}, errors {coarse:.1e} and {fine:.1e}");
    // Measured: 3.91, 1.2e-6.
    assert!((order - 4.0).abs() < 0.2 && fine > 1e-8 && (ends[2] - start.q).amax() > 0.1, "{order}");
}
