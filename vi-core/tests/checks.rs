//! Each check passes for a correct system, and fails for a system with one wrong function, for a state that proves
//! nothing, and for a system to which it does not apply.

use crate::spoiled::{Fault, Spoiled};
use vi_core::check::{self, CheckFailure, Checked, Place, Report};
use vi_core::lagrangian;

lagrangian! {
    /// Unforced, with a cyclic coordinate.
    struct SphericalPendulum {
        param m = 1.2, l = 0.9, g = 9.81;
        coord θ, φ;
        L = m * l^2 * (dot(θ)^2 + sin(θ)^2 * dot(φ)^2) / 2 + m * g * l * cos(θ);
        discretize midpoint;
        check { θ = 1, φ = 0.3, dot(θ) = 0.2, dot(φ) = 1.5; h = 0.02; }
    }
}

lagrangian! {
    /// Forced, and driven in time.
    struct Duffing {
        param alpha = 1.2, beta = 0.8, c = 0.08, amplitude = 0.25, omega = 1.3;
        coord x;
        L = dot(x)^2 / 2 - alpha * x^2 / 2 - beta * x^4 / 4;
        force x = -c * dot(x) + amplitude * cos(omega * t);
        discretize midpoint;
        check { x = 1.1, dot(x) = 0.2, t = 0.2; h = 0.05; }
    }
}

lagrangian! {
    /// A chain with an explicit rule; only one mass moves, and one is driven.
    struct FPUTChain {
        const N = 4;
        param alpha = 0.25, c = 0.1;
        coord q[N];
        let stretch[i in 0..N - 1] = q[i + 1] - q[i];
        let potential = sum(i in 0..N - 1, stretch[i]^2 / 2 + alpha * stretch[i]^3 / 3) + q[0]^2 / 2 + q[N - 1]^2 / 2;
        L = sum(i in 0..N, dot(q[i])^2) / 2 - potential;
        force q[0] = -c * dot(q[0]);
        discretize trapezoidal;
        check { q[i in 0..N] = sin(pi * (i + 1) / (N + 1)); dot(q[N - 1]) = 0.5; h = 0.05; }
    }
}

lagrangian! {
    /// The written-out midpoint rule, which is recognised.
    struct WrittenMidpoint {
        coord x;
        L = dot(x)^2 / 2 - x^4 / 4;
        discretize { Ld = h * L((t0 + t1)/2, (q0 + q1)/2, (q1 - q0)/h); }
        check { x = 1; h = 0.02; }
    }
}

lagrangian! {
    /// A nonsymmetric rule of order one: derivatives, slots, steps, order 1 and symplecticity are checked.
    struct SymplecticEuler {
        coord x;
        L = dot(x)^2 / 2 - x^4 / 4;
        discretize { Ld = h * L(t0, q0, (q1 - q0)/h); }
        check { x = 1; h = 0.05; }
    }
}

lagrangian! {
    /// With a time scale of time and coordinates.
    struct ScaledDuffing {
        param k = 0.7;
        coord x;
        L = dot(x)^2 / 2 - x^4 / 4;
        force x = -dot(x) / 10;
        time_scale = 1 / (1 + k * x^2 + sin(t) / 5);
        discretize midpoint;
        check { x = 1.1, dot(x) = 0.2, t = 0.2; h = 0.05; }
    }
}

// Without a rule: the checks of the motion and of Gauss steps.
lagrangian! {
    struct CentralForce {
        param m = 1.3, k = 0.8;
        coord r, φ;
        L = m * (dot(r)^2 + r^2 * dot(φ)^2) / 2 + k / r;
        check { r = 1.2, dot(r) = 0.1, dot(φ) = 0.7; h = 0.05; }
    }
}

lagrangian! {
    struct DampedRow {
        param c = 0.1;
        coord q[5];
        L = sum(i in 0..5, dot(q[i])^2) / 2 + sum(i in 0..5, cos(q[i])) * sin(t) - sum(i in 0..4, (q[i] - q[i + 1])^4);
        force q[i in 0..5] = -c * dot(q[i]);
        discretize gauss;
        check { q[0] = 0.5, q[1] = 0.2, dot(q[3]) = 0.3, q[4] = 1; h = 0.05; }
    }
}

const PENDULUM: Place<2> = Place {
    t: 0.2,
    q: vi_core::SVector::<f64, 2>::new(1.0, 0.3),
    v: vi_core::SVector::<f64, 2>::new(0.2, 1.5),
    h: 0.02,
};
const DUFFING: Place<1> =
    Place { t: 0.2, q: vi_core::SVector::<f64, 1>::new(1.1), v: vi_core::SVector::<f64, 1>::new(0.2), h: 0.05 };

