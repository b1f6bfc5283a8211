//! A measured curve, and what a run says in its place. In: a mechanism, times. Out: columns at these times. Never knows parameters.

use linkwear_runtime::{Integrator, RunError, Settings, Simulation, Span, Watch};

use crate::mechanism::Mechanism;

/// A column of a curve, SI.
#[derive(Clone, Debug, PartialEq)]
pub struct CurveColumn {
    /// Its name, as `simulate --out` has it without the unit.
    pub name: String,
    /// A value for each time.
    pub values: Vec<f64>,
    /// Standard deviation of its noise, if known.
    pub noise: Option<f64>,
}

/// Columns over one time.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Times from the end of the settling on [s], rising.
    pub times: Vec<f64>,
    /// What was measured.
    pub columns: Vec<CurveColumn>,
    /// What runs before the first time.
    pub settle: Span,
    /// How it is run.
    pub integrator: Integrator,
}

impl Curve {
    /// The columns of a run at the times, one after the other.
    pub(super) fn predict(&self, mechanism: &Mechanism, watch: Watch<'_>) -> Result<Vec<f64>, RunError> {
        let system = mechanism.system();
        let last = self.times.last().copied().unwrap_or_default();
        let settings = Settings {
            settle: self.settle,
            ..Settings::new(self.integrator, Span::Time(last.max(f64::MIN_POSITIVE)), 0)
        };
        let mut run = Simulation::start(&*system, &mechanism.description, &mechanism.parameters, &settings)?;
        let place = |column: &CurveColumn| {
            let found = run.channels().iter().position(|channel| channel.name == *column.name);
            found.unwrap_or(usize::MAX)
        };
        let places: Vec<usize> = self.columns.iter().map(place).collect();
        let begin = run.t();
        let mut rows = Vec::with_capacity(self.times.len());
        for (at, time) in self.times.iter().enumerate() {
            run.advance(begin + time, watch)?;
            if watch.report(at as f64 / self.times.len() as f64).is_break() {
                return Err(RunError::Interrupted { t: run.t() });
            }
            let values = run.values();
            rows.push(places.iter().map(|place| values.get(*place).copied().unwrap_or(f64::NAN)).collect());
        }
        let rows: Vec<Vec<f64>> = rows;
        Ok((0..places.len()).flat_map(|column| rows.iter().map(move |row| row[column])).collect())
    }
}
