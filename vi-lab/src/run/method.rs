//! The integrator of a run in words: `energy, 2 stages, shift 0.5, with fallback`.

use vi_erased::plan::Named as _;
use vi_erased::plan::{Method, Plan, Shift, Start};
use vi_report::numbers::short;

/// The integrator of a plan and its start, in the terms of the command line.
pub(crate) fn in_words(plan: &Plan) -> String {
    let start = |name: &str| format!("start {name}");
    let of_the_method = match (plan.method, plan.energy_stages().or(plan.stages), plan.start) {
        (_, Some(1), _) => Some("1 stage".to_owned()),
        (_, Some(stages), _) => Some(format!("{stages} stages")),
        (Method::Energy, None, Start::Midpoint) => Some(start("midpoint")),
        (Method::Energy, None, Start::Points) => Some(start("points")),
        _ => None,
    };
    let shift = plan.shift.map(|shift| match shift {
        Shift::Of(shift) => format!("shift {}", short(shift)),
        Shift::Over(time) => format!("shift measured over {}", short(time)),
    });
    let fallback = plan.fallback.then(|| "with fallback".to_owned());
    let dtau = plan.dtau.map(|dtau| format!("dtau = {}", short(dtau)));
    let words = [Some(plan.method.name().to_owned()), of_the_method, shift, fallback, dtau];
    words.into_iter().flatten().collect::<Vec<_>>().join(", ")
}
