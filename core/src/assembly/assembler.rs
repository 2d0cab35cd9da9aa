//! Assembles the system of a step: residual and matrices over all unknowns, and the equations that are solved.
//!
//! Three matrices, because they live differently: the *bulk* of elements has one pattern for the whole run and its
//! constant part is assembled once; the *coupling* of interactions (contact) is rebuilt when pairs change; the *load*
//! tangents of follower forces are small and not symmetric.

mod inertia;
mod infinite;
mod massless;
mod ranks;
mod saved;
mod shares;
mod tangents;

use std::time::Instant;

use serde::{Deserialize, Serialize};
use zelus_linear_algebra::vector::{scale_by, zeros};
use zelus_linear_algebra::{Csr, Layout, Symmetry, parallel};

pub use inertia::{Inertia, damped_by_properties, strongest_damping};
pub use saved::AssemblerState;
pub use shares::Push;

use self::ranks::carriers_of_all;
use super::bulk_matrix::{BulkPattern, add_residual, block_numbers};
use super::distribution::Distribution;
use super::dof_table::Dof;
use super::equations::Equations;
use super::group_matrix::GroupMatrix;
use super::near_null_space::near_null_space;
use super::numbering::Numbering;
use super::reach::reach;
use super::redistribution::Redistribution;
use super::rows::ROWS;
use super::system::System;
use crate::communication::Ranks;
use crate::diagnostics::Result;
use crate::entities::{Coupling, EntityBlock, LocalSystems, Tangent, Want};
use crate::model::{Carriers, ModelPart};

/// Largest stiffness of an interaction in those of the bodies: what a stiff penalty adds to the round-off of forces.
const STIFFEST: f64 = 100.0;

/// Seconds spent assembling, by what was assembled.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct AssemblySeconds {
    /// Residuals.
    pub residual: f64,
    /// Tangents of elements.
    pub bulk: f64,
    /// Tangents of interactions.
    pub coupling: f64,
}

type Blocks<'a> = Vec<&'a dyn EntityBlock>;

/// The system of one model part.
#[derive(Default)]
pub struct Assembler {
    pattern: BulkPattern,
    element_numbers: Vec<Vec<u32>>,
    condition_numbers: Vec<Vec<u32>>,
    /// What constant tangents give to the bulk; no numbers where there are none.
    constant: Option<Vec<f64>>,
    mass: Option<Vec<f64>>,
    lumped: bool,
    /// Values of the bulk's tangent where they are not the constant ones.
    bulk: Option<Vec<f64>>,
    bulk_general: bool,
    loads: GroupMatrix,
    coupling: GroupMatrix,
    coupling_graph: Option<u64>,
    interaction_unknowns: Vec<u32>,
    /// Of each of them, whose it is: the place among the couplings.
    coupling_of: Vec<usize>,
    equations: Equations,
    /// Whether the equations are those of a saved run, which says no more of them than their roles.
    incomplete: bool,
    /// All unknowns as equations, those that are not free as held.
    whole: Layout,
    reduced_bulk: Csr,
    reduced_coupling: Csr,
    /// Stamps of the graph and the values that the reduced matrices are of.
    reduced_of: [Option<[u64; 2]>; 2],
    /// Whether there is a tangent.
    has_tangent: bool,
    reduced_loads: Csr,
    stamps: Stamps,
    reduced_graph: u64,
    tangent_key: Option<[f64; 4]>,
    damping: Option<([f64; 2], Vec<f64>)>,
    redistribution: Redistribution,
    /// Of which shape of the bodies its matrices are.
    shape: u64,
    traits: Traits,
    ranks: Ranks,
    distribution: Option<Distribution>,
    numbering: Option<Numbering>,
    /// That of `whole`, where no unknown of any rank follows others.
    whole_numbering: Option<Numbering>,
    /// Seconds spent so far.
    pub seconds: AssemblySeconds,
}

/// The system over all unknowns, those that are not free as held.
#[derive(Debug, Clone, Copy)]
pub struct WholeSystem<'a> {
    /// The system without follower loads.
    pub system: zelus_linear_algebra::System<'a>,
    /// The tangents of follower loads, where there are any.
    pub loads: Option<&'a Csr>,
}

