//! Small pictures of the clear sky, by both models of its colour, and how bright each makes the ground.

use glam::DVec3;
use lightvein::export::{sky_picture, whole_file};
use lightvein::sky::Sun;
use lightvein::sky::colour::luminance;
use lightvein::sky::picture::{Colours, Picture};
use lightvein::sky::spectrum::Atmosphere;
use std::io;
use std::path::Path;

const TURBIDITY: f64 = 3.0;
const SIZE_PX: usize = 200;

/// Pictures by name: azimuth and elevation of the sun, degrees, and the model.
const PICTURES: [(&str, [f64; 2], Colours); 3] = [
    ("noon_preetham", [180.0, 50.0], Colours::Preetham),
    ("noon_hosek", [180.0, 50.0], Colours::Hosek),
    ("evening_preetham", [270.0, 6.0], Colours::Preetham),
];

/// Writes them into a folder.
pub fn draw(folder: &Path) -> io::Result<()> {
    for (name, [azimuth, elevation], colours) in PICTURES {
        let sun = Sun { azimuth_rad: azimuth.to_radians(), elevation_rad: elevation.to_radians() };
        let picture = Picture::paint(sun, 1.0, &Atmosphere::new(TURBIDITY), colours, SIZE_PX);
        let path = folder.join(format!("sky_{name}.png"));
        whole_file(&path, |out| sky_picture::write_png(out, &picture, sky_picture::EXPOSURE))?;
    }
    Ok(())
}

/// Prints the light on level ground, sun included, by model, turbidity and the sun's elevation.
pub fn print_levels() {
    println!("Light on level ground under a clear sky and its sun, klx:\n");
    println!("| turbidity | sun at | Preetham | Hosek and Wilkie |");
    println!("|---:|---:|---:|---:|");
    for turbidity in [2.0, 3.0, 5.0] {
        for elevation_deg in [0.0_f64, 5.0, 20.0, 60.0] {
            let sun = Sun { azimuth_rad: 0.0, elevation_rad: elevation_deg.to_radians() };
            let [preetham, hosek] = [Colours::Preetham, Colours::Hosek].map(|colours| {
                let picture = Picture::paint(sun, 1.0, &Atmosphere::new(turbidity), colours, SIZE_PX);
                luminance(picture.illuminance_klx(DVec3::Z))
            });
            println!("| {turbidity} | {elevation_deg}\u{b0} | {preetham:.1} | {hosek:.1} |");
        }
    }
    println!();
}
