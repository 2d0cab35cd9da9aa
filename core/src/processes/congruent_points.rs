//! Points of a part at which the nodes of another stand, once a congruence has carried them there.

use std::collections::{BTreeMap, BTreeSet};

use super::congruence::Congruence;
use super::point_grid::PointGrid;
use crate::geometry::{mapping, shape_functions};
use crate::model::{ModelPart, SubPart};
use crate::vector3::{add, norm, scale, sub};

/// Distance from a facet, as a share of its size, at which a point still lies on it: chords of unlike meshes differ by less.
const OFF_FACET: f64 = 0.05;
/// Nodes around a point whose facets are tried first.
const NEAR: usize = 4;

/// A part on which points are looked for.
pub(super) struct CongruentPoints<'a> {
    part: &'a ModelPart,
    own: &'a SubPart,
    places: Vec<[f64; 3]>,
    /// Size of the part.
    pub size: f64,
    /// Typical distance of its nodes.
    spacing: f64,
    /// Facets at each node of the part.
    facets: Vec<Vec<u32>>,
    /// Body of each node of the model part.
    bodies: &'a [Option<usize>],
}

/// Why a node has no image.
pub(super) enum NoImage {
    /// Distance of the nearest node.
    Far(f64),
    /// Nodes at the image, of which none is the one.
    Several(Vec<u32>),
}

impl<'a> CongruentPoints<'a> {
    /// The nodes of a part, and those of its conditions that are facets of the model.
    pub fn new(part: &'a ModelPart, own: &'a SubPart, bodies: &'a [Option<usize>]) -> Self {
        let places: Vec<[f64; 3]> = own.nodes.iter().map(|&node| part.nodes.initial[node as usize]).collect();
        let first = places.first().copied().unwrap_or_default();
        let [low, high] = places.iter().fold([first; 2], |[low, high], x| {
            [[0, 1, 2].map(|c| low[c].min(x[c])), [0, 1, 2].map(|c| high[c].max(x[c]))]
        });
        let size = norm(sub(high, low));
        let dim = part.info.domain_size - 1;
        let mut facets = vec![Vec::new(); own.nodes.len()];
        for &at in &own.conditions {
            if part.conditions.kinds[at as usize].cell.is_some_and(|shape| shape.dim() == dim) {
                for node in part.conditions.nodes(at) {
                    if let Ok(local) = own.nodes.binary_search(node) {
                        facets[local].push(at);
                    }
                }
            }
        }
        let spacing = size / (places.len().max(2) as f64 - 1.0).powf(1.0 / dim.max(1) as f64);
        Self { part, own, places, size, spacing, facets, bodies }
    }

    /// Whether it has facets.
    pub fn has_facets(&self) -> bool {
        self.facets.iter().any(|at| !at.is_empty())
    }

    /// The nodes of the part whose values interpolate that at each of these places of nodes, with weights: one node within
    /// `tolerance`, or those of a facet. Nodes and facets of the body of a node come before others.
    ///
    /// # Errors
    /// For a node the distance to the nearest of the part where there is neither, or those among which it cannot choose.
    pub fn interpolated(&self, points: &[(u32, [f64; 3])], tolerance: f64) -> Vec<Result<Vec<(u32, f64)>, NoImage>> {
        let grid = PointGrid::new(&self.places, if self.spacing > 0.0 { self.spacing } else { 1.0 });
        let near = |&(_, point): &(u32, [f64; 3])| -> Vec<(f64, u32)> {
            let found = grid.near(point, NEAR.min(self.places.len())).into_iter();
            let mut near: Vec<(f64, u32)> = found.map(|at| (norm(sub(self.places[at as usize], point)), at)).collect();
            near.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
            near
        };
        let near: Vec<Vec<(f64, u32)>> = points.iter().map(near).collect();
        let there = |near: &[(f64, u32)]| -> Vec<u32> {
            near.iter()
                .take_while(|(distance, _)| *distance <= tolerance)
                .map(|&(_, at)| self.own.nodes[at as usize])
                .collect()
        };
        let of_nodes = self.at_one_place(points, &near.iter().map(|near| there(near)).collect::<Vec<_>>());
        let bodies: BTreeSet<Option<usize>> = points.iter().map(|&(node, _)| self.bodies[node as usize]).collect();
        let find = |((&(node, point), near), at_node): ((&(u32, [f64; 3]), &Vec<(f64, u32)>), Option<_>)| {
            at_node.unwrap_or_else(|| {
                let body = self.bodies[node as usize];
                let of_body = |at: &u32| self.body_of(*at) == body;
                let of_no_other = |at: &u32| !bodies.contains(&self.body_of(*at));
                let close = || near.iter().flat_map(|&(_, at)| &self.facets[at as usize]).copied();
                let all = || self.facets.iter().flatten().copied();
                self.on_facets(close().filter(of_body), point)
                    .or_else(|| self.on_facets(all().filter(of_body), point))
                    .or_else(|| self.on_facets(all().filter(of_no_other), point))
                    .ok_or(NoImage::Far(near.first().map_or(f64::INFINITY, |&(distance, _)| distance)))
            })
        };
        points.iter().zip(&near).zip(of_nodes).map(find).collect()
    }

