//! The coefficients of Gauss collocation with S stages, computed at compile time.
//!
//! The nodes are c and the weights b. The matrices of a step have the form `column j over the stages i`:
//!
//! ```text
//! a_ij = ∫_0^{c_i} l_j        first   = a_ij / b_j            second = (A²)_ij / b_j        next = l_j(1 + c_i)
//! ahead = (A² next)_ij / b_j
//! ```
//!
//! l_j is the Lagrange polynomial of node j; sums over Legendre polynomials give its integral without cancellation
//! (Hairer, Lubich, Wanner, *Geometric Numerical Integration*, II.1.3). The computation has twice the precision. Its
//! results are rounded so that the conditions of a symplectic method hold exactly:
//!
//! ```text
//! first_ij + first_ji = 1        second_ij − second_ji = c_i − c_j        first_ii = 1/2
//! ```
//!
//! A step that multiplies stage impulses `h b_j F_j` by these is symplectic up to the rounding of its sums. With
//! individually rounded `a_ij` the energy would drift (Antoñana, Makazaga, Murua, arXiv 2511.03655).

use super::pair::Pair;

/// Highest degree of the polynomial that extrapolates a step. A higher degree amplifies rounding more than it improves
/// the guess.
pub(crate) const DEGREE: usize = 7;

/// The coefficients of S stages; see the [module](self).
#[derive(Debug)]
pub(crate) struct Tableau<const S: usize> {
    /// Nodes in (0, 1), ascending, rounded to multiples of 2⁻⁵³.
    pub(crate) c: [f64; S],
    /// Weights; their sum is 1.
    pub(crate) b: [f64; S],
    /// `first[j][i] = a_ij / b_j`.
    pub(crate) first: [[f64; S]; S],
    /// `second[j][i] = (A²)_ij / b_j`.
    pub(crate) second: [[f64; S]; S],
    /// `next[j][i]`: the weight of stage j in the value extrapolated to stage i of the next step. The polynomial
    /// through the stages has a degree of up to [`DEGREE`].
    pub(crate) next: [[f64; S]; S],
    /// `ahead[j][i]`: `second` applied to `next`.
    pub(crate) ahead: [[f64; S]; S],
    /// `legendre[k][i] = P_k(2 c_i − 1)`.
    pub(crate) legendre: [[f64; S]; S],
    /// `to_legendre[k][i] = (2k + 1) b_i P_k(2 c_i − 1)`: the weight of stage i in the coefficient of P_k.
    pub(crate) to_legendre: [[f64; S]; S],
}

impl<const S: usize> Tableau<S> {
    /// The coefficients.
    pub(crate) const VALUES: Self = Self::new();

    const fn new() -> Self {
        assert!(S >= 1 && S <= 16, "a Gauss step has 1 to 16 stages");
        let mut x = [Pair::ZERO; S];
        let mut c = [Pair::ZERO; S];
        let mut b = [Pair::ZERO; S];
        let mut i = 0;
        while i < S {
            // The nodes are symmetric about the middle.
            x[i] = if 2 * i < S { node(S, i) } else { Pair::ZERO.minus(x[S - 1 - i]) };
            c[i] = Pair::ONE.plus(x[i]).times(HALF);
            b[i] = weight(S, x[i]);
            i += 1;
        }
        let legendre = polynomials(&x);
        let at_nodes = transposed(&legendre);
        let first = product(&integrals(&x, &legendre), &at_nodes, S);
        let next = product(&beyond(&x), &at_nodes, DEGREE + 1);
        let second = product(&scaled(&first, &b), &first, S);
        let ahead = product(&scaled(&second, &b), &next, S);
        let rounded = Self::rounded(&c, &b, &first, &second);
        let legendre = nearest(&legendre);
        let to_legendre = Self::to_legendre(&rounded.b, &legendre);
        Self { next: nearest(&scaled(&next, &b)), ahead: nearest(&ahead), legendre, to_legendre, ..rounded }
    }

    const fn to_legendre(b: &[f64; S], legendre: &[[f64; S]; S]) -> [[f64; S]; S] {
        let mut weights = *legendre;
        let mut k = 0;
        while k < S {
            let mut i = 0;
            while i < S {
                weights[k][i] = real(2 * k + 1) * b[i] * legendre[k][i];
                i += 1;
            }
            k += 1;
        }
        weights
    }

