//! Composition: fixed steps of order 4, 6 and 8 from a symmetric rule of order 2.
//!
//! The system needs a symmetric rule (midpoint, trapezoidal). With weights `γ_i` of sum 1, one step consists of the
//! fixed steps `γ_1 h, γ_2 h, …`:
//!
//! ```text
//! Φ_h = φ_{γ_s h} ∘ … ∘ φ_{γ_1 h}        γ_i = γ_{s+1−i}
//! ```
//!
//! A composition inherits symplecticity, symmetry and conserved momenta from its substeps. Above order 2 some weights
//! must be negative. These negative substeps amplify damped modes. A midpoint composition of `a = −c v` is unstable in
//! bands of `c h`, the first of which begin at 1.13 (triple jump), 3.02 (Suzuki 4), 2.73 (Kahan–Li 6) and 3.30
//! (Kahan–Li 8). Beyond them it does not approximate the solution. The section "Compositions and damping" of `vi-lab
//! stability` shows the growth factor of a step and the bands.
//!
//! Source: Hairer, Lubich, Wanner, Geometric Numerical Integration, section V.3; Kahan and Li, Mathematics of
//! Computation 66 (1997) 1089.

use super::fixed::check_steps;
use super::{Change, Facts, Memory, Method, Problem, Status};
use crate::branch::Branch;
use crate::called::Called;
use crate::error::StepError;
use crate::momentum::steps::{Corrector, Steps};
use crate::node::Node;
use crate::real::{Real, Scalar};
use crate::run::{Hermite, Run};
use crate::state::State;
use crate::stepping::FixedStepping;
use alloc::vec::Vec;
use nalgebra::SVector;

/// A symmetric composition of fixed steps. See the [module](self).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Composition {
    /// Its name.
    pub name: &'static str,
    /// Its order, for a symmetric rule of order 2.
    pub order: u32,
    /// The weights `γ_i`, whose sum is 1.
    pub weights: &'static [f64],
}

impl Composition {
    /// Triple jump of order 4 (Yoshida; Suzuki): the fewest substeps, the largest errors.
    pub const TRIPLE_JUMP_4: Self = Self {
        name: "triple jump 4",
        order: 4,
        weights: &[1.351_207_191_959_657_8, -1.702_414_383_919_315_5, 1.351_207_191_959_657_8],
    };
    /// Suzuki's fractal composition of order 4, five substeps.
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
    /// Kahan and Li's composition of order 6, nine substeps.
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
    /// Kahan and Li's composition of order 8, seventeen substeps.
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
    /// All compositions, by order and number of substeps.
    pub const ALL: [Self; 4] = [Self::TRIPLE_JUMP_4, Self::SUZUKI_4, Self::KAHAN_LI_6, Self::KAHAN_LI_8];

    /// Lengths of the substeps of a step of the length h.
    pub(super) fn lengths<T: Real>(&self, h: T) -> impl Iterator<Item = T> + '_ {
        self.weights.iter().map(move |weight| h * T::real(*weight))
    }
}

/// Memory of a composition: each substep is extrapolated from the same substep of earlier steps.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: Real + serde::Serialize", deserialize = "T: Real + serde::Deserialize<'de>"))
)]
pub struct Substeps<const N: usize, T = f64> {
    pub(crate) all: Vec<Steps<N, T>>,
    /// Newton iterations of the last step.
    iterations: u32,
}

impl<const N: usize, T> Substeps<N, T> {
    fn of(all: Vec<Steps<N, T>>) -> Self {
        Self { all, iterations: 0 }
    }
}

impl<const N: usize, T: Scalar> Memory for Substeps<N, T> {}

/// A solved step.
#[derive(Clone, Debug)]
pub struct CompositionSolution<const N: usize, T = f64> {
    after: Node<N, T>,
    /// The updated memory of the substeps.
    substeps: Vec<Steps<N, T>>,
    iterations: u32,
}

