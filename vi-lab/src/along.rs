//! `vi-lab explain --along SCENE`: the shares of the summands of L along a run.
//!
//! In: a run. Out: a table of the summands T of L with the largest share of force, of `T_q − d/dt T_v`, and of energy, of the
//! change of `v·T_v − T`, and the operations of each; and the summands whose shares are both below a limit.

use crate::run::{self, Request};
use vi_erased::System;
use vi_erased::system::Quantity;
use vi_ready::expressions::{Moment, Terms};
use vi_report::catalogue::{Catalogue, kebab};
use vi_report::failure::Failure;
use vi_report::numbers::{about, larger, scientific, short};
use vi_report::table::Table;

/// The number of nodes at which terms are evaluated, about.
const NODES: f64 = 1000.0;

/// The table of the summands along the run of a scene, and those below a share. `system` has to be that of the scene.
///
/// # Errors
/// Wrong input, a failed step, a system that is too large.
pub(crate) fn terms(system: Option<&str>, scene: &str, below: f64, catalogue: &Catalogue) -> Result<String, Failure> {
    let request =
        Request::of(&run::Arguments { target: Some(scene.to_owned()), ..run::Arguments::default() }, catalogue)?;
    run::check(request.system.as_ref(), &request.plan, request.length)?;
    let name = request.system.name();
    if let Some(other) = system.map(|system| catalogue.find(system)).transpose()?.filter(|other| other.name != name) {
        let [other, name] = [other.name, name].map(kebab);
        return Err(Failure::Input(format!("{scene} is a scene of {name}, not of {other}")));
    }
    let wrong = |mistakes: vi_ready::Mistakes| Failure::System { shown: String::new(), wrong: mistakes.to_string() };
    let terms = Terms::of(request.system.definition()).map_err(wrong)?;
    let shares = Shares::along(&request, &terms)?;
    let mut table = Table::new("terms", ["term of L", "share of force", "share of energy", "operations"]);
    let mut small = Vec::new();
    for (index, (text, operations)) in terms.costs().enumerate() {
        let [force, energy] = [shares.force(index), shares.energy(index)];
        if force < below && energy < below {
            small.push(text.clone());
        }
        let operations = operations.map_or_else(|| "—".to_owned(), |count| count.to_string());
        table.row([text, scientific(force), scientific(energy), operations]);
    }
    let found = if small.is_empty() {
        format!("no term is below {} of both", about(below))
    } else {
        format!("below {} of both, so that this run may do without: {}", about(below), small.join(", "))
    };
    Ok(format!("{name} along {scene}\n{}\n{found}", table.text()))
}

/// The largest sizes of each summand along a run.
struct Shares {
    /// The components of the force, summand by summand.
    forces: Vec<Vec<f64>>,
    /// The energy at the start.
    first: Vec<f64>,
    /// The largest change of the energy.
    changes: Vec<f64>,
}

impl Shares {
    fn along(request: &Request, terms: &Terms) -> Result<Self, Failure> {
        let Request { system, plan, length, .. } = request;
        let failed = |error| Failure::start(error, plan);
        let mut run = system.begin(plan).map_err(failed)?;
        let every = (length.steps(plan) / NODES).ceil();
        let parameters: Vec<f64> = system.parameters().iter().map(|(_, value)| *value).collect();
        let mut shares: Option<Self> = None;
        let (mut steps, mut next) = (0, 0.0);
        loop {
            let is_end = length.is_reached(run.t(), run.h(), steps);
            #[allow(clippy::cast_precision_loss)] // far below 2⁵³
            if is_end || steps as f64 >= next {
                next += every;
                let (t, q) = (run.t(), run.q().to_vec());
                let [v, a] = rates(system.as_ref(), (t, &q, run.p())).map_err(failed)?;
                let found = terms.at(&Moment { t, q: &q, v: &v, a: &a, parameters: &parameters });
                match &mut shares {
                    Some(shares) => shares.add(&found),
                    None => shares = Some(Self::first(found)),
                }
            }
            if is_end {
                break;
            }
            length.advance(run.as_mut()).map_err(|error| {
                Failure::step(error, plan, format!("t = {}, q = {:?}, after {steps} steps", short(run.t()), run.q()))
            })?;
            steps += 1;
        }
        Ok(shares.unwrap_or_else(|| Self::first(Vec::new())))
    }

    fn first(found: Vec<(Vec<f64>, f64)>) -> Self {
        let changes = vec![0.0; found.len()];
        let first = found.iter().map(|(_, energy)| *energy).collect();
        let forces = found.into_iter().map(|(force, _)| force.into_iter().map(f64::abs).collect()).collect();
        Self { forces, first, changes }
    }

    fn add(&mut self, found: &[(Vec<f64>, f64)]) {
        for (index, (force, energy)) in found.iter().enumerate() {
            for (most, component) in self.forces[index].iter_mut().zip(force) {
                *most = larger(*most, component.abs());
            }
            self.changes[index] = larger(self.changes[index], (energy - self.first[index]).abs());
        }
    }

    /// The largest share of a component of the force: relative to that of the summand that has most of it.
    fn force(&self, index: usize) -> f64 {
        let share = |(place, own): (usize, &f64)| share(*own, self.forces.iter().map(|of| of[place]));
        self.forces[index].iter().enumerate().map(share).fold(0.0, larger)
    }

    /// The change of the energy, relative to that of the summand that changes most.
    fn energy(&self, index: usize) -> f64 {
        share(self.changes[index], self.changes.iter().copied())
    }
}

/// A size relative to the largest; 0 if all are zero.
fn share(own: f64, all: impl Iterator<Item = f64>) -> f64 {
    let most = all.fold(0.0, larger);
    if most == 0.0 { 0.0 } else { own / most }
}

/// Velocities and accelerations of a state.
fn rates(system: &dyn System, (t, q, p): (f64, &[f64], &[f64])) -> Result<[Vec<f64>; 2], vi_core::StepError> {
    let [mut v, mut a] = [Vec::new(), Vec::new()];
    system.evaluate(Quantity::Velocity, [&[t], q, p], &mut v)?;
    system.evaluate(Quantity::ExtendedAcceleration, [&[t], q, &v], &mut a)?;
    Ok([v, a])
}
