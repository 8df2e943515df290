//! Typed failures of a step: their numbers, and advice.

use core::fmt;

/// Name of the bordered mass matrix in [`StepError::Singular`].
pub const BORDERED_MASS: &str = "mass matrix bordered by the constraints";

/// Ratio of a gap to its residual above which the gradient almost vanishes.
const STEEP: f64 = 1e4;

/// The reason why a step failed.
///
/// The integrator still holds the last good state, and a further call returns the same error.
#[derive(Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub enum StepError {
    /// No energy-preserving step exists past this point. This is a property of the method, not of the solver.
    NoForwardStep {
        /// Time of the last good node.
        t: f64,
        /// Length of the last good step.
        h: f64,
        /// `H(t, q, p) − E`. If a step exists, this is `h² D/8` to leading order.
        excess: f64,
        /// Step density D at the last good node.
        density: f64,
    },
    /// No energy-preserving Gauss step exists past this point: its step density vanishes or changes sign.
    NoForwardGaussStep {
        /// Time of the last good node.
        t: f64,
        /// Length of the last good step.
        h: f64,
        /// Stages s of the step.
        stages: usize,
        /// `H(t, q, p) − E'`. If a step exists, this is `C_s h^2s (D_s + D_*)` to leading order.
        excess: f64,
        /// Step density D_s at the last good node.
        density: f64,
        /// The shift D_*.
        shift: f64,
        /// The largest `|D_s|` of the run so far.
        largest: f64,
    },
    /// The shift of the step density adds more to the preserved energy than the energy itself, so that E' carries no
    /// information on it.
    ShiftTooLarge {
        /// Time of the last good node.
        t: f64,
        /// Length of the last good step.
        h: f64,
        /// The shift D_*.
        shift: f64,
        /// The energy that the shift adds, `C_s h^2s D_*`.
        part: f64,
        /// The size of the terms of H along the trajectory, `|v·p| + |H|`.
        size: f64,
        /// The step length at which the shift adds a tenth of that size.
        shorter: f64,
    },
    /// The step density vanishes, so that the step length is not determined.
    DegenerateStep {
        /// Time of the last good node.
        t: f64,
        /// Length of the last good step.
        h: f64,
        /// Step density D at the trial step.
        density: f64,
    },
    /// The length of the only forward step differs from that of the last step by more than the factor allowed.
    StepRatio {
        /// Time of the last good node.
        t: f64,
        /// Length of the last good step.
        previous: f64,
        /// Length of the step that solves the equations.
        found: f64,
    },
    /// No length of an adaptive step has the phase of the first step: the forces change too fast for it.
    LengthsLost {
        /// Time of the last good node.
        t: f64,
        /// Length of the last good step.
        h: f64,
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
    /// The Newton iteration ended above the rounding floor.
    NotConverged {
        /// Time at which the step, or the substep of a composition, begins.
        t: f64,
        /// Length of the trial step, or of the substep of a composition.
        h: f64,
        /// Number of iterations.
        iterations: u32,
        /// Last residual, in units of its rounding-error bound.
        residual: f64,
        /// The residuals of the last iterations.
        residuals: Residuals,
        /// The angle in degrees by which the gradient of a constraint turns in a step at the velocity of its start; zero
        /// without constraints. Beyond 57 degrees a step may not exist. A short number keeps errors small.
        turn: f32,
    },
    /// The step has no solution that continues those of short steps. Its equations may have another solution, which
    /// does not approximate the motion.
    TooLong {
        /// Time at which the step begins.
        t: f64,
        /// Length of the step.
        h: f64,
        /// A length to try, at which such a solution exists; positive, also if h is negative.
        longest: f64,
    },
    /// The stages of a Gauss step converged neither by fixed-point iteration nor by Newton iteration.
    StagesNotConverged {
        /// Time at which the step begins.
        t: f64,
        /// Length of the step.
        h: f64,
        /// Number of iterations.
        iterations: u32,
        /// The last update of a stage, in ulps of its coordinate.
        change: f64,
        /// Ratio of the last update to the one before.
        contraction: f64,
        /// Estimate of h ω, with ω the fastest rate of the equations linearized at the middle of the step.
        stiffness: f64,
    },
    /// The time scale g of `dt = g dτ` is not positive, not finite, or too small: the step does not change the time or
    /// does not preserve the energy.
    TimeScale {
        /// Time of this value.
        t: f64,
        /// Value of g.
        g: f64,
    },
    /// The method steps in transformed time, but the system has no time scale.
    NoTimeScale {
        /// Name of the system.
        system: &'static str,
    },
    /// The motion of the system does not split into kicks and drifts.
    NotSeparable {
        /// Name of the system.
        system: &'static str,
    },
    /// The method preserves the energy, but L contains a `monotone` table, at whose places the step density jumps.
    NoStepDensity {
        /// Name of the table.
        table: &'static str,
    },
    /// The method needs a quadrature rule, but the system declares none.
    NoRule {
        /// Name of the system.
        system: &'static str,
    },
    /// The equations of a step by the rule have too many terms, in a system of a text.
    RuleTooLarge {
        /// Name of the system.
        system: &'static str,
    },
    /// The system has constraints, which the method does not keep.
    HasConstraints {
        /// Name of the system.
        system: &'static str,
    },
    /// L is linear in the velocities: the system has no mass matrix, which the method or the quantity needs.
    FirstOrder {
        /// Name of the system.
        system: &'static str,
    },
    /// Two velocities have the same momenta: L is not defined at rest and has a branch on each side.
    Ambiguous {
        /// Time of this state.
        t: f64,
    },
    /// A matrix to invert is singular.
    Singular {
        /// Time of this state.
        t: f64,
        /// Name of the matrix.
        matrix: &'static str,
    },
    /// A start, a checkpoint or a state whose acceleration is requested does not satisfy a constraint.
    InconsistentStart {
        /// Name of the constraint.
        constraint: &'static str,
        /// `g(t, q)`, in the unit of the constraint; zero for a nonholonomic constraint.
        residual: f64,
        /// `A v + a`, with the velocity v of the momenta, in the unit of the constraint over time for a holonomic one. If
        /// the mass matrix is singular, the part of the momentum along the gradient that no velocity produces.
        rate: f64,
    },
    /// A constraint that followed from the others at the start, and was dropped, does not hold at the end of a step.
    DroppedConstraint {
        /// Time at the end of the step.
        t: f64,
        /// Name of the constraint.
        constraint: &'static str,
        /// `g(t, q)`, in the unit of the constraint, or `A v + a` of a nonholonomic constraint.
        residual: f64,
    },
    /// No state on the constraints was found from a guess: their residuals cannot shrink together past this point.
    NotAssembled {
        /// Time of the state.
        t: f64,
        /// The constraint that is farthest from being satisfied.
        constraint: &'static str,
        /// Its value g(t, x) at the last place, or at the guess of [`State::projected`](crate::State::projected), in its
        /// own unit.
        residual: f64,
        /// The length of the move along its gradient that would satisfy it, in the units of the coordinates.
        gap: f64,
        /// The part by which the residuals of the guess shrank, from 0 to 1; 0 for [`State::projected`](crate::State::projected).
        passed: f64,
    },
    /// A tangent vector does not satisfy the derivatives of a constraint and of its rate.
    InconsistentTangent {
        /// Time of the node.
        t: f64,
        /// Name of the constraint.
        constraint: &'static str,
        /// `A δq + g_t δt + g_θ δθ`, in the unit of the constraint; zero for a nonholonomic constraint.
        residual: f64,
        /// The multiplier of the gradient of the constraint in the part of the momenta that no admissible velocity
        /// produces.
        impulse: f64,
    },
    /// The constraints depend on each other at the start.
    Redundant {
        /// Name of a constraint that follows from the others.
        constraint: &'static str,
        /// The number of constraints.
        of: usize,
        /// The number of independent constraints.
        rank: usize,
    },
    /// No equilibrium was found near the guess.
    NoEquilibrium {
        /// Time of the equilibrium.
        t: f64,
        /// The coordinate whose force stayed largest, in units of its rounding-error bound.
        coordinate: &'static str,
        /// The force on this coordinate, in the units of the system.
        force: f64,
    },
    /// The stiffness matrix is singular: the forces at rest do not change along some direction.
    FreeMotion {
        /// Time of the equilibrium.
        t: f64,
        /// The coordinate that moves most along this direction.
        coordinate: &'static str,
    },
    /// A quantity is infinite or not a number.
    NonFinite {
        /// Time of this value.
        t: f64,
        /// Name of the quantity.
        quantity: &'static str,
        /// The subexpression of L or f that is not finite, if the system can name it.
        expression: Option<&'static str>,
    },
    /// A table or a Rust function in L or f has no value at an argument that the state or the trial step has.
    Undefined {
        /// Time of the last good node.
        t: f64,
        /// The function as it is written, with its arguments: `drag(v)`.
        function: &'static str,
        /// The argument, in its own unit.
        argument: f64,
        /// The range in which a table is given; `None` for a function that is not finite at the argument.
        range: Option<[f64; 2]>,
    },
    /// A one-directional event is at its zero at the start of the search, and its function passes zero again at the
    /// same instant. A ball at rest on its floor is an example.
    CannotLeave {
        /// Time at which the search begins.
        t: f64,
        /// Index of the event in the list given.
        event: usize,
        /// Value of the event function.
        value: f64,
        /// Time after which the function has passed zero again.
        within: f64,
    },
    /// The step has no derivative, or not the requested one.
    NoDerivative {
        /// Time at which the step begins.
        t: f64,
        /// The reason, with advice.
        because: &'static str,
    },
    /// The system has no parameter of the given name.
    UnknownParameter {
        /// Name of the system.
        system: &'static str,
        /// Names of its parameters.
        parameters: &'static [&'static str],
    },
    /// The checkpoint belongs to another system, or to another value of a parameter.
    OtherSystem {
        /// Name of the system to restart.
        system: &'static str,
        /// The parameter that differs; `None` if the systems, their rules or their tables differ.
        parameter: Option<&'static str>,
        /// Its value in the checkpoint; NaN if the systems differ.
        stored: f64,
        /// Its value in the system to restart; NaN if the systems differ.
        given: f64,
    },
    /// The relative error of a step exceeds the tolerance, or nothing moves whose error could be compared with it.
    Tolerance {
        /// Time at which the step begins.
        t: f64,
        /// Relative error of the step; infinite if its half steps have no solution, zero if nothing moves.
        estimate: f64,
        /// Largest error allowed.
        tolerance: f64,
    },
    /// An input is outside of its allowed range.
    InvalidInput {
        /// Name of the input.
        input: &'static str,
        /// Description of the allowed values.
        allowed: &'static str,
        /// Value given.
        value: f64,
    },
}

