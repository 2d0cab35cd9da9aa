//! Normals of contact surfaces, and how they rotate when nodes move.
//!
//! The normal of a node is S/|S| with the sum S of v over its facets. Everything in the present configuration, outward. At a
//! node of a facet whose next and previous nodes lie along the edges a and b (in the plane a line has one edge, the other is
//! the axis z; of a facet of second order they are the tangents of its surface at the node), v is one of
//!
//! - a × b/(|a|² |b|²), which gives the normal of the sphere or circle that nodes lie on, however unlike their facets are
//!   (Max, 1999);
//! - a × b/|a × b|: all facets count alike, as in the reference program.
//!
//! dn = (I − n⊗n)/|S| Σ dv with, for the first, dv = (da × b + a × db)/(|a|² |b|²) − 2 v (a·da/|a|² + b·db/|b|²), and for
//! the second (I − v⊗v)/|a × b| (da × b + a × db).
//!
//! Normals of nodes on planes of symmetry lie in them: the sum over facets and their mirror images.

use std::collections::BTreeMap;

use zelus_core::geometry::local_gradients;
use zelus_core::model::ModelPart;
use zelus_core::vector3::{cross, dot, norm, scale, sub};
use zelus_structural_mechanics::variables::NORMAL;

use super::facet::{Facet, Roles};
use super::facets::Interface;
use super::fixed::FixedDirections;
use super::patches::Patches;

/// The edge that a line has not.
const AXIS: [f64; 3] = [0.0, 0.0, 1.0];

/// A facet as one of its nodes sees it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FacetCorner {
    /// Interface and facet, by their positions.
    pub facet: [u32; 2],
    /// Where the terms of its edges a and b stand; none for the edge that a line has not.
    edges: [Option<[u32; 2]>; 2],
}

/// A term of an edge: the way from the node to this one, times a number.
type Term = (u32, f64);

/// The terms of the edges a and b at a node of a facet.
fn edges(facet: &Facet, local: usize) -> [Option<Vec<Term>>; 2] {
    let cell = facet.shape.cell();
    let (corners, line) = (cell.corners(), facet.shape.dim() == 1);
    if facet.nodes.len() > corners {
        let mut gradients = vec![[0.0; 3]; facet.nodes.len()];
        local_gradients(facet.shape, cell.points[local], &mut gradients);
        let terms = |axis: usize| -> Vec<Term> {
            let all = facet.nodes.iter().zip(&gradients).enumerate().filter(|(n, _)| *n != local);
            all.map(|(_, (&node, gradient))| (node, gradient[axis])).filter(|(_, factor)| *factor != 0.0).collect()
        };
        return [Some(terms(0)), (!line).then(|| terms(1))];
    }
    let to = |local: usize| vec![(facet.nodes[local % corners], 1.0)];
    [(!line || local == 0).then(|| to(local + 1)), (!line || local > 0).then(|| to(local + corners - 1))]
}

/// How facets count in the normal of a node.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum NodalNormals {
    /// By the squares of their edges at the node, the shorter the more.
    ByEdges,
    /// All alike.
    #[default]
    ByFacets,
}

/// The facets that make the normals of items: the mesh nodes of the interfaces, or the slave nodes of patches.
///
/// Where each search decides the sides, facets that meet nothing do not turn the normals of those that do: the edge of a
/// block found by its skin would otherwise be pressed askew.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct NormalPatches {
    /// Mesh node of each item.
    nodes: Vec<u32>,
    /// First corner of each item, and the end.
    starts: Vec<u32>,
    corners: Vec<FacetCorner>,
    terms: Vec<Term>,
    weights: NodalNormals,
    /// Directions that the normals of nodes on planes of symmetry lack.
    planes: BTreeMap<u32, FixedDirections>,
}

impl NormalPatches {
    /// Normals of the mesh nodes of a model part with `count` nodes, of all facets around each.
    pub fn new(count: usize, interfaces: &[Interface], weights: NodalNormals) -> Self {
        let nodes: Vec<u32> = (0..count as u32).collect();
        Self::of_items(nodes, interfaces, weights, &|_, _, _, node| Some(node))
    }

    /// Normals of slave nodes, of the facets of their own patch alone.
    pub fn of_slaves(patches: &Patches, interfaces: &[Interface], weights: NodalNormals) -> Self {
        let nodes: Vec<u32> = patches.all().map(|slave| patches.mesh_node(slave)).collect();
        Self::of_items(nodes, interfaces, weights, &|i, f, local, _| {
            let facet = &interfaces[i as usize].facets[f as usize];
            Some(patches.of_facet(i, f, facet.nodes.len()).get(local)?.0)
        })
    }

