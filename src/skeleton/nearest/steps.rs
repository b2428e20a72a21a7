//! Where do the 26 steps from a voxel lead, and which of them does a way take on?
//!
//! Tables, made by the compiler. Steps are numbered like the 27 voxels around one, x fastest; tables are longer than
//! that where five bits choose the step.

/// The length of a step over a face; over an edge and a corner it is one and two more.
const STEP_UNITS: u8 = 3;

/// Among the 27 bricks or voxels around one, x fastest, itself.
pub(super) const MIDDLE: usize = 13;

/// The steps that a way takes on after a step (its own direction and its components; all from the middle), and how long
/// they are.
#[inline(always)]
pub(super) fn onward(step: usize) -> &'static [(u8, u8)] {
    let (steps, count) = &ONWARD[step];
    &steps[..*count]
}

static ONWARD: [([(u8, u8); 26], usize); 32] = {
    let mut onward = [([(0, 0); 26], 0); 32];
    let mut step = 0;
    while step < 27 {
        let mut next = 0;
        while next < 27 {
            let (a, b) = (offset(step), offset(next));
            let along = (b[0] == 0 || b[0] == a[0]) && (b[1] == 0 || b[1] == a[1]) && (b[2] == 0 || b[2] == a[2]);
            if next != MIDDLE && (along || step == MIDDLE) {
                let axes = b[0] * b[0] + b[1] * b[1] + b[2] * b[2];
                let (steps, count) = &mut onward[step];
                steps[*count] = (next as u8, STEP_UNITS + axes as u8 - 1);
                *count += 1;
            }
            next += 1;
        }
        step += 1;
    }
    onward
};

/// For each bit of a brick and each of the 27 directions: which of the 27 bricks around holds that neighbour, and its bit.
pub(super) static MOVED: [[(u8, u8); 32]; 64] = {
    let mut moved = [[(0, 0); 32]; 64];
    let mut bit = 0;
    while bit < 64 {
        let mut step = 0;
        while step < 27 {
            let [dx, dy, dz] = offset(step);
            // One brick further along each axis, so that nothing is negative.
            let (x, y, z) = (bit as isize % 4 + dx + 4, bit as isize / 4 % 4 + dy + 4, bit as isize / 16 + dz + 4);
            let side = x / 4 + 3 * (y / 4) + 9 * (z / 4);
            moved[bit][step] = (side as u8, (x % 4 + 4 * (y % 4) + 16 * (z % 4)) as u8);
            step += 1;
        }
        bit += 1;
    }
    moved
};

/// The steps from the middle of 27 to each of them.
pub(super) static OFFSETS: [[isize; 3]; 27] = {
    let mut offsets = [[0; 3]; 27];
    let mut side = 0;
    while side < 27 {
        offsets[side] = offset(side);
        side += 1;
    }
    offsets
};

/// The step from the middle of 27 to one of them.
const fn offset(side: usize) -> [isize; 3] {
    [side as isize % 3 - 1, side as isize / 3 % 3 - 1, side as isize / 9 - 1]
}
