//! Checks of the constraints at a start.

use super::motion::{Velocity, from_rest};
use super::{bordered, diagonal, reaction_of, spread};
use crate::error::StepError;
use crate::kind::Multipliers;
use crate::linear::{Bordered, Matrix, Rectangular};
use crate::motion::Motion;
use crate::newton::roundings;
use crate::node::Node;
use crate::real::{Real, Rounded};
use crate::stepping::Convertible;
use alloc::vec::Vec;
use nalgebra::{DMatrix, SVector};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

/// Largest g and `A v + a` of a start, in roundings of their terms.
pub(super) const CONSISTENT: f64 = 16.0;
/// The same of a stored node, whose run measured them with bounds of its own, and of a place whose independent
/// constraints are found.
pub(super) const STORED: f64 = 1024.0;
/// Rows of A, scaled to 1, whose part across the others is below this are redundant.
const INDEPENDENT: f64 = 1e-10;

/// Checks that the constraints are independent at a node and that the node satisfies them. Returns its velocity.
///
/// # Errors
/// [`StepError::Redundant`], [`StepError::InconsistentStart`], [`StepError::DroppedConstraint`], [`StepError::Singular`], [`StepError::NonFinite`],
/// [`StepError::NotConverged`].
pub(crate) fn checked<S, const N: usize>(
    system: &S,
    node: &Node<N>,
    bordered: &mut Bordered,
) -> Result<SVector<f64, N>, StepError>
where
    S: Convertible<N>,
{
    node.check_finite(0.0)?;
    let Node { t, q, p, .. } = node;
    let (gradients, _) = system.constraint_gradients(*t, q);
    let found = from_rest(system, (*t, q, p), bordered);
    let v = found.as_ref().map_or(SVector::zeros(), |found| found.v);
    let mass = system.point(*t, q, &v).mass;
    // The name of a redundant constraint says more than a singular matrix.
    let inverse = &mut Bordered::new(N, 0, system.blocks());
    let is_regular = inverse.factor(&mass, &gradients).is_ok();
    let given: Vec<usize> = (0..system.constraint_names().len()).filter(|r| !system.is_dropped(*r)).collect();
    let redundant = redundant_rows(&gradients, &given, &mass, is_regular);
    // The last declared of those that follow from the others.
    if let Some(last) = redundant.last() {
        let (constraint, of) = (system.constraint_names()[*last], given.len());
        let rank = of - redundant.len();
        return Err(StepError::Redundant { constraint, of, rank });
    }
    let Velocity { mu, .. } = found?;
    consistent(system, node, (&v, &mu), (&mass, is_regular.then_some(inverse)), CONSISTENT)?;
    Ok(v)
}

/// Checks that a stored node satisfies the constraints: a file may contain any numbers.
///
/// # Errors
/// [`StepError::InconsistentStart`], [`StepError::DroppedConstraint`].
pub(crate) fn check_stored<S, const N: usize>(system: &S, node: &Node<N>) -> Result<(), StepError>
where
    S: Convertible<N>,
{
    let Node { t, q, p, .. } = node;
    let (gradients, mut none) = system.constraint_gradients(*t, q);
    none.as_mut().fill(0.0);
    // Without a velocity the next step fails. The coordinates are checked nevertheless.
    let found = from_rest(system, (*t, q, p), &mut bordered(system));
    let (v, mu) = found.map_or((SVector::zeros(), none), |Velocity { v, mu, .. }| (v, mu));
    let mass = system.point(*t, q, &v).mass;
    let inverse = &mut Bordered::new(N, 0, system.blocks());
    let is_regular = inverse.factor(&mass, &gradients).is_ok();
    consistent(system, node, (&v, &mu), (&mass, is_regular.then_some(inverse)), STORED)
}

