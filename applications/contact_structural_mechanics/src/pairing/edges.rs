//! Normals of slave nodes on rims of patches and on sharp edges.
//!
//! An edge or a corner of a body that is pressed on a surface has no normal of its own: the force acts along the normal of the
//! surface it lies on. Slave nodes where their patch ends at an edge of the body, unless a facet there is in contact beside
//! the edge, and those on sharp folds within a patch take the normal of the master that they overlap, turned round, once it
//! differs from that of their facets.

use zelus_core::geometry::mapping::unit_normal;
use zelus_core::model::ModelPart;
use zelus_core::vector3::{add, dot, norm, scale};

use super::pairs_of_interfaces::Pairing;
use crate::interface::SlaveIndex;
use crate::slave_nodes::{SlaveStates, SlaveSums, Summands};

/// Cosine of the angle between a facet and the mean normal of its node, beyond which the node is on a sharp fold: 35°.
pub(crate) const SHARP: f64 = 0.82;
/// Angle between the facets of a rim and the master, in radians, up to which both lie flat on each other: strains and coarse facets
/// tilt faces that press by less.
pub(crate) const FLAT: f64 = 0.05;
/// Cosine of the angle between two normals up to which they are one direction.
const SAME: f64 = 0.9;
/// Length of the mean of unit normals of masters below which they have no normal in common.
pub(crate) const NO_COMMON_NORMAL: f64 = 0.1;

/// Gives slave nodes on rims and sharp folds the normal of the master that they overlap. Collective.
///
/// `on_plane` says which mesh nodes lie on planes of symmetry, where a patch ends and its body does not.
pub(crate) fn take_normals_of_masters(
    part: &ModelPart,
    states: &mut SlaveStates,
    pairing: &Pairing,
    on_plane: &dyn Fn(u32) -> bool,
) {
    states.for_all(|state| state.kinematics.normal_of_master = false);
    let rims = open_rims(states, pairing, on_plane);
    for (slave, sum, area) in opposite_normals(part, states, pairing, &rims) {
        let size = norm(sum);
        if size < NO_COMMON_NORMAL * area {
            continue;
        }
        let normal = scale(sum, 1.0 / size);
        let state = &mut states[slave];
        let is_flat = dot(normal, state.kinematics.normal) > FLAT.cos();
        if !is_flat {
            (state.kinematics.normal, state.kinematics.normal_of_master) = (normal, true);
        }
    }
}

/// Marks of the slave nodes at edges of their body that may press as an edge: no facet around them is in contact with all of
/// its nodes, or with one beside the edge.
fn open_rims(states: &SlaveStates, pairing: &Pairing, on_plane: &dyn Fn(u32) -> bool) -> Vec<bool> {
    let patches = &pairing.patches;
    let mut closed = vec![false; states.len()];
    for (i, interface) in pairing.interfaces.iter().enumerate() {
        for (f, facet) in interface.facets.iter().enumerate() {
            let own = patches.of_facet(i as u32, f as u32, facet.nodes.len());
            let inner = own.iter().any(|&slave| states[slave].law.active && !patches.is_rim(slave));
            if inner || own.iter().all(|&slave| states[slave].law.active) {
                own.iter().for_each(|slave| closed[slave.place()] = true);
            }
        }
    }
    let is_open_rim =
        |slave: SlaveIndex| patches.is_rim(slave) && !on_plane(patches.mesh_node(slave)) && !closed[slave.place()];
    patches.all().map(is_open_rim).collect()
}

/// Isolates slave nodes that share their mesh node and the normal of a master with another that is in contact or has the larger area: two
/// multipliers of one direction are a null mode.
pub(crate) fn keep_one_of_a_normal(states: &mut SlaveStates) {
    let facing: Vec<SlaveIndex> = states.all().filter(|&slave| !states[slave].kinematics.isolated).collect();
    let is_less = |&slave: &SlaveIndex| {
        let own = &states[slave];
        let others =
            states.at(states.mesh_node(slave)).filter(|&other| other != slave && !states[other].kinematics.isolated);
        own.kinematics.normal_of_master
            && others.into_iter().any(|other| {
                let order = states[other]
                    .law
                    .active
                    .cmp(&own.law.active)
                    .then(states[other].kinematics.area.total_cmp(&own.kinematics.area));
                order.then(slave.cmp(&other)).is_gt()
                    && dot(states[other].kinematics.normal, own.kinematics.normal) > SAME
            })
    };
    let less: Vec<SlaveIndex> = facing.into_iter().filter(is_less).collect();
    less.into_iter().for_each(|slave| states[slave].kinematics.isolated = true);
}

/// Sum of the normals into the masters that a slave node overlaps, by area, and the sum of the areas.
#[derive(Clone, Copy, Default)]
struct FacedNormals {
    normal: [f64; 3],
    area: f64,
}

impl Summands<4> for FacedNormals {
    fn numbers(&self) -> [f64; 4] {
        let [x, y, z] = self.normal;
        [x, y, z, self.area]
    }

    fn of([x, y, z, area]: [f64; 4]) -> Self {
        Self { normal: [x, y, z], area }
    }
}

/// Sums of the normals into the masters that slave nodes on rims and sharp folds overlap, by their areas, and the areas. Collective.
fn opposite_normals(
    part: &ModelPart,
    states: &SlaveStates,
    pairing: &Pairing,
    rims: &[bool],
) -> Vec<(SlaveIndex, [f64; 3], f64)> {
    let mut wanted = rims.to_vec();
    for (i, interface) in pairing.interfaces.iter().enumerate() {
        for (f, facet) in interface.facets.iter().enumerate() {
            let points = facet.positions(part);
            for (local, &slave) in pairing.patches.of_facet(i as u32, f as u32, facet.nodes.len()).iter().enumerate() {
                let own = unit_normal(facet.shape, &points, facet.shape.cell().points[local]);
                wanted[slave.place()] |= own.is_some_and(|own| dot(own, states[slave].kinematics.normal) < SHARP);
            }
        }
    }
    if !wanted.contains(&true) {
        return Vec::new();
    }
    let mut sums = SlaveSums::<FacedNormals>::new(states);
    for pair in pairing.blocks.iter().flat_map(|block| block.pairs()).filter(|pair| pair.overlapping) {
        let into = scale(pairing.master(pair.key).normal(part), -1.0);
        for (local, &slave) in pairing.slaves_of_pair(pair.key).iter().enumerate().filter(|(_, s)| wanted[s.place()]) {
            // A rank knows the areas of the pairs that it evaluates.
            let area = pair.area[local].abs();
            let sum = &mut sums[slave];
            (sum.normal, sum.area) = (add(sum.normal, scale(into, area)), sum.area + area);
        }
    }
    sums.over_ranks(part, states);
    let found = pairing.patches.all().filter(|slave| wanted[slave.place()]).map(|slave| (slave, sums[slave]));
    found.filter(|(_, sum)| sum.area > 0.0).map(|(slave, sum)| (slave, sum.normal, sum.area)).collect()
}
