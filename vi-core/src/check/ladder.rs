//! Slopes over a ladder of steps.
//!
//! In: quantities that fall with a power of h, measured for steps h, h/2, …, each with its rounding. Out: the slope of
//! log(quantity) over log(h), by least squares through the three smallest steps at which the quantity is [`CLEAR`] of the
//! bound of its rounding. Where there are no three, ladders from 4 h, 16 h, … are climbed, up to the system's own time scale:
//!
//! ```text
//! the quantity is clear at three steps or more              the slope is judged
//! at none, on the ladder that comes to the time scale       the law holds exactly, as far as rounding shows
//! else                                                      h is too small: a failure that says which h to try
//! ```

use super::comparison::Comparison;
use super::report::{CheckFailure, Report};

/// Halvings of the step: the ladder.
const HALVINGS: u32 = 4;
/// Where a slope is too small, halvings up to which the ladder is extended while the quantity stands clear: the next power
/// of h may have its part in it.
const FURTHER: u32 = 8;
/// Points that a slope needs.
const FEWEST: usize = 3;
/// So many times the bound of its rounding is clear of it.
const CLEAR: f64 = 2.0;
/// From one ladder to the next.
const CLIMB: f64 = 4.0;
/// Multiples of the longest step of a ladder beyond which none is worth a try.
pub(super) const REACH: f64 = 4.0;
/// What a slope may be too small by. Measured on the ready systems: 2.6e-3.
const TOLERANCE: f64 = 0.1;
/// Rounding, as a part of what is measured, up to which a law may be called exact.
const EXACT: f64 = 1e-6;

/// A quantity for one step, and what rounding may have made of it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Measured {
    pub(super) quantity: f64,
    pub(super) rounding: f64,
}

impl Measured {
    fn is_clear(&self) -> bool {
        // Not a number is clear, and no slope goes through it.
        self.quantity.is_nan() || self.quantity > CLEAR * self.rounding
    }
}

/// What has to fall with h to the power `slope`.
pub(super) struct Law {
    pub(super) name: &'static str,
    pub(super) quantities: Vec<String>,
    pub(super) slope: f64,
    /// Whether a quantity that is not seen must be exact, or the others will do.
    pub(super) every: bool,
}

impl Law {
    /// Judges the law by ladders of steps from `h` to `longest`. `prepare` makes what the steps of the ladder from its
    /// argument share; `measure` gives the quantities for one of them, by how often it is halved.
    ///
    /// # Errors
    /// A slope that is too small; what `prepare` and `measure` fail with on the ladder from `h`;
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

    /// Fits the quantities that are seen on this ladder, and were not on an earlier one.
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

/// What was measured for the steps h, h/2, …
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

    /// The slope of a quantity through the smallest steps at which it is seen, smaller ones than the ladder's where that
    /// is too small; `None` where there are too few.
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

    /// Steps and a quantity, from the largest step down to where the quantity is lost in its rounding.
    fn clear(&self, index: usize) -> Vec<(f64, f64)> {
        let steps = core::iter::successors(Some(self.h), |h| Some(h / 2.0));
        let measured = self.rungs.iter().filter_map(|rung| rung.get(index)).take_while(|measured| measured.is_clear());
        steps.zip(measured.map(|measured| measured.quantity)).collect()
    }

    /// Whether the quantities without a fit are zero to a rounding that hides little.
    fn are_exact(&self, fits: &[Option<Fit>]) -> bool {
        let top = self.rungs.first().into_iter().flatten();
        let mut hidden = top.zip(fits).filter(|(_, fit)| fit.is_none());
        hidden.all(|(measured, _)| !measured.is_clear() && measured.rounding <= EXACT)
    }

    /// The factor of h with which the quantities without a fit would be seen, 2 at least: over a time in proportion to h a
    /// quantity grows as h⁴, or as h² while its rounding falls as 1/h².
    fn missing(&self, fits: &[Option<Fit>]) -> f64 {
        let third = self.rungs.get(FEWEST - 1).into_iter().flatten();
        let hidden = third.zip(fits).filter(|(_, fit)| fit.is_none());
        let ratios = hidden.map(|(measured, _)| CLEAR * measured.rounding / measured.quantity);
        ratios.filter(|ratio| ratio.is_finite()).fold(16.0, f64::max).powf(0.25)
    }
}

/// A slope, and the points that it was fitted through.
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

    /// Whether the slope is large enough. One that is not a number is not.
    fn is_steep(&self, slope: f64) -> bool {
        slope - self.slope <= TOLERANCE
    }

    /// The points, as a message shows them.
    fn describe(&self, of: &str) -> String {
        let each: Vec<String> =
            self.points.iter().map(|(h, quantity)| format!("{quantity:.1e} at h = {h:.1e}")).collect();
        format!("slope of {of} ({})", each.join(", "))
    }
}
