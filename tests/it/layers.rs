//! The invariants of ARCHITECTURE.md that can be read off the source: who may use whom, and what no library module does.

use std::fs;
use std::path::{Path, PathBuf};

/// The modules in the order in which they may use each other: each may name itself and those before it.
const ORDER: [&str; 16] = [
    "job", "space", "scene", "rays", "voxel", "skeleton", "sky", "light", "model", "flow", "trace", "daylight",
    "guide", "study", "export", "cli",
];

/// Pairs that stand beside each other and never meet, though the order would let the second use the first.
const PEERS: [(&str, &str); 1] = [("flow", "trace")];

/// Modules that may touch files.
const TOUCH_FILES: [&str; 3] = ["scene", "export", "cli"];

/// What marks a file being touched, a clock being read, a generator without a seed, or a panic that waits to happen.
const FILE_MARKS: [&str; 4] = ["std::fs", "fs::", "File::", "OpenOptions"];
const CLOCK_MARKS: [&str; 2] = ["Instant", "SystemTime"];
const UNSEEDED_MARKS: [&str; 3] = ["thread_rng", "from_entropy", "RandomState::new"];

#[test]
fn every_module_uses_only_those_before_it() {
    for (module, path, code) in sources() {
        let Some(place) = ORDER.iter().position(|&name| name == module) else {
            panic!("{}: module {module} has no place in the order", path.display());
        };
        for &later in &ORDER[place + 1..] {
            assert!(!uses(&code, later), "{}: {module} uses {later}, which stands after it", path.display());
        }
        for (a, b) in PEERS {
            let peer = if module == a { b } else { a };
            let is_peer = module == a || module == b;
            assert!(!(is_peer && uses(&code, peer)), "{}: {module} uses its peer {peer}", path.display());
        }
    }
}

#[test]
fn only_scene_export_and_cli_touch_files() {
    for (module, path, code) in sources().into_iter().filter(|(module, ..)| !TOUCH_FILES.contains(&module.as_str())) {
        for mark in FILE_MARKS {
            assert!(!code.contains(mark), "{}: {module} has {mark}", path.display());
        }
    }
}

#[test]
fn no_library_module_reads_the_clock_or_an_unseeded_generator() {
    for (module, path, code) in sources().into_iter().filter(|(module, ..)| module != "cli") {
        for mark in CLOCK_MARKS.iter().chain(&UNSEEDED_MARKS) {
            assert!(!code.contains(mark), "{}: {module} has {mark}", path.display());
        }
    }
}

#[test]
fn no_library_module_prints_or_unwraps() {
    for (module, path, code) in sources() {
        let marks: &[&str] = if module == "cli" {
            &[".unwrap()", ".expect("]
        } else {
            &[".unwrap()", ".expect(", "println!", "eprintln!", "dbg!"]
        };
        for mark in marks {
            assert!(!code.contains(mark), "{}: {module} has {mark}", path.display());
        }
    }
}

#[test]
fn the_library_forbids_unsafe_code() {
    let library = fs::read_to_string(root().join("lib.rs")).unwrap();
    assert!(library.contains("#![forbid(unsafe_code)]"));
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("src")
}

/// Each source file that belongs to a module: the module, the path, and its code without comments and without its tests.
fn sources() -> Vec<(String, PathBuf, String)> {
    let mut found = Vec::new();
    let mut folders = vec![root()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
                continue;
            }
            // Data stand beside the code that reads them.
            if path.extension().is_none_or(|extension| extension != "rs") {
                continue;
            }
            let inside = path.strip_prefix(root()).unwrap();
            let first = inside.components().next().unwrap().as_os_str().to_str().unwrap();
            let module = first.trim_end_matches(".rs").to_owned();
            let is_test = path.file_stem().is_some_and(|stem| stem.to_string_lossy().starts_with("test"));
            if module != "lib" && module != "main" && !is_test {
                found.push((module, path.clone(), code_of(&fs::read_to_string(&path).unwrap())));
            }
        }
    }
    assert!(found.len() > ORDER.len(), "the sources were not found");
    found
}

/// The code of a file: no comments, nothing from its `mod tests` on.
fn code_of(text: &str) -> String {
    let text = text.replace("pub(crate) mod tests", "mod tests");
    let before_tests = text.split("#[cfg(test)]\nmod tests").next().unwrap_or_default();
    before_tests.lines().filter(|line| !line.trim_start().starts_with("//")).map(|line| format!("{line}\n")).collect()
}

/// Whether code names a module of this crate, as `crate::name` or inside `crate::{...}`.
fn uses(code: &str, module: &str) -> bool {
    let is_name = |rest: &str| !rest.starts_with(|next: char| next.is_alphanumeric() || next == '_');
    let direct = code.match_indices(&format!("crate::{module}")).any(|(at, found)| is_name(&code[at + found.len()..]));
    let grouped = code.match_indices("crate::{").any(|(at, found)| {
        let group = code[at + found.len()..].split(';').next().unwrap_or_default();
        group.split([',', '{', '}', ' ', '\n']).any(|part| part.split("::").next() == Some(module))
    });
    direct || grouped
}

#[test]
fn the_reader_of_uses_sees_both_forms() {
    assert!(uses("use crate::flow::paths;", "flow"));
    assert!(uses("use crate::{job::Cancel, flow};", "flow"));
    assert!(!uses("use crate::flowers;", "flow"));
}
