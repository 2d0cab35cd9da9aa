//! Mass and damping matrices on the pattern of the bulk.

use zelus_linear_algebra::vector::zeros;

use super::bulk_tangent::{BulkTangent, InertiaKey};
use super::inertia::{Inertia, damped_by_properties, without_rates};
use crate::assembly::System;
use crate::assembly::redistribution::Redistribution;
use crate::assembly::rows::fill_rows;
use crate::diagnostics::Result;
use crate::entities::{EntityBlock, LocalSystems, Request, StepView, Tangent};
use crate::model::{EntityRole, ModelPart, Nodes, Rates};

/// Values of mass and damping on the pattern of a [`BulkTangent`].
#[derive(Default)]
pub(super) struct InertiaMatrices {
    /// Mass of the initial positions; `None` until it is computed.
    mass: Option<Vec<f64>>,
    /// Whether the elements give the lumped mass.
    lumped: bool,
    /// Damping that does not depend on the state, with its Rayleigh factors.
    damping: Option<([f64; 2], Vec<f64>)>,
    /// Mass taken off nodes and handed on to others.
    pub redistribution: Redistribution,
}

impl InertiaMatrices {
    /// No matrices yet.
    pub fn new(lumped: bool) -> Self {
        Self { lumped, ..Self::default() }
    }

    /// Drops all values: they are of another shape or pattern.
    pub fn forget(&mut self) {
        (self.mass, self.damping) = (None, None);
    }

    /// Drops the mass: it is to be redistributed in another way.
    pub fn forget_mass(&mut self) {
        self.mass = None;
    }

    /// The mass matrix of the initial positions, redistributed.
    ///
    /// # Errors
    /// An entity that cannot be computed.
    pub fn mass(&mut self, bulk: &BulkTangent, part: &ModelPart, system: &System) -> Result<&[f64]> {
        if self.mass.is_none() {
            let nodes = undeformed(part);
            let view = StepView { nodes: &nodes, ..part.view() };
            let mut values = zeros(bulk.entries());
            for (block, numbers) in bulk.elements(system) {
                let lumped = self.lumped;
                let compute = |range, out: &mut LocalSystems| block.mass(&view, range, lumped, out).map(|_| ());
                bulk.add((block, numbers), &mut values, &compute)?;
            }
            self.redistribution.apply(bulk.matrix(), &mut values);
            self.mass = Some(values);
        }
        Ok(self.present_mass())
    }

    /// The mass matrix.
    ///
    /// # Panics
    /// Before [`InertiaMatrices::mass`].
    pub fn present_mass(&self) -> &[f64] {
        self.mass.as_deref().expect("just made")
    }

    /// The damping matrix, where properties have factors of their own or elements are dampers.
    ///
    /// # Errors
    /// An entity that cannot be computed.
    pub fn damping(
        &mut self,
        bulk: &BulkTangent,
        part: &ModelPart,
        system: &System,
        rayleigh: [f64; 2],
    ) -> Result<Vec<f64>> {
        if let Some((_, values)) = self.damping.as_ref().filter(|(key, _)| *key == rayleigh) {
            return Ok(values.clone());
        }
        let view = part.view();
        let nodes = undeformed(part);
        let initial = StepView { nodes: &nodes, ..view };
        let mut values = zeros(bulk.entries());
        let mut lasting = true;
        for (block, numbers) in bulk.blocks(system) {
            let element = block.entry().role == EntityRole::Element;
            let [alpha, beta] = if element { rayleigh_of(part, block, rayleigh) } else { [0.0, rayleigh[1]] };
            if alpha != 0.0 {
                let lumped = self.lumped;
                let compute = |range, out: &mut LocalSystems| {
                    block.mass(&initial, range, lumped, out).map(|_| out.lhs.iter_mut().for_each(|m| *m *= alpha))
                };
                bulk.add((block, numbers), &mut values, &compute)?;
            }
            let stiff = match block.tangent() {
                Tangent::Zero => false,
                Tangent::Unsymmetric => element,
                Tangent::Constant | Tangent::Symmetric => true,
            };
            if beta != 0.0 && stiff {
                let compute = |range, out: &mut LocalSystems| {
                    let systems = block.local_systems(&view, range, Request::Both, out);
                    systems.map(|()| out.lhs.iter_mut().for_each(|k| *k *= beta))
                };
                bulk.add((block, numbers), &mut values, &compute)?;
                lasting &= block.tangent() == Tangent::Constant;
            }
            if element && block.has_damping() {
                let compute = |range, out: &mut LocalSystems| {
                    block.damping(&view, range, out);
                    Ok(())
                };
                bulk.add((block, numbers), &mut values, &compute)?;
            }
        }
        if lasting {
            self.damping = Some((rayleigh, values.clone()));
        }
        Ok(values)
    }

