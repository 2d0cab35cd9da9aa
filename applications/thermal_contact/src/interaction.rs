//! Heat between the bodies of a part: facets that face each other are looked for when a step begins.

use std::f64::consts::TAU;
use std::sync::Arc;

use zelus_contact_structural_mechanics::interface::Facet;
use zelus_contact_structural_mechanics::mortar::condition_name;
use zelus_contact_structural_mechanics::pairs::{FacingPoint, PairKey, group_by_shapes};
use zelus_contact_structural_mechanics::variables::{
    CONTACT_GAP, CONTACT_PRESSURE, CONTACT_SLIP, CONTACT_STATUS, CONTACT_TRACTION,
};
use zelus_contact_structural_mechanics::{FacingPair, FacingSurfaces, register_pair_conditions};
use zelus_convection_diffusion::adoption::properties_of_heat;
use zelus_convection_diffusion::columns::Columns;
use zelus_convection_diffusion::coupling::EXTENSION;
use zelus_convection_diffusion::elements::radial;
use zelus_core::Result;
use zelus_core::diagnostics::Diagnostic;
use zelus_core::entities::{Coupling, EntityBlock, Interaction, require_kind};
use zelus_core::model::{EntityRole, ModelPart};
use zelus_core::parameters::{Interval, SpaceTime};
use zelus_core::processes::ScalarValue;
use zelus_core::vector3::dot;

use crate::block::{ConductanceBlock, Point};
use crate::law::{ConductanceLaw, ContactPoint};

/// Name of the interaction.
const NAME: &str = "thermal contact";
/// Conditions of the pairs, without their shapes.
const STEM: &str = "ContactConductanceCondition";

register_pair_conditions! { "ContactConductanceCondition",
    about: "heat between two facets that face each other",
    source: "∫ h (T₁ − T₂)(δT₁ − δT₂) over mortar pairs"
}

/// Settings of a deck.
pub struct ThermalContactSettings {
    /// Between which surfaces.
    pub surfaces: FacingSurfaces,
    /// Times in which heat passes.
    pub interval: Interval,
    /// The laws whose sum is the conductance.
    pub laws: Arc<[Box<dyn ConductanceLaw>]>,
    /// Share of a slave facet's size up to which a gap is none where no contact is computed.
    pub touching: f64,
    /// Whether bodies are of revolution, about the axis that heat has.
    pub axisymmetric: bool,
    /// Heat of friction: its share times the factor from units of work to units of heat.
    pub friction: f64,
    /// Sliding across the motion of the model: the coefficient of friction, and the speed (length per time).
    pub across: Option<(f64, ScalarValue)>,
}

/// Heat between the bodies of a part.
pub struct ThermalContact {
    settings: ThermalContactSettings,
    blocks: Vec<ConductanceBlock>,
    keys: Vec<PairKey>,
    graph: u64,
    has_acted: bool,
}

impl ThermalContact {
    /// As chosen, of which nothing has been looked for yet.
    pub fn new(settings: ThermalContactSettings) -> Self {
        Self { settings, blocks: Vec::new(), keys: Vec::new(), graph: 1, has_acted: false }
    }

