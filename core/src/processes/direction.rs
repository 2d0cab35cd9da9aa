//! A vector given by its modulus and direction.

use super::scalar_value::ScalarValue;
use super::target::Target;
use crate::diagnostics::{Diagnostic, Place, Result};
use crate::geometry::{ShapeTable, mapping};
use crate::model::{Model, ModelPart};
use crate::parameters::{Node, Settings};
use crate::vector3::{add, norm, scale};

/// A direction as the deck gives it.
#[derive(Debug, Clone)]
pub(super) enum Direction {
    /// Three values; of unit length when all are numbers, as they are otherwise.
    Given([ScalarValue; 3]),
    /// Along (+1) or against (−1) the mean normal of the conditions of the part.
    Normal(f64),
}

impl Direction {
    /// Reads `"direction"`: three numbers or functions, or the name of a normal.
    ///
    /// Only the first `dimensions` entries count for the length; `smallest` is the length that is refused as zero.
    ///
    /// # Errors
    /// `invalid-direction`, and those of [`ScalarValue::from_node`].
    pub(super) fn from_node(node: &Node, dimensions: usize, smallest: f64) -> Result<Self> {
        match node.as_str() {
            Some("automatic_outwards_normal") => return Ok(Self::Normal(1.0)),
            Some("automatic_inwards_normal") => return Ok(Self::Normal(-1.0)),
            _ => {}
        }
        let Some([x, y, z]) = node.as_array() else {
            let fact = format!("a direction must be three numbers or functions, found {node}");
            let remedy = "write e.g. [0.0, -1.0, 0.0], \"automatic_inwards_normal\" or \"automatic_outwards_normal\"";
            return Err(Diagnostic::error("invalid-direction", fact).at(node.place()).remedy(remedy).into());
        };
        let entries = [ScalarValue::from_node(x)?, ScalarValue::from_node(y)?, ScalarValue::from_node(z)?];
        let (Some(x), Some(y), Some(z)) = (x.as_f64(), y.as_f64(), z.as_f64()) else { return Ok(Self::Given(entries)) };
        let vector = [x, y, z];
        let length = vector[..dimensions].iter().map(|c| c * c).sum::<f64>().sqrt();
        if length < smallest {
            return Err(zero_length(&node.place()).into());
        }
        Ok(Self::Given(vector.map(|c| ScalarValue::Number(c / length))))
    }

    /// The three components of the vector; the model decides the normal.
    ///
    /// # Errors
    /// `invalid-direction` when the normals of the part's conditions cancel or there are none.
    pub(super) fn components(
        &self,
        modulus: &ScalarValue,
        target: &Target,
        model: &Model,
        smallest: f64,
    ) -> Result<[ScalarValue; 3]> {
        let direction = match self {
            Self::Given(entries) => entries.clone(),
            Self::Normal(sign) => {
                let sum = sum_of_normals(target, model.root(&target.path)?)?;
                let length = norm(sum);
                if length < smallest {
                    return Err(zero_length(&target.place).into());
                }
                scale(sum, sign / length).map(ScalarValue::Number)
            }
        };
        Ok(direction.map(|d| match (&d, modulus) {
            (ScalarValue::Number(d), ScalarValue::Number(m)) => ScalarValue::Number(m * d),
            _ => ScalarValue::Product(Box::new([d, modulus.clone()])),
        }))
    }
}

/// Reads `"modulus"`.
///
/// # Errors
/// As [`ScalarValue::from_node`].
pub(super) fn modulus(settings: &Settings) -> Result<ScalarValue> {
    ScalarValue::from_node(settings.get("modulus")?)
}

fn zero_length(place: &Place) -> Diagnostic {
    Diagnostic::error("invalid-direction", "the direction has no length")
        .at(place.clone())
        .remedy("give a direction that is not zero; for an automatic one, a part whose normals do not cancel")
}

/// Sum of the area normals of the conditions of the part, on the present positions.
fn sum_of_normals(target: &Target, part: &ModelPart) -> Result<[f64; 3]> {
    let mut sum = [0.0; 3];
    for &condition in &target.selection(&part.tree)?.conditions {
        let Some(shape) = part.conditions.kinds[condition as usize].cell else { continue };
        let x: Vec<[f64; 3]> =
            part.conditions.nodes(condition).iter().map(|&n| part.nodes.current[n as usize]).collect();
        for point in ShapeTable::default_of(shape).points() {
            sum = add(sum, scale(mapping::area_normal(shape, &x, point.xi), point.weight));
        }
    }
    Ok(sum)
}
