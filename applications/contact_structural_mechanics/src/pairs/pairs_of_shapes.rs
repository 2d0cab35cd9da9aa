//! Nodes, positions and operators of the pairs of a block, whatever their law.

use std::ops::Range;
use std::sync::Arc;

use zelus_core::entities::{LocalUnknown, StepView};
use zelus_core::geometry::{ExactFacet, FacetShape, Nodal};
use zelus_core::model::{EntityKind, ScalarVariable};
use zelus_core::parallel;
use zelus_core::vector3::{add, scale};
use zelus_structural_mechanics::variables::DISPLACEMENT;

use super::contact_block::IntegrationState;
use super::grouping::PAIRS;
use super::kinematics::PairHistory;
use super::known_operators::KnownOperators;
use super::pair::{Integral, Pair, Previous};
use super::pair_request::PairRequest;
use crate::interface::{FacetCorner, NormalPatches, SlaveIndex};
use crate::law::{Augmentation, Multiplier, NormalVariation, SlaveNode, StepParameters};
use crate::mortar::{Active, Operators, Overlap, PairGeometry, choices_of, operators, weighted_gap};
use crate::slave_nodes::SlaveStates;

/// Pairs of two shapes.
///
/// It knows no law: blocks of all formulations share its code. The local unknowns of a pair are those of
/// [`PairSystem`](super::PairSystem); nodes around it follow as columns, for they rotate its normals.
pub(super) struct PairsOfShapes {
    /// The registered condition.
    pub entry: &'static EntityKind,
    /// Shape of the slave facets.
    pub slave: &'static FacetShape,
    /// Shape of the master facets.
    pub master: &'static FacetShape,
    /// Exact surfaces of the masters, one a pair; none for masters of elements.
    exact: Vec<Arc<(ExactFacet, u32)>>,
    /// The pairs.
    pub pairs: Vec<Pair>,
    /// Settings and numbers of the step.
    pub parameters: Arc<StepParameters>,
    /// The states in which the assembly evaluates the pairs.
    pub states: Arc<SlaveStates>,
    /// Unknowns of a pair.
    pub unknowns: Vec<LocalUnknown>,
    /// Cached operators of each pair; `None` before the first evaluation.
    known: Vec<Option<KnownOperators>>,
    nodes: Vec<u32>,
    slaves: Vec<SlaveIndex>,
    owners: Vec<u32>,
    around: usize,
    patches: Arc<NormalPatches>,
}

/// Contribution of a law to the integral of a pair that overlaps, as it stands with these operators.
pub(super) type Addition<'a> = &'a (dyn Fn(usize, &PairGeometry<f64>, &Operators<f64>, &mut Integral) + Sync);

impl PairsOfShapes {
    /// The pairs of a request, with these multipliers.
    ///
    /// # Panics
    /// If the shapes are not those of facets.
    pub(super) fn new(request: PairRequest, multiplier: Multiplier) -> Self {
        let PairRequest {
            entry,
            slave,
            master,
            exact,
            pairs,
            nodes,
            slaves,
            owners,
            around,
            patches,
            parameters,
            states,
            ..
        } = request;
        let [slave, master] = [slave, master].map(|shape| FacetShape::of(shape).expect("pairs are made of facets"));
        let master =
            if exact.is_empty() { master } else { master.and_apex().expect("facets of exact surfaces are linear") };
        let counts = [master.nodes, slave.nodes];
        let unknowns = local_unknowns(around, counts, slave.space, &multiplier.unknowns(slave.space));
        Self {
            entry,
            slave,
            master,
            exact,
            pairs,
            parameters,
            states,
            unknowns,
            known: Vec::new(),
            nodes,
            slaves,
            owners,
            around,
            patches,
        }
    }

    /// Nodes of the `at`-th pair: those around it, master nodes, slave nodes.
    pub(super) fn nodes(&self, at: usize) -> &[u32] {
        let size = self.around + self.master.nodes + self.slave.nodes;
        &self.nodes[at * size..(at + 1) * size]
    }

    /// Rows of a pair. Nodes around it turn its normals; it pushes none of them.
    pub(super) fn equations(&self) -> usize {
        self.unknowns.len() - self.slave.space * self.around
    }

    /// Row of the first displacement of a node of the `at`-th pair.
    pub(super) fn first_row(&self, at: usize, node: u32) -> usize {
        let dim = self.slave.space;
        let place = self.nodes(at).iter().rposition(|&n| n == node).expect("the node belongs to the pair");
        match place.checked_sub(self.around) {
            Some(place) => dim * place,
            None => self.unknowns.len() - dim * (self.around - place),
        }
    }

    /// Slave nodes of the `at`-th pair.
    pub(super) fn slaves(&self, at: usize) -> &[SlaveIndex] {
        let count = self.slave.nodes;
        &self.slaves[at * count..(at + 1) * count]
    }

    /// Owners of the multipliers of the `at`-th pair.
    pub(super) fn owners(&self, at: usize) -> &[u32] {
        let count = self.slave.nodes;
        if self.owners.is_empty() { &[] } else { &self.owners[at * count..(at + 1) * count] }
    }

