//! Predefined mechanical systems, each a few lines of the language of `lagrangian!`.
//!
//! Every system is a struct whose public fields are its parameters. Its documentation gives its physics and its source,
//! and `Default` the parameters of the source. Each file declares one system. [`SOURCES`] contains the text of these
//! files for tools that show declarations.
//!
//! ```
//! use vi_core::prelude::*;
//! use vi_systems::Kepler;
//!
//! let planet = Kepler::default();
//! let start = planet.at(0.0, [0.4, 0.0], [0.0, 2.0]);
//! let energy = start.state.energy(&planet)?;
//! for state in start.integrate(FixedStep, 0.005)?.take(1000) {
//!     assert!((state?.energy(&planet)? - energy).abs() < 1e-3);
//! }
//! # Ok::<(), StepError>(())
//! ```

mod andrews_squeezer;
mod chaplygin_sleigh;
mod charged_particle;
mod damped_oscillator;
mod double_pendulum;
mod double_rod_pendulum;
mod double_well;
mod double_well_duffing;
mod four_bar;
mod fpu_chain;
mod guiding_centre;
mod hard_duffing;
mod harmonic_oscillator;
mod heavy_top;
mod henon_heiles;
mod kepler;
mod lotka_volterra;
mod massless_particle;
mod n_pendulum;
mod outer_solar_system;
mod parametric_pendulum;
mod pendulum;
mod point_vortices;
mod rod_chain;
mod rod_pendulum;
mod rolling_ball;
mod rolling_disk;
mod rotating_hoop;
mod slider_crank;
mod spherical_pendulum;
mod three_body;

pub use andrews_squeezer::AndrewsSqueezer;
pub use chaplygin_sleigh::ChaplyginSleigh;
pub use charged_particle::ChargedParticle;
pub use damped_oscillator::DampedOscillator;
pub use double_pendulum::DoublePendulum;
pub use double_rod_pendulum::DoubleRodPendulum;
pub use double_well::DoubleWell;
pub use double_well_duffing::DoubleWellDuffing;
pub use four_bar::FourBar;
pub use fpu_chain::FpuChain;
pub use guiding_centre::GuidingCentre;
pub use hard_duffing::HardDuffing;
pub use harmonic_oscillator::HarmonicOscillator;
pub use heavy_top::HeavyTop;
pub use henon_heiles::HenonHeiles;
pub use kepler::Kepler;
pub use lotka_volterra::LotkaVolterra;
pub use massless_particle::MasslessParticle;
pub use n_pendulum::NPendulum;
pub use outer_solar_system::OuterSolarSystem;
pub use parametric_pendulum::ParametricPendulum;
pub use pendulum::Pendulum;
pub use point_vortices::PointVortices;
pub use rod_chain::RodChain;
pub use rod_pendulum::RodPendulum;
pub use rolling_ball::RollingBall;
pub use rolling_disk::RollingDisk;
pub use rotating_hoop::RotatingHoop;
pub use slider_crank::SliderCrank;
pub use spherical_pendulum::SphericalPendulum;
pub use three_body::ThreeBody;

/// The declaration of every system, as the text of its file.
pub const SOURCES: [&str; 31] = [
    include_str!("andrews_squeezer.rs"),
    include_str!("chaplygin_sleigh.rs"),
    include_str!("charged_particle.rs"),
    include_str!("damped_oscillator.rs"),
    include_str!("double_pendulum.rs"),
    include_str!("double_rod_pendulum.rs"),
    include_str!("double_well.rs"),
    include_str!("double_well_duffing.rs"),
    include_str!("four_bar.rs"),
    include_str!("fpu_chain.rs"),
    include_str!("guiding_centre.rs"),
    include_str!("hard_duffing.rs"),
    include_str!("harmonic_oscillator.rs"),
    include_str!("heavy_top.rs"),
    include_str!("henon_heiles.rs"),
    include_str!("kepler.rs"),
    include_str!("lotka_volterra.rs"),
    include_str!("massless_particle.rs"),
    include_str!("n_pendulum.rs"),
    include_str!("outer_solar_system.rs"),
    include_str!("parametric_pendulum.rs"),
    include_str!("pendulum.rs"),
    include_str!("point_vortices.rs"),
    include_str!("rod_chain.rs"),
    include_str!("rod_pendulum.rs"),
    include_str!("rolling_ball.rs"),
    include_str!("rolling_disk.rs"),
    include_str!("rotating_hoop.rs"),
    include_str!("slider_crank.rs"),
    include_str!("spherical_pendulum.rs"),
    include_str!("three_body.rs"),
];
