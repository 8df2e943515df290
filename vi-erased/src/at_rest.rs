//! A system without its last coordinates, which are at rest.
//!
//! In: a type-erased system of more coordinates than were declared; the others have the mass 1, no force and no
//! constraint.
//! Out: a [`System`] of the declared coordinates. Vectors passed to the inner system are extended by zeros, and vectors
//! that it returns are shortened. So only few numbers of coordinates have to be compiled.

#[cfg(feature = "derivatives")]
use crate::control::{Control, Linear, Rest, pairs};
use crate::forward;
#[cfg(feature = "checkpoints")]
use crate::plan::Built;
#[cfg(feature = "studies")]
use crate::plan::ENERGY_STAGES;
use crate::plan::{PhasePoint, Plan};
use crate::section::{Section, Watch};
#[cfg(feature = "derivatives")]
use crate::simulation::Wanted;
use crate::simulation::{Met, Simulation, Steps, wrong_size};
#[cfg(feature = "sessions")]
use crate::simulation::{Rows, Session, StepOutput};
#[cfg(feature = "studies")]
use crate::studies::{Studies, exponents::Exponents, rival::Ended};
use crate::system::{OnConstraints, Quantity, System};
#[cfg(feature = "studies")]
use core::cell::Cell;
use std::borrow::Cow;
use vi_core::StepError;
#[cfg(feature = "derivatives")]
use vi_core::control::Equilibrium;
use vi_core::lagrangian::Space;
#[cfg(feature = "derivatives")]
use vi_core::nalgebra::{DMatrix, SVector};
use vi_core::run::ErrorEstimate;

/// A system without its coordinates from `size` on.
#[must_use]
pub fn without_rest(system: Box<dyn System>, size: usize) -> Box<dyn System> {
    Box::new(Declared { of: system, size })
}

/// A system or a run of which the first coordinates are declared.
struct Declared<Y: ?Sized> {
    of: Box<Y>,
    size: usize,
}

/// The vector with as many entries as all coordinates.
///
/// # Errors
/// [`StepError::InvalidInput`] unless it has `size` entries.
fn with_rest(values: &[f64], size: usize, all: usize, input: &'static str) -> Result<Vec<f64>, StepError> {
    if values.len() == size { Ok(extended(values, all)) } else { Err(wrong_size(values, input)) }
}

/// The numbers with zeros at their end.
fn extended(values: &[f64], all: usize) -> Vec<f64> {
    let mut values = values.to_vec();
    values.resize(all, 0.0);
    values
}

/// Keeps the first `size` of each `all` numbers.
fn cut(values: &[f64], all: usize, size: usize) -> Vec<f64> {
    values.chunks_exact(all.max(1)).flat_map(|of| &of[..size]).copied().collect()
}

impl Declared<dyn System> {
    fn all(&self) -> usize {
        self.of.coordinates().len()
    }

    fn point(&self, at: &PhasePoint) -> Result<PhasePoint, StepError> {
        let [q, v] = [(&at.q, "number of coordinates"), (&at.v, "number of velocities")];
        let full = |(values, input): (&Vec<f64>, _)| with_rest(values, self.size, self.all(), input);
        Ok(PhasePoint { t: at.t, q: full(q)?, v: full(v)? })
    }

    fn plan(&self, plan: &Plan) -> Result<Plan, StepError> {
        let full = |values: &[f64], input| with_rest(values, self.size, self.all(), input);
        let q = full(&plan.q, "number of coordinates")?;
        Ok(match &plan.p {
            Some(p) => Plan { q, p: Some(full(p, "number of momenta")?), ..plan.clone() },
            None => Plan { q, v: full(&plan.v, "number of velocities")?, ..plan.clone() },
        })
    }

    fn cut(&self, mut of: OnConstraints) -> OnConstraints {
        for vector in [&mut of.point.q, &mut of.point.v, &mut of.moved_q, &mut of.moved_v] {
            vector.truncate(self.size);
        }
        of
    }

    /// The points with zeros at the end of each.
    fn points(&self, [q, v]: [&[f64]; 2]) -> [Vec<f64>; 2] {
        let all = self.all();
        [q, v].map(|of| of.chunks_exact(self.size).flat_map(|of| extended(of, all)).collect())
    }
}

