//! Misleading inputs and files.

use super::sweep::Folder;
use super::{lab, success};
use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::Command;

#[test]
fn control_characters_are_printed_as_escapes() {
    let folder = Folder::new("escapes", "");
    let assert_rejected = |arguments: &[&str]| {
        let (status, output, errors) = lab(arguments);
        assert_eq!((status, output.as_str()), (Some(2), ""), "{errors:?}");
        let is_raw = errors.contains(|letter: char| letter.is_control() && letter != '\n');
        assert!(!is_raw && errors.contains("\\u{"), "{errors:?}");
    };
    for text in [
        "system = \"\\u001b[31mred\"\n",
        "system = \"kepler\"\n[parameters]\n\"\\u001b]0;title\\u0007\" = 1.0\n",
        "system = \"kepler\"\n\"\\u009b2J\" = 1.0\n",
        "system = \"kepler\"\nmethod = \"\\u001b[2Jfixed\\r\"\n",
    ] {
        assert_rejected(&["run", &folder.file("scene.toml", text)]);
    }
    for command in ["run", "expand"] {
        assert_rejected(&[command, &folder.at("\u{1b}[31mno.toml")]);
    }
    // A mistake in a system shows its lines.
    let text = "lagrangian! { struct P { coord x; L = dot(x)^2 / 2 + y; /* \u{1b}[31m */ discretize midpoint; } }";
    let (status, output, errors) = lab(&["explain", &folder.file("system.rs", text)]);
    assert!(status == Some(1) && !errors.contains('\u{1b}') && !output.contains('\u{1b}'), "{errors:?}");
    assert!(errors.contains("\\u{1b}[31m"), "{errors:?}");
}

/// One run.
const SWEEP: &str = "system = \"kepler\"\nsteps = 1\n[sweep]\nover = [{ name = \"mu\", values = [1.0] }]\n";

#[test]
fn what_is_read_must_be_a_file() {
    let folder = Folder::new("pipes", SWEEP);
    let pipe = |name: &str| {
        let file = folder.at(name);
        let made = Command::new("mkfifo").arg(&file).status().expect("mkfifo runs");
        assert!(made.success());
        file
    };
    let [scene, source, part] = ["a.toml", "a.rs", "a.csv.part"].map(pipe);
    let output = folder.at("a.csv");
    // Each would wait forever for a writer.
    let cases: [(&[&str], &str); 5] = [
        (&["run", &scene], &scene),
        (&["sweep", &scene, "-o", &output], &scene),
        (&["lyapunov", &scene], &scene),
        (&["expand", &source], &source),
        (&["explain", &source], &source),
    ];
    for (arguments, file) in cases {
        let (status, output, errors) = lab(arguments);
        assert_eq!((status, output.as_str()), (Some(2), ""), "{arguments:?}");
        assert_eq!(errors, format!("error: {file} is not a regular file; name a regular file\n"), "{arguments:?}");
    }
    // Chunks are files in a folder.
    let sweep = || lab(&["sweep", &folder.scene(), "-o", &output]);
    let merge = || lab(&["merge", &part, "-o", &output]);
    let refused = |message: String| (Some(2), String::new(), format!("error: {message}\n"));
    assert_eq!(sweep(), refused(format!("{part} is not a folder; remove it, or name another output")));
    let (status, _, errors) = merge();
    assert!(
        status == Some(2) && errors.starts_with(&format!("error: {part} contains no chunks of a sweep: ")),
        "{errors}"
    );
    fs::remove_file(&part).expect("the pipe goes");
    fs::create_dir(&part).expect("a folder");
    let lock = pipe("a.csv.part/lock");
    assert_eq!(sweep(), refused(format!("{lock} is not a regular file; name a regular file")));
    fs::remove_file(lock).expect("the pipe goes");
    let heading = pipe("a.csv.part/sweep.json");
    let no_file = format!("{heading} is not a regular file; name a regular file");
    for assert_rejected in [sweep(), merge()] {
        assert_eq!(assert_rejected, refused(format!("{part} contains no chunks of a sweep: {no_file}")));
    }
    fs::remove_file(heading).expect("the pipe goes");
    // After a shard without chunks the description exists.
    success(&["sweep", &folder.scene(), "-o", &output, "--shard", "0/2"]);
    let chunk = pipe("a.csv.part/0.csv");
    assert_eq!(merge(), refused(format!("{chunk} is not a regular file; name a regular file")));
    let (status, _, errors) = sweep();
    assert_eq!((status, errors.as_str()), (Some(0), ""), "what is no chunk is made again");
}

#[test]
fn a_link_beside_an_output_is_not_followed() {
    let folder = Folder::new("links", SWEEP);
    let victim = folder.file("victim", "mine");
    let link = |name: &str| symlink(&victim, folder.at(name)).expect("a link");
    ["a.csv", "a.csv.tmp"].into_iter().for_each(link);
    success(&["sweep", &folder.scene(), "-o", &folder.at("a.csv")]);
    assert_eq!(folder.text("victim"), "mine");
    assert!(folder.text("a.csv").contains("# system: Kepler\n") && !Path::new(&folder.at("a.csv")).is_symlink());
}
