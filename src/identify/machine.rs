//! A mechanism as a model of what was measured of it. In: its file at any values, a curve, inspections. Out: predictions. Never knows
//! how values are sought.

use std::cell::{Cell, RefCell};

use linkwear_runtime::{RevolutionSettings, RunError, Watch};

use super::curve::Curve;
use super::errors::{IdentifyError, ModelFault};
use super::free::Free;
use super::problem::Model;
use super::readings::{Group, Readings};
use super::wear::{Inspections, WearPath, first_coefficient};
use crate::journal::Identity;
use crate::mechanism::Mechanism;
use crate::study::{Cases, Fault, Last};

/// What was measured of a machine, and its mechanism.
pub struct Machine<'a> {
    cases: &'a Cases,
    free: &'a [Free],
    curve: Option<Curve>,
    inspections: Vec<Inspections>,
    revolutions: RevolutionSettings,
    last: RefCell<Last>,
    /// Paths of wear, by all that decides them but the coefficient.
    paths: RefCell<Vec<(Identity, WearPath)>>,
    lives: Cell<u64>,
}

impl<'a> Machine<'a> {
    /// Of a file at values of these parameters.
    pub fn new(
        cases: &'a Cases,
        free: &'a [Free],
        (curve, inspections): (Option<Curve>, Vec<Inspections>),
        revolutions: RevolutionSettings,
    ) -> Self {
        let (last, paths, lives) = (RefCell::default(), RefCell::default(), Cell::new(0));
        Self { cases, free, curve, inspections, revolutions, last, paths, lives }
    }

    /// The readings in the order of the predictions: columns of the curve, then inspections; SI.
    ///
    /// # Errors
    /// [`IdentifyError`] of readings.
    pub fn readings(&self) -> Result<Readings, IdentifyError> {
        let known = linkwear_runtime::channels(&self.cases.base().description);
        let unit = |name: &str| {
            let found = known.iter().find(|channel| channel.name == *name);
            found.map_or(String::new(), |channel| channel.unit.to_string())
        };
        let columns = self.curve.iter().flat_map(|curve| {
            curve.columns.iter().map(|column| Group {
                name: column.name.clone(),
                unit: unit(&column.name),
                noise: column.noise,
                clock: "t [s]".to_owned(),
                at: curve.times.clone(),
                values: column.values.clone(),
            })
        });
        let inspections = self.inspections.iter().map(|one| Group {
            name: one.joint.clone(),
            unit: "m".to_owned(),
            noise: one.gauge,
            clock: if one.by_time { "t [s]" } else { "revolutions" }.to_owned(),
            at: one.at.clone(),
            values: one.wear.clone(),
        });
        Readings::new(columns.chain(inspections).collect())
    }

    /// Lives that were lived: paths serve many values.
    pub fn lives(&self) -> u64 {
        self.lives.get()
    }

    fn wear(&self, mechanism: &Mechanism, watch: Watch<'_>) -> Result<Vec<f64>, ModelFault> {
        let coefficient = first_coefficient(mechanism).unwrap_or(f64::NAN);
        let mut relative = mechanism.clone();
        for contact in relative.description.contacts.to_mut() {
            if let Some(wear) = &mut contact.wear {
                wear.coefficient /= coefficient;
            }
        }
        let identity = relative.identity();
        if !self.paths.borrow().iter().any(|(known, _)| *known == identity) {
            let path = WearPath::live(mechanism, &self.inspections, self.revolutions, watch)?;
            self.lives.set(self.lives.get() + 1);
            self.paths.borrow_mut().push((identity.clone(), path));
        }
        let paths = self.paths.borrow();
        let Some((_, path)) = paths.iter().find(|(known, _)| *known == identity) else {
            return Ok(Vec::new());
        };
        let at = |inspections: &Inspections| path.at(inspections, coefficient);
        Ok(self.inspections.iter().map(at).collect::<Result<Vec<_>, _>>()?.concat())
    }
}

impl Model for Machine<'_> {
    fn predict(&self, values: &[f64], watch: Watch<'_>) -> Result<Vec<f64>, ModelFault> {
        let given: Vec<(String, String)> = self
            .free
            .iter()
            .zip(values)
            .map(|(free, value)| (free.name.clone(), free.written(*value)))
            .collect();
        let failed = |fault: Fault| ModelFault::Failed(fault.told());
        let mechanism = self.cases.at(&given, &mut self.last.borrow_mut());
        let mechanism = mechanism.map_err(|error| failed(Fault::Load(error)))?;
        let mut all = match &self.curve {
            Some(curve) => curve.predict(&mechanism, watch).map_err(|error| match error {
                RunError::Interrupted { .. } => ModelFault::Interrupted,
                error => failed(Fault::Run(error)),
            })?,
            None => Vec::new(),
        };
        if !self.inspections.is_empty() {
            all.extend(self.wear(&mechanism, watch)?);
        }
        Ok(all)
    }
}
