//! The surfaces between which something acts that is no contact, such as heat or wear: facets that face each other, and the points
//! at which they do.

use std::collections::BTreeMap;

use rustc_hash::FxHashMap;
use serde::Deserialize;
use zelus_core::Result;
use zelus_core::model::ModelPart;
use zelus_core::parallel;
use zelus_core::parameters::{Node, Settings};
use zelus_core::processes::{NamedSurface, ProcessRequest};

use super::interface_settings::{check_slaves, integration_order, warn_of_revolution};
use super::touching;
use crate::interface::{Facet, Interface, Roles, interfaces};
use crate::mortar::SegmentationSettings;
use crate::pairs::{FacingPoint, PAIRS, PairKey, facing_points};
use crate::search::{Candidate, GapCheck, SearchDistance, SearchSettings, WithinStep, candidates};

#[derive(Debug, Deserialize)]
struct FacingSurfacesKeys {
    contact_model_part: BTreeMap<String, Vec<String>>,
    assume_master_slave: BTreeMap<String, Vec<String>>,
    normal_orientation_threshold: f64,
}

/// The surfaces that a process names, and how it looks for those that face each other.
pub struct FacingSurfaces {
    interfaces: Vec<Interface>,
    search: SearchSettings,
    segmentation: SegmentationSettings,
}

/// A slave facet with a master facet near it that does not face the same way.
pub struct FacingPair<'a, 's> {
    /// Facets of the pair.
    pub key: PairKey,
    /// Slave and master.
    pub facets: [&'a Facet; 2],
    part: &'s ModelPart,
    normals: &'s FxHashMap<u32, [f64; 3]>,
    segmentation: &'s SegmentationSettings,
}

impl FacingPair<'_, '_> {
    /// The points of their overlap where they are now; none where they do not overlap.
    pub fn points(&self) -> Vec<FacingPoint> {
        let [slave, master] = self.facets;
        facing_points(self.part, slave, master, &|node| self.normals[&node], self.segmentation)
    }
}

impl FacingSurfaces {
    /// By the keys `contact_model_part`, `assume_master_slave`, `search_factor`, `integration_order` and
    /// `normal_orientation_threshold`, on the part that `model_part_name` names; `slivers` says whether overlaps of next to no size
    /// count, `across` whether facets face each other at any distance: else `search_factor` is the search radius.
    ///
    /// The report takes the warning that `axisymmetric` does not fit the bodies.
    ///
    /// # Errors
    /// Parts that do not exist or hold no facets, pairs without slaves, numbers out of range.
    pub fn new(settings: &Settings, request: &mut ProcessRequest<'_>, slivers: bool, across: bool) -> Result<Self> {
        let whole: FacingSurfacesKeys = settings.parse()?;
        let part = request.model.root_mut(settings.get_str("model_part_name")?)?;
        warn_of_revolution(part, settings, "axisymmetric")?.into_iter().for_each(|own| request.report.push(own));
        check_slaves(settings, "contact_model_part", &whole.contact_model_part, &whole.assume_master_slave)?;
        let search = SearchSettings {
            factor: settings.get_positive("search_factor")?,
            distance: if across { SearchDistance::BeyondFirst } else { SearchDistance::BetweenFacets },
            within_step: WithinStep::Lost,
            normal_orientation_threshold: whole.normal_orientation_threshold,
            check: GapCheck::CheckMapping,
            dynamic: false,
        };
        let integration_order = integration_order(settings)?;
        let segmentation = SegmentationSettings { integration_order, slivers, ..SegmentationSettings::default() };
        // Contact marks the same nodes.
        let flags = part.nodes.flags.clone();
        let found = interfaces(part, &whole.contact_model_part, &whole.assume_master_slave);
        part.nodes.flags = flags;
        Ok(Self { interfaces: found?, search, segmentation })
    }

    /// The surfaces, pair of the deck by pair.
    pub fn interfaces(&self) -> &[Interface] {
        &self.interfaces
    }

    /// The surfaces of both sides, for those who share out a mesh.
    pub fn named(parameters: Option<&Node>) -> Vec<NamedSurface> {
        touching::contact(parameters)
    }

    /// Results of `of_pair` for the pairs of facets of one interface, in an order that depends on nothing but the mesh.
    pub fn of_pairs<'a, T: Send, I: IntoIterator<Item = T>>(
        &'a self,
        part: &ModelPart,
        interface: usize,
        of_pair: impl Fn(FacingPair<'a, '_>) -> I + Sync,
    ) -> Vec<T> {
        let own = &self.interfaces[interface];
        let normals = &own.normals_of(part, Roles::Slave).into_iter().collect();
        let segmentation = &self.segmentation;
        let near = candidates(part, own, &self.search);
        let found = parallel::map(near.len(), PAIRS, |at| {
            let Candidate { slave, master, .. } = near[at];
            let key = PairKey { interface: interface as u32, slave, master };
            let facets = [slave, master].map(|at| &own.facets[at as usize]);
            of_pair(FacingPair { key, facets, part, normals, segmentation }).into_iter().collect::<Vec<T>>()
        });
        found.into_iter().flatten().collect()
    }
}
