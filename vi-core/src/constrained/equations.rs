//! The equations of a step of s Gauss stages with constraints.
//!
//! With the Gauss coefficients c, b, a, and the Lobatto nodes and weights c̃, b̃ (`crate::gauss::lobatto`), the unknowns
//! are the velocities V_i at the stages and the impulses `λ_j = h b̃_j Λ_j` at the Lobatto nodes j = 0 … s − 1:
//!
//! ```text
//! Q_i = q0 + h Σ a_ij V_j        Q̃_i = q0 + h Σ ã_ij V_j        A_j = A(T̃_j, Q̃_j)
//!
//! momentum        L_v(T_i, Q_i, V_i) − p0 − h Σ a_ij F_j − Σ_j (1 − ã_ji/b_i) A_jᵀ λ_j = 0
//! holonomic       g(T̃_i, Q̃_i)/h = 0                    i = 1 … s, at the Lobatto nodes
//! nonholonomic    (A V + a)(T_i, Q_i, V_i) = 0          i = 1 … s, at the Gauss points
//! ```
//!
//! A dropped constraint has its impulse as row. The rows are generic over the numbers: `Rounded` numbers give their rounding-error bounds.

// One index addresses several arrays.
#![allow(clippy::needless_range_loop)]

use super::{diagonal, inertia, reaction_of, reaction_terms, spread};
use crate::gauss::lobatto::Lobatto;
use crate::gauss::tableau::Tableau;
use crate::kind::{Gradients, Multipliers};
use crate::linear::{Assemble, Entries, Matrix, Rectangular, Row, determinant_sign, scale};
use crate::motion::{Motion, Point};
use crate::newton::{roundings, worst};
use crate::node::Node;
use crate::real::{Real, Rounded};
use crate::vector::worse;
use nalgebra::{SMatrix, SVector};

/// The cosine of the largest angle by which a gradient may turn in a step.
const STRAIGHT: f64 = 0.9;

/// The number of unknowns of a step: velocities first, then impulses.
pub(crate) const fn unknowns<const N: usize, const S: usize>(constraints: usize) -> usize {
    S * (N + constraints)
}

/// The velocity at stage i.
pub(crate) fn stage_velocity<const N: usize, T: Real>(u: &[T], i: usize) -> SVector<T, N> {
    SVector::from_column_slice(&u[i * N..(i + 1) * N])
}

/// The impulses at Lobatto node j.
pub(crate) fn impulses<const N: usize, const S: usize, T>(u: &[T], constraints: usize, j: usize) -> &[T] {
    &u[S * N + j * constraints..][..constraints]
}

/// The part of the impulse at Lobatto node j that acts on stage i.
fn part_of_node<const S: usize>(j: usize, i: usize) -> f64 {
    if j == 0 { 1.0 } else { 1.0 - const { &Lobatto::<S>::VALUES }.part[i][j - 1] }
}

/// Time and coordinates of a point in a step.
pub(crate) type Configuration<const N: usize, T> = (T, SVector<T, N>);

/// The equations at some unknowns.
pub(crate) struct Rows<S: Motion<N, T>, const N: usize, const STAGES: usize, T: Real = f64> {
    momentum: [SVector<T, N>; STAGES],
    constraint: [Multipliers<S, N, T>; STAGES],
    /// The equations of motion at the stages.
    points: [Point<N, T, S::Mass>; STAGES],
    /// `Σ b_i V_i`.
    pub(crate) velocity: SVector<T, N>,
    /// `h Σ b_i F_i + Σ A_jᵀ λ_j`.
    pub(crate) increment: SVector<T, N>,
    stages: [Configuration<N, T>; STAGES],
    /// The Lobatto nodes 1 … s.
    nodes: [Configuration<N, T>; STAGES],
    /// A at the node.
    first: Gradients<S, N, T>,
    /// A and a at the Lobatto nodes 1 … s.
    at_nodes: [(Gradients<S, N, T>, Multipliers<S, N, T>); STAGES],
}

