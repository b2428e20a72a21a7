//! Which potentials does a resistor network take, fed with currents?
//!
//! A skeleton is nearly a tree, and a tree is solved exactly in one pass from its leaves to its root and one back: each
//! unknown is eliminated into those beside it, the one with the fewest first (minimum degree, Tinney & Walker 1967), which
//! on a tree makes no new entries and with a few loops hardly any. Conjugate gradients would take as many steps as the
//! longest way has edges. Chosen over a crate (faer, sprs and nalgebra-sparse are general and large) because it is this
//! short, needs no pivots, and keeps what matters here: only positive numbers are added, the loss of an unknown is carried
//! along by itself instead of being found as a small difference, so that walls that absorb a millionth still come out right.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// A network of unknowns joined by conductances, each with a conductance to the ground, factorised.
#[derive(Debug, Clone, PartialEq)]
pub struct Eliminated {
    /// Unknowns in the order of their elimination, each with what it was joined to then.
    steps: Vec<Step>,
}

#[derive(Debug, Clone, PartialEq)]
struct Step {
    unknown: u32,
    /// Its conductance to the ground and to all others that were left; 0 where it had none at all.
    total: f64,
    beside: Vec<(u32, f64)>,
}

impl Eliminated {
    /// Eliminates the unknowns with conductances `to_ground` (none negative) and `joints` `(a, b, conductance)`; joints that
    /// are not positive count as none. About a microsecond an unknown for trees.
    pub fn new(mut to_ground: Vec<f64>, joints: &[(u32, u32, f64)]) -> Self {
        let mut beside: Vec<Vec<(u32, f64)>> = vec![Vec::new(); to_ground.len()];
        for &(a, b, conductance) in joints.iter().filter(|(a, b, conductance)| a != b && *conductance > 0.0) {
            join(&mut beside, a, b, conductance);
        }

        let mut open: BinaryHeap<Reverse<(usize, u32)>> =
            beside.iter().enumerate().map(|(unknown, joints)| Reverse((joints.len(), unknown as u32))).collect();
        let mut done = vec![false; to_ground.len()];
        let mut steps = Vec::with_capacity(to_ground.len());
        while let Some(Reverse((degree, unknown))) = open.pop() {
            let at = unknown as usize;
            if done[at] || degree != beside[at].len() {
                continue;
            }
            done[at] = true;
            let here = std::mem::take(&mut beside[at]);
            let total = to_ground[at] + here.iter().map(|(_, conductance)| conductance).sum::<f64>();

            // Star to mesh: what led here leads from each neighbour to each other and to the ground.
            for (number, &(a, to_a)) in here.iter().enumerate() {
                beside[a as usize].retain(|(other, _)| *other != unknown);
                to_ground[a as usize] += to_a * (to_ground[at] / total);
                for &(b, to_b) in &here[..number] {
                    join(&mut beside, a, b, to_a * (to_b / total));
                }
            }
            for &(a, _) in &here {
                open.push(Reverse((beside[a as usize].len(), a)));
            }
            steps.push(Step { unknown, total, beside: here });
        }
        Self { steps }
    }

    /// The potentials for currents fed into the unknowns; 0 where nothing leads to the ground. Linear in what is stored.
    pub fn potentials(&self, currents: &[f64]) -> Vec<f64> {
        let mut potentials = currents.to_vec();
        for Step { unknown, total, beside } in &self.steps {
            let share = potentials[*unknown as usize] / total;
            if *total > 0.0 {
                beside.iter().for_each(|(other, conductance)| potentials[*other as usize] += share * conductance);
            }
        }
        for Step { unknown, total, beside } in self.steps.iter().rev() {
            let from: f64 = beside.iter().map(|(other, conductance)| conductance * potentials[*other as usize]).sum();
            let potential = (potentials[*unknown as usize] + from) / total;
            potentials[*unknown as usize] = if *total > 0.0 { potential } else { 0.0 };
        }
        potentials
    }
}

/// Adds a conductance between two unknowns, to the one there is if there is one.
fn join(beside: &mut [Vec<(u32, f64)>], a: u32, b: u32, conductance: f64) {
    for (from, to) in [(a, b), (b, a)] {
        let joints = &mut beside[from as usize];
        match joints.iter_mut().find(|(other, _)| *other == to) {
            Some((_, there)) => *there += conductance,
            None => joints.push((to, conductance)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::flow::solve::{Symmetric, solve};
    use proptest::prelude::*;

    #[test]
    fn a_chain_falls_as_its_difference_equation_says() {
        let (links, loss) = (300_u32, 0.2_f64);
        let joints: Vec<_> = (1..links).map(|at| (at - 1, at, 1.0)).collect();
        let mut currents = vec![0.0; links as usize];
        currents[0] = 1.0;
        let found = Eliminated::new(vec![loss; links as usize], &joints).potentials(&currents);
        let root = 1.0 + loss / 2.0 - (loss + loss * loss / 4.0).sqrt();
        for at in 0..200 {
            assert!((found[at + 1] / found[at] / root - 1.0).abs() < 1e-9, "{at}");
        }
    }

    #[test]
    fn a_loss_of_a_billionth_is_not_lost() {
        let joints = [(0, 1, 3.0), (1, 2, 0.5), (2, 0, 7.0), (2, 3, 1.0)];
        let found = Eliminated::new(vec![0.0, 1e-9, 0.0, 0.0], &joints).potentials(&[0.0, 0.0, 0.0, 2.0]);
        assert!((found[1] * 1e-9 / 2.0 - 1.0).abs() < 1e-12, "{found:?}");
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]
        #[test]
        fn it_agrees_with_conjugate_gradients(
            joints in prop::collection::vec((0..30_u32, 0..30_u32, 1e-3..10.0_f64), 0..60),
            to_ground in prop::collection::vec(1e-3..1.0_f64, 30),
            currents in prop::collection::vec(0.0..1.0_f64, 30),
        ) {
            let joints: Vec<_> = joints.into_iter().filter(|(a, b, _)| a != b).collect();
            let mut diagonal = to_ground.clone();
            for &(a, b, conductance) in &joints {
                diagonal[a as usize] += conductance;
                diagonal[b as usize] += conductance;
            }
            let entries: Vec<_> = joints.iter().map(|&(a, b, conductance)| (a, b, -conductance)).collect();
            let want = solve(&Symmetric::new(diagonal, &entries), std::slice::from_ref(&currents), 1e-12).remove(0);
            let found = Eliminated::new(to_ground, &joints).potentials(&currents);
            for (found, want) in found.iter().zip(&want) {
                prop_assert!((found / want - 1.0).abs() < 1e-6, "{} is not {}", found, want);
            }
        }
    }
}
