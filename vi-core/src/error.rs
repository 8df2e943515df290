//! Every way in which a step can fail, with its numbers, and what to do about it.

use core::fmt;

/// Why a step was not taken. The integrator still holds the last good state, and a further call returns the same error.
#[derive(Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum StepError {
    /// No energy-preserving step leads forward from here: a property of the method, not of the solver.
    NoForwardStep {
        /// Time of the last good node.
        t: f64,
        /// Length of the last good step.
        h: f64,
        /// `H(t, q, p) − E`: where a step exists it is `h² D/8` to leading order.
        excess: f64,
        /// Step density D at the last good node.
        density: f64,
    },
    /// No energy-preserving Gauss step leads forward from here: its step density vanishes or changes its sign.
    NoForwardGaussStep {
        /// Time of the last good node.
        t: f64,
        /// Length of the last good step.
        h: f64,
        /// Stages s of the step.
        stages: usize,
        /// `H(t, q, p) − E'`: where a step exists it is `C_s h^2s (D_s + D_*)` to leading order.
        excess: f64,
        /// Step density D_s at the last good node.
        density: f64,
        /// The shift D_*.
        shift: f64,
        /// The largest `|D_s|` that the run has met.
        largest: f64,
    },
    /// The shift of the step density adds more to the energy that is kept than the energy has: E' would say nothing of it.
    ShiftTooLarge {
        /// Time of the last good node.
        t: f64,
        /// Length of the last good step.
        h: f64,
        /// The shift D_*.
        shift: f64,
        /// What it adds, `C_s h^2s D_*`.
        part: f64,
        /// The size of the terms of H, `|v·p| + |H|`, along the motion.
        size: f64,
        /// Length of a step whose part is a tenth of that size.
        shorter: f64,
    },
    /// The step density vanishes: the length of the step is not determined.
    DegenerateStep {
        /// Time of the last good node.
        t: f64,
        /// Length of the last good step.
        h: f64,
        /// Step density D at the trial step.
        density: f64,
    },
    /// The only forward step is longer or shorter than the last one by more than the factor allowed.
    StepRatio {
        /// Time of the last good node.
        t: f64,
        /// Length of the last good step.
        previous: f64,
        /// Length of the step that solves the equations.
        found: f64,
    },
    /// The step that solves the equations is shorter or longer than the caller allows.
    StepBounds {
        /// Time of the last good node.
        t: f64,
        /// Length of the step that solves the equations.
        found: f64,
        /// Shortest length allowed.
        h_min: f64,
        /// Longest length allowed.
        h_max: f64,
    },
    /// Newton's iteration ended above the rounding floor.
    NotConverged {
        /// Time at which the step begins; of a composition, its substep.
        t: f64,
        /// Length of the trial step; of a composition, of its substep.
        h: f64,
        /// Iterations spent.
        iterations: u32,
        /// Residual left, in units of rounding.
        residual: f64,
        /// The last residuals on the way there.
        residuals: Residuals,
    },
    /// The stages of a Gauss step did not come to rest, neither by sweeps nor by Newton's iteration.
    StagesUnsettled {
        /// Time at which the step begins.
        t: f64,
        /// Length of the step.
        h: f64,
        /// Iterations spent.
        iterations: u32,
        /// The last change of a stage, in roundings of its coordinate.
        change: f64,
        /// The last change by the one before.
        contraction: f64,
        /// Estimate of h ω, ω the fastest rate of the equations linearized in the middle of the step.
        stiffness: f64,
    },
    /// The time scale g of `dt = g dτ` is not positive, not finite, or so small that a step does not change the time or does not keep the energy.
    TimeScale {
        /// Time at which it was met.
        t: f64,
        /// Its value there.
        g: f64,
    },
    /// Steps in transformed time were asked of a system without a time scale.
    NoTimeScale {
        /// Name of the system.
        system: &'static str,
    },
    /// Steps by a rule were asked of a system without one.
    NoRule {
        /// Name of the system.
        system: &'static str,
    },
    /// Two velocities have the same momenta: L is not defined at rest and has a branch on each side of it.
    Ambiguous {
        /// Time at which it was met.
        t: f64,
    },
    /// A matrix that has to be inverted is singular.
    Singular {
        /// Time at which it was met.
        t: f64,
        /// Which matrix.
        matrix: &'static str,
    },
    /// A quantity is infinite or not a number.
    NonFinite {
        /// Time at which it was met.
        t: f64,
        /// Which quantity.
        quantity: &'static str,
        /// The part of L or f that is not finite there, where the system says so.
        expression: Option<&'static str>,
    },
    /// The search for an event of one direction begins at its zero, and the motion leads through it again at that instant: a ball that has come to rest.
    CannotLeave {
        /// Time at which the search begins.
        t: f64,
        /// The index of the event among those that were asked for.
        event: usize,
        /// The function of the event there.
        value: f64,
        /// Length of time after which it has passed zero again.
        within: f64,
    },
    /// A step has no derivative, or not the one that was asked for.
    NoDerivative {
        /// Time at which the step was to begin.
        t: f64,
        /// Why, and what to do.
        because: &'static str,
    },
    /// The system has no parameter of the name that was given.
    UnknownParameter {
        /// Name of the system.
        system: &'static str,
        /// The names that its parameters have.
        parameters: &'static [&'static str],
    },
    /// A checkpoint was taken of another system, or with another value of a parameter.
    OtherSystem {
        /// Name of the system that was to be restarted.
        system: &'static str,
        /// The parameter whose values differ; `None` where the systems or their rules do.
        parameter: Option<&'static str>,
        /// Its value in the checkpoint; not a number where the systems differ.
        stored: f64,
        /// Its value in the system that was to be restarted; not a number where the systems differ.
        given: f64,
    },
    /// The error of a step exceeds what was asked for, relative to the excursion of a coordinate.
    Tolerance {
        /// Time at which the step begins.
        t: f64,
        /// Its relative error; infinite if its half steps have no solution.
        estimate: f64,
        /// The largest that is allowed.
        tolerance: f64,
    },
    /// The caller gave a number with which no step can be taken.
    InvalidInput {
        /// Which input.
        input: &'static str,
        /// What is allowed.
        allowed: &'static str,
        /// What was given.
        value: f64,
    },
}

