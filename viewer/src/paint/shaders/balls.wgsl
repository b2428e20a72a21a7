// Spheres, each by one square that covers its outline: the fragment meets the sphere with its own ray.

struct Ball {
    @location(0) centre_m: vec3<f32>,
    @location(1) radius_m: f32,
    @location(2) value_bits: u32,
    @location(3) colour: vec4<f32>,
}

struct Vertex {
    @builtin(position) clip: vec4<f32>,
    @location(0) position_m: vec3<f32>,
    @location(1) @interpolate(flat) centre_m: vec3<f32>,
    // Radius in metres, and a pixel at the centre in metres.
    @location(2) @interpolate(flat) radius_m: vec2<f32>,
    @location(3) @interpolate(flat) colour: vec4<f32>,
}

struct Fragment {
    @builtin(frag_depth) depth: f32,
    @location(0) colour: vec4<f32>,
}

// Brightness at the outline; the middle has the ball's own colour, so that it can be read off.
const DIMMEST: f32 = 0.45;

@vertex
fn balls_vertex(ball: Ball, @builtin(vertex_index) index: u32) -> Vertex {
    let px_m = metres_per_px(ball.centre_m);
    let radius_m = clamp(ball.radius_m, batch.sizes.x * px_m, max(batch.sizes.x, batch.sizes.y) * px_m);
    let toward = -to_eye(ball.centre_m);
    let away_m = length(toward);

    // The outline lies where rays touch: in perspective nearer than the centre, so its shadow at the centre is larger.
    var outline_m = radius_m;
    var right = view.right.xyz;
    var up = view.up.xyz;
    if in_perspective() {
        outline_m = radius_m * away_m / sqrt(max(away_m * away_m - radius_m * radius_m, 1e-12));
        right = normalize(cross(toward, view.up.xyz));
        up = normalize(cross(right, toward));
    }
    let hidden = (in_perspective() && (away_m <= radius_m * 1.001 || depth_m(ball.centre_m) < view.size_px.z))
        || radius_m <= 0.0 || (CUT && cut_away(ball.centre_m));

    let corner = vec2<f32>(f32(index & 1u), f32(index >> 1u & 1u)) * 2.0 - 1.0;
    let reach_m = (outline_m + px_m) * corner;
    var out: Vertex;
    out.position_m = ball.centre_m + right * reach_m.x + up * reach_m.y;
    out.clip = select(to_clip(out.position_m), NOWHERE, hidden);
    out.centre_m = ball.centre_m;
    out.radius_m = vec2<f32>(radius_m, px_m);
    out.colour = tinted(ball.value_bits, ball.colour);
    return out;
}

@fragment
fn balls_fragment(in: Vertex) -> Fragment {
    let origin_m = select(in.position_m, view.eye_m.xyz, in_perspective());
    let direction = normalize(-to_eye(in.position_m));
    let from_centre_m = origin_m - in.centre_m;
    let nearest_m = from_centre_m - direction * dot(from_centre_m, direction);
    let missed_m = length(nearest_m);
    let coverage = clamp((in.radius_m.x - missed_m) / in.radius_m.y + 0.5, 0.0, 1.0);
    if coverage <= 0.0 {
        discard;
    }

    let height_m = sqrt(max(in.radius_m.x * in.radius_m.x - missed_m * missed_m, 0.0));
    let clip = to_clip(in.centre_m + nearest_m - direction * height_m);
    let lit = mix(DIMMEST, 1.0, height_m / in.radius_m.x);
    var out: Fragment;
    out.depth = clamp(clip.z / clip.w, 0.0, 1.0);
    out.colour = vec4<f32>(in.colour.rgb * lit, in.colour.a * coverage);
    return out;
}
