//! The library and the program of the crate that `vi-lab new mine` writes.

#[path = "lib.rs"]
pub mod mine;

include!("main.rs");
