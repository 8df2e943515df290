//! The description of a run: an integrator with its options, and the initial state.
//!
//! In: the request of a command line, a scene or Python. Out: a [`Plan`].

use vi_core::lagrangian::Lagrangian;
use vi_core::run::Length;
use vi_core::{Composition, Splitting, Start as Begun, StepError, Tolerance};

/// The integrator.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// The variational integrator with a given step.
    Fixed,
    /// Five fixed steps composed to order 4.
    Suzuki4,
    /// Nine fixed steps composed to order 6.
    KahanLi6,
    /// Seventeen fixed steps composed to order 8.
    KahanLi8,
    /// Kicks and drifts of order 4, without equations to solve.
    Splitting4,
    /// Kicks and drifts of order 6.
    Splitting6,
    /// Gauss steps, of order 2S with S stages. They keep constraints.
    Gauss,
    /// Gauss steps whose length follows the motion.
    Adaptive,
    /// The integrator that solves for its own step and preserves the discrete energy.
    Energy,
}

/// Numbers of stages of Gauss steps built into the command, for each system: each costs a second or two of compile
/// time.
pub const STAGES: [usize; 2] = [4, 8];
/// The default number of stages: the most accurate steps for their time, for errors below 1e-6.
pub const DEFAULT_STAGES: usize = 8;

/// Numbers of stages of energy-preserving Gauss steps: with more, rounding hides their length.
pub const ENERGY_STAGES: [usize; 3] = [1, 2, 3];

/// The default number of stages of Gauss steps of systems with constraints.
pub const DEFAULT_BOUND_STAGES: usize = 3;
/// The default number of stages of their energy-preserving steps.
pub const DEFAULT_BOUND_ENERGY_STAGES: usize = 2;

impl Method {
    /// All integrators.
    pub const ALL: [Self; 9] = [
        Self::Fixed,
        Self::Suzuki4,
        Self::KahanLi6,
        Self::KahanLi8,
        Self::Splitting4,
        Self::Splitting6,
        Self::Gauss,
        Self::Adaptive,
        Self::Energy,
    ];

    /// Whether each step finds its length.
    #[must_use]
    pub fn finds_length(self) -> bool {
        matches!(self, Self::Energy | Self::Adaptive)
    }

    /// The scheme of a composition.
    #[must_use]
    pub fn scheme(self) -> Option<Composition> {
        match self {
            Self::Suzuki4 => Some(Composition::SUZUKI_4),
            Self::KahanLi6 => Some(Composition::KAHAN_LI_6),
            Self::KahanLi8 => Some(Composition::KAHAN_LI_8),
            _ => None,
        }
    }

    /// The scheme of a splitting.
    #[must_use]
    pub fn splitting(self) -> Option<Splitting> {
        match self {
            Self::Splitting4 => Some(Splitting::BLANES_MOAN_4),
            Self::Splitting6 => Some(Splitting::BLANES_MOAN_6),
            _ => None,
        }
    }
}

/// The first interval of the energy-preserving integrator.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Start {
    /// The first interval begins at the initial state, as with `integrate`.
    #[default]
    State,
    /// The initial state is the midpoint of the first interval.
    Midpoint,
    /// The first interval ends at the exact solution at t0 + h, as in the paper.
    Points,
}

impl Start {
    /// All starts.
    pub const ALL: [Self; 3] = [Self::State, Self::Midpoint, Self::Points];
}

/// A choice by name, in a command line, a scene or Python.
pub trait Named: Copy + 'static {
    /// All values.
    const VALUES: &'static [Self];
    /// Names of earlier versions, which files may hold.
    const ALIASES: &'static [(&'static str, Self)] = &[];

    /// The name.
    #[must_use]
    fn name(self) -> &'static str;

    /// The value in words.
    #[must_use]
    fn about(self) -> &'static str;

    /// The value of this name, if there is one.
    #[must_use]
    fn named(name: &str) -> Option<Self> {
        let alias = || Self::ALIASES.iter().find(|(alias, _)| *alias == name).map(|(_, value)| *value);
        Self::VALUES.iter().copied().find(|value| value.name() == name).or_else(alias)
    }
}

impl Named for Method {
    const VALUES: &'static [Self] = &Self::ALL;
    const ALIASES: &'static [(&'static str, Self)] = &[("gauss-lobatto", Self::Gauss)];

    fn name(self) -> &'static str {
        match self {
            Self::Fixed => "fixed",
            Self::Suzuki4 => "suzuki-4",
            Self::KahanLi6 => "kahan-li-6",
            Self::KahanLi8 => "kahan-li-8",
            Self::Splitting4 => "splitting-4",
            Self::Splitting6 => "splitting-6",
            Self::Gauss => "gauss",
            Self::Adaptive => "adaptive",
            Self::Energy => "energy",
        }
    }

    fn about(self) -> &'static str {
        match self {
            Self::Fixed => "The variational integrator with a given step",
            Self::Suzuki4 => "Five fixed steps composed to order 4, by Suzuki",
            Self::KahanLi6 => "Nine fixed steps composed to order 6, by Kahan and Li",
            Self::KahanLi8 => "Seventeen fixed steps composed to order 8, by Kahan and Li",
            Self::Splitting4 => "Kicks and drifts of order 4, by Blanes and Moan, for forces of the coordinates alone",
            Self::Splitting6 => "Kicks and drifts of order 6, by Blanes and Moan, for forces of the coordinates alone",
            Self::Gauss => "Gauss steps, of order 2S for --stages S; they keep constraints",
            Self::Adaptive => "Gauss steps whose length follows the forces along the motion; they keep constraints",
            Self::Energy => "The integrator that solves for its own step and preserves the discrete energy",
        }
    }
}

