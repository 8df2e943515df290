//! The phase of a step: its length times the frequency of the forces along it.
//!
//! A system with `time_scale = g;` has ω = 1/g. Otherwise ω follows from the stiffness K = −∂(L_q + f)/∂q, with the part of
//! the reactions on constraints, from `B = ∂(L_q + f)/∂v − ∂L_v/∂q`, and from the change of K in the step. With M⁻¹ restricted
//! to velocities that the constraints allow,
//!
//! ```text
//! Ω⁶ = mean of tr((M⁻¹K)²)^(3/2) + tr(M⁻¹B M⁻¹Bᵀ)³ + tr((M⁻¹ΔK/Δt)²)        K symmetrized
//! ```
//!
//! by Simpson's rule over the ends and the middle of the step, the differences over its halves. Each term is a sum of squares,
//! and none depends on the choice of coordinates. The differences bridge the places where K passes through zero, as that of a
//! pendulum at a right angle. The middle is that of the cubic through both ends, so that a step and its reverse have the
//! same phase.

#[cfg(feature = "alloc")]
use crate::constrained::{accelerations, border, bordered};
use crate::error::StepError;
use crate::gauss::transformed::check_time_scale;
#[cfg(feature = "alloc")]
use crate::kind::Kind;
#[cfg(feature = "alloc")]
use crate::linear::Rectangular;
use crate::linear::{Matrix, solve};
use crate::motion::PointDerivatives;
use crate::node::Node;
use crate::state::State;
use crate::stepping::Convertible;
use nalgebra::{SMatrix, SVector};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

/// The phase of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Phase {
    /// h Ω.
    pub(super) value: f64,
    /// The logarithmic slope of h Ω in h, with the start fixed.
    pub(super) slope: f64,
    /// The next length divided by that of the step, by the explicit law.
    pub(super) ratio: f64,
}

impl Phase {
    /// From (h ω)⁶ at the start, in the middle and at the end of a step.
    fn of(powers: [f64; 3]) -> Option<Self> {
        let mean = simpson(powers);
        // ln ω is a quadratic polynomial: its slopes in the middle and at the end, in units of 1/h.
        let [start, middle, end] = powers.map(|power| power.ln() / 6.0);
        let slopes = [end - start, 3.0 * end - 4.0 * middle + start];
        let slope = 1.0 + (2.0 * powers[1] * slopes[0] + powers[2] * slopes[1]) / (6.0 * mean);
        let value = mean.powf(1.0 / 6.0);
        let ratio = (1.0 + slopes[1]).max(0.3).recip();
        (value.is_normal() && slope.is_finite()).then_some(Self { value, slope, ratio })
    }
}

/// A place of the motion.
pub(super) struct Place<const N: usize> {
    t: f64,
    q: SVector<f64, N>,
    v: SVector<f64, N>,
    forces: Option<Forces<N>>,
}

/// The linear forces at a place.
struct Forces<const N: usize> {
    /// K, symmetric.
    stiffness: SMatrix<f64, N, N>,
    /// `M⁻¹`, in the directions that the constraints allow.
    compliance: SMatrix<f64, N, N>,
    /// `tr((M⁻¹K)²)`
    of_stiffness: f64,
    /// `tr(M⁻¹B M⁻¹Bᵀ)`
    of_damping: f64,
}

impl<const N: usize> Forces<N> {
    /// (h ω)⁶ without the change of K.
    fn power(&self, h: f64) -> f64 {
        let (of_stiffness, of_damping) = (self.of_stiffness * h.powi(4), self.of_damping * (h * h));
        of_stiffness * of_stiffness.sqrt() + of_damping * of_damping * of_damping
    }

    /// `tr((M⁻¹X)²)` of X = K − K'.
    fn change(&self, compliance: &SMatrix<f64, N, N>, other: &Self) -> f64 {
        let change = self.stiffness - other.stiffness;
        size(compliance, &change, &change)
    }
}

impl<const N: usize> Place<N> {
    /// That of a node.
    ///
    /// # Errors
    /// As [`State::velocity`].
    pub(super) fn of<S: Convertible<N>>(system: &S, node: &Node<N>) -> Result<Self, StepError> {
        let state = node.state();
        let v = state.velocity(system)?;
        let State { t, q, .. } = state;
        Ok(Self::at(system, (t, q, v)))
    }

    fn at<S: Convertible<N>>(system: &S, (t, q, v): (f64, SVector<f64, N>, SVector<f64, N>)) -> Self {
        let forces = if system.scales_time() { None } else { forces(system, t, &q, &v) };
        Self { t, q, v, forces }
    }

