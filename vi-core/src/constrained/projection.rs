//! The state on the constraints that is nearest to a given one, in the metric of the mass matrix M at that state.
//!
//! ```text
//! M (x − q) = Aᵀκ     g(t, x) = 0           coordinates
//! M (w − v) = Aᵀμ     A w + a = 0           velocities, at x
//! ```
//!
//! Held coordinates and their velocities do not change: they have no gradients here. A constraint on held coordinates
//! alone has to hold already, and has no multiplier.

use super::start::{CONSISTENT, redundant_rows};
use super::{is_shortened, reaction_of, spread, unsolvable, with_idle};
use crate::error::{BORDERED_MASS, StepError};
use crate::kind::{Gradients, Multipliers};
use crate::linear::{Bordered, Matrix, Rectangular};
use crate::motion::Motion;
use crate::newton::roundings;
use crate::node::Node;
use crate::real::Rounded;
use crate::state::{Numbers, State};
use crate::stepping::Convertible;
use crate::vector::{weights, worse};
use alloc::vec::Vec;
use nalgebra::{SMatrix, SVector};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

const ITERATIONS: u32 = 60;
const HALVINGS: u32 = 12;
/// Largest last correction of the coordinates, relative to their lengths: the nearest place is a minimum, which
/// rounding determines to half of the digits.
const CONVERGED: f64 = 1e-8;
/// The same for a place that satisfies the constraints to half a rounding.
const LAST: f64 = 4.0 * f64::EPSILON;
/// Moves along the constraints, and the longest one, over the coordinates, that may end them: distances of places nearer
/// to each other are equal to rounding.
const SLIDES: u32 = 500;
const ROUGH: f64 = 1e-6;
/// Residuals over their sizes at a place whose gradients show which constraints are redundant.
const HOLDS: f64 = 1e-14;

/// A state on the constraints, and how far it is from the given one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Projected<const N: usize> {
    /// The state.
    pub state: State<N>,
    /// Change of the coordinates.
    pub moved_q: SVector<f64, N>,
    /// Change of the velocities.
    pub moved_v: SVector<f64, N>,
    /// The energy at the new coordinates with the given velocities, less that of the state: the loss of a plastic
    /// impact, `½ moved_v·M moved_v` for constraints at rest. Constraints that move may also do work.
    pub energy_lost: f64,
}

/// Moves states onto the constraints of a system; [`State::projected`] without held coordinates.
#[derive(Clone, Copy, Debug)]
pub struct Projection<'a, S, const N: usize> {
    pub(super) system: &'a S,
    pub(super) held: [bool; N],
}

impl<const N: usize> State<N> {
    /// The state on the constraints that is nearest to time t, coordinates q and velocities v, in the metric of the mass
    /// matrix: first the coordinates, with the mass matrix at (t, q, v), then the velocities. Returns both changes, and
    /// the energy lost with the velocities. From beyond a centre of curvature of the constraints it may be another state
    /// whose distance is stationary.
    ///
    /// [`Projection::holding`] holds coordinates. [`State::assembled`] starts from far guesses. Redundant constraints need
    /// [`Independent`](super::Independent): `State::projected(&Independent::of(system), …)`.
    ///
    /// # Errors
    /// [`StepError::NotAssembled`] if no coordinates near q satisfy the constraints, [`StepError::Singular`] if the
    /// constraints are redundant on the way, [`StepError::NonFinite`].
    pub fn projected<S: Convertible<N>>(
        system: &S,
        t: f64,
        q: impl Numbers<N>,
        v: impl Numbers<N>,
    ) -> Result<Projected<N>, StepError> {
        Projection::of(system).projected(t, q, v)
    }
}

impl<'a, S: Convertible<N>, const N: usize> Projection<'a, S, N> {
    /// Moves every coordinate.
    #[must_use]
    pub fn of(system: &'a S) -> Self {
        Self { system, held: [false; N] }
    }

