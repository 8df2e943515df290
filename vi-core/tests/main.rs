//! The run-time tests with handwritten systems as one program, so that shared code compiles once. Those that take many
//! steps are in `tests/long/core`.

mod checks;
mod constrained;
mod derivatives;
mod equations;
mod equilibria;
mod failures;
mod gauss_alone;
mod indexed;
mod outcomes;
mod references;
#[allow(dead_code, reason = "each program uses a part")]
mod spoiled;
#[allow(dead_code, reason = "each program uses a part")]
mod systems;
mod tables;
