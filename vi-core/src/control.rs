//! The functions that a controller needs of a system: mass matrix, bias, inverse dynamics, linearizations, equilibria.
//!
//! Along the motion `M a + b = AᵀΛ`, with the mass matrix `M = L_vv`, the reaction AᵀΛ of constraints, and the bias
//!
//! ```text
//! b = L_vt + L_vq v − L_q − f            inputs and parameters as they are set
//! ```
//!
//! A linearization of x = (q, v), or of a step of (q, p), has one column of B for each `input` of the system, in the
//! order of [`Lagrangian::INPUTS`]. Inputs are constant over a step (zero-order hold).
//!
//! | file | contents |
//! |---|---|
//! | `equilibrium` | a state of rest, with its matrices and frequencies |
//! | `free`, `bound` | the search for it without and with constraints |
//! | `spectrum` | eigenvalues of matrices of a size known at run time |

mod bound;
mod equilibrium;
mod free;
mod spectrum;

pub use equilibrium::Equilibrium;

use crate::derivatives::{Differentiable, TOGETHER, Tangent, Variation, Varied};
use crate::error::StepError;
use crate::kind::Kind;
use crate::lagrangian::{Lagrangian, Parameters};
use crate::motion::Motion;
use crate::node::Node;
use crate::real::Dual;
use crate::run::Run;
use crate::state::{Numbers, State};
use crate::stepping::Convertible;
use alloc::vec::Vec;
use nalgebra::{Complex, DMatrix, DVector, SMatrix, SVector};

/// Mass matrix, bias, inverse dynamics, linearization and equilibria of a system, for every generated system.
///
/// All functions use the inputs and parameters as they are set. Times, coordinates, velocities, accelerations and
/// forces are in the units of the system.
pub trait Dynamics<const N: usize>: Convertible<N> {
    /// The mass matrix `M = L_vv` at (t, q, v). Its entries are not finite if L is not.
    fn mass_matrix(&self, t: f64, q: impl Numbers<N>, v: impl Numbers<N>) -> SMatrix<f64, N, N> {
        use crate::linear::Matrix;
        self.point(t, &q.vector(), &v.vector()).mass.dense()
    }

    /// The bias b at (t, q, v), with `M a + b = AᵀΛ` along the motion: Coriolis and centrifugal terms, gravity and other
    /// potentials, and generalized forces, with inputs as set. Its entries are not finite if L or f is not.
    fn bias(&self, t: f64, q: impl Numbers<N>, v: impl Numbers<N>) -> SVector<f64, N> {
        self.inverse_dynamics(t, q, v, SVector::zeros())
    }

    /// The generalized force `M a + b` that has to be added for the acceleration a at (t, q, v); a part `AᵀΛ` of it may
    /// come from constraints. It is zero for the acceleration of a motion without constraints. Its entries are not
    /// finite if L or f is not.
    fn inverse_dynamics(&self, t: f64, q: impl Numbers<N>, v: impl Numbers<N>, a: impl Numbers<N>) -> SVector<f64, N> {
        let (q, v, a) = (q.vector(), v.vector(), a.vector());
        let along = |value: f64, slope: f64| Dual { value, slope };
        let point = self.convert::<Dual<f64>>().point(Dual::variable(t), &q.zip_map(&v, along), &v.zip_map(&a, along));
        // d/dt L_v − (L_q + f)
        point.momentum.map(|entry| entry.slope) - point.force.map(|entry| entry.value)
    }

    /// The linearization of x = (q, v) at (t, q, v): `x' = value + A δx + B δu`, exact to rounding. A has 2N rows and
    /// columns, B one column for each input.
    ///
    /// With constraints, the point has to satisfy them. Changes δx that satisfy the derivatives of the constraints
    /// continue to do so. A has the eigenvalue zero twice for each holonomic constraint, and once for each other one.
    ///
    /// # Errors
    /// [`StepError::Singular`] if the mass matrix is singular or the constraints are redundant at q,
    /// [`StepError::InconsistentStart`] if (t, q, v) does not satisfy a constraint, [`StepError::NonFinite`] if L, f or a
    /// derivative is not finite, [`StepError::FirstOrder`] if L is linear in the velocities.
    fn linearization(&self, t: f64, q: impl Numbers<N>, v: impl Numbers<N>) -> Result<Linearization, StepError> {
        linearized(self, t, q.vector(), v.vector())
    }

    /// The equilibrium near a guess of the coordinates, at the time t: a state of rest without acceleration. See
    /// [`Equilibrium`].
    ///
    /// Without constraints, a coordinate on which nothing depends at the guess, as the place of a cart, keeps the value of
    /// the guess. With constraints, the guess may be off them: [`State::assembled`] moves it first. With constraints on
    /// velocities the equilibria form families: the result is reached from the guess along directions that these
    /// constraints allow. With a symmetry they form families, too: the result then has [`Equilibrium::free_motions`].
    ///
    /// # Errors
    /// [`StepError::NoEquilibrium`] if there is none near the guess; [`StepError::NonFinite`] if a derivative of L or f is
    /// not finite. Without constraints [`StepError::FreeMotion`] if the equilibria form a family along several
    /// coordinates, as those of two masses with a spring between them, or if the forces of a coordinate underflow at the
    /// guess. With constraints those of [`State::assembled`]; [`StepError::InconsistentStart`] if a constraint moves;
    /// [`StepError::Singular`] if the forces do not change along any direction, or the constraints are redundant.
    fn equilibrium(&self, t: f64, guess: impl Numbers<N>) -> Result<Equilibrium<N>, StepError> {
        let guess = guess.vector();
        if const { Self::Kind::COUNT == 0 } { free::find(self, t, guess) } else { bound::find(self, t, guess) }
    }
}

