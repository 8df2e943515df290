//! `vi-lab run`: one system simulated, its nodes written as CSV or NPY, or drawn.
//!
//! In: the command line, or a scene file whose entries the command line overrides. Out: rows `t, q…, p…, H, E, h`, where
//! H is the energy at the node and E the discrete energy of the interval that ends there; before h, E' of steps with a shift. AFTER A RUN THAT ENDS
//! EARLY, by a step that fails or a signal, the output and the plot hold every row up to there, and the last node whatever `--every` says.
//!
//! | module | part of a run |
//! |---|---|
//! | [`request`], [`scene`] | what is to be done: command line and scene, checked |
//! | [`shift`] | how a shift is written |
//! | [`resolution`], [`extent`] | what is refused: steps that rounding swallows, outputs of gigabytes |
//! | [`ways_out`] | what to do where an energy-preserving step does not exist |
//! | [`csv`], [`npy`], [`plot`] | where rows go |

mod csv;
mod extent;
pub(crate) mod method;
mod npy;
mod plot;
mod request;
mod resolution;
mod scene;
mod shift;
mod ways_out;

use clap::Args;
use core::cell::Cell;
use extent::Extent;
use request::Output;
pub(crate) use request::{Length, Request};
use shift::Wanted;
use std::io::{self, Write as _};
use std::path::PathBuf;
use vi_core::StepError;
use vi_core::run::ErrorEstimate;
use vi_report::catalogue::Catalogue;
use vi_report::failure::{Failure, advice};
use vi_report::input::{count, number};
use vi_report::interrupt::{Interrupt, Signal};
use vi_report::numbers::{about, short};
use vi_report::progress::Progress;
use vi_runs::plan::{ENERGY_STAGES, Method, Plan, Shift, Start};
use vi_runs::simulation::{Row, Simulation};
use vi_runs::system::System;

/// Bytes of whole rows that are written at once.
const BLOCK: usize = 1 << 16;

/// What the two columns of energies are, for the files that hold them.
const ENERGIES: &str = "H: energy at the node; E: discrete energy of the interval that ends there, none before the first \
                        step of a given length and none of a composition";
/// `C_s` of 1, 2 and 3 stages: H − E is `C_s h^2s D` to leading order, D the step density.
const CONSTANTS: [&str; ENERGY_STAGES.len()] = ["1/8", "1/864", "1/288000"];

/// What the columns of energies are in the rows of a plan, and which of them is kept.
fn energies(plan: &Plan) -> String {
    let kept = match (plan.method, plan.shift) {
        (Method::Energy, Some(Shift::Of(shift))) => {
            let stages = plan.energy_stages().unwrap_or(1);
            let constant = CONSTANTS.get(stages - 1).copied().unwrap_or_default();
            let (order, shift) = (2 * stages, short(shift));
            format!("; E': E − C h^{order} D*, which is kept, with C = {constant} and the shift D* = {shift}")
        }
        (Method::Energy, _) if plan.fallback => "; E is kept, but by fixed steps".to_owned(),
        (Method::Energy, _) => "; E is kept".to_owned(),
        _ => String::new(),
    };
    format!("{ENERGIES}{kept}")
}

/// Arguments of `vi-lab run`.
#[derive(Clone, Debug, Default, Args)]
#[command(after_help = "\
Columns: t, coordinates, momenta p_…, H, E, h. H is the energy at the node, of its coordinates and momenta. E is the \
discrete energy of the interval that ends at the node, which --method energy preserves; with fixed steps it swings by a \
term of order h², with Gauss steps of S stages by one of order h^2S. H and E of the first two differ by h²D/8 to leading order, D the step density. \
With --shift D* a column E' comes before h: E − C h^2S D*, C = 1/8, 1/864, 1/288000 for S = 1, 2, 3, which is kept then, while E and H swing. A run of fixed or Gauss steps has no interval \
before its first row, and the whole step of a composition is none: E is empty there (NaN in .npy). The last step to --until T is as long as is left, and has no E if that is shorter. H is empty if no velocity belongs to the momenta; \
standard error says in how many rows. h is the length of the step that led to the node.

