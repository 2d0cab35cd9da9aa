//! Contact and ties by constraints: reads the settings and puts the interaction into the model part.

use std::collections::BTreeMap;

use serde::Deserialize;
use zelus_core::Result;
use zelus_core::parameters::Interval;
use zelus_core::processes::{Process, ProcessEntry, ProcessRequest};
use zelus_core::register;

use super::friction_settings::{check_sliding, friction_law};
use super::interaction_process::InteractionProcess;
use super::interface_settings::{check_analysis, check_search, check_slaves, segmentation, without_computing_part};
use crate::friction::FrictionSettings;
use crate::mpc::{MpcInteraction, MpcKind, MpcSettings, Weights, mpc_contact_type, updates_each_iteration};
use crate::search::{GapCheck, SearchDistance, SearchSettings, WithinStep};
use crate::solver::ContactSolverSettings;

#[derive(Debug, Deserialize)]
struct MpcSearchKeys {
    search_factor: f64,
    database_step_update: usize,
    normal_orientation_threshold: f64,
}

#[derive(Debug, Deserialize)]
struct MpcKeys {
    model_part_name: String,
    contact_model_part: BTreeMap<String, Vec<String>>,
    assume_master_slave: BTreeMap<String, Vec<String>>,
    friction_coefficients: BTreeMap<String, f64>,
    reaction_check_stiffness_factor: f64,
    update_condition_relation_step: bool,
    consistent_weights: bool,
    keep_first_opening: bool,
    swap_held_slaves: bool,
    search_parameters: MpcSearchKeys,
}

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let settings = request.settings_with(without_computing_part)?;
    let whole: MpcKeys = settings.parse()?;
    let (kind, pure_slip) = mpc_contact_type(&settings)?;
    check_search(&settings)?;
    check_slaves(&settings, "contact_model_part", &whole.contact_model_part, &whole.assume_master_slave)?;
    let part = request.model.root_mut(&whole.model_part_name)?;
    if kind != MpcKind::MeshTying {
        check_analysis(&settings, part)?;
    }
    let info = &part.info;
    let (solver, update_each_iteration) = (ContactSolverSettings::of(info), updates_each_iteration(info));
    let law = friction_law(&settings, kind == MpcKind::Frictional, request)?;
    check_sliding(&settings, law, false)?;
    let chosen = MpcSettings {
        parts: whole.contact_model_part,
        slaves: whole.assume_master_slave,
        kind,
        pure_slip,
        friction: FrictionSettings { law, coefficients: whole.friction_coefficients, ..FrictionSettings::default() },
        interval: Interval::from_node(settings.get("interval")?)?,
        search: SearchSettings {
            factor: whole.search_parameters.search_factor,
            distance: SearchDistance::BetweenFacets,
            within_step: WithinStep::Lost,
            normal_orientation_threshold: whole.search_parameters.normal_orientation_threshold,
            check: GapCheck::CheckMapping,
            dynamic: false,
        },
        database_step_update: whole.search_parameters.database_step_update.max(1),
        segmentation: segmentation(&settings)?,
        reaction_check_stiffness_factor: whole.reaction_check_stiffness_factor,
        update_each_iteration,
        update_relations: whole.update_condition_relation_step,
        weights: if whole.consistent_weights || kind == MpcKind::Frictional {
            Weights::Consistent
        } else {
            Weights::ByFacets
        },
        keeps_first_opening: whole.keep_first_opening,
        swaps_held_slaves: whole.swap_held_slaves,
        solver,
    };
    let part = request.model.root_mut(&whole.model_part_name)?;
    let interaction = MpcInteraction::new(chosen, part)?;
    Ok(InteractionProcess::boxed(whole.model_part_name, interaction))
}

register! { ProcessEntry "mpc_contact_process",
    aliases: &["MPCContactProcess"],
    about: "contact and ties by linear constraints that active nodes obey",
    source: "eqs. D.12a–e",
    defaults: include_str!("../../../../configs/processes/mpc_contact_process.json"),
    like: &[("kratos", include_str!("../../../../configs/like_kratos/mpc_contact_process.json"))],
    build: build,
    puts: "contact",
    surfaces: super::touching::contact,
}