/// A check, called by hand.
type Check<S, const N: usize> = fn(&S, &Place<N>) -> Result<Report, CheckFailure>;

fn second_order<const N: usize, S: Checked<N>>(system: &S, place: &Place<N>) -> Result<Report, CheckFailure> {
    check::order(system, place, 2)
}

/// Asserts that the check passes for the correct system and fails for the wrong one with numbers in its message.
fn trips<const N: usize, S: Checked<N>>(system: S, place: &Place<N>, fault: Fault, check: Check<Spoiled<S>, N>) {
    let right = check(&Spoiled { system, fault: Fault::None }, place);
    let report = right.unwrap_or_else(|failure| panic!("{failure}"));
    assert!(report.compared > 0 && report.worst <= report.tolerance, "{report}");
    let failure = check(&Spoiled { system, fault }, place).expect_err("a fault that nothing sees");
    println!("{fault:?}: {failure}");
    assert!(matches!(failure, CheckFailure::Differs { .. }), "{fault:?}: {failure}");
    let message = failure.to_string();
    assert!(message.contains(report.check) && message.contains("instead of"), "{message}");
}

#[test]
fn wrong_derivatives_are_seen() {
    let faults =
        [Fault::Momentum, Fault::Energy, Fault::Acceleration, Fault::PointMomentum, Fault::PointForce, Fault::Power];
    for fault in faults {
        trips(SphericalPendulum::default(), &PENDULUM, fault, check::derivatives);
        trips(Duffing::default(), &DUFFING, fault, check::derivatives);
    }
    // The one of the last coordinate of the spherical pendulum is zero: it is cyclic.
    trips(Duffing::default(), &DUFFING, Fault::PointDerivatives, check::derivatives);
    for fault in [Fault::ScaledForce, Fault::ScaledPower, Fault::TimeScaleDq, Fault::TimeScaleDt] {
        trips(ScaledDuffing::default(), &DUFFING, fault, check::derivatives);
    }
}

#[test]
fn wrong_slots_are_seen() {
    for fault in [Fault::Ld, Fault::D1, Fault::D2, Fault::D3, Fault::D4] {
        trips(SphericalPendulum::default(), &PENDULUM, fault, check::slots);
        trips(Duffing::default(), &DUFFING, fault, check::slots);
    }
    for fault in [Fault::FdMinus, Fault::FdPlus, Fault::GdPlus] {
        trips(Duffing::default(), &DUFFING, fault, check::slots);
    }
}

#[test]
fn wrong_steps_are_seen() {
    let faults = [
        Fault::Damping,
        Fault::MomentumGain,
        Fault::DirectedGain,
        Fault::DiscreteEnergy,
        Fault::Rounding,
        Fault::Jacobian,
    ];
    for fault in faults {
        trips(SphericalPendulum::default(), &PENDULUM, fault, check::steps);
        trips(Duffing::default(), &DUFFING, fault, check::steps);
    }
    trips(Duffing::default(), &DUFFING, Fault::Residual, check::steps);
    // The one of the last coordinate of the spherical pendulum is zero: it is cyclic.
    trips(Duffing::default(), &DUFFING, Fault::MomentumDerivatives, check::steps);
}

#[test]
fn wrong_energy_equations_are_seen() {
    let faults = [
        Fault::StepDensity,
        Fault::Jacobian,
        Fault::ResidualDh,
        Fault::ExtendedDerivatives,
        Fault::EnergyResidual,
        Fault::EnergyDh,
        Fault::EnergyGain,
        Fault::Rounding,
        Fault::D3,
    ];
    for fault in faults {
        trips(SphericalPendulum::default(), &PENDULUM, fault, check::energy_equations);
        trips(Duffing::default(), &DUFFING, fault, check::energy_equations);
    }
    trips(Duffing::default(), &DUFFING, Fault::GdPlus, check::energy_equations);
}

#[test]
fn a_wrong_order_is_seen() {
    trips(SphericalPendulum::default(), &PENDULUM, Fault::Damping, second_order);
    trips(SphericalPendulum::default(), &PENDULUM, Fault::Acceleration, second_order);
    trips(SphericalPendulum::default(), &PENDULUM, Fault::DirectedGain, second_order);
    trips(Duffing::default(), &DUFFING, Fault::Residual, second_order);
    trips(Duffing::default(), &DUFFING, Fault::Acceleration, second_order);
}

