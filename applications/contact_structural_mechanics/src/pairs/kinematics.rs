//! Kinematics of a pair: gap, slip, history traction and areas of its slave nodes, computed once for all laws.

use crate::law::{ContactLaw, NodeInputs, SlaveNode, SlipMeasure};
use crate::mortar::{
    FacetRotation, Operators, PairGeometry, incremental_slip, is_objective, objective_slip, rotated_slip, tangential,
    weighted_gap,
};
use zelus_core::geometry::Nodal;
use zelus_core::scalar::Real;
use zelus_core::vector3::constant;

/// A pair at the start of the step and in its last accepted state.
#[derive(Debug, Clone, Copy)]
pub struct PairHistory {
    /// D° and M°, at the start of the step; needed where slip is measured by them.
    pub previous: Option<Operators<f64>>,
    /// Positions of the slave nodes in the last accepted state.
    pub slave: Nodal<[f64; 3]>,
    /// Positions of the master nodes in the last accepted state.
    pub master: Nodal<[f64; 3]>,
}

impl PairHistory {
    /// Weighted slips s of the slave nodes of a pair by a measure; `rotation` is that of the slave facet.
    fn slip<T: Real>(
        &self,
        measure: SlipMeasure,
        geometry: &PairGeometry<T>,
        operators: &Operators<T>,
        rotation: Option<&FacetRotation<T>>,
    ) -> Nodal<[T; 3]> {
        let (slave, master, normals) = (&geometry.slave, &geometry.master, &geometry.nodal_normals);
        match (measure, rotation, &self.previous) {
            (SlipMeasure::Rotated, Some(rotation), _) => {
                rotated_slip(rotation, operators, (slave, &self.slave), (master, &self.master), normals)
            }
            (SlipMeasure::OfOperators(threshold), _, Some(previous)) => {
                if is_objective(operators, previous, threshold) {
                    return objective_slip(operators, previous, slave, master, normals);
                }
                let increment = |x: [T; 3], from: [f64; 3]| std::array::from_fn(|c| x[c] - from[c]);
                let delta_slave = Nodal::new(slave.len(), |j| increment(slave[j], self.slave[j]));
                let delta_master = Nodal::new(master.len(), |l| increment(master[l], self.master[l]));
                incremental_slip(operators, &delta_slave, &delta_master, normals)
            }
            _ => Nodal::new(slave.len(), |_| [T::zero(); 3]),
        }
    }

    /// Rotation of the slave facet since the last accepted state.
    pub fn rotation<T: Real>(&self, geometry: &PairGeometry<T>) -> FacetRotation<T> {
        FacetRotation::of_facet(geometry.slave_shape, &geometry.slave, &self.slave)
    }
}

/// Active inputs of the laws at all slave nodes of a pair, in one scalar.
pub struct PairKinematics<'a, T: Real> {
    /// The pair as it stands.
    pub geometry: &'a PairGeometry<T>,
    /// D and M.
    pub operators: &'a Operators<T>,
    gap: Nodal<T>,
    slip: Nodal<[T; 3]>,
    history: Nodal<[T; 3]>,
    /// Empty where no bond has one.
    sliding: Nodal<[T; 3]>,
    area: Nodal<T>,
}

impl<'a, T: Real> PairKinematics<'a, T> {
    /// The inputs that a law reads.
    pub fn new(
        law: &dyn ContactLaw,
        geometry: &'a PairGeometry<T>,
        operators: &'a Operators<T>,
        nodes: &[SlaveNode],
        history: &PairHistory,
    ) -> Self {
        let normals = &geometry.nodal_normals;
        let measure = law.slip();
        let rotates = law.has_history() || measure == SlipMeasure::Rotated;
        let rotation = rotates.then(|| history.rotation(geometry));
        let history_traction = |j: usize| match &rotation {
            Some(rotation) if law.has_history() => {
                tangential(rotation.apply(constant(nodes[j].history_traction)), normals[j])
            }
            _ => [T::zero(); 3],
        };
        let sliding = |j: usize| match &rotation {
            Some(rotation) => tangential(rotation.apply(constant(nodes[j].history_sliding)), normals[j]),
            None => [T::zero(); 3],
        };
        let slaves = geometry.slave.len();
        let slip = history.slip(measure, geometry, operators, rotation.as_ref());
        let gap = weighted_gap(operators, &geometry.slave, &geometry.master, normals);
        let (history, sliding_of_bonds, area) = (Nodal::empty(), Nodal::empty(), Nodal::empty());
        let mut out = Self { geometry, operators, gap, slip, history, sliding: sliding_of_bonds, area };
        // In place: with derivatives they are too large to be moved about.
        out.history.refill(slaves, history_traction);
        if nodes.iter().any(|node| node.history_sliding != [0.0; 3]) {
            out.sliding.refill(slaves, sliding);
        }
        out.area.refill(slaves, |j| operators.d[j].iter().fold(T::zero(), |sum, d| sum + *d));
        out
    }

    /// Inputs at slave node `j`.
    #[inline]
    pub fn inputs(&self, j: usize, multiplier: [T; 3]) -> NodeInputs<T> {
        NodeInputs {
            gap: self.gap[j],
            slip: self.slip[j],
            normal: self.geometry.nodal_normals[j],
            multiplier,
            history: self.history[j],
            sliding: self.sliding.get(j).copied().unwrap_or([T::zero(); 3]),
            area: self.area[j],
        }
    }
}
