//! The phase of a step: its length times the frequency of the forces along it.
//!
//! A system with `time_scale = g;` has ω = 1/g. Otherwise ω follows from the stiffness K = −∂(L_q + f)/∂q, with the part of
//! the reactions on constraints, from `B = ∂(L_q + f)/∂v − ∂L_v/∂q`, and from the change of K in the step. With M⁻¹ restricted
//! to velocities that the constraints allow,
//!
//! ```text
//! Ω⁶ = mean of tr((M⁻¹K)²)^(3/2) + tr(M⁻¹B M⁻¹Bᵀ)³ + tr((M⁻¹ΔK/Δt)²) + tr((M⁻¹ΔM/2Δt)²)³        K symmetrized
//! ```
//!
//! The mean is Simpson's rule over the ends and the middle of the step; the differences are over its halves. Each term
//! is a sum of squares, which does not depend on the units. The differences of K count where K passes through zero, as in
//! a pendulum at a right angle; those of M, without constraints, near a pole of the coordinates, which no force shows. The
//! middle is taken from the cubic through both ends, so that a step and its reverse have the same phase.

#[cfg(feature = "alloc")]
use crate::constrained::{accelerations, bordered};
use crate::error::StepError;
use crate::gauss::transformed::check_time_scale;
use crate::kind::Kind as _;
#[cfg(feature = "alloc")]
use crate::linear::Rectangular;
use crate::linear::{Matrix, solve};
use crate::motion::{Motion, PointDerivatives};
use crate::node::Node;
use crate::state::State;
use crate::stepping::Convertible;
use nalgebra::{SMatrix, SVector};
#[cfg(not(feature = "std"))]
use num_traits::Float as _;

/// The phase of a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Phase {
    /// (h ω)⁶ at the start, in the middle and at the end of the step; positive.
    powers: [f64; 3],
}

impl Phase {
    /// `None` for a power that is zero or not finite.
    fn of(powers: [f64; 3]) -> Option<Self> {
        let is_known = powers.iter().all(|power| *power > 0.0) && simpson(powers).is_finite();
        is_known.then_some(Self { powers })
    }

    /// The same phase all along the step.
    pub(super) fn constant(value: f64) -> Self {
        Self { powers: [value.powi(6); 3] }
    }

    /// h Ω.
    pub(super) fn value(&self) -> f64 {
        simpson(self.powers).powf(1.0 / 6.0)
    }

    /// The logarithm of h Ω over a phase.
    pub(super) fn off(&self, wanted: f64) -> f64 {
        (simpson(self.powers) / wanted.powi(6)).ln() / 6.0
    }

    /// Slopes of ln ω, a quadratic polynomial, in the middle and at the end, in units of 1/h.
    fn slopes(&self) -> [f64; 2] {
        let [start, middle, end] = self.powers.map(|power| power.ln() / 6.0);
        [end - start, 3.0 * end - 4.0 * middle + start]
    }

    /// The logarithmic slope of h Ω in h, with the start fixed.
    pub(super) fn slope(&self) -> f64 {
        let ([_, middle, end], slopes) = (self.powers, self.slopes());
        1.0 + (2.0 * middle * slopes[0] + end * slopes[1]) / (6.0 * simpson(self.powers))
    }

    /// The next length divided by that of the step, by the explicit law.
    pub(super) fn ratio(&self) -> f64 {
        (1.0 + self.slopes()[1]).max(0.3).recip()
    }
}

fn simpson([start, middle, end]: [f64; 3]) -> f64 {
    (start + 4.0 * middle + end) / 6.0
}

/// A point of the motion, with the linear forces there.
pub(super) struct MotionPoint<S: Motion<N>, const N: usize> {
    t: f64,
    q: SVector<f64, N>,
    v: SVector<f64, N>,
    forces: Option<Forces<S::Mass, N>>,
}

