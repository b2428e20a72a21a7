//! What does a Wavefront OBJ file say?
//!
//! Taken: `v`, `f` (any number of corners, negative and interleaved indices), `usemtl`, `mtllib`, `o`, `g`, and lines
//! continued by a backslash. A face without `usemtl` takes the name of its object or group, whichever came last, as its
//! material's name, so that a scene file can give it properties. Texture coordinates, normals, lines and points are
//! passed over. A face may only use vertices above it in the file.

use super::polygon::{Cut, tangled, triangulate};
use super::{RawMesh, check_vertices, mtl, part as numbered};
use crate::job::Quiet;
use crate::scene::error::{Kind, SceneError};
use crate::scene::input::{Input, Lines, counted, next_triple, shown, text, without_mark, words};
use std::borrow::Cow;
use std::collections::HashMap;

/// Statements that say nothing about faces and are passed over in silence.
const PASSED_OVER: [&[u8]; 9] = [b"vt", b"vn", b"vp", b"s", b"l", b"p", b"cstype", b"shadow_obj", b"trace_obj"];

/// Reads an OBJ file and the material files it names.
///
/// Material files that do not exist are a warning; one that exists beside the mesh, though its path as written does not,
/// is taken.
///
/// # Errors
/// [`SceneError`] with the line: numbers that are none, coordinates that are not finite or too large, indices without a
/// vertex, a broken material file. A file without faces is an empty mesh, not an error here.
pub fn read_obj(input: &Input) -> Result<RawMesh, SceneError> {
    let mut mesh = RawMesh::default();
    let (mut names, mut parts) = (HashMap::new(), HashMap::new());
    let mut library = HashMap::new();
    let (mut material, mut part) = (String::new(), input.stem());
    let (mut current, mut current_part, mut corners) = (None, None, Vec::new());
    let (mut unknown, mut crossing) = (0_usize, 0_usize);

    let mut stage = input.parse();
    let mut lines = Lines::new(without_mark(input.bytes));
    while let Some(first) = lines.next() {
        stage.done(first.end)?;
        let number = first.number;
        let failed = |kind| input.error(number, kind);

        // A backslash at the end of a line joins the next one to it.
        let mut line = Cow::Borrowed(first.bytes);
        while let Some(joined) = line.strip_suffix(b"\\") {
            let mut joined = joined.to_vec();
            joined.push(b' ');
            joined.extend_from_slice(lines.next().map_or(&[][..], |next| next.bytes));
            line = Cow::Owned(joined);
        }

        let mut rest = words(&line);
        match rest.next() {
            None => {}
            Some(b"v") => {
                let point = next_triple(&mut rest, "a coordinate").map_err(failed)?;
                mesh.positions.push(input.position(number, "a vertex", point)?);
                check_vertices(input, mesh.positions.len())?;
            }
            Some(b"f" | b"fo") => {
                corners.clear();
                for word in rest {
                    corners.push(corner(word, mesh.positions.len()).map_err(failed)?);
                }
                let number = *current.get_or_insert_with(|| {
                    let name = if material.is_empty() { &part } else { &material };
                    mesh.material(&mut names, name)
                });
                match triangulate(&corners, &mesh.positions, &mut mesh.triangles) {
                    Cut::Whole => {}
                    Cut::TooFewCorners => mesh.too_few_corners += 1,
                    Cut::Crossing => crossing += 1,
                }
                mesh.material_of.resize(mesh.triangles.len(), number);
                let number = *current_part.get_or_insert_with(|| numbered(&mut mesh.parts, &mut parts, &part));
                mesh.part_of.resize(mesh.triangles.len(), number);
            }
            Some(b"usemtl") => (material, current) = (name_after(&line, b"usemtl"), None),
            Some(word @ (b"o" | b"g")) => {
                let name = name_after(&line, word);
                part = if name.is_empty() { input.stem() } else { name };
                (current, current_part) = (None, None);
            }
            Some(b"mtllib") => read_libraries(input, &name_after(&line, b"mtllib"), &mut library, &mut mesh.warnings)?,
            Some(word) if word.starts_with(b"#") || PASSED_OVER.contains(&word) => {}
            Some(_) => unknown += 1,
        }
    }
    drop(stage);

    give_properties(&mut mesh, &library);
    if unknown > 0 {
        mesh.warnings.push(format!("{} left out", counted(unknown, "unknown statement")));
    }
    if crossing > 0 {
        mesh.warnings.push(tangled(crossing));
    }
    Ok(mesh)
}

/// The vertex number of one corner, from 0; only what stands before the first `/` counts.
fn corner(word: &[u8], count: usize) -> Result<u32, Kind> {
    let digits = word.split(|&byte| byte == b'/').next().unwrap_or_default();
    let parsed = std::str::from_utf8(digits).ok().and_then(|digits| digits.parse::<i64>().ok());
    let Some(index) = parsed else {
        return Err(Kind::Syntax { expected: "a vertex number".into(), found: shown(word) });
    };
    let from_zero = if index < 0 { index.saturating_add(count as i64) } else { index - 1 };
    if index == 0 || from_zero < 0 || from_zero >= count as i64 {
        return Err(Kind::NoSuchVertex { face: "a face".into(), index, count });
    }
    u32::try_from(from_zero).map_err(|_| Kind::NoSuchVertex { face: "a face".into(), index, count })
}

