//! Contents of a picture of a model part: settings shared by the VTK and VTU processes, and the data they ask for.

use super::gauss::{self, GaussWeight};
use super::part_path::one_of;
use super::quantity::{GaussQuantity, Quantity, flag_column, flag_list};
use super::{lists, usual};
use crate::assembly::System;
use crate::diagnostics::{Diagnostic, Place, Report, Result};
use crate::io::results::{Column, Dataset};
use crate::model::{EntityRole, EntityTable, ModelPart, SubPart};
use crate::parameters::Settings;

/// Entities that are the cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum CellChoice {
    /// Elements where there are any, else conditions.
    Automatic,
    Elements,
    Conditions,
}

/// Points and cells of a part, with the indices they come from.
pub(super) struct Mesh {
    pub(super) data: Dataset,
    /// Node index of each point.
    pub(super) nodes: Vec<u32>,
    /// Entity index of each cell.
    pub(super) cells: Vec<u32>,
    /// Whether the cells are elements or conditions.
    pub(super) kind: EntityRole,
}

impl Mesh {
    /// The mesh of a part; nodes of its cells belong to it even where the part does not list them. Each rank has the cells it evaluates
    /// with their points, and its nodes that no cell has; collective.
    pub(super) fn new(part: &ModelPart, selection: &SubPart, choice: CellChoice, deformed: bool) -> Self {
        let elements = match choice {
            CellChoice::Automatic => part.ranks.any(!selection.elements.is_empty()),
            CellChoice::Elements => true,
            CellChoice::Conditions => false,
        };
        let (kind, table, chosen) = match elements {
            true => (EntityRole::Element, &part.elements, &selection.elements),
            false => (EntityRole::Condition, &part.conditions, &selection.conditions),
        };
        let drawn = |&&at: &&u32| table.kinds[at as usize].cell.is_some() && part.evaluates(kind, at as usize);
        let cells: Vec<u32> = chosen.iter().filter(drawn).copied().collect();
        let mut used = vec![false; part.nodes.len()];
        cells.iter().flat_map(|&cell| table.nodes(cell)).for_each(|&node| used[node as usize] = true);
        let loose = |&&node: &&u32| part.owns_node(node as usize);
        let has_cell = of_all(part, &used);
        let loose = selection.nodes.iter().filter(|&&node| !has_cell[node as usize]).filter(loose);
        loose.for_each(|&node| used[node as usize] = true);
        let nodes: Vec<u32> = (0..part.nodes.len() as u32).filter(|&node| used[node as usize]).collect();
        let data = dataset(part, table, &nodes, &cells, deformed);
        Self { data, nodes, cells, kind }
    }

    /// The table of the cells.
    pub(super) fn table<'m>(&self, part: &'m ModelPart) -> &'m EntityTable {
        if self.kind == EntityRole::Element { &part.elements } else { &part.conditions }
    }
}

/// The cells of a whole part on all its nodes, with default output variables that no column of the model holds: quantities of Gauss
/// points as values at nodes and as means of cells, and the properties and sub part of each cell. Collective.
pub fn usual_results(part: &ModelPart, system: &System) -> Dataset {
    let mut mesh = Mesh::new(part, &part.tree, CellChoice::Automatic, false);
    for quantity in usual::gauss(part, system) {
        let elements = &part.tree.elements;
        let nodal =
            gauss::at_nodes(part, system, EntityRole::Element, elements, &mesh.nodes, &quantity, GaussWeight::Volume);
        mesh.data.point_data.push(nodal);
        mesh.data.cell_data.push(gauss::means(part, system, mesh.kind, &mesh.cells, &quantity));
    }
    let parts = usual::parts(&part.ranks, &part.tree, mesh.kind, &mesh.cells);
    mesh.data.cell_data.push(Column::ids("PROPERTIES_ID", &mesh.data.cells.properties));
    mesh.data.cell_data.push(Column::ids("PART", &parts));
    mesh.data
}

/// Whether elements of all ranks have several sets of properties; collective.
fn has_several_materials(part: &ModelPart) -> bool {
    let own = &part.elements.properties;
    let ends = own.iter().min().into_iter().chain(own.iter().max()).map(|&id| id as f64).collect::<Vec<f64>>();
    let all = part.ranks.gather_numbers(&ends).concat();
    all.iter().any(|id| *id != all[0])
}

