//! Springs and masses as elements of an mdpa file, with their constants as data of the elements.

use zelus_core::io::mdpa::{DataBlock, DataColumn, MdpaDocument, MdpaEntities, PropertiesBlock};

use super::conditions::DiscreteKind;
use super::mesh::Mesh;

/// Elements of a kind, by the beginning of their name, with the variable of their constants.
struct Block {
    name: String,
    variable: &'static str,
    ids: Vec<u32>,
    nodes: Vec<u32>,
    values: Vec<f64>,
}

/// Adds the elements, with properties of their own.
pub(super) fn add(mesh: &Mesh, space: usize, out: &mut MdpaDocument) {
    let elements = out.elements.iter().flat_map(|block| &block.ids);
    let first = elements.max().map_or(1, |id| id + 1);
    let properties = out.properties.iter().map(|block| block.id).max().map_or(1, |id| id + 1);
    let mut blocks: Vec<Block> = Vec::new();
    for (next, own) in (first..).zip(&mesh.discrete) {
        let (stem, variable, values) = match &own.kind {
            DiscreteKind::Ground(values) => ("NodalConcentratedElement", "NODAL_DISPLACEMENT_STIFFNESS", &values[..]),
            DiscreteKind::Between(values) => ("SpringDamperElement", "NODAL_DISPLACEMENT_STIFFNESS", &values[..]),
            DiscreteKind::Axial(value) if mesh.is_large => {
                ("AxialSpringElement", "AXIAL_STIFFNESS", std::slice::from_ref(value))
            }
            DiscreteKind::Axial(value) => ("LinearAxialSpringElement", "AXIAL_STIFFNESS", std::slice::from_ref(value)),
            DiscreteKind::Mass(value) => ("NodalConcentratedElement", "NODAL_MASS", std::slice::from_ref(value)),
        };
        let name = format!("{stem}{space}D{}N", own.nodes.len());
        let at = blocks.iter().position(|block| block.name == name && block.variable == variable);
        let at = at.unwrap_or_else(|| {
            blocks.push(Block { name, variable, ids: Vec::new(), nodes: Vec::new(), values: Vec::new() });
            blocks.len() - 1
        });
        blocks[at].ids.push(next);
        blocks[at].nodes.extend(own.nodes.iter().map(|&node| mesh.node_ids[node as usize]));
        blocks[at].values.extend(values);
    }
    if !blocks.is_empty() {
        out.properties.push(PropertiesBlock { id: properties, ..PropertiesBlock::default() });
    }
    for Block { name, variable, ids, nodes, values } in blocks {
        let count = ids.len();
        let column = if values.len() == count {
            DataColumn::Scalar { values, fixed: Vec::new() }
        } else {
            DataColumn::Vector { size: values.len() / count, values }
        };
        out.elemental_data.push(DataBlock {
            variable: variable.to_owned(),
            ids: ids.clone(),
            values: column,
            ..DataBlock::default()
        });
        out.elements.push(MdpaEntities {
            name,
            nodes_per_entity: nodes.len() / count,
            ids,
            properties: vec![properties; count],
            nodes,
            ..MdpaEntities::default()
        });
    }
}
