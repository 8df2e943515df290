//! The output of the commands `vi-lab` and `paper`, and their systems by name.
//!
//! In: numbers and text of a subcommand. Out: figures, tables and pages as files; progress, and failures with exit
//! statuses, for a terminal. This crate has no loop over steps, needs no optimization and compiles in seconds.
//!
//! | module | product |
//! |---|---|
//! | [`chart`], [`table`], [`html`], [`page`] | figures, tables, and their page |
//! | [`input`], [`numbers`] | numbers in input, pages and messages |
//! | [`progress`], [`machine`], [`interrupt`], [`failure`], [`terminal`] | bars, versions, signals, errors, the exit of a program |
//! | [`entry`], [`catalogue`], [`quantity`] | a system with a place to start from; the systems by name; the quantities that vary from run to run |

pub mod catalogue;
pub mod chart;
pub mod entry;
pub mod failure;
pub mod html;
pub mod input;
pub mod interrupt;
pub mod machine;
pub mod numbers;
pub mod page;
pub mod progress;
pub mod quantity;
pub mod table;
pub mod terminal;