--plot draws the rows that --every leaves: energies less H at the start, every coordinate over time and with its momentum, up to 24 of them, and \
the path of two in their plane. A long run takes no more memory than a short one: stretches of it keep their extremes, a phase portrait becomes dots.

Energy-preserving steps: without --stages and --shift they are of order 2. They exist where the step density D, another \
one for each number of stages, keeps its sign; with --shift D*, where D + D* does: D* above the largest |D| makes steps everywhere, the larger the \
nearer to fixed ones. --shift auto takes twice the largest |D| that fixed steps meet over the time of the run, or over its first 10000 steps, and the \
head of the CSV names it. --fallback takes fixed steps where there is no other.

Rows: the first row is the node from which the integrator starts. With --method energy and --start midpoint the initial \
state is the middle of the first interval, and that node lies half a step later. With --stages or --shift the first row is the initial state. The node reached last is always written.

Exit status: 0 all is written; 1 a step or a file failed; 2 the input is wrong; 130 and 143 the run was interrupted \
(SIGINT, SIGTERM); 141 nobody reads standard output any more, as after `| head`. Whatever ends a run, the rows up to there \
are whole, and drawn by --plot; only a second signal ends the command at once.")]
pub(crate) struct Arguments {
    /// Name of a system (see `vi-lab list`), or a scene file whose name ends in .toml [default: the first system of this program's own]
    #[arg(value_name = "SYSTEM|SCENE.toml")]
    pub(crate) target: Option<String>,
    /// One run of a scene with [sweep], by its number
    #[arg(long, value_name = "K", allow_negative_numbers = true, value_parser = count)]
    pub(crate) item: Option<u64>,
    /// Integrator [default: fixed]
    #[arg(long)]
    pub(crate) method: Option<Method>,
    /// First interval of energy-preserving steps without --stages and --shift [default: midpoint]
    #[arg(long)]
    pub(crate) start: Option<Start>,
    /// Stages of a step of --method gauss: 4 or 8 [default: 8]; of --method energy: 1, 2 or 3, of order 2, 4 or 6
    #[arg(long, value_name = "S", allow_negative_numbers = true, value_parser = count)]
    pub(crate) stages: Option<u64>,
    /// Shift of the step density of --method energy, with which steps exist where its sign changes: a number, or auto
    #[arg(long, value_name = "D|auto", allow_hyphen_values = true, value_parser = shift::wanted)]
    pub(crate) shift: Option<Wanted>,
    /// Takes fixed steps where --method energy has no others
    #[arg(long)]
    pub(crate) fallback: bool,
    /// Step of --method gauss in transformed time, for systems with a `time_scale`
    #[arg(long, value_name = "DTAU", allow_hyphen_values = true, value_parser = number, conflicts_with = "h")]
    pub(crate) dtau: Option<f64>,
    /// Step, or first step [default: the system's; four and eight times that with --method energy --stages 2 and 3]
    #[arg(long, value_name = "H", allow_hyphen_values = true, value_parser = number)]
    pub(crate) h: Option<f64>,
    /// Finds the step: the largest error of a step over the first oscillations, relative to the excursion of each coordinate
    #[arg(long, value_name = "TOL", allow_negative_numbers = true, value_parser = number, conflicts_with_all = ["h", "dtau"])]
    pub(crate) tolerance: Option<f64>,
    /// Number of steps, such as 1e6 [default: 1000]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = count)]
    pub(crate) steps: Option<u64>,
    /// Ends at this time exactly
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_parser = number)]
    pub(crate) until: Option<f64>,
    /// Sets a parameter; may be given once for each
    #[arg(long, value_name = "NAME=VALUE")]
    pub(crate) set: Vec<String>,
    /// Initial time [default: 0]
    #[arg(long, value_name = "T0", allow_hyphen_values = true, value_parser = number)]
    pub(crate) t: Option<f64>,
    /// Initial coordinates, separated by commas [default: the system's]
    #[arg(long, value_name = "Q,…", value_delimiter = ',', allow_hyphen_values = true, value_parser = number)]
    pub(crate) q: Option<Vec<f64>>,
    /// Initial velocities, separated by commas [default: the system's]
    #[arg(long, value_name = "V,…", value_delimiter = ',', allow_hyphen_values = true, value_parser = number)]
    pub(crate) v: Option<Vec<f64>>,
    /// Writes every Nth node, and the last [default: 1]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = count)]
    pub(crate) every: Option<u64>,
    /// File to write, .csv or .npy, an existing one anew; without it and without --plot CSV goes to standard output
    #[arg(short, long, value_name = "FILE")]
    pub(crate) output: Option<PathBuf>,
    /// Draws energies, coordinates and phase portraits of the rows into an SVG file, an existing one anew
    #[arg(long, value_name = "FILE.svg")]
    pub(crate) plot: Option<PathBuf>,
    /// Allows an output of more than a gigabyte
    #[arg(long)]
    pub(crate) large_output: bool,
}

