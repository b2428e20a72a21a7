//! Behaviour of the library and the program, one module a topic.

/// Broken files, and edits of sound ones.
mod bad_input;
/// Scene files, meshes, sensors and references as they should be.
mod scene_files;

/// The scenes under the sky, and what Radiance says of them.
mod outdoor_scenes;

/// The path tracer against closed forms.
mod physics;

/// The path tracer against an independent renderer.
mod references;

/// Who may use whom, and what no library module does.
mod layers;

/// The program as a user meets it.
mod program;

/// Stability where methods fail.
mod stress;

/// The generated scenes, modelled.
mod modelled;

/// The files that are written.
mod written;

/// Topology kept, structures valid, on every scene.
mod topology;

/// The same bits on any number of threads.
mod threads;

/// Long steps stop when asked to.
mod cancel;

/// One set of laws of physics, for every estimator.
mod conformance;

/// The sun against SPA's own program, almanacs and published tables; clear skies against pvlib.
mod sun;

/// Weather files, and the sky of a year against Radiance.
mod weather;

/// Sky models against an independent implementation.
mod sky_colour;

/// Steps of a period, the exposure map, and the command `sky`.
mod exposure;

/// What surfaces receive of sun and sky.
mod daylight;

/// What surfaces reflect of sun and sky.
mod reflected;

/// Exposure by latitude and turbidity, as physics and the paper have it.
mod exposure_trends;

/// Exposure of odd scenes and places: right, or refused with a reason.
mod exposure_robust;

/// Real cities against Radiance.
mod cities;

/// Exposure on faces, at vertices, and in pictures.
mod views;

/// Parts of a scene moved, scaled or hidden.
mod dynamic;

/// Exposure by maps, at one scale and at two.
mod scales;

/// What a renderer is seeded with: whole scenes, files, the command.
mod guide;
mod guided;
