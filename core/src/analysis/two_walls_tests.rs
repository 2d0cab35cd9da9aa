//! Slave nodes in a whole analysis: a node on springs is pressed into the corner between two walls.
//!
//! min ½ uᵀ K u − t fᵀ u with n_a · u ≤ g_a for two walls: K u + Σ λ_a n_a = t f, λ_a ≥ 0, λ_a (n_a · u − g_a) = 0. Each wall has
//! a slave node at the one mesh node, and both have a multiplier of the same variable.

use std::collections::BTreeMap;
use std::ops::Range;

use zelus_linear_algebra::{
    Csr, DirectSettings, Engine, Layout, LinearSolver, SolveError, SolveReport, State, Symmetry, create, packed,
};

use super::step_backup::StepBackup;
use crate::assembly::{Assembler, Equations, System};
use crate::diagnostics::Result;
use crate::entities::{
    ActiveSet, Coupling, EntityBlock, EntityError, Interaction, LocalSystems, LocalUnknown, Request, Retry, SetChange,
    StepView, Tangent,
};
use crate::model::test_variables::DISPLACEMENT;
use crate::model::{DofOwners, EntityKind, EntityRole, ModelPart, Nodes, Owner};
use crate::register_variable;
use crate::registry::Entry;
use crate::strategies::{
    Block, BodyBalance, Form, Measure, NewtonRaphson, NewtonSettings, Silent, SolutionStrategy, StaticScheme, Tolerance,
};

register_variable! {
    WALL_PRESSURE: f64 = "Multiplier of the tests, positive in compression.";
}
static SPRINGS: EntityKind = EntityKind::new(EntityRole::Element, Entry::new("TestSprings2D1N", file!(), line!()));
static WALL: EntityKind = EntityKind::new(EntityRole::Condition, Entry::new("TestWall2D1N", file!(), line!()));

const STIFFNESS: [[f64; 2]; 2] = [[4.0, 1.0], [1.0, 3.0]];
/// Load at time 1.
const LOAD: [f64; 2] = [5.0, 4.0];
const NORMALS: [[f64; 2]; 2] = [[1.0, 0.0], [0.6, 0.8]];
const GAPS: [f64; 2] = [0.5, 0.9];
/// Node with springs and walls; that before it has no unknown that is free.
const NODE: u32 = 1;

fn dot(a: [f64; 2], b: [f64; 2]) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

fn displacement(view: &StepView<'_>, node: u32) -> [f64; 2] {
    let [x, y, _] = view.nodes.history.get(DISPLACEMENT.name()).expect("a column").vector(0, node as usize);
    [x, y]
}

fn displacements() -> Vec<LocalUnknown> {
    (0..2).map(|c| LocalUnknown::of_node(0, DISPLACEMENT.component(c))).collect()
}

/// Springs at both nodes, with the load at the second.
struct Springs(Vec<LocalUnknown>);

impl EntityBlock for Springs {
    fn entry(&self) -> &'static EntityKind {
        &SPRINGS
    }
    fn members(&self) -> &[u32] {
        &[0, 1]
    }
    fn nodes(&self, at: usize) -> &[u32] {
        [&[0], &[NODE]][at]
    }
    fn unknowns(&self) -> &[LocalUnknown] {
        &self.0
    }
    fn tangent(&self) -> Tangent {
        Tangent::Symmetric
    }
    fn is_active(&self, _: usize, _: &StepView<'_>) -> bool {
        true
    }
    fn local_systems(
        &self,
        view: &StepView<'_>,
        range: Range<usize>,
        _: Request,
        out: &mut LocalSystems,
    ) -> Result<(), EntityError> {
        for (slot, at) in range.enumerate() {
            let node = self.nodes(at)[0];
            let u = displacement(view, node);
            let share = if node == NODE { view.info.time } else { 0.0 };
            let (lhs, rhs) = out.entity(slot);
            lhs.iter_mut().zip(STIFFNESS.as_flattened()).for_each(|(to, k)| *to = *k);
            (0..2).for_each(|c| rhs[c] = share * LOAD[c] - dot(STIFFNESS[c], u));
        }
        Ok(())
    }
}

/// The condition of each wall at its slave node.
struct WallBlock {
    slaves: [[u32; 1]; 2],
    pressed: [bool; 2],
    unknowns: Vec<LocalUnknown>,
}

impl WallBlock {
    fn pressure(&self, view: &StepView<'_>, wall: usize) -> f64 {
        view.slave_nodes.history.values(&WALL_PRESSURE, 0)[self.slaves[wall][0] as usize]
    }