/// The linear forces at a point.
struct Forces<M, const N: usize> {
    compliance: Compliance<M, N>,
    /// The symmetric K; M⁻¹K if M is constant.
    stiffness: SMatrix<f64, N, N>,
    /// `tr((M⁻¹K)²)`
    of_stiffness: f64,
    /// `tr(M⁻¹B M⁻¹Bᵀ)`
    of_damping: f64,
}

/// M⁻¹, in the directions that the constraints allow.
enum Compliance<M, const N: usize> {
    /// M⁻¹ without constraints.
    Free(M),
    /// M⁻¹ on the velocities that constraints allow.
    #[cfg(feature = "alloc")]
    Bound(SMatrix<f64, N, N>),
}

impl<M: Matrix<N, f64>, const N: usize> Compliance<M, N> {
    /// `M⁻¹X`
    fn times(&self, x: &SMatrix<f64, N, N>) -> Option<SMatrix<f64, N, N>> {
        match self {
            Self::Free(mass) => solve(mass, x),
            #[cfg(feature = "alloc")]
            Self::Bound(compliance) => Some(compliance * x),
        }
    }

    /// `tr((M⁻¹ΔM)²)` of the change of M to another place; zero with constraints.
    fn change(&self, other: &Self) -> Option<f64> {
        match (self, other) {
            (Self::Free(mass), Self::Free(others)) => {
                let change = self.times(&(mass.dense() - others.dense()))?;
                Some(trace(&change, &change))
            }
            #[cfg(feature = "alloc")]
            _ => Some(0.0),
        }
    }
}

/// A time, coordinates and velocities.
type At<'a, const N: usize> = (f64, &'a SVector<f64, N>, &'a SVector<f64, N>);

/// The compliance at a point. Adds the reactions of constraints to K.
#[cfg_attr(not(feature = "alloc"), allow(unused_variables, clippy::unnecessary_wraps, reason = "constraints need it"))]
fn compliance<S: Convertible<N>, const N: usize>(
    system: &S,
    at: At<'_, N>,
    stiffness: &mut SMatrix<f64, N, N>,
) -> Option<Compliance<S::Mass, N>> {
    let (t, q, v) = at;
    #[cfg(feature = "alloc")]
    if const { S::Kind::COUNT > 0 } {
        let mut bordered = bordered(system);
        let (_, mut multipliers) = accelerations(system, at, &mut bordered).ok()?;
        for (i, row) in system.reaction_derivatives(t, q, &multipliers).rows().enumerate() {
            row.iter().for_each(|(j, slope)| stiffness[(i, j)] += slope);
        }
        let mut compliance = SMatrix::<f64, N, N>::identity();
        for mut column in compliance.column_iter_mut() {
            let mut entries: SVector<f64, N> = column.clone_owned();
            multipliers.as_mut().fill(0.0);
            bordered.solve(&mut entries, multipliers.as_mut());
            column.copy_from(&entries);
        }
        return Some(Compliance::Bound(compliance));
    }
    Some(Compliance::Free(system.point(t, q, v).mass))
}

/// Whether M⁻¹ is the same at all points.
fn has_constant_mass<S: Convertible<N>, const N: usize>(system: &S) -> bool {
    S::Kind::COUNT == 0 && system.has_constant_mass()
}

/// `tr(XY)` of X = M⁻¹K and Y = M⁻¹Kᵀ. Only rounding can make it negative.
fn trace<const N: usize>(x: &SMatrix<f64, N, N>, y: &SMatrix<f64, N, N>) -> f64 {
    let mut sum = 0.0;
    for j in 0..N {
        for i in 0..N {
            sum += x[(i, j)] * y[(j, i)];
        }
    }
    sum.max(0.0)
}

