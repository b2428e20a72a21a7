use super::*;
use crate::job::Quiet;
use crate::space::VoxelIndex;
use crate::voxel::bits::BitGrid;
use crate::voxel::groups;
use crate::voxel::morphology::Neighbours;
use glam::IVec3;
use topology::{Topology, of_complex, of_curve, of_void};

fn thinned(void: &BitGrid) -> Curve {
    thin(void, &Quiet, &Cancel::new()).unwrap()
}

/// The collapsed complex itself, with the topology of the tied void before.
fn collapsed(void: &BitGrid) -> (Complex, Topology, usize) {
    let never = Cancel::new();
    let board = Chessboard::new(void, &never).unwrap();
    let opening = opening::opening(void, &board, &never).unwrap();
    let mut complex = Complex::closure(void);
    let ties = tie::tie(&mut complex, void, &never).unwrap();
    let tied = of_complex(&complex);
    let anchors = anchors::anchors(void, &board);
    collapse::collapse(&mut complex, &board.distance, &opening, &anchors, &Filter::default(), &Quiet, &never).unwrap();
    (complex, tied, ties)
}

/// A void of boxes, given by their lowest and one past their highest voxel.
fn boxes(size: [usize; 3], boxes: &[([i32; 3], [i32; 3])]) -> BitGrid {
    let mut void = BitGrid::new(size);
    for (low, high) in boxes {
        set_box(&mut void, *low, *high, true);
    }
    void
}

fn set_box(grid: &mut BitGrid, low: [i32; 3], high: [i32; 3], member: bool) {
    for z in low[2]..high[2] {
        for y in low[1]..high[1] {
            for x in low[0]..high[0] {
                grid.set(VoxelIndex::new(x, y, z), member);
            }
        }
    }
}

/// Numbers from 0 to 1 that look random and are the same each time.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }
}

/// A void of independent voxels, or (every other one) of a few large bites with specks of matter left in them.
fn random_void(seed: u64) -> BitGrid {
    let mut random = Random(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1);
    (0..8).for_each(|_| _ = random.next());
    let size = [0; 3].map(|_: i32| 6 + (random.next() * 7.0) as usize);
    let mut void = BitGrid::new(size);
    let (bites, share) =
        if seed.is_multiple_of(2) { (0, 0.05 + 0.9 * random.next()) } else { (4, 0.15 * random.next()) };
    for _ in 0..bites {
        let low = size.map(|voxels| (random.next() * voxels as f64 * 0.7) as i32);
        let high = low.map(|low| low + 2 + (random.next() * 8.0) as i32);
        set_box(&mut void, low, high, true);
    }
    let mut whole = BitGrid::new(size);
    whole.fill(true);
    for voxel in whole.iter() {
        if random.next() < share {
            void.set(voxel, bites == 0);
        }
    }
    void
}

#[track_caller]
fn check(void: &BitGrid, what: &str) {
    let before = of_void(void);
    assert_eq!(of_complex(&Complex::closure(void)), before, "{what}: the closure");
    let (complex, tied, ties) = collapsed(void);
    assert_eq!(ties as i64, before.cavities, "{what}: ties");
    assert_eq!(tied, Topology { cavities: 0, ..before }, "{what}: the tied void");
    assert_eq!(of_complex(&complex), tied, "{what}: the collapsed complex");
    let [.., faces, cubes] = complex.count();
    assert_eq!([faces, cubes], [0, 0], "{what}: faces and cubes left");
    let curve = thinned(void);
    assert_eq!(of_curve(&curve), tied, "{what}: the curve");
    for vertex in &curve.vertices {
        assert!(vertex.distance > 0 && vertex.distance <= vertex.opening, "{what}: {vertex:?} outside the void");
    }
    for [a, b] in &curve.edges {
        let (a, b) = (curve.vertices[*a as usize].corner, curve.vertices[*b as usize].corner);
        assert_eq!((a - b).abs().element_sum(), 1, "{what}: an edge from {a} to {b}");
    }
    assert!(curve.vertices.is_sorted_by_key(|v| (v.corner.z, v.corner.y, v.corner.x)), "{what}: order");
    assert!(curve.edges.is_sorted(), "{what}: order of edges");
}

#[test]
fn topology_is_kept_on_random_volumes() {
    let mut cavities = 0;
    for seed in 0..2400 {
        let void = random_void(seed);
        check(&void, &format!("volume {seed}"));
        cavities += of_void(&void).cavities;
    }
    assert!(cavities > 2400, "only {cavities} floating solids were tried");
}

