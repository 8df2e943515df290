//! The command `vi-lab` as a user sees it: output, exit status, messages, files.

#[path = "command/ends.rs"]
mod ends;
#[cfg(unix)]
#[path = "command/hostile.rs"]
mod hostile;
#[path = "command/models.rs"]
mod models;
#[path = "command/sweep.rs"]
mod sweep;
#[path = "command/texts.rs"]
mod texts;

use std::fs;
use std::io::{BufRead as _, BufReader, Read as _};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output, Stdio};

/// Runs the command, and returns exit status, standard output, and standard error without the error of steps.
fn lab(arguments: &[&str]) -> (Option<i32>, String, String) {
    let Output { status, stdout, stderr } =
        Command::new(env!("CARGO_BIN_EXE_vi-lab")).args(arguments).output().expect("the command runs");
    let text = |bytes| String::from_utf8(bytes).expect("text");
    let is_other = |line: &&str| {
        !line.contains("the largest error of a step is") && !line.contains("for its error to be measured")
    };
    let errors = text(stderr).split_inclusive('\n').filter(is_other).collect();
    (status.code(), text(stdout), errors)
}

/// Standard output of a command that succeeds without a message.
fn success(arguments: &[&str]) -> String {
    let (status, output, errors) = lab(arguments);
    assert_eq!((status, errors.as_str()), (Some(0), ""), "{arguments:?}");
    output
}

/// A file of this test in the temporary folder.
fn temporary(name: &str) -> PathBuf {
    std::env::temp_dir().join(format!("vi-lab-{}-{name}", std::process::id()))
}

/// Asserts that the command rejects arguments with a message on one line, and status 2.
fn assert_refused(cases: &[(&[&str], &str)]) {
    for (arguments, message) in cases {
        let (status, output, errors) = lab(arguments);
        assert_eq!((status, output.as_str()), (Some(2), ""), "{arguments:?}");
        assert_eq!(errors, format!("error: {message}\n"), "{arguments:?}");
    }
}

