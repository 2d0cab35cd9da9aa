//! Pretension of a bolt: a section through its shank shortens it by s along its axis n.
//!
//! u⁺ = u⁻ − s n at the doubled nodes of the section ([`super::bolt_section`]), with u⁺ on the side of n; s > 0 shortens the bolt. The
//! displacement of a reference node is s n, and its load F n is the tension: F s is their work. Within the interval F or s is
//! prescribed, before and after it s keeps its value (locked length).

use zelus_core::assembly::System;
use zelus_core::diagnostics::{Diagnostic, Report, Result};
use zelus_core::entities::{EntityBlock, LocalSystems, Request};
use zelus_core::model::flags::RELATIVE;
use zelus_core::model::{MasterSlaveConstraint, Model, ModelPart, PropertyValue, ScalarVariable, SubPart};
use zelus_core::names::{Name, lasting};
use zelus_core::parameters::{Defaults, Settings, SpaceTime};
use zelus_core::processes::{Prescription, Process, ProcessEntry, ProcessRequest, ScalarValue, Target, check_unknowns};
use zelus_core::register;
use zelus_core::vector3::{norm, scale};

use super::bolt_section::{BoltSection, Cut};
use super::constraints_of_process::couple;
use super::nodal_conditions::add_conditions_to_mesh;
use crate::variables::{DISPLACEMENT, RESULTANT_LOAD, TEMPERATURE};

/// Component of the normal that is round-off.
const ROUND_OFF: f64 = 1e-12;
/// Data of the part of a section: the number of steps made when its process was made, and whether the bolt has been tightened since.
const STEP: &str = "PRETENSION_STEP";
const ACTED: &str = "PRETENSION_ACTED";

/// The prescribed quantity.
enum Pretension {
    Force(ScalarValue),
    Shortening(ScalarValue),
}

struct BoltPretension {
    target: Target,
    pretension: Pretension,
    /// Unit normal of the section.
    normal: [f64; 3],
    /// Reference node.
    reference: u32,
    /// Copies of the nodes of the section, ascending.
    copies: Vec<u32>,
    /// Place of the load among the conditions.
    condition: usize,
    names: [Name; 2],
    /// Force and shortening of the accepted state.
    now: [f64; 2],
    acts: bool,
    messages: Vec<Diagnostic>,
}

fn required(defaults: Defaults) -> Defaults {
    defaults.require(&["model_part_name"])
}

/// Name of the part of a bolt's section, below the root part.
fn section_name(path: &str) -> String {
    let below = path.split_once('.').map_or(path, |(_, below)| below);
    format!("section_of_{}", below.replace('.', "_"))
}

/// Place at which the settings cut the bolt.
fn cut(settings: &Settings, part: &ModelPart) -> Result<Cut> {
    let name = settings.get_str("section_model_part_name")?;
    let [point, normal] = [settings.get("point")?, settings.get("normal")?];
    if !name.is_empty() {
        if let Some((key, _)) = [("point", point), ("normal", normal)].iter().find(|(_, node)| !node.is_null()) {
            let fact = format!("\"{key}\" and \"section_model_part_name\" both cut the bolt");
            return Err(settings.error(key, "invalid-value", fact).remedy("write one of them").into());
        }
        let found = part.part(name).map_err(|error| error.at(&settings.key_place("section_model_part_name")))?;
        if found.conditions.is_empty() {
            let problem = settings.error("section_model_part_name", "empty-part", format!("{name} has no conditions"));
            return Err(problem
                .remedy("name a part with conditions on faces within the bolt, or write a plane")
                .into());
        }
        return Ok(Cut::Faces(found.conditions.clone()));
    }
    if let Some((key, _)) = [("point", point), ("normal", normal)].iter().find(|(_, node)| node.is_null()) {
        let problem =
            settings.error(key, "missing-key", format!("a section needs a plane, and \"{key}\" is not given"));
        return Err(problem.remedy("write \"point\" and \"normal\", e.g. [0.0, 0.0, 1.0]").into());
    }
    let (point, normal): ([f64; 3], [f64; 3]) = (point.parse("point")?, normal.parse("normal")?);
    let normal = if part.info.domain_size == 2 { [normal[0], normal[1], 0.0] } else { normal };
    let size = norm(normal);
    if !(size > 0.0 && size.is_finite()) {
        let problem = settings.error("normal", "invalid-direction", "\"normal\" has no length");
        return Err(problem.remedy("write the axis of the bolt, in planar models in the plane").into());
    }
    let unit = scale(normal, size.recip()).map(|n| if n.abs() <= ROUND_OFF { 0.0 } else { n });
    Ok(Cut::Plane(point, unit))
}