/// The terms of each row of the equations, also where they cancel: the row is known to a rounding of them.
#[derive(Clone, Copy)]
pub(crate) struct Scales<S: Motion<N>, const N: usize, const STAGES: usize> {
    momentum: [SVector<f64, N>; STAGES],
    constraint: [Multipliers<S, N>; STAGES],
}

/// Times and coordinates of the stages, and of the Lobatto nodes 1 … s; the mean velocity.
pub(crate) fn configurations<const N: usize, const STAGES: usize, T: Real>(
    node: &Node<N, T>,
    h: T,
    u: &[T],
) -> ([Configuration<N, T>; STAGES], [Configuration<N, T>; STAGES], SVector<T, N>) {
    let Tableau { b, c, first: part, .. } = const { &Tableau::<STAGES>::VALUES };
    let lobatto = const { &Lobatto::<STAGES>::VALUES };
    let v: [SVector<T, N>; STAGES] = core::array::from_fn(|i| stage_velocity(u, i));
    let weights = b.map(|b| h * T::real(b));
    // The coordinates after a displacement are those that `Node::advance` gives.
    let moved = |displacement: SVector<T, N>| node.q + (node.q_low + displacement);
    let later = |c: f64| node.t + (node.t_low + h * T::real(c));
    let displaced = |parts: &[[f64; STAGES]; STAGES], i: usize| {
        let terms = (0..STAGES).map(|j| v[j] * (weights[j] * T::real(parts[j][i])));
        moved(terms.fold(SVector::zeros(), |sum, term| sum + term))
    };
    let velocity = (0..STAGES).fold(SVector::zeros(), |sum, i| sum + v[i] * T::real(b[i]));
    let stages = core::array::from_fn(|i| (later(c[i]), displaced(part, i)));
    let nodes = core::array::from_fn(|i| {
        let q = if i + 1 == STAGES { moved(velocity * h) } else { displaced(&lobatto.part, i) };
        (later(lobatto.c[i]), q)
    });
    (stages, nodes, velocity)
}

impl<S: Motion<N, T>, const N: usize, const STAGES: usize, T: Real> Rows<S, N, STAGES, T> {
    /// Evaluates the equations of the step of length h from `node`.
    pub(crate) fn at(system: &S, node: &Node<N, T>, h: T, u: &[T]) -> Self {
        let start = system.constraint_gradients(node.t, &node.q);
        Self::from_start(system, (node, h), &start, u)
    }

