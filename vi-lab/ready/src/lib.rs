//! The predefined systems, each with an initial state, and those of a text ([`text`]).
//!
//! In: the systems of `vi_systems`. Out: a list of [`Entry`] values, which build nothing until a system is used. Most are
//! texts for `vi_tape`. Systems of speed measurements, and those with more coordinates than a text may have, are
//! compiled with every integrator.

pub mod text;

pub use vi_tape::{Mistakes, expressions};

use text::ready;
use vi_report::entry::{Entry, start};
use vi_systems::{
    AndrewsSqueezer, ChaplyginSleigh, ChargedParticle, DampedOscillator, DoublePendulum, DoubleRodPendulum, DoubleWell,
    DoubleWellDuffing, FourBar, FpuChain, GuidingCentre, HardDuffing, HarmonicOscillator, HeavyTop, HenonHeiles,
    Kepler, LotkaVolterra, MasslessParticle, NPendulum, OuterSolarSystem, ParametricPendulum, Pendulum, PointVortices,
    RodChain, RodPendulum, RollingBall, RollingDisk, RotatingHoop, SliderCrank, SphericalPendulum, ThreeBody,
};

/// sin(π (i + 1)/17), to three digits: the lowest mode of 16 masses between walls.
const LOWEST_MODE: [f64; 16] =
    [0.184, 0.361, 0.526, 0.674, 0.798, 0.895, 0.962, 0.996, 0.996, 0.962, 0.895, 0.798, 0.674, 0.526, 0.361, 0.184];

/// The figure-eight orbit: coordinates x and y of the bodies, in the digits of C. Simó.
const EIGHT: [f64; 6] =
    [0.970_004_356_697_34, -0.970_004_356_697_34, 0.0, -0.243_087_531_535_83, 0.243_087_531_535_83, 0.0];
/// The velocities: the third body, in the middle, moves against both others.
const EIGHT_V: [f64; 6] = [
    0.466_203_685_720_52,
    0.466_203_685_720_52,
    -0.932_407_371_441_04,
    0.432_365_730_460_51,
    0.432_365_730_460_51,
    -0.864_731_460_921_02,
];

/// Positions of the vortices: x, then y.
const VORTICES: [f64; 8] = [1.0, -0.5, 0.25, -1.25, 0.1, 0.75, -1.0, -0.5];

/// The entry of a text with constraints, whose initial state follows from its parameters.
macro_rules! placed {
    ($system:ident, $about:literal, $h:literal) => {
        ready::<$system, _>($about, $system::default().start(), $h).placed(|of| start(of, $system::start))
    };
}

/// The predefined systems in the order of the list.
#[must_use]
pub fn systems() -> Vec<Entry> {
    let rest = [0.0];
    let (chain, chain_v) = RodChain::default().start();
    vec![
        ready::<DoubleWell, 1>("particle in a double well: the paper's conservative example", ([0.74], rest), 0.01),
        ready::<DampedOscillator, 1>("damped oscillator: the paper's forced example", ([1.0], rest), 0.01),
        Entry::new::<Pendulum, 1>("mass on a rod", [1.0], rest, 0.01),
        Entry::new::<Kepler, 2>("planet about a fixed sun, eccentricity 0.6", [0.4, 0.0], [0.0, 2.0], 0.005),
        Entry::new::<DoublePendulum, 2>("two pendula, one hanging from the other", [1.0, 1.0], [0.0, 0.0], 0.005),
        ready::<HarmonicOscillator, 1>("mass on a spring", ([1.0], rest), 0.01),
        ready::<HardDuffing, 1>("driven oscillator with a stiffening spring", ([1.0], rest), 0.01),
        ready::<DoubleWellDuffing, 1>("driven double well: chaos", ([0.8], rest), 0.01),
        ready::<ParametricPendulum, 1>("pendulum with a modulated gravity", ([0.5], rest), 0.01),
        ready::<RotatingHoop, 1>("bead on a rotating hoop", ([1.0], rest), 0.01),
        ready::<SphericalPendulum, 2>("mass on a rod in space", ([0.8, 0.0], [0.0, 4.0]), 0.005),
        ready::<HenonHeiles, 2>("star in a galaxy near its circular orbit", ([0.0, 0.1], [0.5, 0.0]), 0.02),
        ready::<ChargedParticle, 3>("charge in a magnetic field", ([1.0, 0.0, 0.1], [0.0, 1.0, 0.0]), 0.01),
        ready::<NPendulum, 4>("four pendula, each hanging from the one above", ([0.6, 0.4, 0.2, 0.1], [0.0; 4]), 0.005),
        ready::<ThreeBody, 6>("three bodies on a figure of eight, period 6.3259", (EIGHT, EIGHT_V), 0.005),
        Entry::new::<FpuChain, 16>(
            "sixteen masses on nonlinear springs, in their lowest mode",
            LOWEST_MODE,
            [0.0; 16],
            0.1,
        ),
        Entry::new::<OuterSolarSystem, 18>(
            "the Sun and five planets; AU, days, solar masses",
            OuterSolarSystem::POSITIONS,
            OuterSolarSystem::VELOCITIES,
            10.0,
        ),
        ready::<PointVortices, 8>("four vortices in the plane; first order", (VORTICES, [0.0; 8]), 0.1),
        ready::<LotkaVolterra, 2>("predators and prey; first order", ([1.0, 1.0], [0.0; 2]), 0.1),
        ready::<MasslessParticle, 2>(
            "charge without mass in a strong field; first order",
            ([0.5, 0.25], [0.0; 2]),
            0.1,
        ),
        ready::<GuidingCentre, 4>(
            "guiding centre in a tokamak; first order",
            ([0.0, 0.0, 0.25, 0.005], [0.0; 4]),
            50.0,
        ),
        placed!(RodPendulum, "mass on a rod, in Cartesian coordinates", 0.01),
        placed!(DoubleRodPendulum, "two masses on two rods", 0.01),
        Entry::with_constraints::<RodChain, 20>("ten masses on a chain of rods", chain, chain_v, 0.01)
            .placed(|of| start(of, RodChain::start)),
        placed!(FourBar, "four-bar linkage: a closed loop", 0.01),
        placed!(SliderCrank, "crank, connecting rod and slider", 0.01),
        placed!(AndrewsSqueezer, "Andrews' squeezer: seven bodies, SI units", 2e-5),
        placed!(HeavyTop, "spinning top, by a unit quaternion", 0.005),
        placed!(ChaplyginSleigh, "sleigh on a blade", 0.01),
        placed!(RollingDisk, "disk that rolls on a plane", 0.01),
        placed!(RollingBall, "ball that rolls on a turntable", 0.01),
    ]
}
