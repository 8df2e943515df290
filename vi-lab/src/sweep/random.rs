//! Random numbers determined by a seed and a place.
//!
//! In: a seed and a place. Out: the number at this place of the SplitMix64 sequence of the seed: a mixing of `seed +
//! (place + 1) γ`. γ is the odd number next to 2^64 over the golden ratio. Source: G. L. Steele, D. Lea, C. H.
//! Flood, Fast splittable pseudorandom number generators, OOPSLA 2014.

const GAMMA: u64 = 0x9e37_79b9_7f4a_7c15;

/// The 64 bits at a place.
pub(super) fn bits(seed: u64, place: u64) -> u64 {
    let state = seed.wrapping_add(place.wrapping_add(1).wrapping_mul(GAMMA));
    let once = (state ^ (state >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let twice = (once ^ (once >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    twice ^ (twice >> 31)
}

/// A number strictly between 0 and 1: one of 2^52 equidistant values.
#[allow(clippy::cast_precision_loss)] // 52 bits
pub(super) fn uniform(seed: u64, place: u64) -> f64 {
    ((bits(seed, place) >> 12) as f64 + 0.5) / (1_u64 << 52) as f64
}

/// A standard normal number, by Box and Muller, from the uniform numbers at two places.
pub(super) fn normal(seed: u64, places: [u64; 2]) -> f64 {
    let [radius, angle] = places.map(|place| uniform(seed, place));
    (-2.0 * radius.ln()).sqrt() * (core::f64::consts::TAU * angle).cos()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_numbers_are_those_of_splitmix64() {
        // The published sequence of the seed 1234567.
        let published = [
            6_457_827_717_110_365_317,
            3_203_168_211_198_807_973,
            9_817_491_932_198_370_423,
            4_593_380_528_125_082_431,
            16_408_922_859_458_223_821,
        ];
        assert_eq!([0, 1, 2, 3, 4].map(|place| bits(1_234_567, place)), published);
    }

    #[test]
    #[allow(clippy::cast_precision_loss)] // a few thousand
    fn means_and_variances_are_those_of_their_laws() {
        const COUNT: u64 = 40_000;
        let moments = |draw: &dyn Fn(u64) -> f64| {
            let mean = (0..COUNT).map(draw).sum::<f64>() / COUNT as f64;
            (mean, (0..COUNT).map(|place| (draw(place) - mean).powi(2)).sum::<f64>() / COUNT as f64)
        };
        let (mean, variance) = moments(&|place| uniform(7, place));
        // Four standard deviations of the mean: 0.0058; of the variance: 0.0015.
        assert!((mean - 0.5).abs() < 0.0058 && (variance - 1.0 / 12.0).abs() < 0.0015, "{mean} {variance}");
        let (mean, variance) = moments(&|place| normal(7, [2 * place, 2 * place + 1]));
        // 0.02 and 0.0283.
        assert!(mean.abs() < 0.02 && (variance - 1.0).abs() < 0.0283, "{mean} {variance}");
        assert!((0..COUNT).all(|place| uniform(3, place) > 0.0 && uniform(3, place) < 1.0));
    }
}
