use super::*;
use crate::job::Quiet;
use crate::skeleton::anchors::anchors;
use crate::skeleton::complex::Complex;
use crate::voxel::bits::BitGrid;
use crate::voxel::chessboard::Chessboard;
use crate::voxel::opening::opening;

fn thinned(void: &BitGrid) -> Complex {
    let never = Cancel::new();
    let board = Chessboard::new(void, &never).unwrap();
    let opening = opening(void, &board, &never).unwrap();
    let mut complex = Complex::closure(void);
    collapse(&mut complex, &board.distance, &opening, &anchors(void, &board), &Quiet, &never).unwrap();
    complex
}

fn full(size: [usize; 3]) -> BitGrid {
    let mut void = BitGrid::new(size);
    void.fill(true);
    void
}

#[test]
fn a_bar_becomes_a_line_and_a_cube_a_point() {
    assert_eq!(thinned(&full([4, 4, 100])).count(), [89, 88, 0, 0]);
    assert_eq!(thinned(&full([128, 128, 128])).count(), [1, 0, 0, 0]);
}
