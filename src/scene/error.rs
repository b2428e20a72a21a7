//! What went wrong in a file of the user, and where?
//!
//! One error type for all of loading: a place (file and, where the format has lines, the line) and a [`Kind`]. It prints
//! as one line, `gallery.toml:7: reflectance 1.4 is outside 0 to 1`: where, what and the bound.

use std::path::{Path, PathBuf};

/// A file of the scene that cannot be used, with the place in it.
#[derive(Debug, thiserror::Error)]
#[error("{}: {kind}", place(path, *line))]
pub struct SceneError {
    /// The file, as the user or the file that points to it names it.
    pub path: PathBuf,
    /// The line in it, from 1; `None` for binary files and for what is missing altogether.
    pub line: Option<usize>,
    /// What is wrong there.
    pub kind: Kind,
}

/// What is wrong at the place a [`SceneError`] names.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum Kind {
    /// The file itself cannot be opened or read.
    #[error("cannot be read: {0}")]
    Read(std::io::Error),
    /// A file that this one names cannot be opened or read.
    #[error("{what} {file:?} cannot be read: {reason}")]
    Named {
        /// What the file was to be: "mesh", "sensors".
        what: &'static str,
        /// Its name as written.
        file: String,
        /// What the system answered.
        reason: std::io::Error,
    },
    /// Loading was cancelled; the file may be well.
    #[error("interrupted")]
    Cancelled,
    /// The file is not TOML, or a key is unknown, missing or of the wrong type: the parser's own words.
    #[error("{0}")]
    Toml(String),
    /// The file is not the glTF it should be: the parser's own words, or ours.
    #[error("glTF: {0}")]
    Gltf(String),
    /// A number is beyond its bounds.
    #[error("{what} {value:?} is outside {bound}")]
    Outside {
        /// What the number is.
        what: String,
        /// The number.
        value: f64,
        /// The bounds, as a person writes them: "0 to 1".
        bound: &'static str,
    },
    /// A number is NaN or infinite.
    #[error("{what} {value:?} is not a finite number")]
    NotFinite {
        /// What the number is.
        what: String,
        /// The number.
        value: f64,
    },
    /// Something else stands where the format wants `expected`.
    #[error("expected {expected}, found {found}")]
    Syntax {
        /// What the format wants here.
        expected: String,
        /// What is there, shortened.
        found: String,
    },
    /// A face names a vertex that is not there.
    #[error("{face} uses vertex {index}, but there are {count}")]
    NoSuchVertex {
        /// The face, by number where there is no line.
        face: String,
        /// The vertex, numbered as the format does.
        index: i64,
        /// How many there are.
        count: usize,
    },
    /// The meshes have no face with an area.
    #[error("no face with an area: the mesh is empty")]
    EmptyMesh,
    /// A file has an ending that no reader knows.
    #[error("file {file:?} is of no known format; known are {known}")]
    UnknownFormat {
        /// The file as written.
        file: String,
        /// The endings that are known.
        known: &'static str,
    },
    /// A word is not among those allowed.
    #[error("{what} {name:?} is unknown; known are {known}")]
    UnknownName {
        /// What the word was to name.
        what: &'static str,
        /// The word.
        name: String,
        /// All words allowed.
        known: String,
    },
    /// A key or column is missing.
    #[error("{0} is missing")]
    Missing(String),
    /// A key does not belong where it stands.
    #[error("{what} does not belong to {to}")]
    Misplaced {
        /// The key.
        what: &'static str,
        /// What it stands in.
        to: String,
    },
    /// A name that must be unique is not.
    #[error("{what} {name:?} occurs twice, first in line {first}")]
    Twice {
        /// What the name names.
        what: &'static str,
        /// The name.
        name: String,
        /// The line of its first use.
        first: usize,
    },
    /// A row has the wrong number of fields.
    #[error("{found} fields, expected {expected}")]
    Fields {
        /// How many there are.
        found: usize,
        /// How many there should be.
        expected: String,
    },
    /// Reflectance and transmittance of one material send out more than comes in.
    #[error("material {name:?}: reflectance {reflectance} + transmittance {transmittance} is above 1")]
    TooBright {
        /// The material.
        name: String,
        /// Its reflectance.
        reflectance: f32,
        /// Its transmittance.
        transmittance: f32,
    },
    /// A vector that must have a length, or two that must span an area, do not.
    #[error("{0}")]
    Flat(&'static str),
    /// Text that must be UTF-8 is not.
    #[error("the text is not UTF-8")]
    NotUtf8,
    /// A file ends before all that it announces.
    #[error("the file ends early: {what} needs {needed} bytes, {left} are left")]
    EndsEarly {
        /// What was being read.
        what: String,
        /// How many bytes it needs.
        needed: u64,
        /// How many there are.
        left: u64,
    },
    /// More of something than can be handled.
    #[error("{count} {what}, more than the {most} that can be handled")]
    TooMany {
        /// Of what.
        what: &'static str,
        /// How many.
        count: u64,
        /// The most there may be.
        most: u64,
    },
    /// Things that do not go together, or stand in the wrong order.
    #[error("{0}")]
    Contradiction(String),
}

impl SceneError {
    /// An error in `line` of `path`.
    pub fn new(path: &Path, line: impl Into<Option<usize>>, kind: Kind) -> Self {
        Self { path: path.to_owned(), line: line.into(), kind }
    }

    /// Whether loading was stopped by its `Cancel`, rather than by a bad file.
    pub fn is_cancelled(&self) -> bool {
        matches!(self.kind, Kind::Cancelled)
    }
}

/// `path:line`, or `path` alone.
fn place(path: &Path, line: Option<usize>) -> String {
    match line {
        Some(line) => format!("{}:{line}", path.display()),
        None => path.display().to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_is_one_line_with_place_thing_and_bound() {
        let kind = Kind::Outside { what: "reflectance".into(), value: 1.4, bound: "0 to 1" };
        let error = SceneError::new(Path::new("gallery.toml"), 7, kind);
        assert_eq!(error.to_string(), "gallery.toml:7: reflectance 1.4 is outside 0 to 1");
        let error = SceneError::new(Path::new("a.stl"), None, Kind::EmptyMesh);
        assert_eq!(error.to_string(), "a.stl: no face with an area: the mesh is empty");
    }
}
