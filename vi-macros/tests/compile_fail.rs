//! Mistakes as rustc prints them: message and caret only. Each file of `compile_fail/` uses the struct of its broken
//! system, so that the expected output shows that the stub keeps the surrounding code valid.
//!
//! `TRYBUILD=overwrite cargo test -p vi-macros` rewrites the expected output, for the version of rustc that the workflow pins.
//! Other versions word their part of a message differently: with them the test compares nothing, and prints so.

use std::io::{Write as _, stderr};
use std::process::Command;

/// The workflow, which pins the version.
const WORKFLOW: &str = include_str!("../../.github/workflows/ci.yml");

/// The version of rustc, as in `rustc 1.95.0 (59807616e 2026-04-14)`.
fn version() -> String {
    let output = Command::new("rustc").arg("--version").output().expect("rustc runs");
    let words = String::from_utf8(output.stdout).expect("rustc prints text");
    words.split_whitespace().nth(1).expect("rustc prints its version").to_owned()
}

#[test]
fn broken_systems_fail_with_our_message_alone() {
    let pinned =
        WORKFLOW.lines().find_map(|line| line.trim().strip_prefix("PINNED: ")).expect("the workflow pins a version");
    let version = version();
    if version == pinned {
        trybuild::TestCases::new().compile_fail("tests/compile_fail/*.rs");
    } else {
        // Not `eprintln!`, which a passed test does not show.
        let skipped = format!("skipped: the messages of `compile_fail` are those of rustc {pinned}, this is {version}");
        writeln!(stderr(), "{skipped}").expect("standard error is open");
    }
}
