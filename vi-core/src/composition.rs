//! Composition: fixed steps of order 4, 6 and 8 from a symmetric rule of order 2.
//!
//! In: a system whose rule is symmetric (midpoint, trapezoidal), an initial state, a step `h`, a [`Scheme`] of weights
//! `γ_i` with `Σ γ_i = 1`. Out: an iterator of states; one step is the fixed steps `γ_1 h, γ_2 h, …` one after the other.
//!
//! ```text
//! Φ_h = φ_{γ_s h} ∘ … ∘ φ_{γ_1 h}        γ_i = γ_{s+1−i}
//! ```
//!
//! It keeps what its parts keep: symplecticity, symmetry, conserved momenta. Some weights are negative, as they must be
//! above order 2: those substeps go backwards in time, and there damping feeds. A midpoint composition of `a = −c v`
//! is unstable in bands of `c h`, the first of which begin at 1.13 (triple jump), 3.02 (Suzuki 4), 2.73 (Kahan–Li 6) and
//! 3.30 (Kahan–Li 8), and beyond them it is no approximation: the section "Compositions and damping" of `vi-lab stability`
//! shows the factor of a step, and the bands.
//!
//! Source: Hairer, Lubich, Wanner, Geometric Numerical Integration, section V.3; Kahan and Li, Mathematics of Computation
//! 66 (1997) 1089.

use crate::branch::Branch;
use crate::called::Called;
use crate::checkpoint;
use crate::error::StepError;
use crate::fixed_step::check_step;
use crate::integrator::{Hermite, Integrator, changed, own};
use crate::momentum::steps::{Corrector, Steps};
use crate::node::Node;
use crate::real::{Real, Scalar};
use crate::state::State;
use crate::stepping::FixedStepping;
use nalgebra::SVector;

/// A symmetric composition.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scheme {
    /// Its name.
    pub name: &'static str,
    /// Its order, of a symmetric rule of order 2.
    pub order: u32,
    /// The weights `γ_i`, whose sum is 1.
    pub weights: &'static [f64],
}

impl Scheme {
    /// Triple jump of order 4 (Yoshida; Suzuki): the fewest substeps, the largest errors.
    pub const TRIPLE_JUMP_4: Self = Self {
        name: "triple jump 4",
        order: 4,
        weights: &[1.351_207_191_959_657_8, -1.702_414_383_919_315_5, 1.351_207_191_959_657_8],
    };
    /// Suzuki's fractal of order 4, five substeps.
    pub const SUZUKI_4: Self = Self {
        name: "Suzuki 4",
        order: 4,
        weights: &[
            0.414_490_771_794_375_7,
            0.414_490_771_794_375_7,
            -0.657_963_087_177_502_8,
            0.414_490_771_794_375_7,
            0.414_490_771_794_375_7,
        ],
    };
    /// Kahan and Li's of order 6, nine substeps.
    pub const KAHAN_LI_6: Self = Self {
        name: "Kahan–Li 6",
        order: 6,
        weights: &[
            0.392_161_444_007_314_1,
            0.332_599_136_789_359_43,
            -0.706_246_172_557_639_3,
            0.082_213_596_293_550_8,
            0.798_543_990_934_830_1,
            0.082_213_596_293_550_8,
            -0.706_246_172_557_639_3,
            0.332_599_136_789_359_43,
            0.392_161_444_007_314_1,
        ],
    };
    /// Kahan and Li's of order 8, seventeen substeps.
    pub const KAHAN_LI_8: Self = Self {
        name: "Kahan–Li 8",
        order: 8,
        weights: &[
            0.130_202_483_088_890_07,
            0.561_162_981_775_108_4,
            -0.389_474_962_644_847_27,
            0.158_841_906_555_155_6,
            -0.395_903_894_133_237_57,
            0.184_539_640_978_315_7,
            0.258_374_387_686_322_04,
            0.295_011_723_609_310_3,
            -0.605_508_533_830_034_6,
            0.295_011_723_609_310_3,
            0.258_374_387_686_322_04,
            0.184_539_640_978_315_7,
            -0.395_903_894_133_237_57,
            0.158_841_906_555_155_6,
            -0.389_474_962_644_847_27,
            0.561_162_981_775_108_4,
            0.130_202_483_088_890_07,
        ],
    };
    /// All of them, by order and number of substeps.
    pub const ALL: [Self; 4] = [Self::TRIPLE_JUMP_4, Self::SUZUKI_4, Self::KAHAN_LI_6, Self::KAHAN_LI_8];
}

