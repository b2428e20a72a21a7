//! What does a map cover: the part of the scene that a slice of the camera's frustum holds, boxed in light space.

use super::super::View;
use crate::camera::Camera;
use glam::{Mat4, Vec2, Vec3, Vec4};

/// Texels that a map is wider than what it covers, on each side: what its filters reach beyond.
const BORDER_TEXELS: f32 = 3.0;

/// Axes of light space: across the rays, and along them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Basis {
    right: Vec3,
    up: Vec3,
    along: Vec3,
}

impl Basis {
    /// The axes of a view's sun; `up` follows the gaze, or the camera's own up where it looks along the rays.
    pub fn new(view: &View) -> Self {
        let along = -view.towards_sun;
        let across = |direction: Vec3| direction.reject_from_normalized(along);
        let [gaze, top] = [across(view.camera.forward()), across(view.camera.up())];
        let up = if gaze.length_squared() > 1e-4 { gaze.normalize() } else { top.normalize_or(Vec3::X) };
        Self { right: up.cross(along).normalize(), up, along }
    }

    fn of(&self, point_m: Vec3) -> Vec3 {
        Vec3::new(self.right.dot(point_m), self.up.dot(point_m), self.along.dot(point_m))
    }
}

/// A box in light space, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Box3 {
    pub low: Vec3,
    pub high: Vec3,
}

impl Box3 {
    /// Around points of scene space; none around none.
    pub fn of(points_m: &[Vec3], basis: &Basis) -> Option<Self> {
        let first = basis.of(*points_m.first()?);
        let grown = |grown: Self, point_m: &Vec3| {
            let point = basis.of(*point_m);
            Self { low: grown.low.min(point), high: grown.high.max(point) }
        };
        Some(points_m.iter().fold(Self { low: first, high: first }, grown))
    }

    /// Around a box of scene space.
    pub fn of_bounds(bounds_m: (Vec3, Vec3), basis: &Basis) -> Self {
        let corners = corners_m(bounds_m);
        Self::of(&corners, basis).unwrap_or(Self { low: Vec3::ZERO, high: Vec3::ZERO })
    }

    /// Least and greatest depth from the camera.
    pub fn depths_m(points_m: &[Vec3], camera: &Camera) -> Option<[f32; 2]> {
        let depths = || points_m.iter().map(|point_m| camera.depth_m(*point_m));
        (!points_m.is_empty())
            .then(|| [depths().fold(f32::INFINITY, f32::min), depths().fold(f32::NEG_INFINITY, f32::max)])
    }
}

/// Where a map's texels lie.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightMap {
    /// Scene to clip space: x and y from -1 to 1, y up; z from 0 at the sun's side to 1.
    pub clip_from_scene: Mat4,
    /// Texels a side.
    pub resolution: u32,
    /// Longer side of a texel, metres.
    pub texel_m: f32,
    /// Where z is 0: metres along the rays.
    pub nearest_m: f32,
    /// From there to where z is 1, metres.
    pub length_m: f32,
    low: Vec2,
    high: Vec2,
    basis: Basis,
}

impl LightMap {
    /// A map over a part of a scene, with so many texels a side.
    pub fn new(part: &Box3, scene: &Box3, basis: &Basis, resolution: u32) -> Self {
        // Nothing is as thin as not to be divided by, and what lies at the very ends is inside.
        let least_m = 1e-4 * (scene.high - scene.low).max_element().max(1e-3);
        let part_low = part.low.max(scene.low);
        let part_high = part.high.min(scene.high).max(part_low);
        let half = 0.5 * (part_high - part_low).truncate().max(Vec2::splat(least_m));
        let middle = 0.5 * (part_high + part_low).truncate();
        let inner = (resolution as f32 - 2.0 * BORDER_TEXELS).max(1.0);
        let half = half * (resolution as f32 / inner);
        let (nearest_m, farthest_m) = (scene.low.z - least_m, part_high.z + least_m);
        let length_m = farthest_m - nearest_m;

        let row = |axis: Vec3, middle: f32, half: f32| (axis / half).extend(-middle / half);
        let rows = [
            row(basis.right, middle.x, half.x),
            row(basis.up, middle.y, half.y),
            row(basis.along, nearest_m, length_m),
            Vec4::W,
        ];
        Self {
            clip_from_scene: Mat4::from_cols(rows[0], rows[1], rows[2], rows[3]).transpose(),
            resolution,
            texel_m: 2.0 * half.max_element() / resolution as f32,
            nearest_m,
            length_m,
            low: middle - half,
            high: middle + half,
            basis: *basis,
        }
    }

    /// Metres along the rays as a depth of the map, 0 to 1.
    pub fn depth(&self, along_m: f32) -> f32 {
        ((along_m - self.nearest_m) / self.length_m).clamp(0.0, 1.0)
    }

