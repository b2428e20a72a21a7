//! How far along a ray is a triangle or a sphere?
//!
//! Triangles by the watertight test of Woop, Benthin & Wald 2013; spheres by the distance of their centre from the ray.

use crate::scene::Light;
use glam::{DVec3, Vec3};
use obvhs::aabb::Aabb;
use obvhs::ray::Ray;

/// Distances are handed to the tree in units of 2^-20 m. The tree drops boxes that end nearer than 1e-4 of its units, which
/// in metres would let rays that start 0.1 mm before a wall through it.
pub(super) const UNITS_PER_M: f32 = 1_048_576.0;

/// A distance is in doubt within 16 roundings of what it is summed up from.
const IN_DOUBT: f32 = 16.0 / 16_777_216.0;

/// What a ray can meet.
#[derive(Debug, Clone, Copy)]
pub(super) enum Body {
    Triangle([Vec3; 3]),
    Sphere {
        centre_m: Vec3,
        radius_m: f32,
    },
    /// Nothing: what stood there was moved or hidden.
    Blank,
}

/// The bodies of a light; none for a point.
pub(super) fn bodies_of(light: &Light) -> Vec<Body> {
    match *light {
        Light::Point { .. } => Vec::new(),
        Light::Sphere { centre_m, radius_m, .. } => vec![Body::Sphere { centre_m, radius_m }],
        Light::Quad { corner_m, u_m, v_m, .. } => {
            let [a, b, c, d] = [corner_m, corner_m + u_m, corner_m + u_m + v_m, corner_m + v_m];
            vec![Body::Triangle([a, b, c]), Body::Triangle([a, c, d])]
        }
    }
}

impl Body {
    pub(super) fn largest_coordinate(&self) -> f32 {
        match self {
            Body::Triangle(corners) => corners.iter().map(|corner| corner.abs().max_element()).fold(0.0, f32::max),
            Body::Sphere { centre_m, radius_m } => centre_m.abs().max_element() + radius_m,
            Body::Blank => 0.0,
        }
    }

    pub(super) fn padded_box(&self, pad_m: f32) -> Aabb {
        let (low, high) = match *self {
            Body::Triangle([a, b, c]) => (a.min(b).min(c), a.max(b).max(c)),
            Body::Sphere { centre_m, radius_m } => (centre_m - radius_m, centre_m + radius_m),
            Body::Blank => return Aabb::empty(),
        };
        Aabb::new((low - pad_m).into(), (high + pad_m).into())
    }

    /// The normal of the front side at a point of the body.
    pub(super) fn normal(&self, at_m: Vec3) -> Vec3 {
        match *self {
            // In f64: slivers lose their normal in f32.
            Body::Triangle(corners) => {
                let [a, b, c] = corners.map(|corner| corner.as_dvec3());
                (b - a).cross(c - a).normalize_or(DVec3::Z).as_vec3()
            }
            Body::Sphere { centre_m, .. } => (at_m - centre_m).normalize_or(Vec3::Z),
            Body::Blank => Vec3::Z,
        }
    }

    /// How far along the ray the body is, metres; infinite where it is missed or behind.
    pub(super) fn distance_m(&self, ray: &Shear) -> f32 {
        match *self {
            Body::Triangle(corners) => ray.distance_to_triangle_m(corners),
            Body::Sphere { centre_m, radius_m } => ray.distance_to_sphere_m(centre_m, radius_m),
            Body::Blank => f32::INFINITY,
        }
    }
}

/// A ray, prepared for the watertight test: the shear that turns its direction onto its own largest axis.
pub(super) struct Shear {
    origin_m: Vec3,
    direction: Vec3,
    /// The axes, the direction's largest last; the first two swapped where that one points backwards.
    axes: [usize; 3],
    shear: Vec3,
}

impl Shear {
    pub(super) fn new(origin_m: Vec3, direction: Vec3) -> Self {
        // Negative zeros would select the wrong side of a box.
        let direction = direction + 0.0;
        let size = direction.abs();
        let last = if size.x >= size.y && size.x >= size.z {
            0
        } else if size.y >= size.z {
            1
        } else {
            2
        };
        let axes = [(last + 1) % 3, (last + 2) % 3, last];
        let along = direction[last];
        let shear = Vec3::new(direction[axes[0]] / along, direction[axes[1]] / along, 1.0 / along);
        Self { origin_m, direction, axes, shear }
    }

