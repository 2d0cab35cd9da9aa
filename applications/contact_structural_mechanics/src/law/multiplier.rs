//! The multipliers of slave nodes.

use zelus_core::model::{ScalarVariable, SlaveNodes, Variable};
use zelus_core::vector3::scale;

/// The multipliers of a formulation.
#[derive(Clone, Copy)]
pub enum Multiplier {
    /// None: the penalty method.
    None,
    /// One a slave node, along its normal.
    Scalar(&'static Variable<f64>),
    /// One a slave node and direction.
    Vector(&'static Variable<[f64; 3]>),
    /// None: tractions of the slave's own elements serve, and integration points decide on contact, by Nitsche's method.
    Body,
}

impl Multiplier {
    /// Number a node in `dimension` dimensions.
    pub const fn count(self, dimension: usize) -> usize {
        match self {
            Self::None | Self::Body => 0,
            Self::Scalar(_) => 1,
            Self::Vector(_) => dimension,
        }
    }

    /// Whether it is solved for.
    pub fn is_unknown(self) -> bool {
        matches!(self, Self::Scalar(_) | Self::Vector(_))
    }

    /// Its value at a slave node, by its owner, a scalar one in the first component; zero without.
    pub fn value(self, slave_nodes: &SlaveNodes, owner: u32) -> [f64; 3] {
        self.value_at(slave_nodes, owner, 0)
    }

    /// The same at a time level (0 the present).
    pub fn value_at(self, slave_nodes: &SlaveNodes, owner: u32, level: usize) -> [f64; 3] {
        let (history, at) = (&slave_nodes.history, owner as usize);
        match self {
            Self::None | Self::Body => [0.0; 3],
            Self::Scalar(variable) => [history.values(variable, level)[at], 0.0, 0.0],
            Self::Vector(variable) => history.get(variable.name()).map_or([0.0; 3], |field| field.vector(level, at)),
        }
    }

    /// Its value at a slave node as a vector, a scalar one along the normal.
    pub fn vector(self, slave_nodes: &SlaveNodes, owner: u32, normal: [f64; 3]) -> [f64; 3] {
        let value = self.value(slave_nodes, owner);
        if matches!(self, Self::Scalar(_)) { scale(normal, value[0]) } else { value }
    }

    /// Sets its value at a slave node, a scalar one from the first component.
    pub fn set(self, slave_nodes: &mut SlaveNodes, owner: u32, value: [f64; 3]) {
        let (history, at) = (&mut slave_nodes.history, owner as usize);
        match self {
            Self::None | Self::Body => {}
            Self::Scalar(variable) => history.values_mut(variable, 0)[at] = value[0],
            Self::Vector(variable) => {
                history.values_mut(variable, 0)[3 * at..3 * at + 3].copy_from_slice(&value);
            }
        }
    }

    /// Its name and number of components as a column; `None` without one.
    pub fn column(self) -> Option<(&'static str, usize)> {
        match self {
            Self::None | Self::Body => None,
            Self::Scalar(variable) => Some((variable.name(), 1)),
            Self::Vector(variable) => Some((variable.name(), 3)),
        }
    }

    /// The unknowns in `dimension` dimensions.
    pub fn unknowns(self, dimension: usize) -> Vec<ScalarVariable> {
        match self {
            Self::None | Self::Body => Vec::new(),
            Self::Scalar(variable) => vec![variable.scalar()],
            Self::Vector(variable) => (0..dimension as u8).map(|c| variable.component(c)).collect(),
        }
    }
}
