//! Balance of forces and energies in accepted steps: see [`Balance`].

use serde::{Deserialize, Serialize};

use super::balance::{Balance, BalanceTerms, Energies, Flows, PairBalance, UnknownBalance};
use crate::StateMapper;
use crate::assembly::{Assembler, Inertia, PairForce, System};
use crate::diagnostics::Result;
use crate::entities::PairState;
use crate::model::flags::RELATIVE;
use crate::model::{ModelPart, Rates, ScalarVariable, mesh_box};
use crate::vector3::{add, cross, norm, sub};

/// Loads, internal forces, interactions, inertia and reactions; then the residual.
const KINDS: usize = 5;
const LOADS: usize = 0;
const ELEMENTS: usize = 1;
const INTERACTIONS: usize = 2;
const REACTIONS: usize = 4;

/// Forces over all unknowns, by kind.
pub(super) type Forces = [Vec<f64>; KINDS];

/// A converged state that is not accepted yet.
#[derive(Debug, Clone, Default)]
struct Pending {
    forces: Forces,
    works: [f64; KINDS],
    dissipated: Vec<f64>,
}

/// Balance of forces and energies of one stage.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub(super) struct EnergyBalance {
    /// Forces at the end of the last accepted step; none before the first one.
    before: Option<Forces>,
    /// Works of the kinds since the stage began.
    works: [f64; KINDS],
    /// Heat of friction since the stage began, by pair.
    dissipated: Vec<f64>,
    #[serde(skip)]
    pending: Option<Pending>,
    /// Centre of the box around the initial mesh.
    #[serde(skip)]
    centre: Option<[f64; 3]>,
}

impl EnergyBalance {
    /// The balance of a converged state with this residual; `more` are loads that the assembler does not know of. Collective.
    ///
    /// # Errors
    /// An entity that cannot be computed.
    pub(super) fn balance(
        &mut self,
        part: &ModelPart,
        system: &System,
        assembler: &mut Assembler,
        residual: &[f64],
        inertia: Option<&Inertia>,
        more: Option<&[f64]>,
    ) -> Result<Balance> {
        let centre = *self.centre.get_or_insert_with(|| centre(part));
        let mut pairs = Pairs::of(part, system, centre);
        let penalty = pairs.states.iter().filter_map(|state| state.stored).sum();
        let forces = forces(part, system, assembler, residual, inertia, more, &mut pairs)?;
        let pairs = pairs.finish(part);
        let unknowns = sums(part, system, residual, &forces, &pairs, centre);
        let works = self.works(part, system, assembler, &forces);
        let kinetic = if inertia.is_some() { assembler.kinetic_energy(part, system)? } else { 0.0 };
        let dissipated = pairs.iter().enumerate().map(|(at, pair)| pair.dissipated + self.dissipated_by(at)).collect();
        let pending = Pending { forces, works, dissipated };
        let pairs = pairs.into_iter().zip(&pending.dissipated);
        let balance = Balance {
            unknowns,
            pairs: pairs.map(|(pair, &dissipated)| PairBalance { dissipated, ..pair }).collect(),
            energies: Energies {
                stored: -pending.works[ELEMENTS],
                loads: pending.works[LOADS],
                supports: pending.works[REACTIONS],
                interactions: pending.works[INTERACTIONS],
                dissipated: pending.dissipated.iter().sum(),
                kinetic,
                penalty,
                ..Energies::default()
            },
            supports: Vec::new(),
        };
        self.pending = Some(pending);
        Ok(balance)
    }

    /// Forces of the converged state whose balance was taken last, by kind; `None` once it is accepted.
    pub(super) fn pending_forces(&self) -> Option<&Forces> {
        self.pending.as_ref().map(|pending| &pending.forces)
    }

    /// The step is accepted.
    pub(super) fn accept(&mut self) {
        if let Some(Pending { forces, works, dissipated }) = self.pending.take() {
            (self.before, self.works, self.dissipated) = (Some(forces), works, dissipated);
        }
    }

    /// Whether it can be that of as many unknowns.
    pub(super) fn is_of(&self, unknowns: usize) -> bool {
        self.before.iter().flatten().all(|forces| forces.len() == unknowns)
    }

    /// See [`State::remap`](crate::State::remap).
    pub(super) fn remap(&mut self, mapper: &mut dyn StateMapper) {
        self.before.iter_mut().flatten().for_each(|forces| mapper.by_unknown(forces));
    }

    fn dissipated_by(&self, pair: usize) -> f64 {
        self.dissipated.get(pair).copied().unwrap_or(0.0)
    }

