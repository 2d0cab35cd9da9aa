//! Quantities of Gauss points as variables of the nodes around them.

use super::gauss::{self, GaussWeight};
use super::part_path::PartPath;
use super::quantity::GaussQuantity;
use crate::assembly::System;
use crate::diagnostics::Result;
use crate::io::results::{Column, Values};
use crate::model::{EntityRole, Model, ModelPart, named};
use crate::parameters::Defaults;
use crate::processes::{Process, ProcessEntry, ProcessRequest};
use crate::register;

struct Extrapolation {
    part: PartPath,
    quantities: Vec<GaussQuantity>,
    share: GaussWeight,
    history: bool,
}

fn build(request: &mut ProcessRequest<'_>) -> Result<Box<dyn Process>> {
    let settings = &request.settings_with(|defaults: Defaults| defaults.require(&["model_part_name"]))?;
    Ok(Box::new(Extrapolation {
        part: PartPath::new(settings)?,
        quantities: GaussQuantity::list(settings, "list_of_variables", request.report)?,
        share: if settings.get_bool("area_average")? { GaussWeight::Volume } else { GaussWeight::Point },
        history: !settings.get_bool("extrapolate_non_historical")?,
    }))
}

impl Extrapolation {
    /// Writes a column of all nodes of a selection into the fields of the part.
    fn store(&self, part: &mut ModelPart, nodes: &[u32], column: &Column) {
        let (Some(variable), Values::Real(values)) = (named(&column.name), &column.values) else { return };
        let fields = if self.history { &mut part.nodes.history } else { &mut part.nodes.values };
        let (name, ..) = variable.column();
        fields.add_named(name, column.components);
        let field = fields.get_mut(name).expect("just added");
        let width = field.components;
        for (row, &node) in values.chunks_exact(column.components).zip(nodes) {
            let count = width.min(row.len());
            field.levels[0][node as usize * width..][..count].copy_from_slice(&row[..count]);
        }
    }
}

impl Process for Extrapolation {
    fn drives(&self, _part: &ModelPart, _system: &System) -> bool {
        false
    }

    fn initialize(&mut self, model: &mut Model) -> Result<()> {
        self.part.find(model).map(|_| ())
    }

    fn end_step(&mut self, model: &mut Model, system: &System) -> Result<()> {
        let (part, selection) = self.part.find(model)?;
        let nodes = selection.nodes.clone();
        let of = |quantity| {
            gauss::at_nodes(part, system, EntityRole::Element, &selection.elements, &nodes, quantity, self.share)
        };
        let columns: Vec<Column> = self.quantities.iter().map(of).collect();
        let part = model.root_mut(&self.part.path)?;
        columns.iter().for_each(|column| self.store(part, &nodes, column));
        Ok(())
    }
}

register! { ProcessEntry "integration_values_extrapolation_to_nodes_process",
    aliases: &["IntegrationValuesExtrapolationToNodesProcess"],
    about: "extrapolates results at Gauss points to nodes, averaged over the elements around a node",
    source: "v_i = Σ w J |N_i| v / Σ w J |N_i|",
    defaults: include_str!(concat!(
        env!("CARGO_MANIFEST_DIR"),
        "/../configs/processes/integration_values_extrapolation_to_nodes_process.json"
    )),
    build: build,
}
