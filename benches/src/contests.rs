//! All contests: systems, starts, steps, and what is to be reached.
//!
//! The bound of a rival is at least twice its deviation from the generated trajectory after 1000 steps, in either build.

use crate::chain::{LongChain, Springs, lowest_mode};
use crate::contest::{Contest, Target};
use crate::dense::Lu;
use crate::hand::chain::{Series, Solver};
use crate::hand::{self, Compensated, Plain};
use crate::newton::{Difference, Dual, Newton};
use crate::pendulum::{AngleChain, TriplePendulum};
use crate::problem::Problem;
use crate::rods::{RodChain, straight};
use crate::run::{Adjoint, Other};
use core::array::from_fn;
use std::hint::black_box;
use vi_core::derivatives::{Differentiable, Tangent, Variation};
use vi_core::stepping::{Batch, Convertible, EnergyStepping, FixedStepping};
use vi_core::{EnergyPreserving, FixedStep, Gauss, Run, SVector, Starts, State};
use vi_ensemble::Ensemble;
use vi_systems::{DoublePendulum, DoubleWell, FpuChain, HeavyTop, Kepler, NPendulum};

const BY_HAND: &str = "by hand, sums compensated";
const BY_HAND_PLAIN: &str = "by hand, plain sums";
const DUAL: &str = "Newton, dual numbers";
const DIFFERENCE: &str = "Newton, differences";
const TOGETHER: &str = "ensemble of 64, one core";
const DENSE: &str = "dense LU of nalgebra";

/// Compensated sums. Measured: 8.9e-16, Kepler.
const KEPT: f64 = 2e-15;
/// Many at once. Measured: 3.4e-16, Kepler.
const TOGETHER_KEPT: f64 = 7e-16;
/// Plain sums. Measured: 1.4e-12, the time of the chains.
const LOST: f64 = 3e-12;
/// Energy-preserving steps have h from `H = E0`, and a rounding of H is one of `1/(h² D)` times as much in h. Measured: double
/// well 3.2e-9, Kepler 2.1e-10, double pendulum 9.4e-11; if the rows are not combined, 2.8e-7, 2.8e-9
/// and 2.9e-9.
const ROUGH: [[f64; 2]; 3] = [[7e-9, 6e-7], [5e-10, 6e-9], [5e-10, 6e-9]];

/// Ten rods amplify rounding. Measured: 1.3e-14, and with plain sums 1.7e-13.
const SWUNG: f64 = 3e-14;
const SWUNG_PLAIN: f64 = 4e-13;

/// The top turns by 300 rad, and its angle collects roundings. Measured: 1.0e-12, and with plain sums 1.3e-11; with fused operations,
/// which only the steps by hand have, 8.1e-11 and 7.9e-11.
const TURNED: f64 = if cfg!(target_feature = "fma") { 2e-10 } else { 3e-12 };
const TURNED_PLAIN: f64 = if cfg!(target_feature = "fma") { 2e-10 } else { 3e-11 };

/// Maximum time of a generated step relative to a step by hand, which ends the program at any error.
const ABREAST: f64 = 1.12;

/// All contests.
#[must_use]
pub fn all() -> Vec<Contest> {
    vec![
        double_well(),
        double_well_energy(),
        kepler(),
        kepler_energy(),
        double_pendulum(),
        double_pendulum_energy(),
        double_pendulum_derivatives(),
        kepler_energy_derivatives(),
        double_pendulum_gauss_derivatives(),
        pendula("Triple pendulum, fixed step, h = 0.01", &black_box(TriplePendulum::default())),
        pendula("Four pendula, fixed step, h = 0.01", &black_box(NPendulum::default())),
        chain::<_, 16, 17>("Chain of 16, fixed step, h = 0.1", &black_box(FpuChain::default()), 10.0),
        chain::<_, 64, 65>("Chain of 64, fixed step, h = 0.1", &black_box(LongChain::default()), 60.0),
        rods(),
        heavy_top(),
    ]
}

fn double_well() -> Contest {
    let (system, start, h) = (black_box(DoubleWell::default()), (0.74, 0.0), black_box(0.01));
    Contest::new("Double well, fixed step, h = 0.01", fixed(&system, ([start.0], [start.1]), h))
        .rival(BY_HAND, KEPT, Target::AtMost(ABREAST), hand::double_well::Fixed::<Compensated>::new(&system, start, h))
        .rival(BY_HAND_PLAIN, LOST, Target::None, hand::double_well::Fixed::<Plain>::new(&system, start, h))
        .rival(DUAL, LOST, Target::Faster(3.0), newton::<_, Dual, 1>(&system, ([start.0], [start.1]), h, 1e-14))
        .rival(DIFFERENCE, LOST, Target::None, newton::<_, Difference, 1>(&system, ([start.0], [start.1]), h, 1e-14))
        .ensemble(TOGETHER, 64, TOGETHER_KEPT, Target::Slower(20.0), together(&system, ([start.0], [start.1]), h))
}

