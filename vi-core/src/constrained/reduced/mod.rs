//! Midpoint steps of point masses in a uniform field, in the impulses alone.
//!
//! With a constant diagonal M and a force F(t), the velocity is affine in the impulses λ, and k equations remain:
//!
//! ```text
//! v = M⁻¹(p0 + (h/2) F + A0ᵀλ)        g(t1, q0 + h v)/h = 0        S = A1 M⁻¹ A0ᵀ
//! p1 = p0 + h F + A0ᵀλ + A1ᵀμ         A1 M⁻¹ p1 + a1 = 0           S = A1 M⁻¹ A1ᵀ
//! ```
//!
//! S couples constraints that share a coordinate: three diagonals for a chain. Its pivots are positive for short steps,
//! in any order of elimination; the fewest couplings come first. The general solver takes steps with
//! a pivot that is not positive, a residual above the floor, or rows that fill S.

mod pattern;
mod schur;

use super::diagonal;
use super::equations::Configuration;
use super::solved::{NEARLY_SOLVED, Solved, contracted};
use crate::kind::Multipliers;
use crate::linear::{Rectangular, Row};
use crate::motion::Motion;
use crate::newton::FLOOR;
use crate::node::Node;
use crate::vector::worse;
use alloc::vec::Vec;
use nalgebra::SVector;
use pattern::{Part, Pattern, parts};
use schur::Schur;

/// The factors of S serve a further iteration if the residual fell by this factor.
const FALLEN: f64 = 0.1;
const ITERATIONS: u32 = 12;

/// Buffers and patterns of the solver. No result depends on them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Reduced {
    /// Coordinates of a point: a row of A has entries at all of them, or at none.
    dimension: usize,
    pattern: Pattern,
    schur: Schur,
    /// The diagonal of M⁻¹.
    inverse: Vec<f64>,
    /// A at the start of the step, and M⁻¹Aᵀ.
    first: Vec<f64>,
    weighted: Vec<f64>,
    /// A and a at the end of the step.
    last: Vec<f64>,
    rates: Vec<f64>,
    /// Coordinates of `last`.
    end: Vec<f64>,
    known: Vec<f64>,
    /// The terms of each row.
    scales: Vec<f64>,
}

impl Reduced {
    /// Allocates; `None` if the system needs the general solver.
    pub(crate) fn new<S: Motion<N>, const N: usize>(system: &S, node: &Node<N>) -> Option<Self> {
        let count = system.constraint_names().len();
        if !system.has_point_masses() || system.holonomic() < count {
            return None;
        }
        let (gradients, _) = system.constraint_gradients(node.t, &node.q);
        let (dimension, parts) = [3, 2, 1].into_iter().find_map(|d| Some((d, parts(&gradients, d)?)))?;
        let pattern = Pattern::new(parts);
        let schur = Schur::new(&pattern, count)?;
        let zeros = vec![0.0; pattern.parts.len() * dimension];
        let [first, weighted, last] = [zeros.clone(), zeros.clone(), zeros];
        let (inverse, end) = (vec![0.0; N], vec![f64::NAN; N]);
        let [rates, known, scales] = core::array::from_fn(|_| vec![0.0; count]);
        Some(Self { dimension, pattern, schur, inverse, first, weighted, last, rates, end, known, scales })
    }

    /// A and M⁻¹ at the start of a step. `is_next` if the step follows the last one of the same system. False if a mass
    /// is not positive.
    fn begin<S: Motion<N>, const N: usize, const D: usize>(
        &mut self,
        system: &S,
        node: &Node<N>,
        is_next: bool,
    ) -> bool {
        let is_known = is_next && node.q.as_slice() == self.end;
        self.end.fill(f64::NAN);
        if is_known {
            // Its end has divided A by the masses.
            core::mem::swap(&mut self.first, &mut self.last);
            return true;
        }
        let masses = diagonal(&system.point(node.t, &node.q, &SVector::zeros()).mass);
        for (inverse, mass) in self.inverse.iter_mut().zip(&masses) {
            *inverse = mass.recip();
        }
        let (gradients, _) = system.constraint_gradients(node.t, &node.q);
        write(&gradients, &mut self.first);
        weigh::<D>(&self.pattern, &self.inverse, &self.first, &mut self.weighted);
        self.inverse.iter().all(|inverse| *inverse > 0.0)
    }

    /// The velocity M⁻¹ p.
    #[inline(always)]
    fn velocity<const N: usize>(&self, p: &SVector<f64, N>) -> SVector<f64, N> {
        let mut v = *p;
        v.iter_mut().zip(&self.inverse).for_each(|(v, inverse)| *v *= inverse);
        v
    }

    /// Writes `A1 v + a1` to `known`.
    #[inline(always)]
    fn rate<const N: usize, const D: usize>(&mut self, v: &SVector<f64, N>) {
        self.known.copy_from_slice(&self.rates);
        self.pattern.add_products::<D>(&self.last, v.as_slice(), &mut self.known, |sum, term| sum + term);
    }

