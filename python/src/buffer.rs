//! Numbers that NumPy takes over without copying them.

use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

/// Numbers with the shape of an array; `numpy.asarray` makes an array of it, which keeps it alive.
#[pyclass(frozen, module = "zelus._zelus")]
pub(crate) struct Buffer {
    /// The numbers, to be dropped with the array; Rust looks at them no more.
    _owner: Box<dyn Send + Sync>,
    /// Where they lie.
    address: usize,
    /// Type of the numbers, in NumPy's notation.
    kind: &'static str,
    shape: Vec<usize>,
}

impl Buffer {
    fn new<T: Send + Sync + 'static>(mut values: Vec<T>, width: usize, kind: &'static str) -> Self {
        let shape = if width == 1 { vec![values.len()] } else { vec![values.len() / width.max(1), width] };
        Self { address: values.as_mut_ptr() as usize, _owner: Box::new(values), kind, shape }
    }

    /// Rows of `width` numbers; a plain list where that is 1.
    pub(crate) fn real(values: Vec<f64>, width: usize) -> Self {
        Self::new(values, width, "f8")
    }

    /// As [`Buffer::real`], of whole numbers.
    pub(crate) fn whole(values: Vec<i64>, width: usize) -> Self {
        Self::new(values, width, "i8")
    }

    /// Indices or ids.
    pub(crate) fn list<T: Copy + TryInto<i64>>(values: &[T]) -> Self {
        Self::whole(values.iter().filter_map(|&value| value.try_into().ok()).collect(), 1)
    }
}

#[pymethods]
impl Buffer {
    /// The interface by which NumPy reads the buffer.
    #[getter]
    fn __array_interface__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let order = if cfg!(target_endian = "little") { '<' } else { '>' };
        let out = PyDict::new(py);
        out.set_item("version", 3)?;
        out.set_item("shape", PyTuple::new(py, &self.shape)?)?;
        out.set_item("typestr", format!("{order}{}", self.kind))?;
        out.set_item("data", (self.address, false))?;
        Ok(out)
    }
}
