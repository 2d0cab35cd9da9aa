//! The tangent of whole curved interfaces against differences, normals of nodes that follow the motion included.

use std::collections::BTreeMap;
use std::sync::Arc;

use zelus_core::entities::{LocalSystems, LocalUnknown, Request, require_kind};
use zelus_core::geometry::{ExactFacet, ExactSurface, Shape, reversed};
use zelus_core::model::flags::ACTIVE;
use zelus_core::model::{EntityRole, ModelPart, Nodes};
use zelus_core::parameters::Document;
use zelus_core::registry::named;
use zelus_core::vector3::{add, norm};
use zelus_structural_mechanics::variables::{DISPLACEMENT, NORMAL};

use crate::active_set::{Rules, find_tangents};
use crate::flags::SLIP;
use crate::interface::{Facet, FacetSource, Interface, NodalNormals, NormalPatches, Patches, Roles, SlaveIndex};
use crate::law::{
    Augmentation, BondState, CohesiveLaw, CohesiveLawEntry, FrictionEllipse, Margin, Multiplier, Nitsche,
    NormalVariation, Rubbing, SlipRule, StepParameters, SurfaceLaw,
};
use crate::laws::bonded::BONDED;
use crate::laws::friction::COULOMB;
use crate::mortar::tests::Noise;
use crate::mortar::{OperatorThreshold, SegmentationSettings};
use crate::pairs::{
    ContactBlock, Formulation, Integral, IntegrationState, Pair, PairKey, PairRequest, condition_name,
    find_formulation, group_by_shapes, group_by_surroundings,
};
use crate::slave_nodes::{SlaveStates, SlaveTable};
use crate::tolerances::Tolerances;
use crate::variables::{DYNAMIC_FACTOR, FRICTION_COEFFICIENT, INITIAL_PENALTY, NODAL_AREA};

/// Facets of two sides that overlap in several pairs a node, and all that their forces depend on.
struct Contact {
    formulation: &'static Formulation,
    parameters: Arc<StepParameters>,
    part: ModelPart,
    interface: Interface,
    blocks: Vec<Box<dyn ContactBlock>>,
    patches: Patches,
    normals: Arc<NormalPatches>,
    states: SlaveStates,
    /// Law of bonds, and the states that were accepted last.
    bonds: Option<(Option<Box<dyn CohesiveLaw>>, Rubbing, fn(usize) -> BondState)>,
}

/// A node whose multiplier is zero.
const OUT_OF_CONTACT: usize = 2;

fn facet(nodes: &[u32], role: Roles) -> Facet {
    let shape = match nodes.len() {
        2 => Shape::Line2,
        3 => Shape::Tri3,
        4 => Shape::Quad4,
        _ => Shape::Quad8,
    };
    Facet { nodes: nodes.to_vec(), shape, source: FacetSource::Face(0), element: 0, properties: 0, role, exact: None }
}

/// Places and facets of two by two quadrilaterals of eight nodes, numbered on from `first`.
fn sheet_of_eight(pitch: f64, height: f64, first: u32) -> (Vec<[f64; 3]>, Vec<Vec<u32>>) {
    let (mut places, mut numbers) = (Vec::new(), BTreeMap::new());
    for (i, j) in (0..5).flat_map(|j| (0..5).map(move |i| (i, j))).filter(|(i, j)| i % 2 == 0 || j % 2 == 0) {
        let [x, y] = [i, j].map(|n: u32| pitch * (0.5 * f64::from(n) - 1.0));
        numbers.insert((i, j), first + places.len() as u32);
        places.push([x + 0.1, y - 0.07, height - 0.15 * x * x - 0.1 * y * y]);
    }
    let ring = [(0, 0), (2, 0), (2, 2), (0, 2), (1, 0), (2, 1), (1, 2), (0, 1)];
    let cells = [(0, 0), (2, 0), (0, 2), (2, 2)].map(|(i, j)| ring.map(|(a, b)| numbers[&(i + a, j + b)]).to_vec());
    (places, cells.to_vec())
}