/// Starts the command with piped outputs.
fn start(arguments: &[&str]) -> Child {
    let mut command = Command::new(env!("CARGO_BIN_EXE_vi-lab"));
    command.args(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("the command starts")
}

/// Sends a signal to a command.
#[cfg(unix)]
fn send(signal: &str, child: &Child) {
    let status = Command::new("kill").args([signal, &child.id().to_string()]).status().expect("kill runs");
    assert!(status.success());
}

/// The lines of a CSV file without comments and head as numbers; an empty entry is NaN.
fn rows(csv: &str) -> Vec<Vec<f64>> {
    let lines = csv.lines().filter(|line| !line.starts_with('#')).skip(1);
    let number = |text: &str| if text.is_empty() { f64::NAN } else { text.parse().expect("a number") };
    lines.map(|line| line.split(',').map(number).collect()).collect()
}

/// Numbers as bits, so that NaN equals NaN.
fn bits(rows: &[Vec<f64>]) -> Vec<Vec<u64>> {
    rows.iter().map(|row| row.iter().map(|number| number.to_bits()).collect()).collect()
}

fn path(path: &Path) -> &str {
    path.to_str().expect("a path of text")
}

#[test]
fn exponents_of_chaos_and_of_an_oscillation() {
    let text = success(&["lyapunov", "double-well-duffing", "--set", "amplitude=0.5", "--steps", "5000"]);
    let last = rows(&text).pop().expect("a row");
    // The sum is minus the damping, 0.3, to the printed digits.
    assert!(last[1] > 0.05 && (last[1] + last[2] + 0.3).abs() < 2e-6, "{text}");
    assert!(text.starts_with("t,λ1,λ2\n5,"), "{text}");
    let (_, text, _) = lab(&["lyapunov", "pendulum", "--count", "1", "--steps", "5000"]);
    let last = rows(&text).pop().expect("a row");
    assert!(last[1].abs() < 0.05, "{text}");
    assert_refused(&[
        (&["lyapunov", "kepler", "--count", "5"], "kepler has 1 to 4 exponents (--count), not 5"),
        (&["lyapunov"], "name a system of `vi-lab list`"),
    ]);
}

#[test]
fn the_list_names_every_system_with_its_parameters() {
    let list = success(&["list"]);
    for name in [SYSTEMS, WITH_CONSTRAINTS].iter().flat_map(|names| names.split(' ')) {
        assert!(list.contains(name), "{name} is missing");
    }
    assert!(list.contains("m = 1, k = 4, c = 0.04"), "{list}");
}

/// The names of all predefined systems.
const SYSTEMS: &str = "double-well damped-oscillator pendulum kepler double-pendulum harmonic-oscillator hard-duffing \
                       double-well-duffing parametric-pendulum rotating-hoop spherical-pendulum henon-heiles \
                       charged-particle n-pendulum three-body fpu-chain outer-solar-system";

/// The names of all predefined systems with constraints.
const WITH_CONSTRAINTS: &str = "rod-pendulum double-rod-pendulum rod-chain four-bar slider-crank andrews-squeezer heavy-top \
                                chaplygin-sleigh rolling-disk rolling-ball";

#[test]
fn every_system_with_constraints_runs_and_is_explained() {
    for name in WITH_CONSTRAINTS.split(' ') {
        for stages in ["1", "2", "3"] {
            let csv = success(&["run", name, "--stages", stages, "--steps", "10"]);
            let rows = rows(&csv);
            assert_eq!(rows.len(), 11, "{name}, {stages} stages");
            let columns = csv.lines().find(|line| line.starts_with("t,")).expect("a head");
            let residual = columns.split(',').position(|column| column == "residual").expect("a column");
            assert!(columns.contains(",Λ_") && columns.ends_with(",residual,H,E,h"), "{columns}");
            for row in &rows {
                // Measured: at most 1.1e-14, of terms of about 100.
                assert!(row[residual] < 2e-14, "{name}, {stages} stages: {}", row[residual]);
            }
        }
        let energy = ["run", name, "--method", "energy", "--shift", "auto", "--steps", "10"];
        let csv = success(&energy);
        let rows = rows(&csv);
        let column = rows[0].len() - 2;
        assert!(rows.len() == 11 && csv.contains(",H,E,E',h\n"), "{name}: {csv}");
        // A motor, and a turntable, do work.
        let is_kept = rows.iter().all(|row| row[column].to_bits() == rows[0][column].to_bits());
        assert_eq!(is_kept, !["andrews-squeezer", "rolling-ball"].contains(&name), "{name}: {csv}");
        let text = success(&["explain", name]);
        assert!(text.contains("constraint"), "{name}: {text}");
    }
}

#[test]
fn initial_states_keep_or_meet_the_constraints() {
    // The default initial state follows the parameters; a given one is refused with both residuals, or moved.
    let csv = success(&["run", "rod-pendulum", "--set", "l=0.5", "--steps", "1"]);
    let first = &rows(&csv)[0];
    assert!((first[1].hypot(first[2]) - 0.5).abs() < 1e-15, "{csv}");
    // Λ of a rod at rest: the tension m g cos 1 is −2 Λ l.
    assert!((first[5] + 9.81 * 1.0_f64.cos() / (2.0 * 0.5)).abs() < 1e-14, "{csv}");
    let off = ["run", "rod-pendulum", "--q", "0.6,-0.9", "--v", "1,0", "--steps", "1"];
    let (status, csv, errors) = lab(&[off.as_slice(), &["--project"]].concat());
    assert_eq!(status, Some(0), "{errors}");
    // The nearest point is on the ray: √1.17 is 1.0816654.
    assert_eq!(errors, "note: the initial coordinates moved by up to 0.0679, the velocities by up to 0.462\n");
    let first = &rows(&csv)[0];
    assert!((first[1] - 0.6 / 1.17_f64.sqrt()).abs() < 1e-15 && (first[2] + 0.9 / 1.17_f64.sqrt()).abs() < 1e-15);
    assert_refused(&[
        (
            &off,
            "the state does not satisfy the constraint `rod`: residual 1.700e-1, rate 1.200e0; --project moves the initial \
             state onto the constraints",
        ),
        (
            &["run", "rod-pendulum", "--method", "fixed"],
            "RodPendulum has constraints, which --method fixed does not keep: use --method gauss (--stages 1, 2, 3, 4, 6), --method adaptive (--stages 3) or --method energy (--stages 1, 2)",
        ),
        (
            &["run", "rod-pendulum", "--stages", "5"],
            "RodPendulum has no integrator --method gauss --stages 5; --stages may be 1, 2, 3, 4 or 6",
        ),
        (
            &["run", "rod-pendulum", "--method", "energy", "--stages", "3"],
            "RodPendulum has no integrator --method energy --stages 3; --stages may be 1 or 2: with more, rounding hides the length",
        ),
        (
            &["run", "rod-pendulum", "--method", "energy", "--start", "midpoint"],
            "steps with constraints start from the initial state: leave out --start",
        ),
        (
            &["run", "four-bar", "--set", "b=1e3", "--steps", "3"],
            "four-bar has no initial state for these parameters: its constraints cannot be satisfied together; set other \
             lengths with --set, or give a start with --q and --v",
        ),
        (&["run", "kepler", "--project"], "kepler has no constraints to --project onto; remove it"),
    ]);
    let (status, _, errors) = lab(&["run", "rod-pendulum", "--set", "l=0", "--steps", "3"]);
    assert_eq!(status, Some(1));
    let zero = "error: the gradient of the constraint `rod` is zero at the start, as that of a rod without length\n";
    let remedy = "\nwhat to do: set another length with --set, or start elsewhere with --q\n";
    assert!(errors.starts_with(zero) && errors.ends_with(remedy), "{errors}");
    let beside = |q: &'static str| lab(&["run", "rod-pendulum", "--q", q, "--v", "0,0", "--project", "--steps", "3"]);
    let (status, _, errors) = beside("1e-9,0");
    assert_eq!(
        (status, errors.starts_with("note: the initial coordinates moved by up to 1")),
        (Some(0), true),
        "{errors}"
    );
    // At the centre of the circle no direction is nearer than another.
    let (status, _, errors) = beside("0,0");
    assert!(status == Some(1) && errors.contains("bordered by the constraints is singular"), "{errors}");
}

#[test]
fn every_system_runs_by_every_method_and_is_explained() {
    for name in SYSTEMS.split(' ') {
        for method in ["fixed", "kahan-li-6", "gauss", "energy"] {
            let csv = success(&["run", name, "--method", method, "--steps", "10"]);
            let rows = rows(&csv);
            assert_eq!(rows.len(), 11, "{name}, {method}");
            assert!(rows.windows(2).all(|pair| pair[0][0] < pair[1][0]), "{name}, {method}: {csv}");
        }
        let text = success(&["explain", name]);
        assert!(text.contains("D1 L_d"), "{name}: {text}");
    }
}

#[test]
fn both_methods_write_csv_to_standard_output() {
    for (method, start, first, tolerance) in
        [("fixed", "state", 0.0, 2e-8), ("energy", "state", 0.0, 1e-16), ("energy", "midpoint", 0.005, 1e-16)]
    {
        let of_start: &[&str] = if start == "state" { &[] } else { &["--start", start] };
        let run = ["run", "double-well", "--method", method, "--steps", "500"];
        let csv = success(&[run.as_slice(), of_start].concat());
        assert!(
            csv.starts_with("# vi-lab ")
                && csv.contains(&format!("# command: vi-lab run double-well --method {method}"))
        );
        assert!(csv.contains("\n# parameters: m = 1\n") && csv.contains("\nt,q,p_q,H,E,h\n"), "{csv}");
        let rows = rows(&csv);
        assert_eq!(rows.len(), 501);
        assert!((rows[0][0] - first).abs() < 1e-15, "{method} starts at {}", rows[0][0]);
        let spread = rows[1..].iter().map(|row| (row[4] - rows[1][4]).abs()).fold(0.0, f64::max);
        // Measured: fixed 7.2e-9 (the energy error of the theory), energy 0.
        assert!(spread < tolerance, "{method}: {spread}");
    }
}

#[test]
fn parameters_and_initial_values_are_set() {
    let run = ["run", "harmonic-oscillator", "--h", "0.001", "--until", "0.5"];
    let set = ["--set", "k=9", "--set", "m=4", "--q", "-2", "--v", "0.75"];
    let csv = success(&[run.as_slice(), &set].concat());
    let last = rows(&csv).pop().expect("rows");
    let omega = 1.5_f64;
    let t = 0.5;
    let exact = -2.0 * (omega * t).cos() + 0.75 / omega * (omega * t).sin();
    assert!((last[0] - t).abs() < 1e-12, "ends at {}", last[0]);
    // Measured 2.4e-7: the phase error ω³h²t/12 = 1.4e-7 times v/ω = 1.7.
    assert!((last[1] - exact).abs() < 4e-7, "{} instead of {exact}", last[1]);
}

#[test]
fn a_failing_step_leaves_the_output_so_far() {
    let file = temporary("failing.csv");
    let run = ["run", "double-well", "--method", "energy", "--start", "points", "--q", "1.05", "--steps", "1000"];
    let (status, output, errors) = lab(&[run.as_slice(), &["-o", path(&file)]].concat());
    assert_eq!((status, output.as_str()), (Some(1), ""));
    assert!(errors.starts_with("error: no energy-preserving step exists past t = "), "{errors}");
    let written = rows(&fs::read_to_string(&file).expect("the file"));
    // The last step is number 113 or 114: the theory of the paper has no solution at step 114 ± 1.
    assert!((112..=115).contains(&written.len()), "{} rows", written.len());
    let last = written.last().expect("rows");
    assert!(errors.contains(&format!("last good state: t = {}, q = [{}]", last[0], last[1])), "{errors}");
    fs::remove_file(&file).expect("the file can be removed");
}

#[test]
fn a_plot_shows_the_rows_however_the_run_ends() {
    let plot = temporary("plot.svg");
    let csv = temporary("plot.csv");
    let texts = |svg: &str| -> Vec<String> {
        svg.split("<text ")
            .skip(1)
            .filter_map(|rest| Some(rest.split('>').nth(1)?.split('<').next()?.to_owned()))
            .collect()
    };
    let drawn = |arguments: &[&str], status: i32| {
        let (ended, output, errors) = lab(&[arguments, &["--plot", path(&plot)]].concat());
        assert_eq!((ended, output.as_str()), (Some(status), ""), "{arguments:?}: {errors}");
        let svg = fs::read_to_string(&plot).expect("the plot");
        assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n") && !svg.contains("NaN"), "{arguments:?}");
        fs::remove_file(&plot).expect("the file can be removed");
        (texts(&svg), svg, errors)
    };
    // Two coordinates: the energies, the plane, and a time series and a phase portrait for each coordinate.
    let (words, svg, _) = drawn(&["run", "kepler", "--steps", "2000", "-o", path(&csv)], 0);
    assert_eq!(words[..2], ["kepler, fixed, h = 0.005", "mu = 1"]);
    for axis in ["energy − H₀", "H at the start: H₀ = -0.5", "x", "y", "p_x", "p_y", "t"] {
        assert!(words.iter().any(|word| word == axis), "{axis}: {words:?}");
    }
    assert_eq!((svg.matches("<svg ").count(), rows(&fs::read_to_string(&csv).expect("rows")).len()), (7, 2001));
    fs::remove_file(&csv).expect("the file can be removed");
    // A failed run draws its rows: one that ends on the way, and one with its first row only.
    let (_, svg, errors) = drawn(&["run", "double-well", "--q", "1.05", "--method", "energy"], 1);
    assert!(errors.starts_with("error: no energy-preserving step") && svg.contains("<path "), "{errors}");
    let (_, svg, _) = drawn(&["run", "double-well", "--steps", "0"], 0);
    assert!(svg.contains("<circle ") || svg.contains("<rect x="), "one row is a dot");
    // Ten times as many rows make no larger file; of forty coordinates 24 are drawn.
    let long = |steps: &str| drawn(&["run", "pendulum", "--steps", steps], 0).1.len();
    let sizes = (long("2e4"), long("2e5"));
    // Measured 222 kB and 230 kB.
    assert!(sizes.0 < 300_000 && sizes.1 < 300_000, "{sizes:?} bytes");
}

#[test]
fn wrong_input_is_one_line_and_status_2() {
    assert_refused(&[
        (&["explain"], "name a system of `vi-lab list`"),
        (&["work-precision"], "name a system of `vi-lab list`"),
        (&["run", "dubble-well", "--steps", "1"], "there is no system `dubble-well`; did you mean `double-well`?"),
        (&["run", "xyz"], "there is no system `xyz`; `vi-lab list` shows all systems"),
        (&["run"], "name a system of `vi-lab list`"),
        (
            &["run", "double-well", "--steps", "one"],
            "invalid value 'one' for '--steps <N>': write a whole number from 0 to 1.8e19, such as 1000 or 1e6",
        ),
        (
            &["run", "double-well", "--steps", "1.5e0"],
            "invalid value '1.5e0' for '--steps <N>': write a whole number from 0 to 1.8e19, such as 1000 or 1e6",
        ),
        (
            &["run", "double-well", "--steps", "1", "--q", "−1"],
            "invalid value '−1' for '--q <Q,…>': write a number such as 0.5 or 1e-3; write the minus sign as a hyphen `-`",
        ),
        (&["run", "double-well", "--steps", "1", "--q", "1e400"], "the coordinates (--q) must be finite, not inf"),
        (
            &["run", "double-well", "--steps", "1", "--method", "euler"],
            "invalid value 'euler' for '--method <METHOD>' [possible values: fixed, suzuki-4, kahan-li-6, kahan-li-8, splitting-4, splitting-6, gauss, adaptive, energy]",
        ),
        (&["work-precision", "kepler", "--q", "1"], "give 2 finite coordinates (--q), not [1.0]"),
        (
            &["run", "double-well", "--steps", "1", "-o", "x.npy"],
            "the output `x.npy` must end in .csv; pandas reads it with `read_csv(FILE, comment=\"#\")`",
        ),
        (&["run", "double-well", "--steps", "1", "--plot", "x.png"], "the plot `x.png` must end in .svg"),
        (
            &["run", "double-well", "--steps", "1", "--plot", "no-such-folder/x.svg"],
            "there is no folder `no-such-folder` for the plot `no-such-folder/x.svg`; create it first",
        ),
        (
            &["run", "double-well", "--steps", "1", "-o", "no-such-folder/x.csv"],
            "there is no folder `no-such-folder` for the output `no-such-folder/x.csv`; create it first",
        ),
        (&["run", "none.toml", "--steps", "1"], "none.toml: No such file or directory (os error 2)"),
        (&[], "no command given; `vi-lab help` lists the commands"),
        (
            &["run", "a/none.yml"],
            "there is no system `a/none.yml`; a scene file ends in .toml, a declaration in .rs or .vi",
        ),
        (&["fly"], "unrecognized subcommand 'fly'; `vi-lab help` lists the commands"),
        (&["run", "kepler", "--stepz", "1"], "unexpected argument '--stepz' found; did you mean `--steps`?"),
        (
            &["run", "kepler", "--steps", "1", "--parameter", "mu=2"],
            "unexpected argument '--parameter' found; --set NAME=VALUE sets a parameter, `vi-lab run --help` lists the options",
        ),
    ]);
}

#[test]
fn a_run_that_rounding_or_a_disk_would_swallow_is_refused() {
    assert_refused(&[
        // Steps below rounding.
        (
            &["run", "pendulum", "--h", "1e-300", "--until", "1"],
            "the step (--h) 1e-300 is out of range: its square is not a normal number in double precision; use a step from \
             1.49e-154 to 1.34e154",
        ),
        (
            &["run", "pendulum", "--h", "1e-20", "--until", "1"],
            "a step of h = 1e-20 is below rounding at t = 1, where double-precision numbers are 2.22e-16 apart; use a larger \
             --h, or times closer to zero",
        ),
        (
            &["run", "pendulum", "--until", "1e30"],
            "a step of h = 0.01 is below rounding at t = 1e30, where double-precision numbers are 141000000000000 apart; use \
             a larger --h, or times closer to zero",
        ),
        // Whether the length at the end is below rounding is not known: the length of the first step would be.
        (
            &["run", "pendulum", "--method", "adaptive", "--h", "1e-3", "--until", "1e14"],
            "the output would have about 1e17 rows, 11400000000 GB; write fewer rows with --every 11400000000, or allow more \
             than 1 GB with --large-output",
        ),
        (
            &["run", "pendulum", "--method", "energy", "--t", "1e17", "--steps", "1"],
            "a step of h = 0.01 is below rounding at t = 1e17, where double-precision numbers are 16 apart; use a larger --h, \
             or times closer to zero",
        ),
        (
            // Every fourth step would round to zero.
            &["run", "pendulum", "--t", "1e10", "--h", "1.5e-6", "--steps", "10"],
            "a step of h = 1.5e-6 is below rounding at t = 10000000000, where double-precision numbers are 1.91e-6 apart; use a \
             larger --h, or times closer to zero",
        ),
        (
            &["run", "kepler", "--h", "1e-100", "--steps", "3"],
            "the first step of h = 1e-100 changes neither q = [0.4, 0.0] nor p = [0.0, 2.0] in double precision, although \
             v = [0.0, 2.0]; use a larger --h, or a start and parameters with a regular mass matrix",
        ),
        // Gigabytes without permission: 1e9 rows of 6 numbers of 19 bytes, 1e7 rows of 36 numbers.
        (
            &["run", "pendulum", "--until", "1e7"],
            "the output would have about 1000000000 rows, 114 GB; write fewer rows with --every 114, or allow more than 1 GB \
             with --large-output",
        ),
        (
            &["run", "fpu-chain", "--steps", "1e7", "-o", "x.csv"],
            "the output would have about 10000000 rows, 6.84 GB; write fewer rows with --every 7, or allow more than 1 GB with \
             --large-output",
        ),
        (
            &["run", "pendulum", "--method", "energy", "--until", "1e30"],
            "the output would have about 1e32 rows, 1.14e25 GB; shorten the run, or allow more than 1 GB with --large-output",
        ),
    ]);
}

#[test]
fn a_mistake_in_a_scene_is_one_line_and_status_2() {
    let file = temporary("mistaken.toml");
    let refused = |text: &str, start: &str, message: &str| {
        fs::write(&file, text).expect("the scene");
        let (status, output, errors) = lab(&["run", path(&file)]);
        assert_eq!((status, output.as_str(), errors.lines().count()), (Some(2), "", 1), "{errors}");
        assert!(errors.starts_with(&format!("error: {start}")) && errors.contains(message), "{errors}");
    };
    let of_file = format!("{}: line 2: ", path(&file));
    refused(
        "system = \"kepler\"\ncolour = 1\n",
        &of_file,
        "unknown field `colour`, expected one of `system`, `method`",
    );
    // Wrong values are reported as for the command line, which may have replaced them.
    for (text, message) in [
        ("method = \"gauss\"\nstages = 5\n", "Kepler has no integrator --method gauss --stages 5"),
        ("q = [nan, 0]\n", "the coordinates (--q) must be finite, not NaN"),
        ("until = -1.0\n", "steps of 0.005 from t = 0 do not reach --until -1"),
        ("[parameters]\nm = 1\n", "kepler has no parameter `m`; it has `mu`"),
        ("[parameters]\nmu = inf\n", "the parameter `mu` must be finite, not inf"),
    ] {
        refused(&format!("system = \"kepler\"\n{text}"), message, "");
    }
    fs::remove_file(file).expect("the file can be removed");
}

#[test]
fn a_count_may_have_an_exponent() {
    let (status, csv, errors) = lab(&["run", "double-well", "--steps", "1e2"]);
    assert_eq!((status, errors.as_str(), rows(&csv).len()), (Some(0), "", 101));
}

#[test]
fn every_nth_node_and_the_last_are_those_of_the_whole_run() {
    for method in ["fixed", "energy"] {
        let run = ["run", "kepler", "--method", method, "--steps", "25"];
        let (_, all, _) = lab(&run);
        let some = success(&[run.as_slice(), &["--every", "10"]].concat());
        let all = rows(&all);
        let expected: Vec<Vec<f64>> = [0, 10, 20, 25].map(|index: usize| all[index].clone()).to_vec();
        assert_eq!(bits(&rows(&some)), bits(&expected), "{method}");
    }
}

#[test]
fn the_two_energies_have_columns_of_their_own() {
    let csv = success(&["run", "double-well", "--h", "0.01", "--steps", "1000"]);
    let fixed = rows(&csv);
    assert!(csv.contains(",,0.01\n") && fixed[0][4].is_nan(), "no interval ends in the first row");
    let largest = |values: &dyn Fn(&[f64]) -> f64| fixed[1..].iter().map(|row| values(row).abs()).fold(0.0, f64::max);
    // H = p²/2 + (q⁴ − q²)/2, and H − E = h²D/8 with D = V'² + v²V'' to leading order.
    let by_hand = |row: &[f64]| (row[2].powi(2) + row[1].powi(4) - row[1].powi(2)) / 2.0;
    let density = |row: &[f64]| {
        let q = row[1];
        let p = row[2];
        (2.0 * q.powi(3) - q).powi(2) + p * p * (6.0 * q * q - 1.0)
    };
    assert!((fixed[0][3] - by_hand(&fixed[0])).abs() < 1e-16);
    // Measured 2.8e-17.
    let error = largest(&|row| row[3] - by_hand(row));
    assert!(error < 1e-16, "H: {error:e}");
    let excess = |row: &[f64]| 1e-4 / 8.0 * density(row);
    let error = largest(&|row| row[3] - row[4] - excess(row)) / largest(&excess);
    // Measured 6.7e-4, a term of higher order.
    assert!(error < 1e-3, "H − E: {error}");
    let (_, csv, _) = lab(&["run", "double-well", "--h", "0.01", "--steps", "1000", "--method", "energy"]);
    let energy = rows(&csv);
    let swing = |column: usize| energy.iter().map(|row| (row[column] - energy[0][column]).abs()).fold(0.0, f64::max);
    // Measured: 0 and 3.8e-9.
    assert!(swing(4) < 1e-16 && swing(3) > 1e-9, "E swings by {:e}, H by {:e}", swing(4), swing(3));
}

#[test]
fn without_a_step_the_advice_continues_the_run() {
    let run = ["run", "double-well", "--q", "1.05", "--steps", "1000", "--every", "1000"];
    let advised = |options: &[&str]| {
        let (status, _, errors) = lab(&[run.as_slice(), &["--method", "energy"], options].concat());
        let lines: Vec<&str> = errors.lines().collect();
        assert_eq!((status, lines.len()), (Some(1), 3), "{errors}");
        assert!(lines[1].starts_with("last good state: t = "), "{errors}");
        lines[2].to_owned()
    };
    let leads_on = |options: &[&str]| {
        success(&[run.as_slice(), options].concat());
    };
    let shift =
        |advice: &str| advice.split("--shift ").nth(1).and_then(|rest| rest.split(' ').next()).map(str::to_owned);
    let advice = advised(&[]);
    let given = shift(&advice).expect("a shift");
    let rest = format!(
        "what to do: --shift {given} gives steps along this motion; other orders have other step densities: --stages 2, D = "
    );
    assert!(advice.starts_with(&rest) && advice.contains("; --stages 3, D = "), "{advice}");
    let end = "; --method fixed and --method gauss need no step density";
    assert!(advice.contains("; --fallback continues with fixed steps; ") && advice.ends_with(end), "{advice}");
    for options in [["--shift", &given].as_slice(), &["--shift", "auto"], &["--stages", "2"], &["--fallback"]] {
        leads_on(&[&["--method", "energy"], options].concat());
    }
    leads_on(&["--method", "fixed"]);
    leads_on(&["--method", "gauss"]);
    // A shift that is too small: the suggested one is larger.
    let small = advised(&["--stages", "1", "--shift", "0.01"]);
    assert!(small.starts_with("what to do: --stages 1 --shift "), "{small}");
    leads_on(&["--method", "energy", "--stages", "1", "--shift", &shift(&small).expect("a shift")]);
}

#[test]
fn steps_too_short_for_their_length_get_a_longer_one_as_advice() {
    let run = ["run", "double-well", "--method", "energy", "--stages", "3"];
    let (status, _, errors) = lab(&[run.as_slice(), &["--h", "0.01"]].concat());
    assert_eq!(status, Some(1), "{errors}");
    assert!(errors.starts_with("error: the step length is not determined at t = 0"), "{errors}");
    let longer = errors.split("what to do: --h ").nth(1).and_then(|rest| rest.split(':').next()).expect("a length");
    for options in [["--h", longer].as_slice(), &[]] {
        success(&[run.as_slice(), options].concat());
    }
}

#[test]
fn steps_with_a_shift_keep_an_energy_of_their_own() {
    let pendulum =
        ["run", "pendulum", "--set", "g=1", "--q", "2", "--h", "0.05", "--steps", "340", "--method", "energy"];
    let csv = success(&[pendulum.as_slice(), &["--stages", "2", "--shift", "auto"]].concat());
    assert!(csv.contains("\nt,θ,p_θ,H,E,E',h\n"), "{csv}");
    let kept = "E': E − C h^4 D*, which is conserved, with C = 1/864 and the shift D* = 18.";
    assert!(csv.contains("\n# method: energy, 2 stages, shift 18.") && csv.contains(kept), "{csv}");
    let rows = rows(&csv);
    assert_eq!((rows.len(), rows[0][0]), (341, 0.0));
    let swing = |column: usize| {
        let values = || rows.iter().map(|row| row[column]);
        values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
    };
    // Predicted by docs/theory.md, section 5: H by 1.21e-8, E by 4.08e-8. Measured E': 2.2e-16.
    let [total, discrete, shifted] = [3, 4, 5].map(swing);
    println!("H deviates by {total:e}, E by {discrete:e}, E' by {shifted:e}");
    assert!((total / 1.21e-8 - 1.0).abs() < 0.01 && (discrete / 4.08e-8 - 1.0).abs() < 0.01, "{total:e}, {discrete:e}");
    assert!(shifted < 5e-16, "{shifted:e}");
    // With a force, and with a constraint.
    let words = |system: &str, options: &[&str]| {
        let head = lab(&[&["run", system, "--method", "energy", "--steps", "1"], options].concat()).1;
        head.lines().find_map(|line| Some(line.split_once("for compositions; ")?.1.to_owned()))
    };
    let changes = "changes only by the work of forces and constraints, and with an explicit time";
    assert_eq!(words("damped-oscillator", &[]), Some(format!("E {changes}")));
    assert_eq!(words("damped-oscillator", &["--fallback"]), Some(format!("E {changes}, but for fixed steps")));
    let shifted = words("damped-oscillator", &["--shift", "9"]).expect("a header");
    assert!(shifted.starts_with(&format!("E': E − C h^2 D*, which {changes}, with C")), "{shifted}");
    assert_eq!(words("rod-pendulum", &[]).as_deref(), Some("E is conserved if no constraint does work"));
    assert_eq!(words("kepler", &[]).as_deref(), Some("E is conserved"));
    // The order of the stages without a shift: E is conserved, and H is closer to it.
    let (_, csv, _) =
        lab(&["run", "kepler", "--method", "energy", "--stages", "3", "--h", "0.05", "--q", "0.7,0", "--v", "0,1.36"]);
    assert!(
        csv.contains("\n# method: energy, 3 stages, h = 0.05,") && csv.contains("that ends there, empty before"),
        "{csv}"
    );
    let rows: Vec<Vec<&str>> =
        csv.lines().filter(|line| !line.starts_with(['#', 't'])).map(|line| line.split(',').collect()).collect();
    assert!(rows.len() == 1001 && rows.iter().all(|row| row[6] == rows[0][6]), "E is kept to the last bit");
    let scene = temporary("shift.toml");
    fs::write(&scene, "system = \"pendulum\"\nmethod = \"energy\"\nstages = 2\nshift = \"auto\"\nq = [2.0]\n")
        .expect("a scene");
    assert_eq!(lab(&["run", path(&scene)]).0, Some(0));
    // Options for the method of the scene do not apply to another method.
    assert_eq!(lab(&["run", path(&scene), "--method", "fixed"]).0, Some(0));
    fs::remove_file(&scene).expect("the file can be removed");
}

#[test]
fn gauss_steps_in_scaled_time_follow_an_eccentric_orbit() {
    // Eccentricity 0.9: three periods of fifteen steps, as in the cookbook.
    let orbit = ["run", "kepler", "--q", "0.1,0", "--v", "0,4.358898943540674", "--method", "gauss"];
    let csv = success(&[orbit.as_slice(), &["--dtau", "0.5578667", "--steps", "45"]].concat());
    assert!(csv.contains("# method: gauss, 8 stages, dtau = 0.5578667, h = 0.0176"), "{csv}");
    let rows = rows(&csv);
    let last = rows.last().expect("rows");
    let longest = rows.iter().fold(0.0_f64, |longest, row| longest.max(row[7]));
    println!("t = {}, H + 1/2 = {:e}, the longest step {longest}", last[0], last[5] + 0.5);
    // Measured: 45 steps end 2e-3 before the end of the third period, with the initial H to 1.5e-13; a step is up to 80
    // times as long as the first.
    assert!((last[0] - 6.0 * std::f64::consts::PI).abs() < 0.01 && (last[5] + 0.5).abs() < 1e-12 && longest > 1.0);
    assert_refused(&[
        (
            &["run", "pendulum", "--method", "gauss", "--dtau", "0.5"],
            "Pendulum has no time scale: give --h in place of --dtau, or write the clause `time_scale = …;`",
        ),
        (
            &["run", "kepler", "--method", "gauss", "--dtau", "0.5", "--h", "0.1"],
            "the argument '--dtau <DTAU>' cannot be used with '--h <H>'",
        ),
    ]);
}

#[test]
fn a_singular_mass_matrix_is_status_1_with_the_initial_state() {
    let file = temporary("singular.csv");
    let run = ["run", "pendulum", "--set", "l=0", "--v", "1", "--steps", "10", "--method", "energy"];
    let (status, output, errors) = lab(&[run.as_slice(), &["-o", path(&file)]].concat());
    assert_eq!((status, output.as_str()), (Some(1), ""));
    assert!(errors.contains(" is singular at t = "), "{errors}");
    assert!(errors.ends_with("\nlast good state: t = 0, q = [1.0], v = [1.0], the initial state\n"), "{errors}");
    assert!(!file.exists(), "where no run starts no file is made");
}

#[cfg(unix)]
#[test]
fn an_interrupted_run_leaves_whole_rows() {
    let file = temporary("interrupted.csv");
    // Longer than any test.
    let run = ["run", "kepler", "--steps", "1e10", "--every", "100", "--large-output"];
    for (signal, name, status) in [("-INT", "SIGINT", 130), ("-TERM", "SIGTERM", 143)] {
        let child = start(&[run.as_slice(), &["-o", path(&file)]].concat());
        while fs::metadata(&file).map_or(0, |file| file.len()) < 150_000 {
            std::thread::sleep(std::time::Duration::from_millis(10));
        }
        send(signal, &child);
        let Output { status: ended, stderr, .. } = child.wait_with_output().expect("the command ends");
        let errors = String::from_utf8(stderr).expect("text");
        assert_eq!(ended.code(), Some(status), "{errors}");
        let diagnostic = errors.lines().last().expect("a line that says how far the run came");
        assert!(diagnostic.starts_with(&format!("error: interrupted by {name} after ")), "{errors}");
        let written = rows(&fs::read_to_string(&file).expect("the output"));
        assert!(written.len() > 900 && written.iter().all(|row| row.len() == 8));
        let last = written.last().expect("rows")[0];
        assert!(diagnostic.contains(&format!(" steps at t = {last}; ")), "{diagnostic} {last}");
        fs::remove_file(&file).expect("the file can be removed");
        let mut child = start(&run);
        let mut output = BufReader::new(child.stdout.take().expect("the output"));
        let mut text = String::new();
        for _ in 0..1000 {
            output.read_line(&mut text).expect("a line");
        }
        send(signal, &child);
        output.read_to_string(&mut text).expect("the rest");
        assert_eq!(child.wait().expect("the command ends").code(), Some(status));
        assert!(text.ends_with('\n') && rows(&text).iter().all(|row| row.len() == 8));
    }
}

#[cfg(unix)]
#[test]
fn a_disk_that_is_full_leaves_whole_rows() {
    let file = temporary("full.csv");
    // A file is limited to 200 blocks of 512 bytes; writing more fails.
    let limited = "trap '' XFSZ; ulimit -f 200; exec \"$0\" \"$@\"";
    let lab = env!("CARGO_BIN_EXE_vi-lab");
    let run = ["-c", limited, lab, "run", "kepler", "--steps", "1e5", "-o", path(&file)];
    let Output { status, stderr, .. } = Command::new("sh").args(run).output().expect("the shell runs");
    let errors = String::from_utf8(stderr).expect("text");
    assert_eq!((status.code(), errors.lines().count()), (Some(1), 1), "{errors}");
    assert!(errors.starts_with(&format!("error: {}: ", path(&file))), "{errors}");
    let rows = rows(&fs::read_to_string(&file).expect("the output"));
    assert!(rows.len() > 300 && rows.iter().all(|row| row.len() == 8), "{} rows", rows.len());
    fs::remove_file(file).expect("the file can be removed");
}

#[cfg(target_os = "linux")]
#[test]
fn an_output_that_fails_costs_the_other_nothing() {
    // A failed plot loses no row.
    let plot = temporary("device.svg");
    std::os::unix::fs::symlink("/dev/full", &plot).expect("a link");
    let csv = temporary("beside.csv");
    let (status, output, errors) = lab(&["run", "kepler", "--steps", "10", "-o", path(&csv), "--plot", path(&plot)]);
    assert_eq!((status, output.as_str()), (Some(1), ""));
    assert_eq!(errors, format!("error: {}: No space left on device (os error 28)\n", path(&plot)));
    assert_eq!(rows(&fs::read_to_string(&csv).expect("rows")).len(), 11);
    // Failed rows lose no plot.
    let full = temporary("device.csv");
    std::os::unix::fs::symlink("/dev/full", &full).expect("a link");
    fs::remove_file(&plot).expect("the link can be removed");
    let (status, _, errors) = lab(&["run", "kepler", "--steps", "5000", "-o", path(&full), "--plot", path(&plot)]);
    assert_eq!((status, errors), (Some(1), format!("error: {}: No space left on device (os error 28)\n", path(&full))));
    assert!(fs::read_to_string(&plot).expect("the plot").ends_with("</svg>\n"));
    for file in [plot, csv, full] {
        fs::remove_file(file).expect("the file can be removed");
    }
}

#[cfg(unix)]
#[test]
fn a_csv_file_can_be_a_pipe() {
    let pipe = temporary("pipe.csv");
    assert!(Command::new("mkfifo").arg(&pipe).status().expect("mkfifo runs").success());
    let child = start(&["run", "kepler", "--steps", "5", "-o", path(&pipe)]);
    let text = fs::read_to_string(&pipe).expect("what the command writes");
    let Output { status, .. } = child.wait_with_output().expect("the command ends");
    assert_eq!((status.code(), rows(&text).len()), (Some(0), 6));
    fs::remove_file(pipe).expect("the pipe can be removed");
}

#[test]
fn output_that_nobody_reads_is_status_141() {
    for method in ["fixed", "energy"] {
        let mut child = start(&["run", "kepler", "--method", method, "--steps", "1e5"]);
        let mut first = String::new();
        // Reads one line and closes the pipe, as `head -1` does.
        BufReader::new(child.stdout.take().expect("the output")).read_line(&mut first).expect("a line");
        let Output { status, stderr, .. } = child.wait_with_output().expect("the command ends");
        assert!(first.starts_with("# vi-lab "), "{first}");
        assert_eq!((status.code(), String::from_utf8(stderr).as_deref()), (Some(141), Ok("")));
    }
}

#[cfg(unix)]
#[test]
fn a_run_of_days_is_announced() {
    let mut child = start(&["run", "pendulum", "--steps", "1e14", "--every", "1e13"]);
    let mut diagnostic = String::new();
    BufReader::new(child.stderr.take().expect("messages")).read_line(&mut diagnostic).expect("a line");
    send("-INT", &child);
    let Output { status, stdout, .. } = child.wait_with_output().expect("the command ends");
    assert!(
        diagnostic.starts_with("at the rate of its first second, this run takes ") && diagnostic.contains(" more days"),
        "{diagnostic}"
    );
    let rows = rows(&String::from_utf8(stdout).expect("text"));
    assert_eq!((status.code(), rows.len()), (Some(130), 2), "the first node and the last");
}

#[test]
fn a_scene_is_run_and_the_command_line_overrides_it() {
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/damped-oscillator.toml");
    let csv = success(&["run", scene]);
    assert!(csv.contains("# parameters: m = 1, k = 4, c = 0.02\n"));
    let rows_to_end = rows(&csv);
    let [.., before, last] = &rows_to_end[..] else { panic!("{csv}") };
    assert_eq!(last[0].to_bits(), 100.0_f64.to_bits());
    // The last step is shortened. h/h0 at t = 100 for ζ = 0.005, from the step law: 2.712.
    assert!((before[5] / 0.01 - 2.712).abs() < 5e-4 && last[5] < before[5], "{before:?}, {last:?}");
    let (status, csv, _) = lab(&["run", scene, "--steps", "3", "--method", "fixed", "--set", "c=0.5"]);
    assert_eq!((status, rows(&csv).len()), (Some(0), 4));
    assert!(csv.contains("# parameters: m = 1, k = 4, c = 0.5\n"));
}

#[test]
fn every_scene_runs() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes");
    let mut scenes = 0;
    for entry in fs::read_dir(folder).expect("the scenes") {
        let file = entry.expect("an entry").path();
        if file.extension().is_some_and(|extension| extension == "toml") {
            let is_sweep = fs::read_to_string(&file).expect("a scene").contains("[sweep]");
            let item: &[&str] = if is_sweep { &["--item", "7"] } else { &[] };
            success(&[&["run", path(&file), "--steps", "5"], item].concat());
            scenes += 1;
        }
    }
    assert!(scenes > 0);
}