    /// M a + C v less the forces carried over, over all unknowns: the share of this rank; `counts` says of an unknown whether
    /// it counts here.
    ///
    /// # Errors
    /// An entity that cannot be computed.
    pub fn forces(
        &mut self,
        bulk: &BulkTangent,
        part: &ModelPart,
        system: &System,
        inertia: &Inertia,
        counts: impl Fn(usize) -> bool,
    ) -> Result<Vec<f64>> {
        let mut out = vec![0.0; system.dofs.len()];
        let single = !damped_by_properties(part, system);
        let alpha = if single { inertia.alpha } else { 0.0 };
        let minus: Vec<f64> =
            inertia.acceleration.iter().zip(&inertia.velocity).map(|(a, v)| -(a + alpha * v)).collect();
        bulk.mul_subtract(self.mass(bulk, part, system)?, &minus, &mut out);
        let minus = |factor: f64| inertia.velocity.iter().map(|v| -factor * v).collect::<Vec<f64>>();
        if !single {
            let damping = self.damping(bulk, part, system, [inertia.alpha, inertia.beta])?;
            bulk.mul_subtract(&damping, &minus(1.0), &mut out);
        } else if inertia.beta != 0.0 {
            bulk.mul_subtract(&bulk.stiffness(part, system, Vec::new())?, &minus(inertia.beta), &mut out);
        }
        let carried = out.iter_mut().zip(&inertia.carried).enumerate();
        carried.filter(|(number, _)| counts(*number)).for_each(|(_, (sum, force))| *sum -= force);
        Ok(out)
    }

    /// Adds mass and damping with these factors to the stiffness in `values`; whether damping takes the symmetry from it.
    ///
    /// # Errors
    /// An entity that cannot be computed.
    pub fn add_to_tangent(
        &mut self,
        bulk: &BulkTangent,
        part: &ModelPart,
        system: &System,
        [mass_factor, damping_factor, alpha, beta]: InertiaKey,
        values: &mut [f64],
    ) -> Result<bool> {
        let single = !damped_by_properties(part, system);
        let [mass_factor, stiffness_factor] = if single {
            [mass_factor + alpha * damping_factor, 1.0 + beta * damping_factor]
        } else {
            [mass_factor, 1.0]
        };
        // Damping acts on rates only, which takes the symmetry from unknowns without them.
        let still = without_rates(system);
        let moves = |column: u32| !still.get(column as usize).copied().unwrap_or(false);
        let damped = !still.is_empty() && (!single || stiffness_factor != 1.0);
        let mass = self.mass(bulk, part, system)?;
        let pattern = bulk.matrix();
        fill_rows(&pattern.row_starts, values, |row, values| {
            let entries = values.iter_mut().zip(&mass[pattern.row_starts[row]..]).zip(pattern.columns_of(row));
            for ((value, m), &column) in entries {
                let factor = if moves(column) { stiffness_factor } else { 1.0 };
                *value = factor * *value + mass_factor * m;
            }
        });
        if !single {
            let damping = self.damping(bulk, part, system, [alpha, beta])?;
            fill_rows(&pattern.row_starts, values, |row, values| {
                let damping = &damping[pattern.row_starts[row]..];
                let entries = values.iter_mut().zip(damping).zip(pattern.columns_of(row));
                let moving = entries.filter(|(_, column)| moves(**column));
                moving.for_each(|((value, c), _)| *value += damping_factor * c);
            });
        }
        Ok(damped)
    }
}

/// The nodes at their initial positions: mass does not change with the motion.
pub(super) fn undeformed(part: &ModelPart) -> Nodes {
    let mut nodes = part.nodes.clone();
    nodes.current.clone_from(&nodes.initial);
    nodes
}

/// Rayleigh's factors of a block, whose entities share their properties; none for unknowns that do not know them.
fn rayleigh_of(part: &ModelPart, block: &dyn EntityBlock, [alpha, beta]: [f64; 2]) -> [f64; 2] {
    let names = block.unknowns().iter().find_map(|unknown| Rates::of(unknown.variable.column)?.rayleigh);
    let Some([of_mass, of_stiffness]) = names else { return [0.0; 2] };
    let first = block.members().first().map(|&member| part.elements.properties[member as usize]);
    let properties = first.and_then(|id| part.properties.get(&id));
    let own = |name: &str, default: f64| properties.and_then(|p| p.number(name)).unwrap_or(default);
    [own(of_mass, alpha), own(of_stiffness, beta)]
}
