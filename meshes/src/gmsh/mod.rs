//! The format of Gmsh, 2.2 and 4.1, as text and binary.
//!
//! Physical groups become sub model parts, by their names; without any, the entities of the geometry do. Source: Gmsh's reference
//! manual, "Gmsh file formats".

mod gmsh_cells;
mod entities;
mod gmsh_writer;

use std::path::Path;

use rustc_hash::FxHashMap;
use zelus_core::diagnostics::{Diagnostic, Error, Result};
use zelus_core::io::MeshFormatEntry;
use zelus_core::io::mdpa::MdpaDocument;
use zelus_core::parameters::Settings;
use zelus_core::register;

use super::document::finish;
use super::mesh::{Mesh, word};
use super::source::{Source, read};
use entities::Entities;

/// Words for entities by dimension.
const KINDS: [&str; 4] = ["Point", "Curve", "Surface", "Volume"];

/// Reads a file of Gmsh.
///
/// # Errors
/// A file that is damaged, of another version, partitioned, or with cells that no element has.
pub(crate) fn read_mesh(path: &Path) -> Result<Mesh> {
    let bytes = read(path)?;
    let mut reader = Reader {
        source: Source::new(path, &bytes),
        is_old: false,
        mesh: Mesh::default(),
        nodes: FxHashMap::default(),
        names: FxHashMap::default(),
        entities: Entities::default(),
        elementary: Vec::new(),
        physical: Vec::new(),
    };
    while let Some(line) = reader.source.line() {
        reader.section(line)?;
    }
    Ok(reader.grouped())
}

struct Reader<'a> {
    source: Source<'a>,
    /// Version 2.2.
    is_old: bool,
    mesh: Mesh,
    nodes: FxHashMap<usize, u32>,
    /// Names of physical groups by dimension and number.
    names: FxHashMap<(usize, i64), String>,
    entities: Entities,
    /// Dimension and number of the entity of each cell.
    elementary: Vec<(usize, i64)>,
    /// Dimension and number of a physical group, and a cell in it.
    physical: Vec<((usize, i64), u32)>,
}

