//! Coefficients of friction at the nodes, and the settings of friction.

use std::collections::BTreeMap;
use std::ops::RangeInclusive;

use zelus_core::Result;
use zelus_core::diagnostics::Diagnostic;
use zelus_core::model::ModelPart;
use zelus_structural_mechanics::variables::TEMPERATURE;

use crate::interface::{Interface, Roles};
use crate::law::{FrictionEllipse, FrictionLaw, Margin, SlipRule};
use crate::laws::friction::COULOMB;
use crate::pairs::Friction;

/// Coefficients that seem to be written in per cent: rough rubber has 2 or so, and far larger ones stand for perfect stick.
const PER_CENT: RangeInclusive<f64> = 10.5..=100.0;

/// Settings of friction.
#[derive(Debug, Clone, PartialEq)]
pub struct FrictionSettings {
    /// The law (`frictional_law`).
    pub law: &'static FrictionLaw,
    /// Coefficient by key of the pair, for surfaces whose properties have none.
    pub coefficients: BTreeMap<String, f64>,
    /// How far below its bound a sliding node sticks again (`slip_augmentation_coefficient`, `slip_threshold`).
    pub margin: Margin,
    /// Whether in the plane a node keeps the direction in which it began to slide (`sliding_direction`).
    pub keeps_direction: bool,
    /// Limit by direction, of multipliers (`friction_direction`, `friction_ratio`).
    pub ellipse: FrictionEllipse,
    /// Every so many steps all nodes start in stick; `None` for never (`slip_step_reset_frequency`).
    pub reset_frequency: Option<usize>,
}

impl Default for FrictionSettings {
    fn default() -> Self {
        Self {
            law: &COULOMB,
            coefficients: BTreeMap::new(),
            margin: Margin::default(),
            keeps_direction: true,
            ellipse: FrictionEllipse::default(),
            reset_frequency: None,
        }
    }
}

