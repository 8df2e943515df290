//! `vi-lab run`: simulates one system and writes its nodes as CSV, or draws them.
//!
//! In: the command line, or a scene file whose entries the command line overrides. Out: rows `t, q…, p…, H, E, h`. H is
//! the energy at the node, E the discrete energy of the interval that ends there; steps with a shift add E' before h,
//! constraints add their multipliers and the largest residual before H.
//! After a run that ends early, by a failed step or a signal, output and plot contain every row so far and the last
//! node, for any `--every`.
//!
//! | module | part of a run |
//! |---|---|
//! | [`request`], [`scene`] | the request: command line and scene, checked |
//! | [`placement`] | initial states that follow from parameters, or move onto constraints |
//! | [`shift`], [`method`] | the notation of a shift; the integrator in words |
//! | [`resolution`], [`extent`] | rejected runs: steps below rounding, outputs of gigabytes |
//! | [`ways_out`] | alternatives if an energy-preserving step does not exist |
//! | [`csv`], [`plot`] | destinations of rows |

pub(crate) mod csv;
mod extent;
pub(crate) mod method;
pub(crate) mod placement;
mod plot;
mod request;
mod resolution;
mod scene;
mod shift;
mod ways_out;

use crate::entries::named;
use clap::Args;
use extent::Extent;
use request::Output;
pub(crate) use request::{Length, Request, is_scene};
use shift::Wanted;
use std::io::{self, Write as _};
use std::path::PathBuf;
use vi_core::StepError;
use vi_core::run::ErrorEstimate;
use vi_erased::System;
use vi_erased::plan::{ENERGY_STAGES, Method, Plan, Shift, Start};
use vi_erased::simulation::{Row, Steps};
use vi_report::catalogue::Catalogue;
use vi_report::failure::{Failure, advice};
use vi_report::input::{count, number};
use vi_report::interrupt::{Interrupt, Signal};
use vi_report::numbers::{about, short};
use vi_report::progress::Progress;

/// Bytes of complete rows written at once.
const BLOCK: usize = 1 << 16;

/// Description of the two energy columns, for the output files.
const ENERGIES: &str = "H: energy at the node; E: discrete energy of the interval that ends there, empty before the first \
                        fixed or Gauss step and for compositions";
/// `C_s` for 1, 2 and 3 stages: H − E is `C_s h^2s D` to leading order, with the step density D.
const CONSTANTS: [&str; ENERGY_STAGES.len()] = ["1/8", "1/864", "1/288000"];

/// Description of the columns of constraints.
const CONSTRAINTS: &str =
    "Λ: multiplier of each constraint at the node; residual: the largest |g| and |A v + a| there; ";

/// Description of the columns of constraints and energies for a plan, and of the changes of the preserved energy.
fn energies(system: &dyn System, plan: &Plan) -> String {
    let constraints = if system.has_constraints() { CONSTRAINTS } else { "" };
    let changes = match (system.conserves_energy(), system.has_constraints()) {
        (true, false) => "is conserved",
        (true, true) => "is conserved if no constraint does work",
        (false, _) => "changes only by the work of forces and constraints, and with an explicit time",
    };
    let kept = match (plan.method, plan.shift) {
        (Method::Energy, Some(Shift::Of(shift))) => {
            let stages = plan.energy_stages().unwrap_or(1);
            let constant = CONSTANTS.get(stages - 1).copied().unwrap_or_default();
            let (order, shift) = (2 * stages, short(shift));
            format!("; E': E − C h^{order} D*, which {changes}, with C = {constant} and the shift D* = {shift}")
        }
        (Method::Energy, _) if plan.fallback => format!("; E {changes}, but for fixed steps"),
        (Method::Energy, _) => format!("; E {changes}"),
        _ => String::new(),
    };
    format!("{constraints}{ENERGIES}{kept}")
}

