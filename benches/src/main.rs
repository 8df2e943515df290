//! Temporary: deviations and times.

fn main() {
    for contest in vi_benches::contests::all() {
        println!("{}", contest.name);
        let deviations = contest.deviations();
        let timings = vi_benches::time::contest(&contest);
        for ((entry, deviation), timing) in contest.entries.iter().zip(deviations).zip(timings) {
            println!("  {:40} {deviation:9.1e} {:9.2} {:?}", entry.name, timing.nanoseconds, timing.ratio);
        }
    }
}