    /// `item` names the item of a node of a facet: interface, facet, place of the node, node.
    fn of_items(
        nodes: Vec<u32>,
        interfaces: &[Interface],
        weights: NodalNormals,
        item: &dyn Fn(u32, u32, usize, u32) -> Option<u32>,
    ) -> Self {
        let count = nodes.len();
        let all = || {
            interfaces.iter().enumerate().flat_map(|(i, interface)| {
                let facets = interface.facets.iter().enumerate();
                facets.map(move |(f, facet)| (i as u32, f as u32, interface.open, facet))
            })
        };
        let mut met = vec![false; count];
        for (i, f, _, facet) in all().filter(|(_, _, open, facet)| *open && facet.role != Roles::Open) {
            let own = facet.nodes.iter().enumerate().filter_map(|(local, &node)| item(i, f, local, node));
            own.for_each(|item| met[item as usize] = true);
        }
        let (mut at_items, mut terms): (Vec<(u32, FacetCorner)>, Vec<Term>) = Default::default();
        let mut keep = |edge: Vec<Term>| {
            let first = terms.len() as u32;
            terms.extend(edge);
            [first, terms.len() as u32]
        };
        for (i, f, _, facet) in all() {
            for (local, &node) in facet.nodes.iter().enumerate() {
                let Some(item) = item(i, f, local, node) else { continue };
                if facet.role != Roles::Open || !met[item as usize] {
                    let edges = edges(facet, local).map(|edge| edge.map(&mut keep));
                    at_items.push((item, FacetCorner { facet: [i, f], edges }));
                }
            }
        }
        at_items.sort_by_key(|(item, _)| *item);
        let mut starts = vec![0_u32; count + 1];
        at_items.iter().for_each(|(item, _)| starts[*item as usize + 1] += 1);
        (0..count).for_each(|item| starts[item + 1] += starts[item]);
        let corners = at_items.into_iter().map(|(_, corner)| corner).collect();
        Self { nodes, starts, corners, terms, weights, planes: BTreeMap::new() }
    }

    /// How facets count.
    pub fn weights(&self) -> NodalNormals {
        self.weights
    }

    /// The same with nodes on these planes of symmetry.
    #[must_use]
    pub fn on_planes(self, planes: BTreeMap<u32, FixedDirections>) -> Self {
        Self { planes, ..self }
    }

    /// The directions that the normal of an item lacks.
    fn lacks(&self, item: u32) -> FixedDirections {
        self.planes.get(&self.nodes[item as usize]).copied().unwrap_or_default()
    }

    /// The facets of an item.
    pub fn corners(&self, item: u32) -> &[FacetCorner] {
        match self.starts.get(item as usize..item as usize + 2) {
            Some(&[from, to]) => &self.corners[from as usize..to as usize],
            _ => &[],
        }
    }

