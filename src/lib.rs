//! tests
pub use vi_core::*;
