//! Narrows an interval in which a scalar function changes its sign.
//!
//! Chandrupatla's method (*Adv. Eng. Softw.* 28, 1997): inverse quadratic interpolation if the three last points allow
//! it, bisection otherwise. At least every third evaluation halves the interval, so that flat and discontinuous
//! functions terminate too. Zero counts as positive.

/// Evaluations within which the interval must halve; otherwise the next one bisects it.
const PATIENCE: u32 = 3;

/// A point and the value of the function there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Point {
    pub(crate) x: f64,
    pub(crate) y: f64,
}

impl Point {
    /// Whether the value is zero or more.
    pub(crate) fn is_positive(self) -> bool {
        self.y >= 0.0
    }
}

/// Two neighbouring points between which the function `y` changes its sign, the one on the side of `from` first.
///
/// The ends have values of different sign. The first evaluation is at `guess` if that lies between them. Points are
/// neighbours if no number lies between them, or if they are at most `resolution` apart.
///
/// # Errors
/// The errors of `y`.
pub(crate) fn narrowed<E>(
    y: impl Fn(f64) -> Result<f64, E>,
    [mut from, mut to]: [Point; 2],
    guess: Option<f64>,
    resolution: f64,
) -> Result<[Point; 2], E> {
    let mut next = guess.unwrap_or(f64::NAN);
    let mut width = (to.x - from.x).abs();
    let mut waited = 0;
    loop {
        let middle = from.x + 0.5 * (to.x - from.x);
        if (to.x - from.x).abs() <= resolution || middle - from.x == 0.0 || middle - to.x == 0.0 {
            return Ok([from, to]);
        }
        let inside = (next - from.x).abs().min((next - to.x).abs());
        let is_between = (next - from.x) * (next - to.x) < 0.0 && inside >= resolution;
        let x = if is_between { next } else { middle };
        let new = Point { x, y: y(x)? };
        let is_from = new.is_positive() == from.is_positive();
        let replaced = core::mem::replace(if is_from { &mut from } else { &mut to }, new);
        let other = if is_from { to } else { from };
        waited += 1;
        if (to.x - from.x).abs() <= 0.5 * width {
            width = (to.x - from.x).abs();
            waited = 0;
        }
        next = if waited < PATIENCE { interpolated([new, other, replaced], resolution) } else { f64::NAN };
    }
}

/// The root by inverse quadratic interpolation through the newest point, the other end and the replaced point, at least
/// one neighbour away from both ends; NaN if the points do not allow it.
fn interpolated([one, two, three]: [Point; 3], resolution: f64) -> f64 {
    let place = (one.x - two.x) / (three.x - two.x);
    let value = (one.y - two.y) / (three.y - two.y);
    if !(value * value < place && (1.0 - value) * (1.0 - value) < 1.0 - place) {
        return f64::NAN;
    }
    let width = two.x - one.x;
    let part = one.y / (two.y - one.y) * (three.y / (two.y - three.y))
        + (three.x - one.x) / width * (one.y / (three.y - one.y)) * (two.y / (three.y - two.y));
    let rounding = f64::EPSILON * one.x.abs().max(two.x.abs());
    let least = resolution.max(rounding) / width.abs();
    if least < 0.5 { one.x + part.clamp(least, 1.0 - least) * width } else { f64::NAN }
}

#[cfg(test)]
mod tests {
    use super::{Point, narrowed};
    use core::cell::Cell;
    use core::convert::Infallible;

    /// The neighbours, and the number of evaluations.
    fn ends(y: impl Fn(f64) -> f64, [a, b]: [f64; 2], guess: Option<f64>) -> ([Point; 2], u32) {
        let count = Cell::new(0);
        let counted = |x: f64| -> Result<f64, Infallible> {
            count.set(count.get() + 1);
            Ok(y(x))
        };
        let Ok(found) = narrowed(counted, [a, b].map(|x| Point { x, y: y(x) }), guess, 0.0);
        (found, count.get())
    }

    /// A function, its root, and the evaluations that it takes.
    type Case = (fn(f64) -> f64, f64, u32);

    #[test]
    fn neighbours_enclose_the_root() {
        let functions: [Case; 7] = [
            (|x| x - 0.3, 0.3, 3),
            (|x| x.exp() - 1.5, 1.5_f64.ln(), 8),
            (|x| (x - 0.3).powi(3), 0.3, 54),
            (|x| 1.0_f64.copysign(x - 0.7), 0.7, 53),
            (|x| -(x - 0.5).max(0.0), 0.5, 4),
            (|x| 1e-300 * (0.2 - x), 0.2, 5),
            (|x| (x - 0.9).abs().sqrt().copysign(x - 0.9), 0.9, 49),
        ];
        for (index, (y, exact, most)) in functions.into_iter().enumerate() {
            for ends_of in [[0.0, 1.0], [1.0, 0.0]] {
                let ([from, to], count) = ends(y, ends_of, None);
                assert_ne!(from.is_positive(), to.is_positive());
                assert_eq!(from.is_positive(), y(ends_of[0]) >= 0.0);
                assert!((to.x - from.x).abs() <= f64::EPSILON * exact, "{index}: {from:?} {to:?}");
                assert!((to.x - exact).abs() <= 4.0 * f64::EPSILON, "{index}: {to:?} {exact}");
                assert!(count <= most, "{index}: {count} evaluations");
            }
        }
    }

    #[test]
    fn a_root_near_zero_is_exact_to_its_own_rounding() {
        let ([from, to], count) = ends(|x| 1e-17 - x, [0.0, 1.0], Some(1.1e-17));
        assert!(from.x <= 1e-17 && to.x > 1e-17 && to.x - from.x < 4e-33, "{from:?} {to:?}");
        assert!(count < 12, "{count}");
    }
}
