// What every shader knows: the view, the batch and how values become colours.
//
// Scene space: metres, Z up. Depth is reversed, as the camera makes it: the larger the nearer.

struct View {
    clip_from_scene: mat4x4<f32>,
    // Eye; w is 1 in perspective and 0 in a parallel projection.
    eye_m: vec4<f32>,
    // Gaze; w: metres a pixel, at a depth of one metre in perspective and everywhere in a parallel projection.
    forward: vec4<f32>,
    // To the right and upwards; w: half of the picture's width and height at a distance of one, in perspective.
    right: vec4<f32>,
    up: vec4<f32>,
    // Width, height and the nearest depth drawn in metres.
    size_px: vec4<f32>,
    // Normal and offset of what is cut away; a normal of zero cuts nothing.
    cuts: array<vec4<f32>, 2>,
    background_top: vec4<f32>,
    background_bottom: vec4<f32>,
}

struct Batch {
    // The scale as a straight line: share = (place - x) * y + z; place is the value, or its log2 where w is 1.
    straight: vec4<f32>,
    // Row of the colour map, opacity, 1 where only sides to the void are drawn, 1 where shaded.
    look: vec4<f32>,
    // Balls: least and greatest radius in pixels. Cubes: the edge in metres.
    sizes: vec4<f32>,
    // Colour of what has no value.
    grey: vec4<f32>,
}

@group(0) @binding(0) var<uniform> view: View;
@group(0) @binding(1) var maps: texture_2d<f32>;
@group(1) @binding(0) var<uniform> batch: Batch;

// Whether colours come from values.
override SCALED: bool = false;
// Whether the picture's cuts apply.
override CUT: bool = false;

// Where nothing is drawn: a triangle of such corners has no extent.
const NOWHERE: vec4<f32> = vec4<f32>(2.0, 2.0, 2.0, 1.0);

fn in_perspective() -> bool {
    return view.eye_m.w > 0.5;
}

fn depth_m(point_m: vec3<f32>) -> f32 {
    return dot(point_m - view.eye_m.xyz, view.forward.xyz);
}

fn metres_per_px(point_m: vec3<f32>) -> f32 {
    return select(view.forward.w, view.forward.w * max(depth_m(point_m), view.size_px.z), in_perspective());
}

// Towards the viewer, of any length.
fn to_eye(point_m: vec3<f32>) -> vec3<f32> {
    return select(-view.forward.xyz, view.eye_m.xyz - point_m, in_perspective());
}

fn to_clip(point_m: vec3<f32>) -> vec4<f32> {
    return view.clip_from_scene * vec4<f32>(point_m, 1.0);
}

// A point drawn some pixels' worth nearer than it is, where it lies on a surface that would else hide it.
fn to_clip_nearer(point_m: vec3<f32>, pixels: f32) -> vec4<f32> {
    let clip = to_clip(point_m);
    let shifted = to_clip(point_m + normalize(to_eye(point_m)) * pixels * metres_per_px(point_m));
    return vec4<f32>(clip.xy, shifted.z / shifted.w * clip.w, clip.w);
}

fn cut_away(point_m: vec3<f32>) -> bool {
    return dot(view.cuts[0].xyz, point_m) > view.cuts[0].w || dot(view.cuts[1].xyz, point_m) > view.cuts[1].w;
}

// NaN by its bits: shaders may take for granted that there is none.
fn is_known(value_bits: u32) -> bool {
    return (value_bits & 0x7fffffffu) <= 0x7f800000u;
}

// The colour of a value through the batch's scale.
fn scaled(value: f32, known: bool) -> vec3<f32> {
    let logarithmic = batch.straight.w > 0.5;
    if !known || (logarithmic && value <= 0.0) {
        return batch.grey.rgb;
    }
    let place = select(value, log2(value), logarithmic);
    let share = clamp((place - batch.straight.x) * batch.straight.y + batch.straight.z, 0.0, 1.0);
    return textureLoad(maps, vec2<i32>(i32(share * 255.0 + 0.5), i32(batch.look.x)), 0).rgb;
}

// The colour of a thing that has one value and one own colour.
fn tinted(value_bits: u32, own: vec4<f32>) -> vec4<f32> {
    if SCALED {
        return vec4<f32>(scaled(bitcast<f32>(select(0u, value_bits, is_known(value_bits))), is_known(value_bits)), batch.look.y);
    }
    return vec4<f32>(own.rgb, own.a * batch.look.y);
}

// How bright a surface of this normal looks: a light at the viewer, one above the viewer's left shoulder and a sky.
// From 0.45 to 1, so that nothing is black.
fn brightness(normal: vec3<f32>, toward_eye: vec3<f32>) -> f32 {
    let eyeward = normalize(toward_eye);
    let facing = select(-normal, normal, dot(normal, eyeward) > 0.0);
    let shoulder = normalize(eyeward + 0.7 * view.up.xyz - 0.5 * view.right.xyz);
    let lit = 0.45 + 0.2 * dot(facing, eyeward) + 0.2 * max(dot(facing, shoulder), 0.0) + 0.15 * (0.5 + 0.5 * facing.z);
    return mix(1.0, lit, batch.look.w);
}