/// A curved slave below a curved master, both uneven; quadrilaterals and triangles in space, or quadrilaterals of eight nodes.
fn surfaces(space: usize, second_order: bool) -> (Vec<[f64; 3]>, Interface) {
    let mut noise = Noise::new(11);
    let mut shaken = |x: [f64; 3]| std::array::from_fn(|c| if c < space { x[c] + 0.05 * noise.next() } else { 0.0 });
    let (slaves, masters): (Vec<Vec<u32>>, Vec<Vec<u32>>);
    let mut places = Vec::new();
    if second_order {
        let (below, cells) = sheet_of_eight(1.0, 0.0, 0);
        let (above, opposite) = sheet_of_eight(1.2, -0.03, below.len() as u32);
        places.extend(below.into_iter().chain(above).map(&mut shaken));
        slaves = cells;
        masters = opposite.iter().map(|nodes| reversed(Shape::Quad8, nodes)).collect();
    } else if space == 2 {
        places.extend((0..5).map(|n| f64::from(n) - 2.0).map(|x| shaken([x, -0.1 * x * x, 0.0])));
        places.extend((0..5).map(|n| 1.1 * f64::from(n) - 2.0).map(|x| shaken([x, -0.11 * x * x - 0.03, 0.0])));
        slaves = (0..4).map(|n| vec![n + 1, n]).collect();
        masters = (5..9).map(|n| vec![n, n + 1]).collect();
    } else {
        let sheet = |pitch: f64, height: f64| {
            (0..9)
                .map(move |n| [f64::from(n % 3) - 1.0, f64::from(n / 3) - 1.0].map(|x| pitch * x))
                .map(move |[x, y]| [x + 0.1, y - 0.07, height - 0.15 * x * x - 0.1 * y * y])
        };
        places.extend(sheet(1.0, 0.0).map(&mut shaken));
        places.extend(sheet(1.2, -0.03).map(&mut shaken));
        slaves = vec![vec![0, 1, 4, 3], vec![1, 2, 5], vec![1, 5, 4], vec![3, 4, 7, 6], vec![4, 5, 8, 7]];
        masters =
            vec![vec![12, 13, 10, 9], vec![13, 14, 11, 10], vec![15, 16, 13], vec![15, 13, 12], vec![16, 17, 14, 13]];
    }
    let facets = slaves.iter().map(|nodes| facet(nodes, Roles::Slave));
    let facets = facets.chain(masters.iter().map(|nodes| facet(nodes, Roles::Master))).collect();
    let nodes = (0..places.len() as u32).collect();
    (places, Interface { facets, nodes, ..Interface::default() })
}

/// A master that stands for a ball, in the plane for a circle, of radius `R` and centre `(0, 0, R)`, with an apex beside the centre.
const R: f64 = 4.0;

/// The same slave below facets of a rigid ball; all its nodes are free to move.
fn below_a_ball(space: usize) -> (Vec<[f64; 3]>, Interface) {
    let (mut places, mut interface) = surfaces(space, false);
    let up = space - 1;
    let centre = if space == 2 { [0.0, R, 0.0] } else { [0.0, 0.0, R] };
    let corner = |[x, y]: [f64; 2]| {
        let height = R - (R * R - x * x - y * y).sqrt() - 0.2;
        if space == 2 { [x, height, 0.0] } else { [x, y, height] }
    };
    let mut apex = centre;
    (apex[0], apex[up]) = (0.2, R + 0.3);
    let surface = ExactSurface {
        name: "ball",
        level: |&[x, y, z, radius], at| {
            let way = [at[0] - x, at[1] - y, at[2] - z];
            let size = norm(way);
            (size - radius, way.map(|c| c / size))
        },
        numbers: [
            centre[0],
            centre[1] - if space == 2 { 0.2 } else { 0.0 },
            centre[2] - if space == 3 { 0.2 } else { 0.0 },
            R,
        ],
    };
    let first = places.len() as u32;
    let count = if space == 2 { 3 } else { 9 };
    let at = |n: u32| {
        let [i, j] = [n % 3, n / 3].map(|k| 1.5 * f64::from(k) - 1.5);
        corner(if space == 2 { [i, 0.0] } else { [i, j] })
    };
    places.extend((0..count).map(at));
    places.push(apex);
    let (quads, lines) = ([0_u32, 1, 3, 4], [0_u32, 1]);
    let masters: Vec<Vec<u32>> = if space == 2 {
        lines.iter().map(|&n| vec![n, n + 1]).collect()
    } else {
        quads.iter().flat_map(|&n| [vec![n, n + 3, n + 1], vec![n + 1, n + 3, n + 4]]).collect()
    };
    interface.facets.retain(|facet| facet.role == Roles::Slave);
    for own in masters {
        let nodes: Vec<u32> = own.iter().map(|n| first + n).collect();
        let corners = std::array::from_fn(|k| own.get(k).map_or([0.0; 3], |&n| at(n)));
        let exact = ExactFacet { surface, corners, apex };
        interface.facets.push(Facet { exact: Some(Arc::new((exact, first + count))), ..facet(&nodes, Roles::Master) });
    }
    interface.nodes = (0..places.len() as u32).collect();
    (places, interface)
}

