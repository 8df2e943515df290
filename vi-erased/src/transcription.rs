//! Optimal control as a nonlinear program, by direct multiple shooting.
//!
//! In: a system, a method whose steps have a given length, inputs that are constant over each of K steps, a cost and
//! conditions. Out: a [`Transcription`], the callbacks that a solver of nonlinear programs needs:
//!
//! ```text
//! minimise f(x)    with    lower ≤ x ≤ upper    and    row_lower ≤ g(x) ≤ row_upper
//! ```
//!
//! The variables are the duration, and q, p and the inputs of each node. The first rows of g are the steps: the end of
//! each one, from its node, less the next node. Everything but these equalities is local: the step, the cost and the
//! conditions of a node depend on its variables `w = (q, p, u, duration)`.
//!
//! Source: Bock and Plitt, A multiple shooting algorithm for direct solution of optimal control problems (1984);
//! Ober-Blöbaum, Junge and Marsden, Discrete mechanics and optimal control, ESAIM: COCV 17 (2011).

use crate::function::{Function, Points};
use crate::plan::{PhasePoint, Plan};
use crate::shooting::{Curvatures, Ends, Shots};
use crate::system::System;
use core::cell::OnceCell;
use core::ops::RangeInclusive;
use vi_core::StepError;

/// Points and weights on (0, 1) of the cost of a step, of order 6.
const GAUSS: [(f64, f64); 3] =
    [(0.112_701_665_379_258_31, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.887_298_334_620_741_7, 5.0 / 18.0)];

/// The nodes in time.
#[derive(Clone, Debug, PartialEq)]
pub struct Mesh {
    /// The time of the first node.
    pub start: f64,
    /// The nodes as shares of the duration: from 0 to 1, ascending.
    pub shares: Vec<f64>,
    /// The least and the greatest duration.
    pub duration: [f64; 2],
}

impl Mesh {
    /// Steps of equal length, from the time 0 on.
    #[must_use]
    pub fn even(steps: u32, duration: RangeInclusive<f64>) -> Self {
        let shares = (0..=steps).map(|k| f64::from(k) / f64::from(steps)).collect();
        Self { start: 0.0, shares, duration: [*duration.start(), *duration.end()] }
    }
}

/// The places of the entries of a sparse matrix, in compressed columns.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Pattern {
    /// The index of the first entry of each column, then the number of entries.
    pub starts: Vec<usize>,
    /// The row of each entry, ascending in each column.
    pub rows: Vec<usize>,
    /// For each number, in the order in which a transcription finds them, the entry to which it adds.
    entries: Vec<usize>,
}

impl Pattern {
    /// The pattern of numbers at these rows and columns.
    fn of(places: &[(usize, usize)], columns: usize) -> Self {
        let mut order: Vec<usize> = (0..places.len()).collect();
        order.sort_by_key(|index| (places[*index].1, places[*index].0));
        let (mut starts, mut rows, mut entries) = (vec![0; columns + 1], Vec::new(), vec![0; places.len()]);
        let mut last = None;
        for index in order {
            let (row, column) = places[index];
            if last != Some((row, column)) {
                rows.push(row);
                starts[column + 1] += 1;
                last = Some((row, column));
            }
            entries[index] = rows.len() - 1;
        }
        for column in 0..columns {
            starts[column + 1] += starts[column];
        }
        Self { starts, rows, entries }
    }

    /// The row and the column of each entry.
    pub fn places(&self) -> impl Iterator<Item = (usize, usize)> {
        let columns = self.starts.windows(2).enumerate();
        let columns = columns.flat_map(|(column, bounds)| core::iter::repeat_n(column, bounds[1] - bounds[0]));
        self.rows.iter().copied().zip(columns)
    }

    /// The entries from the numbers.
    fn gathered(&self, numbers: &[f64]) -> Vec<f64> {
        let mut values = vec![0.0; self.rows.len()];
        for (entry, number) in self.entries.iter().zip(numbers) {
            values[*entry] += number;
        }
        values
    }
}

/// The functions of the program at one point. What has no value is NaN.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Evaluation {
    /// f.
    pub cost: f64,
    /// The gradient of f.
    pub gradient: Vec<f64>,
    /// g.
    pub rows: Vec<f64>,
    /// The Jacobian of g: the entries of [`Transcription::jacobian_pattern`].
    pub jacobian: Vec<f64>,
    /// The first step without an end, and why.
    pub error: Option<(usize, StepError)>,
}

