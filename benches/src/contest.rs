//! One system with one integrator, and everything that takes the same steps.

use crate::run::Run;

/// Steps after which all must be at the same place.
pub const COMPARED: usize = 1000;

/// Target for the ratio of the generated stepper's time to a rival's time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// The generated stepper takes at most this many times as long as the rival.
    AtMost(f64),
    /// The generated stepper is at least this many times as fast as the rival.
    Faster(f64),
    /// The rival, a stepper of many trajectories, is at least this many times as fast.
    Slower(f64),
    /// The rival computes more, and takes at most this many times as long.
    Costs(f64),
    /// No target; the time is only shown.
    None,
}

/// One stepper of a contest.
pub struct Entry {
    /// Name in the table.
    pub name: &'static str,
    /// The stepper at its start.
    pub run: Box<dyn Run>,
    /// Number of trajectories that one step advances.
    pub trajectories: usize,
    /// Maximum deviation of any quantity from the generated trajectory after [`COMPARED`] steps.
    pub bound: f64,
    /// The target for the generated stepper.
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

    /// Adds a rival.
    #[must_use]
    pub fn rival(self, name: &'static str, bound: f64, target: Target, run: impl Run + 'static) -> Self {
        self.ensemble(name, 1, bound, target, run)
    }

    /// Adds a stepper that advances several trajectories at a time. Times are per trajectory, and the compared state is
    /// the state of the first trajectory.
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

    /// The deviation of each entry from the generated trajectory after [`COMPARED`] steps.
    ///
    /// # Panics
    /// If an entry has another number of coordinates.
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
