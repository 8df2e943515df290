//! Ready mechanical systems, and the command `vi-lab` that runs and charts them.
//!
//! Each system is a few lines of the language of `lagrangian!`; its documentation holds its physics and its source.

pub mod systems;

pub use systems::{
    ChargedParticle, DampedOscillator, DoublePendulum, DoubleWell, DoubleWellDuffing, FpuChain, HardDuffing,
    HarmonicOscillator, HenonHeiles, Kepler, NPendulum, ParametricPendulum, Pendulum, RotatingHoop, SphericalPendulum,
};