impl<M: Matrix<N, f64>, const N: usize> Forces<M, N> {
    fn of<S: Convertible<N> + Motion<N, Mass = M>>(system: &S, at: At<'_, N>) -> Option<Self> {
        let (t, q, v) = at;
        let PointDerivatives { momentum_dq, force_dq, force_dv, .. } = system.point_derivatives(t, q, v);
        let mut stiffness = force_dq.dense();
        let compliance = compliance(system, at, &mut stiffness)?;
        for j in 0..N {
            for i in 0..j {
                let mean = 0.5 * (stiffness[(i, j)] + stiffness[(j, i)]);
                (stiffness[(i, j)], stiffness[(j, i)]) = (mean, mean);
            }
        }
        let response = compliance.times(&stiffness)?;
        let mut of_damping = 0.0;
        if !system.is_separable() {
            let damping = force_dv.dense() - momentum_dq.dense();
            if damping.as_slice().iter().any(|entry| *entry != 0.0) {
                of_damping = trace(&compliance.times(&damping)?, &compliance.times(&damping.transpose())?);
            }
        }
        let of_stiffness = trace(&response, &response);
        let stiffness = if has_constant_mass::<S, N>(system) { response } else { stiffness };
        Some(Self { compliance, stiffness, of_stiffness, of_damping })
    }

    /// (h ω)⁶ without the change of K.
    fn power(&self, h: f64) -> f64 {
        let (of_stiffness, of_damping) = (self.of_stiffness * h.powi(4), self.of_damping * (h * h));
        of_stiffness * of_stiffness.sqrt() + of_damping * of_damping * of_damping
    }

    /// (h ω)⁶ of the change of K and M to another place, half a step of the length h away, with the mass here, which may be
    /// that of all places.
    fn change(&self, other: &Self, h: f64, has_constant_mass: bool) -> Option<f64> {
        let per_half = (2.0 * h * h).powi(2);
        let change = self.stiffness - other.stiffness;
        if has_constant_mass {
            return Some(per_half * trace(&change, &change));
        }
        let change = self.compliance.times(&change)?;
        let of_mass = self.compliance.change(&other.compliance)?;
        Some(per_half * trace(&change, &change) + of_mass.powi(3))
    }
}

impl<S: Convertible<N>, const N: usize> MotionPoint<S, N> {
    /// The point of a node.
    ///
    /// # Errors
    /// As [`State::velocity`].
    pub(super) fn of(system: &S, node: &Node<N>) -> Result<Self, StepError> {
        let state = node.state();
        let v = state.velocity(system)?;
        let State { t, q, .. } = state;
        Ok(Self::at(system, (t, q, v)))
    }

    /// The point at (t, q, v).
    pub(super) fn at(system: &S, (t, q, v): (f64, SVector<f64, N>, SVector<f64, N>)) -> Self {
        let forces = if system.scales_time() { None } else { Forces::of(system, (t, &q, &v)) };
        Self { t, q, v, forces }
    }

    /// The middle of the cubic from here to another point.
    fn middle(&self, end: &Self) -> (f64, SVector<f64, N>, SVector<f64, N>) {
        let h = end.t - self.t;
        let q = (self.q + end.q) * 0.5 + (self.v - end.v) * (0.125 * h);
        let v = (end.q - self.q) * (1.5 / h) - (self.v + end.v) * 0.25;
        (self.t + 0.5 * h, q, v)
    }
}

/// The phase of the step of the length h between two points; `None` if the stiffness has no value. Ω is at least
/// `floor`.
///
/// # Errors
/// [`StepError::TimeScale`] for a time scale that is not positive.
pub(super) fn phase<S: Convertible<N>, const N: usize>(
    system: &S,
    [start, end]: [&MotionPoint<S, N>; 2],
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
    let middle = Forces::of(system, (t, &q, &v));
    let (Some(start), Some(middle), Some(end)) = (&start.forces, &middle, &end.forces) else { return Ok(None) };
    let has_constant_mass = has_constant_mass::<S, N>(system);
    let powers = [start, middle, end].map(|forces| forces.power(h));
    let [Some(before), Some(after)] = [start, end].map(|other| middle.change(other, h, has_constant_mass)) else {
        return Ok(None);
    };
    let [start, middle, end] = powers.map(|power| power + least);
    Ok(Phase::of([start + before, middle + 0.5 * (before + after), end + after]))
}
