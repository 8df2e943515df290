//! The quintic spline with continuous fourth derivatives, while compiling or at run time.
//!
//! Unknowns are the slope s and the second derivative m at each knot. Continuity of the third and of the fourth
//! derivative gives two equations for each, in 2 × 2 blocks:
//!
//! ```text
//! fourth derivative after − before = 0          third derivative before − after = 0
//! ```
//!
//! The end conditions are "not-a-knot": the first three pieces are one polynomial, and so are the last three.
//! Each is determined by three values and by value, s and m at its inner end, so that its knots have no unknowns.

/// A 2 × 2 block, by rows.
pub(super) type Block = [[f64; 2]; 2];

/// The equations of one knot: the blocks of the knot before, of its own and of the knot after, and the right side.
#[derive(Clone, Copy)]
pub(super) struct Row {
    lower: Block,
    diagonal: Block,
    upper: Block,
    right: [f64; 2],
}

pub(super) const ZERO: Block = [[0.0; 2]; 2];

const fn add([[a, b], [c, d]]: Block, [[e, f], [g, h]]: Block) -> Block {
    [[a + e, b + f], [c + g, d + h]]
}

/// `a − b c`.
const fn less([[p, q], [r, s]]: Block, [[a, b], [c, d]]: Block, [[e, f], [g, h]]: Block) -> Block {
    [[p - (a * e + b * g), q - (a * f + b * h)], [r - (c * e + d * g), s - (c * f + d * h)]]
}

/// `a − b x`.
const fn less_vector([p, q]: [f64; 2], [[a, b], [c, d]]: Block, [x, y]: [f64; 2]) -> [f64; 2] {
    [p - (a * x + b * y), q - (c * x + d * y)]
}

/// `a⁻¹ b` and `a⁻¹ x`, which end the elimination of a knot.
const fn divided([[e, f], [g, h]]: Block, [x, y]: [f64; 2], [[a, b], [c, d]]: Block) -> (Block, [f64; 2]) {
    let inverse = 1.0 / (a * d - b * c);
    let block = [
        [(d * e - b * g) * inverse, (d * f - b * h) * inverse],
        [(a * g - c * e) * inverse, (a * h - c * f) * inverse],
    ];
    (block, [(d * x - b * y) * inverse, (a * y - c * x) * inverse])
}

impl Row {
    pub(super) const ZERO: Self = Self { lower: ZERO, diagonal: ZERO, upper: ZERO, right: [0.0; 2] };
}

/// Buffers, one entry for each knot.
pub(super) struct Buffers<'a> {
    pub(super) rows: &'a mut [Row],
    pub(super) known: &'a mut [[f64; 2]],
    pub(super) above: &'a mut [Block],
    pub(super) by_last: &'a mut [Block],
}

/// As [`tridiagonal::solve`](super::tridiagonal::solve), with blocks.
const fn solve(Buffers { rows, known, above, by_last }: &mut Buffers, count: usize, is_cyclic: bool) {
    let last = count - 1;
    let mut i = 0;
    while i < last {
        let Row { lower, diagonal, upper, right } = &rows[i];
        let is_before_last = i + 1 == last;
        let inner = if is_before_last && is_cyclic { ZERO } else { *upper };
        let (pivot, right) = if i == 0 {
            (*diagonal, *right)
        } else {
            (less(*diagonal, *lower, above[i - 1]), less_vector(*right, *lower, known[i - 1]))
        };
        (above[i], known[i]) = divided(inner, right, pivot);
        if is_cyclic {
            let coupling = if is_before_last { *upper } else { ZERO };
            let coupling = if i == 0 { add(coupling, *lower) } else { less(coupling, *lower, by_last[i - 1]) };
            by_last[i] = divided(coupling, [0.0; 2], pivot).0;
        }
        i += 1;
    }
    let Row { lower, diagonal, upper, right } = rows[last];
    let (pivot, right) = if last == 0 {
        (add(add(lower, diagonal), upper), right)
    } else if is_cyclic {
        while i > 1 {
            i -= 1;
            known[i - 1] = less_vector(known[i - 1], above[i - 1], known[i]);
            by_last[i - 1] = less(by_last[i - 1], above[i - 1], by_last[i]);
        }
        let pivot = less(less(diagonal, lower, by_last[last - 1]), upper, by_last[0]);
        (pivot, less_vector(less_vector(right, lower, known[last - 1]), upper, known[0]))
    } else {
        (less(diagonal, lower, above[last - 1]), less_vector(right, lower, known[last - 1]))
    };
    known[last] = divided(ZERO, right, pivot).1;
    i = last;
    while i > 0 {
        i -= 1;
        known[i] = if is_cyclic {
            less_vector(known[i], by_last[i], known[last])
        } else {
            less_vector(known[i], above[i], known[i + 1])
        };
    }
}

