//! Where is matter, and where is the void that light fills?
//!
//! [`voxelise`] turns a scene into [`Voxels`]: the solid voxels that the mesh [touches](touch), what each holds of the
//! [surface], and the void that 26-connected [floods](flood) reach from lights and sensors. Everything on the regular grid is
//! kept as [bits], 64 voxels, a brick of 4 x 4 x 4, to a word. Conservative voxels keep walls closed at any angle, and
//! cost openings: one needs more than two voxels to stay open.

pub mod bits;
pub mod brick;
pub mod chessboard;
pub mod closed;
pub mod cut;
pub mod euclid;
pub mod flood;
pub mod groups;
pub mod levels;
pub mod march;
pub mod memory;
pub mod morphology;
pub mod opening;
pub mod parts;
pub mod seeds;
pub mod surface;
#[cfg(test)]
pub(crate) mod test_scenes;
pub mod touch;

use crate::job::{Cancel, Cancelled, Progress};
use crate::rays::Rays;
use crate::scene::Scene;
use crate::space::Lattice;
use bits::BitGrid;
use closed::ClosedOpening;
use memory::Memory;
use morphology::Neighbours;
use parts::VoidPart;
use seeds::{Ground, Place, Seed, Seeds};
use surface::SurfaceVoxels;

/// A scene on a grid of voxels.
#[derive(Debug, Clone, PartialEq)]
pub struct Voxels {
    /// Where the grid lies: around the box of the mesh, with a voxel to spare on every side.
    pub lattice: Lattice,
    /// Voxels that the mesh touches.
    pub solid: BitGrid,
    /// Voxels of all voids in [`Voxels::voids`].
    pub void: BitGrid,
    /// What each solid voxel holds of the mesh.
    pub surface: SurfaceVoxels,
    /// The voids that lights and sensors stand in, those of lights first; without any light or sensor the largest
    /// enclosed void alone.
    pub voids: Vec<VoidPart>,
    /// Where lights and sensors stand.
    pub seeds: Seeds,
    /// Openings beside the void that light passes and the grid closes, the largest first.
    pub closed: Vec<ClosedOpening>,
    /// What a reader should know, a sentence each.
    pub warnings: Vec<String>,
}

/// Why a scene could not be voxelised.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum VoxelError {
    /// There is nothing to voxelise.
    #[error("the scene has no triangles to voxelise")]
    NoMesh,
    /// The voxel size makes no grid.
    #[error("a voxel of {voxel_m} m is not a positive length")]
    VoxelSize {
        /// The size asked for, metres.
        voxel_m: f32,
    },
    /// The voxels are larger than the mesh.
    #[error(
        "voxels of {voxel_m:?} m are larger than the mesh, {longest_m} m at its longest: none of its voids would stay open"
    )]
    TooCoarse {
        /// The size asked for, metres.
        voxel_m: f32,
        /// The longest side of the mesh, metres.
        longest_m: f32,
    },
    /// The grid would not fit.
    #[error(
        "voxels of {voxel_m:?} m make a grid of {} x {} x {} that takes {} with its skeleton; the bound is {} \
         and {} voxels: --voxel {fitting_m} would fit",
        size[0], size[1], size[2], memory::in_words(*needed_bytes), memory::in_words(*most_bytes as f64), memory::MOST_VOXELS
    )]
    TooLarge {
        /// The size asked for, metres.
        voxel_m: f32,
        /// Voxels along x, y and z.
        size: [usize; 3],
        /// What voxels and skeleton would take, bytes.
        needed_bytes: f64,
        /// The bound, bytes.
        most_bytes: u64,
        /// The smallest size of two digits that fits, metres.
        fitting_m: f32,
    },
    /// Somebody asked to stop.
    #[error(transparent)]
    Cancelled(#[from] Cancelled),
}

/// Voxelises a scene with voxels of edge `voxel_m` (metres) and floods its void from the lights of the scene, `patches` (one
/// place for each patch of emissive faces: [`Place::of_patch`]) and the sensors. The stages "voxels", "flood" and "openings" are
/// reported to `progress`. The same bits for any number of threads.
///
/// # Errors
/// [`VoxelError`] for a scene without triangles, a size that is not positive or above that of the mesh, a grid that with its skeleton would take more
/// than `most_bytes` (nothing was allocated then), and when `cancel` was raised.
pub fn voxelise(
    scene: &Scene,
    rays: &Rays,
    patches: &[Place],
    voxel_m: f32,
    most_bytes: u64,
    progress: &dyn Progress,
    cancel: &Cancel,
) -> Result<Voxels, VoxelError> {
    voxelise_on(fitting_lattice(scene, voxel_m, most_bytes)?, scene, rays, patches, progress, cancel)
}

