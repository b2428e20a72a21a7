// Triangles under sun and sky. Their colour, decoded, is taken for their reflectance.

struct Sunlit {
    @invariant @builtin(position) clip: vec4<f32>,
    @location(0) position_m: vec3<f32>,
    // Of the side that is seen: the same all over a triangle, like what it sends back.
    @location(1) @interpolate(flat) normal: vec3<f32>,
    // What it sends back of sky and ground, kcd/m2; w: opacity.
    @location(2) @interpolate(flat) of_sky: vec4<f32>,
    // And of the whole sun.
    @location(3) @interpolate(flat) of_sun: vec3<f32>,
}

@vertex
fn sunlit_vertex(corner: Corner) -> Sunlit {
    let clip = select(NOWHERE, to_clip(corner.position_m), drawn_from_here(corner));
    let normal = select(-corner.normal, corner.normal, dot(corner.normal, to_eye(corner.position_m)) > 0.0);
    let sent_back = decoded(corner.colour.rgb) / 3.14159265;
    let of_sky = vec4<f32>(sent_back * sky_light(normal), corner.colour.a * batch.look.y);
    let of_sun = sent_back * skylight.beam.rgb * max(dot(normal, skylight.towards_sun.xyz), 0.0);
    return Sunlit(clip, corner.position_m, normal, of_sky, of_sun);
}

@fragment
fn sunlit_fragment(in: Sunlit) -> @location(0) vec4<f32> {
    if CUT && cut_away(in.position_m) {
        discard;
    }
    var rgb = in.of_sky.rgb;
    if any(in.of_sun > vec3<f32>(0.0)) {
        rgb += in.of_sun * sun_share(in.position_m, in.normal, depth_m(in.position_m));
    }
    return vec4<f32>(toned(rgb), in.of_sky.a);
}
