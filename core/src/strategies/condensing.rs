//! Whether iterative solvers see multipliers: as a model part's step data ask for it, and why it was not to be.

use zelus_linear_algebra::{CondensationSettings, Multipliers, NotCondensable};

use super::dof_name::DofNames;
use crate::diagnostics::{Diagnostic, Place};
use crate::model::{MultiplierRequest, ProcessInfo};

/// Number of the step data: [`CondensationSettings::off_node`].
pub const OFF_NODE_TOLERANCE: &str = "DUAL_LM_OFF_NODE_TOLERANCE";
/// Number of the step data: [`CondensationSettings::zero_row`].
pub const ZERO_ROW_TOLERANCE: &str = "DUAL_LM_ZERO_ROW_TOLERANCE";

/// Treatment of multipliers by iterative solvers, as the step data of a model part ask for it.
pub(crate) fn multipliers(info: &ProcessInfo) -> Multipliers {
    let usual = CondensationSettings::default();
    let MultiplierRequest { condense, keep, only_condensed } = info.solver.multipliers;
    if condense {
        Multipliers::Condense(CondensationSettings {
            off_node: info.value_or(OFF_NODE_TOLERANCE, usual.off_node),
            zero_row: info.value_or(ZERO_ROW_TOLERANCE, usual.zero_row),
            fallback: !only_condensed,
        })
    } else if keep {
        Multipliers::Keep
    } else {
        Multipliers::Leave
    }
}

/// Why multipliers are not condensed, by the names of their nodes.
pub(super) fn fact(refused: NotCondensable, dof_name: DofNames<'_>) -> String {
    let name = |equation| dof_name(equation).map_or_else(|| format!("equation {equation}"), |it| it.to_string());
    match refused {
        NotCondensable::OffNode { multiplier, equation, share } => format!(
            "{} acts on {} by {share:.1e} of its effect on its own node, so that multipliers cannot be condensed",
            name(multiplier),
            name(equation)
        ),
        NotCondensable::Undetermined { multiplier, share } => format!(
            "the free unknowns of its node have {share:.1e} of the effect of {}, so that multipliers cannot be condensed",
            name(multiplier)
        ),
    }
}

/// The remedy.
pub(super) fn remedy(refused: NotCondensable) -> &'static str {
    match refused {
        NotCondensable::OffNode { .. } => {
            "name a direct engine, or avoid facets that overlap by a sliver, where dual functions do not exist, and nodes \
             that are slave and master"
        }
        NotCondensable::Undetermined { .. } => {
            "name a direct engine, or prescribe no displacement of slave nodes that contact or tie prescribes, too"
        }
    }
}

/// The warning that the direct engine solves for all unknowns; `place` names the iterative engine.
pub(super) fn warning(refused: NotCondensable, dof_name: DofNames<'_>, place: Option<&Place>) -> Diagnostic {
    let fact = fact(refused, dof_name);
    Diagnostic::warning("not-condensed", format!("{fact}: a direct engine solves for all unknowns"))
        .at(place.cloned())
        .remedy(remedy(refused))
}
