//! Closed forms, energy, and what must never happen.

use super::*;
use crate::flow::tests::{FLUX_W, lamp, modelled, room};
use crate::job::Quiet;
use glam::Vec3;

#[test]
fn what_is_absorbed_and_escapes_is_what_was_emitted() {
    for (triangles, bounces) in [(&room()[..], 0), (&room()[..], 3), (&room()[..10], 0), (&room()[..10], 2)] {
        let (_, model) = modelled(triangles, vec![lamp(Vec3::new(1.0, 1.4, 1.5), FLUX_W)], Vec::new());
        let circuit = Circuit::new(&model, &Surroundings::of(&model));
        let landed = photons::landed(&model, bounces, 0, &Cancel::new()).unwrap();
        let sources_w = sources_w(&circuit, &landed);
        let (absorbed_w, escaped_w) = circuit.losses_w(&sources_w, &circuit.potentials_w_m2(&sources_w));
        let all_w = absorbed_w + escaped_w + landed[0].absorbed_w + landed[0].escaped_w;
        assert!((all_w / FLUX_W - 1.0).abs() < 1e-6, "{all_w}");
    }
    let _ = Quiet;
}