    /// Works since the stage began, Σ ½ (f_n + f_{n+1}) · (u_{n+1} − u_n). A run begins without forces, a later stage with those of
    /// its first step. Collective.
    fn works(&self, part: &ModelPart, system: &System, assembler: &Assembler, forces: &Forces) -> [f64; KINDS] {
        let goes_on = part.info.step > 1;
        let mut own = [0.0; KINDS];
        let levels = [0, 1].map(|level| system.dofs.gather(part, level));
        for (n, dof) in system.dofs.dofs().iter().enumerate() {
            if dof.multiplier || !assembler.counts(n) || dof.rates().is_none_or(|rates| rates.second.is_none()) {
                continue;
            }
            let way = levels[0][n] - levels[1][n];
            for (kind, work) in own.iter_mut().enumerate() {
                let now = forces[kind][n];
                let before = match &self.before {
                    Some(before) => before[kind][n],
                    None if goes_on => now,
                    None => 0.0,
                };
                *work += 0.5 * (before + now) * way;
            }
        }
        part.ranks.sum(&mut own);
        std::array::from_fn(|kind| self.works[kind] + own[kind])
    }
}

/// The pairs of all interactions, as their forces are added up.
struct Pairs<'a> {
    part: &'a ModelPart,
    centre: [f64; 3],
    states: Vec<PairState>,
    /// Place of the first pair of each interaction.
    firsts: Vec<usize>,
    /// Force and moment on the first side, and force on the second.
    sums: Vec<[[f64; 3]; 3]>,
}

impl<'a> Pairs<'a> {
    fn of(part: &'a ModelPart, system: &System, centre: [f64; 3]) -> Self {
        let (mut states, mut firsts) = (Vec::new(), Vec::new());
        for interaction in &system.interactions {
            firsts.push(states.len());
            states.extend(interaction.pairs(part));
        }
        let sums = vec![[[0.0; 3]; 3]; states.len()];
        Self { part, centre, states, firsts, sums }
    }

    /// Adds the force of an entity on one unknown of a pair.
    fn push(&mut self, system: &System, push: PairForce) {
        let dof = system.dofs.dofs()[push.number as usize];
        if !dof.moves_mesh() {
            return;
        }
        let [first, moment, second] = &mut self.sums[self.firsts[push.interaction] + push.pair];
        let mut force = [0.0; 3];
        force[dof.variable.offset()] = push.force;
        if push.second {
            *second = add(*second, force);
        } else {
            let arm = sub(self.part.nodes.current[dof.node as usize], self.centre);
            (*first, *moment) = (add(*first, force), add(*moment, cross(arm, force)));
        }
    }

    /// The sums over all ranks; collective.
    fn finish(self, part: &ModelPart) -> Vec<PairBalance> {
        let mut flat: Vec<f64> = self.sums.into_iter().flatten().flatten().collect();
        part.ranks.sum(&mut flat);
        let mut out = Vec::with_capacity(self.states.len());
        for (state, sums) in self.states.into_iter().zip(flat.chunks_exact(9)) {
            let vector = |at: usize| [sums[3 * at], sums[3 * at + 1], sums[3 * at + 2]];
            let (mut force, mut moment) = (vector(0), vector(1));
            for (node, of_constraint) in state.constraint_forces {
                let arm = sub(part.nodes.current[node as usize], self.centre);
                (force, moment) = (add(force, of_constraint), add(moment, cross(arm, of_constraint)));
            }
            out.push(PairBalance {
                name: state.name,
                force,
                moment,
                out_of_balance: add(vector(0), vector(2)),
                open: state.open,
                sticking: state.sticking,
                slipping: state.slipping,
                penetration: state.deepest.map_or(0.0, |(_, depth)| depth),
                penetration_node: state.deepest.map(|(node, _)| part.nodes.ids[node as usize]),
                dissipated: state.dissipated,
            });
        }
        out
    }
}

/// The forces of each kind over all unknowns, those of linear constraints with those of interactions; those of elements are the
/// remainder of the residual. Collective.
fn forces(
    part: &ModelPart,
    system: &System,
    assembler: &mut Assembler,
    residual: &[f64],
    inertia: Option<&Inertia>,
    more: Option<&[f64]>,
    pairs: &mut Pairs<'_>,
) -> Result<Forces> {
    let mut loads = assembler.external_forces(part, system)?;
    loads.iter_mut().zip(more.into_iter().flatten()).for_each(|(load, more)| *load += more);
    let mut interactions = assembler.exchanged(part, system, |push| pairs.push(system, push))?;
    let taken_up = inertia.map(|inertia| assembler.inertia_forces(part, system, inertia)).transpose()?;
    let mut inertia = assembler.storage(part, system)?;
    inertia.iter_mut().zip(taken_up.into_iter().flatten()).for_each(|(own, taken)| *own -= taken);
    let others = loads.iter().zip(&interactions).zip(&inertia);
    let elements = residual.iter().zip(others).map(|(r, ((load, push), inertia))| r - load - push - inertia).collect();
    let equations = assembler.equations();
    let reactions = equations.forces_of_supports(residual);
    if equations.has_slaves() {
        // The residual that supports leave is the force of constraints.
        let left = residual.iter().zip(&reactions).map(|(r, reaction)| r + reaction);
        interactions.iter_mut().zip(left).for_each(|(own, left)| *own -= left);
    }
    Ok([loads, elements, interactions, inertia, reactions])
}

