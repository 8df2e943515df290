//! `vi-lab compare FULL REDUCED`: two models of one motion.
//!
//! In: two systems, and the coordinates of the full model from those of the reduced one. Out: a page with the difference
//! against time, and the cost of both models. The full model takes the start, the step, and the parameters of the same
//! names from the scene of the reduced one. Python has the same as `vi.compare`.

use crate::entries::named;
use crate::run::{self, Length, Request, is_scene};
use clap::Args;
use std::path::PathBuf;
use std::time::Instant;
use vi_erased::plan::{Method, Named as _, Plan};
use vi_erased::{Simulation, System};
use vi_ready::expressions::{Expressions, Moment, operations};
use vi_report::catalogue::{Catalogue, kebab};
use vi_report::chart::{Axis, Chart, Look, Series};
use vi_report::failure::Failure;
use vi_report::html::escape;
use vi_report::input::{count, number};
use vi_report::numbers::{about, larger, short};
use vi_report::page::Report;
use vi_report::table::Table;

/// `vi-lab compare FULL REDUCED`.
#[derive(Debug, Args)]
#[command(after_help = "\
Both models take steps of one length, and are compared at the same times. The scene is that of REDUCED: FULL has its start, its step, and its \
parameters of the same names. Coordinates with the same name are compared, and those of --map, whose velocities at the start follow from the \
expressions; other coordinates of FULL start at their defaults.

vi-lab compare rod-pendulum pendulum --map 'x = l * sin(θ)' --map 'y = -l * cos(θ)' --until 5")]
pub(crate) struct Arguments {
    /// The full model: a system of `vi-lab list`, a file with one, .rs or .vi, or a scene file, .toml
    #[arg(value_name = "FULL")]
    full: String,
    /// The reduced model, as above
    #[arg(value_name = "REDUCED")]
    reduced: String,
    /// A coordinate of the full model as an expression of the time, the coordinates and the parameters of the reduced one; repeat
    /// for several
    #[arg(long, value_name = "NAME=EXPRESSION", allow_hyphen_values = true)]
    map: Vec<String>,
    /// Integrator, with steps of one length [default: that of the scene, or gauss]
    #[arg(long, value_parser = named::<Method>())]
    method: Option<Method>,
    /// Step [default: that of the reduced model]
    #[arg(long, value_name = "H", allow_hyphen_values = true, value_parser = number)]
    h: Option<f64>,
    /// Number of steps, such as 1e6 [default: 1000]
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = count)]
    steps: Option<u64>,
    /// End at this time exactly; the step becomes the next shorter one that divides the time
    #[arg(long, value_name = "T", allow_hyphen_values = true, value_parser = number)]
    until: Option<f64>,
    /// Set a parameter of the reduced model; repeat for several
    #[arg(long, value_name = "NAME=VALUE")]
    set: Vec<String>,
    /// Initial coordinates of the reduced model, separated by commas [default: those of the system]
    #[arg(long, value_name = "Q,…", value_delimiter = ',', allow_hyphen_values = true, value_parser = number)]
    q: Option<Vec<f64>>,
    /// Initial velocities of the reduced model, separated by commas [default: those of the system]
    #[arg(long, value_name = "V,…", value_delimiter = ',', allow_hyphen_values = true, value_parser = number)]
    v: Option<Vec<f64>>,
    /// Folder for the page, its figure (SVG) and its data (CSV)
    #[arg(long, value_name = "DIR", default_value = "compare")]
    out: PathBuf,
}

/// The number of times at which coordinates are compared, at most.
const TIMES: u64 = 1000;
/// Coordinates with a curve of their own; of more, the largest difference is drawn.
const CURVES: usize = Look::OTHERS.len();
/// Seconds over which steps are timed, at least, and the number of runs.
const TIMED: (f64, usize) = (0.1, 3);

/// Writes the page; returns the differences and costs as text, and the path of the page.
///
/// # Errors
/// Wrong input, a failed step, a failed file.
pub(crate) fn write(arguments: &Arguments, catalogue: &Catalogue) -> Result<String, Failure> {
    let (reduced, steps) = reduced(arguments, catalogue)?;
    let mut full = full(arguments, &reduced, catalogue)?;
    let map = Map::of(arguments, &full, &reduced)?;
    map.place(&mut full, &reduced.plan);
    run::check(full.system.as_ref(), &full.plan, Length::Steps(steps))?;
    let title = format!("{} beside {}", kebab(reduced.system.name()), kebab(full.system.name()));
    let mut report = Report::new(&arguments.out, &title, "Two models of one motion")?;
    let every = steps.div_ceil(TIMES);
    let [of_full, of_reduced] = [nodes(&full, steps, every)?, nodes(&reduced, steps, every)?];
    let times: Vec<f64> = of_full.iter().map(|(t, _)| *t).collect();
    let parameters = values(reduced.system.as_ref());
    let off = of_full.iter().zip(&of_reduced).map(|((_, of_full), (t, q))| {
        let mapped = map.values(&Moment { t: *t, q, parameters: &parameters, ..Moment::default() });
        mapped.iter().zip(&map.columns).map(|(mapped, (place, _))| mapped - of_full[*place]).collect::<Vec<f64>>()
    });
    let off: Vec<Vec<f64>> = off.collect();
    let names = map.names(&full);
    let chart = chart(&title, &names, (&times, &off));
    let costs = costs([&full, &reduced], steps)?;
    let [begin, end] = [times.first(), times.last()].map(|t| about(t.copied().unwrap_or_default()));
    let head = format!("{title}, from t = {begin} to {end}, {steps} steps of {}", full.plan.method.name());
    let most = |index: usize| off.iter().fold(0.0, |most, of| larger(most, of[index].abs()));
    let largest: Vec<String> =
        names.iter().enumerate().map(|(index, name)| format!("{name}: off by up to {}", about(most(index)))).collect();
    report.section("Difference");
    report.prose(&escape(&format!("{head}. {}", largest.join("; "))));
    report.figure(
        chart.figure(),
        "Size of the difference of each coordinate against time. Equal values have no logarithm and no point.",
    );
    report.section("Cost");
    report.table(&costs, "Operations of the equations of motion at one point, and the time of a step on this machine.");
    let page = report.finish()?;
    Ok(format!("{head}\n  {}\n{}\n{}", largest.join("\n  "), costs.text(), page.display()))
}

