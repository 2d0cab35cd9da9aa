//! Contact by the augmented Lagrangian: reads the settings and puts the interaction into the model part.

use std::collections::BTreeMap;

use serde::Deserialize;
use zelus_core::Result;
use zelus_core::diagnostics::Diagnostic;
use zelus_core::model::Model;
use zelus_core::parameters::{Interval, Settings};
use zelus_core::processes::{Process, ProcessRequest};
use zelus_core::register;
use zelus_core::registry::Build;

use super::interface_settings::{check_positive, check_search};
use crate::interaction::{AdaptationSettings, ContactInteraction, ContactSettings, FrictionSettings, NormalVariation};
use crate::interface::AlmParameters;
use crate::mortar::IntegrationOrder;
use crate::pairs::find_family;
use crate::search::{GapCheck, SearchSettings};

#[derive(Debug, Deserialize)]
struct Search {
    simple_search: bool,
    search_factor: f64,
    active_check_factor: f64,
    database_step_update: usize,
    normal_orientation_threshold: f64,
    check_gap: GapCheck,
}

#[derive(Debug, Deserialize)]
struct Parameters {
    #[serde(rename = "manual_ALM")]
    manual: bool,
    stiffness_factor: f64,
    penalty_scale_factor: f64,
    use_scale_factor: bool,
    penalty: f64,
    scale_factor: f64,
    adapt_penalty: bool,
    max_gap_factor: f64,
}

#[derive(Debug, Deserialize)]
struct Alternatives {
    axisymmetric: bool,
}

#[derive(Debug, Deserialize)]
struct Whole {
    model_part_name: String,
    contact_model_part: BTreeMap<String, Vec<String>>,
    assume_master_slave: BTreeMap<String, Vec<String>>,
    contact_type: String,
    friction_coefficients: BTreeMap<String, f64>,
    normal_variation: NormalVariation,
    not_normal_update_frictional: bool,
    slip_augmentation_coefficient: f64,
    slip_threshold: f64,
    slip_step_reset_frequency: i64,
    tangent_factor: f64,
    operator_threshold: f64,
    zero_tolerance_factor: f64,
    integration_order: usize,
    search_parameters: Search,
    #[serde(rename = "advance_ALM_parameters")]
    parameters: Parameters,
    alternative_formulations: Alternatives,
}

/// The process; all it does is in its interaction.
pub struct AlmContactProcess {
    root: String,
    interaction: Option<ContactInteraction>,
}

impl AlmContactProcess {
    fn boxed(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
        Self::of_families(request, "ALMContact", 1.0, 1.0)
    }

    /// The process for the families whose names begin with `stem`.
    ///
    /// The estimated penalty is multiplied by `penalty_factor`; `least_penalty` takes its place when it is zero.
    ///
    /// # Errors
    /// Settings that do not fit.
    pub(super) fn of_families(
        request: &mut ProcessRequest<'_>,
        stem: &str,
        penalty_factor: f64,
        least_penalty: f64,
    ) -> Result<Box<dyn Process>> {
        let settings = request.settings()?;
        let family_of = |contact_type: &str| format!("{stem}{contact_type}");
        let (root, interaction) = interaction(&settings, request, &family_of, penalty_factor, least_penalty)?;
        Ok(Box::new(Self { root, interaction: Some(interaction) }))
    }
}