/// Arguments of `vi-lab run`.
#[derive(Clone, Debug, Default, Args)]
#[command(after_help = "\
Columns: t, coordinates, momenta p_…, H, E, h. H is the energy at the node, from its coordinates and momenta. E is the \
discrete energy of the interval that ends at the node, which --method energy keeps: it changes only by the work of forces and constraints, \
and with an explicit time. Its error is bounded: O(h²) with fixed steps, \
O(h^2S) with Gauss steps of S stages. With --method energy or fixed, H and E differ by h²D/8 to leading order, with the step density D. \
With --shift D* a column E' precedes h: E' = E − C h^2S D*, C = 1/8, 1/864, 1/288000 for S = 1, 2, 3. --method energy then keeps E', and E and H oscillate. E is empty \
in the first row of a run of fixed or Gauss steps, and for compositions, whose step is not one interval. The last step to --until T may be shorter; then it has no E. H is empty if the momenta have no velocity; \
standard error reports the number of such rows. h is the length of the step before the node. \
With constraints, columns Λ_… and residual follow the momenta: the multiplier of each constraint at the node, \
and the largest violation |g| or |A v + a|.

--plot draws the rows selected by --every: energies relative to the initial H; up to 24 coordinates over time and with their momenta; \
the trajectory of two coordinates in their plane. Memory is bounded: long runs keep the extremes of each stretch, and phase portraits become dots.

Energy-preserving steps: without --stages and --shift they have order 2. They exist while the step density D keeps its sign; each number of \
stages has its own D. With --shift D* they exist while D + D* keeps its sign. A D* above the largest |D| gives steps everywhere; the larger D*, \
the closer they are to fixed steps. --shift auto takes twice the largest |D| of fixed steps over the run, or over its first 10000 steps, and the \
header of the CSV contains it. --fallback takes fixed steps if there is no energy-preserving one.

Rows: the first row is the initial state. With --start midpoint or points it is the end of the first interval, \
half a step or one step later. The last node is always written.

Exit status: 0 success; 1 a step or a file failed; 2 the input is wrong; 130 and 143 the run was interrupted \
(SIGINT, SIGTERM); 141 standard output was closed, as after `| head`. After any end the written rows are complete, \
and --plot draws them; a second signal ends the command at once.")]
pub(crate) struct Arguments {
    /// Name of a system (see `vi-lab list`), a file with one, .rs or .vi, or a scene file, .toml [default: the first
    /// system of this program]
    #[arg(value_name = "SYSTEM|FILE|SCENE.toml")]
    pub(crate) target: Option<String>,
    /// One run of a scene with [sweep], by number
    #[arg(long, value_name = "K", allow_negative_numbers = true, value_parser = count)]
    pub(crate) item: Option<u64>,
    /// Integrator [default: fixed; gauss without a rule and with constraints]
    #[arg(long, value_parser = named::<Method>())]
    pub(crate) method: Option<Method>,
    /// First interval of energy-preserving steps without --stages and --shift [default: state]
    #[arg(long, value_parser = named::<Start>())]
    pub(crate) start: Option<Start>,
    /// Stages of a step of --method gauss: 4 or 8 [default: 8], with constraints 1, 2 or 3 [default: 3]; of --method energy: 1, 2 or 3
    /// (order 2, 4 or 6), 2 with constraints
    #[arg(long, value_name = "S", allow_negative_numbers = true, value_parser = count)]
    pub(crate) stages: Option<u64>,
    /// Shift of the step density of --method energy, for steps across its sign changes: a number, or auto
    #[arg(long, value_name = "D|auto", allow_hyphen_values = true, value_parser = shift::wanted)]
    pub(crate) shift: Option<Wanted>,
    /// Take fixed steps if --method energy has no step
    #[arg(long)]
    pub(crate) fallback: bool,
    /// Step of --method gauss in transformed time, for systems with a `time_scale`
    #[arg(long, value_name = "DTAU", allow_hyphen_values = true, value_parser = number, conflicts_with = "h")]
    pub(crate) dtau: Option<f64>,
    /// Step, or first step [default: that of the system; four and eight times that with --method energy --stages 2 and
    /// 3]
    #[arg(long, value_name = "H", allow_hyphen_values = true, value_parser = number)]
    pub(crate) h: Option<f64>,
    /// Finds the step: the largest error of a step over the first oscillations, relative to the motion of each coordinate
    #[arg(long, value_name = "TOL", allow_negative_numbers = true, value_parser = number, conflicts_with_all = ["h", "dtau"])]
    pub(crate) tolerance: Option<f64>,
    /// Number of steps, such as 1e6 [default: 1000]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = count)]
    pub(crate) steps: Option<u64>,
    /// End at this time exactly
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_parser = number)]
    pub(crate) until: Option<f64>,
    /// Set a parameter; repeat for several
    #[arg(long, value_name = "NAME=VALUE")]
    pub(crate) set: Vec<String>,
    /// Initial time [default: 0]
    #[arg(long, value_name = "T0", allow_hyphen_values = true, value_parser = number)]
    pub(crate) t: Option<f64>,
    /// Initial coordinates, separated by commas [default: those of the system]
    #[arg(long, value_name = "Q,…", value_delimiter = ',', allow_hyphen_values = true, value_parser = number)]
    pub(crate) q: Option<Vec<f64>>,
    /// Initial velocities, separated by commas [default: those of the system]
    #[arg(long, value_name = "V,…", value_delimiter = ',', allow_hyphen_values = true, value_parser = number)]
    pub(crate) v: Option<Vec<f64>>,
    /// Initial momenta, separated by commas, in place of the velocities
    #[arg(long, value_name = "P,…", value_delimiter = ',', allow_hyphen_values = true, value_parser = number, conflicts_with = "v")]
    pub(crate) p: Option<Vec<f64>>,
    /// Move the initial state to the nearest one on the constraints, and print by how much
    #[arg(long)]
    pub(crate) project: bool,
    /// Leave out a constraint that follows from the others, in a system of a file; every step checks it. Repeat for several
    #[arg(long, value_name = "CONSTRAINT")]
    pub(crate) drop: Vec<String>,
    /// Write every Nth node and the last [default: 1]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = count)]
    pub(crate) every: Option<u64>,
    /// CSV file, overwritten if it exists; without it and without --plot CSV goes to standard output
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Draw energies, coordinates and phase portraits of the rows into an SVG file, overwritten if it exists
    #[arg(long, value_name = "FILE.svg")]
    pub(crate) plot: Option<PathBuf>,
    /// Allow an output of more than a gigabyte
    #[arg(long)]
    pub(crate) large_output: bool,
}

