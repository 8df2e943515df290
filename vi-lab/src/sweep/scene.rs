//! The table `[sweep]` of a scene, as it is written.
//!
//! ```toml
//! [sweep]
//! over = [                                                     # the last one changes fastest
//!     { name = "mu", values = [0.5, 1.0, 2.0] },               # a parameter, a coordinate, v_ and a coordinate, or h
//!     { name = "x", from = 0.1, to = 1.0, count = 10 },        # spacing = "log" for equal ratios
//!     { name = "v_y", uniform = [0.9, 1.1] },                  # log_uniform = [low, high], normal = [mean, deviation]
//! ]
//! samples = 100                                                # runs for each point of the grid, where something is random
//! seed = 1
//! keep = ["ending", "end", "extremes", "energy", "series"]     # without it, the first two
//! section = { coordinate = "y", at = 0.0, direction = "rising" }   # or { period = 6.28 }
//! ```

use serde::Deserialize;
use vi_report::input::count_of_scene;

/// The entries of the table.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Sweep {
    /// What differs from run to run.
    pub(super) over: Vec<Over>,
    /// Runs for each point of the grid.
    #[serde(default, deserialize_with = "count_of_scene")]
    pub(super) samples: Option<u64>,
    /// What random numbers begin with.
    #[serde(default)]
    pub(super) seed: u64,
    /// What is kept of a run.
    #[serde(default = "usual")]
    pub(super) keep: Vec<Keep>,
    /// The section whose crossings are kept.
    pub(super) section: Option<Cut>,
}

impl Sweep {
    /// Whether it goes over the quantity of this name.
    pub(crate) fn is_over(&self, name: &str) -> bool {
        self.over.iter().any(|over| over.name == name)
    }
}

/// A quantity and its values.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Over {
    /// Name of the quantity.
    pub(super) name: String,
    /// Its values, one by one.
    pub(super) values: Option<Vec<f64>>,
    /// The first of a range.
    pub(super) from: Option<f64>,
    /// The last of a range.
    pub(super) to: Option<f64>,
    /// How many there are in a range.
    #[serde(default, deserialize_with = "count_of_scene")]
    pub(super) count: Option<u64>,
    /// How they lie in a range.
    pub(super) spacing: Option<Spacing>,
    /// Random, equally likely between two values.
    pub(super) uniform: Option<Two>,
    /// Random, its logarithm equally likely between those of two values.
    pub(super) log_uniform: Option<Two>,
    /// Random, normally distributed: mean and standard deviation.
    pub(super) normal: Option<Two>,
}

/// Two numbers, and not more.
#[derive(Clone, Copy, Debug, PartialEq, Deserialize)]
#[serde(try_from = "Vec<f64>")]
pub(crate) struct Two(pub(super) [f64; 2]);

impl TryFrom<Vec<f64>> for Two {
    type Error = String;

    fn try_from(numbers: Vec<f64>) -> Result<Self, String> {
        let count = numbers.len();
        numbers.try_into().map(Self).map_err(|_| format!("needs two numbers, not {count}"))
    }
}

/// How the values of a range lie.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Spacing {
    /// At equal distances.
    Linear,
    /// In equal ratios.
    Log,
}

/// What is kept of a run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Keep {
    /// How it ended, and after how many steps.
    Ending,
    /// The last node.
    End,
    /// Smallest and largest values of the coordinates and of H.
    Extremes,
    /// Largest errors of both energies.
    Energy,
    /// Every so many nodes, as the scene says.
    Series,
}

/// A section.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Cut {
    /// The coordinate that has a value.
    pub(super) coordinate: Option<String>,
    /// The value.
    pub(super) at: Option<f64>,
    /// How the coordinate passes it.
    pub(super) direction: Option<Passing>,
    /// The time from one crossing to the next.
    pub(super) period: Option<f64>,
}

/// How a coordinate passes a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub(crate) enum Passing {
    /// From below.
    Rising,
    /// From above.
    Falling,
    /// Either.
    Both,
}

/// What is kept where nothing is said.
fn usual() -> Vec<Keep> {
    vec![Keep::Ending, Keep::End]
}
