//! Readings, a model of them, and how far apart both are. In: places of the parameters. Out: residuals in units of the noise.
//! Never knows how the places are sought.

use std::cell::Cell;

use linkwear_runtime::Watch;
use nalgebra::DVector;

use super::errors::ModelFault;
use super::free::Free;
use super::readings::Readings;
use crate::study::{PointError, RUN_FAILED};

/// What predicts readings.
pub trait Model {
    /// Predictions in the order of the readings, at values of the free parameters in their units.
    ///
    /// # Errors
    /// [`ModelFault`].
    fn predict(&self, values: &[f64], watch: Watch<'_>) -> Result<Vec<f64>, ModelFault>;
}

/// All that a search goes by.
pub(super) struct Problem<'a> {
    pub free: &'a [Free],
    pub readings: &'a Readings,
    pub model: &'a dyn Model,
    /// Standard deviation of each group's noise, or what stands for it until it is known.
    pub noise: Vec<f64>,
    pub watch: Watch<'a>,
    pub runs: Cell<u64>,
}

impl Problem<'_> {
    pub fn values(&self, places: &[f64]) -> Vec<f64> {
        self.free.iter().zip(places).map(|(free, place)| free.value(*place)).collect()
    }

    /// Predictions at some places.
    pub fn predictions(&self, places: &[f64]) -> Result<Vec<f64>, ModelFault> {
        /// Nobody knows how many runs a search takes: each is a part of what is left.
        const PART: f64 = 1.0 / 400.0;
        let done = 1.0 - libm::exp(-PART * self.runs.get() as f64);
        let next = 1.0 - libm::exp(-PART * (self.runs.get() + 1) as f64);
        if self.watch.report(done).is_break() {
            return Err(ModelFault::Interrupted);
        }
        self.runs.set(self.runs.get() + 1);
        let found = self.model.predict(&self.values(places), self.watch.piece(done, next))?;
        if found.len() == self.readings.len() && found.iter().all(|value| value.is_finite()) {
            return Ok(found);
        }
        let (code, message) =
            (RUN_FAILED.to_owned(), "the model predicts no finite numbers there".to_owned());
        Err(ModelFault::Failed(PointError { code, message, help: String::new() }))
    }

    /// Predicted minus read, in units of the noise.
    pub fn residuals(&self, places: &[f64]) -> Result<DVector<f64>, ModelFault> {
        let predicted = self.predictions(places)?;
        let groups = self.readings.groups().iter().zip(&self.noise);
        let read = groups.flat_map(|(group, noise)| group.values.iter().map(move |value| (value, noise)));
        let residual = |(predicted, (read, noise)): (f64, (&f64, &f64))| (predicted - read) / noise;
        Ok(DVector::from_vec(predicted.into_iter().zip(read).map(residual).collect()))
    }
}
