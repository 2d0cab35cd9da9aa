//! The facets of a contact interface, from the parts a deck names or from the skin of the bodies.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use rustc_hash::FxHashMap;
use zelus_core::Result;
use zelus_core::diagnostics::{Diagnostic, Report, counted, unfit};
use zelus_core::geometry::mapping::{domain_size, unit_normal};
use zelus_core::geometry::{Shape, reversed};
use zelus_core::model::flags::INTERFACE;
use zelus_core::model::{ModelPart, RigidFacet, ScalarVariable, SubPart};
use zelus_core::vector3::{add, dot, norm, scale, sub};
use zelus_structural_mechanics::laws::representative_young;

use super::facet::{Facet, FacetSource, Roles};
use crate::flags::{MASTER, SLAVE};
use crate::mortar::carries_contact;

/// Share of its longest edge, squared in space, below which a facet has no area.
const LEAST_AREA: f64 = 1e-13;

/// The facets of one contact pair of a deck (one key).
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Interface {
    /// The key, `"0"` to `"9"` and beyond.
    pub key: String,
    /// All facets.
    pub facets: Vec<Facet>,
    /// Nodes of all facets, ascending.
    pub nodes: Vec<u32>,
    /// Whether each search decides the roles (self contact): the deck names no slave side.
    pub open: bool,
}

/// The sides of all facets.
pub fn sides(interfaces: &[Interface]) -> Vec<Vec<Roles>> {
    interfaces.iter().map(|interface| interface.facets.iter().map(|facet| facet.role).collect()).collect()
}

/// Gives the facets the sides that [`sides`] told of them.
///
/// # Errors
/// Sides of other facets.
pub fn set_sides(interfaces: &mut [Interface], sides: Vec<Vec<Roles>>) -> Result<()> {
    let counts = interfaces.iter().map(|interface| interface.facets.len());
    let changes = |(interface, sides): (&Interface, &Vec<Roles>)| {
        interface.open || interface.facets.iter().map(|facet| facet.role).eq(sides.iter().copied())
    };
    if !counts.eq(sides.iter().map(Vec::len)) || !interfaces.iter().zip(&sides).all(changes) {
        return Err(unfit("the sides of contact that it remembers are of other facets"));
    }
    for (interface, sides) in interfaces.iter_mut().zip(sides) {
        interface.facets.iter_mut().zip(sides).for_each(|(facet, side)| facet.role = side);
    }
    Ok(())
}

/// Whether there are such nodes.
///
/// # Errors
/// One that is not.
pub fn check_nodes(count: usize, mut nodes: impl Iterator<Item = u32>) -> Result<()> {
    if nodes.all(|node| (node as usize) < count) {
        Ok(())
    } else {
        Err(unfit("contact remembers something of nodes that are not there"))
    }
}

impl Interface {
    /// Nodes that may carry multipliers, ascending: those of slaves, or all of an open interface.
    pub fn dof_owners(&self) -> Vec<u32> {
        if self.open { self.nodes.clone() } else { self.nodes_of(Roles::Slave) }
    }

    /// Nodes of the facets of one role, ascending.
    pub fn nodes_of(&self, role: Roles) -> Vec<u32> {
        let mut nodes: Vec<u32> =
            self.facets.iter().filter(|f| f.role == role).flat_map(|f| f.nodes.iter().copied()).collect();
        nodes.sort_unstable();
        nodes.dedup();
        nodes
    }

    /// Nodes of the facets of one role, ascending, with the unit mean of their facets' normals.
    pub fn normals_of(&self, part: &ModelPart, role: Roles) -> Vec<(u32, [f64; 3])> {
        let nodes = self.nodes_of(role);
        let mut sums = vec![[0.0; 3]; nodes.len()];
        for facet in self.facets.iter().filter(|facet| facet.role == role) {
            let normal = facet.normal(part);
            for node in &facet.nodes {
                let at = nodes.binary_search(node).expect("a node of a facet of this role");
                sums[at] = add(sums[at], normal);
            }
        }
        nodes.into_iter().zip(sums).map(|(node, sum)| (node, scale(sum, norm(sum).recip()))).collect()
    }
}

