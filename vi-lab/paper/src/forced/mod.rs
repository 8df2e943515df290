//! The forced example: a damped oscillator, `L = m v²/2 − k q²/2`, `f = −c v`, m = 1, k = 4, c = 4ζ, from rest at q = 1.
//!
//! In: nothing. Out: the sections on trajectories, energy, step growth, and negative damping. The exact motion is known:
//!
//! ```text
//! q(t) = e^(−ζωt) (cos ω_d t + (ζω/ω_d) sin ω_d t),    ω = 2,  ω_d = ω √(1 − ζ²)
//! ```

mod decay;
mod growth;
mod oscillator;

use super::book::Book;
use vi_report::failure::Failure;
use vi_report::progress::Progress;

/// Initial step.
const H0: f64 = 0.01;
/// Damping ratios of the paper.
const DAMPING: [f64; 3] = [0.001, 0.005, 0.01];

/// The sections on the forced example.
pub(super) fn chapter(book: &mut Book, progress: &mut Progress) -> Result<(), Failure> {
    progress.message("damped oscillator");
    book.page.section("A damped oscillator");
    book.page.formula("L = \\frac{1}{2} m v^2 − \\frac{1}{2} k q^2, ~ f = −c v");
    book.page.prose(
        "with <i>m</i> = 1, <i>k</i> = 4, so <i>ω</i> = 2, and <i>c</i> = 4<i>ζ</i>; <i>q</i>(0) = 1, <i>v</i>(0) = 0, \
         <i>h</i><sub>0</sub> = 0.01. The exact motion is known, and all errors are against it.",
    );
    decay::section(book)?;
    growth::section(book)?;
    growth::negative(book)
}
