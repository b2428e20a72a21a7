// Faces of voxels: squares that face along an axis, their borders a little darker so that they can be counted.

struct Cube {
    @location(0) centre_m: vec3<f32>,
    @location(1) face: u32,
    @location(2) value_bits: u32,
    @location(3) colour: vec4<f32>,
}

struct Vertex {
    @builtin(position) clip: vec4<f32>,
    @location(0) position_m: vec3<f32>,
    @location(1) @interpolate(flat) colour: vec4<f32>,
    @location(2) on_face: vec2<f32>,
}

// How much of the colour a border keeps, and the least size on screen of a face that shows one.
const BORDER: f32 = 0.8;
const LEAST_PX: f32 = 8.0;

@vertex
fn cubes_vertex(cube: Cube, @builtin(vertex_index) index: u32) -> Vertex {
    let axis = cube.face >> 1u;
    let normal = vec3<f32>(vec3<u32>(axis) == vec3<u32>(0u, 1u, 2u)) * select(1.0, -1.0, (cube.face & 1u) == 1u);
    let corner = vec2<f32>(f32(index & 1u), f32(index >> 1u & 1u)) * 2.0 - 1.0;
    var along = vec3<f32>(corner, 0.0);
    if axis == 0u {
        along = vec3<f32>(0.0, corner);
    } else if axis == 1u {
        along = vec3<f32>(corner.y, 0.0, corner.x);
    }

    var out: Vertex;
    out.position_m = cube.centre_m + (normal + along) * batch.sizes.x * 0.5;
    let from_behind = dot(normal, to_eye(out.position_m)) <= 0.0;
    let hidden = axis > 2u || (batch.look.z > 0.5 && from_behind);
    out.clip = select(to_clip(out.position_m), NOWHERE, hidden);
    let colour = tinted(cube.value_bits, cube.colour);
    out.colour = vec4<f32>(colour.rgb * brightness(normal, to_eye(cube.centre_m)), colour.a);
    out.on_face = corner;
    return out;
}

@fragment
fn cubes_fragment(in: Vertex) -> @location(0) vec4<f32> {
    let per_px = fwidth(in.on_face);
    if CUT && cut_away(in.position_m) {
        discard;
    }
    let to_border_px = (1.0 - abs(in.on_face)) / per_px;
    let bordered = min(to_border_px.x, to_border_px.y) < 1.0 && 2.0 / max(per_px.x, per_px.y) > LEAST_PX;
    return vec4<f32>(in.colour.rgb * select(1.0, BORDER, bordered), in.colour.a);
}