impl StepError {
    /// What the error says, with its numbers, but without what to do: for a program that gives its own users other advice.
    #[must_use]
    pub fn reason(&self) -> impl fmt::Display + '_ {
        Reason(self)
    }
}

/// What a [`StepError`] says without what to do about it; see [`StepError::reason`].
struct Reason<'a>(&'a StepError);

impl fmt::Display for Reason<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            StepError::NoForwardStep { t, h, excess, density } => write!(
                f,
                "no energy-preserving step leads forward from t = {t:.9} (last h = {h:.3e}, H − E = {excess:.3e}, step density D = {density:.3e})"
            ),
            StepError::NoForwardGaussStep { t, h, stages, excess, density, shift, .. } => write!(
                f,
                "no energy-preserving step with s = {stages} leads forward from t = {t:.9} (last h = {h:.3e}, H − E = {excess:.3e}, step density D = {density:.3e}, shifted by {shift:.3e})"
            ),
            StepError::ShiftTooLarge { t, h, shift, part, size, .. } => write!(
                f,
                "the shift {shift:.3e} of the step density outweighs the energy at t = {t:.9}: with h = {h:.3e} it adds {part:.3e}, and the terms of H are {size:.3e}"
            ),
            StepError::DegenerateStep { t, h, density } => write!(
                f,
                "the step length is not determined at t = {t:.9} (last h = {h:.3e}, step density D = {density:.3e})"
            ),
            StepError::StepRatio { t, previous, found } => write!(
                f,
                "the forward step from t = {t:.9} has h = {found:.3e} after {previous:.3e}, beyond the allowed factor of 3"
            ),
            StepError::StepBounds { t, found, h_min, h_max } => write!(
                f,
                "the forward step from t = {t:.9} has h = {found:.3e}, outside the bounds {h_min:.3e} to {h_max:.3e}"
            ),
            StepError::NotConverged { t, h, iterations, residual, residuals } => {
                if *h == 0.0 {
                    write!(f, "no velocity found for the momenta at t = {t:.9}")?;
                } else {
                    write!(f, "no solution found from t = {t:.9} with h = {h:.3e}")?;
                }
                write!(f, ": residual {residual:.3e} roundings after {iterations} iterations{residuals}")
            }
            StepError::StagesUnsettled { t, h, iterations, change, contraction, stiffness } => write!(
                f,
                "the stages of the step from t = {t:.9} with h = {h:.3e} do not settle: they change by {change:.3e} roundings in iteration {iterations}, {contraction:.2} times the change before; h ω is about {stiffness:.3e}"
            ),
            StepError::TimeScale { t, g } if *g > 0.0 && g.is_finite() => {
                write!(
                    f,
                    "the time scale is g = {g:.3e} at t = {t:.9}, too small for the time to go on or the energy to stay"
                )
            }
            StepError::TimeScale { t, g } => {
                write!(f, "the time scale is g = {g:.3e} at t = {t:.9}, where it must be positive and finite")
            }
            StepError::NoTimeScale { system } => write!(f, "`{system}` has no time scale"),
            StepError::NoRule { system } => write!(f, "`{system}` takes no steps by a rule"),
            StepError::Ambiguous { t } => write!(f, "two velocities have the momenta at t = {t:.9}"),
            StepError::Singular { t, matrix } => write!(f, "the {matrix} is singular at t = {t:.9}"),
            StepError::NonFinite { t, quantity, expression: None } => {
                write!(f, "the {quantity} is not finite at t = {t:.9}")
            }
            StepError::NonFinite { t, quantity, expression: Some(expression) } => {
                write!(f, "the {quantity} is not finite at t = {t:.9}, because `{expression}` is not")
            }
            StepError::CannotLeave { t, event, value, within } => write!(
                f,
                "the motion cannot leave the zero of event {event} at t = {t:.9}: its function is {value:.3e} there and has passed zero again within {within:.3e}"
            ),
            StepError::NoDerivative { t, because } => {
                write!(f, "the step from t = {t:.9} cannot be differentiated: {because}")
            }
            StepError::UnknownParameter { system, .. } => {
                write!(f, "`{system}` has no parameter of the name that was given")
            }
            StepError::OtherSystem { system, parameter: None, .. } => {
                write!(f, "the checkpoint is of another system than `{system}`, or of another rule")
            }
            StepError::OtherSystem { system, parameter: Some(parameter), stored, given } => {
                write!(f, "the checkpoint of `{system}` was taken with `{parameter}` = {stored:e}, not {given:e}")
            }
            StepError::Tolerance { t, estimate, tolerance } => write!(
                f,
                "the step from t = {t:.9} has a relative error of {estimate:.1e}, more than the {tolerance:.1e} allowed"
            ),
            StepError::InvalidInput { input, allowed, value } => write!(f, "{input} must be {allowed}, not {value:?}"),
        }
    }
}

