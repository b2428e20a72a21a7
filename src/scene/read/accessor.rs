//! Which numbers does a glTF accessor name?
//!
//! All buffers are loaded first: the binary chunk, base64 in the document, or a file beside it. Every view and
//! accessor is checked against its buffer before a byte is read, so that counts and offsets may be anything.

use crate::scene::error::{Kind, SceneError};
use crate::scene::input::Input;
use ::gltf::accessor::{DataType, Dimensions, sparse::IndexType};
use ::gltf::buffer::{Source, View};
use glam::DVec3;
use std::borrow::Cow;

/// Most elements of an accessor that has no data but a few exceptions: they take memory that the file does not back.
const MOST_WITHOUT_DATA: usize = 1 << 24;

/// The buffers of a document.
pub struct Buffers<'a> {
    input: &'a Input<'a>,
    /// In the document's order.
    bytes: Vec<Cow<'a, [u8]>>,
}

impl<'a> Buffers<'a> {
    /// Loads the buffers of `document`; `blob` is its binary chunk.
    ///
    /// # Errors
    /// [`SceneError`] for buffers that are missing or no base64; [`Kind::Cancelled`].
    pub fn load(input: &'a Input<'a>, document: &::gltf::Document, blob: Option<&'a [u8]>) -> Result<Self, SceneError> {
        let failed = |words: String| input.error(None, Kind::Gltf(words));
        let mut bytes = Vec::new();
        for buffer in document.buffers() {
            bytes.push(match buffer.source() {
                Source::Bin => Cow::Borrowed(blob.ok_or_else(|| failed("the binary chunk is missing".into()))?),
                Source::Uri(uri) => match uri.strip_prefix("data:") {
                    Some(data) => {
                        let base64 = data.split_once(";base64,").and_then(|(_, base64)| decode_base64(base64));
                        Cow::Owned(base64.ok_or_else(|| failed(format!("buffer {} is not base64", buffer.index())))?)
                    }
                    None => {
                        let file = decode_percent(uri);
                        let read = input.neighbour(&file, input.progress);
                        Cow::Owned(read.map_err(|error| input.named("buffer", &file, error))?.1)
                    }
                },
            });
        }
        Ok(Self { input, bytes })
    }

    /// `count` elements of `size` bytes from `offset` of a view on.
    fn rows(&self, view: &View, offset: usize, size: usize, count: usize, what: &str) -> Result<Rows<'_>, SceneError> {
        let input = self.input;
        let ends_early = |what: String, needed: u128, left: usize| {
            let needed = u64::try_from(needed).unwrap_or(u64::MAX);
            input.error(None, Kind::EndsEarly { what, needed, left: left as u64 })
        };
        let stride = view.stride().unwrap_or(size);
        let bytes: &[u8] = self.bytes.get(view.buffer().index()).map_or(&[], |bytes| bytes);
        let end = view.offset() as u128 + view.length() as u128;
        let Some(bytes) = usize::try_from(end).ok().and_then(|end| bytes.get(view.offset()..end)) else {
            return Err(ends_early(format!("buffer view {}", view.index()), end, bytes.len()));
        };
        let before_last = count.saturating_sub(1) as u128 * stride as u128;
        let needed = if count == 0 { 0 } else { offset as u128 + before_last + size as u128 };
        if needed > bytes.len() as u128 {
            return Err(ends_early(what.to_owned(), needed, bytes.len()));
        }
        Ok(Rows { bytes: bytes.get(offset..).unwrap_or_default(), stride, size })
    }
}

/// Elements of an accessor.
struct Rows<'a> {
    bytes: &'a [u8],
    stride: usize,
    size: usize,
}

impl Rows<'_> {
    fn get(&self, row: usize) -> &[u8] {
        let start = row * self.stride;
        self.bytes.get(start..start + self.size).unwrap_or_default()
    }
}

/// The positions that an accessor names, sparse ones too.
///
/// # Errors
/// [`SceneError`] if it is not a VEC3, its data are missing or too short, or a sparse index is out of range.
pub fn read_positions(input: &Input, buffers: &Buffers, accessor: &::gltf::Accessor) -> Result<Vec<DVec3>, SceneError> {
    let what = format!("accessor {}", accessor.index());
    let failed = |words: &str| input.error(None, Kind::Gltf(format!("{what} {words}")));
    if accessor.dimensions() != Dimensions::Vec3 {
        return Err(failed("has positions that are not VEC3"));
    }
    let (kind, count) = (accessor.data_type(), accessor.count());
    let size = 3 * kind.size();
    let point = |row: &[u8]| {
        let mut components = row.chunks_exact(kind.size()).map(|bytes| component(bytes, kind, accessor.normalized()));
        DVec3::from_array([(); 3].map(|()| components.next().unwrap_or(f64::NAN)))
    };
    let mut points = match (accessor.view(), accessor.sparse()) {
        (Some(view), _) => {
            let rows = buffers.rows(&view, accessor.offset(), size, count, &what)?;
            (0..count).map(|row| point(rows.get(row))).collect()
        }
        (None, Some(_)) if count <= MOST_WITHOUT_DATA => vec![DVec3::ZERO; count],
        (None, _) => return Err(failed("has no data")),
    };
    if let Some(sparse) = accessor.sparse() {
        let (indices, values, changed) = (sparse.indices(), sparse.values(), sparse.count());
        let kind = match indices.index_type() {
            IndexType::U8 => DataType::U8,
            IndexType::U16 => DataType::U16,
            IndexType::U32 => DataType::U32,
        };
        let rows = buffers.rows(&indices.view(), indices.offset(), kind.size(), changed, &what)?;
        let numbers: Vec<f64> = (0..changed).map(|row| component(rows.get(row), kind, false)).collect();
        let rows = buffers.rows(&values.view(), values.offset(), size, changed, &what)?;
        for (row, number) in numbers.into_iter().enumerate() {
            let Some(target) = points.get_mut(number as usize) else {
                return Err(failed("has a sparse index out of range"));
            };
            *target = point(rows.get(row));
        }
    }
    Ok(points)
}

