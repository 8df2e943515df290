//! Whether the options of a plan go together, and its system has the integrator.
//!
//! In: a plan as a user wrote it. Out: the plan with its stages, or a [`Refusal`], which has words for the command and
//! for Python.

use crate::plan::{Built, Method, Named as _, Plan, Start};
use crate::system::System;
use core::fmt::Display;
use vi_core::StepError;
use vi_core::method::check_step;
use vi_core::run::check_tolerance;

/// The interface in which a user writes options.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Face {
    /// `--method gauss --stages 8`.
    Command,
    /// `method="gauss", stages=8`.
    Python,
}

impl Face {
    /// The name of an option.
    fn option(self, name: &str) -> String {
        match self {
            Self::Command => format!("--{name}"),
            Self::Python => name.to_owned(),
        }
    }

    /// An option with its value.
    fn with(self, name: &str, value: impl Display) -> String {
        match self {
            Self::Command => format!("--{name} {value}"),
            Self::Python => format!("{name}={value}"),
        }
    }

    fn method(self, method: Method) -> String {
        match self {
            Self::Command => self.with("method", method.name()),
            Self::Python => self.with("method", format_args!("{:?}", method.name())),
        }
    }

    /// An integrator.
    #[must_use]
    pub fn integrator(self, (method, stages, is_transformed): Built) -> String {
        let between = if self == Self::Command { " " } else { ", " };
        let stages = stages.map(|stages| self.with("stages", stages));
        let dtau = is_transformed.then(|| self.with("dtau", "…"));
        [Some(self.method(method)), stages, dtau].into_iter().flatten().collect::<Vec<_>>().join(between)
    }

    /// The methods of some integrators with their stages.
    fn methods(self, built: &[Built]) -> Vec<String> {
        let of = |method: Method| {
            let stages = stages_of(built, (method, false));
            let numbers = stages.iter().map(usize::to_string).collect::<Vec<_>>().join(", ");
            let stages = if stages.is_empty() { numbers } else { format!(" ({})", self.with("stages", numbers)) };
            self.method(method) + &stages
        };
        Method::ALL.into_iter().filter(|method| built.iter().any(|of| of.0 == *method)).map(of).collect()
    }
}

/// The stages that are built of a method, in time or in transformed time, in ascending order.
fn stages_of(built: &[Built], of: (Method, bool)) -> Vec<usize> {
    let mut stages: Vec<usize> = built.iter().filter(|one| (one.0, one.2) == of).filter_map(|one| one.1).collect();
    stages.sort_unstable();
    stages
}