    /// The mesh nodes, beside its own, that the normal of an item depends on.
    pub fn neighbours(&self, item: u32) -> impl Iterator<Item = u32> + '_ {
        let edges = self.corners(item).iter().flat_map(|corner| corner.edges).flatten();
        edges.flat_map(|edge| self.terms(edge)).map(|(node, _)| *node)
    }

    fn terms(&self, [from, to]: [u32; 2]) -> &[Term] {
        &self.terms[from as usize..to as usize]
    }

    /// The edges a and b of a corner at a node.
    fn edges(&self, corner: &FacetCorner, node: u32, places: &[[f64; 3]]) -> [[f64; 3]; 2] {
        corner.edges.map(|edge| {
            let Some(edge) = edge else { return AXIS };
            let mut sum = [0.0; 3];
            for &(end, factor) in self.terms(edge) {
                let way = sub(places[end as usize], places[node as usize]);
                (0..3).for_each(|c| sum[c] += factor * way[c]);
            }
            sum
        })
    }

    /// v of a corner at a node; `None` without area.
    fn normal(&self, corner: &FacetCorner, node: u32, places: &[[f64; 3]]) -> Option<[f64; 3]> {
        let [a, b] = self.edges(corner, node, places);
        let across = cross(a, b);
        let size = match self.weights {
            NodalNormals::ByEdges => dot(a, a) * dot(b, b),
            NodalNormals::ByFacets => norm(across),
        };
        (norm(across) > 0.0).then(|| scale(across, 1.0 / size))
    }

    /// Visits the other ends of a corner's edges with ∂v/∂x; the node itself moves against them.
    fn corner_variation(
        &self,
        corner: &FacetCorner,
        node: u32,
        places: &[[f64; 3]],
        mut visit: impl FnMut(u32, [[f64; 3]; 3]),
    ) {
        let Some(v) = self.normal(corner, node, places) else { return };
        let [a, b] = self.edges(corner, node, places);
        let turned = match self.weights {
            NodalNormals::ByEdges => projector([0.0; 3], dot(a, a) * dot(b, b)),
            NodalNormals::ByFacets => projector(v, norm(cross(a, b))),
        };
        // δ × b = −b × δ, and a × δ.
        for (edge, moved, other) in [(corner.edges[0], a, scale(b, -1.0)), (corner.edges[1], b, a)] {
            let Some(edge) = edge else { continue };
            let mut by_edge = product(turned, crossing(other));
            if self.weights == NodalNormals::ByEdges {
                let by_length = -2.0 / dot(moved, moved);
                (0..3).for_each(|r| (0..3).for_each(|c| by_edge[r][c] += by_length * v[r] * moved[c]));
            }
            self.terms(edge).iter().for_each(|&(end, factor)| visit(end, by_edge.map(|row| scale(row, factor))));
        }
    }

    /// S of an item; zero where no facet has an area.
    pub fn sum(&self, item: u32, places: &[[f64; 3]]) -> [f64; 3] {
        let node = self.nodes[item as usize];
        let mut sum = [0.0; 3];
        for v in self.corners(item).iter().filter_map(|corner| self.normal(corner, node, places)) {
            (0..3).for_each(|c| sum[c] += v[c]);
        }
        self.lacks(item).free_part(sum)
    }

    /// Visits mesh nodes with ∂n/∂x, row by row, of the normal of an item; the derivative by a node is the sum of its visits.
    ///
    /// Only facets that `knows` says yes to move; all of them count in the normal.
    pub fn variation(
        &self,
        item: u32,
        places: &[[f64; 3]],
        knows: &dyn Fn(&FacetCorner) -> bool,
        visit: &mut dyn FnMut(u32, [[f64; 3]; 3]),
    ) {
        let (node, sum) = (self.nodes[item as usize], self.sum(item, places));
        let length = norm(sum);
        if length == 0.0 {
            return;
        }
        let lacks = self.lacks(item);
        let mut outer = projector(scale(sum, 1.0 / length), length);
        outer.iter_mut().for_each(|row| *row = lacks.free_part(*row));
        for corner in self.corners(item).iter().filter(|corner| knows(corner)) {
            let mut own = [[0.0; 3]; 3];
            self.corner_variation(corner, node, places, |end, by_end| {
                let by_end = product(outer, by_end);
                (0..3).for_each(|r| (0..3).for_each(|c| own[r][c] -= by_end[r][c]));
                visit(end, by_end);
            });
            visit(node, own);
        }
    }

    /// Writes NORMAL at the mesh nodes of the items.
    pub fn write(&self, part: &mut ModelPart) {
        let items = (0..self.nodes.len() as u32).filter(|&item| !self.corners(item).is_empty());
        let normals: Vec<(u32, [f64; 3])> =
            items.map(|item| (self.nodes[item as usize], self.sum(item, &part.nodes.current))).collect();
        let column = part.nodes.history.values_mut(&NORMAL, 0);
        for (node, sum) in normals {
            let size = norm(sum);
            if size > 0.0 {
                (0..3).for_each(|c| column[3 * node as usize + c] = sum[c] / size);
            }
        }
    }
}

/// (I − n⊗n)/length.
fn projector(n: [f64; 3], length: f64) -> [[f64; 3]; 3] {
    std::array::from_fn(|r| std::array::from_fn(|c| (f64::from(u8::from(r == c)) - n[r] * n[c]) / length))
}

/// The matrix of v ↦ a × v.
fn crossing([x, y, z]: [f64; 3]) -> [[f64; 3]; 3] {
    [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]]
}

fn product(a: [[f64; 3]; 3], b: [[f64; 3]; 3]) -> [[f64; 3]; 3] {
    std::array::from_fn(|r| std::array::from_fn(|c| (0..3).map(|k| a[r][k] * b[k][c]).sum()))
}

