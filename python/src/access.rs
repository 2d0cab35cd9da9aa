//! The model as Python reads and writes it while a run waits.

use pyo3::IntoPyObjectExt;
use pyo3::exceptions::{PyKeyError, PyRuntimeError, PyValueError};
use pyo3::prelude::*;
use zelus::Error;
use zelus::core::model::{
    EntityRole, EntityTable, Fields, Flags, ModelPart, Named, PropertyValue, ScalarVariable, SubPart, VariableEntry,
    VariableKind, flags, named, variables,
};
use zelus::core::registry;

use crate::buffer::Buffer;
use crate::line::Lent;
use crate::session::Session;

/// A value as Python sees it.
#[derive(FromPyObject, IntoPyObject)]
pub(crate) enum Number {
    One(f64),
    Three([f64; 3]),
}

/// The kind of a variable by name, "component" for one of a vector; `None` when there is none.
#[pyfunction]
pub(crate) fn variable_kind(name: &str) -> Option<String> {
    Some(match named(name)? {
        Named::Component(_) => "component".to_owned(),
        Named::Whole(_, kind) => format!("{kind:?}").to_lowercase(),
    })
}

/// Names of all variables, those of components too, and of all flags.
#[pyfunction]
pub(crate) fn names() -> (Vec<String>, Vec<&'static str>) {
    let names = |entry: &VariableEntry| {
        let axes = if entry.kind == VariableKind::Vector3 { &["", "_X", "_Y", "_Z"][..] } else { &[""] };
        axes.iter().map(|axis| format!("{}{axis}", entry.name)).collect::<Vec<_>>()
    };
    (variables().values().copied().flat_map(names).collect(), registry::names::<flags::FlagEntry>())
}

/// Whether there is a flag of that name.
#[pyfunction]
pub(crate) fn is_flag(name: &str) -> bool {
    flags::flag(name).is_ok()
}

fn wrong(error: Error) -> PyErr {
    PyKeyError::new_err(error.to_string())
}

fn unknown(name: &str) -> PyErr {
    PyKeyError::new_err(format!("there is no variable {name}"))
}

pub(crate) fn read_only() -> PyErr {
    PyRuntimeError::new_err("the model can only be read here")
}

fn root<'l>(lent: &'l Lent, path: &str) -> PyResult<&'l ModelPart> {
    lent.model().root(path).map_err(wrong)
}

fn root_mut<'l>(lent: &'l mut Lent, path: &str) -> PyResult<&'l mut ModelPart> {
    let model = lent.model_mut().ok_or_else(read_only)?;
    model.root_mut(path).map_err(wrong)
}

/// The elements or conditions.
fn table<'m>(part: &'m ModelPart, kind: &str) -> PyResult<&'m EntityTable> {
    match kind {
        "elements" => Ok(&part.elements),
        "conditions" => Ok(&part.conditions),
        other => Err(PyValueError::new_err(format!("there is no table {other}"))),
    }
}

fn table_mut<'m>(part: &'m mut ModelPart, kind: &str) -> PyResult<&'m mut EntityTable> {
    match kind {
        "elements" => Ok(&mut part.elements),
        "conditions" => Ok(&mut part.conditions),
        other => Err(PyValueError::new_err(format!("there is no table {other}"))),
    }
}

/// Columns: of nodes with "history" or without ("nodes"), of "elements" or "conditions".
fn fields<'m>(part: &'m ModelPart, store: &str) -> PyResult<&'m Fields> {
    match store {
        "history" => Ok(&part.nodes.history),
        "nodes" => Ok(&part.nodes.values),
        other => table(part, other).map(|table| &table.data),
    }
}

fn fields_mut<'m>(part: &'m mut ModelPart, store: &str) -> PyResult<&'m mut Fields> {
    match store {
        "history" => Ok(&mut part.nodes.history),
        "nodes" => Ok(&mut part.nodes.values),
        other => table_mut(part, other).map(|table| &mut table.data),
    }
}

fn flags_of<'m>(part: &'m ModelPart, kind: &str) -> PyResult<&'m Flags> {
    if kind == "nodes" { Ok(&part.nodes.flags) } else { table(part, kind).map(|table| &table.flags) }
}

fn flags_mut<'m>(part: &'m mut ModelPart, kind: &str) -> PyResult<&'m mut Flags> {
    if kind == "nodes" { Ok(&mut part.nodes.flags) } else { table_mut(part, kind).map(|table| &mut table.flags) }
}

