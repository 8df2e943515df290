//! The systems that the command knows by name, each with a place to start from: those of the program that the command stands in
//! ([`crate::main!`]), then the ready ones.
//!
//! In: a name, in any spelling of case and hyphens. Out: an [`Entry`]. The first near name is offered where there is none.

use crate::failure::Failure;
use crate::machine::program;
use crate::system::{self, System};
use crate::table::Table;
use std::sync::OnceLock;
use vi_core::collocation::Collocation;
use vi_core::lagrangian::Parameters;
use vi_core::stepping::{Convertible, EnergyStepping};
use vi_systems::{DampedOscillator, DoublePendulum, DoubleWell, Kepler, Pendulum};

/// The systems of a program of one's own, set once before its command is read.
static OWN: OnceLock<Own> = OnceLock::new();

/// The systems of a program of one's own; [`crate::main!`] writes it.
#[derive(Clone, Copy)]
pub struct Own {
    /// The text of the files that declare them.
    pub sources: &'static [&'static str],
    /// The systems.
    pub entries: fn() -> Vec<Entry>,
}

impl Own {
    /// Makes these systems known to the command.
    pub(crate) fn declare(self) {
        // A second set of systems in one process is none.
        let _ = OWN.set(self);
    }
}

/// A system in the catalogue.
pub struct Entry {
    /// The system, with the default parameters.
    pub(crate) system: Box<dyn System>,
    /// What it is.
    pub(crate) about: &'static str,
    /// Default initial coordinates.
    pub(crate) q: Vec<f64>,
    /// Default initial velocities.
    pub(crate) v: Vec<f64>,
    /// Default step.
    pub(crate) h: f64,
}