/// Marks of nodes that any rank has set; collective.
fn of_all(part: &ModelPart, marks: &[bool]) -> Vec<bool> {
    let Some(share) = &part.share else { return marks.to_vec() };
    let mut sums: Vec<f64> = marks.iter().map(|&mark| f64::from(u8::from(mark))).collect();
    share.halo.sum(&mut sums);
    sums.iter().map(|&sum| sum > 0.0).collect()
}

fn dataset(part: &ModelPart, table: &EntityTable, nodes: &[u32], cells: &[u32], deformed: bool) -> Dataset {
    let mut point_of = vec![0_u32; part.nodes.len()];
    for (point, &node) in nodes.iter().enumerate() {
        point_of[node as usize] = point as u32;
    }
    let positions = if deformed { &part.nodes.current } else { &part.nodes.initial };
    let mut data = Dataset {
        point_ids: nodes.iter().map(|&node| part.nodes.ids[node as usize]).collect(),
        points: nodes.iter().map(|&node| positions[node as usize]).collect(),
        ..Dataset::default()
    };
    for &cell in cells {
        let at = cell as usize;
        if let Some(shape) = table.kinds[at].cell {
            let points = table.nodes(cell).iter().map(|&node| point_of[node as usize]);
            data.cells.push(table.ids[at], table.properties[at], shape, points);
        }
    }
    data
}

/// The columns a deck asks for.
pub(super) struct OutputColumns {
    choice: CellChoice,
    pub(super) deformed: bool,
    ids: bool,
    history: Vec<Quantity>,
    values: Vec<Quantity>,
    flags: Vec<&'static str>,
    extrapolated: Vec<GaussQuantity>,
    element_values: Vec<Quantity>,
    element_flags: Vec<&'static str>,
    condition_values: Vec<Quantity>,
    condition_flags: Vec<&'static str>,
    gauss: Vec<GaussQuantity>,
    /// Whether no list names anything, and the default output variables are shown.
    pub(super) usual: bool,
    /// Where the deck names the picture; `None` where names in other lists than theirs are written as zeros.
    refuses: Option<Place>,
}

impl OutputColumns {
    /// Reads the keys that VTK and VTU share.
    pub(super) fn new(settings: &Settings, report: &mut Report) -> Result<Self> {
        let choice = match one_of(settings, "entity_type", &["automatic", "element", "condition"])? {
            0 => CellChoice::Automatic,
            1 => CellChoice::Elements,
            _ => CellChoice::Conditions,
        };
        let mut out = Self {
            choice,
            deformed: settings.get_bool("write_deformed_configuration")?,
            ids: settings.get_bool("write_ids")?,
            history: Quantity::shown(settings, "nodal_solution_step_data_variables", report)?,
            values: Quantity::shown(settings, "nodal_data_value_variables", report)?,
            flags: flag_list(settings, "nodal_flags", report)?,
            extrapolated: GaussQuantity::shown(settings, "gauss_point_variables_extrapolated_to_nodes", report)?,
            element_values: Quantity::shown(settings, "element_data_value_variables", report)?,
            element_flags: flag_list(settings, "element_flags", report)?,
            condition_values: Quantity::shown(settings, "condition_data_value_variables", report)?,
            condition_flags: flag_list(settings, "condition_flags", report)?,
            gauss: GaussQuantity::shown(settings, "gauss_point_variables_in_elements", report)?,
            usual: settings.get_bool("usual_results")?,
            refuses: settings.get_bool("refuse_other_lists")?.then(|| settings.place()),
        };
        let lists = [&out.history, &out.values, &out.element_values, &out.condition_values];
        let flags = [&out.flags, &out.element_flags, &out.condition_flags];
        let gauss = [&out.extrapolated, &out.gauss];
        let names_nothing = lists.iter().all(|list| list.is_empty())
            && flags.iter().all(|list| list.is_empty())
            && gauss.iter().all(|list| list.is_empty());
        out.usual &= names_nothing;
        Ok(out)
    }

