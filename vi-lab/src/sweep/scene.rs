//! The table `[sweep]` of a scene.
//!
//! ```toml
//! [sweep]
//! over = [                                                     # the last one changes fastest
//!     { name = "mu", values = [0.5, 1.0, 2.0] },               # a parameter, a coordinate, v_ and a coordinate, or h
//!     { name = "x", from = 0.1, to = 1.0, count = 10 },        # spacing = "log" for equal ratios
//!     { name = "v_y", uniform = [0.9, 1.1] },                  # log_uniform = [low, high], normal = [mean, deviation]
//! ]
//! samples = 100                                                # runs for each point of the grid, if something is random
//! seed = 1
//! keep = ["ending", "accuracy", "end", "extremes", "energy", "series"]     # without it, the first three
//! section = { coordinate = "y", at = 0.0, direction = "rising" }   # or { period = 6.28 }
//! ```

use crate::entries::count;
use serde::Deserialize;

/// The entries of the table.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Sweep {
    pub(super) over: Vec<Over>,
    /// Runs for each point of the grid.
    #[serde(default, deserialize_with = "count")]
    pub(super) samples: Option<u64>,
    #[serde(default)]
    pub(super) seed: u64,
    #[serde(default = "default_keep")]
    pub(super) keep: Vec<Keep>,
    pub(super) section: Option<Cut>,
}

impl Sweep {
    /// Whether the sweep varies this quantity.
    pub(crate) fn is_over(&self, name: &str) -> bool {
        self.over.iter().any(|over| over.name == name)
    }
}

/// A quantity and its values, in one of five ways.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Over {
    pub(super) name: String,
    pub(super) values: Option<Vec<f64>>,
    pub(super) from: Option<f64>,
    pub(super) to: Option<f64>,
    #[serde(default, deserialize_with = "count")]
    pub(super) count: Option<u64>,
    pub(super) spacing: Option<Spacing>,
    /// Lowest and highest value.
    pub(super) uniform: Option<Vec<f64>>,
    /// Lowest and highest value.
    pub(super) log_uniform: Option<Vec<f64>>,
    /// Mean and standard deviation.
    pub(super) normal: Option<Vec<f64>>,
}

/// The spacing of a range: equal distances or equal ratios.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Spacing {
    Linear,
    Log,
}

/// The results kept of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Keep {
    /// The kind of end, and the number of steps.
    Ending,
    /// The largest error of a step.
    Accuracy,
    /// The last node.
    End,
    /// Smallest and largest values of the coordinates and of H.
    Extremes,
    /// Largest errors of both energies.
    Energy,
    /// Every Nth node, as in the scene.
    Series,
}

impl Keep {
    pub(super) const ALL: [Self; 6] =
        [Self::Ending, Self::Accuracy, Self::End, Self::Extremes, Self::Energy, Self::Series];
}

/// A section: a coordinate crosses a value, or a period of time passes.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Cut {
    pub(super) coordinate: Option<String>,
    pub(super) at: Option<f64>,
    pub(super) direction: Option<Passing>,
    pub(super) period: Option<f64>,
}

/// The direction in which a coordinate crosses a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Passing {
    Rising,
    Falling,
    Both,
}

fn default_keep() -> Vec<Keep> {
    vec![Keep::Ending, Keep::Accuracy, Keep::End]
}