    /// Mesh nodes of the slave facet of the `at`-th pair.
    pub(super) fn slave_nodes(&self, at: usize) -> &[u32] {
        &self.nodes(at)[self.around + self.master.nodes..]
    }

    pub(super) fn master_nodes(&self, at: usize) -> &[u32] {
        &self.nodes(at)[self.around..self.around + self.master.nodes]
    }

    /// The `at`-th pair as it stands.
    pub(super) fn geometry(&self, at: usize, view: &StepView<'_>, states: &SlaveStates) -> PairGeometry<f64> {
        let (pair, slaves, masters) = (&self.pairs[at], self.slave_nodes(at), self.master_nodes(at));
        PairGeometry {
            slave_shape: self.slave,
            master_shape: self.master,
            slave: Nodal::new(slaves.len(), |j| view.nodes.current[slaves[j] as usize]),
            master: Nodal::new(masters.len(), |l| view.nodes.current[masters[l] as usize]),
            nodal_normals: Nodal::new(slaves.len(), |j| states[self.slaves(at)[j]].kinematics.normal),
            slave_normal: pair.slave_normal,
            master_normal: pair.master_normal,
            exact: self.exact.get(at).map(|exact| exact.0),
            choices: pair.choices,
        }
    }

    /// The pair with displacements from the one numbered `first` on as variables, and normals of facets too where the settings
    /// ask for it.
    pub(super) fn seeded(&self, geometry: &PairGeometry<f64>, first: usize) -> PairGeometry<Active> {
        let mut seeded = geometry.seeded_from(first);
        if self.parameters.normal_variation.knows_facets() {
            seeded.slave_normal = self.slave.unit_normal(&seeded.slave, self.slave.centre);
            seeded.master_normal = self.master.unit_normal(&seeded.master, self.master.centre);
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
        let dim = self.slave.space;
        let own = self.pairs[at].key;
        let whole = self.parameters.normal_variation == NormalVariation::Exact;
        let knows = |corner: &FacetCorner| whole || corner.facet == [own.interface, own.slave];
        // By column, how the normal of a node turns: several facets tell of the same neighbour.
        let mut variation: Vec<(usize, [[f64; 3]; 3])> = Vec::with_capacity(self.nodes(at).len());
        for (j, &slave) in self.slaves(at).iter().enumerate() {
            if self.states[slave].kinematics.normal_of_master {
                continue;
            }
            variation.clear();
            self.patches.variation(slave.0, &view.nodes.current, &knows, &mut |by, matrix| {
                let column = self.first_row(at, by);
                match variation.iter_mut().find(|(known, _)| *known == column) {
                    Some((_, sum)) => (0..dim).for_each(|r| (0..dim).for_each(|c| sum[r][c] += matrix[r][c])),
                    None => variation.push((column, matrix)),
                }
            });
            for (row, derivatives) in by_normals.chunks_exact(dim * self.slave.nodes).enumerate() {
                let by_normal: [f64; 3] = std::array::from_fn(|r| if r < dim { derivatives[dim * j + r] } else { 0.0 });
                let lhs = &mut lhs[row * width..(row + 1) * width];
                for (column, matrix) in &variation {
                    let entries = &mut lhs[*column..*column + dim];
                    for (c, entry) in entries.iter_mut().enumerate() {
                        *entry -= (0..dim).map(|r| by_normal[r] * matrix[r][c]).sum::<f64>();
                    }
                }
            }
        }
    }

    /// The past of the `at`-th pair: its last accepted state, and its operators at the start of the step where they are `wanted`.
    pub(super) fn history(&self, at: usize, view: &StepView<'_>, wanted: bool) -> PairHistory {
        let displacement = view.nodes.history.get(DISPLACEMENT.name()).expect("displacements are unknowns");
        let back = self.parameters.levels_back.min(displacement.levels.len() - 1);
        let position = |n: u32| add(view.nodes.initial[n as usize], displacement.vector(back, n as usize));
        let (slaves, masters) = (self.slave_nodes(at), self.master_nodes(at));
        PairHistory {
            previous: wanted.then(|| self.pairs[at].previous.operators(self.slave, self.master)),
            slave: Nodal::new(slaves.len(), |j| position(slaves[j])),
            master: Nodal::new(masters.len(), |l| position(masters[l])),
        }
    }

    /// Constants of the slave nodes of the `at`-th pair.
    pub(super) fn slave_constants(&self, at: usize, states: &SlaveStates) -> Nodal<SlaveNode> {
        let positive = |area: f64| if area > 0.0 { area } else { 1.0 };
        // The bounds of pairs that augment have gaps of their own, which add up to zero if all count alike.
        let by_pair = self.parameters.augmentation == Augmentation::Pair;
        let own = self.pairs[at].area;
        let k = self.parameters.scale_factor;
        let slaves = self.slaves(at);
        self.slave.nodal(|j| {
            let (node, bond) = (&states[slaves[j]], states.bond(slaves[j]));
            let area = positive(node.kinematics.area);
            // On a part of a facet of second order the share of a corner may be below zero; over all pairs they add up to the area.
            let share = if node.kinematics.area > 0.0 { own[j] } else { positive(own[j]) };
            let stiffness = self.parameters.nodal_stiffness(node.parameters.penalty, area);
            SlaveNode {
                state: node.contact(),
                penalty: node.parameters.penalty,
                compliance: match node.parameters.soft {
                    Some(soft) => soft.compliance,
                    None if self.parameters.regularised => node.parameters.penalty.recip(),
                    None => 0.0,
                },
                uzawa_pressure: node.parameters.soft.map_or(node.law.uzawa_pressure, |soft| soft.pressure_at_rest),
                stiffness,
                area: if by_pair { area } else { share },
                dynamic_factor: node.parameters.dynamic_factor,
                friction: node.parameters.friction,
                tangent: node.law.tangent,
                rotation: node.law.rotation,
                constraints: node.law.constraints,
                constraint_weight: k * k * area / stiffness,
                history_traction: bond.map_or(node.last.history_traction, |bond| bond.last.friction),
                history_sliding: bond.map_or([0.0; 3], |bond| bond.last.sliding),
                bond: bond.and_then(|bond| bond.tangent),
                traction: add(
                    node.law.history_traction,
                    scale(node.kinematics.normal, node.parameters.penalty * (node.kinematics.weighted_gap / area)),
                ),
            }
        })
    }

    /// The operators of a pair that stands like this; known ones, or else new ones.
    pub(super) fn operators_of(&self, at: usize, geometry: &PairGeometry<f64>) -> Overlap<Operators<f64>> {
        let known = self.known.get(at).and_then(|known| known.as_ref()?.of(geometry));
        known.unwrap_or_else(|| operators(geometry, &self.parameters.segmentation))
    }

    /// The pair in the present state with its operators, if it is this rank's.
    fn operators_now(
        &self,
        at: usize,
        present: IntegrationState<'_>,
    ) -> Option<(PairGeometry<f64>, Overlap<Operators<f64>>)> {
        let geometry = (present.own)(self.nodes(at)).then(|| self.geometry(at, present.view, present.states))?;
        Some((geometry, self.operators_of(at, &geometry)))
    }

    /// Computes the operators of this rank's pairs in the present state.
    pub(super) fn find_operators(&mut self, present: IntegrationState<'_>) {
        self.known = parallel::map(self.pairs.len(), PAIRS, |at| {
            self.operators_now(at, present).map(|(geometry, found)| KnownOperators::new(&geometry, &found))
        });
    }

    /// Gap and area of every pair, and the contribution of a law to those that overlap. Where `left` holds, also to those that did
    /// at the start of the step, with operators of zero.
    pub(super) fn integrate(&self, present: IntegrationState<'_>, left: bool, add: Addition<'_>) -> Vec<Integral> {
        parallel::map(self.pairs.len(), PAIRS, |at| {
            let mut out = Integral::default();
            let Some((geometry, found)) = self.operators_now(at, present) else { return out };
            out.facing = !matches!(found, Overlap::None);
            if let Overlap::Cells(operators) = found {
                out.overlapping = true;
                let gaps = weighted_gap(&operators, &geometry.slave, &geometry.master, &geometry.nodal_normals);
                for j in 0..geometry.slave.len() {
                    out.area[j] = operators.d[j].iter().sum();
                    out.gap[j] = gaps[j];
                }
                add(at, &geometry, &operators, &mut out);
            } else if left && !self.pairs[at].previous.is_empty() {
                add(at, &geometry, &Operators::zero(self.slave, self.master), &mut out);
            }
            out
        })
    }

    /// M of every pair.
    pub(super) fn master_weights(&self, present: IntegrationState<'_>) -> Vec<Option<Nodal<Nodal<f64>>>> {
        parallel::map(self.pairs.len(), PAIRS, |at| Some(self.operators_now(at, present)?.1.cells()?.m))
    }

    /// Keeps the operators of the pairs of this rank against which slip is measured.
    pub(super) fn keep_operators(&mut self, present: IntegrationState<'_>) {
        let kept = |at: usize| {
            let found = self.operators_now(at, present).and_then(|(_, found)| found.cells());
            found.map_or_else(Previous::default, |found| Previous::of(&found))
        };
        let kept = parallel::map(self.pairs.len(), PAIRS, kept);
        self.pairs.iter_mut().zip(kept).for_each(|(pair, operators)| pair.previous = operators);
    }

    /// Freezes the choices of the integration of this rank's pairs.
    pub(super) fn freeze_choices(&mut self, present: IntegrationState<'_>) {
        let choices = |at: usize| {
            let (geometry, found) = self.operators_now(at, present)?;
            Some(choices_of(&geometry, &self.parameters.segmentation, &found.cells()?))
        };
        let choices = |at: usize| choices(at).unwrap_or(self.pairs[at].choices);
        let choices = parallel::map(self.pairs.len(), PAIRS, choices);
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
        let slave = (node - around - masters) as u8;
        unknowns.extend(multipliers.iter().map(|&variable| LocalUnknown::of_slave(node as u8, slave, variable)));
    }
    unknowns.extend(displacements(0..around));
    unknowns
}
