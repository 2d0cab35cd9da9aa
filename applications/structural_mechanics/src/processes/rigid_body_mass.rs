//! Mass and inertia of a rigid body, as masses at points that move with its reference node.
//!
//! Masses m/6 at c ± √(3 e_i/m) v_i have the mass m, the centre c and the inertia J about it, where e_i and v_i are eigenvalues and
//! unit eigenvectors of E = ½ tr(J) I − J = ∫ r rᵀ dm. In the plane, masses m/4 at c ± √(J/m) along x and y have them. Rotations of
//! any size, gyroscopic moments, weight and energy follow from the motion of the points.

use nalgebra::Matrix3;
use zelus_core::diagnostics::Result;
use zelus_core::entities::require_kind;
use zelus_core::model::{EntityRole, ModelPart, SubPart};
use zelus_core::parameters::Settings;
use zelus_core::vector3::{add, norm, scale, sub};

use super::reference_node::not_shared;
use crate::tensor::{Tensor, eigen};
use crate::variables::NODAL_MASS;

const MASS: &str = "mass";
const INERTIA: &str = "inertia";
const CENTRE: &str = "centre_of_mass";
/// Added to the name of the part of the reference node for that of the points.
const SUFFIX: &str = "_masses";
/// Share of the largest moment of inertia that is round-off of the numbers given.
const ROUND_OFF: f64 = 1e-12;

/// A mass at a point of the body.
type PointMass = ([f64; 3], f64);

/// Name of the part with the points of a reference node's part.
pub(super) fn part_of_masses(reference: &str) -> String {
    format!("{reference}{SUFFIX}")
}

/// The masses that the settings give, by their arms from the reference node at a point.
///
/// # Errors
/// Inertia or centre without mass, an inertia that no body has.
pub(super) fn masses(settings: &Settings, space: usize, reference: [f64; 3]) -> Result<Vec<PointMass>> {
    let centre = settings.get(CENTRE)?;
    if centre.is_null() {
        return masses_about_centre(settings, space);
    }
    let offset = sub(centre.parse(CENTRE)?, reference);
    let masses = masses_about_centre(settings, space)?;
    if masses.is_empty() {
        let problem = settings.error(CENTRE, "inertia", format!("\"{CENTRE}\" is given without \"{MASS}\""));
        return Err(problem.remedy("give the mass, too, or take the centre out").into());
    }
    Ok(masses.into_iter().map(|(arm, mass)| (add(arm, offset), mass)).collect())
}

/// As [`masses`], by their arms from the centre of mass.
fn masses_about_centre(settings: &Settings, space: usize) -> Result<Vec<PointMass>> {
    let mass = settings.get_f64(MASS)?;
    let problem = |fact: String, remedy: &str| settings.error(INERTIA, "inertia", fact).remedy(remedy.to_owned());
    let Some(inertia) = inertia(settings, space)? else {
        return Ok(if mass > 0.0 { vec![([0.0; 3], mass)] } else { Vec::new() });
    };
    if mass == 0.0 {
        let fact = format!("\"{INERTIA}\" is given without \"{MASS}\"");
        return Err(problem(fact, "give the mass, too; any one where supports hold the reference node").into());
    }
    let size = inertia.amax();
    if !size.is_finite() || (inertia - inertia.transpose()).amax() > ROUND_OFF * size {
        return Err(problem(format!("\"{INERTIA}\" is not symmetric"), "give J_ij = ∫ (r² δ_ij − r_i r_j) dm").into());
    }
    let axes: Vec<(f64, [f64; 3])> = if space == 2 {
        let radius = (inertia[(2, 2)] / mass).sqrt();
        vec![(radius, [1.0, 0.0, 0.0]), (radius, [0.0, 1.0, 0.0])]
    } else {
        let moments = Tensor::from_diagonal_element(0.5 * inertia.trace()) - inertia;
        let (values, vectors) = eigen(&moments);
        if values.min() < -ROUND_OFF * size {
            let fact = "no body has this inertia: one of its principal moments is larger than the sum of the others";
            return Err(problem(fact.to_owned(), "check signs and units; moments are about the centre of mass").into());
        }
        let radius = |i: usize| if values[i] > ROUND_OFF * size { (3.0 * values[i] / mass).sqrt() } else { 0.0 };
        (0..3).map(|i| (radius(i), vectors.column(i).into_owned().into())).collect()
    };
    let each = 0.5 * mass / axes.len() as f64;
    let (off_centre, at_centre): (Vec<_>, Vec<_>) = axes.into_iter().partition(|(radius, _)| *radius > 0.0);
    let pairs = off_centre.into_iter().flat_map(|(radius, axis)| [scale(axis, radius), scale(axis, -radius)]);
    let rest = 2.0 * each * at_centre.len() as f64;
    let centre = (rest > 0.0).then_some(([0.0; 3], rest));
    Ok(pairs.map(|arm| (arm, each)).chain(centre).collect())
}

