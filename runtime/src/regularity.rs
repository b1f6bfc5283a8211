//! How regular loops are by their pivots. In: pivots, the largest value that each has had. Out: the smallest one relative to that.
//! Never knows what is done about it.

use crate::scalar::Scalar;

/// Below this regularity (see [`crate::Dynamics::nearness`]; about the square of a singular value) the stages of a
/// step are put onto the constraints before they are evaluated. A stage is off the constraints by its own
/// truncation error, which the nearly lost direction multiplies by the inverse of its singular value, twice;
/// on the constraints the accelerations stay smooth right through a singular position.
pub(crate) const PROJECTED_STAGES: f64 = 0.05;

/// Pivots below this part of the largest of all pivots are noise, whatever they were before.
const NOISE_PIVOT: f64 = 1e-13;

/// Keeps the largest value that each pivot has had, and says how regular these are, without branches.
pub(crate) fn note_pivots<T: Scalar>(pivots: &[T], values: &mut [T]) -> T {
    for (pivot, most) in pivots.iter().zip(&mut *values) {
        *most = larger(*pivot, *most);
    }
    let noise = noise_of(values);
    let all = pivots.iter().zip(values);
    all.fold(T::constant(1.0), |smallest, (pivot, most)| smaller(smallest, (*pivot, *most), noise))
}

/// The larger of a pivot, if it is finite, and the largest value that it has had.
#[inline]
pub(crate) fn larger<T: Scalar>(pivot: T, most: T) -> T {
    let finite = T::select(pivot.lt(T::constant(f64::INFINITY)), pivot, most);
    T::select(most.lt(pivot), finite, most)
}

/// Up to where pivots are noise, by their largest values.
pub(crate) fn noise_of<T: Scalar>(values: &[T]) -> T {
    T::constant(NOISE_PIVOT) * values.iter().fold(T::constant(0.0), |most, value| most.max(value.abs()))
}

/// The smaller of a regularity and that of a pivot with the largest value that it has had.
#[inline]
pub(crate) fn smaller<T: Scalar>(smallest: T, (pivot, most): (T, T), noise: T) -> T {
    let least = T::select(pivot.lt(smallest * most), pivot / most, smallest);
    // A pivot that is not a positive number counts as lost rank.
    T::select(noise.lt(pivot), least, T::constant(0.0))
}
