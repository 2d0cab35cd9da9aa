//! Settings and numbers that all of contact shares during a run: those of the deck, of the bodies, and the smallest that decide.

use std::sync::Arc;

use zelus_core::Result;
use zelus_core::diagnostics::Diagnostic;
use zelus_core::model::ModelPart;

use super::calibration::{calibrate, limit};
use super::contact_settings::ContactSettings;
use crate::interface::Interface;
use crate::law::{Augmentation, NormalVariation, SlipRule, StepParameters};
use crate::mortar::SegmentationSettings;
use crate::pairs::Multiplier;
use crate::slave_nodes::SlaveStates;
use crate::tolerances::Tolerances;
use crate::variables::NODAL_H;

/// Settings and numbers of contact in a model part.
pub(crate) struct Setup {
    /// Settings of the deck.
    pub settings: ContactSettings,
    /// Numbers that every pair shares.
    pub parameters: Arc<StepParameters>,
    /// Gap below which nodes and facets count as near, before factors (length).
    pub threshold: f64,
    /// Distance that a search reaches (length).
    reach: f64,
    /// Smallest lengths and tractions that decide in the present state.
    pub tolerances: Tolerances,
}

impl Setup {
    /// Before the bodies are known.
    pub(crate) fn new(settings: ContactSettings) -> Self {
        let parameters = StepParameters {
            segmentation: SegmentationSettings::default(),
            scale_factor: 1.0,
            stiffness: 1.0,
            tangent_factor: settings.tangent_factor,
            weighted_penalty: settings.weighted_penalty,
            levels_back: if settings.explicit.is_some() { 2 } else { 1 },
            operator_threshold: settings.operator_threshold,
            friction_law: settings.friction.law,
            ellipse: settings.friction.ellipse,
            slip_rule: SlipRule::Pure,
            normal_variation: settings.normal_variation,
            augmentation: settings.augmentation,
            regularised: settings.formulation.regularised,
            dynamic: false,
            nitsche: settings.nitsche,
        };
        let (threshold, reach, tolerances) = (f64::INFINITY, f64::INFINITY, Tolerances::default());
        Self { settings, parameters: Arc::new(parameters), threshold, reach, tolerances }
    }

    /// Finds penalty, scale factor and search radius from the bodies behind the interfaces.
    ///
    /// # Errors
    /// A coefficient of friction below zero.
    pub(crate) fn calibrate(
        &mut self,
        part: &mut ModelPart,
        interfaces: &[Interface],
        messages: &mut Vec<Diagnostic>,
    ) -> Result<()> {
        self.adapt_search(part);
        self.settings.given = self.settings.given.or_written(&part.info);
        let (sizes, parameters) = calibrate(part, interfaces, &self.settings, &self.parameters, messages)?;
        ([self.threshold, self.reach], self.parameters) = (sizes, Arc::new(parameters));
        Ok(())
    }

    /// Meshes of very different sizes need a larger search radius: both factors grow with the ratio of the sizes.
    fn adapt_search(&mut self, part: &ModelPart) {
        if !self.settings.adapt_search {
            return;
        }
        let own = part.nodes.values.values(&NODAL_H, 0).iter().copied().filter(|h| *h > 0.0 && *h < f64::MAX);
        let own = own.fold([f64::INFINITY, 0.0_f64], |[least, most], h| [least.min(h), most.max(h)]);
        let sizes = part.ranks.gather_numbers(&own).concat().into_iter().filter(|h| h.is_finite() && *h > 0.0);
        let (least, most) = sizes.fold((f64::INFINITY, 0.0_f64), |(least, most), h| (least.min(h), most.max(h)));
        if most > 0.0 {
            self.settings.search.factor *= most / least;
            self.settings.active_check_factor *= most / least;
        }
    }

    /// Whether normals follow every iteration; otherwise they are those after the first.
    pub(crate) fn updates_normals(&self) -> bool {
        self.settings.normal_variation != NormalVariation::None
    }

    /// Whether integration points decide on contact.
    pub(crate) fn by_points(&self) -> bool {
        matches!(self.settings.formulation.multiplier, Multiplier::Body)
    }

    /// Whether a stiff penalty that nothing else changes may begin soft.
    pub(crate) fn ramps_penalty(&self) -> bool {
        let constant = self.settings.adaptation.rule.is_none() && self.settings.explicit.is_none();
        constant && matches!(self.settings.formulation.multiplier, Multiplier::None)
    }

    /// Whether friction may join contact later: where forces are multipliers alone.
    pub(crate) fn ramps_friction(&self) -> bool {
        let bounded = matches!(self.parameters.slip_rule, SlipRule::Bounded(_));
        bounded
            && self.settings.explicit.is_none()
            && self.settings.surface.is_none()
            && self.settings.augmentation == Augmentation::Node
            && matches!(self.settings.formulation.multiplier, Multiplier::Vector(_))
    }

    /// Whether friction depends on the temperature of contact.
    pub(crate) fn has_warm_friction(&self) -> bool {
        self.settings.formulation.frictional() && self.settings.friction.law.depends_on_temperature()
    }

    /// Finds the tractions of bonds in the present state.
    pub(crate) fn find_bonds(&self, states: &mut SlaveStates) {
        if let Some(surface) = &self.settings.surface {
            states.find_bonds(surface.law(), self.parameters.tangent_factor);
        }
    }

    /// Distance within which nodes start in contact, and depth beyond which facets are in each other (length).
    pub(crate) fn near(&self) -> f64 {
        self.settings.active_check_factor * self.threshold
    }

    /// Distance beyond which a search takes no facets for a pair (length).
    pub(crate) fn limit(&self) -> f64 {
        limit(&self.settings, self.reach)
    }
}
