//! All timed steppers follow the same trajectory: every rival agrees with the generated stepper after 1000 steps.

use vi_benches::contests;

#[test]
fn rivals_agree() {
    for contest in contests::all() {
        for (entry, deviation) in contest.entries.iter().zip(contest.deviations()) {
            assert!(deviation <= entry.bound, "{}, {}: off by {deviation:.2e}", contest.name, entry.name);
        }
    }
}

/// The comparison is one of motions: time passes as it should, and nothing stands still.
#[test]
fn everything_moves() {
    for contest in contests::all() {
        for entry in &contest.entries {
            let [start, end] = [0, 1000].map(|steps| entry.run.run(steps));
            let moved = start[1..].iter().zip(&end[1..]).any(|(start, end)| (end - start).abs() > 1e-2);
            assert!(moved && end[0] > 9.0, "{}, {}: {start:?} to {end:?}", contest.name, entry.name);
        }
    }
}
