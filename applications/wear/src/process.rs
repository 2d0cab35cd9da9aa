//! `wear_process`: removes the worn depth after each accepted step.

use zelus_contact_structural_mechanics::FacingSurfaces;
use zelus_contact_structural_mechanics::interface::{Facet, Roles};
use zelus_contact_structural_mechanics::variables::CONTACT_STATUS;
use zelus_core::assembly::System;
use zelus_core::diagnostics::{Diagnostic, Report};
use zelus_core::model::{Model, ModelPart};
use zelus_core::parameters::{Interval, Node};
use zelus_core::processes::{Process, ProcessEntry, ProcessRequest, ScalarValue};
use zelus_core::registry::named;
use zelus_core::{Result, register};
use zelus_structural_mechanics::variables::DISPLACEMENT;

use crate::law::{SlidingStep, WearLaw, WearLawEntry};
use crate::limits::{Limits, warn_of_oscillation};
use crate::removal::{NodalWear, Side};
use crate::sliding::{SlidingPoint, SlidingSettings};
use crate::variables::WEAR_DEPTH;

/// The sides of an interface, in the order of their records.
const SIDES: [Roles; 2] = [Roles::Slave, Roles::Master];

struct WearProcess {
    root: String,
    interval: Interval,
    /// Laws of slave and master.
    laws: [Vec<Box<dyn WearLaw>>; 2],
    reading: SlidingSettings,
    limits: Limits,
    /// Volumes that slaves and masters have lost in the step, and the greatest depth so far.
    lost: [f64; 2],
    deepest: f64,
    warned: bool,
    messages: Vec<Diagnostic>,
}

impl WearProcess {
    /// Depth that slave or master loses at a point.
    fn depth(&self, side: usize, sliding: &SlidingStep) -> f64 {
        self.laws[side].iter().map(|law| law.depth(sliding)).sum()
    }

    /// Losses of the sides of an interface, and the warning of a step that is too long.
    fn wear(&self, part: &ModelPart, interface: usize) -> ([Side; 2], Option<Diagnostic>) {
        let points = self.reading.points(part, interface);
        let mut sides = SIDES.map(|role| Side::new(&self.reading.surfaces.interfaces()[interface], role));
        let depths = |own: &SlidingPoint<'_>| [0, 1].map(|side| self.depth(side, &own.sliding));
        for own in &points {
            let shapes = [&own.point.slave, &own.point.master];
            for (at, depth) in depths(own).into_iter().enumerate().filter(|(_, depth)| *depth > 0.0) {
                let facet = own.facets[at];
                sides[at].add(facet, &shapes[at][..facet.nodes.len()], depth * own.area);
            }
        }
        let with_depth = points.iter().map(|own| (own, depths(own).iter().sum()));
        (sides, warn_of_oscillation(part, with_depth))
    }
}

impl Process for WearProcess {
    fn check(&self, model: &Model, _system: &System, _warnings: &mut Report) -> Result<()> {
        let part = model.root(&self.root)?;
        let status = part.nodes.values.values(&CONTACT_STATUS, 0);
        let slaves = self.reading.surfaces.interfaces().iter().flat_map(|own| own.nodes_of(Roles::Slave));
        let alone = |node: &u32| status.get(*node as usize).is_none_or(|status| *status < 0.0);
        if let Some(node) = slaves.into_iter().find(alone) {
            let fact = format!("node {} of wear_process is a slave of no contact", part.nodes.ids[node as usize]);
            let remedy = "give it the pairs and slaves of a process of contact, whose pressures it takes";
            return Err(Diagnostic::error("no-contact", fact).remedy(remedy).into());
        }
        if part.nodes.history.get(DISPLACEMENT.name()).is_none_or(|field| field.levels.len() < 2) {
            let fact = "wear_process needs the displacements of the step before";
            return Err(Diagnostic::error("buffer-size", fact).remedy("set \"buffer_size\" to 2").into());
        }
        Ok(())
    }