/// A destination of rows.
trait Sink {
    /// Accepts a row; rows are written in blocks.
    fn write(&mut self, row: &Row) -> Result<(), Failure>;
    /// Writes the remaining rows; after a failure, as many as possible.
    fn finish(&mut self) -> Result<(), Failure>;
}

/// The system and the plan of the arguments.
///
/// # Errors
/// Wrong input.
pub(crate) fn start(arguments: &Arguments, catalogue: &Catalogue) -> Result<(Box<dyn System>, Plan), Failure> {
    let request = Request::of(arguments, catalogue)?;
    Ok((request.system, request.plan))
}

/// Checks the initial state, and that the steps reach the end and exceed rounding.
///
/// # Errors
/// [`Failure::Input`] for the first wrong input.
pub(crate) fn check(system: &dyn System, plan: &Plan, length: Length) -> Result<(), Failure> {
    request::check(system, plan, length)?;
    resolution::check_times(plan, length)
}

/// Runs the simulation of the arguments.
///
/// # Errors
/// Wrong input, a failed step, a failed file, a signal.
pub(crate) fn run(arguments: &Arguments, catalogue: &Catalogue) -> Result<(), Failure> {
    let mut request = Request::of(arguments, catalogue)?;
    resolution::check_times(&request.plan, request.length)?;
    let extent = Extent::of(&request)?;
    let begun = request.system.begin(&request.plan);
    let mut simulation = begun.map_err(|error| Failure::start(error, &request.plan))?;
    if let Some(of) = simulation.shifted_energy() {
        // The measured shift replaces `auto`.
        request.plan.shift = Some(Shift::Of(of.shift));
    }
    resolution::check_state(&request)?;
    if request.length.is_before(simulation.as_ref()) {
        return Err(Failure::Input(format!("the first node, at t = {}, is after --until", short(simulation.t()))));
    }
    let mut sinks = sinks(&request)?;
    if let Some(moved) = &request.moved {
        let _ = writeln!(io::stderr(), "{moved}");
    }
    simulation.monitor();
    let interrupt = Interrupt::install().map_err(|error| Failure::file("signals", error))?;
    let mut run_loop = RunLoop::new(&request, extent, &mut sinks);
    let outcome = run_loop.follow(simulation.as_mut(), &|| interrupt.signal());
    if let Some(note) = run_loop.note() {
        // Standard error may be closed; the rows are complete.
        let _ = writeln!(io::stderr(), "{note}");
    }
    // A motion that ends by an error is judged, too, since inaccurate steps may be the cause. Files and signals are
    // not.
    let is_of_motion = |failure: &Failure| matches!(failure, Failure::Step { .. } | Failure::Ended { .. });
    if let Some(found) = simulation.largest_error().filter(|_| outcome.as_ref().err().is_none_or(is_of_motion)) {
        let _ = writeln!(io::stderr(), "{}", accuracy(&found, &request.system.coordinates()));
    }
    // After any end, and if one output failed, each sink writes what it can.
    sinks.iter_mut().fold(outcome, |outcome, sink| match (outcome, sink.finish()) {
        (Err(first), Err(second)) => Err(Failure::Both(Box::new([first, second]))),
        (outcome, finished) => outcome.and(finished),
    })
}