    /// The middle of the cubic from here to another place.
    fn middle(&self, end: &Self) -> (f64, SVector<f64, N>, SVector<f64, N>) {
        let h = end.t - self.t;
        let q = (self.q + end.q) * 0.5 + (self.v - end.v) * (0.125 * h);
        let v = (end.q - self.q) * (1.5 / h) - (self.v + end.v) * 0.25;
        (self.t + 0.5 * h, q, v)
    }
}

/// The phase of the step of the length h between two places; `None` where the stiffness has no value. Ω is at least
/// `floor`.
///
/// # Errors
/// [`StepError::TimeScale`] for a time scale that is not positive.
pub(super) fn phase<S: Convertible<N>, const N: usize>(
    system: &S,
    [start, end]: [&Place<N>; 2],
    [h, floor]: [f64; 2],
) -> Result<Option<Phase>, StepError> {
    let (t, q, v) = start.middle(end);
    let least = (h * floor).powi(6);
    if system.scales_time() {
        let mut powers = [0.0; 3];
        for (power, (t, q, v)) in powers.iter_mut().zip([(start.t, start.q, start.v), (t, q, v), (end.t, end.q, end.v)])
        {
            let g = system.scaled_point(t, &q, &v).g;
            check_time_scale(t, g)?;
            *power = (h / g).powi(6) + least;
        }
        return Ok(Phase::of(powers));
    }
    let middle = Place::at(system, (t, q, v));
    let [Some(start), Some(middle), Some(end)] = [&start.forces, &middle.forces, &end.forces] else { return Ok(None) };
    let powers = [start, middle, end].map(|forces| forces.power(h));
    let per_half = (2.0 * h * h).powi(2);
    let changes = [(middle, start), (end, middle)].map(|(one, other)| one.change(&middle.compliance, other) * per_half);
    let [start, middle, end] = powers.map(|power| power + least);
    let in_middle = 0.5 * (changes[0] + changes[1]);
    Ok(Phase::of([start + changes[0], middle + in_middle, end + changes[1]]))
}

fn simpson([start, middle, end]: [f64; 3]) -> f64 {
    (start + 4.0 * middle + end) / 6.0
}

fn forces<S: Convertible<N>, const N: usize>(
    system: &S,
    t: f64,
    q: &SVector<f64, N>,
    v: &SVector<f64, N>,
) -> Option<Forces<N>> {
    let PointDerivatives { momentum_dq, force_dq, force_dv, .. } = system.point_derivatives(t, q, v);
    #[cfg_attr(not(feature = "alloc"), allow(unused_mut, reason = "reactions need it"))]
    let mut stiffness = force_dq.dense();
    #[cfg(feature = "alloc")]
    if const { S::Kind::COUNT > 0 } {
        let (_, multipliers) = accelerations(system, (t, q, v), &mut bordered(system)).ok()?;
        for (i, row) in system.reaction_derivatives(t, q, &multipliers).rows().enumerate() {
            row.iter().for_each(|(j, slope)| stiffness[(i, j)] += slope);
        }
    }
    let stiffness = (stiffness + stiffness.transpose()) * 0.5;
    let damping = force_dv.dense() - momentum_dq.dense();
    let compliance = compliance(system, t, q, v)?;
    let has_damping = damping.iter().any(|entry| *entry != 0.0);
    let of_damping = if has_damping { size(&compliance, &damping, &damping.transpose()) } else { 0.0 };
    let of_stiffness = size(&compliance, &stiffness, &stiffness);
    Some(Forces { stiffness, compliance, of_stiffness, of_damping })
}

/// `M⁻¹`, in the directions that the constraints allow.
fn compliance<S: Convertible<N>, const N: usize>(
    system: &S,
    t: f64,
    q: &SVector<f64, N>,
    v: &SVector<f64, N>,
) -> Option<SMatrix<f64, N, N>> {
    let mass = system.point(t, q, v).mass;
    #[cfg(feature = "alloc")]
    if const { S::Kind::COUNT > 0 } {
        let mut bordered = bordered(system);
        let (gradients, mut none) = system.constraint_gradients(t, q);
        border(&mut bordered, system, &mass, &gradients).ok()?;
        let mut compliance = SMatrix::<f64, N, N>::identity();
        for mut column in compliance.column_iter_mut() {
            let mut entries: SVector<f64, N> = column.clone_owned();
            none.as_mut().fill(0.0);
            bordered.solve(&mut entries, none.as_mut());
            column.copy_from(&entries);
        }
        return Some(compliance);
    }
    solve(&mass, &SMatrix::identity())
}

/// `tr(M⁻¹X M⁻¹Y)` with `Y = Xᵀ`: not negative but for rounding.
fn size<const N: usize>(compliance: &SMatrix<f64, N, N>, x: &SMatrix<f64, N, N>, y: &SMatrix<f64, N, N>) -> f64 {
    (compliance * x).dot(&(compliance * y).transpose()).max(0.0)
}
