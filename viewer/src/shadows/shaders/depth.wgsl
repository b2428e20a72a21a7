// Depth alone, from the sun or from the camera.

@group(0) @binding(0) var<uniform> clip_from_scene: mat4x4<f32>;

@vertex
fn depth_vertex(@location(0) position_m: vec3<f32>) -> @builtin(position) vec4<f32> {
    return clip_from_scene * vec4<f32>(position_m, 1.0);
}
