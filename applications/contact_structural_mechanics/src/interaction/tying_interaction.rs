//! Meshes that do not match, tied by multipliers: D and M of a pair are those of the moment it is made.

use std::collections::BTreeMap;

use zelus_core::Result;
use zelus_core::diagnostics::Diagnostic;
use zelus_core::entities::{EntityBlock, Interaction, SetChange};
use zelus_core::model::flags::{ACTIVE, CONTACT};
use zelus_core::model::{ModelPart, ScalarVariable};
use zelus_core::parameters::Interval;
use zelus_core::registry::{self, Kind};

use crate::interface::{
    Interface, Roles, add_contact_part, alm_parameters, find_nodal_h, interfaces, nodal_normals, slave_nodes,
};
use crate::mortar::SegmentationSettings;
use crate::pairs::{
    FacetOperators, FacetPair, PairKey, TyingFamily, TyingRequest, condition_name, group_by_shapes, overlapping_pairs,
    tying_block,
};
use crate::search::SearchSettings;

/// What a deck chooses about a tie.
pub struct TyingSettings {
    /// Parts of the interfaces by key.
    pub parts: BTreeMap<String, Vec<String>>,
    /// Parts on the slave side by key.
    pub slaves: BTreeMap<String, Vec<String>>,
    /// The multipliers.
    pub family: &'static TyingFamily,
    /// What is tied, one number a multiplier.
    pub tied: Vec<ScalarVariable>,
    /// Times in which the tie holds.
    pub interval: Interval,
    /// Which facets are looked at.
    pub search: SearchSettings,
    /// Steps between searches.
    pub database_step_update: usize,
    /// How overlaps are cut and integrated.
    pub segmentation: SegmentationSettings,
    /// Scale factor given by hand.
    pub manual: Option<f64>,
    /// Factor of E/h in eq. 4.11.
    pub stiffness_factor: f64,
}

/// Ties in a model part.
pub struct TyingInteraction {
    settings: TyingSettings,
    interfaces: Vec<Interface>,
    slaves: Vec<u32>,
    pairs: BTreeMap<PairKey, FacetOperators>,
    blocks: Vec<Box<dyn EntityBlock>>,
    scale_factor: f64,
    graph: u64,
    steps_since_search: Option<usize>,
}

impl TyingInteraction {
    /// Ties with these settings; the interfaces are built at once, so that a wrong part is named early.
    ///
    /// # Errors
    /// Parts that do not exist or hold no facets.
    pub fn new(settings: TyingSettings, part: &mut ModelPart) -> Result<Self> {
        let interfaces = interfaces(part, &settings.parts, &settings.slaves)?;
        add_contact_part(part, &interfaces);
        Ok(Self {
            settings,
            slaves: slave_nodes(&interfaces),
            interfaces,
            pairs: BTreeMap::new(),
            blocks: Vec::new(),
            scale_factor: 1.0,
            graph: 1,
            steps_since_search: None,
        })
    }

    fn search(&mut self, part: &mut ModelPart) {
        nodal_normals(part, &self.interfaces);
        let known = |key: &PairKey| self.pairs.contains_key(key);
        let found =
            overlapping_pairs(part, &self.interfaces, &self.settings.search, &self.settings.segmentation, &known);
        self.pairs.extend(found.into_iter().map(|pair| (pair.key, pair.operators)));
    }

    fn make_blocks(&mut self, part: &ModelPart) -> Result<()> {
        let multipliers = self.settings.family.multiplier.unknowns(part.info.domain_size);
        let pairs = self.pairs.iter().map(|(&key, &operators)| FacetPair { key, operators });
        let groups = group_by_shapes(&self.interfaces, pairs, |pair| pair.key);
        self.blocks.clear();
        for ((slave, master), (pairs, nodes)) in groups {
            let name = condition_name("MeshTyingMortarCondition", slave, master);
            let request = TyingRequest {
                entry: registry::require(Kind::Condition, &name)?,
                pairs,
                nodes,
                tied: self.settings.tied.clone(),
                multipliers: multipliers.clone(),
                scale_factor: self.scale_factor,
            };
            self.blocks.push(tying_block(slave, master, request).ok_or_else(|| {
                Diagnostic::error("contact-shapes", format!("{name}: no ties of {slave:?} to {master:?}"))
            })?);
        }
        self.graph += 1;
        Ok(())
    }

