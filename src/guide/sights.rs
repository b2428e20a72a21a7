//! What does each patch see along the lines?
//!
//! A line between two walls is a sight of either; glazing on it sees both ways too. The weights of a patch's sights add up to
//! all that it sees ([`Exchange::seen_m2`](crate::flow::network::exchange::Exchange::seen_m2)), so that the mean of any
//! quantity over its hemisphere by the cosine is the mean over its sights by their weight.

use crate::flow::network::lines::Line;
use crate::flow::network::read::seen_from;
use crate::flow::network::walk::End;
use glam::Vec3;

/// What a point of a patch sees in one direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sight {
    /// The patch.
    pub patch: u32,
    /// The point on it, metres.
    pub from_m: Vec3,
    /// Its unit normal there.
    pub normal: Vec3,
    /// Where it looks, unit length.
    pub direction: Vec3,
    /// How far it sees, through glazing, metres.
    pub distance_m: f32,
    /// What stands there.
    pub far: End,
    /// Pi times the radiance that walls and panes send back, W/m2.
    pub radiosity_w_m2: f64,
    /// Area times solid angle times cosine that it stands for, over pi, m2.
    pub weight_m2: f64,
}

impl Sight {
    /// The cosine between normal and direction, 0 at least.
    pub fn cosine(&self) -> f32 {
        self.normal.dot(self.direction).max(0.0)
    }
}

/// The sights of a line: of its ends and of the two sides of each pane on it, where these are patches.
pub fn sights<'a>(line: &'a Line, radiosity_w_m2: &'a [f64]) -> impl Iterator<Item = Sight> + 'a {
    let panes = line.panes.len();
    let ahead = |patch: u32, at_m: f32, normal: Vec3, panes_before: usize| Sight {
        patch,
        from_m: line.from_m + at_m * line.direction,
        normal,
        direction: line.direction,
        distance_m: line.length_m - at_m,
        far: line.ends[1],
        radiosity_w_m2: seen_from(line, panes_before, radiosity_w_m2)[1],
        weight_m2: line.weight_m2,
    };
    let behind = |patch: u32, at_m: f32, normal: Vec3, panes_before: usize| Sight {
        patch,
        from_m: line.from_m + at_m * line.direction,
        normal,
        direction: -line.direction,
        distance_m: at_m,
        far: line.ends[0],
        radiosity_w_m2: seen_from(line, panes_before, radiosity_w_m2)[0],
        weight_m2: line.weight_m2,
    };
    let of_patch = |end: End| if let End::Patch(patch) = end { Some(patch) } else { None };

    let first = of_patch(line.ends[0]).map(|patch| ahead(patch, 0.0, line.normals[0], 0));
    let last = of_patch(line.ends[1]).map(|patch| behind(patch, line.length_m, line.normals[1], panes));
    let between = line.panes.iter().enumerate().flat_map(move |(number, pane)| {
        let at_m = (pane.at.position_m - line.from_m).dot(line.direction);
        // The side that faces what comes after it.
        let onwards = pane.at.normal * pane.at.normal.dot(line.direction).signum();
        [behind(pane.sides[0], at_m, -onwards, number), ahead(pane.sides[1], at_m, onwards, number + 1)]
    });
    first.into_iter().chain(between).chain(last)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::network::{Network, Quality};
    use crate::flow::tests::{FLUX_W, lamp, model_of};
    use crate::job::{Cancel, Quiet};
    use crate::light::Settings;
    use crate::scene::{Material, Scene};
    use crate::voxel::test_scenes::{boxed, scene_of};

    /// A gallery of 8 x 2 x 2 m whose middle is crossed by a pane that passes half.
    fn glazed() -> Scene {
        let mut triangles = boxed(Vec3::ZERO, Vec3::new(8.0, 2.0, 2.0));
        triangles.extend(&boxed(Vec3::new(4.0, 0.0, 0.0), Vec3::new(4.0, 2.0, 2.0))[8..10]);
        let lights = vec![lamp(Vec3::new(1.0, 1.4, 1.5), FLUX_W)];
        let mut scene = Scene { lights, ..scene_of(&triangles) };
        scene.materials.push(Material { transmittance: 0.5, reflectance: 0.0, ..scene.materials[0].clone() });
        scene.mesh.material_of[12..].fill(1);
        scene
    }

    #[test]
    fn sights_add_up_to_what_patches_see_and_glazing_halves_what_is_behind() {
        let model = model_of(&glazed());
        let (network, lines) = Network::new(&model, &Quality::MEDIUM, &Settings::default(), &Quiet, &Cancel::new())
            .expect("nobody stops it");
        let patches = &network.grounds.patches;
        let is_behind = |patch: u32| patches.starts[patches.list[patch as usize].starts.start].position_m.x > 4.01;
        let shining: Vec<f64> =
            (0..patches.list.len() as u32).map(|patch| f64::from(u8::from(is_behind(patch)))).collect();

        let mut seen_m2 = vec![0.0; patches.list.len()];
        let (mut through, mut of_panes) = (0, 0);
        for sight in lines.iter().flat_map(|line| sights(line, &shining)) {
            seen_m2[sight.patch as usize] += sight.weight_m2;
            assert!(sight.normal.dot(sight.direction) > -1e-4, "{sight:?} looks into its wall");
            let End::Patch(far) = sight.far else { panic!("a closed room: {sight:?}") };
            let [from_x_m, to_x_m] = [0.0, sight.distance_m].map(|at_m| sight.from_m.x + at_m * sight.direction.x);
            // The side of the pane that looks on sees what is there as it is.
            let is_of_pane = sight.normal.x.abs() > 0.5 && (from_x_m - 4.0).abs() < 1e-3;
            // In f32 it does not show on which side of the pane a sight ends in the corner right beside it.
            if [from_x_m, to_x_m].iter().any(|x_m| (x_m - 4.0).abs() < 1e-3) && !is_of_pane {
                continue;
            }
            let is_through = !is_of_pane && (from_x_m < 4.0) != (to_x_m < 4.0);
            let share = if is_through { 0.5 } else { 1.0 };
            assert_eq!(sight.radiosity_w_m2, share * shining[far as usize], "{sight:?}");
            through += u32::from(is_through && sight.radiosity_w_m2 > 0.0);
            of_panes += u32::from(is_of_pane);
        }
        assert!(through > 100 && of_panes > 100, "{through} sights through the pane, {of_panes} from it");
        for (found_m2, wanted_m2) in seen_m2.iter().zip(&network.exchange.seen_m2) {
            assert!((found_m2 - wanted_m2).abs() < 1e-9 * wanted_m2, "{found_m2} is not {wanted_m2}");
        }
    }
}