/// The reduced model with its scene, and the number of steps, which are of one length.
fn reduced(arguments: &Arguments, catalogue: &Catalogue) -> Result<(Request, u64), Failure> {
    let Arguments { reduced, method, h, steps, until, set, q, v, .. } = arguments;
    let wanted = run::Arguments {
        target: Some(reduced.clone()),
        method: method.or((!is_scene(reduced)).then_some(Method::Gauss)),
        h: *h,
        steps: *steps,
        until: *until,
        set: set.clone(),
        q: q.clone(),
        v: v.clone(),
        ..run::Arguments::default()
    };
    let mut request = Request::of(&wanted, catalogue)?;
    if request.plan.finds_length() {
        return Err(Failure::Input(format!(
            "steps of --method {} have lengths of their own, so that two models have no times in common; take gauss",
            request.plan.method.name()
        )));
    }
    let steps = request.length.steps(&request.plan);
    if let Length::Until(end) = request.length {
        request.plan.h = (end - request.plan.t) / steps;
    }
    run::check(request.system.as_ref(), &request.plan, request.length)?;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // checked: steps above the rounding of times
    let steps = steps as u64;
    Ok((request, steps))
}

/// The full model in the scene of the reduced one, except its start.
fn full(arguments: &Arguments, reduced: &Request, catalogue: &Catalogue) -> Result<Request, Failure> {
    let plan = &reduced.plan;
    let wanted = run::Arguments {
        target: Some(arguments.full.clone()),
        method: Some(plan.method),
        h: Some(plan.h),
        t: Some(plan.t),
        ..run::Arguments::default()
    };
    let mut request = Request::of(&wanted, catalogue)?;
    for (name, value) in reduced.system.parameters() {
        request.system.set(name, value);
    }
    request.placement.follow(request.system.as_ref(), &mut request.plan);
    Ok(request)
}

/// The values of all parameters.
fn values(system: &dyn System) -> Vec<f64> {
    system.parameters().iter().map(|(_, value)| *value).collect()
}

/// Coordinates of the full model from those of the reduced one.
struct Map {
    /// The place of each compared coordinate in the full model, and its origin.
    columns: Vec<(usize, Origin)>,
    expressions: Expressions,
    parameters: Vec<f64>,
}

/// The origin of a coordinate.
#[derive(Clone, Copy)]
enum Origin {
    /// The coordinate of the reduced model at this place.
    Coordinate(usize),
    /// The expression at this place.
    Expression(usize),
}

impl Map {
    fn of(arguments: &Arguments, full: &Request, reduced: &Request) -> Result<Self, Failure> {
        let [names, own] = [full, reduced].map(|of| of.system.coordinates());
        let mut written = Vec::with_capacity(arguments.map.len());
        for assignment in &arguments.map {
            let wrong = || Failure::Input(format!("`--map {assignment}` must have the form NAME=EXPRESSION"));
            let (name, expression) = assignment.split_once('=').ok_or_else(wrong)?;
            let (name, expression) = (name.trim(), expression.trim());
            if !names.contains(&name) {
                let known: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
                return Err(Failure::Input(format!(
                    "{} has no coordinate `{name}` for --map; it has {}",
                    kebab(full.system.name()),
                    known.join(", ")
                )));
            }
            if written.iter().any(|(known, _)| *known == name) {
                return Err(Failure::Input(format!("--map gives `{name}` twice")));
            }
            written.push((name, expression));
        }
        let origin = |name: &&str| {
            let of_map = written.iter().position(|(known, _)| known == name).map(Origin::Expression);
            of_map.or_else(|| own.iter().position(|known| known == name).map(Origin::Coordinate))
        };
        let columns: Vec<(usize, Origin)> =
            names.iter().enumerate().filter_map(|(place, name)| origin(name).map(|of| (place, of))).collect();
        if columns.is_empty() {
            let [full, reduced] = [full, reduced].map(|of| kebab(of.system.name()));
            return Err(Failure::Input(format!(
                "{full} and {reduced} have no coordinate in common: give --map NAME=EXPRESSION for {}, each an expression \
                 of {}",
                names.join(", "),
                own.join(", ")
            )));
        }
        let wrong =
            |mistakes: vi_ready::Mistakes| Failure::System { shown: String::new(), wrong: mistakes.to_string() };
        let expressions = Expressions::parse(reduced.system.definition(), &written).map_err(wrong)?;
        Ok(Self { columns, expressions, parameters: values(reduced.system.as_ref()) })
    }