/// Writes the number of the law, the mean over the facets of a node, and says how stick and slip are told apart. Facets whose
/// properties have none count with the pair's coefficient where the law takes one, else with the node's own coefficient. Without a
/// number anywhere, contact always slides, and a warning among the `messages` says so; so does one of numbers without friction.
///
/// # Errors
/// A number below zero.
pub(crate) fn prepare(
    part: &mut ModelPart,
    interfaces: &[Interface],
    settings: &FrictionSettings,
    friction: Friction,
    messages: &mut Vec<Diagnostic>,
) -> Result<SlipRule> {
    let mut sums = vec![(0.0, 0_usize); part.nodes.len()];
    let mut largest = 0.0_f64;
    let mut without: Vec<&str> = Vec::new();
    let law = settings.law;
    let written = part.nodes.values.values(law.variable(), 0);
    let mut overridden: Option<(&str, f64, usize, f64)> = None;
    for interface in interfaces {
        let listed = settings.coefficients.get(&interface.key).copied().filter(|_| law.by_coefficients);
        let (mut slaves, mut bare) = (0, 0);
        let mut of_sides: [Option<(f64, usize)>; 2] = [None; 2];
        let given = listed.filter(|coefficient| *coefficient > 0.0);
        for facet in &interface.facets {
            let own = part.properties.get(&facet.properties).and_then(|p| p.number(law.variable().name()));
            if let (Some(own), Some(given)) = (own, given.filter(|given| own != Some(*given))) {
                overridden.get_or_insert((&interface.key, given, facet.properties, own));
            }
            let mut is_given = listed.is_some() || own.is_some();
            for &node in &facet.nodes {
                let nodal = written.get(node as usize).copied().filter(|number| *number > 0.0);
                let coefficient = own.or(given).or(nodal).unwrap_or(0.0);
                largest = largest.max(coefficient);
                is_given |= nodal.is_some();
                if coefficient < 0.0 {
                    let (name, id) = (law.variable().name(), facet.properties);
                    let fact = format!("{name} of properties {id} is {coefficient}, it must be 0 or more");
                    return Err(Diagnostic::error("negative-friction", fact).remedy("write a number from 0").into());
                }
                let (sum, count) = &mut sums[node as usize];
                *sum += coefficient;
                *count += 1;
            }
            let side = &mut of_sides[usize::from(facet.role == Roles::Master)];
            // A rigid shape has no material.
            *side = side.or(own.filter(|_| !facet.is_rigid()).map(|own| (own, facet.properties)));
            // The coefficient of a pair is that of its slave nodes.
            if facet.role != Roles::Master {
                slaves += 1;
                bare += usize::from(!is_given);
            }
        }
        if let [Some((own, id)), Some((other, other_id))] = of_sides
            && own != other
            && friction == Friction::Coulomb
        {
            let name = law.variable().name();
            let fact = format!(
                "pair \"{}\": {name} is {own} in properties {id} of the slave, and {other} in properties {other_id} of the master: \
                 that of the slave counts",
                interface.key
            );
            messages.push(Diagnostic::warning("friction-overridden", fact).remedy("give both sides the same"));
        }
        if bare == slaves {
            without.push(&interface.key);
        } else if bare > 0 && friction == Friction::Coulomb {
            let name = law.variable().name();
            let fact = format!(
                "{bare} of {slaves} slave facets of pair \"{}\" have no {name}: they slide freely",
                interface.key
            );
            let remedy = format!("give {name} in the materials of all slave surfaces, 0 where there is no friction");
            messages.push(Diagnostic::warning("no-friction", fact).remedy(remedy));
        }
    }
    if let Some((pair, given, id, own)) = overridden.filter(|_| friction == Friction::Coulomb) {
        let name = law.variable().name();
        let fact = format!(
            "\"friction_coefficients\" gives pair \"{pair}\" {given}, {name} of properties {id} is {own}: that of the properties counts"
        );
        let remedy = "take one of the two out";
        messages.push(Diagnostic::warning("friction-overridden", fact).remedy(remedy));
    }
    if friction == Friction::None {
        messages.extend(unread_coefficient(part, interfaces, law));
    }
    if law.by_coefficients && PER_CENT.contains(&largest) {
        let fact = format!("the largest {} is {largest}", law.variable().name());
        let remedy = "write the ratio of forces, e.g. 0.3 for 30 %";
        messages.push(Diagnostic::warning("large-friction", fact).remedy(remedy));
    }
    let column = part.nodes.values.values_mut(law.variable(), 0);
    for (slot, (sum, count)) in column.iter_mut().zip(sums) {
        *slot = sum / count.max(1) as f64;
    }
    if friction != Friction::None {
        check_temperature(part, law)?;
        read_further_numbers(part, interfaces, law)?;
    }
    if friction == Friction::Coulomb && !without.is_empty() {
        let name = law.variable().name();
        let fact = if without.len() == interfaces.len() {
            format!("contact with friction has no {name}: everything slides freely")
        } else {
            format!("contact with friction has no {name} in pair {}: it slides freely there", listed_pairs(&without))
        };
        let remedy = format!(
            "give {name} in the materials of the contact surfaces, or \"friction_coefficients\" of the process"
        );
        messages.push(Diagnostic::warning("no-friction", fact).remedy(remedy));
    }
    let pure = friction == Friction::PureSlip || largest <= 0.0;
    Ok(if pure { SlipRule::Pure } else { SlipRule::Bounded(settings.margin) })
}

/// Laws that depend on the temperature need one.
///
/// # Errors
/// Nodes without TEMPERATURE.
fn check_temperature(part: &ModelPart, law: &FrictionLaw) -> Result<()> {
    if !law.depends_on_temperature() || part.nodes.history.has(TEMPERATURE.name()) {
        return Ok(());
    }
    let fact = "the law of friction depends on TEMPERATURE, which nodes do not have";
    let remedy = "solve for heat, too (\"solver_type\": \"ThermoMechanicallyCoupled\"), or take Coulomb's law";
    Err(Diagnostic::error("friction-temperature", fact).remedy(remedy).into())
}

