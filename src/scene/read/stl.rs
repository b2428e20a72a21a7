//! What does an STL file say?
//!
//! Binary if the length is what the triangle count at byte 80 asks for, whatever the header says (many binary files
//! begin with "solid"); else text if it begins with `solid`. Normals are passed over: the winding tells the front. The
//! name of a solid, or else of the file, names the material of its faces.

use super::{RawMesh, check_vertices};
use crate::scene::error::{Kind, SceneError};
use crate::scene::input::{Input, Lines, counted, next_triple, shown, text, without_mark, words};
use glam::DVec3;
use std::collections::HashMap;

/// Bytes before the first triangle of a binary file: a free header and the number of triangles.
const HEADER: usize = 84;

/// Bytes of a binary triangle: normal, three corners and an attribute.
const TRIANGLE: usize = 50;

/// Reads an STL file, text or binary.
///
/// # Errors
/// [`SceneError`], with the line for text: coordinates that are not finite or too large, a binary file that is shorter
/// than its count says, text that is not STL.
pub fn read_stl(input: &Input) -> Result<RawMesh, SceneError> {
    let bytes = input.bytes;
    let count = bytes.get(80..HEADER).and_then(|count| count.try_into().ok()).map(u32::from_le_bytes);
    let needed = count.map(|count| HEADER as u64 + u64::from(count) * TRIANGLE as u64);
    let starts = without_mark(bytes).trim_ascii_start().get(..5).unwrap_or_default();
    if needed != Some(bytes.len() as u64) && starts.eq_ignore_ascii_case(b"solid") {
        return read_text(input);
    }
    match needed {
        Some(needed) if needed <= bytes.len() as u64 => read_binary(input, (bytes.len() as u64 - needed) as usize),
        Some(needed) => {
            let what = format!("a binary STL of {} triangles", count.unwrap_or_default());
            Err(input.error(None, Kind::EndsEarly { what, needed, left: bytes.len() as u64 }))
        }
        None => {
            let found = shown(bytes.get(..HEADER).unwrap_or(bytes));
            Err(input.error(None, Kind::Syntax { expected: "\"solid\" or a binary STL".into(), found }))
        }
    }
}

/// A binary file, with so many bytes behind its last triangle.
fn read_binary(input: &Input, behind: usize) -> Result<RawMesh, SceneError> {
    let mut mesh = RawMesh::default();
    let material = mesh.material(&mut HashMap::new(), &input.stem());
    let mut stage = input.parse();
    let body = input.bytes.get(HEADER..input.bytes.len() - behind).unwrap_or_default();
    for (number, triangle) in body.chunks_exact(TRIANGLE).enumerate() {
        stage.done(HEADER + number * TRIANGLE)?;
        let floats = triangle.get(12..48).unwrap_or_default().chunks_exact(4);
        let mut floats = floats.map(|float| f64::from(f32::from_le_bytes(float.try_into().unwrap_or_default())));
        let mut corner = || DVec3::from_array([(); 3].map(|()| floats.next().unwrap_or(f64::NAN)));
        let corners = [corner(), corner(), corner()];
        for corner in corners {
            // The words are made for the error alone.
            if !input.fits(corner) {
                input.position(None, &format!("triangle {}", number + 1), corner)?;
            }
        }
        push(input, &mut mesh, material, corners)?;
    }
    if behind > 0 {
        mesh.warnings.push(format!("{} behind the last triangle left out", counted(behind, "byte")));
    }
    Ok(mesh)
}

