//! The run-time tests with handwritten systems as one program, so that shared code compiles once.

mod branches;
mod checkpoints;
mod checks;
mod checks_of_many;
mod constrained;
mod derivatives;
mod equations;
mod failures;
mod fallback;
mod gauss_alone;
mod indexed;
mod long_runs;
mod many;
mod outcomes;
mod references;
mod spoiled;
mod systems;
mod tables;
