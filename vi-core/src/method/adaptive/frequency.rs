//! The frequency of the forces at a state, and its rate along the motion.
//!
//! A system with `time_scale = g;` has ω = 1/g. Otherwise ω follows from the stiffness K = −∂(L_q + f)/∂q, with the part of
//! the reactions on constraints, and from `B = ∂(L_q + f)/∂v − ∂L_v/∂q`. With M⁻¹ restricted to velocities that the
//! constraints allow, and a floor ω0,
//!
//! ```text
//! ω⁶ = tr((M⁻¹K)²)^(3/2) + tr(M⁻¹B M⁻¹Bᵀ)³ + tr((M⁻¹K')²) + ω0⁶        K symmetrized
//! G  = ω'/ω
//! ```
//!
//! Each term is a sum of squares, and none depends on the choice of coordinates. K' bridges the places where K passes
//! through zero, as that of a pendulum at a right angle. Derivatives along the motion are differences over 2δ between
//! points of its Taylor polynomial with the jerk, so that ω is even and G odd when the velocities are reversed. Without the
//! jerk, velocities would err by δ², and with them the change of K' where forces depend on velocities.

#[cfg(feature = "alloc")]
use crate::constrained::{accelerations, border, bordered};
use crate::error::StepError;
use crate::gauss::transformed::check_time_scale;
use crate::kind::Kind;
#[cfg(feature = "alloc")]
use crate::linear::Rectangular;
use crate::linear::{Matrix, solve};
use crate::motion::{Motion, PointDerivatives, ScaledPoint};
use crate::node::Node;
use crate::state::State;
use crate::stepping::Convertible;
use nalgebra::{SMatrix, SVector};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

/// δ, in units of 1/ω. The differences are of second order, which keeps the symmetry; a shorter δ adds rounding, which
/// does not.
const APART: f64 = 1.0 / 32.0;
/// The longest δ, in units of the last step: a wall is not felt from afar.
const WITHIN: f64 = 1.0 / 16.0;

/// ω at a state, and G.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Frequency {
    pub(crate) value: f64,
    pub(crate) rate: f64,
}

/// The frequency at a node, at least `floor`; `None` where the stiffness has no value. Differences stay within a part of the
/// last step.
///
/// # Errors
/// Those of velocity and acceleration at the node; [`StepError::TimeScale`] for a time scale that is not positive.
pub(crate) fn frequency<S: Convertible<N>, const N: usize>(
    system: &S,
    node: &Node<N>,
    [floor, last]: [f64; 2],
) -> Result<Option<Frequency>, StepError> {
    let state = node.state();
    let State { t, q, .. } = state;
    let v = state.velocity(system)?;
    if system.scales_time() {
        let ScaledPoint { g, g_dq, g_dt, .. } = system.scaled_point(t, &q, &v);
        check_time_scale(t, g)?;
        return Ok(Some(Frequency { value: g.recip(), rate: -(g_dq.dot(&v) + g_dt) / g }));
    }
    let here = Place { system, t, q, v };
    let found = here.frequency(&here.acceleration()?, floor, WITHIN * last.abs());
    Ok(found.filter(|found| found.value.is_finite() && found.rate.is_finite()))
}

/// A place of the motion, or near it.
struct Place<'a, S, const N: usize> {
    system: &'a S,
    t: f64,
    q: SVector<f64, N>,
    v: SVector<f64, N>,
}

/// The linear forces at a place.
struct Linear<const N: usize> {
    /// K, symmetric.
    stiffness: SMatrix<f64, N, N>,
    /// B.
    damping: SMatrix<f64, N, N>,
}