/// The interaction that these settings describe; `family_of` turns the contact type into a `mortar_type`.
pub(super) fn interaction(
    settings: &Settings,
    request: &mut ProcessRequest<'_>,
    family_of: &dyn Fn(&str) -> String,
    penalty_factor: f64,
    least_penalty: f64,
) -> Result<(String, ContactInteraction)> {
    let whole: Whole = settings.parse()?;
    let (stem, updated) = match whole.contact_type.strip_suffix("WithNormalUpdate") {
        Some(stem) => (stem, true),
        None => (whole.contact_type.as_str(), false),
    };
    let family = find_family(&family_of(stem)).map_err(|d| d.at(settings.key_place("contact_type")))?;
    let integration_order = IntegrationOrder::new(whole.integration_order).ok_or_else(|| {
        let fact = format!("\"integration_order\" is {}, it must be 1 to 5", whole.integration_order);
        settings.error("integration_order", "integration-order", fact)
    })?;
    check_positive(
        settings,
        &["advance_ALM_parameters.stiffness_factor", "advance_ALM_parameters.penalty_scale_factor"],
    )?;
    check_search(settings)?;
    let normal_variation = match whole.normal_variation {
        NormalVariation::None if updated || (family.frictional() && !whole.not_normal_update_frictional) => {
            NormalVariation::Update
        }
        other => other,
    };
    let chosen = ContactSettings {
        parts: whole.contact_model_part,
        slaves: whole.assume_master_slave,
        family,
        interval: Interval::from_node(settings.get("interval")?)?,
        normal_variation,
        search: SearchSettings {
            factor: whole.search_parameters.search_factor,
            normal_orientation_threshold: whole.search_parameters.normal_orientation_threshold,
            check: whole.search_parameters.check_gap,
        },
        active_check_factor: whole.search_parameters.active_check_factor,
        simple_search: whole.search_parameters.simple_search,
        database_step_update: whole.search_parameters.database_step_update.max(1),
        manual: whole.parameters.manual.then_some(AlmParameters {
            penalty: whole.parameters.penalty,
            scale_factor: whole.parameters.scale_factor,
        }),
        estimate: [whole.parameters.stiffness_factor, whole.parameters.penalty_scale_factor],
        penalty_factor,
        least_penalty,
        use_scale_factor: whole.parameters.use_scale_factor,
        tangent_factor: whole.tangent_factor,
        operator_threshold: whole.operator_threshold,
        friction: FrictionSettings {
            coefficients: whole.friction_coefficients,
            slip_augmentation: whole.slip_augmentation_coefficient,
            slip_threshold: whole.slip_threshold,
            reset_frequency: usize::try_from(whole.slip_step_reset_frequency).ok().filter(|f| *f > 0),
        },
        adaptation: AdaptationSettings {
            adapt_penalty: whole.parameters.adapt_penalty,
            max_gap_factor: whole.parameters.max_gap_factor,
            dynamic_factor: false,
        },
        zero_tolerance_factor: whole.zero_tolerance_factor,
        integration_order,
        axisymmetric: whole.alternative_formulations.axisymmetric,
    };
    let part = request.model.root_mut(&whole.model_part_name)?;
    check_variables(part, family, settings)?;
    let interaction = ContactInteraction::new(chosen, part)?;
    Ok((whole.model_part_name, interaction))
}

/// The solver gives the nodes the variables of its `mortar_type`; another family's would be missing.
fn check_variables(
    part: &zelus_core::model::ModelPart,
    family: &crate::pairs::Family,
    settings: &Settings,
) -> Result<()> {
    match family.variables.iter().find(|(name, _)| !part.nodes.history.has(name)) {
        None => Ok(()),
        Some((name, _)) => {
            let fact = format!(
                "\"contact_type\" asks for {}, but the solver's \"mortar_type\" brings no {name}",
                family.condition
            );
            Err(settings
                .error("contact_type", "contact-type", fact)
                .remedy("let \"contact_settings.mortar_type\" and \"contact_type\" name the same family")
                .into())
        }
    }
}

impl Process for AlmContactProcess {
    fn initialize(&mut self, model: &mut Model) -> Result<()> {
        let interaction = self.interaction.take().ok_or_else(|| Diagnostic::error("contact", "initialised twice"))?;
        model.root_mut(&self.root)?.interactions.push(Box::new(interaction));
        Ok(())
    }
}

register! { Process "alm_contact_process",
    aliases: &["ALMContactProcess"],
    about: "contact by the augmented Lagrangian method on mortar pairs",
    source: "eqs. 4.9, 4.11, D.11",
    defaults: include_str!("../../../../configs/processes/alm_contact_process.json"),
    build: Build::Process(AlmContactProcess::boxed),
}
