//! `vi-lab paper`: the numerical study of the paper (section 5), run again.
//!
//! In: how long the long runs are, and a folder. Out: in the folder a page `index.html`, and for every figure and table
//! an SVG and a CSV file; as text, what each claim of the paper became. Every number of the page is computed in the run,
//! except those that the paper or the theory states.
//!
//! Source: Sharma, Patil, Woolsey, *Energy-preserving Variational Integrators for Forced Lagrangian Systems*.

mod book;
mod conservative;
mod errata;
mod forced;
mod law;
mod numbers;
mod raw;

use super::failure::Failure;
use super::machine::Machine;
use super::progress::Progress;
use book::Book;
use std::path::Path;
use vi_core::StepError;

/// Steps of the paper's long runs.
pub(crate) const STEPS: u32 = 1_000_000;

/// How large the study is.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Study {
    /// Steps of the long runs.
    pub(crate) steps: u32,
}

/// Makes the page and its files in `out`, and returns the summary.
///
/// # Errors
/// [`Failure::File`] where a file cannot be written, [`Failure::Step`] where a step fails that must not.
pub(crate) fn write(out: &Path, study: Study) -> Result<String, Failure> {
    let machine = Machine::here();
    let mut book = Book::new(out)?;
    {
        // Two long runs of each of the four cases make almost all of the work.
        let mut progress = Progress::new(8 * u64::from(study.steps));
        introduction(&mut book, study);
        conservative::chapter(&mut book, study, &mut progress)?;
        forced::chapter(&mut book, &mut progress)?;
        progress.message("step law");
        law::section(&mut book)?;
        errata::section(&mut book)?;
    }
    book.finish(&machine)
}

/// A step that failed where the study needs one.
fn unexpected(what: &str) -> impl Fn(StepError) -> Failure {
    let before = what.to_owned();
    move |error| Failure::Step { error, before: before.clone() }
}

fn introduction(book: &mut Book, study: Study) {
    book.prose(
        "The paper derives variational integrators for forced Lagrangian systems in which time is a discrete variable of \
         its own: one step solves the momentum equation and the energy equation together, and so finds its own length. \
         It then studies two examples numerically. Here both are run again, with integrators generated from ten lines \
         that state the Lagrangian and the force. Wherever the paper makes a claim, its number stands beside ours; where \
         the two differ, the reason is given.",
    );
    let millions = if study.steps == STEPS {
        "The long runs have a million steps, as in the paper.".to_owned()
    } else {
        format!("The long runs of this page have {} steps; the paper's have a million.", study.steps)
    };
    book.prose(&format!(
        "{millions} Colours mean the same everywhere: <b style=\"color:#D55E00\">energy-preserving</b>, \
         <b style=\"color:#0072B2\">fixed step</b>. Each figure comes as SVG, with the points that it shows \
         as CSV. The claims one by one are in the <a href=\"#claims\">last table</a>."
    ));
}