/// Nodes of all slave facets, ascending.
pub fn slave_nodes(interfaces: &[Interface]) -> Vec<u32> {
    let mut nodes: Vec<u32> = interfaces.iter().flat_map(|interface| interface.nodes_of(Roles::Slave)).collect();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

/// A face of an element.
struct ElementFace {
    element: u32,
    /// In the element's order.
    nodes: Vec<u32>,
    shape: Shape,
    /// How many elements have it.
    shared: usize,
}

/// Faces of elements by their sorted nodes.
type Faces = FxHashMap<Vec<u32>, ElementFace>;

/// The faces of one element only whose nodes are `wanted`, as facets in the order of the elements' ids.
fn outer_facets(part: &ModelPart, faces: &Faces, wanted: impl Fn(u32) -> bool, found: &mut Vec<Facet>) -> Result<()> {
    let outer = faces.values().filter(|face| face.shared == 1 && face.nodes.iter().all(|&node| wanted(node)));
    let mut outer: Vec<&ElementFace> = outer.collect();
    outer.sort_by_key(|face| (part.elements.ids[face.element as usize], face.nodes.clone()));
    for face in outer {
        found.push(facet(part, face, face.nodes.clone(), FacetSource::Face(face.element))?);
    }
    Ok(())
}

/// Builds the interfaces a deck names: `parts` and `slaves` are its lists of sub parts by key.
///
/// A part with conditions contributes them; one without contributes the element faces whose nodes all belong to it. When
/// no part is named at all, the whole skin is the interface of key "0".
///
/// # Errors
/// Parts that do not exist, interfaces without facets or without slaves.
pub fn interfaces(
    part: &mut ModelPart,
    parts: &BTreeMap<String, Vec<String>>,
    slaves: &BTreeMap<String, Vec<String>>,
) -> Result<Vec<Interface>> {
    check_parts(part, parts, slaves)?;
    if part.info.solver.incomplete {
        return Ok(Vec::new());
    }
    let mut named: Vec<(&String, &Vec<String>)> = parts.iter().filter(|(_, list)| !list.is_empty()).collect();
    let zero = "0".to_owned();
    let whole = Vec::new();
    let skin = named.is_empty();
    if skin {
        named.push((&zero, &whole));
    }
    let faces = boundary_faces(part, &nodes_of_parts(part, named.iter().flat_map(|(_, list)| *list), skin)?);
    let mut out = Vec::new();
    for (key, list) in named {
        let mut found: Vec<Facet> = Vec::new();
        if skin {
            // Where ranks meet, a face may seem to be an outer one.
            outer_facets(part, &faces, |node| part.has_all_at(node as usize), &mut found)?;
        }
        for name in list {
            let sub = part.part(name)?.clone();
            let before = found.len();
            facets_of(part, &sub, &faces, &mut found)?;
            if found.len() == before {
                let fact = format!(
                    "the contact part {name:?} (pair \"{key}\") has no facets: no conditions, and no element has a face in it"
                );
                return Err(Diagnostic::error("empty-contact-part", fact)
                    .remedy("give it the surface conditions, or all nodes of the surface")
                    .into());
            }
        }
        let mut seen = BTreeSet::new();
        found.retain(|f| {
            let mut sorted = f.nodes.clone();
            sorted.sort_unstable();
            seen.insert(sorted)
        });
        let mut nodes: Vec<u32> = found.iter().flat_map(|f| f.nodes.iter().copied()).collect();
        nodes.sort_unstable();
        nodes.dedup();
        for &node in &nodes {
            part.nodes.flags.set(INTERFACE, node as usize, true);
        }
        out.push(Interface { key: key.clone(), facets: found, nodes, open: false });
    }
    assign_roles(part, parts, slaves, &mut out)?;
    Ok(out)
}

/// Refuses parts that are not there.
///
/// # Errors
/// All of them.
pub fn check_parts(
    part: &ModelPart,
    parts: &BTreeMap<String, Vec<String>>,
    slaves: &BTreeMap<String, Vec<String>>,
) -> Result<()> {
    let mut problems = Report::new();
    for name in parts.values().chain(slaves.values()).flatten() {
        problems.absorb(part.part(name));
    }
    problems.finish().map(|_| ())
}

fn assign_roles(
    part: &mut ModelPart,
    parts: &BTreeMap<String, Vec<String>>,
    slaves: &BTreeMap<String, Vec<String>>,
    interfaces: &mut [Interface],
) -> Result<()> {
    for interface in interfaces {
        let Some(list) = slaves.get(&interface.key).filter(|list| !list.is_empty()) else {
            if interface.facets.iter().any(Facet::is_rigid) {
                let fact = format!("contact pair \"{}\" has a rigid shape and names no slave side", interface.key);
                let remedy =
                    "name the surfaces of the deformable bodies in \"assume_master_slave\": a rigid shape is a master";
                return Err(Diagnostic::error("rigid-shape-sides", fact).remedy(remedy).into());
            }
            interface.open = true;
            continue;
        };
        for &node in &interface.nodes {
            part.nodes.flags.set(MASTER, node as usize, true);
            part.nodes.flags.set(SLAVE, node as usize, false);
        }
        for name in list {
            let nodes = part.part(name)?.nodes.clone();
            for node in nodes {
                part.nodes.flags.set(SLAVE, node as usize, true);
                part.nodes.flags.set(MASTER, node as usize, false);
            }
        }
        for facet in &mut interface.facets {
            let slave = facet.nodes.iter().all(|&n| part.nodes.flags.is(SLAVE, n as usize));
            facet.role = if slave { Roles::Slave } else { Roles::Master };
        }
        if interface.facets.iter().any(|facet| facet.is_rigid() && facet.role == Roles::Slave) {
            let fact =
                format!("{} of contact pair \"{}\" is a rigid shape on the slave side", list.join(", "), interface.key);
            let remedy =
                "name the surface of the deformable body in \"assume_master_slave\": a rigid shape is a master";
            return Err(Diagnostic::error("rigid-shape-sides", fact).remedy(remedy).into());
        }
        for (role, word) in [(Roles::Slave, "slave"), (Roles::Master, "master")] {
            if !interface.facets.iter().any(|f| f.role == role) {
                let whole = parts.get(&interface.key).map(|names| names.join(", ")).unwrap_or_default();
                let fact = format!(
                    "contact pair \"{}\" has no {word} facets: {} is the slave side of {whole}",
                    interface.key,
                    list.join(", ")
                );
                let remedy = "\"assume_master_slave\" names the parts on the slave side; \"contact_model_part\" must hold both sides";
                return Err(Diagnostic::error("empty-contact-side", fact).remedy(remedy).into());
            }
        }
    }
    Ok(())
}

/// Notes on contact parts that hold elements: their whole skin is taken, or the conditions that they hold beside.
pub fn notes_of_bodies(part: &ModelPart, parts: &BTreeMap<String, Vec<String>>) -> Vec<Diagnostic> {
    let mut out = Vec::new();
    if parts.values().all(Vec::is_empty) {
        let fact =
            "no contact part is named: the whole skin of the bodies is taken, and each search decides on the sides";
        let remedy =
            "name the surfaces that may touch in \"contact_model_part\" where that is not meant: it is faster, too";
        out.push(Diagnostic::note("whole-skin", fact).remedy(remedy));
    }
    for (key, name) in parts.iter().flat_map(|(key, list)| list.iter().map(move |name| (key, name))) {
        let Some(own) = part.part(name).ok().filter(|own| !own.elements.is_empty()) else { continue };
        let is_facet = |at: &&u32| part.conditions.kinds[**at as usize].cell.is_some_and(|shape| shape.dim() > 0);
        let conditions = own.conditions.iter().filter(is_facet).count();
        let what = match conditions {
            0 => "its whole skin is taken for contact".to_owned(),
            _ => format!("of its skin the {conditions} conditions in it are taken for contact, loads among them"),
        };
        let fact = format!("contact part {name:?} of pair \"{key}\" holds elements: {what}");
        let remedy = "name a part of the surface that may touch, by its conditions or its nodes";
        out.push(Diagnostic::warning("whole-body", fact).remedy(remedy));
    }
    out
}

/// Nodes that a message names.
const NAMED: usize = 5;

/// Warnings of nodes that are on both sides of a pair: there the bodies are one.
fn shared(part: &ModelPart, interfaces: &[Interface]) -> Vec<Diagnostic> {
    let warning = |interface: &Interface| {
        let mut both = interface.nodes_of(Roles::Slave);
        let masters = interface.nodes_of(Roles::Master);
        both.retain(|node| masters.binary_search(node).is_ok());
        let ids: Vec<String> = both.iter().take(NAMED).map(|&node| part.nodes.ids[node as usize].to_string()).collect();
        let more = if both.len() > NAMED { ", …" } else { "" };
        let fact = format!(
            "{} on both sides of pair \"{}\": {}{more}; the bodies are connected there and cannot separate",
            counted(both.len(), "node is", "nodes are"),
            interface.key,
            ids.join(", ")
        );
        let remedy =
            "give each body nodes of its own, unless it is one that a crack ends in: meshers merge points in one place";
        (!both.is_empty()).then(|| Diagnostic::warning("shared-nodes", fact).remedy(remedy))
    };
    interfaces.iter().filter_map(warning).collect()
}

/// The warning of a tie that these of so many slave nodes face no master.
pub fn slaves_without_master(part: &ModelPart, without: &[u32], all: usize) -> Option<Diagnostic> {
    let first = part.nodes.ids[*without.first()? as usize];
    let fact = format!(
        "{} of {all} slave nodes of the tie face no master and are not tied, the first is node {first}",
        without.len()
    );
    let remedy = "end the slave part where the master ends, or check that both surfaces meet";
    Some(Diagnostic::warning("slaves-not-tied", fact).remedy(remedy))
}

/// Warnings of slaves that no pair has, of nodes on both sides, and of surfaces that are slaves in two pairs.
pub fn warnings_of_pairs(
    part: &ModelPart,
    slaves: &BTreeMap<String, Vec<String>>,
    interfaces: &[Interface],
) -> Vec<Diagnostic> {
    let mut out = Vec::new();
    let is_pair = |key: &String| interfaces.iter().any(|interface| interface.key == *key);
    for (key, list) in slaves.iter().filter(|(key, list)| !list.is_empty() && !is_pair(key)) {
        let fact =
            format!("\"assume_master_slave\" names {} for pair \"{key}\", which does not exist", list.join(", "));
        let remedy = "use the keys of the pairs of contact parts";
        out.push(Diagnostic::warning("slaves-without-pair", fact).remedy(remedy));
    }
    out.extend(shared(part, interfaces));
    out.extend(mutual(interfaces));
    let mut first: BTreeMap<Vec<u32>, &str> = BTreeMap::new();
    let mut twice: BTreeMap<[&str; 2], usize> = BTreeMap::new();
    for interface in interfaces {
        for facet in interface.facets.iter().filter(|facet| facet.role != Roles::Master) {
            let mut nodes = facet.nodes.to_vec();
            nodes.sort_unstable();
            if let Some(other) = first.insert(nodes, &interface.key).filter(|other| *other != interface.key) {
                *twice.entry([other, &interface.key]).or_default() += 1;
            }
        }
    }
    for ([one, other], count) in twice {
        let fact = format!("{count} facets are on the slave side of pair \"{one}\" and of pair \"{other}\"");
        let remedy =
            "a node has one multiplier: list both masters in one pair, or make this side the master of one of them";
        out.push(Diagnostic::warning("slave-in-two-pairs", fact).remedy(remedy));
    }
    out
}

/// Warnings of pairs in which each side is the slave of the other.
fn mutual(interfaces: &[Interface]) -> Vec<Diagnostic> {
    let facets = |interface: &Interface, role: Roles| -> BTreeSet<Vec<u32>> {
        let own = interface.facets.iter().filter(|facet| facet.role == role).map(|facet| {
            let mut nodes = facet.nodes.clone();
            nodes.sort_unstable();
            nodes
        });
        own.collect()
    };
    let sides: Vec<[BTreeSet<Vec<u32>>; 2]> =
        interfaces.iter().map(|of| [Roles::Slave, Roles::Master].map(|role| facets(of, role))).collect();
    let mut out = Vec::new();
    for (at, [slaves, masters]) in sides.iter().enumerate() {
        for (other, [their_slaves, their_masters]) in sides.iter().enumerate().skip(at + 1) {
            if slaves.is_disjoint(their_masters) || masters.is_disjoint(their_slaves) {
                continue;
            }
            let fact = format!(
                "in the pairs \"{}\" and \"{}\" each side is the slave of the other: two multipliers would hold one gap",
                interfaces[at].key, interfaces[other].key
            );
            out.push(
                Diagnostic::warning("mutual-pairs", fact).remedy("keep one of them, with the finer side as slave"),
            );
        }
    }
    out
}

fn facets_of(part: &ModelPart, sub: &SubPart, faces: &Faces, found: &mut Vec<Facet>) -> Result<()> {
    let mut from_conditions = false;
    for &at in &sub.conditions {
        if let Some(rigid) = part.rigid_facets.get(&at) {
            from_conditions = true;
            found.push(rigid_facet(part, at, rigid));
            continue;
        }
        if part.conditions.kinds[at as usize].cell.is_none_or(|shape| shape.dim() == 0) {
            continue;
        }
        let nodes = part.conditions.nodes(at).to_vec();
        from_conditions = true;
        let mut sorted = nodes.clone();
        sorted.sort_unstable();
        let Some(face) = faces.get(&sorted) else {
            let fact = format!(
                "condition {} of contact part {:?} is not a face of any element",
                part.conditions.ids[at as usize], sub.name
            );
            return Err(Diagnostic::error("loose-facet", fact)
                .remedy("contact surfaces must lie on the skin of a body")
                .into());
        };
        found.push(facet(part, face, nodes, FacetSource::Condition(at))?);
    }
    if from_conditions {
        return Ok(());
    }
    let mut inside = vec![false; part.nodes.len()];
    sub.nodes.iter().for_each(|&n| inside[n as usize] = true);
    outer_facets(part, faces, |node| inside[node as usize], found)
}

/// A facet of a rigid shape, whose nodes go round as the shape says.
fn rigid_facet(part: &ModelPart, at: u32, rigid: &RigidFacet) -> Facet {
    let shape = part.conditions.kinds[at as usize].cell.expect("facets of rigid shapes are lines and triangles");
    Facet {
        nodes: part.conditions.nodes(at).to_vec(),
        shape,
        source: FacetSource::Rigid(at),
        element: 0,
        properties: part.conditions.properties[at as usize],
        role: Roles::Open,
        exact: rigid.exact.map(Arc::new),
    }
}

/// A facet whose nodes are turned so that its normal leaves the element.
fn facet(part: &ModelPart, face: &ElementFace, mut nodes: Vec<u32>, source: FacetSource) -> Result<Facet> {
    let &ElementFace { element, shape, .. } = face;
    let (id, space) = (part.elements.ids[element as usize], part.info.domain_size);
    if !carries_contact(shape) || shape.dim() + 1 != space {
        let fact =
            format!("a face of element {id} is of shape {shape:?}, which cannot carry contact in {space} dimensions");
        let remedy = "contact works on lines of 2 and 3 nodes in the plane, triangles of 3 and 6 and quadrilaterals of 4, 8 and 9 in \
                      space: is \"domain_size\" right?";
        return Err(Diagnostic::error("contact-facet", fact).remedy(remedy).into());
    }
    let centre = |nodes: &[u32]| {
        let mut sum = [0.0; 3];
        for &n in nodes {
            (0..3).for_each(|c| sum[c] += part.nodes.initial[n as usize][c] / nodes.len() as f64);
        }
        sum
    };
    let points: Vec<[f64; 3]> = nodes.iter().map(|&n| part.nodes.initial[n as usize]).collect();
    let outward = sub(centre(&nodes), centre(part.elements.nodes(element)));
    let longest = (0..nodes.len()).map(|n| norm(sub(points[n], points[(n + 1) % nodes.len()]))).fold(0.0, f64::max);
    let has_area = domain_size(shape, &points) > LEAST_AREA * longest.powi(shape.dim() as i32);
    let Some(normal) = unit_normal(shape, &points, shape.cell().centre).filter(|_| has_area) else {
        let ids: Vec<String> = nodes.iter().map(|&n| part.nodes.ids[n as usize].to_string()).collect();
        let of = match source {
            FacetSource::Condition(at) => format!("condition {} on element {id}", part.conditions.ids[at as usize]),
            FacetSource::Face(_) | FacetSource::Rigid(_) => format!("a facet of element {id}"),
        };
        let fact = format!("{of} has no area: its nodes are {}", ids.join(", "));
        let remedy = "nodes stand in one place or on one line: mend the mesh";
        return Err(Diagnostic::error("degenerate-facet", fact).remedy(remedy).into());
    };
    if dot(normal, outward) < 0.0 {
        nodes = reversed(shape, &nodes);
    }
    let own = match source {
        FacetSource::Condition(at) => Some(part.conditions.properties[at as usize]),
        FacetSource::Face(_) | FacetSource::Rigid(_) => None,
    };
    let elastic = |id: &usize| part.properties.get(id).is_some_and(|p| representative_young(p).is_some());
    let properties = own.filter(elastic).unwrap_or(part.elements.properties[element as usize]);
    Ok(Facet { nodes, shape, source, element, properties, role: Roles::Open, exact: None })
}

/// Marks of the nodes of these parts and of their conditions; of all nodes with `all`.
///
/// # Errors
/// A part that does not exist.
fn nodes_of_parts<'a>(part: &ModelPart, names: impl Iterator<Item = &'a String>, all: bool) -> Result<Vec<bool>> {
    let mut is_one = vec![all; part.nodes.len()];
    for name in names {
        let sub = part.part(name)?;
        let of_conditions = sub.conditions.iter().flat_map(|&at| part.conditions.nodes(at));
        sub.nodes.iter().chain(of_conditions).for_each(|&node| is_one[node as usize] = true);
    }
    Ok(is_one)
}