impl Contact {
    fn new(
        formulation: &'static Formulation,
        (space, second_order): (usize, bool),
        augmentation: Augmentation,
    ) -> Self {
        let circle = FrictionEllipse::default();
        Self::of(formulation, space, surfaces(space, second_order), (augmentation, circle))
    }

    fn of(
        formulation: &'static Formulation,
        space: usize,
        (places, interface): (Vec<[f64; 3]>, Interface),
        (augmentation, ellipse): (Augmentation, FrictionEllipse),
    ) -> Self {
        let mut noise = Noise::new(5);
        let count = places.len();
        let mut part = ModelPart::new("interface");
        part.info.domain_size = space;
        part.nodes = Nodes::new((1..=count).collect(), places);
        part.nodes.history.set_levels(2);
        part.nodes.history.add(&DISPLACEMENT);
        part.nodes.history.add(&NORMAL);
        formulation.variables.iter().for_each(|&(name, components)| part.nodes.history.add_named(name, components));
        let mut vector =
            |size: f64| -> [f64; 3] { std::array::from_fn(|c| if c < space { size * noise.next() } else { 0.0 }) };
        let start: Vec<[f64; 3]> = (0..count).map(|_| vector(0.05)).collect();
        part.nodes.history.values_mut(&DISPLACEMENT, 1).copy_from_slice(start.as_flattened());
        part.nodes.move_all();
        let interfaces = std::slice::from_ref(&interface);
        let patches = Patches::new(&part, interfaces, None);
        let normals = Arc::new(NormalPatches::of_slaves(&patches, interfaces, NodalNormals::ByEdges));
        let table = SlaveTable::of_patches(&mut part, &patches, "contact", Multiplier::None);
        if let Some((name, components)) = formulation.multiplier.column() {
            part.slave_nodes.history.add_named(name, components);
        }
        part.nodes.values.values_mut(&INITIAL_PENALTY, 0).fill(20.0);
        part.nodes.values.values_mut(&DYNAMIC_FACTOR, 0).fill(0.8);
        part.nodes.values.values_mut(&FRICTION_COEFFICIENT, 0).fill(0.1);
        part.nodes.values.values_mut(&NODAL_AREA, 0).fill(1.3);
        for node in 0..count {
            part.nodes.flags.set(ACTIVE, node, node != OUT_OF_CONTACT);
            part.nodes.flags.set(SLIP, node, node % 2 == 0);
        }
        let parameters = Arc::new(StepParameters {
            segmentation: SegmentationSettings::default(),
            scale_factor: 1.7,
            stiffness: 20.0,
            tangent_factor: 0.3,
            operator_threshold: OperatorThreshold::default(),
            weighted_penalty: false,
            levels_back: 1,
            normal_variation: NormalVariation::Exact,
            augmentation,
            regularised: formulation.regularised,
            dynamic: false,
            friction_law: &COULOMB,
            ellipse,
            slip_rule: SlipRule::Bounded(Margin::default()),
            nitsche: Nitsche::default(),
        });
        let mut states = SlaveStates::of(&part, table, formulation.columns());
        states.set_slaves(patches.slaves(interfaces));
        states.read_friction(&part.nodes, &COULOMB);
        let mut contact = Self {
            formulation,
            parameters,
            part,
            interface,
            blocks: Vec::new(),
            patches,
            normals,
            states,
            bonds: None,
        };
        contact.make_blocks();
        contact.leave_start();
        contact
    }

