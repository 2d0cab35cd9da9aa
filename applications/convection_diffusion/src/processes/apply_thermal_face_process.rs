//! Lets the faces of a part exchange heat with their surroundings, by convection and radiation.
//!
//! Coefficients are data of the conditions, in the place of those that their properties give.

use zelus_core::diagnostics::Result;
use zelus_core::model::{Model, Properties};
use zelus_core::parameters::SpaceTime;
use zelus_core::processes::{Process, ProcessEntry, ProcessRequest, ScalarValue, Target};
use zelus_core::register;

use crate::conditions::DATA;

struct ApplyThermalFace {
    target: Target,
    /// Convection coefficient and emissivity.
    coefficients: [f64; 2],
    ambient: ScalarValue,
}

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let settings = request.settings_with(|defaults| defaults.require(&["model_part_name"]))?;
    let coefficient = |switch: &str, key: &str| -> Result<f64> {
        let value = settings.get_f64(key)?;
        if value < 0.0 {
            let problem = settings.error(key, "invalid-value", format!("\"{key}\" is {value}"));
            return Err(problem.remedy("write a number that is not negative").into());
        }
        Ok(if settings.get_bool(switch)? { value } else { 0.0 })
    };
    Ok(Box::new(ApplyThermalFace {
        coefficients: [
            coefficient("add_ambient_convection", "convection_coefficient")?,
            coefficient("add_ambient_radiation", "emissivity")?,
        ],
        ambient: ScalarValue::from_node(settings.get("ambient_temperature")?)?,
        target: Target::new(&settings, request.model)?,
    }))
}

impl ApplyThermalFace {
    fn apply(&self, model: &mut Model) -> Result<()> {
        let part = model.root_mut(&self.target.path)?;
        let time = part.info.time;
        let faces = part.part(&self.target.path)?.conditions.clone();
        let acts = self.target.interval.contains(time);
        let ambient = self.ambient.value(&SpaceTime { time, ..SpaceTime::default() });
        let [convection, emissivity] = if acts { self.coefficients } else { [0.0; 2] };
        for (name, value) in DATA.into_iter().zip([convection, emissivity, ambient]) {
            part.conditions.data.add_named(name, 1);
            let field = part.conditions.data.get_mut(name).expect("just added");
            faces.iter().for_each(|&at| field.levels[0][at as usize] = value);
        }
        Ok(())
    }
}

impl Process for ApplyThermalFace {
    /// Surroundings that the process gives replace those of materials.
    fn initialize(&mut self, model: &mut Model) -> Result<()> {
        let part = model.root_mut(&self.target.path)?;
        let mut own: Vec<[usize; 2]> = Vec::new();
        for at in part.part(&self.target.path)?.conditions.clone() {
            let given = part.conditions.properties[at as usize];
            let says = |properties: &Properties| DATA.iter().any(|name| properties.values.contains_key(*name));
            if !part.properties.get(&given).is_some_and(says) && part.properties.contains_key(&given) {
                continue;
            }
            let id = match own.iter().find(|[from, _]| *from == given) {
                Some([_, id]) => *id,
                None => {
                    let id = part.properties.keys().max().map_or(1, |last| last + 1);
                    let mut new = part.properties.get(&given).cloned().unwrap_or_default();
                    new.id = id;
                    DATA.iter().for_each(|name| drop(new.values.remove(*name)));
                    part.properties.insert(id, new);
                    own.push([given, id]);
                    id
                }
            };
            part.conditions.properties[at as usize] = id;
        }
        Ok(())
    }

    fn before_loop(&mut self, model: &mut Model) -> Result<()> {
        self.apply(model)
    }

    fn begin_step(&mut self, model: &mut Model) -> Result<()> {
        self.apply(model)
    }
}

register! { ProcessEntry "apply_thermal_face_process",
    aliases: &["ApplyThermalFaceProcess"],
    about: "lets faces exchange heat with their surroundings: convection, radiation",
    source: "q = h (Tₐ − T) + ε σ (Tₐ⁴ − T⁴)",
    defaults: include_str!("../../../../configs/processes/apply_thermal_face_process.json"),
    build: build,
}
