//! The request: command line, then scene, then defaults of the system, with every input checked.

use super::Arguments;
use super::placement::Placement;
use super::scene::Scene;
use super::shift::Wanted;
use crate::place;
use crate::sweep::items::Items;
use crate::sweep::scene::Sweep;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use vi_core::StepError;
use vi_erased::System;
use vi_erased::check;
use vi_erased::plan::{Method, PhasePoint, Plan, Start};
use vi_erased::simulation::{Row, Steps};
use vi_erased::system::Quantity;
use vi_report::catalogue::{Catalogue, kebab};
use vi_report::failure::Failure;
use vi_report::input::number;
use vi_report::numbers::{about, short};

/// Default number of steps.
const DEFAULT_STEPS: u64 = 1000;
/// Maximum number of steps over which a shift is measured.
const MEASURED_STEPS: f64 = 1e4;

/// A checked run.
pub(crate) struct Request {
    /// The system with its parameters.
    pub(crate) system: Box<dyn System>,
    /// The text of a system that is not compiled, with the texts of its files.
    pub(crate) text: Option<String>,
    /// Integrator, step and initial state.
    pub(crate) plan: Plan,
    /// The end of the run.
    pub(crate) length: Length,
    /// Interval between written nodes.
    pub(crate) every: u64,
    /// The destination.
    pub(super) output: Output,
    /// The plot, an SVG file.
    pub(super) plot: Option<PathBuf>,
    /// Whether the output may exceed a gigabyte.
    pub(super) large_output: bool,
    /// The rule for the initial state beside the numbers of the plan.
    pub(crate) placement: Placement,
    /// The distance that the initial state moved onto the constraints, in words.
    pub(super) moved: Option<String>,
}

/// The end of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Length {
    /// After this many steps.
    Steps(u64),
    /// At this time.
    Until(f64),
}

impl Length {
    /// Whether a run is at its end.
    pub(crate) fn is_reached(self, t: f64, h: f64, steps: u64) -> bool {
        match self {
            Self::Steps(wanted) => steps >= wanted,
            Self::Until(end) => (end - t) * h.signum() <= 0.0,
        }
    }

    /// Takes one step of a run toward its end.
    ///
    /// # Errors
    /// The error of the integrator.
    pub(crate) fn advance(self, run: &mut dyn Steps) -> Result<(), StepError> {
        match self {
            Self::Steps(_) => run.advance(),
            Self::Until(end) => run.advance_to(end),
        }
    }

    /// Whether the end precedes the first node: with --start midpoint and points that node is later than the initial state.
    pub(crate) fn is_before(self, run: &dyn Steps) -> bool {
        matches!(self, Self::Until(end) if (end - run.t()) * run.h() < 0.0)
    }

    /// The completed part of a run, between 0 and 1.
    #[allow(clippy::cast_precision_loss)] // an estimate
    pub(crate) fn part(self, plan: &Plan, t: f64, steps: u64) -> f64 {
        match self {
            Self::Steps(wanted) => steps as f64 / wanted as f64,
            Self::Until(end) => ((t - plan.t) / (end - plan.t)).clamp(0.0, 1.0),
        }
    }

    /// Number of steps, if all had the length of the first.
    #[allow(clippy::cast_precision_loss)] // an estimate
    pub(crate) fn steps(self, plan: &Plan) -> f64 {
        match self {
            Self::Steps(wanted) => wanted as f64,
            Self::Until(end) => ((end - plan.t) / plan.h).ceil(),
        }
    }

    /// The time over which a shift is measured: the whole run, or its first steps.
    pub(super) fn measured(self, plan: &Plan) -> f64 {
        self.steps(plan).clamp(1.0, MEASURED_STEPS) * plan.h
    }

    /// The time of the end, if all steps had the length of the first.
    pub(crate) fn end(self, plan: &Plan) -> f64 {
        match self {
            Self::Steps(_) => plan.t + self.steps(plan) * plan.h,
            Self::Until(end) => end,
        }
    }
}

