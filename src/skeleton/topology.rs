//! How many pieces, loops and cavities are there?
//!
//! The Betti numbers of a void or of what thinning made of it: components are counted by uniting neighbours, cavities as
//! components of all that is left out, less one for the outside, and loops follow from the Euler characteristic, which is
//! a count of cells: `components - loops + cavities = points - edges + faces - cubes`.
//! For checks: it shares no code with the collapse, and takes four bytes a voxel.

use super::complex::{CUBES, Complex};
use super::curve::Curve;
use crate::voxel::bits::BitGrid;
use crate::voxel::groups;
use crate::voxel::morphology::Neighbours;
use glam::IVec3;

/// The Betti numbers of a set in space, and its Euler characteristic.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Topology {
    /// Pieces that hang together (the first Betti number, beta 0).
    pub components: i64,
    /// Independent loops, or tunnels (beta 1).
    pub loops: i64,
    /// Enclosed cavities (beta 2).
    pub cavities: i64,
}

impl Topology {
    /// The Euler characteristic: components less loops and with cavities.
    pub fn euler(&self) -> i64 {
        self.components - self.loops + self.cavities
    }

    fn from_counts(components: usize, cavities: usize, cells: [usize; 4]) -> Self {
        let [points, edges, faces, cubes] = cells.map(|count| count as i64);
        let (components, cavities) = (components as i64, cavities as i64);
        Self { components, loops: components + cavities - (points - edges + faces - cubes), cavities }
    }
}

/// The topology of a void, joined by faces, edges and corners of its voxels.
pub fn of_void(void: &BitGrid) -> Topology {
    let components = groups::count(void, Neighbours::All);
    let cavities = groups::count(&super::tie::floating(void), Neighbours::Six);
    Topology::from_counts(components, cavities, Complex::closure(void).count())
}

/// The topology of a complex, whatever it has lost.
pub fn of_complex(complex: &Complex) -> Topology {
    let size = complex.layout().size;
    // Points united by edges.
    let mut points = Sets::new(size.map(|voxels| voxels + 1));
    let mut alone = 0;
    // The places of cubes united by missing faces, with a layer of outside around them.
    let mut open = Sets::new(size.map(|voxels| voxels + 2));
    let [x, y, z] = size.map(|voxels| voxels as i32 + 1);
    for corner in (0..x * y * z).map(|i| IVec3::new(i % x, i / x % y, i / (x * y))) {
        alone += i64::from(complex.has(corner, 0));
        for axis in 0..3 {
            if complex.has(corner, 1 << axis) {
                alone -= i64::from(points.unite(corner, corner + IVec3::AXES[axis]));
            }
        }
    }
    let mut holes = 0;
    for cube in (0..(x + 1) * (y + 1) * (z + 1))
        .map(|i| IVec3::new(i % (x + 1), i / (x + 1) % (y + 1), i / ((x + 1) * (y + 1))))
    {
        // Cube places are numbered one above the lattice's, so that the outside below has a place.
        holes += i64::from(!complex.has(cube - 1, CUBES));
        for axis in 0..3 {
            if cube[axis] > 0 && !complex.has(cube - 1, CUBES ^ 1 << axis) {
                let below = cube - IVec3::AXES[axis];
                let both = !complex.has(cube - 1, CUBES) && !complex.has(below - 1, CUBES);
                holes -= i64::from(both && open.unite(cube, below));
            }
        }
    }
    Topology::from_counts(alone as usize, (holes - 1) as usize, complex.count())
}

/// The topology of a curve.
pub fn of_curve(curve: &Curve) -> Topology {
    let mut sets = Sets::new([curve.vertices.len(), 1, 1]);
    let at = |vertex: u32| IVec3::new(vertex as i32, 0, 0);
    let united = curve.edges.iter().filter(|[a, b]| sets.unite(at(*a), at(*b))).count();
    let components = curve.vertices.len() - united;
    Topology::from_counts(components, 0, [curve.vertices.len(), curve.edges.len(), 0, 0])
}

/// Disjoint sets of the points of a grid.
struct Sets {
    size: [usize; 3],
    parents: Vec<u32>,
}

impl Sets {
    fn new(size: [usize; 3]) -> Self {
        Self { size, parents: (0..size.iter().product::<usize>() as u32).collect() }
    }

    /// Unites the sets of two points; whether they were apart.
    fn unite(&mut self, a: IVec3, b: IVec3) -> bool {
        let index = |at: IVec3| at.x as usize + self.size[0] * (at.y as usize + self.size[1] * at.z as usize);
        let (a, b) = (index(a) as u32, index(b) as u32);
        let (a, b) = (self.root(a), self.root(b));
        self.parents[a.max(b) as usize] = a.min(b);
        a != b
    }

    fn root(&mut self, mut at: u32) -> u32 {
        while self.parents[at as usize] != at {
            let next = self.parents[at as usize];
            self.parents[at as usize] = self.parents[next as usize];
            at = next;
        }
        at
    }
}
