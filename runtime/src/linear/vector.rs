//! Vectors as slices: scalar product, sum, largest magnitude. The order of summation is fixed.

/// Scalar product, in four running sums.
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

/// `y += factor * x`.
pub fn add_scaled(y: &mut [f64], factor: f64, x: &[f64]) {
    for (y, x) in y.iter_mut().zip(x) {
        *y += factor * x;
    }
}

/// Largest magnitude; NaN if any entry is not a number.
pub fn largest(values: &[f64]) -> f64 {
    // Magnitudes are ordered as their bits are, and what is not a number is above all: no branches.
    f64::from_bits(values.iter().fold(0, |most, x| most.max(x.abs().to_bits())))
}

/// Whether all are numbers, and none is infinite.
pub fn is_finite(values: &[f64]) -> bool {
    largest(values).is_finite()
}

/// Whether both have the same bits throughout.
pub fn same_bits(a: &[f64], b: &[f64]) -> bool {
    let differ =
        |a: &[f64], b: &[f64]| a.iter().zip(b).fold(0, |bits, (a, b)| bits | (a.to_bits() ^ b.to_bits()));
    let (a_blocks, a_rest) = a.as_chunks::<4>();
    let (b_blocks, b_rest) = b.as_chunks::<4>();
    let blocks = a_blocks.iter().zip(b_blocks).all(|(a, b)| differ(a, b) == 0);
    a.len() == b.len() && blocks && differ(a_rest, b_rest) == 0
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
