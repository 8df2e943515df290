//! The runs of a sweep.
//!
//! In: the table `[sweep]` of a scene and its system. Out: [`Items`], in which the number k, from 0, determines item k.
//! The grid is the product of all axes with points, the last one fastest, with `samples` runs per point: for n_1 … n_m
//! points, `k = ((i_1 n_2 + i_2) n_3 + …) samples + sample`. Random values of item k use the seed drawn at place k.

use super::axis::Axis;
use super::random::bits;
use super::scene::Sweep;
use crate::run::placement::Placement;
use vi_erased::System;
use vi_erased::plan::Plan;
use vi_report::failure::Failure;

/// Counts are below this number, so that float64 represents them exactly.
const MOST: u64 = 1 << 53;

/// All runs of a sweep.
#[derive(Clone, Debug)]
pub(crate) struct Items {
    axes: Vec<Axis>,
    samples: u64,
    seed: u64,
    count: u64,
    placement: Placement,
}

impl Items {
    /// The runs of a scene.
    ///
    /// # Errors
    /// [`Failure::Input`] for the first wrong entry.
    pub(crate) fn of(sweep: &Sweep, system: &dyn System) -> Result<Self, Failure> {
        let wrong = |message: &str| Err(Failure::Input(message.to_owned()));
        let axes = (0..).zip(&sweep.over).map(|(place, over)| Axis::of(over, place, system));
        let axes: Vec<Axis> = axes.collect::<Result<_, _>>()?;
        if axes.is_empty() {
            return wrong(
                "the sweep varies nothing; add an entry to `over`, such as { name = \"h\", values = [0.1, 0.2] }",
            );
        }
        let repeated =
            (1..axes.len()).find(|last| axes[..*last].iter().any(|axis| axis.quantity == axes[*last].quantity));
        if let Some(axis) = repeated.and_then(|index| axes.get(index)) {
            return Err(Failure::Input(format!("the sweep varies `{}` twice", axis.name)));
        }
        let is_random = axes.iter().any(|axis| axis.points().is_none());
        let samples = match (is_random, sweep.samples) {
            (true, Some(samples)) if samples > 0 => samples,
            (true, _) => {
                return wrong("the sweep has random values: set their number, such as samples = 100");
            }
            (false, Some(_)) => return wrong("the sweep has `samples`, but no random values"),
            (false, None) => 1,
        };
        let count = axes.iter().filter_map(Axis::points).try_fold(samples, u64::checked_mul);
        let Some(count) = count.filter(|count| *count < MOST) else {
            return wrong("the sweep has more runs than can be counted; give fewer values");
        };
        Ok(Self { axes, samples, seed: sweep.seed, count, placement: Placement::default() })
    }

    /// The same runs, with initial states that follow from the parameters or move onto the constraints.
    pub(crate) fn with_placement(self, placement: Placement) -> Self {
        Self { placement, ..self }
    }

    /// The number of runs.
    pub(crate) fn count(&self) -> u64 {
        self.count
    }

    /// Names of the quantities.
    pub(super) fn names(&self) -> impl Iterator<Item = &str> {
        self.axes.iter().map(|axis| axis.name.as_str())
    }

    /// The values of the quantities in a run.
    pub(super) fn values(&self, item: u64) -> Vec<f64> {
        let seed = bits(self.seed, item);
        let mut rest = item / self.samples;
        let value = |axis: &Axis| {
            let Some(points) = axis.points() else { return axis.draw(seed) };
            let index = rest % points;
            rest /= points;
            axis.point(index)
        };
        let mut values: Vec<f64> = self.axes.iter().rev().map(value).collect();
        values.reverse();
        values
    }

    /// Sets a system and a plan to the values of a run.
    pub(crate) fn set(&self, item: u64, system: &mut dyn System, plan: &mut Plan) {
        let values = self.values(item);
        // The initial state follows from the parameters, then its own axes change it.
        let set = |system: &mut dyn System, plan: &mut Plan| {
            for (axis, value) in self.axes.iter().zip(&values) {
                axis.quantity.set(*value, system, plan);
            }
        };
        set(system, plan);
        self.placement.follow(system, plan);
        set(system, plan);
    }

