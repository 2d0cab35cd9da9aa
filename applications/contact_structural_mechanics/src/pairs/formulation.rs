//! Contact and tying formulations, by their `mortar_type`.

use zelus_core::Result;
use zelus_core::analysis::NodalVariable;
use zelus_core::diagnostics::{Diagnostic, did_you_mean};
use zelus_core::model::Variable;
use zelus_core::registered_kind;
use zelus_core::registry;

use super::contact_block::ContactBlock;
use super::pair_block::PairBlock;
use super::pair_request::PairRequest;
use crate::law::{ContactLaw, Decision, Multiplier, NodeLaw, SlaveNumbers, SlipRule};
use crate::slave_nodes::SlaveColumns;
use crate::variables::{CARRIED_TRACTION, FRICTION_TRACTION};

/// Friction of a formulation.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Friction {
    /// Nothing.
    None,
    /// Coulomb's law.
    Coulomb,
    /// Coulomb's law where contact always slides.
    PureSlip,
}

/// A penalty method by node: the traction of a node is the penalty times its gap and slip over all its pairs.
#[derive(Clone, Copy)]
pub struct ByNode {
    /// For steps that iterate: the traction is a multiplier, which couples the pairs of a node.
    pub implicit: &'static Formulation,
    /// For explicit steps, which have the tractions before they look at pairs.
    pub explicit: &'static Formulation,
}

registered_kind! {
    /// A contact formulation, by its `mortar_type`.
    pub struct FormulationEntry("contact_formulation", "mortar-type") {
        build: Formulation;
    }
}

registered_kind! {
    /// A tying formulation, by its `mortar_type`.
    pub struct TyingFormulationEntry("tying_formulation", "mortar-type") {
        build: TyingFormulation;
    }
}

/// A contact formulation.
pub struct Formulation {
    /// Beginning of the names of its conditions, up to the shape, e.g. `ALMFrictionlessMortarContactCondition`.
    pub condition: &'static str,
    /// Its multipliers.
    pub multiplier: Multiplier,
    /// Further nodal variables with history.
    pub variables: &'static [NodalVariable],
    /// Its friction.
    pub friction: Friction,
    /// The rule by which its slave nodes enter and leave contact, stick and slide.
    pub decide: fn(&SlaveNumbers, SlipRule) -> Decision,
    /// Whether its penalty counts weighted gaps, and is a stress by length and area; otherwise gaps.
    pub weighted_gaps: bool,
    /// Whether contact is regularised: gap and slip have an elastic part, traction over penalty, the traction being a multiplier.
    pub regularised: bool,
    /// Whether an outer loop takes away by how much, by Uzawa's iteration.
    pub updated: bool,
    /// The formulations that take its place where its penalty is that of whole nodes.
    pub by_node: Option<ByNode>,
    /// Makes a block of pairs.
    pub block: fn(PairRequest) -> Box<dyn ContactBlock>,
}

impl Formulation {
    /// A formulation without friction whose forces are those of a law, and whose conditions begin with a name.
    pub const fn of<L: NodeLaw>(condition: &'static str, variables: &'static [NodalVariable]) -> Self {
        let block = |request: PairRequest| -> Box<dyn ContactBlock> {
            let law: Box<dyn ContactLaw> = Box::new(L::new(&request.parameters));
            Box::new(PairBlock::new(law, request))
        };
        Self::with_blocks(condition, variables, L::MULTIPLIER, L::decide, block)
    }

    /// A formulation without friction with blocks of its own, whose conditions begin with a name.
    pub const fn with_blocks(
        condition: &'static str,
        variables: &'static [NodalVariable],
        multiplier: Multiplier,
        decide: fn(&SlaveNumbers, SlipRule) -> Decision,
        block: fn(PairRequest) -> Box<dyn ContactBlock>,
    ) -> Self {
        Self {
            condition,
            multiplier,
            variables,
            friction: Friction::None,
            decide,
            weighted_gaps: false,
            regularised: false,
            updated: false,
            by_node: None,
            block,
        }
    }

    /// Whether it has friction, sliding or sticking.
    pub fn frictional(&self) -> bool {
        self.friction != Friction::None
    }

    /// The nodal columns of its slave nodes.
    pub fn columns(&self) -> SlaveColumns {
        let carries = |variable: &&Variable<[f64; 3]>| self.variables.iter().any(|(name, _)| *name == variable.name());
        SlaveColumns {
            tractions: true,
            friction: self.frictional(),
            history_traction: [&FRICTION_TRACTION, &CARRIED_TRACTION].into_iter().find(carries),
        }
    }
}

/// A tying formulation.
pub struct TyingFormulation {
    /// Its multipliers.
    pub multiplier: Multiplier,
    /// Further nodal variables with history.
    pub variables: &'static [NodalVariable],
}

fn unknown(mortar_type: &str, formulations: &[&str]) -> Diagnostic {
    let hint = did_you_mean(mortar_type, formulations.iter().copied());
    Diagnostic::error("mortar-type", format!("there is no contact formulation {mortar_type:?}"))
        .remedy(hint.unwrap_or_else(|| format!("formulations: {}", formulations.join(", "))))
}

/// The formulation of a `mortar_type`.
///
/// # Errors
/// A name that no formulation has.
pub fn find_formulation(mortar_type: &str) -> Result<&'static Formulation, Diagnostic> {
    let found = registry::find::<FormulationEntry>(mortar_type).map(|entry| &entry.build);
    found.ok_or_else(|| unknown(mortar_type, &registry::names::<FormulationEntry>()))
}

/// The tying formulation of a `mortar_type`.
///
/// # Errors
/// A name that no such formulation has.
pub fn find_tying_formulation(mortar_type: &str) -> Result<&'static TyingFormulation, Diagnostic> {
    let found = registry::find::<TyingFormulationEntry>(mortar_type).map(|entry| &entry.build);
    found.ok_or_else(|| unknown(mortar_type, &registry::names::<TyingFormulationEntry>()))
}

/// The nodal variables that a `mortar_type` of either sort brings along.
///
/// # Errors
/// A name that no formulation has.
pub fn variables_of(mortar_type: &str) -> Result<&'static [NodalVariable], Diagnostic> {
    if let Ok(formulation) = find_tying_formulation(mortar_type) {
        return Ok(formulation.variables);
    }
    let known = || [registry::names::<FormulationEntry>(), registry::names::<TyingFormulationEntry>()].concat();
    find_formulation(mortar_type).map(|formulation| formulation.variables).map_err(|_| unknown(mortar_type, &known()))
}
