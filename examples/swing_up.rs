//! Optimal control: a cart swings its pole up with the least force.
//!
//! In: nothing. Out: the force of each step, and the state of the pole after it; `cargo run --release --example
//! swing_up`. With forces `u_k`, constant over a step each,
//!
//! ```text
//! minimise  C(u) = h/2 Σ u_k²        such that the run of Gauss steps ends in  z_K = (x, a, p_x, p_a) = 0
//! ```
//!
//! It is discrete mechanics and optimal control (Ober-Blöbaum, Junge and Marsden, ESAIM: COCV 17, 2011): the steps are
//! the constraints. The gradient of C is the exact gradient for these steps, without an error of time discretization,
//! and takes one backward pass. The condition at the end is an augmented Lagrangian (Nocedal and Wright, *Numerical
//! Optimization*, 17.3), minimised by L-BFGS. Rounding ends the line search of L-BFGS at a gradient of about 1e-6; two
//! Newton steps for the gradient reduce it further.

use argmin::core::{CostFunction, Error, Executor, Gradient as HasGradient, State as _};
use argmin::solver::linesearch::MoreThuenteLineSearch;
use argmin::solver::quasinewton::LBFGS;
use vi_core::derivatives::{Covector, Objective, gradient};
use vi_core::nalgebra::{DMatrix, DVector};
use vi_core::{Gauss, Run, SVector, Starts, State, StepError, lagrangian};

lagrangian! {
    /// A pole on a cart; the angle a is zero where the pole is upright.
    struct CartPole {
        param M = 1.0, m = 0.2, l = 0.5, g = 9.81;
        /// Force on the cart.
        input u = 0.0;
        coord x, a;
        L = (M + m) * dot(x)^2 / 2 + m * l * dot(x) * dot(a) * cos(a) + m * l^2 * dot(a)^2 / 2 - m * g * l * cos(a);
        force x = u;
        discretize midpoint;
    }
}

/// Steps of order 4.
type Swing = Run<Gauss<2>, CartPole, 2>;

/// Length of a step, in seconds.
const H: f64 = 0.1;
/// Steps: two and a half seconds.
pub(crate) const STEPS: u32 = 25;
/// Maximum distance of the end from the goal.
pub(crate) const TOLERANCE: f64 = 1e-8;

/// The augmented Lagrangian `C + λ·z_K + (w/2) |z_K|²`.
#[derive(Clone)]
pub(crate) struct SwingUp {
    start: Swing,
    /// λ.
    multipliers: SVector<f64, 4>,
    /// w.
    weight: f64,
}

impl SwingUp {
    /// The pole hangs at rest, and the weight of its end is small.
    pub(crate) fn new() -> Result<Self, StepError> {
        let pole = CartPole::default();
        let start = State::at(&pole, 0.0, [0.0, std::f64::consts::PI], [0.0, 0.0]);
        Ok(Self { start: pole.at_state(start).integrate(Gauss::<2>, H)?, multipliers: SVector::zeros(), weight: 100.0 })
    }

    /// The state at the end under these forces.
    pub(crate) fn end(&self, forces: &[f64]) -> Result<SVector<f64, 4>, StepError> {
        let mut run = self.start.clone();
        for &force in forces {
            run.set_parameters(|pole| pole.u = force)?;
            run.step()?;
        }
        Ok(coordinates(&run.state()))
    }

    /// The augmented Lagrangian, which is minimised.
    pub(crate) fn value(&self, forces: &[f64]) -> Result<f64, StepError> {
        let z = self.end(forces)?;
        Ok(price(forces) + self.multipliers.dot(&z) + 0.5 * self.weight * z.norm_squared())
    }

    /// The gradient of the augmented Lagrangian.
    pub(crate) fn slope(&self, forces: &[f64]) -> Result<Vec<f64>, StepError> {
        let steps = forces.len() as u64;
        let of_the_end = gradient(&self.start, steps, forces.len(), &EndObjective { forces, problem: self })?;
        Ok(of_the_end.parameters.iter().zip(forces).map(|(by, force)| by[0] + H * force).collect())
    }
}

/// The cost of forces.
fn price(forces: &[f64]) -> f64 {
    0.5 * H * forces.iter().map(|force| force * force).sum::<f64>()
}

