//! `vi-lab work-precision SYSTEM`: what an error costs, for every method.
//!
//! In: a system of the catalogue and a folder. Out: in the folder a page `index.html` with four figures (error against
//! time, against evaluations, against the step; energy over a long time), each as SVG and CSV, and tables of all runs. The
//! methods are the fixed step, its compositions of order 4, 6 and 8, Gauss steps, the energy-preserving integrator, and DOP853 of
//! another library in the same run; and heyoka, where a file tells of its runs.
//!
//! | module | what it makes |
//! |---|---|
//! | [`study`] | every run: error, evaluations, seconds |
//! | [`method`] | one run of one method |
//! | [`mod@reference`] | the motion that errors are measured against, and how well it is known |
//! | [`drift`] | the energy over a long time |
//! | [`clock`] | seconds |
//! | [`elsewhere`] | the runs of heyoka, from a file |
//! | [`figures`] | charts, tables, and what they leave out |

mod clock;
mod drift;
mod elsewhere;
mod figures;
mod method;
mod reference;
mod study;

use clap::Args;
use method::Method;
use std::path::PathBuf;
use study::Findings;
use vi_report::catalogue::{Catalogue, kebab, with_rule};
use vi_report::failure::Failure;
use vi_report::html::escape;
use vi_report::input::number;
use vi_report::machine::Machine;
use vi_report::numbers::scientific;
use vi_report::page::{Page, Report};
use vi_report::progress::Progress;
use vi_runs::entry::Entry;

/// `vi-lab work-precision SYSTEM`.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// A system of `vi-lab list` [default: the first system of this program's own]
    system: Option<String>,
    /// Folder for the page, its figures (SVG) and their data (CSV)
    #[arg(long, value_name = "DIR", default_value = "work-precision")]
    out: PathBuf,
    /// Initial coordinates, separated by commas [default: the system's]
    #[arg(long, value_name = "Q,…", value_delimiter = ',', allow_hyphen_values = true, value_parser = number)]
    q: Option<Vec<f64>>,
    /// Initial velocities, separated by commas [default: the system's]
    #[arg(long, value_name = "V,…", value_delimiter = ',', allow_hyphen_values = true, value_parser = number)]
    v: Option<Vec<f64>>,
    /// Runs of heyoka to show beside the others: SYSTEM.csv, as benches/rivals/heyoka_runs.py writes it
    #[arg(long, value_name = "FILE")]
    rival: Option<PathBuf>,
    /// Fewer and shorter runs, each timed once: for a look, not for numbers
    #[arg(long)]
    quick: bool,
}

/// Makes the page and its files, and returns the price of an error as text, and where the page is.
///
/// # Errors
/// [`Failure::Input`] for a system that does not exist, whose motion cannot be followed, or on which no method can be compared, [`Failure::File`] where a file
/// cannot be written.
pub(crate) fn write(arguments: &Arguments, catalogue: &Catalogue) -> Result<String, Failure> {
    let machine = Machine::here();
    let entry = with_rule(entry(arguments, catalogue)?, "work-precision")?;
    let name = kebab(entry.system.name());
    let told = arguments.rival.as_deref().map(|file| elsewhere::runs(file, &name)).transpose()?;
    let page = Page::new(&format!("What an error costs: {name}"), entry.about);
    let mut report = Report::new(&arguments.out, page)?;
    let mut progress = Progress::new(study::length(&entry, arguments.quick));
    let mut found = study::findings(&entry, arguments.quick, &mut progress)
        .map_err(|ended| Failure::Input(format!("the motion of {name} cannot be followed: {ended}")))?;
    drop(progress);
    found.runs.extend(told.into_iter().flatten());
    introduction(&mut report, &entry, &found);
    work(&mut report, &name, &found)?;
    order(&mut report, &name, &found)?;
    energy(&mut report, &name, &found)?;
    report.section("Every run");
    let missing = found.missing();
    report.prose(&if missing.is_empty() {
        "No run ended early, and none lost the motion.".to_owned()
    } else {
        format!("What the figures do not show. {}", escape(&missing.join(" ")))
    });
    report.table(&found.run_table(), "All runs, coarse to fine; the setting is a step, or the tolerance of DOP853.")?;
    let page = report.finish(&machine)?;
    match found.uncompared() {
        None => Ok(format!("{}\n{}", found.prices().text(), page.display())),
        Some(why) => Err(Failure::Input(format!(
            "on {name} no run has an error to compare: {why}\n{} has all runs",
            page.display()
        ))),
    }
}

