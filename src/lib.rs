#![doc = include_str!("../README.md")]
#![no_std]

#[doc = include_str!("../docs/dsl.md")]
pub mod dsl {}