/// A condition at some nodes. Its rows are behind those of the steps.
struct Row {
    nodes: Vec<usize>,
    of: Box<dyn Function>,
    bounds: [f64; 2],
}

/// A function of a node or of a step, by its local variables.
#[derive(Clone, Debug)]
struct Local {
    value: f64,
    slope: Vec<f64>,
    /// Second derivatives, row by row; empty unless they were requested.
    curvature: Vec<f64>,
}

/// An optimal control problem as a nonlinear program.
///
/// ```text
/// x = (duration, q_0, p_0, u_0, q_1, p_1, u_1, …, u_{K−1}, q_K, p_K)
/// ```
///
/// The last node has the inputs of the last step.
pub struct Transcription {
    system: Box<dyn System>,
    /// Its number of coordinates.
    n: usize,
    plan: Plan,
    mesh: Mesh,
    /// The length of each step as a share of the duration; the last node has the last one.
    widths: Vec<f64>,
    /// The values of all parameters.
    parameters: Vec<f64>,
    inputs: Vec<usize>,
    bounds: Vec<[f64; 2]>,
    cost: Option<Box<dyn Function>>,
    final_cost: Option<Box<dyn Function>>,
    rows: Vec<Row>,
    /// Found at the first request, since each condition changes it.
    jacobian: OnceCell<Pattern>,
    hessian: Pattern,
}

impl Transcription {
    /// The steps of a method as the rows of a program. `inputs` has the indices of the parameters to find; the others
    /// stay. The start of the plan is unused.
    ///
    /// # Errors
    /// [`StepError::InvalidInput`] for a method that finds the lengths of its steps, for shares that do not ascend from 0
    /// to 1, for a duration that is not positive, and for an input that is no parameter. Those of [`System::offers`].
    pub fn of(system: &dyn System, plan: &Plan, mesh: Mesh, inputs: &[usize]) -> Result<Self, StepError> {
        let wrong = |input, allowed, value| Err(StepError::InvalidInput { input, allowed, value });
        if plan.finds_length() || plan.tolerance.is_some() {
            return wrong(
                "steps of optimal control",
                "of a given length: not energy, adaptive or transformed",
                f64::NAN,
            );
        }
        system.offers(plan.wanted(system.has_constraints()))?;
        let parameters: Vec<f64> = system.parameters().iter().map(|(_, value)| *value).collect();
        let shares = &mesh.shares;
        let ascend = shares.windows(2).all(|pair| pair[0] < pair[1]);
        let (first, last) = (shares.first().copied(), shares.last().copied());
        if !ascend || first != Some(0.0) || last != Some(1.0) {
            return wrong("shares of the duration", "ascending from 0 to 1", last.unwrap_or(f64::NAN));
        }
        let [least, greatest] = mesh.duration;
        if !(0.0 < least && least <= greatest && least.is_finite()) {
            return wrong("duration", "positive, and the greatest at least the least", least);
        }
        if let Some(beyond) = inputs.iter().find(|index| **index >= parameters.len()) {
            #[allow(clippy::cast_precision_loss)] // for the message
            return wrong("index of an input", "below the number of parameters", *beyond as f64);
        }
        let mut widths: Vec<f64> = shares.windows(2).map(|pair| pair[1] - pair[0]).collect();
        widths.extend(widths.last().copied());
        let (n, steps) = (system.coordinates().len(), shares.len() - 1);
        let mut bounds = vec![[f64::NEG_INFINITY, f64::INFINITY]; 1 + steps * (2 * n + inputs.len()) + 2 * n];
        bounds[0] = mesh.duration;
        let mut of = Self {
            system: system.copy(),
            n,
            plan: plan.clone(),
            mesh,
            widths,
            parameters,
            inputs: inputs.to_vec(),
            bounds,
            cost: None,
            final_cost: None,
            rows: Vec::new(),
            jacobian: OnceCell::new(),
            hessian: Pattern::default(),
        };
        of.hessian = of.upper_half();
        Ok(of)
    }

    /// The function whose integral is least. Three Gauss points in each step take the integral.
    pub fn set_cost(&mut self, of: Box<dyn Function>) {
        self.cost = Some(of);
    }

