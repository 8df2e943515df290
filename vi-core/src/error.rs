//! Every way in which a step can fail, with its numbers.

use core::fmt;

/// Why a step was not taken. The integrator still holds the last good state, and a further call returns the same error.
#[derive(Clone, Copy, Debug, PartialEq)]
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
    /// Newton's iteration ended above the rounding floor.
    NotConverged {
        /// Time of the last good node.
        t: f64,
        /// Length of the trial step.
        h: f64,
        /// Iterations spent.
        iterations: u32,
        /// Residual left, in units of rounding.
        residual: f64,
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

impl fmt::Display for StepError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoForwardStep { t, h, excess, density } => write!(
                f,
                "no energy-preserving step leads forward from t = {t:.9} (last h = {h:.3e}, H − E = {excess:.3e}, step density D = {density:.3e})"
            ),
            Self::DegenerateStep { t, h, density } => write!(
                f,
                "the step length is not determined at t = {t:.9} (last h = {h:.3e}, step density D = {density:.3e})"
            ),
            Self::StepRatio { t, previous, found } => write!(
                f,
                "the forward step from t = {t:.9} has h = {found:.3e} after {previous:.3e}, beyond the allowed factor of 3"
            ),
            Self::NotConverged { t, h, iterations, residual } => write!(
                f,
                "no solution found from t = {t:.9} with h = {h:.3e}: residual {residual:.3e} roundings after {iterations} iterations"
            ),
            Self::Singular { t, matrix } => write!(f, "the {matrix} is singular at t = {t:.9}"),
            Self::NonFinite { t, quantity } => write!(f, "the {quantity} is not finite at t = {t:.9}"),
            Self::InvalidInput { input, allowed, value } => write!(f, "{input} must be {allowed}, not {value}"),
        }
    }
}

impl core::error::Error for StepError {}