    /// Holds the coordinates of these indices, from 0, and their velocities.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] for an index out of range.
    pub fn holding(mut self, indices: &[usize]) -> Result<Self, StepError> {
        for index in indices {
            #[allow(clippy::cast_precision_loss)] // for the message
            let value = *index as f64;
            let (input, allowed) = ("the index of a coordinate", "below the number of coordinates");
            *self.held.get_mut(*index).ok_or(StepError::InvalidInput { input, allowed, value })? = true;
        }
        Ok(self)
    }

    /// The nearest state with the held coordinates. If L is linear in the velocities, only the velocities move: to those of
    /// the coordinates.
    ///
    /// # Errors
    /// As [`State::projected`]; [`StepError::Singular`] also if the held coordinates leave no motion, or do not satisfy
    /// a constraint on them alone; [`StepError::InconsistentStart`] if their velocities do not.
    pub fn projected(&self, t: f64, q: impl Numbers<N>, v: impl Numbers<N>) -> Result<Projected<N>, StepError> {
        let (q, v) = (q.vector(), v.vector());
        if self.system.is_first_order() {
            let state = State::at(self.system, t, q, v);
            let moved_v = state.velocity(self.system)? - v;
            return Ok(Projected { state, moved_q: SVector::zeros(), moved_v, energy_lost: 0.0 });
        }
        self.explained((t, &q, &v), || self.found((t, &q, &v), false))
    }

    /// The nearest state, or one from a far guess. If none satisfies all constraints and some follow from the others,
    /// the state without these constraints, if they hold at it.
    pub(super) fn found(
        &self,
        place: (f64, &SVector<f64, N>, &SVector<f64, N>),
        is_far: bool,
    ) -> Result<Projected<N>, StepError> {
        let failure = match self.found_by_all(place, is_far) {
            Err(failure @ (StepError::Singular { .. } | StepError::NotAssembled { .. })) => failure,
            found => return found,
        };
        let Some(kept) = self.without_redundant(place) else { return Err(failure) };
        let found = Projection { system: &kept, held: self.held }.found_by_all(place, is_far)?;
        let State { t, q, .. } = found.state;
        match kept.broken(t, &q, &(place.2 + found.moved_v)) {
            Some(_) => Err(failure),
            None => Ok(found),
        }
    }

    /// [`Projection::found`] with all constraints.
    fn found_by_all(
        &self,
        place: (f64, &SVector<f64, N>, &SVector<f64, N>),
        is_far: bool,
    ) -> Result<Projected<N>, StepError> {
        let (t, q, v) = place;
        let x = match self.nearest(place, q, None) {
            Ok(Some(x)) => x,
            Err(failure @ StepError::NonFinite { .. }) => return Err(failure),
            _ if is_far => self.continued(place).or_else(|failure| self.relaxed(place).ok_or(failure))?,
            failure => {
                let failure = failure.err().unwrap_or_else(|| self.open(t, q, 0.0));
                self.slid(place).ok_or(failure)?
            }
        };
        self.with_velocities(t, [q, &x], v)
    }

    /// The system without the constraints that follow from the others at the place of least squares. `None` if there are
    /// none, or if its type keeps all.
    fn without_redundant(&self, place: (f64, &SVector<f64, N>, &SVector<f64, N>)) -> Option<S> {
        // With held coordinates constraints may depend on each other that are independent in the mechanism.
        if self.held.contains(&true) {
            return None;
        }
        self.system.without(&[])?;
        let (t, _, v) = place;
        let x = self.least_squares(place, |x, left| (left < HOLDS).then_some(*x))?;
        let mass = self.system.point(t, &x, v).mass;
        let (gradients, _) = self.system.constraint_gradients(t, &x);
        let is_regular = Bordered::new(N, 0, self.system.blocks()).factor(&mass, &gradients).is_ok();
        let given: Vec<usize> =
            (0..self.system.constraint_names().len()).filter(|r| !self.system.is_dropped(*r)).collect();
        let redundant = redundant_rows(&gradients, &given, &mass, is_regular);
        if redundant.is_empty() { None } else { self.system.without(&redundant) }
    }

