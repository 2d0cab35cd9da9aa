//! `thermal_contact_process`: reads the settings and gives the interaction to the stage.

use zelus_contact_structural_mechanics::FacingSurfaces;
use zelus_core::Result;
use zelus_core::entities::Interaction;
use zelus_core::model::Model;
use zelus_core::parameters::{Interval, Node};
use zelus_core::processes::{Process, ProcessEntry, ProcessRequest, ScalarValue};
use zelus_core::register;
use zelus_core::registry::named;

use crate::interaction::{ThermalContact, ThermalContactSettings};
use crate::law::{ConductanceLaw, ContactConductanceEntry};

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
    let (entry, settings) = named::<ContactConductanceEntry>(node, "law")?;
    (entry.build)(&settings)
}

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let settings = request.settings_with(|defaults| defaults.require(&["model_part_name", "conductance"]))?;
    let laws = settings.items("conductance")?.iter().map(law).collect::<Result<Vec<_>>>()?;
    if laws.is_empty() {
        let problem = settings.error("conductance", "missing-key", "\"conductance\" names no law");
        return Err(problem.remedy("write e.g. [{\"law\": \"constant\", \"conductance\": 1000.0}]").into());
    }
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
    let root = settings.get_str("model_part_name")?.to_owned();
    let across = laws.iter().any(|law| law.acts_apart());
    let thermal = ThermalContactSettings {
        surfaces: FacingSurfaces::new(&settings, request, true, across)?,
        interval: Interval::from_node(settings.get("interval")?)?,
        laws: laws.into(),
        touching: settings.get_positive("touching_gap")?,
        axisymmetric: settings.get_bool("axisymmetric")?,
        friction: settings.get_f64("friction_heat")?,
        across: speed.map(ScalarValue::from_node).transpose()?.map(|speed| (coefficient, speed)),
    };
    Ok(Box::new(ThermalContactProcess { root, interaction: Some(ThermalContact::new(thermal)) }))
}

register! { ProcessEntry "thermal_contact_process",
    about: "heat between bodies that touch or face each other, by laws of conductance",
    source: "∫ h (T₁ − T₂)(δT₁ − δT₂) over mortar pairs",
    defaults: include_str!("../../../configs/processes/thermal_contact_process.json"),
    build: build,
    surfaces: FacingSurfaces::named,
}