    /// The points of two facets at which heat passes.
    fn points(&self, part: &ModelPart, pair: &FacingPair<'_, '_>) -> Vec<Point> {
        let [slave, master] = pair.facets;
        let status = part.nodes.values.values(&CONTACT_STATUS, 0);
        let is_computed =
            slave.nodes.iter().all(|&node| status.get(node as usize).is_some_and(|status| *status >= 0.0));
        let [pressures, gaps] = [&CONTACT_PRESSURE, &CONTACT_GAP].map(|variable| part.nodes.values.values(variable, 0));
        let acts_apart = self.settings.laws.iter().any(|law| law.acts_apart());
        let size = slave.extent(part);
        let work = work_of_friction(part);
        let share = share_of_slave(part, pair.facets);
        let point = |found: FacingPoint| {
            let sum = |of: &dyn Fn(usize) -> f64| -> f64 {
                slave.nodes.iter().zip(&found.slave).map(|(&node, n)| n * of(node as usize)).sum()
            };
            let (touches, pressure, gap) = if is_computed {
                // Contact decides: nodes in contact may still be apart while it iterates.
                let touches = sum(&|node| f64::from(u8::from(status[node] > 0.0))) > 0.0;
                (touches, sum(&|node| pressures[node]), if touches { sum(&|node| gaps[node]) } else { found.gap })
            } else {
                let touches = found.gap <= self.settings.touching * size;
                (touches, 0.0, if touches { 0.0 } else { found.gap })
            };
            let [masters, slaves] =
                [(&found.master, master), (&found.slave, slave)].map(|(n, of)| &n[..of.nodes.len()]);
            let (round, opposite) = if self.settings.axisymmetric {
                let radius = found.position[radial(&part.info)];
                let place = |&node: &u32| part.nodes.current[node as usize][radial(&part.info)];
                let of_master: f64 = master.nodes.iter().map(place).zip(masters).map(|(r, n)| n * r).sum();
                (TAU * radius, if radius > 0.0 { of_master / radius } else { 1.0 })
            } else {
                (1.0, 1.0)
            };
            let (mean, of_master) = if touches { (1.0, 1.0) } else { areas_of_gap(found.spread, opposite) };
            let areas = [1.0 / mean, of_master / mean];
            let contact = ContactPoint { pressure: pressure.max(0.0), gap: gap.max(0.0), touches, areas };
            let work = if is_computed { sum(&work) } else { 0.0 };
            let across = self.settings.across.as_ref().map_or(0.0, |(coefficient, speed)| {
                let here = SpaceTime { current: found.position, initial: found.position, time: part.info.time };
                coefficient * contact.pressure * speed.value(&here).abs()
            });
            let power = self.settings.friction * (work / part.info.delta_time + across);
            (touches || acts_apart).then(|| Point {
                n: [masters, slaves].concat(),
                weight: found.weight * round * mean,
                contact,
                friction: [share * power, (1.0 - share) * power],
            })
        };
        pair.points().into_iter().filter_map(point).collect()
    }

    /// All pairs between which heat passes now.
    fn pairs(&self, part: &ModelPart) -> Vec<(PairKey, Vec<Point>)> {
        let of_pair = |pair: FacingPair<'_, '_>| {
            let points = self.points(part, &pair);
            (!points.is_empty()).then_some((pair.key, points))
        };
        let surfaces = &self.settings.surfaces;
        (0..surfaces.interfaces().len()).flat_map(|at| surfaces.of_pairs(part, at, of_pair)).collect()
    }
}

/// Points and weights of the mean along a gap.
const GAUSS: [[f64; 2]; 3] =
    [[0.112_701_665_379_258_3, 5.0 / 18.0], [0.5, 8.0 / 18.0], [0.887_298_334_620_741_7, 5.0 / 18.0]];
/// Least share of the slave's area that a gap narrows to.
const NARROWEST: f64 = 0.05;

/// The area through which heat passes a gap, and that of the master, in that of the slave: 1/∫ ds/A over the way, which is exact for
/// cylinders and spheres. `spread` is that of [`FacingPoint`]; `opposite` is the radius at the master in that at the slave.
fn areas_of_gap([half, full]: [f64; 2], opposite: f64) -> (f64, f64) {
    let (slope, bend) = (4.0 * half - full - 3.0, 2.0 * (1.0 + full - 2.0 * half));
    let area = |s: f64| ((1.0 + s * (slope + s * bend)) * (1.0 + s * (opposite - 1.0))).max(NARROWEST);
    let resistance: f64 = GAUSS.iter().map(|[s, weight]| weight / area(*s)).sum();
    (1.0 / resistance, area(1.0))
}

