//! What the next step will be, foretold, and how far Newton's iteration may be trusted from there.
//!
//! In: the unknowns `u` of the last steps. Out: a guess of those of the next one, by a polynomial through the last m + 1
//! of them, and a distance ρ: a Newton step shorter than ρ leaves less than a share of one rounding, and nothing need be
//! evaluated to confirm it.
//!
//! ```text
//! guess   Σ w_i u_i,  w_i = (−1)^i binomial(m+1, i+1),  i = 0 the newest; error O(h^(m+1))
//! radius  after a step |δ| the next one is C |δ|²:  ρ² = share ε/C,  ε the length of a step that is all rounding
//! ```
//!
//! C and the best m change slowly along a motion. They are learnt from one step in 64 to 256, which starts on purpose
//! from the last u: its first two Newton steps are C, and which m would have guessed best is seen from the solution. A step
//! whose Newton steps do not come below ρ is taken by the slow way, which measures every residual.
//! Everything is one formula for one number or for lanes of them: conditions are indicators, 1 or 0 in each lane.

use crate::Real;
use nalgebra::SVector;

/// Steps between two that learn, at first.
const INTERVAL: u32 = 64;
/// The same where ρ stays as it is.
const LONG_INTERVAL: u32 = 256;
/// The same after ρ has become less than a quarter of what it was.
const ALERT: u32 = 8;
/// Unknowns that a guess is made of: the highest order is one less.
const DEPTH: usize = 8;
/// Unknowns that are kept to choose the order by: a power of two.
const RING: usize = 8;

/// Rows are orders m, columns the weights, the newest first.
const WEIGHTS: [[f64; DEPTH]; DEPTH] = [
    [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [2.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [3.0, -3.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0],
    [4.0, -6.0, 4.0, -1.0, 0.0, 0.0, 0.0, 0.0],
    [5.0, -10.0, 10.0, -5.0, 1.0, 0.0, 0.0, 0.0],
    [6.0, -15.0, 20.0, -15.0, 6.0, -1.0, 0.0, 0.0],
    [7.0, -21.0, 35.0, -35.0, 21.0, -7.0, 1.0, 0.0],
    [8.0, -28.0, 56.0, -70.0, 56.0, -28.0, 8.0, -1.0],
];

/// Guesses of the next M unknowns.
#[derive(Clone, Copy, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(
    feature = "serde",
    serde(bound(serialize = "T: Real + serde::Serialize", deserialize = "T: Real + serde::Deserialize<'de>"))
)]
pub(crate) struct Forecast<const M: usize, T> {
    /// The guess of the next step.
    guess: SVector<T, M>,
    /// What the steps up to now give to the guesses after the next one, each used up in its turn: a step adds its part to all
    /// of them at once, and none waits for another.
    parts: [SVector<T, M>; DEPTH - 1],
    /// The unknowns of the last steps in a ring, which is written in one place a step.
    last: [SVector<T, M>; RING],
    /// Where in the ring the newest stands.
    newest: usize,
    /// What the guess takes of each, the newest first.
    weights: [T; DEPTH],
    /// ρ²; zero where nothing is trusted.
    radius: T,
    /// Steps until the next one that learns.
    until: u32,
    /// Steps from the last one that learnt to the next.
    interval: u32,
    /// How many of these are steps, up to one more than there are.
    known: usize,
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
    /// ρ² = share ε/C with C = |δ2|/|δ1|², or less where that is below rounding.
    pub(crate) fn radius(&self, share: f64) -> T {
        let second = self.second.max(self.rounding).sqrt();
        let radius = self.rounding.sqrt() * self.first * T::real(share) / second;
        // 0/0: the first step had no length, and nothing was learnt.
        radius * self.first.is_above(T::zero())
    }
}

impl<const M: usize, T: Real> Forecast<M, T> {
    /// Before the first step, with a guess of it.
    pub(crate) fn new(guess: SVector<T, M>) -> Self {
        Self {
            guess,
            parts: [SVector::zeros(); DEPTH - 1],
            last: [guess; RING],
            newest: 0,
            weights: WEIGHTS[0].map(T::real),
            radius: T::zero(),
            until: 0,
            interval: INTERVAL,
            known: 0,
        }
    }

    /// Whether there was no step yet.
    pub(crate) fn is_new(&self) -> bool {
        self.known == 0
    }

    /// The unknowns of the last step.
    #[inline]
    pub(crate) fn newest(&self) -> SVector<T, M> {
        *self.before(0)
    }

    /// The unknowns of the step i before the last one.
    #[inline]
    fn before(&self, i: usize) -> &SVector<T, M> {
        &self.last[self.newest.wrapping_sub(i) % RING]
    }

