//! Which voids are there, and who stands in which?
//!
//! Lights are resolved and flooded first; sensors then prefer the void of a light that they see over a pocket of their
//! own. Voids that no light reaches are flooded from the sensors in them, so that a sensor has a void even in the dark.

use super::bits::BitGrid;
use super::flood::{self, Flood, Reached};
use super::seeds::{self, Ground, Lost, Place, Seed, Seeds};
use crate::job::{Cancel, Cancelled};
use crate::space::VoxelIndex;

/// A void: voxels that 26-connected steps join.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct VoidPart {
    /// How many voxels it has.
    pub voxels: usize,
    /// Whether it reaches the outermost layer of the grid, which then bounds it.
    pub leaks: bool,
    /// The lights and emissive patches in it, as numbered in [`Seeds::lights`].
    pub lights: Vec<usize>,
    /// The sensors in it.
    pub sensors: Vec<usize>,
}

impl VoidPart {
    fn new(reached: Reached) -> Self {
        Self { voxels: reached.voxels, leaks: reached.leaks, lights: Vec::new(), sensors: Vec::new() }
    }
}

/// The voxel of a light or sensor.
type Found = Result<VoxelIndex, Lost>;

/// The void of the lights that stand in the open, if there are others: on a wall or in a beam, those prefer it to a hollow
/// behind the face that they lie on. Where no light stands in the open, the void of the sensors that do.
fn void_of_free(lights: &[Place], sensors: &[Place], ground: &Ground) -> BitGrid {
    let voxel = |place: &Place| ground.lattice.voxel_at(place.point_m);
    let mut flood = Flood::new(ground.solid);
    if lights.iter().any(|light| ground.solid.get(voxel(light))) {
        lights.iter().for_each(|light| _ = flood.flood(voxel(light)));
        if flood.void().is_empty() {
            sensors.iter().for_each(|sensor| _ = flood.flood(voxel(sensor)));
        }
    }
    flood.into_void()
}

/// All void voxels, the voids they make up (those of lights first), and which light and sensor stands in which. Without
/// lights and sensors the largest enclosed void. Costs one flood, two where lights stand in several voids.
///
/// # Errors
/// [`Cancelled`] when `cancel` was raised.
pub fn parted(
    ground: &Ground,
    lights: &[Place],
    sensors: &[Place],
    cancel: &Cancel,
) -> Result<(BitGrid, Vec<VoidPart>, Seeds), Cancelled> {
    let mut flood = Flood::new(ground.solid);
    let mut voids = Vec::new();
    if lights.is_empty() && sensors.is_empty() {
        let largest = flood::largest_void(ground.solid).and_then(|largest| flood.flood(largest.from));
        voids.extend(largest.map(VoidPart::new));
    }

    let lights = seeds::resolved(lights, ground, &void_of_free(lights, sensors, ground), cancel)?;
    let part_of_light = flooded(&lights, &mut flood, &mut voids);
    let lit = voids.len();
    let sensors = seeds::resolved(sensors, ground, flood.void(), cancel)?;
    let mut part_of_sensor = flooded(&sensors, &mut flood, &mut voids);

    // Sensors in the void of a light: of the only one, or found out by flooding in the same order again.
    match lit {
        0 => {}
        1 => part_of_sensor.iter_mut().for_each(|part| _ = part.get_or_insert(0)),
        _ => {
            cancel.check()?;
            let all: Vec<Found> = lights.iter().chain(&sensors).copied().collect();
            part_of_sensor = flooded(&all, &mut Flood::new(ground.solid), &mut Vec::new()).split_off(lights.len());
        }
    }

    let lights = seeds_of(&lights, &part_of_light);
    let sensors = seeds_of(&sensors, &part_of_sensor);
    for (number, part) in voids.iter_mut().enumerate() {
        part.lights = numbers_in(number, &lights);
        part.sensors = numbers_in(number, &sensors);
    }
    Ok((flood.into_void(), voids, Seeds { lights, sensors }))
}

/// Floods the voids of voxels that are not flooded yet, appends them to `voids`, and gives for each voxel the number of its
/// void; `None` where it is lost, or was flooded before.
fn flooded(found: &[Found], flood: &mut Flood, voids: &mut Vec<VoidPart>) -> Vec<Option<usize>> {
    let known = |found: &Found, flood: &Flood| found.is_ok_and(|voxel| flood.void().get(voxel));
    let mut left: Vec<usize> = (0..found.len()).filter(|&number| !known(&found[number], flood)).collect();
    let mut part_of = vec![None; found.len()];
    for &voxel in found.iter().flatten() {
        let Some(reached) = flood.flood(voxel) else { continue };
        left.retain(|&number| {
            let here = known(&found[number], flood);
            if here {
                part_of[number] = Some(voids.len());
            }
            !here
        });
        voids.push(VoidPart::new(reached));
    }
    part_of
}

fn seeds_of(found: &[Found], part_of: &[Option<usize>]) -> Vec<Result<Seed, Lost>> {
    let pairs = found.iter().zip(part_of);
    let seeds = pairs.map(|(found, part)| {
        let voxel = (*found)?;
        part.map(|part| Seed { voxel, part }).ok_or(Lost::InSolid)
    });
    seeds.collect()
}

fn numbers_in(part: usize, seeds: &[Result<Seed, Lost>]) -> Vec<usize> {
    let numbered = seeds.iter().enumerate();
    numbered.filter(|(_, seed)| seed.is_ok_and(|seed| seed.part == part)).map(|(number, _)| number).collect()
}

/// What a reader should know of voids and seeds, a sentence each.
pub fn warnings(voids: &[VoidPart], seeds: &Seeds) -> Vec<String> {
    let leaks = voids.iter().enumerate().filter(|(_, part)| part.leaks);
    let leaks = leaks.map(|(number, VoidPart { voxels, .. })| {
        format!("void {number} ({voxels} voxels) leaks: it reaches the box around the mesh, which bounds it")
    });
    let mut warnings: Vec<String> = leaks.collect();

    let lit = voids.iter().filter(|part| !part.lights.is_empty()).count();
    if lit > 1 {
        warnings.push(format!("the lights stand in {lit} separate voids, and none passes to another"));
    }
    let dark: usize = voids.iter().filter(|part| part.lights.is_empty()).map(|part| part.sensors.len()).sum();
    if dark > 0 && lit > 0 {
        warnings.push(format!("{dark} sensor(s) stand in voids that no light reaches"));
    }
    for (what, found) in [("light", &seeds.lights), ("sensor", &seeds.sensors)] {
        for (lost, why) in
            [(Lost::InSolid, "inside matter, facing no void"), (Lost::Outside, "outside the box around the mesh")]
        {
            let numbers: Vec<usize> = (0..found.len()).filter(|&number| found[number] == Err(lost)).collect();
            if !numbers.is_empty() {
                warnings.push(format!("{} {what}(s) lie {why}: {}", numbers.len(), first_few(&numbers)));
            }
        }
    }
    warnings
}

/// The first few numbers, counted from 1, and whether there are more.
fn first_few(numbers: &[usize]) -> String {
    const FEW: usize = 8;
    let told: Vec<String> = numbers.iter().take(FEW).map(|number| format!("number {}", number + 1)).collect();
    told.join(", ") + if numbers.len() > FEW { ", ..." } else { "" }
}
