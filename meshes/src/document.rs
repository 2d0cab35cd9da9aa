//! From a mesh to the document of an mdpa file, and back.

use rustc_hash::FxHashMap;
use zelus_core::diagnostics::{Diagnostic, Place, Result};
use zelus_core::entities::find_kind;
use zelus_core::geometry::Shape;
use zelus_core::io::mdpa::{MdpaDocument, MdpaEntities, MdpaNodes, PropertiesBlock, SubModelPart};
use zelus_core::io::shape_of_geometry;
use zelus_core::model::EntityRole;
use zelus_core::parameters::Settings;

use super::constraints::constraints;
use super::discrete;
use super::mesh::{Mesh, Plane};
use super::repair::{is_planar, repair};

/// Beginnings of the names of elements and conditions, as `SmallDisplacementElement` of `SmallDisplacementElement3D8N`.
#[derive(Debug, Clone)]
pub struct Names {
    /// Name of elements.
    pub element: String,
    /// Name of conditions; empty: those that carry loads per length or area.
    pub condition: String,
}

impl Names {
    /// Names in a format's settings.
    ///
    /// # Errors
    /// Keys of another type.
    pub fn of(settings: &Settings) -> Result<Self> {
        let get = |key: &str| settings.get_str(key).map(str::to_owned);
        Ok(Self { element: get("element_name")?, condition: get("condition_name")? })
    }

    fn of_element(&self, mesh: &Mesh) -> String {
        if mesh.plane == Some(Plane::Axial) { format!("Axisym{}", self.element) } else { self.element.clone() }
    }

    fn of_condition(&self, mesh: &Mesh) -> String {
        match (self.condition.as_str(), mesh.dimension(), mesh.plane) {
            ("", 3, _) => "SurfaceLoadCondition".to_owned(),
            ("", 2, Some(Plane::Axial)) => "AxisymLineLoadCondition".to_owned(),
            ("", 2, _) => "LineLoadCondition".to_owned(),
            ("", ..) => "PointLoadCondition".to_owned(),
            (name, ..) => name.to_owned(),
        }
    }
}

/// Mends a mesh and makes the document of it: cells of the highest dimension are elements, those one below and in a group conditions,
/// groups sub model parts. Returns notes of repairs and of omitted contents.
///
/// # Errors
/// Errors of [`repair`].
pub fn finish(mut mesh: Mesh, settings: &Settings, path: &std::path::Path) -> Result<(MdpaDocument, Vec<Diagnostic>)> {
    let place = Place::file(path);
    let mut said = repair(&mut mesh, &place)?;
    let document = document(&mesh, &Names::of(settings)?, &place, &mut said);
    Ok((document, said))
}

/// The document of a mended mesh.
pub fn document(mesh: &Mesh, names: &Names, place: &Place, said: &mut Vec<Diagnostic>) -> MdpaDocument {
    let dimension = mesh.dimension();
    let space = if dimension < 3 && is_planar(mesh) { 2 } else { 3 };
    let mut grouped = vec![0_u32; mesh.cells.len()];
    let mut bodies = 0;
    for group in &mesh.groups {
        let holds_elements = group.cells.iter().any(|&cell| mesh.cells.shapes[cell as usize].dim() == dimension);
        bodies += u32::from(holds_elements);
        for &cell in &group.cells {
            let own = &mut grouped[cell as usize];
            *own = if *own == 0 { bodies.max(1) } else { *own };
        }
    }
    let mut out = MdpaDocument { file: place.file.clone(), ..MdpaDocument::default() };
    out.nodes = MdpaNodes { ids: mesh.node_ids.clone(), coordinates: mesh.points.clone() };
    let mut lost = 0;
    let stems = [names.of_condition(mesh), names.of_element(mesh)];
    for cell in 0..mesh.cells.len() {
        let shape = mesh.cells.shapes[cell];
        let role = match dimension - shape.dim() {
            0 => EntityRole::Element,
            1 if grouped[cell] > 0 => EntityRole::Condition,
            _ => {
                lost += 1;
                continue;
            }
        };
        let is_element = role == EntityRole::Element;
        let blocks = if is_element { &mut out.elements } else { &mut out.conditions };
        let name = format!("{}{}", stems[usize::from(is_element)], shape.cell().suffix(space));
        let at = blocks.iter().position(|block| block.name == name).unwrap_or_else(|| {
            blocks.push(MdpaEntities { name, nodes_per_entity: shape.nodes(), ..MdpaEntities::default() });
            blocks.len() - 1
        });
        let block = &mut blocks[at];
        block.ids.push(mesh.cells.ids[cell]);
        block.properties.push(if is_element { grouped[cell] } else { 0 });
        block.nodes.extend(mesh.cells.nodes(cell).iter().map(|&node| mesh.node_ids[node as usize]));
    }
    let ids = out.elements.iter().chain(&out.conditions).flat_map(|block| block.properties.iter().copied());
    let ids: std::collections::BTreeSet<u32> = ids.collect();
    out.properties = ids.into_iter().map(|id| PropertiesBlock { id, ..PropertiesBlock::default() }).collect();
    discrete::add(mesh, space, &mut out);
    out.constraints = constraints(mesh, place, said);
    out.sub_model_parts = mesh.groups.iter().map(|group| part(mesh, group, dimension)).collect();
    if lost > 0 {
        let note = Diagnostic::note("cells-left-out", format!("{lost} faces in no group are left out"));
        said.push(note.at(place.clone()));
    }
    out
}

