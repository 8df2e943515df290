//! Slopes at the knots of piecewise cubic polynomials, while compiling or at run time.

use super::axis::Outside;
use super::tridiagonal;

/// The values of a function and the slopes of its pieces, one entry for each knot, with buffers.
pub(super) struct Buffers<'a> {
    pub(super) values: &'a mut [f64],
    pub(super) slopes: &'a mut [f64],
    pub(super) rows: &'a mut [[f64; 4]],
    pub(super) others: &'a mut [[f64; 2]],
}

impl Buffers<'_> {
    /// Computes the slopes of the spline through the values.
    pub(super) const fn spline(&mut self, knots: &[f64], outside: Outside) {
        spline(knots, self.values, outside, self.slopes, (self.rows, self.others));
    }

    /// Computes the slopes of cubic pieces without overshoot.
    pub(super) const fn monotone(&mut self, knots: &[f64], outside: Outside) {
        monotone(knots, self.values, outside, self.slopes);
    }
}

/// The arrays of N knots.
pub(super) struct Arrays<const N: usize> {
    values: [f64; N],
    pub(super) slopes: [f64; N],
    rows: [[f64; 4]; N],
    others: [[f64; 2]; N],
}

impl<const N: usize> Arrays<N> {
    pub(super) const fn new(values: [f64; N]) -> Self {
        Self { values, slopes: [0.0; N], rows: [[0.0; 4]; N], others: [[0.0; 2]; N] }
    }

    pub(super) const fn buffers(&mut self) -> Buffers<'_> {
        let Self { values, slopes, rows, others } = self;
        Buffers { values, slopes, rows, others }
    }
}

/// Distance of knot i from the next, and the slope of the chord between them.
const fn chord(x: &[f64], y: &[f64], i: usize) -> [f64; 2] {
    let h = x[i + 1] - x[i];
    [h, (y[i + 1] - y[i]) / h]
}

/// The two chords that meet at knot i; at the ends of a periodic table the first and the last one.
const fn chords(x: &[f64], y: &[f64], i: usize) -> [[f64; 2]; 2] {
    let last = x.len() - 1;
    let before = if i == 0 { last - 1 } else { i - 1 };
    let after = if i == last { 0 } else { i };
    [chord(x, y, before), chord(x, y, after)]
}

/// Slopes of the cubic spline with continuous second derivatives. Its third derivative is continuous at the first and
/// the last inner knot ("not-a-knot"), or the spline is periodic. Three points give their parabola, two their line.
///
/// Source: de Boor, A Practical Guide to Splines, chapter IV.
const fn spline(
    x: &[f64],
    y: &[f64],
    outside: Outside,
    slopes: &mut [f64],
    (rows, others): (&mut [[f64; 4]], &mut [[f64; 2]]),
) {
    let n = x.len();
    let is_periodic = matches!(outside, Outside::Periodic);
    if !is_periodic && n == 2 {
        slopes[0] = chord(x, y, 0)[1];
        slopes[1] = slopes[0];
        return;
    }
    let count = if is_periodic { n - 1 } else { n };
    let mut i = 0;
    while i < count {
        let is_end = !is_periodic && (i == 0 || i == n - 1);
        rows[i] = if !is_end {
            let [[h0, d0], [h1, d1]] = chords(x, y, i);
            [h1, 2.0 * (h0 + h1), h0, 3.0 * (h1 * d0 + h0 * d1)]
        } else if i == 0 {
            let [[h0, d0], [h1, d1]] = chords(x, y, 1);
            let sum = h0 + h1;
            [0.0, h1, sum, ((h0 + 2.0 * sum) * h1 * d0 + h0 * h0 * d1) / sum]
        } else {
            let [[h1, d1], [h0, d0]] = chords(x, y, n - 2);
            let sum = h0 + h1;
            [sum, h1, 0.0, ((h0 + 2.0 * sum) * h1 * d0 + h0 * h0 * d1) / sum]
        };
        i += 1;
    }
    if !is_periodic && n == 3 {
        // With three knots both end conditions are the same: the parabola replaces them.
        let [[h0, d0], [h1, d1]] = chords(x, y, 1);
        let bend = (d1 - d0) / (h0 + h1);
        rows[0] = [0.0, 1.0, 0.0, d0 - bend * h0];
        rows[1] = [0.0, 1.0, 0.0, d0 + bend * h0];
        rows[n - 1] = [0.0, 1.0, 0.0, d1 + bend * h1];
    }
    tridiagonal::solve(rows, count, slopes, others);
    if is_periodic {
        slopes[n - 1] = slopes[0];
    }
}

/// Slopes of the cubic interpolant that is monotone wherever the values are: a weighted harmonic mean of both chords,
/// and zero between a rise and a fall.
///
/// Source: Fritsch and Butland, SIAM J. Sci. Stat. Comput. 5 (1984); the ends as in Moler, Numerical Computing with
/// MATLAB, section 3.6.
const fn monotone(x: &[f64], y: &[f64], outside: Outside, slopes: &mut [f64]) {
    let n = x.len();
    let is_periodic = matches!(outside, Outside::Periodic);
    if !is_periodic && n == 2 {
        slopes[0] = chord(x, y, 0)[1];
        slopes[1] = slopes[0];
        return;
    }
    let mut i = 0;
    while i < n {
        slopes[i] = if is_periodic || i > 0 && i < n - 1 {
            let [[h0, d0], [h1, d1]] = chords(x, y, i);
            let (w0, w1) = (2.0 * h1 + h0, h1 + 2.0 * h0);
            if d0 * d1 > 0.0 { (w0 + w1) / (w0 / d0 + w1 / d1) } else { 0.0 }
        } else if i == 0 {
            let [near, far] = chords(x, y, 1);
            end(near, far)
        } else {
            let [far, near] = chords(x, y, n - 2);
            end(near, far)
        };
        i += 1;
    }
}

/// Slope at an end: that of the parabola, limited so that the first piece is monotone.
const fn end([h0, d0]: [f64; 2], [h1, d1]: [f64; 2]) -> f64 {
    let slope = ((2.0 * h0 + h1) * d0 - h0 * d1) / (h0 + h1);
    if slope * d0 <= 0.0 {
        0.0
    } else if d0 * d1 <= 0.0 && slope.abs() > 3.0 * d0.abs() {
        3.0 * d0
    } else {
        slope
    }
}

/// Coefficients of the cubic with value and slope `[y0, s0]` at u = 0 and `[y1, s1]` at u = h. h may be negative.
pub(super) const fn hermite(h: f64, [y0, s0]: [f64; 2], [y1, s1]: [f64; 2]) -> [f64; 4] {
    let chord = (y1 - y0) / h;
    let excess = (s0 + s1 - 2.0 * chord) / h;
    [y0, s0, (chord - s0) / h - excess, excess / h]
}
