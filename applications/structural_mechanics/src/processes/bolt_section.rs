//! Section through a bolt: the mesh is cut along faces between elements, and the nodes of the section are doubled.
//!
//! The faces of the section lie between elements on both sides of a plane, by their centres, or are those of conditions. They must cut
//! the part in two. The side in the direction of the normal takes the copies of the nodes.

use std::collections::{BTreeMap, BTreeSet};

use zelus_core::diagnostics::Diagnostic;
use zelus_core::geometry::{Shape, mapping};
use zelus_core::model::{ModelPart, SubPart};
use zelus_core::vector3::{add, dot, norm, scale, sub};

/// Distance of the centre of an element from the plane, over the size of the part, that is round-off.
const ON_PLANE: f64 = 1e-9;

/// A place at which a bolt is cut.
pub(super) enum Cut {
    /// By a point and a unit normal.
    Plane([f64; 3], [f64; 3]),
    /// By conditions (index) that lie within the bolt.
    Faces(Vec<u32>),
}

/// A section: faces between two sides of a part.
#[derive(Debug)]
pub(super) struct BoltSection {
    /// Its nodes, ascending.
    pub nodes: Vec<u32>,
    /// Elements against the normal and along it, ascending.
    minus: Vec<u32>,
    plus: Vec<u32>,
    /// Unit normal.
    pub normal: [f64; 3],
    /// Mean of its nodes.
    pub centre: [f64; 3],
}

/// A face between elements: its shape and nodes in the order of the first, and the elements.
struct Face {
    shape: Shape,
    nodes: Vec<u32>,
    elements: Vec<u32>,
}

/// Faces of these elements by their sorted nodes.
fn faces(part: &ModelPart, elements: &[u32]) -> BTreeMap<Vec<u32>, Face> {
    let mut out: BTreeMap<Vec<u32>, Face> = BTreeMap::new();
    for &element in elements {
        let Some(cell) = part.elements.kinds[element as usize].cell.map(Shape::cell) else { continue };
        let own = part.elements.nodes(element);
        for facet in if cell.dim == 3 { cell.faces } else { cell.edges } {
            let nodes: Vec<u32> = facet.nodes.iter().map(|&at| own[at]).collect();
            let face = || Face { shape: facet.shape, nodes: nodes.clone(), elements: Vec::new() };
            out.entry(sorted(&nodes)).or_insert_with(face).elements.push(element);
        }
    }
    out
}

fn sorted(nodes: &[u32]) -> Vec<u32> {
    let mut nodes = nodes.to_vec();
    nodes.sort_unstable();
    nodes.dedup();
    nodes
}

fn mean(part: &ModelPart, nodes: &[u32]) -> [f64; 3] {
    let sum = nodes.iter().fold([0.0; 3], |sum, &node| add(sum, part.nodes.initial[node as usize]));
    scale(sum, (nodes.len() as f64).recip())
}

fn text(v: [f64; 3]) -> String {
    format!("({}, {}, {})", v[0], v[1], v[2])
}

/// The error that a section cannot be.
fn wrong(fact: String, remedy: &str) -> Diagnostic {
    Diagnostic::error("bolt-section", fact).remedy(remedy.to_owned())
}

