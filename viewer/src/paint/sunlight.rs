//! Sun and sky over a picture, as plain data: what lights surfaces and stands behind the scene.

use super::picture::Corner;
use crate::shadows::Settings;
use glam::Vec3;
use std::sync::Arc;

/// Sun and sky over a picture, and what they are kept off by.
#[derive(Clone, Debug, PartialEq)]
pub struct Sunlight {
    /// Their light.
    pub light: SkyLight,
    /// What casts shadows, and how; `None` where nothing is lit by the sun.
    pub shadows: Option<Shadows>,
}

/// Light of sun and sky at a moment, in scene space. Colours are linear sRGB.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkyLight {
    /// Towards the sun, of length one.
    pub towards_sun: Vec3,
    /// Radius of the sun's disc, radians.
    pub disc_radius_rad: f32,
    /// The sun's light on a surface that faces it, klx; black with the sun down.
    pub beam_klx: [f32; 3],
    /// Y (kcd/m2), x and y of the sky's zenith, each over Perez' form there.
    pub zenith: [f32; 3],
    /// A to E of Perez' form for Y, x and y.
    pub perez: [[f32; 5]; 3],
    /// What sky and ground cast on surfaces, klx, by the harmonics of `lightvein::sky::harmonics`.
    pub harmonics_klx: [[f32; 3]; 9],
    /// The ground round about, seen below the horizon, kcd/m2.
    pub ground_kcd_m2: [f32; 3],
    /// The luminance that shows at 63% of the screen's, kcd/m2.
    pub white_kcd_m2: f32,
}

impl SkyLight {
    /// Whether any of the sun's own light arrives.
    pub fn is_up(&self) -> bool {
        self.towards_sun.z > 0.0 && self.beam_klx.iter().any(|klx| *klx > 0.0)
    }
}

/// What casts shadows, and how they are found.
#[derive(Clone, Debug)]
pub struct Shadows {
    /// Triangles that keep the sun off, three corners each; compared by address.
    pub casters: Arc<Vec<Corner>>,
    /// The method.
    pub settings: Settings,
}

impl PartialEq for Shadows {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.casters, &other.casters) && self.settings == other.settings
    }
}
