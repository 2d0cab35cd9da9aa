//! Conditions that bound positions: a wall, x ≥ w, or a linear constraint, a·x + b ≤ 0.
//!
//! The last node of a condition stands for the constraint itself and carries its multiplier. The position w of a wall is
//! the X coordinate of that node. The conditions add nothing to the functional by themselves: a method does.

use zelus_core::diagnostics::{Diagnostic, Result};
use zelus_core::entities::{
    BlockRequest, Build, ConditionEntry, EntityView, Kernel, KernelBlock, LocalUnknown, Request, StepView, Tangent,
};
use zelus_core::geometry::Shape;
use zelus_core::model::{ModelPart, Nodes, PropertyValue};
use zelus_core::register;

use crate::variables::POSITION;

/// Mark of a model part on which a method imposes the constraints.
pub const IMPOSED: &str = "CONSTRAINTS_ARE_IMPOSED";

/// Name of every interaction that imposes constraints.
pub const INTERACTION: &str = "constraints";

const WALL: &str = "WallCondition2N";
const LINEAR: [&str; 2] = ["LinearConstraintCondition2N", "LinearConstraintCondition3N"];

/// One constraint, turned so that it reads g(x) = Σ aᵢ xᵢ + b ≥ 0.
#[derive(Debug, Clone, PartialEq)]
pub struct Constraint {
    /// Id of its condition.
    pub id: usize,
    /// Its node, which carries multipliers.
    pub node: u32,
    /// Nodes whose positions it constrains, with their coefficients.
    pub terms: Vec<(u32, f64)>,
    /// The constant b.
    pub constant: f64,
    /// Sign of its multiplier unknown: 1 for a wall (λ ≤ 0), −1 for a constraint written as a·x + b ≤ 0 (λ ≥ 0).
    pub sign: f64,
}

impl Constraint {
    /// Conditions of the part at `path` that are constraints; the part is marked as one on which a method imposes them.
    ///
    /// # Errors
    /// A path without a part.
    pub fn imposed(root: &mut ModelPart, path: &str) -> Result<Vec<u32>> {
        root.info.marks.insert(IMPOSED, true);
        let is_constraint = |at: &&u32| {
            let name = root.conditions.kinds[**at as usize].name;
            name == WALL || LINEAR.contains(&name)
        };
        Ok(root.part(path)?.conditions.iter().filter(is_constraint).copied().collect())
    }

    /// The constraint of condition number `at` in the table of `part`.
    ///
    /// # Errors
    /// Properties that lack a coefficient or the constant.
    pub fn new(part: &ModelPart, at: usize) -> Result<Self> {
        let nodes = part.conditions.nodes(at as u32);
        let id = part.conditions.ids[at];
        let (&node, positions) = nodes.split_last().expect("registered with two nodes or more");
        if part.conditions.kinds[at].name == WALL {
            let constant = -part.nodes.initial[node as usize][0];
            return Ok(Self { id, node, terms: vec![(positions[0], 1.0)], constant, sign: 1.0 });
        }
        let properties = &part.properties[&part.conditions.properties[at]];
        let coefficients = match properties.values.get("CONSTRAINT_COEFFICIENTS") {
            Some(PropertyValue::Vector(values)) if values.len() == positions.len() => values,
            _ => {
                let fact = format!("condition {id} needs {} coefficients", positions.len());
                let remedy = "write CONSTRAINT_COEFFICIENTS [n](…) into its properties, one for each position";
                return Err(Diagnostic::error("constraint-coefficients", fact)
                    .at(properties.place.clone())
                    .remedy(remedy)
                    .into());
            }
        };
        Ok(Self {
            id,
            node,
            terms: positions.iter().zip(coefficients).map(|(&n, a)| (n, -a)).collect(),
            constant: -properties.require("CONSTRAINT_CONSTANT")?,
            sign: -1.0,
        })
    }

    /// The gap g and the size of its round-off.
    pub fn gap(&self, nodes: &Nodes) -> (f64, f64) {
        let positions = nodes.history.values(&POSITION, 0);
        let (mut gap, mut size) = (self.constant, self.constant.abs());
        for &(node, a) in &self.terms {
            let term = a * positions[node as usize];
            gap += term;
            size += term.abs();
        }
        (gap, 2.0 * f64::EPSILON * size)
    }
}

/// The block of the conditions themselves: contributes nothing, but insists on a method.
struct Stated;

impl<const NODES: usize> Kernel<NODES, 1> for Stated {
    type State = ();

    fn unknowns() -> [LocalUnknown; 1] {
        [LocalUnknown::of_node(0, POSITION.scalar())]
    }

    fn new(request: &BlockRequest<'_>) -> Result<Self> {
        if request.part.info.is(IMPOSED) {
            return Ok(Self);
        }
        let fact = format!("no process says how {} is imposed", request.entry.name);
        Err(Diagnostic::error("no-method", fact)
            .remedy("add one to \"processes\", e.g. \"penalty_method_process\"; `zelus list process` shows them")
            .into())
    }

    fn state(&self, _entity: &EntityView<'_, NODES>, _view: &StepView<'_>) -> Result<(), String> {
        Ok(())
    }

    fn tangent(&self) -> Tangent {
        Tangent::Zero
    }

    fn local_system(
        &self,
        _entity: &EntityView<'_, NODES>,
        _state: &(),
        _view: &StepView<'_>,
        _request: Request,
        _lhs: &mut [f64],
        _rhs: &mut [f64; 1],
    ) -> Result<(), String> {
        Ok(())
    }
}

register! { ConditionEntry WALL,
    about: "wall at the X coordinate of the last node: the position of the first node is not below it",
    source: "x ≥ w; eqs. D.13, D.21",
    cell: Shape::of(1, 2),
    build: Build::Block(KernelBlock::<Stated, 2, 1>::boxed),
}
register! { ConditionEntry LINEAR[0],
    about: "linear constraint of one position: CONSTRAINT_COEFFICIENTS·x + CONSTRAINT_CONSTANT ≤ 0",
    source: "eq. D.17",
    cell: Shape::of(1, 2),
    build: Build::Block(KernelBlock::<Stated, 2, 1>::boxed),
}
register! { ConditionEntry LINEAR[1],
    about: "linear constraint of two positions: CONSTRAINT_COEFFICIENTS·x + CONSTRAINT_CONSTANT ≤ 0",
    source: "eq. D.26",
    cell: Shape::of(1, 3),
    build: Build::Block(KernelBlock::<Stated, 3, 1>::boxed),
}
