//! From all unknowns to the equations that are solved: fixed ones go, constrained ones follow their masters.
//!
//! x = T x̄ + g (eq. D.12b); as the values already satisfy the constraints when an iteration starts, increments obey
//! Δx = T Δx̄ (eq. D.12d) and the solved system is TᵀA T Δx̄ = Tᵀb (eq. D.12e). Without constraints T only drops the fixed
//! unknowns. Where a constraint says how its slave's force is passed on, that takes the place of Tᵀ in its rows.

use std::borrow::Cow;
use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use zelus_linear_algebra::{Csr, Layout, parallel};

use super::dof_table::{DofTable, NONE};
use super::rows::{ROWS, fill_rows, starts};
use crate::diagnostics::{Diagnostic, Result};
use crate::model::{MasterSlaveConstraint, ModelPart, Owner, ScalarVariable};

/// Role of an unknown.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
enum DofRole {
    Free(u32),
    Fixed,
    /// Follows equations.
    Slave(Vec<MasterTerm>),
}

/// An equation that a slave follows.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
struct MasterTerm {
    equation: u32,
    /// Factor of its motion.
    weight: f64,
    /// Factor of the slave's force.
    force: f64,
}

/// A fixed unknown that a slave leans on.
#[derive(Debug, Clone, Copy, PartialEq)]
struct FixedMaster {
    fixed: u32,
    slave: u32,
    /// Share of the slave's force.
    force: f64,
}

/// Force of a support along a direction on an unknown that it does not eliminate.
#[derive(Debug, Clone, Copy, PartialEq)]
struct GroundForce {
    unknown: u32,
    slave: u32,
    /// Share of the support's force at the slave, with the opposite sign.
    weight: f64,
}

/// The map between unknowns and equations.
///
/// Node 1 is fixed and node 3 follows node 2 at half its motion, so one equation remains and takes half the force on node 3:
///
/// ```
/// use zelus_core::assembly::{DofTable, Equations};
/// use zelus_core::model::{DofOwners, MasterSlaveConstraint, ModelPart, Nodes, ScalarVariable};
///
/// let mut part = ModelPart::new("Structure");
/// part.nodes = Nodes::new(vec![1, 2, 3], vec![[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]]);
/// let motion = ScalarVariable { column: "MOTION", component: None };
/// part.nodes.set_fixed(motion, &[0], true);
/// part.add_constraints([MasterSlaveConstraint::new((2, motion), vec![((1, motion), 0.5)])]);
/// let mut dofs = DofTable::default();
/// dofs.number(&part, &[DofOwners::of_nodes(motion, vec![0, 1, 2])], &[]);
///
/// let equations = Equations::new(&dofs, &part)?;
/// assert_eq!(equations.unknowns(), [1]);
/// assert_eq!(equations.reduce(&[7.0, 10.0, 4.0]), [12.0]);
/// # Ok::<(), zelus_core::Error>(())
/// ```
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct Equations {
    roles: Vec<DofRole>,
    /// Unknown of each equation.
    #[serde(skip)]
    free: Vec<u32>,
    #[serde(skip)]
    has_slaves: bool,
    #[serde(skip)]
    symmetric: bool,
    /// Contributions of constraints to fixed unknowns.
    #[serde(skip)]
    leaning: Vec<FixedMaster>,
    /// Unknowns that supports along directions eliminate, ascending, and their forces on others.
    #[serde(skip)]
    supported_slaves: Vec<u32>,
    #[serde(skip)]
    ground: Vec<GroundForce>,
    /// Meaning of the equations.
    #[serde(skip)]
    pub layout: Layout,
}

/// Difference of two prescribed values that are one, as a share of the largest of them.
const SAME_VALUE: f64 = 1e-9;

/// Value that a support prescribes for an unknown of a node, `None` inside where it is not known; `None` where no support holds it.
pub type SupportOf<'a> = dyn Fn(ScalarVariable, u32) -> Option<Option<f64>> + Sync + 'a;

/// A constraint whose slave a support prescribes.
fn supported_slave(constraint: &MasterSlaveConstraint, node: usize, why: &str) -> Diagnostic {
    let (_, variable) = constraint.slave;
    let fact = format!("{} makes {variable} of node {node} follow others, {why}", constraint.in_words());
    let remedy = "take the node out of the support, or make one of its masters the slave";
    Diagnostic::error("constraint-on-support", fact).remedy(remedy)
}

