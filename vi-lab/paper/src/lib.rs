//! The commands `paper` and `vi-lab paper`: the numerical study of the paper (section 5), run again.
//!
//! In: the length of the long runs, and a folder. Out: in the folder a page `index.html`, and for every figure and
//! table an SVG and a CSV file; as text, a comparison of each figure, equation and number of the paper. The run
//! computes every number of the page, except those that the paper prints or the theory states.
//!
//! Source: Sharma, Patil, Woolsey, *Energy-preserving Variational Integrators for Forced Lagrangian Systems*.

mod book;
mod conservative;
mod equations;
mod forced;
mod law;
mod raw;

use book::Book;
use clap::Parser;
use std::path::PathBuf;
use vi_core::StepError;
use vi_report::failure::Failure;
use vi_report::input::count;
use vi_report::progress::Progress;

/// Steps of the long runs.
const STEPS: u32 = 1_000_000;
/// Smallest number of steps of the long runs.
const SHORTEST: u32 = 1000;

/// Makes every figure and table of the paper's numerical study, with this project's numbers beside the paper's
#[derive(Clone, Debug, Parser)]
#[command(name = "paper", version, max_term_width = 100)]
pub struct Study {
    /// Folder for the page, its figures (SVG) and their data (CSV)
    #[arg(long, value_name = "DIR", default_value = "paper")]
    out: PathBuf,
    /// Length of the long runs
    #[arg(long, value_name = "N", default_value_t = STEPS, value_parser = steps)]
    steps: u32,
}

/// The number of steps that a user writes.
///
/// # Errors
/// The allowed values, if the text is not such a number.
fn steps(text: &str) -> Result<u32, String> {
    let steps = u32::try_from(count(text)?).ok().filter(|steps| *steps >= SHORTEST);
    steps.ok_or_else(|| format!("the study needs {SHORTEST} to {} steps", u32::MAX))
}

/// Makes the page and its files, and returns the summary.
///
/// # Errors
/// [`Failure::File`] if a file cannot be written, [`Failure::Step`] if a step fails that the study needs.
pub fn write(study: &Study) -> Result<String, Failure> {
    let mut book = Book::new(&study.out)?;
    {
        // The two long runs of each of the four cases take most of the time.
        let mut progress = Progress::new(8 * u64::from(study.steps));
        introduction(&mut book, study);
        equations::section(&mut book);
        conservative::chapter(&mut book, study, &mut progress)?;
        forced::chapter(&mut book, &mut progress)?;
        progress.message("step law");
        law::section(&mut book)?;
    }
    book.finish()
}

/// The failure of a step that the study needs.
fn unexpected(what: &str) -> impl Fn(StepError) -> Failure {
    let before = what.to_owned();
    move |error| Failure::Step { error: Box::new(error), before: before.clone(), advice: None }
}

fn introduction(book: &mut Book, study: &Study) {
    book.page.prose(
        "The paper derives variational integrators for forced Lagrangian systems in which time is a discrete variable: one step \
         solves the momentum equation and the energy equation together and so finds its own length. It then studies two examples \
         numerically. This page runs both again. The integrators are generated from ten lines that state the Lagrangian and the force.",
    );
    book.page.prose(&format!(
        "The long runs have {} steps. Colours mean the same everywhere: <b style=\"color:#D55E00\">energy-preserving</b>, \
         <b style=\"color:#0072B2\">fixed step</b>. Each figure links to its SVG and to the points that it shows as CSV.",
        study.steps
    ));
    book.page.section("The paper, item by item");
    book.page.prose(
        "The table lists figures by their content. The revised text of the study is chapter 3 of H. Sharma’s dissertation \
         <i>Structure-preserving Numerical Methods for Engineering Applications</i> (Virginia Tech, 2020); printed magnitudes and \
         sentences are compared with it too. Every number of the column “this run” was computed for this page.",
    );
    book.items();
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn a_small_study_makes_every_file_and_agrees_with_the_paper() {
        let folder = std::env::temp_dir().join(format!("vi-lab-paper-{}", std::process::id()));
        let study = Study { out: folder.clone(), steps: 3000 };
        let summary = write(&study).unwrap_or_else(|failure| panic!("{failure}"));
        assert!(!summary.contains("does not agree"), "{summary}");
        let page = fs::read_to_string(folder.join("index.html")).expect("the page");
        let files: Vec<String> =
            page.split("href=\"").skip(1).filter_map(|rest| rest.split('"').next()).map(String::from).collect();
        let named: Vec<&String> = files.iter().filter(|name| !name.starts_with('#')).collect();
        // 26 figures in two forms, 9 tables.
        assert_eq!(named.len(), 2 * 26 + 9);
        for target in files.iter().filter_map(|name| name.strip_prefix('#')) {
            assert!(page.contains(&format!("id=\"{target}\"")), "no part of the page is named {target}");
        }
        for name in named {
            let length = fs::metadata(folder.join(name)).map_or(0, |file| file.len());
            assert!(length > 100, "{name} has {length} bytes");
        }
        assert!(!page.contains("NaN") && !page.contains("inf,"), "a number of the page is not finite");
        fs::remove_dir_all(&folder).expect("the folder can be removed");
    }
}
