//! The test set: scenes that no constant of Lightvein was tuned on. Lights and sensors were placed by geometry and by
//! references, before any estimate was seen.

mod crypt;
mod halls;
mod loft;
mod offices;
mod pipes;

use crate::scene::Scene;

/// The folder of the test set, in `scenes/`.
pub const FOLDER: &str = "held_out";

/// All scenes of the test set.
pub fn scenes() -> Result<[Scene; 5], String> {
    Ok([loft::loft()?, pipes::pipes()?, halls::halls()?, crypt::crypt()?, offices::offices()?])
}
