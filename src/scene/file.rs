//! What does a scene file say?
//!
//! TOML, every key known, every number within its bounds; what breaks this is reported with its line. The result is a
//! [`Description`]: checked, in metres, Z up, but nothing it names has been opened. All positions of a scene file are in
//! metres, Z up; `unit_m` and `up` describe the mesh files alone.

use super::error::{Kind, SceneError};
use super::input::{FARTHEST_M, Input, line_of, without_mark};
use super::{Method, ModelChoice, Site};
use glam::DVec3;
use serde::Deserialize;
use std::ops::Range;
use std::path::PathBuf;
use toml::Spanned;

/// A value together with the line it was found in.
#[derive(Debug, Clone, PartialEq)]
pub struct Lined<T> {
    /// The value.
    pub value: T,
    /// Its line in the scene file.
    pub line: usize,
}

/// A scene file, checked.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Description {
    /// Its `name`.
    pub name: Option<String>,
    /// Mesh files as written; at least one.
    pub meshes: Vec<Lined<String>>,
    /// Metres a mesh unit.
    pub unit_m: f64,
    /// The meshes' up axis; `None` leaves it to the format of each (glTF: Y, others: Z).
    pub up: Option<Up>,
    /// Reflectance where a mesh's material gives none.
    pub reflectance: f32,
    /// Overrides of materials, in order.
    pub overrides: Vec<Lined<Override>>,
    /// Lights in metres, not recentred.
    pub lights: Vec<DescribedLight>,
    /// Sensor file.
    pub sensors: Option<Lined<String>>,
    /// Reference file.
    pub reference: Option<Lined<String>>,
    /// `[model]`.
    pub model: ModelChoice,
    /// `[site]`; its weather file as written.
    pub site: Option<Site>,
    /// Line of the weather file's name.
    pub weather_line: usize,
}

/// Which axis of a mesh points up.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Up {
    /// Y: (x, y, z) becomes (x, -z, y).
    Y,
    /// Z: nothing changes.
    Z,
}

/// What `[[materials]]` says of all materials whose name it matches.
#[derive(Debug, Clone, PartialEq)]
pub struct Override {
    /// Name; a trailing `*` matches the rest.
    pub pattern: String,
    /// Diffuse reflectance.
    pub reflectance: Option<f32>,
    /// Share passed straight on.
    pub transmittance: Option<f32>,
    /// Radiance given off, W/m2/sr.
    pub emission_w_m2_sr: Option<f32>,
}

impl Override {
    /// Whether it speaks of the material of that name.
    pub fn matches(&self, name: &str) -> bool {
        match self.pattern.strip_suffix('*') {
            Some(start) => name.starts_with(start),
            None => name == self.pattern,
        }
    }
}

