//! What the next step will be, foretold, and how far Newton's iteration may be trusted from there.
//!
//! In: the unknowns `u` of the last steps. Out: a guess of those of the next one, by a polynomial through the last m + 1
//! of them, and a distance ρ: a Newton step shorter than ρ leaves less than a quarter of a rounding, and nothing need be
//! evaluated to confirm it.
//!
//! ```text
//! guess   Σ w_i u_i,  w_i = (−1)^i binomial(m+1, i+1),  i = 0 the newest           error O(h^(m+1))
//! radius  after a step |δ| the next one is C |δ|²:  ρ² = ε/(4 C),  ε the length of a step that is all rounding
//! ```
//!
//! C and the best m change slowly along a motion. They are learnt from one step in [`INTERVAL`], which starts on purpose
//! from the last u: its first two Newton steps are C, and which m would have guessed best is seen from the solution. A step
//! whose Newton steps do not come below ρ is taken by the slow way, which measures every residual.
//! Everything is one formula for one number or for lanes of them: conditions are indicators, 1 or 0 in each lane.

use crate::Real;
use nalgebra::SVector;

/// Steps between two that learn.
const INTERVAL: u32 = 64;
/// The same after ρ has become less than a quarter of what it was.
const ALERT: u32 = 8;
/// Velocities that are kept: the highest order is one less.
pub(crate) const DEPTH: usize = 7;

/// Rows are orders m, columns the weights of the last u, the newest first.
const WEIGHTS: [[f64; DEPTH]; DEPTH] = [
    [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [2.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [3.0, -3.0, 1.0, 0.0, 0.0, 0.0, 0.0],
    [4.0, -6.0, 4.0, -1.0, 0.0, 0.0, 0.0],
    [5.0, -10.0, 10.0, -5.0, 1.0, 0.0, 0.0],
    [6.0, -15.0, 20.0, -15.0, 6.0, -1.0, 0.0],
    [7.0, -21.0, 35.0, -35.0, 21.0, -7.0, 1.0],
];

/// Guesses of the next M unknowns.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: Real + serde::Serialize", deserialize = "T: Real + serde::Deserialize<'de>"))
)]
pub(crate) struct Forecast<const M: usize, T> {
    /// The unknowns of the last steps, the newest first; before there are so many the oldest stands in.
    last: [SVector<T, M>; DEPTH],
    /// What the guess takes of each.
    weights: [T; DEPTH],
    /// ρ²; zero where nothing is trusted.
    radius: T,
    /// Steps until the next one that learns.
    until: u32,
    /// How many of `last` are steps.
    known: u32,
}

/// What one step in many shows of Newton's iteration.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lesson<T> {
    /// |δ|² of the first Newton step, from the last u.
    pub(crate) first: T,
    /// |δ|² of the second.
    pub(crate) second: T,
    /// |δ|² of a step that is all rounding.
    pub(crate) rounding: T,
}

impl<T: Real> Lesson<T> {
    /// ρ² = ε/(4 C) with C = |δ2|/|δ1|², or less where that is below rounding.
    pub(crate) fn radius(&self) -> T {
        let second = self.second.max(self.rounding).sqrt();
        let radius = self.rounding.sqrt() * self.first * T::real(0.25) / second;
        // 0/0: the first step had no length, and nothing was learnt.
        radius * self.first.is_above(T::zero())
    }
}

impl<const M: usize, T: Real> Forecast<M, T> {
    /// Before the first step, with a guess of it.
    pub(crate) fn new(guess: SVector<T, M>) -> Self {
        let weights = WEIGHTS[0].map(T::real);
        Self { last: [guess; DEPTH], weights, radius: T::zero(), until: 0, known: 0 }
    }

    /// Whether there was no step yet.
    pub(crate) fn is_new(&self) -> bool {
        self.known == 0
    }

    /// The unknowns of the last step.
    #[inline]
    pub(crate) fn newest(&self) -> SVector<T, M> {
        let [newest, ..] = self.last;
        newest
    }

    /// Whether everything is a finite number.
    pub(crate) fn is_finite(&self) -> bool {
        let numbers = self.last.iter().flat_map(|u| u.iter()).chain(&self.weights);
        numbers.chain([&self.radius]).all(|number| number.is_finite())
    }

    /// The guess of the next step.
    #[inline]
    pub(crate) fn guess(&self) -> SVector<T, M> {
        let [newest, older @ ..] = &self.last;
        let [weight, weights @ ..] = self.weights;
        // The newest last: it is the one that is waited for.
        let older = older.iter().zip(weights).fold(SVector::zeros(), |sum, (u, weight)| sum + u * weight);
        older + newest * weight
    }

    /// ρ².
    #[inline]
    pub(crate) fn radius(&self) -> T {
        self.radius
    }

    /// Whether the next step is one that learns.
    #[inline]
    pub(crate) fn is_learning(&self) -> bool {
        self.until == 0
    }

    /// The forecast after the step `u` where none is needed.
    #[inline]
    pub(crate) fn with_newest(mut self, u: SVector<T, M>) -> Self {
        self.last[0] = u;
        self
    }

    /// The forecast after the step `u`.
    #[inline]
    pub(crate) fn after(mut self, u: SVector<T, M>) -> Self {
        let [a, b, c, d, e, f, _] = self.last;
        self.last = [u, a, b, c, d, e, f];
        self.until = self.until.saturating_sub(1);
        self
    }

    /// The forecast after a step `u` that was not come by from here: the next one learns, unless this one should have.
    pub(crate) fn missed(self, u: SVector<T, M>) -> Self {
        if self.is_learning() { self.learnt(u, T::zero()) } else { Self { until: 0, ..self.after(u) } }
    }

    /// The forecast after the step `u` that started from the last one, and what it taught.
    pub(crate) fn learnt(self, u: SVector<T, M>, radius: T) -> Self {
        let known = self.known;
        let narrowed = !radius.is_above(self.radius * T::real(1.0 / 16.0)).holds();
        let weights = self.best_weights(&u);
        // The first steps know no higher order yet.
        let until = match (known as usize) < DEPTH {
            true => 1,
            false if narrowed => ALERT,
            false => INTERVAL,
        };
        Self { weights, radius, until, known: known.saturating_add(1), ..self }.after(u)
    }

    /// The weights of the order that would have guessed `u` best.
    fn best_weights(&self, u: &SVector<T, M>) -> [T; DEPTH] {
        let mut weights = WEIGHTS[0].map(T::real);
        let mut least = self.distance(&weights, u);
        for row in WEIGHTS.iter().take(self.known as usize).skip(1) {
            let row = row.map(T::real);
            let distance = self.distance(&row, u);
            let better = least.is_above(distance);
            for (weight, other) in weights.iter_mut().zip(row) {
                *weight += (other - *weight) * better;
            }
            least += (distance - least) * better;
        }
        weights
    }

    /// Squared distance of a guess from `u`.
    fn distance(&self, weights: &[T; DEPTH], u: &SVector<T, M>) -> T {
        length_squared(&(Self { weights: *weights, ..*self }.guess() - u))
    }
}

/// |u|².
#[inline]
pub(crate) fn length_squared<const M: usize, T: Real>(u: &SVector<T, M>) -> T {
    u.iter().fold(T::zero(), |sum, entry| sum + *entry * *entry)
}