#[test]
fn the_map_of_a_system_is_a_page_with_its_files() {
    let out = temporary("stability");
    let output = success(&[
        "stability",
        "double-well",
        "--columns",
        "20",
        "--x",
        "q=-1.5:1.5",
        "--y",
        "v_q=-1:1",
        "--out",
        path(&out),
    ]);
    assert_eq!(output.trim(), out.join("index.html").display().to_string());
    for name in ["index.html", "energy.svg", "energy.csv", "fixed.svg", "fixed.csv"] {
        assert!(fs::metadata(out.join(name)).is_ok_and(|file| file.len() > 500), "{name}");
    }
    let csv = fs::read_to_string(out.join("energy.csv")).expect("the cells");
    assert!(csv.contains("# 0: runs to the end\n# 2: no forward step\n") && csv.contains("# curve, D = 0: ("), "{csv}");
    let cells: Vec<&str> = csv.lines().filter(|line| !line.starts_with('#')).collect();
    assert_eq!((cells.len(), cells[0].split(',').count()), (12, 21));
    // Rest at the bottom of the right well continues, a run across the barrier ends.
    let cell =
        |row: usize, column: usize| cells[row + 1].split(',').nth(column + 1).and_then(|cell| cell.parse::<u8>().ok());
    assert_eq!(cell(5, 14), Some(0));
    assert!(cell(10, 14).is_some_and(|class| class > 0));
    fs::remove_dir_all(out).expect("the folder can be removed");
}

