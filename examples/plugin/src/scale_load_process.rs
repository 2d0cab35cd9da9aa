//! Multiplies a vector variable of the conditions of a part by a factor, at the beginning of each step.
//!
//! List it after the process that sets the load: that one sets it anew in each step.

use zelus_core::diagnostics::Place;
use zelus_core::model::{Model, Named, VariableKind, named};
use zelus_core::parameters::SpaceTime;
use zelus_core::processes::{Process, ProcessEntry, ProcessRequest, ScalarValue, Target};
use zelus_core::register;
use zelus_core::{Result, diagnostics::Diagnostic};

/// Defaults, with what each key means; `zelus describe scale_load_process` prints them.
const DEFAULTS: &str = r#"// Multiplies a load by a factor.
{
    "model_part_name": "", // full path of the part whose conditions carry the load; must be given
    "variable_name": "LINE_LOAD", // vector variable of the conditions
    "factor": null, // number or function of t as a string; must be given
    "interval": [0.0, "End"] // times at which the process acts
}"#;

struct ScaleLoad {
    target: Target,
    variable: &'static str,
    place: Place,
    factor: ScalarValue,
}

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let settings = request.settings_with(|defaults| defaults.require(&["model_part_name", "factor"]))?;
    let name = settings.get_str("variable_name")?;
    let Some(Named::Whole(variable, VariableKind::Vector3)) = named(name) else {
        let problem =
            settings.error("variable_name", "unknown-variable", format!("there is no vector variable {name:?}"));
        return Err(problem.remedy("`zelus list variable` shows what there is").into());
    };
    Ok(Box::new(ScaleLoad {
        target: Target::new(&settings, request.model)?,
        variable,
        place: settings.key_place("variable_name"),
        factor: ScalarValue::from_node(settings.get("factor")?)?,
    }))
}

impl Process for ScaleLoad {
    fn begin_step(&mut self, model: &mut Model) -> Result<()> {
        let part = model.root_mut(&self.target.path)?;
        let time = part.info.time;
        if !self.target.interval.contains(time) {
            return Ok(());
        }
        let factor = self.factor.value(&SpaceTime { time, ..SpaceTime::default() });
        let selected = part.part(&self.target.path)?.conditions.clone();
        let Some(field) = part.conditions.data.get_mut(self.variable) else {
            let fact = format!("nothing has set {} on conditions", self.variable);
            let remedy = "list this process after the one that sets the load";
            return Err(Diagnostic::error("no-load", fact).at(self.place.clone()).remedy(remedy).into());
        };
        for at in selected {
            let at = 3 * at as usize;
            field.levels[0][at..at + 3].iter_mut().for_each(|component| *component *= factor);
        }
        Ok(())
    }
}

register! { ProcessEntry "scale_load_process",
    about: "multiplies a load of conditions by a factor",
    defaults: DEFAULTS,
    build: build,
}
