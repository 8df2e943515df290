//! The order in which coordinates and multipliers are eliminated in a step with constraints.
//!
//! In: which unknowns are coupled; unknown r of the constraints is `dimension + r`. Out: [`Block`]s. One rule holds for
//! all systems:
//!
//! ```text
//! nodes     coordinates coupled in M, with the constraints on them alone: M may be singular across those
//! order     the node with the fewest coupled unknowns first. So chains and trees shrink from their leaves, loops are
//!           left for the end, and cost and memory stay linear
//! wait      a constraint waits until the eliminated coordinates around it outnumber the eliminated constraints
//! merge     a node with the next one that it is coupled to, if that adds few zeros: small blocks cost more than they save
//! ```

use std::collections::BTreeSet;

/// Maximum number of zeros that a merger may add to each row of a node.
const ZEROS: usize = 2;
/// Maximum number of unknowns of a node to which a merger adds zeros.
const SMALL: usize = 4;

/// Unknowns that are eliminated together.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Block {
    /// The unknowns of the block.
    pub own: Vec<usize>,
    /// The later unknowns that they are coupled to at their elimination, in that order.
    pub border: Vec<usize>,
}

/// Nodes of unknowns, and the couplings between them.
struct Graph {
    dimension: usize,
    /// The unknowns of each node, ascending.
    members: Vec<Vec<usize>>,
    /// The other nodes that each one is coupled to.
    coupled: Vec<BTreeSet<usize>>,
}

/// The blocks in the order of their elimination. `masses` are the couplings in M, `couplings` all others.
pub(super) fn blocks(
    [dimension, constraints]: [usize; 2],
    masses: &[(usize, usize)],
    couplings: &[(usize, usize)],
) -> Vec<Block> {
    let graph = Graph::new([dimension, constraints], masses, couplings).merged();
    graph.eliminated()
}

/// The first member of the group of an unknown.
fn first(groups: &[usize], mut unknown: usize) -> usize {
    while groups[unknown] != unknown {
        unknown = groups[unknown];
    }
    unknown
}

impl Graph {
    fn new([dimension, constraints]: [usize; 2], masses: &[(usize, usize)], couplings: &[(usize, usize)]) -> Self {
        let count = dimension + constraints;
        let mut groups: Vec<usize> = (0..count).collect();
        for (row, column) in masses {
            let (left, right) = (first(&groups, *row), first(&groups, *column));
            groups[left.max(right)] = left.min(right);
        }
        let mut around: Vec<BTreeSet<usize>> = vec![BTreeSet::new(); count];
        for (row, column) in couplings.iter().filter(|(row, column)| row != column) {
            around[*row].insert(*column);
            around[*column].insert(*row);
        }
        for constraint in dimension..count {
            let nodes: BTreeSet<usize> = around[constraint].iter().map(|unknown| first(&groups, *unknown)).collect();
            if let (1, Some(node)) = (nodes.len(), nodes.first()) {
                groups[constraint] = *node;
            }
        }
        let groups: Vec<usize> = (0..count).map(|unknown| first(&groups, unknown)).collect();
        Self::of_groups(dimension, &groups, &around)
    }

    /// The graph of groups of unknowns, each named by one of its members.
    fn of_groups(dimension: usize, groups: &[usize], around: &[BTreeSet<usize>]) -> Self {
        let names: Vec<usize> = groups.iter().copied().collect::<BTreeSet<_>>().into_iter().collect();
        let node = |unknown: usize| names.binary_search(&groups[unknown]).unwrap_or(0);
        let mut members = vec![Vec::new(); names.len()];
        let mut coupled = vec![BTreeSet::new(); names.len()];
        for (unknown, others) in around.iter().enumerate() {
            let own = node(unknown);
            members[own].push(unknown);
            coupled[own].extend(others.iter().map(|other| node(*other)).filter(|other| *other != own));
        }
        Self { dimension, members, coupled }
    }

