//! One system with one integrator, and everything that takes the same steps.

use crate::run::Run;

/// Steps after which all must be at the same place.
pub const COMPARED: usize = 1000;

/// What the ratio of the generated stepper's time to a rival's shall be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// As fast as the rival, but for this factor.
    AtMost(f64),
    /// Faster than the rival by this factor.
    Faster(f64),
    /// Slower than the rival by this factor: one trajectory against many.
    Slower(f64),
    /// The rival computes more: at most this many times as long.
    Costs(f64),
    /// Shown, not judged.
    None,
}

/// One stepper of a contest.
pub struct Entry {
    /// Its name in the table.
    pub name: &'static str,
    /// The stepper at its start.
    pub run: Box<dyn Run>,
    /// Trajectories that one step moves on.
    pub trajectories: usize,
    /// How far from the generated trajectory it may be after [`COMPARED`] steps, in any quantity.
    pub bound: f64,
    /// The target against it.
    pub target: Target,
}

/// The generated stepper and its rivals.
pub struct Contest {
    /// System, integrator and step.
    pub name: &'static str,
    /// The generated stepper first.
    pub entries: Vec<Entry>,
}

impl Contest {
    /// A contest with the generated stepper alone.
    pub fn new(name: &'static str, generated: impl Run + 'static) -> Self {
        let generated =
            Entry { name: "generated", run: Box::new(generated), trajectories: 1, bound: 0.0, target: Target::None };
        Self { name, entries: vec![generated] }
    }

    /// With one more rival.
    #[must_use]
    pub fn rival(self, name: &'static str, bound: f64, target: Target, run: impl Run + 'static) -> Self {
        self.ensemble(name, 1, bound, target, run)
    }

    /// With a stepper that moves `trajectories` at a time; times are per trajectory, and its state is that of the first one.
    #[must_use]
    pub fn ensemble(
        mut self,
        name: &'static str,
        trajectories: usize,
        bound: f64,
        target: Target,
        run: impl Run + 'static,
    ) -> Self {
        self.entries.push(Entry { name, run: Box::new(run), trajectories, bound, target });
        self
    }

    /// How far each entry is from the generated trajectory after [`COMPARED`] steps.
    ///
    /// # Panics
    /// Where an entry has another number of coordinates.
    #[must_use]
    pub fn deviations(&self) -> Vec<f64> {
        let states: Vec<Vec<f64>> = self.entries.iter().map(|entry| entry.run.run(COMPARED)).collect();
        let deviation = |state: &Vec<f64>| {
            assert_eq!(state.len(), states[0].len());
            let apart = state.iter().zip(&states[0]).map(|(a, b)| (a - b).abs());
            // A number that is none is infinitely far.
            apart.fold(0.0, |worst: f64, apart| if apart.is_nan() { f64::INFINITY } else { worst.max(apart) })
        };
        states.iter().map(deviation).collect()
    }
}