/// Fixed steps of higher order; see the [module](self).
#[derive(Clone, Debug)]
pub struct Composition<S, const N: usize, T = f64>
where
    S: FixedStepping<N, T>,
    T: Real,
{
    system: S,
    scheme: Scheme,
    h: T,
    node: Node<N, T>,
    /// The substeps: each is predicted from itself in the whole steps before.
    substeps: Vec<Steps<N, T>>,
    /// The substeps after the whole step that is under way.
    following: Vec<Steps<N, T>>,
    correctors: Vec<Corrector<S::Jacobian, N, T>>,
    failure: Option<StepError>,
}

/// What a run of [`Composition`] carries from step to step.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: Real + serde::Serialize", deserialize = "T: Real + serde::Deserialize<'de>"))
)]
pub struct Run<const N: usize, T = f64> {
    h: T,
    node: Node<N, T>,
    substeps: Vec<Steps<N, T>>,
}

/// Everything that a run of [`Composition`] carries but its scheme, to be stored and resumed bit for bit.
pub type Checkpoint<const N: usize, T = f64> = checkpoint::Checkpoint<Run<N, T>, T>;

impl<S, const N: usize, T> Composition<S, N, T>
where
    S: FixedStepping<N, T>,
    T: Scalar,
{
    /// The composition of fixed steps of `system` from `state`, with the whole step `h`, in units of time.
    ///
    /// # Errors
    /// As [`FixedStep::new`](crate::FixedStep::new).
    pub fn new(system: S, scheme: Scheme, state: State<N, T>, h: T) -> Result<Self, StepError> {
        check_step(h)?;
        let node = Node::new(state, T::zero());
        let v = state.velocity(&system)?;
        let substeps = lengths(scheme, h).map(|h| Steps::new(h, v)).collect();
        Ok(Self::prepared(system, scheme, Run { h, node, substeps }))
    }

    /// With what is the same in every step.
    fn prepared(system: S, scheme: Scheme, run: Run<N, T>) -> Self {
        let Run { h, node, substeps } = run;
        let correctors = substeps.iter().map(|substep| Corrector::of(&Called(system), substep.h)).collect();
        Self { system, scheme, h, node, following: substeps.clone(), substeps, correctors, failure: None }
    }

    /// Everything that the run carries but its scheme, to be stored and resumed bit for bit. Allocates.
    pub fn checkpoint(&self) -> Checkpoint<N, T> {
        checkpoint::Checkpoint::of(&self.system, S::RULE, self.run())
    }

    /// The run that was at `checkpoint`, bit for bit.
    ///
    /// # Errors
    /// [`StepError::OtherSystem`] for a checkpoint of another system or of other parameters; [`StepError::InvalidInput`] for one of another scheme;
    /// [`StepError::NonFinite`] and [`StepError::InvalidInput`] for one that no run can have left.
    pub fn restart(system: S, scheme: Scheme, checkpoint: Checkpoint<N, T>) -> Result<Self, StepError> {
        let run = checkpoint.run_of(&system, S::RULE)?;
        check_step(run.h)?;
        let t = if run.node.t.to_f64().is_finite() { run.node.t } else { T::zero() };
        run.node.check_finite(t)?;
        let mut steps = run.substeps.iter();
        let is_of_scheme = lengths(scheme, run.h).all(|h| steps.next().is_some_and(|substep| substep.h == h));
        if !is_of_scheme || steps.next().is_some() {
            #[allow(clippy::cast_precision_loss)] // a few substeps
            let value = run.substeps.len() as f64;
            let allowed = "those of the scheme that the run is restarted with";
            return Err(StepError::InvalidInput { input: "the substeps of a checkpoint", allowed, value });
        }
        if !run.substeps.iter().all(Steps::is_finite) {
            return Err(StepError::NonFinite { t: t.to_f64(), quantity: "last velocity", expression: None });
        }
        Ok(Self::prepared(system, scheme, run))
    }

    /// What the run carries.
    fn run(&self) -> Run<N, T> {
        Run { h: self.h, node: self.node, substeps: self.substeps.clone() }
    }

    /// The run with substeps of another whole step, of which the last velocities are the first guesses.
    fn with_length(&self, h: T) -> Self {
        let substeps = self.substeps.iter().zip(lengths(self.scheme, h)).map(|(substep, h)| substep.with_length(h));
        Self::prepared(self.system, self.scheme, Run { h, node: self.node, substeps: substeps.collect() })
    }

    /// Takes one whole step of the length `h` instead of the next one; the step of the run stays. Allocates.
    ///
    /// # Errors
    /// As [`Composition::step`], and [`StepError::InvalidInput`] for an h that is zero, subnormal or not finite; the run is then what it was, and
    /// may go on.
    pub fn step_of(&mut self, h: T) -> Result<State<N, T>, StepError> {
        if let Some(failure) = self.failure {
            return Err(failure);
        }
        check_step(h)?;
        let mut aside = self.with_length(h);
        let state = aside.step()?;
        *self = aside.with_length(self.h);
        Ok(state)
    }

    /// Takes one whole step and returns the state reached.
    ///
    /// # Errors
    /// That of the substep that fails, as [`FixedStep::step`](crate::FixedStep::step); the state is then that before the
    /// whole step. The same error again after an error.
    pub fn step(&mut self) -> Result<State<N, T>, StepError> {
        if let Some(failure) = self.failure {
            return Err(failure);
        }
        self.advance().inspect_err(|failure| self.failure = Some(*failure))
    }

    /// The state reached last.
    pub fn state(&self) -> State<N, T> {
        self.node.state()
    }

    /// The node reached last: the state with the low parts of its sums. Its energy has no meaning.
    pub fn node(&self) -> &Node<N, T> {
        &self.node
    }

    /// The system.
    pub fn system(&self) -> &S {
        &self.system
    }

    /// The whole step, in units of time.
    pub fn h(&self) -> T {
        self.h
    }

    /// Velocities of the substeps of the last whole step, one after the other; before the first step the velocity that belongs to
    /// the momenta.
    pub fn velocities(&self) -> impl Iterator<Item = SVector<T, N>> + '_ {
        self.substeps.iter().map(Steps::v)
    }

    /// Whether the last step was taken with the parameters that the system has.
    pub(crate) fn has_parameters_of_last(&self) -> bool {
        self.substeps.iter().all(Steps::has_parameters_of_last)
    }

    /// Largest residual of the substeps of the last whole step, measured at the velocities that were taken, in roundings; see
    /// [`FixedStep::residual`](crate::FixedStep::residual). Zero before the first step.
    pub fn residual(&self) -> f64 {
        self.substeps.iter().map(|substep| substep.measured().roundings()).fold(0.0, f64::max)
    }

    /// The weights.
    pub fn scheme(&self) -> Scheme {
        self.scheme
    }

    fn advance(&mut self) -> Result<State<N, T>, StepError> {
        let (mut node, system, called) = (self.node, &self.system, &Called(self.system));
        // Before the first whole step the velocities of the substeps are not known: each follows the one before.
        let mut before = None;
        self.following.copy_from_slice(&self.substeps);
        for (substep, corrector) in self.following.iter_mut().zip(&self.correctors) {
            if let Some(v) = before.filter(|_| substep.is_new()) {
                *substep = Steps::new(substep.h, v);
            }
            let h = substep.h;
            let solved = match substep.corrected(system, &node, corrector, substep.guess()) {
                Some(solved) => solved,
                None => substep
                    .searched(called, &node, Branch::Nearest)
                    .map_err(|failure| failure.explained(system, &node, h, &substep.v()))?,
            };
            node.advance(h, &solved.v, &solved.increment);
            node.check_finite(self.node.t)?;
            substep.push(&solved);
            before = Some(solved.v);
        }
        self.node = node;
        core::mem::swap(&mut self.substeps, &mut self.following);
        Ok(self.state())
    }
}

