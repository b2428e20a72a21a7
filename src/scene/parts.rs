//! Which parts does a scene's mesh have, and what is it like with some of them moved, scaled or hidden?
//!
//! Parts are the objects or groups of an OBJ file, the nodes of a glTF file, and otherwise whole files. An edit names one, or
//! with a trailing `*` all whose names begin so. Each is scaled about the middle of the base of all that the edit names, so
//! that what stands on the ground still does, and then moved; all edits of a part count, hiding last.
//!
//! Limits: where faces of two parts lie in one place, loading kept one of them ([`Part::keeps_for_others`]), and it goes where
//! its own part goes.

use super::{Mesh, Scene};
use glam::{DAffine3, DVec3, Vec3};
use std::ops::Range;

/// Farthest that a part is moved along an axis, metres.
pub const FARTHEST_MOVE_M: f64 = 1e6;

/// Smallest and largest factor by which a part is scaled.
pub const SCALES: [f64; 2] = [1e-3, 1e3];

/// Most names that an error lists.
const LISTED: usize = 20;

/// A named part of the mesh.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Part {
    /// Its name; with the file's before it where a scene has several meshes.
    pub name: String,
    /// Its triangles, as ranges of their numbers.
    pub triangles: Vec<Range<u32>>,
    /// How many faces it keeps for other parts too, which had one in the same place.
    pub keeps_for_others: usize,
}

impl Part {
    /// Parts by their names, from the number of each triangle's part, and for each face that was left out for one of another
    /// part the number of that one.
    pub(super) fn of_triangles(names: Vec<String>, part_of: &[u32], kept_by: &[u32]) -> Vec<Self> {
        let mut parts: Vec<Self> = names.into_iter().map(|name| Self { name, ..Self::default() }).collect();
        let mut first = 0;
        for same in part_of.chunk_by(|a, b| a == b) {
            let end = first + same.len() as u32;
            if let Some(part) = parts.get_mut(same[0] as usize) {
                part.triangles.push(first..end);
            }
            first = end;
        }
        for &part in kept_by {
            if let Some(part) = parts.get_mut(part as usize) {
                part.keeps_for_others += 1;
            }
        }
        parts
    }
}

/// What is done to a part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Edit {
    /// Made so many times as large.
    Scale(f64),
    /// Moved, metres.
    Move(DVec3),
    /// Taken away.
    Hide,
}

/// What becomes of a part by all its edits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Change {
    /// Its number in [`Scene::parts`].
    pub part: usize,
    /// Where its points go; `None` where it is hidden.
    pub to: Option<DAffine3>,
}

/// Edits that cannot be.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum EditError {
    /// No part is called so.
    #[error("no part is called {name:?}; there {known}")]
    UnknownPart {
        /// The name.
        name: String,
        /// What there is, as the end of the sentence.
        known: String,
    },
    /// Moved too far, or not by a number.
    #[error("{name}: moved by {by_m} m, which is outside -1e6 to 1e6")]
    Move {
        /// The part's name.
        name: String,
        /// How far along one axis.
        by_m: f64,
    },
    /// Scaled too much or too little.
    #[error("{name}: scaled by {by}, which is outside 0.001 to 1000")]
    Scale {
        /// The part's name.
        name: String,
        /// The factor.
        by: f64,
    },
}

impl Scene {
    /// What becomes of the parts by edits, each for a part's name; changed parts in their order.
    ///
    /// # Errors
    /// [`EditError`] for names that no part has and for edits out of bounds.
    pub fn changes(&self, edits: &[(String, Edit)]) -> Result<Vec<Change>, EditError> {
        let mut to: Vec<Option<Option<DAffine3>>> = vec![None; self.parts.len()];
        let order = |edit: &Edit| match edit {
            Edit::Scale(_) => 0,
            Edit::Move(_) => 1,
            Edit::Hide => 2,
        };
        let mut edits: Vec<&(String, Edit)> = edits.iter().collect();
        edits.sort_by_key(|(_, edit)| order(edit));
        for (name, edit) in edits {
            let parts = self.parts_called(name)?;
            let by = self.affine(name, edit, &parts)?;
            for part in parts {
                let before = to[part].unwrap_or(Some(DAffine3::IDENTITY));
                to[part] = Some(before.zip(by).map(|(before, by)| by * before));
            }
        }
        Ok(to.into_iter().enumerate().filter_map(|(part, to)| Some(Change { part, to: to? })).collect())
    }

