//! Cost of an expansion, over families of systems: operations, seconds of the macro, seconds of rustc.
//!
//! `cargo bench -p vi-codegen --bench expansion` prints the tables of `docs/expansion.md`, and draws the second one; with
//! `-- large` only the second one. With `--profile dev` the macro is not optimized, which is cargo's default. Seconds of
//! rustc are those of a program that runs both integrators of the system, or takes fixed steps of the large systems, minus
//! those of an empty one.

#[path = "../../tests/families/mod.rs"]
mod families;
mod large;
mod project;

use families::{LENGTHS, LINKS};
use project::Project;
use std::time::Instant;
use vi_codegen::program::FunctionId;
use vi_codegen::syntax;

fn main() {
    let project = Project::new();
    let empty = [false, true].map(|release| {
        project.write("fn main() {}");
        project.build(release);
        project.write("fn main() { }");
        project.build(release)
    });
    if !std::env::args().any(|argument| argument == "large") {
        small(&project, empty);
    }
    large::table(&project, empty[1]);
}

/// The table of systems that are written as lines.
fn small(project: &Project, empty: [f64; 2]) {
    println!(
        "| system | n | operations per iteration: fixed, energy-preserving | lines | expansion (s) | rustc, debug (s) | rustc, release (s) |"
    );
    println!("|---|---|---|---|---|---|---|");
    let chains = LENGTHS.map(|n| ("chain", n, families::chain(n)));
    let pendula = LINKS.map(|n| ("N-pendulum", n, families::pendulum(n)));
    for (name, n, text) in chains.into_iter().chain(pendula) {
        let [fixed, extended] = operations(&text);
        let start = Instant::now();
        let rust = vi_codegen::expand(text.parse().expect("tokens"));
        let optimized = start.elapsed().as_secs_f64();
        let file = syn::parse2(rust).expect("Rust");
        let rust = prettyplease::unparse(&file);
        project.write(&format!("{rust}\n{}", MAIN.replace("LENGTH", &n.to_string())));
        let [debug, release] = [0, 1].map(|index| project.build(index == 1) - empty[index]);
        let lines = rust.lines().count();
        println!("| {name} | {n} | {fixed}, {extended} | {lines} | {optimized:.3} | {debug:.2} | {release:.2} |");
    }
}

/// Runs both integrators, so that everything is compiled.
const MAIN: &str = "
use vi_core::prelude::*;

fn main() -> Result<(), StepError> {
    let start = System::default().at(0.0, [0.1; LENGTH], [0.0; LENGTH]);
    println!(\"{:?}\", start.integrate(FixedStep, 0.01)?.step()?);
    println!(\"{:?}\", start.integrate(EnergyPreserving, 0.01)?.step()?);
    Ok(())
}
";

/// Operations that one iteration of either integrator takes.
fn operations(text: &str) -> [usize; 2] {
    let system = syntax::parse::system(text.parse().expect("tokens"));
    let program = system.and_then(|system| vi_codegen::derive(&system)).expect("a right system").own.program;
    [FunctionId::MomentumEquation, FunctionId::ExtendedSystem]
        .map(|id| program.function(id).expect("every function is there").operation_count())
}
