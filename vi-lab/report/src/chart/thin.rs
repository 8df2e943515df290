//! Thinning: reduces a million points to the resolution of a figure.
//!
//! The result is a subset of the points in their order, and deterministic. A line has at most four points per pixel
//! column, a scatter plot at most one per cell.

use std::collections::BTreeSet;

/// The feature to preserve.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Thinning {
    /// A function of the abscissa: first, lowest, highest and last point of each column.
    Envelope,
    /// A curve in the plane: drops points closer than half a pixel to the last kept one.
    Curve,
    /// A scatter plot: one point per cell of two pixels.
    Cells,
}

impl Thinning {
    /// Indices of the points to draw; `points` in pixels.
    pub(super) fn keep(self, points: &[(f64, f64)]) -> Vec<usize> {
        match self {
            Self::Envelope => envelope(points),
            Self::Curve => curve(points),
            Self::Cells => cells(points),
        }
    }
}

/// The column of a pixel.
#[allow(clippy::cast_possible_truncation)] // a pixel number is far below 2³¹; what lies outside is drawn at the border
fn column(x: f64) -> i32 {
    x.floor() as i32
}

/// First, lowest, highest and last point of each run of points in one column.
fn envelope(points: &[(f64, f64)]) -> Vec<usize> {
    let (mut kept, mut first) = (Vec::new(), 0);
    for run in points.chunk_by(|one, next| column(one.0) == column(next.0)) {
        let end = first + run.len();
        let below = |one: &usize, other: &usize| points[*one].1.total_cmp(&points[*other].1);
        let low = (first..end).min_by(below);
        let high = (first..end).min_by(|one, other| below(other, one));
        kept.extend(BTreeSet::from_iter([Some(first), low, high, Some(end - 1)]).into_iter().flatten());
        first = end;
    }
    kept
}

/// Points at least half a pixel from the last kept one; the end is always kept.
fn curve(points: &[(f64, f64)]) -> Vec<usize> {
    let mut last: Option<(f64, f64)> = None;
    let is_kept = |&(index, &(x, y)): &(usize, &(f64, f64))| {
        let is_far = last.is_none_or(|(x0, y0)| (x - x0).hypot(y - y0) >= 0.5);
        last = if is_far { Some((x, y)) } else { last };
        is_far || index + 1 == points.len()
    };
    points.iter().enumerate().filter(is_kept).map(|(index, _)| index).collect()
}

/// The first point of each cell of two by two pixels.
fn cells(points: &[(f64, f64)]) -> Vec<usize> {
    let cell = |x: f64| column(x / 2.0);
    let mut taken = BTreeSet::new();
    points.iter().enumerate().filter(|(_, (x, y))| taken.insert((cell(*x), cell(*y)))).map(|(index, _)| index).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A fast oscillation over 100 columns, with one spike.
    fn series() -> Vec<(f64, f64)> {
        (0..100_000).map(|i| (f64::from(i) * 1e-3, if i == 4711 { 9.0 } else { f64::from(i % 7) })).collect()
    }

    #[test]
    fn the_envelope_keeps_extremes_and_is_short() {
        let points = series();
        let kept = Thinning::Envelope.keep(&points);
        assert!(kept.len() <= 400, "{} points for 100 columns", kept.len());
        assert!(kept.is_sorted());
        assert!(kept.contains(&4711) && kept.first() == Some(&0) && kept.last() == Some(&99_999));
        for wanted in 0..100 {
            let heights = kept.iter().map(|&i| points[i]).filter(|(x, _)| column(*x) == wanted).map(|(_, y)| y);
            let lowest = heights.fold(f64::INFINITY, f64::min);
            assert!(lowest.abs() < f64::MIN_POSITIVE, "column {wanted}: {lowest}");
        }
    }

    #[test]
    fn a_cloud_has_one_point_per_cell() {
        let points: Vec<(f64, f64)> = (0..10_000).map(|i| (f64::from(i % 40), f64::from(i % 10))).collect();
        let kept = Thinning::Cells.keep(&points);
        // Columns are even or odd with their rows, and both parities share a cell: 20 columns, 5 rows, of which a
        // column meets those with row ≡ column mod 10.
        assert_eq!(kept.len(), 20);
    }

    #[test]
    fn a_curve_keeps_its_end_and_its_shape() {
        let points: Vec<(f64, f64)> =
            (0..=62_832).map(|i| f64::from(i) * 1e-4).map(|a| (50.0 * a.cos(), 50.0 * a.sin())).collect();
        let kept = Thinning::Curve.keep(&points);
        assert!(kept.len() < 650 && kept.last() == Some(&62_832), "{}", kept.len());
        let longest = kept
            .windows(2)
            .map(|pair| (points[pair[1]].0 - points[pair[0]].0).hypot(points[pair[1]].1 - points[pair[0]].1))
            .fold(0.0, f64::max);
        // Measured 0.505: half a pixel and one step of the curve.
        assert!(longest < 0.51, "{longest}");
    }

    #[test]
    fn nothing_becomes_nothing() {
        for thinning in [Thinning::Envelope, Thinning::Curve, Thinning::Cells] {
            assert!(thinning.keep(&[]).is_empty());
        }
    }
}