    /// Merges nodes of one kind that are coupled to the same nodes: the coordinates of a point, the rows of a joint.
    fn merged(self) -> Self {
        let mut groups: Vec<usize> = (0..self.members.len()).collect();
        for node in 0..self.members.len() {
            let alike = |other: &usize| {
                let without = |node: usize, other: usize| self.coupled[node].iter().filter(move |at| **at != other);
                groups[*other] == *other
                    && self.is_joint(node) == self.is_joint(*other)
                    && without(node, *other).eq(without(*other, node))
            };
            // Only a neighbour, or a neighbour of a neighbour, can have the same neighbours.
            let near = self.coupled[node].iter().flat_map(|at| &self.coupled[*at]).chain(&self.coupled[node]);
            if let Some(other) = near.copied().filter(|other| *other < node).find(|other| alike(other)) {
                groups[node] = other;
            }
        }
        let mut members = vec![Vec::new(); groups.len()];
        let mut coupled = vec![BTreeSet::new(); groups.len()];
        for (node, group) in groups.iter().enumerate() {
            members[*group].extend(&self.members[node]);
            coupled[*group].extend(self.coupled[node].iter().map(|at| groups[*at]).filter(|at| at != group));
        }
        Self { dimension: self.dimension, members, coupled }
    }

    /// Whether a node has constraints only.
    fn is_joint(&self, node: usize) -> bool {
        self.members[node].iter().all(|unknown| *unknown >= self.dimension)
    }

    /// The number of coordinates minus the number of constraints of a node.
    fn freedom(&self, node: usize) -> isize {
        let constraints = self.members[node].iter().filter(|unknown| **unknown >= self.dimension).count();
        (self.members[node].len() - constraints).cast_signed() - constraints.cast_signed()
    }

    fn eliminated(mut self) -> Vec<Block> {
        let mut left: BTreeSet<usize> =
            (0..self.members.len()).filter(|node| !self.members[*node].is_empty()).collect();
        // The eliminated nodes as groups: the group of each node, the freedom of each group, and the groups at a node.
        let mut groups: Vec<usize> = (0..self.members.len()).collect();
        let mut freedoms: Vec<isize> = (0..self.members.len()).map(|node| self.freedom(node)).collect();
        let mut touched: Vec<BTreeSet<usize>> = vec![BTreeSet::new(); self.members.len()];
        let mut order: Vec<(usize, Vec<usize>)> = Vec::new();
        while !left.is_empty() {
            let ready = |node: &usize| {
                let around = touched[*node].iter().map(|other| first(&groups, *other)).collect::<BTreeSet<_>>();
                self.freedom(*node) + around.iter().map(|group| freedoms[*group]).sum::<isize>() >= 0
            };
            let degree =
                |node: &usize| self.coupled[*node].iter().map(|other| self.members[*other].len()).sum::<usize>();
            let next = left.iter().copied().filter(ready).min_by_key(degree);
            let Some(node) = next.or_else(|| left.first().copied()) else { break };
            left.remove(&node);
            for other in core::mem::take(&mut touched[node]) {
                let group = first(&groups, other);
                if group != node {
                    groups[group] = node;
                    freedoms[node] += freedoms[group];
                }
            }
            let border: Vec<usize> = core::mem::take(&mut self.coupled[node]).into_iter().collect();
            for other in &border {
                self.coupled[*other].remove(&node);
                touched[*other].insert(node);
                for third in border.iter().filter(|third| *third != other) {
                    self.coupled[*other].insert(*third);
                }
            }
            order.push((node, border));
        }
        self.blocks(&order)
    }

