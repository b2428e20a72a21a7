//! Behaviour of the library and the program, one module a topic.

/// Broken files, and edits of sound ones.
mod bad_input;
/// Scene files, meshes, sensors and references as they should be.
mod scene_files;
