//! What replacements, looks and standstill cost. In: numbers in one currency. Never knows which.

use super::error::PlanError;
use crate::error::{non_negative, positive};

/// Costs of replacements and how long they take; time in the unit of the life.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Costs {
    /// A replacement in time \[cost\].
    pub preventive: f64,
    /// A failure with its replacement \[cost\].
    pub failure: f64,
    /// How long a replacement in time takes, while nothing wears \[time\].
    pub preventive_time: f64,
    /// How long the standstill after a failure takes \[time\].
    pub failure_time: f64,
}

impl Costs {
    /// Replacements that take no time.
    ///
    /// # Errors
    /// [`PlanError::Life`] for a cost that is not positive, [`PlanError::NothingToSave`].
    pub fn new(preventive: f64, failure: f64) -> Result<Self, PlanError> {
        positive("the cost of a planned replacement", preventive)?;
        positive("the cost of a failure", failure)?;
        if failure <= preventive {
            return Err(PlanError::NothingToSave { preventive, failure });
        }
        Ok(Self { preventive, failure, preventive_time: 0.0, failure_time: 0.0 })
    }

    /// Replacements that take time.
    ///
    /// # Errors
    /// [`PlanError::Life`] for a time that is negative.
    pub fn taking(mut self, preventive_time: f64, failure_time: f64) -> Result<Self, PlanError> {
        self.preventive_time = non_negative("the time of a planned replacement", preventive_time)?;
        self.failure_time = non_negative("the standstill after a failure", failure_time)?;
        Ok(self)
    }
}

/// Costs of looking at a part, and how a failure is noticed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Looks {
    /// One look \[cost\].
    pub inspection: f64,
    /// A unit of time with a failed part, where only the next look finds it \[cost per time\]; None: a failure shows at once, and the
    /// part is replaced.
    pub downtime: Option<f64>,
}

impl Looks {
    /// A look may cost nothing.
    ///
    /// # Errors
    /// [`PlanError::Life`] for a negative cost, [`PlanError::FreeDowntime`].
    pub fn new(inspection: f64, downtime: Option<f64>) -> Result<Self, PlanError> {
        let inspection = non_negative("the cost of an inspection", inspection)?;
        match downtime.map(|cost| non_negative("the cost of downtime", cost)).transpose()? {
            Some(0.0) => Err(PlanError::FreeDowntime),
            downtime => Ok(Self { inspection, downtime }),
        }
    }
}
