//! Small pictures of the clear sky, by both models of its colour.

use lightvein::export::{sky_picture, whole_file};
use lightvein::sky::Sun;
use lightvein::sky::picture::{Colours, Picture};
use lightvein::sky::spectrum::Atmosphere;
use std::io;
use std::path::Path;

const TURBIDITY: f64 = 3.0;
const SIZE_PX: usize = 200;

/// Suns by name, azimuth and elevation, degrees.
const SUNS: [(&str, [f64; 2]); 3] = [("noon", [180.0, 50.0]), ("evening", [270.0, 6.0]), ("dusk", [290.0, -5.0])];

/// Writes them into a folder.
pub fn draw(folder: &Path) -> io::Result<()> {
    for (name, [azimuth, elevation]) in SUNS {
        let sun = Sun { azimuth_rad: azimuth.to_radians(), elevation_rad: elevation.to_radians() };
        for (model, colours) in [("preetham", Colours::Preetham), ("hosek", Colours::Hosek)] {
            // Hosek and Wilkie know no sun below the horizon.
            if sun.elevation_rad < 0.0 && colours == Colours::Hosek {
                continue;
            }
            let picture = Picture::paint(sun, 1.0, &Atmosphere::new(TURBIDITY), colours, SIZE_PX);
            let path = folder.join(format!("sky_{name}_{model}.png"));
            whole_file(&path, |out| sky_picture::write_png(out, &picture, sky_picture::EXPOSURE))?;
        }
    }
    Ok(())
}
