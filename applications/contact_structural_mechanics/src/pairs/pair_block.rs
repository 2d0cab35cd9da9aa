//! A block of pairs of one family and one pair of shapes.

use std::ops::Range;
use std::sync::Arc;

use zelus_core::entities::{EntityBlock, EntityError, LocalSystems, LocalUnknown, StepView, Tangent, Want};
use zelus_core::geometry::{FacetShape, NodeArray, Shape};
use zelus_core::model::{EntityKind, ScalarVariable};
use zelus_core::scalar::Dual;
use zelus_core::vector3::{add, scale};
use zelus_structural_mechanics::variables::DISPLACEMENT;

use super::contact_block::{ContactBlock, Present};
use super::family::PairRequest;
use super::in_parallel::in_parallel;
use super::known_operators::KnownOperators;
use super::pair::{Integral, Pair, Previous};
use crate::formulations::{
    self, Augmentation, Formulation, Kinematics, NormalVariation, PairHistory, SlaveNode, StepParameters,
};
use crate::interface::{Corner, NormalPatches};
use crate::kratos::FirstIterateTangent;
use crate::mortar::shapes::for_shapes;
use crate::mortar::{Operators, Overlap, PairGeometry, choices_of, lanes, operators, weighted_gap};
use crate::slave_states::SlaveStates;

/// The block of a formulation for a pair of shapes (slave, master); `None` for shapes that carry no contact.
pub(super) fn pair_block<F: Formulation>(
    slave: Shape,
    master: Shape,
    request: PairRequest,
) -> Option<Box<dyn ContactBlock>> {
    macro_rules! make {
        ($slave:ty, $master:ty, $end:literal) => {{
            const NU: usize = lanes::<$slave, $master>(PairGeometry::<f64, $slave, $master>::UNKNOWNS);
            const NN: usize = lanes::<$slave, $master>(PairGeometry::<f64, $slave, $master>::NORMALS);
            PairBlock::<F, $slave, $master, NU, NN>::boxed(request)
        }};
    }
    for_shapes!(slave, master, make)
}

/// Pairs of two shapes, differentiated by `NU` displacement unknowns and by `NN` components of nodal normals at once.
///
/// Their rows are those of the formulation; nodes around a pair follow as columns, for they turn its normals.
pub struct PairBlock<F, S: FacetShape, M: FacetShape, const NU: usize, const NN: usize> {
    entry: &'static EntityKind,
    pairs: Vec<Pair>,
    /// Of each pair what was computed last; none for any before that.
    known: Vec<Option<KnownOperators<S, M>>>,
    nodes: Vec<u32>,
    around: usize,
    patches: Arc<NormalPatches>,
    parameters: Arc<StepParameters>,
    states: Arc<SlaveStates>,
    formulation: F,
    unknowns: Vec<LocalUnknown>,
}

impl<F: Formulation, S: FacetShape, M: FacetShape, const NU: usize, const NN: usize> PairBlock<F, S, M, NU, NN> {
    /// The block of a request.
    pub fn boxed(request: PairRequest) -> Box<dyn ContactBlock> {
        let formulation = F::new(&request.parameters);
        Box::new(Self::new(request, formulation))
    }

    /// The block of a request with this formulation.
    pub(super) fn new(request: PairRequest, formulation: F) -> Self {
        let PairRequest { entry, pairs, nodes, around, patches, parameters, states, .. } = request;
        let dim = S::SPACE;
        let displacements = |nodes: Range<usize>| {
            nodes.flat_map(move |node| {
                (0..dim as u8).map(move |c| LocalUnknown { node: node as u8, variable: DISPLACEMENT.component(c) })
            })
        };
        let mut unknowns: Vec<LocalUnknown> = displacements(around..around + M::NODES + S::NODES).collect();
        let multipliers: Vec<ScalarVariable> = F::MULTIPLIER.unknowns(dim);
        for node in around + M::NODES..around + M::NODES + S::NODES {
            unknowns.extend(multipliers.iter().map(|&variable| LocalUnknown { node: node as u8, variable }));
        }
        unknowns.extend(displacements(0..around));
        let known = Vec::new();
        Self { entry, pairs, known, nodes, around, patches, parameters, states, formulation, unknowns }
    }

    pub(super) fn parameters(&self) -> &StepParameters {
        &self.parameters
    }

    pub(super) fn formulation(&self) -> &F {
        &self.formulation
    }

    /// Row of the first displacement of a node of the `at`-th pair.
    pub(super) fn first_row(&self, at: usize, node: u32) -> usize {
        let dim = S::SPACE;
        let place = self.nodes(at).iter().rposition(|&n| n == node).expect("the node belongs to the pair");
        match place.checked_sub(self.around) {
            Some(place) => dim * place,
            None => self.unknowns.len() - dim * (self.around - place),
        }
    }

