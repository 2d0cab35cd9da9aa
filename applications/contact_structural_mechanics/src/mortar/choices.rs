//! Choices of the integration that a pair freezes while a step is iterated, so that its operators stay continuous.
//!
//! The reference program's integration jumps: cells share the first vertex of the overlap by a rule on kinds of vertices, an overlap of
//! one triangle takes standard shape functions for dual ones, a sliver is ignored. Where an equilibrium lies on such a jump no iterate
//! reaches it, however short the step; with frozen choices one does.

use serde::{Deserialize, Serialize};

/// The choices a pair has frozen; none at first.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Choices {
    /// Local coordinates on the slave near which the vertex lies that all cells share.
    pub origin: Option<[f64; 2]>,
    /// The linear sub-facets of the slave, a bit each, on which standard shape functions stand in for dual ones.
    pub plain: u8,
    /// Whether slivers count: an overlap with one triangle more or less then changes nothing by a jump, and no area is lost.
    pub slivers: bool,
}

impl Choices {
    /// Whether standard shape functions stand in for dual ones on a sub-facet of the slave.
    pub fn is_plain(&self, sub_facet: usize) -> bool {
        self.plain & (1 << sub_facet) != 0
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Overlap, PairGeometry, SegmentationSettings, choices_of, operators};
    use super::*;
    use zelus_core::geometry::QUADRILATERAL_4;

    /// Two trapezoids; moved by `x`, a master node leaves the slave across its lower edge.
    fn pair(x: f64, choices: Choices) -> PairGeometry<f64> {
        let place = |[px, py]: [f64; 2]| [px + 0.4, py + x, 0.1];
        PairGeometry {
            slave_shape: &QUADRILATERAL_4,
            master_shape: &QUADRILATERAL_4,
            slave: [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.2, 1.0, 0.0], [0.0, 1.3, 0.0]].into(),
            master: [[0.0, 0.0], [0.1, 1.1], [0.9, 1.0], [1.0, 0.1]].map(place).into(),
            nodal_normals: [[0.0, 0.0, 1.0]; 4].into(),
            slave_normal: [0.0, 0.0, 1.0],
            master_normal: [0.0, 0.0, -1.0],
            exact: None,
            choices,
        }
    }

    fn jump(choices: Choices) -> f64 {
        let at = |x| match operators(&pair(x, choices), &SegmentationSettings::default()) {
            Overlap::Cells(found) => found,
            _ => panic!("they overlap"),
        };
        at(1e-9).norms_of_change(&at(-1e-9))[1]
    }

    #[test]
    fn a_pair_that_keeps_its_first_vertex_changes_continuously() {
        let Overlap::Cells(found) = operators(&pair(1e-9, Choices::default()), &SegmentationSettings::default()) else {
            panic!("they overlap")
        };
        let kept = choices_of(&pair(1e-9, Choices::default()), &SegmentationSettings::default(), &found);
        assert!(kept.origin.is_some() && kept.plain == 0);
        assert!(jump(Choices::default()) > 1e-4, "{}", jump(Choices::default()));
        assert!(jump(kept) < 1e-7, "{}", jump(kept));
    }
}
