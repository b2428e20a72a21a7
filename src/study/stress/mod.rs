//! Where do methods fail, and does a user see it?
//!
//! What should not change an estimate is changed, and what is known to be hard is asked for. [`given`] disturbs a scene:
//! the lattice is shifted, the scene turned, voxels made coarser and finer, walls roughened, reflectances set, seeds changed.
//! [`built_in`] asks at scenes made for one failure each: thin walls, keyholes, ties, dead ends, halls, solids, leaks. Each
//! gives a [`Row`] a method: by which factors the answers moved, how far they are from the truth, what became of the
//! sensors, and which warnings a user reads.
//!
//! Limits: scenes show failures, they do not bound them; the truth of disturbed walls and of the built-in scenes is our own
//! path tracer's, at a stated number of samples, and sensors that it does not know to 10% count nowhere.

pub mod asked;
pub mod boxes;
pub mod built_in;
pub mod disturb;
pub mod given;
pub mod rough;
pub mod scenes;
pub mod tally;

pub use tally::{Row, Spread, Statuses};

/// Ways to fail, in the order of the tables.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Failure {
    /// The lattice is shifted by parts of a voxel.
    GridShift,
    /// The whole scene is turned.
    Turn,
    /// The seed of the random numbers is another.
    Seed,
    /// Voxels are coarser and finer.
    VoxelSize,
    /// Walls are rough.
    WallNoise,
    /// All walls have one reflectance, from black to white.
    Reflectance,
    /// A wall of half a voxel, or of no thickness, parts light and dark.
    ThinWall,
    /// An opening of four voxels down to half a voxel.
    Keyhole,
    /// One opening, voxels from its width down to an eighth of it.
    Opening,
    /// Two paths of one length.
    Tie,
    /// A passage that ends.
    DeadEnd,
    /// A hall of 40 x 40 x 4 m.
    Hall,
    /// Many rooms away from the light, dark walls.
    DarkRooms,
    /// Lights or sensors inside matter.
    InSolid,
    /// Voids that nothing joins.
    SeparateVoids,
    /// A void that reaches the outside.
    Leak,
    /// Matter that touches no wall.
    FloatingSolid,
    /// A light within a voxel of a wall.
    NearWall,
}

impl Failure {
    /// All of them, in the order of the tables.
    pub const ALL: [Failure; 18] = [
        Failure::GridShift,
        Failure::Turn,
        Failure::Seed,
        Failure::VoxelSize,
        Failure::WallNoise,
        Failure::Reflectance,
        Failure::ThinWall,
        Failure::Keyhole,
        Failure::Opening,
        Failure::Tie,
        Failure::DeadEnd,
        Failure::Hall,
        Failure::DarkRooms,
        Failure::InSolid,
        Failure::SeparateVoids,
        Failure::Leak,
        Failure::FloatingSolid,
        Failure::NearWall,
    ];

    /// Its name in files and on the command line.
    pub const fn name(self) -> &'static str {
        match self {
            Failure::GridShift => "grid_shift",
            Failure::Turn => "turn",
            Failure::Seed => "seed",
            Failure::VoxelSize => "voxel_size",
            Failure::WallNoise => "wall_noise",
            Failure::Reflectance => "reflectance",
            Failure::ThinWall => "thin_wall",
            Failure::Keyhole => "keyhole",
            Failure::Opening => "opening",
            Failure::Tie => "tie",
            Failure::DeadEnd => "dead_end",
            Failure::Hall => "hall",
            Failure::DarkRooms => "dark_rooms",
            Failure::InSolid => "in_solid",
            Failure::SeparateVoids => "separate_voids",
            Failure::Leak => "leak",
            Failure::FloatingSolid => "floating_solid",
            Failure::NearWall => "near_wall",
        }
    }

    /// The failure of that name.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|failure| failure.name() == name)
    }
}

impl std::fmt::Display for Failure {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        out.write_str(self.name())
    }
}

/// How much is tried.
#[derive(Debug, Clone, PartialEq)]
pub struct Trials {
    /// The failures to try.
    pub failures: Vec<Failure>,
    /// Offsets of the lattice.
    pub offsets: u32,
    /// Turns of the scene.
    pub turns: u32,
    /// Seeds beside the first.
    pub seeds: u32,
    /// Samples a sensor of a traced truth; scenes with small openings take some times as many.
    pub samples: u32,
    /// Seed of the estimates and of the disturbances.
    pub seed: u64,
    /// Bound on voxels and skeleton, bytes.
    pub max_bytes: u64,
}

impl Default for Trials {
    fn default() -> Self {
        Self {
            failures: Failure::ALL.into(),
            offsets: 16,
            turns: 8,
            seeds: 8,
            samples: 4096,
            seed: 0,
            max_bytes: u64::MAX,
        }
    }
}