    /// Blocks of eliminated nodes with their borders; a node joins the next one of its border if that has no other.
    fn blocks(&self, order: &[(usize, Vec<usize>)]) -> Vec<Block> {
        let mut places = vec![0; self.members.len()];
        for (place, (node, _)) in order.iter().enumerate() {
            places[*node] = place;
        }
        let sorted = |border: &[usize]| {
            let mut sorted: Vec<usize> = border.iter().map(|node| places[*node]).collect();
            sorted.sort_unstable();
            sorted
        };
        let mut nodes: Vec<(Vec<usize>, Vec<usize>)> =
            order.iter().enumerate().map(|(place, (_, border))| (vec![place], sorted(border))).collect();
        let count = |places: &[usize]| places.iter().map(|place| self.members[order[*place].0].len()).sum::<usize>();
        for place in 0..nodes.len() {
            let Some(next) = nodes[place].1.first().copied() else { continue };
            let [(own, border), (own_of_next, border_of_next)] = [&nodes[place], &nodes[next]];
            let gained = (count(own_of_next) + count(border_of_next)).saturating_sub(count(border));
            if gained == 0 || gained <= ZEROS && count(own) + count(own_of_next) <= SMALL {
                let own = core::mem::take(&mut nodes[place].0);
                nodes[next].0.splice(0..0, own);
            }
        }
        let unknowns =
            |places: &[usize]| places.iter().flat_map(|place| &self.members[order[*place].0]).copied().collect();
        // Mergers changed the order of elimination; each border follows the new order.
        let mut blocks: Vec<(Vec<usize>, Vec<usize>)> = nodes.into_iter().filter(|(own, _)| !own.is_empty()).collect();
        let mut ranks = vec![0; order.len()];
        for (index, place) in blocks.iter().flat_map(|(own, _)| own).enumerate() {
            ranks[*place] = index;
        }
        for (_, border) in &mut blocks {
            border.sort_unstable_by_key(|place| ranks[*place]);
        }
        blocks.iter().map(|(own, border)| Block { own: unknowns(own), border: unknowns(border) }).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::{Block, blocks};

    /// Points in a plane, joined in pairs.
    fn linkage(points: usize, rods: &[Vec<usize>]) -> Vec<Block> {
        let of = |rod: &[usize], r: usize| {
            let columns = rod.iter().flat_map(|point| [2 * point, 2 * point + 1]);
            columns.map(|column| (2 * points + r, column)).collect::<Vec<_>>()
        };
        let couplings: Vec<_> = rods.iter().zip(0..).flat_map(|(rod, r)| of(rod, r)).collect();
        let masses: Vec<_> = (0..2 * points).map(|i| (i, i)).collect();
        blocks([2 * points, rods.len()], &masses, &couplings)
    }

    /// Each unknown once; every border within the block of its first unknown and the border of that.
    fn check(blocks: &[Block], unknowns: usize) {
        let mut all: Vec<usize> = blocks.iter().flat_map(|block| &block.own).copied().collect();
        let position = |unknown: &usize| blocks.iter().flat_map(|block| &block.own).position(|own| own == unknown);
        for block in blocks {
            assert!(block.border.is_sorted_by_key(&position), "{block:?}");
            let Some(first) = block.border.first() else { continue };
            let parent = blocks.iter().find(|other| other.own.contains(first)).expect("a block");
            let is_in = |unknown: &usize| parent.own.contains(unknown) || parent.border.contains(unknown);
            assert!(block.border.iter().all(is_in), "{block:?} {parent:?}");
            assert!(position(&parent.own[0]) > position(&block.own[0]));
        }
        all.sort_unstable();
        assert!(all.iter().copied().eq(0..unknowns), "{all:?}");
    }

    #[test]
    fn blocks_of_a_chain_are_small() {
        let found = linkage(10, &(0..10).map(|i: usize| vec![i.saturating_sub(1), i]).collect::<Vec<_>>());
        check(&found, 30);
        let size = |block: &Block| block.own.len() + block.border.len();
        assert!(found.iter().all(|block| size(block) <= 8), "{found:?}");
    }

    #[test]
    fn borders_of_trees_do_not_grow() {
        for points in [7, 63] {
            let rods: Vec<Vec<usize>> =
                (0..points).map(|i: usize| if i == 0 { vec![0] } else { vec![(i - 1) / 2, i] }).collect();
            let found = linkage(points, &rods);
            check(&found, 3 * points);
            assert!(found.iter().all(|block| block.border.len() <= 3), "{found:?}");
        }
        // A hub is eliminated last.
        let rods: Vec<Vec<usize>> = (1..20).map(|i| vec![0, i]).collect();
        let found = linkage(20, &rods);
        check(&found, 59);
        assert!(found.iter().all(|block| block.border.len() <= 2), "{found:?}");
    }

    #[test]
    fn loops_close_at_the_end() {
        let rods: Vec<Vec<usize>> = (0..40).map(|i: usize| vec![i, (i + 1) % 40]).collect();
        let found = linkage(40, &rods);
        check(&found, 120);
        assert!(found.iter().all(|block| block.border.len() <= 6), "{found:?}");
    }

    #[test]
    fn a_constraint_on_one_body_joins_its_coordinates() {
        // A quaternion of four coordinates that M couples, with its length.
        let masses: Vec<_> = (0..4).flat_map(|i| (0..4).map(move |j| (i, j))).collect();
        let couplings: Vec<_> = (0..4).map(|j| (4, j)).collect();
        assert_eq!(blocks([4, 1], &masses, &couplings), [Block { own: vec![0, 1, 2, 3, 4], border: vec![] }]);
    }
}