/// Writes all numbers of the law but the first, the mean over the slave facets of a node.
///
/// # Errors
/// A number that neither the properties nor a node of a slave facet with friction have, and numbers that do not fit together.
fn read_further_numbers(part: &mut ModelPart, interfaces: &[Interface], law: &FrictionLaw) -> Result<()> {
    for (at, variable) in law.variables().enumerate().skip(1) {
        let any_sign = at >= law.strengths.len() + law.constants.len();
        let mut sums = vec![(0.0, 0_usize); part.nodes.len()];
        let [first, written] = [law.variable(), variable].map(|own| part.nodes.values.values(own, 0));
        let facets = interfaces.iter().flat_map(|own| own.facets.iter().map(move |facet| (&own.key, facet)));
        for (pair, facet) in facets.filter(|(_, facet)| facet.role != Roles::Master) {
            let own = part.properties.get(&facet.properties).and_then(|p| p.number(variable.name()));
            for &node in &facet.nodes {
                let at = node as usize;
                let number = own
                    .or_else(|| written.get(at).copied().filter(|number| *number > 0.0 || (any_sign && *number < 0.0)));
                if number.is_none() && first.get(at).is_some_and(|strength| *strength > 0.0) {
                    let (name, id) = (variable.name(), facet.properties);
                    let fact = format!("the law of friction of pair \"{pair}\" has no {name} in properties {id}");
                    let remedy = format!("give {name} in the materials of the slave surface");
                    return Err(Diagnostic::error("missing-constant", fact).remedy(remedy).into());
                }
                let number = number.unwrap_or(0.0);
                if number < 0.0 && !any_sign {
                    let (name, id) = (variable.name(), facet.properties);
                    let fact = format!("{name} of properties {id} is {number}, it must be 0 or more");
                    return Err(Diagnostic::error("negative-friction", fact).remedy("write a number from 0").into());
                }
                let (sum, count) = &mut sums[at];
                *sum += number;
                *count += 1;
            }
        }
        let means = sums.iter().map(|(sum, count)| sum / (*count).max(1) as f64);
        part.nodes.values.values_mut(variable, 0).iter_mut().zip(means).for_each(|(slot, mean)| *slot = mean);
    }
    let first = part.nodes.values.values(law.variable(), 0);
    for facet in interfaces.iter().flat_map(|own| &own.facets).filter(|facet| facet.role != Roles::Master) {
        let rubs = facet.nodes.iter().filter(|&&node| first.get(node as usize).is_some_and(|strength| *strength > 0.0));
        for &node in rubs {
            if let Err(why) = law.check_at(&part.nodes, node as usize) {
                let fact = format!("numbers of friction of properties {} do not fit: {why}", facet.properties);
                return Err(Diagnostic::error("friction-numbers", fact).remedy("correct the materials").into());
            }
        }
    }
    Ok(())
}

/// The warning that properties of contact without friction give a number of the law.
pub(crate) fn unread_coefficient(part: &ModelPart, interfaces: &[Interface], law: &FrictionLaw) -> Option<Diagnostic> {
    let name = law.variable().name();
    let mut facets = interfaces.iter().flat_map(|own| own.facets.iter().map(move |facet| (&own.key, facet.properties)));
    let number = |id: &usize| part.properties.get(id).and_then(|own| own.number(name)).filter(|own| *own > 0.0);
    let (pair, id, own) = facets.find_map(|(pair, id)| Some((pair, id, number(&id)?)))?;
    let fact = format!("{name} of properties {id} is {own}, and contact of pair \"{pair}\" is without friction");
    let remedy = "choose a frictional \"contact_type\", or take the coefficient out";
    Some(Diagnostic::warning("variable-without-effect", fact).remedy(remedy))
}

/// Keys of pairs in quotation marks.
fn listed_pairs(keys: &[&str]) -> String {
    keys.iter().map(|key| format!("\"{key}\"")).collect::<Vec<_>>().join(", ")
}
