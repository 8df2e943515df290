//! The tests of vi-core with handwritten systems that take many steps as one program, compiled with optimization.

mod branches;
mod checkpoints;
mod checks_of_many;
mod fallback;
mod long_runs;
mod many;
#[allow(dead_code, reason = "each program uses a part")]
#[path = "../../../vi-core/tests/spoiled/mod.rs"]
mod spoiled;
#[allow(dead_code, reason = "each program uses a part")]
#[path = "../../../vi-core/tests/systems/mod.rs"]
mod systems;
