//! Results of a run at its end, as arrays that take over its buffers.

use std::collections::BTreeMap;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use zelus::core::geometry::Shape;
use zelus::core::io::results::{Cells, Column, Dataset, Values};
use zelus::core::model::{Fields, ModelPart, SubPart};

use crate::buffer::Buffer;

/// Mesh, parts and fields of a part; `computed` has the results of elements beside them.
pub(crate) fn outcome<'py>(py: Python<'py>, part: ModelPart, computed: Dataset) -> PyResult<Bound<'py, PyDict>> {
    let out = PyDict::new(py);
    out.set_item("name", &part.name)?;
    out.set_item("node_ids", Buffer::list(&part.nodes.ids))?;
    out.set_item("points", Buffer::real(part.nodes.initial.into_flattened(), 3))?;
    let (cells, order) = by_shape(&computed.cells);
    let of_shapes = PyDict::new(py);
    for (shape, points) in cells {
        of_shapes.set_item(format!("{shape:?}"), Buffer::whole(points, shape.nodes()))?;
    }
    out.set_item("cells", of_shapes)?;
    let element_ids: Vec<usize> = order.iter().map(|&at| computed.cells.ids[at]).collect();
    out.set_item("element_ids", Buffer::list(&element_ids))?;
    let parts = PyDict::new(py);
    add_parts(&part.tree, "", &parts)?;
    out.set_item("parts", parts)?;
    let fields = PyDict::new(py);
    for column in computed.point_data {
        add_column(&fields, column, None)?;
    }
    for own in [part.nodes.values, part.nodes.history] {
        add_fields(&fields, own)?;
    }
    out.set_item("fields", fields)?;
    let of_elements = PyDict::new(py);
    for column in computed.cell_data {
        add_column(&of_elements, column, Some(&order))?;
    }
    out.set_item("element_fields", of_elements)?;
    Ok(out)
}

/// Points of the cells by shape, and all cells in that order.
fn by_shape(cells: &Cells) -> (BTreeMap<Shape, Vec<i64>>, Vec<usize>) {
    let mut points: BTreeMap<Shape, Vec<i64>> = BTreeMap::new();
    let mut order: Vec<usize> = (0..cells.len()).collect();
    order.sort_by_key(|&at| cells.shapes[at]);
    for (shape, own) in cells.iter() {
        points.entry(shape).or_default().extend(own.iter().map(|&node| i64::from(node)));
    }
    (points, order)
}

fn add_parts(part: &SubPart, before: &str, out: &Bound<'_, PyDict>) -> PyResult<()> {
    for (name, child) in &part.children {
        let path = format!("{before}{name}");
        out.set_item(&path, Buffer::list(&child.nodes))?;
        add_parts(child, &format!("{path}."), out)?;
    }
    Ok(())
}

/// The present level of every column.
fn add_fields(out: &Bound<'_, PyDict>, mut fields: Fields) -> PyResult<()> {
    let names: Vec<&str> = fields.iter().map(|(name, _)| name).collect();
    for name in names {
        let field = fields.get_mut(name).expect("it is one of them");
        out.set_item(name, Buffer::real(std::mem::take(&mut field.levels[0]).into_vec(), field.components))?;
    }
    Ok(())
}

/// One column, in an order of its rows where there is one.
fn add_column(out: &Bound<'_, PyDict>, column: Column, order: Option<&[usize]>) -> PyResult<()> {
    let width = column.components;
    let buffer = match column.values {
        Values::Whole(values) => match order {
            Some(order) => Buffer::list(&order.iter().map(|&at| values[at]).collect::<Vec<_>>()),
            None => Buffer::list(&values),
        },
        Values::Real(values) => {
            let row = |&at: &usize| values[at * width..(at + 1) * width].iter().copied();
            let ordered = order.map(|order| order.iter().flat_map(row).collect());
            Buffer::real(ordered.unwrap_or(values), width)
        }
    };
    out.set_item(column.name, buffer)
}
