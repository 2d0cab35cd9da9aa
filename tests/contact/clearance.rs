//! Clearance and interference by number (ANALYTIC): two blocks in uniaxial strain, whose slave side is moved before the run. The pressure is
//! M (i − c)/(h₁ + h₂) with the constrained modulus M, the approach i of the ends and the heights that the blocks then have.

use crate::blocks::{Deck, Joint, Mesh, POISSON};
use serde_json::{Value, json};
use zelus::{RunOptions, Silent, Simulation};

const YOUNG: f64 = 1000.0;

/// Two blocks of height 1 with a gap in the mesh, pressed by an approach of their ends.
struct Blocks {
    space: usize,
    second_order: bool,
    gap: f64,
    approach: f64,
    clearance: Value,
    process: &'static str,
    condition: &'static str,
}

impl Blocks {
    fn write(&self) -> tempfile::TempDir {
        let (space, up) = (self.space, self.space - 1);
        let mut mesh = Mesh::new(space);
        let depth = |cells: usize| if space == 3 { cells } else { 1 };
        let at = |x: [f64; 3], base: f64| {
            let mut x = x;
            x[up] += base;
            x
        };
        let divisions = |cells: usize| if space == 3 { [cells, depth(cells), 2] } else { [cells, 2, 1] };
        let lower = mesh.block("Lower", divisions(3), |x| at(x, -1.0));
        let upper = mesh.block("Upper", divisions(4), |x| at(x, self.gap));
        let (own, other) = (&upper[&(up, 0)], &lower[&(up, 1)]);
        mesh.part("Slave", own.0.clone(), own.1.clone());
        mesh.part("Master", other.0.clone(), other.1.clone());
        mesh.part("Interface", [own.0.clone(), other.0.clone()].concat(), [own.1.clone(), other.1.clone()].concat());
        mesh.part("Base", lower[&(up, 0)].0.clone(), Vec::new());
        mesh.part("Top", upper[&(up, 1)].0.clone(), upper[&(up, 1)].1.clone());
        if self.second_order {
            mesh.raise("Upper", false);
            mesh.raise("Lower", false);
        }
        let along = |value: Value, others: Value| {
            let of = |c: usize| if c == up { value.clone() } else { others.clone() };
            [of(0), of(1), if space == 3 { of(2) } else { Value::Null }]
        };
        let supports = vec![
            ("Lower".to_owned(), along(Value::Null, json!(0.0))),
            ("Upper".to_owned(), along(Value::Null, json!(0.0))),
            ("Base".to_owned(), along(json!(0.0), Value::Null)),
            ("Top".to_owned(), along(json!(format!("-{:?}*t", self.approach)), Value::Null)),
        ];
        let deck = Deck { mesh, joint: Joint::Frictionless, supports, pressure: 0.0, young: YOUNG, steps: 1 };
        let folder = tempfile::tempdir().expect("a folder");
        deck.write(folder.path(), |deck| {
            deck["solver_settings"]["contact_settings"]["mortar_type"] = json!(self.condition);
            let list = deck["processes"]["contact_process_list"].as_array_mut().expect("a list");
            list[0]["python_module"] = json!(self.process);
            list.push(json!({"python_module": "initial_clearance_process", "Parameters": {
                "model_part_name": "Structure.Slave", "master_model_part_name": "Structure.Master",
                "clearance": self.clearance}}));
            deck["processes"]["json_output_process_list"] = json!([]);
        });
        folder
    }

    /// Pressure at the top.
    fn pressure(&self) -> f64 {
        let folder = self.write();
        let path = folder.path().join("ProjectParameters.json");
        let mut run = Simulation::open(&path, &RunOptions::default()).expect("a deck");
        run.run(&mut Silent).expect("a converged run");
        let said = &run.report().warnings;
        assert!(!said.iter().any(|warning| warning.contains("initial-penetration")), "{said:?}");
        let reaction = run.field("REACTION").expect("reactions");
        let top = &run.part().expect("a part").part("Top").expect("the top").nodes;
        -top.iter().map(|&node| reaction[3 * node as usize + self.space - 1]).sum::<f64>()
    }
}

#[test]
fn clearances_and_interferences_are_exact() {
    let modulus = YOUNG * (1.0 - POISSON) / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON));
    let formulations =
        [("alm_contact_process", "ALMContactFrictionless"), ("nitsche_contact_process", "NitscheContactFrictionless")];
    for (process, condition) in formulations {
        for (space, second_order) in [(2, false), (2, true), (3, false)] {
            for (gap, approach, clearance) in
                [(0.0, 0.0, -0.01), (0.0, 0.03, 0.01), (0.004, 0.03, 0.01), (0.1, 0.0, -0.02)]
            {
                let blocks =
                    Blocks { space, second_order, gap, approach, clearance: json!(clearance), process, condition };
                let upper = 1.0 + gap - clearance;
                let expected = modulus * (approach - clearance) / (1.0 + upper);
                let found = blocks.pressure();
                let off = (found / expected - 1.0).abs();
                assert!(off < 1e-8, "{condition} in {space}D, {gap} {approach} {clearance}: {found} not {expected}");
            }
        }
    }
}

#[test]
fn a_clearance_without_a_master_is_refused() {
    let blocks = Blocks {
        space: 2,
        second_order: false,
        gap: 2.0,
        approach: 0.0,
        clearance: json!(0.01),
        process: "alm_contact_process",
        condition: "ALMContactFrictionless",
    };
    let folder = blocks.write();
    let path = folder.path().join("ProjectParameters.json");
    let opened = Simulation::open(&path, &RunOptions::default()).and_then(|mut run| run.check(&mut Silent));
    let problem = opened.expect_err("no master").to_string();
    assert!(problem.contains("nothing-to-adjust") && problem.contains("Structure.Master before it"), "{problem}");
}
