//! Which parts of a skeleton are rooms?
//!
//! Rooms are parts of the void that openings part from each other, openings small against the rooms on both sides. Noël &
//! Biri absorb nodes into the largest balls around them; in a flat room the ball is the height's and shatters the room. So
//! the cut is made by true sections instead:
//!
//! 1. Grow: from the widest section left, a region takes all it reaches over sections not below [`GROWS_AT`] of it. Rooms,
//!    passages and doorways become regions of their own, and so does much that is noise.
//! 2. Merge, worst first, two regions whose opening `A` is no neck: it is too large against one of them ([`OPEN_AT`]), or
//!    hardly narrower than both ([`STEP_AT`], `A` over the larger mean section, which bends and beams fail). A region's
//!    size against an opening is the larger of two sections: that of a block of its volume `V` and inner radius `R`,
//!    `sqrt(2 R V)`, which lets a long passage be a room; and its mean section, but no more than its volume over its
//!    length, which lets a closet be one behind its door. All openings between two regions count together, so pillars
//!    part no hall; niches, doorways and noise are small and go to a neighbour.
//! 3. Flood: what is about as wide as its room is the room's core; from the cores the rest is taken, widest first, so that
//!    two rooms meet at the narrowest section between them.

use super::links::Links;
use glam::Vec3;
use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

/// A region reaches over sections down to this share of its widest. Higher cuts more, and merging has more to mend.
pub const GROWS_AT: f32 = 0.8;

/// From this share of a room's own section on, an opening is a missing wall, not a neck. A square corridor must be four
/// widths long to be a room of its own.
pub const OPEN_AT: f32 = 0.5;

/// From this share of the wider side's mean section on, an opening is not narrower than what it joins: a bend, a beam.
pub const STEP_AT: f32 = 0.7;

/// A node is of a room's core when its section is at least this share of the room's mean.
pub const CORE_AT: f32 = 0.75;

/// What the cut goes by; nodes and edges by their numbers.
pub struct Widths<'a> {
    /// Who is joined to whom.
    pub links: &'a Links,
    /// The ends of each edge.
    pub edges: &'a [[u32; 2]],
    /// The section across each edge, m2.
    pub sections_m2: &'a [f32],
    /// The middle of each edge, metres.
    pub middles_m: &'a [Vec3],
    /// The volume nearest to each node, m3.
    pub volumes_m3: &'a [f32],
    /// The distance to matter at each node, metres.
    pub radii_m: &'a [f32],
    /// The length of an edge, metres.
    pub step_m: f32,
}

/// The cell of each node, numbered from 0 in the order of their lowest nodes.
pub fn cells(widths: &Widths) -> Vec<u32> {
    let nodes: Vec<f32> = (0..widths.links.nodes() as u32).map(|node| widths.at(node)).collect();
    let grown = grow(widths, &nodes);
    let merged = merge(widths, &nodes, &grown);
    flood(widths, &nodes, &merged)
}

impl Widths<'_> {
    /// The section at a node: the widest across its edges, m2. Of a node alone, its ball's.
    fn at(&self, node: u32) -> f32 {
        let across = self.links.of(node).iter().map(|link| self.sections_m2[link.edge as usize]);
        let ball = std::f32::consts::PI * self.radii_m[node as usize].powi(2);
        across.reduce(f32::max).unwrap_or(ball)
    }
}

/// Regions around the widest sections; one number a node.
fn grow(widths: &Widths, at: &[f32]) -> Vec<u32> {
    let mut widest: Vec<u32> = (0..at.len() as u32).collect();
    widest.sort_by(|a, b| at[*b as usize].total_cmp(&at[*a as usize]).then(a.cmp(b)));
    let mut region_of = vec![u32::MAX; at.len()];
    let mut regions = 0;
    let mut reached = Vec::new();
    for seed in widest {
        if region_of[seed as usize] != u32::MAX {
            continue;
        }
        let least = GROWS_AT * at[seed as usize];
        region_of[seed as usize] = regions;
        reached.push(seed);
        while let Some(node) = reached.pop() {
            for link in widths.links.of(node) {
                if region_of[link.node as usize] == u32::MAX && widths.sections_m2[link.edge as usize] >= least {
                    region_of[link.node as usize] = regions;
                    reached.push(link.node);
                }
            }
        }
        regions += 1;
    }
    region_of
}

