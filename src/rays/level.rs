//! A tree over bodies, and what each body is.

use super::Surface;
use super::body::Body;
use obvhs::aabb::Aabb;
use obvhs::bvh2::Bvh2;
use obvhs::bvh2::node::Bvh2Node;
use obvhs::bvh2::reinsertion::ReinsertionOptimizer;
use obvhs::cwbvh::CwBvh;
use obvhs::cwbvh::bvh2_to_cwbvh::bvh2_to_cwbvh;
use std::sync::Arc;

/// Share of the nodes that are tried in a better place. Six times as many gain a few percent for twice the build time.
const REINSERTED_SHARE: f32 = 0.05;

/// Bodies in a leaf of the wide tree; its format holds no more.
const MOST_IN_LEAF: u32 = 3;

/// A body on its way into a tree.
#[derive(Debug, Clone, Copy)]
pub(super) struct Solid {
    pub(super) body: Body,
    /// What it belongs to.
    pub(super) surface: Surface,
    /// Share of light that it passes straight on.
    pub(super) transmittance: f32,
}

/// A tree and its bodies, in the order of its leaves.
#[derive(Clone)]
pub(super) struct Level {
    pub(super) tree: Arc<CwBvh>,
    pub(super) bodies: Arc<[Body]>,
    pub(super) surfaces: Arc<[Surface]>,
    pub(super) transmittances: Arc<[f32]>,
}

impl Level {
    /// The tree over bodies, whose boxes are padded by `pad_m`.
    pub(super) fn new(solids: &[Solid], pad_m: f32) -> Self {
        let boxes: Vec<Aabb> = solids.iter().map(|solid| solid.body.padded_box(pad_m)).collect();
        let tree = tree_over(&boxes);
        let leaves = || tree.primitive_indices.iter().filter_map(|&solid| solids.get(solid as usize));
        Self {
            bodies: leaves().map(|solid| solid.body).collect(),
            surfaces: leaves().map(|solid| solid.surface).collect(),
            transmittances: leaves().map(|solid| solid.transmittance).collect(),
            tree: Arc::new(tree),
        }
    }

    pub(super) fn len(&self) -> usize {
        self.bodies.len()
    }

    /// The same tree with the bodies of some surfaces alone; the others are blank.
    pub(super) fn keeping(&self, stays: impl Fn(Surface) -> bool) -> Self {
        let kept = |(&body, &surface): (&Body, &Surface)| if stays(surface) { body } else { Body::Blank };
        Self { bodies: self.bodies.iter().zip(self.surfaces.iter()).map(kept).collect(), ..self.clone() }
    }
}

/// A balanced tree, then improved by moving the subtrees that cost most to better places (Meister & Bittner 2018). The
/// crate's own bottom-up builder was no faster to trace, and where thousands of boxes are alike (repeated faces) it took
/// a minute to chain them into a tree as deep as they are many.
fn tree_over(boxes: &[Aabb]) -> CwBvh {
    if boxes.is_empty() {
        return CwBvh::default();
    }
    let mut tree = balanced(boxes);
    ReinsertionOptimizer::default().run(&mut tree, REINSERTED_SHARE, None);
    bvh2_to_cwbvh(&tree, MOST_IN_LEAF, true, false)
}

/// Halves the boxes by number along the longest axis of their centres, again and again.
fn balanced(boxes: &[Aabb]) -> Bvh2 {
    let mut order: Vec<u32> = (0..boxes.len() as u32).collect();
    let mut nodes = vec![Bvh2Node::default()];
    let mut open = vec![(0, 0..boxes.len())];
    while let Some((node, range)) = open.pop() {
        let part = &mut order[range.clone()];
        let around = part.iter().fold(Aabb::empty(), |around, &at| around.union(&boxes[at as usize]));
        if part.len() == 1 {
            nodes[node] = Bvh2Node::new(around, 1, range.start as u32);
            continue;
        }
        let centres = part.iter().fold(Aabb::empty(), |mut centres, &at| *centres.extend(boxes[at as usize].center()));
        let size = centres.diagonal();
        let axis = (0..3).fold(0, |widest, axis| if size[axis] > size[widest] { axis } else { widest });
        let half = part.len() / 2;
        part.select_nth_unstable_by(half, |&a, &b| {
            let along = |at: u32| boxes[at as usize].center()[axis];
            along(a).total_cmp(&along(b)).then(a.cmp(&b))
        });
        let child = nodes.len();
        nodes.extend([Bvh2Node::default(); 2]);
        nodes[node] = Bvh2Node::new(around, 0, child as u32);
        open.push((child, range.start..range.start + half));
        open.push((child + 1, range.start + half..range.end));
    }
    Bvh2 { nodes, primitive_indices: order, children_are_ordered_after_parents: true, ..Bvh2::default() }
}