/// Writes NORMAL at the nodes of the interfaces; all facets count alike.
pub fn nodal_normals(part: &mut ModelPart, interfaces: &[Interface]) {
    NormalPatches::new(part.nodes.len(), interfaces, NodalNormals::ByFacets).write(part);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interface::FacetSource;
    use crate::mortar::tests::Noise;
    use zelus_core::geometry::Shape;

    fn interface(facets: &[&[u32]]) -> Interface {
        let line =
            facets.iter().all(|nodes| nodes.len() < 4) && facets.iter().flat_map(|nodes| nodes.iter()).all(|n| *n < 5);
        let facet = |nodes: &&[u32]| Facet {
            nodes: nodes.to_vec(),
            shape: match nodes.len() {
                2 => Shape::Line2,
                3 if line => Shape::Line3,
                3 => Shape::Tri3,
                4 => Shape::Quad4,
                6 => Shape::Tri6,
                _ => Shape::Quad8,
            },
            source: FacetSource::Face(0),
            element: 0,
            properties: 0,
            role: Roles::Slave,
            exact: None,
        };
        Interface { facets: facets.iter().map(facet).collect(), ..Interface::default() }
    }

    fn normal(patches: &NormalPatches, node: u32, places: &[[f64; 3]]) -> [f64; 3] {
        let sum = patches.sum(node, places);
        scale(sum, 1.0 / norm(sum))
    }

    /// Every entry against central differences, for lines and for triangles beside quadrilaterals.
    #[test]
    fn variations_match_differences() {
        let mut noise = Noise::new(3);
        let line = [[0.0, 0.0, 0.0], [1.0, 0.2, 0.0], [1.7, -0.1, 0.0]];
        let mut sheet =
            [[0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [0.0, 1.0], [1.0, 1.0], [2.0, 1.0]].map(|[x, y]| [x, y, 0.0]);
        sheet.iter_mut().for_each(|x| (0..3).for_each(|c| x[c] += 0.2 * noise.next()));
        let curved = [[0.0, 0.0], [2.0, 0.0], [1.0, 0.1], [4.0, 0.5], [3.0, 0.4]].map(|[x, y]| [x, y, 0.0]);
        let mut wide = [
            [0.0, 0.0],
            [2.0, 0.0],
            [2.0, 2.0],
            [0.0, 2.0],
            [1.0, 0.0],
            [2.0, 1.0],
            [1.0, 2.0],
            [0.0, 1.0],
            [4.0, 0.0],
            [3.0, 0.0],
            [3.0, 1.0],
        ]
        .map(|[x, y]| [x, y, 0.0]);
        wide.iter_mut().for_each(|x| (0..3).for_each(|c| x[c] += 0.2 * noise.next()));
        let cases: [(&[&[u32]], &[[f64; 3]], usize); 4] = [
            (&[&[0, 1], &[1, 2]], &line, 2),
            (&[&[0, 1, 4, 3], &[1, 2, 4], &[2, 5, 4]], &sheet, 3),
            (&[&[0, 1, 2], &[1, 3, 4]], &curved, 2),
            (&[&[0, 1, 2, 3, 4, 5, 6, 7], &[1, 8, 2, 9, 10, 5]], &wide, 3),
        ];
        for ((facets, places, space), weights) in cases
            .into_iter()
            .flat_map(|case| [NodalNormals::ByEdges, NodalNormals::ByFacets].map(|weights| (case, weights)))
        {
            let patches = NormalPatches::new(places.len(), &[interface(facets)], weights);
            for node in 0..places.len() as u32 {
                let mut exact = vec![[[0.0; 3]; 3]; places.len()];
                patches.variation(node, places, &|_| true, &mut |by, matrix| {
                    (0..3).for_each(|r| (0..3).for_each(|c| exact[by as usize][r][c] += matrix[r][c]));
                });
                for by in 0..places.len() {
                    for c in 0..space {
                        let at = |step: f64| {
                            let mut moved = places.to_vec();
                            moved[by][c] += step;
                            normal(&patches, node, &moved)
                        };
                        let (plus, minus) = (at(1e-6), at(-1e-6));
                        for r in 0..3 {
                            let slope = (plus[r] - minus[r]) / 2e-6;
                            assert!(
                                (slope - exact[by][r][c]).abs() < 1e-8,
                                "{node} by {by}: {slope} {}",
                                exact[by][r][c]
                            );
                        }
                    }
                }
            }
        }
    }

    /// ANALYTIC: the radius is the normal of a circle and of a sphere, to round-off.
    #[test]
    fn normals_of_uneven_spheres_are_radii() {
        let on_circle = |angle: f64| [angle.sin(), angle.cos(), 0.0];
        let line = [0.1, 0.3, 1.0].map(on_circle);
        let directions = [[0.0, 0.0], [0.3, 0.05], [0.35, 0.5], [-0.1, 0.2], [-0.4, -0.02], [0.1, -0.6]];
        let sphere = directions.map(|[x, y]| zelus_core::vector3::normalised([x, y, 1.0]));
        let cases: [(&[&[u32]], &[[f64; 3]], u32); 2] =
            [(&[&[1, 0], &[2, 1]], &line, 1), (&[&[0, 1, 2, 3], &[0, 3, 4], &[0, 4, 5], &[0, 5, 1]], &sphere, 0)];
        for (facets, places, node) in cases {
            let of = |weights| normal(&NormalPatches::new(places.len(), &[interface(facets)], weights), node, places);
            let off = |n: [f64; 3]| norm(sub(n, places[node as usize]));
            assert!(off(of(NodalNormals::ByEdges)) < 1e-14, "{:?}", of(NodalNormals::ByEdges));
            assert!(off(of(NodalNormals::ByFacets)) > 1e-3);
        }
    }
}
