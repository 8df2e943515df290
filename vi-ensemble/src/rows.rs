//! Nodes and velocities of a block, side by side.
//!
//! In: vectors of N entries, one per trajectory. Out: N rows of `WIDTH` numbers each, in which one vector instruction
//! meets the same coordinate of neighbouring trajectories.

use crate::ensemble::HALF;
use crate::lane::Lane;
use crate::sweep::Vector;
use nalgebra::SVector;
use vi_core::{Node, Real, State};

/// One number of each trajectory of a block.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(crate) struct Row<U = f64>([[U; HALF]; 2]);

/// Where a trajectory stands in a row: its half, and its place there. Both are known to be inside, one as a constant and
/// the other as the counter of a loop.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    pub(crate) half: usize,
    pub(crate) index: usize,
}

impl Place {
    /// The place of a trajectory by its number.
    pub(crate) fn of(lane: usize) -> Self {
        Self { half: lane / HALF, index: lane % HALF }
    }
}

impl<U: Copy> Row<U> {
    /// The row of one number.
    pub(crate) fn filled(value: U) -> Self {
        Self([[value; HALF]; 2])
    }

    #[inline(always)]
    pub(crate) fn get(&self, place: Place) -> U {
        self.0[place.half][place.index]
    }

    #[inline(always)]
    pub(crate) fn set(&mut self, place: Place, value: U) {
        self.0[place.half][place.index] = value;
    }
}

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
        Self([Row::filled(0.0); N])
    }

    /// The vector of one trajectory.
    #[inline(always)]
    pub(crate) fn get(&self, place: Place) -> SVector<f64, N> {
        SVector::from(core::array::from_fn(|k| self.0[k].get(place)))
    }

    /// Sets the vector of one trajectory.
    #[inline(always)]
    pub(crate) fn set(&mut self, place: Place, vector: &SVector<f64, N>) {
        for k in 0..N {
            self.0[k].set(place, vector[k]);
        }
    }

    /// One entry of it.
    #[inline(always)]
    pub(crate) fn entry<const FUSED: bool>(&self, k: usize, place: Place) -> Lane<FUSED> {
        Lane::new(self.0[k].get(place))
    }

    #[inline(always)]
    pub(crate) fn lane<T: Real>(&self, place: Place) -> SVector<T, N> {
        SVector::from(core::array::from_fn(|k| T::real(self.0[k].get(place))))
    }

    #[inline(always)]
    pub(crate) fn set_lane<const FUSED: bool>(&mut self, place: Place, vector: &Vector<N, FUSED>) {
        for k in 0..N {
            self.0[k].set(place, vector[k].get());
        }
    }

    /// Sets it where it is not `kept`.
    #[inline(always)]
    pub(crate) fn set_lane_unless<const FUSED: bool>(&mut self, kept: bool, place: Place, vector: &Vector<N, FUSED>) {
        for k in 0..N {
            let (old, new) = (self.0[k].get(place), vector[k].get());
            self.0[k].set(place, if kept { old } else { new });
        }
    }
}

impl<const N: usize> Nodes<N> {
    pub(crate) fn zeros() -> Self {
        Self { q: Rows::zeros(), q_low: Rows::zeros(), p: Rows::zeros(), p_low: Rows::zeros() }
    }

    /// The node of one trajectory, at the time t. Its energy has no meaning.
    #[inline(always)]
    pub(crate) fn get(&self, place: Place, t: f64) -> Node<N> {
        let state = State { t, q: self.q.get(place), p: self.p.get(place) };
        Node { q_low: self.q_low.get(place), p_low: self.p_low.get(place), ..Node::new(state, 0.0) }
    }

    pub(crate) fn set(&mut self, place: Place, node: &Node<N>) {
        self.q.set(place, &node.q);
        self.q_low.set(place, &node.q_low);
        self.p.set(place, &node.p);
        self.p_low.set(place, &node.p_low);
    }

    #[inline(always)]
    pub(crate) fn lane<T: Real>(&self, place: Place, t: f64) -> Node<N, T> {
        let zero = T::zero();
        Node {
            t: T::real(t),
            t_low: zero,
            q: self.q.lane(place),
            q_low: self.q_low.lane(place),
            p: self.p.lane(place),
            p_low: self.p_low.lane(place),
            energy: zero,
            energy_low: zero,
        }
    }

    #[inline(always)]
    pub(crate) fn set_lane<const FUSED: bool>(&mut self, place: Place, node: &Node<N, Lane<FUSED>>) {
        self.q.set_lane(place, &node.q);
        self.q_low.set_lane(place, &node.q_low);
        self.p.set_lane(place, &node.p);
        self.p_low.set_lane(place, &node.p_low);
    }

    /// Sets it where it is not `kept`.
    #[inline(always)]
    pub(crate) fn set_lane_unless<const FUSED: bool>(&mut self, kept: bool, place: Place, node: &Node<N, Lane<FUSED>>) {
        self.q.set_lane_unless(kept, place, &node.q);
        self.q_low.set_lane_unless(kept, place, &node.q_low);
        self.p.set_lane_unless(kept, place, &node.p);
        self.p_low.set_lane_unless(kept, place, &node.p_low);
    }
}
