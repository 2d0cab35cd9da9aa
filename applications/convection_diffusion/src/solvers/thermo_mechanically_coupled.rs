//! Decks of heat and mechanics: the solver is that of the structure, with heat as an extension of it.

use zelus_core::analysis::{SolverDefinition, SolverEntry};
use zelus_core::diagnostics::{Diagnostic, Result, did_you_mean};
use zelus_core::parameters::{Node, Object, Value};
use zelus_core::register;

use crate::coupling::EXTENSION;
use crate::coupling_settings;
use crate::scheme::SCHEME;

/// The object with the settings of the structure.
const STRUCTURE: &str = "structural_solver_settings";

/// Keys of the solver; those of the two within are theirs.
const KEYS: [&str; 7] = [
    "solver_type",
    "domain_size",
    "echo_level",
    STRUCTURE,
    EXTENSION,
    coupling_settings::SETTINGS,
    "time_integration_method",
];

/// Makes the structure's settings those of the solver, with the ones of heat inside, and names all parts by the structure's root.
fn unfold(deck: &mut Node) -> Result<()> {
    let solver = deck.require("solver_settings")?;
    if let Some(key) = solver.object()?.keys().find(|key| !KEYS.contains(key)) {
        let problem =
            Diagnostic::error("unknown-key", format!("\"{key}\" is not a setting of thermo_mechanically_coupled"));
        let remedy = did_you_mean(key, KEYS).unwrap_or_else(|| format!("there is: {}", KEYS.join(", ")));
        return Err(problem.at(solver.key_place(key)).remedy(remedy).into());
    }
    let name = |key: &str, usual: &str| -> Result<String> {
        let named = solver.require(key)?.get("model_part_name");
        named.map_or(Ok(usual.to_owned()), |named| named.str().map(str::to_owned))
    };
    let (structure, heat) = (name(STRUCTURE, "Structure")?, name(EXTENSION, "ThermalModelPart")?);
    let Value::Object(top) = &mut deck.value else { return Ok(()) };
    let Some(Node { value: Value::Object(members), .. }) = top.get_mut("solver_settings") else { return Ok(()) };
    let coupling = members.remove(coupling_settings::SETTINGS);
    let (Some(mut own), Some(of_heat)) = (members.remove(STRUCTURE), members.remove(EXTENSION)) else { return Ok(()) };
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
    Ok(())
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
    defaults: include_str!("../../../../configs/solvers/thermo_mechanically_coupled.json"),
    build: SolverDefinition {
        scheme: |_| Ok(SCHEME.to_owned()),
        adapt: |defaults| defaults.require(&[STRUCTURE, EXTENSION]),
        unfold,
        ..SolverDefinition::PLAIN
    },
}
