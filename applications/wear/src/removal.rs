//! Takes a worn volume off one side of an interface.
//!
//! The law gives a volume at points of the facets. A node gets its share V_j = ∫ φ_j w da, is worn by w_j = V_j/∫ φ_j dA and moves by
//! −V_j b_j/|b_j|², b_j = ∫ φ_j n dA: so do both faces of an edge recede by w_j. Areas and normals are those of the initial shape,
//! since removed material is free of stress. The motion takes off −Σ Δx_j·∫ N_j n dA; on facets of first order, where φ = N, that is Σ
//! V_j of itself. On those of second order, lines and triangles, whose N have negative values, φ are Bernstein's polynomials, and one
//! factor for the whole side, near one, keeps the volume.

use std::f64::consts::TAU;

use zelus_contact_structural_mechanics::interface::{Facet, Interface, Roles};
use zelus_contact_structural_mechanics::mortar::MOST_NODES;
use zelus_core::geometry::mapping::area_normal;
use zelus_core::geometry::{Shape, ShapeTable};
use zelus_core::model::Nodes;
use zelus_core::vector3::{add, dot, scale};

/// How a node of a side wears.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NodalWear {
    /// Node index.
    pub node: u32,
    /// Depth (length).
    pub depth: f64,
    /// Where it goes (length).
    pub way: [f64; 3],
}

/// One side of an interface, with its losses in a step.
pub struct Side {
    /// Ascending.
    nodes: Vec<u32>,
    volumes: Vec<f64>,
    total: f64,
}

impl Side {
    /// The side of this role, unworn.
    pub fn new(interface: &Interface, role: Roles) -> Self {
        let nodes = interface.nodes_of(role);
        Self { volumes: vec![0.0; nodes.len()], nodes, total: 0.0 }
    }

    /// Adds a volume at a point of a facet, where its shape functions have the values `n`.
    pub fn add(&mut self, facet: &Facet, n: &[f64], volume: f64) {
        self.total += volume;
        for (&node, share) in facet.nodes.iter().zip(shares(facet.shape, n)) {
            self.volumes[place(&self.nodes, node)] += share * volume;
        }
    }

    /// The volume it has lost.
    pub fn total(&self) -> f64 {
        self.total
    }

    /// How its nodes wear; `around` says that it is of revolution about the y axis.
    pub fn worn(&self, facets: &[Facet], role: Roles, nodes: &Nodes, around: bool) -> Vec<NodalWear> {
        if self.total <= 0.0 {
            return Vec::new();
        }
        let mut sums = vec![NodalSums::default(); self.nodes.len()];
        for facet in facets.iter().filter(|facet| facet.role == role) {
            let x: Vec<[f64; 3]> = facet.nodes.iter().map(|&node| nodes.initial[node as usize]).collect();
            let table = ShapeTable::default_of(facet.shape);
            for (g, point) in table.points().iter().enumerate() {
                let n = table.n_at(g);
                let round = if around { TAU * n.iter().zip(&x).map(|(n, x)| n * x[0]).sum::<f64>() } else { 1.0 };
                let normal = scale(area_normal(facet.shape, &x, point.xi), point.weight * round);
                let area = dot(normal, normal).sqrt();
                for ((&node, n), share) in facet.nodes.iter().zip(n).zip(shares(facet.shape, n)) {
                    let sum = &mut sums[place(&self.nodes, node)];
                    sum.area += share * area;
                    sum.normal = add(sum.normal, scale(normal, share));
                    sum.taken = add(sum.taken, scale(normal, *n));
                }
            }
        }
        let worn = |((&node, &volume), sum): ((&u32, &f64), &NodalSums)| {
            let way = scale(sum.normal, -volume / dot(sum.normal, sum.normal));
            (NodalWear { node, depth: volume / sum.area, way }, -dot(way, sum.taken))
        };
        let loses = |((_, volume), _): &((&u32, &f64), &NodalSums)| **volume > 0.0;
        let found: Vec<_> = self.nodes.iter().zip(&self.volumes).zip(&sums).filter(loses).map(worn).collect();
        let factor = self.total / found.iter().map(|(_, taken)| taken).sum::<f64>();
        let scaled =
            |(own, _): (NodalWear, f64)| NodalWear { depth: factor * own.depth, way: scale(own.way, factor), ..own };
        found.into_iter().map(scaled).collect()
    }
}

/// Sums over the facets around a node, weighted by its φ, or by its N.
#[derive(Clone, Copy, Default)]
struct NodalSums {
    area: f64,
    normal: [f64; 3],
    /// By N.
    taken: [f64; 3],
}

/// The functions φ at a point where the shape functions are `n`: positive, adding up to one.
fn shares(shape: Shape, n: &[f64]) -> [f64; MOST_NODES] {
    let corners = shape.cell().corners();
    let mut out = [0.0; MOST_NODES];
    out[..n.len()].copy_from_slice(n);
    for (edge, n) in n[corners..].iter().enumerate() {
        out[corners + edge] = 0.5 * n;
        out[edge] += 0.25 * n;
        out[(edge + 1) % corners] += 0.25 * n;
    }
    out
}

fn place(nodes: &[u32], node: u32) -> usize {
    nodes.binary_search(&node).expect("a node of the side")
}
