//! The discrete energies of a step.
//!
//! The stages of a step of length h from a node give its energies at both ends, relative to `base`:
//!
//! ```text
//! E0 =  D1 L_d + g_d⁻ = Σ b_i En_i − h Σ b_i (1 − c_i) (f·v − L_t)_i
//! E1 = −D3 L_d − g_d⁺ = Σ b_i En_i + h Σ b_i c_i (f·v − L_t)_i
//! ```
//!
//! Nearby energies subtract exactly, so that the sum loses no digits.

use super::fixed_point::Equations;
use super::general::equations;
use super::points::ErasedSystem;
use super::rounding;
use super::stages::{Stages, stage};
use super::tableau::Tableau;
use crate::motion::Motion;
use crate::node::Node;
use crate::real::{Real, Rounded};
use crate::stepping::Convertible;
use nalgebra::SVector;

/// The energies of a step relative to `base`, and the size of their terms; see the [module](self).
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Energies<T = f64> {
    /// E0 − base.
    pub(crate) start: T,
    /// E1 − base.
    pub(crate) end: T,
    /// `E1 − E0`.
    pub(crate) work: T,
    /// The mean of `|v·p| + |En|` over the stages.
    pub(crate) size: T,
}

/// The energies relative to `base`, for the step of length h from `node` with the stages of its equations.
#[inline(always)]
pub(crate) fn energies<Y, const N: usize, const S: usize>(
    system: &Y,
    node: &Node<N>,
    h: f64,
    stages: Stages<N, S>,
    base: f64,
) -> Energies
where
    Y: Convertible<N>,
{
    let interval = SolvedStep::new(&ErasedSystem::of(system), node, h, stages);
    interval.energies(system, base, |number| number, |i| stage(&interval.velocities, i))
}

/// The energies in numbers with rounding-error bounds, at positions rounded to the nearest number. Velocities include
/// the rounding error of their forces: at an angle of thousands of turns these are accurate only to the ulp of the
/// angle.
pub(crate) fn bounded_energies<Y, const N: usize, const S: usize>(
    system: &Y,
    node: &Node<N>,
    h: f64,
    stages: Stages<N, S>,
    base: f64,
) -> Energies<Rounded>
where
    Y: Convertible<N>,
{
    let erased = ErasedSystem::of(system);
    let interval = SolvedStep::new(&erased, node, h, stages);
    let velocities = rounding::velocities(&erased, node, h, &interval.positions, &interval.velocities);
    interval.energies(&system.convert::<Rounded>(), base, Rounded::nearest, |i| velocities[i])
}

/// A step with its stage positions and velocities.
struct SolvedStep<'a, const N: usize, const S: usize> {
    node: &'a Node<N>,
    h: f64,
    positions: Stages<N, S>,
    velocities: Stages<N, S>,
}

impl<'a, const N: usize, const S: usize> SolvedStep<'a, N, S> {
    #[inline(always)]
    fn new(system: &ErasedSystem<'_, N>, node: &'a Node<N>, h: f64, stages: Stages<N, S>) -> Self {
        let equations = equations(system, node, h, stages);
        Self { node, h, positions: equations.start(), velocities: equations.velocity() }
    }

    #[inline(always)]
    fn energies<T: Real, Y: Motion<N, T>>(
        &self,
        system: &Y,
        base: f64,
        number: impl Fn(f64) -> T + Copy,
        velocity: impl Fn(usize) -> SVector<T, N>,
    ) -> Energies<T> {
        let Tableau { b, c, .. } = const { &Tableau::<S>::VALUES };
        let mut mean = T::zero();
        let mut size = T::zero();
        let mut done = T::zero();
        let mut left = T::zero();
        for i in 0..S {
            let t = number(self.node.t + (self.node.t_low + self.h * c[i]));
            let q = SVector::from_fn(|k, _| number(self.positions[k][i]));
            let v = velocity(i);
            let energy = system.energy(t, &q, &v);
            mean += T::real(b[i]) * (energy - T::real(base));
            size += T::real(b[i]) * (v.dot(&system.momentum(t, &q, &v)).abs() + energy.abs());
            if !system.conserves_energy() {
                let work = T::real(self.h * b[i]) * system.power(t, &q, &v);
                done += work * T::real(c[i]);
                left += work * T::real(1.0 - c[i]);
            }
        }
        Energies { start: mean - left, end: mean + done, work: done + left, size }
    }
}
