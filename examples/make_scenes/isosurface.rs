//! Where is a scalar field zero? Marching tetrahedra on a cubic lattice (Doi and Koide 1991), six tetrahedra a cube.
//!
//! All cubes are cut along the same diagonals, so the surface is closed wherever the field is negative on the
//! lattice's rim. Features under about two lattice steps are lost.

use std::collections::BTreeMap;

use glam::DVec3;

use crate::scene::Mesh;

/// How near a crossing may come to a lattice point, as a share of the lattice edge: less makes slivers.
const NEAREST: f64 = 0.12;

/// The six tetrahedra of a cube as walks from corner 0 to corner 7, a bit an axis.
const TETRAHEDRA: [[usize; 4]; 6] =
    [[0, 1, 3, 7], [0, 1, 5, 7], [0, 2, 3, 7], [0, 2, 6, 7], [0, 4, 5, 7], [0, 4, 6, 7]];

/// Field values on the points of a lattice; the void is where they are positive.
pub struct Samples {
    pub origin: DVec3,
    pub step_m: f64,
    pub size: [usize; 3],
    pub values: Vec<f64>,
}

impl Samples {
    /// Samples `field` over the box from `min` to `max`.
    pub fn of(min: DVec3, max: DVec3, step_m: f64, field: impl Fn(DVec3) -> f64) -> Self {
        let span = (max - min) / step_m;
        let size = [span.x, span.y, span.z].map(|s| s.ceil() as usize + 1);
        let mut samples = Samples { origin: min, step_m, size, values: Vec::new() };
        samples.values = (0..size.iter().product()).map(|i| field(samples.point(i))).collect();
        samples
    }

    /// Turns every void but the largest into matter, so that the void is one. Gives how many were filled.
    pub fn keep_largest_void(&mut self) -> usize {
        let mut component = vec![usize::MAX; self.values.len()];
        let mut sizes = Vec::new();
        for start in 0..self.values.len() {
            if self.values[start] <= 0.0 || component[start] != usize::MAX {
                continue;
            }
            let (mut stack, mut count) = (vec![start], 0);
            component[start] = sizes.len();
            while let Some(i) = stack.pop() {
                count += 1;
                for j in self.linked(i) {
                    if self.values[j] > 0.0 && component[j] == usize::MAX {
                        component[j] = sizes.len();
                        stack.push(j);
                    }
                }
            }
            sizes.push(count);
        }
        let largest = (0..sizes.len()).max_by_key(|&c| sizes[c]);
        for (value, c) in self.values.iter_mut().zip(&component) {
            if *value > 0.0 && Some(*c) != largest {
                *value = -1e-3;
            }
        }
        sizes.len().saturating_sub(1)
    }

    /// The zero surface, normals towards positive values, coordinates in whole millimetres.
    pub fn surface(&self) -> Mesh {
        let mut mesh = Mesh::default();
        let mut vertex_on = BTreeMap::new();
        let mut triangles = Vec::new();
        let [nx, ny, nz] = self.size;
        for z in 0..nz - 1 {
            for y in 0..ny - 1 {
                for x in 0..nx - 1 {
                    for tetrahedron in TETRAHEDRA {
                        let corners =
                            tetrahedron.map(|c| (x + (c & 1)) + nx * ((y + (c >> 1 & 1)) + ny * (z + (c >> 2))));
                        let (void, matter): (Vec<usize>, Vec<usize>) =
                            corners.iter().partition(|&&i| self.values[i] > 0.0);
                        let Some(&towards) = void.first() else {
                            continue;
                        };
                        let mut crossing = |a: usize, b: usize| {
                            let edge = (a.min(b), a.max(b));
                            *vertex_on.entry(edge).or_insert_with(|| {
                                mesh.vertices.push(self.crossing(edge.0, edge.1));
                                mesh.vertices.len() - 1
                            })
                        };
                        // One corner cut off gives a triangle, two and two a quad.
                        let ring: Vec<usize> = match (void.as_slice(), matter.as_slice()) {
                            ([a], others) | (others, [a]) => others.iter().map(|&b| crossing(*a, b)).collect(),
                            ([a, b], [c, d]) => {
                                vec![crossing(*a, *c), crossing(*a, *d), crossing(*b, *d), crossing(*b, *c)]
                            }
                            _ => continue,
                        };
                        for i in 1..ring.len() - 1 {
                            triangles.push((self.point(towards), [ring[0], ring[i], ring[i + 1]]));
                        }
                    }
                }
            }
        }
        // Each triangle faces the void corner of its tetrahedron.
        let facing = triangles
            .into_iter()
            .map(|(towards, [a, b, c])| {
                let [p, q, r] = [a, b, c].map(|i| mesh.vertices[i]);
                if (q - p).cross(r - p).dot(towards - p) >= 0.0 { vec![a, b, c] } else { vec![a, c, b] }
            })
            .collect();
        mesh.groups = vec![("", facing)];
        mesh
    }

    fn point(&self, i: usize) -> DVec3 {
        let [nx, ny, _] = self.size;
        let steps = [i % nx, i / nx % ny, i / (nx * ny)].map(|s| s as f64);
        self.origin + DVec3::from(steps) * self.step_m
    }

    /// The lattice points that share an edge of a tetrahedron with a point.
    fn linked(&self, i: usize) -> Vec<usize> {
        let [nx, ny, nz] = self.size;
        let at = [i % nx, i / nx % ny, i / (nx * ny)];
        let mut linked = Vec::new();
        for bits in 1..8_usize {
            let step = [bits & 1, bits >> 1 & 1, bits >> 2];
            let offset = step[0] + nx * (step[1] + ny * step[2]);
            if (0..3).all(|a| at[a] + step[a] < [nx, ny, nz][a]) {
                linked.push(i + offset);
            }
            if (0..3).all(|a| at[a] >= step[a]) {
                linked.push(i - offset);
            }
        }
        linked
    }

    fn crossing(&self, a: usize, b: usize) -> DVec3 {
        let (va, vb) = (self.values[a], self.values[b]);
        let t = (va / (va - vb)).clamp(NEAREST, 1.0 - NEAREST);
        let p = self.point(a).lerp(self.point(b), t);
        // Whole millimetres: short files; NEAREST keeps the vertices apart.
        (p * 1000.0).round() / 1000.0
    }
}