    /// Faults of its lists, once all unknowns are known.
    pub(super) fn check(&self, part: &ModelPart, system: &System) -> Vec<Diagnostic> {
        let Some(place) = &self.refuses else { return Vec::new() };
        lists::check(part, system, place, &self.history, &self.values, &self.extrapolated)
    }

    /// Warnings of quantities that nothing computes, which pictures show as zeros; asked in a step. Collective.
    pub(super) fn missing(&self, part: &ModelPart, system: &System) -> Vec<Diagnostic> {
        let by = "output of pictures";
        let of_nodes = self.history.iter().chain(&self.values).filter_map(|own| own.missing_at_nodes(part, by));
        let of_elements = self.element_values.iter();
        let of_elements = of_elements.filter_map(|own| own.missing(&[&part.elements.data], "elements have", by));
        let of_conditions = self.condition_values.iter();
        let of_conditions =
            of_conditions.filter_map(|own| own.missing(&[&part.conditions.data], "conditions have", by));
        let gauss = self.extrapolated.iter().chain(&self.gauss).filter_map(|own| own.missing(part, system, by));
        of_nodes.chain(of_elements).chain(of_conditions).chain(gauss).collect()
    }

    /// The picture of one part now, of several ranks the piece of each; collective.
    pub(super) fn draw(&self, part: &ModelPart, system: &System, selection: &SubPart) -> Mesh {
        let mut mesh = Mesh::new(part, selection, self.choice, self.deformed);
        mesh.data.point_data = self.point_data(part, system, selection, &mesh);
        mesh.data.cell_data = self.cell_data(part, system, &mesh);
        if self.usual {
            let parts = usual::parts(&part.ranks, selection, mesh.kind, &mesh.cells);
            mesh.data.cell_data.push(Column::ids("PART", &parts));
        }
        mesh
    }

    fn point_data(&self, part: &ModelPart, system: &System, selection: &SubPart, mesh: &Mesh) -> Vec<Column> {
        let mut out: Vec<Column> = Vec::new();
        let (history, values, extrapolated) = match self.usual {
            true => (&usual::history(part), &usual::values(part), &usual::gauss(part, system)),
            false => (&self.history, &self.values, &self.extrapolated),
        };
        out.extend(history.iter().map(|q| q.gather(&part.nodes.history, &mesh.nodes)));
        out.extend(values.iter().map(|q| q.gather(&part.nodes.values, &mesh.nodes)));
        for quantity in extrapolated {
            out.push(gauss::at_nodes(
                part,
                system,
                EntityRole::Element,
                &selection.elements,
                &mesh.nodes,
                quantity,
                GaussWeight::Volume,
            ));
        }
        out.extend(self.flags.iter().map(|flag| flag_column(&part.nodes.flags, flag, &mesh.nodes)));
        out.extend((self.ids || self.usual).then(|| Column::ids("KRATOS_NODE_ID", &mesh.data.point_ids)));
        out
    }

    fn cell_data(&self, part: &ModelPart, system: &System, mesh: &Mesh) -> Vec<Column> {
        let table = mesh.table(part);
        let (quantities, flags, id) = match mesh.kind {
            EntityRole::Element => (&self.element_values, &self.element_flags, "KRATOS_ELEMENT_ID"),
            _ => (&self.condition_values, &self.condition_flags, "KRATOS_CONDITION_ID"),
        };
        let mut out: Vec<Column> = quantities.iter().map(|q| q.gather(&table.data, &mesh.cells)).collect();
        out.extend(flags.iter().map(|flag| flag_column(&table.flags, flag, &mesh.cells)));
        // Nodal values are means across the interfaces of materials, where stresses jump; those of cells are not.
        let usual = if self.usual && has_several_materials(part) { usual::gauss(part, system) } else { Vec::new() };
        let of_cells = self.gauss.iter().chain(&usual);
        out.extend(of_cells.map(|quantity| gauss::means(part, system, mesh.kind, &mesh.cells, quantity)));
        if self.ids || self.usual {
            out.push(Column::ids("PROPERTIES_ID", &mesh.data.cells.properties));
        }
        if self.ids {
            out.push(Column::ids(id, &mesh.data.cells.ids));
        }
        out
    }
}
