//! What bounds a void made of rooms of any convex outline, under flat or sloping ceilings, joined by doors?
//!
//! Each room is a ring of corners with a floor and a ceiling; each door a prism between two walls, cut parallel to a
//! line from a point of one room to a point of the other. Walls are cut where doors meet them, and neighbours share
//! whole edges, so no T-junction can leak light. Rooms must not overlap, which nobody checks.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3};

use crate::scene::Mesh;

/// What closes a room above its eaves.
#[derive(Clone, Copy)]
pub enum Roof {
    /// One plane through all eaves.
    Plane,
    /// Two planes that meet between two corners.
    Ridge(usize, usize),
    /// A pyramid over level eaves.
    Peak([f64; 3]),
}

struct Room {
    /// Counter-clockwise.
    corners: Vec<DVec2>,
    floor_m: f64,
    /// Over each corner.
    eaves_m: Vec<f64>,
    roof: Roof,
}

/// Where a door cuts an edge of a room's ring: its two jambs, in the order of the ring.
#[derive(Clone, Copy)]
struct Cut {
    edge: usize,
    jambs: [DVec2; 2],
    /// Lower and upper end of the opening.
    span_m: [f64; 2],
}

/// Rooms and doors.
#[derive(Default)]
pub struct Rooms {
    rooms: Vec<Room>,
    doors: Vec<[(usize, Cut); 2]>,
}

impl Rooms {
    /// Adds a room; `eaves_m` is the ceiling's height over a corner. Its number is how many were added before.
    pub fn room(mut self, corners: &[[f64; 2]], floor_m: f64, eaves_m: impl Fn(DVec2) -> f64, roof: Roof) -> Self {
        let corners: Vec<DVec2> = corners.iter().map(|&c| c.into()).collect();
        let eaves_m = corners.iter().map(|&c| eaves_m(c)).collect();
        self.rooms.push(Room { corners, floor_m, eaves_m, roof });
        self
    }

    /// Joins two rooms by an opening along the line from a point of the first to a point of the second.
    pub fn door(mut self, rooms: [usize; 2], line: [[f64; 2]; 2], width_m: f64, span_m: [f64; 2]) -> Self {
        let [a, b] = line.map(DVec2::from);
        let along = (b - a).normalize();
        let cut = |room: usize, from: DVec2, towards: DVec2| {
            // Seen from inside, the ring runs from right to left.
            let side = towards.perp() * (width_m / 2.0);
            let (edge, first) = self.rooms[room].exit(from - side, towards);
            let (other, second) = self.rooms[room].exit(from + side, towards);
            assert_eq!(edge, other, "a door of room {room} does not fit into one wall");
            (room, Cut { edge, jambs: [first, second], span_m })
        };
        let door = [cut(rooms[0], a, along), cut(rooms[1], b, -along)];
        self.doors.push(door);
        self
    }

    /// The void's boundary in the materials `floor`, `wall` and `ceiling`, or all without a name.
    pub fn mesh(&self, named: bool) -> Mesh {
        let mut faces = Faces::default();
        for (number, room) in self.rooms.iter().enumerate() {
            let cuts = self.doors.iter().flatten().filter(|(of, _)| *of == number).map(|(_, cut)| *cut).collect();
            room.build(cuts, &mut faces);
        }
        for [(_, a), (_, b)] in &self.doors {
            let ring = [b.jambs[1], b.jambs[0], a.jambs[1], a.jambs[0]];
            let [low, high] = a.span_m.map(|z| ring.map(|p| p.extend(z)));
            faces.add("floor", low.to_vec());
            faces.add("ceiling", high.iter().rev().copied().collect());
            for (i, j) in [(3, 0), (1, 2)] {
                faces.add("wall", vec![low[j], low[i], high[i], high[j]]);
            }
        }
        faces.mesh(named)
    }
}

impl Room {
    /// The edge through which a ray leaves the ring from a point inside, and where.
    fn exit(&self, from: DVec2, towards: DVec2) -> (usize, DVec2) {
        let crossings = (0..self.corners.len()).filter_map(|edge| {
            let (p, q) = (self.corners[edge], self.corners[(edge + 1) % self.corners.len()]);
            let across = towards.perp_dot(q - p);
            let (t, along) = ((p - from).perp_dot(q - p) / across, (p - from).perp_dot(towards) / across);
            // Of two edges on one line the one that is met.
            (across > 0.0 && (0.0..=1.0).contains(&along)).then_some((edge, t))
        });
        let (edge, t) = crossings.min_by(|a, b| a.1.total_cmp(&b.1)).expect("a ring is closed");
        (edge, from + towards * t)
    }