    /// A function at the end that is added to the cost.
    pub fn set_final_cost(&mut self, of: Box<dyn Function>) {
        self.final_cost = Some(of);
    }

    /// Adds bounds of a function at these nodes: one row for each, in this order, behind the rows so far.
    pub fn bound(&mut self, of: Box<dyn Function>, nodes: &[usize], bounds: [f64; 2]) {
        self.rows.push(Row { nodes: nodes.to_vec(), of, bounds });
        self.jacobian = OnceCell::new();
    }

    /// Adds bounds of a velocity, given by the index of its coordinate, as [`Self::bound`].
    pub fn bound_velocity(&mut self, index: usize, nodes: &[usize], bounds: [f64; 2]) {
        self.bound(Box::new(Velocity { index, n: self.n, inputs: self.inputs.len() }), nodes, bounds);
    }

    /// The bounds of the variables: those of the duration, and no others to begin with.
    #[must_use]
    pub fn bounds(&self) -> &[[f64; 2]] {
        &self.bounds
    }

    /// The bounds of the variables, to be set at the index [`Self::place`]. The bounds of the duration stay as the mesh
    /// has them.
    pub fn bounds_mut(&mut self) -> &mut [[f64; 2]] {
        &mut self.bounds
    }

    /// The place among the variables of the local one of a node: its q, p and inputs, then the duration.
    #[must_use]
    pub fn place(&self, node: usize, local: usize) -> usize {
        let (each, state) = (self.locals() - 1, 2 * self.n);
        match local {
            _ if local == each => 0,
            _ if local >= state && node == self.steps() => 1 + each * (node - 1) + local,
            _ => 1 + each * node + local,
        }
    }

    /// The bounds of the rows.
    #[must_use]
    pub fn row_bounds(&self) -> Vec<[f64; 2]> {
        let of_rows = self.rows.iter().flat_map(|row| core::iter::repeat_n(row.bounds, row.nodes.len()));
        core::iter::repeat_n([0.0; 2], self.step_rows()).chain(of_rows).collect()
    }

    /// The places of the Jacobian of g.
    #[must_use]
    pub fn jacobian_pattern(&self) -> &Pattern {
        self.jacobian.get_or_init(|| self.derivatives_of_rows())
    }

    /// The places of the upper half of the Hessian matrix, the diagonal included.
    #[must_use]
    pub fn hessian_pattern(&self) -> &Pattern {
        &self.hessian
    }

    /// The variables of a motion: the run of the inputs, M for each of the K steps, from coordinates and velocities.
    ///
    /// # Errors
    /// The error of the first step that fails; [`StepError::InvalidInput`] for another number of coordinates.
    pub fn rolled_out(&self, duration: f64, (q, v): (&[f64], &[f64]), inputs: &[f64]) -> Result<Vec<f64>, StepError> {
        let (m, start) = (self.inputs.len(), PhasePoint { t: self.mesh.start, q: q.to_vec(), v: v.to_vec() });
        let mut x = vec![duration];
        let mut state = (q.to_vec(), self.system.with_parameters(&self.numbers(&inputs[..m])).momentum(&start)?);
        for (k, u) in inputs.chunks_exact(m).take(self.steps()).enumerate() {
            x.extend(state.0.iter().chain(&state.1).chain(u));
            let plan = Plan {
                t: self.time(k, 0.0, duration),
                h: self.widths[k] * duration,
                q: state.0,
                p: Some(state.1),
                ..self.plan.clone()
            };
            let mut run = self.system.with_parameters(&self.numbers(u)).begin(&plan)?;
            run.advance_by(1)?;
            state = (run.q().to_vec(), run.p().to_vec());
        }
        x.extend(state.0.iter().chain(&state.1));
        Ok(x)
    }

