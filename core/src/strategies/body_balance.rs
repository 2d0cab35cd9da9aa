//! Equilibrium of each body: its residual against the forces that act on it.
//!
//! A criterion over all unknowns refers to the residual at the start of the step, which may be that of a far stiffer body. So
//! each body b (connected elements) and unknown is looked at by itself, once the criterion is satisfied:
//!
//! ‖r‖_b ≤ tol · max(‖f_ext‖_b, ‖f_int‖_b, ‖f_contact‖_b, ‖f_inertia‖_b), and |Σ r|_b ≤ tol · max Σ|f|_b
//!
//! with the forces of supported unknowns among those of the right-hand side, and for nodes of no element with the forces that
//! constraints hand on to them. Residuals no larger than round-off pass: of the terms
//! in the present state, or of the residual at the start of the step, which a body that is let go loses whole.

use super::criterion::is_round_off;
use super::energy_balance::Forces;
use super::location::body_in_words;
use crate::assembly::{Assembler, System};
use crate::model::{ModelPart, NumberedBodies, Rates};
use crate::vector3::norm;

/// Kinds of forces that act: loads, elements, interactions, inertia; then those that constraints hand on.
const KINDS: usize = 4;
const HANDED_ON: usize = KINDS;
/// Share of the residual at the start of the step that is round-off.
const ROUND_OFF: f64 = 1e-12;
/// Place of the residual of the present state; that of the start of the step follows.
const NOW: usize = 0;

/// The rule for bodies whose forces are out of balance in a state that meets the criterion.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BodyBalance {
    /// The iteration goes on until the forces on each body are in balance.
    Required,
    /// The state is accepted, with a warning.
    Told,
    /// The state is accepted, and not looked at.
    Unchecked,
}

/// A body that is out of balance.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Imbalance {
    /// The body, in words.
    body: String,
    /// The unknown, e.g. DISPLACEMENT.
    unknown: &'static str,
    /// Residual by the largest of the forces.
    pub ratio: f64,
    /// Largest ratio that is accepted.
    pub tolerance: f64,
}

impl Imbalance {
    /// The fact, in words.
    pub fn fact(&self) -> String {
        let Self { body, unknown, ratio, tolerance } = self;
        let kind = match Rates::of(unknown) {
            Some(rates) if rates.moves_mesh => "forces",
            _ => "flows",
        };
        format!(
            "{kind} of {unknown} on {body} are out of balance by {ratio:.1e} of the largest of them (tol {tolerance:.0e})"
        )
    }

    /// The body that is farthest out of balance beyond `tolerance`; `None` where each is in balance. Residuals are those that the
    /// equations see, now and at the start of the step; `residual` is that of all unknowns now. Collective.
    pub fn largest(
        groups: &BodyDofs<'_>,
        part: &ModelPart,
        residuals: [&[f64]; 2],
        residual: &[f64],
        forces: &Forces,
        tolerance: f64,
    ) -> Option<Self> {
        let terms = groups.terms(part, residuals, residual, forces);
        let mut beyond: Vec<(usize, f64)> = (0..groups.count()).map(|group| (group, terms.ratio(group))).collect();
        beyond.retain(|&(group, ratio)| ratio > tolerance && !terms.has_fallen(group));
        if beyond.is_empty() {
            return None;
        }
        let round_off = groups.round_off(part);
        beyond.retain(|&(group, _)| !is_round_off(terms.residual[group][NOW].sqrt(), round_off[group]));
        let (group, ratio) = beyond.into_iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
        let columns = &groups.columns;
        let body = match groups.bodies.first.get(group / columns.len()) {
            Some(&first) => part.ranks.first_to_say(body_in_words(part, first)).unwrap_or_default(),
            None => "nodes without elements".to_owned(),
        };
        Some(Self { body, unknown: columns[group % columns.len()], ratio, tolerance })
    }
}

/// The unknowns by body and variable, multipliers aside; nodes of no element make a last body.
pub(super) struct BodyDofs<'a> {
    bodies: &'a NumberedBodies,
    system: &'a System,
    assembler: &'a Assembler,
    columns: Vec<&'static str>,
    /// Place of the column of each kind of unknown; `None` for multipliers.
    places: Vec<Option<usize>>,
}

impl<'a> BodyDofs<'a> {
    /// The groups of the unknowns of a system.
    pub fn new(bodies: &'a NumberedBodies, system: &'a System, assembler: &'a Assembler) -> Self {
        let dofs = &system.dofs;
        let mut columns: Vec<&'static str> = dofs.variables().map(|variable| variable.column).collect();
        columns.dedup();
        let kinds = dofs.variables().zip(dofs.multipliers());
        let place = |column| columns.iter().position(|own| *own == column);
        let places = kinds.map(|(variable, &multiplier)| place(variable.column).filter(|_| !multiplier)).collect();
        Self { bodies, system, assembler, columns, places }
    }

