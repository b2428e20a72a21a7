//! Where are the middles of rooms, which thinning must not leave out?
//!
//! A room that ends a passage would be eaten back to its door: nothing in it is a dead end long enough. So each summit of
//! the [distance](crate::voxel::chessboard) holds one lattice point in place: a 26-connected group of centres of the same
//! distance, with no other voxel of that distance beside it (from one it would go on up). The point is the corner, nearest
//! the group's centroid, of the voxel of the group nearest it. A long corridor of constant width is one summit and gets
//! one anchor.

use crate::voxel::bits::BitGrid;
use crate::voxel::brick;
use crate::voxel::chessboard::Chessboard;
use crate::voxel::groups::{self, Group};
use crate::voxel::morphology::Neighbours;
use glam::{I64Vec3, IVec3};

/// Distances below this make no anchor. A summit of distance 2 is at most four voxels wide: noise, or a passage that the
/// collapse keeps in any case.
const LEAST_DISTANCE: u16 = 3;

/// The lattice points to hold, those of small distance first.
pub fn anchors(void: &BitGrid, board: &Chessboard) -> Vec<IVec3> {
    let mut anchors = Vec::new();
    let mut left = BitGrid::new(void.size());
    for centres in board.centres.iter().filter(|centres| centres.distance >= LEAST_DISTANCE) {
        for (brick, bits) in &centres.bricks {
            left.words_mut()[*brick as usize] = *bits;
        }
        for brick in centres.bricks.iter().map(|(brick, _)| *brick as usize) {
            while let Some(bit) = brick::ones(left.words()[brick]).next() {
                let group = groups::take(&mut left, [(brick, 1 << bit)], Neighbours::All);
                let around = groups::around(void.bricks(), &group);
                if groups::voxels(void, &around).all(|voxel| board.distance.at(voxel) < centres.distance) {
                    anchors.push(middle(void, &group));
                }
            }
        }
    }
    anchors
}

/// The corner nearest the centroid, of the group's voxel nearest it; the first in z, y, x of equals.
fn middle(void: &BitGrid, group: &Group) -> IVec3 {
    // In whole numbers, as multiples of 1 / count, so that nothing is rounded.
    let voxels = || groups::voxels(void, group).map(|voxel| voxel.0);
    let (sum, count) = voxels().fold((I64Vec3::ZERO, 0), |(sum, count), at| (sum + at.as_i64vec3(), count + 1));
    let off = |at: IVec3| sum - count * at.as_i64vec3();
    let nearest = voxels().min_by_key(|at| (off(*at).length_squared(), at.z, at.y, at.x)).unwrap_or_default();
    nearest + off(nearest).signum().max(I64Vec3::ZERO).as_ivec3()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::job::Cancel;
    use crate::space::VoxelIndex;

    fn anchors_of(boxes: &[(IVec3, IVec3)]) -> Vec<IVec3> {
        let mut void = BitGrid::new([40, 20, 20]);
        for (low, high) in boxes {
            let mut whole = BitGrid::new(void.size());
            whole.fill(true);
            let inside = |at: &VoxelIndex| at.0.cmpge(*low).all() && at.0.cmplt(*high).all();
            for voxel in whole.iter().filter(inside) {
                void.set(voxel, true);
            }
        }
        anchors(&void, &Chessboard::new(&void, &Cancel::new()).unwrap())
    }

    #[test]
    fn a_room_is_held_at_its_middle() {
        assert_eq!(anchors_of(&[(IVec3::new(1, 1, 1), IVec3::new(11, 11, 11))]), [IVec3::splat(6)]);
        assert_eq!(anchors_of(&[(IVec3::new(2, 1, 1), IVec3::new(38, 9, 7))]), [IVec3::new(20, 5, 4)]);
    }

    #[test]
    fn passages_between_rooms_are_not() {
        let rooms = [(IVec3::ONE, IVec3::splat(13)), (IVec3::new(25, 1, 1), IVec3::new(39, 15, 15))];
        let passage = (IVec3::new(13, 4, 4), IVec3::new(25, 10, 10));
        assert_eq!(anchors_of(&[rooms[0], rooms[1], passage]), [IVec3::splat(7), IVec3::new(32, 8, 8)]);
    }

    #[test]
    fn nothing_small_is() {
        assert_eq!(anchors_of(&[(IVec3::ONE, IVec3::new(9, 5, 5))]), []);
        assert_eq!(anchors_of(&[]), []);
    }
}
