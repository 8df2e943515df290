//! Slopes over sequences of step lengths.
//!
//! Quantities that decrease with a power of h are measured for steps h, h/2, …, with their rounding errors. This module
//! fits the slope of log(quantity) over log(h). The least-squares fit uses the three smallest steps at which the
//! quantity exceeds its rounding-error bound [`CLEAR`] times. If there are not three, it tries sequences from 4 h, 16
//! h, …, up to the system's own time scale:
//!
//! ```text
//! the quantity is clear at three steps or more              the slope is judged
//! at none, on the sequence that reaches the time scale      the law holds exactly, to rounding
//! otherwise                                                 h is too small: a failure that suggests an h
//! ```

use super::comparison::Comparison;
use super::report::{CheckFailure, Report};
use alloc::boxed::Box;
use alloc::string::String;
use alloc::vec::Vec;
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

/// Halvings of the step in a sequence.
const HALVINGS: u32 = 4;
/// Most halvings if a slope is too small: the sequence is extended while the quantity is clear, because the next power
/// of h may contribute.
const FURTHER: u32 = 8;
/// Points that a slope needs.
const FEWEST: usize = 3;
/// A quantity is clear if it exceeds its rounding-error bound by this factor.
const CLEAR: f64 = 2.0;
/// Factor from one sequence to the next.
const CLIMB: f64 = 4.0;
/// Largest suggested step, in units of the longest step of a sequence.
pub(super) const REACH: f64 = 4.0;
/// Tolerance below the expected slope. Measured on the ready-made systems: 2.6e-3.
const TOLERANCE: f64 = 0.1;
/// Relative rounding error up to which a law counts as exact.
const EXACT: f64 = 1e-6;

/// A quantity for one step, and its rounding error.
#[derive(Clone, Copy, Debug)]
pub(super) struct Measured {
    pub(super) quantity: f64,
    pub(super) rounding: f64,
}

impl Measured {
    fn is_clear(&self) -> bool {
        // NaN counts as clear, and then fails every slope.
        self.quantity.is_nan() || self.quantity > CLEAR * self.rounding
    }
}

/// A law of decrease with h to the power `slope`.
pub(super) struct PowerLaw {
    pub(super) name: &'static str,
    pub(super) quantities: Vec<String>,
    pub(super) slope: f64,
    /// Whether every quantity must be clear or exact, or one clear quantity is enough.
    pub(super) every: bool,
}

impl PowerLaw {
    /// Judges the law by sequences of steps from `h` to `longest`. `prepare` computes the data that the steps of a
    /// sequence share; `measure` returns the quantities for one of them, by its number of halvings.
    ///
    /// # Errors
    /// A slope that is too small; errors of `prepare` and `measure` on the sequence from `h`;
    /// [`CheckFailure::StepTooSmall`].
    pub(super) fn judge<P>(
        &self,
        check: &Comparison,
        [h, longest]: [f64; 2],
        prepare: impl Fn(f64) -> Result<P, CheckFailure>,
        measure: impl Fn(&P, u32) -> Result<Vec<Measured>, CheckFailure>,
    ) -> Result<Report, CheckFailure> {
        let measure = &measure;
        let climb = |h: f64| -> Result<_, CheckFailure> {
            let shared = prepare(h)?;
            Ladder::from(h, Box::new(move |halvings| measure(&shared, halvings)))
        };
        let mut ladder = climb(h)?;
        let mut fits: Vec<Option<Fit>> = self.quantities.iter().map(|_| None).collect();
        let failure = loop {
            self.fit(&mut ladder, &mut fits, check)?;
            if fits.iter().all(Option::is_some) || ladder.h >= longest {
                break None;
            }
            let [far, near] = [CLIMB, CLIMB.sqrt()].map(|factor| (factor * ladder.h).min(longest));
            match climb(far).or_else(|_| climb(near)) {
                Ok(longer) => ladder = longer,
                Err(failure) => break Some(failure),
            }
        };
        let is_seen = if self.every { fits.iter().all(Option::is_some) } else { fits.iter().any(Option::is_some) };
        if is_seen || failure.is_none() && ladder.are_exact(&fits) {
            return Ok(self.report(&fits, check));
        }
        let beyond = match &failure {
            Some(CheckFailure::Step { error, .. }) => format!(", and beyond {error}"),
            Some(CheckFailure::Vacuous { why, .. }) => format!(", and beyond {why}"),
            _ => String::new(),
        };
        let needed = ladder.h * ladder.missing(&fits);
        let needed = Some(needed).filter(|needed| failure.is_none() && *needed <= REACH * longest);
        Err(check.too_small(self.name, needed, format!("steps up to {:.0e} were tried{beyond}", ladder.h)))
    }

    /// Fits the quantities that are clear on this sequence and were not on an earlier one.
    fn fit(&self, ladder: &mut Ladder, fits: &mut [Option<Fit>], check: &Comparison) -> Result<(), CheckFailure> {
        for (index, (fit, name)) in fits.iter_mut().zip(&self.quantities).enumerate() {
            if fit.is_none() {
                *fit = ladder.fit(index, self.slope)?;
                if let Some(fit) = fit.as_ref().filter(|fit| !fit.is_steep(self.slope)) {
                    let short = self.slope - fit.slope;
                    return Err(check.differs(fit.describe(name), [fit.slope, self.slope], short, TOLERANCE));
                }
            }
        }
        Ok(())
    }

