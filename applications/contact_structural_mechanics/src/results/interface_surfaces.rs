//! Surfaces of interfaces for results, with the columns of their slave nodes.
//!
//! A point of a surface is a slave node: where several stand at a mesh node, each shows its own normal, multiplier and state.

use zelus_core::model::flags::ACTIVE;
use zelus_core::model::{ColumnType, Fields, InterfaceSurface, ModelPart, Variable};
use zelus_structural_mechanics::variables::NORMAL;

use super::nodal_results::{damage, pressure, slip, status, traction};
use super::pair_states::{PartsOfPairs, name};
use crate::flags::SLIP;
use crate::interface::{Interface, Patches, SlaveIndex};
use crate::law::Multiplier;
use crate::pairs::Formulation;
use crate::slave_nodes::{SlaveState, SlaveStates};
use crate::variables::{
    AUGMENTED_NORMAL_CONTACT_PRESSURE, AUGMENTED_TANGENT_CONTACT_PRESSURE, COHESIVE_DAMAGE, CONTACT_GAP,
    CONTACT_PRESSURE, CONTACT_SLIP, CONTACT_STATUS, CONTACT_TRACTION, NODAL_AREA, NORMAL_GAP, TANGENT_XI, WEIGHTED_GAP,
    WEIGHTED_SLIP,
};

/// The surfaces of the interfaces of an interaction in the data of a model part.
#[derive(Default)]
pub(crate) struct InterfaceSurfaces {
    /// Place of the first among those of the model part.
    first: usize,
    /// Points of each: slave nodes, ascending.
    points: Vec<Vec<SlaveIndex>>,
}

/// Columns of slave nodes of a tie, by their places.
pub(crate) struct TiedColumns<'a> {
    /// The multipliers.
    pub multiplier: Multiplier,
    /// Owners of the multipliers.
    pub owners: &'a [u32],
    /// Unit normals out of the slave body.
    pub normals: &'a [[f64; 3]],
    /// Areas that belong to slave nodes (length in the plane).
    pub areas: &'a [f64],
    /// Whether the tie holds.
    pub holds: bool,
}

impl InterfaceSurfaces {
    /// Adds a surface to the model part for each interface: its facets that are slaves or may become slaves. Names are `kind` with the
    /// name of the pair.
    pub(crate) fn add(
        part: &mut ModelPart,
        kind: &str,
        interfaces: &[Interface],
        patches: &Patches,
        parts: PartsOfPairs<'_>,
    ) -> Self {
        let first = part.interface_surfaces.len();
        let mut all = Vec::new();
        for (at, interface) in interfaces.iter().enumerate() {
            let facets = || {
                let own = interface.facets.iter().enumerate();
                let with_points =
                    own.map(|(f, facet)| (facet.shape, patches.of_facet(at as u32, f as u32, facet.nodes.len())));
                with_points.filter(|(_, points)| !points.is_empty())
            };
            let mut points: Vec<SlaveIndex> = facets().flat_map(|(_, points)| points).copied().collect();
            points.sort_unstable();
            points.dedup();
            let places: Vec<(u32, u32)> =
                points.iter().map(|&slave| (patches.mesh_node(slave), patches.patch(slave))).collect();
            let mut surface = InterfaceSurface::new(format!("{kind} {}", name(&interface.key, parts)), &places);
            let place = |slave: &SlaveIndex| points.binary_search(slave).expect("a point of the surface") as u32;
            facets().for_each(|(shape, own)| surface.push(shape, own.iter().map(place)));
            part.interface_surfaces.push(surface);
            all.push(points);
        }
        Self { first, points: all }
    }

