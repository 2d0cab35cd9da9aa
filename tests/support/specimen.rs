//! One entity of a registered kind on a distorted cell, with its block, ready to be asked for its local system.

use std::collections::BTreeMap;

use zelus::structural_mechanics::variables::{DISPLACEMENT, LOCAL_AXIS_1, LOCAL_AXIS_2, TEMPERATURE};
use zelus_core::entities::{BlockRequest, EntityBlock, LocalSystems, Request, Tangent, block_factory};
use zelus_core::geometry::Shape;
use zelus_core::model::{
    EntityKind, EntityRole, ModelPart, Nodes, Properties, PropertyValue, ScalarVariable, VariableKind, variables,
};

pub type Vec3 = [f64; 3];

/// Reproducible numbers in [−1, 1].
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub fn vector(&mut self, size: f64, space: usize) -> Vec3 {
        std::array::from_fn(|a| if a < space { size * self.next() } else { 0.0 })
    }
}

/// The largest absolute value.
pub fn size(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, |largest, value| largest.max(value.abs()))
}

/// The largest difference.
pub fn difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    size(a.iter().zip(b).map(|(a, b)| a - b))
}

/// A cell of a shape, distorted by `amount`, at positive x and y so that it may turn about either axis.
pub fn cell(shape: Shape, space: usize, amount: f64, random: &mut Random) -> Vec<Vec3> {
    let place = |p: &Vec3| {
        let x = [4.0 + p[0] + 0.3 * p[1] + 0.1 * p[2], 0.1 * p[0] + 0.8 * p[1] + 2.0, 0.1 * p[0] + 0.7 * p[2]];
        let noise = random.vector(amount, space);
        std::array::from_fn(|a| if a < space { x[a] + noise[a] } else { 0.0 })
    };
    shape.cell().points.iter().map(place).collect()
}

/// Properties of every specimen. Bodies have the temperature at which laws that expand are without strain. Yielding begins far below
/// the strains of the tests: differences taken across its beginning are no derivatives.
const USUAL: [(&str, f64); 29] = [
    ("REFERENCE_TEMPERATURE", 0.0),
    ("CONDUCTIVITY", 0.7),
    ("SPECIFIC_HEAT", 2.0),
    ("YOUNG_MODULUS", 100.0),
    ("POISSON_RATIO", 0.3),
    ("THICKNESS", 0.5),
    ("DENSITY", 3.0),
    ("YIELD_STRESS", 0.01),
    ("ISOTROPIC_HARDENING_MODULUS", 10.0),
    ("HARDENING_MODULUS_1D", 10.0),
    ("NORTON_COEFFICIENT", 0.01),
    ("NORTON_EXPONENT", 3.0),
    ("BULK_MODULUS", 80.0),
    ("SHEAR_MODULUS", 30.0),
    ("C10", 12.0),
    ("C01", 3.0),
    ("C20", -1.0),
    ("C30", 0.4),
    ("GENT_LIMIT", 10.0),
    ("LOCKING_STRETCH", 2.5),
    ("YOUNG_MODULUS_X", 120.0),
    ("YOUNG_MODULUS_Y", 80.0),
    ("YOUNG_MODULUS_Z", 60.0),
    ("POISSON_RATIO_XY", 0.3),
    ("POISSON_RATIO_YZ", 0.2),
    ("POISSON_RATIO_XZ", 0.25),
    ("SHEAR_MODULUS_XY", 40.0),
    ("SHEAR_MODULUS_YZ", 20.0),
    ("SHEAR_MODULUS_XZ", 30.0),
];

/// Which loads a specimen carries.
#[derive(Clone, Copy, PartialEq)]
pub enum Loads {
    /// Every scalar variable, at the entity and its nodes: pressures, which follow the surface.
    Scalars,
    /// Every vector variable: forces, which keep their direction.
    Vectors,
}

/// One entity with its block.
pub struct Specimen {
    pub part: ModelPart,
    pub block: Box<dyn EntityBlock>,
    entry: &'static EntityKind,
}

