//! What a run is to do: the command line over the scene over the system's defaults, every input checked.

use super::super::catalogue::{self, System};
use super::super::failure::Failure;
use super::super::simulation::{Method, Plan, Start};
use super::Arguments;
use super::scene::Scene;
use std::path::{Path, PathBuf};

/// Positions of the progress bar of a run until a time.
const FINENESS: u64 = 1000;

/// A run, ready to begin.
pub(super) struct Request {
    /// The system, with its parameters set.
    pub(super) system: Box<dyn System>,
    /// Integrator, step and initial state.
    pub(super) plan: Plan,
    /// How long.
    pub(super) length: Length,
    /// Where to.
    pub(super) output: Option<PathBuf>,
}

/// When a run ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Length {
    /// After this many steps.
    Steps(u64),
    /// At the first node at or after this time.
    Until(f64),
}

impl Length {
    /// Length of the progress bar.
    pub(super) fn bar(self) -> u64 {
        match self {
            Self::Steps(steps) => steps,
            Self::Until(_) => FINENESS,
        }
    }

    /// A part of the whole as a position of the bar.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // between 0 and 1000
    pub(super) fn fraction(part: f64) -> u64 {
        (part.clamp(0.0, 1.0) * 1000.0) as u64
    }
}

impl Request {
    /// The run that the arguments ask for.
    ///
    /// # Errors
    /// [`Failure::Input`] for the first input that is wrong.
    pub(super) fn of(arguments: &Arguments) -> Result<Self, Failure> {
        let is_scene = Path::new(&arguments.target).extension().is_some_and(|extension| extension == "toml");
        let scene = if is_scene { Scene::read(&arguments.target)? } else { Scene::of_system(&arguments.target) };
        let entry = catalogue::find(&scene.system)?;
        let mut system = entry.system;
        for (name, value) in &scene.parameters {
            set(system.as_mut(), name, *value)?;
        }
        for assignment in &arguments.set {
            let (name, value) = parse_assignment(assignment)?;
            set(system.as_mut(), name, value)?;
        }
        let plan = Plan {
            method: arguments.method.or(scene.method).unwrap_or(Method::Fixed),
            start: arguments.start.or(scene.start).unwrap_or(Start::Midpoint),
            h: arguments.h.or(scene.h).unwrap_or(entry.h),
            t: arguments.t.or(scene.t).unwrap_or(0.0),
            q: arguments.q.clone().or(scene.q).unwrap_or(entry.q),
            v: arguments.v.clone().or(scene.v).unwrap_or(entry.v),
        };
        check_initial(system.as_ref(), &plan)?;
        let length = match (arguments.steps, arguments.until) {
            (None, None) => length(scene.steps, scene.until, &plan)?,
            (steps, until) => length(steps, until, &plan)?,
        };
        Ok(Self { system, plan, length, output: arguments.output.clone() })
    }

    /// Names of the columns of a row.
    pub(super) fn columns(&self) -> Vec<String> {
        let coordinates = self.system.coordinates();
        let mut columns = vec!["t".to_owned()];
        columns.extend(coordinates.iter().map(|&name| name.to_owned()));
        columns.extend(coordinates.iter().map(|name| format!("p_{name}")));
        columns.extend(["energy".to_owned(), "h".to_owned()]);
        columns
    }
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
    let (name, value) = (name.trim(), value.trim());
    let number = value.parse().map_err(|_| Failure::Input(format!("`{value}` in `--set {text}` is not a number")))?;
    Ok((name, number))
}

/// Sizes and finiteness of the initial state.
fn check_initial(system: &dyn System, plan: &Plan) -> Result<(), Failure> {
    let coordinates = system.coordinates();
    for (what, values) in [("coordinates (--q)", &plan.q), ("velocities (--v)", &plan.v)] {
        if values.len() != coordinates.len() {
            return Err(Failure::Input(format!(
                "{} needs {} {what}, for {}; given {}",
                catalogue::kebab(system.name()),
                coordinates.len(),
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

/// Exactly one of the two, and an end that the step leads to.
fn length(steps: Option<u64>, until: Option<f64>, plan: &Plan) -> Result<Length, Failure> {
    match (steps, until) {
        (Some(steps), None) => Ok(Length::Steps(steps)),
        (None, Some(until)) if !until.is_finite() => {
            Err(Failure::Input(format!("the end (--until) must be finite, not {until}")))
        }
        (None, Some(until)) if (until - plan.t) * plan.h < 0.0 => {
            Err(Failure::Input(format!("steps of {} from t = {} do not lead to --until {until}", plan.h, plan.t)))
        }
        (None, Some(until)) => Ok(Length::Until(until)),
        (Some(_), Some(_)) => Err(Failure::Input("give either --steps or --until, not both".to_owned())),
        (None, None) => Err(Failure::Input("give the length of the run, --steps N or --until T".to_owned())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn arguments(target: &str) -> Arguments {
        Arguments { target: target.to_owned(), steps: Some(10), ..Arguments::default() }
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
        let cases: [(String, &str); 11] = [
            (with(|a| a.set = vec!["k=1".into()]), "double-well has no parameter `k`; it has `m`"),
            (with(|a| a.set = vec!["m".into()]), "`--set m` must have the form NAME=VALUE"),
            (with(|a| a.set = vec!["m=one".into()]), "`one` in `--set m=one` is not a number"),
            (with(|a| a.set = vec!["m=inf".into()]), "the parameter `m` must be finite, not inf"),
            (with(|a| a.q = Some(vec![1.0, 2.0])), "double-well needs 1 coordinates (--q), for q; given 2"),
            (with(|a| a.v = Some(vec![f64::NAN])), "the velocities (--v) must be finite, not NaN"),
            (with(|a| a.h = Some(0.0)), "the step (--h) must not be zero"),
            (with(|a| a.steps = None), "give the length of the run, --steps N or --until T"),
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
        assert_eq!(request.columns(), ["t", "q", "p_q", "energy", "h"]);
        assert_eq!((request.plan.h, request.plan.method), (0.01, Method::Fixed));
        assert_eq!(request.length, Length::Steps(10));
    }
}