/// Adds the piece `[knot − h, knot]` with the chord d to the equations of its right knot.
const fn with_piece_before(row: Row, h: f64, d: f64) -> Row {
    let (h2, h3) = (h * h, h * h * h);
    let diagonal = add(row.diagonal, [[192.0 / h3, -36.0 / h2], [-36.0 / h2, 9.0 / h]]);
    let lower = add(row.lower, [[168.0 / h3, 24.0 / h2], [-24.0 / h2, -3.0 / h]]);
    let right = [row.right[0] + 360.0 * d / h3, row.right[1] - 60.0 * d / h2];
    Row { lower, diagonal, right, ..row }
}

/// Adds the piece `[knot, knot + h]` with the chord d to the equations of its left knot.
const fn with_piece_after(row: Row, h: f64, d: f64) -> Row {
    let (h2, h3) = (h * h, h * h * h);
    let diagonal = add(row.diagonal, [[192.0 / h3, 36.0 / h2], [36.0 / h2, 9.0 / h]]);
    let upper = add(row.upper, [[168.0 / h3, -24.0 / h2], [24.0 / h2, -3.0 / h]]);
    let right = [row.right[0] + 360.0 * d / h3, row.right[1] + 60.0 * d / h2];
    Row { diagonal, upper, right, ..row }
}

/// Three points `(u, y)` relative to a knot, for the polynomial of three pieces.
struct Side {
    u: [f64; 3],
    y: [f64; 3],
}

impl Side {
    /// The points of these indices relative to a knot.
    const fn new(x: &[f64], y: &[f64], points: [usize; 3], knot: usize) -> Self {
        let [a, b, c] = points;
        Self {
            u: [x[a] - x[knot], x[b] - x[knot], x[c] - x[knot]],
            y: [y[a] - y[knot], y[b] - y[knot], y[c] - y[knot]],
        }
    }

    /// The parabola through `(u, value)`, as coefficients.
    const fn parabola(&self, value: [f64; 3]) -> [f64; 3] {
        let [u0, u1, u2] = self.u;
        let weights = [
            value[0] / ((u0 - u1) * (u0 - u2)),
            value[1] / ((u1 - u0) * (u1 - u2)),
            value[2] / ((u2 - u0) * (u2 - u1)),
        ];
        let [w0, w1, w2] = weights;
        [w0 * u1 * u2 + w1 * u0 * u2 + w2 * u0 * u1, -(w0 * (u1 + u2) + w1 * (u0 + u2) + w2 * (u0 + u1)), w0 + w1 + w2]
    }

    /// Coefficients of u³, u⁴ and u⁵, with slope s and second derivative m at the knot.
    const fn highest(&self, [s, m]: [f64; 2]) -> [f64; 3] {
        let ([u0, u1, u2], [y0, y1, y2]) = (self.u, self.y);
        self.parabola([
            (y0 - u0 * (s + 0.5 * m * u0)) / (u0 * u0 * u0),
            (y1 - u1 * (s + 0.5 * m * u1)) / (u1 * u1 * u1),
            (y2 - u2 * (s + 0.5 * m * u2)) / (u2 * u2 * u2),
        ])
    }

    /// Adds the fourth derivative times `sign`, and the third one times `−sign`, to the equations of the knot.
    const fn added_to(&self, row: Row, sign: f64) -> Row {
        let none = Self { u: self.u, y: [0.0; 3] };
        let (known, by_s, by_m) = (self.highest([0.0; 2]), none.highest([1.0, 0.0]), none.highest([0.0, 1.0]));
        let (fourth, third) = (24.0 * sign, -6.0 * sign);
        let block = [[fourth * by_s[1], fourth * by_m[1]], [third * by_s[0], third * by_m[0]]];
        let right = [row.right[0] - fourth * known[1], row.right[1] - third * known[0]];
        Row { diagonal: add(row.diagonal, block), right, ..row }
    }
}

/// Taylor coefficients at u = `by` of a polynomial given by those at u = 0.
const fn shifted(coefficients: [f64; 6], by: f64) -> [f64; 6] {
    let mut shifted = coefficients;
    let mut first = 0;
    while first < 5 {
        let mut k = 5;
        while k > first {
            shifted[k - 1] += by * shifted[k];
            k -= 1;
        }
        first += 1;
    }
    shifted
}

/// Coefficients of the piece from `[y, s, m]` at u = 0 to those at u = h. h may be negative.
const fn hermite(h: f64, [y0, s0, m0]: [f64; 3], [y1, s1, m1]: [f64; 3]) -> [f64; 6] {
    let r0 = ((y1 - y0) / h - s0) / (h * h) - 0.5 * m0 / h;
    let r1 = (s1 - s0) / (h * h) - m0 / h;
    let r2 = (m1 - m0) / h;
    let a = 10.0 * r0 - 4.0 * r1 + 0.5 * r2;
    let b = -15.0 * r0 + 7.0 * r1 - r2;
    let c = 6.0 * r0 - 3.0 * r1 + 0.5 * r2;
    [y0, s0, 0.5 * m0, a, b / h, c / (h * h)]
}

