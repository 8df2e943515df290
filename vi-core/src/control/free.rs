//! The search for an equilibrium without constraints.
//!
//! At rest `M a = F(t, q) = L_q + f − L_vt`. From a guess, damped Newton iteration approaches a root of F: a correction
//! is halved until K = −∂F/∂q changes by less than half along it, so that the iteration does not leap over a maximum of
//! the potential to a distant equilibrium. Undamped iteration to the rounding floor follows ([`newton`]).
//!
//! Forces may vanish by underflow, as far outside of a potential well. So the place of a root has to be known: K may
//! not change over the rounding errors of the root. Forces that do not depend on a free coordinate at the guess may
//! depend on it elsewhere, but not because of an underflow at the guess.

use super::{Equilibrium, spectrum};
use crate::error::StepError;
use crate::linear::{self, Matrix};
use crate::motion::{Motion, Point};
use crate::newton::{self, Equations, Failure, roundings, worst};
use crate::node::Node;
use crate::real::{Dual, Rounded};
use crate::state::State;
use crate::stepping::Convertible;
use crate::vector::worse;
use alloc::vec::Vec;
use core::array;
use nalgebra::{DMatrix, SMatrix, SVector};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

/// Damped steps, and halvings of each.
const STEPS: u32 = 200;
const HALVINGS: i32 = 40;
/// Largest relative change of K over a correction, and the parts of a correction at which it is measured.
const CHANGE: f64 = 0.5;
const PARTS: [f64; 3] = [1.0, 0.5, 0.25];
/// Largest distance from the guess, over its own size or the first correction.
const REACH: f64 = 1e4;
/// Binary exponents of the shortest and the longest moves of a free coordinate, and bisections of the place where the
/// forces begin to depend on it.
const MOVES: core::ops::Range<i32> = -52..64;
const BISECTIONS: u32 = 64;
/// Forces below this are underflows: they have lost digits.
const UNDERFLOW: f64 = f64::MIN_POSITIVE / f64::EPSILON;

/// The equilibrium near a guess; see [`Dynamics::equilibrium`](super::Dynamics::equilibrium).
pub(super) fn find<S: Convertible<N>, const N: usize>(
    system: &S,
    t: f64,
    guess: SVector<f64, N>,
) -> Result<Equilibrium<N>, StepError> {
    let (dual, rounded) = (system.convert::<Dual<f64>>(), system.convert::<Dual<Rounded>>());
    let mut rest = Rest { dual, rounded, t, free: [false; N], names: system.coordinates() };
    let finite = |of: Balance<N>, q: SVector<f64, N>| {
        let node = Node::new(State { t, q, p: SVector::zeros() }, 0.0);
        let lost = StepError::NonFinite { t, quantity: "generalized force", expression: None };
        if of.is_finite() { Ok(of) } else { Err(lost.explained(system, &node, 0.0, &SVector::zeros())) }
    };
    let start = finite(rest.linearized(&guess), guess)?;
    let is_zero = |i: usize, j: usize| start.stiffness[(i, j)] == 0.0;
    rest.free = array::from_fn(|k| (0..N).all(|other| is_zero(k, other) && is_zero(other, k)));
    let forces = rest.at(&guess);
    if (0..N).any(|k| rest.free[k] && roundings(forces.residual[k], forces.scale[k]) > newton::FLOOR) {
        return Err(rest.unbalanced(&guess));
    }
    if let Some(k) = (0..N).find(|k| rest.free[*k] && rest.underflows(&guess, *k)) {
        return Err(StepError::FreeMotion { t, coordinate: system.coordinates()[k] });
    }
    let near = rest.approached(guess, start)?;
    let root = newton::solve(&rest, near).map_err(|failure| match failure {
        Failure::Singular => rest.free_motion(&near),
        _ => rest.unbalanced(&near),
    })?;
    if free_coordinate(&rest.held(&root.at.stiffness)).is_some() {
        return Err(rest.free_motion(&root.u));
    }
    if !rest.is_known(&root.u, &root.at) {
        return Err(rest.unbalanced(&root.u));
    }
    let Balance { mass, damping, stiffness, .. } = finite(rest.linearized(&root.u), root.u)?;
    let residual = worst(&root.at.residual, &root.at.scale);
    let dense = |matrix: SMatrix<f64, N, N>| DMatrix::from_fn(N, N, |i, j| matrix[(i, j)]);
    let [mass, damping, stiffness] = [mass, damping, stiffness].map(dense);
    let free: Vec<usize> = (0..N).filter(|k| rest.free[*k]).collect();
    let free_motions = DMatrix::from_fn(N, free.len(), |k, motion| f64::from(u8::from(free[motion] == k)));
    let (multipliers, directions) = (Vec::new(), DMatrix::identity(N, N));
    Ok(Equilibrium { t, q: root.u, multipliers, directions, mass, damping, stiffness, free_motions, residual })
}