fn items<'p>(part: &'p SubPart, kind: &str) -> PyResult<&'p Vec<u32>> {
    match kind {
        "nodes" => Ok(&part.nodes),
        "elements" => Ok(&part.elements),
        "conditions" => Ok(&part.conditions),
        other => Err(PyValueError::new_err(format!("there is no table {other}"))),
    }
}

/// Column, place in it, numbers: of a named variable.
fn column_of(name: &str) -> PyResult<(&'static str, usize, usize)> {
    named(name).map(|named| named.column()).ok_or_else(|| unknown(name))
}

/// The variable that can be fixed by that name.
fn scalar(name: &str) -> PyResult<ScalarVariable> {
    match named(name).ok_or_else(|| unknown(name))? {
        Named::Component(scalar) => Ok(scalar),
        Named::Whole(column, VariableKind::Scalar) => Ok(ScalarVariable { column, component: None }),
        Named::Whole(..) => Err(PyValueError::new_err(format!("{name} is no single number: name a component"))),
    }
}

fn number(values: &[f64]) -> Number {
    match values {
        [x, y, z] => Number::Three([*x, *y, *z]),
        other => Number::One(other.first().copied().unwrap_or_default()),
    }
}

fn past() -> PyErr {
    PyValueError::new_err("the step is further back than the model remembers")
}

#[pymethods]
impl Session {
    /// Names of the root parts.
    fn roots(&self) -> PyResult<Vec<String>> {
        self.with(|lent| Ok(lent.model().parts.keys().cloned().collect()))
    }

    /// Names of the sub parts of a part.
    fn sub_parts(&self, path: &str) -> PyResult<Vec<String>> {
        self.with(|lent| Ok(root(lent, path)?.part(path).map_err(wrong)?.children.keys().cloned().collect()))
    }

    /// Indices of the "nodes", "elements" or "conditions" of a part.
    fn items(&self, path: &str, kind: &str) -> PyResult<Buffer> {
        self.with(|lent| Ok(Buffer::list(items(root(lent, path)?.part(path).map_err(wrong)?, kind)?)))
    }

    /// Ids of all nodes, elements or conditions of a root part.
    fn ids(&self, path: &str, kind: &str) -> PyResult<Buffer> {
        self.with(|lent| {
            let part = root(lent, path)?;
            Ok(Buffer::list(if kind == "nodes" { &part.nodes.ids } else { &table(part, kind)?.ids }))
        })
    }

    /// Index of the node, element or condition of that id.
    fn find(&self, path: &str, kind: &str, id: usize) -> PyResult<Option<u32>> {
        self.with(|lent| {
            let part = root(lent, path)?;
            if kind == "nodes" { Ok(part.nodes.find(id)) } else { Ok(table(part, kind)?.find(id)) }
        })
    }

    /// Kind, id of the properties and nodes of an element or condition.
    fn entity(&self, path: &str, kind: &str, at: u32) -> PyResult<(&'static str, usize, Vec<u32>)> {
        self.with(|lent| {
            let table = table(root(lent, path)?, kind)?;
            let of = at as usize;
            Ok((table.kinds[of].name, table.properties[of], table.nodes(at).to_vec()))
        })
    }

    /// How many steps are remembered.
    fn levels(&self, path: &str) -> PyResult<usize> {
        self.with(|lent| Ok(root(lent, path)?.nodes.history.levels()))
    }

    /// Adds a column with history.
    fn add_column(&self, path: &str, name: &str) -> PyResult<()> {
        let (column, _, components) = column_of(name)?;
        self.with(|lent| {
            root_mut(lent, path)?.nodes.history.add_named(column, components);
            Ok(())
        })
    }

    /// A copy of a whole column, one row an item.
    fn column(&self, path: &str, store: &str, name: &str, level: usize) -> PyResult<Buffer> {
        self.with(|lent| {
            let field = fields(root(lent, path)?, store)?.field(name).map_err(wrong)?;
            Ok(Buffer::real(field.levels.get(level).ok_or_else(past)?.to_vec(), field.components))
        })
    }

    /// Writes a whole column, from the bytes of its numbers.
    fn set_column(&self, path: &str, store: &str, name: &str, level: usize, bytes: &[u8]) -> PyResult<()> {
        self.with(|lent| {
            let field = fields_mut(root_mut(lent, path)?, store)?.field_mut(name).map_err(wrong)?;
            let own = field.levels.get_mut(level).ok_or_else(past)?;
            let (numbers, rest) = bytes.as_chunks::<8>();
            if own.len() != numbers.len() || !rest.is_empty() {
                let fact = format!("{name} has {} numbers, {} are given", own.len(), numbers.len());
                return Err(PyValueError::new_err(fact));
            }
            own.iter_mut().zip(numbers).for_each(|(own, number)| *own = f64::from_ne_bytes(*number));
            Ok(())
        })
    }

