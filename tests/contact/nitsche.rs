//! Pairs by Nitsche's method on single elements of every kind that has tractions: tangents are derivatives, forces are in
//! balance, bodies may turn.

use std::sync::Arc;

use zelus::contact_structural_mechanics::interface::{
    Bodies, Facet, FacetSource, Interface, NodalNormals, NormalPatches, Patches, Roles,
};
use zelus::contact_structural_mechanics::law::{
    Augmentation, FrictionEllipse, Margin, Multiplier, Nitsche, NitscheVariant, NormalVariation, SlipRule,
    StepParameters,
};
use zelus::contact_structural_mechanics::laws::friction::COULOMB;
use zelus::contact_structural_mechanics::mortar::{IntegrationOrder, OperatorThreshold, SegmentationSettings};
use zelus::contact_structural_mechanics::pairs::{
    ContactBlock, Pair, PairKey, PairRequest, condition_name, find_formulation, group_by_surroundings,
};
use zelus::contact_structural_mechanics::slave_nodes::{SlaveStates, SlaveTable};
use zelus::contact_structural_mechanics::variables::FRICTION_COEFFICIENT;
use zelus::structural_mechanics::variables::{DISPLACEMENT, NORMAL};
use zelus_core::entities::{LocalSystems, Request, require_kind};
use zelus_core::geometry::{Shape, shape_functions};
use zelus_core::model::{EntityRole, ModelPart, Nodes, Properties, PropertyValue};
use zelus_core::vector3::{add, cross, norm, sub};

use crate::specimen::{Random, Vec3, difference, size};
use crate::support::{change, root, said, scratch_copy, zelus};

/// Element, law, and the local nodes of its face, which lies in the plane of the last axis at its lower end.
const KINDS: [(&str, &str, &[usize]); 14] = [
    ("SmallDisplacementElement2D4N", "LinearElasticPlaneStrain2DLaw", &[0, 1]),
    ("SmallDisplacementElement2D3N", "LinearElasticPlaneStress2DLaw", &[0, 1]),
    ("SmallDisplacementBbarElement2D4N", "LinearElasticPlaneStrain2DLaw", &[0, 1]),
    ("AxisymSmallDisplacementElement2D4N", "LinearElasticAxisym2DLaw", &[0, 1]),
    ("TotalLagrangianElement2D4N", "KirchhoffSaintVenantPlaneStrain2DLaw", &[0, 1]),
    ("UpdatedLagrangianElement2D3N", "HyperElasticPlaneStrain2DLaw", &[0, 1]),
    ("SmallDisplacementElement3D4N", "LinearElastic3DLaw", &[0, 2, 1]),
    ("SmallDisplacementElement3D8N", "LinearElastic3DLaw", &[0, 3, 2, 1]),
    ("SmallDisplacementElement3D6N", "LinearElastic3DLaw", &[0, 2, 1]),
    ("TotalLagrangianElement3D8N", "HyperElastic3DLaw", &[0, 3, 2, 1]),
    ("UpdatedLagrangianElement3D4N", "HyperElastic3DLaw", &[0, 2, 1]),
    ("SmallDisplacementElement2D6N", "LinearElasticPlaneStrain2DLaw", &[0, 1, 3]),
    ("AxisymSmallDisplacementElement2D8N", "LinearElasticAxisym2DLaw", &[0, 1, 4]),
    ("SmallDisplacementElement3D10N", "LinearElastic3DLaw", &[0, 2, 1, 6, 5, 4]),
];
const VARIANTS: [NitscheVariant; 3] = [NitscheVariant::Skew, NitscheVariant::Symmetric, NitscheVariant::Incomplete];

/// An element above a facet that it partly overlaps.
struct Contact {
    part: ModelPart,
    block: Box<dyn ContactBlock>,
    interface: Interface,
    patches: Arc<NormalPatches>,
    states: SlaveStates,
}

