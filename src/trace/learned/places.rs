//! Which samples speak for a point?
//!
//! Each sensor has a place of its own. Points on surfaces are parted by the axis that their normal is nearest to and its sign, so
//! that walls that meet in a corner do not share what they see, and then by a binary tree over space whose leaves are halved,
//! along x, y and z in turn, once enough samples fell on them (Müller, Gross & Novák 2017).

use super::directions::Directions;
use glam::Vec3;
use rayon::prelude::*;

/// Sides of surfaces: three axes, two signs.
const SIDES: usize = 6;

/// Samples of a first pass beyond which a leaf is halved; of pass k, 2^(k/2) times as many, so that leaves become both more
/// and better known.
const MOST_SAMPLES: f64 = 2000.0;

/// Share of directions that are drawn from what a place knows well.
const MOST_SHARE: f64 = 0.5;

/// With so many sights of equal light half of that share: a few bright samples in the dark say little. Of 0, 8, 64 and 256, 64
/// gave the dark sensors of `gallery` and `keyhole` the least error after a second, and a scene without openings nearly so.
const DOUBTED_SIGHTS: f64 = 64.0;

/// A leaf is not halved more often than this.
const MOST_DEPTH: u32 = 48;

/// A place where the light was learned.
#[derive(Debug, Clone)]
pub(super) struct Place {
    /// What earlier passes saw; without light until some was seen.
    pub(super) known: Directions,
    /// Share of directions that are drawn from it.
    pub(super) share: f64,
    /// What this pass sees, and the sum of the squares of the light of each sight.
    seen: Directions,
    squares: f64,
    samples: f64,
    depth: u32,
}

/// All places.
#[derive(Debug, Clone)]
pub(super) struct Places {
    list: Vec<Place>,
    nodes: Vec<Node>,
    low_m: Vec3,
    size_m: Vec3,
}

/// A node of the trees over space; the first [`SIDES`] are their roots.
#[derive(Debug, Clone, Copy)]
enum Node {
    Place(u32),
    /// The number of its lower half; the upper one is the next.
    Halves(u32),
}

/// Light that a path found to come to a place.
#[derive(Debug, Clone, Copy)]
pub(super) struct Sight {
    pub(super) place: u32,
    pub(super) square: [f32; 2],
    /// Irradiance over density, W/m2.
    pub(super) light_w_m2: f32,
}

impl Places {
    /// Nothing known, for that many sensors and surfaces within those bounds.
    pub(super) fn new(sensors: usize, (low_m, high_m): (Vec3, Vec3)) -> Self {
        let blank = Place {
            known: Directions::blank(),
            share: 0.0,
            seen: Directions::blank(),
            squares: 0.0,
            samples: 0.0,
            depth: 0,
        };
        Self {
            list: vec![blank; sensors + SIDES],
            nodes: (0..SIDES).map(|side| Node::Place((sensors + side) as u32)).collect(),
            low_m,
            size_m: (high_m - low_m).max(Vec3::splat(f32::MIN_POSITIVE)),
        }
    }

    /// The number of a sensor's place.
    pub(super) fn of_sensor(&self, sensor: usize) -> u32 {
        sensor as u32
    }

    /// The number of the place for a point on a surface.
    pub(super) fn of_point(&self, point_m: Vec3, normal: Vec3) -> u32 {
        let largest = normal.abs();
        let axis = if largest.x >= largest.y.max(largest.z) {
            0
        } else if largest.y >= largest.z {
            1
        } else {
            2
        };
        let mut number = 2 * axis + usize::from(normal[axis] < 0.0);
        let mut within = ((point_m - self.low_m) / self.size_m).clamp(Vec3::ZERO, Vec3::ONE);
        let mut cut = 0;
        loop {
            match self.nodes.get(number) {
                Some(&Node::Halves(lower)) => {
                    let is_upper = within[cut] >= 0.5;
                    within[cut] = 2.0 * within[cut] - if is_upper { 1.0 } else { 0.0 };
                    number = lower as usize + usize::from(is_upper);
                    cut = (cut + 1) % 3;
                }
                Some(&Node::Place(place)) => return place,
                None => return 0,
            }
        }
    }

