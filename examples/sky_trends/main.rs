//! Draws the trends of `docs/sky.md` and prints its tables.
//!
//!     cargo run --release --example sky_trends -- docs/sky
//!
//! The same bytes on every run, but for the table of costs.

mod map_trends;
mod sky_pictures;
mod sun_charts;
mod sun_tables;

use std::error::Error;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn Error>> {
    let folder = std::env::args_os().nth(1).map_or_else(|| PathBuf::from("docs/sky"), PathBuf::from);
    std::fs::create_dir_all(&folder)?;
    sun_charts::draw(&folder)?;
    sky_pictures::draw(&folder)?;
    sky_pictures::print_levels();
    map_trends::draw(&folder)?;
    sun_tables::print()?;
    Ok(())
}