/// The vertex numbers that an accessor names, all below `count`.
///
/// # Errors
/// [`SceneError`] if it is not a scalar of whole numbers, its data are missing or too short, or a number has no vertex.
pub fn read_indices(
    input: &Input,
    buffers: &Buffers,
    accessor: &::gltf::Accessor,
    count: usize,
) -> Result<Vec<u32>, SceneError> {
    let what = format!("accessor {}", accessor.index());
    let failed = |words: &str| input.error(None, Kind::Gltf(format!("{what} {words}")));
    let kind = accessor.data_type();
    if accessor.dimensions() != Dimensions::Scalar || !matches!(kind, DataType::U8 | DataType::U16 | DataType::U32) {
        return Err(failed("has indices that are not unsigned scalars"));
    }
    let (Some(view), None) = (accessor.view(), accessor.sparse()) else {
        return Err(failed("has indices without data, or sparse ones"));
    };
    let rows = buffers.rows(&view, accessor.offset(), kind.size(), accessor.count(), &what)?;
    let index = |row: usize| {
        let index = component(rows.get(row), kind, false);
        if index < count as f64 {
            return Ok(index as u32);
        }
        Err(input.error(None, Kind::NoSuchVertex { face: what.clone(), index: index as i64, count }))
    };
    (0..accessor.count()).map(index).collect()
}

/// The number in `bytes`, which are as many as `kind` has; normalised integers become -1 to 1.
fn component(bytes: &[u8], kind: DataType, normalized: bool) -> f64 {
    let mut padded = [0_u8; 4];
    for (to, from) in padded.iter_mut().zip(bytes) {
        *to = *from;
    }
    let [a, b, ..] = padded;
    let (value, most) = match kind {
        DataType::I8 => (f64::from(a as i8), f64::from(i8::MAX)),
        DataType::U8 => (f64::from(a), f64::from(u8::MAX)),
        DataType::I16 => (f64::from(i16::from_le_bytes([a, b])), f64::from(i16::MAX)),
        DataType::U16 => (f64::from(u16::from_le_bytes([a, b])), f64::from(u16::MAX)),
        DataType::U32 => (f64::from(u32::from_le_bytes(padded)), f64::from(u32::MAX)),
        DataType::F32 => return f64::from(f32::from_le_bytes(padded)),
    };
    if normalized { (value / most).max(-1.0) } else { value }
}

/// Bytes of base64 text (RFC 4648, with or without padding); `None` if it is none.
fn decode_base64(text: &str) -> Option<Vec<u8>> {
    let digits = text.trim_end_matches('=').bytes();
    let mut bytes = Vec::with_capacity(text.len() / 4 * 3 + 3);
    let (mut bits, mut held) = (0_u32, 0);
    for digit in digits {
        let value = match digit {
            b'A'..=b'Z' => digit - b'A',
            b'a'..=b'z' => digit - b'a' + 26,
            b'0'..=b'9' => digit - b'0' + 52,
            b'+' | b'-' => 62,
            b'/' | b'_' => 63,
            _ => return None,
        };
        bits = (bits << 6) | u32::from(value);
        held += 6;
        if held >= 8 {
            held -= 8;
            bytes.push((bits >> held) as u8);
            bits &= (1 << held) - 1;
        }
    }
    Some(bytes)
}

/// Text with `%20` and its like as the characters they stand for.
fn decode_percent(text: &str) -> String {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let Some((&first, behind)) = rest.split_first() {
        let digits = if first == b'%' { behind.get(..2) } else { None };
        let code = digits.and_then(|digits| u8::from_str_radix(std::str::from_utf8(digits).ok()?, 16).ok());
        match code {
            Some(code) => {
                bytes.push(code);
                rest = behind.get(2..).unwrap_or_default();
            }
            None => {
                bytes.push(first);
                rest = behind;
            }
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_and_percent_are_undone() {
        assert_eq!(decode_base64("TGljaHQ="), Some(b"Licht".to_vec()));
        assert_eq!(decode_base64("TGljaA"), Some(b"Lich".to_vec()));
        assert_eq!(decode_base64("T G"), None);
        assert_eq!(decode_percent("a%20b%2g%"), "a b%2g%");
    }

    #[test]
    fn components_of_all_types() {
        assert_eq!(component(&[0x80], DataType::I8, true), -1.0);
        assert_eq!(component(&[0xff, 0xff], DataType::U16, true), 1.0);
        assert_eq!(component(&[0xfe, 0xff], DataType::I16, false), -2.0);
        assert_eq!(component(&1.5_f32.to_le_bytes(), DataType::F32, false), 1.5);
    }
}
