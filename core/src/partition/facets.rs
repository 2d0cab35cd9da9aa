//! The surfaces that touch each other, as faces of elements.

use rustc_hash::FxHashMap;

use super::faces::Face;
use super::interfaces::Surface;
use crate::geometry::Shape;
use crate::geometry::mapping::vector_area;
use crate::model::ModelPart;
use crate::vector3::{add, dot, norm, scale, sub};

/// A face of an element on a surface that may touch another.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactFacet {
    /// The element behind it.
    pub element: u32,
    /// Surface to which it belongs.
    pub surface: u32,
    /// Whether pairs are evaluated here.
    pub slave: bool,
    /// Centre of its corners in the initial mesh.
    pub centre: [f64; 3],
    /// Outward normal times the area (in the plane: length); zero where it has no direction.
    pub normal: [f64; 3],
    /// Largest distance of a corner from the centre.
    pub radius: f64,
}

/// The outer faces whose corners all belong to a surface.
pub(super) fn contact_facets(part: &ModelPart, outer: &[Face], surfaces: &[Surface]) -> Vec<ContactFacet> {
    let mut out = Vec::new();
    for (at, surface) in surfaces.iter().enumerate() {
        let marked = |list: &[u32]| {
            let mut on = vec![false; part.nodes.len()];
            list.iter().for_each(|&node| on[node as usize] = true);
            on
        };
        let (on, slave) = (marked(&surface.nodes), marked(&surface.slaves));
        for face in outer {
            let corners = face.corners();
            let all = |on: &[bool]| corners.iter().all(|&node| on[node as usize]);
            if surface.whole_skin || all(&on) {
                let positions = face.ordered(part).map(|node| part.nodes.initial[node as usize]).collect::<Vec<_>>();
                let slave = surface.slaves.is_empty() || all(&slave);
                out.push(facet(face, face.shape(part).linear(), at as u32, slave, &positions));
            }
        }
    }
    out
}

fn facet(face: &Face, shape: Shape, surface: u32, slave: bool, corners: &[[f64; 3]]) -> ContactFacet {
    let sum = corners.iter().fold([0.0; 3], |sum, &x| add(sum, x));
    let centre = scale(sum, 1.0 / corners.len().max(1) as f64);
    let radius = corners.iter().map(|&x| norm(sub(x, centre))).fold(0.0, f64::max);
    ContactFacet { element: face.element, surface, slave, centre, normal: vector_area(shape, corners), radius }
}

/// For each slave facet the nearest facet that faces it, on the same surface and within two mean diameters.
pub(super) fn facing_pairs(facets: &[ContactFacet]) -> Vec<(u32, u32)> {
    if facets.is_empty() {
        return Vec::new();
    }
    let cell = 4.0 * facets.iter().map(|f| f.radius).sum::<f64>() / facets.len() as f64;
    if cell <= 0.0 {
        return Vec::new();
    }
    let key = |x: [f64; 3]| x.map(|x| (x / cell).floor() as i64);
    let mut cells: FxHashMap<[i64; 3], Vec<u32>> = FxHashMap::default();
    for (at, facet) in facets.iter().enumerate() {
        cells.entry(key(facet.centre)).or_default().push(at as u32);
    }
    let mut out = Vec::new();
    for (at, facet) in facets.iter().enumerate().filter(|(_, facet)| facet.slave) {
        let [i, j, k] = key(facet.centre);
        let mut best: Option<(f64, u32)> = None;
        for near in (0..27).map(|n| [i + n % 3 - 1, j + n / 3 % 3 - 1, k + n / 9 - 1]) {
            for &other in cells.get(&near).map_or(&[][..], Vec::as_slice) {
                let candidate = &facets[other as usize];
                let apart = candidate.surface != facet.surface || candidate.element == facet.element;
                if apart || dot(candidate.normal, facet.normal) >= 0.0 {
                    continue;
                }
                let distance = norm(sub(candidate.centre, facet.centre));
                if distance <= cell && best.is_none_or(|best| (distance, other) < best) {
                    best = Some((distance, other));
                }
            }
        }
        out.extend(best.map(|(_, other)| (at as u32, other)));
    }
    out
}
