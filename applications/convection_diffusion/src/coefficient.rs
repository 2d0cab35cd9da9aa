//! A coefficient of the balance of heat: the constant or table of a material, or a field that a process sets on nodes.

use zelus_core::entities::EntityView;
use zelus_core::model::{Nodes, Properties, Table};
use zelus_core::scalar::Real;

/// Density, conductivity or specific heat of the elements of one block.
#[derive(Debug, Clone)]
pub struct Coefficient {
    column: Option<&'static str>,
    own: Own,
}

/// Values from the material of the element.
#[derive(Debug, Clone)]
enum Own {
    Constant(f64),
    /// Over the unknown.
    Table(Table),
    Missing,
}

/// A coefficient in one element.
#[derive(Clone, Copy)]
pub enum Local<'a, const NODES: usize> {
    /// Coefficient of its material.
    Own(&'a Coefficient),
    /// Values at its nodes.
    Nodal([f64; NODES]),
}

impl Coefficient {
    /// The coefficient with the name of the column, which is that in the properties, too; `off` where the deck switches it off.
    ///
    /// A table over `unknown` acts, whether an accessor names it or not.
    pub fn new(column: Option<&'static str>, properties: Option<&Properties>, unknown: &str, off: f64) -> Self {
        let own = match (column, properties) {
            (None, _) => Own::Constant(off),
            (Some(name), Some(properties)) => {
                let table = properties.table_over(unknown, name);
                match (table, properties.number(name)) {
                    (Some(table), _) => Own::Table(table.clone()),
                    (None, Some(value)) => Own::Constant(value),
                    (None, None) => Own::Missing,
                }
            }
            (Some(_), None) => Own::Missing,
        };
        Self { column, own }
    }

    /// Itself, or a constant where the material says nothing.
    pub fn or(self, value: f64) -> Self {
        let own = if self.is_missing() { Own::Constant(value) } else { self.own };
        Self { own, ..self }
    }

    /// Whether it depends on the unknown.
    pub fn varies(&self) -> bool {
        matches!(self.own, Own::Table(_))
    }

    /// Whether the material says nothing of it.
    pub fn is_missing(&self) -> bool {
        matches!(self.own, Own::Missing)
    }

    /// The coefficient in one element: values of nodes where a process has set one that differs from the material's, or where the
    /// material gives none.
    pub fn in_element<const NODES: usize>(
        &self,
        entity: &EntityView<'_, NODES>,
        nodes: &Nodes,
        unknown: &[f64; NODES],
    ) -> Local<'_, NODES> {
        let Some(column) = self.column else { return Local::Own(self) };
        let (present, written) = (nodes.history.level(column, 0), nodes.values.level(column, 0));
        if present.is_empty() {
            return Local::Own(self);
        }
        let is_set = |node: u32| written.get(node as usize).is_none_or(|written| *written != present[node as usize]);
        if !self.is_missing() && !entity.nodes.iter().any(|&node| is_set(node)) {
            return Local::Own(self);
        }
        let value = |i: usize| {
            let node = entity.nodes[i];
            if self.is_missing() || is_set(node) { present[node as usize] } else { self.at(unknown[i]) }
        };
        Local::Nodal(std::array::from_fn(value))
    }

    /// Its name, where neither the material nor a process gives its value in an element.
    pub fn unknown_in<const NODES: usize>(&self, local: &Local<'_, NODES>) -> Option<&'static str> {
        let is_zero = matches!(local, Local::Nodal(values) if values.iter().all(|value| *value == 0.0));
        self.column.filter(|_| self.is_missing() && (is_zero || matches!(local, Local::Own(_))))
    }

    /// The material's value at a value of the unknown; 0 where it says nothing.
    pub fn at<R: Real>(&self, unknown: R) -> R {
        match &self.own {
            Own::Constant(value) => R::constant(*value),
            Own::Table(table) => unknown.chain(table.value(unknown.value()), table.slope(unknown.value())),
            Own::Missing => R::zero(),
        }
    }
}

impl<const NODES: usize> Local<'_, NODES> {
    /// The value at a point with these shape functions, where the unknown is `unknown`.
    pub fn at<R: Real>(&self, n: &[f64; NODES], unknown: R) -> R {
        match self {
            Self::Own(coefficient) => coefficient.at(unknown),
            Self::Nodal(values) => R::constant(n.iter().zip(values).map(|(n, value)| n * value).sum()),
        }
    }

    /// The mean over the nodes of values there, the material's own value otherwise.
    pub fn mean<R: Real>(&self, unknown: R) -> R {
        match self {
            Self::Own(coefficient) => coefficient.at(unknown),
            Self::Nodal(values) => R::constant(values.iter().sum::<f64>() / NODES as f64),
        }
    }
}