/// The message: a `main` that returns the error prints it by `Debug`.
impl fmt::Debug for StepError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl fmt::Display for StepError {
    /// The reason, and what to do where something can be done.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.reason().fmt(f)?;
        match self {
            Self::DegenerateStep { h, .. } => write!(
                f,
                "; `with_fallback(Fallback::FixedSteps)` or fixed steps of h = {h:.3e} go on, and so may longer steps, fewer stages, or `EnergyPreservingGauss` with another shift"
            ),
            Self::NoForwardStep { h, .. } | Self::StepRatio { previous: h, .. } => {
                write!(
                    f,
                    "; `with_fallback(Fallback::FixedSteps)` or `FixedStep` with h = {h:.3e} goes on, and so does `EnergyPreservingGauss` with a shift, which `with_shift_from(duration)` measures"
                )
            }
            Self::NoForwardGaussStep { h, largest, .. } => write!(
                f,
                "; `with_shift({:.3e})`, beyond the largest |D| so far, makes steps that exist here, other numbers of stages have other densities, and `with_fallback(Fallback::FixedSteps)` or `Gauss` with h = {h:.3e} goes on",
                2.0 * largest
            ),
            Self::ShiftTooLarge { shorter, .. } => write!(f, "; start with steps of {shorter:.1e} or shorter"),
            // Rounded away from the bounds, so that the number itself is allowed.
            Self::StepBounds { found, h_max, .. } => write!(
                f,
                "; allow {:.3e} by `with_step_bounds`, or go on with steps of the bound by `with_fallback(Fallback::FixedSteps)`",
                if found > h_max { 1.001 * found } else { 0.999 * found }
            ),
            Self::NotConverged { h, .. } if *h == 0.0 => {
                f.write_str("; start from the momenta of a velocity, `system.at(t, q, v)`, or take shorter steps")
            }
            Self::NotConverged { h, .. } | Self::StagesUnsettled { h, .. } => {
                write!(f, "; take steps shorter than {:.3e}", h.abs())
            }
            Self::TimeScale { g, .. } if *g > 0.0 && g.is_finite() => {
                f.write_str("; take shorter steps, end the run before, or write a `time_scale` that does not nearly vanish there")
            }
            Self::TimeScale { .. } => {
                f.write_str("; take shorter steps, or write a `time_scale` that is positive there")
            }
            Self::NoTimeScale { .. } => {
                f.write_str("; write the clause `time_scale = …;` in its `lagrangian!`, or take `Gauss`")
            }
            Self::NoRule { .. } => {
                f.write_str("; add `discretize midpoint;` to its `lagrangian!`, or take `Gauss`")
            }
            Self::Ambiguous { .. } => f.write_str("; L is not defined at rest and has a branch on each side of it: take one that is defined on one side alone"),
            Self::UnknownParameter { parameters, .. } if !parameters.is_empty() => {
                write!(f, "; its parameters are `{}`", parameters.join("`, `"))
            }
            Self::OtherSystem { parameter: None, .. } => {
                f.write_str("; restart the system that it was taken of, by its rule")
            }
            Self::OtherSystem { .. } => f.write_str("; restart with the parameters that it was taken with"),
            Self::CannotLeave { event, .. } => write!(
                f,
                "; set the velocity toward it to zero and change the system so that it stays, or search without event {event}"
            ),
            Self::Tolerance { .. } => f.write_str("; take shorter steps, a method of higher order, or allow a larger error"),
            Self::Singular { .. }
            | Self::NonFinite { .. }
            | Self::NoDerivative { .. }
            | Self::UnknownParameter { .. }
            | Self::InvalidInput { .. } => Ok(()),
        }
    }
}

