//! What a block has of its pairs, whatever their family: nodes, positions, operators.

use std::ops::Range;
use std::sync::Arc;

use zelus_core::entities::{LocalUnknown, StepView};
use zelus_core::geometry::{FacetShape, NodeArray};
use zelus_core::model::{EntityKind, ScalarVariable};
use zelus_core::scalar::Dual;
use zelus_core::vector3::{add, scale};
use zelus_structural_mechanics::variables::DISPLACEMENT;

use super::contact_block::Present;
use super::family::PairRequest;
use super::in_parallel::in_parallel;
use super::known_operators::KnownOperators;
use super::pair::{Integral, Pair, Previous};
use crate::formulations::{Augmentation, Multiplier, NormalVariation, SlaveNode, StepParameters};
use crate::interface::{Corner, NormalPatches};
use crate::mortar::{Operators, Overlap, PairGeometry, choices_of, operators, weighted_gap};
use crate::slave_states::SlaveStates;

/// Pairs of two shapes.
///
/// It knows no formulation: blocks of all families share its code, which is compiled once for two shapes. The local unknowns
/// of a pair are those that [`formulations`](crate::formulations) state; nodes around it follow as columns, for they turn its normals.
pub(super) struct PairsOfShapes<S: FacetShape, M: FacetShape> {
    /// The registered condition.
    pub entry: &'static EntityKind,
    /// The pairs.
    pub pairs: Vec<Pair>,
    /// Settings and numbers of the step.
    pub parameters: Arc<StepParameters>,
    /// The states in which the assembly evaluates the pairs.
    pub states: Arc<SlaveStates>,
    /// Unknowns of a pair.
    pub unknowns: Vec<LocalUnknown>,
    /// Of each pair what was computed last; none for any before that.
    known: Vec<Option<KnownOperators<S, M>>>,
    nodes: Vec<u32>,
    around: usize,
    patches: Arc<NormalPatches>,
}

/// What a formulation adds to the integral of a pair that overlaps, as it stands with these operators.
pub(super) type Addition<'a, S, M> =
    &'a (dyn Fn(usize, &PairGeometry<f64, S, M>, Operators<f64, S, M>, &mut Integral) + Sync);

impl<S: FacetShape, M: FacetShape> PairsOfShapes<S, M> {
    /// The pairs of a request, with these multipliers.
    pub(super) fn new(request: PairRequest, multiplier: Multiplier) -> Self {
        let PairRequest { entry, pairs, nodes, around, patches, parameters, states, .. } = request;
        let unknowns = local_unknowns(around, [M::NODES, S::NODES], S::SPACE, &multiplier.unknowns(S::SPACE));
        Self { entry, pairs, parameters, states, unknowns, known: Vec::new(), nodes, around, patches }
    }

    /// Nodes of the `at`-th pair: those around it, master nodes, slave nodes.
    pub(super) fn nodes(&self, at: usize) -> &[u32] {
        let size = self.around + M::NODES + S::NODES;
        &self.nodes[at * size..(at + 1) * size]
    }

