//! What does a material file beside an OBJ mesh say?
//!
//! Taken: `newmtl`, `Kd` (reflectance, by its luminance) and `Ke` (radiance, by its luminance). Opacity (`d`, `Tr`) is
//! passed over: exporters disagree on its sense, and glazing is named in the scene file. Textures are not read; a
//! material keeps its `Kd`, and a warning counts them.

use super::{MOST_EMISSION, luminance};
use crate::scene::error::{Kind, SceneError};
use crate::scene::input::{Input, Lines, counted, number, shown, text, without_mark, words};

/// What a material file says of one material.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Properties {
    /// Luminance of `Kd`, 0 to 1; `None` without `Kd`.
    pub reflectance: Option<f64>,
    /// Luminance of `Ke`, W/m2/sr.
    pub emission_w_m2_sr: f64,
}

/// A material file.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Materials {
    /// Names and properties, in the order of the file.
    pub materials: Vec<(String, Properties)>,
    /// What was passed over, a sentence each.
    pub warnings: Vec<String>,
}

/// Reads an MTL file.
///
/// # Errors
/// [`SceneError`] with the line: colours that are not numbers, not finite or negative, a reflectance above 1, properties
/// before the first `newmtl`.
pub fn read_mtl(input: &Input) -> Result<Materials, SceneError> {
    let mut read = Materials::default();
    let (mut textures, mut spectra) = (0_usize, 0_usize);
    let mut stage = input.parse();
    for line in Lines::new(without_mark(input.bytes)) {
        stage.done(line.end)?;
        let failed = |kind| input.error(line.number, kind);
        let mut rest = words(line.bytes);
        let Some(keyword) = rest.next() else { continue };
        match keyword {
            b"newmtl" => {
                let start = line.bytes.trim_ascii();
                let name = text(start.strip_prefix(b"newmtl").unwrap_or(start).trim_ascii());
                read.materials.push((name, Properties::default()));
            }
            b"map_Kd" => textures += 1,
            b"Kd" | b"Ke" if matches!(rest.clone().next(), Some(b"spectral" | b"xyz")) => spectra += 1,
            b"Kd" | b"Ke" => {
                let what = if keyword == b"Kd" { "Kd" } else { "Ke" };
                let (most, bound) = if what == "Kd" { (1.0, "0 to 1") } else { (MOST_EMISSION, "0 to 1e9") };
                let value = luminance(colour(rest, what, most, bound).map_err(failed)?);
                let Some((_, properties)) = read.materials.last_mut() else {
                    return Err(failed(Kind::Missing(format!("newmtl before {what}"))));
                };
                if what == "Ke" {
                    properties.emission_w_m2_sr = value;
                } else {
                    properties.reflectance = Some(value.min(1.0));
                }
            }
            _ => {}
        }
    }
    if textures > 0 {
        read.warnings.push(format!("{} (map_Kd) not read, Kd stands for it", counted(textures, "texture")));
    }
    if spectra > 0 {
        read.warnings.push(format!("{} given as spectrum or CIE XYZ left out", counted(spectra, "colour")));
    }
    Ok(read)
}

/// Three components from 0 to `most`, or one for all three; a comment may follow.
fn colour<'a>(
    words: impl Iterator<Item = &'a [u8]>,
    what: &str,
    most: f64,
    bound: &'static str,
) -> Result<[f64; 3], Kind> {
    let mut components = Vec::with_capacity(3);
    for word in words.take_while(|word| !word.starts_with(b"#")).take(3) {
        let value = number(word)
            .ok_or_else(|| Kind::Syntax { expected: format!("a component of {what}"), found: shown(word) })?;
        if !value.is_finite() {
            return Err(Kind::NotFinite { what: what.to_owned(), value });
        }
        if !(0.0..=most).contains(&value) {
            return Err(Kind::Outside { what: what.to_owned(), value, bound });
        }
        components.push(value);
    }
    match *components {
        [grey] => Ok([grey; 3]),
        [red, green, blue] => Ok([red, green, blue]),
        _ => Err(Kind::Fields { found: components.len(), expected: format!("1 or 3 for {what}") }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::{Cancel, Quiet};
    use std::path::Path;

    fn read(text: &str) -> Result<Materials, SceneError> {
        read_mtl(&Input::alone(text.as_bytes(), Path::new("a.mtl"), &Quiet, &Cancel::new()))
    }

    #[test]
    fn colours_become_luminances() {
        let read = read("newmtl a b\n  Kd 0.5 # grey\n Ke 17 12 4\n d 0.1\nmap_Kd x.png\nnewmtl c\n").unwrap();
        let [(name, first), (_, second)] = &read.materials[..] else { panic!("two materials") };
        assert_eq!(name, "a b");
        assert!((first.reflectance.unwrap() - 0.5).abs() < 1e-12);
        assert!((first.emission_w_m2_sr - (17.0 * 0.2126 + 12.0 * 0.7152 + 4.0 * 0.0722)).abs() < 1e-12);
        assert_eq!(*second, Properties::default());
        assert_eq!(read.warnings.len(), 1);
    }

    #[test]
    fn errors_name_the_line() {
        let fails = |text: &str, want: &str| assert_eq!(read(text).unwrap_err().to_string(), want);
        fails("Kd 1 1 1", "a.mtl:1: newmtl before Kd is missing");
        fails("newmtl a\nKd 2 2 2", "a.mtl:2: Kd 2.0 is outside 0 to 1");
        fails("newmtl a\nKe -1", "a.mtl:2: Ke -1.0 is outside 0 to 1e9");
        fails("newmtl a\nKd 1 1", "a.mtl:2: 2 fields, expected 1 or 3 for Kd");
    }
}