impl Equations {
    /// The equations left by the present fixities and active constraints.
    ///
    /// # Errors
    /// Constraints that form a circle, eliminate an unknown twice, or one that a support prescribes.
    pub fn new(dofs: &DofTable, part: &ModelPart) -> Result<Self> {
        Self::with_supports(dofs, part, &|variable, node| part.nodes.is_fixed(variable, node).then_some(None))
    }

    /// The equations left by supports and active constraints. A supported slave may follow supported nodes.
    ///
    /// # Errors
    /// As [`Equations::new`]; a supported slave whose value is not the one that its masters give it.
    pub fn with_supports(dofs: &DofTable, part: &ModelPart, support: &SupportOf<'_>) -> Result<Self> {
        let nodes = &part.nodes;
        let mut slaves: BTreeMap<u32, &MasterSlaveConstraint> = BTreeMap::new();
        for constraint in part.constraints.iter().filter(|c| c.active) {
            let (node, variable) = constraint.slave;
            let owner = part.slave_nodes.owner(constraint.set.as_deref(), node);
            let Some(number) = owner.and_then(|owner| dofs.number_of(variable, owner)) else { continue };
            if let Some(first) = slaves.insert(number, constraint) {
                let [one, other] = [first, constraint].map(MasterSlaveConstraint::in_words);
                let fact = format!("{one} and {other} both eliminate {variable} of node {}", nodes.ids[node as usize]);
                let remedy = "remove one of them, or take the node out of one of the parts";
                return Err(Diagnostic::error("constraint-twice", fact).remedy(remedy).into());
            }
        }
        let is_free = |number: usize| {
            let dof = &dofs.dofs()[number];
            !slaves.contains_key(&(number as u32)) && support(dof.variable, dof.node).is_none()
        };
        let is_free: Vec<bool> = parallel::map(dofs.len(), ROWS, is_free);
        let mut roles = vec![DofRole::Fixed; dofs.len()];
        let mut free = Vec::with_capacity(dofs.len());
        for number in (0..dofs.len()).filter(|&number| is_free[number]) {
            roles[number] = DofRole::Free(free.len() as u32);
            free.push(number as u32);
        }
        let (mut leaning, mut ground) = (Vec::new(), Vec::new());
        let is_support = |number: u32| slaves.get(&number).is_some_and(|constraint| constraint.support.is_some());
        let supported_slaves: Vec<u32> = slaves.keys().copied().filter(|&number| is_support(number)).collect();
        for (&number, constraint) in &slaves {
            let mut terms = BTreeMap::new();
            let constant = follow(number, [1.0; 2], &slaves, dofs, part, 0, &|_| false, &mut terms)?;
            let (node, variable) = constraint.slave;
            if let Some(value) = support(variable, node).filter(|_| constraint.set.is_none()) {
                let support_of =
                    |number: u32| support(dofs.dofs()[number as usize].variable, dofs.dofs()[number as usize].node);
                let masters = terms.iter().map(|(&master, [weight, _])| Some((*weight, support_of(master)?)));
                if let Some(why) = contradiction(value, constant, masters) {
                    return Err(supported_slave(constraint, nodes.ids[node as usize], &why).into());
                }
            }
            let mut follows = Vec::with_capacity(terms.len());
            let mut fixed = BTreeMap::new();
            for (master, [weight, force]) in terms {
                match roles[master as usize] {
                    DofRole::Free(equation) => follows.push(MasterTerm { equation, weight, force }),
                    _ => drop(fixed.insert(master, [weight, force])),
                }
            }
            roles[number as usize] = DofRole::Slave(follows);
            if constraint.support.is_some() {
                // A support along a direction bears its force itself.
                let others = constraint.masters.iter().filter_map(|&((node, variable), weight)| {
                    Some((dofs.number_of(variable, Owner::Node(node))?, weight))
                });
                let others = others
                    .filter(|&(unknown, _)| roles[unknown as usize] != DofRole::Fixed || slaves.contains_key(&unknown));
                ground.extend(others.map(|(unknown, weight)| GroundForce { unknown, slave: number, weight }));
                continue;
            }
            if !supported_slaves.is_empty() {
                fixed.clear();
                follow(number, [1.0; 2], &slaves, dofs, part, 0, &is_support, &mut fixed)?;
                fixed.retain(|&master, _| {
                    is_support(master)
                        || support(dofs.dofs()[master as usize].variable, dofs.dofs()[master as usize].node).is_some()
                });
            }
            leaning.extend(fixed.into_iter().map(|(fixed, [_, force])| FixedMaster { fixed, slave: number, force }));
        }
        let layout = Layout {
            node: parallel::map(free.len(), ROWS, |at| dofs.dofs()[free[at] as usize].node),
            multiplier: parallel::map(free.len(), ROWS, |at| dofs.dofs()[free[at] as usize].multiplier),
            ..Layout::default()
        };
        let is_symmetric = |role: &DofRole| match role {
            DofRole::Slave(terms) => terms.iter().all(|term| term.weight == term.force),
            _ => true,
        };
        // Terms of prescribed unknowns are reactions alone.
        let symmetric = roles.iter().all(is_symmetric);
        Ok(Self { has_slaves: !slaves.is_empty(), symmetric, roles, free, leaning, supported_slaves, ground, layout })
    }

