//! The command `vi-lab`.

use std::process::ExitCode;

fn main() -> ExitCode {
    vi_lab::main()
}