    /// The surfaces in the model part, each with its slave nodes.
    fn of<'a>(
        &'a self,
        surfaces: &'a mut [InterfaceSurface],
    ) -> impl Iterator<Item = (&'a mut InterfaceSurface, &'a [SlaveIndex])> {
        surfaces[self.first..].iter_mut().zip(self.points.iter().map(Vec::as_slice))
    }

    /// Writes the columns of the slave nodes of contact. In self contact those that are on no slave facet now have the status -1, and zeros
    /// besides.
    pub(crate) fn write_states(&self, part: &mut ModelPart, states: &SlaveStates, formulation: &Formulation) {
        let ModelPart { interface_surfaces, slave_nodes, .. } = part;
        let (frictional, slaves) = (formulation.frictional(), states.slaves());
        for (InterfaceSurface { values, flags, .. }, points) in self.of(interface_surfaces) {
            let own = || points.iter().map(|&slave| (slaves.binary_search(&slave).is_ok(), &states[slave]));
            put(values, &CONTACT_STATUS, own().map(|(is, state)| [if is { status(state, frictional) } else { -1.0 }]));
            put(values, &NORMAL, own().map(|(_, state)| state.kinematics.normal));
            scalars(values, &NODAL_AREA, own(), |state| state.kinematics.area);
            scalars(values, &WEIGHTED_GAP, own(), |state| state.kinematics.weighted_gap);
            scalars(values, &NORMAL_GAP, own(), |state| state.kinematics.start_gap);
            scalars(values, &CONTACT_GAP, own(), |state| state.gap().unwrap_or(0.0));
            scalars(values, &CONTACT_PRESSURE, own(), pressure);
            scalars(values, &AUGMENTED_NORMAL_CONTACT_PRESSURE, own(), |state| state.law.pressure);
            vectors(values, &CONTACT_TRACTION, own(), |state| traction(state, frictional));
            if frictional {
                vectors(values, &WEIGHTED_SLIP, own(), |state| state.kinematics.weighted_slip);
                vectors(values, &CONTACT_SLIP, own(), slip);
                vectors(values, &TANGENT_XI, own(), |state| state.law.tangent);
                vectors(values, &AUGMENTED_TANGENT_CONTACT_PRESSURE, own(), |state| state.law.traction);
            }
            if states.shows_damage() {
                put(values, &COHESIVE_DAMAGE, points.iter().map(|&slave| [damage(states, slave)]));
            }
            let multiplier = formulation.multiplier;
            put_multiplier(values, multiplier, points.iter().map(|&p| multiplier.value(slave_nodes, states.owner(p))));
            for (at, (is_slave, state)) in own().enumerate() {
                flags.set(ACTIVE, at, is_slave && state.law.active);
                match state.law.slides.filter(|_| is_slave) {
                    Some(slides) => flags.set(SLIP, at, slides),
                    None => flags.undefine(SLIP, at),
                }
            }
        }
    }

    /// Writes the columns of the slave nodes of a tie.
    pub(crate) fn write_ties(&self, part: &mut ModelPart, columns: &TiedColumns<'_>) {
        let ModelPart { interface_surfaces, slave_nodes, .. } = part;
        for (InterfaceSurface { values, flags, .. }, points) in self.of(interface_surfaces) {
            put(values, &NORMAL, points.iter().map(|slave| columns.normals[slave.place()]));
            put(values, &NODAL_AREA, points.iter().map(|slave| [columns.areas[slave.place()]]));
            let value = |slave: &SlaveIndex| columns.multiplier.value(slave_nodes, columns.owners[slave.place()]);
            put_multiplier(values, columns.multiplier, points.iter().map(value));
            (0..points.len()).for_each(|at| flags.set(ACTIVE, at, columns.holds));
        }
    }
}

/// Writes a column of scalars of slave nodes, and 0 where they are on no slave facet.
fn scalars<'a>(
    values: &mut Fields,
    variable: &Variable<f64>,
    points: impl Iterator<Item = (bool, &'a SlaveState)>,
    of: impl Fn(&SlaveState) -> f64,
) {
    put(values, variable, points.map(|(is_slave, state)| [if is_slave { of(state) } else { 0.0 }]));
}

/// The same of vectors.
fn vectors<'a>(
    values: &mut Fields,
    variable: &Variable<[f64; 3]>,
    points: impl Iterator<Item = (bool, &'a SlaveState)>,
    of: impl Fn(&SlaveState) -> [f64; 3],
) {
    put(values, variable, points.map(|(is_slave, state)| if is_slave { of(state) } else { [0.0; 3] }));
}

fn put<T: ColumnType, const C: usize>(
    values: &mut Fields,
    variable: &Variable<T>,
    rows: impl Iterator<Item = [f64; C]>,
) {
    values.values_mut(variable, 0).as_chunks_mut().0.iter_mut().zip(rows).for_each(|(own, row)| *own = row);
}

/// Writes the column of multipliers, of which scalar ones are in the first component.
fn put_multiplier(values: &mut Fields, multiplier: Multiplier, rows: impl Iterator<Item = [f64; 3]>) {
    match multiplier {
        Multiplier::None | Multiplier::Body => {}
        Multiplier::Scalar(variable) => put(values, variable, rows.map(|[value, ..]| [value])),
        Multiplier::Vector(variable) => put(values, variable, rows),
    }
}
