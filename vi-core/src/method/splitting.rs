//! Splitting: explicit steps of order 2, 4 and 6 from kicks and drifts.
//!
//! For `L = v·M v/2 − V(t, q)` with constant M, and forces of time and coordinates alone, the motion splits into two that
//! are solved exactly: kicks change the momenta at fixed coordinates, drifts move the coordinates at fixed momenta. With
//! weights b_i and a_i of sum 1 each,
//!
//! ```text
//! kick     p ← p + b_i h F(t, q)        F = L_q + f
//! drift    q ← q + a_i h M⁻¹ p          t ← t + a_i h
//! ```
//!
//! A step is symmetric; without force it is symplectic, and it preserves momenta of cyclic coordinates bit for bit. It
//! solves no equation, and evaluates no derivative of F: it pays for many coordinates with cheap forces. Nyström's
//! conditions, of which there are fewer than those of other splittings, hold because kicks of constant M commute with
//! their second commutators.
//!
//! A Hamiltonian system of first order, `L = y·x' − T(y) − V(t, x)`, splits in the same way: kicks change y and the momenta
//! `p = y` by `b_i h (f − V_x)`, drifts change x by `a_i h T_y`. Its weights have to satisfy the conditions of all
//! splittings.
//!
//! The increments of a step are summed by themselves and added to the node with their low parts: roundings of a step are
//! those of its increments, as with [`Gauss`](crate::Gauss).
//!
//! Source: Blanes and Moan, J. Comput. Appl. Math. 142 (2002) 313, tables 2 to 4; Hairer, Lubich, Wanner, Geometric
//! Numerical Integration, section V.3.

use super::{Change, Facts, Memory, Method, Problem, Status};
use crate::error::StepError;
use crate::first_order::check_momenta;
use crate::linear::Matrix;
use crate::motion::{Motion, Separable};
use crate::node::Node;
use crate::real::{Real, Scalar};
use crate::run::Hermite;
use crate::state::State;
use nalgebra::SVector;
use vi_dispatch::{Instructions, Loop};

/// Largest difference of a sum of weights from 1: published weights have fifteen digits.
const WHOLE: f64 = 1e-13;
/// The highest order that weights may claim.
const HIGHEST: u32 = 32;

/// A symmetric splitting into kicks and drifts. See the [module](self).
///
/// ```
/// use vi_core::prelude::*;
/// use vi_core::lagrangian;
///
/// lagrangian! {
///     struct Chain {
///         coord x[8];
///         L = sum(i in 0..8, dot(x[i])^2 / 2 - x[i]^2 / 2) - sum(i in 0..7, (x[i + 1] - x[i])^4 / 4);
///     }
/// }
///
/// # fn main() -> Result<(), StepError> {
/// let start = Chain::default().at(0.0, [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0; 8]);
/// let mut run = start.integrate(Splitting::BLANES_MOAN_6, 0.25)?;
/// let state = run.until(10.0)?;
/// # assert!((state.energy(run.system())? - 0.75).abs() < 1e-6);
/// # Ok(())
/// # }
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Splitting {
    /// Its name. A checkpoint stores it.
    pub name: &'static str,
    /// Its order.
    pub order: u32,
    /// The weights b_i of the kicks, whose sum is 1; other weights are refused when a run begins.
    pub kicks: &'static [f64],
    /// The weights a_i of the drifts, whose sum is 1. The longer list begins: kick, drift, …, kick, or drift, kick, …,
    /// drift.
    pub drifts: &'static [f64],
    /// Whether it has this order for kinetic energies `v·M v/2` alone (Nyström's conditions). It is then refused for
    /// systems of first order.
    pub is_nystrom: bool,
}

