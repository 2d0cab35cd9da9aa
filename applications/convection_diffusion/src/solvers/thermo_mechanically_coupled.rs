//! Decks of heat and mechanics: the solver is that of the structure, with heat as an extension of it.

use zelus_core::analysis::{SolverDefinition, SolverEntry};
use zelus_core::diagnostics::Result;
use zelus_core::parameters::{Defaults, Node, Object, Settings, Value};
use zelus_core::register;

use crate::coupling::EXTENSION;
use crate::coupling_settings;
use crate::scheme::SCHEME;

/// Its name.
const SOLVER: &str = "thermo_mechanically_coupled";

/// The object with the settings of the structure.
const STRUCTURE: &str = "structural_solver_settings";

/// Its settings, those of the two solvers within aside.
const DEFAULTS: &str = include_str!("../../../../configs/solvers/thermo_mechanically_coupled.json");

fn with_both(defaults: Defaults) -> Defaults {
    defaults.require(&[STRUCTURE, EXTENSION])
}

/// Makes the structure's settings those of the solver, with the ones of heat inside, and names all parts by the structure's root.
fn unfold(deck: &mut Node) -> Result<()> {
    let solver = deck.require("solver_settings")?;
    let checked = Settings::check(solver, &with_both(Defaults::parse(SOLVER, DEFAULTS)?)).map(|_| ());
    let name = |key: &str, usual: &str| -> Result<String> {
        let named = solver.get(key).and_then(|solver| solver.get("model_part_name"));
        named.map_or(Ok(usual.to_owned()), |named| named.str().map(str::to_owned))
    };
    let (structure, heat) = (name(STRUCTURE, "Structure")?, name(EXTENSION, "ThermalModelPart")?);
    let Value::Object(top) = &mut deck.value else { return checked };
    let Some(Node { value: Value::Object(members), .. }) = top.get_mut("solver_settings") else { return checked };
    let coupling = members.remove(coupling_settings::SETTINGS);
    let (Some(mut own), Some(of_heat)) = (members.remove(STRUCTURE), members.remove(EXTENSION)) else { return checked };
    // Other programs have defaults for it, which apply below the present settings.
    let mut nothing = of_heat.node.clone();
    nothing.value = Value::Object(Object::default());
    own.node.set_path(coupling_settings::SETTINGS, coupling.map_or(nothing, |coupling| coupling.node))?;
    if let Value::Object(members) = &mut own.node.value {
        members.insert(of_heat);
    }
    if let Some(solver) = top.get_mut("solver_settings") {
        *solver = own.node;
    }
    for section in ["processes", "output_processes"] {
        if let Some(lists) = top.get_mut(section) {
            rename(lists, &heat, &structure);
        }
    }
    checked
}

/// Replaces the root of part names in all strings.
fn rename(node: &mut Node, from: &str, to: &str) {
    match &mut node.value {
        Value::String(text) => {
            if let Some(rest) = text.strip_prefix(from).filter(|rest| rest.is_empty() || rest.starts_with('.')) {
                *text = format!("{to}{rest}");
            }
        }
        Value::Array(items) => items.iter_mut().for_each(|item| rename(item, from, to)),
        Value::Object(members) => members.values_mut().for_each(|inner| rename(inner, from, to)),
        _ => {}
    }
}

register! { SolverEntry "thermo_mechanically_coupled",
    aliases: &["ThermoMechanicallyCoupled"],
    about: "heat and mechanics on one mesh, staggered in each step, heat first, until temperatures converge",
    source: "equations of the solvers of heat and of the structure",
    defaults: DEFAULTS,
    build: SolverDefinition {
        scheme: |_| Ok(SCHEME.to_owned()),
        adapt: with_both,
        unfold,
        ..SolverDefinition::PLAIN
    },
}