    fn first(&self, at: usize) -> usize {
        at * (self.around + M::NODES + S::NODES) + self.around
    }

    fn masters(&self, at: usize) -> M::Nodal<u32> {
        M::nodal(|n| self.nodes[self.first(at) + n])
    }

    pub(super) fn slaves(&self, at: usize) -> S::Nodal<u32> {
        S::nodal(|n| self.nodes[self.first(at) + M::NODES + n])
    }

    pub(super) fn states(&self) -> &SlaveStates {
        &self.states
    }

    pub(super) fn geometry(&self, at: usize, view: &StepView<'_>, states: &SlaveStates) -> PairGeometry<f64, S, M> {
        let pair = &self.pairs[at];
        PairGeometry {
            slave: S::map(&self.slaves(at), |n| view.nodes.current[n as usize]),
            master: M::map(&self.masters(at), |n| view.nodes.current[n as usize]),
            nodal_normals: S::map(&self.slaves(at), |n| states[n].normal),
            slave_normal: pair.slave_normal,
            master_normal: pair.master_normal,
            choices: pair.choices,
        }
    }

    /// The pair with displacements from the one numbered `first` on as variables, and normals of facets too where the settings
    /// ask for it.
    pub(super) fn seeded<const LANES: usize>(
        &self,
        geometry: &PairGeometry<f64, S, M>,
        first: usize,
    ) -> PairGeometry<Dual<LANES>, S, M> {
        let mut seeded = geometry.seeded_from::<LANES>(first);
        if self.parameters.normal_variation.knows_facets() {
            seeded.slave_normal = S::unit_normal(&seeded.slave, S::CENTRE);
            seeded.master_normal = M::unit_normal(&seeded.master, M::CENTRE);
        }
        seeded
    }

    /// Adds to the tangent of a pair what the turning of its nodal normals does: −∂b/∂n ∂n/∂x.
    fn add_turning(
        &self,
        at: usize,
        view: &StepView<'_>,
        geometry: &PairGeometry<f64, S, M>,
        nodes: &S::Nodal<SlaveNode>,
        multipliers: &S::Nodal<[f64; 3]>,
        history: &F::History<S, M>,
        (lhs, width): (&mut [f64], usize),
    ) {
        let (rows, count) = (self.equations(), PairGeometry::<f64, S, M>::NORMALS);
        let mut by_normals = vec![0.0; rows * count];
        let keep = |row: usize, first: usize, derivatives: &[f64]| {
            let at = row * count + first;
            by_normals[at..at + derivatives.len()].copy_from_slice(derivatives);
        };
        formulations::by_normals::<_, _, _, NN>(
            &self.formulation,
            geometry,
            &self.parameters.segmentation,
            nodes,
            multipliers,
            history,
            keep,
        );
        self.spread_turning(at, view, &by_normals, (lhs, width));
    }

    /// Adds −∂b/∂n ∂n/∂x to the first rows of a tangent, whose ∂b/∂n are given, row by row.
    pub(super) fn spread_turning(
        &self,
        at: usize,
        view: &StepView<'_>,
        by_normals: &[f64],
        (lhs, width): (&mut [f64], usize),
    ) {
        let dim = S::SPACE;
        let own = self.pairs[at].key;
        let whole = self.parameters.normal_variation == NormalVariation::Exact;
        let knows = |corner: &Corner| whole || corner.facet == [own.interface, own.slave];
        // By column, how the normal of a node turns: several facets tell of the same neighbour.
        let mut turning: Vec<(usize, [[f64; 3]; 3])> = Vec::with_capacity(self.nodes(at).len());
        for (j, node) in self.slaves(at).into_iter().enumerate() {
            if self.states[node].normal_of_master {
                continue;
            }
            turning.clear();
            self.patches.variation(node, &view.nodes.current, &knows, &mut |by, matrix| {
                let column = self.first_row(at, by);
                match turning.iter_mut().find(|(known, _)| *known == column) {
                    Some((_, sum)) => (0..dim).for_each(|r| (0..dim).for_each(|c| sum[r][c] += matrix[r][c])),
                    None => turning.push((column, matrix)),
                }
            });
            for (row, derivatives) in by_normals.chunks_exact(PairGeometry::<f64, S, M>::NORMALS).enumerate() {
                let by_normal: [f64; 3] = std::array::from_fn(|r| if r < dim { derivatives[dim * j + r] } else { 0.0 });
                let lhs = &mut lhs[row * width..(row + 1) * width];
                for (column, matrix) in &turning {
                    let entries = &mut lhs[*column..*column + dim];
                    for (c, entry) in entries.iter_mut().enumerate() {
                        *entry -= (0..dim).map(|r| by_normal[r] * matrix[r][c]).sum::<f64>();
                    }
                }
            }
        }
    }

