//! What a run is to do: the command line over the scene over the system's defaults, every input checked.

use super::Arguments;
use super::scene::Scene;
use crate::catalogue;
use crate::failure::Failure;
use crate::input::number;
use crate::numbers::short;
use crate::place;
use crate::simulation::{Method, Plan, Row, STAGES, Start, USUAL_STAGES};
use crate::sweep::items::Items;
use crate::sweep::scene::Sweep;
use crate::system::System;
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Steps of a run that is not told otherwise.
const USUAL_STEPS: u64 = 1000;

/// A run, ready to begin.
pub(crate) struct Request {
    /// The system, with its parameters set.
    pub(crate) system: Box<dyn System>,
    /// Integrator, step and initial state.
    pub(crate) plan: Plan,
    /// How long.
    pub(crate) length: Length,
    /// Every so many nodes one is written.
    pub(crate) every: u64,
    /// Where to.
    pub(super) output: Output,
    /// The picture of it, an SVG file.
    pub(super) plot: Option<PathBuf>,
    /// Whether the output may have more than a gigabyte.
    pub(super) large_output: bool,
}

/// When a run ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Length {
    /// After this many steps.
    Steps(u64),
    /// At the first node at or after this time.
    Until(f64),
}

impl Length {
    /// Whether a run is at its end.
    pub(crate) fn is_reached(self, t: f64, h: f64, steps: u64) -> bool {
        match self {
            Self::Steps(wanted) => steps >= wanted,
            // A billionth of a step forgives the rounding of a sum of fixed steps.
            Self::Until(end) => (end - t) * h.signum() <= 1e-9 * h.abs(),
        }
    }

    /// The part of a run that is done, between 0 and 1.
    #[allow(clippy::cast_precision_loss)] // an estimate
    pub(crate) fn part(self, plan: &Plan, t: f64, steps: u64) -> f64 {
        match self {
            Self::Steps(wanted) => steps as f64 / wanted as f64,
            Self::Until(end) => ((t - plan.t) / (end - plan.t)).clamp(0.0, 1.0),
        }
    }

    /// Number of steps, were all as long as the first.
    #[allow(clippy::cast_precision_loss)] // an estimate
    pub(crate) fn steps(self, plan: &Plan) -> f64 {
        match self {
            Self::Steps(wanted) => wanted as f64,
            Self::Until(end) => ((end - plan.t) / plan.h).ceil(),
        }
    }

    /// The time at which the run ends, were all steps as long as the first.
    pub(crate) fn end(self, plan: &Plan) -> f64 {
        match self {
            Self::Steps(_) => plan.t + self.steps(plan) * plan.h,
            Self::Until(end) => end,
        }
    }
}

/// Where rows go.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Output {
    /// As CSV to standard output.
    Standard,
    /// To a CSV file.
    Csv(PathBuf),
    /// To an NPY file.
    Npy(PathBuf),
    /// Nowhere but into a plot.
    None,
}

impl Output {
    /// The output that a path asks for.
    fn at(path: &Path) -> Result<Self, Failure> {
        let shown = path.display();
        let extension = path.extension().and_then(|extension| extension.to_str()).map(str::to_ascii_lowercase);
        let output = match extension.as_deref() {
            Some("csv") => Self::Csv(path.to_owned()),
            Some("npy") => Self::Npy(path.to_owned()),
            _ => return Err(Failure::Input(format!("the output `{shown}` must end in .csv or .npy"))),
        };
        place::check("output", path)?;
        match fs::metadata(path) {
            Ok(found) if !found.is_file() && matches!(output, Self::Npy(_)) => Err(Failure::Input(format!(
                "the output `{shown}` is a pipe or a device, and the head of an NPY file is written last; write CSV there"
            ))),
            _ => Ok(output),
        }
    }

    /// Bytes that a number takes in a row: by measurement for CSV, whose numbers are as long as their digits.
    pub(super) fn bytes_per_number(&self) -> f64 {
        match self {
            Self::Standard | Self::Csv(_) => 19.0,
            Self::Npy(_) => 8.0,
            Self::None => 0.0,
        }
    }
}

