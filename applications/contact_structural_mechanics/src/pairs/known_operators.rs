//! The operators that a pair was found to have, and where it stood then.

use zelus_core::geometry::{FacetShape, NodeArray};

use crate::mortar::{Choices, Operators, Overlap, PairGeometry};

/// Operators of a pair as it stood; they serve every question that is asked of the same state.
#[derive(Debug, Clone, Copy)]
pub(super) struct KnownOperators<S: FacetShape, M: FacetShape> {
    /// As it stood.
    pub geometry: PairGeometry<f64, S, M>,
    /// What it had.
    pub found: Overlap<Operators<f64, S, M>>,
}

impl<S: FacetShape, M: FacetShape> KnownOperators<S, M> {
    /// The operators of a pair that stands as this one did.
    pub(super) fn of(&self, pair: &PairGeometry<f64, S, M>) -> Option<Overlap<Operators<f64, S, M>>> {
        if !stand_alike(&self.geometry, pair) {
            return None;
        }
        let (before, now) = (self.geometry.choices, pair.choices);
        // What counts where slivers do not, counts where they do.
        let is_cells = matches!(self.found, Overlap::Cells(_));
        let same = before == now || is_cells && before == (Choices { slivers: false, ..now });
        same.then_some(self.found)
    }
}

/// Whether nodes and normals are the same numbers.
fn stand_alike<S: FacetShape, M: FacetShape>(a: &PairGeometry<f64, S, M>, b: &PairGeometry<f64, S, M>) -> bool {
    a.slave.as_slice() == b.slave.as_slice()
        && a.master.as_slice() == b.master.as_slice()
        && a.nodal_normals.as_slice() == b.nodal_normals.as_slice()
        && (a.slave_normal, a.master_normal) == (b.slave_normal, b.master_normal)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mortar::{SegmentationSettings, operators};
    use zelus_core::geometry::Triangle3;

    /// A triangle below another one of which `share` lies above it, along either edge.
    fn pair(share: f64, slivers: bool) -> PairGeometry<f64, Triangle3, Triangle3> {
        PairGeometry {
            slave: [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            master: [[share, 0.0, 0.0], [share - 1.0, 0.0, 0.0], [share, 1.0, 0.0]],
            nodal_normals: [[0.0, 0.0, 1.0]; 3],
            slave_normal: [0.0, 0.0, 1.0],
            master_normal: [0.0, 0.0, -1.0],
            choices: Choices { slivers, ..Choices::default() },
        }
    }

    fn known(pair: PairGeometry<f64, Triangle3, Triangle3>) -> KnownOperators<Triangle3, Triangle3> {
        KnownOperators { geometry: pair, found: operators(&pair, &SegmentationSettings::default()) }
    }

    #[test]
    fn they_serve_the_same_state_alone() {
        let kept = known(pair(0.5, false));
        assert!(kept.of(&pair(0.5, false)).and_then(Overlap::cells).is_some());
        assert!(kept.of(&pair(0.5 + 1e-15, false)).is_none());
        let mut turned = pair(0.5, false);
        turned.nodal_normals[2] = [1e-12, 0.0, 1.0];
        assert!(kept.of(&turned).is_none());
        turned = pair(0.5, false);
        turned.choices.origin = Some([0.0; 2]);
        assert!(kept.of(&turned).is_none());
    }

    #[test]
    fn what_was_a_sliver_is_looked_at_again_where_slivers_count() {
        let [whole, sliver] = [0.5, 1e-7].map(|share| known(pair(share, false)));
        assert!(whole.of(&pair(0.5, true)).and_then(Overlap::cells).is_some());
        assert!(matches!(sliver.found, Overlap::Sliver));
        assert!(sliver.of(&pair(1e-7, true)).is_none());
        // The other way round it may be one that counts no more.
        assert!(known(pair(1e-7, true)).of(&pair(1e-7, false)).is_none());
    }
}