/// Where rows go.
trait Sink {
    /// Takes a row; rows are written in blocks.
    fn write(&mut self, row: &Row) -> Result<(), Failure>;
    /// Writes what has been taken; after a failure, what can still be written.
    fn finish(&mut self) -> Result<(), Failure>;
}

/// The system and the start that the arguments ask for.
///
/// # Errors
/// Wrong input.
pub(crate) fn start(arguments: &Arguments, catalogue: &Catalogue) -> Result<(Box<dyn System>, Plan), Failure> {
    let request = Request::of(arguments, catalogue)?;
    Ok((request.system, request.plan))
}

/// Whether a run can be: its initial state, and steps that lead to its end and are not lost in rounding.
///
/// # Errors
/// [`Failure::Input`] for the first input that is wrong.
pub(crate) fn check(system: &dyn System, plan: &Plan, length: Length) -> Result<(), Failure> {
    request::check(system, plan, length)?;
    resolution::check_times(plan, length)
}

/// Simulates what the arguments ask for.
///
/// # Errors
/// Wrong input, a failed step, a file that cannot be written, a signal.
pub(crate) fn run(arguments: &Arguments, catalogue: &Catalogue) -> Result<(), Failure> {
    let mut request = Request::of(arguments, catalogue)?;
    resolution::check_times(&request.plan, request.length)?;
    let extent = Extent::of(&request)?;
    let evaluations = Cell::new(0);
    let begun = request.system.begin(&request.plan, &evaluations);
    let mut simulation = begun.map_err(|error| Failure::start(error, &request.plan))?;
    if let Some(of) = simulation.shifted_energy() {
        // A shift that was measured is from here on one that is given.
        request.plan.shift = Some(Shift::Of(of.shift));
    }
    resolution::check_state(&request)?;
    if request.length.is_before(simulation.as_ref()) {
        return Err(Failure::Input(format!("the first node, at t = {}, lies beyond --until", short(simulation.t()))));
    }
    let mut sinks = sinks(&request)?;
    simulation.monitor();
    let interrupt = Interrupt::heed().map_err(|error| Failure::file("signals", error))?;
    let mut course = Course::new(&request, extent, &mut sinks);
    let outcome = course.follow(simulation.as_mut(), &|| interrupt.signal());
    if let Some(note) = course.note() {
        // Standard error may be closed; the rows are whole.
        let _ = writeln!(io::stderr(), "{note}");
    }
    if let Some(found) = simulation.largest_error().filter(|_| outcome.is_ok()) {
        let _ = writeln!(io::stderr(), "{}", accuracy(&found, &request.system.coordinates()));
    }
    // Whatever ended the run, and where one of the outputs failed too, each gets what can still be written.
    sinks.iter_mut().fold(outcome, |outcome, sink| match (outcome, sink.finish()) {
        (Err(first), Err(second)) => Err(Failure::both(first, second)),
        (outcome, finished) => outcome.and(finished),
    })
}

