//! Steps of systems with constraints.

mod assembly;
mod blocks;
mod checks;
mod composed;
mod control;
mod dead_points;
mod derivatives;
mod energy;
mod energy_runs;
mod errors;
mod far;
mod gears;
mod redundant;
mod references;
mod runs;
mod structure;
mod switching;
pub(crate) mod systems;
