//! A mechanism as x' = f(t, x) for integrators of others, contact laws included. In: times and states. Out: derivatives, columns.

use std::collections::HashMap;
use std::sync::{LazyLock, Mutex, PoisonError};

use linkwear::cli::ask;
use linkwear_runtime::{Description, Integrator, Settings, Span, StateSpace as Equations, System};
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;

use crate::failure::{raised, wrong_arrays};
use crate::mechanism::Mechanism;

/// Equations that live as long as the process, one for each text and words: who asks for them asks many times.
struct Loaded {
    system: Box<dyn System<f64> + Send + Sync>,
    description: Description,
}

type Key = (String, String, Vec<String>);

static LOADED: LazyLock<Mutex<HashMap<Key, &'static Loaded>>> = LazyLock::new(Mutex::default);

/// A mechanism at a time and a state.
#[pyclass(unsendable)]
pub struct StateSpace {
    equations: Equations<'static>,
}

#[pymethods]
impl StateSpace {
    /// At a consistent start at time `t`; joints with clearance touch there. Values of parameters and inputs, SI; none: the
    /// file's.
    #[new]
    #[pyo3(signature = (mechanism, t=0.0, parameters=None))]
    fn new(
        py: Python<'_>,
        mechanism: &Mechanism,
        t: f64,
        parameters: Option<PyReadonlyArray1<'_, f64>>,
    ) -> PyResult<Self> {
        let loaded = loaded(py, mechanism)?;
        let defaults = || loaded.description.parameters.iter().map(|one| one.default).collect();
        let parameters = match &parameters {
            Some(given) => given.as_slice().map_err(wrong_arrays)?.to_vec(),
            None => defaults(),
        };
        let settings = Settings::new(Integrator::adaptive(&loaded.description, None), Span::Time(1.0), 2);
        let made = Equations::start_at(t, &*loaded.system, &loaded.description, &parameters, &settings);
        let equations = made.map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
        Ok(Self { equations })
    }

    /// Free coordinates, then free speeds, at the present.
    #[getter]
    fn states<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, self.equations.states())
    }

    /// Present time [s].
    #[getter]
    fn t(&self) -> f64 {
        self.equations.t()
    }

    /// Names with units of [`Self::values`].
    #[getter]
    fn columns(&self) -> Vec<String> {
        self.equations.channels().iter().map(|one| format!("{} [{}]", one.name, one.unit)).collect()
    }

    /// x' at a time and a state, which become the present.
    fn derivative<'py>(
        &mut self,
        py: Python<'py>,
        t: f64,
        x: PyReadonlyArray1<'_, f64>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        self.go(t, &x)?;
        let slope = self.equations.derivatives().map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
        Ok(PyArray1::from_slice(py, slope))
    }

    /// All columns at a time and a state, which become the present.
    fn values<'py>(
        &mut self,
        py: Python<'py>,
        t: f64,
        x: PyReadonlyArray1<'_, f64>,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        self.go(t, &x)?;
        let values = self.equations.values().map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
        Ok(PyArray1::from_slice(py, values))
    }
}

impl StateSpace {
    fn go(&mut self, t: f64, x: &PyReadonlyArray1<'_, f64>) -> PyResult<()> {
        let states = x.as_slice().map_err(wrong_arrays)?;
        self.equations.set_time(t);
        self.equations.set_states(states).map_err(|error| PyValueError::new_err(error.to_string()))
    }
}

fn loaded(py: Python<'_>, mechanism: &Mechanism) -> PyResult<&'static Loaded> {
    let (source, words) = mechanism.source();
    let key = (source.name.clone(), source.text.clone(), words.to_vec());
    let mut known = LOADED.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some(loaded) = known.get(&key) {
        return Ok(loaded);
    }
    let compiled = ask::compile(words, source).map_err(|failure| raised(py, &failure))?;
    let description = compiled.description().clone();
    let (tapes, sizes) = (compiled.tapes_when_asked().clone(), compiled.sizes_without_held());
    let native = linkwear::native::Native::when_asked(tapes, sizes, &description);
    let system: Box<dyn System<f64> + Send + Sync> = match native {
        Ok(native) => Box::new(native),
        Err(_) => Box::new(compiled.interpreter()),
    };
    let made: &'static Loaded = Box::leak(Box::new(Loaded { system, description }));
    known.insert(key, made);
    Ok(made)
}