    /// Whether anything of a box of scene space may throw a shadow on what the map covers.
    pub fn may_hold(&self, bounds_m: (Vec3, Vec3)) -> bool {
        let held = Box3::of_bounds(bounds_m, &self.basis);
        let (low, high) = (held.low.truncate(), held.high.truncate());
        low.cmple(self.high).all() && high.cmpge(self.low).all() && held.low.z <= self.nearest_m + self.length_m
    }
}

/// The depths at which a camera may see something of a box, metres along its gaze; none where all is behind it.
pub fn depths_m(view: &View, bounds_m: (Vec3, Vec3)) -> Option<[f32; 2]> {
    let [near_m, far_m] = Box3::depths_m(&corners_m(bounds_m), &view.camera)?;
    let near_m = if view.camera.orthographic { near_m } else { near_m.max(view.camera.near_m()) };
    (far_m > near_m).then_some([near_m, far_m])
}

/// Corners of what a camera sees of a box between two depths: of a convex body, none where it sees nothing of it.
pub fn visible(view: &View, bounds_m: (Vec3, Vec3), [from_m, to_m]: [f32; 2]) -> Vec<Vec3> {
    let size_px = Vec2::new(view.size_px[0] as f32, view.size_px[1] as f32);
    let at = |corner: usize| {
        let px = size_px * Vec2::new((corner & 1) as f32, (corner >> 1 & 1) as f32);
        let (origin_m, direction) = view.camera.ray(px, size_px);
        let depth_m = if corner & 4 == 0 { from_m } else { to_m };
        let along = (depth_m - view.camera.depth_m(origin_m)) / direction.dot(view.camera.forward());
        origin_m + direction * along
    };
    let (slice, bounds) = (std::array::from_fn(at), corners_m(bounds_m));
    let (of_slice, of_bounds) = (planes(&slice), planes(&bounds));

    // The corners of what two convex bodies share are those of the faces of each, cut by the other.
    let cut = |corners: &[Vec3; 8], face: &[usize; 4], by: &[Vec4; 6]| {
        by.iter().fold(face.map(|corner| corners[corner]).to_vec(), |face, plane| clipped(&face, *plane))
    };
    let slices = FACES.iter().flat_map(|face| cut(&slice, face, &of_bounds));
    slices.chain(FACES.iter().flat_map(|face| cut(&bounds, face, &of_slice))).collect()
}

/// Whether a camera may see anything of a box: not where all its corners lie beyond one side of the picture.
pub fn may_see(view: &View, bounds_m: (Vec3, Vec3)) -> bool {
    let size_px = Vec2::new(view.size_px[0] as f32, view.size_px[1] as f32);
    let clip_from_scene = view.camera.view_projection(size_px);
    let clips = corners_m(bounds_m).map(|corner_m| clip_from_scene * corner_m.extend(1.0));
    let all = |beyond: fn(&Vec4) -> bool| clips.iter().all(beyond);
    let is_beside = all(|at| at.x > at.w) || all(|at| at.x < -at.w) || all(|at| at.y > at.w) || all(|at| at.y < -at.w);
    !is_beside && !all(|at| at.z > at.w)
}

/// Faces of a body with six, by the numbers of its corners: bit 0 for x, bit 1 for y, bit 2 for z.
const FACES: [[usize; 4]; 6] = [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];

/// Corners of a box, numbered as [`FACES`] has it.
fn corners_m((low_m, high_m): (Vec3, Vec3)) -> [Vec3; 8] {
    std::array::from_fn(|corner| {
        let upper = Vec3::new((corner & 1) as f32, (corner >> 1 & 1) as f32, (corner >> 2 & 1) as f32);
        low_m + (high_m - low_m) * upper
    })
}

/// Planes of a body's faces: a point p is inside where n . p + d >= 0.
fn planes(corners: &[Vec3; 8]) -> [Vec4; 6] {
    let middle = corners.iter().sum::<Vec3>() / 8.0;
    FACES.map(|face| {
        let [a, b, c, d] = face.map(|corner| corners[corner]);
        // By the diagonals: an edge at the near plane may be too short to have a direction.
        let normal = (c - a).cross(d - b).normalize_or_zero();
        let plane = normal.extend(-normal.dot((a + b + c + d) / 4.0));
        if plane.dot(middle.extend(1.0)) < 0.0 { -plane } else { plane }
    })
}

/// A polygon cut by a plane (Sutherland & Hodgman 1974).
fn clipped(polygon: &[Vec3], plane: Vec4) -> Vec<Vec3> {
    let height = |point: &Vec3| plane.dot(point.extend(1.0));
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (number, point) in polygon.iter().enumerate() {
        let next = &polygon[(number + 1) % polygon.len()];
        let (here, there) = (height(point), height(next));
        if here >= 0.0 {
            kept.push(*point);
        }
        if (here < 0.0) != (there < 0.0) {
            kept.push(*point + (*next - *point) * (here / (here - there)));
        }
    }
    kept
}