    /// All that a saved run holds of them: enough to tell whether others are the same.
    pub(super) fn roles_only(&self) -> Self {
        Self { roles: self.roles.clone(), ..Self::default() }
    }

    /// Takes up the forces that slaves of the same equations pass on.
    pub(super) fn take_forces(&mut self, other: Self) {
        (self.leaning, self.ground, self.supported_slaves) = (other.leaning, other.ground, other.supported_slaves);
    }

    /// Whether both lead to the same equations.
    pub fn same_as(&self, other: &Self) -> bool {
        self.roles == other.roles
    }

    /// Whether forces go the way of motions, so that a symmetric matrix stays so.
    pub fn keep_symmetry(&self) -> bool {
        self.symmetric
    }

    /// Whether unknowns follow others.
    pub fn has_slaves(&self) -> bool {
        self.has_slaves
    }

    /// Number of equations.
    pub fn len(&self) -> usize {
        self.free.len()
    }

    /// Whether nothing is left to solve.
    pub fn is_empty(&self) -> bool {
        self.free.is_empty()
    }

    /// Number of unknowns, solved for or not.
    pub fn unknown_count(&self) -> usize {
        self.roles.len()
    }

    /// Unknown of each equation.
    pub fn unknowns(&self) -> &[u32] {
        &self.free
    }

    /// Whether an unknown is prescribed.
    pub fn is_fixed(&self, number: usize) -> bool {
        self.roles[number] == DofRole::Fixed
    }