impl StepError {
    /// The reason with its numbers, without the advice, for programs with their own advice.
    #[must_use]
    pub fn reason(&self) -> impl fmt::Display + '_ {
        Reason(self)
    }
}

/// Displays a [`StepError`] without its advice; see [`StepError::reason`].
struct Reason<'a>(&'a StepError);

impl fmt::Display for Reason<'_> {
    #[allow(clippy::too_many_lines)] // one arm for each variant
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.0 {
            StepError::NoForwardStep { t, h, excess, density } => write!(
                f,
                "no energy-preserving step exists past t = {t:.9} (last h = {h:.3e}, H − E = {excess:.3e}, step density D = {density:.3e})"
            ),
            StepError::NoForwardGaussStep { t, h, stages, excess, density, shift, .. } => write!(
                f,
                "no energy-preserving step with s = {stages} exists past t = {t:.9} (last h = {h:.3e}, H − E = {excess:.3e}, step density D = {density:.3e}, shifted by {shift:.3e})"
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
            StepError::LengthsLost { t, h } => {
                write!(
                    f,
                    "no length of an adaptive step fits the forces after t = {t:.9} (last h = {h:.3e}): they change too fast"
                )
            }
            StepError::StepBounds { t, found, h_min, h_max } => write!(
                f,
                "the forward step from t = {t:.9} has h = {found:.3e}, outside the bounds {h_min:.3e} to {h_max:.3e}"
            ),
            StepError::NotConverged { t, h, iterations, residual, residuals, turn } => {
                if *h == 0.0 {
                    write!(f, "no velocity found for the momenta at t = {t:.9}")?;
                } else {
                    write!(f, "no solution found from t = {t:.9} with h = {h:.3e}")?;
                }
                write!(f, ": residual {residual:.3e} ulp after {iterations} iterations{residuals}")?;
                if *turn > 0.0 {
                    write!(f, " (a constraint turns by about {turn:.0} degrees in this step)")?;
                }
                Ok(())
            }
            StepError::TooLong { t, h, .. } => {
                write!(
                    f,
                    "the step from t = {t:.9} is too long: with h = {h:.3e} no solution continues those of short steps"
                )
            }
            StepError::StagesNotConverged { t, h, iterations, change, contraction, stiffness } => write!(
                f,
                "the Gauss stages did not converge from t = {t:.9} with h = {h:.3e}: update {change:.3e} ulp after {iterations} iterations (contraction {contraction:.2}, estimated h ω ≈ {stiffness:.3e})"
            ),
            StepError::TimeScale { t, g } if *g > 0.0 && g.is_finite() => {
                write!(
                    f,
                    "the time scale is g = {g:.3e} at t = {t:.9}, too small to advance the time or to preserve the energy"
                )
            }
            StepError::TimeScale { t, g } => {
                write!(f, "the time scale is g = {g:.3e} at t = {t:.9}, but it must be positive and finite")
            }
            StepError::NoTimeScale { system } => write!(f, "`{system}` has no time scale"),
            StepError::NotSeparable { system } => {
                write!(
                    f,
                    "the motion of `{system}` does not split into kicks and drifts: its mass matrix is not constant, or a force depends on velocities"
                )
            }
            StepError::NoStepDensity { table } => {
                write!(
                    f,
                    "the step density of energy-preserving steps jumps at the places of the `monotone` table `{table}`"
                )
            }
            StepError::NoRule { system } => write!(f, "`{system}` declares no quadrature rule"),
            StepError::RuleTooLarge { system } => {
                write!(f, "the equations of a step of `{system}` by its rule have too many terms")
            }
            StepError::HasConstraints { system } => {
                write!(f, "`{system}` has constraints, which this method does not keep")
            }
            StepError::FirstOrder { system } => {
                write!(f, "L of `{system}` is linear in the velocities: it has no mass matrix")
            }
            StepError::Ambiguous { t } => write!(f, "two velocities have the same momenta at t = {t:.9}"),
            StepError::Singular { t, matrix } => write!(f, "the {matrix} is singular at t = {t:.9}"),
            // Plus zero: −0 is 0.
            StepError::InconsistentStart { constraint, residual, rate } => write!(
                f,
                "the state does not satisfy the constraint `{constraint}`: residual {:.3e}, rate {:.3e}",
                residual + 0.0,
                rate + 0.0
            ),
            StepError::DroppedConstraint { t, constraint, residual } => {
                write!(f, "the dropped constraint `{constraint}` does not hold at t = {t:.9}: residual {residual:.3e}")
            }
            // The gap is the residual over the length of the gradient.
            StepError::NotAssembled { t, constraint, residual, gap, passed: 0.0 } if *gap > STEEP * residual.abs() => {
                write!(
                    f,
                    "the constraints cannot be satisfied from this guess at t = {t:.9}: `{constraint}` is {residual:.3e}, and its gradient almost vanishes there, as at the centre of a circle"
                )
            }
            StepError::NotAssembled { t, constraint, residual, gap, passed } => write!(
                f,
                "the constraints cannot be satisfied together from this guess at t = {t:.9}: `{constraint}` stays {residual:.3e}, a gap of {gap:.3e}, with {:.0} % of the residuals removed",
                100.0 * passed
            ),
            StepError::InconsistentTangent { t, constraint, residual, impulse } => write!(
                f,
                "a tangent vector at t = {t:.9} does not satisfy the constraint `{constraint}`: residual {residual:.3e}, impulse {impulse:.3e}"
            ),
            StepError::Redundant { constraint, rank: 0, .. } => {
                write!(
                    f,
                    "the gradient of the constraint `{constraint}` is zero at the start, as that of a rod without length"
                )
            }
            StepError::Redundant { constraint, of, rank } => write!(
                f,
                "the constraint `{constraint}` follows from the others: {rank} of {of} constraints are independent at the start"
            ),
            StepError::NoEquilibrium { t, coordinate, force } => write!(
                f,
                "no equilibrium was found near the guess at t = {t:.9}: the force {force:.3e} on `{coordinate}` is not balanced"
            ),
            StepError::FreeMotion { t, coordinate } => write!(
                f,
                "the stiffness matrix is singular at t = {t:.9}: the forces do not change along a motion of `{coordinate}`"
            ),
            StepError::NonFinite { t, quantity, expression: None } => {
                write!(f, "the {quantity} is not finite at t = {t:.9}")
            }
            StepError::NonFinite { t, quantity, expression: Some(expression) } => {
                write!(f, "the {quantity} is not finite at t = {t:.9}, because `{expression}` is not")
            }
            StepError::Undefined { t, function, argument, range: Some([from, to]) } => {
                write!(f, "`{function}` is given for {from} to {to}, not at {argument}, past t = {t:.9}")
            }
            StepError::Undefined { t, function, argument, range: None } => {
                write!(f, "`{function}` is not finite at {argument}, past t = {t:.9}")
            }
            StepError::CannotLeave { t, event, value, within } => write!(
                f,
                "the trajectory cannot leave the zero of event {event} at t = {t:.9}: its function is {value:.3e} and passes zero again within {within:.3e}"
            ),
            StepError::NoDerivative { t, because } => {
                write!(f, "the step from t = {t:.9} cannot be differentiated: {because}")
            }
            StepError::UnknownParameter { system, .. } => {
                write!(f, "`{system}` has no parameter of the given name")
            }
            StepError::OtherSystem { system, parameter: None, .. } => {
                write!(
                    f,
                    "the checkpoint belongs to another system than `{system}`, or to another rule, or to tables of other numbers"
                )
            }
            StepError::OtherSystem { system, parameter: Some(parameter), stored, given } => {
                write!(f, "the checkpoint of `{system}` was taken with `{parameter}` = {stored:e}, not {given:e}")
            }
            StepError::Tolerance { t, estimate: 0.0, tolerance } => {
                write!(
                    f,
                    "nothing moves from t = {t:.9} on, so that no step has an error to compare with {tolerance:.1e}"
                )
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

/// Advice if the error of a step is too large.
const SHORTER: &str = "; take shorter steps, a method of higher order, or allow a larger error";

impl fmt::Display for StepError {
    /// Writes the reason, then advice if there is any.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.reason().fmt(f)?;
        match self {
            Self::DegenerateStep { .. } => f.write_str(
                "; continue by `with_fallback(Fallback::FixedSteps)` or by fixed steps, or try longer steps, fewer stages, or another shift by `with_shift` of energy-preserving Gauss steps",
            ),
            Self::NoForwardStep { .. } | Self::StepRatio { .. } => f.write_str(
                "; start with a shorter step, or continue by `with_fallback(Fallback::FixedSteps)`, by `FixedStep` or `Gauss`, or by energy-preserving Gauss steps with a shift, which `with_shift_from(duration)` measures",
            ),
            Self::LengthsLost { .. } => f.write_str("; start with a shorter step or a smaller tolerance, or take `Gauss`"),
            Self::NoForwardGaussStep { largest, .. } => write!(
                f,
                "; start with a shorter step, use `with_shift_from(duration)`, or `with_shift({:.3e})`, which exceeds the largest |D| so far, another number of stages, `with_fallback(Fallback::FixedSteps)`, or `FixedStep` or `Gauss`",
                2.0 * largest
            ),
            Self::ShiftTooLarge { shorter, .. } => write!(f, "; start with steps of {shorter:.1e} or shorter"),
            // The advice is rounded outward, so that it allows the number itself.
            Self::StepBounds { found, h_max, .. } => write!(
                f,
                "; allow {:.3e} by `with_step_bounds`, or continue with steps of the bound by `with_fallback(Fallback::FixedSteps)`",
                if found > h_max { 1.001 * found } else { 0.999 * found }
            ),
            Self::NotConverged { h, .. } if *h == 0.0 => {
                f.write_str("; start from the momenta of a velocity, `system.at(t, q, v)`, or take shorter steps")
            }
            Self::StagesNotConverged { h, .. } if cfg!(not(feature = "alloc")) => {
                write!(f, "; take steps shorter than {:.3e}, or enable the feature `alloc` of vi-core", h.abs())
            }
            Self::NotConverged { h, .. } | Self::StagesNotConverged { h, .. } => {
                write!(f, "; take steps shorter than {:.3e}", h.abs())
            }
            Self::TooLong { longest, .. } => write!(f, "; try h = {longest:.3e}"),
            Self::TimeScale { g, .. } if *g > 0.0 && g.is_finite() => f.write_str(
                "; take shorter steps, end the run before, or write a `time_scale` that stays well above zero",
            ),
            Self::TimeScale { .. } => f.write_str("; take shorter steps, or write a `time_scale` that stays positive"),
            Self::NoTimeScale { .. } => {
                f.write_str("; write the clause `time_scale = …;` in its `lagrangian!`, or use `Gauss`")
            }
            Self::NotSeparable { .. } | Self::RuleTooLarge { .. } | Self::HasConstraints { .. } => {
                f.write_str("; take `Gauss`")
            }
            Self::FirstOrder { .. } => f.write_str("; it moves by `Gauss`"),
            Self::NoStepDensity { .. } => f.write_str("; make the table `cubic`, or take `FixedStep` or `Gauss`"),
            Self::NoRule { .. } => f.write_str("; add `discretize midpoint;` to its `lagrangian!`, or take `Gauss`"),
            Self::Ambiguous { .. } => {
                f.write_str("; L is not defined at rest and has a branch on each side: write an L with one branch")
            }
            Self::UnknownParameter { parameters, .. } if !parameters.is_empty() => {
                f.write_str("; its parameters are ")?;
                listed(f, parameters)
            }
            Self::OtherSystem { parameter: None, .. } => f.write_str("; restart its own system with its own rule, and with the files of its tables as they were"),
            Self::OtherSystem { .. } => f.write_str("; restart with the parameters of the checkpoint"),
            Self::CannotLeave { event, .. } => write!(
                f,
                "; set the velocity toward the zero to zero and change the system so that it stays at rest, or search without event {event}"
            ),
            Self::Tolerance { estimate, .. } => f.write_str(if *estimate > 0.0 { SHORTER } else { "; give a step length h" }),
            Self::Undefined { range: Some(_), .. } => f.write_str(
                "; write `hold` or `extend` in its `table`, add points, or stop the run before it leaves them",
            ),
            Self::Undefined { range: None, .. } => {
                f.write_str("; return a finite number there, or stop the run before it gets there")
            }
            Self::InconsistentStart { .. } => f.write_str(
                "; `State::projected(&system, t, q, v)` moves a state onto the constraints and returns how far",
            ),
            Self::DroppedConstraint { .. } => f.write_str(
                "; it follows from the others at the start only, or contradicts them: start elsewhere, or correct its lengths",
            ),
            Self::NotAssembled { constraint, passed, .. } => {
                write!(f, "; check lengths and anchors of `{constraint}` and its neighbours, or start from another guess")?;
                // Only `State::assembled` moves in parts.
                if *passed > 0.0 { Ok(()) } else { f.write_str(" (`State::assembled` takes far ones)") }
            }
            Self::InconsistentTangent { .. } => {
                f.write_str("; `Tangent::project` moves tangent vectors to admissible ones")
            }
            Self::Redundant { rank: 0, .. } => f.write_str("; correct its lengths, or start elsewhere"),
            Self::Redundant { constraint, .. } => write!(
                f,
                "; drop `{constraint}`, or integrate `Independent::at(system, t, q)`, which keeps an independent subset; start elsewhere if bars are in one line, where several motions may begin"
            ),
            Self::NoEquilibrium { coordinate, .. } => write!(
                f,
                "; start nearer to it, or set inputs and parameters so that the forces on `{coordinate}` can balance"
            ),
            Self::FreeMotion { coordinate, .. } => write!(
                f,
                "; start nearer to an equilibrium; if the equilibria form a family, hold `{coordinate}` by a weak spring"
            ),
            Self::Singular { matrix: BORDERED_MASS, .. } => f.write_str(
                "; there the constraints depend on each other, as at a dead point with bars in one line, where several motions may begin, or a motion along them has no mass: \
                 a step may pass such a place, but none ends there; take another length or time, or the iterator `events`, which passes it; \
                 a mechanism with more constraints than it needs moves as `Independent::at(system, t, q)`",
            ),
            Self::Singular { .. }
            | Self::NonFinite { .. }
            | Self::NoDerivative { .. }
            | Self::UnknownParameter { .. }
            | Self::InvalidInput { .. } => Ok(()),
        }
    }
}

/// Writes names in code, with commas.
fn listed(f: &mut fmt::Formatter<'_>, names: &[&str]) -> fmt::Result {
    for (index, name) in names.iter().enumerate() {
        write!(f, "{}`{name}`", if index == 0 { "" } else { ", " })?;
    }
    Ok(())
}

impl core::error::Error for StepError {}

/// The last residuals of an iteration that did not converge, in units of their rounding-error bounds.
///
/// They show whether the iteration stalled, wandered or was cut short.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Residuals {
    /// The newest residual is last. Unused entries are negative.
    kept: [f64; Self::KEPT],
}

impl Residuals {
    /// Number of residuals kept.
    pub const KEPT: usize = 6;

    /// An empty list.
    pub(crate) fn new() -> Self {
        Self { kept: [-1.0; Self::KEPT] }
    }

    /// Adds the newest residual, and ignores one that is not finite.
    pub(crate) fn push(&mut self, residual: f64) {
        if residual.is_finite() {
            self.kept.rotate_left(1);
            if let Some(newest) = self.kept.last_mut() {
                *newest = residual;
            }
        }
    }

    /// The residuals, the oldest first.
    pub fn iter(&self) -> impl Iterator<Item = f64> + '_ {
        self.kept.iter().copied().filter(|residual| *residual >= 0.0)
    }
}

#[cfg(feature = "serde")]
impl serde::Serialize for Residuals {
    fn serialize<W: serde::Serializer>(&self, serializer: W) -> Result<W::Ok, W::Error> {
        serializer.collect_seq(self.iter())
    }
}

impl fmt::Display for Residuals {
    /// Writes `, last residuals 1.2e3, 4.5e2`, or nothing for an empty list.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (index, residual) in self.iter().enumerate() {
            write!(f, "{}{residual:.1e}", if index == 0 { ", last residuals " } else { ", " })?;
        }
        Ok(())
    }
}
