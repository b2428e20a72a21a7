// The depths that the camera sees: nearest, farthest, and how many pixels by depth.

struct Reading {
    // Near plane, metres: reversed depth is near / depth.
    near_m: f32,
    least_m: f32,
    bins_an_octave: f32,
}

struct Seen {
    // Bits of positive floats are ordered as they are.
    first: atomic<u32>,
    last: atomic<u32>,
    pixels: array<atomic<u32>, 256>,
}

@group(0) @binding(0) var<uniform> reading: Reading;
@group(0) @binding(1) var depths: texture_depth_2d;
@group(0) @binding(2) var<storage, read_write> seen: Seen;

@compute @workgroup_size(8, 8)
fn seen_of(@builtin(global_invocation_id) pixel: vec3<u32>) {
    if any(pixel.xy >= textureDimensions(depths)) {
        return;
    }
    let depth = textureLoad(depths, pixel.xy, 0);
    if depth <= 0.0 {
        return;
    }
    let depth_m = reading.near_m / depth;
    atomicMin(&seen.first, bitcast<u32>(depth_m));
    atomicMax(&seen.last, bitcast<u32>(depth_m));
    let bin = log2(depth_m / reading.least_m) * reading.bins_an_octave;
    atomicAdd(&seen.pixels[u32(clamp(bin, 0.0, 255.0))], 1u);
}
