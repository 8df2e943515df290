//! The command `vi-lab` as a user meets it: output, exit status, messages, files.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// Runs the command, and returns exit status, standard output and standard error.
fn lab(arguments: &[&str]) -> (Option<i32>, String, String) {
    let Output { status, stdout, stderr } =
        Command::new(env!("CARGO_BIN_EXE_vi-lab")).args(arguments).output().expect("the command runs");
    let text = |bytes| String::from_utf8(bytes).expect("text");
    (status.code(), text(stdout), text(stderr))
}

/// A file of this test in the folder for temporary files.
fn temporary(name: &str) -> PathBuf {
    std::env::temp_dir().join(format!("vi-lab-{}-{name}", std::process::id()))
}

/// The lines of a CSV file without comments and head, as numbers.
fn rows(csv: &str) -> Vec<Vec<f64>> {
    let lines = csv.lines().filter(|line| !line.starts_with('#')).skip(1);
    lines.map(|line| line.split(',').map(|number| number.parse().expect("a number")).collect()).collect()
}

fn path(path: &Path) -> &str {
    path.to_str().expect("a path of text")
}

#[test]
fn the_list_names_every_system_with_its_parameters() {
    let (status, list, errors) = lab(&["list"]);
    assert_eq!((status, errors.as_str()), (Some(0), ""));
    for name in ["double-well", "damped-oscillator", "kepler", "spherical-pendulum", "charged-particle"] {
        assert!(list.contains(name), "{name} is missing");
    }
    assert!(list.contains("m = 1, k = 4, c = 0.04"), "{list}");
}

#[test]
fn both_methods_write_csv_to_standard_output() {
    for (method, first, tolerance) in [("fixed", 0.0, 2e-8), ("energy", 0.005, 1e-16)] {
        let (status, csv, errors) = lab(&["run", "double-well", "--method", method, "--steps", "500"]);
        assert_eq!((status, errors.as_str()), (Some(0), ""), "{method}");
        assert!(
            csv.starts_with("# vi-lab ")
                && csv.contains(&format!("# command: vi-lab run double-well --method {method}"))
        );
        assert!(csv.contains("\n# parameters: m = 1\n") && csv.contains("\nt,q,p_q,energy,h\n"), "{csv}");
        let rows = rows(&csv);
        assert_eq!(rows.len(), 501);
        assert!((rows[0][0] - first).abs() < 1e-15, "{method} starts at {}", rows[0][0]);
        let spread = rows[1..].iter().map(|row| (row[3] - rows[1][3]).abs()).fold(0.0, f64::max);
        // Measured: fixed 7.2e-9 (the swing that theory gives), energy 0.
        assert!(spread < tolerance, "{method}: {spread}");
    }
}

#[test]
fn parameters_and_initial_values_are_set() {
    let run = ["run", "harmonic-oscillator", "--h", "0.001", "--until", "0.5"];
    let set = ["--set", "k=9", "--set", "m=4", "--q", "-2", "--v", "0.75"];
    let (status, csv, errors) = lab(&[run.as_slice(), &set].concat());
    assert_eq!((status, errors.as_str()), (Some(0), ""));
    let last = rows(&csv).pop().expect("rows");
    let (omega, t) = (1.5_f64, 0.5);
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
    assert!(errors.starts_with("error: no energy-preserving step leads forward from t = "), "{errors}");
    let written = rows(&fs::read_to_string(&file).expect("the file"));
    // The step of the last row is number 113 or 114: the paper's theory has no solution at step 114 ± 1.
    assert!((112..=115).contains(&written.len()), "{} rows", written.len());
    let last = written.last().expect("rows");
    assert!(errors.contains(&format!("last good state: t = {}, q = [{}]", last[0], last[1])), "{errors}");
    fs::remove_file(&file).expect("the file can be removed");
}

