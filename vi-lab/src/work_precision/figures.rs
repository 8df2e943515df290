//! The figures and the tables of a comparison, with their captions.
//!
//! In: [`Findings`]. Out: charts and tables. Runs with an error over [`LOST`] appear only in the table.

use super::method::Method;
use super::study::{Findings, Point, fitted_order};
use vi_report::chart::{Axis, Chart, Look, Series};
use vi_report::numbers::{extremes, scientific};
use vi_report::table::Table;

/// Error above which a run does not approximate the motion.
pub(super) const LOST: f64 = 2.0;
/// Errors for which the table lists times.
const PRICED: [f64; 4] = [1e-3, 1e-6, 1e-9, 1e-12];

impl Findings {
    /// Error against seconds, with whiskers up to the median.
    pub(super) fn time(&self, system: &str) -> Chart {
        self.work(
            "work-precision",
            format!("{system}: error against time"),
            "wall-clock seconds of the whole run".to_owned(),
            |point| point.seconds,
            |point| Some(point.median),
        )
    }

    /// Error against evaluations.
    pub(super) fn evaluations(&self, system: &str) -> Chart {
        #[allow(clippy::cast_precision_loss)] // far below 2⁵³
        let count = |point: &Point| point.evaluations as f64;
        self.work(
            "evaluations",
            format!("{system}: error against evaluations"),
            "evaluations of the equations".to_owned(),
            count,
            |_| None,
        )
    }

    /// Error against some measure of work, for all methods.
    fn work(
        &self,
        name: &'static str,
        title: String,
        label: String,
        work: impl Fn(&Point) -> f64,
        whisker: impl Fn(&Point) -> Option<f64>,
    ) -> Chart {
        let mut series = Vec::new();
        for method in self.methods() {
            let shown: Vec<Point> = self.shown(method).map(|(_, point)| point).collect();
            let points: Vec<(f64, f64)> = shown.iter().map(|point| (point.error, work(point))).collect();
            if points.is_empty() {
                continue;
            }
            let line = Series::curve(method.name, method.look, points);
            series.push(line.with_whiskers(shown.iter().filter_map(&whisker).collect()));
        }
        let (low, high) = extremes(series.iter().flat_map(|line| line.points.iter().map(|(_, y)| *y)));
        let floor = self.agreement.floor();
        let known = vec![(floor, low), (floor, high)];
        series.insert(0, Series::curve("reference known to", Look::PUBLISHED, known));
        Chart::new(name, title, [Axis::log10(self.error_label()), Axis::log10(label)], series)
    }

    /// Error against the step, for the methods with a given step.
    pub(super) fn orders(&self, system: &str) -> Chart {
        let stepping = self.methods().filter(|method| !method.has_tolerance());
        let series = stepping.map(|method| {
            let order = fitted_order(self.points(method), self.agreement.floor());
            let label = order.map_or_else(
                || method.name.to_owned(),
                |order| format!("{}: {order:.2}", method.name.replace("energy-preserving", "energy-pres.")),
            );
            Series::curve(label, method.look, self.shown(method).map(|(h, point)| (h, point.error)).collect())
        });
        Chart::new(
            "order",
            format!("{system}: error against step, with the fitted order"),
            [Axis::log10("h (energy-preserving: first step)"), Axis::log10(self.error_label())],
            series.collect(),
        )
    }

    /// The least time that reaches an error, by method.
    pub(super) fn prices(&self) -> Table {
        let head = ["method", "error 1e-3", "1e-6", "1e-9", "1e-12"];
        let mut table = Table::new("prices", head);
        for method in self.methods() {
            let price = |error: f64| self.price(method, error).map_or_else(|| "—".to_owned(), duration);
            let [a, b, c, d] = PRICED.map(price);
            table.row([method.name.to_owned(), a, b, c, d]);
        }
        table
    }

    /// The least time of a run of `method` with at most this error.
    fn price(&self, method: Method, error: f64) -> Option<f64> {
        let seconds = self.points(method).filter(|(_, point)| point.error <= error).map(|(_, point)| point.seconds);
        seconds.min_by(f64::total_cmp)
    }

    /// The reason why no method has a time; `None` if one has.
    pub(super) fn uncompared(&self) -> Option<String> {
        let has_price = |method| PRICED.into_iter().any(|error| self.price(method, error).is_some());
        if self.methods().any(has_price) {
            return None;
        }
        let floor = self.agreement.floor();
        Some(match self.missing() {
            _ if floor.is_nan() => {
                "errors are relative to the largest coordinate and momentum, and one of them is always zero".to_owned()
            }
            _ if PRICED.into_iter().all(|error| error < floor) => format!(
                "the reference at t = {} is known to {} only; choose a more regular motion with --q and --v",
                self.until,
                scientific(floor)
            ),
            reasons if reasons.is_empty() => format!("all errors are above {}", scientific(PRICED[0])),
            reasons => reasons.join(" "),
        })
    }

