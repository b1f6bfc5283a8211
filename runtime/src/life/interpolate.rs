//! A monotone cubic through given points. In: increasing places, values. Out: values between and beyond.
//! Never knows what the values are.
//!
//! Slopes are weighted harmonic means of the rises on both sides (Fritsch & Butland, SIAM J. Sci. Stat. Comput. 5
//! (1984) 300-304): no value lies outside the two that it is between, so noise makes no new extremes. A straight
//! line is met exactly; beyond the ends the line goes on with the last slope.

/// A curve through points.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Curve {
    values: Vec<f64>,
    slopes: Vec<f64>,
    /// Whether the logarithms of the values are kept.
    is_log: bool,
}

impl Curve {
    /// A curve of the logarithms, if all values are above zero; else of the values themselves.
    pub(super) fn logarithmic(places: &[f64], values: Vec<f64>) -> Self {
        if values.iter().all(|value| *value > 0.0) {
            let logarithms = values.into_iter().map(libm::log).collect();
            Self { is_log: true, ..Self::plain(places, logarithms) }
        } else {
            Self::plain(places, values)
        }
    }

    /// A curve of the values.
    pub(super) fn plain(places: &[f64], values: Vec<f64>) -> Self {
        let slopes = slopes(places, &values);
        Self { values, slopes, is_log: false }
    }

    /// Value at a place that [`find`] has found.
    pub(super) fn at(&self, cell: Cell) -> f64 {
        let Cell { index, part, width, is_inside } = cell;
        let (from, slope) = (self.values[index], self.slopes[index]);
        let value = if !is_inside {
            from + slope * part
        } else {
            let to = (self.values[index + 1], self.slopes[index + 1] * width);
            at(&cubic((from, slope * width), to), part)
        };
        if self.is_log { libm::exp(value) } else { value }
    }
}

/// Coefficients, the highest power first, of the cubic with these values and slopes at 0 and 1.
#[inline]
pub(super) fn cubic((from, m0): (f64, f64), (to, m1): (f64, f64)) -> [f64; 4] {
    let rise = to - from;
    [m0 + m1 - 2.0 * rise, 3.0 * rise - 2.0 * m0 - m1, m0, from]
}

/// Its value.
#[inline]
pub(super) fn at([a, b, c, d]: &[f64; 4], part: f64) -> f64 {
    ((a * part + b) * part + c) * part + d
}

/// A place among the points: after point `index` by `part` of `width`. Outside, `width` is one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cell {
    index: usize,
    part: f64,
    width: f64,
    is_inside: bool,
}

impl Cell {
    /// The nearest point.
    pub(super) fn nearest(self) -> usize {
        if self.is_inside && self.part > 0.5 { self.index + 1 } else { self.index }
    }
}

/// Where a place lies among increasing places.
pub(super) fn find(places: &[f64], place: f64) -> Cell {
    let index = places.partition_point(|known| *known <= place).max(1) - 1;
    match places.get(index + 1) {
        Some(next) if place >= places[index] => {
            let width = next - places[index];
            Cell { index, part: (place - places[index]) / width, width, is_inside: true }
        }
        _ => Cell { index, part: place - places[index], width: 1.0, is_inside: false },
    }
}

fn slopes(places: &[f64], values: &[f64]) -> Vec<f64> {
    let widths: Vec<f64> = places.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let rises: Vec<f64> =
        values.windows(2).zip(&widths).map(|(pair, width)| (pair[1] - pair[0]) / width).collect();
    let inside = |i: usize| {
        let (before, after) = (rises[i - 1], rises[i]);
        if before * after <= 0.0 {
            return 0.0;
        }
        let (h0, h1) = (widths[i - 1], widths[i]);
        let weight = (h0 + 2.0 * h1) / (3.0 * (h0 + h1));
        before * after / (weight * after + (1.0 - weight) * before)
    };
    let last = values.len() - 1;
    match rises.len() {
        0 => vec![0.0],
        1 => vec![rises[0]; 2],
        _ => {
            let mut slopes = vec![0.0; values.len()];
            (1..last).for_each(|i| slopes[i] = inside(i));
            slopes[0] = end(widths[0], widths[1], rises[0], rises[1]);
            slopes[last] = end(widths[last - 1], widths[last - 2], rises[last - 1], rises[last - 2]);
            slopes
        }
    }
}

