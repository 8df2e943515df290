//! Systems with redundant constraints: an independent subset, chosen at one place.
//!
//! A dropped constraint has no gradient and no multiplier: the motion is unique, and the reaction of the others is that
//! of all. Every step measures the dropped constraints at its end, because elsewhere they may become independent.

use super::start::{STORED, redundant_rows};
use super::{constrained_acceleration, constrained_flow, spread};
use crate::error::StepError;
use crate::forward;
use crate::kind::{Gradients, Multipliers, ReactionMatrix};
use crate::lagrangian::{Described, Flow, Lagrangian, Parameters};
use crate::linear::{Bordered, Rectangular};
use crate::motion::Motion;
use crate::newton::roundings;
use crate::node::Node;
use crate::real::{Real, Rounded};
use crate::state::{Numbers, State};
use crate::stepping::Convertible;
use alloc::vec::Vec;
use nalgebra::SVector;

/// Numbers of 64 bits for the set of dropped constraints.
const WORDS: usize = 8;
/// Largest value of a dropped constraint at a node over the size of its terms.
const HOLDS: f64 = 1e-9;

/// A system without those of its constraints that follow from the others; see [`Independent::at`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Independent<S> {
    system: S,
    dropped: [u64; WORDS],
}

impl<S> Independent<S> {
    /// Keeps an independent subset of the constraints of a system at time t and coordinates q that satisfy them. Runs of
    /// the result have a unique motion; dropped constraints have the reaction 0.
    ///
    /// Every step checks that the dropped constraints hold at its end. It fails with [`StepError::DroppedConstraint`] if
    /// one does not: its lengths contradict those of the others, or it follows from them at this place only, as in a
    /// linkage that is flat. `State::projected(&Independent::of(system), t, q, v)` finds coordinates that satisfy all.
    ///
    /// # Errors
    /// [`StepError::InconsistentStart`] for coordinates that do not satisfy the constraints: there others are redundant.
    /// [`StepError::InvalidInput`] for more than 512 constraints, [`StepError::NonFinite`].
    pub fn at<const N: usize>(system: S, t: f64, q: impl Numbers<N>) -> Result<Self, StepError>
    where
        S: Convertible<N>,
    {
        let of = system.constraint_names().len();
        if of > 64 * WORDS {
            #[allow(clippy::cast_precision_loss)] // for the message
            let value = of as f64;
            let (input, allowed) = ("the number of constraints", "at most 512 if some are redundant");
            return Err(StepError::InvalidInput { input, allowed, value });
        }
        let q = q.vector();
        let rest = SVector::zeros();
        Node::new(State { t, q, p: rest }, 0.0).check_finite(0.0)?;
        let mass = system.point(t, &q, &rest).mass;
        let (gradients, _) = system.constraint_gradients(t, &q);
        let [_, positions] = spread(&mass, &q, &rest);
        let values = system.convert::<Rounded>().constraints(Rounded::exact(t), &q.map(Rounded::nearest));
        for (r, value) in values.as_ref().iter().enumerate().take(system.holonomic()) {
            let residual = value.to_f64();
            if roundings(residual, value.ulps() + gradients.row(r).terms(&positions)) > STORED {
                let constraint = system.constraint_names()[r];
                return Err(StepError::InconsistentStart { constraint, residual, rate: 0.0 });
            }
        }
        let is_regular = Bordered::new(N, 0, system.blocks()).factor(&mass, &gradients).is_ok();
        let all: Vec<usize> = (0..of).collect();
        let redundant = redundant_rows(&gradients, &all, &mass, is_regular);
        Ok(Self::of(system).dropping(redundant))
    }

    /// Keeps all constraints; [`Motion::without`] drops some.
    pub fn of(system: S) -> Self {
        Self { system, dropped: [0; WORDS] }
    }

    /// Drops the constraints of these indices, below 512.
    fn dropping(mut self, constraints: impl IntoIterator<Item = usize>) -> Self {
        for r in constraints {
            self.dropped[r / 64] |= 1 << (r % 64);
        }
        self
    }

    /// The system with all constraints.
    pub fn system(&self) -> &S {
        &self.system
    }

    /// Whether the constraint of this index in [`Motion::CONSTRAINTS`] is dropped.
    pub fn is_dropped(&self, constraint: usize) -> bool {
        self.dropped.get(constraint / 64).is_some_and(|word| word >> (constraint % 64) & 1 == 1)
    }

    /// The names of the dropped constraints.
    pub fn dropped_names<const N: usize>(&self) -> impl Iterator<Item = &'static str>
    where
        S: Motion<N>,
    {
        let names = self.system.constraint_names().iter().enumerate();
        names.filter(|(constraint, _)| self.is_dropped(*constraint)).map(|(_, name)| *name)
    }