    /// The result of `find` for a finite place; its failure names the expression that is not finite.
    pub(super) fn explained<R>(
        &self,
        (t, q, v): (f64, &SVector<f64, N>, &SVector<f64, N>),
        find: impl FnOnce() -> Result<R, StepError>,
    ) -> Result<R, StepError> {
        let given = Node::new(State { t, q: *q, p: *v }, 0.0);
        given.check_finite(0.0)?;
        find().map_err(|failure| failure.explained(self.system, &given, 0.0, v))
    }

    /// For each constraint that is not dropped, whether the held coordinates alone decide on it.
    pub(super) fn fixed(&self, gradients: &Gradients<S, N>) -> Vec<bool> {
        let is_zero = |r: usize| gradients.row(r).iter().all(|(_, entry)| entry == 0.0);
        let is_fixed = |r: usize| self.held.contains(&true) && !self.system.is_dropped(r) && is_zero(r);
        (0..self.system.constraint_names().len()).map(is_fixed).collect()
    }

    /// Factors the mass matrix bordered by gradients, without dropped and fixed constraints.
    fn border(
        &self,
        bordered: &mut Bordered,
        (mass, gradients, fixed): (&SMatrix<f64, N, N>, &Gradients<S, N>, &[bool]),
        t: f64,
    ) -> Result<(), StepError> {
        let factored = bordered.factor_without(mass, gradients, |r| fixed[r] || self.system.is_dropped(r));
        factored.map_err(|failure| unsolvable(failure, t))
    }

    /// The mass matrix without the coupling of held coordinates.
    fn mass(&self, t: f64, q: &SVector<f64, N>, v: &SVector<f64, N>) -> SMatrix<f64, N, N> {
        let mass = self.system.point(t, q, v).mass.dense();
        SMatrix::from_fn(|i, j| match (self.held[i] || self.held[j], i == j) {
            (false, _) => mass[(i, j)],
            (true, is_diagonal) => f64::from(u8::from(is_diagonal)),
        })
    }

    /// The mass matrix that measures moves; see [`with_idle`].
    pub(super) fn metric(&self, (t, q, v): (f64, &SVector<f64, N>, &SVector<f64, N>)) -> SMatrix<f64, N, N> {
        let mass = self.mass(t, q, v);
        let (gradients, _) = self.gradients(t, q);
        with_idle(&mass, &gradients, self.system.holonomic()).unwrap_or(mass)
    }

    /// A and a, without gradients along held coordinates.
    pub(super) fn gradients(&self, t: f64, q: &SVector<f64, N>) -> (Gradients<S, N>, Multipliers<S, N>) {
        let (mut gradients, rates) = self.system.constraint_gradients(t, q);
        for r in 0..self.system.constraint_names().len() {
            let (columns, values) = gradients.row_mut(r);
            for (column, value) in columns.iter().zip(values) {
                if self.held[*column] {
                    *value = 0.0;
                }
            }
        }
        (gradients, rates)
    }