#[test]
fn wrong_gauss_steps_are_seen() {
    for fault in [Fault::PointForce, Fault::Acceleration] {
        trips(SphericalPendulum::default(), &PENDULUM, fault, check::gauss_order);
        trips(Duffing::default(), &DUFFING, fault, check::gauss_order);
    }
    trips(SphericalPendulum::default(), &PENDULUM, Fault::PointForce, check::gauss_momenta);
    trips(SphericalPendulum::default(), &PENDULUM, Fault::PointForce, check::gauss_symplecticity);
}

#[test]
fn checks_detect_quantities_that_are_not_conserved() {
    trips(SphericalPendulum::default(), &PENDULUM, Fault::MomentumGain, check::momenta);
    trips(SphericalPendulum::default(), &PENDULUM, Fault::Damping, check::symplecticity);
    trips(SphericalPendulum::default(), &PENDULUM, Fault::DirectedGain, check::reversibility);
    trips(Duffing::default(), &DUFFING, Fault::Residual, check::reversibility);
    trips(SphericalPendulum::default(), &PENDULUM, Fault::Energy, check::energy);
    trips(Duffing::default(), &DUFFING, Fault::EnergyGain, check::energy);
    trips(Duffing::default(), &DUFFING, Fault::Energy, check::energy);
    trips(Duffing::default(), &DUFFING, Fault::GdPlus, check::energy);
    trips(SphericalPendulum::default(), &PENDULUM, Fault::StepDensity, check::step_law);
}

/// Asserts a failure that reports that there was nothing to prove, or that nothing was proved.
fn refused(result: Result<Report, CheckFailure>, why: &str) {
    let failure = result.expect_err("a check that passes without proof");
    println!("{failure}");
    assert!(matches!(failure, CheckFailure::Vacuous { .. } | CheckFailure::NotApplicable { .. }), "{failure}");
    assert!(failure.to_string().contains(why), "{failure}");
}

lagrangian! {
    /// No force: steps of any rule are exact.
    struct FreeParticle {
        param m = 2;
        coord x;
        L = m * dot(x)^2 / 2;
        discretize midpoint;
    }
}

#[test]
fn a_check_that_proves_nothing_does_not_pass() {
    let (pendulum, duffing) = (SphericalPendulum::default(), Duffing::default());
    let bottom = Place { t: 0.0, q: [0.0, 0.0].into(), v: [0.0, 0.0].into(), h: 0.02 };
    let still = "nothing moves";
    let everywhere = [check::derivatives, check::slots, check::steps, check::symplecticity, check::reversibility];
    let free = Place { t: 0.0, q: [0.5].into(), v: [1.0].into(), h: 0.1 };
    let particle = FreeParticle::default();
    let rest = Place { v: [0.0].into(), ..free };
    for check in everywhere {
        refused(check(&particle, &rest), still);
    }
    refused(check::gauss_symplecticity(&particle, &rest), still);
    refused(check::gauss_momenta(&particle, &rest), "`x` does not change");
    refused(check::gauss_momenta(&duffing, &DUFFING), "no coordinate is cyclic");
    refused(check::gauss_symplecticity(&duffing, &DUFFING), "a system with a force does not preserve");
    refused(check::order(&particle, &free, 2), "steps of any rule are exact");
    refused(check::gauss_order(&particle, &free), "steps of any rule are exact");
    refused(check::step_law(&particle, &free), "the step density is zero");
    refused(check::momenta(&particle, &rest), "`x` does not change");
    refused(check::momenta(&pendulum, &Place { v: [0.2, 0.0].into(), ..PENDULUM }), "choose a velocity `dot(φ)`");
    refused(check::momenta(&duffing, &DUFFING), "no coordinate is cyclic");
    refused(check::symplecticity(&duffing, &DUFFING), "a system with a force does not preserve");
    refused(check::step_law(&duffing, &DUFFING), "a system without a force");
    // The lowest point has no azimuth: the failure reports its singular mass matrix.
    let failure = check::derivatives(&pendulum, &bottom).expect_err("a singular mass matrix");
    assert!(matches!(failure, CheckFailure::Step { .. }), "{failure}");
    assert!(std::error::Error::source(&failure).is_some());
}

#[test]
fn a_step_that_does_not_exist_is_named() {
    let failure = check::energy(&FreeParticle::default(), &Place { t: 0.0, q: [0.5].into(), v: [1.0].into(), h: 0.1 });
    let failure = failure.expect_err("a free particle has steps of every length");
    assert!(failure.to_string().starts_with("FreeParticle, energy: the step length is not determined"), "{failure}");
}