#[test]
fn wrong_input_is_one_line_and_status_2() {
    let missing = temporary("no-such-folder").join("x.csv");
    let cases: [(&[&str], &str); 12] = [
        (&["run", "dubble-well", "--steps", "1"], "there is no system `dubble-well`; did you mean `double-well`?"),
        (&["run", "double-well"], "give the length of the run, --steps N or --until T"),
        (&["run", "double-well", "--steps", "1", "--until", "2"], "give either --steps or --until, not both"),
        (&["run", "double-well", "--steps", "1", "--set", "k=1"], "double-well has no parameter `k`; it has `m`"),
        (&["run", "double-well", "--steps", "1", "--h", "0"], "the step (--h) must not be zero"),
        (
            &["run", "double-well", "--steps", "one"],
            "invalid value 'one' for '--steps <N>': invalid digit found in string",
        ),
        (
            &["run", "double-well", "--steps", "1", "--method", "euler"],
            "invalid value 'euler' for '--method <METHOD>' [possible values: fixed, energy]",
        ),
        (
            &["run", "double-well", "--steps", "1", "--q", "1,2"],
            "double-well needs 1 coordinates (--q), for q; given 2",
        ),
        (&["run", "double-well", "--steps", "1", "-o", "x.txt"], "the output `x.txt` must end in .csv or .npy"),
        (&["run", "none.toml", "--steps", "1"], "none.toml: No such file or directory (os error 2)"),
        (&["run"], "the following required arguments were not provided: <SYSTEM|SCENE.toml>"),
        (&["fly"], "unrecognized subcommand 'fly'"),
    ];
    for (arguments, message) in cases {
        let (status, output, errors) = lab(arguments);
        assert_eq!((status, output.as_str()), (Some(2), ""), "{arguments:?}");
        assert_eq!(errors, format!("error: {message}\n"), "{arguments:?}");
    }
    let (status, _, errors) = lab(&["run", "double-well", "--steps", "1", "-o", path(&missing)]);
    assert_eq!(status, Some(1), "a folder that does not exist is no wrong input");
    assert!(errors.starts_with("error: ") && errors.lines().count() == 1, "{errors}");
}

#[test]
fn npy_holds_the_numbers_of_csv() {
    let (csv, npy) = (temporary("same.csv"), temporary("same.npy"));
    for file in [&csv, &npy] {
        let (status, _, errors) = lab(&["run", "kepler", "--steps", "20", "-o", path(file)]);
        assert_eq!((status, errors.as_str()), (Some(0), ""));
    }
    let bytes = fs::read(&npy).expect("the array");
    assert_eq!(bytes.get(..8), Some(b"\x93NUMPY\x01\x00".as_slice()));
    let length = usize::from(u16::from_le_bytes([bytes[8], bytes[9]]));
    let head = String::from_utf8_lossy(&bytes[10..10 + length]);
    assert!(head.starts_with("{'descr': '<f8', 'fortran_order': False, 'shape': (21, 7), }"), "{head}");
    let numbers: Vec<f64> = bytes[10 + length..]
        .chunks_exact(8)
        .map(|chunk| f64::from_le_bytes(chunk.try_into().expect("eight bytes")))
        .collect();
    let text = fs::read_to_string(&csv).expect("the table");
    assert_eq!(numbers, rows(&text).concat(), "CSV reads back to the same bits");
    let beside = PathBuf::from(format!("{}.json", npy.display()));
    let description: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(&beside).expect("the description")).expect("JSON");
    assert_eq!(description["columns"], serde_json::json!(["t", "x", "y", "p_x", "p_y", "energy", "h"]));
    assert_eq!(description["parameters"], serde_json::json!({"mu": 1.0}));
    for file in [csv, npy, beside] {
        fs::remove_file(file).expect("the file can be removed");
    }
}