    /// The numbers of the parts that a name, or the beginning of one with a `*` after it, means.
    fn parts_called(&self, name: &str) -> Result<Vec<usize>, EditError> {
        let is_meant = |part: &Part| match name.strip_suffix('*') {
            Some(start) => part.name.starts_with(start),
            None => part.name == name,
        };
        let meant: Vec<usize> = (0..self.parts.len()).filter(|&part| is_meant(&self.parts[part])).collect();
        if !meant.is_empty() {
            return Ok(meant);
        }
        let names: Vec<&str> = self.parts.iter().map(|part| part.name.as_str()).take(LISTED).collect();
        let more = self.parts.len().saturating_sub(LISTED);
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        let verb = if self.parts.len() == 1 { "is" } else { "are" };
        Err(EditError::UnknownPart { name: name.to_owned(), known: format!("{verb} {}{more}", names.join(", ")) })
    }

    /// What an edit does to points of those parts; `None` for hiding them.
    fn affine(&self, name: &str, edit: &Edit, parts: &[usize]) -> Result<Option<DAffine3>, EditError> {
        match *edit {
            Edit::Hide => Ok(None),
            Edit::Move(by_m) => {
                let outside = |metres: &f64| !(-FARTHEST_MOVE_M..=FARTHEST_MOVE_M).contains(metres);
                match by_m.to_array().into_iter().find(outside) {
                    Some(by_m) => Err(EditError::Move { name: name.to_owned(), by_m }),
                    None => Ok(Some(DAffine3::from_translation(by_m))),
                }
            }
            Edit::Scale(by) if !(SCALES[0]..=SCALES[1]).contains(&by) => {
                Err(EditError::Scale { name: name.to_owned(), by })
            }
            Edit::Scale(by) => {
                let corners = parts.iter().flat_map(|&part| self.corners_of(part));
                let bounds = corners.fold(None, |bounds: Option<(Vec3, Vec3)>, at_m| {
                    Some(bounds.map_or((at_m, at_m), |(low, high)| (low.min(at_m), high.max(at_m))))
                });
                let (low, high) = bounds.unwrap_or_default();
                let base_m = ((low + high) / 2.0).with_z(low.z).as_dvec3();
                let about = DAffine3::from_translation(base_m);
                Ok(Some(about * DAffine3::from_scale(DVec3::splat(by)) * about.inverse()))
            }
        }
    }

    /// The triangles of a part.
    pub fn triangles_of(&self, part: usize) -> impl Iterator<Item = usize> {
        let ranges = self.parts.get(part).map_or(&[][..], |part| &part.triangles);
        ranges.iter().flat_map(|range| range.start as usize..range.end as usize)
    }

    /// The corners of all triangles of a part, metres.
    pub fn corners_of(&self, part: usize) -> impl Iterator<Item = Vec3> {
        self.triangles_of(part).filter_map(|triangle| self.mesh.corners_m(triangle)).flatten()
    }

    /// For each triangle the place in `changes` of what becomes of it.
    pub fn change_of_triangles(&self, changes: &[Change]) -> Vec<Option<u32>> {
        let mut of = vec![None; self.mesh.triangles.len()];
        for (number, change) in changes.iter().enumerate() {
            for triangle in self.triangles_of(change.part) {
                if let Some(of) = of.get_mut(triangle) {
                    *of = Some(number as u32);
                }
            }
        }
        of
    }

    /// The scene with its parts changed: faces of hidden parts are gone, and each face has vertices of its own.
    pub fn changed(&self, changes: &[Change]) -> Self {
        let change_of = self.change_of_triangles(changes);
        let (mut mesh, mut part_of) = (Mesh::default(), Vec::new());
        let mut own_part = vec![0; self.mesh.triangles.len()];
        for part in 0..self.parts.len() {
            self.triangles_of(part).for_each(|triangle| own_part[triangle] = part as u32);
        }
        for (triangle, change) in change_of.iter().enumerate() {
            let change = change.and_then(|change| changes.get(change as usize));
            let Some(corners_m) = self.mesh.corners_m(triangle) else { continue };
            let moved_m = match change {
                None => corners_m,
                Some(Change { to: Some(to), .. }) => corners_m.map(|at_m| moved(to, at_m)),
                Some(Change { to: None, .. }) => continue,
            };
            let first = mesh.positions_m.len() as u32;
            mesh.positions_m.extend(moved_m);
            mesh.triangles.push([first, first + 1, first + 2]);
            mesh.material_of.push(self.mesh.material_of.get(triangle).copied().unwrap_or_default());
            part_of.push(own_part[triangle]);
        }
        let names = self.parts.iter().map(|part| part.name.clone()).collect();
        Self { mesh, parts: Part::of_triangles(names, &part_of, &[]), ..self.clone() }
    }
}