fn part(mesh: &Mesh, group: &super::mesh::Group, dimension: usize) -> SubModelPart {
    let mut out = SubModelPart { name: group.name.clone(), ..SubModelPart::default() };
    let mut nodes = group.nodes.clone();
    for &cell in &group.cells {
        let cell = cell as usize;
        nodes.extend(mesh.cells.nodes(cell));
        match dimension - mesh.cells.shapes[cell].dim() {
            0 => out.elements.push(mesh.cells.ids[cell]),
            _ => out.conditions.push(mesh.cells.ids[cell]),
        }
    }
    nodes.sort_unstable();
    nodes.dedup();
    out.nodes = nodes.into_iter().map(|node| mesh.node_ids[node as usize]).collect();
    out
}

/// The mesh of a document: elements, conditions and geometries become cells, sub model parts groups, those of a part `Outer.Inner`
/// under `Outer_Inner`. Contents that a mesh does not hold (values, properties, names) are left out.
///
/// # Errors
/// Names of elements, conditions and geometries that are not known.
pub fn mesh(document: &MdpaDocument) -> Result<Mesh> {
    let mut out =
        Mesh { node_ids: document.nodes.ids.clone(), points: document.nodes.coordinates.clone(), ..Mesh::default() };
    let node: FxHashMap<u32, u32> = out.node_ids.iter().enumerate().map(|(at, &id)| (id, at as u32)).collect();
    let kinds = [
        (Some(EntityRole::Element), &document.elements),
        (Some(EntityRole::Condition), &document.conditions),
        (None, &document.geometries),
    ];
    let mut cells: [FxHashMap<u32, u32>; 3] = [const { None }; 3].map(|_: Option<()>| FxHashMap::default());
    let mut used = std::collections::BTreeSet::new();
    let mut next =
        kinds.iter().flat_map(|(_, blocks)| blocks.iter().flat_map(|block| &block.ids)).max().map_or(1, |id| id + 1);
    for (kind, (role, blocks)) in kinds.into_iter().enumerate() {
        for block in blocks {
            let known = match role {
                Some(role) => find_kind(role, &block.name).and_then(|kind| kind.cell),
                None => shape_of_geometry(&block.name).map(|(shape, _)| shape),
            };
            let shape: Shape = known.filter(|shape| shape.nodes() == block.nodes_per_entity).ok_or_else(|| {
                let fact = format!("{} has no shape that is known", block.name);
                Diagnostic::error("unknown-name", fact).at(Place::at(&document.file, block.line.0, 0))
            })?;
            for (at, &id) in block.ids.iter().enumerate() {
                let unique = if used.insert(id) { id } else { next };
                next += u32::from(unique == next);
                let cell = out.cells.push(unique, shape, block.nodes_of(at).iter().map(|id| node[id]));
                cells[kind].insert(id, cell);
            }
        }
    }
    for part in &document.sub_model_parts {
        add_groups(part, "", &node, &cells, &mut out);
    }
    Ok(out)
}

fn add_groups(
    part: &SubModelPart,
    outer: &str,
    node: &FxHashMap<u32, u32>,
    cells: &[FxHashMap<u32, u32>; 3],
    mesh: &mut Mesh,
) {
    let name = format!("{outer}{}", part.name);
    let lists = [&part.elements, &part.conditions, &part.geometries];
    let found = lists.into_iter().zip(cells).flat_map(|(ids, of)| ids.iter().filter_map(|id| of.get(id).copied()));
    let group = mesh.group_mut(&name);
    group.nodes.extend(part.nodes.iter().filter_map(|id| node.get(id).copied()));
    group.cells.extend(found);
    part.parts.iter().for_each(|inner| add_groups(inner, &format!("{name}_"), node, cells, mesh));
}
