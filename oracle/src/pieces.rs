//! Functions with pieces and motion laws on jets, each piece with its derivatives as the books have them.
//! In: jets. Out: jets. Never knows how the generator puts pieces together.

use std::f64::consts::PI;

use linkwear_codegen::model::{DataTable, Piecewise};
use linkwear_codegen::spec::Outside;

use crate::jet::Jet;

/// The value of a function.
pub fn call(function: Piecewise, arguments: &[Jet]) -> Jet {
    let a = arguments[0];
    let x = a.value;
    let b = arguments.get(1).copied().unwrap_or(Jet::constant(f64::NAN));
    let width = b.value;
    match function {
        Piecewise::Abs => a.chain(x.abs(), if x < 0.0 { -1.0 } else { 1.0 }, 0.0),
        Piecewise::Sign => Jet::constant(if x == 0.0 { 0.0 } else { x.signum() }),
        Piecewise::Min => least(a, b),
        Piecewise::Max => -least(-a, -b),
        Piecewise::Clamp => least(-least(-a, -b), arguments[2]),
        Piecewise::Step => Jet::constant(f64::from(u8::from(x >= 0.0))),
        Piecewise::Floor => Jet::constant(x.floor()),
        Piecewise::Mod => a.chain(x.rem_euclid(width), 1.0, 0.0),
        Piecewise::SmoothAbs => {
            let h = x.hypot(width);
            a.chain(h, x / h, width * width / h.powi(3))
        }
        Piecewise::SmoothSign => {
            let h = x.hypot(width);
            a.chain(x / h, width * width / h.powi(3), -3.0 * x * width * width / h.powi(5))
        }
        Piecewise::SmoothStep => {
            let s = x / width + 0.5;
            let [value, first, second] = if s <= 0.0 || s >= 1.0 { rest(s) } else { poly345(s) };
            a.chain(value, first / width, second / (width * width))
        }
        Piecewise::Trapezoid | Piecewise::SCurve => {
            let ramp = if arguments.len() > 1 { width } else { 1.0 / 3.0 };
            let curved = function == Piecewise::SCurve;
            law(a, arguments.get(2), &|s| ramped(s, ramp, curved))
        }
        Piecewise::Cycloidal => law(a, arguments.get(1), &|s| {
            let (sine, cosine) = (2.0 * PI * s).sin_cos();
            [s - sine / (2.0 * PI), 1.0 - cosine, 2.0 * PI * sine]
        }),
        Piecewise::ModifiedSine => law(a, arguments.get(1), &modified_sine),
        Piecewise::Poly345 => law(a, arguments.get(1), &poly345),
        Piecewise::Poly4567 => law(a, arguments.get(1), &|s| {
            [
                35.0 * s.powi(4) - 84.0 * s.powi(5) + 70.0 * s.powi(6) - 20.0 * s.powi(7),
                140.0 * s.powi(3) - 420.0 * s.powi(4) + 420.0 * s.powi(5) - 140.0 * s.powi(6),
                420.0 * s.powi(2) - 1680.0 * s.powi(3) + 2100.0 * s.powi(4) - 840.0 * s.powi(5),
            ]
        }),
    }
}

fn least(a: Jet, b: Jet) -> Jet {
    if b.value < a.value { b } else { a }
}

/// Value of a table, its piece found by its knots.
pub fn table(table: &DataTable, of: Jet) -> Jet {
    let [first, last] = table.range();
    let (x, rate) = match table.outside {
        Outside::Periodic => (first + (of.value - first).rem_euclid(last - first), 1.0),
        Outside::Hold if of.value < first || of.value > last => (of.value.clamp(first, last), 0.0),
        _ => (of.value, 1.0),
    };
    if !(first..=last).contains(&x) {
        return Jet::constant(f64::NAN);
    }
    let after = table.knots.partition_point(|knot| *knot <= x);
    let at = (after.max(1) - 1).min(table.pieces.len() - 1);
    let ([a, b, c, d], u) = (table.pieces[at], x - table.knots[at]);
    let (first, second) = (b + u * (2.0 * c + u * 3.0 * d), 2.0 * c + 6.0 * d * u);
    of.chain(a + u * (b + u * (c + u * d)), rate * first, rate * second)
}

/// A dwell.
fn rest(s: f64) -> [f64; 3] {
    [if s < 0.5 { 0.0 } else { 1.0 }, 0.0, 0.0]
}

/// Rise between its dwells, with a period again and again.
fn law(phase: Jet, period: Option<&Jet>, rise: &dyn Fn(f64) -> [f64; 3]) -> Jet {
    let rounds = period.map_or(0.0, |period| phase.value.div_euclid(period.value));
    let s = phase.value - period.map_or(0.0, |period| rounds * period.value);
    let [value, first, second] = if s <= 0.0 || s >= 1.0 { rest(s) } else { rise(s) };
    phase.chain(rounds + value, first, second)
}