/// The destination of rows.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Output {
    /// CSV on standard output.
    Standard,
    /// A CSV file.
    Csv(PathBuf),
    /// Only a plot.
    None,
}

impl Output {
    /// Bytes of a number in a row: measured for CSV, whose numbers vary in length.
    pub(super) fn bytes_per_number(&self) -> f64 {
        match self {
            Self::Standard | Self::Csv(_) => 19.0,
            Self::None => 0.0,
        }
    }
}

/// Checks the file of --plot.
fn check_plot(path: &Path) -> Result<(), Failure> {
    if path.extension().is_none_or(|extension| !extension.eq_ignore_ascii_case("svg")) {
        return Err(Failure::Input(format!("the plot `{}` must end in .svg", path.display())));
    }
    place::check("plot", path)
}

/// Whether a target is a scene file.
pub(crate) fn is_scene(target: &str) -> bool {
    Path::new(target).extension().is_some_and(|extension| extension.eq_ignore_ascii_case("toml"))
}

impl Request {
    /// The run of the arguments.
    ///
    /// # Errors
    /// [`Failure::Input`] for the first wrong input.
    pub(crate) fn of(arguments: &Arguments, catalogue: &Catalogue) -> Result<Self, Failure> {
        match (Self::read(arguments, catalogue)?, arguments.item) {
            ((request, None), None) | ((request, Some(_)), Some(_)) => Ok(request),
            ((_, None), Some(_)) => Err(Failure::Input("only a scene with [sweep] has an --item".to_owned())),
            ((_, Some(_)), None) => Err(Failure::Input(
                "the scene has a [sweep]: use `vi-lab sweep` for all runs, or --item K for one".to_owned(),
            )),
        }
    }

    /// The common request of the runs of a sweep, and the sweep.
    ///
    /// # Errors
    /// [`Failure::Input`] for the first wrong input, or if the scene has no sweep.
    pub(crate) fn with_sweep(scene: &str, catalogue: &Catalogue) -> Result<(Self, Sweep), Failure> {
        let arguments = Arguments { target: Some(scene.to_owned()), ..Arguments::default() };
        let (request, sweep) = Self::read(&arguments, catalogue)?;
        let none = || {
            Failure::Input(format!("{scene} is not a scene file with a table [sweep]; docs/cluster.md has an example"))
        };
        Ok((request, sweep.ok_or_else(none)?))
    }