#[test]
fn a_scene_is_run_and_the_command_line_overrides_it() {
    let scene = concat!(env!("CARGO_MANIFEST_DIR"), "/../scenes/damped-oscillator.toml");
    let (status, csv, errors) = lab(&["run", scene]);
    assert_eq!((status, errors.as_str()), (Some(0), ""));
    assert!(csv.contains("# parameters: m = 1, k = 4, c = 0.02\n"));
    let last = rows(&csv).pop().expect("rows");
    assert!(last[0] >= 100.0 && last[0] < 100.1, "ends at {}", last[0]);
    // h/h0 at t = 100 for ζ = 0.005, mathematics of the step law: 2.712.
    assert!((last[4] / 0.01 - 2.712).abs() < 5e-4, "{}", last[4]);
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
            let (status, _, errors) = lab(&["run", path(&file), "--steps", "5"]);
            assert_eq!((status, errors.as_str()), (Some(0), ""), "{}", file.display());
            scenes += 1;
        }
    }
    assert!(scenes > 0);
}

#[test]
fn the_map_of_a_system_is_a_page_with_its_files() {
    let out = temporary("stability");
    let (status, output, errors) = lab(&[
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
    assert_eq!((status, errors.as_str()), (Some(0), ""));
    assert_eq!(output.trim(), out.join("index.html").display().to_string());
    for name in ["index.html", "energy.svg", "energy.csv", "fixed.svg", "fixed.csv"] {
        assert!(fs::metadata(out.join(name)).is_ok_and(|file| file.len() > 500), "{name}");
    }
    let csv = fs::read_to_string(out.join("energy.csv")).expect("the cells");
    assert!(csv.contains("# 0: runs to the end\n# 2: no forward step\n") && csv.contains("# curve, D = 0: ("), "{csv}");
    let cells: Vec<&str> = csv.lines().filter(|line| !line.starts_with('#')).collect();
    assert_eq!((cells.len(), cells[0].split(',').count()), (12, 21));
    // Rest at the bottom of the right well runs, a run across the barrier ends.
    let cell =
        |row: usize, column: usize| cells[row + 1].split(',').nth(column + 1).and_then(|cell| cell.parse::<u8>().ok());
    assert_eq!(cell(5, 14), Some(0));
    assert!(cell(10, 14).is_some_and(|class| class > 0));
    fs::remove_dir_all(out).expect("the folder can be removed");
}

#[test]
fn every_method_is_compared_and_a_run_that_ends_says_why() {
    let out = temporary("work-precision");
    // A driven double well: its energy-preserving runs end, the others reach the end.
    let (status, output, errors) = lab(&["work-precision", "double-well-duffing", "--quick", "--out", path(&out)]);
    assert_eq!((status, errors.as_str()), (Some(0), ""));
    let methods = ["fixed step", "Suzuki 4", "Kahan–Li 6", "Kahan–Li 8", "energy-preserving", "DOP853"];
    assert!(methods.iter().all(|method| output.contains(method)), "{output}");
    assert!(output.trim_end().ends_with(path(&out.join("index.html"))), "{output}");
    for name in ["work-precision", "evaluations", "order", "energy"] {
        assert!(fs::metadata(out.join(format!("{name}.svg"))).is_ok_and(|file| file.len() > 5000), "{name}");
        assert!(fs::metadata(out.join(format!("{name}.csv"))).is_ok_and(|file| file.len() > 500), "{name}");
    }
    let runs = fs::read_to_string(out.join("runs.csv")).expect("the runs");
    for method in methods {
        let of: Vec<&str> = runs.lines().filter(|line| line.starts_with(method)).collect();
        let ended = of.iter().filter(|line| line.contains("no energy-preserving step leads forward")).count();
        assert!(of.len() >= 9, "{method}: {} runs", of.len());
        assert_eq!(ended, if method == "energy-preserving" { of.len() } else { 0 }, "{method}");
    }
    let page = fs::read_to_string(out.join("index.html")).expect("the page");
    let said = "All 9 runs of energy-preserving ended early; at h₀ = 0.0050: no energy-preserving step leads forward from t = ";
    assert!(page.contains(said) && page.contains("(debug build") | page.contains("(release build"), "the page says so");
    fs::remove_dir_all(out).expect("the folder can be removed");
}

#[test]
fn wrong_axes_are_status_2() {
    let cases: [(&[&str], &str); 5] = [
        (&["stability", "double-wel"], "there is no system `double-wel`; did you mean `double-well`?"),
        (&["stability", "kepler", "--x", "z=0:1"], "there is no quantity `z` to vary; there are x, y, v_x, v_y, mu, h"),
        (&["stability", "kepler", "--x", "x=1"], "an axis is given as NAME=LOW:HIGH, with LOW below HIGH, not `x=1`"),
        (&["stability", "kepler", "--x", "h=1:2"], "both axes vary `h`; give two different ones with --x and --y"),
        (&["stability", "--columns", "5"], "invalid value '5' for '--columns <N>': 5 is not in 10..=596"),
    ];
    for (arguments, message) in cases {
        let (status, output, errors) = lab(arguments);
        assert_eq!((status, output.as_str()), (Some(2), ""), "{arguments:?}");
        assert_eq!(errors, format!("error: {message}\n"), "{arguments:?}");
    }
    let missing = temporary("stability-file");
    fs::write(&missing, "a file").expect("a file");
    let (status, _, errors) = lab(&["stability", "double-well", "--columns", "10", "--out", path(&missing)]);
    assert_eq!((status, errors.lines().count()), (Some(1), 1), "{errors}");
    fs::remove_file(missing).expect("the file can be removed");
}

#[test]
fn a_file_is_expanded_stage_by_stage() {
    let kepler = concat!(env!("CARGO_MANIFEST_DIR"), "/src/systems/kepler.rs");
    for (stage, line) in [
        ("syntax", "    let r = sqrt(x^2 + y^2);"),
        ("model", "    p_x = dot(x)"),
        ("discrete", "    (D4 L_d)_x = L_v_x + h*L_x/2"),
        ("program", "momentum: 0 operations"),
        ("rust", "impl<T: ::vi_core::Real> ::vi_core::Stepping<2, T> for Kepler<T> {"),
    ] {
        let (status, output, errors) = lab(&["expand", kepler, "--stage", stage]);
        assert_eq!((status, errors.as_str()), (Some(0), ""), "{stage}");
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
    for (text, message) in
        [("fn main() {}\n", "declares no system with `lagrangian!`"), ("fn 1() {}\n", ":1:4: expected identifier")]
    {
        fs::write(&file, text).expect("the file");
        let (status, output, errors) = lab(&["expand", path(&file)]);
        assert_eq!((status, output.as_str()), (Some(2), ""), "{errors}");
        assert!(errors.contains(message) && errors.lines().count() == 1, "{errors}");
    }
    fs::remove_file(&file).expect("the file can be removed");
    let (status, _, errors) = lab(&["expand", path(&file)]);
    assert_eq!((status, errors.lines().count()), (Some(2), 1), "{errors}");
}

#[test]
fn a_system_is_explained_in_text_and_in_latex() {
    let (status, text, errors) = lab(&["explain", "damped-oscillator"]);
    assert_eq!((status, errors.as_str()), (Some(0), ""));
    for line in ["    f_x = -c*dot(x)", "    A_x,x = m + c*h/2 + k*h^2/4", "    momentum               1"] {
        assert!(text.lines().any(|shown| shown == line), "{line}: {text}");
    }
    let (status, latex, errors) = lab(&["explain", "DampedOscillator", "--latex"]);
    assert_eq!((status, errors.as_str()), (Some(0), ""));
    assert!(latex.contains("A_{x,x} &= m + \\frac{c h}{2} + \\frac{k h^{2}}{4}"), "{latex}");
    let own = concat!(env!("CARGO_MANIFEST_DIR"), "/src/systems/damped_oscillator.rs");
    assert_eq!(lab(&["explain", own]).1, text, "a file is explained as a ready system is");
    let (status, _, errors) = lab(&["explain", "keppler"]);
    assert_eq!((status, errors.as_str()), (Some(2), "error: there is no system `keppler`; did you mean `kepler`?\n"));
}
