//! A system of a text, which is not compiled.
//!
//! In: the text of a file. Out: an [`Entry`], whose system has everything that compiled ones have.

use vi_report::entry::Entry;

/// The system of a text, which starts at the state of its clause `check`, with the parameters of that clause. Without the
/// clause it starts at zero, with a step of 0.01.
///
/// # Errors
/// The mistakes of the text, at their places in the file of this name.
pub fn entry(file: &str, text: &str) -> Result<Entry, String> {
    let mut system = vi_tape::System::of_file(file, text, &[]).map_err(|mistakes| mistakes.to_string())?;
    let zeros = vec![0.0; system.coordinates().len()];
    let start = system.check().cloned();
    for (name, value) in start.iter().flat_map(|start| &start.parameters) {
        system.set(name, *value);
    }
    let (q, v, h) = start.map_or_else(|| (zeros.clone(), zeros, 0.01), |start| (start.q, start.v, start.h));
    let text = system.files().fold(system.definition().to_owned(), |all, file| all + "\n" + file);
    Ok(Entry { about: system.about(), system: system.into_inner(), q, v, h, text: Some(text) })
}
