//! The skeleton as SWC, the format of neuron tracing (Cannon et al. 1998): a forest, a line a node with its parent.
//!
//! SWC knows no loops. Each component is written as the breadth-first tree from its lowest node, and the edges that close
//! loops are listed in `#` lines, so that nothing is lost.

use crate::scene::Scene;
use crate::skeleton::Skeleton;
use petgraph::graph::NodeIndex;
use std::collections::VecDeque;
use std::io::{self, Write};

/// Writes the skeleton: `id type x y z radius parent`, metres, ids from 1, parent -1 at a root, type 0.
///
/// # Errors
/// What the writer says.
pub fn write(out: &mut dyn Write, scene: &Scene, skeleton: &Skeleton) -> io::Result<()> {
    let forest = Forest::of(skeleton);
    writeln!(out, "# skeleton of {}: id type x y z radius parent; metres; type 0 = undefined", one_line(&scene.name))?;
    for [a, b] in &forest.closing {
        writeln!(out, "# loop: {} {}", a + 1, b + 1)?;
    }
    for &node in &forest.order {
        let at = &skeleton.graph[node];
        let [x, y, z] = scene.to_user_m(at.position_m).to_array();
        let parent = forest.parent[node.index()].map_or(-1, |parent| parent.index() as i64 + 1);
        writeln!(out, "{} 0 {x} {y} {z} {} {parent}", node.index() + 1, at.radius_m)?;
    }
    Ok(())
}

/// A name without line breaks.
fn one_line(name: &str) -> String {
    name.replace(['\n', '\r'], " ")
}

/// A spanning forest: parents before children, and the edges it leaves out.
struct Forest {
    order: Vec<NodeIndex>,
    parent: Vec<Option<NodeIndex>>,
    closing: Vec<[usize; 2]>,
}

impl Forest {
    fn of(skeleton: &Skeleton) -> Self {
        let graph = &skeleton.graph;
        let mut forest = Self { order: Vec::new(), parent: vec![None; graph.node_count()], closing: Vec::new() };
        let mut seen = vec![false; graph.node_count()];
        for root in graph.node_indices() {
            if std::mem::replace(&mut seen[root.index()], true) {
                continue;
            }
            let mut front = VecDeque::from([root]);
            while let Some(node) = front.pop_front() {
                forest.order.push(node);
                let mut next: Vec<_> = graph.neighbors(node).collect();
                next.sort();
                for neighbour in next {
                    if !std::mem::replace(&mut seen[neighbour.index()], true) {
                        forest.parent[neighbour.index()] = Some(node);
                        front.push_back(neighbour);
                    }
                }
            }
        }
        let is_tree =
            |a: NodeIndex, b: NodeIndex| forest.parent[a.index()] == Some(b) || forest.parent[b.index()] == Some(a);
        let ends = graph.edge_indices().filter_map(|edge| graph.edge_endpoints(edge));
        forest.closing = ends.filter(|&(a, b)| !is_tree(a, b)).map(|(a, b)| [a.index(), b.index()]).collect();
        forest
    }
}