    /// Outside its interval a tie carries nothing.
    fn switch_off(&mut self, part: &mut ModelPart) {
        if self.blocks.is_empty() {
            return;
        }
        self.blocks.clear();
        self.graph += 1;
        for variable in self.settings.family.multiplier.unknowns(part.info.domain_size) {
            let Some(field) = part.nodes.history.get_mut(variable.column) else { continue };
            for &node in &self.slaves {
                field.levels[0][node as usize * field.components + variable.offset()] = 0.0;
            }
        }
        self.mark(part, false);
    }

    fn mark(&self, part: &mut ModelPart, active: bool) {
        self.slaves.iter().for_each(|&node| part.nodes.flags.set(ACTIVE, node as usize, active));
    }
}

impl Interaction for TyingInteraction {
    fn name(&self) -> &str {
        "mesh tying"
    }

    fn initialize(&mut self, part: &mut ModelPart) -> Result<()> {
        find_nodal_h(part);
        part.info.marks.insert(CONTACT, true);
        let estimate = alm_parameters(part, &self.interfaces, self.settings.stiffness_factor, 1.0).scale_factor;
        let chosen = self.settings.manual.unwrap_or(estimate);
        self.scale_factor = if chosen <= 0.0 { 1.0 } else { chosen };
        part.info.values.insert("SCALE_FACTOR", self.scale_factor);
        debug_assert!(self.interfaces.iter().all(|i| i.facets.iter().all(|f| f.role != Roles::Open)));
        nodal_normals(part, &self.interfaces);
        Ok(())
    }

    fn unknowns(&self, part: &ModelPart) -> Vec<(ScalarVariable, Vec<u32>)> {
        let unknowns = self.settings.family.multiplier.unknowns(part.info.domain_size);
        unknowns.into_iter().map(|variable| (variable, self.slaves.clone())).collect()
    }

    fn begin_step(&mut self, part: &mut ModelPart) -> Result<()> {
        if !self.settings.interval.contains(part.info.time) {
            self.switch_off(part);
            return Ok(());
        }
        let due = self.steps_since_search.is_none_or(|steps| steps + 1 >= self.settings.database_step_update);
        let before = self.pairs.len();
        if due {
            self.search(part);
            self.steps_since_search = Some(0);
        } else {
            self.steps_since_search = self.steps_since_search.map(|steps| steps + 1);
        }
        if self.pairs.is_empty() {
            let fact = "no pair of facets overlaps: nothing is tied";
            return Err(Diagnostic::error("nothing-tied", fact)
                .remedy("check that the parts of \"mesh_tying_model_part\" meet, and which is named as slave")
                .into());
        }
        if self.blocks.is_empty() || self.pairs.len() != before {
            self.make_blocks(part)?;
            self.mark(part, true);
        }
        Ok(())
    }

    fn after_prediction(&mut self, _part: &mut ModelPart) -> Result<()> {
        Ok(())
    }

    fn after_update(&mut self, _part: &mut ModelPart, _iteration: usize) -> Result<SetChange> {
        Ok(SetChange::default())
    }

    fn accept_step(&mut self, _part: &mut ModelPart) -> Result<()> {
        Ok(())
    }

    fn blocks(&self) -> Vec<&dyn EntityBlock> {
        self.blocks.iter().map(AsRef::as_ref).collect()
    }

    fn graph_version(&self) -> u64 {
        self.graph
    }

    fn idle_diagonal(&self) -> f64 {
        self.scale_factor
    }

    fn save(&mut self) {}

    // Pairs made at the start of a step are those that the retried step would make.
    fn restore(&mut self) {}

    fn summary(&self, _part: &ModelPart) -> Vec<(&'static str, f64)> {
        vec![("tied pairs", if self.blocks.is_empty() { 0.0 } else { self.pairs.len() as f64 })]
    }
}