/// Lengths of the substeps.
fn lengths<T: Real>(scheme: Scheme, h: T) -> impl Iterator<Item = T> {
    scheme.weights.iter().map(move |weight| h * T::real(*weight))
}

impl<S, const N: usize> Integrator<N> for Composition<S, N>
where
    S: FixedStepping<N>,
{
    type System = S;
    type Path = Hermite<N>;
    type Checkpoint = Checkpoint<N>;

    const LONGEST: f64 = 1.0;

    own!(step, step_of, node, system, h, checkpoint);

    fn discrete_energy(&self) -> Option<f64> {
        None
    }

    fn set_parameters(&mut self, change: impl FnOnce(&mut S)) -> Result<(), StepError> {
        let system = changed(&self.system, change)?;
        self.state().velocity(&system)?;
        let substeps = self.substeps.iter().map(|substep| substep.with_other_parameters()).collect();
        *self = Self::prepared(system, self.scheme, Run { substeps, ..self.run() });
        Ok(())
    }

    fn set_state(&mut self, state: State<N>) -> Result<(), StepError> {
        *self = Self::new(self.system, self.scheme, state, self.h)?;
        Ok(())
    }

    fn path(&self, before: &State<N>) -> Result<Hermite<N>, StepError> {
        Hermite::between(&self.system, before, &self.state(), self.h())
    }

    fn set_time(&mut self, t: f64) {
        self.node.set_time(t);
    }
}

impl<S, const N: usize, T> Iterator for Composition<S, N, T>
where
    S: FixedStepping<N, T>,
    T: Scalar,
{
    type Item = Result<State<N, T>, StepError>;

    fn next(&mut self) -> Option<Self::Item> {
        Some(self.step())
    }
}
