//! What is a town made of? Closed solids, each with vertices of its own, that may reach into each other.
//!
//! A solid that stands on another reaches into it, so no two faces of neighbours lie on each other and no light passes
//! between them. What is thereby hidden stays in the mesh, as it does in the models of real towns.

use std::f64::consts::TAU;

use glam::{DVec2, DVec3};

use super::GROUND_M;
use crate::scene::Mesh;

/// How far solids reach into the ground.
pub const FOOT_M: f64 = 0.2;

/// A plan's own axes: u along a street, v to its left.
#[derive(Clone, Copy)]
pub struct Frame {
    origin: DVec2,
    along: DVec2,
}

/// What closes a house above its eaves.
#[derive(Clone, Copy)]
pub enum Roof {
    Flat,
    /// Rises from the first side to the other.
    Shed(f64),
    /// A ridge along u, so high above the eaves, its ends so far from the ends of the house: 0 makes gables. The ridge
    /// must keep a length.
    Ridge(f64, f64),
}

/// Closed solids.
#[derive(Default)]
pub struct Solids {
    vertices: Vec<DVec3>,
    polygons: Vec<Vec<usize>>,
}

impl Frame {
    /// A frame with its origin at a point, turned counter-clockwise.
    pub fn new(x: f64, y: f64, degrees: f64) -> Self {
        Self { origin: DVec2::new(x, y), along: DVec2::from_angle(degrees.to_radians()) }
    }

    /// A frame in this one, turned by quarters counter-clockwise.
    pub fn part(&self, u: f64, v: f64, quarters: usize) -> Self {
        let along = (0..quarters % 4).fold(self.along, |along, _| along.perp());
        Self { origin: self.at(u, v), along }
    }

    /// Where a point of the plan lies.
    pub fn at(&self, u: f64, v: f64) -> DVec2 {
        self.origin + self.along * u + self.along.perp() * v
    }
}

impl Solids {
    /// The ground: a square slab about the origin.
    pub fn ground(side_m: f64) -> Self {
        let half = side_m / 2.0;
        let mut solids = Self::default();
        solids.block(&Frame::new(0.0, 0.0, 0.0), [-half, -half, -GROUND_M], [half, half, 0.0]);
        solids
    }

    /// A box.
    pub fn block(&mut self, frame: &Frame, [u0, v0, low]: [f64; 3], [u1, v1, high]: [f64; 3]) {
        let ring = [(u0, v0), (u1, v0), (u1, v1), (u0, v1)].map(|(u, v)| frame.at(u, v));
        self.prism(&ring, low, [high; 4]);
    }

    /// A round pillar, octagonal in truth.
    pub fn pillar(&mut self, frame: &Frame, [u, v]: [f64; 2], radius_m: f64, [low, high]: [f64; 2]) {
        let ring: [DVec2; 8] = std::array::from_fn(|i| {
            let p = DVec2::from_angle((i as f64 + 0.5) * TAU / 8.0) * radius_m;
            frame.at(u + p.x, v + p.y)
        });
        self.prism(&ring, low, [high; 8]);
    }

    /// A house from the ground to its roof; the first side is v0.
    pub fn house(&mut self, frame: &Frame, [u0, v0]: [f64; 2], [u1, v1]: [f64; 2], eaves_m: f64, roof: Roof) {
        self.roofed(frame, [u0, v0, -FOOT_M], [u1, v1, eaves_m], roof);
    }

