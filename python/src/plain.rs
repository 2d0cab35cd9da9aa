//! Plain values of Python as JSON, to the last bit.

use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict};
use serde_json::{Map, Number, Value};

/// JSON value of dictionaries, lists, strings, numbers, booleans and `None`.
pub(crate) fn plain(value: &Bound<'_, PyAny>) -> PyResult<Value> {
    if value.is_none() {
        return Ok(Value::Null);
    }
    if let Ok(truth) = value.cast::<PyBool>() {
        return Ok(Value::Bool(truth.is_true()));
    }
    if let Ok(number) = value.extract::<i64>() {
        return Ok(Value::Number(number.into()));
    }
    if let Ok(number) = value.extract::<f64>() {
        let wrong = || PyTypeError::new_err(format!("{number} is no number of a deck"));
        return Number::from_f64(number).map(Value::Number).ok_or_else(wrong);
    }
    if let Ok(text) = value.extract::<String>() {
        return Ok(Value::String(text));
    }
    if let Ok(members) = value.cast::<PyDict>() {
        let member = |(key, own): (Bound<'_, PyAny>, Bound<'_, PyAny>)| Ok((key.extract::<String>()?, plain(&own)?));
        return members.iter().map(member).collect::<PyResult<Map<_, _>>>().map(Value::Object);
    }
    let items = value.try_iter().map_err(|_| PyTypeError::new_err(format!("{value} is no value of a deck")))?;
    items.map(|item| plain(&item?)).collect::<PyResult<_>>().map(Value::Array)
}
