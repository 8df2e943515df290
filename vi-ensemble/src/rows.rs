//! Nodes and velocities of a block, side by side.
//!
//! In: vectors of N entries, one per trajectory. Out: N rows of [`WIDTH`] numbers each, in which one vector instruction
//! meets the same coordinate of neighbouring trajectories.

use crate::ensemble::WIDTH;
use crate::lane::Lane;
use nalgebra::SVector;
use vi_core::{Node, State};

/// One number of each trajectory of a block.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(crate) struct Row<U = f64>(pub(crate) [U; WIDTH]);

/// One vector of each trajectory of a block, row by row.
#[derive(Clone, Debug)]
pub(crate) struct Rows<const N: usize>([Row; N]);

/// Coordinates and momenta of a block with their low parts.
#[derive(Clone, Debug)]
pub(crate) struct Nodes<const N: usize> {
    q: Rows<N>,
    q_low: Rows<N>,
    p: Rows<N>,
    p_low: Rows<N>,
}

impl<const N: usize> Rows<N> {
    pub(crate) fn zeros() -> Self {
        Self([Row([0.0; WIDTH]); N])
    }

    /// The vector of one trajectory.
    #[inline(always)]
    pub(crate) fn get(&self, lane: usize) -> SVector<f64, N> {
        SVector::from(core::array::from_fn(|k| self.0[k].0[lane]))
    }

    /// Sets the vector of one trajectory.
    #[inline(always)]
    pub(crate) fn set(&mut self, lane: usize, vector: &SVector<f64, N>) {
        for k in 0..N {
            self.0[k].0[lane] = vector[k];
        }
    }

    #[inline(always)]
    pub(crate) fn lane<const FUSED: bool>(&self, lane: usize) -> SVector<Lane<FUSED>, N> {
        SVector::from(core::array::from_fn(|k| Lane(self.0[k].0[lane])))
    }

    #[inline(always)]
    pub(crate) fn set_lane<const FUSED: bool>(&mut self, lane: usize, vector: &SVector<Lane<FUSED>, N>) {
        for k in 0..N {
            self.0[k].0[lane] = vector[k].0;
        }
    }
}

impl<const N: usize> Nodes<N> {
    pub(crate) fn zeros() -> Self {
        Self { q: Rows::zeros(), q_low: Rows::zeros(), p: Rows::zeros(), p_low: Rows::zeros() }
    }

    /// The node of one trajectory, at the time t. Its energy has no meaning.
    #[inline(always)]
    pub(crate) fn get(&self, lane: usize, t: f64) -> Node<N> {
        let state = State { t, q: self.q.get(lane), p: self.p.get(lane) };
        Node { q_low: self.q_low.get(lane), p_low: self.p_low.get(lane), ..Node::new(state, 0.0) }
    }

    pub(crate) fn set(&mut self, lane: usize, node: &Node<N>) {
        self.q.set(lane, &node.q);
        self.q_low.set(lane, &node.q_low);
        self.p.set(lane, &node.p);
        self.p_low.set(lane, &node.p_low);
    }

    #[inline(always)]
    pub(crate) fn lane<const FUSED: bool>(&self, lane: usize, t: f64) -> Node<N, Lane<FUSED>> {
        let zero = Lane(0.0);
        Node {
            t: Lane(t),
            t_low: zero,
            q: self.q.lane(lane),
            q_low: self.q_low.lane(lane),
            p: self.p.lane(lane),
            p_low: self.p_low.lane(lane),
            energy: zero,
            energy_low: zero,
        }
    }

    #[inline(always)]
    pub(crate) fn set_lane<const FUSED: bool>(&mut self, lane: usize, node: &Node<N, Lane<FUSED>>) {
        self.q.set_lane(lane, &node.q);
        self.q_low.set_lane(lane, &node.q_low);
        self.p.set_lane(lane, &node.p);
        self.p_low.set_lane(lane, &node.p_low);
    }
}
