//! Cached operators of a pair, and the geometry they belong to.

use zelus_core::geometry::Nodal;

use crate::mortar::{Choices, Operators, Overlap, PairGeometry};

/// Operators of a pair at the last evaluated geometry; they are reused while that stays the same.
///
/// Numbers are contiguous in memory: a model has many pairs.
#[derive(Debug, Clone)]
pub(super) struct KnownOperators {
    /// Positions and normals, then D and M where there are any.
    numbers: Box<[f64]>,
    choices: Choices,
    found: Overlap<()>,
}

/// The numbers of a pair that its operators depend on.
fn numbers_of(pair: &PairGeometry<f64>) -> impl Iterator<Item = f64> + '_ {
    let nodal = pair.slave.iter().chain(pair.master.iter()).chain(pair.nodal_normals.iter());
    nodal.chain([&pair.slave_normal, &pair.master_normal]).flatten().copied()
}

impl KnownOperators {
    /// The operators that a pair was found to have.
    pub(super) fn new(pair: &PairGeometry<f64>, found: &Overlap<Operators<f64>>) -> Self {
        let operators = match found {
            Overlap::Cells(operators) => Some(operators),
            Overlap::Sliver | Overlap::None => None,
        };
        let entries = operators.into_iter().flat_map(|own| own.d.iter().chain(own.m.iter())).flat_map(|row| row.iter());
        let numbers: Vec<f64> = numbers_of(pair).chain(entries.copied()).collect();
        let found = match found {
            Overlap::Cells(_) => Overlap::Cells(()),
            Overlap::Sliver => Overlap::Sliver,
            Overlap::None => Overlap::None,
        };
        Self { numbers: numbers.into(), choices: pair.choices, found }
    }

    /// The operators of a pair that stands as this one did.
    pub(super) fn of(&self, pair: &PairGeometry<f64>) -> Option<Overlap<Operators<f64>>> {
        if !numbers_of(pair).zip(&self.numbers).all(|(a, b)| a == *b) {
            return None;
        }
        let (before, now) = (self.choices, pair.choices);
        // Cells that count where slivers do not, count where they do.
        let is_cells = matches!(self.found, Overlap::Cells(()));
        let same = before == now || is_cells && before == (Choices { slivers: false, ..now });
        same.then(|| self.found.map(|()| self.operators(pair.slave.len(), pair.master.len())))
    }

    fn operators(&self, slaves: usize, masters: usize) -> Operators<f64> {
        let (d, m) = self.numbers[self.numbers.len() - slaves * (slaves + masters)..].split_at(slaves * slaves);
        Operators {
            d: Nodal::new(slaves, |j| Nodal::of(&d[j * slaves..(j + 1) * slaves])),
            m: Nodal::new(slaves, |j| Nodal::of(&m[j * masters..(j + 1) * masters])),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mortar::{SegmentationSettings, operators};
    use zelus_core::geometry::TRIANGLE_3;

    /// A triangle below another one of which `share` lies above it, along either edge.
    fn pair(share: f64, slivers: bool) -> PairGeometry<f64> {
        PairGeometry {
            slave_shape: &TRIANGLE_3,
            master_shape: &TRIANGLE_3,
            slave: [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].into(),
            master: [[share, 0.0, 0.0], [share - 1.0, 0.0, 0.0], [share, 1.0, 0.0]].into(),
            nodal_normals: [[0.0, 0.0, 1.0]; 3].into(),
            slave_normal: [0.0, 0.0, 1.0],
            master_normal: [0.0, 0.0, -1.0],
            exact: None,
            choices: Choices { slivers, ..Choices::default() },
        }
    }

    fn known(pair: PairGeometry<f64>) -> KnownOperators {
        KnownOperators::new(&pair, &operators(&pair, &SegmentationSettings::default()))
    }

    #[test]
    fn they_serve_the_same_state_alone() {
        let kept = known(pair(0.5, false));
        let found = kept.of(&pair(0.5, false)).and_then(Overlap::cells).unwrap();
        let exact = operators(&pair(0.5, false), &SegmentationSettings::default()).cells().unwrap();
        assert_eq!((found.d, found.m), (exact.d, exact.m));
        assert!(kept.of(&pair(0.5 + 1e-15, false)).is_none());
        let mut rotated = pair(0.5, false);
        rotated.nodal_normals[2] = [1e-12, 0.0, 1.0];
        assert!(kept.of(&rotated).is_none());
        rotated = pair(0.5, false);
        rotated.choices.origin = Some([0.0; 2]);
        assert!(kept.of(&rotated).is_none());
    }

    #[test]
    fn a_sliver_is_looked_at_again_where_slivers_count() {
        let [whole, sliver] = [0.5, 1e-7].map(|share| known(pair(share, false)));
        assert!(whole.of(&pair(0.5, true)).and_then(Overlap::cells).is_some());
        assert!(matches!(sliver.found, Overlap::Sliver));
        assert!(sliver.of(&pair(1e-7, true)).is_none());
        // The other way round it may be one that counts no more.
        assert!(known(pair(1e-7, true)).of(&pair(1e-7, false)).is_none());
    }
}
