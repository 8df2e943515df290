//! Cyclic tridiagonal equations, while compiling.

/// The solution of `lower x[i − 1] + diagonal x[i] + upper x[i + 1] = right`, with indices modulo `count`. A row is
/// `[lower, diagonal, upper, right]`; entries from `count` on are zero.
///
/// Without pivoting, in O(count): the last unknown is eliminated after the others. `known` gets the solution.
pub(super) const fn solve(rows: &[[f64; 4]], count: usize, known: &mut [f64], others: &mut [[f64; 2]]) {
    let last = count - 1;
    // x[i] = known[i] − above x[i + 1] − by_last x[last], with [above, by_last] = others[i].
    let mut i = 0;
    while i < last {
        let [lower, diagonal, upper, right] = rows[i];
        let is_before_last = i + 1 == last;
        let coupling = if is_before_last { upper } else { 0.0 };
        let inner = if is_before_last { 0.0 } else { upper };
        if i == 0 {
            known[0] = right / diagonal;
            others[0] = [inner / diagonal, (coupling + lower) / diagonal];
        } else {
            let [above, by_last] = others[i - 1];
            let pivot = diagonal - lower * above;
            known[i] = (right - lower * known[i - 1]) / pivot;
            others[i] = [inner / pivot, (coupling - lower * by_last) / pivot];
        }
        i += 1;
    }
    while i > 1 {
        i -= 1;
        let above = others[i - 1][0];
        known[i - 1] -= above * known[i];
        others[i - 1][1] -= above * others[i][1];
    }
    let [lower, diagonal, upper, right] = rows[last];
    known[last] = if last == 0 {
        right / (lower + diagonal + upper)
    } else {
        let pivot = diagonal - lower * others[last - 1][1] - upper * others[0][1];
        (right - lower * known[last - 1] - upper * known[0]) / pivot
    };
    i = 0;
    while i < last {
        known[i] -= others[i][1] * known[last];
        i += 1;
    }
}
