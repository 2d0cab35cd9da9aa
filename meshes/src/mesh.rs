//! A mesh file of another program, in a neutral form.

use zelus_core::geometry::Shape;

use super::conditions::{
    Bolt, Clearance, Coupling, Cyclic, Discrete, Equation, Load, MaterialAxes, Support, Temperature,
};

/// Nodes, cells, named groups of both, and further contents of an input file of a solver.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Mesh {
    /// Id of each node, unique.
    pub node_ids: Vec<u32>,
    /// Positions of the nodes.
    pub points: Vec<[f64; 3]>,
    /// Cells of all dimensions.
    pub cells: Cells,
    /// Named groups, names unique.
    pub groups: Vec<Group>,
    /// Surfaces that the file ties or lets touch.
    pub pairs: Vec<Pair>,
    /// Materials by name.
    pub materials: Vec<Material>,
    /// Material of each group.
    pub sections: Vec<Section>,
    /// Degrees of freedom that the file holds.
    pub supports: Vec<Support>,
    /// Forces on nodes and pressures on faces.
    pub loads: Vec<Load>,
    /// Linear relations between displacements.
    pub equations: Vec<Equation>,
    /// Springs and masses at nodes.
    pub discrete: Vec<Discrete>,
    /// Nodes coupled to reference nodes.
    pub couplings: Vec<Coupling>,
    /// Bolts.
    pub bolts: Vec<Bolt>,
    /// Sides of sectors that repeat around an axis.
    pub sectors: Vec<Cyclic>,
    /// Distances of surfaces by number.
    pub clearances: Vec<Clearance>,
    /// Axes of materials.
    pub material_axes: Vec<MaterialAxes>,
    /// Temperatures that expand bodies.
    pub temperatures: Vec<Temperature>,
    /// Steps of the analysis, one after the other; none where the file has none.
    pub steps: Vec<Step>,
    /// Whether displacements are large.
    pub is_large: bool,
    /// Assumption of a planar mesh (plane stress, plane strain, …), where the file names it.
    pub plane: Option<Plane>,
}

/// Cells in flat arrays.
#[derive(Debug, Clone, PartialEq)]
pub struct Cells {
    /// Id of each cell, unique.
    pub ids: Vec<u32>,
    /// Shape of each cell.
    pub shapes: Vec<Shape>,
    starts: Vec<u32>,
    nodes: Vec<u32>,
}

impl Default for Cells {
    fn default() -> Self {
        Self { ids: Vec::new(), shapes: Vec::new(), starts: vec![0], nodes: Vec::new() }
    }
}

impl Cells {
    /// Adds a cell with its nodes, which are indices in the order of the shape; gives the index of the cell.
    pub fn push(&mut self, id: u32, shape: Shape, nodes: impl IntoIterator<Item = u32>) -> u32 {
        self.ids.push(id);
        self.shapes.push(shape);
        self.nodes.extend(nodes);
        self.starts.push(self.nodes.len() as u32);
        self.ids.len() as u32 - 1
    }

    /// Number of cells.
    pub fn len(&self) -> usize {
        self.ids.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.ids.is_empty()
    }

    /// Node indices of a cell.
    pub fn nodes(&self, cell: usize) -> &[u32] {
        &self.nodes[self.starts[cell] as usize..self.starts[cell + 1] as usize]
    }

    /// Node indices of a cell, to change.
    pub fn nodes_mut(&mut self, cell: usize) -> &mut [u32] {
        &mut self.nodes[self.starts[cell] as usize..self.starts[cell + 1] as usize]
    }

    /// The largest id, 0 where there are no cells.
    pub fn max_id(&self) -> u32 {
        self.ids.iter().copied().max().unwrap_or(0)
    }
}

/// A named set; its nodes are those listed and those of its cells.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Group {
    /// Its name, a word without dots.
    pub name: String,
    /// Indices of nodes.
    pub nodes: Vec<u32>,
    /// Indices of cells.
    pub cells: Vec<u32>,
}

/// Two surfaces that act on each other.
#[derive(Debug, Clone, PartialEq)]
pub struct Pair {
    /// Whether they are tied; they may touch otherwise.
    pub tied: bool,
    /// The group that carries the multipliers.
    pub slave: String,
    /// The other group; that of the slave where a surface touches itself.
    pub master: String,
    /// Coulomb's coefficient.
    pub friction: f64,
    /// Whether slave nodes are moved onto the master at the start, without strain.
    pub adjusted: bool,
    /// Whether surfaces that are in contact stay so, free to slide.
    pub stays: bool,
    /// Overclosure and pressure of soft contact, growing from row to row; none of hard contact. All pairs that touch have the same.
    pub soft: Vec<[f64; 2]>,
}

