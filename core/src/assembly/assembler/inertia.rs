//! What moves: mass and damping matrices on the pattern of the bulk, and the forces they take up.

use zelus_linear_algebra::vector::{clear, copy, zeros};

use super::{Assembler, is_variable};
use crate::assembly::{Dof, System};
use crate::diagnostics::Result;
use crate::entities::{EntityBlock, LocalSystems, StepView, Tangent, Want};
use crate::model::{ModelPart, Nodes, Rates, Role};

/// What inertia and damping add: factors of the mass and damping matrices in the tangent, and the fields they act on.
///
/// Damping is Rayleigh's, C = alpha M + beta K; factors of an element's properties ([`Rates::rayleigh`]) go before. It acts on
/// first derivatives; unknowns without an entry of [`Rates`] have none.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Inertia {
    /// Factor of M in the tangent, 1/time².
    pub mass_factor: f64,
    /// Factor of C in the tangent, 1/time.
    pub damping_factor: f64,
    /// Rayleigh's alpha, 1/time.
    pub alpha: f64,
    /// Rayleigh's beta, time.
    pub beta: f64,
    /// Acceleration that M acts on, a number an unknown.
    pub acceleration: Vec<f64>,
    /// Velocity that C acts on, a number an unknown.
    pub velocity: Vec<f64>,
    /// Forces of the step before that still act, a number an unknown; empty for none.
    pub carried: Vec<f64>,
}

impl Assembler {
    /// M a + C v less the forces carried over: what inertia and damping take up, over all unknowns.
    ///
    /// # Errors
    /// An entity that cannot be computed.
    pub fn inertia_forces(&mut self, part: &ModelPart, system: &System, inertia: &Inertia) -> Result<Vec<f64>> {
        let own = self.own_inertia_forces(part, system, inertia);
        let mut out = part.ranks.agree(own)?;
        self.add_up(&mut out);
        Ok(out)
    }

    pub(super) fn own_inertia_forces(
        &mut self,
        part: &ModelPart,
        system: &System,
        inertia: &Inertia,
    ) -> Result<Vec<f64>> {
        self.ensure_constant(part, system)?;
        let mut out = vec![0.0; system.dofs.len()];
        let single = !damped_by_properties(part, system);
        let alpha = if single { inertia.alpha } else { 0.0 };
        let minus: Vec<f64> =
            inertia.acceleration.iter().zip(&inertia.velocity).map(|(a, v)| -(a + alpha * v)).collect();
        self.mass(part, system)?;
        self.mul_subtract(self.mass.as_ref().expect("just made"), &minus, &mut out);
        let minus = |factor: f64| inertia.velocity.iter().map(|v| -factor * v).collect::<Vec<f64>>();
        if !single {
            let damping = self.damping(part, system, [inertia.alpha, inertia.beta])?;
            self.mul_subtract(&damping, &minus(1.0), &mut out);
        } else if inertia.beta != 0.0 {
            self.mul_subtract(&self.stiffness(part, system, Vec::new())?, &minus(inertia.beta), &mut out);
        }
        let is_own = |number: usize| self.distribution.as_ref().is_none_or(|d| d.is_own(number));
        let carried = out.iter_mut().zip(&inertia.carried).enumerate();
        carried.filter(|(number, _)| is_own(*number)).for_each(|(_, (sum, force))| *sum -= force);
        Ok(out)
    }

    /// The damping matrix on the bulk pattern, where properties have factors of their own or elements are dampers.
    pub(super) fn damping(&mut self, part: &ModelPart, system: &System, rayleigh: [f64; 2]) -> Result<Vec<f64>> {
        if let Some((_, values)) = self.damping.as_ref().filter(|(key, _)| *key == rayleigh) {
            return Ok(values.clone());
        }
        let view = part.view();
        let nodes = undeformed(part);
        let initial = StepView { nodes: &nodes, ..view };
        let mut values = zeros(self.pattern.matrix.entries());
        let mut lasting = true;
        let numbered = system.elements.iter().zip(&self.element_numbers);
        for (block, numbers) in numbered.chain(system.conditions.iter().zip(&self.condition_numbers)) {
            let element = block.entry().role == Role::Element;
            let [alpha, beta] = if element { rayleigh_of(part, block.as_ref(), rayleigh) } else { [0.0, rayleigh[1]] };
            if alpha != 0.0 {
                let lumped = self.lumped;
                let compute = |range, out: &mut LocalSystems| {
                    block.mass(&initial, range, lumped, out).map(|_| out.lhs.iter_mut().for_each(|m| *m *= alpha))
                };
                self.pattern.add(block.as_ref(), numbers, &mut values, &compute)?;
            }
            let stiff = match block.tangent() {
                Tangent::Zero => false,
                Tangent::General => element,
                Tangent::Constant | Tangent::Symmetric => true,
            };
            if beta != 0.0 && stiff {
                let compute = |range, out: &mut LocalSystems| {
                    let systems = block.local_systems(&view, range, Want::Both, out);
                    systems.map(|()| out.lhs.iter_mut().for_each(|k| *k *= beta))
                };
                self.pattern.add(block.as_ref(), numbers, &mut values, &compute)?;
                lasting &= block.tangent() == Tangent::Constant;
            }
            if element && block.has_damping() {
                let compute = |range, out: &mut LocalSystems| {
                    block.damping(&view, range, out);
                    Ok(())
                };
                self.pattern.add(block.as_ref(), numbers, &mut values, &compute)?;
            }
        }
        if lasting {
            self.damping = Some((rayleigh, values.clone()));
        }
        Ok(values)
    }