    /// Whether everything is a finite number.
    pub(crate) fn is_finite(&self) -> bool {
        let vectors = self.last.iter().chain(&self.parts).chain([&self.guess]);
        let numbers = vectors.flat_map(|u| u.iter()).chain(&self.weights);
        numbers.chain([&self.radius]).all(|number| number.is_finite())
    }

    /// The guess of the next step.
    #[inline]
    pub(crate) fn guess(&self) -> SVector<T, M> {
        self.guess
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

    /// Takes the step `u` where no guess is needed.
    #[inline]
    pub(crate) fn replace(&mut self, u: SVector<T, M>) {
        self.last[self.newest % RING] = u;
    }

    /// Takes the step `u`.
    #[inline]
    pub(crate) fn push(&mut self, u: SVector<T, M>) {
        self.keep(u);
        self.until = self.until.saturating_sub(1);
        let [weight, weights @ .., last] = &self.weights;
        let [first, rest @ ..] = &mut self.parts;
        self.guess = *first + u * *weight;
        let mut part = first;
        for (later, weight) in rest.iter_mut().zip(weights) {
            *part = *later + u * *weight;
            part = later;
        }
        *part = u * *last;
    }

    #[inline]
    fn keep(&mut self, u: SVector<T, M>) {
        self.newest = (self.newest + 1) % RING;
        self.last[self.newest % RING] = u;
    }

    /// The guesses of the steps after the last one, by the weights as they are now.
    fn refresh(&mut self) {
        let sum = |forecast: &Self, ahead: usize| {
            let weights = forecast.weights.iter().skip(ahead).enumerate();
            weights.fold(SVector::zeros(), |sum, (i, weight)| sum + forecast.before(i) * *weight)
        };
        self.guess = sum(self, 0);
        for ahead in 1..DEPTH {
            self.parts[ahead - 1] = sum(self, ahead);
        }
    }

    /// Takes a step `u` that was not come by from here: the next one learns, unless this one should have.
    pub(crate) fn miss(&mut self, u: SVector<T, M>) {
        if self.is_learning() {
            self.learn(u, T::zero());
        } else {
            self.push(u);
            self.until = 0;
        }
    }

    /// Takes the step `u` that started from the last one, and ρ² as it taught.
    pub(crate) fn learn(&mut self, u: SVector<T, M>, radius: T) {
        let narrowed = !radius.is_above(self.radius * T::real(1.0 / 16.0)).holds();
        let steady = !narrowed && radius.at_most(self.radius * T::real(16.0)).holds();
        self.weights = self.best_weights(&u);
        self.radius = radius;
        self.keep(u);
        self.refresh();
        self.interval = match (narrowed, steady) {
            (true, _) => ALERT,
            (_, true) => (2 * self.interval).clamp(INTERVAL, LONG_INTERVAL),
            _ => INTERVAL,
        };
        // The first steps know no higher order yet.
        self.until = if self.known < DEPTH { 0 } else { self.interval - 1 };
        self.known = (self.known + 1).min(DEPTH);
    }

    /// The weights of the order that would have guessed `u` best: the highest up to which each order halves the error of the
    /// one before, so that no order is chosen by chance where the steps are not smooth. The error of order m is the difference
    /// of order m + 1 of the steps up to `u`.
    fn best_weights(&self, u: &SVector<T, M>) -> [T; DEPTH] {
        let mut best = WEIGHTS[0].map(T::real);
        let mut differences: [SVector<T, M>; DEPTH] = core::array::from_fn(|i| *self.before(i));
        let mut newest = u - differences[0];
        let (mut least, mut climbing) = (length_squared(&newest), T::one());
        for (order, weights) in WEIGHTS.iter().enumerate().take(self.known).skip(1) {
            for i in 0..DEPTH - order {
                differences[i] -= differences[i + 1];
            }
            newest -= differences[0];
            let distance = length_squared(&newest);
            climbing *= distance.at_most(least * T::real(0.25));
            for (weight, other) in best.iter_mut().zip(weights) {
                *weight += (T::real(*other) - *weight) * climbing;
            }
            least = distance;
        }
        best
    }
}

/// |u|², in four sums that do not wait for each other.
#[inline]
pub(crate) fn length_squared<const M: usize, T: Real>(u: &SVector<T, M>) -> T {
    let mut sums = [T::zero(); 4];
    for part in u.as_slice().chunks(4) {
        for (sum, entry) in sums.iter_mut().zip(part) {
            *sum += *entry * *entry;
        }
    }
    let [a, b, c, d] = sums;
    (a + b) + (c + d)
}