    fn make_blocks(&mut self) {
        let formulation = self.formulation;
        let of_role = |role| {
            let facets = self.interface.facets.iter().enumerate();
            facets.filter(move |(_, facet)| facet.role == role).map(|(at, _)| at as u32)
        };
        let pairs: Vec<Pair> = of_role(Roles::Slave)
            .flat_map(|slave| of_role(Roles::Master).map(move |master| PairKey { interface: 0, slave, master }))
            .map(|key| Pair::new(key, [[0.0; 3]; 2]))
            .collect();
        for ((slave, master, _), (pairs, nodes)) in
            group_by_shapes(std::slice::from_ref(&self.interface), pairs, true, |p| p.key)
        {
            let entry =
                require_kind(EntityRole::Condition, &condition_name(formulation.condition, slave, master)).unwrap();
            for (around, (pairs, nodes)) in group_by_surroundings(&|pair: &Pair| self.around(pair.key), pairs, &nodes) {
                let (patches, parameters) = (self.normals.clone(), self.parameters.clone());
                let slaves: Vec<SlaveIndex> = pairs.iter().flat_map(|pair| self.slaves_of(pair.key)).copied().collect();
                let has_owners = formulation.multiplier.is_unknown();
                let owners = slaves.iter().filter(|_| has_owners).map(|slave| self.states.owner(*slave)).collect();
                let (bodies, states) = (Arc::default(), Arc::default());
                let of_masters = pairs.iter().map(|pair| &self.interface.facets[pair.key.master as usize]);
                let exact = of_masters.filter_map(|facet| facet.exact.clone()).collect();
                self.blocks.push((formulation.block)(PairRequest {
                    entry,
                    slave,
                    master,
                    exact,
                    pairs,
                    nodes,
                    slaves,
                    owners,
                    around,
                    bodies,
                    patches,
                    parameters,
                    states,
                }));
            }
        }
        self.follow();
        let present = IntegrationState { view: &self.part.view(), states: &self.states, own: &|_| true };
        self.blocks.iter_mut().for_each(|block| block.keep_operators(present));
    }

    /// Slave nodes of a pair.
    fn slaves_of(&self, key: PairKey) -> &[SlaveIndex] {
        let nodes = self.interface.facets[key.slave as usize].nodes.len();
        self.patches.of_facet(key.interface, key.slave, nodes)
    }

    /// Nodes on which the normals of a pair depend.
    fn around(&self, key: PairKey) -> Vec<u32> {
        self.slaves_of(key).iter().flat_map(|slave| self.normals.neighbours(slave.0)).collect()
    }

    /// Moves somewhere else than at the start of the step, with multipliers of its own.
    fn leave_start(&mut self) {
        let formulation = self.formulation;
        let mut noise = Noise::new(23);
        let space = self.part.info.domain_size;
        let mut vector =
            |size: f64| -> [f64; 3] { std::array::from_fn(|c| if c < space { size * noise.next() } else { 0.0 }) };
        let count = self.part.nodes.len();
        let moved: Vec<[f64; 3]> = (0..count).map(|_| vector(0.03)).collect();
        self.part.nodes.history.values_mut(&DISPLACEMENT, 0).copy_from_slice(moved.as_flattened());
        if formulation.variables.iter().any(|(name, _)| *name == "VECTOR_LAGRANGE_MULTIPLIER") {
            let down = if space == 2 { [0.3, -1.0, 0.0] } else { [0.3, 0.2, -1.0] };
            let multipliers: Vec<[f64; 3]> = (0..count).map(|_| add(vector(0.1), down)).collect();
            for slave in self.states.all() {
                let node = self.states.mesh_node(slave) as usize;
                let value = if node == OUT_OF_CONTACT { [0.0; 3] } else { multipliers[node] };
                formulation.multiplier.set(&mut self.part.slave_nodes, self.states.owner(slave), value);
            }
        } else {
            for slave in self.states.all() {
                let value = [-1.0 - 0.1 * f64::from(self.states.mesh_node(slave)), 0.0, 0.0];
                formulation.multiplier.set(&mut self.part.slave_nodes, self.states.owner(slave), value);
            }
        }
        self.follow();
        for block in &mut self.blocks {
            let integrals =
                block.integrate(IntegrationState { view: &self.part.view(), states: &self.states, own: &|_| true });
            block.pairs_mut().iter_mut().zip(integrals).for_each(|(pair, integral)| {
                (pair.area, pair.overlapping) = (integral.area, integral.overlapping);
            });
        }
        // Areas stay those of this state: they weigh slips in the direction of sliding only.
        let areas = self.sums(|integral, j| [integral.area[j], 0.0, 0.0]);
        self.states.for_each(|slave, state| state.kinematics.area = areas[slave.place()][0]);
        self.follow();
    }

