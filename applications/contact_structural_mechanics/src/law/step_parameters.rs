//! Numbers that every pair of a run shares.

use super::augmentation::Augmentation;
use super::friction_ellipse::FrictionEllipse;
use super::friction_law::FrictionLaw;
use super::nitsche::Nitsche;
use super::rules::SlipRule;
use crate::mortar::{OperatorThreshold, SegmentationSettings};

/// When normals follow the iteration, and whether the tangent knows it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Deserialize)]
pub enum NormalVariation {
    /// Normals of the step, renewed once after its first iteration (`no_derivatives_computation`).
    #[serde(rename = "no_derivatives_computation")]
    None,
    /// Normals of each iteration, constant in the tangent.
    #[serde(
        rename = "no_derivatives_computation_with_normal_update",
        alias = "no_derivatives_computation_with_normal_update"
    )]
    Update,
    /// As [`NormalVariation::Update`], with the variation of the facet's normal in the tangent.
    #[serde(rename = "elemental_derivatives")]
    Elemental,
    /// As [`NormalVariation::Elemental`], with the variation of the nodal normals by the facet of the pair too.
    #[serde(rename = "nodal_elemental_derivatives")]
    NodalElemental,
    /// Normals of each iteration with their whole variation, by all facets around a node.
    #[serde(rename = "exact_derivatives")]
    Exact,
}

impl NormalVariation {
    /// Whether the tangent knows how the normals of facets rotate.
    pub fn knows_facets(self) -> bool {
        matches!(self, Self::Elemental | Self::NodalElemental | Self::Exact)
    }

    /// Whether the tangent knows how the normals of nodes rotate.
    pub fn knows_nodes(self) -> bool {
        matches!(self, Self::NodalElemental | Self::Exact)
    }
}

/// Settings and numbers that the conditions read.
#[derive(Debug, Clone, PartialEq)]
pub struct StepParameters {
    /// How overlaps are cut and integrated.
    pub segmentation: SegmentationSettings,
    /// k: multipliers times k are tractions.
    pub scale_factor: f64,
    /// E/h: the least that gaps and slips count with where they stand against tractions (stress by length).
    pub stiffness: f64,
    /// Ratio κ of tangential and normal penalty.
    pub tangent_factor: f64,
    /// Change of the operators beyond which slip is measured objectively.
    pub operator_threshold: OperatorThreshold,
    /// Law that limits tangential tractions.
    pub friction_law: &'static FrictionLaw,
    /// Limit of friction by direction, of multipliers; bonds and penalties have it in their own law.
    pub ellipse: FrictionEllipse,
    /// How stick and slip are told apart.
    pub slip_rule: SlipRule,
    /// Whether penalties act pair by pair on weighted gaps, as in Kratos.
    pub weighted_penalty: bool,
    /// Time levels back to the state from which slip counts: explicit steps decide on contact at their start.
    pub levels_back: usize,
    /// When normals follow the iteration.
    pub normal_variation: NormalVariation,
    /// Where gaps augment the forces of augmented Lagrangians.
    pub augmentation: Augmentation,
    /// Whether contact is regularised: gap and slip have an elastic part, traction over penalty.
    pub regularised: bool,
    /// Whether the step has inertia, so that friction must make no energy.
    pub dynamic: bool,
    /// Nitsche's method, of formulations whose tractions are those of bodies.
    pub nitsche: Nitsche,
}

impl StepParameters {
    /// c: the factor of gaps and slips of a node of this penalty and area against tractions (stress by length).
    ///
    /// Where forces are augmented, weighted gaps enter them with the penalty, which is the larger part where areas are large
    /// numbers. Where they are not, that of the bodies counts alone: whatever a deck says of penalties, contact is the same.
    pub fn nodal_stiffness(&self, penalty: f64, area: f64) -> f64 {
        match self.augmentation {
            Augmentation::Node => self.stiffness,
            Augmentation::Pair => self.stiffness.max(penalty * area),
        }
    }
}
