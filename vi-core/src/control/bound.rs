//! The search for an equilibrium on constraints.
//!
//! Along a symmetry, such as the spin of a top, the forces do not change, and Newton's iteration moves across it only.
//! At least one direction needs a stiffness. The place of the root has to be known: the stiffness may not change over
//! its rounding errors, as it does if forces underflow.

use super::Equilibrium;
use crate::constrained::{Projection, accelerations, border, bordered, is_reduced, is_shortened, reaction_of};
use crate::error::StepError;
use crate::kind::{Gradients, Multipliers};
use crate::linear::{Bordered, Matrix, Rectangular, Row};
use crate::motion::{Motion, Point};
use crate::newton::{FLOOR, roundings};
use crate::real::{Dual, Rounded};
use crate::stepping::Convertible;
use crate::vector::{weights, worse};
use alloc::vec::Vec;
use nalgebra::{DMatrix, DVector, SMatrix, SVector};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

const ITERATIONS: u32 = 100;
const HALVINGS: i32 = 20;

/// Largest stiffness of a free motion, over the largest one, at equal kinetic energies.
const FREE: f64 = 1e-11;
/// Largest relative change of the stiffness over the rounding errors of a root.
const CHANGE: f64 = 0.5;

/// The equilibrium near a guess; see [`Dynamics::equilibrium`](super::Dynamics::equilibrium).
pub(super) fn find<S: Convertible<N>, const N: usize>(
    system: &S,
    t: f64,
    guess: SVector<f64, N>,
) -> Result<Equilibrium<N>, StepError> {
    let place = Projection::of(system).assembled(t, guess, [0.0; N])?;
    let (_, rates) = system.constraint_gradients(t, &place.state.q);
    let moving = rates.as_ref().iter().zip(system.constraint_names()).find(|(rate, _)| **rate != 0.0);
    if let Some((rate, constraint)) = moving {
        return Err(StepError::InconsistentStart { constraint, residual: 0.0, rate: *rate });
    }
    let largest = (place.state.q - place.moved_q).amax();
    Rest::<S, N> { system, t, largest }.equilibrium(place.state.q)
}

/// A system at rest.
struct Rest<'a, S, const N: usize> {
    system: &'a S,
    t: f64,
    /// Size of the coordinates of the guess, because coordinates of an equilibrium at the origin have none.
    largest: f64,
}

/// −F − AᵀΛ and g at a place, with their derivatives.
struct Balance<S: Motion<N>, const N: usize> {
    q: SVector<f64, N>,
    multipliers: Multipliers<S, N>,
    force: SVector<f64, N>,
    values: Multipliers<S, N>,
    gradients: Gradients<S, N>,
    mass: SMatrix<f64, N, N>,
    damping: SMatrix<f64, N, N>,
    stiffness: SMatrix<f64, N, N>,
    /// Weights of the coordinates in lengths.
    weights: SVector<f64, N>,
    /// Bound of the rounding errors of a force, over its weight.
    bound: f64,
    /// Rows over their rounding errors.
    roundings: SVector<f64, N>,
    residual: f64,
}