impl Entry {
    /// A system with a place to start from: what it is, its initial coordinates and velocities, a step.
    #[must_use]
    pub fn new<S, const N: usize>(about: &'static str, q: [f64; N], v: [f64; N], h: f64) -> Self
    where
        S: EnergyStepping<N> + Collocation<N> + Convertible<N> + Parameters + Default + Clone + Send + Sync + 'static,
    {
        entry::<S, N>(about, q, v, h)
    }
}

fn entry<S, const N: usize>(about: &'static str, q: [f64; N], v: [f64; N], h: f64) -> Entry
where
    S: EnergyStepping<N> + Collocation<N> + Convertible<N> + Parameters + Default + Clone + Send + Sync + 'static,
{
    Entry { system: system::erased::<S, N>(), about, q: q.to_vec(), v: v.to_vec(), h }
}

/// sin(π (i + 1)/17), to three digits: the lowest mode of 16 masses between walls.
#[cfg(not(test))]
const LOWEST_MODE: [f64; 16] =
    [0.184, 0.361, 0.526, 0.674, 0.798, 0.895, 0.962, 0.996, 0.996, 0.962, 0.895, 0.798, 0.674, 0.526, 0.361, 0.184];

/// The figure of eight: coordinates x and y of the bodies, in the digits of C. Simó.
#[cfg(not(test))]
const EIGHT: [f64; 6] =
    [0.970_004_356_697_34, -0.970_004_356_697_34, 0.0, -0.243_087_531_535_83, 0.243_087_531_535_83, 0.0];
/// The velocities: the third body, in the middle, moves against both others.
#[cfg(not(test))]
const EIGHT_V: [f64; 6] = [
    0.466_203_685_720_52,
    0.466_203_685_720_52,
    -0.932_407_371_441_04,
    0.432_365_730_460_51,
    0.432_365_730_460_51,
    -0.864_731_460_921_02,
];

/// The text of the files that declare the systems.
pub(crate) fn sources() -> impl Iterator<Item = &'static str> {
    let own = OWN.get().map_or(&[][..], |own| own.sources);
    own.iter().copied().chain(vi_systems::SOURCES)
}

/// All systems, in the order in which they are listed: one's own hide ready ones of the same name.
pub(crate) fn entries() -> Vec<Entry> {
    let mut all = OWN.get().map_or_else(Vec::new, |own| (own.entries)());
    let own: Vec<&str> = all.iter().map(|entry| entry.system.name()).collect();
    let others: Vec<Entry> = ready().into_iter().filter(|entry| !own.contains(&entry.system.name())).collect();
    all.extend(others);
    all
}

/// The name of the first system of one's own.
pub(crate) fn first_own() -> Result<String, Failure> {
    let first = OWN.get().and_then(|own| (own.entries)().into_iter().next());
    let none = || Failure::Input(format!("name a system, as `{} list` does, or a scene file", program()));
    first.map(|entry| entry.system.name().to_owned()).ok_or_else(none)
}

/// The ready systems.
fn ready() -> Vec<Entry> {
    let rest = [0.0];
    let mut ready = vec![
        entry::<DoubleWell, 1>("particle in a double well: the paper's conservative example", [0.74], rest, 0.01),
        entry::<DampedOscillator, 1>("damped oscillator: the paper's forced example", [1.0], rest, 0.01),
        entry::<Pendulum, 1>("mass on a rod", [1.0], rest, 0.01),
        entry::<Kepler, 2>("planet about a fixed sun, eccentricity 0.6", [0.4, 0.0], [0.0, 2.0], 0.005),
        entry::<DoublePendulum, 2>("two pendula, one hanging from the other", [1.0, 1.0], [0.0, 0.0], 0.005),
    ];
    ready.extend(others());
    ready
}

/// None of the others: the tests of these files do without them, and each takes the compiler ten seconds once more. `tests/command.rs`
/// runs them all.
#[cfg(test)]
fn others() -> [Entry; 0] {
    []
}

/// Those that the tests of these files do without.
#[cfg(not(test))]
fn others() -> [Entry; 12] {
    use vi_systems::{
        ChargedParticle, DoubleWellDuffing, FpuChain, HardDuffing, HarmonicOscillator, HenonHeiles, NPendulum,
        OuterSolarSystem, ParametricPendulum, RotatingHoop, SphericalPendulum, ThreeBody,
    };
    let rest = [0.0];
    let inclined = [0.8, 0.0];
    [
        entry::<HarmonicOscillator, 1>("mass on a spring", [1.0], rest, 0.01),
        entry::<HardDuffing, 1>("driven oscillator with a stiffening spring", [1.0], rest, 0.01),
        entry::<DoubleWellDuffing, 1>("driven double well: chaos", [0.8], rest, 0.01),
        entry::<ParametricPendulum, 1>("pendulum with a modulated gravity", [0.5], rest, 0.01),
        entry::<RotatingHoop, 1>("bead on a rotating hoop", [1.0], rest, 0.01),
        entry::<SphericalPendulum, 2>("mass on a rod in space", inclined, [0.0, 4.0], 0.005),
        entry::<HenonHeiles, 2>("star in a galaxy near its circular orbit", [0.0, 0.1], [0.5, 0.0], 0.02),
        entry::<ChargedParticle, 3>("charge in a magnetic field", [1.0, 0.0, 0.1], [0.0, 1.0, 0.0], 0.01),
        entry::<NPendulum, 4>("four pendula, each hanging from the one above", [0.6, 0.4, 0.2, 0.1], [0.0; 4], 0.005),
        entry::<ThreeBody, 6>("three bodies on a figure of eight, period 6.3259", EIGHT, EIGHT_V, 0.005),
        entry::<FpuChain, 16>("sixteen masses on nonlinear springs, in their lowest mode", LOWEST_MODE, [0.0; 16], 0.1),
        entry::<OuterSolarSystem, 18>(
            "the Sun and five planets; AU, days, solar masses",
            OuterSolarSystem::POSITIONS,
            OuterSolarSystem::VELOCITIES,
            10.0,
        ),
    ]
}

/// The entry of this name.
pub(crate) fn find(name: &str) -> Result<Entry, Failure> {
    let wanted = plain(name);
    let mut entries = entries();
    if let Some(index) = entries.iter().position(|entry| plain(entry.system.name()) == wanted) {
        return Ok(entries.swap_remove(index));
    }
    let near = entries
        .iter()
        .map(|entry| (strsim::jaro_winkler(&plain(entry.system.name()), &wanted), entry))
        .filter(|(likeness, _)| *likeness > 0.75)
        .max_by(|(one, _), (other, _)| one.total_cmp(other));
    let hint = match near {
        Some((_, entry)) => format!("did you mean `{}`?", kebab(entry.system.name())),
        None if name.contains(['/', '\\', '.']) => "the name of a scene file ends in .toml".to_owned(),
        None => format!("`{} list` names them all", program()),
    };
    Err(Failure::Input(format!("there is no system `{name}`; {hint}")))
}

/// The catalogue as a table.
pub(crate) fn table() -> Table {
    let mut table = Table::new("systems", ["system", "what it is", "parameters", "starts at", "h"]);
    for Entry { system, about, q, v, h } in entries() {
        let parameters: Vec<String> =
            system.parameters().iter().map(|(name, value)| format!("{name} = {value}")).collect();
        let coordinates = shortened(system.coordinates().iter().map(ToString::to_string).collect());
        let start = format!("({coordinates}) = ({}), v = ({})", list(&q), list(&v));
        table.row([kebab(system.name()), about.to_owned(), parameters.join(", "), start, h.to_string()]);
    }
    table
}

fn list(values: &[f64]) -> String {
    shortened(values.iter().map(f64::to_string).collect())
}

/// A list that fits in a table: of more than four entries the first two and the last.
fn shortened(mut entries: Vec<String>) -> String {
    if entries.len() > 4 {
        entries.splice(2..entries.len() - 1, ["…".to_owned()]);
    }
    entries.join(", ")
}

/// The name of a type as it is written on a command line: `double-well` for `DoubleWell`.
pub(crate) fn kebab(name: &str) -> String {
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
    use crate::simulation::{Method, PhasePoint, Plan};
    use core::cell::Cell;

    #[test]
    fn names_are_found_in_any_spelling() {
        for name in ["double-well", "DoubleWell", "double_well", "DOUBLEWELL"] {
            assert!(find(name).is_ok_and(|entry| entry.system.name() == "DoubleWell"), "{name}");
        }
    }

    #[test]
    fn a_near_name_is_offered() {
        let message = |name: &str| find(name).err().map(|failure| failure.to_string());
        assert_eq!(
            message("double-wel").as_deref(),
            Some("there is no system `double-wel`; did you mean `double-well`?")
        );
        assert_eq!(
            message("folder/xyz.yml").as_deref(),
            Some("there is no system `folder/xyz.yml`; the name of a scene file ends in .toml")
        );
        let listed = format!("there is no system `xyz`; `{} list` names them all", program());
        assert_eq!(message("xyz"), Some(listed));
    }

    #[test]
    fn every_entry_starts_and_keeps_its_parameters() {
        for mut entry in entries() {
            let size = entry.system.coordinates().len();
            let name = entry.system.name();
            assert_eq!((entry.q.len(), entry.v.len()), (size, size), "{name}");
            for method in [Method::Fixed, Method::KahanLi6, Method::Gauss, Method::Energy] {
                let start = PhasePoint { t: 0.0, q: entry.q.clone(), v: entry.v.clone() };
                let plan = Plan::new(method, entry.h, start);
                let evaluations = Cell::new(0);
                let begun = entry.system.begin(&plan, &evaluations);
                let mut run = begun.unwrap_or_else(|error| panic!("{name}: {error}"));
                let first = run.t();
                for _ in 0..10 {
                    run.advance().unwrap_or_else(|error| panic!("{name}, {method:?}: {error}"));
                }
                assert!(run.t() > first && evaluations.get() > 0, "{name}");
            }
            for (parameter, value) in entry.system.parameters() {
                assert!(entry.system.set(parameter, value + 1.0), "{name}: {parameter}");
            }
            assert!(!entry.system.set("no such parameter", 1.0));
        }
    }
}