    /// The report of a law that holds.
    fn report(&self, fits: &[Option<Fit>], check: &Comparison) -> Report {
        let seen = fits.iter().zip(&self.quantities).filter_map(|(fit, name)| fit.as_ref().zip(Some(name)));
        let count = seen.clone().count();
        match seen.min_by(|(one, _), (other, _)| one.slope.total_cmp(&other.slope)) {
            Some((fit, name)) => {
                let short = (self.slope - fit.slope).max(0.0);
                check.fitted(FEWEST * count, fit.describe(name), short, TOLERANCE)
            }
            None => check.fitted(fits.len(), format!("{}, exact to rounding", self.name), 0.0, TOLERANCE),
        }
    }
}

/// Measurements for the steps h, h/2, …
struct Ladder<'a> {
    h: f64,
    measure: Box<dyn Fn(u32) -> Result<Vec<Measured>, CheckFailure> + 'a>,
    rungs: Vec<Vec<Measured>>,
    further: core::ops::RangeInclusive<u32>,
}

impl<'a> Ladder<'a> {
    fn from(
        h: f64,
        measure: Box<dyn Fn(u32) -> Result<Vec<Measured>, CheckFailure> + 'a>,
    ) -> Result<Self, CheckFailure> {
        let rungs = (0..=HALVINGS).map(&measure).collect::<Result<_, _>>()?;
        Ok(Self { h, measure, rungs, further: HALVINGS + 1..=FURTHER })
    }

    /// The slope of a quantity through the smallest steps at which it is clear, extended to smaller steps if it is too
    /// small; `None` if there are too few.
    fn fit(&mut self, index: usize, slope: f64) -> Result<Option<Fit>, CheckFailure> {
        loop {
            let points = self.clear(index);
            let Some(first) = points.len().checked_sub(FEWEST) else { return Ok(None) };
            let fit = Fit::through(points[first..].to_vec());
            if fit.is_steep(slope) || points.len() < self.rungs.len() {
                return Ok(Some(fit));
            }
            let Some(halvings) = self.further.next() else { return Ok(Some(fit)) };
            self.rungs.push((self.measure)(halvings)?);
        }
    }

    /// Steps and values of a quantity, from the largest step down to the first one within its rounding error.
    fn clear(&self, index: usize) -> Vec<(f64, f64)> {
        let steps = core::iter::successors(Some(self.h), |h| Some(h / 2.0));
        let measured = self.rungs.iter().filter_map(|rung| rung.get(index)).take_while(|measured| measured.is_clear());
        steps.zip(measured.map(|measured| measured.quantity)).collect()
    }

    /// Whether the quantities without a fit are zero, with a small rounding error.
    fn are_exact(&self, fits: &[Option<Fit>]) -> bool {
        let top = self.rungs.first().into_iter().flatten();
        let mut hidden = top.zip(fits).filter(|(_, fit)| fit.is_none());
        hidden.all(|(measured, _)| !measured.is_clear() && measured.rounding <= EXACT)
    }

    /// The factor of h that would make the quantities without a fit clear, at least 2. Over a time in proportion to h a
    /// quantity grows as h⁴, or as h² while its rounding error decreases as 1/h².
    fn missing(&self, fits: &[Option<Fit>]) -> f64 {
        let third = self.rungs.get(FEWEST - 1).into_iter().flatten();
        let hidden = third.zip(fits).filter(|(_, fit)| fit.is_none());
        let ratios = hidden.map(|(measured, _)| CLEAR * measured.rounding / measured.quantity);
        ratios.filter(|ratio| ratio.is_finite()).fold(16.0, f64::max).powf(0.25)
    }
}

/// A slope, and its fitted points.
struct Fit {
    slope: f64,
    points: Vec<(f64, f64)>,
}

impl Fit {
    fn through(points: Vec<(f64, f64)>) -> Self {
        let logarithms = || points.iter().map(|(h, quantity)| (h.ln(), quantity.ln()));
        let count = logarithms().fold(0.0, |count, _| count + 1.0);
        let (x, y) = logarithms().fold((0.0, 0.0), |(x, y), point| (x + point.0 / count, y + point.1 / count));
        let (products, squares) = logarithms()
            .map(|(a, b)| (a - x, b - y))
            .fold((0.0, 0.0), |(products, squares), (a, b)| (products + a * b, squares + a * a));
        Self { slope: products / squares, points }
    }

    /// Whether the slope is large enough. NaN is not.
    fn is_steep(&self, slope: f64) -> bool {
        slope - self.slope <= TOLERANCE
    }

    /// The points, formatted for a message.
    fn describe(&self, of: &str) -> String {
        let each: Vec<String> =
            self.points.iter().map(|(h, quantity)| format!("{quantity:.1e} at h = {h:.1e}")).collect();
        format!("slope of {of} ({})", each.join(", "))
    }
}