fn double_well_energy() -> Contest {
    let (system, start, h) = (black_box(DoubleWell::default()), (0.74, 0.0), black_box(0.01));
    let arrays = ([start.0], [start.1]);
    Contest::new("Double well, energy-preserving, h0 = 0.01", energy_preserving(&system, arrays, h))
        .rival(
            BY_HAND,
            ROUGH[0][0],
            Target::AtMost(ABREAST),
            hand::double_well::EnergyPreserving::<Compensated>::new(&system, start, h),
        )
        .rival(
            BY_HAND_PLAIN,
            ROUGH[0][0],
            Target::None,
            hand::double_well::EnergyPreserving::<Plain>::new(&system, start, h),
        )
        .rival(DUAL, ROUGH[0][1], Target::Faster(5.0), newton_energy::<_, Dual, 1, 2>(&system, arrays, h, 1e-15))
        .rival(DIFFERENCE, ROUGH[0][1], Target::None, newton_energy::<_, Difference, 1, 2>(&system, arrays, h, 1e-15))
}

/// An orbit of eccentricity 0.15.
fn kepler() -> Contest {
    let (system, start, h) = (black_box(Kepler::default()), ([0.8, 0.0], [0.0, 1.2]), black_box(0.01));
    Contest::new("Kepler, fixed step, h = 0.01", fixed(&system, start, h))
        .rival(BY_HAND, KEPT, Target::AtMost(ABREAST), hand::kepler::Fixed::<Compensated>::new(&system, start, h))
        .rival(BY_HAND_PLAIN, LOST, Target::None, hand::kepler::Fixed::<Plain>::new(&system, start, h))
        .rival(DUAL, LOST, Target::Faster(3.0), newton::<_, Dual, 2>(&system, start, h, 5e-15))
        .rival(DIFFERENCE, LOST, Target::None, newton::<_, Difference, 2>(&system, start, h, 5e-15))
        .ensemble(TOGETHER, 64, TOGETHER_KEPT, Target::Slower(8.0), together(&system, start, h))
}

fn kepler_energy() -> Contest {
    let (system, start, h) = (black_box(Kepler::default()), ([0.8, 0.0], [0.0, 1.2]), black_box(0.01));
    Contest::new("Kepler, energy-preserving, h0 = 0.01", energy_preserving(&system, start, h))
        .rival(
            BY_HAND,
            ROUGH[1][0],
            Target::AtMost(ABREAST),
            hand::kepler::EnergyPreserving::<Compensated>::new(&system, start, h),
        )
        .rival(
            BY_HAND_PLAIN,
            ROUGH[1][0],
            Target::None,
            hand::kepler::EnergyPreserving::<Plain>::new(&system, start, h),
        )
        .rival(DUAL, ROUGH[1][1], Target::None, newton_energy::<_, Dual, 2, 3>(&system, start, h, 1e-15))
        .rival(DIFFERENCE, ROUGH[1][1], Target::None, newton_energy::<_, Difference, 2, 3>(&system, start, h, 1e-15))
}

/// Swinging in both modes; the step density keeps its sign.
fn double_pendulum() -> Contest {
    let (system, start, h) = (black_box(DoublePendulum::default()), ([0.3, 0.2], [0.0, 0.1]), black_box(0.01));
    Contest::new("Double pendulum, fixed step, h = 0.01", fixed(&system, start, h))
        .rival(
            BY_HAND,
            KEPT,
            Target::AtMost(ABREAST),
            hand::double_pendulum::Fixed::<Compensated>::new(&system, start, h),
        )
        .rival(BY_HAND_PLAIN, LOST, Target::None, hand::double_pendulum::Fixed::<Plain>::new(&system, start, h))
        .rival(DUAL, LOST, Target::Faster(5.0), newton::<_, Dual, 2>(&system, start, h, 1e-13))
        .rival(DIFFERENCE, LOST, Target::None, newton::<_, Difference, 2>(&system, start, h, 1e-13))
        .ensemble(TOGETHER, 64, TOGETHER_KEPT, Target::Slower(8.0), together(&system, start, h))
}

