//! The balance of an accepted step: loads, reactions, remainder and energies.

use serde::{Deserialize, Serialize};

use super::omitted_fields::omitted_from_json;

/// Balance of forces, states of contact and energies at the end of an accepted step.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Balance {
    /// Sums by unknown that has reactions, e.g. forces and moments of displacements.
    pub unknowns: Vec<UnknownBalance>,
    /// The pairs of bodies of all interactions.
    pub pairs: Vec<PairBalance>,
    /// Energies since the stage began.
    pub energies: Energies,
    /// Reactions by support, in the order of the deck.
    #[serde(default)]
    pub supports: Vec<SupportReaction>,
}

/// Sums of forces on one unknown, over all nodes: loads + elements + interactions + inertia + reactions = 0 but for the out-of-balance
/// remainder.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
#[serde(remote = "Self")]
pub struct UnknownBalance {
    /// The unknown, e.g. DISPLACEMENT.
    pub unknown: String,
    /// Sums of the components.
    pub forces: BalanceTerms,
    /// Sums of moments about `centre`, in the present configuration; `None` for unknowns that move nothing.
    pub moments: Option<BalanceTerms>,
    /// Centre of the box around the initial mesh.
    pub centre: [f64; 3],
    /// Flows through the body, of unknowns that move nothing, e.g. heat (power).
    #[serde(default)]
    pub flows: Option<Flows>,
}

omitted_from_json!(UnknownBalance, "flows");

/// Flows into, out of and within the body: entering − leaving + elements + interactions = stored but for the out-of-balance remainder.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Flows {
    /// Input by loads and supports, summed node by node (power).
    pub entering: f64,
    /// Output by loads and supports (power).
    pub leaving: f64,
    /// Rate of storage in the body, negative where it releases.
    pub stored: f64,
}

/// Terms of the balance; their sum is zero.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct BalanceTerms {
    /// External forces of conditions and elements.
    pub loads: [f64; 3],
    /// Reactions of supports and of constraints to fixed unknowns.
    pub reactions: [f64; 3],
    /// Internal forces: zero unless elements are connected to the ground or rotate about an axis; of heat, the convected inflow.
    pub elements: [f64; 3],
    /// Interactions on both sides: nothing where they act between bodies.
    pub interactions: [f64; 3],
    /// Minus the forces of inertia, damping and storage.
    pub inertia: [f64; 3],
    /// Remainder on unsupported unknowns, and between the sides of pairs.
    pub out_of_balance: [f64; 3],
    /// Its size relative to that of the largest of the others, including the force of a pair and the one-sided sums of loads and
    /// supports.
    pub relative: f64,
}

/// One pair of bodies.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct PairBalance {
    /// Key in the deck, and parts.
    pub name: String,
    /// Force on the first (slave) side.
    pub force: [f64; 3],
    /// Its moment about the centre.
    pub moment: [f64; 3],
    /// Sum of the forces on both sides.
    pub out_of_balance: [f64; 3],
    /// Slave nodes without contact.
    pub open: usize,
    /// Slave nodes that stick.
    pub sticking: usize,
    /// Slave nodes that slide.
    pub slipping: usize,
    /// Depth of the node that is deepest in the other side (length).
    pub penetration: f64,
    /// Id of that node.
    pub penetration_node: Option<usize>,
    /// Energy that friction has turned into heat since the stage began.
    pub dissipated: f64,
}

/// Reaction of the unknowns that processes fix on one part.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct SupportReaction {
    /// Full dotted path of the part.
    pub part: String,
    /// The unknown, e.g. DISPLACEMENT.
    pub unknown: String,
    /// Sum over its fixed components; a component that several supports fix at a node counts for the last one, whose value holds.
    pub reaction: [f64; 3],
    /// Its moment about the centre of the balance, in the present configuration; zero for unknowns that move nothing.
    pub moment: [f64; 3],
}

/// Energies since the stage began, of unknowns that have inertia; works by the trapezoidal rule over steps. Those of explicit steps
/// are of the start of the step, as velocities are.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[serde(remote = "Self")]
pub struct Energies {
    /// Work against internal forces: strain energy, and dissipation of materials.
    pub stored: f64,
    /// Work of loads.
    pub loads: f64,
    /// Work of supports that move.
    pub supports: f64,
    /// Work of interactions and linear constraints on all their nodes.
    pub interactions: f64,
    /// Heat of friction.
    pub dissipated: f64,
    /// Kinetic energy at the end of the step.
    pub kinetic: f64,
    /// Energy in the springs of penalty contact, ½ (ε g² + t²/(κ ε)) A over the slave nodes in contact.
    #[serde(default)]
    pub penalty: f64,
    /// Work against damping, of explicit steps.
    #[serde(default)]
    pub damping: Option<f64>,
    /// Part of the kinetic energy that central differences give short waves beyond their own, ½ (Δt/2)² a·M a.
    #[serde(default)]
    pub unresolved: Option<f64>,
    /// Energy made (positive) or lost by explicit steps: kinetic − unresolved + stored + penalty + dissipated + damping − loads −
    /// supports, less its value at the start of the stage.
    #[serde(default)]
    pub remainder: Option<f64>,
}

omitted_from_json!(Energies, "damping", "unresolved", "remainder");
