//! Where formulas are compared: states about the motion from a place, with parameters about the given ones.
//!
//! In: a system and a [`Place`]. Out: samples of which no coordinate, velocity or parameter has a value that could hide a
//! term, as zero and one can; and the extent of the motion, a distance for each coordinate and momentum.

use super::comparison::Comparison;
use super::report::CheckFailure;
use super::{Checked, Motion, Place, STEPS};
use nalgebra::SVector;

/// Samples of one place.
const SAMPLES: u32 = 8;
/// Part of the extent of the motion by which samples lie beside it.
const BESIDE: f64 = 0.5;
/// Part of its value by which a parameter is varied.
const VARIATION: f64 = 0.1;
/// Part of the largest extent that a coordinate which moves less is given.
const LEAST: f64 = 1e-2;

/// A system with varied parameters at a state.
pub(super) struct Sample<S, const N: usize> {
    pub(super) system: S,
    pub(super) t: f64,
    pub(super) q: SVector<f64, N>,
    pub(super) v: SVector<f64, N>,
    pub(super) h: f64,
}

/// How far coordinates, velocities and momenta move from a place.
pub(super) struct Extent<const N: usize> {
    pub(super) q: SVector<f64, N>,
    pub(super) v: SVector<f64, N>,
    pub(super) p: SVector<f64, N>,
}

/// The states of the motion from a place, at equal times over [`STEPS`] steps.
fn motion<const N: usize, S: Checked<N>>(
    system: &S,
    place: &Place<N>,
    check: &Comparison,
) -> Result<Vec<Motion<N>>, CheckFailure> {
    let mut now = Motion { t: place.t, q: place.q, v: place.v };
    let mut states = vec![now];
    for index in 1..SAMPLES {
        let end = place.t + place.h * f64::from(STEPS) * f64::from(index) / f64::from(SAMPLES - 1);
        now = now.at(system, end).map_err(|error| check.step(error))?;
        states.push(now);
    }
    Ok(states)
}

/// The extent of these states; each entry positive, unless nothing moves, which is a failure.
fn extent_of<const N: usize, S: Checked<N>>(
    system: &S,
    states: &[Motion<N>],
    check: &Comparison,
) -> Result<Extent<N>, CheckFailure> {
    let Some(first) = states.first() else { return Err(check.vacuous("no state")) };
    let momentum = |state: &Motion<N>| system.momentum(state.t, &state.q, &state.v);
    let largest = |distance: &dyn Fn(&Motion<N>) -> SVector<f64, N>| {
        let each = states.iter().map(distance);
        let range: SVector<f64, N> = each.fold(SVector::zeros(), |range, moved| range.sup(&moved.abs()));
        range.map(|entry| entry.max(range.amax() * LEAST))
    };
    let extent = Extent {
        q: largest(&|state| state.q - first.q),
        v: largest(&|state| state.v - first.v),
        p: largest(&|state| momentum(state) - momentum(first)),
    };
    if extent.q.amax() == 0.0 {
        return Err(check.vacuous("nothing moves from this place; choose another"));
    }
    // A motion without acceleration is as long as its velocity says.
    let (v, p) = (first.v.abs().amax(), momentum(first).abs().amax());
    let positive = |entries: SVector<f64, N>, otherwise: f64| {
        if entries.amax() > 0.0 { entries } else { SVector::repeat(otherwise) }
    };
    Ok(Extent { v: positive(extent.v, v), p: positive(extent.p, p), ..extent })
}

/// The extent of the motion from a place.
pub(super) fn extent<const N: usize, S: Checked<N>>(
    system: &S,
    place: &Place<N>,
    check: &Comparison,
) -> Result<Extent<N>, CheckFailure> {
    extent_of(system, &motion(system, place, check)?, check)
}

/// The samples about a place.
pub(super) fn samples<const N: usize, S: Checked<N>>(
    system: &S,
    place: &Place<N>,
    check: &Comparison,
) -> Result<Vec<Sample<S, N>>, CheckFailure> {
    let states = motion(system, place, check)?;
    let extent = extent_of(system, &states, check)?;
    let mut draw = Sequence(7);
    let sample = |state: Motion<N>| {
        let mut beside = |entry: f64, extent: f64| entry + BESIDE * extent * draw.next();
        let (q, v) = (state.q.zip_map(&extent.q, &mut beside), state.v.zip_map(&extent.v, &mut beside));
        let mut varied = *system;
        for name in S::PARAMETERS {
            if let Some(parameter) = varied.parameter_mut(name) {
                *parameter *= 1.0 + VARIATION * draw.next();
            }
        }
        // An exponent, say, may allow no other value.
        let values = |system: &S| system.lagrangian(state.t, &q, &v) + system.force(state.t, &q, &v).sum();
        let system = if values(&varied).is_finite() { varied } else { *system };
        Sample { system, t: state.t, q, v, h: place.h }
    };
    Ok(states.into_iter().map(sample).collect())
}

/// A fixed sequence in (−1, 1) that looks random: a linear congruence (Knuth and Lewis, Numerical Recipes, section 7.1).
struct Sequence(u32);

impl Sequence {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(self.0) / f64::from(1_u32 << 31) - 1.0
    }
}
