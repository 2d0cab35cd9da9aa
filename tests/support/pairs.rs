//! The walk over contact formulations: one pair of facets of every two shapes, through the formulation's block.

use std::sync::Arc;

use zelus::contact_structural_mechanics::flags::SLIP;
use zelus::contact_structural_mechanics::law::{
    Augmentation, FrictionEllipse, Margin, Nitsche, NormalVariation, SlipRule, StepParameters,
};
use zelus::contact_structural_mechanics::laws::friction::COULOMB;
use zelus::contact_structural_mechanics::mortar::{
    IntegrationOrder, MOST_NODES, OperatorThreshold, SegmentationSettings,
};
use zelus::contact_structural_mechanics::pairs::{
    ContactBlock, Formulation, FormulationEntry, IntegrationState, Multiplier, Pair, PairKey, PairRequest,
    condition_name,
};
use zelus::contact_structural_mechanics::slave_nodes::{SlaveStates, SlaveTable};
use zelus::contact_structural_mechanics::variables::{
    DYNAMIC_FACTOR, FRICTION_COEFFICIENT, INITIAL_PENALTY, TANGENT_XI,
};
use zelus::structural_mechanics::variables::{DISPLACEMENT, NORMAL};
use zelus_core::entities::{EntityBlock, LocalSystems, Request, find_kind};
use zelus_core::geometry::mapping::unit_normal;
use zelus_core::geometry::{Shape, reversed};
use zelus_core::model::flags::ACTIVE;
use zelus_core::model::{EntityRole, ModelPart, Nodes};
use zelus_core::registry::all;
use zelus_core::vector3::{add, dot, normalised, scale, sub};

use super::specimen::{Random, Vec3, difference, size};

/// The shapes of facets.
pub const FACETS: [Shape; 7] =
    [Shape::Line2, Shape::Line3, Shape::Tri3, Shape::Tri6, Shape::Quad4, Shape::Quad8, Shape::Quad9];

/// One pair and everything its residual depends on.
#[derive(Clone)]
struct Setting {
    shapes: [Shape; 2],
    slave: Vec<Vec3>,
    master: Vec<Vec3>,
    /// Displacements now and at the previous step; masters, then slaves.
    displacement: [Vec<Vec3>; 2],
    normals: Vec<Vec3>,
    tangents: Vec<Vec3>,
    slave_normal: Vec3,
    master_normal: Vec3,
    /// Multipliers of the slave nodes; a scalar one in the first component.
    multipliers: Vec<Vec3>,
    /// In contact, sliding.
    states: Vec<(bool, bool)>,
    /// How far the masters move after the operators of the previous step are kept.
    drift: Vec3,
    operator_threshold: f64,
    order: usize,
}

/// Counts items at the nodes of a facet from another corner on: corners, then nodes on edges, then the rest.
fn turn<T>(items: &mut [T], shape: Shape, by: usize) {
    let corners = shape.cell().corners();
    items.chunks_exact_mut(corners).for_each(|ring| ring.rotate_left(by));
}

