// The sky behind everything, with the sun's disc, over the ground round about.

struct Vertex {
    @builtin(position) clip: vec4<f32>,
    @location(0) across: vec2<f32>,
}

// How fast the ground clears up below the horizon, from the colour of the sky there: to half within 0.7 degrees.
const CLEARING: f32 = 60.0;

@vertex
fn sky_vertex(@builtin(vertex_index) index: u32) -> Vertex {
    let corner = vec2<f32>(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0;
    return Vertex(vec4<f32>(corner, 0.0, 1.0), corner);
}

@fragment
fn sky_fragment(in: Vertex) -> @location(0) vec4<f32> {
    // A parallel projection has the sky of the perspective that shows its target at the same size.
    let aside = in.across.x * view.right.w * view.right.xyz + in.across.y * view.up.w * view.up.xyz;
    let direction = normalize(view.forward.xyz + aside);

    var rgb = sky_colour(direction);
    let from_middle_rad = 2.0 * asin(0.5 * min(distance(direction, skylight.towards_sun.xyz), 2.0));
    let px_rad = 2.0 * view.up.w / view.size_px.y;
    let disc_rad = skylight.towards_sun.w;
    let in_disc = clamp((disc_rad - from_middle_rad) / px_rad + 0.5, 0.0, 1.0);
    rgb += in_disc * skylight.beam.rgb / (3.14159265 * disc_rad * disc_rad);

    // Towards the horizon the ground fades into the air before it.
    let horizon = normalize(vec3<f32>(direction.xy, 1e-4));
    let haze = exp(CLEARING * min(direction.z, 0.0));
    let ground = mix(skylight.ground.rgb, sky_colour(horizon), haze);
    return vec4<f32>(toned(select(ground, rgb, direction.z > 0.0)), 1.0);
}