#[test]
fn every_method_is_compared_and_early_ends_have_a_reason() {
    let out = temporary("work-precision");
    // A driven double well: its energy-preserving runs end, the others reach the end.
    let output = success(&["work-precision", "double-well-duffing", "--quick", "--out", path(&out)]);
    let equal = ["fixed step", "Suzuki 4", "Kahan–Li 6", "Kahan–Li 8", "\"Gauss, 8 stages\""];
    let others = ["\"Gauss, 8 stages, adaptive\"", "energy-preserving", "DOP853"];
    let methods: Vec<&str> = equal.into_iter().chain(others).collect();
    assert!(methods.iter().all(|method| output.contains(method.trim_matches('"'))), "{output}");
    assert!(output.trim_end().ends_with(path(&out.join("index.html"))), "{output}");
    for name in ["work-precision", "evaluations", "order"] {
        assert!(fs::metadata(out.join(format!("{name}.svg"))).is_ok_and(|file| file.len() > 5000), "{name}");
        assert!(fs::metadata(out.join(format!("{name}.csv"))).is_ok_and(|file| file.len() > 500), "{name}");
    }
    let runs = fs::read_to_string(out.join("runs.csv")).expect("the runs");
    for method in methods {
        let of: Vec<&str> = runs.lines().filter(|line| line.starts_with(method)).collect();
        let ended = of.iter().filter(|line| line.contains("no energy-preserving step exists past")).count();
        assert!(of.len() >= 11, "{method}: {} runs", of.len());
        assert_eq!(ended, if method == "energy-preserving" { of.len() } else { 0 }, "{method}");
    }
    let page = fs::read_to_string(out.join("index.html")).expect("the page");
    let diagnostic =
        "All 11 runs of energy-preserving ended early; at h₀ = 0.0050: no energy-preserving step exists past t = ";
    assert!(
        page.contains(diagnostic) && page.contains("(debug build") | page.contains("(release build"),
        "the page says so"
    );
    fs::remove_dir_all(out).expect("the folder can be removed");
}

