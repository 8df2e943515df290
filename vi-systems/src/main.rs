//! The command `vi-lab`.

mod lab;

use std::process::ExitCode;

fn main() -> ExitCode {
    lab::main()
}
