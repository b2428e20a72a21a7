//! A map at half its size, and half of that: a texel of a level is the sum of the four under it.
//!
//! Energies add up, so every level holds the same energy; divided by a texel's solid angle it is the mean radiance there,
//! which is what filtering a map for a wide cone wants. Odd sizes round up, their last texels being the sum of fewer.

/// One level: columns, rows, and the energies of its texels, row by row.
#[derive(Debug, Clone, PartialEq)]
pub struct Level {
    /// Columns and rows.
    pub size: [usize; 2],
    /// In the unit of the map.
    pub energies: Vec<f32>,
}

/// All levels of a map, the map itself first, a single texel last. A third more than the map.
pub fn levels(size: [usize; 2], energies: &[f32]) -> Vec<Level> {
    let mut levels = vec![Level { size, energies: energies.to_vec() }];
    while let Some(last) = levels.last().filter(|level| level.size[0] > 1 || level.size[1] > 1) {
        levels.push(last.halved());
    }
    levels
}

impl Level {
    fn halved(&self) -> Self {
        let size = self.size.map(|texels| texels.div_ceil(2));
        let mut energies = vec![0.0; size[0] * size[1]];
        for (number, energy) in self.energies.iter().enumerate() {
            let (column, row) = (number % self.size[0], number / self.size[0]);
            energies[row / 2 * size[0] + column / 2] += energy;
        }
        Self { size, energies }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_level_holds_all_the_energy() {
        for size in [[8, 8], [5, 3], [1, 7], [1, 1]] {
            let energies: Vec<f32> = (0..size[0] * size[1]).map(|number| number as f32).collect();
            let all: f32 = energies.iter().sum();
            let levels = levels(size, &energies);
            assert_eq!(levels.last().unwrap().size, [1, 1]);
            for level in levels {
                assert_eq!(level.energies.len(), level.size[0] * level.size[1]);
                assert_eq!(level.energies.iter().sum::<f32>(), all);
            }
        }
    }
}
