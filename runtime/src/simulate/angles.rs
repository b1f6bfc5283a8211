//! Angles that columns recompute by atan2, followed over whole turns. In: columns at states of a run, in the order of time.
//! Out: the angles without jumps. Rows have no part in it. Never knows mechanisms.
//!
//! Rates tell how often an angle turned between two times: as long as the rate only rises or only falls, the angle is off
//! the trapezoidal rule by at most half of what the rate's change makes in that time. If that is a quarter of a turn or
//! less, one number of turns is left; if it is more, a time between has to be looked at.

use std::f64::consts::PI;

use crate::description::Channel;

/// Turn that the change of the rate may make over a step.
const RATE_CHANGE: f64 = PI;
/// Distance of the angle from what the rates say.
const OFF: f64 = 0.5 * PI;

/// The angles of one run.
pub(super) struct Angles {
    /// Columns that wrap; the column behind each is its rate.
    places: Vec<usize>,
    /// Where turns are known along the last step, in the order of time.
    knots: Vec<Knot>,
    /// Storage of knots that have gone.
    spare: Vec<Vec<(f64, f64)>>,
}

struct Knot {
    t: f64,
    /// Angle and rate of every place.
    values: Vec<(f64, f64)>,
}

/// A half turn that an angle passed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Crossing {
    /// Its column.
    pub(super) place: usize,
    /// Times before and after it.
    pub(super) between: (f64, f64),
    /// The whole turn in which it was before.
    pub(super) level: f64,
}

impl Angles {
    /// For these columns; turns are counted from the first time that is noted.
    pub(super) fn new(channels: &[Channel]) -> Self {
        let places = (0..channels.len()).filter(|place| channels[*place].wraps).collect();
        Self { places, knots: Vec::new(), spare: Vec::new() }
    }

    /// Whether there is nothing to follow.
    pub(super) fn is_empty(&self) -> bool {
        self.places.is_empty()
    }

    /// Begins a step where the last one ended.
    pub(super) fn begin_step(&mut self) {
        let gone = self.knots.len().saturating_sub(1);
        self.spare.extend(self.knots.drain(..gone).map(|knot| knot.values));
    }

    /// Latest time at which turns are known.
    pub(super) fn known_until(&self) -> Option<f64> {
        self.knots.last().map(|knot| knot.t)
    }

    /// Forgets what is known of times after `t`, within the last step.
    pub(super) fn cut(&mut self, t: f64) {
        let first = self.knots.first().map(|knot| knot.t);
        self.knots.retain(|knot| knot.t <= t || Some(knot.t) == first);
    }

    /// How many there are.
    pub(super) fn count(&self) -> usize {
        self.places.len()
    }

    /// Times at which turns are known, with angle and rate of every place.
    pub(super) fn known(&self) -> Vec<(f64, Vec<(f64, f64)>)> {
        self.knots.iter().map(|knot| (knot.t, knot.values.clone())).collect()
    }

    /// Puts what was known back.
    pub(super) fn put_back(&mut self, known: &[(f64, Vec<(f64, f64)>)]) {
        self.knots = known.iter().map(|(t, values)| Knot { t: *t, values: values.clone() }).collect();
    }

    /// Takes the columns at a later time over.
    ///
    /// # Errors
    /// The column of an angle whose turns since then cannot be told.
    pub(super) fn note(&mut self, t: f64, columns: &[f64]) -> Result<(), usize> {
        let last = self.knots.last();
        if let Some(place) = self.places.iter().enumerate().find_map(|(at, place)| {
            let knot = last?;
            let (predicted, change) = knot.predict(at, t, columns[place + 1]);
            let off = (unwrap(columns[*place], predicted) - predicted).abs();
            // What is not a number tells nothing.
            (!(change <= RATE_CHANGE && off <= OFF)).then_some(*place)
        }) {
            return Err(place);
        }
        let now = |(at, place): (usize, &usize)| {
            let rate = columns[place + 1];
            let predicted = last.map_or(columns[*place], |knot| knot.predict(at, t, rate).0);
            (unwrap(columns[*place], predicted), rate)
        };
        let mut values = self.spare.pop().unwrap_or_default();
        values.clear();
        values.extend(self.places.iter().enumerate().map(now));
        self.knots.push(Knot { t, values });
        Ok(())
    }