    /// Rounds so that the conditions of the [module](self) hold exactly: sums and differences of multiples of 2⁻⁵³
    /// below 1 are exact.
    const fn rounded(c: &[Pair; S], b: &[Pair; S], first: &[[Pair; S]; S], second: &[[Pair; S]; S]) -> Self {
        let zeros = [[0.0; S]; S];
        let mut values = Self {
            c: [0.0; S],
            b: [0.0; S],
            first: zeros,
            second: zeros,
            next: zeros,
            ahead: zeros,
            legendre: zeros,
            to_legendre: zeros,
        };
        let mut i = 0;
        while i < S {
            values.c[i] = on_grid(c[i]);
            values.b[i] = b[i].high;
            values.first[i][i] = 0.5;
            values.second[i][i] = on_grid(second[i][i]);
            let mut j = 0;
            while j < i {
                values.first[j][i] = on_grid(first[j][i]);
                values.first[i][j] = 1.0 - values.first[j][i];
                values.second[j][i] = on_grid(second[j][i]);
                values.second[i][j] = values.second[j][i] - (values.c[i] - values.c[j]);
                j += 1;
            }
            i += 1;
        }
        values
    }
}

pub(super) const HALF: Pair = Pair::new(0.5);

/// The polynomials P_k, k = 0 … S − 1, at x, one row each.
pub(super) const fn polynomials<const S: usize>(x: &[Pair; S]) -> [[Pair; S]; S] {
    let mut values = [[Pair::ZERO; S]; S];
    let mut i = 0;
    while i < S {
        let mut last = [Pair::ONE, x[i]];
        let mut k = 0;
        while k < S {
            values[k][i] = last[0];
            last = [last[1], following(k + 1, x[i], last)];
            k += 1;
        }
        i += 1;
    }
    values
}

/// `(2k + 1) ∫_0^c P_k = (P_{k+1} − P_{k−1})/2` up to each node x of c, from the polynomials there, one row each.
pub(super) const fn integrals<const S: usize>(x: &[Pair; S], legendre: &[[Pair; S]; S]) -> [[Pair; S]; S] {
    let mut integrals = [[Pair::ZERO; S]; S];
    let mut i = 0;
    while i < S {
        integrals[0][i] = Pair::ONE.plus(x[i]).times(HALF);
        let mut k = 1;
        while k < S {
            let before = legendre[k - 1][i];
            let after = following(k, x[i], [before, legendre[k][i]]);
            integrals[k][i] = after.minus(before).times(HALF);
            k += 1;
        }
        i += 1;
    }
    integrals
}

/// `(2k + 1) P_k` at the nodes of the next step, one row each.
const fn beyond<const S: usize>(x: &[Pair; S]) -> [[Pair; S]; S] {
    let mut next = *x;
    let mut i = 0;
    while i < S {
        next[i] = x[i].plus(Pair::new(2.0));
        i += 1;
    }
    let mut values = polynomials(&next);
    let mut k = 0;
    while k < S {
        i = 0;
        while i < S {
            values[k][i] = Pair::new(real(2 * k + 1)).times(values[k][i]);
            i += 1;
        }
        k += 1;
    }
    values
}

/// `Σ_k left_ki right_jk` over this number of k. For `(2k + 1) P_k` and P_k(x_j) it is `l_j / b_j` truncated in degree;
/// for their integrals it is the integral of that; for `b_k a_ik / b_k` and `a_kj / b_j` it is `(A²)_ij / b_j`.
pub(super) const fn product<const S: usize>(
    left: &[[Pair; S]; S],
    right: &[[Pair; S]; S],
    terms: usize,
) -> [[Pair; S]; S] {
    let mut product = [[Pair::ZERO; S]; S];
    let mut j = 0;
    while j < S {
        let mut i = 0;
        while i < S {
            let mut k = 0;
            while k < S && k < terms {
                product[j][i] = product[j][i].plus(left[k][i].times(right[j][k]));
                k += 1;
            }
            i += 1;
        }
        j += 1;
    }
    product
}