#[test]
fn bars_and_cubes_are_not_empty() {
    let bar = boxes([4, 4, 100], &[([0; 3], [4, 4, 100])]);
    assert_eq!(collapsed(&bar).0.count(), [89, 88, 0, 0]);
    let curve = thinned(&bar);
    assert!(curve.vertices.iter().all(|vertex| (vertex.corner.x, vertex.corner.y) == (2, 2)));
    assert!(curve.vertices.len() > 95, "{} vertices after growing", curve.vertices.len());

    let cube = boxes([128; 3], &[([0; 3], [128; 3])]);
    let curve = thinned(&cube);
    assert_eq!(curve.vertices.len(), 1);
    assert_eq!(curve.vertices[0].corner, IVec3::splat(64));
    assert_eq!((curve.vertices[0].distance, curve.vertices[0].saliency()), (64, 1.0));
}

#[test]
fn nothing_gives_nothing() {
    for size in [[0, 0, 0], [1, 1, 1], [0, 5, 5], [9, 4, 7]] {
        let curve = thinned(&BitGrid::new(size));
        assert_eq!((curve.vertices.len(), curve.edges.len()), (0, 0));
    }
    let one = boxes([1; 3], &[([0; 3], [1; 3])]);
    assert_eq!(thinned(&one).vertices.len(), 1);
}

#[test]
fn a_torus_keeps_its_loop() {
    let mut void = BitGrid::new([60, 60, 24]);
    let mut whole = void.clone();
    whole.fill(true);
    for voxel in whole.iter() {
        let at = voxel.0.as_vec3() + 0.5 - glam::Vec3::new(30.0, 30.0, 12.0);
        let ring = at.truncate().length() - 20.0;
        void.set(voxel, ring.hypot(at.z) < 7.0);
    }
    check(&void, "torus");
    let curve = thinned(&void);
    assert_eq!(of_curve(&curve), Topology { components: 1, loops: 1, cavities: 0 });
    assert_eq!(curve.vertices.len(), curve.edges.len());
    assert!(curve.neighbours().iter().all(|near| near.len() == 2), "the loop has branches");
}

#[test]
fn a_pillar_makes_a_loop_and_a_floating_cube_none() {
    let mut void = boxes([40, 40, 20], &[([1, 1, 1], [39, 39, 19])]);
    set_box(&mut void, [17, 17, 0], [23, 23, 20], false);
    check(&void, "pillar");
    assert_eq!(of_curve(&thinned(&void)), Topology { components: 1, loops: 1, cavities: 0 });

    let mut void = boxes([40, 40, 40], &[([1, 1, 1], [39, 39, 39])]);
    set_box(&mut void, [17, 17, 17], [23, 23, 23], false);
    check(&void, "floating cube");
    assert_eq!(of_void(&void), Topology { components: 1, loops: 0, cavities: 1 });
    assert_eq!(of_curve(&thinned(&void)), Topology { components: 1, loops: 0, cavities: 0 });
}

#[test]
fn two_rooms_are_joined_centre_to_centre() {
    let rooms = [([1, 1, 1], [31, 25, 21]), ([61, 1, 1], [91, 31, 21])];
    let void = boxes([92, 32, 22], &[rooms[0], rooms[1], ([31, 8, 1], [61, 16, 13])]);
    check(&void, "two rooms");
    let curve = thinned(&void);
    let anchors: Vec<IVec3> =
        curve.vertices.iter().filter(|vertex| vertex.anchor).map(|vertex| vertex.corner).collect();
    assert_eq!(anchors.len(), 2);
    for (room, anchor) in rooms.iter().zip(&anchors) {
        let centre = (IVec3::from(room.0) + IVec3::from(room.1)) / 2;
        let off = (anchor - centre).abs().max_element();
        assert!(off <= 1, "the room around {centre} is held at {anchor}");
    }
    assert_eq!(of_curve(&curve), Topology { components: 1, loops: 0, cavities: 0 });
    let tips = curve.neighbours().iter().filter(|near| near.len() == 1).count();
    assert_eq!(tips, 2, "one line from room to room");
}

/// A room with a blind corridor of `width` x `height` voxels along an axis: how far from its end does the line stop?
fn gap_at_dead_end(axis: usize, width: i32, height: i32, length: i32) -> i32 {
    let room = 2 * width.max(height) + 8;
    let end = room + 1 + length;
    let turned = |at: [i32; 3]| {
        let mut at = at;
        at.rotate_right(axis);
        at
    };
    let size = turned([end + 1, room + 2, room + 2]).map(|voxels| voxels as usize);
    let (y, z) = (1 + (room - width) / 2, 1 + (room - height) / 2);
    let room_box = (turned([1, 1, 1]), turned([1 + room; 3]));
    let void = boxes(size, &[room_box, (turned([room + 1, y, z]), turned([end, y + width, z + height]))]);
    check(&void, "dead end");
    let curve = thinned(&void);
    end - curve.vertices.iter().map(|vertex| vertex.corner[axis]).max().unwrap()
}

