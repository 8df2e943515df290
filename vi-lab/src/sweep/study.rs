//! A sweep ready to run: the common part of its runs, the varied quantities, and the results kept.

use super::chunks::{Description, fingerprint};
use super::ending::Ending;
use super::items::Items;
use super::keep::Kept;
use super::outcome::{Member, Outcome};
use super::scene::Keep;
use crate::run::{Length, Request, method};
use vi_report::catalogue::Catalogue;
use vi_report::failure::Failure;
use vi_report::machine::VERSION;
use vi_report::numbers::{about, assigned, short};

/// Steps in a chunk: a tenth of a second of fixed steps, much longer than syncing a file.
const STEPS: f64 = 2e5;
/// Maximum number of runs in a chunk.
const MOST_ITEMS: u64 = 1 << 14;
/// Minimum number of chunks, if there are enough runs, so that all cores have work.
const FEWEST_CHUNKS: u64 = 256;
/// Maximum bytes of the series of one run, which is held in memory.
const MOST_BYTES: f64 = 1.6e7;

/// A sweep.
pub(super) struct Study {
    request: Request,
    items: Items,
    kept: Kept,
    /// Fingerprint of the declarations of all systems.
    sources: u64,
}

impl Study {
    /// The sweep of a scene.
    ///
    /// # Errors
    /// [`Failure::Input`] for the first wrong entry.
    pub(super) fn read(scene: &str, catalogue: &Catalogue) -> Result<Self, Failure> {
        let (request, sweep) = Request::with_sweep(scene, catalogue)?;
        let items = Items::of(&sweep, request.system.as_ref())?.with_placement(request.placement);
        let coordinates = request.system.coordinates();
        let kept = Kept::of(&sweep, (&coordinates, request.system.constraints()), &request.plan)?;
        let own: Vec<&str> = catalogue.sources().collect();
        let sources = fingerprint(&own.into_iter().chain(request.text.as_deref()).collect::<Vec<_>>());
        let study = Self { request, items, kept, sources };
        study.check_series()?;
        Ok(study)
    }

    /// Rejects a series that may not fit into memory.
    #[allow(clippy::cast_precision_loss)] // an estimate
    fn check_series(&self) -> Result<(), Failure> {
        let columns = self.request.columns().len() + 1;
        let rows = self.request.length.steps(&self.request.plan) / self.request.every as f64;
        let bytes = 8.0 * rows * columns as f64;
        if !self.kept.has(Keep::Series) || bytes <= MOST_BYTES {
            return Ok(());
        }
        let every = (self.request.every as f64 * bytes / MOST_BYTES).ceil();
        Err(Failure::Input(format!(
            "the series of each run would have about {} rows, {} MB; keep fewer with every = {} in the scene",
            about(rows),
            about(bytes / 1e6),
            short(every)
        )))
    }

    /// All inputs of its tables.
    pub(super) fn description(&self) -> Description {
        let Request { system, plan, length, every, .. } = &self.request;
        let items = self.items.count();
        let balanced = items.div_ceil(FEWEST_CHUNKS).clamp(1, MOST_ITEMS);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // at least 1
        let chunk = balanced.min((STEPS / length.steps(plan).max(1.0)).max(1.0) as u64);
        let length = match length {
            Length::Steps(steps) => format!("{steps} steps"),
            Length::Until(end) => format!("until t = {}", short(*end)),
        };
        let facts = [
            ("vi-lab", VERSION.to_owned()),
            ("system", system.name().to_owned()),
            ("sources", format!("{:016x}", self.sources)),
            ("parameters", assigned(&system.parameters())),
            ("method", method::in_words(plan)),
            ("step", format!("h = {}", short(plan.h))),
            ("start", format!("t = {}, q = {:?}, v = {:?}", short(plan.t), plan.q, plan.v)),
            ("length", format!("{length}, series of one node in {every}, and the last")),
            ("sweep", self.items.words().join("; ")),
            ("keep", self.kept.words(&system.coordinates())),
        ];
        let facts = facts.map(|(name, fact)| (name.to_owned(), fact)).to_vec();
        let schemas = self.kept.schemas(self.items.names(), &system.coordinates());
        Description { facts, items, chunk, schemas }
    }

    /// Computes a run, adds its rows to the tables, and returns whether it failed.
    #[allow(clippy::cast_precision_loss)] // items are fewer than 2^53, and so are steps
    pub(super) fn follow(&self, item: u64, tables: &mut [Vec<f64>]) -> bool {
        let number = item as f64;
        let mut tables = tables.iter_mut();
        let Some(runs) = tables.next() else { return false };
        let section = self.kept.section.as_ref().and_then(|section| Some((section, tables.next()?)));
        let mut series = if self.kept.has(Keep::Series) { tables.next() } else { None };

        let member = self.member(item);
        let mut outcome = Outcome::of(&member, &mut |simulation| {
            if let Some(series) = &mut series {
                series.push(number);
                series.extend(simulation.row().entries().map(|entry| entry.unwrap_or(f64::NAN)));
            }
        });
        if let Some((section, crossings)) = section {
            let crossed = outcome.cross(&member, section, &mut |row| {
                // As a node, but for E, E' and h.
                let columns = row.entries().count() - 2;
                crossings.push(number);
                crossings.extend(row.entries().take(columns).map(|entry| entry.unwrap_or(f64::NAN)));
            });
            if outcome.ending == Ending::REACHED && crossed.is_err() {
                outcome.ending = Ending::NO_SECTION;
            }
        }
        runs.push(number);
        runs.extend(self.items.values(item));
        if self.kept.has(Keep::Ending) {
            runs.extend([outcome.ending.number(), outcome.steps as f64]);
        }
        if self.kept.has(Keep::Accuracy) {
            runs.push(outcome.step_error);
        }
        if self.kept.has(Keep::End) {
            runs.extend(outcome.end(self.request.columns().len()));
        }
        if self.kept.has(Keep::Extremes) {
            runs.extend(outcome.extremes());
        }
        if self.kept.has(Keep::Energy) {
            runs.extend(outcome.errors());
        }
        outcome.ending != Ending::REACHED
    }

    /// The run of an item.
    fn member(&self, item: u64) -> Member {
        let Request { system, plan, length, every, .. } = &self.request;
        let mut system = system.copy();
        let mut plan = plan.clone();
        self.items.set_and_project(item, system.as_mut(), &mut plan);
        let is_watched = self.kept.has(Keep::Extremes) || self.kept.has(Keep::Energy);
        let is_measured = self.kept.has(Keep::Accuracy);
        Member { system, plan, length: *length, every: *every, is_watched, is_measured }
    }
}