impl<S: Convertible<N>, const N: usize> Place<'_, S, N> {
    fn frequency(&self, a: &SVector<f64, N>, floor: f64, within: f64) -> Option<Frequency> {
        let (here, compliance) = (self.linear()?, self.compliance()?);
        let delta = (APART / self.pace(a, powers(&compliance, &here), floor)).min(within);
        if !delta.is_normal() {
            return None;
        }
        let [before, after] = [-delta, delta].map(|delta| self.after(delta, a, &SVector::zeros()).acceleration().ok());
        let jerk = (after? - before?) * (0.5 / delta);
        let is_constant = S::Kind::COUNT == 0 && self.system.has_constant_mass();
        let least = (floor * floor * floor).powi(2);
        let power = |delta: f64| {
            let place = self.after(delta, a, &jerk);
            let (near, far) = (place.linear()?, self.after(2.0 * delta, a, &jerk).linear()?);
            let compliance = if is_constant { compliance } else { place.compliance()? };
            let [of_stiffness, of_damping] = powers(&compliance, &near);
            let slope = (far.stiffness - here.stiffness) * (0.5 / delta);
            let of_damping = of_damping * of_damping * of_damping;
            Some(of_stiffness * of_stiffness.sqrt() + of_damping + size(&compliance, &slope, &slope) + least)
        };
        let [before, after] = [power(-delta)?, power(delta)?];
        Some(Frequency { value: (before * after).powf(1.0 / 12.0), rate: (after / before).ln() / (12.0 * delta) })
    }

    /// A rate that is not zero where K is: with the change of the velocities.
    fn pace(&self, a: &SVector<f64, N>, [of_stiffness, of_damping]: [f64; 2], floor: f64) -> f64 {
        let frequency = of_stiffness.sqrt().sqrt() + of_damping.sqrt() + floor;
        let [speed, acceleration] = [self.v.norm(), a.norm()];
        frequency + acceleration / (speed + acceleration / frequency)
    }

    /// The place after the time δ, by the acceleration and the jerk here.
    fn after(&self, delta: f64, a: &SVector<f64, N>, jerk: &SVector<f64, N>) -> Self {
        let Self { system, t, q, v } = *self;
        let turned = a + jerk * (delta / 3.0);
        let q = q + (v + turned * (0.5 * delta)) * delta;
        Self { system, t: t + delta, q, v: v + (a + jerk * (0.5 * delta)) * delta }
    }

    /// The acceleration, also beside the constraints.
    fn acceleration(&self) -> Result<SVector<f64, N>, StepError> {
        let Self { system, t, q, v } = self;
        #[cfg(feature = "alloc")]
        if const { S::Kind::COUNT > 0 } {
            return accelerations(*system, (*t, q, v), &mut bordered(*system)).map(|(acceleration, _)| acceleration);
        }
        system.acceleration(*t, q, v)
    }

    #[allow(clippy::unnecessary_wraps, reason = "a reaction may have no value")]
    fn linear(&self) -> Option<Linear<N>> {
        let Self { system, t, q, v } = self;
        let PointDerivatives { momentum_dq, force_dq, force_dv, .. } = system.point_derivatives(*t, q, v);
        #[cfg_attr(not(feature = "alloc"), allow(unused_mut, reason = "reactions need it"))]
        let mut stiffness = force_dq.dense();
        #[cfg(feature = "alloc")]
        if const { S::Kind::COUNT > 0 } {
            let (_, multipliers) = accelerations(*system, (*t, q, v), &mut bordered(*system)).ok()?;
            for (i, row) in system.reaction_derivatives(*t, q, &multipliers).rows().enumerate() {
                row.iter().for_each(|(j, slope)| stiffness[(i, j)] += slope);
            }
        }
        let stiffness = (stiffness + stiffness.transpose()) * 0.5;
        Some(Linear { stiffness, damping: force_dv.dense() - momentum_dq.dense() })
    }

    /// `M⁻¹`, in the directions that the constraints allow.
    fn compliance(&self) -> Option<SMatrix<f64, N, N>> {
        let Self { system, t, q, v } = self;
        let mass = system.point(*t, q, v).mass;
        #[cfg(feature = "alloc")]
        if const { S::Kind::COUNT > 0 } {
            let mut bordered = bordered(*system);
            let (gradients, mut none) = system.constraint_gradients(*t, q);
            border(&mut bordered, *system, &mass, &gradients).ok()?;
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
}

/// `tr((M⁻¹K)²)` and `tr(M⁻¹B M⁻¹Bᵀ)`.
fn powers<const N: usize>(compliance: &SMatrix<f64, N, N>, Linear { stiffness, damping }: &Linear<N>) -> [f64; 2] {
    let has_damping = damping.iter().any(|entry| *entry != 0.0);
    let of_damping = if has_damping { size(compliance, damping, &damping.transpose()) } else { 0.0 };
    [size(compliance, stiffness, stiffness), of_damping]
}

/// `tr(M⁻¹X M⁻¹Y)` with `Y = Xᵀ`: not negative but for rounding.
fn size<const N: usize>(compliance: &SMatrix<f64, N, N>, x: &SMatrix<f64, N, N>, y: &SMatrix<f64, N, N>) -> f64 {
    (compliance * x).dot(&(compliance * y).transpose()).max(0.0)
}
