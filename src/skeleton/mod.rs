//! Where does the void run?
//!
//! The void is thinned to curves in the middle of its passages and rooms, with as many pieces and loops as it has. Steps,
//! each in its file: the cubical complex of the void; ties for floating solids, which could only be surrounded by a
//! surface; anchors in the middles of rooms; the collapse; branches that say nothing cut, dead ends grown to their walls. The
//! curve becomes a graph with true radii and sections, is cut into cells (rooms) at necks (doorways), and each void voxel
//! learns its nearest node.
//! Passages under two voxels may be lost before this, when the scene is made into voxels, not here.

pub mod anchors;
pub mod cells;
pub mod collapse;
pub mod complex;
pub mod curve;
mod filter;
mod graph;
pub mod links;
mod matter;
pub mod nearest;
mod necks;
pub mod prune;
mod sections;
pub mod tie;
pub mod topology;
mod validate;

pub use filter::Filter;
pub use graph::{Cell, Edge, Node, Shape, Skeleton};
pub use necks::Neck;

use crate::job::{Cancel, Cancelled, Progress};
use crate::voxel::bits::BitGrid;
use crate::voxel::chessboard::Chessboard;
use crate::voxel::opening;
use complex::Complex;
use curve::Curve;

/// Thins a void (outside the grid all is matter) to its centre lines. They have as many components and loops as the void,
/// no surface, and at least one vertex for each component; an empty void gives an empty curve. The same for any number of
/// threads.
///
/// Stages reported: `distance`, `opening`, `complex`, `ties`, `anchors`, `collapse` (a unit a layer), `prune`.
/// Memory: about 4 bytes a voxel. Time: about 10 ns a voxel on one thread where half of the grid is void.
///
/// # Errors
/// [`Cancelled`] when `cancel` was raised.
///
/// ```
/// use lightvein::job::{Cancel, Cancelled, Quiet};
/// use lightvein::skeleton::{thin, topology};
/// use lightvein::voxel::bits::BitGrid;
///
/// // A frame: a slab of 24 x 24 x 6 voxels with a hole through it.
/// let size = [24, 24, 6];
/// let bytes: Vec<u8> = (0..24 * 24 * 6)
///     .map(|at| [at % 24, at / 24 % 24].map(|along| (8..16).contains(&along)) != [true, true])
///     .map(u8::from)
///     .collect();
/// let curve = thin(&BitGrid::from_bytes(size, &bytes), &Quiet, &Cancel::new())?;
/// let topology = topology::of_curve(&curve);
/// assert_eq!((topology.components, topology.loops), (1, 1));
/// # Ok::<(), Cancelled>(())
/// ```
pub fn thin(void: &BitGrid, progress: &dyn Progress, cancel: &Cancel) -> Result<Curve, Cancelled> {
    thin_by(&Filter::default(), void, progress, cancel)
}

/// The same with a filter of one's own.
///
/// # Errors
/// [`Cancelled`] when `cancel` was raised.
pub fn thin_by(filter: &Filter, void: &BitGrid, progress: &dyn Progress, cancel: &Cancel) -> Result<Curve, Cancelled> {
    let board = staged(progress, "distance", || Chessboard::new(void, cancel))?;
    let opening = staged(progress, "opening", || opening::opening(void, &board, cancel))?;
    let mut complex = staged(progress, "complex", || Complex::closure(void));
    staged(progress, "ties", || tie::tie(&mut complex, void, cancel))?;
    let anchors = staged(progress, "anchors", || match filter.keeps_middles {
        true => anchors::anchors(void, &board),
        false => Vec::new(),
    });
    staged(progress, "collapse", || {
        collapse::collapse(&mut complex, &board.distance, &opening, &anchors, filter, progress, cancel)
    })?;
    Ok(staged(progress, "prune", || {
        let mut curve = Curve::new(&complex, &anchors, board.distance, opening);
        if filter.cuts_branches {
            prune::prune(&mut curve);
        }
        if filter.grows_ends {
            prune::regrow(&mut curve);
        }
        curve
    }))
}

fn staged<T>(progress: &dyn Progress, stage: &'static str, work: impl FnOnce() -> T) -> T {
    progress.begin(stage, 0);
    let done = work();
    progress.end();
    done
}

#[cfg(test)]
mod tests;
