//! The stiffest penalty that explicit steps carry.
//!
//! Springs ε A of the slave nodes add to ω² of the bodies at most 2 ε max a/m over the nodes of the interfaces, with the area a of
//! their facets that is a node's and its mass m: (B x)² ≤ ‖B‖₁ Σ |B_i| x_i² for the operator B of a node, whose entries add up to
//! its area on either side. Steps Δt are stable below ω² = 4/Δt², of which the bodies take 4/Δt_c².

use serde::{Deserialize, Serialize};
use zelus_core::diagnostics::Diagnostic;
use zelus_core::geometry::parts;
use zelus_core::model::ModelPart;
use zelus_core::strategies::CRITICAL_STEP;
use zelus_structural_mechanics::variables::{DISPLACEMENT, NODAL_MASS};

use crate::flags::CONTACT;
use crate::interface::Interface;
use crate::slave_nodes::SlaveStates;
use crate::variables::INITIAL_PENALTY;

/// Share of ω² that contact has even where bodies leave it less: longer steps are warned of anyway.
const LEAST: f64 = 0.05;

/// Loads of the nodes that limit the penalty of explicit steps.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(crate) struct StablePenalty {
    /// Largest a/m and area a of the nodes that move (area by mass, area).
    load: Option<[f64; 2]>,
    said: bool,
}

impl StablePenalty {
    /// Step start: lowers the penalty of all nodes to one that is stable for the step, and never raises it: a spring that stiffens
    /// under load makes energy. A penalty that is `given`, or `weighted` and so by area, stays, with a warning.
    ///
    /// `revolution` is the area of a facet by length and radius where the plane is rotated, `stiffened` the factor by which the
    /// penalty grows with the gap, `delta_time_factor` that of steps with contact.
    pub(crate) fn begin_step(
        &mut self,
        part: &mut ModelPart,
        states: &mut SlaveStates,
        interfaces: &[Interface],
        revolution: Option<f64>,
        stiffened: f64,
        given: bool,
        weighted: bool,
        delta_time_factor: f64,
    ) -> Option<Diagnostic> {
        let [load, area] = *self.load.get_or_insert_with(|| load(part, interfaces, revolution));
        let factor = if part.info.is(CONTACT) { 1.0 } else { delta_time_factor };
        let step = part.info.delta_time * factor;
        let critical = part.info.value_or(CRITICAL_STEP, f64::INFINITY);
        let square = 4.0 / (step * step) * (1.0 - (step / critical).powi(2)).max(LEAST);
        let most = square / (2.0 * load * stiffened) / if weighted { area } else { 1.0 };
        let penalty = part.info.value_or(INITIAL_PENALTY.name(), 0.0);
        if penalty <= most {
            return None;
        }
        let fixed = given || weighted;
        if !fixed {
            part.info.values.insert(INITIAL_PENALTY.name(), most);
            states.for_all(|state| state.parameters.penalty = state.parameters.penalty.min(most));
        }
        let says = !std::mem::replace(&mut self.said, true);
        says.then(|| if fixed { warn(step, penalty, most) } else { note(step, penalty, most) })
    }
}

fn warn(step: f64, penalty: f64, most: f64) -> Diagnostic {
    let fact = format!("steps of {step:.3e} are stable up to a penalty of {most:.3e}, and it is {penalty:.3e}");
    Diagnostic::warning("contact-step", fact).remedy(
        "the motion can grow without bound while there is contact: shorten \"time_step\", or leave the penalty to the estimate",
    )
}

fn note(step: f64, penalty: f64, most: f64) -> Diagnostic {
    let fact = format!(
        "the penalty is lowered from {penalty:.3e} to {most:.3e}, the largest stable one for steps of {step:.3e}"
    );
    Diagnostic::note("contact-step", fact)
}

/// Largest a/m of the nodes of the interfaces that can move, and their largest area.
fn load(part: &ModelPart, interfaces: &[Interface], revolution: Option<f64>) -> [f64; 2] {
    let mut areas = vec![0.0; part.nodes.len()];
    for facet in interfaces.iter().flat_map(|interface| &interface.facets) {
        let size = facet.size(part);
        let ring = |node: u32| revolution.map_or(1.0, |factor| factor * part.nodes.current[node as usize][0].abs());
        for (local, &node) in facet.nodes.iter().enumerate() {
            areas[node as usize] += size / parts(facet.shape, local) * ring(node);
        }
    }
    let masses = part.nodes.values.values(&NODAL_MASS, 0);
    let dimension = part.info.domain_size as u8;
    let moves = |at: &usize| (0..dimension).any(|c| !part.nodes.is_fixed(DISPLACEMENT.component(c), *at as u32));
    let nodes = (0..areas.len()).filter(|&at| areas[at] > 0.0 && masses[at] > 0.0).filter(moves);
    nodes.fold([0.0, 0.0], |[load, area], at| [f64::max(load, areas[at] / masses[at]), f64::max(area, areas[at])])
}
