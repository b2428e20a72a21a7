//! What bounds a void made of boxes?
//!
//! The planes of all boxes cut space into cells; a cell is void or solid by the last box that holds it, and each face between
//! void and solid becomes two triangles that face the void. Neighbours share whole edges, so no light leaks. Sheets are
//! walls without thickness.

use crate::scene::Mesh;
use glam::Vec3;
use std::collections::HashMap;

/// Boxes in the order in which they are carved out or filled in, and sheets; outside all of them is matter.
#[derive(Debug, Clone, Default)]
pub struct Boxes {
    parts: Vec<Part>,
    sheets: Vec<[Vec3; 4]>,
}

#[derive(Debug, Clone, Copy)]
struct Part {
    low_m: Vec3,
    high_m: Vec3,
    is_void: bool,
}

impl Boxes {
    /// Carves out a box, metres.
    pub fn void(self, low_m: [f32; 3], high_m: [f32; 3]) -> Self {
        self.with(low_m, high_m, true)
    }

    /// Fills a box with matter again.
    pub fn solid(self, low_m: [f32; 3], high_m: [f32; 3]) -> Self {
        self.with(low_m, high_m, false)
    }

    /// A rectangle without thickness: its lowest and highest corner, which agree along one axis.
    pub fn sheet(mut self, low_m: [f32; 3], high_m: [f32; 3]) -> Self {
        let flat = (0..3).find(|&axis| low_m[axis] == high_m[axis]).unwrap_or(0);
        let (u, v) = ((flat + 1) % 3, (flat + 2) % 3);
        let corner = |upper: [bool; 2]| {
            let mut corner = low_m;
            corner[u] = if upper[0] { high_m[u] } else { low_m[u] };
            corner[v] = if upper[1] { high_m[v] } else { low_m[v] };
            Vec3::from_array(corner)
        };
        self.sheets.push([[false, false], [true, false], [true, true], [false, true]].map(corner));
        self
    }

    fn with(mut self, low_m: [f32; 3], high_m: [f32; 3], is_void: bool) -> Self {
        self.parts.push(Part { low_m: low_m.into(), high_m: high_m.into(), is_void });
        self
    }

    fn is_void(&self, point_m: Vec3) -> bool {
        let holds = |part: &&Part| point_m.cmpgt(part.low_m).all() && point_m.cmplt(part.high_m).all();
        self.parts.iter().rev().find(holds).is_some_and(|part| part.is_void)
    }

    /// The mesh of all faces, of material 0.
    pub fn mesh(&self) -> Mesh {
        let planes: [Vec<f32>; 3] = std::array::from_fn(|axis| {
            let mut planes: Vec<f32> =
                self.parts.iter().flat_map(|part| [part.low_m[axis], part.high_m[axis]]).collect();
            planes.sort_by(f32::total_cmp);
            planes.dedup();
            planes
        });
        let cells: [usize; 3] = std::array::from_fn(|axis| planes[axis].len().saturating_sub(1));
        let middle_m = |cell: [usize; 3]| {
            Vec3::from_array(std::array::from_fn(|axis| {
                0.5 * (planes[axis][cell[axis]] + planes[axis][cell[axis] + 1])
            }))
        };
        let is_void = |cell: [usize; 3]| (0..3).all(|axis| cell[axis] < cells[axis]) && self.is_void(middle_m(cell));

        let mut quads: Vec<[Vec3; 4]> = self.sheets.clone();
        let all = (0..cells.iter().product())
            .map(|i: usize| [i % cells[0], i / cells[0] % cells[1], i / cells[0] / cells[1]]);
        for (cell, axis, upper) in all.filter(|&cell| is_void(cell)).flat_map(faces_of) {
            let mut beyond = cell;
            // Below the lowest plane the number wraps round, and is beyond all cells.
            beyond[axis] = if upper { cell[axis] + 1 } else { cell[axis].wrapping_sub(1) };
            if !is_void(beyond) {
                quads.push(face(cell, axis, upper, &planes));
            }
        }
        mesh_of(&quads)
    }
}

/// The six faces of a cell: along which axis, and whether at its upper end.
fn faces_of(cell: [usize; 3]) -> impl Iterator<Item = ([usize; 3], usize, bool)> {
    (0..6).map(move |face| (cell, face / 2, face % 2 == 1))
}

/// The corners of a face, counter-clockwise seen from within the cell.
fn face(cell: [usize; 3], axis: usize, upper: bool, planes: &[Vec<f32>; 3]) -> [Vec3; 4] {
    let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
    let mut corners = [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[along_u, along_v]| {
        let mut corner = cell;
        corner[axis] += usize::from(upper);
        corner[u] += along_u;
        corner[v] += along_v;
        Vec3::from_array(std::array::from_fn(|axis| planes[axis][corner[axis]]))
    });
    if upper {
        corners.reverse();
    }
    corners
}

fn mesh_of(quads: &[[Vec3; 4]]) -> Mesh {
    let mut mesh = Mesh::default();
    let mut number_at = HashMap::new();
    for quad in quads {
        let [a, b, c, d] = quad.map(|corner_m| {
            *number_at.entry(corner_m.to_array().map(f32::to_bits)).or_insert_with(|| {
                mesh.positions_m.push(corner_m);
                mesh.positions_m.len() as u32 - 1
            })
        });
        mesh.triangles.extend([[a, b, c], [a, c, d]]);
        mesh.material_of.extend([0, 0]);
    }
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The volume inside a closed mesh whose faces look inwards, and its area.
    fn volume_and_area(mesh: &Mesh) -> [f32; 2] {
        let corners = (0..mesh.triangles.len()).map(|number| mesh.corners_m(number).unwrap());
        corners.fold([0.0; 2], |[volume, area], [a, b, c]| {
            [volume - a.dot(b.cross(c)) / 6.0, area + 0.5 * (b - a).cross(c - a).length()]
        })
    }

    #[test]
    fn faces_look_into_the_void_and_close_it() {
        let rooms = Boxes::default()
            .void([0.0, 0.0, 0.0], [2.0, 1.0, 1.0])
            .void([2.0, 0.2, 0.0], [3.0, 0.8, 1.0])
            .solid([0.5, 0.4, 0.2], [0.7, 0.6, 0.4]);
        let [volume, area] = volume_and_area(&rooms.mesh());
        assert!((volume - (2.0 + 0.6 - 0.008)).abs() < 1e-5, "{volume}");
        // The room's 10 m2 without the mouth, the niche's other five sides, the block.
        assert!((area - (10.0 - 0.6 + 3.8 + 0.24)).abs() < 1e-4, "{area}");
    }

    #[test]
    fn a_sheet_is_two_triangles() {
        let mesh = Boxes::default().sheet([1.0, 0.0, 0.0], [1.0, 2.0, 3.0]).mesh();
        assert_eq!((mesh.triangles.len(), volume_and_area(&mesh)[1]), (2, 6.0));
    }
}