    /// The same with A and a at the node.
    pub(crate) fn from_start(
        system: &S,
        (node, h): (&Node<N, T>, T),
        (first, rest): &(Gradients<S, N, T>, Multipliers<S, N, T>),
        u: &[T],
    ) -> Self {
        let Tableau { b, first: part, .. } = const { &Tableau::<STAGES>::VALUES };
        let constraints = system.constraint_names().len();
        let zeros = SVector::<T, N>::zeros();
        let v: [SVector<T, N>; STAGES] = core::array::from_fn(|i| stage_velocity(u, i));
        let (stages, nodes, velocity) = configurations::<N, STAGES, T>(node, h, u);

        let at_nodes = nodes.map(|(t, q)| system.constraint_gradients(t, &q));
        let gradients_at = |j: usize| if j == 0 { first } else { &at_nodes[j - 1].0 };
        // Loops, because `from_fn` calls its function.
        let (mut reactions, mut increments, mut momentum) = ([zeros; STAGES], [zeros; STAGES], [zeros; STAGES]);
        for (j, reaction) in reactions.iter_mut().enumerate() {
            *reaction = reaction_of(gradients_at(j), impulses::<N, STAGES, T>(u, constraints, j));
        }
        let points: [_; STAGES] = core::array::from_fn(|i| system.point(stages[i].0, &stages[i].1, &v[i]));
        for (i, increment) in increments.iter_mut().enumerate() {
            *increment = points[i].force * (h * T::real(b[i]));
        }
        for (i, row) in momentum.iter_mut().enumerate() {
            let mut sum = zeros;
            for j in 0..STAGES {
                sum += increments[j] * T::real(part[j][i]) + reactions[j] * T::real(part_of_node::<STAGES>(j, i));
            }
            *row = ((points[i].momentum - node.p) - node.p_low) - sum;
        }
        let mut constraint = [*rest; STAGES];
        for (i, residual) in constraint.iter_mut().map(AsMut::as_mut).enumerate() {
            let (t, q) = &nodes[i];
            for (row, value) in residual.iter_mut().zip(system.constraints(*t, q).as_ref()).take(system.holonomic()) {
                *row = *value / h;
            }
            if system.holonomic() < constraints {
                let (gradients, rates) = system.constraint_gradients(stages[i].0, &stages[i].1);
                for r in system.holonomic()..constraints {
                    residual[r] = gradients.row(r).dot(&v[i]) + rates.as_ref()[r];
                }
            }
            let own = impulses::<N, STAGES, T>(u, constraints, i);
            for r in (0..constraints).filter(|r| system.is_dropped(*r)) {
                residual[r] = own[r];
            }
        }
        let sum = |vectors: &[SVector<T, N>; STAGES]| vectors.iter().fold(zeros, |sum, entry| sum + entry);
        let increment = sum(&increments) + sum(&reactions);
        Self { momentum, constraint, points, velocity, increment, stages, nodes, first: *first, at_nodes }
    }

    /// The diagonal of the mass matrix at the first stage.
    pub(crate) fn mass(&self) -> SVector<T, N> {
        diagonal(&self.points[0].mass)
    }

    /// Writes the rows, in the order of the unknowns.
    pub(crate) fn write(&self, rows: &mut [T]) {
        let (momenta, constraints) = rows.split_at_mut(STAGES * N);
        for (rows, momentum) in momenta.chunks_exact_mut(N).zip(&self.momentum) {
            rows.copy_from_slice(momentum.as_slice());
        }
        for (row, entry) in constraints.iter_mut().zip(self.constraint.iter().flat_map(AsRef::as_ref)) {
            *row = *entry;
        }
    }

    /// Time and coordinates at the end of the step.
    pub(crate) fn end(&self) -> Configuration<N, T> {
        self.nodes[STAGES - 1]
    }

    /// A at the end of the step.
    pub(crate) fn end_gradients(&self) -> &Gradients<S, N, T> {
        &self.at_nodes[STAGES - 1].0
    }
}

impl<S: Motion<N, Rounded>, const N: usize, const STAGES: usize> Rows<S, N, STAGES, Rounded> {
    /// The largest row over its rounding-error bound, by running error analysis.
    pub(crate) fn bounded_residual(&self) -> f64 {
        let momenta = self.momentum.iter().flat_map(|row| row.iter());
        let rows = momenta.chain(self.constraint.iter().flat_map(AsRef::as_ref));
        rows.fold(0.0, |largest, row| worse(roundings(row.to_f64(), row.ulps()), largest))
    }
}

impl<S: Motion<N>, const N: usize, const STAGES: usize> Rows<S, N, STAGES> {
    /// The terms of the rows.
    pub(crate) fn scales(&self, system: &S, (node, h): (&Node<N>, f64), u: &[f64]) -> Scales<S, N, STAGES> {
        let momentum = self.momentum_scales((node, h), u, system.constraint_names().len());
        Scales { momentum, constraint: self.constraint_scales(system, h, u, &momentum) }
    }

