//! Not built yet.
use super::RawMesh;
use crate::scene::error::{Kind, SceneError};
use crate::scene::input::Input;

/// Refuses the file.
///
/// # Errors
/// Always.
pub fn read_ply(input: &Input) -> Result<RawMesh, SceneError> {
    Err(input.error(None, Kind::UnknownFormat { file: input.stem(), known: "obj" }))
}