#[test]
fn without_a_comparison_the_command_reports_why() {
    let out = temporary("rest");
    let rest = ["work-precision", "pendulum", "--q", "0", "--v", "0", "--quick", "--out", path(&out)];
    let (status, output, errors) = lab(&rest);
    assert_eq!((status, output.as_str()), (Some(2), ""), "{errors}");
    let why = "error: pendulum has no run with an error to compare: errors are relative to the largest coordinate and momentum, and one of them is always zero\n";
    assert_eq!(errors, format!("{why}{} has all runs\n", path(&out.join("index.html"))));
    fs::remove_dir_all(out).expect("the folder can be removed");
}

#[test]
fn wrong_axes_are_status_2() {
    assert_refused(&[
        (&["stability", "double-wel"], "there is no system `double-wel`; did you mean `double-well`?"),
        (
            &["stability", "kepler", "--x", "z=0:1"],
            "there is no quantity `z` to vary; the quantities are x, y, v_x, v_y, mu, h",
        ),
        (&["stability", "kepler", "--x", "x=1"], "an axis is given as NAME=LOW:HIGH, with LOW below HIGH, not `x=1`"),
        (&["stability", "kepler", "--x", "h=1:2"], "both axes vary `h`; give two different ones with --x and --y"),
        (&["stability", "--columns", "5"], "invalid value '5' for '--columns <N>': 5 is not in 10..=596"),
    ]);
    let missing = temporary("stability-file");
    fs::write(&missing, "a file").expect("a file");
    let (status, _, errors) = lab(&["stability", "double-well", "--columns", "10", "--out", path(&missing)]);
    assert_eq!((status, errors.lines().count()), (Some(1), 1), "{errors}");
    fs::remove_file(missing).expect("the file can be removed");
}