    fn end_step(&mut self, model: &mut Model, _system: &System) -> Result<()> {
        let part = model.root_mut(&self.root)?;
        self.lost = [0.0; 2];
        if !self.interval.contains(part.info.time) {
            return Ok(());
        }
        let mut all: Vec<NodalWear> = Vec::new();
        let interfaces = self.reading.surfaces.interfaces();
        for (at, interface) in interfaces.iter().enumerate() {
            let (sides, warning) = self.wear(part, at);
            for ((side, role), lost) in sides.iter().zip(SIDES).zip(&mut self.lost) {
                all.extend(side.worn(&interface.facets, role, &part.nodes, self.reading.around));
                *lost += side.total();
            }
            if !self.warned {
                self.warned = warning.is_some();
                self.messages.extend(warning);
            }
        }
        if all.is_empty() {
            return Ok(());
        }
        part.ranks.agree(self.limits.check(part, &all))?;
        let depths = part.nodes.values.values_mut(&WEAR_DEPTH, 0);
        all.iter().for_each(|own| depths[own.node as usize] += own.depth);
        self.deepest = interfaces.iter().flat_map(|own| &own.nodes).map(|&n| depths[n as usize]).fold(0.0, f64::max);
        part.nodes.reshape(all.iter().map(|own| (own.node, own.way)));
        Ok(())
    }

    fn summary(&self) -> Vec<(&'static str, f64)> {
        let [slaves, masters] = self.lost;
        vec![("worn_from_slaves", slaves), ("worn_from_masters", masters), ("deepest_wear", self.deepest)]
    }

    fn messages(&mut self) -> Vec<Diagnostic> {
        std::mem::take(&mut self.messages)
    }
}

/// The law that an object of the settings names.
fn law(node: &Node) -> Result<Box<dyn WearLaw>> {
    let (entry, settings) = named::<WearLawEntry>(node, "law")?;
    (entry.build)(&settings)
}

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let settings = request.settings_with(|defaults| defaults.require(&["model_part_name"]))?;
    let laws_of = |key: &str| settings.items(key)?.iter().map(law).collect::<Result<Vec<_>>>();
    let laws = [laws_of("wear_of_slave")?, laws_of("wear_of_master")?];
    if laws.iter().all(Vec::is_empty) {
        let problem = settings.error("wear_of_slave", "missing-key", "neither side has a law of wear");
        return Err(problem.remedy("write e.g. [{\"law\": \"archard\", \"wear_coefficient\": 1.0e-8}]").into());
    }
    let share = settings.get_f64("largest_share")?;
    let speed = Some(settings.get("sliding_speed")?).filter(|speed| speed.is_given());
    let interval = Interval::from_node(settings.get("interval")?)?;
    let root = settings.get_str("model_part_name")?.to_owned();
    let surfaces = FacingSurfaces::new(&settings, request, false, false)?;
    let has_shape = surfaces.interfaces().iter().any(|own| own.facets.iter().any(Facet::is_rigid));
    if has_shape && !laws[1].is_empty() {
        let problem = settings.error("wear_of_master", "rigid-shape-wear", "a master that wears is a rigid shape");
        return Err(problem.remedy("give the wear to \"wear_of_slave\", or mesh the tool").into());
    }
    let reading = SlidingSettings {
        surfaces,
        speed: speed.map(ScalarValue::from_node).transpose()?,
        around: settings.get_bool("axisymmetric")?,
    };
    let part = request.model.root_mut(&root)?;
    part.nodes.values.add(&WEAR_DEPTH);
    Ok(Box::new(WearProcess {
        limits: Limits::new(part, reading.surfaces.interfaces(), share),
        root,
        interval,
        laws,
        reading,
        lost: [0.0; 2],
        deepest: 0.0,
        warned: false,
        messages: Vec::new(),
    }))
}

register! { ProcessEntry "wear_process",
    about: "wear of bodies that slide on each other: depths by laws, taken off after each step",
    source: "∫ w(p, s) da over mortar pairs",
    defaults: include_str!("../../../configs/processes/wear_process.json"),
    build: build,
    surfaces: FacingSurfaces::named,
}
