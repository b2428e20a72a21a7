// Triangles: shaded, flat or by their edges.

struct Corner {
    @location(0) position_m: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) value_bits: u32,
    @location(3) colour: vec4<f32>,
    @location(4) sides: u32,
}

struct Vertex {
    @invariant @builtin(position) clip: vec4<f32>,
    @location(0) position_m: vec3<f32>,
    @location(1) colour: vec4<f32>,
    // Value, 1 where it is known, brightness.
    @location(2) value: vec3<f32>,
    // Which corner: for distances to the edges.
    @location(3) corner: vec3<f32>,
}

// Half the width of an edge.
const HALF_EDGE_PX: f32 = 0.5;

fn drawn_from_here(corner: Corner) -> bool {
    let from_front = dot(corner.normal, to_eye(corner.position_m)) > 0.0;
    let bit = select(2u, 1u, from_front);
    return batch.look.z < 0.5 || (corner.sides & bit) != 0u;
}

fn vertex(corner: Corner, index: u32, clip: vec4<f32>) -> Vertex {
    var out: Vertex;
    out.clip = select(NOWHERE, clip, drawn_from_here(corner));
    out.position_m = corner.position_m;
    let known = is_known(corner.value_bits);
    let lit = brightness(corner.normal, to_eye(corner.position_m));
    out.value = vec3<f32>(bitcast<f32>(select(0u, corner.value_bits, known)), select(0.0, 1.0, known), lit);
    out.colour = vec4<f32>(corner.colour.rgb * lit, corner.colour.a * batch.look.y);
    out.corner = vec3<f32>(vec3<u32>(index % 3u) == vec3<u32>(0u, 1u, 2u));
    return out;
}

@vertex
fn faces_vertex(corner: Corner, @builtin(vertex_index) index: u32) -> Vertex {
    return vertex(corner, index, to_clip(corner.position_m));
}

@vertex
fn edges_vertex(corner: Corner, @builtin(vertex_index) index: u32) -> Vertex {
    return vertex(corner, index, to_clip_nearer(corner.position_m, 1.0));
}

fn face_colour(in: Vertex) -> vec4<f32> {
    if SCALED {
        return vec4<f32>(scaled(in.value.x, in.value.y > 0.9999) * in.value.z, batch.look.y);
    }
    return in.colour;
}

@fragment
fn faces_fragment(in: Vertex) -> @location(0) vec4<f32> {
    if CUT && cut_away(in.position_m) {
        discard;
    }
    return face_colour(in);
}

@fragment
fn edges_fragment(in: Vertex) -> @location(0) vec4<f32> {
    let to_edges_px = in.corner / fwidth(in.corner);
    let to_edge_px = min(to_edges_px.x, min(to_edges_px.y, to_edges_px.z));
    let coverage = clamp(HALF_EDGE_PX + 0.5 - to_edge_px, 0.0, 1.0);
    if coverage <= 0.0 || (CUT && cut_away(in.position_m)) {
        discard;
    }
    let colour = face_colour(in);
    return vec4<f32>(colour.rgb, colour.a * coverage);
}