    /// f, g and their first derivatives at x.
    #[must_use]
    pub fn evaluate(&self, x: &[f64]) -> Evaluation {
        let steps = self.steps();
        let ends = self.ends(x, self.whole_steps());
        let (mut rows, mut numbers) = (Vec::new(), Vec::new());
        for k in 0..steps {
            for (entry, end) in ends.state(k).iter().enumerate() {
                rows.push(end - x[self.place(k + 1, entry)]);
                numbers.extend(self.by_duration(&ends, k, entry));
                numbers.push(-1.0);
            }
        }
        let (mut cost, mut gradient) = (0.0, vec![0.0; self.bounds.len()]);
        let mut add = |k: usize, of: &Local| {
            cost += of.value;
            for (local, slope) in of.slope.iter().enumerate() {
                gradient[self.place(k, local)] += slope;
            }
        };
        for (k, of) in self.integrals(x, false).iter().enumerate() {
            add(k, of);
        }
        let nodes = self.at_nodes(x);
        for row in &self.rows {
            for of in self.composed(x, &nodes.picked(&row.nodes), &*row.of, None) {
                rows.push(of.value);
                numbers.extend(of.slope);
            }
        }
        if let Some(of) = &self.final_cost {
            self.composed(x, &nodes.picked(&[steps]), &**of, None).iter().for_each(|of| add(steps, of));
        }
        let jacobian = self.jacobian_pattern().gathered(&numbers);
        Evaluation { cost, gradient, rows, jacobian, error: ends.of.errors.first().copied() }
    }

    /// The Hessian matrix of `weight f + multipliers · g` at x: the entries of [`Self::hessian_pattern`]. Those without a
    /// value are zero.
    #[must_use]
    pub fn hessian(&self, x: &[f64], weight: f64, multipliers: &[f64]) -> Vec<f64> {
        let (steps, locals) = (self.steps(), self.locals());
        let (of_steps, mut others) = multipliers.split_at(self.step_rows());
        let mut blocks = vec![vec![0.0; locals * locals]; steps + 1];
        let mut add = |k: usize, factor: f64, of: &[f64]| {
            blocks[k].iter_mut().zip(of).for_each(|(sum, number)| *sum += factor * number);
        };
        for (k, of) in self.curved(x, &self.whole_steps(), of_steps).iter().enumerate() {
            add(k, 1.0, of);
        }
        for (k, of) in self.integrals(x, true).iter().enumerate() {
            add(k, weight, &of.curvature);
        }
        let nodes = self.at_nodes(x);
        for row in &self.rows {
            let (own, behind) = others.split_at(row.nodes.len());
            others = behind;
            for (k, of) in row.nodes.iter().zip(self.composed(x, &nodes.picked(&row.nodes), &*row.of, Some(own))) {
                add(*k, 1.0, &of.curvature);
            }
        }
        if let Some(of) = &self.final_cost {
            for of in self.composed(x, &nodes.picked(&[steps]), &**of, Some(&[weight])) {
                add(steps, 1.0, &of.curvature);
            }
        }
        let finite = |number: f64| if number.is_finite() { number } else { 0.0 };
        let numbers: Vec<f64> = self.halves().map(|[k, a, b]| finite(blocks[k][a * locals + b])).collect();
        self.hessian.gathered(&numbers)
    }

    fn steps(&self) -> usize {
        self.mesh.shares.len() - 1
    }

    fn all_steps(&self) -> Vec<usize> {
        (0..self.steps()).collect()
    }

    fn step_rows(&self) -> usize {
        2 * self.n * self.steps()
    }

    /// The number of variables of a node: q, p, its inputs, and the duration.
    fn locals(&self) -> usize {
        2 * self.n + self.inputs.len() + 1
    }

    /// The values of all parameters with these inputs.
    fn numbers(&self, inputs: &[f64]) -> Vec<f64> {
        let mut values = self.parameters.clone();
        for (index, value) in self.inputs.iter().zip(inputs) {
            values[*index] = *value;
        }
        values
    }

    /// The derivative of the time at a part of a step with respect to the duration.
    fn share(&self, k: usize, part: f64) -> f64 {
        self.mesh.shares[k] + part * self.widths[k]
    }

    /// The time at a part of a step.
    fn time(&self, k: usize, part: f64, duration: f64) -> f64 {
        self.mesh.start + self.share(k, part) * duration
    }

    /// The blocks of the upper half of the Hessian matrix: node, and two of its local variables. A given duration does
    /// not vary.
    fn halves(&self) -> impl Iterator<Item = [usize; 3]> {
        let [least, greatest] = self.mesh.duration;
        let free = self.locals() - usize::from(least >= greatest);
        (0..=self.steps()).flat_map(move |k| (0..free).flat_map(move |a| (a..free).map(move |b| [k, a, b])))
    }