/// Where a point goes, metres: the one place that says, so that all who ask get the same bits.
pub fn moved(to: &DAffine3, at_m: Vec3) -> Vec3 {
    to.transform_point3(at_m.as_dvec3()).as_vec3()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two squares side by side, at z = 0 and up from z = 2.
    fn two() -> Scene {
        let floor = [(0., 0., 0.), (2., 0., 0.), (2., 2., 0.), (0., 2., 0.)];
        let wall = [(5., 0., 2.), (7., 0., 2.), (7., 0., 4.), (5., 0., 4.)];
        let mesh = Mesh {
            positions_m: floor.into_iter().chain(wall).map(Vec3::from).collect(),
            triangles: vec![[0, 1, 2], [4, 5, 6], [0, 2, 3], [4, 6, 7]],
            material_of: vec![0; 4],
        };
        let names = vec!["floor".to_owned(), "wall_a".to_owned()];
        Scene { mesh, parts: Part::of_triangles(names, &[0, 1, 0, 1], &[1]), ..Scene::default() }
    }

    fn edited(edits: &[(&str, Edit)]) -> Result<Scene, EditError> {
        let edits: Vec<(String, Edit)> = edits.iter().map(|&(name, edit)| (name.to_owned(), edit)).collect();
        let scene = two();
        Ok(scene.changed(&scene.changes(&edits)?))
    }

    #[test]
    fn parts_are_ranges_and_know_what_they_keep_for_others() {
        let scene = two();
        assert_eq!(scene.parts[0].triangles, [0..1, 2..3]);
        assert_eq!(scene.parts.iter().map(|part| part.keeps_for_others).collect::<Vec<_>>(), [0, 1]);
        assert_eq!(scene.triangles_of(1).collect::<Vec<_>>(), [1, 3]);
    }

    #[test]
    fn parts_are_scaled_about_their_base_then_moved_then_hidden() {
        let bounds = |part, edits: &[(&str, Edit)]| {
            let scene = edited(edits).unwrap();
            scene.corners_of(part).fold(None, |bounds: Option<(Vec3, Vec3)>, at| {
                Some(bounds.map_or((at, at), |(low, high)| (low.min(at), high.max(at))))
            })
        };
        let moved = Edit::Move(DVec3::new(0.0, 0.0, -1.0));
        let twice = [("wall*", moved), ("wall_a", Edit::Scale(2.0))];
        assert_eq!(bounds(1, &twice), Some((Vec3::new(4.0, 0.0, 1.0), Vec3::new(8.0, 0.0, 5.0))));
        assert_eq!(bounds(0, &twice), Some((Vec3::ZERO, Vec3::new(2.0, 2.0, 0.0))));
        assert_eq!(bounds(1, &[("wall_a", Edit::Hide), ("wall_a", moved)]), None);
        assert_eq!(edited(&[("*", Edit::Hide)]).unwrap().mesh.triangles.len(), 0);
    }

    #[test]
    fn wrong_edits_say_what_there_is_and_the_bound() {
        #[track_caller]
        fn fails(name: &str, edit: Edit, want: &str) {
            assert_eq!(edited(&[(name, edit)]).unwrap_err().to_string(), want);
        }
        fails("roof", Edit::Hide, "no part is called \"roof\"; there are floor, wall_a");
        fails("roof*", Edit::Hide, "no part is called \"roof*\"; there are floor, wall_a");
        fails("floor", Edit::Scale(0.0), "floor: scaled by 0, which is outside 0.001 to 1000");
        fails("floor", Edit::Move(DVec3::X * 1e7), "floor: moved by 10000000 m, which is outside -1e6 to 1e6");
    }
}
