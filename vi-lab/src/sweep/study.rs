//! A sweep ready to run: the common part of its runs, the varied quantities, and the results kept.

use super::chunks::{Description, Tally, fingerprint};
use super::items::Items;
use super::keep::Kept;
use super::outcome::{Member, NO_SECTION, Outcome, REACHED};
use super::scene::Keep;
use crate::run::csv::{entries, numbers};
use crate::run::{Length, POOR, Request, method};
use core::fmt::Write as _;
use core::num::NonZeroU64;
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
/// Maximum bytes of the series of a chunk, which is held in memory.
const MOST_BYTES: f64 = 3.8e7;
/// Bytes of a number with its comma, measured.
const BYTES: f64 = 19.0;

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
        let (rows, bytes) = self.series();
        if bytes <= MOST_BYTES {
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

    /// Rows and bytes of the series of a run.
    #[allow(clippy::cast_precision_loss)] // an estimate
    fn series(&self) -> (f64, f64) {
        let Request { plan, length, every, .. } = &self.request;
        let rows = if self.kept.has(Keep::Series) { length.steps(plan) / *every as f64 } else { 0.0 };
        (rows, BYTES * rows * (self.request.columns().len() + 1) as f64)
    }

    /// All inputs of its tables.
    pub(super) fn description(&self) -> Description {
        let Request { system, plan, length, every, .. } = &self.request;
        let items = self.items.count();
        let balanced = items.div_ceil(FEWEST_CHUNKS).clamp(1, MOST_ITEMS);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // at least 1
        let chunk = balanced.min((STEPS / length.steps(plan)).min(MOST_BYTES / self.series().1).max(1.0) as u64);
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
            ("keep", self.kept.words.clone()),
        ];
        let facts = facts.map(|(name, fact)| (name.to_owned(), fact)).to_vec();
        let headings = self.kept.headings(self.items.names(), &system.coordinates());
        let chunk = NonZeroU64::MIN.saturating_add(chunk - 1);
        Description { facts, items, chunk, headings }
    }

    /// Computes a run and adds its rows to a text, each after the name of its table.
    pub(super) fn follow(&self, item: u64, text: &mut String) -> Tally {
        let member = self.member(item);
        let has_series = self.kept.has(Keep::Series);
        // Writing to a string cannot fail.
        let mut outcome = Outcome::of(&member, &mut |simulation| {
            if has_series {
                let _ = write!(text, "series,{item}");
                entries(text, numbers(&simulation.row()));
                text.push('\n');
            }
        });
        if let Some(section) = &self.kept.section {
            let crossed = outcome.cross(&member, section, &mut |row| {
                // A crossing has the columns of a node without E, E' and h.
                let columns = row.entries().count() - 2;
                let _ = write!(text, "section,{item}");
                entries(text, numbers(&row).take(columns));
                text.push('\n');
            });
            if outcome.ending == REACHED && crossed.is_err() {
                outcome.ending = NO_SECTION;
            }
        }
        let _ = write!(text, "runs,{item}");
        entries(text, self.items.values(item));
        for keep in self.kept.in_order() {
            match keep {
                Keep::Ending => {
                    let _ = write!(text, ",{},{}", outcome.ending, outcome.steps);
                }
                Keep::Accuracy => entries(text, [outcome.step_error]),
                Keep::End => entries(text, outcome.end(self.request.columns().len())),
                Keep::Extremes => entries(text, outcome.extremes()),
                Keep::Energy => entries(text, outcome.errors()),
                Keep::Series => {}
            }
        }
        text.push('\n');
        // NaN, if no error was measured, is not above it.
        let is_inaccurate = outcome.step_error > POOR;
        Tally { failed: u64::from(outcome.ending != REACHED), inaccurate: u64::from(is_inaccurate) }
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