impl BoltSection {
    /// Finds the section of the part `path` whose elements and nodes are `bolt`.
    ///
    /// # Errors
    /// A section that misses the part or does not cut it in two, and other elements at its nodes.
    pub fn find(part: &ModelPart, path: &str, bolt: &SubPart, cut: &Cut) -> Result<Self, Diagnostic> {
        let space = part.info.domain_size;
        let is_solid = |at: &u32| part.elements.kinds[*at as usize].cell.is_some_and(|cell| cell.dim() == space);
        let elements: Vec<u32> = bolt.elements.iter().copied().filter(is_solid).collect();
        if elements.is_empty() {
            let fact = format!("{path} has no solid elements: there is no bolt to cut");
            return Err(wrong(fact, "name a part with the elements of one bolt"));
        }
        let faces = faces(part, &elements);
        let (section, normal) = match cut {
            Cut::Plane(point, normal) => (by_plane(part, path, &elements, &faces, *point, *normal)?, *normal),
            Cut::Faces(conditions) => by_faces(part, path, &faces, conditions)?,
        };
        let [minus, plus] = sides(part, path, &faces, &section, normal)?;
        let nodes_of = |elements: &[u32]| {
            let all: Vec<u32> = elements.iter().flat_map(|&at| part.elements.nodes(at)).copied().collect();
            sorted(&all)
        };
        let of_minus = nodes_of(&minus);
        let mut nodes = nodes_of(&plus);
        nodes.retain(|node| of_minus.binary_search(node).is_ok());
        let is_side = |at: u32| minus.binary_search(&at).is_ok() || plus.binary_search(&at).is_ok();
        let node_of = |at: u32| part.elements.nodes(at).iter().find(|node| nodes.binary_search(node).is_ok());
        let mut others = (0..part.elements.len() as u32).filter(|&at| !is_side(at));
        if let Some((at, node)) = others.find_map(|at| Some((at, node_of(at)?))) {
            let (kind, id) = (part.elements.kinds[at as usize].name, part.elements.ids[at as usize]);
            let fact = format!(
                "the section does not separate {path}: {kind} {id} beside it has node {} of the section, too",
                part.nodes.ids[*node as usize]
            );
            return Err(wrong(fact, "cut the shank between head and thread, where the bolt is joined to nothing"));
        }
        let centre = mean(part, &nodes);
        Ok(Self { nodes, minus, plus, normal, centre })
    }

    /// Doubles the nodes of the section; gives the index of the first copy. Conditions go with the elements behind them.
    pub fn open(&self, part: &mut ModelPart) -> u32 {
        let copy_of = |first: u32, node: u32| self.nodes.binary_search(&node).ok().map(|at| first + at as u32);
        let touches = |nodes: &[u32]| nodes.iter().any(|node| self.nodes.binary_search(node).is_ok());
        let goes_with_plus = |&at: &u32| {
            let own = part.conditions.nodes(at);
            let behind = |element: &u32| own.iter().all(|node| part.elements.nodes(*element).contains(node));
            own.len() > 1 && touches(own) && self.plus.iter().any(behind) && !self.minus.iter().any(behind)
        };
        let of_plus: Vec<u32> = (0..part.conditions.len() as u32).filter(goes_with_plus).collect();
        let first = part.add_copies_of_nodes(&self.nodes);
        let renumber = |nodes: &mut [u32]| {
            nodes.iter_mut().for_each(|node| *node = copy_of(first, *node).unwrap_or(*node));
        };
        self.plus.iter().for_each(|&at| renumber(part.elements.nodes_mut(at)));
        of_plus.iter().for_each(|&at| renumber(part.conditions.nodes_mut(at)));
        first
    }
}

/// Faces between elements on both sides of a plane.
fn by_plane(
    part: &ModelPart,
    path: &str,
    elements: &[u32],
    faces: &BTreeMap<Vec<u32>, Face>,
    point: [f64; 3],
    normal: [f64; 3],
) -> Result<Vec<Vec<u32>>, Diagnostic> {
    let height = |x: [f64; 3]| dot(sub(x, point), normal);
    let nodes = elements.iter().flat_map(|&at| part.elements.nodes(at));
    let heights = nodes.map(|&node| height(part.nodes.initial[node as usize]));
    let [low, high] = heights.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], h| [low.min(h), high.max(h)]);
    let is_above = |at: u32| height(mean(part, part.elements.nodes(at))) > -ON_PLANE * (high - low);
    let count = elements.iter().filter(|&&at| is_above(at)).count();
    if count == 0 || count == elements.len() {
        let fact = format!(
            "the plane through {} with the normal {} misses {path}, whose elements lie from {low:.6} to {high:.6} of it along the \
             normal",
            text(point),
            text(normal)
        );
        return Err(wrong(fact, "write a \"point\" within the shank, between two layers of elements at least"));
    }
    let is_between = |face: &&Face| matches!(face.elements[..], [a, b] if is_above(a) != is_above(b));
    Ok(faces.values().filter(is_between).map(|face| sorted(&face.nodes)).collect())
}

