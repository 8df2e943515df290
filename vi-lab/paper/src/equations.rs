//! The printed equations beside the generated ones: both are evaluated on the same intervals.

use super::book::{Book, Verdict};
use core::f64::consts::TAU;
use vi_core::{DiscreteLagrangian, Interval, SVector};
use vi_report::numbers::scientific;
use vi_report::table::Table;
use vi_systems::{DampedOscillator, DoubleWell};

/// Intervals on which both are evaluated.
const INTERVALS: u32 = 64;
/// A difference below this is rounding. Measured: at most 8.9e-16 for formulas that agree, at least 0.168 for misprints.
const ROUNDING: f64 = 1e-14;

/// An equation: the paper's name, the printed formula, the derived formula, and both as functions of an interval.
struct Equation {
    name: &'static str,
    printed: &'static str,
    derived: &'static str,
    sides: fn(&Sample) -> [f64; 2],
}

/// An interval, and the numbers that the printed formulas use.
struct Sample {
    interval: Interval<1>,
    h: f64,
    v: f64,
    middle: f64,
}

impl Sample {
    /// An interval without symmetry.
    fn of(index: u32) -> Self {
        let phase = TAU * f64::from(index) / f64::from(INTERVALS);
        let (t0, h) = (0.3 * phase, 0.2 + 0.15 * (3.0 * phase).sin());
        let (q0, v) = (0.8 + 0.5 * phase.cos(), 0.9 * (2.0 * phase + 0.4).sin() + 0.2);
        let (t1, q1) = (t0 + h, q0 + h * v);
        let (h, v, middle) = (t1 - t0, (q1 - q0) / (t1 - t0), f64::midpoint(q0, q1));
        Self { interval: Interval { t0, q0: SVector::from([q0]), t1, q1: SVector::from([q1]) }, h, v, middle }
    }

    fn q0(&self) -> f64 {
        self.interval.q0.x
    }

    /// `q1 − q0`.
    fn way(&self) -> f64 {
        self.interval.q1.x - self.interval.q0.x
    }

    /// `q1 + q0`.
    fn sum(&self) -> f64 {
        self.interval.q1.x + self.interval.q0.x
    }

    fn potential(&self) -> f64 {
        (self.middle.powi(4) - self.middle.powi(2)) / 2.0
    }
}

/// Generated values: `[−D2 L_d − f_d⁻, D1 L_d + g_d⁻, D4 L_d + f_d⁺, −D3 L_d − g_d⁺]`, that is p_k, E_k, p_{k+1}, E_{k+1}.
fn slots(system: &impl DiscreteLagrangian<1>, interval: &Interval<1>) -> [f64; 4] {
    let start = -system.d2_ld(interval) - system.fd_minus(interval);
    let end = system.d4_ld(interval) + system.fd_plus(interval);
    [
        start.x,
        system.d1_ld(interval) + system.gd_minus(interval),
        end.x,
        -system.d3_ld(interval) - system.gd_plus(interval),
    ]
}

/// p_k, E_k, p_{k+1}, E_{k+1} of the double well.
fn well(sample: &Sample) -> [f64; 4] {
    slots(&DoubleWell::default(), &sample.interval)
}

/// The oscillator with a damping so strong that a mistake in it shows.
const OSCILLATOR: DampedOscillator = DampedOscillator { m: 1.0, k: 4.0, c: 0.8 };

/// p_k, E_k, p_{k+1}, E_{k+1} of the oscillator.
fn oscillator(sample: &Sample) -> [f64; 4] {
    slots(&OSCILLATOR, &sample.interval)
}

/// An equation that is printed as it is derived.
const fn agrees(name: &'static str, printed: &'static str, sides: fn(&Sample) -> [f64; 2]) -> Equation {
    Equation { name, printed, derived: "the same", sides }
}

const fn misprint(
    name: &'static str,
    printed: &'static str,
    derived: &'static str,
    sides: fn(&Sample) -> [f64; 2],
) -> Equation {
    Equation { name, printed, derived, sides }
}

