//! Scenes: a run described in a TOML file.
//!
//! ```toml
//! system = "damped-oscillator"      # required; everything else has a default or comes from the command line
//! method = "energy"
//! start = "state"                   # of energy-preserving steps without stages and shift
//! stages = 2                        # of Gauss steps, and of energy-preserving ones
//! shift = "auto"                    # of energy-preserving steps, or a number
//! fallback = true                   # of energy-preserving steps: fixed ones if there is none
//! h = 0.01                          # or dtau = 0.5, of Gauss steps in transformed time
//! steps = 1000                      # or until = 10.0
//! every = 10
//! t = 0.0
//! q = [1.0]
//! v = [0.0]
//! project = true                    # moves q and v onto the constraints
//! [parameters]
//! c = 0.04
//! ```
//!
//! A table `[sweep]` makes it many runs: see `sweep/scene.rs`. `docs/scenes.md` lists all entries.

use super::shift::{self, Wanted};
use crate::entries::{choice, count};
use crate::sweep::scene::Sweep;
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::Path;
use vi_erased::plan::{Method, Start};
use vi_report::failure::Failure;
use vi_report::input;

/// The entries of a scene file.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct Scene {
    /// Name of the system.
    #[serde(default)]
    pub(super) system: String,
    /// Integrator.
    #[serde(default, deserialize_with = "choice")]
    pub(super) method: Option<Method>,
    /// First interval of the energy-preserving integrator.
    #[serde(default, deserialize_with = "choice")]
    pub(super) start: Option<Start>,
    /// Stages of a Gauss step, or of an energy-preserving one.
    #[serde(default, deserialize_with = "count")]
    pub(super) stages: Option<u64>,
    /// Shift of energy-preserving steps.
    #[serde(default, deserialize_with = "shift::of_scene")]
    pub(super) shift: Option<Wanted>,
    /// Whether to take fixed steps if there is no energy-preserving one.
    pub(super) fallback: Option<bool>,
    /// Step in transformed time.
    pub(super) dtau: Option<f64>,
    /// Step.
    pub(super) h: Option<f64>,
    /// Number of steps.
    #[serde(default, deserialize_with = "count")]
    pub(super) steps: Option<u64>,
    /// End of the run.
    pub(super) until: Option<f64>,
    /// Interval between written nodes.
    #[serde(default, deserialize_with = "count")]
    pub(super) every: Option<u64>,
    /// Initial time.
    pub(super) t: Option<f64>,
    /// Initial coordinates.
    pub(super) q: Option<Vec<f64>>,
    /// Initial velocities.
    pub(super) v: Option<Vec<f64>>,
    /// Initial momenta, in place of the velocities.
    pub(super) p: Option<Vec<f64>>,
    /// Whether the initial state moves onto the constraints.
    pub(super) project: Option<bool>,
    /// Parameters by name.
    #[serde(default)]
    pub(super) parameters: BTreeMap<String, f64>,
    /// The quantities that vary from run to run, and the results kept.
    pub(super) sweep: Option<Sweep>,
}

impl Scene {
    /// A scene with only the name of a system.
    pub(super) fn of_system(name: &str) -> Self {
        Self { system: name.to_owned(), ..Self::default() }
    }

    /// The scene in a file.
    ///
    /// # Errors
    /// [`Failure::Input`] if it cannot be read, or is not a scene.
    pub(super) fn read(path: &str) -> Result<Self, Failure> {
        let text = input::text(Path::new(path))?;
        Self::parse(&text).map_err(|message| Failure::Input(format!("{path}: {message}")))
    }

