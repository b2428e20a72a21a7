//! Colours of values, dark to bright: points of the perceptually even scale "inferno" (van der Walt & Smith).

/// All of it but for black: for maps that fill their place.
#[cfg(feature = "cli")]
pub const INFERNO: [[f32; 3]; 8] = [
    [8.0, 6.0, 30.0],
    [59.0, 15.0, 112.0],
    [112.0, 25.0, 110.0],
    [164.0, 44.0, 96.0],
    [212.0, 72.0, 66.0],
    [245.0, 125.0, 21.0],
    [250.0, 193.0, 39.0],
    [252.0, 255.0, 164.0],
];

/// Without its ends: for lines on white.
pub const INFERNO_ON_WHITE: [[f32; 3]; 7] = [
    [40.0, 11.0, 84.0],
    [101.0, 21.0, 110.0],
    [159.0, 42.0, 99.0],
    [212.0, 72.0, 66.0],
    [245.0, 125.0, 21.0],
    [250.0, 193.0, 39.0],
    [252.0, 230.0, 120.0],
];

/// The colour, red, green and blue, at a part of a scale: 0 its dark end, 1 its bright one, beyond as there.
pub fn colour<const N: usize>(scale: &[[f32; 3]; N], part: f64) -> [u8; 3] {
    let along = part.clamp(0.0, 1.0) as f32 * (N - 1) as f32;
    let [low, high] = [along.floor(), along.ceil()].map(|step| scale[step as usize]);
    std::array::from_fn(|channel| (low[channel] + (high[channel] - low[channel]) * along.fract()).round() as u8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scale_runs_from_its_first_point_to_its_last() {
        assert_eq!([-1.0, 0.0].map(|part| colour(&INFERNO_ON_WHITE, part)), [[40, 11, 84]; 2]);
        assert_eq!([1.0, 7.0].map(|part| colour(&INFERNO_ON_WHITE, part)), [[252, 230, 120]; 2]);
        assert_eq!(colour(&INFERNO_ON_WHITE, 0.25), [130, 32, 105]);
    }
}
