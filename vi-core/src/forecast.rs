//! What the next step will be, foretold, and how far Newton's iteration may be trusted from there.
//!
//! In: the unknowns `u` of the last steps. Out: a guess of those of the next one, by a polynomial through the last m + 1
//! of them, and a distance ρ: a Newton step shorter than ρ leaves less than a share of one rounding, and nothing need be
//! evaluated to confirm it.
//!
//! ```text
//! guess   Σ ∇^k u,  k = 0..m, with the backward differences ∇^0 u = u, ∇^k u = ∇^(k−1) u − ∇^(k−1) u_before; error O(h^(m+1))
//! radius  after a step |δ| the next one is C |δ|²:  ρ² = share ε/C,  ε the length of a step that is all rounding
//! ```
//!
//! A new u enters all differences at once, none waits for another: `∇^k u = u − Σ_(j<k) ∇^j u_before`, and the sums are
//! there before u is.
//!
//! C and the best m change slowly along a motion. They are learnt from one step in 64 to 256, which starts on purpose
//! from the last u: its first two Newton steps are C, and which m would have guessed best is seen from the differences. A step
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
/// Differences that are kept. The last one is the error of the highest order, 6.
const DEPTH: usize = 8;

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
    /// Row k is ∇^k u of the last step.
    differences: [SVector<T, M>; DEPTH],
    /// 1 for each difference that the guess takes, 0 for those beyond its order.
    taken: [T; DEPTH],
    /// How many the guess takes.
    order: T,
    /// ρ²; zero where nothing is trusted.
    radius: T,
    /// Steps until the next one that learns.
    until: u32,
    /// Steps from the last one that learnt to the next.
    interval: u32,
    /// How many differences are those of steps.
    known: u8,
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
        let mut constant = Self {
            guess,
            differences: [SVector::zeros(); DEPTH],
            taken: [T::zero(); DEPTH],
            order: T::one(),
            radius: T::zero(),
            until: 0,
            interval: INTERVAL,
            known: 0,
        };
        (constant.differences[0], constant.taken[0]) = (guess, T::one());
        constant
    }

    /// Whether there was no step yet.
    pub(crate) fn is_new(&self) -> bool {
        self.known == 0
    }

    /// The unknowns of the last step.
    #[inline]
    pub(crate) fn newest(&self) -> SVector<T, M> {
        self.differences[0]
    }

    /// Whether everything is a finite number.
    pub(crate) fn is_finite(&self) -> bool {
        let numbers = self.differences.iter().chain([&self.guess]).flat_map(|u| u.iter()).chain(&self.taken);
        numbers.chain([&self.order, &self.radius]).all(|number| number.is_finite())
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
        self.differences[0] = u;
    }

    /// Takes the step `u`.
    #[inline]
    pub(crate) fn push(&mut self, u: SVector<T, M>) {
        self.until = self.until.saturating_sub(1);
        for i in 0..M {
            // `sum` is Σ ∇^j u_before over j < k, and `known` what the guess takes of these: neither waits for u.
            let (mut sum, mut known) = (T::zero(), T::zero());
            for (k, difference) in self.differences.iter_mut().enumerate() {
                let before = difference[i];
                if k == 0 {
                    (difference[i], sum) = (u[i], before);
                } else {
                    difference[i] = u[i] - sum;
                    known += sum * self.taken[k];
                    sum += before;
                }
            }
            self.guess[i] = u[i] * self.order - known;
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
        self.radius = radius;
        self.push(u);
        self.known = (self.known + 1).min(DEPTH as u8);
        self.choose_order();
        self.interval = match (narrowed, steady) {
            (true, _) => ALERT,
            (_, true) => (2 * self.interval).clamp(INTERVAL, LONG_INTERVAL),
            _ => INTERVAL,
        };
        // The first steps know no higher order yet.
        self.until = if usize::from(self.known) < DEPTH { 0 } else { self.interval - 1 };
    }

    /// The order that would have guessed the last step best: the highest up to which each order halves the error of the
    /// one before, so that no order is chosen by chance where the steps are not smooth. The error of order m is the difference
    /// of order m + 1.
    fn choose_order(&mut self) {
        let (mut least, mut climbing) = (length_squared(&self.differences[1]), T::one());
        (self.guess, self.order) = (self.differences[0], T::one());
        for k in 1..DEPTH {
            let error = self.differences.get(k + 1).filter(|_| k + 1 < usize::from(self.known)).map(length_squared);
            climbing = error.map_or(T::zero(), |error| climbing * error.at_most(least * T::real(0.25)));
            least = error.unwrap_or(least);
            self.taken[k] = climbing;
            self.order += climbing;
            self.guess += self.differences[k] * climbing;
        }
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
