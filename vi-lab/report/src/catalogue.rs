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

/// The systems of a program of one's own, if it has some, and the ready ones.
#[derive(Clone, Copy, Debug)]
pub struct Catalogue {
    own: Option<Systems>,
    ready: Systems,
    of_text: Option<OfText>,
}

/// The system of a file, by its name and its text; or the mistakes of the text, at their places in the file.
pub type OfText = fn(&str, &str) -> Result<Entry, String>;

impl Catalogue {
    /// The catalogue of a program without systems of its own.
    #[must_use]
    pub fn new(ready: Systems) -> Self {
        Self { own: None, ready, of_text: None }
    }

    /// The same, with systems of one's own.
    #[must_use]
    pub fn with_own(self, own: Systems) -> Self {
        Self { own: Some(own), ..self }
    }

    /// The same, with systems of files.
    #[must_use]
    pub fn with_texts(self, of_text: OfText) -> Self {
        Self { of_text: Some(of_text), ..self }
    }

    /// The text of the files that declare the systems.
    pub fn sources(&self) -> impl Iterator<Item = &'static str> + use<> {
        let own = self.own.map_or(&[][..], |own| own.sources);
        own.iter().chain(self.ready.sources).copied()
    }

    /// All systems in the order of the list; a system of the program hides a predefined one of the same name.
    #[must_use]
    pub fn entries(&self) -> Vec<Entry> {
        let mut all = self.own.map_or_else(Vec::new, |own| (own.entries)());
        let own: Vec<&str> = all.iter().map(|entry| entry.name).collect();
        let ready = (self.ready.entries)();
        let others: Vec<Entry> = ready.into_iter().filter(|entry| !own.contains(&entry.name)).collect();
        all.extend(others);
        all
    }

    /// The first system of the program, if there is one.
    #[must_use]
    pub fn own(&self) -> Option<Entry> {
        self.own.and_then(|own| (own.entries)().into_iter().next())
    }

    /// The first system of the program: the default of every command.
    ///
    /// # Errors
    /// [`Failure::Input`] if the program has none.
    pub fn first_own(&self) -> Result<Entry, Failure> {
        self.own().ok_or_else(|| Failure::Input(format!("name a system of `{} list`", program())))
    }

    /// The entry with this name, or the first one of the program.
    ///
    /// # Errors
    /// As [`Self::find`] and [`Self::first_own`].
    pub fn named(&self, name: Option<&str>) -> Result<Entry, Failure> {
        name.map_or_else(|| self.first_own(), |name| self.find(name))
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
    let name = entry.name;
    if entry.system.has_constraints() {
        return Err(Failure::Input(format!(
            "{page} compares steps by a rule, which {name} cannot have because of its constraints"
        )));
    }
    if entry.system.is_first_order() {
        return Err(Failure::Input(format!(
            "{page} compares steps by a rule, which {name} cannot have, since its `L` is linear in the velocities"
        )));
    }
    Err(Failure::Input(format!(
        "{page} compares steps by a rule, and {name} has none: add `discretize midpoint;` to it"
    )))
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

    fn catalogue() -> Catalogue {
        let entries = || {
            vec![
                Entry::new::<DoubleWell, 1>("well", [0.74], [0.0], 0.01),
                Entry::new::<Kepler, 2>("planet", [0.4, 0.0], [0.0, 2.0], 0.005),
            ]
        };
        Catalogue::new(Systems { sources: &[], entries })
    }

    #[test]
    fn names_are_found_in_any_spelling() {
        for name in ["double-well", "DoubleWell", "double_well", "DOUBLEWELL"] {
            assert!(catalogue().find(name).is_ok_and(|entry| entry.name == "DoubleWell"), "{name}");
        }
    }

    #[test]
    fn a_list_builds_no_system() {
        let entries = || {
            let build = || panic!("the system of a list is built");
            vec![
                Entry::listed::<DoubleWell, 1>("well", ([0.74], [0.0]), 0.01, build),
                Entry::new::<Kepler, 2>("planet", [0.4, 0.0], [0.0, 2.0], 0.005),
            ]
        };
        let catalogue = Catalogue::new(Systems { sources: &[], entries });
        let shown = catalogue.table().text();
        assert!(shown.contains("double-well") && shown.contains("(x, y) = (0.4, 0), v = (0, 2)"), "{shown}");
        assert!(catalogue.find("double-wel").is_err());
        assert_eq!(catalogue.find("kepler").ok().map(|entry| entry.system.coordinates()), Some(vec!["x", "y"]));
    }

    #[test]
    fn a_near_name_is_offered() {
        let message = |name: &str| catalogue().find(name).err().map(|failure| failure.to_string());
        assert_eq!(
            message("double-wel").as_deref(),
            Some("there is no system `double-wel`; did you mean `double-well`?")
        );
        assert_eq!(
            message("folder/xyz.yml").as_deref(),
            Some("there is no system `folder/xyz.yml`; a scene file ends in .toml, a declaration in .rs or .vi")
        );
        let listed = format!("there is no system `xyz`; `{} list` shows all systems", program());
        assert_eq!(message("xyz"), Some(listed));
    }
}
