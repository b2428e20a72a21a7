// Sun and sky: Perez' form in Y, x and y (Preetham, Shirley and Smits 1999), their light on surfaces, tones for the screen.

struct Skylight {
    // Towards the sun; w: radius of its disc, radians.
    towards_sun: vec4<f32>,
    // On a surface that faces the sun, klx; w: the luminance that shows at 63%, kcd/m2.
    beam: vec4<f32>,
    // Of the ground beyond the scene, kcd/m2.
    ground: vec4<f32>,
    // Y (kcd/m2), x and y at the zenith, over Perez' form there.
    zenith: vec4<f32>,
    // A to E, each for Y, x and y.
    perez: array<vec4<f32>, 5>,
    // What sky and ground cast on surfaces, klx, by harmonic.
    harmonics: array<vec4<f32>, 9>,
}

@group(0) @binding(2) var<uniform> skylight: Skylight;

const LUMINANCE: vec3<f32> = vec3<f32>(0.2126, 0.7152, 0.0722);

// Linear sRGB of the sky, kcd/m2, towards a direction not below the horizon.
fn sky_colour(direction: vec3<f32>) -> vec3<f32> {
    let cos_zenith = max(direction.z, 1e-6);
    let cos_gamma = clamp(dot(direction, skylight.towards_sun.xyz), -1.0, 1.0);
    let gamma = acos(cos_gamma);
    let darkening = 1.0 + skylight.perez[0].xyz * exp(skylight.perez[1].xyz / cos_zenith);
    let glow = 1.0 + skylight.perez[2].xyz * exp(skylight.perez[3].xyz * gamma) + skylight.perez[4].xyz * cos_gamma * cos_gamma;
    let seen = max(skylight.zenith.xyz * darkening * glow, vec3<f32>(0.0));
    if seen.z <= 0.0 {
        return vec3<f32>(0.0);
    }
    let xyz = vec3<f32>(seen.y, seen.z, 1.0 - seen.y - seen.z) * seen.x / seen.z;
    let rgb = vec3<f32>(
        dot(vec3<f32>(3.2406, -1.5372, -0.4986), xyz),
        dot(vec3<f32>(-0.9689, 1.8758, 0.0415), xyz),
        dot(vec3<f32>(0.0557, -0.2040, 1.0570), xyz),
    );
    return max(rgb, vec3<f32>(0.0));
}

// What sky and ground cast on a surface of this normal, klx.
fn sky_light(normal: vec3<f32>) -> vec3<f32> {
    let n = normal;
    var sum = 0.28209479 * skylight.harmonics[0].rgb;
    sum += 0.48860251 * (n.y * skylight.harmonics[1].rgb + n.z * skylight.harmonics[2].rgb + n.x * skylight.harmonics[3].rgb);
    sum += 1.09254843 * (n.x * n.y * skylight.harmonics[4].rgb + n.y * n.z * skylight.harmonics[5].rgb + n.x * n.z * skylight.harmonics[7].rgb);
    sum += 0.31539157 * (3.0 * n.z * n.z - 1.0) * skylight.harmonics[6].rgb;
    sum += 0.54627422 * (n.x * n.x - n.y * n.y) * skylight.harmonics[8].rgb;
    return max(sum, vec3<f32>(0.0));
}

// A luminance on the screen, as lightvein::sky::colour::tone_mapped has it.
fn toned(rgb: vec3<f32>) -> vec3<f32> {
    let seen = dot(rgb, LUMINANCE);
    if seen <= 0.0 {
        return vec3<f32>(0.0);
    }
    let grey = 1.0 - exp(-seen / skylight.beam.w);
    let mapped = rgb * (grey / seen);
    // Towards grey until the strongest channel fits.
    let strongest = max(max(mapped.r, mapped.g), max(mapped.b, grey));
    let colour = select(1.0, (1.0 - grey) / max(strongest - grey, 1e-9), strongest > 1.0);
    return encoded(clamp(grey + (mapped - grey) * colour, vec3<f32>(0.0), vec3<f32>(1.0)));
}

// sRGB's code of linear values: above the straight part by roots, which cost less than a power and are within 0.01 of 255.
fn encoded(linear: vec3<f32>) -> vec3<f32> {
    let root = sqrt(linear);
    let root4 = sqrt(root);
    let root8 = sqrt(root4);
    let high = 0.65393536 * root + 0.68883897 * root4 - 0.31858495 * root8 - 0.02018098 * linear - 0.00403996;
    return select(high, 12.92 * linear, linear <= vec3<f32>(0.0031308));
}

// Back, exactly.
fn decoded(code: vec3<f32>) -> vec3<f32> {
    return select(pow((code + 0.055) / 1.055, vec3<f32>(2.4)), code / 12.92, code <= vec3<f32>(0.04045));
}