    /// The scene in a text, or one line with the error and its line number.
    fn parse(text: &str) -> Result<Self, String> {
        let scene: Self = toml::from_str(text).map_err(|error| {
            let is_toml = text.parse::<toml::Table>().is_ok();
            let is_of_type = ["invalid type", "wanted"].iter().any(|start| error.message().starts_with(start));
            let hint = match (is_toml, is_of_type) {
                (true, false) => "",
                _ => "; entries are such as `method = \"energy\"`, `h = 0.01`, `steps = 1000` or `q = [0.4, 0.0]`",
            };
            let message = format!("{}{hint}", error.message().replace('\n', " "));
            let before = error.span().and_then(|span| text.get(..span.start));
            before.map_or(message.clone(), |before| format!("line {}: {message}", before.matches('\n').count() + 1))
        })?;
        if scene.system.is_empty() {
            return Err("the scene names no system; add a line such as `system = \"kepler\"`".to_owned());
        }
        if scene.h.is_some() && scene.dtau.is_some() {
            return Err("give either `h` or `dtau`, not both".to_owned());
        }
        if scene.dtau.is_some() && scene.sweep.as_ref().is_some_and(|sweep| sweep.is_over("h")) {
            return Err("the sweep varies `h`, but steps in transformed time have no `h`; remove `dtau`".to_owned());
        }
        if scene.v.is_some() && scene.p.is_some() {
            return Err("give either `v` or `p`, not both".to_owned());
        }
        if scene.p.is_some() && scene.sweep.is_some() {
            return Err("the runs of a sweep start from velocities: write `v` in place of `p`".to_owned());
        }
        if scene.steps.is_some() && scene.until.is_some() {
            return Err("give either `steps` or `until`, not both".to_owned());
        }
        Ok(scene)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scene_is_read() {
        let text = "system = \"double-well\"\nmethod = \"energy\"\nstart = \"points\"\nh = 0.1\nsteps = 5e3\nevery = 10\nq = [0.995]\n[parameters]\nm = 2\n";
        let expected = Scene {
            method: Some(Method::Energy),
            start: Some(Start::Points),
            h: Some(0.1),
            steps: Some(5000),
            every: Some(10),
            q: Some(vec![0.995]),
            parameters: BTreeMap::from([("m".to_owned(), 2.0)]),
            ..Scene::of_system("double-well")
        };
        assert_eq!(Scene::parse(text), Ok(expected));
        let expected = Scene { method: Some(Method::Gauss), stages: Some(4), ..Scene::of_system("kepler") };
        assert_eq!(Scene::parse("system = \"kepler\"\nmethod = \"gauss\"\nstages = 4\n"), Ok(expected));
        let shifted = |shift| Scene { shift: Some(shift), fallback: Some(true), ..Scene::of_system("kepler") };
        for (text, expected) in [("\"auto\"", Wanted::Auto), ("2", Wanted::Given(2.0)), ("1.5", Wanted::Given(1.5))] {
            let text = format!("system = \"kepler\"\nshift = {text}\nfallback = true\n");
            assert_eq!(Scene::parse(&text), Ok(shifted(expected)));
        }
    }

    /// The entries that a table accepts, by the message about an unknown one.
    fn accepted(text: &str) -> Vec<String> {
        let message = Scene::parse(text).expect_err("an unknown entry");
        let list = message.split("expected one of ").nth(1).expect("the entries");
        list.split('`').skip(1).step_by(2).map(str::to_owned).take_while(|name| name != "method = \"energy\"").collect()
    }

    #[test]
    fn the_page_of_scenes_lists_all_entries() {
        let page = include_str!("../../../docs/scenes.md");
        let listed = |heading: &str| -> Vec<String> {
            let section = page.split("\n## ").find(|section| section.starts_with(heading)).expect("a section");
            let rows = section.lines().filter_map(|line| line.strip_prefix("| `"));
            rows.filter_map(|row| Some(row.split_once('`')?.0.to_owned())).collect()
        };
        for (heading, table) in [
            ("The run", "colour = 1\n"),
            ("`[sweep]`", "system = \"kepler\"\n[sweep]\ncolour = 1\n"),
            ("A table of `over`", "system = \"kepler\"\n[sweep]\nover = [{ colour = 1 }]\n"),
            ("The table `section`", "system = \"kepler\"\n[sweep]\nover = []\nsection = { colour = 1 }\n"),
        ] {
            let (mut listed, mut accepted) = (listed(heading), accepted(table));
            assert!(accepted.len() > 3, "{table}: {accepted:?}");
            listed.sort();
            accepted.sort();
            assert_eq!(listed, accepted, "{heading}");
        }
        for method in Method::ALL {
            assert!(page.contains(&format!("`\"{}\"`", vi_erased::plan::Named::name(method))), "{method:?}");
        }
    }

    #[test]
    fn mistakes_name_their_line() {
        for (text, expected) in [
            ("system = \"kepler\"\nsteps = -1\n", "line 2: invalid value: integer `-1`, expected a whole number"),
            (
                "system = \"kepler\"\nevery = 1.5\n",
                "line 2: invalid value: floating point `1.5`, expected a whole number",
            ),
            ("system = \"kepler\"\nq = [0.4 0.0]\n", "; entries are such as `method = \"energy\"`, `h = 0.01`"),
            (
                "system = \"kepler\"\nq = 0.4\n",
                "line 2: invalid type: floating point `0.4`, expected a sequence; entries are",
            ),
            (
                "system = \"kepler\"\nmethod = 3\n",
                "line 2: wanted string or table; entries are such as `method = \"energy\"`",
            ),
            (
                "system = \"kepler\"\nh = \"0.1\"\n",
                "line 2: invalid type: string \"0.1\", expected f64; entries are such as",
            ),
            ("system = \"kepler\"\nsteps = true\n", "line 2: invalid type: boolean `true`, expected a whole number"),
            ("system = kepler\n", "line 1: string values must be quoted"),
            ("system = \"kepler\"\nsteps = 1\nsteps = 2\n", "line 3: duplicate key"),
            ("system = \"kepler\"\n\ncolour = 1\n", "line 3: unknown field `colour`"),
            ("system = \"kepler\"\nsteps = 1\nuntil = 2.0\n", "give either `steps` or `until`, not both"),
            ("system = \"kepler\"\nv = [1, 2]\np = [1, 2]\n", "give either `v` or `p`, not both"),
            (
                "system = \"kepler\"\np = [1, 2]\n[sweep]\nover = [{ name = \"h\", values = [0.1] }]\n",
                "the runs of a sweep start from velocities: write `v` in place of `p`",
            ),
            ("system = \"kepler\"\nh = 1.0\ndtau = 2.0\n", "give either `h` or `dtau`, not both"),
            (
                "system = \"kepler\"\ndtau = 2.0\n[sweep]\nover = [{ name = \"h\", values = [0.1] }]\n",
                "the sweep varies `h`, but steps in transformed time have no `h`; remove `dtau`",
            ),
            (
                "system = \"kepler\"\nshift = \"much\"\n",
                "line 2: invalid value: string \"much\", expected a number in the units of the step density, such as 4.9, or auto",
            ),
            ("h = 1.0\n", "the scene names no system; add a line such as `system = \"kepler\"`"),
            (
                "system = \"a\"\nmethod = \"euler\"\n",
                "line 2: unknown variant `euler`, expected one of `fixed`, `suzuki-4`, `kahan-li-6`, `kahan-li-8`, `splitting-4`, `splitting-6`, `gauss`, `adaptive`, `energy`",
            ),
        ] {
            let message = Scene::parse(text).err().unwrap_or_default();
            assert!(message.contains(expected) && !message.contains('\n'), "{message}");
        }
    }
}
