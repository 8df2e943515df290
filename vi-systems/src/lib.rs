//! Ready mechanical systems, each a few lines of the language of `lagrangian!`.
//!
//! Every system is a struct whose public fields are its parameters; its documentation holds its physics and where it comes
//! from, and `Default` the parameters that the source uses. Each file declares one system. [`SOURCES`] holds the text of these
//! files, so that tools can show how a system is declared.
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

mod charged_particle;
mod damped_oscillator;
mod double_pendulum;
mod double_well;
mod double_well_duffing;
mod fpu_chain;
mod hard_duffing;
mod harmonic_oscillator;
mod henon_heiles;
mod kepler;
mod n_pendulum;
mod outer_solar_system;
mod parametric_pendulum;
mod pendulum;
mod rotating_hoop;
mod spherical_pendulum;
mod three_body;

pub use charged_particle::ChargedParticle;
pub use damped_oscillator::DampedOscillator;
pub use double_pendulum::DoublePendulum;
pub use double_well::DoubleWell;
pub use double_well_duffing::DoubleWellDuffing;
pub use fpu_chain::FpuChain;
pub use hard_duffing::HardDuffing;
pub use harmonic_oscillator::HarmonicOscillator;
pub use henon_heiles::HenonHeiles;
pub use kepler::Kepler;
pub use n_pendulum::NPendulum;
pub use outer_solar_system::OuterSolarSystem;
pub use parametric_pendulum::ParametricPendulum;
pub use pendulum::Pendulum;
pub use rotating_hoop::RotatingHoop;
pub use spherical_pendulum::SphericalPendulum;
pub use three_body::ThreeBody;

/// The declaration of every system, as the text of the file that holds it.
pub const SOURCES: [&str; 17] = [
    include_str!("charged_particle.rs"),
    include_str!("damped_oscillator.rs"),
    include_str!("double_pendulum.rs"),
    include_str!("double_well.rs"),
    include_str!("double_well_duffing.rs"),
    include_str!("fpu_chain.rs"),
    include_str!("hard_duffing.rs"),
    include_str!("harmonic_oscillator.rs"),
    include_str!("henon_heiles.rs"),
    include_str!("kepler.rs"),
    include_str!("n_pendulum.rs"),
    include_str!("outer_solar_system.rs"),
    include_str!("parametric_pendulum.rs"),
    include_str!("pendulum.rs"),
    include_str!("rotating_hoop.rs"),
    include_str!("spherical_pendulum.rs"),
    include_str!("three_body.rs"),
];