#[test]
fn a_composition_runs_and_has_no_discrete_energy() {
    for (method, error) in [("suzuki-4", 1e-4), ("kahan-li-6", 1e-5), ("kahan-li-8", 1e-5)] {
        let output = success(&["run", "kepler", "--method", method, "--h", "0.02", "--steps", "300"]);
        let rows: Vec<Vec<&str>> =
            output.lines().filter(|line| !line.starts_with(['#', 't'])).map(|line| line.split(',').collect()).collect();
        assert_eq!(rows.len(), 301, "{method}");
        for row in rows {
            let energy: f64 = row[5].parse().expect("H");
            assert!((energy + 0.5).abs() < error && row[6].is_empty(), "{method}: {row:?}");
        }
    }
}

#[test]
fn gauss_steps_run_and_have_both_energies() {
    let scene = temporary("gauss.toml");
    fs::write(&scene, "system = \"kepler\"\nmethod = \"gauss\"\nstages = 4\nh = 0.1\nsteps = 300\n").expect("a scene");
    // Measured: 3.2e-8 and 6.7e-16.
    for (stages, error) in [("4", 1e-7), ("8", 2e-15)] {
        let output = success(&["run", path(&scene), "--stages", stages]);
        assert!(output.contains(&format!("# method: gauss, {stages} stages, h = 0.1")), "{output}");
        let rows: Vec<Vec<&str>> =
            output.lines().filter(|line| !line.starts_with(['#', 't'])).map(|line| line.split(',').collect()).collect();
        assert_eq!(rows.len(), 301);
        assert_eq!(rows[0][6], "", "no step has been taken");
        for row in &rows[1..] {
            for energy in &row[5..7] {
                let energy: f64 = energy.parse().expect("an energy");
                assert!((energy + 0.5).abs() < error, "{stages} stages: {row:?}");
            }
        }
    }
    // The command line names another method: the stages of the scene do not apply.
    success(&["run", path(&scene), "--method", "fixed"]);
    fs::remove_file(scene).expect("the file can be removed");
}