    /// The mass matrix on the bulk pattern, that of the initial positions, without what [`Assembler::redistribute`] took off.
    ///
    /// # Errors
    /// An entity that cannot be computed.
    pub fn mass(&mut self, part: &ModelPart, system: &System) -> Result<&[f64]> {
        if self.mass.is_none() {
            let nodes = undeformed(part);
            let view = StepView { nodes: &nodes, ..part.view() };
            let mut values = zeros(self.pattern.matrix.entries());
            for (block, numbers) in system.elements.iter().zip(&self.element_numbers) {
                let lumped = self.lumped;
                let compute = |range, out: &mut LocalSystems| block.mass(&view, range, lumped, out).map(|_| ());
                self.pattern.add(block.as_ref(), numbers, &mut values, &compute)?;
            }
            self.redistribution.apply(&self.pattern.matrix, &mut values);
            self.mass = Some(values);
        }
        Ok(self.mass.as_ref().expect("just made"))
    }

    /// Row sums of the mass matrix, a number an unknown.
    ///
    /// # Errors
    /// As [`Assembler::mass`].
    pub fn lumped_mass(&mut self, part: &ModelPart, system: &System) -> Result<Vec<f64>> {
        let own = self.mass(part, system).map(<[f64]>::to_vec);
        let values = part.ranks.agree(own)?;
        let mut out = vec![0.0; system.dofs.len()];
        self.mul_subtract(&values, &vec![-1.0; system.dofs.len()], &mut out);
        self.add_up(&mut out);
        Ok(out)
    }

    /// Tangents of elements, and of conditions that keep it symmetric; in the `memory` of earlier ones.
    pub(super) fn stiffness(&self, part: &ModelPart, system: &System, memory: Vec<f64>) -> Result<Vec<f64>> {
        let entries = self.pattern.matrix.entries();
        let mut values = if memory.len() == entries { memory } else { zeros(entries) };
        match self.constant.as_deref().expect("assembled before the first residual") {
            [] => clear(&mut values),
            constant => copy(constant, &mut values),
        }
        let is_element = |block: &dyn EntityBlock| block.entry().role == Role::Element;
        self.add_blocks(
            part,
            system,
            |block| is_variable(block) && (is_element(block) || block.tangent() == Tangent::Symmetric),
            &mut values,
        )?;
        Ok(values)
    }
}

/// The nodes at their initial positions: mass does not change with the motion.
fn undeformed(part: &ModelPart) -> Nodes {
    let mut nodes = part.nodes.clone();
    nodes.current.clone_from(&nodes.initial);
    nodes
}

/// Whether the properties of an element give Rayleigh's factors, which then go before those of the solver, or some elements
/// are dampers.
pub fn damped_by_properties(part: &ModelPart, system: &System) -> bool {
    part.properties
        .values()
        .any(|p| Rates::all().filter_map(|r| r.rayleigh).flatten().any(|name| p.number(name).is_some()))
        || system.elements.iter().any(|block| block.has_damping())
}

/// Which unknowns have no rate for damping to act on; empty when elements have none of them.
pub(super) fn without_rates(system: &System) -> Vec<bool> {
    let rateless = |dof: &Dof| dof.rates().is_none();
    let dofs = system.dofs.dofs();
    if dofs.iter().any(|dof| !dof.multiplier && rateless(dof)) {
        dofs.iter().map(rateless).collect()
    } else {
        Vec::new()
    }
}

/// The largest of Rayleigh's factors, those of the solver and of all properties.
pub fn strongest_damping(part: &ModelPart, [alpha, beta]: [f64; 2]) -> [f64; 2] {
    let names = Rates::all().filter_map(|rates| rates.rayleigh);
    let all = names.flat_map(|names| part.properties.values().map(move |properties| (names, properties)));
    all.fold([alpha, beta], |[alpha, beta], ([of_mass, of_stiffness], properties)| {
        let own = |name: &str, other: f64| properties.number(name).map_or(other, |own| own.max(other));
        [own(of_mass, alpha), own(of_stiffness, beta)]
    })
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