impl Specimen {
    /// One entity on nodes at `x`, connected in the order `nodes`; why it cannot be made with this law otherwise.
    ///
    /// Properties that the kind asks for and that are not among the usual ones get the value 1.
    pub fn new(
        entry: &'static EntityKind,
        law: Option<&str>,
        x: &[Vec3],
        nodes: &[u32],
        loads: Loads,
    ) -> Result<Self, String> {
        let mut values: BTreeMap<String, f64> = BTreeMap::new();
        for (name, value) in USUAL {
            values.insert(name.to_owned(), value);
        }
        // A specimen that has lost nearly all stiffness has no digits left to compare.
        if law.is_some_and(|law| law.contains("Damage")) {
            values.insert("YIELD_STRESS".to_owned(), 0.3);
        }
        loop {
            match Self::with_properties(entry, law, x, nodes, loads, &values) {
                Ok(specimen) => return Ok(specimen),
                Err(problem) => {
                    let lacks = problem.split_once("have no ").and_then(|(_, rest)| rest.split_whitespace().next());
                    match lacks.filter(|name| !values.contains_key(*name)) {
                        Some(name) => values.insert(name.to_owned(), 1.0),
                        None => return Err(problem),
                    };
                }
            }
        }
    }

    fn with_properties(
        entry: &'static EntityKind,
        law: Option<&str>,
        x: &[Vec3],
        nodes: &[u32],
        loads: Loads,
        values: &BTreeMap<String, f64>,
    ) -> Result<Self, String> {
        let mut part = ModelPart::new("walk");
        part.info.domain_size = entry.space;
        part.info.delta_time = 0.1;
        part.nodes = Nodes::new((1..=x.len()).collect(), x.to_vec());
        part.nodes.history.set_levels(2);
        part.nodes.history.add(&DISPLACEMENT);
        part.nodes.history.add(&TEMPERATURE);
        let mut properties = Properties::new(1);
        properties.law = law.map(str::to_owned);
        let numbers = values.iter().map(|(name, value)| (name.clone(), PropertyValue::Number(*value)));
        properties.values.extend(numbers);
        // Armstrong–Frederick's, whose tangent is not symmetric
        let hardening = PropertyValue::Vector(vec![20.0, 30.0]);
        properties.values.insert("KINEMATIC_PLASTICITY_PARAMETERS".to_owned(), hardening);
        let lists: [(&str, &[f64]); 4] = [
            ("OGDEN_MODULI", &[40.0, 0.5, -3.0]),
            ("OGDEN_EXPONENTS", &[1.3, 5.0, -2.0]),
            ("PRONY_SHARES", &[0.3, 0.2]),
            ("PRONY_TIMES", &[0.05, 2.0]),
        ];
        // laws of rubber relax where they have a series: here they are elastic
        let relaxes = law.is_some_and(|law| law.contains("Visco"));
        for (name, list) in lists.into_iter().filter(|(name, _)| relaxes || !name.starts_with("PRONY")) {
            properties.values.insert(name.to_owned(), PropertyValue::Vector(list.to_vec()));
        }
        part.properties.insert(1, properties);
        let table = if entry.role == EntityRole::Element { &mut part.elements } else { &mut part.conditions };
        table.push(1, entry, 1, nodes);
        table.finish();
        load(&mut part, entry, loads);
        let make = block_factory(entry).expect("only kinds with a block are walked");
        let table = if entry.role == EntityRole::Element { &part.elements } else { &part.conditions };
        let request =
            BlockRequest { entry, members: vec![0], table, nodes: &part.nodes, part: &part, on_initial: false };
        let mut block = make(&request).map_err(|problem| problem.to_string())?;
        block.initialize(&part.view()).map_err(|problem| problem.to_string())?;
        let mut specimen = Self { part, block, entry };
        for unknown in specimen.block.unknowns().to_vec() {
            let components = if unknown.variable.component.is_some() { 3 } else { 1 };
            specimen.part.nodes.history.add_named(unknown.variable.column, components);
        }
        Ok(specimen)
    }

    /// Whether the nodes move with their displacements; linear theory stays on the initial geometry.
    /// (The small-displacement solid of revolution holds the present radius fixed in its tangent.)
    fn moves(&self) -> bool {
        self.block.tangent() != Tangent::Constant && !is_linear(self.entry)
    }

    /// The unknowns: node index and variable, in the order of the rows.
    pub fn rows(&self) -> Vec<(u32, ScalarVariable)> {
        let nodes = self.block.nodes(0);
        self.block.unknowns().iter().map(|u| (nodes[u.node as usize], u.variable)).collect()
    }

