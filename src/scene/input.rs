//! How do bytes come in: whole files with progress, their lines and words with their numbers?
//!
//! Files are read whole: a mesh of some hundred MB costs its size once more while it is parsed. All text formats are
//! taken as bytes, so that names in Latin-1 do no harm; only numbers need to be ASCII.

use super::error::{Kind, SceneError};
use crate::job::{Cancel, Progress};
use glam::DVec3;
use std::io::Read;
use std::path::{Path, PathBuf};

/// Bytes between two looks at the cancel flag and two reports of progress: some milliseconds of parsing.
const STRIDE: usize = 1 << 20;

/// Largest coordinate that is accepted, metres: three times what any map projection of the earth gives.
pub const FARTHEST_M: f64 = 1e8;

/// The bytes of one file and what a reader may do with them.
pub struct Input<'a> {
    /// The file, for errors.
    pub path: &'a Path,
    /// All of it.
    pub bytes: &'a [u8],
    /// Largest coordinate that is accepted, in units of the file.
    pub farthest: f64,
    /// Folder of the files that this one names; `None` where it may name none.
    pub folder: Option<PathBuf>,
    /// Hears how many bytes are done.
    pub progress: &'a dyn Progress,
    /// Stops the reader.
    pub cancel: &'a Cancel,
}

impl<'a> Input<'a> {
    /// Bytes that came from nowhere: other files that they name do not exist. For tests and fuzzing.
    pub fn alone(bytes: &'a [u8], path: &'a Path, progress: &'a dyn Progress, cancel: &'a Cancel) -> Self {
        Self { path, bytes, farthest: FARTHEST_M, folder: None, progress, cancel }
    }

    /// An error in `line` of this file.
    pub fn error(&self, line: impl Into<Option<usize>>, kind: Kind) -> SceneError {
        SceneError::new(self.path, line, kind)
    }

    /// The file's name without folder and ending: what its faces are called when nothing else names them.
    pub fn stem(&self) -> String {
        self.path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default()
    }

    /// The bytes of a file that this one names, relative to its own folder; `progress` hears of the reading.
    ///
    /// # Errors
    /// [`Kind::Read`] of that file, with `NotFound` where this input may name none; [`Kind::Cancelled`].
    pub fn neighbour(&self, name: &str, progress: &dyn Progress) -> Result<(PathBuf, Vec<u8>), SceneError> {
        let Some(folder) = &self.folder else {
            let error = std::io::Error::from(std::io::ErrorKind::NotFound);
            return Err(SceneError::new(Path::new(name), None, Kind::Read(error)));
        };
        let path = folder.join(name);
        let bytes = read_file(&path, progress, self.cancel)?;
        Ok((path, bytes))
    }

    /// The error of a neighbour as one of this file: it may be well, but names a file that cannot be read.
    pub fn named(&self, what: &'static str, file: &str, error: SceneError) -> SceneError {
        match error.kind {
            Kind::Read(reason) => self.error(None, Kind::Named { what, file: file.to_owned(), reason }),
            _ => error,
        }
    }

    /// Begins the stage of parsing this input.
    pub fn parse(&self) -> Parse<'_> {
        self.progress.begin("parse", self.bytes.len() as u64);
        Parse { input: self, reported: 0 }
    }

    /// Whether all three coordinates are finite and near enough.
    pub fn fits(&self, point: DVec3) -> bool {
        point.is_finite() && point.abs().max_element() <= self.farthest
    }

    /// A coordinate triple, if all three are finite and near enough.
    ///
    /// # Errors
    /// [`Kind::NotFinite`], [`Kind::Outside`].
    pub fn position(&self, at: impl Into<Option<usize>>, what: &str, point: DVec3) -> Result<DVec3, SceneError> {
        if self.fits(point) {
            return Ok(point);
        }
        let worst = |value: &f64| !value.is_finite() || value.abs() > self.farthest;
        let value = point.to_array().into_iter().find(worst).unwrap_or(f64::NAN);
        let what = format!("coordinate of {what}");
        let kind = if value.is_finite() {
            let value_m = value * (FARTHEST_M / self.farthest);
            Kind::Outside { what, value: value_m, bound: "-1e8 to 1e8 m" }
        } else {
            Kind::NotFinite { what, value }
        };
        Err(self.error(at, kind))
    }
}

/// The stage of parsing one input; it ends when this is dropped.
pub struct Parse<'a> {
    input: &'a Input<'a>,
    reported: usize,
}

impl Parse<'_> {
    /// Everything before `offset` is done. Cheap enough to call for each line.
    ///
    /// # Errors
    /// [`Kind::Cancelled`].
    pub fn done(&mut self, offset: usize) -> Result<(), SceneError> {
        if offset >= self.reported + STRIDE {
            self.input.progress.advance((offset - self.reported) as u64);
            self.reported = offset;
            self.input.cancel.check().map_err(|_| self.input.error(None, Kind::Cancelled))?;
        }
        Ok(())
    }
}

impl Drop for Parse<'_> {
    fn drop(&mut self) {
        self.input.progress.end();
    }
}

