//! The tables of `docs/benchmarks.md`.
//!
//! In: what was measured. Out: one table, which takes the place of the last one between its two markers; the
//! text around is written by hand.

use crate::contest::{Contest, Target};
use crate::time::Timing;
use std::fmt::Write;

/// The measurements of a contest, entry by entry.
pub struct Measured<'a> {
    /// The contest.
    pub contest: &'a Contest,
    /// The timings of its entries.
    pub timings: Vec<Timing>,
    /// Instructions per step and trajectory, if they could be counted.
    pub instructions: Vec<Option<f64>>,
}

/// The table.
#[must_use]
pub fn table(measured: &[Measured<'_>]) -> String {
    let mut table = String::from(
        "| stepper | ns a step | generated takes | quartiles | target | | instructions |\n|---|---|---|---|---|---|---|\n",
    );
    for Measured { contest, timings, instructions } in measured {
        let _ = writeln!(table, "| **{}** | | | | | | |", contest.name);
        for ((entry, timing), count) in contest.entries.iter().zip(timings).zip(instructions) {
            let [lower, median, upper] = timing.ratio;
            let (target, reached) = judged(entry.target, median);
            let count = count.map_or("–".to_owned(), |count| format!("{count:.0}"));
            let time = significant(timing.nanoseconds);
            let ratios = format!("{} | {} … {}", ratio(median), ratio(lower), ratio(upper));
            let ratios = if entry.name == contest.entries[0].name { "1 |".to_owned() } else { ratios };
            let _ = writeln!(table, "| {} | {time} | {ratios} | {target} | {reached} | {count} |", entry.name);
        }
    }
    table
}

/// Time of the generated stepper per degree of freedom: the longer chain over the shorter one.
#[must_use]
pub fn growth(measured: &[Measured<'_>], [short, long]: [(&str, f64); 2]) -> Option<f64> {
    let per_mass = |(name, masses): (&str, f64)| {
        let found = measured.iter().find(|measured| measured.contest.name.starts_with(name))?;
        Some(found.timings[0].nanoseconds / masses)
    };
    Some(per_mass(long)? / per_mass(short)?)
}

/// `text` with `section` between the markers of this name; `None` if it has no such markers.
#[must_use]
pub fn replaced(text: &str, name: &str, section: &str) -> Option<String> {
    let (begin, end) = (format!("<!-- {name}: begin -->\n"), format!("<!-- {name}: end -->"));
    let (before, rest) = text.split_once(&begin)?;
    let (_, after) = rest.split_once(&end)?;
    Some(format!("{before}{begin}{section}{end}{after}"))
}

/// The target in words, and whether it is reached.
fn judged(target: Target, ratio: f64) -> (String, &'static str) {
    let (text, reached) = match target {
        Target::AtMost(factor) => (format!("≤ {factor}"), ratio <= factor),
        Target::Faster(factor) => (format!("≤ 1/{factor}"), ratio * factor <= 1.0),
        Target::Slower(factor) => (format!("≥ {factor}"), ratio >= factor),
        Target::Costs(factor) => (format!("≥ 1/{factor}"), ratio * factor >= 1.0),
        Target::None => return (String::new(), ""),
    };
    (text, if reached { "yes" } else { "no" })
}

/// 1.23, or 1/4.5.
fn ratio(ratio: f64) -> String {
    if ratio >= 0.95 { significant(ratio) } else { format!("1/{}", significant(1.0 / ratio)) }
}

/// Three digits.
fn significant(value: f64) -> String {
    match value {
        value if value < 10.0 => format!("{value:.2}"),
        value if value < 100.0 => format!("{value:.1}"),
        value => format!("{value:.0}"),
    }
}

#[cfg(test)]
mod tests {
    use super::{judged, ratio, replaced};
    use crate::contest::Target;

    #[test]
    fn a_section_takes_the_place_of_the_last_one() {
        let text = "a\n<!-- x: begin -->\nold\n<!-- x: end -->\nb\n";
        let new = "a\n<!-- x: begin -->\nnew\n<!-- x: end -->\nb\n";
        assert_eq!(replaced(text, "x", "new\n").as_deref(), Some(new));
        assert_eq!(replaced(text, "y", "new\n"), None);
    }

    #[test]
    fn targets_are_judged() {
        assert_eq!(judged(Target::AtMost(1.05), 1.06), ("≤ 1.05".to_owned(), "no"));
        assert_eq!(judged(Target::Faster(3.0), 0.33), ("≤ 1/3".to_owned(), "yes"));
        assert_eq!(judged(Target::Slower(8.0), 7.9), ("≥ 8".to_owned(), "no"));
        assert_eq!(judged(Target::Costs(3.0), 0.34), ("≥ 1/3".to_owned(), "yes"));
        assert_eq!([ratio(1.5), ratio(0.25)], ["1.50", "1/4.00"]);
    }
}