    /// The run of the arguments, and the sweep of the scene.
    fn read(arguments: &Arguments, catalogue: &Catalogue) -> Result<(Self, Option<Sweep>), Failure> {
        let target = match &arguments.target {
            Some(target) => target.clone(),
            None => catalogue.named(None)?.name.to_owned(),
        };
        let scene = if is_scene(&target) { Scene::read(&target)? } else { Scene::of_system(&target) };
        let entry = catalogue.find(&scene.system)?;
        let mut system = entry.system.copy();
        for (name, value) in &scene.parameters {
            set(system.as_mut(), name, *value)?;
        }
        if !arguments.drop.is_empty() {
            system = without(system.as_ref(), &arguments.drop)?;
        }
        let mut names = BTreeSet::new();
        for assignment in &arguments.set {
            let (name, value) = parse_assignment(assignment)?;
            if !names.insert(name) {
                return Err(Failure::Input(format!(
                    "the parameter `{name}` is set twice; use --set once per parameter"
                )));
            }
            set(system.as_mut(), name, value)?;
        }
        let q = arguments.q.clone().or(scene.q.clone());
        let is_given = arguments.v.is_some() || arguments.p.is_some();
        let given = if is_given { [&arguments.v, &arguments.p] } else { [&scene.v, &scene.p] };
        let [v, p] = given.map(Clone::clone);
        let is_default = q.is_none() && v.is_none() && p.is_none();
        let projects = arguments.project || scene.project.unwrap_or(false);
        let placement = Placement::of(system.as_ref(), entry.start.filter(|_| is_default), projects)?;
        let t = arguments.t.or(scene.t).unwrap_or(0.0);
        let start = PhasePoint { t, q: q.unwrap_or(entry.q), v: v.unwrap_or(entry.v) };
        let method = arguments.method.or(scene.method).unwrap_or(system.usual_method());
        let options = Options::of(arguments, &scene);
        let asked = Plan {
            start: options.start.unwrap_or_default(),
            stages: options.stages,
            shift: options.shift.map(|wanted| wanted.over(entry.h)),
            fallback: options.fallback,
            dtau: options.dtau,
            ..Plan::new(method, entry.h, start)
        };
        let mut plan = check::integrator(system.as_ref(), asked)?;
        // Short energy-preserving steps with constraints keep their length.
        let usual = if system.has_constraints() { entry.h } else { entry.h * usual_length(method, plan.stages) };
        plan.h = arguments.h.or(scene.h).unwrap_or(usual);
        placement.follow(system.as_ref(), &mut plan);
        if let (Some(sweep), Some(item)) = (&scene.sweep, arguments.item) {
            set_item((sweep, item), placement, system.as_mut(), &mut plan)?;
        }
        placement.check(system.as_ref(), &plan)?;
        plan.p = p;
        check::numbers(system.as_ref(), &plan)?;
        if let Some(p) = plan.p.take() {
            plan.v = velocities(system.as_ref(), &plan, &p)?;
        }
        let given = plan.clone();
        let moved = placement.project(system.as_ref(), &mut plan).map_err(|error| Failure::start(error, &given))?;
        if let Some(dtau) = plan.dtau {
            scale_time(system.as_ref(), &mut plan, dtau);
        }
        if let Some(tolerance) = arguments.tolerance {
            plan.h = found_step(system.as_ref(), &plan, tolerance)?;
        }
        let length = match (arguments.steps, arguments.until) {
            (None, None) => length(scene.steps, scene.until, &plan)?,
            (steps, until) => length(steps, until, &plan)?,
        };
        plan.shift = options.shift.map(|wanted| wanted.over(length.measured(&plan)));
        let every = arguments.every.or(scene.every).unwrap_or(1);
        if every == 0 {
            return Err(Failure::Input("--every must be at least 1: 1 writes every node, 10 every tenth".to_owned()));
        }
        let output = match &arguments.output {
            Some(path) => {
                place::check_csv(path)?;
                Output::Csv(path.clone())
            }
            None if arguments.plot.is_some() => Output::None,
            None => Output::Standard,
        };
        let plot = arguments.plot.clone();
        plot.as_deref().map_or(Ok(()), check_plot)?;
        let large_output = arguments.large_output;
        let moved = moved.map(|[q, v]| {
            format!("note: the initial coordinates moved by up to {}, the velocities by up to {}", about(q), about(v))
        });
        Ok((
            Self { system, text: entry.text, plan, length, every, output, plot, large_output, placement, moved },
            scene.sweep,
        ))
    }

    /// Names of the columns of a row.
    pub(crate) fn columns(&self) -> Vec<String> {
        Row::columns(&self.system.coordinates(), self.system.constraints(), self.plan.shift.is_some())
    }
}

/// Options that apply to some methods only.
#[derive(Clone, Copy, Debug)]
struct Options {
    start: Option<Start>,
    stages: Option<usize>,
    shift: Option<Wanted>,
    fallback: bool,
    dtau: Option<f64>,
}