    /// Writes the sizes of the terms of `A1 x` to `scales`.
    #[inline(always)]
    fn scale<const N: usize, const D: usize>(&mut self, x: &SVector<f64, N>) {
        self.scales.fill(0.0);
        self.pattern.add_products::<D>(&self.last, x.as_slice(), &mut self.scales, |sum, term| sum + term.abs());
    }

    /// The largest of the known rows over its rounding. Its scale is that of the terms of `A1 x` and of a1.
    #[inline(always)]
    fn largest(&self, scale: impl Fn(f64, f64) -> f64) -> f64 {
        let scales = self.scales.iter().zip(&self.rates).map(|(terms, rate)| scale(*terms, rate.abs()));
        largest(self.known.iter().copied().zip(scales))
    }
}

/// The largest row over a rounding of its scale. NaN if a row is NaN or a scale is not finite.
#[inline(always)]
fn largest(rows: impl Iterator<Item = (f64, f64)>) -> f64 {
    let worst = rows.fold(0.0, |worst, (row, scale)| {
        // No branch: a row without terms is zero, and 0 ∞ is NaN.
        worse(row.abs() / scale.max(f64::MIN_POSITIVE) + 0.0 * scale, worst)
    });
    worst / f64::EPSILON
}

/// Writes the entries of A.
#[inline(always)]
fn write<const N: usize>(gradients: &impl Rectangular<N, f64>, entries: &mut [f64]) {
    let mut start = 0;
    for Row { values, .. } in gradients.rows() {
        for (entry, value) in entries[start..].iter_mut().zip(values) {
            *entry = *value;
        }
        start += values.len();
    }
}

/// Writes M⁻¹Aᵀ.
#[inline(always)]
fn weigh<const D: usize>(Pattern { parts, .. }: &Pattern, inverse: &[f64], a: &[f64], weighted: &mut [f64]) {
    let ((a, _), (inverse, _), (weighted, _)) =
        (a.as_chunks::<D>(), inverse.as_chunks::<D>(), weighted.as_chunks_mut::<D>());
    for ((Part { point, .. }, a), weighted) in parts.iter().zip(a).zip(weighted) {
        let inverse = &inverse[*point];
        *weighted = core::array::from_fn(|k| a[k] * inverse[k]);
    }
}

/// Adds `AᵀΛ`.
#[inline(always)]
fn add<const N: usize, const D: usize>(pattern: &Pattern, a: &[f64], multipliers: &[f64], sum: &mut SVector<f64, N>) {
    pattern.add_terms::<D>(a, multipliers, sum.as_mut_slice(), |sum, term| sum + term);
}

/// `A0ᵀλ`, and the sizes of its terms.
#[inline(always)]
fn reaction<const N: usize, const D: usize>(pattern: &Pattern, a: &[f64], lambda: &[f64]) -> [SVector<f64, N>; 2] {
    let (mut reaction, mut sizes) = (SVector::<f64, N>::zeros(), SVector::<f64, N>::zeros());
    add::<N, D>(pattern, a, lambda, &mut reaction);
    pattern.add_terms::<D>(a, lambda, sizes.as_mut_slice(), |sum, term| sum + term.abs());
    [reaction, sizes]
}

/// Solves the step of length h from `node`, with the guess of the impulses in `u`; writes there velocities and
/// impulses, and returns the contraction as [`solve::unprojected`](super::solve::unprojected). `None` if the general
/// solver has to.
pub(crate) fn step<S: Motion<N>, const N: usize>(
    system: &S,
    of: (&Node<N>, f64, bool),
    u: &mut [f64],
    reduced: &mut Reduced,
) -> Option<(Solved<N, Multipliers<S, N>>, f64)> {
    match reduced.dimension {
        3 => step_of_points::<S, N, 3>(system, of, u, reduced),
        2 => step_of_points::<S, N, 2>(system, of, u, reduced),
        _ => step_of_points::<S, N, 1>(system, of, u, reduced),
    }
}

