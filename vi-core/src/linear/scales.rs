//! Scale factors of unknowns: powers of two, so that scaling does not round.

/// A power of two near `1/√x`; 1 for zero.
#[inline(always)]
pub(crate) fn reciprocal_root(x: f64) -> f64 {
    power(x, |exponent| exponent.div_euclid(2))
}

/// A power of two near `1/x`, for scaling without rounding; 1 for zero.
#[inline(always)]
pub(crate) fn reciprocal_power(x: f64) -> f64 {
    power(x, |exponent| exponent)
}

/// 2 to the minus `part` of the exponent of x; 1 if x is zero, subnormal or not finite.
#[inline(always)]
fn power(x: f64, part: impl Fn(i64) -> i64) -> f64 {
    const BIAS: i64 = 1023;
    if !x.is_normal() {
        return 1.0;
    }
    let exponent = ((x.abs().to_bits() >> 52).cast_signed()) - BIAS;
    // 2⁻¹⁰²³ is subnormal.
    f64::from_bits((BIAS - part(exponent).min(BIAS - 1)).cast_unsigned() << 52)
}

#[cfg(test)]
mod tests {
    use super::{reciprocal_power, reciprocal_root};

    #[test]
    fn scales_are_powers_of_two_in_any_unit() {
        for exponent in [-1000, -3, 0, 1, 7, 1022] {
            let x = 1.5 * 2.0_f64.powi(exponent);
            let [power, root] = [reciprocal_power(x) * x, reciprocal_root(x) * reciprocal_root(x) * x];
            assert!((1.0..2.0).contains(&power) && (1.0..4.0).contains(&root), "{exponent} {power} {root}");
        }
        for x in [0.0, f64::NAN, f64::INFINITY, 1e-310] {
            assert_eq!([reciprocal_power(x), reciprocal_root(x)].map(f64::to_bits), [1.0_f64.to_bits(); 2]);
        }
    }
}