    /// The state at x with the velocities nearest to v.
    pub(super) fn with_velocities(
        &self,
        t: f64,
        [q, x]: [&SVector<f64, N>; 2],
        v: &SVector<f64, N>,
    ) -> Result<Projected<N>, StepError> {
        let system = self.system;
        let bordered = &mut Bordered::new(N, system.constraint_names().len(), &[]);
        let (gradients, _) = self.gradients(t, x);
        let fixed = self.fixed(&gradients);
        self.border(bordered, (&self.mass(t, x, v), &gradients, &fixed), t)?;
        let (all, rates) = system.constraint_gradients(t, x);
        let mut w = *v;
        for (r, rate) in rates.as_ref().iter().enumerate().filter(|(r, _)| fixed[*r]) {
            let (row, value) = (all.row(r), all.row(r).dot(v) + rate);
            if roundings(value, row.terms(v) + rate.abs()) > CONSISTENT {
                let constraint = system.constraint_names()[r];
                return Err(StepError::InconsistentStart { constraint, residual: 0.0, rate: value });
            }
        }
        // The second correction removes the rounding errors of the first.
        for _ in 0..2 {
            let (mut correction, mut rows) = (SVector::zeros(), rates);
            for (row, gradient) in rows.as_mut().iter_mut().zip(all.rows()) {
                *row += gradient.dot(&w);
            }
            bordered.solve(&mut correction, rows.as_mut());
            w -= correction;
        }
        let state = State::at(system, t, *x, w);
        let energy_lost = system.energy(t, x, v) - system.energy(t, x, &w);
        if !state.q.iter().chain(&state.p).chain(&[energy_lost]).all(|entry| entry.is_finite()) {
            return Err(StepError::NonFinite { t, quantity: "momentum or energy", expression: None });
        }
        Ok(Projected { state, moved_q: x - q, moved_v: w - v, energy_lost })
    }

    /// The nearest place from one on the constraints that [`Projection::relaxed`] finds: it slides along the constraints
    /// while it comes nearer. `None` if there is none, or if it ends elsewhere.
    fn slid(&self, place: (f64, &SVector<f64, N>, &SVector<f64, N>)) -> Option<SVector<f64, N>> {
        let (t, q, _) = place;
        let mass = self.metric(place);
        let weights = weights(&mass.diagonal());
        let distance = |x: &SVector<f64, N>| (x - q).dot(&(mass * (x - q)));
        let mut x = self.relaxed(place)?;
        let mut last = f64::INFINITY;
        for _ in 0..SLIDES {
            // The move to q without its parts across the constraints.
            let bordered = &mut Bordered::new(N, self.system.holonomic(), &[]);
            let (gradients, _) = self.gradients(t, &x);
            self.border(bordered, (&mass, &gradients, &self.fixed(&gradients)), t).ok()?;
            let mut along = mass * (q - x);
            let mut none = self.system.constraints(t, &x);
            none.as_mut().fill(0.0);
            bordered.solve(&mut along, &mut none.as_mut()[..self.system.holonomic()]);
            let length = along.component_mul(&weights).norm();
            let size = (x.abs() + q.abs()).component_mul(&weights).norm();
            if length <= CONVERGED * size {
                return Some(x);
            }
            let next = (0..=HALVINGS).find_map(|halved| {
                let part = 0.5_f64.powi(i32::try_from(halved).unwrap_or(0));
                let next = self.nearest(place, &(x + along * part), None).ok()??;
                Some(next).filter(|next| distance(next) < distance(&x))
            });
            // Moves that no longer become shorter are roundings.
            let Some(next) = next.filter(|_| length < last || length > ROUGH * size) else {
                return (length <= ROUGH * size).then_some(x);
            };
            (x, last) = (next, length);
        }
        None
    }

