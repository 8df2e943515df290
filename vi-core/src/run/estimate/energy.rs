//! A conserved H along a run: it shows a motion that is lost although every step looks accurate.

use super::FAINT;
use crate::lagrangian::{Flow, Lagrangian};
use crate::method::Method;
use crate::real::Scalar;
use crate::run::Run;
use nalgebra::SVector;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

/// Relative change of H since the start from which on the motion counts as lost. The energy errors of steps that resolve a
/// motion oscillate below it.
const DRIFTED: f64 = 0.01;
/// Change of H in an escape from which on the motion counts as lost, relative to H and to the geometric mean of `Σ |p
/// v|`.
const BROKEN: f64 = 0.03;
/// Ratio of `Σ |p v|` to its mean above which the motion has only become faster so far.
const RISEN: f64 = 2.0;
/// Ratio of `Σ |p v|` to its largest value before its present rise above which the motion is an escape.
const ESCAPED: f64 = 100.0;

/// A conserved H along a run, and the energies that it is compared with.
#[derive(Clone, Copy, Debug)]
pub(super) struct EnergyPath {
    /// H at the start.
    start: f64,
    /// Start, and end of the last window.
    from: f64,
    until: f64,
    /// `Σ |p v|` there.
    action: f64,
    /// The time integral of `Σ |p v|`, by the smaller value of each window: a near collision counts for its own time only.
    integral: f64,
    /// The time integral of the logarithm of `Σ |p v|`, and the time without rest, in which the logarithm exists.
    logarithms: f64,
    moving: f64,
    /// The largest `Σ |p v|` so far, and the largest one before its present rise.
    largest: f64,
    before: f64,
    /// Whether `Σ |p v|` has a mean: it does not only rise.
    has_mean: bool,
}

impl EnergyPath {
    /// The path from the current node of a run. `None` if H changes along the motion, or has no value.
    pub(super) fn from<M: Method<S, N, T>, S: Lagrangian<N, T> + Copy, const N: usize, T: Scalar>(
        run: &Run<M, S, N, T>,
    ) -> Option<Self> {
        let Energies { energy, action, .. } = Energies::at(run)?;
        let t = run.node.t.to_f64();
        Some(Self {
            start: energy,
            from: t,
            until: t,
            action,
            integral: 0.0,
            logarithms: 0.0,
            moving: 0.0,
            largest: action,
            before: action,
            has_mean: false,
        })
    }

    /// `|H − H(start)|` at the current node of a run, in two units:
    ///
    /// * relative to `Σ |p v|`: its mean so far, or its present value if that is larger, in the first window also that
    ///   at its start, since it may end at a turning point; zero up to [`DRIFTED`];
    /// * in an escape, in which `Σ |p v|` is [`ESCAPED`] times its largest value before the present rise: relative to
    ///   the geometric mean of `Σ |p v|`, or to `|H(start)|` if that is larger; zero up to [`BROKEN`]. It holds for the
    ///   present state only: after a near collision the energy returns.
    ///
    /// Both are zero for rounding, and in the first rise of `Σ |p v|`, as in a fall from rest: it has no mean yet.
    pub(super) fn drift<M: Method<S, N, T>, S: Lagrangian<N, T> + Copy, const N: usize, T: Scalar>(
        &mut self,
        run: &Run<M, S, N, T>,
    ) -> [f64; 2] {
        let Some(Energies { energy, action, terms }) = Energies::at(run) else { return [0.0; 2] };
        let t = run.node.t.to_f64();
        let (least, duration) = (self.action.min(action), (t - self.until).abs());
        let is_first = self.integral == 0.0;
        self.integral += least * duration;
        if least > 0.0 {
            self.logarithms += least.ln() * duration;
            self.moving += duration;
        }
        if action < self.action {
            self.before = self.largest;
        }
        self.largest = self.largest.max(action);
        let most = if is_first { self.action.max(action) } else { action };
        (self.until, self.action) = (t, action);
        let mean = self.integral / (t - self.from).abs();
        self.has_mean |= action <= RISEN * mean;
        let size = if mean < most { most } else { mean };
        let change = (energy - self.start).abs();
        let is_visible = change > FAINT * T::EPSILON * (self.start.abs() + terms);
        if !(self.has_mean && is_visible) {
            return [0.0; 2];
        }
        let usual = (self.logarithms / self.moving).exp().max(self.start.abs());
        let part = |size: f64, from: f64| if change > from * size { change / size } else { 0.0 };
        let escapes = action > ESCAPED * self.before;
        [part(size, DRIFTED), if escapes { part(usual, BROKEN) } else { 0.0 }]
    }
}

/// Energies at a node: H, `Σ |p v|`, and the size of the terms whose rounding errors H has.
struct Energies {
    energy: f64,
    action: f64,
    terms: f64,
}

impl Energies {
    fn at<M: Method<S, N, T>, S: Lagrangian<N, T> + Copy, const N: usize, T: Scalar>(
        Run { method, system, node, .. }: &Run<M, S, N, T>,
    ) -> Option<Self> {
        if !system.conserves_energy() || method.facts().has_reactions {
            return None;
        }
        let Flow { v, force, .. } = system.flow(node.t, &node.q, &node.p).ok()?;
        let energy = system.energy(node.t, &node.q, &v).to_f64();
        let sum = |a: &SVector<T, N>, b: &SVector<T, N>| (0..N).map(|i| (a[i] * b[i]).to_f64().abs()).sum::<f64>();
        let action = sum(&node.p, &v);
        let terms = energy.abs() + action + sum(&force, &node.q);
        terms.is_finite().then_some(Self { energy, action, terms })
    }
}
