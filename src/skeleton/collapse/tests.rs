use super::*;
use crate::job::Quiet;
use crate::skeleton::anchors::anchors;
use crate::skeleton::complex::{CUBES, across};
use crate::voxel::bits::BitGrid;
use crate::voxel::chessboard::Chessboard;
use crate::voxel::opening::opening;

/// The collapse as it is defined, cell by cell and pass by pass, with no thought of speed.
struct Plain {
    size: IVec3,
    cells: Vec<[bool; 8]>,
}

type Set = Vec<[bool; 8]>;

impl Plain {
    fn new(complex: &Complex) -> Self {
        let size = IVec3::from(complex.layout().size.map(|voxels| voxels as i32 + 1));
        let plain = Self { size, cells: Vec::new() };
        let cells = plain.places().map(|at| [0, 1, 2, 3, 4, 5, 6, 7].map(|plane| complex.has(at, plane))).collect();
        Self { cells, ..plain }
    }

    fn places(&self) -> impl Iterator<Item = IVec3> + use<> {
        let size = self.size;
        (0..size.element_product()).map(move |i| IVec3::new(i % size.x, i / size.x % size.y, i / size.x / size.y))
    }

    fn index(&self, at: IVec3) -> Option<usize> {
        let inside = at.cmpge(IVec3::ZERO).all() && at.cmplt(self.size).all();
        inside.then(|| (at.x + self.size.x * (at.y + self.size.y * at.z)) as usize)
    }

    fn get(&self, set: &Set, at: IVec3, plane: usize) -> bool {
        self.index(at).is_some_and(|index| set[index][plane])
    }

    fn has(&self, at: IVec3, plane: usize) -> bool {
        self.get(&self.cells, at, plane)
    }

    /// The cells one dimension larger that a cell bounds.
    fn around(&self, at: IVec3, plane: usize) -> Vec<(IVec3, usize)> {
        let axes = (0..3).filter(|axis| plane >> axis & 1 == 0);
        let places = axes.flat_map(|axis| [(at, plane | 1 << axis), (at - IVec3::AXES[axis], plane | 1 << axis)]);
        places.filter(|(at, plane)| self.has(*at, *plane)).collect()
    }

    /// The places of the cells one dimension smaller that bound a cell.
    fn bounds(at: IVec3, plane: usize) -> Vec<(IVec3, usize)> {
        let axes = (0..3).filter(|axis| plane >> axis & 1 == 1);
        axes.flat_map(|axis| [(at, plane ^ 1 << axis), (at + IVec3::AXES[axis], plane ^ 1 << axis)]).collect()
    }

    fn border(&self) -> Set {
        let mut border = vec![[false; 8]; self.cells.len()];
        for plane in [CUBES, across(0), across(1), across(2), 1, 2, 4] {
            for at in self.places().filter(|at| self.has(*at, plane)) {
                let index = self.index(at).unwrap();
                border[index][plane] = if plane == CUBES {
                    (0..3).any(|axis| {
                        let step = IVec3::AXES[axis];
                        !self.has(at + step, CUBES) || !self.has(at - step, CUBES)
                    })
                } else {
                    let of_border = self.around(at, plane).iter().any(|(at, plane)| self.get(&border, *at, *plane));
                    let free = Self::bounds(at, plane).iter().any(|(at, plane)| self.around(*at, *plane).len() == 1);
                    of_border || free
                };
            }
        }
        border
    }

    fn run(&mut self, distance: &Levels, opening: &Levels, anchors: &[IVec3]) {
        let mut until: BTreeMap<(usize, usize), u32> = BTreeMap::new();
        let mut kept: Set = vec![[false; 8]; self.cells.len()];
        for now in 0.. {
            for plane in [1, 2, 4_usize] {
                for at in self.places().filter(|at| self.has(*at, plane) && self.around(*at, plane).is_empty()) {
                    let axis = plane.trailing_zeros() as usize;
                    let life = u32::from(opening.at_edge(at, axis) - distance.at_edge(at, axis));
                    let key = (self.index(at).unwrap(), plane);
                    until.entry(key).or_insert((life + 2 * now).max(now + Filter::default().least_life_layers));
                }
            }
            for ((index, plane), _) in until.iter().filter(|(_, until)| **until < now) {
                kept[*index][*plane] |= self.cells[*index][*plane];
            }
            let border = self.border();
            let mut removed = false;
            for axis in 0..3 {
                for far in [IVec3::ZERO, IVec3::AXES[axis]] {
                    for dimension in [3, 2, 1] {
                        let spans = |plane: &usize| plane >> axis & 1 == 1 && plane.count_ones() == dimension;
                        for plane in (1..8).filter(spans) {
                            let small = plane ^ 1 << axis;
                            let pairs: Vec<IVec3> = self
                                .places()
                                .filter(|at| self.has(*at, small) && self.around(*at, small) == [(*at - far, plane)])
                                .filter(|at| self.get(&border, *at - far, plane) && !self.get(&kept, *at - far, plane))
                                .filter(|at| small != 0 || !anchors.contains(at))
                                .collect();
                            for at in pairs {
                                let (large_at, small_at) = (self.index(at - far).unwrap(), self.index(at).unwrap());
                                self.cells[large_at][plane] = false;
                                self.cells[small_at][small] = false;
                                removed = true;
                            }
                        }
                    }
                }
            }
            if !removed {
                break;
            }
        }
    }
}

#[test]
fn it_equals_the_definition_cell_by_cell() {
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut random = |below: u64| {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 33) % below
    };
    let never = Cancel::new();
    for volume in 0..160 {
        let size = [0; 3].map(|_: i32| 4 + random(14) as usize);
        let solid = [2, 10, 60, 300][volume % 4];
        let bytes: Vec<u8> = (0..size.iter().product()).map(|_| u8::from(random(300) >= solid / 2)).collect();
        let void = BitGrid::from_bytes(size, &bytes);
        let board = Chessboard::new(&void, &never).unwrap();
        let opening = opening(&void, &board, &never).unwrap();
        let anchors = anchors(&void, &board);
        let mut complex = Complex::closure(&void);
        let mut plain = Plain::new(&complex);
        collapse(&mut complex, &board.distance, &opening, &anchors, &Filter::default(), &Quiet, &never).unwrap();
        plain.run(&board.distance, &opening, &anchors);
        for at in plain.places() {
            for plane in 0..8 {
                assert_eq!(complex.has(at, plane), plain.has(at, plane), "volume {volume}, {size:?}: {at}, {plane}");
            }
        }
    }
}

#[test]
fn slabs_of_any_number_leave_the_same() {
    let mut state = 0x2545_f491_4f6c_dd1d_u64;
    let mut random = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 33) % 1000
    };
    let never = Cancel::new();
    for solid in [3, 15, 80] {
        let size = [75, 75, 90];
        let bytes: Vec<u8> = (0..size.iter().product()).map(|_| u8::from(random() >= solid)).collect();
        let void = BitGrid::from_bytes(size, &bytes);
        let board = Chessboard::new(&void, &never).unwrap();
        let opening = opening(&void, &board, &never).unwrap();
        let anchors = anchors(&void, &board);
        let left = |threads: usize| {
            let mut complex = Complex::closure(&void);
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            pool.install(|| {
                collapse(&mut complex, &board.distance, &opening, &anchors, &Filter::default(), &Quiet, &never)
            })
            .unwrap();
            complex
        };
        let one = left(1);
        for threads in [2, 5, 12] {
            assert!(one == left(threads), "{threads} threads, {solid} in 1000 solid");
        }
    }
}
