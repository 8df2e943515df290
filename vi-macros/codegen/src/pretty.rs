//! Expansions as readable files.
//!
//! In: the items of a system. Out: formatted text and, given a folder, a file in it named after the system. Nothing is
//! written unless requested.

use proc_macro2::TokenStream;
use std::path::{Path, PathBuf};
use std::{fs, io};

/// Items as formatted text.
///
/// # Errors
/// Tokens that are not Rust items: a bug of this compiler.
pub fn text(items: TokenStream) -> syn::Result<String> {
    Ok(spaced(&prettyplease::unparse(&syn::parse2(items)?)))
}

/// Adds an empty line after each item of the file, of the scope and of an `impl`, except the last.
fn spaced(text: &str) -> String {
    let mut spaced = String::new();
    let mut last = "";
    for line in text.lines() {
        let indent = |line: &str| line.len() - line.trim_start().len();
        let uses = |line: &str| line.trim_start().starts_with("use ");
        let ends = matches!(last.trim_start(), "}" | "};")
            || (last.ends_with(';') && line.trim_start().starts_with("///"))
            || (uses(last) && !uses(line));
        if ends && indent(line) == indent(last) && indent(line) <= 8 && line.trim() != "}" {
            spaced.push('\n');
        }
        spaced.extend([line, "\n"]);
        last = line;
    }
    spaced
}

/// Writes the expansion of a system into a folder, which it creates if necessary: `Double2Well` as `double2_well.rs`.
/// Returns the path of the file.
///
/// # Errors
/// The errors of the file system.
pub fn write(folder: &Path, system: &str, text: &str) -> io::Result<PathBuf> {
    fs::create_dir_all(folder)?;
    let path = folder.join(snake_case(system)).with_extension("rs");
    fs::write(&path, text)?;
    Ok(path)
}

/// The name of a type as a file or module name: `DoubleWell` as `double_well`, `FPUTChain` as `fput_chain`.
#[must_use]
pub fn snake_case(name: &str) -> String {
    let letters: Vec<char> = name.trim_start_matches("r#").chars().collect();
    let mut words = String::new();
    for (index, letter) in letters.iter().enumerate() {
        let before = index.checked_sub(1).and_then(|before| letters.get(before));
        let ends_word = before.is_some_and(|before| before.is_lowercase() || before.is_numeric());
        let begins_word = before.is_some_and(|before| before.is_uppercase())
            && letters.get(index + 1).is_some_and(|after| after.is_lowercase());
        if letter.is_uppercase() && (ends_word || begins_word) {
            words.push('_');
        }
        words.extend(letter.to_lowercase());
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_become_words() {
        let cases = [
            ("DoubleWell", "double_well"),
            ("FPUTChain", "fput_chain"),
            ("Kepler", "kepler"),
            ("Pendulum2D", "pendulum2_d"),
            ("already_snake", "already_snake"),
            ("ΩRing", "ω_ring"),
            ("r#Match", "match"),
        ];
        for (name, wanted) in cases {
            assert_eq!(snake_case(name), wanted);
        }
    }
}
