//! `contact_settings` of the solver: the formulation decides which variables the nodes carry.

use zelus_core::analysis::{Cutting, ExtensionDefinition, SolverExtensionEntry};
use zelus_core::model::{MultiplierRequest, ProcessInfo};
use zelus_core::parameters::Settings;
use zelus_core::strategies::{OFF_NODE_TOLERANCE, ZERO_ROW_TOLERANCE};
use zelus_core::{Result, register};

use crate::interface::FEATURE_ANGLE;
use crate::pairs::variables_of;

/// No node in contact is an error.
const ENSURE_CONTACT: &str = "ENSURE_CONTACT";
/// Contact forces are scaled in the step in which a gap closes.
const COMPUTE_DYNAMIC_FACTOR: &str = "COMPUTE_DYNAMIC_FACTOR";
/// Share of the energy of motion that a step may make or lose where contact closes or opens.
const IMPACT_TOLERANCE: &str = "IMPACT_TOLERANCE";
/// Slave nodes on sharp edges have the mean normal of their faces.
const AVERAGED_EDGES: &str = "AVERAGED_EDGES";
/// Angle between the normals of two slave facets, in degrees, at which their patch ends.
const CONTACT_FEATURE_ANGLE: &str = "CONTACT_FEATURE_ANGLE";
/// Nodes of contact keep their mass in motion.
const KEEP_MASS: &str = "KEEP_MASS";
/// Share of the energy of motion that contact may make before a step is refused; 0: any.
const LARGEST_ENERGY_GAIN: &str = "LARGEST_ENERGY_GAIN";
/// Depth of a node in contact, in mesh sizes, beyond which no state is accepted; 0: any.
const LARGEST_PENETRATION: &str = "LARGEST_PENETRATION";
/// Slave nodes begin on their masters.
const ADJUST_INITIAL: &str = "ADJUST_INITIAL";
/// Distance, in mesh sizes, from which they are moved there.
const ADJUST_TOLERANCE: &str = "ADJUST_TOLERANCE";
/// Factor of explicit steps while there is contact.
const DELTA_TIME_FACTOR: &str = "DELTA_TIME_FACTOR_FOR_CONTACT";

/// `contact_settings` of the solver, as contact takes them.
///
/// The solver writes them into the step data, since ranks share a model part and not a deck. [`ContactSolverSettings::of`] is the only
/// place that reads them there.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactSolverSettings {
    /// Whether a step without a node in contact is an error.
    pub ensures_contact: bool,
    /// Whether contact forces are scaled in the step in which a gap closes.
    pub dynamic_factor: bool,
    /// Whether nodes of contact keep their mass in motion.
    pub keeps_mass: bool,
    /// Share of the energy of motion that a step may make or lose where contact closes or opens; 0: any.
    pub impact_tolerance: f64,
    /// Share of the energy of motion that contact may make before a step is refused; 0: any.
    pub largest_energy_gain: f64,
    /// Depth of a node in contact, in mesh sizes, beyond which no state is accepted; 0: any.
    pub largest_penetration: f64,
    /// Distance, in mesh sizes, from which slave nodes are moved onto their masters before the first step; `None` moves none.
    pub adjust_tolerance: Option<f64>,
    /// Angle between the normals of two slave facets, in degrees, at which their patch ends; `None` where all facets at a node share
    /// its normal, as in Kratos.
    pub feature_angle: Option<f64>,
    /// Factor of explicit steps while there is contact.
    pub delta_time_factor: f64,
}

impl ContactSolverSettings {
    /// The settings that a solver has written into the step data; without `contact_settings` no state is refused.
    pub fn of(info: &ProcessInfo) -> Self {
        let share = |name| info.value_or(name, 0.0);
        Self {
            ensures_contact: info.is(ENSURE_CONTACT),
            dynamic_factor: info.is(COMPUTE_DYNAMIC_FACTOR),
            keeps_mass: info.is(KEEP_MASS),
            impact_tolerance: share(IMPACT_TOLERANCE),
            largest_energy_gain: share(LARGEST_ENERGY_GAIN),
            largest_penetration: share(LARGEST_PENETRATION),
            adjust_tolerance: info.is(ADJUST_INITIAL).then(|| share(ADJUST_TOLERANCE)),
            feature_angle: (!info.is(AVERAGED_EDGES)).then(|| info.value_or(CONTACT_FEATURE_ANGLE, FEATURE_ANGLE)),
            delta_time_factor: info.value_or(DELTA_TIME_FACTOR, 1.0),
        }
    }
}