    /// The dropped constraints, with the values at a state that they should not have: g, or `A v + a` of a nonholonomic
    /// constraint.
    ///
    /// # Errors
    /// As [`State::velocity`].
    pub fn dropped<const N: usize>(&self, state: &State<N>) -> Result<Vec<(&'static str, f64)>, StepError>
    where
        S: Motion<N>,
    {
        let v = state.velocity(self)?;
        Ok(self
            .measured(state.t, &state.q, &v)
            .map(|(r, value, _)| (self.system.constraint_names()[r], value))
            .collect())
    }

    /// Index, value and terms of each dropped constraint.
    fn measured<const N: usize, T: Real>(
        &self,
        t: T,
        q: &SVector<T, N>,
        v: &SVector<T, N>,
    ) -> impl Iterator<Item = (usize, T, T)>
    where
        S: Motion<N, T>,
    {
        let values = self.system.constraints(t, q);
        let (gradients, rates) = self.system.constraint_gradients(t, q);
        let dropped = (0..self.system.constraint_names().len()).filter(|r| self.is_dropped(*r));
        let measured = dropped.map(move |r| {
            let (gradient, rate) = (gradients.row(r), rates.as_ref()[r]);
            if r < self.system.holonomic() {
                (r, values.as_ref()[r], gradient.terms(q) + (rate * t).abs())
            } else {
                (r, gradient.dot(v) + rate, gradient.terms(v) + rate.abs())
            }
        });
        measured.collect::<Vec<_>>().into_iter()
    }

    /// Removes the rows of dropped constraints.
    fn without_dropped<const N: usize, T: Real>(
        &self,
        mut rows: (Gradients<S, N, T>, Multipliers<S, N, T>),
    ) -> (Gradients<S, N, T>, Multipliers<S, N, T>)
    where
        S: Motion<N, T>,
    {
        for r in (0..self.system.constraint_names().len()).filter(|r| self.is_dropped(*r)) {
            rows.0.row_mut(r).1.fill(T::zero());
            rows.1.as_mut()[r] = T::zero();
        }
        rows
    }
}

impl<const N: usize, T: Real, S: Motion<N, T>> Lagrangian<N, T> for Independent<S> {
    forward! { [N T S] self => &self.system; [#[inline]] lagrangian_facts lagrangian }

    fn acceleration(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Result<SVector<T, N>, StepError> {
        constrained_acceleration(self, t, q, v)
    }

    fn flow(&self, t: T, q: &SVector<T, N>, p: &SVector<T, N>) -> Result<Flow<N, T>, StepError> {
        constrained_flow(self, t, q, p)
    }
}

impl<const N: usize, T: Real, S: Motion<N, T>> Motion<N, T> for Independent<S> {
    forward! { [N T S] self => &self.system; [] motion_facts motion }

    fn constraint_gradients(&self, t: T, q: &SVector<T, N>) -> (Gradients<Self, N, T>, Multipliers<Self, N, T>) {
        self.without_dropped(self.system.constraint_gradients(t, q))
    }
    fn constraint_rate_derivatives(
        &self,
        t: T,
        q: &SVector<T, N>,
        v: &SVector<T, N>,
    ) -> (Gradients<Self, N, T>, Multipliers<Self, N, T>) {
        self.without_dropped(self.system.constraint_rate_derivatives(t, q, v))
    }
    fn reaction_derivatives(
        &self,
        t: T,
        q: &SVector<T, N>,
        multipliers: &Multipliers<Self, N, T>,
    ) -> ReactionMatrix<Self, N, T> {
        let mut kept = *multipliers;
        for r in (0..self.system.constraint_names().len()).filter(|r| self.is_dropped(*r)) {
            kept.as_mut()[r] = T::zero();
        }
        self.system.reaction_derivatives(t, q, &kept)
    }
    fn is_dropped(&self, constraint: usize) -> bool {
        Self::is_dropped(self, constraint)
    }
    fn without(&self, constraints: &[usize]) -> Option<Self> {
        let count = self.system.constraint_names().len().min(64 * WORDS);
        constraints.iter().all(|r| *r < count).then(|| self.dropping(constraints.iter().copied()))
    }
    fn broken(&self, t: T, q: &SVector<T, N>, v: &SVector<T, N>) -> Option<(usize, T)> {
        if self.dropped == [0; WORDS] {
            return None;
        }
        let mut measured = self.measured(t, q, v);
        // False for NaN.
        let holds = |value: T, scale: T| value.to_f64().abs() <= HOLDS * scale.to_f64();
        measured.find(|(_, value, scale)| !holds(*value, *scale)).map(|(r, value, _)| (r, value))
    }
}

impl<const N: usize, S: Convertible<N>> Convertible<N> for Independent<S> {
    type In<T: Real> = Independent<S::In<T>>;

    fn convert<T: Real>(&self) -> Self::In<T> {
        Independent { system: self.system.convert(), dropped: self.dropped }
    }
}

impl<S: Described> Described for Independent<S> {
    const ABOUT: &'static str = S::ABOUT;
    const PARAMETERS_ABOUT: &'static [&'static str] = S::PARAMETERS_ABOUT;
    const DEFINITION: &'static str = S::DEFINITION;

    fn about(&self) -> &'static str {
        self.system.about()
    }
    fn parameters_about(&self) -> &'static [&'static str] {
        self.system.parameters_about()
    }
    fn definition(&self) -> &'static str {
        self.system.definition()
    }
}

impl<T: Real, S: Parameters<T>> Parameters<T> for Independent<S> {
    fn parameter_mut(&mut self, name: &str) -> Option<&mut T> {
        self.system.parameter_mut(name)
    }
}
