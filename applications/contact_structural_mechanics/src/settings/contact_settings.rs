//! Settings of contact, read by the processes and used by the interaction.

use std::collections::BTreeMap;
use std::sync::Arc;

use zelus_core::parameters::Interval;

use crate::adaptation::{AdaptationSettings, ExplicitPenalty, UzawaSettings};
use crate::friction::FrictionSettings;
use crate::interface::{GivenParameters, NodalNormals};
use crate::law::{Augmentation, CohesiveLaw, Nitsche, NormalVariation, OverclosureLaw, Rubbing, SurfaceLaw};
use crate::mortar::{OperatorThreshold, SegmentationSettings};
use crate::pairs::Formulation;
use crate::search::{SearchSettings, SetAtStart};
use crate::solver::ContactSolverSettings;

/// Laws of a deck that give the tractions of slave nodes by their gap and slip: bonds, friction by direction and elastic slip.
#[derive(Clone)]
pub struct SurfaceSettings {
    /// The law of bonds.
    pub cohesive: Option<Arc<dyn CohesiveLaw>>,
    /// Keys of interfaces with bonds; none means all.
    pub pairs: Vec<String>,
    /// Friction.
    pub rubbing: Rubbing,
}

impl SurfaceSettings {
    /// Whether an interface has bonds, by its key.
    pub fn bonds(&self, key: &str) -> bool {
        self.cohesive.is_some() && (self.pairs.is_empty() || self.pairs.iter().any(|own| own == key))
    }

    /// Laws that bonds share.
    pub fn law(&self) -> SurfaceLaw<'_> {
        SurfaceLaw { cohesive: self.cohesive.as_deref(), rubbing: self.rubbing }
    }
}

/// Settings of contact.
#[derive(Clone)]
pub struct ContactSettings {
    /// Parts of the interfaces by key.
    pub parts: BTreeMap<String, Vec<String>>,
    /// Parts on the slave side by key.
    pub slaves: BTreeMap<String, Vec<String>>,
    /// Keys of interfaces whose contact does not open again.
    pub no_separation: Vec<String>,
    /// The formulation of conditions.
    pub formulation: &'static Formulation,
    /// Times in which contact acts.
    pub interval: Interval,
    /// When normals follow the iteration.
    pub normal_variation: NormalVariation,
    /// How facets count in the normals of nodes.
    pub nodal_normals: NodalNormals,
    /// Where gaps augment the forces of augmented Lagrangians.
    pub augmentation: Augmentation,
    /// Nitsche's method, of formulations whose tractions are those of bodies.
    pub nitsche: Nitsche,
    /// Settings of the search for pairs.
    pub search: SearchSettings,
    /// Gap, in mesh sizes, below which a node starts active.
    pub active_check_factor: f64,
    /// Whether activation goes by 0.002 of the mesh size instead.
    pub simple_search: bool,
    /// Which slave nodes of bodies in contact begin a step so.
    pub set_at_start: SetAtStart,
    /// Whether the factors of the search grow with the ratio of the largest and the smallest mesh size.
    pub adapt_search: bool,
    /// Steps between searches.
    pub database_step_update: usize,
    /// Penalty and scale factor that take the place of the estimate.
    pub given: GivenParameters,
    /// Factor of E/h in eq. 4.11, and ratio of scale factor and penalty.
    pub estimate: [f64; 2],
    /// Factor of the estimated penalty; the penalty formulations need a stiffer spring.
    pub penalty_factor: f64,
    /// Whether penalties act pair by pair on weighted gaps.
    pub weighted_penalty: bool,
    /// Least penalty: it takes the place of an estimate of zero.
    pub least_penalty: f64,
    /// Whether the scale factor is used; otherwise it is 1.
    pub use_scale_factor: bool,
    /// Whether multipliers are hidden from the deck, so that their scale is that of the bodies.
    pub own_scale: bool,
    /// Ratio of tangential and normal penalty.
    pub tangent_factor: f64,
    /// Change of the operators beyond which slip is measured objectively; its area counts in the model's unit of length.
    pub operator_threshold: OperatorThreshold,
    /// Coefficients and the rules of stick and slip.
    pub friction: FrictionSettings,
    /// The law of soft contact, in place of the penalty.
    pub overclosure: Option<Arc<dyn OverclosureLaw>>,
    /// Laws of bonds and of friction by direction, in place of penalties.
    pub surface: Option<SurfaceSettings>,
    /// Parameters that are adapted in every iteration.
    pub adaptation: AdaptationSettings,
    /// Whether normals lie in planes of symmetry, and multipliers that supports leave without equation are dropped.
    pub mind_supports: bool,
    /// Share of a node's facets, of that of its neighbours, that must be faced for it to be in contact.
    pub least_coverage: f64,
    /// Whether augmented pressures of inactive nodes are zero after a step.
    pub clear_inactive: bool,
    /// How far Uzawa's outer loop goes, where the formulation has one.
    pub uzawa: UzawaSettings,
    /// How explicit steps adapt the penalty; `None` in implicit ones.
    pub explicit: Option<ExplicitPenalty>,
    /// How overlaps are cut and integrated.
    pub segmentation: SegmentationSettings,
    /// Whether the plane is rotated about the y axis.
    pub axisymmetric: bool,
    /// Settings of contact at the solver.
    pub solver: ContactSolverSettings,
}

impl ContactSettings {
    /// Name of the conditions up to the shape.
    pub(crate) fn condition_stem(&self) -> String {
        let stem = self.formulation.condition;
        if self.axisymmetric { stem.replace("MortarContact", "AxisymMortarContact") } else { stem.to_owned() }
    }
}
