//! Maps a nodal variable from one surface to another that lies on it, by mortar: v_j = c Σ (M v)_j / Σ D_jj.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use zelus_core::diagnostics::Diagnostic;
use zelus_core::model::{Field, Model, ModelPart, Named, VariableEntry, named};
use zelus_core::parameters::{Interval, Settings};
use zelus_core::processes::{Process, ProcessEntry, ProcessRequest};
use zelus_core::registry::Kind;
use zelus_core::{Result, State, StateMapper, register};
use zelus_structural_mechanics::variables::NORMAL;

use super::interface_settings::{check_positive, segmentation};
use crate::interface::{self, Interface, interfaces};
use crate::mortar::SegmentationSettings;
use crate::pairs::{FacetPair, PairKey, check_pairs, nodal_normals, overlapping_pairs};
use crate::search::{GapCheck, SearchDistance, SearchSettings, WithinStep};

/// Least difference of unit normals of facets that face each other.
const FACING: f64 = 0.1;

/// A column of nodal values, or one component of it.
struct Quantity {
    column: &'static str,
    offset: usize,
    components: usize,
    historical: bool,
}

impl Quantity {
    fn new(settings: &Settings, key: &str, fallback: &str, historical: &str) -> Result<Self> {
        let name = match settings.get_str(key)? {
            "" => settings.get_str(fallback)?,
            name => name,
        };
        let found = named(name).ok_or_else(|| {
            settings
                .error(key, "unknown-variable", format!("there is no variable {name:?}"))
                .remedy(Kind::of::<VariableEntry>().remedy(name))
        })?;
        let (column, offset, components) = found.column();
        Ok(Self { column, offset, components, historical: settings.get_bool(historical)? })
    }

    fn width(&self) -> usize {
        match named(self.column) {
            Some(Named::Whole(name, kind)) => Named::Whole(name, kind).column().2,
            _ => self.components,
        }
    }

    fn field<'p>(&self, part: &'p mut ModelPart) -> Result<&'p mut Field> {
        if self.historical {
            return part.nodes.history.field_mut(self.column);
        }
        part.nodes.values.add_named(self.column, self.width());
        part.nodes.values.field_mut(self.column)
    }
}

struct Mapper {
    root: String,
    origin_part: String,
    destination_part: String,
    interval: Interval,
    origin: Quantity,
    destination: Quantity,
    coefficient: f64,
    search: SearchSettings,
    segmentation: SegmentationSettings,
    update: bool,
    interface: Vec<Interface>,
    pairs: Vec<FacetPair>,
}

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let required = ["origin_model_part_name", "destination_model_part_name"];
    let settings = request.settings_with(|defaults| defaults.require(&required))?;
    check_positive(&settings, &["search_parameters.search_factor", "distance_threshold"])?;
    for key in ["origin_are_conditions", "destination_are_conditions"] {
        if !settings.get_bool(key)? {
            let fact = format!("\"{key}\" is false, but surfaces are made of conditions or of nodes of element faces");
            return Err(settings.error(key, "invalid-value", fact).into());
        }
    }
    let origin_part = settings.get_str("origin_model_part_name")?.to_owned();
    let destination_part = settings.get_str("destination_model_part_name")?.to_owned();
    let root = origin_part.split('.').next().unwrap_or_default().to_owned();
    if destination_part.split('.').next() != Some(&root) {
        let fact = "origin and destination belong to different root parts";
        return Err(settings.error("destination_model_part_name", "unknown-model-part", fact).into());
    }
    let part = request.model.root_mut(&root).map_err(|e| e.at(&settings.key_place("origin_model_part_name")))?;
    part.part(&origin_part).map_err(|e| e.at(&settings.key_place("origin_model_part_name")))?;
    part.part(&destination_part).map_err(|e| e.at(&settings.key_place("destination_model_part_name")))?;
    let origin = Quantity::new(&settings, "origin_variable", "origin_variable", "origin_variable_historical")?;
    let destination =
        Quantity::new(&settings, "destination_variable", "origin_variable", "destination_variable_historical")?;
    if origin.components != destination.components {
        let fact = "\"origin_variable\" and \"destination_variable\" differ in their number of components";
        return Err(settings.error("destination_variable", "wrong-type", fact).into());
    }
    Ok(Box::new(Mapper {
        root,
        origin_part,
        destination_part,
        interval: Interval::from_node(settings.get("interval")?)?,
        origin,
        destination,
        coefficient: settings.get_f64("mapping_coefficient")?,
        search: SearchSettings {
            factor: settings.get_f64("search_parameters.search_factor")?,
            distance: SearchDistance::BetweenFacets,
            within_step: WithinStep::Lost,
            normal_orientation_threshold: FACING,
            check: GapCheck::CheckMapping,
            dynamic: false,
        },
        segmentation: SegmentationSettings {
            distance_threshold: settings.get_f64("distance_threshold")?,
            ..segmentation(&settings)?
        },
        update: settings.get_bool("update_interface")?,
        interface: Vec::new(),
        pairs: Vec::new(),
    }))
}

/// The overlaps that were found.
#[derive(Serialize, Deserialize)]
struct SavedPairs(Vec<FacetPair>);

#[typetag::serde(name = "simple_mortar_mapper")]
impl State for SavedPairs {
    fn remap(&mut self, _mapper: &mut dyn StateMapper) {}
}

