//! Ties meshes that do not match: reads the settings and puts the interaction into the model part.

use std::collections::BTreeMap;

use serde::Deserialize;
use zelus_core::Result;
use zelus_core::model::{ModelPart, Named, Rates, ScalarVariable, VariableKind, named};
use zelus_core::parameters::{Interval, Settings};
use zelus_core::processes::{Process, ProcessEntry, ProcessRequest};
use zelus_core::register;

use super::interaction_process::InteractionProcess;
use super::interface_settings::{check_search, check_slaves, segmentation, without_computing_part};
use crate::pairs::find_tying_formulation;
use crate::search::{GapCheck, SearchDistance, SearchSettings, WithinStep};
use crate::solver::ContactSolverSettings;
use crate::tying::{TyingInteraction, TyingSettings};

#[derive(Debug, Deserialize)]
struct TyingSearchKeys {
    search_factor: f64,
    database_step_update: usize,
    normal_orientation_threshold: f64,
}

#[derive(Debug, Deserialize)]
struct ScaleFactorKeys {
    manual_scale_factor: bool,
    stiffness_factor: f64,
    scale_factor: f64,
}

#[derive(Debug, Deserialize)]
struct TyingKeys {
    model_part_name: String,
    mesh_tying_model_part: BTreeMap<String, Vec<String>>,
    assume_master_slave: BTreeMap<String, Vec<String>>,
    search_parameters: TyingSearchKeys,
    scale_factor_parameters: ScaleFactorKeys,
    mind_supports: bool,
}

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let settings = request.settings_with(without_computing_part)?;
    let whole: TyingKeys = settings.parse()?;
    check_search(&settings)?;
    check_slaves(&settings, "mesh_tying_model_part", &whole.mesh_tying_model_part, &whole.assume_master_slave)?;
    let part = request.model.root_mut(&whole.model_part_name)?;
    let (mortar_type, tied) = tied(&settings, part.info.domain_size)?;
    let Some(first) = tied.first() else {
        let fact = format!("a model of {} dimensions has no components to tie", part.info.domain_size);
        return Err(settings.error("variable_name", "tied-variable", fact).remedy("mend \"domain_size\" first").into());
    };
    check_unknown(&settings, part, *first)?;
    let formulation = find_tying_formulation(mortar_type)?;
    for (name, components) in formulation.variables {
        part.nodes.history.add_named(name, *components);
    }
    let manual = &whole.scale_factor_parameters;
    let chosen = TyingSettings {
        parts: whole.mesh_tying_model_part,
        slaves: whole.assume_master_slave,
        formulation,
        tied,
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
        manual: manual.manual_scale_factor.then_some(manual.scale_factor),
        stiffness_factor: manual.stiffness_factor,
        mind_supports: whole.mind_supports,
        feature_angle: ContactSolverSettings::of(&part.info).feature_angle,
    };
    let interaction = TyingInteraction::new(chosen, part)?;
    Ok(InteractionProcess::boxed(whole.model_part_name, interaction))
}

/// The `mortar_type` that `"variable_name"` needs, and the numbers it stands for.
fn tied(settings: &Settings, dimension: usize) -> Result<(&'static str, Vec<ScalarVariable>)> {
    let name = settings.get_str("variable_name")?;
    match named(name) {
        Some(Named::Component(variable)) => Ok(("ScalarMeshTying", vec![variable])),
        Some(Named::Whole(column, VariableKind::Scalar)) => {
            Ok(("ScalarMeshTying", vec![ScalarVariable { column, component: None }]))
        }
        Some(Named::Whole(column, VariableKind::Vector3)) => {
            let components = (0..dimension as u8).map(|c| ScalarVariable { column, component: Some(c) });
            Ok(("ComponentsMeshTying", components.collect()))
        }
        _ => Err(settings
            .error("variable_name", "unknown-variable", format!("{name:?} is no variable of nodes"))
            .remedy("tie a vector, e.g. \"DISPLACEMENT\", or a scalar or component")
            .into()),
    }
}

/// Refuses variables that no equation of the part solves for.
fn check_unknown(settings: &Settings, part: &ModelPart, tied: ScalarVariable) -> Result<()> {
    if Rates::of(tied.column).is_some() && part.nodes.history.has(tied.column) {
        return Ok(());
    }
    let unknowns: Vec<&str> = Rates::within(&part.nodes.history).iter().map(|(rates, _)| rates.unknown).collect();
    let fact = format!("{:?} is no unknown of model part {:?}: it cannot be tied", tied.column, part.name);
    let remedy = format!("tie {}", unknowns.join(" or "));
    Err(settings.error("variable_name", "tied-variable", fact).remedy(remedy).into())
}

register! { ProcessEntry "mesh_tying_process",
    aliases: &["MeshTyingProcess"],
    about: "ties meshes that do not match by multipliers on mortar pairs",
    source: "eqs. D.5, D.7 of an equality; D and M: Wohlmuth (2000)",
    defaults: include_str!("../../../../configs/processes/mesh_tying_process.json"),
    like: &[("kratos", include_str!("../../../../configs/like_kratos/mesh_tying_process.json"))],
    build: build,
    puts: "a tie",
    surfaces: super::touching::ties,
}
