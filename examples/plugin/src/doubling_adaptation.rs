//! A penalty that doubles until gaps are small enough.

use zelus::contact_structural_mechanics::adaptation::{PenaltyAdaptation, PenaltyAdaptationEntry};
use zelus_core::register;

register! { PenaltyAdaptationEntry "doubling",
    about: "twice the penalty where a node is too deep in the master",
    source: "ε ← 2ε where −g > g_max",
    build: PenaltyAdaptation {
        adapt: |penalty, gap, _previous, [_least, largest]| if -gap > largest { 2.0 * penalty } else { penalty },
        keeps_share_of_run: true,
    },
}
