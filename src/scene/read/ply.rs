//! What does a Stanford PLY file say?
//!
//! Text and binary of either byte order; `vertex` with `x`, `y`, `z` of any type, then `face` with a list
//! `vertex_indices` or `vertex_index`; everything else is read over. The file's name names the material of all faces.
//! Limits: triangle strips are not read; vertices must come before faces.

use super::polygon::{Cut, tangled, triangulate};
use super::{RawMesh, check_vertices};
use crate::scene::error::{Kind, SceneError};
use crate::scene::input::{Input, Line, Lines, number, shown, words};
use glam::DVec3;
use std::collections::HashMap;

/// Type of a number in the file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Type {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Type {
    fn of(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }

    const fn bytes(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

/// How the body is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Encoding {
    Text,
    LittleEndian,
    BigEndian,
}

/// What a property of an element is to us.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Role {
    /// Coordinate 0, 1 or 2 of a vertex.
    Coordinate(usize),
    /// The corners of a face.
    Corners,
    Other,
}

struct Property {
    role: Role,
    /// Type of the length, for a list.
    length: Option<Type>,
    item: Type,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kin {
    Vertex,
    Face,
    Other,
}

struct Element {
    kin: Kin,
    name: String,
    count: u64,
    properties: Vec<Property>,
}

struct Header {
    encoding: Encoding,
    elements: Vec<Element>,
    /// Offset and line where the body begins.
    body: usize,
    line: usize,
}

/// Reads a PLY file.
///
/// # Errors
/// [`SceneError`], with the line for headers and text: no PLY, unknown types, counts that the file is too short for,
/// coordinates that are not finite or too large, indices without a vertex.
pub fn read_ply(input: &Input) -> Result<RawMesh, SceneError> {
    let header = read_header(input)?;
    let mut mesh = RawMesh::default();
    let material = mesh.material(&mut HashMap::new(), &input.stem());
    let mut crossing = 0_usize;
    let body = input.bytes.get(header.body..).unwrap_or_default();
    let mut body = Body { encoding: header.encoding, rest: body, row: &[], line: header.line };
    let mut corners = Vec::new();

    let mut stage = input.parse();
    let last_needed = header.elements.iter().rposition(|element| element.kin != Kin::Other).map_or(0, |last| last + 1);
    for element in header.elements.iter().take(last_needed) {
        // A row without properties takes no place; one with some takes at least a byte, so that a damaged count shows.
        if element.properties.is_empty() && header.encoding != Encoding::Text {
            continue;
        }
        let left = body.rest.len() as u64;
        if element.count > left {
            let what = format!("element {:?} of {} rows", element.name, element.count);
            return Err(input.error(None, Kind::EndsEarly { what, needed: element.count, left }));
        }
        if element.kin == Kin::Vertex {
            check_vertices(input, usize::try_from(element.count).unwrap_or(usize::MAX))?;
        }
        for row in 1..=element.count {
            stage.done(input.bytes.len() - body.rest.len())?;
            let what = || format!("{} {row}", element.name);
            body.begin_row().map_err(|kind| input.error(body.place(), kind))?;
            let mut point = DVec3::ZERO;
            corners.clear();
            for property in &element.properties {
                let value = read_property(&mut body, property, &mut corners, mesh.positions.len());
                let value = value.map_err(|kind| input.error(body.place(), body.in_row(kind, what)))?;
                match property.role {
                    Role::Coordinate(0) => point.x = value,
                    Role::Coordinate(1) => point.y = value,
                    Role::Coordinate(_) => point.z = value,
                    Role::Corners | Role::Other => {}
                }
            }
            match element.kin {
                Kin::Vertex => mesh.positions.push(input.position(body.place(), &what(), point)?),
                Kin::Face => match triangulate(&corners, &mesh.positions, &mut mesh.triangles) {
                    Cut::Whole => {}
                    Cut::TooFewCorners => mesh.too_few_corners += 1,
                    Cut::Crossing => crossing += 1,
                },
                Kin::Other => {}
            }
        }
    }
    mesh.material_of.resize(mesh.triangles.len(), material);
    if crossing > 0 {
        mesh.warnings.push(tangled(crossing));
    }
    Ok(mesh)
}

/// Reads one property of a row: its value, or for a list its length; corners go to `corners`.
fn read_property(body: &mut Body, property: &Property, corners: &mut Vec<u32>, count: usize) -> Result<f64, Kind> {
    let Some(length) = property.length else { return body.value(property.item) };
    let length = body.value(length)?;
    if !is_whole(length) {
        return Err(Kind::Outside { what: "length of a list".into(), value: length, bound: "whole numbers from 0" });
    }
    let length = length as u64;
    body.require(length.saturating_mul(if body.encoding == Encoding::Text {
        1
    } else {
        property.item.bytes() as u64
    }))?;
    for _ in 0..length {
        let value = body.value(property.item)?;
        if property.role == Role::Corners {
            if !is_whole(value) || value >= count as f64 {
                return Err(Kind::NoSuchVertex { face: "a face".into(), index: value as i64, count });
            }
            corners.push(value as u32);
        }
    }
    Ok(length as f64)
}

/// Whether a number counts something.
fn is_whole(value: f64) -> bool {
    value >= 0.0 && value.fract() == 0.0
}

/// The body of the file from where reading has got to.
struct Body<'a> {
    encoding: Encoding,
    rest: &'a [u8],
    /// What is left of the current line of a text file.
    row: &'a [u8],
    line: usize,
}

