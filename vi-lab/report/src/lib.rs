//! What the commands `vi-lab` and `paper` show and say, and the systems that they know by name.
//!
//! In: numbers and words of a subcommand. Out: figures, tables and pages as files; progress, and failures with their exit statuses, for a
//! terminal. No loop over steps stands here, so that nothing of it has to be optimized: it is compiled in seconds.
//!
//! | module | what it makes |
//! |---|---|
//! | [`chart`], [`table`], [`html`], [`page`] | figures, tables, and the page that holds them |
//! | [`input`], [`numbers`] | numbers as users write them, and as pages and messages do |
//! | [`progress`], [`machine`], [`interrupt`], [`failure`], [`terminal`] | bars, versions, signals, errors, how a program ends |
//! | [`catalogue`], [`quantity`] | the systems by name; what differs from run to run |

pub mod catalogue;
pub mod chart;
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