impl<S: Convertible<N>, const N: usize> Rest<'_, S, N> {
    fn at(&self, q: SVector<f64, N>, multipliers: Multipliers<S, N>) -> Balance<S, N> {
        let Self { system, t, largest: of_guess } = *self;
        let dual = system.convert::<Dual<f64>>();
        let (time, place, still) = (Dual::variable(t), q.map(Dual::fixed), SVector::zeros());
        let Point { momentum, force, .. } = dual.point(time, &place, &still);
        let of = dual.point_derivatives(time, &place, &still);
        let [momentum_dq, mass, force_dq, force_dv] =
            [of.momentum_dq, of.mass, of.force_dq, of.force_dv].map(|matrix| matrix.dense());
        let (gradients, _) = system.constraint_gradients(t, &q);
        let reaction = reaction_of(&gradients, multipliers.as_ref());
        let unbalanced = momentum.zip_map(&force, |momentum, force| momentum.slope - force.value) - reaction;

        let rounded = system.convert::<Dual<Rounded>>();
        let time = Dual { value: Rounded::exact(t), slope: Rounded::exact(1.0) };
        let place = q.map(|number| Dual::fixed(Rounded::nearest(number)));
        let Point { momentum, force, .. } = rounded.point(time, &place, &SVector::zeros());
        let fixed: Vec<_> = multipliers.as_ref().iter().map(|number| Dual::fixed(Rounded::nearest(*number))).collect();
        let reaction = reaction_of(&rounded.constraint_gradients(time, &place).0, &fixed);
        let scale = SVector::<f64, N>::from_fn(|i, _| (momentum[i].slope - force[i].value - reaction[i].value).ulps());
        // The bound follows from the largest scale, at equal kinetic energies, because all terms of a force may vanish.
        let weights = weights(&SVector::<f64, N>::from_fn(|i, _| mass[(i, i)].value));
        let largest = scale.component_div(&weights).amax();
        let over = unbalanced.zip_map(&weights, |row, weight| roundings(row, weight * largest));
        let mut values = system.constraints(t, &q);
        let sizes = SVector::<f64, N>::repeat(of_guess.max(q.amax()));
        let mut residual = over.iter().fold(0.0, |worst, row| worse(*row, worst));
        for (r, value) in values.as_mut().iter_mut().enumerate() {
            if r >= system.holonomic() || system.is_dropped(r) {
                *value = 0.0;
            }
            residual = worse(roundings(*value, gradients.row(r).terms(&sizes)), residual);
        }
        // L_vqt − ∂(L_q + f)/∂q − ∂(AᵀΛ)/∂q
        let mut stiffness = momentum_dq.zip_map(&force_dq, |momentum, force| momentum.slope - force.value);
        for (i, row) in system.reaction_derivatives(t, &q, &multipliers).rows().enumerate() {
            row.iter().for_each(|(j, slope)| stiffness[(i, j)] -= slope);
        }
        Balance {
            q,
            multipliers,
            force: unbalanced,
            values,
            mass: mass.map(|entry| entry.value),
            // L_vvt + L_vq − ∂(L_q + f)/∂v
            damping: SMatrix::from_fn(|i, j| mass[(i, j)].slope + (momentum_dq[(i, j)].value - force_dv[(i, j)].value)),
            stiffness,
            gradients,
            weights,
            bound: FLOOR * f64::EPSILON * largest,
            roundings: over,
            residual,
        }
    }

    /// Damped Newton iteration from a place on the constraints, with the multipliers of the motion from rest there.
    fn equilibrium(&self, q: SVector<f64, N>) -> Result<Equilibrium<N>, StepError> {
        let Self { system, t, .. } = *self;
        let (_, multipliers) = accelerations(system, (t, &q, &SVector::zeros()), &mut bordered(system))?;
        let bordered = &mut Bordered::new(N, system.constraint_names().len(), &[]);
        let mut found = self.at(q, multipliers);
        for _ in 0..ITERATIONS {
            if found.residual.is_nan() {
                return Err(StepError::NonFinite { t, quantity: "generalized force", expression: None });
            }
            let singular = StepError::Singular { t, matrix: "stiffness matrix bordered by the constraints" };
            if border(bordered, system, &found.stiffness, &found.gradients).is_err() {
                let held = Along::of(&found).ok_or(singular)?.held(&found);
                border(bordered, system, &held, &found.gradients).map_err(|_| singular)?;
            }
            let mut correct = |mut force: SVector<f64, N>, mut values: Multipliers<S, N>| {
                bordered.solve(&mut force, values.as_mut());
                (force, values)
            };
            let (correction, change) = correct(found.force, found.values);
            let length = correction.component_mul(&found.weights).norm();
            let next = (0..HALVINGS).find_map(|halved| {
                let part = 0.5_f64.powi(halved);
                let mut next = found.multipliers;
                for (multiplier, change) in next.as_mut().iter_mut().zip(change.as_ref()) {
                    *multiplier -= change * part;
                }
                let next = self.at(found.q - correction * part, next);
                let (behind, _) = correct(next.force, next.values);
                let behind = behind.component_mul(&found.weights).norm();
                let is_nearer = found.residual > FLOOR && is_shortened(behind, length, part);
                Some(next).filter(|next| is_reduced(next.residual, found.residual) || is_nearer)
            });
            match next {
                Some(next) => found = next,
                None => break,
            }
        }
        if found.residual <= FLOOR
            && let Some(along) = Along::of(&found)
            && self.is_known(&found, &along)
        {
            return Ok(self.reduced(&found, &along));
        }
        let worst = found.roundings.iamax();
        Err(StepError::NoEquilibrium { t, coordinate: system.coordinates()[worst], force: -found.force[worst] })
    }

    /// Whether the rounding errors of a root are small: the stiffness changes by less than half over them.
    fn is_known(&self, found: &Balance<S, N>, along: &Along) -> bool {
        let Along { basis, softest: (stiffness, direction), .. } = along;
        #[allow(clippy::cast_precision_loss)] // a number of coordinates
        let error = found.bound * (N as f64).sqrt() / stiffness;
        let direction = basis * direction;
        let moved = SVector::<f64, N>::from_fn(|i, _| direction[i] * error / found.weights[i]);
        // False for NaN.
        [1.0, -1.0].into_iter().all(|sign| {
            let there = self.at(found.q + moved * sign, found.multipliers);
            let change = weighted(&(there.stiffness - found.stiffness), &found.weights) * &direction;
            (basis.transpose() * change).norm() <= CHANGE * stiffness
        })
    }

    /// The equilibrium with its matrices along the constraints.
    fn reduced(&self, found: &Balance<S, N>, of: &Along) -> Equilibrium<N> {
        let directions = directions(found.gradients.rows().map(Row::dense::<N>));
        let along = |matrix: &SMatrix<f64, N, N>| {
            let matrix = DMatrix::from_fn(N, N, |i, j| matrix[(i, j)]);
            directions.transpose() * matrix * &directions
        };
        Equilibrium {
            t: self.t,
            q: found.q,
            multipliers: found.multipliers.as_ref().to_vec(),
            mass: along(&found.mass),
            damping: along(&found.damping),
            stiffness: along(&found.stiffness),
            free_motions: of.free_motions(&found.weights),
            residual: found.residual,
            directions,
        }
    }
}

