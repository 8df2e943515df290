//! Embeds the sources of the crates that a compiled system needs.
//!
//! In: the crates of this repository. Out: `sources.rs` with their files, without tests, under a workspace manifest
//! that has only them; and their digest, which names the folder of a cache. A comment does not change it.

use proc_macro2::{Delimiter, Group, TokenStream, TokenTree};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::{env, fs};

/// The folders of the crates, in the repository.
const CRATES: [&str; 8] = [
    "vi-core",
    "vi-macros",
    "vi-macros/expr",
    "vi-macros/codegen",
    "vi-dispatch",
    "vi-erased",
    "python/vi-fmi",
    "python/vi-python",
];

/// The crates that the package writes: a compiled system, and a unit of FMI.
const WRITTEN: [&str; 2] = ["compiled", "unit"];

fn main() {
    let here = PathBuf::from(env::var("CARGO_MANIFEST_DIR").expect("cargo sets it"));
    let root = here.parent().expect("the repository");
    let mut files = vec![
        ("Cargo.toml".to_owned(), workspace(&read(&root.join("Cargo.toml")), &read(&here.join("Cargo.toml")))),
        ("Cargo.lock".to_owned(), read(&here.join("Cargo.lock"))),
    ];
    for folder in CRATES {
        let path = root.join(folder);
        println!("cargo::rerun-if-changed={}", path.join("src").display());
        files.push((format!("{folder}/Cargo.toml"), manifest(&read(&path.join("Cargo.toml")))));
        walk(&path.join("src"), &format!("{folder}/src"), &mut files);
    }
    for manifest in [root.join("Cargo.toml"), here.join("Cargo.toml"), here.join("Cargo.lock")] {
        println!("cargo::rerun-if-changed={}", manifest.display());
    }
    println!("cargo::rerun-if-changed=build.rs");
    files.sort();
    let mut text = "pub(super) const FILES: &[(&str, &str)] = &[\n".to_owned();
    for (path, content) in &files {
        writeln!(text, "({path:?}, {content:?}),").expect("a string");
    }
    let digest = files.iter().fold(OFFSET, |sum, (path, content)| hash(hash(sum, path), &compiled(path, content)));
    writeln!(text, "];\npub(super) const DIGEST: &str = \"{digest:016x}\";").expect("a string");
    let out = PathBuf::from(env::var("OUT_DIR").expect("cargo sets it"));
    fs::write(out.join("sources.rs"), text).expect("the output folder is writable");
}

/// The start of FNV-1a.
const OFFSET: u64 = 0xcbf2_9ce4_8422_2325;

/// FNV-1a of a text and its end.
fn hash(sum: u64, text: &str) -> u64 {
    text.bytes().chain([0]).fold(sum, |sum, byte| (sum ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

/// The part of a file that affects compilation: its tokens without comments, documentation and tests, also in quoted
/// tokens that the macro emits.
fn compiled(path: &str, content: &str) -> String {
    if path.ends_with(".rs") {
        let tokens = content.parse().unwrap_or_else(|error| panic!("{path}: {error}"));
        compiled_tokens(tokens).to_string()
    } else {
        content.to_owned()
    }
}

fn compiled_tokens(tokens: TokenStream) -> TokenStream {
    let is = |token: &TokenTree, wanted: char| matches!(token, TokenTree::Punct(punct) if punct.as_char() == wanted);
    // The item of an attribute ends with its block or with a semicolon.
    let is_end = |token: &TokenTree| match token {
        TokenTree::Group(group) => group.delimiter() == Delimiter::Brace,
        other => is(other, ';'),
    };
    let mut kept = Vec::new();
    let mut rest = tokens.into_iter().peekable();
    while let Some(token) = rest.next() {
        if is(&token, '#') {
            let inner = rest.next_if(|next| is(next, '!'));
            let attribute = match rest.peek() {
                Some(TokenTree::Group(group)) => group.to_string().split_whitespace().collect(),
                _ => String::new(),
            };
            if attribute.starts_with("[doc=\"") {
                rest.next();
            } else if attribute == "[cfg(test)]" {
                rest.by_ref().find(is_end);
            } else {
                kept.extend([Some(token), inner].into_iter().flatten());
            }
        } else if let TokenTree::Group(group) = &token {
            kept.push(TokenTree::Group(Group::new(group.delimiter(), compiled_tokens(group.stream()))));
        } else {
            kept.push(token);
        }
    }
    kept.into_iter().collect()
}

fn read(path: &Path) -> String {
    fs::read_to_string(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
}

/// The Rust files below a folder, without modules of tests.
fn walk(folder: &Path, name: &str, files: &mut Vec<(String, String)>) {
    for entry in fs::read_dir(folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display())) {
        let path = entry.expect("an entry").path();
        let name = format!("{name}/{}", path.file_name().expect("an entry has a name").to_string_lossy());
        if path.file_stem().is_some_and(|stem| stem == "tests") {
            continue;
        }
        if path.is_dir() {
            walk(&path, &name, files);
        } else if path.extension().is_some_and(|kind| kind == "rs") {
            files.push((name, read(&path)));
        }
    }
}

/// The sections of a manifest, as their header and text.
fn sections(manifest: &str) -> Vec<(&str, String)> {
    let mut sections = vec![("", String::new())];
    for line in manifest.lines().filter(|line| !line.trim_start().starts_with('#')) {
        if line.starts_with('[') {
            sections.push((line, String::new()));
        }
        if let Some((_, text)) = sections.last_mut() {
            *text += line;
            text.push('\n');
        }
    }
    sections
}

/// The manifest of a crate without tests and benchmarks, and without a dependency that the lock file does not have: of
/// members of a workspace it lists optional ones too.
fn manifest(text: &str) -> String {
    let is_kept =
        |header: &str| !["[dev-dependencies", "[[test", "[[bench"].iter().any(|start| header.starts_with(start));
    let text: String = sections(text).into_iter().filter(|(header, _)| is_kept(header)).map(|(_, text)| text).collect();
    let lines = text.lines().filter(|line| !line.starts_with(UNLOCKED));
    lines.map(|line| line.replace(&format!("\"dep:{UNLOCKED}\""), "") + "\n").collect()
}

/// The dependency of the feature `studies` of vi-erased.
const UNLOCKED: &str = "differential-equations";

/// The workspace of a compiled system: versions and lints of the repository, profiles of this crate.
fn workspace(repository: &str, this: &str) -> String {
    let members: Vec<String> = CRATES.iter().chain(&WRITTEN).map(|name| format!("{name:?}")).collect();
    let mut text = format!("[workspace]\nmembers = [{}]\nresolver = \"3\"\n", members.join(", "));
    let of = |manifest: &str, is_kept: fn(&str) -> bool| -> String {
        sections(manifest).into_iter().filter(|(header, _)| is_kept(header)).map(|(_, text)| text).collect()
    };
    text += &of(repository, |header| {
        ["[workspace.package", "[workspace.dependencies", "[workspace.lints"]
            .iter()
            .any(|start| header.starts_with(start))
    });
    text += &of(this, |header| {
        header.starts_with("[profile.") && !header.contains("-python-ready") && !header.contains(".variational-")
    });
    // One unit is as fast to compile as several, and its steps are faster.
    for name in WRITTEN {
        writeln!(text, "[profile.release.package.{name}]\nopt-level = 3\ncodegen-units = 1").expect("a string");
    }
    text
}