    /// Sets the unknowns, and moves the mesh where forces follow it.
    pub fn set(&mut self, values: &[f64]) {
        for ((node, variable), value) in self.rows().into_iter().zip(values) {
            let field = self.part.nodes.history.get_mut(variable.column).expect("a column for each unknown");
            field.levels[0][node as usize * field.components + variable.offset()] = *value;
        }
        if self.moves() {
            self.part.nodes.move_all();
        }
    }

    /// Tangent and right-hand side.
    pub fn system(&self) -> (Vec<f64>, Vec<f64>) {
        let out = self.local(Request::Both);
        (out.lhs, out.rhs)
    }

    /// The right-hand side alone.
    pub fn residual(&self) -> Vec<f64> {
        self.local(Request::Residual).rhs
    }

    fn local(&self, request: Request) -> LocalSystems {
        let mut out = LocalSystems::default();
        out.reset(1, self.block.unknowns().len(), request);
        let result = self.block.local_systems(&self.part.view(), 0..1, request, &mut out);
        result.unwrap_or_else(|problem| panic!("{}: {}", self.entry.name, problem.fact));
        out
    }

    /// −∂residual/∂unknowns at `values` by central differences of fourth order, row by row.
    pub fn difference_tangent(&mut self, values: &[f64], step: f64) -> Vec<f64> {
        let n = values.len();
        let mut out = vec![0.0; n * n];
        for column in 0..n {
            let mut at = |h: f64| {
                let mut moved = values.to_vec();
                moved[column] += h;
                self.set(&moved);
                self.residual()
            };
            let (a, b, c, d) = (at(-2.0 * step), at(-step), at(step), at(2.0 * step));
            for row in 0..n {
                out[row * n + column] = -(a[row] - 8.0 * b[row] + 8.0 * c[row] - d[row]) / (12.0 * step);
            }
        }
        self.set(values);
        out
    }
}

/// Whether strains are those of linear theory, by the name that says so.
pub fn is_linear(entry: &EntityKind) -> bool {
    ["SmallDisplacement", "TrussLinear", "LinearTruss", "LinearAxialSpring"]
        .iter()
        .any(|word| entry.name.contains(word))
}

/// Whether the plane turns about the y axis.
pub fn is_axisymmetric(entry: &EntityKind) -> bool {
    entry.name.contains("Axisym")
}

/// Axes of the material: perpendicular, and none along an axis of the space.
fn axes(space: usize) -> [(&'static str, Vec3); 2] {
    let first = if space == 3 { [0.6, 0.64, 0.48] } else { [0.6, 0.8, 0.0] };
    [(LOCAL_AXIS_1.name(), first), (LOCAL_AXIS_2.name(), [-0.8, 0.48, 0.36])]
}

/// Gives the entity and its nodes a value of every variable of the wanted sort, and the entity its axes.
fn load(part: &mut ModelPart, entry: &EntityKind, loads: Loads) {
    let wanted = if loads == Loads::Scalars { VariableKind::Scalar } else { VariableKind::Vector3 };
    let mut random = Random(5);
    let data = if entry.role == EntityRole::Element { &mut part.elements.data } else { &mut part.conditions.data };
    // constants that resist rotations are refused
    let bare = [DISPLACEMENT.name(), TEMPERATURE.name()];
    let axes = axes(entry.space);
    let own = |name: &str| axes.iter().any(|(axis, _)| *axis == name);
    let taken =
        |name: &str| bare.contains(&name) || own(name) || name.contains("ROTATIONAL") || name == "NODAL_INERTIA";
    for (name, axis) in axes {
        data.add_named(name, 3);
        data.get_mut(name).expect("added above").levels[0].copy_from_slice(&axis);
    }
    for variable in variables().values().filter(|v| v.kind == wanted && !taken(v.name)) {
        let components = if loads == Loads::Scalars { 1 } else { 3 };
        for fields in [&mut *data, &mut part.nodes.history] {
            fields.add_named(variable.name, components);
            let level = &mut fields.get_mut(variable.name).expect("added above").levels[0];
            level.chunks_mut(components).for_each(|value| {
                // Scalars may be masses, which are not negative.
                let sign = |x: f64| if components == 1 { x.abs() } else { x };
                value[..components.min(entry.space)].fill_with(|| sign(random.next()));
            });
        }
    }
}
