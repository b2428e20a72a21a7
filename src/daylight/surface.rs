//! Where on a mesh is exposure asked for: on its faces, cut into patches, or at its vertices?
//!
//! Patches: a face is halved across its longest side until no side is longer than asked for, so long faces become chains and
//! not dust (Rivara 1984). Each is asked at its centroid, on the side that the face's normal is on: the side from which its
//! corners run counter-clockwise. The other side is not asked.
//!
//! Vertices: the faces about a vertex are grouped into surfaces that bend by less than [`CREASE_RAD`] from face to face; each
//! group of one part of the scene is asked once, with the mean of its normals by area, so that a box has three values at a corner and a dome one. The
//! point stands a little inside the group, not on the crease, where rays would start in the seam of two walls.

use super::Point;
use crate::job::{Cancel, Cancelled};
use crate::scene::Mesh;
use crate::scene::parts::{Change, Part, moved};
use glam::{DVec3, Vec3};

/// Patches that a scene is cut into where nobody says how large they are to be.
const PATCHES: f64 = 20_000.0;

/// Area of a patch over the square of its longest permitted side, in the mean: right triangles have 1/4 at first and 1/8 after
/// a cut.
const SHARE_OF_SQUARE: f64 = 0.18;

/// Patches beyond which a mesh is not cut: 1 GB with their exposures.
const MOST_PATCHES: usize = 10_000_000;

/// Angle between the normals of two faces from which on their common vertices are asked for each apart.
pub const CREASE_RAD: f64 = 40.0 / 180.0 * std::f64::consts::PI;

/// Share of the way to the middle of its faces that a vertex's point stands inside.
const INSIDE: f64 = 0.02;

/// Why a mesh is not cut.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum PatchError {
    /// Too many would be made.
    #[error("patches of {patch_m} m are more than {most}; patches of {least_m} m would do")]
    TooMany {
        /// The longest side that was asked for, metres.
        patch_m: f32,
        /// Most patches.
        most: usize,
        /// A side with which there are fewer, metres.
        least_m: f32,
    },
    /// The caller asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// A part of a face.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Patch {
    /// Its corners, metres, counter-clockwise seen from the side that is asked.
    pub corners_m: [Vec3; 3],
    /// The triangle that it is part of.
    pub triangle: u32,
}

impl Patch {
    /// Its area, m2.
    pub fn area_m2(&self) -> f64 {
        self.twice_area_m2().length() / 2.0
    }

    /// Where it is asked.
    pub fn point(&self) -> Point {
        let [a, b, c] = self.corners_m;
        let normal = self.twice_area_m2().normalize_or(DVec3::Z).as_vec3();
        Point { position_m: (a + b + c) / 3.0, normal: Some(normal) }
    }

    fn twice_area_m2(&self) -> DVec3 {
        let [a, b, c] = self.corners_m.map(|corner_m| corner_m.as_dvec3());
        (b - a).cross(c - a)
    }
}

/// A length of patches that cuts a mesh into some 20,000, or its faces where these are more; two digits, metres. 1 m for a mesh
/// without area.
pub fn default_patch_m(mesh: &Mesh) -> f32 {
    let area_m2: f64 = faces(mesh).map(|face| face.area_m2()).sum();
    let patch_m = (area_m2 / (SHARE_OF_SQUARE * PATCHES)).sqrt();
    if patch_m <= 0.0 {
        return 1.0;
    }
    let digit = 10_f64.powf(patch_m.log10().floor() - 1.0);
    ((patch_m / digit).ceil() * digit) as f32
}