    /// Over the pairs of each slave node.
    fn sums(&self, of: impl Fn(&Integral, usize) -> [f64; 3]) -> Vec<[f64; 3]> {
        let mut sums = vec![[0.0; 3]; self.states.len()];
        for block in &self.blocks {
            for (at, integral) in self.integrals(block.as_ref()).iter().enumerate() {
                for (j, &slave) in block.slaves(at).iter().enumerate() {
                    sums[slave.place()] = add(sums[slave.place()], of(integral, j));
                }
            }
        }
        sums
    }

    /// Positions, normals and directions of sliding after displacements.
    fn follow(&mut self) {
        self.part.nodes.move_all();
        self.states.take_normals(&self.normals, &self.part.nodes.current);
        for pair in self.blocks.iter_mut().flat_map(|block| block.pairs_mut()) {
            let normal = |facet: u32| {
                let facet = &self.interface.facets[facet as usize];
                let places: Vec<[f64; 3]> = facet.nodes.iter().map(|&n| self.part.nodes.current[n as usize]).collect();
                facet.normal_at(&places)
            };
            (pair.slave_normal, pair.master_normal) = (normal(pair.key.slave), normal(pair.key.master));
        }
        if self.formulation.frictional() {
            let slips = self.sums(|integral, j| integral.slip[j]);
            self.states.for_each(|slave, state| {
                (state.kinematics.weighted_slip, state.kinematics.pairs) = (slips[slave.place()], 0)
            });
            for block in &self.blocks {
                let integrals = self.integrals(block.as_ref());
                for at in (0..block.len()).filter(|&at| integrals[at].overlapping) {
                    block.slaves(at).iter().for_each(|&slave| self.states[slave].kinematics.pairs += 1);
                }
            }
            let (formulation, parameters) = (self.formulation, self.parameters.clone());
            let rules = Rules { formulation, parameters: &parameters, tolerances: Tolerances::default() };
            find_tangents(&self.part, &mut self.states, rules, false, &mut BTreeMap::new());
        }
        if self.bonds.is_some() {
            self.find_bonds();
        }
        let states = Arc::new(self.states.clone());
        self.blocks.iter_mut().for_each(|block| block.set_states(states.clone()));
    }

    /// Finds the tractions of bonds over all pairs of a slave node.
    fn find_bonds(&mut self) {
        let (law, rubbing, last) = self.bonds.as_ref().expect("bonds");
        self.states.all().for_each(|slave| self.states.set_accepted(slave, last(slave.place())));
        let area = self.sums(|integral, j| [integral.area[j], integral.gap[j], 0.0]);
        let [trial, sliding] =
            [self.sums(|integral, j| integral.trial[j]), self.sums(|integral, j| integral.sliding[j])];
        let means = |sum: [f64; 3], slave: SlaveIndex| sum.map(|x| x / area[slave.place()][0]);
        self.states.for_each(|slave, state| {
            (state.kinematics.area, state.kinematics.weighted_gap) = (area[slave.place()][0], area[slave.place()][1]);
            state.law.trial = means(trial[slave.place()], slave);
        });
        self.states.open_bonds(&|slave| means(sliding[slave.place()], slave));
        self.states.make_bonds(&[]);
        let law = SurfaceLaw { cohesive: law.as_deref(), rubbing: *rubbing };
        self.states.find_bonds(law, self.parameters.tangent_factor);
    }