/// The same on a lattice of one's own: [`Lattice::around`] the mesh, or that [shifted](Lattice::shifted). Memory is not
/// bounded.
///
/// # Errors
/// [`VoxelError::Cancelled`] when `cancel` was raised.
pub fn voxelise_on(
    lattice: Lattice,
    scene: &Scene,
    rays: &Rays,
    patches: &[Place],
    progress: &dyn Progress,
    cancel: &Cancel,
) -> Result<Voxels, VoxelError> {
    let (solid, surface) = surface::voxelised(scene, &lattice, progress, cancel)?;

    progress.begin("flood", 0);
    let lights: Vec<Place> = scene.lights.iter().map(Place::of_light).chain(patches.iter().copied()).collect();
    let sensors: Vec<Place> = scene.sensors.iter().map(Place::of_sensor).collect();
    let ground = Ground { lattice: &lattice, solid: &solid, rays };
    let (void, voids, seeds) = parts::parted(&ground, &lights, &sensors, cancel)?;
    progress.end();

    progress.begin("openings", 0);
    let closed = closed::closed_openings(&ground, &surface, &void, cancel)?;
    progress.end();

    let mut warnings = parts::warnings(&voids, &seeds);
    warnings.extend(closed::warning(&closed, scene, lattice.voxel_m));
    Ok(Voxels { lattice, solid, void, surface, voids, seeds, closed, warnings })
}

impl Voxels {
    /// Checks what holds for all voxels, and names the first that does not: solid and void are disjoint, the void is closed
    /// under 26-connected steps through free voxels, each solid voxel has its patch, the voids make up the void, and every
    /// seed stands in the void.
    ///
    /// # Errors
    /// The name of the first broken invariant.
    pub fn validate(&self) -> Result<(), &'static str> {
        let size = self.lattice.size;
        let sizes = [self.solid.size(), self.void.size()];
        ensure(sizes == [size; 2], "grids have the lattice's size")?;

        let mut beside = morphology::dilate(&self.void, Neighbours::All);
        beside.and_not(&self.void);
        beside.and_not(&self.solid);
        ensure(beside.is_empty(), "the void is closed under steps to free neighbours")?;
        let mut both = self.void.clone();
        both.and(&self.solid);
        ensure(both.is_empty(), "solid and void are disjoint")?;

        ensure(self.surface.patches().len() == self.solid.count(), "each solid voxel has a patch")?;
        let voxels: usize = self.voids.iter().map(|part| part.voxels).sum();
        ensure(voxels == self.void.count(), "the voids make up the void")?;
        let mut seeds = self.seeds.lights.iter().chain(&self.seeds.sensors).flatten();
        let stands = |seed: &Seed| self.void.get(seed.voxel) && seed.part < self.voids.len();
        ensure(seeds.all(stands), "seeds stand in the void")
    }
}

