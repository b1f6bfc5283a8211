//! Vectors as slices: scalar product, sum, largest magnitude. The order of summation is fixed.

/// Scalar product, in four running sums.
#[inline]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (a_blocks, a_rest) = a.as_chunks::<4>();
    let (b_blocks, b_rest) = b.as_chunks::<4>();
    for (x, y) in a_blocks.iter().zip(b_blocks) {
        for (sum, (x, y)) in sums.iter_mut().zip(x.iter().zip(y)) {
            *sum += x * y;
        }
    }
    let rest: f64 = a_rest.iter().zip(b_rest).map(|(x, y)| x * y).sum();
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}

/// Writes `y + factor * x`. Of slices cut to one length compilers make loops without checks, several numbers at a time.
pub fn combine(sum: &mut [f64], y: &[f64], factor: f64, x: &[f64]) {
    let n = sum.len();
    let (y, x) = (&y[..n], &x[..n]);
    for i in 0..n {
        sum[i] = y[i] + factor * x[i];
    }
}

/// `y += factor * x`.
#[inline]
pub fn add_scaled(y: &mut [f64], factor: f64, x: &[f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += factor * x;
    }
}

/// Largest magnitude; NaN if any entry is not a number.
#[inline]
pub fn largest(values: &[f64]) -> f64 {
    largest_of(values.iter().copied())
}

/// The same of values that come one by one.
#[inline]
pub fn largest_of(values: impl Iterator<Item = f64>) -> f64 {
    // Magnitudes are ordered as their bits are, and what is not a number is above all: no branches.
    f64::from_bits(values.fold(0, |most, x| most.max(x.abs().to_bits())))
}

/// Whether all are numbers, and none is infinite.
#[inline]
pub fn is_finite(values: &[f64]) -> bool {
    // Nothing but these makes a zero that is none, of either sign: no branches, several side by side.
    values.iter().fold(0, |bits, x| bits | (0.0 * x).to_bits()) << 1 == 0
}

/// Whether both have the same bits throughout.
#[inline]
pub fn same_bits(a: &[f64], b: &[f64]) -> bool {
    let mut bits = [0; 4];
    let (a_blocks, a_rest) = a.as_chunks::<4>();
    let (b_blocks, b_rest) = b.as_chunks::<4>();
    for (a, b) in a_blocks.iter().zip(b_blocks) {
        for (bits, (a, b)) in bits.iter_mut().zip(a.iter().zip(b)) {
            *bits |= a.to_bits() ^ b.to_bits();
        }
    }
    let rest = a_rest.iter().zip(b_rest).fold(0, |bits, (a, b)| bits | (a.to_bits() ^ b.to_bits()));
    a.len() == b.len() && bits.iter().fold(rest, |all, bits| all | bits) == 0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_not_a_number_is_the_largest() {
        assert_eq!(largest(&[1.0, -3.0, 2.0]), 3.0);
        assert_eq!(largest(&[]), 0.0);
        assert!(largest(&[1.0, f64::NAN, f64::INFINITY]).is_nan());
        assert!(
            is_finite(&[f64::MAX, -0.0]) && !is_finite(&[0.0, f64::NEG_INFINITY]) && !is_finite(&[-f64::NAN])
        );
    }

    #[test]
    fn bits_are_compared_to_the_last_entry() {
        let values = [1.0, 2.0, 3.0, 4.0, 0.0];
        let mut other = values;
        assert!(same_bits(&values, &other) && !same_bits(&values, &values[..4]));
        other[4] = -0.0;
        assert!(!same_bits(&values, &other));
        other = values;
        other[1] = 2.0 + 4.0 * f64::EPSILON;
        assert!(!same_bits(&values, &other));
    }
}
