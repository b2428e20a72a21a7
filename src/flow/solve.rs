//! Which field balances exchange and loss: `M x = b` for a sparse symmetric positive definite `M`.
//!
//! Conjugate gradients (Hestenes & Stiefel 1952) with the diagonal as preconditioner. The systems here are diagonally
//! dominant exchanges of a few thousand unknowns, where tens of products do and nothing needs to be factorised. Right-hand
//! sides are solved each by itself, side by side on the threads; every sum runs in the order of the unknowns, so the bits do
//! not depend on the threads. Long chains with little loss take as many products as they have links: those are better
//! eliminated.

use rayon::prelude::*;

/// Products after which a solve gives what it has, for each unknown: twice what exact arithmetic would need.
const PRODUCTS_AN_UNKNOWN: usize = 2;

/// Products that even the smallest system may take.
const LEAST_PRODUCTS: usize = 64;

/// A sparse symmetric matrix, in compressed rows; the diagonal apart.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Symmetric {
    diagonal: Vec<f64>,
    /// For each row the first of its entries, and the end of the last row.
    first: Vec<usize>,
    columns: Vec<u32>,
    values: Vec<f64>,
}

impl Symmetric {
    /// The matrix with this diagonal and, for each `(row, column, value)`, that value in both halves. Entries of one place
    /// add up in their order, those on the diagonal to the diagonal; those beyond it are left out. Takes
    /// `O(entries log(entries of a row))`.
    pub fn new(mut diagonal: Vec<f64>, entries: &[(u32, u32, f64)]) -> Self {
        let unknowns = diagonal.len();
        let inside = |&&(row, column, _): &&(u32, u32, f64)| (row.max(column) as usize) < unknowns;
        let mut first = vec![0_usize; unknowns + 1];
        for &(row, column, value) in entries.iter().filter(inside) {
            if row == column {
                diagonal[row as usize] += value;
            } else {
                first[row as usize + 1] += 1;
                first[column as usize + 1] += 1;
            }
        }
        for row in 0..unknowns {
            first[row + 1] += first[row];
        }
        let mut next = first.clone();
        let mut placed = vec![(0_u32, 0.0); first[unknowns]];
        for &(row, column, value) in entries.iter().filter(inside).filter(|(row, column, _)| row != column) {
            for (from, to) in [(row, column), (column, row)] {
                placed[next[from as usize]] = (to, value);
                next[from as usize] += 1;
            }
        }

        // The sort is stable, so entries of one place stay in their order.
        let mut matrix = Self { diagonal, first: vec![0], columns: Vec::new(), values: Vec::new() };
        for row in 0..unknowns {
            let row_entries = &mut placed[first[row]..first[row + 1]];
            row_entries.sort_by_key(|(column, _)| *column);
            for some in row_entries.chunk_by(|a, b| a.0 == b.0) {
                matrix.columns.push(some[0].0);
                matrix.values.push(some.iter().map(|(_, value)| value).sum());
            }
            matrix.first.push(matrix.columns.len());
        }
        matrix
    }

    /// How many unknowns it has.
    pub fn unknowns(&self) -> usize {
        self.diagonal.len()
    }

    /// What it makes of a vector that has a number for each unknown.
    pub fn times(&self, vector: &[f64]) -> Vec<f64> {
        let mut product = vec![0.0; self.unknowns()];
        self.times_into(vector, &mut product);
        product
    }

    fn times_into(&self, vector: &[f64], product: &mut [f64]) {
        for (row, product) in product.iter_mut().enumerate() {
            let range = self.first[row]..self.first[row + 1];
            let beside = self.columns[range.clone()].iter().zip(&self.values[range]);
            *product = self.diagonal[row] * vector[row]
                + beside.map(|(&column, value)| value * vector[column as usize]).sum::<f64>();
        }
    }
}

/// Solves `matrix x = b` for each `b` of `right` (a number for each unknown) until the residual, measured against `b`, both in
/// the norm of the inverse diagonal, is at most `tolerance` (1e-8: eight digits), or the products run out.
///
/// An unknown whose diagonal is not positive has no equation and gets 0. A `b` that is not finite gives zeros. What comes back
/// is finite always.
pub fn solve(matrix: &Symmetric, right: &[Vec<f64>], tolerance: f64) -> Vec<Vec<f64>> {
    right.par_iter().map(|right| solve_one(matrix, right, tolerance)).collect()
}

