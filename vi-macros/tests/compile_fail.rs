//! Mistakes as a user meets them, printed by rustc: message and caret, and nothing beside. Each file of `compile_fail/`
//! uses the struct of its broken system, so that the expected output shows that the stub keeps the code around it right.
//!
//! `TRYBUILD=overwrite cargo test -p vi-macros` writes the expected output anew.

#[test]
fn broken_systems_fail_with_our_message_alone() {
    trybuild::TestCases::new().compile_fail("tests/compile_fail/*.rs");
}