/// The faces of elements all nodes of which are `wanted`.
fn boundary_faces(part: &ModelPart, wanted: &[bool]) -> Faces {
    let mut faces = Faces::default();
    for element in 0..part.elements.len() as u32 {
        let Some(cell) = part.elements.kinds[element as usize].cell.map(Shape::cell) else { continue };
        let nodes = part.elements.nodes(element);
        if !nodes.iter().any(|&node| wanted[node as usize]) {
            continue;
        }
        for facet in cell.faces.iter().filter(|facet| facet.nodes.iter().all(|&n| wanted[nodes[n] as usize])) {
            let face: Vec<u32> = facet.nodes.iter().map(|&n| nodes[n]).collect();
            let mut sorted = face.clone();
            sorted.sort_unstable();
            let new = || ElementFace { element, nodes: face, shape: facet.shape, shared: 1 };
            faces.entry(sorted).and_modify(|face| face.shared += 1).or_insert_with(new);
        }
    }
    join_sections(part, &mut faces);
    faces
}

/// Faces that constraints hold together, as the two sides of the section of a bolt, lie within a body.
fn join_sections(part: &ModelPart, faces: &mut Faces) {
    let mut followed: FxHashMap<u32, u32> = FxHashMap::default();
    for own in part.constraints.iter().filter(|own| own.active && own.set.is_none()) {
        let (node, variable) = own.slave;
        let at_one_place = |other: u32| part.nodes.initial[other as usize] == part.nodes.initial[node as usize];
        let follows = |&&((other, of), _): &&((u32, ScalarVariable), f64)| of == variable && at_one_place(other);
        if let Some(((other, _), _)) = own.masters.iter().find(follows) {
            followed.insert(node, *other);
        }
    }
    if followed.is_empty() {
        return;
    }
    let joined = |nodes: &Vec<u32>| {
        let mut others = nodes.iter().map(|node| followed.get(node).copied()).collect::<Option<Vec<u32>>>()?;
        others.sort_unstable();
        faces.contains_key(&others).then(|| [nodes.clone(), others])
    };
    let both: Vec<Vec<u32>> = faces.keys().filter_map(joined).flatten().collect();
    for nodes in both {
        faces.entry(nodes).and_modify(|face| face.shared += 1);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use zelus_core::entities::require_kind;
    use zelus_core::model::{EntityRole, Nodes};

    /// The skin of one element in a space of `space` dimensions.
    fn skin(name: &str, space: usize) -> Result<Vec<Interface>> {
        let kind = require_kind(EntityRole::Element, name).unwrap();
        let cell = kind.cell.unwrap().cell();
        let mut part = ModelPart::new("Body");
        part.info.domain_size = space;
        part.nodes = Nodes::new((1..=cell.points.len()).collect(), cell.points.to_vec());
        part.elements.push(1, kind, 0, &(0..cell.points.len() as u32).collect::<Vec<u32>>());
        interfaces(&mut part, &BTreeMap::new(), &BTreeMap::new())
    }

    #[test]
    fn faces_are_known_by_their_shape_not_their_number_of_nodes() {
        assert_eq!(skin("SmallDisplacementElement2D3N", 2).unwrap()[0].facets.len(), 3);
        assert_eq!(skin("SmallDisplacementElement3D8N", 3).unwrap()[0].facets.len(), 6);
        // Lines of three nodes have as many as triangles, quadrilaterals of eight as nothing else.
        assert_eq!(skin("SmallDisplacementElement2D6N", 2).unwrap()[0].facets[0].shape, Shape::Line3);
        assert_eq!(skin("SmallDisplacementElement3D10N", 3).unwrap()[0].facets[0].shape, Shape::Tri6);
        assert_eq!(skin("SmallDisplacementElement3D20N", 3).unwrap()[0].facets[0].shape, Shape::Quad8);
        assert_eq!(skin("SmallDisplacementElement3D27N", 3).unwrap()[0].facets[0].shape, Shape::Quad9);
        let said = skin("SmallDisplacementElement2D6N", 3).unwrap_err().to_string();
        assert!(said.contains("Line3") && said.contains("domain_size"), "{said}");
        let said = skin("SmallDisplacementElement2D3N", 3).unwrap_err().to_string();
        assert!(said.contains("Line2") && said.contains("domain_size"), "{said}");
    }
}