/// The work that friction has done on a slave node in the last step (force times way per area).
fn work_of_friction(part: &ModelPart) -> impl Fn(usize) -> f64 {
    let values = |all: &'_ [f64], node: usize| match all.get(3 * node..) {
        Some(&[x, y, z, ..]) => [x, y, z],
        _ => [0.0; 3],
    };
    let slips = part.nodes.values.values(&CONTACT_SLIP, 0);
    let tractions = part.nodes.values.values(&CONTACT_TRACTION, 0);
    move |node| dot(values(slips, node), values(tractions, node)).abs()
}

/// The share of the heat of friction that enters the slave: by the effusivities √(kρc) of both bodies, half where one has none.
fn share_of_slave(part: &ModelPart, facets: [&Facet; 2]) -> f64 {
    let columns = Columns::of(part);
    let effusivity = |facet: &Facet| -> Option<f64> {
        let properties = properties_of_heat(part, facet.element).filter(|_| !facet.is_rigid())?;
        let number = |column: Option<&'static str>| column.map_or(Some(1.0), |name| properties.number(name));
        let product = number(columns.diffusion)? * number(columns.density)? * number(columns.specific_heat)?;
        Some(product.sqrt()).filter(|effusivity| *effusivity > 0.0)
    };
    match facets.map(effusivity) {
        [Some(slave), Some(master)] => slave / (slave + master),
        _ => 0.5,
    }
}

impl Interaction for ThermalContact {
    fn name(&self) -> &str {
        NAME
    }

    fn extension(&self) -> Option<&'static str> {
        Some(EXTENSION)
    }

    fn begin_step(&mut self, part: &mut ModelPart) -> Result<()> {
        let acts = self.settings.interval.contains(part.info.time);
        let pairs = if acts { self.pairs(part) } else { Vec::new() };
        let keys: Vec<PairKey> = pairs.iter().map(|(key, _)| *key).collect();
        self.graph += u64::from(keys != self.keys);
        self.has_acted |= !keys.is_empty();
        self.keys = keys;
        self.blocks.clear();
        let unknown = Columns::of(part).unknown;
        for ((slave, master, _), (pairs, nodes)) in
            group_by_shapes(self.settings.surfaces.interfaces(), pairs, false, |(key, _)| *key)
        {
            let entry = require_kind(EntityRole::Condition, &condition_name(STEM, slave, master))?;
            let points = pairs.into_iter().map(|(_, points)| points).collect();
            let laws = self.settings.laws.clone();
            self.blocks.push(ConductanceBlock::new(entry, (points, nodes, master.nodes()), unknown, laws));
        }
        Ok(())
    }

    fn summary(&self, part: &ModelPart) -> Vec<(&'static str, f64)> {
        let view = part.view();
        let of_blocks = self.blocks.iter().map(|block| block.flow(&view, |nodes| part.evaluates_pair(nodes)));
        let own = of_blocks.fold([0.0; 2], |sum, own| [sum[0] + own[0], sum[1] + own[1]]);
        let [flow, friction] = if part.share.is_some() { own.map(|own| part.ranks.total(own)) } else { own };
        vec![("heat_pairs", self.keys.len() as f64), ("heat_from_slaves", flow), ("heat_of_friction", friction)]
    }

    fn last_messages(&self, part: &ModelPart) -> Vec<Diagnostic> {
        let never = !part.ranks.any(self.has_acted);
        let fact = "no heat has passed between the bodies of thermal_contact_process in any step";
        let remedy = "look whether its parts face and touch each other; laws \"gas\" and \"radiation\" act across gaps";
        never.then(|| Diagnostic::warning("never-met", fact).remedy(remedy)).into_iter().collect()
    }

    fn coupling(&self) -> Option<&dyn Coupling> {
        Some(self)
    }
}

impl Coupling for ThermalContact {
    fn blocks(&self) -> Vec<&dyn EntityBlock> {
        self.blocks.iter().map(|block| block as &dyn EntityBlock).collect()
    }

    fn graph_version(&self) -> u64 {
        self.graph
    }
}