    fn count(&self) -> usize {
        (self.bodies.first.len() + 1) * self.columns.len()
    }

    /// Group of an unknown that this rank counts.
    fn of(&self, n: usize) -> Option<usize> {
        let column = self.places[self.system.dofs.kinds()[n] as usize].filter(|_| self.assembler.counts(n))?;
        let body = self.bodies.of_node[self.system.dofs.dofs()[n].node as usize];
        Some(body.unwrap_or(self.bodies.first.len()) * self.columns.len() + column)
    }

    /// Group of an unknown of a node of no element, which another rank may count.
    fn without_element(&self, n: usize) -> Option<usize> {
        let column = self.places[self.system.dofs.kinds()[n] as usize]?;
        let is_of_body = self.bodies.of_node[self.system.dofs.dofs()[n].node as usize].is_some();
        (!is_of_body).then(|| self.bodies.first.len() * self.columns.len() + column)
    }

    /// Unknowns that are solved for, with their groups.
    fn solved(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let unknowns = self.assembler.equations().unknowns().iter().map(|&n| n as usize);
        unknowns.filter_map(|n| Some((n, self.of(n)?)))
    }

    /// Terms of the balance of each group; collective.
    fn terms(&self, part: &ModelPart, residuals: [&[f64]; 2], residual: &[f64], forces: &Forces) -> BodySums {
        let mut out = BodySums::new(self.count());
        for (n, group) in (0..self.system.dofs.len()).filter_map(|n| Some((n, self.of(n)?))) {
            for (kind, of_kind) in forces[..KINDS].iter().enumerate() {
                out.squares[group][kind] += of_kind[n] * of_kind[n];
                out.sizes[group][kind] += of_kind[n].abs();
            }
        }
        let equations = self.assembler.equations();
        let slaves = (0..self.system.dofs.len()).filter(|&n| equations.has_slaves() && self.assembler.counts(n));
        for (n, (master, share)) in slaves.flat_map(|n| equations.hands_on(n).map(move |term| (n, term))) {
            let Some(group) = self.without_element(master as usize) else { continue };
            out.squares[group][HANDED_ON] += (share * residual[n]).powi(2);
            out.sizes[group][HANDED_ON] += (share * residual[n]).abs();
        }
        for (n, group) in self.solved() {
            out.sum[group][self.system.dofs.dofs()[n].variable.offset()] += residuals[NOW][n];
            for (sum, residual) in out.residual[group].iter_mut().zip(residuals) {
                *sum += residual[n] * residual[n];
            }
        }
        part.ranks.sum(out.residual.as_flattened_mut());
        part.ranks.sum(out.sum.as_flattened_mut());
        part.ranks.sum(out.squares.as_flattened_mut());
        part.ranks.sum(out.sizes.as_flattened_mut());
        out
    }

    /// Norm of the round-off of the residuals of each group; collective.
    fn round_off(&self, part: &ModelPart) -> Vec<f64> {
        let mut squares = vec![0.0; self.count()];
        let sizes = self.assembler.round_off(part, self.system);
        self.solved().for_each(|(n, group)| squares[group] += sizes[n] * sizes[n]);
        part.ranks.sum(&mut squares);
        squares.into_iter().map(f64::sqrt).collect()
    }
}

/// Sums over the unknowns of each group.
struct BodySums {
    /// Σ r² of the unknowns that are solved for, now and at the start of the step.
    residual: Vec<[f64; 2]>,
    /// Σ r of these now, by component.
    sum: Vec<[f64; 3]>,
    /// Σ f² of all unknowns, by kind of force.
    squares: Vec<[f64; KINDS + 1]>,
    /// Σ|f| of all unknowns, by kind of force.
    sizes: Vec<[f64; KINDS + 1]>,
}

impl BodySums {
    fn new(count: usize) -> Self {
        let (squares, sizes) = (vec![[0.0; KINDS + 1]; count], vec![[0.0; KINDS + 1]; count]);
        Self { residual: vec![[0.0; 2]; count], sum: vec![[0.0; 3]; count], squares, sizes }
    }

    /// Residual of a group by the largest of its forces: that of the norms or that of the sums, whichever is more.
    fn ratio(&self, group: usize) -> f64 {
        let largest = |terms: &[f64; KINDS + 1]| terms.iter().copied().fold(0.0, f64::max);
        let by_norm = self.residual[group][NOW].sqrt() / largest(&self.squares[group]).sqrt().max(f64::MIN_POSITIVE);
        let by_sum = norm(self.sum[group]) / largest(&self.sizes[group]).max(f64::MIN_POSITIVE);
        by_norm.max(by_sum)
    }

    /// Whether the residual of a group is round-off of that at the start of the step.
    fn has_fallen(&self, group: usize) -> bool {
        let [now, start] = self.residual[group];
        now <= ROUND_OFF * ROUND_OFF * start
    }
}
