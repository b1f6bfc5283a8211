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

/// Copies what was written just now; whether nothing changed. Numbers go in pairs, as loops write them: processors wait until all is
/// through where a copy reads more than that at once.
///
/// # Panics
/// If `from` is shorter.
#[inline]
pub fn replace(to: &mut [f64], from: &[f64]) -> bool {
    // Pairs begin at multiples of 16 bytes.
    let odd = usize::from(!from.as_ptr().addr().is_multiple_of(16)).min(to.len());
    let (from, mut bits) = (&from[..to.len()], 0);
    let (first, rest) = to.split_at_mut(odd);
    let (from_first, from_rest) = from.split_at(odd);
    for (to, from) in [(first, from_first), (rest, from_rest)] {
        for (to, from) in to.iter_mut().zip(from) {
            bits |= to.to_bits() ^ from.to_bits();
            *to = *from;
        }
    }
    bits == 0
}

/// Whether all numbers have the same bits.
///
/// # Panics
/// If `b` is shorter.
#[inline]
pub fn same_bits(a: &[f64], b: &[f64]) -> bool {
    let ((a, a_rest), (b, b_rest)) = (a.as_chunks::<4>(), b[..a.len()].as_chunks::<4>());
    let differs = |(a, b): (&f64, &f64)| a.to_bits() ^ b.to_bits();
    // To stop at the first four that differ takes fewer instructions than to look at all.
    let same =
        |(a, b): (&[f64; 4], &[f64; 4])| a.iter().zip(b).map(differs).fold(0, |all, bits| all | bits) == 0;
    a.iter().zip(b).all(same) && a_rest.iter().zip(b_rest).map(differs).all(|bits| bits == 0)
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
    fn a_copy_tells_whether_anything_changed() {
        let values: Vec<f64> = (0..12).map(f64::from).collect();
        // Wherever pairs begin, and however many numbers stand before them.
        for (first, last) in [(0, 12), (1, 12), (2, 3), (3, 3), (5, 6), (4, 11)] {
            let from = &values[first..last];
            let mut to = vec![f64::NAN; from.len()];
            assert_eq!(replace(&mut to, from), from.is_empty());
            assert!(replace(&mut to, from) && to == from);
        }
        assert!(!replace(&mut [0.0], &[-0.0]) && replace(&mut [f64::NAN], &[f64::NAN]));
        assert!(!same_bits(&[1.0, 0.0], &[1.0, -0.0]) && same_bits(&[1.0, f64::NAN], &[1.0, f64::NAN]));
    }
}