    /// What is known at a place; `None` where no light was seen yet.
    pub(super) fn known(&self, place: u32) -> Option<&Place> {
        self.list.get(place as usize).filter(|place| place.share > 0.0)
    }

    /// Takes in what paths found. The sums of a place are made in the order of the sights, whichever thread makes them.
    pub(super) fn see(&mut self, sights: &[Vec<Sight>]) {
        let mut begins = vec![0_usize; self.list.len() + 1];
        for sight in sights.iter().flatten() {
            begins[sight.place as usize + 1] += 1;
        }
        for place in 0..self.list.len() {
            begins[place + 1] += begins[place];
        }
        let mut next = begins.clone();
        let mut by_place = vec![([0.0_f32; 2], 0.0_f32); begins[self.list.len()]];
        for sight in sights.iter().flatten() {
            by_place[next[sight.place as usize]] = (sight.square, sight.light_w_m2);
            next[sight.place as usize] += 1;
        }
        self.list.par_iter_mut().zip(begins.par_windows(2)).for_each(|(place, ends)| {
            let its = &by_place[ends[0]..ends[1]];
            place.samples += its.len() as f64;
            for &(square, light_w_m2) in its.iter().filter(|(_, light_w_m2)| *light_w_m2 > 0.0) {
                place.seen.add(square, f64::from(light_w_m2));
                place.squares += f64::from(light_w_m2).powi(2);
            }
        });
    }

    /// Ends a pass, the `pass`th: what it saw is what is known, and places with many samples are halved.
    pub(super) fn learn(&mut self, pass: u32) {
        self.list.par_iter_mut().for_each(|place| {
            // A pass that saw nothing teaches nothing.
            let total = place.seen.total();
            if total > 0.0 {
                // So many sights of equal light would say as much.
                let count = total * total / place.squares;
                place.share = MOST_SHARE * count / (count + DOUBTED_SIGHTS);
                place.squares = 0.0;
                place.known = std::mem::replace(&mut place.seen, Directions::blank());
            }
            place.seen = place.known.refined();
        });
        let most = MOST_SAMPLES * 2.0_f64.powf(0.5 * f64::from(pass));
        let mut number = 0;
        while let Some(&node) = self.nodes.get(number) {
            if let Node::Place(at) = node
                && let Some(place) = self.list.get_mut(at as usize)
                && place.samples > most
                && place.depth < MOST_DEPTH
            {
                place.samples *= 0.5;
                place.depth += 1;
                let upper = place.clone();
                self.nodes[number] = Node::Halves(self.nodes.len() as u32);
                self.nodes.extend([Node::Place(at), Node::Place(self.list.len() as u32)]);
                self.list.push(upper);
            }
            number += 1;
        }
        self.list.iter_mut().for_each(|place| place.samples = 0.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_part_where_samples_are_many() {
        let mut places = Places::new(2, (Vec3::ZERO, Vec3::new(4.0, 2.0, 1.0)));
        let at = |x: f32| Vec3::new(x, 0.3, 0.2);
        assert_eq!(places.of_point(at(0.1), Vec3::Z), places.of_point(at(3.9), Vec3::Z));
        assert_ne!(places.of_point(at(0.1), Vec3::Z), places.of_point(at(0.1), Vec3::NEG_Z));
        let place = places.of_point(at(0.1), Vec3::Z);
        let sight = Sight { place, square: [0.1, 0.7], light_w_m2: 2.0 };
        places.see(&[vec![sight; 3 * MOST_SAMPLES as usize], vec![Sight { place: 0, ..sight }]]);
        places.learn(0);
        // Halved along x and, as each half still has 1.5 times as many, along y.
        assert_ne!(places.of_point(at(0.1), Vec3::Z), places.of_point(at(3.9), Vec3::Z));
        assert_eq!(places.list.len(), 2 + SIDES + 3);
        let known = |place| places.known(place).map(|place| place.known.total());
        assert_eq!(known(places.of_point(at(3.9), Vec3::Z)), Some(6.0 * MOST_SAMPLES));
        assert_eq!((known(places.of_sensor(0)), known(places.of_sensor(1))), (Some(2.0), None));
        assert_eq!(known(places.of_point(at(0.1), Vec3::X)), None);
    }
}
