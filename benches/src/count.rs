//! Instructions of a step, counted by callgrind: unlike times, they repeat exactly.
//!
//! In: this program with the sub-command `run`, in valgrind. Out: the difference between two lengths of a run, so that its
//! start cancels. Valgrind has no AVX-512: a program built for such a machine cannot be counted.

use std::process::Command;

/// Lengths of the two runs, in steps.
const LENGTHS: [u32; 2] = [200, 1200];

/// Instructions per step of an entry, both by their numbers; `None` if valgrind is missing or cannot run this program.
#[must_use]
pub fn instructions(contest: usize, entry: usize) -> Option<f64> {
    let [short, long] = LENGTHS.map(|steps| total(contest, entry, steps));
    Some((long? - short?) / f64::from(LENGTHS[1] - LENGTHS[0]))
}

fn total(contest: usize, entry: usize, steps: u32) -> Option<f64> {
    let program = std::env::current_exe().ok()?;
    let output = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(program)
        .args(["run", &contest.to_string(), &entry.to_string(), &steps.to_string()])
        .output()
        .ok()
        .filter(|output| output.status.success())?;
    let report = String::from_utf8(output.stderr).ok()?;
    collected(&report)
}

/// The number in `==pid== Collected : 123`.
fn collected(report: &str) -> Option<f64> {
    report.lines().find_map(|line| line.split_once("Collected :")?.1.trim().parse().ok())
}

#[cfg(test)]
mod tests {
    use super::collected;

    #[test]
    fn reads_what_callgrind_says() {
        let report = "==12== Events    : Ir\n==12== Collected : 1652327\n==12== \n";
        assert_eq!(collected(report), Some(1_652_327.0));
        assert_eq!(collected("valgrind: the impossible happened"), None);
    }
}
