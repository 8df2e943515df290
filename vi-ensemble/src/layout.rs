//! Nodes and velocities of a block, one row per coordinate.
//!
//! In: vectors of N entries, one per trajectory. Out: N rows of [`WIDTH`] numbers, in which one vector instruction
//! processes the same coordinate of adjacent trajectories.

use nalgebra::SVector;
use vi_core::State;
use vi_core::node::Node;
use vi_core::real::Lane;
use vi_core::real::Real;

/// Trajectories in a block: several vectors, so that their instructions overlap.
pub(crate) const WIDTH: usize = 2 * HALF;

/// Trajectories in half of a block.
pub(crate) const HALF: usize = 32;

/// Numbers summed at a time: two of the widest vectors.
const CHUNK: usize = 16;

/// One number of each trajectory of a block.
#[derive(Clone, Copy, Debug)]
#[repr(align(64))]
pub(crate) struct Row<U = f64>([[U; HALF]; 2]);

/// The position of a trajectory in a row: its half and its index there. The compiler sees both in bounds, one as a
/// constant and the other as a loop counter.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LaneIndex {
    pub(crate) half: usize,
    pub(crate) index: usize,
}

impl LaneIndex {
    /// The index of a trajectory, from its number in the block.
    pub(crate) fn of(number: usize) -> Self {
        Self { half: number / HALF, index: number % HALF }
    }
}

impl<U: Copy> Row<U> {
    /// The row of one number.
    pub(crate) fn filled(value: U) -> Self {
        Self([[value; HALF]; 2])
    }

    #[inline(always)]
    pub(crate) fn get(&self, lane: LaneIndex) -> U {
        self.0[lane.half][lane.index]
    }

    #[inline(always)]
    pub(crate) fn set(&mut self, lane: LaneIndex, value: U) {
        self.0[lane.half][lane.index] = value;
    }
}

/// One vector of each trajectory of a block, row by row.
#[derive(Clone, Debug)]
pub(crate) struct Rows<const N: usize>([Row; N]);

impl<const N: usize> Rows<N> {
    pub(crate) fn zeros() -> Self {
        Self([Row::filled(0.0); N])
    }

    /// The vector of one trajectory.
    #[inline(always)]
    pub(crate) fn get<T: Real>(&self, lane: LaneIndex) -> SVector<T, N> {
        SVector::from(core::array::from_fn(|k| T::real(self.0[k].get(lane))))
    }

    /// Sets the vector of one trajectory.
    #[inline(always)]
    pub(crate) fn set<T: Real>(&mut self, lane: LaneIndex, vector: &SVector<T, N>) {
        for k in 0..N {
            self.0[k].set(lane, vector[k].to_f64());
        }
    }

    /// Sets the vector unless `kept`.
    #[inline(always)]
    pub(crate) fn set_unless<T: Real>(&mut self, kept: bool, lane: LaneIndex, vector: &SVector<T, N>) {
        for k in 0..N {
            let (old, new) = (self.0[k].get(lane), vector[k].to_f64());
            self.0[k].set(lane, if kept { old } else { new });
        }
    }

    /// Sets the rows to `Σ weight · other`.
    #[inline(always)]
    pub(crate) fn set_sum<const FUSED: bool>(&mut self, weights: &[f64], others: &[Box<Self>]) {
        for (k, row) in self.0.iter_mut().enumerate() {
            for (place, sums) in row.0.as_flattened_mut().chunks_exact_mut(CHUNK).enumerate() {
                // Accumulates in registers.
                let mut whole = [0.0; CHUNK];
                for (weight, other) in weights.iter().zip(others) {
                    let entries = &other.0[k].0.as_flattened()[place * CHUNK..(place + 1) * CHUNK];
                    for (sum, entry) in whole.iter_mut().zip(entries) {
                        *sum = Lane::<FUSED>::multiply_add(*weight, *entry, *sum);
                    }
                }
                sums.copy_from_slice(&whole);
            }
        }
    }
}

/// Coordinates and momenta of a block with their low parts, and the residuals of the last step.
#[derive(Clone, Debug)]
pub(crate) struct Nodes<const N: usize> {
    q: Rows<N>,
    q_low: Rows<N>,
    p: Rows<N>,
    p_low: Rows<N>,
    pub(crate) remainder: Rows<N>,
}

impl<const N: usize> Nodes<N> {
    pub(crate) fn zeros() -> Self {
        let zeros = Rows::zeros;
        Self { q: zeros(), q_low: zeros(), p: zeros(), p_low: zeros(), remainder: zeros() }
    }

    /// The node of one trajectory at the time t with its low part. Its energy is meaningless.
    #[inline(always)]
    pub(crate) fn get<T: Real>(&self, lane: LaneIndex, (t, t_low): (f64, f64)) -> Node<N, T> {
        let state = State { t: T::real(t), q: self.q.get(lane), p: self.p.get(lane) };
        Node {
            t_low: T::real(t_low),
            q_low: self.q_low.get(lane),
            p_low: self.p_low.get(lane),
            ..Node::new(state, T::zero())
        }
    }

    /// Coordinates of one trajectory.
    #[inline(always)]
    pub(crate) fn q(&self, lane: LaneIndex) -> SVector<f64, N> {
        self.q.get(lane)
    }

    /// Sets the node of one trajectory.
    #[inline(always)]
    pub(crate) fn set<T: Real>(&mut self, lane: LaneIndex, node: &Node<N, T>) {
        self.set_unless(false, lane, node);
    }

    /// Sets the node unless `kept`.
    #[inline(always)]
    pub(crate) fn set_unless<T: Real>(&mut self, kept: bool, lane: LaneIndex, node: &Node<N, T>) {
        self.q.set_unless(kept, lane, &node.q);
        self.q_low.set_unless(kept, lane, &node.q_low);
        self.p.set_unless(kept, lane, &node.p);
        self.p_low.set_unless(kept, lane, &node.p_low);
    }
}