impl Body<'_> {
    /// Goes to the next line that is not blank, if the file is text.
    fn begin_row(&mut self) -> Result<(), Kind> {
        if self.encoding != Encoding::Text {
            return Ok(());
        }
        loop {
            let Some(Line { bytes, end, .. }) = Lines::new(self.rest).next() else {
                return Err(Kind::Syntax { expected: "a further row".into(), found: "the end of the file".into() });
            };
            self.rest = self.rest.get(end..).unwrap_or_default();
            self.line += 1;
            self.row = bytes.trim_ascii();
            if !self.row.is_empty() {
                return Ok(());
            }
        }
    }

    /// The line, if the file is text.
    fn place(&self) -> Option<usize> {
        (self.encoding == Encoding::Text).then_some(self.line)
    }

    /// Fails if so many bytes cannot follow.
    fn require(&self, needed: u64) -> Result<(), Kind> {
        let left = if self.encoding == Encoding::Text { self.row.len() } else { self.rest.len() } as u64;
        if needed <= left { Ok(()) } else { Err(Kind::EndsEarly { what: "a list".into(), needed, left }) }
    }

    /// Says which row of a binary file a problem is in, where its kind has room for that.
    fn in_row(&self, kind: Kind, what: impl Fn() -> String) -> Kind {
        match kind {
            Kind::EndsEarly { needed, left, .. } => Kind::EndsEarly { what: what(), needed, left },
            Kind::NoSuchVertex { index, count, .. } => Kind::NoSuchVertex { face: what(), index, count },
            other => other,
        }
    }

    /// The next number.
    fn value(&mut self, item: Type) -> Result<f64, Kind> {
        if self.encoding == Encoding::Text {
            let word = words(self.row).next().unwrap_or_default();
            let behind = self.row.len().min(self.row.iter().position(u8::is_ascii_whitespace).unwrap_or(usize::MAX));
            self.row = self.row.get(behind..).unwrap_or_default().trim_ascii_start();
            return number(word).ok_or_else(|| Kind::Syntax { expected: "a number".into(), found: shown(word) });
        }
        let size = item.bytes();
        let Some((head, rest)) = self.rest.split_at_checked(size) else {
            let (needed, left) = (size as u64, self.rest.len() as u64);
            return Err(Kind::EndsEarly { what: "a number".into(), needed, left });
        };
        self.rest = rest;
        let mut bytes = [0_u8; 8];
        for (to, from) in bytes.iter_mut().zip(head) {
            *to = *from;
        }
        if self.encoding == Encoding::BigEndian {
            bytes.iter_mut().take(size).zip(head.iter().rev()).for_each(|(to, from)| *to = *from);
        }
        let [a, b, c, d, ..] = bytes;
        Ok(match item {
            Type::I8 => f64::from(i8::from_le_bytes([a])),
            Type::U8 => f64::from(a),
            Type::I16 => f64::from(i16::from_le_bytes([a, b])),
            Type::U16 => f64::from(u16::from_le_bytes([a, b])),
            Type::I32 => f64::from(i32::from_le_bytes([a, b, c, d])),
            Type::U32 => f64::from(u32::from_le_bytes([a, b, c, d])),
            Type::F32 => f64::from(f32::from_le_bytes([a, b, c, d])),
            Type::F64 => f64::from_le_bytes(bytes),
        })
    }
}

