//! The maps of one system: the endings of its runs over the phase plane or any two quantities.
//!
//! In: an entry of the catalogue and two axes. Out: a map for the energy-preserving integrator, with the curve D = 0 of
//! the initial states over it, and one for the fixed step. Other quantities have the values of the catalogue.

use super::atlas::{Map, Part, Section};
use super::ending::{Limit, RunSummary, size};
use super::span::Span;
use vi_erased::System;
use vi_erased::plan::{Method, PhasePoint, Plan, Start};
use vi_erased::simulation::Simulation;
use vi_report::catalogue::kebab;
use vi_report::chart::{Class, Look, Series, middles};
use vi_report::entry::Entry;
use vi_report::failure::Failure;
use vi_report::quantity::Quantity;

/// Steps of a run.
const STEPS: u32 = 2500;
/// Runs across and upwards whose ends are marked.
const ENDS: (usize, usize) = (15, 11);
/// Ratio of a coordinate to its scale above which a run counts as unstable.
const BOUND: f64 = 1e3;

/// The two requested axes. The default is the phase plane in one degree of freedom; otherwise the largest initial
/// value, and the step.
pub(super) fn axes(entry: &Entry, x: Option<&str>, y: Option<&str>) -> Result<[Span; 2], Failure> {
    let [first, second] = usual(entry);
    let axis = |text: Option<&str>, usual: Span| text.map_or(Ok(usual), |text| Span::parse(entry, text));
    let axes = [axis(x, first)?, axis(y, second)?];
    match &axes {
        [x, y] if x.quantity == y.quantity => {
            Err(Failure::Input(format!("both axes vary `{}`; give two different ones with --x and --y", x.name)))
        }
        _ => Ok(axes),
    }
}

fn usual(entry: &Entry) -> [Span; 2] {
    let span = |quantity, name: String, low, high| Span { quantity, name, range: (low, high) };
    let coordinates = entry.system.coordinates();
    let name = |index: usize| coordinates.get(index).copied().unwrap_or_default();
    if let [q] = entry.q.as_slice() {
        let width = 2.0 * q.abs().max(0.75);
        let plane = span(Quantity::Coordinate(0), name(0).to_owned(), -width, width);
        return [plane, span(Quantity::Velocity(0), format!("v_{}", name(0)), -width, width)];
    }
    let places = entry.q.iter().enumerate().map(|(index, q)| (*q, Quantity::Coordinate(index), name(index).to_owned()));
    let velocities =
        entry.v.iter().enumerate().map(|(index, v)| (*v, Quantity::Velocity(index), format!("v_{}", name(index))));
    let largest = places.chain(velocities).max_by(|(a, ..), (b, ..)| a.abs().total_cmp(&b.abs()));
    let (value, quantity, name) = largest.unwrap_or((1.0, Quantity::Coordinate(0), String::new()));
    let reach = 2.0 * value.abs().max(0.1);
    [span(quantity, name, 0.0, reach), span(Quantity::Step, "h".to_owned(), entry.h / 5.0, entry.h * 50.0)]
}

/// Two sections, each a map.
pub(super) fn sections<'a>(entry: &'a Entry, axes: &[Span; 2]) -> Vec<Section<'a>> {
    let name = kebab(entry.name);
    let fixed: Vec<String> =
        entry.system.parameters().iter().map(|(parameter, value)| format!("{parameter} = {value}")).collect();
    let energy = energy(
        "energy",
        format!("{name}: energy-preserving"),
        "Endings of runs. Dashed, if it is in the picture: the initial states with <i>D</i> = 0. Steps exist while \
         <i>D</i> keeps its sign; a run ends where its orbit meets <i>D</i> = 0.",
        entry,
        axes.clone(),
    );
    let caption = "The same with fixed steps: no step density limits them, but the equation may have no solution, and a \
                   motion may grow without bound.";
    vec![
        Section {
            heading: "The energy-preserving integrator",
            prose: format!(
                "Each cell is a run of {STEPS} steps at most, from the midpoint start. Other quantities have these values: {}, \
                 q = {:?}, v = {:?}, h = {}.",
                if fixed.is_empty() { "no parameters".to_owned() } else { fixed.join(", ") },
                entry.q,
                entry.v,
                entry.h
            ),
            parts: vec![Part::Map(energy)],
            advice: "",
        },
        Section {
            heading: "Fixed steps",
            prose: String::new(),
            parts: vec![Part::Map(map(
                "fixed",
                format!("{name}: fixed step"),
                caption,
                entry,
                axes.clone(),
                Method::Fixed,
            ))],
            advice: "Start where both maps are pale, and away from the dashed curve. Where only the second is pale, take \
                     fixed steps. Where neither is, shorten the step: <code>--y h=LOW:HIGH</code> shows by how much.",
        },
    ]
}