impl Contact {
    /// `turn` is applied to all initial positions; `masters` is the number of nodes of the facet that it is over.
    fn new(
        (element, law, face): (&str, &str, &[usize]),
        masters: usize,
        variant: NitscheVariant,
        friction: f64,
        turn: impl Fn(Vec3) -> Vec3,
    ) -> Self {
        let entry = require_kind(EntityRole::Element, element).expect("an element");
        let (cell, space) = (entry.cell.expect("a cell").cell(), entry.space);
        let mut random = Random(3);
        let mut shaken = |x: Vec3| add(x, random.vector(0.05, space));
        let axis = space - 1;
        // Over the unit cell, away from an axis, the face at zero.
        let low = cell.points.iter().map(|p| p[axis]).fold(f64::INFINITY, f64::min);
        let mut x: Vec<Vec3> = cell
            .points
            .iter()
            .map(|p| {
                let mut x = *p;
                x[axis] -= low;
                shaken([x[0] + 3.0, x[1], x[2]])
            })
            .collect();
        let count = x.len();
        let shape = |nodes: usize| Shape::of(space - 1, nodes).expect("a shape");
        let facing = shape(masters);
        let corners: &[Vec3] = match facing.cell().corners() {
            2 => &[[0.4, 0.03, 0.0], [-1.6, 0.0, 0.0]],
            3 => &[[-0.9, -0.8, 0.04], [1.1, -0.7, 0.03], [0.1, 1.0, 0.02]],
            _ => &[[-0.9, -0.8, 0.02], [0.7, -0.9, 0.03], [0.8, 0.6, 0.01], [-0.7, 0.7, 0.04]],
        };
        let place = |point: &Vec3| -> Vec3 {
            let mut shares = vec![0.0; corners.len()];
            shape_functions(facing.linear(), *point, &mut shares);
            std::array::from_fn(|c| shares.iter().zip(corners).map(|(share, x)| share * x[c]).sum())
        };
        let corners: Vec<Vec3> = facing.cell().points.iter().map(place).collect();
        x.extend(corners.iter().map(|c| shaken([c[0] + 3.2, c[1], c[2]])));
        let x: Vec<Vec3> = x.into_iter().map(turn).collect();

        let mut part = ModelPart::new("pair");
        part.info.domain_size = space;
        part.nodes = Nodes::new((1..=x.len()).collect(), x);
        part.nodes.history.set_levels(2);
        part.nodes.history.add(&DISPLACEMENT);
        part.nodes.history.add(&NORMAL);
        part.nodes.values.values_mut(&FRICTION_COEFFICIENT, 0).fill(friction);
        let mut properties = Properties::new(1);
        properties.law = Some(law.to_owned());
        for (name, value) in [("YOUNG_MODULUS", 100.0), ("POISSON_RATIO", 0.3), ("THICKNESS", 0.5)] {
            properties.values.insert(name.to_owned(), PropertyValue::Number(value));
        }
        part.properties.insert(1, properties);
        let nodes: Vec<u32> = (0..count as u32).collect();
        part.elements.push(1, entry, 1, &nodes);
        part.elements.finish();

        let facet = |nodes: Vec<u32>, role| {
            let shape = shape(nodes.len());
            Facet { nodes, shape, source: FacetSource::Face(0), element: 0, properties: 1, role, exact: None }
        };
        let slave = facet(face.iter().map(|&n| n as u32).collect(), Roles::Slave);
        let master = facet((count..count + masters).map(|n| n as u32).collect(), Roles::Master);
        let all: Vec<u32> = slave.nodes.iter().chain(&master.nodes).copied().collect();
        let interface = Interface { facets: vec![slave, master], nodes: all, ..Interface::default() };
        let interfaces = std::slice::from_ref(&interface);
        let of_slaves = Patches::new(&part, interfaces, None);
        let patches = Arc::new(NormalPatches::of_slaves(&of_slaves, interfaces, NodalNormals::ByEdges));
        let slaves = of_slaves.of_facet(0, 0, face.len()).to_vec();
        let table = SlaveTable::of_patches(&mut part, &of_slaves, "pair", Multiplier::None);
        let axisymmetric = element.starts_with("Axisym").then_some(0.5);
        let bodies = Arc::new(Bodies::new(&part, interfaces, axisymmetric).expect("tractions"));

        let name = if friction > 0.0 { "NitscheContactFrictional" } else { "NitscheContactFrictionless" };
        let formulation = find_formulation(name).expect("the formulation");
        let (slave, master) = (shape(face.len()), shape(masters));
        let parameters = Arc::new(StepParameters {
            segmentation: SegmentationSettings {
                integration_order: IntegrationOrder::new(3).expect("an order"),
                axisymmetric,
                ..SegmentationSettings::default()
            },
            scale_factor: 1.0,
            stiffness: 1.0,
            tangent_factor: 0.7,
            operator_threshold: OperatorThreshold::default(),
            weighted_penalty: false,
            levels_back: 1,
            normal_variation: NormalVariation::Exact,
            augmentation: Augmentation::Node,
            regularised: false,
            dynamic: false,
            friction_law: &COULOMB,
            ellipse: FrictionEllipse::default(),
            slip_rule: SlipRule::Bounded(Margin::default()),
            nitsche: Nitsche::new(variant, Some(2.0), None),
        });
        let pair = Pair::new(PairKey { interface: 0, slave: 0, master: 1 }, [[0.0; 3]; 2]);
        let own: Vec<u32> = interface.facets[1].nodes.iter().chain(&interface.facets[0].nodes).copied().collect();
        let around = |_: &Pair| {
            let turning = slaves.iter().flat_map(|slave| patches.neighbours(slave.0));
            bodies.nodes([0, 0]).iter().copied().chain(turning).collect()
        };
        let groups = group_by_surroundings(&around, vec![pair], &own);
        let (around, (pairs, nodes)) = groups.into_iter().next().expect("one pair");
        let entry = require_kind(EntityRole::Condition, &condition_name(formulation.condition, slave, master))
            .expect("a condition");
        let mut states = SlaveStates::of(&part, table, formulation.columns());
        states.read_friction(&part.nodes, &COULOMB);
        let request = PairRequest {
            entry,
            slave,
            master,
            pairs,
            nodes,
            slaves: slaves.clone(),
            owners: Vec::new(),
            around,
            exact: Vec::new(),
            bodies,
            patches: patches.clone(),
            parameters,
            states: Arc::new(states.clone()),
        };
        let block = (formulation.block)(request);
        Self { part, block, interface, patches, states }
    }

