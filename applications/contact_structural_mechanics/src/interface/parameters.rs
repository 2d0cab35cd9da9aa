//! The estimate of penalty and scale factor from the stiffness of the bodies (eq. 4.11).
//!
//! ε = k = factor · E_mean / h_mean on each side, the means weighted by the area of the facets; the smaller side counts. A side
//! without facets does not count, nor does a slave side without Young's modulus.

use zelus_core::model::{ModelPart, ProcessInfo};
use zelus_structural_mechanics::laws::representative_young;

use super::facet::Roles;
use super::facets::Interface;
use crate::variables::{INITIAL_PENALTY, NODAL_H};

/// Penalty and scale factor of an interface, force per length cubed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AlmParameters {
    /// INITIAL_PENALTY, ε.
    pub penalty: f64,
    /// SCALE_FACTOR, k.
    pub scale_factor: f64,
}

impl AlmParameters {
    /// The same with `least_penalty` and 1 in the place of numbers that are not positive, as an estimate is of bodies without
    /// Young's modulus.
    pub fn with_floors(self, least_penalty: f64) -> Self {
        let or = |number: f64, floor: f64| if number > 0.0 { number } else { floor };
        Self { penalty: or(self.penalty, least_penalty), scale_factor: or(self.scale_factor, 1.0) }
    }
}

/// Numbers that take the place of the estimate of a contact process: manual ones, and those of another process.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct GivenParameters {
    /// INITIAL_PENALTY, ε.
    pub penalty: Option<f64>,
    /// SCALE_FACTOR, k.
    pub scale_factor: Option<f64>,
}

/// Names of the numbers of a process beside those of contact, in the process info.
const CALCULATED: [&str; 2] = ["CALCULATED_PENALTY", "CALCULATED_SCALE_FACTOR"];

impl GivenParameters {
    /// Writes the numbers into the process info, as INITIAL_PENALTY and SCALE_FACTOR and for the processes of contact.
    pub fn write(self, info: &mut ProcessInfo) {
        let results = [INITIAL_PENALTY.name(), "SCALE_FACTOR"];
        for ((calculated, result), number) in CALCULATED.into_iter().zip(results).zip([self.penalty, self.scale_factor])
        {
            if let Some(number) = number {
                info.values.extend([(calculated, number), (result, number)]);
            }
        }
    }

    /// These numbers, or in their place those that a process has written.
    #[must_use]
    pub fn or_written(self, info: &ProcessInfo) -> Self {
        let [penalty, scale_factor] = CALCULATED.map(|name| info.values.get(name).copied());
        Self { penalty: penalty.or(self.penalty), scale_factor: scale_factor.or(self.scale_factor) }
    }

    /// Removes written numbers, at the end of a stage.
    pub fn forget(info: &mut ProcessInfo) {
        for name in CALCULATED {
            info.values.remove(name);
        }
    }
}