    /// Every run.
    pub(super) fn run_table(&self) -> Table {
        let head = ["method", "setting", "error", "evaluations", "seconds, least", "seconds, median", "ended"];
        let mut table = Table::new("runs", head);
        for run in &self.runs {
            let name = run.method.name.to_owned();
            let setting = format!("{:e}", run.setting);
            table.row(match &run.outcome {
                Ok(point) => [
                    name,
                    setting,
                    format!("{:e}", point.error),
                    point.evaluations.to_string(),
                    format!("{:.4e}", point.seconds),
                    format!("{:.4e}", point.median),
                    String::new(),
                ],
                Err(ended) => {
                    let none = String::new;
                    [name, setting, none(), none(), none(), none(), ended.to_string()]
                }
            });
        }
        table
    }

    /// Runs that the figures omit, one sentence per method: runs that ended early, and runs with large errors.
    pub(super) fn missing(&self) -> Vec<String> {
        let mut sentences = Vec::new();
        for method in self.methods() {
            let of: Vec<_> = self.runs.iter().filter(|run| run.method == method).collect();
            let ended: Vec<_> = of.iter().filter_map(|run| Some((run.setting, run.outcome.err()?))).collect();
            if let (Some((setting, first)), count) = (ended.last(), ended.len()) {
                let which = if count == of.len() { "All".to_owned() } else { format!("{count} of the") };
                let setting = method.setting(*setting);
                sentences.push(format!(
                    "{which} {} runs of {} ended early; at {setting}: {first}.",
                    of.len(),
                    method.name
                ));
            }
            let lost = self.points(method).filter(|(_, point)| point.error > LOST).count();
            if lost > 0 {
                sentences.push(format!(
                    "{lost} of the {} runs of {} have an error above {LOST}.",
                    of.len(),
                    method.name
                ));
            }
        }
        sentences
    }

    /// The points in the figures.
    fn shown(&self, method: Method) -> impl Iterator<Item = (f64, Point)> + '_ {
        self.points(method).filter(|(_, point)| point.error <= LOST)
    }

    fn error_label(&self) -> String {
        format!("relative error of q and p at t = {}", self.until)
    }
}

/// Seconds in a suitable unit.
fn duration(seconds: f64) -> String {
    match seconds {
        seconds if seconds < 1e-3 => format!("{} µs", scientific(seconds * 1e6)),
        seconds if seconds < 1.0 => format!("{} ms", scientific(seconds * 1e3)),
        seconds => format!("{} s", scientific(seconds)),
    }
}

#[cfg(test)]
mod tests {
    use super::super::reference::Agreement;
    use super::super::study::TimedRun;
    use super::*;
    use vi_core::StepError;
    use vi_erased::studies::rival::Ended;

    /// Two runs of the energy-preserving integrator, off by 1e-12 and 1e-14, and one that ended.
    fn findings() -> Findings {
        let point = |error, seconds| Point { error, evaluations: 100, seconds, median: 2.0 * seconds };
        let error = StepError::NoForwardStep { t: 1.0, h: 0.1, excess: 0.0, density: -1.0 };
        let run = |setting, outcome| TimedRun { method: Method::ENERGY, setting, outcome };
        Findings {
            until: 10.0,
            agreement: Agreement { composed: 1e-15, h: 0.1, rival: 1e-15 },
            runs: vec![
                run(0.2, Err(Ended::Step(error))),
                run(0.1, Ok(point(1e-12, 1e-4))),
                run(0.05, Ok(point(1e-14, 1e-3))),
                run(0.02, Ok(point(3.0, 1e-2))),
            ],
        }
    }

    #[test]
    fn why_nothing_can_be_compared_is_said() {
        let found = findings();
        assert_eq!(found.uncompared(), None);
        let without = |is_kept: fn(&TimedRun) -> bool| Findings {
            runs: found.runs.iter().filter(|run| is_kept(run)).cloned().collect(),
            ..found.clone()
        };
        // A run that ended early, and one with a large error.
        let why = without(|run| run.setting > 0.1 || run.setting < 0.05).uncompared().expect("nothing is compared");
        assert!(why.contains("ended early; at h₀ = 0.2000: no energy-preserving step exists past"), "{why}");
        let lost = without(|run| run.setting < 0.05);
        let of_agreement = |composed| Findings { agreement: Agreement { composed, ..found.agreement }, ..lost.clone() };
        let why = of_agreement(0.3).uncompared().expect("nothing is compared");
        assert!(why.starts_with("the reference at t = 10 is known to 0.300 only; "), "{why}");
        let rest = Agreement { composed: f64::NAN, rival: f64::NAN, ..found.agreement };
        let why = Findings { agreement: rest, ..lost }.uncompared().expect("nothing is compared");
        assert!(why.ends_with("one of them is always zero"), "{why}");
    }

    #[test]
    fn what_is_not_shown_is_said() {
        let found = findings();
        assert_eq!(
            found.missing(),
            [
                "1 of the 4 runs of energy-preserving ended early; at h₀ = 0.2000: no energy-preserving step exists past \
                 t = 1.000000000 (last h = 1.000e-1, H − E = 0.000e0, step density D = -1.000e0).",
                "1 of the 4 runs of energy-preserving have an error above 2."
            ]
        );
        let shown = found.time("test").figure().csv;
        assert!(shown.contains("\"energy-preserving\",1e-14,1e-3,2e-3\n") && !shown.contains("1e-2,2e-2"), "{shown}");
        let runs = found.run_table().csv();
        assert!(runs.lines().any(|line| line.starts_with("energy-preserving,2e-1,,,,,\"no energy-preserving step")));
    }
}
