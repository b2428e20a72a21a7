//! How exposure changes with latitude and turbidity, as Muñoz-Pandiella et al. 2017 show for their cities (their figure 8):
//! trends of physics, at a house alone under clear years.

use lightvein::daylight::cast::{Casting, cast};
use lightvein::daylight::{Exposure, Point};
use lightvein::job::{Cancel, Quiet};
use lightvein::rays::Rays;
use lightvein::scene::{Scene, Site};
use lightvein::sky::dome::SkyModel;
use lightvein::sky::map::{ExposureMap, MapSettings};
use lightvein::sky::site::{ClearSky, Outdoors};
use std::path::Path;

/// What a house alone receives in a clear year, kWh/m2.
#[derive(Debug, Clone, Copy)]
struct House {
    north: f64,
    east: f64,
    south: f64,
    west: f64,
    roof: f64,
}

/// The outer faces of the block of `courtyard`: facades, which see half the sky, and the roof.
fn house(latitude_deg: f64, turbidity: f64, clear_sky: ClearSky) -> House {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/outdoor/courtyard/courtyard.toml");
    let scene = Scene::load(&path, &Quiet, &Cancel::new()).unwrap();
    let faces = ["facade_north", "facade_east", "facade_south", "facade_west", "roof"];
    let points = faces.map(|face| Point::from(scene.sensors.iter().find(|sensor| sensor.id == face).expect(face)));
    let (outdoors, map) = clear_year(latitude_deg, turbidity, clear_sky, None);
    let casting = Casting { sky_rays: 1024, ..Casting::default() };
    let rays = Rays::new(&scene);
    let found = cast(&rays, &points, &map, outdoors.north_rad, casting, &Quiet, &Cancel::new()).unwrap();
    let [north, east, south, west, roof] = [0, 1, 2, 3, 4].map(|face| Exposure::total_kwh_m2(&found[face]));
    let house = House { north, east, south, west, roof };
    println!("{latitude_deg} degrees, turbidity {turbidity}, {}: {house:.0?}", clear_sky.name());
    house
}

fn clear_year(
    latitude_deg: f64,
    turbidity: f64,
    clear_sky: ClearSky,
    model: Option<SkyModel>,
) -> (Outdoors, ExposureMap) {
    let site = Site {
        latitude_deg: Some(latitude_deg),
        longitude_deg: Some(0.0),
        turbidity: Some(turbidity),
        ..Site::default()
    };
    let outdoors = Outdoors { clear_sky, ..Outdoors::of(&site, None).unwrap() };
    let model = model.unwrap_or(outdoors.model);
    let settings = MapSettings { size: [128, 64], model, haze: outdoors.haze, ..MapSettings::default() };
    let map = ExposureMap::build(&outdoors.steps().unwrap(), &settings, &Quiet, &Cancel::new()).unwrap();
    (outdoors, map)
}

/// Each is above the one before by at least this share.
#[track_caller]
fn rises(values: [f64; 4], share: f64, what: &str) {
    for pair in values.windows(2) {
        assert!(pair[1] > pair[0] * (1.0 + share), "{what} should rise: {values:.0?}");
    }
}

/// A wall that the sun hardly sees lives on the sky, which haze brightens; a roof under a low sun loses more of the beam than
/// the sky gives back. The north facade's gain levels off near turbidity 5, where the sky brightens about the sun alone, and
/// thick haze takes it back.
#[test]
fn haze_feeds_north_facades_at_30_degrees_and_starves_roofs_at_60() {
    for clear_sky in ClearSky::ALL {
        let at_30 = [2.0, 2.5, 3.0, 4.0].map(|turbidity| house(30.0, turbidity, clear_sky));
        rises(at_30.map(|house| house.north), 0.02, "the north facade at 30 degrees");
        rises(at_30.map(|house| 1.0 / house.south), 0.005, "the loss of the south facade at 30 degrees");
        let at_60 = [2.0, 3.0, 4.0, 8.0].map(|turbidity| house(60.0, turbidity, clear_sky));
        rises(at_60.map(|house| 1.0 / house.roof), 0.02, "the loss of the roof at 60 degrees");
        // Under the low sun of 60 degrees haze takes a larger share of a roof's light than at 30.
        let kept = [at_30[3].roof / at_30[0].roof, at_60[2].roof / at_60[0].roof];
        assert!(kept[1] < kept[0] - 0.02, "{kept:?}");
    }
}