impl Options {
    /// The options of the command line, then those of the scene; a scene for another method is not a mistake.
    fn of(arguments: &Arguments, scene: &Scene) -> Self {
        let other = Scene::default();
        let scene = if arguments.method.is_none() { scene } else { &other };
        // A step in time on the command line replaces one in transformed time.
        let dtau = scene.dtau.filter(|_| arguments.h.is_none());
        Self {
            start: arguments.start.or(scene.start),
            // A number that does not fit is larger than any number of stages.
            stages: arguments.stages.or(scene.stages).map(|stages| usize::try_from(stages).unwrap_or(usize::MAX)),
            shift: arguments.shift.or(scene.shift),
            fallback: arguments.fallback || scene.fallback.unwrap_or(false),
            dtau: arguments.dtau.or(dtau).filter(|_| arguments.tolerance.is_none()),
        }
    }
}

/// Ratio of the default step to that of the system. For short energy-preserving steps of order 4 and 6, rounding hides
/// the length.
fn usual_length(method: Method, stages: Option<usize>) -> f64 {
    match (method, stages) {
        (Method::Energy, Some(2)) => 4.0,
        (Method::Energy, Some(3)) => 8.0,
        _ => 1.0,
    }
}

/// Sets equal steps in transformed time; g determines the first step in time.
fn scale_time(system: &dyn System, plan: &mut Plan, dtau: f64) {
    let Plan { t, q, v, .. } = plan.clone();
    // A run reports an invalid g.
    plan.h = match system.time_scale(&PhasePoint { t, q, v }) {
        Some(g) if g > 0.0 && g.is_finite() => g * dtau,
        _ => dtau,
    };
}

/// The step whose error is the tolerance.
fn found_step(system: &dyn System, plan: &Plan, tolerance: f64) -> Result<f64, Failure> {
    let plan = Plan { tolerance: Some(tolerance), ..plan.clone() };
    let begun = system.begin(&plan).map_err(|error| Failure::start(error, &plan))?;
    Ok(begun.h())
}

/// The system of a file without these constraints.
fn without(system: &dyn System, constraints: &[String]) -> Result<Box<dyn System>, Failure> {
    let known = system.constraints();
    if let Some(name) = constraints.iter().find(|name| !known.contains(&name.as_str())) {
        let (of, known) = (kebab(system.name()), known.join(", "));
        let known = if known.is_empty() { "none" } else { &known };
        return Err(Failure::Input(format!("{of} has no constraint `{name}` to --drop; it has {known}")));
    }
    let names: Vec<&str> = constraints.iter().map(String::as_str).collect();
    system.without(&names).ok_or_else(|| {
        let name = kebab(system.name());
        Failure::Input(format!(
            "{name} is compiled and keeps all its constraints; give its file, .vi or .rs, with --drop"
        ))
    })
}

fn set(system: &mut dyn System, name: &str, value: f64) -> Result<(), Failure> {
    if !value.is_finite() {
        return Err(Failure::Input(format!("the parameter `{name}` must be finite, not {value}")));
    }
    if system.set(name, value) {
        return Ok(());
    }
    let names: Vec<String> = system.parameters().iter().map(|(name, _)| format!("`{name}`")).collect();
    let known = if names.is_empty() { "it has none".to_owned() } else { format!("it has {}", names.join(", ")) };
    Err(Failure::Input(format!("{} has no parameter `{name}`; {known}", kebab(system.name()))))
}

/// The parts of `NAME=VALUE`.
fn parse_assignment(text: &str) -> Result<(&str, f64), Failure> {
    let (name, value) =
        text.split_once('=').ok_or_else(|| Failure::Input(format!("`--set {text}` must have the form NAME=VALUE")))?;
    let name = name.trim();
    let value = value.trim();
    let wrong = |what| Failure::Input(format!("`{value}` in `--set {text}` is not a number; {what}"));
    Ok((name, number(value).map_err(wrong)?))
}

/// Sets a system and a plan to one run of a sweep.
fn set_item(
    (sweep, item): (&Sweep, u64),
    placement: Placement,
    system: &mut dyn System,
    plan: &mut Plan,
) -> Result<(), Failure> {
    let items = Items::of(sweep, system)?.with_placement(placement);
    if item >= items.count() {
        let last = items.count() - 1;
        return Err(Failure::Input(format!("there is no --item {item}: the runs are numbered from 0 to {last}")));
    }
    items.set(item, system, plan);
    Ok(())
}

