//! Makes the scenes of `scenes/`: meshes, scene files and sensors, the same bytes on every run.
//!
//!     cargo run --release --example make_scenes -- scenes
//!
//! It uses nothing of the library, so a fault there cannot hide in a scene made with it.
//! References are no part of this: `scenes/reference.py` has an independent program compute them.
//! Every scene is checked before it is written: each mesh is closed and every light and sensor lies in the void.
//!
//! | scene | what it is for |
//! |---|---|
//! | furnace | a closed grey box, whose mean irradiance has a closed form |
//! | two_rooms | a doorway, and materials |
//! | keyhole | a small hole that light only enters reflected |
//! | gallery | the poster's table: seven sensors from lit to dark, at three reflectances; 200 more for charts |
//! | corridor | bends and a dead end |
//! | cave | curved, noisy walls |
//! | tower | storeys, shafts, loops, a floating block, every kind of light |
//! | held_out/ | the test set, on which nothing was tuned: slanted and curved walls, other proportions and reflectances |
//! | outdoor/ | solids under the sky, and an office with a window, checked in their own way: `outdoor/open_air.rs` |

mod boxes;
mod cave;
mod check;
mod gallery;
mod held_out;
mod isosurface;
mod outdoor;
mod prisms;
mod rooms;
mod scene;
mod seen;
mod tower;

use std::error::Error;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn Error>> {
    let root = std::env::args_os().nth(1).map_or_else(|| PathBuf::from("scenes"), PathBuf::from);
    let scenes = [
        rooms::furnace(),
        rooms::two_rooms(),
        rooms::keyhole(),
        gallery::gallery(),
        rooms::corridor(),
        cave::cave(),
        tower::tower(),
    ];
    for scene in &scenes {
        check::check(scene)?;
        scene.write(&root)?;
        println!("{}", scene.summary());
    }
    for scene in &held_out::scenes()? {
        check::check(scene)?;
        check::check_clear(scene)?;
        scene.write(&root.join(held_out::FOLDER))?;
        println!("{}/{}", held_out::FOLDER, scene.summary());
    }
    for scene in &outdoor::scenes()? {
        outdoor::check(scene)?;
        scene.write(&root.join(outdoor::FOLDER))?;
        println!("{}/{}", outdoor::FOLDER, scene.summary());
    }
    Ok(())
}