/// The sums over the nodes of all ranks, for each unknown that has reactions; without nodes of relative motions, whose forces act between
/// two sides. Collective.
fn sums(
    part: &ModelPart,
    system: &System,
    residual: &[f64],
    forces: &Forces,
    pairs: &[PairBalance],
    centre: [f64; 3],
) -> Vec<UnknownBalance> {
    let with_reactions = |v: &ScalarVariable| Rates::of(v.column).is_some_and(|rates| rates.reaction.is_some());
    let variables: Vec<ScalarVariable> = system.dofs.variables().filter(with_reactions).collect();
    let mut columns: Vec<&'static str> = variables.iter().map(|variable| variable.column).collect();
    columns.dedup();
    // Forces and moments of each kind, and of the remainder.
    let mut all = vec![[[[0.0; 3]; 2]; KINDS + 1]; columns.len()];
    // Input and output by loads and supports, and the moments of both as absolute values: supports that push against each other alone
    // add up to nothing, beside which all is large.
    let mut through = vec![[0.0; 3]; columns.len()];
    for variable in variables {
        let at = columns.iter().position(|column| *column == variable.column).expect("one of them");
        let (of_column, [entering, leaving, moments]) = (&mut all[at], &mut through[at]);
        let c = variable.offset();
        for n in system.dofs.of_variable(variable) {
            let node = system.dofs.dofs()[n].node as usize;
            if !part.owns_node(node) || part.nodes.flags.is(RELATIVE, node) {
                continue;
            }
            let arm = sub(part.nodes.current[node], centre);
            let left = residual[n] + forces[REACTIONS][n];
            for own in [forces[LOADS][n], forces[REACTIONS][n]] {
                *entering += own.max(0.0);
                *leaving += (-own).max(0.0);
                *moments += norm(arm) * own.abs();
            }
            let values = forces.iter().map(|of_kind| of_kind[n]).chain([left]);
            for ([force, moment], value) in of_column.iter_mut().zip(values) {
                force[c] += value;
                let [y, z] = [(c + 1) % 3, (c + 2) % 3];
                moment[y] += arm[z] * value;
                moment[z] -= arm[y] * value;
            }
        }
    }
    let mut flat: Vec<f64> = all.iter().flatten().flatten().flatten().copied().collect();
    part.ranks.sum(&mut flat);
    part.ranks.sum(through.as_flattened_mut());
    let size = flat.len() / columns.len().max(1);
    let of_columns = columns.iter().zip(through).zip(flat.chunks_exact(size.max(1)));
    of_columns
        .map(|((column, [entering, leaving, moments]), flat)| {
            let moves = Rates::of(column).is_some_and(|rates| rates.moves_mesh);
            let pairs = if moves { pairs } else { &[] };
            let between = pairs.iter().map(|pair| pair.out_of_balance).fold([0.0; 3], add);
            let vectors = |which: usize| {
                let vector = |kind: usize| std::array::from_fn(|c| flat[6 * kind + 3 * which + c]);
                std::array::from_fn(vector)
            };
            let (pushing, turned) =
                (pairs.iter().map(|pair| norm(pair.force)), pairs.iter().map(|pair| norm(pair.moment)));
            let forces = BalanceTerms::of(vectors(0), between, pushing.chain([entering.max(leaving)]));
            let moments = BalanceTerms::of(vectors(1), [0.0; 3], turned.chain([moments]));
            let moments = moves.then_some(moments);
            let flows = Flows { entering, leaving, stored: -forces.inertia.iter().sum::<f64>() };
            UnknownBalance { unknown: (*column).to_owned(), forces, moments, centre, flows: (!moves).then_some(flows) }
        })
        .collect()
}

impl BalanceTerms {
    /// The kinds with the remainder, to which `between` is added; `others` are sizes to compare with.
    fn of(kinds: [[f64; 3]; KINDS + 1], between: [f64; 3], others: impl Iterator<Item = f64>) -> Self {
        let [loads, elements, interactions, inertia, reactions, left] = kinds;
        let out_of_balance = add(left, between);
        let largest = kinds[..KINDS].iter().map(|kind| norm(*kind)).chain(others).fold(0.0, f64::max);
        let relative = if largest > 0.0 { norm(out_of_balance) / largest } else { 0.0 };
        Self { loads, reactions, elements, interactions, inertia, out_of_balance, relative }
    }
}

/// The centre of the box around the initial mesh of all ranks; collective.
fn centre(part: &ModelPart) -> [f64; 3] {
    let [low, high] = mesh_box(part);
    std::array::from_fn(|c| 0.5 * (low[c] + high[c])).map(|x: f64| if x.is_finite() { x } else { 0.0 })
}