/// Cuts the mesh at the section and ties its sides by way of a reference node.
fn prepare(request: &mut ProcessRequest<'_>) -> Result<()> {
    // Faults of the settings are told when the process is made.
    let Ok(settings) = request.settings_with(required) else { return Ok(()) };
    let Ok(target) = Target::new(&settings, request.model) else { return Ok(()) };
    let part = request.model.root_mut(&target.path)?;
    let name = section_name(&target.path);
    if part.part(&name).is_ok() {
        // An earlier stage has cut it, or another process, which `build` tells.
        return Ok(());
    }
    let Ok(cut) = cut(&settings, part) else { return Ok(()) };
    if part.share.is_some() {
        let fact = format!("ranks share the mesh already, and {} is cut in this stage only", target.path);
        let problem = Diagnostic::error("shared-mesh", fact).at(target.place);
        return Err(problem.remedy("list the process in the first stage, too, or run on one rank").into());
    }
    let bolt = target.selection(&part.tree)?;
    if let Some(&at) = bolt.elements.iter().find(|&&at| part.elements.kinds[at as usize].name.contains("Axisym")) {
        let id = part.elements.ids[at as usize];
        let fact = format!("element {id} of {} is one of a body of revolution, whose section is a ring", target.path);
        let problem = Diagnostic::error("axisymmetric-resultant", fact).at(target.place);
        return Err(problem.remedy("model the bolt in space, or prescribe its shortening as an interference").into());
    }
    let section =
        BoltSection::find(part, &target.path, bolt, &cut).map_err(|problem| problem.at(target.place.clone()))?;
    let first = section.open(part);
    let reference = part.add_node(section.centre);
    part.nodes.flags.set(RELATIVE, reference as usize, true);
    let made = add_conditions_to_mesh(part, "ResultantLoadCondition", &[reference])?;
    let is_warm = part.nodes.history.has(TEMPERATURE.name());
    let constraints = constraints(&section, first, reference, part.info.domain_size, is_warm);
    let constraints = couple(part, &target, constraints);
    let copies = first..first + section.nodes.len() as u32;
    let mut own = SubPart {
        nodes: section.nodes.iter().copied().chain(copies).chain([reference]).collect(),
        conditions: made.map(|at| at as u32).collect(),
        constraints: constraints.map(|at| at as u32).collect(),
        ..SubPart::new(name.clone())
    };
    own.data.insert("NORMAL".to_owned(), PropertyValue::Vector(section.normal.to_vec()));
    own.normalise();
    part.tree.children.insert(name, own);
    Ok(())
}

/// Component of the reference node that stands for the shortening: the largest of the normal.
fn leading(normal: [f64; 3]) -> usize {
    (0..3).max_by(|&a, &b| normal[a].abs().total_cmp(&normal[b].abs())).unwrap_or(0)
}