impl Splitting {
    /// Störmer and Verlet's method of order 2, with one force a step.
    pub const VERLET: Self = Self { name: "Verlet", order: 2, kicks: &[0.5, 0.5], drifts: &[1.0], is_nystrom: false };
    /// Blanes and Moan's method of order 4, with six forces a step.
    pub const BLANES_MOAN_4: Self = Self {
        name: "Blanes–Moan 4",
        order: 4,
        kicks: &symmetric::<3, 7>([0.082_984_406_417_405_2, 0.396_309_801_498_368, -0.039_056_304_922_348_6]),
        drifts: &symmetric::<2, 6>([0.245_298_957_184_271, 0.604_872_665_711_08]),
        is_nystrom: true,
    };
    /// Blanes and Moan's method of order 4 for any kinetic energy, with six forces a step.
    pub const BLANES_MOAN_S4: Self = Self {
        name: "Blanes–Moan S4",
        order: 4,
        kicks: &symmetric::<3, 7>([0.079_203_696_431_195_7, 0.353_172_906_049_774, -0.042_065_080_357_719_5]),
        drifts: &symmetric::<2, 6>([0.209_515_106_613_362, -0.143_851_773_179_818]),
        is_nystrom: false,
    };
    /// Blanes and Moan's method of order 6 for any kinetic energy, with ten forces a step.
    pub const BLANES_MOAN_S6: Self = Self {
        name: "Blanes–Moan S6",
        order: 6,
        kicks: &symmetric::<5, 11>([
            0.050_262_764_400_392_2,
            0.413_514_300_428_344,
            0.045_079_889_794_397_7,
            -0.188_054_853_819_569,
            0.541_960_678_450_78,
        ]),
        drifts: &symmetric::<4, 10>([
            0.148_816_447_901_042,
            -0.132_385_865_767_784,
            0.067_307_604_692_185,
            0.432_666_402_578_175,
        ]),
        is_nystrom: false,
    };
    /// Blanes and Moan's method of order 6 with eleven forces a step.
    pub const BLANES_MOAN_6_SHORT: Self = Self {
        name: "Blanes–Moan 6, eleven forces",
        order: 6,
        kicks: &symmetric::<5, 12>([
            0.041_464_998_518_262_4,
            0.198_128_671_918_067,
            -0.040_006_192_104_153_3,
            0.075_253_984_301_580_7,
            -0.011_511_387_420_687_9,
        ]),
        drifts: &symmetric::<5, 11>([
            0.123_229_775_946_271,
            0.290_553_797_799_558,
            -0.127_049_212_625_417,
            -0.246_331_761_062_075,
            0.357_208_872_795_928,
        ]),
        is_nystrom: true,
    };
    /// Blanes and Moan's method of order 6 with fourteen forces a step: the smallest errors for their time.
    pub const BLANES_MOAN_6: Self = Self {
        name: "Blanes–Moan 6",
        order: 6,
        kicks: &symmetric::<6, 14>([
            0.091_719_152_624_461_65,
            0.183_983_170_005_006,
            -0.056_534_365_832_888_27,
            0.004_914_688_774_712_854,
            0.143_761_127_168_358,
            0.328_567_693_746_804,
        ]),
        drifts: &symmetric::<7, 15>([
            0.037_859_319_840_611_6,
            0.102_635_633_102_435,
            -0.025_867_888_266_558_7,
            0.314_241_403_071_447,
            -0.130_144_459_517_415,
            0.106_417_700_369_543,
            -0.008_794_243_128_510_58,
        ]),
        is_nystrom: true,
    };
    /// All splittings: those for a mass matrix by order and number of forces, then those for any kinetic energy.
    pub const ALL: [Self; 6] = [
        Self::VERLET,
        Self::BLANES_MOAN_4,
        Self::BLANES_MOAN_6_SHORT,
        Self::BLANES_MOAN_6,
        Self::BLANES_MOAN_S4,
        Self::BLANES_MOAN_S6,
    ];

    /// A number that differs between sets of weights.
    fn fingerprint(&self) -> f64 {
        self.kicks.iter().chain(&[1.0]).chain(self.drifts).fold(0.0, |sum, weight| 0.7 * sum + weight)
    }

    /// Whether a step begins and ends with a kick. The force at its end then serves the next step.
    const fn begins_with_kick(&self) -> bool {
        self.kicks.len() > self.drifts.len()
    }

    /// The number of forces of a step after the first.
    #[must_use]
    pub const fn forces(&self) -> usize {
        if self.begins_with_kick() { self.kicks.len() - 1 } else { self.kicks.len() }
    }
}

/// The weights of sum 1 that read the same from both ends and begin with these.
const fn symmetric<const FIRST: usize, const ALL: usize>(first: [f64; FIRST]) -> [f64; ALL] {
    let mut all = [0.0; ALL];
    let (mut i, mut sum) = (0, 0.0);
    while i < FIRST {
        (all[i], all[ALL - 1 - i]) = (first[i], first[i]);
        sum += first[i];
        i += 1;
    }
    let rest = if ALL.is_multiple_of(2) { 0.5 - sum } else { 1.0 - 2.0 * sum };
    (all[FIRST], all[ALL - 1 - FIRST]) = (rest, rest);
    all
}