    /// The value of a variable at one item; zero where a column without history is missing.
    fn value(&self, path: &str, store: &str, at: usize, name: &str, level: usize) -> PyResult<Number> {
        let (column, offset, count) = column_of(name)?;
        self.with(|lent| {
            let fields = fields(root(lent, path)?, store)?;
            let Some(field) = fields.get(column) else {
                return if store == "history" {
                    Err(wrong(fields.field(column).expect_err("it is missing")))
                } else {
                    Ok(number(&[0.0; 3][..count]))
                };
            };
            let start = at * field.components + offset;
            let numbers = if count == 3 { field.components } else { count };
            Ok(number(field.levels.get(level).ok_or_else(past)?.get(start..start + numbers).ok_or_else(past)?))
        })
    }

    /// Writes the value of a variable at one item; a missing column without history is added.
    fn set_value(&self, path: &str, store: &str, at: usize, name: &str, level: usize, value: Number) -> PyResult<()> {
        let (column, offset, count) = column_of(name)?;
        let values = match &value {
            Number::One(value) => std::slice::from_ref(value),
            Number::Three(values) => values,
        };
        if values.len() != count {
            return Err(PyValueError::new_err(format!("{name} takes {count} numbers, {} are given", values.len())));
        }
        self.with(|lent| {
            let fields = fields_mut(root_mut(lent, path)?, store)?;
            if store != "history" {
                let whole = named(column).map_or(count, |whole| whole.column().2);
                fields.add_named(column, whole);
            }
            let field = fields.field_mut(column).map_err(wrong)?;
            let start = at * field.components + offset;
            field.levels.get_mut(level).ok_or_else(past)?[start..start + count].copy_from_slice(values);
            Ok(())
        })
    }

    /// Whether a store has a column for the variable.
    fn has_column(&self, path: &str, store: &str, name: &str) -> PyResult<bool> {
        let (column, ..) = column_of(name)?;
        self.with(|lent| Ok(fields(root(lent, path)?, store)?.has(column)))
    }

    /// Position of a node, now or before any displacement.
    fn position(&self, path: &str, at: usize, initial: bool) -> PyResult<[f64; 3]> {
        self.with(|lent| {
            let nodes = &root(lent, path)?.nodes;
            Ok(if initial { nodes.initial[at] } else { nodes.current[at] })
        })
    }

    /// Positions of all nodes, one row a node.
    fn positions(&self, path: &str, initial: bool) -> PyResult<Buffer> {
        self.with(|lent| {
            let nodes = &root(lent, path)?.nodes;
            let own = if initial { &nodes.initial } else { &nodes.current };
            Ok(Buffer::real(own.as_flattened().to_vec(), 3))
        })
    }

    /// Moves a node, now or also where it starts.
    fn set_position(&self, path: &str, at: usize, initial: bool, to: [f64; 3]) -> PyResult<()> {
        self.with(|lent| {
            let nodes = &mut root_mut(lent, path)?.nodes;
            if initial {
                nodes.initial[at] = to;
            } else {
                nodes.current[at] = to;
            }
            Ok(())
        })
    }

    /// Fixes or frees a variable of nodes.
    fn fix(&self, path: &str, name: &str, nodes: Vec<u32>, fixed: bool) -> PyResult<()> {
        let scalar = scalar(name)?;
        self.with(|lent| {
            root_mut(lent, path)?.nodes.set_fixed(scalar, &nodes, fixed);
            Ok(())
        })
    }

    /// Whether a variable of a node is fixed.
    fn is_fixed(&self, path: &str, name: &str, node: u32) -> PyResult<bool> {
        let scalar = scalar(name)?;
        self.with(|lent| Ok(root(lent, path)?.nodes.is_fixed(scalar, node)))
    }

    /// A flag of a node, element or condition; `None` when it is undefined.
    fn flag(&self, path: &str, kind: &str, at: usize, name: &str) -> PyResult<Option<bool>> {
        self.with(|lent| Ok(flags_of(root(lent, path)?, kind)?.get(name, at)))
    }

    /// Sets, unsets or undefines a flag.
    fn set_flag(&self, path: &str, kind: &str, at: usize, name: &str, state: Option<bool>) -> PyResult<()> {
        let name = flags::flag(name).map_err(|problem| PyKeyError::new_err(problem.to_string()))?;
        self.with(|lent| {
            let flags = flags_mut(root_mut(lent, path)?, kind)?;
            match state {
                Some(state) => flags.set(name, at, state),
                None => flags.undefine(name, at),
            }
            Ok(())
        })
    }