/// Above this error of a step, a run is a poor approximation.
pub(crate) const POOR: f64 = 1e-3;

/// Sum of the errors of all steps, relative to the motion, above which a run may be wrong although no step is.
const LOST: f64 = 0.1;

/// A line about the largest error of a step, and their sum if it is large.
fn accuracy(found: &ErrorEstimate, coordinates: &[&str]) -> String {
    let ErrorEstimate { estimate, t, coordinate, sum } = *found;
    let at = format!("at t = {}", about(t));
    if estimate.is_infinite() {
        return format!("warning: the step {at} is too long for its error to be measured; take shorter ones with --h");
    }
    let name = coordinates.get(coordinate).copied().unwrap_or_default();
    let found = format!("the largest error of a step is {} of the motion of {name}, {at}", about(estimate));
    let advice = "take shorter steps with --h, or --tolerance 1e-9";
    if estimate >= POOR {
        format!("warning: {found}; {advice}")
    } else if sum >= LOST {
        format!("warning: {found}, and the errors of all steps may add up to {} of a motion; {advice}", about(sum))
    } else {
        format!("note: {found}")
    }
}

/// The sinks of the request.
fn sinks(request: &Request) -> Result<Vec<Box<dyn Sink>>, Failure> {
    let mut sinks: Vec<Box<dyn Sink>> = Vec::new();
    match &request.output {
        Output::Standard => sinks.push(Box::new(csv::Csv::standard_output(request))),
        Output::Csv(path) => sinks.push(Box::new(csv::Csv::create(path, request)?)),
        Output::None => {}
    }
    if let Some(path) = &request.plot {
        sinks.push(Box::new(plot::Plot::create(path, request)?));
    }
    Ok(sinks)
}

/// A run in progress.
struct RunLoop<'a> {
    request: &'a Request,
    extent: Extent,
    /// Destinations of rows.
    sinks: &'a mut [Box<dyn Sink>],
    steps: u64,
    rows: u64,
    /// Number of steps before the last written row.
    written: u64,
    /// Number of rows without H, and the first reason.
    lost: u64,
    first_lost: Option<StepError>,
}

impl<'a> RunLoop<'a> {
    /// A run at its start.
    fn new(request: &'a Request, extent: Extent, sinks: &'a mut [Box<dyn Sink>]) -> Self {
        Self { request, extent, sinks, steps: 0, rows: 0, written: 0, lost: 0, first_lost: None }
    }

    /// The note about rows without H.
    fn note(&self) -> Option<String> {
        let why = self.first_lost?;
        Some(format!("note: {} of {} rows have no H; first reason: {}", self.lost, self.rows, why.reason()))
    }

    /// Steps to the end, and writes the requested nodes and the last.
    fn follow(&mut self, simulation: &mut dyn Steps, signal: &dyn Fn() -> Option<Signal>) -> Result<(), Failure> {
        let Request { plan, length, every, .. } = self.request;
        let mut progress = Progress::new(Progress::FINENESS);
        self.write(simulation)?;
        let outcome = loop {
            if length.is_reached(simulation.t(), simulation.h(), self.steps) {
                break Ok(());
            }
            if let Err(failure) = self.advance(simulation, signal) {
                break Err(failure);
            }
            if self.steps.is_multiple_of(*every) {
                self.write(simulation)?;
            }
            progress.reach(length.part(plan, simulation.t(), self.steps));
        };
        if self.written < self.steps {
            self.write(simulation)?;
        }
        outcome
    }