impl core::error::Error for StepError {}

/// The last residuals of an iteration that did not converge, in units of rounding: whether it stalled, wandered or was
/// cut short.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Residuals {
    /// The newest last; those that are not there yet are zero.
    kept: [f64; Self::KEPT],
    count: usize,
}

impl Residuals {
    /// So many are kept.
    pub const KEPT: usize = 6;

    /// None yet.
    pub(crate) fn new() -> Self {
        Self { kept: [0.0; Self::KEPT], count: 0 }
    }

    /// Adds the newest; one that is not finite says nothing and is left out.
    pub(crate) fn push(&mut self, residual: f64) {
        if residual.is_finite() {
            self.kept.rotate_left(1);
            if let Some(newest) = self.kept.last_mut() {
                *newest = residual;
            }
            self.count = Self::KEPT.min(self.count + 1);
        }
    }

    /// The residuals, the oldest first.
    pub fn iter(&self) -> impl Iterator<Item = f64> + '_ {
        self.kept.iter().copied().skip(Self::KEPT - self.count)
    }
}

impl fmt::Display for Residuals {
    /// `, residuals up to there 1.2e3, 4.5e2`; nothing where there are none.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, residual) in self.iter().enumerate() {
            write!(f, "{}{residual:.1e}", if index == 0 { ", residuals up to there " } else { ", " })?;
        }
        Ok(())
    }
}