    fn build(&self, mut cuts: Vec<Cut>, faces: &mut Faces) {
        let count = self.corners.len();
        // The ring at the eaves with its jambs, and where each corner stands in it.
        let (mut ring, mut place) = (Vec::new(), Vec::new());
        for edge in 0..count {
            let (p, q) = (self.corners[edge], self.corners[(edge + 1) % count]);
            let top = |x: DVec2| {
                let t = x.distance(p) / q.distance(p);
                self.eaves_m[edge] * (1.0 - t) + self.eaves_m[(edge + 1) % count] * t
            };
            cuts.sort_by(|a, b| a.jambs[0].distance(p).total_cmp(&b.jambs[0].distance(p)));
            let here: Vec<&Cut> = cuts.iter().filter(|cut| cut.edge == edge).collect();
            place.push(ring.len());
            // Columns of the wall: at its ends from floor to eaves, at jambs with the opening's ends in between.
            let whole = |x: DVec2| vec![x.extend(self.floor_m), x.extend(top(x))];
            let mut left = whole(p);
            ring.push(p.extend(top(p)));
            for cut in here {
                let columns = cut.jambs.map(|x| {
                    let [low, high] = cut.span_m.map(|z| x.extend(z));
                    vec![x.extend(self.floor_m), low, high, x.extend(top(x))]
                });
                ring.extend(columns.iter().map(|column| column[3]));
                faces.wall(&left, &columns[0]);
                if cut.span_m[0] > self.floor_m {
                    faces.wall(&columns[0][..2], &columns[1][..2]);
                }
                faces.wall(&columns[0][2..], &columns[1][2..]);
                left = columns[1].clone();
            }
            faces.wall(&left, &whole(q));
        }

        faces.add("floor", ring.iter().map(|p| p.truncate().extend(self.floor_m)).collect());
        let part = |from: usize, to: usize| {
            let to = if to > from { to } else { to + ring.len() };
            (from..=to).rev().map(|i| ring[i % ring.len()]).collect::<Vec<_>>()
        };
        match self.roof {
            Roof::Plane => faces.add("ceiling", ring.iter().rev().copied().collect()),
            Roof::Ridge(i, j) => {
                faces.add("ceiling", part(place[i], place[j]));
                faces.add("ceiling", part(place[j], place[i]));
            }
            Roof::Peak(peak) => faces.fan("ceiling", peak.into(), &part(0, 0)[1..]),
        }
    }
}

/// Polygons over vertices that are one where they agree to a tenth of a millimetre.
#[derive(Default)]
struct Faces {
    vertices: Vec<DVec3>,
    index_of: BTreeMap<[i64; 3], usize>,
    groups: BTreeMap<&'static str, Vec<Vec<usize>>>,
}

impl Faces {
    fn vertex(&mut self, p: DVec3) -> usize {
        let key = (p * 1e4).round();
        *self.index_of.entry(key.to_array().map(|c| c as i64)).or_insert_with(|| {
            self.vertices.push(key / 1e4);
            self.vertices.len() - 1
        })
    }

    /// Adds a planar convex polygon; corners may lie on its edges.
    fn add(&mut self, material: &'static str, mut corners: Vec<DVec3>) {
        corners.dedup_by(|a, b| a.distance(*b) < 1e-4);
        if corners.len() > 4 {
            // About its middle, for a fan about a corner is degenerate where others lie on the corner's edges.
            let middle = corners.iter().sum::<DVec3>() / corners.len() as f64;
            self.fan(material, middle, &corners);
        } else {
            let polygon = corners.into_iter().map(|p| self.vertex(p)).collect();
            self.groups.entry(material).or_default().push(polygon);
        }
    }

    fn fan(&mut self, material: &'static str, middle: DVec3, ring: &[DVec3]) {
        for (i, &p) in ring.iter().enumerate() {
            let triangle = [middle, p, ring[(i + 1) % ring.len()]].map(|p| self.vertex(p));
            self.groups.entry(material).or_default().push(triangle.to_vec());
        }
    }

    /// Adds the part of a wall between two columns of points, each from below to above, the second further on the ring.
    fn wall(&mut self, first: &[DVec3], second: &[DVec3]) {
        self.add("wall", first.iter().chain(second.iter().rev()).copied().collect());
    }

    fn mesh(self, named: bool) -> Mesh {
        let groups = if named {
            self.groups.into_iter().collect()
        } else {
            vec![("", self.groups.into_values().flatten().collect())]
        };
        Mesh { vertices: self.vertices, groups }
    }
}
