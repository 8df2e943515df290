//! Ready mechanical systems, and the command `vi-lab` that runs and charts them.
//!
//! Each system is a few lines of the language of `lagrangian!`; its documentation holds its physics and its source.

pub mod systems;

pub use systems::{
    ChargedParticle, DampedOscillator, DoublePendulum, DoubleWell, DoubleWellDuffing, HardDuffing, HarmonicOscillator,
    HenonHeiles, Kepler, ParametricPendulum, Pendulum, RotatingHoop, SphericalPendulum,
};
