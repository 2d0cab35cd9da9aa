//! Axes of a material: an orthogonal matrix whose rows are the axes 1, 2 and 3.
//!
//! A vector v has the components A v along them. Axes of an element are LOCAL_AXIS_1, LOCAL_AXIS_2 and their vector product, in the
//! plane LOCAL_AXIS_1, the direction a quarter turn from it, and that across. EULER_ANGLES φ, θ, ψ (degrees) of a material turn them
//! further: by φ about axis 3, by θ about the new axis 1, by ψ about the new axis 3.

use nalgebra::Vector3;

use zelus_core::diagnostics::{Diagnostic, Result};
use zelus_core::model::{Properties, PropertyValue};

use crate::tensor::{IDENTITY, Tensor};

/// Cosine between two axes up to which they are perpendicular.
const PERPENDICULAR: f64 = 1e-6;

/// Axes that the angles φ, θ, ψ (degrees) turn those of the space to.
pub(super) fn turned([phi, theta, psi]: [f64; 3]) -> Tensor {
    let about_third = |angle: f64| {
        let (s, c) = angle.to_radians().sin_cos();
        Tensor::new(c, s, 0.0, -s, c, 0.0, 0.0, 0.0, 1.0)
    };
    let (s, c) = theta.to_radians().sin_cos();
    about_third(psi) * Tensor::new(1.0, 0.0, 0.0, 0.0, c, s, 0.0, -s, c) * about_third(phi)
}

/// EULER_ANGLES of the properties as axes; those of the element where they are not given.
///
/// # Errors
/// Not three numbers; angles out of the plane, for laws of plane bodies and bodies of revolution.
pub(super) fn of_properties(properties: &Properties, planar: bool) -> Result<Tensor> {
    Ok(of_angles(properties, "EULER_ANGLES", 1, planar)?.first().copied().unwrap_or(IDENTITY))
}

/// LAYER_EULER_ANGLES of the properties as axes, one for each layer; none where they are not given.
///
/// # Errors
/// As [`of_properties`].
pub(super) fn of_layers(properties: &Properties, layers: usize, planar: bool) -> Result<Vec<Tensor>> {
    of_angles(properties, "LAYER_EULER_ANGLES", layers, planar)
}

fn of_angles(properties: &Properties, name: &str, count: usize, planar: bool) -> Result<Vec<Tensor>> {
    let problem = |fact: String, remedy: &str| {
        Diagnostic::error("material-axes", fact).at(properties.place.clone()).remedy(remedy.to_owned())
    };
    let Some(value) = properties.values.get(name) else { return Ok(Vec::new()) };
    let PropertyValue::Vector(angles) = value else {
        let fact = format!("{name} of properties {} is no list", properties.id);
        return Err(problem(fact, "write three angles φ, θ, ψ in degrees").into());
    };
    if angles.len() != 3 * count || !angles.iter().all(|angle| angle.is_finite()) {
        let fact = format!("{name} of properties {} has {} numbers", properties.id, angles.len());
        return Err(problem(fact, &format!("write {} finite angles in degrees, φ, θ, ψ", 3 * count)).into());
    }
    let angles = angles.as_chunks::<3>().0;
    if let Some([_, out, _]) = angles.iter().find(|[_, out, _]| planar && *out != 0.0) {
        let fact = format!("{name} of properties {} turns the axes out of the plane by {out}°", properties.id);
        return Err(problem(fact, "write 0 for θ: in the plane φ and ψ turn the axes").into());
    }
    Ok(angles.iter().map(|angles| turned(*angles)).collect())
}

/// Axes of an element from its LOCAL_AXIS_1 and LOCAL_AXIS_2; `None` where the first is not given, so that they are those of the space.
///
/// # Errors
/// A second axis that is missing or not perpendicular to the first; a first axis out of the plane of a `planar` element.
pub(crate) fn of_element(first: [f64; 3], second: [f64; 3], planar: bool) -> Result<Option<Tensor>, &'static str> {
    let Some(first) = Vector3::from(first).try_normalize(0.0) else {
        return if second == [0.0; 3] || planar { Ok(None) } else { Err("it has a LOCAL_AXIS_2 and no LOCAL_AXIS_1") };
    };
    if planar {
        if first.z.abs() > PERPENDICULAR {
            return Err("its LOCAL_AXIS_1 is not in the plane");
        }
        let (x, y) = (first.x, first.y);
        return Ok(Some(Tensor::new(x, y, 0.0, -y, x, 0.0, 0.0, 0.0, 1.0)));
    }
    let Some(second) = Vector3::from(second).try_normalize(0.0) else {
        return Err("it has a LOCAL_AXIS_1 and no LOCAL_AXIS_2");
    };
    if first.dot(&second).abs() > PERPENDICULAR {
        return Err("its LOCAL_AXIS_1 and LOCAL_AXIS_2 are not perpendicular");
    }
    let third = first.cross(&second).normalize();
    let second = third.cross(&first);
    Ok(Some(Tensor::from_rows(&[first.transpose(), second.transpose(), third.transpose()])))
}
