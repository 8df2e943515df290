//! Records a run of any length in bounded memory, for a figure.
//!
//! In: the points of a run in order. Out: [`Trace::points`], a function of time with the extremes of every stretch; and
//! [`Sample::points`], every 2^k-th point of a curve in the plane. Both return all points of a short run. The result is
//! a subset of the points in their order, and deterministic.

/// Maximum number of stretches of a trace: two per column of a wide figure.
const STRETCHES: usize = 2048;
/// Maximum number of points of a sample.
const POINTS: usize = 2048;

/// A function of time: the first, lowest, highest and last point of each stretch.
#[derive(Clone, Debug, Default)]
pub struct Trace {
    /// Stretches of `1 << doublings` points each, except the last.
    stretches: Vec<Stretch>,
    doublings: u32,
    count: u64,
}

/// The first, lowest, highest and last of consecutive points.
type Stretch = [Point; 4];

/// A point with its index.
#[derive(Clone, Copy, Debug)]
struct Point {
    number: u64,
    at: (f64, f64),
}

/// Merges a stretch and the next.
fn joined([first, low, high, _]: Stretch, [_, next_low, next_high, last]: Stretch) -> Stretch {
    let low = if next_low.at.1 < low.at.1 { next_low } else { low };
    let high = if next_high.at.1 > high.at.1 { next_high } else { high };
    [first, low, high, last]
}

impl Trace {
    /// Adds a point.
    pub fn push(&mut self, at: (f64, f64)) {
        let next = [Point { number: self.count, at }; 4];
        let begins = self.count.is_multiple_of(1 << self.doublings);
        self.count += 1;
        match self.stretches.last_mut() {
            Some(last) if !begins => *last = joined(*last, next),
            _ => self.stretches.push(next),
        }
        if self.stretches.len() > STRETCHES {
            // The number of points is a multiple of a stretch plus one: all pairs except the last are complete.
            let pair = |pair: &[Stretch]| pair.iter().copied().reduce(joined);
            self.stretches = self.stretches.chunks(2).filter_map(pair).collect();
            self.doublings += 1;
        }
    }

    /// The kept points.
    #[must_use]
    pub fn points(&self) -> Vec<(f64, f64)> {
        let mut points = self.stretches.concat();
        points.sort_by_key(|point| point.number);
        points.dedup_by_key(|point| point.number);
        points.into_iter().map(|point| point.at).collect()
    }
}

/// A curve in the plane: every 2^k-th of its points.
#[derive(Clone, Debug, Default)]
pub struct Sample {
    points: Vec<(f64, f64)>,
    doublings: u32,
    count: u64,
}

impl Sample {
    /// Adds a point.
    pub fn push(&mut self, at: (f64, f64)) {
        if self.count.is_multiple_of(1 << self.doublings) {
            self.points.push(at);
        }
        self.count += 1;
        if self.points.len() > POINTS {
            self.points = self.points.iter().copied().step_by(2).collect();
            self.doublings += 1;
        }
    }

    /// Whether the sample contains all points.
    #[must_use]
    pub fn is_whole(&self) -> bool {
        self.doublings == 0
    }

    /// The kept points.
    #[must_use]
    pub fn points(&self) -> Vec<(f64, f64)> {
        self.points.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_short_run_is_whole() {
        let points: Vec<(f64, f64)> = (0..2048).map(|i| (f64::from(i), f64::from(i % 7))).collect();
        let mut trace = Trace::default();
        let mut sample = Sample::default();
        for point in &points {
            trace.push(*point);
            sample.push(*point);
        }
        assert_eq!((trace.points(), sample.points(), sample.is_whole()), (points.clone(), points, true));
        assert!(Trace::default().points().is_empty() && Sample::default().points().is_empty());
    }

    #[test]
    fn a_long_run_keeps_its_ends_its_extremes_and_its_order_in_bounded_memory() {
        let count = 1_000_003;
        let mut trace = Trace::default();
        let mut sample = Sample::default();
        for i in 0..count {
            // An oscillation with one upward and one downward spike of a single point.
            let height = match i {
                4711 => 9.0,
                777_777 => -9.0,
                _ => f64::from(i % 7),
            };
            trace.push((f64::from(i), height));
            sample.push((f64::from(i), height));
        }
        let points = trace.points();
        assert!(points.len() <= 4 * STRETCHES && points.len() >= STRETCHES, "{}", points.len());
        assert!(points.is_sorted_by(|one, other| one.0 < other.0));
        assert_eq!((points[0], points[points.len() - 1].0), ((0.0, 0.0), f64::from(count - 1)));
        assert!(points.contains(&(4711.0, 9.0)) && points.contains(&(777_777.0, -9.0)));
        // Stretches of 2¹⁸ points would hide the oscillation; with 512 points it is visible.
        for window in points.windows(5) {
            assert!(window[4].0 - window[0].0 <= 2.0 * 512.0, "{window:?}");
        }
        let kept = sample.points();
        assert!(kept.len() > POINTS / 2 && kept.len() <= POINTS && !sample.is_whole());
        let distance = kept[1].0 - kept[0].0;
        assert!(kept.windows(2).all(|pair| (pair[1].0 - pair[0].0 - distance).abs() < 0.5));
    }
}