/// Checks that a node satisfies the constraints to `limit` roundings, with v and μ of `L_v(v) = p + Aᵀμ`. `inverse`
/// has the factors of a regular mass matrix.
///
/// # Errors
/// [`StepError::InconsistentStart`], [`StepError::DroppedConstraint`].
fn consistent<S, const N: usize>(
    system: &S,
    node: &Node<N>,
    (v, mu): (&SVector<f64, N>, &Multipliers<S, N>),
    (mass, inverse): (&impl Matrix<N, f64>, Option<&mut Bordered>),
    limit: f64,
) -> Result<(), StepError>
where
    S: Convertible<N>,
{
    let Node { t, q, p, .. } = node;
    let (gradients, _) = system.constraint_gradients(*t, q);
    let [_, positions] = spread(mass, q, &SVector::zeros());
    let [_, velocities] = spread(mass, v, p);
    let rounded = system.convert::<Rounded>();
    let (t, q) = (Rounded::exact(*t), q.map(Rounded::nearest));
    let values = rounded.constraints(t, &q);
    let (rounded_gradients, offsets) = rounded.constraint_gradients(t, &q);
    // L_v(v) − p = Aᵀμ: the velocity of p is v − M⁻¹ Aᵀμ. Without an inverse, momenta are compared.
    let impulse = reaction_of(&gradients, mu.as_ref());
    let (mut excess, mut uncertainty) = (impulse, p.abs());
    if let Some(inverse) = inverse {
        inverse.solve(&mut excess, &mut []);
        // |M⁻¹| |p|: momenta may cancel, but their roundings do not.
        uncertainty = SVector::zeros();
        for (j, momentum) in p.iter().enumerate() {
            let mut column = SVector::<f64, N>::zeros();
            column[j] = *momentum;
            inverse.solve(&mut column, &mut []);
            uncertainty += column.abs();
        }
    }
    for (r, constraint) in system.constraint_names().iter().enumerate().filter(|(r, _)| !system.is_dropped(*r)) {
        let value = values.as_ref()[r];
        let of_velocity = rounded_gradients.row(r).iter().map(|(column, entry)| entry * Rounded::nearest(v[column]));
        let bound = of_velocity.fold(offsets.as_ref()[r], |sum, term| sum + term).ulps();
        let row = gradients.row(r);
        let of_momentum = row.terms(&uncertainty) + row.terms(&velocities);
        let of_value = value.ulps() + row.terms(&positions);
        let rate = -row.dot(&excess);
        // At rest a velocity is the rounding of a rounding, which no motion shows, in any unit of time.
        let of_rate = bound + of_momentum + f64::EPSILON * of_value;
        let is_consistent = roundings(value.to_f64(), of_value) <= limit && roundings(rate, of_rate) <= limit;
        if !is_consistent {
            return Err(StepError::InconsistentStart { constraint, residual: value.to_f64(), rate });
        }
    }
    match system.broken(node.t, &node.q, v) {
        Some((r, residual)) => {
            Err(StepError::DroppedConstraint { t: node.t, constraint: system.constraint_names()[r], residual })
        }
        None => Ok(()),
    }
}

/// The constraints among `given` that follow from the others, in the order of `given`: those that [`independent_rows`]
/// does not find.
pub(super) fn redundant_rows<const N: usize>(
    gradients: &impl Rectangular<N, f64>,
    given: &[usize],
    mass: &impl Matrix<N, f64>,
    is_regular: bool,
) -> Vec<usize> {
    let kept = independent_rows(gradients, given, mass, is_regular);
    given.iter().enumerate().filter(|(place, _)| !kept.contains(place)).map(|(_, r)| *r).collect()
}

/// The places among `given` of independent constraints, by orthogonalization with column pivoting in the metric of the
/// inverse mass matrix, or of its diagonal if it is singular or not positive definite. Gradients are compared at length
/// 1; one without length is never independent.
fn independent_rows<const N: usize>(
    gradients: &impl Rectangular<N, f64>,
    given: &[usize],
    mass: &impl Matrix<N, f64>,
    is_regular: bool,
) -> Vec<usize> {
    let of = given.len();
    let mut columns = DMatrix::zeros(N, of);
    for (place, r) in given.iter().enumerate() {
        gradients.row(*r).iter().for_each(|(column, value)| columns[(column, place)] = value);
    }
    let mut root = DMatrix::zeros(N, N);
    mass.each_entry(|row, column, value| root[(row, column)] = value);
    let root = root.cholesky();
    if let Some(root) = root.filter(|_| is_regular) {
        root.l_dirty().solve_lower_triangular_mut(&mut columns);
    } else {
        for (mut row, entry) in columns.row_iter_mut().zip(&diagonal(mass)) {
            let entry = *entry;
            row /= if entry > 0.0 { entry.sqrt() } else { 1.0 };
        }
    }
    let lengths: Vec<f64> = columns.column_iter().map(|column| column.norm()).collect();
    let (mut kept, mut rest) = (Vec::with_capacity(of), (0..of).collect::<Vec<_>>());
    while !rest.is_empty() {
        let part = |r: usize| columns.column(r).norm() / lengths[r];
        // The largest row; of equal ones the first declared.
        let index =
            (1..rest.len()).fold(0, |best, index| if part(rest[index]) > part(rest[best]) { index } else { best });
        // False for a row without length.
        let is_independent = part(rest[index]) > INDEPENDENT;
        if !is_independent {
            break;
        }
        let r = rest.remove(index);
        kept.push(r);
        let chosen = columns.column(r).normalize();
        // Twice, so that the rest is orthogonal to rounding.
        for r in rest.iter().chain(&rest) {
            let shadow = chosen.dot(&columns.column(*r));
            columns.column_mut(*r).axpy(-shadow, &chosen, 1.0);
        }
    }
    kept
}