/// Faces of conditions, and their mean normal.
fn by_faces(
    part: &ModelPart,
    path: &str,
    faces: &BTreeMap<Vec<u32>, Face>,
    conditions: &[u32],
) -> Result<(Vec<Vec<u32>>, [f64; 3]), Diagnostic> {
    let (mut section, mut area) = (Vec::new(), [0.0; 3]);
    for &at in conditions {
        let key = sorted(part.conditions.nodes(at));
        let Some(face) = faces.get(&key).filter(|face| face.elements.len() == 2) else {
            let id = part.conditions.ids[at as usize];
            let fact = format!("condition {id} of the section is no face between two elements of {path}");
            return Err(wrong(fact, "name conditions on faces within the bolt"));
        };
        let x: Vec<[f64; 3]> =
            part.conditions.nodes(at).iter().map(|&node| part.nodes.initial[node as usize]).collect();
        area = add(area, mapping::vector_area(face.shape, &x));
        section.push(key);
    }
    let size = norm(area);
    if size > 0.0 && size.is_finite() {
        return Ok((section, scale(area, size.recip())));
    }
    let fact = format!("the conditions of the section of {path} have no area in common");
    Err(wrong(fact, "name conditions whose normals point to one side"))
}

/// Elements on both sides of a section, each ascending: against the normal and along it.
fn sides(
    part: &ModelPart,
    path: &str,
    faces: &BTreeMap<Vec<u32>, Face>,
    section: &[Vec<u32>],
    normal: [f64; 3],
) -> Result<[Vec<u32>; 2], Diagnostic> {
    let cut: BTreeSet<&Vec<u32>> = section.iter().collect();
    let mut neighbours: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for (_, face) in faces.iter().filter(|(key, _)| !cut.contains(key)) {
        for &element in &face.elements {
            neighbours.entry(element).or_default().extend(&face.elements);
        }
    }
    let mut starts = [Vec::new(), Vec::new()];
    for key in section {
        let face = &faces[key];
        let height = |&&at: &&u32| dot(sub(mean(part, part.elements.nodes(at)), mean(part, &face.nodes)), normal);
        let above = face.elements.iter().max_by(|a, b| height(a).total_cmp(&height(b)));
        let below = face.elements.iter().min_by(|a, b| height(a).total_cmp(&height(b)));
        starts[0].extend(below);
        starts[1].extend(above);
    }
    // All elements that faces connect to the first of each side.
    let reached = |from: u32| {
        let (mut found, mut next) = (BTreeSet::from([from]), vec![from]);
        while let Some(at) = next.pop() {
            next.extend(neighbours.get(&at).into_iter().flatten().filter(|&&other| found.insert(other)));
        }
        found.into_iter().collect::<Vec<u32>>()
    };
    let both = starts.each_ref().map(|starts| reached(starts[0]));
    if both[0] == both[1] {
        let fact = format!("the section does not separate {path}: its sides are connected beside it");
        return Err(wrong(fact, "cut the whole shank; of a bolt with two legs make two parts"));
    }
    let missed = |side: usize| starts[side].iter().find(|at| both[side].binary_search(at).is_err());
    if let Some(other) = missed(0).or(missed(1)) {
        let fact = format!(
            "the section of {path} has several pieces, one at element {} and one at element {}",
            part.elements.ids[starts[0][0] as usize], part.elements.ids[*other as usize]
        );
        return Err(wrong(fact, "name one bolt: a part of its own for each"));
    }
    Ok(both)
}