impl<S: Convertible<N>, const N: usize> Dynamics<N> for S {}

/// The linearization of x = (q, v) with the acceleration of a system.
fn linearized<S: Convertible<N>, const N: usize>(
    system: &S,
    t: f64,
    q: SVector<f64, N>,
    v: SVector<f64, N>,
) -> Result<Linearization, StepError> {
    if system.is_first_order() {
        // The velocities of first order depend on the inputs, so that (q, v) is no state.
        return Err(StepError::FirstOrder { system: system.name() });
    }
    let node = Node::new(State { t, q, p: SVector::zeros() }, 0.0);
    let explained = |failure: StepError| failure.explained(system, &node, 0.0, &v);
    let acceleration = system.acceleration(t, &q, &v).map_err(explained)?;
    let value = DVector::from_iterator(2 * N, v.iter().chain(&acceleration).copied());
    let columns: Vec<usize> = (0..2 * N + system.inputs().len()).collect();
    // The derivative of q' = v is known, that of v' comes from dual numbers.
    let mut derivatives = DMatrix::zeros(2 * N, columns.len());
    derivatives.view_mut((0, N), (N, N)).fill_with_identity();
    for columns in columns.chunks(TOGETHER) {
        let mut varying = system.convert::<Varied>();
        let (mut q, mut v) = (q.map(Varied::fixed), v.map(Varied::fixed));
        for (direction, column) in columns.iter().enumerate() {
            let varied = match *column {
                column if column < N => q.get_mut(column),
                column if column < 2 * N => v.get_mut(column - N),
                column => varying.parameter_mut(system.parameters()[system.inputs()[column - 2 * N]]),
            };
            if let Some(number) = varied {
                number.slope.0[direction] = 1.0;
            }
        }
        let varied = varying.acceleration(Dual::fixed(t), &q, &v).map_err(explained)?;
        for (direction, column) in columns.iter().enumerate() {
            for (row, entry) in varied.iter().enumerate() {
                derivatives[(N + row, *column)] = entry.slope.0[direction];
            }
        }
    }
    Linearization::new(t, value, &derivatives)
}

/// A linearization: `f(x + δx, u + δu) = value + A δx + B δu` to first order. f is the rate of change of x = (q, v), or
/// the end (q, p) of a step.
#[derive(Clone, Debug, PartialEq)]
pub struct Linearization {
    /// Time of the point of linearization; of a step, of its start.
    pub t: f64,
    /// f at the point of linearization: 2N entries.
    pub value: DVector<f64>,
    /// `A = ∂f/∂x`: 2N rows, 2N columns.
    pub a: DMatrix<f64>,
    /// `B = ∂f/∂u`: 2N rows, one column for each input in the order of
    /// [`Lagrangian::INPUTS`].
    pub b: DMatrix<f64>,
}

impl Linearization {
    /// Splits `[A B]`, and rejects entries that are not finite.
    fn new(t: f64, value: DVector<f64>, derivatives: &DMatrix<f64>) -> Result<Self, StepError> {
        if !value.iter().chain(derivatives).all(|entry| entry.is_finite()) {
            return Err(StepError::NonFinite { t, quantity: "linearization", expression: None });
        }
        let (a, b) = derivatives.columns_range_pair(..value.len(), value.len()..);
        Ok(Self { t, a: a.into_owned(), b: b.into_owned(), value })
    }

    /// The eigenvalues of A, ascending by the size of their imaginary part, then by their real part; of a pair the one
    /// with negative imaginary part comes first. Their errors are of the order of an ulp of the largest, more if
    /// eigenvalues nearly coincide.
    ///
    /// For x' the motion decays if all real parts are negative; for a step if all absolute values are below 1.
    ///
    /// # Errors
    /// [`StepError::NonFinite`] if the QR iteration does not converge.
    pub fn eigenvalues(&self) -> Result<Vec<Complex<f64>>, StepError> {
        spectrum::eigenvalues(&self.a).ok_or(no_eigenvalues(self.t))
    }
}

/// The iteration for the eigenvalues did not converge.
fn no_eigenvalues(t: f64) -> StepError {
    StepError::NonFinite { t, quantity: "spectrum", expression: None }
}

impl<M, S, const N: usize> Run<M, S, N>
where
    M: Differentiable<S, N>,
    S: Convertible<N>,
{
    /// The linearization of the next step: the derivatives of (q, p) at its end with respect to (q, p) at the node and
    /// to the inputs over the step. It is exact to rounding, and the run does not change.
    ///
    /// With constraints, A is the derivative along the nearest admissible changes of (q, p): it has the eigenvalue zero
    /// twice for each holonomic constraint and once for each other.
    ///
    /// If the method finds the length of its steps, the end is that of the changed step. A change of the state or of
    /// the inputs changes the preserved energy as [`Run::set_state`] and [`Run::set_parameters`] do.
    ///
    /// # Errors
    /// The errors of a step and of [`Run::vary`].
    pub fn linearization(&self) -> Result<Linearization, StepError> {
        let mut variations = Variation::of_state();
        for input in self.system().inputs() {
            variations.push(Variation::of_index(*input));
        }
        let mut admissible = Tangent::new(self.clone(), variations);
        admissible.project()?;
        // The energy changes with the admissible changes of the state.
        let mut tangent = Tangent::from_change(self.clone(), admissible.variations().to_vec())?;
        let State { q, p, .. } = tangent.step()?;
        let columns = tangent.variations();
        let derivatives = DMatrix::from_fn(2 * N, columns.len(), |row, column| {
            let Variation { q, p, .. } = &columns[column];
            if row < N { q[row] } else { p[row - N] }
        });
        Linearization::new(self.t(), DVector::from_iterator(2 * N, q.iter().chain(&p).copied()), &derivatives)
    }
}
