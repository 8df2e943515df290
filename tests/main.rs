//! The tests across crates, one program: what they share, generated steppers above all, is compiled once.

mod arrays;
mod checks;
mod composition;
mod declarations;
mod derivatives;
mod extremes;
mod failures;
mod flow;
mod forms;
mod hunt;
mod invariants;
mod iterations;
mod loops;
mod orders;
mod predicted;
mod references;
mod resonances;
mod restarts;
mod robustness;
mod single_precision;
mod solvability;
mod step_law;
mod support;
mod symmetries;
mod trapezoidal;
mod units;
