//! How bright does each patch become by all reflections?
//!
//! Radiosity: `M_i = rho_i (E0_i + sum_j X_ij M_j / D_i)`, with `D_i` all that patch i sees. With `D / rho` on the diagonal
//! the system is symmetric and positive definite for any mix of materials, so conjugate gradients solve it; patches that
//! reflect nothing drop out. Energy balances to the rounding of the solution: what lands is absorbed or lost.

use super::exchange::Exchange;
use crate::flow::solve::{Symmetric, solve};

/// Share of the right-hand side that the residual may have.
const TOLERANCE: f64 = 1e-9;

/// Highest reflectance of a patch: where nothing absorbs there is no balance.
pub const MOST_REFLECTANCE: f64 = 0.999_999;

/// For each column of `landed_w` (what each patch reflects of the light that lands on it straight from lights, W) the
/// irradiance on each patch by light that was reflected at least once, W/m2. `reflectances` are the patches' own.
///
/// Costs some tens of products of the exchange with a vector for each column.
pub fn reflected_w_m2(exchange: &Exchange, reflectances: &[f64], landed_w: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let reflectance = |patch: usize| reflectances[patch].clamp(0.0, MOST_REFLECTANCE);
    let takes_part = |patch: usize| reflectance(patch) > 0.0 && exchange.seen_m2[patch] > 0.0;
    let patches = reflectances.len();

    let diagonal = (0..patches)
        .map(|patch| if takes_part(patch) { exchange.seen_m2[patch] / reflectance(patch) } else { 0.0 })
        .collect();
    let pairs = exchange.pairs.iter().filter(|&&(i, j, _)| takes_part(i as usize) && takes_part(j as usize));
    let entries: Vec<(u32, u32, f64)> = pairs.map(|&(i, j, x_m2)| (i, j, -x_m2)).collect();
    let matrix = Symmetric::new(diagonal, &entries);
    let right: Vec<Vec<f64>> = (landed_w.iter())
        .map(|landed_w| {
            let right = |(patch, reflected_w)| if takes_part(patch) { reflected_w / reflectance(patch) } else { 0.0 };
            landed_w.iter().copied().enumerate().map(right).collect()
        })
        .collect();

    let radiosities = solve(&matrix, &right, TOLERANCE);
    radiosities.iter().map(|radiosity_w_m2| arriving_w_m2(exchange, radiosity_w_m2)).collect()
}

/// Whether light that lands is never absorbed: patches that see each other reflect all, and none of it is lost.
pub fn without_end(exchange: &Exchange, reflectances: &[f64], landed_w: &[f64]) -> bool {
    // What patches hang together with, the lowest number leads.
    let mut leader: Vec<usize> = (0..reflectances.len()).collect();
    let find = |leader: &mut Vec<usize>, mut patch: usize| {
        while leader[patch] != patch {
            leader[patch] = leader[leader[patch]];
            patch = leader[patch];
        }
        patch
    };
    for &(i, j, _) in &exchange.pairs {
        let (a, b) = (find(&mut leader, i as usize), find(&mut leader, j as usize));
        leader[a.max(b)] = a.min(b);
    }
    let (mut seen_m2, mut ends_m2, mut lands_w) =
        (vec![0.0; leader.len()], vec![0.0; leader.len()], vec![0.0; leader.len()]);
    for patch in 0..leader.len() {
        let void = find(&mut leader, patch);
        seen_m2[void] += exchange.seen_m2[patch];
        ends_m2[void] += (1.0 - reflectances[patch]) * exchange.seen_m2[patch] + exchange.lost_m2[patch];
        lands_w[void] += landed_w[patch];
    }
    (0..leader.len()).any(|void| lands_w[void] > 0.0 && ends_m2[void] < (1.0 - MOST_REFLECTANCE) * seen_m2[void])
}

/// The irradiance on each patch by light that patches of these radiosities send out.
fn arriving_w_m2(exchange: &Exchange, radiosity_w_m2: &[f64]) -> Vec<f64> {
    let mut arriving_w = vec![0.0; radiosity_w_m2.len()];
    for &(i, j, x_m2) in &exchange.pairs {
        arriving_w[i as usize] += x_m2 * radiosity_w_m2[j as usize];
        if i != j {
            arriving_w[j as usize] += x_m2 * radiosity_w_m2[i as usize];
        }
    }
    let per_m2 = |(arriving_w, seen_m2): (f64, &f64)| if *seen_m2 > 0.0 { arriving_w / seen_m2 } else { 0.0 };
    arriving_w.into_iter().zip(&exchange.seen_m2).map(per_m2).collect()
}
