//! The methods that are compared, and one run of each.
//!
//! In: a system, a motion to start from, the time to reach, a [`Method`] and its setting: the length of a step, or a
//! tolerance. Out: the state reached, or why it was not.

use super::rival::{self, Ended};
use crate::chart::Look;
use vi_core::check::Motion;
use vi_core::{Composition, EnergyPreserving, FixedStep, Scheme, State, Stepping};

/// A method of the comparison.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Method {
    /// Fixed steps of order 2.
    Fixed,
    /// Fixed steps composed to a higher order.
    Composed(Scheme),
    /// The integrator that solves for its own step.
    Energy,
    /// The Runge–Kutta method of order 8 that chooses its steps by a tolerance.
    Rival,
}

impl Method {
    /// All of them, in the order of the legends.
    pub(super) const ALL: [Self; 6] = [
        Self::Fixed,
        Self::Composed(Scheme::SUZUKI_4),
        Self::Composed(Scheme::KAHAN_LI_6),
        Self::Composed(Scheme::KAHAN_LI_8),
        Self::Energy,
        Self::Rival,
    ];

    /// Its name in legends and tables.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Fixed => "fixed step",
            Self::Composed(scheme) => scheme.name,
            Self::Energy => "energy-preserving",
            Self::Rival => "DOP853",
        }
    }

    /// Its colour and its marker.
    pub(super) fn look(self) -> Look {
        let [four, six, eight, _] = Look::OTHERS;
        match self {
            Self::Fixed => Look::FIXED,
            Self::Composed(scheme) if scheme.order == 4 => four,
            Self::Composed(scheme) if scheme.order == 6 => six,
            Self::Composed(_) => eight,
            Self::Energy => Look::ENERGY,
            Self::Rival => Look::RIVAL,
        }
    }

    /// Parts of one of its steps: equations that are solved one after the other.
    pub(super) fn parts(self) -> usize {
        match self {
            Self::Composed(scheme) => scheme.weights.len(),
            Self::Fixed | Self::Energy | Self::Rival => 1,
        }
    }

    /// Its settings in words.
    pub(super) fn setting(self, setting: f64) -> String {
        match self {
            Self::Rival => format!("tolerance {setting:.0e}"),
            Self::Energy => format!("h₀ = {setting:.4}"),
            Self::Fixed | Self::Composed(_) => format!("h = {setting:.4}"),
        }
    }
}

/// How many steps of length `h` lead from the start to `end`.
pub(super) fn steps(span: f64, h: f64) -> u64 {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss)] // a positive count far below 2⁵³
    let count = (span / h).round() as u64;
    count.max(1)
}

/// The state that `method` reaches at `end`; the energy-preserving integrator stops at the first node from there on.
pub(super) fn reached<S: Stepping<N>, const N: usize>(
    system: S,
    start: &Motion<N>,
    end: f64,
    method: Method,
    setting: f64,
) -> Result<State<N>, Ended> {
    let count = steps(end - start.t, setting);
    let state = State::at(&system, start.t, start.q, start.v);
    let state = match method {
        Method::Fixed => {
            let mut run = FixedStep::new(system, state, setting).map_err(Ended::Step)?;
            (0..count).try_for_each(|_| run.step().map(drop)).map_err(Ended::Step)?;
            run.state()
        }
        Method::Composed(scheme) => {
            let mut run = Composition::new(system, scheme, state, setting).map_err(Ended::Step)?;
            (0..count).try_for_each(|_| run.step().map(drop)).map_err(Ended::Step)?;
            run.state()
        }
        Method::Energy => {
            let run = EnergyPreserving::from_midpoint(system, start.t, start.q, start.v, setting);
            let mut run = run.map_err(Ended::Step)?;
            let mut taken = 0;
            while run.node().t < end {
                run.step().map_err(Ended::Step)?;
                taken += 1;
                if taken > 10 * count {
                    return Err(Ended::Short(run.node().t));
                }
            }
            run.state()
        }
        Method::Rival => {
            let motion = rival::motion(system, start, end, setting, drop)?;
            State::at(&system, motion.t, motion.q, motion.v)
        }
    };
    let finite = state.q.iter().chain(state.p.iter()).all(|entry| entry.is_finite());
    if finite { Ok(state) } else { Err(Ended::NonFinite) }
}
