//! The variables of contact.

use zelus_core::model::VariableEntry;
use zelus_core::{register_absent, register_material_range, register_usual_results, register_variable};

register_usual_results! {
    values: ["CONTACT_PRESSURE", "CONTACT_TRACTION", "CONTACT_GAP", "CONTACT_SLIP", "CONTACT_STATUS", "CONTACT_FORCE", "COHESIVE_DAMAGE"],
    gauss: []
}

register_material_range! { "[0, inf)": ["KINETIC_FRICTION_COEFFICIENT", "FRICTION_DECAY"] }
register_material_range! { "(0, inf)": ["FRICTION_SOFTENING_EXPONENT"] }

register_variable! {
    pub LAGRANGE_MULTIPLIER_CONTACT_PRESSURE: f64 = "Normal contact pressure divided by SCALE_FACTOR, negative in compression.";
    pub VECTOR_LAGRANGE_MULTIPLIER: [f64; 3] = "Contact traction on the slave divided by SCALE_FACTOR, along the outward normal of the slave in tension.";
    pub SCALAR_LAGRANGE_MULTIPLIER: f64 = "Multiplier of a tied scalar.";
    pub KEPT_CONTACT_PRESSURE: f64 = "Uzawa pressure: normal contact pressure between two updates of Uzawa's iteration, negative in compression (force per area).";
    pub WEIGHTED_GAP: f64 = "Gap integrated with the dual shape function of a slave node, negative in penetration (length times area).";
    pub WEIGHTED_SLIP: [f64; 3] = "Slip of the step integrated with the dual shape function of a slave node (length times area).";
    pub WEIGHTED_SCALAR_RESIDUAL: f64 = "Residual of a tied scalar, integrated with dual shape functions.";
    pub WEIGHTED_VECTOR_RESIDUAL: [f64; 3] = "Residual of a tied vector, integrated with dual shape functions.";
    pub FRICTION_TRACTION: [f64; 3] = "History traction of the penalty method: tangential traction on a slave node (force per area).";
    pub CARRIED_TRACTION: [f64; 3] = "History traction of Nitsche's method: tangential traction of contact less that of the slave's body (force per area).";
    pub NORMAL_GAP: f64 = "Gap along the normal of a slave node, negative in penetration (length).";
    pub INITIAL_CLEARANCE: f64 = "Clearance that the deck gives a slave node before the run, negative for interference (length).";
    pub NODAL_AREA: f64 = "Area (length in the plane) of contact that belongs to a slave node.";
    pub NODAL_H: f64 = "Distance to the nearest node that shares an element (length).";
    pub INITIAL_PENALTY: f64 = "Penalty parameter of contact (force per length cubed).";
    pub MULTIPLIER_WEIGHT: f64 = "Weight of the multiplier in the equation of a slave node that states a traction (force times area).";
    pub DYNAMIC_FACTOR: f64 = "Factor of contact forces in the step in which a gap closes.";
    pub FRICTION_COEFFICIENT: f64 = "Coulomb's coefficient of friction.";
    pub KINETIC_FRICTION_COEFFICIENT: f64 = "Coefficient of friction at high sliding speeds.";
    pub FRICTION_DECAY: f64 = "Decay of friction with the sliding speed (time per length).";
    pub FRICTION_SOFTENING_EXPONENT: f64 = "Exponent by which friction falls with the temperature.";
    pub FRICTION_REFERENCE_TEMPERATURE: f64 = "Temperature above which friction falls.";
    pub FRICTION_MELTING_TEMPERATURE: f64 = "Temperature from which there is no friction.";
    pub TRESCA_FRICTION_THRESHOLD: f64 = "Tresca's limit of the tangential traction (force per area).";
    pub TANGENT_XI: [f64; 3] = "Unit tangent of the slave surface in the direction of sliding; of friction by direction in the plane in which its limit is a circle.";
    pub TANGENT_ETA: [f64; 3] = "Unit tangent of the slave surface across the direction of sliding: TANGENT_XI, TANGENT_ETA and the normal are right-handed.";
    pub AUGMENTED_NORMAL_CONTACT_PRESSURE: f64 = "Normal traction of a slave node, negative in contact: scale factor times normal multiplier, plus penalty times weighted gap where pairs augment; of penalty methods their traction.";
    pub AUGMENTED_TANGENT_CONTACT_PRESSURE: [f64; 3] = "Augmented tangential traction that friction limits.";
    pub CONTACT_PRESSURE: f64 = "Force per area by which contact presses on a node, positive in compression; 0 where it is open. At master nodes their share of the pressure of the slave, over the area.";
    pub CONTACT_TRACTION: [f64; 3] = "Force per area of contact on a node, along the normal and tangential.";
    pub CONTACT_GAP: f64 = "Gap at a slave node, negative in penetration; 0 where nothing faces it (length).";
    pub CONTACT_SLIP: [f64; 3] = "How far a slave node in contact with friction has slid in the step (length).";
    pub CONTACT_STATUS: f64 = "0 open, 1 in contact without sliding, 2 in contact and sliding, as every node in contact without friction; -1 at nodes that are no slaves.";
    pub COHESIVE_DAMAGE: f64 = "Damage of the bond of a slave node: 0 sound, 1 failed or never bonded; 0 at nodes that are no slaves.";
    pub SLAVE_STATUS: f64 = "Of a slave node: 0 open, 1 in contact without friction, 2 sticking, 3 sliding against friction.";
    pub CONTACT_FORCE: [f64; 3] = "Force of contact on a node, of both sides.";
    kind SCALE_FACTOR: Scalar = "Factor that turns multipliers into tractions (eq. 4.11).";
}

