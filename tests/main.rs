//! The tests across crates with few steps as one program, compiled without optimization, so that shared code (above all
//! generated steppers) compiles once. Tests with many steps are in `long`.

mod angles;
mod arrays;
mod bodies;
mod checks;
mod composition;
mod control;
mod declarations;
mod derivatives;
mod estimates;
mod events;
mod extremes;
mod flow;
mod forms;
mod functions;
mod inputs;
mod integrators;
mod large;
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
mod splitting;
mod step_law;
mod support;
mod symmetries;
mod trapezoidal;
mod units;
mod vectors;
