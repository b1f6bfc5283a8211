//! Inputs that drives follow, led from outside one stretch of time after the other: their values go from where they are to where they
//! are wanted with a continuous second derivative, so that no drive jumps. In: values with their rates at both ends. Out: values and
//! rates at any time. Never knows who wants them.

use crate::tables::InputRole;

/// Value, rate and acceleration.
pub type Course = [f64; 3];

/// How the inputs that drives follow go on.
#[derive(Clone, Debug, PartialEq)]
pub struct Guide {
    /// Places of the values among the inputs; rates stand behind them.
    places: Vec<usize>,
    /// First and last time of the present stretch [s]; the last is the earlier one while nothing is led.
    begin: f64,
    end: f64,
    /// By input, coefficients of a polynomial in the time since the beginning.
    pieces: Vec<[f64; 6]>,
    /// By input, its course at the end: beyond it the acceleration stays.
    ends: Vec<Course>,
}

impl Guide {
    /// Of a mechanism's inputs; none is led.
    pub fn new(roles: &[InputRole]) -> Self {
        let follows = |at: &usize| {
            roles[*at] == InputRole::Value && roles.get(at + 1) == Some(&InputRole::RateOfPrevious)
        };
        let places: Vec<usize> = (0..roles.len()).filter(follows).collect();
        let (pieces, ends) = (vec![[0.0; 6]; places.len()], vec![[0.0; 3]; places.len()]);
        Self { places, begin: 0.0, end: -1.0, pieces, ends }
    }

    /// Leads every such input from its course in `now` at a time to where the course in `wanted` at that time takes it in `span`
    /// seconds, with the rates that it has there.
    pub fn lead(&mut self, begin: f64, span: f64, now: &[f64], wanted: &[f64]) {
        (self.begin, self.end) = (begin, begin + span);
        for ((place, piece), end) in self.places.iter().zip(&mut self.pieces).zip(&mut self.ends) {
            let course = |values: &[f64]| [values[*place], values[place + 1], values[place + 2]];
            let start = course(now);
            *end = onward(course(wanted), span);
            *piece = quintic(start, *end, span);
        }
    }

    /// Writes values and rates at a time over those of the inputs, if they are led.
    #[inline]
    pub fn write(&self, t: f64, inputs: &mut [f64]) {
        if self.end < self.begin {
            return;
        }
        for ((place, piece), end) in self.places.iter().zip(&self.pieces).zip(&self.ends) {
            let course = if t > self.end { onward(*end, t - self.end) } else { along(piece, t - self.begin) };
            inputs[*place..place + 3].copy_from_slice(&course);
        }
    }

    /// Passes all numbers that it consists of, to be read or written.
    pub fn visit_memory(&mut self, visit: &mut dyn FnMut(&mut f64)) {
        if self.places.is_empty() {
            return;
        }
        [&mut self.begin, &mut self.end].into_iter().for_each(&mut *visit);
        self.pieces.iter_mut().flatten().for_each(&mut *visit);
        self.ends.iter_mut().flatten().for_each(visit);
    }
}

/// Where a course leads if its acceleration stays.
fn onward([value, rate, acceleration]: Course, span: f64) -> Course {
    [value + span * (rate + 0.5 * span * acceleration), rate + span * acceleration, acceleration]
}

/// The polynomial of fifth degree with these courses at both ends.
fn quintic(start: Course, end: Course, span: f64) -> [f64; 6] {
    let by_inertia = onward(start, span);
    let [value, rate, acceleration] = [0, 1, 2].map(|order| end[order] - by_inertia[order]);
    let (rate, acceleration) = (rate * span, acceleration * span * span);
    let cube = span * span * span;
    [
        start[0],
        start[1],
        0.5 * start[2],
        (10.0 * value - 4.0 * rate + 0.5 * acceleration) / cube,
        (-15.0 * value + 7.0 * rate - acceleration) / (cube * span),
        (6.0 * value - 3.0 * rate + 0.5 * acceleration) / (cube * span * span),
    ]
}

fn along(piece: &[f64; 6], t: f64) -> Course {
    let [a, b, c, d, e, f] = *piece;
    [
        a + t * (b + t * (c + t * (d + t * (e + t * f)))),
        b + t * (2.0 * c + t * (3.0 * d + t * (4.0 * e + t * 5.0 * f))),
        2.0 * c + t * (6.0 * d + t * (12.0 * e + t * 20.0 * f)),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROLES: [InputRole; 5] = [
        InputRole::Value,
        InputRole::Value,
        InputRole::RateOfPrevious,
        InputRole::RateOfPrevious,
        InputRole::Value,
    ];

    fn at(guide: &Guide, t: f64) -> Course {
        let mut inputs = [7.0, 0.0, 0.0, 0.0, 9.0];
        guide.write(t, &mut inputs);
        // Inputs that no drive follows stay.
        assert_eq!((inputs[0], inputs[4]), (7.0, 9.0));
        [inputs[1], inputs[2], inputs[3]]
    }

    #[test]
    fn courses_meet_at_both_ends_and_go_on_behind_the_last() {
        let mut guide = Guide::new(&ROLES);
        assert_eq!(at(&guide, 1.0), [0.0; 3]);
        guide.lead(1.0, 0.5, &[0.0, 1.0, 2.0, 3.0, 0.0], &[0.0, 4.0, -2.0, 6.0, 0.0]);
        // 4 - 2 h + 3 h^2, -2 + 6 h; sums of some numbers of that size, divided by h^5.
        let close = |found: Course, wanted: Course| {
            for (found, wanted) in found.into_iter().zip(wanted) {
                assert!((found - wanted).abs() < 1e-11, "{found} {wanted}");
            }
        };
        close(at(&guide, 1.0), [1.0, 2.0, 3.0]);
        close(at(&guide, 1.5), [3.75, 1.0, 6.0]);
        close(at(&guide, 1.5 + 1e-13), [3.75, 1.0, 6.0]);
        close(at(&guide, 2.0), [3.75 + 0.5 + 0.75, 4.0, 6.0]);
    }

    #[test]
    fn rates_are_those_of_the_values() {
        let mut guide = Guide::new(&ROLES);
        guide.lead(0.0, 1.0, &[0.0, 1.0, -2.0, 3.0, 0.0], &[0.0, 4.0, -2.0, 6.0, 0.0]);
        let h = 1e-4;
        for t in [0.2, 0.5, 0.9, 1.4] {
            let [before, now, after] = [t - h, t, t + h].map(|t| at(&guide, t));
            for order in 0..2 {
                // Error h^2 of a third derivative of some 1e3, rounding 1e-12.
                let slope = (after[order] - before[order]) / (2.0 * h);
                assert!((slope - now[order + 1]).abs() < 1e-5, "{t}: {slope} {now:?}");
            }
        }
    }

    #[test]
    fn a_parabola_that_is_told_truly_is_followed_exactly() {
        let mut guide = Guide::new(&ROLES);
        let course = |t: f64| [0.0, 1.0 + t + t * t, 1.0 + 2.0 * t, 2.0, 0.0];
        for step in 0..4 {
            let t = 0.25 * f64::from(step);
            guide.lead(t, 0.25, &course(t), &course(t));
            let [_, value, rate, acceleration, _] = course(t + 0.1);
            let found = at(&guide, t + 0.1);
            assert!(
                (found[0] - value).abs() + (found[1] - rate).abs() + (found[2] - acceleration).abs() < 1e-13
            );
        }
    }
}
