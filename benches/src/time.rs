//! Time of a step, in rounds that take turns.
//!
//! In: a contest. Out: nanoseconds per step and the ratio to the generated stepper, as medians with quartiles. In every round
//! each entry runs once from its start, so that a slower machine slows all of them; ratios are taken inside
//! a round. Time is thread time if the system reports it.

use crate::contest::{Contest, Entry};
use std::hint::black_box;
use std::time::Duration;

/// Rounds of a contest.
pub const ROUNDS: usize = 31;
/// Least time of one entry in one round.
const ROUND: Duration = Duration::from_millis(1);
/// Minimum number of steps in one round. The first steps have poor guesses and then have little weight.
const STEPS: usize = 1000;

/// The measured times of one entry.
#[derive(Clone, Debug, PartialEq)]
pub struct Timing {
    /// Nanoseconds per step and trajectory.
    pub nanoseconds: f64,
    /// Lower quartile, median and upper quartile of the time of the generated stepper over this one's.
    pub ratio: [f64; 3],
}

/// The timings of all entries, in their order.
#[must_use]
pub fn contest(contest: &Contest) -> Vec<Timing> {
    let steps: Vec<usize> = contest.entries.iter().map(|entry| enough(|steps| once(entry, steps))).collect();
    let rounds: Vec<Vec<f64>> = (0..ROUNDS)
        .map(|_| contest.entries.iter().zip(&steps).map(|(entry, steps)| once(entry, *steps)).collect())
        .collect();
    (0..contest.entries.len())
        .map(|index| {
            let [_, nanoseconds, _] = quartiles(rounds.iter().map(|round| round[index]).collect());
            Timing { nanoseconds, ratio: quartiles(rounds.iter().map(|round| round[0] / round[index]).collect()) }
        })
        .collect()
}

/// Nanoseconds per step and trajectory of one run.
fn once(entry: &Entry, steps: usize) -> f64 {
    let start = now();
    black_box(entry.run.run(black_box(steps)));
    let count = u32::try_from(steps * entry.trajectories).expect("a round is short");
    now().checked_sub(start).unwrap().as_secs_f64() * 1e9 / f64::from(count)
}

/// Time that this thread has had: on a shared machine the clock on the wall runs for others too.
#[cfg(unix)]
fn now() -> Duration {
    let spent = rustix::time::clock_gettime(rustix::time::ClockId::ThreadCPUTime);
    Duration::try_from(spent).expect("time is not negative")
}

/// Time since the first call.
#[cfg(not(unix))]
fn now() -> Duration {
    static START: std::sync::LazyLock<std::time::Instant> = std::sync::LazyLock::new(std::time::Instant::now);
    START.elapsed()
}

/// Steps that fill a round; the first runs warm up besides.
fn enough(mut nanoseconds: impl FnMut(usize) -> f64) -> usize {
    let mut steps = STEPS;
    loop {
        if nanoseconds(steps) * f64::from(u32::try_from(steps).expect("a round is short")) >= ROUND.as_secs_f64() * 1e9
        {
            return steps;
        }
        steps *= 2;
    }
}

fn quartiles(mut values: Vec<f64>) -> [f64; 3] {
    values.sort_by(f64::total_cmp);
    [1, 2, 3].map(|quarter| values[(values.len() - 1) * quarter / 4])
}

#[cfg(test)]
mod tests {
    use super::quartiles;

    #[test]
    fn quartiles_of_nine() {
        let values = vec![9.0, 1.0, 8.0, 2.0, 7.0, 3.0, 6.0, 4.0, 5.0];
        assert!(quartiles(values).iter().zip([3.0, 5.0, 7.0]).all(|(a, b)| a.to_bits() == f64::to_bits(b)));
    }
}
