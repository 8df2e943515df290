//! Tangent vectors of a splitting step, by dual numbers.

use super::steps::{Differentiable, not_last};
use super::variation::{TOGETHER, Variation, Varied, more_parameters};
use crate::error::StepError;
use crate::method::Splitting;
use crate::method::splitting::step;
use crate::motion::Separable;
use crate::node::Node;
use crate::run::Run;
use crate::stepping::Convertible;

/// Largest relative difference of two ends of the same step.
const SAME: f64 = 1024.0 * f64::EPSILON;

impl<S, const N: usize> Differentiable<S, N> for Splitting
where
    S: Separable<N> + Convertible<N>,
{
    fn vary(run: &Run<Self, S, N>, before: &Node<N>, variations: &mut [Variation<N>]) -> Result<(), StepError> {
        let Run { method, system, node, h, .. } = run;
        let end = step(method, system, (before, *h));
        // The force of the first kick may belong to an angle with whole turns that the run has since removed.
        let off = (end.q - node.q) + (end.q_low - node.q_low);
        let is_last = (end.t - node.t).abs() <= SAME * end.t.abs()
            && off.amax() <= SAME * end.q.amax().max((end.q - before.q).amax());
        if !is_last {
            return Err(not_last(before.t));
        }
        if variations.iter().any(|variation| variation.parameters.len() > system.parameters().len()) {
            return Err(more_parameters(before.t));
        }
        for variations in variations.chunks_mut(TOGETHER) {
            let system = Variation::vary_parameters(variations, system.parameters(), system.convert::<Varied>());
            let length = Variation::number(variations, *h, |variation| variation.h);
            let end = step(method, &system, (&Variation::node(variations, before), length));
            for (direction, variation) in variations.iter_mut().enumerate() {
                let slope = |high: Varied, low: Varied| (high + low).slope.0[direction];
                variation.q = end.q.zip_map(&end.q_low, slope);
                variation.p = end.p.zip_map(&end.p_low, slope);
                variation.t = (end.t + end.t_low).slope.0[direction];
            }
        }
        Variation::check_finite(variations, before.t)
    }
}
