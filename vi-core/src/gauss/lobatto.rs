//! Lobatto nodes and weights for the constraints of a step with S Gauss stages, computed at compile time.
//!
//! The nodes are `0 = c_0 < … < c_S = 1`, and the weights b̃. With the Lagrange polynomials l_j of the Gauss nodes,
//!
//! ```text
//! part_ji = ã_ij / b_j,   ã_ij = ∫_0^{c_i} l_j        i = 1 … S
//! ```
//!
//! so that `q(c_i) = q0 + Σ_j part_ji (h b_j V_j)`. Stage i takes the part `1 − part_ij` of the impulse at node j. That
//! difference is exact, so that the step is symplectic up to the rounding of its sums. c_0 = 0 has the part 0.

use super::pair::Pair;
use super::tableau::{HALF, integrals, legendre, node, on_grid, polynomials, product, real, transposed};

/// The coefficients of S stages; see the [module](self).
#[derive(Debug)]
pub(crate) struct Lobatto<const S: usize> {
    /// The nodes c_1 … c_S.
    pub(crate) c: [f64; S],
    /// The weights of the nodes c_0 … c_{S−1}.
    pub(crate) b: [f64; S],
    /// `part[j][i − 1] = ã_ij / b_j` for the nodes i = 1 … S.
    pub(crate) part: [[f64; S]; S],
}

impl<const S: usize> Lobatto<S> {
    /// The coefficients.
    pub(crate) const VALUES: Self = Self::new();

    const fn new() -> Self {
        assert!(S >= 1 && S <= 16, "a Gauss step has 1 to 16 stages");
        let (mut gauss, mut lobatto) = ([Pair::ZERO; S], [Pair::ONE; S]);
        let (mut c, mut b) = ([1.0; S], [0.0; S]);
        let mut i = 0;
        while i < S {
            // Both kinds of nodes are symmetric about the middle.
            gauss[i] = if 2 * i < S { node(S, i) } else { Pair::ZERO.minus(gauss[S - 1 - i]) };
            if i + 1 < S {
                lobatto[i] = if 2 * i + 2 <= S { inner(S, i + 1) } else { Pair::ZERO.minus(lobatto[S - 2 - i]) };
                c[i] = on_grid(Pair::ONE.plus(lobatto[i]).times(HALF));
            }
            i += 1;
        }
        // The weight of c_i is that of c_{S−i}.
        i = 0;
        while i < S {
            let value = at(S, lobatto[S - 1 - i]);
            let weight = Pair::ONE.over(Pair::new(real(S * (S + 1))).times(value.times(value)));
            b[i] = weight.high;
            i += 1;
        }
        let exact = product(&integrals(&lobatto, &polynomials(&lobatto)), &transposed(&polynomials(&gauss)), S);
        let mut part = [[1.0; S]; S];
        let mut j = 0;
        while j < S {
            i = 0;
            while i + 1 < S {
                // A multiple of 2⁻⁵²: 1 minus it is exact, even if it is negative.
                part[j][i] = 2.0 * on_grid(exact[j][i].times(HALF));
                i += 1;
            }
            j += 1;
        }
        Self { c, b, part }
    }
}

/// P_s(x) for a Lobatto node x. At the end it is 1, because [`legendre`] computes 0/0 there.
const fn at(s: usize, x: Pair) -> Pair {
    if x.high >= 1.0 { Pair::ONE } else { legendre(s, x).0 }
}

/// Node i of s + 1 Lobatto nodes on [−1, 1], for 0 < i < s: the root of P_s' by Newton iteration. `(1 − x²) P_s'' = 2 x
/// P_s' − s (s + 1) P_s`.
const fn inner(s: usize, i: usize) -> Pair {
    if 2 * i == s {
        return Pair::ZERO;
    }
    // The Gauss nodes i − 1 and i enclose it.
    let mut x = node(s, i - 1).plus(node(s, i)).times(HALF);
    let mut k = 0;
    while k < 8 {
        let (value, slope) = legendre(s, x);
        let bend = Pair::new(2.0).times(x.times(slope)).minus(Pair::new(real(s * (s + 1))).times(value));
        let rest = Pair::ONE.minus(x.times(x));
        x = x.minus(slope.times(rest).over(bend));
        k += 1;
    }
    x
}

#[cfg(test)]
mod tests {
    use super::Lobatto;
    use crate::gauss::tableau::Tableau;

    /// Tests quadrature up to degree 2s − 1, and collocation, for one S.
    fn check<const S: usize>() {
        let Lobatto { c, b, part } = &Lobatto::<S>::VALUES;
        let gauss = &Tableau::<S>::VALUES;
        let mut worst: f64 = 0.0;
        for power in 0..2 * S {
            let exponent = i32::try_from(power).expect("a small power");
            let at = |c: f64| c.powi(exponent);
            let nodes = (1..S).map(|i| b[i] * at(c[i - 1])).sum::<f64>() + b[0] * (at(0.0) + at(1.0));
            worst = worst.max((nodes - f64::from(exponent + 1).recip()).abs());
            if power < S {
                for i in 0..S {
                    let sum: f64 = (0..S).map(|j| part[j][i] * gauss.b[j] * gauss.c[j].powi(exponent)).sum();
                    worst = worst.max((sum - c[i].powi(exponent + 1) / f64::from(exponent + 1)).abs());
                }
            }
        }
        println!("{S} stages: {worst:e}");
        // 2.8e-16 was measured.
        assert!(worst < 5e-16, "{S} stages: {worst:e}");
    }

    #[test]
    fn the_conditions_of_order_hold() {
        check::<1>();
        check::<2>();
        check::<3>();
        check::<4>();
        check::<5>();
        check::<8>();
        check::<11>();
        check::<16>();
    }

    #[test]
    fn three_nodes_are_those_of_simpson() {
        let Lobatto { c, b, part } = &Lobatto::<2>::VALUES;
        assert_eq!((*c, b.map(|b| (6.0 * b).round())), ([0.5, 1.0], [1.0, 4.0]));
        // ∫_0^{1/2} of l_1 and l_2 over their weight 1/2: 1/2 ± √3/4.
        let exact = [0.5 + 0.75_f64.sqrt() / 2.0, 0.5 - 0.75_f64.sqrt() / 2.0];
        assert!((part[0][0] - exact[0]).abs() + (part[1][0] - exact[1]).abs() < 5e-16);
        assert_eq!([part[0][1], part[1][1]].map(f64::to_bits), [1.0_f64.to_bits(); 2]);
    }
}