/// All bytes of a file, read as the stage "read".
///
/// # Errors
/// [`Kind::Read`], also for what is not a plain file; [`Kind::Cancelled`].
pub fn read_file(path: &Path, progress: &dyn Progress, cancel: &Cancel) -> Result<Vec<u8>, SceneError> {
    let failed = |error| SceneError::new(path, None, Kind::Read(error));
    let metadata = std::fs::metadata(path).map_err(failed)?;
    if !metadata.is_file() {
        let what = if metadata.is_dir() { "it is a folder" } else { "it is not a plain file" };
        return Err(failed(std::io::Error::other(what)));
    }
    let mut file = std::fs::File::open(path).map_err(failed)?;

    progress.begin("read", metadata.len());
    let mut bytes = Vec::with_capacity(usize::try_from(metadata.len()).unwrap_or(0));
    let outcome = loop {
        if cancel.is_cancelled() {
            break Err(SceneError::new(path, None, Kind::Cancelled));
        }
        match (&mut file).take(STRIDE as u64).read_to_end(&mut bytes) {
            Ok(0) => break Ok(()),
            Ok(count) => progress.advance(count as u64),
            Err(error) => break Err(failed(error)),
        }
    };
    progress.end();
    outcome.map(|()| bytes)
}

/// The number of the line that holds byte `offset`, from 1.
pub fn line_of(bytes: &[u8], offset: usize) -> usize {
    1 + bytes.iter().take(offset).filter(|&&byte| byte == b'\n').count()
}

/// The bytes without a UTF-8 byte order mark.
pub fn without_mark(bytes: &[u8]) -> &[u8] {
    bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes)
}

/// Text of bytes that should be UTF-8; else each byte is taken as a Latin-1 character.
pub fn text(bytes: &[u8]) -> String {
    match std::str::from_utf8(bytes) {
        Ok(text) => text.to_owned(),
        Err(_) => bytes.iter().map(|&byte| char::from(byte)).collect(),
    }
}

/// What an error shows of a word of the user: quoted, control characters escaped, at most 40 characters.
pub fn shown(bytes: &[u8]) -> String {
    const MOST: usize = 40;
    let text = text(bytes.get(..4 * MOST).unwrap_or(bytes));
    let mut short: String = text.chars().take(MOST).collect();
    if short.len() < bytes.len() && text.chars().count() > MOST {
        short.push_str("...");
    }
    if short.is_empty() { "nothing".to_owned() } else { format!("{short:?}") }
}

/// A number of things as a person writes it: "1 face", "3 faces".
pub fn counted(count: usize, thing: &str) -> String {
    if count == 1 { format!("1 {thing}") } else { format!("{count} {thing}s") }
}

/// The words of a line: what stands between blanks.
pub fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> + Clone {
    line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty())
}

/// The number a word stands for; `None` if it is none. NaN and infinities are numbers here, overflow gives infinity.
pub fn number(word: &[u8]) -> Option<f64> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

/// The next word as a number.
///
/// # Errors
/// [`Kind::Syntax`] where there is none.
pub fn next_number<'a>(words: &mut impl Iterator<Item = &'a [u8]>, what: &str) -> Result<f64, Kind> {
    let word = words.next().unwrap_or_default();
    number(word).ok_or_else(|| Kind::Syntax { expected: format!("{what}, a number"), found: shown(word) })
}

/// The next three words as a point or a direction.
///
/// # Errors
/// As [`next_number`].
pub fn next_triple<'a>(words: &mut impl Iterator<Item = &'a [u8]>, what: &str) -> Result<DVec3, Kind> {
    Ok(DVec3::new(next_number(words, what)?, next_number(words, what)?, next_number(words, what)?))
}

/// Lines of a text with their numbers from 1 and the offset behind them; ended by `\n` or `\r\n`.
pub struct Lines<'a> {
    bytes: &'a [u8],
    offset: usize,
    number: usize,
}

/// One line of [`Lines`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Line<'a> {
    /// From 1.
    pub number: usize,
    /// Without its end.
    pub bytes: &'a [u8],
    /// Where the next line begins.
    pub end: usize,
}

impl<'a> Lines<'a> {
    /// The lines of `bytes`.
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { bytes, offset: 0, number: 0 }
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = Line<'a>;

    fn next(&mut self) -> Option<Line<'a>> {
        let rest = self.bytes.get(self.offset..).filter(|rest| !rest.is_empty())?;
        let length = rest.iter().position(|&byte| byte == b'\n').unwrap_or(rest.len());
        let (line, _) = rest.split_at(length);
        self.offset += (length + 1).min(rest.len());
        self.number += 1;
        Some(Line { number: self.number, bytes: line.strip_suffix(b"\r").unwrap_or(line), end: self.offset })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_numbered_whatever_ends_them() {
        let lines: Vec<_> = Lines::new(b"a\r\n\nb").map(|line| (line.number, line.bytes.to_vec())).collect();
        assert_eq!(lines, [(1, b"a".to_vec()), (2, b"".to_vec()), (3, b"b".to_vec())]);
        assert_eq!(Lines::new(b"").count(), 0);
        assert_eq!(line_of(b"a\nb\nc", 4), 3);
    }

    #[test]
    fn words_of_the_user_are_shown_short_and_harmless() {
        assert_eq!(shown(b"1.5x"), "\"1.5x\"");
        assert_eq!(shown(b""), "nothing");
        assert_eq!(shown(b"M\xFCller\n"), "\"M\u{fc}ller\\n\"");
        assert!(shown(&[b'a'; 1000]).len() < 50);
    }
}
