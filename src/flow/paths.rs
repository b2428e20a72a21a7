//! Which way does light take along the veins: the shortest-path tree of one light over the skeleton.
//!
//! Dijkstra from the light's node over edge lengths in metres. Among paths of the same length the one through the lower
//! node number wins, so that the tree is the same on any machine. Nothing splits at branches.

use crate::skeleton::Skeleton;
use petgraph::graph::NodeIndex;
use petgraph::visit::EdgeRef;
use std::cmp::Ordering;
use std::collections::BinaryHeap;

/// The shortest-path tree from one node. Nodes of other components have no distance.
#[derive(Debug, Clone, PartialEq)]
pub struct PathTree {
    /// The node the light enters by.
    pub root: NodeIndex,
    /// Metres along edges from the root, by node; infinite where no path leads.
    pub distance_m: Vec<f64>,
    /// The next node towards the root, by node; a node's own number at the root and where no path leads.
    pub parent: Vec<NodeIndex>,
    /// The nodes that a path reaches, nearest first (ties: lower number first); the root leads.
    pub order: Vec<NodeIndex>,
}

impl PathTree {
    /// The tree of shortest paths from `root`; takes `O((nodes + edges) log nodes)`.
    pub fn from(skeleton: &Skeleton, root: NodeIndex) -> Self {
        let nodes = skeleton.graph.node_count();
        let mut tree = Self {
            root,
            distance_m: vec![f64::INFINITY; nodes],
            parent: (0..nodes).map(NodeIndex::new).collect(),
            order: Vec::new(),
        };
        let mut settled = vec![false; nodes];
        let mut front = BinaryHeap::new();
        if root.index() < nodes {
            tree.distance_m[root.index()] = 0.0;
            front.push(Reached { distance_m: 0.0, node: root });
        }

        while let Some(Reached { distance_m, node }) = front.pop() {
            if std::mem::replace(&mut settled[node.index()], true) {
                continue;
            }
            tree.order.push(node);
            for edge in skeleton.graph.edges(node) {
                let next = edge.target();
                let longer_m = distance_m + f64::from(edge.weight().length_m);
                let known_m = tree.distance_m[next.index()];
                let tie = longer_m == known_m && !settled[next.index()] && node < tree.parent[next.index()];
                if longer_m < known_m || tie {
                    tree.distance_m[next.index()] = longer_m;
                    tree.parent[next.index()] = node;
                    front.push(Reached { distance_m: longer_m, node: next });
                }
            }
        }
        tree
    }

    /// Whether a path leads to `node`.
    pub fn reaches(&self, node: NodeIndex) -> bool {
        self.distance_m.get(node.index()).is_some_and(|distance_m| distance_m.is_finite())
    }

    /// The nodes from `node` to the root, both included; just the node where no path leads.
    pub fn path_from(&self, node: NodeIndex) -> impl Iterator<Item = NodeIndex> + '_ {
        std::iter::successors(Some(node), |&at| {
            let parent = self.parent[at.index()];
            (parent != at).then_some(parent)
        })
    }
}

/// A node and the length of a path to it; the heap gives the shortest first, then the lowest number.
struct Reached {
    distance_m: f64,
    node: NodeIndex,
}

impl Ord for Reached {
    fn cmp(&self, other: &Self) -> Ordering {
        other.distance_m.total_cmp(&self.distance_m).then(other.node.cmp(&self.node))
    }
}

impl PartialOrd for Reached {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl PartialEq for Reached {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl Eq for Reached {}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::tests::veins;

    fn numbers(nodes: impl IntoIterator<Item = NodeIndex>) -> Vec<usize> {
        nodes.into_iter().map(NodeIndex::index).collect()
    }

    #[test]
    fn of_two_ways_of_one_length_the_lower_node_is_taken() {
        // Twice round a square, the sides in either order; node 4 stands alone.
        let sides = [(0, 2, 1.0), (2, 3, 0.5), (0, 1, 1.0), (1, 3, 0.5)];
        for turned in [false, true] {
            let mut edges = sides.to_vec();
            if turned {
                edges.reverse();
            }
            let tree = PathTree::from(&veins(&[1; 5], &edges), NodeIndex::new(0));
            assert_eq!(tree.distance_m, [0.0, 1.0, 1.0, 1.5, f64::INFINITY]);
            assert_eq!(numbers(tree.parent.clone()), [0, 0, 0, 1, 4]);
            assert_eq!(numbers(tree.order.clone()), [0, 1, 2, 3]);
            assert_eq!(numbers(tree.path_from(NodeIndex::new(3))), [3, 1, 0]);
            assert_eq!(numbers(tree.path_from(NodeIndex::new(4))), [4]);
            assert!(tree.reaches(NodeIndex::new(3)) && !tree.reaches(NodeIndex::new(4)));
        }
    }

    #[test]
    fn a_detour_that_is_shorter_is_taken() {
        let tree = PathTree::from(&veins(&[1; 3], &[(0, 2, 3.0), (0, 1, 1.0), (1, 2, 1.0)]), NodeIndex::new(2));
        assert_eq!(tree.distance_m, [2.0, 1.0, 0.0]);
        assert_eq!(numbers(tree.path_from(NodeIndex::new(0))), [0, 1, 2]);
    }

    #[test]
    fn a_root_beyond_the_skeleton_reaches_nothing() {
        let tree = PathTree::from(&veins(&[1], &[]), NodeIndex::new(7));
        assert!(tree.order.is_empty() && !tree.reaches(NodeIndex::new(0)) && !tree.reaches(NodeIndex::new(7)));
    }
}
