//! The facts of a system, or its mistakes.
//!
//! In: a text. Out: the system, and JSON with its names, defaults, start and methods; or JSON with each mistake at its
//! token.

use serde_json::{Value, json};
use vi_core::StepError;
use vi_erased::plan::{Built, Method, Named as _, PhasePoint};
use vi_erased::{Plan, System};
use vi_tape::{Mistake, Mistakes};

/// A system of a text.
pub struct Model {
    /// The system, with the defaults of its parameters.
    pub system: vi_tape::System,
}

impl Model {
    /// The system of a text.
    ///
    /// # Errors
    /// The mistakes as JSON: `text` has all of them, `each` those at tokens. Lines count from 1, columns in characters
    /// from 0.
    pub fn of(text: &str) -> Result<Self, String> {
        vi_tape::System::parse(text).map(|system| Self { system }).map_err(|mistakes| described(&mistakes))
    }

    /// The facts as JSON.
    #[must_use]
    pub fn facts(&self) -> String {
        let system = &self.system;
        let parameters = system.parameters().into_iter().zip(system.parameters_about());
        let parameters: Vec<Value> =
            parameters.map(|((name, value), about)| json!({ "name": name, "about": about, "value": value })).collect();
        let methods: Vec<String> = self.methods().into_iter().map(name).collect();
        let facts = json!({
            "name": system.name(),
            "about": system.about(),
            "coordinates": system.coordinates(),
            "parameters": parameters,
            "methods": methods,
            "conserves": system.conserves_energy(),
            "start": self.start(),
        });
        facts.to_string()
    }

    /// The methods of the system, which the page names by their place in this list.
    #[must_use]
    pub fn methods(&self) -> Vec<Built> {
        self.system.integrators()
    }

    /// The state of the clause `check`, if there is one; otherwise all coordinates are 1, at rest.
    fn start(&self) -> Value {
        let size = self.system.coordinates().len();
        let (q, v) =
            self.system.check().map_or_else(|| (vec![1.0; size], vec![0.0; size]), |at| (at.q.clone(), at.v.clone()));
        json!({ "q": q, "v": v })
    }

    /// The system with these parameters, and the plan of a run by a method from the time 0. `numbers` are all parameters,
    /// coordinates and velocities.
    ///
    /// # Errors
    /// Another number of them, or no method of this index.
    pub fn planned(
        &self,
        method: usize,
        length: Length,
        numbers: &[f64],
    ) -> Result<(Box<dyn System>, Plan), StepError> {
        let mut system = self.system.copy();
        let parameters = system.parameters();
        let (values, state) = numbers.split_at(parameters.len().min(numbers.len()));
        for ((name, _), value) in parameters.iter().zip(values) {
            system.set(name, *value);
        }
        let (q, v) = state.split_at(system.coordinates().len().min(state.len()));
        #[allow(clippy::cast_precision_loss)] // the index of a method
        let unknown = StepError::InvalidInput { input: "method", allowed: "one that is built", value: method as f64 };
        let (method, stages, _) = self.methods().get(method).copied().ok_or(unknown)?;
        let at = PhasePoint { t: 0.0, q: q.to_vec(), v: v.to_vec() };
        let mut plan = Plan { stages, ..Plan::new(method, 1.0, at) };
        match length {
            Length::Of(h) => plan.h = h,
            Length::Within(tolerance) => plan.tolerance = Some(tolerance),
        }
        Ok((system, plan))
    }
}

/// The length of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Length {
    /// This length.
    Of(f64),
    /// The longest one whose error is below this, relative to the motion.
    Within(f64),
}

/// The name of a method, with its stages.
#[must_use]
pub fn name((method, stages, _): Built) -> String {
    stages.map_or_else(|| method.name().to_owned(), |stages| format!("{} {stages}", method.name()))
}

/// Whether the method keeps the discrete energy, which is not H at the start.
#[must_use]
pub fn keeps_energy(method: Method) -> bool {
    method == Method::Energy
}

fn described(mistakes: &Mistakes) -> String {
    let each = mistakes.each().iter().map(|Mistake { wrong, helps, token }| {
        let [from, to] = token.map(|of| [of.line, of.column]);
        json!({ "wrong": wrong, "helps": helps, "from": from, "to": to })
    });
    json!({ "text": mistakes.to_string(), "each": each.collect::<Vec<_>>() }).to_string()
}
