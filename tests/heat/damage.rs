//! A bar that breaks: it dissipates the fracture energy by area, whatever the mesh.

use serde_json::{Value, json};

use crate::slab::{Deck, Slab};

const STRENGTH: f64 = 0.4;
const ENERGY: f64 = 0.002;

fn law(part: &str, id: usize, strength: f64, softening: usize) -> Value {
    json!({"model_part_name": format!("Heat.{part}"), "properties_id": id, "Material": {"Tables": {},
        "constitutive_law": {"name": "SmallStrainIsotropicDamagePlaneStressRankine"}, "Variables": {"YOUNG_MODULUS": 200.0,
        "POISSON_RATIO": 0.0, "YIELD_STRESS": strength, "FRACTURE_ENERGY": ENERGY, "SOFTENING_TYPE": softening}}})
}

/// The work of pulling the slab until it has broken in its middle, which is weaker.
fn work(slab: &Slab, softening: usize, end: f64) -> f64 {
    let steps = 120;
    let mut deck = Deck::new("Static", 1.0 / f64::from(steps), 1.0, 1.0)
        .assign("Left", "DISPLACEMENT_X", json!(0.0), true)
        .assign("Foot", "DISPLACEMENT_Y", json!(0.0), true)
        .assign("Right", "DISPLACEMENT_X", json!(format!("{end}*t")), true);
    deck.materials = vec![law("Body", 1, STRENGTH, softening), law("Middle", 2, 0.8 * STRENGTH, softening)];
    let results = deck.run(slab);
    let force = |step: usize| -> f64 {
        let at = results.nodal("REACTION_X", step);
        (0..=slab.rows).map(|row| at[&(slab.node(slab.cells, row) as u64)]).sum()
    };
    (0..results.len())
        .map(|step| 0.5 * (force(step) + if step == 0 { 0.0 } else { force(step - 1) }) * end / f64::from(steps))
        .sum()
}

#[test]
fn a_bar_takes_its_fracture_energy_whatever_the_mesh() {
    for (softening, end) in [(0, 0.012), (1, 0.05)] {
        for (cells, rows, triangles) in [(5, 1, false), (11, 1, false), (21, 2, false), (11, 1, true)] {
            let slab = Slab {
                element: "SmallDisplacementElement",
                rows,
                triangles,
                height: rows as f64 / cells as f64,
                ..Slab::new(cells)
            };
            let taken = work(&slab, softening, end) / slab.height;
            assert!((taken / ENERGY - 1.0).abs() < 0.01, "{softening} {cells} {triangles}: {taken}");
        }
    }
}
