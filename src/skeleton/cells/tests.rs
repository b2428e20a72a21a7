//! Rooms made by hand, a voxel a tenth of a metre.

use crate::job::{Cancel, Quiet};
use crate::rays::Rays;
use crate::scene::Scene;
use crate::skeleton::Skeleton;
use crate::space::{Lattice, VoxelIndex};
use crate::voxel::bits::BitGrid;
use glam::{IVec3, Vec3};

type Block = ([i32; 3], [i32; 3]);

fn carved(size: [usize; 3], rooms: &[Block], solids: &[Block]) -> BitGrid {
    let mut void = BitGrid::new(size);
    for (blocks, member) in [(rooms, true), (solids, false)] {
        for (low, high) in blocks {
            for (x, y, z) in (low[0]..high[0])
                .flat_map(|x| (low[1]..high[1]).flat_map(move |y| (low[2]..high[2]).map(move |z| (x, y, z))))
            {
                void.set(VoxelIndex::new(x, y, z), member);
            }
        }
    }
    void
}

fn skeleton(void: &BitGrid) -> Skeleton {
    let lattice = Lattice { origin_m: Vec3::ZERO, voxel_m: 0.1, size: void.size() };
    let rays = Rays::new(&Scene::default());
    let skeleton =
        Skeleton::build_from(lattice, void, &crate::skeleton::Filter::default(), &rays, &Quiet, &Cancel::new())
            .unwrap();
    assert_eq!(skeleton.validate(void), Ok(()));
    skeleton
}

/// Cells and necks, and a picture of both when they are not as wanted.
#[track_caller]
fn check(void: &BitGrid, cells: usize, necks: usize) -> Skeleton {
    let skeleton = skeleton(void);
    let found = (skeleton.cells.len(), skeleton.necks.len());
    assert_eq!(found, (cells, necks), "{:#?}\n{:#?}", skeleton.cells, skeleton.necks);
    skeleton
}

#[test]
fn a_flat_room_is_one_cell() {
    check(&carved([60, 60, 36], &[([3, 3, 3], [57, 57, 33])], &[]), 1, 0);
}

#[test]
fn a_long_hall_and_a_corridor_are_one_cell_each() {
    check(&carved([130, 46, 36], &[([3, 3, 3], [127, 43, 29])], &[]), 1, 0);
    check(&carved([206, 21, 36], &[([3, 3, 3], [203, 18, 29])], &[]), 1, 0);
}

#[test]
fn a_door_joins_two_rooms() {
    let rooms = [([3, 3, 3], [57, 57, 33]), ([60, 3, 3], [100, 57, 33]), ([57, 20, 3], [60, 29, 24])];
    let skeleton = check(&carved([103, 60, 36], &rooms, &[]), 2, 1);
    let neck = &skeleton.necks[0];
    // Nine by 21 voxels and half a voxel all round.
    assert!((neck.area_m2 / 2.2 - 1.0).abs() < 0.1, "{neck:?}");
    assert!(neck.normal.x.abs() > 0.97, "{neck:?}");
    assert!((neck.position_m - Vec3::new(5.85, 2.45, 1.35)).length() < 0.3, "{neck:?}");
    let [a, b] = [0, 1].map(|cell: usize| skeleton.cells[cell].volume_m3);
    let (small, large) = (a.min(b), a.max(b));
    assert!((large / (5.5 * 5.5 * 3.1) - 1.0).abs() < 0.03, "{large}");
    assert!((small / (4.1 * 5.5 * 3.1) - 1.0).abs() < 0.03, "{small}");
}

#[test]
fn a_thin_wall_parts_two_rooms_as_well() {
    let rooms = [([3, 3, 3], [57, 57, 33]), ([58, 3, 3], [100, 57, 33]), ([57, 4, 4], [58, 13, 24])];
    check(&carved([103, 60, 36], &rooms, &[]), 2, 1);
}

#[test]
fn nine_rooms_have_twelve_doors() {
    let mut blocks = Vec::new();
    for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
        let (x, y) = (2 + 46 * i, 2 + 42 * j);
        blocks.push(([x, y, 2], [x + 44, y + 40, 28]));
        let (door_x, door_y) = (x + 8 + 9 * j, y + 10 + 5 * i);
        if i < 2 {
            blocks.push(([x + 44, door_y, 2], [x + 46, door_y + 9, 22]));
        }
        if j < 2 {
            blocks.push(([door_x, y + 40, 2], [door_x + 9, y + 42, 22]));
        }
    }
    check(&carved([142, 130, 30], &blocks, &[]), 9, 12);
}

