//! Supports, loads and couplings of an input file, over the time of its steps.

use super::history::History;

/// Directions that turn with the position, or do not.
#[derive(Debug, Clone, PartialEq)]
pub enum Axes {
    /// Unit vectors along the axes 1, 2 and 3.
    Cartesian([[f64; 3]; 3]),
    /// Axis 1 radial, 2 tangential, 3 along the axis of a cylinder.
    Cylindrical {
        /// A point of the axis.
        origin: [f64; 3],
        /// Its direction.
        axis: [f64; 3],
    },
}

/// A prescribed quantity of nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Prescribed {
    /// Displacement (length).
    Displacement,
    /// Rotation of a reference node (radian).
    Rotation,
}

/// Displacements or rotations prescribed for a group of nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct Support {
    /// The group.
    pub group: String,
    /// The prescribed quantity.
    pub quantity: Prescribed,
    /// Value by direction; `None` where it is free.
    pub values: [Option<History>; 3],
    /// The directions; `None` for those of the space.
    pub axes: Option<Axes>,
    /// Time at which it begins, and ends where it does.
    pub interval: (f64, Option<f64>),
}

impl Support {
    /// Displacements prescribed at all times.
    pub fn of(group: String, values: [Option<History>; 3]) -> Self {
        Self { group, quantity: Prescribed::Displacement, values, axes: None, interval: (0.0, None) }
    }
}

/// A load on a group.
#[derive(Debug, Clone, PartialEq)]
pub struct Load {
    /// The group.
    pub group: String,
    /// Kind of the load.
    pub kind: LoadKind,
}

/// Kind of a load.
#[derive(Debug, Clone, PartialEq)]
pub enum LoadKind {
    /// The same force on each node.
    Force([History; 3]),
    /// Total force, spread over the area of the group.
    Total([History; 3]),
    /// The same moment on each node.
    Moment([History; 3]),
    /// Force per area against the outward normal of the faces.
    Pressure(History),
    /// Force per area on the faces.
    Traction([History; 3]),
    /// Acceleration of the bodies, as by gravity.
    Acceleration([History; 3]),
    /// Acceleration away from an axis, per distance.
    Centrifugal {
        /// Square of the angular velocity.
        square: History,
        /// A point of the axis.
        origin: [f64; 3],
        /// Its direction, of length 1.
        axis: [f64; 3],
    },
}

/// A linear relation between displacements of nodes: Σ factor · displacement = 0, whose first one follows the others.
#[derive(Debug, Clone, PartialEq)]
pub struct Equation {
    /// Index of the node, direction from 0, factor.
    pub terms: Vec<(u32, usize, f64)>,
}

/// A group of nodes coupled to a reference node.
#[derive(Debug, Clone, PartialEq)]
pub struct Coupling {
    /// The group of the coupled nodes.
    pub group: String,
    /// The part of the reference node.
    pub reference: String,
    /// Position of the reference node.
    pub point: [f64; 3],
    /// Whether the nodes move as a rigid body; otherwise the reference node takes their mean motion.
    pub is_rigid: bool,
    /// Displacement components that follow.
    pub components: [bool; 3],
    /// Mass of a rigid body at the reference node.
    pub mass: f64,
    /// Its inertia about the reference node.
    pub inertia: Option<[[f64; 3]; 3]>,
}

/// A spring or a mass at nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct Discrete {
    /// Indices of its nodes.
    pub nodes: Vec<u32>,
    /// Its kind.
    pub kind: DiscreteKind,
}

/// Kind of a spring or mass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DiscreteKind {
    /// Spring to the ground: stiffness by direction.
    Ground([f64; 3]),
    /// Spring between two nodes: stiffness by direction.
    Between([f64; 3]),
    /// Spring along the line between two nodes: stiffness.
    Axial(f64),
    /// Mass.
    Mass(f64),
}

/// A bolt that is tightened at a section.
#[derive(Debug, Clone, PartialEq)]
pub struct Bolt {
    /// The group with the elements of the bolt.
    pub group: String,
    /// The group with faces of the section.
    pub section: String,
    /// Tension; `None` where the shortening is given.
    pub force: Option<History>,
    /// Shortening.
    pub shortening: Option<History>,
    /// Last time at which force or shortening is prescribed; the length is locked after it.
    pub until: Option<f64>,
}

/// Axes of the material of a group of elements.
#[derive(Debug, Clone, PartialEq)]
pub struct MaterialAxes {
    /// The group.
    pub group: String,
    /// The axes.
    pub axes: Axes,
}

/// Prescribed temperatures of a group of nodes.
#[derive(Debug, Clone, PartialEq)]
pub struct Temperature {
    /// The group.
    pub group: String,
    /// Temperature over time.
    pub value: History,
}

/// Two sides of a sector that repeats around an axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Cyclic {
    /// The group of the side that leads.
    pub first: String,
    /// The group of the side that follows.
    pub second: String,
    /// A point of the axis.
    pub origin: [f64; 3],
    /// Its direction.
    pub axis: [f64; 3],
    /// Angle from the first side to the second, by the right-hand rule (degree).
    pub angle: f64,
}

/// Distance between two surfaces, whatever the mesh gives them.
#[derive(Debug, Clone, PartialEq)]
pub struct Clearance {
    /// The group of the slave side.
    pub slave: String,
    /// The group of the master side.
    pub master: String,
    /// Distance along the normal of the slave; negative: interference.
    pub value: f64,
}