/// What stands behind the statement `word` on a line, as text without blanks around it.
fn name_after(line: &[u8], word: &[u8]) -> String {
    let start = line.trim_ascii_start();
    text(start.strip_prefix(word).unwrap_or(start).trim_ascii())
}

/// Reads the material files that one `mtllib` names: one whose name may have blanks, or else several.
fn read_libraries(
    input: &Input,
    names: &str,
    library: &mut HashMap<String, mtl::Properties>,
    warnings: &mut Vec<String>,
) -> Result<(), SceneError> {
    if read_library(input, names, library, warnings)? {
        return Ok(());
    }
    let several: Vec<&str> = names.split_whitespace().collect();
    for name in &several {
        if several.len() < 2 || !read_library(input, name, library, warnings)? {
            warnings.push(format!("material file {name:?} is missing"));
        }
    }
    Ok(())
}

/// Reads one material file, where it is said to be or beside the mesh; `false` if it is in neither place.
fn read_library(
    input: &Input,
    name: &str,
    library: &mut HashMap<String, mtl::Properties>,
    warnings: &mut Vec<String>,
) -> Result<bool, SceneError> {
    // Exporters write paths of their own machine, with the separators of theirs.
    let written = name.replace('\\', "/");
    let beside = written.rsplit('/').next().unwrap_or_default();
    for candidate in [written.as_str(), beside] {
        let (path, bytes) = match input.neighbour(candidate, &Quiet) {
            Ok(found) => found,
            Err(error) if error.is_cancelled() => return Err(error),
            Err(_) => continue,
        };
        let input = Input { path: &path, bytes: &bytes, folder: None, progress: &Quiet, ..*input };
        let read = mtl::read_mtl(&input)?;
        warnings.extend(read.warnings);
        for (name, properties) in read.materials {
            library.entry(name).or_insert(properties);
        }
        return Ok(true);
    }
    Ok(false)
}

/// Gives the materials that faces use the properties that the material files have for them. A name that only an object
/// or a group gave is not looked up.
fn give_properties(mesh: &mut RawMesh, library: &HashMap<String, mtl::Properties>) {
    for material in &mut mesh.materials {
        if let Some(properties) = library.get(&material.name) {
            material.reflectance = properties.reflectance;
            material.emission_w_m2_sr = properties.emission_w_m2_sr;
        }
    }
    let missing = mesh.materials.iter().filter(|material| !library.contains_key(&material.name)).count();
    if missing > 0 && !library.is_empty() {
        mesh.warnings.push(format!("{} in no material file", counted(missing, "material")));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::{Cancel, Quiet};
    use std::path::Path;

    fn read(text: &str) -> Result<RawMesh, SceneError> {
        read_obj(&Input::alone(text.as_bytes(), Path::new("room.obj"), &Quiet, &Cancel::new()))
    }

    #[track_caller]
    fn fails(text: &str, want: &str) {
        let error = read(text).expect_err("this file is broken").to_string();
        assert!(error.contains(want), "{error}");
    }

    #[test]
    fn interleaved_negative_and_slashed_indices_give_the_same_faces() {
        let positive = read("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
        let negative = read("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3/1/1 -2//1 -1/4\n").unwrap();
        assert_eq!(positive, negative);
        assert_eq!(positive.triangles, [[0, 1, 2]]);
        let interleaved = read("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -3 -2 -1\nv 0 0 1\nf -1 \\\n 1 2\n").unwrap();
        assert_eq!(interleaved.triangles, [[0, 1, 2], [3, 0, 1]]);
    }

    #[test]
    fn objects_and_groups_name_faces_without_a_material() {
        let mesh =
            read("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\no door\nf 1 2 3\nusemtl red\nf 1 2 3\ng b\nf 1 2 3").unwrap();
        let names: Vec<_> =
            mesh.material_of.iter().map(|&number| mesh.materials[number as usize].name.as_str()).collect();
        assert_eq!(names, ["room", "door", "red", "red"]);
    }

    #[test]
    fn errors_name_the_line() {
        fails("v 0 0 0\nv 1 nan 0\n", "room.obj:2: coordinate of a vertex NaN is not a finite number");
        fails("v 0 0 1e400\n", "room.obj:1: coordinate of a vertex inf");
        fails("v 0 0 1e30\n", "room.obj:1: coordinate of a vertex 1e30 is outside -1e8 to 1e8 m");
        fails("# a\nv 0 0\n", "room.obj:2: expected a coordinate, a number, found nothing");
        fails("v 0 0 0\nf 1 2 3\n", "room.obj:2: a face uses vertex 2, but there are 1");
        fails("v 0 0 0\nf 0 1 1\n", "room.obj:2: a face uses vertex 0");
        fails("v 0 0 0\nf 1 -2 1\n", "room.obj:2: a face uses vertex -2");
        fails("v 0 0 0\nf 1 x 1\n", "room.obj:2: expected a vertex number, found \"x\"");
    }

    #[test]
    fn a_missing_material_file_is_a_warning() {
        let mesh = read("mtllib gone.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\nvapour 3\n").unwrap();
        assert_eq!(mesh.warnings, ["material file \"gone.mtl\" is missing", "1 unknown statement left out"]);
    }
}