/// The error of a step from which on a run is hardly an approximation.
pub(crate) const POOR: f64 = 1e-3;

/// What the largest error of a step says of a run.
fn accuracy(found: &ErrorEstimate, coordinates: &[&str]) -> String {
    let ErrorEstimate { estimate, t, coordinate } = *found;
    let at = format!("at t = {}", about(t));
    if estimate.is_infinite() {
        return format!("warning: the step {at} is too long for its error to be measured; take shorter ones with --h");
    }
    let name = coordinates.get(coordinate).copied().unwrap_or_default();
    let found = format!("the largest error of a step is {} of the excursion of {name}, {at}", about(estimate));
    if estimate < POOR {
        format!("note: {found}")
    } else {
        format!("warning: {found}; take shorter steps with --h, or --tolerance 1e-9")
    }
}

/// The sinks that the request names.
fn sinks(request: &Request) -> Result<Vec<Box<dyn Sink>>, Failure> {
    let mut sinks: Vec<Box<dyn Sink>> = Vec::new();
    match &request.output {
        Output::Standard => sinks.push(Box::new(csv::Csv::standard_output(request))),
        Output::Csv(path) => sinks.push(Box::new(csv::Csv::create(path, request)?)),
        Output::Npy(path) => sinks.push(Box::new(npy::Npy::create(path, request)?)),
        Output::None => {}
    }
    if let Some(path) = &request.plot {
        sinks.push(Box::new(plot::Plot::create(path, request)?));
    }
    Ok(sinks)
}

/// A run under way: what was asked for, and how far it came.
struct Course<'a> {
    request: &'a Request,
    extent: Extent,
    /// Where rows go.
    sinks: &'a mut [Box<dyn Sink>],
    steps: u64,
    rows: u64,
    /// The number of steps that led to the row written last.
    written: u64,
    /// Rows without H, and why the first of them has none.
    lost: u64,
    first_lost: Option<StepError>,
}

impl<'a> Course<'a> {
    /// A run at its start.
    fn new(request: &'a Request, extent: Extent, sinks: &'a mut [Box<dyn Sink>]) -> Self {
        Self { request, extent, sinks, steps: 0, rows: 0, written: 0, lost: 0, first_lost: None }
    }

    /// What to say of rows without H.
    fn note(&self) -> Option<String> {
        let why = self.first_lost?;
        Some(format!("note: {} of {} rows have no H, the first because {}", self.lost, self.rows, why.reason()))
    }

