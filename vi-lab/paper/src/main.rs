//! The command `paper`.

use clap::Parser as _;
use std::process::ExitCode;
use vi_paper::Study;
use vi_report::terminal::{end, print};

fn main() -> ExitCode {
    end(vi_paper::write(&Study::parse()).and_then(|summary| print(&summary)))
}
