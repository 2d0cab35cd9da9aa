//! Heat of plastic flow: the share TAYLOR_QUINNEY_COEFFICIENT of the plastic work of a step, fed into the elements that have flown.
//!
//! Work is by element, the sum over its Gauss points, and heat spreads evenly over the element; so no work is lost whatever the meshes of both
//! are integrated by. Taylor and Quinney, Proc. R. Soc. A 143 (1934).

use zelus_core::entities::EntityBlock;
use zelus_core::model::ModelPart;
use zelus_core::parallel;
use zelus_structural_mechanics::laws::PLASTIC_WORK;

use crate::adoption::properties_of_heat;
use crate::elements::PLASTIC_HEAT_POWER;

/// Share of plastic work that becomes heat, times the factor to the units of heat, among the properties of heat.
const SHARE: &str = "TAYLOR_QUINNEY_COEFFICIENT";

/// Heat of plastic flow.
pub(crate) struct PlasticHeat {
    /// Whether there is any.
    acts: bool,
}

impl PlasticHeat {
    /// Plastic heat by the materials of heat in a part, which gets its column.
    pub(crate) fn of(part: &mut ModelPart) -> Self {
        let acts =
            part.properties.values().any(|properties| properties.number(SHARE).is_some_and(|share| share != 0.0));
        if acts {
            part.elements.data.add_named(PLASTIC_HEAT_POWER, 1);
        }
        Self { acts }
    }

    /// Whether there is any.
    pub(crate) fn acts(&self) -> bool {
        self.acts
    }

    /// Takes the work of the step that these elements of the structure have just converged to.
    pub(crate) fn take(&self, part: &mut ModelPart, elements: &[Box<dyn EntityBlock>]) {
        if !self.acts {
            return;
        }
        let mut power = vec![0.0; part.elements.len()];
        let view = part.view();
        for block in elements.iter().filter(|block| block.gauss_variables().contains(&PLASTIC_WORK)) {
            let members = block.members();
            let of_element = |at: usize| -> f64 {
                let share = properties_of_heat(part, members[at]).and_then(|properties| properties.number(SHARE));
                let (Some(share), true) = (share, block.is_active(at, &view)) else { return 0.0 };
                let Some(points) = block.gauss(&view, PLASTIC_WORK, at) else { return 0.0 };
                let work: f64 = points.values.iter().zip(&points.weights).map(|(work, weight)| work * weight).sum();
                share * work / part.info.delta_time
            };
            let all: Vec<f64> = parallel::map(members.len(), 64, of_element);
            members.iter().zip(all).for_each(|(&member, own)| power[member as usize] = own);
        }
        part.elements.data.write_level(PLASTIC_HEAT_POWER, 0, &power);
    }
}