fn ensure(holds: bool, name: &'static str) -> Result<(), &'static str> {
    if holds { Ok(()) } else { Err(name) }
}

/// The lattice around the mesh, once it is known to fit.
fn fitting_lattice(scene: &Scene, voxel_m: f32, most_bytes: u64) -> Result<Lattice, VoxelError> {
    let (low_m, high_m) = scene.mesh.bounds_m().ok_or(VoxelError::NoMesh)?;
    if !(voxel_m.is_finite() && voxel_m > 0.0) {
        return Err(VoxelError::VoxelSize { voxel_m });
    }
    let longest_m = (high_m - low_m).max_element();
    if voxel_m > longest_m {
        return Err(VoxelError::TooCoarse { voxel_m, longest_m });
    }
    let lattice = Lattice::around(low_m, high_m, voxel_m);
    let triangles = (0..scene.mesh.triangles.len()).filter_map(|triangle| scene.mesh.corners_m(triangle));
    let areas_m2 = triangles.map(|[a, b, c]| 0.5 * f64::from((b - a).cross(c - a).length()));
    let mesh_area_m2: f64 = areas_m2.sum();
    if memory::fits(&lattice, mesh_area_m2, most_bytes) {
        return Ok(lattice);
    }
    Err(VoxelError::TooLarge {
        voxel_m,
        size: lattice.size,
        needed_bytes: Memory::of(&lattice, mesh_area_m2).total_bytes(),
        most_bytes,
        fitting_m: memory::smallest_voxel_m(low_m, high_m, mesh_area_m2, most_bytes, voxel_m),
    })
}

#[cfg(test)]
mod tests {
    use super::test_scenes::{boxed, moved, scene_of};
    use super::*;
    use crate::job::Quiet;
    use crate::scene::{Light, Sensor};
    use glam::{EulerRot, Quat, Vec3};
    use proptest::prelude::*;

    fn lamp(at: Vec3) -> Light {
        Light::Point { position_m: at, flux_w: 1.0 }
    }

    fn sensor(at: Vec3) -> Sensor {
        Sensor { id: "a".into(), position_m: at, normal: None }
    }

    fn voxels_of(scene: &Scene, voxel_m: f32) -> Voxels {
        let rays = Rays::new(scene);
        let voxels = voxelise(scene, &rays, &[], voxel_m, 1 << 30, &Quiet, &Cancel::new()).unwrap();
        assert_eq!(voxels.validate(), Ok(()));
        voxels
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(100))]
        #[test]
        fn a_closed_box_never_leaks(
            side in prop::array::uniform3(0.6..3.0_f32),
            turn in prop::array::uniform3(-4.0..4.0_f32),
            shift in prop::array::uniform3(-50.0..50.0_f32),
            round in any::<bool>(),
        ) {
            let half = Vec3::from_array(side) / 2.0;
            let (turn, shift) = match round {
                true => (Quat::IDENTITY, (Vec3::from_array(shift) * 10.0).round() / 10.0),
                false => (Quat::from_euler(EulerRot::XYZ, turn[0], turn[1], turn[2]), Vec3::from_array(shift)),
            };
            // A box, and a wall without thickness that parts it at its middle.
            let mut triangles = boxed(-half, half);
            triangles.extend(boxed(Vec3::new(0.0, -half.y, -half.z), Vec3::new(0.0, half.y, half.z)).split_off(8));
            let mut scene = scene_of(&moved(&triangles, turn, shift));
            let aside = turn * Vec3::new(0.5 * half.x, 0.0, 0.0);
            scene.lights.extend([lamp(shift - aside), lamp(shift + aside)]);
            let voxels = voxels_of(&scene, 0.05);
            prop_assert_eq!(voxels.voids.len(), 2);
            prop_assert!(!voxels.voids[0].leaks && !voxels.voids[1].leaks);
            prop_assert_eq!(&voxels.closed, &[]);
            let area = 8.0 * (half.x * half.y + half.y * half.z + half.z * half.x) + 8.0 * half.y * half.z;
            prop_assert!((voxels.surface.area_m2() / f64::from(area) - 1.0).abs() < 1e-4);
        }
    }

    #[test]
    fn two_rooms_are_two_voids_and_a_door_joins_them() {
        let mut triangles = boxed(Vec3::ZERO, Vec3::new(4.0, 2.0, 2.0));
        let wall = |y: f32| [[2.0, y, 0.0], [2.0, 2.0, 0.0], [2.0, 2.0, 2.0], [2.0, y, 2.0]].map(Vec3::from_array);
        for (door_m, want) in [(0.0, 2), (0.6, 1)] {
            let wall = wall(door_m);
            triangles.truncate(12);
            triangles.extend([[wall[0], wall[1], wall[2]], [wall[0], wall[2], wall[3]]]);
            let mut scene = scene_of(&triangles);
            scene.lights.push(lamp(Vec3::splat(1.0)));
            scene.sensors.extend([sensor(Vec3::new(3.0, 1.0, 1.0)), sensor(Vec3::new(0.5, 0.5, 0.5))]);
            let voxels = voxels_of(&scene, 0.1);
            assert_eq!(voxels.voids.len(), want);
            assert_eq!(voxels.seeds.sensors[0].unwrap().part, want - 1);
            assert_eq!(voxels.seeds.sensors[1].unwrap().part, 0);
            assert_eq!(voxels.warnings.len(), want - 1, "{:?}", voxels.warnings);
        }
    }

    #[test]
    fn sensors_know_which_light_is_theirs() {
        let mut triangles = Vec::new();
        for i in 0..3 {
            let low = Vec3::new(3.0 * i as f32, 0.0, 0.0);
            triangles.extend(boxed(low, low + 2.0));
        }
        let mut scene = scene_of(&triangles);
        let middle = |i: usize| Vec3::new(3.0 * i as f32 + 1.0, 1.0, 1.0);
        scene.lights.extend([lamp(middle(2)), lamp(middle(0)), lamp(middle(2) + 0.5), lamp(Vec3::splat(-9.0))]);
        scene.sensors.extend([sensor(middle(0)), sensor(middle(1)), sensor(middle(2)), sensor(Vec3::splat(70.0))]);
        let voxels = voxels_of(&scene, 0.1);
        let parts: Vec<_> = voxels.voids.iter().map(|part| (part.lights.clone(), part.sensors.clone())).collect();
        assert_eq!(parts, [(vec![0, 2], vec![2]), (vec![1], vec![0]), (vec![], vec![1])]);
        assert_eq!(voxels.seeds.lights[3], Err(seeds::Lost::Outside));
        assert_eq!(voxels.seeds.sensors[3], Err(seeds::Lost::Outside));
        let told = voxels.warnings.join("; ");
        for words in ["2 separate voids", "1 sensor(s) stand in voids that no light", "1 light(s) lie outside"] {
            assert!(told.contains(words), "{told}");
        }
    }

    #[test]
    fn a_light_on_a_wall_shines_into_the_room_of_the_sensors() {
        let mut scene = scene_of(&boxed(Vec3::ZERO, Vec3::splat(2.0)));
        let places = [Vec3::new(1.0, 1.0, 0.0), Vec3::new(0.0, 1.0, 1.0), Vec3::new(1.0, 2.0, 1.0)];
        scene.lights.extend(places.map(lamp));
        scene.sensors.push(sensor(Vec3::splat(1.0)));
        let voxels = voxels_of(&scene, 0.1);
        assert_eq!((voxels.voids.len(), voxels.voids[0].leaks), (1, false));
    }

    #[test]
    fn a_box_without_a_lid_leaks_and_says_so() {
        let mut triangles = boxed(Vec3::ZERO, Vec3::splat(2.0));
        triangles.retain(|triangle| !triangle.iter().all(|corner| corner.z == 2.0));
        let mut scene = scene_of(&triangles);
        scene.lights.push(lamp(Vec3::splat(1.0)));
        let voxels = voxels_of(&scene, 0.1);
        assert!(voxels.voids[0].leaks);
        assert!(voxels.warnings[0].contains("leaks"));
    }

    #[test]
    fn a_bare_mesh_gives_its_largest_enclosed_void() {
        let mut triangles = boxed(Vec3::ZERO, Vec3::splat(2.0));
        triangles.extend(boxed(Vec3::new(5.0, 0.0, 0.0), Vec3::new(8.0, 2.0, 2.0)));
        let voxels = voxels_of(&scene_of(&triangles), 0.1);
        assert_eq!(voxels.voids.len(), 1);
        assert!(!voxels.voids[0].leaks && voxels.void.get(voxels.lattice.voxel_at(Vec3::new(6.5, 1.0, 1.0))));
    }

    #[test]
    fn broken_voxels_are_told_by_name() {
        let mut scene = scene_of(&boxed(Vec3::ZERO, Vec3::splat(1.0)));
        scene.lights.push(lamp(Vec3::splat(0.5)));
        let whole = voxels_of(&scene, 0.1);
        let centre = whole.lattice.voxel_at(Vec3::splat(0.5));
        let check = |broken: &dyn Fn(&mut Voxels), want: &str| {
            let mut voxels = whole.clone();
            broken(&mut voxels);
            assert_eq!(voxels.validate(), Err(want));
        };
        check(&|v| v.void.set(centre, false), "the void is closed under steps to free neighbours");
        check(&|v| v.solid.set(centre, true), "solid and void are disjoint");
        check(&|v| v.surface = SurfaceVoxels::default(), "each solid voxel has a patch");
        check(&|v| v.voids[0].voxels += 1, "the voids make up the void");
        check(&|v| v.seeds.lights[0] = Ok(Seed { voxel: centre, part: 1 }), "seeds stand in the void");
        check(&|v| v.void = BitGrid::new([1, 1, 1]), "grids have the lattice's size");
    }

    #[test]
    fn glazing_is_not_solid() {
        let mut scene = scene_of(&boxed(Vec3::ZERO, Vec3::splat(2.0)));
        scene.materials[0].transmittance = 0.7;
        scene.lights.push(lamp(Vec3::splat(1.0)));
        let voxels = voxels_of(&scene, 0.1);
        assert!(voxels.solid.is_empty() && voxels.voids[0].leaks);
    }

    #[test]
    fn a_sphere_keeps_its_true_area_and_normals() {
        let (rings, radius_m) = (40_u32, 1.0_f32);
        let at = |i: u32, j: u32| {
            let (polar, azimuth) =
                (i as f32 / rings as f32 * std::f32::consts::PI, j as f32 / rings as f32 * std::f32::consts::TAU);
            radius_m * Vec3::new(polar.sin() * azimuth.cos(), polar.sin() * azimuth.sin(), polar.cos())
        };
        let quads = (0..rings * rings).map(|q| (q / rings, q % rings));
        let triangles: Vec<[Vec3; 3]> = quads
            .flat_map(|(i, j)| [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]])
            .collect();
        let voxels = voxels_of(&scene_of(&triangles), 0.05);
        let area: f64 = triangles.iter().map(|[a, b, c]| f64::from((*b - *a).cross(*c - *a).length()) / 2.0).sum();
        assert!((voxels.surface.area_m2() / area - 1.0).abs() < 1e-4);
        for (voxel, patch) in voxels.solid.iter().zip(voxels.surface.patches()) {
            assert_eq!(voxels.surface.at(&voxels.solid, voxel), Some(patch));
            if patch.area_m2 > 1e-4 {
                assert!(patch.normal.dot(voxels.lattice.centre_m(voxel).normalize()) > 0.9);
                assert!((patch.reflectance - 0.5).abs() < 1e-6);
            }
        }
    }

    #[test]
    fn the_same_bits_on_one_thread_and_many() {
        let turn = Quat::from_euler(EulerRot::XYZ, 0.3, 0.7, -0.2);
        let mut triangles = moved(&boxed(Vec3::splat(-1.5), Vec3::splat(1.5)), turn, Vec3::ZERO);
        triangles.extend(moved(&boxed(Vec3::splat(-0.3), Vec3::splat(0.4)), turn.inverse(), Vec3::ZERO));
        let mut scene = scene_of(&triangles);
        scene.lights.push(lamp(Vec3::splat(0.8)));
        scene.sensors.extend((0..40).map(|i| sensor(Vec3::splat(i as f32 / 20.0 - 1.0))));
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| voxels_of(&scene, 0.05))
        };
        let one = on(1);
        assert_eq!(one, on(2));
        assert_eq!(one, on(3));
    }

    #[test]
    fn what_cannot_be_is_refused_with_its_bound() {
        let scene = scene_of(&boxed(Vec3::ZERO, Vec3::splat(2.0)));
        let rays = Rays::new(&scene);
        let try_with = |scene: &Scene, voxel_m, most_bytes| {
            voxelise(scene, &rays, &[], voxel_m, most_bytes, &Quiet, &Cancel::new()).unwrap_err()
        };
        assert_eq!(try_with(&Scene::default(), 0.1, 1 << 30), VoxelError::NoMesh);
        for bad in [0.0, -0.1, f32::NAN, f32::INFINITY] {
            assert!(matches!(try_with(&scene, bad, 1 << 30), VoxelError::VoxelSize { .. }));
        }
        let coarse = VoxelError::TooCoarse { voxel_m: 2.1, longest_m: 2.0 };
        assert_eq!(try_with(&scene, 2.1, 1 << 30), coarse);
        for tiny in [1e-3, 1e-12, f32::MIN_POSITIVE] {
            let error = try_with(&scene, tiny, 1 << 20);
            let VoxelError::TooLarge { fitting_m, .. } = error else { panic!("{error}") };
            assert!(voxelise(&scene, &rays, &[], fitting_m, 1 << 20, &Quiet, &Cancel::new()).is_ok());
            assert!(error.to_string().contains(&format!("--voxel {fitting_m} would fit")), "{error}");
        }
        let cancel = Cancel::new();
        cancel.cancel();
        let stopped = voxelise(&scene, &rays, &[], 0.1, 1 << 30, &Quiet, &cancel).unwrap_err();
        assert_eq!(stopped, VoxelError::Cancelled(Cancelled));
    }
}
