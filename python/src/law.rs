//! A constitutive law that is a function of Python.

use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::PyBytes;
use zelus::user_materials::law_function::{LawFunction, Points, Response, add_function};

/// Calls the function with the bytes of all numbers of some points, in the thread that computes them.
struct PythonLaw(Py<PyAny>);

/// Bytes of numbers.
fn bytes(numbers: &[f64]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_ne_bytes()).collect()
}

impl LawFunction for PythonLaw {
    fn respond(&self, points: &Points) -> Result<Response, String> {
        Python::attach(|py| {
            let of = |numbers: &[f64]| PyBytes::new(py, &bytes(numbers));
            let places: Vec<f64> = points.places.iter().flatten().map(|&number| number as f64).collect();
            let lists = (of(&points.strain), of(&points.state), of(&points.parameters), of(&places));
            let sizes = (points.len(), points.components, points.states);
            let found = self.0.call1(py, (sizes, points.time, points.wants_tangent, lists));
            let found = found.and_then(|found| found.extract::<[Vec<u8>; 3]>(py));
            let [stress, tangent, state] = found.map_err(|error| error.to_string())?.map(|bytes| reals(&bytes));
            Ok(Response { stress, tangent, state })
        })
    }
}

/// The numbers that the bytes of an array stand for.
pub(crate) fn reals(bytes: &[u8]) -> Vec<f64> {
    bytes.as_chunks().0.iter().map(|number| f64::from_ne_bytes(*number)).collect()
}

/// Makes a function known as a law.
#[pyfunction]
pub(crate) fn add_law(name: &str, function: Py<PyAny>) {
    add_function(name, Arc::new(PythonLaw(function)));
}