#[derive(Debug, Clone, Copy, Default, Serialize, Deserialize)]
struct Stamps {
    bulk_graph: u64,
    bulk_values: u64,
    coupling_graph: u64,
    coupling_values: u64,
    /// Counts the calls of [`Assembler::tangents`].
    tangents: u64,
}

/// What the blocks of all ranks have.
#[derive(Debug, Clone, Copy, Default)]
struct Traits {
    /// Elements whose tangent depends on the state.
    variable_elements: bool,
    /// Elements whose tangent is not symmetric.
    general_elements: bool,
    /// Anything in the bulk whose tangent depends on the state.
    variable_bulk: bool,
}

impl Traits {
    fn of(part: &ModelPart, system: &System) -> Self {
        let variable_elements = system.elements.iter().any(|b| is_variable(b.as_ref()));
        let mut flags = [
            variable_elements,
            system.elements.iter().any(|b| b.tangent() == Tangent::General),
            // Follower loads are not symmetric and have a matrix of their own.
            variable_elements || system.conditions.iter().any(|b| b.tangent() == Tangent::Symmetric),
        ];
        part.ranks.any_of(&mut flags);
        let [variable_elements, general_elements, variable_bulk] = flags;
        Self { variable_elements, general_elements, variable_bulk }
    }
}

impl Assembler {
    /// Numbers the unknowns of the part and lays out the patterns that last.
    pub fn new(part: &ModelPart, system: &mut System, lumped_mass: bool) -> Self {
        let mut carriers: Vec<Carriers> = Vec::new();
        for block in system.elements.iter().chain(&system.conditions) {
            for unknown in block.unknowns() {
                let nodes = (0..block.len()).map(|at| block.nodes(at)[unknown.node as usize]);
                match carriers.iter_mut().find(|known| known.variable == unknown.variable) {
                    Some(known) => known.nodes.extend(nodes),
                    None => carriers.push(Carriers::of_nodes(unknown.variable, nodes.collect())),
                }
            }
        }
        if let Some(share) = &part.share {
            carriers = carriers_of_all(carriers, part.nodes.len(), &share.halo);
        }
        carriers.sort_by_key(|own| own.variable);
        let multipliers: Vec<Vec<Carriers>> = couplings(system).map(|coupling| coupling.unknowns(part)).collect();
        system.dofs.number(part, &carriers, &multipliers.concat());
        let numbers = |blocks: &[Box<dyn EntityBlock>]| -> Vec<Vec<u32>> {
            blocks.iter().map(|block| block_numbers(block.as_ref(), &system.dofs)).collect()
        };
        let distribution = Distribution::new(&system.dofs, part);
        let pattern = bulk_pattern(part, system, &[]);
        let loads: Blocks<'_> = load_blocks(system);
        let interaction_unknowns: Vec<u32> =
            (0..system.dofs.len() as u32).filter(|&n| system.dofs.dofs()[n as usize].multiplier).collect();
        let mut coupling_of = vec![0; interaction_unknowns.len()];
        for (at, of_coupling) in multipliers.iter().enumerate() {
            for own in of_coupling {
                let numbers = own.owners().filter_map(|owner| system.dofs.number_of(own.variable, owner));
                let places = numbers.filter_map(|number| interaction_unknowns.binary_search(&number).ok());
                places.for_each(|place| coupling_of[place] = at);
            }
        }
        Self {
            element_numbers: numbers(&system.elements),
            condition_numbers: numbers(&system.conditions),
            loads: GroupMatrix::new(&system.dofs, &loads, &[], |_| true),
            pattern,
            lumped: lumped_mass,
            interaction_unknowns,
            coupling_of,
            traits: Traits::of(part, system),
            ranks: part.ranks.clone(),
            distribution,
            ..Self::default()
        }
    }

    /// Whether elements of any rank have a tangent that depends on the state.
    pub fn has_variable_elements(&self) -> bool {
        self.traits.variable_elements
    }

    /// Entries of the elements' matrix over all unknowns.
    pub fn entries(&self) -> usize {
        self.pattern.matrix.entries()
    }

    /// The map between unknowns and equations.
    pub fn equations(&self) -> &Equations {
        &self.equations
    }