impl Named for Start {
    const VALUES: &'static [Self] = &Self::ALL;

    fn name(self) -> &'static str {
        match self {
            Self::State => "state",
            Self::Midpoint => "midpoint",
            Self::Points => "points",
        }
    }

    fn about(self) -> &'static str {
        match self {
            Self::State => "The first interval begins at the initial state",
            Self::Midpoint => "The initial state is the midpoint of the first interval",
            Self::Points => "The first interval ends at the exact solution at t0 + h, as in the paper",
        }
    }
}

/// The shift D_* of the step density.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shift {
    /// A given value.
    Of(f64),
    /// Twice the largest step density over this time from the start.
    Over(f64),
}

/// An integrator of a system: method, stages, and whether it uses transformed time.
pub type Built = (Method, Option<usize>, bool);

/// The description of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// The integrator.
    pub method: Method,
    /// The start of the energy-preserving integrator without stages and shift; unused by others.
    pub start: Start,
    /// The stages of Gauss steps or of energy-preserving ones, such as the system has.
    pub stages: Option<usize>,
    /// The shift of energy-preserving steps.
    pub shift: Option<Shift>,
    /// Whether to take fixed steps if there is no energy-preserving one.
    pub fallback: bool,
    /// The Gauss step in transformed time.
    pub dtau: Option<f64>,
    /// The step, or the first one.
    pub h: f64,
    /// The largest error of a step over the first oscillations, which determines the step in place of `h`.
    pub tolerance: Option<f64>,
    /// Initial time.
    pub t: f64,
    /// Initial coordinates.
    pub q: Vec<f64>,
    /// Initial velocities; unused with momenta.
    pub v: Vec<f64>,
    /// Initial momenta, in place of the velocities.
    pub p: Option<Vec<f64>>,
}

impl Plan {
    /// A run with steps of length h from a point, with the defaults of the method.
    #[must_use]
    pub fn new(method: Method, h: f64, PhasePoint { t, q, v }: PhasePoint) -> Self {
        let (start, shift, tolerance) = (Start::default(), None, None);
        Self { method, start, stages: None, shift, fallback: false, dtau: None, h, tolerance, t, q, v, p: None }
    }

    /// Steps of a method, with its default stages or with these, whose starts and lengths are given elsewhere.
    #[must_use]
    pub fn anywhere(method: Method, stages: Option<usize>) -> Self {
        let nowhere = PhasePoint { t: f64::NAN, q: Vec::new(), v: Vec::new() };
        Self { stages, ..Self::new(method, f64::NAN, nowhere) }
    }

    /// The rule for the length of a step.
    #[must_use]
    pub fn length(&self) -> StepLength {
        self.tolerance.map_or(StepLength::Given(self.h), StepLength::Found)
    }

    /// Whether the lengths of the steps in time are known after them only.
    #[must_use]
    pub fn finds_length(&self) -> bool {
        self.method.finds_length() || self.dtau.is_some()
    }

    /// The integrator of this plan for a system with or without constraints.
    #[must_use]
    pub fn wanted(&self, has_constraints: bool) -> Built {
        (self.method, self.energy_stages().or(self.gauss_stages(has_constraints)), self.dtau.is_some())
    }

    /// The stages of Gauss steps of a system with or without constraints; `None` for other methods.
    #[must_use]
    pub fn gauss_stages(&self, has_constraints: bool) -> Option<usize> {
        self.usual_stages(has_constraints)
            .map(|usual| self.stages.unwrap_or(usual))
            .filter(|_| self.method != Method::Energy)
    }

    /// The default number of stages of its method, for a system with or without constraints.
    #[must_use]
    pub fn usual_stages(&self, has_constraints: bool) -> Option<usize> {
        match (self.method, has_constraints) {
            (Method::Gauss | Method::Adaptive, true) => Some(DEFAULT_BOUND_STAGES),
            (Method::Gauss | Method::Adaptive, false) => Some(DEFAULT_STAGES),
            (Method::Energy, true) => Some(DEFAULT_BOUND_ENERGY_STAGES),
            _ => None,
        }
    }

    /// The stages of energy-preserving steps with [`EnergyPreservingGauss`](vi_core::EnergyPreservingGauss); `None` for steps with [`EnergyPreserving`](vi_core::EnergyPreserving).
    #[must_use]
    pub fn energy_stages(&self) -> Option<usize> {
        self.stages.or(self.shift.map(|_| 1)).filter(|_| self.method == Method::Energy)
    }
}

/// The length of a step, or what it follows from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StepLength {
    /// A given length.
    Given(f64),
    /// The tolerance of the error of a step.
    Found(f64),
}

impl Length<f64> for StepLength {
    fn tolerance(&self) -> Option<f64> {
        match self {
            Self::Given(_) => None,
            Self::Found(tolerance) => Some(*tolerance),
        }
    }

    fn length<M: vi_core::Method<S, N>, S: Lagrangian<N> + Copy, const N: usize>(
        self,
        start: &Begun<S, N>,
        method: &M,
    ) -> Result<f64, StepError> {
        match self {
            Self::Given(h) => Ok(h),
            Self::Found(tolerance) => Tolerance(tolerance).length(start, method),
        }
    }
}

/// A point of a trajectory.
#[derive(Clone, Debug, PartialEq)]
pub struct PhasePoint {
    /// Time.
    pub t: f64,
    /// Coordinates.
    pub q: Vec<f64>,
    /// Velocities.
    pub v: Vec<f64>,
}