/// Inertia about the centre of mass: a number in the plane; three moments or a matrix in space.
fn inertia(settings: &Settings, space: usize) -> Result<Option<Tensor>> {
    let node = settings.get(INERTIA)?;
    if node.is_null() {
        return Ok(None);
    }
    let found = match node.as_f64() {
        Some(moment) if space == 2 => Some(Tensor::from_diagonal(&[0.0, 0.0, moment].into())),
        _ if space == 2 => None,
        _ => {
            let rows = node.parse::<[[f64; 3]; 3]>(INERTIA).ok().map(|rows| Matrix3::from_fn(|i, j| rows[i][j]));
            rows.or_else(|| node.parse::<[f64; 3]>(INERTIA).ok().map(|own| Tensor::from_diagonal(&own.into())))
        }
    };
    let is_positive = |inertia: &Tensor| (0..3).all(|i| inertia[(i, i)] >= 0.0) && inertia.trace() > 0.0;
    match found.filter(is_positive) {
        Some(inertia) => Ok(Some(inertia)),
        None => {
            let fact = format!("\"{INERTIA}\" is not a moment of inertia");
            let remedy = match space {
                2 => "give a positive number, the moment about an axis along z through the centre of mass",
                _ => "give three positive moments [J_xx, J_yy, J_zz], or three rows of the matrix",
            };
            Err(settings.error(INERTIA, "inertia", fact).remedy(remedy).into())
        }
    }
}

/// Adds elements with these masses, and nodes for those off the reference node, in a part beside that of the reference node.
///
/// # Errors
/// A mesh that ranks share already.
pub(super) fn add_to_mesh(
    part: &mut ModelPart,
    reference: (&str, u32),
    masses: &[PointMass],
    settings: &Settings,
) -> Result<()> {
    let (path, centre) = reference;
    let own_path = part_of_masses(path);
    if masses.is_empty() || part.part(&own_path).is_ok() {
        return Ok(());
    }
    not_shared(part, path, &settings.key_place(MASS))?;
    let kind = require_kind(EntityRole::Element, &format!("NodalConcentratedElement{}D1N", part.info.domain_size))?;
    let properties = part.properties.keys().next().copied().unwrap_or(0);
    let (above, name) = own_path.rsplit_once('.').unwrap_or(("", &own_path));
    let origin = part.nodes.initial[centre as usize];
    let mut own = SubPart::new(name);
    let next = part.elements.max_id() + 1;
    for (id, (arm, _)) in (next..).zip(masses) {
        let node = if norm(*arm) > 0.0 { part.add_node(add(origin, *arm)) } else { centre };
        own.nodes.push(node);
        own.elements.push(part.elements.push(id, kind, properties, &[node]));
    }
    part.elements.finish();
    for (&at, (_, mass)) in own.elements.iter().zip(masses) {
        part.elements.data.values_mut(&NODAL_MASS, 0)[at as usize] = *mass;
    }
    part.along(above, |parent| {
        parent.nodes.extend(&own.nodes);
        parent.elements.extend(&own.elements);
    });
    part.part_mut(above)?.children.insert(name.to_owned(), own);
    part.tree.normalise();
    Ok(())
}

#[cfg(test)]
mod tests {
    use zelus_core::parameters::{Defaults, Document};

    use super::*;