/// An opening between two regions: several edges may cross it.
#[derive(Debug, Clone, Copy)]
struct Opening {
    middle_m: Vec3,
    area_m2: f32,
}

#[derive(Debug, Clone, Default)]
struct Region {
    volume_m3: f32,
    radius_m: f32,
    /// Steps of the curve in it, metres.
    length_m: f32,
    /// Sum of volume times the logarithm of the section there.
    log_sections: f32,
    openings: BTreeMap<u32, Vec<Opening>>,
    /// Counts mergers, so that scores from before are known to be old.
    age: u32,
}

impl Region {
    /// The geometric mean of its sections, weighted by volume, m2: sights through doors weigh little in it.
    fn section_m2(&self) -> f32 {
        (self.log_sections / self.volume_m3).exp()
    }

    /// What an opening is held against, m2: the section of a block of its volume and radius, or its own section as far as
    /// its volume bears it (a bay between pillars sees through the whole hall).
    fn size_m2(&self) -> f32 {
        let block_m2 = (2.0 * self.radius_m * self.volume_m3).sqrt();
        block_m2.max(self.section_m2().min(self.volume_m3 / self.length_m))
    }
}

/// How little of a neck the opening between two regions is: from 1 on it is none.
fn openness(a: &Region, b: &Region, openings: &[Opening]) -> f32 {
    let area_m2: f32 = openings.iter().map(|opening| opening.area_m2).sum();
    let open = area_m2 / (OPEN_AT * a.size_m2().min(b.size_m2()));
    let step = area_m2 / (STEP_AT * a.section_m2().max(b.section_m2()));
    open.max(step)
}

/// Adds an opening, unless it is one that is there already: its middle lies within the other's own radius.
fn add(openings: &mut Vec<Opening>, new: Opening) {
    let same = openings.iter_mut().find(|old| {
        let reach_2 = old.area_m2.max(new.area_m2) / std::f32::consts::PI;
        old.middle_m.distance_squared(new.middle_m) < reach_2
    });
    match same {
        Some(old) if old.area_m2 >= new.area_m2 => {}
        Some(old) => *old = new,
        None => openings.push(new),
    }
}

/// A pair of regions that may have to be merged; the most open pair is the greatest, then that of lower numbers.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Pair {
    /// The openness by its bits, which order as the positive numbers do.
    openness: u32,
    regions: Reverse<[u32; 2]>,
    ages: [u32; 2],
}