/// The faces of a mesh, none with a side longer than `patch_m`, in the order of its triangles.
///
/// # Errors
/// [`PatchError::TooMany`]; [`PatchError::Cancelled`].
pub fn patches(mesh: &Mesh, patch_m: f32, cancel: &Cancel) -> Result<Vec<Patch>, PatchError> {
    let mut patches = Vec::new();
    let mut open = Vec::new();
    for face in faces(mesh) {
        cancel.check()?;
        open.push(face);
        while let Some(patch) = open.pop() {
            if patches.len() + open.len() >= MOST_PATCHES {
                let area_m2: f64 = faces(mesh).map(|face| face.area_m2()).sum();
                let least_m = 2.0 * (area_m2 / (SHARE_OF_SQUARE * MOST_PATCHES as f64)).sqrt() as f32;
                return Err(PatchError::TooMany { patch_m, most: MOST_PATCHES, least_m: least_m.max(2.0 * patch_m) });
            }
            let [a, b, c] = patch.corners_m;
            let sides_m = [a.distance(b), b.distance(c), c.distance(a)];
            let longest = (1..3).fold(0, |longest, side| if sides_m[side] > sides_m[longest] { side } else { longest });
            // A coordinate that cannot be halved any more ends the cutting too.
            let corner = |turn: usize| patch.corners_m[(longest + turn) % 3];
            let middle_m = (corner(0) + corner(1)) / 2.0;
            if sides_m[longest] <= patch_m || middle_m == corner(0) || middle_m == corner(1) {
                patches.push(patch);
                continue;
            }
            open.push(Patch { corners_m: [middle_m, corner(1), corner(2)], ..patch });
            open.push(Patch { corners_m: [corner(0), middle_m, corner(2)], ..patch });
        }
    }
    Ok(patches)
}

fn faces(mesh: &Mesh) -> impl Iterator<Item = Patch> {
    let face = |triangle| Some(Patch { corners_m: mesh.corners_m(triangle)?, triangle: triangle as u32 });
    (0..mesh.triangles.len()).filter_map(face)
}

/// The vertices of a mesh, one for each surface that meets there.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Corners {
    /// Where each is asked: a little inside its surface.
    pub points: Vec<Point>,
    /// Where each is, metres.
    pub positions_m: Vec<Vec3>,
    /// A triangle that each belongs to.
    pub triangle_of: Vec<u32>,
    /// The corners of each triangle.
    pub triangles: Vec<[u32; 3]>,
}

/// Patches with the parts of their scene changed, and which of them are left: all but those of hidden parts. `change_of` has
/// each triangle's change.
pub fn patches_changed(patches: &[Patch], changes: &[Change], change_of: &[Option<u32>]) -> (Vec<u32>, Vec<Patch>) {
    let changed = patches.iter().zip(0..).filter_map(|(patch, number)| {
        let corners_m = place(patch.triangle, changes, change_of, patch.corners_m)?;
        Some((number, Patch { corners_m, ..*patch }))
    });
    changed.unzip()
}

/// Where points of a triangle are after changes, metres; `None` for a hidden one.
fn place<const N: usize>(
    triangle: u32,
    changes: &[Change],
    change_of: &[Option<u32>],
    points_m: [Vec3; N],
) -> Option<[Vec3; N]> {
    let change = change_of.get(triangle as usize).copied().flatten().and_then(|change| changes.get(change as usize));
    let Some(change) = change else { return Some(points_m) };
    let to = change.to?;
    Some(points_m.map(|at_m| moved(&to, at_m)))
}

impl Corners {
    /// The same with parts of the scene changed, and which of them are left: all but those of hidden parts.
    pub fn changed(&self, changes: &[Change], change_of: &[Option<u32>]) -> (Vec<u32>, Self) {
        let mut left = Vec::new();
        let mut changed = Self::default();
        let mut number_of = vec![0; self.points.len()];
        for (number, (point, &triangle)) in self.points.iter().zip(&self.triangle_of).enumerate() {
            let place = place(triangle, changes, change_of, [point.position_m, self.positions_m[number]]);
            let Some([position_m, corner_m]) = place else { continue };
            number_of[number] = left.len() as u32;
            left.push(number as u32);
            changed.points.push(Point { position_m, ..*point });
            changed.positions_m.push(corner_m);
            changed.triangle_of.push(triangle);
        }
        let stays = |triangle: &usize| place(*triangle as u32, changes, change_of, []).is_some();
        let triangles = (0..self.triangles.len()).filter(stays).map(|triangle| self.triangles[triangle]);
        changed.triangles = triangles.map(|corners| corners.map(|corner| number_of[corner as usize])).collect();
        (left, changed)
    }
}

