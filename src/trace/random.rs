//! Which random numbers does a block of samples take?
//!
//! SplitMix64 (Steele, Lea & Flood 2014), started from a hash of the seed, the sensor's number and the block's number. Each
//! block has a stream of its own whichever thread works on it, so the thread count cannot change a bit of the result.

/// A stream of uniform numbers.
pub(super) struct Random {
    state: u64,
}

/// SplitMix64's increment, the odd number nearest to 2^64 over the golden ratio.
const STEP: u64 = 0x9e37_79b9_7f4a_7c15;

impl Random {
    /// The stream of that block of that sensor.
    pub(super) fn new(seed: u64, sensor: u64, block: u64) -> Self {
        let state = [sensor, block].into_iter().fold(mixed(seed.wrapping_add(STEP)), |state, part| {
            mixed(state.wrapping_add(STEP) ^ mixed(part.wrapping_add(STEP)))
        });
        Self { state }
    }

    /// Uniform in [0, 1), in steps of 2^-53.
    pub(super) fn number(&mut self) -> f64 {
        self.state = self.state.wrapping_add(STEP);
        (mixed(self.state) >> 11) as f64 / (1_u64 << 53) as f64
    }

    /// Two of them.
    pub(super) fn pair(&mut self) -> [f64; 2] {
        [self.number(), self.number()]
    }
}

fn mixed(mut bits: u64) -> u64 {
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ (bits >> 31)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn it_is_splitmix64() {
        // Vigna's splitmix64.c from state 1234567.
        let mut random = Random { state: 1_234_567 };
        random.number();
        assert_eq!(random.state, 1_234_567_u64.wrapping_add(STEP));
        assert_eq!(mixed(random.state), 6_457_827_717_110_365_317);
        assert_eq!(mixed(random.state.wrapping_add(STEP)), 3_203_168_211_198_807_973);
    }

    #[test]
    fn streams_differ_and_are_uniform() {
        let mut starts = BTreeSet::new();
        for (seed, sensor, block) in (0..1000).map(|at| (at / 100, at / 10 % 10, at % 10)) {
            starts.insert(Random::new(seed, sensor, block).state);
        }
        assert_eq!(starts.len(), 1000);
        let (mut sum, mut squares) = (0.0, 0.0);
        let mut random = Random::new(1, 2, 3);
        for _ in 0..100_000 {
            let number = random.number();
            assert!((0.0..1.0).contains(&number));
            sum += number;
            squares += number * number;
        }
        assert!((sum / 1e5 - 0.5).abs() < 0.004 && (squares / 1e5 - 1.0 / 3.0).abs() < 0.004);
    }
}