/// The equation F(t, q) = 0, of a system in dual numbers.
struct Rest<const N: usize, D, R> {
    dual: D,
    /// The same system over numbers with rounding-error bounds.
    rounded: R,
    t: f64,
    /// Coordinates on which nothing depends.
    free: [bool; N],
    names: [&'static str; N],
}

/// −F and its derivatives at rest.
struct Balance<const N: usize> {
    residual: SVector<f64, N>,
    stiffness: SMatrix<f64, N, N>,
    damping: SMatrix<f64, N, N>,
    mass: SMatrix<f64, N, N>,
    /// One ulp of the terms of −F; zero before the iteration to the rounding floor.
    scale: SVector<f64, N>,
}

/// The size of a move by the diagonal of a mass matrix. Unlike lengths of the coordinates, its kinetic energy has no units
/// of its own.
fn size_by<const N: usize>(mass: &SMatrix<f64, N, N>) -> impl Fn(&SVector<f64, N>) -> f64 + use<N> {
    // A coordinate without mass counts by its length.
    let weights = mass.diagonal().map(|mass| if mass == 0.0 { 1.0 } else { mass.abs() });
    move |u| u.component_mul(u).dot(&weights).sqrt()
}

impl<const N: usize> Balance<N> {
    fn is_finite(&self) -> bool {
        let Self { residual, stiffness, damping, mass, .. } = self;
        residual.iter().chain(stiffness).chain(damping).chain(mass).all(|entry| entry.is_finite())
    }
}

impl<const N: usize, D: Motion<N, Dual<f64>>, R: Motion<N, Dual<Rounded>>> Rest<N, D, R> {
    /// −F, its derivatives and M, without the rounding-error bounds. Along the direction of time of the dual numbers, a
    /// slope is a derivative with respect to t.
    fn linearized(&self, q: &SVector<f64, N>) -> Balance<N> {
        let (t, q, v) = (Dual::variable(self.t), q.map(Dual::fixed), SVector::zeros());
        let Point { momentum, force, .. } = self.dual.point(t, &q, &v);
        let of = self.dual.point_derivatives(t, &q, &v);
        let [momentum_dq, mass, force_dq, force_dv] =
            [of.momentum_dq, of.mass, of.force_dq, of.force_dv].map(|matrix| matrix.dense());
        Balance {
            residual: momentum.zip_map(&force, |momentum, force| momentum.slope - force.value),
            // L_vqt − ∂(L_q + f)/∂q
            stiffness: momentum_dq.zip_map(&force_dq, |momentum, force| momentum.slope - force.value),
            // L_vvt + L_vq − ∂(L_q + f)/∂v
            damping: SMatrix::from_fn(|i, j| mass[(i, j)].slope + (momentum_dq[(i, j)].value - force_dv[(i, j)].value)),
            mass: mass.map(|entry| entry.value),
            scale: SVector::zeros(),
        }
    }

    /// K with the rows and columns of free coordinates replaced by those of the identity.
    fn held(&self, stiffness: &SMatrix<f64, N, N>) -> SMatrix<f64, N, N> {
        let identity = SMatrix::<f64, N, N>::identity();
        SMatrix::from_fn(|i, j| if self.free[i] || self.free[j] { identity[(i, j)] } else { stiffness[(i, j)] })
    }

    /// Forces, zero on free coordinates.
    fn held_forces(&self, forces: &SVector<f64, N>) -> SVector<f64, N> {
        SVector::from_fn(|k, _| if self.free[k] { 0.0 } else { forces[k] })
    }

    /// A point from which undamped Newton iteration converges.
    fn approached(&self, mut q: SVector<f64, N>, mut at: Balance<N>) -> Result<SVector<f64, N>, StepError> {
        let size = size_by(&at.mass);
        let (guess, mut reach) = (q, REACH * size(&q));
        for step in 0..STEPS {
            let stiffness = self.held(&at.stiffness);
            let solved = |forces: &SVector<f64, N>| linear::solve(&stiffness, forces);
            let correction = solved(&self.held_forces(&at.residual)).ok_or_else(|| self.free_motion(&q))?;
            if step == 0 {
                reach = reach.max(REACH * size(&correction));
            }
            let is_similar = |factor: f64| {
                let there = self.linearized(&(q - correction * factor));
                let change = solved(&((self.held(&there.stiffness) - stiffness) * correction));
                there.is_finite() && change.is_some_and(|change| size(&change) <= CHANGE * size(&correction))
            };
            // K is compared at parts of the correction, too: a whole turn of an angle does not change it.
            let is_short = |factor: &f64| PARTS.iter().all(|part| is_similar(factor * part));
            let factors = (0..HALVINGS).map(|halvings| 0.5_f64.powi(halvings));
            match factors.into_iter().find(is_short) {
                // The first trial.
                Some(factor) if factor > 0.5 => return Ok(q),
                // The force vanishes far away.
                Some(factor) if size(&(q - correction * factor - guess)) > reach => return Err(self.unbalanced(&q)),
                Some(factor) => q -= correction * factor,
                None => return Err(self.unbalanced(&q)),
            }
            at = self.linearized(&q);
        }
        Err(self.unbalanced(&q))
    }