/// Checks the numbers of a plan, and that the step leads to the end.
///
/// # Errors
/// [`Failure::Input`] for the first wrong input.
pub(super) fn check(system: &dyn System, plan: &Plan, length: Length) -> Result<(), Failure> {
    check::numbers(system, plan)?;
    match length {
        Length::Until(end) => check_direction(plan, end),
        Length::Steps(_) => Ok(()),
    }
}

/// The velocities of these momenta at the start of a plan.
fn velocities(system: &dyn System, plan: &Plan, p: &[f64]) -> Result<Vec<f64>, Failure> {
    if system.is_first_order() {
        return Err(Failure::Input(format!(
            "the momenta of {} follow from its coordinates, since its `L` is linear in the velocities: leave out --p",
            system.name()
        )));
    }
    let mut v = Vec::new();
    let found = system.evaluate(Quantity::Velocity, [&[plan.t], &plan.q, p], &mut v);
    found.map_err(|error| Failure::start(error, plan))?;
    Ok(v)
}

/// Checks that steps lead to the end.
fn check_direction(plan: &Plan, until: f64) -> Result<(), Failure> {
    if (until - plan.t) * plan.h >= 0.0 {
        return Ok(());
    }
    Err(Failure::Input(format!(
        "steps of {} from t = {} do not reach --until {}",
        short(plan.h),
        short(plan.t),
        short(until)
    )))
}