fn poly345(s: f64) -> [f64; 3] {
    [
        10.0 * s.powi(3) - 15.0 * s.powi(4) + 6.0 * s.powi(5),
        30.0 * s.powi(2) - 60.0 * s.powi(3) + 30.0 * s.powi(4),
        60.0 * s - 180.0 * s.powi(2) + 120.0 * s.powi(3),
    ]
}

/// Norton 2009, equations 3.15, with Ca = 4 pi²/(4 + pi) = 5.528.
fn modified_sine(s: f64) -> [f64; 3] {
    let k = 4.0 + PI;
    let (slow, fast) = ((PI + 4.0 * PI * s) / 3.0, 4.0 * PI * s);
    if (0.125..0.875).contains(&s) {
        return [
            2.0 / k + PI * s / k - 9.0 / (4.0 * k) * slow.sin(),
            PI / k * (1.0 - 3.0 * slow.cos()),
            4.0 * PI * PI / k * slow.sin(),
        ];
    }
    let shift = if s < 0.5 { 0.0 } else { 4.0 / k };
    [shift + PI * s / k - fast.sin() / (4.0 * k), PI / k * (1.0 - fast.cos()), 4.0 * PI * PI / k * fast.sin()]
}

/// Trapezoid of speed with straight or eased ramps, by symmetry from its first half.
fn ramped(s: f64, ramp: f64, curved: bool) -> [f64; 3] {
    if s > 0.5 {
        let [value, first, second] = ramped(1.0 - s, ramp, curved);
        return [1.0 - value, first, -second];
    }
    let top = 1.0 / (1.0 - ramp);
    if s >= ramp {
        return [top * (s - 0.5 * ramp), top, 0.0];
    }
    if !curved {
        return [top * s * s / (2.0 * ramp), top * s / ramp, top / ramp];
    }
    let jerk = 4.0 * top / (ramp * ramp);
    if s < 0.5 * ramp {
        return [jerk * s.powi(3) / 6.0, jerk * s * s / 2.0, jerk * s];
    }
    let left = ramp - s;
    [top * (s - 0.5 * ramp) + jerk * left.powi(3) / 6.0, top - jerk * left * left / 2.0, jerk * left]
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [Piecewise; 17] = [
        Piecewise::Abs,
        Piecewise::Sign,
        Piecewise::Min,
        Piecewise::Max,
        Piecewise::Clamp,
        Piecewise::Step,
        Piecewise::Floor,
        Piecewise::Mod,
        Piecewise::SmoothAbs,
        Piecewise::SmoothSign,
        Piecewise::SmoothStep,
        Piecewise::Trapezoid,
        Piecewise::SCurve,
        Piecewise::Cycloidal,
        Piecewise::ModifiedSine,
        Piecewise::Poly345,
        Piecewise::Poly4567,
    ];

    /// The last arguments of a function.
    fn others(function: Piecewise) -> Vec<f64> {
        match function {
            Piecewise::Min | Piecewise::Max => vec![0.2],
            Piecewise::Clamp => vec![-0.4, 0.6],
            Piecewise::Mod | Piecewise::SmoothAbs | Piecewise::SmoothSign | Piecewise::SmoothStep => {
                vec![0.7]
            }
            Piecewise::Trapezoid | Piecewise::SCurve => vec![0.3, 1.5],
            Piecewise::Abs | Piecewise::Sign | Piecewise::Step | Piecewise::Floor => vec![],
            _ => vec![1.5],
        }
    }

    #[test]
    fn the_generators_pieces_have_the_values_and_derivatives_of_the_books() {
        for function in ALL {
            let others = others(function);
            for k in 0..60 {
                // Between all joints of pieces.
                let x = -1.183 + 0.0617 * f64::from(k);
                let with = |x: f64| -> f64 {
                    function.of(&std::iter::once(x).chain(others.iter().copied()).collect::<Vec<f64>>())
                };
                let arguments: Vec<Jet> = std::iter::once(Jet::time(x))
                    .chain(others.iter().map(|other| Jet::constant(*other)))
                    .collect();
                let jet = call(function, &arguments);
                let h = 1e-4;
                // A few roundings; h² times a third or fourth derivative of up to 1e3, and roundings over h².
                assert!((with(x) - jet.value).abs() < 1e-14, "{function:?} at {x}: {jet:?}");
                let first = (with(x + h) - with(x - h)) / (2.0 * h);
                assert!((first - jet.first).abs() < 1e-5, "{function:?} at {x}: {first} {jet:?}");
                let second = (with(x + h) - 2.0 * with(x) + with(x - h)) / (h * h);
                assert!((second - jet.second).abs() < 1e-4, "{function:?} at {x}: {second} {jet:?}");
            }
        }
    }
}