#[test]
fn a_dead_end_is_followed_to_its_wall() {
    for axis in 0..3 {
        for (width, height) in [(4, 4), (6, 10), (10, 6), (7, 7), (5, 12), (12, 24)] {
            let gap = gap_at_dead_end(axis, width, height, 80);
            let half = (width.max(height) + 1) / 2;
            assert!(gap <= half, "axis {axis}, {width} x {height}: the line stops {gap} voxels from the wall");
        }
    }
}

#[test]
fn threads_do_not_matter() {
    let mut void =
        boxes([70, 60, 50], &[([1, 1, 1], [30, 59, 49]), ([40, 1, 1], [69, 59, 49]), ([30, 20, 1], [40, 40, 30])]);
    let mut random = Random(77);
    for voxel in void.clone().iter() {
        if random.next() < 0.002 {
            void.set(voxel, false);
        }
    }
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| thinned(&void))
    };
    let one = with(1);
    assert!(one.vertices.len() > 100);
    assert!(one == with(2));
    assert!(one == with(3));
}

#[test]
fn a_raised_flag_stops_it() {
    let cancel = Cancel::new();
    cancel.cancel();
    assert_eq!(thin(&boxes([9; 3], &[([0; 3], [9; 3])]), &Quiet, &cancel), Err(Cancelled));
}

#[test]
fn noise_on_walls_makes_few_branches() {
    let mut void = boxes([142, 24, 24], &[([1, 4, 4], [141, 20, 20])]);
    let mut random = Random(5);
    let mut whole = BitGrid::new(void.size());
    whole.fill(true);
    // Bumps and dents of a voxel all over the walls.
    for voxel in whole.iter().filter(|_| random.next() < 0.15) {
        let at = voxel.0;
        let depth = [at.y - 4, 19 - at.y, at.z - 4, 19 - at.z].into_iter().min().unwrap_or(0);
        if (-1..=0).contains(&depth) && (1..141).contains(&at.x) {
            void.set(voxel, depth < 0);
        }
    }
    // The corridor without the bubbles in its walls.
    let seed = void.place(VoxelIndex::new(70, 12, 12)).map(|(brick, bit)| (brick, 1 << bit));
    let corridor = groups::take(&mut void, seed, Neighbours::All);
    void.fill(false);
    corridor.iter().for_each(|(brick, bits)| void.words_mut()[*brick as usize] = *bits);
    check(&void, "noisy corridor");
    let tips = |curve: &Curve| curve.neighbours().iter().filter(|near| near.len() == 1).count();
    let (complex, ..) = collapsed(&void);
    let board = Chessboard::new(&void, &Cancel::new()).unwrap();
    let before = Curve::new(&complex, &[], board.distance.clone(), board.distance);
    let after = thinned(&void);
    assert!(tips(&after) <= 4 && tips(&before) > tips(&after), "{} tips, {} before", tips(&after), tips(&before));
}

/// A corridor with a side passage: what each switch of the filter takes, and that none changes the topology.
#[test]
fn a_filter_takes_branches_and_keeps_the_topology() {
    let void = boxes([62, 34, 10], &[([2, 10, 2], [60, 16, 8]), ([28, 16, 2], [34, 32, 8])]);
    let by = |filter: Filter| thin_by(&filter, &void, &Quiet, &Cancel::new()).unwrap();
    let normal = by(Filter::default());
    let variants = [
        Filter { least_life_layers: Filter::MOST_LAYERS, ..Filter::default() },
        Filter { keeps_middles: false, ..Filter::default() },
        Filter { cuts_branches: false, ..Filter::default() },
        Filter { grows_ends: false, ..Filter::default() },
    ];
    let [long, loose, uncut, short] = variants.map(by);
    for curve in [&normal, &long, &loose, &uncut, &short] {
        assert_eq!(of_curve(curve), of_void(&void));
    }
    assert!(long.vertices.len() < normal.vertices.len(), "{} {}", long.vertices.len(), normal.vertices.len());
    assert!(loose.vertices.len() <= normal.vertices.len());
    assert!(uncut.vertices.len() >= normal.vertices.len() && short.vertices.len() < normal.vertices.len());
}