    /// The places of the derivatives that `evaluate` finds, in their order.
    fn derivatives_of_rows(&self) -> Pattern {
        let (locals, each) = (self.locals(), 2 * self.n);
        let mut places = Vec::new();
        for row in 0..self.step_rows() {
            let (k, entry) = (row / each, row % each);
            places.extend((0..locals).map(|local| (row, self.place(k, local))));
            places.push((row, self.place(k + 1, entry)));
        }
        for (row, k) in self.rows.iter().flat_map(|row| &row.nodes).enumerate() {
            places.extend((0..locals).map(|local| (self.step_rows() + row, self.place(*k, local))));
        }
        Pattern::of(&places, self.bounds.len())
    }

    /// The places of the second derivatives that `hessian` finds, in their order.
    fn upper_half(&self) -> Pattern {
        let upper = |[k, a, b]: [usize; 3]| {
            let (a, b) = (self.place(k, a), self.place(k, b));
            (a.min(b), a.max(b))
        };
        Pattern::of(&self.halves().map(upper).collect::<Vec<_>>(), self.bounds.len())
    }

    /// All steps, as the rows have them.
    fn whole_steps(&self) -> Legs {
        Legs { nodes: self.all_steps(), part: 1.0, steps: 1, has_velocities: false }
    }

    /// The ends of these parts of steps.
    fn ends(&self, x: &[f64], legs: Legs) -> Stops {
        let Legs { nodes, part, steps, has_velocities } = &legs;
        let of = self.shoot(x, nodes, *part, |shots| {
            shots.ends(&*self.system, &self.plan, &self.inputs, *steps, *has_velocities)
        });
        Stops { legs, of }
    }

    /// Coordinates and velocities of all nodes.
    fn at_nodes(&self, x: &[f64]) -> Stops {
        let nodes: Vec<usize> =
            if self.rows.is_empty() && self.final_cost.is_none() { Vec::new() } else { (0..=self.steps()).collect() };
        self.ends(x, Legs { nodes, ..Legs::CONVERSION })
    }