    /// Moves the mesh by these displacements, `before` being those of the last state.
    fn set(&mut self, now: &[Vec3], before: &[Vec3]) {
        for (level, u) in [now, before].into_iter().enumerate() {
            self.part.nodes.history.values_mut(&DISPLACEMENT, level).copy_from_slice(u.as_flattened());
        }
        self.part.nodes.move_all();
        self.states.take_normals(&self.patches, &self.part.nodes.current);
        self.block.set_states(Arc::new(self.states.clone()));
        let normal = |facet: usize| {
            let facet = &self.interface.facets[facet];
            facet.normal(&self.part)
        };
        let normals = (normal(0), normal(1));
        let pair = &mut self.block.pairs_mut()[0];
        (pair.slave_normal, pair.master_normal) = normals;
    }

    /// Forces and tangent by node and component.
    fn system(&self, request: Request) -> (Vec<f64>, Vec<f64>) {
        let mut out = LocalSystems::default();
        out.reset(1, self.block.unknowns().len(), request);
        self.block.local_systems(&self.part.view(), 0..1, request, &mut out).expect("a pair");
        let place = |u: &zelus_core::entities::LocalUnknown| {
            3 * self.block.nodes(0)[u.node as usize] as usize + u.variable.offset()
        };
        let places: Vec<usize> = self.block.unknowns().iter().map(place).collect();
        let n = 3 * self.part.nodes.len();
        let (mut forces, mut tangent) = (vec![0.0; n], vec![0.0; if request == Request::Both { n * n } else { 0 }]);
        for (row, &place) in places.iter().enumerate() {
            forces[place] += out.rhs[row];
            for (column, &other) in places.iter().enumerate().filter(|_| request == Request::Both) {
                tangent[place * n + other] += out.lhs[row * places.len() + column];
            }
        }
        (forces, tangent)
    }
}

/// Every kind on every facet with every variant: pressed in, its tractions not those of contact.
fn walk(mut visit: impl FnMut(&str, &dyn Fn(&dyn Fn(Vec3) -> Vec3) -> Contact, &[Vec3], &[Vec3])) {
    for kind in KINDS {
        let space = require_kind(EntityRole::Element, kind.0).expect("an element").space;
        for masters in if space == 2 { vec![2, 3] } else { vec![3, 4, 6] } {
            for variant in VARIANTS {
                for friction in [0.0, 0.15, 10.0] {
                    let name = format!("{} on {masters} nodes, {variant:?}, friction {friction}", kind.0);
                    let make = |turn: &dyn Fn(Vec3) -> Vec3| Contact::new(kind, masters, variant, friction, turn);
                    let count = make(&|x| x).part.nodes.len();
                    // The first state that presses: the tractions of disturbed elements of second order may pull everywhere.
                    let states = (17..40).map(|seed| {
                        let mut random = Random(seed);
                        let mut some = || (0..count).map(|_| random.vector(0.04, space)).collect::<Vec<Vec3>>();
                        [some(), some()]
                    });
                    let presses = |[now, before]: &[Vec<Vec3>; 2]| {
                        let mut contact = make(&|x| x);
                        contact.set(now, before);
                        size(contact.system(Request::Residual).0) > 0.1
                    };
                    let [now, before] = states.into_iter().find(presses).expect("a state that presses");
                    visit(&name, &make, &now, &before);
                }
            }
        }
    }
}