/// A run, the run with tangent vectors in 1, 2 and 4 directions, and the run with its gradient by one backward pass.
fn derivatives<M, S, const N: usize>(name: &'static str, run: &Run<M, S, N>) -> Contest
where
    M: Differentiable<S, N> + 'static,
    S: Convertible<N> + 'static,
{
    let along = |count: usize| Tangent::new(run.clone(), Variation::of_state().into_iter().take(count).collect());
    Contest::new(name, run.clone())
        .rival("variations, 1 direction", 0.0, Target::Costs(1.5), along(1))
        .rival("variations, 2 directions", 0.0, Target::Costs(2.0), along(2))
        .rival("variations, 4 directions", 0.0, Target::Costs(3.0), along(4))
        .rival("gradient, few nodes kept", 0.0, Target::Costs(4.0), Adjoint { run: run.clone(), keeps_all: false })
        .rival("gradient, all nodes kept", 0.0, Target::Costs(4.0), Adjoint { run: run.clone(), keeps_all: true })
}

fn double_pendulum_derivatives() -> Contest {
    let (system, start, h) = (black_box(DoublePendulum::default()), ([0.3, 0.2], [0.0, 0.1]), black_box(0.01));
    derivatives("Double pendulum, fixed step with derivatives, h = 0.01", &fixed(&system, start, h))
}

fn kepler_energy_derivatives() -> Contest {
    let (system, start, h) = (black_box(Kepler::default()), ([0.8, 0.0], [0.0, 1.2]), black_box(0.01));
    derivatives("Kepler, energy-preserving with derivatives, h0 = 0.01", &energy_preserving(&system, start, h))
}

fn double_pendulum_gauss_derivatives() -> Contest {
    let (system, (q, v), h) = (black_box(DoublePendulum::default()), ([0.3, 0.2], [0.0, 0.1]), black_box(0.05));
    let state = State::at(&system, 0.0, SVector::from(q), SVector::from(v));
    let run = system.at_state(state).integrate(Gauss::<4>, h).expect("a step");
    derivatives("Double pendulum, Gauss of 4 stages with derivatives, h = 0.05", &run)
}

fn double_pendulum_energy() -> Contest {
    let (system, start, h) = (black_box(DoublePendulum::default()), ([0.3, 0.2], [0.0, 0.1]), black_box(0.01));
    Contest::new("Double pendulum, energy-preserving, h0 = 0.01", energy_preserving(&system, start, h))
        .rival(
            BY_HAND,
            ROUGH[2][0],
            Target::AtMost(ABREAST),
            hand::double_pendulum::EnergyPreserving::<Compensated>::new(&system, start, h),
        )
        .rival(
            BY_HAND_PLAIN,
            ROUGH[2][0],
            Target::None,
            hand::double_pendulum::EnergyPreserving::<Plain>::new(&system, start, h),
        )
        .rival(DUAL, ROUGH[2][1], Target::None, newton_energy::<_, Dual, 2, 3>(&system, start, h, 1e-14))
        .rival(DIFFERENCE, ROUGH[2][1], Target::None, newton_energy::<_, Difference, 2, 3>(&system, start, h, 1e-14))
}

/// Whether an ensemble is never slower than its trajectories one by one: long steps, for which lanes save the least
/// time, and steps that an ensemble takes one after the other.
fn pendula<S: Batch<N> + Clone + 'static, const N: usize>(name: &'static str, system: &S) -> Contest {
    let (start, h) = ((from_fn(|i| [0.3, 0.2, 0.1, 0.05][i]), [0.0; N]), black_box(0.01));
    let ensemble = together(system, start, h);
    Contest::new(name, fixed(system, start, h)).ensemble(TOGETHER, 64, TOGETHER_KEPT, Target::Slower(1.0), ensemble)
}

/// A chain in its lowest mode.
fn chain<S: FixedStepping<N> + Clone + 'static, const N: usize, const M: usize>(
    name: &'static str,
    system: &S,
    faster: f64,
) -> Contest
where
    for<'a> Springs: From<&'a S>,
    Lu: Solver<N, M>,
{
    let (q, h) = (lowest_mode::<N>(), black_box(0.1));
    let springs = || Springs::from(system);
    Contest::new(name, fixed(system, (q, [0.0; N]), h))
        .rival(
            BY_HAND,
            KEPT,
            Target::AtMost(ABREAST),
            hand::chain::Fixed::<Compensated, Series, N, M>::new(springs(), q, h),
        )
        .rival(BY_HAND_PLAIN, LOST, Target::None, hand::chain::Fixed::<Plain, Series, N, M>::new(springs(), q, h))
        .rival(DENSE, LOST, Target::Faster(faster), hand::chain::Fixed::<Plain, Lu, N, M>::new(springs(), q, h))
}