impl Reader<'_> {
    fn section(&mut self, line: &str) -> Result<()> {
        let Some(name) = line.strip_prefix('$') else {
            let is_empty = line.is_empty();
            return if is_empty {
                Ok(())
            } else {
                Err(self.source.wrong(format!("{line:?} stands outside of sections")))
            };
        };
        match name {
            "MeshFormat" => self.format()?,
            "PhysicalNames" => self.physical_names()?,
            "Entities" => self.entities = Entities::read(&mut self.source)?,
            "Nodes" if self.is_old => self.old_nodes()?,
            "Nodes" => self.nodes()?,
            "Elements" if self.is_old => self.old_elements()?,
            "Elements" => self.elements()?,
            "PartitionedEntities" => {
                let problem = self.source.wrong("the mesh is partitioned");
                return Err(with_remedy(problem, "save it whole; zelus cuts meshes itself"));
            }
            _ => {}
        }
        self.source.skip_behind(&format!("$End{name}"))
    }

    fn format(&mut self) -> Result<()> {
        let header = self.source.line().unwrap_or_default();
        let words: Vec<&str> = header.split_whitespace().collect();
        self.is_old = match words.first() {
            Some(&("2.2" | "2.1" | "2")) => true,
            Some(&"4.1") => false,
            other => {
                let problem = self.source.wrong(format!("the format is {}", other.copied().unwrap_or("unknown")));
                return Err(with_remedy(problem, "save it as version 4.1 or 2.2, e.g. by `gmsh -format msh41`"));
            }
        };
        if words.get(1) == Some(&"1") {
            self.source.is_binary = true;
            if self.source.int()? != 1 {
                return Err(self.source.wrong("its numbers have the bytes of another kind of machine"));
            }
        }
        Ok(())
    }

    fn count_of_text(&mut self) -> Result<usize> {
        let line = self.source.line().unwrap_or_default();
        line.parse().map_err(|_| self.source.wrong(format!("{line:?} is no number of things")))
    }

    fn physical_names(&mut self) -> Result<()> {
        for _ in 0..self.count_of_text()? {
            let line = self.source.line().unwrap_or_default();
            let mut words = line.splitn(3, char::is_whitespace);
            let (dimension, number) =
                (words.next().and_then(|w| w.parse().ok()), words.next().and_then(|w| w.parse().ok()));
            let (Some(dimension), Some(number), Some(name)) = (dimension, number, words.next()) else {
                return Err(self.source.wrong(format!("{line:?} is no dimension, number and name")));
            };
            self.names.insert((dimension, number), word(name));
        }
        Ok(())
    }

    fn node(&mut self, tag: usize, point: [f64; 3]) -> Result<()> {
        let at = self.mesh.points.len() as u32;
        let id = u32::try_from(tag).map_err(|_| self.source.wrong(format!("the number of node {tag} is too large")))?;
        if self.nodes.insert(tag, at).is_some() {
            return Err(self.source.wrong(format!("node {tag} stands there twice")));
        }
        self.mesh.node_ids.push(id);
        self.mesh.points.push(point);
        Ok(())
    }

    fn old_nodes(&mut self) -> Result<()> {
        for _ in 0..self.count_of_text()? {
            let tag = self.source.int()?;
            let point = [self.source.real()?, self.source.real()?, self.source.real()?];
            self.node(tag as usize, point)?;
        }
        Ok(())
    }

    fn nodes(&mut self) -> Result<()> {
        let blocks = self.source.size()?;
        for _ in 0..3 {
            self.source.size()?;
        }
        for _ in 0..blocks {
            let dimension = self.source.int()?;
            self.source.int()?;
            let parameters = if self.source.int()? == 0 { 0 } else { dimension };
            let count = self.source.size()?;
            let tags = (0..self.source.held(count)?).map(|_| self.source.size()).collect::<Result<Vec<_>>>()?;
            for tag in tags {
                let point = [self.source.real()?, self.source.real()?, self.source.real()?];
                (0..parameters).try_for_each(|_| self.source.real().map(drop))?;
                self.node(tag, point)?;
            }
        }
        Ok(())
    }

    fn cell(&mut self, tag: usize, kind: i64, entity: (usize, i64), nodes: &[usize]) -> Result<u32> {
        let (shape, order) = gmsh_cells::of(kind).expect("its number of nodes was known");
        let found = order.iter().map(|&place| self.nodes.get(&nodes[place]).copied()).collect::<Option<Vec<u32>>>();
        let found = found.ok_or_else(|| self.source.wrong(format!("element {tag} has a node that is not there")))?;
        let id =
            u32::try_from(tag).map_err(|_| self.source.wrong(format!("the number of element {tag} is too large")))?;
        self.elementary.push(entity);
        Ok(self.mesh.cells.push(id, shape, found))
    }

    fn nodes_of(&self, kind: i64) -> Result<usize> {
        gmsh_cells::of(kind).map(|(shape, _)| shape.nodes()).ok_or_else(|| {
            let problem =
                self.source.wrong(format!("cells of Gmsh's type {kind}{} are not known", gmsh_cells::name(kind)));
            with_remedy(
                problem,
                "mesh with lines, triangles, quadrilaterals, tetrahedra, pyramids, prisms or hexahedra of order 1 or 2; pyramids of order 2 \
                 need Mesh.SecondOrderIncomplete = 1",
            )
        })
    }

    fn old_elements(&mut self) -> Result<()> {
        let mut left = self.count_of_text()?;
        while left > 0 {
            // as text, every element is a block of one, whose number stands first
            let (kind, count, tags, first) = if self.source.is_binary {
                (self.source.int()?, self.source.int()?, self.source.int()?, None)
            } else {
                let tag = self.source.int()?;
                (self.source.int()?, 1, self.source.int()?, Some(tag))
            };
            let size = self.nodes_of(kind)?;
            for _ in 0..count {
                let tag = first.map_or_else(|| self.source.int(), Ok)?;
                let tags = (0..tags).map(|_| self.source.int()).collect::<Result<Vec<_>>>()?;
                let nodes = (0..size).map(|_| self.source.int().map(|tag| tag as usize)).collect::<Result<Vec<_>>>()?;
                let dimension = gmsh_cells::of(kind).map_or(0, |(shape, _)| shape.dim());
                let entity = (dimension, tags.get(1).copied().unwrap_or(0));
                let cell = self.cell(tag as usize, kind, entity, &nodes)?;
                if let Some(&group) = tags.first().filter(|&&group| group != 0) {
                    self.physical.push(((dimension, group.abs()), cell));
                }
            }
            left = left.checked_sub(count as usize).ok_or_else(|| self.source.wrong("more elements than announced"))?;
        }
        Ok(())
    }

    fn elements(&mut self) -> Result<()> {
        let blocks = self.source.size()?;
        for _ in 0..3 {
            self.source.size()?;
        }
        for _ in 0..blocks {
            let (dimension, number) = (self.source.int()? as usize, self.source.int()?);
            let kind = self.source.int()?;
            let size = self.nodes_of(kind)?;
            let groups = self.entities.groups(dimension, number).to_vec();
            for _ in 0..self.source.size()? {
                let tag = self.source.size()?;
                let nodes = (0..size).map(|_| self.source.size()).collect::<Result<Vec<_>>>()?;
                let cell = self.cell(tag, kind, (dimension, number), &nodes)?;
                self.physical.extend(groups.iter().map(|&group| ((dimension, group), cell)));
            }
        }
        Ok(())
    }

    /// The mesh with its groups: physical ones, or those of the geometry where there are none.
    fn grouped(mut self) -> Mesh {
        if self.physical.is_empty() {
            for (cell, (dimension, number)) in self.elementary.iter().enumerate() {
                let name = format!("{}_{number}", KINDS[(*dimension).min(3)]);
                self.mesh.group_mut(&name).cells.push(cell as u32);
            }
        }
        for (group, cell) in self.physical {
            let name =
                self.names.entry(group).or_insert_with(|| format!("Physical{}_{}", KINDS[group.0.min(3)], group.1));
            self.mesh.group_mut(name).cells.push(cell);
        }
        self.mesh
    }
}

fn with_remedy(error: Error, remedy: &str) -> Error {
    match error {
        Error::Input(problems) => Error::Input(problems.into_iter().map(|problem| problem.remedy(remedy)).collect()),
        other => other,
    }
}

fn build(path: &Path, settings: &Settings) -> Result<(MdpaDocument, Vec<Diagnostic>)> {
    finish(read_mesh(path)?, settings, path)
}

register! { MeshFormatEntry "gmsh",
    aliases: &["msh"],
    about: "meshes of Gmsh, 2.2 and 4.1, text and binary; physical groups become sub model parts",
    source: "Gmsh reference manual, Gmsh file formats",
    defaults: include_str!(concat!(env!("CARGO_MANIFEST_DIR"), "/../configs/mesh_formats/gmsh.json")),
    build: build,
    endings: &["msh"],
    write: Some(gmsh_writer::write),
}
