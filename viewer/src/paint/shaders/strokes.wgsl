// Lines of constant width on screen, each by one rectangle in which the fragment finds its distance to the line.

struct Stroke {
    @location(0) a_m: vec3<f32>,
    @location(1) width_px: f32,
    @location(2) b_m: vec3<f32>,
    @location(3) value_bits: u32,
    @location(4) colour: vec4<f32>,
    // Bit 0: dashed; bit 1: an arrow head at b.
    @location(5) kind: u32,
}

struct Vertex {
    @builtin(position) clip: vec4<f32>,
    // Both ends on the screen.
    @location(0) @interpolate(flat) ends_px: vec4<f32>,
    @location(1) @interpolate(flat) half_px: f32,
    @location(2) @interpolate(flat) kind: u32,
    @location(3) @interpolate(flat) colour: vec4<f32>,
}

// Arrow heads: half their width in half widths of the line, at least in pixels; their length in half their width.
const HEAD_HALF: f32 = 3.0;
const HEAD_HALF_LEAST_PX: f32 = 5.0;
const HEAD_LENGTH: f32 = 2.2;
// Dashes and the gaps between them, in widths of the line and in pixels besides.
const DASH: vec2<f32> = vec2<f32>(2.0, 4.0);
const GAP: vec2<f32> = vec2<f32>(1.0, 3.0);
// How much nearer than they are strokes are drawn: those on a surface are not swallowed by it, and the balls that they
// join still hide them.
const NEARER_PX: f32 = 0.75;

// The part of a line, as shares of it, on the side of a plane where `a` and `b`, the signed distances of its ends
// to the plane, are above zero.
fn kept(part: vec2<f32>, a: f32, b: f32) -> vec2<f32> {
    let crossing = a / select(a - b, 1.0, a == b);
    if a <= 0.0 && b <= 0.0 {
        return vec2<f32>(1.0, 0.0);
    }
    return vec2<f32>(select(part.x, max(part.x, crossing), a < 0.0), select(part.y, min(part.y, crossing), b < 0.0));
}

fn on_screen_px(clip: vec4<f32>) -> vec2<f32> {
    return (vec2<f32>(clip.x, -clip.y) / clip.w * 0.5 + 0.5) * view.size_px.xy;
}

fn head_half_px(half_px: f32) -> f32 {
    return max(half_px * HEAD_HALF, HEAD_HALF_LEAST_PX);
}

@vertex
fn strokes_vertex(stroke: Stroke, @builtin(vertex_index) index: u32) -> Vertex {
    // Only what lies before the eye and on the kept side of the cuts has a place on the screen.
    var part = vec2<f32>(0.0, 1.0);
    if in_perspective() {
        let near_m = view.size_px.z * 1.01;
        part = kept(part, depth_m(stroke.a_m) - near_m, depth_m(stroke.b_m) - near_m);
    }
    if CUT {
        for (var i = 0; i < 2; i++) {
            let cut = view.cuts[i];
            if dot(cut.xyz, cut.xyz) > 0.0 {
                part = kept(part, cut.w - dot(cut.xyz, stroke.a_m), cut.w - dot(cut.xyz, stroke.b_m));
            }
        }
    }
    let a = to_clip_nearer(mix(stroke.a_m, stroke.b_m, part.x), NEARER_PX);
    let b = to_clip_nearer(mix(stroke.a_m, stroke.b_m, part.y), NEARER_PX);

    var out: Vertex;
    out.ends_px = vec4<f32>(on_screen_px(a), on_screen_px(b));
    out.half_px = stroke.width_px * 0.5;
    out.kind = stroke.kind & select(1u, 3u, part.y == 1.0);
    out.colour = tinted(stroke.value_bits, stroke.colour);

    let line_px = out.ends_px.zw - out.ends_px.xy;
    let along = select(vec2<f32>(1.0, 0.0), line_px / max(length(line_px), 1e-6), length(line_px) > 1e-3);
    let reach_px = select(out.half_px, head_half_px(out.half_px), (out.kind & 2u) != 0u) + 1.0;
    let at_b = (index & 1u) == 1u;
    let beside = select(-1.0, 1.0, (index & 2u) != 0u);
    let shift_px = (along * select(-1.0, 1.0, at_b) + vec2<f32>(-along.y, along.x) * beside) * reach_px;
    let end = select(a, b, at_b);
    let shift = shift_px / view.size_px.xy * 2.0 * end.w;
    let clip = vec4<f32>(end.x + shift.x, end.y - shift.y, end.zw);
    out.clip = select(NOWHERE, clip, part.x <= part.y && stroke.width_px > 0.0);
    return out;
}

@fragment
fn strokes_fragment(in: Vertex) -> @location(0) vec4<f32> {
    let line_px = in.ends_px.zw - in.ends_px.xy;
    let length_px = length(line_px);
    let along = select(vec2<f32>(1.0, 0.0), line_px / max(length_px, 1e-6), length_px > 1e-3);
    let from_a_px = in.clip.xy - in.ends_px.xy;
    let on = dot(from_a_px, along);
    let beside = abs(dot(from_a_px, vec2<f32>(-along.y, along.x)));

    // A short arrow has a small head; its line ends within it.
    let arrow = (in.kind & 2u) != 0u;
    let head_px = min(head_half_px(in.half_px) * HEAD_LENGTH, max(length_px, 4.0));
    let end_px = select(length_px, max(length_px - head_px * 0.5, 0.0), arrow);
    var outside_px = length(vec2<f32>(on - clamp(on, 0.0, end_px), beside)) - in.half_px;
    if (in.kind & 1u) != 0u {
        let width_px = in.half_px * 2.0;
        let dash_px = DASH.x * width_px + DASH.y;
        let period_px = dash_px + GAP.x * width_px + GAP.y;
        let within = on - floor(on / period_px) * period_px;
        outside_px = max(outside_px, abs(within - dash_px * 0.5) - dash_px * 0.5);
    }
    if arrow {
        let half_px = (length_px - on) / HEAD_LENGTH;
        let head_outside_px = max((beside - half_px) * 0.92, length_px - head_px - on);
        outside_px = min(outside_px, head_outside_px);
    }

    let coverage = clamp(0.5 - outside_px, 0.0, 1.0);
    if coverage <= 0.0 {
        discard;
    }
    return vec4<f32>(in.colour.rgb, in.colour.a * coverage);
}
