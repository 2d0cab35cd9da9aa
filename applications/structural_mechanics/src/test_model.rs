//! A model part with one entity of one kind, for tests.

use zelus_core::entities::{BlockRequest, EntityBlock, Gauss, LocalSystems, Request, block_factory, find_kind};
use zelus_core::geometry::Shape;
use zelus_core::model::{EntityRole, ModelPart, Nodes, Properties, PropertyValue, Variable};

use crate::variables::DISPLACEMENT;

pub(crate) type Vec3 = [f64; 3];

/// Reproducible numbers in [−1, 1].
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        (self.0 >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub(crate) fn vector(&mut self, size: f64, space: usize) -> Vec3 {
        let mut out = [0.0; 3];
        out[..space].iter_mut().for_each(|x| *x = size * self.next());
        out
    }

    /// A distorted cell away from the plane x = 0.
    pub(crate) fn cell(&mut self, shape: Shape, amount: f64, space: usize) -> Vec<Vec3> {
        let moved = |p: &Vec3| [4.0 + p[0] + 0.3 * p[1] + 0.1 * p[2], 0.8 * p[1] - 1.0, 0.1 * p[0] + 0.7 * p[2]];
        let points = shape.cell().points.iter().map(|p| {
            let (x, noise) = (moved(p), self.vector(amount, space));
            let z = if space == 2 { 0.0 } else { x[2] + noise[2] };
            [x[0] + noise[0], x[1] + noise[1], z]
        });
        points.collect()
    }
}

pub(crate) fn near(a: f64, b: f64, tolerance: f64) -> bool {
    (a - b).abs() <= tolerance
}

/// The largest absolute value.
pub(crate) fn size(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |m, v| m.max(v.abs()))
}

/// Nodes and displacements of the cells whose numbers the reference program printed.
pub(crate) fn reference_cell(shape: Shape, space: usize) -> (Vec<Vec3>, Vec<Vec3>) {
    let points = shape.cell().points.iter().enumerate();
    let nodes = points.map(|(i, p)| {
        let mut x = [4.0 + p[0] + 0.3 * p[1] + 0.1 * p[2], 0.8 * p[1] - 1.0, 0.1 * p[0] + 0.7 * p[2]];
        let mut u = [0.0; 3];
        for a in 0..space {
            x[a] += 0.03 * (7.0 * i as f64 + 3.0 * a as f64).sin();
            u[a] = 0.05 * (5.0 * i as f64 + 2.0 * a as f64).cos();
        }
        if space == 2 {
            x[2] = 0.0;
        }
        (x, u)
    });
    nodes.unzip()
}

/// Σ cos(r) v_r.
pub(crate) fn weighted(values: &[f64]) -> f64 {
    values.iter().enumerate().map(|(r, v)| (r as f64).cos() * v).sum()
}

/// One entity with its block.
pub(crate) struct Single {
    pub(crate) part: ModelPart,
    block: Box<dyn EntityBlock>,
}

impl Single {
    pub(crate) fn new(role: EntityRole, name: &str, law: Option<&str>, values: &[(&str, f64)], x: &[Vec3]) -> Self {
        let entry = find_kind(role, name).unwrap_or_else(|| panic!("{name} is not registered"));
        let mut part = ModelPart::new("test");
        part.nodes = Nodes::new((1..=x.len()).collect(), x.to_vec());
        part.nodes.history.add(&DISPLACEMENT);
        let mut properties = Properties::new(1);
        properties.law = law.map(str::to_owned);
        for (name, value) in values {
            properties.values.insert((*name).to_owned(), PropertyValue::Number(*value));
        }
        part.properties.insert(1, properties);
        let nodes: Vec<u32> = (0..x.len() as u32).collect();
        let table = if role == EntityRole::Element { &mut part.elements } else { &mut part.conditions };
        table.push(1, entry, 1, &nodes);
        table.finish();
        let make = block_factory(entry).unwrap_or_else(|| panic!("{name} is no block"));
        let table = if role == EntityRole::Element { &part.elements } else { &part.conditions };
        let request =
            BlockRequest { entry, members: vec![0], table, nodes: &part.nodes, part: &part, on_initial: false };
        let mut block = make(&request).unwrap();
        block.initialize(&part.view()).unwrap();
        Self { part, block }
    }

