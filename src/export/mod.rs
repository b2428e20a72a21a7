//! Every file format we write, one a file. Positions are in the user's own coordinates, metres, Z up.
//!
//! Writers take any `Write` and never see a path; [`whole_file`] is the one place that opens files: it writes beside the
//! target and renames, so that a failed or interrupted run leaves nothing half-written.

pub mod analysed;
pub mod chart;
pub mod curves;
pub mod daylight;
pub mod exposure;
pub mod exposures;
pub mod field;
pub mod graphml;
pub mod guide;
#[cfg(feature = "cli")]
mod legend;
pub mod plan;
pub mod ply;
#[cfg(feature = "cli")]
pub mod png;
pub mod reference;
mod scale;
pub mod skeleton_json;
pub mod sky_picture;
pub mod stress;
pub mod strips;
pub mod sun_path;
pub mod swc;
pub mod voxels;

use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// Writes a file whole or not at all: what `write` writes appears at `path` once all of it is on disk.
///
/// # Errors
/// What the file system or `write` says; the file beside the target is removed again.
pub fn whole_file(path: &Path, write: impl FnOnce(&mut dyn Write) -> io::Result<()>) -> io::Result<()> {
    let name = path.file_name().ok_or_else(|| io::Error::new(io::ErrorKind::InvalidInput, "the path names no file"))?;
    let mut beside_name = std::ffi::OsString::from(".");
    beside_name.push(name);
    beside_name.push(format!(".{}.part", std::process::id()));
    let beside = path.with_file_name(beside_name);

    let written = (|| {
        let mut writer = BufWriter::new(File::create(&beside)?);
        write(&mut writer)?;
        writer.into_inner().map_err(io::IntoInnerError::into_error)?.sync_all()?;
        fs::rename(&beside, path)
    })();
    if written.is_err() {
        // The first error is the one worth telling.
        let _ = fs::remove_file(&beside);
    }
    written
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failed_write_leaves_the_old_file_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("field.csv");
        whole_file(&path, |out| out.write_all(b"whole")).unwrap();
        let failed = whole_file(&path, |out| {
            out.write_all(b"half")?;
            Err(io::Error::other("the disk is gone"))
        });
        assert!(failed.is_err());
        assert_eq!(fs::read(&path).unwrap(), b"whole");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }
}
