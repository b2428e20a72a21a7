//! How does the sun meet a face that was picked: its azimuth and tilt, and the horizontal and vertical shadow angle?

use super::light::in_scene;
use glam::{DVec3, Vec3};
use lightvein::sky::facade::{ShadowAngles, shadow_angles};
use lightvein::sky::{Sun, azimuth_elevation_rad};
use std::f64::consts::FRAC_PI_2;

/// Faces that lean no more than this off the level have no azimuth worth naming.
const LEVEL_RAD: f64 = 1.0 * std::f64::consts::PI / 180.0;

/// A face of the mesh that was picked, from the side that was seen.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Facade {
    /// Where it was touched, metres.
    pub at_m: Vec3,
    /// Of the side that was seen, in the scene, of length one.
    pub normal: Vec3,
}

/// How a face stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Stance {
    /// Level, its side facing up.
    Up,
    /// Level, its side facing down.
    Down,
    /// Neither.
    Facing {
        /// Where its normal points, seen from above, clockwise from true north, radians, 0 up to a whole turn.
        azimuth_rad: f64,
        /// How far the normal points up, radians; 0 for an upright wall.
        tilt_rad: f64,
    },
}

impl Facade {
    /// How it stands in a scene whose true north is that far clockwise from +Y.
    pub fn stance(&self, north_rad: f64) -> Stance {
        // Back from the scene: the turn the other way.
        let (azimuth_rad, tilt_rad) = azimuth_elevation_rad(in_scene(-north_rad, self.normal.as_dvec3()));
        if tilt_rad.abs() >= FRAC_PI_2 - LEVEL_RAD {
            return if tilt_rad > 0.0 { Stance::Up } else { Stance::Down };
        }
        Stance::Facing { azimuth_rad, tilt_rad }
    }

    /// How it stands and how the sun meets it, as rows of a table: names and values.
    pub fn rows(&self, sun: Sun, north_rad: f64) -> Vec<(&'static str, String)> {
        let mut rows = match self.stance(north_rad) {
            Stance::Up => vec![("Faces", "up: a level face has no shadow angles".to_owned())],
            Stance::Down => vec![("Faces", "down: a level face has no shadow angles".to_owned())],
            Stance::Facing { azimuth_rad, tilt_rad } => {
                let faces = format!("{} from north ({})", degrees(azimuth_rad), quarter(azimuth_rad));
                let mut rows = vec![("Faces", faces)];
                if tilt_rad.abs() > LEVEL_RAD {
                    let towards = if tilt_rad > 0.0 { "up" } else { "down" };
                    rows.push(("Leans", format!("{} {towards} from upright", degrees(tilt_rad.abs()))));
                }
                rows.extend(angles(shadow_angles(sun, azimuth_rad)));
                rows
            }
        };
        if sun.elevation_rad > 0.0 {
            rows.push(("Sun to normal", self.met(sun, north_rad)));
        }
        rows
    }

    /// The angle between the sun and the normal.
    fn met(&self, sun: Sun, north_rad: f64) -> String {
        let normal: DVec3 = in_scene(-north_rad, self.normal.as_dvec3());
        let angle_rad = normal.angle_between(sun.towards());
        let behind = if angle_rad >= FRAC_PI_2 { ": its other side is met" } else { "" };
        format!("{}{behind}", degrees(angle_rad))
    }
}

fn angles(angles: ShadowAngles) -> Vec<(&'static str, String)> {
    let aside = |horizontal_rad: f64| match horizontal_rad {
        right if right > 0.0 => format!("{} clockwise", degrees(right)),
        left => format!("{} counter-clockwise", degrees(-left)),
    };
    match angles {
        ShadowAngles::Front { horizontal_rad, vertical_rad } => {
            vec![("Horizontal (HSA)", aside(horizontal_rad)), ("Vertical (VSA)", degrees(vertical_rad))]
        }
        ShadowAngles::Behind { horizontal_rad } => {
            vec![("Horizontal (HSA)", aside(horizontal_rad)), ("Vertical (VSA)", "the sun is behind it".to_owned())]
        }
        ShadowAngles::Down => vec![("Shadow angles", "the sun is down".to_owned())],
    }
}

fn degrees(angle_rad: f64) -> String {
    format!("{:.1}°", angle_rad.to_degrees())
}

/// The name of the quarter or the half quarter that an azimuth lies in.
fn quarter(azimuth_rad: f64) -> &'static str {
    const NAMES: [&str; 8] = ["N", "NE", "E", "SE", "S", "SW", "W", "NW"];
    let eighth = (azimuth_rad.to_degrees() / 45.0).round().rem_euclid(8.0) as usize;
    NAMES.get(eighth).copied().unwrap_or("N")
}

#[cfg(test)]
mod tests {
    use super::*;
    use lightvein::sky::towards;

    fn facade(azimuth_deg: f64, tilt_deg: f64, north_deg: f64) -> Facade {
        let normal = towards(azimuth_deg.to_radians(), tilt_deg.to_radians());
        Facade { at_m: Vec3::ZERO, normal: in_scene(north_deg.to_radians(), normal).as_vec3() }
    }

    fn told(facade: Facade, sun_deg: [f64; 2], north_deg: f64) -> String {
        let [azimuth_rad, elevation_rad] = sun_deg.map(f64::to_radians);
        let rows = facade.rows(Sun { azimuth_rad, elevation_rad }, north_deg.to_radians());
        rows.iter().map(|(name, value)| format!("{name}: {value}\n")).collect()
    }

    /// The afternoon sun at 240 degrees and 30 high: 60 to the right of a south wall; tan VSA = tan 30 / cos 60.
    #[test]
    fn a_wall_has_its_angles_whichever_way_the_scene_is_turned() {
        for north_deg in [0.0, 18.0, -100.0, 270.0] {
            let south = told(facade(180.0, 0.0, north_deg), [240.0, 30.0], north_deg);
            for want in ["180.0° from north (S)", "(HSA): 60.0° clockwise", "(VSA): 49.1°", "normal: 64.3°"] {
                assert!(south.contains(want), "{north_deg}: {south}");
            }
            assert!(!south.contains("Leans"), "{south}");
        }
    }

    #[test]
    fn the_sun_may_be_behind_or_down_and_roofs_say_so() {
        let east = told(facade(90.0, 0.0, 0.0), [240.0, 30.0], 0.0);
        assert!(east.contains("(HSA): 150.0° clockwise") && east.contains("behind it"), "{east}");
        assert!(east.contains("its other side is met"), "{east}");
        let night = told(facade(90.0, 0.0, 0.0), [340.0, -20.0], 0.0);
        assert!(night.contains("the sun is down") && !night.contains("normal"), "{night}");
        let roof = told(facade(0.0, 90.0, 30.0), [180.0, 50.0], 30.0);
        assert!(roof.contains("Faces: up") && roof.contains("Sun to normal: 40.0°"), "{roof}");
        assert!(told(facade(0.0, -89.5, 0.0), [180.0, 50.0], 0.0).contains("Faces: down"));
        let pitched = told(facade(135.0, 45.0, 0.0), [135.0, 45.0], 0.0);
        assert!(pitched.contains("(SE)") && pitched.contains("Leans: 45.0° up"), "{pitched}");
        assert!(pitched.contains("Sun to normal: 0.0°"), "{pitched}");
    }
}