    pub(crate) fn block(&self) -> &dyn EntityBlock {
        self.block.as_ref()
    }

    /// Sets DISPLACEMENT and moves the mesh.
    pub(crate) fn displace(&mut self, u: &[Vec3]) {
        self.set_nodal(&DISPLACEMENT, u);
        self.part.nodes.move_all();
    }

    /// Prepares the block again, after its data have changed.
    pub(crate) fn initialize(&mut self) {
        self.try_initialize().unwrap();
    }

    pub(crate) fn try_initialize(&mut self) -> Result<(), String> {
        self.block.initialize(&self.part.view()).map_err(|problem| problem.to_string())
    }

    pub(crate) fn damping(&self) -> Vec<f64> {
        let mut out = LocalSystems::default();
        out.reset(1, self.block.unknowns().len(), Request::Both);
        self.block.damping(&self.part.view(), 0..1, &mut out);
        out.lhs
    }

    /// Lets the history advance.
    pub(crate) fn accept(&mut self) {
        self.block.finalize_step(&self.part.view()).map_err(|e| e.fact).unwrap();
    }

    /// Takes over the history of another model's entity.
    pub(crate) fn inherit(&mut self, earlier: &Single) {
        self.block.inherit(earlier.block());
    }

    pub(crate) fn set_nodal(&mut self, variable: &Variable<Vec3>, values: &[Vec3]) {
        self.part.nodes.history.values_mut(variable, 0).copy_from_slice(values.as_flattened());
    }

    pub(crate) fn system(&self) -> (Vec<f64>, Vec<f64>) {
        self.try_system(Request::Both).unwrap()
    }

    pub(crate) fn residual(&self) -> Vec<f64> {
        self.try_system(Request::Residual).unwrap().1
    }

    pub(crate) fn try_system(&self, request: Request) -> Result<(Vec<f64>, Vec<f64>), String> {
        let mut out = LocalSystems::default();
        out.reset(1, self.block.unknowns().len(), request);
        self.block.local_systems(&self.part.view(), 0..1, request, &mut out).map_err(|e| e.fact)?;
        Ok((out.lhs, out.rhs))
    }

    pub(crate) fn mass(&self, lumped: bool) -> Vec<f64> {
        let mut out = LocalSystems::default();
        out.reset(1, self.block.unknowns().len(), Request::Both);
        assert!(self.block.mass(&self.part.view(), 0..1, lumped, &mut out).unwrap());
        out.lhs
    }

    pub(crate) fn gauss(&self, variable: &str) -> Gauss {
        self.block.gauss(&self.part.view(), variable, 0).unwrap_or_else(|| panic!("no {variable}"))
    }

    /// −∂residual/∂u by central differences at displacements `u`, column by column; the mesh moves when `move_mesh`.
    pub(crate) fn difference_tangent(&mut self, u: &[Vec3], space: usize, move_mesh: bool) -> Vec<f64> {
        let rows = u.len() * space;
        let mut out = vec![0.0; rows * rows];
        for column in 0..rows {
            let mut at = |step: f64| {
                let mut moved = u.to_vec();
                moved[column / space][column % space] += step;
                self.set_nodal(&DISPLACEMENT, &moved);
                if move_mesh {
                    self.part.nodes.move_all();
                }
                self.residual()
            };
            let h = 1e-4;
            let (a, b, c, d) = (at(-2.0 * h), at(-h), at(h), at(2.0 * h));
            for row in 0..rows {
                out[row * rows + column] = -(a[row] - 8.0 * b[row] + 8.0 * c[row] - d[row]) / (12.0 * h);
            }
        }
        self.displace(u);
        out
    }
}