/// Reads up to and with `end_header`.
fn read_header(input: &Input) -> Result<Header, SceneError> {
    let mut lines = Lines::new(input.bytes);
    let first = lines.next().map_or(&[][..], |line| line.bytes);
    if first.trim_ascii_end() != b"ply" {
        return Err(input.error(1, Kind::Syntax { expected: "ply".into(), found: shown(first) }));
    }
    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    for line in lines {
        let failed = |expected: &str| {
            let found = shown(line.bytes.trim_ascii());
            input.error(line.number, Kind::Syntax { expected: expected.to_owned(), found })
        };
        let fields: Vec<&[u8]> = words(line.bytes).take(6).collect();
        match fields.as_slice() {
            [] | [b"comment" | b"obj_info", ..] => {}
            [b"format", name, b"1.0"] => {
                encoding = Some(match *name {
                    b"ascii" => Encoding::Text,
                    b"binary_little_endian" => Encoding::LittleEndian,
                    b"binary_big_endian" => Encoding::BigEndian,
                    _ => return Err(failed("format ascii, binary_little_endian or binary_big_endian")),
                });
            }
            [b"element", name, count] => {
                let count = std::str::from_utf8(count).ok().and_then(|count| count.parse().ok());
                let kin = match *name {
                    b"vertex" => Kin::Vertex,
                    b"face" => Kin::Face,
                    _ => Kin::Other,
                };
                let name = String::from_utf8_lossy(name).into_owned();
                let count = count.ok_or_else(|| failed("a count of rows"))?;
                elements.push(Element { kin, name, count, properties: Vec::new() });
            }
            [b"property", rest @ ..] => {
                let Some(element) = elements.last_mut() else { return Err(failed("an element before its properties")) };
                element.properties.push(
                    property(rest, element.kin)
                        .ok_or_else(|| failed("property TYPE NAME or property list TYPE TYPE NAME"))?,
                );
            }
            [b"end_header"] => {
                let Some(encoding) = encoding else {
                    return Err(input.error(line.number, Kind::Missing("the format, before end_header,".into())));
                };
                check_elements(&elements).map_err(|kind| input.error(line.number, kind))?;
                return Ok(Header { encoding, elements, body: line.end, line: line.number });
            }
            _ => return Err(failed("a line of a PLY 1.0 header")),
        }
    }
    Err(input.error(None, Kind::Missing("end_header".into())))
}

/// What stands behind `property`.
fn property(fields: &[&[u8]], kin: Kin) -> Option<Property> {
    let (length, item, name) = match *fields {
        [b"list", length, item, name] => (Some(Type::of(length)?), Type::of(item)?, name),
        [item, name] => (None, Type::of(item)?, name),
        _ => return None,
    };
    let role = match (kin, length, name) {
        (Kin::Vertex, None, b"x") => Role::Coordinate(0),
        (Kin::Vertex, None, b"y") => Role::Coordinate(1),
        (Kin::Vertex, None, b"z") => Role::Coordinate(2),
        (Kin::Face, Some(_), b"vertex_indices" | b"vertex_index") => Role::Corners,
        _ => Role::Other,
    };
    if matches!(length, Some(Type::F32 | Type::F64)) {
        return None;
    }
    Some(Property { role, length, item })
}