    /// Step start, and whenever constraints change: the equations left by fixities and constraints, and the pattern of
    /// the interactions. Collective.
    ///
    /// # Errors
    /// Constraints that contradict each other.
    pub fn begin_step(&mut self, part: &ModelPart, system: &System) -> Result<()> {
        if self.shape != part.nodes.reshaped {
            self.shape = part.nodes.reshaped;
            (self.bulk, self.constant, self.damping) = (None, None, None);
            (self.mass, self.tangent_key) = (None, None);
        }
        let equations = part.ranks.agree(Equations::new(&system.dofs, part))?;
        let changed = self.stamps.bulk_graph == 0 || !equations.same_as(&self.equations);
        let changed = part.ranks.any(changed);
        if changed || std::mem::take(&mut self.incomplete) {
            self.equations = equations;
            let dofs = system.dofs.dofs();
            let place = |dof: &Dof| (!dof.multiplier).then(|| (dof.variable, part.nodes.initial[dof.node as usize]));
            self.whole = Layout {
                node: parallel::map(dofs.len(), ROWS, |at| dofs[at].node),
                multiplier: parallel::map(dofs.len(), ROWS, |at| dofs[at].multiplier),
                // Motions of bodies that several ranks share are found by all of them.
                near_null_space: match self.distribution {
                    None => near_null_space(&parallel::map(dofs.len(), ROWS, |at| place(&dofs[at]))),
                    Some(_) => Vec::new(),
                },
                held: parallel::map(dofs.len(), ROWS, |number| !self.equations.is_free(number)),
            };
            self.numbering = self.distribution.as_ref().map(|d| Numbering::new(&self.equations, d));
            let follows = part.ranks.any(self.equations.has_slaves());
            let numbering = self.numbering.as_ref().filter(|_| !follows);
            self.whole_numbering = numbering.map(|numbering| numbering.of_unknowns(&self.equations));
            self.stamps.bulk_graph += u64::from(changed);
            self.stamps.bulk_values += u64::from(changed);
            self.coupling_graph = None;
        } else {
            self.equations.leaning = equations.leaning;
        }
        let graph = graph_of(system);
        if self.coupling_graph != Some(graph) {
            let blocks = blocks_of(system);
            let is_own = |nodes: &[u32]| part.evaluates_pair(nodes);
            self.coupling = GroupMatrix::new(&system.dofs, &blocks, &self.interaction_unknowns, is_own);
            self.coupling_graph = Some(graph);
            self.stamps.coupling_graph += 1;
        }
        Ok(())
    }

    /// Present values of all unknowns.
    pub fn values(&self, part: &ModelPart, system: &System) -> Vec<f64> {
        system.dofs.gather(part, 0)
    }

    /// External minus internal forces over all unknowns; at supports, minus the reaction.
    ///
    /// # Errors
    /// An entity that cannot be computed.
    pub fn residual(&mut self, part: &ModelPart, system: &System, inertia: Option<&Inertia>) -> Result<Vec<f64>> {
        let own = self.own_residual(part, system, inertia);
        let start = Instant::now();
        let mut rhs = part.ranks.agree(own)?;
        self.add_up(&mut rhs);
        self.seconds.residual += start.elapsed().as_secs_f64();
        Ok(rhs)
    }

    /// As [`Assembler::residual`], where blocks of interactions may be others than those of the matrix, which stays. Collective.
    ///
    /// # Errors
    /// An entity that cannot be computed.
    pub fn residual_beside(
        &mut self,
        part: &ModelPart,
        system: &System,
        inertia: Option<&Inertia>,
    ) -> Result<Vec<f64>> {
        if self.coupling_graph == Some(graph_of(system)) {
            return self.residual(part, system, inertia);
        }
        let is_own = |nodes: &[u32]| part.evaluates_pair(nodes);
        let present = GroupMatrix::new(&system.dofs, &blocks_of(system), &[], is_own);
        let kept = std::mem::replace(&mut self.coupling, present);
        let found = self.residual(part, system, inertia);
        self.coupling = kept;
        found
    }

