//! Systems of a text, which are not compiled.
//!
//! In: the text of a file, or the declaration of a predefined system. Out: an [`Entry`], whose system has the functions
//! of a compiled one.

use vi_core::Lagrangian;
use vi_core::lagrangian::Described;
use vi_report::entry::Entry;

/// A predefined system from the text of its declaration, a description, initial coordinates and velocities, and a step.
pub(crate) fn ready<S, const N: usize>(about: &'static str, start: ([f64; N], [f64; N]), h: f64) -> Entry
where
    S: Lagrangian<N> + Described + Default,
{
    Entry::listed::<S, N>(about, start, h, || {
        let system = vi_tape::System::parse(S::DEFINITION);
        system.unwrap_or_else(|mistakes| panic!("a declaration that was compiled is a text: {mistakes}")).into_inner()
    })
}

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
    Ok(Entry::of(system.into_inner(), [q, v], h, text))
}
