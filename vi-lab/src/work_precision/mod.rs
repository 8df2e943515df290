//! `vi-lab work-precision SYSTEM`: error against work, for every method.
//!
//! In: a predefined system and a folder. Out: in the folder a page `index.html` with three figures (error against time,
//! against evaluations, against the step), each as SVG and CSV, and tables of all runs. The methods are the fixed step,
//! its compositions of order 4, 6 and 8, splittings, Gauss methods with equal and with adaptive steps, the
//! energy-preserving integrator, and DOP853 of another library.
//!
//! | module | product |
//! |---|---|
//! | [`study`] | every run: error, evaluations, seconds |
//! | [`method`] | one run of one method |
//! | [`mod@reference`] | the reference solution, and its accuracy |
//! | [`figures`] | charts, tables, and the runs that charts omit |

mod figures;
mod method;
mod reference;
mod study;

use clap::Args;
use std::path::PathBuf;
use study::Findings;
use vi_report::catalogue::{Catalogue, kebab, with_rule};
use vi_report::entry::Entry;
use vi_report::failure::Failure;
use vi_report::html::escape;
use vi_report::input::number;
use vi_report::numbers::scientific;
use vi_report::page::Report;

/// `vi-lab work-precision SYSTEM`.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// A system of `vi-lab list` [default: the first system of this program]
    system: Option<String>,
    /// Folder for the page, its figures (SVG) and their data (CSV)
    #[arg(long, value_name = "DIR", default_value = "work-precision")]
    out: PathBuf,
    /// Initial coordinates, separated by commas [default: those of the system]
    #[arg(long, value_name = "Q,…", value_delimiter = ',', allow_hyphen_values = true, value_parser = number)]
    q: Option<Vec<f64>>,
    /// Initial velocities, separated by commas [default: those of the system]
    #[arg(long, value_name = "V,…", value_delimiter = ',', allow_hyphen_values = true, value_parser = number)]
    v: Option<Vec<f64>>,
    /// Fewer and shorter runs, each timed once: for a preview, not for numbers
    #[arg(long)]
    quick: bool,
}

/// Writes the page and its files; returns the table of times as text, and the path of the page.
///
/// # Errors
/// [`Failure::Input`] for an unknown system, a motion that cannot be computed, or if no method can be compared.
/// [`Failure::File`] if a file cannot be written.
pub(crate) fn write(arguments: &Arguments, catalogue: &Catalogue) -> Result<String, Failure> {
    let entry = with_rule(entry(arguments, catalogue)?, "work-precision")?;
    let name = kebab(entry.name);
    let mut report = Report::new(&arguments.out, &format!("Error against work: {name}"), entry.about)?;
    let found = study::findings(&entry, arguments.quick)
        .map_err(|ended| Failure::Input(format!("the motion of {name} cannot be computed: {ended}")))?;
    introduction(&mut report, &entry, &found);
    work(&mut report, &name, &found);
    order(&mut report, &name, &found);
    report.section("Every run");
    let missing = found.missing();
    report.prose(&if missing.is_empty() {
        "No run ended early, and none has an error above 2.".to_owned()
    } else {
        format!("Runs that the figures omit. {}", escape(&missing.join(" ")))
    });
    report.table(&found.run_table(), "All runs, coarse to fine; the setting is a step, of the energy-preserving integrator the first one, or the tolerance of adaptive steps and of DOP853.");
    let page = report.finish()?;
    match found.uncompared() {
        None => Ok(format!("{}\n{}", found.prices().text(), page.display())),
        Some(why) => Err(Failure::Input(format!(
            "{name} has no run with an error to compare: {why}\n{} has all runs",
            page.display()
        ))),
    }
}

/// The entry of the system, with the requested initial state.
fn entry(arguments: &Arguments, catalogue: &Catalogue) -> Result<Entry, Failure> {
    let entry = catalogue.named(arguments.system.as_deref())?;
    let q = arguments.q.clone().unwrap_or(entry.q);
    let v = arguments.v.clone().unwrap_or(entry.v);
    for (what, values) in [("coordinates (--q)", &q), ("velocities (--v)", &v)] {
        let size = entry.system.coordinates().len();
        if values.len() != size || !values.iter().all(|value| value.is_finite()) {
            return Err(Failure::Input(format!("give {size} finite {what}, not {values:?}")));
        }
    }
    Ok(Entry { q, v, ..entry })
}

fn introduction(report: &mut Report, entry: &Entry, found: &Findings) {
    let parameters: Vec<String> =
        entry.system.parameters().iter().map(|(name, value)| format!("{name} = {value}")).collect();
    report.section("Comparison");
    report.prose(&format!(
        "The system starts at q = {:?}, v = {:?}{}. The <i>error</i> is taken at t = {}: the largest difference of a \
         coordinate or a momentum from the reference, relative to the largest coordinate or momentum along the solution. The \
         energy-preserving integrator and adaptive Gauss steps choose their nodes. Their error is taken at the first node at \
         or after this time, relative to the reference at that node. The time of adaptive Gauss steps is that of the steps, \
         without the search of the first one.",
        entry.q,
        entry.v,
        if parameters.is_empty() { String::new() } else { format!(", with {}", parameters.join(", ")) },
        found.until
    ));
    let agreement = found.agreement;
    report.prose(&format!(
        "The reference is extrapolation of the modified midpoint rule, which is not in the comparison. At the end Kahan and \
         Li’s composition of order 8 with h = {} differs from it by {}, and DOP853 at a tolerance of {} by {}. Errors below \
         the larger of the two are not resolved: the dotted line in the figures.",
        agreement.h,
        scientific(agreement.composed),
        scientific(reference::TOLERANCE),
        scientific(agreement.rival)
    ));
    report.prose(
        "DOP853 is that of the crate <code>differential-equations</code> 0.7, with the same tolerance relative and absolute. \
         It uses the generated acceleration of the system, and states on the stack. It computes dense \
         output in every step: 15 evaluations instead of 12.",
    );
}

fn work(report: &mut Report, name: &str, found: &Findings) {
    report.section("Error against work");
    report.figure(
        found.time(name).figure(),
        "The lower left is best. Each marker is the fastest repetition of a run; its whisker ends at the median. \
         Runs of all methods alternate.",
    );
    report.table(&found.prices(), "The least time of a run with at most this error; a dash if no run reaches it.");
    report.figure(
        found.evaluations(name).figure(),
        "The same runs by a measure that repeats exactly. One evaluation is one residual with its Jacobian, one \
         residual with the increment of the step, the equations at one stage of a Gauss iteration, or one acceleration. An acceleration is the cheapest of these for few degrees of freedom; for many it requires \
         the solution of a linear system.",
    );
}

fn order(report: &mut Report, name: &str, found: &Findings) {
    report.section("Order");
    report.figure(
        found.orders(name).figure(),
        "The number in the legend is the slope over the four finest steps whose error is below 10<sup>−2</sup> and at least \
         30 times that of the reference; it is absent for fewer than four. DOP853 has no given step.",
    );
}