impl Setting {
    /// A partly overlapping pair; `noise` distorts facets and normals.
    fn new(slave: Shape, master: Shape, seed: u64, noise: f64, states: [(bool, bool); 2]) -> Self {
        let mut random = Random(seed);
        let space = slave.dim() + 1;
        // The first of a line is to the right, so that it faces up as surfaces do.
        let unit = |shape: Shape| -> Vec<Vec3> {
            let points = shape.cell().points.iter();
            match shape.cell().corners() {
                2 => points.map(|[xi, ..]| [0.5 - 0.5 * xi, 0.0, 0.0]).collect(),
                3 => points.copied().collect(),
                _ => points.map(|[xi, eta, _]| [0.5 + 0.5 * xi, 0.5 + 0.5 * eta, 0.0]).collect(),
            }
        };
        let shift = if space == 2 { [0.3, -0.02, 0.0] } else { [0.17, 0.12, 0.02] };
        let slave_x: Vec<Vec3> = unit(slave).into_iter().map(|x| add(x, random.vector(noise, space))).collect();
        let (master_unit, count) = (unit(master), master.nodes() as u32);
        let master_x: Vec<Vec3> = reversed(master, &(0..count).collect::<Vec<u32>>())
            .into_iter()
            .map(|n| add(add(scale(master_unit[n as usize], 1.1), shift), random.vector(noise, space)))
            .collect();
        let normal = |shape: Shape, x: &[Vec3]| unit_normal(shape, x, shape.cell().centre).expect("an area");
        let (slave_normal, master_normal) = (normal(slave, &slave_x), normal(master, &master_x));
        let normals: Vec<Vec3> =
            slave_x.iter().map(|_| normalised(add(slave_normal, random.vector(noise, space)))).collect();
        let tangents = normals
            .iter()
            .map(|&n| {
                let v = add([1.0, 0.0, 0.0], random.vector(noise, space));
                normalised(sub(v, scale(n, dot(v, n))))
            })
            .collect();
        let count = slave_x.len() + master_x.len();
        let mut displacements = || (0..count).map(|_| random.vector(0.05, space)).collect::<Vec<Vec3>>();
        let displacement = [displacements(), displacements()];
        let multipliers = slave_x.iter().map(|_| random.vector(1.0, space)).collect();
        Self {
            shapes: [slave, master],
            multipliers,
            states: (0..slave_x.len()).map(|j| states[j % 2]).collect(),
            drift: if space == 2 { [0.03, 0.0, 0.0] } else { [0.03, -0.02, 0.0] },
            operator_threshold: 0.0,
            order: 2,
            slave: slave_x,
            master: master_x,
            displacement,
            normals,
            tangents,
            slave_normal,
            master_normal,
        }
    }

    fn space(&self) -> usize {
        self.shapes[0].dim() + 1
    }

    /// Everything turned by R and shifted.
    fn moved(&self, turn: impl Fn(Vec3) -> Vec3, shift: Vec3, vector_multipliers: bool) -> Self {
        let all = |vectors: &[Vec3]| vectors.iter().map(|&v| turn(v)).collect::<Vec<Vec3>>();
        let positions = |x: &[Vec3]| all(x).into_iter().map(|x| add(x, shift)).collect::<Vec<Vec3>>();
        Self {
            slave: positions(&self.slave),
            master: positions(&self.master),
            displacement: [all(&self.displacement[0]), all(&self.displacement[1])],
            normals: all(&self.normals),
            tangents: all(&self.tangents),
            slave_normal: turn(self.slave_normal),
            master_normal: turn(self.master_normal),
            multipliers: if vector_multipliers { all(&self.multipliers) } else { self.multipliers.clone() },
            drift: turn(self.drift),
            ..self.clone()
        }
    }

    /// The same pair with its nodes counted from another one on.
    fn recounted(&self, slave_by: usize, master_by: usize) -> Self {
        let mut other = self.clone();
        let masters = self.master.len();
        let [slave, master] = self.shapes;
        turn(&mut other.slave, slave, slave_by);
        turn(&mut other.master, master, master_by);
        turn(&mut other.normals, slave, slave_by);
        turn(&mut other.tangents, slave, slave_by);
        turn(&mut other.multipliers, slave, slave_by);
        turn(&mut other.states, slave, slave_by);
        for level in &mut other.displacement {
            turn(&mut level[..masters], master, master_by);
            turn(&mut level[masters..], slave, slave_by);
        }
        other
    }