/// A map of the ends of runs: coarser for many degrees of freedom, whose steps take long.
fn map<'a>(
    name: &'static str,
    title: impl Into<String>,
    caption: &'static str,
    entry: &'a Entry,
    axes: [Span; 2],
    method: Method,
) -> Map<'a> {
    let shown = axes.each_ref().map(Span::axis);
    let class = move |a, b| class(entry, &axes, (a, b), method);
    Map::new(name, title, caption, shown, class).coarser(entry.q.len() / 2)
}

/// The map of the energy-preserving integrator: endings of runs, the curve D = 0, and in the phase plane of one degree
/// of freedom the middles of the last steps of some runs.
pub(super) fn energy<'a>(
    name: &'static str,
    title: impl Into<String>,
    caption: &'static str,
    entry: &'a Entry,
    axes: [Span; 2],
) -> Map<'a> {
    let mut marks = Vec::new();
    let [x, y] = &axes;
    if entry.q.len() == 1 && (&x.quantity, &y.quantity) == (&Quantity::Coordinate(0), &Quantity::Velocity(0)) {
        let [across, upwards] = axes.each_ref().map(Span::axis);
        let ends: Vec<(f64, f64)> = middles(&upwards, ENDS.1)
            .flat_map(|v| middles(&across, ENDS.0).map(move |q| (q, v)))
            .filter_map(|place| last_middle(entry, &axes, place))
            .filter(|(q, v)| x.contains(*q) && y.contains(*v))
            .collect();
        if !ends.is_empty() {
            marks.push(Series::scatter("last steps of some runs", Look::EXACT.dots(2.5), ends));
        }
    }
    let map = map(name, title, caption, entry, axes.clone(), Method::Energy);
    map.with_marks(marks).with_theory("D = 0", move |a, b| {
        let (system, plan) = varied(entry, &axes, (a, b), Method::Energy);
        let at = PhasePoint { t: 0.0, q: plan.q, v: plan.v };
        system.studies().step_density(&at).unwrap_or(f64::NAN)
    })
}

/// Coordinate and velocity in the middle of the last step of a run that failed; `None` if it did not.
fn last_middle(entry: &Entry, axes: &[Span; 2], place: (f64, f64)) -> Option<(f64, f64)> {
    let (system, plan) = varied(entry, axes, place, Method::Energy);
    let mut run = system.begin(&plan).ok()?;
    let node = |run: &dyn Simulation| Some((run.t(), *run.q().first()?));
    let mut before = node(run.as_ref())?;
    for _ in 0..STEPS {
        let now = node(run.as_ref())?;
        if run.advance().is_err() {
            let (t0, q0) = before;
            let (t1, q1) = now;
            return (t1 > t0).then(|| (f64::midpoint(q0, q1), (q1 - q0) / (t1 - t0)));
        }
        before = now;
    }
    None
}

/// The system and the plan of the cell at `place`.
fn varied(entry: &Entry, axes: &[Span; 2], place: (f64, f64), method: Method) -> (Box<dyn System>, Plan) {
    let mut system = entry.system.copy();
    let q = entry.q.clone();
    let v = entry.v.clone();
    // Every midpoint of these runs lies on the energy of the cell.
    let start = Start::Midpoint;
    let mut plan = Plan { start, ..Plan::new(method, entry.h, PhasePoint { t: 0.0, q, v }) };
    for (span, value) in axes.iter().zip([place.0, place.1]) {
        span.quantity.set(value, system.as_mut(), &mut plan);
    }
    (system, plan)
}

/// The class of the run of a cell.
fn class(entry: &Entry, axes: &[Span; 2], place: (f64, f64), method: Method) -> Class {
    let (system, plan) = varied(entry, axes, place, method);
    let scale = size(&plan.q).max(size(&plan.v)).max(1.0);
    let limit = Limit { steps: STEPS, until: f64::INFINITY, bound: BOUND * scale };
    RunSummary::planned(system.as_ref(), &plan, limit).ending.class()
}
