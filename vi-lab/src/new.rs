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
    /// Also a Python module of the systems, for `pip install .`
    #[arg(long)]
    python: bool,
}

const MANIFEST: &str = include_str!("new/manifest.toml");
const SYSTEMS: &str = include_str!("new/lib.rs");
const PROGRAM: &str = include_str!("new/main.rs");
const README: &str = include_str!("new/README.md");
const IGNORED: &str = "target\n";

/// The additional files of a Python module.
mod python {
    pub(super) const FEATURES: &str = include_str!("new/python/features.toml");
    pub(super) const SYSTEMS: &str = include_str!("new/python/systems.rs");
    pub(super) const MODULE: &str = include_str!("new/python/module.rs");
    pub(super) const MANIFEST: &str = include_str!("new/python/manifest.toml");
    pub(super) const PROJECT: &str = include_str!("new/python/pyproject.toml");
    pub(super) const README: &str = include_str!("new/python/README.md");
}

/// Writes the crate.
pub(crate) fn write(Arguments { name: folder, python }: &Arguments) -> Result<String, Failure> {
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
    for (path, text) in files(name, *python) {
        let path = folder.join(path);
        let failed = |error| Failure::File { name: path.display().to_string(), error };
        path.parent().map_or(Ok(()), fs::create_dir_all).and_then(|()| fs::write(&path, text)).map_err(failed)?;
    }
    let also = if *python { "\n    pip install ." } else { "" };
    Ok(format!(
        "{}: a crate with one system\n\n    cd {0} && cargo run --release -- run --plot motion.svg{also}",
        folder.display()
    ))
}

/// The files of a crate, by their paths.
fn files(name: &str, with_python: bool) -> Vec<(&'static str, String)> {
    let module = name.replace('-', "_");
    let filled = |text: &str| {
        let text = text.replace("mine::", &format!("{module}::")).replace("fn mine", &format!("fn {module}"));
        text.replace("NAME", name).replace("MODULE", &module).replace("PACKAGE", &package())
    };
    let mut manifest = filled(MANIFEST).replace("LIBRARIES", &libraries(&["vi-core", "vi-lab"]));
    let (mut readme, mut systems) = (filled(README), SYSTEMS.to_owned());
    let mut files = vec![("src/main.rs", filled(PROGRAM)), (".gitignore", IGNORED.to_owned())];
    if with_python {
        let libraries_of = |names| libraries(names);
        let of_module = libraries_of(&["vi-erased"]).replace(" }", ", optional = true }");
        manifest =
            manifest.replace(&libraries(&["vi-lab"]), &libraries(&["vi-lab"]).replace(" }", ", optional = true }"));
        manifest = manifest.replace("\n\n# Debug", &format!("\n{of_module}\n\n{}\n# Debug", filled(python::FEATURES)));
        readme += &filled(python::README);
        systems += python::SYSTEMS;
        files.push(("pyproject.toml", filled(python::PROJECT)));
        let libraries = libraries_of(&["python/vi-python"]);
        files.push(("python/Cargo.toml", filled(python::MANIFEST).replace("LIBRARIES", &libraries)));
        files.push(("python/src/lib.rs", filled(python::MODULE)));
    }
    files.extend([("Cargo.toml", manifest), ("README.md", readme), ("src/lib.rs", systems)]);
    files
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

/// The checkout that this command was built from, if it is there.
fn checkout() -> Option<&'static Path> {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().filter(|root| root.join("vi-core/Cargo.toml").is_file())
}

/// The source of the package `variational` for pip.
fn package() -> String {
    checkout().map_or_else(|| "variational".to_owned(), |root| root.join("python").display().to_string())
}

/// The dependencies in a manifest, by their folders: paths if the source of this command exists, otherwise versions.
fn libraries(folders: &[&str]) -> String {
    let line = |folder: &&str| {
        let name = folder.rsplit('/').next().unwrap_or(folder);
        match checkout() {
            // Rust and TOML escape backslashes and quotes alike.
            Some(root) => format!("{name} = {{ path = {:?} }}", root.join(folder).display().to_string()),
            None => format!("{name} = {{ version = {:?} }}", env!("CARGO_PKG_VERSION")),
        }
    };
    folders.iter().map(line).collect::<Vec<_>>().join("\n")
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