    /// What the entities of this rank give to the residual.
    fn own_residual(&mut self, part: &ModelPart, system: &System, inertia: Option<&Inertia>) -> Result<Vec<f64>> {
        self.ensure_constant(part, system)?;
        let start = Instant::now();
        let view = part.view();
        let mut rhs = vec![0.0; system.dofs.len()];
        let values = self.values(part, system);
        let constant = self.constant.as_ref().expect("ensured");
        if system.elements.iter().chain(&system.conditions).any(|b| b.tangent() == Tangent::Constant) {
            self.mul_subtract(constant, &values, &mut rhs);
        }
        let numbered = system.elements.iter().zip(&self.element_numbers);
        for (block, numbers) in numbered.chain(system.conditions.iter().zip(&self.condition_numbers)) {
            match block.tangent() {
                Tangent::Constant if block.has_external(&view) => {
                    add_residual(block.as_ref(), numbers, &view, Want::External, &mut rhs)?;
                }
                Tangent::Constant => {}
                _ => add_residual(block.as_ref(), numbers, &view, Want::Residual, &mut rhs)?,
            }
        }
        if let Some(inertia) = inertia {
            let forces = self.own_inertia_forces(part, system, inertia)?;
            rhs.iter_mut().zip(forces).for_each(|(r, force)| *r -= force);
        }
        self.coupling.add_residual(&blocks_of(system), &view, &mut rhs)?;
        self.seconds.residual += start.elapsed().as_secs_f64();
        Ok(rhs)
    }

    /// Forces of the conditions alone: the loads, over all unknowns.
    ///
    /// # Errors
    /// An entity that cannot be computed.
    pub fn loads(&self, part: &ModelPart, system: &System) -> Result<Vec<f64>> {
        let mut out = part.ranks.agree(self.own_loads(part, system))?;
        self.add_up(&mut out);
        Ok(out)
    }

    fn own_loads(&self, part: &ModelPart, system: &System) -> Result<Vec<f64>> {
        let view = part.view();
        let mut out = vec![0.0; system.dofs.len()];
        for (block, numbers) in system.conditions.iter().zip(&self.condition_numbers) {
            add_residual(block.as_ref(), numbers, &view, Want::Residual, &mut out)?;
        }
        Ok(out)
    }

    /// Brings the matrices of the equations up to date with the tangents.
    pub fn reduce(&mut self) {
        let start = Instant::now();
        let Stamps { bulk_graph, bulk_values, coupling_graph, coupling_values, .. } = self.stamps;
        let of = [[bulk_graph, bulk_values], [coupling_graph, coupling_values]].map(Some);
        let graph = |stamps: Option<[u64; 2]>| stamps.map(|[graph, _]| graph);
        let [bulk_kept, coupling_kept] = [0, 1].map(|which| graph(self.reduced_of[which]) == graph(of[which]));
        if self.reduced_of[0] != of[0]
            && let Some(values) = self.bulk.as_deref().or(self.constant.as_deref())
        {
            self.equations.reduce_matrix(&self.pattern.matrix, values, &mut self.reduced_bulk, bulk_kept);
        }
        if self.reduced_of[1] != of[1] {
            let coupling = &self.coupling.matrix;
            self.equations.reduce_matrix(coupling, &coupling.values, &mut self.reduced_coupling, coupling_kept);
        }
        self.reduced_of = of;
        if self.equations.layout.near_null_space.len() != self.whole.near_null_space.len() {
            let of = |vector: &Vec<f64>| self.equations.unknowns().iter().map(|&n| vector[n as usize]).collect();
            self.equations.layout.near_null_space = self.whole.near_null_space.iter().map(of).collect();
        }
        self.seconds.bulk += start.elapsed().as_secs_f64();
    }