    #[inline(always)]
    fn momentum_scales(&self, (node, h): (&Node<N>, f64), u: &[f64], constraints: usize) -> [SVector<f64, N>; STAGES] {
        let Tableau { b, first: part, .. } = const { &Tableau::<STAGES>::VALUES };
        let gradients_at = |j: usize| if j == 0 { &self.first } else { &self.at_nodes[j - 1].0 };
        let (mut reactions, mut scales) = ([SVector::<f64, N>::zeros(); STAGES], [SVector::zeros(); STAGES]);
        for (j, reaction) in reactions.iter_mut().enumerate() {
            *reaction = reaction_terms(gradients_at(j), impulses::<N, STAGES, f64>(u, constraints, j));
        }
        for (i, scale) in scales.iter_mut().enumerate() {
            let (Point { mass, momentum, .. }, v) = (&self.points[i], stage_velocity(u, i));
            let [least, _] = spread(mass, &v, &node.p);
            *scale = node.p.abs() + momentum.abs() + inertia(mass, &v) + least;
            for j in 0..STAGES {
                let part_of_force = h * b[j] * part[j][i];
                *scale += self.points[j].force.abs() * part_of_force.abs();
                *scale += reactions[j] * part_of_node::<STAGES>(j, i).abs();
            }
        }
        scales
    }

    #[inline(always)]
    fn constraint_scales(
        &self,
        system: &S,
        h: f64,
        u: &[f64],
        momentum: &[SVector<f64, N>; STAGES],
    ) -> [Multipliers<S, N>; STAGES] {
        let constraints = system.constraint_names().len();
        let mut scales = self.constraint;
        for (i, scale) in scales.iter_mut().map(AsMut::as_mut).enumerate() {
            // A velocity is known to the terms of its momentum.
            let mass = diagonal(&self.points[i].mass);
            let known = momentum[i].zip_map(&mass, |terms, mass| if mass > 0.0 { terms / mass } else { 0.0 });
            let (_, q) = &self.nodes[i];
            let (gradients, rates) = &self.at_nodes[i];
            for r in 0..system.holonomic() {
                let row = gradients.row(r);
                scale[r] = row.terms(q) / h.abs() + rates.as_ref()[r].abs() + row.terms(&known);
            }
            if system.holonomic() < constraints {
                // Evaluated again: to keep them takes every step longer.
                let v: SVector<f64, N> = stage_velocity(u, i);
                let (gradients, rates) = system.constraint_gradients(self.stages[i].0, &self.stages[i].1);
                for r in system.holonomic()..constraints {
                    let row = gradients.row(r);
                    scale[r] = row.terms(&v) + rates.as_ref()[r].abs() + row.terms(&known);
                }
            }
            for r in (0..constraints).filter(|r| system.is_dropped(*r)) {
                scale[r] = self.constraint[i].as_ref()[r].abs();
            }
        }
        scales
    }

    /// The largest row over a rounding of its terms. NaN if a row is not finite.
    pub(crate) fn residual(&self, scales: &Scales<S, N, STAGES>) -> f64 {
        let mut largest = 0.0;
        for i in 0..STAGES {
            largest = worse(worst(&self.momentum[i], &scales.momentum[i]), largest);
            for (row, scale) in self.constraint[i].as_ref().iter().zip(scales.constraint[i].as_ref()) {
                largest = worse(roundings(*row, *scale), largest);
            }
        }
        largest
    }

    /// Whether no gradient turns far: a shorter step would have a determinant of the same sign.
    pub(crate) fn is_straight(&self) -> bool {
        self.first.rows().zip(self.end_gradients().rows()).all(|(before, after)| {
            let [before, after] = [before, after].map(Row::dense::<N>);
            before.dot(&after) >= STRAIGHT * (before.norm() * after.norm())
        })
    }

