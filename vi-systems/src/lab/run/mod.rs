//! `vi-lab run`: one system simulated, its nodes written as CSV or NPY.
//!
//! In: the command line, or a scene file whose entries the command line overrides. Out: rows `t, q…, p…, energy, h`.
//! A failing step leaves the rows so far in the file.

mod csv;
mod npy;
mod request;
mod scene;

use super::failure::Failure;
use super::progress::Progress;
use super::simulation::{Method, Row, Simulation, Start};
use clap::Args;
use request::{Length, Request};
use std::path::PathBuf;

/// Arguments of `vi-lab run`.
#[derive(Clone, Debug, Default, Args)]
#[command(after_help = "The first row is the node from which the integrator starts. With --method energy and \
                        --start midpoint the initial state is the middle of the first interval, and that node lies half \
                        a step later.")]
pub(crate) struct Arguments {
    /// Name of a system (see `vi-lab list`), or a scene file whose name ends in .toml
    #[arg(value_name = "SYSTEM|SCENE.toml")]
    pub(crate) target: String,
    /// Integrator [default: fixed]
    #[arg(long)]
    pub(crate) method: Option<Method>,
    /// First interval of the energy-preserving integrator [default: midpoint]
    #[arg(long)]
    pub(crate) start: Option<Start>,
    /// Step, or first step [default: the system's]
    #[arg(long, value_name = "H", allow_hyphen_values = true)]
    pub(crate) h: Option<f64>,
    /// Number of steps
    #[arg(long, value_name = "N")]
    pub(crate) steps: Option<u64>,
    /// Steps until this time is reached
    #[arg(long, value_name = "T", allow_hyphen_values = true)]
    pub(crate) until: Option<f64>,
    /// Sets a parameter; may be given more than once
    #[arg(long, value_name = "NAME=VALUE")]
    pub(crate) set: Vec<String>,
    /// Initial time [default: 0]
    #[arg(long, value_name = "T0", allow_hyphen_values = true)]
    pub(crate) t: Option<f64>,
    /// Initial coordinates, separated by commas [default: the system's]
    #[arg(long, value_name = "Q,…", value_delimiter = ',', allow_hyphen_values = true)]
    pub(crate) q: Option<Vec<f64>>,
    /// Initial velocities, separated by commas [default: the system's]
    #[arg(long, value_name = "V,…", value_delimiter = ',', allow_hyphen_values = true)]
    pub(crate) v: Option<Vec<f64>>,
    /// File to write, .csv or .npy; without it CSV goes to standard output
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
}

/// Where rows go.
trait Sink {
    /// Writes a row.
    fn write(&mut self, row: &Row) -> Result<(), Failure>;
    /// Completes the file; called after a failed step too.
    fn finish(&mut self) -> Result<(), Failure>;
}

/// Simulates what the arguments ask for.
///
/// # Errors
/// Wrong input, a failed step, a file that cannot be written.
pub(crate) fn run(arguments: &Arguments) -> Result<(), Failure> {
    let request = Request::of(arguments)?;
    let mut simulation = request.system.begin(&request.plan).map_err(Failure::start)?;
    let mut sink = sink(&request)?;
    let outcome = simulate(simulation.as_mut(), &request, sink.as_mut());
    sink.finish()?;
    outcome
}

/// The sink that the name of the output file asks for.
fn sink(request: &Request) -> Result<Box<dyn Sink>, Failure> {
    let Some(path) = &request.output else {
        return Ok(Box::new(csv::Csv::standard_output(request)?));
    };
    match path.extension().and_then(|extension| extension.to_str()) {
        Some("csv") => Ok(Box::new(csv::Csv::create(path, request)?)),
        Some("npy") => Ok(Box::new(npy::Npy::create(path, request)?)),
        _ => Err(Failure::Input(format!("the output `{}` must end in .csv or .npy", path.display()))),
    }
}

/// Steps to the end, writing each node.
fn simulate(simulation: &mut dyn Simulation, request: &Request, sink: &mut dyn Sink) -> Result<(), Failure> {
    let mut row = simulation.row();
    let (start, direction) = (row.t, request.plan.h.signum());
    let mut progress = Progress::new(request.length.bar());
    let mut steps = 0;
    sink.write(&row)?;
    loop {
        let (done, position) = match request.length {
            Length::Steps(wanted) => (steps >= wanted, steps),
            // A billionth of a step forgives the rounding of a sum of fixed steps.
            Length::Until(end) => {
                ((end - row.t) * direction <= 1e-9 * row.h.abs(), Length::fraction((row.t - start) / (end - start)))
            }
        };
        if done {
            return Ok(());
        }
        simulation.advance().map_err(|error| Failure::Step { error, before: describe(&row, steps) })?;
        row = simulation.row();
        steps += 1;
        sink.write(&row)?;
        progress.reach(position);
    }
}

/// A node in words.
fn describe(row: &Row, steps: u64) -> String {
    let Row { t, q, p, energy, h } = row;
    format!("t = {t}, q = {q:?}, p = {p:?}, energy = {energy}, h = {h}, after {steps} steps")
}
