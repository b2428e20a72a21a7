//! Colours of values, dark to bright: points of the perceptually even scale "inferno" (van der Walt & Smith).

/// All of it but for black: for maps that fill their place.
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

/// What a linear scale from 0 spans, and where it has its marks.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span {
    /// The value at its bright end.
    pub top: f64,
    /// From mark to mark.
    pub step: f64,
}

impl Span {
    /// From 0 to 1.
    pub const SHARES: Self = Self { top: 1.0, step: 0.2 };

    /// From 0 to just above a value, four to ten marks by 1, 2 or 5; to 1 where there is none above 0.
    pub fn up_to(value: f64) -> Self {
        if !(value.is_finite() && value > 0.0) {
            return Self::SHARES;
        }
        let decade = 10_f64.powf((value / 4.0).log10().floor());
        let step = [5.0, 2.0, 1.0].map(|digit| digit * decade).into_iter().find(|step| value / step >= 4.0);
        let step = step.unwrap_or(decade);
        Self { top: (value / step).ceil() * step, step }
    }

    /// The part of the scale at which a value is, 0 to 1.
    pub fn part(self, value: f64) -> f64 {
        (value / self.top).clamp(0.0, 1.0)
    }

    /// Its marks, from 0 up.
    pub fn marks(self) -> Vec<f64> {
        (0..=(self.top / self.step).round() as u32).map(|mark| f64::from(mark) * self.step).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spans_end_at_a_mark_just_above_the_value() {
        for (value, top, step) in [(1687.3, 1800.0, 200.0), (0.43, 0.5, 0.1), (4.0, 4.0, 1.0), (39.0, 40.0, 5.0)] {
            let span = Span::up_to(value);
            assert!((span.top - top).abs() < 1e-9 && (span.step - step).abs() < 1e-9, "{value}: {span:?}");
            assert!((4..=11).contains(&span.marks().len()));
            assert!((span.part(value) - value / top).abs() < 1e-9 && span.part(2.0 * value) == 1.0);
        }
        assert_eq!([0.0, f64::NAN].map(Span::up_to), [Span::SHARES; 2]);
    }

    #[test]
    fn a_scale_runs_from_its_first_point_to_its_last() {
        assert_eq!([-1.0, 0.0].map(|part| colour(&INFERNO_ON_WHITE, part)), [[40, 11, 84]; 2]);
        assert_eq!([1.0, 7.0].map(|part| colour(&INFERNO_ON_WHITE, part)), [[252, 230, 120]; 2]);
        assert_eq!(colour(&INFERNO_ON_WHITE, 0.25), [130, 32, 105]);
    }
}
