// The background: a fade from the top to the bottom, behind everything.

struct Vertex {
    @builtin(position) clip: vec4<f32>,
    @location(0) down: f32,
}

@vertex
fn background_vertex(@builtin(vertex_index) index: u32) -> Vertex {
    let corner = vec2<f32>(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0;
    return Vertex(vec4<f32>(corner, 0.0, 1.0), (1.0 - corner.y) * 0.5);
}

@fragment
fn background_fragment(in: Vertex) -> @location(0) vec4<f32> {
    return mix(view.background_top, view.background_bottom, in.down);
}
