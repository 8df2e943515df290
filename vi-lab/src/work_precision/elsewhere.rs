//! Runs of an external program, from a file.
//!
//! In: a CSV file with the columns of the table of runs, as `benches/rivals/heyoka_runs.py` writes it. Out: runs of
//! [`Method::Heyoka`], or [`Failure::Input`] with the invalid line. The file name is the name of the system. Equality
//! of initial state, time and machine is not checked.

use super::method::Method;
use super::study::{Point, TimedRun};
use crate::place;
use std::path::Path;
use vi_report::failure::Failure;

/// Names of the columns, as in the table of runs.
const HEAD: &str = "method,setting,error,evaluations,\"seconds, least\",\"seconds, median\",ended";

/// The runs of `system` in a file.
///
/// # Errors
/// [`Failure::Input`] if it has another name or form, or cannot be read.
pub(super) fn runs(path: &Path, system: &str) -> Result<Vec<TimedRun>, Failure> {
    let shown = path.display();
    if path.file_stem().is_none_or(|stem| stem != system) {
        return Err(Failure::Input(format!("the runs of {system} must be in the file {system}.csv, not in {shown}")));
    }
    parse(&place::text(path)?).map_err(|message| Failure::Input(format!("{shown}: {message}")))
}

/// The runs in a text, or the error with its line.
fn parse(text: &str) -> Result<Vec<TimedRun>, String> {
    let mut lines = text.lines();
    if lines.next() != Some(HEAD) {
        return Err(format!("line 1: expected the columns `{HEAD}`"));
    }
    let runs: Result<Vec<TimedRun>, String> = lines.enumerate().map(|(index, line)| run(line, index + 2)).collect();
    runs.and_then(|runs| if runs.is_empty() { Err("it contains no run".to_owned()) } else { Ok(runs) })
}

/// The run of a line.
fn run(line: &str, number: usize) -> Result<TimedRun, String> {
    let wrong = || format!("line {number}: expected a run such as `heyoka,1e-06,4.1e-07,,1.5e-05,1.6e-05,`");
    let ["heyoka", setting, error, _, least, median, ""] = line.split(',').collect::<Vec<_>>()[..] else {
        return Err(wrong());
    };
    let value = |field: &str| {
        let value: Option<f64> = field.parse().ok();
        value.filter(|value| value.is_finite() && *value >= 0.0).ok_or_else(wrong)
    };
    let point = Point { error: value(error)?, evaluations: None, seconds: value(least)?, median: value(median)? };
    Ok(TimedRun { method: Method::Heyoka, setting: value(setting)?, outcome: Ok(point) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_read_and_a_wrong_line_is_named() {
        let found = parse(&format!("{HEAD}\nheyoka,1e-06,4.1e-07,,1.5e-05,1.6e-05,\n")).expect("a run");
        let point = Point { error: 4.1e-7, evaluations: None, seconds: 1.5e-5, median: 1.6e-5 };
        assert!(matches!(&found[..], [TimedRun { method: Method::Heyoka, setting, outcome: Ok(read) }]
            if setting.to_bits() == 1e-6_f64.to_bits() && *read == point));
        for (text, expected) in [
            ("a,b\n".to_owned(), "line 1: expected the columns"),
            (format!("{HEAD}\n"), "it contains no run"),
            (format!("{HEAD}\nheyoka,1e-06,NaN,,1.5e-05,1.6e-05,\n"), "line 2: expected a run such as"),
            (format!("{HEAD}\nDOP853,1e-06,1e-7,,1.5e-05,1.6e-05,\n"), "line 2: expected a run such as"),
        ] {
            let message = parse(&text).expect_err("a wrong file");
            assert!(message.starts_with(expected), "{message}");
        }
    }
}
