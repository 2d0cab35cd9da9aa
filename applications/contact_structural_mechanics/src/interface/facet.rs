//! A facet of a contact surface.

use std::ops::Deref;
use std::sync::Arc;

use serde::{Deserialize, Serialize};
use zelus_core::geometry::mapping::{domain_size, unit_normal};
use zelus_core::geometry::{ExactFacet, FacetShape, Nodal, Shape};
use zelus_core::model::ModelPart;
use zelus_core::vector3::{norm, sub};

use crate::mortar::MOST_NODES;

/// Sides that a facet can be on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Roles {
    /// Carries multipliers.
    Slave,
    /// Is touched.
    Master,
    /// Either, to be decided by each search (self contact).
    Open,
}

/// Where a facet comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FacetSource {
    /// A condition of the mesh, by its index.
    Condition(u32),
    /// A face of an element, by the index of the element.
    Face(u32),
    /// A condition of a rigid shape, by its index: there is no element.
    Rigid(u32),
}

/// A facet of a contact surface; its nodes go round so that the normal points out of the body.
#[derive(Debug, Clone, PartialEq)]
pub struct Facet {
    /// Node indices.
    pub nodes: Vec<u32>,
    /// One that carries contact.
    pub shape: Shape,
    /// The condition or element face that it is made of.
    pub source: FacetSource,
    /// Index of the element whose face it is; without meaning for one of a rigid shape.
    pub element: u32,
    /// Properties id with the elastic constants of the body.
    pub properties: usize,
    /// Its side.
    pub role: Roles,
    /// The surface of a rigid shape that it stands for, and the node of its apex; `None` for all that are flat.
    pub exact: Option<Arc<(ExactFacet, u32)>>,
}

/// Positions of the nodes of a facet.
pub struct Positions {
    places: [[f64; 3]; MOST_NODES],
    count: usize,
}

impl Deref for Positions {
    type Target = [[f64; 3]];

    fn deref(&self) -> &[[f64; 3]] {
        &self.places[..self.count]
    }
}

impl Facet {
    /// Present positions of its nodes.
    pub fn positions(&self, part: &ModelPart) -> Positions {
        let mut places = [[0.0; 3]; MOST_NODES];
        places.iter_mut().zip(&self.nodes).for_each(|(place, &node)| *place = part.nodes.current[node as usize]);
        Positions { places, count: self.nodes.len() }
    }

    /// Its nodes and, where it stands for an exact surface, the apex.
    pub fn nodes_with_apex(&self) -> impl Iterator<Item = u32> {
        self.nodes.iter().copied().chain(self.exact.as_ref().map(|exact| exact.1))
    }

    /// Its facts for code over facets of contact, with an apex where it has one; `None` where it carries no contact.
    pub fn facet_shape(&self) -> Option<&'static FacetShape> {
        let flat = FacetShape::of(self.shape)?;
        if self.exact.is_some() { flat.and_apex() } else { Some(flat) }
    }

    /// The exact surface.
    pub fn exact_facet(&self) -> Option<ExactFacet> {
        self.exact.as_ref().map(|exact| exact.0)
    }

    /// Whether it belongs to a rigid shape.
    pub fn is_rigid(&self) -> bool {
        matches!(self.source, FacetSource::Rigid(_))
    }

    /// Present positions of its nodes and of its apex.
    pub fn positions_with_apex(&self, part: &ModelPart) -> Nodal<[f64; 3]> {
        let mut nodes = self.nodes_with_apex();
        let count = self.nodes.len() + usize::from(self.exact.is_some());
        Nodal::new(count, |_| nodes.next().map_or([0.0; 3], |node| part.nodes.current[node as usize]))
    }

    /// Its corners, in the order of its nodes.
    pub fn corners(&self) -> &[u32] {
        &self.nodes[..self.shape.cell().corners()]
    }

    /// Unit normal at its centre in the initial configuration, zero when it has no area.
    pub fn initial_normal(&self, part: &ModelPart) -> [f64; 3] {
        let places: Vec<[f64; 3]> = self.nodes.iter().map(|&node| part.nodes.initial[node as usize]).collect();
        self.normal_at(&places)
    }

    /// Unit normal at its centre, zero when it has no area.
    pub fn normal(&self, part: &ModelPart) -> [f64; 3] {
        self.normal_at(&self.positions(part))
    }

    /// The same where its nodes are at `places`.
    pub fn normal_at(&self, places: &[[f64; 3]]) -> [f64; 3] {
        unit_normal(self.shape, places, self.shape.cell().centre).unwrap_or([0.0; 3])
    }

    /// The longest way from its first node to another (length).
    pub fn extent(&self, part: &ModelPart) -> f64 {
        let x = self.positions(part);
        x.iter().map(|y| norm(sub(*y, x[0]))).fold(0.0, f64::max)
    }

    /// Its length or area.
    pub fn size(&self, part: &ModelPart) -> f64 {
        domain_size(self.shape, &self.positions(part))
    }
}