/// The file that --plot names.
fn check_plot(path: &Path) -> Result<(), Failure> {
    if path.extension().is_none_or(|extension| !extension.eq_ignore_ascii_case("svg")) {
        return Err(Failure::Input(format!("the plot `{}` must end in .svg", path.display())));
    }
    place::check("plot", path)
}

impl Request {
    /// The run that the arguments ask for.
    ///
    /// # Errors
    /// [`Failure::Input`] for the first input that is wrong.
    pub(super) fn of(arguments: &Arguments) -> Result<Self, Failure> {
        match (Self::read(arguments)?, arguments.item) {
            ((request, None), None) | ((request, Some(_)), Some(_)) => Ok(request),
            ((_, None), Some(_)) => Err(Failure::Input("only a scene with [sweep] has an --item".to_owned())),
            ((_, Some(_)), None) => Err(Failure::Input(
                "the scene has a [sweep]: `vi-lab sweep` takes all its runs, and --item K one of them".to_owned(),
            )),
        }
    }

    /// The run that all runs of a sweep are like, and the sweep.
    ///
    /// # Errors
    /// [`Failure::Input`] for the first input that is wrong, and where the scene has no sweep.
    pub(crate) fn with_sweep(scene: &str) -> Result<(Self, Sweep), Failure> {
        let arguments = Arguments { target: Some(scene.to_owned()), ..Arguments::default() };
        let (request, sweep) = Self::read(&arguments)?;
        let none = || Failure::Input(format!("{scene} is no scene file with a table [sweep]; docs/cluster.md has one"));
        Ok((request, sweep.ok_or_else(none)?))
    }

    /// The run that the arguments ask for, and the sweep of the scene.
    fn read(arguments: &Arguments) -> Result<(Self, Option<Sweep>), Failure> {
        let target = match &arguments.target {
            Some(target) => target.clone(),
            None => catalogue::first_own()?,
        };
        let extension = Path::new(&target).extension();
        let is_scene = extension.is_some_and(|extension| extension.eq_ignore_ascii_case("toml"));
        let scene = if is_scene { Scene::read(&target)? } else { Scene::of_system(&target) };
        let entry = catalogue::find(&scene.system)?;
        let mut system = entry.system;
        for (name, value) in &scene.parameters {
            set(system.as_mut(), name, *value)?;
        }
        let mut names = BTreeSet::new();
        for assignment in &arguments.set {
            let (name, value) = parse_assignment(assignment)?;
            if !names.insert(name) {
                return Err(Failure::Input(format!("the parameter `{name}` is set twice; give --set once for each")));
            }
            set(system.as_mut(), name, value)?;
        }
        let mut plan = Plan {
            method: arguments.method.or(scene.method).unwrap_or(Method::Fixed),
            start: arguments.start.or(scene.start).unwrap_or(Start::Midpoint),
            stages: stages(arguments.stages.or(scene.stages))?,
            h: arguments.h.or(scene.h).unwrap_or(entry.h),
            t: arguments.t.or(scene.t).unwrap_or(0.0),
            q: arguments.q.clone().or(scene.q).unwrap_or(entry.q),
            v: arguments.v.clone().or(scene.v).unwrap_or(entry.v),
        };
        if let (Some(sweep), Some(item)) = (&scene.sweep, arguments.item) {
            set_item(sweep, item, system.as_mut(), &mut plan)?;
        }
        check_initial(system.as_ref(), &plan)?;
        // A start that belongs to another method of the scene is no mistake.
        let start = arguments.start.or(scene.start.filter(|_| arguments.method.is_none()));
        if start.is_some() && plan.method != Method::Energy {
            let message = "only energy-preserving steps have a --start; add --method energy, or leave it out";
            return Err(Failure::Input(message.to_owned()));
        }
        let stages = arguments.stages.or(scene.stages.filter(|_| arguments.method.is_none()));
        if stages.is_some() && plan.method != Method::Gauss {
            return Err(Failure::Input(
                "only Gauss steps have --stages; add --method gauss, or leave it out".to_owned(),
            ));
        }
        let length = match (arguments.steps, arguments.until) {
            (None, None) => length(scene.steps, scene.until, &plan)?,
            (steps, until) => length(steps, until, &plan)?,
        };
        let every = arguments.every.or(scene.every).unwrap_or(1);
        if every == 0 {
            return Err(Failure::Input("every how many nodes one is written (--every) must be at least 1".to_owned()));
        }
        let output = match &arguments.output {
            Some(path) => Output::at(path)?,
            None if arguments.plot.is_some() => Output::None,
            None => Output::Standard,
        };
        let plot = arguments.plot.clone();
        plot.as_deref().map_or(Ok(()), check_plot)?;
        Ok((Self { system, plan, length, every, output, plot, large_output: arguments.large_output }, scene.sweep))
    }