    /// A number of the step data; `None` when there is none of that name.
    fn info(&self, path: &str, name: &str) -> PyResult<Option<f64>> {
        self.with(|lent| {
            let info = &root(lent, path)?.info;
            Ok(match name {
                "TIME" => Some(info.time),
                "DELTA_TIME" => Some(info.delta_time),
                "STEP" => Some(info.step as f64),
                "NL_ITERATION_NUMBER" => Some(info.nl_iteration as f64),
                "DOMAIN_SIZE" => Some(info.domain_size as f64),
                other => info
                    .values
                    .get(other)
                    .copied()
                    .or_else(|| info.marks.get(other).map(|&mark| f64::from(u8::from(mark)))),
            })
        })
    }

    /// Writes a named number of the step data; time and counters are the run's.
    fn set_info(&self, path: &str, name: &str, value: f64) -> PyResult<()> {
        let (column, ..) = column_of(name)?;
        self.with(|lent| {
            root_mut(lent, path)?.info.values.insert(column, value);
            Ok(())
        })
    }

    /// Ids of the properties of a root part.
    fn properties(&self, path: &str) -> PyResult<Vec<usize>> {
        self.with(|lent| Ok(root(lent, path)?.properties.keys().copied().collect()))
    }

    /// A value of properties: a number, a list of numbers, or a word; `None` when there is none.
    fn property(&self, py: Python<'_>, path: &str, id: usize, name: &str) -> PyResult<Option<Py<PyAny>>> {
        self.with(|lent| {
            let own = root(lent, path)?.properties.get(&id).and_then(|own| own.values.get(name));
            own.map(|value| match value {
                PropertyValue::Number(value) => value.into_py_any(py),
                PropertyValue::Boolean(value) => value.into_py_any(py),
                PropertyValue::Vector(values) => values.into_py_any(py),
                PropertyValue::Matrix(rows) => rows.into_py_any(py),
                PropertyValue::Text(word) => word.into_py_any(py),
            })
            .transpose()
        })
    }

    /// Writes a number or a list of numbers to properties.
    fn set_property(&self, path: &str, id: usize, name: &str, value: Bound<'_, PyAny>) -> PyResult<()> {
        let value = match value.extract::<f64>() {
            Ok(number) => PropertyValue::Number(number),
            Err(_) => PropertyValue::Vector(value.extract()?),
        };
        self.with(|lent| {
            let own = root_mut(lent, path)?.properties.get_mut(&id);
            let own = own.ok_or_else(|| PyKeyError::new_err(format!("there are no properties {id}")))?;
            own.values.insert(name.to_owned(), value);
            Ok(())
        })
    }

    /// Adds an empty sub part.
    fn create_part(&self, path: &str, name: &str) -> PyResult<()> {
        self.with(|lent| {
            let part = root_mut(lent, path)?.part_mut(path).map_err(wrong)?;
            if part.children.contains_key(name) {
                return Err(PyValueError::new_err(format!("{path} has a sub model part {name} already")));
            }
            part.children.insert(name.to_owned(), SubPart::new(name));
            Ok(())
        })
    }

    /// Adds nodes, elements or conditions, by index, to a part and those above it.
    fn add_items(&self, path: &str, kind: &str, more: Vec<u32>) -> PyResult<()> {
        self.with(|lent| {
            let root = root_mut(lent, path)?;
            items(root.part(path).map_err(wrong)?, kind)?;
            root.along(path, |part| {
                let own = match kind {
                    "nodes" => &mut part.nodes,
                    "elements" => &mut part.elements,
                    _ => &mut part.conditions,
                };
                own.extend(&more);
                own.sort_unstable();
                own.dedup();
            });
            Ok(())
        })
    }

    /// A variable at the Gauss points of an element or condition, one row a point; `None` when it does not know it.
    fn gauss(&self, path: &str, kind: &str, at: u32, name: &str) -> PyResult<Option<Buffer>> {
        let role = if kind == "elements" { EntityRole::Element } else { EntityRole::Condition };
        self.with(|lent| {
            let part = root(lent, path)?;
            let system = lent.system().ok_or_else(|| PyRuntimeError::new_err("elements are not ready here"))?;
            let mut blocks = system.blocks(role).iter();
            let found = blocks.find_map(|block| Some((block, block.members().binary_search(&at).ok()?)));
            let values = found.and_then(|(block, place)| block.gauss(&part.view(), name, place));
            Ok(values.map(|own| Buffer::real(own.values, own.components)))
        })
    }
}