#[test]
fn a_file_is_expanded_stage_by_stage() {
    let kepler = concat!(env!("CARGO_MANIFEST_DIR"), "/../vi-systems/src/kepler.rs");
    for (stage, line) in [
        ("syntax", "    let r = sqrt(x^2 + y^2);"),
        ("model", "    p_x = dot(x)"),
        ("discrete", "    (D4 L_d)_x = L_v_x + h*L_x/2"),
        ("program", "momentum: 0 operations"),
        ("rust", "    impl<T: ::vi_core::real::Real> ::vi_core::stepping::FixedStepping<2, T>"),
    ] {
        let output = success(&["expand", kepler, "--stage", stage]);
        assert!(output.lines().any(|shown| shown == line), "{stage}: {output}");
    }
    let (_, rust, _) = lab(&["expand", kepler]);
    let documented = concat!(env!("CARGO_MANIFEST_DIR"), "/../docs/expanded/kepler.rs");
    assert_eq!(rust, fs::read_to_string(documented).expect("the documented expansion"));
}

#[test]
fn mistakes_in_a_file_are_shown_at_their_places() {
    let file = temporary("wrong.rs");
    let right = "lagrangian! { struct Right { coord x; L = dot(x)^2; discretize midpoint; } }";
    let wrong = "lagrangian! { struct Wrong { coord x; L = a * dot(x)^2; discretize midpoint; } }";
    fs::write(&file, format!("{wrong}\nmod inner {{\n    {right}\n}}\n")).expect("the file");
    let (status, output, errors) = lab(&["expand", path(&file), "--stage", "syntax"]);
    assert_eq!((status, errors.as_str(), output.matches("struct").count()), (Some(0), "", 2), "the syntax is right");
    let (status, output, errors) = lab(&["expand", path(&file), "--stage", "model"]);
    assert_eq!(status, Some(1));
    assert!(output.starts_with("Right\n"), "what is right is shown: {output}");
    let begins = format!("error: unknown name `a`\n --> {}:1:43\n  |\n1 | {wrong}\n  | {:>43}\n", path(&file), "^");
    assert!(errors.starts_with(&begins), "{errors}");
    fs::write(&file, "fn main() {}\n").expect("the file");
    let (status, output, errors) = lab(&["expand", path(&file)]);
    assert_eq!((status, output.as_str(), errors.lines().count()), (Some(2), "", 1), "{errors}");
    assert!(errors.contains("declares no system with `lagrangian!`"), "{errors}");
    // Text that Rust cannot read is also shown with its line.
    for (text, message) in [
        ("fn `() {}\n", ":1:4\n  |\n1 | fn `() {}\n  |    ^\n"),
        ("lagrangian! {\n    L = x²;\n}\n", ":2:10\n  |\n2 |     L = x²;\n  |          ^\n  = help: write `^2`\n"),
        ("lagrangian! {\n    L = (x;\n}\n", ":3:1\n  |\n3 | }\n  | ^\n  = help: write `)` before it, or remove one\n"),
    ] {
        fs::write(&file, text).expect("the file");
        let (status, output, errors) = lab(&["expand", path(&file)]);
        assert_eq!((status, output.as_str()), (Some(1), ""), "{errors}");
        assert!(errors.ends_with(message), "{errors}");
    }
    // For any nesting depth, and any number of mistakes in one line.
    let nested = format!("lagrangian! {{ struct A {{ L = {}1{}; }} }}", "(".repeat(12_000), ")".repeat(12_000));
    let unused = (0..4000).map(|i| format!("param a{i} = 1; ")).collect::<Vec<_>>().concat();
    let many = format!("lagrangian! {{ struct A {{ {unused} coord x; L = dot(x)^2; discretize midpoint; }} }}");
    for (text, message) in [(nested, "error: this expression is nested"), (many, "error: 3970 more mistakes are not")] {
        fs::write(&file, text).expect("the file");
        for command in ["expand", "explain"] {
            let (status, output, errors) = lab(&[command, path(&file)]);
            assert_eq!((status, output.as_str()), (Some(1), ""), "{command}");
            assert!(errors.contains(message) && errors.len() < 20_000, "{} bytes", errors.len());
        }
    }
    fs::remove_file(&file).expect("the file can be removed");
    let (status, _, errors) = lab(&["expand", path(&file)]);
    assert_eq!((status, errors.lines().count()), (Some(2), 1), "{errors}");
}