    /// The same ray in the tree's units.
    pub(super) fn in_tree(&self, max_m: f32) -> Ray {
        /// Stands for the inverse of zero: large, and finite when multiplied by any coordinate.
        const INVERSE_OF_ZERO: f32 = 1e20;
        let inverse = |along: f32| {
            if along.abs() < 1.0 / INVERSE_OF_ZERO { INVERSE_OF_ZERO.copysign(along) } else { 1.0 / along }
        };
        let [x, y, z] = self.direction.to_array().map(inverse);
        Ray {
            origin: self.origin_m.into(),
            direction: self.direction.into(),
            inv_direction: (Vec3::new(x, y, z) * UNITS_PER_M).into(),
            tmin: 0.0,
            tmax: max_m * UNITS_PER_M,
        }
    }

    /// Woop, Benthin & Wald 2013: seen along the ray the origin lies in the triangle when the three edge functions have
    /// one sign. Two triangles compute the function of a shared edge from the same numbers, so no ray passes between.
    fn distance_to_triangle_m(&self, corners_m: [Vec3; 3]) -> f32 {
        let [first, second, last] = self.axes;
        let [a, b, c] = corners_m.map(|corner_m| {
            let local = corner_m - self.origin_m;
            let along = local[last];
            Vec3::new(local[first] - self.shear.x * along, local[second] - self.shear.y * along, self.shear.z * along)
        });
        let mut u = c.x * b.y - c.y * b.x;
        let mut v = a.x * c.y - a.y * c.x;
        let mut w = b.x * a.y - b.y * a.x;

        // On an edge in f32: decide in f64, where these products are exact.
        if u == 0.0 || v == 0.0 || w == 0.0 {
            let edge = |p: Vec3, q: Vec3| (f64::from(p.x) * f64::from(q.y) - f64::from(p.y) * f64::from(q.x)) as f32;
            (u, v, w) = (edge(c, b), edge(a, c), edge(b, a));
        }
        if (u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0) {
            return f32::INFINITY;
        }
        let area = u + v + w;
        let moment = u * a.z + v * b.z + w * c.z;
        if area == 0.0 {
            return f32::INFINITY;
        }
        // Where the triangle is a long sliver, rounding may outweigh the distance, and the ground shades itself.
        let size = |axis: usize| [a, b, c].into_iter().map(|corner| corner[axis].abs()).fold(0.0, f32::max);
        let (aside_m, along_m) = (size(0).max(size(1)), size(2));
        let distance_m = if moment.abs() < IN_DOUBT * aside_m * (aside_m + along_m) * along_m {
            self.distance_to_plane_m(corners_m)
        } else {
            moment / area
        };
        if distance_m > 0.0 { distance_m } else { f32::INFINITY }
    }

    /// In f64, in which differences and products of coordinates are exact or nearly so; not a number for edge-on planes.
    fn distance_to_plane_m(&self, corners_m: [Vec3; 3]) -> f32 {
        let [a, b, c] = corners_m.map(|corner_m| corner_m.as_dvec3() - self.origin_m.as_dvec3());
        let normal = (b - a).cross(c - a);
        (normal.dot(a) / normal.dot(self.direction.as_dvec3())) as f32
    }

    /// The nearer crossing in front of the origin; from inside, the far one.
    fn distance_to_sphere_m(&self, centre_m: Vec3, radius_m: f32) -> f32 {
        // In f64: far from a small sphere the discriminant cancels in f32.
        let (origin, direction) = (self.origin_m.as_dvec3(), self.direction.as_dvec3());
        let (to_centre, radius) = (centre_m.as_dvec3() - origin, f64::from(radius_m));
        let along = to_centre.dot(direction);
        let aside = to_centre - along * direction;
        let half_chord_squared = radius * radius - aside.length_squared();
        if half_chord_squared < 0.0 {
            return f32::INFINITY;
        }
        let half_chord = half_chord_squared.sqrt();
        let crossings = [along - half_chord, along + half_chord];
        crossings.into_iter().find(|&distance| distance > 0.0).map_or(f32::INFINITY, |distance| distance as f32)
    }
}
