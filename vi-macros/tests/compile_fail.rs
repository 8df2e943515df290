//! Mistakes as rustc prints them: message and caret only. Each file of `compile_fail/` uses the struct of its broken
//! system, so that the expected output shows that the stub keeps the surrounding code valid.
//!
//! `UPDATE_MESSAGES=1 cargo test --test compile_fail` rewrites the expected output, for the version of rustc that the workflow
//! pins. Other versions word their part of a message differently: with them the test compares nothing, and prints so.

use std::ffi::OsString;
use std::fmt::Write as _;
use std::io::{Write as _, stderr};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::{env, fs};

/// The workflow, which pins the version.
const WORKFLOW: &str = include_str!("../../.github/workflows/ci.yml");

/// Starts of lines that belong to no message: the end of every failed build, and files with the full name of a type.
const OTHERS: [&str; 5] = [
    "error: aborting due to",
    "For more information about",
    "Some errors have",
    "   = note: the full name for the type has been written to",
    "   = note: consider using `--verbose` to print the full type name",
];

/// The output of a command, without what the gate sets for the seconds of tests: build scripts would run again.
fn run(command: &mut Command) -> Output {
    command.env_remove("RUSTC_BOOTSTRAP").output().unwrap_or_else(|error| panic!("{command:?}: {error}"))
}

fn text(bytes: Vec<u8>) -> String {
    String::from_utf8(bytes).expect("rustc and Cargo print text")
}

/// The version of rustc, as in `rustc 1.95.0 (59807616e 2026-04-14)`.
fn version() -> String {
    let words = text(run(Command::new("rustc").arg("--version")).stdout);
    words.split_whitespace().nth(1).expect("rustc prints its version").to_owned()
}

fn workspace() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the workspace")
}

/// The library of vi-core that Cargo reports for this test, in the target folder and with the profile of this program.
///
/// No package is named: features are then those of `cargo test`, which has built the library.
fn library() -> PathBuf {
    let program = env::current_exe().expect("the path of this program");
    let profile = program.ancestors().nth(2).expect("target/debug/deps");
    let target = profile.parent().expect("target/debug");
    let mut cargo = Command::new(env!("CARGO"));
    cargo.args(["test", "--locked", "--test=compile_fail", "--no-run", "--message-format=json"]);
    cargo.arg("--target-dir").arg(target).current_dir(workspace());
    if profile.ends_with("release") {
        cargo.arg("--release");
    }
    let output = run(&mut cargo);
    let messages = text(output.stdout);
    let is_library = |path: &&Path| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        name.starts_with("libvi_core-") && path.extension().is_some_and(|end| end == "rlib")
    };
    let path = messages.split('"').map(Path::new).find(is_library);
    path.unwrap_or_else(|| panic!("Cargo reports no library of vi-core:\n{}", text(output.stderr))).to_owned()
}

/// A line without the number of a line of vi-core, which moves, and without the folder of the workspace.
fn placeless(line: &str) -> String {
    let line = line.replace(workspace().to_str().expect("a path as text"), "$WORKSPACE");
    match line.split_once(" vi-core/") {
        Some((arrow, place)) => format!("{arrow} $WORKSPACE/vi-core/{}", place.split(':').next().unwrap_or_default()),
        None => line,
    }
}

/// The messages of rustc for a file, which must not compile.
fn messages(file: &Path, library: &Path) -> String {
    let mut dependencies = OsString::from("dependency=");
    dependencies.push(library.parent().expect("a folder"));
    let mut vi_core = OsString::from("vi_core=");
    vi_core.push(library);
    let mut rustc = Command::new("rustc");
    rustc.args(["--edition=2024", "--crate-name=broken", "--crate-type=bin", "--emit=metadata", "-o"]);
    rustc.arg(library.with_file_name("compile_fail.rmeta")).arg("-L").arg(dependencies);
    let output = run(rustc.arg("--extern").arg(vi_core).arg(file));
    assert!(!output.status.success(), "{} compiles", file.display());
    let errors = text(output.stderr);
    let lines = errors.lines().filter(|line| !OTHERS.iter().any(|start| line.starts_with(start)));
    let kept = lines.fold(String::new(), |kept, line| kept + &placeless(line) + "\n");
    kept.trim_end().to_owned() + "\n"
}

#[test]
fn broken_systems_fail_with_our_message_alone() {
    let pinned =
        WORKFLOW.lines().find_map(|line| line.trim().strip_prefix("PINNED: ")).expect("the workflow pins a version");
    let version = version();
    if version != pinned {
        // Not `eprintln!`, which a passed test does not show.
        let skipped = format!("skipped: the messages of `compile_fail` are those of rustc {pinned}, this is {version}");
        writeln!(stderr(), "{skipped}").expect("standard error is open");
        return;
    }
    let folder = fs::read_dir("tests/compile_fail").expect("the folder of broken systems");
    let paths = folder.map(|entry| entry.expect("an entry").path());
    let mut files: Vec<PathBuf> = paths.filter(|path| path.extension().is_some_and(|end| end == "rs")).collect();
    files.sort();
    assert!(files.len() >= 27, "{files:?}");
    let library = library();
    let mut differences = String::new();
    for file in files {
        let found = messages(&file, &library);
        let stored = file.with_extension("stderr");
        if env::var_os("UPDATE_MESSAGES").is_some() {
            fs::write(&stored, &found).unwrap_or_else(|error| panic!("{}: {error}", stored.display()));
        }
        let expected = fs::read_to_string(&stored).unwrap_or_default();
        if found != expected {
            writeln!(differences, "{}\nexpected:\n{expected}\nfound:\n{found}", file.display()).expect("a string");
        }
    }
    assert!(differences.is_empty(), "{differences}");
}
