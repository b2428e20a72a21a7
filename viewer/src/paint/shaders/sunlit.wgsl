// Triangles under sun and sky. Their colour, decoded, is taken for their reflectance.

struct Sunlit {
    @invariant @builtin(position) clip: vec4<f32>,
    @location(0) position_m: vec3<f32>,
    @location(1) @interpolate(flat) normal: vec3<f32>,
    @location(2) @interpolate(flat) colour: vec4<f32>,
}

@vertex
fn sunlit_vertex(corner: Corner) -> Sunlit {
    let clip = select(NOWHERE, to_clip(corner.position_m), drawn_from_here(corner));
    return Sunlit(clip, corner.position_m, corner.normal, corner.colour);
}

@fragment
fn sunlit_fragment(in: Sunlit) -> @location(0) vec4<f32> {
    if CUT && cut_away(in.position_m) {
        discard;
    }
    let normal = select(-in.normal, in.normal, dot(in.normal, to_eye(in.position_m)) > 0.0);
    var light_klx = sky_light(normal);
    let facing = dot(normal, skylight.towards_sun.xyz);
    if facing > 0.0 && any(skylight.beam.rgb > vec3<f32>(0.0)) {
        light_klx += skylight.beam.rgb * facing * sun_share(in.position_m, normal, depth_m(in.position_m));
    }
    let rgb = decoded(in.colour.rgb) * light_klx / 3.14159265;
    return vec4<f32>(toned(rgb), in.colour.a * batch.look.y);
}