impl System for Declared<dyn System> {
    forward!(System);

    fn coordinates(&self) -> Vec<&'static str> {
        let mut names = self.of.coordinates();
        names.truncate(self.size);
        names
    }

    fn spaces(&self) -> Vec<Space> {
        let mut spaces = self.of.spaces();
        spaces.truncate(self.size);
        spaces
    }

    fn copy(&self) -> Box<dyn System> {
        without_rest(self.of.copy(), self.size)
    }

    fn evaluate(&self, of: Quantity, [t, q, v]: [&[f64]; 3], out: &mut Vec<f64>) -> Result<(), StepError> {
        let [q, v] = self.points([q, v]);
        if !of.has_coordinates() {
            return self.of.evaluate(of, [t, &q, &v], out);
        }
        let mut found = Vec::new();
        let outcome = self.of.evaluate(of, [t, &q, &v], &mut found);
        out.extend(cut(&found, self.all(), self.size));
        outcome
    }

    fn project(&self, at: &PhasePoint) -> Result<OnConstraints, StepError> {
        Ok(self.cut(self.of.project(&self.point(at)?)?))
    }

    #[cfg(feature = "derivatives")]
    fn assemble(&self, at: &PhasePoint) -> Result<OnConstraints, StepError> {
        Ok(self.cut(self.of.assemble(&self.point(at)?)?))
    }

    #[cfg(feature = "derivatives")]
    fn redundant(&self, t: f64, q: &[f64]) -> Result<Vec<&'static str>, StepError> {
        let PhasePoint { q, .. } = self.point(&PhasePoint { t, q: q.to_vec(), v: vec![0.0; q.len()] })?;
        self.of.redundant(t, &q)
    }

    fn without(&self, constraints: &[&str]) -> Option<Box<dyn System>> {
        Some(without_rest(self.of.without(constraints)?, self.size))
    }

    #[cfg(feature = "derivatives")]
    fn control(&self) -> &dyn Control {
        self
    }

    #[cfg(feature = "studies")]
    fn studies(&self) -> &dyn Studies {
        self
    }

    fn begin_while(&self, plan: &Plan, goes_on: &mut dyn FnMut() -> bool) -> Result<Box<dyn Simulation>, StepError> {
        Ok(Box::new(Declared { of: self.of.begin_while(&self.plan(plan)?, goes_on)?, size: self.size }))
    }

    #[cfg(feature = "checkpoints")]
    fn restart(&self, built: Built, stored: &str) -> Result<Box<dyn Simulation>, String> {
        Ok(Box::new(Declared { of: self.of.restart(built, stored)?, size: self.size }))
    }
}

#[cfg(feature = "derivatives")]
impl Control for Declared<dyn System> {
    fn inputs(&self) -> &'static [usize] {
        self.of.control().inputs()
    }

    fn mass_matrix(&self, [t, q, v]: [&[f64]; 3], out: &mut Vec<f64>) {
        let ([q, v], all, mut found) = (self.points([q, v]), self.all(), Vec::new());
        self.of.control().mass_matrix([t, &q, &v], &mut found);
        for matrix in found.chunks_exact(all * all) {
            out.extend(cut(&matrix[..self.size * all], all, self.size));
        }
    }

    fn bias(&self, [t, q, v]: [&[f64]; 3], out: &mut Vec<f64>) {
        let ([q, v], mut found) = (self.points([q, v]), Vec::new());
        self.of.control().bias([t, &q, &v], &mut found);
        out.extend(cut(&found, self.all(), self.size));
    }

    fn linearization(&self, t: f64, q: &[f64], v: &[f64]) -> Result<Linear, StepError> {
        let PhasePoint { q, v, .. } = self.point(&PhasePoint { t, q: q.to_vec(), v: v.to_vec() })?;
        Ok(cut_linear(&self.of.control().linearization(t, &q, &v)?, self.all(), self.size))
    }

    fn equilibrium(&self, t: f64, guess: &[f64]) -> Result<Rest, StepError> {
        let (all, size) = (self.all(), self.size);
        let mut rest = self.of.control().equilibrium(t, &with_rest(guess, size, all, "number of coordinates")?)?;
        // Each coordinate at rest is a direction of its own: no constraint holds it.
        let freedom = rest.freedom;
        let is_declared = |direction: &usize| (size..all).all(|i| rest.directions[i * freedom + direction] == 0.0);
        let declared: Vec<usize> = (0..freedom).filter(is_declared).collect();
        let of_declared = |row: &[f64]| declared.iter().map(|direction| row[*direction]).collect::<Vec<_>>();
        rest.directions = rest.directions.chunks_exact(freedom.max(1)).take(size).flat_map(of_declared).collect();
        rest.matrices = rest.matrices.map(|of| {
            let rows = declared.iter().map(|direction| &of[direction * freedom..(direction + 1) * freedom]);
            rows.flat_map(of_declared).collect()
        });
        rest.q.truncate(size);
        rest.free.truncate(size);
        rest.free_motions -= freedom - declared.len();
        rest.freedom = declared.len();
        let matrix = |of: usize| DMatrix::from_row_slice(rest.freedom, rest.freedom, &rest.matrices[of]);
        let [mass, damping, stiffness] = [0, 1, 2].map(matrix);
        // Its rates follow from the matrices alone.
        let declared = Equilibrium::<1> {
            t,
            q: SVector::zeros(),
            multipliers: Vec::new(),
            directions: DMatrix::zeros(size, rest.freedom),
            mass,
            damping,
            stiffness,
            free_motions: DMatrix::zeros(size, rest.free_motions),
            residual: rest.residual,
        };
        rest.rates = pairs(declared.rates()?);
        Ok(rest)
    }
}