    /// The half turns that angles passed in the last step.
    pub(super) fn crossings(&self) -> Vec<Crossing> {
        let pairs = self.knots.windows(2).flat_map(|knots| {
            let ends = self.places.iter().zip(knots[0].values.iter().zip(&knots[1].values));
            ends.filter_map(|(place, ((before, _), (after, _)))| {
                let level = whole_turn(*before);
                let between = (knots[0].t, knots[1].t);
                (whole_turn(*after) != level).then_some(Crossing { place: *place, between, level })
            })
        });
        pairs.collect()
    }

    /// The whole turn in which the angle of a column is at a time within the last step.
    pub(super) fn level(&self, place: usize, t: f64, columns: &[f64]) -> f64 {
        let (Some(at), Some(knot)) = (self.places.iter().position(|other| *other == place), self.knot(t))
        else {
            return 0.0;
        };
        let (predicted, _) = knot.predict(at, t, columns[place + 1]);
        whole_turn(unwrap(columns[place], predicted))
    }

    /// The last one not after a time.
    fn knot(&self, t: f64) -> Option<&Knot> {
        self.knots.iter().rev().find(|knot| knot.t <= t).or(self.knots.first())
    }

    /// Puts the angles in columns of a time within the last step on their turns.
    pub(super) fn unwrap(&self, t: f64, columns: &mut [f64]) {
        let Some(knot) = self.knot(t) else { return };
        for (at, place) in self.places.iter().enumerate() {
            let (predicted, _) = knot.predict(at, t, columns[place + 1]);
            columns[*place] = unwrap(columns[*place], predicted);
        }
    }
}

impl Knot {
    /// Angle at a time as the rates at both ends have it, and the turn that the change of the rate makes.
    fn predict(&self, at: usize, t: f64, rate: f64) -> (f64, f64) {
        let (angle, before) = self.values[at];
        let step = t - self.t;
        (angle + 0.5 * step * (before + rate), step * (rate - before).abs())
    }
}

/// The whole turn in which an angle is, from half a turn below to half a turn above.
fn whole_turn(angle: f64) -> f64 {
    (angle / (2.0 * PI)).round()
}

/// The angle plus the whole turns that bring it nearest to `near`.
fn unwrap(angle: f64, near: f64) -> f64 {
    angle + 2.0 * PI * ((near - angle) / (2.0 * PI)).round()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn angles() -> Angles {
        let channel = |wraps| Channel { name: "H".into(), unit: "rad".into(), wraps };
        Angles::new(&[channel(false), channel(true), channel(false)])
    }

    fn columns(angle: f64, rate: f64) -> [f64; 3] {
        [7.0, angle.sin().atan2(angle.cos()), rate]
    }

    #[test]
    fn a_steady_angle_is_followed_over_any_number_of_turns() {
        let mut angles = angles();
        for (t, back) in [(0.0, 0.0), (1.0, 0.3), (10.0, 4.0)] {
            let angle = |t: f64| 0.4 - 100.0 * t;
            angles.begin_step();
            assert_eq!(angles.note(t, &columns(angle(t), -100.0)), Ok(()));
            // Also at times before the end of the step.
            let mut seen = columns(angle(t - back), -100.0);
            angles.unwrap(t - back, &mut seen);
            // Rounding of a thousand radians.
            assert!((seen[1] - angle(t - back)).abs() < 1e-12, "{seen:?}");
            assert_eq!(seen[0], 7.0);
        }
    }

    #[test]
    fn turns_that_rates_cannot_tell_are_not_guessed() {
        let mut angles = angles();
        assert_eq!(angles.note(0.0, &columns(0.0, 0.0)), Ok(()));
        // The rate changes too much, or does not explain the angle, or is none.
        assert_eq!(angles.note(1.0, &columns(2.0, 3.5)), Err(1));
        assert_eq!(angles.note(1.0, &columns(2.0, 0.1)), Err(1));
        assert_eq!(angles.note(1.0, &columns(2.0, f64::NAN)), Err(1));
        assert_eq!(angles.known_until(), Some(0.0));
        assert_eq!(angles.note(0.5, &columns(0.5, 1.75)), Ok(()));
    }
}