    /// Steps to the end, and writes the nodes that are asked for, and the last.
    fn follow(&mut self, simulation: &mut dyn Simulation, signal: &dyn Fn() -> Option<Signal>) -> Result<(), Failure> {
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

    /// Takes one step; an error says why the run ends here.
    fn advance(&mut self, simulation: &mut dyn Simulation, signal: &dyn Fn() -> Option<Signal>) -> Result<(), Failure> {
        let t = simulation.t();
        if let Some(signal) = signal() {
            return Err(Failure::Interrupted { signal, reached: format!("{} steps at t = {}", self.steps, short(t)) });
        }
        self.request.length.advance(simulation).map_err(|error| {
            let node = simulation.row();
            let general = || advice(&error, &self.request.plan).map(str::to_owned);
            let advice = ways_out::of(self.request, &error, &node).or_else(general);
            Failure::Step { error: Box::new(error), before: describe(&node, self.steps), advice }
        })?;
        self.steps += 1;
        let ended = |why| Failure::Ended { why, before: describe(&simulation.row(), self.steps) };
        #[allow(clippy::float_cmp)] // exactly
        if simulation.t() == t {
            let why =
                "the step does not change t in double precision any more; end the run before, with --until or --steps";
            return Err(ended(why.to_owned()));
        }
        self.extent.check(self.rows).map_err(ended)
    }

    /// Writes the node reached last.
    fn write(&mut self, simulation: &dyn Simulation) -> Result<(), Failure> {
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

/// A node in words.
fn describe(row: &Row, steps: u64) -> String {
    let Row { t, q, p, energy, discrete_energy, shifted_energy, h } = row;
    let energies: String = [("H", energy), ("E", discrete_energy), ("E'", shifted_energy)]
        .into_iter()
        .filter_map(|(name, energy)| energy.map(|energy| format!(", {name} = {}", short(energy))))
        .collect();
    format!("t = {}, q = {q:?}, p = {p:?}{energies}, h = {}, after {steps} steps", short(*t), short(*h))
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::cell::RefCell;
    use std::rc::Rc;
    use vi_runs::simulation::Section;

    /// A run that cannot go on after three steps, at t = 1.5.
    struct Ending {
        t: f64,
        /// What the fourth step does.
        fourth: Result<(), StepError>,
        /// The nodes from this time on have no H.
        lost: f64,
    }

    impl Simulation for Ending {
        fn t(&self) -> f64 {
            self.t
        }

        fn q(&self) -> &[f64] {
            core::slice::from_ref(&self.t)
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

        fn cross(&mut self, _: &Section, _: f64, _: &mut dyn FnMut(Row)) -> Result<(), StepError> {
            Ok(())
        }
    }

    /// Keeps the rows.
    #[derive(Clone, Default)]
    struct Kept(Rc<RefCell<Vec<Row>>>);

    impl Sink for Kept {
        fn write(&mut self, row: &Row) -> Result<(), Failure> {
            self.0.borrow_mut().push(row.clone());
            Ok(())
        }

        fn finish(&mut self) -> Result<(), Failure> {
            Ok(())
        }
    }

    /// Why the run ends, and the times of its rows.
    fn followed(every: u64, fourth: Result<(), StepError>, signal: &dyn Fn() -> Option<Signal>) -> (Failure, Vec<f64>) {
        let target = Some("double-well".to_owned());
        let arguments = Arguments { target, steps: Some(9), every: Some(every), ..Arguments::default() };
        let request = Request::of(&arguments, &crate::ready()).unwrap_or_else(|failure| panic!("{failure}"));
        let extent = Extent::of(&request).unwrap_or_else(|failure| panic!("{failure}"));
        let kept = Kept::default();
        let mut sinks: [Box<dyn Sink>; 1] = [Box::new(kept.clone())];
        let mut course = Course::new(&request, extent, &mut sinks);
        let failure =
            course.follow(&mut Ending { t: 0.0, fourth, lost: f64::INFINITY }, signal).expect_err("the run ends early");
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
            let mut course = Course::new(&request, extent, &mut []);
            course.follow(&mut Ending { t: 0.0, fourth: Ok(()), lost }, &|| None).expect("three steps");
            course.note()
        };
        assert_eq!(note(2.0), None);
        let told = "note: 2 of 4 rows have no H, the first because the mass matrix is singular at t = 1.000000000";
        assert_eq!(note(1.0).as_deref(), Some(told));
    }

    #[test]
    fn a_step_that_does_not_change_the_time_ends_the_run() {
        let (failure, written) = followed(1, Ok(()), &|| None);
        assert_eq!((failure.exit_status(), written), (1, vec![0.0, 0.5, 1.0, 1.5, 1.5]));
        let message = failure.to_string();
        assert!(message.starts_with("the step does not change t in double precision any more; "), "{message}");
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
            let expected =
                format!("interrupted by {} after 2 steps at t = 1; the output up to there is whole", signal.name);
            assert_eq!(failure.to_string(), expected);
        }
    }
}
