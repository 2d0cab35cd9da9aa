//! Contents of an mdpa file, without interpretation.

use std::path::PathBuf;

/// A line of the file, from 1. All lines compare equal: the position of an entry is not part of its contents.
#[derive(Debug, Clone, Copy, Default)]
pub struct Line(pub u32);

impl PartialEq for Line {
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// The content of an mdpa file, in its order.
///
/// Ids are those of the file: unique within nodes, elements, conditions, and so on, and not necessarily sorted.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MdpaDocument {
    /// The file it was read from; empty when made in memory.
    pub file: PathBuf,
    /// `ModelPartData`: variables of the model part as a whole.
    pub model_part_data: Vec<DataEntry>,
    /// `Table` blocks outside properties; each has an id.
    pub tables: Vec<MdpaTable>,
    /// `Properties` blocks, ids unique.
    pub properties: Vec<PropertiesBlock>,
    /// All `Nodes` blocks in one.
    pub nodes: MdpaNodes,
    /// `Elements` blocks.
    pub elements: Vec<MdpaEntities>,
    /// `Conditions` blocks.
    pub conditions: Vec<MdpaEntities>,
    /// `Geometries` blocks; their entities have no properties.
    pub geometries: Vec<MdpaEntities>,
    /// `Constraints` blocks.
    pub constraints: Vec<ConstraintBlock>,
    /// `NodalData` blocks.
    pub nodal_data: Vec<DataBlock>,
    /// `ElementalData` blocks.
    pub elemental_data: Vec<DataBlock>,
    /// `ConditionalData` blocks.
    pub conditional_data: Vec<DataBlock>,
    /// `SubModelPart` blocks, nested as in the file.
    pub sub_model_parts: Vec<SubModelPart>,
}

/// Nodes as columns; row i is node `ids[i]`.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MdpaNodes {
    /// Ids in file order.
    pub ids: Vec<u32>,
    /// Initial x, y, z.
    pub coordinates: Vec<[f64; 3]>,
}

/// A variable and its value, as in `YOUNG_MODULUS 2.1e11`.
#[derive(Debug, Clone, PartialEq)]
pub struct DataEntry {
    /// Name of the variable.
    pub name: String,
    /// Its value.
    pub value: DataValue,
    /// Where the name stands.
    pub line: Line,
}

/// The value of a variable, by its spelling.
#[derive(Debug, Clone, PartialEq)]
pub enum DataValue {
    /// A word that is a number as a whole; integers and booleans 0/1 too.
    Number(f64),
    /// `[3] (a,b,c)`.
    Vector(Vec<f64>),
    /// `[2,2] ((a,b),(c,d))`.
    Matrix {
        /// Number of rows.
        rows: usize,
        /// Number of columns.
        columns: usize,
        /// Row by row.
        values: Vec<f64>,
    },
    /// Any other word.
    Text(String),
}

/// A function given by points.
#[derive(Debug, Clone, PartialEq)]
pub struct MdpaTable {
    /// Its id; `None` inside properties, where the two variables name it.
    pub id: Option<u32>,
    /// Variable of the argument.
    pub input_variable: String,
    /// Variable of the value.
    pub output_variable: String,
    /// Argument and value, in file order.
    pub rows: Vec<[f64; 2]>,
    /// Where the block begins.
    pub line: Line,
}

/// A material, or an empty set of properties waiting for one.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct PropertiesBlock {
    /// Its id.
    pub id: u32,
    /// Values in file order; a law is the text value of `CONSTITUTIVE_LAW`.
    pub values: Vec<DataEntry>,
    /// Tables of the material.
    pub tables: Vec<MdpaTable>,
    /// Where the block begins.
    pub line: Line,
}

/// Elements, conditions or geometries of one kind as columns.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct MdpaEntities {
    /// Registered name, as `SmallDisplacementElement2D4N`.
    pub name: String,
    /// Number of nodes of each entity, at least 1.
    pub nodes_per_entity: usize,
    /// Ids in file order.
    pub ids: Vec<u32>,
    /// Properties id of each entity; empty for geometries.
    pub properties: Vec<u32>,
    /// Node ids, `nodes_per_entity` an entity.
    pub nodes: Vec<u32>,
    /// Where the block begins.
    pub line: Line,
}

impl MdpaEntities {
    /// Node ids of entity number `i` of the block.
    pub fn nodes_of(&self, i: usize) -> &[u32] {
        &self.nodes[i * self.nodes_per_entity..(i + 1) * self.nodes_per_entity]
    }
}

/// Linear relations between unknowns, of one kind.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ConstraintBlock {
    /// Registered name, as `LinearMasterSlaveConstraint`.
    pub name: String,
    /// Variables of the heading: the slave's, then the masters' where given.
    pub variables: Vec<String>,
    /// One constraint a row.
    pub rows: Vec<Constraint>,
    /// Where the block begins.
    pub line: Line,
}

/// One relation: slave = Σ weight · master + constant.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Constraint {
    /// Its id.
    pub id: u32,
    /// The constant term.
    pub constant: f64,
    /// One weight a master.
    pub weights: Vec<f64>,
    /// Node of the unknown that follows.
    pub slave: u32,
    /// Nodes of the unknowns it follows.
    pub masters: Vec<u32>,
}

/// Values of one variable at some entities; row i belongs to `ids[i]`.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct DataBlock {
    /// Name of the variable, component or flag.
    pub variable: String,
    /// Ids in file order.
    pub ids: Vec<u32>,
    /// The values.
    pub values: DataColumn,
    /// Where the block begins.
    pub line: Line,
}

/// A column of values of one type.
#[derive(Debug, Clone, Default, PartialEq)]
pub enum DataColumn {
    /// A flag, set on every listed entity.
    #[default]
    Flag,
    /// One number an entity.
    Scalar {
        /// The values.
        values: Vec<f64>,
        /// Whether the unknown is fixed; empty where the block has no fixity (elements and conditions).
        fixed: Vec<bool>,
    },
    /// `size` numbers an entity, flat.
    Vector {
        /// Numbers an entity.
        size: usize,
        /// Entity by entity.
        values: Vec<f64>,
    },
    /// `rows` × `columns` numbers an entity, flat.
    Matrix {
        /// Rows of each matrix.
        rows: usize,
        /// Columns of each matrix.
        columns: usize,
        /// Entity by entity, each row by row.
        values: Vec<f64>,
    },
}

/// A named subset of the model part, with its own subsets.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct SubModelPart {
    /// Name, unique among its siblings.
    pub name: String,
    /// `SubModelPartData`.
    pub data: Vec<DataEntry>,
    /// `SubModelPartTables`.
    pub tables: Vec<u32>,
    /// `SubModelPartProperties`.
    pub properties: Vec<u32>,
    /// `SubModelPartNodes`.
    pub nodes: Vec<u32>,
    /// `SubModelPartElements`.
    pub elements: Vec<u32>,
    /// `SubModelPartConditions`.
    pub conditions: Vec<u32>,
    /// `SubModelPartGeometries`.
    pub geometries: Vec<u32>,
    /// `SubModelPartConstraints`.
    pub constraints: Vec<u32>,
    /// Nested parts.
    pub parts: Vec<SubModelPart>,
    /// Where the block begins.
    pub line: Line,
}
