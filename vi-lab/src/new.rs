//! `vi-lab new`: a project with one system, and this command for it.
//!
//! In: a name. Out: a folder with a crate that builds and runs unchanged: a manifest with profiles for fast debug steps
//! and short release builds, a library with one system, a program with this command, and a README of five lines.

use clap::Args;
use std::fs;
use std::path::{Path, PathBuf};
use vi_report::failure::Failure;

/// The command line of `vi-lab new`.
#[derive(Debug, Args)]
pub(crate) struct Arguments {
    /// Name of the crate and of its folder
    #[arg(value_name = "NAME")]
    name: PathBuf,
}

const MANIFEST: &str = include_str!("new/manifest.toml");
const SYSTEMS: &str = include_str!("new/lib.rs");
const PROGRAM: &str = include_str!("new/main.rs");
const README: &str = include_str!("new/README.md");
const IGNORED: &str = "/target\n";

/// Writes the crate.
pub(crate) fn write(Arguments { name: folder }: &Arguments) -> Result<String, Failure> {
    let name = folder.file_name().and_then(|name| name.to_str()).unwrap_or_default();
    if !is_crate_name(name) {
        let allowed = "letters, digits, - and _, the first a letter";
        return Err(Failure::Input(format!("`{}` is not a crate name; use {allowed}", folder.display())));
    }
    if let Some(why) = taken(name) {
        return Err(Failure::Input(format!("`{name}` {why}; choose another name")));
    }
    if folder.exists() {
        return Err(Failure::Input(format!("{} already exists", folder.display())));
    }
    let file = |path: PathBuf, text: &str| {
        fs::write(&path, text).map_err(|error| Failure::File { name: path.display().to_string(), error })
    };
    let source = folder.join("src");
    fs::create_dir_all(&source).map_err(|error| Failure::File { name: source.display().to_string(), error })?;
    file(folder.join("Cargo.toml"), &MANIFEST.replace("NAME", name).replace("LIBRARIES", &libraries()))?;
    file(
        folder.join("README.md"),
        &README.replace("NAME", name).replace("mine::", &format!("{}::", name.replace('-', "_"))),
    )?;
    file(folder.join(".gitignore"), IGNORED)?;
    file(source.join("lib.rs"), SYSTEMS)?;
    file(source.join("main.rs"), &PROGRAM.replace("mine::", &format!("{}::", name.replace('-', "_"))))?;
    Ok(format!(
        "{}: a crate with one system\n\n    cd {0} && cargo run --release -- run --plot motion.svg",
        folder.display()
    ))
}

/// Whether Cargo accepts a name for a crate.
fn is_crate_name(name: &str) -> bool {
    let mut letters = name.chars();
    letters.next().is_some_and(|first| first.is_ascii_alphabetic())
        && letters.all(|letter| letter.is_ascii_alphanumeric() || matches!(letter, '-' | '_'))
}

/// Why a crate cannot have this name: it is a keyword, or the name of another crate in the same build.
fn taken(name: &str) -> Option<&'static str> {
    let word = name.replace('-', "_");
    if matches!(word.as_str(), "core" | "std" | "alloc" | "proc_macro" | "test") {
        return Some("is a standard crate of Rust");
    }
    if syn::parse_str::<syn::Ident>(&word).is_err() {
        return Some("is a keyword of Rust");
    }
    word.starts_with("vi_").then_some("may clash with a dependency: their names begin with vi-")
}

/// The dependencies in the manifest: paths if the source of this command exists, otherwise versions.
fn libraries() -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).parent().filter(|root| root.join("vi-core/Cargo.toml").is_file());
    let line = |name: &str| match root {
        // Rust and TOML escape backslashes and quotes alike.
        Some(root) => format!("{name} = {{ path = {:?} }}", root.join(name).display().to_string()),
        None => format!("{name} = {:?}", env!("CARGO_PKG_VERSION")),
    };
    [line("vi-core"), line("vi-lab")].join("\n")
}

#[cfg(test)]
mod tests {
    use super::{is_crate_name, taken};

    #[test]
    fn names_of_rust_and_of_this_command_are_taken() {
        assert!(
            ["fn", "crate", "self", "async", "std", "core", "vi-core", "vi-lab"]
                .into_iter()
                .all(|name| taken(name).is_some())
        );
        assert!(["mine", "my-system_2", "via"].into_iter().all(|name| taken(name).is_none()));
    }

    #[test]
    fn names_are_those_of_crates() {
        assert!(["mine", "my-system_2", "A"].into_iter().all(is_crate_name));
        assert!(["", "2d", "-a", "a b", "ä", "a/b", "a.b", ".."].into_iter().all(|name| !is_crate_name(name)));
    }
}
