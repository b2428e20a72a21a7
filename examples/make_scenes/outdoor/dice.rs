//! Chance that falls the same way on every machine: SplitMix64 (Steele, Lea and Flood 2014).

/// A seeded generator.
pub struct Dice(u64);

impl Dice {
    /// The generator of a seed.
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    /// From 0 up to 1.
    pub fn share(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }

    /// Between two bounds.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.share()
    }

    /// A length between two bounds in whole tenths of a metre.
    pub fn length_m(&mut self, low: f64, high: f64) -> f64 {
        (self.between(low, high) * 10.0).round() / 10.0
    }

    /// Whether something happens that does so with this probability.
    pub fn falls(&mut self, probability: f64) -> bool {
        self.share() < probability
    }
}