/// The vertices of a mesh with the surfaces about them, in the order of the vertices.
///
/// # Errors
/// [`Cancelled`].
pub fn corners(mesh: &Mesh, parts: &[Part], cancel: &Cancel) -> Result<Corners, Cancelled> {
    let faces: Vec<Patch> = faces(mesh).collect();
    let normals: Vec<DVec3> = faces.iter().map(Patch::twice_area_m2).collect();
    let mut of_triangle = vec![0_usize; mesh.triangles.len()];
    for (number, part) in parts.iter().enumerate() {
        let ranges = part.triangles.iter().map(|range| range.start as usize..range.end as usize);
        for range in ranges {
            if let Some(part_of) = of_triangle.get_mut(range) {
                part_of.fill(number);
            }
        }
    }
    let part_of: Vec<usize> = faces.iter().map(|face| of_triangle[face.triangle as usize]).collect();
    let mut about: Vec<(u32, u32)> = Vec::with_capacity(3 * faces.len());
    for (face, patch) in faces.iter().enumerate() {
        let vertices = mesh.triangles.get(patch.triangle as usize).copied().unwrap_or_default();
        about.extend(vertices.map(|vertex| (vertex, face as u32)));
    }
    about.sort_unstable();

    let mut corners = Corners { triangles: vec![[0; 3]; mesh.triangles.len()], ..Corners::default() };
    for about in about.chunk_by(|a, b| a.0 == b.0) {
        cancel.check()?;
        let vertex = about[0].0;
        let Some(&at_m) = mesh.positions_m.get(vertex as usize) else { continue };
        let ids: Vec<usize> = about.iter().map(|&(_, face)| face as usize).collect();
        for surface in surfaces(&ids, &normals, &part_of) {
            let number = corners.points.len() as u32;
            corners.points.push(point_inside(at_m, &surface, &faces, &normals));
            corners.positions_m.push(at_m);
            corners.triangle_of.push(faces[surface[0]].triangle);
            for face in surface {
                let triangle = faces[face].triangle as usize;
                for (corner, &of) in corners.triangles[triangle].iter_mut().zip(&mesh.triangles[triangle]) {
                    if of == vertex {
                        *corner = number;
                    }
                }
            }
        }
    }
    Ok(corners)
}

/// Groups of the faces about a vertex that bend by less than a crease from one to another.
fn surfaces(faces: &[usize], normals: &[DVec3], part_of: &[usize]) -> Vec<Vec<usize>> {
    let least = CREASE_RAD.cos();
    let mut left = faces.to_vec();
    let mut surfaces = Vec::new();
    while !left.is_empty() {
        let mut surface = vec![left.remove(0)];
        let mut reached = 0;
        while let Some(&face) = surface.get(reached) {
            let normal = normals[face].normalize_or_zero();
            let is_near = |&other: &usize| {
                part_of[other] == part_of[face] && normals[other].normalize_or_zero().dot(normal) > least
            };
            let (near, far): (Vec<usize>, Vec<usize>) = left.into_iter().partition(is_near);
            left = far;
            surface.extend(near);
            reached += 1;
        }
        surfaces.push(surface);
    }
    surfaces
}