    pub(super) fn previous(&self, at: usize, view: &StepView<'_>, states: &SlaveStates) -> PairGeometry<f64, S, M> {
        let displacement = &view.nodes.history.get(DISPLACEMENT.name()).expect("displacements are unknowns").levels;
        let back = &displacement[self.parameters.levels_back.min(displacement.len() - 1)];
        let position = |n: u32| {
            let u = vector(back, n);
            let initial = view.nodes.initial[n as usize];
            std::array::from_fn(|c| initial[c] + u[c])
        };
        PairGeometry {
            slave: S::map(&self.slaves(at), position),
            master: M::map(&self.masters(at), position),
            ..self.geometry(at, view, states)
        }
    }

    /// Constants of the slave nodes of the `at`-th pair.
    fn slave_constants(&self, at: usize, states: &SlaveStates) -> S::Nodal<SlaveNode> {
        let positive = |area: f64| if area > 0.0 { area } else { 1.0 };
        // The bounds of pairs that augment have gaps of their own, which add up to zero if all count alike.
        let by_pair = self.parameters.augmentation == Augmentation::Pair;
        let own = self.pairs[at].area;
        let k = self.parameters.scale_factor;
        let slaves = self.slaves(at);
        S::nodal(|j| {
            let node = &states[slaves[j]];
            let area = positive(node.area);
            // On a part of a facet of second order the share of a corner may be below zero; over all pairs they add up to the area.
            let share = if node.area > 0.0 { own[j] } else { positive(own[j]) };
            let stiffness = self.parameters.nodal_stiffness(node.penalty, area);
            SlaveNode {
                state: node.contact(),
                penalty: node.penalty,
                compliance: if self.parameters.compliant { node.penalty.recip() } else { 0.0 },
                kept: node.kept_pressure,
                stiffness,
                area: if by_pair { area } else { share },
                dynamic_factor: node.dynamic_factor,
                friction: node.friction,
                tangent: node.tangent,
                turning: node.turning,
                held: node.held,
                held_weight: k * k * area / stiffness,
                carried: node.last.carried,
                traction: add(node.carried, scale(node.normal, node.penalty * (node.weighted_gap / area))),
            }
        })
    }

    /// The operators of a pair that stands like this; known ones, or else new ones.
    fn operators_of(&self, at: usize, geometry: &PairGeometry<f64, S, M>) -> Overlap<Operators<f64, S, M>> {
        let known = self.known.get(at).and_then(|known| known.as_ref()?.of(geometry));
        known.unwrap_or_else(|| operators(geometry, &self.parameters.segmentation))
    }

    /// The pair in the present state with its operators, if it is this rank's.
    fn operators_now(&self, at: usize, present: Present<'_>) -> Option<KnownOperators<S, M>> {
        let geometry = (present.own)(self.nodes(at)).then(|| self.geometry(at, present.view, present.states))?;
        Some(KnownOperators { geometry, found: self.operators_of(at, &geometry) })
    }

    fn multipliers(&self, at: usize, view: &StepView<'_>) -> S::Nodal<[f64; 3]> {
        S::map(&self.slaves(at), |n| F::MULTIPLIER.value(view.nodes, n))
    }
}

fn vector(column: &[f64], node: u32) -> [f64; 3] {
    let at = 3 * node as usize;
    [column[at], column[at + 1], column[at + 2]]
}