#[cfg(feature = "studies")]
impl Declared<dyn System> {
    fn cut_point(&self, mut of: PhasePoint) -> PhasePoint {
        of.q.truncate(self.size);
        of.v.truncate(self.size);
        of
    }
}

#[cfg(feature = "studies")]
impl Studies for Declared<dyn System> {
    fn step_density(&self, at: &PhasePoint) -> Option<f64> {
        self.of.studies().step_density(&self.point(at).ok()?)
    }

    fn step_densities(&self, t: f64, q: &[f64], p: &[f64]) -> [Option<f64>; ENERGY_STAGES.len()] {
        let [q, p] = [q, p].map(|of| extended(of, self.all()));
        self.of.studies().step_densities(t, &q, &p)
    }

    fn follow(&self, from: &PhasePoint, end: f64) -> Result<PhasePoint, StepError> {
        Ok(self.cut_point(self.of.studies().follow(&self.point(from)?, end)?))
    }

    fn lyapunov(&self, plan: &Plan, count: usize, coordinates: usize) -> Result<Box<dyn Exponents>, StepError> {
        let of = self.of.studies().lyapunov(&self.plan(plan)?, count, coordinates.min(self.size))?;
        Ok(Box::new(Declared { of, size: self.size }))
    }

    fn rival(
        &self,
        from: &PhasePoint,
        end: f64,
        tolerance: f64,
        evaluations: &Cell<u64>,
        watch: Option<&mut dyn FnMut(f64, f64)>,
    ) -> Result<PhasePoint, Ended> {
        let reached = self.of.studies().rival(&self.point(from)?, end, tolerance, evaluations, watch)?;
        Ok(self.cut_point(reached))
    }
}

#[cfg(feature = "studies")]
impl Exponents for Declared<dyn Exponents> {
    forward! {
        fn advance(&mut self, steps: u64) -> Result<(), StepError>;
        fn t(&self) -> f64;
        fn exponents(&self) -> Vec<f64>;
    }

    fn q(&self) -> &[f64] {
        &self.of.q()[..self.size]
    }
}

/// A linearization without the rows and columns of the coordinates at rest.
#[cfg(feature = "derivatives")]
fn cut_linear(of: &Linear, all: usize, size: usize) -> Linear {
    // Coordinates, then velocities or momenta.
    let halves = |of: &[f64]| cut(of, all, size);
    let inputs = of.b.len() / (2 * all);
    Linear {
        t: of.t,
        value: halves(&of.value),
        a: cut(&of.a, 2 * all * all, 2 * all * size).chunks_exact(all).flat_map(|of| &of[..size]).copied().collect(),
        b: cut(&of.b, all * inputs, size * inputs),
    }
}

