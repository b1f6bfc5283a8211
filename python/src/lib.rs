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

/// Fits a process of wear to a table of readings, CSV as text, with replicates of the bootstrap that were drawn elsewhere, if there are
/// any; returns the JSON of `linkwear fit`, and the file that it writes.
#[pyfunction]
#[pyo3(signature = (words, name, table, drawn=Vec::new()))]
fn fit(
    py: Python<'_>,
    words: Vec<String>,
    name: String,
    table: String,
    drawn: Vec<String>,
) -> PyResult<(String, String)> {
    let fitted = abandoned(py, move || linkwear::cli::ask::fit(&words, &name, &table, &drawn))?;
    fitted.map(|fitted| (fitted.json.to_string(), fitted.file)).map_err(|failure| raised(py, &failure))
}

/// Draws replicates of the bootstrap of a fit by their numbers, `last` left out, as text for `fit`.
#[pyfunction]
fn replicates(
    py: Python<'_>,
    words: Vec<String>,
    name: String,
    table: String,
    first: u64,
    last: u64,
) -> PyResult<String> {
    let drawn = abandoned(py, move || linkwear::cli::ask::replicates(&words, &name, &table, first..last))?;
    drawn.map_err(|failure| raised(py, &failure))
}

/// Puts the parts of a study together; returns the JSON of `linkwear merge`.
#[pyfunction]
fn merge_study(py: Python<'_>, parts: Vec<String>) -> PyResult<String> {
    let merged = abandoned(py, move || linkwear::cli::ask::merge_study(&parts))?;
    merged.map(|json| json.to_string()).map_err(|failure| raised(py, &failure))
}

/// Predicts by the JSON of a fit; returns the JSON of `linkwear predict`.
#[pyfunction]
fn predict(py: Python<'_>, words: Vec<String>, name: String, fit: String) -> PyResult<String> {
    let answer = abandoned(py, move || linkwear::cli::ask::predict(&words, &name, &fit))?;
    answer.map(|json| json.to_string()).map_err(|failure| raised(py, &failure))
}

/// Plans by the JSON of a fit; returns the JSON of `linkwear plan`.
#[pyfunction]
fn plan(py: Python<'_>, words: Vec<String>, name: String, fit: String) -> PyResult<String> {
    let answer = abandoned(py, move || linkwear::cli::ask::plan(&words, &name, &fit))?;
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
    module.add_function(wrap_pyfunction!(plan, module)?)?;
    module.add_function(wrap_pyfunction!(merge, module)?)?;
    module.add_function(wrap_pyfunction!(merge_study, module)?)?;
    module.add_function(wrap_pyfunction!(replicates, module)?)?;
    Ok(())
}
