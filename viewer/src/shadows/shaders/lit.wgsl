// What figures are made of: the share of the sun and the depth at each pixel. Behind it goes lookup.wgsl.

struct Eye {
    clip_from_scene: mat4x4<f32>,
    // Gaze; w: what is added to a point's component along it, for its depth.
    forward: vec4<f32>,
    // Eye; w is 1 in perspective and 0 in a parallel projection.
    eye_m: vec4<f32>,
}

@group(0) @binding(0) var<uniform> eye: Eye;

struct Vertex {
    @builtin(position) clip: vec4<f32>,
    @location(0) position_m: vec3<f32>,
}

@vertex
fn lit_vertex(@location(0) position_m: vec3<f32>) -> Vertex {
    return Vertex(eye.clip_from_scene * vec4<f32>(position_m, 1.0), position_m);
}

@fragment
fn lit_fragment(in: Vertex) -> @location(0) vec2<f32> {
    let across = cross(dpdx(in.position_m), dpdy(in.position_m));
    let toward_eye = select(-eye.forward.xyz, eye.eye_m.xyz - in.position_m, eye.eye_m.w > 0.5);
    let normal = normalize(across) * select(-1.0, 1.0, dot(across, toward_eye) > 0.0);
    let depth_m = dot(in.position_m, eye.forward.xyz) + eye.forward.w;
    return vec2<f32>(sun_share(in.position_m, normal, depth_m), depth_m);
}
