//! The ready systems of the Python package: a few compiled, with every integrator; the others as texts.

use vi_core::lagrangian::Described;
use vi_erased::{System, kind};
use vi_systems::{
    AndrewsSqueezer, ChaplyginSleigh, ChargedParticle, DampedOscillator, DoublePendulum, DoubleRodPendulum, DoubleWell,
    DoubleWellDuffing, FourBar, FpuChain, GuidingCentre, HardDuffing, HarmonicOscillator, HeavyTop, HenonHeiles,
    Kepler, LotkaVolterra, MasslessParticle, NPendulum, OuterSolarSystem, ParametricPendulum, Pendulum, PointVortices,
    RodChain, RodPendulum, RollingBall, RollingDisk, RotatingHoop, SliderCrank, SphericalPendulum, ThreeBody,
};

macro_rules! systems {
    ($($system:ident),* $(,)?) => {
        vec![$(kind!($system, { fixed; splitting; gauss 4, 8; adaptive 4, 8; energy; energy 1, 2, 3 })),*]
    };
}

/// The compiled systems with their default parameters.
#[must_use]
pub fn systems() -> Vec<Box<dyn System>> {
    let mut systems = systems!(DoublePendulum);
    // Steps in transformed time are built only for the system that declares a time scale.
    systems
        .push(kind!(Kepler, { fixed; splitting; gauss 4, 8; adaptive 4, 8; transformed 4, 8; energy; energy 1, 2, 3 }));
    systems
}

/// Name and declaration of the others.
#[must_use]
pub fn texts() -> Vec<(&'static str, &'static str)> {
    macro_rules! texts {
        ($($system:ident),*) => { vec![$((stringify!($system), <$system as Described>::DEFINITION)),*] };
    }
    texts!(
        AndrewsSqueezer,
        ChaplyginSleigh,
        ChargedParticle,
        DampedOscillator,
        DoubleRodPendulum,
        DoubleWell,
        DoubleWellDuffing,
        FourBar,
        FpuChain,
        GuidingCentre,
        HardDuffing,
        HarmonicOscillator,
        HeavyTop,
        HenonHeiles,
        LotkaVolterra,
        MasslessParticle,
        NPendulum,
        OuterSolarSystem,
        ParametricPendulum,
        Pendulum,
        PointVortices,
        RodChain,
        RodPendulum,
        RollingBall,
        RollingDisk,
        RotatingHoop,
        SliderCrank,
        SphericalPendulum,
        ThreeBody
    )
}
