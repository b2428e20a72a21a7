// Copies a finished picture to where the window wants it, pixel by pixel.

struct Vertex {
    @builtin(position) clip: vec4<f32>,
    @location(0) place: vec2<f32>,
}

@group(0) @binding(0) var picture: texture_2d<f32>;
@group(0) @binding(1) var nearest: sampler;

// Whether the window wants linear colours.
override LINEAR: bool = false;

@vertex
fn blit_vertex(@builtin(vertex_index) index: u32) -> Vertex {
    let corner = vec2<f32>(f32(index & 1u), f32(index >> 1u)) * 2.0;
    return Vertex(vec4<f32>(corner * 2.0 - 1.0, 0.0, 1.0), vec2<f32>(corner.x, 1.0 - corner.y));
}

@fragment
fn blit_fragment(in: Vertex) -> @location(0) vec4<f32> {
    let encoded = textureSample(picture, nearest, in.place).rgb;
    let linear = select(pow((encoded + 0.055) / 1.055, vec3<f32>(2.4)), encoded / 12.92, encoded < vec3<f32>(0.04045));
    return vec4<f32>(select(encoded, linear, LINEAR), 1.0);
}