impl<S, const N: usize, T> Method<S, N, T> for Composition
where
    S: FixedStepping<N, T>,
    T: Scalar,
{
    type Prepared = Vec<Corrector<S::Jacobian, N, T>>;
    type Memory = Substeps<N, T>;
    /// The old memory of the substeps, reused as a buffer for the next step.
    type Cache = Vec<Steps<N, T>>;
    type Step = CompositionSolution<N, T>;
    type Left = StepError;
    type DenseOutput = Hermite<N, T>;

    fn facts(&self) -> Facts {
        Facts { order: self.order, rule: S::RULE, ..Facts::default() }
    }

    fn prepare(&self, system: &S, h: T) -> Self::Prepared {
        self.lengths(h).map(|h| Corrector::of(&Called(*system), h)).collect()
    }

    fn begin(&self, system: &S, node: &mut Node<N, T>, h: T) -> Result<Substeps<N, T>, StepError> {
        let v = node.state().velocity(system)?;
        Ok(Substeps::of(self.lengths(h).map(|h| Steps::new(h, v)).collect()))
    }

    fn attempt(
        &self,
        at: Problem<'_, S, Self::Prepared, N, T>,
        memory: &Substeps<N, T>,
        cache: &mut Self::Cache,
    ) -> Result<Self::Step, StepError> {
        let Problem { system, prepared, node, .. } = at;
        let mut after = *node;
        let mut substeps = core::mem::take(cache);
        substeps.clone_from(&memory.all);
        let mut last = None;
        let mut iterations = 0;
        for (substep, corrector) in substeps.iter_mut().zip(prepared) {
            // Before the first step, each substep starts from the velocity of the one before.
            if let Some(v) = last.filter(|_| substep.is_new()) {
                *substep = Steps::new(substep.h, v);
            }
            let h = substep.h;
            let solved = match substep.corrected(system, &after, corrector, substep.guess()) {
                Some(solved) => solved,
                None => substep
                    .searched(&Called(*system), &after, Branch::Nearest)
                    .map_err(|failure| failure.explained(system, &after, h, &substep.v()))?,
            };
            after.advance(h, &solved.v, &solved.increment);
            after.check_finite(node.t)?;
            substep.push(&solved);
            iterations += solved.iterations;
            last = Some(solved.v);
        }
        Ok(CompositionSolution { after, substeps, iterations })
    }

    fn recover(
        &self,
        _at: Problem<'_, S, Self::Prepared, N, T>,
        _memory: &Substeps<N, T>,
        _cache: &mut Self::Cache,
        left: StepError,
    ) -> Result<Self::Step, StepError> {
        Err(left)
    }

    fn take(
        &self,
        _system: &S,
        _h: T,
        (node, memory): (&mut Node<N, T>, &mut Substeps<N, T>),
        cache: &mut Self::Cache,
        step: Self::Step,
    ) {
        *node = step.after;
        *cache = core::mem::replace(&mut memory.all, step.substeps);
        memory.iterations = step.iterations;
    }

    fn restarted(
        &self,
        system: &S,
        change: &Change<'_, S, N, T>,
        node: &mut Node<N, T>,
        h: T,
        memory: &Substeps<N, T>,
    ) -> Result<Substeps<N, T>, StepError> {
        let substeps = memory.all.iter();
        match change {
            Change::NewLength => {
                Ok(Substeps::of(substeps.zip(self.lengths(h)).map(|(substep, h)| substep.with_length(h)).collect()))
            }
            Change::NewSystem(_) => {
                node.state().velocity(system)?;
                Ok(Substeps::of(substeps.map(|substep| substep.with_other_parameters()).collect()))
            }
            Change::NewState(..) => change.begun(self, system, node, h),
        }
    }

    fn dense_output(
        &self,
        system: &S,
        before: &State<N, T>,
        node: &Node<N, T>,
        h: T,
        _memory: &Substeps<N, T>,
    ) -> Result<Hermite<N, T>, StepError> {
        Hermite::between(system, before, &node.state(), h)
    }

    fn status(&self, h: T, memory: &Substeps<N, T>) -> Status<T> {
        let residual = memory.all.iter().map(|substep| substep.measured().roundings()).fold(0.0, f64::max);
        Status { residual, iterations: memory.iterations, ..Status::of_length(h) }
    }

    fn check(&self, _system: &S, (node, memory): (&Node<N, T>, &Substeps<N, T>), h: T) -> Result<(), StepError> {
        let mut substeps = memory.all.iter();
        let is_of_scheme = self.lengths(h).all(|h| substeps.next().is_some_and(|substep| substep.h == h));
        if !is_of_scheme || substeps.next().is_some() {
            #[allow(clippy::cast_precision_loss)] // a few substeps
            let value = memory.all.len() as f64;
            let allowed = "those of the composition of the restarted run";
            return Err(StepError::InvalidInput { input: "the substeps of a checkpoint", allowed, value });
        }
        memory.all.iter().try_for_each(|substep| check_steps(substep, substep.h, node.t))
    }
}

impl<S, const N: usize, T> Run<Composition, S, N, T>
where
    S: FixedStepping<N, T>,
    T: Scalar,
{
    /// Velocities of the substeps of the last step, in order. Before the first step, the velocity of the momenta.
    pub fn velocities(&self) -> impl Iterator<Item = SVector<T, N>> + '_ {
        self.memory.all.iter().map(Steps::v)
    }
}
