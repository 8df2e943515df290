//! Expansions as files, for whoever wants to read them.
//!
//! In: the items of a system. Out: the text that a formatter makes of them, and, where a folder is given, a file in it
//! that is named after the system. Nothing is written unasked.

use proc_macro2::TokenStream;
use std::path::{Path, PathBuf};
use std::{fs, io};

/// Items as formatted text.
///
/// # Errors
/// Tokens that are no items of Rust: a mistake of this compiler.
pub fn text(items: TokenStream) -> syn::Result<String> {
    Ok(spaced(&prettyplease::unparse(&syn::parse2(items)?)))
}

/// The text with an empty line after each item, of the file, of the scope of the implementations and of an `impl`, but for the last.
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

/// Writes the expansion of a system into a folder, which is made if it is not there: `Double2Well` as `double2_well.rs`.
/// Returns the path of the file.
///
/// # Errors
/// What the file system reports.
pub fn write(folder: &Path, system: &str, text: &str) -> io::Result<PathBuf> {
    fs::create_dir_all(folder)?;
    let path = folder.join(snake_case(system)).with_extension("rs");
    fs::write(&path, text)?;
    Ok(path)
}

/// The name of a type as the name of a file.
#[must_use]
pub fn snake_case(name: &str) -> String {
    let mut snake = String::new();
    for letter in name.trim_start_matches("r#").chars() {
        if letter.is_uppercase() && !snake.is_empty() && !snake.ends_with('_') {
            snake.push('_');
        }
        snake.extend(letter.to_lowercase());
    }
    snake
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_files() {
        for (name, file) in
            [("Kepler", "kepler"), ("DoubleWell", "double_well"), ("θSystem", "θ_system"), ("r#Match", "match")]
        {
            assert_eq!(snake_case(name), file);
        }
    }
}
