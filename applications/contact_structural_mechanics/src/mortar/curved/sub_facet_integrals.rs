//! Integrals over the overlap of a sub-facet of the slave with the master, and D and M made of them.

use super::super::geometry::Active;
use super::super::operators::{Operators, by_nodal_normals, inverse};
use super::super::overlap_point::OverlapPoint;
use super::linear_functions::{PIECE, linear_functions};
use zelus_core::geometry::{FacetShape, Nodal};
use zelus_core::scalar::{Dual, Real};

/// Integrals over the overlap of a sub-facet of the slave: Me, ∫ L⊗N¹ and ∫ L⊗N².
pub(super) struct SubFacetIntegrals<T: Real> {
    slave_shape: &'static FacetShape,
    nodes: &'static [usize],
    me: [[T; PIECE]; PIECE],
    slave: [Nodal<T>; PIECE],
    master: [Nodal<T>; PIECE],
}

impl<T: Real> SubFacetIntegrals<T> {
    /// Integrals of a sub-facet without overlap.
    pub(super) fn zero(slave: &'static FacetShape, master: &FacetShape, sub_facet: usize) -> Self {
        let zero = T::zero();
        Self {
            slave_shape: slave,
            nodes: slave.sub_facets[sub_facet],
            me: [[zero; PIECE]; PIECE],
            slave: [slave.nodal(|_| zero); PIECE],
            master: [master.nodal(|_| zero); PIECE],
        }
    }

    /// Adds a point of the sub-facet.
    pub(super) fn add(&mut self, point: &OverlapPoint<T>) {
        let count = self.nodes.len();
        let linear = linear_functions(self.slave_shape, self.nodes, point.local);
        for i in 0..count {
            let weighted = linear[i] * point.weight;
            (i..count).for_each(|j| self.me[i][j].add_product(weighted, linear[j]));
            // Of a slave of first order these are Me.
            if self.slave_shape.curved {
                let own = self.slave[i].iter_mut().zip(point.slave.iter());
                own.for_each(|(sum, shape)| sum.add_product(weighted, *shape));
            }
            let others = self.master[i].iter_mut().zip(point.master.iter());
            others.for_each(|(sum, shape)| sum.add_product(weighted, *shape));
        }
    }

    /// Whether there is any overlap.
    pub(super) fn is_covered(&self) -> bool {
        self.me[0][0].value() > 0.0
    }
}

impl SubFacetIntegrals<Active> {
    /// Adds a point of the sub-facet that is moved on the master by the normal interpolated there: `by_normal` are the derivatives
    /// of the shape functions of the master by its components. Derivatives are by components of the normals of nodes, [`LANES`](super::super::geometry::LANES)
    /// of them from the one numbered `first` on, node by node.
    pub(super) fn add_by_normals(&mut self, point: &OverlapPoint<f64>, by_normal: &[[f64; 3]], first: usize) {
        let count = self.nodes.len();
        let linear = linear_functions(self.slave_shape, self.nodes, point.local);
        let weighted: [f64; PIECE] = std::array::from_fn(|i| linear[i] * point.weight);
        for i in 0..count {
            (i..count).for_each(|j| self.me[i][j].value += weighted[i] * linear[j]);
            let own = self.slave[i].iter_mut().zip(point.slave.iter());
            own.for_each(|(sum, shape)| sum.value += weighted[i] * shape);
        }
        for (l, (shape, derivatives)) in point.master.iter().zip(by_normal).enumerate() {
            let moved = by_nodal_normals(Dual { value: *shape, gradient: *derivatives }, &point.slave, first);
            (0..count).for_each(|i| self.master[i][l].add_scaled(moved, weighted[i]));
        }
    }
}

impl<T: Real> SubFacetIntegrals<T> {
    /// Entry of Me, which is symmetric.
    fn me(&self, i: usize, j: usize) -> T {
        self.me[i.min(j)][i.max(j)]
    }

    /// Me⁻¹; `None` where it is too badly conditioned.
    pub(super) fn inverse(&self) -> Option<[[f64; PIECE]; PIECE]> {
        // The diagonal of nodes that the sub-facet has not keeps the matrix regular and its condition as it is.
        let (count, filler) = (self.nodes.len(), self.me[0][0].value());
        let me = Nodal::new(PIECE, |i| {
            Nodal::new(PIECE, |j| {
                let missing = i >= count || j >= count;
                if missing { if i == j { filler } else { 0.0 } } else { self.me(i, j).value() }
            })
        });
        let inverse = inverse(&me)?;
        Some(std::array::from_fn(|i| std::array::from_fn(|j| inverse[i][j])))
    }

    /// Adds to D and M, with standard functions where that is chosen or there are no dual ones.
    pub(super) fn add_to(&self, standard: bool, out: &mut Operators<T>) {
        match Some(self).filter(|_| !standard).and_then(SubFacetIntegrals::inverse) {
            Some(inverse) => self.add_dual(&inverse, out),
            None => self.add_standard(out),
        }
    }

    fn add_standard(&self, out: &mut Operators<T>) {
        let slave = self.slave_shape;
        for (i, &node) in self.nodes.iter().enumerate() {
            for k in 0..slave.nodes {
                // A slave of first order is its only sub-facet.
                out.d[node][k] += if slave.curved { self.slave[i][k] } else { self.me(i, k) };
            }
            out.m[node].iter_mut().zip(self.master[i].iter()).for_each(|(sum, own)| *sum += *own);
        }
    }

    fn add_dual(&self, inverse: &[[f64; PIECE]; PIECE], out: &mut Operators<T>) {
        let (slave, count) = (self.slave_shape, self.nodes.len());
        let de: [T; PIECE] = std::array::from_fn(|i| (0..count).fold(T::zero(), |sum, j| sum + self.me(i, j)));
        if !slave.curved {
            self.nodes.iter().enumerate().for_each(|(i, &node)| out.d[node][node] += de[i]);
        }
        // De Me⁻¹ ∫ L N: on values, then one correction, which brings the derivative.
        let times_dual = |of: &dyn Fn(usize) -> T| -> [T; PIECE] {
            let values: [f64; PIECE] = std::array::from_fn(|i| (0..count).map(|j| inverse[i][j] * of(j).value()).sum());
            let residual: [T; PIECE] = std::array::from_fn(|i| {
                let mut rest = if i < count { of(i) } else { T::zero() };
                (0..count).for_each(|j| rest.add_scaled(self.me(i, j), -values[j]));
                rest
            });
            std::array::from_fn(|i| {
                let mut x = T::constant(values[i]);
                (0..count).for_each(|j| x.add_scaled(residual[j], inverse[i][j]));
                de[i] * x
            })
        };
        for k in 0..if slave.curved { slave.nodes } else { 0 } {
            let found = times_dual(&|i| self.slave[i][k]);
            self.nodes.iter().zip(found).for_each(|(&node, own)| out.d[node][k] += own);
        }
        for l in 0..self.master[0].len() {
            let found = times_dual(&|i| self.master[i][l]);
            self.nodes.iter().zip(found).for_each(|(&node, own)| out.m[node][l] += own);
        }
    }
}