    fn settings(text: &str) -> Settings {
        let defaults =
            Defaults::parse("body", r#"{"mass": 0.0, "centre_of_mass": null, "inertia": null}"#).expect("defaults");
        let given = Document::from_str(text, "deck.json").expect("a deck").root;
        Settings::check(&given, &defaults).expect("settings").0
    }

    /// ANALYTIC: mass, centre and inertia of the points; to round-off.
    #[test]
    fn points_have_the_mass_and_the_inertia_of_the_body() {
        for (text, space, count, mass, wanted) in [
            (r#"{"mass": 2.0}"#, 3, 1, 2.0, [[0.0; 3]; 3]),
            (
                r#"{"mass": 2.0, "inertia": [3.0, 4.0, 5.0]}"#,
                3,
                6,
                2.0,
                [[3.0, 0.0, 0.0], [0.0, 4.0, 0.0], [0.0, 0.0, 5.0]],
            ),
            // A disc without thickness, a rod.
            (
                r#"{"mass": 2.0, "inertia": [1.0, 1.0, 2.0]}"#,
                3,
                5,
                2.0,
                [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 2.0]],
            ),
            (
                r#"{"mass": 2.0, "inertia": [1.0, 0.0, 1.0]}"#,
                3,
                3,
                2.0,
                [[1.0, 0.0, 0.0], [0.0, 0.0, 0.0], [0.0, 0.0, 1.0]],
            ),
            (
                r#"{"mass": 0.5, "inertia": [[3.0, 0.5, -0.2], [0.5, 4.0, 0.1], [-0.2, 0.1, 5.0]]}"#,
                3,
                6,
                0.5,
                [[3.0, 0.5, -0.2], [0.5, 4.0, 0.1], [-0.2, 0.1, 5.0]],
            ),
            (r#"{"mass": 2.0, "inertia": 3.0}"#, 2, 4, 2.0, [[1.5, 0.0, 0.0], [0.0, 1.5, 0.0], [0.0, 0.0, 3.0]]),
        ] {
            let points = masses(&settings(text), space, [5.0; 3]).expect("masses");
            assert_eq!(points.len(), count, "{text}");
            let total: f64 = points.iter().map(|(_, m)| m).sum();
            assert!((total - mass).abs() < 1e-15, "{text}: {total}");
            for i in 0..3 {
                let first: f64 = points.iter().map(|(r, m)| m * r[i]).sum();
                assert!(first.abs() < 1e-14, "{text}: centre {first}");
                for j in 0..3 {
                    let square = |r: &[f64; 3]| if i == j { r.iter().map(|x| x * x).sum::<f64>() } else { 0.0 };
                    let own: f64 = points.iter().map(|(r, m)| m * (square(r) - r[i] * r[j])).sum();
                    assert!((own - wanted[i][j]).abs() < 1e-13, "{text}: J_{i}{j} = {own}");
                }
            }
        }
    }

    #[test]
    fn inertia_of_no_body_is_named() {
        for (text, space, wanted) in [
            (r#"{"mass": 1.0, "inertia": [1.0, 1.0, 3.0]}"#, 3, "larger than the sum of the others"),
            (r#"{"mass": 1.0, "inertia": [1.0, -1.0, 1.0]}"#, 3, "is not a moment of inertia"),
            (r#"{"mass": 1.0, "inertia": 1.0}"#, 3, "is not a moment of inertia"),
            (r#"{"mass": 1.0, "inertia": [1.0, 1.0, 1.0]}"#, 2, "is not a moment of inertia"),
            (r#"{"inertia": [1.0, 1.0, 1.0]}"#, 3, "without \"mass\""),
            (r#"{"mass": 1.0, "inertia": [[1.0, 0.1, 0.0], [0.2, 1.0, 0.0], [0.0, 0.0, 1.0]]}"#, 3, "is not symmetric"),
            (r#"{"centre_of_mass": [1.0, 1.0, 1.0]}"#, 3, "\"centre_of_mass\" is given without"),
        ] {
            let said = masses(&settings(text), space, [0.0; 3]).expect_err(text).to_string();
            assert!(said.contains(wanted), "{text}: {said}");
        }
    }
}
