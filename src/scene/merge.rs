//! How do meshes of several files become the one mesh that is voxelised and traced?
//!
//! In double precision to metres, Z up, and around a whole-metre origin near the middle; then to `f32`. Vertices at the
//! same place become one. Left out and counted are faces without an area and faces that lie exactly on another one: of
//! those, one stays, an opaque one before glazing, the first before later ones. Where any of them emits, the emitting
//! ones stay, one for each winding, as each winding emits to its own side.

use super::error::{Kind, SceneError};
use super::input::{FARTHEST_M, counted};
use super::{Material, Mesh};
use crate::job::Cancel;
use glam::{DVec3, Vec3};
use rayon::prelude::*;
use std::path::{Path, PathBuf};

/// A triangle whose height is below this share of its longest side has no usable normal in `f32`: it has no area.
const FLATTEST: f64 = 1e-9;

/// Extent from which rounding to `f32` moves vertices by half a millimetre or more, metres.
const WIDE_M: f32 = 16_384.0;

/// Triangles of one file, on their way into the scene.
pub struct OfFile {
    /// The file, for errors and warnings.
    pub path: PathBuf,
    /// Vertices, metres, Z up, in the user's coordinates.
    pub positions_m: Vec<DVec3>,
    /// Vertex numbers within the part.
    pub triangles: Vec<[u32; 3]>,
    /// Material of each triangle in the scene.
    pub material_of: Vec<u32>,
    /// Number in the scene of the named part that each triangle belongs to.
    pub part_of: Vec<u32>,
    /// Faces that were left out before for having too few corners.
    pub too_few_corners: usize,
}

/// The mesh of all files.
#[derive(Debug)]
pub struct Merged {
    /// The mesh, around its origin.
    pub mesh: Mesh,
    /// The origin in the user's coordinates, metres.
    pub origin_m: DVec3,
    /// Part of each of its triangles.
    pub part_of: Vec<u32>,
    /// For each face that was left out because one of another part lies in the same place: the part that kept it.
    pub kept_by: Vec<u32>,
    /// What was left out, a sentence each.
    pub warnings: Vec<String>,
}

/// The merged mesh.
///
/// # Errors
/// [`Kind::Outside`] for a vertex beyond [`FARTHEST_M`], [`Kind::TooMany`] vertices, [`Kind::EmptyMesh`] (placed at
/// `scene`) if no face is left, [`Kind::Cancelled`].
pub fn merge(scene: &Path, parts: Vec<OfFile>, materials: &[Material], cancel: &Cancel) -> Result<Merged, SceneError> {
    let go_on = || cancel.check().map_err(|_| SceneError::new(scene, None, Kind::Cancelled));
    let mut warnings = Vec::new();
    let origin_m = origin_of(&parts)?.ok_or_else(|| SceneError::new(scene, None, Kind::EmptyMesh))?;

    let count: usize = parts.iter().map(|part| part.positions_m.len()).sum();
    if u32::try_from(count).is_err() {
        let kind = Kind::TooMany { what: "vertices", count: count as u64, most: u32::MAX.into() };
        return Err(SceneError::new(scene, None, kind));
    }
    let mut mesh = Mesh::default();
    let (mut labels, mut part_of) = (Vec::new(), Vec::new());
    for part in parts {
        let first = mesh.positions_m.len() as u32;
        // Adding zero turns -0 into 0, so that equal coordinates have equal bits.
        mesh.positions_m.extend(part.positions_m.iter().map(|&p| (p - origin_m).as_vec3() + Vec3::ZERO));
        mesh.triangles.extend(part.triangles.iter().map(|triangle| triangle.map(|vertex| vertex + first)));
        mesh.material_of.extend_from_slice(&part.material_of);
        part_of.extend_from_slice(&part.part_of);
        labels.push((part.path.clone(), mesh.triangles.len(), part.too_few_corners));
    }
    go_on()?;
    weld(&mut mesh);
    go_on()?;

    let (fates, instead) = fates(&mesh, materials);
    let part = |triangle: usize| part_of.get(triangle).copied().unwrap_or_default();
    let elsewhere = instead.into_iter().filter(|&[kept, left_out]| part(kept) != part(left_out));
    let kept_by = elsewhere.map(|[kept, _]| part(kept)).collect();
    go_on()?;
    let mut first = 0;
    for (path, end, too_few_corners) in labels {
        let part = fates.get(first..end).unwrap_or_default();
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let degenerate = too_few_corners + part.iter().filter(|&&fate| fate == Fate::Degenerate).count();
        let duplicate = part.iter().filter(|&&fate| fate == Fate::Duplicate).count();
        if degenerate > 0 {
            warnings.push(format!("{name}: {} left out", counted(degenerate, "degenerate face")));
        }
        if duplicate > 0 {
            warnings.push(format!("{name}: {} left out", counted(duplicate, "duplicate face")));
        }
        first = end;
    }
    keep(&mut mesh, &mut part_of, &fates);

    let Some((low, high)) = mesh.bounds_m() else {
        return Err(SceneError::new(scene, None, Kind::EmptyMesh));
    };
    let widest_m = (high - low).max_element();
    if widest_m > WIDE_M {
        let error_mm = 1e3 * 0.25 * f64::from(widest_m) * f64::from(f32::EPSILON);
        warnings.push(format!("the mesh is {:.0} km wide: its vertices are held to {error_mm:.1} mm", widest_m / 1e3));
    }
    Ok(Merged { mesh, origin_m, part_of, kept_by, warnings })
}