/// Memory of a splitting.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: Real + serde::Serialize", deserialize = "T: Real + serde::Deserialize<'de>"))
)]
pub struct Kicked<const N: usize, T = f64> {
    /// The last force of the last step, at the node if steps begin with a kick. Zero before the first step, if they begin
    /// with a drift.
    force: SVector<T, N>,
    /// Fingerprint of the weights: a splitting with other weights cannot continue the run.
    fingerprint: f64,
}

impl<const N: usize, T: Scalar> Memory for Kicked<N, T> {}

/// Data shared by all steps of a run.
#[derive(Clone, Copy, Debug)]
pub struct Shared<I> {
    instructions: Instructions,
    /// M, factored.
    inverse: I,
}

/// A step.
#[derive(Clone, Copy, Debug)]
pub struct Split<const N: usize, T = f64> {
    after: Node<N, T>,
    /// The force at its end.
    force: SVector<T, N>,
}

impl<const N: usize, T: Real> Split<N, T> {
    /// Whether time, coordinates and momenta are finite, and with them all forces of the step.
    #[inline(always)]
    fn is_finite(&self) -> bool {
        // Zero times a number is zero, or NaN for one that is not finite. One sum then tests all entries.
        let Node { t, q, p, .. } = &self.after;
        let zeros = (q + p + self.force) * T::zero();
        (zeros.sum() + *t * T::zero()).is_finite()
    }
}

/// Kicks and drifts of one step.
struct KicksAndDrifts<'a, S: Motion<N, T>, const N: usize, T: Real> {
    scheme: &'a Splitting,
    system: &'a S,
    inverse: &'a <S::Mass as Matrix<N, T>>::Inverse,
    node: &'a Node<N, T>,
    h: T,
    /// The force at the node, if the step begins with a kick.
    force: &'a SVector<T, N>,
}

impl<S: Motion<N, T>, const N: usize, T: Real> Loop for KicksAndDrifts<'_, S, N, T> {
    type Output = Split<N, T>;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> Split<N, T> {
        let Self { scheme, system, inverse, node, h, .. } = self;
        let Splitting { kicks, drifts, .. } = scheme;
        // `L = y·x' − T(y) − V(t, x)`: L_x + f kicks the momenta of x, and with them y; −L_y is the velocity T_y of x.
        let is_canonical = const { S::INTERPRETED || !S::WITHOUT_VELOCITY.is_empty() } && system.is_first_order();
        let without = system.without_velocity();
        let half = |without_it: bool| (0..without.len()).filter(move |index| without[*index] == without_it);
        let moved = |of: &SVector<T, N>, from: bool, to: bool| {
            let mut moved = SVector::<T, N>::zeros();
            half(from).zip(half(to)).for_each(|(from, to)| moved[to] = of[from]);
            moved
        };
        let rest = SVector::zeros();
        // The next kick waits for q and p alone: both sums beside them are more accurate.
        let (mut q, mut p) = (node.q + node.q_low, node.p + node.p_low);
        let (mut displacement, mut increment) = (SVector::<T, N>::zeros(), SVector::<T, N>::zeros());
        let mut force = *self.force;
        // The first kick needs no drift.
        let first = kicks.len() - kicks.len().min(drifts.len());
        if let Some(weight) = kicks[..first].first() {
            let of_momenta = if is_canonical { moved(&force, false, false) } else { force };
            increment = of_momenta * (h * T::real(*weight));
            p += increment;
            if is_canonical {
                displacement = moved(&increment, false, true);
                q += displacement;
            }
        }
        let mut passed = 0.0;
        for (i, weight) in drifts.iter().enumerate() {
            // T depends on no time.
            let velocity = if is_canonical {
                moved(&-system.point(node.t, &q, &rest).force, true, false)
            } else {
                S::Mass::apply(inverse, &p)
            };
            let drift = velocity * (h * T::real(*weight));
            displacement += drift;
            let is_last = i + 1 == drifts.len();
            // The last place is rounded as the node is, so that the next step begins with the same force.
            q = if is_last { node.q + (node.q_low + displacement) } else { q + drift };
            passed = if is_last { 1.0 } else { passed + weight };
            let Some(weight) = kicks.get(first + i) else { break };
            force = system.point(node.t + (node.t_low + h * T::real(passed)), &q, &rest).force;
            let of_momenta = if is_canonical { moved(&force, false, false) } else { force };
            let kick = of_momenta * (h * T::real(*weight));
            p += kick;
            increment += kick;
            if is_canonical {
                let of_y = moved(&kick, false, true);
                displacement += of_y;
                q += of_y;
            }
        }
        let mut after = *node;
        after.advance_by(h, &displacement, &increment);
        Split { after, force }
    }
}

