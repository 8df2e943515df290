//! Slips in the printed formulas, which a generator must not repeat.

use super::book::Book;
use vi_report::failure::Failure;
use vi_report::table::Table;

/// Where, as printed, as derived.
const ERRATA: [[&str; 3]; 7] = [
    ["section 2.4, definition of Eₖ", "Eₖ = D₃ L_d", "Eₖ = −D₃ L_d"],
    ["forced time-marching form, Eₖ₊₁", "−D₃ L_d − g_d⁻", "−D₃ L_d − g_d⁺"],
    ["oscillator, Eₖ₊₁", "− c (qₖ₊₁ − qₖ)²/h", "− (c/2) (qₖ₊₁ − qₖ)²/h"],
    [
        "oscillator, implicit momentum equation",
        "m (qₖ₊₁ + qₖ)/h … − c h (qₖ₊₁ − qₖ)/2",
        "m (qₖ₊₁ − qₖ)/h … + c (qₖ₊₁ − qₖ)/2",
    ],
    ["oscillator, implicit equation of (q, p, h, v)", "(h/4)(2q + hv)", "k (h/4)(2q + hv)"],
    ["section 3, integrated variation", "f_L", "f_L c_t′"],
    [
        "Remark 7",
        "time-dependent systems must be solved for tₖ₊₁",
        "(v, h) serve every L(t, q, v), and are better in floating point",
    ],
];

/// The section: the table.
pub(super) fn section(book: &mut Book) -> Result<(), Failure> {
    book.section("Errata of the printed formulas");
    book.prose(
        "The integrators of this page are generated from the Lagrangian and the force; their formulas are derived, not \
         copied. Compared with the paper’s they differ in the places below, each checked by a computer algebra system and \
         in 50-digit arithmetic. All printed double-well formulas are right, with <i>m</i> = 1.",
    );
    let mut table = Table::new("errata", ["where", "printed", "derived"]);
    for row in ERRATA {
        table.row(row.map(str::to_owned));
    }
    book.table(&table, "Where the printed formulas and the derived ones differ.")
}
