//! Runs that end at a given time.

use super::{assert_refused, bits, lab, path, rows, success, temporary};
use std::fs;

/// The rows of a run of the harmonic oscillator with ω = 1 from (1, 0).
fn oscillator(options: &[&str]) -> Vec<Vec<f64>> {
    let run = ["run", "harmonic-oscillator", "--set", "m=1", "--set", "k=1", "--q", "1", "--v", "0"];
    let csv = success(&[run.as_slice(), options].concat());
    rows(&csv)
}

#[test]
fn a_run_ends_at_the_time_that_is_asked_for() {
    // Each with the error of its last coordinate: measured 5.7e-3, 5.7e-6, 4.3e-8, 1.6e-11, 2.0e-12, 0, 1.2e-2, 5.7e-3,
    // 8.5e-6, 5.5e-9.
    for (method, tolerance) in [
        ("fixed", 6e-3),
        ("suzuki-4", 6e-6),
        ("kahan-li-6", 5e-8),
        ("kahan-li-8", 2e-11),
        ("splitting-4", 1e-5),
        ("splitting-6", 1e-8),
        ("gauss --stages 4", 3e-12),
        ("gauss", 5e-16),
        ("energy", 1.3e-2),
        ("energy --stages 1", 6e-3),
        ("energy --stages 2", 9e-6),
        ("energy --stages 3", 6e-9),
    ] {
        let method: Vec<&str> = ["--method"].into_iter().chain(method.split(' ')).collect();
        for [h, until] in [["0.3", "1"], ["-0.3", "-1"]] {
            if method.contains(&"energy") && h.starts_with('-') {
                continue;
            }
            let rows = oscillator(&[method.as_slice(), &["--h", h, "--until", until]].concat());
            let [.., before, last] = &rows[..] else { panic!("{method:?}: {rows:?}") };
            let end: f64 = until.parse().expect("a number");
            assert_eq!(last[0].to_bits(), end.to_bits(), "{method:?}: {last:?}");
            // The last step is shortened, and its interval differs from the others.
            assert!((last[5] - (end - before[0])).abs() < 1e-15 && last[5].abs() < 0.3, "{method:?}: {last:?}");
            assert!(last[4].is_nan(), "{method:?}: {last:?}");
            let error = (last[1] - end.cos()).abs();
            assert!(error < tolerance, "{method:?}: {error:e}");
        }
    }
}

#[test]
fn steps_that_lead_to_the_end_are_those_of_the_run() {
    for method in ["fixed", "gauss", "kahan-li-6"] {
        let until = oscillator(&["--method", method, "--h", "0.1", "--until", "1"]);
        let steps = oscillator(&["--method", method, "--h", "0.1", "--steps", "10"]);
        // Except for the time, which rounding may have changed by an ulp.
        let without_time = |rows: &[Vec<f64>]| rows.iter().map(|row| row[1..].to_vec()).collect::<Vec<_>>();
        assert_eq!(bits(&without_time(&until)), bits(&without_time(&steps)), "{method}");
        let [.., last] = &until[..] else { panic!("{until:?}") };
        assert_eq!((until.len(), last[0].to_bits()), (11, 1.0_f64.to_bits()));
    }
}

#[test]
fn the_last_row_is_the_end_whatever_every_says() {
    let rows = oscillator(&["--method", "gauss", "--h", "0.3", "--until", "1", "--every", "3"]);
    let times: Vec<f64> = rows.iter().map(|row| row[0]).collect();
    // 0.9 is three steps up to rounding.
    assert!(times.len() == 3 && (times[1] - 0.9).abs() < 2e-16 && times[2].to_bits() == 1.0_f64.to_bits(), "{times:?}");
    // Steps in transformed time.
    let run = ["run", "kepler", "--method", "gauss", "--dtau", "0.3", "--until", "1"];
    let csv = success(&run);
    let rows = super::rows(&csv);
    let [.., before, last] = &rows[..] else { panic!("{csv}") };
    assert_eq!(last[0].to_bits(), 1.0_f64.to_bits());
    // With short steps in time: measured 4.4e-16.
    let (_, csv, _) = lab(&["run", "kepler", "--method", "gauss", "--h", "0.01", "--until", "1"]);
    let exact = super::rows(&csv).pop().expect("rows");
    let error = (1..5).map(|column| (last[column] - exact[column]).abs()).fold(0.0, f64::max);
    assert!(error < 1e-15 && before[0] < 1.0, "{error:e}");
}

#[test]
fn a_sweep_ends_its_runs_as_a_run_does() {
    let folder = temporary("ends");
    fs::create_dir(&folder).expect("a new folder");
    let scene = folder.join("scene.toml");
    let text = "system = \"kepler\"\nmethod = \"gauss\"\nh = 0.3\nuntil = 1.0\n[sweep]\n\
                over = [{ name = \"mu\", values = [1.0, 2.0] }]\nkeep = [\"end\"]\n";
    fs::write(&scene, text).expect("the scene");
    let output = folder.join("ends.csv");
    success(&["sweep", path(&scene), "-o", path(&output)]);
    let ends = rows(&fs::read_to_string(&output).expect("the table"));
    for (item, end) in ends.iter().enumerate() {
        let (_, csv, _) = lab(&["run", path(&scene), "--item", &item.to_string()]);
        let last = rows(&csv).pop().expect("rows");
        assert_eq!(bits(&[end[2..].to_vec()]), bits(&[last]), "{item}");
        assert_eq!(end[2].to_bits(), 1.0_f64.to_bits());
    }
    fs::remove_dir_all(folder).expect("the folder can be removed");
}

#[test]
fn an_end_before_the_first_node_is_refused() {
    assert_refused(&[(
        &["run", "kepler", "--method", "energy", "--start", "midpoint", "--h", "0.01", "--until", "0.001"],
        "the first node, at t = 0.005, is after --until",
    )]);
}