fn solve_one(matrix: &Symmetric, right: &[f64], tolerance: f64) -> Vec<f64> {
    let unknowns = matrix.unknowns();
    let inverse: Vec<f64> =
        matrix.diagonal.iter().map(|&entry| if entry > 0.0 { entry.recip() } else { 0.0 }).collect();
    let weighted =
        |vector: &[f64]| -> f64 { vector.iter().zip(&inverse).map(|(part, weight)| weight * part * part).sum() };

    let mut solution = vec![0.0; unknowns];
    let mut residual: Vec<f64> =
        right.iter().copied().zip(&inverse).map(|(part, &weight)| if weight > 0.0 { part } else { 0.0 }).collect();
    residual.resize(unknowns, 0.0);
    let mut step: Vec<f64> = residual.iter().zip(&inverse).map(|(part, weight)| weight * part).collect();
    let mut product = vec![0.0; unknowns];
    let mut size = weighted(&residual);
    let enough = tolerance * tolerance * size;

    for _ in 0..LEAST_PRODUCTS.max(PRODUCTS_AN_UNKNOWN * unknowns) {
        // Written so that a size that is no number ends it too.
        if !(size > enough && size.is_finite()) {
            break;
        }
        matrix.times_into(&step, &mut product);
        let energy: f64 = step
            .iter()
            .zip(&product)
            .zip(&inverse)
            .map(|((step, product), weight)| if *weight > 0.0 { step * product } else { 0.0 })
            .sum();
        if energy.is_nan() || energy <= 0.0 {
            break;
        }
        let length = size / energy;
        for at in 0..unknowns {
            solution[at] += length * step[at];
            residual[at] = if inverse[at] > 0.0 { residual[at] - length * product[at] } else { 0.0 };
        }
        let size_before = std::mem::replace(&mut size, weighted(&residual));
        for at in 0..unknowns {
            step[at] = inverse[at] * residual[at] + size / size_before * step[at];
        }
    }
    if solution.iter().all(|part| part.is_finite()) { solution } else { vec![0.0; unknowns] }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[track_caller]
    fn check(matrix: &Symmetric, wanted: &[f64]) {
        let found = solve(matrix, &[matrix.times(wanted)], 1e-12).remove(0);
        for (found, wanted) in found.iter().zip(wanted) {
            assert!((found - wanted).abs() < 1e-8 * (1.0 + wanted.abs()), "{found} is not {wanted}");
        }
    }

    #[test]
    fn entries_of_one_place_add_up() {
        let matrix = Symmetric::new(vec![2.0, 3.0], &[(0, 1, 0.5), (1, 0, 0.25), (1, 1, 1.0), (0, 7, 9.0)]);
        assert_eq!(matrix.times(&[1.0, 10.0]), [2.0 + 7.5, 0.75 + 40.0]);
        assert_eq!((matrix.unknowns(), matrix.columns.len()), (2, 2));
    }

    #[test]
    fn a_chain_falls_as_its_difference_equation_says() {
        // -x[i-1] + (2 + loss) x[i] - x[i+1] = 0: each step is the smaller root of r + 1/r = 2 + loss.
        let (links, loss) = (400_u32, 0.3_f64);
        let mut diagonal = vec![2.0 + loss; links as usize];
        diagonal[0] = 1.0;
        let entries: Vec<_> = (1..links).map(|at| (at - 1, at, -1.0)).collect();
        let mut right = vec![0.0; links as usize];
        // The first unknown is held at 1 by its own row: x0 - x1 = 1 - r.
        let root = 1.0 + loss / 2.0 - (loss + loss * loss / 4.0).sqrt();
        right[0] = 1.0 - root;
        let found = solve(&Symmetric::new(diagonal, &entries), &[right], 1e-13).remove(0);
        for (at, found) in (0..40).zip(found) {
            assert!((found / root.powi(at) - 1.0).abs() < 1e-6, "{at}: {found}");
        }
    }

    #[test]
    fn what_has_no_equation_is_zero_and_nothing_is_ever_no_number() {
        let matrix = Symmetric::new(vec![1.0, 0.0, 2.0], &[(0, 2, -0.5)]);
        let found = solve(&matrix, &[vec![1.0, 5.0, 0.0], vec![0.0; 3], vec![f64::NAN; 3], Vec::new()], 1e-12);
        assert!((found[0][0] - 1.0 / 0.875).abs() < 1e-9 && found[0][1] == 0.0);
        assert_eq!(found[1..], [vec![0.0; 3], vec![0.0; 3], vec![0.0; 3]]);
        // A closed ring without loss has no one solution.
        let ring = Symmetric::new(vec![2.0; 3], &[(0, 1, -1.0), (1, 2, -1.0), (2, 0, -1.0)]);
        assert!(solve(&ring, &[vec![1.0, 0.0, 0.0]], 1e-12)[0].iter().all(|part| part.is_finite()));
        assert_eq!(solve(&Symmetric::default(), &[Vec::new()], 1e-9), [Vec::<f64>::new()]);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn any_lossy_exchange_is_solved(
            pairs in prop::collection::vec((0..40_u32, 0..40_u32, 1e-3..10.0_f64), 0..300),
            losses in prop::collection::vec(1e-3..1.0_f64, 40),
            wanted in prop::collection::vec(-1.0..1.0_f64, 40),
        ) {
            let mut diagonal = losses;
            let pairs: Vec<_> = pairs.into_iter().filter(|(a, b, _)| a != b).collect();
            for &(a, b, exchange) in &pairs {
                diagonal[a as usize] += exchange;
                diagonal[b as usize] += exchange;
            }
            let entries: Vec<_> = pairs.iter().map(|&(a, b, exchange)| (a, b, -exchange)).collect();
            check(&Symmetric::new(diagonal, &entries), &wanted);
        }

        #[test]
        fn any_number_of_threads_gives_the_same_bits(entries in prop::collection::vec((0..9_u32, 0..9_u32, -1.0..0.0_f64), 0..60)) {
            let matrix = Symmetric::new(vec![99.0; 9], &entries.into_iter().filter(|(a, b, _)| a != b).collect::<Vec<_>>());
            let right: Vec<Vec<f64>> = (0..9).map(|at| (0..9).map(|i| f64::from(u8::from(i == at))).collect()).collect();
            let on = |threads| rayon::ThreadPoolBuilder::new().num_threads(threads).build().map(|pool| pool.install(|| solve(&matrix, &right, 1e-10)));
            prop_assert_eq!(on(1).ok(), on(3).ok());
        }
    }
}
