//! The array that benchmarks work on: rooms joined by doors and shafts, half of it void, the same each time.

/// Voxels from a room to the next.
const PITCH: usize = 24;

/// Voxels of wall past the last room.
const WALL: usize = 5;

/// Rooms of differing sizes on a grid, joined by doors to the side and shafts upwards; 1 is void, `[z][y][x]`. The size is
/// along x, y and z.
pub fn array_of_rooms(rooms: [usize; 3]) -> ([usize; 3], Vec<u8>) {
    let size = rooms.map(|rooms| rooms * PITCH + WALL);
    let mut bytes = vec![0; size.iter().product()];
    let mut carve = |low: [usize; 3], high: [usize; 3]| {
        for z in low[2]..high[2] {
            for y in low[1]..high[1] {
                bytes[low[0] + size[0] * (y + size[1] * z)..][..high[0] - low[0]].fill(1);
            }
        }
    };
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    let mut random = |below: usize| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 33) as usize % below
    };
    for room in 0..rooms.iter().product() {
        let at = [room % rooms[0], room / rooms[0] % rooms[1], room / (rooms[0] * rooms[1])];
        let low = at.map(|along| WALL + PITCH * along);
        let high = low.map(|low| low + 19 + random(2) - random(2));
        carve(low, high);
        // A door at the floor for three in four neighbours to the side, a shaft in the middle for one in three above.
        for axis in 0..3 {
            let joined = if axis == 2 { random(3) == 0 } else { random(4) > 0 };
            if joined && at[axis] + 1 < rooms[axis] {
                let (mut from, mut to) = (low.map(|low| low + 7), low.map(|low| low + 13));
                if axis != 2 {
                    (from[2], to[2]) = (low[2], low[2] + 12);
                }
                (from[axis], to[axis]) = (high[axis], low[axis] + PITCH);
                carve(from, to);
            }
        }
    }
    (size, bytes)
}
