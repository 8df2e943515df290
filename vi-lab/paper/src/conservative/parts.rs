//! The two parts of the energy error (Remarks 5 and 6 of the paper): the discrete energy error and the discretization error.

use super::super::book::{Book, Verdict};
use super::plain::density;
use super::runs::Pair;
use vi_report::numbers::scientific;
use vi_report::table::Table;

/// The section: a table of both parts for all cases.
pub(super) fn section(book: &mut Book, runs: &[Pair]) {
    book.page.section("The two parts of the energy error");
    book.page.prose(
        "Remark 5 of the paper splits the usual energy error <i>E<sub>k</sub></i> − <i>H</i><sub>0</sub>: the discrete energy \
         error <i>E<sub>k</sub></i> − <i>E</i><sub>1</sub> comes from the solver and from the method, the discretization error \
         <i>E</i><sub>1</sub> − <i>H</i><sub>0</sub> from the start. Here \
         <i>E</i><sub>1</sub> − <i>H</i><sub>0</sub> ≈ −<i>h</i><sub>0</sub>²<i>D</i>/8. Remark 6 states that for a \
         conservative system the second part is constant and larger by orders of magnitude.",
    );
    let mut table = Table::new(
        "energy-parts",
        [
            "case",
            "discretization error E₁ − H₀",
            "−h₀²D/8",
            "discrete error, energy-preserving",
            "discrete error, fixed step",
        ],
    );
    let mut holds = true;
    for run in runs {
        let law = -run.case.h0.powi(2) * density(run.case.q0, 0.0) / 8.0;
        table.row([
            run.case.label(),
            scientific(run.start),
            scientific(law),
            scientific(run.energy.error),
            scientific(run.fixed.error),
        ]);
        holds &= run.energy.error < 1e-6 * run.start.abs() && (run.start / law - 1.0).abs() < 0.03;
    }
    book.page.table(&table, "Both parts for all cases, over the whole runs.");
    let ratios = runs.iter().map(|run| scientific(run.start.abs() / run.energy.error));
    book.item(
        "Remarks 5 and 6: the discretization error is constant, and orders of magnitude larger than the discrete error",
        "—",
        format!("larger by factors of {}", ratios.collect::<Vec<_>>().join(", ")),
        Verdict::Agrees.when(holds),
        "energy-parts",
    );
}
