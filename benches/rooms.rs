//! The arrays that benchmarks work on: rooms joined by doors and shafts, half of it void, the same each time.

/// Rooms of differing sizes on a grid, joined by doors to the side and shafts upwards; 1 is void, `[z][y][x]`.
pub fn array_of_rooms(rooms: [usize; 3], pitch: usize, wall: usize) -> ([usize; 3], Vec<u8>) {
    let size = rooms.map(|rooms| rooms * pitch + wall);
    let mut bytes = vec![0; size.iter().product()];
    let mut carve = |low: [usize; 3], high: [usize; 3]| {
        for z in low[2]..high[2] {
            for y in low[1]..high[1] {
                bytes[low[0] + size[0] * (y + size[1] * z)..][..high[0] - low[0]].fill(1);
            }
        }
    };
    let mut random = random();
    for room in 0..rooms.iter().product() {
        let at = [room % rooms[0], room / rooms[0] % rooms[1], room / (rooms[0] * rooms[1])];
        let low = at.map(|along| wall + pitch * along);
        let high = low.map(|low| low + pitch - wall + random(2) - random(2));
        carve(low, high);
        // A door at the floor for three in four neighbours to the side, a shaft in the middle for one in three above.
        for axis in 0..3 {
            let joined = if axis == 2 { random(3) == 0 } else { random(4) > 0 };
            if joined && at[axis] + 1 < rooms[axis] {
                let (mut from, mut to) = (low.map(|low| low + pitch / 3), low.map(|low| low + pitch / 3 + 6));
                if axis != 2 {
                    (from[2], to[2]) = (low[2], low[2] + 12);
                }
                (from[axis], to[axis]) = (high[axis], low[axis] + pitch);
                carve(from, to);
            }
        }
    }
    (size, bytes)
}

/// Whole numbers below what is asked for, that look random and are the same each time.
pub fn random() -> impl FnMut(usize) -> usize {
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    move |below| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 33) as usize % below
    }
}