/// Transposes a matrix.
pub(super) const fn transposed<const S: usize>(matrix: &[[Pair; S]; S]) -> [[Pair; S]; S] {
    let mut transposed = *matrix;
    let mut j = 0;
    while j < S {
        let mut i = 0;
        while i < S {
            transposed[j][i] = matrix[i][j];
            i += 1;
        }
        j += 1;
    }
    transposed
}

/// `b_j matrix_ij`.
const fn scaled<const S: usize>(matrix: &[[Pair; S]; S], b: &[Pair; S]) -> [[Pair; S]; S] {
    let mut scaled = *matrix;
    let mut j = 0;
    while j < S {
        let mut i = 0;
        while i < S {
            scaled[j][i] = matrix[j][i].times(b[j]);
            i += 1;
        }
        j += 1;
    }
    scaled
}

/// Rounds a matrix to `f64`.
const fn nearest<const S: usize>(matrix: &[[Pair; S]; S]) -> [[f64; S]; S] {
    let mut nearest = [[0.0; S]; S];
    let mut j = 0;
    while j < S {
        let mut i = 0;
        while i < S {
            nearest[j][i] = matrix[j][i].high;
            i += 1;
        }
        j += 1;
    }
    nearest
}

/// Rounds a number in (−1, 1) to a multiple of 2⁻⁵³: adding 1 or 2 drops the lower bits.
pub(super) const fn on_grid(value: Pair) -> f64 {
    let shift = if value.high < 0.0 { -1.0 } else { 1.0 };
    // Numbers in [1, 2) are multiples of 2⁻⁵², so half of the doubled number is a multiple of 2⁻⁵³.
    let doubled = if value.high.abs() < 0.5 { 2.0 * value.high } else { return value.high };
    ((doubled + shift) - shift) * 0.5
}

/// Node i of s on [−1, 1], ascending: the root of P_s by Newton iteration from Tricomi's estimate.
pub(super) const fn node(s: usize, i: usize) -> Pair {
    if 2 * i + 1 == s {
        return Pair::ZERO;
    }
    let angle = core::f64::consts::PI * (real(i) + 0.75) / (real(s) + 0.5);
    let mut x = Pair::new(-cosine(angle));
    let mut k = 0;
    // Each iteration squares the distance, initially 1e-3.
    while k < 5 {
        let (value, slope) = legendre(s, x);
        x = x.minus(value.over(slope));
        k += 1;
    }
    x
}

/// The weight on [0, 1] of the node x: `1 / ((1 − x²) P_s'(x)²)`.
const fn weight(s: usize, x: Pair) -> Pair {
    let (_, slope) = legendre(s, x);
    let rest = Pair::ONE.minus(x.times(x));
    Pair::ONE.over(rest.times(slope.times(slope)))
}

/// P_s(x) and its derivative, from `(1 − x²) P_s' = s (P_{s−1} − x P_s)`.
pub(super) const fn legendre(s: usize, x: Pair) -> (Pair, Pair) {
    let mut last = [Pair::ONE, x];
    let mut k = 1;
    while k < s {
        last = [last[1], following(k, x, last)];
        k += 1;
    }
    let numerator = Pair::new(real(s)).times(last[0].minus(x.times(last[1])));
    (last[1], numerator.over(Pair::ONE.minus(x.times(x))))
}

/// `P_{k+1}(x) = ((2k + 1) x P_k − k P_{k−1}) / (k + 1)` from `[P_{k−1}, P_k]`.
const fn following(k: usize, x: Pair, last: [Pair; 2]) -> Pair {
    let first = Pair::new(real(2 * k + 1)).times(x.times(last[1]));
    let second = Pair::new(real(k)).times(last[0]);
    first.minus(second).over(Pair::new(real(k + 1)))
}

/// cos x for x in (0, π), by its power series: an estimate, so that its rounding does not matter.
const fn cosine(x: f64) -> f64 {
    let mut sum = 1.0;
    let mut term = 1.0;
    let mut k = 1;
    while k < 40 {
        term *= -x * x / (real(k) * real(k + 1));
        sum += term;
        k += 2;
    }
    sum
}

/// A small integer as a number.
#[allow(clippy::cast_precision_loss)]
pub(crate) const fn real(integer: usize) -> f64 {
    integer as f64
}