/// u⁺ = u⁻ − u_ref at the nodes of a section, u_ref along the normal, and one temperature on both sides.
fn constraints(
    section: &BoltSection,
    first: u32,
    reference: u32,
    space: usize,
    is_warm: bool,
) -> Vec<MasterSlaveConstraint> {
    let lead = leading(section.normal);
    let unknown = |node: u32, c: usize| (node, DISPLACEMENT.component(c as u8));
    let share = |c: usize| section.normal[c] / section.normal[lead];
    let follows = MasterSlaveConstraint::new;
    let led = |c: usize, factor: f64| (share(c) != 0.0).then(|| (unknown(reference, lead), factor * share(c)));
    let of_node = |(copy, &node): (u32, &u32)| {
        let of_component = move |c: usize| {
            let masters = [(unknown(node, c), 1.0)].into_iter().chain(led(c, -1.0)).collect();
            follows(unknown(copy, c), masters)
        };
        let warm = follows((copy, TEMPERATURE.scalar()), vec![((node, TEMPERATURE.scalar()), 1.0)]);
        (0..space).map(of_component).chain(is_warm.then_some(warm)).collect::<Vec<_>>()
    };
    let of_nodes = (first..).zip(&section.nodes).flat_map(of_node);
    let along = (0..space).filter(|&c| c != lead);
    of_nodes.chain(along.map(|c| follows(unknown(reference, c), led(c, 1.0).into_iter().collect()))).collect()
}

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let settings = request.settings_with(required)?;
    let target = Target::new(&settings, request.model)?;
    let given = ["force", "shortening"].map(|key| settings.get(key).map(|node| !node.is_null()));
    let pretension = match given {
        [Ok(true), Ok(false)] => Pretension::Force(ScalarValue::from_node(settings.get("force")?)?),
        [Ok(false), Ok(true)] => Pretension::Shortening(ScalarValue::from_node(settings.get("shortening")?)?),
        both => {
            let fact = match both {
                [Ok(true), _] => "\"force\" and \"shortening\" both tighten the bolt",
                _ => "neither \"force\" nor \"shortening\" tightens the bolt",
            };
            return Err(settings.error("force", "invalid-value", fact).remedy("write one of them").into());
        }
    };
    let part = request.model.root_mut(&target.path)?;
    cut(&settings, part)?;
    if part.info.solver.explicit {
        let problem = Diagnostic::error("explicit-pretension", "explicit steps cannot tie the two sides of a section");
        return Err(problem.at(target.place).remedy("use an implicit or a static solver").into());
    }
    let step = part.info.step as f64;
    let name = section_name(&target.path);
    let gone = || Diagnostic::error("bolt-section", format!("the mesh of {} is not cut", target.path));
    let section = part.tree.children.get_mut(&name).ok_or_else(|| gone().at(target.place.clone()))?;
    if section.data.insert(STEP.to_owned(), PropertyValue::Number(step)) == Some(PropertyValue::Number(step)) {
        let fact = format!("two processes tighten {}", target.path);
        let problem = Diagnostic::error("listed-twice", fact).at(target.place);
        return Err(problem.remedy("give the force in one process, as a function of t or a table").into());
    }
    section.data.remove(ACTED);
    let Some(PropertyValue::Vector(normal)) = section.data.get("NORMAL") else { return Err(gone().into()) };
    let normal = std::array::from_fn(|c| normal.get(c).copied().unwrap_or(0.0));
    let Some(&condition) = section.conditions.first() else { return Err(gone().into()) };
    let slaves = section.constraints.iter().map(|&at| part.constraints[at as usize].slave.0);
    let reference = part.conditions.nodes(condition)[0];
    let mut copies: Vec<u32> = slaves.filter(|&node| node != reference).collect();
    copies.sort_unstable();
    copies.dedup();
    let names = ["force", "shortening"].map(|what| lasting(&format!("{what} of bolt {}", target.path)));
    Ok(Box::new(BoltPretension {
        target,
        pretension,
        normal,
        reference,
        copies,
        condition: condition as usize,
        names,
        now: [0.0; 2],
        acts: false,
        messages: Vec::new(),
    }))
}

impl BoltPretension {
    /// The unknown of the reference node, which is n_c s.
    fn unknown(&self) -> ScalarVariable {
        DISPLACEMENT.component(leading(self.normal) as u8)
    }

    fn value(&self, part: &ModelPart, value: &ScalarValue, time: f64) -> f64 {
        let at = self.reference as usize;
        value.value(&SpaceTime { current: part.nodes.current[at], initial: part.nodes.initial[at], time })
    }

    fn checked(&self, part: &ModelPart, value: &ScalarValue) -> Result<f64> {
        let (time, found) = (part.info.time, self.value(part, value, part.info.time));
        match found.is_finite() {
            true => Ok(found),
            false => Err(self.target.not_finite(self.unknown(), found, time, "the section").into()),
        }
    }

    fn load(&self, part: &mut ModelPart, force: f64) {
        part.conditions.data.add(&RESULTANT_LOAD);
        let column = part.conditions.data.values_mut(&RESULTANT_LOAD, 0);
        column[3 * self.condition..3 * self.condition + 3].copy_from_slice(&scale(self.normal, force));
    }

    /// Tension in the section: the forces of the elements on the side of the normal at its nodes, along it; collective.
    fn tension(&self, part: &ModelPart, system: &System) -> Result<f64> {
        let mut sum = 0.0;
        let of_block = |block: &dyn EntityBlock, sum: &mut f64| -> Result<()> {
            let size = block.unknowns().len();
            let is_copy = |node: &u32| self.copies.binary_search(node).is_ok();
            let mut out = LocalSystems::default();
            for at in (0..block.len()).filter(|&at| block.nodes(at).iter().any(is_copy)) {
                out.reset(1, size, Request::Residual);
                block.local_systems(&part.view(), at..at + 1, Request::Residual, &mut out)?;
                for (unknown, force) in block.unknowns().iter().zip(out.rhs_of(0)) {
                    let node = block.nodes(at)[usize::from(unknown.node)];
                    if is_copy(&node) && unknown.variable.column == DISPLACEMENT.name() {
                        *sum += self.normal[unknown.variable.offset()] * force;
                    }
                }
            }
            Ok(())
        };
        let found = system.elements.iter().try_for_each(|block| of_block(block.as_ref(), &mut sum));
        part.ranks.agree(found)?;
        Ok(if part.share.is_some() { part.ranks.total(sum) } else { sum })
    }
}