    /// The formulation's block of this pair in a model part; `None` for shapes the formulation does not know.
    fn build(&self, formulation: &Formulation) -> Option<(ModelPart, Box<dyn ContactBlock>)> {
        let [slave, master] = self.shapes;
        let name = condition_name(formulation.condition, slave, master);
        let entry = find_kind(EntityRole::Condition, &name)?;
        let masters = self.master.len();
        let current: Vec<Vec3> = self.master.iter().chain(&self.slave).copied().collect();
        let count = current.len();

        let mut part = ModelPart::new("walk");
        part.info.domain_size = self.space();
        let initial = current.iter().zip(&self.displacement[0]).map(|(&x, &u)| sub(x, u)).collect();
        part.nodes = Nodes::new((1..=count).collect(), initial);
        part.nodes.history.set_levels(2);
        part.nodes.history.add(&DISPLACEMENT);
        part.nodes.history.add(&NORMAL);
        for &(name, components) in formulation.variables {
            part.nodes.history.add_named(name, components);
        }
        for (level, u) in self.displacement.iter().enumerate() {
            part.nodes.history.values_mut(&DISPLACEMENT, level).copy_from_slice(u.as_flattened());
        }
        part.nodes.history.values_mut(&NORMAL, 0)[3 * masters..].copy_from_slice(self.normals.as_flattened());
        part.nodes.values.values_mut(&TANGENT_XI, 0)[3 * masters..].copy_from_slice(self.tangents.as_flattened());
        part.nodes.values.values_mut(&INITIAL_PENALTY, 0).fill(20.0);
        part.nodes.values.values_mut(&DYNAMIC_FACTOR, 0).fill(0.8);
        part.nodes.values.values_mut(&FRICTION_COEFFICIENT, 0).fill(0.4);
        for (j, &(active, slip)) in self.states.iter().enumerate() {
            part.nodes.flags.set(ACTIVE, masters + j, active);
            part.nodes.flags.set(SLIP, masters + j, slip);
        }
        let segmentation = SegmentationSettings {
            integration_order: IntegrationOrder::new(self.order).expect("an order"),
            ..SegmentationSettings::default()
        };
        let parameters = StepParameters {
            segmentation,
            scale_factor: 1.7,
            stiffness: 20.0,
            tangent_factor: 0.3,
            operator_threshold: OperatorThreshold { share: 0.0, area: self.operator_threshold },
            weighted_penalty: false,
            levels_back: 1,
            normal_variation: NormalVariation::Update,
            augmentation: Augmentation::Node,
            regularised: formulation.regularised,
            dynamic: false,
            friction_law: &COULOMB,
            ellipse: FrictionEllipse::default(),
            slip_rule: SlipRule::Bounded(Margin::default()),
            nitsche: Nitsche::default(),
        };
        let nodes: Vec<u32> = (masters as u32..count as u32).collect();
        let owners: Vec<u32> = part.slave_nodes.set("pair", &nodes).collect();
        if let Some((name, components)) = formulation.multiplier.column() {
            part.slave_nodes.history.add_named(name, components);
        }
        let table = SlaveTable { nodes, owners: owners.clone() };
        let mut states = SlaveStates::of(&part, table, formulation.columns());
        states.read_friction(&part.nodes, &COULOMB);
        let key = PairKey { interface: 0, slave: 0, master: 0 };
        let pair = Pair { area: [0.6; MOST_NODES], ..Pair::new(key, [self.slave_normal, self.master_normal]) };
        let request = PairRequest {
            entry,
            slave,
            master,
            exact: Vec::new(),
            pairs: vec![pair],
            nodes: (0..count as u32).collect(),
            slaves: states.all().collect(),
            owners: if formulation.multiplier.is_unknown() { owners } else { Vec::new() },
            around: 0,
            bodies: Arc::default(),
            patches: Arc::default(),
            parameters: Arc::new(parameters),
            states: Arc::new(states.clone()),
        };
        let mut block = (formulation.block)(request);
        part.nodes.move_all();
        let here = part.nodes.current.clone();
        part.nodes.current[..masters].iter_mut().for_each(|x| *x = add(*x, self.drift));
        block.keep_operators(IntegrationState { view: &part.view(), states: &states, own: &|_| true });
        part.nodes.current = here;
        for (row, value) in self.multiplier_rows(block.as_ref()).zip(self.multiplier_values(block.as_ref())) {
            set(&mut part, block.as_ref(), row, value);
        }
        Some((part, block))
    }

    fn multiplier_rows(&self, block: &dyn ContactBlock) -> std::ops::Range<usize> {
        self.space() * (self.slave.len() + self.master.len())..block.unknowns().len()
    }

    fn multiplier_values(&self, block: &dyn ContactBlock) -> Vec<f64> {
        let each = self.multiplier_rows(block).len() / self.slave.len();
        self.multipliers.iter().flat_map(|lambda| lambda[..each].to_vec()).collect()
    }
}

