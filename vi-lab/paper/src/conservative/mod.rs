//! The conservative example: a particle in a double well, `L = m v²/2 − (q⁴ − q²)/2`, m = 1, from rest.
//!
//! In: the length of the long runs. Out: the sections on phase portraits, energy and its two parts, step length, the initial
//! step, and condition numbers. All runs use the paper's start: the second node from an accurate solution at h0.

mod condition;
mod energy;
mod initial_step;
mod parts;
mod plain;
mod portrait;
mod runs;
mod step_length;

use super::book::Book;
use super::{Study, unexpected};
use runs::{Case, Pair};
use vi_report::failure::Failure;
use vi_report::progress::Progress;

/// The four cases of the paper: amplitude and initial step.
const CASES: [Case; 4] = [
    Case { q0: 0.74, h0: 0.01 },
    Case { q0: 0.74, h0: 0.1 },
    Case { q0: 0.995, h0: 0.01 },
    Case { q0: 0.995, h0: 0.1 },
];

/// The sections on the conservative example.
pub(super) fn chapter(book: &mut Book, study: &Study, progress: &mut Progress) -> Result<(), Failure> {
    let mut runs = Vec::new();
    for case in CASES {
        progress.message(format!("double well, {}", case.label()));
        runs.push(Pair::of(case, study.steps, progress).map_err(unexpected("double well"))?);
    }
    book.page.section("A particle in a double well");
    book.page.formula("L = \\frac{1}{2} m v^2 − \\frac{q^4 − q^2}{2}");
    book.page.prose(
        "The particle of mass <i>m</i> = 1 starts from rest. From <i>q</i><sub>0</sub> = 0.74 it oscillates nearly harmonically in \
         the right well. From <i>q</i><sub>0</sub> = 0.995, just below the barrier, it almost stops near the saddle at the \
         origin. Each motion is run with <i>h</i><sub>0</sub> = 0.01 and 0.1.",
    );
    portrait::section(book, &runs);
    energy::section(book, &runs);
    parts::section(book, &runs);
    step_length::section(book, &runs)?;
    progress.message("initial steps");
    initial_step::section(book, study)?;
    progress.message("condition numbers");
    condition::section(book)
}