    /// The unknowns to which an unknown hands its force on, with their shares; none where it is no slave.
    pub fn hands_on(&self, number: usize) -> impl Iterator<Item = (u32, f64)> + '_ {
        let terms = if let DofRole::Slave(terms) = &self.roles[number] { &terms[..] } else { &[] };
        terms.iter().map(|term| (self.free[term.equation as usize], term.force))
    }

    /// Rows of the equations of a matrix over all unknowns, its columns as the unknowns follow equations: `R A T`.
    pub(super) fn motions(&self, matrix: &Csr) -> Csr {
        let mut out = Csr::empty(if matrix.rows == 0 { 0 } else { self.free.len() });
        let mut sums: BTreeMap<u32, f64> = BTreeMap::new();
        let mut one = [MasterTerm { equation: 0, weight: 0.0, force: 0.0 }];
        for (row, &unknown) in self.free.iter().enumerate().take(out.rows) {
            let (columns, values) = matrix.row(unknown as usize);
            for (&column, value) in columns.iter().zip(values) {
                for term in self.terms(column as usize, &mut one) {
                    *sums.entry(term.equation).or_default() += value * term.weight;
                }
            }
            out.columns.extend(sums.keys());
            out.values.extend(std::mem::take(&mut sums).into_values());
            out.row_starts[row + 1] = out.columns.len();
        }
        out
    }

    /// Whether an unknown is solved for.
    pub fn is_free(&self, number: usize) -> bool {
        matches!(self.roles[number], DofRole::Free(_))
    }

    /// Tᵀ v: a vector over unknowns gathered on equations.
    pub fn reduce(&self, full: &[f64]) -> Vec<f64> {
        let mut out: Vec<f64> = parallel::map(self.free.len(), ROWS, |at| full[self.free[at] as usize]);
        if self.has_slaves {
            for (role, value) in self.roles.iter().zip(full) {
                if let DofRole::Slave(terms) = role {
                    terms.iter().for_each(|term| out[term.equation as usize] += term.force * value);
                }
            }
        }
        out
    }

    /// The residual as the equations see it: forces on slaves are added to their masters, and only free unknowns remain.
    pub fn balanced<'r>(&self, full: &'r [f64]) -> Cow<'r, [f64]> {
        if !self.has_slaves {
            return Cow::Borrowed(full);
        }
        let mut out = vec![0.0; full.len()];
        self.free.iter().zip(self.reduce(full)).for_each(|(&n, value)| out[n as usize] = value);
        Cow::Owned(out)
    }

    /// Minus the residual with the forces that slaves hand on: the forces of the supports and their constraints at all unknowns.
    pub fn reactions(&self, full: &[f64]) -> Vec<f64> {
        self.supported(full).iter().map(|r| -r).collect()
    }

    /// The forces of the supports alone, those along directions included; zero at unknowns without support.
    pub fn forces_of_supports(&self, full: &[f64]) -> Vec<f64> {
        let supported = self.supported(full);
        let mut out: Vec<f64> =
            supported.iter().zip(&self.roles).map(|(r, role)| if *role == DofRole::Fixed { -r } else { 0.0 }).collect();
        self.supported_slaves.iter().for_each(|&slave| out[slave as usize] = -supported[slave as usize]);
        self.ground.iter().for_each(|of| out[of.unknown as usize] += of.weight * supported[of.slave as usize]);
        out
    }

    /// The residual with the forces that slaves hand on to supported unknowns: there, minus the force of the supports.
    pub fn supported<'r>(&self, full: &'r [f64]) -> Cow<'r, [f64]> {
        if self.leaning.is_empty() {
            return Cow::Borrowed(full);
        }
        let mut out = full.to_vec();
        self.leaning.iter().for_each(|of| out[of.fixed as usize] += of.force * full[of.slave as usize]);
        Cow::Owned(out)
    }

    /// T v: increments of the equations spread to all unknowns; fixed ones get zero.
    pub fn expand(&self, reduced: &[f64]) -> Vec<f64> {
        let value = |role: &DofRole| match role {
            DofRole::Free(equation) => reduced[*equation as usize],
            DofRole::Fixed => 0.0,
            DofRole::Slave(terms) => terms.iter().map(|term| term.weight * reduced[term.equation as usize]).sum(),
        };
        parallel::map(self.roles.len(), ROWS, |number| value(&self.roles[number]))
    }

    /// Lumped masses of unknowns gathered on equations: masses of slaves are lumped on their masters.
    pub fn lump(&self, mass: &[f64]) -> Vec<f64> {
        let mut carried = self.expand(&vec![1.0; self.len()]);
        carried.iter_mut().zip(mass).for_each(|(share, m)| *share *= m);
        self.reduce(&carried)
    }

    /// TᵀA T of the matrix A with the pattern of `full` and these values.
    pub fn reduce_matrix(&self, full: &Csr, values: &[f64], into: &mut Csr, same_pattern: bool) {
        assert_eq!(values.len(), full.entries(), "length of values");
        if self.has_slaves && self.touches_slaves(full) {
            *into = self.reduce_constrained(full, values);
            return;
        }
        let equation: Vec<u32> =
            self.roles.iter().map(|role| if let DofRole::Free(equation) = role { *equation } else { NONE }).collect();
        let columns_of = |row: usize| full.columns_of(self.free[row] as usize).iter().map(|&c| equation[c as usize]);
        if !same_pattern {
            let count = |row: usize| columns_of(row).filter(|&to| to != NONE).count();
            let counts: Vec<usize> = parallel::map(self.len(), ROWS, count);
            let row_starts = starts(counts);
            let mut columns = vec![0; row_starts[self.len()]];
            fill_rows(&row_starts, &mut columns, |row, out| {
                out.iter_mut().zip(columns_of(row).filter(|&to| to != NONE)).for_each(|(out, to)| *out = to);
            });
            *into = Csr::from_sorted_pattern(row_starts, columns);
        }
        fill_rows(&into.row_starts, &mut into.values, |row, out| {
            let values = &values[full.row_starts[self.free[row] as usize]..];
            let entries = columns_of(row).zip(values).filter(|(to, _)| *to != NONE);
            out.iter_mut().zip(entries).for_each(|(out, (_, value))| *out = *value);
        });
    }

    /// Whether a constrained unknown has entries; the pattern is symmetric.
    fn touches_slaves(&self, full: &Csr) -> bool {
        let slaves = self.roles.iter().enumerate().filter(|(_, role)| matches!(role, DofRole::Slave(_)));
        slaves.map(|(row, _)| full.columns_of(row)).any(|columns| !columns.is_empty())
    }

    fn terms<'a>(&'a self, number: usize, one: &'a mut [MasterTerm; 1]) -> &'a [MasterTerm] {
        match &self.roles[number] {
            DofRole::Free(equation) => {
                one[0] = MasterTerm { equation: *equation, weight: 1.0, force: 1.0 };
                &one[..]
            }
            DofRole::Fixed => &[],
            DofRole::Slave(terms) => terms,
        }
    }

    fn reduce_constrained(&self, full: &Csr, values: &[f64]) -> Csr {
        let mut triplets = Vec::with_capacity(full.entries());
        let none = MasterTerm { equation: 0, weight: 0.0, force: 0.0 };
        let (mut left, mut right) = ([none], [none]);
        for row in 0..full.rows {
            let columns = full.columns_of(row);
            let values = &values[full.row_starts[row]..];
            for to in self.terms(row, &mut left) {
                for (&column, &value) in columns.iter().zip(values) {
                    for of in self.terms(column as usize, &mut right) {
                        triplets.push((to.equation as usize, of.equation as usize, to.force * value * of.weight));
                    }
                }
            }
        }
        Csr::from_triplets(self.free.len(), &triplets)
    }
}

