//! Who is joined to whom, and which way does the curve run there?
//!
//! The curve of unit steps between lattice points, laid out flat (links of a node side by side) for the searches that cut
//! it into cells. Nodes and edges have the numbers they keep in the graph.

use glam::{IVec3, Vec3};

/// The edges at each node.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Links {
    first: Vec<u32>,
    links: Vec<Link>,
}

/// One edge seen from one of its ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Link {
    /// The node at the other end.
    pub node: u32,
    /// The edge.
    pub edge: u32,
}

impl Links {
    /// Lays out the edges of `nodes` nodes; the links of a node are in the order of the edges.
    pub fn new(nodes: usize, edges: &[[u32; 2]]) -> Self {
        let mut first = vec![0_u32; nodes + 1];
        for end in edges.iter().flatten() {
            first[*end as usize + 1] += 1;
        }
        for node in 0..nodes {
            first[node + 1] += first[node];
        }
        let mut next = first.clone();
        let mut links = vec![Link { node: 0, edge: 0 }; 2 * edges.len()];
        for (edge, &[a, b]) in edges.iter().enumerate() {
            for (from, to) in [(a, b), (b, a)] {
                links[next[from as usize] as usize] = Link { node: to, edge: edge as u32 };
                next[from as usize] += 1;
            }
        }
        Self { first, links }
    }

    /// How many nodes there are.
    pub fn nodes(&self) -> usize {
        self.first.len() - 1
    }

    /// The edges at a node.
    pub fn of(&self, node: u32) -> &[Link] {
        &self.links[self.first[node as usize] as usize..self.first[node as usize + 1] as usize]
    }

    /// The node reached from `from` over the edge to `to` and on for at most `steps` in all; stops where the curve
    /// branches or ends.
    pub fn walk(&self, from: u32, to: u32, steps: usize) -> u32 {
        let (mut before, mut here) = (from, to);
        for _ in 1..steps {
            let [a, b] = self.of(here) else { break };
            (before, here) = (here, if a.node == before { b.node } else { a.node });
        }
        here
    }

    /// The unit direction of the curve at the edge from `a` to `b`, smoothed over `reach` steps to either side: unit
    /// steps along axes are not yet a direction.
    pub fn direction(&self, corners: &[IVec3], [a, b]: [u32; 2], reach: usize) -> Vec3 {
        let [behind, ahead] = [self.walk(b, a, reach), self.walk(a, b, reach)].map(|node| corners[node as usize]);
        let step = (corners[b as usize] - corners[a as usize]).as_vec3();
        (ahead - behind).as_vec3().try_normalize().unwrap_or(step)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_staircase_runs_along_its_diagonal() {
        let corners: Vec<IVec3> = (0..9).map(|i| IVec3::new((i + 1) / 2, i / 2, 0)).collect();
        let edges: Vec<[u32; 2]> = (0..8).map(|i| [i, i + 1]).collect();
        let links = Links::new(corners.len(), &edges);
        assert_eq!(links.of(0).len(), 1);
        assert_eq!(links.of(4), [Link { node: 3, edge: 3 }, Link { node: 5, edge: 4 }]);
        assert_eq!(links.walk(3, 4, 3), 6);
        assert_eq!(links.walk(3, 4, 30), 8);
        let direction = links.direction(&corners, [3, 4], 4);
        assert!(direction.dot(Vec3::new(1.0, 1.0, 0.0).normalize()) > 0.98, "{direction}");
    }

    #[test]
    fn a_direction_does_not_look_past_a_branch() {
        let corners = [IVec3::ZERO, IVec3::X, IVec3::X * 2, IVec3::new(1, 1, 0), IVec3::new(1, 2, 0)];
        let links = Links::new(5, &[[0, 1], [1, 2], [1, 3], [3, 4]]);
        assert_eq!(links.direction(&corners, [1, 3], 4), Vec3::Y);
    }
}