impl Pair {
    /// Surfaces that touch without friction.
    pub fn of(slave: String, master: String) -> Self {
        Self { tied: false, slave, master, friction: 0.0, adjusted: false, stays: false, soft: Vec::new() }
    }
}

/// A step of the analysis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Step {
    /// Time at its start.
    pub start: f64,
    /// Time at its end.
    pub end: f64,
    /// Length of the increments, where the file fixes it.
    pub increment: Option<f64>,
}

/// A material: elastic, and what its file adds.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Material {
    /// Its name.
    pub name: String,
    /// Young's modulus; `None` where the file gives no elasticity.
    pub young: Option<f64>,
    /// Poisson's ratio.
    pub poisson: f64,
    /// Mass per volume; 0 where none is given.
    pub density: f64,
    /// Temperature, Young's modulus and Poisson's ratio, where they depend on it.
    pub elastic_table: Vec<[f64; 3]>,
    /// E₁, E₂, E₃, ν₁₂, ν₁₃, ν₂₃, G₁₂, G₁₃, G₂₃ of an orthotropic material.
    pub orthotropic: Option<[f64; 9]>,
    /// Energy of a hyperelastic material.
    pub rubber: Option<Rubber>,
    /// Yield stress over plastic strain, from strain 0; none: elastic.
    pub yield_curve: Vec<[f64; 2]>,
    /// Expansion by heat.
    pub expansion: Option<Expansion>,
}

/// Energy of a hyperelastic material.
#[derive(Debug, Clone, PartialEq)]
pub struct Rubber {
    /// Beginning of the name of its law.
    pub law: &'static str,
    /// Names and values of its constants.
    pub constants: Vec<(&'static str, Vec<f64>)>,
    /// Shear modulus without strain.
    pub shear_modulus: f64,
    /// Bulk modulus; `None` of a material that keeps its volume.
    pub bulk_modulus: Option<f64>,
}

/// Expansion of a material by heat.
#[derive(Debug, Clone, PartialEq)]
pub struct Expansion {
    /// Temperature and secant coefficient.
    pub table: Vec<[f64; 2]>,
    /// Temperature without strain.
    pub reference: f64,
}

/// The material of a group of cells.
#[derive(Debug, Clone, PartialEq)]
pub struct Section {
    /// The group.
    pub group: String,
    /// The name of the material.
    pub material: String,
    /// Thickness of plane elements.
    pub thickness: f64,
}

/// Assumption of a planar mesh.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Plane {
    /// A thin plate, free to change its thickness.
    Stress,
    /// A slice of a long body.
    Strain,
    /// A body of revolution about the y axis.
    Axial,
}

impl Mesh {
    /// Dimension of its elements: that of the cells with most dimensions.
    pub fn dimension(&self) -> usize {
        self.cells.shapes.iter().map(|shape| shape.dim()).max().unwrap_or(0)
    }

    /// Positions of the nodes of a cell.
    pub fn points_of(&self, cell: usize) -> Vec<[f64; 3]> {
        self.cells.nodes(cell).iter().map(|&node| self.points[node as usize]).collect()
    }

    /// The group of that name, made where it is not there.
    pub fn group_mut(&mut self, name: &str) -> &mut Group {
        let at = self.groups.iter().position(|group| group.name == name).unwrap_or_else(|| {
            self.groups.push(Group { name: name.to_owned(), ..Group::default() });
            self.groups.len() - 1
        });
        &mut self.groups[at]
    }

    /// The group of that name.
    pub fn group(&self, name: &str) -> Option<&Group> {
        self.groups.iter().find(|group| group.name == name)
    }
}

/// A name as a deck can use it: separators of words and parts become an underscore, and one follows the words `Begin` and `End`, which
/// open and close the blocks of a mesh file.
pub fn word(name: &str) -> String {
    let name = name.trim().trim_matches('"');
    let keeps = |c: char| c.is_alphanumeric() || matches!(c, '_' | '-' | '+');
    let own: String = name.chars().map(|c| if keeps(c) { c } else { '_' }).collect();
    if matches!(own.as_str(), "Begin" | "End") { own + "_" } else { own }
}
