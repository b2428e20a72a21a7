//! What answers are made from: the sky of a site's period, and the mesh with its parts changed.

use crate::results::Failed;
use lightvein::daylight::dynamic::{Disturbance, changed};
use lightvein::export::sun_path::SunPath;
use lightvein::job::{Cancel, Progress};
use lightvein::rays::Rays;
use lightvein::scene::parts::{Change, Edit};
use lightvein::scene::{Scene, Site};
use lightvein::sky::map::{ExposureMap, MapSettings};
use lightvein::sky::site::Outdoors;
use lightvein::sky::sun::SunError;
use lightvein::sky::weather::Weather;
use std::borrow::Cow;
use std::sync::Arc;

/// Sun and sky of a site's period.
#[derive(Debug)]
pub struct Sky {
    /// The site as it was asked for.
    pub site: Site,
    /// The site with all decided that it leaves open.
    pub outdoors: Outdoors,
    /// The sun's paths over the place in a year.
    pub sun_path: Arc<SunPath>,
    /// What comes from each direction over the period.
    pub map: ExposureMap,
    /// What a reader of it should know, a sentence each.
    pub warnings: Vec<String>,
}

impl Sky {
    /// The sky of a site. What the sky `before` has of it already, weather and sun paths, is taken from there.
    ///
    /// # Errors
    /// Broken weather, a place that nobody names or that is out of bounds; [`Failed::Cancelled`].
    pub fn of(site: &Site, before: Option<&Self>, progress: &dyn Progress, cancel: &Cancel) -> Result<Self, Failed> {
        let known = before.filter(|before| before.site.weather == site.weather);
        let weather = match (&site.weather, known) {
            (Some(_), Some(known)) => known.outdoors.weather.clone(),
            (Some(path), None) => Some(Weather::load(path, progress, cancel)?),
            (None, _) => None,
        };
        let mut warnings = weather.as_ref().map_or_else(Vec::new, |weather| weather.warnings.clone());
        let outdoors = Outdoors::of(site, weather).map_err(anyhow::Error::from)?;
        let steps = outdoors.steps_unless(cancel).map_err(of_sun)?;
        warnings.extend(steps.warnings.iter().cloned());
        let settings = MapSettings { model: outdoors.model, haze: outdoors.haze, ..MapSettings::default() };
        let map = ExposureMap::build(&steps, &settings, progress, cancel)?;

        let (place, year) = (outdoors.place, outdoors.year);
        let same = before.filter(|before| (before.outdoors.place, before.outdoors.year) == (place, year));
        let sun_path = match same {
            Some(before) => Arc::clone(&before.sun_path),
            None => Arc::new(SunPath::of(&place, year).map_err(of_sun)?),
        };
        Ok(Self { site: site.clone(), outdoors, sun_path, map, warnings })
    }

    /// What comes from each texel of the map, kWh/m2/sr: sky and sun, rows from the horizon up.
    pub fn radiances(&self) -> Vec<f32> {
        let map = &self.map;
        let [columns, _] = map.size;
        let texels = map.diffuse_kwh_m2.iter().zip(&map.direct_kwh_m2).enumerate();
        texels.map(|(at, (sky, sun))| (sky + sun) / map.solid_angle_sr(at / columns.max(1)) as f32).collect()
    }

    /// What comes from a direction, kWh/m2/sr; azimuth clockwise from true north.
    pub fn radiance_at(&self, azimuth_rad: f64, elevation_rad: f64) -> f32 {
        let [column, row] = self.map.texel(azimuth_rad, elevation_rad);
        let at = row * self.map.size[0] + column;
        let energy = |energies: &[f32]| energies.get(at).copied().unwrap_or(0.0);
        let both_kwh_m2 = energy(&self.map.diffuse_kwh_m2) + energy(&self.map.direct_kwh_m2);
        both_kwh_m2 / self.map.solid_angle_sr(row) as f32
    }
}

fn of_sun(error: SunError) -> Failed {
    match error {
        SunError::Cancelled(_) => Failed::Cancelled,
        error => Failed::Because(error.into()),
    }
}

/// The mesh as its file has it, and with its parts changed.
#[derive(Debug)]
pub struct Scenery {
    /// The scene as its file has it.
    pub scene: Arc<Scene>,
    /// What rays hit of it.
    pub rays: Arc<Rays>,
    /// What was done to its parts.
    pub edits: Vec<(String, Edit)>,
    /// What became of it thereby; `None` where nothing was done.
    pub changed: Option<Changed>,
}

/// What edits made of a mesh.
#[derive(Debug)]
pub struct Changed {
    /// The parts that they concern.
    pub changes: Vec<Change>,
    /// What rays hit now.
    pub rays: Rays,
    /// Where that differs from before.
    pub disturbance: Disturbance,
}

impl Scenery {
    /// A scene with edits. The rays of the scenery `before` serve again where they are of the same scene.
    ///
    /// # Errors
    /// An edit that cannot be.
    pub fn of(scene: &Arc<Scene>, edits: &[(String, Edit)], before: Option<&Self>) -> Result<Self, Failed> {
        let same = before.filter(|before| Arc::ptr_eq(&before.scene, scene));
        let rays = same.map_or_else(|| Arc::new(Rays::new(scene)), |before| Arc::clone(&before.rays));
        let changes = scene.changes(edits).map_err(anyhow::Error::from)?;
        let changed = (!edits.is_empty()).then(|| {
            let (rays, disturbance) = changed(scene, &rays, &changes);
            Changed { changes, rays, disturbance }
        });
        Ok(Self { scene: Arc::clone(scene), rays, edits: edits.to_vec(), changed })
    }

    /// Whether it is of this scene with these edits.
    pub fn is_of(&self, scene: &Arc<Scene>, edits: &[(String, Edit)]) -> bool {
        Arc::ptr_eq(&self.scene, scene) && self.edits == edits
    }

    /// What rays hit now.
    pub fn rays_now(&self) -> &Rays {
        self.changed.as_ref().map_or(&self.rays, |changed| &changed.rays)
    }

    /// The scene as it is now.
    pub fn scene_now(&self) -> Cow<'_, Scene> {
        match &self.changed {
            Some(changed) => Cow::Owned(self.scene.changed(&changed.changes)),
            None => Cow::Borrowed(&self.scene),
        }
    }
}
