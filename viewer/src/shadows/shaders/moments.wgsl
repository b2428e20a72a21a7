// Moments of a map's depth within a layer's range, blurred: first along rows from the depths, then along columns.

struct Making {
    // Depth of the map to the layer's range, -1 to 1: t = depth * x + y.
    warp: vec2<f32>,
    // Depths a side of a texel of moments, and how far the blur reaches in texels: 0 or 2.
    depths: i32,
    reach: i32,
    // Texels a side of the moments.
    size: i32,
}

@group(0) @binding(0) var<uniform> making: Making;
@group(1) @binding(0) var depths: texture_depth_2d;
@group(1) @binding(1) var rows: texture_2d<f32>;

// A Gaussian of one texel.
const WEIGHTS = array<f32, 3>(0.38774, 0.24477, 0.06136);

@vertex
fn moments_vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4<f32> {
    return vec4<f32>(vec2<f32>(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0, 0.0, 1.0);
}

// Mean moments of the depths of one texel; beyond the border those of the border.
fn made(texel: vec2<i32>) -> vec2<f32> {
    let first = clamp(texel, vec2<i32>(0), vec2<i32>(making.size - 1)) * making.depths;
    var sum = vec2<f32>(0.0);
    for (var y = 0; y < making.depths; y++) {
        for (var x = 0; x < making.depths; x++) {
            let depth = textureLoad(depths, first + vec2<i32>(x, y), 0);
            let t = clamp(depth * making.warp.x + making.warp.y, -1.0, 1.0);
            sum += vec2<f32>(t, t * t);
        }
    }
    return sum / f32(making.depths * making.depths);
}

fn weight(offset: i32) -> f32 {
    return select(WEIGHTS[abs(offset)], 1.0, making.reach == 0);
}

@fragment
fn rows_fragment(@builtin(position) position: vec4<f32>) -> @location(0) vec2<f32> {
    let texel = vec2<i32>(position.xy);
    var sum = vec2<f32>(0.0);
    for (var offset = -making.reach; offset <= making.reach; offset++) {
        sum += weight(offset) * made(texel + vec2<i32>(offset, 0));
    }
    return sum;
}

@fragment
fn columns_fragment(@builtin(position) position: vec4<f32>) -> @location(0) vec2<f32> {
    let texel = vec2<i32>(position.xy);
    var sum = vec2<f32>(0.0);
    for (var offset = -making.reach; offset <= making.reach; offset++) {
        let row = clamp(texel.y + offset, 0, making.size - 1);
        sum += weight(offset) * textureLoad(rows, vec2<i32>(texel.x, row), 0).xy;
    }
    return sum;
}