    /// Takes one step; an error contains the reason of the end.
    fn advance(&mut self, simulation: &mut dyn Steps, signal: &dyn Fn() -> Option<Signal>) -> Result<(), Failure> {
        let t = simulation.t();
        if let Some(signal) = signal() {
            return Err(Failure::Interrupted { signal, reached: format!("{} steps at t = {}", self.steps, short(t)) });
        }
        self.request.length.advance(simulation).map_err(|error| {
            let node = simulation.row();
            let general = || advice(&error, &self.request.plan);
            let advice = ways_out::of(self.request, &error, &node).or_else(general);
            Failure::Step { error: Box::new(error), before: describe(&node, self.steps), advice }
        })?;
        self.steps += 1;
        let ended = |why| Failure::Ended { why, before: describe(&simulation.row(), self.steps) };
        #[allow(clippy::float_cmp)] // exactly
        if simulation.t() == t {
            let why = "the step no longer changes t in double precision; end the run earlier with --until or --steps";
            return Err(ended(why.to_owned()));
        }
        self.extent.check(self.rows).map_err(ended)
    }

    /// Writes the last node.
    fn write(&mut self, simulation: &dyn Steps) -> Result<(), Failure> {
        self.rows += 1;
        self.written = self.steps;
        let row = simulation.row();
        if row.energy.is_none() {
            self.lost += 1;
            self.first_lost = self.first_lost.or_else(|| simulation.energy().err());
        }
        self.sinks.iter_mut().try_for_each(|sink| sink.write(&row))
    }
}

