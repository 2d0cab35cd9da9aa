//! How heat and a structure are solved within a step: `coupling_settings`.

use zelus_core::analysis::{ExtensionDefinition, SolverExtensionEntry};
use zelus_core::model::ModelPart;
use zelus_core::register;

use crate::staggered::StaggeredSettings;

/// Name of the extension.
pub const SETTINGS: &str = "coupling_settings";
/// Names of step data: settings of the deck.
const TOLERANCE: &str = "COUPLING_TOLERANCE";
const MOST: &str = "COUPLING_MAX_ITERATION";
const MONOLITHIC: &str = "COUPLING_TOGETHER";
/// Tolerance and number of iterations where a deck gives none.
const USUAL: StaggeredSettings = StaggeredSettings { tolerance: 1e-6, most: 30 };

/// How both are solved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum CouplingStrategy {
    /// Once each, heat first.
    Sequential,
    /// Staggered: alternately until the temperatures converge.
    Staggered(StaggeredSettings),
    /// In one Newton's iteration.
    Monolithic,
}

impl CouplingStrategy {
    /// Way of a part.
    pub(crate) fn of(part: &ModelPart) -> Self {
        let value = |name, usual| part.info.value_or(name, usual);
        let goal = StaggeredSettings {
            tolerance: value(TOLERANCE, USUAL.tolerance),
            most: value(MOST, USUAL.most as f64) as usize,
        };
        match goal.most {
            _ if value(MONOLITHIC, 0.0) != 0.0 => Self::Monolithic,
            0 => Self::Sequential,
            _ => Self::Staggered(goal),
        }
    }
}

register! { SolverExtensionEntry "coupling_settings",
    about: "coupling of heat and structure within a step: staggered, sequential or monolithic",
    defaults: include_str!("../../../configs/solvers/coupling_settings.json"),
    like: &[("kratos", include_str!("../../../configs/like_kratos/coupling_settings.json"))],
    build: ExtensionDefinition {
        values: |settings| {
            let strategy = settings.get_str("strategy")?;
            let most = match strategy {
                "staggered" => settings.get_usize("max_iteration")?.max(1),
                "sequential" | "monolithic" => 0,
                other => {
                    let fact = format!("\"strategy\" is {other:?}");
                    let problem = settings.error("strategy", "invalid-value", fact);
                    return Err(problem.remedy("use \"staggered\", \"monolithic\" or \"sequential\"").into());
                }
            };
            let tolerance = settings.get_f64("tolerance")?;
            if !(tolerance > 0.0 && tolerance < 1.0) {
                let problem = settings.error("tolerance", "invalid-tolerance", format!("\"tolerance\" is {tolerance}"));
                return Err(problem.remedy("write a number between 0 and 1, e.g. 1e-6").into());
            }
            let together = f64::from(u8::from(strategy == "monolithic"));
            Ok(vec![(TOLERANCE, tolerance), (MOST, most as f64), (MONOLITHIC, together)])
        },
        acts_alone: true,
        ..ExtensionDefinition::NOTHING
    },
}
