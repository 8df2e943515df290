//! Every system with parameters away from 1, and a motion that both integrators can compute.

use vi_systems as systems;

/// A system, its initial state, and the time over which the energy-preserving integrator runs.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Scene<S, const N: usize> {
    pub(crate) system: S,
    pub(crate) q: [f64; N],
    pub(crate) v: [f64; N],
    /// A step of moderate length.
    pub(crate) h: f64,
    /// Time over which the step density keeps its sign.
    pub(crate) span: f64,
}

pub(crate) fn double_well() -> Scene<systems::DoubleWell, 1> {
    let system = systems::DoubleWell { m: 1.3 };
    Scene { system, q: [0.9], v: [0.1], h: 0.05, span: f64::INFINITY }
}

pub(crate) fn harmonic_oscillator() -> Scene<systems::HarmonicOscillator, 1> {
    let system = systems::HarmonicOscillator { m: 1.7, k: 3.1 };
    Scene { system, q: [0.8], v: [0.5], h: 0.05, span: f64::INFINITY }
}

pub(crate) fn damped_oscillator() -> Scene<systems::DampedOscillator, 1> {
    let system = systems::DampedOscillator { m: 1.2, k: 3.4, c: 0.1 };
    Scene { system, q: [0.8], v: [0.5], h: 0.05, span: 80.0 }
}

pub(crate) fn pendulum() -> Scene<systems::Pendulum, 1> {
    let system = systems::Pendulum { m: 1.4, l: 0.7, g: 9.81 };
    Scene { system, q: [1.2], v: [0.4], h: 0.02, span: f64::INFINITY }
}

pub(crate) fn hard_duffing() -> Scene<systems::HardDuffing, 1> {
    let system = systems::HardDuffing { alpha: 1.2, beta: 0.8, c: 0.08, amplitude: 0.25, omega: 1.3 };
    Scene { system, q: [1.1], v: [0.2], h: 0.05, span: f64::INFINITY }
}

pub(crate) fn double_well_duffing() -> Scene<systems::DoubleWellDuffing, 1> {
    let system = systems::DoubleWellDuffing { c: 0.25, amplitude: 0.3, omega: 1.1 };
    Scene { system, q: [1.3], v: [0.1], h: 0.05, span: 8.0 }
}

pub(crate) fn parametric_pendulum() -> Scene<systems::ParametricPendulum, 1> {
    let system = systems::ParametricPendulum { epsilon: 0.15, omega: 0.9 };
    Scene { system, q: [0.9], v: [0.3], h: 0.05, span: 80.0 }
}

pub(crate) fn rotating_hoop() -> Scene<systems::RotatingHoop, 1> {
    let system = systems::RotatingHoop { m: 1.2, r: 0.8, Ω: 4.5, g: 9.81 };
    Scene { system, q: [1.2], v: [0.3], h: 0.02, span: f64::INFINITY }
}

pub(crate) fn kepler() -> Scene<systems::Kepler, 2> {
    let system = systems::Kepler { mu: 1.6 };
    Scene { system, q: [0.6, 0.1], v: [-0.2, 1.9], h: 0.02, span: f64::INFINITY }
}

pub(crate) fn henon_heiles() -> Scene<systems::HenonHeiles, 2> {
    let system = systems::HenonHeiles { lambda: 0.8 };
    Scene { system, q: [0.3, -0.2], v: [0.1, 0.25], h: 0.05, span: f64::INFINITY }
}

pub(crate) fn double_pendulum() -> Scene<systems::DoublePendulum, 2> {
    let system = systems::DoublePendulum { m1: 1.3, m2: 0.8, l1: 0.9, l2: 1.1, g: 9.81 };
    Scene { system, q: [0.5, -0.3], v: [0.2, 0.1], h: 0.01, span: f64::INFINITY }
}

pub(crate) fn spherical_pendulum() -> Scene<systems::SphericalPendulum, 2> {
    let system = systems::SphericalPendulum { m: 1.2, l: 0.9, g: 9.81 };
    Scene { system, q: [1.0, 0.3], v: [0.2, 1.5], h: 0.02, span: f64::INFINITY }
}

pub(crate) fn charged_particle() -> Scene<systems::ChargedParticle, 3> {
    let system = systems::ChargedParticle { m: 1.3, e: 0.9, b: 1.4, s: 0.15, kappa: 1.2 };
    Scene { system, q: [0.2, 0.1, 0.5], v: [0.7, 0.4, 0.1], h: 0.05, span: f64::INFINITY }
}

/// One test for every system: `check` gets its scene.
#[allow(unused_macros, reason = "each program uses a part")]
macro_rules! each_system {
    ($check:path) => {
        $crate::support::scenes::each_system! { $check:
            double_well harmonic_oscillator damped_oscillator pendulum hard_duffing double_well_duffing
            parametric_pendulum rotating_hoop kepler henon_heiles double_pendulum spherical_pendulum charged_particle
        }
    };
    ($check:path: $($system:ident)*) => {$(
        #[test]
        fn $system() {
            $check($crate::support::scenes::$system());
        }
    )*};
}
#[allow(unused_imports, reason = "each program uses a part")]
pub(crate) use each_system;