impl Process for BoltPretension {
    fn check(&self, model: &Model, system: &System, _warnings: &mut Report) -> Result<()> {
        let unknowns = std::iter::once((self.reference, self.unknown()));
        check_unknowns(model.root(&self.target.path)?, system, unknowns, &self.target.place)
    }

    fn prescribes(&self, part: &ModelPart, time: f64) -> Vec<Prescription> {
        let value = match &self.pretension {
            _ if !self.target.is_of(part) => return Vec::new(),
            Pretension::Force(_) if self.target.interval.contains(time) => return Vec::new(),
            Pretension::Shortening(value) if self.target.interval.contains(time) => {
                Some(self.normal[leading(self.normal)] * self.value(part, value, time))
            }
            _ => None,
        };
        let by = format!("{} on {}", self.target.process, self.target.path);
        let part = self.target.path.clone();
        vec![Prescription { by, part, variable: self.unknown(), values: vec![(self.reference, value)] }]
    }

    fn drives(&self, part: &ModelPart, _system: &System) -> bool {
        let (Pretension::Force(value) | Pretension::Shortening(value)) = &self.pretension;
        self.target.is_of(part) && !value.is_zero()
    }

    fn begin_step(&mut self, model: &mut Model) -> Result<()> {
        let part = model.root_mut(&self.target.path)?;
        self.acts = self.target.interval.contains(part.info.time);
        let (mut force, mut is_fixed) = (0.0, true);
        match &self.pretension {
            Pretension::Force(value) if self.acts => (force, is_fixed) = (self.checked(part, value)?, false),
            Pretension::Shortening(value) if self.acts => {
                let value = self.normal[leading(self.normal)] * self.checked(part, value)?;
                part.nodes.history.set_value(self.unknown(), self.reference as usize, 0, value);
            }
            _ => {}
        }
        part.nodes.set_fixed(self.unknown(), &[self.reference], is_fixed);
        self.load(part, force);
        Ok(())
    }

    fn end_step(&mut self, model: &mut Model, system: &System) -> Result<()> {
        let section = section_name(&self.target.path);
        let part = model.root_mut(&self.target.path)?;
        if let Some(own) = part.tree.children.get_mut(&section).filter(|_| self.acts) {
            own.data.insert(ACTED.to_owned(), PropertyValue::Boolean(true));
        }
        let moved = part.nodes.history.value(self.unknown(), self.reference as usize, 0).unwrap_or(0.0);
        let part = &*part;
        self.now = [self.tension(part, system)?, moved / self.normal[leading(self.normal)]];
        let [force, shortening] = self.now;
        let state = match (&self.pretension, self.acts) {
            (_, false) => "at locked length",
            (Pretension::Force(_), true) => "by its force",
            (Pretension::Shortening(_), true) => "by its shortening",
        };
        let fact = format!(
            "bolt {} at time {}: force {force:.6e}, shortening {shortening:.6e}, {state}",
            self.target.path, part.info.time
        );
        self.messages.push(Diagnostic::note("bolt", fact));
        Ok(())
    }

    fn summary(&self) -> Vec<(&'static str, f64)> {
        self.names.into_iter().zip(self.now).collect()
    }

    fn messages(&mut self) -> Vec<Diagnostic> {
        std::mem::take(&mut self.messages)
    }

    fn last_messages(&self, model: &Model) -> Vec<Diagnostic> {
        let section = |part: &ModelPart| part.tree.children.get(&section_name(&self.target.path)).cloned();
        let section = model.root(&self.target.path).ok().and_then(section);
        if section.is_none_or(|own| own.data.contains_key(ACTED)) {
            return Vec::new();
        }
        let fact = format!("no step lies in the \"interval\" in which the bolt {} is tightened", self.target.path);
        let problem = Diagnostic::warning("never-tightened", fact).at(self.target.place.clone());
        vec![problem.remedy("an interval from 0 ends before its end: let it reach beyond the last step of tightening")]
    }

    fn finalize(&mut self, model: &mut Model) -> Result<()> {
        // The bolt keeps its length in later stages.
        let part = model.root_mut(&self.target.path)?;
        part.nodes.set_fixed(self.unknown(), &[self.reference], true);
        self.load(part, 0.0);
        Ok(())
    }

    fn suspend(&mut self, _model: &mut Model) -> Result<()> {
        Ok(())
    }
}

register! { ProcessEntry "bolt_pretension_process",
    aliases: &["BoltPretensionProcess"],
    about: "tightens a bolt at a section through its shank: by a force first, then at locked length",
    source: "u⁺ − u⁻ = −s n",
    prepares: prepare,
    defaults: include_str!("../../../../configs/processes/bolt_pretension_process.json"),
    build: build,
}
