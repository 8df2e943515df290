//! The ready systems of the Python package, with every integrator.

use vi_erased::{System, kind};
use vi_systems::{
    ChargedParticle, DampedOscillator, DoublePendulum, DoubleWell, DoubleWellDuffing, FpuChain, HardDuffing,
    HarmonicOscillator, HenonHeiles, Kepler, NPendulum, OuterSolarSystem, ParametricPendulum, Pendulum, RotatingHoop,
    SphericalPendulum, ThreeBody,
};

macro_rules! systems {
    ($($system:ident),* $(,)?) => {
        vec![$(kind!($system, { fixed; gauss 4, 8; energy; energy 1, 2, 3 })),*]
    };
}

/// The systems with their default parameters, in alphabetical order but for Kepler, which is last.
#[must_use]
pub fn systems() -> Vec<Box<dyn System>> {
    let mut systems = systems!(
        ChargedParticle,
        DampedOscillator,
        DoublePendulum,
        DoubleWell,
        DoubleWellDuffing,
        FpuChain,
        HardDuffing,
        HarmonicOscillator,
        HenonHeiles,
        NPendulum,
        OuterSolarSystem,
        ParametricPendulum,
        Pendulum,
        RotatingHoop,
        SphericalPendulum,
        ThreeBody,
    );
    // Steps in transformed time are built only for the system that declares a time scale.
    systems.push(kind!(Kepler, { fixed; gauss 4, 8; transformed 4, 8; energy; energy 1, 2, 3 }));
    systems
}
