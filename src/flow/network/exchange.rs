//! The exchange of light among patches as a matrix.

use super::lines::Line;
use super::walk::End;

/// What each patch sees of each other.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Exchange {
    /// Pairs of patches that see each other, as many as there are lines, each standing for both ways round: entries of the
    /// symmetric `X_ij`, m2, which add up.
    pub pairs: Vec<(u32, u32, f64)>,
    /// All that each patch sees, walls or not, m2: by its lines what its area is by its points.
    pub seen_m2: Vec<f64>,
    /// What of it leads out of the scene or onto the bodies of lights, m2.
    pub lost_m2: Vec<f64>,
}

/// Which lines count.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Half {
    /// All.
    Both,
    /// Every second, for twice.
    Odd,
    /// The others, for twice.
    Even,
}

impl Exchange {
    /// The exchange that lines measure among `patches` patches. `merged` names the patch that takes a patch's place, for a
    /// coarser network; the identity for the whole one. Linear in the lines.
    pub fn new(patches: usize, lines: &[Line], half: Half, merged: impl Fn(u32) -> u32) -> Self {
        let mut seen_m2 = vec![0.0; patches];
        let mut lost_m2 = vec![0.0; patches];
        let mut pairs: Vec<(u32, u32, f64)> = Vec::with_capacity(lines.len());
        let mut vertices: Vec<Vertex> = Vec::new();
        for line in lines {
            let weight_m2 = match half {
                Half::Both => line.weight_m2,
                _ if line.odd == (half == Half::Odd) => 2.0 * line.weight_m2,
                _ => continue,
            };
            vertices.clear();
            vertices.extend(along(line));
            for (number, one) in vertices.iter().enumerate() {
                let Some(patch) = one.forwards.map(&merged) else { continue };
                let mut passes = 1.0;
                seen_m2[patch as usize] += weight_m2;
                for other in &vertices[number + 1..] {
                    match other.backwards.map(&merged) {
                        Some(beside) => {
                            // Within a patch a line goes both ways too.
                            let ways = if patch == beside { 2.0 } else { 1.0 };
                            pairs.push((patch, beside, ways * weight_m2 * passes));
                        }
                        None => lost_m2[patch as usize] += weight_m2 * passes,
                    }
                    passes *= other.passes;
                }
            }
            for (number, one) in vertices.iter().enumerate() {
                let Some(patch) = one.backwards.map(&merged) else { continue };
                seen_m2[patch as usize] += weight_m2;
                let passes: f64 = vertices[1..number.max(1)].iter().map(|vertex| vertex.passes).product();
                if vertices[0].forwards.is_none() {
                    lost_m2[patch as usize] += weight_m2 * passes;
                }
            }
        }
        Self { pairs, seen_m2, lost_m2 }
    }
}

/// A place on a line where light is met.
#[derive(Debug, Clone, Copy)]
struct Vertex {
    /// The patch that looks along the line.
    forwards: Option<u32>,
    /// The patch that looks back along it.
    backwards: Option<u32>,
    /// Share that passes straight on.
    passes: f64,
}

fn along(line: &Line) -> impl Iterator<Item = Vertex> + '_ {
    let patch = |end: End| if let End::Patch(patch) = end { Some(patch) } else { None };
    let first = Vertex { forwards: patch(line.ends[0]), backwards: None, passes: 0.0 };
    let last = Vertex { forwards: None, backwards: patch(line.ends[1]), passes: 0.0 };
    let panes = line.panes.iter().map(|pane| Vertex {
        forwards: Some(pane.sides[1]),
        backwards: Some(pane.sides[0]),
        passes: f64::from(pane.at.answer.passes),
    });
    std::iter::once(first).chain(panes).chain(std::iter::once(last))
}
