// How much of the sun reaches a point, by the maps: `sun_share`.

struct ShadowLayer {
    clip_from_scene: mat4x4<f32>,
    // Where the layer begins, where the next begins, where it ends, metres; a texel, metres.
    bounds_m: vec4<f32>,
    // Depth of the map to the layer's range: t = depth * x + y. Least variance. How far a point is lifted, metres at a right angle.
    making: vec4<f32>,
    // Class, its place among the maps or moments of its class, texels a side, 1 where depths are compared.
    place: vec4<u32>,
}

struct Shadows {
    // Direction to the sun; w: length of a shared map along the rays, metres, or 0 where the camera's depth tells the layer.
    towards: vec4<f32>,
    // Layers; 1 where both of two that overlap answer; texels of a comparison: 1, or 4 a side; 1 where a point's plane is followed.
    mode: vec4<u32>,
    layers: array<ShadowLayer, 16>,
}

@group(2) @binding(0) var<uniform> shadows: Shadows;
@group(2) @binding(1) var shadow_depths: texture_depth_2d_array;
@group(2) @binding(2) var shadow_moments_a: texture_2d_array<f32>;
@group(2) @binding(3) var shadow_moments_b: texture_2d_array<f32>;
@group(2) @binding(4) var shadow_moments_c: texture_2d_array<f32>;
@group(2) @binding(5) var shadow_texels: sampler;

// Share of the sun at a point of a surface whose normal, of length one, points to the side that is seen; its depth along the gaze.
fn sun_share(position_m: vec3<f32>, normal: vec3<f32>, depth_m: f32) -> f32 {
    if shadows.mode.x == 0u || dot(normal, shadows.towards.xyz) <= 0.0 {
        return select(0.0, 1.0, dot(normal, shadows.towards.xyz) > 0.0);
    }
    var key_m = depth_m;
    if shadows.towards.w > 0.0 {
        key_m = (shadows.layers[0].clip_from_scene * vec4<f32>(position_m, 1.0)).z * shadows.towards.w;
    }
    var layer = 0u;
    while layer + 1u < shadows.mode.x && key_m >= shadows.layers[layer].bounds_m.y {
        layer++;
    }
    let own = sun_by_layer(layer, position_m, normal);
    if shadows.mode.y == 0u || layer == 0u || key_m >= shadows.layers[max(layer, 1u) - 1u].bounds_m.z {
        return own;
    }
    // The medium bound.
    let before = sun_by_layer(layer - 1u, position_m, normal);
    return min(own, before) + 0.5 * abs(own - before);
}

fn sun_by_layer(number: u32, position_m: vec3<f32>, normal: vec3<f32>) -> f32 {
    let making = shadows.layers[number].making;
    let place = shadows.layers[number].place;
    let clip_from_scene = shadows.layers[number].clip_from_scene;
    let towards = shadows.towards.xyz;
    // The more a surface is tilted, the farther it is lifted; and all by a little, for rounding.
    let cosine = dot(normal, towards);
    let lifted_m = position_m + making.w * (normal * sqrt(max(1.0 - cosine * cosine, 0.0)) + 0.2 * towards);
    let clip = clip_from_scene * vec4<f32>(lifted_m, 1.0);
    if any(abs(clip.xy) > vec2<f32>(1.0)) {
        return 1.0;
    }
    let at = vec2<f32>(0.5 + 0.5 * clip.x, 0.5 - 0.5 * clip.y);
    if place.w == 0u {
        return sun_by_moments(place, at, making, clip.z);
    }
    let slope = select(vec2<f32>(0.0), plane_slope(clip_from_scene, normal), shadows.mode.w == 1u) / f32(place.z);
    if shadows.mode.z == 1u {
        return sun_by_texel(place, at, clip.z, slope);
    }
    return sun_by_neighbours(place, at, clip.z, slope);
}

// How the depth of a surface's plane changes across the whole map.
fn plane_slope(clip_from_scene: mat4x4<f32>, normal: vec3<f32>) -> vec2<f32> {
    let rows = transpose(clip_from_scene);
    let across = vec2<f32>(dot(rows[0].xyz, normal) / dot(rows[0].xyz, rows[0].xyz),
        dot(rows[1].xyz, normal) / dot(rows[1].xyz, rows[1].xyz));
    let along = dot(rows[2].xyz, normal) / dot(rows[2].xyz, rows[2].xyz);
    // Along the rays a lit surface's normal points back to the sun; where it grazes, the plane is as good as along them.
    let slope = -across / min(along, GRAZING / length(rows[2].xyz));
    return 2.0 * vec2<f32>(slope.x, -slope.y);
}