/// A node as text.
fn describe(row: &Row, steps: u64) -> String {
    let Row { t, q, p, energy, discrete_energy, shifted_energy, constraints, h } = row;
    let residual = constraints.as_ref().and_then(|of| of.residual);
    let energies: String = [("residual", &residual), ("H", energy), ("E", discrete_energy), ("E'", shifted_energy)]
        .into_iter()
        .filter_map(|(name, energy)| energy.map(|energy| format!(", {name} = {}", short(energy))))
        .collect();
    format!("t = {}, q = {q:?}, p = {p:?}{energies}, h = {}, after {steps} steps", short(*t), short(*h))
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::cell::{Cell, RefCell};
    use std::borrow::Cow;
    use std::rc::Rc;

    #[test]
    fn small_errors_of_many_steps_are_a_warning() {
        let line = |estimate, sum| accuracy(&ErrorEstimate { estimate, t: 2.0, coordinate: 1, sum }, &["x", "y"]);
        assert_eq!(line(1e-5, 1e-2), "note: the largest error of a step is 0.00001 of the motion of y, at t = 2");
        let warning = line(1e-5, 0.25);
        assert!(warning.starts_with("warning: ") && warning.contains("may add up to 0.25 of a motion"), "{warning}");
        assert!(line(2e-3, 0.25).ends_with("at t = 2; take shorter steps with --h, or --tolerance 1e-9"));
    }

    /// A run that fails after three steps, at t = 1.5.
    struct Ending {
        t: f64,
        /// The result of the fourth step.
        fourth: Result<(), StepError>,
        /// The nodes from this time on have no H.
        lost: f64,
    }

    impl Steps for Ending {
        fn t(&self) -> f64 {
            self.t
        }

        fn q(&self) -> Cow<'_, [f64]> {
            core::slice::from_ref(&self.t).into()
        }

        fn h(&self) -> f64 {
            0.5
        }

        fn p(&self) -> &[f64] {
            &[0.0]
        }

        fn energy(&self) -> Result<f64, StepError> {
            let singular = StepError::Singular { t: self.t, matrix: "mass matrix" };
            if self.t < self.lost { Ok(1.0) } else { Err(singular) }
        }

        fn discrete_energy(&self) -> Option<f64> {
            None
        }

        fn advance(&mut self) -> Result<(), StepError> {
            if self.t < 1.5 {
                self.t += 0.5;
                return Ok(());
            }
            self.fourth
        }

        fn advance_to(&mut self, _: f64) -> Result<(), StepError> {
            self.advance()
        }
    }

    /// Stores the rows.
    #[derive(Clone, Default)]
    struct StoredRows(Rc<RefCell<Vec<Row>>>);

    impl Sink for StoredRows {
        fn write(&mut self, row: &Row) -> Result<(), Failure> {
            self.0.borrow_mut().push(row.clone());
            Ok(())
        }

        fn finish(&mut self) -> Result<(), Failure> {
            Ok(())
        }
    }

    /// The failure of the run, and the times of its rows.
    fn followed(every: u64, fourth: Result<(), StepError>, signal: &dyn Fn() -> Option<Signal>) -> (Failure, Vec<f64>) {
        let target = Some("double-well".to_owned());
        let arguments = Arguments { target, steps: Some(9), every: Some(every), ..Arguments::default() };
        let request = Request::of(&arguments, &crate::ready()).unwrap_or_else(|failure| panic!("{failure}"));
        let extent = Extent::of(&request).unwrap_or_else(|failure| panic!("{failure}"));
        let kept = StoredRows::default();
        let mut sinks: [Box<dyn Sink>; 1] = [Box::new(kept.clone())];
        let mut run_loop = RunLoop::new(&request, extent, &mut sinks);
        let failure = run_loop
            .follow(&mut Ending { t: 0.0, fourth, lost: f64::INFINITY }, signal)
            .expect_err("the run ends early");
        (failure, kept.0.borrow().iter().map(|row| row.t).collect())
    }

    #[test]
    fn a_singular_matrix_on_the_way_leaves_the_rows_so_far_and_status_1() {
        let singular = StepError::Singular { t: 1.5, matrix: "mass matrix" };
        for (every, times) in [(1, vec![0.0, 0.5, 1.0, 1.5]), (2, vec![0.0, 1.0, 1.5]), (3, vec![0.0, 1.5])] {
            let (failure, written) = followed(every, Err(singular), &|| None);
            assert_eq!((failure.exit_status(), written), (1, times), "every {every}");
            assert_eq!(
                failure.to_string(),
                "the mass matrix is singular at t = 1.500000000\n\
                 last good state: t = 1.5, q = [1.5], p = [0.0], H = 1, h = 0.5, after 3 steps"
            );
        }
    }

    #[test]
    fn rows_without_an_energy_are_told() {
        let arguments = Arguments { target: Some("double-well".to_owned()), steps: Some(3), ..Arguments::default() };
        let request = Request::of(&arguments, &crate::ready()).unwrap_or_else(|failure| panic!("{failure}"));
        let extent = Extent::of(&request).unwrap_or_else(|failure| panic!("{failure}"));
        let note = |lost| {
            let mut run_loop = RunLoop::new(&request, extent, &mut []);
            run_loop.follow(&mut Ending { t: 0.0, fourth: Ok(()), lost }, &|| None).expect("three steps");
            run_loop.note()
        };
        assert_eq!(note(2.0), None);
        let expected = "note: 2 of 4 rows have no H; first reason: the mass matrix is singular at t = 1.000000000";
        assert_eq!(note(1.0).as_deref(), Some(expected));
    }

    #[test]
    fn a_step_that_does_not_change_the_time_ends_the_run() {
        let (failure, written) = followed(1, Ok(()), &|| None);
        assert_eq!((failure.exit_status(), written), (1, vec![0.0, 0.5, 1.0, 1.5, 1.5]));
        let message = failure.to_string();
        assert!(message.starts_with("the step no longer changes t in double precision; "), "{message}");
        assert!(message.ends_with("t = 1.5, q = [1.5], p = [0.0], H = 1, h = 0.5, after 4 steps"), "{message}");
    }

    #[test]
    fn a_signal_ends_a_run_after_the_node_reached_last() {
        for (signal, status) in vi_report::interrupt::SIGNALS.into_iter().zip([130, 143]) {
            let looks = Cell::new(0);
            let third_look = || {
                looks.set(looks.get() + 1);
                (looks.get() > 2).then_some(signal)
            };
            let (failure, written) = followed(5, Ok(()), &third_look);
            assert_eq!((failure.exit_status(), written), (status, vec![0.0, 1.0]));
            let expected = format!(
                "interrupted by {} after 2 steps at t = 1; the output up to this point is complete",
                signal.name
            );
            assert_eq!(failure.to_string(), expected);
        }
    }
}