    /// Rows of a pair. Nodes around it turn its normals; it pushes none of them.
    pub(super) fn equations(&self) -> usize {
        self.unknowns.len() - S::SPACE * self.around
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

    /// Node indices on the slave side of the `at`-th pair.
    pub(super) fn slave_nodes(&self, at: usize) -> &[u32] {
        &self.nodes(at)[self.around + M::NODES..]
    }

    fn masters(&self, at: usize) -> M::Nodal<u32> {
        let nodes = &self.nodes(at)[self.around..];
        M::nodal(|n| nodes[n])
    }

    /// As [`PairsOfShapes::slave_nodes`].
    pub(super) fn slaves(&self, at: usize) -> S::Nodal<u32> {
        let nodes = self.slave_nodes(at);
        S::nodal(|n| nodes[n])
    }

    /// The `at`-th pair as it stands.
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

    /// The `at`-th pair as it stood in the last accepted state.
    pub(super) fn previous(&self, at: usize, view: &StepView<'_>, states: &SlaveStates) -> PairGeometry<f64, S, M> {
        let displacement = view.nodes.history.get(DISPLACEMENT.name()).expect("displacements are unknowns");
        let back = self.parameters.levels_back.min(displacement.levels.len() - 1);
        let position = |n: u32| add(view.nodes.initial[n as usize], displacement.vector(back, n as usize));
        PairGeometry {
            slave: S::map(&self.slaves(at), position),
            master: M::map(&self.masters(at), position),
            ..self.geometry(at, view, states)
        }
    }

    /// Constants of the slave nodes of the `at`-th pair.
    pub(super) fn slave_constants(&self, at: usize, states: &SlaveStates) -> S::Nodal<SlaveNode> {
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
    pub(super) fn operators_of(&self, at: usize, geometry: &PairGeometry<f64, S, M>) -> Overlap<Operators<f64, S, M>> {
        let known = self.known.get(at).and_then(|known| known.as_ref()?.of(geometry));
        known.unwrap_or_else(|| operators(geometry, &self.parameters.segmentation))
    }

    /// The pair in the present state with its operators, if it is this rank's.
    fn operators_now(&self, at: usize, present: Present<'_>) -> Option<KnownOperators<S, M>> {
        let geometry = (present.own)(self.nodes(at)).then(|| self.geometry(at, present.view, present.states))?;
        Some(KnownOperators { geometry, found: self.operators_of(at, &geometry) })
    }

    /// Computes the operators of this rank's pairs in the present state.
    pub(super) fn find_operators(&mut self, present: Present<'_>) {
        self.known = in_parallel(self.pairs.len(), &|at| self.operators_now(at, present));
    }

    /// Gap and area of every pair, and what a formulation adds to those that overlap.
    pub(super) fn integrate(&self, present: Present<'_>, add: Addition<'_, S, M>) -> Vec<Integral> {
        in_parallel(self.pairs.len(), &|at| {
            let mut out = Integral::default();
            let Some(KnownOperators { geometry, found }) = self.operators_now(at, present) else { return out };
            out.facing = !matches!(found, Overlap::None);
            if let Overlap::Cells(operators) = found {
                out.overlapping = true;
                let gaps = weighted_gap(&operators, &geometry.slave, &geometry.master, &geometry.nodal_normals);
                for j in 0..S::NODES {
                    out.area[j] = operators.d[j].iter().sum();
                    out.gap[j] = gaps[j];
                }
                add(at, &geometry, operators, &mut out);
            }
            out
        })
    }

    /// Keeps the operators of the pairs of this rank against which slip is measured.
    pub(super) fn keep_operators(&mut self, present: Present<'_>) {
        let kept = |at: usize| {
            let found = self.operators_now(at, present).and_then(|now| now.found.cells());
            found.map_or_else(Previous::default, |found| Previous::of(&found))
        };
        let kept = in_parallel(self.pairs.len(), &kept);
        self.pairs.iter_mut().zip(kept).for_each(|(pair, operators)| pair.previous = operators);
    }

    /// Freezes the choices of the integration of this rank's pairs.
    pub(super) fn freeze_choices(&mut self, present: Present<'_>) {
        let choices = |at: usize| {
            let KnownOperators { geometry, found } = self.operators_now(at, present)?;
            Some(choices_of(&geometry, &self.parameters.segmentation, &found.cells()?))
        };
        let choices = |at: usize| choices(at).unwrap_or(self.pairs[at].choices);
        let choices = in_parallel(self.pairs.len(), &choices);
        self.pairs.iter_mut().zip(choices).for_each(|(pair, choices)| pair.choices = choices);
    }
}

/// The unknowns of a pair: displacements of its masters and slaves, multipliers of its slaves, displacements of those around it.
fn local_unknowns(
    around: usize,
    [masters, slaves]: [usize; 2],
    dim: usize,
    multipliers: &[ScalarVariable],
) -> Vec<LocalUnknown> {
    let displacements = |nodes: Range<usize>| {
        nodes.flat_map(move |node| {
            (0..dim as u8).map(move |c| LocalUnknown::of_node(node as u8, DISPLACEMENT.component(c)))
        })
    };
    let end = around + masters + slaves;
    let mut unknowns: Vec<LocalUnknown> = displacements(around..end).collect();
    for node in around + masters..end {
        unknowns.extend(multipliers.iter().map(|&variable| LocalUnknown::of_node(node as u8, variable)));
    }
    unknowns.extend(displacements(0..around));
    unknowns
}