// Variables of Kratos' process info and entities: settings here, or states that nothing has to pass on.
register_absent! { VariableEntry ["ADAPT_PENALTY"] => "set `adapt_penalty` of `advance_ALM_parameters`: true adapts the penalty node by node" }
register_absent! { VariableEntry ["MAX_GAP_FACTOR"] =>
"set `max_gap_factor` of `advance_ALM_parameters`: allowed gap of the adaptation, in mesh sizes (NODAL_H)" }
register_absent! { VariableEntry ["MAX_GAP_THRESHOLD"] =>
"set `max_gap_threshold` of `advance_explicit_parameters`, with `manual_max_gap_theshold`: gap at which the explicit penalty has grown" }
register_absent! { VariableEntry ["REACTION_CHECK_STIFFNESS_FACTOR"] =>
"set `reaction_check_stiffness_factor` of `mpc_contact_process`: pressure, in Young's moduli, below which a node is released" }
register_absent! { VariableEntry ["NODAL_PAUX"] =>
"use CONTACT_PRESSURE for the pressure of `mpc_contact_process`; weights of constraints need no nodal variable" }
register_absent! { VariableEntry ["CONSTRAINT_POINTER"] =>
"`mpc_contact_process` owns its constraints, which it makes anew in each iteration; entities hold no pointers" }
register_absent! { VariableEntry ["CONSIDER_NORMAL_VARIATION"] => "set `normal_variation` of the contact process" }
register_absent! { VariableEntry ["TANGENT_FACTOR"] => "set `tangent_factor` of the contact process: ratio of tangential and normal penalty" }
register_absent! { VariableEntry ["OPERATOR_THRESHOLD"] => "set `operator_threshold` of the contact process" }
register_absent! { VariableEntry ["ZERO_TOLERANCE_FACTOR"] => "set `zero_tolerance_factor` of the contact process" }
register_absent! { VariableEntry ["ACTIVE_CHECK_FACTOR"] => "set `active_check_factor` of `search_parameters`" }
register_absent! { VariableEntry ["DISTANCE_THRESHOLD"] =>
"set `active_check_factor` of `search_parameters`: gap, in mesh sizes, below which a node starts active" }