/// Sets the unknown of a row.
pub fn set(part: &mut ModelPart, block: &dyn EntityBlock, row: usize, value: f64) {
    let unknown = block.unknowns()[row];
    let owner = unknown.owner_among(block.nodes(0), block.slave_owners(0));
    part.set_value_of(owner, unknown.variable, 0, value);
}

fn get(part: &ModelPart, block: &dyn EntityBlock, row: usize) -> f64 {
    let unknown = block.unknowns()[row];
    let owner = unknown.owner_among(block.nodes(0), block.slave_owners(0));
    part.value_of(owner, unknown.variable, 0).expect("a column")
}

/// The local system of the only pair.
pub fn system(part: &ModelPart, block: &dyn EntityBlock, request: Request) -> LocalSystems {
    let mut out = LocalSystems::default();
    out.reset(1, block.unknowns().len(), request);
    block.local_systems(&part.view(), 0..1, request, &mut out).expect("a pair that can be computed");
    out
}

fn formulations() -> Vec<(&'static str, &'static Formulation)> {
    // Formulations that take tractions from elements are walked with elements, in tests/contact/nitsche.rs.
    let found = all::<FormulationEntry>().into_iter().map(|entry| (entry.name, &entry.build));
    let found: Vec<_> = found.filter(|(_, formulation)| !matches!(formulation.multiplier, Multiplier::Body)).collect();
    assert!(!found.is_empty(), "no contact formulation is registered");
    let by_node =
        |&(name, formulation): &(&'static str, &'static Formulation)| Some((name, formulation.by_node?.implicit));
    let by_node: Vec<_> = found.iter().filter_map(by_node).collect();
    found.into_iter().chain(by_node).collect()
}

/// Unknowns of pairs of which not all derivatives are checked in each state.
const LARGE: usize = 50;

const INACTIVE: (bool, bool) = (false, false);
const STICK: (bool, bool) = (true, false);
const SLIDING: (bool, bool) = (true, true);