#[cfg(test)]
mod tests {
    use super::Tableau;

    /// Tests the residuals of the module's conditions and of the order conditions up to 2s, for one S.
    fn check<const S: usize>() {
        let Tableau { c, b, first, second, next, ahead, legendre, .. } = &Tableau::<S>::VALUES;
        for i in 0..S {
            for j in 0..S {
                assert_eq!((first[j][i] + first[i][j]).to_bits(), 1.0_f64.to_bits(), "{S} stages: {i}, {j}");
                let left = (second[j][i] - second[i][j]) - (c[i] - c[j]);
                assert!(left.abs() < f64::MIN_POSITIVE, "{S} stages: {i}, {j}: {left:e}");
            }
        }
        let mut worst: f64 = 0.0;
        for k in 0..S {
            for l in 0..S {
                let norm = (f64::from(u32::try_from((2 * k + 1) * (2 * l + 1)).expect("a few"))).sqrt();
                let product: f64 = (0..S).map(|i| b[i] * legendre[k][i] * legendre[l][i]).sum::<f64>() * norm;
                worst = worst.max((product - if k == l { 1.0 } else { 0.0 }).abs());
            }
        }
        println!("{S} stages: polynomials off by {worst:e}");
        // Orthonormal polynomials. Measured: 4.5e-16.
        assert!(worst < 1e-15, "{S} stages: {worst:e}");
        let mut worst_ahead: f64 = 0.0;
        // B(2S), C(S) and C(S) applied twice: quadrature of powers at the end, at the stages, and of their integrals.
        worst = 0.0;
        for power in 0..2 * S {
            let exponent = i32::try_from(power).expect("a small power");
            let sum: f64 = (0..S).map(|j| b[j] * c[j].powi(exponent)).sum();
            worst = worst.max((sum - 1.0 / f64::from(exponent + 1)).abs());
            if power >= S {
                continue;
            }
            for i in 0..S {
                let once: f64 = (0..S).map(|j| first[j][i] * b[j] * c[j].powi(exponent)).sum();
                let n = f64::from(exponent + 1);
                let at = c[i].powi(exponent + 1);
                worst = worst.max((once - at / n).abs());
                if power + 1 < S {
                    let twice: f64 = (0..S).map(|j| second[j][i] * b[j] * c[j].powi(exponent)).sum();
                    worst = worst.max((twice - at * c[i] / (n * (n + 1.0))).abs());
                }
                if power <= 7 {
                    let guess: f64 = (0..S).map(|j| next[j][i] * c[j].powi(exponent)).sum();
                    let scale: f64 = (0..S).map(|j| next[j][i].abs()).sum();
                    worst = worst.max((guess - (1.0 + c[i]).powi(exponent)).abs() / scale);
                    // ∫∫ (1 + c)^power from the node to the stage, which `second` has exactly for powers below S − 1.
                    if power + 1 < S {
                        let ahead_of: f64 = (0..S).map(|j| ahead[j][i] * b[j] * c[j].powi(exponent)).sum();
                        let end = (1.0 + c[i]).powi(exponent + 2) - 1.0 - (n + 1.0) * c[i];
                        let scale: f64 =
                            (0..S).map(|j| (ahead[j][i] * b[j]).abs()).sum::<f64>() + (n * (n + 1.0)).recip();
                        worst_ahead = worst_ahead.max((ahead_of - end / (n * (n + 1.0))).abs() / scale);
                    }
                }
            }
        }
        // Twice the rounding of a sum of sixteen terms: 3.4e-16 was measured at S = 13.
        assert!(worst < 5e-16, "{S} stages: {worst:e}");
        // 1.7e-15 was measured at S = 16.
        assert!(worst_ahead < 2e-15, "{S} stages: {worst_ahead:e}");
    }

    #[test]
    fn the_conditions_of_order_and_of_symplecticity_hold() {
        check::<1>();
        check::<2>();
        check::<3>();
        check::<4>();
        check::<5>();
        check::<6>();
        check::<7>();
        check::<8>();
        check::<9>();
        check::<10>();
        check::<11>();
        check::<12>();
        check::<13>();
        check::<14>();
        check::<15>();
        check::<16>();
    }
}
