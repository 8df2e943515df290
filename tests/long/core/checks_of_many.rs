//! The checks account for rounding. Correct systems of many kinds and units pass each check over steps from 1e-5, and
//! from 1e-5 of the largest sensible step, up to that; wrong systems fail each with numbers. If rounding hides the
//! property, the check reports that.

use crate::many;
use crate::many::Case;
use crate::spoiled::{Fault, Spoiled};
use vi_core::check::{self, CheckFailure, Checked, EnergyChecked, Place, Report};

/// Number of random states near each place.
const DRAWS: u32 = 20;

/// A check, called by hand.
type Check<S, const N: usize> = fn(&S, &Place<N>) -> Result<Report, CheckFailure>;

fn second_order<const N: usize, S: Checked<N>>(system: &S, place: &Place<N>) -> Result<Report, CheckFailure> {
    check::order(system, place, 2)
}

/// A check with the faults that it must detect.
type Seen<S, const N: usize> = (Check<S, N>, Vec<Fault>);

/// The checks that apply to fixed steps.
fn of_fixed_steps<const N: usize, S: Checked<N>>() -> Vec<Seen<S, N>> {
    use Fault::{Acceleration, DiscreteEnergy, Gain, Jacobian, Ld, Loss, Momentum, PointMomentum, Rounding};
    let of_derivatives = vec![Momentum, Fault::Energy, Acceleration, PointMomentum];
    let each: [(bool, Check<S, N>, Vec<Fault>); 10] = [
        (true, check::derivatives, of_derivatives),
        (true, check::slots, vec![Ld, Fault::D1, Fault::D2, Fault::D4]),
        (true, check::steps, vec![Gain, Loss, DiscreteEnergy, Jacobian, Rounding]),
        (true, second_order, vec![Gain, Loss, Acceleration]),
        (S::CYCLIC.contains(&true), check::momenta, vec![Loss]),
        (!S::FORCED, check::symplecticity, vec![Loss]),
        (true, check::reversibility, vec![Gain, Loss]),
        (true, check::gauss_order, vec![Acceleration]),
        (S::CYCLIC.contains(&true), check::gauss_momenta, vec![]),
        (!S::FORCED, check::gauss_symplecticity, vec![]),
    ];
    each.into_iter().filter(|(applies, ..)| *applies).map(|(_, check, faults)| (check, faults)).collect()
}

/// The checks that apply to a system with energy-preserving steps by the midpoint rule.
fn of_energy_steps<const N: usize, S: EnergyChecked<N>>() -> Vec<Seen<S, N>> {
    let mut all = of_fixed_steps();
    all.push((check::energy_equations, vec![Fault::EnergyResidual, Fault::ResidualDh]));
    all.push((check::energy, vec![Fault::Energy]));
    if !S::FORCED {
        all.push((check::step_law, vec![Fault::Density]));
    }
    all
}

/// Each check passes for the correct system and fails for each wrong one with numbers, for every step.
#[allow(clippy::needless_pass_by_value, reason = "as the other tests of each case")]
fn seen_at_each_step<const N: usize, S: Checked<N>>(case: Case<S, N>, checks: Vec<Seen<Spoiled<S>, N>>) {
    let system = case.system;
    for place in case.places() {
        for (check, faults) in checks.clone() {
            let right = check(&Spoiled { system, fault: Fault::None }, &place);
            let report = right.unwrap_or_else(|failure| panic!("h = {:e}: {failure}", place.h));
            println!("h = {:.1e}: {report}", place.h);
            assert!(report.compared > 0 && report.worst <= report.tolerance, "{report}");
            for fault in faults {
                let failure = check(&Spoiled { system, fault }, &place).expect_err("a fault that nothing sees");
                assert!(matches!(failure, CheckFailure::Differs { .. }), "h = {:e}, {fault:?}: {failure}", place.h);
            }
        }
    }
}

mod at_their_places {
    super::many::each_case!(super::seen_at_each_step, super::of_energy_steps, super::of_fixed_steps);
}

/// A fixed pseudo-random sequence in (0, 1): a linear congruence (Knuth, MMIX).
fn sequence() -> impl FnMut() -> f64 {
    let mut state = 1_u64;
    move || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        f64::from(u32::try_from(state >> 32).unwrap_or_default()) / 2_f64.powi(32)
    }
}

/// No check fails with numbers for a correct system near its place, with steps up to twice the largest sensible one.
/// Allowed are: a missing motion or step, and a law below rounding.
#[allow(clippy::needless_pass_by_value, reason = "as the other tests of each case")]
fn not_red_at_others<const N: usize, S: Checked<N>>(case: Case<S, N>, checks: Vec<Seen<Spoiled<S>, N>>) {
    let Case { system, place } = case;
    let (mut draw, mut passed, mut refused) = (sequence(), 0, 0);
    for _ in 0..DRAWS {
        let (t, h) = (place.t + 60.0 * place.h * draw(), 2.0 * place.h * 10_f64.powf(-6.0 * draw()));
        let (q, v) = (place.q.map(|entry| entry * (0.5 + draw())), place.v.map(|entry| entry * (0.3 + 1.2 * draw())));
        let place = Place { t, q, v, h };
        for (check, _) in &checks {
            match check(&Spoiled { system, fault: Fault::None }, &place) {
                Ok(_) => passed += 1,
                Err(CheckFailure::Step { .. } | CheckFailure::StepTooSmall { .. }) => refused += 1,
                Err(failure) => panic!("{failure}, at {place:?}"),
            }
        }
    }
    println!("{}: {passed} passed, {refused} refused", S::NAME);
    assert!(passed > 9 * refused, "{}: {passed} passed, {refused} refused", S::NAME);
}

mod about_their_places {
    super::many::each_case!(super::not_red_at_others, super::of_energy_steps, super::of_fixed_steps);
}

/// The energy of a slow particle is nearly all rest energy: the remainder has six digits.
#[test]
fn checks_report_rounding() {
    let Case { system, place, .. } = many::relativistic();
    let system = many::Relativistic { c: 1e5, ..system };
    for h in [1e-5, 1e-3, place.h] {
        let place = Place { h, ..place };
        let hidden: [(Check<_, 2>, &str); 2] =
            [(check::energy, "the length of a step"), (check::step_law, "the step law")];
        for (check, hidden) in hidden {
            let failure = check(&system, &place).expect_err("a law below rounding");
            println!("{failure}");
            let CheckFailure::StepTooSmall { what, needed, .. } = &failure else { panic!("{failure}") };
            assert_eq!(*what, hidden);
            assert!(needed.is_none_or(|needed| needed > h), "{failure}");
        }
        second_order(&system, &place).unwrap_or_else(|failure| panic!("{failure}"));
    }
    let late = Place { t: 1e9, h: 1e-7, ..place };
    let failure = check::steps(&system, &late).expect_err("a step that is lost in the time");
    println!("{failure}");
    assert!(failure.to_string().contains("too small to see steps above rounding"), "{failure}");
}
