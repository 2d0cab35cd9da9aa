//! Supports of slave nodes together with the master surface opposite them, and the constrained multipliers there.

use std::collections::{BTreeMap, BTreeSet};

use serde::{Deserialize, Serialize};
use zelus_core::Result;
use zelus_core::StateMapper;
use zelus_core::diagnostics::Diagnostic;
use zelus_core::geometry::mapping::local_coordinates;
use zelus_core::geometry::shape_functions;
use zelus_core::model::ModelPart;
use zelus_core::vector3::{add, dot, norm, scale, sub};
use zelus_structural_mechanics::variables::DISPLACEMENT;

use crate::interface::{
    Facet, Fixed, FixedDirections, Interface, SlaveIndex, check_nodes, fixed_directions, symmetry_planes,
};
use crate::law::constrained_multiplier::free_normal;
use crate::law::{MultiplierConstraint, MultiplierConstraints, SupportAxes};
use crate::mortar::MOST_NODES;
use crate::pairs::{Formulation, Multiplier};
use crate::slave_nodes::SlaveStates;

/// Share of a master facet by which a node may lie beyond its edge and still face it.
const OVERHANG: f64 = 0.02;
/// Shape functions up to this are those of nodes on the other side of an edge.
const NO_SHARE: f64 = 1e-3;
/// Cosine of the angle between normals beyond which a node is not moved along its own to the master.
const LEAST_SLOPE: f64 = 0.1;
/// Difference of prescribed motions, over their size, from which on they move a contact.
const SAME_MOTION: f64 = 1e-9;

/// Nodes that supports hold, and whether they have been reported.
#[derive(Clone, Default, Serialize, Deserialize)]
pub(crate) struct SupportedNodes {
    fixed: BTreeMap<u32, FixedDirections>,
    planes: BTreeMap<u32, FixedDirections>,
    said: bool,
}

/// A pair, as the treatment of supports needs it.
#[derive(Clone, Copy)]
pub(crate) struct FacetsOfPair<'a> {
    /// The slave facet.
    pub slave: &'a Facet,
    /// Its slave nodes, in the order of its nodes.
    pub slaves: &'a [SlaveIndex],
    /// The master facet.
    pub master: &'a Facet,
}

/// A slave node that supports hold together with the opposite master.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SupportedNode {
    /// Axes of the node's supports.
    pub axes: SupportAxes,
    /// Components along them in which both sides are fixed.
    pub components: Fixed,
    /// Whether supports move both sides apart in one of them.
    pub moves: bool,
    /// Whether the supports are planes of symmetry.
    pub symmetric: bool,
}

impl SupportedNode {
    /// Whether both sides are fixed along an axis.
    pub(crate) fn fixes(&self, axes: SupportAxes, c: usize) -> bool {
        if self.axes == axes {
            return self.components[c];
        }
        FixedDirections { axes: self.axes, fixed: self.components }.holds(axes.0[c])
    }
}

impl SupportedNodes {
    /// Whether it can be that of as many nodes.
    ///
    /// # Errors
    /// Others.
    pub(crate) fn check(&self, nodes: usize) -> Result<()> {
        check_nodes(nodes, self.fixed.keys().chain(self.planes.keys()).copied())
    }

    /// See [`State::remap`](zelus_core::State::remap).
    pub(crate) fn remap(&mut self, mapper: &mut dyn StateMapper) {
        mapper.node_map(&mut self.fixed);
        mapper.node_map(&mut self.planes);
    }

    /// Step start: finds the fixed directions, and the planes of symmetry among them.
    pub(crate) fn begin_step(&mut self, part: &ModelPart, interfaces: &[Interface]) {
        self.fixed = fixed_directions(part, interfaces);
        self.planes = symmetry_planes(part, interfaces, &self.fixed);
    }

    /// Directions that the normals of nodes on planes of symmetry lack.
    pub(crate) fn planes(&self) -> &BTreeMap<u32, FixedDirections> {
        &self.planes
    }

    /// Whether an interface node is fixed along a unit vector.
    pub(crate) fn fixes(&self, node: u32, direction: [f64; 3]) -> bool {
        self.fixed.get(&node).is_some_and(|own| own.holds(direction))
    }

