//! Systems, each a few lines of the language, with its physics and source in its documentation.

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
mod parametric_pendulum;
mod pendulum;
mod rotating_hoop;
mod spherical_pendulum;

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
pub use parametric_pendulum::ParametricPendulum;
pub use pendulum::Pendulum;
pub use rotating_hoop::RotatingHoop;
pub use spherical_pendulum::SphericalPendulum;
