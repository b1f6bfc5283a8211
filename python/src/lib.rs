//! linkwear for Python: the library's questions and answers, states in lanes as NumPy arrays. In: texts, words as on the command line,
//! arrays. Out: arrays and JSON. The classes that users see are in Python, beside this crate.

#![deny(
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    clippy::todo,
    clippy::unimplemented,
    clippy::unreachable
)]

mod entries;
mod failure;
mod mechanism;
mod state_space;
mod work;

use pyo3::prelude::*;

use failure::raised;
use work::abandoned;

/// Fits a process of wear to a table of readings, CSV as text; returns the file that `linkwear fit --out` writes.
#[pyfunction]
fn fit(py: Python<'_>, words: Vec<String>, name: String, table: String) -> PyResult<String> {
    let answer = abandoned(py, move || linkwear::cli::ask::fit(&words, &name, &table))?;
    answer.map(|json| format!("{json:#}\n")).map_err(|failure| raised(py, &failure))
}

/// Predicts by the JSON of a fit; returns the JSON of `linkwear predict`.
#[pyfunction]
fn predict(py: Python<'_>, words: Vec<String>, name: String, fit: String) -> PyResult<String> {
    let answer = abandoned(py, move || linkwear::cli::ask::predict(&words, &name, &fit))?;
    answer.map(|json| json.to_string()).map_err(|failure| raised(py, &failure))
}

/// Puts shards of lives together; returns the JSON of `linkwear merge`, and the lives as [`mechanism::Lives`] has them.
#[pyfunction]
fn merge(py: Python<'_>, shards: Vec<String>) -> PyResult<(String, mechanism::Lives)> {
    let merged = abandoned(py, move || linkwear::cli::ask::merge(&shards))?;
    let lived = merged.map_err(|failure| raised(py, &failure))?;
    Ok((lived.json.to_string(), mechanism::Lives::of(py, &lived.result)))
}

#[pymodule]
fn _linkwear(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add_class::<mechanism::Mechanism>()?;
    module.add_class::<entries::Entries>()?;
    module.add_class::<mechanism::Lives>()?;
    module.add_class::<state_space::StateSpace>()?;
    module.add_function(wrap_pyfunction!(fit, module)?)?;
    module.add_function(wrap_pyfunction!(predict, module)?)?;
    module.add_function(wrap_pyfunction!(merge, module)?)?;
    Ok(())
}
