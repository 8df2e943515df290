//! The ready systems of the Python package, with every integrator.

use vi_erased::{System, kind};
use vi_systems::{
    AndrewsSqueezer, ChaplyginSleigh, ChargedParticle, DampedOscillator, DoublePendulum, DoubleRodPendulum, DoubleWell,
    DoubleWellDuffing, FourBar, FpuChain, HardDuffing, HarmonicOscillator, HeavyTop, HenonHeiles, Kepler, NPendulum,
    OuterSolarSystem, ParametricPendulum, Pendulum, RodChain, RodPendulum, RollingBall, RollingDisk, RotatingHoop,
    SliderCrank, SphericalPendulum, ThreeBody,
};

macro_rules! systems {
    ($($system:ident),* $(,)?) => {
        vec![$(kind!($system, { fixed; splitting; gauss 4, 8; energy; energy 1, 2, 3 })),*]
    };
}

macro_rules! with_constraints {
    ($($system:ident),* $(,)?) => {
        vec![$(kind!($system, { gauss 1, 2, 3; energy 2 })),*]
    };
}

/// The systems with their default parameters: those with constraints are after the others, Kepler is last.
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
    systems.extend(with_constraints!(
        AndrewsSqueezer,
        ChaplyginSleigh,
        DoubleRodPendulum,
        FourBar,
        HeavyTop,
        RodChain,
        RodPendulum,
        RollingBall,
        RollingDisk,
        SliderCrank,
    ));
    // Steps in transformed time are built only for the system that declares a time scale.
    systems.push(kind!(Kepler, { fixed; splitting; gauss 4, 8; transformed 4, 8; energy; energy 1, 2, 3 }));
    systems
}