/// A matrix over the weights of its row and of its column.
fn weighted<const N: usize>(matrix: &SMatrix<f64, N, N>, weights: &SVector<f64, N>) -> DMatrix<f64> {
    DMatrix::from_fn(N, N, |i, j| matrix[(i, j)] / (weights[i] * weights[j]))
}

/// The stiffness along the constraints, in coordinates times their weights: its units do not matter.
struct Along {
    /// An orthonormal basis of the directions that the constraints allow.
    basis: DMatrix<f64>,
    /// Free motions in this basis, and their forces: the singular vectors on both sides.
    free: Vec<[DVector<f64>; 2]>,
    /// The largest singular value.
    largest: f64,
    /// The smallest singular value that is not free, with its direction.
    softest: (f64, DVector<f64>),
}

impl Along {
    /// `None` if no direction has a stiffness.
    fn of<S: Motion<N>, const N: usize>(found: &Balance<S, N>) -> Option<Self> {
        let weights = &found.weights;
        let basis = directions(found.gradients.rows().map(|row| row.dense::<N>().component_div(weights)));
        let stiffness = basis.transpose() * weighted(&found.stiffness, weights) * &basis;
        if stiffness.is_empty() || !stiffness.iter().all(|entry| entry.is_finite()) {
            return None;
        }
        let parts = stiffness.try_svd(true, true, f64::EPSILON, 100 * N)?;
        let (forces, directions) = (parts.u?, parts.v_t?);
        let largest = parts.singular_values.iter().copied().fold(0.0, f64::max);
        let direction = |index: usize| directions.row(index).transpose();
        let (mut free, mut softest) = (Vec::new(), None);
        for (index, value) in parts.singular_values.iter().enumerate() {
            if *value <= FREE * largest {
                free.push([direction(index), forces.column(index).into_owned()]);
            } else if softest.as_ref().is_none_or(|(least, _)| value < least) {
                softest = Some((*value, direction(index)));
            }
        }
        Some(Self { basis, free, largest, softest: softest? })
    }

    /// The stiffness matrix with the largest stiffness along free motions.
    fn held<S: Motion<N>, const N: usize>(&self, found: &Balance<S, N>) -> SMatrix<f64, N, N> {
        let mut held = found.stiffness;
        for [direction, force] in &self.free {
            let [direction, force] = [direction, force].map(|vector| &self.basis * vector);
            let weights = &found.weights;
            held += SMatrix::from_fn(|i, j| self.largest * weights[i] * force[i] * direction[j] * weights[j]);
        }
        held
    }

    /// The free motions in coordinates, of length 1.
    fn free_motions<const N: usize>(&self, weights: &SVector<f64, N>) -> DMatrix<f64> {
        let mut motions = DMatrix::zeros(N, self.free.len());
        for (index, [direction, _]) in self.free.iter().enumerate() {
            let direction = &self.basis * direction;
            let motion = DVector::from_fn(N, |i, _| direction[i] / weights[i]);
            motions.set_column(index, &motion.normalize());
        }
        motions
    }
}

/// An orthonormal basis of the vectors across these gradients, by orthogonalization with pivoting.
fn directions<const N: usize>(gradients: impl Iterator<Item = SVector<f64, N>>) -> DMatrix<f64> {
    let mut known: Vec<DVector<f64>> = Vec::with_capacity(N);
    let across = |mut vector: DVector<f64>, known: &[DVector<f64>]| {
        // Twice, so that the rest is orthogonal to rounding.
        for other in known.iter().chain(known) {
            let shadow = other.dot(&vector);
            vector.axpy(-shadow, other, 1.0);
        }
        vector
    };
    for gradient in gradients.filter(|gradient| gradient.amax() > 0.0) {
        // Divided by the largest entry first: squares of the entries may overflow or vanish.
        let gradient = DVector::from_column_slice((gradient / gradient.amax()).normalize().as_slice());
        known.push(across(gradient, &known).normalize());
    }
    let rank = known.len();
    while known.len() < N {
        let units = (0..N).map(|i| across(DVector::from_fn(N, |row, _| f64::from(u8::from(row == i))), &known));
        let Some(longest) = units.max_by(|one, other| one.norm().total_cmp(&other.norm())) else { break };
        known.push(longest.normalize());
    }
    DMatrix::from_fn(N, N - rank, |row, column| known[rank + column][row])
}
