//! Constants of properties: positive ones, and lists.

use std::borrow::Cow;

use zelus_core::diagnostics::{Diagnostic, Result};
use zelus_core::model::{Properties, PropertyValue};

/// The number called `name`.
///
/// # Errors
/// It is missing or not positive.
pub(super) fn positive(properties: &Properties, name: &str) -> Result<f64> {
    let value = properties.require(name)?;
    super::uniaxial::positive(properties, name, value)?;
    Ok(value)
}

/// The list called `name`; a number is a list of one.
///
/// # Errors
/// It is missing or neither.
pub(super) fn list<'a>(properties: &'a Properties, name: &str) -> Result<Cow<'a, [f64]>> {
    match properties.values.get(name) {
        Some(PropertyValue::Vector(values)) => Ok(Cow::Borrowed(values)),
        Some(PropertyValue::Text(_) | PropertyValue::Matrix(_)) => {
            let fact = format!("{name} of properties {} is no list of numbers", properties.id);
            let problem = Diagnostic::error("wrong-type", fact).at(properties.place.clone());
            Err(problem.remedy("write numbers between [ and ]").into())
        }
        _ => Ok(Cow::Owned(vec![properties.require(name)?])),
    }
}
