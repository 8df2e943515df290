//! Every use of a broken system reports only its own mistake.

use vi_core::derivatives::{Covector, Lyapunov, Objective, Tangent, Variation, gradient};
use vi_core::lagrangian::Parameters;
use vi_core::rules::{By, Trapezoidal};
use vi_core::stepping::Batch;
use vi_core::{lagrangian, Called, Composition, DiscreteLagrangian, EnergyPreserving, EnergyPreservingGauss, FixedStep, Gauss, Lagrangian, Method, Starts, State};

lagrangian! {
    struct Oscillator {
        param m = 1.0, k[2] = 1.0;
        coord x;
        L = mm * dot(x)^2 / 2 - k[0] * x^2;
        timescale = 1 + x^2;
        discretize midpoint, trapezoidal;
    }
}

struct End;

impl<M: Method<S, 1>, S> Objective<M, S, 1> for End {
    fn slope(&self, _: u64, _: &State<1>) -> Covector<1> {
        Covector::zero()
    }
}

fn side_by_side<S: Batch<1>>(system: S) {
    let _ = S::from_rows(&S::rows(&[system; 4]), 0);
}

fn main() -> Result<(), vi_core::StepError> {
    let mut system = Oscillator { m: 2.0, ..Oscillator::default() };
    *system.parameter_mut("k[0]").expect("a parameter") = 3.0;
    let start = State::at(&system, 0.0, [1.0], [0.0]);
    let fixed = || system.at_state(start).integrate(FixedStep, 0.1).expect("a start");
    fixed().until(1.0)?;
    By::new(&system, Trapezoidal).at_state(start).integrate(FixedStep, 0.1)?.step()?;
    system.at_state(start).integrate(Composition::KAHAN_LI_8, 0.1)?.until(1.0)?;
    system.at_state(start).integrate(Gauss::<4>, 0.1)?.until(1.0)?;
    By::new(system, Trapezoidal).at_state(start).integrate(Gauss::<4>, 0.1)?.step()?;
    Called(system).at_state(start).integrate(Gauss::<4>, 0.1)?.step()?;
    system.at_state(start).integrate(Gauss::<4>.in_transformed_time(), 0.1)?.until(1.0)?;
    EnergyPreserving::from_midpoint(system, 0.0, [1.0], [0.0], 0.1)?.until(1.0)?;
    system.at_state(start).integrate(EnergyPreservingGauss::<2>, 0.1)?.until(1.0)?;
    vi_core::gauss::step_density::<_, 1, 2>(&system, &start)?;
    Tangent::new(fixed(), Variation::of_state()).step()?;
    Tangent::new(system.at_state(start).integrate(Gauss::<4>, 0.1)?, Variation::of_state()).step()?;
    Tangent::new(EnergyPreserving::from_midpoint(system, 0.0, [1.0], [0.0], 0.1)?, Variation::of_state()).step()?;
    Lyapunov::new(fixed(), 1)?.advance(10)?;
    gradient(&fixed(), 10, 3, &End)?;
    let _ = Variation::<1>::of_parameter::<Oscillator>("m");
    vi_core::check::derivatives(&system, &vi_core::check::Place { t: 0.0, q: [1.0].into(), v: [0.0].into(), h: 0.1 }).expect("right");
    let single = system.convert::<f32>();
    let _ = single.energy(0.0, &[1.0_f32].into(), &[0.0].into()) + single.k[1];
    let _ = start.energy(&system)? + DiscreteLagrangian::<1>::ld(&system, &vi_core::Interval { t0: 0.0, q0: [0.0].into(), t1: 1.0, q1: [1.0].into() });
    side_by_side(system);
    Ok(())
}