/// The whole metres nearest to the middle of the box around all faces; `None` without faces.
fn origin_of(parts: &[OfFile]) -> Result<Option<DVec3>, SceneError> {
    let mut bounds: Option<(DVec3, DVec3)> = None;
    for part in parts {
        for &vertex in part.triangles.iter().flatten() {
            let Some(&p) = part.positions_m.get(vertex as usize) else { continue };
            if !p.is_finite() || p.abs().max_element() > FARTHEST_M {
                let value =
                    p.to_array().into_iter().find(|c| !c.is_finite() || c.abs() > FARTHEST_M).unwrap_or(f64::NAN);
                let what = format!("coordinate of vertex {}", vertex + 1);
                return Err(SceneError::new(&part.path, None, Kind::Outside { what, value, bound: "-1e8 to 1e8 m" }));
            }
            bounds = Some(bounds.map_or((p, p), |(low, high)| (low.min(p), high.max(p))));
        }
    }
    Ok(bounds.map(|(low, high)| (0.5 * (low + high)).round() + DVec3::ZERO))
}

/// Gives vertices at the same place the same number, the lowest of them.
fn weld(mesh: &mut Mesh) {
    let bits = |p: &Vec3| p.to_array().map(f32::to_bits);
    let mut order: Vec<([u32; 3], u32)> = mesh.positions_m.iter().map(bits).zip(0..).collect();
    order.par_sort_unstable();
    let mut lowest: Vec<u32> = (0..mesh.positions_m.len() as u32).collect();
    for same in order.chunk_by(|a, b| a.0 == b.0) {
        for &(_, vertex) in same {
            lowest[vertex as usize] = same[0].1;
        }
    }
    mesh.triangles.par_iter_mut().for_each(|triangle| *triangle = triangle.map(|vertex| lowest[vertex as usize]));
}

/// What becomes of a triangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Fate {
    Kept,
    Degenerate,
    Duplicate,
}

