//! A user's own systems in the command: the program of `vi-lab new`, run unchanged, and its crate.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// Runs a program, and returns exit status, standard output and standard error.
fn run(program: &Path, arguments: &[&str]) -> (Option<i32>, String, String) {
    let Output { status, stdout, stderr } = Command::new(program).args(arguments).output().expect("the command runs");
    let text = |bytes| String::from_utf8(bytes).expect("text");
    (status.code(), text(stdout), text(stderr))
}

fn lab() -> PathBuf {
    PathBuf::from(env!("CARGO_BIN_EXE_vi-lab"))
}

/// The program of a new crate, which Cargo builds as an example of this one.
fn own() -> PathBuf {
    let program = lab().with_file_name("examples").join("own");
    assert!(
        program.is_file(),
        "`cargo test -p vi-lab` builds it, as long as it is not told to build `--test own` alone"
    );
    program
}

#[test]
fn every_tool_knows_the_system() {
    let (status, rows, errors) = run(&own(), &["run"]);
    assert!(status == Some(0) && errors.starts_with("note: the largest error of a step is "), "{errors}");
    assert!(
        rows.contains("\n# command: own run\n")
            && rows.contains("# system: SpringPendulum")
            && rows.contains("\nt,r,θ,p_r,p_θ,H,E,h\n"),
        "{rows}"
    );
    // 1000 steps, the initial node, six comment lines.
    assert_eq!(rows.lines().filter(|line| !line.starts_with('#')).count(), 1002);
    let (_, set, _) = run(&own(), &["run", "spring-pendulum", "--set", "k=80", "--method", "energy", "--steps", "10"]);
    assert!(set.contains("k = 80"), "{set}");
    let (status, list, _) = run(&own(), &["list"]);
    let first = list.lines().nth(3).expect("a row");
    assert!(status == Some(0) && first.contains("spring-pendulum") && list.contains("kepler"), "{list}");
    let (status, text, _) = run(&own(), &["explain"]);
    assert!(status == Some(0) && text.starts_with("SpringPendulum\n") && text.contains("p_θ = m*r^2*dot(θ)"), "{text}");
    let (status, _, errors) = run(&own(), &["run", "spring-pendulun"]);
    assert_eq!(status, Some(2));
    assert_eq!(errors, "error: there is no system `spring-pendulun`; did you mean `spring-pendulum`?\n");
}

#[test]
fn a_new_crate_has_what_it_needs() {
    let folder = std::env::temp_dir().join(format!("vi-lab-new-{}", std::process::id()));
    fs::create_dir_all(&folder).expect("a folder");
    let name = folder.join("mine");
    let (status, text, errors) = run(&lab(), &["new", name.to_str().expect("text")]);
    assert_eq!((status, errors.as_str()), (Some(0), ""));
    assert!(text.contains("cargo run --release -- run --plot motion.svg"), "{text}");
    let manifest = fs::read_to_string(name.join("Cargo.toml")).expect("a manifest");
    let manifest: toml::Table = manifest.parse().expect("TOML");
    assert_eq!(manifest["package"]["name"].as_str(), Some("mine"));
    for library in ["vi-core", "vi-lab"] {
        let path = manifest["dependencies"][library]["path"].as_str().expect("a path");
        assert!(Path::new(path).join("Cargo.toml").is_file(), "{path}");
    }
    let source = |file: &str| fs::read_to_string(name.join("src").join(file)).expect("a source");
    assert!(source("lib.rs").contains("lagrangian!") && source("main.rs").contains("use mine::SpringPendulum;"));
    let readme = fs::read_to_string(name.join("README.md")).expect("a README");
    assert!(readme.starts_with("# mine\n") && !readme.contains("NAME"));
    let other = folder.join("my-own");
    let (status, text, errors) = run(&lab(), &["new", other.to_str().expect("text"), "--python"]);
    assert_eq!((status, errors.as_str()), (Some(0), ""));
    assert!(text.ends_with("\n    pip install .\n"), "{text}");
    let read = |file: &str| fs::read_to_string(other.join(file)).unwrap_or_else(|error| panic!("{file}: {error}"));
    assert!(read("src/main.rs").contains("use my_own::SpringPendulum;"));
    let manifest: toml::Table = read("Cargo.toml").parse().expect("TOML");
    assert_eq!(manifest["dependencies"]["vi-lab"]["optional"].as_bool(), Some(true));
    assert_eq!(manifest["bin"][0]["required-features"][0].as_str(), Some("command"));
    let module: toml::Table = read("python/Cargo.toml").parse().expect("TOML");
    assert_eq!(module["lib"]["name"].as_str(), Some("my_own"));
    assert_eq!(module["dependencies"]["systems"]["package"].as_str(), Some("my-own"));
    let path = module["dependencies"]["vi-python"]["path"].as_str().expect("a path");
    assert!(Path::new(path).join("Cargo.toml").is_file(), "{path}");
    assert!(read("python/src/lib.rs").contains("fn my_own(") && read("src/lib.rs").contains("vi_erased::kind!"));
    let written = ["Cargo.toml", "pyproject.toml", "README.md", "python/Cargo.toml", "python/src/lib.rs"].map(read);
    assert!(
        written.iter().all(|text| !["NAME", "MODULE", "LIBRARIES", "PACKAGE"].iter().any(|word| text.contains(word)))
    );
    // Existing files are not overwritten.
    let (status, _, errors) = run(&lab(), &["new", name.to_str().expect("text")]);
    assert_eq!((status, errors), (Some(2), format!("error: {} already exists\n", name.display())));
    for wrong in ["2d", "a b", "ä", ".."] {
        let (status, output, errors) = run(&lab(), &["new", wrong]);
        assert_eq!((status, output.as_str()), (Some(2), ""), "{wrong}");
        assert!(errors.contains("is not a crate name"), "{errors}");
    }
    fs::remove_dir_all(&folder).expect("the folder goes");
}