/// A point a little inside the faces of a surface about a vertex, above all of them.
fn point_inside(at_m: Vec3, surface: &[usize], faces: &[Patch], normals: &[DVec3]) -> Point {
    let at_m = at_m.as_dvec3();
    let normal = surface.iter().map(|&face| normals[face]).sum::<DVec3>().normalize_or(DVec3::Z);
    let middle_of = |face: usize| faces[face].corners_m.iter().map(|corner_m| corner_m.as_dvec3()).sum::<DVec3>() / 3.0;
    let middle_m = surface.iter().map(|&face| middle_of(face)).sum::<DVec3>() / surface.len() as f64;
    let inwards_m = INSIDE * (middle_m - at_m).reject_from_normalized(normal);
    // Where the surface is hollow, the way inside would lead under it.
    let under_m = surface.iter().filter_map(|&face| {
        let of_face = normals[face].normalize_or_zero();
        let upright = of_face.dot(normal);
        (upright > 0.1).then(|| -inwards_m.dot(of_face) / upright)
    });
    let lift_m = under_m.fold(0.0, f64::max);
    Point { position_m: (at_m + inwards_m + lift_m * normal).as_vec3(), normal: Some(normal.as_vec3()) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mesh(positions: &[[f32; 3]], triangles: &[[u32; 3]]) -> Mesh {
        Mesh {
            positions_m: positions.iter().copied().map(Vec3::from).collect(),
            triangles: triangles.to_vec(),
            material_of: vec![0; triangles.len()],
        }
    }

    fn cube() -> Mesh {
        let corner = |at: u32| [0, 1, 2].map(|axis| (at >> axis & 1) as f32);
        let quads = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles: Vec<[u32; 3]> = quads.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        mesh(&std::array::from_fn::<_, 8, _>(|at| corner(at as u32)), &triangles)
    }

    #[test]
    fn a_ground_of_two_triangles_becomes_patches_of_the_same_area_and_side() {
        let ground = mesh(&[[0., 0., 0.], [200., 0., 0.], [200., 100., 0.], [0., 100., 0.]], &[[0, 1, 2], [0, 2, 3]]);
        let patch_m = default_patch_m(&ground);
        let patches = patches(&ground, patch_m, &Cancel::new()).unwrap();
        assert!((10_000..40_000).contains(&patches.len()), "{} of {patch_m} m", patches.len());
        let area_m2: f64 = patches.iter().map(Patch::area_m2).sum();
        assert!((area_m2 - 20_000.0).abs() < 0.1, "{area_m2}");
        for patch in &patches {
            let [a, b, c] = patch.corners_m;
            assert!(a.distance(b).max(b.distance(c)).max(c.distance(a)) <= patch_m);
            assert_eq!(patch.point().normal, Some(Vec3::Z));
        }
        assert!(patches.windows(2).all(|pair| pair[0].triangle <= pair[1].triangle));
    }

    #[test]
    fn small_faces_stay_whole_and_dust_is_refused() {
        let cube = cube();
        assert_eq!(patches(&cube, 2.0, &Cancel::new()).unwrap().len(), 12);
        let refused = patches(&cube, 1e-5, &Cancel::new()).unwrap_err().to_string();
        assert!(refused.contains("more than 10000000; patches of 0.00"), "{refused}");
        let cancel = Cancel::new();
        cancel.cancel();
        assert_eq!(patches(&cube, 2.0, &cancel), Err(PatchError::Cancelled(Cancelled)));
        assert_eq!(default_patch_m(&Mesh::default()), 1.0);
    }

    #[test]
    fn a_cube_has_three_values_at_each_corner_and_each_point_stands_on_its_face() {
        let cube = cube();
        let corners = corners(&cube, &[], &Cancel::new()).unwrap();
        assert_eq!(corners.points.len(), 24);
        for (triangle, vertices) in corners.triangles.iter().enumerate() {
            let [a, b, c] = cube.corners_m(triangle).unwrap();
            let normal = (b - a).cross(c - a).normalize();
            for (&corner, at_m) in vertices.iter().zip([a, b, c]) {
                let point = corners.points[corner as usize];
                assert_eq!((point.normal, corners.positions_m[corner as usize]), (Some(normal), at_m));
                let moved_m = point.position_m - at_m;
                assert!(moved_m.dot(normal).abs() < 1e-6 && (0.005..0.03).contains(&moved_m.length()), "{moved_m}");
                // Inwards: nearer to the middle of the cube's face.
                assert!(moved_m.dot(Vec3::splat(0.5) - at_m) > 0.0);
            }
        }
    }

    #[test]
    fn a_gentle_ridge_is_one_surface_and_a_hollow_is_not_dived_into() {
        for height in [-0.2_f32, 0.2] {
            let positions = [[0., 0., 0.], [1., 0., height], [0., 1., height], [-1., 0., height], [0., -1., height]];
            let tent = mesh(&positions, &[[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 1]]);
            let corners = corners(&tent, &[], &Cancel::new()).unwrap();
            assert_eq!(corners.points.len(), 5);
            for (point, at_m) in corners.points.iter().zip(&corners.positions_m) {
                for face in faces(&tent).filter(|face| face.corners_m.contains(at_m)) {
                    let above_m = (point.position_m - *at_m).dot(face.point().normal.unwrap());
                    assert!(above_m > -1e-6, "{height}: {above_m}");
                }
            }
        }
    }
}
