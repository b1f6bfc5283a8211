//! The larger and the smaller of numbers, as functions to be written and by plain evaluation.

use linkwear_runtime::Scalar;

use crate::straight::lower::Lowered;
use crate::straight::number::Recorder;

/// Numbers that are equal, of both signs, infinite or none.
pub(crate) const NUMBERS: [f64; 9] =
    [0.0, -0.0, 1.0, -1.0, f64::INFINITY, f64::NEG_INFINITY, f64::NAN, 0.5, f64::MIN_POSITIVE];

/// Of two numbers; the comparison of the last one is read elsewhere, too.
pub(crate) fn extremes<T: Scalar>([a, b]: [T; 2]) -> Vec<T> {
    let half = T::constant(0.5);
    let is_less = b.lt(a);
    vec![
        a.max(b),
        b.max(a),
        T::select(a.lt(b), a, b),
        T::select(a.lt(half), half, a),
        half.max(b),
        T::select(half.lt(b), half, b),
        T::select(is_less, b, a) + T::select(is_less, half, a),
    ]
}

/// The same to be written.
pub(crate) fn written_down() -> Lowered {
    let recorder = Recorder::default();
    let outputs = recorder.ids(extremes([recorder.input(0), recorder.input(1)]));
    Lowered { graph: recorder.into_graph(), inputs: 2, first: Vec::new(), outputs }
}