    /// Writes the Jacobian of the rows with respect to the unknowns: copy i of the row of a coordinate is the momentum
    /// row of stage i, copy k of its column the velocity of stage k; those of a constraint are row and impulse k.
    #[inline(always)]
    fn jacobian(&self, system: &S, h: f64, u: &[f64], jacobian: &mut impl Entries<f64>) {
        let Tableau { b, first: part, .. } = const { &Tableau::<STAGES>::VALUES };
        let lobatto = const { &Lobatto::<STAGES>::VALUES };
        let constraints = system.constraint_names().len();
        let weights = b.map(|b| h * b);
        scale(jacobian.scales(), self.mass().iter().copied(), self.first.rows());
        for i in 0..STAGES {
            let (t, q) = &self.stages[i];
            let v = stage_velocity(u, i);
            let at = system.point_derivatives(*t, q, &v);
            at.mass.each_entry(|row, column, value| {
                let entry = jacobian.entry(row, column);
                jacobian.add(entry, [i, i], value);
            });
            at.momentum_dq.each_entry(|row, column, value| {
                let entry = jacobian.entry(row, column);
                for k in 0..STAGES {
                    jacobian.add(entry, [i, k], value * (part[k][i] * weights[k]));
                }
            });
            // The force at stage i acts on the momentum of stage k.
            at.force_dv.each_entry(|row, column, value| {
                let entry = jacobian.entry(row, column);
                for k in 0..STAGES {
                    jacobian.add(entry, [k, i], -part[i][k] * (value * weights[i]));
                }
            });
            at.force_dq.each_entry(|row, column, value| {
                let entry = jacobian.entry(row, column);
                for k in 0..STAGES {
                    let of_force = value * weights[i] * (part[k][i] * weights[k]);
                    for l in 0..STAGES {
                        jacobian.add(entry, [l, k], -part[i][l] * of_force);
                    }
                }
            });
            for r in 0..system.holonomic() {
                for (column, slope) in self.at_nodes[i].0.row(r).iter() {
                    let entry = jacobian.entry(N + r, column);
                    for k in 0..STAGES {
                        jacobian.add(entry, [i, k], slope * lobatto.part[k][i] * b[k]);
                    }
                }
            }
            if system.holonomic() < constraints {
                let (gradients, _) = system.constraint_gradients(*t, q);
                let (rates_dq, _) = system.constraint_rate_derivatives(*t, q, &v);
                for r in system.holonomic()..constraints {
                    for (column, slope) in gradients.row(r).iter() {
                        let entry = jacobian.entry(N + r, column);
                        jacobian.add(entry, [i, i], slope);
                    }
                    for (column, slope) in rates_dq.row(r).iter() {
                        let entry = jacobian.entry(N + r, column);
                        for k in 0..STAGES {
                            jacobian.add(entry, [i, k], slope * (part[k][i] * weights[k]));
                        }
                    }
                }
            }
            for r in (0..constraints).filter(|r| system.is_dropped(*r)) {
                // The row is the impulse.
                let entry = jacobian.entry(N + r, N + r);
                jacobian.add(entry, [i, i], 1.0);
            }
            self.reactions(system, i, u, &weights, jacobian);
        }
    }

    /// Adds the derivatives of the reaction at Lobatto node j.
    #[inline(always)]
    fn reactions(&self, system: &S, j: usize, u: &[f64], weights: &[f64; STAGES], jacobian: &mut impl Entries<f64>) {
        let lobatto = const { &Lobatto::<STAGES>::VALUES };
        let gradients = if j == 0 { &self.first } else { &self.at_nodes[j - 1].0 };
        for (r, row) in gradients.rows().enumerate() {
            for (column, slope) in row.iter() {
                let entry = jacobian.entry(column, N + r);
                for i in 0..STAGES {
                    jacobian.add(entry, [i, j], -part_of_node::<STAGES>(j, i) * slope);
                }
            }
        }
        // The first node does not move.
        if j == 0 {
            return;
        }
        let (t, q) = &self.nodes[j - 1];
        let mut multipliers = self.constraint[0];
        let of_node = impulses::<N, STAGES, f64>(u, system.constraint_names().len(), j);
        multipliers.as_mut().copy_from_slice(of_node);
        let derivatives = system.reaction_derivatives(*t, q, &multipliers);
        for (row, entries) in derivatives.rows().enumerate() {
            for (column, slope) in entries.iter() {
                let entry = jacobian.entry(row, column);
                for k in 0..STAGES {
                    let displacement = lobatto.part[k][j - 1] * weights[k];
                    for i in 0..STAGES {
                        jacobian.add(entry, [i, k], -part_of_node::<STAGES>(j, i) * displacement * slope);
                    }
                }
            }
        }
    }
}