    /// n · u − g.
    fn penetration(view: &StepView<'_>, wall: usize) -> f64 {
        dot(NORMALS[wall], displacement(view, NODE)) - GAPS[wall]
    }
}

impl EntityBlock for WallBlock {
    fn entry(&self) -> &'static EntityKind {
        &WALL
    }
    fn members(&self) -> &[u32] {
        &[]
    }
    fn len(&self) -> usize {
        2
    }
    fn nodes(&self, _: usize) -> &[u32] {
        &[NODE]
    }
    fn slave_owners(&self, at: usize) -> &[u32] {
        &self.slaves[at]
    }
    fn unknowns(&self) -> &[LocalUnknown] {
        &self.unknowns
    }
    fn tangent(&self) -> Tangent {
        Tangent::Unsymmetric
    }
    fn is_active(&self, _: usize, _: &StepView<'_>) -> bool {
        true
    }
    fn local_systems(
        &self,
        view: &StepView<'_>,
        range: Range<usize>,
        request: Request,
        out: &mut LocalSystems,
    ) -> Result<(), EntityError> {
        for (slot, wall) in range.enumerate() {
            let (normal, pressure, pressed) = (NORMALS[wall], self.pressure(view, wall), self.pressed[wall]);
            let (lhs, rhs) = out.entity(slot);
            (0..2).for_each(|c| rhs[c] = -pressure * normal[c]);
            rhs[2] = if pressed { -Self::penetration(view, wall) } else { -pressure };
            if request == Request::Both {
                (0..2).for_each(|c| lhs[3 * c + 2] = normal[c]);
                match pressed {
                    true => (0..2).for_each(|c| lhs[6 + c] = normal[c]),
                    false => lhs[8] = 1.0,
                }
            }
        }
        Ok(())
    }
}

struct Walls {
    block: WallBlock,
    kept: [bool; 2],
}

impl Interaction for Walls {
    fn name(&self) -> &str {
        "walls"
    }
    fn initialize(&mut self, part: &mut ModelPart) -> Result<()> {
        for (slaves, name) in self.block.slaves.iter_mut().zip(["right", "top"]) {
            *slaves = [part.slave_nodes.set(name, &[NODE]).start];
        }
        part.slave_nodes.history.add(&WALL_PRESSURE);
        Ok(())
    }
    fn coupling(&self) -> Option<&dyn Coupling> {
        Some(self)
    }
    fn active_set(&mut self) -> Option<&mut dyn ActiveSet> {
        Some(self)
    }
    fn retry(&mut self) -> Option<&mut dyn Retry> {
        Some(self)
    }
}

impl Coupling for Walls {
    fn unknowns(&self, _: &ModelPart) -> Vec<DofOwners> {
        vec![DofOwners::of_slaves(WALL_PRESSURE.scalar(), self.block.slaves.as_flattened().to_vec())]
    }
    fn blocks(&self) -> Vec<&dyn EntityBlock> {
        vec![&self.block]
    }
    fn graph_version(&self) -> u64 {
        1
    }
}

impl ActiveSet for Walls {
    fn after_update(&mut self, part: &mut ModelPart, _: usize) -> Result<SetChange> {
        let (before, view) = (self.block.pressed, part.view());
        self.block.pressed =
            [0, 1].map(|wall| self.block.pressure(&view, wall) + WallBlock::penetration(&view, wall) > 0.0);
        let changed = (0..2).filter(|&wall| self.block.pressed[wall] != before[wall]);
        Ok(SetChange { activated: changed.map(|_| part.nodes.ids[NODE as usize]).collect(), ..SetChange::default() })
    }
}

impl Retry for Walls {
    fn save(&mut self) {
        self.kept = self.block.pressed;
    }
    fn restore(&mut self) {
        self.block.pressed = self.kept;
    }
}

/// The model as a mesh file would give it.
fn mesh() -> ModelPart {
    let mut part = ModelPart::new("Structure");
    part.nodes = Nodes::new(vec![3, 7], vec![[0.0; 3], [1.0, 0.0, 0.0]]);
    part.info.domain_size = 2;
    part.nodes.history.add(&DISPLACEMENT);
    part.set_levels(2);
    (0..2).for_each(|c| part.nodes.set_fixed(DISPLACEMENT.component(c), &[0], true));
    part
}

struct TestRun {
    part: ModelPart,
    system: System,
    newton: NewtonRaphson,
}

