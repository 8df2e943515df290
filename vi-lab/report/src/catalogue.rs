//! The named systems of the command, each with an initial state: those of the program (`vi_lab::main!`), then the
//! predefined ones.
//!
//! In: lists of systems; a name, in any spelling of case and hyphens. Out: an [`Entry`], or an error with the nearest name.

use crate::entry::Entry;
use crate::failure::Failure;
use crate::input;
use crate::machine::program;
use crate::table::Table;
use std::path::Path;

/// Systems that a program knows.
#[derive(Clone, Copy, Debug)]
pub struct Systems {
    /// The text of the files that declare them.
    pub sources: &'static [&'static str],
    /// The systems.
    pub entries: fn() -> Vec<Entry>,
}

/// The systems of a program, and the ready ones.
#[derive(Clone, Copy, Debug)]
pub struct Catalogue {
    /// The systems of the program; they hide ready ones of the same names.
    pub own: Option<Systems>,
    /// The ready systems.
    pub ready: Systems,
    /// The constructor of systems of files.
    pub of_text: Option<OfText>,
}

/// The system of a file, by its name and its text; or the mistakes of the text, at their places in the file.
pub type OfText = fn(&str, &str) -> Result<Entry, String>;

impl Catalogue {
    /// The text of the files that declare the systems.
    pub fn sources(&self) -> impl Iterator<Item = &'static str> + use<> {
        self.own.into_iter().chain([self.ready]).flat_map(|systems| systems.sources).copied()
    }

    /// All systems in the order of the list.
    #[must_use]
    pub fn entries(&self) -> Vec<Entry> {
        let mut all = self.own.map_or_else(Vec::new, |own| (own.entries)());
        let mut ready = (self.ready.entries)();
        ready.retain(|entry| all.iter().all(|own| own.name != entry.name));
        all.append(&mut ready);
        all
    }

    /// The first system of the program, if there is one.
    #[must_use]
    pub fn own(&self) -> Option<Entry> {
        self.own.and_then(|own| (own.entries)().into_iter().next())
    }

    /// The entry with this name; by default the first one of the program.
    ///
    /// # Errors
    /// As [`Self::find`]; [`Failure::Input`] without a name, if the program has no systems.
    pub fn named(&self, name: Option<&str>) -> Result<Entry, Failure> {
        let first = || self.own().ok_or_else(|| Failure::Input(format!("name a system of `{} list`", program())));
        name.map_or_else(first, |name| self.find(name))
    }

    /// The entry with this name, or the system of a file that ends in `.rs` or `.vi`.
    ///
    /// # Errors
    /// [`Failure::Input`] with the nearest name if there is none, or for a file that cannot be read; [`Failure::System`]
    /// for the mistakes of a file.
    pub fn find(&self, name: &str) -> Result<Entry, Failure> {
        let file = Path::new(name);
        if let Some(of_text) = self.of_text.filter(|_| input::has_systems(file)) {
            let text = input::text(file)?;
            return of_text(name, &text).map_err(|wrong| Failure::System { shown: String::new(), wrong });
        }
        let wanted = plain(name);
        let mut entries = self.entries();
        if let Some(index) = entries.iter().position(|entry| plain(entry.name) == wanted) {
            return Ok(entries.swap_remove(index));
        }
        let near = entries
            .iter()
            .map(|entry| (strsim::jaro_winkler(&plain(entry.name), &wanted), entry))
            .filter(|(likeness, _)| *likeness > 0.75)
            .max_by(|(one, _), (other, _)| one.total_cmp(other));
        let hint = match near {
            Some((_, entry)) => format!("did you mean `{}`?", kebab(entry.name)),
            None if name.contains(['/', '\\', '.']) => {
                "a scene file ends in .toml, a declaration in .rs or .vi".to_owned()
            }
            None => format!("`{} list` shows all systems", program()),
        };
        Err(Failure::Input(format!("there is no system `{name}`; {hint}")))
    }

    /// The catalogue as a table.
    #[must_use]
    pub fn table(&self) -> Table {
        let mut table = Table::new("systems", ["system", "what it is", "parameters", "starts at", "h"]);
        for Entry { name, about, coordinates, parameters, q, v, h, .. } in self.entries() {
            let parameters: Vec<String> = parameters.iter().map(|(name, value)| format!("{name} = {value}")).collect();
            let coordinates = shortened(coordinates.iter().map(ToString::to_string).collect());
            let start = format!("({coordinates}) = ({}), v = ({})", list(&q), list(&v));
            table.row([kebab(name), about.to_owned(), parameters.join(", "), start, h.to_string()]);
        }
        table
    }
}

/// Rejects an entry without a rule for a page that compares steps by a rule.
///
/// # Errors
/// [`Failure::Input`] if the system has no rule.
pub fn with_rule(entry: Entry, page: &str) -> Result<Entry, Failure> {
    if entry.system.has_rule() {
        return Ok(entry);
    }
    let Entry { name, system, .. } = entry;
    let why = if system.has_constraints() {
        format!("which {name} cannot have because of its constraints")
    } else if system.is_first_order() {
        format!("which {name} cannot have, since its `L` is linear in the velocities")
    } else {
        format!("and {name} has none: add `discretize midpoint;` to it")
    };
    Err(Failure::Input(format!("{page} compares steps by a rule, {why}")))
}

fn list(values: &[f64]) -> String {
    shortened(values.iter().map(f64::to_string).collect())
}

/// A short list for a table: of more than four entries the first two and the last.
fn shortened(mut entries: Vec<String>) -> String {
    if entries.len() > 4 {
        entries.splice(2..entries.len() - 1, ["…".to_owned()]);
    }
    entries.join(", ")
}

/// The name of a type on a command line: `double-well` for `DoubleWell`.
#[must_use]
pub fn kebab(name: &str) -> String {
    let mut kebab = String::new();
    for (index, letter) in name.chars().enumerate() {
        if letter.is_uppercase() && index > 0 {
            kebab.push('-');
        }
        kebab.extend(letter.to_lowercase());
    }
    kebab
}

/// A name without case, hyphens and underscores.
fn plain(name: &str) -> String {
    name.chars().filter(|letter| !matches!(letter, '-' | '_' | ' ')).flat_map(char::to_lowercase).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use vi_systems::{DoubleWell, Kepler};

    #[test]
    fn a_list_builds_no_system() {
        let entries = || {
            let build = || panic!("the system of a list is built");
            vec![
                Entry::listed::<DoubleWell, 1>("well", ([0.74], [0.0]), 0.01, build),
                Entry::new::<Kepler, 2>("planet", [0.4, 0.0], [0.0, 2.0], 0.005),
            ]
        };
        let catalogue = Catalogue { own: None, ready: Systems { sources: &[], entries }, of_text: None };
        let shown = catalogue.table().text();
        assert!(shown.contains("double-well") && shown.contains("(x, y) = (0.4, 0), v = (0, 2)"), "{shown}");
        assert!(catalogue.find("double-wel").is_err());
        assert_eq!(catalogue.find("kepler").ok().map(|entry| entry.system.coordinates()), Some(vec!["x", "y"]));
    }
}