    /// Shots from some nodes over a part of their steps.
    fn shoot<R>(&self, x: &[f64], nodes: &[usize], part: f64, shoot: impl FnOnce(&Shots<'_>) -> R) -> R {
        let (n, duration) = (self.n, x[0]);
        let [mut t, mut h, mut q, mut p, mut parameters] = [const { Vec::new() }; 5];
        for &k in nodes {
            t.push(self.time(k, 0.0, duration));
            // A part of length zero only converts the state; the length of its step has no effect.
            h.push(if part == 0.0 { 1.0 } else { part } * self.widths[k] * duration);
            q.extend((0..n).map(|local| x[self.place(k, local)]));
            p.extend((n..2 * n).map(|local| x[self.place(k, local)]));
            parameters.extend(self.numbers(&self.inputs_at(x, k)));
        }
        shoot(&Shots { t: &t, q: &q, p: &p, h: &h, parameters: &parameters })
    }

    fn inputs_at(&self, x: &[f64], k: usize) -> Vec<f64> {
        (2 * self.n..self.locals() - 1).map(|local| x[self.place(k, local)]).collect()
    }

    /// The derivatives of an entry of an end with respect to the local variables: the length of the step and the time of
    /// its start depend on the duration.
    fn by_duration(&self, at: &Stops, index: usize, entry: usize) -> Vec<f64> {
        let (k, columns) = (at.legs.nodes[index], self.locals() + 1);
        let row = (index * 2 * self.n + entry) * columns;
        let slope = &at.of.jacobians[row..row + columns];
        let (own, others) = slope.split_at(columns - 2);
        let of_duration = others[0] * at.legs.part * self.widths[k] + others[1] * self.mesh.shares[k];
        own.iter().copied().chain([of_duration]).collect()
    }

    /// The second derivatives of weighted ends with respect to the local variables, row by row.
    fn curved(&self, x: &[f64], at: &Legs, weights: &[f64]) -> Vec<Vec<f64>> {
        let (n, locals) = (self.n, self.locals());
        // Coordinates are variables themselves at zero steps.
        let counts = |of: &[f64]| of[if at.steps == 0 { n } else { 0 }..].iter().any(|weight| *weight != 0.0);
        let shot: Vec<usize> = (0..at.nodes.len()).filter(|index| counts(&weights[2 * n * index..][..2 * n])).collect();
        let nodes: Vec<usize> = shot.iter().map(|index| at.nodes[*index]).collect();
        let own: Vec<f64> = shot.iter().flat_map(|index| &weights[2 * n * index..][..2 * n]).copied().collect();
        let Curvatures { values, .. } = self.shoot(x, &nodes, at.part, |shots| {
            shots.curvatures(&*self.system, &self.plan, &self.inputs, at.steps, at.has_velocities, &own)
        });
        let mut curved = vec![vec![0.0; locals * locals]; at.nodes.len()];
        let columns = locals + 1;
        for ((index, k), of) in shot.iter().zip(&nodes).zip(values.chunks_exact(columns * columns)) {
            // The duration has two columns: the length of the step, and the time of its start.
            let parts = [at.part * self.widths[*k], self.mesh.shares[*k]];
            let of_local = |local: usize| match local {
                _ if local + 1 == locals => [(local, parts[0]), (local + 1, parts[1])],
                _ => [(local, 1.0), (local, 0.0)],
            };
            for (entry, sum) in curved[*index].iter_mut().enumerate() {
                for (row, by_row) in of_local(entry / locals) {
                    for (column, by_column) in of_local(entry % locals) {
                        *sum += of[row * columns + column] * by_row * by_column;
                    }
                }
            }
        }
        curved
    }

    /// A function at the ends (q, v) of `at`, by the chain rule. With weights each curvature has one.
    fn composed(&self, x: &[f64], at: &Stops, of: &dyn Function, weights: Option<&[f64]>) -> Vec<Local> {
        let (n, m, locals) = (self.n, self.inputs.len(), self.locals());
        let Legs { nodes, part, .. } = &at.legs;
        let t: Vec<f64> = nodes.iter().map(|k| self.time(*k, *part, x[0])).collect();
        let entries =
            |first: usize| at.of.states.chunks_exact(2 * n).flat_map(move |of| &of[first..first + n]).copied();
        let (q, v): (Vec<f64>, Vec<f64>) = (entries(0).collect(), entries(n).collect());
        let parameters: Vec<f64> = nodes.iter().flat_map(|k| self.numbers(&self.inputs_at(x, *k))).collect();
        let points = Points { t: &t, q: &q, v: &v, parameters: &parameters };
        let [values, slopes] = [0, 1].map(|order| of.at(&points, order));
        let arguments = 1 + 2 * n + m;
        let by_arguments: Vec<Vec<Vec<f64>>> = (0..nodes.len())
            .map(|index| {
                let unit = |place: usize, value: f64| {
                    let mut row = vec![0.0; locals];
                    row[place] = value;
                    row
                };
                let time = unit(locals - 1, self.share(nodes[index], *part));
                let state = (0..2 * n).map(|entry| self.by_duration(at, index, entry));
                let inputs = (2 * n..2 * n + m).map(|place| unit(place, 1.0));
                [time].into_iter().chain(state).chain(inputs).collect()
            })
            .collect();
        let mut locals_of: Vec<Local> = values
            .iter()
            .zip(slopes.chunks_exact(arguments))
            .zip(&by_arguments)
            .map(|((value, slope), by)| {
                let along = |local: usize| slope.iter().zip(by).map(|(slope, row)| slope * row[local]).sum();
                Local { value: *value, slope: (0..locals).map(along).collect(), curvature: Vec::new() }
            })
            .collect();
        let Some(weights) = weights else { return locals_of };
        let scaled: Vec<f64> = slopes
            .chunks_exact(arguments)
            .zip(weights)
            .flat_map(|(slope, weight)| slope[1..=2 * n].iter().map(move |slope| slope * weight))
            .collect();
        let curved = self.curved(x, &at.legs, &scaled);
        let second = of.at(&points, 2);
        for (index, (own, mut sum)) in locals_of.iter_mut().zip(curved).enumerate() {
            let (by, second) = (&by_arguments[index], &second[index * arguments * arguments..]);
            for (i, j) in (0..arguments).flat_map(|i| (0..arguments).map(move |j| (i, j))) {
                let curvature = weights[index] * second[i * arguments + j];
                if curvature != 0.0 {
                    for (entry, sum) in sum.iter_mut().enumerate() {
                        *sum += curvature * by[i][entry / locals] * by[j][entry % locals];
                    }
                }
            }
            own.curvature = sum;
        }
        locals_of
    }

    /// The cost of each step.
    fn integrals(&self, x: &[f64], has_curvature: bool) -> Vec<Local> {
        let Some(cost) = &self.cost else { return Vec::new() };
        let (locals, nodes) = (self.locals(), self.all_steps());
        let zero = Local { value: 0.0, slope: vec![0.0; locals], curvature: vec![0.0; locals * locals] };
        let mut total = vec![zero; nodes.len()];
        let ones = vec![1.0; nodes.len()];
        let points: &[(f64, f64)] = if cost.is_of_inputs() { &[(0.0, 1.0)] } else { &GAUSS };
        for (part, weight) in points {
            let at = if cost.is_of_inputs() {
                Stops::nowhere(&nodes, 2 * self.n, locals + 1)
            } else {
                self.ends(x, Legs { nodes: nodes.clone(), part: *part, steps: 1, has_velocities: true })
            };
            let found = self.composed(x, &at, &**cost, has_curvature.then_some(&*ones));
            for (sum, of) in total.iter_mut().zip(found) {
                sum.value += weight * of.value;
                sum.slope.iter_mut().zip(of.slope).for_each(|(sum, slope)| *sum += weight * slope);
                sum.curvature.iter_mut().zip(of.curvature).for_each(|(sum, curvature)| *sum += weight * curvature);
            }
        }
        // The mean of a step becomes its integral: times the length, which depends on the duration.
        for (of, width) in total.iter_mut().zip(&self.widths) {
            let (h, duration) = (width * x[0], locals - 1);
            of.curvature.iter_mut().for_each(|curvature| *curvature *= h);
            for (local, slope) in of.slope.iter().enumerate() {
                of.curvature[local * locals + duration] += width * slope;
                of.curvature[duration * locals + local] += width * slope;
            }
            of.slope.iter_mut().for_each(|slope| *slope *= h);
            of.slope[duration] += width * of.value;
            of.value *= h;
        }
        total
    }
}

/// The same part of the steps from some nodes.
struct Legs {
    nodes: Vec<usize>,
    part: f64,
    /// One; zero convert momenta to velocities.
    steps: u64,
    has_velocities: bool,
}

impl Legs {
    /// No step: the velocities of nodes.
    const CONVERSION: Self = Self { nodes: Vec::new(), part: 0.0, steps: 0, has_velocities: true };
}

/// The states at the ends of legs.
struct Stops {
    legs: Legs,
    of: Ends,
}

impl Stops {
    /// Ends for a function of inputs alone.
    fn nowhere(nodes: &[usize], entries: usize, columns: usize) -> Self {
        let states = vec![0.0; nodes.len() * entries];
        let jacobians = vec![0.0; states.len() * columns];
        let of = Ends { states, jacobians, errors: Vec::new() };
        Self { legs: Legs { nodes: nodes.to_vec(), ..Legs::CONVERSION }, of }
    }