/// Exactly one of the two, with an end that the steps reach.
fn length(steps: Option<u64>, until: Option<f64>, plan: &Plan) -> Result<Length, Failure> {
    match (steps, until) {
        (Some(steps), None) => Ok(Length::Steps(steps)),
        (None, Some(until)) if !until.is_finite() => {
            Err(Failure::Input(format!("the end (--until) must be finite, not {until}")))
        }
        (None, Some(until)) => check_direction(plan, until).map(|()| Length::Until(until)),
        (Some(_), Some(_)) => Err(Failure::Input("give either --steps or --until, not both".to_owned())),
        (None, None) => Ok(Length::Steps(DEFAULT_STEPS)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use vi_erased::plan::Shift;

    fn arguments(target: &str) -> Arguments {
        Arguments { target: Some(target.to_owned()), steps: Some(10), ..Arguments::default() }
    }

    fn message(arguments: &Arguments) -> String {
        Request::of(arguments, &crate::ready()).err().map_or_else(String::new, |failure| failure.to_string())
    }

    fn plan_of(arguments: &Arguments) -> Plan {
        Request::of(arguments, &crate::ready()).map_or_else(|failure| panic!("{failure}"), |request| request.plan)
    }

    #[test]
    fn every_wrong_input_has_its_message() {
        let with = |change: fn(&mut Arguments)| {
            let mut arguments = arguments("double-well");
            change(&mut arguments);
            message(&arguments)
        };
        let cases: [(String, &str); 17] = [
            (with(|a| a.set = vec!["k=1".into()]), "double-well has no parameter `k`; it has `m`"),
            (
                with(|a| a.set = vec!["m=1".into(), " m =2".into()]),
                "the parameter `m` is set twice; use --set once per parameter",
            ),
            // Options in the words of `check`.
            (
                with(|a| a.start = Some(Start::Points)),
                "--start is an option of --method energy: give this method, or leave out --start",
            ),
            (
                with(|a| (a.method, a.stages) = (Some(Method::Gauss), Some(5))),
                "DoubleWell has no integrator --method gauss --stages 5; --stages may be 4 or 8",
            ),
            (with(|a| a.every = Some(0)), "--every must be at least 1: 1 writes every node, 10 every tenth"),
            (
                with(|a| a.output = Some("orbit.npy".into())),
                "the output `orbit.npy` must end in .csv; pandas reads it with `read_csv(FILE, comment=\"#\")`",
            ),
            (with(|a| a.set = vec!["m".into()]), "`--set m` must have the form NAME=VALUE"),
            (
                with(|a| a.set = vec!["m=one".into()]),
                "`one` in `--set m=one` is not a number; write a number such as 0.5 or 1e-3",
            ),
            (with(|a| a.set = vec!["m=inf".into()]), "the parameter `m` must be finite, not inf"),
            (
                with(|a| a.q = Some(vec![1.0, 2.0])),
                "DoubleWell has the coordinates q: give as many coordinates (--q), not 2",
            ),
            (with(|a| a.v = Some(vec![f64::NAN])), "the velocities (--v) must be finite, not NaN"),
            (
                with(|a| a.p = Some(vec![1.0, 2.0])),
                "DoubleWell has the coordinates q: give as many momenta (--p), not 2",
            ),
            (with(|a| a.p = Some(vec![f64::INFINITY])), "the momenta (--p) must be finite, not inf"),
            (with(|a| a.h = Some(0.0)), "the step (--h) must be finite, not zero and not subnormal, not 0.0"),
            (with(|a| a.until = Some(1.0)), "give either --steps or --until, not both"),
            (
                with(|a| (a.steps, a.until, a.h) = (None, Some(1.0), Some(-0.1))),
                "steps of -0.1 from t = 0 do not reach --until 1",
            ),
            (with(|a| (a.steps, a.until) = (None, Some(f64::INFINITY))), "the end (--until) must be finite, not inf"),
        ];
        for (found, expected) in cases {
            assert_eq!(found, expected);
        }
    }

    #[test]
    fn momenta_become_the_velocities_of_the_parameters() {
        let with = |p: f64| {
            let arguments = Arguments { p: Some(vec![p]), set: vec!["m=4".into()], ..arguments("double-well") };
            plan_of(&arguments).v
        };
        assert_eq!([with(2.0), with(-1.0)], [[0.5], [-0.25]]);
    }

    #[test]
    fn a_step_in_scaled_time_begins_as_long_as_the_scale_says() {
        let scaled = |dtau| Arguments { method: Some(Method::Gauss), dtau: Some(dtau), ..arguments("kepler") };
        let plan = plan_of(&scaled(0.5));
        // g = r^(3/2) at r = 0.4.
        assert!((plan.h - 0.5 * 0.4_f64.powf(1.5)).abs() < 1e-15 && plan.dtau == Some(0.5), "{plan:?}");
        let refused = message(&scaled(0.0));
        assert_eq!(
            refused,
            "the step in transformed time (--dtau) must be finite, not zero and not subnormal, not 0.0"
        );
    }

    #[test]
    fn a_shift_is_measured_over_the_run_or_its_first_steps() {
        let over = |steps| {
            let (method, shift) = (Some(Method::Energy), Some(Wanted::Auto));
            let arguments = Arguments { method, shift, steps: Some(steps), ..arguments("double-well") };
            plan_of(&arguments).shift
        };
        assert_eq!([over(0), over(500)], [Some(Shift::Over(0.01)), Some(Shift::Over(5.0))]);
        assert_eq!(over(10_000_000), Some(Shift::Over(100.0)));
    }

    #[test]
    fn defaults_come_from_the_catalogue() {
        let request =
            Request::of(&arguments("double-well"), &crate::ready()).unwrap_or_else(|failure| panic!("{failure}"));
        assert_eq!(request.columns(), ["t", "q", "p_q", "H", "E", "h"]);
        assert_eq!((request.every, request.output), (1, Output::Standard));
        assert_eq!((request.plan.h, request.plan.method), (0.01, Method::Fixed));
        assert_eq!(request.length, Length::Steps(10));
    }
}
