//! Facets that meet: they face each other, near enough to be a pair.

use std::collections::{BTreeMap, BTreeSet};

use zelus_core::model::ModelPart;
use zelus_core::vector3::{dot, norm, scale, sub};

use super::candidates::{Candidate, FacetExtent, SLACK, SearchSettings, among};
use super::motion::have_crossed;
use super::open_sides::Renewal;
use crate::interface::{Facet, Interface};

/// Cosine of the angle between normals beyond which facets do not face each other, 84°.
pub(crate) const FACING: f64 = 0.1;

/// Cosine from which on facets face each other straight: one may have come through the other.
const STRAIGHT: f64 = 0.5;

/// Height above a facet, in radii, that a facet at an angle to it reaches somewhere where they meet: across an edge it is zero.
const BESIDE: f64 = 0.05;

/// How a facet meets another.
#[derive(Debug, Clone, Copy)]
struct Meeting {
    other: u32,
    /// Between their normals, one turned round: 1 where they face each other straight.
    cosine: f64,
    /// Between their centres.
    distance: f64,
}

/// The facets that each facet meets.
///
/// A facet does not meet another that a facet of the same body faces nearer and twice as straight: the flank of a block does not
/// meet the floor below its bottom.
pub(super) fn facing(
    part: &ModelPart,
    interface: &Interface,
    bodies: &[Option<usize>],
    settings: &SearchSettings,
    renewal: Renewal,
) -> BTreeMap<u32, Vec<u32>> {
    let all: Vec<u32> = (0..interface.facets.len() as u32).collect();
    // Meetings by facet.
    let mut meeting: BTreeMap<u32, Vec<Meeting>> = BTreeMap::new();
    let mut candidates = among(part, interface, &all, &all, settings, false);
    candidates.retain(|candidate| candidate.within_reach);
    let extents: Vec<FacetExtent> = interface.facets.iter().map(|facet| FacetExtent::of(part, facet)).collect();
    let facet = |at: u32| (&interface.facets[at as usize], &extents[at as usize]);
    for &Candidate { slave, master, .. } in &candidates {
        let (one, other) = (facet(slave), facet(master));
        if one.0.nodes.iter().all(|n| !other.0.nodes.contains(n))
            && let Some((cosine, distance)) = meet(part, one, other, renewal == Renewal::Open)
        {
            meeting.entry(master).or_default().push(Meeting { other: slave, cosine, distance });
            meeting.entry(slave).or_default().push(Meeting { other: master, cosine, distance });
        }
    }
    let body = |facet: u32| bodies[interface.facets[facet as usize].nodes[0] as usize];
    let mut straight: BTreeSet<[u32; 2]> = BTreeSet::new();
    for (&facet, own) in &meeting {
        for one in own {
            let is_straighter = |by: &Meeting| {
                by.cosine > 2.0 * one.cosine && by.distance < one.distance && body(by.other) == body(one.other)
            };
            if !own.iter().any(is_straighter) {
                straight.insert([facet, one.other]);
            }
        }
    }
    let mut facing: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for &Candidate { slave, master, .. } in &candidates {
        if straight.contains(&[slave, master]) && straight.contains(&[master, slave]) {
            facing.entry(slave).or_default().push(master);
        }
    }
    facing
}

/// Cosine and distance of two facets as in [`Meeting`]; `None` where they do not meet.
///
/// Each lies before the other, or no farther behind than one that has come through where they face each other straight: the two
/// sides of a body face away from each other, a face faces past the flank of a body before it. Seen along the normal of either they may overlap.
/// Facets that have crossed in the step meet where `crossed` holds.
fn meet(
    part: &ModelPart,
    (one, from): (&Facet, &FacetExtent),
    (other, to): (&Facet, &FacetExtent),
    crossed: bool,
) -> Option<(f64, f64)> {
    let cosine = -dot(from.normal, to.normal);
    if cosine <= FACING {
        return None;
    }
    let least = from.radius.min(to.radius) * if cosine > STRAIGHT { -1.0 } else { BESIDE };
    let lies_before = |facet: &FacetExtent, other: &Facet| {
        let height = |n: &u32| dot(sub(part.nodes.current[*n as usize], facet.centre), facet.normal);
        other.nodes.iter().map(height).fold(f64::NEG_INFINITY, f64::max) > least
    };
    let overlap = |facet: &FacetExtent, other: &FacetExtent| {
        let way = sub(other.centre, facet.centre);
        norm(sub(way, scale(facet.normal, dot(way, facet.normal)))) <= SLACK * (facet.radius + other.radius)
    };
    let meet = overlap(from, to)
        && overlap(to, from)
        && (lies_before(from, other) && lies_before(to, one)
            || crossed && have_crossed(part, one, other) && have_crossed(part, other, one));
    meet.then(|| (cosine, norm(sub(to.centre, from.centre))))
}