    /// The same from any height.
    pub fn roofed(&mut self, frame: &Frame, [u0, v0, low]: [f64; 3], [u1, v1, eaves_m]: [f64; 3], roof: Roof) {
        let ring = [(u0, v0), (u1, v0), (u1, v1), (u0, v1)].map(|(u, v)| frame.at(u, v));
        match roof {
            Roof::Flat => self.prism(&ring, low, [eaves_m; 4]),
            Roof::Shed(rise_m) => self.prism(&ring, low, [eaves_m, eaves_m, eaves_m + rise_m, eaves_m + rise_m]),
            Roof::Ridge(rise_m, inset_m) => {
                let middle = (v0 + v1) / 2.0;
                let ridge = [u0 + inset_m, u1 - inset_m].map(|u| frame.at(u, middle).extend(eaves_m + rise_m));
                let points: Vec<DVec3> = [low, eaves_m].iter().flat_map(|&z| ring.map(|p| p.extend(z))).collect();
                let faces: [&[usize]; 9] = [
                    &[3, 2, 1, 0],
                    &[0, 1, 5, 4],
                    &[1, 2, 6, 5],
                    &[2, 3, 7, 6],
                    &[3, 0, 4, 7],
                    &[4, 5, 9, 8],
                    &[5, 6, 9],
                    &[6, 7, 8, 9],
                    &[7, 4, 8],
                ];
                self.add(&[points, ridge.to_vec()].concat(), &faces.map(<[usize]>::to_vec));
            }
        }
    }

    /// A prism over a convex ring, counter-clockwise, that is as high over each corner as said.
    fn prism<const N: usize>(&mut self, ring: &[DVec2; N], low: f64, tops: [f64; N]) {
        let mut points: Vec<DVec3> = ring.iter().map(|p| p.extend(low)).collect();
        points.extend(ring.iter().zip(tops).map(|(p, top)| p.extend(top)));
        let mut faces = vec![(0..N).rev().collect(), (N..2 * N).collect()];
        faces.extend((0..N).map(|i| vec![i, (i + 1) % N, N + (i + 1) % N, N + i]));
        self.add(&points, &faces);
    }

    /// A wall along u over an arch: half an ellipse from springing to crown, in straight pieces.
    pub fn arch(
        &mut self,
        frame: &Frame,
        [u0, u1]: [f64; 2],
        [v0, v1]: [f64; 2],
        [spring_m, crown_m, top_m]: [f64; 3],
    ) {
        const PIECES: usize = 6;
        let mut points = Vec::new();
        for i in 0..=PIECES {
            let (across, up) = (-DVec2::from_angle(i as f64 * TAU / 2.0 / PIECES as f64).x, i * (PIECES - i));
            // Exactly at the springing at both ends.
            let lift = if up == 0 { 0.0 } else { (1.0 - across * across).sqrt() };
            let u = (u0 + u1) / 2.0 + across * (u1 - u0) / 2.0;
            for z in [spring_m + (crown_m - spring_m) * lift, top_m] {
                points.extend([v0, v1].map(|v| frame.at(u, v).extend(z)));
            }
        }
        // Each column: below at v0 and v1, above at v0 and v1.
        let mut faces = vec![vec![0, 2, 3, 1], [0, 1, 3, 2].map(|k| 4 * PIECES + k).to_vec()];
        for i in 0..PIECES {
            let (a, b) = (4 * i, 4 * i + 4);
            faces.push(vec![a, b, b + 2, a + 2]);
            faces.push(vec![b + 1, a + 1, a + 3, b + 3]);
            faces.push(vec![a, a + 1, b + 1, b]);
            faces.push(vec![a + 2, b + 2, b + 3, a + 3]);
        }
        self.add(&points, &faces);
    }

    /// Adds a solid, in whole tenths of a millimetre.
    fn add(&mut self, points: &[DVec3], faces: &[Vec<usize>]) {
        let first = self.vertices.len();
        self.vertices.extend(points.iter().map(|p| (p * 1e4).round() / 1e4));
        self.polygons.extend(faces.iter().map(|face| face.iter().map(|corner| first + corner).collect()));
    }

    /// Adds all of another's.
    pub fn append(&mut self, other: &Self) {
        self.add(&other.vertices, &other.polygons);
    }

    /// All of them as one mesh.
    pub fn mesh(&self) -> Mesh {
        Mesh { vertices: self.vertices.clone(), groups: vec![("", self.polygons.clone())] }
    }
}