/// The entry of the system, with the start that is asked for.
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
    report.section("What is compared");
    report.prose(&format!(
        "The system starts at q = {:?}, v = {:?}{}. The <i>error</i> is taken at t = {}: the largest difference of a \
         coordinate or a momentum from the reference, relative to the largest coordinate, or momentum, on the way. The \
         energy-preserving integrator chooses its nodes; its error is that of its first node from there on, against the \
         reference at the time of that node.",
        entry.q,
        entry.v,
        if parameters.is_empty() { String::new() } else { format!(", with {}", parameters.join(", ")) },
        found.until
    ));
    let agreement = found.agreement;
    report.prose(&format!(
        "The reference is extrapolation of the modified midpoint rule, which is not in the comparison. At the end Kahan and \
         Li’s composition of order 8 with h = {} differs from it by {}, and DOP853 at a tolerance of {} by {}. Errors below \
         the larger of the two say nothing: it is the dotted line in the figures.",
        agreement.h,
        scientific(agreement.composed),
        scientific(reference::TOLERANCE),
        scientific(agreement.rival)
    ));
    report.prose(
        "DOP853 is that of the crate <code>differential-equations</code> 0.7, with the same tolerance relative and absolute. \
         It is given the acceleration that was generated for the system, and states on the stack. This library makes dense \
         output in every step: 15 evaluations, of which 12 would do.",
    );
}

fn work(report: &mut Report, name: &str, found: &Findings) -> Result<(), Failure> {
    report.section("Error against work");
    if found.methods().any(|method| method == Method::Heyoka) {
        report.prose(
            "The runs of heyoka are those that a file tells of: of the same system, start and time if the file is right, on the clock \
             on the wall, and on whatever machine it was made.",
        );
    }
    report.figure(
        &found.time(name).figure(),
        "Best is the lower left. Each marker is the fastest of the repetitions of a run, its whisker ends at the median. \
         Runs of all methods take turns.",
    )?;
    report.prose(&found.winners());
    report.table(
        &found.prices(),
        "The least time of a run whose error is at most so large; none reaches it where there is a dash.",
    )?;
    report.figure(
        &found.evaluations(name).figure(),
        "The same runs by a measure that repeats exactly. One evaluation is one residual with its Jacobian, one \
         residual with the gain of the step, the equations at one stage of a sweep of Gauss steps, or one acceleration: an acceleration is the cheapest of them with few degrees of freedom, and with many has \
         a linear system to solve too.",
    )
}

fn order(report: &mut Report, name: &str, found: &Findings) -> Result<(), Failure> {
    report.section("Order");
    report.figure(
        &found.orders(name).figure(),
        "The number in the legend is the slope over the four finest steps whose error is below 10<sup>−2</sup> and stands \
         30 times above the reference’s own; there is none where fewer are left. DOP853 has no given step.",
    )
}

fn energy(report: &mut Report, name: &str, found: &Findings) -> Result<(), Failure> {
    report.section("Energy over a long time");
    let compared = if found.conserved {
        "The energy is conserved, and is compared with that of the start."
    } else {
        "The energy is not conserved here, and is compared with that of the reference at the same time, over no longer a \
         time than the reference is known for."
    };
    report.figure(
        &found.energy(name).figure(),
        &format!(
            "Largest energy error so far, up to t = {}. {compared} Parts of composed steps have the same length on average \
             as the fixed step. The energy is <i>H</i> at the nodes; for the energy-preserving integrator <i>H</i> in the \
             middles of its steps, where its rule preserves it (at its nodes <i>H</i> swings by <i>h</i>²<i>D</i>/8).",
            found.long
        ),
    )?;
    report.table(
        &found.drift_table(),
        "The same in numbers. The power of t is fitted over the last hundredfold of the time: 0 is an error that stays, 1/2 \
         that of random rounding, 1 a steady drift.",
    )
}