impl Mapper {
    /// The facets, once; flags of contact on the same nodes are left as they are.
    fn find_facets(&mut self, part: &mut ModelPart) -> Result<()> {
        if !self.interface.is_empty() {
            return Ok(());
        }
        let flags = part.nodes.flags.clone();
        let key = "0".to_owned();
        let parts = BTreeMap::from([(key.clone(), vec![self.origin_part.clone(), self.destination_part.clone()])]);
        let slaves = BTreeMap::from([(key, vec![self.destination_part.clone()])]);
        let found = interfaces(part, &parts, &slaves);
        part.nodes.flags = flags;
        self.interface = found?;
        Ok(())
    }

    /// The overlaps as they stand.
    fn find_pairs(&mut self, part: &mut ModelPart) -> Result<()> {
        self.find_facets(part)?;
        part.nodes.history.add(&NORMAL);
        interface::nodal_normals(part, &self.interface);
        let normals = |key: PairKey, local: usize| {
            nodal_normals(part, &self.interface[key.interface as usize].facets[key.slave as usize])(local)
        };
        let pairs = overlapping_pairs(part, &self.interface, &self.search, &self.segmentation, &normals, &|_| false);
        if pairs.is_empty() {
            let fact = format!("{} and {} do not overlap: nothing is mapped", self.origin_part, self.destination_part);
            return Err(Diagnostic::error("nothing-mapped", fact)
                .remedy("name two surfaces that face each other")
                .into());
        }
        self.pairs = pairs;
        Ok(())
    }
}

/// Steps after which the exchange between neighbours is round-off: each takes it to a third or less.
const STEPS: usize = 40;

impl Mapper {
    /// Areas times the values v at slave nodes for which D v is `sums`, each node with as many numbers as it has components.
    ///
    /// Where slaves are of second order D has entries beside its diagonal, which is the larger part: v is that of simple
    /// iterations. Elsewhere D counts as diagonal.
    fn without_neighbours(&self, sums: Vec<f64>, areas: &[f64]) -> Vec<f64> {
        let count = self.origin.components;
        let slave = |pair: &FacetPair| &self.interface[pair.key.interface as usize].facets[pair.key.slave as usize];
        let is_curved = |pair: &&FacetPair| slave(pair).shape != slave(pair).shape.linear();
        let curved: Vec<&FacetPair> = self.pairs.iter().filter(is_curved).collect();
        let mut mapped = sums.clone();
        for _ in 0..if curved.is_empty() { 0 } else { STEPS } {
            let mut next = sums.clone();
            for pair in &curved {
                let nodes = &slave(pair).nodes;
                for (row, &node) in pair.operators.d.iter().zip(nodes) {
                    let own: f64 = row[..nodes.len()].iter().sum();
                    for (k, (&other, d)) in nodes.iter().zip(row).enumerate() {
                        let beside = if nodes[k] == node { d - own } else { *d };
                        for c in 0..count {
                            let value = mapped[count * other as usize + c] / areas[other as usize];
                            next[count * node as usize + c] -= beside * value;
                        }
                    }
                }
            }
            mapped = next;
        }
        mapped
    }
}

impl Process for Mapper {
    fn begin_step(&mut self, model: &mut Model) -> Result<()> {
        let part = model.root_mut(&self.root)?;
        if !self.interval.contains(part.info.time) {
            return Ok(());
        }
        if self.pairs.is_empty() || self.update {
            self.find_pairs(part)?;
        }
        let count = self.origin.components;
        let from = self.origin.field(part)?;
        let (width, values) = (from.components, from.levels[0].clone());
        let mut sums = vec![0.0; count * part.nodes.len()];
        let mut areas = vec![0.0; part.nodes.len()];
        for pair in &self.pairs {
            let facets = &self.interface[pair.key.interface as usize].facets;
            let (slave, master) = (&facets[pair.key.slave as usize], &facets[pair.key.master as usize]);
            for (j, &node) in slave.nodes.iter().enumerate() {
                areas[node as usize] += pair.operators.d[j][..slave.nodes.len()].iter().sum::<f64>();
                for (l, &other) in master.nodes.iter().enumerate() {
                    for c in 0..count {
                        sums[count * node as usize + c] +=
                            pair.operators.m[j][l] * values[width * other as usize + self.origin.offset + c];
                    }
                }
            }
        }
        let mapped = self.without_neighbours(sums, &areas);
        let offset = self.destination.offset;
        let to = self.destination.field(part)?;
        let width = to.components;
        for (node, area) in areas.iter().enumerate().filter(|(_, area)| **area > 0.0) {
            for c in 0..count {
                to.levels[0][width * node + offset + c] = self.coefficient * mapped[count * node + c] / area;
            }
        }
        Ok(())
    }

    fn state(&self) -> Option<Box<dyn State>> {
        Some(Box::new(SavedPairs(self.pairs.clone())))
    }

    fn resume(&mut self, model: &mut Model, state: Box<dyn State>) -> Result<()> {
        let SavedPairs(pairs) = state.take()?;
        self.find_facets(model.root_mut(&self.root)?)?;
        check_pairs(&self.interface, pairs.iter().map(|pair| pair.key))?;
        self.pairs = pairs;
        Ok(())
    }
}

register! { ProcessEntry "simple_mortar_mapper_process",
    aliases: &["SimpleMortarMapperProcess", "basic_mapping_process", "BasicMappingProcess"],
    about: "maps a nodal variable between two surfaces that face each other, by dual mortar",
    source: "D φ¹ = M φ²; Wohlmuth (2000)",
    defaults: include_str!("../../../../configs/processes/simple_mortar_mapper_process.json"),
    build: build,
    surfaces: super::touching::mapping,
}