#[test]
fn a_bend_is_no_neck() {
    let corridor = [([3, 3, 3], [100, 18, 29]), ([85, 3, 3], [100, 90, 29]), ([85, 75, 3], [180, 90, 29])];
    check(&carved([183, 93, 32], &corridor, &[]), 1, 0);
}

#[test]
fn a_corridor_with_doors_at_its_ends_is_a_cell() {
    let blocks = [
        ([3, 3, 3], [43, 43, 29]),
        ([46, 15, 3], [126, 30, 29]),
        ([129, 3, 3], [169, 43, 29]),
        ([43, 18, 3], [46, 27, 23]),
        ([126, 18, 3], [129, 27, 23]),
    ];
    check(&carved([172, 46, 32], &blocks, &[]), 3, 2);
}

#[test]
fn a_long_open_passage_is_a_cell_and_a_short_one_a_neck() {
    let with = |length: i32| {
        let blocks = [
            ([3, 3, 3], [43, 43, 29]),
            ([43, 16, 3], [43 + length, 28, 26]),
            ([43 + length, 3, 3], [83 + length, 43, 29]),
        ];
        carved([86 + length as usize, 46, 32], &blocks, &[])
    };
    check(&with(120), 3, 2);
    check(&with(10), 2, 1);
}

#[test]
fn crossing_corridors_are_one_cell() {
    let blocks = [([3, 60, 3], [140, 75, 29]), ([64, 3, 3], [79, 130, 29])];
    check(&carved([143, 133, 32], &blocks, &[]), 1, 0);
}

#[test]
fn a_keyhole_is_a_neck() {
    let blocks = [([3, 3, 3], [40, 40, 30]), ([44, 3, 3], [84, 40, 30]), ([40, 20, 15], [44, 24, 19])];
    let skeleton = check(&carved([87, 43, 33], &blocks, &[]), 2, 1);
    assert!((skeleton.necks[0].area_m2 / 0.25 - 1.0).abs() < 0.1, "{:?}", skeleton.necks);
}

#[test]
fn a_shaft_joins_two_storeys() {
    let blocks = [([3, 3, 3], [70, 60, 29]), ([3, 3, 33], [70, 60, 59]), ([50, 40, 29], [60, 52, 33])];
    let skeleton = check(&carved([73, 63, 62], &blocks, &[]), 2, 1);
    assert!(skeleton.necks[0].normal.z.abs() > 0.97, "{:?}", skeleton.necks);
}

#[test]
fn pillars_do_not_cut_a_hall() {
    let hall = [([3, 3, 3], [203, 123, 35])];
    let pillars: Vec<Block> = (0..7)
        .flat_map(|i| (0..4).map(move |j| (26 + 25 * i, 24 + 25 * j)))
        .map(|(x, y)| ([x, y, 3], [x + 4, y + 4, 35]))
        .collect();
    check(&carved([206, 126, 38], &hall, &pillars), 1, 0);
}

#[test]
fn two_doors_between_two_rooms_are_two_necks() {
    let blocks = [
        ([3, 3, 3], [57, 67, 33]),
        ([60, 3, 3], [100, 67, 33]),
        ([57, 8, 3], [60, 17, 24]),
        ([57, 48, 3], [60, 57, 24]),
    ];
    let skeleton = check(&carved([103, 70, 36], &blocks, &[]), 2, 2);
    assert_eq!(skeleton.shape().loops, 1);
}

/// The void turned by 90 degrees about z.
fn turned(void: &BitGrid) -> BitGrid {
    let [nx, ny, nz] = void.size();
    let mut out = BitGrid::new([ny, nx, nz]);
    for VoxelIndex(IVec3 { x, y, z }) in void.iter() {
        out.set(VoxelIndex::new(ny as i32 - 1 - y, x, z), true);
    }
    out
}

#[test]
fn turning_keeps_components_loops_and_necks() {
    let blocks = [
        ([3, 3, 3], [40, 50, 27]),
        ([43, 3, 3], [83, 30, 27]),
        ([40, 10, 3], [43, 19, 22]),
        ([86, 3, 3], [120, 40, 27]),
        ([83, 6, 3], [86, 14, 22]),
    ];
    let void = carved([124, 54, 30], &blocks, &[]);
    let (one, other) = (check(&void, 3, 2), check(&turned(&void), 3, 2));
    assert_eq!(one.shape(), other.shape());
}

#[test]
fn threads_do_not_matter() {
    let blocks = [([3, 3, 3], [40, 50, 27]), ([43, 3, 3], [83, 30, 27]), ([40, 10, 3], [43, 19, 22])];
    let void = carved([86, 54, 30], &blocks, &[]);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let skeleton = pool.install(|| skeleton(&void));
        format!("{:?}", skeleton)
    };
    assert!(with(1) == with(3));
}