/// Takes each second system with its inactive equations and the others without, as a solver does that changes its engine.
#[derive(Default)]
struct Alternating {
    solves: usize,
    /// Number of equations by stamp of the graph.
    seen: BTreeMap<u64, usize>,
}

impl LinearSolver for Alternating {
    fn name(&self) -> &'static str {
        "alternating"
    }

    fn takes_inactive_rows(&self, _: usize, _: usize) -> bool {
        self.solves.is_multiple_of(2)
    }

    fn solve(
        &mut self,
        system: &zelus_linear_algebra::System<'_>,
        rhs: &[f64],
        x: &mut [f64],
    ) -> std::result::Result<SolveReport, SolveError> {
        self.solves += 1;
        let count = system.equations();
        assert_eq!(*self.seen.entry(system.bulk_graph).or_insert(count), count, "one stamp, two graphs");
        let (matrix, is_inactive) = (system.merged(), |i: usize| system.layout.is_inactive(i));
        let mut entries: Vec<(usize, usize, f64)> = Vec::new();
        for i in (0..count).filter(|&i| !is_inactive(i)) {
            let (columns, values) = matrix.row(i);
            let active = columns.iter().zip(values).filter(|(j, _)| !is_inactive(**j as usize));
            entries.extend(active.map(|(&j, &value)| (i, j as usize, value)));
        }
        entries.extend((0..count).filter(|&i| is_inactive(i)).map(|i| (i, i, 1.0)));
        let (matrix, layout) = (Csr::from_triplets(count, &entries), Layout::scalar(count));
        let active: Vec<f64> = (0..count).map(|i| if is_inactive(i) { 0.0 } else { rhs[i] }).collect();
        let whole = zelus_linear_algebra::System::bulk(&layout, &matrix, Symmetry::General);
        create(Engine::default()).solve(&whole, &active, x)
    }
}

impl TestRun {
    fn new(part: ModelPart, walls: bool) -> Self {
        Self::with(part, walls, create(Engine::Direct(DirectSettings::default())))
    }

    fn with(mut part: ModelPart, walls: bool, solver: Box<dyn LinearSolver>) -> Self {
        let mut system = System { elements: vec![Box::new(Springs(displacements()))], ..System::default() };
        if walls {
            let mut unknowns = displacements();
            unknowns.push(LocalUnknown::of_slave(0, 0, WALL_PRESSURE.scalar()));
            let block = WallBlock { slaves: [[0]; 2], pressed: [false; 2], unknowns };
            let mut walls = Walls { block, kept: [false; 2] };
            walls.initialize(&mut part).expect("sets of slave nodes");
            system.interactions.push(Box::new(walls));
        }
        let settings = NewtonSettings {
            max_iteration: 20,
            continue_if_converging: false,
            linear: false,
            compute_reactions: true,
            reactions_of_constraints: true,
            move_mesh: true,
            body_balance: BodyBalance::Unchecked,
            line_search: None,
            line_search_after_failure: None,
            contact_stabilization: false,
            elastic_start_after_failure: false,
        };
        let tolerance = Tolerance { relative: 1e-12, absolute: 1e-13 };
        let criterion = Measure { form: Form::Residual, block: Block::All, tolerance, apart: true };
        let assembler = Assembler::new(&part, &mut system, false);
        let newton = NewtonRaphson::new(settings, Box::new(StaticScheme), Box::new(criterion), solver, assembler);
        Self { part, system, newton }
    }

    /// One attempt at a step.
    fn attempt(&mut self, time: f64) -> bool {
        self.part.info.step += 1;
        self.part.clone_time_step(time);
        let record = self.newton.solve_step(&mut self.part, &mut self.system, &mut Silent).expect("a regular system");
        record.converged
    }

    fn step(&mut self, time: f64) {
        assert!(self.attempt(time), "the step to {time} does not converge");
        self.newton.finalize_step(&mut self.part, &mut self.system).expect("an accepted step");
    }

    fn displacement(&self) -> [f64; 2] {
        displacement(&self.part.view(), NODE)
    }

    fn pressures(&self) -> [f64; 2] {
        [0, 1].map(|slave| self.part.value_of(Owner::Slave(slave), WALL_PRESSURE.scalar(), 0).expect("a column"))
    }
}

fn assert_near(found: [f64; 2], expected: [f64; 2]) {
    assert!((0..2).all(|c| (found[c] - expected[c]).abs() < 1e-11), "{found:?} is not {expected:?}");
}