/// A light in double precision: it is recentred with the mesh.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DescribedLight {
    /// See `Light::Point`.
    Point {
        /// Metres.
        position_m: DVec3,
        /// Total, W.
        flux_w: f64,
    },
    /// See `Light::Sphere`.
    Sphere {
        /// Metres.
        centre_m: DVec3,
        /// Metres.
        radius_m: f64,
        /// Total, W.
        flux_w: f64,
    },
    /// See `Light::Quad`.
    Quad {
        /// Metres.
        corner_m: DVec3,
        /// Metres.
        u_m: DVec3,
        /// Metres.
        v_m: DVec3,
        /// Total, W.
        flux_w: f64,
    },
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    name: Option<String>,
    geometry: Option<Spanned<Geometry>>,
    #[serde(default)]
    materials: Vec<Spanned<MaterialEntry>>,
    #[serde(default)]
    lights: Vec<Spanned<LightEntry>>,
    sensors: Option<Spanned<SensorsEntry>>,
    model: Option<ModelEntry>,
    site: Option<SiteEntry>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Geometry {
    meshes: Option<Spanned<Vec<Spanned<String>>>>,
    unit_m: Option<Spanned<f64>>,
    up: Option<Spanned<String>>,
    reflectance: Option<Spanned<f64>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct MaterialEntry {
    name: String,
    reflectance: Option<Spanned<f64>>,
    transmittance: Option<Spanned<f64>>,
    emission: Option<Spanned<f64>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct LightEntry {
    kind: Spanned<String>,
    flux_w: Option<Spanned<f64>>,
    position: Option<Spanned<[f64; 3]>>,
    center: Option<Spanned<[f64; 3]>>,
    radius: Option<Spanned<f64>>,
    corner: Option<Spanned<[f64; 3]>>,
    u: Option<Spanned<[f64; 3]>>,
    v: Option<Spanned<[f64; 3]>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SensorsEntry {
    file: Option<Spanned<String>>,
    reference: Option<Spanned<String>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct ModelEntry {
    voxel_m: Option<Spanned<f64>>,
    method: Option<Spanned<String>>,
    tolerance: Option<Spanned<f64>>,
    threads: Option<Spanned<i64>>,
    seed: Option<Spanned<i64>>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SiteEntry {
    latitude_deg: Option<Spanned<f64>>,
    longitude_deg: Option<Spanned<f64>>,
    utc_offset_h: Option<Spanned<f64>>,
    north_deg: Option<Spanned<f64>>,
    turbidity: Option<Spanned<f64>>,
    ground_albedo: Option<Spanned<f64>>,
    weather: Option<Spanned<String>>,
    start: Option<Spanned<String>>,
    end: Option<Spanned<String>>,
    step_min: Option<Spanned<f64>>,
}

/// Reads and checks a scene file.
///
/// # Errors
/// [`SceneError`] with the line: no TOML, unknown or missing keys, numbers out of bounds, unknown words.
pub fn read_scene_file(input: &Input) -> Result<Description, SceneError> {
    let bytes = without_mark(input.bytes);
    let text =
        std::str::from_utf8(bytes).map_err(|error| input.error(line_of(bytes, error.valid_up_to()), Kind::NotUtf8))?;
    let file: File = toml::from_str(text).map_err(|error| {
        let line = error.span().map(|span| line_of(bytes, span.start));
        let words = error.message().trim().replace('\n', ", ");
        input.error(line, Kind::Toml(words))
    })?;
    let at = Places { input, bytes };

    let Some(geometry) = file.geometry else {
        return Err(input.error(None, Kind::Missing("[geometry] with meshes".into())));
    };
    let geometry_line = at.line(geometry.span());
    let geometry = geometry.into_inner();
    let meshes = geometry.meshes.filter(|meshes| !meshes.get_ref().is_empty());
    let Some(meshes) = meshes else {
        return Err(input.error(geometry_line, Kind::Missing("a mesh in [geometry] meshes".into())));
    };

    let mut description = Description {
        name: file.name,
        meshes: meshes.into_inner().into_iter().map(|mesh| at.lined(mesh)).collect(),
        unit_m: at.within("unit_m", geometry.unit_m, 1e-6..=1e6, "1e-6 to 1e6")?.unwrap_or(1.0),
        up: at.up(geometry.up)?,
        reflectance: at.share("reflectance", geometry.reflectance)?.unwrap_or(DEFAULT_REFLECTANCE),
        ..Description::default()
    };
    for entry in file.materials {
        description.overrides.push(at.material(entry)?);
    }
    for entry in file.lights {
        description.lights.push(at.light(entry)?);
    }
    if let Some(entry) = file.sensors {
        let line = at.line(entry.span());
        let entry = entry.into_inner();
        if entry.file.is_none() {
            return Err(input.error(line, Kind::Missing("file in [sensors]".into())));
        }
        description.sensors = entry.file.map(|file| at.lined(file));
        description.reference = entry.reference.map(|file| at.lined(file));
    }
    if let Some(entry) = file.model {
        description.model = at.model(entry)?;
    }
    if let Some(entry) = file.site {
        description.weather_line = entry.weather.as_ref().map_or(0, |weather| at.line(weather.span()));
        description.site = Some(at.site(entry)?);
    }
    Ok(description)
}

/// Reflectance of what has none of its own: a light grey, the middle of the scale.
pub const DEFAULT_REFLECTANCE: f32 = 0.5;

/// Finds lines, and checks one value at a time.
struct Places<'a> {
    input: &'a Input<'a>,
    bytes: &'a [u8],
}

impl Places<'_> {
    fn line(&self, span: Range<usize>) -> usize {
        line_of(self.bytes, span.start)
    }

    fn lined<T>(&self, value: Spanned<T>) -> Lined<T> {
        Lined { line: self.line(value.span()), value: value.into_inner() }
    }

    fn error(&self, span: Range<usize>, kind: Kind) -> SceneError {
        self.input.error(self.line(span), kind)
    }

    fn within(
        &self,
        what: &str,
        value: Option<Spanned<f64>>,
        range: std::ops::RangeInclusive<f64>,
        bound: &'static str,
    ) -> Result<Option<f64>, SceneError> {
        let Some(spanned) = value else { return Ok(None) };
        let value = *spanned.get_ref();
        if range.contains(&value) {
            return Ok(Some(value));
        }
        let what = what.to_owned();
        let kind =
            if value.is_finite() { Kind::Outside { what, value, bound } } else { Kind::NotFinite { what, value } };
        Err(self.error(spanned.span(), kind))
    }

    fn share(&self, what: &str, value: Option<Spanned<f64>>) -> Result<Option<f32>, SceneError> {
        Ok(self.within(what, value, 0.0..=1.0, "0 to 1")?.map(|share| share as f32))
    }

    fn up(&self, up: Option<Spanned<String>>) -> Result<Option<Up>, SceneError> {
        let Some(up) = up else { return Ok(None) };
        match up.get_ref().as_str() {
            "y" | "Y" => Ok(Some(Up::Y)),
            "z" | "Z" => Ok(Some(Up::Z)),
            name => {
                let kind = Kind::UnknownName { what: "up axis", name: name.to_owned(), known: "y, z".to_owned() };
                Err(self.error(up.span(), kind))
            }
        }
    }

    fn material(&self, entry: Spanned<MaterialEntry>) -> Result<Lined<Override>, SceneError> {
        let line = self.line(entry.span());
        let entry = entry.into_inner();
        let emission = self.within("emission", entry.emission, 0.0..=1e9, "0 to 1e9 W/m2/sr")?;
        let value = Override {
            reflectance: self.share("reflectance", entry.reflectance)?,
            transmittance: self.share("transmittance", entry.transmittance)?,
            emission_w_m2_sr: emission.map(|radiance| radiance as f32),
            pattern: entry.name,
        };
        if let (Some(reflectance), Some(transmittance)) = (value.reflectance, value.transmittance)
            && reflectance + transmittance > 1.0 + 1e-6
        {
            return Err(self.input.error(line, Kind::TooBright { name: value.pattern, reflectance, transmittance }));
        }
        Ok(Lined { value, line })
    }

    fn light(&self, entry: Spanned<LightEntry>) -> Result<DescribedLight, SceneError> {
        let span = entry.span();
        let entry = entry.into_inner();
        let kind = entry.kind.get_ref().clone();
        let own: &[&str] = match kind.as_str() {
            "point" => &["position"],
            "sphere" => &["center", "radius"],
            "quad" => &["corner", "u", "v"],
            _ => {
                let known = "point, sphere, quad".to_owned();
                return Err(self.error(entry.kind.span(), Kind::UnknownName { what: "light kind", name: kind, known }));
            }
        };

        // A key of another kind of light is a mistake, not something to pass over.
        let span_of = |value: &Option<Spanned<[f64; 3]>>| value.as_ref().map(Spanned::span);
        let given = [
            ("position", span_of(&entry.position)),
            ("center", span_of(&entry.center)),
            ("radius", entry.radius.as_ref().map(Spanned::span)),
            ("corner", span_of(&entry.corner)),
            ("u", span_of(&entry.u)),
            ("v", span_of(&entry.v)),
        ];
        for (what, span) in given {
            if let (Some(span), false) = (span, own.contains(&what)) {
                return Err(self.error(span, Kind::Misplaced { what, to: format!("a {kind} light") }));
            }
        }

        let missing = |what: &str| self.error(span.clone(), Kind::Missing(format!("{what} of a {kind} light")));
        let flux_w = self.within("flux_w", entry.flux_w, 0.0..=1e12, "0 to 1e12 W")?;
        let flux_w = flux_w.ok_or_else(|| missing("flux_w"))?;
        let vector = |what: &str, value: Option<Spanned<[f64; 3]>>| {
            let value = value.ok_or_else(|| missing(what))?;
            self.vector(what, value)
        };
        match kind.as_str() {
            "point" => Ok(DescribedLight::Point { position_m: vector("position", entry.position)?, flux_w }),
            "sphere" => {
                let radius_m = self.within("radius", entry.radius, 1e-6..=1e6, "1e-6 to 1e6 m")?;
                let radius_m = radius_m.ok_or_else(|| missing("radius"))?;
                Ok(DescribedLight::Sphere { centre_m: vector("center", entry.center)?, radius_m, flux_w })
            }
            _ => {
                let (u, v) = (vector("u", entry.u)?, vector("v", entry.v)?);
                // Thinner than this, the normal of the quad is lost in f32.
                let flat = u.cross(v).length() <= 1e-6 * u.length() * v.length();
                if flat || u.length().min(v.length()) < 1e-6 {
                    return Err(self.error(span, Kind::Flat("u and v of a quad light span no area")));
                }
                Ok(DescribedLight::Quad { corner_m: vector("corner", entry.corner)?, u_m: u, v_m: v, flux_w })
            }
        }
    }

    fn vector(&self, what: &str, value: Spanned<[f64; 3]>) -> Result<DVec3, SceneError> {
        let vector = DVec3::from_array(*value.get_ref());
        for value_m in vector.to_array() {
            let span = value.span();
            self.within(what, Some(Spanned::new(span, value_m)), -FARTHEST_M..=FARTHEST_M, "-1e8 to 1e8 m")?;
        }
        Ok(vector)
    }

    fn model(&self, entry: ModelEntry) -> Result<ModelChoice, SceneError> {
        let method = match entry.method {
            None => None,
            Some(name) => Some(Method::from_name(name.get_ref()).ok_or_else(|| {
                let known = Method::ALL.map(Method::name).join(", ");
                let kind = Kind::UnknownName { what: "method", name: name.get_ref().clone(), known };
                self.error(name.span(), kind)
            })?),
        };
        let whole = |what: &str, value: Option<Spanned<i64>>, least: i64, most: i64, bound| match value {
            None => Ok(None),
            Some(value) if (least..=most).contains(value.get_ref()) => Ok(Some(*value.get_ref())),
            Some(value) => {
                let kind = Kind::Outside { what: what.to_owned(), value: *value.get_ref() as f64, bound };
                Err(self.error(value.span(), kind))
            }
        };
        let threads = whole("threads", entry.threads, 1, 4096, "1 to 4096")?;
        let seed = whole("seed", entry.seed, 0, i64::MAX, "0 to 2^63 - 1")?;
        Ok(ModelChoice {
            voxel_m: self.within("voxel_m", entry.voxel_m, 1e-6..=1e6, "1e-6 to 1e6 m")?.map(|edge| edge as f32),
            method,
            tolerance: self.within("tolerance", entry.tolerance, 1.0..=1e6, "1 to 1e6")?,
            threads: threads.map(|threads| threads as usize),
            seed: seed.map(i64::unsigned_abs),
        })
    }

    fn site(&self, entry: SiteEntry) -> Result<Site, SceneError> {
        let step_min = self.within("step_min", entry.step_min, 1.0..=1440.0, "1 to 1440")?;
        Ok(Site {
            latitude_deg: self.within("latitude_deg", entry.latitude_deg, -90.0..=90.0, "-90 to 90")?,
            longitude_deg: self.within("longitude_deg", entry.longitude_deg, -180.0..=180.0, "-180 to 180")?,
            utc_offset_h: self.within("utc_offset_h", entry.utc_offset_h, -14.0..=14.0, "-14 to 14")?,
            north_deg: self.within("north_deg", entry.north_deg, -360.0..=360.0, "-360 to 360")?.unwrap_or(0.0),
            turbidity: self.within("turbidity", entry.turbidity, 1.0..=10.0, "1 to 10")?,
            ground_albedo: self.within("ground_albedo", entry.ground_albedo, 0.0..=1.0, "0 to 1")?,
            weather: entry.weather.map(|file| PathBuf::from(file.into_inner())),
            start: self.day(entry.start)?,
            end: self.day(entry.end)?,
            step_min,
        })
    }

    /// A day written `MM-DD`; 29 February is one.
    fn day(&self, value: Option<Spanned<String>>) -> Result<Option<(u8, u8)>, SceneError> {
        const DAYS: [u8; 12] = [31, 29, 31, 30, 31, 30, 31, 31, 30, 31, 30, 31];
        let Some(value) = value else { return Ok(None) };
        let two_digits = |text: &str| if text.len() == 2 { text.parse::<u8>().ok() } else { None };
        let parts = value.get_ref().split_once('-');
        let parts = parts.and_then(|(month, day)| Some((two_digits(month)?, two_digits(day)?)));
        let real = parts.filter(|&(month, day)| {
            let most = month.checked_sub(1).and_then(|index| DAYS.get(usize::from(index)));
            day >= 1 && most.is_some_and(|&most| day <= most)
        });
        let expected = || "a day MM-DD".to_owned();
        let found = || format!("{:?}", value.get_ref());
        real.map(Some).ok_or_else(|| self.error(value.span(), Kind::Syntax { expected: expected(), found: found() }))
    }
}