    /// For each point with nodes of the part at its place the one that it follows: that of its body, or the one that is left.
    fn at_one_place(
        &self,
        points: &[(u32, [f64; 3])],
        there: &[Vec<u32>],
    ) -> Vec<Option<Result<Vec<(u32, f64)>, NoImage>>> {
        let mut chosen: Vec<Option<u32>> = Vec::with_capacity(points.len());
        for (&(node, _), there) in points.iter().zip(there) {
            let mut own =
                there.iter().copied().filter(|&other| self.bodies[other as usize] == self.bodies[node as usize]);
            chosen.push(own.next().filter(|_| own.next().is_none()));
        }
        let taken: BTreeSet<u32> = chosen.iter().flatten().copied().collect();
        let mut asked: BTreeMap<u32, usize> = BTreeMap::new();
        let left = |there: &[u32]| there.iter().copied().filter(|node| !taken.contains(node)).collect::<Vec<u32>>();
        for (there, _) in there.iter().zip(&chosen).filter(|(_, chosen)| chosen.is_none()) {
            left(there).into_iter().for_each(|node| *asked.entry(node).or_default() += 1);
        }
        let decide = |(there, chosen): (&Vec<u32>, &Option<u32>)| match (&there[..], chosen) {
            ([], _) => None,
            (_, Some(node)) => Some(Ok(vec![(*node, 1.0)])),
            _ => match left(there)[..] {
                [node] if asked[&node] == 1 => Some(Ok(vec![(node, 1.0)])),
                _ => Some(Err(NoImage::Several(there.clone()))),
            },
        };
        there.iter().zip(&chosen).map(decide).collect()
    }

    /// Body of a facet.
    fn body_of(&self, facet: u32) -> Option<usize> {
        self.bodies[self.part.conditions.nodes(facet)[0] as usize]
    }

    /// Weights of the nodes of the nearest of these facets on which a point lies.
    fn on_facets(&self, facets: impl Iterator<Item = u32>, point: [f64; 3]) -> Option<Vec<(u32, f64)>> {
        let on = |at: u32| {
            let shape = self.part.conditions.kinds[at as usize].cell?;
            let nodes = self.part.conditions.nodes(at);
            let x: Vec<[f64; 3]> = nodes.iter().map(|&node| self.part.nodes.initial[node as usize]).collect();
            let size = x.iter().map(|end| norm(sub(*end, x[0]))).fold(0.0, f64::max);
            let found = mapping::local_coordinates(shape, &x, point)?;
            if found.distance > OFF_FACET * size || !shape.cell().contains(found.xi, OFF_FACET) {
                return None;
            }
            // A point beyond the edge by round-off or a chord belongs to the edge.
            let xi = shape.cell().clamped(found.xi);
            let mut weights = [0.0; 27];
            shape_functions(shape, xi, &mut weights);
            let at = nodes.iter().enumerate().fold([0.0; 3], |sum, (i, _)| add(sum, scale(x[i], weights[i])));
            let weights = nodes.iter().copied().zip(weights).filter(|(_, weight)| weight.abs() > f64::EPSILON);
            Some((norm(sub(at, point)), weights.collect::<Vec<_>>()))
        };
        facets.filter_map(on).min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, weights)| weights)
    }

    /// Nodes of both parts that the congruence carries onto themselves, within `tolerance`; `Err` with one that it moves.
    pub fn kept_by(&self, way: &Congruence, other: &SubPart, tolerance: f64) -> Result<Vec<u32>, u32> {
        let both = other.nodes.iter().copied().filter(|node| self.own.nodes.binary_search(node).is_ok());
        let moved = |node: u32| {
            let x = self.part.nodes.initial[node as usize];
            norm(sub(way.image(x), x)) > tolerance
        };
        both.map(|node| if moved(node) { Err(node) } else { Ok(node) }).collect()
    }
}