impl Declared<dyn Simulation> {
    /// Sections whose functions take the declared coordinates.
    fn sections(&self, sections: &[Section]) -> Vec<Section> {
        let size = self.size;
        let of_all = |section: &Section| match section.clone() {
            Section::Function(watch, direction) => {
                let of_declared = Watch::new(move |t, q, v| watch.value(t, &q[..size], &v[..size]));
                Section::Function(of_declared, direction)
            }
            other => other,
        };
        sections.iter().map(of_all).collect()
    }
}

/// A crossing of the declared coordinates.
fn cut_met(mut met: Met, size: usize) -> Met {
    met.row.q.truncate(size);
    met.row.p.truncate(size);
    met
}

impl Steps for Declared<dyn Simulation> {
    forward!(Steps);
    forward! {
        fn advance(&mut self) -> Result<(), StepError>;
        fn largest_error(&self) -> Option<ErrorEstimate>;
    }

    fn q(&self) -> Cow<'_, [f64]> {
        match self.of.q() {
            Cow::Borrowed(q) => Cow::Borrowed(&q[..self.size]),
            Cow::Owned(mut q) => {
                q.truncate(self.size);
                Cow::Owned(q)
            }
        }
    }

    fn p(&self) -> &[f64] {
        &self.of.p()[..self.size]
    }
}

impl Simulation for Declared<dyn Simulation> {
    forward!(Simulation);
    forward! { fn advance_until(&mut self, end: f64, most: u64) -> Result<u64, StepError>; }

    fn copy(&self) -> Box<dyn Simulation> {
        Box::new(Declared { of: self.of.copy(), size: self.size })
    }

    fn cross(&mut self, sections: &[Section], end: f64, take: &mut dyn FnMut(Met) -> bool) -> Result<(), StepError> {
        let (sections, size) = (self.sections(sections), self.size);
        self.of.cross(&sections, end, &mut |met| take(cut_met(met, size)))
    }
}

#[cfg(feature = "sessions")]
impl Declared<dyn Simulation> {
    fn all(&self) -> usize {
        self.of.p().len()
    }

    /// Derivatives without those of the coordinates at rest, nor with respect to them.
    #[cfg(feature = "derivatives")]
    fn declared(&self, rows: Vec<Vec<f64>>) -> Vec<Vec<f64>> {
        let (all, size) = (self.all(), self.size);
        let is_declared = |at: usize| at >= 2 * all || at % all < size;
        let declared = |of: Vec<f64>| of.into_iter().enumerate().filter(|(at, _)| is_declared(*at));
        let rows = rows.into_iter().enumerate().filter(|(at, _)| is_declared(*at));
        rows.map(|(_, row)| declared(row).map(|(_, entry)| entry).collect()).collect()
    }

    /// Adds what a function records, without the coordinates at rest.
    fn recorded<Y>(&mut self, rows: &mut Rows, record: impl FnOnce(&mut dyn Simulation, &mut Rows) -> Y) -> Y {
        let (all, mut found) = (self.all(), Rows::default());
        let outcome = record(&mut *self.of, &mut found);
        rows.t.extend(found.t);
        rows.q.extend(cut(&found.q, all, self.size));
        rows.p.extend(cut(&found.p, all, self.size));
        outcome
    }
}

/// Dense output of the declared coordinates.
#[cfg(feature = "sessions")]
impl StepOutput for Declared<dyn StepOutput> {
    fn at(&self, t: f64) -> [Vec<f64>; 3] {
        self.of.at(t).map(|mut of| {
            of.truncate(self.size);
            of
        })
    }
}

#[cfg(feature = "sessions")]
impl Session for Declared<dyn Simulation> {
    forward! {
        fn parameters(&self) -> Vec<f64>;
        fn set_parameters(&mut self, change: &[(usize, f64)]) -> Result<(), StepError>;
        fn advance_of(&mut self, h: f64) -> Result<(), StepError>;
        #[cfg(feature = "checkpoints")]
        fn checkpoint(&self) -> Result<String, String>;
    }

    fn velocity(&self) -> Result<Vec<f64>, StepError> {
        let mut velocity = self.of.velocity()?;
        velocity.truncate(self.size);
        Ok(velocity)
    }