#[test]
fn a_system_is_explained_in_text_and_in_latex() {
    let text = success(&["explain", "damped-oscillator"]);
    for line in ["    f_x = -c*dot(x)", "    A_x,x = m + k*h^2/4 + c*h/2"] {
        assert!(text.lines().any(|shown| shown == line), "{line}: {text}");
    }
    // The columns are as wide as the longest name.
    assert!(text.lines().any(|shown| shown.split_whitespace().eq(["momentum", "1"])), "{text}");
    let latex = success(&["explain", "DAMPED_Oscillator", "--latex"]);
    assert!(latex.contains("A_{x,x} &= m + \\frac{k h^{2}}{4} + \\frac{c h}{2}"), "{latex}");
    let own = concat!(env!("CARGO_MANIFEST_DIR"), "/../vi-systems/src/damped_oscillator.rs");
    assert_eq!(lab(&["explain", own]).1, text, "a file is explained as a ready system is");
    let text = success(&["explain", "damped-oscillator", "--rule", "gauss", "--stages", "3"]);
    for line in ["    a_12 = 2/9 - sqrt(15)/15", "    F_x_i = -c*x_dot_i - k*x_i", "    E1 = -D3 L_d - g_d⁺"] {
        assert!(text.lines().any(|shown| shown == line), "{line}: {text}");
    }
    let (status, of_two, _) = lab(&["explain", own, "--rule", "gauss"]);
    assert!(status == Some(0) && of_two.contains("\n    b_2 = 1/2\n"), "{of_two}");
    assert_eq!(lab(&["explain", "kepler", "--rule", "gauss", "--stages", "17"]).0, Some(2));
    assert_eq!(lab(&["explain", "kepler", "--stages", "2"]).0, Some(2), "stages are those of a Gauss step");
    let (status, _, errors) = lab(&["explain", "keppler"]);
    assert_eq!((status, errors.as_str()), (Some(2), "error: there is no system `keppler`; did you mean `kepler`?\n"));
}
