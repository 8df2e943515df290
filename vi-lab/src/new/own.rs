//! The crate that `vi-lab new mine` writes, its library and its program in one.

#[path = "lib.rs"]
pub mod mine;

include!("main.rs");
