//! What the next step will be, foretold, and how far Newton's iteration may be trusted from there.
//!
//! In: the unknowns `u` of the last steps. Out: a guess of those of the next one, and a distance ρ: a Newton step shorter than
//! ρ leaves less than a share of one rounding, and nothing need be evaluated to confirm it.
//!
//! ```text
//! guess   Σ w_i u_i,  i = 0 the newest: w = 7, −21, 35, −35, 21, −7, 1, the polynomial of degree 6 through the last seven;
//!         or the last u, where the steps are not smooth enough for that
//! radius  after a step |δ| the next one is C |δ|²:  ρ² = share ε/C,  ε the length of a step that is all rounding
//! ```
//!
//! A step is short in time: what waits for its end should be little. A new u gives its part to all later guesses at once, and
//! the next guess is there before the Newton step δ is, but for `w_0 δ`.
//!
//! C and whether to extrapolate change slowly along a motion. They are learnt from one step in 64 to 256, which starts from the last
//! u: its first two Newton steps are C (in two unknowns: `energy_preserving::lesson`), and its solution shows which guess would have been better. A step
//! whose Newton steps do not come below ρ is taken by the slow way, which measures every residual.

use crate::{Real, Scalar};
use core::hint::black_box;
use nalgebra::SVector;

/// Steps between two that learn, at first.
const INTERVAL: u32 = 64;
/// The same where ρ stays as it is.
const LONG_INTERVAL: u32 = 256;
/// The same after ρ has become less than a quarter of what it was.
const ALERT: u32 = 8;
/// What the extrapolation takes of the last step, and of those before it.
const NEWEST: f64 = 7.0;
const OLDER: [f64; 6] = [-21.0, 35.0, -35.0, 21.0, -7.0, 1.0];
/// Steps after which all that is extrapolated from is known.
const ENOUGH: u8 = 8;

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
    /// What the steps up to now give to the extrapolations after the next one, each used up in its turn. To the last of them only
    /// the newest step gives anything, and as often as it is: once.
    parts: [SVector<T, M>; OLDER.len()],
    /// Whether the guess is the extrapolation: 1, or 0 where it is the last step.
    extrapolated: T,
    /// What the guess takes of the last step.
    weight: T,
    /// ρ²; zero where nothing is trusted.
    radius: T,
    /// Steps until the next one that learns.
    until: u32,
    /// Steps from the last one that learnt to the next.
    interval: u32,
    /// Steps that are known, up to [`ENOUGH`].
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

impl<T: Scalar> Lesson<T> {
    /// ρ² = share ε/C with C = |δ2|/|δ1|², or less where that is below rounding.
    pub(crate) fn radius(&self, share: f64) -> T {
        let second = self.second.max(self.rounding).sqrt();
        // A first step that had no length taught nothing.
        if self.first > T::zero() { self.rounding.sqrt() * self.first * T::real(share) / second } else { T::zero() }
    }
}

impl<const M: usize, T: Scalar> Forecast<M, T> {
    /// Before the first step, with a guess of it.
    pub(crate) fn new(guess: SVector<T, M>) -> Self {
        let mut constant = Self {
            guess,
            parts: [SVector::zeros(); OLDER.len()],
            extrapolated: T::zero(),
            weight: T::one(),
            radius: T::zero(),
            until: 0,
            interval: INTERVAL,
            known: 0,
        };
        for _ in OLDER {
            (0..M).for_each(|i| constant.enter(i, guess[i]));
        }
        constant
    }

    /// The same, each number stored for itself: see the rare path of [`FixedStep::step`](crate::FixedStep::step).
    pub(crate) fn apart(mut self) -> Self {
        self.guess = black_box(self.guess);
        self.parts = self.parts.map(black_box);
        self.extrapolated = black_box(self.extrapolated);
        self.weight = black_box(self.weight);
        self.radius = black_box(self.radius);
        self
    }

    /// Whether there was no step yet.
    pub(crate) fn is_new(&self) -> bool {
        self.known == 0
    }

    /// The unknowns of the last step.
    #[inline]
    pub(crate) fn newest(&self) -> SVector<T, M> {
        self.parts[OLDER.len() - 1]
    }

