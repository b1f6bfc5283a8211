//! Entry points as functions of arrays. In: arrays (quantity, lane), C order. Out: the same of the answers.

use linkwear::batch::{Batch, Quantities};
use linkwear_runtime::Entry;
use numpy::{PyArray2, PyArrayMethods as _, PyReadonlyArray1, PyReadonlyArray2, PyReadwriteArray2};
use pyo3::exceptions::PyKeyError;
use pyo3::prelude::*;

use crate::failure::wrong_arrays;
use crate::mechanism::Mechanism;

/// A group of quantities and the name of each.
type Named = Vec<(&'static str, Vec<String>)>;

/// The entries of a mechanism.
#[pyclass(frozen)]
pub struct Entries {
    batch: Batch,
}

#[pymethods]
impl Entries {
    /// On as many lanes as the processor has.
    #[new]
    fn new(py: Python<'_>, mechanism: &Mechanism) -> PyResult<Self> {
        Ok(Self { batch: mechanism.batch(py)? })
    }

    /// What an entry takes and gives: groups with the names of their quantities.
    fn entry(&self, name: &str) -> PyResult<(Named, Named)> {
        let (batch, entry) = (&self.batch, named(name)?);
        let pairs = |all: Vec<Quantities>| all.into_iter().map(|one| (one.group, one.names)).collect();
        Ok((pairs(batch.inputs(entry)), pairs(batch.outputs(entry))))
    }

    /// States that are evaluated side by side.
    fn lanes(&self) -> usize {
        self.batch.lanes()
    }

    /// Tunable parameters, then inputs: name, SI unit, value.
    fn parameters(&self) -> Vec<(String, String, f64)> {
        let parameters = self.batch.description().parameters.iter();
        parameters.map(|one| (one.name.to_string(), one.unit.to_string(), one.default)).collect()
    }

    /// Evaluates an entry: of each group an array (quantity, 1 or states), into one (quantity, states).
    fn evaluate(
        &self,
        py: Python<'_>,
        name: &str,
        groups: Vec<PyReadonlyArray2<'_, f64>>,
        mut out: PyReadwriteArray2<'_, f64>,
    ) -> PyResult<()> {
        let (batch, entry) = (&self.batch, named(name)?);
        let states = out.as_array().ncols();
        let mut inputs: Vec<&[f64]> = Vec::new();
        for group in &groups {
            let width = group.as_array().ncols();
            let numbers = group.as_slice().map_err(wrong_arrays)?;
            inputs.extend(numbers.chunks_exact(width.max(1)));
        }
        let outputs = out.as_slice_mut().map_err(wrong_arrays)?;
        py.detach(|| batch.evaluate(entry, &inputs, states, outputs)).map_err(wrong_arrays)
    }

    /// Derivatives of all answers at one state by some of the quantities, (answer, quantity).
    fn derivatives<'py>(
        &self,
        py: Python<'py>,
        name: &str,
        input: PyReadonlyArray1<'_, f64>,
        by: Vec<usize>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let (batch, entry) = (&self.batch, named(name)?);
        let input = input.as_slice().map_err(wrong_arrays)?;
        let slopes = py.detach(|| batch.derivatives(entry, input, &by)).map_err(wrong_arrays)?;
        let answers = batch.sizes().output(entry);
        let transposed: Vec<f64> = (0..answers).flat_map(|row| slopes.iter().map(move |slope| slope[row])).collect();
        numpy::PyArray1::from_vec(py, transposed).reshape([answers, by.len()])
    }
}

fn named(name: &str) -> PyResult<Entry> {
    Entry::ALL.into_iter().find(|entry| entry.name() == name).ok_or_else(|| {
        let known: Vec<&str> = Entry::ALL.iter().map(|entry| entry.name()).collect();
        PyKeyError::new_err(format!("there is no entry `{name}`; there are: {}", known.join(", ")))
    })
}