/// A chain of ten rods with constraints, and in angles. Angles have other steps: only their time is compared.
fn rods() -> Contest {
    let (system, start, h) = (black_box(RodChain::default()), straight::<20>(), black_box(0.01));
    let run = system.at(0.0, start[0], start[1]).integrate(Gauss::<1>, h).expect("a regular start");
    let angle = 0.75_f64.atan();
    let angles = fixed(&black_box(AngleChain::default()), ([angle; 10], [0.1; 10]), h);
    let (parameters, places) = ([system.m, system.l, system.g], [start[0].as_slice(), &start[1]]);
    let by_hand = hand::rods::Fixed::<Compensated, 10>::new(parameters, places, h);
    let plain = hand::rods::Fixed::<Plain, 10>::new(parameters, places, h);
    Contest::new("Ten rods with constraints, h = 0.01", run)
        .rival(BY_HAND, SWUNG, Target::AtMost(1.15), by_hand)
        .rival(BY_HAND_PLAIN, SWUNG_PLAIN, Target::None, plain)
        .rival("in ten angles", f64::INFINITY, Target::Faster(2.5), Other(angles, 41))
}

/// A spinning top.
fn heavy_top() -> Contest {
    let (system, h) = (black_box(HeavyTop::default()), black_box(0.01));
    let (q, v) = system.start();
    let run = system.at(0.0, q, v).integrate(Gauss::<1>, h).expect("a regular start");
    let (inertia, weight) = ([system.J1, system.J1, system.J3], system.m * system.g * system.l);
    let by_hand = hand::heavy_top::Fixed::<Compensated>::new(inertia, weight, [q, v], h);
    let plain = hand::heavy_top::Fixed::<Plain>::new(inertia, weight, [q, v], h);
    Contest::new("Heavy top with constraints, h = 0.01", run)
        .rival(BY_HAND, TURNED, Target::AtMost(1.15), by_hand)
        .rival(BY_HAND_PLAIN, TURNED_PLAIN, Target::None, plain)
}

fn fixed<S: FixedStepping<N> + Clone, const N: usize>(
    system: &S,
    (q, v): ([f64; N], [f64; N]),
    h: f64,
) -> Run<FixedStep, S, N> {
    (*system).at(0.0, q, v).integrate(FixedStep, h).expect("a regular start")
}

/// The trajectory of [`fixed`], and 63 more whose coordinates are up to a fifth smaller.
fn together<S: Batch<N>, const N: usize>(system: &S, (q, v): ([f64; N], [f64; N]), h: f64) -> Ensemble<S, N> {
    let start = |i: u32| State::at(system, 0.0, q.map(|q| q * (1.0 - 0.2 / 63.0 * f64::from(i))), v);
    Ensemble::new(vec![*system; 64], (0..64).map(start).collect(), h).expect("regular starts")
}

fn energy_preserving<S: EnergyStepping<N> + Clone, const N: usize>(
    system: &S,
    (q, v): ([f64; N], [f64; N]),
    h: f64,
) -> Run<EnergyPreserving, S, N> {
    EnergyPreserving::from_midpoint(*system, 0.0, q, v, h).expect("a regular start")
}

/// Newton's method with derivatives found at run time, from the same start as [`fixed`].
fn newton<S: EnergyStepping<N> + Problem<N>, D, const N: usize>(
    system: &S,
    (q, v): ([f64; N], [f64; N]),
    h: f64,
    tolerance: f64,
) -> Newton<S, D, N, N>
where
    D: crate::newton::Derivatives,
{
    let State { t, p, .. } = State::at(system, 0.0, q, v);
    Newton::new(*system, (t, q, p), [v; 2], h, tolerance)
}

/// Newton's method for energy-preserving steps, with derivatives found at run time, from the start of
/// [`energy_preserving`].
fn newton_energy<S: EnergyStepping<N> + Problem<N>, D, const N: usize, const M: usize>(
    system: &S,
    (q, v): ([f64; N], [f64; N]),
    h: f64,
    tolerance: f64,
) -> Newton<S, D, N, M>
where
    D: crate::newton::Derivatives,
{
    let (q_mid, v_mid) = (SVector::from(q), SVector::from(v));
    let a = system.acceleration(0.0, &q_mid, &v_mid).expect("a regular start");
    let [force, momentum] = system.gradients(q, v);
    let energy = system.energy(0.0, &q_mid, &v_mid);
    let p = SVector::from_fn(|i, _| if i < N { momentum[i] + 0.5 * h * force[i] } else { -energy });
    let end = from_fn(|i| q[i] + 0.5 * h * v[i]);
    Newton::new(*system, (0.5 * h, end, p), [v, from_fn(|i| v[i] - h * a[i])], h, tolerance)
}