/// The equations of the two examples, in the paper's order.
const EQUATIONS: [Equation; 17] = [
    misprint("section 2.4, discrete energy Eₖ", "Eₖ = D₃ L_d", "Eₖ = −D₃ L_d", |s| {
        [DoubleWell::default().d3_ld(&s.interval), well(s)[3]]
    }),
    agrees("double well, L_d", "h [m v²/2 − (q̄⁴ − q̄²)/2]", |s| {
        [s.h * (s.v * s.v / 2.0 - s.potential()), DoubleWell::default().ld(&s.interval)]
    }),
    agrees("double well, pₖ₊₁", "m v + h ((qₖ₊₁ + qₖ)/4 − q̄³)", |s| {
        [s.v + s.h * (s.sum() / 4.0 - s.middle.powi(3)), well(s)[2]]
    }),
    agrees("double well, Eₖ₊₁", "m v²/2 + (q̄⁴ − q̄²)/2", |s| {
        [s.v * s.v / 2.0 + s.potential(), well(s)[3]]
    }),
    agrees("double well, implicit momentum equation", "m v − h ((qₖ₊₁ + qₖ)/4 − q̄³) = pₖ", |s| {
        [s.v - s.h * (s.sum() / 4.0 - s.middle.powi(3)), well(s)[0]]
    }),
    agrees("double well, implicit energy equation", "m v²/2 + (q̄⁴ − q̄²)/2 = Eₖ", |s| {
        [s.v * s.v / 2.0 + s.potential(), well(s)[1]]
    }),
    agrees("double well, F(q, p, h, v)", "m v − h [(v h + 2 q)/4 − (q + v h/2)³] − p", |s| {
        let middle = s.q0() + s.v * s.h / 2.0;
        [s.v - s.h * ((s.v * s.h + 2.0 * s.q0()) / 4.0 - middle.powi(3)), well(s)[0]]
    }),
    agrees("double well, G(q, E, h, v)", "m v²/2 + [(q + v h/2)⁴ − (q + v h/2)²]/2 − E", |s| {
        let middle = s.q0() + s.v * s.h / 2.0;
        [s.v * s.v / 2.0 + (middle.powi(4) - middle.powi(2)) / 2.0, well(s)[1]]
    }),
    agrees("oscillator, f_d±", "−c h v/2", |s| [-OSCILLATOR.c * s.h * s.v / 2.0, OSCILLATOR.fd_plus(&s.interval).x]),
    agrees("oscillator, g_d±", "c h v²/2", |s| {
        [OSCILLATOR.c * s.h * s.v * s.v / 2.0, OSCILLATOR.gd_plus(&s.interval)]
    }),
    agrees("oscillator, pₖ₊₁", "m v − k h (qₖ + qₖ₊₁)/4 − c (qₖ₊₁ − qₖ)/2", |s| {
        [s.v - OSCILLATOR.k * s.h * s.sum() / 4.0 - OSCILLATOR.c * s.way() / 2.0, oscillator(s)[2]]
    }),
    misprint(
        "oscillator, Eₖ₊₁",
        "… − c (qₖ₊₁ − qₖ)²/h",
        "… − (c/2) (qₖ₊₁ − qₖ)²/h",
        |s| [total(s) - OSCILLATOR.c * s.way().powi(2) / s.h, oscillator(s)[3]],
    ),
    misprint(
        "oscillator, implicit momentum equation, first term",
        "m (qₖ₊₁ + qₖ)/h",
        "m (qₖ₊₁ − qₖ)/h",
        |s| [s.sum() / s.h, s.way() / s.h],
    ),
    misprint(
        "oscillator, implicit momentum equation, damping",
        "… − c h (qₖ₊₁ − qₖ)/2",
        "… + c (qₖ₊₁ − qₖ)/2",
        |s| {
            let elastic = s.v + OSCILLATOR.k * s.h * s.sum() / 4.0;
            [elastic - OSCILLATOR.c * s.h * s.way() / 2.0, oscillator(s)[0]]
        },
    ),
    agrees("oscillator, implicit energy equation", "m v²/2 + c h v²/2 + k q̄²/2 = Eₖ", |s| {
        [total(s) + OSCILLATOR.c * s.h * s.v * s.v / 2.0, oscillator(s)[1]]
    }),
    misprint(
        "oscillator, F(q, p, h, v)",
        "m v + (h/4)(2 q + h v) + c h v/2 − p",
        "m v + k (h/4)(2 q + h v) + c h v/2 − p",
        |s| {
            let spring = s.h / 4.0 * (2.0 * s.q0() + s.h * s.v);
            [s.v + spring + OSCILLATOR.c * s.h * s.v / 2.0, oscillator(s)[0]]
        },
    ),
    agrees("oscillator, G(q, E, h, v)", "m v²/2 + c h v²/2 + k (q + h v/2)²/2 − E", |s| {
        let middle = s.q0() + s.h * s.v / 2.0;
        let work = OSCILLATOR.c * s.h * s.v * s.v / 2.0;
        [s.v * s.v / 2.0 + work + OSCILLATOR.k * middle * middle / 2.0, oscillator(s)[1]]
    }),
];