/// Why a supported slave cannot follow its masters, given as weight and prescribed value, `None` for free ones.
fn contradiction(
    value: Option<f64>,
    constant: f64,
    masters: impl Iterator<Item = Option<(f64, Option<f64>)>>,
) -> Option<String> {
    let Some(masters) = masters.collect::<Option<Vec<_>>>() else {
        return Some("and a support prescribes it".to_owned());
    };
    let products = masters.into_iter().map(|(weight, of)| of.map(|of| weight * of)).collect::<Option<Vec<f64>>>()?;
    let (value, follows) = (value?, constant + products.iter().sum::<f64>());
    let largest = products.iter().fold(constant.abs().max(value.abs()), |most, product| most.max(product.abs()));
    let differs = (value - follows).abs() > SAME_VALUE * largest;
    differs.then(|| format!("which gives it {follows}, and a support prescribes {value}"))
}

/// Adds the unknowns that a slave follows through all constraints to `terms`, slaves at which it `ends` included; the sum of their
/// constants.
#[expect(clippy::too_many_arguments, reason = "the path of a recursion")]
fn follow(
    number: u32,
    shares: [f64; 2],
    slaves: &BTreeMap<u32, &MasterSlaveConstraint>,
    dofs: &DofTable,
    part: &ModelPart,
    depth: usize,
    ends: &dyn Fn(u32) -> bool,
    terms: &mut BTreeMap<u32, [f64; 2]>,
) -> Result<f64> {
    let constraint = slaves[&number];
    if depth > slaves.len() {
        let fact = format!("{} depends on itself through other constraints", constraint.in_words());
        return Err(Diagnostic::error("constraint-circle", fact).remedy("remove one constraint of the circle").into());
    }
    let mut constant = shares[0] * constraint.constant;
    for (at, &((node, variable), weight)) in constraint.masters.iter().enumerate() {
        let force = constraint.forces.as_ref().map_or(weight, |forces| forces[at]);
        let shares = [shares[0] * weight, shares[1] * force];
        let owner = part.slave_nodes.owner(constraint.set.as_deref(), node);
        let master = owner.and_then(|owner| dofs.number_of(variable, owner)).ok_or_else(|| {
            Diagnostic::error(
                "constraint-unknown",
                format!(
                    "{} needs {variable} of node {}, which is not an unknown",
                    constraint.in_words(),
                    part.nodes.ids[node as usize]
                ),
            )
        })?;
        if slaves.contains_key(&master) && !ends(master) {
            constant += follow(master, shares, slaves, dofs, part, depth + 1, ends, terms)?;
        } else {
            let sums = terms.entry(master).or_insert([0.0; 2]);
            (0..2).for_each(|at| sums[at] += shares[at]);
        }
    }
    Ok(constant)
}

