//! The continuous system from `lagrangian!`, in `(t, q, v)` and in `(t, q, p)`.

use crate::error::StepError;
use crate::real::Real;
use nalgebra::SVector;

/// What a coordinate is: configurations are the product of lines, circles and rotations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Space {
    /// A number, declared by `coord`.
    Line,
    /// An angle, declared by `angle`: L and f are 2π-periodic in it, and a run reduces it.
    Circle,
    /// A component of a unit quaternion, declared by `rotation`: this one of four coordinates in a row, scalar first.
    Rotation(usize),
}

impl Space {
    /// Whether the coordinate is an angle.
    #[must_use]
    #[inline(always)]
    pub const fn is_angle(self) -> bool {
        matches!(self, Self::Circle)
    }
}

/// The continuous system: Lagrangian `L(t, q, v)` and generalized force `f(t, q, v)`.
pub trait Lagrangian<const N: usize, T: Real = f64> {
    /// Name of the system, as declared.
    const NAME: &'static str;
    /// Names of the coordinates, as declared.
    const COORDINATES: [&'static str; N];
    /// Whether L and f are both independent of time.
    const AUTONOMOUS: bool;
    /// Whether there is a generalized force.
    const FORCED: bool;
    /// For each coordinate, whether it appears neither in L nor has a force. Its momentum is then conserved.
    const CYCLIC: [bool; N];
    /// What each coordinate is, as declared.
    const SPACES: [Space; N] = [Space::Line; N];
    /// Names of the parameters, as declared.
    const PARAMETERS: &'static [&'static str] = &[];
    /// Indices in [`Lagrangian::PARAMETERS`] of the inputs, the parameters that `input` declares for a controller to
    /// set, in ascending order.
    const INPUTS: &'static [usize] = &[];

    /// The name of a `monotone` table in L, if there is one. The step density jumps at its places, so that
    /// energy-preserving methods refuse the system.
    const MONOTONE_TABLE: Option<&'static str> = None;
    /// A digest of the numbers of its tables, which a checkpoint holds; 0 without tables.
    const TABLES: u32 = 0;
    /// Whether an interpreter evaluates the system. The functions below then return its facts, while its constants are
    /// the weakest claims. Gauss steps evaluate all stages by one call, which costs more than an operation.
    const INTERPRETED: bool = false;