    /// The equations to solve, without the follower loads; [`Assembler::reduce`] comes first.
    pub fn system(&self) -> zelus_linear_algebra::System<'_> {
        self.system_of(&self.equations.layout, &self.reduced_bulk, &self.reduced_coupling)
    }

    /// Whether the unknowns may be taken for equations, some of them held: none follows others.
    pub fn has_whole(&self) -> bool {
        match self.distribution {
            None => !self.equations.has_slaves(),
            Some(_) => self.whole_numbering.is_some(),
        }
    }

    /// The equations of all ranks where the unknowns are taken for equations.
    pub fn whole_numbering(&self) -> Option<&Numbering> {
        self.whole_numbering.as_ref()
    }

    /// Lets `solve` have the same system as [`WholeSystem`], without a second copy of the matrix.
    pub fn with_whole<T>(&mut self, solve: impl FnOnce(&Self, WholeSystem<'_>) -> T) -> T {
        let kept = self.bulk.as_mut().or(self.constant.as_mut()).map(std::mem::take).unwrap_or_default();
        self.pattern.matrix.values = kept;
        let system = self.system_of(&self.whole, &self.pattern.matrix, &self.coupling.matrix);
        let solved = solve(self, WholeSystem { system, loads: self.loads.nonzero() });
        let kept = std::mem::take(&mut self.pattern.matrix.values);
        if let Some(values) = self.bulk.as_mut().or(self.constant.as_mut()) {
            *values = kept;
        }
        solved
    }

    fn system_of<'a>(&self, layout: &'a Layout, bulk: &'a Csr, coupling: &'a Csr) -> zelus_linear_algebra::System<'a> {
        zelus_linear_algebra::System {
            layout,
            bulk,
            bulk_symmetry: if self.bulk_general || !self.equations.keep_symmetry() {
                Symmetry::General
            } else {
                Symmetry::PositiveDefinite
            },
            bulk_graph: self.stamps.bulk_graph,
            bulk_values: self.stamps.bulk_values,
            coupling: (coupling.entries() > 0).then_some(coupling),
            coupling_graph: self.stamps.coupling_graph,
            coupling_values: self.stamps.coupling_values,
            coupling_symmetric: false,
            shared: None,
        }
    }

    /// Subtracts (all tangents) · `increment` from `rhs`, both over all unknowns.
    pub fn subtract_product(&self, increment: &[f64], rhs: &mut [f64]) {
        let subtract = |rhs: &mut [f64]| {
            if let Some(bulk) = self.bulk_values() {
                self.mul_subtract(bulk, increment, rhs);
            }
            self.loads.matrix.mul_vec_subtract(increment, rhs);
            self.coupling.matrix.mul_vec_subtract(increment, rhs);
        };
        if self.distribution.is_none() {
            return subtract(rhs);
        }
        let mut product = vec![0.0; rhs.len()];
        subtract(&mut product);
        self.add_up(&mut product);
        rhs.iter_mut().zip(product).for_each(|(sum, value)| *sum += value);
    }

    /// How large the round-off of each entry of a residual is, from the sizes of the terms it is a sum of.
    ///
    /// Terms of constant blocks scale with displacements, those of all others with positions. No term is larger than
    /// stiffness times [`reach`]: bodies that have gone farther, and multipliers that push farther, measure no accuracy.
    pub fn round_off(&self, part: &ModelPart, system: &System) -> Vec<f64> {
        let reach = reach(part, &system.dofs, &self.equations);
        let before = system.dofs.gather(part, 1);
        let values = self.values(part, system);
        let dofs = system.dofs.dofs();
        // Of every unknown: its displacement, its position, its size as a multiplier, and how far it may go.
        let sizes = |n: usize| match values[n].abs() {
            value if dofs[n].multiplier => [0.0, 0.0, value, 0.0],
            value if system.dofs.moves_mesh(n) => {
                let (node, c) = (dofs[n].node as usize, dofs[n].variable.offset());
                let held = value.min(before[n].abs() + reach);
                let farthest = part.nodes.initial[node][c].abs() + held;
                [held, part.nodes.current[node][c].abs().min(farthest).max(held), 0.0, reach]
            }
            value => [value, value, 0.0, 0.0],
        };
        let [displacement, position, multiplier, farthest] =
            [0, 1, 2, 3].map(|i| parallel::map(dofs.len(), ROWS, |n| sizes(n)[i]));
        let bulk = if self.traits.variable_elements { &position } else { &displacement };
        let [mut out, mut bodies, mut coupled, mut pushed, mut gaps] = std::array::from_fn(|_| zeros(dofs.len()));
        let coupling = &self.coupling.matrix;
        let of_coupling = [&mut coupled[..], &mut pushed, &mut gaps];
        coupling.add_products_of_sizes(&coupling.values, [&position, &multiplier, &farthest], of_coupling);
        // Gaps are integrated over facets: a node at the origin is known no better than what lies around it.
        for (n, _) in dofs.iter().enumerate().filter(|(_, dof)| dof.multiplier) {
            let (columns, values) = coupling.row(n);
            // Rows with multipliers are no gaps alone.
            if columns.iter().zip(values).any(|(column, v)| *v != 0.0 && dofs[*column as usize].multiplier) {
                continue;
            }
            let motions = || columns.iter().zip(values).filter(|(column, _)| !dofs[**column as usize].multiplier);
            let [sum, count] =
                motions().fold([0.0, 0.0], |[s, c], (&column, _)| [s + position[column as usize], c + 1.0]);
            let mean = if count > 0.0 { sum / count } else { 0.0 };
            coupled[n] =
                motions().map(|(&column, value)| value.abs() * position[column as usize].max(mean)).sum::<f64>();
        }
        if let Some(values) = self.bulk_values() {
            let matrix = &self.pattern.matrix;
            matrix.add_products_of_sizes(values, [bulk, &farthest], [&mut out, &mut bodies]);
        }
        parallel::each_mut(&mut out, ROWS, |n, out| {
            // Multipliers stand in the tangent of turning normals, too: forces are bounded by the bodies alone.
            *out += match dofs[n].multiplier {
                true => coupled[n] + pushed[n].min(gaps[n]),
                false => (coupled[n] + pushed[n]).min(STIFFEST * bodies[n]),
            };
        });
        self.add_up(&mut out);
        scale_by(f64::EPSILON, &mut out);
        out
    }

    /// Values of the bulk's tangent on its pattern, once there are any.
    fn bulk_values(&self) -> Option<&[f64]> {
        self.bulk.as_deref().or(self.constant.as_deref()).filter(|values| !values.is_empty())
    }

    fn mul_subtract(&self, values: &[f64], x: &[f64], y: &mut [f64]) {
        self.pattern.matrix.mul_vec_subtract_with(values, x, y);
    }

    fn add_blocks(
        &self,
        part: &ModelPart,
        system: &System,
        wanted: impl Fn(&dyn EntityBlock) -> bool,
        values: &mut [f64],
    ) -> Result<()> {
        let view = part.view();
        let numbered = system.elements.iter().zip(&self.element_numbers);
        for (block, numbers) in numbered.chain(system.conditions.iter().zip(&self.condition_numbers)) {
            if wanted(block.as_ref()) {
                let compute = |range, out: &mut LocalSystems| block.local_systems(&view, range, Want::Both, out);
                self.pattern.add(block.as_ref(), numbers, values, &compute)?;
            }
        }
        Ok(())
    }

    fn ensure_constant(&mut self, part: &ModelPart, system: &System) -> Result<()> {
        if self.constant.is_none() {
            let start = Instant::now();
            let is_constant = |block: &dyn EntityBlock| block.tangent() == Tangent::Constant;
            let any = system.elements.iter().chain(&system.conditions).any(|block| is_constant(block.as_ref()));
            let entries = if any { self.pattern.matrix.entries() } else { 0 };
            let mut values = zeros(entries);
            self.add_blocks(part, system, is_constant, &mut values)?;
            self.constant = Some(values);
            self.seconds.bulk += start.elapsed().as_secs_f64();
        }
        Ok(())
    }
}