    fn set_state(&mut self, change: &[(usize, f64)], (t, q, p): (f64, &[f64], &[f64])) -> Result<(), StepError> {
        let q = with_rest(q, self.size, self.all(), "number of coordinates")?;
        let p = with_rest(p, self.size, self.all(), "number of momenta")?;
        self.of.set_state(change, (t, &q, &p))
    }

    fn record(
        &mut self,
        end: Option<f64>,
        most: u64,
        every: u64,
        taken: &mut u64,
        rows: &mut Rows,
    ) -> Result<bool, StepError> {
        self.recorded(rows, |run, rows| run.record(end, most, every, taken, rows))
    }

    fn record_at(&mut self, times: &[f64], rows: &mut Rows) -> Result<(), StepError> {
        self.recorded(rows, |run, rows| run.record_at(times, rows))
    }

    fn next_crossing(&mut self, sections: &[Section], end: f64) -> Result<Option<Met>, StepError> {
        let sections = self.sections(sections);
        let met = self.of.next_crossing(&sections, end)?;
        Ok(met.map(|met| cut_met(met, self.size)))
    }

    fn step_output(&self, t: f64, q: &[f64], p: &[f64]) -> Result<Box<dyn StepOutput>, StepError> {
        let q = with_rest(q, self.size, self.all(), "number of coordinates")?;
        let p = with_rest(p, self.size, self.all(), "number of momenta")?;
        Ok(Box::new(Declared { of: self.of.step_output(t, &q, &p)?, size: self.size }))
    }

    fn local_error(&self) -> Result<[Vec<f64>; 2], StepError> {
        Ok(self.of.local_error()?.map(|of| of[..self.size].to_vec()))
    }

    #[cfg(feature = "derivatives")]
    fn linearization(&self) -> Result<Linear, StepError> {
        Ok(cut_linear(&self.of.linearization()?, self.all(), self.size))
    }

    #[cfg(feature = "derivatives")]
    fn tangent(
        &mut self,
        wanted: Wanted<'_>,
        goes_on: &mut dyn FnMut() -> bool,
    ) -> Result<Option<Vec<Vec<f64>>>, StepError> {
        Ok(self.of.tangent(wanted, goes_on)?.map(|rows| self.declared(rows)))
    }

    #[cfg(feature = "derivatives")]
    fn curvature(&self, wanted: Wanted<'_>, weights: &[f64]) -> Result<Option<Vec<f64>>, StepError> {
        self.of.curvature(wanted, weights)
    }

    #[cfg(feature = "derivatives")]
    fn tangents_at(
        &mut self,
        times_and_parameters: (&[f64], &[usize]),
        has_velocities: [bool; 2],
        goes_on: &mut dyn FnMut() -> bool,
    ) -> Result<Option<Vec<Vec<Vec<f64>>>>, StepError> {
        let found = self.of.tangents_at(times_and_parameters, has_velocities, goes_on)?;
        Ok(found.map(|of| of.into_iter().map(|rows| self.declared(rows)).collect()))
    }

    #[cfg(feature = "derivatives")]
    fn lyapunov(
        &mut self,
        steps: u64,
        [count, coordinates]: [usize; 2],
        goes_on: &mut dyn FnMut() -> bool,
    ) -> Result<Option<Vec<f64>>, StepError> {
        self.of.lyapunov(steps, [count, coordinates.min(self.size)], goes_on)
    }

    #[cfg(feature = "derivatives")]
    fn gradient(
        &mut self,
        wanted: Wanted<'_>,
        slope: &[f64],
        goes_on: &mut dyn FnMut() -> bool,
    ) -> Result<Option<Vec<f64>>, StepError> {
        let (all, size) = (self.all(), self.size);
        if slope.len() != 2 * size + 1 {
            return Err(wrong_size(slope, "number of coordinates, momenta and the time"));
        }
        let (state, t) = slope.split_at(2 * size);
        let slope: Vec<f64> = state.chunks_exact(size).flat_map(|of| extended(of, all)).chain(t.to_vec()).collect();
        let found = self.of.gradient(wanted, &slope, goes_on)?;
        Ok(found.map(|of| {
            let (state, parameters) = of.split_at(2 * all);
            cut(state, all, size).into_iter().chain(parameters.iter().copied()).collect()
        }))
    }
}