// Cosine of the angle to the sun beyond which planes are not followed: 89 degrees.
const GRAZING: f32 = -0.0175;

// One comparison, with the plane's depth at the middle of the texel. Only where the plane comes nearer to the sun: where it
// goes on away from it, it may do so below a ground on which the surface stands.
fn sun_by_texel(place: vec4<u32>, at: vec2<f32>, depth: f32, slope: vec2<f32>) -> f32 {
    let texel = min(floor(at * f32(place.z)), vec2<f32>(f32(place.z - 1u)));
    let here = depth + min(dot(slope, texel + 0.5 - at * f32(place.z)), 0.0);
    return select(0.0, 1.0, here <= textureLoad(shadow_depths, vec2<i32>(texel), place.y, 0));
}

// Nine bilinear comparisons, a texel apart: those of 4 x 4 texels, gathered by fours.
fn sun_by_neighbours(place: vec4<u32>, at: vec2<f32>, depth: f32, slope: vec2<f32>) -> f32 {
    let size = f32(place.z);
    let texel = at * size - 0.5;
    let first = floor(texel);
    let share = texel - first;
    var low = array<vec2<f32>, 2>(vec2<f32>(1.0) - share, vec2<f32>(1.0));
    var high = array<vec2<f32>, 2>(vec2<f32>(1.0), share);
    var sum = 0.0;
    for (var y = 0u; y < 2u; y++) {
        for (var x = 0u; x < 2u; x++) {
            // The corner that four texels share, and the plane's depth at their middles; counter-clockwise from the lower left.
            let corner = first + vec2<f32>(f32(x), f32(y)) * 2.0;
            let near = vec2<f32>(-0.5) + corner - at * size;
            let risen = slope.x * vec4<f32>(near.x, near.x + 1.0, near.x + 1.0, near.x)
                + slope.y * vec4<f32>(near.y + 1.0, near.y + 1.0, near.y, near.y);
            let here = depth + min(risen, vec4<f32>(0.0));
            let map = textureGather(shadow_depths, shadow_texels, corner / size, i32(place.y));
            let lit = select(vec4<f32>(0.0), vec4<f32>(1.0), here <= map);
            let across = vec2<f32>(low[x].x, high[x].x);
            let down = vec2<f32>(low[y].y, high[y].y);
            sum += dot(lit, vec4<f32>(across.x * down.y, across.y * down.y, across.y * down.x, across.x * down.x));
        }
    }
    return sum / 9.0;
}

// Chebyshev's upper bound on the share of the map that lies no nearer to the sun.
fn sun_by_moments(place: vec4<u32>, at: vec2<f32>, making: vec4<f32>, depth: f32) -> f32 {
    let t = clamp(depth * making.x + making.y, -1.0, 1.0);
    let texel = at * f32(place.z) - 0.5;
    let first = floor(texel);
    let share = texel - first;
    let last = i32(place.z) - 1;
    var rows = array<vec2<f32>, 2>();
    for (var y = 0; y < 2; y++) {
        let row = clamp(i32(first.y) + y, 0, last);
        let left = shadow_moments(place, vec2<i32>(clamp(i32(first.x), 0, last), row));
        let right = shadow_moments(place, vec2<i32>(clamp(i32(first.x) + 1, 0, last), row));
        rows[y] = mix(left, right, share.x);
    }
    let moments = mix(rows[0], rows[1], share.y);
    let past = t - moments.x;
    if past <= 0.0 {
        return 1.0;
    }
    let variance = max(moments.y - moments.x * moments.x, making.z);
    return variance / (variance + past * past);
}

fn shadow_moments(place: vec4<u32>, texel: vec2<i32>) -> vec2<f32> {
    if place.x == 0u {
        return textureLoad(shadow_moments_a, texel, place.y, 0).xy;
    }
    if place.x == 1u {
        return textureLoad(shadow_moments_b, texel, place.y, 0).xy;
    }
    return textureLoad(shadow_moments_c, texel, place.y, 0).xy;
}