#[test]
fn a_node_in_a_corner_has_the_pressure_of_each_wall() {
    let mut run = TestRun::new(mesh(), true);
    assert_eq!(run.system.dofs.layout().0[1].1[2..], ["WALL_PRESSURE of right", "WALL_PRESSURE of top"]);
    run.step(0.4);
    assert_near(run.displacement(), [0.4; 2]);
    assert_eq!(run.pressures(), [0.0; 2]);
    run.step(1.0);
    // Both walls hold: u = (1/2, 3/4), λ₂ = (f − K u)_y / 0.8, λ₁ = (f − K u)_x − 0.6 λ₂.
    assert_near(run.displacement(), [0.5, 0.75]);
    assert_near(run.pressures(), [1.3125, 1.5625]);
    // The load turns: the right wall alone would be left behind.
    run.step(0.4);
    assert_near(run.displacement(), [0.4; 2]);
    assert_near(run.pressures(), [0.0; 2]);
}

/// Graphs of systems with inactive equations and without have stamps of their own: what a solver keeps of one is not the other's.
#[test]
fn a_solver_may_change_between_systems_with_inactive_equations_and_without() {
    let mut run = TestRun::with(mesh(), true, Box::new(Alternating::default()));
    run.step(0.4);
    run.step(1.0);
    assert_near(run.displacement(), [0.5, 0.75]);
    assert_near(run.pressures(), [1.3125, 1.5625]);
}

#[test]
fn a_restart_in_the_middle_gives_the_same_bits() {
    let mut whole = TestRun::new(mesh(), true);
    [0.4, 0.7].iter().for_each(|&time| whole.step(time));
    let file = |part: &ModelPart| packed::to_bytes(part).expect("numbers");
    let (saved, state) = (file(&whole.part), packed::to_bytes(&whole.newton.state()).expect("a state"));
    whole.step(1.0);

    let mut resumed = TestRun::new(mesh(), true);
    let part: ModelPart = packed::from_bytes(&saved).expect("a part");
    part.check().expect("a part that can be");
    assert!(part.slave_nodes.is_alike(&resumed.part.slave_nodes));
    resumed.part = part;
    let state: Option<Box<dyn State>> = packed::from_bytes(&state).expect("a state");
    resumed.newton.resume(&resumed.part, &resumed.system, state.expect("Newton's")).expect("its own state");
    // The active set, which contact keeps in a state of its own, follows from the values.
    let set = resumed.system.interactions[0].active_set().expect("walls");
    set.after_update(&mut resumed.part, 0).expect("states of walls");
    resumed.step(1.0);
    assert!(resumed.part == whole.part);
    assert!(whole.pressures().iter().all(|pressure| *pressure > 1.0));
}

#[test]
fn a_step_that_is_cut_finds_the_pressures_of_its_start() {
    let mut run = TestRun::new(mesh(), true);
    run.step(0.7);
    let begin = run.part.clone();
    let saved = StepBackup::of(&run.part, &mut run.system);
    assert!(run.attempt(1.0));
    assert!(run.part.slave_nodes != begin.slave_nodes);
    saved.restore(&mut run.part, &mut run.system);
    assert!(run.part.nodes == begin.nodes && run.part.slave_nodes == begin.slave_nodes);
    let mut straight = TestRun::new(mesh(), true);
    straight.step(0.7);
    for run in [&mut run, &mut straight] {
        run.step(0.85);
        run.step(1.0);
    }
    assert_near(run.pressures(), [1.3125, 1.5625]);
    assert_eq!(run.part.slave_nodes, straight.part.slave_nodes);
    assert_eq!(run.part.nodes, straight.part.nodes);
}

#[test]
fn a_multiplier_is_fixed_where_its_mesh_node_is() {
    let mut part = mesh();
    part.nodes.set_fixed(WALL_PRESSURE.scalar(), &[NODE], true);
    let mut run = TestRun::new(part, true);
    let equations = Equations::new(&run.system.dofs, &run.part).expect("no constraints");
    assert_eq!((run.system.dofs.len(), equations.len()), (6, 2));
    run.step(1.0);
    assert_near(run.displacement(), [1.0; 2]);
    assert_eq!(run.pressures(), [0.0; 2]);
}

#[test]
fn without_slave_nodes_nothing_is_numbered_for_them() {
    let run = TestRun::new(mesh(), false);
    assert!(run.part.slave_nodes.is_empty());
    assert!(run.system.dofs.dofs().iter().all(|dof| dof.owner == Owner::Node(dof.node)));
    assert_eq!(run.system.dofs.len(), 4);
}