/// Merges regions until only necks are left between them; the region of each node.
fn merge(widths: &Widths, at: &[f32], region_of: &[u32]) -> Vec<u32> {
    let count = region_of.iter().max().map_or(0, |most| *most as usize + 1);
    let mut regions = vec![Region::default(); count];
    for (node, region) in region_of.iter().enumerate() {
        let region = &mut regions[*region as usize];
        // A node without a voxel of its own must not leave its region without a volume.
        let volume_m3 = widths.volumes_m3[node].max(1e-9);
        region.volume_m3 += volume_m3;
        region.length_m += widths.step_m;
        region.radius_m = region.radius_m.max(widths.radii_m[node]);
        region.log_sections += volume_m3 * at[node].max(1e-9).ln();
    }
    for (edge, ends) in widths.edges.iter().enumerate() {
        let [a, b] = ends.map(|end| region_of[end as usize]);
        if a != b {
            let opening = Opening { middle_m: widths.middles_m[edge], area_m2: widths.sections_m2[edge] };
            add(regions[a as usize].openings.entry(b).or_default(), opening);
            add(regions[b as usize].openings.entry(a).or_default(), opening);
        }
    }

    let mut pairs = BinaryHeap::new();
    let offer = |pairs: &mut BinaryHeap<Pair>, regions: &[Region], a: u32, b: u32| {
        let [a, b] = [a.min(b), a.max(b)];
        let (one, other) = (&regions[a as usize], &regions[b as usize]);
        let openness = openness(one, other, &one.openings[&b]);
        if openness >= 1.0 {
            let ages = [one.age, other.age];
            pairs.push(Pair { openness: openness.to_bits(), regions: Reverse([a, b]), ages });
        }
    };
    for a in 0..count as u32 {
        for &b in regions[a as usize].openings.keys().filter(|b| a < **b) {
            offer(&mut pairs, &regions, a, b);
        }
    }
    let mut into: Vec<u32> = (0..count as u32).collect();
    while let Some(Pair { regions: Reverse([a, b]), ages, .. }) = pairs.pop() {
        if [a, b].map(|region| regions[region as usize].age) != ages {
            continue;
        }
        into[b as usize] = a;
        let mut gone = std::mem::take(&mut regions[b as usize]);
        regions[b as usize].age = u32::MAX;
        gone.openings.remove(&a);
        let whole = &mut regions[a as usize];
        let within_m2 = whole.openings.remove(&b).iter().flatten().map(|opening| opening.area_m2).sum();
        // Behind the smaller one, nothing is wider open to the larger than the two are to each other.
        let smaller = if whole.volume_m3 < gone.volume_m3 { &mut *whole } else { &mut gone };
        for opening in smaller.openings.values_mut().flatten() {
            opening.area_m2 = opening.area_m2.min(within_m2);
        }
        whole.volume_m3 += gone.volume_m3;
        whole.length_m += gone.length_m;
        whole.radius_m = whole.radius_m.max(gone.radius_m);
        whole.log_sections += gone.log_sections;
        whole.age += 1;
        for (&beside, openings) in &gone.openings {
            regions[beside as usize].openings.remove(&b);
            for opening in openings {
                add(regions[a as usize].openings.entry(beside).or_default(), *opening);
            }
        }
        let openings = regions[a as usize].openings.clone();
        let besides: Vec<u32> = openings.keys().copied().collect();
        for (beside, openings) in openings {
            regions[beside as usize].openings.insert(a, openings);
        }
        for beside in besides {
            offer(&mut pairs, &regions, a, beside);
        }
    }

    let root = |mut region: u32| {
        while into[region as usize] != region {
            region = into[region as usize];
        }
        region
    };
    region_of.iter().map(|region| root(*region)).collect()
}

/// From the cores of the regions outwards, over the widest sections first; the cell of each node.
fn flood(widths: &Widths, at: &[f32], region_of: &[u32]) -> Vec<u32> {
    let mut sums: BTreeMap<u32, (f64, f64)> = BTreeMap::new();
    for (node, region) in region_of.iter().enumerate() {
        let volume_m3 = f64::from(widths.volumes_m3[node].max(1e-9));
        let (volume, logs) = sums.entry(*region).or_default();
        *volume += volume_m3;
        *logs += volume_m3 * f64::from(at[node].max(1e-9)).ln();
    }
    let core_m2 = |region: u32| sums.get(&region).map_or(0.0, |(volume, logs)| CORE_AT * (logs / volume).exp() as f32);

    // Largest section first; of equals the fewest steps from a core, then the lowest node.
    let mut open: BinaryHeap<(u32, Reverse<u32>, Reverse<u32>, u32)> = BinaryHeap::new();
    let mut cell_of = vec![u32::MAX; at.len()];
    for node in 0..at.len() {
        let region = region_of[node];
        if at[node] >= core_m2(region) {
            open.push((u32::MAX, Reverse(0), Reverse(node as u32), region));
        }
    }
    while let Some((_, Reverse(steps), Reverse(node), region)) = open.pop() {
        if cell_of[node as usize] != u32::MAX {
            continue;
        }
        cell_of[node as usize] = region;
        for link in widths.links.of(node).iter().filter(|link| cell_of[link.node as usize] == u32::MAX) {
            let section = widths.sections_m2[link.edge as usize].to_bits();
            open.push((section, Reverse(steps + 1), Reverse(link.node), region));
        }
    }

    // Numbered by their lowest nodes.
    let mut numbers = BTreeMap::new();
    for cell in &mut cell_of {
        let next = numbers.len() as u32;
        *cell = *numbers.entry(*cell).or_insert(next);
    }
    cell_of
}

#[cfg(test)]
mod tests;