    /// The entries of one end.
    fn state(&self, index: usize) -> &[f64] {
        let each = self.of.states.len() / self.legs.nodes.len();
        &self.of.states[index * each..(index + 1) * each]
    }

    /// The ends at some of the nodes.
    fn picked(&self, nodes: &[usize]) -> Self {
        let picked = |of: &[f64]| -> Vec<f64> {
            let each = of.len() / self.legs.nodes.len();
            nodes.iter().flat_map(|k| &of[k * each..(k + 1) * each]).copied().collect()
        };
        let of = Ends { states: picked(&self.of.states), jacobians: picked(&self.of.jacobians), errors: Vec::new() };
        Self { legs: Legs { nodes: nodes.to_vec(), ..self.legs }, of }
    }
}

/// A velocity.
struct Velocity {
    index: usize,
    n: usize,
    inputs: usize,
}

impl Function for Velocity {
    fn at(&self, points: &Points<'_>, order: u8) -> Vec<f64> {
        let (count, arguments) = (points.t.len(), 1 + 2 * self.n + self.inputs);
        match order {
            0 => points.v.chunks_exact(self.n).map(|v| v[self.index]).collect(),
            1 => {
                let mut slope = vec![0.0; arguments];
                slope[1 + self.n + self.index] = 1.0;
                slope.repeat(count)
            }
            _ => vec![0.0; count * arguments * arguments],
        }
    }
}
