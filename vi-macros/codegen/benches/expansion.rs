//! Cost of an expansion, over two families of systems: operations, seconds of the macro, seconds of rustc.
//!
//! `cargo bench -p vi-codegen --bench expansion` prints the table of `docs/expansion.md`; with `--profile dev` the macro is
//! not optimized, which is cargo's default. Seconds of rustc are those of a program that runs both integrators of the
//! system, minus those of an empty one.

#[path = "../tests/families/mod.rs"]
mod families;

use families::{LENGTHS, LINKS};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;
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
fn main() -> Result<(), vi_core::StepError> {
    let (system, q, v) = (System::default(), [0.1; LENGTH], [0.0; LENGTH]);
    let mut fixed = vi_core::FixedStep::new(system, vi_core::State::at(&system, 0.0, q, v), 0.01)?;
    println!(\"{:?}\", fixed.step()?);
    println!(\"{:?}\", vi_core::EnergyPreserving::from_midpoint(system, 0.0, q, v, 0.01)?.step()?);
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

/// A crate beside this one's build, of one file that depends on `vi-core`.
struct Project {
    folder: PathBuf,
}

impl Project {
    fn new() -> Self {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("expansion");
        let core = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../vi-core");
        fs::create_dir_all(folder.join("src")).expect("a folder");
        let manifest = format!(
            "[package]\nname = \"expansion\"\nversion = \"0.0.0\"\nedition = \"2024\"\n[dependencies]\nvi-core = {{ path = '{}' }}\n[workspace]\n",
            core.display()
        );
        fs::write(folder.join("Cargo.toml"), manifest).expect("a manifest");
        Self { folder }
    }

    fn write(&self, text: &str) {
        fs::write(self.folder.join("src/main.rs"), text).expect("a file");
    }

    /// Seconds that a build takes.
    fn build(&self, release: bool) -> f64 {
        let mut cargo = Command::new(env!("CARGO"));
        cargo.args(["build", "--quiet"]).args(release.then_some("--release")).current_dir(&self.folder);
        let start = Instant::now();
        let status = cargo
            .env("RUSTFLAGS", "--cap-lints allow")
            .env("CARGO_TARGET_DIR", self.folder.join("target"))
            .status()
            .expect("cargo runs");
        assert!(status.success(), "the expansion does not compile");
        start.elapsed().as_secs_f64()
    }
}
