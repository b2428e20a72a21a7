//! What bounds a void made of axis-aligned boxes?
//!
//! The planes of all boxes cut space into cells; a cell is void or solid by the last box that holds it, and each face
//! between void and solid becomes a quad. Neighbours share whole edges, so no T-junction can leak light. Two boxes
//! that touch along an edge alone would give an edge with four faces; `check` refuses that.

use std::collections::BTreeMap;

use glam::DVec3;

use crate::scene::Mesh;

/// Boxes in the order in which they are carved out or filled in.
#[derive(Default)]
pub struct Plan {
    parts: Vec<(DVec3, DVec3, bool)>,
}

impl Plan {
    /// Carves a box out of the matter.
    pub fn void(mut self, min: [f64; 3], max: [f64; 3]) -> Self {
        self.parts.push((min.into(), max.into(), true));
        self
    }

    /// Fills a box with matter again: a pillar, a block.
    pub fn solid(mut self, min: [f64; 3], max: [f64; 3]) -> Self {
        self.parts.push((min.into(), max.into(), false));
        self
    }

    /// Whether a point lies in the void; outside every box is matter.
    pub fn is_void(&self, p: DVec3) -> bool {
        self.parts
            .iter()
            .rev()
            .find(|(min, max, _)| p.cmpgt(*min).all() && p.cmplt(*max).all())
            .is_some_and(|(_, _, void)| *void)
    }

    /// Whether a cube of half-side `margin_m` about a point is void at its corners and faces.
    pub fn is_clear(&self, p: DVec3, margin_m: f64) -> bool {
        let steps = [-margin_m, 0.0, margin_m];
        steps.iter().all(|x| steps.iter().all(|y| steps.iter().all(|z| self.is_void(p + DVec3::new(*x, *y, *z)))))
    }

    /// The corners of the box that holds all parts.
    pub fn bounds(&self) -> (DVec3, DVec3) {
        self.parts
            .iter()
            .fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(low, high), (min, max, _)| (low.min(*min), high.max(*max)))
    }

    /// The void's boundary. `material` names each quad's material by its normal.
    pub fn mesh(&self, material: impl Fn(DVec3) -> &'static str) -> Mesh {
        let planes: [Vec<f64>; 3] = std::array::from_fn(|axis| {
            let mut planes: Vec<f64> = self.parts.iter().flat_map(|(min, max, _)| [min[axis], max[axis]]).collect();
            planes.sort_by(f64::total_cmp);
            planes.dedup();
            planes
        });
        let middle = |axis: usize, i: usize| (planes[axis][i] + planes[axis][i + 1]) / 2.0;
        let is_void = |cell: [usize; 3]| {
            let inside = (0..3).all(|axis| cell[axis] + 1 < planes[axis].len());
            inside && self.is_void(DVec3::from(std::array::from_fn(|a| middle(a, cell[a]))))
        };

        let mut mesh = Mesh::default();
        let mut index_of = BTreeMap::new();
        let mut groups: BTreeMap<&'static str, Vec<Vec<usize>>> = BTreeMap::new();
        for z in 0..planes[2].len() - 1 {
            for y in 0..planes[1].len() - 1 {
                for x in 0..planes[0].len() - 1 {
                    let cell = [x, y, z];
                    if !is_void(cell) {
                        continue;
                    }
                    for axis in 0..3 {
                        for upper in [false, true] {
                            // The cell on the other side; below the lowest plane there is only matter.
                            let mut other = cell;
                            other[axis] = if upper { cell[axis] + 1 } else { cell[axis].wrapping_sub(1) };
                            if other[axis] != usize::MAX && is_void(other) {
                                continue;
                            }
                            // Counter-clockwise about +axis, turned over where the void lies below the face.
                            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
                            let mut quad: Vec<usize> = [(0, 0), (1, 0), (1, 1), (0, 1)]
                                .iter()
                                .map(|(i, j)| {
                                    let mut corner = cell;
                                    corner[axis] += usize::from(upper);
                                    corner[u] += i;
                                    corner[v] += j;
                                    *index_of.entry(corner).or_insert_with(|| {
                                        mesh.vertices.push(DVec3::from(std::array::from_fn(|a| planes[a][corner[a]])));
                                        mesh.vertices.len() - 1
                                    })
                                })
                                .collect();
                            if upper {
                                quad.reverse();
                            }
                            let normal = DVec3::AXES[axis] * if upper { -1.0 } else { 1.0 };
                            groups.entry(material(normal)).or_default().push(quad);
                        }
                    }
                }
            }
        }
        mesh.groups = groups.into_iter().collect();
        mesh
    }
}

/// The material of a face in a furnished room, by where its normal points.
pub fn floor_wall_ceiling(normal: DVec3) -> &'static str {
    if normal.z > 0.5 {
        "floor"
    } else if normal.z < -0.5 {
        "ceiling"
    } else {
        "wall"
    }
}