    /// The compared coordinates of the full model.
    fn values(&self, at: &Moment<'_>) -> Vec<f64> {
        self.picked(&self.expressions.values(at), at.q)
    }

    fn picked(&self, expressions: &[f64], coordinates: &[f64]) -> Vec<f64> {
        let of = |(_, origin): &(usize, Origin)| match origin {
            Origin::Coordinate(place) => coordinates[*place],
            Origin::Expression(place) => expressions[*place],
        };
        self.columns.iter().map(of).collect()
    }

    /// Starts the full model at the start of the reduced one.
    fn place(&self, full: &mut Request, Plan { t, q, v, .. }: &Plan) {
        let at = Moment { t: *t, q, v, parameters: &self.parameters, ..Moment::default() };
        let [values, rates] = [self.values(&at), self.picked(&self.expressions.rates(&at), v)];
        for (index, (place, _)) in self.columns.iter().enumerate() {
            (full.plan.q[*place], full.plan.v[*place]) = (values[index], rates[index]);
        }
    }

    fn names(&self, full: &Request) -> Vec<&'static str> {
        let names = full.system.coordinates();
        self.columns.iter().map(|(place, _)| names[*place]).collect()
    }
}

fn begin(of: &Request) -> Result<Box<dyn Simulation>, Failure> {
    of.system.begin(&of.plan).map_err(|error| Failure::start(error, &of.plan))
}

/// Time and coordinates of each `every`th node and of the last.
fn nodes(of: &Request, steps: u64, every: u64) -> Result<Vec<(f64, Vec<f64>)>, Failure> {
    let mut run = begin(of)?;
    let mut nodes = vec![(run.t(), run.q().to_vec())];
    let mut taken = 0;
    while taken < steps {
        let part = every.min(steps - taken);
        run.advance_by(part).map_err(|error| failed(of, run.as_ref(), error))?;
        taken += part;
        nodes.push((run.t(), run.q().to_vec()));
    }
    Ok(nodes)
}

fn failed(of: &Request, run: &dyn Simulation, error: vi_core::StepError) -> Failure {
    let before = format!("{} at t = {}, q = {:?}", kebab(of.system.name()), short(run.t()), run.q());
    Failure::step(error, &of.plan, before)
}

/// Operations and nanoseconds of both models.
fn costs(models: [&Request; 2], steps: u64) -> Result<Table, Failure> {
    let mut table = Table::new("cost", ["model", "operations at a point", "ns a step"]);
    for (of, what) in models.into_iter().zip(["full", "reduced"]) {
        let count = operations(of.system.definition()).map_or_else(|_| "—".to_owned(), |count| count.to_string());
        let name = format!("{} ({what})", kebab(of.system.name()));
        table.row([name, count, format!("{:.0}", 1e9 * seconds(of, steps)? / steps_as_number(steps))]);
    }
    Ok(table)
}

#[allow(clippy::cast_precision_loss)] // far below 2⁵³
fn steps_as_number(steps: u64) -> f64 {
    steps as f64
}

/// The least time of some runs.
fn seconds(of: &Request, steps: u64) -> Result<f64, Failure> {
    let (mut least, mut all, mut runs) = (f64::INFINITY, 0.0, 0);
    while runs < TIMED.1 || all < TIMED.0 {
        let mut run = begin(of)?;
        let begun = Instant::now();
        run.advance_by(steps).map_err(|error| failed(of, run.as_ref(), error))?;
        let taken = begun.elapsed().as_secs_f64();
        (least, all, runs) = (f64::min(least, taken), all + taken, runs + 1);
    }
    Ok(least)
}

/// The size of each difference against time.
fn chart(title: &str, names: &[&'static str], (times, off): (&[f64], &[Vec<f64>])) -> Chart {
    let curve = |size: &dyn Fn(&[f64]) -> f64| {
        let points = times.iter().zip(off).map(|(t, of)| (*t, size(of)));
        points.filter(|(_, size)| *size > 0.0).collect::<Vec<_>>()
    };
    let mut series = Vec::new();
    if names.len() > CURVES {
        let largest = |of: &[f64]| of.iter().fold(0.0, |most, of| larger(most, of.abs()));
        series.push(Series::line("largest", Look::OTHERS[0].line(), curve(&largest)));
    } else {
        for (index, (name, look)) in names.iter().zip(Look::OTHERS).enumerate() {
            series.push(Series::line(*name, look.line(), curve(&|of: &[f64]| of[index].abs())));
        }
    }
    Chart::new("difference", title, [Axis::linear("t"), Axis::log10("difference")], series)
}