impl<F: Formulation, S: FacetShape, M: FacetShape, const NU: usize, const NN: usize> EntityBlock
    for PairBlock<F, S, M, NU, NN>
{
    fn entry(&self) -> &'static EntityKind {
        self.entry
    }

    fn members(&self) -> &[u32] {
        &[]
    }

    fn len(&self) -> usize {
        self.pairs.len()
    }

    fn nodes(&self, at: usize) -> &[u32] {
        let size = self.around + M::NODES + S::NODES;
        &self.nodes[at * size..(at + 1) * size]
    }

    fn unknowns(&self) -> &[LocalUnknown] {
        &self.unknowns
    }

    /// Nodes around a pair turn its normals; it pushes none of them.
    fn equations(&self) -> usize {
        self.unknowns.len() - S::SPACE * self.around
    }

    fn tangent(&self) -> Tangent {
        Tangent::General
    }

    fn is_active(&self, at: usize, _view: &StepView<'_>) -> bool {
        self.pairs[at].overlapping
    }

    fn local_systems(
        &self,
        view: &StepView<'_>,
        range: Range<usize>,
        want: Want,
        out: &mut LocalSystems,
    ) -> Result<(), EntityError> {
        for (slot, at) in range.enumerate() {
            if !self.pairs[at].overlapping {
                continue;
            }
            let geometry = self.geometry(at, view, &self.states);
            let nodes = self.slave_constants(at, &self.states);
            let multipliers = self.multipliers(at, view);
            let history = F::History::of(self.pairs[at].previous.operators(), &self.previous(at, view, &self.states));
            let settings = &self.parameters.segmentation;
            let (width, rows) = (out.size, self.equations());
            let (lhs, rhs) = out.entity(slot);
            let rhs = &mut rhs[..rows];
            if want == Want::Both {
                let lhs = &mut lhs[..rows * width];
                formulations::tangent(
                    &self.formulation,
                    |first| self.seeded::<NU>(&geometry, first),
                    settings,
                    FirstIterateTangent::of(view, S::SPACE),
                    &nodes,
                    &multipliers,
                    &history,
                    (lhs, width),
                    rhs,
                );
                let acts = nodes.iter().any(|node| node.state.is_active());
                if acts && self.parameters.normal_variation.knows_nodes() {
                    self.add_turning(at, view, &geometry, &nodes, &multipliers, &history, (lhs, width));
                }
            } else {
                let found = self.operators_of(at, &geometry);
                formulations::residual(&self.formulation, &geometry, found, &nodes, &multipliers, &history, rhs);
            }
        }
        Ok(())
    }
}

impl<F: Formulation, S: FacetShape, M: FacetShape, const NU: usize, const NN: usize> ContactBlock
    for PairBlock<F, S, M, NU, NN>
{
    fn pairs(&self) -> &[Pair] {
        &self.pairs
    }

    fn pairs_mut(&mut self) -> &mut [Pair] {
        &mut self.pairs
    }

    fn slave_nodes(&self, at: usize) -> &[u32] {
        &self.nodes[self.first(at) + M::NODES..self.first(at) + M::NODES + S::NODES]
    }

    fn set_states(&mut self, states: Arc<SlaveStates>) {
        self.states = states;
    }

    fn find_operators(&mut self, present: Present<'_>) {
        self.known = in_parallel(self.pairs.len(), &|at| self.operators_now(at, present));
    }

    fn integrate(&self, present: Present<'_>) -> Vec<Integral> {
        let Present { view, states, .. } = present;
        in_parallel(self.pairs.len(), &|at| {
            let mut out = Integral::default();
            let Some(KnownOperators { geometry, found }) = self.operators_now(at, present) else { return out };
            out.facing = !matches!(found, Overlap::None);
            if let Overlap::Cells(operators) = found {
                out.overlapping = true;
                let gaps = weighted_gap(&operators, &geometry.slave, &geometry.master, &geometry.nodal_normals);
                let history = F::History::of(self.pairs[at].previous.operators(), &self.previous(at, view, states));
                let pair = Kinematics {
                    operators,
                    slave: geometry.slave,
                    master: geometry.master,
                    normals: geometry.nodal_normals,
                    multipliers: S::nodal(|_| [0.0; 3]),
                };
                let slip = self.formulation.weighted_slip(&pair, &history);
                let trial = self.formulation.weighted_trial(&pair, &self.slave_constants(at, states), &history);
                for j in 0..S::NODES {
                    out.area[j] = operators.d[j].iter().sum();
                    out.gap[j] = gaps[j];
                    out.slip[j] = slip[j];
                    out.trial[j] = trial.map_or([0.0; 3], |trial| trial[j]);
                }
            }
            out
        })
    }

    fn keep_operators(&mut self, present: Present<'_>) {
        let kept = |at: usize| {
            let found = self.operators_now(at, present).and_then(|now| now.found.cells());
            found.map_or_else(Previous::default, |found| Previous::of(&found))
        };
        let kept = in_parallel(self.pairs.len(), &kept);
        self.pairs.iter_mut().zip(kept).for_each(|(pair, operators)| pair.previous = operators);
    }

    fn freeze_choices(&mut self, present: Present<'_>) {
        let choices = |at: usize| {
            let KnownOperators { geometry, found } = self.operators_now(at, present)?;
            Some(choices_of(&geometry, &self.parameters.segmentation, &found.cells()?))
        };
        let choices = |at: usize| choices(at).unwrap_or(self.pairs[at].choices);
        let choices = in_parallel(self.pairs.len(), &choices);
        self.pairs.iter_mut().zip(choices).for_each(|(pair, choices)| pair.choices = choices);
    }

    fn as_entities(&self) -> &dyn EntityBlock {
        self
    }
}