/// Makes the values of constrained unknowns obey their constraints: u_s = Σ w u_m + g.
///
/// A constraint may follow another one; passes are repeated until nothing changes.
pub fn impose_constraints(part: &mut ModelPart) {
    let constraints = std::mem::take(&mut part.constraints);
    for _ in 0..=constraints.len() {
        let mut changed = false;
        for constraint in constraints.iter().filter(|c| c.active) {
            let set = constraint.set.as_deref();
            let value = constraint.masters.iter().fold(constraint.constant, |sum, &((node, variable), weight)| {
                let owner = part.slave_nodes.owner(set, node);
                sum + weight * owner.and_then(|owner| part.value_of(owner, variable, 0)).unwrap_or(0.0)
            });
            let (node, variable) = constraint.slave;
            let Some(owner) = part.slave_nodes.owner(set, node) else { continue };
            if let Some(before) = part.value_of(owner, variable, 0) {
                changed |= before != value;
                part.set_value_of(owner, variable, 0, value);
            }
        }
        if !changed {
            break;
        }
    }
    part.constraints = constraints;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{DofOwners, ModelPart, Nodes, test_variables::DISPLACEMENT};

    /// Three nodes on a line, some of them fixed; the last follows the others by halves and passes its force on as `forces` say.
    fn equations(fixed: &[u32], forces: Option<Vec<f64>>) -> Equations {
        let mut part = ModelPart::new("Structure");
        part.nodes = Nodes::new(vec![1, 2, 3], vec![[0.0; 3], [1.0, 0.0, 0.0], [2.0, 0.0, 0.0]]);
        let x = DISPLACEMENT.component(0);
        part.nodes.history.add(&DISPLACEMENT);
        let mut dofs = DofTable::default();
        dofs.number(&part, &[DofOwners::of_nodes(x, vec![0, 1, 2])], &[]);
        part.nodes.set_fixed(x, fixed, true);
        let masters = vec![((0, x), 0.5), ((1, x), 0.5)];
        let constraint = MasterSlaveConstraint { id: 1, forces, ..MasterSlaveConstraint::new((2, x), masters) };
        part.constraints.push(constraint);
        Equations::new(&dofs, &part).unwrap()
    }

    #[test]
    fn forces_may_go_another_way_than_motions() {
        let full = Csr::from_triplets(3, &[(0, 0, 2.0), (1, 1, 3.0), (2, 0, 5.0), (2, 2, 4.0)]);
        for forces in [[0.5, 0.5], [0.75, -0.25]] {
            let given = equations(&[], (forces != [0.5, 0.5]).then(|| forces.to_vec()));
            assert_eq!(given.keep_symmetry(), forces == [0.5, 0.5]);
            assert_eq!(given.expand(&[1.0, 3.0]), [1.0, 3.0, 2.0]);
            assert_eq!(given.reduce(&[1.0, 2.0, 10.0]), [1.0 + 10.0 * forces[0], 2.0 + 10.0 * forces[1]]);
            let mut reduced = Csr::default();
            given.reduce_matrix(&full, &full.values, &mut reduced, false);
            // The row of the slave over the equations is 5 x₀ + 4 (x₀ + x₁)/2.
            let [f, g] = forces;
            let expected = [[2.0 + 7.0 * f, 2.0 * f], [7.0 * g, 3.0 + 2.0 * g]];
            for (row, expected) in expected.iter().enumerate() {
                assert_eq!(reduced.row(row).1, expected, "{forces:?}");
            }
        }
    }

    #[test]
    fn supports_bear_what_slaves_hand_on_to_them() {
        let given = equations(&[1], Some(vec![0.75, -0.25]));
        assert_eq!(given.reduce(&[1.0, 2.0, 10.0]), [1.0 + 7.5]);
        assert_eq!(*given.supported(&[1.0, 2.0, 10.0]), [1.0, 2.0 - 2.5, 10.0]);
        assert_eq!(*equations(&[], None).supported(&[1.0, 2.0, 10.0]), [1.0, 2.0, 10.0]);
    }
}