/// Every formulation on every two shapes in every mix of states, with its name; penalties by pair and by node.
fn walk(noise: f64, mut visit: impl FnMut(&str, &'static Formulation, Setting)) {
    for (name, formulation) in formulations() {
        let mut shapes = 0;
        let pairs = FACETS.into_iter().flat_map(|slave| FACETS.map(|master| [slave, master]));
        for [slave, master] in pairs.filter(|[slave, master]| slave.dim() == master.dim()) {
            for (at, states) in
                [[INACTIVE; 2], [SLIDING; 2], [STICK; 2], [SLIDING, INACTIVE], [STICK, SLIDING]].into_iter().enumerate()
            {
                let setting = Setting::new(slave, master, 7 + at as u64, noise, states);
                if setting.build(formulation).is_some() {
                    shapes += 1;
                    visit(&format!("{name} {slave:?} on {master:?}, states {states:?}"), formulation, setting);
                }
            }
        }
        assert!(shapes > 0, "{name} has no block for any two shapes");
    }
}

#[test]
fn tangents_of_pairs_are_derivatives() {
    let mut met = 0;
    walk(0.05, |name, formulation, setting| {
        for operator_threshold in if formulation.frictional() { vec![0.0, 1e9] } else { vec![0.0] } {
            let setting = Setting { operator_threshold, ..setting.clone() };
            let (mut part, block) = setting.build(formulation).expect("a block");
            let block = block.as_ref();
            let LocalSystems { lhs, rhs, .. } = system(&part, block, Request::Both);
            let plain = system(&part, block, Request::Residual).rhs;
            let force = size(plain.iter().copied());
            assert!(difference(&rhs, &plain) <= 1e-12 * force, "{name}: the residual depends on what is wanted");
            if setting.states.iter().any(|(active, _)| *active) {
                assert!(force > 1e-6, "{name}: the pair has no overlap");
            }
            let n = rhs.len();
            let largest = size(lhs.iter().copied()).max(1e-3);
            // Of large systems each takes some of the columns, all of them together all.
            let stride = if n > LARGE { 4 } else { 1 };
            met += 1;
            for column in (met % stride..n).step_by(stride) {
                let value = get(&part, block, column);
                let mut at = |h: f64| {
                    set(&mut part, block, column, value + h);
                    part.nodes.move_all();
                    system(&part, block, Request::Residual).rhs
                };
                let h = 1e-6;
                let (plus, minus) = (at(h), at(-h));
                at(0.0);
                for row in 0..n {
                    let (slope, exact) = (-(plus[row] - minus[row]) / (2.0 * h), lhs[row * n + column]);
                    let error = (slope - exact).abs();
                    assert!(error < 1e-6 * largest, "{name}, row {row}, column {column}: {exact} is not {slope}");
                }
            }
        }
    });
}

#[test]
fn pairs_push_back_what_is_pushed_and_turn_with_the_bodies() {
    walk(0.05, |name, formulation, setting| {
        let space = setting.space();
        let (part, block) = setting.build(formulation).expect("a block");
        let rhs = system(&part, block.as_ref(), Request::Residual).rhs;
        let rows = setting.multiplier_rows(block.as_ref());
        let vectors = rows.len() == space * setting.slave.len();
        for c in 0..space {
            let total: f64 = rhs[..rows.start].iter().skip(c).step_by(space).sum();
            assert!(total.abs() <= 1e-10 * size(rhs.iter().copied()).max(1.0), "{name}: out of balance by {total:e}");
        }

        let ((s, c), (t, k)) = (0.7_f64.sin_cos(), if space == 3 { 0.4_f64.sin_cos() } else { (0.0, 1.0) });
        let turn = |v: Vec3| {
            let (x, y) = (c * v[0] - s * v[1], s * v[0] + c * v[1]);
            [x, k * y - t * v[2], t * y + k * v[2]]
        };
        let shift = [0.4, -0.3, if space == 3 { 0.2 } else { 0.0 }];
        let (part, block) = setting.moved(turn, shift, vectors).build(formulation).expect("a block");
        let after = system(&part, block.as_ref(), Request::Residual).rhs;
        let turned_rows = if vectors { rhs.len() } else { rows.start };
        let mut expected: Vec<f64> = rhs[..turned_rows]
            .chunks(space)
            .flat_map(|f| {
                let f = turn(std::array::from_fn(|a| f.get(a).copied().unwrap_or(0.0)));
                f.into_iter().take(space)
            })
            .collect();
        expected.extend(&rhs[turned_rows..]);
        let error = difference(&expected, &after);
        assert!(error <= 1e-8 * size(rhs).max(1.0), "{name}: off by {error:e} after a rigid-body motion");
    });
}

#[test]
fn the_order_of_a_facets_nodes_does_not_matter() {
    walk(0.0, |name, formulation, mut setting| {
        if setting.space() == 2 {
            return; // the other order of a line is its other side
        }
        // rectangles and a rule of degree six: the integrals are exact however the overlap is cut
        setting.order = 5;
        let (part, block) = setting.build(formulation).expect("a block");
        let rhs = system(&part, block.as_ref(), Request::Residual).rhs;
        let (masters, slaves) = (setting.master.len(), setting.slave.len());
        let each = setting.multiplier_rows(block.as_ref()).len() / slaves;
        for (slave_by, master_by) in [(1, 0), (0, 1), (2, 1)] {
            let (part, block) = setting.recounted(slave_by, master_by).build(formulation).expect("a block");
            let other = system(&part, block.as_ref(), Request::Residual).rhs;
            let mut back = other.clone();
            let [slave, master] = setting.shapes.map(|shape| shape.cell().corners());
            let turn_back = |rows: &mut [f64], corners: usize, each: usize, by: usize| {
                rows.chunks_exact_mut(corners * each).for_each(|ring| ring.rotate_right(each * by));
            };
            turn_back(&mut back[..3 * masters], master, 3, master_by);
            turn_back(&mut back[3 * masters..3 * (masters + slaves)], slave, 3, slave_by);
            if each > 0 {
                turn_back(&mut back[3 * (masters + slaves)..], slave, each, slave_by);
            }
            let error = difference(&rhs, &back);
            assert!(error <= 1e-8 * size(rhs.iter().copied()).max(1.0), "{name}: off by {error:e}");
        }
    });
}