/// The pattern of elements and conditions, and of `groups` of nodes beside them.
fn bulk_pattern(part: &ModelPart, system: &System, groups: &[Vec<u32>]) -> BulkPattern {
    let blocks = system.elements.iter().chain(&system.conditions).map(AsRef::as_ref);
    let blocks = blocks.filter(|b: &&dyn EntityBlock| b.tangent() != Tangent::Zero);
    BulkPattern::new(&system.dofs, part.nodes.len(), blocks, groups, |node| part.owns_node(node))
}

fn is_variable(block: &dyn EntityBlock) -> bool {
    matches!(block.tangent(), Tangent::Symmetric | Tangent::General)
}

fn load_blocks(system: &System) -> Blocks<'_> {
    system.conditions.iter().map(AsRef::as_ref).filter(|b: &&dyn EntityBlock| b.tangent() == Tangent::General).collect()
}

/// What interactions couple.
fn couplings(system: &System) -> impl Iterator<Item = &dyn Coupling> {
    system.interactions.iter().filter_map(|interaction| interaction.coupling())
}

/// Changes whenever what they couple does.
fn graph_of(system: &System) -> u64 {
    couplings(system).fold(1, |sum, own| sum.wrapping_mul(31).wrapping_add(own.graph_version()))
}

fn blocks_of(system: &System) -> Blocks<'_> {
    couplings(system).flat_map(|own| own.blocks()).collect()
}