/// The Jacobian of the rows.
pub(super) struct Jacobian<'a, S: Motion<N>, const N: usize, const STAGES: usize> {
    pub(super) rows: &'a Rows<S, N, STAGES>,
    pub(super) system: &'a S,
    pub(super) h: f64,
    pub(super) u: &'a [f64],
}

impl<S: Motion<N>, const N: usize, const STAGES: usize> Assemble<f64> for Jacobian<'_, S, N, STAGES> {
    #[inline(always)]
    fn assemble(&self, entries: &mut impl Entries<f64>) {
        self.rows.jacobian(self.system, self.h, self.u, entries);
    }
}

/// Signs of the determinants of the matrix of ã, and of that of the parts of the impulses.
pub(crate) fn signs<const STAGES: usize>() -> [i8; 2] {
    let lobatto = const { &Lobatto::<STAGES>::VALUES };
    let displacement = SMatrix::<f64, STAGES, STAGES>::from_fn(|i, k| lobatto.part[k][i]);
    let impulse = SMatrix::<f64, STAGES, STAGES>::from_fn(|i, j| part_of_node::<STAGES>(j, i));
    [determinant_sign(&displacement), determinant_sign(&impulse)]
}

/// The sign of the determinant of the Jacobian for short steps, with this sign of the bordered mass matrix.
///
/// For h → 0 that determinant is a product of s bordered mass matrices, of the matrix of ã for each holonomic
/// constraint, and of the matrix of the parts of the impulses for each constraint.
pub(crate) fn expected_sign(
    [displacement, impulse]: [i8; 2],
    (bordered, stages): (i8, usize),
    [holonomic, constraints]: [usize; 2],
) -> i8 {
    let power = |sign: i8, exponent: usize| if exponent.is_multiple_of(2) { sign * sign } else { sign };
    power(displacement, holonomic) * power(impulse, constraints) * power(bordered, stages)
}

/// The discrete energy at the end of a step with these unknowns and the impulse μ of its projection:
///
/// ```text
/// E1 = Σ b_i En_i − h Σ b_i c_i (L_t − f·V)_i − Σ_j c̃_j λ_j·a_j − μ·a_s
/// ```
///
/// with the energies En_i at the stages.
pub(crate) fn discrete_energy<S: Motion<N>, const N: usize, const STAGES: usize>(
    system: &S,
    (node, h): (&Node<N>, f64),
    u: &[f64],
    mu: &[f64],
) -> f64 {
    let Tableau { b, c, .. } = const { &Tableau::<STAGES>::VALUES };
    let lobatto = const { &Lobatto::<STAGES>::VALUES };
    let (stages, nodes, _) = configurations::<N, STAGES, f64>(node, h, u);
    let of_stages = (0..STAGES).fold(0.0, |sum, i| {
        let ((t, q), v) = (&stages[i], stage_velocity(u, i));
        sum + b[i] * (system.energy(*t, q, &v) + h * c[i] * system.power(*t, q, &v))
    });
    (0..STAGES).fold(of_stages, |sum, i| {
        let (_, rates) = system.constraint_gradients(nodes[i].0, &nodes[i].1);
        let impulse =
            if i + 1 == STAGES { mu } else { impulses::<N, STAGES, f64>(u, system.constraint_names().len(), i + 1) };
        let c = if i + 1 == STAGES { 1.0 } else { lobatto.c[i] };
        sum - c * rates.as_ref().iter().zip(impulse).map(|(rate, impulse)| rate * impulse).sum::<f64>()
    })
}