    /// Names of the columns of a row.
    pub(crate) fn columns(&self) -> Vec<String> {
        Row::columns(&self.system.coordinates())
    }
}

/// A number of stages that is built into the command.
fn stages(wanted: Option<u64>) -> Result<usize, Failure> {
    let Some(wanted) = wanted else { return Ok(USUAL_STAGES) };
    let built = STAGES.into_iter().find(|built| *built as u64 == wanted);
    built.ok_or_else(|| {
        let [first, second] = STAGES;
        Failure::Input(format!(
            "Gauss steps of {wanted} stages are not built into the command; --stages may be {first} or {second}"
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
    Err(Failure::Input(format!("{} has no parameter `{name}`; {known}", catalogue::kebab(system.name()))))
}

/// `NAME=VALUE` as its parts.
fn parse_assignment(text: &str) -> Result<(&str, f64), Failure> {
    let (name, value) =
        text.split_once('=').ok_or_else(|| Failure::Input(format!("`--set {text}` must have the form NAME=VALUE")))?;
    let name = name.trim();
    let value = value.trim();
    let wrong = |what| Failure::Input(format!("`{value}` in `--set {text}` is not a number; {what}"));
    Ok((name, number(value).map_err(wrong)?))
}

/// Makes a system and a plan those of one run of a sweep.
fn set_item(sweep: &Sweep, item: u64, system: &mut dyn System, plan: &mut Plan) -> Result<(), Failure> {
    let items = Items::of(sweep, system)?;
    if item >= items.count() {
        let last = items.count() - 1;
        return Err(Failure::Input(format!("there is no --item {item}: the runs are numbered from 0 to {last}")));
    }
    items.set(item, system, plan);
    Ok(())
}

/// Sizes and finiteness of the initial state, and whether its step leads to the end.
///
/// # Errors
/// [`Failure::Input`] for the first input that is wrong.
pub(super) fn check(system: &dyn System, plan: &Plan, length: Length) -> Result<(), Failure> {
    check_initial(system, plan)?;
    match length {
        Length::Until(end) => check_direction(plan, end),
        Length::Steps(_) => Ok(()),
    }
}

/// Sizes and finiteness of the initial state.
fn check_initial(system: &dyn System, plan: &Plan) -> Result<(), Failure> {
    let coordinates = system.coordinates();
    for (what, values) in [("coordinates (--q)", &plan.q), ("velocities (--v)", &plan.v)] {
        if values.len() != coordinates.len() {
            return Err(Failure::Input(format!(
                "{} has the coordinates {}: give as many {what}, not {}",
                catalogue::kebab(system.name()),
                coordinates.join(", "),
                values.len()
            )));
        }
        if let Some(value) = values.iter().find(|value| !value.is_finite()) {
            return Err(Failure::Input(format!("the {what} must be finite, not {value}")));
        }
    }
    for (what, value) in [("initial time (--t)", plan.t), ("step (--h)", plan.h)] {
        if !value.is_finite() {
            return Err(Failure::Input(format!("the {what} must be finite, not {value}")));
        }
    }
    if plan.h == 0.0 {
        return Err(Failure::Input("the step (--h) must not be zero".to_owned()));
    }
    Ok(())
}

/// Whether steps lead to an end.
fn check_direction(plan: &Plan, until: f64) -> Result<(), Failure> {
    if (until - plan.t) * plan.h >= 0.0 {
        return Ok(());
    }
    Err(Failure::Input(format!(
        "steps of {} from t = {} do not lead to --until {}",
        short(plan.h),
        short(plan.t),
        short(until)
    )))
}

/// Exactly one of the two, and an end that the step leads to.
fn length(steps: Option<u64>, until: Option<f64>, plan: &Plan) -> Result<Length, Failure> {
    match (steps, until) {
        (Some(steps), None) => Ok(Length::Steps(steps)),
        (None, Some(until)) if !until.is_finite() => {
            Err(Failure::Input(format!("the end (--until) must be finite, not {until}")))
        }
        (None, Some(until)) => check_direction(plan, until).map(|()| Length::Until(until)),
        (Some(_), Some(_)) => Err(Failure::Input("give either --steps or --until, not both".to_owned())),
        (None, None) => Ok(Length::Steps(USUAL_STEPS)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arguments(target: &str) -> Arguments {
        Arguments { target: Some(target.to_owned()), steps: Some(10), ..Arguments::default() }
    }

    fn message(arguments: &Arguments) -> String {
        Request::of(arguments).err().map_or_else(String::new, |failure| failure.to_string())
    }

    #[test]
    fn every_wrong_input_has_its_message() {
        let with = |change: fn(&mut Arguments)| {
            let mut arguments = arguments("double-well");
            change(&mut arguments);
            message(&arguments)
        };
        let cases: [(String, &str); 16] = [
            (with(|a| a.set = vec!["k=1".into()]), "double-well has no parameter `k`; it has `m`"),
            (
                with(|a| a.set = vec!["m=1".into(), " m =2".into()]),
                "the parameter `m` is set twice; give --set once for each",
            ),
            (with(|a| a.every = Some(0)), "every how many nodes one is written (--every) must be at least 1"),
            (
                with(|a| a.start = Some(Start::Points)),
                "only energy-preserving steps have a --start; add --method energy, or leave it out",
            ),
            (with(|a| a.stages = Some(8)), "only Gauss steps have --stages; add --method gauss, or leave it out"),
            (
                with(|a| (a.method, a.stages) = (Some(Method::Gauss), Some(5))),
                "Gauss steps of 5 stages are not built into the command; --stages may be 4 or 8",
            ),
            (with(|a| a.output = Some(".npy".into())), "the output `.npy` must end in .csv or .npy"),
            (with(|a| a.set = vec!["m".into()]), "`--set m` must have the form NAME=VALUE"),
            (
                with(|a| a.set = vec!["m=one".into()]),
                "`one` in `--set m=one` is not a number; write a number such as 0.5 or 1e-3",
            ),
            (with(|a| a.set = vec!["m=inf".into()]), "the parameter `m` must be finite, not inf"),
            (
                with(|a| a.q = Some(vec![1.0, 2.0])),
                "double-well has the coordinates q: give as many coordinates (--q), not 2",
            ),
            (with(|a| a.v = Some(vec![f64::NAN])), "the velocities (--v) must be finite, not NaN"),
            (with(|a| a.h = Some(0.0)), "the step (--h) must not be zero"),
            (with(|a| a.until = Some(1.0)), "give either --steps or --until, not both"),
            (
                with(|a| (a.steps, a.until, a.h) = (None, Some(1.0), Some(-0.1))),
                "steps of -0.1 from t = 0 do not lead to --until 1",
            ),
            (with(|a| (a.steps, a.until) = (None, Some(f64::INFINITY))), "the end (--until) must be finite, not inf"),
        ];
        for (found, expected) in cases {
            assert_eq!(found, expected);
        }
    }

    #[test]
    fn defaults_come_from_the_catalogue() {
        let request = Request::of(&arguments("double-well")).unwrap_or_else(|failure| panic!("{failure}"));
        assert_eq!(request.columns(), ["t", "q", "p_q", "H", "E", "h"]);
        assert_eq!((request.every, request.output), (1, Output::Standard));
        assert_eq!((request.plan.h, request.plan.method), (0.01, Method::Fixed));
        assert_eq!(request.length, Length::Steps(10));
    }
}
