//! Mistakes as rustc prints them: message and caret only. Each file of `compile_fail/` uses the struct of its broken
//! system, so that the expected output shows that the stub keeps the surrounding code valid.
//!
//! `TRYBUILD=overwrite cargo test -p vi-macros` rewrites the expected output.

#[test]
fn broken_systems_fail_with_our_message_alone() {
    trybuild::TestCases::new().compile_fail("tests/compile_fail/*.rs");
}
