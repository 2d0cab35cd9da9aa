//! Facets of a rigid shape in its own axes.

use zelus_core::geometry::ExactSurface;
use zelus_core::vector3::{cross, dot, norm, scale, sub};

/// Share of the size of a shape below which two of its points are one.
const ONE_POINT: f64 = 1e-9;

/// A facet, whose nodes go round so that its normal points out of the rigid body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShapeFacet {
    /// Points by their place; a line has two, and its third is that of the second.
    pub points: [u32; 3],
    /// The exact surface, and its apex by its place among [`ShapeFacets::apexes`]; `None` where the surface is flat.
    pub exact: Option<(ExactSurface, u32)>,
}

/// Points, apexes and facets.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ShapeFacets {
    /// Corners of facets.
    pub points: Vec<[f64; 3]>,
    /// Apexes of curved facets.
    pub apexes: Vec<[f64; 3]>,
    /// The facets.
    pub facets: Vec<ShapeFacet>,
}

impl ShapeFacets {
    /// Adds a point; gives its place.
    pub fn point(&mut self, x: [f64; 3]) -> u32 {
        self.points.push(x);
        self.points.len() as u32 - 1
    }

    /// Adds an apex; gives its place.
    pub fn apex(&mut self, x: [f64; 3]) -> u32 {
        self.apexes.push(x);
        self.apexes.len() as u32 - 1
    }

    /// Adds a triangle that has an area.
    pub fn triangle(&mut self, points: [u32; 3], exact: Option<(ExactSurface, u32)>) {
        let [a, b, c] = points.map(|at| self.points[at as usize]);
        let longest = [sub(b, a), sub(c, b), sub(a, c)].map(norm).into_iter().fold(0.0, f64::max);
        if norm(cross(sub(b, a), sub(c, a))) > ONE_POINT * longest * longest {
            self.facets.push(ShapeFacet { points, exact });
        }
    }

    /// Adds a line.
    pub fn line(&mut self, [a, b]: [u32; 2], exact: Option<(ExactSurface, u32)>) {
        self.facets.push(ShapeFacet { points: [a, b, b], exact });
    }

    /// Largest distance of two points along an axis.
    pub fn size(&self) -> f64 {
        let range = |c: usize| {
            let all = self.points.iter().map(|x| x[c]);
            all.clone().fold(f64::NEG_INFINITY, f64::max) - all.fold(f64::INFINITY, f64::min)
        };
        (0..3).map(range).fold(0.0, f64::max)
    }

    /// Six times the volume that triangles enclose, as they go round: negative where normals point inwards.
    pub fn enclosed(&self) -> f64 {
        let own = |facet: &ShapeFacet| {
            let [a, b, c] = facet.points.map(|at| self.points[at as usize]);
            dot(a, cross(b, c))
        };
        self.facets.iter().map(own).sum()
    }

    /// The same facets at places that a function gives.
    #[must_use]
    pub fn moved(mut self, to: &dyn Fn([f64; 3]) -> [f64; 3]) -> Self {
        self.points.iter_mut().chain(&mut self.apexes).for_each(|x| *x = to(*x));
        self
    }
}

/// The mean of two points.
pub(super) fn middle(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    scale(std::array::from_fn(|c| a[c] + b[c]), 0.5)
}