/// Slope at an end by a parabola through three points, kept from overshooting.
fn end(width: f64, next_width: f64, rise: f64, next_rise: f64) -> f64 {
    let slope = ((2.0 * width + next_width) * rise - width * next_rise) / (width + next_width);
    if slope * rise <= 0.0 {
        0.0
    } else if rise * next_rise <= 0.0 && slope.abs() > 3.0 * rise.abs() {
        3.0 * rise
    } else {
        slope
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn at(places: &[f64], curve: &Curve, place: f64) -> f64 {
        curve.at(find(places, place))
    }

    #[test]
    fn a_power_law_is_met_between_and_beyond_its_points() {
        let places: Vec<f64> = (0..17).map(|i| 0.1 * f64::from(i)).collect();
        let curve = Curve::logarithmic(&places, places.iter().map(|x| 3e-13 * (0.4 * x).exp()).collect());
        for place in [-0.3_f64, 0.0, 0.03, 0.77, 1.6, 1.9] {
            let expected = 3e-13 * (0.4 * place).exp();
            // ln of 3e-13 is 29: its rounding, 4e-15, is that of the value.
            assert!((at(&places, &curve, place) / expected - 1.0).abs() < 4e-14, "{place}");
        }
    }

    #[test]
    fn a_smooth_curve_is_met_better_with_more_points() {
        let error = |count: i32| {
            let places: Vec<f64> = (0..=count).map(|i| f64::from(i) / f64::from(count)).collect();
            let curve = Curve::plain(&places, places.iter().map(|x| (2.0 * x).exp()).collect());
            let error = |i: i32| {
                let x = f64::from(i) / 1000.0;
                (at(&places, &curve, x) - (2.0 * x).exp()).abs()
            };
            (0..1000).map(error).fold(0.0, f64::max)
        };
        // Harmonic means are slopes of second order: errors fall by 8 per halving, 7 leaves room for the next term.
        assert!(error(16) / error(32) > 7.0 && error(32) < 1e-4, "{} {}", error(16), error(32));
    }

    #[test]
    fn values_that_are_not_above_zero_are_no_logarithms() {
        let places = [0.0, 1.0, 2.0];
        let curve = Curve::logarithmic(&places, vec![0.0, 1.0, 2.0]);
        assert_eq!((at(&places, &curve, 0.0), at(&places, &curve, 1.5)), (0.0, 1.5));
        let constant = Curve::plain(&[0.0], vec![4.0]);
        assert_eq!((at(&[0.0], &constant, 0.0), at(&[0.0], &constant, 7.0)), (4.0, 4.0));
    }

    #[test]
    fn the_nearest_point_is_the_nearest() {
        let places = [0.0, 1.0, 3.0];
        let nearest: Vec<usize> = [0.0, 0.4, 0.6, 1.9, 2.1, 9.0].map(|x| find(&places, x).nearest()).into();
        assert_eq!(nearest, [0, 0, 1, 1, 2, 2]);
    }

    proptest! {
        #[test]
        fn a_value_is_never_outside_the_two_it_is_between(
            values in prop::collection::vec(-1.0..1.0_f64, 2..9), part in 0.0..1.0_f64,
        ) {
            let places: Vec<f64> = (0..values.len()).map(|i| (i * i) as f64).collect();
            let curve = Curve::plain(&places, values.clone());
            let place = part * places[values.len() - 1];
            let value = at(&places, &curve, place);
            let cell = find(&places, place);
            let next = (cell.index + 1).min(values.len() - 1);
            let (a, b) = (values[cell.index], values[next]);
            // Rounding of a cubic with coefficients below 12.
            prop_assert!(value >= a.min(b) - 1e-14 && value <= a.max(b) + 1e-14);
        }
    }
}