    /// [`Lagrangian::NAME`]. This function and those below return their constants, except those of a system that is
    /// known at run time only.
    fn name(&self) -> &'static str {
        Self::NAME
    }
    /// [`Lagrangian::COORDINATES`].
    fn coordinates(&self) -> [&'static str; N] {
        Self::COORDINATES
    }
    /// [`Lagrangian::AUTONOMOUS`].
    #[inline(always)]
    fn is_autonomous(&self) -> bool {
        Self::AUTONOMOUS
    }
    /// [`Lagrangian::FORCED`].
    #[inline(always)]
    fn is_forced(&self) -> bool {
        Self::FORCED
    }
    /// Whether the energy is constant along a motion: neither L depends on time, nor is there a force.
    #[inline(always)]
    fn conserves_energy(&self) -> bool {
        self.is_autonomous() && !self.is_forced()
    }
    /// [`Lagrangian::CYCLIC`].
    fn cyclic(&self) -> [bool; N] {
        Self::CYCLIC
    }
    /// [`Lagrangian::SPACES`].
    #[inline(always)]
    fn spaces(&self) -> [Space; N] {
        Self::SPACES
    }
    /// [`Lagrangian::PARAMETERS`].
    #[inline(always)]
    fn parameters(&self) -> &'static [&'static str] {
        Self::PARAMETERS
    }
    /// [`Lagrangian::INPUTS`].
    fn inputs(&self) -> &'static [usize] {
        Self::INPUTS
    }
    /// [`Lagrangian::TABLES`].
    fn tables(&self) -> u32 {
        Self::TABLES
    }
    /// [`Lagrangian::MONOTONE_TABLE`].
    fn monotone_table(&self) -> Option<&'static str> {
        Self::MONOTONE_TABLE
    }

    /// The value of the parameter of this index in [`Lagrangian::PARAMETERS`].
    fn parameter(&self, _index: usize) -> T {
        T::zero()
    }
    /// L(t, q, v).
    fn lagrangian(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> T;
    /// Energy `v·∂L/∂v − L`.
    fn energy(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> T;
    /// Momentum `∂L/∂v`.
    fn momentum(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> SVector<T, N>;
    /// Generalized force f; zero if none is declared.
    fn force(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> SVector<T, N>;
    /// Acceleration `a = (∂²L/∂v²)⁻¹ (L_q + f − L_vt − L_vq v)`; with constraints together with their reaction.
    ///
    /// # Errors
    /// [`StepError::Singular`] if the mass matrix is singular, [`StepError::NonFinite`] if a derivative of L or f is
    /// not finite, [`StepError::InconsistentStart`] at a point off the constraints.
    fn acceleration(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Result<SVector<T, N>, StepError>;
    /// The flow at `(t, q, p)`: the velocity of p, and the rates of change of p and E.
    ///
    /// If L is quadratic in the velocities, v follows from p by the mass matrix; otherwise by Newton iteration from
    /// rest.
    ///
    /// # Errors
    /// [`StepError::Singular`] if the mass matrix is singular, [`StepError::NotConverged`] if no velocity has these
    /// momenta, [`StepError::NonFinite`].
    fn flow(&self, t: T, q: &SVector<T, N>, p: &SVector<T, N>) -> Result<Flow<N, T>, StepError>;
    /// The first subexpression of L and f that is not finite at `(t, q, v)`, as text, with inner expressions before
    /// outer ones.
    ///
    /// `None` if everything is finite, and for systems that do not implement it.
    fn non_finite(&self, _t: T, _q: &SVector<T, N>, _v: &SVector<T, N>) -> Option<&'static str> {
        None
    }
    /// The first table or Rust function in L and f that has no value at `(t, q, v)`, although its arguments are finite.
    ///
    /// `None` if all have one, and for systems without them.
    fn undefined(&self, _t: T, _q: &SVector<T, N>, _v: &SVector<T, N>) -> Option<Undefined> {
        None
    }
}

/// A function without a value at an argument.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Undefined {
    /// The function as it is written, with its arguments: `drag(v)`.
    pub function: &'static str,
    /// The argument, in its own unit.
    pub argument: f64,
    /// The range in which a table is given; `None` for a function that is not finite at the argument.
    pub range: Option<[f64; 2]>,
}

/// The rates of change at `(t, q, p)`: Hamilton's equations with a force.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Flow<const N: usize, T = f64> {
    /// `dq/dt = v`, the root of `∂L/∂v(t, q, v) = p`.
    pub v: SVector<T, N>,
    /// `dp/dt = L_q + f`.
    pub force: SVector<T, N>,
    /// `dE/dt = −L_t + f·v`.
    pub power: T,
}

/// The declaration of a system in words, and its text.
pub trait Described {
    /// Documentation of the system.
    const ABOUT: &'static str;
    /// Documentation of each parameter, in the order of [`Lagrangian::PARAMETERS`].
    const PARAMETERS_ABOUT: &'static [&'static str];
    /// The body of its `lagrangian!`, as tokens.
    const DEFINITION: &'static str;

    /// Whether the equations of a step by its rule are too large for a system that is known at run time only.
    #[doc(hidden)]
    fn has_too_large_rule(&self) -> bool {
        false
    }
    /// [`Described::ABOUT`]; this function and the next two return their constants, except those of a system that is
    /// known at run time only.
    fn about(&self) -> &'static str {
        Self::ABOUT
    }
    /// [`Described::PARAMETERS_ABOUT`].
    fn parameters_about(&self) -> &'static [&'static str] {
        Self::PARAMETERS_ABOUT
    }
    /// [`Described::DEFINITION`].
    fn definition(&self) -> &'static str {
        Self::DEFINITION
    }
}

/// The parameters of a system, by name; [`Lagrangian::PARAMETERS`] lists them.
pub trait Parameters<T: Real = f64> {
    /// The parameter of this name, for reading and writing.
    fn parameter_mut(&mut self, name: &str) -> Option<&mut T>;
}