/// `m v²/2 + k q̄²/2`.
fn total(sample: &Sample) -> f64 {
    sample.v * sample.v / 2.0 + OSCILLATOR.k * sample.middle * sample.middle / 2.0
}

/// Formulas that no number of the two examples distinguishes: place, printed form, derived form.
const IN_SYMBOLS: [[&str; 3]; 3] = [
    ["section 3, integrated variation", "f_L and f_L·q̇", "f_L c_t′ and f_L·q̇ c_t′"],
    ["forced time-marching form, Eₖ₊₁", "−D₃ L_d − g_d⁻", "−D₃ L_d − g_d⁺; equal for the midpoint rule"],
    ["Remark 7", "time-dependent systems must be solved for tₖ₊₁", "(v, h) serve every L(t, q, v); t̄ = tₖ + h/2"],
];

impl Equation {
    /// The largest difference of both sides.
    fn difference(&self) -> f64 {
        let difference = |[printed, derived]: [f64; 2]| (printed - derived).abs();
        (0..INTERVALS).map(|index| difference((self.sides)(&Sample::of(index)))).fold(0.0, f64::max)
    }

    fn is_misprint(&self) -> bool {
        self.derived != "the same"
    }
}

/// The section: a table of all equations.
pub(super) fn section(book: &mut Book) {
    book.page.section("The equations");
    book.page.prose(&format!(
        "The compiler derives the integrators of this page from the Lagrangian and the force. So every printed equation of \
         the examples can be checked: both formulas are evaluated on the same {INTERVALS} intervals. \
         <i>v</i> = (<i>q</i><sub><i>k</i>+1</sub> − <i>q<sub>k</sub></i>)/<i>h</i>, \
         <i>q̄</i> = (<i>q<sub>k</sub></i> + <i>q</i><sub><i>k</i>+1</sub>)/2, <i>m</i> = 1."
    ));
    let mut table = Table::new("equations", ["equation", "printed", "derived", "largest difference"]);
    for [name, printed, derived] in IN_SYMBOLS {
        table.row([name, printed, derived, "in symbols"].map(str::to_owned));
        let verdict = if name == "Remark 7" { Verdict::Corrected } else { Verdict::Misprint };
        book.item(name, printed, derived.to_owned(), verdict, "equations");
    }
    for equation in &EQUATIONS {
        let difference = equation.difference();
        let cells = [equation.name, equation.printed, equation.derived].map(str::to_owned);
        let [name, printed, derived] = cells;
        table.row([name, printed, derived, scientific(difference)]);
        let (verdict, holds) = if equation.is_misprint() {
            (Verdict::Misprint, difference > 0.1)
        } else {
            (Verdict::Agrees, difference < ROUNDING)
        };
        let ours = if equation.is_misprint() {
            format!("{}; the printed one is off by up to {}", equation.derived, scientific(difference))
        } else {
            format!("the same; largest difference {}", scientific(difference))
        };
        book.item(equation.name, equation.printed, ours, verdict.when(holds), "equations");
    }
    book.page.table(
        &table,
        "Printed and derived equations. Differences below 10⁻¹⁴ are rounding. A computer algebra system and 50-digit \
         arithmetic confirm the derived ones.",
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn printed_equations_agree_except_the_misprints() {
        let mut worst = 0.0_f64;
        for equation in &EQUATIONS {
            let difference = equation.difference();
            if equation.is_misprint() {
                assert!(difference > 0.1, "{}: {difference}", equation.name);
            } else {
                worst = worst.max(difference);
            }
        }
        // Measured 8.9e-16.
        assert!(worst < ROUNDING, "{worst}");
    }
}