    /// The supported slave nodes of these pairs; `normal` is that of a slave node.
    pub(crate) fn nodes<'a>(
        &self,
        part: &ModelPart,
        normal: &dyn Fn(SlaveIndex) -> [f64; 3],
        pairs: impl Iterator<Item = FacetsOfPair<'a>>,
    ) -> BTreeMap<SlaveIndex, SupportedNode> {
        // Of each node the image on the master that lies least beside a facet, then the nearest.
        let mut faced: BTreeMap<SlaveIndex, ([f64; 2], SupportedNode)> = BTreeMap::new();
        for FacetsOfPair { slave, slaves, master } in pairs {
            let own = slave.nodes.iter().zip(slaves).filter(|(node, _)| self.fixed.contains_key(node));
            for (&node, &at) in own {
                let points = master.positions(part);
                let foot = foot(part, node, normal(at), master, &points);
                let Some(image) = local_coordinates(master.shape, &points, foot) else { continue };
                // Shape functions of its corners, which are positive all over a facet of second order, too.
                let mut shares = [0.0; MOST_NODES];
                let linear = master.shape.linear();
                shape_functions(linear, image.xi, &mut shares[..linear.nodes()]);
                let beside = shares.iter().fold(0.0_f64, |most, share| most.max(-share));
                let distance = norm(sub(foot, part.nodes.current[node as usize])) + image.distance;
                let place = [if beside > OVERHANG { beside } else { 0.0 }, distance];
                if beside <= OVERHANG && faced.get(&at).is_none_or(|(known, _)| place < *known) {
                    faced.insert(at, (place, self.supported_node(part, node, master, &shares)));
                }
            }
        }
        faced
            .into_iter()
            .map(|(node, (_, supported))| (node, supported))
            .filter(|(_, h)| h.components.contains(&true))
            .collect()
    }

    fn supported_node(&self, part: &ModelPart, node: u32, master: &Facet, shares: &[f64]) -> SupportedNode {
        let own = self.fixed[&node];
        let weights = || master.nodes.iter().zip(shares).filter(|(_, share)| **share > NO_SHARE);
        let faced_too = |c: usize| weights().all(|(&faced, _)| self.fixes(faced, own.axes.0[c]));
        let components = std::array::from_fn(|c| own.fixed[c] && faced_too(c));
        let field = part.nodes.history.get(DISPLACEMENT.name());
        let motion = |n: u32| {
            field.map_or([0.0; 3], |u| sub(u.vector(0, n as usize), u.vector(1.min(u.levels.len() - 1), n as usize)))
        };
        let total: f64 = weights().map(|(_, share)| share).sum();
        let faced = weights().fold([0.0; 3], |sum, (&n, share)| add(sum, scale(motion(n), share / total)));
        let (apart, size) = (sub(motion(node), faced), norm(motion(node)).max(norm(faced)));
        let moves = |c: usize| own.axes.component(c, apart).abs() > SAME_MOTION * size;
        SupportedNode {
            axes: own.axes,
            components,
            moves: (0..3).any(|c| components[c] && moves(c)),
            symmetric: self.planes.contains_key(&node),
        }
    }

    /// Decides the constrained multipliers of the slave nodes by this formulation; returns the note about them.
    pub(crate) fn constrain<'a>(
        &mut self,
        part: &ModelPart,
        states: &mut SlaveStates,
        formulation: &Formulation,
        pairs: impl Iterator<Item = FacetsOfPair<'a>> + Clone,
    ) -> Option<Diagnostic> {
        states.for_all(|state| state.law.constraints = MultiplierConstraints::default());
        let supported = if formulation.multiplier.is_unknown() {
            self.nodes(part, &|slave| states[slave].kinematics.normal, pairs.clone())
        } else {
            BTreeMap::new()
        };
        let followed = followed(&supported, pairs.clone().map(|pair| pair.slaves));
        let resting = self.resting(&supported, pairs);
        let mut dropped = BTreeMap::new();
        for (&node, own) in &supported {
            let normal = states[node].kinematics.normal;
            let rule = |c: usize| match () {
                () if !own.components[c] => MultiplierConstraint::Free,
                () if own.moves => MultiplierConstraint::ConstantInStick,
                () if own.symmetric => MultiplierConstraint::Constant,
                () if followed.contains(&(node, c)) => MultiplierConstraint::Crosspoint,
                () if resting[&node][c] => MultiplierConstraint::Constant,
                () => MultiplierConstraint::Free,
            };
            let whole = MultiplierConstraints { rules: std::array::from_fn(rule), axes: own.axes };
            let constrained_normal = free_normal(normal, whole) == [0.0; 3] && whole.any_still();
            let constraints = match formulation.multiplier {
                Multiplier::Vector(_) if formulation.frictional() || constrained_normal => whole,
                Multiplier::Scalar(_) if constrained_normal => {
                    // Along the normal alone.
                    let normal = own.axes.components(normal);
                    let most = (0..3).max_by(|&a, &b| normal[a].abs().total_cmp(&normal[b].abs())).unwrap_or(0);
                    let rules = [whole.rules[most], MultiplierConstraint::Free, MultiplierConstraint::Free];
                    MultiplierConstraints { rules, axes: SupportAxes::default() }
                }
                _ => continue,
            };
            states[node].law.constraints = constraints;
            let still = constraints.rules.map(MultiplierConstraint::is_still);
            dropped.insert(states.mesh_node(node), FixedDirections { axes: constraints.axes, fixed: still });
        }
        let scalar = matches!(formulation.multiplier, Multiplier::Scalar(_));
        self.say(part, &dropped, scalar)
    }

    /// Components along the axes of supported nodes in which nothing that they face can move.
    fn resting<'a>(
        &self,
        supported: &BTreeMap<SlaveIndex, SupportedNode>,
        pairs: impl Iterator<Item = FacetsOfPair<'a>>,
    ) -> BTreeMap<SlaveIndex, Fixed> {
        let mut out: BTreeMap<SlaveIndex, Fixed> = BTreeMap::new();
        for FacetsOfPair { slaves, master, .. } in pairs {
            for &slave in slaves {
                let Some(SupportedNode { axes, .. }) = supported.get(&slave) else { continue };
                let own = out.entry(slave).or_insert([true; 3]);
                (0..3).for_each(|c| own[c] &= master.nodes.iter().all(|&node| self.fixes(node, axes.0[c])));
            }
        }
        out
    }

    /// Says once a run how many multipliers have no equation.
    pub(crate) fn say(
        &mut self,
        part: &ModelPart,
        dropped: &BTreeMap<u32, FixedDirections>,
        along_normals: bool,
    ) -> Option<Diagnostic> {
        let count = dropped.values().filter(|own| own.fixed.contains(&true)).count();
        if count == 0 || std::mem::replace(&mut self.said, true) {
            return None;
        }
        let is_global = |own: &&FixedDirections| own.axes == SupportAxes::default();
        let others = dropped.values().filter(|own| !is_global(own) && own.fixed.contains(&true)).count();
        let along: Vec<String> = (0..3)
            .map(|c| (["x", "y", "z"][c], dropped.values().filter(is_global).filter(|own| own.fixed[c]).count()))
            .chain([("directions of supports", others)])
            .filter(|(_, count)| *count > 0)
            .map(|(name, count)| format!("{count} along {name}"))
            .collect();
        let along = if along_normals { "along their normals".to_owned() } else { along.join(", ") };
        let ids: Vec<String> = dropped.keys().take(5).map(|&n| part.nodes.ids[n as usize].to_string()).collect();
        let word = if count == 1 { "node" } else { "nodes" };
        let fact = format!(
            "supports fix {count} slave {word} and the opposite surface alike: multipliers without influence are \
             constrained, {along}; {word} {}{}",
            ids.join(" "),
            if count > ids.len() { " …" } else { "" }
        );
        Some(Diagnostic::note("held-multipliers", fact))
    }
}

/// Where a slave node meets the plane of a master along its own normal, which lies in planes of symmetry: across a gap or a
/// penetration the point nearest to it would not. The node itself where the facets hardly face each other.
fn foot(part: &ModelPart, node: u32, normal: [f64; 3], master: &Facet, points: &[[f64; 3]]) -> [f64; 3] {
    let at = part.nodes.current[node as usize];
    let across = master.normal_at(points);
    match dot(normal, across) {
        slope if slope < -LEAST_SLOPE => add(at, scale(normal, dot(sub(points[0], at), across) / slope)),
        _ => at,
    }
}

/// The components of supported nodes along which some node of their facets is free.
fn followed<'a>(
    supported: &BTreeMap<SlaveIndex, SupportedNode>,
    facets: impl Iterator<Item = &'a [SlaveIndex]>,
) -> BTreeSet<(SlaveIndex, usize)> {
    let mut found = BTreeSet::new();
    for slaves in facets {
        for &node in slaves {
            let Some(own) = supported.get(&node) else { continue };
            for c in (0..3).filter(|&c| own.components[c]) {
                if slaves.iter().any(|other| !supported.get(other).is_some_and(|other| other.fixes(own.axes, c))) {
                    found.insert((node, c));
                }
            }
        }
    }
    found
}