#[test]
fn tangents_are_derivatives() {
    walk(|name, make, now, before| {
        let mut contact = make(&|x| x);
        contact.set(now, before);
        let (forces, tangent) = contact.system(Request::Both);
        assert!(size(forces.iter().copied()) > 0.1, "{name}: nothing presses");
        assert!(
            difference(&forces, &contact.system(Request::Residual).0) < 1e-12 * size(forces.iter().copied()),
            "{name}"
        );
        let (n, largest) = (forces.len(), size(tangent.iter().copied()));
        let space = contact.part.info.domain_size;
        for column in (0..n).filter(|column| column % 3 < space) {
            let mut at = |h: f64| {
                let mut moved = now.to_vec();
                moved[column / 3][column % 3] += h;
                contact.set(&moved, before);
                contact.system(Request::Residual).0
            };
            let (plus, minus) = (at(1e-6), at(-1e-6));
            for row in 0..n {
                let (slope, exact) = ((minus[row] - plus[row]) / 2e-6, tangent[row * n + column]);
                let error = (slope - exact).abs();
                assert!(
                    error < 1e-6 * largest,
                    "{name}, row {row}, column {column}: {exact} is not {slope} of {largest}"
                );
            }
        }
    });
}

#[test]
fn forces_are_in_balance_and_turn_with_the_bodies() {
    walk(|name, make, now, before| {
        let mut contact = make(&|x| x);
        contact.set(now, before);
        let forces = contact.system(Request::Residual).0;
        let most = size(forces.iter().copied());
        let (mut force, mut moment) = ([0.0; 3], [0.0; 3]);
        for (f, x) in forces.as_chunks::<3>().0.iter().zip(&contact.part.nodes.current) {
            force = add(force, *f);
            moment = add(moment, cross(*x, *f));
        }
        if name.contains("Axisym") {
            assert!(force[1].abs() < 1e-12 * most, "{name}: {force:?}");
            return; // it cannot turn, and radial forces balance about the axis
        }
        assert!(norm(force) < 1e-12 * most, "{name}: {force:?}");
        // Small displacements change no lever, and quadrilaterals off their plane are met beside the normal.
        let exact = name.contains("2D") && name.contains("Incomplete") && name.ends_with("friction 0");
        assert!(!exact || norm(moment) < 1e-11 * most, "{name}: {moment:?}");

        let (s, c) = 0.7_f64.sin_cos();
        let (t, k) = if name.contains("3D") { 0.4_f64.sin_cos() } else { (0.0, 1.0) };
        let turn = |v: Vec3| {
            let (x, y) = (c * v[0] - s * v[1], s * v[0] + c * v[1]);
            [x, k * y - t * v[2], t * y + k * v[2]]
        };
        let turned = |u: &[Vec3]| u.iter().map(|&u| turn(u)).collect::<Vec<Vec3>>();
        let expected: Vec<f64> = forces.as_chunks::<3>().0.iter().flat_map(|f| turn(*f)).collect();
        // The whole problem in other axes, and from a turned state where strains are finite.
        let mut other = make(&turn);
        other.set(&turned(now), &turned(before));
        let found = other.system(Request::Residual).0;
        assert!(difference(&found, &expected) < 1e-10 * most, "{name}: off by {:e}", difference(&found, &expected));
        if name.contains("Lagrangian") {
            let initial = contact.part.nodes.initial.clone();
            let moved =
                |u: &[Vec3]| -> Vec<Vec3> { initial.iter().zip(u).map(|(x, u)| sub(turn(add(*x, *u)), *x)).collect() };
            contact.set(&moved(now), &moved(before));
            let found = contact.system(Request::Residual).0;
            assert!(difference(&found, &expected) < 1e-9 * most, "{name}: off by {:e}", difference(&found, &expected));
        }
    });
}

/// The traction of a law with a history is not a function of displacements.
#[test]
fn slaves_without_tractions_are_refused() {
    let scratch = scratch_copy(&root().join("tests/cases/contact_2d/nitsche"));
    let materials = "StructuralMaterials.json";
    change(scratch.path(), materials, "LinearElasticPlaneStrain2DLaw", "SmallStrainJ2PlasticityPlaneStrain2DLaw");
    change(scratch.path(), materials, "\"POISSON_RATIO\"", "\"YIELD_STRESS\": 1e9, \"POISSON_RATIO\"");
    let output = zelus(scratch.path(), &["run", "ProjectParameters.json"]);
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
    for expected in ["error[no-tractions]", "its law has a history", "let the other body be the slave"] {
        assert!(said(&output).contains(expected), "{}", said(&output));
    }
}

#[test]
fn factors_below_zero_are_refused() {
    let scratch = scratch_copy(&root().join("tests/cases/contact_2d/nitsche"));
    change(
        scratch.path(),
        "ProjectParameters.json",
        "\"nitsche_variant\"",
        "\"nitsche_factor\": -1.0, \"nitsche_variant\"",
    );
    let output = zelus(scratch.path(), &["run", "ProjectParameters.json"]);
    assert_eq!(output.status.code(), Some(2), "{}", said(&output));
    assert!(said(&output).contains("is -1.0, it must be at least 0"), "{}", said(&output));
}
