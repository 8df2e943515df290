//! Rows as a figure: energies and coordinates over time, coordinates with their momenta, in one SVG file.
//!
//! In: the rows of a run. Out: the file, when the run ends for any reason. Memory is bounded: functions of time keep
//! the extremes of each stretch; a phase portrait keeps every 2^k-th row and is then drawn as dots.

use super::{Request, Sink, method};
use std::fs::File;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use vi_erased::simulation::Row;
use vi_report::catalogue::kebab;
use vi_report::chart::{Axis, Chart, Look, Panel, Sample, Series, Sheet, Trace};
use vi_report::failure::Failure;
use vi_report::machine::{VERSION, command_line};
use vi_report::numbers::{assigned, short};

/// Maximum number of coordinates drawn.
const MOST: usize = 24;
/// Widths of the panels over time and of the phase portraits, in pixels; their height.
const OVER_TIME: f64 = 620.0;
const PORTRAIT: f64 = 360.0;
const HEIGHT: f64 = 250.0;

/// A picture of a run.
pub(super) struct Plot {
    path: PathBuf,
    file: File,
    title: String,
    parameters: String,
    names: Vec<&'static str>,
    energy: Trace,
    discrete_energy: Trace,
    coordinates: Vec<Coordinate>,
    /// The trajectory of two coordinates in their plane.
    plane: Sample,
}

/// A coordinate over time, and with its momentum.
#[derive(Clone, Default)]
struct Coordinate {
    over_time: Trace,
    portrait: Sample,
}

impl Plot {
    /// An empty figure in its own file.
    pub(super) fn create(path: &Path, request: &Request) -> Result<Self, Failure> {
        let file = File::create(path).map_err(|error| Failure::file(path, error))?;
        let Request { system, plan, .. } = request;
        let names = system.coordinates();
        let shown = names.len().min(MOST);
        let few = if shown < names.len() {
            format!(" (the first {shown} of {} coordinates)", names.len())
        } else {
            String::new()
        };
        Ok(Self {
            path: path.to_owned(),
            file,
            title: format!("{}, {}, h = {}{few}", kebab(system.name()), method::in_words(plan), short(plan.h)),
            parameters: assigned(&system.parameters()),
            energy: Trace::default(),
            discrete_energy: Trace::default(),
            coordinates: vec![Coordinate::default(); shown],
            plane: Sample::default(),
            names,
        })
    }

    /// The figure.
    fn sheet(&self) -> Sheet {
        let mut rows = vec![self.first_row()];
        let coordinates = self.names.iter().zip(&self.coordinates);
        rows.extend(coordinates.map(|(name, coordinate)| coordinate.row(name)));
        Sheet {
            title: self.title.clone(),
            subtitle: self.parameters.clone(),
            description: format!("vi-lab {VERSION}: {}; {}; {}", command_line(), self.title, self.parameters),
            rows,
        }
    }

    /// The energies, and beside them the trajectory of two coordinates.
    fn first_row(&self) -> Vec<Panel> {
        let energy = self.energy.points();
        let start = energy.first().map_or(0.0, |first| first.1);
        let less_start = |points: Vec<(f64, f64)>| points.into_iter().map(|(t, energy)| (t, energy - start)).collect();
        let lines = [
            (energy, "H − H₀", Look::OTHERS[0].line()),
            (self.discrete_energy.points(), "E − H₀", Look::OTHERS[1].dashed()),
        ];
        let series = lines
            .into_iter()
            .filter(|(points, ..)| !points.is_empty())
            .map(|(points, label, look)| Series::line(label, visible(look, &points), less_start(points)))
            .collect();
        let title = format!("H at the start: H₀ = {}", short(start));
        let energies = chart(title, ["t", "energy − H₀"], series);
        let [first, second] = self.names[..] else {
            return vec![Panel { chart: energies, width: OVER_TIME + PORTRAIT, height: HEIGHT }];
        };
        let path = chart(String::new(), [first, second], vec![curve(&self.plane)]);
        let path = Chart { equal_aspect: true, ..path };
        [(energies, OVER_TIME), (path, PORTRAIT)].map(|(chart, width)| Panel { chart, width, height: HEIGHT }).into()
    }
}

impl Coordinate {
    fn row(&self, name: &str) -> Vec<Panel> {
        let points = self.over_time.points();
        let line = Series::line("", visible(Look::FIXED.line(), &points), points).unlabelled();
        let over_time = chart(String::new(), ["t", name], vec![line]);
        let portrait = chart(String::new(), [name, &format!("p_{name}")], vec![curve(&self.portrait)]);
        [(over_time, OVER_TIME), (portrait, PORTRAIT)]
            .map(|(chart, width)| Panel { chart, width, height: HEIGHT })
            .into()
    }
}

fn chart(title: String, axes: [&str; 2], series: Vec<Series>) -> Chart {
    let [x, y] = axes.map(Axis::linear);
    Chart::new("plot", title, [x, y], series)
}

/// A curve in the plane; dots if the points are not consecutive.
fn curve(sample: &Sample) -> Series {
    let points = sample.points();
    let look = if sample.is_whole() { visible(Look::FIXED.line(), &points) } else { Look::FIXED.line().dots(1.2) };
    Series::curve("", look, points).unlabelled()
}

/// The style of a line; a dot for a single point.
fn visible(look: Look, points: &[(f64, f64)]) -> Look {
    if points.len() == 1 { look.dots(3.0) } else { look }
}

impl Sink for Plot {
    fn write(&mut self, row: &Row) -> Result<(), Failure> {
        let entries = [(&mut self.energy, row.energy), (&mut self.discrete_energy, row.discrete_energy)];
        for (trace, energy) in entries {
            if let Some(energy) = energy {
                trace.push((row.t, energy));
            }
        }
        for ((coordinate, q), p) in self.coordinates.iter_mut().zip(&row.q).zip(&row.p) {
            coordinate.over_time.push((row.t, *q));
            coordinate.portrait.push((*q, *p));
        }
        if let [first, second] = row.q[..] {
            self.plane.push((first, second));
        }
        Ok(())
    }

    fn finish(&mut self) -> Result<(), Failure> {
        let svg = self.sheet().svg();
        self.file.write_all(svg.as_bytes()).map_err(|error| Failure::file(&self.path, error))
    }
}
