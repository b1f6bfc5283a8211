//! What was measured. In: numbers by groups. Out: the same, checked. Never knows what predicts them.

use std::ops::Range;

use super::errors::IdentifyError;

/// Readings of one quantity by one gauge.
#[derive(Clone, Debug, PartialEq)]
pub struct Group {
    /// What is read: a column, a joint.
    pub name: String,
    /// Unit of the readings.
    pub unit: String,
    /// Standard deviation of the noise, in the unit; none: it is estimated.
    pub noise: Option<f64>,
    /// What `at` counts, with its unit: `t [s]`, `revolutions`.
    pub clock: String,
    /// When each was read, rising.
    pub at: Vec<f64>,
    /// The readings.
    pub values: Vec<f64>,
}

/// All readings, group after group.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Readings {
    groups: Vec<Group>,
}

impl Group {
    /// How far readings lie from their mean, by the root of the mean square; their size where there is one alone.
    pub(super) fn spread(&self) -> f64 {
        let count = self.values.len() as f64;
        let mean = self.values.iter().sum::<f64>() / count;
        let square = self.values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / count;
        if square > 0.0 { libm::sqrt(square) } else { mean.abs().max(f64::MIN_POSITIVE) }
    }

    fn check(&self) -> Result<(), IdentifyError> {
        let wrong = |what: String| Err(IdentifyError::Number { group: self.name.clone(), what });
        if self.values.is_empty() && self.at.is_empty() {
            return wrong("there are no readings: rows of numbers follow the header".to_owned());
        }
        if self.values.len() != self.at.len() {
            return wrong(format!("{} readings at {} places", self.values.len(), self.at.len()));
        }
        if let Some(value) = self.values.iter().chain(&self.at).find(|value| !value.is_finite()) {
            return wrong(format!("{value} is no finite number"));
        }
        if let Some(noise) = self.noise
            && !(noise.is_finite() && noise > 0.0)
        {
            return wrong(format!("a noise of {noise} is not positive"));
        }
        let first = self.values[0];
        if self.noise.is_none() && self.values.len() > 1 && self.values.iter().all(|value| *value == first) {
            let (group, count) = (self.name.clone(), self.values.len());
            return Err(IdentifyError::Constant { group, count, value: first });
        }
        Ok(())
    }
}

impl Readings {
    /// Of some groups.
    ///
    /// # Errors
    /// [`IdentifyError::Number`], [`IdentifyError::Constant`].
    pub fn new(groups: Vec<Group>) -> Result<Self, IdentifyError> {
        groups.iter().try_for_each(Group::check)?;
        Ok(Self { groups })
    }

    /// The groups.
    pub fn groups(&self) -> &[Group] {
        &self.groups
    }

    /// Number of readings.
    pub fn len(&self) -> usize {
        self.groups.iter().map(|group| group.values.len()).sum()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.groups.is_empty()
    }

    /// All readings, in order.
    pub fn values(&self) -> impl Iterator<Item = f64> + '_ {
        self.groups.iter().flat_map(|group| group.values.iter().copied())
    }

    /// The place of each group among all readings.
    pub fn ranges(&self) -> Vec<Range<usize>> {
        let mut from = 0;
        let place = |group: &Group| {
            let range = from..from + group.values.len();
            from = range.end;
            range
        };
        self.groups.iter().map(place).collect()
    }
}
