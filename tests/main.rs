//! The tests across crates that take few steps, one program, compiled without optimization: what they share, generated steppers above all,
//! is compiled once. Those that take many are `long`.

mod arrays;
mod bodies;
mod checks;
mod composition;
mod declarations;
mod derivatives;
mod events;
mod extremes;
mod flow;
mod forms;
mod integrators;
mod limits;
mod loops;
mod orders;
mod predicted;
mod references;
mod resonances;
mod restarts;
mod rules;
mod scaled;
mod single_precision;
mod step_law;
mod support;
mod symmetries;
mod trapezoidal;
mod units;
