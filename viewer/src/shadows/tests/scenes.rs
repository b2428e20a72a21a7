//! Scenes of boxes, and what rays say of them.

use super::super::{Lit, View};
use crate::camera::Camera;
use glam::{Vec2, Vec3};

/// Boxes on a ground, seen from somewhere.
pub struct Town {
    pub boxes_m: Vec<(Vec3, Vec3)>,
    pub view: View,
}

/// Share of wrong pixels, and mean share of the sun deep in shadows and missing deep in the light.
#[derive(Clone, Copy, Debug)]
pub struct Wrong {
    pub share: f64,
    pub bleeding: f64,
    pub acne: f64,
}

impl Town {
    /// One block of 10 m on a ground of 100 m.
    pub fn block_on_ground() -> Self {
        let camera = Camera {
            target_m: Vec3::new(0.0, 0.0, 3.0),
            azimuth_rad: -1.2,
            elevation_rad: 0.4,
            distance_m: 50.0,
            field_of_view_rad: 0.7,
            orthographic: false,
        };
        let towards_sun = Vec3::new(-0.6, -0.3, 0.7).normalize();
        let ground = (Vec3::new(-50.0, -50.0, -1.0), Vec3::new(50.0, 50.0, 0.0));
        let block = (Vec3::new(-5.0, -5.0, 0.0), Vec3::new(5.0, 5.0, 10.0));
        Self { boxes_m: vec![ground, block], view: View { camera, size_px: [320, 240], towards_sun } }
    }

    /// A low screen under a high roof's edge over the ground: the roof's rim, the screen's rim and the ground mix in a texel.
    pub fn three_occluders() -> Self {
        let mut town = Self::block_on_ground();
        let slab = |x_m: f32, z_m: f32| (Vec3::new(x_m, -12.0, z_m), Vec3::new(x_m + 16.0, 12.0, z_m + 0.2));
        town.boxes_m = vec![town.boxes_m[0], slab(-8.0, 2.0), slab(-4.0, 8.0), slab(0.0, 25.0)];
        town.view.camera.target_m = Vec3::new(0.0, 0.0, 4.0);
        town.view.camera.elevation_rad = 0.25;
        town.view.towards_sun = Vec3::new(-0.1, -0.15, 0.98).normalize();
        town
    }

    /// A wall of 300 m seen along, whose shadow crosses all layers.
    pub fn long_wall() -> Self {
        let camera = Camera {
            target_m: Vec3::new(10.0, 0.0, 2.0),
            azimuth_rad: -std::f32::consts::FRAC_PI_2,
            elevation_rad: 0.1,
            distance_m: 20.0,
            field_of_view_rad: 0.7,
            orthographic: false,
        };
        let ground = (Vec3::new(-50.0, -30.0, -1.0), Vec3::new(50.0, 320.0, 0.0));
        let wall = (Vec3::new(-1.0, -25.0, 0.0), Vec3::new(1.0, 300.0, 12.0));
        let towards_sun = Vec3::new(-0.6, 0.2, 0.7).normalize();
        Self { boxes_m: vec![ground, wall], view: View { camera, size_px: [320, 240], towards_sun } }
    }

    /// Columns under a roof, seen from between them.
    pub fn arcade() -> Self {
        let mut town = Self::long_wall();
        let column = |at: i32| {
            let y_m = 4.0 * at as f32;
            (Vec3::new(-0.4, y_m, 0.0), Vec3::new(0.4, y_m + 0.8, 5.0))
        };
        let roof = (Vec3::new(-0.4, -10.0, 5.0), Vec3::new(6.0, 90.0, 5.5));
        let back = (Vec3::new(6.0, -10.0, 0.0), Vec3::new(6.5, 90.0, 5.5));
        town.boxes_m = vec![town.boxes_m[0], roof, back];
        town.boxes_m.extend((-2..22).map(column));
        town.view.camera.target_m = Vec3::new(3.0, 5.0, 1.7);
        town.view.camera.elevation_rad = 0.0;
        town.view.camera.distance_m = 5.0;
        town.view.towards_sun = Vec3::new(-0.8, -0.2, 0.4).normalize();
        town
    }

