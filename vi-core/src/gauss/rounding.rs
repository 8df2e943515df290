//! What rounding moves the positions of the stages by, by running error analysis.
//!
//! In: a system in numbers that carry a bound of their rounding, and stages, each number the nearest to the one that is meant. Out: how
//! far the positions that follow from one evaluation can be off. Where changes stall below a few times that, the stages are solved: what is left is what the
//! arithmetic cannot tell from zero.

use super::stages::Stages;
use super::tableau::Tableau;
use crate::collocation::Collocation;
use crate::linear::Matrix;
use crate::node::Node;
use crate::real::Rounded;
use nalgebra::SVector;

/// The vector of one stage.
fn nearest<const N: usize, const S: usize>(of: &Stages<N, S>, i: usize) -> SVector<Rounded, N> {
    SVector::from_fn(|k, _| Rounded::nearest(of[k][i]))
}

/// The largest bound of each coordinate over the stages.
pub(super) fn bounds<Y, const N: usize, const S: usize>(
    system: &Y,
    node: &Node<N>,
    h: f64,
    x: &Stages<N, S>,
    v: &Stages<N, S>,
) -> SVector<f64, N>
where
    Y: Collocation<N, Rounded>,
{
    let Tableau { b, c, first, .. } = const { &Tableau::<S>::VALUES };
    let weights = b.map(|b| Rounded::nearest(h * b));
    let points: [_; S] = core::array::from_fn(|i| {
        let t = Rounded::nearest(node.t + h * c[i]);
        system.point(t, &nearest(x, i), &nearest(v, i))
    });
    // The sum over the stages, from `start`.
    let sum = |start: Rounded, i: usize, of: &dyn Fn(usize) -> Rounded| {
        (0..S).fold(start, |sum, j| sum + Rounded::nearest(first[j][i]) * (weights[j] * of(j)))
    };
    let velocity: [SVector<Rounded, N>; S] = core::array::from_fn(|i| {
        let missing = SVector::from_fn(|k, _| {
            let start = Rounded::exact(node.p[k]) - points[i].momentum[k];
            sum(start, i, &|j| points[j].force[k])
        });
        nearest(v, i) + points[i].mass.solve_unchecked(&missing)
    });
    let mut largest = SVector::zeros();
    for k in 0..N {
        for i in 0..S {
            let position = sum(Rounded::exact(node.q[k]), i, &|j| velocity[j][k]);
            // Bounds are in halves of an ulp.
            largest[k] = f64::max(largest[k], 0.5 * f64::EPSILON * position.error());
        }
    }
    largest
}