/// Roofs lose with latitude. Facades to the equator gain up to the middle latitudes, since the noon sun leaves the zenith;
/// east and west are alike, for the clear sun's path is the same before and after noon.
#[test]
fn latitude_moves_light_from_roofs_to_southern_facades() {
    let houses = [0.0, 30.0, 45.0, 60.0].map(|latitude_deg| house(latitude_deg, 3.0, ClearSky::Ineichen));
    rises(houses.map(|house| 1.0 / house.roof), 0.05, "the loss of roofs");
    assert!(houses[0].south * 1.5 < houses[1].south && houses[1].south * 1.1 < houses[2].south, "{houses:.0?}");
    for house in houses {
        assert!((house.east / house.west - 1.0).abs() < 0.02, "{house:?}");
    }
    let at_equator = houses[0];
    assert!((at_equator.north / at_equator.south - 1.0).abs() < 0.1, "{at_equator:?}");
    for house in &houses[1..] {
        assert!(house.south > 1.1 * house.east && house.east > 1.5 * house.north, "{house:?}");
    }
    // Ratio of south facade to roof: from a third to as much.
    rises(houses.map(|house| house.south / house.roof), 0.2, "the south facade's share of the roof's");
}

/// The other half of the globe is the mirror of this one, but for the sun's distance, which is least in January: 3.3% more
/// or less on a midsummer's day.
#[test]
fn the_southern_half_is_the_mirror_of_the_northern() {
    let (north, south) = (house(30.0, 3.0, ClearSky::Ineichen), house(-30.0, 3.0, ClearSky::Ineichen));
    for (a, b) in
        [(north.roof, south.roof), (north.east, south.west), (north.south, south.north), (north.north, south.south)]
    {
        assert!((a / b - 1.0).abs() < 0.04, "{north:?} {south:?}");
    }
}

/// Facades and roof of a house alone without any ray: half the sky's horizontal irradiation of an isotropic sky, and the
/// cosines of the suns.
#[test]
fn an_even_sky_adds_up_by_hand() {
    for (latitude_deg, turbidity) in [(30.0, 2.0), (30.0, 8.0), (60.0, 5.0)] {
        let (outdoors, map) = clear_year(latitude_deg, turbidity, ClearSky::Ineichen, Some(SkyModel::Isotropic));
        let empty = Rays::new(&Scene::default());
        let normals = [glam::Vec3::Y, glam::Vec3::X, glam::Vec3::NEG_Y, glam::Vec3::Z];
        let points = normals.map(|normal| Point { position_m: glam::Vec3::ZERO, normal: Some(normal) });
        let found = cast(&empty, &points, &map, 0.0, Casting::default(), &Quiet, &Cancel::new()).unwrap();
        let steps = outdoors.steps().unwrap();
        for (normal, exposure) in normals.iter().zip(&found) {
            let energy = |step: &lightvein::sky::steps::Step| {
                let cosine = step.sun.towards().dot(normal.as_dvec3()).max(0.0);
                let sky_share = 0.5 * (1.0 + f64::from(normal.z));
                (step.dni_w_m2 * cosine + step.dhi_w_m2 * sky_share) * step.hours / 1000.0
            };
            let by_hand: f64 = steps.steps.iter().map(energy).sum();
            let total = exposure.total_kwh_m2();
            assert!((total / by_hand - 1.0).abs() < 0.003, "{latitude_deg} {turbidity} {normal}: {total} {by_hand}");
        }
    }
}
