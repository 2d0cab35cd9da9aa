//! The settings in which Kratos' contact is not the best method known.

/// A setting with another default under `--like kratos`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Deviation {
    /// Registered objects whose setting it is, as files of `configs/like_kratos`.
    pub of: &'static [&'static str],
    /// The key, with dots.
    pub key: &'static str,
    /// Behaviour of Kratos.
    pub kratos: &'static str,
    /// The default here, and its reason.
    pub here: &'static str,
    /// Where Kratos does it.
    pub source: &'static str,
}

const ALM: &str = "alm_contact_process";
const PENALTY: &str = "penalty_contact_process";
const EXPLICIT: &str = "explicit_penalty_contact_process";
const LAGRANGIAN: &str = "perturbed_lagrangian_contact_process";
const UZAWA: &str = "uzawa_contact_process";
const MPC: &str = "mpc_contact_process";
const MPC_SOLVER: &str = "mpc_contact_settings";
const TYING: &str = "mesh_tying_process";
const SOLVER: &str = "contact_settings";
const PROCESSES: &[&str] = &[ALM, PENALTY, EXPLICIT, LAGRANGIAN, UZAWA];

/// All of them.
pub const DEVIATIONS: &[Deviation] = &[
    Deviation {
        of: PROCESSES,
        key: "normal_variation",
        kratos: "normals are those after the first iteration of a step, whose tangent leaves a part out",
        here: "normals of each iteration with their whole derivative: results do not depend on iterates",
        source: "alm_contact_process.py, mortar_contact_condition.cpp",
    },
    Deviation {
        of: &[ALM],
        key: "augmentation",
        kratos: "gaps of single pairs augment forces: results depend a little on the penalty",
        here: "the gap of the whole node decides, forces are multipliers alone",
        source: "ALM_frictionless_mortar_contact_condition.cpp",
    },
    Deviation {
        of: PROCESSES,
        key: "nodal_normals",
        kratos: "facets of a node count alike in its normal",
        here: "facets count by their edges, which is exact on spheres",
        source: "normal_calculation_utils.cpp",
    },
    Deviation {
        of: PROCESSES,
        key: "mind_supports",
        kratos: "normals and multipliers do not know of supports",
        here: "normals lie in planes of symmetry, multipliers there are constrained",
        source: "no counterpart",
    },
    Deviation {
        of: &[TYING],
        key: "mind_supports",
        kratos: "multipliers do not know of supports",
        here: "constrained multipliers follow their neighbours",
        source: "no counterpart",
    },
    Deviation {
        of: &[ALM, PENALTY, EXPLICIT, LAGRANGIAN, UZAWA, MPC, TYING],
        key: "count_slivers",
        kratos: "overlaps below 1e-5 of a slave facet count for nothing",
        here: "they count where the nodes of the slave have others: no area is lost",
        source: "exact_mortar_segmentation_utility.cpp",
    },
    Deviation {
        of: PROCESSES,
        key: "least_coverage",
        kratos: "every node that has an overlap may be in contact",
        here: "nodes at the master's edge, whose gap is extrapolated beyond the master, are not",
        source: "no counterpart",
    },
    Deviation {
        of: PROCESSES,
        key: "search_parameters.search_distance",
        kratos: "facets are found by the distance of their centres",
        here: "by that of the facets: large masters are found from fine slaves",
        source: "base_contact_search_process.cpp",
    },
    Deviation {
        of: PROCESSES,
        key: "search_parameters.search_within_step",
        kratos: "pairs are those of the start of the step, and those whose facets nodes have penetrated",
        here: "pairs are added wherever facets come to face each other",
        source: "base_contact_search_process.cpp; penetrated facets have no counterpart",
    },
    Deviation {
        of: &[ALM, PENALTY, LAGRANGIAN, UZAWA],
        key: "search_parameters.set_at_start",
        kratos: "all nodes that are near a master begin every step in contact, and leave it ring by ring",
        here: "between bodies in contact the set of the last step is kept: a step takes half as many iterations",
        source: "base_contact_search_process.cpp",
    },
    Deviation {
        of: &[ALM, PENALTY],
        key: "slip_step_reset_frequency",
        kratos: "all nodes begin every step in stick",
        here: "nodes begin in the state in which the last step ended",
        source: "alm_contact_process.py",
    },
    Deviation {
        of: &[ALM],
        key: "slip_threshold",
        kratos: "a node near its bound slides on although its slip has turned against its traction",
        here: "it sticks",
        source: "active_set_utilities.cpp",
    },
    Deviation {
        of: &[ALM],
        key: "sliding_direction",
        kratos: "in the plane the direction of sliding is that of each iterate's multiplier",
        here: "the direction is kept while the node slides",
        source: "mortar_utilities.cpp",
    },
    Deviation {
        of: &[ALM],
        key: "operator_threshold",
        kratos: "slip is measured objectively beyond this change of the operators",
        here: "beyond ten times as much, as a share of them",
        source: "ALM_frictional_mortar_contact_condition.cpp",
    },
    Deviation {
        of: &[ALM],
        key: "absolute_operator_threshold",
        kratos: "that change is an area in no unit",
        here: "a share of the operators",
        source: "ALM_frictional_mortar_contact_condition.cpp",
    },
    Deviation {
        of: &[PENALTY, EXPLICIT],
        key: "tangent_factor",
        kratos: "the tangential spring yields by much before friction slides",
        here: "a spring nearly as stiff as the normal one",
        source: "penalty_contact_process.py, explicit_penalty_contact_process.py",
    },
    Deviation {
        of: &[PENALTY, EXPLICIT],
        key: "advance_ALM_parameters.penalty_of_weighted_gaps",
        kratos: "penalties act pair by pair on weighted gaps, and hold an area that no deck names",
        here: "they act on the gap of a node: results do not depend on size, unit and mesh",
        source: "penalty_frictionless_mortar_contact_condition.cpp",
    },
    Deviation {
        of: &[MPC],
        key: "update_condition_relation_step",
        kratos: "nodes stay with the facets they met first",
        here: "relations are those of each step",
        source: "mpc_contact_process.py",
    },
    Deviation {
        of: &[MPC],
        key: "consistent_weights",
        kratos: "rows that extrapolate are left out, the others divided by the facets of the node: load is lost",
        here: "all rows count with their area: weights add up to one",
        source: "mpc_mortar_contact_condition.cpp",
    },
    Deviation {
        of: &[MPC],
        key: "keep_first_opening",
        kratos: "openings stay in the first step of a run",
        here: "they close at once",
        source: "contact_master_slave_constraint.cpp",
    },
    Deviation {
        of: &[MPC],
        key: "swap_held_slaves",
        kratos: "a slave side that supports hold is not constrained",
        here: "sides are exchanged",
        source: "no counterpart",
    },
    Deviation {
        of: &[MPC_SOLVER],
        key: "update_each_nl_iteration",
        kratos: "relations are those of the start of the step",
        here: "relations follow the iterates",
        source: "residualbased_newton_raphson_mpc_contact_strategy.h",
    },
    Deviation {
        of: &[SOLVER, MPC_SOLVER],
        key: "edge_normals",
        kratos: "slave nodes on sharp edges have the mean normal of their faces",
        here: "they have the normal of the opposite surface",
        source: "normal_calculation_utils.cpp",
    },
    Deviation {
        of: &[SOLVER, MPC_SOLVER],
        key: "contact_stabilisation",
        kratos: "nodes of contact keep their mass: impacts make energy",
        here: "the nodes below carry it",
        source: "no counterpart",
    },
    Deviation {
        of: &[SOLVER, MPC_SOLVER],
        key: "impact_energy_tolerance",
        kratos: "steps are as long as the deck says",
        here: "steps in which contact closes or opens are cut until they keep energy",
        source: "no counterpart",
    },
    Deviation {
        of: &[SOLVER, MPC_SOLVER],
        key: "largest_energy_gain",
        kratos: "contact may make any energy",
        here: "a step that brings it to a tenth of the energy of motion is refused",
        source: "no counterpart",
    },
    Deviation {
        of: &[SOLVER],
        key: "largest_penetration",
        kratos: "nodes in contact may be in the master by any depth",
        here: "a state in which one is by a fifth of its mesh size is refused",
        source: "no counterpart",
    },
];
