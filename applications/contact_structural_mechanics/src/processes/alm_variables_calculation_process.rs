//! Penalty and scale factor of a part of the deck's choice, estimated as the process of contact does (eq. 4.11).
//!
//! The facets are those of the part, on the sides that the processes of contact give their nodes by the flags SLAVE and MASTER;
//! facets without a side count on both. The processes of contact take the numbers like manual ones.

use std::collections::BTreeMap;

use zelus_core::Result;
use zelus_core::model::{Model, ModelPart};
use zelus_core::parameters::Settings;
use zelus_core::processes::{Process, ProcessEntry, ProcessRequest};
use zelus_core::register;

use crate::flags::{MASTER, SLAVE};
use crate::interface::{AlmParameters, GivenParameters, Interface, Roles, alm_parameters, find_nodal_h, interfaces};

struct Calculation {
    path: String,
    settings: Settings,
    /// Factor of E/h, and ratio of scale factor and penalty.
    factors: [f64; 2],
    computes_penalty: bool,
    computes_scale_factor: bool,
}

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let settings = request.settings_with(|defaults| defaults.require(&["model_part_name"]))?;
    Ok(Box::new(Calculation {
        path: settings.get_str("model_part_name")?.to_owned(),
        factors: [settings.get_f64("stiffness_factor")?, settings.get_f64("penalty_scale_factor")?],
        computes_penalty: settings.get_bool("compute_penalty")?,
        computes_scale_factor: settings.get_bool("compute_scale_factor")?,
        settings,
    }))
}

/// The facets of a part, on the sides of their nodes.
fn facets(part: &mut ModelPart, path: &str) -> Result<Vec<Interface>> {
    let mut found = interfaces(part, &BTreeMap::from([("0".to_owned(), vec![path.to_owned()])]), &BTreeMap::new())?;
    let flags = &part.nodes.flags;
    for facet in found.iter_mut().flat_map(|interface| &mut interface.facets) {
        let all = |flag| facet.nodes.iter().all(|&node| flags.is(flag, node as usize));
        let has_side = facet.nodes.iter().all(|&node| [SLAVE, MASTER].iter().any(|flag| flags.is(flag, node as usize)));
        facet.role = match (all(SLAVE), has_side) {
            (true, _) => Roles::Slave,
            (false, true) => Roles::Master,
            (false, false) => Roles::Open,
        };
    }
    Ok(found)
}

impl Process for Calculation {
    fn initialize(&mut self, model: &mut Model) -> Result<()> {
        let place = self.settings.key_place("model_part_name");
        let part = model.root_mut(&self.path).map_err(|problem| problem.at(&place))?;
        let interfaces = facets(part, &self.path).map_err(|problem| problem.at(&place))?;
        find_nodal_h(part);
        let AlmParameters { penalty, scale_factor } =
            alm_parameters(part, &interfaces, self.factors[0], self.factors[1]);
        let computed = GivenParameters {
            penalty: self.computes_penalty.then_some(penalty),
            scale_factor: self.computes_scale_factor.then_some(scale_factor),
        };
        computed.write(&mut part.info);
        Ok(())
    }

    fn drives(&self, _part: &ModelPart, _system: &zelus_core::assembly::System) -> bool {
        false
    }

    fn finalize(&mut self, model: &mut Model) -> Result<()> {
        GivenParameters::forget(&mut model.root_mut(&self.path)?.info);
        Ok(())
    }
}

register! { ProcessEntry "alm_variables_calculation_process",
    aliases: &["ALMVariablesCalculationProcess"],
    about: "estimates penalty and scale factor of contact from stiffness and mesh size of a part",
    source: "eq. 4.11",
    defaults: include_str!("../../../../configs/processes/alm_variables_calculation_process.json"),
    build: build,
    surfaces: super::touching::estimated,
}
