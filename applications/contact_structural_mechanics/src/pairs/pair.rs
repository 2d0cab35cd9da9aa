//! One slave facet and one master facet that overlap.

use serde::{Deserialize, Serialize};
use zelus_core::Result;
use zelus_core::diagnostics::unfit;
use zelus_core::geometry::FacetShape;

use crate::interface::{Interface, Roles};
use crate::mortar::{Choices, MOST_NODES, Operators};

/// Key of a pair: its interface and facets.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
pub struct PairKey {
    /// Position of the interface.
    pub interface: u32,
    /// Slave facet of the interface.
    pub slave: u32,
    /// Master facet of the interface.
    pub master: u32,
}

/// Whether there are the facets of these pairs, on their sides.
///
/// # Errors
/// One that is not.
pub fn check_pairs(interfaces: &[Interface], mut keys: impl Iterator<Item = PairKey>) -> Result<()> {
    let side = |interface: u32, facet: u32| Some(interfaces.get(interface as usize)?.facets.get(facet as usize)?.role);
    let known = |key: PairKey| {
        let sides = (side(key.interface, key.slave), side(key.interface, key.master));
        sides == (Some(Roles::Slave), Some(Roles::Master))
    };
    if keys.all(known) { Ok(()) } else { Err(unfit("the pairs of facets that it remembers are not there")) }
}

/// Operators at the start of the step, against which slip is measured.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Previous {
    /// D of the start of the step, row by row; empty without overlap.
    d: Vec<f64>,
    /// M of the start of the step.
    m: Vec<f64>,
}

impl Previous {
    /// The operators of a pair, to be kept.
    pub fn of(operators: &Operators<f64>) -> Self {
        Self {
            d: operators.d.iter().flat_map(|row| row.iter().copied()).collect(),
            m: operators.m.iter().flat_map(|row| row.iter().copied()).collect(),
        }
    }

    /// Whether the pair had no overlap.
    pub fn is_empty(&self) -> bool {
        self.d.is_empty()
    }

    /// D and M of a pair of these shapes.
    pub fn operators(&self, slave: &FacetShape, master: &FacetShape) -> Operators<f64> {
        if self.d.is_empty() {
            return Operators::zero(slave, master);
        }
        Operators {
            d: slave.nodal(|j| slave.nodal(|k| self.d[j * slave.nodes + k])),
            m: slave.nodal(|j| master.nodal(|l| self.m[j * master.nodes + l])),
        }
    }
}

/// A pair with its state between iterations and steps.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Pair {
    /// Its facets.
    pub key: PairKey,
    /// Slave normal on which the overlap is cut: that of the step which made the pair, unless normals are updated.
    pub slave_normal: [f64; 3],
    /// Master normal onto whose plane points are projected: that of the start of the step, unless normals are updated.
    pub master_normal: [f64; 3],
    /// Whether the facets overlap now; a pair that does not is isolated and contributes nothing.
    pub overlapping: bool,
    /// Area that it has of each slave node, in the state integrated last.
    pub area: [f64; MOST_NODES],
    /// Operators at the start of the step.
    pub previous: Previous,
    /// Choices of the integration that are frozen until the step ends.
    pub choices: Choices,
}

impl Pair {
    /// A pair that overlaps and has no history, with these normals of its slave and its master.
    pub fn new(key: PairKey, [slave_normal, master_normal]: [[f64; 3]; 2]) -> Self {
        let (area, previous, choices) = Default::default();
        Self { key, slave_normal, master_normal, overlapping: true, area, previous, choices }
    }
}

/// Contribution of a pair to the sums of its slave nodes.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Integral {
    /// Whether the facets overlap by more than a sliver.
    pub overlapping: bool,
    /// Whether they overlap at all.
    pub facing: bool,
    /// Row sums of D (area).
    pub area: [f64; MOST_NODES],
    /// Weighted gap, negative in penetration.
    pub gap: [f64; MOST_NODES],
    /// Weighted slip of the step.
    pub slip: [[f64; 3]; MOST_NODES],
    /// Weighted tangential opening of a bond.
    pub sliding: [[f64; 3]; MOST_NODES],
    /// Area times trial traction, where a formulation carries tractions from state to state.
    pub trial: [[f64; 3]; MOST_NODES],
    /// Area times traction that the body lacks, where integration points decide on friction.
    pub history_traction: [[f64; 3]; MOST_NODES],
}
