//! Scenes: a run described in a TOML file.
//!
//! ```toml
//! system = "damped-oscillator"      # required; everything else has a default or comes from the command line
//! method = "energy"
//! start = "midpoint"
//! h = 0.01
//! steps = 1000                      # or until = 10.0
//! t = 0.0
//! q = [1.0]
//! v = [0.0]
//! [parameters]
//! c = 0.04
//! ```

use super::super::failure::Failure;
use super::super::simulation::{Method, Start};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::fs;

/// The entries of a scene file.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Scene {
    /// Name of the system.
    pub(super) system: String,
    /// Integrator.
    pub(super) method: Option<Method>,
    /// First interval of the energy-preserving integrator.
    pub(super) start: Option<Start>,
    /// Step.
    pub(super) h: Option<f64>,
    /// Number of steps.
    pub(super) steps: Option<u64>,
    /// End of the run.
    pub(super) until: Option<f64>,
    /// Initial time.
    pub(super) t: Option<f64>,
    /// Initial coordinates.
    pub(super) q: Option<Vec<f64>>,
    /// Initial velocities.
    pub(super) v: Option<Vec<f64>>,
    /// Parameters by name.
    #[serde(default)]
    pub(super) parameters: BTreeMap<String, f64>,
}

impl Scene {
    /// The scene that names a system and nothing else.
    pub(super) fn of_system(name: &str) -> Self {
        Self { system: name.to_owned(), ..Self::default() }
    }

    /// The scene of a file.
    ///
    /// # Errors
    /// [`Failure::Input`] where it cannot be read, or is not a scene.
    pub(super) fn read(path: &str) -> Result<Self, Failure> {
        let text = fs::read_to_string(path).map_err(|error| Failure::Input(format!("{path}: {error}")))?;
        Self::parse(&text).map_err(|message| Failure::Input(format!("{path}: {message}")))
    }

    /// The scene of a text, or one line that says what is wrong, and where.
    fn parse(text: &str) -> Result<Self, String> {
        toml::from_str(text).map_err(|error| {
            let message = error.message().replace('\n', " ");
            let before = error.span().and_then(|span| text.get(..span.start));
            before.map_or(message.clone(), |before| format!("line {}: {message}", before.matches('\n').count() + 1))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scene_is_read() {
        let text = "system = \"double-well\"\nmethod = \"energy\"\nstart = \"points\"\nh = 0.1\nsteps = 5\nq = [0.995]\n[parameters]\nm = 2\n";
        let expected = Scene {
            method: Some(Method::Energy),
            start: Some(Start::Points),
            h: Some(0.1),
            steps: Some(5),
            q: Some(vec![0.995]),
            parameters: BTreeMap::from([("m".to_owned(), 2.0)]),
            ..Scene::of_system("double-well")
        };
        assert_eq!(Scene::parse(text), Ok(expected));
    }

    #[test]
    fn mistakes_name_their_line() {
        for (text, expected) in [
            ("system = \"kepler\"\nsteps = -1\n", "line 2: "),
            ("system = \"kepler\"\n\ncolour = 1\n", "line 3: unknown field `colour`"),
            ("h = 1.0\n", "missing field `system`"),
            ("system = \"a\"\nmethod = \"euler\"\n", "line 2: unknown variant `euler`, expected `fixed` or `energy`"),
        ] {
            let message = Scene::parse(text).err().unwrap_or_default();
            assert!(message.contains(expected) && !message.contains('\n'), "{message}");
        }
    }
}
