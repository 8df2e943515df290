//! Existence and uniqueness of a fixed step of the midpoint rule.

use crate::support::Sequence;
use crate::support::ending;
use vi_core::node::Node;
use vi_core::stepping::FixedStepping;
use vi_core::{FixedStep, SVector, Starts, State, StepError};
use vi_systems::{DoubleWell, Kepler, Pendulum, RotatingHoop, SphericalPendulum};

#[test]
fn a_step_of_kepler_exists_up_to_its_bound() {
    // From q̄ = w − (h²/4) μ q̄/|q̄|³ with w = q + h p/2: solvable iff |w|³ ≥ (27/16) μ h².
    let mut draw = Sequence::new(11);
    let (mut taken, mut worst) = (0, 0.0_f64);
    for _ in 0..500 {
        let system = Kepler { mu: draw.within(0.3, 3.0) };
        let h: f64 = draw.within(-1.0, 1.0);
        let bound = (27.0 / 16.0 * system.mu * h * h).cbrt();
        let angle = draw.within(0.0, core::f64::consts::TAU);
        let direction = SVector::from([angle.cos(), angle.sin()]);
        let p = SVector::from([draw.within(-1.0, 1.0), draw.within(-1.0, 1.0)]);
        // 0.3 to 3 times the bound, and close to it.
        for distance in [draw.within(-1.2, 1.1).exp(), 1.0 - 1e-4, 1.0 + 1e-4] {
            let q = direction * (distance * bound) - p * (h / 2.0);
            let mut run = system.at_state(State { t: 0.0, q, p }).integrate(FixedStep, h).expect("a valid start");
            match run.step() {
                Ok(state) => {
                    assert!(distance >= 1.0, "{distance} of the bound: {state:?}");
                    // The step solves p1 = p − h μ q̄/|q̄|³ in its midpoint.
                    let middle = (q + state.q) / 2.0;
                    let kick = middle * (h * system.mu / middle.norm().powi(3));
                    worst = worst.max((state.p - p + kick).amax() / (1.0 + kick.amax()));
                    taken += 1;
                }
                Err(error) => {
                    assert!(distance < 1.0, "{distance} of the bound: {error}");
                    ending::assert_typed(error);
                    assert!(matches!(error, StepError::NotConverged { .. }), "{distance}: {error}");
                }
            }
        }
    }
    println!("{taken} steps exist, p1 off by {worst:.1e}");
    // Measured: 5.5e-16.
    assert!(worst <= 2e-15, "{worst:e}");
    assert!((500..1500).contains(&taken), "{taken} of 1500 steps exist");
}

/// Number of roots v of the momentum equation, from sign changes of its residual.
fn roots<S: FixedStepping<1>>(system: &S, node: &Node<1>, h: f64) -> usize {
    let residual = |v: f64| system.momentum_equation(node, h, &SVector::from([v])).residual[0];
    let values: Vec<f64> = (0..=10_000).map(|index| residual(-10.0 + 2e-3 * f64::from(index))).collect();
    values.windows(2).filter(|pair| pair[0].is_sign_negative() != pair[1].is_sign_negative()).count()
}

/// Drawn states of each system and step.
const DRAWN: u32 = 100;

/// The largest number of roots over drawn states near the top of the potential, at `top`.
fn most_roots<S: FixedStepping<1>>(system: &S, top: f64, h: f64) -> usize {
    let mut draw = Sequence::new(5);
    let each = (0..DRAWN).map(|_| {
        // From here the step with velocity v crosses the top, where V_q = 0: it solves the equation to 1e-3.
        let v = draw.within(-1.0, 1.0);
        let q = top - h * v / 2.0 + draw.within(-1e-3, 1e-3);
        roots(system, &Node::new(State::at(system, 0.0, [q], [v]), 0.0), h)
    });
    each.max().unwrap_or(0)
}

#[test]
fn the_root_is_the_only_one_below_h_2() {
    // h < 2/√(−V''_min/m), where V''_min = −1 at the barrier of the double well and at the top of the pendulum.
    assert_eq!(most_roots(&DoubleWell::default(), 0.0, 1.99), 1);
    assert_eq!(most_roots(&DoubleWell::default(), 0.0, 2.01), 3);
    assert_eq!(most_roots(&Pendulum::default(), core::f64::consts::PI, 1.99), 1);
    assert_eq!(most_roots(&Pendulum::default(), core::f64::consts::PI, 2.01), 3);
    // Twice the mass, √2 times the step.
    let heavy = DoubleWell { m: 2.0 };
    assert_eq!(most_roots(&heavy, 0.0, 1.99 * 2_f64.sqrt()), 1);
    assert_eq!(most_roots(&heavy, 0.0, 2.01 * 2_f64.sqrt()), 3);
}

#[test]
fn every_step_below_the_bound_is_taken() {
    let mut draw = Sequence::new(3);
    for h in [0.1, 1.0, 1.9, 1.99, -1.99] {
        for _ in 0..300 {
            let state = |q: f64, p: f64| State { t: 0.0, q: SVector::from([q]), p: SVector::from([p]) };
            let start = state(draw.within(-2.0, 2.0), draw.within(-2.0, 2.0));
            let run = DoubleWell::default().at_state(start).integrate(FixedStep, h).expect("a valid start");
            assert_eq!(ending::fixed(run, 50), None, "h = {h}, {start:?}");
            let run = Pendulum::default().at_state(start).integrate(FixedStep, h).expect("a valid start");
            assert_eq!(ending::fixed(run, 50), None, "h = {h}, {start:?}");
        }
    }
}

/// The coordinates after the first step.
fn first<S: FixedStepping<N>, const N: usize>(
    system: S,
    q: [f64; N],
    v: [f64; N],
    h: f64,
) -> Result<SVector<f64, N>, StepError> {
    let mut run = system.at(0.0, q, v).integrate(FixedStep, h)?;
    run.step().map(|state| state.q)
}

#[test]
fn a_long_step_takes_the_root_that_short_steps_lead_to() -> Result<(), StepError> {
    // The coordinates are those of continuation from h = 0 with 30 digits. Newton iteration from the start finds other
    // roots.
    let pendulum = first(Pendulum::default(), [0.617_877_13], [-1.344_352_42], 4.0)?;
    let hoop = first(RotatingHoop::default(), [-2.560_990_024_390_331], [-1.057_514_412_026_922], 0.8)?;
    let well = first(DoubleWell::default(), [-0.995_271_648_905_431_6], [0.682_351_423_365_381_3], 3.0)?;
    let start = ([0.159_564_342_795_291_95, 0.0], [-2.038_901_313_124_093, 0.305_182_449_532_556_35]);
    let spherical = first(SphericalPendulum::default(), start.0, start.1, 0.4)?;
    let expected = [-1.466_389_25, -0.493_494_210_982_868_6, -0.035_444_653_096_64, -0.118_619_661_7];
    for (q, expected) in [pendulum[0], hoop[0], well[0], spherical[0]].into_iter().zip(expected) {
        assert!((q - expected).abs() < 1e-7, "{q} instead of {expected}");
    }
    Ok(())
}
