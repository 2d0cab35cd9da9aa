//! The part of the Python package that is compiled: a run in a thread of its own, which Python drives from point to point.

mod access;
mod buffer;
mod builtin;
mod event;
mod law;
mod line;
mod outcome;
mod plain;
mod process;
mod residual;
mod session;
mod errors;
mod worker;

use pyo3::prelude::*;

#[pymodule]
fn _zelus(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<session::Session>()?;
    module.add_class::<builtin::Builtin>()?;
    module.add_class::<builtin::Function>()?;
    module.add_function(wrap_pyfunction!(builtin::in_interval, module)?)?;
    module.add_function(wrap_pyfunction!(builtin::is_process, module)?)?;
    module.add_function(wrap_pyfunction!(law::add_law, module)?)?;
    module.add_function(wrap_pyfunction!(access::variable_kind, module)?)?;
    module.add_function(wrap_pyfunction!(access::is_flag, module)?)?;
    module.add_function(wrap_pyfunction!(access::names, module)?)
}