/// Numbers of the settings for impacts, with their names in the step data.
pub(crate) const IMPACT_NUMBERS: [(&str, &str); 2] =
    [("impact_energy_tolerance", IMPACT_TOLERANCE), ("largest_energy_gain", LARGEST_ENERGY_GAIN)];

/// The marks of `contact_stabilisation` and `edge_normals`.
///
/// # Errors
/// Other words than theirs.
pub(crate) fn marks_of_words(settings: &Settings) -> Result<Vec<&'static str>> {
    let mut marks = Vec::new();
    for (key, usual, other, mark) in [
        ("contact_stabilisation", "mass_redistribution", "none", KEEP_MASS),
        ("edge_normals", "of_master", "averaged", AVERAGED_EDGES),
    ] {
        match settings.get_str(key)? {
            word if word == usual => {}
            word if word == other => marks.push(mark),
            word => {
                let problem = settings.error(key, "invalid-value", format!("\"{key}\" is {word:?}"));
                return Err(problem.remedy(format!("use {usual:?} or {other:?}")).into());
            }
        }
    }
    Ok(marks)
}

register! { SolverExtensionEntry "contact_settings",
    about: "settings of contact at the solver",
    defaults: include_str!("../../../../configs/solvers/contact_settings.json"),
    like: &[("kratos", include_str!("../../../../configs/like_kratos/contact_settings.json"))],
    build: ExtensionDefinition {
        variables: |settings| {
            let mortar_type = settings.get_str("mortar_type")?;
            if mortar_type.is_empty() {
                return Ok(Vec::new());
            }
            let variables = variables_of(mortar_type).map_err(|d| d.at(settings.key_place("mortar_type")))?;
            Ok(variables.to_vec())
        },
        marks: |settings| {
            let mut marks = marks_of_words(settings)?;
            for (key, mark) in [
                ("ensure_contact", ENSURE_CONTACT),
                ("adjust_initial", ADJUST_INITIAL),
                ("compute_dynamic_factor", COMPUTE_DYNAMIC_FACTOR),
            ] {
                if settings.get_bool(key)? {
                    marks.push(mark);
                }
            }
            Ok(marks)
        },
        condition_number: |settings| settings.get_bool("condn_convergence_criterion"),
        multipliers: |settings| {
            let condense = settings.get_bool("use_mixed_ulm_solver")?;
            let only_condensed = !settings.get_bool("fallback_if_dual_lm_not_valid")?;
            Ok(MultiplierRequest { condense, keep: !condense, only_condensed })
        },
        cutting: |settings| {
            if !settings.get_bool("adaptative_strategy")? {
                return Ok(None);
            }
            let factor = settings.get_f64("split_factor")?;
            Ok(Some(Cutting { factor, times: settings.get_usize("max_number_splits")? as u32 }))
        },
        values: |settings| {
            let keys = [
                ("delta_time_factor_for_contact", DELTA_TIME_FACTOR),
                ("largest_penetration", LARGEST_PENETRATION),
                ("adjust_tolerance", ADJUST_TOLERANCE),
                ("feature_angle", CONTACT_FEATURE_ANGLE),
                ("mixed_ulm_solver_parameters.dual_lm_off_node_tolerance", OFF_NODE_TOLERANCE),
                ("mixed_ulm_solver_parameters.dual_lm_zero_row_tolerance", ZERO_ROW_TOLERANCE),
            ];
            let numbers = keys.into_iter().chain(IMPACT_NUMBERS);
            numbers.map(|(key, name)| Ok((name, settings.get_f64(key)?))).collect()
        },
        ..ExtensionDefinition::NOTHING
    },
}
