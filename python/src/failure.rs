//! Faults as exceptions of Python. In: a failure of the library. Out: what `linkwear._errors` makes of it.

use linkwear::cli::failure::Failure;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde_json::Value;

/// The exception of a failure.
pub fn raised(py: Python<'_>, failure: &Failure) -> PyErr {
    made(py, failure.to_string(), &Value::from(failure.errors().to_vec()), failure.is_usage())
}

/// The exception of what is wrong with arrays.
pub fn wrong_arrays(error: impl ToString) -> PyErr {
    PyValueError::new_err(error.to_string())
}

fn made(py: Python<'_>, text: String, errors: &Value, is_usage: bool) -> PyErr {
    let made = py
        .import("linkwear._errors")
        .and_then(|module| module.call_method1("error", (text, errors.to_string(), is_usage)));
    match made {
        Ok(exception) => PyErr::from_value(exception),
        Err(error) => error,
    }
}
