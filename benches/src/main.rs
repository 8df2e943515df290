//! Times the generated steppers against their rivals and prints the table; with `--write` puts it into docs/benchmarks.md.

use clap::{Parser, Subcommand};
use std::fmt::Write;
use std::path::Path;
use std::process::ExitCode;
use vi_benches::contest::COMPARED;
use vi_benches::document::{Measured, growth, replaced, table};
use vi_benches::{contests, count, time};

const DOCUMENT: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/benchmarks.md");

/// Times the generated steppers against their rivals.
#[derive(Parser)]
struct Arguments {
    /// Puts the table of the default build into docs/benchmarks.md.
    #[arg(long)]
    write: bool,
    /// Only contests whose name contains this; not with --write.
    #[arg(long, conflicts_with = "write", default_value = "")]
    only: String,
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Subcommand)]
enum Command {
    /// Runs one entry of a contest, both by number, and prints where it ends: what callgrind counts.
    Run { contest: usize, entry: usize, steps: usize },
}

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let outcome = match arguments.command {
        Some(Command::Run { contest, entry, steps }) => run(contest, entry, steps),
        None => race(&arguments.only).and_then(|section| if arguments.write { write(&section) } else { Ok(()) }),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("error: {message}");
            ExitCode::FAILURE
        }
    }
}

fn run(contest: usize, entry: usize, steps: usize) -> Result<(), String> {
    let contests = contests::all();
    let contest = contests.get(contest).ok_or("no such contest")?;
    let entry = contest.entries.get(entry).ok_or("no such entry")?;
    println!("{:?}", entry.run.run(steps));
    Ok(())
}

/// Measures and prints; the section of the document.
fn race(only: &str) -> Result<String, String> {
    let contests = contests::all();
    let mut measured = Vec::new();
    for (number, contest) in contests.iter().enumerate().filter(|(_, contest)| contest.name.contains(only)) {
        eprintln!("{}", contest.name);
        for (entry, deviation) in contest.entries.iter().zip(contest.deviations()) {
            if deviation > entry.bound {
                let name = entry.name;
                return Err(format!(
                    "{name} is {deviation:.1e} off after {COMPARED} steps, allowed are {:.1e}",
                    entry.bound
                ));
            }
        }
        let count = |(index, trajectories): (usize, usize)| {
            let share = 1.0 / f64::from(u32::try_from(trajectories).ok()?);
            count::instructions(number, index).map(|count| count * share)
        };
        let instructions = contest.entries.iter().map(|entry| entry.trajectories).enumerate().map(count).collect();
        measured.push(Measured { contest, timings: time::contest(contest), instructions });
    }
    let mut section = table(&measured);
    if let Some(growth) = growth(&measured, [("Chain of 16", 16.0), ("Chain of 64", 64.0)]) {
        let _ = writeln!(section, "\nPer mass, the generated step of the chain of 64 takes {growth:.2} of that of 16.");
    }
    println!("{section}");
    Ok(section)
}

fn write(section: &str) -> Result<(), String> {
    if cfg!(target_feature = "fma") {
        return Err("the table is of the default build: unset RUSTFLAGS to write it".to_owned());
    }
    let path = Path::new(DOCUMENT);
    let text = std::fs::read_to_string(path).map_err(|error| format!("{DOCUMENT}: {error}"))?;
    let text = replaced(&text, "default", section).ok_or(format!("{DOCUMENT} has no markers of `default`"))?;
    std::fs::write(path, text).map_err(|error| format!("{DOCUMENT}: {error}"))
}