    /// Its triangles.
    pub fn corners_m(&self) -> Vec<Vec3> {
        self.boxes_m.iter().flat_map(|bounds| sides(*bounds)).flatten().collect()
    }

    /// Nearest hit of a ray with the boxes, and the normal there.
    fn hit(&self, origin_m: Vec3, direction: Vec3) -> Option<(f32, Vec3)> {
        let hits = self.boxes_m.iter().filter_map(|(low_m, high_m)| {
            let [a, b] = [(*low_m - origin_m) / direction, (*high_m - origin_m) / direction];
            let (near, far) = (a.min(b), a.max(b));
            let (enters, leaves) = (near.max_element(), far.min_element());
            let axis = near.to_array().iter().position(|at| *at == enters).unwrap_or(0);
            let normal = -Vec3::AXES[axis] * direction[axis].signum();
            (enters > 0.0 && enters < leaves).then_some((enters, normal))
        });
        hits.min_by(|a, b| a.0.total_cmp(&b.0))
    }

    /// Whether the sun reaches what each pixel shows; none where nothing is shown or it faces away.
    pub fn truth(&self) -> Vec<Option<bool>> {
        let [width, height] = self.view.size_px;
        let size_px = Vec2::new(width as f32, height as f32);
        let pixels = (0..height).flat_map(|row| (0..width).map(move |column| (column, row)));
        let truth = |(column, row): (u32, u32)| {
            let px = Vec2::new(column as f32 + 0.5, row as f32 + 0.5);
            let (origin_m, direction) = self.view.camera.ray(px, size_px);
            let (along_m, normal) = self.hit(origin_m, direction)?;
            let at_m = origin_m + direction * along_m + normal * 1e-3;
            (normal.dot(self.view.towards_sun) > 0.0).then(|| self.hit(at_m, self.view.towards_sun).is_none())
        };
        pixels.map(truth).collect()
    }
}

/// Compares a frame with rays.
pub fn wrong(town: &Town, lit: &[Option<Lit>]) -> Wrong {
    let truth = town.truth();
    let [width, height] = town.view.size_px.map(|side| side as usize);
    let both = || truth.iter().zip(lit).filter_map(|(truth, lit)| Some(((*truth)?, (*lit)?.share)));
    let count = both().count().max(1) as f64;
    let share = both().filter(|(truth, share)| *truth != (*share > 0.5)).count() as f64 / count;
    // Deep: all within three pixels say the same.
    let deep = |is_lit: bool| {
        let (mut sum, mut number) = (0.0, 0);
        for row in 3..height - 3 {
            for column in 3..width - 3 {
                let alike = (row - 3..=row + 3)
                    .all(|y| (column - 3..=column + 3).all(|x| truth[y * width + x] == Some(is_lit)));
                if let (true, Some(lit)) = (alike, lit[row * width + column]) {
                    sum += f64::from(lit.share - f32::from(u8::from(is_lit))).abs();
                    number += 1;
                }
            }
        }
        sum / f64::from(number.max(1))
    };
    Wrong { share, bleeding: deep(false), acne: deep(true) }
}

/// The twelve triangles of a box.
fn sides((low_m, high_m): (Vec3, Vec3)) -> Vec<[Vec3; 3]> {
    let corner = |bits: usize| {
        low_m + (high_m - low_m) * Vec3::new((bits & 1) as f32, (bits >> 1 & 1) as f32, (bits >> 2 & 1) as f32)
    };
    let faces = [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];
    faces.iter().flat_map(|[a, b, c, d]| [[*a, *b, *c], [*a, *c, *d]]).map(|face| face.map(corner)).collect()
}