    /// The same, and moves the initial state onto the constraints if the sweep asks for it. A state that cannot move
    /// stays, and its run is refused.
    pub(crate) fn set_and_project(&self, item: u64, system: &mut dyn System, plan: &mut Plan) {
        self.set(item, system, plan);
        let _ = self.placement.project(system, plan);
    }

    /// Descriptions of the quantities and of the random numbers.
    pub(super) fn words(&self) -> Vec<String> {
        let axes = self.axes.iter().map(Axis::to_string);
        let is_random = self.axes.iter().any(|axis| axis.points().is_none());
        let random = is_random.then(|| format!("{} samples of seed {}", self.samples, self.seed));
        axes.chain(random).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::super::random::uniform;
    use super::*;
    use crate::ready;

    fn items(text: &str) -> Result<Items, String> {
        let sweep: Sweep = toml::from_str(text).map_err(|error| error.message().to_owned())?;
        let entry = ready().find("kepler").unwrap_or_else(|failure| panic!("{failure}"));
        Items::of(&sweep, entry.system.as_ref()).map_err(|failure| failure.to_string())
    }

    const MIXED: &str = "over = [{ name = \"mu\", values = [1, 2] }, { name = \"v_y\", uniform = [0, 1] }, \
                         { name = \"x\", from = 0, to = 1, count = 3 }]\nsamples = 2\nseed = 5";

    #[test]
    fn the_last_axis_and_then_samples_are_fastest() {
        let items = items(MIXED).unwrap_or_else(|message| panic!("{message}"));
        assert_eq!(items.count(), 12);
        let grid: Vec<(f64, f64)> =
            (0..12).map(|item| items.values(item)).map(|values| (values[0], values[2])).collect();
        let each = [(1.0, 0.0), (1.0, 0.5), (1.0, 1.0), (2.0, 0.0), (2.0, 0.5), (2.0, 1.0)];
        assert_eq!(grid, each.into_iter().flat_map(|point| [point, point]).collect::<Vec<_>>());
        let mut drawn: Vec<f64> = (0..12).map(|item| items.values(item)[1]).collect();
        drawn.sort_by(f64::total_cmp);
        drawn.dedup();
        assert_eq!(drawn.len(), 12, "each run has a draw of its own");
        assert_eq!(
            items.words(),
            ["mu = 1, 2", "v_y random from 0 to 1", "x from 0 to 1, 3 values", "2 samples of seed 5"]
        );
    }

    #[test]
    fn an_item_depends_on_its_number_alone() {
        let whole = items(MIXED).unwrap_or_else(|message| panic!("{message}"));
        let forward: Vec<Vec<f64>> = (0..12).map(|item| whole.values(item)).collect();
        let backward: Vec<Vec<f64>> = (0..12).rev().map(|item| whole.values(item)).collect();
        assert!(forward.iter().eq(backward.iter().rev()));
        // By hand: the seed of item 7 is the bits at place 7 of seed 5, and v_y, the axis with index 1, draws at 2.
        assert_eq!(forward[7][1].to_bits(), uniform(bits(5, 7), 2).to_bits());
    }

    #[test]
    fn mistakes_are_named() {
        for (text, message) in [
            (
                "over = []",
                "the sweep varies nothing; add an entry to `over`, such as { name = \"h\", values = [0.1, 0.2] }",
            ),
            ("over = [{ name = \"x\", values = [1] }, { name = \"x\", values = [2] }]", "the sweep varies `x` twice"),
            (
                "over = [{ name = \"x\", uniform = [0, 1] }]",
                "the sweep has random values: set their number, such as samples = 100",
            ),
            ("over = [{ name = \"x\", values = [1] }]\nsamples = 3", "the sweep has `samples`, but no random values"),
            (
                "over = [{ name = \"x\", from = 0, to = 1, count = 1e10 }, { name = \"y\", from = 0, to = 1, count = 1e10 }]",
                "the sweep has more runs than can be counted; give fewer values",
            ),
            (
                "over = [{ name = \"x\", value = [1] }]",
                "unknown field `value`, expected one of `name`, `values`, `from`",
            ),
            (
                "over = [{ name = \"x\", values = [1] }]\nkeep = [\"energies\"]",
                "unknown variant `energies`, expected one of `ending`, `accuracy`, `end`",
            ),
        ] {
            let found = items(text).err().unwrap_or_default();
            assert!(found.starts_with(message), "{found}");
        }
    }
}