    /// Whether the rounding errors of a root are small: K changes by less than half over them.
    fn is_known(&self, q: &SVector<f64, N>, at: &Balance<N>) -> bool {
        let stiffness = self.held(&at.stiffness);
        let Some(inverse) = linear::solve(&stiffness, &SMatrix::<f64, N, N>::identity()) else { return false };
        let errors = at.residual.abs() + at.scale * (newton::FLOOR * f64::EPSILON);
        let errors = inverse.abs() * self.held_forces(&errors);
        let size = size_by(&at.mass);
        // False for NaN.
        [1.0, -1.0].into_iter().all(|sign| {
            let there = self.held(&self.linearized(&(q + errors * sign)).stiffness);
            size(&(inverse * ((there - stiffness) * errors))) <= CHANGE * size(&errors)
        })
    }

    /// Whether the forces begin to depend on a free coordinate, elsewhere, by an underflow.
    fn underflows(&self, q: &SVector<f64, N>, k: usize) -> bool {
        let (here, length) = (self.linearized(q).residual, if q[k] == 0.0 { 1.0 } else { q[k].abs() });
        // The largest change of a force and the largest slope; NaN if one has no value.
        let change = |by: f64| {
            let mut moved = *q;
            moved[k] += by;
            let there = self.linearized(&moved);
            let slopes = (0..N).flat_map(|j| [there.stiffness[(k, j)], there.stiffness[(j, k)]]);
            let changes = (0..N).map(|j| there.residual[j] - here[j]);
            slopes.chain(changes).fold(0.0, |largest, number| worse(number.abs(), largest))
        };
        [1.0, -1.0].into_iter().any(|sign| {
            let moves = || MOVES.map(|exponent| sign * length * 2.0_f64.powi(exponent));
            let Some(place) = moves().position(|by| change(by) != 0.0) else { return false };
            let [mut near, mut far] = [place.checked_sub(1), Some(place)]
                .map(|place| place.and_then(|place| moves().nth(place)).unwrap_or(0.0));
            for _ in 0..BISECTIONS {
                let middle = 0.5 * (near + far);
                if change(middle) == 0.0 { near = middle } else { far = middle }
            }
            // False for NaN.
            change(far) < UNDERFLOW
        })
    }

    /// The force that remains at a point.
    fn unbalanced(&self, q: &SVector<f64, N>) -> StepError {
        let at = self.at(q);
        let size = |k: usize| roundings(at.residual[k], at.scale[k]);
        let worst = (0..N).fold(0, |worst, k| if size(k) > size(worst) { k } else { worst });
        StepError::NoEquilibrium { t: self.t, coordinate: self.names[worst], force: -at.residual[worst] }
    }

    /// The direction along which the force does not change at a point.
    fn free_motion(&self, q: &SVector<f64, N>) -> StepError {
        let stiffness = self.held(&self.linearized(q).stiffness);
        match free_coordinate(&stiffness) {
            Some(coordinate) => StepError::FreeMotion { t: self.t, coordinate: self.names[coordinate] },
            None => self.unbalanced(q),
        }
    }
}

/// The coordinate that moves most along a null vector of K; `None` if K is regular.
fn free_coordinate<const N: usize>(stiffness: &SMatrix<f64, N, N>) -> Option<usize> {
    let [rows, columns] = linear::weights(stiffness);
    let dense = DMatrix::from_fn(N, N, |i, j| stiffness[(i, j)]);
    spectrum::null_vector(&dense, &rows, &columns).map(|vector| vector.iamax())
}

impl<const N: usize, D, R> Equations<f64> for Rest<N, D, R>
where
    D: Motion<N, Dual<f64>>,
    R: Motion<N, Dual<Rounded>>,
{
    type Unknowns = SVector<f64, N>;
    type Evaluation = Balance<N>;

    fn at(&self, q: &SVector<f64, N>) -> Balance<N> {
        let t = Dual { value: Rounded::exact(self.t), slope: Rounded::exact(1.0) };
        let nearest = q.map(|number| Dual::fixed(Rounded::nearest(number)));
        let Point { momentum, force, .. } = self.rounded.point(t, &nearest, &SVector::zeros());
        let scale = momentum.zip_map(&force, |momentum, force| (momentum.slope - force.value).ulps());
        Balance { scale, ..self.linearized(q) }
    }

    fn roundings(&self, of: &Balance<N>, scales: &Balance<N>) -> [f64; 2] {
        [worst(&of.residual, &scales.scale), 0.0]
    }

    fn correction(&self, jacobian: &Balance<N>, residual: &Balance<N>) -> Result<SVector<f64, N>, Failure> {
        let forces = self.held_forces(&residual.residual);
        linear::solve(&self.held(&jacobian.stiffness), &forces).ok_or(Failure::Singular)
    }
}