/// Vertices with three coordinates, then faces with corners, once each.
fn check_elements(elements: &[Element]) -> Result<(), Kind> {
    let kin: Vec<Kin> = elements.iter().map(|element| element.kin).filter(|&kin| kin != Kin::Other).collect();
    match kin.as_slice() {
        [Kin::Vertex, Kin::Face] => {}
        [Kin::Vertex] | [] => return Err(Kind::Missing("element face".into())),
        [Kin::Face] => return Err(Kind::Missing("element vertex".into())),
        _ => return Err(Kind::Contradiction("element vertex and element face must occur once, in this order".into())),
    }
    let count = |wanted: Role| {
        let all = elements.iter().flat_map(|element| &element.properties);
        all.filter(|property| property.role == wanted).count()
    };
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        if count(Role::Coordinate(axis)) != 1 {
            return Err(Kind::Missing(format!("one property {name} of vertex")));
        }
    }
    if count(Role::Corners) == 1 { Ok(()) } else { Err(Kind::Missing("one property vertex_indices of face".into())) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::{Cancel, Quiet};
    use std::path::Path;

    const HEADER: &str = "ply\nformat ascii 1.0\ncomment caf\u{e9}\nelement vertex 4\nproperty float x\nproperty double y\n\
        property short z\nproperty uchar red\nelement face 2\nproperty uchar flags\nproperty list uchar int vertex_indices\n\
        element edge 99999999999\nend_header\n";

    fn read(bytes: &[u8]) -> Result<RawMesh, SceneError> {
        read_ply(&Input::alone(bytes, Path::new("a.ply"), &Quiet, &Cancel::new()))
    }

    fn binary(big: bool) -> Vec<u8> {
        let name = if big { "binary_big_endian" } else { "binary_little_endian" };
        let mut bytes = HEADER.replace("ascii", name).into_bytes();
        let mut put = |little: &[u8]| {
            let mut value = little.to_vec();
            if big {
                value.reverse();
            }
            bytes.extend(value);
        };
        for [x, y, z] in [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]] {
            put(&(x as f32).to_le_bytes());
            put(&(f64::from(y)).to_le_bytes());
            put(&(z as i16).to_le_bytes());
            put(&[7]);
        }
        for corners in [&[0_i32, 1, 2, 3][..], &[2, 1, 0]] {
            put(&[1]);
            put(&[corners.len() as u8]);
            corners.iter().for_each(|corner| put(&corner.to_le_bytes()));
        }
        bytes
    }

    fn written() -> String {
        format!("{HEADER}0 0 0 7\n1 0 0 7\r\n\n1 1 0 7\n0 1 0 7\n1 4 0 1 2 3\n1 3 2 1 0\n")
    }

    #[test]
    fn text_and_both_byte_orders_say_the_same() {
        let mesh = read(written().as_bytes()).unwrap();
        assert_eq!(mesh.triangles, [[0, 1, 2], [0, 2, 3], [2, 1, 0]]);
        assert_eq!(mesh.positions[2], DVec3::new(1.0, 1.0, 0.0));
        assert_eq!(read(&binary(false)).unwrap(), mesh);
        assert_eq!(read(&binary(true)).unwrap(), mesh);
    }

    #[test]
    fn errors_name_the_place() {
        let fails = |bytes: &[u8], want: &str| assert_eq!(read(bytes).unwrap_err().to_string(), want);
        let text = |from: &str, to: &str, want: &str| fails(written().replace(from, to).as_bytes(), want);
        text("0 1 0 7\n", "0 nan 0 7\n", "a.ply:18: coordinate of vertex 4 NaN is not a finite number");
        text("3 2 1 0", "3 2 1 9", "a.ply:20: face 2 uses vertex 9, but there are 4");
        text("3 2 1 0", "3 2 1", "a.ply:20: expected a number, found nothing");
        text("3 2 1 0", "-3 2 1 0", "a.ply:20: length of a list -3.0 is outside whole numbers from 0");
        text(
            "vertex 4",
            "vertex 4000000",
            "a.ply: the file ends early: element \"vertex\" of 4000000 rows needs 4000000 bytes, 56 are left",
        );
        text("property double y\n", "", "a.ply:12: one property y of vertex is missing");
        text(
            "double",
            "quadruple",
            "a.ply:6: expected property TYPE NAME or property list TYPE TYPE NAME, found \"property quadruple y\"",
        );
        let short = binary(false);
        fails(&short[..short.len() - 2], "a.ply: the file ends early: face 2 needs 12 bytes, 10 are left");
    }
}
