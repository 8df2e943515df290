#![doc = include_str!("../README.md")]
#![no_std]

#[doc = include_str!("../docs/dsl.md")]
pub mod dsl {}

#[doc = include_str!("../docs/reference.md")]
pub mod reference {}

#[doc = include_str!("../docs/choosing.md")]
pub mod choosing {}

#[doc = include_str!("../docs/cookbook.md")]
pub mod cookbook {}

#[doc = include_str!("../docs/theory.md")]
pub mod theory {}