/// Takes a step inside the dispatched function.
struct Advancing<'a, S: Motion<N, T>, const N: usize, T: Real> {
    scheme: &'a Splitting,
    system: &'a S,
    inverse: &'a <S::Mass as Matrix<N, T>>::Inverse,
    h: T,
    node: &'a mut Node<N, T>,
    force: &'a mut SVector<T, N>,
}

impl<S: Motion<N, T>, const N: usize, T: Scalar> Loop for Advancing<'_, S, N, T> {
    type Output = Result<(), ()>;

    #[inline(always)]
    fn run<const FUSED: bool>(self) -> Result<(), ()> {
        let Self { scheme, system, inverse, h, node, force } = self;
        let step = KicksAndDrifts { scheme, system, inverse, node, h, force }.run::<FUSED>();
        if !step.is_finite() {
            return Err(());
        }
        *node = step.after;
        *force = step.force;
        Ok(())
    }
}

/// The force at a node.
fn force_at<S: Motion<N, T>, const N: usize, T: Real>(system: &S, node: &Node<N, T>) -> SVector<T, N> {
    system.point(node.t, &node.q, &SVector::zeros()).force
}

/// The error of a force that is not finite.
fn no_force(t: impl Real) -> StepError {
    StepError::NonFinite { t: t.to_f64(), quantity: "force", expression: None }
}

/// Checks that a force is finite.
///
/// # Errors
/// [`StepError::NonFinite`].
fn checked<const N: usize, T: Scalar>(force: &SVector<T, N>, t: T) -> Result<(), StepError> {
    let is_finite = force.iter().all(|entry| entry.is_finite());
    if is_finite { Ok(()) } else { Err(no_force(t)) }
}

/// One step from a node over any numbers.
pub(crate) fn step<S: Motion<N, T>, const N: usize, T: Real>(
    scheme: &Splitting,
    system: &S,
    (node, h): (&Node<N, T>, T),
) -> Node<N, T> {
    let inverse = &system.point(node.t, &node.q, &SVector::zeros()).mass.inverse();
    let force = if scheme.begins_with_kick() { force_at(system, node) } else { SVector::zeros() };
    KicksAndDrifts { scheme, system, inverse, node, h, force: &force }.run::<false>().after
}

impl<S: Separable<N, T>, const N: usize, T: Scalar> Method<S, N, T> for Splitting {
    type Prepared = Shared<<S::Mass as Matrix<N, T>>::Inverse>;
    type Memory = Kicked<N, T>;
    type Cache = ();
    type Step = Split<N, T>;
    type Left = ();
    type DenseOutput = Hermite<N, T>;

    fn facts(&self) -> Facts {
        Facts { order: self.order.clamp(1, HIGHEST), rule: Some(self.name), ..Facts::default() }
    }

    fn check_length(&self, system: &S, h: T) -> Result<(), StepError> {
        if !system.splits() {
            return Err(StepError::NotSeparable { system: system.name() });
        }
        if self.is_nystrom && system.is_first_order() {
            let allowed = "those of any kinetic energy: `VERLET`, `BLANES_MOAN_S4`, `BLANES_MOAN_S6`";
            let (input, value) = ("the weights of a splitting of first order", f64::from(self.order));
            return Err(StepError::InvalidInput { input, allowed, value });
        }
        let Self { kicks, drifts, .. } = self;
        if kicks.len().abs_diff(drifts.len()) != 1 {
            #[allow(clippy::cast_precision_loss)] // a few weights
            let value = kicks.len() as f64 - drifts.len() as f64;
            let (input, allowed) = ("the kicks of a splitting less its drifts", "1 or -1: they take turns");
            return Err(StepError::InvalidInput { input, allowed, value });
        }
        if !(1..=HIGHEST).contains(&self.order) {
            let (input, allowed) = ("the order of a splitting", "from 1 to 32");
            return Err(StepError::InvalidInput { input, allowed, value: f64::from(self.order) });
        }
        for (weights, input) in
            [(kicks, "the sum of the kicks of a splitting"), (drifts, "the sum of the drifts of a splitting")]
        {
            let value = weights.iter().sum::<f64>();
            // False for NaN.
            let is_whole = (value - 1.0).abs() < WHOLE;
            if !is_whole {
                return Err(StepError::InvalidInput { input, allowed: "1", value });
            }
        }
        super::check_step(h)
    }