/// Coefficients of the pieces, each at its left knot, and of the last one at its right knot.
pub(super) const fn pieces<const N: usize>(x: &[f64; N], y: &[f64; N], is_periodic: bool) -> [[f64; 6]; N] {
    let mut pieces = [[0.0; 6]; N];
    let mut buffers = Buffers {
        rows: &mut [Row::ZERO; N],
        known: &mut [[0.0; 2]; N],
        above: &mut [ZERO; N],
        by_last: &mut [ZERO; N],
    };
    pieces_of(x, y, is_periodic, &mut pieces, &mut buffers);
    pieces
}

/// Computes the coefficients as [`pieces`], for lists of one length, in an array of zeros.
pub(super) const fn pieces_of(x: &[f64], y: &[f64], is_periodic: bool, pieces: &mut [[f64; 6]], buffers: &mut Buffers) {
    let n = x.len();
    if !is_periodic && n <= 6 {
        return polynomial(x, y, pieces);
    }
    // The knots with unknowns.
    let (first, count) = if is_periodic { (0, n - 1) } else { (3, n - 6) };
    let mut i = 0;
    while i < count {
        let knot = first + i;
        let (before, after) = (if knot == 0 { n - 2 } else { knot - 1 }, knot);
        let mut row = buffers.rows[i];
        row = if is_periodic || i > 0 {
            let h = x[before + 1] - x[before];
            with_piece_before(row, h, (y[before + 1] - y[before]) / h)
        } else {
            Side::new(x, y, [0, 1, 2], knot).added_to(row, -1.0)
        };
        row = if is_periodic || i + 1 < count {
            let h = x[after + 1] - x[after];
            with_piece_after(row, h, (y[after + 1] - y[after]) / h)
        } else {
            Side::new(x, y, [n - 3, n - 2, n - 1], knot).added_to(row, 1.0)
        };
        buffers.rows[i] = row;
        i += 1;
    }
    solve(buffers, count, is_periodic);
    let found = &*buffers.known;
    i = 0;
    while i < count {
        let knot = first + i;
        let [s, m] = found[i];
        if is_periodic || i + 1 < count {
            let [s1, m1] = found[(i + 1) % count];
            pieces[knot] = hermite(x[knot + 1] - x[knot], [y[knot], s, m], [y[knot + 1], s1, m1]);
        }
        i += 1;
    }
    if is_periodic {
        let ([s0, m0], [s, m]) = (found[count - 1], found[0]);
        pieces[n - 1] = hermite(x[n - 2] - x[n - 1], [y[n - 1], s, m], [y[n - 2], s0, m0]);
        return;
    }
    // The polynomials of three pieces, at each of their knots.
    let (left, right) = (3, n - 4);
    let mut k = 0;
    while k < 3 {
        pieces[k] = one_of_three(x, y, &Side::new(x, y, [0, 1, 2], left), found[0], [left, k]);
        k += 1;
    }
    k = right;
    while k < n {
        let side = Side::new(x, y, [n - 3, n - 2, n - 1], right);
        pieces[k] = one_of_three(x, y, &side, found[count - 1], [right, k]);
        k += 1;
    }
}

/// The polynomial of three pieces that has slope and second derivative `[s, m]` at the knot `base`, at the knot `at`.
const fn one_of_three(x: &[f64], y: &[f64], side: &Side, [s, m]: [f64; 2], [base, at]: [usize; 2]) -> [f64; 6] {
    let [a, b, c] = side.highest([s, m]);
    let mut piece = shifted([y[base], s, 0.5 * m, a, b, c], x[at] - x[base]);
    piece[0] = y[at];
    piece
}

/// The polynomial through at most six points, at each of them: Newton's form, then its expansion.
const fn polynomial(x: &[f64], y: &[f64], pieces: &mut [[f64; 6]]) {
    let n = x.len();
    let mut differences = [0.0; 6];
    let mut i = 0;
    while i < n {
        differences[i] = y[i];
        i += 1;
    }
    let mut order = 1;
    while order < n {
        i = n - 1;
        while i >= order {
            differences[i] = (differences[i] - differences[i - 1]) / (x[i] - x[i - order]);
            i -= 1;
        }
        order += 1;
    }
    let mut at = 0;
    while at < n {
        let mut piece = [0.0; 6];
        let mut k = n;
        while k > 0 {
            k -= 1;
            // piece ← piece (u + distance) + difference.
            let distance = x[at] - x[k];
            let mut power = 5;
            while power > 0 {
                piece[power] = piece[power] * distance + piece[power - 1];
                power -= 1;
            }
            piece[0] = piece[0] * distance + differences[k];
        }
        piece[0] = y[at];
        pieces[at] = piece;
        at += 1;
    }
}