/// The same for points of D coordinates.
fn step_of_points<S: Motion<N>, const N: usize, const D: usize>(
    system: &S,
    (node, h, is_next): (&Node<N>, f64, bool),
    u: &mut [f64],
    reduced: &mut Reduced,
) -> Option<(Solved<N, Multipliers<S, N>>, f64)> {
    if !reduced.begin::<S, N, D>(system, node, is_next) {
        return None;
    }
    let (velocity, lambda) = u.split_at_mut(N);
    let (middle, t1) = (node.t + (node.t_low + h * 0.5), node.t + (node.t_low + h));
    let force = system.point(middle, &node.q, &SVector::zeros()).force;
    let mut v = reduced.velocity(&(node.p + (node.p_low + force * (h * 0.5))));
    add::<N, D>(&reduced.pattern, &reduced.weighted, lambda, &mut v);

    let (mut iterations, mut before, mut is_factored, mut contraction) = (0, f64::INFINITY, false, 0.0);
    let residual = loop {
        let end: Configuration<N, f64> = (t1, node.q + (node.q_low + v * h));
        let residual = constraints::<S, N, D>(system, &end, (h, before), reduced);
        contraction = contracted(contraction, [before, residual]);
        if !is_factored || residual > FLOOR && residual > FALLEN * before {
            is_factored = reduced.schur.factor::<D>(reduced.pattern.is_chain, &reduced.last, &reduced.weighted);
        }
        if !is_factored || residual.is_nan() || iterations == ITERATIONS {
            return None;
        }
        if residual <= 1.0 || residual <= FLOOR && iterations > 0 {
            reduced.end.copy_from_slice(end.1.as_slice());
            break residual;
        }
        reduced.schur.solve(&mut reduced.known);
        for (lambda, correction) in lambda.iter_mut().zip(&mut reduced.known) {
            *correction = -*correction;
            *lambda += *correction;
        }
        add::<N, D>(&reduced.pattern, &reduced.weighted, &reduced.known, &mut v);
        (before, iterations) = (residual, iterations + 1);
    };
    velocity.copy_from_slice(v.as_slice());
    let [reaction, sizes] = reaction::<N, D>(&reduced.pattern, &reduced.first, lambda);
    let residual = worse(momenta(system, (node, h, &v), &reaction, &sizes), residual);
    let (end, mu, of_velocity) = projected::<S, N, D>(system, (node, h, &v), force * h + reaction, reduced)?;
    let residual = worse(of_velocity, residual);
    // False for NaN.
    (residual <= FLOOR).then_some((Solved { end, mu, residual, iterations }, contraction))
}

/// g/h at the end of a step, in `known`, and A and a there. Returns the largest row over its rounding. The scales are
/// those of the residual `before` if it is small.
#[inline(always)]
fn constraints<S: Motion<N>, const N: usize, const D: usize>(
    system: &S,
    (t, q): &Configuration<N, f64>,
    (h, before): (f64, f64),
    reduced: &mut Reduced,
) -> f64 {
    let (gradients, rates) = system.constraint_gradients(*t, q);
    write(&gradients, &mut reduced.last);
    reduced.rates.copy_from_slice(rates.as_ref());
    for (known, value) in reduced.known.iter_mut().zip(system.constraints(*t, q).as_ref()) {
        *known = value / h;
    }
    // True at the first residual.
    if before > NEARLY_SOLVED {
        reduced.scale::<N, D>(q);
    }
    reduced.largest(|terms, rate| terms / h.abs() + rate)
}

/// The largest momentum row over its rounding.
#[inline(always)]
fn momenta<S: Motion<N>, const N: usize>(
    system: &S,
    (node, h, v): (&Node<N>, f64, &SVector<f64, N>),
    reaction: &SVector<f64, N>,
    sizes: &SVector<f64, N>,
) -> f64 {
    let (t, q) = node.midpoint(h, v);
    let point = system.point(t, &q, v);
    largest((0..N).map(|i| {
        let of_force = point.force[i] * (h * 0.5);
        let row = ((point.momentum[i] - node.p[i]) - node.p_low[i]) - (of_force + reaction[i]);
        // M v is the only term of its row.
        let scale = node.p[i].abs() + 2.0 * point.momentum[i].abs() + of_force.abs() + sizes[i];
        (row, scale)
    }))
}

/// The end of a step with consistent momenta, the impulse for that, and the residual of `A v + a`.
#[inline(always)]
fn projected<S: Motion<N>, const N: usize, const D: usize>(
    system: &S,
    (node, h, v): (&Node<N>, f64, &SVector<f64, N>),
    mut increment: SVector<f64, N>,
    reduced: &mut Reduced,
) -> Option<(Node<N>, Multipliers<S, N>, f64)> {
    weigh::<D>(&reduced.pattern, &reduced.inverse, &reduced.last, &mut reduced.weighted);
    if !reduced.schur.factor::<D>(reduced.pattern.is_chain, &reduced.last, &reduced.weighted) {
        return None;
    }
    let mut mu = system.constraints(node.t, &node.q);
    reduced.rate::<N, D>(&reduced.velocity(&(node.p + (node.p_low + increment))));
    reduced.schur.solve(&mut reduced.known);
    for (mu, rate) in mu.as_mut().iter_mut().zip(&reduced.known) {
        *mu = -rate;
    }
    add::<N, D>(&reduced.pattern, &reduced.last, mu.as_ref(), &mut increment);
    let mut end = *node;
    end.advance(h, v, &increment);
    // The increment of the momenta was rounded. Its part across the constraints goes into a second, tiny impulse.
    reduced.rate::<N, D>(&reduced.velocity(&(end.p + end.p_low)));
    reduced.schur.solve(&mut reduced.known);
    let mut rest = SVector::zeros();
    for (mu, rate) in mu.as_mut().iter_mut().zip(&mut reduced.known) {
        *rate = -*rate;
        *mu += *rate;
    }
    add::<N, D>(&reduced.pattern, &reduced.last, &reduced.known, &mut rest);
    end.add_momentum(&rest);
    let v = reduced.velocity(&(end.p + end.p_low));
    reduced.rate::<N, D>(&v);
    reduced.scale::<N, D>(&v);
    // p and v are rounded too.
    let residual = reduced.largest(|terms, rate| 3.0 * (terms + rate));
    end.is_finite().then_some((end, mu, residual))
}
