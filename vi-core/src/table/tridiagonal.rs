//! Cyclic tridiagonal equations, while compiling.

/// The solution of `lower x[i − 1] + diagonal x[i] + upper x[i + 1] = right`, with indices modulo `count`. A row is
/// `[lower, diagonal, upper, right]`; entries from `count` on are zero.
///
/// Without pivoting, in O(count): the last unknown is eliminated after the others.
pub(super) const fn solve<const N: usize>(rows: &[[f64; 4]; N], count: usize) -> [f64; N] {
    let last = count - 1;
    // x[i] = known[i] − above[i] x[i + 1] − by_last[i] x[last].
    let (mut known, mut above, mut by_last) = ([0.0; N], [0.0; N], [0.0; N]);
    let mut i = 0;
    while i < last {
        let [lower, diagonal, upper, right] = rows[i];
        let is_before_last = i + 1 == last;
        let coupling = if is_before_last { upper } else { 0.0 };
        let inner = if is_before_last { 0.0 } else { upper };
        if i == 0 {
            (above[0], known[0], by_last[0]) = (inner / diagonal, right / diagonal, (coupling + lower) / diagonal);
        } else {
            let pivot = diagonal - lower * above[i - 1];
            above[i] = inner / pivot;
            known[i] = (right - lower * known[i - 1]) / pivot;
            by_last[i] = (coupling - lower * by_last[i - 1]) / pivot;
        }
        i += 1;
    }
    while i > 1 {
        i -= 1;
        known[i - 1] -= above[i - 1] * known[i];
        by_last[i - 1] -= above[i - 1] * by_last[i];
    }
    let [lower, diagonal, upper, right] = rows[last];
    known[last] = if last == 0 {
        right / (lower + diagonal + upper)
    } else {
        let pivot = diagonal - lower * by_last[last - 1] - upper * by_last[0];
        (right - lower * known[last - 1] - upper * known[0]) / pivot
    };
    i = 0;
    while i < last {
        known[i] -= by_last[i] * known[last];
        i += 1;
    }
    known
}