    fn prepare(&self, system: &S, _h: T) -> Self::Prepared {
        let zeros = SVector::zeros();
        let inverse = system.point(T::zero(), &zeros, &zeros).mass.inverse();
        Shared { instructions: Instructions::detected(), inverse }
    }

    fn begin(&self, system: &S, node: &mut Node<N, T>, _h: T) -> Result<Kicked<N, T>, StepError> {
        check_momenta(system, node)?;
        node.state().velocity(system)?;
        let force = if self.begins_with_kick() { force_at(system, node) } else { SVector::zeros() };
        checked(&force, node.t)?;
        Ok(Kicked { force, fingerprint: self.fingerprint() })
    }

    #[inline(always)]
    fn attempt(
        &self,
        at: Problem<'_, S, Self::Prepared, N, T>,
        memory: &Kicked<N, T>,
        (): &mut (),
    ) -> Result<Split<N, T>, ()> {
        let Problem { system, prepared: Shared { instructions, inverse }, node, h } = at;
        let step = instructions.run(KicksAndDrifts { scheme: self, system, inverse, node, h, force: &memory.force });
        if step.is_finite() { Ok(step) } else { Err(()) }
    }

    /// Kicks and drifts, the test of their end and the advance in one dispatched function.
    #[inline(always)]
    fn advance(
        &self,
        system: &S,
        prepared: &Self::Prepared,
        h: T,
        (node, memory): (&mut Node<N, T>, &mut Kicked<N, T>),
        (): &mut (),
    ) -> Result<(), ()> {
        let Shared { instructions, inverse } = prepared;
        instructions.run(Advancing { scheme: self, system, inverse, h, node, force: &mut memory.force })
    }

    fn recover(
        &self,
        at: Problem<'_, S, Self::Prepared, N, T>,
        _memory: &Kicked<N, T>,
        (): &mut (),
        (): (),
    ) -> Result<Split<N, T>, StepError> {
        Err(no_force(at.node.t))
    }

    #[inline(always)]
    fn take(
        &self,
        _system: &S,
        _h: T,
        (node, memory): (&mut Node<N, T>, &mut Kicked<N, T>),
        (): &mut (),
        step: Split<N, T>,
    ) {
        *node = step.after;
        memory.force = step.force;
    }

    fn restarted(
        &self,
        system: &S,
        change: &Change<'_, S, N, T>,
        node: &mut Node<N, T>,
        h: T,
        memory: &Kicked<N, T>,
    ) -> Result<Kicked<N, T>, StepError> {
        if !matches!(change, Change::NewLength) {
            return change.begun(self, system, node, h);
        }
        // The node may be another one than that of the memory: a monitor halves steps that are past.
        let force = if self.begins_with_kick() { force_at(system, node) } else { memory.force };
        checked(&force, node.t)?;
        Ok(Kicked { force, ..*memory })
    }

    fn dense_output(
        &self,
        system: &S,
        before: &State<N, T>,
        node: &Node<N, T>,
        h: T,
        _memory: &Kicked<N, T>,
    ) -> Result<Hermite<N, T>, StepError> {
        Hermite::between(system, before, &node.state(), h)
    }

    #[allow(clippy::cast_possible_truncation)] // a few forces
    fn status(&self, h: T, _memory: &Kicked<N, T>) -> Status<T> {
        Status { iterations: self.forces() as u32, ..Status::of_length(h) }
    }

    fn check(&self, _system: &S, (node, memory): (&Node<N, T>, &Kicked<N, T>), _h: T) -> Result<(), StepError> {
        if memory.fingerprint.to_bits() != self.fingerprint().to_bits() {
            let (input, allowed) = ("the weights of a checkpoint", "those of the splitting of the restarted run");
            return Err(StepError::InvalidInput { input, allowed, value: memory.fingerprint });
        }
        checked(&memory.force, node.t)
    }
}
