//! `thermal_contact_process`: reads the settings and gives the interaction to the stage.

use std::collections::BTreeMap;

use serde::Deserialize;
use zelus_contact_structural_mechanics::mortar::{IntegrationOrder, SegmentationSettings};
use zelus_contact_structural_mechanics::search::{GapCheck, SearchDistance, SearchSettings, WithinStep};
use zelus_contact_structural_mechanics::{check_slaves, surfaces_by_pair};
use zelus_core::Result;
use zelus_core::entities::Interaction;
use zelus_core::model::Model;
use zelus_core::parameters::{Defaults, Interval, Node, Settings};
use zelus_core::processes::{Process, ProcessEntry, ProcessRequest, ScalarValue};
use zelus_core::register;
use zelus_core::registry::require;

use crate::interaction::{Chosen, ThermalContact};
use crate::law::{ConductanceLaw, ContactConductanceEntry};

#[derive(Debug, Deserialize)]
struct Whole {
    model_part_name: String,
    contact_model_part: BTreeMap<String, Vec<String>>,
    assume_master_slave: BTreeMap<String, Vec<String>>,
    integration_order: usize,
    normal_orientation_threshold: f64,
    axisymmetric: bool,
    friction_heat: f64,
}

struct ThermalContactProcess {
    root: String,
    interaction: Option<ThermalContact>,
}

impl Process for ThermalContactProcess {
    fn interaction(&mut self, _model: &mut Model) -> Result<Option<(String, Box<dyn Interaction>)>> {
        Ok(self.interaction.take().map(|own| (self.root.clone(), Box::new(own) as Box<dyn Interaction>)))
    }
}

/// The law that an object of the settings names.
fn law(node: &Node) -> Result<Box<dyn ConductanceLaw>> {
    let named = node.require("law")?;
    let entry = require::<ContactConductanceEntry>(named.str()?).map_err(|problem| problem.at(named.place()))?;
    let (settings, _) = Settings::check(node, &Defaults::parse(entry.name, entry.defaults)?)?;
    (entry.build)(&settings)
}

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let settings = request.settings_with(|defaults| defaults.require(&["model_part_name", "conductance"]))?;
    let whole: Whole = settings.parse()?;
    check_slaves(&settings, "contact_model_part", &whole.contact_model_part, &whole.assume_master_slave)?;
    let laws = settings.items("conductance")?.iter().map(law).collect::<Result<Vec<_>>>()?;
    if laws.is_empty() {
        let problem = settings.error("conductance", "missing-key", "\"conductance\" names no law");
        return Err(problem.remedy("write e.g. [{\"law\": \"constant\", \"conductance\": 1000.0}]").into());
    }
    let integration_order = IntegrationOrder::new(whole.integration_order).ok_or_else(|| {
        let fact = format!("\"integration_order\" is {}, it must be 1 to 5", whole.integration_order);
        settings.error("integration_order", "integration-order", fact)
    })?;
    let coefficient = settings.get_f64("friction_coefficient")?;
    let speed = Some(settings.get("sliding_speed")?).filter(|speed| speed.is_given());
    if coefficient < 0.0 || (coefficient > 0.0) != speed.is_some() {
        let fact = format!(
            "\"friction_coefficient\" is {coefficient}, \"sliding_speed\" {}",
            if speed.is_some() { "is given" } else { "is not" }
        );
        let problem = settings.error("friction_coefficient", "invalid-value", fact);
        return Err(problem.remedy("give both, for sliding across the model, or neither").into());
    }
    let chosen = Chosen {
        parts: whole.contact_model_part,
        slaves: whole.assume_master_slave,
        interval: Interval::from_node(settings.get("interval")?)?,
        laws: laws.into(),
        search: SearchSettings {
            factor: settings.get_positive("search_factor")?,
            distance: SearchDistance::BetweenFacets,
            within_step: WithinStep::Lost,
            normal_orientation_threshold: whole.normal_orientation_threshold,
            check: GapCheck::CheckMapping,
            dynamic: false,
        },
        segmentation: SegmentationSettings { integration_order, slivers: true, ..SegmentationSettings::default() },
        touching: settings.get_positive("touching_gap")?,
        axisymmetric: whole.axisymmetric,
        friction: whole.friction_heat,
        across: speed.map(ScalarValue::from_node).transpose()?.map(|speed| (coefficient, speed)),
    };
    let part = request.model.root_mut(&whole.model_part_name)?;
    let interaction = ThermalContact::new(chosen, part)?;
    Ok(Box::new(ThermalContactProcess { root: whole.model_part_name, interaction: Some(interaction) }))
}

register! { ProcessEntry "thermal_contact_process",
    about: "heat between bodies that touch or face each other, by laws of conductance",
    source: "∫ h (T₁ − T₂)(δT₁ − δT₂) over mortar pairs",
    defaults: include_str!("../../../configs/processes/thermal_contact_process.json"),
    build: build,
    surfaces: |parameters| surfaces_by_pair(parameters, "contact_model_part"),
}