/// What becomes of each triangle, and for each duplicate the one that stays in its place, before it.
fn fates(mesh: &Mesh, materials: &[Material]) -> (Vec<Fate>, Vec<[usize; 2]>) {
    let degenerate = |triangle: usize| {
        let Some([a, b, c]) = mesh.corners_m(triangle) else { return true };
        let [a, b, c] = [a, b, c].map(Vec3::as_dvec3);
        let longest = (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
        (b - a).cross(c - a).length() <= FLATTEST * longest
    };
    let fate = |triangle| if degenerate(triangle) { Fate::Degenerate } else { Fate::Kept };
    let mut fates: Vec<Fate> = (0..mesh.triangles.len()).into_par_iter().map(fate).collect();

    let sorted = |triangle: &[u32; 3]| {
        let mut corners = *triangle;
        corners.sort_unstable();
        corners
    };
    let mut order: Vec<([u32; 3], u32)> = mesh.triangles.iter().map(sorted).zip(0..).collect();
    order.par_sort_unstable();
    let mut instead = Vec::new();
    for same in order.chunk_by(|a, b| a.0 == b.0).filter(|same| same.len() > 1) {
        let alike: Vec<usize> = same.iter().map(|&(_, triangle)| triangle as usize).collect();
        let kept = stays(&alike, mesh, materials);
        for triangle in alike {
            if fates[triangle] == Fate::Kept && !kept.contains(&triangle) {
                fates[triangle] = Fate::Duplicate;
                instead.extend(kept.first().map(|&kept| [kept, triangle]));
            }
        }
    }
    (fates, instead)
}

/// Which of several triangles with the same corners stay; ascending numbers in, one or two out.
fn stays(alike: &[usize], mesh: &Mesh, materials: &[Material]) -> Vec<usize> {
    let material = |triangle: usize| {
        let number = mesh.material_of.get(triangle).copied().unwrap_or_default();
        materials.get(number as usize)
    };
    let emits = |&triangle: &usize| material(triangle).is_some_and(|material| material.emission_w_m2_sr > 0.0);
    let opaque = |&triangle: &usize| material(triangle).is_none_or(|material| material.transmittance == 0.0);
    let turned = |&triangle: &usize| {
        let [a, b, c] = mesh.triangles[triangle];
        (a < b) ^ (b < c) ^ (c < a)
    };
    let emitting =
        |winding: bool| alike.iter().copied().find(|triangle| emits(triangle) && turned(triangle) == winding);
    let stays: Vec<usize> = [false, true].into_iter().filter_map(emitting).collect();
    if !stays.is_empty() {
        return stays;
    }
    alike.iter().copied().find(opaque).or(alike.first().copied()).into_iter().collect()
}

/// Leaves out all triangles that are not kept, and then all vertices that none uses.
fn keep(mesh: &mut Mesh, part_of: &mut Vec<u32>, fates: &[Fate]) {
    let kept = |&(_, &fate): &(usize, &Fate)| fate == Fate::Kept;
    let numbers: Vec<usize> = fates.iter().enumerate().filter(kept).map(|(number, _)| number).collect();
    mesh.triangles = numbers.iter().map(|&number| mesh.triangles[number]).collect();
    mesh.material_of = numbers.iter().map(|&number| mesh.material_of[number]).collect();
    *part_of = numbers.iter().map(|&number| part_of[number]).collect();

    let mut renumbered = vec![0_u32; mesh.positions_m.len()];
    for &vertex in mesh.triangles.iter().flatten() {
        renumbered[vertex as usize] = 1;
    }
    let mut count = 0;
    for (vertex, number) in renumbered.iter_mut().enumerate() {
        if *number == 1 {
            mesh.positions_m[count as usize] = mesh.positions_m[vertex];
            *number = count;
            count += 1;
        }
    }
    mesh.positions_m.truncate(count as usize);
    mesh.positions_m.shrink_to_fit();
    mesh.triangles.iter_mut().for_each(|triangle| *triangle = triangle.map(|vertex| renumbered[vertex as usize]));
}

#[cfg(test)]
mod tests {
    use super::*;

    fn part(positions: &[[f64; 3]], triangles: &[[u32; 3]], material_of: &[u32]) -> OfFile {
        OfFile {
            path: PathBuf::from("a.obj"),
            positions_m: positions.iter().copied().map(DVec3::from_array).collect(),
            triangles: triangles.to_vec(),
            material_of: material_of.to_vec(),
            part_of: (0..triangles.len() as u32).collect(),
            too_few_corners: 0,
        }
    }

    fn material(emission_w_m2_sr: f32, transmittance: f32) -> Material {
        Material { name: String::new(), reflectance: 0.5, transmittance, emission_w_m2_sr }
    }

    fn merged(part: OfFile) -> Result<Merged, SceneError> {
        let materials = [material(0.0, 0.0), material(0.0, 0.7), material(5.0, 0.0)];
        merge(Path::new("a.toml"), vec![part], &materials, &Cancel::new())
    }

    const CITY: [[f64; 3]; 4] = [
        [678_097.1, 5_403_593.2, 413.0],
        [678_098.1, 5_403_593.2, 413.0],
        [678_097.1, 5_403_594.2, 413.0],
        [9e30, 0.0, 0.0],
    ];

    #[test]
    fn city_coordinates_keep_their_millimetres() {
        let Merged { mesh, origin_m, .. } = merged(part(&CITY, &[[0, 1, 2]], &[0])).unwrap();
        assert_eq!(origin_m, DVec3::new(678_098.0, 5_403_594.0, 413.0));
        assert_eq!(mesh.positions_m.len(), 3);
        for (position, want) in mesh.positions_m.iter().zip(CITY) {
            assert!((position.as_dvec3() + origin_m - DVec3::from_array(want)).length() < 1e-6);
        }
        assert!(
            merged(part(&CITY, &[[0, 1, 3]], &[0])).unwrap_err().to_string().contains("a.obj: coordinate of vertex 4")
        );
    }

    #[test]
    fn duplicates_and_degenerates_are_left_out_and_counted() {
        let corners = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0., 1., 0.], [2., 0., 0.]];
        let triangles = [[0, 1, 2], [1, 3, 0], [0, 2, 1], [0, 1, 1], [0, 1, 4]];
        let Merged { mesh, warnings, part_of, kept_by, .. } = merged(part(&corners, &triangles, &[0; 5])).unwrap();
        assert_eq!(mesh.triangles, [[0, 1, 2]]);
        // Every triangle was a part of its own: the first kept its place for two others.
        assert_eq!((part_of.as_slice(), kept_by.as_slice()), (&[0][..], &[0, 0][..]));
        assert_eq!(warnings, ["a.obj: 2 degenerate faces left out", "a.obj: 2 duplicate faces left out"]);
    }

    #[test]
    fn of_coinciding_faces_emitters_stay_one_a_winding_then_what_is_opaque() {
        let corners = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]];
        let kept = |triangles: &[[u32; 3]], material_of: &[u32]| {
            let Merged { mesh, .. } = merged(part(&corners, triangles, material_of)).unwrap();
            mesh.triangles.into_iter().zip(mesh.material_of).collect::<Vec<_>>()
        };
        assert_eq!(kept(&[[0, 1, 2], [1, 2, 0]], &[1, 0]), [([1, 2, 0], 0)]);
        assert_eq!(kept(&[[0, 1, 2], [0, 2, 1], [2, 0, 1]], &[2, 2, 2]), [([0, 1, 2], 2), ([0, 2, 1], 2)]);
        assert_eq!(kept(&[[0, 1, 2], [0, 2, 1]], &[0, 2]), [([0, 2, 1], 2)]);
    }

    #[test]
    fn nothing_left_is_an_error() {
        let error = merged(part(&[[0.0; 3]], &[[0, 0, 0]], &[0])).unwrap_err();
        assert_eq!(error.to_string(), "a.toml: no face with an area: the mesh is empty");
    }
}