/// Why a plan has no run.
#[derive(Clone, Debug, PartialEq)]
pub enum Refusal {
    /// An option that only other methods have.
    Option {
        /// Its name.
        option: &'static str,
        /// The methods that have it.
        of: &'static [Method],
    },
    /// A start that this cause excludes: with constraints, stages or a shift a run begins at the initial state.
    Start {
        /// The cause, in the plural.
        with: &'static str,
    },
    /// Another number of coordinates or velocities than that of the system.
    Count {
        /// Name of the system.
        system: &'static str,
        /// Names of its coordinates.
        coordinates: Vec<&'static str>,
        /// The numbers, and the option.
        of: [&'static str; 2],
        /// The number of values that were given.
        given: usize,
    },
    /// A number that no run has.
    Number {
        /// Name of the input.
        input: &'static str,
        /// Name of its option.
        option: &'static str,
        /// The allowed values.
        allowed: &'static str,
        /// The number.
        value: f64,
    },
    /// The system does not have this integrator.
    Integrator {
        /// Name of the system.
        system: &'static str,
        /// The integrator.
        wanted: Built,
        /// The integrators that it has.
        built: Vec<Built>,
        /// The reason.
        reason: Box<StepError>,
    },
}

impl Refusal {
    /// The mistake and its correction, as a line for a user of this interface.
    #[must_use]
    pub fn message(&self, face: Face) -> String {
        match self {
            Self::Option { option, of } => {
                let [of, option] = [or(&of.iter().map(|of| face.method(*of)).collect::<Vec<_>>()), face.option(option)];
                format!("{option} is an option of {of}: give this method, or leave out {option}")
            }
            Self::Start { with } => {
                format!("steps with {with} start from the initial state: leave out {}", face.option("start"))
            }
            Self::Count { system, coordinates, of: [what, option], given } => format!(
                "{system} has the coordinates {}: give as many {} ({}), not {given}",
                coordinates.join(", "),
                what.trim_start_matches("the "),
                face.option(option)
            ),
            Self::Number { input, option, allowed, value } => {
                format!("{input} ({}) must be {allowed}, not {value:?}", face.option(option))
            }
            Self::Integrator { system, wanted, built, reason } => {
                let method = face.method(wanted.0);
                match reason.as_ref() {
                    StepError::HasConstraints { .. } => {
                        format!(
                            "{system} has constraints, which {method} does not keep: use {}",
                            or(&face.methods(built))
                        )
                    }
                    StepError::FirstOrder { .. } => format!(
                        "{system} has no mass matrix, which {method} needs, since its `L` is linear in the velocities: use {}",
                        or(&face.methods(built))
                    ),
                    StepError::NoTimeScale { .. } => format!(
                        "{system} has no time scale: give {} in place of {}, or write the clause `time_scale = …;`",
                        face.option("h"),
                        face.option("dtau")
                    ),
                    StepError::NoRule { .. } if !built.iter().any(|of| of.0 == Method::Fixed) => format!(
                        "{system} has no rule for {method}: add `discretize midpoint;` to it, or use {}, or {}",
                        face.method(Method::Gauss),
                        face.integrator((Method::Energy, Some(2), false))
                    ),
                    StepError::NotSeparable { .. } => format!("{method}: {}", reason.reason()),
                    _ => lacking(face, (system, *wanted), built),
                }
            }
        }
    }
}

/// The words for an integrator that could be built and is not.
fn lacking(face: Face, (system, wanted): (&str, Built), built: &[Built]) -> String {
    let (method, stages, is_transformed) = wanted;
    let known = stages_of(built, (method, is_transformed));
    let wanted = face.integrator(wanted);
    // With more stages rounding hides the length of energy-preserving steps.
    let why = if method == Method::Energy { ": with more, rounding hides the length" } else { "" };
    let has = match stages {
        Some(_) if !known.is_empty() => {
            let known: Vec<String> = known.iter().map(usize::to_string).collect();
            format!("{} may be {}{why}", face.option("stages"), or(&known))
        }
        _ => format!("it has {}", or(&face.methods(built))),
    };
    let others =
        if face == Face::Python { ". The argument methods of compile and of native builds others" } else { "" };
    format!("{system} has no integrator {wanted}; {has}{others}")
}

/// `1, 2 or 3`.
fn or(words: &[String]) -> String {
    match words {
        [first @ .., last] if !first.is_empty() => format!("{} or {last}", first.join(", ")),
        _ => words.concat(),
    }
}

/// The plan with the stages that its method has if it names none. Its length and its start may still be missing.
///
/// # Errors
/// [`Refusal::Option`], [`Refusal::Start`] for options that do not go together, [`Refusal::Integrator`].
pub fn integrator(system: &dyn System, plan: Plan) -> Result<Plan, Refusal> {
    use Method::{Adaptive, Energy, Gauss};
    let begins_elsewhere = plan.start != Start::default();
    let options: [(_, _, &'static [Method]); 5] = [
        ("start", begins_elsewhere, &[Energy]),
        ("shift", plan.shift.is_some(), &[Energy]),
        ("fallback", plan.fallback, &[Energy]),
        ("stages", plan.stages.is_some(), &[Gauss, Adaptive, Energy]),
        ("dtau", plan.dtau.is_some(), &[Gauss]),
    ];
    for (option, is_given, of) in options {
        if is_given && !of.contains(&plan.method) {
            return Err(Refusal::Option { option, of });
        }
    }
    let excluding = [
        ("constraints", system.has_constraints()),
        ("stages", plan.stages.is_some()),
        ("a shift", plan.shift.is_some()),
    ];
    if let Some((with, _)) = excluding.into_iter().find(|(_, excludes)| begins_elsewhere && *excludes) {
        return Err(Refusal::Start { with });
    }
    let built = system.integrators();
    let plan = Plan { stages: plan.stages.or_else(|| usual_stages(system, &plan, &built)), ..plan };
    let wanted = plan.wanted(system.has_constraints());
    match system.offers(wanted) {
        Ok(()) => Ok(plan),
        Err(reason) => Err(Refusal::Integrator { system: system.name(), wanted, built, reason: Box::new(reason) }),
    }
}

/// The stages of a plan that names none: those of its method if they are built, else the most that are.
fn usual_stages(system: &dyn System, plan: &Plan, built: &[Built]) -> Option<usize> {
    let usual = plan.usual_stages(system.has_constraints())?;
    let known = stages_of(built, (plan.method, plan.dtau.is_some()));
    if known.is_empty() || known.contains(&usual) { Some(usual) } else { known.last().copied() }
}

/// Checks the numbers of a plan: the start, and what determines the length of its steps.
///
/// # Errors
/// [`Refusal::Count`], [`Refusal::Number`].
pub fn numbers(system: &dyn System, plan: &Plan) -> Result<(), Refusal> {
    let coordinates = system.coordinates();
    let second = plan.p.as_ref().map_or((["the velocities", "v"], &plan.v), |p| (["the momenta", "p"], p));
    for (of, values) in [(["the coordinates", "q"], &plan.q), second] {
        if values.len() != coordinates.len() {
            return Err(Refusal::Count { system: system.name(), coordinates, of, given: values.len() });
        }
        if let Some(value) = values.iter().copied().find(|value| !value.is_finite()) {
            let [input, option] = of;
            return Err(Refusal::Number { input, option, allowed: "finite", value });
        }
    }
    if !plan.t.is_finite() {
        return Err(Refusal::Number { input: "the initial time", option: "t", allowed: "finite", value: plan.t });
    }
    let (input, option, value, outcome) = match (plan.tolerance, plan.dtau) {
        (Some(tolerance), _) => ("the tolerance", "tolerance", tolerance, check_tolerance::<f64>(tolerance)),
        (None, Some(dtau)) => ("the step in transformed time", "dtau", dtau, check_step(dtau)),
        (None, None) => ("the step", "h", plan.h, check_step(plan.h)),
    };
    match outcome {
        Err(StepError::InvalidInput { allowed, .. }) => Err(Refusal::Number { input, option, allowed, value }),
        _ => Ok(()),
    }
}