    fn integrals(&self, block: &dyn ContactBlock) -> Vec<Integral> {
        block.integrate(IntegrationState { view: &self.part.view(), states: &self.states, own: &|_| true })
    }

    /// Visits the entries of residual and tangent, the latter with its column.
    fn each(&self, request: Request, mut visit: impl FnMut((u32, LocalUnknown), Option<(u32, LocalUnknown)>, f64)) {
        for block in &self.blocks {
            let mut out = LocalSystems::default();
            out.reset(block.len(), block.unknowns().len(), request);
            block.local_systems(&self.part.view(), 0..block.len(), request, &mut out).unwrap();
            for at in 0..block.len() {
                let nodes = block.nodes(at).to_vec();
                let place = |u: &LocalUnknown| (nodes[u.node as usize], LocalUnknown::of_node(0, u.variable));
                let rows: Vec<_> = block.unknowns().iter().map(place).collect();
                let (lhs, rhs) = out.entity(at);
                for (i, &row) in rows.iter().enumerate() {
                    visit(row, None, rhs[i]);
                    if request == Request::Both {
                        (0..rows.len()).for_each(|j| visit(row, Some(rows[j]), lhs[i * rows.len() + j]));
                    }
                }
            }
        }
    }
}

type Place = (u32, &'static str, usize);

fn place((node, unknown): (u32, LocalUnknown)) -> Place {
    (node, unknown.variable.column, unknown.variable.offset())
}

fn check(formulation: &str, of: (usize, bool), augmentation: Augmentation) {
    let contact = Contact::new(find_formulation(formulation).unwrap(), of, augmentation);
    check_contact(contact, &format!("{formulation} {of:?} {augmentation:?}"), of.0);
}

fn check_contact(mut contact: Contact, what: &str, space: usize) {
    let (mut tangent, mut forces) = (BTreeMap::<(Place, Place), f64>::new(), BTreeMap::<Place, f64>::new());
    contact.each(Request::Both, |row, column, value| match column {
        Some(column) => *tangent.entry((place(row), place(column))).or_default() += value,
        None => *forces.entry(place(row)).or_default() += value,
    });
    let largest = tangent.values().fold(0.0_f64, |most, value| most.max(value.abs()));
    assert!(largest > 0.1 && forces.len() > 10, "{what}: {largest}");
    for node in 0..contact.part.nodes.len() {
        for c in 0..space {
            let mut slopes: BTreeMap<Place, f64> = BTreeMap::new();
            for (step, sign) in [(1e-6, 1.0), (-2e-6, -1.0)] {
                contact.part.nodes.history.values_mut(&DISPLACEMENT, 0)[3 * node + c] += step;
                contact.follow();
                contact.each(Request::Residual, |row, _, value| {
                    *slopes.entry(place(row)).or_default() -= sign * value / 2e-6;
                });
            }
            contact.part.nodes.history.values_mut(&DISPLACEMENT, 0)[3 * node + c] += 1e-6;
            let column = (node as u32, DISPLACEMENT.component(c as u8).column, c);
            for (row, slope) in slopes {
                let exact = tangent.get(&(row, column)).copied().unwrap_or(0.0);
                assert!(
                    (slope - exact).abs() < 2e-7 * largest,
                    "{what}: {row:?} by {column:?}: {slope} {exact} of {largest}"
                );
            }
        }
    }
}

#[test]
fn tangents_of_curved_interfaces_match_differences() {
    for space in [2, 3] {
        for augmentation in [Augmentation::Node, Augmentation::Pair] {
            check("ALMContactFrictionless", (space, false), augmentation);
            check("ALMContactFrictionlessComponents", (space, false), augmentation);
            // Where pairs augment, the direction of sliding in space turns as it does in contact, without gaps.
            if space == 2 || augmentation == Augmentation::Node {
                check("ALMContactFrictional", (space, false), augmentation);
            }
        }
        check("PerturbedLagrangianContactFrictionless", (space, false), Augmentation::Pair);
    }
}

/// The exact surface of a rigid shape moves with the nodes of its facets and with their apex, rotations among them.
#[test]
fn tangents_below_a_rigid_shape_match_differences() {
    for space in [2, 3] {
        for name in ["ALMContactFrictionless", "ALMContactFrictional"] {
            let contact = Contact::of(
                find_formulation(name).unwrap(),
                space,
                below_a_ball(space),
                (Augmentation::Node, FrictionEllipse::default()),
            );
            assert!(contact.blocks.iter().all(|block| block.nodes(0).contains(&(contact.part.nodes.len() as u32 - 1))));
            check_contact(contact, &format!("{name} {space}"), space);
        }
    }
}

const ELLIPSE: FrictionEllipse = FrictionEllipse { direction: [0.6, 0.8, 0.0], ratio: 0.4 };

/// Friction by direction with multipliers, whose axis the curved surface has in it in places only.
#[test]
fn tangents_of_friction_by_direction_match_differences() {
    let formulation = find_formulation("ALMContactFrictional").unwrap();
    let contact = Contact::of(formulation, 3, surfaces(3, false), (Augmentation::Node, ELLIPSE));
    check_contact(contact, "friction by direction", 3);
}

/// Bonds that are sound, are being damaged, unload, and have failed, with friction where they are closed; a node without contact among
/// them. The branch of each node is that of its accepted state.
#[test]
fn tangents_of_bonds_match_differences() {
    let laws = [
        r#"{"law": "bilinear", "normal_stiffness": 20.0, "shear_stiffness": 12.0, "normal_strength": 0.4, "shear_strength": 0.3,
            "normal_energy": 0.7, "shear_energy": 2.0, "mixed_mode_exponent": 1.7}"#,
        r#"{"law": "exponential", "normal_stiffness": 20.0, "shear_stiffness": 12.0, "normal_strength": 0.4, "shear_strength": 0.3,
            "normal_energy": 0.7, "shear_energy": 2.0, "mixed_mode_exponent": 1.7}"#,
        r#"{"law": "adhesion", "normal_stiffness": 20.0, "normal_strength": 0.2, "normal_energy": 0.7}"#,
    ];
    let states: [(&str, fn(usize) -> BondState); 4] = [
        ("open", |_| BondState { bonded: Some(true), start: -0.4, ..BondState::default() }),
        ("closed", |_| BondState { bonded: Some(true), start: 0.4, sliding: [0.09, 0.0, 0.0], ..BondState::default() }),
        ("unloads", |at| BondState {
            bonded: Some(true),
            start: [-0.4, 0.3][at % 2],
            damage: 0.99,
            ..BondState::default()
        }),
        ("failed", |_| BondState {
            bonded: Some(false),
            start: 0.5,
            damage: 1.0,
            friction: [0.05, 0.0, 0.0],
            ..BondState::default()
        }),
    ];
    for (law, space) in laws.iter().flat_map(|law| [(law, 2), (law, 3)]) {
        for (word, accepted) in states {
            let document = Document::from_str(law, "law.json").expect("JSON");
            let (entry, settings) = named::<CohesiveLawEntry>(&document.root, "law").expect("a law");
            let law_of_bonds = (entry.build)(&settings).expect("a law");
            check_bonds(space, (Some(law_of_bonds), Rubbing::default(), accepted), &format!("{law} {word}"));
        }
    }
    // Friction by direction, elastic up to a slip or not.
    for elastic_slip in [None, Some(0.01), Some(10.0)] {
        let rubbing = Rubbing { elastic_slip, ellipse: ELLIPSE };
        let (word, accepted) = states[3];
        check_bonds(3, (None, rubbing, accepted), &format!("{rubbing:?} {word}"));
    }
}

fn check_bonds(space: usize, bonds: (Option<Box<dyn CohesiveLaw>>, Rubbing, fn(usize) -> BondState), what: &str) {
    let mut contact = Contact::new(&BONDED, (space, false), Augmentation::Node);
    contact.states.add_bonds(true);
    contact.bonds = Some(bonds);
    contact.follow();
    check_contact(contact, &format!("{what} {space}"), space);
}

/// Corners of such facets have shares below zero of those that they overlap in part.
#[test]
fn tangents_of_facets_of_second_order_match_differences() {
    check("ALMContactFrictionless", (3, true), Augmentation::Node);
    check("ALMContactFrictional", (3, true), Augmentation::Node);
}
