//! The results kept of each run, and their columns.
//!
//! In: the entries `keep` and `section` of a scene. Out: a [`Kept`], and the headings of its tables.

use super::chunks::TABLES;
use super::scene::{Cut, Keep, Passing, Sweep};
use vi_erased::Row;
use vi_erased::plan::Plan;
use vi_erased::section::{Direction, Section};
use vi_report::failure::Failure;
use vi_report::numbers::short;
use vi_report::table::csv_field;

/// Minimum number of steps in a period, so that no crossing is missed.
pub(super) const STEPS_OF_A_PERIOD: f64 = 4.0;

/// The column with the largest error of a step.
pub(super) const STEP_ERROR: &str = "step_error";

/// The results kept.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Kept {
    kinds: Vec<Keep>,
    pub(super) section: Option<Section>,
    /// The results kept, in words.
    pub(super) words: String,
    /// The constraints of the system, which add columns to rows.
    constraints: &'static [&'static str],
    /// Whether rows contain the shifted energy.
    is_shifted: bool,
}

impl Kept {
    /// The results requested by the scene.
    ///
    /// # Errors
    /// [`Failure::Input`] if there are none, or no such section.
    pub(super) fn of(
        sweep: &Sweep,
        (coordinates, constraints): (&[&str], &'static [&'static str]),
        plan: &Plan,
    ) -> Result<Self, Failure> {
        let section = sweep.section.as_ref().map(|cut| section(cut, coordinates, plan)).transpose();
        let section = section.map_err(|message| Failure::Input(format!("the section {message}")))?;
        if sweep.keep.is_empty() && section.is_none() {
            return Err(Failure::Input("`keep` is empty; remove it to keep the end of each run".to_owned()));
        }
        let kinds = sweep.keep.iter().map(|keep| format!("{keep:?}").to_lowercase());
        let (section, of_section) = section.unzip();
        let words = kinds.chain(of_section).collect::<Vec<_>>().join(", ");
        Ok(Self { kinds: sweep.keep.clone(), section, words, constraints, is_shifted: plan.shift.is_some() })
    }

    pub(super) fn has(&self, keep: Keep) -> bool {
        self.kinds.contains(&keep)
    }

    /// The results in the order of their columns.
    pub(super) fn in_order(&self) -> impl Iterator<Item = Keep> {
        Keep::ALL.into_iter().filter(|keep| self.has(*keep))
    }

    /// The heading of each of [`TABLES`] that is kept.
    pub(super) fn headings<'a>(
        &self,
        swept: impl Iterator<Item = &'a str>,
        coordinates: &[&str],
    ) -> [Option<String>; TABLES.len()] {
        let nodes = Row::columns(coordinates, self.constraints, self.is_shifted);
        let kept = |keep: Keep| match keep {
            Keep::Ending => ["ending", "steps"].map(str::to_owned).to_vec(),
            Keep::Accuracy => vec![STEP_ERROR.to_owned()],
            Keep::End => nodes.iter().map(|name| format!("end_{name}")).collect(),
            Keep::Extremes => {
                let ranged = coordinates.iter().copied().chain(["H"]);
                ranged.flat_map(|name| ["min", "max"].map(|which| format!("{which}_{name}"))).collect()
            }
            Keep::Energy => ["error_H", "error_E"].map(str::to_owned).to_vec(),
            Keep::Series => Vec::new(),
        };
        let runs: Vec<String> = swept.map(str::to_owned).chain(self.in_order().flat_map(kept)).collect();
        // A crossing is not a node: it has no discrete energies and no h.
        let crossings = &nodes[..nodes.len() - if self.is_shifted { 3 } else { 2 }];
        let heading = |columns: &[String]| {
            let columns = columns.iter().map(|column| csv_field(column));
            core::iter::once("item".to_owned()).chain(columns).collect::<Vec<_>>().join(",")
        };
        [
            Some(heading(&runs)),
            self.section.as_ref().map(|_| heading(crossings)),
            self.has(Keep::Series).then(|| heading(&nodes)),
        ]
    }
}

/// The section of a scene, and the same in words.
fn section(cut: &Cut, coordinates: &[&str], plan: &Plan) -> Result<(Section, String), String> {
    let Cut { coordinate, at, direction, period } = cut;
    match (coordinate, period) {
        (Some(name), None) => {
            let place = coordinates.iter().position(|coordinate| coordinate == name);
            let index = place.ok_or_else(|| {
                format!("names the unknown coordinate `{name}`; the coordinates are {}", coordinates.join(", "))
            })?;
            let at = at.unwrap_or(0.0);
            if !at.is_finite() {
                return Err(format!("must be `at` a finite number, not {at}"));
            }
            let (direction, way) = match direction.unwrap_or(Passing::Rising) {
                Passing::Rising => (Direction::Rising, "rising"),
                Passing::Falling => (Direction::Falling, "falling"),
                Passing::Both => (Direction::Both, "both"),
            };
            let words = format!("section {name} = {}, {way}", short(at));
            Ok((Section::Coordinate { index, at, direction }, words))
        }
        (None, Some(period)) if at.is_none() && direction.is_none() => {
            if period.is_finite() && *period >= STEPS_OF_A_PERIOD * plan.h.abs() {
                let words = format!("section every {} of time", short(*period));
                Ok((Section::Period { start: plan.t, period: *period }, words))
            } else {
                Err(format!("has the period {period}; it must be at least four steps long"))
            }
        }
        _ => Err("is { coordinate = \"x\", at = 0.0, direction = \"rising\" } or { period = 1.0 }".to_owned()),
    }
}