fn read_text(input: &Input) -> Result<RawMesh, SceneError> {
    let mut mesh = RawMesh::default();
    let mut names = HashMap::new();
    let mut material = None;
    // The corners of the facet that is open, if one is.
    let mut facet: Option<Vec<DVec3>> = None;
    let mut open = false;
    let mut stage = input.parse();
    for line in Lines::new(without_mark(input.bytes)) {
        stage.done(line.end)?;
        let failed = |kind| input.error(line.number, kind);
        let unexpected = |expected: &str| {
            failed(Kind::Syntax { expected: expected.to_owned(), found: shown(line.bytes.trim_ascii()) })
        };
        let mut rest = words(line.bytes);
        let Some(keyword) = rest.next() else { continue };
        match (keyword.to_ascii_lowercase().as_slice(), &mut facet) {
            (b"solid", None) if !open => {
                let name = text(line.bytes.trim_ascii().get(5..).unwrap_or_default().trim_ascii());
                let name = if name.is_empty() { input.stem() } else { name };
                open = true;
                material = Some(mesh.material(&mut names, &name));
            }
            (b"facet", None) if open => facet = Some(Vec::with_capacity(3)),
            (b"vertex", Some(corners)) if corners.len() < 3 => {
                let corner = next_triple(&mut rest, "a coordinate").map_err(failed)?;
                corners.push(input.position(line.number, "a vertex", corner)?);
            }
            (b"outer" | b"endloop", Some(_)) => {}
            (b"endsolid", None) => open = false,
            (b"endfacet", Some(corners)) => {
                let &[a, b, c] = corners.as_slice() else { return Err(unexpected("three vertices in a facet")) };
                let number = material.unwrap_or_default();
                push(input, &mut mesh, number, [a, b, c])?;
                facet = None;
            }
            (_, Some(_)) => return Err(unexpected("three vertices and endfacet")),
            (_, None) => return Err(unexpected(if open { "facet or endsolid" } else { "solid" })),
        }
    }
    if open {
        let kind = Kind::Syntax { expected: "endsolid".into(), found: "the end of the file".into() };
        return Err(input.error(None, kind));
    }
    Ok(mesh)
}

/// Adds a triangle with corners of its own.
fn push(input: &Input, mesh: &mut RawMesh, material: u32, corners: [DVec3; 3]) -> Result<(), SceneError> {
    let first = mesh.positions.len() as u32;
    mesh.positions.extend(corners);
    check_vertices(input, mesh.positions.len())?;
    mesh.triangles.push([first, first + 1, first + 2]);
    mesh.material_of.push(material);
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::{Cancel, Quiet};
    use std::path::Path;

    const TEXT: &str = "solid lid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n";

    fn read(bytes: &[u8]) -> Result<RawMesh, SceneError> {
        read_stl(&Input::alone(bytes, Path::new("a.stl"), &Quiet, &Cancel::new()))
    }

    fn binary(corners: &[[f32; 9]]) -> Vec<u8> {
        let mut bytes = b"solid but binary".to_vec();
        bytes.resize(80, b' ');
        bytes.extend((corners.len() as u32).to_le_bytes());
        for triangle in corners {
            bytes.extend([0; 12]);
            bytes.extend(triangle.iter().flat_map(|c| c.to_le_bytes()));
            bytes.extend([0; 2]);
        }
        bytes
    }

    #[test]
    fn text_and_binary_say_the_same() {
        let from_text = read(TEXT.as_bytes()).unwrap();
        let from_binary = read(&binary(&[[0., 0., 0., 1., 0., 0., 0., 1., 0.]])).unwrap();
        assert_eq!((&from_text.positions, &from_text.triangles), (&from_binary.positions, &from_binary.triangles));
        let mut with_more = [binary(&[[0., 0., 0., 1., 0., 0., 0., 1., 0.]]), vec![0; 60]].concat();
        with_more[..5].fill(b'-');
        let with_more = read(&with_more).unwrap();
        assert_eq!(with_more.positions, from_binary.positions);
        assert_eq!(with_more.warnings, ["60 bytes behind the last triangle left out"]);
        assert_eq!((from_text.materials[0].name.as_str(), from_binary.materials[0].name.as_str()), ("lid", "a"));
    }

    #[test]
    fn errors_name_the_place() {
        let fails = |bytes: &[u8], want: &str| assert_eq!(read(bytes).unwrap_err().to_string(), want);
        fails(
            TEXT.replace("vertex 1 0 0", "vertex 1 0 x").as_bytes(),
            "a.stl:5: expected a coordinate, a number, found \"x\"",
        );
        fails(
            TEXT.replace("vertex 1 0 0\n", "").as_bytes(),
            "a.stl:7: expected three vertices in a facet, found \"endfacet\"",
        );
        fails(b"hello", "a.stl: expected \"solid\" or a binary STL, found \"hello\"");
        let whole = binary(&[[0., 0., 0., f32::NAN, 0., 0., 0., 1., 0.]]);
        fails(&whole, "a.stl: coordinate of triangle 1 NaN is not a finite number");
        fails(
            &[&[0; 80][..], &[9, 0, 0, 0], &[0; 50]].concat(),
            "a.stl: the file ends early: a binary STL of 9 triangles needs 534 bytes, 134 are left",
        );
    }
}