/// The estimate of eq. 4.11 for all interfaces together.
///
/// `stiffness_factor` is the factor of E/h, `penalty_scale_factor` the ratio of scale factor and penalty.
pub fn alm_parameters(
    part: &ModelPart,
    interfaces: &[Interface],
    stiffness_factor: f64,
    penalty_scale_factor: f64,
) -> AlmParameters {
    let sizes = part.nodes.values.values(&NODAL_H, 0);
    let side = |role: Roles| {
        let (mut area, mut stiffness, mut length) = (0.0, 0.0, 0.0);
        let is_of_side = |f: &&super::facet::Facet| (f.role == role || f.role == Roles::Open) && !f.is_rigid();
        for facet in interfaces.iter().flat_map(|i| &i.facets).filter(is_of_side) {
            let size = facet.size(part);
            let young = part.properties.get(&facet.properties).and_then(representative_young).unwrap_or(0.0);
            area += size;
            stiffness += young * size;
            length += size / facet.nodes.len() as f64 * facet.nodes.iter().map(|&n| sizes[n as usize]).sum::<f64>();
        }
        (area > 0.0 && length > 0.0).then_some((stiffness, stiffness_factor * stiffness / length))
    };
    let slave = side(Roles::Slave).filter(|(stiffness, _)| *stiffness > 0.0).map(|(_, penalty)| penalty);
    let master = side(Roles::Master).map(|(_, penalty)| penalty);
    let penalty = match (slave, master) {
        (Some(slave), Some(master)) => slave.min(master),
        (slave, master) => slave.or(master).unwrap_or(0.0),
    };
    AlmParameters { penalty, scale_factor: penalty_scale_factor * penalty }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interface::{Facet, FacetSource};
    use zelus_core::geometry::Shape;
    use zelus_core::model::{Nodes, Properties, PropertyValue};

    /// A slave line of length 1 on a master line of length 2, of these moduli, in cells of 0.25 and 0.5.
    fn estimate(slave: Option<f64>, master: Option<f64>, factors: [f64; 2]) -> AlmParameters {
        let mut part = ModelPart::new("Structure");
        part.info.domain_size = 2;
        part.nodes = Nodes::new(vec![1, 2, 3, 4], [0.0, 1.0, 0.0, 2.0].map(|x| [x, 0.0, 0.0]).to_vec());
        part.nodes.values.values_mut(&NODAL_H, 0).copy_from_slice(&[0.25, 0.25, 0.5, 0.5]);
        for (id, young) in [(1, slave), (2, master)] {
            let mut properties = Properties::new(id);
            young.into_iter().for_each(|young| {
                properties.values.insert("YOUNG_MODULUS".to_owned(), PropertyValue::Number(young));
            });
            part.properties.insert(id, properties);
        }
        let facet = |nodes: [u32; 2], properties, role| Facet {
            nodes: nodes.to_vec(),
            shape: Shape::Line2,
            source: FacetSource::Face(0),
            element: 0,
            properties,
            role,
            exact: None,
        };
        let facets = vec![facet([0, 1], 1, Roles::Slave), facet([2, 3], 2, Roles::Master)];
        let interface = Interface { key: "0".to_owned(), facets, nodes: vec![0, 1, 2, 3], open: false };
        alm_parameters(&part, &[interface], factors[0], factors[1])
    }

    #[test]
    fn the_softer_side_counts_and_a_slave_without_modulus_does_not() {
        let found = |slave, master| estimate(slave, master, [1.0, 1.0]).penalty;
        assert_eq!(found(Some(100.0), Some(300.0)), 400.0);
        assert_eq!(found(Some(100.0), Some(10.0)), 20.0);
        assert_eq!(found(None, Some(10.0)), 20.0);
        assert_eq!(found(Some(100.0), None), 0.0);
    }

    #[test]
    fn written_numbers_take_the_place_of_given_ones() {
        let mut info = ProcessInfo::default();
        let manual = GivenParameters { penalty: Some(7.0), scale_factor: Some(5.0) };
        assert_eq!(manual.or_written(&info), manual);
        GivenParameters { penalty: None, scale_factor: Some(4.0) }.write(&mut info);
        assert_eq!(info.values.get("SCALE_FACTOR"), Some(&4.0));
        assert_eq!(info.values.get("INITIAL_PENALTY"), None);
        assert_eq!(manual.or_written(&info), GivenParameters { penalty: Some(7.0), scale_factor: Some(4.0) });
        GivenParameters::forget(&mut info);
        assert_eq!(manual.or_written(&info), manual);
    }

    #[test]
    fn factors_and_floors() {
        let AlmParameters { penalty, scale_factor } = estimate(Some(100.0), Some(300.0), [2.0, 5.0]);
        assert_eq!((penalty, scale_factor), (800.0, 4000.0));
        let none = estimate(None, None, [2.0, 5.0]);
        assert_eq!(none.with_floors(1e16), AlmParameters { penalty: 1e16, scale_factor: 1.0 });
        let some = AlmParameters { penalty: 3.0, scale_factor: 2.0 };
        assert_eq!(some.with_floors(1e16), some);
    }
}