    /// The coordinates with the values `target` of g, zero without, that are nearest to `from` by the mass matrix at (t,
    /// q, v), by Newton iteration. Corrections are halved until the next one, with the same factors, is shorter: lengths
    /// by the mass matrix compare what residuals of forces and of constraints do not.
    ///
    /// # Errors
    /// `None` inside if the iteration ends elsewhere.
    pub(super) fn nearest(
        &self,
        (t, q, v): (f64, &SVector<f64, N>, &SVector<f64, N>),
        from: &SVector<f64, N>,
        target: Option<&Multipliers<S, N>>,
    ) -> Result<Option<SVector<f64, N>>, StepError> {
        let (system, holonomic) = (self.system, self.system.holonomic());
        let mass = self.metric((t, q, v));
        let weights = weights(&mass.diagonal());
        let [_, positions] = spread(&mass, q, &SVector::zeros());
        let bordered = &mut Bordered::new(N, holonomic, &[]);
        let mut zero = system.constraints(t, q);
        zero.as_mut().fill(0.0);
        let target = target.unwrap_or(&zero).as_ref();
        let fixed = self.fixed(&self.gradients(t, from).0);
        let at = |x: SVector<f64, N>, kappa: Multipliers<S, N>| {
            let mut values = system.constraints(t, &x);
            let (gradients, _) = self.gradients(t, &x);
            for (r, (value, target)) in values.as_mut().iter_mut().zip(target).enumerate() {
                *value = if fixed[r] || system.is_dropped(r) { 0.0 } else { *value - target };
            }
            let row = mass * (x - from) - reaction_of(&gradients, kappa.as_ref());
            (x, kappa, row, values, gradients)
        };
        // The largest constraint over its rounding errors, with coordinates that are known to `known` ulps.
        let violation = |x: &SVector<f64, N>, values: &Multipliers<S, N>, known: &SVector<f64, N>| {
            let (all, _) = system.constraint_gradients(t, x);
            let bounds = system.convert::<Rounded>().constraints(Rounded::exact(t), &x.map(Rounded::nearest));
            (0..holonomic).fold(0.0, |worst, r| {
                let bound = bounds.as_ref()[r].ulps() + all.row(r).terms(known) + target[r].abs();
                worse(roundings(values.as_ref()[r], bound), worst)
            })
        };
        // No motion of the other coordinates satisfies these.
        let mut values = system.constraints(t, from);
        for (r, (value, target)) in values.as_mut().iter_mut().zip(target).enumerate() {
            *value = if fixed[r] { *value - target } else { 0.0 };
        }
        if fixed.contains(&true) && violation(from, &values, &positions) > CONSISTENT {
            return Err(StepError::Singular { t, matrix: BORDERED_MASS });
        }
        let mut found = at(*from, zero);
        let mut iterations = 0;
        loop {
            let (x, kappa, row, values, gradients) = found;
            if !row.iter().chain(values.as_ref()).all(|entry| entry.is_finite()) {
                return Err(StepError::NonFinite { t, quantity: "constraint", expression: None });
            }
            let bend = system.reaction_derivatives(t, &x, &kappa);
            let mut curved = mass;
            for (i, row) in bend.rows().enumerate() {
                for (j, slope) in row.iter().filter(|(j, _)| !self.held[i] && !self.held[*j]) {
                    curved[(i, j)] -= slope;
                }
            }
            self.border(bordered, (&curved, &gradients, &fixed), t)?;
            let mut correct = |mut row: SVector<f64, N>, mut values: Multipliers<S, N>| {
                bordered.solve(&mut row, &mut values.as_mut()[..holonomic]);
                let length = row.component_mul(&weights).norm();
                (row, values, length)
            };
            let (correction, change, length) = correct(row, values);
            let size = (x.abs() + from.abs() + positions).component_mul(&weights).norm();
            if length <= LAST * size && violation(&x, &values, &SVector::zeros()) <= 0.5 {
                return Ok(Some(x));
            }
            let next = (0..=HALVINGS).find_map(|halved| {
                let part = 0.5_f64.powi(i32::try_from(halved).unwrap_or(0));
                let mut next = kappa;
                for (kappa, change) in next.as_mut().iter_mut().zip(change.as_ref()).take(holonomic) {
                    *kappa -= change * part;
                }
                let next = at(x - correction * part, next);
                let (.., left) = correct(next.2, next.3);
                Some(next).filter(|_| is_shortened(left, length, part))
            });
            iterations += 1;
            let Some(next) = next.filter(|_| iterations < ITERATIONS) else {
                let is_found = length <= CONVERGED * size && violation(&x, &values, &positions) <= CONSISTENT;
                // Roundings of large coordinates hide the effect of the last correction on small ones.
                let last = x - correction;
                let zeros = SVector::zeros();
                let is_better = violation(&last, &at(last, kappa).3, &zeros) < violation(&x, &values, &zeros);
                return Ok(is_found.then_some(if is_better { last } else { x }));
            };
            found = next;
        }
    }
}