/// Coordinates and momenta.
fn coordinates(state: &State<2>) -> SVector<f64, 4> {
    SVector::from([state.q[0], state.q[1], state.p[0], state.p[1]])
}

/// The objective of the end of a run with these forces, for the backward pass.
struct EndObjective<'a> {
    forces: &'a [f64],
    problem: &'a SwingUp,
}

impl Objective<Gauss<2>, CartPole, 2> for EndObjective<'_> {
    fn prepare(&self, step: u64, run: &mut Swing) -> Result<(), StepError> {
        let force = usize::try_from(step).ok().and_then(|step| self.forces.get(step)).copied().unwrap_or(0.0);
        run.set_parameters(|pole| pole.u = force)
    }

    fn parameters(&self) -> &[&str] {
        &["u"]
    }

    fn slope(&self, step: u64, state: &State<2>) -> Covector<2> {
        if step < self.forces.len() as u64 {
            return Covector::zero();
        }
        let SwingUp { multipliers, weight, .. } = self.problem;
        let by = multipliers + coordinates(state) * *weight;
        Covector { q: [by[0], by[1]].into(), p: [by[2], by[3]].into(), ..Covector::zero() }
    }
}

impl CostFunction for SwingUp {
    type Param = Vec<f64>;
    type Output = f64;

    fn cost(&self, forces: &Vec<f64>) -> Result<f64, Error> {
        Ok(self.value(forces)?)
    }
}

impl HasGradient for SwingUp {
    type Param = Vec<f64>;
    type Gradient = Vec<f64>;

    fn gradient(&self, forces: &Vec<f64>) -> Result<Vec<f64>, Error> {
        Ok(self.slope(forces)?)
    }
}

/// The forces, and the problem with the multipliers at which they are its minimum.
pub(crate) fn solved() -> Result<(Vec<f64>, SwingUp), Error> {
    let mut problem = SwingUp::new()?;
    // At rest below both directions are equivalent: a push selects one.
    let mut forces: Vec<f64> = (0..STEPS).map(|step| 2.0 * (f64::from(step) * H * 5.0).sin()).collect();
    for _ in 0..20 {
        let solver =
            LBFGS::new(MoreThuenteLineSearch::new(), 40).with_tolerance_grad(1e-9)?.with_tolerance_cost(0.0)?;
        let outcome = Executor::new(problem.clone(), solver)
            .configure(|state| state.param(forces.clone()).max_iters(2000))
            .run()?;
        if let Some(best) = outcome.state().get_best_param() {
            forces.clone_from(best);
        }
        for _ in 0..2 {
            forces = corrected(&problem, &forces)?;
        }
        let z = problem.end(&forces)?;
        println!("force {:.6}, at its end {:.1e} from the top", price(&forces), z.norm());
        if z.norm() < TOLERANCE {
            break;
        }
        problem.multipliers += z * problem.weight;
        problem.weight = (10.0 * problem.weight).min(1e5);
    }
    Ok((forces, problem))
}

/// The forces after a Newton step for the gradient, with derivatives of the gradient by differences.
fn corrected(problem: &SwingUp, forces: &[f64]) -> Result<Vec<f64>, Error> {
    const BY: f64 = 1e-5;
    let moved = |index: usize, by: f64| {
        let mut moved = forces.to_vec();
        moved[index] += by;
        problem.slope(&moved).map(DVector::from)
    };
    let mut columns = Vec::with_capacity(forces.len());
    for index in 0..forces.len() {
        columns.push((moved(index, BY)? - moved(index, -BY)?) / (2.0 * BY));
    }
    let slope = DVector::from(problem.slope(forces)?);
    let step = DMatrix::from_columns(&columns).lu().solve(&slope).ok_or_else(|| Error::msg("no curvature"))?;
    Ok(forces.iter().zip(&step).map(|(force, step)| force - step).collect())
}

fn main() -> Result<(), Error> {
    let (forces, _) = solved()?;
    for (step, force) in (0..STEPS).zip(&forces) {
        println!("{:5.2} s {force:9.4} N", f64::from(step) * H);
    }
    Ok(())
}
