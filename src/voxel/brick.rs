//! What do the neighbours of 64 voxels hold, all at once?
//!
//! A brick is a cube of 4 x 4 x 4 voxels in one `u64`: voxel `(x, y, z)` of the brick is bit `x + 4 y + 16 z`. Moving all
//! of them by one voxel along an axis is a shift of the word, with the layer that enters taken from the brick beside it.
//! Axes are numbered 0, 1, 2 for x, y, z.

/// Voxels along an edge of a brick.
pub const EDGE: usize = 4;

/// How far a step of one voxel along each axis moves a bit.
const STEP: [u32; 3] = [1, 4, 16];

/// The layer of voxels with the lowest coordinate along each axis.
pub const FIRST: [u64; 3] = [0x1111_1111_1111_1111, 0x000f_000f_000f_000f, 0xffff];

/// The layer of voxels with the highest coordinate along each axis.
pub const LAST: [u64; 3] = [FIRST[0] << 3, FIRST[1] << 12, FIRST[2] << 48];

/// For each voxel the bit of its neighbour one step below it along the axis; `below` is the brick beside on that side.
#[inline(always)]
pub const fn from_below<const AXIS: usize>(word: u64, below: u64) -> u64 {
    (word << STEP[AXIS] & !FIRST[AXIS]) | (below >> (3 * STEP[AXIS]) & FIRST[AXIS])
}

/// For each voxel the bit of its neighbour one step above it along the axis; `above` is the brick beside on that side.
#[inline(always)]
pub const fn from_above<const AXIS: usize>(word: u64, above: u64) -> u64 {
    (word >> STEP[AXIS] & !LAST[AXIS]) | (above << (3 * STEP[AXIS]) & LAST[AXIS])
}

/// The bit of a voxel by its coordinates inside the brick, each 0 to 3.
#[inline(always)]
pub const fn bit(x: usize, y: usize, z: usize) -> u32 {
    (x + EDGE * y + EDGE * EDGE * z) as u32
}

/// The voxels of a brick whose coordinate along each axis is below `size` (counted from the brick's first voxel).
pub fn below(size: [usize; 3]) -> u64 {
    (0..3).fold(!0, |mask, axis| mask & layers(axis, 0, size[axis].min(EDGE)))
}

/// The voxels of a brick with coordinates `from..to` along one axis; both at most 4.
pub fn layers(axis: usize, from: usize, to: usize) -> u64 {
    (from..to).fold(0, |mask, layer| mask | FIRST[axis] << (layer as u32 * STEP[axis]))
}

/// The voxels of a mask that a path inside the brick joins to `seeds`, by shared faces.
#[inline]
pub fn flood_six(seeds: u64, mask: u64) -> u64 {
    grow(seeds, mask, |word| {
        word | from_below::<0>(word, 0)
            | from_above::<0>(word, 0)
            | from_below::<1>(word, 0)
            | from_above::<1>(word, 0)
            | from_below::<2>(word, 0)
            | from_above::<2>(word, 0)
    })
}

/// The voxels of a mask that a path inside the brick joins to `seeds`, by shared faces, edges or corners.
#[inline]
pub fn flood_all(seeds: u64, mask: u64) -> u64 {
    grow(seeds, mask, |word| {
        let x = word | from_below::<0>(word, 0) | from_above::<0>(word, 0);
        let y = x | from_below::<1>(x, 0) | from_above::<1>(x, 0);
        y | from_below::<2>(y, 0) | from_above::<2>(y, 0)
    })
}

#[inline(always)]
fn grow(seeds: u64, mask: u64, spread: impl Fn(u64) -> u64) -> u64 {
    let mut reached = seeds & mask;
    loop {
        let next = spread(reached) & mask;
        if next == reached {
            return reached;
        }
        reached = next;
    }
}

/// The positions of the set bits, lowest first.
pub fn ones(mut word: u64) -> impl Iterator<Item = u32> {
    std::iter::from_fn(move || {
        let bit = word.trailing_zeros();
        word &= word.wrapping_sub(1);
        (bit < 64).then_some(bit)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A step along an axis is checked voxel by voxel.
    fn check<const AXIS: usize>() {
        let (word, other) = (0x9e37_79b9_7f4a_7c15_u64, 0xd1b5_4a32_d192_ed03_u64);
        for (x, y, z) in (0..64).map(|i| (i % 4, i / 4 % 4, i / 16)) {
            let at = |word: u64, p: [usize; 3]| word >> bit(p[0], p[1], p[2]) & 1;
            let here = [x, y, z];
            let (mut low, mut high) = (here, here);
            low[AXIS] = (here[AXIS] + 3) % 4;
            high[AXIS] = (here[AXIS] + 1) % 4;
            let want_low = at(if here[AXIS] == 0 { other } else { word }, low);
            let want_high = at(if here[AXIS] == 3 { other } else { word }, high);
            assert_eq!(at(from_below::<AXIS>(word, other), here), want_low);
            assert_eq!(at(from_above::<AXIS>(word, other), here), want_high);
        }
    }

    #[test]
    fn steps_take_each_voxel_from_its_neighbour() {
        check::<0>();
        check::<1>();
        check::<2>();
    }

    #[test]
    fn floods_stay_in_the_mask() {
        // A row of three voxels along x, and a fourth that touches its end by a corner only.
        let mask = 1 << bit(0, 0, 0) | 1 << bit(1, 0, 0) | 1 << bit(2, 0, 0) | 1 << bit(3, 1, 1);
        assert_eq!(flood_six(1, mask), 0b111);
        assert_eq!(flood_all(1, mask), mask);
        assert_eq!(flood_six(2, !mask) & mask, 0);
    }

    #[test]
    fn ones_come_lowest_first() {
        assert_eq!(ones(0x8000_0000_0000_0005).collect::<Vec<_>>(), [0, 2, 63]);
        assert_eq!(ones(0).count(), 0);
    }
}
