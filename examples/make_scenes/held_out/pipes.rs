//! Round tunnels with a bend, two chambers, a riser and a narrow blind end: curved walls throughout.

use glam::{DVec2, DVec3};

use crate::isosurface::Samples;
use crate::scene::{Light, Scene, Table, Variant, planar, scalar};
use crate::seen::seen;

/// The lattice of the surface: some 25 sides about a pipe of 1.2 m radius.
const STEP_M: f64 = 0.3;

/// Straight pipes, ending flat: both ends and the radius. The first runs into the bend, the second out of it into the
/// first chamber, the third to the second chamber; then the riser on the first, and the blind end.
const PIPES: [(DVec3, DVec3, f64); 5] = [
    (DVec3::new(0.1, 0.0, 0.0), DVec3::new(9.0 + OVERLAP_M, 0.0, 0.0), 1.21),
    (DVec3::new(12.0, 3.0 - OVERLAP_M, 0.0), DVec3::new(12.0, 9.3, 0.0), 1.21),
    (DVec3::new(12.1, 10.4, 0.3), DVec3::new(4.1, 10.1, -0.7), 1.13),
    (DVec3::new(4.3, 0.2, 0.2), DVec3::new(3.7, 1.3, 5.3), 0.83),
    (DVec3::new(3.7, 9.6, -0.4), DVec3::new(1.1, 6.1, 1.7), 0.83),
];

/// Chambers: centre and radius.
const CHAMBERS: [(DVec3, f64); 2] = [(DVec3::new(12.1, 10.4, 0.3), 2.37), (DVec3::new(3.9, 10.0, -0.6), 1.63)];

/// The bend between the first two pipes, a quarter of a torus: centre, radius of the axis, radius of the pipe.
const BEND: (DVec3, f64, f64) = (DVec3::new(9.0, 3.0, 0.0), 3.0, 1.21);

/// How far the bend and its pipes reach into each other: enough to be one, so little that the pipe shows 3 mm of it.
const OVERLAP_M: f64 = 0.13;

/// Metres inside the void; negative in matter.
fn depth_m(p: DVec3) -> f64 {
    let chambers = CHAMBERS.iter().map(|(centre, radius)| radius - p.distance(*centre));
    let pipes = PIPES.iter().map(|(a, b, radius)| {
        let (length, axis) = (a.distance(*b), (*b - *a).normalize());
        let along = (p - *a).dot(axis);
        (radius - (p - *a - axis * along).length()).min(along.min(length - along))
    });
    let (centre, bend_radius, radius) = BEND;
    let from = p - centre;
    let flat = from.truncate();
    let ring = radius - DVec2::new(flat.length() - bend_radius, from.z).length();
    // The quarter from south to east.
    let bend = ring.min(flat.x + OVERLAP_M).min(OVERLAP_M - flat.y);
    chambers.chain(pipes).fold(bend, f64::max)
}

/// The pipes.
pub fn pipes() -> Result<Scene, String> {
    let (low, high) = (DVec3::new(-0.63, -1.91, -3.11), DVec3::new(15.1, 13.5, 6.2));
    let mesh = Samples::of(low, high, STEP_M, depth_m).surface();
    let sensors = vec![
        scalar("a_1", [3.31, -0.47, -0.31]),
        scalar("a_2", [6.17, 0.41, 0.23]),
        scalar("a_3", [8.43, -0.23, -0.57]),
        scalar("a_end", [0.53, 0.37, 0.31]),
        scalar("bend_1", [10.27, 0.31, 0.37]),
        scalar("bend_2", [11.63, 1.87, -0.29]),
        scalar("b_1", [12.37, 4.11, 0.41]),
        scalar("b_2", [11.71, 6.37, -0.43]),
        scalar("chamber_1", [12.61, 9.73, 0.87]),
        scalar("chamber_2", [13.37, 11.41, -0.53]),
        scalar("chamber_top", [11.43, 10.91, 2.03]),
        scalar("c_1", [9.03, 10.17, 0.11]),
        scalar("c_2", [6.61, 10.31, -0.51]),
        scalar("cell_1", [3.47, 10.63, -0.97]),
        scalar("cell_2", [4.23, 9.37, -0.23]),
        scalar("blind_1", [2.93, 8.57, 0.31]),
        scalar("blind_2", [2.29, 7.61, 0.73]),
        scalar("riser_1", [4.03, 0.67, 2.61]),
        scalar("riser_2", [3.91, 1.03, 4.57]),
        planar("b_free", [12.23, 7.61, 0.17], [0.48, -0.8, 0.36]),
        seen(&mesh, "a_wall", [7.23, 0.11, 0.05], [0.1, 0.7, 0.4])?,
        seen(&mesh, "bend_wall", [11.1, 0.9, 0.0], [0.5, -0.6, 0.31])?,
        seen(&mesh, "chamber_wall", [12.1, 10.4, 0.3], [0.35, 0.83, -0.33])?,
        seen(&mesh, "cell_wall", [3.9, 10.0, -0.6], [-0.71, 0.33, 0.49])?,
    ];
    Ok(Scene {
        name: "pipes",
        mesh,
        materials: vec![],
        lights: vec![Light::Point { position: DVec3::new(1.87, 0.23, 0.37), flux_w: 80.0 }],
        voxel_m: 0.1,
        tables: vec![Table {
            file: "sensors.csv",
            about: "a_*: in the lit pipe; bend_*, b_*: past the bend; chamber_*, c_*, cell_*, blind_*: ever deeper; riser_*: in\n\
                    the pipe that rises from a. Those with a normal are irradiance, 1 mm off their wall, *_free in the air.",
            sensors,
        }],
        variants: vec![Variant {
            name: "pipes",
            about: "Round pipes of three widths, a bend, two spherical chambers, a riser, a blind end; one light.",
            reflectance: 0.7,
            sensors: "sensors.csv",
            reference: "reference.csv",
        }],
    })
}
