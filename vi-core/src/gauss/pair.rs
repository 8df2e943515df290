//! Double-double numbers, the unevaluated sum of two, for constants computed at compile time.
//!
//! A pair `(high, low)` has |low| ≤ half an ulp of high. Error: a few units of 2⁻¹⁰⁴ (Dekker 1971).

/// A double-double number.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pair {
    pub(crate) high: f64,
    pub(crate) low: f64,
}

impl Pair {
    pub(crate) const ZERO: Self = Self::new(0.0);
    pub(crate) const ONE: Self = Self::new(1.0);

    pub(crate) const fn new(value: f64) -> Self {
        Self { high: value, low: 0.0 }
    }

    /// Normalizes a sum whose second term is the smaller one.
    const fn normalized(high: f64, low: f64) -> Self {
        let sum = high + low;
        Self { high: sum, low: low - (sum - high) }
    }

    pub(crate) const fn plus(self, other: Self) -> Self {
        let sum = self.high + other.high;
        let part = sum - self.high;
        let lost = (self.high - (sum - part)) + (other.high - part);
        Self::normalized(sum, lost + (self.low + other.low))
    }

    pub(crate) const fn minus(self, other: Self) -> Self {
        self.plus(Self { high: -other.high, low: -other.low })
    }

    pub(crate) const fn times(self, other: Self) -> Self {
        let product = self.high * other.high;
        let ([a, a_low], [b, b_low]) = (halves(self.high), halves(other.high));
        let lost = ((a * b - product) + a * b_low + a_low * b) + a_low * b_low;
        Self::normalized(product, lost + (self.high * other.low + self.low * other.high))
    }

    pub(crate) const fn over(self, other: Self) -> Self {
        let quotient = Self::new(self.high / other.high);
        let left = self.minus(quotient.times(other));
        quotient.plus(Self::new((left.high + left.low) / other.high))
    }
}

/// Splits a number into a sum of two with half the digits each, whose products are exact.
const fn halves(value: f64) -> [f64; 2] {
    // 2²⁷ + 1.
    let scaled = value * 134_217_729.0;
    let high = scaled - (scaled - value);
    [high, value - high]
}