    /// Whether everything is a finite number.
    pub(crate) fn is_finite(&self) -> bool {
        let numbers = self.parts.iter().chain([&self.guess]).flat_map(|u| u.iter());
        numbers.chain([&self.extrapolated, &self.weight, &self.radius]).all(|number| number.is_finite())
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

    /// What the next guess takes of a change of the step before it.
    #[inline]
    pub(crate) fn weight(&self) -> T {
        self.weight
    }

    /// Entry i of the next guess, were the trial u the step.
    #[inline]
    pub(crate) fn after(&self, i: usize, trial: T) -> T {
        self.parts[0][i] * self.extrapolated + trial * self.weight
    }

    /// The polynomial of degree 5 through the last six steps, at the next one: `6 u0 − 15 u1 + 20 u2 − 15 u3 + 6 u4 − u5`. The parts
    /// are the first coefficients of `(1 − z)⁷ Σ u_i z^i`, and their sum is that with the opposite sign.
    fn of_degree_five(&self) -> SVector<T, M> {
        self.parts.iter().fold(SVector::zeros(), |sum, part| sum - part)
    }

    /// Takes the step `u` where no guess is needed.
    #[inline]
    pub(crate) fn replace(&mut self, u: SVector<T, M>) {
        self.parts[OLDER.len() - 1] = u;
        self.known = 1;
    }

    /// Takes the step `trial + δ`.
    #[inline]
    pub(crate) fn push(&mut self, trial: &SVector<T, M>, step: &SVector<T, M>) {
        // One loop: each entry is read and written once.
        for i in 0..M {
            let u = trial[i] + step[i];
            self.guess[i] = self.after(i, trial[i]) + step[i] * self.weight;
            self.enter(i, u);
        }
        self.until = self.until.saturating_sub(1);
    }

    /// Gives entry i of the step `u` to all extrapolations after the next one.
    #[inline]
    fn enter(&mut self, i: usize, u: T) {
        for (k, weight) in OLDER.iter().enumerate() {
            let part = u * T::real(*weight);
            // Behind the last one is nothing: not a zero, which would have to be added.
            self.parts[k][i] = self.parts.get(k + 1).map_or(part, |before| before[i] + part);
        }
    }

    /// Takes a step `u` that was not come by from here: the next one learns, unless this one should have.
    pub(crate) fn miss(&mut self, u: SVector<T, M>) {
        if self.is_learning() {
            self.learn(u, T::zero());
        } else {
            self.push(&u, &SVector::zeros());
            self.until = 0;
        }
    }

    /// Takes the step `u` that started from the last one, and ρ² as it taught.
    pub(crate) fn learn(&mut self, u: SVector<T, M>, radius: T) {
        let kept = radius > self.radius * T::real(1.0 / 16.0);
        let steady = kept && radius <= self.radius * T::real(16.0);
        self.radius = radius;
        self.known = (self.known + 1).min(ENOUGH);
        let [by_last, by_degree_five] =
            [self.newest(), self.of_degree_five()].map(|guess| length_squared(&(u - guess)));
        let better = by_degree_five <= by_last * T::real(0.25);
        let (extrapolated, weight) = if better && self.known == ENOUGH { (1.0, NEWEST) } else { (0.0, 1.0) };
        (self.extrapolated, self.weight) = (T::real(extrapolated), T::real(weight));
        self.push(&u, &SVector::zeros());
        self.interval = match (kept, steady) {
            (false, _) => ALERT,
            (_, true) => (2 * self.interval).clamp(INTERVAL, LONG_INTERVAL),
            _ => INTERVAL,
        };
        self.until = if self.known < ENOUGH { 0 } else { self.interval - 1 };
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

#[cfg(test)]
mod tests {
    use super::{Forecast, Lesson};
    use nalgebra::SVector;

    /// A forecast that has learnt from the first steps of a sequence, with a radius that stays.
    fn learnt(sequence: impl Fn(f64) -> f64) -> Forecast<1, f64> {
        let mut forecast = Forecast::new(SVector::from([sequence(0.0)]));
        for step in 1..=12 {
            forecast.learn(SVector::from([sequence(f64::from(step))]), 1.0);
        }
        forecast
    }

    #[test]
    fn a_polynomial_of_degree_six_is_foretold() {
        let sequence = |t: f64| t.powi(6) - 3.0 * t.powi(5) + t;
        let mut forecast = learnt(sequence);
        for step in 13..40 {
            let (guess, u) = (forecast.guess()[0], sequence(f64::from(step)));
            // Integers below 2⁵³: no rounding.
            assert_eq!(guess.to_bits(), u.to_bits(), "step {step}");
            // From another trial, the Newton step leads to the same.
            forecast.push(&SVector::from([u + 8.0]), &SVector::from([-8.0]));
            assert_eq!(forecast.newest()[0].to_bits(), u.to_bits());
        }
    }

    #[test]
    fn a_polynomial_of_degree_five_is_judged_right() {
        let sequence = |t: f64| 2.0 * t.powi(5) - 3.0 * t.powi(4) + t - 7.0;
        let forecast = learnt(sequence);
        // Integers below 2⁵³: no rounding.
        assert_eq!(forecast.of_degree_five()[0].to_bits(), sequence(13.0).to_bits());
    }

    #[test]
    fn what_is_not_smooth_is_foretold_by_the_last_step() {
        let mut forecast = learnt(|t| if t % 3.0 < 1.5 { 1.0 } else { -1.0 });
        forecast.push(&SVector::from([0.25]), &SVector::from([0.5]));
        assert_eq!(forecast.guess()[0].to_bits(), 0.75_f64.to_bits());
    }

    #[test]
    fn lessons_are_rarer_where_the_radius_stays_and_frequent_where_it_falls() {
        let until = |mut forecast: Forecast<1, f64>| {
            let mut steps = 0;
            while !forecast.is_learning() {
                forecast.push(&forecast.guess(), &SVector::zeros());
                steps += 1;
            }
            steps
        };
        let mut forecast = learnt(f64::sin);
        assert_eq!(until(forecast), 255);
        forecast.learn(SVector::from([0.5]), 1e-3);
        assert_eq!(until(forecast), 7);
        forecast.miss(SVector::from([0.5]));
        assert!(forecast.is_learning());
    }

    #[test]
    fn the_radius_leaves_a_share_of_a_rounding() {
        // |δ2| = C |δ1|² with C = 10: after |δ|² = ρ² the next one is share ε.
        let (delta, epsilon, share) = (1e-4_f64, 1e-16_f64, 0.25);
        let second = 10.0 * delta * delta;
        let lesson = Lesson { first: delta * delta, second: second * second, rounding: epsilon * epsilon };
        assert!((10.0 * lesson.radius(share) / (share * epsilon) - 1.0).abs() < 1e-14);
        assert!(Lesson { first: 0.0, second: 0.0, rounding: 1e-32 }.radius(1.0) <= 0.0);
    }
}
